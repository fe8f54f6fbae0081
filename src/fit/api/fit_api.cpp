// The C interface of the overlap fit: its functions, and conversion of exceptions to status codes.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <new>
#include <vector>

#include "fit/api/boundary.hpp"
#include "fit/api/fit_call.hpp"
#include "fit/api/fit_checks.hpp"
#include "fit/api/fit_handle.hpp"
#include "fit/api/fit_methods.hpp"
#include "fit/api/held.hpp"
#include "fit/base/sized.hpp"
#include "fit/methods/cameras.hpp"
#include "fit/methods/overlap.hpp"
#include "fit/problem/tracks.hpp"
#include "fit/scene/scene.hpp"

using namespace lensprof;

namespace {

// What the caller receives.
struct Target {
    Place place;
    lensprof_exposure *exposures;
    lensprof_fit **fit;
};

// Runs a fit, and gives the exposures and the fit to the caller.
template <class Fit>
lensprof_status run(FitCall &call, const Target &target, lensprof_error *error, Fit fit) {
    if (!has_unknowns(call.options, call.images.data(), call.count()))
        return fail(LENSPROF_ERROR_NO_UNKNOWNS, error, "fit: every parameter is fixed; free at least one");
    const auto began = std::chrono::steady_clock::now();
    std::vector<lensprof_exposure> found(target.exposures, target.exposures + call.count());
    const lensprof_status status = fit(found.data());
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - began;
    if (status != LENSPROF_OK) return status;
    call.result.seconds = taken.count();
    void *memory = target.place.memory ? target.place.memory : ::operator new(fit_bytes(call.images));
    *target.fit = make_fit(call, found.data(), memory, !target.place.memory);
    std::copy(found.begin(), found.end(), target.exposures);
    return LENSPROF_OK;
}

// Fits pairs of one camera or several.
lensprof_status fit_given(FitCall &call, const lensprof_pair *pairs, uint32_t count, lensprof_exposure *found,
                          lensprof_error *error) {
    return has_several_cameras(call.options, call.images)
               ? fit_each_camera(call, {call.options, call.images, {pairs, pairs + count}, {}}, found, error)
               : fit_pairs(call, pairs, count, found, error);
}

// The progress of the fits of a scene as that of one.
class SceneProgress {
public:
    explicit SceneProgress(lensprof_fit_options &options) : report_(options.progress), user_(options.progress_user) {
        if (report_) options.progress = &SceneProgress::on_progress, options.progress_user = this;
    }
    SceneProgress(const SceneProgress &) = delete;
    SceneProgress &operator=(const SceneProgress &) = delete;

    void next_fit() { done_++; }

private:
    static constexpr int kMostFits = 10;  // all pairs, exposures alone, six rounds without glossy points, two halves

    static int on_progress(double done, void *user) {
        const auto *self = static_cast<const SceneProgress *>(user);
        return self->report_((self->done_ + done) / kMostFits, self->user_);
    }

    const lensprof_progress report_;
    void *const user_;
    int done_ = 0;
};

// Fits pairs of known scene points.
lensprof_status fit_points(FitCall &call, const lensprof_pair *pairs, uint32_t count, lensprof_exposure *found,
                           lensprof_error *error) {
    const lensprof_fit_options &o = call.options;
    SceneData data{{pairs, pairs + count}, {o.points, o.points + count}, {}};
    if (o.view_distances) data.distances.assign(o.view_distances, o.view_distances + count);
    SceneProgress progress(call.options);
    const lensprof_status status = fit_given(call, pairs, count, found, error);
    if (status != LENSPROF_OK) return status;
    const auto fit = [&](FitCall &next, const std::vector<lensprof_pair> &some, lensprof_exposure *exposures) {
        progress.next_fit();
        return !some.empty() && has_unknowns(next.options, next.images.data(), next.count())
               && fit_given(next, some.data(), static_cast<uint32_t>(some.size()), exposures, nullptr) == LENSPROF_OK;
    };
    fit_scene(data, fit, call, found);
    return LENSPROF_OK;
}

}  // namespace

