// Pictures from and to files and memory.
#include <algorithm>
#include <cstring>
#include <filesystem>

#include "photo/api/handles.hpp"
#include "photo/api/sized.hpp"
#include "photo/base/input_file.hpp"

namespace lensprof {
namespace {

constexpr size_t first_info = LENSPROF_FIRST(lensprof_picture_info, icc_bytes),
                 first_metadata = LENSPROF_FIRST(lensprof_picture_metadata, captured),
                 first_options = LENSPROF_FIRST(lensprof_picture_options, metadata);

// The path of bytes in memory names nothing for the caller.
template <class Call>
void with_name(const std::optional<MemoryFile> &bytes, const Call &call) {
    try {
        call();
    } catch (const Failure &failure) {
        std::string text = failure.what();
        if (bytes)
            for (size_t at; (at = text.find(bytes->path())) != std::string::npos;)
                text.replace(at, bytes->path().size(), "the bytes of the picture");
        throw Failure(failure.status, text, failure.reason);
    }
}

std::unique_ptr<lensprof_picture> opened(std::unique_ptr<lensprof_picture> picture) {
    with_name(picture->bytes, [&] {
        require_regular_file(picture->path);
        picture->header = read_header(picture->path);
        picture->metadata = read_metadata(picture->path);
    });
    return picture;
}

// The picture that is written: the pixels, and what is like another.
Picture picture_of(const lensprof_image &pixels, const lensprof_picture *like) {
    check(lensprof_image_validate(&pixels), "pixels");
    Picture picture;
    picture.width = picture.frame_width = pixels.width, picture.height = picture.frame_height = pixels.height;
    picture.sample = pixels.sample, picture.layout = pixels.layout;
    picture.row_bytes =
        size_t(pixels.width) * lensprof_layout_samples(pixels.layout) * lensprof_sample_type_bytes(pixels.sample);
    picture.pixels.resize(picture.row_bytes * pixels.height);
    for (uint32_t y = 0; y < pixels.height; y++)
        std::memcpy(&picture.pixels[y * picture.row_bytes],
                    static_cast<const uint8_t *>(pixels.data) + static_cast<ptrdiff_t>(y) * pixels.row_bytes,
                    picture.row_bytes);
    if (!like) return picture;
    const bool is_grey = lensprof_layout_channels(pixels.layout) == 1,
               was_grey = lensprof_layout_channels(like->header.layout) == 1;
    if (is_grey == was_grey) picture.icc = like->header.icc;
    picture.traits = like->header.traits;
    return picture;
}

// A number of EXIF in the range that its tag holds, or empty if it is unknown.
std::optional<double> stated(double value, double least, double below, const char *name) {
    if (value == LENSPROF_UNKNOWN) return {};
    if (value >= least && value < below) return value;
    throw Failure(LENSPROF_ERROR_ARGUMENT,
                  std::string("metadata: ") + name + ": is neither in the range of EXIF nor LENSPROF_UNKNOWN");
}

PictureMetadata metadata_of(const lensprof_picture_metadata &given) {
    lensprof_picture_metadata all;
    lensprof_picture_metadata_init(&all);
    all = taken(&given, all, first_metadata, "metadata");
    check(lensprof_profile_key_validate(&all.key), "metadata: key");
    PictureMetadata metadata = unknown_metadata();
    metadata.key = all.key;
    metadata.key.aperture = stated(all.f_number, 0.01, 1e3, "f_number").value_or(all.key.aperture);
    metadata.exposure_time_s = stated(all.exposure_time_s, 1e-9, 1e6, "exposure_time_s");
    metadata.iso = stated(all.iso, 0.5, 1e8, "iso");
    metadata.captured.assign(all.captured, std::find(all.captured, std::end(all.captured), '\0'));
    return metadata;
}

void write_as(const std::string &path, const lensprof_image &pixels, const lensprof_picture_options *given) {
    lensprof_picture_options defaults;
    lensprof_picture_options_init(&defaults);
    const lensprof_picture_options options = taken(given, defaults, first_options, "options");
    if (options.jpeg_quality > 100) throw Failure(LENSPROF_ERROR_ARGUMENT, "jpeg_quality: is above 100");
    if (pixels.sample == LENSPROF_SAMPLE_F16)
        throw Failure(LENSPROF_ERROR_ARGUMENT, "pixels: no format holds half floats; give 8 or 16 bit, or float");
    WriteOptions how;
    how.jpeg_quality = static_cast<int>(options.jpeg_quality);
    if (options.like) how.metadata_from = options.like->path;
    PictureMetadata metadata;
    if (options.metadata) metadata = metadata_of(*options.metadata), how.metadata = &metadata;
    write_picture(path, picture_of(pixels, options.like), how);
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

void lensprof_picture_metadata_init_sized(lensprof_picture_metadata *metadata, size_t size) {
    lensprof_init_sized(metadata, size);
    if (size < first_metadata) return;
    lensprof_profile_key_init(&metadata->key);
    metadata->exposure_time_s = metadata->iso = metadata->f_number = metadata->ev = LENSPROF_UNKNOWN;
}

lensprof_status lensprof_picture_open(const char *path, lensprof_picture **picture, lensprof_error *error) {
    return photo_call("picture", error, [&] {
        require(path, "path"), require(picture, "picture");
        auto handle = std::make_unique<lensprof_picture>();
        handle->path = path;
        *picture = opened(std::move(handle)).release();
    });
}

lensprof_status lensprof_picture_open_memory(const void *data, size_t size, lensprof_picture **picture,
                                             lensprof_error *error) {
    return photo_call("picture", error, [&] {
        require(picture, "picture");
        if (size) require(data, "data");
        auto handle = std::make_unique<lensprof_picture>();
        handle->bytes.emplace(data, size);
        handle->path = handle->bytes->path();
        *picture = opened(std::move(handle)).release();
    });
}

void lensprof_picture_destroy(lensprof_picture *picture) { delete picture; }

lensprof_status lensprof_picture_get_info(const lensprof_picture *picture, uint32_t max_side,
                                          lensprof_picture_info *info, lensprof_error *error) {
    return photo_call("picture", error, [&] {
        require(picture, "picture"), require(info, "info");
        Picture reduced;
        with_name(picture->bytes, [&] {
            ReadOptions options;
            options.max_side = max_side;
            reduced = max_side ? read_header(picture->path, options) : picture->header;
        });
        lensprof_picture_info found;
        lensprof_picture_info_init(&found);
        found.width = picture->header.frame_width, found.height = picture->header.frame_height;
        found.sample = reduced.sample, found.layout = reduced.layout;
        found.reduction = reduced.reduction;
        found.read_width = reduced.width, found.read_height = reduced.height;
        found.orientation = picture->metadata.orientation;
        found.icc_bytes = picture->header.icc.size();
        give(found, info, first_info, "info");
    });
}

lensprof_status lensprof_picture_get_metadata(const lensprof_picture *picture, lensprof_picture_metadata *metadata,
                                              lensprof_error *error) {
    return photo_call("picture", error, [&] {
        require(picture, "picture"), require(metadata, "metadata");
        const PictureMetadata &from = picture->metadata;
        lensprof_picture_metadata found;
        lensprof_picture_metadata_init(&found);
        found.is_corrected = !from.corrected_by.empty();
        found.key = from.key;
        found.exposure_time_s = from.exposure_time_s.value_or(LENSPROF_UNKNOWN);
        found.iso = from.iso.value_or(LENSPROF_UNKNOWN);
        found.f_number = from.f_number.value_or(LENSPROF_UNKNOWN);
        found.ev = from.exif_ev.value_or(LENSPROF_UNKNOWN);
        set_text(found.captured, sizeof found.captured, from.captured);
        give(found, metadata, first_metadata, "metadata");
    });
}

lensprof_status lensprof_picture_get_icc(const lensprof_picture *picture, void *buffer, size_t capacity, size_t *count,
                                         lensprof_error *error) {
    return photo_call("picture", error, [&] {
        require(picture, "picture");
        give_bytes(picture->header.icc.data(), picture->header.icc.size(), buffer, capacity, count);
    });
}

lensprof_status lensprof_picture_read(const lensprof_picture *picture, uint32_t max_side, const lensprof_target *pixels,
                                      lensprof_error *error) {
    return photo_call("picture", error, [&] {
        require(picture, "picture"), require(pixels, "pixels");
        const lensprof_image given = image_of(*pixels);
        check(lensprof_image_validate(&given), "pixels");
        Picture read;
        with_name(picture->bytes, [&] {
            ReadOptions options;
            options.max_side = max_side;
            read = read_picture(picture->path, options);
        });
        if (read.width != pixels->width || read.height != pixels->height || read.sample != pixels->sample
            || read.layout != pixels->layout)
            throw Failure(LENSPROF_ERROR_SIZE,
                          "pixels: are not of the size, sample type and layout of "
                          "lensprof_picture_get_info; the file may have changed");
        for (uint32_t y = 0; y < read.height; y++)
            std::memcpy(static_cast<uint8_t *>(pixels->data) + static_cast<ptrdiff_t>(y) * pixels->row_bytes,
                        &read.pixels[y * read.row_bytes], read.row_bytes);
    });
}

lensprof_status lensprof_picture_write(const char *path, const lensprof_image *pixels,
                                       const lensprof_picture_options *options, lensprof_error *error) {
    return photo_call("picture", error, [&] {
        require(path, "path"), require(pixels, "pixels");
        write_as(path, *pixels, options);
    });
}

lensprof_status lensprof_picture_encode(const char *name, const lensprof_image *pixels,
                                        const lensprof_picture_options *options, void *buffer, size_t capacity,
                                        size_t *count, lensprof_error *error) {
    return photo_call("picture", error, [&] {
        require(name, "name"), require(pixels, "pixels");
        const TemporaryFolder folder;
        const std::string path =
            folder.path() + "/picture" + std::filesystem::path(std::string("x") + name).extension().string();
        try {
            write_as(path, *pixels, options);
        } catch (const Failure &failure) {  // with the name that the caller gave
            const std::string text = failure.what();
            throw Failure(failure.status, text.rfind(path, 0) == 0 ? name + text.substr(path.size()) : text);
        }
        const std::string bytes = read_text(path, UINT64_MAX);
        give_bytes(bytes.data(), bytes.size(), buffer, capacity, count);
    });
}
