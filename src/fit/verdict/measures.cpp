#include "fit/verdict/measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/covariance.h"
#include "falloff/rise.hpp"
#include "fit/base/constants.hpp"
#include "fit/base/quantile.hpp"
#include "fit/verdict/held_balance.hpp"
#include "fit/verdict/limits.hpp"
#include "fit/verdict/quality.hpp"

namespace lensprof {
namespace {

constexpr double kBlack = 0.004;  // one level of 255
constexpr Measured kNotMeasured{};

// Counts informative pairs: different from each other, with both grey values of a channel between black and white.
size_t count_informative(const Problem &problem) {
    std::vector<std::array<double, 10>> seen;
    for (const auto &p : problem.pairs) {
        bool is_informative = false;
        for (int c = 0; c < problem.channels; c++)
            is_informative = is_informative
                             || (std::min(p.value[0][c], p.value[1][c]) > kBlack
                                 && std::max(p.value[0][c], p.value[1][c]) < 1.0 - kBlack);
        if (!is_informative) continue;
        seen.push_back({p.xy[0][0], p.xy[0][1], p.xy[1][0], p.xy[1][1]});
        for (size_t c = 0; c < static_cast<size_t>(problem.channels); c++)
            seen.back()[4 + c] = p.value[0][c], seen.back()[7 + c] = p.value[1][c];
    }
    std::sort(seen.begin(), seen.end());
    return static_cast<size_t>(std::unique(seen.begin(), seen.end()) - seen.begin());
}

// The number of pair ends in a bin that counts as "a few".
uint32_t few_pair_ends(const FitResult &r) { return 2 + r.pairs / 1000; }

// Whether a tenth of the grey values holds more than a few samples.
bool is_covered(const Problem &problem, const FitResult &r, int bin) {
    return r.grey_ends[bin] > static_cast<uint32_t>(problem.channels) * few_pair_ends(r);
}

bool frees_falloff(const Problem &problem) { return problem.free & LENSPROF_FREE_FALLOFF; }

bool fits_response(const Estimate &estimate) { return estimate.modes > 0 || estimate.is_refined; }

// Outer edge of the outermost ring that holds more than a few pair ends.
double outer_radius(const FitResult &r) {
    for (int bin = LENSPROF_COVERAGE_BINS; bin > 0; bin--)
        if (r.radius_ends[bin - 1] > few_pair_ends(r)) return bin / static_cast<double>(LENSPROF_COVERAGE_BINS);
    return 0.0;
}

// Covariance of k1..k3 of a curve, with gamma held.
void covariance_held(const FitResult &r, int curve, double held[9]) {
    const uint32_t n = r.covariance_size;
    const uint32_t first = lp_covariance_index(r.response.modes, static_cast<uint32_t>(curve));
    for (uint32_t i = 0; i < 9; i++) {
        const uint32_t row = first + i / 3, column = first + i % 3;
        held[i] = r.covariance[row * n + column]
                  - r.gamma_sigma * r.gamma_sigma * r.gamma_direction[row] * r.gamma_direction[column];
    }
}

// Change of r^2 between the ends of a pair, exceeded by few pairs: a falloff is seen by nothing else.
double change_of_r2(const Problem &problem) {
    const lensprof_vignetting centred{};
    std::vector<double> changes;
    for (const lensprof_pair &pair : problem.pairs) {
        double r2[2];
        for (int side = 0; side < 2; side++) {
            const lensprof_fit_image &image = problem.images[pair.image[side]];
            r2[side] = lensprof_vignetting_r2(&centred, image.width, image.height, pair.xy[side][0], pair.xy[side][1],
                                              nullptr);
        }
        changes.push_back(std::abs(r2[0] - r2[1]));
    }
    return quantile(changes, 0.95);
}

// Levels of the residual that separate maps of each image explain, if these explain more than `share` of its variance.
Measured image_pattern(const Judged &judged, double share) {
    const double levels = judged.r.image_share > share ? judged.r.noise_levels * std::sqrt(judged.r.image_share) : 0.0;
    return of_values(levels, judged.r.image_share, levels);
}

// Whether pairs tie an image to the reference. Other images are left out (methods/group.cpp).
bool is_joined(const Problem &problem, uint32_t image) {
    return problem.component[image] == problem.component[problem.reference];
}

bool leaves_out_any(const Problem &problem, const FitResult &r) {
    return std::any_of(r.image_quality, r.image_quality + problem.image_count,
                       [](const auto &q) { return q.known_ev_left_out != 0; });
}

// For many known exposures, whose errors follow from their scatter, only steps and single errors are reported.
bool explains_known(const Judged &judged, KnownExposures::Explanation explanation) {
    const bool is_reported =
        judged.known.count <= kMany || judged.known.explanation == KnownExposures::Explanation::step;
    return is_reported && judged.known.explanation == explanation;
}

KnownExposures known_of(const Found &found, const FitResult &r) {
    const bool open = r.gamma_from == LENSPROF_GAMMA_EXPOSURES || r.gamma_from == LENSPROF_GAMMA_PRIOR;
    return compare_known(found.problem, found.estimate, open);
}

uint32_t state_of(const Found &found, const FitResult &r) {
    const Problem &problem = found.problem;
    const Estimate &estimate = found.estimate;
    const bool is_equal = is_static(problem), is_still = is_equal && (problem.free & LENSPROF_FREE_RESPONSE),
               frees_all = (estimate.modes >= 0 || estimate.is_refined)
                           && (problem.free & LENSPROF_FREE_FALLOFF) == LENSPROF_FREE_FALLOFF;
    uint32_t state = is_equal ? kStatic : kMoving;
    state |= is_still ? kStill : kNotStill;
    state |= frees_all ? kFreesAll : kHolds;
    if (fits_response(estimate)) state |= kFreesResponse;
    if (frees_falloff(problem)) state |= kFreesFalloff;
    if (problem.free & LENSPROF_FREE_CENTER) state |= kFreesCenter;
    if (problem.moving_camera) state |= kMovingCamera;
    if (leaves_out_any(problem, r)) state |= kLeavesOutKnown;
    return state;
}

}  // namespace

Judged::Judged(const Found &finished, const FitResult &result)
    : found(finished),
      r(result),
      known(known_of(finished, result)),
      state(state_of(finished, result)),
      wording(state & kStatic ? Wording::still : Wording::usual) {}

namespace measure {

Measured groups(const Judged &judged) {
    const Problem &problem = judged.problem();
    if (problem.image_unknowns == 0) return kNotMeasured;
    uint32_t image = 0;  // the first that is not joined
    while (image + 1 < problem.image_count && is_joined(problem, image)) image++;
    return of_image(of_value(judged.r.components), image);
}

Measured pairs_per_unknown(const Judged &judged) {
    const Problem &problem = judged.problem();
    const double unknowns = static_cast<double>(free_columns(problem, judged.estimate().modes).size())
                            + static_cast<double>(problem.image_unknowns),
                 informative = static_cast<double>(count_informative(problem));
    return unknowns > 0.0 ? of_values(informative * problem.channels / unknowns, informative, unknowns) : kNotMeasured;
}

Measured exposure_spread(const Judged &judged) {
    return of_value(lensprof::exposure_spread(judged.problem(), judged.estimate()));
}

Measured covered_greys(const Judged &judged) {
    double covered = 0.0;
    for (int bin = 0; bin < LENSPROF_COVERAGE_BINS; bin++) covered += is_covered(judged.problem(), judged.r, bin);
    return of_value(covered);
}

// The longest run of tenths without samples is reported.
Measured missing_greys(const Judged &judged) {
    std::pair<int, int> longest{0, 0};
    for (int bin = 0, first = 0; bin < LENSPROF_COVERAGE_BINS; bin++) {
        if (is_covered(judged.problem(), judged.r, bin))
            first = bin + 1;
        else if (bin + 1 - first > longest.second - longest.first)
            longest = {first, bin + 1};
    }
    return of_values(covered_greys(judged).value, 0.1 * longest.first, 0.1 * longest.second);
}

Measured radius_change(const Judged &judged) { return of_value(change_of_r2(judged.problem())); }

Measured covered_radius(const Judged &judged) { return of_value(outer_radius(judged.r)); }

Measured agreement(const Judged &judged) { return of_value(judged.r.inlier_share); }

// 1 if half of the held-out pairs are close all the same.
Measured still_agreement(const Judged &judged) {
    const double median = judged.r.heldout_median;
    const bool is_far = median == LENSPROF_UNKNOWN || median > kStillMedian;
    return of_value(is_far ? judged.r.inlier_share : 1.0);
}

Measured noise(const Judged &judged) { return of_value(judged.r.noise_levels); }

Measured strong_pattern(const Judged &judged) { return image_pattern(judged, kLargestImageShare); }

Measured weak_pattern(const Judged &judged) { return image_pattern(judged, kSuspiciousImageShare); }

// The oddness of the response, where the residual follows patterns as well: each alone may be a camera's.
Measured pattern_oddness(const Judged &judged) {
    Measured pattern = weak_pattern(judged);
    pattern.value = pattern.value > kWeakPattern ? response_oddness(judged).value : NAN;
    return pattern;
}

Measured frame_pattern(const Judged &judged) {
    const double share = judged.r.frame_share,
                 levels = share > kNotRadial ? judged.r.noise_levels * std::sqrt(share) : 0.0;
    return of_values(levels, share, levels);
}

Measured joined_images(const Judged &judged) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < judged.problem().image_count; i++) count += is_joined(judged.problem(), i);
    return of_values(count, count, kMovingImages);
}

