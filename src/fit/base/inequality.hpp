// Least squares under many linear inequalities, few of which are active: NLopt (SLSQP) on a working set.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace lensprof {

// Linear inequalities  row . d + something >= 0  on a step d. The step 0 satisfies them all.
class Inequalities {
public:
    virtual ~Inequalities() = default;
    virtual int count() const = 0;
    virtual std::vector<double>
    gaps(const Eigen::VectorXd &d) const = 0;      // violation of each inequality after d; > 0: violated
    virtual Eigen::VectorXd row(int i) const = 0;  // derivatives by the unknowns; zero for unknowns not involved
    virtual double tolerance(int i) const = 0;     // a gap up to this is accepted
    virtual bool
    is_kept(const Eigen::VectorXd &d) const = 0;  // whether the step d satisfies all, as strictly as callers require
};

// Minimises  1/2 d'Sd - b'd  over steps d that satisfy the inequalities. S must be positive definite. Returns the
// unconstrained minimum if it satisfies them; NaN if S is not positive definite.
Eigen::VectorXd constrained_step(const Inequalities &inequalities, const Eigen::MatrixXd &S, const Eigen::VectorXd &b);

}  // namespace lensprof
