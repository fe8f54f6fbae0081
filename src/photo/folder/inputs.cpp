#include "photo/folder/inputs.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

#include "photo/base/file_kind.hpp"
#include "photo/base/parallel.hpp"
#include "photo/base/paths.hpp"
#include "photo/folder/attempt.hpp"
#include "photo/pictures/coded_kind.hpp"
#include "photo/pictures/named_pictures.hpp"
#include "photo/pictures/other_parts.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/pictures/raw_kind.hpp"
#include "photo/scene/photographs.hpp"

namespace lensprof {
namespace {

namespace fs = std::filesystem;

void check_output(const std::vector<std::string> &words, const std::string &output) {
    for (const std::string &word : words) {
        refuse_other_kind(word);
        if (!is_folder(word) && !is_picture_name(word) && path_exists(word))
            throw Failure(
                LENSPROF_ERROR_ARGUMENT,
                word + ": is neither a picture (.jpg, .png, .tif, camera raw) nor a folder" + advice("build_project"));
        if (canonical_path(word) == canonical_path(output))
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          output + ": is the folder of the pictures; give another output folder" + advice("output"));
    }
}

// Of pictures in one folder with the same copy name the first is used: img000.dng and img000.nef both become
// img000.tif.
void leave_out_duplicates(Inputs &inputs) {
    std::map<std::string, const InputPicture *> first;
    std::vector<InputPicture> kept;
    kept.reserve(inputs.pictures.size());
    for (InputPicture &picture : inputs.pictures) {
        const fs::path file = picture.file;
        const auto [other, is_new] = first.try_emplace(canonical_path(picture.target), nullptr);
        if (!is_new && fs::path(other->second->file).parent_path() == file.parent_path()) {
            inputs.left_out.push_back({picture.file, picture.file + ": its corrected copy would be " + picture.target
                                                         + ", like that of " + other->second->name
                                                         + ", which is used instead; rename one"});
            continue;
        }
        kept.push_back(std::move(picture));
        other->second = &kept.back();
    }
    inputs.pictures = std::move(kept);
}

// Refuses pictures of two folders with the same copy name, and copies that would overwrite a picture.
void check_targets(const Inputs &inputs, const std::vector<NamedPicture> &named) {
    std::set<std::string> read;
    for (const NamedPicture &picture : named) read.insert(canonical_path(picture.file));
    std::map<std::string, std::string> written;
    for (const InputPicture &picture : inputs.pictures) {
        const std::string target = canonical_path(picture.target);
        if (read.count(target))
            throw Failure(LENSPROF_ERROR_ARGUMENT, picture.file + ": its corrected copy would be " + picture.target
                                                       + ", which is an input picture; give another folder"
                                                       + advice("output"));
        const auto [other, is_new] = written.try_emplace(target, picture.file);
        if (!is_new)
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          picture.file + " and " + other->second + ": both would be " + picture.target
                              + "; give their parent folder, or calibrate one folder at a time");
    }
}

// The name of the copy, with another extension if the file's does not match its content.
std::string copy_name(const InputPicture &picture) {
    fs::path name = fs::path(picture.file).filename();
    if (picture.is_raw) return name.replace_extension(".tif").string();
    const FileFormat format = read_header(picture.file).traits.format;
    if (is_picture_name(name.string()) && !is_raw_name(name.string()) && !coded_kind_of_name(name.string())
        && format_of_name(name.string()) == format)
        return name.string();
    const char *end = format == FileFormat::png ? ".png" : format == FileFormat::jpeg ? ".jpg" : ".tif";
    return name.replace_extension(end).string();
}

// Whether the copy would overwrite a contact sheet.
bool is_sheet(const InputPicture &picture, const std::string &output) {
    const fs::path target = canonical_path(picture.target);
    const std::string name = target.filename().string();
    if (name.rfind("calibrate_sheet", 0) != 0 || target.parent_path() != fs::path(canonical_path(output))) return false;
    for (size_t page = 0; page < 1000; page++)
        if (name == sheet_name(page)) return true;
    return false;
}

