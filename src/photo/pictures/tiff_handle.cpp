#include "photo/pictures/tiff_handle.hpp"

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <new>

#include "photo/system/system.hpp"

namespace lensprof {

namespace codec {

namespace {

int on_error(TIFF *, void *data, const char *, const char *format, va_list arguments) {
    TiffMessage *message = static_cast<TiffMessage *>(data);
    if (message->text[0] == '\0') {
        message->error_number = errno;
        vsnprintf(message->text, sizeof message->text, format, arguments);
    }
    return 1;
}

// libjpeg inside libtiff only warns about damage and invents the missing pixels.
int on_warning(TIFF *tiff, void *data, const char *module, const char *format, va_list arguments) {
    va_list copy;
    va_copy(copy, arguments);
    char text[200] = "";
    vsnprintf(text, sizeof text, format, copy);
    va_end(copy);
    const bool damage = std::strstr(text, "Premature end")
                        || (std::strstr(text, "Corrupt JPEG data") && !std::strstr(text, "extraneous"));
    if (module && std::strcmp(module, "JPEGLib") == 0 && damage) on_error(tiff, data, module, format, arguments);
    return 1;
}

// TIFF 6.0, section 2, and BigTIFF: where the header has the place of the first directory, and its bytes.
struct HeaderField {
    size_t at, bytes;
};

HeaderField first_directory_of(const uint8_t *header) {
    const bool is_big_tiff = header[2] + header[3] == 43;  // one of them is 0
    return is_big_tiff ? HeaderField{8, 8} : HeaderField{4, 4};
}

}  // namespace

// A file whose header names another directory as the first.
class StartedFile {
public:
    StartedFile(const std::string &path, uint64_t directory) : file_(open_for_reading(path)) {
        const size_t count = std::fread(header_, 1, sizeof header_, file_.get());
        const HeaderField field = first_directory_of(header_);
        const bool is_big_endian = header_[0] == 'M';
        for (size_t i = 0; i < field.bytes; i++)
            header_[field.at + (is_big_endian ? field.bytes - 1 - i : i)] = static_cast<uint8_t>(directory >> 8 * i);
        header_bytes_ = std::min(count, field.at + field.bytes);
        std::rewind(file_.get());
    }

    static tmsize_t read(thandle_t self, void *to, tmsize_t size) {
        StartedFile &f = *static_cast<StartedFile *>(self);
        const auto start = static_cast<uint64_t>(system::tell(f.file_.get()));
        const size_t count = std::fread(to, 1, static_cast<size_t>(size), f.file_.get());
        for (uint64_t i = start; i < std::min<uint64_t>(f.header_bytes_, start + count); i++)
            static_cast<uint8_t *>(to)[i - start] = f.header_[i];
        return static_cast<tmsize_t>(count);
    }
    static tmsize_t write(thandle_t, void *, tmsize_t) { return 0; }
    static toff_t seek(thandle_t self, toff_t offset, int whence) {
        std::FILE *file = static_cast<StartedFile *>(self)->file_.get();
        const bool is_sought = system::seek(file, static_cast<int64_t>(offset), whence);
        return is_sought ? static_cast<toff_t>(system::tell(file)) : static_cast<toff_t>(-1);
    }
    static int close(thandle_t) { return 0; }  // by its owner
    static toff_t size(thandle_t self) { return file_bytes(static_cast<StartedFile *>(self)->file_.get()); }

private:
    File file_;
    uint8_t header_[16] = {};
    uint64_t header_bytes_ = 0;
};

Tiff::~Tiff() { close(); }

Tiff::Tiff(const std::string &path, const char *mode, uint64_t directory) {
    std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions *)> options(TIFFOpenOptionsAlloc(), TIFFOpenOptionsFree);
    if (!options) throw std::bad_alloc();
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), on_error, &message);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), on_warning, &message);
    if (!directory) {
        handle = TIFFOpenExt(path.c_str(), mode, options.get());
        return;
    }
    file_ = std::make_unique<StartedFile>(path, directory);
    handle =
        TIFFClientOpenExt(path.c_str(), mode, file_.get(), StartedFile::read, StartedFile::write, StartedFile::seek,
                          StartedFile::close, StartedFile::size, nullptr, nullptr, options.get());
}

}  // namespace codec

}  // namespace lensprof
