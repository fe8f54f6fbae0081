#include "cli/calibrate/inputs.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

#include "cli/fitting/photographs.hpp"
#include "cli/pictures/named_pictures.hpp"
#include "cli/pictures/picture.hpp"
#include "cli/pictures/raw_kind.hpp"
#include "cli/program/parallel.hpp"
#include "cli/program/paths.hpp"

namespace lensprof {
namespace {

namespace fs = std::filesystem;

void check_output(const std::vector<std::string> &words, const std::string &output) {
    for (const std::string &word : words) {
        if (!is_folder(word) && !is_picture_name(word) && path_exists(word))
            throw Failure(
                ExitCode::usage,
                word
                    + ": is no picture (.jpg, .png, .tif, camera raw) and no folder; for a project there is `lensprof build`");
        if (one_name(word) == one_name(output))
            throw Failure(ExitCode::usage, output + ": is the folder of the pictures; give another with -o");
    }
}

// Whether a picture of a folder lies in a subfolder that calibrate has written.
bool is_output(const NamedPicture &picture, std::map<std::string, bool> &known) {
    if (!picture.in_folder) return false;
    fs::path place = fs::path(picture.file).parent_path();
    for (fs::path below = picture.subfolder; !below.empty(); below = below.parent_path()) {
        const auto [entry, is_new] = known.try_emplace(place.string(), false);
        if (is_new) entry->second = is_regular_file((place / summary_name).string());
        if (entry->second) return true;
        place = place.parent_path();
    }
    return false;
}

// Two pictures would have the same copy, or one would be written over a picture.
void check_targets(const Inputs &inputs, const std::vector<NamedPicture> &named) {
    std::set<std::string> read;
    for (const NamedPicture &picture : named) read.insert(one_name(picture.file));
    std::map<std::string, std::string> written;
    for (const InputPicture &picture : inputs.pictures) {
        const std::string target = one_name(picture.target);
        if (read.count(target))
            throw Failure(ExitCode::usage, picture.file + ": its corrected copy would be " + picture.target
                                               + ", which is a picture of this call; give another folder with -o");
        const auto [other, is_new] = written.try_emplace(target, picture.file);
        if (!is_new)
            throw Failure(ExitCode::usage,
                          picture.file + " and " + other->second + ": both would be " + picture.target
                              + "; give the folder above them, or calibrate them one folder at a time");
    }
}

// Metadata and identity; the reason to leave it out, or "".
std::string look_at(InputPicture &picture, bool &is_unreadable) {
    try {
        picture.metadata = read_metadata(picture.file);
        picture.identity = stamp_of(picture.file) + ":" + digest_of(picture.file);
    } catch (const Failure &failure) {
        if (failure.code != ExitCode::unreadable) throw;
        is_unreadable = true;
        return failure.what();
    }
    const auto &mark = picture.metadata.mark;
    if (mark && mark->falloff == CorrectionMark::Falloff::removed)
        return picture.file + ": is corrected already, " + picture.metadata.corrected_by + "; give the original";
    return {};
}

}  // namespace

Inputs find_inputs(const std::vector<std::string> &words, const std::string &output, Progress &progress) {
    check_output(words, output);
    std::vector<NamedPicture> named = named_pictures(words, output);
    std::map<std::string, bool> known;
    named.erase(std::remove_if(named.begin(), named.end(), [&](const auto &one) { return is_output(one, known); }),
                named.end());
    std::map<std::string, std::string> subfolders;
    for (const NamedPicture &picture : named) subfolders.emplace(picture.file, picture.subfolder);
    const Photographs list = list_photographs(words, named);
    Inputs inputs;
    inputs.label = list.label;
    inputs.found = named.size();
    std::vector<InputPicture> all(list.files.size());
    std::vector<std::string> reasons(all.size());
    std::vector<char> unreadable(all.size(), 0);
    for_each_parallel(static_cast<uint32_t>(all.size()), "looking at pictures", progress, [&](uint32_t i) {
        InputPicture &picture = all[i];
        picture.file = list.files[i], picture.name = list.names[i];
        fs::path name = fs::path(picture.file).filename();
        if (raw_kind(picture.file)) name.replace_extension(".tif");
        picture.target = (fs::path(output) / subfolders.at(picture.file) / name).string();
        bool fails = false;
        reasons[i] = look_at(picture, fails);
        unreadable[i] = fails;
    });
    for (size_t i = 0; i < all.size(); i++) {
        inputs.unreadable += unreadable[i] != 0;
        if (reasons[i].empty())
            inputs.pictures.push_back(std::move(all[i]));
        else
            inputs.left_out.push_back({all[i].file, reasons[i]});
    }
    for (const NamedPicture &picture : named)
        if (!picture.instead_of.empty()) {
            const std::string other = fs::path(picture.file).replace_filename(picture.instead_of).string();
            inputs.left_out.push_back(
                {other, other + ": " + fs::path(picture.file).filename().string() + " is taken in its place"});
            inputs.found++;
        }
    for (const auto &[file, why] : list.copies) inputs.left_out.push_back({file, file + ": " + why});
    check_targets(inputs, named);
    return inputs;
}

}  // namespace lensprof
