#include "cli/program/message.hpp"

#include "cli/program/utf8.hpp"

namespace lensprof {

void tell(Streams &streams, const std::string &text) { streams.err << "lensprof: " << one_line(text) << "\n"; }

void warn(Streams &streams, const std::string &text) { tell(streams, "warning: " + text); }

void note(Streams &streams, const std::string &text) { tell(streams, "note: " + text); }

}  // namespace lensprof
