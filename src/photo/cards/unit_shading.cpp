#include "photo/cards/unit_shading.hpp"

#include <algorithm>
#include <cmath>

#include <lensprof/formats.h>

#include "fit/base/quantile.hpp"

namespace lensprof {
namespace {

// Whether the profile has light there.
bool is_lit(const lensprof_profile &profile, const Lattice &lattice, const std::array<double, 2> &place) {
    const double x = place[0] - 0.5 * (lattice.width() - 1.0), y = place[1] - 0.5 * (lattice.height() - 1.0);
    const double half_diagonal = 0.5 * std::hypot(lattice.width() - 1.0, lattice.height() - 1.0);
    return std::hypot(x, y) <= half_diagonal * reach_of_circle(profile.image_circle, std::atan2(y, x));
}

// The mean of both middle values of an even number.
double median_of(std::vector<double> &values) { return 0.5 * (median(values) + upper_median(values)); }

lensprof_status take_map(void *user, const lensprof_import_entry *entry) {
    return lensprof_profile_copy(static_cast<lensprof_profile *>(user), entry->profile);
}

// The falloff of a map of attenuations [place][channel].
std::shared_ptr<lensprof_profile> profile_of_map(const std::vector<float> &values, const Lattice &lattice,
                                                 uint32_t channels) {
    const lensprof_map map{lattice.columns, lattice.rows, channels, LENSPROF_MAP_ATTENUATION, values.data()};
    lensprof_import_options options;
    lensprof_import_options_init(&options);
    options.format = LENSPROF_FORMAT_MAP, options.map = &map;
    options.width = lattice.width(), options.height = lattice.height();
    std::shared_ptr<lensprof_profile> profile = new_profile();
    lensprof_error error{};
    check(lensprof_import(nullptr, 0, &options, take_map, profile.get(), &error), "mean of the units", &error);
    return profile;
}

// Parameters of a profile in the order of a covariance, but for the response, which is stated: k1..k3 per curve,
// centre.
std::vector<double> parameters_of(const lensprof_profile &profile, uint32_t curves) {
    std::vector<double> all;
    for (uint32_t curve = 0; curve < curves; curve++)
        for (const double k : profile.vignetting[profile.vignettings == 3 ? curve : 0].k) all.push_back(k);
    for (const double c : profile.vignetting[0].center) all.push_back(c);
    return all;
}

// The scatter of the units is the error of the profile for one of them. Fewer than three do not show it.
void set_scatter(const std::vector<const CardFit *> &units, lensprof_profile &profile) {
    profile.covariance_size = 0;
    if (units.size() < 3) return;
    const uint32_t size = 3 * profile.vignettings + 2;
    std::vector<std::vector<double>> parameters;
    std::vector<double> mean(size);
    for (const CardFit *unit : units) {
        parameters.push_back(parameters_of(*unit->profile, profile.vignettings));
        for (uint32_t i = 0; i < size; i++) mean[i] += parameters.back()[i] / static_cast<double>(units.size());
    }
    profile.covariance_size = size;
    for (uint32_t i = 0; i < size; i++)
        for (uint32_t j = 0; j <= i; j++) {
            double sum = 0.0;
            for (const std::vector<double> &own : parameters) sum += (own[i] - mean[i]) * (own[j] - mean[j]);
            profile.covariance[i * size + j] = profile.covariance[j * size + i] =
                sum / (static_cast<double>(units.size()) - 1.0);
        }
}

// Black and white levels are those of the sensors' samples: medians, as they may be measured per unit. An image circle
// is one of all units, or none.
void set_levels_and_circle(const std::vector<const CardFit *> &units, lensprof_profile &profile) {
    const auto median = [&](auto value) {
        std::vector<double> values;
        for (const CardFit *unit : units) values.push_back(value(*unit->profile));
        return middle_of(values).median;
    };
    for (int c = 0; c < 3; c++)
        profile.levels.black[c] = median([c](const lensprof_profile &p) { return p.levels.black[c]; });
    profile.levels.white = median([](const lensprof_profile &p) { return p.levels.white; });
    const auto has_circle = [](const CardFit *unit) { return unit->profile->image_circle.radius > 0.0; };
    profile.image_circle = {};
    if (!std::all_of(units.begin(), units.end(), has_circle)) return;
    profile.image_circle.radius = median([](const lensprof_profile &p) { return p.image_circle.radius; });
    for (int axis = 0; axis < 2; axis++)
        profile.image_circle.center[axis] =
            median([axis](const lensprof_profile &p) { return p.image_circle.center[axis]; });
}

}  // namespace

uint32_t Lattice::width() const { return static_cast<uint32_t>(std::lround(longer_side * std::min(aspect, 1.0))); }

uint32_t Lattice::height() const {
    return static_cast<uint32_t>(std::lround(longer_side * std::min(1.0 / aspect, 1.0)));
}

std::array<double, 2> Lattice::place(uint32_t index) const {
    const auto at = [this](uint32_t i, uint32_t count, uint32_t side) {
        return of_cells ? (i + 0.5) * side / count - 0.5 : i * (side - 1.0) / (count - 1.0);
    };
    return {at(index % columns, columns, width()), at(index / columns, rows, height())};
}

Lattice lattice_of(double aspect, uint32_t longer_count, bool of_cells) {
    const auto shorter =
        static_cast<uint32_t>(std::max(4.0, std::round(longer_count * std::min(aspect, 1.0 / aspect))));
    return {aspect, aspect < 1.0 ? shorter : longer_count, aspect < 1.0 ? longer_count : shorter, of_cells};
}

Shading shading_of(const lensprof_profile &profile, const Lattice &lattice) {
    const uint32_t width = lattice.width(), height = lattice.height();
    Shading shading;
    for (uint32_t c = 0; c < 3; c++) {
        const double middle =
            lensprof_profile_falloff(&profile, c, width, height, 0.5 * (width - 1.0), 0.5 * (height - 1.0), nullptr);
        for (uint32_t i = 0; i < lattice.size(); i++) {
            const std::array<double, 2> place = lattice.place(i);
            double sigma = 0.0;
            const double light = lensprof_profile_falloff(&profile, c, width, height, place[0], place[1], &sigma);
            const bool lit = is_lit(profile, lattice, place);
            shading.light[c].push_back(lit ? light / middle : NAN);
            shading.sigma[c].push_back(lit && sigma != LENSPROF_UNKNOWN ? sigma / light : NAN);
        }
    }
    return shading;
}

bool has_colours(const lensprof_profile &profile) { return profile.vignettings == 3 || profile.grid.channels == 3; }

Middle middle_of(std::vector<double> values) {
    const size_t given = values.size();
    values.erase(std::remove_if(values.begin(), values.end(), [](double value) { return !std::isfinite(value); }),
                 values.end());
    if (values.empty() || 2 * values.size() < given) return {NAN, NAN, NAN};
    const double median = median_of(values);
    for (double &value : values) value = std::fabs(value - median);
    const double scatter = mad_to_sigma * median_of(values);
    return {median, scatter, median_error * scatter / std::sqrt(static_cast<double>(values.size()))};
}

// The median of the light at each place, as one falloff and its gain grid. Medians of k1..k3 would not do: the three
// are correlated, so that a triple of medians may be the falloff of no unit, and units with a gain grid have a part of
// their falloff in it. Centres that scatter by s (half diagonals) blur the falloff by s^2/2 times its Laplacian, 0.03 %
// of the light for 2 %: a program that corrects any unit with it leaves the least.
std::shared_ptr<lensprof_profile> mean_profile(const std::vector<const CardFit *> &units, double aspect) {
    constexpr uint32_t longer_count = 48;  // two for each node of a gain grid
    auto mean = new_profile();
    check(lensprof_profile_copy(mean.get(), units.front()->profile.get()), "mean of the units");
    if (units.size() == 1) return mean;
    const Lattice lattice = lattice_of(aspect, longer_count, true);
    const bool is_coloured =
        std::any_of(units.begin(), units.end(), [](const CardFit *unit) { return has_colours(*unit->profile); });
    const uint32_t channels = is_coloured ? 3 : 1;
    std::vector<Shading> shadings;
    for (const CardFit *unit : units) shadings.push_back(shading_of(*unit->profile, lattice));
    std::vector<float> values;
    for (uint32_t i = 0; i < lattice.size(); i++)
        for (uint32_t c = 0; c < channels; c++) {
            std::vector<double> own;
            for (const Shading &shading : shadings) own.push_back(shading.light[c][i]);
            const double median = middle_of(own).median;
            values.push_back(std::isfinite(median) ? static_cast<float>(median) : 0.0f);  // 0: not known
        }
    const std::shared_ptr<lensprof_profile> fitted = profile_of_map(values, lattice, channels);
    mean->vignettings = fitted->vignettings, mean->grid = fitted->grid;
    std::copy(fitted->vignetting, fitted->vignetting + 3, mean->vignetting);
    set_scatter(units, *mean);
    set_levels_and_circle(units, *mean);
    return mean;
}

}  // namespace lensprof
