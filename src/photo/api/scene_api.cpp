// Scenes: opened, asked, saved.
#include "photo/api/handles.hpp"
#include "photo/api/sized.hpp"
#include "photo/registration/registration.hpp"
#include "photo/scene/hugin_project.hpp"
#include "photo/scene/open_scene.hpp"
#include "photo/scene/photographs.hpp"

using namespace lensprof;

namespace {

constexpr size_t first_scene_options = LENSPROF_FIRST(lensprof_scene_options, image_list),
                 first_scene_info = LENSPROF_FIRST(lensprof_scene_info, links);

}  // namespace

lensprof_status lensprof_scene_open(const char *const *paths, uint32_t count, const lensprof_scene_options *given,
                                    const lensprof_events *events, lensprof_scene **scene, lensprof_error *error) {
    CallerEvents caller;
    return photo_call("scene", caller, error, [&] {
        caller.set(events);
        require(scene, "scene"), require(count ? paths : nullptr, "paths");
        lensprof_scene_options defaults;
        lensprof_scene_options_init(&defaults);
        const lensprof_scene_options o = taken(given, defaults, first_scene_options, "options");
        std::vector<std::string> names;
        for (uint32_t i = 0; i < count; i++) {
            require(paths[i], "path");
            names.emplace_back(paths[i]);
        }
        SceneOptions options;
        options.one_lens = o.one_lens != 0;
        options.reconstruction.images = o.images ? o.images : "";
        options.reconstruction.image_list = o.image_list ? o.image_list : "";
        auto handle = std::make_unique<lensprof_scene>();
        handle->scene = open_scene(names, options, caller);
        *scene = handle.release();
    });
}

void lensprof_scene_destroy(lensprof_scene *scene) { delete scene; }

lensprof_status lensprof_scene_get_info(const lensprof_scene *scene, lensprof_scene_info *info, lensprof_error *error) {
    return photo_call("scene", error, [&] {
        require(scene, "scene"), require(info, "info");
        const Scene &of = scene->scene;
        lensprof_scene_info found;
        lensprof_scene_info_init(&found);
        found.images = static_cast<uint32_t>(of.images.size());
        found.left_out = static_cast<uint32_t>(of.left_out.size());
        found.matches = static_cast<uint32_t>(of.matches.size());
        found.links = static_cast<uint32_t>(of.links.size());
        found.reference = of.reference;
        found.is_reconstruction = of.is_reconstruction;
        give(found, info, first_scene_info, "info");
    });
}

lensprof_status lensprof_scene_image_at(const lensprof_scene *scene, uint32_t index, lensprof_camera *camera,
                                        const char **name, const char **file, lensprof_error *error) {
    return photo_call("scene", error, [&] {
        require(scene, "scene"), require_index(index, scene->scene.images.size(), "image");
        if (camera) *camera = scene->scene.images[index].camera;
        if (name) *name = scene->scene.names[index].c_str();
        if (file) *file = scene->scene.files[index].c_str();
    });
}

lensprof_status lensprof_scene_link_at(const lensprof_scene *scene, uint32_t index, lensprof_scene_link *link,
                                       lensprof_error *error) {
    return photo_call("scene", error, [&] {
        require(scene, "scene"), require(link, "link");
        require_index(index, scene->scene.links.size(), "link");
        *link = scene->scene.links[index];
    });
}

lensprof_status lensprof_scene_match_at(const lensprof_scene *scene, uint32_t index, lensprof_match *match,
                                        lensprof_error *error) {
    return photo_call("scene", error, [&] {
        require(scene, "scene"), require(match, "match");
        require_index(index, scene->scene.matches.size(), "match");
        *match = scene->scene.matches[index];
    });
}

lensprof_status lensprof_scene_left_out_at(const lensprof_scene *scene, uint32_t index, const char **name,
                                           const char **reason, lensprof_error *error) {
    return photo_call("scene", error, [&] {
        require(scene, "scene"), require_index(index, scene->scene.left_out.size(), "picture");
        if (name) *name = scene->scene.left_out[index].first.c_str();
        if (reason) *reason = scene->scene.left_out[index].second.c_str();
    });
}

lensprof_status lensprof_scene_save(const lensprof_scene *scene, const char *path, lensprof_error *error) {
    return photo_call("scene", error, [&] {
        require(scene, "scene"), require(path, "path");
        refuse_own_file(path, "project", scene->scene);
        write_hugin_project(scene->scene, path);
    });
}
