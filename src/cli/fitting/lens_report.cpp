#include "cli/fitting/lens_report.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include "cli/fitting/flat.hpp"
#include "cli/fitting/shared_lines.hpp"
#include "cli/program/help_text.hpp"
#include "photo/base/format.hpp"
#include "photo/base/paths.hpp"
#include "photo/base/utf8.hpp"
#include "photo/calibration/lens_file.hpp"
#include "photo/calibration/lens_settings.hpp"
#include "photo/report/falloff.hpp"

namespace lensprof {
namespace {

std::string missing_text(const LensCards &cards) {
    std::string text;
    double focal = 0.0;
    std::string title;
    for (const MissingSetting &setting : cards.missing) {
        const std::string of_setting = missing_lens(cards, setting);
        if (of_setting != title) text += (text.empty() ? "" : "; ") + of_setting, focal = 0.0;
        title = of_setting;
        if (setting.focal_mm != focal) text += format("%s%g mm:", focal == 0.0 ? " " : "; ", setting.focal_mm);
        text += format(" f/%g", setting.aperture);
        focal = setting.focal_mm;
    }
    return text;
}

void print_settings(const LensCards &cards, std::ostream &out) {
    size_t width = 7;
    for (const MeasuredSetting &setting : cards.settings) width = std::max(width, setting.of.label.size());
    std::string title;
    for (size_t n = 0; n < cards.settings.size(); n++) {
        const MeasuredSetting &setting = cards.settings[n];
        const std::string of_setting = lens_title(setting.of.key);
        if (of_setting != title || &setting == &cards.settings.front()) {
            title = of_setting;
            if (!title.empty()) out << title << "\n";
            out << format("%-*s  pictures   corner %%       +-  result\n", static_cast<int>(width), "setting");
        }
        out << format("%-*s  %8zu", static_cast<int>(width), setting.of.label.c_str(), setting.of.pictures.size());
        if (setting.fit) {
            const Corner corner = corner_of(*setting.fit);
            const double sigma = 100.0 * corner.sigma;
            out << format("  %9s  %7s", with_decimals_of(sigma, 100.0 * corner.value).c_str(),
                          error_text(sigma).c_str());
        } else {
            out << "          -        -";
        }
        out << "  " << one_line(result_text(cards, n)) << "\n";
    }
}

// Whether the pictures that the light was checked with answer a doubt about it.
bool is_answered(const Finding &finding, const std::optional<LightCheck> &light) {
    return finding.code == LENSPROF_REASON_FLAT_ONE_LIGHT && light
           && light->corners != LENSPROF_TRIAL_CORNERS_NOT_SHOWN;
}

void print_findings(const LensCards &cards, std::ostream &out) {
    SharedLines lines;
    for (const MeasuredSetting &setting : cards.settings) {
        for (const Notice &notice : setting.notices.list) lines.add_alike(notice.text, setting.of.label);
        if (setting.fit && setting.is_good())
            for (const Finding &finding : setting.fit->verdict.findings)
                if (!is_answered(finding, cards.light)) lines.add_alike(with_code(finding), setting.of.label);
    }
    lines.print("note      ", out);
}

// They start with the setting, or the camera.
void print_lens_file_notes(const LensCards &cards, std::ostream &out) {
    SharedLines lines;
    for (const std::string &note : cards.lens_file_notes) {
        const size_t colon = note.find(": ");
        const std::string item = colon == std::string::npos ? std::string() : note.substr(0, colon),
                          text = colon == std::string::npos ? note : note.substr(colon + 2);
        lines.add_alike(text, item);
    }
    lines.print("note      ", out);
}

// How many good settings the file for Lensfun does not hold.
std::string off_text(const LensCards &cards) {
    size_t off = 0;
    for (size_t n = 0; n < cards.settings.size(); n++) off += !cards.is_good_for_lensfun(n);
    return off ? format(", without %zu that it would be off by more than %g EV", off, largest_lens_file_ev)
               : std::string();
}

Json light_json(const LensCards &cards) {
    if (!cards.light) return {};
    Json rings = Json::array();
    for (uint32_t ring = 0; ring < cards.light->rings; ring++)
        rings.push_back({{"radius", cards.light->ring_end[ring]},
                         {"ev", cards.light->ring_ev[ring]},
                         {"sigma_ev", cards.light->ring_sigma_ev[ring]}});
    return {{"setting", cards.settings[cards.light->setting].of.label},
            {"pictures", cards.light->pictures},
            {"rings", rings},
            {"removed_from", cards.light_removed}};
}

}  // namespace

Corner corner_of(const CardFit &found) {
    const uint32_t curve = green_curve(found.profile->vignettings);
    double sigma = 0.0;  // with that of the light, if it was removed
    (void)lensprof_profile_corner_falloff(found.profile.get(), curve, &sigma);
    return {mean_light(*found.profile, curve, 1.0), std::max(found.fit.corner_sigma, sigma)};
}

std::string lens_title(const lensprof_profile_key &key) {
    const std::string camera = camera_name(key.camera_maker, key.camera_model), lens = key.lens;
    return camera + (camera.empty() || lens.empty() ? "" : ", ") + lens;
}

std::string setting_title(const lensprof_profile_key &key) {
    const KeyParts parts = key_parts(key);
    std::string title = lens_title(key);
    for (const size_t part : {2, 3, 4})
        if (!parts[part].empty()) title += (title.empty() ? "" : ", ") + parts[part];
    return title;
}

std::string missing_lens(const LensCards &cards, const MissingSetting &missing) {
    const auto is_other = [&](const MeasuredSetting &setting) {
        const lensprof_profile_key &key = setting.of.key;
        return camera_name(key.camera_maker, key.camera_model) != missing.camera;
    };
    const bool are_several = std::any_of(cards.settings.begin(), cards.settings.end(), is_other);
    return are_several && !missing.camera.empty() ? missing.camera + ", " + missing.lens : missing.lens;
}

std::string result_text(const LensCards &cards, size_t n) {
    const MeasuredSetting &setting = cards.settings[n];
    if (!setting.is_good()) return "take it again: " + setting.refusal;
    if (cards.is_good_for_lensfun(n)) return "good";
    return format("good, but not for Lensfun: k1..k3 alone are off by %.2f EV in a corner", cards.lens_file_ev[n]);
}

bool LensCards::is_good_for_lensfun(size_t setting) const {
    return setting >= lens_file_ev.size() || !(lens_file_ev[setting] > largest_lens_file_ev);
}

size_t LensCards::good() const {
    return static_cast<size_t>(
        std::count_if(settings.begin(), settings.end(), [](const MeasuredSetting &s) { return s.is_good(); }));
}

std::string counted_settings(const CardSettings &settings) {
    size_t pictures = 0;
    for (const CardSetting &setting : settings.list) pictures += setting.pictures.size();
    return counted(pictures, "picture") + " of " + counted(settings.list.size(), "setting");
}

void check_lens_output(const std::string &output) {
    const std::string kind = lowercase_extension(output);
    if (kind != "xml" && kind != "csv" && kind != "json")
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      output
                          + ": give a name that ends in .xml, for Lensfun, .csv, a table, or .json, tables of a "
                            "sensor for the Raspberry Pi");
}

