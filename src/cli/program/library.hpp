// From the library's status codes to the program's failures, and its handles with an owner.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <lensprof/lensprof.h>

#include "cli/program/error.hpp"

namespace lensprof {

// Throws Failure with the exit code that belongs to the status, unless it is OK. The text is `item`: error text (or the
// status's name where there is none).
void check(lensprof_status status, const std::string &item, const lensprof_error *error = nullptr);

// A text of the library with `name` in place of the words that name its item.
std::string with_name(const std::string &text, const lensprof_item &item, const std::string &name);

// As check; the item of `kind` that the error names, if it does, has a name in `names`.
void check_named(lensprof_status status, const std::string &item, const lensprof_error &error, lensprof_item_kind kind,
                 const std::vector<std::string> &names);

// What a function of the library writes: write(data, capacity, &count, &error) as in lensprof/base.h. `names` are those
// of its profiles, where an error may name one.
template <class Write>
std::string written(const std::string &item, Write write, const std::vector<std::string> &names = {}) {
    lensprof_error error{};
    size_t count = 0;
    check_named(write(nullptr, 0, &count, &error), item, error, LENSPROF_ITEM_PROFILE, names);
    std::string text(count, 0);
    if (count) check_named(write(text.data(), count, &count, &error), item, error, LENSPROF_ITEM_PROFILE, names);
    return text;
}

struct StoreClose {
    void operator()(lensprof_store *store) const { lensprof_store_close(store); }
};
using Store = std::unique_ptr<lensprof_store, StoreClose>;

std::unique_ptr<lensprof_profile> new_profile();  // initialised

struct StoredProfile {
    int64_t id;  // 0: of a file, alone
    std::unique_ptr<lensprof_profile> profile;
    std::string database = {};  // where it is one of several
};

// The database to use: `path`, or where that is empty the user's own, $XDG_DATA_HOME/lensprof/profiles.db (else under
// ~/.local/share), whose folder is made when `mode` may create it.
Store open_store(const std::string &path, lensprof_store_mode mode);
std::string store_path(const std::string &path);

// Failure (store) where the folder of a database that is named is not there.
void demand_folder(const std::string &path);

struct PtoDestroy {
    void operator()(lensprof_pto *pto) const { lensprof_pto_destroy(pto); }
};
using Pto = std::unique_ptr<lensprof_pto, PtoDestroy>;

Pto read_pto(const std::string &path);
Pto parse_pto(const std::string &text, const std::string &item);  // `item` names it in a Failure
std::string pto_name(const lensprof_pto &pto, uint32_t index);
std::string pto_text(const lensprof_pto &pto);

// Copies a text into a fixed field of a key or provenance, cut at its size between UTF-8 characters; control
// characters become blanks, and in a text that is not UTF-8 all bytes beyond ASCII question marks.
void set_text(char *field, size_t size, const std::string &text);

// Failure (usage) for the option --maker, --camera, --lens, --unit or --style whose text a key's field would cut.
void demand_room(const std::string &maker, const std::string &camera, const std::string &lens, const std::string &unit,
                 const std::string &style);

}  // namespace lensprof
