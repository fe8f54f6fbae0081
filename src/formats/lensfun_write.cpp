// Profiles to a Lensfun database.
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include "formats/each_format.h"

#include "formats/falloff/export.hpp"
#include "formats/falloff/radius.hpp"
#include "formats/lensfun.hpp"
#include "formats/text/text.hpp"
#include "formats/text/xml.hpp"

namespace lensprof {
namespace {

constexpr const char *kMount = "Generic";  // which Lensfun's cameras with exchangeable lenses take

using Setting = std::tuple<double, double, double>;  // focal length, aperture, distance

struct WrittenLens {
    pugi::xml_node calibration;
    std::array<double, 2> center;
    std::set<Setting> settings;
};

WrittenLens begin_lens(pugi::xml_node root, const lensprof_profile &profile) {
    const std::string name = profile.key.lens;
    const double *center = profile.vignetting[0].center;
    pugi::xml_node lens = append_element(root, "lens");
    append_text(lens, "maker", name.substr(0, name.find(' ')));
    append_text(lens, "model", name);
    append_text(lens, "mount", kMount);
    append_text(lens, "cropfactor", number_text(profile.key.crop_factor));
    if (center[0] != 0.0 || center[1] != 0.0) {
        append_text(lens, "aspect-ratio", "3:2");
        pugi::xml_node node = append_element(lens, "center");
        append_number(node, "x", center[0] / half_short_side(kLensfunAspectRatio));
        append_number(node, "y", center[1] / half_short_side(kLensfunAspectRatio));
    }
    return {append_element(lens, "calibration"), {center[0], center[1]}, {}};
}

void append_entry(WrittenLens &lens, const lensprof_profile &profile, uint32_t index) {
    const lensprof_profile_key &key = profile.key;
    const double *center = profile.vignetting[0].center;
    demand_of_profile(lens.center[0] == center[0] && lens.center[1] == center[1], index,
                      "its centre differs from that of an earlier profile of " + in_quotes(key.lens)
                          + ", but Lensfun has one per lens; fit without a centre");
    const bool is_infinity = key.distance_m == LENSPROF_UNKNOWN || std::isinf(key.distance_m);
    const Setting setting{key.focal_mm, key.aperture, is_infinity ? kLensfunInfinityM : key.distance_m};
    demand_of_profile(lens.settings.insert(setting).second, index,
                      "lens " + in_quotes(key.lens) + ": same setting as an earlier profile; leave one out");
    pugi::xml_node entry = append_element(lens.calibration, "vignetting");
    append_attribute(entry, "model", "pa");
    append_number(entry, "focal", key.focal_mm);
    append_number(entry, "aperture", key.aperture);
    append_number(entry, "distance", std::get<2>(setting));
    const char *const names[3] = {"k1", "k2", "k3"};
    const std::array<double, 3> k = mean_curve(profile);
    for (int n = 0; n < 3; n++) append_number(entry, names[n], k[n]);
}

std::string database_text(const lensprof_profile *const *profiles, uint32_t count) {
    pugi::xml_document document;
    const std::string remark =
        std::string(kLensfunRemark) + lensprof_version() + "; <mount> may be changed to that of your camera ";
    append_remark(document, remark);
    const pugi::xml_node root = append_element(document, "lensdatabase");
    append_attribute(root, "version", "1");
    std::map<std::pair<std::string, double>, WrittenLens> lenses;
    for (uint32_t i = 0; i < count; i++) {
        demand_of_profile(profiles[i] != nullptr, i, "is NULL; pass a profile");
        const lensprof_profile &profile = *profiles[i];
        check_exported(profile, i, "Lensfun");
        const std::pair<std::string, double> name(profile.key.lens, profile.key.crop_factor);
        auto found = lenses.find(name);
        if (found == lenses.end()) found = lenses.emplace(name, begin_lens(root, profile)).first;
        append_entry(found->second, profile, i);
    }
    return document_text(document);
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

lensprof_status lp_lensfun_write(const lensprof_profile *const *profiles, uint32_t profile_count, void *data,
                                 size_t capacity, size_t *count, lensprof_error *error) {
    if ((!profiles && profile_count) || (!data && capacity)) {
        set_error(error, "lensprof_export: profiles or data is NULL; pass a buffer");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return write_at_boundary(data, capacity, count, error, [&] { return database_text(profiles, profile_count); });
}
