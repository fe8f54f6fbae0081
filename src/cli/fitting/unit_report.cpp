#include "cli/fitting/unit_report.hpp"

#include <algorithm>
#include <ostream>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "cli/fitting/flat.hpp"
#include "cli/fitting/lens_report.hpp"
#include "cli/fitting/shared_lines.hpp"
#include "cli/program/help_text.hpp"
#include "photo/base/format.hpp"
#include "photo/cards/card_units.hpp"
#include "photo/report/falloff.hpp"

namespace lensprof {
namespace {

UnitRule unit_rule_of(const std::string &word) {
    if (word == "auto") return {UnitRule::By::automatic, {}};
    if (word == "folder") return {UnitRule::By::folder, {}};
    if (word == "serial") return {UnitRule::By::serial, {}};
    if (is_unit_pattern(word)) return {UnitRule::By::name, word};
    throw std::invalid_argument(word + ": use auto, folder, serial, or a pattern of file names such as cam_{unit}_*");
}

// "3%" or 0.03; "3" may be meant as either, and is refused.
double limit_of(const std::string &word) {
    if (!word.empty() && word.back() == '%') return 0.01 * number_of(word.substr(0, word.size() - 1), {0.001, 100.0});
    const double share = number_of(word, {0.0, 1e6});
    if (!(share < 1.0)) throw std::invalid_argument(word + ": give a percentage, such as " + word + "%");
    return share;
}

std::string percent(const Difference &difference) {
    return std::isnan(difference.value) ? "-" : format("%+.2f", 100.0 * difference.value);
}

void print_unit(const UnitCards &cards, const UnitResult &unit, int width, std::ostream &out) {
    const MeasuredSetting &setting = cards.setting_of(unit);
    out << format("%-*s  %8zu", width, one_line(setting.of.unit).c_str(), setting.of.pictures.size());
    if (setting.fit) {
        const Corner corner = corner_of(*setting.fit);
        out << format("  %9s  %7s", with_decimals_of(100.0 * corner.sigma, 100.0 * corner.value).c_str(),
                      error_text(100.0 * corner.sigma).c_str());
    } else {
        out << "          -        -";
    }
    for (const Difference *difference : {&unit.corner, &unit.center, &unit.frame, &unit.color})
        out << format("  %7s", percent(*difference).c_str());
    out << "  " << unit_verdict_name(unit.verdict) << (unit.reason.empty() ? "" : ": ") << one_line(unit.reason)
        << "\n";
}

// Standard deviation of the light in the corners of the units that pass; nothing without any.
std::string scatter_text(const UnitCards &cards, const UnitBatch &batch) {
    std::vector<double> corners;
    for (const UnitResult &unit : batch.units)
        if (unit.verdict == UnitVerdict::pass) corners.push_back(corner_of(*cards.setting_of(unit).fit).value);
    if (corners.size() < 2) return {};
    return ", of the units that pass, which scatter by " + error_text(100.0 * middle_of(corners).scatter) + " %";
}

void print_batch(const UnitCards &cards, const UnitBatch &batch, std::ostream &out) {
    constexpr size_t most_lines = 20;
    std::vector<const UnitResult *> listed = failed_first(batch);
    if (listed.size() > most_lines)
        listed.erase(std::remove_if(listed.begin(), listed.end(),
                                    [](const UnitResult *unit) { return unit->verdict == UnitVerdict::pass; }),
                     listed.end());
    size_t width = 4;
    for (const UnitResult *unit : listed) width = std::max(width, cards.setting_of(*unit).of.unit.size());
    out << one_line(batch_title(cards, batch)) << "\n";
    if (!listed.empty())
        out << format(
            "%-*s  pictures   corner %%       +-  d corner   centre    frame   colour  result (differences in %%)\n",
            static_cast<int>(width), "unit");
    for (const UnitResult *unit : listed) print_unit(cards, *unit, static_cast<int>(width), out);
    out << "units     " << batch.units.size();
    const char *separator = ": ";
    for (const UnitVerdict verdict :
         {UnitVerdict::pass, UnitVerdict::fail, UnitVerdict::not_measured, UnitVerdict::not_compared})
        if (const size_t count = batch.count(verdict)) {
            out << separator << count << " " << unit_verdict_name(verdict);
            separator = ", ";
        }
    out << "\n";
    if (batch.mean)
        out << format("mean      corner %.2f %%",
                      100.0 * mean_light(*batch.mean, green_curve(batch.mean->vignettings), 1.0, batch.lattice.aspect))
            << scatter_text(cards, batch) << "\n";
    if (!batch.note.empty()) out << "note      " << batch.note << "\n";
}

void print_unit_notes(const UnitCards &cards, std::ostream &out) {
    SharedLines lines;
    for (const MeasuredSetting &setting : cards.settings) {
        for (const Notice &notice : setting.notices.list) lines.add_alike(notice.text, setting.of.unit);
        if (setting.fit && setting.is_good())
            for (const Finding &finding : setting.fit->verdict.findings)
                lines.add_alike(with_code(finding), setting.of.unit);
    }
    lines.print("note      ", out, "unit");
}

// Both numbers of a difference, as cells.
std::string cells_of(const Difference &difference) {
    return "," + csv_number(difference.value) + "," + csv_number(difference.sigma);
}

// The light in the corners in each curve, with its error; red and blue only where they have curves of their own.
std::string corner_cells(const MeasuredSetting &setting) {
    if (!setting.fit) return ",,,,,,";
    const Corner green = corner_of(*setting.fit);
    std::string cells = "," + csv_number(green.value) + "," + csv_number(green.sigma);
    for (const uint32_t channel : {0u, 2u}) {
        if (!has_colours(*setting.fit->profile)) {
            cells += ",,";
            continue;
        }
        double sigma = 0.0;
        (void)lensprof_profile_corner_falloff(setting.fit->profile.get(), channel, &sigma);
        cells += "," + csv_number(mean_light(*setting.fit->profile, channel, 1.0, setting.fit->aspect)) + ","
                 + csv_number(std::max(setting.fit->fit.corner_sigma, sigma));
    }
    return cells;
}

std::string csv_row(const UnitCards &cards, const UnitResult &unit) {
    const MeasuredSetting &setting = cards.setting_of(unit);
    const lensprof_profile_key &key = setting.of.key;
    std::string row = csv_cell(setting.of.unit) + "," + csv_cell(camera_name(key.camera_maker, key.camera_model)) + ","
                      + csv_cell(key.lens) + "," + csv_number(key.focal_mm) + "," + csv_number(key.aperture) + ","
                      + std::to_string(setting.of.pictures.size()) + "," + unit_verdict_name(unit.verdict);
    row += corner_cells(setting);
    for (int axis = 0; axis < 2; axis++)
        row += "," + csv_number(unit.centre[axis]) + "," + csv_number(unit.centre_sigma[axis]);
    for (const Difference *difference : {&unit.corner, &unit.center, &unit.frame, &unit.color})
        row += cells_of(*difference);
    row += "," + csv_number(unit.frame_at[0]) + "," + csv_number(unit.frame_at[1]);
    row += "," + (setting.fit ? std::to_string(setting.fit->fit.spots) : std::string());
    return row + "," + csv_number(unit.unseen) + "," + csv_cell(unit.reason) + "\n";
}

Json difference_json(const Difference &difference) {
    return {{"value", number_or_null(difference.value)}, {"sigma", number_or_null(difference.sigma)}};
}

Json unit_json(const UnitCards &cards, const UnitResult &unit) {
    const MeasuredSetting &setting = cards.setting_of(unit);
    Json files = Json::array();
    for (const CardPicture &picture : setting.of.pictures) files.push_back(picture.file);
    return {{"unit", setting.of.unit},
            {"files", files},
            {"verdict", unit_verdict_name(unit.verdict)},
            {"reason", unit.reason.empty() ? Json() : Json(unit.reason)},
            {"corner", difference_json(unit.corner)},
            {"center", difference_json(unit.center)},
            {"frame", difference_json(unit.frame)},
            {"frame_at", {number_or_null(unit.frame_at[0]), number_or_null(unit.frame_at[1])}},
            {"color", difference_json(unit.color)},
            {"unseen", number_or_null(unit.unseen)},
            {"result", setting.fit ? flat_json(*setting.fit) : Json()}};
}

}  // namespace

void declare_units(Command &command, UnitOptions &o) {
    Keys keys = command.expert().keys(
        "--units", "the pictures are of many cameras of one type: measure each alone, and compare it with the others");
    const auto given = [&o]() -> UnitRule & {
        if (!o.rule) o.rule.emplace();
        return *o.rule;
    };
    keys.word(
        "by", "WORD|PATTERN", [given](const std::string &word) { given() = unit_rule_of(word); },
        "where the unit is stated: folder, a folder for each; serial, serial numbers in EXIF; a pattern of file names such "
        "as cam_{unit}_*; or auto (default: serial numbers or folders, if all pictures have them)");
    const auto limit = [&](const char *name, double &value, const std::string &about) {
        keys.word(
            name, "PERCENT", [given, &value](const std::string &word) { (void)given(), value = limit_of(word); },
            about);
    };
    limit("corner", o.limits.corner,
          "a unit fails if the light in its corners differs by more from that of the others; default 3%");
    limit("center", o.limits.center, "likewise its centre, of half the diagonal of the frame; default 3%");
    limit("frame", o.limits.frame, "likewise the light at any place of the frame; default 5%");
    limit("unseen", o.limits.unseen,
          "likewise the share of the frame that is black, saturated, covered or dirty; default 1%");
    limit("color", o.limits.color, "likewise the light in red or blue over that in green; default 2%");
    keys.word(
        "against", "ID", [given, &o](const std::string &word) { (void)given(), o.against = profile_id_of(word); },
        "compare with this profile of the database, not with the median of the units");
    keys.word(
        "store", "yes|no",
        [given, &o](const std::string &word) {
            (void)given(), o.stores_each = index_of(word, {"no", "yes"}) == 1;
        },
        "also store a profile for each unit that passes; default no");
}

std::string batch_title(const UnitCards &cards, const UnitBatch &batch) {
    const lensprof_profile_key &key = cards.setting_of(batch.units.front()).of.key;
    std::string title = setting_title(key);
    if (const std::string temperature = temperature_text(key); !temperature.empty())
        title += (title.empty() ? "" : ", ") + temperature;
    return title.empty() ? "camera not stated" : title;
}

std::vector<const UnitResult *> failed_first(const UnitBatch &batch) {
    std::vector<const UnitResult *> units;
    for (const UnitVerdict verdict :
         {UnitVerdict::fail, UnitVerdict::not_measured, UnitVerdict::not_compared, UnitVerdict::pass})
        for (const UnitResult &unit : batch.units)
            if (unit.verdict == verdict) units.push_back(&unit);
    return units;
}

const char *unit_verdict_name(UnitVerdict verdict) {
    static const char *const names[] = {"pass", "fail", "not measured", "not compared"};
    return names[static_cast<size_t>(verdict)];
}

std::string units_csv(const UnitCards &cards) {
    std::string text =
        "unit,camera,lens,focal_mm,aperture,pictures,verdict,corner,corner_sigma,corner_red,corner_red_sigma,"
        "corner_blue,corner_blue_sigma,center_x,center_x_sigma,center_y,center_y_sigma,difference_corner,"
        "difference_corner_sigma,difference_center,difference_center_sigma,difference_frame,difference_frame_sigma,"
        "difference_color,difference_color_sigma,frame_at_x,frame_at_y,dust,unseen,reason\n";
    for (const UnitBatch &batch : cards.batches)
        for (const UnitResult &unit : batch.units) text += csv_row(cards, unit);
    const std::string head = text.substr(0, text.find('\n'));
    const auto commas = static_cast<size_t>(std::count(head.begin(), head.end(), ','));
    for (const UnitWithoutPictures &unit : cards.missing)  // the name, four unknown cells, no picture, the verdict
        text += csv_cell(unit.unit) + ",,,,,0," + unit_verdict_name(UnitVerdict::not_measured)
                + std::string(commas - 6, ',') + csv_cell(unit.reason) + "\n";
    return text;
}

ExitCode units_exit_code(const UnitCards &cards) {
    const auto passes = [](const UnitBatch &batch) { return batch.count(UnitVerdict::pass) == batch.units.size(); };
    if (!cards.missing.empty() || !std::all_of(cards.batches.begin(), cards.batches.end(), passes))
        return ExitCode::not_usable;
    return cards.left_out.empty() ? ExitCode::done : ExitCode::unreadable;
}

void print_units(const UnitCards &cards, const std::string &database, bool with_notes, std::ostream &out) {
    for (const UnitBatch &batch : cards.batches) print_batch(cards, batch, out);
    for (const UnitWithoutPictures &unit : cards.missing)
        out << one_line(unit.unit) << "  " << unit_verdict_name(UnitVerdict::not_measured) << ": "
            << one_line(unit.reason) << "\n";
    if (with_notes) print_unit_notes(cards, out);
    size_t stored = 0;
    for (const UnitBatch &batch : cards.batches) stored += batch.profile_id != 0;
    for (const MeasuredSetting &setting : cards.settings) stored += setting.fit && setting.fit->profile_id;
    if (stored) out << "stored    " << counted(stored, "profile") << " in " << database << "\n";
    print_left_out(cards.left_out, cards.given, out);
}

Json units_json(const UnitCards &cards) {
    Json batches = Json::array(), left_out = Json::array();
    for (const UnitBatch &batch : cards.batches) {
        Json units = Json::array();
        for (const UnitResult &unit : batch.units) units.push_back(unit_json(cards, unit));
        batches.push_back({{"label", batch_title(cards, batch)},
                           {"key", key_json(cards.setting_of(batch.units.front()).of.key)},
                           {"profile", batch.profile_id ? Json(batch.profile_id) : Json()},
                           {"mean", batch.mean ? profile_json(batch.profile_id, *batch.mean) : Json()},
                           {"note", batch.note.empty() ? Json() : Json(batch.note)},
                           {"units", units}});
    }
    for (const LeftOutCard &card : cards.left_out) left_out.push_back({{"file", card.file}, {"reason", card.reason}});
    Json missing = Json::array();
    for (const UnitWithoutPictures &unit : cards.missing)
        missing.push_back({{"unit", unit.unit}, {"reason", unit.reason}});
    const UnitLimits &limits = cards.options.limits;
    return {{"schema", json_schema},
            {"method", "flat"},
            {"limits",
             {{"corner", limits.corner},
              {"center", limits.center},
              {"frame", limits.frame},
              {"color", limits.color},
              {"unseen", limits.unseen}}},
            {"batches", batches},
            {"without_pictures", missing},
            {"left_out", left_out}};
}

}  // namespace lensprof
