#include "formats/falloff/export.hpp"

namespace lensprof {

void demand_of_profile(bool holds, uint32_t index, const std::string &text, lensprof_status status) {
    if (!holds) throw failure_at(LENSPROF_ITEM_PROFILE, index, text, status);
}

void check_exported(const lensprof_profile &profile, uint32_t index, const std::string &format) {
    const auto demand = [&](bool holds, const std::string &text, lensprof_status status = LENSPROF_ERROR_ARGUMENT) {
        demand_of_profile(holds, index, text, status);
    };
    const lensprof_status status = lensprof_profile_validate(&profile);
    demand(status == LENSPROF_OK,
           std::string("is invalid (") + lensprof_status_name(status) + "); see lensprof_profile_validate", status);
    const lensprof_profile_key &key = profile.key;
    const std::string lens = key.lens;
    demand(!lens.empty(), "its lens is unknown; set key.lens");
    demand(find_not_utf8(lens) == lens.size(), "its lens " + in_quotes(lens) + " is not UTF-8; correct key.lens");
    demand(key.crop_factor != LENSPROF_UNKNOWN, "its crop factor is unknown; set key.crop_factor");
    demand(key.focal_mm != LENSPROF_UNKNOWN, "its focal length is unknown; set key.focal_mm");
    demand(key.aperture != LENSPROF_UNKNOWN, "its aperture is unknown; set key.aperture");
    demand(key.processing != LENSPROF_PROCESSING_CORRECTED,
           "is for pictures corrected in camera, which " + format + " does not correct; leave it out",
           LENSPROF_ERROR_UNSUPPORTED);
}

void check_no_grid(const lensprof_profile &profile, uint32_t index, const std::string &format) {
    demand_of_profile(profile.grid.columns == 0, index,
                      "has a gain grid, which " + format + " cannot hold; fit only a radial falloff",
                      LENSPROF_ERROR_UNSUPPORTED);
}

std::array<double, 3> mean_curve(const lensprof_profile &profile) {
    std::array<double, 3> mean{};
    for (int n = 0; n < 3; n++) {
        const double first = profile.vignetting[0].k[n];
        double excess = 0.0;
        for (uint32_t c = 1; c < profile.vignettings; c++) excess += profile.vignetting[c].k[n] - first;
        mean[n] = first + excess / profile.vignettings;
    }
    return mean;
}

}  // namespace lensprof
