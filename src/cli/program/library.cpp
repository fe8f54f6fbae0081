#include "cli/program/library.hpp"

#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "cli/program/file_kind.hpp"
#include "cli/program/input_file.hpp"
#include "cli/program/paths.hpp"
#include "cli/program/utf8.hpp"

namespace lensprof {
namespace {

ExitCode exit_code(lensprof_status status) {
    switch (status) {
    case LENSPROF_OK: return ExitCode::done;
    case LENSPROF_ERROR_NO_OVERLAP:
    case LENSPROF_ERROR_NO_SAMPLES: return ExitCode::not_usable;
    case LENSPROF_ERROR_NO_UNKNOWNS: return ExitCode::usage;
    case LENSPROF_ERROR_CANCELLED: return ExitCode::interrupted;
    case LENSPROF_ERROR_NOT_FINITE:
    case LENSPROF_ERROR_GEOMETRY:
    case LENSPROF_ERROR_RESPONSE:
    case LENSPROF_ERROR_VIGNETTING:
    case LENSPROF_ERROR_EXPOSURE:
    case LENSPROF_ERROR_SYNTAX:
    case LENSPROF_ERROR_VARIABLE:
    case LENSPROF_ERROR_UNSUPPORTED: return ExitCode::unreadable;
    case LENSPROF_ERROR_NOT_FOUND: return ExitCode::not_found;
    case LENSPROF_ERROR_STORE:
    case LENSPROF_ERROR_CORRUPT:
    case LENSPROF_ERROR_LAYOUT:
    case LENSPROF_ERROR_READ_ONLY:
    case LENSPROF_ERROR_FULL:
    case LENSPROF_ERROR_BUSY: return ExitCode::store;
    default: return ExitCode::failed;
    }
}

// The reason that a fit could not be started.
uint32_t reason_of(lensprof_status status) {
    return status == LENSPROF_ERROR_NO_OVERLAP   ? LENSPROF_REASON_IMAGE_GROUPS
           : status == LENSPROF_ERROR_NO_SAMPLES ? LENSPROF_REASON_FEW_PAIRS
                                                 : LENSPROF_REASON_NONE;
}

}  // namespace

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
    throw Failure(exit_code(status), is_named ? text : item + ": " + text, reason_of(status));
}

std::string store_path(const std::string &path) {
    if (!path.empty()) return path;
    const char *data = std::getenv("XDG_DATA_HOME"), *home = std::getenv("HOME");
    if (data && data[0] == '/') return std::string(data) + "/lensprof/profiles.db";
    if (home && home[0] == '/') return std::string(home) + "/.local/share/lensprof/profiles.db";
    throw Failure(ExitCode::usage, "no home folder for the profile database; give a database with --db FILE");
}

void require_folder(const std::string &path) {
    const std::string folder = std::filesystem::path(absolute_path(store_path(path))).parent_path().string();
    if (path.empty() || is_folder(folder)) return;
    const std::string place = existing_part(folder);
    if (!is_folder(place)) throw Failure(ExitCode::store, path + ": " + place + " is not a folder; give another name");
    throw Failure(ExitCode::store, path + ": folder " + folder + " does not exist; create it first");
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
        throw Failure(ExitCode::store, file + ": is not a regular file; give the path of a database");
    refuse_other_kind(file);
    lensprof_store *store = nullptr;
    lensprof_error error{};
    check(lensprof_store_open(file.c_str(), mode, &store, &error), file, &error);
    return Store(store);
}

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

void require_text_sizes(const std::string &maker, const std::string &camera, const std::string &lens,
                        const std::string &unit, const std::string &style) {
    using Key = lensprof_profile_key;
    const struct {
        const char *option;
        const std::string &text;
        size_t size;
    } fields[] = {{"--key maker", maker, sizeof Key::camera_maker},
                  {"--camera", camera, sizeof Key::camera_model},
                  {"--lens", lens, sizeof Key::lens},
                  {"--key unit", unit, sizeof Key::unit},
                  {"--key style", style, sizeof Key::style}};
    for (const auto &field : fields)
        if (field.text.size() >= field.size)
            throw Failure(ExitCode::usage, std::string(field.option) + ": is " + std::to_string(field.text.size())
                                               + " bytes long, but a profile stores at most "
                                               + std::to_string(field.size - 1) + "; give a shorter text");
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
