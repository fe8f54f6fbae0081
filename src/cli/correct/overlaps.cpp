#include "cli/correct/overlaps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>

#include "cli/correct/light_weights.hpp"
#include "cli/correct/picture_plan.hpp"
#include "cli/program/format.hpp"
#include "cli/program/interrupt.hpp"
#include "cli/program/parallel.hpp"
#include "cli/program/paths.hpp"

namespace lensprof {
namespace {

// A light may differ by so much from a pixel's grey value; and from those of most about it, which noise does less.
constexpr double same_grey = 0.03, same_in_black = 0.01, same_share = 0.04;
constexpr double most_agree = 0.6;
constexpr int about_px = 2;
// Grey values next to white ones from which on noise and coding may have made them of white.
constexpr double almost_white = 0.95;

// Means of blocks tell whether pictures show the same at all; some px of misplacement do not matter to them.
constexpr uint32_t block_px = 16;
constexpr double same_block = 0.04, enough_agree = 0.5;

constexpr uint32_t node_px = 8;                // between places that are computed
constexpr double bent_px = 0.05;               // by which those between may be off a plane
constexpr double edge_px = 0.05;               // beyond the middles of the outermost pixels
constexpr int sight_steps = 24;                // of the places by which pictures are found to overlap
constexpr uint32_t strip_rows = 4 * block_px;  // that a thread takes

// Full frame of the project -> pixels of a picture, which may be of another size.
struct PixelScale {
    double x, y;

    PixelScale(const Picture &picture, const lensprof_camera &camera)
        : x(static_cast<double>(picture.width) / camera.width),
          y(static_cast<double>(picture.height) / camera.height) {}
    static double to_picture(double at, double scale) { return (at + 0.5) * scale - 0.5; }
    static double to_frame(double at, double scale) { return (at + 0.5) / scale - 0.5; }
};

// A picture at full size, and its light.
class LitPicture {
public:
    LitPicture(const PlacedCorrection &placed, const CorrectionKind &kind, const Project &project);

    uint32_t width() const { return grey_.width; }
    uint32_t height() const { return grey_.height; }
    size_t samples() const { return samples_; }
    const Picture &header() const { return grey_; }
    const lensprof_camera &camera() const { return camera_; }
    PixelScale scale() const { return {grey_, camera_}; }

    double grey(uint32_t x, uint32_t y, size_t c) const { return grey_at(view_, y, size_t(x) * samples_ + c); }
    double largest(uint32_t x, uint32_t y) const { return largest_grey(view_, x, y); }
    float *light(uint32_t x, uint32_t y) { return &light_[(size_t(y) * width() + x) * samples_]; }

    const std::vector<float> &all_light() const { return light_; }

    bool is_masked(uint32_t x, uint32_t y) const { return !mask_.empty() && !mask_[size_t(y) * width() + x]; }
    double trust(uint32_t x, uint32_t y) const { return trust_of(largest(x, y)); }
    void weights(uint32_t x, uint32_t y, double trust, double weight[3]) const;

    double falloff(uint32_t x, uint32_t y) const {
        return lensprof_vignetting_eval(
            &vignetting_, lensprof_vignetting_r2(&vignetting_, width(), height(), x, y, nullptr), nullptr);
    }

