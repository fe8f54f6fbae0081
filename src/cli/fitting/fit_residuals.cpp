#include "cli/fitting/fit_residuals.hpp"
#include "photo/scene/exposures.hpp"
#include "photo/scene/sampling.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

namespace lensprof {
namespace {

using Json = nlohmann::ordered_json;

constexpr double levels = 255.0;
constexpr double darkest = 2.0 / levels, brightest = 250.0 / levels;
constexpr int radius_bins = 20, grey_bins = 17, joint_bins = 48, frame_columns = 12;
constexpr size_t min_in_bin = 5;

uint32_t channel_of(const Fitted &fitted, uint32_t image) { return fitted.falloff_curves_of(image) == 3 ? 1 : 0; }

PairEnd end_of(const Fitted &fitted, const Scene &scene, const lensprof_pair &pair, int side) {
    PairEnd end{};
    end.image = pair.image[side];
    end.value = pair.value[side][1];
    const lensprof_vignetting falloff = fitted.falloff_of(end.image)[channel_of(fitted, end.image)];
    const FalloffFrame frame = falloff_frame_of(scene.images[end.image]);
    const double r2 =
        lensprof_vignetting_r2(&falloff, frame.width, frame.height, pair.xy[side][0], pair.xy[side][1], nullptr);
    end.r = std::sqrt(r2);
    end.across = (pair.xy[side][0] + 0.5) / frame.width, end.down = (pair.xy[side][1] + 0.5) / frame.height;
    end.attenuation = lensprof_vignetting_eval(&falloff, r2, nullptr) * std::exp2(fitted.exposures[end.image].ev)
                      * fitted.exposures[end.image].white_balance[1];
    end.light = lensprof_response_invert(&fitted.response_of(end.image), end.value, nullptr) / end.attenuation;
    return end;
}

bool is_exposed(const PairEnd &end) { return end.value > darkest && end.value < brightest && end.light > 0.0; }

// Levels by which an end is brighter than the other end predicts.
double residual_of(const Fitted &fitted, const PairEnd &end, const PairEnd &other) {
    const double predicted =
        lensprof_response_eval(&fitted.response_of(end.image), other.light * end.attenuation, nullptr);
    return levels * (end.value - predicted);
}

double quantile(std::vector<double> &values, double q) {
    const auto index = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1) + 0.5);
    std::nth_element(values.begin(), values.begin() + index, values.end());
    return values[static_cast<size_t>(index)];
}

// The median, half the distance of the quartiles, and the number of values; null without enough.
Json spread_json(double position, std::vector<double> &values) {
    if (values.size() < min_in_bin) return {{"at", position}, {"mean", nullptr}, {"spread", nullptr}, {"count", 0}};
    const double low = quantile(values, 0.25), high = quantile(values, 0.75);
    return {
        {"at", position}, {"mean", quantile(values, 0.5)}, {"spread", 0.5 * (high - low)}, {"count", values.size()}};
}

Json bins_json(std::vector<std::vector<double>> &bins, double width) {
    Json json = Json::array();
    for (size_t i = 0; i < bins.size(); i++)
        json.push_back(spread_json((static_cast<double>(i) + 0.5) * width, bins[i]));
    return json;
}

size_t bin_of(double share, int bins) {
    return static_cast<size_t>(std::clamp(static_cast<int>(share * bins), 0, bins - 1));
}

class JointHistogram {
public:
    void add(double first, double second) {
        counts_[bin_of(second, joint_bins) * joint_bins + bin_of(first, joint_bins)]++;
    }
    Json json() const {
        Json cells = Json::array();
        for (size_t i = 0; i < counts_.size(); i++)
            if (counts_[i]) cells.push_back({i % joint_bins, i / joint_bins, counts_[i]});
        return {{"bins", joint_bins}, {"cells", cells}};
    }

private:
    std::vector<uint32_t> counts_ = std::vector<uint32_t>(size_t(joint_bins) * joint_bins, 0);
};

// The value that an end has at the mean exposure, without falloff.
double corrected(const Fitted &fitted, const lensprof_exposure &mean, const PairEnd &end) {
    return lensprof_response_eval(&fitted.response_of(fitted.reference),
                                  end.light * std::exp2(mean.ev) * mean.white_balance[1], nullptr);
}

}  // namespace

