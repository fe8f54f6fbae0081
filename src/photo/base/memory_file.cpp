#include "photo/base/memory_file.hpp"

#include <cerrno>
#include <cstdint>
#include <filesystem>

#include "photo/base/failure.hpp"
#include "photo/base/output_file.hpp"
#include "photo/system/system.hpp"

namespace lensprof {
namespace {

std::string start_of_name() { return system::temporary_folder() + "/lensprof-"; }

[[noreturn]] void fail(const std::string &what) {
    throw Failure(LENSPROF_ERROR_WRITE, what + ": " + system_text(errno) + "; set TMPDIR to a folder with space");
}

}  // namespace

MemoryFile::MemoryFile(const void *data, size_t size) {
    file_ = system::create_file_in_memory(path_);
    if (file_ < 0) {
        const auto create = [&] { return system::create_file(path_, 0600, system::Lifetime::kept); };
        file_ = create_numbered(start_of_name(), "", path_, create);
        is_named_ = file_ >= 0;
    }
    if (file_ < 0) fail("bytes of a picture");
    if (system::write_bytes_at(file_, 0, data, size)) return;
    const int error_number = errno;
    remove();
    errno = error_number;
    fail("bytes of a picture");
}

MemoryFile::~MemoryFile() { remove(); }

void MemoryFile::remove() {
    if (file_ >= 0) system::close_file(file_);
    if (is_named_) system::remove_file(path_);
}

ScratchFile::ScratchFile() {
    file_ = open_unnamed(start_of_name());
    if (file_ < 0) fail(system::temporary_folder());
}

ScratchFile::~ScratchFile() { system::close_file(file_); }

uint64_t ScratchFile::append(const void *data, size_t size) {
    const uint64_t begin = size_;
    if (!system::write_bytes_at(file_, begin, data, size)) fail("intermediate results");
    size_ += size;
    return begin;
}

void ScratchFile::read(uint64_t begin, void *data, size_t size) const {
    if (!system::read_bytes_at(file_, begin, data, size)) fail("intermediate results");
}

TemporaryFolder::TemporaryFolder() {
    const auto create = [&] { return system::create_private_folder(path_) ? 0 : -1; };
    if (create_numbered(start_of_name(), "", path_, create) < 0) fail(system::temporary_folder());
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace lensprof
