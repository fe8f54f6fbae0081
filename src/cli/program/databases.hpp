// The databases that lookups ask, in their order.
#pragma once

#include <string>
#include <vector>

#include "cli/program/library.hpp"
#include "cli/program/options.hpp"

namespace lensprof {

// --db FILE, any number of times.
void declare_databases(Command &command, std::vector<std::string> &files, const std::string &more = "");

// The same for commands that show what is in all of them.
void declare_listed_databases(Command &command, std::vector<std::string> &files, const std::string &more = "");

// lensprof/lensfun.db as `make install` puts it: in the program's own share folder, else in $XDG_DATA_DIRS. Empty where
// there is none that can be read.
std::string installed_database();

// What --db names; without any, the user's own database and then the installed one, as far as they are there.
std::vector<std::string> databases_of(const std::vector<std::string> &named);

// Open for reading. The files must be there.
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

    // A last column of a row, "  in a.db", where there are several.
    std::string column(size_t index) const { return size() > 1 ? "  in " + file(index) : std::string(); }

    // lensprof_store_lookup_in of all of them. NOT_FOUND is returned, every other failure thrown.
    lensprof_status look_up(const lensprof_profile_key &key, const lensprof_lookup_options &options,
                            lensprof_profile &profile, lensprof_lookup &how) const;

private:
    std::vector<std::string> files_;
    std::vector<Store> stores_;
};

}  // namespace lensprof
