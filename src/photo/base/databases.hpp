// The databases that lookups search, in order.
#pragma once

#include <string>
#include <vector>

#include "photo/base/library.hpp"

namespace lensprof {

// lensprof/lensfun.db as installed by `make install`: in the program's own share folder, else in $XDG_DATA_DIRS. Empty
// if no readable one exists.
std::string installed_database();

// The databases named by the user; by default the user's own database and the installed one, if they exist.
std::vector<std::string> databases_of(const std::vector<std::string> &named);

// Those of them that exist.
std::vector<std::string> existing(std::vector<std::string> databases);

// The same, for what can do without one: a process without a home folder has the installed one.
std::vector<std::string> existing_databases(const std::vector<std::string> &named);

// Opens databases for reading. The files must exist.
class Databases {
public:
    Databases() = default;
    explicit Databases(const std::vector<std::string> &files);

    bool is_empty() const { return stores_.empty(); }
    size_t size() const { return stores_.size(); }
    lensprof_store *store(size_t index) const { return stores_[index].get(); }
    const std::string &file(size_t index) const { return files_[index]; }
    const std::vector<std::string> &files() const { return files_; }
    std::string names() const;  // "a.db, b.db"

    // The last column of a row, "  in a.db", if there are several databases.
    std::string column(size_t index) const { return size() > 1 ? "  in " + file(index) : std::string(); }

    // lensprof_store_lookup_in for all of them. Returns NOT_FOUND, throws on every other failure.
    lensprof_status look_up(const lensprof_profile_key &key, const lensprof_lookup_options &options,
                            lensprof_profile &profile, lensprof_lookup &lookup) const;

private:
    std::vector<std::string> files_;
    std::vector<Store> stores_;
};

}  // namespace lensprof
