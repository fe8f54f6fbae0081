// Simulated pairs with a known camera: the independent ground truth of the fit's tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

extern "C" {
#include "core/exposure.h"
#include "support.h"
}
#undef fail

#include <lensprof/fit.h>

struct Simulation {
    uint32_t width = 800, height = 600, images = 6, channels = 3;
    lensprof_response response;
    lensprof_vignetting vignetting{{-0.30, 0.05, -0.15}, {0.02, -0.015}};
    std::vector<lensprof_vignetting> chromatic;  // one falloff curve per channel; empty: `vignetting` for all
    std::vector<lensprof_vignetting>
        of_setting;  // falloff per lens setting; images use the settings in turn; empty: one for all
    std::vector<lensprof_response>
        of_camera;          // response per camera; images use the cameras in turn; empty: `response` for all
    double local_ev = 0.0;  // largest local tone error, EV: waves over the frame, with another phase in each image
    double frame_ev = 0.0;  // the same, but with one pattern for all images, EV
    double tilt_ev = 0.0;   // EV from the left edge of every frame to the right: accumulates over images
    uint32_t reach = 1;     // a pair's images are at most this many apart
    double shift = 0.0;     // from frame to frame, in widths: neighbouring pixels stay neighbours; 0 = random
    std::vector<lensprof_exposure> exposures;  // drawn in make() unless given
    std::vector<lensprof_fit_image> fit_images;
    std::vector<lensprof_pair> pairs;

    // Neighbouring images with random positions, uniform log radiance, normal noise in the grey value, 8 bit rounding.
    void make(uint32_t count, double noise_levels, double outliers, double ev_range, uint64_t seed) {
        uint64_t random = seed;
        bool is_given = exposures.size() == images;
        for (uint32_t i = 0; i < images; i++) {
            lensprof_exposure e;
            lensprof_exposure_init(&e);
            double draws[3] = {lp_random(&random), lp_random(&random), lp_random(&random)};
            if (i > 0) e = {ev_range * (2 * draws[0] - 1), {0.85 + 0.3 * draws[1], 1.0, 0.85 + 0.3 * draws[2]}};
            if (channels == 1) e.white_balance[0] = e.white_balance[2] = 1.0;
            if (!is_given) exposures.push_back(e);
            lensprof_fit_image image;
            lensprof_fit_image_init(&image, i, width, height);
            image.setting = of_setting.empty() ? 0 : i % static_cast<uint32_t>(of_setting.size());
            image.camera = of_camera.empty() ? 0 : i % static_cast<uint32_t>(of_camera.size());
            fit_images.push_back(image);
        }
        while (pairs.size() < count) {
            lensprof_pair pair{};
            pair.image[0] = static_cast<uint32_t>(lp_random(&random) * (images - 1));
            uint32_t apart = reach > 1 ? 1 + static_cast<uint32_t>(lp_random(&random) * reach) : 1;
            pair.image[1] = std::min(pair.image[0] + apart, images - 1);
            double base = std::exp(-4.5 + 4.5 * lp_random(&random)), radiance[3];
            for (double &r : radiance) r = base * std::exp(0.6 * (lp_random(&random) - 0.5));
            for (int side = 0; side < 2; side++) {
                pair.xy[side][0] = lp_random(&random) * (width - 1);
                pair.xy[side][1] = lp_random(&random) * (height - 1);
            }
            if (shift > 0.0) {
                pair.xy[1][0] = pair.xy[0][0] - shift * width * (pair.image[1] - pair.image[0]);
                pair.xy[1][1] = pair.xy[0][1];
                if (pair.xy[1][0] < 0.0) continue;
            }
            if (see(pair, radiance, noise_levels, random)) pairs.push_back(pair);
        }
        for (auto &pair : pairs)
            if (lp_random(&random) < outliers)
                for (double &v : pair.value[lp_random(&random) < 0.5]) v = lp_random(&random);
    }

