// Pictures of one scene by a camera that does not move, as a project without a Hugin file.
#pragma once

#include <string>
#include <vector>

#include "cli/fitting/project.hpp"

namespace lensprof {

// A project in which every picture has the same camera, so that equal pixels are the same place, and the falloff is
// held at none: it is the same for all and cancels. Exposures are free, white balances where `free_balance`; the first
// picture is the reference. Failure (usage) for fewer than two files, or one given twice; Failure (unreadable) that
// names a picture of another size than the first.
Project static_project(const std::vector<std::string> &files, bool free_balance);

// Pairs of such pictures, `options.pairs` or 10000 a picture: values next to black and white count, too, for the ends
// of a response are where its modes fail. Up to the grey level `black` of 255 there is nothing.
std::vector<lensprof_pair> sample_still(const Project &project, std::vector<SamplePicture> &pictures,
                                        lensprof_sample_options options, double black, Progress &progress);

}  // namespace lensprof
