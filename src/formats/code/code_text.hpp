// Comments of source code.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <lensprof/profile.h>

#include "formats/text/numbers.hpp"

namespace lensprof {

// Text for a comment of one line, in any language: control characters, bytes that are not UTF-8, backslashes (which
// continue a line), characters that end a line or turn its direction become '_'; no comment begins or ends in it.
std::string comment_text(std::string_view text);

// Camera, lens, focal length, aperture and distance, as far as they are known; not yet safe for a comment.
std::string name_of_profile(const lensprof_profile_key &key);

// The head of a file, without the signs of a comment: what it holds, and which profile.
std::vector<std::string> head_lines(const lensprof_profile &profile, std::string_view what);

}  // namespace lensprof
