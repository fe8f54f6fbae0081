// Simulated tracks of a camera that moves, with known response, falloff and exposures, frame by frame. Uses the public
// API only: tests and tests/bench/online.cpp include it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <lensprof/online.h>

enum class Motion {
    pan,
    handheld,
    forward,
    still
};

// How the exposure of a clip changes.
enum class Course {
    walk,  // automatic exposure: a random walk
    steps,
    sinus,
    fixed
};

struct VideoPlan {
    uint64_t seed = 1;
    uint32_t width = 640, height = 480, channels = 1;
    uint32_t tracks = 300;
    Motion motion = Motion::pan;
    double speed = 6.0;   // px per frame; handheld: the size of a sway
    double lost = 0.01;   // share of tracks that the tracker loses per frame
    double corner = 0.6;  // M in the corner
    double edge = 0.0;    // share of the falloff that rises with r^6
    double center[2] = {0.0, 0.0};
    Course course = Course::walk;
    double ev_range = 1.0;  // of the exposure, either side; 0: constant
    double noise_levels = 2.0;
    double shot = 0.0;       // share of the variance of the noise that rises with the grey value
    double outliers = 0.1;   // share of observations that show something else
    double known_sigma = 0;  // of known exposures, EV; 0: none
};

class Video {
public:
    Video(const VideoPlan &plan, const lensprof_response &response)
        : plan_(plan), response_(response), state_(plan.seed) {
        const double loss = 1.0 - plan.corner, bend = 0.4 * random() - 0.2;  // of the profile of the falloff
        falloff_ = {{-loss * (1.0 - bend - plan.edge), -loss * bend, -loss * plan.edge},
                    {plan.center[0], plan.center[1]}};
        for (uint32_t i = 0; i < plan.tracks; i++) points_.push_back(appear(false));
        velocity_[0] = plan.speed, velocity_[1] = plan.speed * (0.6 * random() - 0.3);
    }

    const lensprof_vignetting &falloff() const { return falloff_; }
    double ev() const { return ev_; }
    double known_ev() const { return known_ev_; }
    double balance(uint32_t channel) const { return balance_[channel]; }

    // The observations of the next frame; valid until the one after.
    const std::vector<lensprof_online_observation> &next() {
        if (frame_++) move();
        seen_.clear();
        for (Point &p : points_) see(p);
        known_ev_ = ev_ + 3.0 + plan_.known_sigma * normal();
        return seen_;
    }

    double random() {  // SplitMix64
        uint64_t x = state_ += 0x9E3779B97F4A7C15ull;
        x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull, x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
        return static_cast<double>((x ^ (x >> 31)) >> 11) * 0x1p-53;
    }
    double normal() { return std::sqrt(-2.0 * std::log(1.0 - random())) * std::cos(6.283185307179586 * random()); }

private:
    struct Point {
        uint64_t id;
        double x, y, radiance[3];
        bool is_wrong;
    };

    Point appear(bool at_edge) {
        Point p{next_id_++, random() * plan_.width - 0.5, random() * plan_.height - 0.5, {}, false};
        if (at_edge && plan_.motion == Motion::pan)
            p.x = velocity_[0] > 0.0 ? random() * plan_.speed : plan_.width - 1.0 - random() * plan_.speed;
        if (at_edge && plan_.motion == Motion::forward)
            p.x = 0.5 * plan_.width + 0.5 * (p.x - 0.5 * plan_.width),
            p.y = 0.5 * plan_.height + 0.5 * (p.y - 0.5 * plan_.height);
        const double base = std::exp(-3.5 * random());
        for (double &l : p.radiance) l = base * (plan_.channels == 3 ? std::exp(0.5 * (random() - 0.5)) : 1.0);
        return p;
    }

    void expose() {
        const double range = plan_.ev_range;
        if (plan_.course == Course::walk) ev_ += 0.04 * range * normal() - 0.001 * ev_;
        if (plan_.course == Course::steps && random() < 0.03) ev_ = range * (2.0 * random() - 1.0);
        if (plan_.course == Course::sinus) ev_ = range * std::sin(0.03 * static_cast<double>(frame_));
        ev_ = std::clamp(ev_, -range, range);
    }

