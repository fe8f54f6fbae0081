// The C interface of a camera that runs: argument checks. Nothing is changed by a call that fails.
#include <cmath>

#include "fit/api/boundary.hpp"
#include "fit/api/held.hpp"
#include "fit/api/profile.hpp"
#include "fit/base/sized.hpp"
#include "fit/online/frame.hpp"
#include "fit/online/report.hpp"
#include "fit/online/solve.hpp"

using namespace lensprof;

struct lensprof_online : online::State {};

namespace {

constexpr size_t kFirstOnlineOptions = LP_END_OF(lensprof_online_options, profile);
constexpr size_t kFirstOnlineFrame = LP_END_OF(lensprof_online_frame, observations);
constexpr size_t kFirstOnlineExposure = LP_END_OF(lensprof_online_exposure, keyframe);
constexpr size_t kFirstOnlineResult = LP_END_OF(lensprof_online_result, inlier_share);
constexpr double kLargestWeight = 1000.0, kLargestEv = 64.0, kLargestCentre = 0.5;

bool is_within(double value, double low, double high) { return value >= low && value <= high; }

lensprof_status null_online(lensprof_error *error) {
    return fail(LENSPROF_ERROR_ARGUMENT, error, "online: a pointer is NULL");
}

bool are_sizes_valid(const lensprof_online_options &o) {
    return (o.channels == 1 || o.channels == 3) && o.tracks >= 8 && o.tracks <= LENSPROF_ONLINE_TRACKS
           && o.keyframes >= 4 && o.keyframes <= LENSPROF_ONLINE_KEYFRAMES && o.history >= 2
           && o.history <= LENSPROF_ONLINE_HISTORY;
}

lensprof_status check_online_options(const lensprof_online_options &o, lensprof_error *error) {
    if (!o.width || !o.height)
        return fail(LENSPROF_ERROR_SIZE, error, "online: a frame of %u x %u; set width and height", o.width, o.height);
    for (double value : {o.center[0], o.center[1], o.black, o.white})
        if (!std::isfinite(value))
            return fail(LENSPROF_ERROR_NOT_FINITE, error, "online: center, black or white is not a finite number");
    const Rule rules[] = {
        {o.channels == 1 || o.channels == 3, "channels: give 1 or 3"},
        {are_sizes_valid(o), "tracks, keyframes or history is out of range; online.h has the ranges"},
        {o.modes <= LENSPROF_ONLINE_MODES, "modes: give 0 to 8"},
        {o.camera_kind <= LENSPROF_CAMERA_LINEAR, "camera_kind: unknown"},
        {std::abs(o.center[0]) <= kLargestCentre && std::abs(o.center[1]) <= kLargestCentre,
         "center: give -0.5 to 0.5"},
        {o.black >= 0.0 && o.black < o.white && o.white <= 1.0, "black, white: give 0 <= black < white <= 1"},
    };
    const char *broken = first_broken(rules);
    return broken ? fail(LENSPROF_ERROR_ARGUMENT, error, "online: %s", broken) : LENSPROF_OK;
}

lensprof_status check_start(const lensprof_profile *profile, lensprof_error *error) {
    if (!profile) return LENSPROF_OK;
    const lensprof_status status = lensprof_profile_validate(profile);
    if (status != LENSPROF_OK)
        return fail(status, error, "online: the profile is invalid; see lensprof_profile_validate");
    return profile->responses == 1
               ? LENSPROF_OK
               : fail(LENSPROF_ERROR_RESPONSE, error,
                      "online: the profile has a response per channel; give one with a single response");
}

lensprof_status take_options(const lensprof_online_options *given, lensprof_online_options &options,
                             lensprof_error *error) {
    lensprof_online_options_init(&options);
    if (const char *wrong = lp_sized_take(&options, given, kFirstOnlineOptions))
        return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "online options: %s", wrong);
    const lensprof_status status = check_online_options(options, error);
    return status == LENSPROF_OK ? check_start(options.profile, error) : status;
}

lensprof_status refuse_observation(uint32_t index, lensprof_status status, const char *text, lensprof_error *error) {
    return fail_at(LENSPROF_ITEM_OBSERVATION, index, status, error, "%s", text);
}

