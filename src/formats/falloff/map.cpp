#include "formats/falloff/map.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/profile.h"
#include "falloff/known_area.hpp"
#include "formats/text/text.hpp"

namespace lensprof {
namespace {

constexpr uint32_t kMaxSide = 65536;
constexpr uint32_t kKeptSide = 1024;  // larger maps are averaged down first: more resolution does not help a profile
constexpr double kMostHoles = 0.01;   // of the circle or frame that a map shows: dead pixels, not a covered part

[[noreturn]] void fail_at(uint32_t i, uint32_t j, const char *message, lensprof_status status) {
    throw FormatFailure{status, "value at column " + std::to_string(i) + ", row " + std::to_string(j) + " " + message};
}

// Attenuation of a value, 0 where it is not known.
double attenuation_of(float value, bool gain, uint32_t i, uint32_t j) {
    if (!std::isfinite(value)) fail_at(i, j, "is not finite; use 0 for unknown values", LENSPROF_ERROR_NOT_FINITE);
    if (value < 0.0f) fail_at(i, j, "is below 0; correct it, or give another map", LENSPROF_ERROR_ARGUMENT);
    return gain ? (value > 0.0f ? 1.0 / double(value) : 0.0) : double(value);
}

// Values that become one.
struct Block {
    uint32_t columns, rows;
};

// Sets a map's attenuations to the means over blocks of values, of those that are known.
void fill(const MapValues &form, const float *values, Block side, FalloffMap &map) {
    std::vector<double> sum(size_t(map.columns) * map.channels);
    std::vector<uint32_t> count(sum.size());
    map.attenuation.assign(size_t(map.columns) * map.rows * map.channels, 0.0);
    for (uint32_t j = 0; j < form.rows; j++) {
        const uint32_t row = j / side.rows;
        for (uint32_t i = 0; i < form.columns; i++)
            for (uint32_t c = 0; c < form.channels; c++) {
                const float value = values[(size_t(j) * form.columns + i) * form.channels + form.order[c]];
                const double attenuation = attenuation_of(value, form.gain, i, j);
                const uint32_t column = i / side.columns;
                if (attenuation == 0.0 || column >= map.columns || row >= map.rows) continue;
                sum[size_t(column) * form.channels + c] += attenuation;
                count[size_t(column) * form.channels + c]++;
            }
        if ((j + 1) % side.rows || row >= map.rows) continue;
        for (uint32_t i = 0; i < map.columns; i++)
            for (uint32_t c = 0; c < form.channels; c++) {
                const size_t index = size_t(i) * form.channels + c;
                if (count[index])
                    map.attenuation[(size_t(c) * map.rows + row) * map.columns + i] = sum[index] / count[index];
                sum[index] = 0.0, count[index] = 0;
            }
    }
}

// A picture shows nothing outside of a circle, so a falloff is not needed there; in a hole it would be guessed.
void check_holes(const KnownArea &known) {
    if (known.holes <= kMostHoles) return;
    char text[200];
    std::snprintf(text, sizeof text,
                  "%.1f %% of the frame has no data (0, or dark with an edge), not only outside of a circle; give a "
                  "map that covers the frame, or the circle of a fisheye, without holes",
                  100.0 * known.empty);
    throw FormatFailure{LENSPROF_ERROR_VIGNETTING, text};
}

}  // namespace

void check_frame(uint32_t width, uint32_t height) {
    if (width < 2 || height < 2 || width > kMaxSide || height > kMaxSide)
        throw FormatFailure{LENSPROF_ERROR_SIZE, std::to_string(width) + " x " + std::to_string(height)
                                                     + " values or pixels; give sides of 2 to 65536"};
}

void check_profile(const lensprof_profile &profile) {
    const lensprof_status status = lensprof_profile_validate(&profile);
    if (status != LENSPROF_OK)
        throw FormatFailure{status, std::string("the profile is invalid (") + lensprof_status_name(status)
                                        + "); see lensprof_profile_validate"};
}

double fit_values(const MapValues &form, const float *values, uint32_t width, uint32_t height,
                  lensprof_profile &profile) {
    check_frame(form.columns, form.rows);
    check_frame(width, height);
    const Block side{(form.columns + kKeptSide - 1) / kKeptSide, (form.rows + kKeptSide - 1) / kKeptSide};
    FalloffMap map{width, height, form.columns, form.rows, form.channels, 0, 0, 0, 0, {}};
    place_as_cells(map);
    map.columns = form.columns / side.columns, map.rows = form.rows / side.rows;
    map.x0 += map.dx * (side.columns - 1) / 2.0, map.y0 += map.dy * (side.rows - 1) / 2.0;
    map.dx *= side.columns, map.dy *= side.rows;
    fill(form, values, side, map);
    const KnownArea known = drop_surround(map);
    const double worst = fit_map(map, profile);
    check_holes(known);
    profile.image_circle = known.circle.value_or(lensprof_image_circle{});
    profile.covariance_size = 0;
    std::fill(std::begin(profile.covariance), std::end(profile.covariance), 0.0);
    return worst;
}

std::vector<double> attenuations_of(const lensprof_profile &profile, uint32_t width, uint32_t height, uint32_t columns,
                                    uint32_t rows, uint32_t channels) {
    FalloffMap map{width, height, columns, rows, channels, 0, 0, 0, 0, {}};
    place_as_cells(map);
    std::vector<double> &all = map.attenuation;
    all.reserve(size_t(columns) * rows * channels);
    for (uint32_t c = 0; c < channels; c++)
        for (uint32_t j = 0; j < rows; j++)
            for (uint32_t i = 0; i < columns; i++) {
                double sum = 0.0;
                for (uint32_t from = channels == 3 ? c : 0; from <= (channels == 3 ? c : 2); from++)
                    sum += lp_profile_continued_falloff(&profile, from, width, height, map.x0 + i * map.dx,
                                                        map.y0 + j * map.dy);
                all.push_back(channels == 3 ? sum : sum / 3.0);
            }
    const double largest = *std::max_element(all.begin(), all.end());
    for (double &value : all) value /= largest;
    return std::move(map.attenuation);
}

}  // namespace lensprof
