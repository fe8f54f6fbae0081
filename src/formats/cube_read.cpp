// Adobe's cube format (.cube), of one dimension: a response.
#include <algorithm>
#include <array>
#include <cmath>

#include "formats/each_format.h"

#include "formats/responses.hpp"

namespace lensprof {
namespace {

constexpr size_t kMaxBytes = size_t{64} << 20;
constexpr const char *kMark = "\xEF\xBB\xBF";  // byte order mark of UTF-8

bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_'; }

std::vector<double> read_numbers(std::string_view words, size_t line) {
    std::vector<double> values;
    for (std::string_view word = next_word(words); !word.empty(); word = next_word(words)) {
        double value;
        if (!read_number(word, value)) fail_at_line(line, in_quotes(word) + " is not a finite number; correct it");
        values.push_back(value);
    }
    return values;
}

class CubeText {
public:
    explicit CubeText(std::string_view text) {
        if (text.size() > kMaxBytes)
            throw FormatFailure{LENSPROF_ERROR_SIZE, "over 64 MiB; give a one-dimensional table"};
        if (text.substr(0, 3) == kMark) text.remove_prefix(3);
        LineReader lines(text);
        while (lines.next()) add_line(lines.line, lines.number);
        if (!rows_) throw FormatFailure{LENSPROF_ERROR_SYNTAX, "has no LUT_1D_SIZE; give a cube of one dimension"};
        if (count() < rows_)
            throw FormatFailure{LENSPROF_ERROR_SYNTAX, std::to_string(count()) + " rows, but LUT_1D_SIZE is "
                                                           + std::to_string(rows_) + "; copy the file again"};
    }

    const std::array<TableColumn, 3> &columns() const { return columns_; }

private:
    size_t count() const { return columns_[0].values.size(); }

    void add_line(std::string_view line, size_t number) {
        std::string_view rest = line;
        const std::string_view word = next_word(rest);
        if (word.empty() || word[0] == '#') return;
        if (is_letter(word[0]) && word != "nan" && word != "inf")
            add_keyword(word, rest, number);
        else
            add_row(line, number);
    }

    void add_keyword(std::string_view word, std::string_view rest, size_t line) {
        if (word == "TITLE") return;
        if (word == "LUT_3D_SIZE" || word == "LUT_3D_INPUT_RANGE")
            fail_at_line(line, std::string(word) + ": the table has three dimensions, and a response has one; give a "
                                                   "table with LUT_1D_SIZE", LENSPROF_ERROR_UNSUPPORTED);
        if (count()) fail_at_line(line, in_quotes(word) + " after the first row; correct it");
        const std::vector<double> values = read_numbers(rest, line);
        if (word == "LUT_1D_SIZE")
            set_size(values, line);
        else if (word == "DOMAIN_MIN" || word == "DOMAIN_MAX")
            check_domain(word, values, std::vector<double>(3, word == "DOMAIN_MAX"), line);
        else if (word == "LUT_1D_INPUT_RANGE")
            check_domain(word, values, {0.0, 1.0}, line);
        else
            fail_at_line(line, in_quotes(word) + " is not a word of the format; remove the line");
    }

    void set_size(const std::vector<double> &values, size_t line) {
        if (rows_) fail_at_line(line, "a second LUT_1D_SIZE; remove it");
        if (values.size() != 1 || values[0] != std::floor(values[0]) || values[0] < 2.0)
            fail_at_line(line, "LUT_1D_SIZE is not a whole number of at least 2; correct it");
        if (values[0] > kMaxCurveRows)
            fail_at_line(line, "LUT_1D_SIZE is over 65536; give a shorter table", LENSPROF_ERROR_SIZE);
        rows_ = static_cast<size_t>(values[0]);
    }

    static void check_domain(std::string_view word, const std::vector<double> &values,
                             const std::vector<double> &supported, size_t line) {
        if (values.size() != supported.size())
            fail_at_line(line, std::string(word) + " has " + std::to_string(values.size()) + " numbers, not "
                                   + std::to_string(supported.size()) + "; correct it");
        if (values != supported)
            fail_at_line(line, std::string(word) + ": only tables of the domain 0 to 1 are supported; resample it",
                         LENSPROF_ERROR_UNSUPPORTED);
    }

    void add_row(std::string_view line, size_t number) {
        const std::vector<double> values = read_numbers(line, number);
        if (!rows_) fail_at_line(number, "a row before LUT_1D_SIZE; give a cube of one dimension");
        if (values.size() != 3)
            fail_at_line(number, std::to_string(values.size()) + " numbers instead of 3; correct it");
        if (count() == rows_)
            fail_at_line(number, "more than the " + std::to_string(rows_) + " rows of LUT_1D_SIZE; correct it");
        for (size_t c = 0; c < 3; c++) {
            columns_[c].values.push_back(values[c]);
            columns_[c].lines.push_back(number);
        }
    }

    size_t rows_ = 0;
    std::array<TableColumn, 3> columns_;
};

}  // namespace

void check_cube_curve(uint32_t curve) {
    if (curve != LENSPROF_CURVE_INVERSE && curve != LENSPROF_CURVE_FORWARD)
        throw FormatFailure{LENSPROF_ERROR_UNSUPPORTED,
                            "a cube holds light or grey values, not logarithms; choose the inverse or forward curve"};
}

uint32_t read_cube(std::string_view text, uint32_t curve, Repair &repair, lensprof_response *responses) {
    check_cube_curve(curve);
    const CubeText cube(text);
    const std::array<TableColumn, 3> &columns = cube.columns();
    const bool is_one = columns[0].values == columns[1].values && columns[0].values == columns[2].values;
    const uint32_t count = is_one ? 1 : 3;
    std::array<lensprof_response, 3> found{};
    for (uint32_t c = 0; c < count; c++) found[c] = response_of_column(columns[c], curve, repair);
    std::copy_n(found.begin(), count, responses);
    return count;
}

}  // namespace lensprof

using namespace lensprof;

lensprof_status lp_cube_read(const void *data, size_t size, uint32_t curve, lensprof_response *responses,
                             uint32_t *count, lensprof_error *error) {
    if ((!data && size) || !responses || !count) {
        set_error(error, "lensprof_import: data, responses or count is NULL; pass a buffer and responses");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return at_boundary(error, [&] {
        Repair none;
        *count = read_cube(view_of(data, size), curve, none, responses);
    });
}
