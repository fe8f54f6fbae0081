// The cameras of Lensfun databases.
#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <lensprof/formats.h>

#include "formats/falloff/import.hpp"
#include "formats/lensfun.hpp"
#include "formats/text/text.hpp"

namespace lensprof {
namespace {

constexpr std::string_view kStandard = "(Standard)";  // how Lensfun marks a built-in lens without a converter

bool is_standard(const std::string &name) {
    return name.size() >= kStandard.size()
           && name.compare(name.size() - kStandard.size(), kStandard.size(), kStandard) == 0;
}

// The built-in lens of several, the others being of the same camera with converters or in special modes: the one that
// is marked, or with whose name all others begin. Empty where that is not clear.
std::string choose_lens(const std::vector<std::string> &names) {
    if (names.size() == 1) return names.front();
    if (std::count_if(names.begin(), names.end(), is_standard) == 1)
        return *std::find_if(names.begin(), names.end(), is_standard);
    for (const std::string &name : names)
        if (std::all_of(names.begin(), names.end(),
                        [&](const std::string &other) { return other.compare(0, name.size(), name) == 0; }))
            return name;
    return {};
}

class CameraReader {
public:
    CameraReader(std::string_view text, const char *source)
        : xml_(text, {"lensdatabase"}), origin_(lensfun_origin(text)) {
        const auto profile = std::make_unique<lensprof_profile>();
        lensprof_profile_init(profile.get());
        set_import_provenance(*profile, source, origin_);
        source_ = profile->provenance.source;
        check_lensfun_version(xml_);
        for (pugi::xml_node lens : xml_.root().children("lens")) {
            const auto mounts = lens.children("mount");
            if (std::distance(mounts.begin(), mounts.end()) == 1)
                lenses_[lensfun_text(lens, "mount")].push_back(lensfun_lens_name(lens));
        }
        for (pugi::xml_node camera : xml_.root().children("camera"))
            if (!lensfun_text(camera, "model").empty()) cameras_.push_back(read(camera));
    }

    const std::vector<lensprof_camera_model> &cameras() const { return cameras_; }

private:
    template <size_t size>
    void put(const pugi::xml_node &camera, const std::string &text, char (&field)[size]) const {
        xml_.check_key_text(camera, "camera " + in_quotes(lensfun_text(camera, "model")) + ": ", text, size);
        put_text(field, size, text);
    }

    // The text in English where that is not the one without a language.
    static std::string other_text(const pugi::xml_node &camera, const char *name) {
        for (pugi::xml_node child : camera.children(name))
            if (std::string_view(child.attribute("lang").value()) == "en") {
                const std::string text = one_line(child.child_value());
                return text == lensfun_text(camera, name) ? std::string() : text;
            }
        return {};
    }

    double read_crop_factor(const pugi::xml_node &camera) const {
        const pugi::xml_node crop = camera.child("cropfactor");
        const std::string word = one_line(crop.child_value());
        double value = LENSPROF_UNKNOWN;
        if (crop && (!read_number(word, value) || !(value > 0.0 && value <= 1e4)))
            fail_at_line(xml_.line_of(crop), "camera " + in_quotes(lensfun_text(camera, "model")) + ": cropfactor is "
                                                 + in_quotes(word)
                                                 + ", not a number above 0 and up to 1e4; correct it");
        return value;
    }

    lensprof_camera_model read(const pugi::xml_node &entry) const {
        lensprof_camera_model camera;
        lensprof_camera_model_init(&camera);
        const std::string mount = lensfun_text(entry, "mount");
        put(entry, lensfun_text(entry, "maker"), camera.maker);
        put(entry, lensfun_text(entry, "model"), camera.model);
        put(entry, other_text(entry, "maker"), camera.other_maker);
        put(entry, other_text(entry, "model"), camera.other_model);
        put(entry, lensfun_text(entry, "variant"), camera.variant);
        put(entry, mount, camera.mount);
        put_text(camera.source, sizeof camera.source, source_);
        camera.crop_factor = read_crop_factor(entry);
        camera.fixed_lens = is_fixed_mount(mount);
        const auto found = lenses_.find(mount);
        if (camera.fixed_lens && found != lenses_.end()) put(entry, choose_lens(found->second), camera.lens);
        return camera;
    }

    XmlText xml_;
    std::string origin_, source_;
    std::map<std::string, std::vector<std::string>> lenses_;  // by mount, of those with one
    std::vector<lensprof_camera_model> cameras_;
};

}  // namespace
}  // namespace lensprof

using namespace lensprof;

lensprof_status lensprof_lensfun_read_cameras(const void *data, size_t size, const char *source,
                                              lensprof_camera_visitor visit, void *user, lensprof_error *error) {
    if ((!data && size) || !visit) {
        set_error(error, "lensprof_lensfun_read_cameras: data or visit is NULL; pass a buffer and a function");
        return LENSPROF_ERROR_ARGUMENT;
    }
    lensprof_status visited = LENSPROF_OK;
    const lensprof_status status = at_boundary(error, [&] {
        const CameraReader reader(view_of(data, size), source);
        for (const lensprof_camera_model &camera : reader.cameras()) {
            visited = visit(user, &camera);
            if (visited != LENSPROF_OK) return;
        }
    });
    return status == LENSPROF_OK ? visited : status;
}
