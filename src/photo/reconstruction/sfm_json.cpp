// AliceVision's .sfm and OpenMVG's sfm_data.json. Both are JSON with views, poses and structure; AliceVision writes
// numbers as strings, OpenMVG keys and values of maps.
#include <cmath>
#include <filesystem>
#include <map>

#include "photo/base/failure.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/reconstruction/json_file.hpp"
#include "photo/reconstruction/readers.hpp"

namespace lensprof {
namespace {

[[noreturn]] void fail_damaged(const std::string &path, const std::string &problem) {
    throw Failure(LENSPROF_ERROR_READ, path + ": " + problem + "; export it again, with structure and observations");
}

struct Views {
    Reconstruction found;
    std::map<std::string, uint32_t> image_of;                // by id of the view
    std::map<std::string, std::array<double, 3>> centre_of;  // by id of the pose
    std::map<std::string, std::string> pose_of;              // by id of the view
};

void add_view(const std::string &id, const std::string &name, int64_t width, int64_t height, Views &views) {
    Reconstruction &found = views.found;
    const std::string &path = found.path;
    if (id.empty() || name.empty()) fail_damaged(path, "has a view without id or name");
    if (width < 0 || height < 0 || width > max_image_side || height > max_image_side || !width != !height)
        fail_damaged(path, short_name(name) + " has no valid size");
    if (!views.image_of.emplace(id, static_cast<uint32_t>(found.images.size())).second)
        fail_damaged(path, "has two views with the id " + short_name(id));
    found.images.push_back({name, static_cast<uint32_t>(found.cameras.size()), false, {}});
    found.cameras.push_back({static_cast<uint32_t>(width), static_cast<uint32_t>(height)});
}

// px; 0 if not stated
int64_t side_of(const SceneJson &view, const char *name) { return view.contains(name) ? whole_at(view, name) : 0; }

void add_observation(const std::string &view, int64_t feature, const SceneJson &place, double scale, Views &views) {
    Reconstruction &found = views.found;
    const auto image = views.image_of.find(view);
    if (image == views.image_of.end())
        fail_damaged(found.path, "has an observation in view " + short_name(view) + ", which does not exist");
    TrackObservation result;
    result.point = static_cast<uint32_t>(found.points.size()), result.image = image->second;
    result.feature = feature < 0 ? 0 : static_cast<uint32_t>(feature);
    for (size_t d = 0; d < 2; d++) {
        const double x = d < place.size() ? real_of(place[d]) : NAN;
        if (!std::isfinite(x)) fail_damaged(found.path, "has an observation without a position");
        result.xy[d] = static_cast<float>(x);  // as in VLFeat's SIFT: the centre of the first pixel is (0, 0)
    }
    if (scale > 0.0) result.shape[0][0] = result.shape[1][1] = static_cast<float>(scale);
    found.observations.push_back(result);
}

void place_images(Views &views) {
    for (const auto &[view, pose] : views.pose_of) {
        const auto centre = views.centre_of.find(pose);
        ReconstructionImage &image = views.found.images[views.image_of.at(view)];
        if (centre != views.centre_of.end() && is_finite(centre->second))
            image.centre = centre->second, image.has_centre = true;
    }
}

Reconstruction finished(Views &views, const SceneJson &structure) {
    if (structure.empty()) fail_damaged(views.found.path, "has no structure, and so no points that connect images");
    place_images(views);
    clean_tracks(views.found);
    sort_images(views.found);
    return std::move(views.found);
}

// The top-level members of a JSON file, without reading it completely.
bool has_members(const std::string &path, const char *const *names, const char *end) {
    const std::string ending(end);
    if (path.size() < ending.size() || path.compare(path.size() - ending.size(), ending.size(), ending) != 0)
        return false;
    if (!is_regular_file(path)) return false;
    const std::string head = read_head(path, 1 << 16);
    if (head.find('{') == std::string::npos) return false;
    for (; *names; names++)
        if (head.find(std::string("\"") + *names + "\"") == std::string::npos) return false;
    return true;
}

}  // namespace

bool is_alicevision(const std::string &path) {
    static const char *const names[] = {"version", nullptr};
    return has_members(path, names, ".sfm");
}

Reconstruction read_alicevision(const std::string &path) {
    const SceneJson all = read_json_file(path);
    Views views;
    views.found.kind = "AliceVision scene", views.found.path = path;
    for (const SceneJson &view : list_at(all, "views")) {
        const std::string id = text_at(view, "viewId");
        add_view(id, text_at(view, "path"), side_of(view, "width"), side_of(view, "height"), views);
        views.pose_of[id] = text_at(view, "poseId");
    }
    for (const SceneJson &pose : list_at(all, "poses"))
        views.centre_of[text_at(pose, "poseId")] = vector_at(object_at(object_at(pose, "pose"), "transform"), "center");
    const SceneJson &structure = list_at(all, "structure");
    for (const SceneJson &point : structure) {
        for (const SceneJson &observation : list_at(point, "observations"))
            add_observation(
                text_at(observation, "observationId"), whole_at(observation, "featureId"), list_at(observation, "x"),
                observation.is_object() && observation.contains("scale") ? real_of(observation["scale"]) : 0.0, views);
        views.found.points.push_back(vector_at(point, "X"));
    }
    return finished(views, structure);
}

bool is_openmvg(const std::string &path) {
    static const char *const names[] = {"sfm_data_version", nullptr};
    return has_members(path, names, ".json");
}

Reconstruction read_openmvg(const std::string &path) {
    const SceneJson all = read_json_file(path);
    Views views;
    views.found.kind = "OpenMVG scene", views.found.path = path;
    const std::string root = text_at(all, "root_path");
    for (const SceneJson &entry : list_at(all, "views")) {
        const SceneJson &view = object_at(object_at(object_at(entry, "value"), "ptr_wrapper"), "data");
        const std::string id = text_at(view, "id_view");
        // Relative to the common folder, even with a leading slash.
        std::string folder = text_at(view, "local_path");
        if (!root.empty()) folder.erase(0, folder.find_first_not_of('/'));
        const auto name = std::filesystem::path(folder) / text_at(view, "filename");
        add_view(id, name.string(), side_of(view, "width"), side_of(view, "height"), views);
        views.pose_of[id] = text_at(view, "id_pose");
    }
    for (const SceneJson &pose : list_at(all, "extrinsics"))
        views.centre_of[text_at(pose, "key")] = vector_at(object_at(pose, "value"), "center");
    const SceneJson &structure = list_at(all, "structure");
    for (const SceneJson &point : structure) {
        const SceneJson &value = object_at(point, "value");
        for (const SceneJson &observation : list_at(value, "observations"))
            add_observation(text_at(observation, "key"), whole_at(object_at(observation, "value"), "id_feat"),
                            list_at(object_at(observation, "value"), "x"), 0.0, views);
        views.found.points.push_back(vector_at(value, "X"));
    }
    views.found.folder = root;
    return finished(views, structure);
}

}  // namespace lensprof
