// The C interface of levelled frames: argument checks, and conversion of exceptions to status codes.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "fit/api/boundary.hpp"
#include "fit/api/held.hpp"
#include "fit/base/inequality.hpp"
#include "fit/base/sized.hpp"
#include "fit/deflicker/levelling.hpp"
#include "fit/deflicker/shading.hpp"

using namespace lensprof;

struct lensprof_deflicker {
    lensprof_deflicker_options options;
    std::vector<lensprof_response> response;
    std::optional<CellTables> tables;
    std::optional<FrameChain> chain;
    uint32_t sample = 0, layout = 0;
    std::optional<FrameShadings> shadings;
    size_t measured = 0;  // frames
};

namespace {

constexpr size_t kFirstDeflickerOptions = LP_END_OF(lensprof_deflicker_options, region),
                 kFirstDeflickerFacts = LP_END_OF(lensprof_deflicker_facts, f_number),
                 kFirstDeflickerTarget = LP_END_OF(lensprof_deflicker_target, curve),
                 kFirstDeflickerFrame = LP_END_OF(lensprof_deflicker_frame, dark_share),
                 kFirstDeflickerResult = LP_END_OF(lensprof_deflicker_result, known_range);

lensprof_status null_deflicker(lensprof_error *error) {
    return fail(LENSPROF_ERROR_ARGUMENT, error, "deflicker: a pointer is NULL");
}

lensprof_status check_deflicker_options(const lensprof_deflicker_options &o, lensprof_error *error) {
    if (o.response && o.responses != 1 && o.responses != 3)
        return fail(LENSPROF_ERROR_ARGUMENT, error, "deflicker options: responses must be 1 or 3");
    if (o.rows > 1 || o.reserved) return fail(LENSPROF_ERROR_ARGUMENT, error, "deflicker options: rows must be 0 or 1");
    const double *r = o.region;
    const bool is_whole = std::all_of(r, r + 4, [](double share) { return share == 0.0; });
    if (!is_whole && !(r[0] >= 0.0 && r[1] >= 0.0 && r[2] <= 1.0 && r[3] <= 1.0 && r[0] < r[2] && r[1] < r[3]))
        return fail(
            LENSPROF_ERROR_ARGUMENT, error,
            "deflicker options: region must be left, top, right, bottom within 0..1, left < right, top < bottom");
    for (uint32_t c = 0; o.response && c < o.responses; c++)
        if (const lensprof_status status = lensprof_response_validate(&o.response[c]); status != LENSPROF_OK)
            return fail(status, error, "deflicker options: a response is not monotone from 0 to 1");
    return LENSPROF_OK;
}

lensprof_status check_frame(const lensprof_deflicker &d, const lensprof_image &frame,
                            const lensprof_deflicker_facts &facts, lensprof_error *error) {
    const lensprof_status status = lensprof_image_validate(&frame);
    const size_t index = d.chain ? d.chain->frames().size() : 0;
    const auto refuse = [&](lensprof_status of, const char *text) {
        return fail_at(LENSPROF_ITEM_IMAGE, static_cast<uint32_t>(index), of, error, "%s", text);
    };
    if (status != LENSPROF_OK) return refuse(status, "not a valid view; see lensprof_image_validate");
    if (frame.sample == LENSPROF_SAMPLE_F16)
        return refuse(LENSPROF_ERROR_UNSUPPORTED, "samples of 16 bit float are not supported; give U8, U16 or F32");
    if (frame.layout > LENSPROF_LAYOUT_BGRA)
        return refuse(LENSPROF_ERROR_UNSUPPORTED, "planar frames and mosaics are not supported; give grey or RGB");
    if (std::isinf(facts.seconds) || std::abs(facts.settings_ev) > 64.0 || facts.f_number <= 0.0
        || std::isinf(facts.f_number))
        return refuse(LENSPROF_ERROR_ARGUMENT,
                      "seconds, settings_ev (within 64 EV) and f_number (positive) must be finite or NaN");
    if (index == 0)
        return FrameGrid(frame, d.options.region).cells() >= kFewestCells
                   ? LENSPROF_OK
                   : refuse(LENSPROF_ERROR_SIZE, "too few pixels to compare; at least 24 are needed");
    const FrameGrid &grid = d.chain->grid();
    if (frame.width != grid.width || frame.height != grid.height || frame.sample != d.sample
        || frame.layout != d.layout)
        return refuse(LENSPROF_ERROR_SIZE, "its size, sample type or layout is not that of the first frame");
    const double last = d.chain->frames().back().seconds;
    if (std::isnan(facts.seconds) != std::isnan(last))
        return refuse(LENSPROF_ERROR_ARGUMENT, "seconds must be given for all frames or none");
    if (facts.seconds < last) return refuse(LENSPROF_ERROR_ARGUMENT, "seconds must not decrease");
    if (index >= LENSPROF_DEFLICKER_FRAMES) return refuse(LENSPROF_ERROR_ARGUMENT, "too many frames");
    return LENSPROF_OK;
}

lensprof_status check_measured(const lensprof_deflicker *d, const void *result, lensprof_error *error) {
    clear(error);
    if (!d || !result) return null_deflicker(error);
    if (d->measured == 0)
        return fail(LENSPROF_ERROR_ARGUMENT, error,
                    "deflicker: nothing was measured; call lensprof_deflicker_measure first");
    return LENSPROF_OK;
}

lensprof_status check_index(const lensprof_deflicker *d, uint32_t index, const void *result, lensprof_error *error) {
    const lensprof_status status = check_measured(d, result, error);
    if (status == LENSPROF_OK && index >= d->measured)
        return fail(LENSPROF_ERROR_ARGUMENT, error, "deflicker: it has no frame %u, but %zu, counted from 0", index,
                    d->measured);
    return status;
}

lensprof_status check_target(const lensprof_deflicker &d, const lensprof_deflicker_target &t, lensprof_error *error) {
    const auto refuse = [&](const char *text) {
        return fail(LENSPROF_ERROR_ARGUMENT, error, "deflicker target: %s", text);
    };
    const auto &frames = d.chain->frames();
    if (t.to > LENSPROF_TO_CURVE) return refuse("unknown value of `to`");
    if (!(t.window_s >= 0.0) || std::isinf(t.window_s)) return refuse("window_s must be 0 or positive");
    if (t.to == LENSPROF_TO_FRAME && (t.frame >= frames.size() || frames[t.frame].state != LENSPROF_FRAME_LEVELLED))
        return refuse("frame is not one that was levelled");
    if (t.to == LENSPROF_TO_CURVE && !t.curve) return refuse("curve is NULL");
    for (size_t i = 0; t.to == LENSPROF_TO_CURVE && i < frames.size(); i++)
        if (!(std::abs(t.curve[i]) <= 64.0)) return refuse("curve must be within -64..64 EV");
    const auto is_unknown = [](const ChainFrame &f) { return !std::isfinite(f.settings_ev); };
    if (t.to == LENSPROF_TO_LIGHT && std::any_of(frames.begin(), frames.end(), is_unknown))
        return refuse("the settings of a frame are unknown; the light alone needs those of all");
    return LENSPROF_OK;
}

}  // namespace

