// Settings in the names of files and folders, where EXIF does not state them.
#pragma once

#include <string>

#include <lensprof/profile.h>

namespace lensprof {

// What the names of a file and of its folders state: lens, focal length, aperture and distance; other fields are
// unknown.
//   Lens_name--35mm--2.8.CR2, Lens_name--35mm--2.8_IMG_1.CR2   as Lensfun's calibration scripts read: "_" is a blank,
//                                                              "__" a slash
//   35mm--2.8.CR2                                              the same of a lens that is stated elsewhere
//   vignetting_10, vignetting                                  folders of these scripts: the distance in m; infinity
//   2850K, alsc_3000k_0.dng                                    colour temperature of the light, as in names for
//   libcamera's
//                                                              tuning tool; a word of any name
//   24mm_f4_2.tif, f2.8/1.dng, 50mm/0.5m/card-3.tif            names of settings, numbers and words for a card alone;
//                                                              f01 is a number of a picture, as f/1 is not written so
// The innermost name that states a field counts.
lensprof_profile_key setting_of_names(const std::string &path);

}  // namespace lensprof
