// Kriging (a Gaussian process with an unknown level) of falloffs over the settings of a lens.
//
// A curve's coefficient y at setting s (x, t, z: prediction.h) is taken as a trend plus a process whose covariance
// between two settings at distance d is, in units of its variance v,
//     c(d) = (1 + d) e^-d + kAnyLevel,
// the first term once differentiable (Matern 3/2), the second, large one a level that is common to the lens and not
// known beforehand. Node i is off the process by noise of variance n_i = kOwnNoise + (its own variance of M) /
// kPriorSigma^2. With A = c(d_ij) + diag(n_i) among the nodes and b = c(d_i*) from them to the setting asked for, the
// best linear prediction and its variance are
//     w = A^-1 b,     y* = m + w'(y - m),     v (c(0) + kOwnNoise - b'w),
// where m is the nodes' mean: as kAnyLevel is large the weights add up to nearly 1 and m has almost no effect. The same
// w serve k1, k2, k3 of all curves. v is what the nodes show, y' A^-1 y over their number for corners y about their
// mean, together with kPriorSigma^2 in the weight of kPriorNodes nodes. M has no unit; distances are in steps of two
// octaves of focal length, of one N0/N or of 5 dioptres.
#include "falloff/prediction.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <new>

#include <Eigen/Cholesky>

#include <lensprof/model.h>

#include "falloff/power_fit.hpp"

namespace {

constexpr double kTrend = 0.4;        // the mean falloff wide open is 1 - 0.4 r^2
constexpr double kAnyLevel = 100.0;   // variance of the level of all curves of a lens: ordinary kriging
constexpr double kOwnNoise = 1e-4;    // variance of a node about the smooth truth, in units of the process's
constexpr double kPriorSigma = 0.15;  // of the process, with the weight of kPriorNodes nodes
constexpr double kPriorNodes = 4.0;
constexpr double kSpare = 0.02;  // of M, beyond what neighbours span

// At most LP_NEIGHBOURS unknowns, without a heap.
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, LP_NEIGHBOURS, LP_NEIGHBOURS>;
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, LP_NEIGHBOURS, 1>;

struct Point {
    double x, t, z, d;  // d: distance from the setting asked for
    uint32_t node;
};

double distance(const Point &a, const Point &b) {
    return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.t - b.t) * (a.t - b.t) + (a.z - b.z) * (a.z - b.z));
}

double covariance(const Point &a, const Point &b) {
    const double d = distance(a, b);
    return (1.0 + d) * std::exp(-d) + kAnyLevel;
}

double corner(const double *k) { return k[0] + k[1] + k[2]; }

double longest_of(const lp_falloff_node *nodes, uint32_t count) {
    double longest = 0.0;
    for (uint32_t i = 0; i < count; i++) longest = nodes[i].focal_mm > longest ? nodes[i].focal_mm : longest;
    return longest;
}

// The smallest f-number at this focal length or a longer one; beyond the longest that is known, at that.
double widest_at(const lp_falloff_node *nodes, uint32_t count, const lp_falloff_node &target, double focal_mm,
                 double longest) {
    const double from = 0.999 * std::fmin(focal_mm, longest);
    double widest = target.focal_mm >= from ? target.aperture : INFINITY;
    for (uint32_t i = 0; i < count; i++)
        if (nodes[i].focal_mm >= from && nodes[i].aperture < widest) widest = nodes[i].aperture;
    return widest;
}

Point point_of(const lp_falloff_node &node, double widest) {
    return {0.5 * std::log2(node.focal_mm), widest / node.aperture, std::fmin(0.2 / node.distance_m, 6.0), 0.0, 0};
}

struct IsNearer {
    bool operator()(const Point &a, const Point &b) const { return a.d != b.d ? a.d < b.d : a.node < b.node; }
};

// Focal length, aperture and curves, in some order.
int compare_curves(const lp_falloff_node &a, const lp_falloff_node &b) {
    if (a.focal_mm != b.focal_mm) return a.focal_mm < b.focal_mm ? -1 : 1;
    if (a.aperture != b.aperture) return a.aperture < b.aperture ? -1 : 1;
    return std::memcmp(a.k, b.k, sizeof a.k);
}

// The nodes that a prediction uses, nearest first.
struct Neighbours {
    const lp_falloff_node *nodes;
    const Point *points;
    uint32_t used;