    // The grey value that a pixel would have, of the falloff, with so much light; above 1 for more light than white.
    // Projects have one response.
    double recorded(size_t c, double light, double falloff) const {
        const double share = std::max(light * gain_[c] * falloff, 0.0);
        if (share > 1.0) return share;  // more than white, which is no grey value
        return curve_[static_cast<size_t>(std::lround(curve_steps * std::sqrt(share)))];
    }

private:
    static constexpr int curve_steps = 8192;  // of the square root of light, since responses are steepest next to black
    const LightWeights weights_;
    const lensprof_camera camera_;
    const lensprof_vignetting vignetting_;
    Picture grey_;
    lensprof_image view_{};
    size_t samples_;
    double gain_[3];
    std::array<double, curve_steps + 1> curve_;
    std::vector<float> light_;
    std::vector<uint8_t> mask_;
};

LitPicture::LitPicture(const PlacedCorrection &placed, const CorrectionKind &kind, const Project &project)
    : weights_(placed.job),
      camera_(project.images[placed.image].camera),
      vignetting_(placed.job.model->vignetting[0]),
      grey_(read_picture(placed.job.source)),
      samples_(lensprof_layout_samples(grey_.layout)) {
    const std::string &file = placed.job.source;
    view_ = grey_.view();
    check_finite(view_, 0, 1, file);
    light_.resize(size_t(grey_.width) * grey_.height * samples_);
    const lensprof_image after{light_.data(),       static_cast<ptrdiff_t>(grey_.width * samples_ * sizeof(float)),
                               grey_.width,         grey_.height,
                               LENSPROF_SAMPLE_F32, grey_.layout};
    const Plan plan(options_of(grey_, placed.job, kind), file);
    check(lensprof_apply(plan.get(), &view_, &after, 0, 0), file);
    for (size_t c = 0; c < 3; c++) gain_[c] = gain_of(placed.job, c);
    for (int k = 0; k <= curve_steps; k++)
        curve_[static_cast<size_t>(k)] = lensprof_response_eval(
            &placed.job.model->response[0], std::pow(static_cast<double>(k) / curve_steps, 2), nullptr);
    mask_.resize(size_t(grey_.width) * grey_.height);
    lensprof_error error{};
    check(lensprof_pto_draw_mask(project.pto.get(), placed.image, mask_.data(), grey_.width, grey_.height,
                                 static_cast<ptrdiff_t>(grey_.width), &error),
          file, &error);
    if (std::find(mask_.begin(), mask_.end(), 0) == mask_.end()) mask_.clear();
}

void LitPicture::weights(uint32_t x, uint32_t y, double trust, double weight[3]) const {
    const double m = falloff(x, y);
    for (size_t c = 0; c < samples_; c++) weight[c] = trust * m * m * weights_.at(c, grey(x, y, c));
}

// Where another picture shows the pixels of one: computed at nodes, and between four of them where places lie on a
// plane to bent_px; else, at the cut of a picture all around for one, for every pixel.
class PlaceMap {
public:
    PlaceMap(const LitPicture &from, const LitPicture &to)
        : from_(from.camera()),
          to_(to.camera()),
          out_(from.scale()),
          in_(to.scale()),
          columns_(from.width() / node_px + 2),
          nodes_(size_t(columns_) * (from.height() / node_px + 2)) {
        for (size_t n = 0; n < nodes_.size(); n++) {
            Node &node = nodes_[n];
            node.is_seen = compute(x_of(n), y_of(n), node.xy);
        }
        for (size_t n = 0; n + columns_ < nodes_.size(); n++)
            if (n % columns_ + 1 < columns_) nodes_[n].is_plane = is_plane(n);
    }

    bool find(uint32_t x, uint32_t y, double xy[2]) const {
        const size_t n = size_t(y / node_px) * columns_ + x / node_px;
        if (!nodes_[n].is_plane) return compute(x, y, xy);
        between(n, static_cast<double>(x % node_px) / node_px, static_cast<double>(y % node_px) / node_px, xy);
        return true;
    }

private:
    struct Node {
        double xy[2] = {};
        bool is_seen = false, is_plane = false;  // is_plane: of the square of nodes from this one on
    };

    double x_of(size_t n) const { return static_cast<double>(n % columns_) * node_px; }
    double y_of(size_t n) const { return static_cast<double>(n / columns_) * node_px; }

    bool compute(double x, double y, double xy[2]) const {
        double direction[2];
        if (!lensprof_camera_unproject(&from_, PixelScale::to_frame(x, out_.x), PixelScale::to_frame(y, out_.y),
                                       direction)
            || !lensprof_camera_project(&to_, direction[0], direction[1], xy))
            return false;
        xy[0] = PixelScale::to_picture(xy[0], in_.x), xy[1] = PixelScale::to_picture(xy[1], in_.y);
        return true;
    }

    void between(size_t n, double u, double v, double xy[2]) const {
        const Node *upper = &nodes_[n], *lower = upper + columns_;
        for (size_t d = 0; d < 2; d++)
            xy[d] = (1 - v) * ((1 - u) * upper[0].xy[d] + u * upper[1].xy[d])
                    + v * ((1 - u) * lower[0].xy[d] + u * lower[1].xy[d]);
    }

    bool is_plane(size_t n) const {
        for (size_t corner : {n, n + 1, n + columns_, n + columns_ + 1})
            if (!nodes_[corner].is_seen) return false;
        constexpr double inside[3][2] = {{0.5, 0.5}, {0.5, 0.0}, {0.0, 0.5}};  // where bends are largest
        for (const auto &[u, v] : inside) {
            double straight[2], exact[2];
            between(n, u, v, straight);
            if (!compute(x_of(n) + u * node_px, y_of(n) + v * node_px, exact)
                || !(std::hypot(straight[0] - exact[0], straight[1] - exact[1]) < bent_px))
                return false;
        }
        return true;
    }

