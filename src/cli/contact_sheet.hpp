/* contact_sheet.hpp - an overview picture: every picture before, and below it after. */
#ifndef LENSPROF_CLI_CONTACT_SHEET_HPP
#define LENSPROF_CLI_CONTACT_SHEET_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "picture.hpp"

namespace lensprof {

class ContactSheet {
public:
    /* Keeps small copies (box means, 8 bit RGB). */
    void add(const Picture &before, const Picture &after);

    /* PNG. */
    void write(const std::string &path) const;

private:
    struct Thumbnail {
        uint32_t width, height;
        std::vector<uint8_t> rgb;
    };
    static Thumbnail shrink(const Picture &picture);

    std::vector<Thumbnail> before_, after_;
};

}  // namespace lensprof

#endif