lensprof_status check_observation(const online::State &state, const lensprof_online_observation &o, uint32_t index,
                                  lensprof_error *error) {
    bool is_finite = std::isfinite(o.x) && std::isfinite(o.y) && std::isfinite(o.weight), is_grey = true;
    for (uint32_t c = 0; c < state.channels; c++) {
        is_finite = is_finite && std::isfinite(o.value[c]);
        is_grey = is_grey && o.value[c] >= 0.0f && o.value[c] <= 1.0f;
    }
    if (!is_finite)
        return refuse_observation(index, LENSPROF_ERROR_NOT_FINITE, "a number is not finite; leave the track out",
                                  error);
    if (!is_grey)
        return refuse_observation(index, LENSPROF_ERROR_ARGUMENT, "a grey value is outside of 0..1; divide by white",
                                  error);
    if (!is_within(static_cast<double>(o.x), -0.5, state.width - 0.5)
        || !is_within(static_cast<double>(o.y), -0.5, state.height - 0.5))
        return refuse_observation(index, LENSPROF_ERROR_ARGUMENT, "lies outside of the frame; leave it out", error);
    if (!is_within(static_cast<double>(o.weight), 0.0, kLargestWeight))
        return refuse_observation(index, LENSPROF_ERROR_ARGUMENT, "its weight is outside of 0..1000", error);
    return LENSPROF_OK;
}

lensprof_status check_frame(const online::Memory &memory, const lensprof_online_frame &frame, lensprof_error *error) {
    const online::State &state = memory.state();
    if (state.added && frame.number <= memory.frame(state.last).number)
        return fail(LENSPROF_ERROR_ARGUMENT, error,
                    "online: frame %llu does not follow frame %llu; add frames in their order",
                    static_cast<unsigned long long>(frame.number),
                    static_cast<unsigned long long>(memory.frame(state.last).number));
    if (!std::isfinite(frame.known_ev) || !std::isfinite(frame.known_ev_sigma))
        return fail(LENSPROF_ERROR_NOT_FINITE, error, "online: the known exposure is not finite; set its sigma to 0");
    const bool has_sigma = is_within(frame.known_ev_sigma, 0.001, 100.0) && std::abs(frame.known_ev) <= kLargestEv;
    if (frame.known_ev_sigma != 0.0 && !has_sigma)
        return fail(LENSPROF_ERROR_ARGUMENT, error, "online: the known exposure or its error is out of range");
    if (frame.count > state.tracks)
        return fail(LENSPROF_ERROR_CAPACITY, error, "online: %u observations, but options.tracks is %u", frame.count,
                    state.tracks);
    if (frame.count && !frame.observations) return null_online(error);
    for (uint32_t i = 0; i < frame.count; i++) {
        const lensprof_status status = check_observation(state, frame.observations[i], i, error);
        if (status != LENSPROF_OK) return status;
    }
    return LENSPROF_OK;
}

// Runs a call on a state that was begun.
template <class Call>
lensprof_status with_online(const lensprof_online *given, lensprof_error *error, Call call) {
    return at_boundary("online", error, [&] {
        clear(error);
        if (!given) return null_online(error);
        auto &state = const_cast<lensprof_online &>(*given);  // calls for results do not write
        if (state.magic != online::kMagic)
            return fail(LENSPROF_ERROR_ARGUMENT, error, "online: not begun; call lensprof_online_begin first");
        return call(online::Memory(state));
    });
}

lensprof_status give_exposure(const online::Memory &memory, int32_t frame, lensprof_online_exposure *exposure,
                              lensprof_error *error) {
    return give(online::exposure_of(memory, frame), exposure, kFirstOnlineExposure, "online exposure", error);
}

}  // namespace

