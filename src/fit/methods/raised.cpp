#include "fit/methods/raised.hpp"

#include <algorithm>
#include <cmath>

#include "core/covariance.h"
#include "core/response.h"
#include "fit/base/constants.hpp"
#include "fit/prior/gauge.hpp"

namespace lensprof {
namespace {

lensprof_response raised_response(const lensprof_response &response, double gamma) {
    double curve[LENSPROF_RESPONSE_SAMPLES];
    for (int j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++)
        curve[j] = lp_curve_eval(response.table, std::pow(j / (LENSPROF_RESPONSE_SAMPLES - 1.0), 1.0 / gamma), nullptr);
    Estimate table;
    set_table(table, curve);
    return table.fixed;
}

// The uncertainty of the falloffs of a result, or of one of its lens settings.
template <class Result>
class RaisedFalloff {
public:
    // `size`, `modes`: of the covariance, without the response's part.
    RaisedFalloff(Result &r, uint32_t size, uint32_t modes, uint32_t free)
        : r_(r), size_(size), modes_(modes), free_(free) {}

    void raise(double log_gamma, double old_sigma, double sigma) {
        constexpr double h = 0.01;
        lensprof_vignetting up[3], down[3];
        for (size_t c = 0; c < 3; c++) {
            up[c] = down[c] = r_.vignetting[c];
            raise_falloff(free_, std::exp(log_gamma + h), up[c]);
            raise_falloff(free_, std::exp(log_gamma - h), down[c]);
            raise_falloff(free_, std::exp(log_gamma), r_.vignetting[c]);
        }
        const uint32_t n = size_ > modes_ ? size_ - modes_ : 0;
        std::vector<double> before(n), after(n), by_gamma(n), scale(n), covariance(n * n);
        for (uint32_t i = 0; i < n; i++) {
            const bool is_center = i + 2 >= n;
            before[i] = old_sigma * r_.gamma_direction[modes_ + i];
            by_gamma[i] = is_center ? 0.0 : (up[i / 3].k[i % 3] - down[i / 3].k[i % 3]) / (2.0 * h);
            after[i] = sigma * by_gamma[i];
            scale[i] = is_center ? 1.0 : std::exp(log_gamma);
        }
        for (uint32_t i = 0; i < n; i++)
            for (uint32_t j = 0; j < n; j++) {
                const double of_data = r_.covariance[(modes_ + i) * size_ + modes_ + j] - before[i] * before[j];
                covariance[i * n + j] = scale[i] * scale[j] * of_data + after[i] * after[j];
            }
        std::fill(std::begin(r_.covariance), std::end(r_.covariance), 0.0);
        std::fill(std::begin(r_.gamma_direction), std::end(r_.gamma_direction), 0.0);
        std::copy(covariance.begin(), covariance.end(), r_.covariance);
        std::copy(by_gamma.begin(), by_gamma.end(), r_.gamma_direction);
    }

private:
    Result &r_;
    const uint32_t size_, modes_, free_;
};

}  // namespace

void raise_result(double log_gamma, double sigma, uint32_t free, const std::set<uint32_t> &settings,
                  std::vector<lensprof_exposure> &exposures, FitResult &r) {
    const double gamma = std::exp(log_gamma), old_sigma = std::max(r.gamma_sigma, 0.0), stated = sigma;
    sigma = std::max(sigma, 0.0);
    const uint32_t modes = lp_covariance_modes(&r.response, 1), size = r.covariance_size;
    r.response = raised_response(r.response, gamma);
    r.covariance_size = size > modes ? size - modes : 0;
    RaisedFalloff(r, size, modes, free).raise(log_gamma, old_sigma, sigma);
    for (const uint32_t number : settings)
        if (r.settings && r.settings[number].images)
            RaisedFalloff(r.settings[number], size, modes, free).raise(log_gamma, old_sigma, sigma);
    const lensprof_exposure zero = exposures[r.reference];
    for (size_t i = 0; i < exposures.size(); i++) {
        lensprof_exposure &e = exposures[i];
        if (std::isnan(e.ev)) continue;
        const double ev_offset = e.ev - zero.ev, of_gamma = old_sigma * ev_offset;
        e.ev = zero.ev + gamma * ev_offset;
        for (int c = 0; c < 3; c++) {
            const double before = e.white_balance[c];
            e.white_balance[c] = zero.white_balance[c] * std::pow(before / zero.white_balance[c], gamma);
            if (r.image_quality) r.image_quality[i].white_balance_sigma[c] *= gamma * e.white_balance[c] / before;
        }
        if (!r.image_quality) continue;
        double &ev_sigma = r.image_quality[i].ev_sigma;
        const double of_data = std::max(0.0, ev_sigma * ev_sigma - of_gamma * of_gamma);
        ev_sigma = std::sqrt(gamma * gamma * of_data + std::pow(sigma * gamma * ev_offset, 2));
    }
    r.gamma_sigma = stated;
    r.irradiance_spread_ev *= gamma;
}

void offset_exposures(const Offset &offset, uint32_t channels, std::vector<lensprof_exposure> &exposures,
                      FitResult &r) {
    const size_t measured = channels == 3 ? 1 : 0;
    for (size_t i = 0; i < exposures.size(); i++) {
        lensprof_exposure &e = exposures[i];
        if (std::isnan(e.ev)) continue;
        e.ev -= offset.log_light[measured] / kLn2;
        lensprof_fit_image_quality *quality = r.image_quality ? &r.image_quality[i] : nullptr;
        if (quality) quality->ev_sigma = std::hypot(quality->ev_sigma, offset.sigma / kLn2);
        for (const size_t c : {0, 2}) {
            if (channels == 1) break;
            const double factor = std::exp(offset.log_light[measured] - offset.log_light[c]);
            e.white_balance[c] *= factor;
            if (!quality) continue;
            quality->white_balance_sigma[c] =
                std::hypot(factor * quality->white_balance_sigma[c], e.white_balance[c] * offset.balance_sigma[c]);
        }
    }
}

}  // namespace lensprof