extern "C" {

void lensprof_deflicker_options_init_sized(lensprof_deflicker_options *options, size_t size) {
    if (lp_sized_begin(options, size, kFirstDeflickerOptions)) options->responses = 1;
}

void lensprof_deflicker_facts_init_sized(lensprof_deflicker_facts *facts, size_t size) {
    if (lp_sized_begin(facts, size, kFirstDeflickerFacts)) facts->seconds = facts->settings_ev = facts->f_number = NAN;
}

void lensprof_deflicker_target_init_sized(lensprof_deflicker_target *target, size_t size) {
    (void)lp_sized_begin(target, size, kFirstDeflickerTarget);
}

lensprof_status lensprof_deflicker_create(const lensprof_deflicker_options *options, lensprof_deflicker **deflicker,
                                          lensprof_error *error) {
    return at_boundary("deflicker", error, [&] {
        clear(error);
        if (!deflicker) return null_deflicker(error);
        auto made = std::make_unique<lensprof_deflicker>();
        lensprof_deflicker_options_init(&made->options);
        if (options)
            if (const char *wrong = lp_sized_take(&made->options, options, kFirstDeflickerOptions))
                return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "deflicker options: %s", wrong);
        const lensprof_status status = check_deflicker_options(made->options, error);
        if (status != LENSPROF_OK) return status;
        if (made->options.response)
            made->response.assign(made->options.response, made->options.response + made->options.responses);
        *deflicker = made.release();
        return LENSPROF_OK;
    });
}

void lensprof_deflicker_destroy(lensprof_deflicker *deflicker) { delete deflicker; }

