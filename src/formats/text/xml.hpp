// XML from untrusted buffers, by pugixml: bounded, UTF-8 only, and errors with their line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

#include "formats/text/text.hpp"

namespace lensprof {

class XmlText {
public:
    // `text` must outlive this. Throws SIZE over 64 MiB or 2 million elements or attributes; SYNTAX for what is not
    // UTF-8, not well-formed or has another document element than one of these. Document types, comments and processing
    // instructions are skipped; entities but the five of XML stay as they are.
    XmlText(std::string_view text, const std::vector<std::string_view> &document_elements);

    pugi::xml_node root() const { return root_; }
    size_t line_of(const pugi::xml_node &node) const;

    // Throws SYNTAX, "line 3: LABEL...", for a text that a profile's key cannot hold.
    void check_key_text(const pugi::xml_node &node, const std::string &label, const std::string &text,
                        size_t capacity) const;

private:
    size_t line_at(size_t offset) const;

    std::string_view text_;
    pugi::xml_document document_;
    pugi::xml_node root_;
};

// Blanks and line ends as one blank, none at the ends.
std::string one_line(std::string_view text);

// Children and attributes at the end of an element, with the shortest decimals that read back the same; they throw
// std::bad_alloc, which pugixml reports in its results.
pugi::xml_node append_element(pugi::xml_node parent, const char *name);
void append_text(pugi::xml_node parent, const char *name, const std::string &text);
void append_attribute(pugi::xml_node node, const char *name, const std::string &value);
void append_number(pugi::xml_node node, const char *name, double value);
void append_remark(pugi::xml_node parent, const std::string &text);

// Indented UTF-8 without a declaration.
std::string document_text(const pugi::xml_document &document);

}  // namespace lensprof
