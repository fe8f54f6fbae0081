// With e_a the vector that has 1 at cell a, the pair p between cells a and b has the residual
//
//     z_p = h_a - h_b + noise = (e_a - e_b)'h + noise,
//
// levels or any other unit, which h shares. Each half of the pairs gives the maps that minimise
//
//     sum_p (z_p - (e_a - e_b)'h)^2 + R |h|^2,     so that     (R I + L) h = sum_p z_p (e_a - e_b),
//
// where L = sum_p (e_a - e_b)(e_a - e_b)'
// is the Laplacian of the graph whose nodes are the cells and whose edges the pairs: positive semi-definite,
// singular for a constant added to maps that pairs join, which the ridge R determines; a cell with few pairs stays near
// 0. Conjugate gradients only need products with L, a sum over pairs: L, of as many rows as 48 cells times images, is
// never formed. They end after 40 steps, or at a millionth of the first gradient, which is exact enough for a share.
//
// The share is  1 - sum (z_p - (h_a - h_b))^2 / sum z_p^2  over the other half's pairs, both ways round. Maps fitted to
// noise make it negative there, so that a share above 0 is not chance, and needs no correction for the number of cells.
#include "fit/verdict/pattern.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

namespace lensprof {
namespace {

constexpr int kColumns = 8, kRows = 6, kCells = kColumns * kRows;
constexpr double kRidge = 4.0;  // weight, in pairs, of the prior that a cell shows nothing
constexpr int kIterations = 40;

// A pair in terms of the maps.
struct Sample {
    Eigen::Index cell[2];  // numbered over all maps
    double residual;
};

Eigen::Index cell_of(const Problem &problem, const lensprof_pair &pair, int side, bool per_image) {
    const auto &image = problem.images[pair.image[side]];
    auto cell_index = [](double value, double size, int count) {
        return std::clamp(static_cast<int>((value + 0.5) / size * count), 0, count - 1);
    };
    int cell = cell_index(pair.xy[side][0], image.width, kColumns)
               + kColumns * cell_index(pair.xy[side][1], image.height, kRows);
    return cell + (per_image ? kCells * static_cast<Eigen::Index>(pair.image[side]) : 0);
}

// Ridge regression of the residuals on the maps, by conjugate gradients: the cost is linear in the number of pairs.
Eigen::VectorXd fit_maps(const std::vector<Sample> &samples, Eigen::Index cells) {
    auto times = [&](const Eigen::VectorXd &h) {
        Eigen::VectorXd product = kRidge * h;
        for (const Sample &s : samples) {
            double difference = h[s.cell[0]] - h[s.cell[1]];
            product[s.cell[0]] += difference;
            product[s.cell[1]] -= difference;
        }
        return product;
    };
    Eigen::VectorXd h = Eigen::VectorXd::Zero(cells), gradient = h;
    for (const Sample &s : samples) {
        gradient[s.cell[0]] += s.residual;
        gradient[s.cell[1]] -= s.residual;
    }
    Eigen::VectorXd direction = gradient;
    double length2 = gradient.squaredNorm(), enough = 1e-12 * length2;
    for (int i = 0; i < kIterations && length2 > enough; i++) {
        Eigen::VectorXd product = times(direction);
        double step = length2 / direction.dot(product);
        h += step * direction;
        gradient -= step * product;
        double next = gradient.squaredNorm();
        direction = gradient + next / length2 * direction;
        length2 = next;
    }
    return h;
}

// Share of the variance of one half of the pairs that the maps of the other half explain, in both directions.
double explained(const std::vector<Sample> (&halves)[2], Eigen::Index cells) {
    double before = 0.0, after = 0.0;
    for (int half = 0; half < 2; half++) {
        Eigen::VectorXd h = fit_maps(halves[half], cells);
        for (const Sample &s : halves[1 - half]) {
            before += s.residual * s.residual;
            after += std::pow(s.residual - (h[s.cell[0]] - h[s.cell[1]]), 2);
        }
    }
    return before > 0.0 ? std::max(0.0, 1.0 - after / before) : 0.0;
}

}  // namespace

PatternShares pattern_shares(const Problem &problem, const std::vector<double> &residual,
                             const std::vector<bool> &is_inlier) {
    PatternShares shares;
    for (bool per_image : {false, true}) {
        std::vector<Sample> halves[2];
        size_t count = 0;
        for (size_t p = 0; p < problem.pairs.size(); p++) {
            if (!is_inlier[p]) continue;
            const auto &pair = problem.pairs[p];
            halves[count++ % 2].push_back(
                {{cell_of(problem, pair, 0, per_image), cell_of(problem, pair, 1, per_image)}, residual[p]});
        }
        auto cells = static_cast<Eigen::Index>(per_image ? kCells * static_cast<size_t>(problem.image_count) : kCells);
        double share = explained(halves, cells);
        if (per_image)
            shares.image = std::max(0.0, share - shares.frame);
        else
            shares.frame = share;
    }
    return shares;
}

}  // namespace lensprof
