#include "cli/profiles/known_range.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "photo/base/format.hpp"
#include "photo/base/library.hpp"

namespace lensprof {
namespace {

constexpr size_t kMaxPrinted = 8;  // maximum printed, then the number of the others

void extend(double value, KnownRange::Ends &ends) {
    if (value == LENSPROF_UNKNOWN) return;
    ends = ends[0] == LENSPROF_UNKNOWN ? KnownRange::Ends{value, value}
                                       : KnownRange::Ends{std::min(ends[0], value), std::max(ends[1], value)};
}

std::string joined(const std::set<std::string> &names) {
    std::string text;
    size_t count = 0;
    for (const std::string &name : names) {
        if (count == kMaxPrinted) return text + format(" and %zu more", names.size() - count);
        text += (count++ ? ", " : "") + name;
    }
    return text.empty() ? "not named" : text;
}

}  // namespace

std::string range_text(const double range[2]) {
    if (range[0] == LENSPROF_UNKNOWN) return "-";
    return range[0] == range[1] ? format("%.4g", range[0]) : format("%.4g-%.4g", range[0], range[1]);
}

Json range_json(const double range[2]) {
    if (range[0] == LENSPROF_UNKNOWN) return nullptr;
    Json ends = Json::array();
    for (int end = 0; end < 2; end++) ends.push_back(std::isinf(range[end]) ? Json("infinity") : Json(range[end]));
    return ends;
}

void KnownRange::add(const lensprof_profile &profile) {
    const lensprof_profile_key &key = profile.key;
    profiles++;
    if (*key.camera_model) cameras.insert(camera_name(key.camera_maker, key.camera_model));
    if (*key.lens) lenses.insert(key.lens);
    processings.insert(processing_name(key.processing));
    extend(key.focal_mm, focal_mm);
    extend(key.aperture, aperture);
    extend(key.distance_m, distance_m);
    extend(lensprof_profile_corner_falloff(&profile, 1, nullptr), corner);
}

Json known_range_json(const KnownRange &known) {
    return {{"profiles", known.profiles},
            {"cameras", known.cameras},
            {"lenses", known.lenses},
            {"processings", known.processings},
            {"focal_mm", range_json(known.focal_mm.data())},
            {"aperture", range_json(known.aperture.data())},
            {"distance_m", range_json(known.distance_m.data())},
            {"corner", range_json(known.corner.data())}};
}

void print_known_range(const KnownRange &known, std::ostream &out) {
    out << "known     " << counted(known.profiles, "profile") << " (" << joined(known.processings) << ")\n"
        << "lens      " << joined(known.lenses) << "\n";
    if (!known.cameras.empty()) out << "camera    " << joined(known.cameras) << "\n";
    out << "focal     " << range_text(known.focal_mm.data()) << " mm\n"
        << "aperture  f/" << range_text(known.aperture.data()) << "\n"
        << "distance  " << range_text(known.distance_m.data()) << " m\n"
        << format("corner    M %.3f to %.3f\n", known.corner[0], known.corner[1]);
}

}  // namespace lensprof
