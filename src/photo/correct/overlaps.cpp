#include "photo/correct/overlaps.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "photo/base/events.hpp"
#include "photo/base/format.hpp"
#include "photo/base/parallel.hpp"
#include "photo/base/paths.hpp"
#include "photo/base/throughput.hpp"
#include "photo/correct/left_out_parts.hpp"
#include "photo/correct/picture_plan.hpp"
#include "photo/correct/place_map.hpp"

namespace lensprof {
namespace {

// Allowed difference of irradiance from a pixel's grey value, and from those of most surrounding pixels, where noise
// averages out.
constexpr double same_grey = 0.03, same_in_black = 0.01, same_share = 0.04;
constexpr double min_same_share = 0.6;
constexpr int about_px = 2;
// Grey values near white that noise and coding may have made from white.
constexpr double almost_white = 0.95;

// Block means show whether pictures show the same scene; some px of misalignment do not matter.
constexpr uint32_t block_px = 16;
constexpr double same_block = 0.04, enough_agree = 0.5;

constexpr int sight_steps = 24;                     // of the positions used to detect overlaps
constexpr uint32_t rows_per_thread = 4 * block_px;  // processed by a thread at a time

// Irradiance of a picture, from itself and from others.
class Merge {
public:
    Merge(const PlacedCorrection &placed, const CorrectionKind &kind, const Scene &scene)
        : kind_(kind),
          picture_(placed, kind, scene),
          sums_(size_t(picture_.width()) * picture_.height() * picture_.samples()) {
        in_strips([&](uint32_t x, uint32_t y) {
            double weight[3];
            picture_.weights(x, y, ends_in_white(x, y) ? 0.0 : picture_.trust(x, y), weight);
            add(x, y, picture_.light(x, y), weight);
        });
    }

    LitPicture &picture() { return picture_; }

    void add(LitPicture &other) {
        const PlaceMap map(picture_, other);
        std::vector<Agreement> agreement(size_t(picture_.width()) * picture_.height(), Agreement::unseen);
        const uint32_t columns = picture_.width() / block_px + 1;
        std::vector<Block> blocks(size_t(columns) * (picture_.height() / block_px + 1));
        const auto agreement_at = [&](uint32_t x, uint32_t y) -> Agreement & {
            return agreement[size_t(y) * picture_.width() + x];
        };
        in_strips([&](uint32_t x, uint32_t y) {
            double xy[2];
            Reading reading;
            if (!map.find(x, y, xy) || !read_at(other, xy, reading)) return;
            double more[3];
            differences(x, y, reading, more);
            agreement_at(x, y) = agreement_of(x, y, more);
            if (reading.trust == 0.0) return;         // clipped: not a measurement
            const size_t c = picture_.samples() / 2;  // green, or grey
            Block &block = blocks[size_t(y / block_px) * columns + x / block_px];
            block.difference += std::min(more[c], 1.0 - clamped_grey(x, y, c)), block.pixels++;
        });
        in_strips([&](uint32_t x, uint32_t y) {
            double xy[2];
            Reading reading;
            const bool may_be = agreement_at(x, y) == Agreement::near || agreement_at(x, y) == Agreement::same;
            if (may_be && most_are_same(agreement, x, y) && map.find(x, y, xy) && read_at(other, xy, reading))
                add(x, y, other, reading);
        });
        for (const Block &block : blocks)
            if (block.pixels) seen_++, same_ += std::fabs(block.difference / block.pixels) <= same_block;
    }

    // Share of the area shown by other pictures in which they agree with this one; NaN if none overlaps.
    double share_same() const { return static_cast<double>(same_) / static_cast<double>(seen_); }

    // Replaces the picture's own irradiance by the merged one.
    const std::vector<float> &result() {
        in_strips([&](uint32_t x, uint32_t y) {
            Sum *sum = &sums_[index(x, y)];
            for (size_t c = 0; c < picture_.samples(); c++)
                if (sum[c].weight > 0.0f) picture_.light(x, y)[c] = sum[c].light / sum[c].weight;
        });
        return picture_.all_light();
    }

private:
    enum class Agreement : uint8_t {
        unseen,
        other,
        near,  // as noise or a nearby edge may explain
        same
    };

    // Differences of another picture's values, as this one would have recorded them.
    struct Block {
        double difference = 0.0;
        uint32_t pixels = 0;
    };

