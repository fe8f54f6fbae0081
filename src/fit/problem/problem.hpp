// The estimation problem as flat arrays, which the solver only reads.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <lensprof/fit.h>

#include "fit/base/constants.hpp"

namespace lensprof {

// The full shared vector: EMoR coefficients, then for each lens setting k1..k3 of up to three falloff curves, and
// centre x, y. If one curve serves all channels, it is the first. kFalloff and kCenter are those of the first setting.
constexpr int kMaxModes = LENSPROF_EMOR_MODES;
constexpr int kFalloff = kMaxModes;
constexpr int kCenter = kFalloff + 9;
constexpr int kOneSetting = kCenter + 2;          // size of the vector if there is one setting
constexpr int kSetting = kOneSetting - kFalloff;  // stride from one setting to the next

constexpr int falloff_column(int setting) { return kFalloff + kSetting * setting; }
constexpr int center_column(int setting) { return kCenter + kSetting * setting; }
constexpr int shared_size(int settings) { return falloff_column(settings); }

// Meaning of a column of the vector, from kFalloff on.
struct LensColumn {
    int setting;
    int offset;  // within the setting: column - kFalloff if there is one setting
    bool is_center() const { return offset >= kCenter - kFalloff; }
};
constexpr LensColumn lens_column(int column) {
    return {(column - kFalloff) / kSetting, (column - kFalloff) % kSetting};
}

constexpr double kLargestLogExposure = 20.0 * kLn2;  // 20 EV relative to the reference

// Two images that share pairs, and these pairs: [first, last) of Problem::pairs.
struct Edge {
    uint32_t image[2];
    size_t first, last;
};

// Observations of a track, or tracks of a chunk: [first, last).
struct Range {
    size_t first, last;
};

// Input of a fit if scene points have tracks of observations.
struct Tracks {
    std::vector<lensprof_observation> observations;  // by point, then by image
    std::vector<Range> tracks;                       // ranges of observations; by point
};

// Pairs [first, last), starting within edge `first_edge`, that one thread processes as a unit. Chunks depend only on
// the pairs, and their results are combined in order: the result is the same to the byte for any number of threads.
struct Chunk {
    size_t first, last, first_edge;
};

struct Problem {
    int channels = 3;
    int vignettings = 1;                   // falloff curves of a setting: 1, or one per channel
    int settings = 1;                      // lens settings, each with falloff curves and a centre
    std::vector<int> setting_of;           // per image; that of the reference is 0
    std::vector<uint32_t> setting_number;  // the caller's number of each setting here
    uint32_t reference = 0;
    uint32_t free = 0;  // LENSPROF_FREE_RESPONSE .. _CENTER
    const lensprof_fit_image *images = nullptr;
    uint32_t image_count = 0;
    std::vector<lensprof_pair> pairs;  // by edge, the lower image first, otherwise in the order given
    std::vector<Edge> edges;           // sorted by image indices
    std::vector<Chunk> chunks;
    uint32_t threads = 1;  // at most; 0 = one per core

    // Method `radiance`: minimises tracks instead of pairs; the pairs are then those derived from the tracks.
    bool by_radiance = false;
    bool moving_camera = false;
    Tracks tracks;
    std::vector<Range> track_chunks;             // tracks per chunk
    std::vector<std::array<uint32_t, 2>> links;  // images with a track in common, sorted, the lower one first
    std::vector<uint32_t> first_link;            // index of each lower image's first link, and the end

    std::vector<uint32_t> component;  // per image: smallest image index of its connected group

    // Unknowns of the images. Log exposure of image i in channel c: a_ic = ev_i ln 2 + ln w_ic. ev_unknown[i] and
    // balance_unknown[i][c] are columns of the image block, -1 if the value is fixed.
    std::vector<int> ev_unknown;
    std::vector<std::array<int, 3>> balance_unknown;
    int image_unknowns = 0;
    bool channels_apart = false;  // no unknown affects two channels, once the balances represent whole log exposures

    // The columns whose sum is a_ic, -1 for none. If the channels are apart, the column of a white balance holds a_ic
    // and not ln w_ic; the normal equations of the channels are then independent.
    std::array<int, 2> columns_of(uint32_t image, int channel) const;

    uint32_t component_count() const;
    uint32_t link_of(uint32_t low, uint32_t high) const;            // number of the link between two images
    int measured_channel() const { return channels == 3 ? 1 : 0; }  // the channel whose white balance factor is 1
};

// Where a pair or, with tracks, an observation is in the frame of its image: one of across x across places.
uint32_t place_in_frame(const lensprof_fit_image &image, const double xy[2], int across);

// Pictures by a camera that did not move: every place is compared with itself, and the falloff cancels.
bool is_static(const Problem &problem);

// The exposure given for an image: each value is taken from the image that it is shared with.
lensprof_exposure given_exposure(const lensprof_fit_image *images, uint32_t i);

// Copies pairs[keep[...]] into a problem over the given images and numbers the unknowns.
Problem make_problem(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                     const lensprof_pair *pairs, const std::vector<uint32_t> &keep);

// The same over tracks[keep[...]].
Problem make_problem(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                     const Tracks &tracks, const std::vector<uint32_t> &keep);

// A response table, with an index that shortens the search of its inverse.
struct Curve {
    static constexpr int kGuide = 1024;
    std::array<double, LENSPROF_RESPONSE_SAMPLES> table;
    std::array<uint16_t, kGuide + 1> guide;  // largest sample below each k / 1024

    void renew_guide();
    double invert(double b, double *slope) const;
};

// Falloff curves of a setting, per channel; only the first is used if one curve serves all. They share a centre.
using Falloffs = std::array<lensprof_vignetting, 3>;

// The current estimate.
struct Estimate {
    int modes = 0;            // EMoR modes in use; -1 if the response is `fixed`
    bool is_refined = false;  // whether `fixed` is itself an estimate (refine.hpp)
    std::array<double, kMaxModes> emor{};
    Curve curve;                                      // f; derived from emor
    lensprof_response fixed;                          // modes == -1: the response, a table if refined
    std::vector<Falloffs> vignetting{Falloffs{}};     // per setting
    std::vector<std::array<double, 3>> log_exposure;  // a_ic
};

// Makes an estimate from a model. `vignetting`: for each setting of the problem.
Estimate estimate_of(const lensprof_response &response, const std::vector<Falloffs> &vignetting,
                     const lensprof_exposure *exposures, uint32_t image_count, int channels);

// Sets emor and curve.
void set_response(Estimate &estimate, const double *emor, int modes);

// Sets the response of an estimate to a table of 1024 samples, as near to `curve` as a strictly rising table can be.
void set_table(Estimate &estimate, const double *curve);

// Holds a response: sets modes to -1 and `curve` to its table.
void set_fixed(Estimate &estimate, const lensprof_response &response);

// The curve of an estimate as a separate response.
lensprof_response table_response(const Estimate &estimate);

// The full shared vector of an estimate, and back.
Eigen::VectorXd shared_vector(const Estimate &estimate);
void set_shared(Estimate &estimate, const Eigen::VectorXd &full, int vignettings);

// Whether the response of an estimate is fitted to the pairs.
inline bool fits_response(const Problem &problem, const Estimate &estimate) {
    return (problem.free & LENSPROF_FREE_RESPONSE) && (estimate.modes > 0 || estimate.is_refined);
}

// Which entries of the full shared vector are estimated.
std::vector<int> free_columns(const Problem &problem, int modes);

}  // namespace lensprof
