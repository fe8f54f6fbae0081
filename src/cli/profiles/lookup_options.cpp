#include "cli/profiles/lookup_options.hpp"

namespace lensprof {

void LookupOptions::add_keys(Keys keys) {
    keys.number("crop-factor", crop_factor, crop_factors,
                "43.27 mm divided by the sensor diagonal; default from the table of cameras");
    keys.choice("unknown-distance", distance_rule,
                {{"usual", LENSPROF_DISTANCE_USUAL},
                 {"weakest", LENSPROF_DISTANCE_WEAKEST},
                 {"farthest", LENSPROF_DISTANCE_FARTHEST}},
                "falloff if the focus distance is unknown: usual (default: the mean over common distances), weakest "
                "(of all stored distances, never overcorrects) or farthest (distance)");
    keys.flag("doubtful", doubtful,
              "also use profiles that were imported as doubtful; and, to correct pictures, predictions with an error "
              "above 0.1 in the corner and falloffs that no lens has");
}

lensprof_lookup_options LookupOptions::options() const {
    lensprof_lookup_options options;
    lensprof_lookup_options_init(&options);
    options.distance_rule = distance_rule;
    options.with_doubt = doubtful;
    return options;
}

}  // namespace lensprof
