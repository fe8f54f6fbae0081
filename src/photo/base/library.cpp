#include "photo/base/library.hpp"
#include "photo/base/events.hpp"

#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "photo/base/file_kind.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/base/utf8.hpp"

namespace lensprof {
namespace {

// The reason that a fit could not be started.
uint32_t reason_of(lensprof_status status) {
    return status == LENSPROF_ERROR_NO_OVERLAP   ? LENSPROF_REASON_IMAGE_GROUPS
           : status == LENSPROF_ERROR_NO_SAMPLES ? LENSPROF_REASON_FEW_PAIRS
                                                 : LENSPROF_REASON_NONE;
}

}  // namespace

std::string exported(const std::string &item, const std::vector<const lensprof_profile *> &profiles,
                     const lensprof_export_options &options, const std::vector<std::string> &names) {
    const auto write = [&](void *data, size_t capacity, size_t *count, lensprof_error *error) {
        return lensprof_export(profiles.data(), static_cast<uint32_t>(profiles.size()), &options, data, capacity, count,
                               error);
    };
    return written(item, write, names);
}

void check(lensprof_status status, const std::string &item, const lensprof_error *error) {
    check_named(status, item, error ? *error : lensprof_error{}, LENSPROF_ITEM_NONE, {});
}

std::string with_name(const std::string &text, const lensprof_item &item, const std::string &name) {
    const size_t end = size_t(item.text_begin) + item.text_bytes;
    if (!item.text_bytes || end > text.size()) return text;
    return text.substr(0, item.text_begin) + name + text.substr(end);
}

void check_named(lensprof_status status, const std::string &item, const lensprof_error &error, lensprof_item_kind kind,
                 const std::vector<std::string> &names) {
    if (status == LENSPROF_OK) return;
    std::string text = error.text[0] ? error.text : lensprof_status_name(status);
    if (error.item.kind == static_cast<uint32_t>(kind) && error.item.index < names.size())
        text = with_name(text, error.item, names[error.item.index]);
    const bool is_named = item.empty() || text.rfind(item, 0) == 0;
    throw Failure(status, is_named ? text : item + ": " + text, reason_of(status));
}

std::string user_store_path() {
    const char *data = std::getenv("XDG_DATA_HOME"), *home = std::getenv("HOME");
    if (data && data[0] == '/') return std::string(data) + "/lensprof/profiles.db";
    if (home && home[0] == '/') return std::string(home) + "/.local/share/lensprof/profiles.db";
    return {};
}

std::string store_path(const std::string &path) {
    const std::string file = path.empty() ? user_store_path() : path;
    if (!file.empty()) return file;
    throw Failure(LENSPROF_ERROR_ARGUMENT,
                  "no home folder for the profile database; give a database with " + option_name("databases"));
}

void require_folder(const std::string &path) {
    const std::string folder = std::filesystem::path(absolute_path(store_path(path))).parent_path().string();
    if (path.empty() || is_folder(folder)) return;
    const std::string place = existing_part(folder);
    if (!is_folder(place))
        throw Failure(LENSPROF_ERROR_STORE, path + ": " + place + " is not a folder; give another name");
    throw Failure(LENSPROF_ERROR_STORE, path + ": folder " + folder + " does not exist; create it first");
}

std::unique_ptr<lensprof_profile> new_profile() {
    auto profile = std::make_unique<lensprof_profile>();
    lensprof_profile_init(profile.get());
    return profile;
}

Store open_store(const std::string &path, lensprof_store_mode mode) {
    std::string file = store_path(path);
    if (path.empty() && mode == LENSPROF_STORE_CREATE) {
        std::error_code ignored;  // opening the database reports a folder that cannot be created
        std::filesystem::create_directories(std::filesystem::path(file).parent_path(), ignored);
    }
    if (mode == LENSPROF_STORE_CREATE) require_folder(path);
    if (path_exists(file) && !is_regular_file(file) && !is_folder(file))  // reading a pipe would block
        throw Failure(LENSPROF_ERROR_STORE, file + ": is not a regular file; give the path of a database");
    refuse_other_kind(file);
    lensprof_store *store = nullptr;
    lensprof_error error{};
    check(lensprof_store_open(file.c_str(), mode, &store, &error), file, &error);
    return Store(store);
}

Pto::Pto(const Pto &other) : unique_ptr(other ? parse_pto(pto_text(*other), "project").release() : nullptr) {}

Pto read_pto(const std::string &path) { return parse_pto(read_text(path, max_text_bytes), path); }

Pto parse_pto(const std::string &text, const std::string &item) {
    lensprof_pto *pto = nullptr;
    lensprof_error error{};
    check(lensprof_pto_read(text.data(), text.size(), &pto, &error), item, &error);
    return Pto(pto);
}

std::string pto_name(const lensprof_pto &pto, uint32_t index) {
    return written("image name", [&](char *name, size_t capacity, size_t *count, lensprof_error *error) {
        return lensprof_pto_get_name(&pto, index, name, capacity, count, error);
    });
}

std::string pto_text(const lensprof_pto &pto) {
    return written("project", [&](void *text, size_t capacity, size_t *count, lensprof_error *error) {
        return lensprof_pto_write(&pto, text, capacity, count, error);
    });
}

void set_text(char *field, size_t size, const std::string &text) {
    const bool readable = is_utf8(text);
    const size_t length = utf8_cut(text, size - 1);
    std::memset(field, 0, size);
    for (size_t i = 0; i < length; i++) {
        auto c = static_cast<unsigned char>(text[i]);
        field[i] = c < 0x20 || c == 0x7f ? ' ' : c >= 0x80 && !readable ? '?' : text[i];
    }
}

}  // namespace lensprof
