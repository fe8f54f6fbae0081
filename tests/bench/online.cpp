// What the fit of a camera that runs costs and how true its errors are, on simulated tracks with a known camera.
//   online [RUNS]      a table for docs/benchmark-results.md: CPU per frame, coverage over RUNS runs, drift
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

#include <lensprof/fit.h>

#include "../fit/simulated_video.hpp"

namespace {

constexpr uint64_t kReported = 10000;  // first seed of the reported runs; limits were chosen on those below 100

// How often errors lie within one and two stated standard errors, and how large they are.
struct Coverage {
    double count = 0, within1 = 0, within2 = 0;
    std::vector<double> errors;
    void add(double error, double sigma) {
        count++, within1 += std::abs(error) <= sigma, within2 += std::abs(error) <= 1.96 * sigma;
        errors.push_back(std::abs(error));
    }
    void print(const char *name) {
        std::sort(errors.begin(), errors.end());
        if (errors.empty()) return;
        std::printf("| %s | %.0f | %.0f %% | %.0f %% | %.4f | %.4f |\n", name, count, 100 * within1 / count,
                    100 * within2 / count, errors[errors.size() / 2], errors[errors.size() * 95 / 100]);
    }
};

struct Case {
    VideoPlan plan;
    lensprof_response response;
    uint32_t kind = LENSPROF_CAMERA_ANY;
    uint32_t frames = 600;
};

// A response of an ordinary camera: a gamma curve, or a tone curve whose EMoR modes differ from the typical ones.
void draw_response(Video &dice, Case &c) {
    const double which = dice.random();
    const double gamma = 1.8 + 0.6 * dice.random();
    if (which < 0.15) {
        lensprof_response_set_linear(&c.response), c.kind = LENSPROF_CAMERA_LINEAR;
    } else if (which < 0.5) {
        if (lensprof_response_set_gamma(&c.response, gamma) != LENSPROF_OK) std::abort();
    } else {
        lensprof_response typical;
        if (lensprof_response_set_typical(&typical, LENSPROF_CAMERA_STILL, nullptr, nullptr) != LENSPROF_OK)
            std::abort();
        double emor[LENSPROF_EMOR_MODES];
        do {
            std::memcpy(emor, typical.emor, sizeof emor);
            const double scatter[4] = {0.6, 0.4, 0.15, 0.06};
            for (int l = 0; l < 4; l++) emor[l] += scatter[l] * dice.normal();
        } while (lensprof_response_set_emor(&c.response, emor, LENSPROF_EMOR_MODES) != LENSPROF_OK);
    }
}

Case draw(uint64_t seed) {
    Case c;
    VideoPlan &plan = c.plan;
    lensprof_response_set_linear(&c.response);
    plan.seed = 0x51ED270B9F6Aull * (seed + 1);
    Video own(plan, c.response);
    plan.motion = static_cast<Motion>(static_cast<int>(3.0 * own.random()));
    plan.corner = 0.3 + 0.7 * own.random();
    plan.tracks = 100 + static_cast<uint32_t>(400.0 * own.random());
    plan.speed = 3.0 + 9.0 * own.random();
    plan.lost = 0.002 + 0.05 * own.random() * own.random();
    plan.ev_range = 0.3 + 0.7 * own.random();
    plan.noise_levels = 1.0 + 2.0 * own.random();
    plan.outliers = 0.3 * own.random();
    plan.known_sigma = own.random() < 0.6 ? 0.05 + 0.1 * own.random() : 0.0;
    draw_response(own, c);
    return c;
}

struct Coverages {
    Coverage corner, corner_known, corner_given, gamma, step, ratio, drift;
};

// The corner's falloff at the true exponent: what tracks alone determine.
double exponent_of(const lensprof_response &response) {
    const double bright = lensprof_response_invert(&response, 208.0 / 255.0, nullptr);
    const double dark = lensprof_response_invert(&response, 48.0 / 255.0, nullptr);
    return std::log(bright / dark) / std::log(208.0 / 48.0);
}

void run(const Case &c, Coverages &all, bool prints) {
    Video video(c.plan, c.response);
    lensprof_online_options options = options_for(c.plan);
    options.camera_kind = c.kind;
    OnlineRun online(options);
    double before = 0.0, first = 0.0;
    for (uint32_t f = 0; f < c.frames; f++) {
        online.add(video, c.plan.known_sigma, 1);
        if (f == 0) first = video.ev();
        if (f >= 100 && f % 50 == 0 && online.exposure.state == LENSPROF_ONLINE_CHAINED)
            all.step.add(online.exposure.step_ev - (video.ev() - before), online.exposure.step_sigma);
        before = video.ev();
    }
    const lensprof_online_result r = online.result();
    const double gamma = exponent_of(c.response);
    all.ratio.add(online.exposure.ev - (video.ev() - first), online.exposure.ev_sigma);
    (c.plan.known_sigma > 0.0 || c.kind == LENSPROF_CAMERA_LINEAR ? all.corner_known : all.corner)
        .add(r.corner - c.plan.corner, r.corner_sigma);
    all.corner_given.add(std::log(r.corner) * gamma / r.gamma - std::log(c.plan.corner), r.falloff_sigma);
    if (c.plan.known_sigma > 0.0 && c.kind != LENSPROF_CAMERA_LINEAR)
        all.gamma.add(std::log(r.gamma / gamma), r.log_gamma_sigma);
    if (prints)
        std::printf(
            "motion %d corner %.2f gamma %.2f tracks %u noise %.1f out %.2f known %.2f lost %.3f speed %.1f kind %u | corner %.3f (%.3f) z %+.1f | given %+.4f (%.4f) z %+.1f | gamma %.2f (%.3f) z %+.1f | ev %+.3f (%.3f) z %+.1f\n",
            static_cast<int>(c.plan.motion), c.plan.corner, gamma, c.plan.tracks, c.plan.noise_levels, c.plan.outliers,
            c.plan.known_sigma, c.plan.lost, c.plan.speed, c.kind, r.corner, r.corner_sigma,
            (r.corner - c.plan.corner) / r.corner_sigma, std::log(r.corner) * gamma / r.gamma - std::log(c.plan.corner),
            r.falloff_sigma, (std::log(r.corner) * gamma / r.gamma - std::log(c.plan.corner)) / r.falloff_sigma,
            r.gamma, r.log_gamma_sigma, std::log(r.gamma / gamma) / std::max(r.log_gamma_sigma, 1e-9),
            online.exposure.ev - (video.ev() - first), online.exposure.ev_sigma,
            (online.exposure.ev - (video.ev() - first)) / online.exposure.ev_sigma);
}

// Seconds of processor time.
double now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void measure_cost() {
    VideoPlan plan;
    plan.tracks = 500, plan.known_sigma = 0.1;
    lensprof_response response;
    if (lensprof_response_set_gamma(&response, 2.2) != LENSPROF_OK) std::abort();
    Video video(plan, response);
    OnlineRun online(options_for(plan));
    double add = 0.0, solve = 0.0, longest = 0.0;
    const uint32_t frames = 2000;
    for (uint32_t f = 0; f < frames; f++) {
        const double a = now();
        online.add(video, plan.known_sigma, 0);
        const double b = now();
        if (lensprof_online_solve(online.online, 1, nullptr, nullptr) != LENSPROF_OK) std::abort();
        const double c = now();
        add += b - a, solve += c - b, longest = std::max(longest, c - a);
    }
    const lensprof_online_options options = options_for(plan);
    std::printf(
        "500 tracks, 640 x 480: with the simulation, add %.3f ms, solve %.3f ms per frame, at most %.1f ms; %.1f %% of a core at 30 frames/s; "
        "%zu bytes\n",
        1e3 * add / frames, 1e3 * solve / frames, 1e3 * longest, 3e3 * (add + solve) / frames,
        lensprof_online_bytes(&options));
}

// The exposure of frame 2000 relative to frame 0.
void measure_drift(uint32_t runs) {
    const char *names[] = {"pan", "handheld", "forward"};
    for (int m = 0; m < 3; m++) {
        Coverage drift;
        for (uint32_t i = 0; i < runs; i++) {
            Case c = draw(1000 + i);
            c.plan.motion = static_cast<Motion>(m), c.frames = 2000, c.plan.known_sigma = 0.1;
            Coverages all;
            run(c, all, false);
            drift.add(all.ratio.errors[0], 0.0);
        }
        std::sort(drift.errors.begin(), drift.errors.end());
        std::printf("| %s | %u | %.4f | %.4f |\n", names[m], runs, drift.errors[runs / 2],
                    drift.errors[runs * 95 / 100]);
    }
}

// The batch fit `radiance` of every tenth frame, and the fit that ran, on the same clips.
void compare_with_batch(uint32_t runs) {
    std::printf(
        "\n| true M in the corner | online | batch | online at the exponent of batch | difference / joint error | "
        "seconds online, batch |\n|---|---|---|---|---|---|\n");
    for (uint32_t i = 0; i < runs; i++) {
        Case c = draw(2000 + i);
        c.plan.known_sigma = 0.1, c.plan.tracks = 200, c.plan.outliers = 0.1, c.frames = 300;
        Video video(c.plan, c.response);
        lensprof_online_options options = options_for(c.plan);
        options.camera_kind = c.kind;
        OnlineRun online(options);
        std::vector<lensprof_fit_image> images;
        std::vector<lensprof_observation> tracks;
        double seconds = -now();
        for (uint32_t f = 0; f < c.frames; f++) {
            online.add(video, c.plan.known_sigma, 1);
            if (f % 10) continue;
            lensprof_fit_image image;
            lensprof_fit_image_init(&image, static_cast<uint32_t>(images.size()), c.plan.width, c.plan.height);
            image.known_ev = video.known_ev(), image.known_ev_sigma = c.plan.known_sigma;
            for (uint32_t o = 0; o < online.frame.count; o++) {
                const lensprof_online_observation &seen = online.frame.observations[o];
                const double value = static_cast<double>(seen.value[0]);
                tracks.push_back({static_cast<uint32_t>(seen.track),
                                  static_cast<uint32_t>(images.size()),
                                  {static_cast<double>(seen.x), static_cast<double>(seen.y)},
                                  {value, value, value}});
            }
            images.push_back(image);
        }
        seconds += now();
        std::vector<uint32_t> views(4000000, 0);
        for (const auto &o : tracks) views[o.point]++;
        tracks.erase(std::remove_if(tracks.begin(), tracks.end(), [&](const auto &o) { return views[o.point] < 2; }),
                     tracks.end());
        lensprof_fit_options batch;
        lensprof_fit_options_init(&batch);
        batch.channels = 1, batch.camera_kind = c.kind, batch.method = LENSPROF_METHOD_RADIANCE, batch.vignettings = 1;
        batch.free &= ~LENSPROF_FREE_CENTER, batch.threads = 1, batch.modes = 6;
        std::vector<lensprof_exposure> exposures(images.size());
        lensprof_fit *fit = nullptr;
        lensprof_error error;
        double batch_seconds = -now();
        if (lensprof_fit_radiance(&batch, images.data(), static_cast<uint32_t>(images.size()), tracks.data(),
                                  static_cast<uint32_t>(tracks.size()), nullptr, 0, exposures.data(), &fit, &error)
            != LENSPROF_OK) {
            std::printf("| %.2f | %s |\n", c.plan.corner, error.text);
            continue;
        }
        batch_seconds += now();
        static lensprof_profile profile;
        lensprof_profile_init(&profile);
        double sigma = 0.0;
        if (lensprof_fit_profile(fit, LENSPROF_FIT_REFERENCE, &profile, &error) != LENSPROF_OK) std::abort();
        const double corner = lensprof_profile_corner_falloff(&profile, 0, &sigma);
        const lensprof_online_result r = online.result();
        if (!(sigma > 0.0)) {
            std::printf("| %.3f | %.3f +- %.3f | no falloff: not certain | | | %.2f, %.1f |\n", c.plan.corner, r.corner,
                        r.corner_sigma, seconds, batch_seconds);
            lensprof_fit_destroy(fit);
            continue;
        }
        const double ratio = exponent_of(profile.response[0]) / r.gamma, raised = std::pow(r.corner, ratio);
        std::printf("| %.3f | %.3f +- %.3f | %.3f +- %.3f | %.3f | %.1f | %.2f, %.1f |\n", c.plan.corner, r.corner,
                    r.corner_sigma, corner, sigma, raised, (r.corner - corner) / std::hypot(r.corner_sigma, sigma),
                    seconds, batch_seconds);
        std::fflush(stdout);
        lensprof_fit_destroy(fit);
    }
}

}  // namespace

int main(int count, char **arguments) {
    const uint32_t runs = count > 1 ? static_cast<uint32_t>(std::atoi(arguments[1])) : 200;
    const bool prints = count > 2;
    measure_cost();
    Coverages all;
    for (uint32_t i = 0; i < runs; i++) run(draw(kReported + i), all, prints);
    std::printf("\n| error of | cases | within 1 sigma | within 1.96 | median | 95 %% |\n|---|---|---|---|---|---|\n");
    all.step.print("exposure ratio to the frame before, EV");
    all.ratio.print("exposure ratio to frame 0 after 600 frames, EV");
    all.corner_known.print("corner falloff M, exposures known or a linear camera");
    all.corner.print("corner falloff M, exponent from the prior");
    all.corner_given.print("ln M in the corner at the true exponent");
    all.gamma.print("ln gamma, exposures known");
    std::fflush(stdout);
    compare_with_batch(std::max(runs / 20, 1u));
    std::printf("\n| drift over 2000 frames | runs | median EV | 95 %% EV |\n|---|---|---|---|\n");
    measure_drift(std::max(runs / 10, 1u));
}
