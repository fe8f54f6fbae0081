#include "fit/solver/inflation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>

#include "fit/problem/residual.hpp"
#include "fit/solver/objective.hpp"

namespace lensprof {
namespace {

constexpr size_t kSizes = 4;
constexpr int kAcross[kSizes] = {8, 4, 2, 1};  // places per side of the frame: errors are common to places of any size
constexpr size_t kMaxPairs = 50000;            // with more, one of so many is used, of every link
constexpr double kLargest = 1e4;               // of the inflation
constexpr Eigen::Index kBlock = 32;            // directions whose influences are summed at a time, which bounds memory

// Directions of the full shared vector whose errors are measured, and what they belong to.
struct Directions {
    Eigen::MatrixXd columns;  // one column per direction, in the model's unknowns
    std::vector<int> group;   // 0: the response; 1 + 2 s: the falloff of setting s; 2 + 2 s: its centre
};

Directions directions_of(const Problem &problem, const std::vector<int> &unknowns) {
    const auto n = static_cast<Eigen::Index>(unknowns.size());
    std::vector<Eigen::VectorXd> found;
    Directions result;
    const auto add = [&](int group, const auto &value_of) {
        Eigen::VectorXd direction(n);
        for (Eigen::Index u = 0; u < n; u++) direction[u] = value_of(unknowns[static_cast<size_t>(u)]);
        if (direction.isZero()) return;
        found.push_back(direction), result.group.push_back(group);
    };
    for (int l = 0; l < kMaxModes; l++) add(0, [&](int column) { return column == l ? 1.0 : 0.0; });
    for (int s = 0; s < problem.settings; s++) {
        const int green = green_falloff(problem.vignettings, s);
        for (const double r2 : {0.25, 0.5625, 1.0})  // M there
            add(1 + 2 * s, [&](int column) {
                const int power = column - green;
                return power >= 0 && power < 3 ? std::pow(r2, power + 1) : 0.0;
            });
        for (int d = 0; d < 2; d++)
            add(2 + 2 * s, [&](int column) { return column == center_column(s) + d ? 1.0 : 0.0; });
    }
    result.columns.resize(n, static_cast<Eigen::Index>(found.size()));
    for (size_t k = 0; k < found.size(); k++) result.columns.col(static_cast<Eigen::Index>(k)) = found[k];
    return result;
}

// The influence of a pair on the estimate along each direction, and last on the exposure between its images.
class Influence {
public:
    // `by_shared`: covariance of the shared unknowns times each direction; `by_image`: what the images follow by.
    Influence(const Problem &problem, const Estimate &estimate, const Loss &loss, const std::vector<int> &unknowns,
              Eigen::MatrixXd by_shared, Eigen::MatrixXd by_image)
        : problem_(problem),
          loss_(loss),
          modes_(std::max(estimate.modes, 0)),
          unknowns_(unknowns),
          by_shared_(std::move(by_shared)),
          by_image_(std::move(by_image)),
          derivative_(unknowns.size()) {}

    Eigen::Index directions() const { return by_shared_.cols() + 1; }

