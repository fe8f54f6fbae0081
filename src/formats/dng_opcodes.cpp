#include "formats/dng_opcodes.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <lensprof/apply.h>

#include "formats/text/text.hpp"

namespace lensprof {
namespace {

constexpr uint32_t kTrimBounds = 6;
constexpr size_t kMaxGains = 64;
constexpr uint64_t kMaxPoints = 1u << 20;
constexpr const char *kNames[] = {nullptr,
                                  "WarpRectilinear",
                                  "WarpFisheye",
                                  "FixVignetteRadial",
                                  "FixBadPixelsConstant",
                                  "FixBadPixelsList",
                                  "TrimBounds",
                                  "MapTable",
                                  "MapPolynomial",
                                  "GainMap",
                                  "DeltaPerRow",
                                  "DeltaPerColumn",
                                  "ScalePerRow",
                                  "ScalePerColumn",
                                  "WarpRectilinear2"};

// Numbers of a range of bytes, which are checked to be there.
class BigEndian {
public:
    BigEndian(const uint8_t *bytes, size_t size) : data_(bytes), left_(size) {}

    size_t left() const { return left_; }

    uint32_t u32(const char *item) { return static_cast<uint32_t>(take(4, item)); }

    double f64(const char *item) {
        const uint64_t bits = take(8, item);
        double value;
        std::memcpy(&value, &bits, sizeof value);
        return finite(value, item);
    }

    float f32(const char *item) {
        const uint32_t bits = u32(item);
        float value;
        std::memcpy(&value, &bits, sizeof value);
        return static_cast<float>(finite(value, item));
    }

    BigEndian part(size_t size, const char *item) {
        demand(size, item);
        BigEndian result(data_, size);
        data_ += size, left_ -= size;
        return result;
    }

private:
    void demand(size_t size, const char *item) const {
        if (size > left_)
            throw FormatFailure{LENSPROF_ERROR_SYNTAX, std::string("ends within ") + item + "; give the whole list"};
    }

    uint64_t take(size_t size, const char *item) {
        demand(size, item);
        uint64_t value = 0;
        for (size_t i = 0; i < size; i++) value = value << 8 | data_[i];
        data_ += size, left_ -= size;
        return value;
    }

    static double finite(double value, const char *item) {
        if (!std::isfinite(value))
            throw FormatFailure{LENSPROF_ERROR_SYNTAX, std::string(item) + " is not finite; correct it"};
        return value;
    }

    const uint8_t *data_;
    size_t left_;
};

void demand(bool holds, const char *text, lensprof_status status = LENSPROF_ERROR_SYNTAX) {
    if (!holds) throw FormatFailure{status, text};
}

RadialGain read_radial(BigEndian payload) {
    RadialGain gain{};
    for (double &k : gain.k) k = payload.f64("its coefficients");
    for (double &c : gain.center) {
        c = payload.f64("its centre");
        demand(c >= 0.0 && c <= 1.0, "its centre is outside the frame; correct it");
    }
    demand(payload.left() == 0, "bytes after its 7 numbers; correct its size");
    return gain;
}

GainMap read_map(BigEndian payload, uint64_t &points_left) {
    GainMap map{};
    for (uint32_t *field : {&map.top, &map.left, &map.bottom, &map.right, &map.plane, &map.planes, &map.row_pitch,
                            &map.column_pitch, &map.rows, &map.columns})
        *field = payload.u32("its area");
    for (double *field : {&map.spacing[0], &map.spacing[1], &map.origin[0], &map.origin[1]})
        *field = payload.f64("its spacing and origin");
    map.map_planes = payload.u32("its planes");
    demand(map.planes && map.row_pitch && map.column_pitch, "planes or pitch is 0; correct it");
    demand(map.rows && map.columns && map.map_planes, "a map without points; correct it");
    demand((map.rows == 1 || map.spacing[0] > 0.0) && (map.columns == 1 || map.spacing[1] > 0.0),
           "a spacing that is not above 0; correct it");
    uint64_t points = 1;
    for (uint32_t side : {map.rows, map.columns, map.map_planes}) {
        demand(side <= points_left && points * side <= points_left, "over 1 Mi points in total; leave maps out",
               LENSPROF_ERROR_SIZE);
        points *= side;
    }
    demand(payload.left() == 4 * points, "the number of gains differs from that of points; correct it");
    points_left -= points;
    map.gains.resize(points);
    for (float &gain : map.gains) gain = payload.f32("a gain");
    return map;
}

// One opcode of the list, from its id on.
class ListReader {
public:
    ListReader(const uint8_t *bytes, size_t size) : bytes_(bytes, size) {}

