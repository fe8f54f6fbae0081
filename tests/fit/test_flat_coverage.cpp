// Whether the stated errors of the flat field fit are true: hundreds of simulated cards.
#include "campaign.h"
#include "flat_pictures.hpp"

constexpr int all_runs = 400;
static const int runs = campaign_runs(all_runs);
static const double wider = std::sqrt(static_cast<double>(all_runs) / runs);  // limits for fewer runs

// Share of runs with an error below the stated one: k1, k2, k3, centre x, y, and M at r = 1.
struct Coverage {
    double inside[6] = {};
    double scatter = 0.0, stated = 0.0;  // of M at r = 1, RMS

    void add(const lensprof_flat_result &r, const lensprof_vignetting &truth) {
        const uint32_t n = r.covariance_size;
        double corner = 0.0, variance = 0.0;
        for (uint32_t i = 0; i < 5; i++) {
            double error =
                i < 3 ? r.vignetting[0].k[i] - truth.k[i] : r.vignetting[0].center[i - 3] - truth.center[i - 3];
            inside[i] += std::fabs(error) < std::sqrt(r.covariance[i * n + i]);
            for (uint32_t j = 0; j < 3 && i < 3; j++) variance += r.covariance[i * n + j];
            if (i < 3) corner += error;
        }
        inside[5] += std::fabs(corner) < std::sqrt(variance);
        scatter += corner * corner;
        stated += variance;
    }
};

static Coverage simulate(uint32_t shots, double texture, uint32_t channels) {
    Coverage coverage;
    uint64_t random = 17 + shots;
    for (int run = 0; run < runs; run++) {
        FlatPictures p;
        p.width = 200, p.height = 150, p.channels = channels;
        p.seed = static_cast<uint64_t>(run) + 1;
        p.sample = LENSPROF_SAMPLE_U8;
        p.noise = 0.012;
        p.set_center(0.02 * lp_normal(&random), 0.02 * lp_normal(&random));  // drawn from the prior
        p.gradient[0] = 0.05, p.gradient[1] = 0.03;
        std::vector<double> waves(24 * 24);
        for (double &w : waves) w = texture * lp_normal(&random);
        p.defect = [=](double x, double y, uint32_t) {  // texture on the card, several cells in size
            return 1.0 + waves[static_cast<size_t>(y / 8) * 24 + static_cast<size_t>(x / 9)];
        };
        for (uint32_t s = 0; s < shots; s++) p.shoot(s, 0.0, 90.0 * s);
        lensprof_flat_options o = p.options();
        o.vignettings = 1;
        o.grid = LENSPROF_FLAT_GRID_NONE;
        auto r = p.fit(o);
        assert_int_equal(r->covariance_size, 5);
        coverage.add(*r, p.vignetting[0]);
    }
    return coverage;
}

static void check(const char *what, const Coverage &c) {
    print_message("%s: k1 %.2f k2 %.2f k3 %.2f centre %.2f %.2f corner %.2f; corner error %.5f, stated %.5f\n", what,
                  c.inside[0] / runs, c.inside[1] / runs, c.inside[2] / runs, c.inside[3] / runs, c.inside[4] / runs,
                  c.inside[5] / runs, std::sqrt(c.scatter / runs), std::sqrt(c.stated / runs));
    for (double inside : c.inside) assert_close(inside / runs, 0.68, 0.08 * wider);
    assert_true(c.scatter > (1.0 - 0.2 * wider) * c.stated && c.scatter < (1.0 + 0.25 * wider) * c.stated);
}

static void stated_errors_of_one_shot(void **) { check("one shot", simulate(1, 0.0, 1)); }
static void stated_errors_of_rotated_shots(void **) { check("rotated", simulate(3, 0.0, 3)); }
static void stated_errors_on_a_card_with_texture(void **) { check("texture", simulate(1, 0.006, 1)); }

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stated_errors_of_one_shot),
        cmocka_unit_test(stated_errors_of_rotated_shots),
        cmocka_unit_test(stated_errors_on_a_card_with_texture),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
