#include "fit/rendering/rendering.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Dense>

#include "fit/base/fail.hpp"
#include "fit/rendering/curve_fit.hpp"
#include "fit/rendering/limits.hpp"

namespace lensprof {
namespace {

constexpr uint32_t kMinAreas = 300;  // with a grey value
constexpr size_t kMinInRegion = 20;
constexpr int kMapColumns = 12, kMapRows = 9;
constexpr double kMinInCell = 8.0;  // values, of each half
// Error of ln gamma per EV of the map left by local tone mapping: the curve absorbs the rest (measured: 1.4 to 2.2).
constexpr double kByPattern = 2.0;
constexpr double kMinCorrection = 0.02;  // of irradiance
// Errors common to all areas, which a jackknife does not show: block-wise rendering, rounding of colours, denoising by
// the camera.
constexpr double kCommonSigma = 0.004;
constexpr double kScatterUnseen = 0.5;  // of ln gamma, for levels that are not measured
const double kGaugeRange = std::log(208.0 / 48.0);

double gamma_of(double gauge) { return std::exp(gauge) / kGaugeRange; }

bool is_used(const Area &area) {
    return area.use[0] == Area::grey || area.use[1] == Area::grey || area.use[2] == Area::grey;
}

// Irradiance of the rendering over that of the sensor.
double radial_gain(const Rendering &rendering, double radius) {
    const double r2 = radius * radius;
    return std::exp(r2 * (rendering.falloff[0] + r2 * (rendering.falloff[1] + r2 * rendering.falloff[2])));
}

// Jackknife standard errors over regions: of the gauge, and of ln of every file's corner. That of the gauge includes
// its change when only smooth and neutral areas are used, for which the model is exact.
struct Spread {
    double gauge = 0.0;
    std::vector<double> corners;
};

Spread leave_out(const FitRequest &request, const CurveFit &fit, const std::vector<double> &radii) {
    std::array<size_t, kRegionCount> counts{};
    for (const Area &area : request.areas) counts[static_cast<size_t>(region_of(area))]++;
    std::vector<CurveFit> fits;
    for (int region = 0; region < kRegionCount; region++) {
        if (counts[static_cast<size_t>(region)] < kMinInRegion) continue;
        FitRequest without{request.areas, request.pictures, request.channels, request.prior,
                           &fit,          region,           request.stop};
        fits.push_back(fit_curve(without));
    }
    const auto error_of = [&](const auto &value) {
        double mean = 0.0, sum = 0.0;
        for (const CurveFit &f : fits) mean += value(f) / double(fits.size());
        for (const CurveFit &f : fits) sum += std::pow(value(f) - mean, 2);
        return fits.size() < 2 ? 0.0 : std::sqrt(sum * double(fits.size() - 1) / double(fits.size()));
    };
    Spread spread;
    double variance = std::pow(error_of([](const CurveFit &f) { return f.gauge(); }), 2);
    for (const int half : {kLeaveRougher, kLeaveColourful}) {
        const CurveFit without =
            fit_curve({request.areas, request.pictures, request.channels, request.prior, &fit, half, request.stop});
        variance += std::pow(without.gauge() - fit.gauge(), 2);
    }
    spread.gauge = std::sqrt(variance);
    for (size_t p = 0; p < radii.size(); p++)
        spread.corners.push_back(
            error_of([&](const CurveFit &f) { return std::log(radial_gain(f.renderings[p], radii[p])); }));
    return spread;
}

// A map of residuals over the frame, from each half of the areas: what both show is not noise.
struct HalfMaps {
    struct Sums {
        double levels = 0.0, ev = 0.0, weight = 0.0, count = 0.0;
    };
    std::array<std::array<Sums, kMapColumns * kMapRows>, 2> half{};

    void add(const CurveFit &fit, const Area &area, size_t half_index, uint32_t channels) {
        const int column = std::clamp(static_cast<int>(area.across * kMapColumns), 0, kMapColumns - 1);
        const int row = std::clamp(static_cast<int>(area.down * kMapRows), 0, kMapRows - 1);
        Sums &sums = half[half_index][static_cast<size_t>(row * kMapColumns + column)];
        const AreaPrediction prediction = fit.predict(area);
        for (size_t c = 0; c < channels; c++) {
            double residual = 0.0;
            const double weight = fit.weight(area, prediction, c, &residual);
            if (weight == 0.0 || area.use[c] != Area::grey) continue;
            sums.levels -= weight * 255.0 * residual;
            sums.ev -= weight * residual / std::max(prediction.slope[c] * prediction.light[c] * std::log(2.0), 1e-3);
            sums.weight += weight, sums.count++;
        }
    }

