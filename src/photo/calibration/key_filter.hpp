// Selects profiles by camera, lens and setting.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <lensprof/lensprof.h>

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

// Camera, lens and setting; fields not given match anything.
struct KeyFilter {
    std::string maker, camera, lens, unit, style;
    std::optional<uint32_t> processing;
    double focal = LENSPROF_UNKNOWN, aperture = LENSPROF_UNKNOWN, distance = LENSPROF_UNKNOWN;

    bool is_empty() const;

    bool has_camera_or_lens() const { return !camera.empty() || !lens.empty(); }

    // The given fields, the rest unknown; `otherwise` if no processing was given.
    lensprof_profile_key key(uint32_t otherwise) const;
    // Only camera, lens, unit and style, for any setting and processing.
    KeyFilter without_setting() const;

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
};

}  // namespace lensprof
