#include "photo/scene/photographs.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "photo/base/format.hpp"
#include "photo/base/lap.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/pictures/even_light.hpp"
#include "photo/pictures/other_parts.hpp"

namespace lensprof {
namespace {

// Whether two files of equal, nonzero size have the same content, as far as they can be read.
bool is_copy(const std::string &first, const std::string &second) {
    std::ifstream a(first, std::ios::binary), b(second, std::ios::binary);
    std::vector<char> x(1 << 16), y(1 << 16);
    for (;;) {
        a.read(x.data(), static_cast<std::streamsize>(x.size()));
        b.read(y.data(), static_cast<std::streamsize>(y.size()));
        if (a.gcount() != b.gcount() || !std::equal(x.begin(), x.begin() + a.gcount(), y.begin())) return false;
        if (a.gcount() == 0) return true;
    }
}

}  // namespace

Photographs list_photographs(const std::vector<std::string> &words, const std::vector<NamedPicture> &pictures) {
    const bool is_one_folder = words.size() == 1 && is_folder(words[0]);
    Photographs list;
    std::set<std::string> known;
    std::map<uint64_t, std::vector<size_t>> by_size;
    for (const NamedPicture &picture : pictures) {
        if (!known.insert(file_identity(picture.file)).second) continue;
        const uint64_t bytes = file_bytes(picture.file);  // 0 if the file does not exist
        auto &same_size = by_size[bytes];
        const auto original =
            !bytes ? same_size.end() : std::find_if(same_size.begin(), same_size.end(), [&](size_t other) {
                return is_copy(list.files[other], picture.file);
            });
        if (original != same_size.end()) {
            list.left_out.emplace_back(picture.file, "a copy of " + list.names[*original]);
            continue;
        }
        same_size.push_back(list.files.size());
        list.files.push_back(picture.file);
        list.names.push_back(is_one_folder ? std::filesystem::path(picture.file).lexically_relative(words[0]).string()
                                           : picture.file);
    }
    list.label = words.size() == 1 ? words[0] : counted(list.files.size(), "picture");
    return list;
}

namespace {

using LeftOut = std::vector<std::pair<std::string, std::string>>;  // names and reasons

// Reports pictures that are not part of the project, for one reason.
void leave_out(const std::vector<uint32_t> &numbers, const std::vector<std::string> &names, const std::string &reason,
               LeftOut &left_out, Events &events) {
    for (uint32_t number : numbers) left_out.emplace_back(names[number], reason);
    events.warn(listed(numbers, names), "left out: " + reason);
}

std::string reason_left_out(const FoundScene &other, const FoundScene &scene) {
    if (other.kind == SceneKind::still)
        return "part of another group, whose camera did not move" + advice("still_group");
    if (other.connected_group == scene.connected_group)
        return std::string("part of another group: ") + linked_by_other_camera();
    return "part of another group that overlaps none of these pictures; give that group's pictures alone";
}

void report_found(const Registration &found, const std::vector<std::string> &names, const std::string &label,
                  LeftOut &left_out, Events &events) {
    const FoundScene &scene = found.scenes[0];
    const std::string unfit =
        scene.unfit() ? format(" that fit; %zu more do not fit the cameras and are compared only at matched points",
                               scene.unfit())
                      : "";
    events.note(
        label, format("%zu pictures overlap (%s%s; alignment residual %.2f %% of the longer side; %s); estimating "
                      "response, falloff, exposures and white balances%s",
                      scene.pictures.size(), counted(scene.links.size() - scene.unfit(), "link").c_str(), unfit.c_str(),
                      100.0 * scene.residual,
                      scene.kind == SceneKind::plane ? "a camera that moved over a plane, compared only at matched "
                                                       "points"
                                                     : "a rotating camera",
                      advice("free_parameters").c_str()));
    const size_t cameras = std::set<uint32_t>(scene.camera_ids.begin(), scene.camera_ids.end()).size();
    if (cameras > 1)
        events.note(label, format("the pictures are from %zu cameras, sizes or processings; each gets its own response",
                                  cameras)
                               + advice("one_lens"));
    if (!scene.cameras_fit()) events.warn(label, poor_cameras_note);
    for (size_t n = 1; n < found.scenes.size(); n++)
        leave_out(found.scenes[n].pictures, names, reason_left_out(found.scenes[n], scene), left_out, events);
    if (!found.other_camera.empty()) leave_out(found.other_camera, names, no_overlap_within_camera(), left_out, events);
    if (!found.disconnected.empty()) leave_out(found.disconnected, names, linked_by_other_camera(), left_out, events);
    if (!found.isolated.empty())
        leave_out(found.isolated, names, "no overlap with another picture found", left_out, events);
}

}  // namespace

bool is_of_even_light(const std::string &file) {
    try {
        return shows_even_light(file);
    } catch (const Failure &) {
        return false;
    }
}

std::string no_overlap_of(const std::string &file) {
    return std::string("no overlap with another picture found")
           + (is_of_even_light(file) ? ": it shows an even light, as pictures of a white card do" + advice("card")
                                     : std::string());
}

bool is_picture_argument(const std::string &word) { return is_folder(word) || is_picture_name(word); }

// Whether a picture in a folder is marked as an output of lensprof.
static bool is_corrected_copy(const NamedPicture &picture) {
    if (!picture.in_folder) return false;
    try {
        const auto mark = read_metadata(picture.file).mark;
        return mark && mark->falloff != CorrectionMark::Falloff::added;
    } catch (const Failure &) {
        return false;  // reported when it is read
    }
}

Photographs find_photographs(const std::vector<std::string> &words, Events &events) {
    std::vector<std::string> other_kinds;
    std::vector<NamedPicture> named = named_pictures(words, std::string(), other_kinds);
    for (const std::string &text : other_kinds) events.warn({}, text);
    const std::vector<NamedPicture> outputs = extract_outputs(named, events);
    for (const NamedPicture &picture : named) note_instead(picture, events);
    const auto first_corrected = std::stable_partition(
        named.begin(), named.end(), [](const NamedPicture &picture) { return !is_corrected_copy(picture); });
    const std::vector<NamedPicture> corrected(first_corrected, named.end());
    named.erase(first_corrected, named.end());
    Photographs list = list_photographs(words, named);
    for (const NamedPicture &picture : corrected)
        list.left_out.emplace_back(picture.file,
                                   "lensprof made it from another picture; give its name explicitly to "
                                   "use it");
    for (const auto &[file, reason] : list.left_out) events.warn(file, "left out: " + reason);
    for (const NamedPicture &picture : outputs)
        list.left_out.emplace_back(picture.file, "it is in an output folder of calibrate");
    require_one_kind(list.files);
    note_several(list.files, events);
    if (list.files.size() < 2) {
        for (const std::string &file : list.files) read_header(file);  // for its errors
        throw Failure(LENSPROF_ERROR_NOT_USABLE,
                      list.label + (list.files.empty() ? ": has only corrected pictures" : ": has only one picture")
                          + "; give at least two that overlap",
                      LENSPROF_REASON_FEW_PAIRS);
    }
    return list;
}

Scene scene_of_pictures(const Photographs &list, bool one_lens, Events &events) {
    const auto &[label, files, names, left_out] = list;
    Scene scene;
    scene.left_out = left_out;
    auto clock = std::chrono::steady_clock::now();
    const Registration found = register_pictures(files, {}, one_lens, events);
    scene.register_s = lap(clock);
    events.clear();
    for (const auto &[number, reason] : found.unreadable) {
        scene.left_out.emplace_back(names[number], reason);
        events.warn({}, reason + "; left out");
    }
    if (found.scenes.empty() && std::all_of(files.begin(), files.end(), is_of_even_light))
        throw Failure(LENSPROF_ERROR_NOT_USABLE,
                      label + ": the pictures show an even light, as those of a white card do: no overlap can be found"
                          + advice("card"),
                      LENSPROF_REASON_FEW_PAIRS);
    for (const CopiedPicture &picture : found.copies)
        leave_out({picture.copy}, names, "a copy of " + names[picture.original] + picture.how, scene.left_out, events);
    if (found.unreadable.size() == files.size())
        throw Failure(LENSPROF_ERROR_READ, label + ": none of the pictures can be read; give others");
    if (found.unreadable.size() + found.copies.size() + 1 == files.size() && !found.copies.empty())
        throw Failure(LENSPROF_ERROR_NOT_USABLE,
                      label + ": has only one photograph and copies of it; give at least two that overlap",
                      LENSPROF_REASON_FEW_PAIRS);
    if (found.scenes.empty() && !found.other_camera.empty())
        throw Failure(LENSPROF_ERROR_NOT_USABLE,
                      label + ": no two pictures of the same camera, size and processing overlap; give more pictures "
                              "per camera, or use " + option_name("one_lens") + " to treat all as one",
                      LENSPROF_REASON_FEW_PAIRS);
    if (found.scenes.empty())
        throw Failure(LENSPROF_ERROR_NOT_USABLE,
                      label + ": no two of the pictures overlap, or they have too few recognisable features; give "
                              "pictures that overlap by a third, or a Hugin project",
                      LENSPROF_REASON_FEW_PAIRS);
    if (found.scenes[0].kind == SceneKind::still)
        throw Failure(LENSPROF_ERROR_NOT_USABLE, label + still_camera_reason(), LENSPROF_REASON_FEW_PAIRS);
    report_found(found, names, label, scene.left_out, events);

    const FoundScene &largest = found.scenes[0];
    scene.unlinked = found.isolated.size();
    scene.path = label;
    for (const uint32_t picture : largest.pictures) {
        scene.names.push_back(names[picture]);
        scene.files.push_back(files[picture]);
        scene.metadata.push_back(found.metadata[picture]);
    }
    set_found(largest, scene);
    return scene;
}

void set_found(const FoundScene &found, Scene &scene) {
    std::vector<NewImage> images;
    for (size_t n = 0; n < found.cameras.size(); n++)
        images.push_back({found.cameras[n], found.camera_ids[n], found.lenses[n]});
    set_images(images, scene);
    scene.control_points = found.points;
    scene.links = found.links;
    scene.matches = found.matches, scene.by_matches = found.by_matches;
}

}  // namespace lensprof
