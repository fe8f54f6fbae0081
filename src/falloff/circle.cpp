#include "falloff/circle.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace lensprof {
namespace {

constexpr double kRoundShare = 0.95;     // of the places, near the circle
constexpr double kFarthestCircle = 0.5;  // half diagonals: a straight outline is not a circle

}  // namespace

std::optional<lensprof_image_circle> circle_through(const std::vector<std::array<double, 2>> &places, double slack,
                                                    size_t fewest) {
    if (places.size() < fewest) return std::nullopt;
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const auto &place : places) {
        const Eigen::Vector2d p(place[0], place[1]);
        const Eigen::Vector3d row(2.0 * p[0], 2.0 * p[1], 1.0);
        normal += row * row.transpose(), right += row * p.squaredNorm();
    }
    const Eigen::Vector3d found = normal.ldlt().solve(right);
    const Eigen::Vector2d center = found.head<2>();
    const double radius = std::sqrt(found[2] + center.squaredNorm());
    const auto is_near = [&](const auto &place) {
        return std::fabs((Eigen::Vector2d(place[0], place[1]) - center).norm() - radius) <= slack;
    };
    const auto near = static_cast<double>(std::count_if(places.begin(), places.end(), is_near));
    if (!(near >= kRoundShare * static_cast<double>(places.size())) || !(center.norm() <= kFarthestCircle))
        return std::nullopt;
    return lensprof_image_circle{{center[0], center[1]}, radius};
}

}  // namespace lensprof
