// Hilly ground: heights on a grid, linearly interpolated.
#pragma once

#include "cli/simulate/moving.hpp"

namespace lensprof {

class Heights {
public:
    // Hills within `reach_m` of the origin along x and y; flat beyond.
    Heights(uint32_t seed, double reach_x_m, double reach_y_m);

    double height_at(double x, double y) const;
    Vector3 normal(double x, double y) const;
    double top() const { return top_m_; }

    // The intersection of a ray from above with the ground; false if it passes over it.
    bool meet(const Line &line, double &distance_m) const;

private:
    double reach_m_[2];
    size_t columns_, rows_;
    std::vector<float> heights_m_;
    double top_m_, slope_;  // the highest point, the steepest slope
};

}  // namespace lensprof
