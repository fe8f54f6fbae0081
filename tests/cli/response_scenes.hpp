// Raw files and the JPEGs that a simulated camera renders from them, with known response, colours and falloff.
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "cli/simulate/simulated_scene.hpp"

#include "picture_files.hpp"
#include "raw_files.hpp"

namespace response_scenes {

using namespace picture_files;

using Colour = std::array<double, 3>;

// How the camera renders.
struct Shot {
    uint32_t width = 900, height = 600;  // of the sensor
    lensprof_response response{};
    double white_ev = 0.3;             // EV between the rendering's white and the sensor's saturation
    double exposure = 1.0;             // of the scene; at 1 its mid-grey is near a sixth of the rendering's white
    double mixing = 0.5;               // off-diagonal weight of the colour matrix; 0 = none
    Colour balance = {2.0, 1.0, 1.6};  // gains of the channels
    Colour falloff = {-0.40, 0.10, -0.05};
    bool corrects = false;    // whether it corrects the falloff before the curve
    double local_ev = 0.0;    // gain of tones that depends on the mean of their surroundings
    double saturation = 0.0;  // change of colours after the curve
    double sharpen = 0.3;
    double noise = 0.0015,
           shot_noise = 0.01;  // of a photosite: constant, and proportional to the square root of the light
    double crop = 0.01;        // share cropped at every edge
    double bend = 0.0;         // k1 of the distortion that the rendering corrects
    uint32_t rendered_width = 800;
    int quarter_turns = 0;  // of the rendering
    JpegKind jpeg = {92, 2, 2};
    lensprof::SimulatedKind scene = lensprof::SimulatedKind::landscape;
    uint32_t seed = 1;
    bool monochrome = false;
};

struct Field {
    uint32_t width, height;
    std::vector<Colour> values;
    Colour &at(uint32_t x, uint32_t y) { return values[size_t(y) * width + x]; }
    Colour between(double x, double y) const {
        x = std::clamp(x, 0.0, width - 1.001), y = std::clamp(y, 0.0, height - 1.001);
        const auto i = static_cast<size_t>(x), j = static_cast<size_t>(y);
        const double u = x - double(i), v = y - double(j);
        const Colour *a = &values[j * width + i], *b = a + width;
        Colour out;
        for (size_t c = 0; c < 3; c++)
            out[c] = (a[0][c] * (1 - u) + a[1][c] * u) * (1 - v) + (b[0][c] * (1 - u) + b[1][c] * u) * v;
        return out;
    }
};

inline double radius2(double x, double y, uint32_t width, uint32_t height) {
    const double dx = x - (width - 1) / 2.0, dy = y - (height - 1) / 2.0;
    return 4.0 * (dx * dx + dy * dy) / (double(width) * width + double(height) * height);
}

inline double falloff_of(const Shot &shot, double r2) {
    return 1.0 + r2 * (shot.falloff[0] + r2 * (shot.falloff[1] + r2 * shot.falloff[2]));
}

// Neutral colours stay neutral.
inline Colour mixed(const Shot &shot, const Colour &in) {
    const double m = shot.mixing;
    return {(1 + m) * in[0] - 0.8 * m * in[1] - 0.2 * m * in[2],
            -0.3 * m * in[0] + (1 + 0.6 * m) * in[1] - 0.3 * m * in[2],
            -0.1 * m * in[0] - 0.9 * m * in[1] + (1 + m) * in[2]};
}

// The light on the sensor, relative to its saturation; not clipped.
inline Field sensor_light(const Shot &shot) {
    Field field{shot.width, shot.height, std::vector<Colour>(size_t(shot.width) * shot.height)};
    const lensprof::SimulatedScene scene(shot.seed, shot.scene);
    const double per_px = 1.0 / shot.width;
    for (uint32_t y = 0; y < shot.height; y++)
        for (uint32_t x = 0; x < shot.width; x++) {
            Colour &out = field.at(x, y);
            scene.radiance((x - shot.width / 2.0) * per_px + 0.3, (y - shot.height / 2.0) * per_px, out.data());
            // Neutral light is white at 2^-white_ev of the saturation of the channel that saturates first.
            const double gain =
                shot.exposure * std::exp2(-shot.white_ev) * falloff_of(shot, radius2(x, y, shot.width, shot.height));
            const double least = *std::min_element(shot.balance.begin(), shot.balance.end());
            if (shot.monochrome) out = {out[1], out[1], out[1]};
            for (size_t c = 0; c < 3; c++) out[c] *= gain * (shot.monochrome ? 1.0 : least / shot.balance[c]);
        }
    return field;
}

// The mosaic of 14 bits, with noise.
inline raw_files::Dng mosaic_of(const Shot &shot, Field light) {
    raw_files::Dng dng;
    dng.width = shot.width, dng.height = shot.height, dng.bits = 14, dng.white = 16383, dng.black = {512};
    dng.values.reserve(size_t(shot.width) * shot.height);
    std::mt19937 random(shot.seed + 77);
    std::normal_distribution<double> normal;
    for (uint32_t y = 0; y < shot.height; y++)
        for (uint32_t x = 0; x < shot.width; x++) {
            const double value = light.at(x, y)[dng.pattern[y % 2 * 2 + x % 2]];
            const double noisy =
                value + normal(random) * (shot.noise + shot.shot_noise * std::sqrt(std::max(value, 0.0)) * 0.5);
            dng.values.push_back(
                static_cast<uint16_t>(std::clamp(std::lround(512 + noisy * (16383 - 512)), 0l, 16383l)));
        }
    return dng;
}

// The missing channels: means of the neighbours that have them.
inline Field demosaiced(const raw_files::Dng &dng) {
    Field field{dng.width, dng.height, std::vector<Colour>(size_t(dng.width) * dng.height)};
    for (int y = 0; y < int(dng.height); y++)
        for (int x = 0; x < int(dng.width); x++) {
            Colour sum = {0, 0, 0}, count = {0, 0, 0};
            for (int v = std::max(y - 1, 0); v <= std::min(y + 1, int(dng.height) - 1); v++)
                for (int u = std::max(x - 1, 0); u <= std::min(x + 1, int(dng.width) - 1); u++) {
                    const size_t c = dng.pattern[size_t(v % 2 * 2 + u % 2)];
                    const double weight = (u == x ? 2.0 : 1.0) * (v == y ? 2.0 : 1.0);
                    sum[c] += weight * (dng.values[size_t(v) * dng.width + size_t(u)] - 512.0) / (16383.0 - 512.0);
                    count[c] += weight;
                }
            for (size_t c = 0; c < 3; c++) field.at(uint32_t(x), uint32_t(y))[c] = sum[c] / count[c];
        }
    return field;
}

// At the size of the rendering: linear light with white at 1, in the output colours.
inline Field linear_rendering(const Shot &shot, const Field &full) {
    const double kept = 1.0 - 2.0 * shot.crop, reduction = kept * shot.width / shot.rendered_width;
    Field out{shot.rendered_width, uint32_t(std::lround(kept * shot.height / reduction)), {}};
    out.values.resize(size_t(out.width) * out.height);
    const int steps = std::max(1, int(std::ceil(reduction)));
    const double rho = std::hypot(shot.width, shot.height) / 2.0, white = std::exp2(shot.white_ev);
    const double least = *std::min_element(shot.balance.begin(), shot.balance.end());
    for (uint32_t y = 0; y < out.height; y++)
        for (uint32_t x = 0; x < out.width; x++) {
            Colour sum = {0, 0, 0};
            for (int i = 0; i < steps * steps; i++) {
                const double u = (x + 0.5 + (i % steps + 0.5) / steps - 0.5 - out.width / 2.0) * reduction / rho;
                const double v = (y + 0.5 + (i / steps + 0.5) / steps - 0.5 - out.height / 2.0) * reduction / rho;
                const double bent = 1.0 + shot.bend * (u * u + v * v);
                const double fx = (shot.width - 1) / 2.0 + rho * u * bent,
                             fy = (shot.height - 1) / 2.0 + rho * v * bent;
                const Colour part = full.between(fx, fy);
                const double gain =
                    shot.corrects ? 1.0 / falloff_of(shot, radius2(fx, fy, shot.width, shot.height)) : 1.0;
                for (size_t c = 0; c < 3; c++)
                    sum[c] += std::min(part[c], 1.0) * gain * white * (shot.monochrome ? 1.0 : shot.balance[c] / least)
                              / (steps * steps);
            }
            out.at(x, y) = shot.monochrome ? sum : mixed(shot, sum);
        }
    return out;
}

// Brightens dark surroundings and darkens bright ones, as D-Lighting and similar functions do.
inline void map_locally(const Shot &shot, Field &field) {
    if (shot.local_ev == 0.0) return;
    const int radius = int(field.width) / 12;
    Field copy = field;
    for (int y = 0; y < int(field.height); y++)
        for (int x = 0; x < int(field.width); x++) {
            double sum = 0, count = 0;
            for (int v = y - radius; v <= y + radius; v += radius / 4)
                for (int u = x - radius; u <= x + radius; u += radius / 4)
                    sum += std::log2(std::max(copy.between(u, v)[1], 0.002)), count++;
            const double ev = -shot.local_ev * std::tanh((sum / count + 2.8) / 2.0);
            for (double &v : field.at(uint32_t(x), uint32_t(y))) v *= std::exp2(ev);
        }
}

inline Picture rendered_of(const Shot &shot, const Field &full) {
    Field field = linear_rendering(shot, full);
    map_locally(shot, field);
    for (Colour &pixel : field.values) {
        for (double &v : pixel) v = lensprof_response_eval(&shot.response, v, nullptr);
        const double grey = 0.3 * pixel[0] + 0.59 * pixel[1] + 0.11 * pixel[2];
        for (double &v : pixel) v += shot.saturation * (v - grey);
    }
    Picture picture;
    picture.layout = shot.monochrome ? LENSPROF_LAYOUT_GREY : LENSPROF_LAYOUT_RGB;
    const size_t samples = shot.monochrome ? 1 : 3;
    const bool swaps = shot.quarter_turns % 2 != 0;
    picture.width = swaps ? field.height : field.width, picture.height = swaps ? field.width : field.height;
    picture.row_bytes = picture.width * samples;
    picture.pixels.resize(picture.row_bytes * picture.height);
    for (uint32_t y = 0; y < picture.height; y++)
        for (uint32_t x = 0; x < picture.width; x++) {
            // In a picture rotated clockwise, (x, y) shows the original (u, v).
            uint32_t u = x, v = y;
            if (shot.quarter_turns == 1) u = y, v = field.height - 1 - x;
            if (shot.quarter_turns == 2) u = field.width - 1 - x, v = field.height - 1 - y;
            if (shot.quarter_turns == 3) u = field.width - 1 - y, v = x;
            const auto near = [&](int i, int j) {
                return field.at(uint32_t(std::clamp(int(u) + i, 0, int(field.width) - 1)),
                                uint32_t(std::clamp(int(v) + j, 0, int(field.height) - 1)));
            };
            for (size_t c = 0; c < samples; c++) {
                const double own = near(0, 0)[c];
                const double about = (near(1, 0)[c] + near(-1, 0)[c] + near(0, 1)[c] + near(0, -1)[c]) / 4;
                const double value = own + shot.sharpen * (own - about);
                picture.pixels[y * picture.row_bytes + x * samples + c] =
                    static_cast<uint8_t>(std::clamp(std::lround(255 * value), 0l, 255l));
            }
        }
    return picture;
}

struct Taken {
    raw_files::Dng dng;
    Picture rendered;
};

inline Taken take(const Shot &shot) {
    Taken taken;
    taken.dng = mosaic_of(shot, sensor_light(shot));
    taken.rendered = rendered_of(shot, demosaiced(taken.dng));
    return taken;
}

// ln ln( I(208) / I(48) ), by the library's own inverse.
inline double gauge_of(const lensprof_response &response) {
    return std::log(std::log(lensprof_response_invert(&response, 208.0 / 255.0, nullptr)
                             / lensprof_response_invert(&response, 48.0 / 255.0, nullptr)));
}

inline lensprof_response table_response(double (*curve)(double)) {
    std::vector<double> values(4096);
    for (size_t i = 0; i < values.size(); i++) values[i] = curve(double(i) / double(values.size() - 1));
    values.front() = 0.0, values.back() = 1.0;
    lensprof_response response;
    assert_int_equal(lensprof_response_set_table(&response, values.data(), uint32_t(values.size())), LENSPROF_OK);
    return response;
}

inline double srgb(double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055; }
inline double bt709(double x) { return x < 0.018 ? 4.5 * x : 1.099 * std::pow(x, 0.45) - 0.099; }
// A contrasty rendering: sRGB, then an S with toe and shoulder.
inline double contrasty(double x) {
    const double y = srgb(x);
    return y + 0.18 * (y * y * (3 - 2 * y) - y) * 2.0;
}
// Bright mid-greys and a long shoulder.
inline double filmic(double x) {
    return std::pow(1.0 - std::exp(-3.2 * x), 0.52) / std::pow(1.0 - std::exp(-3.2), 0.52);
}

inline lensprof_response typical(uint32_t kind) {
    lensprof_response response;
    assert_int_equal(lensprof_response_set_typical(&response, kind, nullptr, nullptr), LENSPROF_OK);
    return response;
}

inline lensprof_response gamma_curve(double gamma) {
    lensprof_response response;
    assert_int_equal(lensprof_response_set_gamma(&response, gamma), LENSPROF_OK);
    return response;
}

constexpr int response_kinds = 10;
inline lensprof_response response_number(int i) {
    switch (i % response_kinds) {
    case 0: return typical(LENSPROF_CAMERA_STILL);
    case 1: return table_response(srgb);
    case 2: return gamma_curve(2.2);
    case 3: return typical(LENSPROF_CAMERA_FILM);
    case 4: return table_response(contrasty);
    case 5: return typical(LENSPROF_CAMERA_PHONE);
    case 6: return table_response(filmic);
    case 7: return typical(LENSPROF_CAMERA_DIGITAL);
    case 8: return table_response(bt709);
    default: return gamma_curve(1.8);
    }
}

}  // namespace response_scenes