Measured image_inliers(const Judged &judged) {
    const auto few = images_with_few_inliers(judged.problem(), judged.r);
    return few.empty() ? kNotMeasured : of_image(of_value(few[0].inliers), few[0].image);
}

// Of the first image with almost no pair that agrees, else of the one with the smallest share.
Measured image_agreement(const Judged &judged) {
    Measured least = kNotMeasured;
    for (uint32_t i = 0; i < judged.problem().image_count; i++) {
        const double pairs = judged.r.image_quality[i].pairs, inliers = judged.r.image_quality[i].inliers;
        if (pairs > 0.0 && !(inliers / pairs >= least.value))
            least = of_image(of_values(inliers / pairs, inliers, pairs), i);
        if (least.value < kSmallestImageShare) break;
    }
    return least;
}

// The image that disagrees most with those it overlaps. Where noise exceeds a quarter of the limit, less by that
// factor.
Measured image_residual(const Judged &judged) {
    Measured worst = kNotMeasured;
    const double scale = std::min(1.0, kInconsistentImage / (4.0 * std::max(judged.r.noise_levels, 1e-3)));
    for (uint32_t i = 0; i < judged.problem().image_count; i++) {
        const double residual = judged.r.image_quality[i].median_residual;
        if (!(scale * residual <= worst.value)) worst = of_image(of_values(scale * residual, residual, 0.0), i);
    }
    worst.count = 1;
    return worst;
}

