#include "formats/text/json_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <lensprof/profile.h>

#include <nlohmann/json.hpp>

namespace lensprof {

namespace {

constexpr size_t kMaxBytes = size_t{64} << 20;
constexpr size_t kMaxNodes = 4000000;  // of 24 bytes each
constexpr size_t kMaxLevels = 32;

}  // namespace

// Fills a JsonText by the parser's events.
class JsonNodes : public nlohmann::json::json_sax_t {
public:
    JsonNodes(JsonText &all, std::string_view text) : all_(all), text_(text) {}

    bool null() override { return add(JsonText::kNull), true; }
    bool boolean(bool value) override { return add(JsonText::kBoolean).integer = value, true; }
    bool number_integer(int64_t value) override { return add(JsonText::kInteger).integer = value, true; }
    bool number_unsigned(uint64_t value) override {
        if (value <= uint64_t{INT64_MAX}) return number_integer(static_cast<int64_t>(value));
        return add(JsonText::kNumber).number = static_cast<double>(value), true;
    }
    bool number_float(double value, const std::string &) override {
        return add(JsonText::kNumber).number = value, true;
    }
    bool string(std::string &value) override {
        const uint32_t offset = keep(value);
        return add(JsonText::kString).text = offset, true;
    }
    bool binary(binary_t &) override { return false; }
    bool key(std::string &name) override { return name_ = keep(name), true; }
    bool start_object(size_t) override { return open(JsonText::kObject); }
    bool start_array(size_t) override { return open(JsonText::kArray); }
    bool end_object() override { return open_.pop_back(), true; }
    bool end_array() override { return open_.pop_back(), true; }

    bool parse_error(size_t position, const std::string &token, const nlohmann::json::exception &error) override {
        const std::string_view before = text_.substr(0, std::min(position, text_.size()));
        const size_t line = 1 + static_cast<size_t>(std::count(before.begin(), before.end(), '\n'));
        if (error.id == 406) fail_at_line(line, lensprof::in_quotes(token) + " is out of range; correct it");
        fail_at_line(line, "not JSON at " + lensprof::in_quotes(token.substr(token.size() > 20 ? token.size() - 20 : 0))
                               + "; correct the file");
    }

private:
    struct Open {
        uint32_t node, last;  // last: newest item, 0 before the first
    };

    JsonText::Node &add(JsonText::Kind kind) {
        if (all_.nodes_.size() >= kMaxNodes)
            throw FormatFailure{LENSPROF_ERROR_SIZE, "over 4 million values of JSON; split the file"};
        const uint32_t index = static_cast<uint32_t>(all_.nodes_.size());
        JsonText::Node node{};
        node.kind = kind, node.name = name_;
        name_ = 0;
        if (!open_.empty()) {
            Open &parent = open_.back();
            node.parent = parent.node;
            (parent.last ? all_.nodes_[parent.last].next : all_.nodes_[parent.node].first) = index;
            parent.last = index;
        }
        all_.nodes_.push_back(node);
        return all_.nodes_.back();
    }

    bool open(JsonText::Kind kind) {
        if (open_.size() >= kMaxLevels)
            throw FormatFailure{LENSPROF_ERROR_SYNTAX, "JSON with over 32 levels; give a file of profiles or tables"};
        add(kind);
        open_.push_back({static_cast<uint32_t>(all_.nodes_.size() - 1), 0});
        return true;
    }

    uint32_t keep(const std::string &text) {
        const uint32_t length = static_cast<uint32_t>(text.size());
        const auto offset = static_cast<uint32_t>(all_.texts_.size());
        char bytes[sizeof length];
        std::memcpy(bytes, &length, sizeof length);
        all_.texts_.append(bytes, sizeof bytes).append(text);
        return offset;
    }

