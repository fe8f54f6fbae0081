// Maps in the caller's memory, such as the pixels of vignette.png.
#include <vector>

#include "formats/each_format.h"
#include "formats/falloff/map.hpp"
#include "formats/text/text.hpp"

using namespace lensprof;

lensprof_status lp_map_read(const lensprof_map *map, uint32_t width, uint32_t height, lensprof_profile *profile,
                            double *worst, lensprof_error *error) {
    if (!map || !map->values || !profile || (map->channels != 1 && map->channels != 3)
        || map->sense > LENSPROF_MAP_GAIN) {
        set_error(error,
                  "lensprof_import: give a map with values, of 1 or 3 channels and a known sense, and a profile");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return at_boundary(error, [&] {
        const MapValues form{map->columns, map->rows, map->channels, map->sense == LENSPROF_MAP_GAIN, {0, 1, 2}};
        double error_found = 0.0;
        change_profile(profile, [&](lensprof_profile &target) {
            error_found = fit_values(form, map->values, width, height, target);
        });
        if (worst) *worst = error_found;
    });
}

lensprof_status lensprof_map_write(const lensprof_profile *profile, uint32_t width, uint32_t height, uint32_t columns,
                                   uint32_t rows, uint32_t channels, uint32_t sense, float *values,
                                   lensprof_error *error) {
    if (!profile || !values || (channels != 1 && channels != 3) || sense > LENSPROF_MAP_GAIN) {
        set_error(error, "lensprof_map_write: give a profile, values, 1 or 3 channels and a known sense");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return at_boundary(error, [&] {
        check_profile(*profile);
        check_frame(width, height);
        check_frame(columns, rows);
        const std::vector<double> all = attenuations_of(*profile, width, height, columns, rows, channels);
        const size_t pixels = size_t(columns) * rows;
        for (size_t i = 0; i < pixels; i++)
            for (uint32_t c = 0; c < channels; c++) {
                const double attenuation = all[c * pixels + i];
                values[i * channels + c] =
                    static_cast<float>(sense == LENSPROF_MAP_GAIN ? 1.0 / attenuation : attenuation);
            }
    });
}
