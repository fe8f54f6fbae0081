#include "photo/calibration/still_fit.hpp"

#include "photo/calibration/known_exposures.hpp"
#include "photo/scene/static_camera.hpp"

namespace lensprof {

Fitted fit_still(const Scene &scene, const FitOptions &options, const SamplingOptions &pixels, Events &events,
                 std::vector<SamplePicture> *pictures) {
    FitInput input;
    input.options = fit_options(options);
    input.options.free &= scene.images[0].free;
    input.options.reference = scene.reference;
    std::vector<SamplePicture> read = read_pictures(scene, pixels.max_side, events);
    input.options.channels = channel_count(read);
    lensprof_sample_options sampling;
    lensprof_sample_options_init(&sampling);
    sampling.pairs = pixels.pairs, sampling.seed = pixels.seed;
    input.pairs = sample_still(scene, read, sampling, 0.0, events);
    input.options.refine = options.modes == LENSPROF_MODES_AUTO;
    input.images = fit_images(scene);
    std::vector<PictureMetadata> metadata;
    for (const std::string &file : scene.files) metadata.push_back(read_metadata(file));
    add_known_exposures(options, scene, metadata, input.images, events);
    if (pictures) *pictures = std::move(read);
    return fit(input, scene.reference, scene.files[0], events, nullptr);
}

}  // namespace lensprof
