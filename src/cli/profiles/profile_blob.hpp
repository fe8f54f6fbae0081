// Profiles as blob files for firmware (docs/blob.md).
#pragma once

#include <memory>
#include <string>

#include <lensprof/lensprof.h>

namespace lensprof {

// Size and checksum of a blob, to verify that a file and the data in a camera are equal.
struct BlobStamp {
    size_t bytes;
    std::string crc32;  // eight hexadecimal digits
};

// Writes the file completely or not at all.
BlobStamp write_blob(const lensprof_profile &profile, bool with_covariance, const std::string &path);

// Failure (unreadable) with the file name states whether it is damaged or only newer.
std::unique_ptr<lensprof_profile> read_blob(const std::string &path, BlobStamp &stamp);

}  // namespace lensprof
