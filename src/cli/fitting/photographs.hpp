// Pictures that are in no project, as one.
#pragma once

#include <string>
#include <vector>

#include "cli/fitting/project.hpp"
#include "cli/pictures/named_pictures.hpp"
#include "cli/program/run.hpp"
#include "cli/registration/registration.hpp"

namespace lensprof {

// Whether a word of the command line names a picture or a folder, and not a project.
bool names_pictures(const std::string &word);

// Every picture once, whatever its names; copies of a picture are left out. Within a folder that is the only word
// reports call a picture by the rest of its path.
struct Photographs {
    std::string label;  // of all
    std::vector<std::string> files, names;
    std::vector<std::pair<std::string, std::string>> left_out;  // files, and why
};
Photographs list_photographs(const std::vector<std::string> &words, const std::vector<NamedPicture> &pictures);

// The pictures that are named, and those of folders that are. What calibrate has written is left out. What is left out
// is named on standard error. Failure for raw files among others (usage), and where fewer than two are left.
Photographs find_photographs(const std::vector<std::string> &words, Streams &streams);

// Finds the overlaps. The project is that of the largest group; what it leaves out is named on standard
// error. With `one_lens` all pictures are taken as of one. All unknowns are asked for. Failure (not usable) where no
// two overlap.
Project project_of_pictures(const Photographs &list, bool one_lens, Progress &progress, Streams &streams);

// Why a picture is not part of a project that it overlaps with, directly or through others.
constexpr const char *of_another_body =
    "of a camera, size or processing of which no two pictures overlap (--one-lens takes all as of one)";
constexpr const char *joined_by_another_body =
    "only pictures of another camera, size or processing join it to the others (--one-lens takes all as of one)";

// Why pictures of a camera that did not move are not fitted, and what they serve for.
constexpr const char *no_falloff_of_still =
    ": the camera did not move, and the pictures show no falloff; `lensprof bracket` finds its response, `lensprof align` "
    "evens or merges them";

// What is to be said of a project whose cameras do not fit.
constexpr const char *no_cameras_fit =
    ": no cameras fit the pictures well: parallax of a camera that moved, distortion, or things that moved. The pictures "
    "are compared where they match; a project or preview of them does not show the scene";

// The project of a group of pictures, whose images are called image0, image1 and so on; and the same as a project,
// whose path, names and files are known.
std::string text_of_found(const FoundProject &found);
void read_found(const std::string &text, Project &project);

void write_project(Project &project, const std::string &path);

}  // namespace lensprof
