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

// Finds the overlaps of pictures and folders of them. The project is that of the largest group of one camera; what it
// leaves out is named on standard error. With `one_lens` all pictures are taken as of one. All unknowns are asked for.
// Failure (not usable) where no two overlap.
Project project_of_pictures(const std::vector<std::string> &words, bool one_lens, Progress &progress, Streams &streams);

// Every picture once, whatever its names; copies of a picture are left out. Within a folder that is the only word
// reports call a picture by the rest of its path.
struct Photographs {
    std::string label;  // of all
    std::vector<std::string> files, names;
    std::vector<std::pair<std::string, std::string>> copies;  // and of which picture, as a reason
};
Photographs list_photographs(const std::vector<std::string> &words, const std::vector<NamedPicture> &pictures);

// Why a picture is not part of a project that it overlaps with.
constexpr const char *of_another_body = "of another camera or size than most (--one-lens takes all as one)";

// The project of a group of pictures, whose images are called image0, image1 and so on; and the same as a project,
// whose path, names and files are known.
std::string text_of_found(const FoundProject &found);
void read_found(const std::string &text, Project &project);

void write_project(Project &project, const std::string &path);

}  // namespace lensprof
