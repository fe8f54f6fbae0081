// Fuzzing PNG, TIFF, JPEG, HEIC, AVIF, WebP and JPEG XL files. Invariant for any bytes: the header, the picture and the
// reduced picture are read, or a Failure gives the reason; if the picture is read, so is its header, with the same
// sizes.
#include "fuzz_file.hpp"
#include "photo/pictures/picture.hpp"

namespace {

using namespace lensprof;

const char *const kTarget = "fuzz_pictures";
const std::vector<std::string> kWords = {std::string(4, '\0'),
                                         "\xFF\xFF\xFF\xFF",
                                         "\xFF\xD8",
                                         "\xFF\xD9",
                                         "\xFF\xDA",
                                         "\xFF\xC0",
                                         "\xFF\xC4",
                                         "IHDR",
                                         "IDAT",
                                         "IEND",
                                         "PLTE",
                                         "tRNS",
                                         "II*",
                                         "\x01\x01",
                                         "\x01\x02",
                                         "\x01\x03",
                                         "\x01\x1C",
                                         "\x80",
                                         "\x7F",
                                         "irot",
                                         "ispe",
                                         "VP8X",
                                         "ALPH",
                                         "jxlp"};

constexpr uint64_t kLargestFrame = 1 << 20;  // px; larger ones only take more time

void check_sizes(const Picture &picture, const Picture &header) {
    demand(picture.width == header.width && picture.height == header.height, "sizes differ from the header's");
    demand(picture.sample == header.sample && picture.layout == header.layout, "samples differ from the header's");
    demand(picture.pixels.size() == picture.row_bytes * picture.height, "pixel size differs");
    demand(picture.width >= 1 && picture.height >= 1, "an empty picture");
}

bool read_both(const std::string &path, const ReadOptions &options) {
    Picture header;
    if (!is_read([&] { header = read_header(path, options); })) return false;
    if (uint64_t{header.frame_width} * header.frame_height > kLargestFrame) return false;
    return is_read([&] { check_sizes(read_picture(path, options), header); });
}

bool try_bytes(const std::vector<char> &bytes) {
    const MemoryFile file(bytes);
    ReadOptions reduced;
    reduced.max_side = 4;
    const bool full = read_both(file.path(), {});
    read_both(file.path(), reduced);
    return full;
}

}  // namespace
