#include "cli/fitting/lens_report.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include "cli/fitting/flat.hpp"
#include "cli/program/help_text.hpp"
#include "photo/base/format.hpp"
#include "photo/base/paths.hpp"
#include "photo/base/utf8.hpp"
#include "photo/calibration/lens_file.hpp"
#include "photo/calibration/lens_settings.hpp"
#include "photo/report/falloff.hpp"

namespace lensprof {
namespace {

// Illuminance in the corners of the frame, with the gain grid: their mean, and its standard error.
struct Corner {
    double value, sigma;
};

Corner corner_of(const CardFit &found) {
    constexpr uint32_t width = 30000, height = 20000;  // so large that the outermost pixels are in the corners
    double sum = 0.0;
    for (const double x : {0.0, width - 1.0})
        for (const double y : {0.0, height - 1.0})
            sum += lensprof_profile_falloff(found.profile.get(), green_curve(found.profile->vignettings), width, height,
                                            x, y, nullptr);
    double sigma = 0.0;  // with that of the light, if it was removed
    (void)lensprof_profile_corner_falloff(found.profile.get(), green_curve(found.profile->vignettings), &sigma);
    return {sum / 4.0, std::max(found.fit.corner_sigma, sigma)};
}

// "Canon EOS R5, RF 50mm F1.8", the parts that are known.
std::string lens_title(const lensprof_profile_key &key) {
    const std::string camera = camera_name(key.camera_maker, key.camera_model), lens = key.lens;
    return camera + (camera.empty() || lens.empty() ? "" : ", ") + lens;
}

std::string missing_text(const std::vector<MissingSetting> &missing) {
    std::string text;
    double focal = 0.0;
    std::string title;
    for (const MissingSetting &setting : missing) {
        if (setting.lens != title) text += (text.empty() ? "" : "; ") + setting.lens, focal = 0.0;
        title = setting.lens;
        if (setting.focal_mm != focal) text += format("%s%g mm:", focal == 0.0 ? " " : "; ", setting.focal_mm);
        text += format(" f/%g", setting.aperture);
        focal = setting.focal_mm;
    }
    return text;
}

std::string result_text(const MeasuredSetting &setting) {
    return setting.is_good() ? "good" : "take it again: " + setting.refusal;
}

void print_settings(const LensCards &cards, std::ostream &out) {
    size_t width = 7;
    for (const MeasuredSetting &setting : cards.settings) width = std::max(width, setting.of.label.size());
    std::string title;
    for (const MeasuredSetting &setting : cards.settings) {
        const std::string of_setting = lens_title(setting.of.key);
        if (of_setting != title || &setting == &cards.settings.front()) {
            title = of_setting;
            if (!title.empty()) out << title << "\n";
            out << format("%-*s  pictures  corner %%    +-  result\n", static_cast<int>(width), "setting");
        }
        out << format("%-*s  %8zu", static_cast<int>(width), setting.of.label.c_str(), setting.of.pictures.size());
        if (setting.fit) {
            const Corner corner = corner_of(*setting.fit);
            out << format("  %8.1f  %4.1f", 100.0 * corner.value, 100.0 * corner.sigma);
        } else {
            out << "         -     -";
        }
        out << "  " << one_line(result_text(setting)) << "\n";
    }
}

// Lines that several settings or files share are printed once, with the first of them.
class SharedLines {
public:
    void add(const std::string &text, const std::string &item) {
        const auto same =
            std::find_if(lines_.begin(), lines_.end(), [&](const Line &line) { return line.text == text; });
        same == lines_.end() ? lines_.push_back({text, item, 1}) : void(same->count++);
    }

