#include "photo/folder/ledger.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "photo/base/format.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/folder/attempt.hpp"
#include "photo/system/system.hpp"

namespace lensprof {

std::string digest_of_text(std::string_view text) {
    uint64_t hash = 0xcbf29ce484222325;
    for (const char c : text) hash = (hash ^ static_cast<uint8_t>(c)) * 0x100000001b3;
    return format("%016llx", static_cast<unsigned long long>(hash));
}

std::string stamp_of(const std::string &file) {
    const system::FileStatus status = system::status_of(file);
    if (status.kind == system::FileStatus::Kind::missing) return {};
    return format("%lld:%lld.%09ld", static_cast<long long>(status.bytes), static_cast<long long>(status.modified_s),
                  static_cast<long>(status.modified_ns));
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

namespace {

namespace fs = std::filesystem;

constexpr int schema = 5;

std::string without_slash(std::string path) {
    while (path.size() > 1 && path.back() == '/') path.pop_back();
    return path;
}

std::string digest_of_notes(const Json &notes) { return digest_of_text(lensprof_version() + notes.dump()); }

// The first line of a ledger, an object; null if it is not a ledger.
Json object_of(const std::string &text) {
    constexpr int max_depth = 64;  // what is copied and written recurses
    const auto is_shallow = [](int depth, Json::parse_event_t, Json &) { return depth < max_depth; };
    const Json json = Json::parse(text.substr(0, text.find('\n')), is_shallow, false);
    const bool is_own = json.is_object() && json.contains("schema") && json["schema"] == schema;
    return is_own ? json : Json();
}

}  // namespace

bool has_ledger(const std::string &folder) {
    const std::string path = (fs::path(folder) / calibrate_records).string();
    if (!is_regular_file(path)) return false;
    return failure_of([&] {
               if (object_of(read_text(path, max_text_bytes)).is_null())
                   throw Failure(LENSPROF_ERROR_READ, path + ": is not a record of calibrate; delete it, or give "
                                                              "another folder" + advice("output"));
           })
        .empty();
}

FolderLock::FolderLock(const std::string &folder) : folder_(folder) {
    if (is_folder(folder)) acquire();
}

void FolderLock::acquire() {
    if (lock_.acquire(folder_)) return;
    throw Failure(LENSPROF_ERROR_WRITE, folder_ + ": another calibrate is using this folder; wait until it ends, or give "
                                              "another folder" + advice("output"));
}

Ledger::Ledger(const std::string &folder, bool overwrite, const char *records)
    : folder_(without_slash(absolute_path(folder))),
      path_((fs::path(folder) / records).string()),
      overwrite_(overwrite) {
    if (!is_regular_file(path_)) return;
    try {
        read(read_text(path_, max_text_bytes));
    } catch (const std::exception &) {  // damaged, or too large
        files_.clear();
        notes = Json();
    }
}

void Ledger::read(const std::string &text) {
    const Json json = object_of(text);
    if (json.is_null()) return;
    std::map<std::string, Entry> files;
    for (const auto &[file, entry] : json.at("files").items())
        files[file] = {entry.at("of").get<std::string>(), entry.at("stamp").get<std::string>()};
    files_ = std::move(files);
    recover_files(text.substr(std::min(text.find('\n'), text.size())));
    if (json.at("digest") == digest_of_notes(json.at("notes"))) notes = json.at("notes");
    saved_ = text;
}

// Files started but not finished by a run belong to it if they have the stamp of a line; else they existed before.
void Ledger::recover_files(const std::string &lines) {
    std::istringstream in(lines);
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::string file, stamp, key;
        if (words >> file >> stamp >> key && stamp == stamp_of((fs::path(folder_) / path_of_ascii(file)).string()))
            files_[file] = {path_of_ascii(key), stamp};
    }
}

std::string Ledger::name_of(const std::string &file) const {
    return ascii_path(fs::path(absolute_path(file)).lexically_relative(folder_).string());
}

bool Ledger::is_current(const std::string &file, const std::string &key) const {
    const auto entry = files_.find(name_of(file));
    return entry != files_.end() && entry->second.key == key && is_regular_file(file);
}

bool Ledger::is_foreign(const std::string &file) const {
    if (!path_exists(file)) return false;
    const auto entry = files_.find(name_of(file));
    return entry == files_.end() || stamp_of(file) != entry->second.stamp;
}

void Ledger::begin(const std::string &file, const std::string &key) {
    if (!overwrite_ && is_foreign(file))
        throw ForeignFile(LENSPROF_ERROR_ARGUMENT, file + ": "
                                                       + (contains(file) ? "was modified after calibrate wrote it"
                                                                         : "exists and was not written by calibrate")
                                                       + "; move it away, or use " + option_name("overwrite"));
    std::error_code ignored;
    if (fs::is_symlink(file, ignored)) fs::remove(file, ignored);
    {
        const std::lock_guard<std::mutex> lock(writing_);
        begun_[name_of(file)] = {key, ""};
    }
    if (!watch_)
        watch_ = std::make_unique<CommitWatch>(
            [this](const std::string &path, const std::string &temporary) { note_commit(path, temporary); });
}

void Ledger::note_commit(const std::string &file, const std::string &temporary) {
    const std::lock_guard<std::mutex> lock(writing_);
    const std::string name = name_of(file);
    const auto begun = begun_.find(name);
    if (begun == begun_.end()) return;
    begun->second.stamp = stamp_of(temporary);
    std::ofstream(path_, std::ios::app) << name << ' ' << begun->second.stamp << ' ' << ascii_path(begun->second.key)
                                        << std::endl;
    saved_.clear();
}

bool Ledger::is_written(const std::string &file) const {
    const std::lock_guard<std::mutex> lock(writing_);
    const auto begun = begun_.find(name_of(file));
    return begun != begun_.end() && !begun->second.stamp.empty() && path_exists(file);
}

void Ledger::finish(const std::string &file) {
    const std::lock_guard<std::mutex> lock(writing_);
    const auto begun = begun_.find(name_of(file));
    if (begun == begun_.end()) return;
    files_[begun->first] = begun->second;
    begun_.erase(begun);
}

void Ledger::abandon(const std::string &file) {
    const std::lock_guard<std::mutex> lock(writing_);
    begun_.erase(name_of(file));
}

void Ledger::remove(const std::string &file) {
    std::error_code ignored;
    if (contains(file) && !is_foreign(file)) fs::remove(file, ignored);
    files_.erase(name_of(file));
}

void Ledger::save() {
    std::string text;
    {
        const std::lock_guard<std::mutex> lock(writing_);  // not while the file is written, which is noted, too
        Json files = Json::object();
        for (const auto &[file, entry] : files_) files[file] = {{"of", entry.key}, {"stamp", entry.stamp}};
        const Json json = {{"schema", schema}, {"files", files}, {"digest", digest_of_notes(notes)}, {"notes", notes}};
        text = json.dump() + "\n";
        if (text == saved_) return;
    }
    std::error_code ignored;
    if (fs::is_symlink(path_, ignored)) fs::remove(path_, ignored);  // its target is in another folder
    write_file(path_, text.data(), text.size());
    const std::lock_guard<std::mutex> lock(writing_);
    saved_ = text;
}

void Ledger::erase() {
    std::error_code ignored;
    if (is_regular_file(path_)) fs::remove(path_, ignored);
    files_.clear(), begun_.clear(), saved_.clear();
}

}  // namespace lensprof
