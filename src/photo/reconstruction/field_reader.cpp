#include "photo/reconstruction/field_reader.hpp"

#include <cmath>

#include "photo/base/failure.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/paths.hpp"

namespace lensprof {

FieldReader::FieldReader(const std::string &file, char separator, uint64_t most_bytes)
    : file_(file), separator_(separator) {
    require_regular_file(file);
    if (file_bytes(file) > most_bytes)
        throw Failure(LENSPROF_ERROR_READ, file + ": has " + std::to_string(file_bytes(file)) + " bytes, but at most "
                                               + std::to_string(most_bytes) + " are supported; give a smaller file");
    stream_.open(file);
    if (!stream_) throw Failure(LENSPROF_ERROR_READ, file + ": cannot be opened; give a readable file");
}

bool FieldReader::next_line() {
    if (!std::getline(stream_, line_)) {
        if (stream_.bad()) fail("it cannot be read");
        return false;
    }
    if (!line_.empty() && line_.back() == '\r') line_.pop_back();
    position_ = 0, number_++;
    skip_blanks();
    return true;
}

bool FieldReader::next_line_of_values() {
    while (next_line())
        if (has_more() && line_[position_] != '#') return true;
    return false;
}

bool FieldReader::has_more() const { return position_ < line_.size(); }

void FieldReader::skip_blanks() {
    if (!separator_)
        while (position_ < line_.size() && (line_[position_] == ' ' || line_[position_] == '\t')) position_++;
}

std::string FieldReader::text() {
    if (!has_more()) fail("it has too few fields");
    const size_t end = separator_ ? line_.find(separator_, position_) : line_.find_first_of(" \t", position_);
    const std::string field = line_.substr(position_, end - position_);
    position_ = end == std::string::npos ? line_.size() : end + (separator_ ? 1 : 0);
    skip_blanks();
    return field;
}

std::string FieldReader::rest() {
    if (!has_more()) fail("it has too few fields");
    const std::string field = line_.substr(position_);
    position_ = line_.size();
    return field;
}

double FieldReader::number() {
    const std::string field = text();
    double number = 0.0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), number);
    if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(number))
        fail_at(field, "a number");
    return number;
}

void FieldReader::fail_at(const std::string &field, const char *wanted) const {
    fail("'" + short_name(field) + "' is not " + wanted);
}

void FieldReader::fail(const std::string &problem) const {
    throw Failure(LENSPROF_ERROR_READ,
                  file_ + ": line " + std::to_string(number_) + ": " + problem + "; give an intact file");
}

}  // namespace lensprof
