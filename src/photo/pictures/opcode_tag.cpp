#include "photo/pictures/opcode_tag.hpp"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <memory>
#include <optional>

#include <lensprof/apply.h>

#include "photo/base/failure.hpp"
#include "photo/base/output_file.hpp"
#include "photo/pictures/tiff_directory.hpp"
#include "photo/pictures/tiff_tags.hpp"

namespace lensprof {

namespace {

constexpr uint32_t max_opcode_bytes = 64u << 20;

const char *text_of(TiffDefect defect) {
    switch (defect) {
    case TiffDefect::not_tiff: return "is not a TIFF or DNG file; give one, because only they store opcodes";
    case TiffDefect::big_tiff:
        return "is a BigTIFF, in which lensprof does not support opcodes; convert it to "
               "classic TIFF";
    case TiffDefect::no_directory: return "has no image directory; give a complete file";
    case TiffDefect::cut_off: return "is cut off within its image directory; give the complete file";
    case TiffDefect::pixels_cut_off: return "is cut off within its pixels; give the complete file";
    case TiffDefect::circle: return "has circular or more than 256 image directories; give another file";
    }
    return "";
}

// A classic TIFF and the directory of its image. Reads only what is requested.
class TiffFile {
public:
    explicit TiffFile(const std::string &path) : path_(path), file_(path, std::ios::binary) {
        if (!file_) fail("cannot be opened: " + system_text(errno) + "; check the file name and the permissions");
        file_.seekg(0, std::ios::end);
        size_ = static_cast<uint64_t>(std::max<std::streamoff>(file_.tellg(), 0));
        try {
            reader_ = std::make_unique<TiffReader>(
                size_, [&](uint64_t offset, uint8_t *bytes, size_t count) { read(offset, bytes, count); });
            find_image();
        } catch (const UnusableTiff &unusable) {
            fail(text_of(unusable.defect));
        }
    }

    uint64_t size() const { return size_; }
    const TiffByteOrder &order() const { return reader_->order(); }

    // The directory of the raw image, or the first of a plain TIFF. Its values and pixels are all in the file.
    const TiffDirectory &image() const { return image_; }
    bool is_raw() const { return raw_; }

    uint32_t number(uint16_t tag, uint32_t fallback) { return reader_->number(image_, tag, fallback); }
    std::vector<uint32_t> numbers(uint16_t tag, uint32_t max_count) { return reader_->numbers(image_, tag, max_count); }

    std::vector<uint8_t> bytes_of(uint16_t tag) {
        const TiffEntry *entry = image_.find(tag);
        if (!entry || (entry->type != tiff_undefined && entry->type != tiff_byte)) return {};
        if (entry->count > max_opcode_bytes) fail("has an opcode list larger than 64 MiB; give another file");
        return reader_->bytes(*entry);
    }

    // Copies the whole file, in pieces.
    void copy_to(std::ostream &target) {
        std::vector<char> piece(1 << 20);
        file_.clear();
        file_.seekg(0);
        for (uint64_t left = size_; left;) {
            const size_t bytes = static_cast<size_t>(std::min<uint64_t>(left, piece.size()));
            if (!file_.read(piece.data(), static_cast<std::streamsize>(bytes)))
                fail("read error before the end of the file: " + system_text(errno) + "; check the disk");
            target.write(piece.data(), static_cast<std::streamsize>(bytes));
            left -= bytes;
        }
    }

private:
    [[noreturn]] void fail(const std::string &text) const { throw Failure(LENSPROF_ERROR_READ, path_ + ": " + text); }

    void read(uint64_t offset, uint8_t *bytes, size_t count) {
        file_.clear();
        file_.seekg(static_cast<std::streamoff>(offset));
        if (!file_.read(reinterpret_cast<char *>(bytes), static_cast<std::streamsize>(count)))
            fail("cannot be read: " + system_text(errno) + "; check the disk");
    }

    void find_image() {
        image_ = choose();
        reader_->check_values(image_);
        reader_->check_blocks(image_);
    }

    // Also sets raw_. Holds only a few directories at a time.
    TiffDirectory choose() {
        std::optional<TiffDirectory> first, preview, image;
        const auto look_at = [&](TiffDirectory directory) {
            if (image || !has_raw(directory)) return;
            raw_ = true;
            if (reader_->number(directory, tag_subfile_type, 0) == 0)
                image = std::move(directory);
            else if (!preview)
                preview = std::move(directory);
        };
        for (uint64_t pointer = 4; pointer && !image;) {
            TiffDirectory directory = reader_->directory(pointer);
            const std::vector<uint64_t> children = reader_->children(directory);
            pointer = directory.next ? directory.next_pointer() : 0;
            if (!first) first = directory;
            look_at(std::move(directory));
            for (uint64_t child : children) look_at(reader_->directory(child));
        }
        return image ? *image : preview ? *preview : *first;
    }

    bool has_raw(const TiffDirectory &directory) {
        const uint32_t photometric = reader_->number(directory, tag_photometric, 0);
        return photometric == photometric_cfa || photometric == photometric_linear_raw;
    }

