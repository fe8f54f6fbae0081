// Files of lines whose fields are separated, read line by line.
#pragma once

#include <charconv>
#include <cstdint>
#include <fstream>
#include <string>

namespace lensprof {

// Every failure is (unreadable) and names file and line.
class FieldReader {
public:
    // separator: '\0' for blanks, as many as there are. Failure for a file that cannot be read or is too large.
    FieldReader(const std::string &file, char separator, uint64_t most_bytes);

    bool next_line();            // also an empty one; false at the end
    bool next_line_of_values();  // the next one that is neither empty nor begins with #

    bool has_more() const;  // fields in the line
    std::string text();
    std::string rest();  // of the line, separators and all
    double number();     // finite

    template <class Whole>
    Whole whole() {
        const std::string field = text();
        Whole number = 0;
        const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), number);
        if (error != std::errc() || end != field.data() + field.size()) fail_at(field, "a whole number");
        return number;
    }

    [[noreturn]] void fail(const std::string &what) const;

private:
    [[noreturn]] void fail_at(const std::string &field, const char *wanted) const;
    void skip_blanks();

    std::string file_;
    char separator_;
    std::ifstream stream_;
    std::string line_;
    size_t at_ = 0;
    uint64_t number_ = 0;
};

}  // namespace lensprof
