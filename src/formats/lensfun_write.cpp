// Profiles to a Lensfun database.
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include <lensprof/formats.h>

#include "lensfun.hpp"
#include "radius.hpp"
#include "text.hpp"
#include "xml.hpp"

namespace lensprof {
namespace {

constexpr const char *kMount = "Generic";  // which Lensfun's cameras with exchangeable lenses take

using Setting = std::tuple<double, double, double>;  // focal length, aperture, distance

struct WrittenLens {
    pugi::xml_node calibration;
    std::array<double, 2> center;
    std::set<Setting> settings;
};

class StringWriter : public pugi::xml_writer {
public:
    void write(const void *data, size_t size) override { text.append(static_cast<const char *>(data), size); }
    std::string text;
};

void demand(bool holds, uint32_t index, const std::string &text, lensprof_status status = LENSPROF_ERROR_ARGUMENT) {
    if (!holds) throw FormatFailure{status, "profile " + std::to_string(index) + ": " + text};
}

void check_profile(const lensprof_profile &profile, uint32_t index) {
    const lensprof_status status = lensprof_profile_validate(&profile);
    demand(status == LENSPROF_OK, index, std::string("is not valid (") + lensprof_status_name(status)
                                             + "); see lensprof_profile_validate", status);
    const lensprof_profile_key &key = profile.key;
    const std::string lens = key.lens;
    demand(!lens.empty(), index, "its lens is unknown; set key.lens");
    demand(find_not_utf8(lens) == lens.size(), index, "its lens " + quoted(lens) + " is not UTF-8; correct key.lens");
    demand(key.crop_factor != LENSPROF_UNKNOWN, index, "its crop factor is unknown; set key.crop_factor");
    demand(key.focal_mm != LENSPROF_UNKNOWN, index, "its focal length is unknown; set key.focal_mm");
    demand(key.aperture != LENSPROF_UNKNOWN, index, "its aperture is unknown; set key.aperture");
    demand(profile.grid.columns == 0, index, "has a gain grid, which Lensfun has not; fit a radial falloff alone",
           LENSPROF_ERROR_UNSUPPORTED);
    demand(key.processing != LENSPROF_PROCESSING_CORRECTED, index,
           "is of pictures corrected in camera, and Lensfun corrects raw ones; leave it out",
           LENSPROF_ERROR_UNSUPPORTED);
}

// pugixml tells by its results that memory ran out.
void demand_memory(bool done) {
    if (!done) throw std::bad_alloc();
}

pugi::xml_node append(pugi::xml_node parent, const char *name) {
    const pugi::xml_node node = parent.append_child(name);
    demand_memory(node);
    return node;
}

void append_text(pugi::xml_node parent, const char *name, const std::string &text) {
    demand_memory(append(parent, name).text().set(text.c_str()));
}

void append_attribute(pugi::xml_node node, const char *name, const std::string &value) {
    demand_memory(node.append_attribute(name).set_value(value.c_str()));
}

void append_number(pugi::xml_node node, const char *name, double value) {
    append_attribute(node, name, number_text(value));
}

WrittenLens begin_lens(pugi::xml_node root, const lensprof_profile &profile) {
    const std::string name = profile.key.lens;
    const double *center = profile.vignetting[0].center;
    pugi::xml_node lens = append(root, "lens");
    append_text(lens, "maker", name.substr(0, name.find(' ')));
    append_text(lens, "model", name);
    append_text(lens, "mount", kMount);
    append_text(lens, "cropfactor", number_text(profile.key.crop_factor));
    if (center[0] != 0.0 || center[1] != 0.0) {
        append_text(lens, "aspect-ratio", "3:2");
        pugi::xml_node node = append(lens, "center");
        append_number(node, "x", center[0] / half_short_side(kLensfunAspectRatio));
        append_number(node, "y", center[1] / half_short_side(kLensfunAspectRatio));
    }
    return {append(lens, "calibration"), {center[0], center[1]}, {}};
}

void append_entry(WrittenLens &lens, const lensprof_profile &profile, uint32_t index) {
    const lensprof_profile_key &key = profile.key;
    const double *center = profile.vignetting[0].center;
    demand(lens.center[0] == center[0] && lens.center[1] == center[1], index,
           "another centre than an earlier profile of " + quoted(key.lens)
               + ", and Lensfun has one a lens; fit it without");
    const bool far = key.distance_m == LENSPROF_UNKNOWN || std::isinf(key.distance_m);
    const Setting setting{key.focal_mm, key.aperture, far ? kLensfunInfinityM : key.distance_m};
    demand(lens.settings.insert(setting).second, index,
           "lens " + quoted(key.lens) + " and setting of an earlier profile; leave one out");
    pugi::xml_node entry = append(lens.calibration, "vignetting");
    append_attribute(entry, "model", "pa");
    append_number(entry, "focal", key.focal_mm);
    append_number(entry, "aperture", key.aperture);
    append_number(entry, "distance", std::get<2>(setting));
    const char *const names[3] = {"k1", "k2", "k3"};
    for (int n = 0; n < 3; n++) {
        const double first = profile.vignetting[0].k[n];
        double beyond = 0.0;  // the mean is that of the curves; of three that are the same it is exactly theirs
        for (uint32_t c = 1; c < profile.vignettings; c++) beyond += profile.vignetting[c].k[n] - first;
        append_number(entry, names[n], first + beyond / profile.vignettings);
    }
}

std::string database_text(const lensprof_profile *const *profiles, uint32_t count) {
    pugi::xml_document document;
    const std::string remark = std::string(" written by lensprof ") + lensprof_version()
                               + "; <mount> may be made that of your camera ";
    demand_memory(document.append_child(pugi::node_comment).set_value(remark.c_str()));
    const pugi::xml_node root = append(document, "lensdatabase");
    append_attribute(root, "version", "1");
    std::map<std::pair<std::string, double>, WrittenLens> lenses;
    for (uint32_t i = 0; i < count; i++) {
        demand(profiles[i] != nullptr, i, "is NULL; pass a profile");
        const lensprof_profile &profile = *profiles[i];
        check_profile(profile, i);
        const std::pair<std::string, double> name(profile.key.lens, profile.key.crop_factor);
        auto found = lenses.find(name);
        if (found == lenses.end()) found = lenses.emplace(name, begin_lens(root, profile)).first;
        append_entry(found->second, profile, i);
    }
    StringWriter writer;
    document.save(writer, "    ", pugi::format_indent | pugi::format_no_declaration, pugi::encoding_utf8);
    return writer.text;
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

lensprof_status lensprof_lensfun_write(const lensprof_profile *const *profiles, uint32_t count, char *text,
                                       size_t capacity, size_t *needed, lensprof_error *error) {
    if ((!profiles && count) || (!text && capacity)) {
        set_error(error, "lensprof_lensfun_write: profiles or text is NULL; pass a buffer");
        return LENSPROF_ERROR_ARGUMENT;
    }
    std::string all;
    lensprof_status status = at_boundary(error, [&] { all = database_text(profiles, count); });
    if (status != LENSPROF_OK) return status;
    status = copy_text(all, text, capacity, needed);
    if (status != LENSPROF_OK) set_error(error, "the text is longer than the buffer; call again with the size needed");
    return status;
}
