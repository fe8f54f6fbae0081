#include "fit/rendering/curve_fit.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Dense>

#include "fit/base/constants.hpp"
#include "fit/base/quantile.hpp"

namespace lensprof {
namespace {

constexpr int kInner = kCurveKnots - 1;
constexpr double kPower = 2.2;
constexpr double kMinLight = 1e-7;
constexpr double kMinNoise = 0.25 / 255.0;  // of a mean over a square: from JPEG coding
constexpr double kWhiteEdge = 254.0 / 255.0;
constexpr double kRobustAt = 3.0;  // in units of the noise
constexpr double kRoughAt = 0.3;   // range over mean of irradiance in an area
constexpr int kOfPicture = 13;     // kUnknowns: 9 of A, 3 of q, s
constexpr double kColourSigma = 1.0, kFalloffSigma = 1.0, kSaturationSigma = 0.3;
constexpr double kBendSigma = 0.06, kLevelSigma = 1.0;

// f is smooth except at its dark end, where slopes of cameras differ by orders of magnitude.
double bend_sigma_at(int i) { return kBendSigma * (1.0 + 24.0 / (1.0 + i)); }

struct Interval {
    int index;
    double share, t_slope;  // dt/dx
};

Interval interval_of(double x) {
    const double light = std::max(x, kMinLight), t = std::pow(light, 1.0 / kPower);
    const double position = t * kCurveKnots;
    const int index = std::min(static_cast<int>(position), kCurveKnots - 1);
    return {index, x > 0.0 ? position - index : 0.0, t / (kPower * light)};
}

double radial(const Rendering &rendering, double r2) {
    const auto &q = rendering.falloff;
    return std::exp(std::clamp(r2 * (q[0] + r2 * (q[1] + r2 * q[2])), -5.0, 5.0));
}

// Up to 2 knots and 3 of A's row per channel, 3 of q, s.
struct Row {
    std::array<int, 3 * 5 + 4> column{};
    std::array<double, 3 * 5 + 4> slope{};
    int count = 0;
    void add(int index, double value) {
        if (index < 0 || value == 0.0) return;
        column[static_cast<size_t>(count)] = index;
        slope[static_cast<size_t>(count++)] = value;
    }
};

int chroma_bin(const Area &area) { return std::min(static_cast<int>(area.chroma * kChromaBins), kChromaBins - 1); }

double rise(const CurveFit &fit, int i) {
    return fit.knots[static_cast<size_t>(i + 1)] - fit.knots[static_cast<size_t>(i)];
}

// The mean of f over an area differs from f of its mean irradiance by an amount that depends on the variance.
double rough_factor(const Area &area) { return 1.0 + std::pow(area.roughness / kRoughAt, 2); }

class Solver {
public:
    explicit Solver(const FitRequest &request) : request_(request) {
        size_ = kInner + kOfPicture * static_cast<int>(request.pictures);
        for (int i = 0; i < kCurveKnots; i++) {
            const double from = std::pow(double(i) / kCurveKnots, kPower),
                         to = std::pow((i + 1.0) / kCurveKnots, kPower);
            const double rise = lensprof_response_eval(&request.prior, to, nullptr)
                                - lensprof_response_eval(&request.prior, from, nullptr);
            prior_rise_[static_cast<size_t>(i)] = std::log(std::max(rise, 1e-6));
        }
    }

    CurveFit start() const;
    void estimate_noise(CurveFit &fit) const;
    void solve(CurveFit &fit, int rounds) const;
    void add_covariance(CurveFit &fit) const;

private:
    bool counts(const Area &area) const {
        switch (request_.left_out) {
        case kLeaveNone: return true;
        case kLeaveRougher: return !area.is_rougher;
        case kLeaveColourful: return !area.is_more_colourful;
        default: return region_of(area) != request_.left_out;
        }
    }
    void add_curve(const CurveFit &fit, const Area &area, const AreaPrediction &prediction, size_t channel,
                   double share, Row &row) const;
    Row row_of(const CurveFit &fit, const Area &area, const AreaPrediction &prediction, size_t channel) const;
    double cost_of(const CurveFit &fit) const;
    double prior_cost(const CurveFit &fit) const;
    void equations(const CurveFit &fit, Eigen::MatrixXd &h, Eigen::VectorXd &g) const;
    void add_curve_prior(const CurveFit &fit, Eigen::MatrixXd &h, Eigen::VectorXd &g) const;
    void add_picture_prior(const CurveFit &fit, Eigen::MatrixXd &h, Eigen::VectorXd &g) const;
    CurveFit moved(const CurveFit &fit, const Eigen::VectorXd &step) const;

