#include "photo/pictures/picture.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <new>
#include <optional>
#include <string_view>

#include "photo/base/failure.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/pictures/codec.hpp"
#include "photo/pictures/coded_kind.hpp"
#include "photo/pictures/other_parts.hpp"
#include "photo/pictures/raw_file.hpp"
#include "photo/pictures/raw_kind.hpp"
#include "photo/pictures/row_reducer.hpp"

namespace lensprof {

namespace {

// For pictures that are neither camera raw files nor of coded_kind.
FileFormat format_of_content(const std::string &path) {
    const codec::File file = codec::open_for_reading(path);
    unsigned char start[12] = {};
    const size_t count = std::fread(start, 1, sizeof start, file.get());
    const auto begins = [&](std::string_view bytes) {
        return count >= bytes.size() && std::memcmp(start, bytes.data(), bytes.size()) == 0;
    };
    if (begins("\x89PNG\r\n\x1a\n")) return FileFormat::png;
    if (begins("\xff\xd8\xff")) return FileFormat::jpeg;
    using namespace std::string_view_literals;
    if (begins("II*\0"sv) || begins("MM\0*"sv) || begins("II+\0"sv) || begins("MM\0+"sv)) return FileFormat::tiff;
    if (count < 8) codec::fail_damaged(path, count == 0 ? "it is empty" : "it has " + std::to_string(count) + " bytes");
    codec::fail_unsupported(
        path,
        "is not a PNG, TIFF, JPEG, HEIC, AVIF, WebP, JPEG XL or FITS picture, nor a camera raw file; convert it "
        "first");
}

// Runs `read`, with a specific message if memory is insufficient.
template <class Read>
auto reading(const std::string &path, const Read &read) -> decltype(read()) {
    try {
        return read();
    } catch (const std::bad_alloc &) {
        codec::fail_memory(path);
    }
}

std::unique_ptr<codec::RowSource> open_coded(const codec::ReadRequest &request, const CodedKind &kind) {
    switch (kind.format) {
    case FileFormat::webp: return codec::open_webp(request);
    case FileFormat::jxl: return codec::open_jxl(request);
    case FileFormat::fits: return codec::open_fits(request);
    default: return codec::open_heif(request, kind.name);
    }
}

std::unique_ptr<codec::RowSource> open_source(const codec::ReadRequest &request) {
    if (const auto kind = raw_kind(request.path)) return codec::open_raw(request, *kind);
    if (const auto coded = coded_kind(request.path)) return open_coded(request, *coded);
    switch (format_of_content(request.path)) {
    case FileFormat::png: return codec::open_png(request);
    case FileFormat::tiff: return codec::open_tiff(request);
    default: return codec::open_jpeg(request);
    }
}

std::unique_ptr<codec::RowSink> create_sink(const std::string &file, FileFormat format, const Picture &header,
                                            const WriteOptions &options) {
    switch (format) {
    case FileFormat::png: return codec::create_png(file, header);
    case FileFormat::tiff: return codec::create_tiff(file, header);
    case FileFormat::exr:
        return codec::create_exr(file, header, options.mark ? packet_of_mark(*options.mark) : std::string());
    default: return codec::create_jpeg(file, header, options.jpeg_quality);
    }
}

Picture read_rows(codec::RowSource &source) {
    Picture picture = source.header();
    codec::RowReducer reducer(picture, source.row_width(), source.halved());
    for (uint32_t y = 0; y < source.row_count(); ++y) {
        source.read(reducer.row());
        reducer.accept();
    }
    source.finish();
    return picture;
}

void check_held(const std::string &path, const Picture &picture) {
    const bool sized = picture.width > 0 && picture.height > 0 && picture.width <= picture_max_side
                       && picture.height <= picture_max_side;
    const bool known = picture.layout <= LENSPROF_LAYOUT_RGBA && lensprof_sample_type_bytes(picture.sample) > 0;
    if (!sized || !known || picture.row_bytes < codec::pixel_bytes(picture) * picture.width
        || picture.pixels.size() / picture.height < picture.row_bytes)
        throw Failure(LENSPROF_ERROR_WRITE, path + ": cannot write: internal error: invalid picture in memory; please "
                                               "report this");
}

}  // namespace

lensprof_image Picture::view() const {
    return {pixels.data(), static_cast<ptrdiff_t>(row_bytes), width, height, sample, layout};
}

lensprof_target Picture::target() {
    return {pixels.data(), static_cast<ptrdiff_t>(row_bytes), width, height, sample, layout};
}

Picture read_picture(const std::string &path, const ReadOptions &options) {
    return reading(path, [&] {
        const auto source = open_source({path, options.max_side, nullptr, options.page, options.page_offset});
        return read_rows(*source);
    });
}

Picture read_raw_preview(const std::string &path, const ReadOptions &options) {
    const auto kind = raw_kind(path);
    if (!kind) {
        codec::open_for_reading(path);  // for its errors
        codec::fail_unsupported(path, "not a camera raw file, which alone has a preview; give one");
    }
    return reading(path, [&] {
        const std::vector<uint8_t> bytes = codec::raw_preview_bytes(path, *kind);
        const auto source = codec::open_jpeg({path, options.max_side, &bytes});
        return read_rows(*source);
    });
}

Picture read_header(const std::string &path, const ReadOptions &options) {
    return reading(path, [&] {
        return open_source({path, options.max_side, nullptr, options.page, options.page_offset})->header();
    });
}

PictureReader::PictureReader(const std::string &path)
    : path_(path), source_(reading(path, [&] {
          return open_source({path, 0, nullptr});
      })) {}

PictureReader::~PictureReader() = default;

const Picture &PictureReader::header() const { return source_->header(); }

void PictureReader::read(const lensprof_target &rows) {
    reading(path_, [&] {
        for (uint32_t y = 0; y < rows.height; ++y)
            source_->read(static_cast<uint8_t *>(rows.data) + static_cast<ptrdiff_t>(y) * rows.row_bytes);
        done_ += rows.height;
        if (done_ == source_->row_count()) source_->finish();
    });
}

PictureSize read_size(const std::string &path) {
    const Picture picture = read_header(path);
    return {picture.frame_width, picture.frame_height};
}

static std::optional<FileFormat> known_format(const std::string &path) {
    const std::string extension = lowercase_extension(path);
    if (extension == "png") return FileFormat::png;
    if (extension == "tif" || extension == "tiff") return FileFormat::tiff;
    if (extension == "jpg" || extension == "jpeg" || extension == "mpo") return FileFormat::jpeg;
    if (extension == "exr") return FileFormat::exr;
    return std::nullopt;
}

bool is_picture_name(const std::string &path) {
    return known_format(path).value_or(FileFormat::exr) != FileFormat::exr || is_raw_name(path)
           || coded_kind_of_name(path);
}

FileFormat format_of_name(const std::string &path) {
    const auto format = known_format(path);
    if (format == FileFormat::exr && !can_write_exr())
        throw Failure(LENSPROF_ERROR_ARGUMENT, path + ": this lensprof was built without OpenEXR; install libopenexr-dev and "
                                              "rebuild lensprof, or give a name ending in .tif");
    if (format) return *format;
    if (const auto coded = coded_kind_of_name(path))
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      path + ": lensprof reads " + coded->name
                          + " but does not write it; give a name ending in .tif, .png or .jpg");
    throw Failure(LENSPROF_ERROR_ARGUMENT, path + ": unknown picture format; give a name ending in .png, .tif, .jpg or, for "
                                          "irradiance, .exr");
}

