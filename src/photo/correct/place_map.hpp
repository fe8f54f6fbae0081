// Maps the pixels of a picture to positions in another picture.
#pragma once

#include <vector>

#include "photo/correct/lit_picture.hpp"

namespace lensprof {

// Positions in another picture of the pixels of this one. Computed at nodes and interpolated between four nodes if the
// positions are planar to bent_px; else, such as at the seam of a full panorama, computed for every pixel.
class PlaceMap {
public:
    PlaceMap(const LitPicture &from, const LitPicture &to);

    // The position may lie outside the frame; false if the point is not in front of the other camera.
    bool find(uint32_t x, uint32_t y, double xy[2]) const;

private:
    static constexpr uint32_t node_px = 8;  // between computed positions

    struct Node {
        double xy[2] = {};
        bool is_seen = false, is_plane = false;  // is_plane: whether the square of nodes starting here is planar
    };

    double x_of(size_t n) const { return static_cast<double>(n % columns_) * node_px; }
    double y_of(size_t n) const { return static_cast<double>(n / columns_) * node_px; }

    bool compute(double x, double y, double xy[2]) const;
    void between(size_t n, double u, double v, double xy[2]) const;
    bool is_plane(size_t n) const;

    const lensprof_camera from_, to_;
    const PixelScale out_, in_;
    uint32_t columns_;
    std::vector<Node> nodes_;
};

}  // namespace lensprof
