#include "photo/pictures/coded_file.hpp"

#include <cstring>

namespace lensprof {

namespace codec {

void DecodedSource::read(uint8_t *row) {
    const size_t row_bytes = static_cast<size_t>(pixel_bytes(header_) * header_.frame_width);
    if (!pixels_) {
        const size_t bytes = row_bytes * header_.frame_height;
        pixels_ = make_lazy_bytes(bytes);
        decode(pixels_.get(), bytes);
    }
    std::memcpy(row, pixels_.get() + next_++ * row_bytes, row_bytes);
}

void set_coded_frame(Picture &picture, uint32_t width, uint32_t height, const ReadRequest &request) {
    set_frame(picture, width, height, request);
    if (pixel_bytes(picture) * width * height > coded_max_bytes)
        fail_unsupported(request.path,
                         size_text(width, height) + " exceed the limit of this format; convert it to TIFF first");
}

void fail_hdr(const std::string &path, const std::string &kind, const std::string &transfer) {
    fail_unsupported(path, "is a high dynamic range " + kind + " picture (" + transfer
        + " transfer), whose values do not follow a camera response; convert it to a TIFF or PNG in sRGB, or to a "
          "linear TIFF, first");
}

void fail_animated(const std::string &path, const std::string &kind) {
    fail_unsupported(path, "is a " + kind + " animation; save one of its frames as TIFF or PNG first");
}

std::vector<uint8_t> without_exif_mark(const uint8_t *bytes, size_t count) {
    static const char mark[] = {'E', 'x', 'i', 'f', 0, 0};
    const size_t skipped = count >= sizeof mark && std::memcmp(bytes, mark, sizeof mark) == 0 ? sizeof mark : 0;
    return {bytes + skipped, bytes + count};
}

std::vector<uint8_t> exif_of_item(const std::vector<uint8_t> &item) {
    constexpr size_t head = 4;
    if (item.size() <= head) return {};
    uint64_t skipped = 0;
    for (size_t i = 0; i < head; i++) skipped = skipped << 8 | item[i];
    if (skipped >= item.size() - head) return {};
    const size_t start = head + static_cast<size_t>(skipped);
    return without_exif_mark(item.data() + start, item.size() - start);
}

}  // namespace codec

}  // namespace lensprof
