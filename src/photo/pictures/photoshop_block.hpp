// The image resources of Photoshop, in which JPEG and PNG files hold IPTC.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lensprof {

namespace codec {

// The resource of IPTC; empty if missing. Damaged resources end the search.
std::vector<uint8_t> iptc_of(const std::vector<uint8_t> &resources);

// The resources with another IPTC; without it if it is empty.
std::vector<uint8_t> with_iptc(const std::vector<uint8_t> &resources, const std::vector<uint8_t> &iptc);

}  // namespace codec

}  // namespace lensprof
