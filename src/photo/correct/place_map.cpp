#include "photo/correct/place_map.hpp"

#include <cmath>

namespace lensprof {

static constexpr double bent_px = 0.05;  // by which interpolated positions may deviate

PlaceMap::PlaceMap(const LitPicture &from, const LitPicture &to)
    : from_(from.camera()),
      to_(to.camera()),
      out_(from.scale()),
      in_(to.scale()),
      columns_(from.width() / node_px + 2),
      nodes_(size_t(columns_) * (from.height() / node_px + 2)) {
    for (size_t n = 0; n < nodes_.size(); n++) {
        Node &node = nodes_[n];
        node.is_seen = compute(x_of(n), y_of(n), node.xy);
    }
    for (size_t n = 0; n + columns_ < nodes_.size(); n++)
        if (n % columns_ + 1 < columns_) nodes_[n].is_plane = is_plane(n);
}

bool PlaceMap::find(uint32_t x, uint32_t y, double xy[2]) const {
    const size_t n = size_t(y / node_px) * columns_ + x / node_px;
    if (!nodes_[n].is_plane) return compute(x, y, xy);
    between(n, static_cast<double>(x % node_px) / node_px, static_cast<double>(y % node_px) / node_px, xy);
    return true;
}

bool PlaceMap::compute(double x, double y, double xy[2]) const {
    double direction[2];
    if (!lensprof_camera_unproject(&from_, PixelScale::to_frame(x, out_.x), PixelScale::to_frame(y, out_.y), direction)
        || !lensprof_camera_project(&to_, direction[0], direction[1], xy))
        return false;
    xy[0] = PixelScale::to_picture(xy[0], in_.x), xy[1] = PixelScale::to_picture(xy[1], in_.y);
    return true;
}

void PlaceMap::between(size_t n, double u, double v, double xy[2]) const {
    const Node *upper = &nodes_[n], *lower = upper + columns_;
    for (size_t d = 0; d < 2; d++)
        xy[d] = (1 - v) * ((1 - u) * upper[0].xy[d] + u * upper[1].xy[d])
                + v * ((1 - u) * lower[0].xy[d] + u * lower[1].xy[d]);
}

bool PlaceMap::is_plane(size_t n) const {
    for (size_t corner : {n, n + 1, n + columns_, n + columns_ + 1})
        if (!nodes_[corner].is_seen) return false;
    constexpr double inside[3][2] = {{0.5, 0.5}, {0.5, 0.0}, {0.0, 0.5}};  // where curvature is largest
    for (const auto &[u, v] : inside) {
        double straight[2], exact[2];
        between(n, u, v, straight);
        if (!compute(x_of(n) + u * node_px, y_of(n) + v * node_px, exact)
            || !(std::hypot(straight[0] - exact[0], straight[1] - exact[1]) < bent_px))
            return false;
    }
    return true;
}

}  // namespace lensprof
