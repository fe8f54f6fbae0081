#include "photo/clip/transforms_file.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <tuple>

#include "photo/base/failure.hpp"
#include "photo/base/format.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/paths.hpp"

namespace lensprof {
namespace {

using OrderedJson = nlohmann::ordered_json;
namespace fs = std::filesystem;

[[noreturn]] void fail_transforms(const std::string &folder, const std::string &what) {
    throw Failure(LENSPROF_ERROR_READ, transforms_path(folder) + ": " + what);
}

constexpr int deepest = 100;  // of nested lists and objects; copies are recursive

// The file of a name, which may lack its extension; if no such file exists, the name without an extension.
std::string picture_named(const std::string &folder, const std::string &name) {
    const std::string path = (fs::path(folder) / name).lexically_normal().string();
    if (is_regular_file(path)) return path;
    for (const char *extension : {".png", ".jpg", ".jpeg", ".PNG", ".JPG"})
        if (is_regular_file(path + extension)) return path + extension;
    return path;
}

// A name relative to one folder as one relative to another.
void move_name(OrderedJson &object, const char *key, const std::string &from, const std::string &to) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_string()) return;
    const fs::path name(found->get<std::string>());
    if (name.is_absolute()) return;
    const fs::path whole(canonical_path((fs::path(from) / name).string()));
    *found = whole.lexically_proximate(canonical_path(to)).generic_string();
}

// A name without extension: what comes before the number at its end, and the number.
std::pair<std::string, std::string> split_number(const std::string &file) {
    const std::string name = fs::path(file).replace_extension().string();
    const size_t end = name.find_last_not_of("0123456789") + 1;
    return {name.substr(0, end), name.substr(std::min(name.find_first_not_of('0', end), name.size()))};
}

// Whether the number after this text is the fraction of a decimal, "1.02".
bool is_before_fraction(const std::string &before) {
    const size_t size = before.size();
    return size > 1 && before[size - 1] == '.' && before[size - 2] >= '0' && before[size - 2] <= '9';
}

void sort_by_number(TransformsFile &transforms) {
    using Place = std::tuple<size_t, std::string, size_t>;  // digits, number, frame
    std::vector<Place> places;
    if (is_before_fraction(split_number(transforms.files[0]).first)) return;
    for (size_t i = 0; i < transforms.files.size(); i++) {
        const auto [before, number] = split_number(transforms.files[i]);
        if (before != split_number(transforms.files[0]).first) return;
        places.emplace_back(number.size(), number, i);
    }
    if (std::is_sorted(places.begin(), places.end())) return;
    std::sort(places.begin(), places.end());
    const TransformsFile listed = transforms;
    for (size_t i = 0; i < places.size(); i++) {
        transforms.files[i] = listed.files[std::get<2>(places[i])];
        transforms.content["frames"][i] = listed.content["frames"][std::get<2>(places[i])];
    }
    transforms.is_sorted = true;
}

}  // namespace

std::string transforms_path(const std::string &folder) { return (fs::path(folder) / transforms_name).string(); }

bool has_transforms(const std::string &folder) { return is_regular_file(transforms_path(folder)); }

TransformsFile read_transforms(const std::string &folder) {
    TransformsFile transforms{folder, {}, {}, false};
    const auto check_depth = [&](int depth, OrderedJson::parse_event_t, const OrderedJson &) {
        if (depth > deepest) fail_transforms(folder, format("is nested more than %d deep; repair it", deepest));
        return true;
    };
    try {
        transforms.content = OrderedJson::parse(read_text(transforms_path(folder), max_text_bytes), check_depth);
    } catch (const OrderedJson::exception &error) {
        fail_transforms(folder, std::string("is not JSON: ") + error.what() + "; repair it");
    }
    const OrderedJson &content = transforms.content;
    if (!content.is_object() || !content.contains("frames") || !content["frames"].is_array())
        fail_transforms(folder,
                        "has no list of frames, as nerfstudio and instant-ngp write it; give their file, or move "
                        "it away to read the pictures of the folder");
    for (const OrderedJson &frame : content["frames"]) {
        const size_t index = transforms.files.size();
        if (!frame.is_object() || !frame.contains("file_path") || !frame["file_path"].is_string())
            fail_transforms(folder, format("frames[%zu] has no file_path; add the name of its picture", index));
        const std::string file = picture_named(folder, frame["file_path"].get<std::string>());
        if (!is_regular_file(file))
            fail_transforms(
                folder, format("frames[%zu]: ", index) + file + " does not exist; copy it there, or remove the frame");
        transforms.files.push_back(file);
    }
    if (transforms.files.empty()) fail_transforms(folder, "lists no frames; give a file with frames");
    sort_by_number(transforms);
    return transforms;
}

void check_stated_size(const TransformsFile &transforms, uint32_t width, uint32_t height) {
    const OrderedJson &content = transforms.content;
    const auto differs = [&](const char *key, uint32_t size) {
        return content.contains(key) && content[key].is_number() && content[key].get<double>() != double(size);
    };
    if (differs("w", width) || differs("h", height))
        fail_transforms(transforms.folder, "states w = " + content.value("w", OrderedJson()).dump()
                                               + ", h = " + content.value("h", OrderedJson()).dump() + ", but "
                                               + transforms.files[0]
                                               + format(" has %u x %u pixels; correct them", width, height));
}

std::string levelled_transforms(const TransformsFile &transforms, const std::string &folder,
                                const std::vector<LevelledPose> &frames) {
    OrderedJson content = transforms.content, kept = OrderedJson::array();
    std::map<std::string, std::string> new_names;  // of the source's files
    for (size_t i = 0; i < frames.size(); i++) {
        OrderedJson frame = content["frames"][i];
        new_names[transforms.files[i]] = frames[i].file;
        if (frames[i].file.empty()) continue;
        frame["file_path"] = frames[i].file;
        frame["exposure_ev"] = frames[i].removed_ev;
        for (const char *key : {"mask_path", "depth_file_path"}) move_name(frame, key, transforms.folder, folder);
        kept.push_back(std::move(frame));
    }
    content["frames"] = std::move(kept);
    move_name(content, "ply_file_path", transforms.folder, folder);
    for (const char *key : {"train_filenames", "val_filenames", "test_filenames"}) {
        if (!content.contains(key) || !content[key].is_array()) continue;
        OrderedJson names = OrderedJson::array();
        for (const OrderedJson &name : content[key]) {
            const auto found = name.is_string()
                                   ? new_names.find(picture_named(transforms.folder, name.get<std::string>()))
                                   : new_names.end();
            if (found == new_names.end())
                names.push_back(name);
            else if (!found->second.empty())
                names.push_back(found->second);
        }
        content[key] = std::move(names);
    }
    return content.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";  // folders have any name
}

}  // namespace lensprof
