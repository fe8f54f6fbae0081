#include "fit/verdict/quality.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "fit/base/constants.hpp"
#include "fit/problem/residual.hpp"
#include "fit/verdict/pattern.hpp"

namespace lensprof {
namespace {

double radius(const Problem &problem, const Estimate &estimate, const lensprof_pair &pair, int side) {
    const auto &image = problem.images[pair.image[side]];
    const auto setting = static_cast<size_t>(problem.setting_of[pair.image[side]]);
    const lensprof_vignetting &vignetting = estimate.vignetting[setting][0];
    return std::sqrt(
        lensprof_vignetting_r2(&vignetting, image.width, image.height, pair.xy[side][0], pair.xy[side][1], nullptr));
}

uint32_t bin_of(double value) { return static_cast<uint32_t>(std::clamp(value, 0.0, 0.999) * LENSPROF_COVERAGE_BINS); }

void count_greys(const Problem &problem, FitResult &r) {
    std::fill_n(r.grey_ends, LENSPROF_COVERAGE_BINS, 0u);
    for (const auto &pair : problem.pairs)
        for (int side = 0; side < 2; side++) {
            for (int c = 0; c < problem.channels; c++) r.grey_ends[bin_of(pair.value[side][c])]++;
        }
}

// Signed residual of a pair: mean over the channels of the forward direction, weighted by its noise, levels of 255.
double signed_residual(const PairTransfer &t, int channels) {
    double sum = 0.0;
    for (int c = 0; c < channels; c++) {
        const Transfer &transfer = t.channel[static_cast<size_t>(c)];
        sum += 255.0 * transfer.residual[0] / std::sqrt(1.0 + transfer.by_value[0] * transfer.by_value[0]);
    }
    return sum / channels;
}

// Fills residuals, noise and the patterns they follow, and every image's median.
void describe_residuals(const Problem &problem, const Estimate &estimate, double noise, FitResult &r) {
    std::vector<double> chi2 = all_chi2(problem, estimate, noise), residual(problem.pairs.size());
    std::vector<bool> is_inlier(problem.pairs.size());
    for (size_t p = 0; p < chi2.size(); p++) is_inlier[p] = chi2[p] < inlier_limit(problem.channels);
    r.noise_levels = 255.0 * noise;
    r.inlier_share = static_cast<double>(std::count(is_inlier.begin(), is_inlier.end(), true))
                     / static_cast<double>(problem.pairs.size());
    std::vector<std::vector<double>> of_image(r.image_quality ? problem.image_count : 0);
    for (size_t i = 0; i < of_image.size(); i++) r.image_quality[i].inliers = 0;
    for_each_transfer(problem, estimate, [&](size_t p, const PairTransfer &t) {
        residual[p] = signed_residual(t, problem.channels);
        if (of_image.empty()) return;
        for (uint32_t image : problem.pairs[p].image) {
            r.image_quality[image].inliers += is_inlier[p];
            for (int c = 0; c < problem.channels; c++)
                for (double channel_residual : t.channel[static_cast<size_t>(c)].residual)
                    of_image[image].push_back(255.0 * std::abs(channel_residual));
        }
    });
    PatternShares shares = pattern_shares(problem, residual, is_inlier);
    r.frame_share = shares.frame;
    r.image_share = shares.image;
    for (size_t i = 0; i < of_image.size(); i++) r.image_quality[i].median_residual = median(of_image[i]);
}

void describe_images(const Problem &problem, const Gauge &gauge, const Estimate &estimate, const Covariance &found,
                     FitResult &r) {
    if (!r.image_quality) return;
    int measured = problem.measured_channel();
    std::vector<std::vector<double>> greys(problem.image_count);
    for (uint32_t i = 0; i < problem.image_count; i++) {
        auto &q = r.image_quality[i];
        const auto &a = estimate.log_exposure[i], &zero = estimate.log_exposure[problem.reference];
        double gamma_sigma = std::max(gauge.sigma(), 0.0);
        q.pairs = 0, q.radius = q.ev_sigma = q.known_ev_residual = 0.0;
        q.component = problem.component[i];
        q.joined = 1;  // methods/group.cpp leaves images out
        q.known_ev_left_out = gauge.leaves_out(i);
        auto sigma = [&](int unknown, double log_value) {  // of a logarithm: that of the data and that of gamma
            if (unknown < 0 || !found.is_determined || q.component != problem.component[problem.reference]) return 0.0;
            return std::sqrt(std::max(0.0, found.images[unknown]) + std::pow(gamma_sigma * log_value, 2));
        };
        q.ev_sigma = sigma(problem.ev_unknown[i], a[measured] - zero[measured]) / kLn2;
        for (int c = 0; c < 3; c++) {
            int unknown = problem.channels == 3 ? problem.balance_unknown[i][c] : -1;
            double balance = (a[c] - a[1]) - (zero[c] - zero[1]);
            q.white_balance_sigma[c] = sigma(unknown, balance) * (unknown < 0 ? 0.0 : std::exp(a[c] - a[1]));
        }
        if (gauge.knows() && problem.images[i].known_ev_sigma > 0.0
            && q.component == problem.component[problem.reference])
            q.known_ev_residual =
                (a[measured] - gauge.known_offset()) / kLn2 / gauge.slope() - problem.images[i].known_ev;
    }
    for (const auto &pair : problem.pairs)
        for (int side = 0; side < 2; side++) {
            auto &q = r.image_quality[pair.image[side]];
            q.pairs++;
            q.radius = std::max(q.radius, radius(problem, estimate, pair, side));
            for (int c = 0; c < problem.channels; c++) greys[pair.image[side]].push_back(pair.value[side][c]);
        }
    for (uint32_t i = 0; i < problem.image_count; i++) {
        r.image_quality[i].grey_low = quantile(greys[i], 0.05);
        r.image_quality[i].grey_high = quantile(greys[i], 0.95);
    }
}

// The covariance of the data, with gamma held, and that of gamma, which moves all parameters together: for the response
// and one setting.
void describe_covariance(const Problem &problem, const Gauge &gauge, const Estimate &estimate, const Covariance &found,
                         int setting, FitResult &r) {
    int modes = static_cast<int>(r.response.modes), curves = 3 * problem.vignettings, n = modes + curves + 2;
    auto column = [&](int i) {
        if (i < modes) return i;
        return i < modes + curves ? falloff_column(setting) + i - modes : center_column(setting) + i - modes - curves;
    };
    r.covariance_size = found.is_determined ? static_cast<uint32_t>(n) : 0;
    std::fill_n(r.gamma_direction, LENSPROF_COVARIANCE_MAX, 0.0);
    if (!found.is_determined) return;
    bool moves = gauge.sigma() > 0.0 && estimate.modes > 0;
    Eigen::VectorXd direction = Eigen::VectorXd::Zero(shared_size(problem.settings));
    if (moves) direction = Gauge::direction(problem, estimate);
    for (int i = 0; i < n; i++)
        if (found.shared(column(i), column(i)) > 0.0) r.gamma_direction[i] = direction[column(i)];
    double variance = moves ? gauge.sigma() * gauge.sigma() : 0.0;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            r.covariance[i * n + j] =
                found.shared(column(i), column(j)) + variance * (r.gamma_direction[i] * r.gamma_direction[j]);
}

}  // namespace

std::vector<double> residual_levels(const Problem &problem, const Estimate &estimate) {
    std::vector<double> values;
    for_each_transfer(problem, estimate, [&](size_t, const PairTransfer &t) {
        for (int c = 0; c < problem.channels; c++)
            for (double r : t.channel[static_cast<size_t>(c)].residual) values.push_back(255.0 * std::abs(r));
    });
    return values;
}

Summary summarise(std::vector<double> values) {
    Summary summary;
    if (values.empty()) return summary;
    double sum2 = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
    summary.rms = std::sqrt(sum2 / static_cast<double>(values.size()));
    summary.median = median(values);
    return summary;
}

void describe_model(const Problem &problem, const Estimate &estimate, FitResult &r) {
    if (estimate.modes < 0)
        r.response = estimate.fixed;
    else if (lensprof_response_set_emor(&r.response, estimate.emor.data(), static_cast<uint32_t>(estimate.modes))
             != LENSPROF_OK)
        throw std::runtime_error("the fitted response is not monotone");
    r.vignettings = static_cast<uint32_t>(problem.vignettings);
    r.pairs = static_cast<uint32_t>(problem.pairs.size());
}

void describe_heldout(const Problem &tested, const Estimate &train, bool is_heldout, FitResult &r) {
    Summary summary = summarise(residual_levels(tested, train));
    r.heldout_rms = is_heldout ? summary.rms : LENSPROF_UNKNOWN;
    r.heldout_median = is_heldout ? summary.median : LENSPROF_UNKNOWN;
    std::vector<double> before;
    for (const auto &pair : tested.pairs)
        for (int c = 0; c < tested.channels; c++)
            before.push_back(255.0 * std::abs(pair.value[0][c] - pair.value[1][c]));
    r.before_rms = summarise(before).rms;
}

void describe_quality(const Problem &problem, const Gauge &gauge, double noise, const Covariance &found,
                      const Estimate &estimate, FitResult &r) {
    r.components = problem.component_count();
    r.reference = problem.reference;
    r.left_out = 0;
    r.gamma_from = gauge.from();
    r.gamma_sigma = gauge.from() == LENSPROF_GAMMA_NONE ? LENSPROF_UNKNOWN : gauge.sigma();
    r.irradiance_spread_ev = light_spread(problem, estimate);
    r.response_from = fits_response(problem, estimate) ? LENSPROF_FIT_RESPONSE_PICTURES : LENSPROF_FIT_RESPONSE_OPTIONS;
    describe_residuals(problem, estimate, noise, r);
    count_greys(problem, r);
    describe_images(problem, gauge, estimate, found, r);
}

void describe_setting(const Problem &problem, const Gauge &gauge, const Covariance &found, const Estimate &estimate,
                      int setting, FitResult &r) {
    const Falloffs &curves = estimate.vignetting[static_cast<size_t>(setting)];
    for (size_t c = 0; c < 3; c++) r.vignetting[c] = curves[problem.vignettings == 3 ? c : 0];
    std::fill_n(r.radius_ends, LENSPROF_COVERAGE_BINS, 0u);
    for (const auto &pair : problem.pairs)
        for (int side = 0; side < 2; side++)
            if (problem.setting_of[pair.image[side]] == setting)
                r.radius_ends[bin_of(radius(problem, estimate, pair, side))]++;
    describe_covariance(problem, gauge, estimate, found, setting, r);
}

double exposure_spread(const Problem &problem, const Estimate &estimate) {
    double sum = 0.0, count = 0.0;
    for (const Edge &edge : problem.edges)
        for (size_t c = 0; c < static_cast<size_t>(problem.channels); c++) {
            const auto &a = estimate.log_exposure;
            auto pairs = static_cast<double>(edge.last - edge.first);
            sum += pairs * std::pow(a[edge.image[0]][c] - a[edge.image[1]][c], 2);
            count += pairs;
        }
    return std::sqrt(sum / std::max(count, 1.0)) / kLn2;
}

double light_spread(const Problem &problem, const Estimate &estimate) {
    double sum = 0.0, count = 0.0;
    for (const Edge &edge : problem.edges) {
        const auto ratios = exposure_ratios(problem, estimate, edge);
        for (size_t p = edge.first; p < edge.last; p++)
            for (size_t c = 0; c < static_cast<size_t>(problem.channels); c++) {
                const size_t curve = problem.vignettings == 3 ? c : 0;
                sum += std::pow(std::log(ratios[c] * falloff(problem, estimate, curve, problem.pairs[p]).ratio), 2);
                count += 1.0;
            }
    }
    return std::sqrt(sum / std::max(count, 1.0)) / kLn2;
}

void write_exposures(const Problem &problem, const Estimate &estimate, lensprof_exposure *exposures) {
    for (uint32_t i = 0; i < problem.image_count; i++) {
        const auto &a = estimate.log_exposure[i];
        const lensprof_exposure given = given_exposure(problem.images, i);
        auto green = static_cast<size_t>(problem.measured_channel());
        exposures[i] = given;
        if (problem.ev_unknown[i] >= 0)
            exposures[i].ev =
                std::clamp((a[green] - (green ? std::log(given.white_balance[1]) : 0.0)) / kLn2, -64.0, 64.0);
        for (size_t c : {0, 2})
            if (problem.balance_unknown[i][c] >= 0)
                exposures[i].white_balance[c] = std::clamp(std::exp(a[c] - a[1]) * given.white_balance[1], 1e-6, 1e6);
    }
}

}  // namespace lensprof
