// Finds the panoramas.
#include <algorithm>
#include <filesystem>

#include <lensprof/lensprof.h>

#include "photo/base/format.hpp"
#include "photo/base/paths.hpp"
#include "photo/folder/attempt.hpp"
#include "photo/folder/panoramas.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/scene/photographs.hpp"

namespace lensprof {
namespace {

// One group of pictures, as stored in the ledger.
struct Group {
    std::vector<const InputPicture *> pictures;
    FoundScene found;
    Json facts;
};

struct Groups {
    std::vector<Group> list;
    std::map<std::string, std::string> unjoined, unreadable, copies;  // reason by file
};

std::string key_of(const std::vector<const InputPicture *> &pictures, const std::string &more) {
    std::string text = std::string(lensprof_version()) + "\n" + more + "\n";
    for (const InputPicture *picture : pictures)
        text += canonical_path(picture->file) + "\n" + picture->identity + "\n";
    return digest_of_text(text);
}

Group group_of(const FoundScene &found, const std::vector<const InputPicture *> &all) {
    Group group;
    for (const uint32_t number : found.pictures) group.pictures.push_back(all[number]);
    // Converted through the ledger's numbers, so that a fit of what is recalled is identical to the byte.
    if (!read_noted(json_of(found), found.pictures.size(), group.found))
        throw Failure(LENSPROF_ERROR_WRITE, "internal error: matches of pictures are not finite; please report this");
    group.facts = {{"camera", found.kind == SceneKind::still   ? camera_stationary
                              : found.kind == SceneKind::plane ? "moved over a plane"
                                                               : "rotated about one point"},
                   {"links", found.links.size()},
                   {"links_unfit", found.unfit()},
                   {"by_matches", found.by_matches},
                   {"cameras_fit", found.cameras_fit()},
                   {"residual", found.residual}};
    return group;
}

// A Hugin project stores paths relative to its folder and cannot store such a name.
bool has_odd_name(const InputPicture &picture, const std::string &output) {
    const auto stated =
        std::filesystem::path(absolute_path(picture.file)).lexically_proximate(absolute_path(output)).string();
    return std::any_of(stated.begin(), stated.end(),
                       [](char c) { return c == '"' || static_cast<unsigned char>(c) < ' '; });
}

Groups register_groups(const FolderOptions &o, const std::vector<const InputPicture *> &given, Events &events) {
    std::vector<std::string> files;
    std::vector<const InputPicture *> all;
    std::vector<PictureMetadata> metadata;
    Groups groups;
    for (const InputPicture *picture : given) {
        if (has_odd_name(*picture, o.output)) {
            groups.unjoined[picture->file] = picture->file + ": its path has a quote or a line break, which a Hugin "
                                                             "project cannot store; rename it";
            continue;
        }
        files.push_back(picture->file);
        all.push_back(picture);
        metadata.push_back(picture->metadata);
    }
    if (files.empty()) return groups;
    const Registration found = register_pictures(files, metadata, o.one_lens, events);
    for (const auto &[number, reason] : found.unreadable) groups.unreadable[files[number]] = reason;
    for (const CopiedPicture &picture : found.copies) {
        const std::string &file = files[picture.copy];
        if (is_of_even_light(file))  // all alike
            groups.unjoined[file] = file + ": " + no_overlap_of(file);
        else
            groups.copies[file] = file + ": a copy of " + all[picture.original]->name + picture.how;
    }
    for (const uint32_t number : found.isolated)
        groups.unjoined[files[number]] = files[number] + ": " + no_overlap_of(files[number]);
    for (const uint32_t number : found.other_camera)
        groups.unjoined[files[number]] = files[number] + ": overlaps others, but "
                                         + (o.one_lens ? "it is the only camera raw file among them, or the only "
                                                         "other picture"
                                                       : no_overlap_within_camera());
    for (const uint32_t number : found.disconnected)
        groups.unjoined[files[number]] = files[number] + ": " + linked_by_other_camera();
    for (const FoundScene &scene : found.scenes) groups.list.push_back(group_of(scene, all));
    std::stable_sort(groups.list.begin(), groups.list.end(),
                     [](const Group &a, const Group &b) { return a.pictures.size() > b.pictures.size(); });
    return groups;
}

std::string noted_name(const std::string &file) { return ascii_path(canonical_path(file)); }

Json json_of(const std::map<std::string, std::string> &reasons) {
    Json list = Json::array();
    for (const auto &[file, reason] : reasons) list.push_back({noted_name(file), ascii_path(reason)});
    return list;
}

Json json_of(const Groups &groups, const std::string &key) {
    Json list = Json::array();
    for (const Group &group : groups.list) {
        Json files = Json::array();
        for (const InputPicture *picture : group.pictures) files.push_back(noted_name(picture->file));
        list.push_back({{"files", files}, {"found", json_of(group.found)}, {"facts", group.facts}});
    }
    return {{"key", key},
            {"groups", list},
            {"unjoined", json_of(groups.unjoined)},
            {"unreadable", json_of(groups.unreadable)},
            {"copies", json_of(groups.copies)}};
}

using ByNotedFile = std::map<std::string, const InputPicture *>;

bool recall_reasons(const Json &list, const ByNotedFile &by_file, std::map<std::string, std::string> &reasons) {
    for (const Json &entry : list) {
        const auto picture = by_file.find(entry[0].get<std::string>());
        if (picture == by_file.end()) return false;
        reasons[picture->second->file] = path_of_ascii(entry[1].get<std::string>());
    }
    return true;
}

// A disk or network error may be temporary.
bool is_readable(const std::string &file) {
    ReadOptions options;
    options.max_side = 256;
    return failure_of([&] { read_picture(file, options); }).empty();
}

bool has_size_of(const InputPicture &picture, const lensprof_camera &camera) {
    return picture.metadata.size.width == camera.width && picture.metadata.size.height == camera.height;
}

// Takes the ledger's data on these pictures; false if they are missing, or if a picture that was unreadable can now be
// read.
bool recall(const Json &notes, const std::string &key, const std::vector<const InputPicture *> &all, Groups &groups) {
    if (!notes.is_object() || !notes.contains("registration") || notes["registration"].value("key", "") != key)
        return false;
    const Json &registration = notes["registration"];
    ByNotedFile by_file;
    for (const InputPicture *picture : all) by_file[noted_name(picture->file)] = picture;
    for (const Json &known : registration["groups"]) {
        Group group;
        for (const Json &file : known["files"]) {
            const auto picture = by_file.find(file.get<std::string>());
            if (picture == by_file.end()) return false;
            group.pictures.push_back(picture->second);
        }
        if (!read_noted(known.value("found", Json()), known["files"].size(), group.found)) return false;
        for (size_t n = 0; n < group.pictures.size(); n++)
            if (!has_size_of(*group.pictures[n], group.found.cameras[n])) return false;
        group.facts = known["facts"];
        groups.list.push_back(std::move(group));
    }
    return recall_reasons(registration["unjoined"], by_file, groups.unjoined)
           && recall_reasons(registration["unreadable"], by_file, groups.unreadable)
           && recall_reasons(registration.value("copies", Json::array()), by_file, groups.copies)
           && std::none_of(groups.unreadable.begin(), groups.unreadable.end(),
                           [](const auto &entry) { return is_readable(entry.first); });
}

// The name of an earlier panorama with this key or, with an empty `key`, with any of the pictures; "" if not found.
std::string name_in_earlier_run(const Json &notes, const std::string &key, const Group &group,
                                const std::set<std::string> &used_names) {
    if (!notes.is_object() || !notes.contains("results")) return {};
    for (const auto &[name, result] : notes["results"].items()) {
        if (used_names.count(path_of_ascii(name))) continue;
        if (!key.empty() && result.value("key", "") == key) return path_of_ascii(name);
        for (const InputPicture *picture : group.pictures)
            for (const Json &file : result["files"])
                if (key.empty() && file == noted_name(picture->file)) return path_of_ascii(name);
    }
    return {};
}

std::string file_of(const FolderOptions &o, const std::string &name, const char *end) {
    return (std::filesystem::path(o.output) / ("panorama_" + name + end)).string();
}

// Named after the first picture, with a number if the name is used by something else.
std::string new_name(const FolderOptions &o, const Group &group, const std::set<std::string> &used_names,
                     const std::set<std::string> &targets, const Ledger &ledger) {
    std::string base = std::filesystem::path(group.pictures[0]->name).replace_extension().relative_path().string();
    std::replace(base.begin(), base.end(), '/', '-');
    for (char &c : base) c = static_cast<unsigned char>(c) < ' ' || c == '"' ? '_' : c;
    const size_t last = base.rfind("..-");  // for a picture above the folder
    if (last != std::string::npos) base = base.substr(last + 3);
    if (base.size() > 100) base = base.substr(base.size() - 100);
    for (int number = 1;; number++) {
        const std::string name = base + (number > 1 ? "_" + std::to_string(number) : "");
        bool is_free = !used_names.count(name);
        for (const char *end : {".pto", ".jpg"}) {
            const std::string file = file_of(o, name, end);
            is_free = is_free && !targets.count(file) && !ledger.is_foreign(file);
        }
        if (is_free) return name;
    }
}

// Keeps the names of earlier runs if possible: by pictures and options, then by any of the pictures.
std::vector<std::string> names_of(const FolderOptions &o, const std::vector<Group> &groups,
                                  const std::vector<std::string> &keys, const std::set<std::string> &targets,
                                  const Ledger &ledger) {
    std::set<std::string> used_names;
    std::vector<std::string> names(groups.size());
    for (const bool is_exact : {true, false})
        for (size_t n = 0; n < names.size(); n++) {
            if (!names[n].empty()) continue;
            const std::string name = name_in_earlier_run(ledger.notes, is_exact ? keys[n] : "", groups[n], used_names);
            const bool is_copy = targets.count(file_of(o, name, ".pto")) || targets.count(file_of(o, name, ".jpg"));
            if (name.empty() || is_copy) continue;  // a new picture has this name
            names[n] = name;
            used_names.insert(name);
        }
    for (size_t n = 0; n < names.size(); n++) {
        if (names[n].empty()) names[n] = new_name(o, groups[n], used_names, targets, ledger);
        used_names.insert(names[n]);
    }
    return names;
}

// Prefers a picture of its own to that of an earlier run, whose profile must not count twice.
std::string source_of(const Json &notes, const Group &group, const std::string &name) {
    const std::string known = ascii_path(name);
    if (notes.is_object() && notes.contains("results") && notes["results"].contains(known))
        return path_of_ascii(notes["results"][known].value("source", noted_name(group.pictures[0]->file)));
    return canonical_path(group.pictures[0]->file);
}

}  // namespace

bool Panorama::equalizes() const {
    const Json &result = summary["result"];
    return result.is_object() && (result["usable"] == true || result["equalizes"] == true);
}

Panoramas find_panoramas(const FolderOptions &o, const Inputs &inputs, Ledger &ledger, Events &events) {
    std::vector<const InputPicture *> all;
    std::set<std::string> targets;
    for (const InputPicture &picture : inputs.pictures) {
        all.push_back(&picture);
        targets.insert(picture.target);
    }
    Panoramas panoramas;
    Groups groups;
    const std::string key = key_of(all, o.one_lens ? "one lens" : "");
    if (!recall(ledger.notes, key, all, groups)) {
        groups = register_groups(o, all, events);
        panoramas.is_registered = true;
        ledger.notes["registration"] = json_of(groups, key);
        ledger.save();
    }
    panoramas.unjoined = groups.unjoined;
    panoramas.copies = groups.copies;
    panoramas.unjoined.insert(groups.unreadable.begin(), groups.unreadable.end());
    std::string fit_options = o.one_lens ? "one lens\n" : "\n";
    if (o.store.no_store) fit_options += "no store\n";
    for (const std::string &db : o.store.dbs) fit_options += canonical_path(db) + "\n";
    std::vector<std::string> keys;
    for (const Group &group : groups.list) keys.push_back(key_of(group.pictures, fit_options));
    const std::vector<std::string> names = names_of(o, groups.list, keys, targets, ledger);
    for (size_t n = 0; n < names.size(); n++) {
        const Group &group = groups.list[n];
        Panorama panorama;
        panorama.name = names[n];
        panorama.project = file_of(o, panorama.name, ".pto"), panorama.preview = file_of(o, panorama.name, ".jpg");
        panorama.pictures = group.pictures, panorama.found = group.found, panorama.key = keys[n];
        panorama.source = source_of(ledger.notes, group, names[n]);
        panorama.summary = {{"name", panorama.name}, {"project", panorama.project}, {"preview", nullptr}};
        panorama.summary["pictures"] = group.pictures.size();
        panorama.summary.update(group.facts);
        panoramas.list.push_back(std::move(panorama));
    }
    return panoramas;
}

void remove_obsolete_panoramas(const FolderOptions &o, const Panoramas &panoramas, Ledger &ledger) {
    if (!ledger.notes.is_object() || !ledger.notes.contains("results")) return;
    Json kept = Json::object();
    for (const auto &[name, result] : ledger.notes["results"].items()) {
        const std::string panorama_name = path_of_ascii(name);
        if (std::any_of(panoramas.list.begin(), panoramas.list.end(),
                        [&](const Panorama &p) { return p.name == panorama_name; }))
            kept[name] = result;
        else
            for (const char *end : {".pto", ".jpg"}) ledger.remove(file_of(o, panorama_name, end));
    }
    ledger.notes["results"] = kept;
}

}  // namespace lensprof
