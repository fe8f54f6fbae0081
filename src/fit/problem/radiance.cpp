#include "fit/problem/radiance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "fit/base/parallel.hpp"

namespace lensprof {
namespace {

constexpr int kSteps = 60;        // of the search for a radiance: two or three are usual, kinks of f need more
constexpr double kStill = 1e-13;  // relative step at which it ends
constexpr size_t kSuspects = 3;   // observations of a track that are tentatively left out
constexpr double kHalfTurn = 1.5707963267948966;

using Kind = Sighting::Kind;

bool is_measured(const Sighting &s) { return s.kind == Kind::measured; }

// The largest robust loss of an observation, which is also the cost of one that is not trusted.
double most_cost(const Problem &problem, const Loss &loss) {
    return loss.cutoff * loss.cutoff * problem.channels * kHalfTurn;
}

}  // namespace

TrackEvaluator::TrackEvaluator(const Problem &problem, const Estimate &estimate, const Loss &loss)
    : problem_(problem), estimate_(estimate), loss_(loss) {
    for (const auto &a : estimate.log_exposure) exposure_.push_back({std::exp(a[0]), std::exp(a[1]), std::exp(a[2])});
}

Sighting TrackEvaluator::sighting(const lensprof_observation &observation, int channel, double attenuation,
                                  bool trusted) const {
    Sighting s{};
    s.value = observation.value[channel];
    s.kind = !trusted           ? Kind::unused
             : s.value > kWhite ? Kind::at_least
             : s.value < kBlack ? Kind::at_most
                                : Kind::measured;
    if (s.kind == Kind::at_least) s.value = kWhite;
    if (s.kind == Kind::at_most) s.value = kBlack;
    s.factor = attenuation * exposure_[observation.image][static_cast<size_t>(channel)];
    return s;
}

void TrackEvaluator::predict(double radiance, std::vector<Sighting> &sightings) const {
    for (Sighting &s : sightings) {
        double slope;
        s.x = s.factor * radiance;
        s.residual = s.value - response_at(estimate_, s.x, &slope);
        s.by_log = slope * s.x;
        s.weight = 1.0;
        if ((s.kind == Kind::at_least && s.residual < 0.0) || (s.kind == Kind::at_most && s.residual > 0.0)
            || s.kind == Kind::unused)
            s.residual = s.by_log = 0.0;
        if (loss_.kind == LENSPROF_LOSS_HUBER && std::abs(s.residual) > loss_.huber)
            s.weight = loss_.huber / std::abs(s.residual);
    }
}

// Newton's method within bounds. Every residual falls with L, so that the minimum is between the radiances that single
// observations require. f is linear between its samples, where a step is exact.
double TrackEvaluator::solve(std::vector<Sighting> &sightings) const {
    double low = std::numeric_limits<double>::infinity(), high = 0.0, top = 0.0, bottom = 0.0;
    if (!std::any_of(sightings.begin(), sightings.end(), is_measured)) {
        for (Sighting &s : sightings) s.residual = s.by_log = s.x = 0.0, s.weight = 1.0;
        return 0.0;
    }
    for (const Sighting &s : sightings) {
        if (s.kind == Kind::unused) continue;
        double inverse_slope, estimate = irradiance_of(estimate_, s.value, &inverse_slope) / s.factor;
        if (s.kind != Kind::at_least) low = std::min(low, estimate);
        if (s.kind != Kind::at_most) high = std::max(high, estimate);
        if (!is_measured(s) || !(inverse_slope > 0.0)) continue;
        double slope = s.factor / inverse_slope;
        top += slope * slope * estimate, bottom += slope * slope;
    }
    double radiance = bottom > 0.0 ? std::clamp(top / bottom, low, std::max(low, high)) : 0.5 * (low + high);
    for (int n = 0; n < kSteps; n++) {
        predict(radiance, sightings);
        double pull = 0.0, stiffness = 0.0;
        for (const Sighting &s : sightings)
            pull += s.weight * s.residual * s.by_log, stiffness += s.weight * s.by_log * s.by_log;
        (pull > 0.0 ? low : high) = radiance;
        double next = radiance * (1.0 + pull / stiffness);
        if (!(next >= low && next <= high)) next = 0.5 * (low + high);
        if (std::abs(next - radiance) <= kStill * radiance) break;
        radiance = next;
    }
    return radiance;
}

void TrackEvaluator::evaluate(const Range &track, const uint8_t *trust, TrackFit &fit) const {
    size_t count = track.last - track.first;
    fit.lens.resize(count);
    fit.freedom = 0;
    for (size_t i = 0; i < count; i++) {
        const auto &o = problem_.tracks.observations[track.first + i];
        for (size_t curve = 0; curve < static_cast<size_t>(problem_.vignettings); curve++)
            fit.lens[i][curve] = attenuation(problem_, estimate_, curve, o.image, o.xy);
    }
    for (int c = 0; c < problem_.channels; c++) {
        auto &sightings = fit.channel[static_cast<size_t>(c)];
        sightings.resize(count);
        int used = 0;
        for (size_t i = 0; i < count; i++) {
            double m = fit.lens[i][problem_.vignettings == 3 ? static_cast<size_t>(c) : 0].m;
            sightings[i] = sighting(problem_.tracks.observations[track.first + i], c, m, trust[track.first + i]);
            used += sightings[i].kind != Kind::unused;
        }
        fit.radiance[static_cast<size_t>(c)] = solve(sightings);
        if (fit.radiance[static_cast<size_t>(c)] > 0.0) fit.freedom += used - 1;
    }
}

double TrackEvaluator::cost(const Range &track, const uint8_t *trust, const TrackFit &fit, double *factor) const {
    double sum = 0.0, scale = 1.0 / (loss_.noise * loss_.noise), sigma = loss_.huber;
    for (int c = 0; c < problem_.channels; c++)
        for (const Sighting &s : fit.channel[static_cast<size_t>(c)]) {
            double e = std::abs(s.residual);
            sum += scale * (s.weight < 1.0 ? 2.0 * sigma * e - sigma * sigma : e * e);
        }
    if (factor) *factor = scale;
    if (loss_.kind != LENSPROF_LOSS_ROBUST) return sum;
    auto out = std::count(trust + track.first, trust + track.last, uint8_t{0});
    double c2 = loss_.cutoff * loss_.cutoff * std::max(fit.freedom, 1), q = sum / c2;
    if (factor) *factor = scale / (1.0 + q * q);
    return c2 * std::atan(q) + static_cast<double>(out) * most_cost(problem_, loss_);
}

// Leaving out an observation reduces the sum of squares by about its squared residual divided by the share of it that
// the others do not explain. Tries the few observations with the largest reduction.
void TrackEvaluator::distrust(const Range &track, uint8_t *trust) const {
    size_t count = track.last - track.first;
    TrackFit fit;
    evaluate(track, trust, fit);
    double current = cost(track, trust, fit, nullptr), max_cost = most_cost(problem_, loss_);
    for (size_t out = 0; out + 2 < count && current - static_cast<double>(out) * max_cost > max_cost; out++) {
        std::vector<std::pair<double, size_t>> suspects;
        for (size_t i = 0; i < count; i++) {
            double fall = 0.0;
            for (int c = 0; c < problem_.channels; c++) {
                double stiffness = 0.0;
                for (const Sighting &s : fit.channel[static_cast<size_t>(c)]) stiffness += s.by_log * s.by_log;
                const Sighting &s = fit.channel[static_cast<size_t>(c)][i];
                double others = stiffness > 0.0 ? 1.0 - s.by_log * s.by_log / stiffness : 1.0;
                fall += s.residual * s.residual / std::max(others, 1e-3);
            }
            if (trust[track.first + i]) suspects.emplace_back(-fall, i);
        }
        std::sort(suspects.begin(), suspects.end());
        double best = current;
        size_t worst = count;
        for (size_t n = 0; n < std::min(kSuspects, suspects.size()); n++) {
            uint8_t &is_trusted = trust[track.first + suspects[n].second];
            is_trusted = 0;
            evaluate(track, trust, fit);
            double without = cost(track, trust, fit, nullptr);
            is_trusted = 1;
            if (without < best) best = without, worst = suspects[n].second;
        }
        if (worst == count) return;
        trust[track.first + worst] = 0;
        evaluate(track, trust, fit);
        current = best;
    }
}

void for_each_track_chunk(const Problem &problem, const std::function<void(uint32_t)> &work) {
    for_each_parallel(static_cast<uint32_t>(problem.track_chunks.size()), problem.threads, work, [] { return false; });
}

Trust trust_all(const Problem &problem) { return Trust(problem.tracks.observations.size(), 1); }

Trust find_trust(const Problem &problem, const Estimate &estimate, const Loss &loss) {
    Trust trust = trust_all(problem);
    if (loss.kind != LENSPROF_LOSS_ROBUST || !loss.distrusts) return trust;
    const TrackEvaluator evaluator(problem, estimate, loss);
    for_each_track_chunk(problem, [&](uint32_t k) {
        const Range &chunk = problem.track_chunks[k];
        for (size_t t = chunk.first; t < chunk.last; t++) evaluator.distrust(problem.tracks.tracks[t], trust.data());
    });
    return trust;
}

std::vector<double> track_costs(const Problem &problem, const Estimate &estimate, const Loss &loss,
                                const Trust &trust) {
    std::vector<double> costs(problem.tracks.tracks.size());
    const TrackEvaluator evaluator(problem, estimate, loss);
    for_each_track_chunk(problem, [&](uint32_t k) {
        const Range &chunk = problem.track_chunks[k];
        TrackFit fit;
        for (size_t t = chunk.first; t < chunk.last; t++) {
            const Range &track = problem.tracks.tracks[t];
            evaluator.evaluate(track, trust.data(), fit);
            costs[t] = evaluator.cost(track, trust.data(), fit, nullptr);
        }
    });
    return costs;
}

double radiance_cost(const Problem &problem, const Estimate &estimate, const Loss &loss, const Trust &trust) {
    std::vector<double> costs = track_costs(problem, estimate, loss, trust);
    return 0.5 * std::accumulate(costs.begin(), costs.end(), 0.0);
}

}  // namespace lensprof