    OpcodeGains read() {
        gains_.count = bytes_.u32("the number of opcodes");
        demand(gains_.count <= bytes_.left() / 16, "fewer bytes than its opcodes need; give the whole list");
        for (uint32_t i = 0; i < gains_.count; i++) {
            try {
                read_opcode();
            } catch (FormatFailure &failure) {
                failure.text = "opcode " + std::to_string(i) + name_ + ": " + failure.text;
                throw;
            }
        }
        demand(bytes_.left() == 0, "bytes after the last opcode; give only the list");
        return std::move(gains_);
    }

private:
    void read_opcode() {
        name_.clear();
        const uint32_t id = bytes_.u32("its head");
        bytes_.u32("its head");  // the version of DNG that has it
        const uint32_t flags = bytes_.u32("its head"), size = bytes_.u32("its head");
        const bool known = id > 0 && id < std::size(kNames);
        const std::string name = known ? kNames[id] : "id " + std::to_string(id);
        name_ = " (" + name + ")";
        const BigEndian payload = bytes_.part(size, "its payload");
        demand(known || (flags & kOpcodeOptional), "not in DNG 1.7, and not optional; use a program that supports it",
               LENSPROF_ERROR_UNSUPPORTED);
        const bool gain = id == kFixVignetteRadial || id == kGainMap;
        demand(!gain || !trimmed_, "a gain after TrimBounds, which lensprof does not support; remove it",
               LENSPROF_ERROR_UNSUPPORTED);
        demand(!gain || gains_.radial.size() + gains_.maps.size() < kMaxGains, "over 64 gains; leave some out",
               LENSPROF_ERROR_SIZE);
        if (id == kFixVignetteRadial)
            gains_.radial.push_back(read_radial(payload));
        else if (id == kGainMap)
            gains_.maps.push_back(read_map(payload, points_left_));
        else if (gains_.left_out.size() < 200)
            gains_.left_out += (gains_.left_out.empty() ? "" : ", ") + name;
        trimmed_ = trimmed_ || id == kTrimBounds;
    }

    BigEndian bytes_;
    OpcodeGains gains_{};
    std::string name_;
    uint64_t points_left_ = kMaxPoints;
    bool trimmed_ = false;
};

// Where a place lies between the points of one direction: of the lower one, and the share of the upper one.
struct Between {
    size_t low, high;
    double share;
};
Between between(double place, double side, double origin, double spacing, uint32_t count) {
    const double index = count == 1 ? 0.0 : ((place + 0.5) / side - origin) / spacing;
    const double inside = std::clamp(index, 0.0, count - 1.0);
    const size_t low = std::min(static_cast<size_t>(inside), size_t(count) - 1);
    return {low, std::min(low + 1, size_t(count) - 1), inside - double(low)};
}

}  // namespace

OpcodeGains parse_opcodes(const uint8_t *bytes, size_t size) { return ListReader(bytes, size).read(); }

double radial_gain(const RadialGain &gain, const PixelFrame &frame, double x, double y) {
    const double cx = gain.center[0] * frame.width, cy = gain.center[1] * frame.height;
    const double far_x = std::max(cx, frame.width - cx), far_y = std::max(cy, frame.height - cy);
    const double dx = x + 0.5 - cx, dy = y + 0.5 - cy;
    const double r2 = (dx * dx + dy * dy) / (far_x * far_x + far_y * far_y);
    double sum = 0.0;
    for (size_t n = gain.k.size(); n-- > 0;) sum = (sum + gain.k[n]) * r2;
    return 1.0 + sum;
}

double map_gain(const GainMap &map, const PixelFrame &frame, double x, double y, uint32_t plane) {
    const Between down = between(y, frame.height, map.origin[0], map.spacing[0], map.rows),
                  across = between(x, frame.width, map.origin[1], map.spacing[1], map.columns);
    const uint32_t used = std::min(plane, map.map_planes - 1);
    const auto node_value = [&](size_t row, size_t column) -> double {
        return map.gains[(row * map.columns + column) * map.map_planes + used];
    };
    const auto along = [&](size_t row) {
        return node_value(row, across.low)
               + across.share * (node_value(row, across.high) - node_value(row, across.low));
    };
    return along(down.low) + down.share * (along(down.high) - along(down.low));
}

bool is_mosaic(uint32_t layout) { return layout >= LENSPROF_LAYOUT_RGGB && layout <= LENSPROF_LAYOUT_BGGR; }

uint32_t mosaic_channel(uint32_t layout, uint32_t column, uint32_t row) {
    const uint32_t red_column = layout == LENSPROF_LAYOUT_GRBG || layout == LENSPROF_LAYOUT_BGGR,
                   red_row = layout == LENSPROF_LAYOUT_GBRG || layout == LENSPROF_LAYOUT_BGGR;
    return (column != red_column) + (row != red_row);
}

uint32_t opcode_channels(uint32_t layout) {
    if (layout == LENSPROF_LAYOUT_GREY) return 1;
    demand(layout == LENSPROF_LAYOUT_RGB || is_mosaic(layout),
           "the layout is not one of raw pictures; pass GREY, RGB or that of a mosaic", LENSPROF_ERROR_ARGUMENT);
    return 3;
}

}  // namespace lensprof
