// What calibrate wrote into its folder, and of what: so that nothing is done twice and nothing of others is replaced.
#pragma once

#include <map>
#include <string>

#include <nlohmann/json.hpp>

#include "cli/report/report.hpp"

namespace lensprof {

// Sixteen hexadecimal digits (FNV-1a) of a text.
std::string digest_of_text(const std::string &text);

// Size and time of the last change of a file, "" where there is none.
std::string stamp_of(const std::string &file);

// A path in ASCII, for JSON: '%' and all other bytes outside of the printable ones as %XX; and back.
std::string ascii_path(const std::string &path);
std::string path_of_ascii(const std::string &text);

// The files of the folder and, as JSON, what the command wants to find again at the next run. Kept in the folder as
// `.lensprof-calibrate.json`, which is replaced as a whole whenever something changes.
class Ledger {
public:
    // Reads what an earlier run has left. A damaged file counts as none: then all outputs are somebody else's.
    explicit Ledger(const std::string &folder);

    // Whether `file` is there, written of what `key` stands for. One that somebody has edited since is.
    bool is_current(const std::string &file, const std::string &key) const;

    // Whether there is something at `file` that was not written by this command, or was edited since.
    bool is_in_the_way(const std::string &file) const;

    bool knows(const std::string &file) const { return files_.count(ascii_path(file)) != 0; }

    // Notes that `file` is about to be written; save() must follow before it is. However the run ends, the next one
    // sees by the file's stamp whether it was.
    void begin(const std::string &file, const std::string &key);
    void finish(const std::string &file);            // it was
    bool is_written(const std::string &file) const;  // since begin()

    // Removes a file that was written by this command and that nobody has edited.
    void remove(const std::string &file);

    // Registration and panoramas of earlier runs; null where there are none.
    Json notes;

    void save();  // where something has changed

private:
    struct Entry {
        std::string key, stamp;  // stamp: as it was written; while is_begun as it was before
        bool is_begun = false;
    };

    std::string path_, saved_;
    std::map<std::string, Entry> files_;
};

}  // namespace lensprof
