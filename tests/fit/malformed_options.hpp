// Mutations of options, of the data they point to, and of the call itself.
#pragma once

#include "malformed_case.hpp"

namespace malformed {

// Options.

inline void grey(Case &c) { c.options.channels = 1; }

inline void odd_channels(Case &c) {
    static const uint32_t numbers[] = {0, 2, 4, 99, 0xFFFFFFFF};
    c.options.channels = numbers[c.below(5)];
}

inline void any_reference(Case &c) { c.options.reference = c.chance(0.7) ? c.below(c.s.images) : odd_integer(c); }

inline void random_flags(Case &c) { c.options.free = c.below(32); }

inline void odd_flags(Case &c) { c.options.free = c.chance(0.5) ? odd_integer(c) : 1u << c.below(32); }

inline void any_modes(Case &c) { c.options.modes = c.chance(0.8) ? c.below(26) : odd_integer(c); }

inline void automatic_modes(Case &c) {
    c.options.modes = LENSPROF_MODES_AUTO;
    c.options.max_iterations = 1 + c.below(3);
}

inline void any_loss(Case &c) { c.options.loss = c.chance(0.7) ? c.below(3) : odd_integer(c); }

inline void any_huber(Case &c) {
    c.options.loss = LENSPROF_LOSS_HUBER;
    c.options.huber_levels = c.chance(0.6) ? std::pow(10.0, 12.0 * c.uniform() - 10.0) : odd_number(c);
}

inline void no_prior(Case &c) { c.options.prior_weight = 0.0; }

inline void any_prior(Case &c) {
    c.options.prior_weight = c.chance(0.6) ? std::pow(10.0, 16.0 * c.uniform() - 10.0) : odd_number(c);
}

inline void paper(Case &c) {
    c.options.loss = LENSPROF_LOSS_HUBER;
    c.options.prior_weight = 0.0;
    c.options.modes = 5;
}

inline void odd_iterations(Case &c) { c.options.max_iterations = odd_integer(c); }

inline void many_iterations(Case &c) { c.options.max_iterations = c.chance(0.5) ? 200 : 1000000; }

inline void odd_struct_size(Case &c) {
    (c.chance(0.5) ? c.options.struct_size : c.result.struct_size) += c.chance(0.5) ? 8 : odd_integer(c);
}

inline void odd_choices(Case &c) {
    (c.chance(0.3)   ? c.options.vignettings
     : c.chance(0.5) ? c.options.gamma_from
                     : c.options.camera_kind) = odd_integer(c);
}

inline void any_choices(Case &c) {
    const uint32_t curves[3] = {0, 1, 3};
    c.options.vignettings = curves[c.below(3)];
    c.options.gamma_from = c.below(3);
    c.options.camera_kind = c.below(6);
}

// Known exposures: the true ones, all equal, or random.
inline void known_exposures(Case &c) {
    uint32_t kind = c.below(3);
    for (size_t i = 0; i < c.s.fit_images.size(); i++) {
        auto &image = c.s.fit_images[i];
        image.known_ev = kind == 1 ? 3.0 : 9.0 * c.uniform();
        if (kind == 0 && i < c.s.exposures.size()) image.known_ev = c.s.exposures[i].ev;
        image.known_ev_sigma = c.chance(0.8) ? 0.1 : 100.0 * c.uniform();
    }
}

inline void odd_known_exposure(Case &c) {
    if (c.s.fit_images.empty()) return;
    auto &image = c.s.fit_images[c.below(static_cast<uint32_t>(c.s.fit_images.size()))];
    image.known_ev_sigma = 0.1;
    (c.chance(0.5) ? image.known_ev : image.known_ev_sigma) = odd_number(c);
}

inline void any_vignetting(Case &c) {
    for (double &k : c.options.vignetting.k) k = 4.0 * c.uniform() - 2.0;
    c.options.free &= c.below(32);
}

inline void odd_vignetting(Case &c) {
    auto &v = c.options.vignetting;
    (c.chance(0.5) ? v.k[c.below(3)] : v.center[c.below(2)]) = odd_number(c);
}

inline void darkest_vignetting(Case &c) {  // M = .001 at the corner
    c.options.vignetting = {{-0.999, 0.0, 0.0}, {0.0, 0.0}};
    c.options.free &= c.below(32);
}

inline void centre_outside(Case &c) {
    for (double &d : c.options.vignetting.center) d = 2.4 * c.uniform() - 1.2;
    c.options.free &= ~LENSPROF_FREE_CENTER;
}

inline void set_given(Case &c, const std::vector<double> &values) {
    assert_ok(lensprof_response_set_table(&c.given, values.data(), static_cast<uint32_t>(values.size())));
    c.options.response = &c.given;
    if (c.chance(0.8)) c.options.free &= ~LENSPROF_FREE_RESPONSE;
}

inline void nearly_flat_response(Case &c) {
    double low = c.uniform(), high = low + (1.0 - low) * std::pow(10.0, -16.0 * c.uniform());
    std::vector<double> values(1024);
    for (size_t j = 0; j < values.size(); j++) values[j] = low + (high - low) * static_cast<double>(j) / 1023.0;
    values.front() = 0.0, values.back() = 1.0;
    set_given(c, values);
}

inline void step_response(Case &c) {
    uint32_t step = 1 + c.below(1022);
    std::vector<double> values(1024);
    for (uint32_t j = step; j < 1024; j++) values[j] = 1.0;
    set_given(c, values);
}

inline void stairs_response(Case &c) {
    std::vector<double> values(1024);
    for (size_t j = 1; j < values.size(); j++) values[j] = values[j - 1] + (c.chance(0.02) ? c.uniform() : 0.0);
    for (double &v : values) v /= std::max(values.back(), 1e-9);
    values.back() = 1.0;
    set_given(c, values);
}

inline void odd_response(Case &c) {
    c.options.response = &c.given;
    switch (c.below(4)) {
    case 0: c.given.table[c.below(1024)] = odd_number(c); break;
    case 1: c.given.kind = odd_integer(c); break;
    case 2: c.given.modes = odd_integer(c); break;
    default: c.given.gamma = odd_number(c);
    }
}

inline void cancelled(Case &c) { c.calls_left = static_cast<int>(c.below(12)); }

inline void null_pointer(Case &c) {
    bool *pointers[] = {&c.null_options,   &c.null_images, &c.null_pairs,
                        &c.null_exposures, &c.null_result, &c.null_error};
    *pointers[c.below(6)] = true;
}

}  // namespace malformed
