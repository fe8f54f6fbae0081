#include "photo/base/databases.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "photo/base/paths.hpp"

namespace lensprof {
namespace {

constexpr const char *kInstalled = "/lensprof/lensfun.db";

// The share folder next to the program's bin: /usr/local/share for /usr/local/bin/lensprof. Empty if unknown.
std::string program_share_folder() {
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    return error ? std::string() : (program.parent_path().parent_path() / "share").string();
}

// Not named by the user: a damaged one is skipped.
bool is_readable(const std::string &file) {
    lensprof_store *store = nullptr;
    const bool is_open = lensprof_store_open(file.c_str(), LENSPROF_STORE_READ, &store, nullptr) == LENSPROF_OK;
    lensprof_store_close(store);
    return is_open;
}

}  // namespace

std::string installed_database() {
    const char *given = std::getenv("XDG_DATA_DIRS");
    std::string folders =
        program_share_folder() + ":" + (given && *given ? given : "/usr/local/share:/usr/share") + ":";
    for (size_t begin = 0, end; (end = folders.find(':', begin)) != std::string::npos; begin = end + 1) {
        const std::string file = folders.substr(begin, end - begin) + kInstalled;
        if (file[0] == '/' && end > begin && is_regular_file(file) && is_readable(file)) return file;
    }
    return {};
}

std::vector<std::string> databases_of(const std::vector<std::string> &named) {
    if (!named.empty()) return named;
    std::vector<std::string> files;
    const std::string user_database = store_path(""), installed_file = installed_database();
    if (path_exists(user_database) || installed_file.empty()) files.push_back(user_database);
    if (!installed_file.empty() && !is_same_file(user_database, installed_file)) files.push_back(installed_file);
    return files;
}

std::vector<std::string> existing_databases(const std::vector<std::string> &named) {
    if (!named.empty() || !user_store_path().empty()) return existing(databases_of(named));
    return existing({installed_database()});
}

std::vector<std::string> existing(std::vector<std::string> databases) {
    const auto is_missing = [](const std::string &file) { return !path_exists(file); };
    databases.erase(std::remove_if(databases.begin(), databases.end(), is_missing), databases.end());
    return databases;
}

Databases::Databases(const std::vector<std::string> &files) {
    std::set<std::string> seen;
    for (const std::string &file : files) {
        if (!seen.insert(file_identity(file)).second) continue;  // a store has one transaction at a time
        stores_.push_back(open_store(file, LENSPROF_STORE_READ));
        files_.push_back(file);
    }
}

std::string Databases::names() const {
    std::string text;
    for (const std::string &file : files_) text += (text.empty() ? "" : ", ") + file;
    return text;
}

lensprof_status Databases::look_up(const lensprof_profile_key &key, const lensprof_lookup_options &options,
                                   lensprof_profile &profile, lensprof_lookup &lookup) const {
    std::vector<lensprof_store *> stores;
    for (const Store &store : stores_) stores.push_back(store.get());
    lensprof_error error{};
    const lensprof_status status = lensprof_store_lookup_in(stores.data(), static_cast<uint32_t>(stores.size()), &key,
                                                            &options, &profile, &lookup, &error);
    if (status != LENSPROF_ERROR_NOT_FOUND) check(status, names(), &error);
    return status;
}

}  // namespace lensprof
