#include "photo/scene/hugin_project.hpp"

#include <array>
#include <filesystem>
#include <map>
#include <tuple>

#include "photo/base/file_kind.hpp"
#include "photo/base/format.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"

namespace lensprof {
namespace {

uint32_t find_reference(const Scene &scene) {
    for (uint32_t i = 0; i < scene.images.size(); i++)
        if (!(scene.images[i].free & LENSPROF_FREE_EV)) return i;
    return 0;
}

// No file can have such a name: the project is damaged.
void check_name(const Scene &scene, uint32_t i) {
    if (scene.names[i].empty())
        throw Failure(LENSPROF_ERROR_READ, scene.path + ": image " + std::to_string(i)
                                               + " has no file name (its n is empty or missing); correct the project");
    if (is_too_long(scene.files[i]))
        throw Failure(LENSPROF_ERROR_READ, scene.path + ": image " + std::to_string(i) + ": its name "
                                               + short_name(scene.names[i])
                                               + " is too long for a file name; correct the project");
}

// One model per response and falloff.
class Models {
public:
    explicit Models(const Scene &scene) : scene_(scene) {}

    std::shared_ptr<const lensprof_profile> at(uint32_t i) {
        const lensprof_pto_image &image = scene_.images[i];
        const lensprof_vignetting &v = image.vignetting;
        const Key key{image.response_type,
                      {image.emor[0], image.emor[1], image.emor[2], image.emor[3], image.emor[4], v.k[0], v.k[1],
                       v.k[2], v.center[0], v.center[1]}};
        auto &model = known_[key];
        if (model) return model;
        auto made = std::shared_ptr<lensprof_profile>(new_profile());
        lensprof_error error{};
        check(lensprof_pto_get_response(scene_.document.get(), i, &made->response[0], &error), scene_.path, &error);
        made->vignetting[0] = v;
        return model = made;
    }

private:
    using Key = std::pair<uint32_t, std::array<double, 10>>;
    const Scene &scene_;
    std::map<Key, std::shared_ptr<const lensprof_profile>> known_;
};

// ` a0.1`, or ` a=3` if the value is linked to image 3.
std::string shared(const char *name, double value, uint32_t i, uint32_t first) {
    return i == first ? format(" %s%.17g", name, value) : format(" %s=%u", name, first);
}

// Of a scene without a project; the name is replaced, because it may contain quotes.
std::string image_line(const Scene &scene, uint32_t i) {
    const uint32_t of_camera = scene.images[i].response_of, of_lens = scene.lenses[i];
    const lensprof_camera &c = scene.images[i].camera;
    std::string line = format("i w%u h%u f%u", c.width, c.height, c.projection) + shared("v", c.hfov_deg, i, of_lens);
    for (const char *name : {"Ra", "Rb", "Rc", "Rd", "Re"}) line += shared(name, 0.0, i, of_camera);
    line += format(" Eev0 Er1 Eb1 r%.17g p%.17g y%.17g TrX%.17g TrY%.17g TrZ%.17g Tpy%.17g Tpp%.17g j0", c.roll_deg,
                   c.pitch_deg, c.yaw_deg, c.translation[0], c.translation[1], c.translation[2], c.plane_deg[0],
                   c.plane_deg[1]);
    const std::pair<const char *, double> lens[] = {{"a", c.radial[0]},   {"b", c.radial[1]},   {"c", c.radial[2]},
                                                    {"d", c.shift_px[0]}, {"e", c.shift_px[1]}, {"g", c.shear_px[0]},
                                                    {"t", c.shear_px[1]}};
    for (const auto &[name, value] : lens) line += shared(name, value, i, of_lens);
    for (const char *name : {"Va", "Vb", "Vc", "Vd", "Vx", "Vy"}) line += shared(name, name[1] == 'a', i, of_camera);
    return line + format(" Vm5 n\"image%u\"\n", i);
}

// Without photometric values; its `v` lines free those of all images, relative to the first.
std::string new_project_text(const Scene &scene) {
    std::string text =
        "# written by lensprof\np f2 w3000 h1500 v360  E0 R0 n\"TIFF_m c:LZW\"\nm g1 i0 f0 m2 p0.00784314\n\n";
    std::string asked;
    for (uint32_t i = 0; i < scene.images.size(); i++) {
        text += image_line(scene, i);
        if (scene.images[i].response_of == i)
            asked += format("v Ra%u Rb%u Rc%u Rd%u Re%u\nv Vb%u Vc%u Vd%u Vx%u Vy%u\n", i, i, i, i, i, i, i, i, i, i);
        if (i > 0) asked += format("v Eev%u Er%u Eb%u\n", i, i, i);
    }
    text += "\n" + asked + "v\n";
    for (const ControlPoint &p : scene.control_points)
        text += format("c n%u N%u x%.3f y%.3f X%.3f Y%.3f t0\n", p.image[0], p.image[1], p.xy[0][0], p.xy[0][1],
                       p.xy[1][0], p.xy[1][1]);
    return text;
}

bool is_beside(const std::string &file, const std::string &other) {
    const auto folder_of = [](const std::string &path) {
        return std::filesystem::path(absolute_path(path)).parent_path();
    };
    return is_regular_file(other) && folder_of(file) == folder_of(other);
}

void set_name(Pto &project, uint32_t image, const std::string &name) {
    lensprof_error error{};
    check(lensprof_pto_set_name(project.get(), image, name.c_str(), &error), name, &error);
}

}  // namespace

Scene read_hugin_project(const std::string &path) {
    Scene scene;
    scene.path = path;
    scene.document = read_pto(path);
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    Models models(scene);
    for (uint32_t i = 0; i < lensprof_pto_image_count(scene.document.get()); i++) {
        lensprof_pto_image image;
        lensprof_pto_image_init(&image);
        lensprof_error error{};
        check(lensprof_pto_get_image(scene.document.get(), i, &image, &error), path, &error);
        scene.images.push_back(image);
        scene.models.push_back(models.at(i));
        scene.names.push_back(pto_name(*scene.document, i));
        scene.files.push_back((folder / scene.names[i]).string());
        check_name(scene, i);
    }
    scene.reference = find_reference(scene);
    return scene;
}

Pto hugin_project(const Scene &scene, const std::string &path) {
    Pto project = scene.document;
    if (project && is_beside(path, scene.path)) return project;
    if (!project) project = parse_pto(new_project_text(scene), scene.path);
    const auto folder = std::filesystem::path(absolute_path(path)).parent_path();
    for (uint32_t i = 0; i < scene.files.size(); i++)
        set_name(project, i, std::filesystem::path(absolute_path(scene.files[i])).lexically_proximate(folder).string());
    return project;
}

void write_hugin_project(const Scene &scene, const std::string &path) {
    const std::string text = pto_text(*hugin_project(scene, path));
    write_file(path, text.data(), text.size());
}

}  // namespace lensprof
