#include "photo/registration/pinhole.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "photo/registration/camera_rotation.hpp"

namespace lensprof {

Pinhole::Pinhole(const lensprof_camera &camera)
    : turn_(turn_of(camera)),
      place_(camera.translation[0], camera.translation[1], -camera.translation[2]),
      centre_(0.5 * camera.width - 0.5, 0.5 * camera.height - 0.5),
      focal_(camera.width / (2.0 * std::tan(camera.hfov_deg * M_PI / 360.0))),
      half_side_(0.5 * std::min(camera.width, camera.height)),
      is_moved_(!place_.isZero(0.0)) {
    const double *radial = camera.radial;
    std::copy_n(radial, 3, radial_);
    radial_[3] = 1.0 - radial[0] - radial[1] - radial[2];
    is_distorted_ = radial[0] != 0.0 || radial[1] != 0.0 || radial[2] != 0.0;
    rises_to_ = is_distorted_ ? end_of_rise() : std::numeric_limits<double>::infinity();
}

double Pinhole::scale_at(double r) const { return radial_[3] + r * (radial_[2] + r * (radial_[1] + r * radial_[0])); }

double Pinhole::slope(double r) const {
    return radial_[3] + r * (2.0 * radial_[2] + r * (3.0 * radial_[1] + r * 4.0 * radial_[0]));
}

// The smallest root of the slope, between its extrema.
double Pinhole::end_of_rise() const {
    constexpr double far = 1e6;
    const double a = 12.0 * radial_[0], b = 6.0 * radial_[1], c = 2.0 * radial_[2], q = b * b - 4.0 * a * c;
    double ends[3] = {far, far, far};
    if (q >= 0.0) {
        const double u = -0.5 * (b + std::copysign(std::sqrt(q), b));
        for (int n = 0; n < 2; n++)
            if (const double root = n ? c / u : u / a; root > 0.0 && root < far) ends[n] = root;
        std::sort(ends, ends + 3);
    }
    double low = 0.0;
    for (double high : ends) {
        if (slope(high) > 0.0) {
            low = high;
            continue;
        }
        for (int n = 0; n < 60; n++) {
            const double middle = 0.5 * (low + high);
            (slope(middle) > 0.0 ? low : high) = middle;
        }
        return low;
    }
    return far;
}

// Newton's method from the distorted distance, which is near.
double Pinhole::undistorted(double distance) const {
    double r = distance;
    for (int n = 0; n < 50; n++) {
        const double rise = slope(r);
        if (!(rise > 0.0)) r = 0.5 * std::min(r, rises_to_);
        const double next = r - (r * scale_at(r) - distance) / slope(r);
        const bool is_done = std::abs(next - r) <= 1e-15 * distance;
        r = next;
        if (is_done) break;
    }
    return r >= 0.0 && r <= rises_to_ && std::abs(r * scale_at(r) - distance) <= 1e-12 * (1.0 + distance) ? r : -1.0;
}

bool Pinhole::ray(double x, double y, Eigen::Vector3d &direction) const {
    Eigen::Vector2d p = Eigen::Vector2d(x, y) - centre_;
    if (is_distorted_) {
        const double distance = p.norm() / half_side_, r = undistorted(distance);
        if (r < 0.0) return false;
        if (distance > 0.0) p *= r / distance;
    }
    direction << p.x() / focal_, p.y() / focal_, 1.0;
    return true;
}

bool Pinhole::seen(const Eigen::Vector3d &ray, Eigen::Vector3d &direction) const {
    direction.noalias() = turn_.transpose() * ray;
    if (!is_moved_) return true;
    const double length = (1.0 - place_.z()) / direction.z();
    if (!(length > 0.0) || !std::isfinite(length)) return false;
    direction = length * direction + place_;
    return true;
}

bool Pinhole::project(const Eigen::Vector3d &direction, Eigen::Vector2d &xy) const {
    Eigen::Vector3d v = direction;
    if (is_moved_) {
        if (!(v.z() > 0.0)) return false;
        v = v / v.z() - place_;
    }
    v = turn_ * v;
    if (!(v.z() > 0.0)) return false;
    Eigen::Vector2d p = focal_ / v.z() * v.head<2>();
    if (is_distorted_) {
        const double r = p.norm() / half_side_;
        if (!(r <= rises_to_)) return false;
        p *= scale_at(r);
    }
    xy = p + centre_;
    return xy.allFinite();
}

}  // namespace lensprof
