#include "photo/registration/camera_rotation.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace lensprof {

static constexpr double degrees = 180.0 / M_PI;

double focal_px(const PictureOptics &picture, double hfov_deg) {
    return picture.width / (2.0 * std::tan(0.5 * hfov_deg / degrees));
}

static Eigen::Vector3d ray(const PictureOptics &picture, double hfov_deg, const cv::Point2d &pixel) {
    const double focal = focal_px(picture, hfov_deg);
    return Eigen::Vector3d((pixel.x - 0.5 * (picture.width - 1.0)) / focal,
                           (pixel.y - 0.5 * (picture.height - 1.0)) / focal, 1.0)
        .normalized();
}

Eigen::Matrix3d rotation_between(const PictureOptics &first, double first_hfov, const PictureOptics &second,
                                 double second_hfov, const Matches &matches) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const auto &m : matches)
        sum += ray(second, second_hfov, m.second) * ray(first, first_hfov, m.first).transpose();
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d sign(1.0, 1.0, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0);
    return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

void set_angles(lensprof_camera &camera, const Eigen::Matrix3d &turn) {
    camera.yaw_deg = std::atan2(turn(2, 0), turn(2, 2)) * degrees;
    camera.pitch_deg = -std::asin(std::clamp(turn(2, 1), -1.0, 1.0)) * degrees;
    camera.roll_deg = std::atan2(turn(0, 1), turn(1, 1)) * degrees;
}

Eigen::Matrix3d turn_of(const lensprof_camera &camera) {
    const auto about = [](double angle_deg, const Eigen::Vector3d &axis) {
        return Eigen::AngleAxisd(angle_deg / degrees, axis).toRotationMatrix();
    };
    return about(-camera.roll_deg, Eigen::Vector3d::UnitZ()) * about(-camera.pitch_deg, Eigen::Vector3d::UnitX())
           * about(-camera.yaw_deg, Eigen::Vector3d::UnitY());
}

Eigen::Matrix3d upright(uint16_t orientation) {
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    if (orientation == 3) turn << -1, 0, 0, 0, -1, 0, 0, 0, 1;
    if (orientation == 6) turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    if (orientation == 8) turn << 0, 1, 0, -1, 0, 0, 0, 0, 1;
    return turn;
}

}  // namespace lensprof
