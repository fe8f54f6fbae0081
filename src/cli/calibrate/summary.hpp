// Results of calibrate: a summary of about ten lines, and a JSON object.
#pragma once

#include "cli/calibrate/corrections.hpp"

namespace lensprof {

// See docs/json.md, calibrate.json. A run that found everything done gives the same object.
Json summary_json(const CalibrateOptions &o, const Inputs &inputs, const Panoramas &panoramas,
                  const CorrectedPictures &pictures);

// "img000 (5 pictures): profile 3 stored, relative illuminance in the corners 0.62 (-0.69 EV)", with a reason if there
// is one.
std::string panorama_line(const Panorama &panorama);

void print_summary(const CalibrateOptions &o, const Inputs &inputs, const Panoramas &panoramas,
                   const CorrectedPictures &pictures, std::ostream &out);

}  // namespace lensprof
