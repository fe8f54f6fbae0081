// Common parts of the tests of lensprof bracket: pictures of one scene rendered through a known response, the command
// on them, and the error of its results.
#pragma once

#include "cli_runs.hpp"

#include "photo/pictures/metadata.hpp"

namespace bracket_runs {

using namespace cli_runs;

constexpr uint32_t frame_width = 240, frame_height = 180;

inline double srgb(double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055; }

// Log2 radiance over about nine EV: slow waves, with a different colour at every place.
inline double scene_ev(uint32_t number, uint32_t x, uint32_t y, uint32_t c) {
    const double u = x / 60.0 + 3.0 * number, v = y / 45.0 - 2.0 * number;
    return -4.0 + 3.2 * sin(u + 0.6 * cos(v)) + 1.2 * cos(1.7 * v + u) + 0.5 * sin(0.9 * u + 2.1 * c);
}

struct Shot {
    double ev = 0.0;
    uint32_t scene = 0;
    uint32_t sample = LENSPROF_SAMPLE_U8, layout = LENSPROF_LAYOUT_RGB;
    double noise = 1.0;  // levels of 255; white stays white
    uint32_t width = frame_width, height = frame_height;
    std::function<double(double)> response = srgb;
    double waves_ev = 0.0;  // of light that varies over the frame, with another pattern in each picture
};

inline void save_shot(const std::string &path, const Shot &shot) {
    Picture picture;
    picture.width = picture.frame_width = shot.width;
    picture.height = picture.frame_height = shot.height;
    picture.sample = shot.sample;
    picture.layout = shot.layout;
    const uint32_t channels = lensprof_layout_samples(shot.layout);
    picture.row_bytes = shot.width * channels * lensprof_sample_type_bytes(shot.sample);
    picture.pixels.resize(picture.row_bytes * shot.height);
    uint64_t random = 7 + uint64_t(1000.0 * (shot.ev + 64.0));
    const auto put = [&](size_t at, double value) {
        if (shot.sample == LENSPROF_SAMPLE_U8)
            picture.pixels[at] = uint8_t(std::lround(255.0 * value));
        else
            reinterpret_cast<uint16_t *>(picture.pixels.data())[at] = uint16_t(std::lround(65535.0 * value));
    };
    for (uint32_t y = 0; y < shot.height; ++y)
        for (uint32_t x = 0; x < shot.width; ++x)
            for (uint32_t c = 0; c < channels; ++c) {
                const double wave = shot.waves_ev * sin(x / 20.0 + 2.4 * shot.ev) * cos(y / 28.0 + 1.3 * shot.ev);
                const double light = std::exp2(scene_ev(shot.scene, x, y, c) + shot.ev + wave);
                const double grain = shot.noise / 255.0 * lp_normal(&random);
                const double value = light >= 1.0 ? 1.0 : std::clamp(shot.response(light) + grain, 0.0, 1.0);
                put((size_t(y) * shot.width + x) * channels + c, value);
            }
    write_picture(path, picture);
}

inline std::string shot_name(size_t i) { return work("shot" + std::to_string(i) + ".png"); }

// One picture per exposure; `like` gives the other properties.
inline Words shots(const std::vector<double> &evs, Shot like = {}) {
    Words files;
    for (double ev : evs) {
        files.push_back(shot_name(files.size()));
        like.ev = ev;
        save_shot(files.back(), like);
    }
    return files;
}

// Writes the metadata that the camera stores next to the picture.
inline void state_exposure(const std::string &path, double ev, bool camera = true) {
    PictureMetadata metadata = unknown_metadata();
    if (camera) {
        strcpy(metadata.key.camera_maker, "Maker");
        strcpy(metadata.key.camera_model, "Camera");
        strcpy(metadata.key.lens, "Lens");
        metadata.key.focal_mm = 50.0;
    }
    metadata.key.aperture = metadata.f_number.emplace(4.0);
    metadata.iso = 100.0;
    metadata.exposure_time_s = std::exp2(ev);
    assert_true(write_metadata(path, metadata));
}

inline const Words no_store = {"--no-store", "--json", "--fit", "pairs=4000"};

inline Words bracket(const Words &files, const Words &more = no_store) { return Words{"bracket"} + files + more; }

inline std::string list_of(const std::vector<double> &values) {
    std::string text;
    for (double value : values) text += (text.empty() ? "" : ",") + std::to_string(value);
    return text;
}

inline const std::vector<double> three = {2.0, 0.0, -2.0}, five = {3.0, 1.5, 0.0, -1.5, -3.0};

inline double found_ev(const Json &json, size_t i) { return json["images"][i]["ev"].get<double>(); }

// Slope of the recovered against the true exposures, gamma; `worst` receives the largest deviation from it.
inline double slope(const Json &json, const std::vector<double> &truth, double &worst) {
    double cross = 0.0, square = 0.0, mean = 0.0, true_mean = 0.0;
    for (size_t i = 0; i < truth.size(); ++i)
        mean += found_ev(json, i) / double(truth.size()), true_mean += truth[i] / double(truth.size());
    for (size_t i = 0; i < truth.size(); ++i) {
        cross += (found_ev(json, i) - mean) * (truth[i] - true_mean);
        square += (truth[i] - true_mean) * (truth[i] - true_mean);
    }
    const double gamma = cross / square;
    worst = 0.0;
    for (size_t i = 0; i < truth.size(); ++i)
        worst = std::max(worst, std::fabs((found_ev(json, i) - mean) / gamma - (truth[i] - true_mean)));
    return gamma;
}

// Root mean square difference of two responses, levels of 255, after removing scale and the exponent gamma.
inline double response_error(const Json &json, double gamma, const std::function<double(double)> &truth) {
    const auto values = json["response"]["values"][0].get<std::vector<double>>();
    assert_int_equal(values.size(), 1024);
    double best = 255.0;
    for (double scale = 0.6; scale < 1.7; scale += 0.004) {
        double sum = 0.0;
        int count = 0;
        for (size_t j = 1; j < 1023; ++j) {
            const double light = scale * std::pow(double(j) / 1023.0, 1.0 / gamma);
            if (values[j] > 250.0 / 255.0 || light > 1.0) continue;
            sum += std::pow(255.0 * (values[j] - truth(light)), 2);
            ++count;
        }
        if (count > 500) best = std::min(best, std::sqrt(sum / count));
    }
    return best;
}

inline double heldout(const Json &json) { return json["residual"]["heldout_rms"].get<double>(); }

inline void assert_rises(const Json &json) {
    const auto values = json["response"]["values"][0].get<std::vector<double>>();
    for (size_t j = 1; j < values.size(); ++j) assert_true(values[j] > values[j - 1]);
}

// Checks that exposures and response are correct except for gamma; returns gamma.
inline double assert_recovered(const Json &json, const std::vector<double> &truth, double levels,
                               const std::function<double(double)> &response = srgb) {
    if (!json["usable"].get<bool>()) fail_msg("not usable: %s", text_of(json).c_str());
    double worst;
    const double gamma = slope(json, truth, worst), error = response_error(json, gamma, response);
    if (worst > 0.05 || error > levels)
        fail_msg("exposures are off by %.3f EV, the response by %.2f levels", worst, error);
    assert_rises(json);
    return gamma;
}

}  // namespace bracket_runs
