#include "photo/scene/static_camera.hpp"

#include <algorithm>
#include <set>

#include "photo/base/file_kind.hpp"
#include "photo/base/paths.hpp"
#include "photo/scene/sampling.hpp"
#include "photo/scene/scene_pictures.hpp"

namespace lensprof {
namespace {

// JPEG rings at edges: in a block (16 px with subsampled colours) with white pixels, values near white are artefacts of
// white. Such blocks are masked.
void mask_ringing(SamplePicture &sample) {
    constexpr uint32_t block_px = 16;
    const Picture &picture = sample.picture;
    if (sample.mask.empty()) sample.mask.assign(static_cast<size_t>(picture.width) * picture.height, 1);
    const uint32_t side = std::max(1u, block_px / picture.reduction), samples = lensprof_layout_samples(picture.layout);
    for (uint32_t top = 0; top < picture.height; top += side)
        for (uint32_t left = 0; left < picture.width; left += side) {
            const uint32_t bottom = std::min(top + side, picture.height), right = std::min(left + side, picture.width);
            bool has_white = false;
            for (uint32_t y = top; y < bottom && !has_white; y++) {
                const uint8_t *row = picture.pixels.data() + y * picture.row_bytes;
                has_white =
                    std::any_of(row + left * samples, row + right * samples, [](uint8_t v) { return v == 255; });
            }
            for (uint32_t y = top; y < bottom && has_white; y++)
                std::fill_n(sample.mask.begin() + static_cast<std::ptrdiff_t>(y * picture.width + left), right - left,
                            0);
        }
}

lensprof_pto_image still_image(PictureSize size, uint32_t number, uint32_t free) {
    lensprof_pto_image image;
    lensprof_pto_image_init(&image);
    image.camera = camera_of_size(size.width, size.height);
    lensprof_exposure_init(&image.exposure);
    image.free = free;
    image.ev_of = image.red_of = image.blue_of = number;
    return image;
}

}  // namespace

Scene static_scene(const std::vector<std::string> &files, bool free_balance) {
    for (const std::string &file : files) {
        if (is_folder(file))
            throw Failure(LENSPROF_ERROR_READ, file + ": cannot read: it is a folder; give its pictures");
        if (!path_exists(file)) throw Failure(LENSPROF_ERROR_READ, file + ": cannot be opened: no such file or folder");
        refuse_other_kind(file);
    }
    if (files.size() < 2)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "one picture shows no difference in exposure; give at least two of the same scene");
    Scene scene;
    scene.path = files[0];
    scene.names = scene.files = files;
    const uint32_t balance = free_balance ? LENSPROF_FREE_RED | LENSPROF_FREE_BLUE : 0;
    std::set<std::string> seen;
    for (uint32_t i = 0; i < files.size(); i++) {
        if (!seen.insert(file_identity(files[i])).second)
            throw Failure(LENSPROF_ERROR_ARGUMENT, files[i] + ": given twice; give it once");
        PictureSize size = read_size(files[i]);
        scene.images.push_back(still_image(size, i, LENSPROF_FREE_RESPONSE | LENSPROF_FREE_EV | balance));
        const auto &first = scene.images[0].camera;
        if (size.width != first.width || size.height != first.height)
            throw Failure(LENSPROF_ERROR_READ, files[i] + ": is " + std::to_string(size.width) + " x "
                                                   + std::to_string(size.height) + " pixels, but " + files[0] + " is "
                                                   + std::to_string(first.width) + " x " + std::to_string(first.height)
                                                   + "; give pictures of one camera that did not move");
    }
    return scene;
}

std::vector<lensprof_pair> sample_still(const Scene &scene, std::vector<SamplePicture> &pictures,
                                        lensprof_sample_options options, double black, Events &progress) {
    constexpr double black_margin = 0.6, max_level = 254.4, max_jpeg_level = 250.5;  // levels of 255
    constexpr uint32_t pairs_per_picture = 10000;
    options.sampling = LENSPROF_SAMPLING_BRACKET;
    if (!options.pairs) options.pairs = pairs_per_picture * static_cast<uint32_t>(pictures.size());
    bool any_jpeg = false;
    for (SamplePicture &sample : pictures) {
        if (!sample.picture.traits.is_lossy || sample.picture.sample != LENSPROF_SAMPLE_U8) continue;
        mask_ringing(sample);
        any_jpeg = true;
    }
    const GreyRange range{(black + black_margin) / 255.0, (any_jpeg ? max_jpeg_level : max_level) / 255.0, true};
    return sample_pairs(scene, pictures, options, range, progress, nullptr);
}

}  // namespace lensprof
