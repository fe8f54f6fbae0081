// The C interface of the fit of renderings: argument checks, and conversion of exceptions to status codes.
#include <memory>

#include "fit/api/boundary.hpp"
#include "fit/api/held.hpp"
#include "fit/base/sized.hpp"
#include "fit/rendering/rules.hpp"

using namespace lensprof;

struct lensprof_rendering {
    RenderingFit fit;
};

namespace {

lensprof_status null_pointer(lensprof_error *error) {
    return fail(LENSPROF_ERROR_ARGUMENT, error, "rendering: a pointer is NULL");
}

// Checks that another shot can be added.
lensprof_status check_shot(const RenderingFit &fit, const lensprof_image &raw, const lensprof_image &rendered,
                           lensprof_error *error) {
    if (fit.shots.size() >= LENSPROF_RENDERING_SHOTS)
        return fail(LENSPROF_ERROR_ARGUMENT, error, "rendering: more than %d shots; a few suffice",
                    LENSPROF_RENDERING_SHOTS);
    for (const lensprof_image *image : {&raw, &rendered}) {
        const lensprof_status status = lensprof_image_validate(image);
        if (status != LENSPROF_OK)
            return fail(status, error, "rendering: the %s is invalid; see lensprof_image_validate",
                        image == &raw ? "raw frame" : "rendered picture");
    }
    return LENSPROF_OK;
}

}  // namespace

extern "C" {

lensprof_status lensprof_rendering_create(const lensprof_response *prior, lensprof_progress progress,
                                          void *progress_user, lensprof_rendering **rendering, lensprof_error *error) {
    return at_boundary("rendering", error, [&] {
        clear(error);
        if (!rendering) return null_pointer(error);
        auto made = std::make_unique<lensprof_rendering>();
        RenderingFit &fit = made->fit;
        fit.stop = {progress, progress_user};
        lensprof_rendering_result_init(&fit.result);
        const lensprof_status status =
            prior ? lensprof_response_validate(prior)
                  : lensprof_response_set_typical(&fit.prior, LENSPROF_CAMERA_STILL, nullptr, nullptr);
        if (status != LENSPROF_OK)
            return fail(status, error, "rendering: the given response is not monotone from 0 to 1");
        if (prior) fit.prior = *prior;
        *rendering = made.release();
        return LENSPROF_OK;
    });
}

void lensprof_rendering_destroy(lensprof_rendering *rendering) { delete rendering; }

lensprof_status lensprof_rendering_add(lensprof_rendering *rendering, const lensprof_image *raw,
                                       const lensprof_image *rendered, lensprof_error *error) {
    return at_boundary("rendering", error, [&] {
        clear(error);
        if (!rendering || !raw || !rendered) return null_pointer(error);
        RenderingFit &fit = rendering->fit;
        lensprof_status status = check_shot(fit, *raw, *rendered, error);
        RenderedShot shot;
        if (status == LENSPROF_OK)
            status = compare_pictures(*raw, *rendered, static_cast<uint32_t>(fit.shots.size()), fit.stop, shot, error);
        if (status != LENSPROF_OK) return status;
        if (!fit.shots.empty() && fit.shots[0].found.channels != shot.found.channels)
            return fail(LENSPROF_ERROR_ARGUMENT, error,
                        "rendering: one shot is in colour and another is grey; give shots of one kind");
        fit.shots.push_back(std::move(shot));
        return LENSPROF_OK;
    });
}

lensprof_status lensprof_rendering_fit(lensprof_rendering *rendering, lensprof_rendering_result *result,
                                       lensprof_error *error) {
    return at_boundary("rendering", error, [&] {
        clear(error);
        if (!rendering || !result) return null_pointer(error);
        RenderingFit &fit = rendering->fit;
        const lensprof_status status = fit_shots(fit, error);
        if (status != LENSPROF_OK) return status;
        fit.result.findings = count_findings(fit.verdict);
        fit.result.passed = count_passed(fit.verdict);
        return give(fit.result, result, LP_END_OF(lensprof_rendering_result, reserved), "rendering", error);
    });
}

lensprof_status lensprof_rendering_shot_at(const lensprof_rendering *rendering, uint32_t index,
                                           lensprof_rendering_shot *shot, lensprof_error *error) {
    clear(error);
    if (!rendering || !shot) return null_pointer(error);
    const auto &shots = rendering->fit.shots;
    if (index >= shots.size())
        return fail(LENSPROF_ERROR_ARGUMENT, error, "rendering: it has no shot %u, but %zu, counted from 0", index,
                    shots.size());
    return give(shots[index].found, shot, LP_END_OF(lensprof_rendering_shot, saturation), "rendering", error);
}

lensprof_status lensprof_rendering_finding_at(const lensprof_rendering *rendering, uint32_t index,
                                              lensprof_finding *finding, lensprof_error *error) {
    clear(error);
    if (!rendering || !finding) return null_pointer(error);
    const RenderingFit &fit = rendering->fit;
    return give_finding(fit.verdict.data(), fit.result, index, finding, "rendering", error);
}

}  // extern "C"