    Eigen::VectorXd of(const lensprof_pair &pair, const PairTransfer &t) {
        Eigen::VectorXd result = Eigen::VectorXd::Zero(directions());
        const PairWeights weights = pair_weights(t, problem_.channels, loss_);
        PairResiduals factor;
        pair_cost(weighted_residuals(t, problem_.channels, weights), problem_.channels, loss_, &factor);
        std::fill(derivative_.begin(), derivative_.end(), 0.0);
        for (int c = 0; c < problem_.channels; c++) {
            const double by_delta = add_response(t.channel[static_cast<size_t>(c)], weights[c], factor[c]);
            const int curve = problem_.vignettings == 3 ? c : 0;
            for (int side = 0; side < 2; side++) {
                const double pull = side ? -by_delta : by_delta;
                add_by_lens(problem_, unknowns_, t.fall[static_cast<size_t>(curve)].end[side], pair.image[side], curve,
                            pull, derivative_.data());
                for (const int q : problem_.columns_of(pair.image[side], c))
                    if (q >= 0) result.head(by_image_.cols()) -= pull * by_image_.row(q).transpose();
            }
            result[directions() - 1] += by_delta;
        }
        const auto n = static_cast<Eigen::Index>(derivative_.size());
        result.head(by_shared_.cols()) += by_shared_.transpose() * Eigen::VectorXd::Map(derivative_.data(), n);
        return result;
    }

private:
    // Adds the derivatives by the modes; returns that by delta.
    double add_response(const Transfer &transfer, const std::array<float, 2> &weight,
                        const std::array<double, 2> &factor) {
        std::vector<double> by_mode(static_cast<size_t>(modes_.modes()));
        const size_t modes = leading_modes(unknowns_);
        double by_delta = 0.0;
        for (int side = 0; side < 2; side++) {
            const auto direction = static_cast<size_t>(side);
            const double pull = factor[direction] * weight[direction] * weight[direction] * transfer.residual[side];
            by_delta += pull * transfer.by_delta[side];
            if (modes) modes_.transfer_by_emor(transfer, side, pull, by_mode.data());
            for (size_t u = 0; u < modes; u++) derivative_[u] += by_mode[u];
        }
        return by_delta;
    }

    const Problem &problem_;
    const Loss &loss_;
    const ModeTable modes_;
    const std::vector<int> &unknowns_;
    const Eigen::MatrixXd by_shared_, by_image_;
    std::vector<double> derivative_;  // of minus the cost, by the shared unknowns
};

// Sums over pairs, and over places of one size, of squared influences. A place is a part of a picture; the error of
// what it shows is common to all pairs with an end there, in whatever other picture the other end is (dyadic clusters,
// Aronow, Samii & Assenova 2015): squares of sums over places, less those over pairs of places, which count twice.
struct Sums {
    Eigen::VectorXd apart;
    std::array<Eigen::VectorXd, kSizes> together;
    std::array<double, kSizes> places{};
    size_t step =
        1;  // one of so many pairs was used: the terms of two pairs are rarer by this factor than those of one