Measured outliers(const Judged &judged) {
    return of_values(1.0 - judged.r.inlier_share, 1.0 - judged.r.inlier_share, judged.r.heldout_rms);
}

Measured heldout_rms(const Judged &judged) {
    if (judged.r.heldout_rms == LENSPROF_UNKNOWN) return kNotMeasured;
    return of_values(judged.r.heldout_rms, 1.0 - judged.r.inlier_share, judged.r.heldout_rms);
}

Measured seam(const Judged &judged) {
    if (judged.r.equalizes) return kNotMeasured;
    return of_values(judged.seam.after, judged.seam.after, judged.seam.before);
}

Measured convergence(const Judged &judged) { return {double(judged.r.converged), 1, {double(judged.r.iterations)}}; }

Measured covariance(const Judged &judged) {
    if (free_columns(judged.problem(), judged.estimate().modes).empty()) return kNotMeasured;
    return {double(judged.r.covariance_size), 0, {}};
}

// Standard error of M in the corner, with gamma held.
Measured corner_sigma(const Judged &judged) {
    double worst = 0.0;
    for (int curve = 0; curve < judged.problem().vignettings && judged.r.covariance_size; curve++) {
        double held[9];
        covariance_held(judged.r, curve, held);
        worst = std::max(worst, lp_falloff_variance(held, 3, 0, 1.0));
    }
    return of_value(std::sqrt(worst));
}

// Offset of the centre from the middle, along the axis with the larger offset.
Measured center_on_axis(const Judged &judged) {
    const double *center = judged.r.vignetting[0].center;
    return of_value(std::max(std::abs(center[0]), std::abs(center[1])));
}

Measured center_distance(const Judged &judged) {
    const double *center = judged.r.vignetting[0].center;
    return of_value(std::hypot(center[0], center[1]));
}

// The largest M of a falloff that was free, less what its standard error, with gamma held, leaves unclear.
Measured clear_rise(const Judged &judged) {
    const Problem &problem = judged.problem();
    double highest = 1.0, sigma = 0.0;
    for (int curve = 0; curve < problem.vignettings && judged.r.covariance_size && frees_falloff(problem); curve++) {
        const MAt peak = course_of(judged.r.vignetting[curve]).highest;
        if (peak.m <= highest) continue;
        double held[9];
        covariance_held(judged.r, curve, held);
        highest = peak.m, sigma = std::sqrt(std::max(0.0, lp_falloff_variance(held, 3, 0, peak.r2)));
    }
    return of_values(highest - kClearOfLimit * sigma, highest, sigma);
}

// The smallest M of the falloffs that were free.
Measured darkest(const Judged &judged) {
    double least = 1.0;
    for (int curve = 0; curve < judged.problem().vignettings; curve++)
        least = std::min(least, course_of(judged.r.vignetting[curve]).lowest.m);
    return of_value(least);
}

