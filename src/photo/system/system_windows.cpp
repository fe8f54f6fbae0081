#ifdef _WIN32
#include "photo/system/system.hpp"

#include <cerrno>
#include <ctime>
#include <memory>
#include <regex>

#include <fcntl.h>
#include <io.h>
#include <sys/stat.h>

// windows.h first, psapi.h needs it.
#define NOMINMAX
#include <windows.h>

#include <psapi.h>

namespace lensprof::system {
namespace {

std::wstring wide(const std::string &text) {
    const int bytes = static_cast<int>(text.size());
    std::wstring result(static_cast<size_t>(MultiByteToWideChar(CP_UTF8, 0, text.data(), bytes, nullptr, 0)), L'\0');
    MultiByteToWideChar(CP_UTF8, 0, text.data(), bytes, result.data(), static_cast<int>(result.size()));
    return result;
}

std::string narrow(const std::wstring &text) {
    const int count = static_cast<int>(text.size());
    const int bytes = WideCharToMultiByte(CP_UTF8, 0, text.data(), count, nullptr, 0, nullptr, nullptr);
    std::string result(static_cast<size_t>(bytes), '\0');
    WideCharToMultiByte(CP_UTF8, 0, text.data(), count, result.data(), bytes, nullptr, nullptr);
    return result;
}

// The errno that the C library sets for such an error.
int errno_of(DWORD error) {
    switch (error) {
    case ERROR_FILE_NOT_FOUND:
    case ERROR_PATH_NOT_FOUND: return ENOENT;
    case ERROR_FILE_EXISTS:
    case ERROR_ALREADY_EXISTS: return EEXIST;
    case ERROR_ACCESS_DENIED:
    case ERROR_SHARING_VIOLATION:
    case ERROR_LOCK_VIOLATION: return EACCES;
    case ERROR_DISK_FULL:
    case ERROR_HANDLE_DISK_FULL: return ENOSPC;
    case ERROR_NOT_ENOUGH_MEMORY: return ENOMEM;
    case ERROR_BUFFER_OVERFLOW:
    case ERROR_FILENAME_EXCED_RANGE: return ENAMETOOLONG;
    default: return EIO;
    }
}

bool fail() {
    errno = errno_of(GetLastError());
    return false;
}

// Closed when it goes out of scope.
class Handle {
public:
    explicit Handle(HANDLE handle) : handle_(handle) {}
    ~Handle() {
        if (*this) CloseHandle(handle_);
    }
    Handle(const Handle &) = delete;
    Handle &operator=(const Handle &) = delete;
    explicit operator bool() const { return handle_ != nullptr && handle_ != INVALID_HANDLE_VALUE; }
    HANDLE get() const { return handle_; }

private:
    HANDLE handle_;
};

constexpr DWORD share_all = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;

// Files and folders, for what is known of them.
HANDLE open_for_status(const std::string &path) {
    return CreateFileW(wide(path).c_str(), FILE_READ_ATTRIBUTES, share_all, nullptr, OPEN_EXISTING,
                       FILE_FLAG_BACKUP_SEMANTICS, nullptr);
}

FileStatus status_from(HANDLE handle) {
    BY_HANDLE_FILE_INFORMATION information = {};
    FileStatus result;
    if (!GetFileInformationByHandle(handle, &information)) return result;
    const bool is_folder = (information.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0;
    const bool is_read_only = (information.dwFileAttributes & FILE_ATTRIBUTE_READONLY) != 0;
    const auto joined = [](DWORD high, DWORD low) { return static_cast<uint64_t>(high) << 32 | low; };
    result.kind = is_folder ? FileStatus::Kind::folder : FileStatus::Kind::file;
    result.bytes = joined(information.nFileSizeHigh, information.nFileSizeLow);
    // In units of 100 ns since 1601, which is 11 644 473 600 s before 1970.
    const uint64_t ticks =
        joined(information.ftLastWriteTime.dwHighDateTime, information.ftLastWriteTime.dwLowDateTime);
    result.modified_s = static_cast<int64_t>(ticks / 10000000) - 11644473600;
    result.modified_ns = static_cast<int64_t>(ticks % 10000000) * 100;
    result.permissions = is_read_only ? 0444 : 0666;
    result.identity = std::to_string(information.dwVolumeSerialNumber) + ":"
                      + std::to_string(joined(information.nFileIndexHigh, information.nFileIndexLow));
    return result;
}

HANDLE handle_of(int file) { return reinterpret_cast<HANDLE>(_get_osfhandle(file)); }

// ReadFile and WriteFile at a place: at most this many bytes in one call.
constexpr size_t max_transfer_bytes = size_t(1) << 30;

OVERLAPPED at(uint64_t place) {
    OVERLAPPED overlapped = {};
    overlapped.Offset = static_cast<DWORD>(place);
    overlapped.OffsetHigh = static_cast<DWORD>(place >> 32);
    return overlapped;
}

}  // namespace

FileStatus status_of(const std::string &path) {
    const Handle handle(open_for_status(path));
    return handle ? status_from(handle.get()) : FileStatus();
}

FileStatus status_of(std::FILE *file) { return status_from(handle_of(_fileno(file))); }

std::string resolve_links(const std::string &path) {
    const Handle handle(open_for_status(path));
    if (!handle) return {};
    std::wstring name(GetFinalPathNameByHandleW(handle.get(), nullptr, 0, 0), L'\0');
    name.resize(GetFinalPathNameByHandleW(handle.get(), name.data(), static_cast<DWORD>(name.size()), 0));
    std::string result = narrow(name);
    for (char &c : result) c = c == '\\' ? '/' : c;
    return result.compare(0, 4, "//?/") == 0 && result.compare(4, 4, "UNC/") != 0 ? result.substr(4) : result;
}

bool can_write_in(const std::string &folder) {
    const Handle handle(CreateFileW(wide(folder).c_str(), FILE_ADD_FILE, share_all, nullptr, OPEN_EXISTING,
                                    FILE_FLAG_BACKUP_SEMANTICS, nullptr));
    return handle ? true : fail();
}

int create_file(const std::string &path, unsigned permissions, Lifetime lifetime) {
    const int flags = _O_RDWR | _O_CREAT | _O_EXCL | _O_BINARY | _O_NOINHERIT
                      | (lifetime == Lifetime::until_closed ? _O_TEMPORARY | _O_SHORT_LIVED : 0);
    return _wopen(wide(path).c_str(), flags, (permissions & 0200) != 0 ? _S_IREAD | _S_IWRITE : _S_IREAD);
}

int create_file_in_memory(std::string &) { return -1; }

void close_file(int file) { _close(file); }

bool read_bytes_at(int file, uint64_t place, void *data, size_t size) {
    for (size_t done = 0; done < size;) {
        OVERLAPPED overlapped = at(place + done);
        DWORD got = 0;
        const size_t part = size - done < max_transfer_bytes ? size - done : max_transfer_bytes;
        if (!ReadFile(handle_of(file), static_cast<char *>(data) + done, static_cast<DWORD>(part), &got, &overlapped)
            || got == 0)
            return fail();
        done += got;
    }
    return true;
}

bool write_bytes_at(int file, uint64_t place, const void *data, size_t size) {
    for (size_t done = 0; done < size;) {
        OVERLAPPED overlapped = at(place + done);
        DWORD written = 0;
        const size_t part = size - done < max_transfer_bytes ? size - done : max_transfer_bytes;
        if (!WriteFile(handle_of(file), static_cast<const char *>(data) + done, static_cast<DWORD>(part), &written,
                       &overlapped))
            return fail();
        done += written;
    }
    return true;
}

bool set_permissions(const std::string &path, unsigned permissions) {
    return _wchmod(wide(path).c_str(), (permissions & 0200) != 0 ? _S_IREAD | _S_IWRITE : _S_IREAD) == 0;
}

bool make_durable(const std::string &file) {
    const Handle handle(CreateFileW(wide(file).c_str(), GENERIC_WRITE, share_all, nullptr, OPEN_EXISTING, 0, nullptr));
    return handle && FlushFileBuffers(handle.get()) ? true : fail();
}

void make_names_durable(const std::string &) {}  // NTFS keeps a journal of them

bool replace_file(const std::string &from, const std::string &to) {
    // A file without write permission is replaced, as POSIX does.
    const std::wstring target = wide(to);
    const DWORD attributes = GetFileAttributesW(target.c_str());
    if (attributes != INVALID_FILE_ATTRIBUTES && (attributes & FILE_ATTRIBUTE_READONLY) != 0)
        SetFileAttributesW(target.c_str(), attributes & ~static_cast<DWORD>(FILE_ATTRIBUTE_READONLY));
    return MoveFileExW(wide(from).c_str(), target.c_str(), MOVEFILE_REPLACE_EXISTING) ? true : fail();
}

bool remove_file(const std::string &path) { return DeleteFileW(wide(path).c_str()) ? true : fail(); }

std::FILE *open_stream(const std::string &path, const char *mode) {
    return _wfopen(wide(path).c_str(), wide(mode).c_str());
}

std::FILE *open_bytes(const void *data, size_t size) {
    std::FILE *file = std::tmpfile();
    if (file && (std::fwrite(data, 1, size, file) != size || std::fseek(file, 0, SEEK_SET) != 0)) {
        std::fclose(file);
        return nullptr;
    }
    return file;
}

bool seek(std::FILE *file, int64_t offset, int whence) { return _fseeki64(file, offset, whence) == 0; }

int64_t tell(std::FILE *file) { return _ftelli64(file); }

bool create_private_folder(const std::string &path) {
    return CreateDirectoryW(wide(path).c_str(), nullptr) ? true : fail();  // readable as the folder above is
}

std::string temporary_folder() {
    std::wstring name(MAX_PATH + 1, L'\0');
    name.resize(GetTempPathW(static_cast<DWORD>(name.size()), name.data()));
    std::string folder = narrow(name);
    for (char &c : folder) c = c == '\\' ? '/' : c;
    while (folder.size() > 3 && folder.back() == '/') folder.pop_back();
    return folder.empty() ? "." : folder;
}

bool fits_pattern(const std::string &pattern, const std::string &name) {
    std::string expression;
    bool is_in_brackets = false;
    for (size_t i = 0; i < pattern.size(); i++) {
        const char c = pattern[i];
        if (is_in_brackets) {
            const bool is_first = pattern[i - 1] == '[';
            expression += is_first && c == '!' ? "^" : c == '\\' ? "\\\\" : std::string(1, c);
            is_in_brackets = c != ']';
        } else if (c == '*' || c == '?') {
            expression += c == '*' ? "[^]*" : "[^]";
        } else if (c == '[' && pattern.find(']', i + 1) != std::string::npos) {
            expression += c, is_in_brackets = true;
        } else {
            expression += std::string("^$\\.*+?()[]{}|").find(c) == std::string::npos ? "" : "\\";
            expression += c;
        }
    }
    try {
        return std::regex_match(name, std::regex(expression));
    } catch (const std::regex_error &) {
        return pattern == name;
    }
}

FolderLock::~FolderLock() {
    if (handle_ >= 0) CloseHandle(reinterpret_cast<HANDLE>(handle_));
}

bool FolderLock::acquire(const std::string &folder) {
    if (handle_ >= 0) return true;
    const HANDLE handle = CreateFileW(wide(folder + "/.lensprof-lock").c_str(), GENERIC_WRITE, 0, nullptr, OPEN_ALWAYS,
                                      FILE_ATTRIBUTE_HIDDEN | FILE_FLAG_DELETE_ON_CLOSE, nullptr);
    if (handle == INVALID_HANDLE_VALUE) return GetLastError() != ERROR_SHARING_VIOLATION;
    handle_ = reinterpret_cast<intptr_t>(handle);
    return true;
}

unsigned long process_number() { return GetCurrentProcessId(); }

bool is_running(unsigned long process) {
    const Handle handle(OpenProcess(SYNCHRONIZE, FALSE, process));
    if (!handle) return GetLastError() != ERROR_INVALID_PARAMETER;
    return WaitForSingleObject(handle.get(), 0) == WAIT_TIMEOUT;
}

void survive_size_limits() {}  // Windows has no such limit

bool is_terminal(std::FILE *stream) { return _isatty(_fileno(stream)) != 0; }

uint64_t available_memory_bytes() {
    MEMORYSTATUSEX status = {};
    status.dwLength = sizeof status;
    return GlobalMemoryStatusEx(&status) ? status.ullTotalPhys : 0;
}

uint64_t peak_memory_bytes() {
    PROCESS_MEMORY_COUNTERS counters = {};
    counters.cb = sizeof counters;
    return GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof counters) ? counters.PeakWorkingSetSize : 0;
}

}  // namespace lensprof::system
#endif