    const FitRequest &request_;
    int size_ = 0;
    std::array<double, kCurveKnots> prior_rise_{};
    mutable std::vector<std::array<double, 3>> gains_;  // per picture, the scale that A is relative to
};

// The curve of the prior, and gains of the channels from the irradiance it gives.
CurveFit Solver::start() const {
    CurveFit fit;
    for (int i = 0; i <= kCurveKnots; i++)
        fit.knots[static_cast<size_t>(i)] =
            lensprof_response_eval(&request_.prior, std::pow(double(i) / kCurveKnots, kPower), nullptr);
    for (int i = 1; i < kCurveKnots; i++)
        fit.knots[static_cast<size_t>(i)] = 0.999 * fit.knots[static_cast<size_t>(i)] + 0.001 * i / kCurveKnots;
    fit.noise.fill(2.0 / 255.0);
    fit.renderings.resize(request_.pictures);
    for (uint32_t p = 0; p < request_.pictures; p++)
        for (size_t c = 0; c < 3; c++) {
            std::vector<double> ratios;
            for (const Area &area : request_.areas)
                if (area.picture == p && area.use[c] == Area::grey && area.raw[c] > 0.0f)
                    ratios.push_back(lensprof_response_invert(&request_.prior, area.grey_value[c], nullptr)
                                     / area.raw[c]);
            auto &colour = fit.renderings[p].colour;
            for (size_t k = 0; k < 3; k++) colour[3 * c + k] = 0.0;
            colour[3 * c + c] = ratios.empty() ? 1.0 : upper_median(ratios);
        }
    return fit;
}

// Adds `share` of the derivatives of f in a channel, without those of q.
void Solver::add_curve(const CurveFit &fit, const Area &area, const AreaPrediction &prediction, size_t channel,
                       double share, Row &row) const {
    const double x = prediction.light[channel], slope = prediction.slope[channel];
    if (x >= 1.0) {
        row.add(kCurveKnots - 2, -share * (x - 1.0) * slope / std::max(rise(fit, kCurveKnots - 1), 1e-9));
    } else {
        const Interval in = interval_of(x);
        row.add(in.index - 1, share * (1.0 - in.share));
        if (in.index + 1 < kCurveKnots) row.add(in.index, share * in.share);
    }
    const int first = kInner + kOfPicture * static_cast<int>(area.picture) + 3 * static_cast<int>(channel);
    const double gain = share * slope * radial(fit.renderings[area.picture], area.r2);
    for (size_t k = 0; k < request_.channels; k++)
        row.add(first + static_cast<int>(k), gain * area.raw[k] * gains_[area.picture][k]);
}

Row Solver::row_of(const CurveFit &fit, const Area &area, const AreaPrediction &prediction, size_t channel) const {
    Row row;
    const double s = fit.renderings[area.picture].saturation;
    const int first = kInner + kOfPicture * static_cast<int>(area.picture);
    double by_gain = 0.0;
    for (size_t k = 0; k < request_.channels; k++) {
        const double share = (k == channel ? 1.0 + s : 0.0) - s * kGreyWeights[k];
        if (share == 0.0) continue;
        add_curve(fit, area, prediction, k, share, row);
        by_gain += share * prediction.slope[k] * prediction.light[k];
    }
    double r2 = area.r2;
    for (int n = 0; n < 3; n++, r2 *= area.r2) row.add(first + 9 + n, by_gain * r2);
    if (request_.channels == 3) row.add(first + 12, prediction.curve[channel] - prediction.grey);
    return row;
}

// ln of every rise: its second difference relative to the prior, twice, and itself.
double Solver::prior_cost(const CurveFit &fit) const {
    double sum = 0.0;
    std::array<double, kCurveKnots> off{};
    for (int i = 0; i < kCurveKnots; i++) {
        if (!(rise(fit, i) > 0.0)) return INFINITY;
        off[static_cast<size_t>(i)] = std::log(rise(fit, i)) - prior_rise_[static_cast<size_t>(i)];
        sum += std::pow(off[static_cast<size_t>(i)] / kLevelSigma, 2) / kCurveKnots;
    }
    for (size_t i = 1; i + 1 < off.size(); i++)
        sum += std::pow((off[i + 1] - 2.0 * off[i] + off[i - 1]) / bend_sigma_at(static_cast<int>(i)), 2);
    for (size_t p = 0; p < fit.renderings.size(); p++) {
        const auto &r = fit.renderings[p];
        for (size_t i = 0; i < 9; i++) {
            const double about = i % 4 == 0 ? 1.0 : 0.0;
            sum += std::pow((r.colour[i] / gains_[p][i % 3] - about) / kColourSigma, 2);
        }
        for (double q : r.falloff) sum += std::pow(q / kFalloffSigma, 2);
        sum += std::pow(r.saturation / kSaturationSigma, 2);
    }
    return sum;
}

double Solver::cost_of(const CurveFit &fit) const {
    double sum = prior_cost(fit);
    for (const Area &area : request_.areas) {
        if (!counts(area)) continue;
        const AreaPrediction prediction = fit.predict(area);
        for (size_t c = 0; c < request_.channels; c++) {
            double residual = 0.0;
            if (fit.weight(area, prediction, c, &residual) == 0.0) continue;
            const double z = residual / fit.sigma(area);
            sum += kRobustAt * kRobustAt * std::log1p(z * z / (kRobustAt * kRobustAt));
        }
    }
    return sum;
}

void Solver::add_curve_prior(const CurveFit &fit, Eigen::MatrixXd &h, Eigen::VectorXd &g) const {
    const auto off = [&](int i) { return std::log(rise(fit, i)) - prior_rise_[static_cast<size_t>(i)]; };
    const auto add = [&](const std::array<double, 3> &factors, int first, double residual, double weight) {
        std::array<double, 4> slope{};  // of knots first .. first + 3, from the rises between them
        for (int i = 0; i < 3; i++) {
            if (factors[static_cast<size_t>(i)] == 0.0) continue;
            const double by_rise = factors[static_cast<size_t>(i)] / rise(fit, first + i);
            slope[static_cast<size_t>(i + 1)] += by_rise, slope[static_cast<size_t>(i)] -= by_rise;
        }
        for (int a = 0; a < 4; a++) {
            const int row = first + a - 1;
            if (row < 0 || row >= kInner) continue;
            g(row) += weight * residual * slope[static_cast<size_t>(a)];
            for (int b = 0; b < 4; b++)
                if (first + b - 1 >= 0 && first + b - 1 < kInner)
                    h(row, first + b - 1) += weight * slope[static_cast<size_t>(a)] * slope[static_cast<size_t>(b)];
        }
    };
    for (int i = 0; i < kCurveKnots; i++)
        add({1.0, 0.0, 0.0}, i, off(i), 1.0 / (kLevelSigma * kLevelSigma * kCurveKnots));
    for (int i = 1; i + 1 < kCurveKnots; i++)
        add({1.0, -2.0, 1.0}, i - 1, off(i + 1) - 2.0 * off(i) + off(i - 1), std::pow(bend_sigma_at(i), -2));
}

void Solver::add_picture_prior(const CurveFit &fit, Eigen::MatrixXd &h, Eigen::VectorXd &g) const {
    for (size_t p = 0; p < fit.renderings.size(); p++) {
        const auto first = kInner + kOfPicture * static_cast<int>(p);
        for (int i = 0; i < kOfPicture; i++) {
            const auto n = static_cast<size_t>(i);
            const double sigma = i < 9 ? kColourSigma : i < 12 ? kFalloffSigma : kSaturationSigma;
            const Rendering &r = fit.renderings[p];
            const double value = i < 9    ? r.colour[n] / gains_[p][n % 3] - (n % 4 == 0 ? 1.0 : 0.0)
                                 : i < 12 ? r.falloff[n - 9]
                                          : r.saturation;
            h(first + i, first + i) += 1.0 / (sigma * sigma);
            g(first + i) += value / (sigma * sigma);
        }
    }
}

void Solver::equations(const CurveFit &fit, Eigen::MatrixXd &h, Eigen::VectorXd &g) const {
    h.setZero(size_, size_);
    g.setZero(size_);
    for (const Area &area : request_.areas) {
        if (!counts(area)) continue;
        const AreaPrediction prediction = fit.predict(area);
        for (size_t c = 0; c < request_.channels; c++) {
            double residual = 0.0;
            const double weight = fit.weight(area, prediction, c, &residual);
            if (weight == 0.0) continue;
            const Row row = row_of(fit, area, prediction, c);
            for (int a = 0; a < row.count; a++) {
                const double along = weight * row.slope[static_cast<size_t>(a)];
                g(row.column[static_cast<size_t>(a)]) += along * residual;
                for (int b = 0; b < row.count; b++)
                    h(row.column[static_cast<size_t>(a)], row.column[static_cast<size_t>(b)]) +=
                        along * row.slope[static_cast<size_t>(b)];
            }
        }
    }
    add_curve_prior(fit, h, g);
    add_picture_prior(fit, h, g);
}

// Shortens a step that would make f fall: each rise keeps at least a fifth.
CurveFit Solver::moved(const CurveFit &fit, const Eigen::VectorXd &step) const {
    CurveFit to = fit;
    const auto change = [&](int knot) { return knot < 1 || knot > kInner ? 0.0 : step(knot - 1); };
    double share = 1.0;
    for (int i = 0; i < kCurveKnots; i++) {
        const double fall = change(i) - change(i + 1);
        if (fall > 0.8 * rise(fit, i)) share = std::min(share, 0.8 * rise(fit, i) / fall);
    }
    for (int i = 1; i <= kInner; i++) to.knots[static_cast<size_t>(i)] += share * change(i);
    for (size_t p = 0; p < fit.renderings.size(); p++)
        for (int i = 0; i < kOfPicture; i++) {
            const auto n = static_cast<size_t>(i);
            const double delta = share * step(kInner + kOfPicture * static_cast<int>(p) + i);
            if (i < 9)
                to.renderings[p].colour[n] += delta * gains_[p][n % 3];
            else if (i < 12)
                to.renderings[p].falloff[n - 9] += delta;
            else
                to.renderings[p].saturation += delta;
        }
    return to;
}

void Solver::solve(CurveFit &fit, int rounds) const {
    if (gains_.empty()) {
        const CurveFit &from = request_.start ? *request_.start : fit;
        for (const Rendering &r : from.renderings)
            gains_.push_back({std::max(r.colour[0], 1e-6), std::max(r.colour[4], 1e-6), std::max(r.colour[8], 1e-6)});
    }
    Eigen::MatrixXd h;
    Eigen::VectorXd g;
    double damping = 1e-4;
    fit.cost = cost_of(fit);
    for (int round = 0; round < rounds; round++) {
        request_.stop.check();
        equations(fit, h, g);
        bool better = false;
        double gained = 0.0;
        for (int trial = 0; trial < 8 && !better; trial++, damping *= 8.0) {
            Eigen::MatrixXd damped = h;
            damped.diagonal() *= 1.0 + damping;
            CurveFit to = moved(fit, damped.ldlt().solve(-g));
            to.cost = cost_of(to);
            better = to.cost < fit.cost;
            gained = fit.cost - to.cost;
            if (better) fit = to;
        }
        damping = std::max(damping / 64.0, 1e-9);
        if (!better || gained < 1e-4) return;
    }
}

// From the median residual, increasing with chroma.
void Solver::estimate_noise(CurveFit &fit) const {
    std::array<std::vector<double>, kChromaBins> left;
    for (const Area &area : request_.areas) {
        const AreaPrediction prediction = fit.predict(area);
        for (size_t c = 0; c < request_.channels; c++) {
            double residual = 0.0;
            if (fit.weight(area, prediction, c, &residual) != 0.0 && area.use[c] == Area::grey)
                left[static_cast<size_t>(chroma_bin(area))].push_back(std::fabs(residual) / rough_factor(area));
        }
    }
    double least = kMinNoise;
    for (size_t i = 0; i < left.size(); i++) {
        if (left[i].size() >= 30) least = std::max(least, kMadToSigma * upper_median(left[i]));
        fit.noise[i] = least;
    }
}

void Solver::add_covariance(CurveFit &fit) const {
    Eigen::MatrixXd h;
    Eigen::VectorXd g;
    equations(fit, h, g);
    const Eigen::MatrixXd covariance =
        h.ldlt().solve(Eigen::MatrixXd::Identity(size_, size_)).topLeftCorner(kInner, kInner);
    fit.knot_covariance.assign(covariance.data(), covariance.data() + covariance.size());
}

}  // namespace

double CurveFit::eval(double x, double *slope) const {
    if (x >= 1.0) {
        const double last = (knots[kCurveKnots] - knots[kCurveKnots - 1]) * kCurveKnots / kPower;
        if (slope) *slope = last;
        return 1.0 + last * (x - 1.0);
    }
    const Interval in = interval_of(x);
    const auto i = static_cast<size_t>(in.index);
    if (slope) *slope = x > 0.0 ? (knots[i + 1] - knots[i]) * kCurveKnots * in.t_slope : 0.0;
    return knots[i] + in.share * (knots[i + 1] - knots[i]);
}

AreaPrediction CurveFit::predict(const Area &area) const {
    AreaPrediction prediction;
    const Rendering &r = renderings[area.picture];
    const double gain = radial(r, area.r2);
    for (size_t c = 0; c < 3; c++) {
        const double *row = &r.colour[3 * c];
        prediction.light[c] = gain * (row[0] * area.raw[0] + row[1] * area.raw[1] + row[2] * area.raw[2]);
        prediction.curve[c] = eval(prediction.light[c], &prediction.slope[c]);
        prediction.grey += kGreyWeights[c] * prediction.curve[c];
    }
    for (size_t c = 0; c < 3; c++)
        prediction.grey_value[c] = prediction.curve[c] + r.saturation * (prediction.curve[c] - prediction.grey);
    return prediction;
}

double CurveFit::sigma(const Area &area) const {
    return noise[static_cast<size_t>(chroma_bin(area))] * rough_factor(area);
}

// White only shows that the response has reached its maximum.
double CurveFit::weight(const Area &area, const AreaPrediction &prediction, size_t channel, double *residual) const {
    *residual = 0.0;
    if (area.use[channel] == Area::none) return 0.0;
    *residual =
        prediction.grey_value[channel] - (area.use[channel] == Area::white ? kWhiteEdge : area.grey_value[channel]);
    if (area.use[channel] == Area::white && *residual >= 0.0) return 0.0;
    const double area_sigma = sigma(area), z = *residual / (kRobustAt * area_sigma);
    return 1.0 / (area_sigma * area_sigma * (1.0 + z * z));
}

lensprof_response CurveFit::response() const {
    std::array<double, LENSPROF_RESPONSE_SAMPLES> table;
    for (size_t i = 0; i < table.size(); i++)
        table[i] = std::min(1.0, eval(double(i) / double(table.size() - 1), nullptr));
    for (size_t i = 1; i < table.size(); i++) table[i] = std::max(table[i], table[i - 1]);
    table.back() = 1.0;
    lensprof_response response;
    if (lensprof_response_set_table(&response, table.data(), static_cast<uint32_t>(table.size())) != LENSPROF_OK)
        throw std::logic_error("a fitted response is not monotone");
    return response;
}

double CurveFit::gauge() const {
    const auto light_at = [&](double level) {
        int i = 0;
        while (i < kCurveKnots - 1 && knots[static_cast<size_t>(i + 1)] < level) i++;
        const double from = knots[static_cast<size_t>(i)], to = knots[static_cast<size_t>(i + 1)];
        const double t = (i + (level - from) / std::max(to - from, 1e-12)) / kCurveKnots;
        return kPower * std::log(std::max(t, 1e-9));
    };
    return std::log(std::max(light_at(208.0 / 255.0) - light_at(48.0 / 255.0), 1e-9));
}

double CurveFit::gauge_sigma() const {
    std::array<double, kInner> slope{};
    CurveFit moved = *this;
    for (size_t i = 0; i < slope.size(); i++) {
        const double step = 1e-6 * (knots[i + 1] - knots[i]);
        moved.knots[i + 1] = knots[i + 1] - step;
        slope[i] = (gauge() - moved.gauge()) / step;
        moved.knots[i + 1] = knots[i + 1];
    }
    double variance = 0.0;
    for (size_t i = 0; i < slope.size(); i++)
        for (size_t j = 0; j < slope.size(); j++) variance += slope[i] * slope[j] * knot_covariance[i * kInner + j];
    return std::sqrt(std::max(variance, 0.0));
}

CurveFit fit_curve(const FitRequest &request) {
    Solver solver(request);
    if (request.start) {
        CurveFit fit = *request.start;
        solver.solve(fit, 6);
        return fit;
    }
    CurveFit fit = solver.start();
    for (const int rounds : {15, 10, 10, 40}) {
        solver.solve(fit, rounds);
        if (rounds != 40) solver.estimate_noise(fit);
    }
    solver.add_covariance(fit);
    return fit;
}

// 5 x 4 regions of the frame.
int region_of(const Area &area) {
    return std::clamp(static_cast<int>(area.across * 5.0f), 0, 4)
           + 5 * std::clamp(static_cast<int>(area.down * 4.0f), 0, 3);
}

}  // namespace lensprof
