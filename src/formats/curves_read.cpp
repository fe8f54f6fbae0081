// Response curves as tables of text: CSV of OpenCV, AliceVision and others, and pfstools' .m.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "formats/each_format.h"

#include "formats/responses.hpp"

namespace lensprof {
namespace {

constexpr size_t kMaxBytes = size_t{64} << 20;
constexpr double kEven = 1e-4;  // of a step, that the first column may be off by rounding

struct Row {
    size_t line;
    std::vector<double> values;
};

// One table, or one a channel of pfstools.
struct Table {
    std::string name;
    std::vector<Row> rows;
};

bool is_separator(char c) { return is_blank(c) || c == ',' || c == ';' || c == '[' || c == ']'; }

std::vector<std::string_view> split(std::string_view line) {
    std::vector<std::string_view> words;
    for (size_t position = 0; position < line.size();) {
        if (is_separator(line[position])) {
            position++;
            continue;
        }
        const size_t begin = position;
        while (position < line.size() && !is_separator(line[position])) position++;
        words.push_back(line.substr(begin, position - begin));
    }
    return words;
}

class CurveText {
public:
    explicit CurveText(std::string_view text) {
        if (text.size() > kMaxBytes)
            throw FormatFailure{LENSPROF_ERROR_SIZE, "over 64 MiB; give a table of a response"};
        LineReader lines(text);
        while (lines.next()) add_line(lines.line, lines.number);
        tables_.erase(std::remove_if(tables_.begin(), tables_.end(), [](const Table &t) { return t.rows.empty(); }),
                      tables_.end());
        if (tables_.empty())
            throw FormatFailure{LENSPROF_ERROR_SYNTAX, "no row of numbers; give a table of a response"};
    }

    const std::vector<Table> &tables() const { return tables_; }
    bool blue_first() const { return blue_first_; }

private:
    void add_line(std::string_view line, size_t number) {
        const std::vector<std::string_view> words = split(line);
        if (words.empty()) return;
        if (words[0][0] == '#' || words[0][0] == '%' || words[0].substr(0, 2) == "//") {
            if (words[0] == "#" && words.size() == 3 && words[1] == "name:")
                tables_.push_back({std::string(words[2]), {}});
            return;
        }
        Row row{number, {}};
        for (const std::string_view word : words) {
            double value;
            if (!read_number(word, value)) {
                if (tables_.empty() && row.values.empty()) return read_header(words, number);
                fail_at_line(number, in_quotes(word) + " is not a finite number; correct it");
            }
            row.values.push_back(value);
        }
        if (tables_.empty()) tables_.push_back({});
        std::vector<Row> &rows = tables_.back().rows;
        if (!rows.empty() && rows[0].values.size() != row.values.size())
            fail_at_line(number, std::to_string(row.values.size()) + " columns, but the first row has "
                                     + std::to_string(rows[0].values.size()) + "; correct it");
        if (rows.size() == kMaxCurveRows)
            fail_at_line(number, "over 65536 rows; give a shorter table", LENSPROF_ERROR_SIZE);
        rows.push_back(std::move(row));
    }

    // Names of columns, once, before the first row.
    void read_header(const std::vector<std::string_view> &words, size_t number) {
        if (header_) fail_at_line(number, in_quotes(words[0]) + " is not a finite number; correct it");
        header_ = true;
        const auto is = [](std::string_view word, char small) {
            while (!word.empty() && word[0] == '"') word.remove_prefix(1);
            return !word.empty() && (word[0] | 0x20) == small;
        };
        blue_first_ = words.size() >= 3 && is(words[words.size() - 3], 'b') && is(words.back(), 'r');
    }

