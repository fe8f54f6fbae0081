// COLMAP's sparse model: cameras, images and points3D, binary or text. Rigs and frames of newer versions are not read:
// images.bin still has the pose of every image.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <unordered_map>

#include "photo/base/failure.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/reconstruction/field_reader.hpp"
#include "photo/reconstruction/readers.hpp"

namespace lensprof {
namespace {

constexpr uint64_t kMaxModelBytes = uint64_t(4) << 30;
// Number of parameters of the camera models 0, 1, 2, ... (COLMAP, src/colmap/sensor/models.h).
constexpr int kParameters[] = {3, 4, 4, 5, 8, 8, 12, 5, 4, 5, 12, 16, 4, 5, 3, 4, 6, 2};

[[noreturn]] void fail_model(const std::string &file, const std::string &problem) {
    throw Failure(LENSPROF_ERROR_READ, file + ": " + problem + "; give an intact COLMAP model");
}

// Reads numbers of a little-endian binary file.
class Bytes {
public:
    explicit Bytes(const std::string &file) : file_(file), content_(read_text(file, kMaxModelBytes)) {}

    template <class Number>
    Number next() {
        Number number;
        std::memcpy(&number, take(sizeof number), sizeof number);
        return number;
    }
    std::string next_text() {
        const size_t end = content_.find('\0', offset_);
        if (end == std::string::npos) fail_model(file_, "is truncated");
        const std::string text = content_.substr(offset_, end - offset_);
        offset_ = end + 1;
        return text;
    }
    // Reads the number of following items, of at least `bytes_each`.
    uint64_t next_count(uint64_t bytes_each) {
        const auto count = next<uint64_t>();
        if (count > (content_.size() - offset_) / bytes_each)
            fail_model(file_, "declares " + std::to_string(count) + " items, but is too short for them");
        return count;
    }
    const char *take(size_t bytes) {
        if (bytes > content_.size() - offset_) fail_model(file_, "is truncated");
        offset_ += bytes;
        return content_.data() + offset_ - bytes;
    }
    void demand_end() const {
        if (offset_ != content_.size()) fail_model(file_, "has more data than its counts declare");
    }

private:
    std::string file_, content_;
    size_t offset_ = 0;
};

struct PosedImage {
    ReconstructionImage image;
    std::vector<std::array<double, 2>> places;  // of its features
    uint32_t camera_id = 0;
};

struct Model {
    std::map<uint32_t, ReconstructionCamera> cameras;  // by their ids in the files
    std::map<uint32_t, PosedImage> images;
};

struct Sight {
    uint32_t image, feature;
};

ReconstructionCamera camera_of(const std::string &file, uint64_t width, uint64_t height) {
    if (width < 1 || height < 1 || width > uint64_t(max_image_side) || height > uint64_t(max_image_side))
        fail_model(file, "has a camera of " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
    return {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
}

// The centre -R^T t of the world-to-camera rotation and translation.
void place(const std::array<double, 4> &q, const std::array<double, 3> &t, ReconstructionImage &image) {
    const double w = q[0], n = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!std::isfinite(n) || n == 0.0) return;
    const std::array<double, 3> v = {-q[1] / n, -q[2] / n, -q[3] / n};  // of the inverse rotation
    const auto cross = [](const auto &a, const auto &b) {
        return std::array<double, 3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    auto cross1 = cross(v, t);
    for (int d = 0; d < 3; d++) cross1[d] += w / n * t[d];
    const auto cross2 = cross(v, cross1);
    for (int d = 0; d < 3; d++) image.centre[d] = -(t[d] + 2.0 * cross2[d]);
    image.has_centre = is_finite(image.centre);
}

void add_camera(const std::string &file, uint32_t id, const ReconstructionCamera &camera, Model &model) {
    if (!model.cameras.emplace(id, camera).second)
        fail_model(file, "has two cameras with the id " + std::to_string(id));
}

PosedImage &add_image(const std::string &file, uint32_t id, Model &model) {
    const auto [own, is_new] = model.images.emplace(id, PosedImage());
    if (!is_new) fail_model(file, "has two images with the id " + std::to_string(id));
    return own->second;
}

void read_binary_cameras(const std::string &file, Model &model) {
    Bytes bytes(file);
    for (uint64_t left = bytes.next_count(24); left > 0; left--) {
        const auto id = bytes.next<uint32_t>();
        const auto kind = bytes.next<int32_t>();
        const auto width = bytes.next<uint64_t>(), height = bytes.next<uint64_t>();
        if (kind < 0 || kind >= int32_t(std::size(kParameters)))
            fail_model(file, "has the unknown camera model " + std::to_string(kind));
        bytes.take(sizeof(double) * static_cast<size_t>(kParameters[kind]));
        add_camera(file, id, camera_of(file, width, height), model);
    }
    bytes.demand_end();
}

void read_binary_images(const std::string &file, Model &model) {
    Bytes bytes(file);
    for (uint64_t left = bytes.next_count(73); left > 0; left--) {
        const auto id = bytes.next<uint32_t>();
        std::array<double, 4> q;
        std::array<double, 3> t;
        for (double &x : q) x = bytes.next<double>();
        for (double &x : t) x = bytes.next<double>();
        PosedImage &image = add_image(file, id, model);
        image.camera_id = bytes.next<uint32_t>();
        image.image.name = bytes.next_text();
        place(q, t, image.image);
        image.places.resize(bytes.next_count(24));
        for (auto &xy : image.places) {
            for (double &x : xy) x = bytes.next<double>();
            bytes.next<uint64_t>();  // its point, also given by points3D
        }
    }
    bytes.demand_end();
}

// Calls add(position, sights) for every point.
template <class Add>
void read_binary_points(const std::string &file, const Add &add) {
    Bytes bytes(file);
    for (uint64_t left = bytes.next_count(51); left > 0; left--) {
        bytes.next<uint64_t>();  // its number
        std::array<double, 3> position;
        for (double &x : position) x = bytes.next<double>();
        bytes.take(3 + sizeof(double));  // colour, error
        std::vector<Sight> sights(bytes.next_count(8));
        for (Sight &sight : sights) sight = {bytes.next<uint32_t>(), bytes.next<uint32_t>()};
        add(position, sights);
    }
    bytes.demand_end();
}

void read_text_cameras(const std::string &file, Model &model) {
    FieldReader fields(file, '\0', kMaxModelBytes);
    while (fields.next_line_of_values()) {
        const auto id = fields.integer<uint32_t>();
        fields.text();  // the name of its model
        const auto width = fields.integer<uint64_t>(), height = fields.integer<uint64_t>();
        add_camera(file, id, camera_of(file, width, height), model);
    }
}

void read_text_images(const std::string &file, Model &model) {
    FieldReader fields(file, '\0', kMaxModelBytes);
    while (fields.next_line_of_values()) {
        const auto id = fields.integer<uint32_t>();
        std::array<double, 4> q;
        std::array<double, 3> t;
        for (double &x : q) x = fields.number();
        for (double &x : t) x = fields.number();
        PosedImage &image = add_image(file, id, model);
        image.camera_id = fields.integer<uint32_t>();
        image.image.name = fields.rest();
        place(q, t, image.image);
        if (!fields.next_line()) fields.fail("the line of its features is missing");  // which may be empty
        while (fields.has_more()) {
            const double x = fields.number(), y = fields.number();
            fields.text();  // its point, or -1
            image.places.push_back({x, y});
        }
    }
}

template <class Add>
void read_text_points(const std::string &file, const Add &add) {
    FieldReader fields(file, '\0', kMaxModelBytes);
    while (fields.next_line_of_values()) {
        fields.text();  // its number
        std::array<double, 3> position;
        for (double &x : position) x = fields.number();
        for (int n = 0; n < 3; n++) fields.number();  // colour
        fields.text();                                // error, which may be nan
        std::vector<Sight> sights;
        while (fields.has_more()) {
            const auto image = fields.integer<uint32_t>();
            sights.push_back({image, fields.integer<uint32_t>()});
        }
        add(position, sights);
    }
}

// "cameras" -> the path of cameras.bin or cameras.txt; empty if neither exists.
std::string model_file(const std::string &folder, const char *name) {
    for (const char *end : {".bin", ".txt"})
        if (is_regular_file(folder + "/" + name + end)) return folder + "/" + name + end;
    return {};
}

bool is_text(const std::string &file) { return file.back() == 't'; }

// The images in the order of their names.
void take_images(const Model &model, const std::string &file, Reconstruction &found,
                 std::unordered_map<uint32_t, uint32_t> &image_of) {
    std::map<uint32_t, uint32_t> camera_of;
    for (const auto &[id, camera] : model.cameras) {
        camera_of[id] = static_cast<uint32_t>(found.cameras.size());
        found.cameras.push_back(camera);
    }
    std::vector<uint32_t> order;
    for (const auto &entry : model.images) order.push_back(entry.first);
    std::sort(order.begin(), order.end(),
              [&](uint32_t a, uint32_t b) { return model.images.at(a).image.name < model.images.at(b).image.name; });
    for (const uint32_t id : order) {
        const PosedImage &image = model.images.at(id);
        if (!camera_of.count(image.camera_id))
            fail_model(file, image.image.name + " refers to a camera that does not exist");
        image_of[id] = static_cast<uint32_t>(found.images.size());
        found.images.push_back(image.image);
        found.images.back().camera = camera_of[image.camera_id];
    }
}

}  // namespace

bool is_colmap_model(const std::string &folder) {
    for (const char *name : {"cameras", "images", "points3D"})
        if (model_file(folder, name).empty()) return false;
    return true;
}

Reconstruction read_colmap_model(const std::string &folder) {
    const std::string cameras = model_file(folder, "cameras"), images = model_file(folder, "images"),
                      points = model_file(folder, "points3D");
    Model model;
    is_text(cameras) ? read_text_cameras(cameras, model) : read_binary_cameras(cameras, model);
    is_text(images) ? read_text_images(images, model) : read_binary_images(images, model);
    Reconstruction found;
    found.kind = "COLMAP model", found.path = folder;
    std::unordered_map<uint32_t, uint32_t> image_of;
    take_images(model, images, found, image_of);
    const auto add = [&](const std::array<double, 3> &position, const std::vector<Sight> &sights) {
        for (const Sight &sight : sights) {
            const auto image = model.images.find(sight.image);
            if (image == model.images.end() || sight.feature >= image->second.places.size())
                fail_model(points, "refers to feature " + std::to_string(sight.feature) + " of image "
                                       + std::to_string(sight.image) + ", which does not exist");
            if (found.observations.size() == max_observations) fail_model(points, "has too many observations");
            TrackObservation observation;
            observation.point = static_cast<uint32_t>(found.points.size());
            observation.image = image_of.at(sight.image), observation.feature = sight.feature;
            for (int d = 0; d < 2; d++)  // COLMAP: the centre of the first pixel is (.5, .5)
                observation.xy[d] = static_cast<float>(image->second.places[sight.feature][d] - 0.5);
            found.observations.push_back(observation);
        }
        found.points.push_back(position);
    };
    is_text(points) ? read_text_points(points, add) : read_binary_points(points, add);
    clean_tracks(found);
    return found;
}

}  // namespace lensprof
