// Synthetic camera raw files: DNGs of a mosaic or of linear values, written byte by byte (DNG 1.4; TIFF 6.0).
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "picture_files.hpp"

namespace raw_files {

using picture_files::Bytes;

enum class Packing {
    words,    // 16 bits per sample, little-endian
    bits,     // without gaps, the highest bit first
    lossless  // lossless JPEG (ITU T.81, process 14), predictor 1
};

struct Dng {
    uint32_t width = 0, height = 0, samples = 1;  // including masked pixels
    std::vector<uint16_t> values;
    uint16_t bits = 16;
    Packing packing = Packing::words;
    uint32_t white = 65535;
    std::vector<uint32_t> black = {0};  // one value, or one per site of a 2 x 2 pattern
    std::array<uint8_t, 4> pattern = {0, 1, 1, 2};
    std::vector<uint32_t> pattern6;        // of 6 x 6 places, instead of 2 x 2; may be empty
    std::vector<uint32_t> active, masked;  // top, left, bottom, right
    std::string maker = "TestMaker", model = "TestCam 1";
    bool is_dng = true;  // otherwise the same structure without the tags of DNG, as in NEF and PEF
    uint16_t orientation = 1;
    std::string lens;  // with f_number and focal_mm in a directory of EXIF; may be empty
    double f_number = 0.0, focal_mm = 0.0;
    std::vector<uint8_t> opcodes;  // OpcodeList3; may be empty
    uint32_t declared = 0;         // width and height in the header instead of the true ones; 0 = the true ones
};

// Bits, the highest first.
class BitWriter {
public:
    explicit BitWriter(bool stuffed) : stuffed_(stuffed) {}
    void put(uint32_t value, unsigned count) {
        while (count-- > 0) {
            byte_ = byte_ << 1 | (value >> count & 1);
            if (++held_ == 8) flush();
        }
    }
    Bytes finish() {
        while (held_ != 0) put(stuffed_ ? 1 : 0, 1);
        return bytes_;
    }

private:
    void flush() {
        bytes_.push_back(static_cast<uint8_t>(byte_));
        if (stuffed_ && (byte_ & 255) == 255) bytes_.push_back(0);
        byte_ = held_ = 0;
    }
    bool stuffed_;
    Bytes bytes_;
    uint32_t byte_ = 0, held_ = 0;
};

inline Bytes packed(const Dng &dng) {
    BitWriter writer(false);
    for (uint32_t y = 0; y < dng.height; y++) {
        const size_t row = size_t(dng.width) * dng.samples;
        for (size_t i = 0; i < row; i++) writer.put(dng.values[y * row + i], dng.bits);
        while (row * dng.bits % 8 != 0) return {};  // rows that end within a byte are not supported here
    }
    return writer.finish();
}

// One component. All 17 categories of differences have codes of 5 bits.
inline Bytes lossless_jpeg(const Dng &dng) {
    const auto high = static_cast<uint8_t>(dng.height >> 8), low = static_cast<uint8_t>(dng.height);
    const auto wide = static_cast<uint8_t>(dng.width >> 8), narrow = static_cast<uint8_t>(dng.width);
    Bytes jpeg = {0xff, 0xd8,   0xff, 0xc3, 0,    11, static_cast<uint8_t>(dng.bits), high, low,
                  wide, narrow, 1,    0,    0x11, 0};
    const Bytes table = {0xff, 0xc4, 0, 2 + 1 + 16 + 17, 0, 0, 0, 0, 0, 17, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    jpeg.insert(jpeg.end(), table.begin(), table.end());
    for (uint8_t i = 0; i < 17; i++) jpeg.push_back(i);
    const Bytes scan = {0xff, 0xda, 0, 8, 1, 0, 0, 1, 0, 0};
    jpeg.insert(jpeg.end(), scan.begin(), scan.end());
    BitWriter writer(true);
    for (uint32_t y = 0; y < dng.height; y++)
        for (uint32_t x = 0; x < dng.width; x++) {
            const uint16_t *at = &dng.values[size_t(y) * dng.width + x];
            const int guess = x > 0 ? at[-1] : y > 0 ? at[-static_cast<ptrdiff_t>(dng.width)] : 1 << (dng.bits - 1);
            const int difference = *at - guess;
            unsigned category = 0;
            while (std::abs(difference) >> category) category++;
            writer.put(category, 5);
            if (category > 0)
                writer.put(static_cast<uint32_t>(difference > 0 ? difference : difference + (1 << category) - 1),
                           category);
        }
    const Bytes coded = writer.finish();
    jpeg.insert(jpeg.end(), coded.begin(), coded.end());
    jpeg.push_back(0xff), jpeg.push_back(0xd9);
    return jpeg;
}

inline Bytes words_of(const std::vector<uint16_t> &values) {
    Bytes bytes;
    for (uint16_t v : values) bytes.push_back(static_cast<uint8_t>(v)), bytes.push_back(static_cast<uint8_t>(v >> 8));
    return bytes;
}

// Entries of a directory, in the order of their tags.
class Directory {
public:
    void add(uint16_t tag, uint16_t type, uint32_t count, Bytes bytes) {
        entries_.push_back({tag, type, count, std::move(bytes)});
    }
    void numbers(uint16_t tag, uint16_t type, const std::vector<uint32_t> &values) {
        const unsigned size = type == 1 ? 1 : type == 3 ? 2 : 4;
        Bytes bytes;
        for (uint32_t v : values)
            for (unsigned i = 0; i < size; i++) bytes.push_back(static_cast<uint8_t>(v >> 8 * i));
        add(tag, type, static_cast<uint32_t>(type == 5 || type == 10 ? values.size() / 2 : values.size()), bytes);
    }
    void text(uint16_t tag, const std::string &text) {
        add(tag, 2, static_cast<uint32_t>(text.size() + 1), Bytes(text.c_str(), text.c_str() + text.size() + 1));
    }
    Bytes bytes_at(uint32_t place) const {
        Bytes head, values;
        const auto put = [](Bytes &to, uint32_t v, unsigned size) {
            for (unsigned i = 0; i < size; i++) to.push_back(static_cast<uint8_t>(v >> 8 * i));
        };
        put(head, static_cast<uint32_t>(entries_.size()), 2);
        const uint32_t start = place + 2 + 12 * static_cast<uint32_t>(entries_.size()) + 4;
        for (const Entry &e : entries_) {
            put(head, e.tag, 2), put(head, e.type, 2), put(head, e.count, 4);
            Bytes value = e.bytes;
            if (value.size() > 4) {
                const auto at = start + static_cast<uint32_t>(values.size());
                values.insert(values.end(), value.begin(), value.end());
                values.resize((values.size() + 1) / 2 * 2);
                value.clear();
                put(value, at, 4);
            }
            value.resize(4);
            head.insert(head.end(), value.begin(), value.end());
        }
        put(head, 0, 4);
        head.insert(head.end(), values.begin(), values.end());
        return head;
    }

private:
    struct Entry {
        uint16_t tag, type;
        uint32_t count;
        Bytes bytes;
    };
    std::vector<Entry> entries_;
};

inline void add_levels(Directory &directory, const Dng &dng) {
    if (dng.black.size() == 4) directory.numbers(50713, 3, {2, 2});
    directory.numbers(50714, 4, dng.black.size() == 4 ? dng.black : std::vector<uint32_t>(dng.samples, dng.black[0]));
    directory.numbers(50717, 4, std::vector<uint32_t>(dng.samples, dng.white));
    // XYZ to the camera's colours, and its white: any invertible matrix
    std::vector<uint32_t> matrix;
    for (int v : {10000, -2000, -1000, -3000, 11000, 2000, -500, 2000, 6000})
        matrix.push_back(static_cast<uint32_t>(v)), matrix.push_back(10000);
    directory.numbers(50721, 10, matrix);
    directory.numbers(50728, 5, {5, 10, 1, 1, 7, 10});
    directory.numbers(50778, 3, {21});
    if (!dng.active.empty()) directory.numbers(50829, 4, dng.active);
    if (!dng.masked.empty()) directory.numbers(50830, 4, dng.masked);
    if (!dng.opcodes.empty()) directory.add(51022, 7, static_cast<uint32_t>(dng.opcodes.size()), dng.opcodes);
}

// EXIF 2.32: aperture, focal length and the name of the lens.
inline Directory exif_of(const Dng &dng) {
    const auto tenths = [](double value) { return static_cast<uint32_t>(std::lround(10.0 * value)); };
    Directory d;
    d.numbers(33437, 5, {tenths(dng.f_number), 10}), d.numbers(37386, 5, {tenths(dng.focal_mm), 10});
    d.text(42036, dng.lens);
    return d;
}

inline Directory directory_of(const Dng &dng, uint32_t pixels_at, uint32_t pixel_bytes, uint32_t exif_at = 0) {
    Directory d;
    const uint32_t width = dng.declared ? dng.declared : dng.width, height = dng.declared ? dng.declared : dng.height;
    d.numbers(254, 4, {0}), d.numbers(256, 4, {width}), d.numbers(257, 4, {height});
    d.numbers(258, 3, std::vector<uint32_t>(dng.samples, dng.packing == Packing::words ? 16 : dng.bits));
    d.numbers(259, 3, {dng.packing == Packing::lossless ? 7u : 1u});
    d.numbers(262, 3, {dng.samples == 1 ? 32803u : 34892u});
    d.text(271, dng.maker), d.text(272, dng.model), d.numbers(273, 4, {pixels_at});
    d.numbers(274, 3, {dng.orientation}), d.numbers(277, 3, {dng.samples}), d.numbers(278, 4, {height});
    d.numbers(279, 4, {pixel_bytes}), d.numbers(284, 3, {1});
    if (!dng.pattern6.empty()) {
        d.numbers(33421, 3, {6, 6}), d.numbers(33422, 1, dng.pattern6);
    } else if (dng.samples == 1) {
        d.numbers(33421, 3, {2, 2});
        d.numbers(33422, 1, {dng.pattern[0], dng.pattern[1], dng.pattern[2], dng.pattern[3]});
    }
    if (exif_at) d.numbers(34665, 4, {exif_at});
    if (!dng.is_dng) return d;
    d.numbers(50706, 1, {1, 4, 0, 0}), d.numbers(50707, 1, {1, 1, 0, 0}), d.text(50708, "TestMaker " + dng.model);
    add_levels(d, dng);
    return d;
}

// The directory first, then that of EXIF, then the pixels.
inline Bytes dng_bytes(const Dng &dng) {
    const Bytes pixels = dng.packing == Packing::lossless ? lossless_jpeg(dng)
                         : dng.packing == Packing::bits   ? packed(dng)
                                                          : words_of(dng.values);
    const auto count = static_cast<uint32_t>(pixels.size());
    const bool has_exif = !dng.lens.empty();
    Bytes file = {'I', 'I', 42, 0, 8, 0, 0, 0};
    const auto exif_at = static_cast<uint32_t>(8 + directory_of(dng, 0, count, has_exif).bytes_at(8).size());
    const Bytes exif = has_exif ? exif_of(dng).bytes_at(exif_at) : Bytes();
    const auto place = exif_at + static_cast<uint32_t>(exif.size());
    const Bytes directory = directory_of(dng, place, count, has_exif ? exif_at : 0).bytes_at(8);
    for (const Bytes &part : {directory, exif, pixels}) file.insert(file.end(), part.begin(), part.end());
    return file;
}

// As cameras and converters write them: a JPEG preview in the first directory, whose SubIFD is the raw image.
inline Bytes dng_with_preview(const Dng &dng, const Bytes &jpeg, uint32_t width, uint32_t height) {
    const Bytes pixels = words_of(dng.values);
    const auto directories = [&](uint32_t raw_place, uint32_t jpeg_place, uint32_t pixels_place) {
        Directory d;
        d.numbers(254, 4, {1}), d.numbers(256, 4, {width}), d.numbers(257, 4, {height}), d.numbers(258, 3, {8, 8, 8});
        d.numbers(259, 3, {7}), d.numbers(262, 3, {6}), d.text(271, "TestMaker"), d.text(272, dng.model);
        d.numbers(273, 4, {jpeg_place}), d.numbers(277, 3, {3}), d.numbers(278, 4, {height});
        d.numbers(279, 4, {static_cast<uint32_t>(jpeg.size())}), d.numbers(284, 3, {1}), d.numbers(330, 4, {raw_place});
        d.numbers(50706, 1, {1, 4, 0, 0}), d.text(50708, "TestMaker " + dng.model);
        Bytes all = d.bytes_at(8);
        const auto own = static_cast<uint32_t>(8 + all.size());
        const Bytes raw = directory_of(dng, pixels_place, static_cast<uint32_t>(pixels.size())).bytes_at(own);
        all.insert(all.end(), raw.begin(), raw.end());
        return std::make_pair(own, all);
    };
    const auto [raw_place, sized] = directories(0, 0, 0);
    const auto jpeg_place = static_cast<uint32_t>(8 + sized.size());
    const Bytes all = directories(raw_place, jpeg_place, jpeg_place + static_cast<uint32_t>(jpeg.size())).second;
    Bytes file = {'I', 'I', 42, 0, 8, 0, 0, 0};
    for (const Bytes &part : {all, jpeg, pixels}) file.insert(file.end(), part.begin(), part.end());
    return file;
}

}  // namespace raw_files
