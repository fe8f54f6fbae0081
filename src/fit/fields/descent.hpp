// The steps that fit level, shading, content and offset of one channel (shading.hpp).
#pragma once

#include <vector>

#include "fit/fields/shading.hpp"

namespace lensprof {

class Descent {
public:
    Descent(const FieldData &data, const Surface &surface);

    // A beginning from an offset: level and shading are quantiles of the logarithms over cells and pictures.
    void start(double offset, double share);

    // A beginning from what was found in some of the pictures.
    void start_from(const Descent &some, double share);

    // From here on, picture n has no influence if n % groups is `group`; everything else stays where it is.
    void leave_out(size_t group, size_t groups);

    // One step; `moves_offset` includes the offset.
    void step(bool moves_offset);

    // Sets every level to the best of many about it: a picture may have begun on its content.
    void search_levels();

    double cost() const;       // per cell
    bool is_at_limit() const;  // the offset is the smallest or largest possible
    double light() const;      // median level: light of the background, where S = 1

    // Sums over groups of pictures: per cell the weight, and weight times ln S as these pictures see it, which to first
    // order does not depend on the present estimate (Fisher scoring: the force over its mean slope, its mean square).
    struct Sums {
        std::vector<double> weight, weighted;
    };
    std::vector<Sums> sums(size_t groups) const;

    // Mean over the cells of the variance of ln S as one picture sees it: what all have in common and the surface
    // leaves, and the rest.
    struct Variance {
        double common = 0.0, own = 0.0;
    };
    Variance variance() const;

    struct OffsetStep {
        double change = 0.0, sigma = INFINITY;
    };
    OffsetStep offset_step() const;

    double offset = 0.0;
    std::vector<double> level, cells, nodes;
    Smoothness smoothness;
    Content content;
    double change = INFINITY;  // of ln S in the last step, rms

private:
    void take_logarithms();
    double information() const;
    double offset_force(float e) const;
    struct OffsetSide;
    OffsetSide offset_side() const;
    void take_residuals();
    std::vector<float> without_shading(size_t n) const;

    const FieldData *data_;
    const Surface *surface_;
    double middle_ = 0.0;  // median of the values
    double least_ = 0.0,
           floor_ = 0.0;        // ends of the offset: 0 unless there are smaller values; below nearly all values
    std::vector<float> t_, e_;  // [picture][cell]
    int rounds_ = 3;            // of the content, per step
    size_t left_out_ = 1, groups_ = 1;  // pictures n with n % groups_ == left_out_ have no t_
};

}  // namespace lensprof
