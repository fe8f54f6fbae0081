// Reads files of lines with separated fields, line by line.
#pragma once

#include <charconv>
#include <cstdint>
#include <fstream>
#include <string>

namespace lensprof {

// Every Failure is (unreadable) and names file and line.
class FieldReader {
public:
    // separator: '\0' for any number of blanks. Failure for a file that is unreadable or too large.
    FieldReader(const std::string &file, char separator, uint64_t most_bytes);

    bool next_line();            // also empty lines; false at the end
    bool next_line_of_values();  // the next line that is neither empty nor starts with #

    bool has_more() const;  // number of fields in the line
    std::string text();
    std::string rest();  // the rest of the line, with separators
    double number();     // finite

    template <class Whole>
    Whole integer() {
        const std::string field = text();
        Whole number = 0;
        const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), number);
        if (error != std::errc() || end != field.data() + field.size()) fail_at(field, "an integer");
        return number;
    }

    [[noreturn]] void fail(const std::string &problem) const;

private:
    [[noreturn]] void fail_at(const std::string &field, const char *wanted) const;
    void skip_blanks();

    std::string file_;
    char separator_;
    std::ifstream stream_;
    std::string line_;
    size_t position_ = 0;
    uint64_t number_ = 0;
};

}  // namespace lensprof
