// A mark in a picture's XMP that records what lensprof did, so that a falloff is not corrected twice and an output is
// not mistaken for that of another picture.
#pragma once

#include <optional>
#include <string>

namespace lensprof {

class Xmp;

// Properties of the namespace urn:lensprof:correction:1/ (docs/formats.md).
struct CorrectionMark {
    enum class Falloff {
        kept,     // only exposure, white balance or encoding changed
        removed,  // corrected: must not be corrected again
        added     // simulated
    };

    Falloff falloff = Falloff::kept;
    bool linear = false;                // proportional to light
    bool is_exposure_measured = false;  // EXIF holds the exposure measured by lensprof, not the one stated by the
                                        // camera
    std::string software;               // "lensprof 0.3.0"
    std::string model;                  // source of falloff and response
    std::string source;                 // name of the source picture, without folder
    std::string digest;                 // digest_of that file
};

// Sixteen hexadecimal digits (FNV-1a) of a file's size and its first and last 64 KiB, enough to distinguish
// photographs. Failure (unreadable).
std::string digest_of(const std::string &path);

std::optional<CorrectionMark> correction_mark_of(const Xmp &xmp);

// Replaces an older mark. A new mark that keeps the falloff retains the older mark's statement about it.
void set_correction_mark(const CorrectionMark &mark, Xmp &xmp);

}  // namespace lensprof
