// Path queries. Nothing here throws std::filesystem::filesystem_error: a path that cannot be examined (too long, a link
// to itself, no permission) counts as missing, and its reader or writer reports the problem. The overloads of
// std::filesystem that throw are not used elsewhere (tests/lint/path_rules.py).
#pragma once

#include <cstdint>
#include <string>

namespace lensprof {

bool path_exists(const std::string &path);
bool is_folder(const std::string &path);
bool is_regular_file(const std::string &path);
uint64_t file_bytes(const std::string &path);  // 0 if it is not a regular file

// The longest existing prefix of an absolute path.
std::string existing_part(const std::string &path);

// Absolute, without "." and "..", symbolic links unresolved.
std::string absolute_path(const std::string &path);

// The canonical name of a path, whether or not the file exists.
std::string canonical_path(const std::string &path);

// Whether a file is directly in `folder`, which does not exist yet, so that it can be checked only after that is made.
bool is_in_new_folder(const std::string &path, const std::string &folder);

// Whether two paths refer to the same file, which may not exist yet.
bool is_same_file(const std::string &a, const std::string &b);

// A key that is equal for such paths and different for others, for searching many.
std::string file_identity(const std::string &path);

// What follows the last dot of a file's name, in lower case: "jpg"; "" without a dot.
std::string lowercase_extension(const std::string &path);

// For messages: a name, or, if it is longer than a line, its start and length.
std::string short_name(const std::string &name);

// Whether a path, or a component of it, is too long to be opened.
bool is_too_long(const std::string &path);

}  // namespace lensprof
