// The constrained step: feasible on the whole grid, and optimal.
#include "simulated.hpp"

#include <Eigen/Dense>

#include "core/response.h"
#include "fit/problem/curve_shape.hpp"
#include "fit/solver/constrained_step.hpp"

using namespace lensprof;

namespace {

double rms_distance(const std::vector<double> &emor, const std::vector<double> &curve) {
    double table[1024], sum = 0;
    lp_emor_curve(emor.data(), static_cast<uint32_t>(emor.size()), table);
    for (int j = 0; j < 1024; j++) sum += (table[j] - curve[j]) * (table[j] - curve[j]);
    return 255 * std::sqrt(sum / 1024);
}

std::vector<double> power_curve(double exponent) {
    std::vector<double> curve;
    for (int j = 0; j < 1024; j++) curve.push_back(std::pow(j / 1023.0, exponent));
    return curve;
}

// The unconstrained projection of a straight line on 5 modes falls near black; the constrained one does not, and stays
// close to the unconstrained distance of 0.12 levels.
void test_linear_curve_needs_the_constraint(void **) {
    auto line = power_curve(1.0);
    std::vector<double> free(5, 0.0);
    for (uint32_t l = 0; l < 5; l++)
        for (int j = 0; j < 1024; j++) free[l] += lensprof_emor_table(l + 1)[j] * (line[j] - lensprof_emor_table(0)[j]);
    assert_false(is_rising(free.data(), 5));
    auto emor = project_curve(line.data(), 5);
    assert_true(is_rising(emor.data(), 5));
    assert_close(rms_distance(emor, line), 0.2643, 0.0005);  // the optimum, confirmed by an independent solver
    assert_true(rms_distance(emor, line) >= rms_distance(free, line));
}

void test_projections_are_strictly_monotone(void **) {
    for (double exponent : {0.1, 0.2, 0.45, 0.8, 1.0, 1.5, 3.0})
        for (int modes : {1, 2, 3, 5, 9, 15, 25}) {
            auto emor = project_curve(power_curve(exponent).data(), modes);
            assert_true(is_rising(emor.data(), modes));
        }
    // a curve with a hard shoulder: flat above 0.4
    std::vector<double> shoulder;
    for (int j = 0; j < 1024; j++) shoulder.push_back(std::min(1.0, j / 409.0));
    for (int modes : {3, 7, 12, 25}) {
        auto emor = project_curve(shoulder.data(), modes);
        assert_true(is_rising(emor.data(), modes));
    }
}

// No feasible point near the solution is better: random feasible points, and their mixtures with the solution (the
// region is convex), never have a lower cost.
void test_step_is_optimal(void **) {
    uint64_t random = 11;
    for (int trial = 0; trial < 20; trial++) {
        const int n = 6;
        Region region{n, 1, 1, {0, 1, 2, 3, 4, 5}, Eigen::VectorXd::Zero(kOneSetting)};
        Eigen::MatrixXd a(n, n);
        for (int i = 0; i < n * n; i++) a.data()[i] = lp_normal(&random);
        Eigen::MatrixXd S = a * a.transpose() + 0.1 * Eigen::MatrixXd::Identity(n, n);
        Eigen::VectorXd b(n);
        for (int i = 0; i < n; i++) b[i] = 30 * lp_normal(&random);
        Eigen::VectorXd d = constrained_step(region, S, b);
        auto cost = [&](const Eigen::VectorXd &x) { return 0.5 * x.dot(S * x) - b.dot(x); };
        assert_true(is_rising(d.data(), n));
        assert_true(cost(d) < 0.0);
        int tested = 0;
        for (int k = 0; k < 4000; k++) {
            Eigen::VectorXd x(n);
            for (int i = 0; i < n; i++) x[i] = d[i] * (k % 2) + 3.0 * lp_normal(&random) * std::pow(0.5, i);
            if (!is_rising(x.data(), n)) continue;
            tested++;
            for (double t : {1e-3, 0.1, 1.0}) {
                Eigen::VectorXd mixed = d + t * (x - d);
                assert_true(cost(mixed) >= cost(d) - 1e-3 * t * std::abs(cost(d)));
            }
        }
        assert_true(tested > 100);
    }
}

void test_falloff_stays_positive(void **) {
    Region region{-1, 1, 1, {kFalloff, kFalloff + 1, kFalloff + 2, kCenter}, Eigen::VectorXd::Zero(kOneSetting)};
    Eigen::VectorXd b(4);
    b << -8.0, 3.0, -5.0, 4.0;
    Eigen::VectorXd d = constrained_step(region, Eigen::MatrixXd::Identity(4, 4), b);
    lensprof_vignetting v{{d[0], d[1], d[2]}, {d[3], 0.0}};
    assert_ok(lensprof_vignetting_validate(&v));
    Region center{-1, 1, 1, {kCenter, kCenter + 1}, Eigen::VectorXd::Zero(kOneSetting)};
    d = constrained_step(center, Eigen::MatrixXd::Identity(2, 2), Eigen::Vector2d(4.0, -0.1));
    assert_close(d[0], 0.5, 1e-6);  // the centre's bound
    assert_close(d[1], -0.1, 1e-9);
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_linear_curve_needs_the_constraint),
        cmocka_unit_test(test_projections_are_strictly_monotone),
        cmocka_unit_test(test_step_is_optimal),
        cmocka_unit_test(test_falloff_stays_positive),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