    std::string path_;
    std::ifstream file_;
    uint64_t size_ = 0;
    std::unique_ptr<TiffReader> reader_;
    TiffDirectory image_{};
    bool raw_ = false;
};

// Channels of the first 2 x 2 pixels, 0 red, 1 green, 2 blue.
uint32_t mosaic_layout(TiffFile &file) {
    const std::vector<uint32_t> repeat = file.numbers(tag_cfa_repeat, 2), pattern = file.numbers(tag_cfa_pattern, 4);
    const struct {
        uint32_t layout;
        std::vector<uint32_t> pattern;
    } known[] = {{LENSPROF_LAYOUT_RGGB, {0, 1, 1, 2}},
                 {LENSPROF_LAYOUT_GRBG, {1, 0, 2, 1}},
                 {LENSPROF_LAYOUT_GBRG, {1, 2, 0, 1}},
                 {LENSPROF_LAYOUT_BGGR, {2, 1, 1, 0}}};
    for (const auto &entry : known)
        if (repeat == std::vector<uint32_t>{2, 2} && pattern == entry.pattern) return entry.layout;
    return UINT32_MAX;
}

// Bytes to append to a TIFF, in its byte order.
class AppendedBytes {
public:
    explicit AppendedBytes(const TiffByteOrder &order) : order_(order) {}

    void put(uint32_t value, size_t size) {
        bytes_.resize(bytes_.size() + size);
        order_.put(&bytes_[bytes_.size() - size], size, value);
    }
    void put(const uint8_t *bytes, size_t count) { bytes_.insert(bytes_.end(), bytes, bytes + count); }

    // Aligns what follows to an even position in the file.
    void align(uint64_t file_bytes) { bytes_.resize(bytes_.size() + (file_bytes + bytes_.size()) % 2); }

    const std::vector<uint8_t> &bytes() const { return bytes_; }

private:
    TiffByteOrder order_;
    std::vector<uint8_t> bytes_;
};

// The list, followed by the image's directory with the updated tag, to append to the file. *place receives the position
// of the directory.
std::vector<uint8_t> appendix(const TiffFile &file, uint16_t tag, const std::vector<uint8_t> &list, uint64_t *place) {
    AppendedBytes end(file.order());
    TiffEntry entry{tag, tiff_undefined, static_cast<uint32_t>(list.size()), {}, 0};
    end.align(file.size());
    if (entry.inside()) {
        std::copy(list.begin(), list.end(), entry.value);
    } else {
        file.order().put(entry.value, 4, static_cast<uint32_t>(file.size() + end.bytes().size()));
        end.put(list.data(), list.size());
    }
    std::vector<TiffEntry> all = file.image().entries;
    all.erase(std::remove_if(all.begin(), all.end(), [&](const TiffEntry &e) { return e.tag == tag; }), all.end());
    all.insert(std::find_if(all.begin(), all.end(), [&](const TiffEntry &e) { return e.tag > tag; }), entry);
    end.align(file.size());
    *place = file.size() + end.bytes().size();
    end.put(static_cast<uint32_t>(all.size()), 2);
    for (const TiffEntry &field : all) {
        end.put(field.tag, 2);
        end.put(field.type, 2);
        end.put(field.count, 4);
        end.put(field.value, 4);
    }
    end.put(file.image().next, 4);
    return end.bytes();
}

}  // namespace

OpcodeLists read_opcode_lists(const std::string &path) {
    TiffFile file(path);
    OpcodeLists lists;
    lists.raw = file.is_raw();
    lists.width = file.number(tag_width, 0);
    lists.height = file.number(tag_height, 0);
    const std::vector<uint32_t> area = file.numbers(tag_active_area, 4);  // top, left, bottom, right
    if (area.size() == 4 && area[0] < area[2] && area[1] < area[3] && area[2] <= lists.height
        && area[3] <= lists.width) {
        lists.width = area[3] - area[1];
        lists.height = area[2] - area[0];
    }
    const bool mosaic = file.number(tag_photometric, 0) == photometric_cfa;
    const uint32_t samples = file.number(tag_samples, 1);
    lists.layout = mosaic         ? mosaic_layout(file)
                   : samples >= 3 ? static_cast<uint32_t>(LENSPROF_LAYOUT_RGB)
                                  : static_cast<uint32_t>(LENSPROF_LAYOUT_GREY);
    lists.list2 = file.bytes_of(tag_opcode_list2);
    lists.list3 = file.bytes_of(tag_opcode_list3);
    return lists;
}

void write_opcode_list(const std::string &path_in, const std::string &path_out, uint16_t tag,
                       const std::vector<uint8_t> &list) {
    TiffFile file(path_in);
    const auto too_large = [&](uint64_t size) {
        if (size > UINT32_MAX)
            throw Failure(LENSPROF_ERROR_WRITE,
                          path_out + ": would exceed 4 GiB, the limit of TIFF; write a smaller map");
    };
    too_large(file.size() + list.size() + 2);
    if (file.image().entries.size() >= UINT16_MAX)
        throw Failure(LENSPROF_ERROR_READ, path_in + ": its image directory cannot be extended; give another file");
    uint64_t place = 0;
    const std::vector<uint8_t> bytes = appendix(file, tag, list, &place);
    too_large(file.size() + bytes.size());
    OutputFile output(path_out);
    errno = 0;
    std::fstream target(output.temporary(), std::ios::binary | std::ios::in | std::ios::out);
    file.copy_to(target);
    target.write(reinterpret_cast<const char *>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    uint8_t pointer[4];
    file.order().put(pointer, 4, static_cast<uint32_t>(place));
    target.seekp(static_cast<std::streamoff>(file.image().pointer));
    target.write(reinterpret_cast<const char *>(pointer), 4);
    target.close();
    if (!target)
        throw Failure(LENSPROF_ERROR_WRITE, path_out + ": cannot write: " + system_text(errno ? errno : EIO)
                                                + "; free some space or check the folder");
    output.commit();
}

}  // namespace lensprof
