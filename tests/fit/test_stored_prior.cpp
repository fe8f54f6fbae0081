// A stored profile as the prior: sequences of two pictures improve the profile step by step; a wrong profile is
// overruled.
#include <memory>

#include "simulated.hpp"

#include "fit/problem/curve_shape.hpp"

namespace {

constexpr uint32_t kSequences = 5, kCameras = 12;

// Two pictures of one lens, half a frame apart.
Simulation sequence(uint64_t seed, uint32_t pairs = 2000) {
    Simulation s;
    s.images = 2;
    s.response = srgb_response();
    s.vignetting = {{-0.45, 0.12, -0.12}, {0.015, -0.01}};
    s.shift = 0.5;
    s.make(pairs, 2.0, 0.03, 1.5, seed);
    for (uint32_t i = 0; i < s.images; i++) {  // from EXIF, to a tenth
        uint64_t random = seed + 77 + i;
        s.fit_images[i].known_ev = s.exposures[i].ev + 0.1 * lp_normal(&random);
        s.fit_images[i].known_ev_sigma = 0.1;
    }
    return s;
}

struct Found {
    std::unique_ptr<FoundResult> result = std::make_unique<FoundResult>();
    std::vector<lensprof_exposure> exposures;
};

lensprof_status fit(const Simulation &s, const lensprof_profile *profile, Found &found, lensprof_error *error = nullptr,
                    uint32_t method = LENSPROF_METHOD_TRANSFER) {
    lensprof_fit_options options;
    lensprof_fit_options_init(&options);
    options.profile = profile;
    options.method = method;
    FitRun run;
    const lensprof_status status = fit_into(run, options, s.fit_images, s.pairs, error);
    if (status != LENSPROF_OK) return status;
    *found.result = run.result, found.exposures = run.exposures;
    return status;
}

// The profile that the command would store.
std::unique_ptr<lensprof_profile> profile_of(const lensprof_fit_result &r) {
    auto profile = std::make_unique<lensprof_profile>();
    lensprof_profile_init(profile.get());
    profile->response[0] = r.response;
    profile->vignettings = r.vignettings;
    for (uint32_t c = 0; c < r.vignettings; c++) profile->vignetting[c] = r.vignetting[c];
    profile->covariance_size = r.covariance_size;
    std::copy(r.covariance, r.covariance + r.covariance_size * r.covariance_size, profile->covariance);
    return profile;
}

struct Errors {
    double falloff = 0.0, response = 0.0, gamma = 0.0;  // of M and f; ln gamma in standard errors

