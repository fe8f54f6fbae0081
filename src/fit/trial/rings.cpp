#include "fit/trial/rings.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/profile.h"
#include "fit/base/constants.hpp"
#include "fit/trial/ring_fit.hpp"

namespace lensprof {
namespace {

constexpr size_t kMinEnds = 20;       // of pairs, in a ring that is shown
constexpr double kClear = 2.0;        // standard errors
constexpr double kSame = 0.03;        // EV: a difference that nobody sees
constexpr double kHidden = 0.1;       // EV: a standard error that does not show a difference
constexpr double kLeastKnown = 0.02;  // EV: least standard error of a known exposure, as in fits
constexpr int kGammaRounds = 30;      // of the search for gamma
constexpr double kGammaStep = 0.3;    // ln, at most
constexpr int kAreaSide = 96;         // samples across the frame, for means over rings

// Means over the rings of a frame: of the nodes' weights and of ln M.
struct RingMeans {
    RingMatrix nodes = RingMatrix::Zero();
    RingVector corrected = RingVector::Zero(), area = RingVector::Zero();
};

RingMeans means_over(const TrialPairs &pairs, const TrialModel &model) {
    RingMeans means;
    const lensprof_pair &pair = pairs.train.empty() ? pairs.heldout.front() : pairs.train.front();
    const lensprof_fit_image &image = pairs.images[pair.image[0]];
    const lensprof_image_circle circle = model.falloff ? lp_profile_circle(model.falloff) : lensprof_image_circle{};
    for (int j = 0; j < kAreaSide; j++)
        for (int i = 0; i < kAreaSide; i++) {
            const double x = (i + 0.5) / kAreaSide * (image.width - 1.0),
                         y = (j + 0.5) / kAreaSide * (image.height - 1.0);
            if (!lensprof_image_circle_contains(&circle, image.width, image.height, x, y)) continue;
            const double r2 = r2_of(image, x, y);
            const int ring = ring_of(r2);
            means.area[ring]++;
            means.nodes.row(ring) += node_weights(r2).transpose();
            for (uint32_t c = 0; c < pairs.channels && model.falloff; c++)
                means.corrected[ring] +=
                    std::log(lensprof_profile_falloff(model.falloff, c, image.width, image.height, x, y, nullptr))
                    / pairs.channels;
        }
    for (int k = 0; k < kRings; k++) {
        if (!(means.area[k] > 0.0)) continue;
        means.nodes.row(k) /= means.area[k], means.corrected[k] /= means.area[k];
    }
    for (int k = kRings - 1; k >= 0; k--) {
        means.nodes.row(k) -= means.nodes.row(0).eval();
        means.corrected[k] -= means.corrected[0];
    }
    means.area /= kAreaSide * kAreaSide;
    return means;
}

// The falloff that the pictures show has the gamma of the response, M^gamma; the candidate's M has the true one.
void apply_gamma(const ResponseError &response, RingFalloff &found) {
    const double gamma = std::exp(response.log_gamma);
    found.remaining = (found.remaining + found.corrected) / gamma - found.corrected;
    const RingVector by_gamma = (found.remaining + found.corrected) * response.log_gamma_sigma;
    found.covariance = found.covariance / (gamma * gamma) + by_gamma * by_gamma.transpose();
}

// Adds to what is known of gamma the known exposures of the images: they are those of the pictures to the power
// 1/gamma, with errors. `exposures`: of the pictures, ln.
void add_known_exposures(const std::vector<lensprof_fit_image> &images, const std::vector<double> &exposures,
                         ResponseError &response) {
    if (!(response.log_gamma_sigma > 0.0)) return;
    std::vector<std::array<double, 3>> known;  // weight, known exposure, that of the pictures
    std::array<double, 3> sum{};
    for (size_t i = 0; i < images.size(); i++) {
        if (!(images[i].known_ev_sigma > 0.0) || exposures[i] == 0.0) continue;
        const double sigma = kLn2 * std::max(images[i].known_ev_sigma, kLeastKnown);
        known.push_back({1.0 / (sigma * sigma), kLn2 * images[i].known_ev, exposures[i]});
        sum[0] += known.back()[0];
        for (size_t n = 1; n < 3; n++) sum[n] += known.back()[0] * known.back()[n];
    }
    double square = 0.0, product = 0.0;  // of the exposures of the pictures, and with the known ones
    for (const auto &[weight, given, found] : known) {
        const double off = found - sum[2] / sum[0];
        square += weight * off * off, product += weight * off * (given - sum[1] / sum[0]);
    }
    if (!(square > 0.0)) return;
    double log_gamma = response.log_gamma, information = 0.0;
    for (int round = 0; round < kGammaRounds; round++) {  // Gauss-Newton
        const double inverse = std::exp(-log_gamma), by_known = inverse * inverse * square;
        const double z =
            (log_gamma - response.log_gamma) / std::hypot(response.log_gamma_sigma, 1.0 / std::sqrt(by_known));
        const double prior = std::pow(response.log_gamma_sigma, -2.0) / (1.0 + z * z);  // its errors have heavy tails
        information = prior + by_known;
        const double slope = prior * (log_gamma - response.log_gamma) + inverse * product - by_known;
        log_gamma -= std::clamp(slope / information, -kGammaStep, kGammaStep);
    }
    response.log_gamma = log_gamma, response.log_gamma_sigma = 1.0 / std::sqrt(information);
}

}  // namespace

RingFalloff remaining_falloff(const TrialPairs &pairs, const TrialModel &model, ResponseError response) {
    RingFalloff found;
    RingFit fit(pairs, model, response);
    if (fit.is_empty()) return found;
    fit.solve();
    const RingMeans means = means_over(pairs, model);
    found.corrected = means.corrected, found.area = means.area;
    for (int k = 0; k < kRings; k++)
        if (fit.ends()[static_cast<size_t>(k)] >= kMinEnds && means.area[k] > 0.0)
            found.rings = static_cast<uint32_t>(k) + 1;
    found.remaining = means.nodes * fit.nodes();
    found.covariance = fit.covariance(means.nodes);
    add_known_exposures(pairs.images, fit.exposures(), response);
    apply_gamma(response, found);
    return found;
}

bool is_flatter(const RingFalloff &found) {
    double gain = 0.0;
    RingVector by_ring = RingVector::Zero();
    for (int k = 1; k < static_cast<int>(found.rings); k++) {
        const double m = found.corrected[k];
        gain += found.area[k] * m * (2.0 * found.remaining[k] + m);
        by_ring[k] = 2.0 * found.area[k] * m;
    }
    return gain > kClear * std::sqrt(by_ring.dot(found.covariance * by_ring)) && gain > std::pow(kSame * kLn2, 2.0);
}

void put_rings(const RingFalloff &found, lensprof_trial_candidate &candidate) {
    candidate.rings = found.rings;
    for (uint32_t k = 0; k < found.rings; k++) {
        candidate.ring_ev[k] = found.remaining[k] / kLn2;
        candidate.ring_sigma_ev[k] = std::sqrt(found.covariance(k, k)) / kLn2;
    }
    if (found.rings < 2) return;
    const double ev = candidate.ring_ev[found.rings - 1], sigma = candidate.ring_sigma_ev[found.rings - 1];
    if (std::fabs(ev) > std::max(kClear * sigma, kSame))
        candidate.corners = ev < 0.0 ? LENSPROF_TRIAL_CORNERS_TOO_DARK : LENSPROF_TRIAL_CORNERS_TOO_BRIGHT;
    else
        candidate.corners = sigma > kHidden ? LENSPROF_TRIAL_CORNERS_NOT_SHOWN : LENSPROF_TRIAL_CORNERS_AGREE;
}

}  // namespace lensprof
