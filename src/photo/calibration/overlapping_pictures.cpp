#include "photo/calibration/overlapping_pictures.hpp"

#include <algorithm>

#include "photo/base/file_kind.hpp"
#include "photo/calibration/project_fit.hpp"
#include "photo/reconstruction/reconstruction_file.hpp"
#include "photo/scene/photographs.hpp"
#include "photo/scene/reconstruction_project.hpp"

namespace lensprof {

Project project_of_words(const std::vector<std::string> &words, const std::string &images, Events &events) {
    const bool is_one = words.size() == 1;
    if (is_one && is_reconstruction(words[0])) {
        ReconstructionOptions options;
        options.images = images;
        return project_of_reconstruction(words[0], options, events);
    }
    if (!images.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, option_name("images") + ": is for reconstructions, but " + words[0]
                                                   + " is not one; omit the option");
    for (const std::string &word : words) refuse_other_kind(word);
    if (is_one && !is_picture_argument(words[0])) {
        reject_reconstruction_part(words[0]);
        return read_project(words[0]);
    }
    for (const std::string &word : words)
        if (!is_picture_argument(word))
            throw Failure(LENSPROF_ERROR_READ, word + ": is neither a picture (.jpg, .png, .tif) nor a folder; give "
                                                       "a single project, or pictures and folders");
    return project_of_pictures(find_photographs(words, events), false, events);
}

DrawnPairs draw_pairs(const Project &project, Events &progress) {
    const ProjectFitOptions options;
    if (!project.is_reconstruction) check_pictures(project, options.pixels.max_side);
    return first_pairs(options, project, progress);
}

}  // namespace lensprof
