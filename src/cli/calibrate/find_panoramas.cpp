// Which pictures belong together.
#include <algorithm>
#include <filesystem>

#include <lensprof/lensprof.h>

#include "cli/calibrate/panoramas.hpp"
#include "cli/fitting/photographs.hpp"
#include "cli/program/format.hpp"
#include "cli/program/paths.hpp"

namespace lensprof {
namespace {

// One group of pictures, as the ledger has it.
struct Group {
    std::vector<const InputPicture *> pictures;
    std::string geometry;
    Json facts;
};

struct Groups {
    std::vector<Group> list;
    std::map<std::string, std::string> unjoined;
};

std::string key_of(const std::vector<const InputPicture *> &pictures, const std::string &more) {
    std::string text = std::string(lensprof_version()) + "\n" + more + "\n";
    for (const InputPicture *picture : pictures) text += one_name(picture->file) + "\n" + picture->identity + "\n";
    return digest_of_text(text);
}

Group group_of(const FoundProject &found, const std::vector<const InputPicture *> &all) {
    Group group;
    for (const uint32_t number : found.pictures) group.pictures.push_back(all[number]);
    group.geometry = text_of_found(found);
    group.facts = {{"camera", found.kind == SceneKind::plane ? "moved over a plane" : "turned about one point"},
                   {"links", found.links},
                   {"links_unfit", found.unfit},
                   {"residual", found.residual}};
    return group;
}

Groups register_groups(bool one_lens, const std::vector<const InputPicture *> &all, Progress &progress) {
    std::vector<std::string> files;
    for (const InputPicture *picture : all) files.push_back(picture->file);
    Groups groups;
    if (files.empty()) return groups;
    const Registration found = register_pictures(files, progress);
    for (const auto &[number, why] : found.unreadable) groups.unjoined[files[number]] = why;
    for (const uint32_t number : found.alone)
        groups.unjoined[files[number]] = files[number] + ": no overlap with another picture was found";
    for (const FoundProject &project : found.projects) {
        std::vector<FoundProject> parts{project};
        if (!one_lens) parts = split_by_lens(project);
        for (const FoundProject &part : parts) {
            if (part.pictures.size() >= 2 && part.links > 0) {
                groups.list.push_back(group_of(part, all));
                continue;
            }
            for (const uint32_t number : part.pictures)
                groups.unjoined[files[number]] = files[number] + ": overlaps with pictures " + of_another_lens;
        }
    }
    std::stable_sort(groups.list.begin(), groups.list.end(),
                     [](const Group &a, const Group &b) { return a.pictures.size() > b.pictures.size(); });
    return groups;
}

Json json_of(const Groups &groups, const std::string &key) {
    Json list = Json::array(), unjoined = Json::array();
    for (const Group &group : groups.list) {
        Json files = Json::array();
        for (const InputPicture *picture : group.pictures) files.push_back(ascii_path(picture->file));
        list.push_back({{"files", files}, {"geometry", group.geometry}, {"facts", group.facts}});
    }
    for (const auto &[file, why] : groups.unjoined) unjoined.push_back({ascii_path(file), ascii_path(why)});
    return {{"key", key}, {"groups", list}, {"unjoined", unjoined}};
}

// What the ledger has of these pictures; false where it has none.
bool recall(const Json &notes, const std::string &key, const std::vector<const InputPicture *> &all, Groups &groups) {
    if (!notes.is_object() || !notes.contains("registration") || notes["registration"].value("key", "") != key)
        return false;
    std::map<std::string, const InputPicture *> by_file;
    for (const InputPicture *picture : all) by_file[ascii_path(picture->file)] = picture;
    for (const Json &known : notes["registration"]["groups"]) {
        Group group;
        for (const Json &file : known["files"]) {
            const auto picture = by_file.find(file.get<std::string>());
            if (picture == by_file.end()) return false;  // the same files by other names
            group.pictures.push_back(picture->second);
        }
        group.geometry = known["geometry"].get<std::string>();
        group.facts = known["facts"];
        groups.list.push_back(std::move(group));
    }
    for (const Json &one : notes["registration"]["unjoined"])
        groups.unjoined[path_of_ascii(one[0].get<std::string>())] = path_of_ascii(one[1].get<std::string>());
    return true;
}

// The name of an earlier panorama that has the key, or with `key` empty any of the pictures; "" where there is none.
std::string earlier_name(const Json &notes, const std::string &key, const Group &group,
                         const std::set<std::string> &taken) {
    if (!notes.is_object() || !notes.contains("results")) return {};
    for (const auto &[name, result] : notes["results"].items()) {
        if (taken.count(path_of_ascii(name))) continue;
        if (!key.empty() && result.value("key", "") == key) return path_of_ascii(name);
        for (const InputPicture *picture : group.pictures)
            for (const Json &file : result["files"])
                if (key.empty() && file == ascii_path(picture->file)) return path_of_ascii(name);
    }
    return {};
}

std::string file_of(const CalibrateOptions &o, const std::string &name, const char *end) {
    return (std::filesystem::path(o.output) / ("panorama_" + name + end)).string();
}

// By the first picture; where that name is taken by something else, with a number.
std::string new_name(const CalibrateOptions &o, const Group &group, const std::set<std::string> &taken,
                     const std::set<std::string> &targets, const Ledger &ledger) {
    std::string base = std::filesystem::path(group.pictures[0]->name).replace_extension().relative_path().string();
    std::replace(base.begin(), base.end(), '/', '-');
    for (char &c : base) c = static_cast<unsigned char>(c) < ' ' || c == '"' ? '_' : c;
    const size_t last = base.rfind("..-");  // of a picture above the folder
    if (last != std::string::npos) base = base.substr(last + 3);
    if (base.size() > 100) base = base.substr(base.size() - 100);
    for (int number = 1;; number++) {
        const std::string name = base + (number > 1 ? "_" + std::to_string(number) : "");
        bool is_free = !taken.count(name);
        for (const char *end : {".pto", ".jpg"}) {
            const std::string file = file_of(o, name, end);
            is_free = is_free && !targets.count(file) && !ledger.is_in_the_way(file);
        }
        if (is_free) return name;
    }
}

}  // namespace

bool Panorama::evens() const {
    const Json &result = summary["result"];
    return result.is_object() && (result["usable"] == true || result["evens"] == true);
}

Panoramas find_panoramas(const CalibrateOptions &o, const Inputs &inputs, Ledger &ledger, Progress &progress) {
    std::vector<const InputPicture *> all;
    std::set<std::string> targets, taken;
    for (const InputPicture &picture : inputs.pictures) {
        all.push_back(&picture);
        targets.insert(picture.target);
    }
    Panoramas panoramas;
    Groups groups;
    const std::string key = key_of(all, o.one_lens ? "one lens" : "");
    if (!recall(ledger.notes, key, all, groups)) {
        groups = register_groups(o.one_lens, all, progress);
        panoramas.is_registered = true;
        ledger.notes["registration"] = json_of(groups, key);
        ledger.save();
    }
    panoramas.unjoined = groups.unjoined;
    std::string asked = o.one_lens ? "one lens\n" : "\n";
    if (o.store.no_store) asked += "no store\n";
    for (const std::string &db : o.store.dbs) asked += one_name(db) + "\n";
    std::vector<std::string> names(groups.list.size()), keys;
    for (const Group &group : groups.list) keys.push_back(key_of(group.pictures, asked));
    for (const bool is_exact : {true, false})
        for (size_t n = 0; n < names.size(); n++) {
            if (names[n].empty()) names[n] = earlier_name(ledger.notes, is_exact ? keys[n] : "", groups.list[n], taken);
            if (!names[n].empty()) taken.insert(names[n]);
        }
    for (size_t n = 0; n < names.size(); n++) {
        const Group &group = groups.list[n];
        Panorama panorama;
        panorama.name = names[n].empty() ? new_name(o, group, taken, targets, ledger) : names[n];
        taken.insert(panorama.name);
        panorama.project = file_of(o, panorama.name, ".pto"), panorama.preview = file_of(o, panorama.name, ".jpg");
        panorama.pictures = group.pictures, panorama.geometry = group.geometry, panorama.key = keys[n];
        // What `build` of the folder fits is the largest, and these pictures must not count twice.
        panorama.source = n == 0 && o.inputs.size() == 1 ? o.inputs[0] : group.pictures[0]->file;
        panorama.summary = {{"name", panorama.name}, {"project", panorama.project}, {"preview", nullptr}};
        panorama.summary["pictures"] = group.pictures.size();
        panorama.summary.update(group.facts);
        panoramas.list.push_back(std::move(panorama));
    }
    return panoramas;
}

void forget_panoramas(const CalibrateOptions &o, const Panoramas &panoramas, Ledger &ledger) {
    if (!ledger.notes.is_object() || !ledger.notes.contains("results")) return;
    Json kept = Json::object();
    for (const auto &[name, result] : ledger.notes["results"].items()) {
        const std::string own = path_of_ascii(name);
        if (std::any_of(panoramas.list.begin(), panoramas.list.end(), [&](const Panorama &p) { return p.name == own; }))
            kept[name] = result;
        else
            for (const char *end : {".pto", ".jpg"}) ledger.remove(file_of(o, own, end));
    }
    ledger.notes["results"] = kept;
}

}  // namespace lensprof
