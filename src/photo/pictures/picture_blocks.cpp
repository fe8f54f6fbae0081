#include "photo/pictures/picture_blocks.hpp"

#include <algorithm>
#include <cstring>
#include <optional>

#include "photo/base/failure.hpp"
#include "photo/pictures/codec.hpp"
#include "photo/pictures/coded_kind.hpp"
#include "photo/pictures/coded_metadata.hpp"
#include "photo/pictures/maker_notes.hpp"
#include "photo/pictures/picture_excerpt.hpp"
#include "photo/pictures/raw_kind.hpp"

namespace lensprof {

namespace {

enum class Container {
    jpeg,
    png,
    tiff,
    other
};

Container container_of(const std::string &path) {
    const codec::File file = codec::open_for_reading(path);
    std::vector<uint8_t> start;
    if (!codec::read_at(file.get(), 0, 8, start)) return Container::other;
    if (std::memcmp(start.data(), "\x89PNG\r\n\x1a\n", 8) == 0) return Container::png;
    if (std::memcmp(start.data(), "\xff\xd8", 2) == 0) return Container::jpeg;
    const bool is_tiff = std::memcmp(start.data(), "II*\0", 4) == 0 || std::memcmp(start.data(), "MM\0*", 4) == 0;
    return is_tiff ? Container::tiff : Container::other;
}

codec::ReadAt reader_of(const std::vector<uint8_t> &bytes) {
    return [&bytes](uint64_t offset, size_t count, std::vector<uint8_t> &part) {
        if (offset > bytes.size() || count > bytes.size() - offset) return false;
        const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(offset);
        part.assign(from, from + static_cast<std::ptrdiff_t>(count));
        return true;
    };
}

[[noreturn]] void fail_reading(const std::string &path, const std::string &why) {
    throw Failure(LENSPROF_ERROR_READ,
                  path + ": cannot read metadata: " + why + "; check that it is a picture, or copy it again");
}

PictureBlocks read_other(const std::string &path) {
    if (std::optional<PictureBlocks> blocks = read_other_blocks(path)) return std::move(*blocks);
    if (raw_kind(path)) return {};  // read without metadata
    throw std::runtime_error("the file has an unknown format");
}

PictureBlocks read_container(const std::string &path) {
    if (const auto coded = coded_kind(path); coded && !raw_kind(path)) return read_coded_blocks(path, *coded);
    const Container container = container_of(path);
    if (container == Container::tiff) return codec::read_tiff_blocks(path);
    if (container == Container::other) return read_other(path);
    const codec::File file = codec::open_for_reading(path);
    const codec::ReadAt read = [&](uint64_t offset, size_t count, std::vector<uint8_t> &bytes) {
        return offset <= codec::file_bytes(file.get()) && count <= codec::file_bytes(file.get()) - offset
               && codec::read_at(file.get(), offset, count, bytes);
    };
    return container == Container::png ? codec::read_png_blocks(read) : codec::read_jpeg_blocks(read);
}

// False if the excerpt is not sufficient.
bool edit_excerpt(const codec::PictureExcerpt &excerpt, Container container,
                  const std::function<void(PictureBlocks &)> &change) {
    const bool is_png = container == Container::png;
    PictureBlocks blocks = is_png ? codec::read_png_blocks(reader_of(excerpt.bytes()))
                                  : codec::read_jpeg_blocks(reader_of(excerpt.bytes()));
    change(blocks);
    const std::vector<uint8_t> edited =
        is_png ? codec::png_with(excerpt.bytes(), blocks) : codec::jpeg_with(excerpt.bytes(), blocks);
    return excerpt.replace(edited.data(), edited.size());
}

}  // namespace

PictureBlocks read_blocks(const std::string &path) {
    try {
        return read_container(path);
    } catch (const Failure &) {
        throw;
    } catch (const std::exception &error) {
        fail_reading(path, error.what());
    }
}

void edit_blocks(const std::string &path, const std::function<void(PictureBlocks &)> &change) {
    const Container container = container_of(path);
    if (container == Container::other) fail_reading(path, "the file is not a JPEG, PNG or TIFF");
    PictureBlocks blocks = read_blocks(path);  // for its errors
    try {
        if (container == Container::tiff) {
            change(blocks);
            codec::write_tiff_blocks(path, std::move(blocks));
            return;
        }
        const auto excerpt = codec::excerpt_of(path);
        if (!excerpt || !edit_excerpt(*excerpt, container, change))
            edit_excerpt(*codec::whole_file(path), container, change);
    } catch (const Failure &) {
        throw;
    } catch (const std::exception &error) {
        throw Failure(LENSPROF_ERROR_WRITE,
                      path + ": cannot write metadata: " + error.what() + "; write another format");
    }
}

}  // namespace lensprof