std::string lacking_for_lensfun(const StoreOptions &store, const CardSettings &settings) {
    const auto lacks = [](const std::string &what, const CardPicture &picture, const char *option) {
        return "needs " + what + ", which " + picture.file + " does not state; give it with " + option_name(option);
    };
    for (const CardSetting &setting : settings.list) {
        const CardPicture &first = setting.pictures.front();
        if (!*setting.key.lens) return lacks("the name of the lens", first, "lens");
        if (setting.key.focal_mm == LENSPROF_UNKNOWN) return lacks("the focal length", first, "focal");
        if (setting.key.aperture == LENSPROF_UNKNOWN) return lacks("the aperture", first, "aperture");
        StoreOptions unstored = store;
        unstored.no_store = true;
        if (override_key(setting.key, first.metadata.size, unstored, first.file).crop_factor == LENSPROF_UNKNOWN)
            return "needs the crop factor of the camera, which neither EXIF nor a database states; give it with "
                   + option_name("crop_factor");
    }
    return {};
}

std::string several_for_lensfun(const CardSettings &settings) {
    std::set<std::string> titles;
    for (const CardSetting &setting : settings.list) {
        const std::string temperature = temperature_text(setting.key);
        titles.insert(lens_title(setting.key) + (temperature.empty() ? "" : " at " + temperature));
    }
    if (titles.size() < 2) return {};
    return "holds one lens on one camera, but the pictures are of " + joined({titles.begin(), titles.end()}, "; ")
           + ": give each its own run, or omit -o";
}

std::string several_for_sensor(const CardSettings &settings) {
    std::set<std::string> titles;
    for (const CardSetting &setting : settings.list) titles.insert(setting_title(setting.key));
    if (titles.size() < 2) return {};
    return "holds one sensor and lens at several colour temperatures, but the pictures are of "
           + joined({titles.begin(), titles.end()}, "; ") + ": give each its own run, or omit -o";
}

