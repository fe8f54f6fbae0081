#include "fit/online/solve.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "core/response.h"
#include "fit/online/camera.hpp"
#include "fit/online/exponent.hpp"
#include "fit/online/keyframe.hpp"
#include "fit/online/possible_step.hpp"
#include "fit/online/replay.hpp"
#include "fit/online/window.hpp"

namespace lensprof {
namespace online {
namespace {

constexpr double kPinned = 1e8;  // precision of the response's position, which the exponent is relative to
constexpr double kStill = 1e-4;  // squared standard errors of a step that changes nothing
constexpr uint32_t kMostSteps = 20;
constexpr int kHalvings = 12;

// The hold on the position of the response: precision (gradient' s - off)^2 / 2 of a step s.
struct Pin {
    Globals gradient = Globals::Zero();
    double off = 0.0;
    OmittedSlope omitted = OmittedSlope::Zero();  // of the modes that the fit omits, per standard error
};

Pin pin_of(const State &state) {
    Pin pin;
    if (!state.camera.modes) return pin;
    double by_mode[LENSPROF_EMOR_MODES];
    pin.off = state.exponent.position - lp_gauge_position(state.camera.table, by_mode);
    for (int l = 0; l < state.camera.modes; l++) pin.gradient[l] = by_mode[l];
    for (int m = 0; m < kOmitted; m++) pin.omitted[m] = state.omitted_sigma[m] * by_mode[state.camera.modes + m];
    return pin;
}

// The largest share of a step that leaves a possible camera.
Globals possible(const Globals &step, const Camera &camera) {
    Globals part = step;
    for (int n = 0; n < kHalvings; n++, part *= 0.5)
        if (is_possible(camera.globals + part, camera)) return part;
    return Globals::Zero();
}

// All that was found so far follows the globals.
void follow_all(const Memory &memory, const Globals &step) {
    State &state = memory.state();
    const Slope small = step.cast<float>();
    for (uint32_t c = 0; c < state.channels; c++) {
        for (uint32_t t = 0; t < state.live; t++)
            memory.lights(c)[t].log_radiance += static_cast<double>(memory.lights(c)[t].slope.dot(small));
        const auto kept = static_cast<int32_t>(std::min<uint64_t>(state.added, state.history));
        for (int32_t f = 0; f < kept; f++) {
            Exposed &exposed = memory.exposed(f, c);
            if (memory.frame(f).state == LENSPROF_ONLINE_LOST) continue;
            exposed.log_exposure += exposed.slope.dot(step), exposed.log_step += exposed.step_slope.dot(step);
        }
    }
    for (uint32_t k = 0; k < state.key_count; k++)
        for (uint32_t c = 0; c < state.channels; c++)
            memory.keyframes()[k].found[c] += memory.keyframes()[k].found_slope[c].dot(step);
    follow(step, state.exponent);
    state.has_moved = 1;
}

// What the errors of a converged window follow from.
struct Shown {
    GlobalMatrix inverse;  // of the precision of all that is known
    GlobalMatrix scatter;
    Omitted omitted;
};

Shown shown_by(const State &state, const Pin &pin, const Window &window) {
    const GlobalMatrix hold = kPinned * pin.gradient * pin.gradient.transpose();
    const GlobalMatrix inverse = (state.prior.precision + window.precision() + hold).inverse();
    return {inverse, window.scatter(inverse), window.omitted()};
}

// Standard errors by the scatter of the tracks' pulls (sandwich): those of one track may have a common error. Modes
// that the fit omits add theirs, which all tracks have in common.
void set_covariance(const Pin &pin, const Shown &shown, State &state) {
    const GlobalMatrix hold = kPinned * pin.gradient * pin.gradient.transpose();
    state.moved = shown.inverse * (state.omitted + shown.omitted + kPinned * pin.gradient * pin.omitted.transpose());
    state.covariance =
        shown.inverse * (state.scatter + shown.scatter + hold) * shown.inverse + state.moved * state.moved.transpose();
}

// The window becomes prior knowledge: its cost is quadratic about the present globals.
void drop_window(const Memory &memory, const Window &window, const Shown &shown) {
    State &state = memory.state();
    state.prior.precision += window.precision();
    state.prior.weighted += window.precision() * state.camera.globals + window.pull();
    state.scatter += shown.scatter, state.omitted += shown.omitted;
    state.windows++;
    clear_window(memory);
}

bool is_full(const Memory &memory) {
    const State &state = memory.state();
    return state.key_count == state.keyframes || state.window_count == memory.layout().window_tracks;
}

}  // namespace

bool is_pending(const State &state) { return !state.is_still; }

void take_step(const Memory &memory) {
    State &state = memory.state();
    const Window window(memory);
    const Pin pin = pin_of(state);
    const GlobalMatrix total =
        state.prior.precision + window.precision() + kPinned * pin.gradient * pin.gradient.transpose();
    const Globals pull = state.prior.weighted - state.prior.precision * state.camera.globals + window.pull()
                         + kPinned * pin.off * pin.gradient;
    const Globals step = possible(possible_step(state.camera, total.inverse(), pull), state.camera);
    const bool is_converged = step.dot(total * step) < kStill || ++state.steps >= kMostSteps;
    if (is_converged) {
        const Shown shown = shown_by(state, pin, window);
        set_covariance(pin, shown, state);
        state.is_still = 1;
        if (state.windows == 0 && state.has_moved) replay_window(memory);
        if (is_full(memory)) drop_window(memory, window, shown);
        return;
    }
    set_globals(state.camera.globals + step, state.camera);
    window.move_exposures(step);
    follow_all(memory, step);
}

}  // namespace online
}  // namespace lensprof
