// `simulate --set moving`: the requested sequence, with automatic exposure and white balance.
#include <algorithm>
#include <cmath>

#include "cli/simulate/simulate.hpp"
#include "photo/base/library.hpp"

namespace lensprof {
namespace {

constexpr uint32_t kMeteredColumns = 16, kMeteredRows = 12;  // metering points of a picture
constexpr double kMetered = 0.2;                             // mean irradiance of all pictures, relative to white
constexpr double kStrength = 0.75;  // share of a brightness difference that automatic exposure compensates

// log2 of the mean luminance.
double metered_ev(const Truth &truth, uint32_t i) {
    const auto &camera = truth.cameras[i];
    double sum = 0.0;
    for (uint32_t v = 0; v < kMeteredRows; v++)
        for (uint32_t u = 0; u < kMeteredColumns; u++) {
            const double xy[2] = {(u + 0.5) / kMeteredColumns * camera.width - 0.5,
                                  (v + 0.5) / kMeteredRows * camera.height - 0.5};
            double rgb[3];
            moving_radiance(*truth.world, truth.pinhole, truth.poses[i], xy, rgb);
            sum += 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
        }
    return std::log2(std::max(sum / (kMeteredColumns * kMeteredRows), 1e-6));
}

// Oscillates within +-1, starting at 0.
double drift(double share, double swings, double phase) {
    return 0.5 * (std::sin(2.0 * kPi * swings * share + phase) - std::sin(phase));
}

}  // namespace

void place_moving_cameras(const SimulateOptions &o, Truth &truth) {
    truth.gloss = o.gloss.value_or(1.0);
    truth.world = make_moving_world(*o.moving, {o.seed, o.images, o.width, o.height, o.hfov, o.jitter, truth.gloss});
    truth.world_word = moving_word(*o.moving);
    truth.pinhole = pinhole_of(o.width, o.height, o.hfov);
    truth.poses = truth.world->path();
    lensprof_camera camera{};
    camera.width = o.width;
    camera.height = o.height;
    camera.hfov_deg = o.hfov;
    check(lensprof_camera_validate(&camera), "--set hfov");
    truth.cameras.assign(o.images, camera);
}

void expose_automatically(const SimulateOptions &o, Truth &truth) {
    std::vector<double> metered;
    double sum = 0.0;
    for (uint32_t i = 0; i < o.images; i++) {
        metered.push_back(metered_ev(truth, i));
        sum += metered.back();
    }
    const double mean = sum / o.images, max_correction = o.ev.value_or(kAutomaticEv), wb = o.wb.value_or(kAutomaticWb);
    Random random(o.seed * 472882027ull + 5);
    const double phase[2] = {random.uniform(0.0, 2.0 * kPi), random.uniform(0.0, 2.0 * kPi)};
    for (uint32_t i = 0; i < o.images; i++) {
        lensprof_exposure e;
        lensprof_exposure_init(&e);
        e.ev = o.mean_ev + std::log2(kMetered) - mean
               + std::clamp(kStrength * (mean - metered[i]), -max_correction, max_correction);
        const double share = static_cast<double>(i) / o.images;
        e.white_balance[0] = 1.0 + wb * drift(share, 1.3, phase[0]);
        e.white_balance[2] = 1.0 - wb * drift(share, 0.9, phase[1]);
        truth.exposures.push_back(e);
    }
}

}  // namespace lensprof
