#include "cli/response/findings.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include <Eigen/Dense>

#include "cli/program/error.hpp"
#include "cli/program/format.hpp"

namespace lensprof {
namespace {

constexpr uint32_t min_places = 300;  // with a grey value
constexpr size_t min_in_region = 20;
constexpr int map_columns = 12, map_rows = 9;
constexpr double min_in_cell = 8.0;  // values, of each half
// Error of ln gamma per EV of the map left by local tone mapping: the curve absorbs the rest (measured: 1.4 to 2.2).
constexpr double by_pattern = 2.0;
constexpr double min_correction = 0.02;  // of irradiance
// Errors common to all areas, which a jackknife does not show: block-wise rendering, rounding of colours, denoising by
// the camera.
constexpr double common_sigma = 0.004;
constexpr double scatter_unseen = 0.5;  // of ln gamma, for levels that are not measured
const double gauge_range = std::log(208.0 / 48.0);

double gamma_of(double gauge) { return std::exp(gauge) / gauge_range; }

bool is_used(const Place &place) {
    return place.use[0] == Place::grey || place.use[1] == Place::grey || place.use[2] == Place::grey;
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
    std::array<size_t, region_count> counts{};
    for (const Place &place : request.places) counts[static_cast<size_t>(region_of(place))]++;
    std::vector<CurveFit> fits;
    for (int region = 0; region < region_count; region++) {
        if (counts[static_cast<size_t>(region)] < min_in_region) continue;
        FitRequest without{request.places, request.pictures, request.channels, request.prior, &fit, region};
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
    for (const int half : {leave_rougher, leave_colourful}) {
        const CurveFit without =
            fit_curve({request.places, request.pictures, request.channels, request.prior, &fit, half});
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
    std::array<std::array<Sums, map_columns * map_rows>, 2> half{};

    void add(const CurveFit &fit, const Place &place, size_t half_index, uint32_t channels) {
        const int column = std::clamp(static_cast<int>(place.across * map_columns), 0, map_columns - 1);
        const int row = std::clamp(static_cast<int>(place.down * map_rows), 0, map_rows - 1);
        Sums &sums = half[half_index][static_cast<size_t>(row * map_columns + column)];
        const Prediction prediction = fit.predict(place);
        for (size_t c = 0; c < channels; c++) {
            double residual = 0.0;
            const double weight = fit.weight(place, prediction, c, &residual);
            if (weight == 0.0 || place.use[c] != Place::grey) continue;
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
            if (a.count < min_in_cell || b.count < min_in_cell) continue;
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

void describe_file(const CurveFit &fit, const std::vector<Place> &places, uint32_t picture, FileFindings &file) {
    HalfMaps maps;
    size_t number = 0;
    for (Place place : places) {
        place.picture = picture;
        maps.add(fit, place, number++ % 2, file.from.channels);
    }
    file.rendering = fit.renderings[picture];
    file.corner = radial_gain(file.rendering, file.radius);
    file.noise_levels = 255.0 * fit.noise[0];
    file.pattern_levels = maps.rms(&HalfMaps::Sums::levels);
    file.pattern_ev = maps.rms(&HalfMaps::Sums::ev);
    file.white_ev = white_ev_of(file.rendering, file.from.channels);
}

void describe_levels(const std::vector<Place> &places, uint32_t channels, ResponseReport &report) {
    std::vector<double> levels;
    std::array<int, 10> tenths{};
    size_t white = 0;
    for (const Place &place : places)
        for (size_t c = 0; c < channels; c++) {
            white += place.use[c] == Place::white;
            if (place.use[c] != Place::grey) continue;
            levels.push_back(255.0 * place.grey_value[c]);
            tenths[static_cast<size_t>(std::min(place.grey_value[c], 0.999f) * 10.0f)]++;
        }
    std::sort(levels.begin(), levels.end());
    if (!levels.empty())
        report.lowest = levels[levels.size() / 100], report.highest = levels[levels.size() - 1 - levels.size() / 100];
    report.tenths = static_cast<uint32_t>(std::count_if(tenths.begin(), tenths.end(), [](int n) { return n >= 20; }));
    report.shows_white = white >= 20;
}

std::string too_few_message(const FileFindings &file) {
    const PlacesOf &f = file.from;
    return file.file
           + format(
               ": too few areas are smooth and unclipped in both pictures (%u; of %u squares of the rendered picture "
               "%u are black, %u white and %u saturated in the raw file); take a picture with smooth areas of all "
               "brightnesses",
               file.places, f.squares, f.black, f.white, f.saturated);
}

// Error of ln gamma if the darkest or brightest part between levels 48 and 208 is not measured: cameras differ there.
double unseen_sigma(const ResponseReport &report) {
    const auto light = [&](double level) {
        return std::log(std::max(lensprof_response_invert(&report.response, level / 255.0, nullptr), 1e-9));
    };
    const double low = std::clamp(report.lowest, 48.0, 208.0), high = std::clamp(report.highest, low, 208.0);
    const double range = light(208.0) - light(48.0), seen = light(high) - light(low);
    return range > 0.0 ? scatter_unseen * (1.0 - seen / range) : scatter_unseen;
}

// For individual files: their exponents, and scatter beyond their errors.
double scatter_of_files(const std::vector<std::vector<Place>> &places, const lensprof_response &prior,
                        ResponseReport &report) {
    double mean = 0.0, scatter = 0.0, stated = 0.0;
    std::vector<double> gauges;
    for (size_t i = 0; i < places.size(); i++) {
        std::vector<Place> alone = places[i];
        for (Place &place : alone) place.picture = 0;
        const FitRequest request{alone, 1, report.files[i].from.channels, prior};
        const CurveFit fit = fit_curve(request);
        const double sigma =
            std::hypot(std::max(leave_out(request, fit, {1.0}).gauge, fit.gauge_sigma()), common_sigma);
        gauges.push_back(fit.gauge());
        report.files[i].gamma = gamma_of(fit.gauge()), report.files[i].gamma_sigma = sigma;
        mean += fit.gauge() / double(places.size()), stated += sigma * sigma / double(places.size());
    }
    for (double gauge : gauges) scatter += std::pow(gauge - mean, 2) / double(std::max<size_t>(gauges.size() - 1, 1));
    return std::max(0.0, scatter - stated);
}

}  // namespace

bool FileFindings::is_corrected() const { return std::log(corner) > std::max(3.0 * corner_sigma, min_correction); }

void fit_files(const std::vector<std::vector<Place>> &places, const lensprof_response &prior, ResponseReport &report) {
    std::vector<Place> all;
    std::vector<double> radii;
    for (size_t i = 0; i < places.size(); i++) {
        FileFindings &file = report.files[i];
        float r2 = 0.0f;
        for (const Place &place : places[i]) r2 = std::max(r2, place.r2), file.places += is_used(place);
        if (file.places < min_places)
            throw Failure(ExitCode::not_usable, too_few_message(file), LENSPROF_REASON_FEW_PAIRS);
        file.radius = std::min(1.0, std::sqrt(double(r2)));
        radii.push_back(file.radius);
        all.insert(all.end(), places[i].begin(), places[i].end());
    }
    const uint32_t channels = report.files[0].from.channels;
    const FitRequest request{all, static_cast<uint32_t>(places.size()), channels, prior};
    const CurveFit fit = fit_curve(request);
    const Spread spread = leave_out(request, fit, radii);
    report.response = fit.response();
    report.gamma = gamma_of(fit.gauge());
    describe_levels(all, channels, report);
    const double curve_sigma =
        std::hypot(std::max(spread.gauge, fit.gauge_sigma()), common_sigma, unseen_sigma(report));
    const double scatter = places.size() > 1 ? scatter_of_files(places, prior, report) : 0.0;
    size_t corrected = 0;
    for (size_t i = 0; i < places.size(); i++) {
        describe_file(fit, places[i], static_cast<uint32_t>(i), report.files[i]);
        report.files[i].corner_sigma = std::max(spread.corners[i], 0.001);
        corrected += report.files[i].is_corrected();
    }
    const double local = by_pattern * most_patterned(report).pattern_ev;
    report.log_gamma_sigma = std::sqrt(curve_sigma * curve_sigma + local * local + scatter / double(places.size()));
    if (places.size() == 1) report.files[0].gamma = report.gamma, report.files[0].gamma_sigma = report.log_gamma_sigma;
    report.is_corrected = 2 * corrected > places.size();
    judge(report);
}

}  // namespace lensprof
