// Lensfun databases to profiles.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <string>

#include "formats/each_format.h"

#include "falloff/refit.hpp"
#include "formats/falloff/import.hpp"
#include "formats/falloff/radius.hpp"
#include "formats/lensfun.hpp"
#include "formats/text/text.hpp"
#include "formats/text/xml.hpp"

namespace lensprof {
namespace {

struct Camera {
    std::string maker, model;
    uint32_t count = 0;  // cameras with this mount
};

class LensfunReader {
public:
    LensfunReader(std::string_view text, const char *source)
        : xml_(text, {"lensdatabase"}), profile_(new lensprof_profile) {
        lensprof_profile_init(profile_.get());
        set_import_provenance(*profile_, source, lensfun_origin(text));
        check_lensfun_version(xml_);
        for (pugi::xml_node camera : xml_.root().children("camera")) add_camera(camera);
    }

    // Calls use(profile) for every entry until it does not return OK.
    template <typename Use>
    lensprof_status walk(Use use);

private:
    [[noreturn]] void fail(const pugi::xml_node &node, const std::string &text,
                           lensprof_status status = LENSPROF_ERROR_SYNTAX) const {
        fail_at_line(xml_.line_of(node), label_ + text, status);
    }

    void add_camera(const pugi::xml_node &camera);
    void check_text(const pugi::xml_node &node, const std::string &text, size_t capacity) const;
    double number(const pugi::xml_node &node, std::string_view text, const char *item, double low, double high) const;
    double attribute(const pugi::xml_node &node, const char *name, double low, double high) const;
    double aspect_ratio(const pugi::xml_node &node, std::string_view text) const;
    void begin_lens(const pugi::xml_node &lens);
    void begin_calibration(const pugi::xml_node &lens, const pugi::xml_node &calibration);
    void read_center(const pugi::xml_node &lens, double aspect);
    double real_focal(const pugi::xml_node &entry, double focal_mm) const;
    void read_entry(const pugi::xml_node &entry);

