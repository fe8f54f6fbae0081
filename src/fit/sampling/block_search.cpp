// The blocks of neighbouring shifts differ only in where they begin. Several are processed side by side, in the lanes
// of a vector, with the same operations in the same order as one block alone: the results are identical.
#include "fit/sampling/block_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace lensprof {
namespace {

constexpr size_t kBlockLanes = 4;
typedef float BlockLanes __attribute__((vector_size(kBlockLanes * sizeof(float))));
typedef int LaneFlags __attribute__((vector_size(kBlockLanes * sizeof(int))));

constexpr size_t kFootprintPixels = Footprint<4>::kCount;

using Offsets = std::array<ptrdiff_t, kBlockLanes>;

class BlockSearch {
public:
    BlockSearch(const Block<4> &block, const GreyLevels::Level &level, const Footprint<4> &footprint)
        : block_(block), level_(level) {
        for (size_t k = 0; k < kFootprintPixels; k++) index_[k] = footprint.index(k, level);
    }

    // Correlations with the blocks whose pixels are `offset[n]` after those of the footprint.
    std::array<double, kBlockLanes> compare(const Offsets &offset) const {
        Square<4, BlockLanes> blocks;
        LaneFlags lost{};
        const bool is_run = offset[3] == offset[0] + 3;  // the shifts are in the order of pixels
        for (size_t k = 0; k < kFootprintPixels; k++) {
            const float *first = level_.grey.data() + index_[k];
            BlockLanes grey;
            if (is_run)
                std::memcpy(&grey, first + offset[0], sizeof grey);
            else
                grey = BlockLanes{first[offset[0]], first[offset[1]], first[offset[2]], first[offset[3]]};
            lost |= (grey < kBlackGrey) | (grey > kWhiteGrey);
            blocks.value[k] = grey;
        }
        const BlockLanes sum = normalised_product(blocks);
        std::array<double, kBlockLanes> correlations;
        for (size_t n = 0; n < kBlockLanes; n++)
            correlations[n] = block_.lost || lost[n] ? correlation_of_rest(offset[n]) : sum[n];
        return correlations;
    }

private:
    BlockLanes normalised_product(Square<4, BlockLanes> &blocks) const {
        blocks.take_out_mean(), blocks.take_out_gradient();
        const BlockLanes square = blocks.sum_of_squares();
        BlockLanes length{}, sum{};
        for (size_t n = 0; n < kBlockLanes; n++) length[n] = square[n] > 0.0f ? std::sqrt(square[n]) : 1.0f;
        for (size_t k = 0; k < kFootprintPixels; k++) sum += blocks.value[k] / length * block_.value[k];
        return sum;
    }

    double correlation_of_rest(ptrdiff_t offset) const {
        std::array<float, kFootprintPixels> grey;
        for (size_t k = 0; k < kFootprintPixels; k++) grey[k] = level_.grey[static_cast<size_t>(index_[k] + offset)];
        return block_.correlation_of_rest(grey);
    }

    const Block<4> &block_;
    const GreyLevels::Level &level_;
    std::array<ptrdiff_t, kFootprintPixels> index_;
};

}  // namespace

std::vector<double> correlations_around(const Block<4> &block, const GreyLevels::Level &level, const Sight &sight,
                                        double pixel, const Shifts &shifts) {
    std::vector<double> found(shifts.count(), kOutside);
    Footprint<4> footprint;
    if (!footprint.lay(level, sight.x, sight.y, pixel, sight.map)) return found;
    std::vector<size_t> inside;  // shifts within the frame
    for (size_t k = 0; k < shifts.count(); k++)
        if (footprint.lies_in(level, shifts.at(k))) inside.push_back(k);
    BlockSearch search(block, level, footprint);
    Offsets offset;
    for (size_t first = 0; first < inside.size(); first += kBlockLanes) {
        const size_t count = std::min(kBlockLanes, inside.size() - first);
        for (size_t n = 0; n < kBlockLanes; n++) {  // surplus lanes repeat the last block
            const auto [du, dv] = shifts.at(inside[first + std::min(n, count - 1)]);
            offset[n] = static_cast<ptrdiff_t>(dv) * level.width + du;
        }
        const std::array<double, kBlockLanes> correlations = search.compare(offset);
        for (size_t n = 0; n < count; n++) found[inside[first + n]] = correlations[n];
    }
    return found;
}

}  // namespace lensprof
