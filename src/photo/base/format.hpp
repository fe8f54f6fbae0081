// Formatting of text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lensprof {

// printf into a string.
std::string format(const char *pattern, ...) __attribute__((format(printf, 1, 2)));

// A standard error with two significant digits, "0" if it is 0; "-" if it is unknown.
std::string error_text(double error);

// A number with the decimals of its error, at most 6: "63.021" of +- 0.013.
std::string with_decimals_of(double error, double number);

// "1 profile", "2 lenses"; the default plural adds an s.
std::string counted(size_t count, const std::string &singular, const std::string &plural = "");

// Names by index, "img1.jpg, img2.jpg and 7 more".
std::string listed(const std::vector<uint32_t> &numbers, const std::vector<std::string> &names);

// All words, with `separator` between them.
std::string joined(const std::vector<std::string> &words, const std::string &separator);

// Failure (ARGUMENT) with the option if the number of `values` is not `count`, one per thing (such as "picture").
void require_count(size_t values, const std::string &option, size_t count, const std::string &singular);

// In single quotes of a shell.
std::string shell_quoted(const std::string &text);

}  // namespace lensprof
