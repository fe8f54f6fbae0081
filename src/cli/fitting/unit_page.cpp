// The report of units of one type as a web page (cli/page).
#include <algorithm>

#include <nlohmann/json.hpp>

#include "cli/fitting/unit_report.hpp"
#include "cli/page/page.hpp"
#include "photo/base/format.hpp"

namespace lensprof {
namespace {

constexpr size_t most_maps = 12;  // of units that fail

std::string shown(const Difference &difference) {
    if (std::isnan(difference.value)) return "–";
    return format("%+.2f", 100.0 * difference.value)
           + (std::isnan(difference.sigma) ? "" : format(" ± %.2f", 100.0 * difference.sigma));
}

// Rows of the units that do not pass.
Json failed_rows(const UnitCards &cards, const UnitBatch &batch) {
    Json rows = Json::array();
    for (const UnitResult *unit : failed_first(batch))
        if (unit->verdict != UnitVerdict::pass)
            rows.push_back({cards.setting_of(*unit).of.unit, unit_verdict_name(unit->verdict), shown(unit->corner),
                            shown(unit->center), shown(unit->frame), shown(unit->color), unit->reason});
    return rows;
}

// One figure of all units in the order of its size, %.
Json plot_of(const UnitCards &cards, const UnitBatch &batch, const char *name, Difference UnitResult::*figure,
             double limit) {
    Json points = Json::array();
    for (const UnitResult &unit : batch.units)
        if (const Difference &difference = unit.*figure; !std::isnan(difference.value))
            points.push_back({{"unit", cards.setting_of(unit).of.unit},
                              {"value", 100.0 * difference.value},
                              {"sigma", std::isnan(difference.sigma) ? 0.0 : 100.0 * difference.sigma},
                              {"pass", unit.verdict == UnitVerdict::pass}});
    return {{"name", name}, {"limit", 100.0 * limit}, {"points", points}};
}

Json map_of(const UnitBatch &batch, const std::string &name, const std::vector<double> &values) {
    Json cells = Json::array();
    for (const double value : values) cells.push_back(std::isfinite(value) ? Json(100.0 * value) : Json());
    return {{"name", name}, {"columns", batch.lattice.columns}, {"cells", cells}};
}

// At each place, the largest difference of a unit that passes.
std::vector<double> largest_differences(const UnitBatch &batch) {
    std::vector<double> largest(batch.lattice.size(), NAN);
    for (const UnitResult &unit : batch.units)
        for (size_t i = 0; i < unit.map.size() && unit.verdict == UnitVerdict::pass; i++)
            if (!(std::fabs(unit.map[i]) <= std::fabs(largest[i]))) largest[i] = unit.map[i];
    return largest;
}

Json batch_json(const UnitCards &cards, const UnitBatch &batch) {
    const UnitLimits &limits = cards.options.limits;
    Json plots = Json::array(), maps = Json::array();
    plots.push_back(plot_of(cards, batch, "corner", &UnitResult::corner, limits.corner));
    plots.push_back(plot_of(cards, batch, "centre", &UnitResult::center, limits.center));
    plots.push_back(plot_of(cards, batch, "frame", &UnitResult::frame, limits.frame));
    plots.push_back(plot_of(cards, batch, "colour", &UnitResult::color, limits.color));
    Json mean;
    if (!batch.usual.light[1].empty()) {
        mean = map_of(batch, "Usual light", batch.usual.light[1]);
        maps.push_back(map_of(batch, "largest of those that pass", largest_differences(batch)));
        for (const UnitResult *unit : failed_first(batch))
            if (unit->verdict == UnitVerdict::fail && maps.size() <= most_maps)
                maps.push_back(map_of(batch, cards.setting_of(*unit).of.unit, unit->map));
    }
    return {{"title", batch_title(cards, batch)},
            {"note", batch.note},
            {"failed", failed_rows(cards, batch)},
            {"plots", plots},
            {"mean", mean},
            {"maps", maps}};
}

size_t counted_verdicts(const UnitCards &cards, UnitVerdict verdict) {
    size_t count = 0;
    for (const UnitBatch &batch : cards.batches) count += batch.count(verdict);
    return count;
}

}  // namespace

std::string units_page(const UnitCards &cards, const std::string &command, const std::vector<std::string> &warnings) {
    const size_t pass = counted_verdicts(cards, UnitVerdict::pass), fail = counted_verdicts(cards, UnitVerdict::fail),
                 others = counted_verdicts(cards, UnitVerdict::not_measured)
                          + counted_verdicts(cards, UnitVerdict::not_compared) + cards.missing.size(),
                 all = pass + fail + others;
    Json page = new_page("units", batch_title(cards, cards.batches.front()),
                         "Units of one type, from pictures of a white card", command);
    page["verdict"] = {{"level", pass == all ? "good"
                                 : pass      ? "warn"
                                             : "bad"},
                       {"headline", pass == all ? "All units pass." : format("%zu of %zu units pass.", pass, all)},
                       {"details", warnings},
                       {"notes", Json::array()}};
    const UnitLimits &limits = cards.options.limits;
    page["facts"] = Json::array(
        {{"units", std::to_string(all)},
         {"pass", std::to_string(pass)},
         {"fail", std::to_string(fail)},
         {"not measured or compared", std::to_string(others)},
         {"limits", format("corner %g %%, centre %g %%, frame %g %%, colour %g %%, unseen %g %%", 100.0 * limits.corner,
                           100.0 * limits.center, 100.0 * limits.frame, 100.0 * limits.color, 100.0 * limits.unseen)}});
    page["batches"] = Json::array(), page["falloffs"] = Json::array(), page["responses"] = Json::array();
    for (const UnitBatch &batch : cards.batches) page["batches"].push_back(batch_json(cards, batch));
    page["left_out"] = Json::array();
    for (const UnitWithoutPictures &unit : cards.missing)
        page["left_out"].push_back({{"name", unit.unit}, {"reason", unit.reason}});
    for (const LeftOutCard &card : cards.left_out)
        page["left_out"].push_back({{"name", card.file}, {"reason", card.reason}});
    return page_of(page);
}

}  // namespace lensprof
