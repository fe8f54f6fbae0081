// Converts status codes of the library to failures, and gives its handles owners.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <lensprof/lensprof.h>

#include "photo/base/failure.hpp"

namespace lensprof {

// Throws Failure with the status, unless it is OK. The text is `item`: error text (or the name of the
// status otherwise).
void check(lensprof_status status, const std::string &item, const lensprof_error *error = nullptr);

// A message of the library, with the words that identify its item replaced by `name`.
std::string with_name(const std::string &text, const lensprof_item &item, const std::string &name);

// Like check; if the error identifies an item of `kind`, its name is taken from `names`.
void check_named(lensprof_status status, const std::string &item, const lensprof_error &error, lensprof_item_kind kind,
                 const std::vector<std::string> &names);

// The output of a library function write(data, capacity, &count, &error) as in lensprof/base.h. `names` are the names
// of its profiles, in case an error identifies one.
template <class Write>
std::string written(const std::string &item, Write write, const std::vector<std::string> &names = {}) {
    lensprof_error error{};
    size_t count = 0;
    check_named(write(nullptr, 0, &count, &error), item, error, LENSPROF_ITEM_PROFILE, names);
    std::string text(count, 0);
    if (count) check_named(write(text.data(), count, &count, &error), item, error, LENSPROF_ITEM_PROFILE, names);
    return text;
}

// The bytes of a file with these profiles, by lensprof_export. `names` are theirs in a Failure.
std::string exported(const std::string &item, const std::vector<const lensprof_profile *> &profiles,
                     const lensprof_export_options &options, const std::vector<std::string> &names = {});

struct StoreClose {
    void operator()(lensprof_store *store) const { lensprof_store_close(store); }
};
using Store = std::unique_ptr<lensprof_store, StoreClose>;

std::unique_ptr<lensprof_profile> new_profile();  // initialised

struct StoredProfile {
    int64_t id;  // 0: from a file
    std::unique_ptr<lensprof_profile> profile;
    std::string database = {};  // if there are several
};

// Opens the database `path` or, if that is empty, the user's own, $XDG_DATA_HOME/lensprof/profiles.db (else under
// ~/.local/share), whose folder is created if `mode` may create it.
Store open_store(const std::string &path, lensprof_store_mode mode);
std::string store_path(const std::string &path);

// That of the user's own database; empty for a process without a home folder.
std::string user_store_path();

// Failure (store) if the folder of a named database does not exist.
void require_folder(const std::string &path);

struct PtoDestroy {
    void operator()(lensprof_pto *pto) const { lensprof_pto_destroy(pto); }
};

// Copying it copies the project.
struct Pto : std::unique_ptr<lensprof_pto, PtoDestroy> {
    using std::unique_ptr<lensprof_pto, PtoDestroy>::unique_ptr;
    Pto(const Pto &other);
    Pto(Pto &&) = default;
    Pto &operator=(Pto other) {
        swap(other);
        return *this;
    }
};

Pto read_pto(const std::string &path);
Pto parse_pto(const std::string &text, const std::string &item);  // `item` is its name in a Failure
std::string pto_name(const lensprof_pto &pto, uint32_t index);
std::string pto_text(const lensprof_pto &pto);

// Copies a text into a fixed field of a key or provenance, truncated between UTF-8 characters; control characters
// become blanks, and in text that is not UTF-8 all non-ASCII bytes become question marks.
void set_text(char *field, size_t size, const std::string &text);

}  // namespace lensprof