std::vector<PairEnds> ends_of_pairs(const FitInput &input, const Fitted &best, const Scene &scene) {
    std::vector<PairEnds> all;
    const std::vector<lensprof_pair> pairs =
        input.observations.empty() ? input.pairs : pairs_of_tracks(input.observations);
    for (const lensprof_pair &pair : pairs) {
        if (std::isnan(best.exposures[pair.image[0]].ev) || std::isnan(best.exposures[pair.image[1]].ev)) continue;
        const PairEnds ends{{end_of(best, scene, pair, 0), end_of(best, scene, pair, 1)}};
        if (is_exposed(ends.end[0]) && is_exposed(ends.end[1])) all.push_back(ends);
    }
    return all;
}

Json falloff_points(const std::vector<PairEnds> &all, const Fitted &best) {
    constexpr double min_radius_difference = 0.1;  // of radii: else a pair shows nothing of the falloff
    std::vector<std::vector<double>> bins(radius_bins);
    for (const PairEnds &ends : all) {
        const bool second_is_far = ends.end[1].r > ends.end[0].r;
        const PairEnd &far = ends.end[second_is_far], &near = ends.end[!second_is_far];
        const bool is_of_reference =
            best.settings.empty() || best.setting_of[far.image] == best.setting_of[best.reference];
        if (!is_of_reference || far.r - near.r < min_radius_difference) continue;
        const double exposure = std::exp2(best.exposures[far.image].ev) * best.exposures[far.image].white_balance[1];
        bins[bin_of(far.r, radius_bins)].push_back(far.light / near.light * far.attenuation / exposure);
    }
    Json json = Json::array();
    for (size_t i = 0; i < bins.size(); i++) {
        if (bins[i].size() < min_in_bin) continue;
        const double low = quantile(bins[i], 0.25), high = quantile(bins[i], 0.75);
        // Standard error of a median: 1.253 sigma / sqrt(n), and sigma is 0.741 times the distance of the quartiles.
        const double sigma = 1.253 * 0.741 * (high - low) / std::sqrt(static_cast<double>(bins[i].size()));
        json.push_back({{"r", (static_cast<double>(i) + 0.5) / radius_bins},
                        {"m", quantile(bins[i], 0.5)},
                        {"sigma", sigma},
                        {"count", bins[i].size()}});
    }
    return json;
}

Json residual_figures(const std::vector<PairEnds> &all, const Fitted &best, const Scene &scene) {
    if (all.empty()) return {};
    const lensprof_exposure mean = mean_exposure(best.exposures);
    const lensprof_camera &camera = scene.images[best.reference].camera;
    const double aspect = double(camera.height) / camera.width;
    const int rows = std::clamp(static_cast<int>(std::lround(frame_columns * aspect)), 2, 4 * frame_columns);
    std::vector<std::vector<double>> by_radius(radius_bins), by_grey(grey_bins), by_place(size_t(rows) * frame_columns);
    JointHistogram before, after;
    for (const PairEnds &ends : all) {
        before.add(ends.end[0].value, ends.end[1].value);
        after.add(corrected(best, mean, ends.end[0]), corrected(best, mean, ends.end[1]));
        for (int side = 0; side < 2; side++) {
            const PairEnd &end = ends.end[side];
            const double residual = residual_of(best, end, ends.end[1 - side]);
            by_radius[bin_of(end.r, radius_bins)].push_back(residual);
            by_grey[bin_of(end.value, grey_bins)].push_back(residual);
            by_place[bin_of(end.down, rows) * frame_columns + bin_of(end.across, frame_columns)].push_back(residual);
        }
    }
    Json means = Json::array(), counts = Json::array();
    for (auto &cell : by_place) {
        counts.push_back(cell.size());
        means.push_back(cell.size() < min_in_bin ? Json() : Json(quantile(cell, 0.5)));
    }
    return {
        {"joint_before", before.json()},
        {"joint_after", after.json()},
        {"by_radius", bins_json(by_radius, 1.0 / radius_bins)},
        {"by_grey", bins_json(by_grey, levels / grey_bins)},
        {"frame",
         {{"columns", frame_columns}, {"aspect", aspect * frame_columns / rows}, {"mean", means}, {"count", counts}}}};
}

}  // namespace lensprof
