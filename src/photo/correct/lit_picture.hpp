// A full-size picture with its irradiance and its orientation.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "photo/correct/correction.hpp"
#include "photo/correct/light_weights.hpp"
#include "photo/scene/scene.hpp"

namespace lensprof {

// The correction of an image of a project with the model of the project.
struct PlacedCorrection {
    Correction job;
    uint32_t image;
};

// Maps the full frame of the project to pixels of a picture, which may have another size.
struct PixelScale {
    double x, y;

    PixelScale(const Picture &picture, const lensprof_camera &camera)
        : x(static_cast<double>(picture.width) / camera.width),
          y(static_cast<double>(picture.height) / camera.height) {}
    static double to_picture(double position, double scale) { return (position + 0.5) * scale - 0.5; }
    static double to_frame(double position, double scale) { return (position + 0.5) / scale - 0.5; }
};

// A full-size picture and its irradiance.
class LitPicture {
public:
    LitPicture(const PlacedCorrection &placed, const CorrectionKind &kind, const Scene &scene);

    uint32_t width() const { return grey_.width; }
    uint32_t height() const { return grey_.height; }
    size_t samples() const { return samples_; }
    const Picture &header() const { return grey_; }
    const lensprof_camera &camera() const { return camera_; }
    PixelScale scale() const { return {grey_, camera_}; }

    double grey(uint32_t x, uint32_t y, size_t c) const { return grey_at(view_, y, size_t(x) * samples_ + c); }
    double largest(uint32_t x, uint32_t y) const { return largest_grey(view_, x, y); }
    float *light(uint32_t x, uint32_t y) { return &light_[(size_t(y) * width() + x) * samples_]; }

    const std::vector<float> &all_light() const { return light_; }

    bool is_masked(uint32_t x, uint32_t y) const { return !mask_.empty() && !mask_[size_t(y) * width() + x]; }
    double trust(uint32_t x, uint32_t y) const { return trust_of(largest(x, y)); }
    void weights(uint32_t x, uint32_t y, double trust, double weight[3]) const;

    double falloff(uint32_t x, uint32_t y) const {
        return lensprof_vignetting_eval(
            &vignetting_, lensprof_vignetting_r2(&vignetting_, width(), height(), x, y, nullptr), nullptr);
    }

    // The grey value of a pixel with this falloff and irradiance; above 1 for irradiance beyond white. Projects have a
    // single response.
    double recorded(size_t c, double light, double falloff) const {
        const double share = std::max(light * gain_[c] * falloff, 0.0);
        if (share > 1.0) return share;  // beyond white, not a grey value
        return curve_[static_cast<size_t>(std::lround(curve_steps * std::sqrt(share)))];
    }

private:
    static constexpr int curve_steps = 8192;  // tabulated over the square root of irradiance, because responses are
                                              // steepest next to black
    const LightWeights weights_;
    const lensprof_camera camera_;
    const lensprof_vignetting vignetting_;
    Picture grey_;
    lensprof_image view_{};
    size_t samples_;
    double gain_[3];
    std::array<double, curve_steps + 1> curve_;
    std::vector<float> light_;
    std::vector<uint8_t> mask_;
};

// Irradiance interpolated between four pixels, and how far all four are from clipping.
struct Reading {
    double light[3], trust;
    bool is_white;
    uint32_t x, y;  // the nearest pixel
};

// False outside the picture, and if a mask excludes one of the four pixels.
bool read_at(LitPicture &picture, const double xy[2], Reading &reading);

}  // namespace lensprof
