// ICC.1:2010: the header has 128 bytes, then the count of tags and for each its name, offset and size; all numbers are
// big-endian. A curve is of type `curv` (10.5: no entry, one u8Fixed8 exponent, or samples of 16 bit) or `para` (10.15:
// function 0 is Y = X^g; the others are Y = (aX + b)^g + e from X = d on and cX + f before, of which they state a
// part).
#include "photo/pictures/icc.hpp"

#include <cmath>
#include <cstring>
#include <functional>
#include <initializer_list>
#include <utility>

namespace lensprof {
namespace {

constexpr double kLinear = 0.002;  // of an exponent, or of a sample of full scale

struct Bytes {
    const uint8_t *data;
    size_t count;

    bool has(size_t offset, size_t size) const { return offset <= count && size <= count - offset; }
    uint32_t u16(size_t offset) const { return uint32_t(data[offset]) << 8 | data[offset + 1]; }
    uint32_t u32(size_t offset) const { return u16(offset) << 16 | u16(offset + 2); }
    bool is(size_t offset, const char *name) const { return !std::memcmp(data + offset, name, 4); }
};

ToneCurve linear_or_other(bool is_linear) { return is_linear ? ToneCurve::linear : ToneCurve::other; }

ToneCurve of_samples(const Bytes &curve) {
    if (!curve.has(8, 4)) return ToneCurve::unknown;
    const size_t entries = curve.u32(8);
    if (entries > curve.count || !curve.has(12, 2 * entries)) return ToneCurve::unknown;
    if (entries == 0) return ToneCurve::linear;
    if (entries == 1) return linear_or_other(std::fabs(curve.u16(12) / 256.0 - 1.0) < kLinear);
    for (size_t i = 0; i < entries; i++) {
        const double x = double(i) / double(entries - 1), y = curve.u16(12 + 2 * i) / 65535.0;
        if (std::fabs(y - x) > kLinear) return ToneCurve::other;
    }
    return ToneCurve::linear;
}

ToneCurve of_function(const Bytes &curve) {
    if (!curve.has(8, 8)) return ToneCurve::unknown;
    static const size_t counts[] = {1, 3, 4, 5, 7};
    const size_t function = curve.u16(8);
    if (function >= 5 || !curve.has(12, 4 * counts[function])) return ToneCurve::unknown;
    double p[7] = {1.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0};  // g a b c d e f
    for (size_t i = 0; i < counts[function]; i++) p[i] = double(static_cast<int32_t>(curve.u32(12 + 4 * i))) / 65536.0;
    if (function == 2) p[5] = p[6] = p[3];
    if (function == 1 || function == 2) p[3] = 0.0, p[4] = p[1] != 0.0 ? -p[2] / p[1] : 2.0;
    for (int i = 0; i <= 32; i++) {
        const double x = i / 32.0,
                     y = x >= p[4] ? std::pow(std::fmax(p[1] * x + p[2], 0.0), p[0]) + p[5] : p[3] * x + p[6];
        if (!(std::fabs(y - x) < kLinear)) return ToneCurve::other;
    }
    return ToneCurve::linear;
}

ToneCurve of_curve(const Bytes &curve) {
    if (!curve.has(0, 12)) return ToneCurve::unknown;
    return curve.is(0, "curv") ? of_samples(curve) : curve.is(0, "para") ? of_function(curve) : ToneCurve::unknown;
}

bool is_tone_curve(const Bytes &profile, size_t tag) {
    for (const char *name : {"rTRC", "gTRC", "bTRC", "kTRC"})
        if (profile.is(tag, name)) return true;
    return false;
}

class ProfileBytes {
public:
    void put(uint32_t value, size_t size = 4) {
        for (size_t i = size; i-- > 0;) bytes_.push_back(static_cast<uint8_t>(value >> 8 * i));
    }
    void text(const char *name) { bytes_.insert(bytes_.end(), name, name + std::strlen(name)); }
    void xyz(double x, double y, double z) {
        for (double v : {x, y, z}) put(static_cast<uint32_t>(std::lround(65536.0 * v)));
    }
    void fill_to(size_t size) { bytes_.resize(size); }
    void append(const std::vector<uint8_t> &more) { bytes_.insert(bytes_.end(), more.begin(), more.end()); }
    const std::vector<uint8_t> &bytes() const { return bytes_; }

private:
    std::vector<uint8_t> bytes_;
};

// 6.5: a tag's data begins with its type and four zeros, and has a multiple of four bytes.
std::vector<uint8_t> tag_data(const char *type, const std::function<void(ProfileBytes &)> &write) {
    ProfileBytes data;
    data.text(type);
    data.put(0);
    write(data);
    data.fill_to((data.bytes().size() + 3) / 4 * 4);
    return data.bytes();
}

// Version 2.4's textDescriptionType: the ASCII text; no Unicode, no Macintosh text.
std::vector<uint8_t> description(const char *text) {
    return tag_data("desc", [&](ProfileBytes &data) {
        data.put(static_cast<uint32_t>(std::strlen(text) + 1));
        data.text(text);
        data.put(0, 1);
        data.fill_to(data.bytes().size() + 8 + 3 + 67);
    });
}

}  // namespace

std::vector<uint8_t> linear_profile(bool grey) {
    const auto xyz = [](double x, double y, double z) {
        return tag_data("XYZ ", [&](ProfileBytes &data) { data.xyz(x, y, z); });
    };
    const std::vector<uint8_t> curve = tag_data("curv", [](ProfileBytes &data) { data.put(0); });
    std::vector<std::pair<const char *, std::vector<uint8_t>>> tags = {
        {"desc", description(grey ? "Linear grey" : "Linear, colours of the camera")},
        {"cprt", tag_data("text", [](ProfileBytes &data) { data.text("No copyright"), data.put(0, 1); })},
        {"wtpt", xyz(0.9642, 1.0, 0.8249)}};
    if (grey)
        tags.insert(tags.end(), {{"kTRC", curve}});
    else
        tags.insert(tags.end(), {{"rXYZ", xyz(0.43607, 0.22249, 0.01392)},
                                 {"gXYZ", xyz(0.38515, 0.71687, 0.09708)},
                                 {"bXYZ", xyz(0.14307, 0.06061, 0.71410)},
                                 {"rTRC", curve},
                                 {"gTRC", curve},
                                 {"bTRC", curve}});
    ProfileBytes table, data;
    const size_t start = 128 + 4 + 12 * tags.size();
    table.put(static_cast<uint32_t>(tags.size()));
    for (const auto &[name, bytes] : tags) {
        table.text(name);
        table.put(static_cast<uint32_t>(start + data.bytes().size()));
        table.put(static_cast<uint32_t>(bytes.size()));
        data.append(bytes);
    }
    ProfileBytes profile;
    profile.put(static_cast<uint32_t>(start + data.bytes().size()));
    profile.put(0);           // no preferred module
    profile.put(0x02400000);  // version 2.4
    profile.text("mntr");
    profile.text(grey ? "GRAY" : "RGB ");
    profile.text("XYZ ");
    for (uint32_t part : {2026u, 1u, 1u, 0u, 0u, 0u}) profile.put(part, 2);  // always one date: outputs are repeatable
    profile.text("acsp");
    profile.fill_to(68);
    profile.xyz(0.9642, 1.0, 0.8249);  // D50
    profile.fill_to(128);
    profile.append(table.bytes());
    profile.append(data.bytes());
    return profile.bytes();
}

ToneCurve tone_curve_of(const uint8_t *data, size_t bytes) {
    const Bytes profile{data, bytes};
    constexpr size_t header = 128, entry = 12;
    ToneCurve all = ToneCurve::unknown;
    if (!profile.has(header, 4)) return all;
    for (size_t i = 0; i < profile.u32(header); i++) {
        const size_t tag = header + 4 + entry * i;
        if (!profile.has(tag, entry)) return ToneCurve::unknown;
        if (profile.is(tag, "A2B0")) return ToneCurve::unknown;  // tables, which go before the curves
        if (!is_tone_curve(profile, tag)) continue;
        const size_t offset = profile.u32(tag + 4), size = profile.u32(tag + 8);
        if (!profile.has(offset, size)) return ToneCurve::unknown;
        const ToneCurve curve = of_curve({data + offset, size});
        if (curve != ToneCurve::linear) return curve;
        all = curve;
    }
    return all;
}

}  // namespace lensprof
