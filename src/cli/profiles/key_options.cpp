#include "cli/profiles/key_options.hpp"

#include "cli/fitting/store_options.hpp"
#include "cli/program/key_texts.hpp"

namespace lensprof {

Keys declare_key_filter(Command &command, KeyFilter &filter) {
    command.text("--camera", filter.camera, "camera model");
    command.text("--lens", filter.lens, "lens model");
    command.number("--focal", filter.focal, focal_lengths, "focal length, mm, such as 50 or 50mm");
    command.number("--aperture", filter.aperture, f_numbers, "f-number, such as 4 or f/4");
    Keys keys = command.expert().keys("--key", "more about camera, lens and setting");
    keys.text("maker", filter.maker, "camera maker");
    keys.text("unit", filter.unit, "serial numbers of camera and lens, for profiles of a single unit");
    keys.number("distance", filter.distance, distances, "focus distance, m, such as 3 or 3m");
    keys.choice("processing", filter.processing, processing_choices(),
                "processing of the pictures: raw, jpeg or corrected (falloff corrected in camera)");
    keys.text("style", filter.style, "picture style, by the camera's name for it");
    return keys;
}

void declare_lookup(Keys keys, LookupOptions &o) {
    keys.number("crop-factor", o.crop_factor, crop_factors,
                "43.27 mm divided by the sensor diagonal; default from the table of cameras");
    keys.choice("unknown-distance", o.distance_rule,
                {{"usual", LENSPROF_DISTANCE_USUAL},
                 {"weakest", LENSPROF_DISTANCE_WEAKEST},
                 {"farthest", LENSPROF_DISTANCE_FARTHEST}},
                "falloff if the focus distance is unknown: usual (default: the mean over common distances), weakest "
                "(of all stored distances, never overcorrects) or farthest (distance)");
    keys.flag("doubtful", o.doubtful,
              "also use profiles that were imported as doubtful; and, to correct pictures, predictions with an error "
              "above 0.1 in the corner and falloffs that no lens has");
}

void check_names(const KeyFilter &filter) {
    require_text_sizes(filter.maker, filter.camera, filter.lens, filter.unit, filter.style);
}

}  // namespace lensprof
