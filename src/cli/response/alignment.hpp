// Where the places of a rendered picture lie in the raw frame that it was made of.
//
// Cameras render a part of the frame: some pixels less at every edge, less still where the aspect differs, at another
// size, and bent where they take out the lens's distortion.
#pragma once

#include <vector>

#include "cli/pictures/picture.hpp"

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
    double correlation = 0.0;  // of the local structure of both, aligned
    double texture = 0.0;      // share of the frame that has any

    void map(double x, double y, double raw[2]) const;
};

// The green or only channel on a perceptual scale, averaged to `side` pixels on the longer side (or as it is, where it
// has fewer). `exponent`: of the power that makes linear values perceptual, 1 for rendered ones.
Plane structure_of(const Picture &picture, int side, double exponent);

// By Gauss-Newton on the locally normalised structure (Lucas & Kanade 1981), from coarse to fine; the coarsest start is
// the best of a grid of scales and shifts. `rendered` is turned as the raw frame is.
Alignment align_pictures(const Picture &raw, const Picture &rendered);

// The same on the coarsest level alone, for trying how a picture is turned.
Alignment align_coarsely(const Picture &raw, const Picture &rendered);

// `picture` (8 bit) turned by `quarters` clockwise.
Picture turned(const Picture &picture, int quarters);

}  // namespace lensprof
