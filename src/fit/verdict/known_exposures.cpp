#include "fit/verdict/known_exposures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "falloff/dense.hpp"
#include "fit/base/constants.hpp"
#include "fit/base/quantile.hpp"
#include "fit/prior/gauge.hpp"
#include "fit/verdict/limits.hpp"

namespace lensprof {
namespace {

struct Line {
    double chi2, slope, step, largest;
};

// Known exposures in the order of the images.
class Known {
public:
    Known(const Problem &problem, const Estimate &estimate, bool open) : open_(open) {
        for (uint32_t i = 0; i < problem.image_count; i++) {
            const auto &image = problem.images[i];
            if (!(image.known_ev_sigma > 0.0) || problem.component[i] != problem.component[problem.reference]) continue;
            images_.push_back(i);
            known_.push_back(image.known_ev);
            found_.push_back(estimate.log_exposure[i][static_cast<size_t>(problem.measured_channel())] / kLn2);
            sigma_.push_back(std::max(image.known_ev_sigma, kKnownSigma));
        }
    }

    size_t count() const { return images_.size(); }
    uint32_t image(size_t m) const { return images_[m]; }
    double spread() const {
        return *std::max_element(found_.begin(), found_.end()) - *std::min_element(found_.begin(), found_.end());
    }
    int freedom() const { return static_cast<int>(count()) - (open_ ? 2 : 1); }

    // known = a + slope found + step from member `first` to `last`; step 0 if the range is empty.
    Line fit(size_t first, size_t last) const {
        const Eigen::Index n = 1 + open_ + (first < last);
        Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
        Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
        for (size_t m = 0; m < count(); m++) {
            Eigen::VectorXd row = row_of(m, first, last) / sigma_[m];
            normal += row * row.transpose();
            right += row * (target(m) / sigma_[m]);
        }
        Eigen::VectorXd u = solve_symmetric(normal, right);
        Line line{0.0, open_ ? u[1] : 1.0, first < last ? u[n - 1] : 0.0, 0.0};
        for (size_t m = 0; m < count(); m++) {
            double off = target(m) - row_of(m, first, last).dot(u);
            line.chi2 += std::pow(off / sigma_[m], 2);
            line.largest = std::max(line.largest, std::abs(off));
        }
        return line;
    }

private:
    double target(size_t m) const { return open_ ? known_[m] : known_[m] - found_[m]; }
    Eigen::VectorXd row_of(size_t m, size_t first, size_t last) const {
        Eigen::VectorXd row(1 + open_ + (first < last));
        row[0] = 1.0;
        if (open_) row[1] = found_[m];
        if (first < last) row[row.size() - 1] = m >= first && m < last;
        return row;
    }

    bool open_;
    std::vector<uint32_t> images_;
    std::vector<double> known_, found_, sigma_;
};

// Finds the explanation that clearly leaves the least error, if there is one: one wrong exposure, or a step from some
// picture on.
void explain(const Known &known, KnownExposures &result) {
    double best = std::numeric_limits<double>::infinity(), next = best;
    auto consider = [&](size_t first, size_t last, KnownExposures::Explanation explanation) {
        Line line = known.fit(first, last);
        if (line.chi2 >= best) {
            next = std::min(next, line.chi2);
            return;
        }
        next = best, best = line.chi2;
        result.explanation = explanation;
        result.image = known.image(first);
        result.off_ev = line.step;
    };
    for (size_t m = 0; m < known.count(); m++) consider(m, m + 1, KnownExposures::Explanation::single_image);
    for (size_t m = 2; m + 1 < known.count(); m++) consider(m, known.count(), KnownExposures::Explanation::step);
    bool is_clear =
        known.freedom() > 1 && best < chi_squared_limit(known.freedom() - 1) && next - best > kClearlyBetter;
    if (!is_clear) result.explanation = KnownExposures::Explanation::any;
}

}  // namespace

KnownExposures compare_known(const Problem &problem, const Estimate &estimate, bool open) {
    KnownExposures result;
    Known known(problem, estimate, open);
    result.count = static_cast<int>(known.count());
    if (open && known.count() > 1 && known.spread() > kClearSpread && known.fit(0, 0).slope < kFlatSlope) {
        result.explanation = KnownExposures::Explanation::order;
        result.off_ev = known.spread();
        return result;
    }
    if (known.freedom() < 1) return result;
    Line line = known.fit(0, 0);
    result.slope = 1.0 / line.slope;
    if (line.chi2 < chi_squared_limit(known.freedom()) || line.largest < kReportableEv) return result;
    explain(known, result);
    if (result.explanation == KnownExposures::Explanation::any) result.off_ev = line.largest;
    return result;
}

}  // namespace lensprof
