// The layout of help texts.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

namespace CLI {
class FormatterBase;
}  // namespace CLI

namespace lensprof {

constexpr size_t help_columns = 100;

// The text with line breaks so that each line has at most `columns` characters, unless one word is longer.
std::string wrapped(const std::string &text, size_t columns);

// The group of options that only --help-all and the second section of man pages show.
constexpr const char *expert_group = "Expert options";

// Wraps at help_columns.
std::shared_ptr<CLI::FormatterBase> help_formatter(bool with_expert);

}  // namespace lensprof
