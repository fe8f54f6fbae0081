#include "photo/calibration/lens_file.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "photo/base/databases.hpp"
#include "photo/base/format.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/pictures/picture_levels.hpp"

namespace lensprof {
namespace {

constexpr uint64_t max_file_bytes = uint64_t{64} << 20;  // that the library reads

// The databases that exist, and always the installed one, which has the cameras.
std::vector<std::string> camera_tables(const std::vector<std::string> &dbs) {
    std::vector<std::string> files = existing_databases(dbs);
    const std::string installed = installed_database();
    if (!installed.empty() && std::find(files.begin(), files.end(), installed) == files.end())
        files.push_back(installed);
    return files;
}

using CameraName = std::pair<std::string, std::string>;  // maker, model

// False if none of the tables has the camera.
bool find_camera(const Databases &databases, const CameraName &name, lensprof_camera_model &camera) {
    lensprof_camera_model_init(&camera);
    for (size_t i = 0; i < databases.size() && !name.second.empty(); i++) {
        lensprof_error error{};
        const auto status =
            lensprof_store_find_camera(databases.store(i), name.first.c_str(), name.second.c_str(), &camera, &error);
        if (status == LENSPROF_OK) return true;
        if (status != LENSPROF_ERROR_NOT_FOUND) check(status, databases.file(i), &error);
    }
    return false;
}

}  // namespace

std::vector<std::string> notes_of(const LensFileCost &cost, const std::vector<std::string> &names) {
    constexpr double noted_cost_ev = 0.02;  // below it nobody sees the difference
    std::vector<std::string> notes;
    for (const std::string &camera : cost.unknown_cameras)
        notes.push_back((camera.empty() ? "camera unknown" : camera + ": not in the table of cameras")
                        + std::string("; mount and maker are taken from the names of the lenses, or Generic"));
    for (size_t i = 0; i < cost.ev.size(); i++)
        if (cost.ev[i] > noted_cost_ev)
            notes.push_back(names[i] + ": written about the middle of the frame as one curve, which is off by up to "
                            + format("%.2f EV in a corner", cost.ev[i]));
    return notes;
}

std::string note_of_levels(const lensprof_profile &profile, const std::string &name) {
    if (!has_levels(profile.levels)) return {};
    return name + ": the file does not hold its black and white level; where it is used, the black level must be "
                  "subtracted from the pictures, and white be full scale, before they are corrected";
}

std::string note_of_circle(const lensprof_profile &profile, const std::string &name) {
    if (profile.image_circle.radius == 0.0) return {};
    return name + ": the file does not hold its image circle; where it is used, what lies outside is lifted by the "
                  "continued falloff";
}

// A camera after another: each is added to the text with those before it.
std::string lens_file_text(const std::vector<const lensprof_profile *> &profiles, const std::vector<std::string> &dbs,
                           const std::string &into, LensFileCost &cost, const std::vector<std::string> &names) {
    std::map<CameraName, std::vector<size_t>> cameras;
    for (size_t i = 0; i < profiles.size(); i++)
        cameras[{profiles[i]->key.camera_maker, profiles[i]->key.camera_model}].push_back(i);
    const Databases databases(camera_tables(dbs));
    std::string text = into.empty() ? std::string() : read_text(into, max_file_bytes);
    bool has_text = !into.empty();
    cost.ev.assign(profiles.size(), 0.0);
    for (const auto &[name, members] : cameras) {
        lensprof_camera_model camera;
        const bool is_known = find_camera(databases, name, camera);
        if (!is_known) cost.unknown_cameras.push_back(name.second);
        std::vector<const lensprof_profile *> chosen;
        std::vector<std::string> chosen_names;
        for (size_t i : members) {
            chosen.push_back(profiles[i]);
            if (i < names.size()) chosen_names.push_back(names[i]);
        }
        std::vector<double> ev(members.size());
        lensprof_export_options options;
        lensprof_export_options_init(&options);
        options.format = LENSPROF_FORMAT_LENSFUN;
        options.camera = is_known ? &camera : nullptr;
        options.into = has_text ? text.data() : nullptr;
        options.into_size = text.size();
        options.cost_ev = ev.data();
        text = exported(into.empty() ? "lens file" : into, chosen, options, chosen_names);
        has_text = true;
        for (size_t i = 0; i < members.size(); i++) cost.ev[members[i]] = ev[i];
    }
    return text;
}

}  // namespace lensprof
