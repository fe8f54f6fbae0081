#include "photo/video/look.hpp"

#include <cmath>

#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

namespace lensprof {
namespace {

constexpr float noise_levels = 2.0f;  // of a reduced and smoothed pixel, with what compression changes
constexpr float unlike_share = 0.1f;  // of the variance that may differ otherwise
constexpr float shape_sigma = 0.02f;  // change of the shape since the frame before
constexpr float tilt_sigma = 0.8f;    // levels per px
constexpr float gain_sigma = 0.5f;
constexpr double most_px = 2.0, least_area = 0.4, most_area = 2.5;
constexpr double most_left_px = 0.2;  // of the last step
constexpr int most_rounds = 8;

// Bilinear; the place is within the frame.
float value_at(const cv::Mat &grey, double x, double y) {
    const int column = static_cast<int>(x), row = static_cast<int>(y);
    const auto right = static_cast<float>(x - column), below = static_cast<float>(y - row);
    const uint8_t *above = grey.ptr<uint8_t>(row) + column, *under = grey.ptr<uint8_t>(row + 1) + column;
    const float upper = above[0] + right * float(above[1] - above[0]);
    return upper + below * (under[0] + right * float(under[1] - under[0]) - upper);
}

bool is_inside(const cv::Mat &grey, const Warp &warp) {
    for (const double dx : {-double(Look::reach), double(Look::reach)})
        for (const double dy : {-double(Look::reach), double(Look::reach)}) {
            const Eigen::Vector2d corner = warp(dx, dy);
            if (!(corner.x() >= 0.0 && corner.y() >= 0.0 && corner.x() < grey.cols - 1.0
                  && corner.y() < grey.rows - 1.0))
                return false;
        }
    return true;
}

}  // namespace

Look::Look(const cv::Mat &grey, cv::Point2f place) {
    cv::Mat look;
    cv::getRectSubPix(grey, {side + 2, side + 2}, place, look, CV_8U);
    prior_.setConstant(0.0f);
    prior_.head<4>().setConstant(noise_levels * noise_levels / (shape_sigma * shape_sigma));
    prior_[gain_] = noise_levels * noise_levels / (gain_sigma * gain_sigma);
    prior_.tail<2>().setConstant(noise_levels * noise_levels / (tilt_sigma * tilt_sigma));
    const auto mean = static_cast<float>(cv::mean(look)[0]);
    for (int y = 0, n = 0; y < side; y++)
        for (int x = 0; x < side; x++, n++) {
            const uint8_t *row = look.ptr<uint8_t>(y + 1) + x + 1;
            const float value = row[0], across = 0.5f * float(row[1] - row[-1]),
                        down = 0.5f * float(row[look.step] - row[-static_cast<std::ptrdiff_t>(look.step)]);
            const auto dx = static_cast<float>(x - reach), dy = static_cast<float>(y - reach);
            slopes_.row(n) << across * dx, across * dy, down * dx, down * dy, across, down, value - mean, 1.0f, dx, dy;
        }
    variance_ = slopes_.col(gain_).squaredNorm() / float(side * side);
    Normal normal = slopes_.transpose() * slopes_;
    normal.diagonal() += prior_;
    inverse_ = normal.inverse();
}

bool Look::align(const cv::Mat &grey, Warp &warp) const {
    const Warp first = warp;
    Eigen::Matrix<float, side * side, 1> seen;
    Vector found, wanted = Vector::Zero();  // `wanted`: where the priors have their middle
    wanted[gain_] = 1.0f;
    float last_gain = 1.0f;
    double shift_px = 0.0;
    for (int round = 0; round < most_rounds; round++) {
        if (!is_inside(grey, warp)) return false;
        for (int y = 0, n = 0; y < side; y++)
            for (int x = 0; x < side; x++, n++) {
                const Eigen::Vector2d at = warp(x - reach, y - reach);
                seen[n] = value_at(grey, at.x(), at.y());
            }
        found = inverse_ * (slopes_.transpose() * seen + prior_.cwiseProduct(wanted));
        const float gain = found[gain_];
        if (!(gain > 0.1f)) return false;
        const Vector step = found / gain;
        Eigen::Matrix2f shape;
        shape << 1.0f + step[0], step[1], step[2], 1.0f + step[3];
        const Eigen::Vector2d shift = step.segment<2>(4).cast<double>();
        // The frame at warp(d) looks like the template at shape d + shift: the new warp begins where that is d.
        const Eigen::Matrix2d inverse = shape.cast<double>().inverse();
        warp.place -= warp.shape * inverse * shift;
        warp.shape = warp.shape * inverse;
        wanted.head<4>() = gain * (wanted.head<4>() / last_gain - step.head<4>());  // back to the shape of `first`
        last_gain = gain;
        const double area = warp.shape.determinant();
        if (!(area > least_area && area < most_area) || (warp.place - first.place).norm() > most_px) return false;
        shift_px = shift.norm();
        if (shift_px < 0.01) break;
    }
    if (shift_px > most_left_px) return false;
    const float error = (seen - slopes_ * found).squaredNorm() / float(side * side);
    const float contrast = found[gain_] * found[gain_] * variance_;
    return error <= noise_levels * noise_levels + unlike_share * contrast;
}

}  // namespace lensprof
