// The index of the pictures in one JPEG file (CIPA DC-007, Multi-Picture Format), a segment APP2 of its first picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace lensprof {

namespace codec {

struct MpPicture {
    uint32_t attribute = 0;  // flags and type
    uint32_t bytes = 0;
    uint32_t offset = 0;  // from the index's byte order mark; 0 for the first picture
    uint16_t dependent[2] = {};

    uint32_t type() const { return attribute & 0xffffff; }
    bool is_preview() const { return (type() & 0xff0000) == 0x010000; }  // a large thumbnail of the first picture
    bool is_view() const { return (type() & 0xff0000) == 0x020000; }     // of a panorama, stereo pair or multi-angle
    bool is_gain_map() const { return type() == 0x050000; }

    void remove_dependence() {
        attribute &= 0x3fffffff;  // without the flags of dependent parent and child
        dependent[0] = dependent[1] = 0;
    }
};

// The pictures of the index at `bytes`, after its mark "MPF"; empty optional if it is damaged.
std::optional<std::vector<MpPicture>> read_mp_index(const std::vector<uint8_t> &bytes);

constexpr size_t mp_index_start = 8;  // of the byte order mark in the segment

size_t mp_segment_bytes(size_t pictures);
std::vector<uint8_t> mp_segment(const std::vector<MpPicture> &pictures);

}  // namespace codec

}  // namespace lensprof
