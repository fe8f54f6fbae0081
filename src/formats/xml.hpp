// XML from untrusted buffers, by pugixml: bounded, UTF-8 only, and errors with their line.
#pragma once

#include <string>
#include <string_view>

#include <pugixml.hpp>

#include "text.hpp"

namespace lensprof {

class XmlText {
public:
    // `text` must outlive this. Throws SIZE over 64 MiB or 2 million elements or attributes; SYNTAX for what is not
    // UTF-8, not well-formed or has another document element. Document types, comments and processing instructions are
    // skipped; entities but the five of XML stay as they are.
    XmlText(std::string_view text, const char *document_element);

    pugi::xml_node root() const { return root_; }
    size_t line_of(const pugi::xml_node &node) const;

private:
    size_t line_at(size_t offset) const;

    std::string_view text_;
    pugi::xml_document document_;
    pugi::xml_node root_;
};

}  // namespace lensprof
