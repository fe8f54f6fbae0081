// Bytes as a file that has a path.
#pragma once

#include <cstddef>
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
