// What the operating system does for src/photo and src/cli: files, locks, terminal, signals, memory. system_posix.cpp
// is for Linux and macOS, system_windows.cpp for Windows; no other file of the two layers includes a header of a
// system. Paths are UTF-8 everywhere. Nothing throws: functions that fail return what their comment states, and set
// errno.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

namespace lensprof::system {

struct FileStatus {
    enum class Kind {
        missing,
        file,
        folder,
        other
    };
    Kind kind = Kind::missing;
    uint64_t bytes = 0;
    int64_t modified_s = 0;    // since 1970
    int64_t modified_ns = 0;   // and within that second
    unsigned permissions = 0;  // as of POSIX, without the kind; Windows: only whether it is writable
    std::string identity;      // equal for all names of one file; empty if missing
};
FileStatus status_of(const std::string &path);  // of what a link points to
FileStatus status_of(std::FILE *file);

// The path without symbolic links; empty if it does not exist.
std::string resolve_links(const std::string &path);

bool can_write_in(const std::string &folder);

// A new file for reading and writing: its descriptor, or -1, with EEXIST if the name is taken. `until_closed`: nothing
// is left of it afterwards, and the name may never appear. Not inherited by other programs.
enum class Lifetime {
    kept,
    until_closed
};
int create_file(const std::string &path, unsigned permissions, Lifetime lifetime);

// A file in memory, with the path by which libraries open it; -1 where a system has no such files.
int create_file_in_memory(std::string &path);

void close_file(int file);

// All of these bytes, `place` bytes from the beginning.
bool read_bytes_at(int file, uint64_t place, void *data, size_t size);
bool write_bytes_at(int file, uint64_t place, const void *data, size_t size);

bool set_permissions(const std::string &path, unsigned permissions);
bool make_durable(const std::string &file);  // its content survives a power cut
void make_names_durable(const std::string &folder);
bool replace_file(const std::string &from, const std::string &to);
bool remove_file(const std::string &path);

std::FILE *open_stream(const std::string &path, const char *mode);
std::FILE *open_bytes(const void *data, size_t size);  // for reading, without a copy where that is possible
bool seek(std::FILE *file, int64_t offset, int whence);
int64_t tell(std::FILE *file);  // -1: unknown

bool create_private_folder(const std::string &path);  // false, with EEXIST, if the name is taken
std::string temporary_folder();                       // without a slash at its end

// Whether a file name fits a pattern with *, ? and [a-z]; * and ? also match a slash.
bool fits_pattern(const std::string &pattern, const std::string &name);

// A lock on a folder until the object dies or the process ends.
class FolderLock {
public:
    FolderLock() = default;
    ~FolderLock();
    FolderLock(const FolderLock &) = delete;
    FolderLock &operator=(const FolderLock &) = delete;

    // False: another process has it. True also where the file system has no locks.
    bool acquire(const std::string &folder);

private:
    intptr_t handle_ = -1;
};

unsigned long process_number();
bool is_running(unsigned long process);  // true also if that is unknown

// Writing beyond the limit of a file (ulimit -f) fails like a full disk, instead of ending the process.
void survive_size_limits();

bool is_terminal(std::FILE *stream);

uint64_t available_memory_bytes();  // of the machine, or the limit of the process if that is less; 0: unknown
uint64_t peak_memory_bytes();       // the largest resident set of this process; 0: unknown

}  // namespace lensprof::system
