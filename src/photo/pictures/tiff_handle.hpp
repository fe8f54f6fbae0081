// An open TIFF file of libtiff. Errors are return values; messages arrive in a handler per open file. Private to
// picture_tiff.cpp and tiff_pages.cpp.
#pragma once

#include <algorithm>
#include <memory>
#include <string>

#include <tiffio.h>

#include "photo/pictures/codec.hpp"

namespace lensprof {

namespace codec {

struct TiffMessage {
    char text[200] = "";  // the first error
    int error_number = 0;
};

class StartedFile;

class Tiff {
public:
    // mode as of TIFFOpen. `directory`: the place of the one to read instead of the first; libtiff would look for it in
    // all directories of the file (TIFFSetSubDirectory, TIFFSetDirectory). 0 = the first.
    Tiff(const std::string &path, const char *mode, uint64_t directory = 0);
    ~Tiff();
    Tiff(const Tiff &) = delete;
    Tiff &operator=(const Tiff &) = delete;

    void close() {
        if (handle) TIFFClose(handle);
        handle = nullptr;
    }

    bool failed() const { return !handle || message.text[0] != '\0'; }

    template <class T>
    T field(uint32_t tag, T default_value) const {
        T value = default_value;
        return TIFFGetFieldDefaulted(handle, tag, &value) ? value : default_value;
    }

    // Bytes stored in the file for a strip or tile.
    uint64_t stored(uint32_t block) const { return std::min(TIFFGetStrileByteCount(handle, block), file_bytes()); }
    uint64_t file_bytes() const { return TIFFGetSizeProc(handle)(TIFFClientdata(handle)); }

    TiffMessage message;
    TIFF *handle = nullptr;

private:
    std::unique_ptr<StartedFile> file_;
};

}  // namespace codec

}  // namespace lensprof