extern "C" {

void lensprof_online_options_init_sized(lensprof_online_options *options, size_t size) {
    if (!lp_sized_begin(options, size, kFirstOnlineOptions)) return;
    options->channels = 1, options->tracks = 512, options->keyframes = 12, options->modes = 6, options->history = 64;
    options->black = 0.04, options->white = 0.94;
}

void lensprof_online_frame_init_sized(lensprof_online_frame *frame, size_t size) { lensprof_init_sized(frame, size); }

void lensprof_online_exposure_init_sized(lensprof_online_exposure *exposure, size_t size) {
    lensprof_init_sized(exposure, size);
}

void lensprof_online_result_init_sized(lensprof_online_result *result, size_t size) {
    lensprof_init_sized(result, size);
}

size_t lensprof_online_bytes(const lensprof_online_options *given) {
    lensprof_online_options options;
    lensprof_online_options_init(&options);
    if (!given || lp_sized_take(&options, given, kFirstOnlineOptions) || !are_sizes_valid(options)) return 0;
    return online::layout_of(options).bytes;
}

lensprof_status lensprof_online_begin(void *memory, size_t size, const lensprof_online_options *given,
                                      lensprof_online **result, lensprof_error *error) {
    return at_boundary("online", error, [&] {
        clear(error);
        if (!memory || !given || !result) return null_online(error);
        lensprof_online_options options;
        const lensprof_status status = take_options(given, options, error);
        if (status != LENSPROF_OK) return status;
        if (reinterpret_cast<uintptr_t>(memory) % 8)
            return fail(LENSPROF_ERROR_ARGUMENT, error, "online: the memory is not aligned to 8 bytes");
        const size_t bytes = online::layout_of(options).bytes;
        if (size < bytes)
            return fail(LENSPROF_ERROR_CAPACITY, error, "online: %zu bytes of memory, but these options need %zu", size,
                        bytes);
        auto *state = static_cast<lensprof_online *>(memory);
        online::begin(options, *state);
        *result = state;
        return LENSPROF_OK;
    });
}

lensprof_status lensprof_online_add(lensprof_online *online, const lensprof_online_frame *given,
                                    lensprof_online_exposure *exposure, lensprof_error *error) {
    return with_online(online, error, [&](const online::Memory &memory) {
        if (!given) return null_online(error);
        lensprof_online_frame frame;
        lensprof_online_frame_init(&frame);
        if (const char *wrong = lp_sized_take(&frame, given, kFirstOnlineFrame))
            return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "online frame: %s", wrong);
        if (const char *wrong = exposure ? lp_sized_wrong(exposure, kFirstOnlineExposure, sizeof *exposure) : nullptr)
            return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "online exposure: %s", wrong);
        const lensprof_status status = check_frame(memory, frame, error);
        if (status != LENSPROF_OK) return status;
        const online::Refusal refusal = online::find_tracks(memory, frame);
        if (refusal.fault != online::Fault::none)
            return refuse_observation(refusal.observation, LENSPROF_ERROR_ARGUMENT,
                                      "its track occurs twice in the frame; give each track once", error);
        online::add_frame(memory, frame);
        return exposure ? give_exposure(memory, memory.state().last, exposure, error) : LENSPROF_OK;
    });
}

lensprof_status lensprof_online_solve(lensprof_online *online, uint32_t steps, uint32_t *pending,
                                      lensprof_error *error) {
    return with_online(online, error, [&](const online::Memory &memory) {
        while (steps-- && online::is_pending(memory.state())) online::take_step(memory);
        if (pending) *pending = online::is_pending(memory.state());
        return LENSPROF_OK;
    });
}

lensprof_status lensprof_online_exposure_at(const lensprof_online *online, uint64_t number,
                                            lensprof_online_exposure *exposure, lensprof_error *error) {
    return with_online(online, error, [&](const online::Memory &memory) {
        if (!exposure) return null_online(error);
        const online::State &state = memory.state();
        const auto kept = static_cast<int32_t>(std::min<uint64_t>(state.added, state.history));
        for (int32_t frame = 0; frame < kept; frame++)
            if (memory.frame(frame).number == number) return give_exposure(memory, frame, exposure, error);
        return fail(LENSPROF_ERROR_NOT_FOUND, error, "online: frame %llu was not added, or is no longer kept",
                    static_cast<unsigned long long>(number));
    });
}

lensprof_status lensprof_online_get(const lensprof_online *online, lensprof_online_result *result,
                                    lensprof_error *error) {
    return with_online(online, error, [&](const online::Memory &memory) {
        if (!result) return null_online(error);
        return give(online::result_of(memory.state()), result, kFirstOnlineResult, "online result", error);
    });
}

lensprof_status lensprof_online_profile(const lensprof_online *online, lensprof_profile *profile,
                                        lensprof_error *error) {
    return with_online(online, error, [&](const online::Memory &memory) {
        if (!profile) return null_online(error);
        return change_given_profile(
            profile, [&](lensprof_profile &local) { online::put_profile(memory.state(), local); }, error);
    });
}

}  // extern "C"
