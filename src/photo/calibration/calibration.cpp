#include "photo/calibration/calibration.hpp"
#include "photo/pictures/picture_levels.hpp"
#include "photo/scene/scene_pictures.hpp"

#include <cmath>

namespace lensprof {
namespace {

constexpr uint32_t all_flags = LENSPROF_FREE_LENS | LENSPROF_FREE_IMAGE;

// The free parameters: as requested, else by the v lines of a project; all if these have nothing photometric, as in a
// project that was only aligned.
void choose_unknowns(uint32_t requested, Scene &scene, Events &events) {
    uint32_t free = requested, free_in_scene = 0;
    for (const auto &image : scene.images) free_in_scene |= image.free;
    if (!free && !free_in_scene) {
        events.note(scene.path, "no photometric v lines; estimating response, falloff, exposures and white balances"
                                    + advice("free_parameters"));
        free = all_flags;
    }
    for (auto &image : scene.images) image.free = free ? free : image.free;
}

// Reconstructions from film are rare. Sensors of phones are small.
CameraKind kind_of_reconstruction(const lensprof_profile_key &key) {
    constexpr double min_phone_crop_factor = 4.5;
    const bool is_phone = key.crop_factor != LENSPROF_UNKNOWN && key.crop_factor >= min_phone_crop_factor;
    return {is_phone ? LENSPROF_CAMERA_PHONE : LENSPROF_CAMERA_STILL, KindFrom::reconstruction};
}

CameraKind kind_of(const FitOptions &o, const Scene &scene, const lensprof_profile_key &key,
                   const PictureMetadata &metadata) {
    const CameraKind kind = camera_kind_of(o, key, metadata);
    return scene.is_reconstruction && kind.from == KindFrom::none ? kind_of_reconstruction(key) : kind;
}

}  // namespace

Calibration::Calibration(Scene of, const SceneFitOptions &o, Events &events)
    : options(o), scene(std::move(of)), fit(events) {
    if (scene.document == nullptr && scene.lenses.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, scene.path + ": has exposures, but nothing to fit them to; it is used "
                                                              "to correct pictures");
    if (scene.images.size() < 2)
        throw Failure(LENSPROF_ERROR_NOT_USABLE, scene.path + ": has only one image; give at least two that overlap",
                      LENSPROF_REASON_FEW_PAIRS);
    choose_unknowns(o.free, scene, events);
    if (o.points.empty() && !scene.is_reconstruction) check_pictures(scene, o.pixels.max_side);
    metadata = picture_metadata(o, scene);
    scene.levels = scene_levels(o, scene, metadata);
    if (has_levels(scene.levels) && !scene.is_reconstruction) check_pictures(scene, o.pixels.max_side);  // as floats
    key = profile_key(o, scene, metadata, events);
    check_store(o.store);
    if (uses_stored_prior(o.fit))
        prior = find_stored_prior(o.store, o.fit.stored_id, o.fit.stored_is_requested, key, scene.path);
    fit.report.camera_kind = kind_of(o.fit, scene, key, metadata[scene.reference]);
    fit_scene(o, scene, metadata, prior, fit, events);
}

Scene with_result(const Calibration &calibration) {
    Scene scene = calibration.scene;
    const Fitted &best = calibration.fit.best;
    scene.reference = best.reference;
    scene.models.clear();
    for (uint32_t i = 0; i < scene.images.size(); i++) {
        scene.images[i].left_out = std::isnan(best.exposures[i].ev);
        scene.images[i].exposure = best.exposures[i];
        auto model = std::shared_ptr<lensprof_profile>(new_profile());
        const auto falloffs = best.falloff_of(i);
        model->levels = scene.levels;
        model->response[0] = best.response_of(i);
        model->vignettings = best.falloff_curves_of(i);
        std::copy_n(falloffs.begin(), falloffs.size(), model->vignetting);
        scene.models.push_back(model);
    }
    return scene;
}

}  // namespace lensprof
