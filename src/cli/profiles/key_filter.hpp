// Options that choose profiles by what they are for.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <lensprof/lensprof.h>

#include "cli/program/databases.hpp"
#include "cli/program/library.hpp"
#include "cli/program/options.hpp"

namespace lensprof {

// All rows that a listing function of the store has: others may add some between two calls.
template <typename Row, typename List>
std::vector<Row> listed(const std::string &db, const List &list) {
    lensprof_error error{};
    uint32_t found = 0;
    check(list(nullptr, 0, &found, &error), store_path(db), &error);
    std::vector<Row> rows;
    lensprof_status status = LENSPROF_OK;
    do {
        rows.resize(found);
        if (found) status = list(rows.data(), found, &found, &error);
    } while (status == LENSPROF_ERROR_CAPACITY);
    check(status, store_path(db), &error);
    rows.resize(std::min<size_t>(rows.size(), found));
    return rows;
}

// Camera, lens and setting as asked for; what is not given may be anything.
class KeyFilter {
public:
    void add_options(Command &command);

    bool is_empty() const;

    // Failure (usage) for names that would be cut where they are stored.
    void check_names() const;
    bool has_camera_or_lens() const { return !camera_.empty() || !lens_.empty(); }

    // What was given, the rest unknown; `processing` where none was given.
    lensprof_profile_key key(uint32_t processing) const;
    // Camera, lens, unit and style alone, at any setting and processing.
    KeyFilter without_setting() const;

    bool has_processing() const { return processing_.has_value(); }

    // What was given in place of what the key has.
    void put_into(lensprof_profile_key &key) const;

    // Rows of the profiles that match, in the order of lensprof_store_list, and all damaged rows; `db` as given, for
    // texts.
    std::vector<lensprof_store_row> rows(lensprof_store *store, const std::string &db) const;

    // As rows(), but names of camera and lens may be written as lookups take them, and where none is that, be words of
    // the names.
    std::vector<lensprof_store_row> matching_rows(lensprof_store *store, const std::string &db) const;

    // The profiles with these ids in the first database, or where there are none those of matching_rows() in all of
    // them, or `of_first` in the first that has any; Failure (not_found).
    std::vector<StoredProfile> profiles(const Databases &databases, const std::vector<int64_t> &ids,
                                        bool of_first) const;

    // "no profile for CAMERA with this setting in FILE; what to do".
    std::string nothing_found(const std::string &db) const;

private:
    std::vector<lensprof_store_row> rows_of(lensprof_store *store, const std::string &db,
                                            const lensprof_profile_key &filter) const;

    std::string maker_, camera_, lens_, unit_, style_;
    std::optional<uint32_t> processing_;
    double focal_ = LENSPROF_UNKNOWN, aperture_ = LENSPROF_UNKNOWN, distance_ = LENSPROF_UNKNOWN;
};

}  // namespace lensprof