    const lensprof_camera from_, to_;
    const PixelScale out_, in_;
    uint32_t columns_;
    std::vector<Node> nodes_;
};

// Light at a place between four pixels, and how far all of them are from black and white.
struct Reading {
    double light[3], trust;
    bool is_white;
    uint32_t x, y;  // the nearest pixel
};

// False outside of the picture, and where a mask excludes any of the four.
bool read_at(LitPicture &picture, const double xy[2], Reading &reading) {
    const double right = picture.width() - 1.0, bottom = picture.height() - 1.0;
    if (!(xy[0] >= -edge_px && xy[1] >= -edge_px && xy[0] <= right + edge_px && xy[1] <= bottom + edge_px))
        return false;
    const double at_x = std::clamp(xy[0], 0.0, right), at_y = std::clamp(xy[1], 0.0, bottom);
    const auto x = static_cast<uint32_t>(at_x), y = static_cast<uint32_t>(at_y);
    const double u = at_x - x, v = at_y - y;
    const uint32_t next_x = std::min(x + 1, picture.width() - 1), next_y = std::min(y + 1, picture.height() - 1);
    reading = {{}, 1.0, false, u < 0.5 ? x : next_x, v < 0.5 ? y : next_y};
    for (uint32_t n = 0; n < 4; n++) {
        const uint32_t px = n % 2 ? next_x : x, py = n / 2 ? next_y : y;
        const double share = (n % 2 ? u : 1 - u) * (n / 2 ? v : 1 - v);
        if (picture.is_masked(px, py)) return false;
        const float *light = picture.light(px, py);
        for (size_t c = 0; c < picture.samples(); c++) reading.light[c] += share * static_cast<double>(light[c]);
        reading.trust = std::min(reading.trust, picture.trust(px, py));
        reading.is_white = reading.is_white || is_white(picture.largest(px, py));
    }
    return true;
}

// The light of a picture, as it and others say.
class Merge {
public:
    Merge(const PlacedCorrection &placed, const CorrectionKind &kind, const Project &project)
        : kind_(kind), own_(placed, kind, project), sums_(size_t(own_.width()) * own_.height() * own_.samples()) {
        in_strips([&](uint32_t x, uint32_t y) {
            double weight[3];
            own_.weights(x, y, ends_in_white(x, y) ? 0.0 : own_.trust(x, y), weight);
            add(x, y, own_.light(x, y), weight);
        });
    }

    LitPicture &own() { return own_; }

    void add(LitPicture &other) {
        const PlaceMap map(own_, other);
        std::vector<Agreement> agreement(size_t(own_.width()) * own_.height(), Agreement::unseen);
        const uint32_t columns = own_.width() / block_px + 1;
        std::vector<Block> blocks(size_t(columns) * (own_.height() / block_px + 1));
        const auto at = [&](uint32_t x, uint32_t y) -> Agreement & { return agreement[size_t(y) * own_.width() + x]; };
        in_strips([&](uint32_t x, uint32_t y) {
            double xy[2];
            Reading reading;
            if (!map.find(x, y, xy) || !read_at(other, xy, reading)) return;
            double more[3];
            differences(x, y, reading, more);
            at(x, y) = agreement_of(x, y, more);
            if (reading.trust == 0.0) return;     // black or white, which is not the light
            const size_t c = own_.samples() / 2;  // green, or grey
            Block &block = blocks[size_t(y / block_px) * columns + x / block_px];
            block.difference += std::min(more[c], 1.0 - clamped_grey(x, y, c)), block.pixels++;
        });
        in_strips([&](uint32_t x, uint32_t y) {
            double xy[2];
            Reading reading;
            const bool may_be = at(x, y) == Agreement::near || at(x, y) == Agreement::same;
            if (may_be && most_are_same(agreement, x, y) && map.find(x, y, xy) && read_at(other, xy, reading))
                add(x, y, other, reading);
        });
        for (const Block &block : blocks)
            if (block.pixels) seen_++, same_ += std::fabs(block.difference / block.pixels) <= same_block;
    }

    // Of what other pictures show of this one the share where they agree with it; NaN where they show nothing.
    double share_same() const { return static_cast<double>(same_) / static_cast<double>(seen_); }

