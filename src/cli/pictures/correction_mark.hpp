// What lensprof did to a picture, as a mark in the picture's XMP: so that a falloff is not taken out twice, and that an
// output is not taken for that of another picture.
#pragma once

#include <optional>
#include <string>

namespace Exiv2 {
class XmpData;
}

namespace lensprof {

// Properties of the namespace urn:lensprof:correction:1/ (docs/formats.md).
struct CorrectionMark {
    enum class Falloff {
        kept,     // exposure, white balance or encoding alone changed
        removed,  // must not be removed again
        added     // simulated
    };

    Falloff falloff = Falloff::kept;
    bool linear = false;                // proportional to light
    bool is_exposure_measured = false;  // EXIF's exposure is what lensprof measured, and not what the camera states
    std::string software;               // "lensprof 0.2.0"
    std::string model;                  // what falloff and response are those of
    std::string source;                 // name of the picture that it was made from, without folder
    std::string digest;                 // of that file: digest_of
};

// Sixteen hexadecimal digits (FNV-1a) of a file's size, its first and its last 64 KiB, which tell photographs apart.
// Failure (unreadable).
std::string digest_of(const std::string &path);

// Once, before XMP is read or written.
void register_correction_mark();

std::optional<CorrectionMark> correction_mark_of(const Exiv2::XmpData &xmp);

// In the place of an older one, of which a mark that keeps the falloff keeps what was said about that.
void set_correction_mark(const CorrectionMark &mark, Exiv2::XmpData &xmp);

}  // namespace lensprof
