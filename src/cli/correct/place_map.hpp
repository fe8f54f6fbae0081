// From the pixels of a picture to the places of another one.
#pragma once

#include <vector>

#include "cli/correct/lit_picture.hpp"

namespace lensprof {

// Where another picture shows the pixels of one: computed at nodes, and between four of them where places lie on a
// plane to bent_px; else, at the cut of a picture all around for one, for every pixel.
class PlaceMap {
public:
    PlaceMap(const LitPicture &from, const LitPicture &to);

    // The place may lie outside of the frame; false where the other camera does not look at all.
    bool find(uint32_t x, uint32_t y, double xy[2]) const;

private:
    static constexpr uint32_t node_px = 8;  // between places that are computed

    struct Node {
        double xy[2] = {};
        bool is_seen = false, is_plane = false;  // is_plane: of the square of nodes from this one on
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
