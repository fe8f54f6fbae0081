// Options that select profiles by camera, lens and setting.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <lensprof/lensprof.h>

#include "cli/program/options.hpp"
#include "photo/base/databases.hpp"
#include "photo/base/library.hpp"

namespace lensprof {

// All rows of a listing function of the store; other processes may add rows between two calls.
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

// Camera, lens and setting from the command line; fields not given match anything.
class KeyFilter {
public:
    // Declares --camera and others, and --key, whose further keys are declared with what this returns.
    Keys add_options(Command &command);

    bool is_empty() const;

    // Failure (usage) for names too long to be stored.
    void check_names() const;
    bool has_camera_or_lens() const { return !camera_.empty() || !lens_.empty(); }

    // The given fields, the rest unknown; `processing` if none was given.
    lensprof_profile_key key(uint32_t processing) const;
    // Only camera, lens, unit and style, for any setting and processing.
    KeyFilter without_setting() const;

    bool has_processing() const { return processing_.has_value(); }

    // Overrides fields of the key with the given ones.
    void put_into(lensprof_profile_key &key) const;

    // Rows of the matching profiles, in the order of lensprof_store_list, and all damaged rows; `db` is the name for
    // messages.
    std::vector<lensprof_store_row> rows(lensprof_store *store, const std::string &db) const;

    // As rows(), but names of camera and lens may be written as lookups accept them or, if none matches, be words of
    // the names.
    std::vector<lensprof_store_row> matching_rows(lensprof_store *store, const std::string &db) const;

    // The profiles with these ids in the first database or, without ids, those of matching_rows() in all databases, or
    // with `of_first` in the first that has a match; Failure (not_found).
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
