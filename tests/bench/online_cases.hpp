// Clips for the benchmark of a camera that runs, drawn from a seed: motion, length of tracks, exposure, noise, response
// and falloff.
#pragma once

#include <cstdlib>
#include <cstring>

#include "../fit/simulated_video.hpp"

struct Case {
    VideoPlan plan;
    lensprof_response response;
    uint32_t kind = LENSPROF_CAMERA_ANY;
    uint32_t frames = 600;
};

// A gamma curve under a curve of contrast, x + s x (1 - x) (2 x - 1): EMoR's first modes do not contain it.
inline void set_contrast(double gamma, double s, lensprof_response *response) {
    double table[LENSPROF_RESPONSE_SAMPLES];
    for (int j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++) {
        const double x = std::pow(j / (LENSPROF_RESPONSE_SAMPLES - 1.0), 1.0 / gamma);
        table[j] = x + s * x * (1.0 - x) * (2.0 * x - 1.0);
    }
    if (lensprof_response_set_table(response, table, LENSPROF_RESPONSE_SAMPLES) != LENSPROF_OK) std::abort();
}

// A gamma curve with a shoulder, (1 + k) x / (x + k): a tone curve that compresses highlights.
inline void set_shoulder(double gamma, double k, lensprof_response *response) {
    double table[LENSPROF_RESPONSE_SAMPLES];
    for (int j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++) {
        const double x = std::pow(j / (LENSPROF_RESPONSE_SAMPLES - 1.0), 1.0 / gamma);
        table[j] = (1.0 + k) * x / (x + k);
    }
    if (lensprof_response_set_table(response, table, LENSPROF_RESPONSE_SAMPLES) != LENSPROF_OK) std::abort();
}

// A response of all modes about the typical one of cameras.
inline void draw_modes(Video &dice, lensprof_response *response) {
    lensprof_response typical;
    if (lensprof_response_set_typical(&typical, LENSPROF_CAMERA_STILL, nullptr, nullptr) != LENSPROF_OK) std::abort();
    const double scatter[12] = {0.6, 0.4, 0.15, 0.06, 0.05, 0.04, 0.03, 0.02, 0.02, 0.015, 0.01, 0.007};
    double emor[LENSPROF_EMOR_MODES];
    do {
        std::memcpy(emor, typical.emor, sizeof emor);
        for (int l = 0; l < 12; l++) emor[l] += scatter[l] * dice.normal();
    } while (lensprof_response_set_emor(response, emor, LENSPROF_EMOR_MODES) != LENSPROF_OK);
}

inline void draw_response(Video &dice, bool is_unseen, Case *c) {
    const double which = dice.random(), gamma = 1.8 + 0.6 * dice.random(), contrast = 0.8 * dice.random() - 0.9;
    if (which < 0.15) {
        lensprof_response_set_linear(&c->response), c->kind = LENSPROF_CAMERA_LINEAR;
    } else if (which < 0.4) {
        if (lensprof_response_set_gamma(&c->response, gamma) != LENSPROF_OK) std::abort();
    } else if (which < 0.65 && is_unseen) {
        set_shoulder(0.8 * gamma, 1.0 - contrast, &c->response);
    } else if (which < 0.65) {
        set_contrast(gamma, contrast, &c->response);
    } else {
        draw_modes(dice, &c->response);
    }
}

constexpr uint64_t kUnseen = 10000;  // seeds from here on were not used to choose the method and its limits

inline Case draw(uint64_t seed) {
    Case c;
    VideoPlan &plan = c.plan;
    lensprof_response_set_linear(&c.response);
    plan.seed = 0x51ED270B9F6Aull * (seed + 1);
    Video own(plan, c.response);
    plan.motion = static_cast<Motion>(static_cast<int>(3.0 * own.random()));
    plan.corner = 0.25 + 0.75 * own.random(), plan.edge = 0.4 * own.random() - 0.1;
    for (double &center : plan.center) center = 0.05 * own.normal();
    plan.tracks = 100 + static_cast<uint32_t>(400.0 * own.random());
    plan.speed = 3.0 + 9.0 * own.random();
    plan.lost = 0.002 + 0.05 * own.random() * own.random();
    const double course = own.random();
    plan.course = course < 0.5   ? Course::walk
                  : course < 0.7 ? Course::steps
                  : course < 0.9 ? Course::sinus
                                 : Course::fixed;
    plan.ev_range = 0.3 + 0.7 * own.random();
    plan.noise_levels = 0.5 + 2.5 * own.random(), plan.shot = 0.6 * own.random();
    plan.outliers = 0.3 * own.random();
    plan.known_sigma = own.random() < 0.6 ? 0.05 + 0.1 * own.random() : 0.0;
    draw_response(own, seed >= kUnseen, &c);
    return c;
}

// What a program knows of it beforehand.
inline lensprof_online_options options_for(const Case &c) {
    lensprof_online_options options = options_for(c.plan);
    options.camera_kind = c.kind;
    std::copy_n(c.plan.center, 2, options.center);
    return options;
}
