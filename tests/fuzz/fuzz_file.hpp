// Bytes as a file for readers that take a path: an unnamed file in memory.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include "fuzz_main.hpp"
#include "photo/base/failure.hpp"

// Leaks of libheif and its decoders on damaged files.
extern "C" const char *__lsan_default_suppressions();
extern "C" const char *__lsan_default_suppressions() {
    return "leak:libheif\nleak:libdav1d\nleak:libaom\nleak:libde265";
}

namespace {

class MemoryFile {
public:
    explicit MemoryFile(const std::vector<char> &bytes) : descriptor_(memfd_create("fuzz", MFD_CLOEXEC)) {
        demand(descriptor_ >= 0, "cannot create the memory file");
        const auto written = write(descriptor_, bytes.data(), bytes.size());
        demand(written >= 0 && static_cast<size_t>(written) == bytes.size(), "cannot create the memory file");
    }
    MemoryFile(const MemoryFile &) = delete;
    MemoryFile &operator=(const MemoryFile &) = delete;
    ~MemoryFile() { close(descriptor_); }

    std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

private:
    int descriptor_;
};

// True if `read` returns; false if it throws Failure for an unreadable file, with a text. Anything else is a defect.
template <typename Read>
bool is_read(const Read &read) {
    try {
        read();
        return true;
    } catch (const lensprof::Failure &failure) {
        demand(failure.group() == LENSPROF_ERROR_READ, failure.what());
        demand(failure.what()[0], "a failure without a text");
        return false;
    }
}

}  // namespace
