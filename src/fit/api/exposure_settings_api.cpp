// The C interface of exposures known from the settings of cameras.
#include <algorithm>
#include <cmath>

#include "fit/api/boundary.hpp"
#include "fit/prior/exposure_settings.hpp"

using namespace lensprof;

extern "C" {

double lensprof_settings_ev(double time_s, double f_number, double iso) {
    return std::log2(time_s * iso / 100 / (f_number * f_number));
}

lensprof_status lensprof_known_exposures(const lensprof_exposure_settings *settings, uint32_t count,
                                         lensprof_known_exposure *known, lensprof_error *error) {
    return at_boundary("known exposures", error, [&] {
        clear(error);
        if (count && (!settings || !known))
            return fail(LENSPROF_ERROR_ARGUMENT, error, "known exposures: a pointer is NULL");
        for (uint32_t i = 0; i < count; i++)
            if (settings[i].is_manual > 1 || settings[i].reserved)
                return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_ARGUMENT, error,
                               "is_manual must be 0 or 1, and reserved 0");
        const auto found = known_exposures({settings, settings + count});
        std::copy(found.begin(), found.end(), known);
        return LENSPROF_OK;
    });
}

}  // extern "C"
