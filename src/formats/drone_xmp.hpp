// The XMP packet of a drone camera, with what is known about it from elsewhere.
#pragma once

#include <cstddef>
#include <cstdint>

#include "formats/each_format.h"

namespace lensprof {

struct DronePacket {
    const void *data;
    size_t size;
    uint32_t width, height;  // of its picture, px
    const char *source;      // for the provenance; or NULL
    const char *maker;       // of the camera, if the packet does not contain it; or NULL
};

// lp_drone_xmp_read of it.
lensprof_status read_drone_packet(const DronePacket &packet, lensprof_import_visitor visit, void *user,
                                  lensprof_error *error);

}  // namespace lensprof
