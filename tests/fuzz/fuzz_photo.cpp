// Fuzzing lensprof/photo.h with pictures in memory. Invariant for any bytes: a picture is opened, or refused with a
// text; what is opened has a header, metadata and pixels of the sizes stated; a copy with its metadata can be opened.
#include <lensprof/photo.h>

#include "fuzz_file.hpp"

namespace {

const char *const kTarget = "fuzz_photo";
const std::vector<std::string> kWords = {std::string(4, '\0'),
                                         "\xFF\xFF\xFF\xFF",
                                         "\xFF\xD8",
                                         "\xFF\xD9",
                                         "\xFF\xDA",
                                         "\xFF\xE1",
                                         "Exif",
                                         "8BIM",
                                         "IHDR",
                                         "IDAT",
                                         "eXIf",
                                         "iCCP",
                                         "II*",
                                         "MM",
                                         "\x69\x87",
                                         "\x7C\x92",
                                         "<x:xmpmeta",
                                         "ispe",
                                         "VP8X",
                                         "\x80",
                                         "\x7F"};

constexpr uint64_t kLargestFrame = 1 << 16;  // px; larger ones only take more time

struct Owner {
    lensprof_picture *picture = nullptr;
    ~Owner() { lensprof_picture_destroy(picture); }
};

// Whether a call is done; otherwise the file is damaged, and a text states how.
bool is_done(lensprof_status status, const lensprof_error &error) {
    demand((status == LENSPROF_OK) == !error.text[0], "status and error text contradict each other");
    demand(status == LENSPROF_OK || status == LENSPROF_ERROR_READ, error.text);
    return status == LENSPROF_OK;
}

bool open(const std::vector<char> &bytes, Owner &owner) {
    lensprof_error error;
    const bool is_open =
        is_done(lensprof_picture_open_memory(bytes.data(), bytes.size(), &owner.picture, &error), error);
    demand(is_open == (owner.picture != nullptr), "status and handle contradict each other");
    return is_open;
}

void check_metadata(const lensprof_picture *picture) {
    lensprof_picture_metadata metadata;
    lensprof_picture_metadata_init(&metadata);
    demand(lensprof_picture_get_metadata(picture, &metadata, nullptr) == LENSPROF_OK, "no metadata");
    demand(lensprof_profile_key_validate(&metadata.key) == LENSPROF_OK || !metadata.key.camera_model[0],
           "an invalid key");
    written([&](void *data, size_t capacity, size_t *count) {
        return lensprof_picture_get_icc(picture, data, capacity, count, nullptr);
    });
}

// The pixels, as an image in `data`.
bool read(const lensprof_picture *picture, uint32_t max_side, std::vector<uint8_t> &data, lensprof_image &image) {
    lensprof_picture_info info;
    lensprof_picture_info_init(&info);
    lensprof_error error;
    if (!is_done(lensprof_picture_get_info(picture, max_side, &info, &error), error)) return false;
    if (uint64_t{info.width} * info.height > kLargestFrame) return false;
    demand(info.read_width >= 1 && info.read_height >= 1, "an empty picture");
    const size_t row_bytes =
        size_t{info.read_width} * lensprof_sample_type_bytes(info.sample) * lensprof_layout_samples(info.layout);
    data.assign(row_bytes * info.read_height, 0);
    lensprof_target target = {};
    target.width = info.read_width, target.height = info.read_height;
    target.sample = info.sample, target.layout = info.layout;
    target.data = data.data(), target.row_bytes = static_cast<ptrdiff_t>(row_bytes);
    if (!is_done(lensprof_picture_read(picture, max_side, &target, &error), error)) return false;
    image = {};
    image.width = target.width, image.height = target.height;
    image.sample = target.sample, image.layout = target.layout;
    image.data = data.data(), image.row_bytes = target.row_bytes;
    return true;
}

// A copy as PNG or TIFF, which hold every kind of pixels but a mosaic.
void check_copy(const lensprof_picture *picture, const lensprof_image &image) {
    static size_t turn = 0;
    lensprof_picture_options options;
    lensprof_picture_options_init(&options);
    options.like = picture;
    std::vector<char> copy((1 << 20) + 16 * kLargestFrame);
    size_t count = 0;
    lensprof_error error;
    const lensprof_status status = lensprof_picture_encode(turn++ % 2 ? ".png" : ".tif", &image, &options, copy.data(),
                                                           copy.size(), &count, &error);
    demand((status == LENSPROF_OK) == !error.text[0], "status and error text contradict each other");
    if (status != LENSPROF_OK) return;
    copy.resize(count);
    Owner again;
    demand(open(copy, again), "a copy cannot be opened");
    check_metadata(again.picture);
}

bool try_bytes(const std::vector<char> &bytes) {
    Owner owner;
    if (!open(bytes, owner)) return false;
    check_metadata(owner.picture);
    std::vector<uint8_t> data;
    lensprof_image image;
    read(owner.picture, 4, data, image);
    if (!read(owner.picture, 0, data, image)) return false;
    check_copy(owner.picture, image);
    return true;
}

}  // namespace
