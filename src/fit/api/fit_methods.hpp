// Runs the method that the options of a call name.
#pragma once

#include "fit/api/fit_call.hpp"
#include "fit/methods/cameras.hpp"

namespace lensprof {

bool has_unknowns(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t count);

lensprof_status fit_tracks(FitCall &call, const lensprof_observation *observations, uint32_t count,
                           lensprof_exposure *exposures, lensprof_error *error);

lensprof_status fit_pairs(FitCall &call, const lensprof_pair *pairs, uint32_t count, lensprof_exposure *exposures,
                          lensprof_error *error);

lensprof_status fit_each_camera(FitCall &call, const CamerasData &data, lensprof_exposure *exposures,
                                lensprof_error *error);

const char *name_of_method(uint32_t method);

}  // namespace lensprof