    // What has been found, in the place of the picture's own light.
    const std::vector<float> &result() {
        in_strips([&](uint32_t x, uint32_t y) {
            Sum *sum = &sums_[index(x, y)];
            for (size_t c = 0; c < own_.samples(); c++)
                if (sum[c].weight > 0.0f) own_.light(x, y)[c] = sum[c].light / sum[c].weight;
        });
        return own_.all_light();
    }

private:
    enum class Agreement : uint8_t {
        unseen,
        other,
        near,  // as noise or a step beside it may explain
        same
    };

    // Differences of what another picture shows, as this one would have recorded it.
    struct Block {
        double difference = 0.0;
        uint32_t pixels = 0;
    };

    struct Sum {
        float light = 0.0f, weight = 0.0f;
    };

    size_t index(uint32_t x, uint32_t y) const { return (size_t(y) * own_.width() + x) * own_.samples(); }

    template <class Work>
    void in_strips(const Work &work) {
        const uint32_t strips = (own_.height() + strip_rows - 1) / strip_rows;
        const auto strip = [&](uint32_t n) {
            const uint32_t end = std::min(own_.height(), (n + 1) * strip_rows);
            for (uint32_t y = n * strip_rows; y < end; y++)
                for (uint32_t x = 0; x < own_.width(); x++) work(x, y);
        };
        for_each_in_order(strips, thread_count(kind_.threads), strip, [](uint32_t) {});
    }

    template <class Light>
    void add(uint32_t x, uint32_t y, const Light *light, const double weight[3]) {
        Sum *sum = &sums_[index(x, y)];
        for (size_t c = 0; c < own_.samples(); c++) {
            sum[c].light += static_cast<float>(weight[c] * static_cast<double>(light[c]));
            sum[c].weight += static_cast<float>(weight[c]);
        }
    }

    void add(uint32_t x, uint32_t y, const LitPicture &other, const Reading &reading) {
        if (reading.trust > 0.0) {
            double weight[3];
            other.weights(reading.x, reading.y, reading.trust, weight);
            add(x, y, reading.light, weight);
        } else if (reading.is_white && is_white(own_.largest(x, y))) {
            // White in both: at least as bright as the darker picture says.
            for (size_t c = 0; c < own_.samples(); c++)
                own_.light(x, y)[c] = std::max(own_.light(x, y)[c], static_cast<float>(reading.light[c]));
        }
    }

    // Whether a channel is white: by its grey value, or almost, among others that are.
    bool ends_in_white(uint32_t x, uint32_t y, size_t c) const {
        if (is_white(own_.grey(x, y, c))) return true;
        if (own_.grey(x, y, c) < almost_white) return false;
        for (uint32_t py = y - (y > 0); py <= std::min(y + 1, own_.height() - 1); py++)
            for (uint32_t px = x - (x > 0); px <= std::min(x + 1, own_.width() - 1); px++)
                if (is_white(own_.grey(px, py, c))) return true;
        return false;
    }

    bool ends_in_white(uint32_t x, uint32_t y) const {
        for (size_t c = 0; c < own_.samples(); c++)
            if (ends_in_white(x, y, c)) return true;
        return false;
    }

    double clamped_grey(uint32_t x, uint32_t y, size_t c) const { return std::clamp(own_.grey(x, y, c), 0.0, 1.0); }

    // By how much this picture would have recorded more of such light than it did.
    void differences(uint32_t x, uint32_t y, const Reading &reading, double more[3]) const {
        const double falloff = own_.falloff(x, y);
        for (size_t c = 0; c < own_.samples(); c++)
            more[c] = own_.recorded(c, reading.light[c], falloff) - clamped_grey(x, y, c);
    }

    // White fits all that is brighter.
    Agreement agreement_of(uint32_t x, uint32_t y, const double more[3]) const {
        Agreement all = Agreement::same;
        for (size_t c = 0; c < own_.samples(); c++) {
            if (more[c] > 0.0 && ends_in_white(x, y, c)) continue;
            if (!(std::fabs(more[c]) <= same_grey)) return Agreement::other;
            if (std::fabs(more[c]) > same_in_black + same_share * clamped_grey(x, y, c)) all = Agreement::near;
        }
        return all;
    }

