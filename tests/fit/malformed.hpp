// A well-formed problem of the overlap fit, and a table of mutations that make it malformed or degenerate.
#pragma once

#include <cstdio>
#include <limits>
#include <string>

#include "simulated.hpp"

namespace malformed {

const double kNone = std::numeric_limits<double>::quiet_NaN(), kInfinite = std::numeric_limits<double>::infinity();

struct Case {
    uint64_t random;
    Simulation s;
    lensprof_response given;  // where options.response points to, if anywhere
    lensprof_fit_options options;
    std::vector<lensprof_exposure> exposures;
    std::vector<lensprof_fit_image_quality> quality;
    lensprof_fit_result result;
    lensprof_error error;
    bool null_options = false, null_images = false, null_pairs = false, null_exposures = false, null_result = false,
         null_error = false;
    int calls_left = -1;  // of progress before it cancels
    std::string what;     // names of the mutations

    explicit Case(uint32_t number);
    double uniform() { return lp_random(&random); }
    uint32_t below(uint32_t n) { return std::min(static_cast<uint32_t>(uniform() * n), n - 1); }
    bool chance(double p) { return uniform() < p; }
    lensprof_pair &any_pair() { return s.pairs[below(static_cast<uint32_t>(s.pairs.size()))]; }
    lensprof_fit_image &any_image() { return s.fit_images[below(static_cast<uint32_t>(s.fit_images.size()))]; }
    lensprof_status run();
};

inline Case::Case(uint32_t number) : random(0x9e3779b97f4a7c15ull * (number + 1)) {
    static const lensprof_response srgb = srgb_response();
    s.response = given = srgb;
    s.images = 2 + below(5);
    s.make(1 + below(60), 2.0 * uniform(), chance(0.3) ? 0.5 * uniform() : 0.0, 1.0, random);
    lensprof_fit_options_init(&options);
    options.modes = below(6);
    options.max_iterations = 1 + below(6);
    options.loss = below(3);
    if (number % 200 == 7) options.method = LENSPROF_METHOD_TRANSFER_FUNCTION;
    if (number % 20 == 9) {
        options.method = LENSPROF_METHOD_DEBEVEC;
        options.free = LENSPROF_FREE_RESPONSE;
        for (auto &image : s.fit_images) image.known_ev = 4.0 * uniform(), image.known_ev_sigma = 0.1;
    }
    lensprof_fit_result_init(&result);
}

inline int count_down(double, void *user) {
    int &left = *static_cast<int *>(user);
    return left >= 0 && left-- == 0;
}

inline lensprof_status Case::run() {
    if (calls_left >= 0) options.progress = count_down, options.progress_user = &calls_left;
    exposures.resize(s.fit_images.size());  // exactly as many as are promised: a sanitizer sees one more
    if (!exposures.empty())
        std::memset(static_cast<void *>(exposures.data()), 0xFF, exposures.size() * sizeof exposures[0]);
    quality.assign(s.fit_images.size(), lensprof_fit_image_quality{});
    for (auto &q : quality) q.ev_sigma = q.median_residual = q.radius = kNone;
    result.image_quality = chance(0.5) ? quality.data() : nullptr;
    result.before_rms = result.noise_levels = result.inlier_share = result.seconds = kNone;
    result.heldout_rms = result.heldout_median = result.vignetting[0].k[0] = result.response.table[7] = kNone;
    std::strcpy(result.reason, "stale");
    return lensprof_fit_overlap(null_options ? nullptr : &options, null_images ? nullptr : s.fit_images.data(),
                                static_cast<uint32_t>(s.fit_images.size()), null_pairs ? nullptr : s.pairs.data(),
                                static_cast<uint32_t>(s.pairs.size()), null_exposures ? nullptr : exposures.data(),
                                null_result ? nullptr : &result, null_error ? nullptr : &error);
}

// Numbers at and beyond every edge.
inline double odd_number(Case &c) {
    static const double numbers[] = {kNone,     kInfinite, -kInfinite, 1e300, -1e300, 1e-320, -0.0, 0.0,  1.0,   -1.0,
                                     1.0000001, -1e-9,     2.0,        1e9,   -1e9,   255.0,  1e6,  64.0, -64.0, 1e-6};
    return numbers[c.below(sizeof numbers / sizeof *numbers)];
}

inline uint32_t odd_integer(Case &c) {
    static const uint32_t numbers[] = {
        0, 1, 2, 3, 4, 25, 26, 99, 255, 1u << 20, (1u << 20) + 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFE, 0xFFFFFFFF};
    return numbers[c.below(sizeof numbers / sizeof *numbers)];
}

inline void set_value(lensprof_pair &pair, double value) {
    for (auto &side : pair.value) side[0] = side[1] = side[2] = value;
}

// Pairs that are valid and tell little or nothing.

inline void one_pair_repeated(Case &c) {
    for (auto &pair : c.s.pairs) pair = c.s.pairs[0];
}

inline void one_grey_value(Case &c) {
    double value = c.chance(0.5) ? c.uniform() : std::round(c.uniform());
    for (auto &pair : c.s.pairs) set_value(pair, value);
}

inline void black_and_white(Case &c) {
    for (auto &pair : c.s.pairs)
        for (auto &side : pair.value)
            for (double &v : side) v = std::round(c.uniform());
}

inline void some_black_or_white(Case &c) {
    for (auto &pair : c.s.pairs)
        if (c.chance(0.3)) set_value(pair, std::round(c.uniform()));
}

inline void noise_alone(Case &c) {
    for (auto &pair : c.s.pairs)
        for (auto &side : pair.value)
            for (double &v : side) v = c.uniform();
}

inline void opposite_ends(Case &c) {
    for (auto &pair : c.s.pairs)
        for (int k = 0; k < 3; k++) pair.value[0][k] = 0.0, pair.value[1][k] = 1.0;
}

inline void equal_ends(Case &c) {
    for (auto &pair : c.s.pairs) std::memcpy(pair.value[1], pair.value[0], sizeof pair.value[0]);
}

inline void dark(Case &c) {
    double factor = std::pow(10.0, -12.0 * c.uniform());
    for (auto &pair : c.s.pairs)
        for (auto &side : pair.value)
            for (double &v : side) v *= factor;
}

inline void one_position(Case &c) {
    for (auto &pair : c.s.pairs) std::memcpy(pair.xy, c.s.pairs[0].xy, sizeof pair.xy);
}

inline void same_position_in_both(Case &c) {
    for (auto &pair : c.s.pairs) std::memcpy(pair.xy[1], pair.xy[0], sizeof pair.xy[0]);
}

inline void corners(Case &c) {
    for (auto &pair : c.s.pairs)
        for (int side = 0; side < 2; side++) {
            const auto &frame = c.s.fit_images[std::min<size_t>(pair.image[side], c.s.fit_images.size() - 1)];
            pair.xy[side][0] = c.chance(0.5) ? -1.0 : frame.width;
            pair.xy[side][1] = c.chance(0.5) ? -1.0 : frame.height;
        }
}

inline void duplicates(Case &c) {
    size_t half = std::max<size_t>(c.s.pairs.size() / 2, 1);
    for (size_t p = half; p < c.s.pairs.size(); p++) c.s.pairs[p] = c.s.pairs[p - half];
}

// Which images are tied to which.

inline void images_without_pairs(Case &c) {
    for (auto &pair : c.s.pairs) pair.image[0] = 0, pair.image[1] = 1;
}

inline void two_groups(Case &c) {
    if (c.s.fit_images.size() < 4) return;
    for (auto &pair : c.s.pairs) {
        uint32_t first = c.chance(0.5) ? 0 : 2;
        pair.image[0] = first, pair.image[1] = first + 1;
    }
}

inline void reference_without_pairs(Case &c) {
    c.options.reference = static_cast<uint32_t>(c.s.fit_images.size()) - 1;
    images_without_pairs(c);
}

inline void random_images(Case &c) {
    for (auto &pair : c.s.pairs)
        for (auto &image : pair.image) image = c.below(c.s.images + (c.chance(0.02) ? 1 : 0));
}

inline void same_image_twice(Case &c) {
    auto &pair = c.any_pair();
    pair.image[1] = pair.image[0];
}

inline void image_out_of_range(Case &c) { c.any_pair().image[c.below(2)] = odd_integer(c); }

inline void one_pair(Case &c) { c.s.pairs.resize(1); }

inline void no_pairs(Case &c) { c.s.pairs.clear(); }

inline void one_image(Case &c) { c.s.fit_images.resize(c.below(2)); }

inline void many_images(Case &c) {
    lensprof_fit_image last = c.s.fit_images.back();
    while (c.s.fit_images.size() < 30) {
        last.ev_of = last.red_of = last.blue_of = static_cast<uint32_t>(c.s.fit_images.size());
        c.s.fit_images.push_back(last);
    }
}

// Links.

inline void link_all(Case &c) {
    uint32_t to = c.below(c.s.images);
    for (auto &image : c.s.fit_images) {
        if (c.chance(0.9)) image.ev_of = to;
        if (c.chance(0.9)) image.red_of = to;
        if (c.chance(0.9)) image.blue_of = to;
    }
    if (c.chance(0.8) && to < c.s.fit_images.size())
        c.s.fit_images[to].ev_of = c.s.fit_images[to].red_of = c.s.fit_images[to].blue_of = to;
}

inline void random_links(Case &c) {
    for (auto &image : c.s.fit_images) {
        uint32_t *fields[] = {&image.ev_of, &image.red_of, &image.blue_of};
        if (c.chance(0.3)) *fields[c.below(3)] = c.below(c.s.images);
    }
}

inline void link_out_of_range(Case &c) {
    auto &image = c.any_image();
    uint32_t *fields[] = {&image.ev_of, &image.red_of, &image.blue_of};
    *fields[c.below(3)] = odd_integer(c);
}

// Images.

inline void odd_size(Case &c) { (c.chance(0.5) ? c.any_image().width : c.any_image().height) = odd_integer(c); }

inline void smallest_frames(Case &c) {
    for (auto &image : c.s.fit_images) image.width = image.height = 1;
    for (auto &pair : c.s.pairs)
        for (auto &xy : pair.xy) xy[0] = xy[1] = c.uniform();
}

inline void largest_frames(Case &c) {
    for (auto &image : c.s.fit_images) image.width = 1u << 20, image.height = c.chance(0.5) ? 1u << 20 : 1;
    for (auto &pair : c.s.pairs)
        for (auto &xy : pair.xy) xy[0] *= 1e3, xy[1] = c.uniform();
}

inline void random_image_flags(Case &c) {
    for (auto &image : c.s.fit_images) image.free = c.below(8) * LENSPROF_FREE_EV;
    if (c.chance(0.1)) c.any_image().free = odd_integer(c);
}

inline void extreme_exposures(Case &c) {
    for (auto &image : c.s.fit_images) {
        image.exposure.ev = 40.0 * c.uniform() - 20.0;
        if (c.chance(0.5)) image.free = 0;
    }
}

inline void extreme_balances(Case &c) {
    for (auto &image : c.s.fit_images) {
        for (double &w : image.exposure.white_balance) w = std::pow(10.0, 12.0 * c.uniform() - 6.0);
        if (c.chance(0.5)) image.free &= LENSPROF_FREE_EV;
    }
}

inline void largest_exposures(Case &c) {
    for (auto &image : c.s.fit_images) image.exposure.ev = c.chance(0.5) ? -64.0 : 64.0, image.free = c.below(2) * 0xE0;
}

inline void odd_exposure(Case &c) {
    auto &exposure = c.any_image().exposure;
    (c.chance(0.5) ? exposure.ev : exposure.white_balance[c.below(3)]) = odd_number(c);
}

// Numbers of a pair.

inline void odd_value(Case &c) { c.any_pair().value[c.below(2)][c.below(3)] = odd_number(c); }

inline void odd_position(Case &c) { c.any_pair().xy[c.below(2)][c.below(2)] = odd_number(c); }

inline void odd_chroma_of_grey(Case &c) {
    c.options.channels = 1;
    for (auto &pair : c.s.pairs)
        for (auto &side : pair.value) side[1] = odd_number(c), side[2] = odd_number(c);
}

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
    c.options.camera_kind = c.below(3);
}