// The user knows the final name, not the temporary one.
template <class Call>
auto PictureWriter::named(const Call &call) -> decltype(call()) {
    try {
        return call();
    } catch (const Failure &failure) {
        std::string text = failure.what();
        const size_t position = text.find(output_->temporary());
        if (position != std::string::npos) text.replace(position, output_->temporary().size(), path_);
        throw Failure(failure.status, text);
    }
}

PictureWriter::PictureWriter(const std::string &path, const Picture &header, const WriteOptions &options)
    : path_(path), options_(options) {
    const FileFormat format = format_of_name(path);
    output_ = std::make_unique<OutputFile>(path);
    sink_ = named([&] { return create_sink(output_->temporary(), format, header, options); });
}

PictureWriter::~PictureWriter() = default;

void PictureWriter::write(const lensprof_image &rows) {
    named([&] {
        for (uint32_t y = 0; y < rows.height; ++y)
            sink_->write(static_cast<const uint8_t *>(rows.data) + static_cast<ptrdiff_t>(y) * rows.row_bytes);
    });
}

bool PictureWriter::finish() {
    return named([&] {
        const std::string &file = output_->temporary();
        sink_->finish();
        sink_.reset();
        if (format_of_name(path_) == FileFormat::exr) {
            output_->sync();
            return true;
        }
        const bool copied = options_.metadata_from.empty()
                            || copy_metadata(options_.metadata_from, file, options_.mark ? &*options_.mark : nullptr);
        const bool written = !options_.metadata || write_metadata(file, *options_.metadata);
        if (!options_.metadata_from.empty()) append_kept_parts(options_.metadata_from, file);
        output_->sync();
        return copied && written;
    });
}

void PictureWriter::commit() { output_->commit(); }

bool write_picture(const std::string &path, const Picture &picture, const WriteOptions &options) {
    format_of_name(path);
    check_held(path, picture);
    PictureWriter writer(path, picture, options);
    writer.write(picture.view());
    const bool with_metadata = writer.finish();
    writer.commit();
    return with_metadata;
}

}  // namespace lensprof
