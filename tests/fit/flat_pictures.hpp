// Simulated pictures of an evenly lit card: the core's own model, a light with a gradient, noise and defects.
#pragma once

#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <vector>

extern "C" {
#include "support.h"
}
#undef fail

#include <lensprof/flat.h>

// A disturbance in addition to falloff and light: a factor of the light at a pixel and channel.
using Defect = std::function<double(double x, double y, uint32_t channel)>;

// Standard normal numbers, drawn once.
inline const std::vector<double> &normal_numbers() {
    static const std::vector<double> numbers = [] {
        std::vector<double> drawn(1 << 16);
        uint64_t random = 11;
        for (double &n : drawn) n = lp_normal(&random);
        return drawn;
    }();
    return numbers;
}

// A result with its first finding, which is empty if all rules hold.
struct FoundFlat : lensprof_flat_result {
    lensprof_finding first;
    std::vector<lensprof_finding> all;  // findings

    // The finding with this code, or NULL.
    const lensprof_finding *with(lensprof_reason code) const {
        for (const lensprof_finding &finding : all)
            if (finding.code == static_cast<uint32_t>(code)) return &finding;
        return nullptr;
    }
};

inline void take_flat(const lensprof_flat *flat, FoundFlat &result) {
    lensprof_flat_result_init(&result);
    lensprof_finding_init(&result.first);
    assert_ok(lensprof_flat_get(flat, &result, nullptr));
    result.all.resize(result.findings);
    for (uint32_t i = 0; i < result.findings; i++) {
        lensprof_finding_init(&result.all[i]);
        assert_ok(lensprof_flat_finding_at(flat, i, &result.all[i], nullptr));
    }
    if (result.findings) result.first = result.all[0];
}

struct FlatPictures {
    uint32_t width = 600, height = 450, channels = 3;
    uint32_t sample = LENSPROF_SAMPLE_U16;
    lensprof_vignetting vignetting[3];
    lensprof_response response;
    double gradient[2] = {0.0, 0.0};  // of the light's logarithm per half diagonal, to the right and down in the scene
    double bend = 0.0;                // added to that logarithm, per square of its slope
    double level = 0.5;               // light at the centre at 0 EV
    double noise = 0.004;             // standard deviation, in grey values
    uint64_t seed = 1;
    Defect defect;             // may be empty
    lensprof_levels levels{};  // of the samples
    std::vector<std::unique_ptr<std::vector<uint8_t>>> data;
    std::vector<lensprof_flat_image> images;

    FlatPictures() {
        for (auto &v : vignetting) v = {{-0.45, 0.12, -0.06}, {0.0, 0.0}};
        lensprof_response_set_linear(&response);
    }

    void set_center(double x, double y) {
        for (auto &v : vignetting) v.center[0] = x, v.center[1] = y;
    }

    // The falloff is one of the radius, half diagonals from a centre.
    void set_falloff(double center_x, double center_y, const std::function<double(double r)> &m) {
        const double half = 0.5 * std::hypot(width, height), w = width, h = height;
        for (auto &v : vignetting) v = {{0.0, 0.0, 0.0}, {0.0, 0.0}};
        defect = [=](double x, double y, uint32_t) {
            return m(std::hypot((x - 0.5 * (w - 1.0)) / half - center_x, (y - 0.5 * (h - 1.0)) / half - center_y));
        };
    }

    // The light that reaches a pixel, falloff included.
    double light(double x, double y, uint32_t channel, double rotation_deg) const {
        double half = 0.5 * std::hypot(width, height), turn = rotation_deg * 3.14159265358979 / 180.0;
        double dx = (x - 0.5 * (width - 1.0)) / half, dy = (y - 0.5 * (height - 1.0)) / half;
        double qx = std::cos(turn) * dx - std::sin(turn) * dy, qy = std::sin(turn) * dx + std::cos(turn) * dy;
        double m = lensprof_vignetting_eval(
            &vignetting[channel], lensprof_vignetting_r2(&vignetting[channel], width, height, x, y, nullptr), nullptr);
        const double slope = gradient[0] * qx + gradient[1] * qy;
        return level * m * std::exp(slope + bend * slope * slope) * (defect ? defect(x, y, channel) : 1.0);
    }

    void put(uint8_t *at, double value) const {
        if (sample == LENSPROF_SAMPLE_U8) {
            *at = static_cast<uint8_t>(std::lround(255.0 * std::fmin(std::fmax(value, 0.0), 1.0)));
        } else if (sample == LENSPROF_SAMPLE_U16) {
            auto v = static_cast<uint16_t>(std::lround(65535.0 * std::fmin(std::fmax(value, 0.0), 1.0)));
            std::memcpy(at, &v, sizeof v);
        } else {
            auto v = static_cast<float>(value);
            std::memcpy(at, &v, sizeof v);
        }
    }

