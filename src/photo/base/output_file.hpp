// Files that are written completely or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <vector>

#include "photo/base/failure.hpp"

namespace lensprof {

// A file being written. The bytes go to a temporary file in the same folder (a rename is atomic only within one file
// system), which commit() makes durable and renames to the final path. Without commit() nothing is left, and an
// existing file of that name stays unchanged. A symbolic link is followed; the permissions of an existing file are
// kept. All functions throw Failure with the path: LENSPROF_ERROR_ARGUMENT if the path is not a regular file, else
// LENSPROF_ERROR_WRITE. Threads: different objects may be used by different threads.
class OutputFile {
public:
    explicit OutputFile(const std::string &path);
    ~OutputFile();
    OutputFile(const OutputFile &) = delete;
    OutputFile &operator=(const OutputFile &) = delete;

    // Path of the temporary file: exists, is empty, has the extension of the final path. May be opened by name and
    // rewritten as often as needed.
    const std::string &temporary() const { return temporary_; }

    // Writes exactly these bytes to the temporary file.
    void write(const void *data, size_t bytes);

    // Makes the content of the temporary file durable. Part of commit(), for callers that want to do it earlier; the
    // file must not be changed afterwards.
    void sync();

    void commit();

private:
    bool synced_ = false;
    unsigned mode_ = 0;   // permissions of the file that is replaced; 0 = no file is replaced
    std::string path_;    // as given, for messages
    std::string target_;  // with symbolic links resolved
    std::string temporary_;
};

// Removes temporary files of killed processes from a folder and its subfolders.
void remove_stale_temporaries(const std::string &folder);

// While this object lives, every commit() of this process calls `note` before the file is renamed, with the path as
// given and the temporary file, on the committing thread, one at a time.
class CommitWatch {
public:
    using Note = std::function<void(const std::string &path, const std::string &temporary)>;
    explicit CommitWatch(Note note);
    ~CommitWatch();
    CommitWatch(const CommitWatch &) = delete;
    CommitWatch &operator=(const CommitWatch &) = delete;

private:
    std::list<Note>::iterator place_;
};

// Files that are kept complete under temporary names until everything else has succeeded.
class OutputFiles {
public:
    void add(const std::string &path, const std::string &text);
    const std::string &temporary_for(const std::string &path);  // for a file that something else writes
    void commit();

private:
    std::vector<std::unique_ptr<OutputFile>> files_;
};

// Writes these bytes to the file `path`, completely or not at all.
void write_file(const std::string &path, const void *data, size_t bytes);

// Opens an unnamed file for reading and writing in the folder of `neighbour`; it is deleted when closed. Returns -1 and
// sets errno if this fails.
int open_unnamed(const std::string &neighbour);

// Calls create() with `name` set to `start`, the number of this process, a number and `end`, until the name is not
// taken. Returns its result, at least 0, or -1 with errno.
int create_numbered(const std::string &start, const std::string &end, std::string &name,
                    const std::function<int()> &create);

// Failure about `item` if `folder` is not writable and cannot be created: with `folder_status` if a file has its
// name, else `write_status`. For checks before long computations.
void check_folder(const std::string &folder, const std::string &item, lensprof_status folder_status,
                  lensprof_status write_status);

// Failure (usage) if a file is one of `reserved`: inputs, the database, other outputs. `what` names it: "output",
// "report".
void check_not_reserved(const std::string &path, const std::string &what, const std::vector<std::string> &reserved);

// Throws the Failure that writing this file would cause, before the work is done.
void check_output_file(const std::string &path);

// The output folder of a command, created if missing. Failure (usage or failed) with its name.
void check_output_folder(const std::string &folder);
void make_folder(const std::string &folder);

// Error text such as "No space left on device" for ENOSPC; the same in every locale of the C++ library.
std::string system_text(int error_number);

}  // namespace lensprof
