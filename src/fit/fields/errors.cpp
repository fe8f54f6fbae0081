#include "fit/fields/errors.hpp"

#include <algorithm>
#include <cmath>

#include "fit/base/parallel.hpp"

namespace lensprof {
namespace {

constexpr int kRefitSteps = 10;             // 40 change the error by less than a tenth
constexpr size_t kMostParallel = 1u << 22;  // cells of all pictures, of which threads may hold copies

// Factor by which a deviation of n - 1 degrees of freedom is exceeded as often as one standard deviation of a normal
// number is: the quantile of Student's t at 84.13 % (Cornish and Fisher's expansion for z = 1).
double student_factor(double groups) {
    const double nu = groups - 1.0;
    return 1.0 + 0.5 / nu + 0.25 / (nu * nu);
}

// Sum over the fits of the squared distance of one of their values from its mean.
double scatter(const std::vector<std::vector<double>> &fits, size_t i) {
    const auto count = static_cast<double>(fits.size());
    double mean = 0.0, sum = 0.0;
    for (const auto &fit : fits) mean += fit[i] / count;
    for (const auto &fit : fits) sum += (fit[i] - mean) * (fit[i] - mean);
    return sum;
}

}  // namespace

FieldErrors jackknife(const Descent &descent, const Refits &how, const FieldStep &step) {
    const size_t cells = descent.cells.size();
    std::vector<std::vector<double>> fits(how.groups);  // of each: ln S at the cells, then the offset
    const bool is_complete = for_each_parallel(
        static_cast<uint32_t>(how.groups), descent.level.size() * cells > kMostParallel ? 1 : how.threads,
        [&](uint32_t g) {
            Descent fit = descent;
            fit.leave_out(g, how.groups);
            for (int k = 0; k < kRefitSteps; k++) fit.step(how.moves_offset);
            fits[g] = fit.cells;
            fits[g].push_back(fit.offset);
        },
        step);
    if (!is_complete) throw Cancelled();
    const auto groups = static_cast<double>(how.groups);
    const double share = (groups - 1.0) / groups, factor = student_factor(groups);
    double variance = 0.0;
    for (size_t j = 0; j < cells; j++) variance += share * scatter(fits, j) / static_cast<double>(cells);
    return {factor * std::sqrt(variance), factor * std::sqrt(share * scatter(fits, cells))};
}

}  // namespace lensprof