    void move() {
        expose();
        if (plan_.channels == 3)
            for (int c = 0; c < 3; c += 2) balance_[c] *= std::exp(0.004 * normal());
        if (plan_.motion == Motion::pan && random() < 0.005) velocity_[0] = -velocity_[0];
        double shift[2] = {0.0, 0.0};
        if (plan_.motion == Motion::pan) shift[0] = velocity_[0], shift[1] = velocity_[1] * std::sin(0.05 * frame_);
        if (plan_.motion == Motion::handheld)
            for (double &d : sway_) {
                const double before = d;
                d = 0.98 * d + 0.2 * plan_.speed * normal();
                shift[&d - sway_] = d - before;
            }
        const double zoom = plan_.motion == Motion::forward ? 1.0 + 0.002 * plan_.speed : 1.0;
        for (Point &p : points_) {
            p.x = 0.5 * plan_.width + zoom * (p.x - 0.5 * plan_.width) + shift[0];
            p.y = 0.5 * plan_.height + zoom * (p.y - 0.5 * plan_.height) + shift[1];
            const bool is_out = !(p.x >= -0.5 && p.x < plan_.width - 0.5 && p.y >= -0.5 && p.y < plan_.height - 0.5);
            if (is_out || random() < plan_.lost) p = appear(is_out);
            p.is_wrong = random() < (p.is_wrong ? 0.8 : 0.2 * plan_.outliers / std::max(1.0 - plan_.outliers, 0.1));
        }
    }

    void see(Point &p) {
        lensprof_online_observation o{p.id, static_cast<float>(p.x), static_cast<float>(p.y), {}, 1.0f};
        const double r2 = lensprof_vignetting_r2(&falloff_, plan_.width, plan_.height, p.x, p.y, nullptr);
        const double light = lensprof_vignetting_eval(&falloff_, r2, nullptr) * std::exp2(ev_);
        for (uint32_t c = 0; c < plan_.channels; c++) {
            const double l = p.is_wrong ? std::exp(-3.5 * random()) : p.radiance[c];
            const double f = lensprof_response_eval(&response_, l * light * balance_[c], nullptr),
                         b = f + plan_.noise_levels / 255.0 * std::sqrt(1.0 + plan_.shot * (2.0 * f - 1.0)) * normal();
            o.value[c] = static_cast<float>(std::round(std::clamp(b, 0.0, 1.0) * 1020.0) / 1020.0);  // a mean of pixels
        }
        seen_.push_back(o);
    }

    VideoPlan plan_;
    lensprof_response response_;
    uint64_t state_, next_id_ = 1, frame_ = 0;
    lensprof_vignetting falloff_{};
    std::vector<Point> points_;
    std::vector<lensprof_online_observation> seen_;
    double velocity_[2] = {0.0, 0.0}, sway_[2] = {0.0, 0.0}, ev_ = 0.0, known_ev_ = 0.0, balance_[3] = {1.0, 1.0, 1.0};
};

// A camera that runs, in memory of its own.
class OnlineRun {
public:
    explicit OnlineRun(const lensprof_online_options &options) : memory_(lensprof_online_bytes(&options) / 8 + 1) {
        status = lensprof_online_begin(memory_.data(), memory_.size() * 8, &options, &online, nullptr);
        lensprof_online_exposure_init(&exposure);
        lensprof_online_frame_init(&frame);
    }

    // Adds the next frame of a video, then takes steps of the fit.
    void add(Video &video, double known_sigma, uint32_t steps) {
        const auto &seen = video.next();
        frame.number++, frame.count = static_cast<uint32_t>(seen.size()), frame.observations = seen.data();
        frame.known_ev = video.known_ev(), frame.known_ev_sigma = known_sigma;
        if (status == LENSPROF_OK) status = lensprof_online_add(online, &frame, &exposure, nullptr);
        if (status == LENSPROF_OK) status = lensprof_online_solve(online, steps, nullptr, nullptr);
    }

    lensprof_online_result result() const {
        lensprof_online_result result;
        lensprof_online_result_init(&result);
        if (lensprof_online_get(online, &result, nullptr) != LENSPROF_OK) result.frames = 0;
        return result;
    }

    lensprof_status status;
    lensprof_online *online = nullptr;
    lensprof_online_exposure exposure;
    lensprof_online_frame frame;

private:
    std::vector<uint64_t> memory_;
};

inline lensprof_online_options options_for(const VideoPlan &plan) {
    lensprof_online_options options;
    lensprof_online_options_init(&options);
    options.width = plan.width, options.height = plan.height, options.channels = plan.channels;
    options.tracks = plan.tracks;
    return options;
}