    bool see(lensprof_pair &pair, const double radiance[3], double noise_levels, uint64_t &random) const {
        for (int side = 0; side < 2; side++) {
            const lensprof_vignetting &own = falloff_of(pair.image[side], 1);
            double r2 = lensprof_vignetting_r2(&own, width, height, pair.xy[side][0], pair.xy[side][1], nullptr);
            double local = local_factor(pair.image[side], pair.xy[side]);
            for (uint32_t c = 0; c < 3; c++) {
                double m = lensprof_vignetting_eval(&falloff_of(pair.image[side], c), r2, nullptr) * local;
                double e = lp_exposure_factor(&exposures[pair.image[side]], c);
                const double light = radiance[channels == 1 ? 0 : c] * m * e;
                double b = lensprof_response_eval(&response_of(pair.image[side]), light, nullptr);
                if (b > 250.0 / 255.0 || b < 3.0 / 255.0) return false;
                double noisy = b + noise_levels / 255.0 * (noise_levels > 0.0 ? lp_normal(&random) : 0.0);
                pair.value[side][c] = std::round(std::clamp(noisy, 0.0, 1.0) * 255.0 * 256.0) / (255.0 * 256.0);
                if (channels == 1) pair.value[side][c] = pair.value[side][0];
            }
        }
        return true;
    }

    const lensprof_response &response_of(uint32_t image) const {
        return of_camera.empty() ? response : of_camera[image % of_camera.size()];
    }
    const lensprof_vignetting &falloff_of(uint32_t image, uint32_t channel) const {
        return of_setting.empty() ? falloff(channel) : of_setting[image % of_setting.size()];
    }
    const lensprof_vignetting &falloff(uint32_t channel) const {
        return chromatic.empty() ? vignetting : chromatic[channel];
    }

    // Two waves over the width and one over the height, like local tone mapping or a falloff that is not radial.
    double local_factor(uint32_t image, const double xy[2]) const {
        constexpr double kTurn = 6.283185307179586;
        double phase = 2.4 * image, x = 2.0 * kTurn * xy[0] / width, y = kTurn * xy[1] / height;
        return std::exp2(local_ev * std::sin(x + phase) * std::cos(y + 2.0 * phase)
                         + frame_ev * std::sin(x) * std::cos(y) + tilt_ev * (xy[0] / width - 0.5));
    }

    // The exponent that pictures leave open: the slope of recovered against true exposures.
    double gamma(const std::vector<lensprof_exposure> &found) const {
        double mean = 0, true_mean = 0, cross = 0, square = 0;
        for (size_t i = 0; i < found.size(); i++)
            mean += found[i].ev / found.size(), true_mean += exposures[i].ev / found.size();
        for (size_t i = 0; i < found.size(); i++) {
            cross += (found[i].ev - mean) * (exposures[i].ev - true_mean);
            square += (exposures[i].ev - true_mean) * (exposures[i].ev - true_mean);
        }
        return square > 0 ? cross / square : 1.0;
    }

    double exposure_error(const std::vector<lensprof_exposure> &found, double g) const {
        double worst = 0;
        for (size_t i = 0; i < found.size(); i++) worst = std::max(worst, std::abs(found[i].ev / g - exposures[i].ev));
        return worst;
    }

    double falloff_error(const lensprof_vignetting &found, double g, uint32_t channel = 1) const {
        double worst = 0;
        for (int k = 0; k <= 20; k++) {
            double r2 = k * k / 400.0, m = std::max(lensprof_vignetting_eval(&found, r2, nullptr), 1e-6);
            double truth = lensprof_vignetting_eval(&falloff(channel), r2, nullptr);
            worst = std::max(worst, std::abs(std::pow(m, 1.0 / g) - truth));
        }
        return worst;
    }
};

template <class Curve>
lensprof_response table_response(Curve &&curve) {
    std::vector<double> table;
    for (int j = 0; j < 1024; j++) table.push_back(curve(j / 1023.0));
    lensprof_response response;
    assert_ok(lensprof_response_set_table(&response, table.data(), 1024));
    return response;
}

inline lensprof_response srgb_response() {
    return table_response([](double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055; });
}

inline lensprof_response linear_response() {
    return table_response([](double x) { return x; });
}

inline lensprof_response gamma_response(double gamma) {
    return table_response([=](double x) { return std::pow(x, 1.0 / gamma); });
}

// A toe and a long shoulder.
inline lensprof_response film_response() {
    return table_response([](double x) { return 1.15 * std::pow(x, 1.2) / (std::pow(x, 1.2) + 0.15); });
}

