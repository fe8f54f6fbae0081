// The response between linear raw values and rendered grey values, fitted to areas.
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

#include "fit/rendering/areas.hpp"

namespace lensprof {

constexpr int kCurveKnots = 64;  // intervals of f

struct Rendering {
    std::array<double, 9> colour = {1, 0, 0, 0, 1, 0, 0, 0, 1};  // A, one row per rendered channel
    std::array<double, 3> falloff = {0, 0, 0};                   // q
    double saturation = 0.0;                                     // s
};

// At an area: irradiance and f per channel, and the rendered grey values.
struct AreaPrediction {
    std::array<double, 3> light{}, curve{}, slope{}, grey_value{};
    double grey = 0.0;  // the grey axis of the saturation
};
constexpr std::array<double, 3> kGreyWeights = {0.299, 0.587, 0.114};  // of Y in JPEG (ITU-R BT.601)

// Chroma is weighted by how well the model explains it: hues that a camera shifts get a low weight.
constexpr int kChromaBins = 5;

struct CurveFit {
    std::array<double, kCurveKnots + 1> knots{};  // f at (i / kCurveKnots)^2.2
    std::vector<Rendering> renderings;            // per picture
    std::array<double, kChromaBins> noise{};      // of an area, grey value 0..1, by chroma
    double cost = 0.0;
    std::vector<double> knot_covariance;  // (kCurveKnots - 1)^2, of the kInner knots

    // f(x); linear extrapolation beyond white.
    double eval(double x, double *slope) const;
    AreaPrediction predict(const Area &area) const;
    // Noise of a channel's residual: that of the chroma, larger for an uneven area, where the mean of f is not f of the
    // mean.
    double sigma(const Area &area) const;
    // The weight of a channel's residual, and the residual in grey values; 0 if it does not count.
    double weight(const Area &area, const AreaPrediction &predicted, size_t channel, double *residual) const;

    lensprof_response response() const;
    // q = ln ln( I(208) / I(48) ), which moves with ln gamma (docs/model.md).
    double gauge() const;
    // From the covariance of the knots.
    double gauge_sigma() const;
};

// Regions of the frame, for jackknife errors: neighbouring areas have similar errors.
constexpr int kRegionCount = 20;
constexpr int kLeaveNone = -1, kLeaveRougher = kRegionCount, kLeaveColourful = kRegionCount + 1;
int region_of(const Area &area);

// `pictures`: number of pictures; `prior`: the typical response that unmeasured levels are drawn to. Robust
// Levenberg-Marquardt. `start`: an earlier fit of the same pictures, whose noise is kept; or null. `left_out`: areas to
// leave out: none, all of a region (0..region_count - 1), or the more uneven or more colourful half.
struct FitRequest {
    const std::vector<Area> &areas;
    uint32_t pictures = 1, channels = 3;
    const lensprof_response &prior;
    const CurveFit *start = nullptr;
    int left_out = kLeaveNone;
    Stop stop{};
};
CurveFit fit_curve(const FitRequest &request);

}  // namespace lensprof
