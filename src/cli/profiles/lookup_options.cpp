#include "cli/profiles/lookup_options.hpp"

namespace lensprof {

void LookupOptions::add_options(Command &command) {
    command.number("--crop-factor", crop_factor, crop_factors, "43.27 mm over the diagonal of the camera's sensor");
    command.choice(
        "--unknown-distance", distance_rule,
        {{"usual", LENSPROF_DISTANCE_USUAL},
         {"weakest", LENSPROF_DISTANCE_WEAKEST},
         {"farthest", LENSPROF_DISTANCE_FARTHEST}},
        "where the distance is not known: usual, the mean falloff over the distances of most photographs "
        "(default); weakest, the weakest of all stored distances, which never corrects too much; or farthest");
    command.flag("--doubtful", doubtful, "predict also from profiles that were imported with a doubt");
}

lensprof_lookup_options LookupOptions::options() const {
    lensprof_lookup_options options;
    lensprof_lookup_options_init(&options);
    options.distance_rule = distance_rule;
    options.with_doubt = doubtful;
    return options;
}

}  // namespace lensprof
