// The response between linear raw values and rendered grey values, fitted to places.
//
//   y_c = f( exp(q1 r^2 + q2 r^4 + q3 r^6) * sum_k A_ck raw_k )
//   B_c = y_c + s (y_c - .299 y_r - .587 y_g - .114 y_b)
//
// f is one curve for all channels and pictures; A (white balance, exposure and colour matrix in one), the camera's
// own correction of the falloff q and a saturation s of colours after the curve are each picture's. f is straight
// between knots that lie evenly in x^(1/2.2), rises by its prior, and f(0) = 0, f(1) = 1: x = 1 is where the rendering
// reaches white.
#pragma once

#include <array>
#include <vector>

#include <lensprof/model.h>

#include "cli/response/places.hpp"

namespace lensprof {

constexpr int curve_knots = 64;  // intervals of f

struct Rendering {
    std::array<double, 9> colour = {1, 0, 0, 0, 1, 0, 0, 0, 1};  // A, rows of the rendered channels
    std::array<double, 3> falloff = {0, 0, 0};                   // q
    double saturation = 0.0;                                     // s
};

// Of a place: light and f of every channel, and the rendered grey values.
struct Prediction {
    std::array<double, 3> light{}, curve{}, slope{}, grey_value{};
    double grey = 0.0;  // what saturation is about
};
constexpr std::array<double, 3> grey_weights = {0.299, 0.587, 0.114};  // of Y in JPEG (ITU-R BT.601)

// Chroma is weighed by how well the model follows it: hues that a camera shifts count for little.
constexpr int chroma_bins = 5;

struct CurveFit {
    std::array<double, curve_knots + 1> knots{};  // f at (i / curve_knots)^2.2
    std::vector<Rendering> renderings;            // of every picture
    std::array<double, chroma_bins> noise{};      // of a place, grey value 0..1, by chroma
    double cost = 0.0;
    std::vector<double> knot_covariance;  // (curve_knots - 1)^2, of the inner knots

    // f(x); beyond white on with its last slope.
    double eval(double x, double *slope) const;
    Prediction predict(const Place &place) const;
    // Of a channel's residual: that of the chroma, more for a rough place, whose mean is not that of its mean light.
    double sigma(const Place &place) const;
    // The weight of a channel's residual, and the residual in grey values; 0 where it does not count.
    double weight(const Place &place, const Prediction &predicted, size_t channel, double *residual) const;

    lensprof_response response() const;
    // q = ln ln( I(208) / I(48) ), which moves with ln gamma (docs/model.md).
    double gauge() const;
    // By the covariance of the knots.
    double gauge_sigma() const;
};

// Regions of the frame, for errors by leaving each out in turn: places near each other are wrong alike.
constexpr int region_count = 20;
constexpr int leave_none = -1, leave_rougher = region_count, leave_colourful = region_count + 1;
int region_of(const Place &place);

// `pictures`: how many there are; `prior`: the typical response that unseen levels lean on. By Levenberg-Marquardt,
// robust. `start`: of an earlier fit of the same pictures, whose noise stays; or null. `left_out`: places that do not
// count: none, or all of a region (0..region_count - 1), the rougher or the more colourful half.
struct FitRequest {
    const std::vector<Place> &places;
    uint32_t pictures = 1, channels = 3;
    const lensprof_response &prior;
    const CurveFit *start = nullptr;
    int left_out = leave_none;
};
CurveFit fit_curve(const FitRequest &request);

}  // namespace lensprof
