#include "photo/calibration/sequence_fit.hpp"

#include "photo/calibration/known_exposures.hpp"
#include "photo/scene/sampling.hpp"
#include "photo/scene/static_camera.hpp"

namespace lensprof {

Fitted fit_sequence(const Scene &scene, const FitOptions &options, const SamplingOptions &pixels, Events &events,
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
    std::vector<lensprof_link> links;
    input.pairs = scene.document ? sample_pairs(scene, read, sampling, {}, events, &links)
                                 : sample_still(scene, read, sampling, 0.0, events);
    input.options.links = links.data();
    input.options.link_count = static_cast<uint32_t>(links.size());
    input.options.refine = !scene.document && options.modes == LENSPROF_MODES_AUTO;
    input.images = fit_images(scene);
    std::vector<PictureMetadata> metadata;
    for (const std::string &file : scene.files) metadata.push_back(read_metadata(file));
    add_known_exposures(options, scene, metadata, input.images, events);
    if (pictures) *pictures = std::move(read);
    return fit(input, scene.reference, scene.path, events, nullptr);
}

}  // namespace lensprof
