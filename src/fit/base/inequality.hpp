// Least squares under many linear inequalities of which few bind: NLopt (SLSQP) on a working set.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace lensprof {

// Linear inequalities  row . d + something >= 0  on a step d. The step 0 keeps them all.
class Inequalities {
public:
    virtual ~Inequalities() = default;
    virtual int count() const = 0;
    virtual std::vector<double> gaps(const Eigen::VectorXd &d) const = 0;  // what each lacks after d; > 0: violated
    virtual Eigen::VectorXd row(int i) const = 0;              // by the unknowns; zero where none is involved
    virtual double tolerance(int i) const = 0;                 // a gap up to this needs no cure
    virtual bool is_kept(const Eigen::VectorXd &d) const = 0;  // by the step's end, as strictly as callers rely on
};

// Minimises  1/2 d'Sd - b'd  over steps d that keep the inequalities. S must be positive definite.
// The unconstrained minimum is returned when it keeps them; NaN when S is not positive definite.
Eigen::VectorXd constrained_step(const Inequalities &inequalities, const Eigen::MatrixXd &S, const Eigen::VectorXd &b);

}  // namespace lensprof