// Known exposures: the true ones, all alike, or anything.
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

struct Mutation {
    const char *name;
    void (*apply)(Case &c);
    uint32_t weight;  // how often
};

#define ROW(name, weight) \
    { #name, name, weight }
const Mutation kMutations[] = {
    ROW(one_pair_repeated, 3),
    ROW(one_grey_value, 4),
    ROW(black_and_white, 3),
    ROW(some_black_or_white, 3),
    ROW(noise_alone, 5),
    ROW(opposite_ends, 2),
    ROW(equal_ends, 2),
    ROW(dark, 3),
    ROW(one_position, 3),
    ROW(same_position_in_both, 2),
    ROW(corners, 4),
    ROW(duplicates, 3),
    ROW(images_without_pairs, 3),
    ROW(two_groups, 3),
    ROW(reference_without_pairs, 2),
    ROW(random_images, 3),
    ROW(same_image_twice, 1),
    ROW(image_out_of_range, 1),
    ROW(one_pair, 3),
    ROW(no_pairs, 1),
    ROW(one_image, 1),
    ROW(many_images, 1),
    ROW(link_all, 3),
    ROW(random_links, 4),
    ROW(link_out_of_range, 1),
    ROW(odd_size, 1),
    ROW(smallest_frames, 2),
    ROW(largest_frames, 2),
    ROW(random_image_flags, 4),
    ROW(extreme_exposures, 4),
    ROW(extreme_balances, 3),
    ROW(largest_exposures, 3),
    ROW(odd_exposure, 2),
    ROW(odd_value, 2),
    ROW(odd_position, 2),
    ROW(odd_chroma_of_grey, 2),
    ROW(grey, 4),
    ROW(odd_channels, 1),
    ROW(any_reference, 3),
    ROW(random_flags, 6),
    ROW(odd_flags, 1),
    ROW(any_modes, 4),
    ROW(automatic_modes, 2),
    ROW(any_loss, 2),
    ROW(any_huber, 3),
    ROW(no_prior, 6),
    ROW(any_prior, 3),
    ROW(paper, 3),
    ROW(odd_iterations, 1),
    ROW(many_iterations, 1),
    ROW(odd_struct_size, 1),
    ROW(odd_choices, 1),
    ROW(any_choices, 4),
    ROW(known_exposures, 4),
    ROW(odd_known_exposure, 1),
    ROW(any_vignetting, 4),
    ROW(odd_vignetting, 1),
    ROW(darkest_vignetting, 3),
    ROW(centre_outside, 3),
    ROW(nearly_flat_response, 3),
    ROW(step_response, 3),
    ROW(stairs_response, 3),
    ROW(odd_response, 1),
    ROW(cancelled, 2),
    ROW(null_pointer, 1),
};
#undef ROW

inline void mutate(Case &c) {
    uint32_t total = 0;
    for (const auto &m : kMutations) total += m.weight;
    for (uint32_t left = 1 + c.below(3); left > 0; left--) {
        uint32_t draw = c.below(total);
        const Mutation *m = kMutations;
        while (draw >= m->weight) draw -= m++->weight;
        if (c.s.pairs.empty() || c.s.fit_images.size() < 2) return;  // the others change what is no more
        c.what += std::string(c.what.empty() ? "" : " + ") + m->name;
        m->apply(c);
    }
}

}  // namespace malformed
