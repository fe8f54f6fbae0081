// Mutations of pairs, images and exposures.
#pragma once

#include "malformed_case.hpp"

namespace malformed {

inline void set_value(lensprof_pair &pair, double value) {
    for (auto &side : pair.value) side[0] = side[1] = side[2] = value;
}

// Pairs that are valid but carry little or no information.

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

// Which images are connected.

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

}  // namespace malformed
