#include "photo/pictures/picture_excerpt.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "photo/base/events.hpp"
#include "photo/pictures/file_boxes.hpp"
#include "photo/system/system.hpp"

namespace lensprof {

namespace codec {

namespace {

// Maximum bytes before the pixels; a file with more has another layout.
constexpr uint64_t start_max_bytes = uint64_t(64) << 20;

constexpr size_t copy_bytes = size_t(1) << 20;

// JPEG and PNG: metadata come first, and the rest is copied unchanged.
class PixelsLast final : public PictureExcerpt {
public:
    PixelsLast(const std::string &path, std::FILE *file, uint64_t pixels, const std::vector<uint8_t> &end)
        : PictureExcerpt(path), pixels_(pixels), end_(end) {
        if (!read_at(file, 0, static_cast<size_t>(pixels), bytes_))
            fail_damaged(path,
                         "it was truncated while being "
                         "read");
        bytes_.insert(bytes_.end(), end.begin(), end.end());
    }

    bool replace(const uint8_t *edited, size_t size) const override {
        if (size < end_.size() || !std::equal(end_.begin(), end_.end(), edited + size - end_.size())) return false;
        const File file = open_for_reading(path_);
        Replacement to(path_, file.get());
        to.write(edited, size - end_.size());
        to.copy(pixels_, file_bytes(file.get()) - pixels_);
        to.commit();
        return true;
    }

private:
    uint64_t pixels_;           // where they start in the file
    std::vector<uint8_t> end_;  // their substitute in the excerpt
};

// The segments before the first scan (ITU-T T.81, annex B).
std::unique_ptr<PictureExcerpt> excerpt_of_jpeg(const std::string &path) {
    const File file = open_for_reading(path);
    std::vector<uint8_t> head;
    for (uint64_t offset = 2; offset < start_max_bytes && read_at(file.get(), offset, 4, head) && head[0] == 0xff;) {
        const uint32_t marker = head[1], length = static_cast<uint32_t>(big_endian(&head[2], 2));
        if (marker < 0xc0 || (marker >= 0xd0 && marker <= 0xd9) || marker == 0xff || length < 2) return nullptr;
        if (marker != 0xda) {
            offset += 2 + length;
            continue;
        }
        std::vector<uint8_t> end;
        if (!read_at(file.get(), offset, 2 + length, end)) return nullptr;
        end.insert(end.end(), {0xff, 0xd9});  // a scan without data, and the end
        return std::make_unique<PixelsLast>(path, file.get(), offset, end);
    }
    return nullptr;
}

// The chunks before IDAT, when nothing but these follows (PNG 1.2, chapter 4).
std::unique_ptr<PictureExcerpt> excerpt_of_png(const std::string &path) {
    const File file = open_for_reading(path);
    std::vector<uint8_t> head;
    uint64_t pixels = 0;
    for (uint64_t offset = 8; read_at(file.get(), offset, 8, head); offset += 12 + big_endian(head.data(), 4)) {
        const bool data = std::memcmp(&head[4], "IDAT", 4) == 0, last = std::memcmp(&head[4], "IEND", 4) == 0;
        if (last && pixels > 0) {
            const std::vector<uint8_t> end = {0, 0, 0, 0, 'I', 'E', 'N', 'D', 0xae, 0x42, 0x60, 0x82};
            return std::make_unique<PixelsLast>(path, file.get(), pixels, end);
        }
        if (last || (!data && pixels > 0) || (!data && offset > start_max_bytes)) return nullptr;
        if (data && pixels == 0) pixels = offset;
    }
    return nullptr;
}

class WholeFile final : public PictureExcerpt {
public:
    explicit WholeFile(const std::string &path) : PictureExcerpt(path) {
        const File file = open_for_reading(path);
        size_t count = 1;
        while (count > 0) {
            const size_t start = bytes_.size();
            bytes_.resize(start + copy_bytes);
            count = std::fread(bytes_.data() + start, 1, bytes_.size() - start, file.get());
            bytes_.resize(start + count);
        }
    }

    bool replace(const uint8_t *edited, size_t size) const override {
        write_file(path_, edited, size);
        return true;
    }
};

}  // namespace

bool read_at(std::FILE *file, uint64_t start, size_t count, std::vector<uint8_t> &bytes) {
    bytes.resize(count);
    return system::seek(file, static_cast<int64_t>(start), SEEK_SET)
           && std::fread(bytes.data(), 1, count, file) == count;
}

Replacement::Replacement(const std::string &path, std::FILE *from)
    : path_(path), from_(from), output_(path), to_(open_for_writing(output_.temporary())) {}

void Replacement::write(const void *data, size_t bytes) {
    errno = 0;
    if (bytes > 0 && std::fwrite(data, 1, bytes, to_.get()) != bytes) fail_to_write(path_, system_text(errno), errno);
}

void Replacement::copy_from(std::FILE *file, uint64_t start, uint64_t bytes) {
    for (uint64_t done = 0; done < bytes;) {
        stop_if_cancelled();
        const size_t count = static_cast<size_t>(std::min<uint64_t>(copy_bytes, bytes - done));
        if (!read_at(file, start + done, count, buffer_)) fail_damaged(path_, "it was truncated while being read");
        write(buffer_.data(), count);
        done += count;
    }
}

void Replacement::commit() {
    close_written(to_, path_);
    output_.commit();
}

std::unique_ptr<PictureExcerpt> excerpt_of(const std::string &path) {
    const File file = open_for_reading(path);
    std::vector<uint8_t> start;
    if (!read_at(file.get(), 0, 8, start)) return nullptr;
    if (std::memcmp(start.data(), "\x89PNG\r\n\x1a\n", 8) == 0) return excerpt_of_png(path);
    if (std::memcmp(start.data(), "\xff\xd8", 2) == 0) return excerpt_of_jpeg(path);
    return nullptr;
}

std::unique_ptr<PictureExcerpt> whole_file(const std::string &path) { return std::make_unique<WholeFile>(path); }

}  // namespace codec

}  // namespace lensprof
