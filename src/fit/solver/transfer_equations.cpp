#include "fit/solver/transfer_equations.hpp"

#include <cmath>

#include "fit/problem/residual.hpp"

namespace lensprof {

// One row per residual, scaled by the root of its weight: d prediction / d shared, d prediction / d delta, residual.
// The product of the rows with themselves contains the edge's whole contribution to the model.
struct TransferEquations::Rows {
    static constexpr Eigen::Index kCapacity = 128;
    Eigen::MatrixXd rows;  // one per column
    Eigen::MatrixXd product;
    Eigen::Index count = 0;

    explicit Rows(Eigen::Index n) : rows(n + 2, kCapacity), product(n + 2, n + 2) {}
};

// Contribution of a chunk of pairs to the model; its links are the edges from its first one on.
struct TransferEquations::Part : Sums {
    std::vector<Rows> rows;  // per channel, while the chunk is read

    using Sums::Sums;
};

TransferEquations::TransferEquations(const Problem &problem, const Prior &prior, const Loss &loss,
                                     const NoiseWeights &weights, const Estimate &estimate, const ModeTable &modes)
    : NormalEquations(problem, estimate) {
    auto n = static_cast<Eigen::Index>(columns_.size());
    Sums total(n, problem.image_count);
    std::vector<Part> parts(problem.chunks.size(), Part(n, problem.image_count));
    for_each_chunk(problem,
                   [&](uint32_t k) { add_chunk(problem.chunks[k], loss, weights, estimate, modes, parts[k]); });
    for (const Edge &edge : problem.edges) total.links.push_back({{edge.image[0], edge.image[1]}, {0.0, 0.0, 0.0}});
    for (size_t k = 0; k < parts.size(); k++) {
        total.add(parts[k]);
        for (size_t e = 0; e < parts[k].links.size(); e++) {
            auto &weight = total.links[problem.chunks[k].first_edge + e].weight;
            for (size_t c = 0; c < 3; c++) weight[c] += parts[k].links[e].weight[c];
        }
    }
    complete(total, prior, estimate);
}

void TransferEquations::add_chunk(const Chunk &chunk, const Loss &loss, const NoiseWeights &weights,
                                  const Estimate &estimate, const ModeTable &modes, Part &part) const {
    part.rows.assign(static_cast<size_t>(problem_.channels), Rows(part.gradient.size()));
    for (size_t p = chunk.first, e = chunk.first_edge; p < chunk.last; e++) {
        Edge piece = problem_.edges[e];
        piece.first = p;
        p = piece.last = std::min(piece.last, chunk.last);
        add_edge(piece, loss, weights, estimate, modes, part);
    }
    part.rows.clear();
}

void TransferEquations::add_edge(const Edge &edge, const Loss &loss, const NoiseWeights &weights,
                                 const Estimate &estimate, const ModeTable &modes, Part &part) const {
    auto n = static_cast<Eigen::Index>(columns_.size());
    auto ratio = exposure_ratios(problem_, estimate, edge);
    auto emor = static_cast<Eigen::Index>(modes_);
    part.links.push_back({{edge.image[0], edge.image[1]}, {0.0, 0.0, 0.0}});
    PairTransfer t;
    std::array<std::vector<double>, 3> lens;  // d delta / d shared, after the modes, per falloff curve
    for (size_t p = edge.first; p < edge.last; p++) {
        evaluate_pair(problem_, estimate, problem_.pairs[p], ratio.data(), t);
        PairResiduals factor, residuals = weighted_residuals(t, problem_.channels, weights[p]);
        part.objective += 0.5 * pair_cost(residuals, problem_.channels, loss, &factor);
        for (int curve = 0; curve < problem_.vignettings; curve++) {
            const Falloff &fall = t.fall[static_cast<size_t>(curve)];
            std::vector<double> &derivative = lens[static_cast<size_t>(curve)];
            derivative.assign(columns_.size(), 0.0);
            for (int side = 0; side < 2; side++)
                add_by_lens(problem_, columns_, fall.end[side], edge.image[side], curve, side ? -1.0 : 1.0,
                            derivative.data());
        }
        for (int c = 0; c < problem_.channels; c++) {
            const Transfer &transfer = t.channel[static_cast<size_t>(c)];
            const double *derivative = lens[problem_.vignettings == 3 ? static_cast<size_t>(c) : 0].data();
            for (int side = 0; side < 2; side++) {
                double by_delta = transfer.by_delta[side], root = weights[p][c][side] * std::sqrt(factor[c][side]);
                if (by_delta == 0.0 && transfer.by_value[side] == 0.0) continue;  // saturated prediction
                Rows &rows = part.rows[static_cast<size_t>(c)];
                double *row = rows.rows.col(rows.count).data();
                if (emor) modes.transfer_by_emor(transfer, side, root, row);
                for (Eigen::Index u = emor; u < n; u++) row[u] = root * by_delta * derivative[u];
                row[n] = root * by_delta;
                row[n + 1] = root * transfer.residual[side];
                if (++rows.count == Rows::kCapacity) add_rows(edge, c, part);
            }
        }
    }
    for (int c = 0; c < problem_.channels; c++) add_rows(edge, c, part);
}

void TransferEquations::add_rows(const Edge &edge, int channel, Part &part) {
    Rows &rows = part.rows[static_cast<size_t>(channel)];
    if (rows.count == 0) return;
    Eigen::Index n = part.gradient.size();
    rows.product.setZero();
    rows.product.selfadjointView<Eigen::Lower>().rankUpdate(rows.rows.leftCols(rows.count));
    rows.count = 0;
    const auto &product = rows.product;
    part.shared.triangularView<Eigen::Lower>() += product.topLeftCorner(n, n);
    part.gradient += product.row(n + 1).head(n).transpose();
    part.links.back().weight[static_cast<size_t>(channel)] += product(n, n);
    for (int end = 0; end < 2; end++) {
        Eigen::Index i = 3 * static_cast<Eigen::Index>(edge.image[end]) + channel;
        double sign = end == 0 ? 1.0 : -1.0;
        part.cross.col(i) += sign * product.row(n).head(n).transpose();
        part.image_gradient[i] += sign * product(n + 1, n);
    }
}

}  // namespace lensprof
