// What the fit of a camera that runs costs and how true its errors are, on simulated tracks with a known camera.
//   online [RUNS]      a table for docs/benchmark-results.md: CPU per frame, coverage over RUNS runs, drift
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <map>
#include <string>
#include <vector>

#include <lensprof/fit.h>

#include "online_cases.hpp"

namespace {

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

struct Coverages {
    Coverage corner, corner_known, corner_given, gamma, step, ratio;
};

// The corner's falloff at the true exponent: what tracks alone determine.
double exponent_of(const lensprof_response &response) {
    const double bright = lensprof_response_invert(&response, 208.0 / 255.0, nullptr);
    const double dark = lensprof_response_invert(&response, 48.0 / 255.0, nullptr);
    return std::log(bright / dark) / std::log(208.0 / 48.0);
}

void run(const Case &c, Coverages &all, bool prints) {
    Video video(c.plan, c.response);
    OnlineRun online(options_for(c));
    double before = 0.0, first = 0.0;
    for (uint32_t f = 0; f < c.frames; f++) {
        online.add(video, c.plan.known_sigma, 1);
        if (online.exposure.state == LENSPROF_ONLINE_FIRST) first = video.ev();
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

// The exposure of frame 2000 relative to frame 0, with known exposures.
void measure_drift(uint32_t runs) {
    const char *names[] = {"pan", "handheld", "forward"};
    for (int m = 0; m < 3; m++) {
        Coverage drift;
        for (uint32_t i = 0; i < runs; i++) {
            Case c = draw(kUnseen + 1000 + i);
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

// The tracks of every tenth frame of a clip for the batch fit.
struct Batch {
    std::vector<lensprof_fit_image> images;
    std::vector<lensprof_observation> tracks;

    void add(const Case &c, const Video &video, const lensprof_online_frame &frame) {
        const auto number = static_cast<uint32_t>(images.size());
        lensprof_fit_image image;
        lensprof_fit_image_init(&image, number, c.plan.width, c.plan.height);
        image.known_ev = video.known_ev(), image.known_ev_sigma = c.plan.known_sigma;
        images.push_back(image);
        for (uint32_t o = 0; o < frame.count; o++) {
            const lensprof_online_observation &seen = frame.observations[o];
            const double value = static_cast<double>(seen.value[0]);
            tracks.push_back({static_cast<uint32_t>(seen.track),
                              number,
                              {static_cast<double>(seen.x), static_cast<double>(seen.y)},
                              {value, value, value}});
        }
    }

    // M in the corner, and its standard error; 0 if the fit states no falloff.
    double corner(uint32_t kind, double *sigma) {
        std::map<uint32_t, uint32_t> views;
        for (const auto &o : tracks) views[o.point]++;
        tracks.erase(std::remove_if(tracks.begin(), tracks.end(), [&](const auto &o) { return views[o.point] < 2; }),
                     tracks.end());
        lensprof_fit_options options;
        lensprof_fit_options_init(&options);
        options.channels = 1, options.camera_kind = kind, options.method = LENSPROF_METHOD_RADIANCE;
        options.free &= ~LENSPROF_FREE_CENTER, options.threads = 1, options.modes = 6, options.vignettings = 1;
        std::vector<lensprof_exposure> exposures(images.size());
        lensprof_fit *fit = nullptr;
        static lensprof_profile profile;
        lensprof_profile_init(&profile);
        *sigma = 0.0;
        if (lensprof_fit_radiance(&options, images.data(), static_cast<uint32_t>(images.size()), tracks.data(),
                                  static_cast<uint32_t>(tracks.size()), nullptr, 0, exposures.data(), &fit, nullptr)
            != LENSPROF_OK)
            return 0.0;
        if (lensprof_fit_profile(fit, LENSPROF_FIT_REFERENCE, &profile, nullptr) != LENSPROF_OK) std::abort();
        lensprof_fit_destroy(fit);
        return lensprof_profile_corner_falloff(&profile, 0, sigma);
    }
};

// The batch fit `radiance` of every tenth frame, and the fit that ran, on the same clips, until enough have a falloff
// that both call certain.
void compare_with_batch(uint32_t wanted) {
    Coverage online_errors, batch_errors, differences;
    uint32_t clips = 0, uncertain[2] = {0, 0};
    double seconds[2] = {0.0, 0.0};
    for (; differences.count < wanted && clips < 8 * wanted; clips++) {
        Case c = draw(kUnseen + 2000 + clips);
        c.plan.known_sigma = 0.1, c.plan.outliers = 0.1, c.plan.center[0] = c.plan.center[1] = 0.0, c.frames = 300;
        Video video(c.plan, c.response);
        OnlineRun online(options_for(c));
        Batch batch;
        seconds[0] -= now();
        for (uint32_t f = 0; f < c.frames; f++) {
            online.add(video, c.plan.known_sigma, 1);
            if (f % 10 == 0) batch.add(c, video, online.frame);
        }
        seconds[0] += now(), seconds[1] -= now();
        double sigma;
        const double corner = batch.corner(c.kind, &sigma);
        seconds[1] += now();
        const lensprof_online_result r = online.result();
        const bool knows = r.known & LENSPROF_ONLINE_KNOWS_FALLOFF;
        uncertain[0] += !knows, uncertain[1] += !(sigma > 0.0);
        if (!knows || !(sigma > 0.0)) continue;
        online_errors.add(r.corner - c.plan.corner, r.corner_sigma), batch_errors.add(corner - c.plan.corner, sigma);
        differences.add(r.corner - corner, std::hypot(r.corner_sigma, sigma));
    }
    std::printf(
        "\n%u clips; the falloff is uncertain online in %u, and to the batch fit in %u; %.2f and %.2f s per clip\n",
        clips, uncertain[0], uncertain[1], seconds[0] / clips, seconds[1] / clips);
    std::printf(
        "\n| corner falloff M | cases | within 1 sigma | within 1.96 | median | 95 %% |\n|---|---|---|---|---|---|\n");
    online_errors.print("online and truth");
    batch_errors.print("batch and truth");
    differences.print("online and batch");
    std::fflush(stdout);
}

}  // namespace

int main(int count, char **arguments) {
    const uint32_t runs = count > 1 ? static_cast<uint32_t>(std::atoi(arguments[1])) : 200;
    const bool prints = count > 2;
    measure_cost();
    Coverages all;
    for (uint32_t i = 0; i < runs; i++) run(draw(kUnseen + i), all, prints);
    std::printf("\n| error of | cases | within 1 sigma | within 1.96 | median | 95 %% |\n|---|---|---|---|---|---|\n");
    all.step.print("exposure ratio to the frame before, EV");
    all.ratio.print("exposure ratio to frame 0 after 600 frames, EV");
    all.corner_known.print("corner falloff M, exposures known or a linear camera");
    all.corner.print("corner falloff M, exponent from the prior");
    all.corner_given.print("ln M in the corner at the true exponent");
    all.gamma.print("ln gamma, exposures known");
    std::fflush(stdout);
    compare_with_batch(std::max(runs / 5, 1u));
    std::printf("\n| drift over 2000 frames | runs | median EV | 95 %% EV |\n|---|---|---|---|\n");
    measure_drift(std::max(runs / 10, 1u));
}
