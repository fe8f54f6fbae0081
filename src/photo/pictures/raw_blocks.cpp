#include "photo/pictures/raw_blocks.hpp"

#include <algorithm>
#include <fstream>
#include <optional>

#include "photo/base/paths.hpp"
#include "photo/pictures/codec.hpp"
#include "photo/pictures/tiff_directory.hpp"
#include "photo/pictures/tiff_tags.hpp"

namespace lensprof {

namespace codec {

namespace {

constexpr uint32_t compression_jpeg = 7;
constexpr uint8_t start_of_jpeg = 0xd8, lossless_frame = 0xc3, huffman_table = 0xc4, start_of_jpeg_scan = 0xda;
constexpr int max_segments = 64;

struct JpegFrame {
    uint32_t width = 0, height = 0, components = 0;
};

// The strips or tiles of a directory.
struct Grid {
    uint32_t width = 0, height = 0, samples = 0;
    bool is_tiled = false;
    uint64_t block_width = 0, block_height = 0;

    uint64_t columns() const { return (width + block_width - 1) / block_width; }
    uint64_t rows() const { return (height + block_height - 1) / block_height; }

    // Pixels of a block within the image. LibRaw breaks rows at the block's width, or at the image's if less.
    uint64_t pixels_of(uint64_t block) const {
        const uint64_t top = block / columns() * block_height;
        return std::min<uint64_t>(block_width, width) * std::min<uint64_t>(block_height, height - top);
    }
};

class BlockCheck {
public:
    explicit BlockCheck(const std::string &path) : path_(path), file_(path, std::ios::binary) {}

    RawBlocks run(uint32_t width, uint32_t height) {
        TiffReader reader(lensprof::file_bytes(path_), [this](uint64_t offset, uint8_t *to, size_t count) {
            if (!read(offset, to, count)) throw UnusableTiff(TiffDefect::cut_off);
        });
        for (uint64_t pointer = 4; pointer;) {
            const TiffDirectory directory = reader.directory(pointer);
            check(reader, directory, width, height);
            for (const uint64_t child : reader.children(directory))
                check(reader, reader.directory(child), width, height);
            pointer = directory.next ? directory.next_pointer() : 0;
        }
        return std::move(blocks_);
    }

private:
    bool read(uint64_t offset, uint8_t *to, size_t count) {
        file_.clear();
        file_.seekg(static_cast<std::streamoff>(offset));
        return bool(file_.read(reinterpret_cast<char *>(to), static_cast<std::streamsize>(count)));
    }

    void check(TiffReader &reader, const TiffDirectory &directory, uint32_t width, uint32_t height) {
        const uint32_t photometric = reader.number(directory, tag_photometric, 0);
        if (photometric != photometric_cfa && photometric != photometric_linear_raw) return;
        reader.check_blocks(directory);
        Grid grid;
        grid.width = reader.number(directory, tag_width, 0), grid.height = reader.number(directory, tag_height, 0);
        if (grid.width != width || grid.height != height || width == 0 || height == 0) return;
        if (reader.number(directory, tag_compression, 1) != compression_jpeg) return;
        grid.samples = reader.number(directory, tag_samples, 1);
        grid.is_tiled = directory.find(tag_tile_offsets) != nullptr;
        grid.block_width = grid.is_tiled ? reader.number(directory, tag_tile_width, 0) : width;
        grid.block_height = reader.number(directory, grid.is_tiled ? tag_tile_height : tag_rows_per_strip, height);
        if (grid.block_width == 0 || grid.block_height == 0) fail_damaged(path_, "its tiles have no size");
        check_jpegs(reader, directory, grid);
    }

    void check_jpegs(TiffReader &reader, const TiffDirectory &directory, const Grid &grid) {
        const auto offsets = reader.numbers(directory, grid.is_tiled ? tag_tile_offsets : tag_strip_offsets),
                   bytes = reader.numbers(directory, grid.is_tiled ? tag_tile_bytes : tag_strip_bytes);
        const uint64_t count = grid.columns() * grid.rows();
        if (offsets.size() < count || bytes.size() < count)
            fail_damaged(path_, std::to_string(count) + " strips or tiles are declared, but some are missing");
        if (!grid.is_tiled && count > 1)  // LibRaw decodes only the first
            fail_unsupported(path_,
                             "DNG with several lossless JPEG strips, which LibRaw does not read; convert it with "
                             "Adobe's DNG Converter, or develop it to a linear 16 bit TIFF");
        for (uint64_t i = 0; i < count; ++i) {
            const auto frame = frame_at(offsets[i], bytes[i]);
            if (!frame)
                fail_damaged(path_, "the lossless JPEG at byte " + std::to_string(offsets[i]) + " has no valid header");
            const uint64_t pixels = uint64_t(frame->width) * frame->height;
            const bool covers = grid.samples > 1 ? frame->components >= grid.samples && pixels >= grid.pixels_of(i)
                                                 : pixels * frame->components >= grid.pixels_of(i);
            if (!covers)
                fail_damaged(path_, "the lossless JPEG at byte " + std::to_string(offsets[i]) + " of "
                                        + size_text(frame->width, frame->height) + " does not fill its strip or tile");
            blocks_[offsets[i]] = bytes[i];
        }
    }

    // The frame of a lossless JPEG (ITU T.81, annex B: SOI, SOF3, DHT, SOS) within `size` bytes; empty for others.
    std::optional<JpegFrame> frame_at(uint64_t offset, uint64_t size) {
        uint8_t head[4];
        const uint64_t end = offset + size;
        if (size < 4 || !read(offset, head, 2) || head[0] != 0xff || head[1] != start_of_jpeg) return std::nullopt;
        JpegFrame frame;
        bool has_table = false;
        uint64_t segment = offset + 2;
        for (int i = 0; i < max_segments && segment + 4 <= end && read(segment, head, 4) && head[0] == 0xff; ++i) {
            const uint64_t length = uint64_t(head[2]) << 8 | head[3];
            if (head[1] == lossless_frame) {
                uint8_t f[6];
                if (length < 8 || segment + 10 > end || !read(segment + 4, f, 6)) return std::nullopt;
                frame = {uint32_t(f[3]) << 8 | f[4], uint32_t(f[1]) << 8 | f[2], f[5]};
            }
            has_table |= head[1] == huffman_table;
            if (head[1] == start_of_jpeg_scan)
                return has_table && frame.components > 0 ? std::optional<JpegFrame>(frame) : std::nullopt;
            segment += 2 + length;
        }
        return std::nullopt;
    }

    const std::string path_;
    std::ifstream file_;
    RawBlocks blocks_;
};

}  // namespace

RawBlocks check_raw_blocks(const std::string &path, uint32_t width, uint32_t height) {
    try {
        return BlockCheck(path).run(width, height);
    } catch (const UnusableTiff &unusable) {  // others: LibRaw also supports files that are not a TIFF
        if (unusable.defect == TiffDefect::pixels_cut_off) fail_damaged(path, "its pixels are cut off");
    }
    return {};
}

}  // namespace codec

}  // namespace lensprof
