// A picture file without its pixels, whose metadata can be edited in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "photo/base/output_file.hpp"
#include "photo/pictures/codec.hpp"

namespace lensprof {

namespace codec {

// A file that replaces another, with parts copied from it.
class Replacement {
public:
    Replacement(const std::string &path, std::FILE *from);

    void write(const void *data, size_t bytes);
    void copy(uint64_t start, uint64_t bytes) { copy_from(from_, start, bytes); }  // of the old file
    void copy_from(std::FILE *file, uint64_t start, uint64_t bytes);
    void commit();

private:
    std::string path_;
    std::FILE *from_;
    OutputFile output_;
    File to_;
    std::vector<uint8_t> buffer_;
};

// Metadata are edited in memory: in a small file with everything but the coded pixels, which are then copied from the
// old file. The result is byte for byte that of editing the whole.
class PictureExcerpt {
public:
    virtual ~PictureExcerpt() = default;

    const std::vector<uint8_t> &bytes() const { return bytes_; }

    // Replaces the file, completely or not at all, by one with the structure and metadata of `edited`, the edited
    // bytes(). Returns false, with the file unchanged, if the position of the pixels in it is unclear: then edit the
    // whole file. Throws Failure.
    virtual bool replace(const uint8_t *edited, size_t size) const = 0;

protected:
    explicit PictureExcerpt(const std::string &path) : path_(path) {}

    std::string path_;
    std::vector<uint8_t> bytes_;
};

// The excerpt of a PNG or JPEG with the layout that this program writes; else NULL.
std::unique_ptr<PictureExcerpt> excerpt_of(const std::string &path);

// The whole file.
std::unique_ptr<PictureExcerpt> whole_file(const std::string &path);

// `count` bytes from `start` on; false if there are fewer.
bool read_at(std::FILE *file, uint64_t start, size_t count, std::vector<uint8_t> &bytes);

}  // namespace codec

}  // namespace lensprof
