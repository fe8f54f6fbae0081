// The objective about an estimate, for a step d of the shared unknowns and e of the images' unknowns q, is taken as
//
//     F(d, e) = F - g'd - h'e + 1/2 d'A d + e'C d + 1/2 e'B e
//
// with A = shared_, B = images_, C = cross_q_ (images x shared), g = gradient_ and h = gradient_q_, which are those of
// -F. F is dimensionless: squared residuals over the variance of the noise, priors included, so that the inverse
// Hessian is a covariance. q are natural logarithms. A is small and dense, B large and sparse: where images overlap.
//
// For a given d, F is least at  e = B^-1 (h - C d)  = image_only_ - eliminated_ d.  Substituting this gives
//
//     S d = b,     S = A - C'B^-1 C   (the Schur complement of B),     b = g - C'B^-1 h,
//
// which is as small as A: one sparse factorisation and as many solutions as there are shared unknowns. S and b are
// those of F minimised over the images, so that inequalities on d (constrained_step) do not involve the images. The
// gain of a step is  1/2 h'B^-1 h + b'd - 1/2 d'S d.  Levenberg-Marquardt's lambda raises the diagonals of A and B
// alike.
//
// With V = S^-1, the covariance of the shared unknowns, the images' is  B^-1 + B^-1 C V C'B^-1:  the uncertainty
// left by their own pairs, and that added by the shared unknowns. Only its diagonal is computed (inverse_diagonal).
#include "fit/solver/normal_equations.hpp"

#include <algorithm>
#include <cmath>

