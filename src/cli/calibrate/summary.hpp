// What calibrate found and wrote: for people in ten lines, for programs as an object.
#pragma once

#include "cli/calibrate/corrections.hpp"

namespace lensprof {

// docs/json.md, calibrate.json. The same after a run that found everything done.
Json summary_json(const CalibrateOptions &o, const Inputs &inputs, const Panoramas &panoramas,
                  const CorrectedPictures &pictures);

void print_summary(const CalibrateOptions &o, const Inputs &inputs, const Panoramas &panoramas,
                   const CorrectedPictures &pictures, std::ostream &out);

}  // namespace lensprof
