// The estimation problem as flat arrays: what the solver reads, nothing it changes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <lensprof/fit.h>

namespace lensprof {

constexpr int kMaxModes = LENSPROF_EMOR_MODES;
constexpr int kMaxShared = kMaxModes + 5;  // EMoR coefficients, k1..k3, centre x, y

// Two images that share pairs.
struct Edge {
    uint32_t image[2];
};

struct Problem {
    int channels = 3;
    uint32_t reference = 0;
    uint32_t free = 0;  // LENSPROF_FREE_RESPONSE .. _CENTER
    const lensprof_fit_image *images = nullptr;
    uint32_t image_count = 0;
    std::vector<lensprof_pair> pairs;
    std::vector<uint32_t> edge_of_pair;
    std::vector<Edge> edges;         // sorted by image indices
    std::vector<uint32_t> component; // of each image: smallest image index of its connected group

    // Unknowns of the images. Log exposure of image i in channel c: a_ic = ev_i ln 2 + ln w_ic.
    // ev_unknown[i] and balance_unknown[i][c] are columns of the image block, -1 where the value is fixed.
    std::vector<int> ev_unknown;
    std::vector<std::array<int, 3>> balance_unknown;
    int image_unknowns = 0;

    uint32_t component_count() const;
};

// Copies pairs[keep[...]] into a problem over the given images and numbers the unknowns.
Problem make_problem(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                     const lensprof_pair *pairs, const std::vector<uint32_t> &keep);

// The current estimate.
struct Estimate {
    int modes = 0;                                        // EMoR modes in use; -1 where the response is fixed
    std::array<double, kMaxModes> emor{};
    std::array<double, LENSPROF_RESPONSE_SAMPLES> table;  // f on the grid; follows emor
    lensprof_response fixed;                              // modes == -1: the response
    lensprof_vignetting vignetting{};
    std::vector<std::array<double, 3>> log_exposure;      // a_ic
};

// Sets emor and table.
void set_response(Estimate &estimate, const double *emor, int modes);

}  // namespace lensprof
