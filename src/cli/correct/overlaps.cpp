#include "cli/correct/overlaps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>

#include "cli/correct/light_weights.hpp"
#include "cli/correct/picture_plan.hpp"
#include "cli/program/interrupt.hpp"
#include "cli/program/parallel.hpp"
#include "cli/program/paths.hpp"

namespace lensprof {
namespace {

constexpr double same_grey = 0.03;                 // difference of grey values that one light may have
constexpr uint32_t node_px = 16, strip_rows = 64;  // between places that are computed; rows that a thread takes
constexpr int sight_steps = 24;                    // of the places by which pictures are found to overlap

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

    // 0 where a mask excludes the pixel.
    double trust(uint32_t x, uint32_t y) const { return is_masked(x, y) ? 0.0 : trust_of(largest(x, y)); }
    void weights(uint32_t x, uint32_t y, double trust, double weight[3]) const;

    double falloff(uint32_t x, uint32_t y) const {
        return lensprof_vignetting_eval(
            &vignetting_, lensprof_vignetting_r2(&vignetting_, width(), height(), x, y, nullptr), nullptr);
    }

    // The grey value that a pixel would have, of the falloff, with so much light.
    double recorded(size_t c, double light, double falloff) const {
        const double share = std::clamp(light * gain_[c] * falloff, 0.0, 1.0);
        return curve_[static_cast<size_t>(std::lround(curve_steps * std::sqrt(share)))];
    }

private:
    bool is_masked(uint32_t x, uint32_t y) const { return !mask_.empty() && !mask_[size_t(y) * width() + x]; }

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

// Where another picture shows the pixels of one: computed at nodes, linear between them, which is within .02 px.
class PlaceMap {
public:
    PlaceMap(const LitPicture &from, const LitPicture &to)
        : columns_(from.width() / node_px + 2), nodes_(size_t(columns_) * (from.height() / node_px + 2)) {
        const PixelScale out = from.scale(), in = to.scale();
        for (size_t n = 0; n < nodes_.size(); n++) {
            const double x = static_cast<double>(n % columns_) * node_px,
                         y = static_cast<double>(n / columns_) * node_px;
            double direction[2], xy[2];
            Node &node = nodes_[n];
            node.is_seen = lensprof_camera_unproject(&from.camera(), PixelScale::to_frame(x, out.x),
                                                     PixelScale::to_frame(y, out.y), direction)
                           && lensprof_camera_project(&to.camera(), direction[0], direction[1], xy);
            if (!node.is_seen) continue;
            node.x = PixelScale::to_picture(xy[0], in.x), node.y = PixelScale::to_picture(xy[1], in.y);
        }
    }

    bool find(uint32_t x, uint32_t y, double xy[2]) const {
        const Node *upper = &nodes_[size_t(y / node_px) * columns_ + x / node_px], *lower = upper + columns_;
        if (!(upper[0].is_seen && upper[1].is_seen && lower[0].is_seen && lower[1].is_seen)) return false;
        const double u = static_cast<double>(x % node_px) / node_px, v = static_cast<double>(y % node_px) / node_px;
        xy[0] = (1 - v) * ((1 - u) * upper[0].x + u * upper[1].x) + v * ((1 - u) * lower[0].x + u * lower[1].x);
        xy[1] = (1 - v) * ((1 - u) * upper[0].y + u * upper[1].y) + v * ((1 - u) * lower[0].y + u * lower[1].y);
        return true;
    }

private:
    struct Node {
        double x = 0.0, y = 0.0;
        bool is_seen = false;
    };

    uint32_t columns_;
    std::vector<Node> nodes_;
};

// Light at a place between four pixels, and how far all of them are from black and white.
struct Reading {
    double light[3], trust;
    bool is_white;
    uint32_t x, y;  // the nearest pixel
};

bool read_at(LitPicture &picture, const double xy[2], Reading &reading) {
    const double left = std::floor(xy[0]), top = std::floor(xy[1]);
    if (!(left >= 0.0 && top >= 0.0 && left + 1.0 < picture.width() && top + 1.0 < picture.height())) return false;
    const auto x = static_cast<uint32_t>(left), y = static_cast<uint32_t>(top);
    const double u = xy[0] - left, v = xy[1] - top;
    reading = {{}, 1.0, false, u < 0.5 ? x : x + 1, v < 0.5 ? y : y + 1};
    for (uint32_t n = 0; n < 4; n++) {
        const uint32_t px = x + n % 2, py = y + n / 2;
        const double share = (n % 2 ? u : 1 - u) * (n / 2 ? v : 1 - v);
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
            own_.weights(x, y, trust_of(own_.largest(x, y)), weight);
            add(x, y, own_.light(x, y), weight);
        });
    }

    LitPicture &own() { return own_; }

    void add(LitPicture &other) {
        const PlaceMap map(own_, other);
        in_strips([&](uint32_t x, uint32_t y) {
            double xy[2];
            Reading reading;
            if (map.find(x, y, xy) && read_at(other, xy, reading) && is_alike(x, y, reading)) add(x, y, other, reading);
        });
    }

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

    bool is_alike(uint32_t x, uint32_t y, const Reading &reading) const {
        const double falloff = own_.falloff(x, y);
        for (size_t c = 0; c < own_.samples(); c++)
            if (!(std::fabs(own_.recorded(c, reading.light[c], falloff) - own_.grey(x, y, c)) <= same_grey))
                return false;
        return true;
    }

    const CorrectionKind &kind_;
    LitPicture own_;
    std::vector<Sum> sums_;
};

// Whether a picture shows any place of another one.
bool overlap(const lensprof_camera &one, const lensprof_camera &other) {
    double direction[2], xy[2];
    for (int v = 0; v <= sight_steps; v++)
        for (int u = 0; u <= sight_steps; u++)
            if (lensprof_camera_unproject(&one, u * (one.width - 1.0) / sight_steps,
                                          v * (one.height - 1.0) / sight_steps, direction)
                && lensprof_camera_project(&other, direction[0], direction[1], xy) && xy[0] >= 0.0 && xy[1] >= 0.0
                && xy[0] <= other.width - 1.0 && xy[1] <= other.height - 1.0)
                return true;
    return false;
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

void check_overlaps(const std::vector<PlacedCorrection> &all) {
    uint32_t layout = 0;
    for (const PlacedCorrection &placed : all) {
        const Picture header = read_header(placed.job.source);
        const size_t samples = lensprof_layout_samples(header.layout);
        if (samples != 1 && samples != 3)
            throw Failure(ExitCode::usage,
                          placed.job.source + ": has transparency, which a merged picture has not; remove it");
        if (&placed == &all[0]) layout = header.layout;
        if (header.layout != layout)
            throw Failure(ExitCode::usage, placed.job.source + ": is " + (samples == 1 ? "grey" : "in colour")
                                               + ", and " + all[0].job.source + " is not; merge pictures of one kind");
    }
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
        write_light(placed.job, kind, merge, progress);
        corrected.pictures.push_back(
            {{"file", placed.job.source}, {"output", placed.job.target}, {"overlapping", overlapping}});
        throughput.add_pixels(placed.job.pixels);
        throughput.add_picture();
    }
    corrected.seconds = throughput.seconds();
    corrected.megapixels = throughput.megapixels();
    if (jobs.size() > 1) progress.say("merged " + throughput.summary());
    return corrected;
}

}  // namespace lensprof
