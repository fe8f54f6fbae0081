// Aligns a rendered picture with the raw frame it was made from.
//
// Cameras render only a part of the frame: some pixels are cut off at every edge, more if the aspect ratio differs; the
// picture is scaled, and warped if the camera corrects distortion.
#pragma once

#include <cstdint>
#include <vector>

#include <lensprof/apply.h>

#include "fit/rendering/stop.hpp"

namespace lensprof {

// Values of one channel, rows without gaps.
struct Plane {
    int width = 0, height = 0;
    std::vector<float> values;
    float at(int x, int y) const { return values[size_t(y) * size_t(width) + size_t(x)]; }
};

// From rendered picture to raw frame, both in units of their own half diagonals about their own centres:
// raw = shift + scale p (1 + k1 |p|^2 + k2 |p|^4).
struct Alignment {
    double shift[2] = {0, 0}, scale = 1.0, k1 = 0.0, k2 = 0.0;
    double correlation = 0.0;  // correlation of the local structure of both, aligned
    double texture = 0.0;      // share of the frame with structure

    void map(double x, double y, double raw[2]) const;
};

// The green or only channel on a kPerceptual scale, reduced to `side` pixels on the longer side (unless it has fewer).
// `exponent`: of the kPower function that makes linear values kPerceptual, 1 for rendered ones.
Plane structure_of(const lensprof_image &picture, int side, double exponent);

// Gauss-Newton on the locally normalised structure (Lucas & Kanade 1981), coarse to fine; the coarsest level starts
// from the best of a grid of scales and shifts. `rendered` has the orientation of the raw frame.
Alignment align_pictures(const lensprof_image &raw, const lensprof_image &rendered, const Stop &stop);

// The same on the coarsest level only, to determine the orientation of a picture.
Alignment align_coarsely(const lensprof_image &raw, const lensprof_image &rendered, const Stop &stop);

// An 8 bit `picture` rotated clockwise by `quarters` quarter turns.
struct RotatedImage {
    std::vector<uint8_t> pixels;  // empty: those of `picture`
    lensprof_image view;
};
RotatedImage rotated(const lensprof_image &picture, int quarters);

}  // namespace lensprof