    XmlText xml_;
    std::unique_ptr<lensprof_profile> profile_;
    std::map<std::string, Camera, std::less<>> cameras_;  // by mount
    std::string label_;                                   // of the lens, for error texts
};

void LensfunReader::add_camera(const pugi::xml_node &camera) {
    Camera &entry = cameras_[lensfun_text(camera, "mount")];
    if (entry.count++) return;
    entry.maker = lensfun_text(camera, "maker");
    entry.model = lensfun_text(camera, "model");
}

void LensfunReader::check_text(const pugi::xml_node &node, const std::string &text, size_t capacity) const {
    xml_.check_key_text(node, label_, text, capacity);
}

// The text as a number of (low, high]; low itself only where it is negative.
double LensfunReader::number(const pugi::xml_node &node, std::string_view text, const char *item, double low,
                             double high) const {
    const std::string word = one_line(text);
    double value = 0.0;
    if (!read_number(word, value))
        fail(node, std::string(item) + " is " + in_quotes(word) + ", not a finite number; correct it");
    if (!(value > low || (low < 0.0 && value == low)) || value > high)
        fail(node, std::string(item) + " is " + in_quotes(word) + (low < 0.0 ? ", beyond " : ", not above 0 and up to ")
                       + number_text(high) + "; correct it");
    return value;
}

double LensfunReader::attribute(const pugi::xml_node &node, const char *name, double low, double high) const {
    const pugi::xml_attribute found = node.attribute(name);
    if (!found) fail(node, "<" + std::string(node.name()) + "> has no " + name + "; add it");
    return number(node, found.value(), name, low, high);
}

// "3:2" or "1.5".
double LensfunReader::aspect_ratio(const pugi::xml_node &node, std::string_view text) const {
    const size_t colon = text.find(':');
    const double first = number(node, text.substr(0, colon), "aspect ratio", 0.0, 1e4);
    return colon == std::string_view::npos ? first
                                           : first / number(node, text.substr(colon + 1), "aspect ratio", 0.0, 1e4);
}

void LensfunReader::begin_lens(const pugi::xml_node &lens) {
    label_.clear();
    const std::string name = lensfun_lens_name(lens);
    if (name.empty()) fail(lens, "a <lens> without a <model>; add it");
    lensprof_profile_key &key = profile_->key;
    lensprof_profile_key_init(&key);
    key.processing = LENSPROF_PROCESSING_RAW;
    check_text(lens, name, sizeof key.lens);
    put_text(key.lens, sizeof key.lens, name);
    label_ = "lens " + in_quotes(name) + ": ";

    const auto mounts = lens.children("mount");
    if (std::distance(mounts.begin(), mounts.end()) != 1) return;
    const std::string mount = lensfun_text(lens, "mount");
    const auto found = cameras_.find(mount);
    if (!is_fixed_mount(mount) || found == cameras_.end() || found->second.count != 1) return;
    check_text(lens, found->second.maker, sizeof key.camera_maker);
    check_text(lens, found->second.model, sizeof key.camera_model);
    put_text(key.camera_maker, sizeof key.camera_maker, found->second.maker);
    put_text(key.camera_model, sizeof key.camera_model, found->second.model);
}

// Crop factor and centre, which the calibration of a newer database may give for itself.
void LensfunReader::begin_calibration(const pugi::xml_node &lens, const pugi::xml_node &calibration) {
    const pugi::xml_attribute crop_attribute = calibration.attribute("cropfactor"),
                              aspect_attribute = calibration.attribute("aspect-ratio");
    const pugi::xml_node crop = lens.child("cropfactor"), aspect = lens.child("aspect-ratio");
    if (!crop_attribute && !crop) fail(lens, "no <cropfactor>; add it");
    profile_->key.crop_factor = crop_attribute ? number(calibration, crop_attribute.value(), "cropfactor", 0.0, 1e4)
                                               : number(crop, crop.child_value(), "cropfactor", 0.0, 1e4);
    read_center(lens, aspect_attribute ? aspect_ratio(calibration, aspect_attribute.value())
                      : aspect         ? aspect_ratio(aspect, aspect.child_value())
                                       : kLensfunAspectRatio);
}

void LensfunReader::read_center(const pugi::xml_node &lens, double aspect) {
    const pugi::xml_node center = lens.child("center");
    const char *const names[2] = {"x", "y"};
    for (int i = 0; i < 2; i++) {
        const double value = center && center.attribute(names[i]) ? attribute(center, names[i], -1e6, 1e6) : 0.0;
        profile_->vignetting[0].center[i] = value * half_short_side(aspect);
    }
}

double LensfunReader::real_focal(const pugi::xml_node &entry, double focal_mm) const {
    for (pugi::xml_node distortion : entry.parent().children("distortion")) {
        double focal = 0.0;
        if (distortion.attribute("real-focal") && read_number(distortion.attribute("focal").value(), focal)
            && focal == focal_mm)
            return attribute(distortion, "real-focal", 0.0, 1e5);
    }
    return focal_mm;
}

void LensfunReader::read_entry(const pugi::xml_node &entry) {
    lensprof_profile_key &key = profile_->key;
    key.focal_mm = attribute(entry, "focal", 0.0, 1e5);
    key.aperture = attribute(entry, "aperture", 0.0, 1e4);
    key.distance_m = attribute(entry, "distance", 0.0, 1e300);
    if (key.distance_m == kLensfunInfinityM) key.distance_m = INFINITY;
    const std::string model = entry.attribute("model").value();
    if (model != "pa" && model != "acm")
        fail(entry, "a falloff of model " + in_quotes(model) + "; lensprof reads \"pa\" and \"acm\"",
             LENSPROF_ERROR_UNSUPPORTED);
    static constexpr const char *kNames[2][3] = {{"k1", "k2", "k3"}, {"alpha1", "alpha2", "alpha3"}};
    const bool acm = model == "acm";
    std::array<double, 3> terms{};
    for (int n = 0; n < 3; n++)  // Lensfun takes those after the first that are left out as 0
        if (n == 0 || entry.attribute(kNames[acm][n])) terms[n] = attribute(entry, kNames[acm][n], -1e300, 1e300);
    if (acm) terms = in_half_diagonals(terms, real_focal(entry, key.focal_mm) / half_diagonal_mm(key.crop_factor));
    for (double k : terms)
        if (!std::isfinite(k)) fail(entry, "coefficients out of range; correct them");
    std::copy(terms.begin(), terms.end(), profile_->vignetting[0].k);
}

template <typename Use>
lensprof_status LensfunReader::walk(Use use) {
    for (pugi::xml_node lens : xml_.root().children("lens")) {
        begin_lens(lens);
        for (pugi::xml_node calibration : lens.children("calibration")) {
            if (!calibration.child("vignetting")) continue;
            begin_calibration(lens, calibration);
            for (pugi::xml_node entry : calibration.children("vignetting")) {
                read_entry(entry);
                const lensprof_status status = use(*profile_);
                if (status != LENSPROF_OK) return status;
            }
        }
    }
    return LENSPROF_OK;
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

lensprof_status lp_lensfun_read(const void *data, size_t size, const char *source, lensprof_import_visitor visit,
                                void *user, lensprof_error *error) {
    if ((!data && size) || !visit) {
        set_error(error, "lensprof_import: data or visit is NULL; pass a buffer and a function");
        return LENSPROF_ERROR_ARGUMENT;
    }
    lensprof_status visited = LENSPROF_OK;
    const lensprof_status status = at_boundary(error, [&] {
        LensfunReader reader(view_of(data, size), source);
        reader.walk([](lensprof_profile &) { return LENSPROF_OK; });  // all entries are checked first
        visited = reader.walk([&](lensprof_profile &profile) { return visit_entry(profile, "", visit, user); });
    });
    return status == LENSPROF_OK ? visited : status;
}
