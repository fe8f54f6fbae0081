#include "photo/base/output_file.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <mutex>
#include <system_error>

#include "photo/base/paths.hpp"
#include "photo/system/system.hpp"

namespace lensprof {

namespace {

[[noreturn]] void fail(const std::string &path, int error_number) {
    const char *advice = "check the folder and its permissions";
    bool is_full = error_number == ENOSPC || error_number == EFBIG;
#ifdef EDQUOT
    is_full |= error_number == EDQUOT;
#endif
    if (is_full) advice = "free some space or write to another disk";
    throw Failure(LENSPROF_ERROR_WRITE, path + ": cannot write: " + system_text(error_number) + "; " + advice);
}

// A rename would replace the link, not the file it points to.
std::string follow_links(const std::string &path) {
    const std::string real = system::resolve_links(path);
    return real.empty() ? path : real;
}

constexpr unsigned owner_writes = 0200;  // of the permissions

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
int create_temporary(const std::string &target, unsigned permissions, system::Lifetime lifetime, std::string &name) {
    const auto extension = extension_of(target);
    return create_numbered(folder_of(target) + ".lensprof-", extension, name,
                           [&] { return system::create_file(name, permissions, lifetime); });
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
    return !system::is_running(std::strtoul(pid.c_str(), nullptr, 10));
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

int create_numbered(const std::string &start, const std::string &end, std::string &name,
                    const std::function<int()> &create) {
    static std::atomic<unsigned> counter{0};
    for (int attempt = 0; attempt < 1000; ++attempt) {
        name = start + std::to_string(system::process_number()) + "-" + std::to_string(++counter) + end;
        const int result = create();
        if (result >= 0 || errno != EEXIST) return result;
    }
    return -1;
}

int open_unnamed(const std::string &neighbour) {
    std::string name;
    return create_temporary(neighbour, 0600, system::Lifetime::until_closed, name);
}

void check_folder(const std::string &folder, const std::string &item, lensprof_status folder_status,
                  lensprof_status write_status) {
    const std::string existing = existing_part(absolute_path(folder));
    if (!is_folder(existing))
        throw Failure(folder_status, item + ": " + existing + " is not a folder; give another name");
    if (!system::can_write_in(existing))
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
    const system::FileStatus status = system::status_of(target_);
    const bool exists = status.kind != system::FileStatus::Kind::missing;
    if (exists && status.kind != system::FileStatus::Kind::file)
        throw Failure(LENSPROF_ERROR_ARGUMENT, path_ + ": cannot write: not a regular file; give the name of a file");
    const int file = create_temporary(target_, 0666, system::Lifetime::kept, temporary_);
    if (file < 0) fail(path_, errno);
    system::close_file(file);
    // Best effort: a file system without permissions refuses this, but the picture matters more.
    mode_ = exists ? status.permissions : 0;
    if (exists) system::set_permissions(temporary_, mode_ | owner_writes);  // writable until it is complete
}

OutputFile::~OutputFile() {
    if (!temporary_.empty()) system::remove_file(temporary_);
}

void OutputFile::sync() {
    if (!system::make_durable(temporary_)) fail(path_, errno);
    synced_ = true;
}

void OutputFile::commit() {
    if (!synced_) sync();
    if (mode_ != 0 && (mode_ & owner_writes) == 0) system::set_permissions(temporary_, mode_);
    {
        const std::lock_guard<std::mutex> lock(watching);
        for (const CommitWatch::Note &note : watches) note(path_, temporary_);
    }
    if (!system::replace_file(temporary_, target_)) fail(path_, errno);
    temporary_.clear();
    // The data are durable and in place; not all file systems make the new name survive a power cut.
    const std::string folder = folder_of(target_);
    system::make_names_durable(folder.empty() ? "." : folder);
}

void OutputFile::write(const void *data, size_t bytes) {
    std::FILE *file = system::open_stream(temporary_, "wb");
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
