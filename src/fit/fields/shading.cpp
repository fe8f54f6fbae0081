#include "fit/fields/shading.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "fit/base/parallel.hpp"
#include "fit/fields/descent.hpp"
#include "fit/fields/errors.hpp"
#include "fit/fields/heldout.hpp"

namespace lensprof {
namespace {

constexpr size_t kStartPictures = 48;  // that the beginnings are tried on,
constexpr int kStartNodes = 12;        // with a surface of so many nodes
constexpr double kStartShares[] = {0.15, 0.5, 0.85};
constexpr double kStartOffsets[] = {0.0, 0.5, 0.8, 0.95};  // of the lowest value
constexpr int kStartSteps = 24, kFixedSteps = 4;           // the offset is held in the first ones
constexpr int kRounds = 3, kRoundSteps = 50;               // between choices of the smoothness
constexpr double kConverged = 5e-6;                        // rms change of ln S in a step
constexpr int kCoarseNodes = 12;                           // of a surface that scenes have more detail than
constexpr Smoothness kCoarse = {2, 1e-6};
constexpr size_t kGroups = 10;                // of held-out pictures
constexpr double kLargestOffsetSigma = 0.25;  // of the light: beyond it the offset is not determined

// Every k-th picture, so many that none of the starts takes long.
FieldData some_of(const FieldData &data) {
    FieldData some;
    some.pictures = std::min(data.pictures, kStartPictures), some.cells = data.cells;
    for (size_t i = 0; i < some.pictures; i++) {
        const float *first = data.picture(i * data.pictures / some.pictures);
        some.value.insert(some.value.end(), first, first + data.cells);
    }
    return some;
}

double lowest_of(const FieldData &data) {
    float lowest = INFINITY;
    for (float value : data.value)
        if (value < lowest) lowest = value;
    return static_cast<double>(lowest);
}

struct Start {
    double offset, share;
};

std::vector<Start> starts_of(const FieldData &data, const std::optional<double> &offset) {
    std::vector<Start> starts;
    for (double share : kStartShares) {
        if (offset)
            starts.push_back({*offset, share});
        else
            for (double part : kStartOffsets) starts.push_back({part * std::max(lowest_of(data), 0.0), share});
    }
    return starts;
}

// Whether the pictures determine the offset of a beginning: it does not lie on a limit, and its error is small.
bool is_determined(const Descent &descent) {
    return !descent.is_at_limit() && descent.offset_step().sigma < kLargestOffsetSigma * descent.light();
}

// Follows several beginnings for some steps.
std::vector<Descent> followed(const FieldData &data, const Surface &surface, const std::vector<Start> &starts,
                              bool moves_offset, uint32_t threads, const FieldStep &step) {
    std::vector<Descent> all(starts.size(), Descent(data, surface));
    const bool is_complete = for_each_parallel(
        static_cast<uint32_t>(starts.size()), threads,
        [&](uint32_t i) {
            all[i].start(starts[i].offset, starts[i].share);
            for (int k = 0; k < kStartSteps; k++) {
                all[i].step(moves_offset && k >= kFixedSteps);
                if (k == kStartSteps / 2) all[i].search_levels();
            }
        },
        step);
    if (!is_complete) throw Cancelled();
    return all;
}

struct Beginning {
    Descent descent;
    double share;
};

// The beginning with the lowest cost; NULL if an offset is to be found and none determines it.
std::unique_ptr<Beginning> best_of(const FieldData &data, const Surface &surface, const std::optional<double> &offset,
                                   uint32_t threads, const FieldStep &step) {
    const std::vector<Start> starts = starts_of(data, offset);
    const std::vector<Descent> all = followed(data, surface, starts, !offset, threads, step);
    size_t best = all.size();
    for (size_t i = 0; i < all.size(); i++)
        if ((offset || is_determined(all[i])) && (best == all.size() || all[i].cost() < all[best].cost())) best = i;
    if (best == all.size()) return nullptr;
    return std::make_unique<Beginning>(Beginning{all[best], starts[best].share});
}

// Steps until the shading stays, at most kRoundSteps.
void follow(Descent &descent, bool moves_offset, const FieldStep &step, Shading &found) {
    found.converged = false;
    for (int k = 0; k < kRoundSteps && !found.converged; k++) {
        if (step()) throw Cancelled();
        descent.step(moves_offset);
        found.iterations++;
        found.converged = descent.change < kConverged;
    }
}

struct Refinement {
    bool moves_offset;
    uint32_t threads;
};

// Steps, and choices of the smoothness between them.
void refine(Descent &descent, const Surface &surface, size_t groups, const Refinement &how, const FieldStep &step,
            Shading &found) {
    for (int round = 0; round < kRounds; round++) {
        follow(descent, how.moves_offset, step, found);
        const Heldout heldout = hold_out(descent, surface, groups, how.threads);
        found.heldout = heldout.rms, found.heldout_rms = heldout.best_rms, found.even_rms = heldout.even_rms;
        found.smoothness_index = heldout.best_index;
        descent.smoothness = heldout.best;
    }
    follow(descent, how.moves_offset, step, found);
}

// Mean square of what a surface of few nodes leaves of ln S.
double fine_variance(const Descent &descent, const Surface &surface) {
    const Surface coarse(surface.grid(), kCoarseNodes);
    std::vector<double> nodes;
    if (!coarse.fit(std::vector<double>(descent.cells.size(), 1.0), descent.cells, kCoarse, nodes)) return 0.0;
    const std::vector<double> smooth = coarse.at_cells(nodes);
    double sum = 0.0;
    for (size_t j = 0; j < smooth.size(); j++) sum += (descent.cells[j] - smooth[j]) * (descent.cells[j] - smooth[j]);
    return sum / static_cast<double>(smooth.size());
}

// Chance, what the smoothness removed, and what no surface describes: independent of each other.
void report_errors(const Descent &descent, const Surface &surface, const Refits &refits, const FieldStep &step,
                   Shading &found) {
    const FieldErrors chance = jackknife(descent, refits, step);
    const double bias = smoothing_bias(descent, surface, refits.groups) + descent.variance().common;
    found.error = std::sqrt(chance.shading * chance.shading + bias);
    found.offset_sigma = std::max(descent.offset_step().sigma, chance.offset);
}

void report(const Descent &descent, const Surface &surface, Shading &found) {
    found.offset = descent.offset;
    found.level = descent.level, found.nodes = descent.nodes, found.cells = descent.cells;
    found.seen = descent.sums(1)[0].weight;
    found.smoothness = descent.smoothness;
    const Descent::Variance variance = descent.variance();
    const double fine = variance.common + fine_variance(descent, surface);
    found.pattern = std::sqrt(fine), found.pattern_share = fine / std::max(fine + variance.own, 1e-300);
    found.content_sigma = descent.content.narrowest_sigma();
    found.background_share = descent.content.narrowest_share();
}

}  // namespace

Shading fit_shading(const FieldData &data, const Surface &surface, std::optional<double> offset, uint32_t threads,
                    const FieldStep &step) {
    const FieldData some = some_of(data);
    const size_t groups = std::min(kGroups, data.pictures);
    Shading found;
    const Surface coarse(surface.grid(), kStartNodes);
    std::unique_ptr<Beginning> first = best_of(some, coarse, offset, threads, step);
    if (!first) first = best_of(some, coarse, 0.0, threads, step);  // where the offset may still move
    Descent descent(data, surface);
    descent.start_from(first->descent, first->share);
    refine(descent, surface, groups, {!offset, threads}, step, found);
    found.is_offset_found = !offset && is_determined(descent);
    if (!offset && !found.is_offset_found) {
        first = best_of(some, coarse, 0.0, threads, step);
        descent.start_from(first->descent, first->share);
        refine(descent, surface, groups, {false, threads}, step, found);
    }
    report(descent, surface, found);
    report_errors(descent, surface, {groups, !offset, threads}, step, found);
    return found;
}

}  // namespace lensprof
