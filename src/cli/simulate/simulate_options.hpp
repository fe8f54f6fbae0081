// The options of `lensprof simulate`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <lensprof/lensprof.h>

#include "cli/program/options.hpp"
#include "cli/simulate/moving.hpp"
#include "cli/simulate/simulated_scene.hpp"

namespace lensprof {

// Format of the pictures.
struct SimulateFormat {
    const char *extension;
    uint32_t sample;
};

struct SimulateOptions {
    std::string output;
    lensprof_response response;
    std::vector<SimulateFormat> formats = {{".png", LENSPROF_SAMPLE_U8}};
    SimulatedKind scene = SimulatedKind::landscape;
    std::optional<MovingKind> moving;  // empty: the camera turns
    uint32_t images = 6, rows = 1, seed = 1, points = 0, test_points = 0, width = 800, height = 600;
    double hfov = 50, overlap = 0.4, jitter = 1, mean_ev = 0, clip = 0, noise = 2, outliers = 0, misalign = 0,
           parallax = 0, objects = 0, local_tone = 0, sharpen = 0, exif_rounding = 0, exif_scatter = 0;
    std::vector<double> vignetting{-0.30, 0.05, -0.15}, center{0.02, -0.015};
    std::optional<double> ev,
        wb;                       // ranges of exposures, EV, and of white balance factors about 1; defaults below
    std::optional<double> gloss;  // default 1
    bool no_images = false, exif = false, exif_manual = false, progress = false;
};

constexpr double kRandomEv = 1.0, kRandomWb = 0.15;         // camera that turns
constexpr double kAutomaticEv = 0.75, kAutomaticWb = 0.06;  // moving

void declare_simulate_options(Command &command, SimulateOptions &options);

// Failure (usage) for conflicting options.
void check_simulate_options(const SimulateOptions &options);

}  // namespace lensprof