    void print(const char *start, std::ostream &out) const {
        for (const Line &line : lines_)
            out << start << one_line(line.item)
                << (line.count > 1 ? " and " + std::to_string(line.count - 1) + " more" : std::string()) << ": "
                << one_line(line.text) << "\n";
    }

private:
    struct Line {
        std::string text, item;
        size_t count;
    };
    std::vector<Line> lines_;
};

// Whether the pictures that the light was checked with answer a doubt about it.
bool is_answered(const Finding &finding, const std::optional<LightCheck> &light) {
    return finding.code == LENSPROF_REASON_FLAT_ONE_LIGHT && light
           && light->corners != LENSPROF_TRIAL_CORNERS_NOT_SHOWN;
}

void print_findings(const LensCards &cards, std::ostream &out) {
    SharedLines lines;
    for (const MeasuredSetting &setting : cards.settings) {
        for (const Notice &notice : setting.notices.list) lines.add(notice.text, setting.of.label);
        if (setting.fit && setting.is_good())
            for (const Finding &finding : setting.fit->verdict.findings)
                if (!is_answered(finding, cards.light)) lines.add(with_code(finding), setting.of.label);
    }
    lines.print("note      ", out);
}

void print_left_out(const LensCards &cards, std::ostream &out) {
    if (cards.left_out.empty()) return;
    out << "left out  " << cards.left_out.size() << " of " << counted(cards.given, "picture") << "\n";
    SharedLines lines;
    for (const LeftOutCard &card : cards.left_out) {
        const bool is_named = card.reason.rfind(card.file + ": ", 0) == 0;
        lines.add(is_named ? card.reason.substr(card.file.size() + 2) : card.reason, card.file);
    }
    lines.print("  ", out);
}

std::string csv_cell(const std::string &text) {
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

std::string csv_number(double value) {
    return value == LENSPROF_UNKNOWN || std::isnan(value) ? "" : format("%.6g", value);
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

size_t LensCards::good() const {
    return static_cast<size_t>(
        std::count_if(settings.begin(), settings.end(), [](const MeasuredSetting &s) { return s.is_good(); }));
}

std::string counted_settings(const CardSettings &settings) {
    size_t pictures = 0;
    for (const CardSetting &setting : settings.list) pictures += setting.pictures.size();
    return counted(pictures, "picture") + " of " + counted(settings.list.size(), "setting");
}

void check_lens_output(const std::string &output, const StoreOptions &store, const CardSettings &settings) {
    const std::string kind = lowercase_extension(output);
    if (kind == "csv") return;
    if (kind != "xml")
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      output + ": give a name that ends in .xml, for Lensfun, or .csv, a table");
    std::set<std::string> titles;
    for (const CardSetting &setting : settings.list) {
        if (!*setting.key.lens)
            throw Failure(LENSPROF_ERROR_ARGUMENT, output + ": needs the name of the lens, which "
                                                       + setting.pictures.front().file
                                                       + " does not state; give it with --lens");
        titles.insert(lens_title(setting.key));
    }
    if (titles.size() > 1)
        throw Failure(LENSPROF_ERROR_ARGUMENT, output + ": holds one lens on one camera, but the pictures are of "
                                                   + joined({titles.begin(), titles.end()}, "; ")
                                                   + ": give each its own run, or omit -o");
    const CardSetting &any = settings.list.front();  // of the one camera
    StoreOptions unstored = store;
    unstored.no_store = true;
    const CardPicture &first = any.pictures.front();
    if (override_key(any.key, first.metadata.size, unstored, first.file).crop_factor == LENSPROF_UNKNOWN)
        throw Failure(LENSPROF_ERROR_ARGUMENT, output + ": needs the crop factor of the camera, which neither EXIF nor a "
                                                        "database states; give it with --key crop-factor=NUMBER");
}

std::string lens_csv(const LensCards &cards) {
    std::string text = "camera,lens,focal_mm,aperture,distance_m,pictures,usable,corner,corner_sigma,k1,k2,k3,reason\n";
    for (const MeasuredSetting &setting : cards.settings) {
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
        text += "," + csv_cell(setting.refusal) + "\n";
    }
    return text;
}

std::string lensfun_text(const LensFileSource &source, LensCards &cards) {
    std::vector<const lensprof_profile *> profiles;
    std::vector<std::string> names;
    for (const MeasuredSetting &setting : cards.settings) {
        if (!setting.is_good()) continue;
        profiles.push_back(setting.fit->profile.get());
        names.push_back(setting.of.label);
    }
    if (profiles.empty()) return {};
    LensFileCost cost;
    const std::string text = lens_file_text(profiles, source.databases, source.into, cost, names);
    cards.lens_file_notes = notes_of(cost, names);
    for (size_t i = 0; i < profiles.size(); i++)
        if (const std::string about = note_of_levels(*profiles[i], names[i]); !about.empty())
            cards.lens_file_notes.push_back(about);
    return text;
}

void add_lens_output(const std::string &path, const LensFileSource &source, LensCards &cards, OutputFiles &outputs) {
    if (lowercase_extension(path) == "csv") return outputs.add(path, lens_csv(cards));
    const std::string text = lensfun_text(source, cards);
    if (text.empty()) return;
    outputs.add(path, text);
    cards.lens_file = path;
}

ExitCode lens_exit_code(const LensCards &cards) {
    if (cards.good() < cards.settings.size()) return ExitCode::not_usable;
    return cards.left_out.empty() ? ExitCode::done : ExitCode::unreadable;
}

void print_lens(const LensCards &cards, const std::string &database, std::ostream &out) {
    print_settings(cards, out);
    print_findings(cards, out);
    if (cards.light)
        out << "light     checked with " << cards.light->pictures << " at "
            << cards.settings[cards.light->setting].of.label << ": " << cards.light->text()
            << (cards.light_removed ? "; removed from " + counted(cards.light_removed, "setting") : std::string())
            << "\n";
    if (!cards.missing.empty())
        out << format("missing   %zu more for an error of predictions below %.0f %%: ", cards.missing.size(),
                      100.0 * largest_prediction_error)
            << missing_text(cards.missing) << "\n";
    size_t stored = 0;
    for (const MeasuredSetting &setting : cards.settings) stored += setting.fit && setting.fit->profile_id;
    if (stored) out << "stored    " << counted(stored, "profile") << " in " << database << "\n";
    for (const std::string &text : cards.lens_file_notes) out << "note      " << one_line(text) << "\n";
    if (!cards.lens_file.empty())
        out << "written   " << cards.lens_file << ": " << counted(cards.good(), "setting") << "\n";
    print_left_out(cards, out);
}

Json lens_json(const LensCards &cards) {
    Json settings = Json::array(), missing = Json::array(), left_out = Json::array();
    for (const MeasuredSetting &setting : cards.settings) {
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
        json["notices"] = notices;
        json["result"] = setting.fit ? flat_json(*setting.fit) : Json();
        settings.push_back(json);
    }
    for (const MissingSetting &setting : cards.missing)
        missing.push_back({{"lens", setting.lens},
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
            {"lens_file", cards.lens_file.empty() ? Json() : Json(cards.lens_file)}};
}

}  // namespace lensprof