    void add(const Errors &e) {
        falloff += e.falloff * e.falloff, response += e.response * e.response, gamma += e.gamma * e.gamma;
    }
    Errors root_mean(double count) const {
        return {std::sqrt(falloff / count), std::sqrt(response / count), std::sqrt(gamma / count)};
    }
};

Errors errors_of(const Simulation &s, const lensprof_fit_result &r) {
    Errors e;
    for (int k = 1; k <= 20; k++) {
        e.falloff = std::max(e.falloff, std::abs(lensprof_vignetting_eval(&r.vignetting[1], k / 20.0, nullptr)
                                                 - lensprof_vignetting_eval(&s.vignetting, k / 20.0, nullptr)));
        e.response = std::max(e.response, std::abs(lensprof_response_eval(&r.response, k / 20.0, nullptr)
                                                   - lensprof_response_eval(&s.response, k / 20.0, nullptr)));
    }
    const auto log_at = [](const lensprof_response &f) {
        return std::log(lensprof_response_invert(&f, 0.35, nullptr));
    };
    e.gamma = std::log(log_at(r.response) / log_at(s.response)) / r.gamma_sigma;
    return e;
}

void test_sequences_improve(void **) {
    Errors after[kSequences], alone;
    uint32_t overruled = 0;
    for (uint32_t camera = 0; camera < kCameras; camera++) {
        std::unique_ptr<lensprof_profile> stored;
        for (uint32_t i = 0; i < kSequences; i++) {
            const Simulation s = sequence(1000 * camera + 7 * i + 1);
            Found found, own;
            assert_ok(fit(s, stored.get(), found));
            assert_ok(fit(s, nullptr, own));
            assert_int_equal(own.result->profile_prior, LENSPROF_PROFILE_PRIOR_NONE);
            if (stored) assert_int_not_equal(found.result->profile_prior, LENSPROF_PROFILE_PRIOR_NONE);
            overruled += found.result->profile_prior == LENSPROF_PROFILE_PRIOR_OVERRULED;
            after[i].add(errors_of(s, *found.result));
            alone.add(errors_of(s, *own.result));
            stored = profile_of(*found.result);
            assert_ok(lensprof_profile_validate(stored.get()));
        }
    }
    for (Errors &e : after) e = e.root_mean(kCameras);
    alone = alone.root_mean(kCameras * kSequences);
    for (const Errors &e : after)
        printf("    falloff %.4f, response %.4f, gamma %.2f sigma\n", e.falloff, e.response, e.gamma);
    printf("    each alone: falloff %.4f, response %.4f\n", alone.falloff, alone.response);
    const Errors &last = after[kSequences - 1];
    assert_true(last.falloff < 0.75 * after[0].falloff && last.response < 0.75 * after[0].response);
    assert_true(last.falloff < 0.75 * alone.falloff && last.response < 0.75 * alone.response);
    assert_true(last.gamma < 1.6);  // the stated error of gamma shrinks no faster than the error
    assert_true(overruled <= 1);    // three standard errors
}

// Of another lens and another response, both with small stated errors.
void test_wrong_profile_is_overruled(void **) {
    for (const double exponent : {1.3, 1.0}) {
        Simulation other = sequence(5), s = sequence(99);
        other.vignetting = {{-0.05, 0.0, 0.0}, {0.0, 0.0}};
        other.response = gamma_response(exponent);
        other.pairs.clear(), other.fit_images.clear();
        other.make(2000, 1.0, 0.0, 1.5, 5);
        Found first, found, own;
        assert_ok(fit(other, nullptr, first));
        const auto stored = profile_of(*first.result);
        assert_ok(fit(s, stored.get(), found));
        assert_ok(fit(s, nullptr, own));
        assert_int_equal(found.result->profile_prior, LENSPROF_PROFILE_PRIOR_OVERRULED);
        assert_int_equal(found.result->usable, 1);
        assert_reason(*found.result, PRIOR_OVERRULED, "contradicts the pictures");
        assert_int_equal(found.result->first.value_count, 2);
        assert_memory_equal(found.result->vignetting, own.result->vignetting, sizeof own.result->vignetting);
        assert_memory_equal(&found.result->response, &own.result->response, sizeof own.result->response);
        assert_memory_equal(found.exposures.data(), own.exposures.data(), 2 * sizeof own.exposures[0]);
    }
}

// A falloff without its response, as from a database: 80 pairs alone do not determine it.
void test_falloff_alone(void **) {
    double with = 0.0, without = 0.0;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        const Simulation s = sequence(seed, 80);
        auto stored = std::make_unique<lensprof_profile>();
        lensprof_profile_init(stored.get());
        stored->vignetting[0] = s.vignetting;
        stored->covariance_size = 5;
        for (int i = 0; i < 3; i++) stored->covariance[6 * i] = 1e-4;
        Found found, own;
        assert_ok(fit(s, stored.get(), found));
        assert_ok(fit(s, nullptr, own));
        assert_int_equal(found.result->gamma_from, LENSPROF_GAMMA_FALLOFF);
        assert_true(found.result->gamma_sigma < own.result->gamma_sigma);
        with += errors_of(s, *found.result).falloff / 10.0, without += errors_of(s, *own.result).falloff / 10.0;
    }
    printf("    80 pairs: %.4f with a falloff, %.4f without\n", with, without);
    assert_true(with < 0.6 * without);
}

// Response and falloff measured on different pictures, both accurately.
std::unique_ptr<lensprof_profile> composed(const lensprof_response &response, lensprof_vignetting falloff,
                                           double times) {
    auto stored = std::make_unique<lensprof_profile>();
    lensprof_profile_init(stored.get());
    const auto emor = lensprof::project_curve(response.table, 12);
    assert_ok(lensprof_response_set_emor(&stored->response[0], emor.data(), 12));
    stored->vignetting[0] = falloff;
    for (double &k : stored->vignetting[0].k) k *= times;
    stored->covariance_size = 15;
    for (int i = 0; i < 15; i++) stored->covariance[16 * i] = i < 12 ? 1e-3 / (1 + i * i) : 1e-5;
    return stored;
}

