#include "photo/pictures/codec.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <new>

#include "photo/base/failure.hpp"
#include "photo/base/file_kind.hpp"
#include "photo/base/output_file.hpp"
#include "photo/system/system.hpp"

namespace lensprof {

namespace codec {

uint64_t pixel_bytes(const Picture &picture) {
    return lensprof_layout_samples(picture.layout) * uint64_t(lensprof_sample_type_bytes(picture.sample));
}

void set_frame(Picture &picture, uint32_t frame_width, uint32_t frame_height, const ReadRequest &request) {
    const std::string size = size_text(frame_width, frame_height);
    if (frame_width == 0 || frame_height == 0) fail_damaged(request.path, size);
    if (frame_width > picture_max_side || frame_height > picture_max_side
        || pixel_bytes(picture) * frame_width * frame_height > picture_max_bytes)
        fail_unsupported(request.path, size + " exceed the limit; cut it into smaller pictures");
    picture.frame_width = frame_width;
    picture.frame_height = frame_height;
    picture.reduction = 1;
    if (request.max_side > 0) {
        const uint32_t wanted = std::max(frame_width, frame_height) / request.max_side;
        picture.reduction = std::max(1u, std::min({wanted, frame_width, frame_height}));
        if (picture.reduction > 1) picture.reduction -= picture.reduction % 2;
    }
    picture.width = frame_width / picture.reduction;
    picture.height = frame_height / picture.reduction;
    picture.row_bytes = static_cast<size_t>(pixel_bytes(picture) * picture.width);
}

std::string size_text(uint64_t width, uint64_t height) {
    return std::to_string(width) + " x " + std::to_string(height) + " pixels";
}

void check_stored(const std::string &path, const std::string &declared, uint64_t needed, uint64_t stored,
                  uint64_t expansion, uint64_t file_bytes) {
    if (expansion > 0 && stored < (needed + expansion - 1) / expansion)
        fail_damaged(path, "it declares " + declared + ", too many for its "
                               + std::to_string(std::min(stored, file_bytes)) + " bytes of data");
}

LazyBytes make_lazy_bytes(size_t count) {
    LazyBytes bytes(static_cast<uint8_t *>(std::calloc(std::max<size_t>(count, 1), 1)), std::free);
    if (!bytes) throw std::bad_alloc();
    return bytes;
}

double convert_resolution(double value, PictureTraits::Unit from, PictureTraits::Unit to) {
    const auto metres = [](PictureTraits::Unit unit) {
        return unit == PictureTraits::Unit::inch ? 0.0254 : unit == PictureTraits::Unit::centimetre ? 0.01 : 1.0;
    };
    if (from == to || from == PictureTraits::Unit::none || to == PictureTraits::Unit::none) return value;
    return value * metres(to) / metres(from);
}

File open_for_reading(const std::string &path) {
    // A pipe would block until a writer opens it.
    if (system::status_of(path).kind == system::FileStatus::Kind::other)
        throw Failure(LENSPROF_ERROR_READ, path + ": cannot read: not a regular file; give the name of a picture");
    File file(system::open_stream(path, "rb"), std::fclose);
    if (!file)
        throw Failure(LENSPROF_ERROR_READ,
                      path + ": cannot read: " + system_text(errno) + "; check the file name and the permissions");
    const system::FileStatus::Kind kind = system::status_of(file.get()).kind;
    if (kind == system::FileStatus::Kind::folder || kind == system::FileStatus::Kind::missing)
        throw Failure(LENSPROF_ERROR_READ, path + ": cannot read: it is a folder; give the name of a picture");
    refuse_other_kind(path);
    return file;
}

File open_for_writing(const std::string &path) {
    File file(system::open_stream(path, "wb"), std::fclose);
    if (!file) fail_to_write(path, system_text(errno), errno);
    return file;
}

uint64_t file_bytes(std::FILE *file) { return system::status_of(file).bytes; }

void close_written(File &file, const std::string &path) {
    if (std::fclose(file.release()) != 0) fail_to_write(path, system_text(errno), errno);
}

void fail_damaged(const std::string &path, const std::string &detail) {
    throw Failure(LENSPROF_ERROR_READ,
                  path + ": cannot read: file is truncated or damaged (" + detail + "); copy it again");
}

void fail_unsupported(const std::string &path, const std::string &kind_and_next_step) {
    throw Failure(LENSPROF_ERROR_READ, path + ": cannot read: " + kind_and_next_step);
}

void fail_memory(const std::string &path) {
    fail_unsupported(path, "not enough memory; close other programs or use a smaller picture");
}

void fail_to_write(const std::string &path, const std::string &detail, int error_number) {
    throw Failure(LENSPROF_ERROR_WRITE,
                  path + ": cannot write: "
                      + (error_number != 0 ? system_text(error_number) + "; check the free space and the permissions"
                                           : detail + "; write another format"));
}

void fail_to_hold(const std::string &path, const std::string &kind_and_next_step) {
    throw Failure(LENSPROF_ERROR_ARGUMENT, path + ": cannot write: " + kind_and_next_step);
}

}  // namespace codec

}  // namespace lensprof
