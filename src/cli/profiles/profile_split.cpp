#include "cli/profiles/profile_split.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>

#include "cli/report/report.hpp"
#include "photo/base/format.hpp"
#include "photo/base/output_file.hpp"

namespace lensprof {
namespace {

constexpr size_t max_name_bytes = 200;  // bytes, without extension: file systems allow 255

// Removes characters that other file systems refuse. UTF-8 is kept.
std::string file_name_of(const std::string &text) {
    std::string name;
    for (const char c : text) name += c < 0 || (c >= ' ' && !std::strchr("/\\:*?\"<>|\x7f", c)) ? c : '-';
    while (name.size() > max_name_bytes || (!name.empty() && (name.back() == '.' || name.back() == ' '))) {
        while (name.size() > 1 && (name.back() & 0xC0) == 0x80) name.pop_back();  // the rest of a UTF-8 character
        name.pop_back();
    }
    return name.empty() || name[0] == '.' ? "_" + name : name;
}

const char *ending_of(const ForeignRule &rule) {
    switch (rule.format) {
    case LENSPROF_FORMAT_LENSFUN: return "xml";
    case LENSPROF_FORMAT_ALSC: return "json";
    case LENSPROF_FORMAT_PCALIB: return "txt";
    case LENSPROF_FORMAT_CURVES: return "csv";
    case LENSPROF_FORMAT_C: return "h";
    default: return rule.name;
    }
}

// The lens, else the camera with a built-in lens.
std::string lens_name_of(const lensprof_profile_key &key) {
    if (*key.lens) return key.lens;
    return *key.camera_model ? camera_name(key.camera_maker, key.camera_model) : "unknown lens";
}

// The properties shared by the profiles of one file: the lens, and camera and sensor if the file has only one.
std::string group_of(const ForeignRule &rule, const lensprof_profile_key &key) {
    std::string group = lens_name_of(key);
    if (rule.format == LENSPROF_FORMAT_LCP) {
        if (*key.camera_model && *key.lens) group += std::string(" on ") + key.camera_model;
        if (key.crop_factor != LENSPROF_UNKNOWN) group += format(", crop %.4g", key.crop_factor);
        if (key.processing != LENSPROF_PROCESSING_RAW) group += std::string(", ") + processing_name(key.processing);
    }
    return group;
}

// As seen by a file system that ignores case.
std::string folded(std::string name) {
    std::transform(name.begin(), name.end(), name.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return name;
}

}  // namespace

std::vector<SplitFile> write_split(const ForeignRule &rule, const std::string &folder, const ForeignOptions &options,
                                   const std::vector<StoredProfile> &profiles) {
    std::vector<SplitFile> files;
    std::map<std::string, size_t> file_of_group;
    std::set<std::string> used_names;
    const auto add_file = [&](const std::string &name) {
        const std::string base_name = file_name_of(name);
        std::string unused = base_name;
        for (int i = 2; !used_names.insert(folded(unused)).second; i++)
            unused = base_name + " (" + std::to_string(i) + ")";
        files.push_back({(std::filesystem::path(folder) / (unused + "." + ending_of(rule))).string(), {}});
        return files.size() - 1;
    };
    for (const StoredProfile &stored : profiles) {
        const std::string group = group_of(rule, stored.profile->key);
        if (rule.is_many) {
            const bool is_exact = rule.format == LENSPROF_FORMAT_LCP;  // which distinguishes names by case
            const auto [group_file, is_new] = file_of_group.try_emplace(is_exact ? group : folded(group), 0);
            if (is_new) group_file->second = add_file(group);
            files[group_file->second].profiles.push_back(&stored);
        } else {
            files[add_file(group + " " + std::to_string(stored.id))].profiles.push_back(&stored);
        }
    }
    std::vector<std::string> texts;  // before a folder is created
    for (const SplitFile &file : files) {
        std::vector<const lensprof_profile *> content;
        std::vector<std::string> names;
        for (const StoredProfile *stored : file.profiles) {
            content.push_back(stored->profile.get());
            names.push_back("profile " + std::to_string(stored->id));
        }
        texts.push_back(foreign_bytes(rule, file.path, options, content, names));
    }
    make_folder(folder);
    OutputFiles outputs;
    for (size_t i = 0; i < files.size(); i++) outputs.add(files[i].path, texts[i]);
    outputs.commit();
    return files;
}

}  // namespace lensprof
