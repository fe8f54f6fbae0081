// Profiles to DNG opcode lists.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "formats/each_format.h"

#include "core/profile.h"
#include "falloff/map_fit.hpp"
#include "falloff/refit.hpp"
#include "formats/dng_opcodes.hpp"
#include "formats/falloff/radius.hpp"
#include "formats/text/text.hpp"

namespace lensprof {
namespace {

constexpr uint32_t kMaxPoints = 33;  // of a map, along the longer side of the frame
constexpr uint32_t kMinPoints = 9;   // along the shorter one
constexpr uint32_t kChecked = 131;   // places a side that the largest error is looked for at

void demand(bool holds, const std::string &text, lensprof_status status = LENSPROF_ERROR_ARGUMENT) {
    if (!holds) throw FormatFailure{status, text};
}

class OpcodeBytes {
public:
    void u32(uint32_t value) { put(value, 4); }

    void f64(double value) {
        uint64_t bits;
        std::memcpy(&bits, &value, sizeof bits);
        put(bits, 8);
    }

    void f32(float value) {
        uint32_t bits;
        std::memcpy(&bits, &value, sizeof bits);
        put(bits, 4);
    }

    void head(uint32_t id, size_t payload) {
        u32(id), u32(kDngVersion13), u32(kOpcodeOptional), u32(static_cast<uint32_t>(payload));
    }

    const std::vector<uint8_t> &all() const { return bytes_; }

private:
    void put(uint64_t value, int size) {
        while (size-- > 0) bytes_.push_back(static_cast<uint8_t>(value >> (8 * size)));
    }

