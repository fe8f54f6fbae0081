#include "formats/text/xml.hpp"

#include <algorithm>

namespace lensprof {
namespace {

constexpr size_t kMaxBytes = size_t{64} << 20;
// pugixml takes about 64 bytes an element and 40 an attribute, more than their text may have.
constexpr ptrdiff_t kMaxItems = 2000000;

void check_size(std::string_view text) {
    if (text.size() > kMaxBytes) throw FormatFailure{LENSPROF_ERROR_SIZE, "over 64 MiB of XML; split the file"};
    const auto count = [&](char c) { return std::count(text.begin(), text.end(), c); };
    if (count('<') > kMaxItems || count('=') > kMaxItems)
        throw FormatFailure{LENSPROF_ERROR_SIZE, "over 2 million elements or attributes; split the file"};
}

class StringWriter : public pugi::xml_writer {
public:
    void write(const void *data, size_t size) override { text.append(static_cast<const char *>(data), size); }
    std::string text;
};

void demand_memory(bool done) {
    if (!done) throw std::bad_alloc();
}

}  // namespace

XmlText::XmlText(std::string_view text, const std::vector<std::string_view> &document_elements) : text_(text) {
    check_size(text);
    const size_t wrong = find_not_utf8(text);
    if (wrong < text.size() || text.find('\0') < text.size())
        fail_at_line(line_at(std::min(wrong, text.find('\0'))),
                     "not UTF-8 text; convert the file, or give an XML file");
    constexpr unsigned int kFlags =
        pugi::parse_minimal | pugi::parse_cdata | pugi::parse_escapes | pugi::parse_eol | pugi::parse_wconv_attribute;
    const pugi::xml_parse_result result = document_.load_buffer(text.data(), text.size(), kFlags, pugi::encoding_utf8);
    if (result.status == pugi::status_out_of_memory) throw std::bad_alloc();
    if (!result)
        fail_at_line(line_at(static_cast<size_t>(result.offset)),
                     std::string("not well-formed XML (") + result.description() + "); correct the file");
    for (pugi::xml_node node : document_.children()) {
        if (root_ || !std::count(document_elements.begin(), document_elements.end(), node.name()))
            fail_at_line(line_of(node), "<" + std::string(document_elements[0]) + "> must be the only outermost element, "
                                            "not " + in_quotes(node.name()) + "; give another file");
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

void XmlText::check_key_text(const pugi::xml_node &node, const std::string &label, const std::string &text,
                             size_t capacity) const {
    const auto fail = [&](const std::string &message) {
        fail_at_line(line_of(node), label + in_quotes(text) + message);
    };
    if (text.size() >= capacity) fail(" is longer than " + std::to_string(capacity - 1) + " bytes; shorten it");
    if (find_not_utf8(text) < text.size())  // by a character reference
        fail(" has invalid characters; remove them");
    for (char c : text)
        if ((c > 0 && c < ' ') || c == 127) fail(" has control characters; remove them");
}

std::string one_line(std::string_view text) {
    std::string line;
    for (char c : text) {
        const bool blank = c == ' ' || (c >= '\t' && c <= '\r');
        if (!blank)
            line += c;
        else if (!line.empty() && line.back() != ' ')
            line += ' ';
    }
    if (!line.empty() && line.back() == ' ') line.pop_back();
    return line;
}

pugi::xml_node append_element(pugi::xml_node parent, const char *name) {
    const pugi::xml_node node = parent.append_child(name);
    demand_memory(node);
    return node;
}

void append_text(pugi::xml_node parent, const char *name, const std::string &text) {
    demand_memory(append_element(parent, name).text().set(text.c_str()));
}

void append_attribute(pugi::xml_node node, const char *name, const std::string &value) {
    demand_memory(node.append_attribute(name).set_value(value.c_str()));
}

void append_number(pugi::xml_node node, const char *name, double value) {
    append_attribute(node, name, number_text(value));
}

void append_remark(pugi::xml_node parent, const std::string &text) {
    demand_memory(parent.append_child(pugi::node_comment).set_value(text.c_str()));
}

std::string document_text(const pugi::xml_document &document) {
    StringWriter writer;
    document.save(writer, "    ", pugi::format_indent | pugi::format_no_declaration, pugi::encoding_utf8);
    return writer.text;
}

}  // namespace lensprof
