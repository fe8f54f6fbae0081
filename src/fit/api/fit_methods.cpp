#include "fit/api/fit_methods.hpp"

#include <algorithm>
#include <iterator>

#include "fit/api/fit_checks.hpp"
#include "fit/methods/group.hpp"
#include "fit/methods/overlap.hpp"
#include "fit/methods/transfer_function/transfer_function.hpp"
#include "fit/problem/tracks.hpp"

namespace lensprof {

bool has_unknowns(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t count) {
    Problem problem = make_problem(options, images, count, nullptr, {});
    return problem.image_unknowns > 0 || !free_columns(problem, options.modes == 0 ? 0 : 1).empty();
}

lensprof_status fit_tracks(FitCall &call, const lensprof_observation *observations, uint32_t count,
                           lensprof_exposure *exposures, lensprof_error *error) {
    Tracks tracks = tracks_of(observations, count);
    lensprof_status status = check_tracks(tracks, error);
    if (status != LENSPROF_OK) return status;
    const auto within = [&](const Group &group) {
        return tracks_within(tracks, [&](uint32_t i, uint32_t j) { return group.holds(i, j); });
    };
    if (pairs_of(tracks, call.channels()).empty())
        return fail(LENSPROF_ERROR_NO_SAMPLES, error,
                    "fit: no point has two observations that are neither black nor saturated");
    const auto fit = [&](const lensprof_fit_options &options, const Group &group, lensprof_exposure *found,
                         FitResult &result) {
        fit_radiance(options, call.images.data(), call.count(), within(group), found, result);
    };
    const auto pairs_within = [&](const Group &group) { return pairs_of(within(group), call.channels()); };
    fit_largest_group(call.options, call.images.data(), call.count(), pairs_within, fit, exposures, call.result);
    return LENSPROF_OK;
}

namespace {

// Fits the largest group of images that agree, with a method of pairs.
template <class Method>
void fit_group(FitCall &call, const lensprof_pair *pairs, uint32_t count, lensprof_exposure *exposures, Method method) {
    const auto pairs_within = [&](const Group &group) {
        std::vector<lensprof_pair> group_pairs;
        std::copy_if(pairs, pairs + count, std::back_inserter(group_pairs),
                     [&](const lensprof_pair &pair) { return group.holds(pair.image[0], pair.image[1]); });
        return group_pairs;
    };
    const auto fit = [&](const lensprof_fit_options &options, const Group &group, lensprof_exposure *found,
                         FitResult &result) {
        const std::vector<lensprof_pair> group_pairs = pairs_within(group);
        method(options, call.images.data(), call.count(), group_pairs.data(), static_cast<uint32_t>(group_pairs.size()),
               found, result);
    };
    fit_largest_group(call.options, call.images.data(), call.count(), pairs_within, fit, exposures, call.result);
}

}  // namespace

lensprof_status fit_pairs(FitCall &call, const lensprof_pair *pairs, uint32_t count, lensprof_exposure *exposures,
                          lensprof_error *error) {
    if (call.options.method == LENSPROF_METHOD_RADIANCE) {
        std::vector<lensprof_observation> observations = observations_of(pairs, count, call.channels());
        return fit_tracks(call, observations.data(), static_cast<uint32_t>(observations.size()), exposures, error);
    }
    if (call.options.method == LENSPROF_METHOD_TRANSFER)
        fit_group(call, pairs, count, exposures, fit_overlap);
    else
        fit_group(call, pairs, count, exposures, fit_transfer_functions);
    return LENSPROF_OK;
}

namespace {

// Fits one camera of several, using only its images.
bool fit_camera(const CameraInput &input, lensprof_exposure *exposures, FitResult &result) {
    if (!has_unknowns(input.options, input.images.data(), static_cast<uint32_t>(input.images.size()))) return false;
    FitCall call;
    call.options = input.options;
    call.images = input.images;
    call.result = result;
    const auto pairs = static_cast<uint32_t>(input.pairs.size()),
               observations = static_cast<uint32_t>(input.observations.size());
    const lensprof_status status = observations
                                       ? fit_tracks(call, input.observations.data(), observations, exposures, nullptr)
                                       : fit_pairs(call, input.pairs.data(), pairs, exposures, nullptr);
    result = call.result;
    return status == LENSPROF_OK;
}

}  // namespace

lensprof_status fit_each_camera(FitCall &call, const CamerasData &data, lensprof_exposure *exposures,
                                lensprof_error *error) {
    if (fit_cameras(data, fit_camera, exposures, call.result)) return LENSPROF_OK;
    return fail(
        LENSPROF_ERROR_NO_SAMPLES, error,
        "fit: no pair connects two images of the same camera; give more images of it, or treat all as one camera");
}

const char *name_of_method(uint32_t method) {
    switch (method) {
    case LENSPROF_METHOD_TRANSFER: return "transfer";
    case LENSPROF_METHOD_RADIANCE: return "radiance";
    case LENSPROF_METHOD_TRANSFER_FUNCTION: return "transfer-function";
    default: return "";
    }
}

}  // namespace lensprof
