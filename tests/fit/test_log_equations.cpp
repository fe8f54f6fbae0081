// The basis of log inverse responses, and the linear equations for response and exposures (Kim & Pollefeys 2004, eq. 8
// to 13), compared with a dense reference.
#include "core/exposure.h"
#include "simulated.hpp"

#include <Eigen/Dense>

#include "core/response.h"
#include "fit/methods/transfer_function/log_equations.hpp"

using namespace lensprof;

namespace {

void test_basis_is_orthonormal(void **) {
    for (int m = 1; m <= kLogModes; m++)
        for (int n = 1; n <= m; n++) {
            double sum = 0.0;
            for (int i = 0; i < kLogLevels; i++) sum += kLogEmor[m][i] * kLogEmor[n][i];
            assert_close(sum, m == n ? 1.0 : 0.0, 1e-7);
        }
    for (int m = 0; m <= kLogModes; m++) assert_close(kLogEmor[m][kLogLevels - 1], 0.0, 1e-7);  // g(255) = 0
}

// Figure 4: the first three modes explain more than 99.6 %.
void test_three_modes_explain_the_database(void **) {
    double sum = 0.0;
    for (int n = 0; n < 3; n++) sum += kLogEmorSigma[n] * kLogEmorSigma[n];
    assert_true(sum / kLogEmorVariance > 0.996 && sum < kLogEmorVariance);
    for (int n = 1; n < kLogModes; n++) assert_true(kLogEmorSigma[n] < kLogEmorSigma[n - 1]);
}

// g of a response and the response of g are inverses at every level.
void test_response_and_log_inverse(void **) {
    for (const lensprof_response &response : {srgb_response(), film_response(), linear_response()}) {
        lensprof_response back = response_of(log_inverse(response));
        for (int j = 0; j < 1024; j += 7) assert_close(back.table[j], response.table[j], 0.3 / 255.0);
        assert_int_equal(back.kind, LENSPROF_RESPONSE_TABLE);
    }
    double slope, row[kLogLevels];
    for (int i = 0; i < kLogLevels; i++) row[i] = 2.0 * (i + 1);
    assert_close(at_level(row, 17.25, &slope), 34.5, 1e-12);
    assert_close(slope, 2.0, 1e-12);
    assert_close(at_level(row, 255.0, &slope), 510.0, 1e-12);
    assert_close(at_level(row, 0.3, &slope), 2.0, 1e-12);
}

// For a falling g as the target, the result rises and is as good as other rising curves.
void test_coefficients_keep_g_rising(void **) {
    constexpr int kModes = 6;
    Eigen::MatrixXd S = Eigen::MatrixXd::Identity(kModes, kModes);
    Eigen::VectorXd b(kModes);
    for (int n = 0; n < kModes; n++) {
        b[n] = 0.0;
        for (int i = 0; i < kLogLevels; i++) b[n] += kLogEmor[n + 1][i] * (-1.0 - 2.0 * (i < 60) - kLogEmor[0][i]);
    }
    auto cost = [&](const LogCoefficients &c) { return 0.5 * c.squaredNorm() - b.dot(c.head(kModes)); };
    auto is_rising = [](const LogCoefficients &c) {
        LogInverse g = log_inverse(c);
        for (size_t i = 1; i < g.size(); i++)
            if (!(g[i] - g[i - 1] >= 0.4 * kSmallestLogRise)) return false;
        return true;
    };
    LogCoefficients free = LogCoefficients::Zero();
    free.head(kModes) = b;
    assert_false(is_rising(free));
    LogCoefficients c = monotone_coefficients(S, b);
    assert_true(is_rising(c));
    uint64_t random = 3;
    int tried = 0;
    for (int i = 0; i < 4000; i++) {
        LogCoefficients other = c;
        for (int n = 0; n < kModes; n++) other[n] += 0.3 * lp_normal(&random);
        if (!is_rising(other)) continue;
        assert_true(cost(other) >= cost(c) - 1e-6);
        tried++;
    }
    assert_true(tried > 20);
}

struct Setup {
    Simulation s;
    lensprof_fit_options options = default_fit();
    Problem problem;
    std::vector<TransferCurve> curves;
    Estimate estimate;
    LogModel model;

