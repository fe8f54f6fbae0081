#include "cli/calibrate/ledger.hpp"

#include <filesystem>

#include <sys/stat.h>

#include "cli/program/format.hpp"
#include "cli/program/input_file.hpp"
#include "cli/program/output_file.hpp"
#include "cli/program/paths.hpp"

namespace lensprof {

std::string digest_of_text(const std::string &text) {
    uint64_t hash = 0xcbf29ce484222325;
    for (const char c : text) hash = (hash ^ static_cast<uint8_t>(c)) * 0x100000001b3;
    return format("%016llx", static_cast<unsigned long long>(hash));
}

std::string stamp_of(const std::string &file) {
    struct stat status = {};
    if (stat(file.c_str(), &status) != 0) return {};
    return format("%lld:%lld.%09ld", static_cast<long long>(status.st_size),
                  static_cast<long long>(status.st_mtim.tv_sec), static_cast<long>(status.st_mtim.tv_nsec));
}

std::string ascii_path(const std::string &path) {
    std::string text;
    for (const char c : path)
        text += c > ' ' && c < 0x7f && c != '%' ? std::string(1, c) : format("%%%02X", static_cast<uint8_t>(c));
    return text;
}

std::string path_of_ascii(const std::string &text) {
    std::string path;
    for (size_t i = 0; i < text.size(); i++) {
        const bool is_code = text[i] == '%' && i + 2 < text.size();
        path += is_code ? static_cast<char>(std::strtol(text.substr(i + 1, 2).c_str(), nullptr, 16)) : text[i];
        i += is_code ? 2 : 0;
    }
    return path;
}

Ledger::Ledger(const std::string &folder)
    : path_((std::filesystem::path(folder) / ".lensprof-calibrate.json").string()) {
    if (!is_regular_file(path_)) return;
    const std::string text = read_text(path_, largest_text);
    const Json json = Json::parse(text, nullptr, false);
    try {
        if (json.at("schema") != 1) return;
        for (const auto &[file, entry] : json.at("files").items())
            files_[file] = {entry.at("of").get<std::string>(), entry.at("stamp").get<std::string>(),
                            entry.at("begun").get<bool>()};
        notes = json.at("notes");
        saved_ = text;
    } catch (const Json::exception &) {
        files_.clear();
    }
}

bool Ledger::is_current(const std::string &file, const std::string &key) const {
    const auto entry = files_.find(ascii_path(file));
    if (entry == files_.end() || entry->second.key != key || !is_regular_file(file)) return false;
    return !entry->second.is_begun || stamp_of(file) != entry->second.stamp;
}

bool Ledger::is_in_the_way(const std::string &file) const {
    if (!path_exists(file)) return false;
    const auto entry = files_.find(ascii_path(file));
    return entry == files_.end() || (!entry->second.is_begun && stamp_of(file) != entry->second.stamp);
}

void Ledger::begin(const std::string &file, const std::string &key) {
    files_[ascii_path(file)] = {key, stamp_of(file), true};
}

bool Ledger::is_written(const std::string &file) const {
    const auto entry = files_.find(ascii_path(file));
    return entry != files_.end() && path_exists(file) && stamp_of(file) != entry->second.stamp;
}

void Ledger::finish(const std::string &file) {
    Entry &entry = files_[ascii_path(file)];
    entry.stamp = stamp_of(file);
    entry.is_begun = false;
}

void Ledger::remove(const std::string &file) {
    std::error_code ignored;
    if (knows(file) && !is_in_the_way(file)) std::filesystem::remove(file, ignored);
    files_.erase(ascii_path(file));
}

void Ledger::save() {
    Json files = Json::object();
    for (const auto &[file, entry] : files_)
        files[file] = {{"of", entry.key}, {"stamp", entry.stamp}, {"begun", entry.is_begun}};
    const Json json = {{"schema", 1}, {"files", files}, {"notes", notes}};
    const std::string text = json.dump() + "\n";
    if (text == saved_) return;
    write_file(path_, text.data(), text.size());
    saved_ = text;
}

}  // namespace lensprof
