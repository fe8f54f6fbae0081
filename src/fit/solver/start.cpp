#include "fit/solver/start.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/SparseCholesky>

#include "fit/base/constants.hpp"
#include "fit/problem/curve_shape.hpp"
#include "fit/problem/residual.hpp"

namespace lensprof {
namespace {

constexpr double kDarkest = 0.03, kBrightest = 0.97;  // grey values whose ratio is reliable

using Ratios = std::array<double, 3>;
using TieFactor = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;

// The log ratio that the exposures of two images must explain: ln g(B1)/M1 - ln g(B2)/M2, on which most of an edge's
// pairs agree, or that of one pair if there are too few.
struct Tie {
    uint32_t image[2];
    Ratios ratios;
    double votes;  // number that agree on it
    double trust = 1.0;
};

struct Vote {
    Ratios ratios{};
    uint32_t colour = 0;  // of both ends, quantised
    double weight = 1.0;
};

// A colour has one vote, however many pairs have it: an object of one colour in front of another agrees only with
// itself.
void weigh(std::vector<Vote> &votes) {
    std::vector<uint32_t> colours;
    for (const Vote &v : votes) colours.push_back(v.colour);
    std::sort(colours.begin(), colours.end());
    for (Vote &v : votes) {
        auto range = std::equal_range(colours.begin(), colours.end(), v.colour);
        v.weight = 1.0 / static_cast<double>(range.second - range.first);
    }
}

uint32_t colour_of(const lensprof_pair &pair, int channels) {
    uint32_t colour = 0;
    for (const auto &side : pair.value)
        for (int c = 0; c < channels; c++) colour = 16 * colour + static_cast<uint32_t>(15.99 * side[c]);
    return colour;
}

// The vector around which most votes lie within about `width`, all channels together, then the mean of those votes.
// Half and more of the pairs may be wrong, as long as they do not agree with each other. `support`: the votes that lie
// there.
Ratios mode_of(const std::vector<Vote> &all, int channels, double width, double &support) {
    constexpr size_t kGuesses = 48, kVoters = 192;
    auto closeness = [&](const Ratios &a, const Ratios &b) {
        double distance2 = 0.0;
        for (size_t c = 0; c < static_cast<size_t>(channels); c++) distance2 += (a[c] - b[c]) * (a[c] - b[c]);
        double z = distance2 / (width * width);
        return 1.0 / (1.0 + z * z);
    };
    auto for_every_guess = [&](size_t count, auto &&visit) {
        count = std::min(count, all.size());
        for (size_t n = 0; n < count; n++) visit(all[n * all.size() / count]);
    };
    Ratios best{};
    double most_votes = -1.0;
    for_every_guess(kGuesses, [&](const Vote &guess) {
        double votes = 0.0;
        for_every_guess(kVoters,
                        [&](const Vote &vote) { votes += vote.weight * closeness(guess.ratios, vote.ratios); });
        if (votes > most_votes) most_votes = votes, best = guess.ratios;
    });
    for (int round = 0; round < 3; round++) {
        double sum = 0.0;
        Ratios mean{};
        for (const Vote &vote : all) {
            double weight = vote.weight * closeness(best, vote.ratios);
            sum += weight;
            for (size_t c = 0; c < 3; c++) mean[c] += weight * vote.ratios[c];
        }
        for (size_t c = 0; c < 3; c++) best[c] = mean[c] / sum;
        support = sum;
    }
    return best;
}

std::vector<Vote> votes_of(const Problem &problem, const Estimate &estimate, const Edge &edge) {
    std::vector<Vote> votes;
    for (size_t p = edge.first; p < edge.last; p++) {
        const auto &pair = problem.pairs[p];
        double fall = falloff(problem, estimate, 0, pair).ratio;
        Vote vote;
        vote.colour = colour_of(pair, problem.channels);
        bool good = true;
        for (int c = 0; c < problem.channels && good; c++) {
            double b1 = pair.value[0][c], b2 = pair.value[1][c];
            good = std::min(b1, b2) >= kDarkest && std::max(b1, b2) <= kBrightest;
            if (!good) break;
            Transfer t = transfer(estimate, b1, b2, 1.0);
            vote.ratios[static_cast<size_t>(c)] = std::log(t.x[0] / t.x[1] / fall);
        }
        if (good) votes.push_back(vote);
    }
    return votes;
}

std::vector<Tie> ties_of(const Problem &problem, const Estimate &estimate, double width) {
    constexpr size_t kElectorate = 8;  // with this many pairs, the correct ones can outvote the wrong ones
    std::vector<Tie> ties;
    for (const Edge &edge : problem.edges) {
        std::vector<Vote> votes = votes_of(problem, estimate, edge);
        if (votes.size() < kElectorate) {
            for (const Vote &v : votes) ties.push_back({{edge.image[0], edge.image[1]}, v.ratios, 1.0});
            continue;
        }
        weigh(votes);
        double support = 0.0;
        Ratios mode = mode_of(votes, problem.channels, width, support);
        ties.push_back({{edge.image[0], edge.image[1]}, mode, support});
    }
    return ties;
}

// Weighted least squares over the ties; false if it failed numerically. `factor` keeps the order of elimination from
// one call to the next, because only the weights of the ties change.
bool add_exposures(const Problem &problem, const std::vector<Tie> &ties, TieFactor &factor, Estimate &estimate) {
    int count = problem.image_unknowns;
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
    for (int q = 0; q < count; q++) entries.emplace_back(q, q, 1e-3);
    for (const Tie &tie : ties)
        for (size_t c = 0; c < static_cast<size_t>(problem.channels); c++) {
            // One equation: sum of the unknowns of image 1 minus those of image 2 = ratio minus fixed values.
            uint32_t i = tie.image[0], j = tie.image[1];
            const auto first = problem.columns_of(i, static_cast<int>(c)),
                       second = problem.columns_of(j, static_cast<int>(c));
            const int q[4] = {first[0], first[1], second[0], second[1]};
            double target = tie.ratios[c] - (estimate.log_exposure[i][c] - estimate.log_exposure[j][c]);
            double weight = tie.votes * tie.trust;
            for (int a = 0; a < 4; a++) {
                if (q[a] < 0) continue;
                double sign = a < 2 ? 1.0 : -1.0;
                right[q[a]] += weight * sign * target;
                for (int b = 0; b < 4; b++)
                    if (q[b] >= 0) entries.emplace_back(q[a], q[b], weight * sign * (b < 2 ? 1.0 : -1.0));
            }
        }
    Eigen::SparseMatrix<double> matrix(count, count);
    matrix.setFromTriplets(entries.begin(), entries.end());
    if (factor.rows() == 0) factor.analyzePattern(matrix);
    factor.factorize(matrix);
    if (factor.info() != Eigen::Success) return false;
    Eigen::VectorXd q = factor.solve(right);
    if (!q.allFinite()) return false;
    for (uint32_t i = 0; i < problem.image_count; i++)
        for (int c = 0; c < problem.channels; c++)
            for (int unknown : problem.columns_of(i, c))
                if (unknown >= 0) estimate.log_exposure[i][c] += std::clamp(q[unknown], -10.0, 10.0);
    return true;
}

// Distance of a tie from the exposures, over all channels, natural logarithm.
double tie_distance(const Problem &problem, const Tie &tie, const Estimate &estimate) {
    const auto &a = estimate.log_exposure[tie.image[0]], &b = estimate.log_exposure[tie.image[1]];
    double off2 = 0.0;
    for (size_t c = 0; c < static_cast<size_t>(problem.channels); c++) {
        double off = tie.ratios[c] - (a[c] - b[c]);
        off2 += off * off;
    }
    return std::sqrt(off2);
}

}  // namespace

// Minimises the sum of the distances (convex: the loops outvote wrong ties, from any start), then least squares over
// the ties that are near.
void start_exposures(const Problem &problem, double width, Estimate &estimate) {
    constexpr int kDistanceRounds = 8, kNearRounds = 4;
    constexpr double kExact = 0.05, kNear = 0.3;  // natural logarithm: allowed error of a tie
    if (problem.image_unknowns == 0) return;
    auto ties = ties_of(problem, estimate, width);
    TieFactor factor;
    for (int round = 0; round <= kDistanceRounds + kNearRounds && add_exposures(problem, ties, factor, estimate);
         round++)
        for (Tie &tie : ties) {
            double off = tie_distance(problem, tie, estimate), z = off / kNear;
            tie.trust = round < kDistanceRounds ? 1.0 / std::hypot(off, kExact) : 1.0 / ((1.0 + z * z) * (1.0 + z * z));
        }
    const auto zero = estimate.log_exposure[problem.reference];
    for (uint32_t i = 0; i < problem.image_count; i++)
        for (size_t c = 0; c < static_cast<size_t>(problem.channels); c++)
            if (problem.ev_unknown[i] >= 0)
                estimate.log_exposure[i][c] = std::clamp(estimate.log_exposure[i][c], zero[c] - kLargestLogExposure,
                                                         zero[c] + kLargestLogExposure);
}

std::vector<Estimate> start_estimates(const Problem &problem, const lensprof_fit_options &options, int modes) {
    Estimate base;
    const lensprof_vignetting &given = options.vignetting;
    base.vignetting.assign(static_cast<size_t>(problem.settings), Falloffs{given, given, given});
    const lensprof_exposure reference = given_exposure(problem.images, problem.reference);
    for (uint32_t i = 0; i < problem.image_count; i++) {
        const lensprof_exposure exposure = given_exposure(problem.images, i);
        std::array<double, 3> a{};
        for (int c = 0; c < 3; c++) {
            bool grey = problem.channels == 1;
            a[c] = (problem.ev_unknown[i] >= 0 ? reference.ev : exposure.ev) * kLn2
                   + (grey || problem.balance_unknown[i][c] >= 0 ? 0.0 : std::log(exposure.white_balance[c]));
        }
        base.log_exposure.push_back(a);
    }
    std::vector<Estimate> starts;
    auto add = [&](const double *emor) {
        Estimate start = base;
        if (emor) set_response(start, emor, modes);
        start_exposures(problem, kRoughWidth, start);
        starts.push_back(std::move(start));
    };
    if (!(options.free & LENSPROF_FREE_RESPONSE) || modes == 0) {
        lensprof_response held;
        if (options.response)
            held = *options.response;
        else if (lensprof_response_set_emor(&held, nullptr, 0) != LENSPROF_OK)
            lensprof_response_set_linear(&held);
        set_fixed(base, held);
        add(nullptr);
        return starts;
    }
    for (double exponent : {0.0, 1.0, 1.0 / 1.8, 1.0 / 4.0}) {
        double curve[LENSPROF_RESPONSE_SAMPLES];
        for (int j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++)
            curve[j] = exponent == 0.0 ? lensprof_emor_table(0)[j] : std::pow(j / 1023.0, exponent);
        add(project_curve(curve, modes).data());
    }
    return starts;
}

}  // namespace lensprof
