// The surroundings of a corner when it was first seen, and where a later frame shows them (Baker & Matthews 2004,
// inverse compositional; affine as Shi & Tomasi 1994).
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace lensprof {

// Maps offsets from the corner, px of the reduced frame where it was first seen, to places in a later one.
struct Warp {
    Eigen::Matrix2d shape = Eigen::Matrix2d::Identity();
    Eigen::Vector2d place;

    explicit Warp(cv::Point2f corner) : place(double(corner.x), double(corner.y)) {}

    Eigen::Vector2d operator()(double dx, double dy) const { return place + shape * Eigen::Vector2d(dx, dy); }
};

class Look {
public:
    static constexpr int reach = 7, side = 2 * reach + 1;  // px from the corner, and of the square

    // Of a grey frame of 8 bits; `place` is at least reach + 2 pixels from its border.
    Look(const cv::Mat &grey, cv::Point2f place);

    // Improves `warp` until the frame looks like this. Gain, offset and a tilt of the brightness are free, so that
    // neither exposure nor falloff moves the place; the shape changes little from the one before. False where the frame
    // does not show the same, or not within its border.
    bool align(const cv::Mat &grey, Warp &warp) const;

private:
    static constexpr int unknowns = 10;  // shape, place, gain, offset, tilt
    static constexpr int gain_ = 6;
    using Normal = Eigen::Matrix<float, unknowns, unknowns>;
    using Vector = Eigen::Matrix<float, unknowns, 1>;

    Eigen::Matrix<float, side * side, unknowns, Eigen::RowMajor> slopes_;
    Normal inverse_;  // of the normal matrix with its priors
    Vector prior_;    // inverse variances of the unknowns, in units of the noise
    float variance_ = 0.0f;
};

}  // namespace lensprof
