// The verdict: why a result is not usable, or the warning about it.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/covariance.h"
#include "falloff/rise.hpp"
#include "fit/base/constants.hpp"
#include "fit/base/quantile.hpp"
#include "fit/prior/known_exposures.hpp"
#include "fit/problem/curve_shape.hpp"
#include "fit/verdict/held_balance.hpp"
#include "fit/verdict/quality.hpp"
#include "fit/verdict/reason.hpp"

namespace lensprof {
namespace {

constexpr double kBlack = 0.004;                     // one level of 255
constexpr uint32_t kMinGreys = 4, kEnoughGreys = 8;  // tenths of the grey values that hold more than a few
constexpr double kSmallestRadius = 0.6;              // half diagonals: beyond it, k1..k3 extrapolate
constexpr double kSameView = 0.03;                   // of r^2: a corner of 70 % then changes grey values by 1 %
constexpr double kLargestNoise = 6.0;       // levels of 255: above the noise of any camera, so the model does not fit
constexpr double kLargestImageShare = 0.2;  // of residual variance explained by separate maps of each image,
constexpr double kSuspiciousImageShare = 0.1;  // and worth a warning; noise and moving things stay below
constexpr double kContradiction = 5.0;         // standard errors between an exposure and its known value
constexpr int kMany = 12;                      // known exposures
constexpr double kUnfollowed = 0.05;           // of ln gamma
constexpr double kSmallestPattern = 0.3;       // levels of 255 that are worth a warning,
constexpr double kHarmfulPattern = 0.5;        // and too much: rounding and JPEG cause less
constexpr double kStillPattern = 1.0;          // the same if no falloff can be biased
constexpr double kHarmfulStillPattern = 2.0;
constexpr double kNotRadial = 0.3;           // share explained by one map over the frame
constexpr double kLargestCornerSigma = 0.1;  // of M
constexpr uint32_t kMinInliers = 3;          // of an image: fewer agree by chance,
constexpr double kSmallestImageShare = 0.2;  // or a smaller share of its pairs
constexpr double kSmallestStillShare = 0.7;  // of all pairs, if equal places are compared,
constexpr double kStillMedian = 1.5;         // and levels of 255 that half of them exceed
constexpr double kFarCentre = 0.1;           // half diagonals: five standard errors of its prior
constexpr double kOnLimit = 0.98;            // of the largest allowed offset of the centre
constexpr double kClearOfLimit = 3.0;        // standard errors
constexpr double kOddImage = 5.0;            // levels of 255, and four times the noise

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

uint32_t covered_greys(const Problem &problem, const FitResult &r) {
    uint32_t covered = 0;
    for (int bin = 0; bin < LENSPROF_COVERAGE_BINS; bin++) covered += is_covered(problem, r, bin);
    return covered;
}

// The longest run of tenths without samples: [first, last).
std::pair<int, int> missing_greys(const Problem &problem, const FitResult &r) {
    std::pair<int, int> longest{0, 0};
    for (int bin = 0, first = 0; bin < LENSPROF_COVERAGE_BINS; bin++) {
        if (is_covered(problem, r, bin))
            first = bin + 1;
        else if (bin + 1 - first > longest.second - longest.first)
            longest = {first, bin + 1};
    }
    return longest;
}

bool frees_falloff(const Problem &problem) { return problem.free & kFalloffFlags; }

// Offset of the centre from the middle, along the axis with the larger offset, half diagonals.
double largest_offset(const lensprof_vignetting &v) { return std::max(std::abs(v.center[0]), std::abs(v.center[1])); }

bool fits_response(const Estimate &estimate) { return estimate.modes > 0 || estimate.is_refined; }

// Outer edge of the outermost ring that holds more than a few pair ends.
double covered_radius(const FitResult &r) {
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
double radius_change(const Problem &problem) {
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

// The smallest M of the falloffs that were free.
double darkest_of(const Problem &problem, const FitResult &r) {
    double darkest = 1.0;
    for (int curve = 0; curve < problem.vignettings && frees_falloff(problem); curve++)
        darkest = std::min(darkest, course_of(r.vignetting[curve]).lowest.m);
    return darkest;
}

// The largest M of a falloff that was free, and its standard error with gamma held, if it is clearly above `limit`.
std::vector<double> rise_above(double limit, const Problem &problem, const FitResult &r) {
    double highest = 1.0, sigma = 0.0;
    for (int curve = 0; curve < problem.vignettings && r.covariance_size && frees_falloff(problem); curve++) {
        const MAt peak = course_of(r.vignetting[curve]).highest;
        if (peak.m <= highest) continue;
        double held[9];
        covariance_held(r, curve, held);
        highest = peak.m, sigma = std::sqrt(std::max(0.0, lp_falloff_variance(held, 3, 0, peak.r2)));
    }
    if (highest - kClearOfLimit * sigma > limit) return {highest, sigma};
    return {};
}

// Standard error of M in the corner, with gamma held.
double corner_sigma(const Problem &problem, const FitResult &r) {
    double worst = 0.0;
    for (int curve = 0; curve < problem.vignettings && r.covariance_size; curve++) {
        double held[9];
        covariance_held(r, curve, held);
        worst = std::max(worst, lp_falloff_variance(held, 3, 0, 1.0));
    }
    return std::sqrt(worst);
}

// The image that disagrees most with those it overlaps, if the disagreement is clear; else -1.
int odd_image(const Problem &problem, const FitResult &r) {
    int worst = -1;
    double limit = std::max(kOddImage, 4.0 * r.noise_levels);
    for (uint32_t i = 0; i < problem.image_count && r.image_quality; i++)
        if (r.image_quality[i].median_residual > limit) {
            limit = r.image_quality[i].median_residual;
            worst = static_cast<int>(i);
        }
    return worst;
}

// The image whose exposure the pairs leave most uncertain, if by more than `limit` EV; else -1.
int uncertain_image(const Problem &problem, const Estimate &estimate, const FitResult &r, double &limit) {
    int worst = -1;
    limit = kLargestEvSigma;
    for (uint32_t i = 0; i < problem.image_count && r.image_quality; i++) {
        auto measured = static_cast<size_t>(problem.measured_channel());
        double log_ratio = estimate.log_exposure[i][measured] - estimate.log_exposure[problem.reference][measured];
        const double sigma = ev_sigma_of_pairs(r, i, log_ratio / kLn2);
        if (sigma > limit) limit = sigma, worst = static_cast<int>(i);
    }
    return worst;
}

// Whether pairs tie an image to the reference. Other images are left out (methods/group.cpp).
bool is_joined(const Problem &problem, uint32_t image) {
    return problem.component[image] == problem.component[problem.reference];
}

// The first image that is not joined.
uint32_t apart_image(const Problem &problem) {
    uint32_t image = 0;
    while (image + 1 < problem.image_count && is_joined(problem, image)) image++;
    return image;
}

// Whether pairs are too few, too similar, or at places that carry no information.
bool lacks_data(const Problem &problem, const Estimate &estimate, FitResult &r) {
    size_t unknowns = free_columns(problem, estimate.modes).size() + static_cast<size_t>(problem.image_unknowns);
    size_t informative = count_informative(problem);
    if (r.components > 1 && problem.image_unknowns > 0 && is_static(problem))
        return refuse(r, of_image(LENSPROF_REASON_IMAGE_GROUPS, apart_image(problem), {double(r.components)}));
    if (informative * static_cast<size_t>(problem.channels) < 2 * unknowns)
        return refuse(r, {LENSPROF_REASON_FEW_PAIRS, {double(informative), double(unknowns)}});
    if (fits_response(estimate) && is_static(problem))
        if (const double spread = exposure_spread(problem, estimate); spread < kSmallestSpread)
            return refuse(r, {LENSPROF_REASON_EXPOSURES_ALIKE, {spread}});
    if (fits_response(estimate) && covered_greys(problem, r) < kMinGreys)
        return refuse(r, {LENSPROF_REASON_FEW_GREYS, {double(covered_greys(problem, r))}});
    if (frees_falloff(problem) && !is_static(problem))
        if (const double change = radius_change(problem); change < kSameView)
            return refuse(r, {LENSPROF_REASON_SAME_VIEW, {change}});
    if (frees_falloff(problem) && covered_radius(r) < kSmallestRadius)
        return refuse(r, {LENSPROF_REASON_SMALL_RADIUS, {covered_radius(r)}});
    return false;
}

bool contradicts_model(const Problem &problem, const Estimate &estimate, FitResult &r) {
    // otherwise a held value does not fit
    bool is_free = (estimate.modes >= 0 || estimate.is_refined) && (problem.free & kFalloffFlags) == kFalloffFlags;
    bool still = is_static(problem) && (problem.free & LENSPROF_FREE_RESPONSE);
    bool is_far = r.heldout_median == LENSPROF_UNKNOWN || r.heldout_median > kStillMedian;
    if (still && r.inlier_share < kSmallestStillShare && is_far)
        return refuse(r, {LENSPROF_REASON_STILL_FEW_AGREE, {r.inlier_share}});
    if (r.inlier_share < 0.3) return refuse(r, {LENSPROF_REASON_FEW_AGREE, {r.inlier_share}});
    double pattern = r.noise_levels * std::sqrt(r.image_share);
    // A held response or falloff that does not fit also leaves patterns, and is wrong however small they are.
    const double harmful = still ? kHarmfulStillPattern : is_free ? kHarmfulPattern : kSmallestPattern;
    if (r.image_share > kLargestImageShare && pattern > harmful)
        return refuse(r, {still     ? LENSPROF_REASON_STILL_PATTERNS
                          : is_free ? LENSPROF_REASON_PATTERNS
                                    : LENSPROF_REASON_PATTERNS_HELD,
                          {r.image_share, pattern}});
    if (r.noise_levels > kLargestNoise) return refuse(r, {LENSPROF_REASON_SCATTER, {r.noise_levels}});
    return false;
}

// The first image with almost no pair that agrees.
bool disagrees(const Problem &problem, const FitResult &r, uint32_t &image) {
    for (image = 0; image < problem.image_count && r.image_quality; image++)
        if (r.image_quality[image].inliers < kSmallestImageShare * r.image_quality[image].pairs) return true;
    return false;
}

bool is_undetermined(const Problem &problem, const Estimate &estimate, FitResult &r) {
    if (!r.converged) return refuse(r, {LENSPROF_REASON_NOT_SETTLED, {double(r.iterations)}});
    if (r.covariance_size == 0 && !free_columns(problem, estimate.modes).empty())
        return refuse(r, {LENSPROF_REASON_UNDETERMINED, {}});
    double corner = corner_sigma(problem, r);
    if (corner > kLargestCornerSigma) return refuse(r, {LENSPROF_REASON_CORNER_UNCERTAIN, {corner}});
    const double off_centre = largest_offset(r.vignetting[0]);
    if (off_centre > kOnLimit * kLargestCenter && (problem.free & LENSPROF_FREE_CENTER))
        return refuse(r, {LENSPROF_REASON_CENTER_ON_LIMIT, {off_centre}});
    if (const auto rise = rise_above(kLargestRise, problem, r); !rise.empty())
        return refuse(r, {LENSPROF_REASON_FALLOFF_RISES, rise});
    if (const double darkest = darkest_of(problem, r); darkest < kSmallestM)
        return refuse(r, {LENSPROF_REASON_FALLOFF_DARK, {darkest}});
    const bool still = is_static(problem);
    if (const auto few = images_with_few_inliers(problem, r); !few.empty())
        return refuse(r,
                      of_image(still ? LENSPROF_REASON_STILL_FEW_BEHIND_EXPOSURE : LENSPROF_REASON_FEW_BEHIND_EXPOSURE,
                               few[0].image, {double(few[0].inliers)}));
    uint32_t image;
    if (disagrees(problem, r, image))
        return refuse(r,
                      of_image(still ? LENSPROF_REASON_STILL_IMAGE_DISAGREES : LENSPROF_REASON_IMAGE_DISAGREES, image,
                               {double(r.image_quality[image].inliers), double(r.image_quality[image].pairs)}));
    double uncertain_by;
    int uncertain = uncertain_image(problem, estimate, r, uncertain_by);
    if (uncertain >= 0)
        return refuse(r,
                      of_image(LENSPROF_REASON_EXPOSURE_UNCERTAIN, static_cast<uint32_t>(uncertain), {uncertain_by}));
    return false;
}

bool leaves_out_any(const Problem &problem, const FitResult &r) {
    return r.image_quality && std::any_of(r.image_quality, r.image_quality + problem.image_count, [](const auto &q) {
               return q.known_ev_left_out != 0;
           });
}

// The image whose exposure is farthest from its known one, if clearly; else -1. Considers only images that are left
// out, if there are any.
int contradicting_image(const Problem &problem, const FitResult &r) {
    int worst = -1;
    const bool any = leaves_out_any(problem, r);
    double limit = any ? 0.0 : kContradiction;
    for (uint32_t i = 0; i < problem.image_count && r.image_quality; i++) {
        double sigma = problem.images[i].known_ev_sigma;
        double off = sigma > 0.0 ? std::abs(r.image_quality[i].known_ev_residual) / std::max(sigma, kKnownSigma) : 0.0;
        if (any && !r.image_quality[i].known_ev_left_out) continue;
        if (off > limit) limit = off, worst = static_cast<int>(i);
    }
    return worst;
}

// Reports how known exposures contradict each other, or the exponent of the result, if they do. For many known
// exposures, whose errors follow from their scatter, only steps and single errors are reported (contradicting_image).
bool warns_of_known_exposures(const Problem &problem, const Estimate &estimate, FitResult &r) {
    using Explanation = KnownExposures::Explanation;
    bool open = r.gamma_from == LENSPROF_GAMMA_EXPOSURES || r.gamma_from == LENSPROF_GAMMA_PRIOR;
    KnownExposures known = compare_known(problem, estimate, open);
    if (known.count > kMany && known.explanation != Explanation::step) return false;
    const double slope_error = std::abs(std::log(std::max(known.slope, 1e-3))), offset_ev = std::abs(known.off_ev);
    switch (known.explanation) {
    case Explanation::order: return warn(r, {LENSPROF_REASON_KNOWN_ORDER, {known.off_ev}});
    case Explanation::single_image: return warn(r, of_image(LENSPROF_REASON_KNOWN_WRONG, known.image, {offset_ev}));
    case Explanation::step:
        return warn(r, of_image(known.off_ev > 0.0 ? LENSPROF_REASON_KNOWN_MORE_FROM : LENSPROF_REASON_KNOWN_LESS_FROM,
                                known.image, {offset_ev}));
    case Explanation::any:
        if (leaves_out_any(problem, r)) return false;  // these are
        return warn(r, {LENSPROF_REASON_KNOWN_CONTRADICT, {known.off_ev}});
    default: break;
    }
    const bool is_unfollowed =
        r.gamma_from == LENSPROF_GAMMA_EXPOSURES && slope_error > std::max(kUnfollowed, 3.0 * r.gamma_sigma);
    return is_unfollowed && warn(r, {LENSPROF_REASON_GAMMA_UNFOLLOWED, {1.0 / known.slope}});
}

// The most important warning about a usable result.
bool warns_of_images(const Problem &problem, const Estimate &estimate, FitResult &r) {
    if (const HeldBalance held = held_balance(problem, estimate); held.levels > 0.0)
        return warn(r, of_image(LENSPROF_REASON_BALANCES_HELD, held.image, {held.levels}));
    const int odd = odd_image(problem, r), contradicting = contradicting_image(problem, r);
    if (odd >= 0) {
        const auto image = static_cast<uint32_t>(odd);
        return warn(r, of_image(is_static(problem) ? LENSPROF_REASON_STILL_IMAGE_ODD : LENSPROF_REASON_IMAGE_ODD, image,
                                {r.image_quality[image].median_residual}));
    }
    if (warns_of_known_exposures(problem, estimate, r)) return true;
    if (contradicting < 0) return false;
    const auto image = static_cast<uint32_t>(contradicting);
    return warn(r, of_image(LENSPROF_REASON_KNOWN_WRONG, image, {std::abs(r.image_quality[image].known_ev_residual)}));
}

bool warns_of_model(const Problem &problem, const Estimate &estimate, FitResult &r) {
    const bool is_still = is_static(problem) && (problem.free & LENSPROF_FREE_RESPONSE);
    const double image_pattern = r.noise_levels * std::sqrt(r.image_share),
                 frame_pattern = r.noise_levels * std::sqrt(r.frame_share);
    const double off_centre = std::hypot(r.vignetting[0].center[0], r.vignetting[0].center[1]);
    if (r.image_share > kSuspiciousImageShare && image_pattern > (is_still ? kStillPattern : kSmallestPattern))
        return warn(r, {LENSPROF_REASON_WEAK_PATTERNS, {r.image_share, image_pattern}});
    if (r.frame_share > kNotRadial && frame_pattern > kSmallestPattern)
        return warn(r, {LENSPROF_REASON_NOT_RADIAL, {r.frame_share, frame_pattern}});
    if (const auto rise = rise_above(1.0 + kSmallRise, problem, r); !rise.empty())
        return warn(r, {LENSPROF_REASON_FALLOFF_RISES_SOME, rise});
    if (off_centre > kFarCentre && (problem.free & LENSPROF_FREE_CENTER))
        return warn(r, {LENSPROF_REASON_FAR_CENTER, {off_centre}});
    if (!fits_response(estimate) || covered_greys(problem, r) >= kEnoughGreys) return false;
    const auto [first, last] = missing_greys(problem, r);
    return warn(r, {LENSPROF_REASON_MISSING_GREYS, {0.1 * first, 0.1 * last}});
}

}  // namespace

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
        if (is_joined(problem, i) && inliers[owner(i)] < kMinInliers) few.push_back({i, inliers[owner(i)]});
    return few;
}

double ev_sigma_of_pairs(const FitResult &r, uint32_t image, double ev) {
    const double sigma = r.image_quality[image].ev_sigma, of_gamma = std::max(r.gamma_sigma, 0.0) * ev;
    return std::sqrt(std::max(0.0, sigma * sigma - of_gamma * of_gamma));
}

void judge(const Problem &problem, const Estimate &estimate, FitResult &r) {
    if (lacks_data(problem, estimate, r) || contradicts_model(problem, estimate, r)
        || is_undetermined(problem, estimate, r))
        return;
    accept(r);
    if (!warns_of_images(problem, estimate, r)) warns_of_model(problem, estimate, r);
}

}  // namespace lensprof