    struct Sum {
        float light = 0.0f, weight = 0.0f;
    };

    size_t index(uint32_t x, uint32_t y) const { return (size_t(y) * picture_.width() + x) * picture_.samples(); }

    template <class Work>
    void in_strips(const Work &work) {
        const uint32_t strips = (picture_.height() + rows_per_thread - 1) / rows_per_thread;
        const auto strip = [&](uint32_t n) {
            const uint32_t end = std::min(picture_.height(), (n + 1) * rows_per_thread);
            for (uint32_t y = n * rows_per_thread; y < end; y++)
                for (uint32_t x = 0; x < picture_.width(); x++) work(x, y);
        };
        for_each_in_order(strips, thread_count(kind_.threads), strip, [](uint32_t) {});
    }

    template <class Light>
    void add(uint32_t x, uint32_t y, const Light *light, const double weight[3]) {
        Sum *sum = &sums_[index(x, y)];
        for (size_t c = 0; c < picture_.samples(); c++) {
            sum[c].light += static_cast<float>(weight[c] * static_cast<double>(light[c]));
            sum[c].weight += static_cast<float>(weight[c]);
        }
    }

    void add(uint32_t x, uint32_t y, const LitPicture &other, const Reading &reading) {
        if (reading.trust > 0.0) {
            double weight[3];
            other.weights(reading.x, reading.y, reading.trust, weight);
            add(x, y, reading.light, weight);
        } else if (reading.is_white && is_white(picture_.largest(x, y))) {
            // White in both: at least as bright as in the darker picture.
            for (size_t c = 0; c < picture_.samples(); c++)
                picture_.light(x, y)[c] = std::max(picture_.light(x, y)[c], static_cast<float>(reading.light[c]));
        }
    }

    // Whether a channel is white: by its grey value, or almost white next to white ones.
    bool ends_in_white(uint32_t x, uint32_t y, size_t c) const {
        if (is_white(picture_.grey(x, y, c))) return true;
        if (picture_.grey(x, y, c) < almost_white) return false;
        for (uint32_t py = y - (y > 0); py <= std::min(y + 1, picture_.height() - 1); py++)
            for (uint32_t px = x - (x > 0); px <= std::min(x + 1, picture_.width() - 1); px++)
                if (is_white(picture_.grey(px, py, c))) return true;
        return false;
    }

    bool ends_in_white(uint32_t x, uint32_t y) const {
        for (size_t c = 0; c < picture_.samples(); c++)
            if (ends_in_white(x, y, c)) return true;
        return false;
    }

    double clamped_grey(uint32_t x, uint32_t y, size_t c) const { return std::clamp(picture_.grey(x, y, c), 0.0, 1.0); }

    // Difference between the grey value this picture would have recorded for this irradiance and its actual value.
    void differences(uint32_t x, uint32_t y, const Reading &reading, double more[3]) const {
        const double falloff = picture_.falloff(x, y);
        for (size_t c = 0; c < picture_.samples(); c++)
            more[c] = picture_.recorded(c, reading.light[c], falloff) - clamped_grey(x, y, c);
    }

    // White is consistent with any brighter value.
    Agreement agreement_of(uint32_t x, uint32_t y, const double more[3]) const {
        Agreement all = Agreement::same;
        for (size_t c = 0; c < picture_.samples(); c++) {
            if (more[c] > 0.0 && ends_in_white(x, y, c)) continue;
            if (!(std::fabs(more[c]) <= same_grey)) return Agreement::other;
            if (std::fabs(more[c]) > same_in_black + same_share * clamped_grey(x, y, c)) all = Agreement::near;
        }
        return all;
    }

    // An edge in shadows is as small as noise at one pixel, but not in its surroundings.
    bool most_are_same(const std::vector<Agreement> &agreement, uint32_t x, uint32_t y) const {
        const auto width = static_cast<int>(picture_.width()), height = static_cast<int>(picture_.height());
        const auto left = std::max(static_cast<int>(x) - about_px, 0),
                   top = std::max(static_cast<int>(y) - about_px, 0);
        int seen = 0, same = 0;
        for (int py = top; py <= std::min(static_cast<int>(y) + about_px, height - 1); py++)
            for (int px = left; px <= std::min(static_cast<int>(x) + about_px, width - 1); px++) {
                const Agreement agreement_here =
                    agreement[static_cast<size_t>(py) * picture_.width() + static_cast<size_t>(px)];
                seen += agreement_here != Agreement::unseen, same += agreement_here == Agreement::same;
            }
        return same >= min_same_share * seen;
    }

