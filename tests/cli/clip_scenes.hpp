// Frames of a camera whose exposure changes in front of a wall, and videos that ffmpeg makes of them.
#pragma once

#include "cli_runs.hpp"

namespace clip_scenes {

using namespace cli_runs;

constexpr uint32_t width = 320, height = 240;
constexpr double gamma_of_camera = 2.2, corner = 0.55;

// Even patches of all sizes with sharp rims, as light.
struct Wall {
    static constexpr uint32_t columns = 1200, rows = 300;
    std::vector<float> light = std::vector<float>(size_t(columns) * rows * 3, 0.15f);

    Wall() {
        uint32_t state = 7;
        const auto random = [&](uint32_t below) {
            state = state * 1664525u + 1013904223u;
            return (state >> 8) % below;
        };
        for (int patch = 0; patch < 2600; patch++) {
            const uint32_t left = random(columns), top = random(rows), w = 8 + random(36), h = 8 + random(36);
            const double level = 0.03 * std::exp2(random(1000) / 1000.0 * 4.3);
            const double tint[3] = {1.0, 0.8 + random(100) / 250.0, 0.8 + random(100) / 250.0};
            for (uint32_t y = top; y < std::min(rows, top + h); y++)
                for (uint32_t x = left; x < std::min(columns, left + w); x++)
                    for (size_t c = 0; c < 3; c++) light[(y * columns + x) * 3 + c] = float(level * tint[c]);
        }
    }

    double at(double x, double y, size_t c) const {
        const auto u = static_cast<size_t>(x), v = static_cast<size_t>(y);
        const double fx = x - double(u), fy = y - double(v);
        const auto l = [&](size_t a, size_t b) { return double(light[(b * columns + a) * 3 + c]); };
        return (1 - fy) * ((1 - fx) * l(u, v) + fx * l(u + 1, v))
               + fy * ((1 - fx) * l(u, v + 1) + fx * l(u + 1, v + 1));
    }
};

inline double true_ev(uint32_t i) { return 0.7 * std::sin(i / 8.0); }

inline double true_falloff(double x, double y) {
    const double u = x - (width - 1) / 2.0, v = y - (height - 1) / 2.0;
    return 1.0 - (1.0 - corner) * (u * u + v * v) / (0.25 * (width * width + height * height));
}

// The frame of a camera that moves by `step` px per frame.
inline Picture rendered(const Wall &wall, uint32_t i, double step, double gamma = gamma_of_camera) {
    Picture frame;
    frame.width = frame.frame_width = width, frame.height = frame.frame_height = height;
    frame.row_bytes = size_t(3) * width;
    frame.pixels.resize(frame.row_bytes * height);
    uint32_t state = i + 1;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            for (size_t c = 0; c < 3; c++) {
                const double light = wall.at(x + i * step, y + 20.0 + (step > 0.0 ? 15.0 * std::sin(i / 9.0) : 0.0), c)
                                     * true_falloff(x, y) * std::exp2(true_ev(i));
                state = state * 1664525u + 1013904223u;
                const double level = 255.0 * std::pow(std::min(light, 1.0), 1.0 / gamma) + (state >> 24) / 256.0;
                frame.pixels[y * frame.row_bytes + 3 * x + c] = static_cast<uint8_t>(std::min(level, 255.0));
            }
    return frame;
}

inline Picture rendered_black() {
    Picture frame;
    frame.width = frame.frame_width = width, frame.height = frame.frame_height = height;
    frame.row_bytes = size_t(3) * width;
    frame.pixels.resize(frame.row_bytes * height);
    return frame;
}

inline std::string frame_name(uint32_t i) {
    char name[32];
    std::snprintf(name, sizeof name, "%05u.png", i);
    return name;
}

// OUT/images with the frames and OUT/times.txt, with exposure times if `has_times`.
inline void write_frames(const std::string &name, uint32_t count, double step, bool has_times,
                         double gamma = gamma_of_camera) {
    static const Wall wall;
    fs::create_directories(folder / name / "images");
    std::ofstream times(in_folder(name) + "/times.txt");
    for (uint32_t i = 0; i < count; i++) {
        write_picture(in_folder(name) + "/images/" + frame_name(i), rendered(wall, i, step, gamma));
        times << i << " " << i / 25.0;
        if (has_times) times << " " << 10.0 * std::exp2(true_ev(i));
        times << "\n";
    }
}

inline int shell(const std::string &command) { return std::system((command + " </dev/null >/dev/null 2>&1").c_str()); }

inline std::string quoted(const std::string &name) { return "'" + in_folder(name) + "'"; }

// Encodes the frames of write_frames; skips the test without ffmpeg.
inline std::string encoded(const std::string &frames, const std::string &name, const std::string &options) {
    if (shell("ffmpeg -y -loglevel error -framerate 25 -i " + quoted(frames + "/images/%05d.png") + " " + options + " "
              + quoted(name)))
        skip();
    return in_folder(name);
}

}  // namespace clip_scenes