std::string lens_csv(const LensCards &cards) {
    std::string text =
        "camera,lens,focal_mm,aperture,distance_m,pictures,usable,corner,corner_sigma,k1,k2,k3,reason,"
        "lensfun_ev,color_temperature_k\n";
    for (size_t n = 0; n < cards.settings.size(); n++) {
        const MeasuredSetting &setting = cards.settings[n];
        const lensprof_profile_key &key = setting.fit ? setting.fit->key : setting.of.key;
        text += csv_cell(camera_name(key.camera_maker, key.camera_model)) + "," + csv_cell(key.lens) + ","
                + csv_number(key.focal_mm) + "," + csv_number(key.aperture) + "," + csv_number(key.distance_m) + ","
                + std::to_string(setting.of.pictures.size()) + (setting.is_good() ? ",yes," : ",no,");
        if (setting.fit) {
            const Corner corner = corner_of(*setting.fit);
            text += csv_number(corner.value) + "," + csv_number(corner.sigma);
            for (const double k : setting.fit->profile->vignetting[green_curve(setting.fit->profile->vignettings)].k)
                text += "," + csv_number(k);
        } else {
            text += ",,,,";
        }
        const bool is_noted = setting.is_good() && !cards.is_good_for_lensfun(n);
        text += "," + csv_cell(is_noted ? result_text(cards, n) : setting.refusal) + ","
                + (n < cards.lens_file_ev.size() ? csv_number(cards.lens_file_ev[n]) : std::string()) + ","
                + csv_number(key.color_temperature_k) + "\n";
    }
    return text;
}

namespace {

// The good settings of which the file can have a share.
struct LensFileSettings {
    std::vector<const lensprof_profile *> profiles;
    std::vector<std::string> names;
    std::vector<size_t> numbers;  // of the settings
};

LensFileSettings settings_for_file(const LensCards &cards) {
    LensFileSettings chosen;
    for (size_t n = 0; n < cards.settings.size(); n++) {
        const MeasuredSetting &setting = cards.settings[n];
        if (!setting.is_good() || !cards.is_good_for_lensfun(n)) continue;
        chosen.profiles.push_back(setting.fit->profile.get());
        chosen.names.push_back(setting.of.label);
        chosen.numbers.push_back(n);
    }
    return chosen;
}

}  // namespace

// What k1..k3 do not describe is left out: the file would be wrong where other programs use it.
void make_lens_file(const LensFileSource &source, LensCards &cards) {
    const LensFileSettings all = settings_for_file(cards);
    if (all.profiles.empty()) return;
    LensFileCost cost;
    cards.lens_file_text = lens_file_text(all.profiles, source.databases, source.into, cost, all.names);
    cards.lens_file_ev.assign(cards.settings.size(), NAN);
    for (size_t i = 0; i < all.numbers.size(); i++) cards.lens_file_ev[all.numbers[i]] = cost.ev[i];
    const LensFileSettings written = settings_for_file(cards);
    if (written.profiles.size() < all.profiles.size()) {
        cost = {};
        cards.lens_file_text.clear();
        if (written.profiles.empty()) {
            cards.lens_file_obstacle = format(
                "holds k1..k3 alone, which are off by more than %g EV in a corner for all", largest_lens_file_ev);
            return;
        }
        cards.lens_file_text = lens_file_text(written.profiles, source.databases, source.into, cost, written.names);
    }
    cards.lens_file_notes = notes_of(cost, written.names);
    for (size_t i = 0; i < written.profiles.size(); i++)
        for (const std::string &about : {note_of_levels(*written.profiles[i], written.names[i]),
                                         note_of_circle(*written.profiles[i], written.names[i])})
            if (!about.empty()) cards.lens_file_notes.push_back(about);
}

void make_sensor_file(const SensorTables &tables, LensCards &cards) {
    constexpr double noted = 0.01;  // of the light
    std::vector<const lensprof_profile *> profiles;
    double aspect = usual_aspect;  // of the sensor, which is not higher than wide
    for (const MeasuredSetting &setting : cards.settings) {
        if (!setting.is_good()) continue;
        profiles.push_back(setting.fit->profile.get());
        aspect = std::max(setting.fit->aspect, 1.0 / setting.fit->aspect);
    }
    if (profiles.empty()) return;
    SensorFileCost cost;
    cards.sensor_file_text = sensor_file_text(profiles, aspect, tables, cost);
    if (cost.has_colours && profiles.front()->key.color_temperature_k == LENSPROF_UNKNOWN)
        cards.sensor_file_note =
            "no colour temperature is stated: the tables are those of 4500 K; sort the pictures in "
            "folders such as 2850K, or give "
            + option_name("temperature");
    else if (cost.green > noted)
        cards.sensor_file_note = format(
            "the light in green differs by up to %.1f %% between the colour temperatures; "
            "the file has one luminance table, their mean",
            100.0 * cost.green);
}