    // Takes a picture; `shot` as in lensprof_flat_image.
    lensprof_flat_image &shoot(uint32_t shot, double ev = 0.0, double rotation_deg = 0.0) {
        const uint32_t bytes = lensprof_sample_type_bytes(sample);
        data.push_back(std::make_unique<std::vector<uint8_t>>(static_cast<size_t>(width) * height * channels * bytes));
        uint8_t *at = data.back()->data();
        const std::vector<double> &normals = normal_numbers();
        uint64_t random = seed * 1000003 + images.size() * 7919;
        for (uint32_t y = 0; y < height; y++)
            for (uint32_t x = 0; x < width; x++)
                for (uint32_t c = 0; c < channels; c++, at += bytes) {
                    double irradiance = light(x, y, c, rotation_deg) * std::exp2(ev);
                    random = random * 6364136223846793005ull + 1442695040888963407ull;
                    const double grey =
                        lensprof_response_eval(&response, irradiance, nullptr) + noise * normals[random >> 48];
                    put(at, lensprof_levels_to_sample(&levels, c, grey));
                }
        lensprof_flat_image image;
        lensprof_flat_image_init(&image);
        image.view = {data.back()->data(),
                      static_cast<ptrdiff_t>(width) * channels * bytes,
                      width,
                      height,
                      sample,
                      channels == 3 ? LENSPROF_LAYOUT_RGB : LENSPROF_LAYOUT_GREY};
        image.width = width, image.height = height, image.reduction = 1;
        image.shot = shot, image.ev = ev, image.rotation_deg = rotation_deg;
        image.black = 0.01, image.white = 0.98;
        images.push_back(image);
        return images.back();
    }

    lensprof_flat_options options() const {
        lensprof_flat_options o;
        lensprof_flat_options_init(&o);
        o.channels = channels;
        o.response = &response;
        return o;
    }

    // The fit, which must succeed.
    std::unique_ptr<FoundFlat> fit(const lensprof_flat_options &o,
                                   lensprof_flat_image_quality *quality = nullptr) const {
        auto result = std::make_unique<FoundFlat>();
        lensprof_error error;
        lensprof_flat *flat = nullptr;
        const auto count = static_cast<uint32_t>(images.size());
        const lensprof_status status = lensprof_fit_flat(&o, images.data(), count, nullptr, 0, &flat, &error);
        if (status != LENSPROF_OK) print_error("%s: %s\n", lensprof_status_name(status), error.text);
        assert_int_equal(status, LENSPROF_OK);
        take_flat(flat, *result);
        for (uint32_t i = 0; i < count && quality; i++) {
            lensprof_flat_image_quality_init(&quality[i]);
            assert_ok(lensprof_flat_image_at(flat, i, &quality[i], &error));
        }
        lensprof_flat_destroy(flat);
        return result;
    }
};

// M times grid of a result at a place, relative to that in the middle of the frame.
inline double found_falloff(const lensprof_flat_result &r, const FlatPictures &p, double x, double y, uint32_t c = 1) {
    const auto at = [&](double px, double py) {
        const double r2 = lensprof_vignetting_r2(&r.vignetting[c], p.width, p.height, px, py, nullptr);
        const double m = lensprof_vignetting_eval(&r.vignetting[c], r2, nullptr);
        return r.gain_grid.columns ? m * lensprof_gain_grid_eval(&r.gain_grid, p.width, p.height, px, py, c) : m;
    };
    return at(x, y) / at(0.5 * (p.width - 1.0), 0.5 * (p.height - 1.0));
}

// Half diagonals from the middle of the frame.
inline double radius_at(const FlatPictures &p, double x, double y) {
    return std::hypot(x - 0.5 * (p.width - 1.0), y - 0.5 * (p.height - 1.0)) / (0.5 * std::hypot(p.width, p.height));
}

// Largest difference of a result from the light of its pictures, within a radius.
inline double largest_error(const lensprof_flat_result &r, const FlatPictures &p, double radius = 2.0) {
    const double middle = p.light(0.5 * (p.width - 1.0), 0.5 * (p.height - 1.0), 1, 0.0);
    double worst = 0.0;
    for (uint32_t i = 0; i < 900; i++) {
        const double x = (i % 30) * (p.width - 1.0) / 29.0, y = (i / 30) * (p.height - 1.0) / 29.0;
        if (radius_at(p, x, y) > radius) continue;
        worst = std::fmax(worst, std::fabs(found_falloff(r, p, x, y) - p.light(x, y, 1, 0.0) / middle));
    }
    return worst;
}

// The same relative to the light of the place, also between the nodes of a gain grid.
inline double largest_share(const lensprof_flat_result &r, const FlatPictures &p) {
    const double middle = p.light(0.5 * (p.width - 1.0), 0.5 * (p.height - 1.0), 1, 0.0);
    double worst = 0.0;
    for (uint32_t i = 0; i < 97 * 65; i++) {
        const double x = (i % 97) * (p.width - 1.0) / 96.0, y = (i / 97) * (p.height - 1.0) / 64.0;
        worst = std::fmax(worst, std::fabs(found_falloff(r, p, x, y) * middle / p.light(x, y, 1, 0.0) - 1.0));
    }
    return worst;
}

// Largest difference between two falloffs over the frame.
inline double falloff_error(const lensprof_vignetting &a, const lensprof_vignetting &b, uint32_t width,
                            uint32_t height) {
    double worst = 0.0;
    for (uint32_t i = 0; i < 400; i++) {
        double x = (i % 20) * (width - 1.0) / 19.0, y = (i / 20) * (height - 1.0) / 19.0;
        double ma = lensprof_vignetting_eval(&a, lensprof_vignetting_r2(&a, width, height, x, y, nullptr), nullptr);
        double mb = lensprof_vignetting_eval(&b, lensprof_vignetting_r2(&b, width, height, x, y, nullptr), nullptr);
        worst = std::fmax(worst, std::fabs(ma - mb));
    }
    return worst;
}

// The same for a result: its worst channel.
inline double error_of(const lensprof_flat_result &r, const FlatPictures &p) {
    double worst = 0.0;
    for (int c = 0; c < 3; c++)
        worst = std::fmax(worst, falloff_error(r.vignetting[c], p.vignetting[c], p.width, p.height));
    return worst;
}