    const CorrectionKind &kind_;
    LitPicture picture_;
    std::vector<Sum> sums_;
    uint64_t seen_ = 0, same_ = 0;  // blocks of other pictures in this one
};

// Whether a picture shows any of the sample positions of another one, including its edges.
bool shows_any(const lensprof_camera &first, const lensprof_camera &second) {
    double direction[2], xy[2];
    for (int v = 0; v <= sight_steps; v++)
        for (int u = 0; u <= sight_steps; u++)
            if (lensprof_camera_unproject(&second, u * (second.width - 1.0) / sight_steps,
                                          v * (second.height - 1.0) / sight_steps, direction)
                && lensprof_camera_project(&first, direction[0], direction[1], xy) && xy[0] >= -0.5 && xy[1] >= -0.5
                && xy[0] <= first.width - 0.5 && xy[1] <= first.height - 0.5)
                return true;
    return false;
}

// One picture may lie between the sample positions of the other.
bool overlap(const lensprof_camera &first, const lensprof_camera &second) {
    return shows_any(first, second) || shows_any(second, first);
}

void write_light(const Correction &job, const CorrectionKind &kind, Merge &merge, Events &events) {
    make_folder(std::filesystem::path(absolute_path(job.target)).parent_path().string());
    const Picture header = header_of_result(merge.picture().header(), LENSPROF_SAMPLE_F32);
    PictureWriter writer(job.target, header, write_options(job, kind));
    const std::vector<float> &light = merge.result();
    writer.write({light.data(), static_cast<ptrdiff_t>(header.row_bytes), header.width, header.height, header.sample,
                  header.layout});
    const bool with_metadata = writer.finish();
    writer.commit();
    warn_of_written(job, with_metadata, events);
    LeftOutParts parts;
    parts.add(job.source, job.target);
    parts.warn(events);
}

}  // namespace

void check_mergeable(const std::string &file, std::optional<uint32_t> &layout) {
    const Picture header = read_header(file);
    const size_t samples = samples_of_light(header, file);
    if (layout && header.layout != *layout)
        throw Failure(LENSPROF_ERROR_ARGUMENT, file + ": is " + (samples == 1 ? "grey" : "in colour")
                                                   + ", but others are not; merge pictures of one kind");
    layout = header.layout;
}

Corrected write_from_overlaps(const Scene &scene, const std::vector<PlacedCorrection> &jobs,
                              const std::vector<PlacedCorrection> &all, const CorrectionKind &kind, Events &events) {
    Corrected corrected;
    uint64_t pixels = 0;
    for (const PlacedCorrection &placed : jobs) pixels += placed.job.pixels;
    Throughput throughput(events, "merging", static_cast<uint32_t>(jobs.size()), pixels);
    for (const PlacedCorrection &placed : jobs) {
        Merge merge(placed, kind, scene);
        uint32_t overlapping = 0;
        for (PlacedCorrection other : all) {
            stop_if_cancelled();
            if (other.image == placed.image || !overlap(merge.picture().camera(), scene.images[other.image].camera))
                continue;
            other.job.target_exposure = placed.job.target_exposure;
            LitPicture lit(other, kind, scene);
            merge.add(lit);
            overlapping++;
        }
        if (!overlapping)
            events.warn(placed.job.source, "no other picture of the project overlaps it; nothing is merged into it");
        const double same = merge.share_same();
        if (same < enough_agree)
            events.warn(
                placed.job.source,
                format("agrees with the overlapping pictures in only %.0f %% of the shared area; check that it is "
                       "the picture the project was fitted to",
                       100.0 * same));
        write_light(placed.job, kind, merge, events);
        corrected.pictures.push_back({{"file", placed.job.source},
                                      {"output", placed.job.target},
                                      {"overlapping", overlapping},
                                      {"agreement", overlapping ? Json(same) : Json()}});
        throughput.add_pixels(placed.job.pixels);
        throughput.add_picture();
    }
    corrected.seconds = throughput.seconds();
    corrected.megapixels = throughput.megapixels();
    if (jobs.size() > 1) events.finish("merged " + throughput.summary());
    return corrected;
}

}  // namespace lensprof