    // RMS of what both halves show.
    double rms(double Sums::*value) const {
        double sum = 0.0, count = 0.0;
        for (size_t i = 0; i < half[0].size(); i++) {
            const Sums &a = half[0][i], &b = half[1][i];
            if (a.count < kMinInCell || b.count < kMinInCell) continue;
            sum += (a.count + b.count) * (a.*value / a.weight) * (b.*value / b.weight);
            count += a.count + b.count;
        }
        return count > 0.0 ? std::sqrt(std::max(0.0, sum / count)) : 0.0;
    }
};

double white_ev_of(const Rendering &rendering, uint32_t channels) {
    if (channels == 1) return std::log2(std::max(rendering.colour[0], 1e-9));
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> colour(rendering.colour.data());
    const Eigen::Vector3d neutral = colour.inverse() * Eigen::Vector3d::Ones();
    const double largest = neutral.maxCoeff();
    return largest > 0.0 && std::isfinite(largest) ? -std::log2(largest) : 0.0;
}

void describe_shot(const CurveFit &fit, uint32_t number, RenderedShot &shot) {
    HalfMaps maps;
    size_t area_number = 0;
    lensprof_rendering_shot &found = shot.found;
    for (const Area &area : shot.areas) maps.add(fit, area, area_number++ % 2, found.channels);
    const Rendering &rendering = fit.renderings[number];
    std::copy(rendering.colour.begin(), rendering.colour.end(), found.colour);
    std::copy(rendering.falloff.begin(), rendering.falloff.end(), found.falloff);
    found.saturation = rendering.saturation;
    found.corner = radial_gain(rendering, found.radius);
    found.noise_levels = 255.0 * fit.noise[0];
    found.pattern_levels = maps.rms(&HalfMaps::Sums::levels);
    found.pattern_ev = maps.rms(&HalfMaps::Sums::ev);
    found.tones = found.pattern_levels > rendering_limits::kStrongMap ? 2
                  : found.pattern_levels > rendering_limits::kWeakMap ? 1
                                                                      : 0;
    found.white_ev = white_ev_of(rendering, found.channels);
}

void describe_levels(const std::vector<Area> &areas, uint32_t channels, lensprof_rendering_result &result) {
    std::vector<double> levels;
    std::array<int, 10> tenths{};
    size_t white = 0;
    for (const Area &area : areas)
        for (size_t c = 0; c < channels; c++) {
            white += area.use[c] == Area::white;
            if (area.use[c] != Area::grey) continue;
            levels.push_back(255.0 * area.grey_value[c]);
            tenths[static_cast<size_t>(std::min(area.grey_value[c], 0.999f) * 10.0f)]++;
        }
    std::sort(levels.begin(), levels.end());
    if (!levels.empty())
        result.lowest = levels[levels.size() / 100] / 255.0,
        result.highest = levels[levels.size() - 1 - levels.size() / 100] / 255.0;
    result.tenths = static_cast<uint32_t>(std::count_if(tenths.begin(), tenths.end(), [](int n) { return n >= 20; }));
    result.shows_white = white >= 20;
}

// Error of ln gamma if the darkest or brightest part between levels 48 and 208 is not measured: cameras differ there.
double unseen_sigma(const lensprof_rendering_result &result) {
    const auto light = [&](double level) {
        return std::log(std::max(lensprof_response_invert(&result.response, level / 255.0, nullptr), 1e-9));
    };
    const double low = std::clamp(255.0 * result.lowest, 48.0, 208.0),
                 high = std::clamp(255.0 * result.highest, low, 208.0);
    const double range = light(208.0) - light(48.0), seen = light(high) - light(low);
    return range > 0.0 ? kScatterUnseen * (1.0 - seen / range) : kScatterUnseen;
}

// Of each shot alone: its exponent, and scatter beyond their errors.
double scatter_of_shots(RenderingFit &fit) {
    const double count = static_cast<double>(fit.shots.size());
    double mean = 0.0, scatter = 0.0, stated = 0.0;
    std::vector<double> gauges;
    for (RenderedShot &shot : fit.shots) {
        std::vector<Area> alone = shot.areas;
        for (Area &area : alone) area.picture = 0;
        const FitRequest request{alone, 1, shot.found.channels, fit.prior, nullptr, kLeaveNone, fit.stop};
        const CurveFit own = fit_curve(request);
        const double sigma =
            std::hypot(std::max(leave_out(request, own, {1.0}).gauge, own.gauge_sigma()), kCommonSigma);
        gauges.push_back(own.gauge());
        shot.found.gamma = gamma_of(own.gauge()), shot.found.gamma_sigma = sigma;
        mean += own.gauge() / count, stated += sigma * sigma / count;
    }
    for (double gauge : gauges) scatter += std::pow(gauge - mean, 2) / std::max(count - 1.0, 1.0);
    return std::max(0.0, scatter - stated);
}

// The areas of all shots; an error names a shot that has too few.
lensprof_status gather_areas(RenderingFit &fit, std::vector<Area> &all, lensprof_error *error) {
    if (fit.shots.empty()) return fail(LENSPROF_ERROR_NO_SAMPLES, error, "rendering: no shot was added");
    for (uint32_t i = 0; i < fit.shots.size(); i++) {
        lensprof_rendering_shot &shot = fit.shots[i].found;
        float r2 = 0.0f;
        shot.areas = 0;
        for (const Area &area : fit.shots[i].areas) r2 = std::max(r2, area.r2), shot.areas += is_used(area);
        if (shot.areas < kMinAreas)
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_NO_SAMPLES, error,
                           "too few areas are smooth and unclipped in both pictures (%u; of %u squares of the rendered "
                           "picture %u are black, %u white and %u saturated in the raw file); take a picture with "
                           "smooth areas of all brightnesses",
                           shot.areas, shot.squares, shot.black, shot.white, shot.saturated);
        shot.radius = std::min(1.0, std::sqrt(double(r2)));
        all.insert(all.end(), fit.shots[i].areas.begin(), fit.shots[i].areas.end());
    }
    return LENSPROF_OK;
}

}  // namespace

