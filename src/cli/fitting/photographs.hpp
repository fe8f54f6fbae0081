// Pictures that are in no project, as one.
#pragma once

#include <string>
#include <vector>

#include "cli/fitting/project.hpp"
#include "cli/program/run.hpp"

namespace lensprof {

// Whether a word of the command line names a picture or a folder, and not a project.
bool names_pictures(const std::string &word);

// Finds the overlaps of pictures and folders of them. The project is that of the largest group of one lens; what it
// leaves out is named on standard error. With `one_lens` all pictures are taken as of one. All unknowns are asked for.
// Failure (not usable) where no two overlap.
Project project_of_pictures(const std::vector<std::string> &words, bool one_lens, Progress &progress, Streams &streams);

void write_project(Project &project, const std::string &path);

}  // namespace lensprof
