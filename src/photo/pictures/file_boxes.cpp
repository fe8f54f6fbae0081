#include "photo/pictures/file_boxes.hpp"

#include <algorithm>
#include <vector>

#include "photo/pictures/codec.hpp"
#include "photo/pictures/picture_excerpt.hpp"

namespace lensprof {

namespace codec {

uint64_t big_endian(const uint8_t *bytes, size_t count) {
    uint64_t value = 0;
    for (size_t i = 0; i < count; ++i) value = value << 8 | bytes[i];
    return value;
}

void each_box(std::FILE *file,
              const std::function<bool(const std::string &type, uint64_t start, uint64_t size)> &visit) {
    const uint64_t end = file_bytes(file);
    std::vector<uint8_t> head;
    for (uint64_t offset = 0; offset + 8 <= end;) {
        if (!read_at(file, offset, static_cast<size_t>(std::min<uint64_t>(16, end - offset)), head)) return;
        uint64_t size = big_endian(&head[0], 4), start = 8;
        if (size == 1 && head.size() == 16) size = big_endian(&head[8], 8), start = 16;
        if (size == 0) size = end - offset;  // the last one
        const std::string type(head.begin() + 4, head.begin() + 8);
        if (size < start || size > end - offset || !visit(type, offset + start, size - start)) return;
        offset += size;
    }
}

}  // namespace codec

}  // namespace lensprof
