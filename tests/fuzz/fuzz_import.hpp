// Common parts of the fuzz targets for readers of falloffs: checks of entries, and words of XML.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <lensprof/formats.h>

#include "fuzz_main.hpp"

namespace {

using Profiles = std::vector<std::unique_ptr<lensprof_profile>>;

struct Visited {
    Profiles usable;
    size_t entries = 0;
};

lensprof_status visit(void *user, const lensprof_import_entry *entry) {
    auto *visited = static_cast<Visited *>(user);
    const lensprof_profile &profile = *entry->profile;
    const bool valid = lensprof_profile_validate(&profile) == LENSPROF_OK;
    demand(valid == (entry->usable == 1), "usable and valid contradict each other");
    demand(valid || profile.provenance.doubt[0], "not usable without a reason");
    demand(lensprof_profile_key_validate(&profile.key) == LENSPROF_OK, "an invalid key");
    visited->entries++;
    if (valid) visited->usable.push_back(std::make_unique<lensprof_profile>(profile));
    return LENSPROF_OK;
}

void check_reading(lensprof_status status, const lensprof_error &error, const Visited &visited,
                   const std::vector<lensprof_status> &allowed) {
    demand(status == LENSPROF_OK || std::count(allowed.begin(), allowed.end(), status), "unexpected status");
    demand((status == LENSPROF_OK) == !error.text[0], "status and error text contradict each other");
    demand(status == LENSPROF_OK || visited.entries == 0, "entries delivered despite an error");
}

const std::vector<std::string> kXmlWords = {
    "<",     ">",      "/>",   "<!--",       "-->",      "<![CDATA[", "]]>",           "\"",  "'", "=",
    "&",     "&amp;",  "&#0;", "&#x10FFFF;", "&#xD800;", "<?",        "<!DOCTYPE a [", "\n",  "0", "-1",
    "1e308", "1e-308", "nan",  "inf",        ":",        ",",         "\xC3\xA9",      "\xFF"};

}  // namespace
