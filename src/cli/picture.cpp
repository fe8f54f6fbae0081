#include "picture.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>
#include <type_traits>

#include <sys/stat.h>

#include "error.hpp"
#include "output_file.hpp"

namespace lensprof {

namespace codec {

namespace {

/* Of every block of 2 x 2 pixels in two rows, of `row_samples` each, the mean of the middle two; put at the front of the
 * upper row. Not finite values stay so. */
template <class Sample, class Sum> void reduce_blocks(uint8_t *rows, size_t row_samples, size_t pixel, size_t count) {
    Sample *to = reinterpret_cast<Sample *>(rows);
    const Sample *upper = to, *lower = to + row_samples;
    const Sum half = std::is_floating_point<Sum>::value ? Sum(0) : Sum(1);
    for (size_t i = 0; i < count; ++i, upper += 2 * pixel, lower += 2 * pixel)
        for (size_t c = 0; c < pixel; ++c) {
            const Sample v[4] = {upper[c], upper[c + pixel], lower[c], lower[c + pixel]};
            const Sum least = std::min(std::min(v[0], v[1]), std::min(v[2], v[3]));
            const Sum largest = std::max(std::max(v[0], v[1]), std::max(v[2], v[3]));
            *to++ = static_cast<Sample>((Sum(v[0]) + v[1] + v[2] + v[3] - least - largest + half) / 2);
        }
}

/* Place below `count` of a fraction of 2^32. */
uint32_t place(uint32_t fraction, uint32_t count) { return static_cast<uint32_t>(uint64_t(fraction) * count >> 32); }

}  // namespace

RowSink::RowSink(Picture &picture, uint32_t source_width, uint32_t done)
    : picture_(picture), halves_(picture.reduction > 1 && done == 1), blocks_(std::max(picture.reduction / 2, 1u)),
      pixel_bytes_(static_cast<size_t>(pixel_bytes(picture))), scratch_row_(source_width * pixel_bytes_),
      direct_(!halves_ && blocks_ == 1 && source_width == picture.width) {
    picture_.pixels.clear();
    picture_.pixels.reserve(picture_.row_bytes * picture_.height);
    if (direct_)
        return;
    scratch_.resize(scratch_row_ * (halves_ ? 2 : 1));
    picks_.resize(blocks_);
}

uint8_t *RowSink::row() {
    if (!direct_)
        return scratch_.data() + (lower_ ? scratch_row_ : 0);
    picture_.pixels.resize((emitted_ + size_t(1)) * picture_.row_bytes);
    return picture_.pixels.data() + emitted_ * picture_.row_bytes;
}

void RowSink::accept() {
    if (emitted_ == picture_.height)
        return;
    if (direct_) {
        ++emitted_;
        return;
    }
    if (halves_) {
        lower_ = !lower_;
        if (lower_)
            return;
        halve_rows();
    }
    pick_from_row();
}

void RowSink::halve_rows() {
    const size_t pixel = lensprof_layout_samples(picture_.layout), count = size_t(picture_.width) * blocks_;
    const size_t row_samples = scratch_row_ / lensprof_sample_bytes(picture_.sample);
    if (picture_.sample == LENSPROF_SAMPLE_U8)
        reduce_blocks<uint8_t, int32_t>(scratch_.data(), row_samples, pixel, count);
    else if (picture_.sample == LENSPROF_SAMPLE_U16)
        reduce_blocks<uint16_t, int32_t>(scratch_.data(), row_samples, pixel, count);
    else
        reduce_blocks<float, double>(scratch_.data(), row_samples, pixel, count);
}

/* Multiples of the plane's generalised golden ratio (Roberts' R2 sequence) and of the golden ratio, as fractions of 2^32,
 * choose the block, so that the blocks of any few neighbouring pixels lie evenly about the middles of their squares. */
void RowSink::choose_blocks() {
    for (auto &picks : picks_)
        picks.clear();
    for (uint32_t x = 0; x < picture_.width; ++x) {
        const uint32_t down = place(0xc13fa9a9u * x + 0x91e10da6u * emitted_, blocks_);
        picks_[down].push_back({x, x * blocks_ + place(0x9e3779b9u * x + 0x80000000u * emitted_, blocks_)});
    }
}

void RowSink::pick_from_row() {
    if (block_row_ == 0) {
        picture_.pixels.resize((emitted_ + size_t(1)) * picture_.row_bytes);
        choose_blocks();
    }
    uint8_t *to = picture_.pixels.data() + emitted_ * picture_.row_bytes;
    const uint8_t *from = scratch_.data();
    for (const Pick &pick : picks_[block_row_]) {
        if (pixel_bytes_ == 3) /* the usual size, known to the compiler */
            std::memcpy(to + pick.x * size_t(3), from + pick.column * size_t(3), 3);
        else
            std::memcpy(to + pick.x * pixel_bytes_, from + pick.column * pixel_bytes_, pixel_bytes_);
    }
    if (++block_row_ == blocks_) {
        block_row_ = 0;
        ++emitted_;
    }
}

uint64_t pixel_bytes(const Picture &picture) {
    return lensprof_layout_samples(picture.layout) * uint64_t(lensprof_sample_bytes(picture.sample));
}

void set_frame(Picture &picture, uint32_t frame_width, uint32_t frame_height, const ReadRequest &request) {
    const std::string size = std::to_string(frame_width) + " x " + std::to_string(frame_height) + " pixels";
    if (frame_width == 0 || frame_height == 0)
        fail_damaged(request.path, size);
    if (frame_width > picture_max_side || frame_height > picture_max_side ||
        pixel_bytes(picture) * frame_width * frame_height > picture_max_bytes)
        fail_unsupported(request.path, size + " are too many; cut it into smaller pictures");
    picture.frame_width = frame_width;
    picture.frame_height = frame_height;
    picture.reduction = 1;
    if (request.max_side > 0) {
        const uint32_t wanted = std::max(frame_width, frame_height) / request.max_side;
        picture.reduction = std::max(1u, std::min({wanted, frame_width, frame_height}));
        if (picture.reduction > 1)
            picture.reduction -= picture.reduction % 2;
    }
    picture.width = frame_width / picture.reduction;
    picture.height = frame_height / picture.reduction;
    picture.row_bytes = static_cast<size_t>(pixel_bytes(picture) * picture.width);
}

double convert_resolution(double value, PictureTraits::Unit from, PictureTraits::Unit to) {
    const auto metres = [](PictureTraits::Unit unit) {
        return unit == PictureTraits::Unit::inch ? 0.0254 : unit == PictureTraits::Unit::centimetre ? 0.01 : 1.0;
    };
    if (from == to || from == PictureTraits::Unit::none || to == PictureTraits::Unit::none)
        return value;
    return value * metres(to) / metres(from);
}

File open_for_reading(const std::string &path) {
    File file(std::fopen(path.c_str(), "rb"), std::fclose);
    if (!file)
        throw Failure(ExitCode::unreadable,
                      path + ": cannot read: " + system_text(errno) + "; check the name and its permissions");
    struct stat status = {};
    if (fstat(fileno(file.get()), &status) != 0 || S_ISDIR(status.st_mode))
        throw Failure(ExitCode::unreadable, path + ": cannot read: is a folder; give the name of a picture");
    return file;
}

File open_for_writing(const std::string &path) {
    File file(std::fopen(path.c_str(), "wb"), std::fclose);
    if (!file)
        fail_to_write(path, system_text(errno), errno);
    return file;
}

void close_written(File &file, const std::string &path) {
    if (std::fclose(file.release()) != 0)
        fail_to_write(path, system_text(errno), errno);
}

void fail_damaged(const std::string &path, const std::string &detail) {
    throw Failure(ExitCode::unreadable,
                  path + ": cannot read: file is truncated or damaged (" + detail + "); copy it again");
}

void fail_unsupported(const std::string &path, const std::string &kind_and_next_step) {
    throw Failure(ExitCode::unreadable, path + ": cannot read: " + kind_and_next_step);
}

void fail_to_write(const std::string &path, const std::string &detail, int error_number) {
    throw Failure(ExitCode::failed,
                  path + ": cannot write: " +
                      (error_number != 0 ? system_text(error_number) + "; check the disk's space and the permissions"
                                         : detail + "; write another format"));
}

void fail_to_hold(const std::string &path, const std::string &kind_and_next_step) {
    throw Failure(ExitCode::usage, path + ": cannot write: " + kind_and_next_step);
}

}  // namespace codec

namespace {

FileFormat format_of_content(const std::string &path) {
    const codec::File file = codec::open_for_reading(path);
    unsigned char start[12] = {};
    const size_t count = std::fread(start, 1, sizeof start, file.get());
    const auto begins = [&](const char *bytes, size_t length) {
        return count >= length && std::memcmp(start, bytes, length) == 0;
    };
    if (begins("\x89PNG\r\n\x1a\n", 8))
        return FileFormat::png;
    if (begins("\xff\xd8\xff", 3))
        return FileFormat::jpeg;
    if (count >= 10 && (start[8] == 'C' && start[9] == 'R') && begins("II*", 3))
        codec::fail_unsupported(path, "camera raw file; develop it to TIFF first");
    if (begins("II*\0", 4) || begins("MM\0*", 4) || begins("II+\0", 4) || begins("MM\0+", 4))
        return FileFormat::tiff;
    if (count < 8)
        codec::fail_damaged(path, count == 0 ? "it is empty" : "it has " + std::to_string(count) + " bytes");
    codec::fail_unsupported(path, "is not a PNG, TIFF or JPEG picture; convert it first");
}

Picture read(const codec::ReadRequest &request) {
    try {
        switch (format_of_content(request.path)) {
        case FileFormat::png:
            return codec::read_png(request);
        case FileFormat::tiff:
            return codec::read_tiff(request);
        default:
            return codec::read_jpeg(request);
        }
    } catch (const std::bad_alloc &) {
        codec::fail_unsupported(request.path, "not enough memory; close other programs or use a smaller picture");
    }
}

void check_held(const std::string &path, const Picture &picture) {
    const bool sized = picture.width > 0 && picture.height > 0 && picture.width <= picture_max_side &&
                       picture.height <= picture_max_side;
    const bool known = picture.layout <= LENSPROF_LAYOUT_RGBA && lensprof_sample_bytes(picture.sample) > 0;
    if (!sized || !known || picture.row_bytes < codec::pixel_bytes(picture) * picture.width ||
        picture.pixels.size() / picture.height < picture.row_bytes)
        throw Failure(ExitCode::failed, path + ": cannot write: no valid picture in memory; please report this");
}

/* False when the metadata could not be written. */
bool write_complete(const std::string &file, FileFormat format, const Picture &picture, const WriteOptions &options) {
    switch (format) {
    case FileFormat::png:
        codec::write_png(file, picture);
        break;
    case FileFormat::tiff:
        codec::write_tiff(file, picture);
        break;
    case FileFormat::jpeg:
        codec::write_jpeg(file, picture, options.jpeg_quality);
        break;
    }
    const bool copied = options.metadata_from.empty() || copy_metadata(options.metadata_from, file);
    const bool written = !options.metadata || write_metadata(file, *options.metadata);
    return copied && written;
}

}  // namespace

lensprof_image Picture::view() {
    return {pixels.data(), static_cast<ptrdiff_t>(row_bytes), width, height, sample, layout};
}

Picture read_picture(const std::string &path, const ReadOptions &options) {
    return read({path, options.max_side, false});
}

Picture read_header(const std::string &path, const ReadOptions &options) {
    return read({path, options.max_side, true});
}

PictureSize read_size(const std::string &path) {
    const Picture picture = read_header(path);
    return {picture.frame_width, picture.frame_height};
}

FileFormat format_of_name(const std::string &path) {
    const size_t slash = path.rfind('/');
    const std::string name = slash == std::string::npos ? path : path.substr(slash + 1);
    const size_t dot = name.rfind('.');
    std::string extension = dot == std::string::npos ? std::string() : name.substr(dot + 1);
    for (char &c : extension)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (extension == "png")
        return FileFormat::png;
    if (extension == "tif" || extension == "tiff")
        return FileFormat::tiff;
    if (extension == "jpg" || extension == "jpeg")
        return FileFormat::jpeg;
    throw Failure(ExitCode::usage, path + ": unknown kind of picture; the name must end in .png, .tif or .jpg");
}

bool write_picture(const std::string &path, const Picture &picture, const WriteOptions &options) {
    const FileFormat format = format_of_name(path);
    check_held(path, picture);
    OutputFile output(path);
    bool with_metadata = false;
    try {
        with_metadata = write_complete(output.temporary(), format, picture, options);
    } catch (const Failure &failure) {
        /* The user knows the wanted name, not the temporary one. */
        std::string text = failure.what();
        const size_t at = text.find(output.temporary());
        if (at != std::string::npos)
            text.replace(at, output.temporary().size(), path);
        throw Failure(failure.code, text);
    }
    output.commit();
    return with_metadata;
}

}  // namespace lensprof
