#include "fit/solver/objective.hpp"

#include <algorithm>

#include "fit/solver/radiance_equations.hpp"
#include "fit/solver/transfer_equations.hpp"

namespace lensprof {
namespace {

// Common parts of the two objectives.
class Base : public Objective {
public:
    Base(const Problem &problem, const Prior &prior, const Loss &loss, const Estimate &estimate)
        : problem_(problem), prior_(prior), loss_(loss), modes_(std::max(estimate.modes, 0)) {}

protected:
    double prior_at(const Estimate &estimate) const {
        return prior_cost(prior_, problem_, free_columns(problem_, estimate.modes), estimate);
    }

    const Problem &problem_;
    const Prior &prior_;
    const Loss &loss_;
    const ModeTable modes_;
};

class TransferObjective : public Base {
public:
    TransferObjective(const Problem &problem, const Prior &prior, const Loss &loss, const Estimate &estimate)
        : Base(problem, prior, loss, estimate), weights_(noise_weights(problem, estimate, loss)) {}

    std::unique_ptr<NormalEquations> model_at(const Estimate &estimate) const override {
        return std::make_unique<TransferEquations>(problem_, prior_, loss_, weights_, estimate, modes_);
    }
    double value_at(const Estimate &estimate) const override {
        double value = prior_at(estimate);
        for_each_transfer(problem_, estimate, [&](size_t p, const PairTransfer &t) {
            PairResiduals residuals = weighted_residuals(t, problem_.channels, weights_[p]);
            value += 0.5 * pair_cost(residuals, problem_.channels, loss_, nullptr);
        });
        return value;
    }

private:
    const NoiseWeights weights_;
};

class RadianceObjective : public Base {
public:
    RadianceObjective(const Problem &problem, const Prior &prior, const Loss &loss, const Estimate &estimate)
        : Base(problem, prior, loss, estimate), trust_(find_trust(problem, estimate, loss)) {}

    std::unique_ptr<NormalEquations> model_at(const Estimate &estimate) const override {
        return std::make_unique<RadianceEquations>(problem_, prior_, loss_, trust_, estimate, modes_);
    }
    double value_at(const Estimate &estimate) const override {
        return prior_at(estimate) + radiance_cost(problem_, estimate, loss_, trust_);
    }

private:
    const Trust trust_;
};

}  // namespace

std::unique_ptr<Objective> make_objective(const Problem &problem, const Prior &prior, const Loss &loss,
                                          const Estimate &estimate) {
    if (problem.by_radiance) return std::make_unique<RadianceObjective>(problem, prior, loss, estimate);
    return std::make_unique<TransferObjective>(problem, prior, loss, estimate);
}

std::vector<double> all_costs(const Problem &problem, const Loss &loss, const Estimate &estimate) {
    if (problem.by_radiance) return track_costs(problem, estimate, loss, find_trust(problem, estimate, loss));
    std::vector<double> costs;
    NoiseWeights weights = noise_weights(problem, estimate, loss);
    for_each_transfer(problem, estimate, [&](size_t p, const PairTransfer &t) {
        PairResiduals residuals = weighted_residuals(t, problem.channels, weights[p]);
        costs.push_back(pair_cost(residuals, problem.channels, loss, nullptr));
    });
    return costs;
}

}  // namespace lensprof
