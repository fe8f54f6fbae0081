// Records what calibrate wrote into its folder and from which inputs, so that nothing is done twice and no foreign file
// is replaced.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "photo/base/output_file.hpp"
#include "photo/pictures/named_pictures.hpp"
#include "photo/report/report.hpp"
#include "photo/system/system.hpp"

namespace lensprof {

// Sixteen hexadecimal digits (FNV-1a) of a text.
std::string digest_of_text(std::string_view text);

// Size and modification time of a file; "" if it does not exist.
std::string stamp_of(const std::string &file);

// A path as ASCII for JSON: '%' and all bytes that are not printable ASCII are written as %XX. And the reverse.
std::string ascii_path(const std::string &path);
std::string path_of_ascii(const std::string &text);

// Whether calibrate has written into a folder.
bool has_ledger(const std::string &folder);

// Allows one run at a time per folder, which stays locked (flock) for the lifetime of this object.
class FolderLock {
public:
    // Failure (failed) if another run holds the lock. A folder that does not exist yet is locked by acquire().
    explicit FolderLock(const std::string &folder);
    void acquire();

private:
    const std::string folder_;
    system::FolderLock lock_;
};

// Thrown for an output path with a file that calibrate did not write or that was modified since.
struct ForeignFile : Failure {
    using Failure::Failure;
};

// The files of the folder and, as JSON, the state for the next run. Stored in the folder as `.lensprof-calibrate.json`,
// which save() replaces as a whole. Between begin() and finish() a line with stamp and key of each new file is appended
// before the file gets its name. However a run ends, the next one recognises its own files by these lines.
class Ledger {
public:
    // Reads the state of an earlier run. A damaged file is treated as missing: then all outputs count as foreign.
    // Modified notes and notes of another version are treated as missing too.
    // `records`: another name of it.
    explicit Ledger(const std::string &folder, bool overwrite = false, const char *records = calibrate_records);

    // Whether `file` exists and was written from the inputs that `key` identifies. True even if it was modified since.
    bool is_current(const std::string &file, const std::string &key) const;

    // Whether a file exists at `file` that this command did not write or that was modified since.
    bool is_foreign(const std::string &file) const;

    bool contains(const std::string &file) const { return files_.count(name_of(file)) != 0; }

    // Records that `file` is about to be written, in a folder in which save() was called once. Throws ForeignFile
    // (usage) unless `overwrite`. A link is removed because its target is in another folder.
    void begin(const std::string &file, const std::string &key);
    void finish(const std::string &file);            // it was written
    void abandon(const std::string &file);           // it was not written and will not be
    bool is_written(const std::string &file) const;  // since begin()

    // Removes a file that this command wrote and nobody modified.
    void remove(const std::string &file);

    // Registration and panoramas of earlier runs; null if not found.
    Json notes;

    void save();   // if something has changed
    void erase();  // nothing is left to recognise

private:
    struct Entry {
        std::string key, stamp;  // stamp: as of writing; "" = not yet written
    };

    std::string name_of(const std::string &file) const;  // relative to the folder
    void read(const std::string &text);
    void recover_files(const std::string &lines);
    void note_commit(const std::string &file, const std::string &temporary);

    const std::string folder_, path_;
    const bool overwrite_;
    std::string saved_;
    std::map<std::string, Entry> files_, begun_;
    mutable std::mutex writing_;  // of begun_ and saved_
    std::unique_ptr<CommitWatch> watch_;
};

}  // namespace lensprof