uint32_t RenderingFit::most_patterned() const {
    const auto found = std::max_element(shots.begin(), shots.end(), [](const RenderedShot &a, const RenderedShot &b) {
        return a.found.pattern_levels < b.found.pattern_levels;
    });
    return static_cast<uint32_t>(found - shots.begin());
}

lensprof_status fit_shots(RenderingFit &fit, lensprof_error *error) {
    std::vector<Area> all;
    const lensprof_status status = gather_areas(fit, all, error);
    if (status != LENSPROF_OK) return status;
    std::vector<double> radii;
    for (const RenderedShot &shot : fit.shots) radii.push_back(shot.found.radius);
    const uint32_t channels = fit.shots[0].found.channels, count = static_cast<uint32_t>(fit.shots.size());
    const FitRequest request{all, count, channels, fit.prior, nullptr, kLeaveNone, fit.stop};
    const CurveFit curve = fit_curve(request);
    const Spread spread = leave_out(request, curve, radii);
    lensprof_rendering_result &result = fit.result;
    lensprof_rendering_result_init(&result);
    result.response = curve.response();
    result.gamma = gamma_of(curve.gauge());
    describe_levels(all, channels, result);
    const double curve_sigma =
        std::hypot(std::max(spread.gauge, curve.gauge_sigma()), kCommonSigma, unseen_sigma(result));
    const double scatter = count > 1 ? scatter_of_shots(fit) : 0.0;
    uint32_t corrected = 0;
    for (uint32_t i = 0; i < count; i++) {
        lensprof_rendering_shot &shot = fit.shots[i].found;
        describe_shot(curve, i, fit.shots[i]);
        shot.corner_sigma = std::max(spread.corners[i], 0.001);
        shot.corrects_falloff = std::log(shot.corner) > std::max(3.0 * shot.corner_sigma, kMinCorrection);
        corrected += shot.corrects_falloff, result.areas += shot.areas;
    }
    const double local = kByPattern * fit.shots[fit.most_patterned()].found.pattern_ev;
    result.gamma_sigma = std::sqrt(curve_sigma * curve_sigma + local * local + scatter / double(count));
    if (count == 1) fit.shots[0].found.gamma = result.gamma, fit.shots[0].found.gamma_sigma = result.gamma_sigma;
    result.corrects_falloff = 2 * corrected > count;
    result.shots = count;
    judge_rendering(fit);
    return LENSPROF_OK;
}

}  // namespace lensprof
