// What calibrate wrote into its folder, and of what: so that nothing is done twice and nothing of others is replaced.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include <nlohmann/json.hpp>

#include "cli/program/output_file.hpp"
#include "cli/report/report.hpp"

namespace lensprof {

// Sixteen hexadecimal digits (FNV-1a) of a text.
std::string digest_of_text(const std::string &text);

// Size and time of the last change of a file, "" where there is none.
std::string stamp_of(const std::string &file);

// A path in ASCII, for JSON: '%' and all other bytes outside of the printable ones as %XX; and back.
std::string ascii_path(const std::string &path);
std::string path_of_ascii(const std::string &text);

// Whether calibrate has written into a folder.
bool has_ledger(const std::string &folder);

// One run at a time works in a folder, which is locked (flock) as long as this lives.
class FolderLock {
public:
    // Failure (failed) where another run has it. A folder that is not there yet is locked by take().
    explicit FolderLock(const std::string &folder);
    ~FolderLock();
    FolderLock(const FolderLock &) = delete;
    FolderLock &operator=(const FolderLock &) = delete;
    void take();

private:
    const std::string folder_;
    int file_ = -1;
};

// A file that calibrate has not written, or that somebody has edited since, where it wants to write.
struct InTheWay : Failure {
    using Failure::Failure;
};

// The files of the folder and, as JSON, what the command wants to find again at the next run. Kept in the folder as
// `.lensprof-calibrate.json`, which is replaced as a whole whenever something changes. Between begin() and finish() a
// line is appended before a new file takes its name: with the stamp that it has by then. However a run ends, the next
// one knows by these lines which files are its own.
class Ledger {
public:
    // Reads what an earlier run has left. A damaged file counts as none: then all outputs are somebody else's. Notes
    // that were changed count as none, too, and so do those of another version.
    explicit Ledger(const std::string &folder, bool overwrite = false);

    // Whether `file` is there, written of what `key` stands for. One that somebody has edited since is.
    bool is_current(const std::string &file, const std::string &key) const;

    // Whether there is something at `file` that was not written by this command, or was edited since.
    bool is_in_the_way(const std::string &file) const;

    bool knows(const std::string &file) const { return files_.count(name_of(file)) != 0; }

    // Notes that `file` is about to be written; save() must follow before it is. InTheWay (usage) unless `overwrite`. A
    // link is removed: what it leads to is in another folder.
    void begin(const std::string &file, const std::string &key);
    void finish(const std::string &file);            // it was
    void abandon(const std::string &file);           // it was not, and shall not be
    bool is_written(const std::string &file) const;  // since begin()

    // Removes a file that was written by this command and that nobody has edited.
    void remove(const std::string &file);

    // Registration and panoramas of earlier runs; null where there are none.
    Json notes;

    void save();  // where something has changed

private:
    struct Entry {
        std::string key, stamp;  // stamp: as it was written; "" = not yet
    };

    std::string name_of(const std::string &file) const;  // in the folder
    void read(const std::string &text);
    void settle(const Json &begun, const std::string &lines);
    void note_commit(const std::string &file, const std::string &temporary);

    const std::string folder_, path_;
    const bool overwrite_;
    std::string saved_;
    std::map<std::string, Entry> files_, begun_;
    std::mutex writing_;
    std::unique_ptr<CommitWatch> watch_;
};

}  // namespace lensprof
