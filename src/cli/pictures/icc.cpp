// ICC.1:2010: the header has 128 bytes, then the count of tags and for each its name, offset and size; all numbers are
// big-endian. A curve is of type `curv` (10.5: no entry, one u8Fixed8 exponent, or samples of 16 bit) or `para` (10.15:
// function 0 is Y = X^g; those with more parameters are linear only where g is 1 and they add nothing).
#include "cli/pictures/icc.hpp"

#include <cmath>
#include <cstring>
#include <initializer_list>

namespace lensprof {
namespace {

constexpr double kLinear = 0.002;  // of an exponent, or of a sample of full scale

struct Bytes {
    const uint8_t *data;
    size_t count;

    bool has(size_t at, size_t size) const { return at <= count && size <= count - at; }
    uint32_t u16(size_t at) const { return uint32_t(data[at]) << 8 | data[at + 1]; }
    uint32_t u32(size_t at) const { return u16(at) << 16 | u16(at + 2); }
    bool is(size_t at, const char *name) const { return !std::memcmp(data + at, name, 4); }
};

ToneCurve told(bool is_linear) { return is_linear ? ToneCurve::linear : ToneCurve::other; }

ToneCurve of_samples(const Bytes &curve) {
    if (!curve.has(8, 4)) return ToneCurve::unknown;
    const size_t entries = curve.u32(8);
    if (entries > curve.count || !curve.has(12, 2 * entries)) return ToneCurve::unknown;
    if (entries == 0) return ToneCurve::linear;
    if (entries == 1) return told(std::fabs(curve.u16(12) / 256.0 - 1.0) < kLinear);
    for (size_t i = 0; i < entries; i++) {
        const double x = double(i) / double(entries - 1), y = curve.u16(12 + 2 * i) / 65535.0;
        if (std::fabs(y - x) > kLinear) return ToneCurve::other;
    }
    return ToneCurve::linear;
}

ToneCurve of_function(const Bytes &curve) {
    if (!curve.has(8, 8)) return ToneCurve::unknown;
    const double exponent = double(static_cast<int32_t>(curve.u32(12))) / 65536.0;
    if (curve.u16(8) == 0) return told(std::fabs(exponent - 1.0) < kLinear);
    return ToneCurve::other;
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

}  // namespace

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
        const size_t at = profile.u32(tag + 4), size = profile.u32(tag + 8);
        if (!profile.has(at, size)) return ToneCurve::unknown;
        const ToneCurve own = of_curve({data + at, size});
        if (own != ToneCurve::linear) return own;
        all = own;
    }
    return all;
}

}  // namespace lensprof
