#include "photo/scene/point_file.hpp"

#include <cstring>

#include "photo/base/file_kind.hpp"
#include "photo/base/format.hpp"
#include "photo/base/input_file.hpp"

namespace lensprof {
namespace {

// `number`: 1-based index of the point in its file.
void check_point(const std::string &path, const Scene &scene, const lensprof_pair &pair, int side, size_t number) {
    const uint32_t image = pair.image[side];
    if (image >= scene.images.size())
        throw Failure(LENSPROF_ERROR_READ, path + ": refers to image " + std::to_string(image) + ", but " + scene.path
                                               + " has images 0 to " + std::to_string(scene.images.size() - 1)
                                               + "; give the points of this project");
    const auto &camera = scene.images[image].camera;
    const double *xy = pair.xy[side];
    if (!(xy[0] >= -1.0 && xy[1] >= -1.0 && xy[0] <= camera.width && xy[1] <= camera.height))
        throw Failure(LENSPROF_ERROR_READ, path + ": point " + std::to_string(number) + " is outside "
                                               + scene.names[image] + "; give the points of this project");
}

// Point files may have gigabytes: other files are refused by their first lines.
void check_first_points(const std::string &path) {
    constexpr size_t max_head_bytes = 1 << 16;
    const std::string head = read_head(path, max_head_bytes);
    refuse_other_kind(path);
    const size_t end = head.size() < max_head_bytes ? head.size() : head.rfind('\n') + 1;  // 0 without a line end
    if (end == 0 && !head.empty())
        throw Failure(LENSPROF_ERROR_READ, path + ": line 1 is too long for a point file; check the file name");
    lensprof_error error{};
    uint32_t found = 0;
    check(lensprof_points_read(head.data(), end, nullptr, 0, &found, &error), path, &error);
}

}  // namespace

std::vector<lensprof_pair> read_points(const std::string &path, const Scene &scene) {
    // The maximum number of pairs of --fit pairs, with 17 digits.
    constexpr uint64_t max_points_bytes = uint64_t(1 << 24) * 256;
    check_first_points(path);
    std::string text = read_text(path, max_points_bytes);
    lensprof_error error{};
    uint32_t found = 0;
    check(lensprof_points_read(text.data(), text.size(), nullptr, 0, &found, &error), path, &error);
    std::vector<lensprof_pair> pairs(found);
    if (found == 0) throw Failure(LENSPROF_ERROR_READ, path + ": has no points; give a point file of this project");
    check(lensprof_points_read(text.data(), text.size(), pairs.data(), found, &found, &error), path, &error);
    for (size_t p = 0; p < pairs.size(); p++)
        for (int side = 0; side < 2; side++) check_point(path, scene, pairs[p], side, p + 1);
    move_places(scene, 1.0, pairs);
    return pairs;
}

std::string points_text(std::vector<lensprof_pair> pairs, const Scene &scene) {
    move_places(scene, -1.0, pairs);
    std::vector<lensprof_camera> cameras;
    for (const auto &image : scene.images) cameras.push_back(image.camera);
    return written("points", [&](void *text, size_t capacity, size_t *count, lensprof_error *error) {
        return lensprof_points_write(pairs.data(), static_cast<uint32_t>(pairs.size()), cameras.data(),
                                     static_cast<uint32_t>(cameras.size()), text, capacity, count, error);
    });
}

}  // namespace lensprof
