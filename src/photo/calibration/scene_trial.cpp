#include "photo/calibration/scene_trial.hpp"

#include <algorithm>

#include "photo/base/format.hpp"
#include "photo/base/library.hpp"
#include "photo/calibration/known_exposures.hpp"
#include "photo/calibration/lens_settings.hpp"
#include "photo/calibration/scene_fit.hpp"
#include "photo/scene/scene_pictures.hpp"

namespace lensprof {
namespace {

// `first` receives the image of the setting with most metadata.
std::vector<lensprof_pair> pairs_of_one_setting(const Scene &scene, const std::vector<PictureMetadata> &metadata,
                                                std::vector<lensprof_pair> pairs, uint32_t &first, Events &events) {
    const LensSettings settings = lens_settings(scene, metadata, {}, false);
    std::vector<size_t> count(settings.first.size());
    const auto setting_of = [&](const lensprof_pair &pair, int side) { return settings.of_image[pair.image[side]]; };
    const auto has_one_setting = [&](const lensprof_pair &pair) { return setting_of(pair, 0) == setting_of(pair, 1); };
    for (const lensprof_pair &pair : pairs)
        if (has_one_setting(pair)) count[setting_of(pair, 0)]++;
    const auto main_setting = static_cast<uint32_t>(std::max_element(count.begin(), count.end()) - count.begin());
    first = settings.first[main_setting];
    const auto is_portrait = [&](uint32_t i) { return scene.images[i].camera.height > scene.images[i].camera.width; };
    const auto is_like_first = [&](uint32_t i) {  // the centre of a profile is in one frame
        return settings.of_image[i] == main_setting && is_portrait(i) == is_portrait(first);
    };
    size_t other_pictures = 0;
    for (uint32_t i = 0; i < scene.images.size(); i++) other_pictures += !is_like_first(i);
    if (other_pictures)
        events.warn(scene.path, counted(other_pictures, "picture")
                                    + " of another camera, size or lens setting left out, since a profile describes one "
                                      "setting; using those of "
                                    + describe_setting(metadata[first].key, scene.names[first]));
    const auto is_other = [&](const lensprof_pair &p) {
        return !is_like_first(p.image[0]) || !is_like_first(p.image[1]);
    };
    pairs.erase(std::remove_if(pairs.begin(), pairs.end(), is_other), pairs.end());
    return pairs;
}

void warn_of_earlier_correction(const Scene &scene, const std::vector<PictureMetadata> &metadata, Events &events) {
    for (size_t i = 0; i < metadata.size(); i++)
        if (!metadata[i].corrected_by.empty())
            return events.warn(scene.names[i], "its falloff was corrected before, " + metadata[i].corrected_by
                                                   + "; only the remaining falloff is measured");
}

}  // namespace

SceneTrial::SceneTrial(const Scene &scene, bool are_linear, Events &events) : scene_(scene) {
    if (scene.images.size() < 2)
        throw Failure(LENSPROF_ERROR_NOT_USABLE, scene.path + ": has only one image; give at least two that overlap",
                      LENSPROF_REASON_FEW_PAIRS);
    const std::vector<PictureMetadata> metadata = picture_metadata({}, scene);
    const SceneFitOptions options;
    if (!scene.is_reconstruction) check_pictures(scene, options.pixels.max_side);
    DrawnPairs sampled = first_pairs(options, scene, events);
    events.clear();
    uint32_t first = 0;
    pairs_ = pairs_of_one_setting(scene, metadata, std::move(sampled.pairs), first, events);
    warn_of_earlier_correction(scene, metadata, events);
    key_ = metadata[first].key;
    file_ = first < scene.files.size() ? scene.files[first] : scene.path;
    lensprof_trial_options_init(&options_);
    options_.channels = sampled.channels;
    options_.camera_kind = are_linear && metadata[first].may_be_linear ? static_cast<uint32_t>(LENSPROF_CAMERA_LINEAR)
                                                                       : camera_kind_of({}, key_, metadata[first]).kind;
    images_ = fit_images(scene);
    WarningsAlone warnings(events);
    add_known_exposures(options.fit, scene, metadata, images_, warnings);
}

std::vector<lensprof_trial_candidate> SceneTrial::run(const std::vector<const lensprof_profile *> &profiles,
                                                      lensprof_trial_result *result) const {
    std::vector<lensprof_trial_candidate> candidates(profiles.size() + 1);
    for (lensprof_trial_candidate &candidate : candidates) lensprof_trial_candidate_init(&candidate);
    lensprof_trial_result own;
    lensprof_trial_result_init(&own);
    lensprof_error error{};
    const lensprof_status status =
        lensprof_trial_run(&options_, images_.data(), static_cast<uint32_t>(images_.size()), pairs_.data(),
                           static_cast<uint32_t>(pairs_.size()), profiles.data(),
                           static_cast<uint32_t>(profiles.size()), candidates.data(), result ? result : &own, &error);
    if (status == LENSPROF_ERROR_NO_SAMPLES)
        throw Failure(LENSPROF_ERROR_NOT_USABLE, scene_.path + ": " + error.text, LENSPROF_REASON_FEW_PAIRS);
    check(status, scene_.path, &error);
    return candidates;
}

}  // namespace lensprof
