// Ctrl-C: work in progress stops at the next safe point and cleans up after itself.
#pragma once

namespace lensprof {

// From now on SIGINT and SIGTERM only set a flag (a second one ends the process immediately), and writing beyond the
// file size limit fails like any other write. Call once, from main.
void catch_interrupts();

bool interrupted();

}  // namespace lensprof