    // Ratio of both. The estimate follows the errors of its own pairs, which makes what is left smaller: places that
    // are few compared with the unknowns show less. The largest of several ratios is used: each is lowered by its own
    // standard error, which is that of a variance from so many places.
    Eigen::VectorXd ratio(size_t size, double unknowns) const {
        const double count = std::max(places[size], 1.0), left = std::max(count - unknowns, count / 3.0);
        const auto thinned = static_cast<double>(step);
        const Eigen::ArrayXd ratio =
            1.0 + (together[size].array() / (apart.array() + 1e-300) - 1.0) * thinned * count / left;
        return (ratio / (1.0 + thinned * std::sqrt(2.0 / count))).matrix();
    }
};

using PlaceSums = std::map<std::array<uint32_t, 2>, Eigen::VectorXd>;

void add_to(PlaceSums &sums, const std::array<uint32_t, 2> &key, const Eigen::VectorXd &value) {
    const auto [found, is_new] = sums.try_emplace(key, value);
    if (!is_new) found->second += value;
}

Eigen::VectorXd squares_of(const PlaceSums &sums, Eigen::Index rows) {
    Eigen::VectorXd total = Eigen::VectorXd::Zero(rows);
    for (const auto &[place, sum] : sums) total += sum.cwiseAbs2();
    return total;
}

Sums sums_of(const Problem &problem, const Estimate &estimate, Influence &influence) {
    const Eigen::Index rows = influence.directions();
    Sums sums;
    sums.apart = Eigen::VectorXd::Zero(rows);
    sums.together.fill(sums.apart);
    std::array<PlaceSums, kSizes> of_place;  // by image and place
    sums.step = 1 + problem.pairs.size() / kMaxPairs;
    for (const Edge &edge : problem.edges) {
        const auto ratio = exposure_ratios(problem, estimate, edge);
        std::array<PlaceSums, kSizes> of_two;  // by the places of both ends
        PairTransfer transfer;
        const size_t skipped = (sums.step - edge.first % sums.step) % sums.step;
        for (size_t p = edge.first + skipped; p < edge.last; p += sums.step) {
            const lensprof_pair &pair = problem.pairs[p];
            evaluate_pair(problem, estimate, pair, ratio.data(), transfer);
            const Eigen::VectorXd value = influence.of(pair, transfer);
            sums.apart += value.cwiseAbs2();
            for (size_t size = 0; size < kSizes; size++) {
                std::array<uint32_t, 2> place{};
                for (size_t side = 0; side < 2; side++) {
                    place[side] = place_in_frame(problem.images[edge.image[side]], pair.xy[side], kAcross[size]);
                    add_to(of_place[size], {edge.image[side], place[side]}, value);
                }
                add_to(of_two[size], place, value);
            }
        }
        for (size_t size = 0; size < kSizes; size++) sums.together[size] -= squares_of(of_two[size], rows);
    }
    for (size_t size = 0; size < kSizes; size++) {
        sums.together[size] += squares_of(of_place[size], rows);
        sums.places[size] = static_cast<double>(of_place[size].size());
    }
    return sums;
}

}  // namespace

double Inflation::of_column(int column) const {
    if (column < kMaxModes) return response;
    return lens[static_cast<size_t>(lens_column(column).setting)];
}

Inflation error_inflation(const Problem &problem, const Prior &prior, Gauge &gauge, const Loss &loss,
                          const Estimate &estimate) {
    Inflation result(problem.settings);
    Prior renewed = prior_of(prior, estimate.modes);
    gauge.renew(problem, estimate, renewed);
    const auto model = make_objective(problem, renewed, loss, estimate)->model_at(estimate);
    const Directions directions = directions_of(problem, model->columns());
    if (!model->reduce(0.0)) return result;
    const Eigen::LLT<Eigen::MatrixXd> factor(model->reduced_hessian());
    if (directions.columns.cols() > 0 && factor.info() != Eigen::Success) return result;
    const double unknowns =
        static_cast<double>(model->columns().size()) + double(problem.image_unknowns) / problem.channels;
    const Eigen::Index count = directions.columns.cols();
    Eigen::MatrixXd ratios(count + 1, kSizes);  // per direction, and last of the exposures
    for (Eigen::Index first = 0; first == 0 || first < count; first += kBlock) {
        const Eigen::Index width = std::min(kBlock, count - first);
        const Eigen::MatrixXd block = directions.columns.middleCols(first, width);
        const Eigen::MatrixXd by_shared = width ? Eigen::MatrixXd(factor.solve(block)) : block;
        Influence influence(problem, estimate, loss, model->columns(), by_shared, model->images_by(by_shared));
        const Sums sums = sums_of(problem, estimate, influence);
        for (size_t size = 0; size < kSizes; size++) {
            const Eigen::VectorXd ratio = sums.ratio(size, unknowns);
            ratios.block(first, static_cast<Eigen::Index>(size), width, 1) = ratio.head(width);
            ratios(count, static_cast<Eigen::Index>(size)) = ratio[width];
        }
    }
    for (Eigen::Index size = 0; size < ratios.cols(); size++) {
        const auto take = [&](double &target, int group) {
            double sum = 0.0, members = 0.0;
            for (size_t k = 0; k < directions.group.size(); k++)
                if (directions.group[k] == group) sum += ratios(static_cast<Eigen::Index>(k), size), members += 1.0;
            if (members > 0.0) target = std::clamp(sum / members, target, kLargest);
        };
        take(result.response, 0);
        for (int s = 0; s < problem.settings; s++) {
            // Falloff and centre suffer from the same errors, and each is measured from few places: the larger counts.
            take(result.lens[static_cast<size_t>(s)], 1 + 2 * s);
            take(result.lens[static_cast<size_t>(s)], 2 + 2 * s);
        }
        result.exposures = std::clamp(ratios(count, size), result.exposures, kLargest);
    }
    return result;
}

}  // namespace lensprof
