#include "photo/scene/scene_pictures.hpp"

#include <algorithm>
#include <cmath>

#include "photo/base/format.hpp"
#include "photo/base/parallel.hpp"
#include "photo/pictures/picture_levels.hpp"
#include "photo/system/system.hpp"

namespace lensprof {
namespace {

// Failure if the frame of a picture differs from that of the project.
void check_size(const Scene &scene, uint32_t i, const Picture &header) {
    const auto &camera = scene.images[i].camera;
    if (header.frame_width == camera.width && header.frame_height == camera.height) return;
    throw Failure(
        LENSPROF_ERROR_READ,
        scene.files[i] + format(": is %u x %u pixels, but ", header.frame_width, header.frame_height) + scene.path
            + format(" states %u x %u; use the pictures that the project was made with", camera.width, camera.height));
}

// The available memory: scene_max_bytes, or less if the machine or its process limit (ulimit -v) has less.
uint64_t available_memory() {
    const uint64_t bytes = system::available_memory_bytes();
    return bytes > 0 ? std::min(scene_max_bytes, bytes) : scene_max_bytes;
}

}  // namespace

void check_finite(const lensprof_image &rows, uint32_t first_row, uint32_t reduction, const std::string &file) {
    if (rows.sample != LENSPROF_SAMPLE_F32) return;
    uint32_t samples = lensprof_layout_samples(rows.layout);
    for (uint32_t y = 0; y < rows.height; y++) {
        const auto *row = reinterpret_cast<const float *>(static_cast<const uint8_t *>(rows.data)
                                                          + static_cast<ptrdiff_t>(y) * rows.row_bytes);
        for (uint32_t s = 0; s < rows.width * samples; s++)
            if (!std::isfinite(row[s]))
                throw Failure(LENSPROF_ERROR_READ, file + ": pixel " + std::to_string(s / samples * reduction) + ", "
                                                       + std::to_string((first_row + y) * reduction)
                                                       + " is not a finite number; repair the picture");
    }
}

uint64_t bytes_in_memory(const Scene &scene, const Picture &header) {
    const uint64_t row_samples = uint64_t(header.width) * lensprof_layout_samples(header.layout);
    return header.height * (has_levels(scene.levels) ? row_samples * sizeof(float) : header.row_bytes);
}

void check_pictures(const Scene &scene, uint32_t max_side, uint32_t in_memory) {
    ReadOptions options;
    options.max_side = max_side;
    uint64_t needed = 0;
    for (uint32_t i = 0; i < scene.files.size(); i++) {
        stop_if_cancelled();
        const Picture header = read_header(scene.files[i], options);
        check_size(scene, i, header);
        if (i >= in_memory) continue;
        needed += bytes_in_memory(scene, header);
        if (scene.document) needed += uint64_t(header.width) * header.height;  // its mask
    }
    const uint64_t bound = available_memory();
    if (needed > bound)
        throw Failure(LENSPROF_ERROR_READ,
                      scene.path
                          + format(": its %zu pictures need %.1f GiB of memory, but at most %.1f are available; give "
                                   "a smaller %s or fewer pictures",
                                   scene.files.size(), double(needed) / (1 << 30), double(bound) / (1 << 30),
                                   option_name("max_side").c_str()));
}

SamplePicture read_sample_picture(const Scene &scene, uint32_t i, uint32_t max_side) {
    const std::string &file = scene.files[i];
    SamplePicture result;
    ReadOptions options;
    options.max_side = max_side;
    result.picture = read_picture(file, options);
    const Picture &p = result.picture;
    check_size(scene, i, p);
    check_finite(result.picture.view(), 0, p.reduction, file);
    for (uint32_t c = 0; c < lensprof_layout_channels(p.layout) && has_levels(scene.levels); c++)
        require_black_below(p, c, scene.levels, file, option_name("black_level"));
    if (has_levels(scene.levels)) remove_levels(scene.levels, result.picture);
    result.mask = mask_of(scene, i, p.width, p.height);
    return result;
}

std::vector<SamplePicture> read_pictures(const Scene &scene, uint32_t max_side, Events &progress) {
    std::vector<SamplePicture> pictures(scene.files.size());
    for_each_parallel(static_cast<uint32_t>(pictures.size()), "reading pictures", progress,
                      [&](uint32_t i) { pictures[i] = read_sample_picture(scene, i, max_side); });
    return pictures;
}

std::vector<uint8_t> mask_of(const Scene &scene, uint32_t image, uint32_t width, uint32_t height) {
    if (!scene.document) return {};
    std::vector<uint8_t> mask(size_t(width) * height);
    lensprof_error error{};
    check(lensprof_pto_draw_mask(scene.document.get(), image, mask.data(), width, height, static_cast<ptrdiff_t>(width),
                                 &error),
          scene.files[image], &error);
    if (std::find(mask.begin(), mask.end(), 0) == mask.end()) mask.clear();
    return mask;
}

uint32_t channel_count(const std::vector<SamplePicture> &pictures) {
    for (const auto &p : pictures)
        if (lensprof_layout_channels(p.picture.layout) == 3) return 3;
    return 1;
}

}  // namespace lensprof
