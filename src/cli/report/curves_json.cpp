#include "cli/report/curves_json.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <nlohmann/json.hpp>

#include "cli/report/chart.hpp"
#include "photo/base/format.hpp"
#include "photo/base/library.hpp"
#include "photo/report/falloff.hpp"

namespace lensprof {
namespace {

constexpr int response_steps = 64;

std::string label_of(const std::string &label, uint32_t channels, uint32_t channel) {
    if (channels != 3) return label;
    return label.empty() ? channel_names[channel] : label + " " + channel_names[channel];
}

std::vector<double> response_samples(const lensprof_response &response) {
    std::vector<double> f;
    for (int i = 0; i <= response_steps; i++)
        f.push_back(lensprof_response_eval(&response, double(i) / response_steps, nullptr));
    return f;
}

// Of f, by a covariance of `stride` columns whose rows `first`.. are of the coefficients.
std::vector<double> response_sigmas(const double *covariance, size_t stride, size_t first, uint32_t modes) {
    std::vector<double> sigma;
    for (int i = 0; i <= response_steps; i++) {
        const auto sample =
            static_cast<size_t>(std::lround(double(i) / response_steps * (LENSPROF_RESPONSE_SAMPLES - 1)));
        double variance = 0.0;
        for (uint32_t a = 0; a < modes; a++)
            for (uint32_t b = 0; b < modes; b++)
                variance += lensprof_emor_table(a + 1)[sample] * covariance[(first + a) * stride + first + b]
                            * lensprof_emor_table(b + 1)[sample];
        sigma.push_back(std::sqrt(std::max(variance, 0.0)));
    }
    return sigma;
}

}  // namespace

void add_falloff_curves(const lensprof_profile &profile, const std::string &label, Json &curves) {
    for (uint32_t c = 0; c < profile.vignettings; c++) {
        std::vector<double> m(chart_samples), sigma(chart_samples);
        for (size_t i = 0; i < chart_samples; i++) {
            m[i] = lensprof_profile_radial_falloff(&profile, c, double(i) / (chart_samples - 1), &sigma[i]);
            sigma[i] = std::max(sigma[i], 0.0);
        }
        curves.push_back({{"label", label_of(label, profile.vignettings, c)}, {"m", m}, {"sigma", sigma}});
    }
}

void add_response_curves(const lensprof_profile &profile, const std::string &label, Json &curves) {
    size_t first = 0;
    for (uint32_t c = 0; c < profile.responses; c++) {
        const lensprof_response &response = profile.response[c];
        const uint32_t modes = response.kind == LENSPROF_RESPONSE_EMOR ? response.modes : 0;
        Json curve = {{"label", label_of(label, profile.responses, c)}, {"f", response_samples(response)}};
        if (modes && first + modes <= profile.covariance_size)
            curve["sigma"] = response_sigmas(profile.covariance, profile.covariance_size, first, modes);
        first += modes;
        curves.push_back(curve);
    }
}

std::string corner_text(const lensprof_profile &profile) {
    double sigma = 0.0;
    const double corner = lensprof_profile_corner_falloff(&profile, green_curve(profile.vignettings), &sigma);
    const double ev = std::log2(corner);
    if (!(sigma > 0.0)) return format("%.2f (%+.2f EV)", corner, ev);
    const int digits =
        std::clamp(static_cast<int>(std::ceil(-std::log10(sigma))), 2, 6);  // one of the error, two or more
    return format("%.*f ± %.*f (%+.2f EV)", digits, corner, digits, sigma, ev);
}

Json typical_band(uint32_t kind) {
    static const char *const names[] = {"cameras of all kinds", "film", "digital cameras of the 1990s",
                                        "today's digital cameras", "phones"};
    if (kind == LENSPROF_CAMERA_LINEAR) return {};
    lensprof_response response;
    std::vector<double> covariance(size_t(LENSPROF_EMOR_MODES) * LENSPROF_EMOR_MODES);
    check(lensprof_response_set_typical(&response, kind, covariance.data(), nullptr), "typical response");
    const std::vector<double> f = response_samples(response);
    const std::vector<double> sigma = response_sigmas(covariance.data(), LENSPROF_EMOR_MODES, 0, LENSPROF_EMOR_MODES);
    std::vector<double> low, high;
    for (size_t i = 0; i < f.size(); i++)
        low.push_back(std::max(0.0, f[i] - sigma[i])), high.push_back(std::min(1.0, f[i] + sigma[i]));
    return {{"label", std::string("measured responses of ") + names[kind] + ", 68 %"}, {"low", low}, {"high", high}};
}

}  // namespace lensprof
