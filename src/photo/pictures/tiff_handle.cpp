#include "photo/pictures/tiff_handle.hpp"

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <new>

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

}  // namespace

Tiff::Tiff(const std::string &path, const char *mode) {
    std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions *)> options(TIFFOpenOptionsAlloc(), TIFFOpenOptionsFree);
    if (!options) throw std::bad_alloc();
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), on_error, &message);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), on_warning, &message);
    handle = TIFFOpenExt(path.c_str(), mode, options.get());
}

}  // namespace codec

}  // namespace lensprof
