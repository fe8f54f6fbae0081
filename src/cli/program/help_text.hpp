// The layout of help texts.
#pragma once

#include <memory>

namespace CLI {
class FormatterBase;
}  // namespace CLI

namespace lensprof {

// Wraps at 100 columns. Formats all commands of a program.
std::shared_ptr<CLI::FormatterBase> help_formatter();

}  // namespace lensprof
