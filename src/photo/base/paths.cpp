#include "photo/base/paths.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "photo/base/utf8.hpp"
#include "photo/system/system.hpp"

namespace lensprof {

namespace fs = std::filesystem;

bool path_exists(const std::string &path) {
    std::error_code ignored;
    return fs::exists(path, ignored);
}

bool is_folder(const std::string &path) {
    std::error_code ignored;
    return fs::is_directory(path, ignored);
}

bool is_regular_file(const std::string &path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

uint64_t file_bytes(const std::string &path) {
    std::error_code error;
    const uint64_t bytes = fs::file_size(path, error);
    return error ? 0 : bytes;
}

std::string existing_part(const std::string &path) {
    fs::path part = path;
    while (!path_exists(part.string()) && part.has_relative_path()) part = part.parent_path();
    return part.string();
}

std::string absolute_path(const std::string &path) {
    std::error_code error;
    const fs::path absolute = fs::absolute(path, error);
    return (error ? fs::path(path) : absolute).lexically_normal().string();
}

std::string canonical_path(const std::string &path) {
    std::error_code error;
    const fs::path name = fs::weakly_canonical(absolute_path(path), error);
    return error ? absolute_path(path) : name.string();
}

bool is_in_new_folder(const std::string &path, const std::string &folder) {
    const std::string parent = std::filesystem::path(absolute_path(path)).parent_path().string();
    return !is_folder(folder) && canonical_path(parent) == canonical_path(folder);
}

bool is_same_file(const std::string &a, const std::string &b) {
    if (a.empty() || b.empty()) return false;
    std::error_code ignored;
    return absolute_path(a) == absolute_path(b) || fs::equivalent(a, b, ignored);
}

std::string file_identity(const std::string &path) {
    const std::string identity = system::status_of(path).identity;
    return identity.empty() ? absolute_path(path) : identity;
}

std::string lowercase_extension(const std::string &path) {
    const size_t slash = path.rfind('/'), dot = path.rfind('.');
    if (dot == std::string::npos || (slash != std::string::npos && dot < slash)) return {};
    std::string extension = path.substr(dot + 1);
    for (char &c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

std::string short_name(const std::string &name) {
    constexpr size_t head_bytes = 100, max_bytes = 1000;
    if (name.size() <= max_bytes) return name;
    return name.substr(0, utf8_cut(name, head_bytes)) + "... (" + std::to_string(name.size()) + " bytes)";
}

bool is_too_long(const std::string &path) {
    constexpr size_t max_path_bytes = 4095, max_name_bytes = 255;  // PATH_MAX and NAME_MAX of Linux
    size_t longest_part = 0;
    for (const fs::path &part : fs::path(path)) longest_part = std::max(longest_part, part.native().size());
    return path.size() > max_path_bytes || longest_part > max_name_bytes;
}

}  // namespace lensprof