    JsonText &all_;
    std::string_view text_;
    std::vector<Open> open_;
    uint32_t name_ = 0;
};

JsonText::JsonText(std::string_view text) : texts_(sizeof(uint32_t), '\0') {
    if (text.size() > kMaxBytes) throw FormatFailure{LENSPROF_ERROR_SIZE, "over 64 MiB of JSON; split the file"};
    const size_t wrong = find_not_utf8(text);
    if (wrong < text.size()) {
        const std::string_view before = text.substr(0, wrong);
        fail_at_line(1 + static_cast<size_t>(std::count(before.begin(), before.end(), '\n')),
                     "not UTF-8 text; convert the file, or give a JSON file");
    }
    JsonNodes nodes(*this, text);
    if (!nlohmann::json::sax_parse(text.begin(), text.end(), &nodes))
        throw FormatFailure{LENSPROF_ERROR_SYNTAX, "not JSON; correct the file"};
}

std::string_view JsonText::text_at(uint32_t offset) const {
    uint32_t length;
    std::memcpy(&length, texts_.data() + offset, sizeof length);
    return std::string_view(texts_).substr(offset + sizeof length, length);
}

namespace {
constexpr uint32_t kMissing = UINT32_MAX;
}

JsonValue::operator bool() const { return index_ != kMissing && owner_->nodes_[index_].kind != JsonText::kNull; }

bool JsonValue::is_object() const { return *this && owner_->nodes_[index_].kind == JsonText::kObject; }
bool JsonValue::is_array() const { return *this && owner_->nodes_[index_].kind == JsonText::kArray; }
bool JsonValue::is_text() const { return *this && owner_->nodes_[index_].kind == JsonText::kString; }
bool JsonValue::is_number() const {
    return *this
           && (owner_->nodes_[index_].kind == JsonText::kNumber || owner_->nodes_[index_].kind == JsonText::kInteger);
}

JsonValue JsonValue::first() const {
    if (!is_array() && !is_object()) fail("is not an array or object; correct it");
    const uint32_t index = owner_->nodes_[index_].first;
    return {owner_, index ? index : kMissing};
}

JsonValue JsonValue::next() const {
    const uint32_t index = owner_->nodes_[index_].next;
    return {owner_, index ? index : kMissing};
}

size_t JsonValue::size() const {
    size_t count = 0;
    for (JsonValue item = first(); item.index_ != kMissing; item = item.next()) count++;
    return count;
}

bool JsonValue::has(std::string_view name) const { return (*this)[name].index_ != kMissing; }

JsonValue JsonValue::operator[](std::string_view name) const {
    if (!is_object()) fail("is not an object; correct it");
    JsonValue found{owner_, kMissing};
    for (JsonValue member = first(); member.index_ != kMissing; member = member.next())
        if (owner_->text_at(owner_->nodes_[member.index_].name) == name) found = member;
    return found;
}

JsonValue JsonValue::required(std::string_view name) const {
    const JsonValue found = (*this)[name];
    if (!found) fail("has no \"" + std::string(name) + "\"; add it");
    return found;
}

double JsonValue::number() const {
    if (!is_number()) fail("is not a number; correct it");
    const JsonText::Node &node = owner_->nodes_[index_];
    return node.kind == JsonText::kInteger ? static_cast<double>(node.integer) : node.number;
}

double JsonValue::number_within(double low, double high) const {
    const double value = number();
    if (!(value >= low && value <= high))
        fail("is " + number_text(value) + ", not within " + number_text(low) + " to " + number_text(high)
             + "; correct it");
    return value;
}

int64_t JsonValue::integer(int64_t low, int64_t high) const {
    if (!is_number() || owner_->nodes_[index_].kind != JsonText::kInteger) fail("is not an integer; correct it");
    const int64_t value = owner_->nodes_[index_].integer;
    if (value < low || value > high)
        fail("is " + std::to_string(value) + ", not within " + std::to_string(low) + " to " + std::to_string(high)
             + "; correct it");
    return value;
}

bool JsonValue::boolean() const {
    if (!*this || owner_->nodes_[index_].kind != JsonText::kBoolean) fail("is not true or false; correct it");
    return owner_->nodes_[index_].integer != 0;
}

std::string_view JsonValue::text() const {
    if (!is_text()) fail("is not a text; correct it");
    return owner_->text_at(owner_->nodes_[index_].text);
}

std::vector<double> JsonValue::numbers(size_t low, size_t high) const {
    if (!is_array()) fail("is not an array; correct it");
    const size_t count = size();
    if (count < low || count > high)
        fail("has " + std::to_string(count) + " items, not " + std::to_string(low)
             + (high > low ? " to " + std::to_string(high) : "") + "; correct it");
    std::vector<double> values;
    values.reserve(count);
    for (JsonValue item = first(); item.index_ != kMissing; item = item.next()) values.push_back(item.number());
    return values;
}

std::string JsonValue::path() const {
    std::string path;
    for (uint32_t index = index_; index != 0 && index != kMissing;) {
        const JsonText::Node &node = owner_->nodes_[index], &parent = owner_->nodes_[node.parent];
        std::string step;
        if (parent.kind == JsonText::kObject) {
            const std::string name = in_quotes(owner_->text_at(node.name));
            step = (node.parent ? "." : "") + name.substr(1, name.size() - 2);
        } else {
            size_t number = 0;
            for (uint32_t i = parent.first; i != index; i = owner_->nodes_[i].next) number++;
            step = "[" + std::to_string(number) + "]";
        }
        path.insert(0, step);
        index = node.parent;
    }
    return path;
}

void JsonValue::fail(const std::string &message, lensprof_status status) const {
    const std::string position = path();
    throw FormatFailure{status, (position.empty() ? "the JSON" : position) + (message[0] == ':' ? "" : " ") + message};
}

void JsonWriter::separate() {
    if (!first_ && !named_) all_ += ',';
    if (broken_) all_ += '\n';
    if (level_ && !named_) begin_line();
    first_ = named_ = broken_ = false;
}

void JsonWriter::begin_line() {
    if (style_ == kIndented) all_.append("\n").append(level_, ' ');
}

void JsonWriter::open(char bracket) {
    separate();
    all_ += bracket;
    first_ = true;
    level_++;
}

void JsonWriter::close(char bracket) {
    level_--;
    if (!first_) begin_line();
    all_ += bracket;
    first_ = false;
}

void JsonWriter::name(const char *name) {
    separate();
    all_.append("\"").append(name).append(style_ == kIndented ? "\": " : "\":");
    named_ = true;
}

void JsonWriter::number(double value) {
    if (!std::isfinite(value)) return word("null");
    if (style_ == kIndented) return word(nlohmann::json(value).dump().c_str());
    const std::string digits = value == 0.0 && std::signbit(value) ? "-0" : number_text(value);
    separate();
    all_ += digits;
    if (digits.find_first_of(".e") == std::string::npos) all_ += ".0";
}

void JsonWriter::known(double value) {
    if (value == LENSPROF_UNKNOWN) return word("null");
    number(value);
}

void JsonWriter::integer(int64_t value) {
    separate();
    all_ += std::to_string(value);
}

void JsonWriter::text(const char *value) {
    separate();
    all_ += nlohmann::json(value).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void JsonWriter::word(const char *value) {
    separate();
    all_ += value;
}

void JsonWriter::numbers(const double *values, size_t count) {
    open('[');
    for (size_t i = 0; i < count; i++) number(values[i]);
    close(']');
}

}  // namespace lensprof
