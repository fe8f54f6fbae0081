// Functions of the grey value sampled at the levels 1..255 of 255 and linear in between, such as ln f^-1.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include <Eigen/Core>

#include <lensprof/model.h>

namespace lensprof {

constexpr int kLevels = 255;  // element k - 1 holds level k

// Position of a grey value between two levels: element of the lower one and weight of the upper one.
struct Place {
    int low;
    double share;
};

// Position of a grey value 0..1; below level `first` the function is constant.
inline Place place_of(double b, double first = 1.0) {
    double level = std::clamp(b * 255.0, first, 255.0) - 1.0;
    int low = std::min(static_cast<int>(level), kLevels - 2);
    return {low, level - low};
}

inline double value_at(const std::array<double, kLevels> &function, Place p) {
    auto low = static_cast<size_t>(p.low);
    return (1.0 - p.share) * function[low] + p.share * function[low + 1];
}

// f at the 1024 samples of irradiance from inverse(grey value 0..1), made monotone and scaled to 1 at white.
template <class Inverse>
std::array<double, LENSPROF_RESPONSE_SAMPLES> response_samples(Inverse inverse) {
    constexpr int kFine = 16;  // samples of the inverse between two levels
    constexpr int count = 255 * kFine;
    std::vector<double> x(count + 1, 0.0);
    for (size_t i = 1; i < x.size(); i++) x[i] = std::max(x[i - 1], inverse(static_cast<double>(i) / count));
    std::array<double, LENSPROF_RESPONSE_SAMPLES> f{};
    constexpr size_t last = LENSPROF_RESPONSE_SAMPLES - 1;
    for (size_t j = 1, i = 0; j < last; j++) {
        double level = x.back() * static_cast<double>(j) / last;
        while (x[i + 1] < level) i++;
        f[j] = (static_cast<double>(i) + (level - x[i]) / (x[i + 1] - x[i])) / count;
    }
    f.back() = 1.0;
    return f;
}

// The normal equations of linear least squares, accumulated row by row.
struct NormalRows {
    Eigen::MatrixXd normal;
    Eigen::VectorXd right;

    explicit NormalRows(Eigen::Index size)
        : normal(Eigen::MatrixXd::Zero(size, size)), right(Eigen::VectorXd::Zero(size)) {}

    // Adds the row  value = sum of coefficients times unknowns; unknowns in column -1 are fixed at 0.
    void add(const int *column, const double *coefficient, int count, double value, double weight) {
        for (int i = 0; i < count; i++) {
            if (column[i] < 0) continue;
            right[column[i]] += weight * coefficient[i] * value;
            for (int j = 0; j < count; j++)
                if (column[j] >= 0) normal(column[i], column[j]) += weight * coefficient[i] * coefficient[j];
        }
    }
};

}  // namespace lensprof