// Sets metadata, identity and copy in `folder`; returns the reason to leave it out, or "".
std::string examine_picture(InputPicture &picture, const fs::path &folder, bool &is_unreadable) {
    SeveralPictures several;
    try {
        picture.is_raw = raw_kind(picture.file).has_value();
        picture.target = (folder / copy_name(picture)).string();
        picture.metadata = read_metadata(picture.file);
        several = several_pictures(picture.file);
        picture.identity = stamp_of(picture.file) + ":" + digest_of(picture.file);
    } catch (const Failure &failure) {
        if (!is_of_pictures(failure)) throw;
        is_unreadable = true;
        return failure.what();
    }
    const auto &mark = picture.metadata.mark;
    if (!several.what.empty())
        return picture.file + ": " + several.what + ", but only the first would be corrected; " + several.next_step;
    if (mark && mark->falloff == CorrectionMark::Falloff::removed)
        return picture.file + ": already corrected, " + picture.metadata.corrected_by + "; give the original";
    return {};
}

}  // namespace

namespace {

// Examines the pictures in parallel.
void examine_pictures(const Photographs &list, const std::vector<NamedPicture> &named, const std::string &output,
                      Inputs &inputs, Events &events) {
    std::map<std::string, std::string> subfolders;
    for (const NamedPicture &picture : named) subfolders.emplace(picture.file, picture.subfolder);
    std::vector<InputPicture> all(list.files.size());
    std::vector<std::string> reasons(all.size());
    std::vector<char> unreadable(all.size(), 0);
    for_each_parallel(static_cast<uint32_t>(all.size()), "scanning pictures", events, [&](uint32_t i) {
        all[i].file = list.files[i], all[i].name = list.names[i];
        bool is_unreadable = false;
        reasons[i] = examine_picture(all[i], fs::path(output) / subfolders.at(all[i].file), is_unreadable);
        if (reasons[i].empty() && is_sheet(all[i], output))
            reasons[i] = all[i].file + ": has the name of the contact sheet that calibrate writes; rename it";
        unreadable[i] = is_unreadable;
    });
    for (size_t i = 0; i < all.size(); i++) {
        inputs.unreadable += unreadable[i] != 0;
        if (reasons[i].empty())
            inputs.pictures.push_back(std::move(all[i]));
        else
            inputs.left_out.push_back({all[i].file, reasons[i]});
    }
}

// Files replaced by another file with the same base name.
void list_replaced(const std::vector<NamedPicture> &named, Inputs &inputs) {
    std::set<std::string> known;
    for (const NamedPicture &picture : named)
        for (const std::string &name : picture.instead_of) {
            const std::string other = fs::path(picture.file).replace_filename(name).string();
            if (!known.insert(other).second) continue;
            inputs.left_out.push_back(
                {other, other + ": " + fs::path(picture.file).filename().string() + " is used instead"});
            inputs.found++;
        }
}

}  // namespace

std::string sheet_name(size_t page) {
    return "calibrate_sheet" + (page ? std::to_string(page + 1) : std::string()) + ".jpg";
}

Inputs find_inputs(const std::vector<std::string> &words, const std::string &output, Events &events) {
    check_output(words, output);
    std::vector<UnlistedFolder> unlisted;
    std::vector<std::string> other_kinds;
    std::vector<NamedPicture> named = named_pictures(words, output, other_kinds, &unlisted);
    for (const std::string &text : other_kinds) events.warn({}, text);
    extract_below(named, has_ledger);
    const Photographs list = list_photographs(words, named);
    Inputs inputs;
    inputs.label = list.label;
    inputs.found = list.files.size() + list.left_out.size();
    examine_pictures(list, named, output, inputs, events);
    leave_out_duplicates(inputs);
    list_replaced(named, inputs);
    for (const auto &[file, why] : list.left_out) inputs.left_out.push_back({file, file + ": " + why});
    for (const UnlistedFolder &folder : unlisted) inputs.left_out.push_back({folder.folder, folder.reason});
    check_targets(inputs, named);
    return inputs;
}

}  // namespace lensprof
