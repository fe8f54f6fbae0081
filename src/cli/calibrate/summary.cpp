#include "cli/calibrate/summary.hpp"

#include <algorithm>
#include <cmath>

#include "cli/program/help_text.hpp"
#include "photo/base/format.hpp"
#include "photo/base/utf8.hpp"
#include "photo/folder/sheet.hpp"
#include "photo/report/falloff.hpp"

namespace lensprof {
namespace {

constexpr size_t max_panoramas = 3, max_names = 3;

double corner_of(const Json &result) {
    double corner = 1.0;
    const Json &curves = result["vignetting"]["k"];
    for (const Json &k : curves[green_curve(curves.size())]) corner += k.get<double>();
    return corner;
}

// "profile 3 stored", "profiles 3, 4 stored"; empty if none is.
std::string stored_text(const Json &result) {
    std::string ids;
    size_t count = 0;
    const auto add = [&](const Json &id) {
        if (id.is_null()) return;
        ids += (count++ ? ", " : "") + std::to_string(id.get<long long>());
    };
    for (const Json &setting : result["settings"]) add(setting["profile"]);
    if (result["settings"].empty()) add(result["profile"]);
    return count ? (count > 1 ? "profiles " : "profile ") + ids + " stored" : "";
}

// An entry of a list: the whole text, wrapped, its further lines indented below the first.
std::string entry(const std::string &text) {
    std::string lines;
    for (const char c : wrapped(one_line(text), help_columns - 4)) c == '\n' ? lines += "\n    " : lines += c;
    return "  " + lines + "\n";
}

void print_panoramas(const Panoramas &panoramas, std::ostream &out) {
    size_t members = 0, corrected = 0;
    for (const Panorama &panorama : panoramas.list)
        members += panorama.pictures.size(), corrected += panorama.equalizes();
    out << "panoramas " << panoramas.list.size();
    if (!panoramas.list.empty()) out << " of " << counted(members, "picture") << ", " << corrected << " corrected";
    out << "\n";
    const size_t count = panoramas.list.size(), listed = count <= max_panoramas ? count : max_panoramas - 1;
    for (size_t n = 0; n < listed; n++) out << entry(panorama_line(panoramas.list[n]));
    if (listed < count) out << "  and " << count - listed << " more\n";
}

}  // namespace

std::string panorama_line(const Panorama &panorama) {
    const Json &summary = panorama.summary, &result = summary["result"];
    std::string text = panorama.name + " (" + counted(panorama.pictures.size(), "picture") + "): ";
    if (!result.is_object()) return text + "not fitted: " + summary["not_stored"].get<std::string>();
    const std::string reason = first_text(result);
    if (!panorama.equalizes()) return text + "not usable: " + reason;
    const std::string stored = stored_text(result);
    text += stored.empty() ? "corrected, no profile stored" : stored;
    const double corner = corner_of(result);
    if (result.value("model", "full") == "exposures")
        text += ", exposures and white balances only";
    else if (corner > 0.0)
        text += format(", relative illuminance in the corners %.2f (%+.2f EV)", corner, std::log2(corner));
    if (stored.empty() && !summary["not_stored"].is_null())
        return text + ": " + summary["not_stored"].get<std::string>();
    return reason.empty() ? text : text + "; " + reason;
}

void print_summary(const FolderOptions &o, const Inputs &inputs, const Panoramas &panoramas,
                   const CorrectedPictures &pictures, std::ostream &out) {
    out << "read      " << counted(inputs.found, "picture");
    if (inputs.unreadable) out << ", " << inputs.unreadable << " of them unreadable";
    out << "\n";
    print_panoramas(panoramas, out);
    size_t by_profile = 0;
    for (const CorrectedPicture &entry : pictures.list) by_profile += entry.panorama.empty();
    out << "corrected " << counted(pictures.list.size(), "picture");
    if (by_profile) out << ", " << by_profile << " of them with profiles of the databases";
    if (pictures.written < pictures.list.size())
        out << (pictures.written ? format("; %u written now, the rest in earlier runs", pictures.written)
                                 : std::string("; all in earlier runs"));
    out << "\n";
    const std::vector<LeftOutPicture> left_out = all_left_out(inputs, pictures);
    if (!left_out.empty()) {
        const size_t shown = left_out.size() <= max_names ? left_out.size() : max_names - 1;
        out << "left out  " << counted(left_out.size(), "picture") << "\n";
        for (size_t i = 0; i < shown; i++) out << entry(left_out[i].reason);
        if (shown < left_out.size()) out << "  and " << left_out.size() - shown << " more\n";
    }
    const bool has_mosaics = std::any_of(panoramas.list.begin(), panoramas.list.end(), [](const auto &panorama) {
        return panorama.summary.value("preview", Json()).is_string();
    });
    out << one_line("written   to " + o.output + ": " + summary_name + " (with all reasons)"
                    + (pictures.list.empty() ? "" : ", calibrate_sheet.jpg")
                    + (panoramas.list.empty() ? "" : ", panorama_*.pto") + (has_mosaics ? ", panorama_*.jpg" : ""))
        << "\n";
}

}  // namespace lensprof
