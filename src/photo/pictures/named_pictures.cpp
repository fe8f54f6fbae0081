#include "photo/pictures/named_pictures.hpp"

#include <algorithm>
#include <deque>
#include <filesystem>
#include <map>
#include <set>

#include "photo/base/failure.hpp"
#include "photo/base/file_kind.hpp"
#include "photo/base/format.hpp"
#include "photo/base/paths.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/pictures/raw_kind.hpp"

namespace lensprof {
namespace {

namespace fs = std::filesystem;

// The pictures of a folder and its subfolders.
class FolderWalk {
public:
    FolderWalk(const std::string &root, const std::string &output, std::vector<UnlistedFolder> *unlisted)
        : root_(root), unlisted_(unlisted) {
        if (canonical_path(root) != canonical_path(output)) entered_.insert(file_identity(output));
        folders_.push_back("");
        while (!folders_.empty() || !links_.empty()) {
            auto &next = folders_.empty() ? links_ : folders_;  // a folder's own name before links to it
            const std::string subfolder = next.front();
            next.pop_front();
            enter(subfolder);
        }
        std::sort(found_.begin(), found_.end(),
                  [](const NamedPicture &a, const NamedPicture &b) { return a.file < b.file; });
        choose_of_pairs();
    }

    // Files with the same base name are adjacent now.
    void choose_of_pairs() {
        const auto stem = [](const NamedPicture &p) { return fs::path(p.file).replace_extension().string(); };
        std::map<std::string, std::vector<NamedPicture>> groups;
        for (const NamedPicture &picture : found_) groups[stem(picture)].push_back(picture);
        std::vector<NamedPicture> chosen;
        for (const NamedPicture &picture : found_) {
            const std::vector<NamedPicture> &group = groups[stem(picture)];
            std::vector<std::string> others;
            for (const NamedPicture &member : group)
                if (is_raw_name(member.file) != is_raw_name(picture.file))
                    others.push_back(fs::path(member.file).filename().string());
            if (!others.empty() && is_raw_name(picture.file) != can_read_raw()) continue;
            chosen.push_back(picture);
            chosen.back().instead_of = others;
        }
        found_ = std::move(chosen);
    }

    const std::vector<NamedPicture> &found() const { return found_; }
    const std::vector<std::string> &other_files() const { return other_files_; }

private:
    void enter(const std::string &subfolder) {
        const std::string folder = subfolder.empty() ? root_ : (fs::path(root_) / subfolder).string();
        if (!entered_.insert(file_identity(folder)).second) return;
        std::error_code error;
        for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
            const std::string path = entry->path().string(), name = entry->path().filename().string();
            std::error_code ignored;
            if (name[0] == '.') continue;
            if (is_folder(path))
                (entry->is_symlink(ignored) ? links_ : folders_).push_back((fs::path(subfolder) / name).string());
            else if (is_picture_name(name))
                found_.push_back({path, subfolder, true});
            else
                other_files_.push_back(path);
        }
        if (!error) return;
        const std::string message = folder + ": cannot list the folder: " + error.message();
        if (!unlisted_ || subfolder.empty()) throw Failure(LENSPROF_ERROR_READ, message);
        unlisted_->push_back({folder, message});
    }

    const std::string root_;
    std::vector<UnlistedFolder> *const unlisted_;
    std::deque<std::string> folders_, links_;  // subfolders to enter
    std::set<std::string> entered_;            // by file_identity
    std::vector<NamedPicture> found_;
    std::vector<std::string> other_files_;
};

// One line per kind of pictures that lensprof does not read, with the first file's name.
std::vector<std::string> lines_of(std::vector<std::string> files) {
    struct Group {
        std::string first, reason;
        size_t count;
    };
    std::sort(files.begin(), files.end());
    std::map<std::string, Group> groups;
    for (const std::string &file : files)
        if (const auto other = other_pictures(file))
            groups.try_emplace(other->kind, Group{file, other->reason, 0}).first->second.count++;
    std::vector<std::string> lines;
    for (const auto &[kind, group] : groups)
        lines.push_back(group.first + (group.count > 1 ? format(" and %zu more", group.count - 1) : "")
                        + ": left out: " + group.reason);
    return lines;
}

}  // namespace

std::vector<NamedPicture> named_pictures(const std::vector<std::string> &names, const std::string &output,
                                         std::vector<std::string> &left_out, std::vector<UnlistedFolder> *unlisted) {
    std::vector<NamedPicture> pictures;
    std::vector<std::string> other_files;
    for (const std::string &name : names) {
        if (name.empty()) throw Failure(LENSPROF_ERROR_ARGUMENT, "FILE: empty name; give a picture or a folder");
        if (!is_folder(name)) {
            pictures.push_back({name, "", false});
            continue;
        }
        const FolderWalk walk(name, output, unlisted);
        if (walk.found().empty()) {
            const std::vector<std::string> others = lines_of(walk.other_files());
            throw Failure(
                LENSPROF_ERROR_ARGUMENT,
                name + ": is a folder without pictures (.jpg, .png, .tif, .heic, .avif, .webp, .jxl, camera raw); "
                    + (others.empty() ? "give another" : others[0]));
        }
        pictures.insert(pictures.end(), walk.found().begin(), walk.found().end());
        other_files.insert(other_files.end(), walk.other_files().begin(), walk.other_files().end());
    }
    left_out = lines_of(std::move(other_files));
    return pictures;
}

std::vector<NamedPicture> extract_below(std::vector<NamedPicture> &pictures,
                                        const std::function<bool(const std::string &)> &is_output) {
    std::map<std::string, bool> known;
    const auto is_kept = [&](const NamedPicture &picture) {
        std::filesystem::path place = std::filesystem::path(picture.file).parent_path(), below = picture.subfolder;
        for (; picture.in_folder && !below.empty(); below = below.parent_path(), place = place.parent_path()) {
            const auto [entry, is_new] = known.try_emplace(place.string(), false);
            if (is_new) entry->second = is_output(place.string());
            if (entry->second) return false;
        }
        return true;
    };
    const auto out = std::stable_partition(pictures.begin(), pictures.end(), is_kept);
    std::vector<NamedPicture> taken(out, pictures.end());
    pictures.erase(out, pictures.end());
    return taken;
}

std::vector<NamedPicture> extract_outputs(std::vector<NamedPicture> &pictures, Events &events) {
    return extract_below(pictures, [&](const std::string &folder) {
        const bool is_output = path_exists(folder + "/" + calibrate_records);
        if (is_output) events.note(folder, "left out: it is an output folder of calibrate");
        return is_output;
    });
}

void note_instead(const NamedPicture &picture, Events &events) {
    if (picture.instead_of.empty()) return;
    std::string others;
    for (const std::string &other : picture.instead_of) others += (others.empty() ? "" : " and ") + other;
    events.note(picture.file, "used instead of " + others
                                  + (is_raw_name(picture.file) ? ", because raw values are linear and uncorrected"
                                                               : ", because this lensprof was built without LibRaw")
                                  + "; give the other file explicitly to use it");
}

void require_one_kind(const std::vector<std::string> &files) {
    std::string raw, rendered;
    for (const std::string &file : files) {
        if (!is_regular_file(file)) continue;
        std::string &first = raw_kind(file) ? raw : rendered;
        if (first.empty()) first = file;
        if (!raw.empty() && !rendered.empty())
            throw Failure(
                LENSPROF_ERROR_ARGUMENT,
                raw + ": is a camera raw file, but " + rendered
                    + " is not; give files of one kind, because one response and falloff are estimated for all");
    }
}

}  // namespace lensprof
