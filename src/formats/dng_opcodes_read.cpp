// DNG opcode lists to profiles.
#include <algorithm>
#include <cmath>
#include <memory>

#include "formats/each_format.h"

#include "falloff/map_fit.hpp"
#include "falloff/refit.hpp"
#include "formats/dng_opcodes.hpp"
#include "formats/falloff/import.hpp"
#include "formats/falloff/radius.hpp"
#include "formats/text/text.hpp"

namespace lensprof {
namespace {

constexpr double kSame = 1e-6;  // relative; a map's gains are in single precision

[[noreturn]] void fail(lensprof_status status, const std::string &text) { throw FormatFailure{status, text}; }

double positive(double gain) {
    if (!(gain > 0.0) || !std::isfinite(gain))
        fail(LENSPROF_ERROR_VIGNETTING, "a gain that is not above 0 within the frame; correct the opcodes");
    return gain;
}

// The opcodes over a frame of one layout.
class GainField {
public:
    GainField(const OpcodeGains &gains, PixelFrame frame, uint32_t layout)
        : gains_(gains), frame_(frame), layout_(layout) {
        for (const GainMap &map : gains.maps)
            if (is_mosaic(layout) ? bad_pitch(map.row_pitch) || bad_pitch(map.column_pitch)
                                  : map.row_pitch != 1 || map.column_pitch != 1)
                fail(LENSPROF_ERROR_UNSUPPORTED, "a GainMap of every "
                                                     + std::to_string(std::max(map.row_pitch, map.column_pitch))
                                                     + "th pixel; pass the layout of the mosaic");
    }

    // Of a channel, at a place between the pixels' centres too; of the two greens of a mosaic, their mean.
    double attenuation(double x, double y, uint32_t channel) const {
        double radial = 1.0;
        for (const RadialGain &gain : gains_.radial) radial *= positive(radial_gain(gain, frame_, x, y));
        if (!is_mosaic(layout_)) return 1.0 / positive(radial * maps_gain(x, y, channel, 0, 0));
        double sum = 0.0, count = 0.0;
        for (uint32_t row = 0; row < 2; row++)
            for (uint32_t column = 0; column < 2; column++)
                if (mosaic_channel(layout_, column, row) == channel)
                    sum += 1.0 / positive(radial * maps_gain(x, y, 0, column, row)), count += 1.0;
        return sum / count;
    }

private:
    static bool bad_pitch(uint32_t pitch) { return pitch != 1 && pitch != 2; }

    // Of the maps that reach this plane and, in a mosaic, the pixels of this column and row of its squares.
    double maps_gain(double x, double y, uint32_t plane, uint32_t column, uint32_t row) const {
        double gain = 1.0;
        for (const GainMap &map : gains_.maps) {
            const bool plane_in = plane >= map.plane && plane - map.plane < map.planes;
            const bool site_in = (row + map.top) % map.row_pitch == 0 && (column + map.left) % map.column_pitch == 0;
            // A pixel of the square, or of the plane, nearest to the place.
            const bool inside = y >= map.top - (map.row_pitch - 0.5) && y < map.bottom + (map.row_pitch - 1.5)
                                && x >= map.left - (map.column_pitch - 0.5) && x < map.right + (map.column_pitch - 1.5);
            if (plane_in && site_in && inside) gain *= map_gain(map, frame_, x, y, plane);
        }
        return gain;
    }

