#include "fit/solver/heldout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "fit/solver/objective.hpp"

namespace lensprof {
namespace {

constexpr uint32_t kStartPairs = 800, kStartPairsPerImage = 10;

}  // namespace

uint64_t pair_hash(uint32_t pair) {
    uint64_t x = pair + 0x9e3779b97f4a7c15ull;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

Split split_pairs(uint32_t count, uint32_t images) {
    Split split;
    for (uint32_t p = 0; p < count; p++) {
        split.all.push_back(p);
        (pair_hash(p) % 5 == 0 ? split.heldout : split.train).push_back(p);
    }
    uint32_t wanted = std::max(kStartPairs, kStartPairsPerImage * images);
    uint32_t step = std::max(1u, static_cast<uint32_t>(split.train.size()) / wanted);
    for (size_t i = 0; i < split.train.size(); i += step) split.brief.push_back(split.train[i]);
    return split;
}

HeldoutLoss heldout_loss(const Problem &heldout, const Estimate &estimate, const Loss &common) {
    HeldoutLoss result;
    result.losses = all_costs(heldout, common, estimate);
    result.mean =
        std::accumulate(result.losses.begin(), result.losses.end(), 0.0) / static_cast<double>(result.losses.size());
    return result;
}

double loss_difference(const HeldoutLoss &a, const HeldoutLoss &b, double &standard_error) {
    double difference = a.mean - b.mean, sum2 = 0.0;
    auto n = static_cast<double>(a.losses.size());
    for (size_t p = 0; p < a.losses.size(); p++) {
        double d = a.losses[p] - b.losses[p] - difference;
        sum2 += d * d;
    }
    standard_error = std::sqrt(sum2 / (n * (n - 1.0)));
    return difference;
}

double loss_difference_by_place(const Problem &heldout, const HeldoutLoss &a, const HeldoutLoss &b,
                                double &standard_error) {
    constexpr int kAcross = 4;
    std::map<std::array<uint32_t, 3>, double> sums;  // by two images and the place in the first one
    const double difference = a.mean - b.mean;
    for (size_t p = 0; p < a.losses.size(); p++) {
        uint32_t first, second;
        const double *xy;
        if (heldout.by_radiance) {
            const Range &track = heldout.tracks.tracks[p];
            const lensprof_observation *observation = &heldout.tracks.observations[track.first];
            first = observation[0].image, second = observation[1].image, xy = observation[0].xy;
        } else {
            const lensprof_pair &pair = heldout.pairs[p];
            first = pair.image[0], second = pair.image[1], xy = pair.xy[0];
        }
        const uint32_t place = place_in_frame(heldout.images[first], xy, kAcross);
        sums[{first, second, place}] += a.losses[p] - b.losses[p] - difference;
    }
    double sum2 = 0.0;
    for (const auto &[place, sum] : sums) sum2 += sum * sum;
    // Too few places show no scatter; their pairs then count as independent.
    constexpr size_t kMinPlaces = 4;
    if (sums.size() < kMinPlaces) return loss_difference(a, b, standard_error);
    const auto places = static_cast<double>(sums.size());
    standard_error = std::sqrt(sum2 * places / (places - 1.0)) / static_cast<double>(a.losses.size());
    return difference;
}

bool is_as_good(const HeldoutLoss &loss, const HeldoutLoss &best) {
    double error, difference = loss_difference(loss, best, error);
    return difference <= error;
}

bool is_clearly_better(const HeldoutLoss &loss, const HeldoutLoss &other) {
    double error, difference = loss_difference(loss, other, error);
    return difference < -3.0 * error;
}

}  // namespace lensprof
