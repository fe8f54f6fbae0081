// Whether stated standard errors are true: how often the truth lies within one standard error, over many simulated
// sequences. For a normal error the share is 68.3 %.
#include "campaign.h"
#include "simulated.hpp"

#include "core/response.h"
#include "fit/prior/prior.hpp"

using namespace lensprof;

namespace {

constexpr int kAllRuns = 600;  // the binomial error of the falloff's share is then 2 %
const int kRuns = campaign_runs(kAllRuns),
          kLongRuns = campaign_runs(kAllRuns / 2);  // slow

// Allowed deviation of the share: 2.5 binomial errors.
double allowed(int runs) { return 0.05 * std::sqrt(static_cast<double>(kAllRuns) / runs); }

// How often |error| <= sigma, and the RMS of error / sigma.
struct Share {
    const char *what;
    double within = 0.0, count = 0.0, square = 0.0;

    explicit Share(const char *name) : what(name) {}
    void add(double error, double sigma) {
        assert_true(sigma > 0.0);
        within += std::abs(error) <= sigma;
        square += error * error / (sigma * sigma);
        count += 1.0;
    }
    double share() const { return within / count; }
    void assert_true_to_size(int runs) const {
        print_message("%s: %.1f %% of %.0f within one sigma, rms %.2f sigma\n", what, 100.0 * share(), count,
                      std::sqrt(square / count));
        assert_close(share(), 0.68, allowed(runs));
    }
};

// A monotone response of five modes with the database's spread, so that the model of the fit applies.
lensprof_response draw_response(uint64_t &random) {
    lensprof_response response;
    for (;;) {
        double emor[5];
        for (int l = 0; l < 5; l++) emor[l] = 0.7 * kEmorSigma[l] * lp_normal(&random);
        if (lensprof_response_set_emor(&response, emor, 5) != LENSPROF_OK) continue;
        double smallest = 1.0;
        for (int j = 0; j < 1023; j++) smallest = std::min(smallest, response.table[j + 1] - response.table[j]);
        if (smallest > 1e-5) return response;
    }
}

// Six images, 500 pairs, two levels of noise. The last image's exposure differs from the reference's by 1 EV.
Simulation draw(int run) {
    uint64_t random = 77000 + static_cast<uint64_t>(run);
    Simulation s;
    s.response = draw_response(random);
    for (uint32_t i = 0; i < s.images; i++) {
        double ev = i == 0 ? 0.0 : i == 5 ? (run % 2 ? 1.0 : -1.0) : 2.0 * lp_random(&random) - 1.0;
        double red = 0.85 + 0.3 * lp_random(&random), blue = 0.85 + 0.3 * lp_random(&random);
        s.exposures.push_back({ev, {i ? red : 1.0, 1.0, i ? blue : 1.0}});
    }
    s.make(500, 2.0, 0.0, 1.0, random);
    return s;
}

lensprof_fit_options one_falloff() {
    lensprof_fit_options options = default_fit();
    options.vignettings = 1;
    return options;
}

// Variance of a linear function of the estimated parameters.
double variance(const lensprof_fit_result &r, const std::vector<double> &by) {
    double sum = 0.0;
    for (uint32_t i = 0; i < r.covariance_size; i++)
        for (uint32_t j = 0; j < r.covariance_size; j++) sum += by[i] * by[j] * r.covariance[i * r.covariance_size + j];
    return sum;
}

// The same for the falloff alone: M in the corner (r = 1) by k1, k2, k3; or one coordinate of the centre.
double corner_variance(const lensprof_fit_result &r) {
    std::vector<double> by(r.covariance_size, 0.0);
    for (uint32_t i = r.response.modes; i < r.response.modes + 3; i++) by[i] = 1.0;
    return variance(r, by);
}

double center_sigma(const lensprof_fit_result &r, uint32_t axis) {
    uint32_t i = r.covariance_size - 2 + axis;
    return std::sqrt(r.covariance[i * r.covariance_size + i]);
}

double corner(const lensprof_vignetting &v) { return lensprof_vignetting_eval(&v, 1.0, nullptr); }

// f(x) is linear in the coefficients, with the values at x of the modes in use as factors.
double response_variance(const lensprof_fit_result &r, double x) {
    std::vector<double> by(r.covariance_size, 0.0);
    for (uint32_t l = 0; l < r.response.modes; l++) by[l] = lp_curve_eval(lensprof_emor_table(l + 1), x, nullptr);
    return variance(r, by);
}

struct Shares {
    Share ev{"exposure"}, balance{"white balance"}, falloff{"falloff in the corner"}, center{"centre"};
    Share response{"response"};

