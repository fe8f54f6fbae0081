// Colour profiles with known tone curves, for tests.
#pragma once

#include <string>

#include "picture_files.hpp"

namespace icc_files {

using picture_files::Bytes;

inline void put16(Bytes &bytes, uint32_t value) {
    bytes.push_back(static_cast<uint8_t>(value >> 8));
    bytes.push_back(static_cast<uint8_t>(value));
}

inline void put32(Bytes &bytes, uint32_t value) {
    put16(bytes, value >> 16);
    put16(bytes, value & 0xffff);
}

inline void put_name(Bytes &bytes, const std::string &name) { bytes.insert(bytes.end(), name.begin(), name.end()); }

// 10.5 of the specification: samples of 16 bit; a single sample is an exponent times 256, and an empty list is y = x.
inline Bytes samples_curve(const std::vector<uint32_t> &samples) {
    Bytes bytes;
    put_name(bytes, "curv");
    put32(bytes, 0);
    put32(bytes, static_cast<uint32_t>(samples.size()));
    for (uint32_t sample : samples) put16(bytes, sample);
    return bytes;
}

// 10.15: parameters times 65536.
inline Bytes function_curve(uint32_t function, const std::vector<double> &parameters) {
    Bytes bytes;
    put_name(bytes, "para");
    put32(bytes, 0);
    put16(bytes, function);
    put16(bytes, 0);
    for (double value : parameters) put32(bytes, static_cast<uint32_t>(std::lround(value * 65536.0)));
    return bytes;
}

// A profile whose tags `names` share one curve.
inline Bytes profile_of(const Bytes &curve, const std::vector<std::string> &names = {"rTRC", "gTRC", "bTRC"}) {
    const uint32_t begin = static_cast<uint32_t>(132 + 12 * names.size());
    Bytes profile = picture_files::make_profile(names.size() == 1, 128);
    put32(profile, static_cast<uint32_t>(names.size()));
    for (const std::string &name : names) {
        put_name(profile, name);
        put32(profile, begin);
        put32(profile, static_cast<uint32_t>(curve.size()));
    }
    profile.insert(profile.end(), curve.begin(), curve.end());
    const auto size = static_cast<uint32_t>(profile.size());
    for (size_t i = 0; i < 4; i++) profile[i] = static_cast<uint8_t>(size >> (24 - 8 * i));
    return profile;
}

}  // namespace icc_files
