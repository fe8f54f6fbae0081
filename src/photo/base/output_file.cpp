#include "photo/base/output_file.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <mutex>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "photo/base/paths.hpp"

namespace lensprof {

namespace {

[[noreturn]] void fail(const std::string &path, int error_number) {
    const char *advice = "check the folder and its permissions";
    if (error_number == ENOSPC || error_number == EDQUOT || error_number == EFBIG)
        advice = "free some space or write to another disk";
    throw Failure(LENSPROF_ERROR_WRITE, path + ": cannot write: " + system_text(error_number) + "; " + advice);
}

// A rename would replace the link, not the file it points to.
std::string follow_links(const std::string &path) {
    std::unique_ptr<char, void (*)(void *)> real(realpath(path.c_str(), nullptr), std::free);
    return real ? std::string(real.get()) : path;
}

std::string folder_of(const std::string &path) {
    const size_t slash = path.rfind('/');
    return slash == std::string::npos ? std::string() : path.substr(0, slash + 1);
}

std::string extension_of(const std::string &path) {
    const size_t slash = path.rfind('/');
    const size_t dot = path.rfind('.');
    if (dot == std::string::npos || (slash != std::string::npos && dot < slash)) return std::string();
    return path.substr(dot);
}

// Not derived from the final name, which may already have the maximum length.
int create_temporary(const std::string &target, mode_t mode, std::string &name) {
    static std::atomic<unsigned> counter{0};
    for (int attempt = 0; attempt < 1000; ++attempt) {
        name = folder_of(target) + ".lensprof-" + std::to_string(getpid()) + "-" + std::to_string(++counter)
               + extension_of(target);
        const int file = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
        if (file >= 0 || errno != EEXIST) return file;
    }
    return -1;
}

int sync_path(const std::string &path, int flags) {
    const int file = open(path.c_str(), flags | O_CLOEXEC);
    if (file < 0) return errno;
    const int error_number = fsync(file) == 0 ? 0 : errno;
    close(file);
    return error_number;
}

// Those of all calls that write folders at this time.
std::mutex watching;
std::list<CommitWatch::Note> watches;

}  // namespace

namespace {

// Whether the name is ".lensprof-PID-NUMBER.png", as made by create_temporary(), of a process that no longer exists.
bool is_left_over(const std::string &name) {
    const std::string start = ".lensprof-";
    const size_t dash = name.find('-', start.size()), end = std::min(name.find('.', start.size()), name.size());
    if (name.compare(0, start.size(), start) != 0 || dash == std::string::npos || dash > end) return false;
    const std::string pid = name.substr(start.size(), dash - start.size()),
                      number = name.substr(dash + 1, end - dash - 1);
    for (const std::string &digits : {pid, number})
        if (digits.empty() || digits.size() > 9 || digits.find_first_not_of("0123456789") != std::string::npos)
            return false;
    return kill(static_cast<pid_t>(std::atol(pid.c_str())), 0) != 0 && errno == ESRCH;
}

}  // namespace

void remove_stale_temporaries(const std::string &folder) {
    namespace fs = std::filesystem;
    std::error_code error, ignored;
    std::vector<fs::path> left_over;
    const auto options = fs::directory_options::skip_permission_denied;
    for (fs::recursive_directory_iterator entry(folder, options, error), end; !error && entry != end;
         entry.increment(error))
        if (entry->is_regular_file(ignored) && !entry->is_symlink(ignored)
            && is_left_over(entry->path().filename().string()))
            left_over.push_back(entry->path());
    for (const fs::path &file : left_over) fs::remove(file, ignored);
}

CommitWatch::CommitWatch(Note note) {
    const std::lock_guard<std::mutex> lock(watching);
    place_ = watches.insert(watches.end(), std::move(note));
}

CommitWatch::~CommitWatch() {
    const std::lock_guard<std::mutex> lock(watching);
    watches.erase(place_);
}

int open_unnamed(const std::string &neighbour) {
#ifdef O_TMPFILE
    const std::string folder = folder_of(neighbour);
    const int unnamed = open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (unnamed >= 0) return unnamed;
#endif
    std::string name;  // not every file system supports unnamed files
    const int created = create_temporary(neighbour, 0600, name);
    if (created < 0) return -1;
    close(created);
    const int file = open(name.c_str(), O_RDWR | O_CLOEXEC);
    unlink(name.c_str());
    return file;
}

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

void check_folder(const std::string &folder, const std::string &item, lensprof_status folder_status,
                  lensprof_status write_status) {
    const std::string existing = existing_part(absolute_path(folder));
    if (!is_folder(existing))
        throw Failure(folder_status, item + ": " + existing + " is not a folder; give another name");
    if (access(existing.c_str(), W_OK | X_OK) != 0)
        throw Failure(write_status, item + ": cannot write in " + existing + ": " + system_text(errno)
                                        + "; check its permissions, or give another folder");
}

void check_not_reserved(const std::string &path, const std::string &what, const std::vector<std::string> &reserved) {
    for (const std::string &other : reserved)
        if (is_same_file(path, other))
            throw Failure(LENSPROF_ERROR_ARGUMENT, path + ": would be overwritten; give the " + what + " another name");
}

void check_output_file(const std::string &path) { const OutputFile attempt(path); }

void check_output_folder(const std::string &folder) {
    check_folder(folder, folder, LENSPROF_ERROR_ARGUMENT, LENSPROF_ERROR_WRITE);
}

void make_folder(const std::string &folder) {
    if (!is_folder(folder)) check_output_folder(folder);
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw Failure(LENSPROF_ERROR_WRITE,
                      folder + ": cannot be created: " + system_text(error.value()) + "; give another name");
}

std::string system_text(int error_number) { return std::generic_category().message(error_number); }

OutputFile::OutputFile(const std::string &path) : path_(path), target_(follow_links(path)) {
    struct stat status = {};
    const bool exists = stat(target_.c_str(), &status) == 0;
    if (exists && !S_ISREG(status.st_mode))
        throw Failure(LENSPROF_ERROR_ARGUMENT, path_ + ": cannot write: not a regular file; give the name of a file");
    const int file = create_temporary(target_, 0666, temporary_);
    if (file < 0) fail(path_, errno);
    // Best effort: a file system without permissions refuses this, but the picture matters more.
    mode_ = exists ? status.st_mode & 07777 : 0;
    if (exists && fchmod(file, mode_ | S_IWUSR) != 0) errno = 0;  // writable until it is complete
    close(file);
}

OutputFile::~OutputFile() {
    if (!temporary_.empty()) unlink(temporary_.c_str());
}

void OutputFile::sync() {
    const int error_number = sync_path(temporary_, O_RDONLY);
    if (error_number != 0) fail(path_, error_number);
    synced_ = true;
}

void OutputFile::commit() {
    if (!synced_) sync();
    if (mode_ && !(mode_ & S_IWUSR) && chmod(temporary_.c_str(), mode_) != 0) errno = 0;
    {
        const std::lock_guard<std::mutex> lock(watching);
        for (const CommitWatch::Note &note : watches) note(path_, temporary_);
    }
    if (rename(temporary_.c_str(), target_.c_str()) != 0) fail(path_, errno);
    temporary_.clear();
    // The data are durable and in place; not all file systems make the new name survive a power cut.
    const std::string folder = folder_of(target_);
    sync_path(folder.empty() ? "." : folder, O_RDONLY | O_DIRECTORY);
}

void OutputFile::write(const void *data, size_t bytes) {
    std::FILE *file = std::fopen(temporary_.c_str(), "wb");
    if (!file) fail(path_, errno);
    errno = 0;
    const bool written = std::fwrite(data, 1, bytes, file) == bytes;
    const int write_error = errno;
    if (std::fclose(file) != 0 || !written) fail(path_, write_error != 0 ? write_error : errno);
}

void OutputFiles::add(const std::string &path, const std::string &text) {
    files_.push_back(std::make_unique<OutputFile>(path));
    files_.back()->write(text.data(), text.size());
}

const std::string &OutputFiles::temporary_for(const std::string &path) {
    files_.push_back(std::make_unique<OutputFile>(path));
    return files_.back()->temporary();
}

void OutputFiles::commit() {
    for (auto &file : files_) file->commit();
}

void write_file(const std::string &path, const void *data, size_t bytes) {
    OutputFile output(path);
    output.write(data, bytes);
    output.commit();
}

}  // namespace lensprof
