#include "fit/deflicker/curve.hpp"

#include <algorithm>
#include <cmath>

#include "fit/base/quantile.hpp"

namespace lensprof {
namespace {

constexpr double kShortestSteps = 3.75, kUsualSteps = 30.0, kMostSteps = 500.0;  // of a window
constexpr double kMuchBetter = 0.8;  // error of a window shorter than usual that is preferred
constexpr size_t kMostWhole = 3000;  // values that one window may hold
constexpr double kRobust = 6.0;      // median residuals at which a value has no influence

// Values of the curve, and the influence of each value on its own point.
struct Smoothed {
    std::vector<double> values, own;
};

Smoothed smooth_once(const std::vector<double> &times, const std::vector<double> &values,
                     const std::vector<double> &trust, double window) {
    const size_t count = times.size();
    Smoothed smoothed{std::vector<double>(count), std::vector<double>(count, 1.0)};
    size_t begin = 0;
    for (size_t i = 0; i < count; i++) {
        while (begin < i && times[i] - times[begin] >= window) begin++;
        double w = 0, wt = 0, wtt = 0, wv = 0, wtv = 0;
        for (size_t n = begin; n < count && times[n] - times[i] < window; n++) {
            const double t = (times[n] - times[i]) / window, tail = 1.0 - std::abs(t * t * t);
            const double weight = trust[n] * tail * tail * tail;
            w += weight, wt += weight * t, wtt += weight * t * t;
            wv += weight * values[n], wtv += weight * t * values[n];
        }
        const double det = w * wtt - wt * wt;
        const bool is_line = det > 1e-9 * w * w;
        smoothed.values[i] = !(w > 0.0) ? values[i] : is_line ? (wtt * wv - wt * wtv) / det : wv / w;
        if (w > 0.0) smoothed.own[i] = trust[i] * (is_line ? wtt / det : 1.0 / w);
    }
    return smoothed;
}

// How far each value lies from the curve without it.
std::vector<double> left_out_errors(const std::vector<double> &times, const std::vector<double> &values,
                                    double window) {
    const Smoothed smoothed = smooth_once(times, values, std::vector<double>(times.size(), 1.0), window);
    std::vector<double> errors;
    for (size_t i = 0; i < times.size(); i++)
        errors.push_back(std::abs(values[i] - smoothed.values[i]) / std::max(1.0 - smoothed.own[i], 1e-3));
    return errors;
}

// Whether errors exceed those of the best window by no more than chance: two standard errors of the difference.
bool are_as_good(const std::vector<double> &errors, const std::vector<double> &best) {
    const auto count = static_cast<double>(errors.size());
    double sum = 0.0, squares = 0.0;
    for (size_t i = 0; i < errors.size(); i++) {
        const double difference = errors[i] - best[i];
        sum += difference, squares += difference * difference;
    }
    const double mean = sum / count, variance = std::max(squares / count - mean * mean, 0.0);
    return mean <= 2.0 * std::sqrt(variance / count);
}

}  // namespace

double mean_of(const std::vector<double> &values) {
    double sum = 0.0;
    for (double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

std::vector<double> smooth_curve(const std::vector<double> &times, const std::vector<double> &values, double window) {
    std::vector<double> trust(times.size(), 1.0);
    Smoothed smoothed;
    for (int round = 0; round < 3; round++) {
        smoothed = smooth_once(times, values, trust, window);
        std::vector<double> residuals;
        for (size_t i = 0; i < times.size(); i++) residuals.push_back(std::abs(values[i] - smoothed.values[i]));
        const double limit = kRobust * std::max(upper_median(residuals), 1e-6);
        for (size_t i = 0; i < times.size(); i++) {
            const double share = std::min(residuals[i] / limit, 1.0);
            trust[i] = (1.0 - share * share) * (1.0 - share * share);
        }
    }
    return smoothed.values;
}

double best_window(const std::vector<double> &times, const std::vector<double> &values) {
    const double length = times.empty() ? 0.0 : times.back() - times.front();
    if (!(length > 0.0)) return 1.0;
    const double step = length / static_cast<double>(times.size() - 1);
    std::vector<double> windows;
    for (double n = kShortestSteps; n <= kMostSteps && n * step < length; n *= 2.0) windows.push_back(n * step);
    if (times.size() <= kMostWhole || windows.empty())
        windows.push_back(1e3 * (length + step));  // nearly constant weights: one line
    std::vector<std::vector<double>> errors;
    for (double window : windows) errors.push_back(left_out_errors(times, values, window));
    const auto is_less = [](const auto &a, const auto &b) { return mean_of(a) < mean_of(b); };
    auto best = std::min_element(errors.begin(), errors.end(), is_less);
    // Short windows follow flicker, too: they are for light that changes much faster than it flickers.
    const auto usual = std::find_if(windows.begin(), windows.end(), [&](double w) { return w >= kUsualSteps * step; });
    const auto longer = errors.begin() + (usual - windows.begin());
    if (longer != errors.end()) {
        const auto best_longer = std::min_element(longer, errors.end(), is_less);
        if (mean_of(*best) > kMuchBetter * mean_of(*best_longer)) best = best_longer;
    }
    for (size_t n = windows.size(); n-- > 0;)
        if (are_as_good(errors[n], *best)) return windows[n];
    return windows.front();
}

}  // namespace lensprof
