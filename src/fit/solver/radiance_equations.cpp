#include "fit/solver/radiance_equations.hpp"

#include <algorithm>
#include <cmath>

namespace lensprof {

// Contribution of a chunk of tracks to the model, and room for its rows. There is one row per residual, scaled by the
// root of its weight, with the radiance eliminated: d prediction / d shared, residual.
struct RadianceEquations::Part : Sums {
    static constexpr Eigen::Index kCapacity = 128;
    Eigen::MatrixXd rows, product;
    Eigen::Index count = 0;
    Eigen::MatrixXd by_shared;                       // of the current channel, one column per observation
    std::vector<std::array<double, 3>> link_weight;  // per link of the problem

    Part(Eigen::Index n, const Problem &problem)
        : Sums(n, problem.image_count),
          rows(n + 1, kCapacity),
          product(n + 1, n + 1),
          link_weight(problem.links.size(), {0.0, 0.0, 0.0}) {}
};

RadianceEquations::RadianceEquations(const Problem &problem, const Prior &prior, const Loss &loss, const Trust &trust,
                                     const Estimate &estimate, const ModeTable &modes)
    : NormalEquations(problem, estimate) {
    auto n = static_cast<Eigen::Index>(columns_.size());
    const TrackEvaluator evaluator(problem, estimate, loss);
    std::vector<Part> parts(problem.track_chunks.size(), Part(n, problem));
    for_each_track_chunk(problem,
                         [&](uint32_t k) { add_chunk(problem.track_chunks[k], evaluator, trust, modes, parts[k]); });
    Sums total(n, problem.image_count);
    for (const auto &link : problem.links) total.links.push_back({{link[0], link[1]}, {0.0, 0.0, 0.0}});
    for (const Part &part : parts) {
        total.add(part);
        for (size_t l = 0; l < total.links.size(); l++)
            for (size_t c = 0; c < 3; c++) total.links[l].weight[c] += part.link_weight[l][c];
    }
    complete(total, prior, estimate);
}

void RadianceEquations::add_chunk(const Range &chunk, const TrackEvaluator &evaluator, const Trust &trust,
                                  const ModeTable &modes, Part &part) const {
    TrackFit fit;
    for (size_t t = chunk.first; t < chunk.last; t++) {
        const Range &track = problem_.tracks.tracks[t];
        double factor;
        evaluator.evaluate(track, trust.data(), fit);
        part.objective += 0.5 * evaluator.cost(track, trust.data(), fit, &factor);
        for (int c = 0; c < problem_.channels; c++) add_channel(track, c, fit, factor, modes, part);
    }
    add_rows(part);
}

void RadianceEquations::add_channel(const Range &track, int channel, const TrackFit &fit, double factor,
                                    const ModeTable &modes, Part &part) const {
    auto n = static_cast<Eigen::Index>(columns_.size());
    auto c = static_cast<size_t>(channel);
    const auto &sightings = fit.channel[c];
    auto count = static_cast<Eigen::Index>(sightings.size());
    double stiffness = 0.0, pull = 0.0;                // v'Wv and v'Wr
    Eigen::VectorXd mixed = Eigen::VectorXd::Zero(n);  // J'Wv
    if (part.by_shared.cols() < count) part.by_shared.resize(n, count);
    for (Eigen::Index i = 0; i < count; i++) {
        const Sighting &s = sightings[static_cast<size_t>(i)];
        if (s.by_log == 0.0) continue;
        double weight = factor * s.weight, *row = part.by_shared.col(i).data();
        size_t curve = problem_.vignettings == 3 ? c : 0;
        const Attenuation &lens = fit.lens[static_cast<size_t>(i)][curve];
        std::fill(row + modes_, row + n, 0.0);
        add_by_lens(problem_, columns_, lens, problem_.tracks.observations[track.first + static_cast<size_t>(i)].image,
                    static_cast<int>(curve), 1.0, row);
        for (size_t u = modes_; u < columns_.size(); u++) row[u] *= s.by_log;
        if (modes_) modes.response_by_emor(s.x, 1.0, row);
        mixed += weight * s.by_log * part.by_shared.col(i);
        stiffness += weight * s.by_log * s.by_log;
        pull += weight * s.by_log * s.residual;
    }
    if (!(stiffness > 0.0)) return;
    for (Eigen::Index i = 0; i < count; i++) {
        const Sighting &s = sightings[static_cast<size_t>(i)];
        if (s.by_log == 0.0) continue;
        double weight = factor * s.weight, share = s.by_log / stiffness, root = std::sqrt(weight);
        auto image = problem_.tracks.observations[track.first + static_cast<size_t>(i)].image;
        auto column = part.by_shared.col(i), row = part.rows.col(part.count);
        row.head(n) = column - share * mixed;
        double residual = s.residual - share * pull;
        part.cross.col(3 * image + c) += weight * s.by_log * row.head(n);
        part.image_gradient[3 * image + c] += weight * s.by_log * residual;
        row.head(n) *= root;
        row[n] = root * residual;
        for (Eigen::Index j = i + 1; j < count; j++) {
            const Sighting &other = sightings[static_cast<size_t>(j)];
            if (other.by_log == 0.0) continue;
            uint32_t link =
                problem_.link_of(image, problem_.tracks.observations[track.first + static_cast<size_t>(j)].image);
            part.link_weight[link][c] +=
                weight * s.by_log * share * factor * other.weight * other.by_log * other.by_log;
        }
        if (++part.count == Part::kCapacity) add_rows(part);
    }
}

void RadianceEquations::add_rows(Part &part) {
    if (part.count == 0) return;
    Eigen::Index n = part.gradient.size();
    part.product.setZero();
    part.product.selfadjointView<Eigen::Lower>().rankUpdate(part.rows.leftCols(part.count));
    part.count = 0;
    part.shared.triangularView<Eigen::Lower>() += part.product.topLeftCorner(n, n);
    part.gradient += part.product.row(n).head(n).transpose();
}

}  // namespace lensprof
