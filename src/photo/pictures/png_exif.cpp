#include "photo/pictures/png_exif.hpp"

#include <algorithm>
#include <set>
#include <string>

#include <exiv2/exiv2.hpp>

namespace lensprof {

namespace codec {

namespace {

constexpr size_t header_end = 8 + 25;  // signature and IHDR, which comes first

void put_big_endian(std::vector<uint8_t> &bytes, uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<uint8_t>(value >> shift));
}

// CRC-32 of ISO 3309, as PNG has it.
uint32_t crc_of(const uint8_t *bytes, size_t count) {
    uint32_t crc = 0xffffffffu;
    for (size_t i = 0; i < count; ++i) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
    }
    return ~crc;
}

std::vector<uint8_t> make_chunk(const std::vector<uint8_t> &exif) {
    std::vector<uint8_t> chunk;
    put_big_endian(chunk, static_cast<uint32_t>(exif.size()));
    chunk.insert(chunk.end(), {'e', 'X', 'I', 'f'});
    chunk.insert(chunk.end(), exif.begin(), exif.end());
    put_big_endian(chunk, crc_of(chunk.data() + 4, chunk.size() - 4));
    return chunk;
}

}  // namespace

void keep_last(Exiv2::ExifData &exif) {
    std::set<std::string> seen;
    std::vector<const Exiv2::Exifdatum *> last;
    for (const Exiv2::Exifdatum &datum : exif) last.push_back(&datum);
    const auto is_earlier = [&](const Exiv2::Exifdatum *datum) { return !seen.insert(datum->key()).second; };
    last.erase(last.begin(), std::remove_if(last.rbegin(), last.rend(), is_earlier).base());
    if (last.size() == static_cast<size_t>(exif.count())) return;
    Exiv2::ExifData kept;
    for (const Exiv2::Exifdatum *datum : last) kept.add(*datum);
    exif = kept;
}

std::vector<uint8_t> take_exif(Exiv2::Image &image) {
    Exiv2::Blob exif;
    if (image.exifData().count() > 0) {
        const Exiv2::ByteOrder order = image.byteOrder();
        Exiv2::ExifParser::encode(exif, order == Exiv2::invalidByteOrder ? Exiv2::littleEndian : order,
                                  image.exifData());
        image.clearExifData();
    }
    return exif;
}

std::vector<uint8_t> with_exif(const uint8_t *png, size_t size, const std::vector<uint8_t> &exif) {
    std::vector<uint8_t> file(png, png + size);
    if (exif.empty() || size < header_end) return file;
    const std::vector<uint8_t> chunk = make_chunk(exif);
    file.insert(file.begin() + header_end, chunk.begin(), chunk.end());
    return file;
}

}  // namespace codec

}  // namespace lensprof
