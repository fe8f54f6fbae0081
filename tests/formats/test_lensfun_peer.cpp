// Written databases, read and applied by Lensfun itself.
#include <lensfun.h>

#include "lensfun_support.hpp"

namespace {

constexpr int kWidth = 601, kHeight = 401;  // r = 1 at the centre of a corner pixel: hypot(600, 400) / 2

// Loads a database and returns its only lens.
class Loaded {
public:
    explicit Loaded(const std::string &text) : db_(lf_db_new()) {
        assert_int_equal(lf_db_load_data(db_, "lensprof", text.data(), text.size()), LF_NO_ERROR);
    }
    ~Loaded() { lf_db_destroy(db_); }
    lfDatabase *db() const { return db_; }

    const lfLens *find(const lfCamera *camera, const char *name) const {
        const lfLens **found = lf_db_find_lenses_hd(db_, camera, nullptr, name, 0);
        const lfLens *lens = found ? found[0] : nullptr;
        lf_free(found);
        return lens;
    }

private:
    lfDatabase *db_;
};

// Lensfun's gain, the inverse of M, in one row of a grey picture of ones.
std::vector<float> gains(const lfLens *lens, float crop, float focal, float aperture, float distance, int width,
                         int height, int row) {
    std::vector<float> pixels(static_cast<size_t>(width) * 3, 1.0f);
    lfModifier *modifier = lf_modifier_new(lens, crop, width, height);
    const int done = lf_modifier_initialize(modifier, lens, LF_PF_F32, focal, aperture, distance, 1.0f, LF_RECTILINEAR,
                                            LF_MODIFY_VIGNETTING, false);
    assert_true(done & LF_MODIFY_VIGNETTING);
    lf_modifier_apply_color_modification(modifier, pixels.data(), 0, static_cast<float>(row), width, 1,
                                         LF_CR_3(RED, GREEN, BLUE), width * 3 * static_cast<int>(sizeof(float)));
    lf_modifier_destroy(modifier);
    return pixels;
}

// Over the frame. Lensfun measures the half diagonal between pixel centres, so the frame of lensprof is one pixel
// smaller here.
void compare_gains(const lensprof_profile &profile, float distance, double tolerance) {
    const Loaded loaded(write_lensfun({profile}));
    const lfLens *lens = loaded.find(nullptr, profile.key.lens);
    assert_non_null(lens);
    const auto crop = static_cast<float>(profile.key.crop_factor);
    double worst = 0.0, strongest = 1.0;
    for (int y = 0; y < kHeight; y += 20) {
        const std::vector<float> row = gains(lens, crop, static_cast<float>(profile.key.focal_mm),
                                             static_cast<float>(profile.key.aperture), distance, kWidth, kHeight, y);
        for (int x = 0; x < kWidth; x++) {
            const double r2 =
                lensprof_vignetting_r2(&profile.vignetting[0], kWidth - 1, kHeight - 1, x - 0.5, y - 0.5, nullptr);
            const double gain = 1.0 / lensprof_vignetting_eval(&profile.vignetting[0], r2, nullptr);
            worst = fmax(worst, fabs(row[static_cast<size_t>(x) * 3] - gain) / gain);
            strongest = fmax(strongest, gain);
        }
    }
    print_message("%s: gains up to %.3f, worst relative difference %.2g\n", profile.key.lens, strongest, worst);
    assert_true(strongest > 1.35);
    assert_true(worst < tolerance);
}

void test_gains_are_the_same(void **) {
    compare_gains(lens_profile("Acme 50mm f/2", 1, 50, 2, INFINITY, -0.4, 0.1, -0.1), 1000, 1e-4);
    compare_gains(lens_profile("Acme 18mm f/4", 1.523, 18, 4, 0.45, -0.8, 0.5, -0.2), 0.45f, 1e-4);
}

// A database with Adobe's model is converted to model pa with the same falloff.
void test_adobe_model_converted(void **) {
    const Database adobe = read_lensfun(
        "<lensdatabase version=\"2\"><lens><maker>Acme</maker><model>Acme 24mm f/2</model><mount>Generic</mount>"
        "<cropfactor>1.5</cropfactor><calibration><vignetting model=\"acm\" focal=\"24\" aperture=\"2\" distance=\"5\" "
        "alpha1=\"-0.9\" alpha2=\"0.4\" alpha3=\"-0.3\"/></calibration></lens></lensdatabase>");
    assert_int_equal(adobe.entries.size(), 1);
    lensprof_profile profile = lens_profile("Acme 24mm f/2", 1.5, 24, 2, 5, 0);
    profile.vignetting[0] = adobe.entries[0].vignetting;
    compare_gains(profile, 5, 5e-4);
    const double corner_mm = std::sqrt(36.0 * 36 + 24 * 24) / 3, u = corner_mm / 24;  // in focal lengths
    const Loaded loaded(write_lensfun({profile}));
    const std::vector<float> row = gains(loaded.find(nullptr, "Acme 24mm f/2"), 1.5f, 24, 2, 5, kWidth, kHeight, 0);
    const double m = 1 - 0.9 * u * u + 0.4 * std::pow(u, 4) - 0.3 * std::pow(u, 6);
    assert_close(row[0] * m, 1.0, 5e-4);
}

void test_every_entry_is_loaded(void **) {
    std::vector<lensprof_profile> profiles;
    for (int i = 0; i < 24; i++)
        profiles.push_back(lens_profile("Acme 24-70mm f/2.8", 1.5, 24 + 2 * (i / 6), 2.8 + i % 3,
                                        i / 3 % 2 ? INFINITY : 1, -0.1 - 0.01 * i, 0.02 + 0.001 * i, -0.01));
    const Loaded loaded(write_lensfun(profiles));
    const lfLens *lens = loaded.find(nullptr, "Acme 24-70mm f/2.8");
    assert_non_null(lens);
    assert_close(lens->CropFactor, 1.5, 1e-6);
    for (const lensprof_profile &profile : profiles) {
        lfLensCalibVignetting at;
        const double distance = std::isinf(profile.key.distance_m) ? 1000.0 : profile.key.distance_m;
        assert_true(lf_lens_interpolate_vignetting(lens, static_cast<float>(profile.key.focal_mm),
                                                   static_cast<float>(profile.key.aperture),
                                                   static_cast<float>(distance), &at));
        assert_int_equal(at.Model, LF_VIGNETTING_MODEL_PA);
        for (int n = 0; n < 3; n++) assert_close(at.Terms[n], profile.vignetting[0].k[n], 5.1e-5);
    }
}

// Together with Lensfun's own database, for a camera whose mount accepts "Generic".
void test_found_for_a_camera(void **) {
    const std::string cameras =
        "<lensdatabase version=\"1\"><mount><name>Acme F</name><compat>Generic</compat></mount>"
        "<camera><maker>Acme</maker><model>A1</model><mount>Acme F</mount><cropfactor>1.5"
        "</cropfactor></camera></lensdatabase>";
    const Loaded loaded(cameras);
    const std::string lens = write_lensfun({lens_profile("Acme 24mm f/2 & <so on>", 1.5, 24, 2, 5, -0.3)});
    assert_int_equal(lf_db_load_data(loaded.db(), "lensprof", lens.data(), lens.size()), LF_NO_ERROR);
    const lfCamera **found = lf_db_find_cameras(loaded.db(), "Acme", "A1");
    assert_non_null(found);
    assert_non_null(loaded.find(found[0], "Acme 24mm f/2 & <so on>"));
    lf_free(found);
}

// Maker, model and mount as Lensfun has them.
void test_maker_and_mount(void **) {
    const Loaded loaded(write_lensfun({lens_profile("EF24-70mm f/2.8L USM", 1, 24, 2.8, INFINITY, -0.5)}));
    const lfLens *lens = loaded.find(nullptr, "Canon EF 24-70mm f/2.8L USM");
    assert_non_null(lens);
    assert_string_equal(lens->Maker, "Canon");
    assert_string_equal(lens->Mounts[0], "Canon EF");
    assert_null(lens->Mounts[1]);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_gains_are_the_same),    cmocka_unit_test(test_adobe_model_converted),
        cmocka_unit_test(test_every_entry_is_loaded), cmocka_unit_test(test_found_for_a_camera),
        cmocka_unit_test(test_maker_and_mount),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