    const lp_falloff_node &node(uint32_t i) const { return nodes[points[i].node]; }
};

// The setting asked for; points[count] receives the nodes, of which the LP_NEIGHBOURS nearest come first, in order.
Point sort_by_distance(const lp_falloff_node *nodes, uint32_t count, const lp_falloff_node &target, Point *points) {
    const double longest = longest_of(nodes, count);
    const Point position = point_of(target, widest_at(nodes, count, target, target.focal_mm, longest));
    double focal_mm = -1.0, widest = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        if (nodes[i].focal_mm != focal_mm)
            widest = widest_at(nodes, count, target, focal_mm = nodes[i].focal_mm, longest);
        points[i] = point_of(nodes[i], widest);
        points[i].d = distance(points[i], position);
        points[i].node = i;
    }
    std::partial_sort(points, points + std::min<uint32_t>(count, LP_NEIGHBOURS), points + count, IsNearer());
    return position;
}

// Keeps a curve near those of the neighbours.
void restrain(const Neighbours &neighbours, int curve, double k[3]) {
    double low[LP_FALLOFF_RADII], high[LP_FALLOFF_RADII], values[LP_FALLOFF_RADII], samples[LP_FALLOFF_RADII];
    bool changed = false;
    for (uint32_t i = 0; i < neighbours.used; i++) {
        lp_sample_falloff(neighbours.node(i).k[curve], samples);
        for (int j = 0; j < LP_FALLOFF_RADII; j++) {
            if (!i || samples[j] < low[j]) low[j] = samples[j];
            if (!i || samples[j] > high[j]) high[j] = samples[j];
        }
    }
    lp_sample_falloff(k, values);
    for (int j = 0; j < LP_FALLOFF_RADII; j++) {
        const double spare = 0.5 * (high[j] - low[j]) + kSpare;
        const double inside = std::fmax(std::fmin(values[j], high[j] + spare), std::fmax(low[j] - spare, 0.5 * low[j]));
        if (inside != values[j]) values[j] = inside, changed = true;
    }
    if (changed) lp_fit_falloff(values, k);
}

// The neighbours' mean and their weighted differences from it, trends taken out first and put back here.
void combine(const Neighbours &neighbours, const Point &position, const Vector &weight, double k[3][3]) {
    for (int c = 0; c < 3; c++) {
        for (int n = 0; n < 3; n++) {
            const auto trend = [n](const Point &p) { return n ? 0.0 : kTrend * p.t * p.t; };
            double mean = 0.0, sum = 0.0;
            for (uint32_t i = 0; i < neighbours.used; i++)
                mean += (neighbours.node(i).k[c][n] + trend(neighbours.points[i])) / neighbours.used;
            for (uint32_t i = 0; i < neighbours.used; i++)
                sum += weight[i] * (neighbours.node(i).k[c][n] + trend(neighbours.points[i]) - mean);
            k[c][n] = mean + sum - trend(position);
        }
        restrain(neighbours, c, k[c]);
    }
}

// Range of the neighbours' corners, beyond which a prediction does not go (restrain).
double corner_span(const Neighbours &neighbours) {
    double low = INFINITY, high = -INFINITY;
    for (uint32_t i = 0; i < neighbours.used; i++)
        for (const auto &k : neighbours.node(i).k) low = std::fmin(low, corner(k)), high = std::fmax(high, corner(k));
    return high - low;
}

// Variance of the process by what the neighbours' corners show.
double process_variance(const Neighbours &neighbours, const Eigen::LLT<Matrix> &factor) {
    Vector y(neighbours.used);
    for (uint32_t i = 0; i < neighbours.used; i++) {
        y[i] = kTrend * neighbours.points[i].t * neighbours.points[i].t;
        for (const auto &k : neighbours.node(i).k) y[i] += corner(k) / 3.0;
    }
    y.array() -= y.sum() / neighbours.used;
    const double shown = y.dot(Vector(factor.solve(y)));
    return (kPriorNodes * kPriorSigma * kPriorSigma + shown) / (kPriorNodes + neighbours.used - 1.0);
}

