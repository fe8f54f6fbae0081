// Files that appear complete or not at all.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cli/program/error.hpp"

namespace lensprof {

// A file that is being written. The bytes go to a temporary file in the same folder (a rename is atomic only within
// one file system), which commit() makes durable and renames to the wanted path. Without commit() nothing is left
// and an older file of that name is as it was. A symbolic link is followed; the permissions of an older file are
// kept. Everything here throws Failure with the path in its text: ExitCode::usage where the path names what is no
// ordinary file, else ExitCode::failed.
// Threads: different objects may be used by different threads.
class OutputFile {
public:
    explicit OutputFile(const std::string &path);
    ~OutputFile();
    OutputFile(const OutputFile &) = delete;
    OutputFile &operator=(const OutputFile &) = delete;

    // Path of the temporary file: exists, empty, has the extension of the wanted path. May be opened by that name
    // and rewritten as often as needed.
    const std::string &temporary() const { return temporary_; }

    // Writes these bytes, and nothing else, to the temporary file.
    void write(const void *data, size_t bytes);

    // What the temporary file holds is on the disk, whatever happens. Part of commit(), for who wants to do it before;
    // the file must not be changed afterwards.
    void sync();

    void commit();

private:
    bool synced_ = false;
    std::string path_;    // as given, for texts
    std::string target_;  // with symbolic links followed
    std::string temporary_;
};

// Removes from a folder and its subfolders temporary files of processes that were killed.
void sweep_temporaries(const std::string &folder);

// While it lives, every commit() calls `note`, before the file takes its name, with the path as it was given and the
// temporary file: on the thread that commits. The last one that was made counts.
class CommitWatch {
public:
    using Note = std::function<void(const std::string &path, const std::string &temporary)>;
    explicit CommitWatch(Note note);
    ~CommitWatch();
    CommitWatch(const CommitWatch &) = delete;
    CommitWatch &operator=(const CommitWatch &) = delete;
};

// Files that are complete beside their final names until everything else has worked.
class OutputFiles {
public:
    void add(const std::string &path, const std::string &text);
    void commit();

private:
    std::vector<std::unique_ptr<OutputFile>> files_;
};

// Writes the file `path` with these bytes, complete or not at all.
void write_file(const std::string &path, const void *data, size_t bytes);

// Opens a file for reading and writing that has no name, in the folder of `beside`: it is gone when it is closed. -1
// and errno where there is none to be had.
int open_nameless(const std::string &beside);

// Failure about `item` where `folder` neither is one that can be written to nor can be made: with the code `no_folder`
// where a file is in its place, else `no_writing`. To be known before work that takes long.
void check_folder(const std::string &folder, const std::string &item, ExitCode no_folder, ExitCode no_writing);

// The Failure that writing this file would end in, before the work is done.
void check_output_file(const std::string &path);

// The folder for what a command writes, made where there is none. Failure (usage, or failed) names it.
void check_output_folder(const std::string &folder);
void make_folder(const std::string &folder);

// "No space left on device" for ENOSPC, and so on; the same text in every locale of the C++ library.
std::string system_text(int error_number);

}  // namespace lensprof