// A refined response, as brackets store it: a table, with the error of its gamma and no covariance. Without that error,
// the table does not state how accurate it is.
void test_refined_response(void **) {
    Errors with, without;
    for (uint64_t seed = 1; seed <= 5; seed++) {
        const Simulation s = sequence(seed);
        auto stored = std::make_unique<lensprof_profile>();
        lensprof_profile_init(stored.get());
        assert_ok(lensprof_response_set_table(&stored->response[0], s.response.table, LENSPROF_RESPONSE_SAMPLES));
        Found found, own;
        for (const double says_nothing : {0.0, 1.0, 1e200}) {
            stored->provenance.gamma_sigma = says_nothing;
            assert_int_equal(fit(s, stored.get(), found), LENSPROF_ERROR_ARGUMENT);
        }
        stored->provenance.gamma_sigma = 0.02;
        assert_ok(fit(s, stored.get(), found));
        assert_ok(fit(s, nullptr, own));
        assert_int_equal(found.result->profile_prior, LENSPROF_PROFILE_PRIOR_USED);
        assert_int_equal(found.result->gamma_from, LENSPROF_GAMMA_PROFILE);
        assert_true(found.result->gamma_sigma < 0.5 * own.result->gamma_sigma);
        with.add(errors_of(s, *found.result)), without.add(errors_of(s, *own.result));
    }
    with = with.root_mean(5.0), without = without.root_mean(5.0);
    printf("    f %.4f and M %.4f with a refined response, %.4f and %.4f without\n", with.response, with.falloff,
           without.response, without.falloff);
    assert_true(with.response < 0.5 * without.response && with.falloff < 0.8 * without.falloff);
}

// A wrong refined response is overruled like one with a covariance.
void test_wrong_refined_response_is_overruled(void **) {
    const Simulation s = sequence(4, 40000);
    auto stored = std::make_unique<lensprof_profile>();
    lensprof_profile_init(stored.get());
    double wrong[LENSPROF_RESPONSE_SAMPLES];  // a steep S
    for (int j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++) wrong[j] = 0.5 - 0.5 * std::cos(M_PI * std::sqrt(j / 1023.0));
    assert_ok(lensprof_response_set_table(&stored->response[0], wrong, LENSPROF_RESPONSE_SAMPLES));
    stored->provenance.gamma_sigma = 0.02;
    Found found;
    assert_ok(fit(s, stored.get(), found));
    assert_int_equal(found.result->profile_prior, LENSPROF_PROFILE_PRIOR_OVERRULED);
    stored->vignetting[0] = s.vignetting;
    stored->covariance_size = 5;
    for (int i = 0; i < 3; i++) stored->covariance[6 * i] = 1e-4;
    assert_ok(fit(s, stored.get(), found));
    assert_int_equal(found.result->profile_prior, LENSPROF_PROFILE_PRIOR_RESPONSE_OVERRULED);
    assert_int_equal(found.result->gamma_from, LENSPROF_GAMMA_FALLOFF);
}

// The wrong one is left out, the other one determines gamma.
void test_response_and_falloff_are_overruled_apart(void **) {
    for (uint64_t seed = 1; seed <= 3; seed++) {
        const Simulation s = sequence(seed);
        Found found;
        assert_ok(fit(s, composed(s.response, s.vignetting, 1.0).get(), found));
        assert_int_equal(found.result->profile_prior, LENSPROF_PROFILE_PRIOR_USED);
        assert_true(errors_of(s, *found.result).falloff < 0.03);
        assert_ok(fit(s, composed(s.response, s.vignetting, 0.2).get(), found));
        assert_int_equal(found.result->profile_prior, LENSPROF_PROFILE_PRIOR_FALLOFF_OVERRULED);
        assert_int_equal(found.result->gamma_from, LENSPROF_GAMMA_PROFILE);
        assert_true(errors_of(s, *found.result).falloff < 0.03);
        assert_reason(*found.result, PRIOR_FALLOFF_OVERRULED, "its response was used");
        assert_ok(fit(s, composed(film_response(), s.vignetting, 1.0).get(), found));
        assert_int_equal(found.result->profile_prior, LENSPROF_PROFILE_PRIOR_RESPONSE_OVERRULED);
        assert_int_equal(found.result->gamma_from, LENSPROF_GAMMA_FALLOFF);
        assert_true(errors_of(s, *found.result).falloff < 0.03);
        assert_reason(*found.result, PRIOR_RESPONSE_OVERRULED, "its falloff was used");
    }
}

