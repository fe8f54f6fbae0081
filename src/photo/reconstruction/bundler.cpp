// Bundler's .out (version 0.3): cameras, and points with their views. Image names are in a separate list.
#include <charconv>
#include <cstring>
#include <filesystem>

#include "photo/base/failure.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/reconstruction/field_reader.hpp"
#include "photo/reconstruction/readers.hpp"

namespace lensprof {
namespace {

constexpr uint64_t kMaxBundlerBytes = uint64_t(8) << 30;
constexpr const char *kBundlerHeader = "# Bundle file";

// list.txt next to it, or the name of the file with the extension of a list.
std::string neighbouring_list(const std::string &path) {
    const std::filesystem::path file(path);
    std::vector<std::string> tried;
    for (const std::string &name : {file.filename().string() + ".list.txt", file.stem().string() + ".list.txt",
                                    std::string("list.txt"), std::string("image_list.txt")}) {
        tried.push_back((file.parent_path() / name).string());
        if (is_regular_file(tried.back())) return tried.back();
    }
    for (const std::string &name : {std::string("list.txt"), std::string("image_list.txt")}) {
        const std::string above = (file.parent_path() / ".." / name).string();
        if (is_regular_file(above)) return above;
    }
    throw Failure(LENSPROF_ERROR_READ, path + ": the list of its images is missing; store it as " + tried[2]);
}

bool is_number(const std::string &text) {
    double number = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size();
}

std::string last_word(const std::string &line) { return line.substr(line.find_last_of(" \t") + 1); }

std::string without_last_word(std::string line) {
    line.erase(line.size() - last_word(line).size());
    line.erase(line.find_last_not_of(" \t") + 1);
    return line;
}

// A line of the list without the 0 and the focal length that Bundler appends to a name; names may contain blanks.
std::string name_of(std::string line) {
    line.erase(line.find_last_not_of(" \t") + 1);
    const std::string without_last = without_last_word(line), without_last_two = without_last_word(without_last);
    if (!without_last_two.empty() && last_word(without_last) == "0" && is_number(last_word(line)))
        return without_last_two;
    return !without_last.empty() && last_word(line) == "0" ? without_last : line;
}

std::vector<std::string> read_list(const std::string &path) {
    FieldReader fields(path, '\0', kMaxBundlerBytes);
    std::vector<std::string> names;
    while (fields.next_line_of_values()) names.push_back(name_of(fields.rest()));
    return names;
}

// Centre -R^T t of rotation and translation, which take five lines; a camera of zeros was not placed.
void read_camera(FieldReader &fields, ReconstructionImage &image) {
    std::array<std::array<double, 3>, 5> rows;  // focal length and distortion, R, t
    for (auto &row : rows) {
        if (!fields.next_line_of_values()) fields.fail("cameras are missing");
        for (double &x : row) x = fields.number();
    }
    image.has_centre = rows[0][0] != 0.0;
    for (size_t d = 0; d < 3; d++)
        image.centre[d] = -(rows[1][d] * rows[4][0] + rows[2][d] * rows[4][1] + rows[3][d] * rows[4][2]);
}

// Position, colour, and the views: camera, feature, and position relative to the picture's centre, y upwards.
void read_point(FieldReader &fields, Reconstruction &found) {
    std::array<double, 3> position;
    if (!fields.next_line_of_values()) fields.fail("points are missing");
    for (double &x : position) x = fields.number();
    if (!fields.next_line_of_values()) fields.fail("points are missing");
    if (!fields.next_line_of_values()) fields.fail("points are missing");
    for (auto views = fields.integer<uint32_t>(); views > 0; views--) {
        TrackObservation observation;
        observation.point = static_cast<uint32_t>(found.points.size());
        observation.image = fields.integer<uint32_t>();
        if (observation.image >= found.images.size()) fields.fail("it refers to a camera that does not exist");
        observation.feature = static_cast<uint32_t>(fields.integer<int32_t>());  // -1 if it has no index
        observation.xy[0] = static_cast<float>(fields.number());
        observation.xy[1] = -static_cast<float>(fields.number());
        if (found.observations.size() == max_observations) fields.fail("it has too many observations");
        found.observations.push_back(observation);
    }
    found.points.push_back(position);
}

}  // namespace

bool is_bundler(const std::string &path) {
    return is_regular_file(path) && read_head(path, std::strlen(kBundlerHeader)) == kBundlerHeader;
}

Reconstruction read_bundler(const std::string &path) {
    Reconstruction found;
    found.kind = "Bundler file", found.path = path;
    found.coordinates = ImageCoordinates::stored_centred_px;
    found.cameras.emplace_back();
    const std::string list = neighbouring_list(path);
    for (const std::string &name : read_list(list)) found.images.push_back({name, 0, false, {}});
    FieldReader fields(path, '\0', kMaxBundlerBytes);
    if (!fields.next_line() || fields.rest() != kBundlerHeader + std::string(" v0.3"))
        fields.fail("it is not version 0.3, which has the feature positions");
    if (!fields.next_line_of_values()) fields.fail("the number of cameras is missing");
    const auto cameras = fields.integer<uint32_t>(), points = fields.integer<uint32_t>();
    if (cameras != found.images.size())
        throw Failure(LENSPROF_ERROR_READ, path + ": has " + std::to_string(cameras) + " cameras, but " + list + " has "
                                               + std::to_string(found.images.size())
                                               + " images; give the matching list");
    for (ReconstructionImage &image : found.images) read_camera(fields, image);
    for (uint32_t n = 0; n < points; n++) read_point(fields, found);
    clean_tracks(found);
    sort_images(found);
    return found;
}

}  // namespace lensprof
