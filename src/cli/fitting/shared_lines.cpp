#include "cli/fitting/shared_lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ostream>
#include <regex>

#include "cli/program/help_text.hpp"
#include "photo/base/format.hpp"

namespace lensprof {
namespace {

// What the texts of findings end with: the error that they leave.
double last_number(const std::string &text) {
    const size_t end = text.find_last_of("0123456789");
    if (end == std::string::npos) return 0.0;
    const size_t before = text.find_last_not_of("0123456789.", end);
    return std::strtod(text.c_str() + (before == std::string::npos ? 0 : before + 1), nullptr);
}

}  // namespace

void SharedLines::add_alike(const std::string &text, const std::string &item) {
    static const std::regex numbers(R"(\d+(?:\.\d+)?)");
    add(std::regex_replace(text, numbers, "#"), text, item);
}

void SharedLines::print(const char *start, std::ostream &out, const char *what) const {
    for (const Line &line : lines_) {
        out << start << one_line(line.item);
        if (line.differs)
            out << ", the largest of " << counted(line.count, what);
        else if (line.count > 1)
            out << " and " << line.count - 1 << " more";
        out << (line.item.empty() ? "" : ": ") << one_line(line.text) << "\n";
    }
}

void SharedLines::add(const std::string &kind, const std::string &text, const std::string &item) {
    const auto same = std::find_if(lines_.begin(), lines_.end(), [&](const Line &line) { return line.kind == kind; });
    if (same == lines_.end()) {
        lines_.push_back({kind, text, item});
        return;
    }
    same->count++;
    same->differs |= same->text != text;
    if (last_number(text) > last_number(same->text)) same->text = text, same->item = item;
}

void print_left_out(const std::vector<LeftOutCard> &left_out, size_t given, std::ostream &out) {
    if (left_out.empty()) return;
    out << "left out  " << left_out.size() << " of " << counted(given, "picture") << "\n";
    SharedLines lines;
    for (const LeftOutCard &card : left_out) {
        const bool is_named = card.reason.rfind(card.file + ": ", 0) == 0;
        lines.add(is_named ? card.reason.substr(card.file.size() + 2) : card.reason, card.file);
    }
    lines.print("  ", out);
}

std::string csv_cell(const std::string &text) {
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

std::string csv_number(double value) {
    return value == LENSPROF_UNKNOWN || std::isnan(value) ? "" : format("%.6g", value);
}

}  // namespace lensprof
