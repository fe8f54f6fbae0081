#include "photo/cards/unit_batch.hpp"

#include <algorithm>

#include "photo/base/format.hpp"

namespace lensprof {
namespace {

constexpr uint32_t green = 1, compared_places = 25;  // along the longer side
constexpr size_t least_units = 3;                    // of two that differ, nobody can tell which is unusual

// A unit that was measured.
struct MeasuredUnit {
    size_t number;  // in the batch
    const CardFit *fit;
    Shading shading;
    double corner;  // mean of green
};

double corner_light(const Shading &shading, const Lattice &lattice) {
    double sum = 0.0;
    for (const uint32_t corner : lattice.corners()) sum += 0.25 * shading.light[green][corner];
    return sum;
}

// What units are compared with, and its errors.
struct Usual {
    Shading shading;  // sigma: of the light, relative
    Middle corner, centre[2];
    double cells = NAN;  // that a shot of a unit has; NAN: a stated profile, which does not tell
    bool has_circle = false;
};

double cells_per_shot(const MeasuredUnit &unit) {
    return static_cast<double>(unit.fit->fit.cells) / std::max(1u, unit.fit->fit.shots);
}

// Width over height of the frame, in which profiles are: that of the sensor, which is not higher than wide.
double shape_of(const CardFit &fit) { return std::max(fit.aspect, 1.0 / fit.aspect); }

double longer_side_of(const CardFit &fit) { return std::max(fit.width, fit.height); }

// The median of units: up to half of them may be anything without changing it by more than the others scatter.
Usual median_unit(const std::vector<MeasuredUnit> &units, const std::vector<bool> &is_used, const Lattice &lattice) {
    const auto over_units = [&](auto value) {
        std::vector<double> values;
        for (size_t n = 0; n < units.size(); n++)
            if (is_used[n]) values.push_back(value(units[n]));
        return middle_of(values);
    };
    Usual usual;
    for (uint32_t c = 0; c < 3; c++)
        for (uint32_t i = 0; i < lattice.size(); i++) {
            const Middle light = over_units([&](const MeasuredUnit &unit) { return unit.shading.light[c][i]; });
            usual.shading.light[c].push_back(light.median);
            usual.shading.sigma[c].push_back(light.sigma / light.median);
        }
    usual.corner = over_units([](const MeasuredUnit &unit) { return unit.corner; });
    usual.cells = over_units([](const MeasuredUnit &unit) { return cells_per_shot(unit); }).median;
    for (int axis = 0; axis < 2; axis++)
        usual.centre[axis] =
            over_units([axis](const MeasuredUnit &unit) { return unit.fit->profile->vignetting[0].center[axis]; });
    return usual;
}

// A stated profile is taken as exact.
Usual usual_of(const lensprof_profile &reference, const Lattice &lattice) {
    Usual usual;
    usual.shading = shading_of(reference, lattice);
    for (std::vector<double> &sigma : usual.shading.sigma) std::fill(sigma.begin(), sigma.end(), 0.0);
    usual.corner = {corner_light(usual.shading, lattice), 0.0, 0.0};
    for (int axis = 0; axis < 2; axis++) usual.centre[axis] = {reference.vignetting[0].center[axis], 0.0, 0.0};
    usual.has_circle = reference.image_circle.radius > 0.0;
    return usual;
}

Difference relative(double own, double own_sigma, double usual, double usual_sigma) {
    return {own / usual - 1.0, own / usual * std::hypot(own_sigma, usual_sigma)};
}

// Keeps the larger one.
bool keep_larger(const Difference &other, Difference &largest) {
    if (!(std::fabs(other.value) > std::fabs(largest.value)) && !std::isnan(largest.value)) return false;
    if (std::isnan(other.value)) return false;
    largest = other;
    return true;
}

void compare_frame(const MeasuredUnit &unit, const Usual &usual, const Lattice &lattice, UnitResult &result) {
    const Shading &own = unit.shading, &other = usual.shading;
    const bool is_coloured = has_colours(*unit.fit->profile);
    result.map.clear(), result.frame = result.color = {};
    for (uint32_t i = 0; i < lattice.size(); i++) {
        const auto difference = [&](uint32_t c) {
            return relative(own.light[c][i], own.sigma[c][i], other.light[c][i], other.sigma[c][i]);
        };
        const Difference of_green = difference(green);
        result.map.push_back(of_green.value);
        for (const uint32_t c : {0u, 1u, 2u}) {
            const Difference here = difference(c);
            if (keep_larger(here, result.frame)) {
                const std::array<double, 2> place = lattice.place(i);
                result.frame_at[0] = place[0] / (lattice.width() - 1.0);
                result.frame_at[1] = place[1] / (lattice.height() - 1.0);
            }
            if (is_coloured && c != green)
                keep_larger({(1.0 + here.value) / (1.0 + of_green.value) - 1.0, std::hypot(here.sigma, of_green.sigma)},
                            result.color);
        }
    }
}

void compare_corner(const MeasuredUnit &unit, const Usual &usual, UnitResult &result) {
    result.corner = relative(unit.corner, unit.fit->fit.corner_sigma / unit.fit->fit.corner, usual.corner.median,
                             usual.corner.sigma / usual.corner.median);
}

// The centre is the last of the parameters of a covariance.
void compare_centre(const MeasuredUnit &unit, const Usual &usual, UnitResult &result) {
    const lensprof_profile &profile = *unit.fit->profile;
    const uint32_t size = profile.covariance_size;
    double square = 0.0, variance = 0.0;
    for (uint32_t axis = 0; axis < 2; axis++) {
        const uint32_t row = size - 2 + axis;
        result.centre[axis] = profile.vignetting[0].center[axis];
        result.centre_sigma[axis] = size >= 5 ? std::sqrt(profile.covariance[row * size + row]) : NAN;
        const double off = result.centre[axis] - usual.centre[axis].median,
                     sigma = std::hypot(result.centre_sigma[axis], usual.centre[axis].sigma);
        square += off * off, variance += off * off * sigma * sigma;
    }
    result.center = {std::sqrt(square), square > 0.0 ? std::sqrt(variance / square) : result.centre_sigma[0]};
}

// Cells that are black, saturated or beyond an edge, and large spots, are left out of the fit, which continues the
// falloff there: a covered lens would pass. Without other units, what the fit of this one states.
// Spots that are not as deep as differences may be do not count.
double unseen_share(const MeasuredUnit &unit, const Usual &usual, const UnitLimits &limits) {
    const CardFit &fit = *unit.fit;
    double shallow = 0.0, deep = 0.0;
    for (uint32_t n = 0; n < std::min<uint32_t>(fit.fit.spots, LENSPROF_FLAT_SPOTS); n++) {
        const lensprof_flat_spot &spot = fit.fit.spot[n];
        const double share = M_PI * spot.radius * spot.radius / (static_cast<double>(fit.width) * fit.height);
        (spot.depth < limits.frame ? shallow : deep) += share;
    }
    if (std::isfinite(usual.cells)) return std::max(0.0, 1.0 - cells_per_shot(unit) / usual.cells - shallow);
    double share = usual.has_circle ? 0.0 : fit.fit.edge_share;
    for (const lensprof_flat_image_quality &quality : fit.quality)
        share = std::max({share, quality.black_share, quality.white_share});
    return share + deep;
}

void judge(const UnitLimits &limits, const Usual &usual, UnitResult &result) {
    std::vector<std::string> exceeded;
    if (result.unseen > limits.unseen)
        exceeded.push_back(
            format("%.1f %% of the frame is black, saturated, covered or dirty, more than of other units (limit %g %%)",
                   100.0 * result.unseen, 100.0 * limits.unseen));
    if (std::isnan(result.corner.value) && std::isfinite(usual.corner.median))
        exceeded.push_back("corner without light");
    const auto compare = [&](const char *name, const Difference &difference, double limit, const std::string &place) {
        if (!(std::fabs(difference.value) > limit)) return;
        exceeded.push_back(format("%s %+.2f +- %.2f %%%s (limit %g %%)", name, 100.0 * difference.value,
                                  100.0 * difference.sigma, place.c_str(), 100.0 * limit));
    };
    compare("corner", result.corner, limits.corner, "");
    compare("centre", result.center, limits.center, format(" at %+.3f, %+.3f", result.centre[0], result.centre[1]));
    compare("frame", result.frame, limits.frame,
            format(" at %.0f, %.0f %% of width and height", 100.0 * result.frame_at[0], 100.0 * result.frame_at[1]));
    compare("colour", result.color, limits.color, "");
    result.verdict = exceeded.empty() ? UnitVerdict::pass : UnitVerdict::fail;
    result.reason = joined(exceeded, "; ");
}

void compare(const std::vector<MeasuredUnit> &units, const Usual &usual, const UnitLimits &limits, UnitBatch &batch) {
    for (const MeasuredUnit &unit : units) {
        UnitResult &result = batch.units[unit.number];
        compare_frame(unit, usual, batch.lattice, result);
        compare_corner(unit, usual, result);
        compare_centre(unit, usual, result);
        result.unseen = unseen_share(unit, usual, limits);
        judge(limits, usual, result);
    }
    batch.usual = usual.shading;
}

std::vector<bool> passing(const std::vector<MeasuredUnit> &units, const UnitBatch &batch) {
    std::vector<bool> pass;
    for (const MeasuredUnit &unit : units) pass.push_back(batch.units[unit.number].verdict == UnitVerdict::pass);
    return pass;
}

// Compares with the median of all, then with that of the units that pass, until they remain the same: units that differ
// to one side would else move it within the scatter of the others. If fewer than half pass, the first stands.
void compare_with_median(const std::vector<MeasuredUnit> &units, const UnitLimits &limits, UnitBatch &batch) {
    constexpr int most_rounds = 5;
    const std::vector<bool> all(units.size(), true);
    std::vector<bool> used = all;
    for (int round = 0; round < most_rounds; round++) {
        compare(units, median_unit(units, used, batch.lattice), limits, batch);
        const std::vector<bool> pass = passing(units, batch);
        if (2 * static_cast<size_t>(std::count(pass.begin(), pass.end(), true)) < units.size()) {
            compare(units, median_unit(units, all, batch.lattice), limits, batch);
            batch.note =
                "fewer than half of the units pass: they may be of two types, or the limits are too narrow "
                "for what is usual";
            return;
        }
        if (pass == used) return;
        used = pass;
    }
}

// The mean profile is that of the units that pass, else of all.
void set_mean(const std::vector<MeasuredUnit> &units, UnitBatch &batch) {
    std::vector<bool> pass = passing(units, batch);
    if (std::count(pass.begin(), pass.end(), true) == 0) pass.assign(units.size(), true);
    std::vector<const CardFit *> fits;
    for (size_t n = 0; n < units.size(); n++)
        if (pass[n]) fits.push_back(units[n].fit);
    batch.mean = mean_profile(fits, batch.lattice.aspect);
    batch.mean->provenance.images = 0;
    for (const CardFit *fit : fits) batch.mean->provenance.images += static_cast<uint32_t>(fit->files.size());
}

// Lenses are off to all sides: what all have in common is more likely the light.
void note_slope(UnitBatch &batch) {
    constexpr double noted = 0.02;  // half diagonals
    const double *centre = batch.mean->vignetting[0].center;
    if (batch.units.size() < least_units || !batch.note.empty() || std::hypot(centre[0], centre[1]) < noted) return;
    batch.note = format(
        "the mean centre is %.1f %% of half a diagonal from the middle: the light of the fixture may "
        "slope, which the mean profile then contains; the differences do not",
        100.0 * std::hypot(centre[0], centre[1]));
}

// The shape of the frame that most units have.
double usual_shape(const std::vector<MeasuredSetting> &settings, const UnitBatch &batch) {
    std::vector<double> shapes;
    for (const UnitResult &unit : batch.units)
        if (settings[unit.setting].is_good()) shapes.push_back(shape_of(*settings[unit.setting].fit));
    return shapes.empty() ? usual_aspect : middle_of(shapes).median;
}

// The size of the frame that most units have, px of the longer side. Another type is often seen by nothing else.
double usual_side(const std::vector<MeasuredSetting> &settings, const UnitBatch &batch) {
    std::vector<double> sides;
    for (const UnitResult &unit : batch.units)
        if (settings[unit.setting].is_good()) sides.push_back(longer_side_of(*settings[unit.setting].fit));
    return sides.empty() ? 0.0 : middle_of(sides).median;
}

std::vector<MeasuredUnit> measured_units(const std::vector<MeasuredSetting> &settings, UnitBatch &batch) {
    constexpr double same_shape = 0.01;
    const double side = usual_side(settings, batch);
    std::vector<MeasuredUnit> units;
    for (size_t n = 0; n < batch.units.size(); n++) {
        UnitResult &result = batch.units[n];
        const MeasuredSetting &setting = settings[result.setting];
        if (!setting.is_good()) {
            result.reason = setting.refusal;
        } else if (setting.fit->is_turn_unknown) {
            result.reason =
                "its pictures are higher than wide, and no orientation states how they were rotated: its "
                "centre is unknown; give the pictures as the camera wrote them";
        } else if (std::fabs(std::log(shape_of(*setting.fit) / batch.lattice.aspect)) > same_shape) {
            result.reason = "its frame has another shape than that of the other units";
        } else if (std::fabs(longer_side_of(*setting.fit) / side - 1.0) > same_shape) {
            result.reason =
                format("its frame has %.0f px on the longer side, those of the other units %.0f: another type?",
                       longer_side_of(*setting.fit), side);
        } else {
            const Shading shading = shading_of(*setting.fit->profile, batch.lattice);
            units.push_back({n, &*setting.fit, shading, corner_light(shading, batch.lattice)});
        }
    }
    return units;
}

void compare_batch(const std::vector<MeasuredSetting> &settings, const UnitLimits &limits,
                   const lensprof_profile *reference, UnitBatch &batch) {
    batch.lattice = lattice_of(usual_shape(settings, batch), compared_places, false);
    const std::vector<MeasuredUnit> units = measured_units(settings, batch);
    if (units.empty()) return;
    if (reference) {
        compare(units, usual_of(*reference, batch.lattice), limits, batch);
    } else if (units.size() >= least_units) {
        compare_with_median(units, limits, batch);
    } else {
        for (const MeasuredUnit &unit : units) {
            UnitResult &result = batch.units[unit.number];
            result.verdict = UnitVerdict::not_compared;
            result.reason =
                "fewer than 3 units of this setting do not show what is usual; give more, or a profile to "
                "compare with: "
                + option_name("units_against");
        }
    }
    set_mean(units, batch);
    note_slope(batch);
}

}  // namespace

size_t UnitBatch::count(UnitVerdict verdict) const {
    return static_cast<size_t>(
        std::count_if(units.begin(), units.end(), [&](const UnitResult &unit) { return unit.verdict == verdict; }));
}

std::vector<UnitBatch> compare_units(const std::vector<MeasuredSetting> &settings, const UnitLimits &limits,
                                     const lensprof_profile *reference) {
    std::vector<UnitBatch> batches;
    for (size_t n = 0; n < settings.size(); n++) {
        if (batches.empty() || batches.back().group != settings[n].of.group)
            batches.emplace_back().group = settings[n].of.group;
        batches.back().units.emplace_back().setting = n;
    }
    for (UnitBatch &batch : batches) compare_batch(settings, limits, reference, batch);
    return batches;
}

}  // namespace lensprof