extern "C" {

void lensprof_fit_image_init_sized(lensprof_fit_image *image, size_t size, uint32_t index, uint32_t width,
                                   uint32_t height) {
    if (!lp_sized_begin(image, size, kFirstImage)) return;
    image->width = width;
    image->height = height;
    image->free = LENSPROF_FREE_IMAGE;
    image->ev_of = image->red_of = image->blue_of = index;
    lensprof_exposure_init(&image->exposure);
}

void lensprof_fit_options_init_sized(lensprof_fit_options *options, size_t size) {
    if (!lp_sized_begin(options, size, kFirstOptions)) return;
    options->channels = 3;
    options->free = LENSPROF_FREE_LENS;
    options->modes = LENSPROF_MODES_AUTO;
    options->huber_levels = 5.0;
    options->prior_weight = 1.0;
    options->max_iterations = 200;
}

lensprof_status lensprof_fit_overlap(const lensprof_fit_options *options, const lensprof_fit_image *images,
                                     uint32_t image_count, const lensprof_pair *pairs, uint32_t pair_count,
                                     void *memory, size_t size, lensprof_exposure *exposures, lensprof_fit **held,
                                     lensprof_error *error) {
    return at_boundary("fit", error, [&] {
        const auto call = std::make_unique<FitCall>();
        lensprof_status status =
            take_call(options, images, image_count, held && (pairs || pair_count == 0), exposures, *call, error);
        const Target target{{memory, size}, exposures, held};
        if (status == LENSPROF_OK) status = check_place(target.place, fit_bytes(call->images), "fit", error);
        if (status == LENSPROF_OK)
            status = check_pairs(pairs, pair_count, call->images.data(), image_count, call->channels(), error);
        if (status == LENSPROF_OK) status = check_scene(call->options, pair_count, error);
        if (status != LENSPROF_OK) return status;
        if (pair_count == 0) return fail(LENSPROF_ERROR_NO_SAMPLES, error, "fit: no pairs were given");
        return run(*call, target, error, [&](lensprof_exposure *found) {
            return (call->options.points ? fit_points : fit_given)(*call, pairs, pair_count, found, error);
        });
    });
}

lensprof_status lensprof_fit_radiance(const lensprof_fit_options *options, const lensprof_fit_image *images,
                                      uint32_t image_count, const lensprof_observation *observations,
                                      uint32_t observation_count, void *memory, size_t size,
                                      lensprof_exposure *exposures, lensprof_fit **held, lensprof_error *error) {
    return at_boundary("fit", error, [&] {
        const auto call = std::make_unique<FitCall>();
        lensprof_status status = take_call(options, images, image_count,
                                           held && (observations || observation_count == 0), exposures, *call, error);
        const Target target{{memory, size}, exposures, held};
        if (status == LENSPROF_OK) status = check_place(target.place, fit_bytes(call->images), "fit", error);
        if (status == LENSPROF_OK && call->options.method != LENSPROF_METHOD_RADIANCE)
            return fail(LENSPROF_ERROR_UNSUPPORTED, error, "fit options: tracks require the method radiance");
        if (status == LENSPROF_OK && call->options.points)
            return fail(LENSPROF_ERROR_UNSUPPORTED, error, "fit options: points are those of pairs, not of tracks");
        if (status == LENSPROF_OK)
            status = check_observations(observations, observation_count, call->images.data(), image_count,
                                        call->channels(), error);
        if (status != LENSPROF_OK) return status;
        if (observation_count == 0) return fail(LENSPROF_ERROR_NO_SAMPLES, error, "fit: no observations were given");
        return run(*call, target, error, [&](lensprof_exposure *found) {
            if (!has_several_cameras(call->options, call->images))
                return fit_tracks(*call, observations, observation_count, found, error);
            const Tracks tracks = tracks_of(observations, observation_count);
            status = check_tracks(tracks, error);
            if (status != LENSPROF_OK) return status;
            return fit_each_camera(*call,
                                   {call->options,
                                    call->images,
                                    pairs_of(tracks, call->channels()),
                                    {observations, observations + observation_count}},
                                   found, error);
        });
    });
}

}  // extern "C"
