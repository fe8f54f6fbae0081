#include "cli/program/key_texts.hpp"

#include <lensprof/profile.h>

#include "photo/base/failure.hpp"

namespace lensprof {

std::string option_of_key(const std::string &part) {
    return (part == "camera" || part == "lens" ? "--" : "--key ") + part;
}

void require_text_sizes(const std::string &maker, const std::string &camera, const std::string &lens,
                        const std::string &unit, const std::string &style) {
    using Key = lensprof_profile_key;
    const struct {
        const char *part;
        const std::string &text;
        size_t size;
    } fields[] = {{"maker", maker, sizeof Key::camera_maker},
                  {"camera", camera, sizeof Key::camera_model},
                  {"lens", lens, sizeof Key::lens},
                  {"unit", unit, sizeof Key::unit},
                  {"style", style, sizeof Key::style}};
    for (const auto &field : fields)
        if (field.text.size() >= field.size)
            throw Failure(LENSPROF_ERROR_ARGUMENT, option_of_key(field.part) + ": is "
                                                       + std::to_string(field.text.size())
                                                       + " bytes long, but a profile stores at most "
                                                       + std::to_string(field.size - 1) + "; give a shorter text");
}

}  // namespace lensprof
