#include "photo/scene/open_scene.hpp"

#include "photo/base/file_kind.hpp"
#include "photo/base/paths.hpp"
#include "photo/reconstruction/reconstruction_file.hpp"
#include "photo/scene/exposure_reader.hpp"
#include "photo/scene/hugin_project.hpp"
#include "photo/scene/photographs.hpp"

namespace lensprof {

Scene open_scene(const std::vector<std::string> &paths, const SceneOptions &options, Events &events) {
    const bool is_one = paths.size() == 1;
    if (is_one && is_reconstruction(paths[0])) return scene_of_reconstruction(paths[0], options.reconstruction, events);
    const std::string &images = options.reconstruction.images;
    if (is_one && options.takes_exposures && is_regular_file(paths[0]) && is_exposure_file(paths[0]))
        return read_exposures(paths[0], images);
    if (!images.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, option_name("images") + ": is for reconstructions, but " + paths[0]
                                                   + " is not one; omit the option");
    for (const std::string &path : paths) refuse_other_kind(path);
    if (is_one && !is_picture_argument(paths[0])) {
        reject_reconstruction_part(paths[0]);
        return read_hugin_project(paths[0]);
    }
    for (const std::string &path : paths)
        if (!is_picture_argument(path))
            throw Failure(LENSPROF_ERROR_READ, path + ": is neither a picture (.jpg, .png, .tif) nor a folder; give a "
                                                      "single project, or pictures and folders");
    return scene_of_pictures(find_photographs(paths, events), options.one_lens, events);
}

}  // namespace lensprof