    // A step of light in shadows is as small as noise at one pixel, and is not about it.
    bool most_are_same(const std::vector<Agreement> &agreement, uint32_t x, uint32_t y) const {
        const auto width = static_cast<int>(own_.width()), height = static_cast<int>(own_.height());
        const auto left = std::max(static_cast<int>(x) - about_px, 0),
                   top = std::max(static_cast<int>(y) - about_px, 0);
        int seen = 0, same = 0;
        for (int py = top; py <= std::min(static_cast<int>(y) + about_px, height - 1); py++)
            for (int px = left; px <= std::min(static_cast<int>(x) + about_px, width - 1); px++) {
                const Agreement one = agreement[static_cast<size_t>(py) * own_.width() + static_cast<size_t>(px)];
                seen += one != Agreement::unseen, same += one == Agreement::same;
            }
        return same >= most_agree * seen;
    }

    const CorrectionKind &kind_;
    LitPicture own_;
    std::vector<Sum> sums_;
    uint64_t seen_ = 0, same_ = 0;  // blocks of other pictures in this one
};

// Whether a picture shows any of the places of another one, its edges among them.
bool shows_any(const lensprof_camera &one, const lensprof_camera &other) {
    double direction[2], xy[2];
    for (int v = 0; v <= sight_steps; v++)
        for (int u = 0; u <= sight_steps; u++)
            if (lensprof_camera_unproject(&other, u * (other.width - 1.0) / sight_steps,
                                          v * (other.height - 1.0) / sight_steps, direction)
                && lensprof_camera_project(&one, direction[0], direction[1], xy) && xy[0] >= -0.5 && xy[1] >= -0.5
                && xy[0] <= one.width - 0.5 && xy[1] <= one.height - 0.5)
                return true;
    return false;
}

// One may lie between the places of the other.
bool overlap(const lensprof_camera &one, const lensprof_camera &other) {
    return shows_any(one, other) || shows_any(other, one);
}

void write_light(const Correction &job, const CorrectionKind &kind, Merge &merge, Progress &progress) {
    make_folder(std::filesystem::path(absolute_path(job.target)).parent_path().string());
    const Picture header = header_of_result(merge.own().header(), LENSPROF_SAMPLE_F32);
    PictureWriter writer(job.target, header, write_options(job, kind));
    const std::vector<float> &light = merge.result();
    writer.write({const_cast<float *>(light.data()), static_cast<ptrdiff_t>(header.row_bytes), header.width,
                  header.height, header.sample, header.layout});
    const bool with_metadata = writer.finish();
    writer.commit();
    warn_of_written(job, with_metadata, progress);
}

}  // namespace

void check_mergeable(const std::string &file, std::optional<uint32_t> &layout) {
    const Picture header = read_header(file);
    const size_t samples = samples_of_light(header, file);
    if (layout && header.layout != *layout)
        throw Failure(ExitCode::usage, file + ": is " + (samples == 1 ? "grey" : "in colour")
                                           + ", and others are not; merge pictures of one kind");
    layout = header.layout;
}

Corrected write_from_overlaps(const Project &project, const std::vector<PlacedCorrection> &jobs,
                              const std::vector<PlacedCorrection> &all, const CorrectionKind &kind,
                              Progress &progress) {
    Corrected corrected;
    uint64_t pixels = 0;
    for (const PlacedCorrection &placed : jobs) pixels += placed.job.pixels;
    Throughput throughput(progress, "merging", static_cast<uint32_t>(jobs.size()), pixels);
    for (const PlacedCorrection &placed : jobs) {
        Merge merge(placed, kind, project);
        uint32_t overlapping = 0;
        for (PlacedCorrection other : all) {
            stop_if_interrupted();
            if (other.image == placed.image || !overlap(merge.own().camera(), project.images[other.image].camera))
                continue;
            other.job.wanted = placed.job.wanted;
            LitPicture lit(other, kind, project);
            merge.add(lit);
            overlapping++;
        }
        if (!overlapping)
            progress.warn(placed.job.source
                          + ": no other picture of the project overlaps it; its light is its own alone");
        const double same = merge.share_same();
        if (same < enough_agree)
            progress.warn(
                placed.job.source
                + format(": agrees with the pictures that overlap it at %.0f %% of what they share alone; is it "
                         "the picture that the project was fitted to?",
                         100.0 * same));
        write_light(placed.job, kind, merge, progress);
        corrected.pictures.push_back({{"file", placed.job.source},
                                      {"output", placed.job.target},
                                      {"overlapping", overlapping},
                                      {"agreement", overlapping ? Json(same) : Json()}});
        throughput.add_pixels(placed.job.pixels);
        throughput.add_picture();
    }
    corrected.seconds = throughput.seconds();
    corrected.megapixels = throughput.megapixels();
    if (jobs.size() > 1) progress.say("merged " + throughput.summary());
    return corrected;
}

}  // namespace lensprof
