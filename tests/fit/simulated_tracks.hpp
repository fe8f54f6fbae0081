// Simulated tracks with a known camera: scene points seen in several images, saturated if too bright.
#pragma once

#include "core/exposure.h"
#include "simulated.hpp"

struct TrackSimulation : Simulation {
    uint32_t shortest = 2, longest = 6;  // observations per point
    double brightest = 1.0;              // radiance; with 1 almost nothing is saturated at 0 EV
    std::vector<lensprof_observation> observations;

    // `points` scene points at random places of random images, with uniform log radiance, normal noise and 8 bit
    // rounding as in Simulation. A share `outliers` of the observations shows something else. Points with fewer than
    // two measured observations are drawn again.
    void make_tracks(uint32_t points, double noise_levels, double outliers, double ev_range, uint64_t seed) {
        make(0, noise_levels, 0.0, ev_range, seed);
        uint64_t random = seed + 1000;
        for (uint32_t point = 0; point < points; point++) {
            std::vector<lensprof_observation> track;
            while (measured(track) < 2) track = draw(point, noise_levels, random);
            for (auto &o : track)
                if (lp_random(&random) < outliers)
                    for (double &v : o.value) v = lp_random(&random);
            observations.insert(observations.end(), track.begin(), track.end());
        }
    }

    static bool is_saturated(const lensprof_observation &o) {
        return std::max({o.value[0], o.value[1], o.value[2]}) > 250.0 / 255.0;
    }

    // The same without saturated observations, and without points that then have a single observation.
    std::vector<lensprof_observation> unsaturated() const {
        std::vector<lensprof_observation> kept, track;
        for (size_t i = 0; i < observations.size(); i++) {
            if (!is_saturated(observations[i])) track.push_back(observations[i]);
            if (i + 1 < observations.size() && observations[i + 1].point == observations[i].point) continue;
            if (track.size() > 1) kept.insert(kept.end(), track.begin(), track.end());
            track.clear();
        }
        return kept;
    }

private:
    static size_t measured(const std::vector<lensprof_observation> &track) {
        return track.size() - static_cast<size_t>(std::count_if(track.begin(), track.end(), is_saturated));
    }

    std::vector<lensprof_observation> draw(uint32_t point, double noise_levels, uint64_t &random) const {
        std::vector<lensprof_observation> track;
        double base = brightest * std::exp(4.5 * (lp_random(&random) - 1.0)), radiance[3];
        for (double &r : radiance) r = base * std::exp(0.6 * (lp_random(&random) - 0.5));
        uint32_t count = shortest + static_cast<uint32_t>(lp_random(&random) * (longest - shortest + 1));
        uint32_t first = static_cast<uint32_t>(lp_random(&random) * images);
        for (uint32_t n = 0; n < std::min(count, images); n++) {
            lensprof_observation o{};
            o.point = point;
            o.image = (first + n) % images;
            o.xy[0] = lp_random(&random) * (width - 1);
            o.xy[1] = lp_random(&random) * (height - 1);
            double r2 = lensprof_vignetting_r2(&falloff_of(o.image, 1), width, height, o.xy[0], o.xy[1], nullptr);
            for (uint32_t c = 0; c < 3; c++) {
                double m = lensprof_vignetting_eval(&falloff_of(o.image, c), r2, nullptr);
                double e = lp_exposure_factor(&exposures[o.image], c);
                const double light = radiance[channels == 1 ? 0 : c] * m * e;
                double b = lensprof_response_eval(&response_of(o.image), light, nullptr);
                double noisy = b + noise_levels / 255.0 * (noise_levels > 0.0 ? lp_normal(&random) : 0.0);
                o.value[c] = std::round(std::clamp(noisy, 0.0, 1.0) * 255.0 * 256.0) / (255.0 * 256.0);
                if (channels == 1) o.value[c] = o.value[0];
            }
            track.push_back(o);
        }
        return track;
    }
};

inline lensprof_fit_options radiance_fit() {
    lensprof_fit_options options = default_fit();
    options.method = LENSPROF_METHOD_RADIANCE;
    return options;
}

// A fit of tracks; everything is taken if it returns OK.
inline lensprof_status fit_into(FitRun &run, const lensprof_fit_options &options,
                                const std::vector<lensprof_fit_image> &images,
                                const std::vector<lensprof_observation> &observations, lensprof_error *error) {
    run.exposures.resize(images.size());
    lensprof_fit *fit = nullptr;
    const lensprof_status status = lensprof_fit_radiance(
        &options, images.data(), static_cast<uint32_t>(images.size()), observations.data(),
        static_cast<uint32_t>(observations.size()), nullptr, 0, run.exposures.data(), &fit, error);
    if (status == LENSPROF_OK) run.take(fit);
    return status;
}

inline FitRun run_radiance(const TrackSimulation &s, const std::vector<lensprof_observation> &observations,
                           const lensprof_fit_options &options = radiance_fit()) {
    FitRun run;
    lensprof_error error;
    const lensprof_status status = fit_into(run, options, s.fit_images, observations, &error);
    if (status != LENSPROF_OK) print_error("%s\n", error.text);
    assert_ok(status);
    return run;
}

inline FitRun run_radiance(const TrackSimulation &s, const lensprof_fit_options &options = radiance_fit()) {
    return run_radiance(s, s.observations, options);
}