    void add(const Simulation &s, const FitRun &run) {
        const lensprof_fit_result &r = run.result;
        for (uint32_t i = 1; i < s.images; i++) {
            const lensprof_fit_image_quality &q = run.quality[i];
            if (s.fit_images[i].free & LENSPROF_FREE_EV)
                ev.add(run.exposures[i].ev - s.exposures[i].ev, q.ev_sigma);
            else
                assert_close(q.ev_sigma, 0.0, 0.0);
            for (int c : {0, 2})
                balance.add(run.exposures[i].white_balance[c] - s.exposures[i].white_balance[c],
                            q.white_balance_sigma[c]);
        }
        falloff.add(corner(r.vignetting[0]) - corner(s.vignetting), std::sqrt(corner_variance(r)));
        for (uint32_t axis : {0u, 1u})
            center.add(r.vignetting[0].center[axis] - s.vignetting.center[axis], center_sigma(r, axis));
        for (double x : {0.05, 0.2, 0.5})
            if (response_variance(r, x) > 0.0)
                response.add(
                    lensprof_response_eval(&r.response, x, nullptr) - lensprof_response_eval(&s.response, x, nullptr),
                    std::sqrt(response_variance(r, x)));
    }

    void assert_true_to_size() const {
        for (const Share *one : {&ev, &balance, &falloff, &center, &response})
            if (one->count > 0.0) one->assert_true_to_size(kRuns);
    }
};

void test_known_response(void **) {
    Shares shares;
    for (int run = 0; run < kRuns; run++) {
        Simulation s = draw(run);
        lensprof_fit_options options = one_falloff();
        options.free &= ~LENSPROF_FREE_RESPONSE;
        options.response = &s.response;
        shares.add(s, run_fit(s, options));
    }
    shares.assert_true_to_size();
}

// Response free, gamma known from one held exposure: all errors come from the data.
void test_gamma_known_by_an_exposure(void **) {
    Shares shares;
    for (int run = 0; run < kRuns; run++) {
        Simulation s = draw(run);
        s.fit_images[5].free &= ~LENSPROF_FREE_EV;
        s.fit_images[5].exposure.ev = s.exposures[5].ev;
        lensprof_fit_options options = one_falloff();
        options.modes = 5;
        FitRun found = run_fit(s, options);
        assert_int_equal(found.result.gamma_from, LENSPROF_GAMMA_KNOWN);
        shares.add(s, found);
    }
    shares.assert_true_to_size();
}

// Response free, gamma from the prior: exposures and falloff, brought to the true gamma, are compared with their
// variance without the contribution of gamma.
void test_gamma_from_the_prior(void **) {
    Share ev{"exposure, gamma apart"}, falloff{"falloff in the corner, gamma apart"};
    for (int run = 0; run < kLongRuns; run++) {
        Simulation s = draw(run);
        FitRun found = run_fit(s, one_falloff());
        const lensprof_fit_result &r = found.result;
        double g = s.gamma(found.exposures), by = 0.0;
        for (uint32_t i = 1; i < s.images; i++) {
            double own = std::pow(found.quality[i].ev_sigma, 2) - std::pow(r.gamma_sigma * found.exposures[i].ev, 2);
            ev.add(found.exposures[i].ev - g * s.exposures[i].ev, std::sqrt(own));
        }
        for (uint32_t i = r.response.modes; i < r.response.modes + 3; i++) by += r.gamma_direction[i];
        falloff.add(corner(r.vignetting[0]) - std::pow(corner(s.vignetting), g),
                    std::sqrt(corner_variance(r) - std::pow(r.gamma_sigma * by, 2)));
    }
    ev.assert_true_to_size(kLongRuns);
    falloff.assert_true_to_size(kLongRuns);
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_known_response),
        cmocka_unit_test(test_gamma_known_by_an_exposure),
        cmocka_unit_test(test_gamma_from_the_prior),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
