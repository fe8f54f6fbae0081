// A profile as a table.
#include <algorithm>

#include <nlohmann/json.hpp>

#include "cli/report/report.hpp"
#include "photo/base/format.hpp"
#include "photo/base/library.hpp"
#include "photo/pictures/picture_levels.hpp"

namespace lensprof {
namespace {

void print_gain_grid(const lensprof_gain_grid &grid, std::ostream &out) {
    if (!grid.columns) return;
    const float *end = grid.attenuation + grid.channels * grid.rows * grid.columns;
    const auto range = std::minmax_element(grid.attenuation, end);
    out << format("gain grid %u x %u nodes, %s; multiplies the falloff by %.3f to %.3f\n", grid.columns, grid.rows,
                  grid.channels == 3 ? "one grid per channel" : "all channels", double(*range.first),
                  double(*range.second));
}

void print_circle(const lensprof_image_circle &circle, std::ostream &out) {
    if (circle.radius == 0.0) return;
    out << format(
        "circle    image circle of r = %.3f about (%.3f, %.3f) of the middle; outside of it pictures are not "
        "corrected\n",
        circle.radius, circle.center[0], circle.center[1]);
}

}  // namespace

void print_levels(const lensprof_levels &levels, std::ostream &out) {
    if (!has_levels(levels)) return;
    out << format("levels    black %.4g, %.4g, %.4g %% (red, green, blue), white %.4g %% of full scale\n",
                  100.0 * levels.black[0], 100.0 * levels.black[1], 100.0 * levels.black[2],
                  levels.white > 0.0 ? 100.0 * levels.white : 100.0);
}

void print_profile(int64_t id, const lensprof_profile &profile, std::ostream &out) {
    const auto &p = profile.provenance;
    out << "profile   " << (id ? std::to_string(id) + ": " : std::string()) << describe_key(profile.key) << "\n";
    if (*profile.key.unit) out << "unit      " << profile.key.unit << " only\n";
    if (profile.key.color_temperature_k != LENSPROF_UNKNOWN)
        out << format("light     %g K\n", profile.key.color_temperature_k);
    if (*profile.key.style) out << "style     " << profile.key.style << "\n";
    print_vignettings(profile, out);
    print_gain_grid(profile.grid, out);
    print_levels(profile.levels, out);
    print_circle(profile.image_circle, out);
    for (uint32_t c = 0; c < profile.responses; c++) print_response(profile.response[c], out);
    out << "source    " << (*p.method ? p.method : "unknown method");
    if (p.prior_id) out << ", with profile " << p.prior_id << " as its prior";
    if (p.forced) out << ", stored with --force though not usable";
    out << ", " << p.images << " images, " << p.pairs << " pairs";
    if (p.heldout_rms != LENSPROF_UNKNOWN) out << format(", residual %.2f levels", p.heldout_rms);
    out << (*p.source ? std::string(", ") + p.source : std::string()) << "\n";
    if (*p.doubt) out << "doubt     " << p.doubt << "\n";
}

}  // namespace lensprof