void add_lens_output(const std::string &path, LensCards &cards, OutputFiles &outputs) {
    if (lowercase_extension(path) == "json") {
        if (!cards.sensor_file_text.empty()) outputs.add(path, cards.sensor_file_text);
        return;
    }
    if (lowercase_extension(path) == "csv") return outputs.add(path, lens_csv(cards));
    if (cards.lens_file_text.empty() || !cards.lens_file_obstacle.empty()) return;
    outputs.add(path, cards.lens_file_text);
    cards.lens_file = path;
}

ExitCode lens_exit_code(const LensCards &cards) {
    const bool are_good = settings_for_file(cards).numbers.size() == cards.settings.size();
    if (!are_good || !cards.lens_file_obstacle.empty()) return ExitCode::not_usable;
    return cards.left_out.empty() ? ExitCode::done : ExitCode::unreadable;
}

void print_lens(const LensCards &cards, const std::string &database, bool with_notes, std::ostream &out) {
    print_settings(cards, out);
    if (with_notes) print_findings(cards, out);
    if (cards.light)
        out << "light     checked with " << cards.light->pictures << " at "
            << cards.settings[cards.light->setting].of.label << ": " << cards.light->text()
            << (cards.light_removed ? "; removed from " + counted(cards.light_removed, "setting") : std::string())
            << "\n";
    if (!cards.missing.empty())
        out << format("missing   %zu more for an error of predictions below %.0f %%: ", cards.missing.size(),
                      100.0 * largest_prediction_error)
            << missing_text(cards) << "\n";
    size_t stored = 0;
    for (const MeasuredSetting &setting : cards.settings) stored += setting.fit && setting.fit->profile_id;
    if (stored) out << "stored    " << counted(stored, "profile") << " in " << database << "\n";
    if (with_notes) print_lens_file_notes(cards, out);
    if (!cards.lens_file.empty())
        out << "written   " << cards.lens_file << ": " << counted(settings_for_file(cards).numbers.size(), "setting")
            << off_text(cards) << "\n";
    if (!cards.sensor_file_note.empty() && with_notes) out << "note      " << cards.sensor_file_note << "\n";
    print_left_out(cards.left_out, cards.given, out);
}

Json lens_json(const LensCards &cards) {
    Json settings = Json::array(), missing = Json::array(), left_out = Json::array();
    for (size_t n = 0; n < cards.settings.size(); n++) {
        const MeasuredSetting &setting = cards.settings[n];
        Json files = Json::array(), notices = Json::array();
        for (const CardPicture &picture : setting.of.pictures) files.push_back(picture.file);
        for (const Notice &notice : setting.notices.list) notices.push_back(notice.line());
        Json json = {{"label", setting.of.label},
                     {"key", key_json(setting.fit ? setting.fit->key : setting.of.key)},
                     {"files", files},
                     {"usable", setting.is_good()},
                     {"reason", setting.is_good() ? Json() : Json(setting.refusal)}};
        if (setting.fit) {
            const Corner corner = corner_of(*setting.fit);
            json["corner"] = corner.value, json["corner_sigma"] = number_or_null(corner.sigma);
        }
        json["lens_file_ev"] = n < cards.lens_file_ev.size() ? number_or_null(cards.lens_file_ev[n]) : Json();
        json["good_for_lens_file"] =
            n < cards.lens_file_ev.size() ? Json(setting.is_good() && cards.is_good_for_lensfun(n)) : Json();
        json["notices"] = notices;
        json["result"] = setting.fit ? flat_json(*setting.fit) : Json();
        settings.push_back(json);
    }
    for (const MissingSetting &setting : cards.missing)
        missing.push_back({{"camera", setting.camera},
                           {"lens", setting.lens},
                           {"focal_mm", setting.focal_mm},
                           {"aperture", setting.aperture},
                           {"sigma", number_or_null(setting.sigma)}});
    for (const LeftOutCard &card : cards.left_out) left_out.push_back({{"file", card.file}, {"reason", card.reason}});
    return {{"schema", json_schema},
            {"method", "flat"},
            {"settings", settings},
            {"missing", missing},
            {"light", light_json(cards)},
            {"left_out", left_out},
            {"lens_file_notes", cards.lens_file_notes},
            {"sensor_file_note", cards.sensor_file_note.empty() ? Json() : Json(cards.sensor_file_note)},
            {"lens_file_obstacle", cards.lens_file_obstacle.empty() ? Json() : Json(cards.lens_file_obstacle)},
            {"lens_file", cards.lens_file.empty() ? Json() : Json(cards.lens_file)}};
}

}  // namespace lensprof