// The image whose exposure the pairs leave most uncertain.
Measured exposure_sigma(const Judged &judged) {
    const Problem &problem = judged.problem();
    const auto measured = static_cast<size_t>(problem.measured_channel());
    const auto &log_exposure = judged.estimate().log_exposure;
    Measured worst = kNotMeasured;
    for (uint32_t i = 0; i < problem.image_count; i++) {
        const double ev = (log_exposure[i][measured] - log_exposure[problem.reference][measured]) / kLn2,
                     sigma = ev_sigma_of_pairs(judged.r, i, ev);
        if (!(sigma <= worst.value)) worst = of_image(of_value(sigma), i);
    }
    return worst;
}

Measured held_white_balance(const Judged &judged) {
    const HeldBalance held = held_balance(judged.problem(), judged.estimate());
    return of_image(of_value(held.levels), held.image);
}

Measured known_order(const Judged &judged) {
    if (!explains_known(judged, KnownExposures::Explanation::order)) return kNotMeasured;
    return of_value(judged.known.off_ev);
}

Measured known_single(const Judged &judged) {
    if (!explains_known(judged, KnownExposures::Explanation::single_image)) return kNotMeasured;
    return of_image({std::abs(judged.known.off_ev), 1, {judged.known.off_ev}}, judged.known.image);
}

// The image whose exposure is farthest from its known one, in standard errors, of those that are left out, or else of
// all that no other finding explains.
Measured known_outlier(const Judged &judged) {
    using Explanation = KnownExposures::Explanation;
    const bool any = judged.state & kLeavesOutKnown, is_step = judged.known.explanation == Explanation::step;
    const bool is_explained =
        !any && (is_step || (judged.known.count <= kMany && judged.known.explanation != Explanation::none));
    Measured worst = kNotMeasured;
    for (uint32_t i = 0; i < judged.problem().image_count && !is_explained; i++) {
        const auto &quality = judged.r.image_quality[i];
        const lensprof_fit_image &image = judged.problem().images[i];
        if (!(image.known_ev_sigma > 0.0) || (any && !quality.known_ev_left_out)) continue;
        const double ev = -quality.known_ev_residual, off = std::abs(ev) / std::max(image.known_ev_sigma, kKnownSigma);
        if (!(off <= worst.value)) worst = of_image({off, 1, {ev}}, i);
    }
    return worst;
}

Measured known_step_up(const Judged &judged) {
    if (!explains_known(judged, KnownExposures::Explanation::step)) return kNotMeasured;
    return of_image(of_value(judged.known.off_ev), judged.known.image);
}

Measured known_step_down(const Judged &judged) {
    if (!explains_known(judged, KnownExposures::Explanation::step)) return kNotMeasured;
    return of_image({-judged.known.off_ev, 1, {judged.known.off_ev}}, judged.known.image);
}

// Not where images are left out: these are what contradicts.
Measured known_any(const Judged &judged) {
    if (!explains_known(judged, KnownExposures::Explanation::any) || (judged.state & kLeavesOutKnown))
        return kNotMeasured;
    return of_value(judged.known.off_ev);
}

// |ln| of the exponent that the exposures would need beyond the result's, where it is clear.
Measured gamma_inconsistency(const Judged &judged) {
    const double slope = std::max(judged.known.slope, 1e-3), error = std::abs(std::log(slope));
    if (judged.known.count > kMany || judged.known.explanation != KnownExposures::Explanation::none
        || judged.r.gamma_from != LENSPROF_GAMMA_EXPOSURES)
        return kNotMeasured;
    return {error > 3.0 * judged.r.gamma_sigma ? error : 0.0, 1, {1.0 / judged.known.slope}};
}

Measured response_oddness(const Judged &judged) {
    const double oddness = judged.found.gauge.oddness();
    return of_values(oddness, oddness, judged.r.gamma_sigma);
}

}  // namespace measure

std::vector<FewInliers> images_with_few_inliers(const Problem &problem, const FitResult &r) {
    std::vector<FewInliers> few;
    if (problem.image_unknowns == 0 || !r.image_quality) return few;
    auto held = static_cast<size_t>(problem.image_unknowns);
    auto owner = [&](uint32_t i) {
        return problem.ev_unknown[i] < 0 ? held : static_cast<size_t>(problem.ev_unknown[i]);
    };
    std::vector<uint32_t> inliers(held + 1, 0u);
    for (uint32_t i = 0; i < problem.image_count; i++) inliers[owner(i)] += r.image_quality[i].inliers;
    for (uint32_t i = 0; i < problem.image_count; i++)
        if (is_joined(problem, i) && inliers[owner(i)] < static_cast<uint32_t>(kMinInliers))
            few.push_back({i, inliers[owner(i)]});
    return few;
}

double ev_sigma_of_pairs(const FitResult &r, uint32_t image, double ev) {
    const double sigma = r.image_quality[image].ev_sigma, of_gamma = std::max(r.gamma_sigma, 0.0) * ev;
    return std::sqrt(std::max(0.0, sigma * sigma - of_gamma * of_gamma));
}

}  // namespace lensprof
