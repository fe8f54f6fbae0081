// Questions about paths. Nothing here throws std::filesystem::filesystem_error: a path that cannot be looked at (too
// long, a link to itself, no permission) is one where there is nothing, which its reader or writer then says in its own
// words. The overloads of std::filesystem that throw are not used elsewhere (tests/lint/path_rules.py).
#pragma once

#include <cstdint>
#include <string>

namespace lensprof {

bool path_exists(const std::string &path);
bool is_folder(const std::string &path);
bool is_regular_file(const std::string &path);
uint64_t file_bytes(const std::string &path);  // 0 where there is no regular file

// The longest start of an absolute path that there is.
std::string existing_part(const std::string &path);

// From the root on, without "." and "..", symbolic links as they are.
std::string absolute_path(const std::string &path);

// One name for every way to write a path, whether or not there is a file.
std::string one_name(const std::string &path);

// True when two paths name one file, which may not exist yet.
bool is_same_file(const std::string &a, const std::string &b);

// The same text for such paths, and another for others: to find them among many.
std::string file_identity(const std::string &path);

// For texts: a name as it is, or where it is longer than a line its start and its length.
std::string short_name(const std::string &name);

// Whether a path is longer, as a whole or between two slashes, than any that can be opened.
bool is_too_long(const std::string &path);

}  // namespace lensprof