namespace lensprof {

NormalEquations::Sums::Sums(Eigen::Index n, uint32_t image_count)
    : shared(Eigen::MatrixXd::Zero(n, n)),
      cross(Eigen::MatrixXd::Zero(n, 3 * image_count)),
      gradient(Eigen::VectorXd::Zero(n)),
      image_gradient(Eigen::VectorXd::Zero(3 * image_count)) {}

void NormalEquations::Sums::add(const Sums &part) {
    objective += part.objective;
    shared += part.shared;
    cross += part.cross;
    gradient += part.gradient;
    image_gradient += part.image_gradient;
}

NormalEquations::NormalEquations(const Problem &problem, const Estimate &estimate)
    : problem_(problem), columns_(free_columns(problem, estimate.modes)), modes_(leading_modes(columns_)) {}

size_t leading_modes(const std::vector<int> &columns) {
    return static_cast<size_t>(std::lower_bound(columns.begin(), columns.end(), kMaxModes) - columns.begin());
}

void add_by_lens(const Problem &problem, const std::vector<int> &columns, const Attenuation &place, uint32_t image,
                 int curve, double sign, double *derivative) {
    const int setting = problem.setting_of[image];
    for (size_t u = leading_modes(columns); u < columns.size(); u++) {
        const LensColumn column = lens_column(columns[u]);
        if (column.setting != setting) continue;
        const int k = column.offset - 3 * curve;
        if (column.is_center())
            derivative[u] += sign * place.by_center[columns[u] - center_column(setting)];
        else if (k >= 0 && k < 3)
            derivative[u] += sign * place.by_k[k];
    }
}

void NormalEquations::complete(const Sums &sums, const Prior &prior, const Estimate &estimate) {
    objective_ = sums.objective;
    shared_ = sums.shared.selfadjointView<Eigen::Lower>();
    gradient_ = sums.gradient;
    objective_ += prior_cost(prior, problem_, columns_, estimate);
    add_prior(prior, estimate);
    map_images(sums, prior, estimate);
}

void NormalEquations::add_prior(const Prior &prior, const Estimate &estimate) {
    Eigen::VectorXd full = shared_vector(estimate);
    double off = prior.pin.dot(full.head(kMaxModes)) - prior.pin_value;
    auto pin = [&](int column) { return column < kMaxModes ? prior.pin[column] : 0.0; };
    for (size_t u = 0; u < columns_.size(); u++) {
        auto i = static_cast<Eigen::Index>(u);
        gradient_[i] -= prior.pin_precision * off * pin(columns_[u]);
        for (size_t v = 0; v < columns_.size(); v++) {
            double precision = prior.precision(columns_[u], columns_[v]);
            shared_(i, static_cast<Eigen::Index>(v)) +=
                precision + prior.pin_precision * pin(columns_[u]) * pin(columns_[v]);
            gradient_[i] -= precision * (full[columns_[v]] - prior.mean[columns_[v]]);
        }
    }
    for (size_t s = 0; s < prior.falloff.size(); s++)
        add_falloff_prior(prior.falloff[s], static_cast<int>(s), estimate);
}

void NormalEquations::add_falloff_prior(const FalloffPrior &prior, int setting, const Estimate &estimate) {
    Eigen::Matrix3d slope;
    const Falloffs &curves = estimate.vignetting[static_cast<size_t>(setting)];
    const Eigen::Vector3d off = log_falloff(curves[green_curve(problem_.vignettings)].k, &slope) - prior.mean;
    const Eigen::Vector3d gradient = slope.transpose() * prior.precision * off;
    const Eigen::Matrix3d hessian = slope.transpose() * prior.precision * slope;
    const int green = green_falloff(problem_.vignettings, setting);
    const auto power = [&](size_t u) { return columns_[u] - green; };
    for (size_t u = modes_; u < columns_.size(); u++) {
        if (power(u) < 0 || power(u) > 2) continue;
        const auto i = static_cast<Eigen::Index>(u);
        gradient_[i] -= gradient[power(u)];
        for (size_t v = modes_; v < columns_.size(); v++)
            if (power(v) >= 0 && power(v) <= 2) shared_(i, static_cast<Eigen::Index>(v)) += hessian(power(u), power(v));
    }
}

// From log exposures a_ic to the images' unknowns q.
void NormalEquations::map_images(const Sums &sums, const Prior &prior, const Estimate &estimate) {
    int count = problem_.image_unknowns;
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(8 * sums.links.size() * static_cast<size_t>(problem_.channels));
    for (const Link &link : sums.links)
        for (int c = 0; c < problem_.channels; c++)
            for (int end = 0; end < 2; end++)
                for (int other = 0; other < 2; other++)
                    for (int q : problem_.columns_of(link.image[end], c))
                        for (int r : problem_.columns_of(link.image[other], c))
                            if (q >= 0 && r >= 0)
                                entries.emplace_back(q, r, (end == other ? 1.0 : -1.0) * link.weight[c]);
    const bool has_shared = !columns_.empty();  // a matrix without columns has no rows to point at
    cross_q_ = Eigen::MatrixXd::Zero(count, static_cast<Eigen::Index>(columns_.size()));
    gradient_q_ = Eigen::VectorXd::Zero(count);
    for (uint32_t i = 0; i < problem_.image_count; i++)
        for (int c = 0; c < problem_.channels; c++)
            for (int q : problem_.columns_of(i, c))
                if (q >= 0) {
                    if (has_shared) cross_q_.row(q) += sums.cross.col(3 * static_cast<Eigen::Index>(i) + c).transpose();
                    gradient_q_[q] += sums.image_gradient[3 * static_cast<Eigen::Index>(i) + c];
                }
    for (size_t i = 0; i < prior.known.size(); i++) {
        int q = problem_.ev_unknown[i];
        double precision = prior.known[i].precision;
        if (q < 0 || precision == 0.0) continue;
        entries.emplace_back(q, q, precision);
        gradient_q_[q] -=
            precision * (estimate.log_exposure[i][problem_.measured_channel()] - prior.known[i].log_exposure);
    }
    images_.resize(count, count);
    images_.setFromTriplets(entries.begin(), entries.end());
}

bool NormalEquations::reduce(double lambda) {
    auto n = static_cast<Eigen::Index>(columns_.size());
    S_ = shared_;
    for (Eigen::Index u = 0; u < n; u++) S_(u, u) += lambda * shared_(u, u) + 1e-12;
    b_ = gradient_;
    if (problem_.image_unknowns == 0) return true;
    // A weak pull (sigma 30 EV) holds images without usable pairs, and unconnected groups, at their values.
    Eigen::SparseMatrix<double> damped = images_, diagonal(images_.rows(), images_.cols());
    diagonal.setIdentity();
    for (Eigen::Index q = 0; q < images_.rows(); q++) diagonal.coeffRef(q, q) = lambda * images_.coeff(q, q) + 2e-3;
    damped += diagonal;
    factor_.compute(damped);
    if (factor_.info() != Eigen::Success) return false;
    eliminated_ = cross_q_;
    image_only_ = factor_.solve(gradient_q_);
    if (n == 0) return true;
    eliminated_ = factor_.solve(cross_q_);
    S_ -= cross_q_.transpose() * eliminated_;
    S_ = 0.5 * (S_ + S_.transpose()).eval();
    b_ -= eliminated_.transpose() * gradient_q_;
    return S_.allFinite() && b_.allFinite();
}

std::vector<std::array<double, 3>> NormalEquations::image_step(const Eigen::VectorXd &shared_step) const {
    std::vector<std::array<double, 3>> step(problem_.image_count, {0.0, 0.0, 0.0});
    if (problem_.image_unknowns == 0) return step;
    Eigen::VectorXd q = image_only_;
    if (!columns_.empty()) q -= eliminated_ * shared_step;
    for (uint32_t i = 0; i < problem_.image_count; i++)
        for (int c = 0; c < problem_.channels; c++)
            for (int column : problem_.columns_of(i, c))
                if (column >= 0) step[i][c] += q[column];
    return step;
}

double NormalEquations::expected_gain(const Eigen::VectorXd &shared_step) const {
    double images = problem_.image_unknowns ? 0.5 * image_only_.dot(gradient_q_) : 0.0;
    return images + b_.dot(shared_step) - 0.5 * shared_step.dot(S_ * shared_step);
}

Eigen::MatrixXd NormalEquations::images_by(const Eigen::MatrixXd &shared) const {
    if (problem_.image_unknowns == 0 || columns_.empty())
        return Eigen::MatrixXd::Zero(problem_.image_unknowns, shared.cols());
    return eliminated_ * shared;
}

Eigen::VectorXd NormalEquations::image_variance(const Eigen::MatrixXd &shared, double inflation) const {
    if (problem_.image_unknowns == 0) return {};
    const bool has_shared = !columns_.empty();
    auto added = [&](const Eigen::MatrixXd &rows) -> Eigen::VectorXd {  // by the shared unknowns
        return (rows * shared).cwiseProduct(rows).rowwise().sum();
    };
    Eigen::VectorXd variance = inflation * inverse_diagonal(factor_);
    if (!problem_.channels_apart) return has_shared ? variance + added(eliminated_) : variance;
    // ln w_ic = a_ic - a_i1: the first part of their covariance is 0, because the channels are apart.
    Eigen::MatrixXd by_shared = eliminated_;
    const Eigen::VectorXd alone = variance;
    for (uint32_t i = 0; i < problem_.image_count; i++)
        for (int balance : problem_.balance_unknown[i]) {
            const int ev = problem_.ev_unknown[i];
            if (balance < 0 || ev < 0) continue;
            variance[balance] += alone[ev];
            if (has_shared) by_shared.row(balance) -= eliminated_.row(ev);
        }
    return has_shared ? variance + added(by_shared) : variance;
}

Eigen::VectorXd inverse_diagonal(const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> &factor) {
    // For Z, the inverse of the permuted matrix L D L', L'Z = D^-1 L^-1, whose right side is lower triangular and has
    // 1 / d_j on its diagonal. Row j of it, from column j on, is
    //     Z_ij = -sum over k > j of L_kj Z_ki   (i > j),        Z_jj = 1 / d_j - sum over k > j of L_kj Z_kj.
    // Only k with L_kj != 0 count. Computing Z_ij with L_ij != 0 requires Z_ki for i and k both in the pattern of
    // column j. L_ik (i > k) is then in the pattern, too, because eliminating j has filled it. Going from the last
    // column to the first, no entry outside the pattern is therefore needed.
    Eigen::SparseMatrix<double> l = factor.matrixL();
    l.makeCompressed();
    Eigen::VectorXd d = factor.vectorD(), diagonal(l.cols());
    const int *start = l.outerIndexPtr(), *row = l.innerIndexPtr();
    std::vector<double> z(static_cast<size_t>(l.nonZeros()), 0.0);
    auto first_below = [&](int j) { return start[j] + (start[j] < start[j + 1] && row[start[j]] == j); };
    std::vector<int> place(static_cast<size_t>(l.cols()), -1);  // in the pattern of column j
    std::vector<double> sum;
    for (int j = static_cast<int>(l.cols()) - 1; j >= 0; j--) {
        const int first = first_below(j), count = start[j + 1] - first;
        const double *l_j = l.valuePtr() + first;
        sum.assign(static_cast<size_t>(count), 0.0);
        for (int a = 0; a < count; a++) place[static_cast<size_t>(row[first + a])] = a;
        for (int a = 0; a < count; a++) {  // contribution of Z_ki and Z_ik = Z_ki of column k to the rows k and i
            const int k = row[first + a];
            double product = l_j[a] * diagonal[k];
            for (int b = first_below(k); b < start[k + 1]; b++) {
                const int i = place[static_cast<size_t>(row[b])];
                if (i < 0) continue;
                sum[static_cast<size_t>(i)] -= l_j[a] * z[static_cast<size_t>(b)];
                product += l_j[i] * z[static_cast<size_t>(b)];
            }
            sum[static_cast<size_t>(a)] -= product;
        }
        diagonal[j] = 1.0 / d[j];
        for (int a = 0; a < count; a++) {
            z[static_cast<size_t>(first + a)] = sum[static_cast<size_t>(a)];
            diagonal[j] -= l_j[a] * sum[static_cast<size_t>(a)];
            place[static_cast<size_t>(row[first + a])] = -1;
        }
    }
    return factor.permutationPinv() * diagonal;
}

}  // namespace lensprof
