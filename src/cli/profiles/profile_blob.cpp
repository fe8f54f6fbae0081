#include "cli/profiles/profile_blob.hpp"

#include <vector>

#include "cli/report/report.hpp"
#include "photo/base/format.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/library.hpp"
#include "photo/base/output_file.hpp"

namespace lensprof {
namespace {

// Bytes: no packed profile is larger.
constexpr uint64_t max_blob_bytes = 1 << 20;

// The CRC-32 is the last four bytes, the least significant first.
BlobStamp stamp_of(const unsigned char *blob, size_t bytes) {
    const unsigned char *crc = blob + bytes - 4;
    return {bytes, format("%02x%02x%02x%02x", crc[3], crc[2], crc[1], crc[0])};
}

}  // namespace

BlobStamp write_blob(const lensprof_profile &profile, bool with_covariance, const std::string &path) {
    const uint32_t flags = with_covariance ? LENSPROF_PACK_COVARIANCE : 0;
    const std::string blob = written(path, [&](void *data, size_t capacity, size_t *count, lensprof_error *) {
        return lensprof_profile_pack(&profile, flags, data, capacity, count);
    });
    write_file(path, blob.data(), blob.size());
    return stamp_of(reinterpret_cast<const unsigned char *>(blob.data()), blob.size());
}

std::unique_ptr<lensprof_profile> read_blob(const std::string &path, BlobStamp &stamp) {
    const std::string blob = read_text(path, max_blob_bytes);
    auto profile = new_profile();
    const lensprof_status status = lensprof_profile_unpack(blob.data(), blob.size(), profile.get());
    if (status == LENSPROF_ERROR_LAYOUT)
        throw Failure(LENSPROF_ERROR_READ, path + ": was written by a newer lensprof; read it with that version");
    if (status != LENSPROF_OK)
        throw Failure(LENSPROF_ERROR_READ, path + ": not a profile blob, or damaged; copy it again, or export it "
                                                   "again with `lensprof profile export`");
    stamp = stamp_of(reinterpret_cast<const unsigned char *>(blob.data()), blob.size());
    return profile;
}

}  // namespace lensprof