    std::vector<Table> tables_;
    bool header_ = false, blue_first_ = false;
};

TableColumn column_of(const Table &table, size_t index) {
    TableColumn column;
    for (const Row &row : table.rows) {
        column.values.push_back(row.values[index]);
        column.lines.push_back(row.line);
    }
    return column;
}

// The first column of 2 or 4 counts the rows, or is evenly spaced from 0.
void check_index(const Table &table, size_t index) {
    const std::vector<double> values = column_of(table, index).values;
    const double step = values.back() / static_cast<double>(values.size() - 1);
    for (size_t i = 0; i < values.size(); i++)
        if (!(step > 0.0 && std::fabs(values[i] - step * static_cast<double>(i)) <= kEven * step))
            fail_at_line(table.rows[i].line, "column " + std::to_string(index + 1)
                                                 + ", which counts the rows, is not evenly spaced from 0; correct it");
}

// The irradiances of logarithms, relative to the largest.
void remove_logarithm(std::vector<double> &values, uint32_t curve) {
    const double largest = *std::max_element(values.begin(), values.end());
    for (double &value : values)
        value = curve == LENSPROF_CURVE_LOG ? std::exp(value - largest) : std::pow(10.0, value - largest);
}

struct Curves {
    std::array<lensprof_response, 3> response;
    uint32_t count;
};

// pfstools: a table a channel, of log10(irradiance), grey value and irradiance.
void read_matrices(const std::vector<Table> &tables, Repair &repair, Curves &curves) {
    if (tables.size() != 1 && tables.size() != 3)
        throw FormatFailure{LENSPROF_ERROR_SYNTAX, std::to_string(tables.size())
                                                       + " matrices; give one, or one for each of red, green and blue"};
    curves.count = static_cast<uint32_t>(tables.size());
    for (uint32_t c = 0; c < curves.count; c++) {
        if (tables[c].rows[0].values.size() != 3)
            fail_at_line(tables[c].rows[0].line,
                         "a matrix without 3 columns: log10, grey value and irradiance; correct it");
        check_index(tables[c], 1);
        curves.response[c] = response_of_column(column_of(tables[c], 2), LENSPROF_CURVE_INVERSE, repair);
    }
}

void read_columns(const CurveText &file, uint32_t curve, Repair &repair, Curves &curves) {
    const Table &table = file.tables()[0];
    const size_t columns = table.rows[0].values.size();
    if (columns > 4)
        fail_at_line(table.rows[0].line,
                     std::to_string(columns) + " columns; give 1 or 3, optionally after one that counts the rows");
    curves.count = columns <= 2 ? 1 : 3;
    const size_t skipped = columns - curves.count;
    if (skipped && table.rows.size() > 1) check_index(table, 0);
    for (uint32_t c = 0; c < curves.count; c++)
        curves.response[file.blue_first() ? curves.count - 1 - c : c] =
            response_of_column(column_of(table, skipped + c), curve, repair);
}

}  // namespace

lensprof_response response_of_column(TableColumn column, uint32_t curve, Repair &repair) {
    std::vector<double> &values = column.values;
    if (values.size() < 2) fail_at_line(column.lines[0], "only one row; give one per grey value");
    const size_t fall = find_fall(values, false);
    if (fall < values.size() && !repair.is_allowed)
        fail_at_line(column.lines[fall],
                     number_text(values[fall]) + " is below the " + number_text(values[fall - 1])
                         + " before it, but a response cannot decrease; smooth it, or check the kind of table",
                     LENSPROF_ERROR_RESPONSE);
    const size_t lowest = static_cast<size_t>(std::min_element(values.begin(), values.end()) - values.begin());
    const double smallest = values[lowest];
    if (curve == LENSPROF_CURVE_LOG || curve == LENSPROF_CURVE_LOG10) remove_logarithm(values, curve);
    if (fall < values.size()) make_increasing(values, 0.0, repair);
    if (curve == LENSPROF_CURVE_INVERSE && values.front() < 0.0)
        fail_at_line(
            column.lines[lowest],
            number_text(smallest) + " is below 0, which is not an irradiance; check whether the table is logarithmic",
            LENSPROF_ERROR_RESPONSE);
    const double first = values.front(), last = values.back();
    if (!(last > 0.0 && last > first))
        fail_at_line(column.lines.back(), "the last value is not above the first, or not above 0; give another table",
                     LENSPROF_ERROR_RESPONSE);
    for (double &value : values) {
        if (curve == LENSPROF_CURVE_FORWARD)
            value = std::clamp(value / (last - first) - first / (last - first), 0.0, 1.0);
        else
            value /= last;
    }
    if (curve != LENSPROF_CURVE_FORWARD) return response_of_irradiances(values);
    values.back() = 1.0;
    lensprof_response response;
    const lensprof_status status =
        lensprof_response_set_table(&response, values.data(), static_cast<uint32_t>(values.size()));
    if (status != LENSPROF_OK) throw FormatFailure{status, "it is not a response; check the kind of table"};
    return response;
}

uint32_t read_curves(std::string_view text, uint32_t curve, Repair &repair, lensprof_response *responses) {
    const CurveText file(text);
    Curves curves{};
    if (!file.tables()[0].name.empty())
        read_matrices(file.tables(), repair, curves);
    else
        read_columns(file, curve, repair, curves);
    std::copy_n(curves.response.begin(), curves.count, responses);
    return curves.count;
}

}  // namespace lensprof

using namespace lensprof;

lensprof_status lp_curves_read(const void *data, size_t size, uint32_t curve, lensprof_response *responses,
                               uint32_t *count, lensprof_error *error) {
    if ((!data && size) || !responses || !count || curve > LENSPROF_CURVE_FORWARD) {
        set_error(error,
                  "lensprof_import: data, responses or count is NULL, or the kind is unknown; see lensprof_curve");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return at_boundary(error, [&] {
        Repair none;
        *count = read_curves(view_of(data, size), curve, none, responses);
    });
}