lensprof_status lensprof_deflicker_add(lensprof_deflicker *deflicker, const lensprof_image *frame,
                                       const lensprof_deflicker_facts *facts, lensprof_error *error) {
    return at_boundary("deflicker", error, [&] {
        clear(error);
        if (!deflicker || !frame) return null_deflicker(error);
        lensprof_deflicker_facts known;
        lensprof_deflicker_facts_init(&known);
        if (facts)
            if (const char *wrong = lp_sized_take(&known, facts, kFirstDeflickerFacts))
                return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "deflicker facts: %s", wrong);
        const lensprof_status status = check_frame(*deflicker, *frame, known, error);
        if (status != LENSPROF_OK) return status;
        if (!deflicker->chain) {
            deflicker->tables.emplace(deflicker->response, frame->sample);
            deflicker->chain.emplace(FrameGrid(*frame, deflicker->options.region), deflicker->options.rows != 0);
            deflicker->sample = frame->sample, deflicker->layout = frame->layout;
        }
        FrameChain &chain = *deflicker->chain;
        deflicker->measured = 0;  // frames may change what is known of those before
        chain.add(reduce_frame(chain.grid(), *deflicker->tables, *frame), known);
        return LENSPROF_OK;
    });
}

lensprof_status lensprof_deflicker_measure(lensprof_deflicker *deflicker, lensprof_deflicker_result *result,
                                           lensprof_error *error) {
    return at_boundary("deflicker", error, [&] {
        clear(error);
        if (!deflicker) return null_deflicker(error);
        if (result)
            if (const char *wrong = lp_sized_wrong(result, kFirstDeflickerResult, sizeof *result))
                return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "deflicker: %s", wrong);
        const lensprof_deflicker_result found =
            deflicker->chain ? summarise((deflicker->chain->solve(), *deflicker->chain)) : lensprof_deflicker_result{};
        if (found.levelled == 0)
            return fail(
                LENSPROF_ERROR_NO_SAMPLES, error,
                "deflicker: none of the %u frames has cells that are neither dark nor saturated; check exposure "
                "and region",
                found.frames);
        deflicker->measured = found.frames;
        deflicker->shadings.emplace(*deflicker->chain);
        return result ? give(found, result, kFirstDeflickerResult, "deflicker", error) : LENSPROF_OK;
    });
}

lensprof_status lensprof_deflicker_frame_at(const lensprof_deflicker *deflicker, uint32_t index,
                                            lensprof_deflicker_frame *frame, lensprof_error *error) {
    const lensprof_status status = check_index(deflicker, index, frame, error);
    if (status != LENSPROF_OK) return status;
    const FrameGrid &grid = deflicker->chain->grid();
    const ChainFrame &f = deflicker->chain->frames()[index];
    lensprof_deflicker_frame found;
    lensprof_deflicker_frame_init(&found);
    found.state = f.state, found.segment = f.segment, found.repeats = f.repeats;
    found.seconds = std::isnan(f.seconds) ? index : f.seconds;
    found.settings_ev = f.settings_ev;
    found.exposure = exposure_of(f, grid.channels);
    found.ev_sigma = f.sigma, found.agreeing = f.agreeing;
    for (int a = 0; a < 2; a++) found.shift[a] = f.shift[static_cast<size_t>(a)] / std::max(grid.columns, grid.rows);
    found.white_share = f.white_share, found.dark_share = f.dark_share;
    return give(found, frame, kFirstDeflickerFrame, "deflicker", error);
}

lensprof_status lensprof_deflicker_curve(const lensprof_deflicker *deflicker, const lensprof_deflicker_target *target,
                                         lensprof_exposure *exposures, uint32_t count, double *window,
                                         lensprof_error *error) {
    return at_boundary("deflicker", error, [&] {
        lensprof_status status = check_measured(deflicker, exposures, error);
        if (status != LENSPROF_OK) return status;
        lensprof_deflicker_target wanted;
        lensprof_deflicker_target_init(&wanted);
        if (target)
            if (const char *wrong = lp_sized_take(&wanted, target, kFirstDeflickerTarget))
                return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "deflicker target: %s", wrong);
        if (count != deflicker->measured)
            return fail(LENSPROF_ERROR_ARGUMENT, error,
                        "deflicker: %u exposures are wanted, but %zu frames were measured", count, deflicker->measured);
        status = check_target(*deflicker, wanted, error);
        if (status != LENSPROF_OK) return status;
        double used = 0.0;
        const std::vector<lensprof_exposure> found = wanted_exposures(*deflicker->chain, wanted, used);
        std::copy(found.begin(), found.end(), exposures);
        if (window) *window = used;
        return LENSPROF_OK;
    });
}

lensprof_status lensprof_deflicker_shading(const lensprof_deflicker *deflicker, uint32_t index,
                                           lensprof_gain_grid *shading, lensprof_error *error) {
    const lensprof_status status = check_index(deflicker, index, shading, error);
    if (status != LENSPROF_OK) return status;
    lensprof_gain_grid_init(shading);
    if (deflicker->chain->frames()[index].state == LENSPROF_FRAME_LEVELLED) *shading = deflicker->shadings->of(index);
    return LENSPROF_OK;
}

}  // extern "C"