    std::vector<uint8_t> bytes_;
};

void check_profile(const lensprof_profile &profile) {
    const lensprof_status status = lensprof_profile_validate(&profile);
    demand(status == LENSPROF_OK,
           std::string("the profile is invalid (") + lensprof_status_name(status) + "); see lensprof_profile_validate",
           status);
    demand(profile.key.processing != LENSPROF_PROCESSING_CORRECTED,
           "the profile is for pictures corrected in camera, but opcodes apply to raw pictures; give another",
           LENSPROF_ERROR_UNSUPPORTED);
}

// The gain in its own polynomial, by least squares of its relative error. Returns the largest one.
double write_radial(const lensprof_profile &profile, PixelFrame frame, OpcodeBytes &bytes) {
    demand(profile.vignettings == 1, "the profile has a falloff per channel, FixVignetteRadial only one; write GainMap",
           LENSPROF_ERROR_UNSUPPORTED);
    demand(profile.grid.columns == 0, "the profile has a gain grid, but FixVignetteRadial is radial; write GainMap",
           LENSPROF_ERROR_UNSUPPORTED);
    const lensprof_vignetting &v = profile.vignetting[0];
    const double sides[2] = {double(frame.width), double(frame.height)};
    const double rho = lensprof_half_diagonal(frame.width, frame.height);
    double center[2];
    for (int axis = 0; axis < 2; axis++) {
        center[axis] = 0.5 + v.center[axis] * rho / sides[axis];
        demand(center[axis] >= 0.0 && center[axis] <= 1.0, "a centre outside the frame; write GainMap",
               LENSPROF_ERROR_UNSUPPORTED);
    }
    const double reach = farthest_corner(v.center, frame.width, frame.height);
    const EvenRefit refit =
        refit_even([&](double t) { return 1.0 / lensprof_vignetting_eval(&v, t * reach * reach, nullptr); }, 5);
    bytes.u32(1);
    bytes.head(kFixVignetteRadial, 56);
    for (double k : refit.terms) bytes.f64(k);
    for (double c : center) bytes.f64(c);
    return refit.worst;
}

// A map without gains, which reaches all of the frame's pixels.
GainMap whole_map(PixelFrame frame, uint32_t planes) {
    const double longer = std::max(frame.width, frame.height);
    const auto points = [&](uint32_t side) {
        return std::max(kMinPoints, static_cast<uint32_t>(std::lround((kMaxPoints - 1) * (side / longer))) + 1);
    };
    GainMap map{};
    map.bottom = frame.height, map.right = frame.width;
    map.planes = map.map_planes = planes;
    map.row_pitch = map.column_pitch = 1;
    map.rows = points(frame.height), map.columns = points(frame.width);
    map.spacing[0] = 1.0 / (map.rows - 1), map.spacing[1] = 1.0 / (map.columns - 1);
    return map;
}

// Gains of channels first .. first + map_planes - 1. Between points a reader draws straight lines, which lie outside a
// curve by up to its second difference over 8 in each direction: half of that is taken off the points, so that the
// errors there and between are the same.
void fill_gains(const lensprof_profile &profile, PixelFrame frame, uint32_t first, GainMap &map) {
    std::vector<double> exact(size_t(map.rows) * map.columns);
    map.gains.resize(exact.size() * map.map_planes);
    const auto entry = [&](uint32_t row, uint32_t column) -> double & {
        return exact[size_t(row) * map.columns + column];
    };
    for (uint32_t plane = 0; plane < map.map_planes; plane++) {
        for (uint32_t j = 0; j < map.rows; j++)
            for (uint32_t i = 0; i < map.columns; i++) {
                const double x = i * map.spacing[1] * frame.width - 0.5, y = j * map.spacing[0] * frame.height - 0.5;
                entry(j, i) =
                    1.0 / lp_profile_continued_falloff(&profile, first + plane, frame.width, frame.height, x, y);
            }
        for (uint32_t j = 0; j < map.rows; j++)
            for (uint32_t i = 0; i < map.columns; i++) {
                const uint32_t jj = std::clamp(j, 1u, map.rows - 2), ii = std::clamp(i, 1u, map.columns - 2);
                const double bend = entry(jj - 1, i) - 2.0 * entry(jj, i)
                                    + entry(jj + 1, i)  // of the nearest inner point
                                    + entry(j, ii - 1) - 2.0 * entry(j, ii) + entry(j, ii + 1);
                map.gains[(size_t(j) * map.columns + i) * map.map_planes + plane] =
                    static_cast<float>(std::max(entry(j, i) - bend / 16.0, entry(j, i) / 2.0));
            }
    }
}

double worst_error(const lensprof_profile &profile, PixelFrame frame, uint32_t first, const GainMap &map) {
    double worst = 0.0;
    for (uint32_t plane = 0; plane < map.map_planes; plane++)
        for (uint32_t j = 0; j < kChecked; j++)
            for (uint32_t i = 0; i < kChecked; i++) {
                const double x = i * (frame.width - 1.0) / (kChecked - 1),
                             y = j * (frame.height - 1.0) / (kChecked - 1);
                const double m = lp_profile_continued_falloff(&profile, first + plane, frame.width, frame.height, x, y);
                worst = std::max(worst, std::fabs(map_gain(map, frame, x, y, plane) * m - 1.0));
            }
    return worst;
}

void append_map(const GainMap &map, OpcodeBytes &bytes) {
    bytes.head(kGainMap, 76 + 4 * map.gains.size());
    for (uint32_t value : {map.top, map.left, map.bottom, map.right, map.plane, map.planes, map.row_pitch,
                           map.column_pitch, map.rows, map.columns})
        bytes.u32(value);
    for (double value : {map.spacing[0], map.spacing[1], map.origin[0], map.origin[1]}) bytes.f64(value);
    bytes.u32(map.map_planes);
    for (float gain : map.gains) bytes.f32(gain);
}

// One map for all planes, or four for the pixels of a mosaic whose channels differ. Returns the largest error.
double write_maps(const lensprof_profile &profile, PixelFrame frame, uint32_t layout, OpcodeBytes &bytes) {
    const uint32_t channels = opcode_channels(layout);
    const bool differ = channels == 3 && (profile.vignettings == 3 || profile.grid.channels == 3);
    demand(channels == 3 || (profile.vignettings == 1 && profile.grid.channels <= 1),
           "a falloff per channel for pictures with one channel; pass the layout RGB or that of a mosaic",
           LENSPROF_ERROR_UNSUPPORTED);
    if (!differ || !is_mosaic(layout)) {
        GainMap map = whole_map(frame, differ ? 3 : 1);
        fill_gains(profile, frame, 0, map);
        map.planes = is_mosaic(layout) ? 1 : channels;
        bytes.u32(1);
        append_map(map, bytes);
        return worst_error(profile, frame, 0, map);
    }
    bytes.u32(4);
    double worst = 0.0;
    for (uint32_t row = 0; row < 2; row++)
        for (uint32_t column = 0; column < 2; column++) {
            const uint32_t channel = mosaic_channel(layout, column, row);
            GainMap map = whole_map(frame, 1);
            map.top = row, map.left = column, map.row_pitch = map.column_pitch = 2;
            fill_gains(profile, frame, channel, map);
            append_map(map, bytes);
            worst = std::max(worst, worst_error(profile, frame, channel, map));
        }
    return worst;
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

lensprof_status lp_dng_opcodes_write(const lensprof_profile *profile, uint32_t width, uint32_t height, uint32_t layout,
                                     uint32_t form, void *data, size_t capacity, size_t *count, double *worst,
                                     lensprof_error *error) {
    if (!profile || (!data && capacity)) {
        set_error(error, "lensprof_export: profile or data is NULL; pass a profile and a buffer");
        return LENSPROF_ERROR_ARGUMENT;
    }
    OpcodeBytes list;
    double found = 0.0;
    const lensprof_status status = at_boundary(error, [&] {
        demand(form == LENSPROF_DNG_RADIAL || form == LENSPROF_DNG_GAIN_MAP, "unknown form; pass a lensprof_dng_form");
        demand(width && height, "a frame without pixels; pass its width and height");
        opcode_channels(layout);
        check_profile(*profile);
        const PixelFrame frame{width, height};
        found = form == LENSPROF_DNG_RADIAL ? write_radial(*profile, frame, list)
                                            : write_maps(*profile, frame, layout, list);
    });
    if (status != LENSPROF_OK) return status;
    if (worst) *worst = found;
    const std::string_view bytes = view_of(list.all().data(), list.all().size());
    return copy_bytes(bytes, data, std::min(capacity, bytes.size()), count, error);  // no terminator
}
