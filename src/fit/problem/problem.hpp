// The estimation problem as flat arrays: what the solver reads, nothing it changes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <lensprof/fit.h>

#include "fit/base/constants.hpp"

namespace lensprof {

// The full shared vector: EMoR coefficients; then of each lens setting k1..k3 of up to three falloff curves, and centre
// x, y. Where one curve serves all channels it is the first. kFalloff and kCenter are those of the first setting.
constexpr int kMaxModes = LENSPROF_EMOR_MODES;
constexpr int kFalloff = kMaxModes;
constexpr int kCenter = kFalloff + 9;
constexpr int kOneSetting = kCenter + 2;          // size of the vector where there is one setting
constexpr int kSetting = kOneSetting - kFalloff;  // from one setting to the next

constexpr int falloff_column(int setting) { return kFalloff + kSetting * setting; }
constexpr int center_column(int setting) { return kCenter + kSetting * setting; }
constexpr int shared_size(int settings) { return falloff_column(settings); }

// What a column of the vector is, from kFalloff on.
struct LensColumn {
    int setting;
    int offset;  // from the setting's first: as column - kFalloff where there is one setting
    bool is_center() const { return offset >= kCenter - kFalloff; }
};
constexpr LensColumn lens_column(int column) {
    return {(column - kFalloff) / kSetting, (column - kFalloff) % kSetting};
}

constexpr double kLargestLogExposure = 20.0 * kLn2;  // 20 EV beside the reference

// Two images that share pairs, and these pairs: [first, last) of Problem::pairs.
struct Edge {
    uint32_t image[2];
    size_t first, last;
};

// Observations of a track, or tracks of a chunk: [first, last).
struct Range {
    size_t first, last;
};

// What a fit is given where scene points have tracks of observations.
struct Tracks {
    std::vector<lensprof_observation> observations;  // by point, then by image
    std::vector<Range> tracks;                       // of observations; by point
};

// Pairs [first, last), from within edge `first_edge` on, that one thread takes at a time. Chunks follow from the pairs
// alone and what they give is put together in their order: the same bytes whatever the number of threads.
struct Chunk {
    size_t first, last, first_edge;
};

struct Problem {
    int channels = 3;
    int vignettings = 1;                   // falloff curves of a setting: 1, or one per channel
    int settings = 1;                      // lens settings, each with falloff curves and a centre
    std::vector<int> setting_of;           // of each image; that of the reference is 0
    std::vector<uint32_t> setting_number;  // the caller's, of each setting here
    uint32_t reference = 0;
    uint32_t free = 0;  // LENSPROF_FREE_RESPONSE .. _CENTER
    const lensprof_fit_image *images = nullptr;
    uint32_t image_count = 0;
    std::vector<lensprof_pair> pairs;  // by edge, the lower image first, otherwise in the order given
    std::vector<Edge> edges;           // sorted by image indices
    std::vector<Chunk> chunks;
    uint32_t threads = 1;  // at most; 0 = one a core

    // Method `radiance`: tracks in place of pairs as what is minimised; pairs are then what tracks have as pairs.
    bool by_radiance = false;
    Tracks tracks;
    std::vector<Range> track_chunks;             // of tracks; as chunks
    std::vector<std::array<uint32_t, 2>> links;  // images with a track in common, sorted, the lower one first
    std::vector<uint32_t> first_link;            // of each lower image, and the end

    std::vector<uint32_t> component;  // of each image: smallest image index of its connected group

    // Unknowns of the images. Log exposure of image i in channel c: a_ic = ev_i ln 2 + ln w_ic.
    // ev_unknown[i] and balance_unknown[i][c] are columns of the image block, -1 where the value is fixed.
    std::vector<int> ev_unknown;
    std::vector<std::array<int, 3>> balance_unknown;
    int image_unknowns = 0;
    bool channels_apart = false;  // no unknown is in two channels, once the balances stand for whole log exposures

    // The columns whose sum is a_ic, -1 for none. Where the channels are apart, the column of a white balance holds
    // a_ic and not ln w_ic: then the normal equations of the channels have nothing in common.
    std::array<int, 2> columns_of(uint32_t image, int channel) const;

    uint32_t component_count() const;
    uint32_t link_of(uint32_t low, uint32_t high) const;            // number of the link between two images
    int measured_channel() const { return channels == 3 ? 1 : 0; }  // the one whose white balance factor is 1
};

// Pictures by a camera that did not move: every place is compared with itself, and the falloff cancels.
bool is_static(const Problem &problem);

// The exposure that is given for an image: each value by the image whose it shares.
lensprof_exposure given_exposure(const lensprof_fit_image *images, uint32_t i);

// Copies pairs[keep[...]] into a problem over the given images and numbers the unknowns.
Problem make_problem(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                     const lensprof_pair *pairs, const std::vector<uint32_t> &keep);

// The same over tracks[keep[...]].
Problem make_problem(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                     const Tracks &tracks, const std::vector<uint32_t> &keep);

// A response table, with a guide that shortens the search of its inverse.
struct Curve {
    static constexpr int kGuide = 1024;
    std::array<double, LENSPROF_RESPONSE_SAMPLES> table;
    std::array<uint16_t, kGuide + 1> guide;  // largest sample below each k / 1024

    void renew_guide();
    double invert(double b, double *slope) const;
};

// Falloff curves of a setting, of the channels; the first alone where one curve serves all. They share a centre.
using Falloffs = std::array<lensprof_vignetting, 3>;

// The current estimate.
struct Estimate {
    int modes = 0;            // EMoR modes in use; -1 where the response is `fixed`
    bool is_refined = false;  // and that is an estimate, too (refine.hpp)
    std::array<double, kMaxModes> emor{};
    Curve curve;                                      // f; follows emor
    lensprof_response fixed;                          // modes == -1: the response, a table where refined
    std::vector<Falloffs> vignetting{Falloffs{}};     // of each setting
    std::vector<std::array<double, 3>> log_exposure;  // a_ic
};

// An estimate that holds a model. `vignetting`: of each setting of the problem that it is for.
Estimate estimate_of(const lensprof_response &response, const std::vector<Falloffs> &vignetting,
                     const lensprof_exposure *exposures, uint32_t image_count, int channels);

// Sets emor and curve.
void set_response(Estimate &estimate, const double *emor, int modes);

// Makes the response of an estimate a table of 1024 samples, as nearly `curve` as one that rises everywhere can be.
void set_table(Estimate &estimate, const double *curve);

// Holds a response: modes is -1 then, and `curve` its table.
void set_fixed(Estimate &estimate, const lensprof_response &response);

// The curve of an estimate as a response of its own.
lensprof_response table_response(const Estimate &estimate);

// The full shared vector of an estimate, and back.
Eigen::VectorXd shared_vector(const Estimate &estimate);
void set_shared(Estimate &estimate, const Eigen::VectorXd &full, int vignettings);

// Whether the response of an estimate comes from the pairs.
inline bool fits_response(const Problem &problem, const Estimate &estimate) {
    return (problem.free & LENSPROF_FREE_RESPONSE) && (estimate.modes > 0 || estimate.is_refined);
}

// Which entries of the full shared vector are estimated.
std::vector<int> free_columns(const Problem &problem, int modes);

}  // namespace lensprof