void test_three_curves_for_one_and_one_for_three(void **) {
    const Simulation s = sequence(3);
    for (const uint32_t curves : {1u, 3u}) {
        auto stored = std::make_unique<lensprof_profile>();
        lensprof_profile_init(stored.get());
        stored->vignettings = curves;
        for (uint32_t c = 0; c < curves; c++) stored->vignetting[c] = s.vignetting;
        stored->covariance_size = 3 * curves + 2;
        for (uint32_t i = 0; i < stored->covariance_size; i++)
            stored->covariance[i * stored->covariance_size + i] = 1e-4;
        for (const uint32_t asked : {1u, 3u}) {
            Found found;
            found.exposures.resize(2);
            lensprof_fit_options options;
            lensprof_fit_options_init(&options);
            options.profile = stored.get();
            options.vignettings = asked;
            Simulation two = s;
            two.fit_images.resize(2), two.pairs.resize(2000), two.images = 2;
            *found.result = run_fit(two, options).result;
            assert_int_equal(found.result->profile_prior, LENSPROF_PROFILE_PRIOR_USED);
            assert_int_equal(found.result->vignettings, asked);
            assert_true(errors_of(s, *found.result).falloff < 0.06);
        }
    }
}

void test_radiance(void **) {
    const Simulation s = sequence(21), other = sequence(22);
    Found first, second, own;
    assert_ok(fit(other, nullptr, first, nullptr, LENSPROF_METHOD_RADIANCE));
    assert_ok(fit(s, nullptr, own, nullptr, LENSPROF_METHOD_RADIANCE));
    const auto stored = profile_of(*first.result);
    assert_ok(fit(s, stored.get(), second, nullptr, LENSPROF_METHOD_RADIANCE));
    assert_int_equal(second.result->profile_prior, LENSPROF_PROFILE_PRIOR_USED);
    assert_true(second.result->gamma_sigma < 0.9 * own.result->gamma_sigma);
}

void test_refused(void **) {
    const Simulation s = sequence(1);
    Found found;
    lensprof_error error;
    auto profile = std::make_unique<lensprof_profile>();
    lensprof_profile_init(profile.get());
    assert_int_equal(fit(s, profile.get(), found, &error), LENSPROF_ERROR_ARGUMENT);
    assert_non_null(strstr(error.text, "neither a covariance"));
    profile->covariance_size = 5;  // all held
    assert_int_equal(fit(s, profile.get(), found, &error), LENSPROF_ERROR_ARGUMENT);
    profile->covariance[0] = profile->covariance[6] = 1e-4;
    profile->covariance[1] = profile->covariance[5] = 1e-2;  // a correlation of 100
    assert_int_equal(fit(s, profile.get(), found, &error), LENSPROF_ERROR_ARGUMENT);
    assert_non_null(strstr(error.text, "covariance is not positive semi-definite"));
    profile->covariance[1] = profile->covariance[5] = 0.0;
    assert_int_equal(fit(s, profile.get(), found, &error, LENSPROF_METHOD_TRANSFER_FUNCTION),
                     LENSPROF_ERROR_UNSUPPORTED);
    profile->vignetting[0].k[0] = -2.0;
    assert_int_equal(fit(s, profile.get(), found, &error), LENSPROF_ERROR_VIGNETTING);
    assert_non_null(strstr(error.text, "the profile is invalid"));
}

}  // namespace

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sequences_improve),
        cmocka_unit_test(test_wrong_profile_is_overruled),
        cmocka_unit_test(test_falloff_alone),
        cmocka_unit_test(test_refined_response),
        cmocka_unit_test(test_wrong_refined_response_is_overruled),
        cmocka_unit_test(test_response_and_falloff_are_overruled_apart),
        cmocka_unit_test(test_three_curves_for_one_and_one_for_three),
        cmocka_unit_test(test_radiance),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