void krige(const Neighbours &neighbours, const Point &position, lp_falloff_prediction &prediction) {
    Matrix a(neighbours.used, neighbours.used);
    Vector b(neighbours.used);
    for (uint32_t i = 0; i < neighbours.used; i++) {
        for (uint32_t j = 0; j <= i; j++) a(i, j) = a(j, i) = covariance(neighbours.points[i], neighbours.points[j]);
        a(i, i) += kOwnNoise + neighbours.node(i).variance / (kPriorSigma * kPriorSigma);
        b[i] = covariance(neighbours.points[i], position);
    }
    const Eigen::LLT<Matrix> factor(a);  // positive definite by kOwnNoise
    const Vector weight = factor.solve(b);
    for (uint32_t i = 0; i < neighbours.used; i++) {
        prediction.row[i].node = neighbours.points[i].node;
        prediction.row[i].weight = weight[i];
    }
    combine(neighbours, position, weight, prediction.k);
    const double left = 1.0 + kAnyLevel + kOwnNoise - weight.dot(b);
    const double sigma = std::sqrt(process_variance(neighbours, factor) * std::fmax(left, kOwnNoise));
    prediction.sigma = std::fmin(sigma, corner_span(neighbours) + kPriorSigma);
    prediction.used = neighbours.used;
}

}  // namespace

uint32_t lp_drop_repeated(lp_falloff_node *nodes, uint32_t count, uint32_t *order) {
    for (uint32_t i = 0; i < count; i++) order[i] = i;
    std::sort(order, order + count, [nodes](uint32_t a, uint32_t b) {
        const int side = compare_curves(nodes[a], nodes[b]);
        if (side) return side < 0;
        const double of_a = nodes[a].distance_m, of_b = nodes[b].distance_m;
        return of_a != of_b ? of_a > of_b : a > b;
    });
    uint32_t kept = 0;  // the first of each run of order[], whose indices then rise again
    for (uint32_t i = 0; i < count; i++)
        if (!kept || compare_curves(nodes[order[kept - 1]], nodes[order[i]])) order[kept++] = order[i];
    std::sort(order, order + kept);
    for (uint32_t i = 0; i < kept; i++) nodes[i] = nodes[order[i]];
    return kept;
}

void lp_sample_falloff(const double k[3], double *values) {
    const lensprof_vignetting v{{k[0], k[1], k[2]}, {0.0, 0.0}};
    for (int i = 0; i < LP_FALLOFF_RADII; i++) {
        const double r = double(i) / (LP_FALLOFF_RADII - 1);
        values[i] = lensprof_vignetting_eval(&v, r * r, nullptr);
    }
}

void lp_fit_falloff(const double *values, double k[3]) {
    constexpr int kPowers[3] = {1, 2, 3};
    const auto terms = lensprof::fit_powers(kPowers, 3, LP_FALLOFF_RADII, 0, [&](int i) {
        const double r = double(i) / (LP_FALLOFF_RADII - 1);
        return lensprof::PowerSample{r * r, values[i] - 1.0, r};
    });
    std::copy_n(terms.data(), 3, k);
}

void lp_falloff_covariance(double sigma, double covariance[9]) {
    constexpr double kScatter[9] = {16.6525, -40.34, 24.2986, -40.34, 111.7629, -72.8463, 24.2986, -72.8463, 50.36};
    double corner_variance = 0.0;
    for (double value : kScatter) corner_variance += value;
    for (int i = 0; i < 9; i++) covariance[i] = kScatter[i] / corner_variance * sigma * sigma;
}

int lp_predict_falloff(const lp_falloff_nodes *nodes, const lp_falloff_node *target,
                       lp_falloff_prediction *prediction) {
    *prediction = {};
    prediction->nearest = INFINITY;
    const uint32_t count = nodes->count, used = std::min<uint32_t>(count, LP_NEIGHBOURS);
    const std::unique_ptr<Point[]> points(new (std::nothrow) Point[count]);
    if (!points) return -1;
    const Point position = sort_by_distance(nodes->node, count, *target, points.get());
    prediction->nearest = points[0].d;
    if (points[0].d > LP_FALLOFF_REACH) return 0;
    for (uint32_t i = 0; i < used; i++) {
        lp_falloff_node &node = nodes->node[points[i].node];
        if (node.variance == LP_VARIANCE_UNREAD && !nodes->read_variance(nodes->user, &node)) return -1;
    }
    krige({nodes->node, points.get(), used}, position, *prediction);
    return 1;
}
