// The gains of a DNG opcode list (Adobe DNG specification, chapter 7): FixVignetteRadial and GainMap, in big-endian
// bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lensprof {

constexpr uint32_t kFixVignetteRadial = 3, kGainMap = 9;
constexpr uint32_t kDngVersion13 = 0x01030000;  // the first that has them
constexpr uint32_t kOpcodeOptional = 1;         // flag: a reader that does not know the opcode may go on

struct PixelFrame {
    uint32_t width, height;
};

// 1 + k0 r^2 + ... + k4 r^10; r = 1 at the corner farthest from the centre, which is in 0..1 of the frame.
struct RadialGain {
    std::array<double, 5> k;
    double center[2];
};

// Gains at evenly spaced points, origin and spacing in 0..1 of the frame, for every pitch-th pixel of a rectangle, from
// its first one, and for planes plane .. plane + planes - 1.
struct GainMap {
    uint32_t top, left, bottom, right, plane, planes, row_pitch, column_pitch;
    uint32_t rows, columns;
    double spacing[2], origin[2];  // vertical, horizontal
    uint32_t map_planes;
    std::vector<float> gains;  // [row][column][plane]
};

struct OpcodeGains {
    std::vector<RadialGain> radial;
    std::vector<GainMap> maps;
    std::string left_out;  // names of other opcodes, with commas
    uint32_t count;        // opcodes of the list, of any kind
};

// Throws SYNTAX for bytes that are not an opcode list, SIZE for over 64 gains or 1 Mi points in total, UNSUPPORTED for
// opcodes without a name in the specification that are not optional, and for gains after TrimBounds.
OpcodeGains parse_opcodes(const uint8_t *bytes, size_t size);

// Gain at a place of the frame, pixel centres at integers.
double radial_gain(const RadialGain &gain, const PixelFrame &frame, double x, double y);

// The gain of a map for a plane: bilinear, beyond the outermost points as at the nearest of them.
double map_gain(const GainMap &map, const PixelFrame &frame, double x, double y, uint32_t plane);

// Whether a lensprof_layout is a mosaic; and the channel of a site of its squares of 2 x 2 pixels.
bool is_mosaic(uint32_t layout);
uint32_t mosaic_channel(uint32_t layout, uint32_t column, uint32_t row);

// 1 for GREY, 3 for RGB and mosaics. Throws ARGUMENT for another layout.
uint32_t opcode_channels(uint32_t layout);

}  // namespace lensprof
