// tracks.csv of OpenSfM and OpenDroneMap: features of every picture with track and colour; and reconstruction.json next
// to it: positions of cameras and points.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <unordered_map>
#include <utility>

#include <nlohmann/json.hpp>

#include "photo/base/failure.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/reconstruction/field_reader.hpp"
#include "photo/reconstruction/json_file.hpp"
#include "photo/reconstruction/readers.hpp"

namespace lensprof {
namespace {

constexpr uint64_t kMaxTracksBytes = uint64_t(64) << 30;  // of tracks.csv, which is read line by line
constexpr const char *kTracksHeader = "OPENSFM_TRACKS_VERSION_v";

// Version 0 has no feature size, 1 has one, and 2 has segmentation and instance after the colour.
int version_of(const std::string &path) {
    const std::string head = read_head(path, 4096);
    if (head.compare(0, std::strlen(kTracksHeader), kTracksHeader) != 0) return 0;
    const std::string number =
        head.substr(std::strlen(kTracksHeader), head.find_first_of("\r\n") - std::strlen(kTracksHeader));
    if (number != "0" && number != "1" && number != "2")
        throw Failure(LENSPROF_ERROR_READ,
                      path + ": unknown version '" + short_name(number) + "' of tracks; write version 2");
    return number[0] - '0';
}

struct Tracks {
    Reconstruction found;
    std::unordered_map<std::string, uint32_t> image_of, point_of;
};

uint32_t number_of(const std::string &name, std::unordered_map<std::string, uint32_t> &numbers) {
    return numbers.emplace(name, static_cast<uint32_t>(numbers.size())).first->second;
}

std::array<uint8_t, 3> colour_of(FieldReader &fields) {
    std::array<uint8_t, 3> colour;
    for (uint8_t &channel : colour) {
        const double value = fields.number();
        if (value < 0.0 || value > 255.0) fields.fail("a colour is not in 0..255");
        channel = static_cast<uint8_t>(std::lround(value));
    }
    return colour;
}

void read_tracks(const std::string &path, Tracks &tracks) {
    const int version = version_of(path);
    FieldReader fields(path, '\t', kMaxTracksBytes);
    Reconstruction &found = tracks.found;
    bool is_first = read_head(path, std::strlen(kTracksHeader)) == kTracksHeader;
    while (fields.next_line()) {
        if (std::exchange(is_first, false) || !fields.has_more()) continue;
        TrackObservation observation;
        const std::string image = fields.text();
        observation.image = number_of(image, tracks.image_of);
        if (observation.image == found.images.size()) {
            if (found.images.size() == max_images) fields.fail("it has too many images");
            found.images.push_back({image, 0, false, {}});
        }
        observation.point = number_of(fields.text(), tracks.point_of);
        observation.feature = static_cast<uint32_t>(fields.integer<int32_t>());
        for (float &x : observation.xy) {
            x = static_cast<float>(fields.number());
            if (std::fabs(x) > 0.5001f) fields.fail("its position is outside the picture");
        }
        if (version > 0)
            observation.shape[0][0] = observation.shape[1][1] = std::max(0.0f, static_cast<float>(fields.number()));
        observation.colour = colour_of(fields);
        if (found.observations.size() == max_observations) fields.fail("it has too many observations");
        found.observations.push_back(observation);
    }
}

// The centre -R^T t, from the angle-axis vector of the world-to-camera rotation (Rodrigues).
void place(const SceneJson &shot, ReconstructionImage &image) {
    std::array<double, 3> v = vector_at(shot, "rotation");
    const std::array<double, 3> t = vector_at(shot, "translation");
    for (double &x : v) x = -x;
    const double angle = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]),
                 dot = v[0] * t[0] + v[1] * t[1] + v[2] * t[2];
    const double a = angle > 1e-12 ? std::sin(angle) / angle : 1.0,
                 b = angle > 1e-6 ? (1.0 - std::cos(angle)) / (angle * angle) : 0.5;
    for (size_t d = 0; d < 3; d++) {
        const size_t e = (d + 1) % 3, f = (d + 2) % 3;
        image.centre[d] = -(std::cos(angle) * t[d] + a * (v[e] * t[f] - v[f] * t[e]) + b * dot * v[d]);
    }
    image.has_centre = is_finite(image.centre);
}

void take_sizes(const SceneJson &model, std::map<std::string, uint32_t> &camera_of, Reconstruction &found) {
    for (const auto &[name, camera] : object_at(model, "cameras").items()) {
        const int64_t width = whole_at(camera, "width"), height = whole_at(camera, "height");
        if (width < 1 || height < 1 || width > max_image_side || height > max_image_side) continue;
        camera_of[name] = static_cast<uint32_t>(found.cameras.size());
        found.cameras.push_back({static_cast<uint32_t>(width), static_cast<uint32_t>(height)});
    }
}

// Centres and positions come from the model with most shots, because each model has its own coordinate system.
void take_models(const std::string &path, Tracks &tracks) {
    const SceneJson all = read_json_file(path);
    if (!all.is_array())
        throw Failure(LENSPROF_ERROR_READ,
                      path + ": not a list of reconstructions; give OpenSfM's reconstruction.json");
    std::map<std::string, uint32_t> camera_of;
    const SceneJson *largest = nullptr;
    for (const SceneJson &model : all) {
        take_sizes(model, camera_of, tracks.found);
        for (const auto &[name, shot] : object_at(model, "shots").items()) {
            const auto image = tracks.image_of.find(name);
            const auto camera = camera_of.find(text_at(shot, "camera"));
            if (image != tracks.image_of.end() && camera != camera_of.end())
                tracks.found.images[image->second].camera = camera->second;
        }
        if (!largest || object_at(model, "shots").size() > object_at(*largest, "shots").size()) largest = &model;
    }
    if (!largest) return;
    for (const auto &[name, shot] : object_at(*largest, "shots").items()) {
        const auto image = tracks.image_of.find(name);
        if (image != tracks.image_of.end()) place(shot, tracks.found.images[image->second]);
    }
    tracks.found.points.assign(tracks.point_of.size(), {NAN, NAN, NAN});
    for (const auto &[name, point] : object_at(*largest, "points").items()) {
        const auto known = tracks.point_of.find(name);
        if (known != tracks.point_of.end()) tracks.found.points[known->second] = vector_at(point, "coordinates");
    }
}

}  // namespace

bool is_opensfm_tracks(const std::string &path) {
    if (!is_regular_file(path)) return false;
    const std::string head = read_head(path, 4096);
    if (head.compare(0, std::strlen(kTracksHeader), kTracksHeader) == 0) return true;
    const std::string line = head.substr(0, head.find('\n'));  // version 0: shot, track, feature, x, y, r, g, b
    return path.size() > 4 && path.compare(path.size() - 4, 4, ".csv") == 0
           && std::count(line.begin(), line.end(), '\t') == 7;
}

Reconstruction read_opensfm(const std::string &path) {
    Tracks tracks;
    Reconstruction &found = tracks.found;
    found.kind = "OpenSfM tracks", found.path = path;
    found.coordinates = ImageCoordinates::upright_centred, found.has_colours = true;
    found.cameras.emplace_back();  // of images in no reconstruction
    read_tracks(path, tracks);
    const std::string model = (std::filesystem::path(path).parent_path() / "reconstruction.json").string();
    if (is_regular_file(model)) take_models(model, tracks);
    clean_tracks(found);
    sort_images(found);
    return std::move(tracks.found);
}

}  // namespace lensprof
