// What scenes contain, as a distribution: the logarithm of a cell's light, relative to level and shading, in all
// pictures together. A narrow component is an even background; dark and bright things have components of their own.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace lensprof {

// A mixture of normal distributions, fitted by expectation maximisation (Dempster, Laird and Rubin 1977) to a
// histogram, and tabulated.
class Content {
public:
    // Starts from quantiles of the values.
    void start(const std::vector<float> &values);

    // Fits the components to the values, from where they are; NaN are not counted.
    void fit(const std::vector<float> &values, int rounds);

    // Of a value e, with p_k(e) the probability that it belongs to component k:
    struct Pull {
        double weight;  // sum of p_k / sigma_k^2
        double force;   // sum of p_k (e - mean_k) / sigma_k^2
        double cost;    // minus the logarithm of the density
    };
    Pull at(float value) const {
        double place = (static_cast<double>(value) - low_) * scale_;
        place = place > 0.0 ? (place < kEntries - 1.001 ? place : kEntries - 1.001) : 0.0;
        const auto i = static_cast<size_t>(place);
        const double f = place - static_cast<double>(i), g = 1.0 - f;
        return {g * table_[i].weight + f * table_[i + 1].weight, g * table_[i].force + f * table_[i + 1].force,
                g * table_[i].cost + f * table_[i + 1].cost};
    }

    double narrowest_share() const;  // of the narrowest component that has at least 5 %
    double narrowest_sigma() const;

private:
    static constexpr size_t kComponents = 6, kEntries = 2048;
    using Each = std::array<double, kComponents>;

    Each probabilities(double value) const;
    void tabulate();
    size_t narrowest() const;

    Each share_{}, mean_{}, sigma_{};
    double low_ = 0.0, scale_ = 1.0;  // of the table
    std::vector<Pull> table_;
};

}  // namespace lensprof
