#include "photo/cards/setting_table.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <sstream>

#include "photo/base/format.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/library.hpp"
#include "photo/system/system.hpp"

namespace lensprof {
namespace {

constexpr uint64_t most_bytes = 16u << 20;
constexpr double largest_number = 1e5;

// The cells of a line: quoted ones may hold separators, and quotes twice.
std::vector<std::string> cells_of(const std::string &line, char separator) {
    std::vector<std::string> cells(1);
    bool is_quoted = false;
    for (size_t i = 0; i < line.size(); i++) {
        const char c = line[i];
        if (c == '"' && is_quoted && i + 1 < line.size() && line[i + 1] == '"')
            cells.back() += line[++i];
        else if (c == '"')
            is_quoted = !is_quoted;
        else if (c == separator && !is_quoted)
            cells.emplace_back();
        else
            cells.back() += c;
    }
    for (std::string &cell : cells) {
        const size_t first = cell.find_first_not_of(" \t\r"), last = cell.find_last_not_of(" \t\r");
        cell = first == std::string::npos ? std::string() : cell.substr(first, last - first + 1);
    }
    return cells;
}

// CR and CR LF end lines, too.
std::string with_line_feeds(const std::string &text) {
    std::string lines;
    for (size_t i = 0; i < text.size(); i++)
        if (text[i] != '\r')
            lines += text[i];
        else if (i + 1 == text.size() || text[i + 1] != '\n')
            lines += '\n';
    return lines;
}

char separator_of(const std::string &header) {
    for (const char separator : {'\t', ';'})
        if (header.find(separator) != std::string::npos) return separator;
    return ',';
}

using Setter = std::function<bool(const std::string &cell, lensprof_profile_key &key)>;

template <size_t size>
Setter text_setter(char (lensprof_profile_key::*field)[size]) {
    return [field](const std::string &cell, lensprof_profile_key &key) {
        set_text(key.*field, size, cell);
        return cell.size() < size;
    };
}

// A number as in names of folders, which may have its unit: "58 mm", "10m"; an aperture, without one, "f/2.8".
std::string without_unit(std::string cell, const std::string &unit) {
    for (char &c : cell) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const size_t begin = unit.empty() && cell[0] == 'f' ? cell.find_first_not_of(" /", 1) : 0;
    if (begin == std::string::npos) return {};
    const bool has_unit = cell.size() > unit.size() && cell.compare(cell.size() - unit.size(), unit.size(), unit) == 0;
    const size_t end = cell.find_last_not_of(' ', cell.size() - (has_unit ? unit.size() : 0) - 1);
    return end == std::string::npos || end < begin ? std::string() : cell.substr(begin, end + 1 - begin);
}

Setter number_setter(double lensprof_profile_key::*field, const std::string &unit, bool may_be_infinite) {
    return [=](const std::string &cell, lensprof_profile_key &key) {
        const std::string number = without_unit(cell, unit);
        if (may_be_infinite && (number == "inf" || number == "infinity")) return key.*field = INFINITY, true;
        char *end = nullptr;
        key.*field = std::strtod(number.c_str(), &end);
        const bool is_plain = !number.empty() && number.find_first_not_of("0123456789.e+-") == std::string::npos;
        return is_plain && *end == '\0' && key.*field > 0.0 && key.*field <= largest_number;
    };
}

// What a column sets; empty for the file. Throws std::invalid_argument for an unknown one.
Setter setter_of(const std::string &column) {
    if (column == "file") return nullptr;
    if (column == "maker") return text_setter(&lensprof_profile_key::camera_maker);
    if (column == "camera") return text_setter(&lensprof_profile_key::camera_model);
    if (column == "lens") return text_setter(&lensprof_profile_key::lens);
    if (column == "focal") return number_setter(&lensprof_profile_key::focal_mm, "mm", false);
    if (column == "aperture") return number_setter(&lensprof_profile_key::aperture, "", false);
    if (column == "temperature") return number_setter(&lensprof_profile_key::color_temperature_k, "k", false);
    if (column == "distance") return number_setter(&lensprof_profile_key::distance_m, "m", true);
    throw std::invalid_argument(column);
}

[[noreturn]] void fail(const std::string &path, size_t line, const std::string &what) {
    throw Failure(LENSPROF_ERROR_READ, path + ": line " + std::to_string(line) + ": " + what);
}

bool fits(const std::string &pattern, const std::string &file) {
    return system::fits_pattern(pattern, file) || system::fits_pattern("*/" + pattern, file);
}

void replace(const lensprof_profile_key &by, lensprof_profile_key &key) {
    if (*by.camera_maker) set_text(key.camera_maker, sizeof key.camera_maker, by.camera_maker);
    if (*by.camera_model) set_text(key.camera_model, sizeof key.camera_model, by.camera_model);
    if (*by.lens) set_text(key.lens, sizeof key.lens, by.lens);
    if (by.focal_mm != LENSPROF_UNKNOWN) key.focal_mm = by.focal_mm;
    if (by.aperture != LENSPROF_UNKNOWN) key.aperture = by.aperture;
    if (by.distance_m != LENSPROF_UNKNOWN) key.distance_m = by.distance_m;
    if (by.color_temperature_k != LENSPROF_UNKNOWN) key.color_temperature_k = by.color_temperature_k;
}

}  // namespace

SettingTable::SettingTable(const std::string &path) {
    std::istringstream text(with_line_feeds(read_text(path, most_bytes)));
    std::string line;
    if (!std::getline(text, line)) fail(path, 1, "is empty; give a header such as file,lens,focal,aperture");
    if (line.rfind("\xef\xbb\xbf", 0) == 0) line.erase(0, 3);
    const char separator = separator_of(line);
    std::vector<std::string> columns = cells_of(line, separator);
    for (std::string &column : columns)
        for (char &c : column) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    for (size_t c = 0; c < columns.size(); c++)
        if (std::count(columns.begin(), columns.end(), columns[c]) > 1)
            fail(path, 1, "has the column " + columns[c] + " more than once");
    std::vector<Setter> setters;
    size_t file_column = columns.size();
    for (size_t c = 0; c < columns.size(); c++) {
        try {
            setters.push_back(setter_of(columns[c]));
        } catch (const std::invalid_argument &) {
            fail(path, 1,
                 "'" + columns[c]
                     + "' is not a column; use file, maker, camera, lens, focal, aperture, distance, temperature");
        }
        if (!setters.back()) file_column = c;
    }
    if (file_column == columns.size()) fail(path, 1, "has no column file");
    for (size_t number = 2; std::getline(text, line); number++) {
        if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
        if (std::count(line.begin(), line.end(), '"') % 2) fail(path, number, "a quote is not closed in its line");
        const std::vector<std::string> cells = cells_of(line, separator);
        if (cells.size() != columns.size())
            fail(path, number,
                 "has " + counted(cells.size(), "cell") + ", but the header " + std::to_string(columns.size()));
        Row row{cells[file_column], {}, false};
        lensprof_profile_key_init(&row.key);
        for (size_t c = 0; c < cells.size(); c++)
            if (setters[c] && !cells[c].empty() && !setters[c](cells[c], row.key))
                fail(path, number, "'" + cells[c] + "' is not a value of " + columns[c]);
        rows_.push_back(row);
    }
}

SettingTable::Row *SettingTable::row_of(const std::string &file) {
    const auto row = std::find_if(rows_.begin(), rows_.end(), [&](const Row &one) { return fits(one.file, file); });
    return row == rows_.end() ? nullptr : &*row;
}

void SettingTable::use(const std::string &file) {
    if (Row *row = row_of(file)) row->is_used = true;
}

void SettingTable::apply(const std::string &file, lensprof_profile_key &key) {
    use(file);
    if (const Row *row = row_of(file)) replace(row->key, key);
}

std::vector<std::string> SettingTable::unused() const {
    std::vector<std::string> files;
    for (const Row &row : rows_)
        if (!row.is_used) files.push_back(row.file);
    return files;
}

}  // namespace lensprof
