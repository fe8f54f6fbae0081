// The options that state the texts of a profile key.
#pragma once

#include <string>

namespace lensprof {

// The option of a part of the key: "--camera" of "camera", "--key maker" of "maker".
std::string option_of_key(const std::string &part);

// Failure (ARGUMENT) if the text of --camera, --lens or of a key of --key is too long for its field of the key.
void require_text_sizes(const std::string &maker, const std::string &camera, const std::string &lens,
                        const std::string &unit, const std::string &style);

}  // namespace lensprof
