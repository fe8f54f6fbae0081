// A call of a fit that mutations change, and the numbers that they insert.
#pragma once

#include <limits>
#include <string>

#include "simulated.hpp"

namespace malformed {

const double kNone = std::numeric_limits<double>::quiet_NaN(), kInfinite = std::numeric_limits<double>::infinity();

struct Case : FitRun {
    uint64_t random;
    Simulation s;
    lensprof_response given;  // target of options.response, if it is set
    lensprof_fit_options options;
    lensprof_error error;
    bool null_options = false, null_images = false, null_pairs = false, null_exposures = false, null_result = false,
         null_error = false;
    int calls_left = -1;  // calls of progress before it cancels
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
    if (number % 20 == 9)
        for (auto &image : s.fit_images) image.known_ev = 4.0 * uniform(), image.known_ev_sigma = 0.1;
}

inline int count_down(double, void *user) {
    int &left = *static_cast<int *>(user);
    return left >= 0 && left-- == 0;
}

inline lensprof_status Case::run() {
    if (calls_left >= 0) options.progress = count_down, options.progress_user = &calls_left;
    exposures.resize(s.fit_images.size());  // exactly as many as announced: a sanitizer detects any more
    if (!exposures.empty())
        std::memset(static_cast<void *>(exposures.data()), 0xFF, exposures.size() * sizeof exposures[0]);
    held.reset();
    memory.clear();
    if (chance(0.5))  // exactly as much as needed, with anything in it
        memory.assign(lensprof_fit_bytes(s.fit_images.data(), static_cast<uint32_t>(s.fit_images.size())) / 8,
                      0x5A5A5A5A5A5A5A5Aull);
    lensprof_fit *fit = nullptr;
    const lensprof_status status = lensprof_fit_overlap(
        null_options ? nullptr : &options, null_images ? nullptr : s.fit_images.data(),
        static_cast<uint32_t>(s.fit_images.size()), null_pairs ? nullptr : s.pairs.data(),
        static_cast<uint32_t>(s.pairs.size()), memory.empty() ? nullptr : memory.data(), 8 * memory.size(),
        null_exposures ? nullptr : exposures.data(), null_result ? nullptr : &fit, null_error ? nullptr : &error);
    if (status == LENSPROF_OK)
        take(fit);
    else
        assert_null(fit);
    return status;
}

// Numbers at and beyond every limit.
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

}  // namespace malformed
