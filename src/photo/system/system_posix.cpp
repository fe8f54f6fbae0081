#ifndef _WIN32
#include "photo/system/system.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <limits>
#include <memory>

#include <fcntl.h>
#include <fnmatch.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace lensprof::system {
namespace {

FileStatus status_from(const struct stat &status) {
    FileStatus result;
    result.kind = S_ISREG(status.st_mode)   ? FileStatus::Kind::file
                  : S_ISDIR(status.st_mode) ? FileStatus::Kind::folder
                                            : FileStatus::Kind::other;
    result.bytes = static_cast<uint64_t>(status.st_size);
#ifdef __APPLE__
    const struct timespec &modified = status.st_mtimespec;
#else
    const struct timespec &modified = status.st_mtim;
#endif
    result.modified_s = modified.tv_sec;
    result.modified_ns = modified.tv_nsec;
    result.permissions = status.st_mode & 07777;
    result.identity = std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino);
    return result;
}

bool sync_path(const std::string &path, int flags) {
    const int file = open(path.c_str(), flags | O_CLOEXEC);
    if (file < 0) return false;
    const int error_number = fsync(file) == 0 ? 0 : errno;
    close(file);
    errno = error_number;
    return error_number == 0;
}

}  // namespace

FileStatus status_of(const std::string &path) {
    struct stat status = {};
    return stat(path.c_str(), &status) == 0 ? status_from(status) : FileStatus();
}

FileStatus status_of(std::FILE *file) {
    struct stat status = {};
    return fstat(fileno(file), &status) == 0 ? status_from(status) : FileStatus();
}

std::string resolve_links(const std::string &path) {
    const std::unique_ptr<char, void (*)(void *)> real(realpath(path.c_str(), nullptr), std::free);
    return real ? std::string(real.get()) : std::string();
}

bool can_write_in(const std::string &folder) { return access(folder.c_str(), W_OK | X_OK) == 0; }

int create_file(const std::string &path, unsigned permissions, Lifetime lifetime) {
    const auto mode = static_cast<mode_t>(permissions);
#ifdef O_TMPFILE
    if (lifetime == Lifetime::until_closed) {
        const size_t slash = path.rfind('/');
        const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
        const int unnamed = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, mode);
        if (unnamed >= 0) return unnamed;  // not every file system has such files
    }
#endif
    const int file = open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (file >= 0 && lifetime == Lifetime::until_closed) unlink(path.c_str());
    return file;
}

int create_file_in_memory(std::string &path) {
#ifdef SYS_memfd_create  // the C library has a function for it from glibc 2.27 on
    constexpr unsigned close_on_exec = 1;
    const int file = static_cast<int>(syscall(SYS_memfd_create, "lensprof", close_on_exec));
    if (file >= 0) path = "/proc/self/fd/" + std::to_string(file);
    return file;
#else
    (void)path;
    return -1;
#endif
}

void close_file(int file) { close(file); }

bool read_bytes_at(int file, uint64_t place, void *data, size_t size) {
    for (size_t done = 0; done < size;) {
        const ssize_t got =
            pread(file, static_cast<char *>(data) + done, size - done, static_cast<off_t>(place + done));
        if (got < 0 && errno == EINTR) continue;
        if (got == 0) errno = EIO;  // the file ends
        if (got <= 0) return false;
        done += static_cast<size_t>(got);
    }
    return true;
}

bool write_bytes_at(int file, uint64_t place, const void *data, size_t size) {
    for (size_t done = 0; done < size;) {
        const ssize_t written =
            pwrite(file, static_cast<const char *>(data) + done, size - done, static_cast<off_t>(place + done));
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        done += static_cast<size_t>(written);
    }
    return true;
}

bool set_permissions(const std::string &path, unsigned permissions) {
    return chmod(path.c_str(), static_cast<mode_t>(permissions)) == 0;
}

bool make_durable(const std::string &file) { return sync_path(file, O_RDONLY); }

void make_names_durable(const std::string &folder) { sync_path(folder, O_RDONLY | O_DIRECTORY); }

bool replace_file(const std::string &from, const std::string &to) { return rename(from.c_str(), to.c_str()) == 0; }

bool remove_file(const std::string &path) { return unlink(path.c_str()) == 0; }

std::FILE *open_stream(const std::string &path, const char *mode) { return std::fopen(path.c_str(), mode); }

std::FILE *open_bytes(const void *data, size_t size) { return fmemopen(const_cast<void *>(data), size, "rb"); }

bool seek(std::FILE *file, int64_t offset, int whence) { return fseeko(file, static_cast<off_t>(offset), whence) == 0; }

int64_t tell(std::FILE *file) { return static_cast<int64_t>(ftello(file)); }

bool create_private_folder(const std::string &path) { return mkdir(path.c_str(), 0700) == 0; }

std::string temporary_folder() {
    const char *folder = std::getenv("TMPDIR");
    return folder && *folder ? folder : "/tmp";
}

bool fits_pattern(const std::string &pattern, const std::string &name) {
    return fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

FolderLock::~FolderLock() {
    if (handle_ >= 0) close(static_cast<int>(handle_));
}

bool FolderLock::acquire(const std::string &folder) {
    if (handle_ >= 0) return true;
    const int file = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (file >= 0 && flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        close(file);
        return false;
    }
    handle_ = file;
    return true;
}

unsigned long process_number() { return static_cast<unsigned long>(getpid()); }

bool is_running(unsigned long process) {
    return process > static_cast<unsigned long>(std::numeric_limits<pid_t>::max())
           || kill(static_cast<pid_t>(process), 0) == 0 || errno != ESRCH;
}

void survive_size_limits() { std::signal(SIGXFSZ, SIG_IGN); }

bool is_terminal(std::FILE *stream) { return isatty(fileno(stream)) != 0; }

uint64_t available_memory_bytes() {
    uint64_t bytes = std::numeric_limits<uint64_t>::max();
    const long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
    if (pages > 0 && page_bytes > 0) bytes = static_cast<uint64_t>(pages) * static_cast<uint64_t>(page_bytes);
    rlimit limit = {};
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        bytes = std::min(bytes, static_cast<uint64_t>(limit.rlim_cur));
    return bytes == std::numeric_limits<uint64_t>::max() ? 0 : bytes;
}

uint64_t peak_memory_bytes() {
    rusage usage{};
    if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
#ifdef __APPLE__
    constexpr uint64_t unit = 1;
#else
    constexpr uint64_t unit = 1024;
#endif
    return unit * static_cast<uint64_t>(usage.ru_maxrss);
}

}  // namespace lensprof::system
#endif
