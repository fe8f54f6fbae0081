#include "xml.hpp"

#include <algorithm>

namespace lensprof {
namespace {

constexpr size_t kMostBytes = size_t{64} << 20;
// pugixml takes about 64 bytes an element and 40 an attribute, more than their text may have.
constexpr ptrdiff_t kMostItems = 2000000;

void check_size(std::string_view text) {
    if (text.size() > kMostBytes) throw FormatFailure{LENSPROF_ERROR_SIZE, "over 64 MiB of XML; split the file"};
    const auto count = [&](char c) { return std::count(text.begin(), text.end(), c); };
    if (count('<') > kMostItems || count('=') > kMostItems)
        throw FormatFailure{LENSPROF_ERROR_SIZE, "over 2 million elements or attributes; split the file"};
}

}  // namespace

XmlText::XmlText(std::string_view text, const char *document_element) : text_(text) {
    check_size(text);
    const size_t wrong = find_not_utf8(text);
    if (wrong < text.size() || text.find('\0') < text.size())
        fail_at_line(line_at(std::min(wrong, text.find('\0'))), "not UTF-8 text; convert the file, or give one of XML");
    constexpr unsigned int kFlags = pugi::parse_minimal | pugi::parse_cdata | pugi::parse_escapes | pugi::parse_eol
                                    | pugi::parse_wconv_attribute;
    const pugi::xml_parse_result result = document_.load_buffer(text.data(), text.size(), kFlags, pugi::encoding_utf8);
    if (result.status == pugi::status_out_of_memory) throw std::bad_alloc();
    if (!result)
        fail_at_line(line_at(static_cast<size_t>(result.offset)),
                     std::string("not well-formed XML (") + result.description() + "); correct the file");
    for (pugi::xml_node node : document_.children()) {
        if (root_ || std::string_view(node.name()) != document_element)
            fail_at_line(line_of(node), "<" + std::string(document_element) + "> must be the only outermost element, "
                                            "not " + quoted(node.name()) + "; give another file");
        root_ = node;
    }
}

size_t XmlText::line_of(const pugi::xml_node &node) const {
    const ptrdiff_t offset = node.offset_debug();
    return line_at(offset > 0 ? static_cast<size_t>(offset) : 0);
}

size_t XmlText::line_at(size_t offset) const {
    const std::string_view before = text_.substr(0, std::min(offset, text_.size()));
    return 1 + static_cast<size_t>(std::count(before.begin(), before.end(), '\n'));
}

}  // namespace lensprof
