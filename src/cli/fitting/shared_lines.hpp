// Texts of many items: as lines, of which those that several share are printed once, and as cells of a table.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "photo/cards/card_settings.hpp"

namespace lensprof {

// Lines that several settings or files share are printed once, with the first of them.
class SharedLines {
public:
    void add(const std::string &text, const std::string &item) { add(text, text, item); }

    // Also shared if only numbers differ: the line of the setting with the largest is printed.
    void add_alike(const std::string &text, const std::string &item);

    // `what`: the items, in the singular.
    void print(const char *start, std::ostream &out, const char *what = "setting") const;

private:
    struct Line {
        std::string kind, text, item;
        size_t count = 1;
        bool differs = false;
    };

    void add(const std::string &kind, const std::string &text, const std::string &item);

    std::vector<Line> lines_;
};

// How many pictures were left out, and why.
void print_left_out(const std::vector<LeftOutCard> &left_out, size_t given, std::ostream &out);

// Cells of a CSV file: in quotes where they need them; empty for a number that is unknown.
std::string csv_cell(const std::string &text);
std::string csv_number(double value);

}  // namespace lensprof
