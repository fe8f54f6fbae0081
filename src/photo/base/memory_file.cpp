#include "photo/base/memory_file.hpp"

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <filesystem>

#include <sys/mman.h>
#include <unistd.h>

#include "photo/base/failure.hpp"
#include "photo/base/output_file.hpp"

namespace lensprof {
namespace {

std::string place() {
    const char *folder = std::getenv("TMPDIR");
    return folder && *folder ? folder : "/tmp";
}

std::string temporary_name() { return place() + "/lensprof-XXXXXX"; }

[[noreturn]] void fail(const std::string &what) {
    throw Failure(LENSPROF_ERROR_WRITE, what + ": " + system_text(errno) + "; set TMPDIR to a folder with space");
}

}  // namespace

MemoryFile::MemoryFile(const void *data, size_t size) {
#ifdef MFD_CLOEXEC
    file_ = memfd_create("lensprof", MFD_CLOEXEC);
    if (file_ >= 0) path_ = "/proc/self/fd/" + std::to_string(file_);
#endif
    if (file_ < 0) {
        path_ = temporary_name();
        file_ = mkstemp(path_.data());
        is_named_ = file_ >= 0;
    }
    if (file_ < 0) fail("bytes of a picture");
    if (write_bytes_at(file_, 0, data, size)) return;
    const int error_number = errno;
    remove();
    errno = error_number;
    fail("bytes of a picture");
}

MemoryFile::~MemoryFile() { remove(); }

void MemoryFile::remove() {
    if (file_ >= 0) close(file_);
    if (is_named_) unlink(path_.c_str());
}

ScratchFile::ScratchFile() {
    file_ = open_unnamed(temporary_name());
    if (file_ < 0) fail(place());
}

ScratchFile::~ScratchFile() { close(file_); }

uint64_t ScratchFile::append(const void *data, size_t size) {
    const uint64_t begin = size_;
    if (!write_bytes_at(file_, begin, data, size)) fail("intermediate results");
    size_ += size;
    return begin;
}

void ScratchFile::read(uint64_t begin, void *data, size_t size) const {
    if (!read_bytes_at(file_, begin, data, size)) fail("intermediate results");
}

TemporaryFolder::TemporaryFolder() : path_(temporary_name()) {
    if (!mkdtemp(path_.data())) fail(place());
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace lensprof
