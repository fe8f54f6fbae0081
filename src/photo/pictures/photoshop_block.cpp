#include "photo/pictures/photoshop_block.hpp"

#include <cstring>

#include "photo/pictures/file_boxes.hpp"

namespace lensprof {

namespace codec {

namespace {

constexpr uint16_t iptc_resource = 0x0404;

struct Resource {
    uint64_t id = 0;
    size_t start = 0, data = 0, bytes = 0, end = 0;  // of it, and of its data
};

// "8BIM", an identifier, a name and data, the last two of even length. False at the end and if it is damaged.
bool read_resource(const std::vector<uint8_t> &all, size_t start, Resource &resource) {
    if (all.size() < start + 12 || std::memcmp(&all[start], "8BIM", 4) != 0) return false;
    const size_t name_bytes = (size_t(all[start + 6]) + 2) & ~size_t(1), size_place = start + 6 + name_bytes;
    if (all.size() < size_place + 4) return false;
    const size_t bytes = static_cast<size_t>(big_endian(&all[size_place], 4)), data = size_place + 4;
    if (bytes > all.size() - data) return false;
    const size_t end = data + bytes + bytes % 2;
    resource = {big_endian(&all[start + 4], 2), start, data, bytes, end < all.size() ? end : all.size()};
    return true;
}

}  // namespace

std::vector<uint8_t> iptc_of(const std::vector<uint8_t> &resources) {
    Resource resource;
    for (size_t at = 0; read_resource(resources, at, resource); at = resource.end)
        if (resource.id == iptc_resource)
            return {&resources[resource.data], &resources[resource.data] + resource.bytes};
    return {};
}

std::vector<uint8_t> with_iptc(const std::vector<uint8_t> &resources, const std::vector<uint8_t> &iptc) {
    std::vector<uint8_t> all;
    Resource resource;
    for (size_t at = 0; read_resource(resources, at, resource); at = resource.end)
        if (resource.id != iptc_resource) {
            all.insert(all.end(), &resources[resource.start],
                       &resources[resource.start] + (resource.end - resource.start));
            if (all.size() % 2) all.push_back(0);  // the last one may lack its padding
        }
    if (iptc.empty()) return all;
    all.insert(all.end(), {'8', 'B', 'I', 'M', 4, 4, 0, 0});
    for (int shift = 24; shift >= 0; shift -= 8) all.push_back(static_cast<uint8_t>(iptc.size() >> shift));
    all.insert(all.end(), iptc.begin(), iptc.end());
    if (iptc.size() % 2) all.push_back(0);
    return all;
}

}  // namespace codec

}  // namespace lensprof
