// Results of calibrate: a summary of about ten lines.
#pragma once

#include <ostream>

#include "photo/folder/calibrate_folder.hpp"

namespace lensprof {

// "img000 (5 pictures): profile 3 stored, relative illuminance in the corners 0.62 (-0.69 EV)", with a reason if there
// is one.
std::string panorama_line(const Panorama &panorama);

void print_summary(const FolderOptions &o, const Inputs &inputs, const Panoramas &panoramas,
                   const CorrectedPictures &pictures, std::ostream &out);

}  // namespace lensprof
