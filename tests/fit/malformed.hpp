// A well-formed problem for the overlap fit, and a table of mutations that make it malformed or degenerate.
#pragma once

#include "malformed_options.hpp"
#include "malformed_pairs.hpp"

namespace malformed {

struct Mutation {
    const char *name;
    void (*apply)(Case &c);
    uint32_t weight;  // relative frequency
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
        if (c.s.pairs.empty() || c.s.fit_images.size() < 2) return;  // the other mutations need pairs and images
        c.what += std::string(c.what.empty() ? "" : " + ") + m->name;
        m->apply(c);
    }
}

}  // namespace malformed
