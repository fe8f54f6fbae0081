// Argument checks of the overlap fit. Each returns LENSPROF_OK, or fills the error and returns its status.
#pragma once

#include <vector>

#include <lensprof/fit.h>

#include "fit/problem/tracks.hpp"

namespace lensprof {

lensprof_status check_options(const lensprof_fit_options &o, uint32_t image_count, lensprof_error *error);

lensprof_status check_images(const lensprof_fit_image *images, uint32_t count, lensprof_error *error);

// Checks that every setting belongs to one camera.
lensprof_status check_cameras(const std::vector<lensprof_fit_image> &images, lensprof_error *error);

lensprof_status check_pairs(const lensprof_pair *pairs, uint32_t count, const lensprof_fit_image *images,
                            uint32_t image_count, int channels, lensprof_error *error);

// Checks what the options hold per pair.
lensprof_status check_scene(const lensprof_fit_options &o, uint32_t pair_count, lensprof_error *error);

lensprof_status check_observations(const lensprof_observation *observations, uint32_t count,
                                   const lensprof_fit_image *images, uint32_t image_count, int channels,
                                   lensprof_error *error);

lensprof_status check_tracks(const Tracks &tracks, lensprof_error *error);

lensprof_status check_model(const lensprof_response &response, const lensprof_vignetting *vignetting, uint32_t channels,
                            const lensprof_exposure *exposures, uint32_t image_count, lensprof_error *error);

}  // namespace lensprof