inline bool is_monotone(const lensprof_response &response) {
    for (int j = 0; j < 1023; j++)
        if (!(response.table[j + 1] > response.table[j])) return false;
    return true;
}

// A result with its first finding, which is empty if all rules hold.
struct FoundResult : lensprof_fit_result {
    lensprof_finding first;
};

// All findings on a setting.
inline std::vector<lensprof_finding> findings_of(const lensprof_fit *fit, uint32_t setting, uint32_t count) {
    std::vector<lensprof_finding> findings(count);
    for (uint32_t i = 0; i < count; i++) {
        lensprof_finding_init(&findings[i]);
        assert_ok(lensprof_fit_finding_at(fit, setting, i, &findings[i], nullptr));
    }
    return findings;
}

inline void take_setting(const lensprof_fit *fit, uint32_t setting, FoundResult &result) {
    lensprof_fit_result_init(&result);
    lensprof_finding_init(&result.first);
    assert_ok(lensprof_fit_setting_at(fit, setting, &result, nullptr));
    if (result.findings) result.first = findings_of(fit, setting, 1)[0];
}

// A fit with all its results.
struct FitRun {
    std::vector<uint64_t> memory;        // of the fit; empty: the library's
    std::shared_ptr<lensprof_fit> held;  // released before its memory
    std::vector<lensprof_exposure> exposures;
    std::vector<lensprof_fit_image_quality> quality;
    FoundResult result;                      // of the setting of the reference
    std::vector<lensprof_finding> findings;  // on it
    std::vector<FoundResult> settings;
    std::vector<lensprof_fit_camera> cameras;

    // The result of a camera's own fit.
    const FoundResult &of_camera(size_t camera) const { return settings[cameras[camera].setting]; }

    // The finding with this code, or NULL.
    const lensprof_finding *with(lensprof_reason code) const {
        for (const lensprof_finding &finding : findings)
            if (finding.code == static_cast<uint32_t>(code)) return &finding;
        return nullptr;
    }

    // Takes a fit, and asks it for everything.
    void take(lensprof_fit *fit) {
        held = {fit, lensprof_fit_destroy};
        take_setting(fit, LENSPROF_FIT_REFERENCE, result);
        findings = findings_of(fit, LENSPROF_FIT_REFERENCE, result.findings);
        settings.assign(result.setting_count, result);
        for (uint32_t s = 0; s < settings.size(); s++) take_setting(fit, s, settings[s]);
        cameras.resize(result.camera_count);
        for (uint32_t k = 0; k < cameras.size(); k++) {
            lensprof_fit_camera_init(&cameras[k]);
            assert_ok(lensprof_fit_camera_at(fit, k, &cameras[k], nullptr));
        }
        quality.resize(exposures.size());
        for (uint32_t i = 0; i < quality.size(); i++) {
            lensprof_fit_image_quality_init(&quality[i]);
            assert_ok(lensprof_fit_image_at(fit, i, &quality[i], nullptr));
        }
    }
};

// A fit of pairs; everything is taken if it returns OK.
inline lensprof_status fit_into(FitRun &run, const lensprof_fit_options &options,
                                const std::vector<lensprof_fit_image> &images, const std::vector<lensprof_pair> &pairs,
                                lensprof_error *error = nullptr) {
    run.exposures.resize(images.size());
    lensprof_fit *fit = nullptr;
    const lensprof_status status =
        lensprof_fit_overlap(&options, images.data(), static_cast<uint32_t>(images.size()), pairs.data(),
                             static_cast<uint32_t>(pairs.size()), nullptr, 0, run.exposures.data(), &fit, error);
    if (status == LENSPROF_OK) run.take(fit);
    return status;
}

inline lensprof_fit_options default_fit() {
    lensprof_fit_options options;
    lensprof_fit_options_init(&options);
    return options;
}

inline FitRun run_fit(const Simulation &s, const lensprof_fit_options &options = default_fit()) {
    FitRun run;
    lensprof_error error;
    const lensprof_status status = fit_into(run, options, s.fit_images, s.pairs, &error);
    if (status != LENSPROF_OK) print_error("%s\n", error.text);
    assert_ok(status);
    return run;
}