    const OpcodeGains &gains_;
    PixelFrame frame_;
    uint32_t layout_;
};

bool one_center(const std::vector<RadialGain> &radial) {
    return std::all_of(radial.begin(), radial.end(), [&](const RadialGain &gain) {
        return gain.center[0] == radial[0].center[0] && gain.center[1] == radial[0].center[1];
    });
}

// Gains about one centre. Returns the largest relative error.
double fit_radial(const std::vector<RadialGain> &radial, PixelFrame frame, lensprof_profile &profile) {
    const double sides[2] = {double(frame.width), double(frame.height)};
    const double rho = lensprof_half_diagonal(frame.width, frame.height);
    lensprof_vignetting &v = profile.vignetting[0];
    for (int axis = 0; axis < 2; axis++) v.center[axis] = (radial[0].center[axis] - 0.5) * sides[axis] / rho;
    const double reach = farthest_corner(v.center, frame.width, frame.height);
    const auto attenuation = [&](double r2) {
        double product = 1.0;
        for (const RadialGain &gain : radial) {
            const double along = std::sqrt(r2) * rho;  // px to the right of the centre
            product *= positive(
                radial_gain(gain, frame, gain.center[0] * sides[0] - 0.5 + along, gain.center[1] * sides[1] - 0.5));
        }
        return 1.0 / product;
    };
    const RadialRefit refit = refit_radial(attenuation, reach);
    std::copy(refit.k.begin(), refit.k.end(), v.k);
    return refit.worst;
}

double fit_field(const GainField &field, PixelFrame frame, uint32_t channels, lensprof_profile &profile) {
    FalloffMap map = sampled_map(frame.width, frame.height, channels, [&](double x, double y, uint32_t channel) {
        return field.attenuation(x, y, channel);
    });
    const size_t size = size_t(map.columns) * map.rows;
    bool same = true;
    for (size_t i = size; i < map.attenuation.size(); i++)
        same = same && std::fabs(map.attenuation[i] / map.attenuation[i % size] - 1.0) <= kSame;
    if (same) map.channels = 1, map.attenuation.resize(size);
    return fit_map(map, profile);
}

std::string remark_on(double worst, const std::string &left_out) {
    const std::string refit = refit_remark(worst);
    if (left_out.empty()) return refit;
    return refit.empty() ? "left out: " + left_out : refit + "; left out: " + left_out;
}

// Returns the text for provenance.doubt.
std::string read_gains(const OpcodeGains &gains, PixelFrame frame, uint32_t layout, lensprof_profile &profile) {
    const uint32_t channels = opcode_channels(layout);
    if (!frame.width || !frame.height)
        fail(LENSPROF_ERROR_ARGUMENT, "a frame without pixels; pass its width and height");
    if (gains.radial.empty() && gains.maps.empty())
        fail(LENSPROF_ERROR_NOT_FOUND, "no FixVignetteRadial and no GainMap among " + std::to_string(gains.count)
                                           + " opcodes" + (gains.left_out.empty() ? "" : " (" + gains.left_out + ")")
                                           + "; give the list that contains one");
    profile.key.processing = LENSPROF_PROCESSING_RAW;
    const GainField field(gains, frame, layout);
    const double worst = gains.maps.empty() && one_center(gains.radial) ? fit_radial(gains.radial, frame, profile)
                                                                        : fit_field(field, frame, channels, profile);
    return remark_on(worst, gains.left_out);
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

lensprof_status lp_dng_opcodes_read(const void *data, size_t size, uint32_t width, uint32_t height, uint32_t layout,
                                    const char *source, lensprof_import_visitor visit, void *user,
                                    lensprof_error *error) {
    if ((!data && size) || !visit) {
        set_error(error, "lensprof_import: data or visit is NULL; pass a buffer and a function");
        return LENSPROF_ERROR_ARGUMENT;
    }
    lensprof_status visited = LENSPROF_OK;
    const lensprof_status status = at_boundary(error, [&] {
        const auto profile = std::make_unique<lensprof_profile>();
        lensprof_profile_init(profile.get());
        set_import_provenance(*profile, source, "DNG opcodes");
        const OpcodeGains gains = parse_opcodes(static_cast<const uint8_t *>(data), size);
        const std::string remark = read_gains(gains, {width, height}, layout, *profile);
        visited = visit_entry(*profile, remark, visit, user);
    });
    return status == LENSPROF_OK ? visited : status;
}
