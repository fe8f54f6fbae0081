// Bytes as a file that has a path.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace lensprof {

// Libraries that read pictures open files by name. Nothing of it is left when the object dies.
class MemoryFile {
public:
    MemoryFile(const void *data, size_t size);  // copies; Failure (WRITE)
    ~MemoryFile();
    MemoryFile(const MemoryFile &) = delete;
    MemoryFile &operator=(const MemoryFile &) = delete;

    const std::string &path() const { return path_; }

private:
    void remove();

    int file_ = -1;
    bool is_named_ = false;
    std::string path_;
};

// Bytes that wait on disk instead of in memory: a file without a name in TMPDIR, of which nothing is left.
class ScratchFile {
public:
    ScratchFile();  // Failure (WRITE)
    ~ScratchFile();
    ScratchFile(const ScratchFile &) = delete;
    ScratchFile &operator=(const ScratchFile &) = delete;

    uint64_t append(const void *data, size_t size);           // returns where it is; Failure (WRITE)
    void read(uint64_t from, void *data, size_t size) const;  // what was appended there; Failure (WRITE)

private:
    int file_ = -1;
    uint64_t size_ = 0;
};

// An empty folder of its own, removed with its files.
class TemporaryFolder {
public:
    TemporaryFolder();  // Failure (WRITE)
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder &) = delete;
    TemporaryFolder &operator=(const TemporaryFolder &) = delete;

    const std::string &path() const { return path_; }

private:
    std::string path_;
};

}  // namespace lensprof
