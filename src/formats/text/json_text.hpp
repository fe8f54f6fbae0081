// JSON from and to memory. Read by nlohmann-json's parser into one array of nodes, so that neither depth nor memory is
// up to the file, and no destructor needs memory; written in the shortest form that reads back the same.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "formats/text/text.hpp"

namespace lensprof {

class JsonText;

// A value of a text, as long as that lives; or none, where a member is missing.
class JsonValue {
public:
    // Neither missing nor null.
    explicit operator bool() const;
    bool is_object() const;
    bool is_array() const;
    bool is_number() const;
    bool is_text() const;

    // Number of items of an array or members of an object; throws for what is neither.
    size_t size() const;
    // Whether an object has a member of this name, be it null.
    bool has(std::string_view name) const;
    // The member of an object, the last one of this name; throws if this is not an object.
    JsonValue operator[](std::string_view name) const;
    // The same; throws SYNTAX, with the path, where it is missing or null.
    JsonValue required(std::string_view name) const;

    // First item or member of an array or object, and that after this one; none at the end.
    JsonValue first() const;
    JsonValue next() const;

    // Each throws SYNTAX, with the path, for another kind of value.
    double number() const;
    double number_within(double low, double high) const;
    int64_t integer(int64_t low, int64_t high) const;
    bool boolean() const;
    std::string_view text() const;
    std::vector<double> numbers(size_t low, size_t high) const;  // an array of so many numbers

    // "profiles[2].vignetting.k: message"; `message` alone at the outermost value.
    [[noreturn]] void fail(const std::string &message, lensprof_status status = LENSPROF_ERROR_SYNTAX) const;
    std::string path() const;

private:
    friend class JsonText;
    JsonValue(const JsonText *owner, uint32_t index) : owner_(owner), index_(index) {}

    const JsonText *owner_;
    uint32_t index_;
};

class JsonText {
public:
    // Throws SIZE over 64 MiB or 4 million values; SYNTAX, with the line, for what is not UTF-8, not JSON, deeper than
    // 32 levels or holds numbers beyond double precision.
    explicit JsonText(std::string_view text);

    JsonValue root() const { return {this, 0}; }

private:
    friend class JsonValue;
    friend class JsonNodes;

    enum Kind : uint32_t {
        kNull,
        kBoolean,
        kInteger,
        kNumber,
        kString,
        kArray,
        kObject
    };

    struct Node {
        Kind kind;
        uint32_t parent, next, name;  // nodes; 0 = none, which is the outermost one. name: of a member, in texts_
        union {
            double number;
            int64_t integer;
            uint32_t first, text;
        };
    };

    std::string_view text_at(uint32_t offset) const;

    std::vector<Node> nodes_;
    std::string texts_;  // each after its length, 4 bytes
};

// Appends JSON to a text; the caller opens and closes what it opens in turn.
class JsonWriter {
public:
    enum Style {
        kOneLine,  // but for what begins another
        kIndented  // as nlohmann-json writes with an indent of 1, to the byte
    };
    explicit JsonWriter(Style style = kOneLine) : style_(style) {}

    void open(char bracket);   // '{' or '['
    void close(char bracket);  // '}' or ']'
    void name(const char *name);
    void number(double value);  // with a point or an exponent; null unless finite
    void known(double value);   // null for LENSPROF_UNKNOWN, too
    void integer(int64_t value);
    void text(const char *value);  // bytes that are not UTF-8 as U+FFFD
    void word(const char *value);  // true, false, null
    void numbers(const double *values, size_t count);
    void line() { broken_ = true; }  // what is written next begins a line

    std::string all() const { return all_ + '\n'; }

private:
    void separate();
    void begin_line();

    std::string all_;
    Style style_;
    size_t level_ = 0;
    bool first_ = true, named_ = false, broken_ = false;
};

}  // namespace lensprof