    // Points of true transfer functions between three images, all of them neighbours.
    explicit Setup(double noise) {
        s.response = srgb_response();
        s.images = 3;
        s.reach = 2;
        s.vignetting = {{0.0, 0.0, 0.0}, {0.0, 0.0}};
        s.make(60, 0.0, 0.0, 1.0, 5);
        options.free = LENSPROF_FREE_RESPONSE;
        std::vector<uint32_t> keep(s.pairs.size());
        for (uint32_t p = 0; p < keep.size(); p++) keep[p] = p;
        problem = make_problem(options, s.fit_images.data(), s.images, s.pairs.data(), keep);
        set_fixed(estimate, s.response);
        estimate.log_exposure.assign(s.images, {0.0, 0.0, 0.0});
        uint64_t random = 6;
        for (size_t e = 0; e < problem.edges.size(); e++)
            for (int c = 0; c < 3; c++) {
                TransferCurve curve{e, c, 1.0, {}};
                double ratio = true_log(problem.edges[e].image[1], c) - true_log(problem.edges[e].image[0], c);
                for (double level = 20.0; level < 240.0; level += 3.0) {
                    double x = lensprof_response_invert(&s.response, level / 255.0, nullptr) * std::exp(ratio);
                    double to = 255.0 * lensprof_response_eval(&s.response, x, nullptr) + noise * lp_normal(&random);
                    if (to > 5.0 && to < 245.0) curve.points.push_back({{level, to}, 1.0 + lp_random(&random)});
                }
                curves.push_back(curve);
            }
    }
    double true_log(uint32_t image, int c) const {
        return std::log(lp_exposure_factor(&s.exposures[image], static_cast<uint32_t>(c)));
    }
};

// Equations 10 to 13 as one dense system give the same coefficients and exposures.
void test_equations_are_those_of_a_dense_system(void **) {
    Setup setup(0.5);
    constexpr int kModes = 4;
    setup.model.modes = kModes;
    LogWeights weights;
    weights.as_paper = true;
    LogEquations equations(setup.problem, setup.curves, weights, setup.model, setup.estimate);
    assert_true(equations.eliminate());
    LogModel model = setup.model;
    Estimate estimate = setup.estimate;
    assert_true(equations.solve(1.0, false, model, estimate));

    // Unknowns: c, then a for images 1 and 2 per channel. The mask is that of the paper's variant.
    size_t rows = 0;
    for (const auto &curve : setup.curves) rows += curve.points.size();
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows) + kModes, kModes + 6);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(A.rows());
    Eigen::Index r = 0;
    for (const auto &curve : setup.curves)
        for (const auto &point : curve.points) {
            double from = point.level[0], to = point.level[1];
            double root = std::exp(-0.125 * (std::pow((from - 128.0) / 45.0, 2) + std::pow((to - 128.0) / 45.0, 2)));
            auto rise = [&](int row) {
                return at_level(kLogEmor[row], to, nullptr) - at_level(kLogEmor[row], from, nullptr);
            };
            for (int n = 0; n < kModes; n++) A(r, n) = root * rise(n + 1);
            for (int end = 0; end < 2; end++) {
                uint32_t image = setup.problem.edges[curve.edge].image[end];
                if (image) A(r, kModes + 3 * (static_cast<int>(image) - 1) + curve.channel) = end ? -root : root;
            }
            b[r++] = -root * rise(0);
        }
    for (int n = 0; n < kModes; n++) A(r++, n) = 1.0 / kLogEmorSigma[n];
    Eigen::VectorXd x = A.colPivHouseholderQr().solve(b);
    for (int n = 0; n < kModes; n++) assert_close(model.c[n], x[n], 1e-4 * (1.0 + std::abs(x[n])));
    for (uint32_t i = 1; i < 3; i++)
        for (int c = 0; c < 3; c++)
            assert_close(estimate.log_exposure[i][static_cast<size_t>(c)],
                         x[kModes + 3 * (static_cast<int>(i) - 1) + c], 1e-4);
}

// With the response held, only exposures remain; they are exact if the points are.
void test_exposures_under_a_known_response(void **) {
    Setup setup(0.0);
    setup.model.is_free = false;
    setup.model.g = log_inverse(setup.s.response);
    LogEquations equations(setup.problem, setup.curves, LogWeights(), setup.model, setup.estimate);
    assert_true(equations.eliminate());
    LogModel model = setup.model;
    Estimate estimate = setup.estimate;
    assert_true(equations.solve(1.0, true, model, estimate));
    for (uint32_t i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++)
            assert_close(estimate.log_exposure[i][static_cast<size_t>(c)], setup.true_log(i, c), 2e-3);
}

// If held, the scale of the exposures stays; only its orthogonal complement changes.
void test_scale_of_the_exposures_is_held(void **) {
    Setup setup(0.5);
    setup.model.modes = 5;
    for (uint32_t i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++)
            setup.estimate.log_exposure[i][static_cast<size_t>(c)] = 1.3 * setup.true_log(i, c) + (i ? 0.05 : 0.0);
    LogEquations equations(setup.problem, setup.curves, LogWeights(), setup.model, setup.estimate);
    assert_true(equations.eliminate());
    LogModel model = setup.model;
    Estimate estimate = setup.estimate;
    assert_true(equations.solve(1.0, true, model, estimate));
    double along = 0.0, length2 = 0.0;
    for (uint32_t i = 0; i < 3; i++)
        for (size_t c = 0; c < 3; c++) {
            double before = setup.estimate.log_exposure[i][c];
            along += before * (estimate.log_exposure[i][c] - before);
            length2 += before * before;
        }
    assert_close(along / length2, 0.0, 1e-5);
    for (size_t i = 1; i < model.g.size(); i++) assert_true(model.g[i] > model.g[i - 1]);
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_basis_is_orthonormal),
        cmocka_unit_test(test_three_modes_explain_the_database),
        cmocka_unit_test(test_response_and_log_inverse),
        cmocka_unit_test(test_coefficients_keep_g_rising),
        cmocka_unit_test(test_equations_are_those_of_a_dense_system),
        cmocka_unit_test(test_exposures_under_a_known_response),
        cmocka_unit_test(test_scale_of_the_exposures_is_held),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
