// Pictures and other data in a file in addition to the picture that is read.
#pragma once

#include <string>
#include <vector>

#include "photo/base/events.hpp"
#include "photo/pictures/jpeg_parts.hpp"

namespace lensprof {

// Pictures of their own, of which one is read: pages, frames, views. Not those of a camera raw file.
struct SeveralPictures {
    std::string what;       // "has 40 pages"; empty if there is one picture
    std::string next_step;  // how to split the file
    bool is_stack = false;  // picture_stack lists them: pages, slices and planes
};

SeveralPictures several_pictures(const std::string &path);

// Notes which files hold several pictures, of which the first one is used. `stack_advice`: the end of a note on a
// stack.
void note_several(const std::vector<std::string> &files, Events &events, const std::string &stack_advice = {});

// Parts that belong to the picture, and what becomes of them in a corrected copy. A JPEG keeps those that stay valid;
// thumbnails, which no copy has, are not listed.
struct OtherParts {
    std::vector<codec::ByteRange> kept;  // of the source; tags that refer to them stay
    std::vector<std::string> left_out;   // for messages
};

// Empty for files that cannot be read.
OtherParts other_parts(const std::string &source, const std::string &target);

// Appends to a finished copy what it keeps of its source.
void append_kept_parts(const std::string &source, const std::string &target);

}  // namespace lensprof
