// The shading of one channel:  B_n(x) = b + a_n S(x) C_n(x),  with the level a_n of picture n, the shading S, the
// content C_n of its scene and one offset b.
//
// With t = ln(B - b) and e = t - ln a_n - ln S, the cost is  sum over pictures and cells of  -ln f(e) + t,  which is
// the likelihood of the grey values if all contents have one density f. f is estimated along with levels, shading and
// offset (content.hpp), and makes the fit robust: cells of an even background pull much, those of bright or dark things
// little. Expectation maximisation; every step is a weighted least squares problem.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "fit/fields/content.hpp"
#include "fit/fields/surface.hpp"

namespace lensprof {

// Linear values of the cells of all pictures, in one channel; NaN: not usable.
struct FieldData {
    size_t pictures = 0, cells = 0;
    std::vector<float> value;  // [picture][cell]

    const float *picture(size_t n) const { return &value[n * cells]; }
};

// Called between steps; true to cancel.
using FieldStep = std::function<bool()>;
constexpr int kFieldSteps = 200;  // calls of a fit, about

struct Shading {
    double offset = 0.0;
    double offset_sigma = 0.0;     // standard error, by the scatter of the pictures; INFINITY: not determined
    bool is_offset_found = false;  // otherwise it is the given one
    std::vector<double> level;     // ln a of every picture
    std::vector<double> nodes;     // ln S at the nodes of the surface; mean over the cells 0
    std::vector<double> cells;     // ln S at the cells
    std::vector<double> seen;      // weight of the cells, all pictures together; 0: in no picture
    Smoothness smoothness;
    size_t smoothness_index = 0;
    std::vector<double> heldout;    // of held-out pictures, rms of ln S, per order and weight of surface.hpp
    double heldout_rms = 0.0;       // with the smoothness chosen
    double even_rms = 0.0;          // of an even shading, S = 1
    double error = 0.0;             // standard error of ln S, rms over the frame: chance and bias
    double pattern = 0.0;           // rms of what all pictures have in common and no surface of 12 nodes has
    double pattern_share = 0.0;     // its share of the variance of ln S as one picture sees it
    double content_sigma = 0.0;     // of the narrowest component of the content
    double background_share = 0.0;  // of the cells that belong to it
    uint32_t iterations = 0;
    bool converged = false;
};

// `offset`: given, or to be found. Pictures must have a value in most cells. Throws Cancelled.
Shading fit_shading(const FieldData &data, const Surface &surface, std::optional<double> offset, uint32_t threads,
                    const FieldStep &step);

}  // namespace lensprof
