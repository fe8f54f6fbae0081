// Bytes as a file for readers that take a path: a file in memory without a name.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include "cli/program/error.hpp"
#include "fuzz_main.hpp"

// What libheif and its decoders lose of damaged files.
extern "C" const char *__lsan_default_suppressions();
extern "C" const char *__lsan_default_suppressions() {
    return "leak:libheif\nleak:libdav1d\nleak:libaom\nleak:libde265";
}

namespace {

class MemoryFile {
public:
    explicit MemoryFile(const std::vector<char> &bytes) : descriptor_(memfd_create("fuzz", MFD_CLOEXEC)) {
        demand(descriptor_ >= 0, "no memory file");
        const auto written = write(descriptor_, bytes.data(), bytes.size());
        demand(written >= 0 && static_cast<size_t>(written) == bytes.size(), "no memory file");
    }
    MemoryFile(const MemoryFile &) = delete;
    MemoryFile &operator=(const MemoryFile &) = delete;
    ~MemoryFile() { close(descriptor_); }

    std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

private:
    int descriptor_;
};

// True when `read` returns; false when it throws Failure as unreadable, with a text. Anything else is a defect.
template <typename Read>
bool is_read(const Read &read) {
    try {
        read();
        return true;
    } catch (const lensprof::Failure &failure) {
        demand(failure.code == lensprof::ExitCode::unreadable, failure.what());
        demand(failure.what()[0], "a failure without a text");
        return false;
    }
}

}  // namespace
