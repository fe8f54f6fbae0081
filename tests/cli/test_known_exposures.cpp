// The standard errors of EXIF exposures in the fit.
#include <cstring>
#include <sstream>

#include "cli/fitting/known_exposures.hpp"

extern "C" {
#include "support.h"
}
#undef fail

using namespace lensprof;

namespace {

// 1/100 s, f/8, ISO 100, manual.
PictureMetadata manual() {
    PictureMetadata m = unknown_metadata();
    m.exposure_time_s = 0.01, m.f_number = 8.0, m.iso = 100.0, m.is_manual = true;
    return m;
}

std::vector<double> sigmas(std::vector<PictureMetadata> metadata, const FitOptions &options = {}) {
    std::vector<lensprof_fit_image> images(metadata.size());
    std::vector<std::string> files(metadata.size(), "img.jpg");
    for (uint32_t i = 0; i < images.size(); i++) {
        auto &m = metadata[i];
        lensprof_fit_image_init(&images[i], i, 200, 150);
        if (m.exposure_time_s && m.f_number && m.iso)
            m.exif_ev = std::log2(*m.exposure_time_s * *m.iso / 100.0 / (*m.f_number * *m.f_number));
    }
    std::ostringstream out, err;
    Streams streams{out, err};
    add_known_exposures(options, files, metadata, images, streams);
    std::vector<double> found;
    for (const auto &image : images) found.push_back(image.known_ev_sigma);
    return found;
}

void assert_sigmas(const std::vector<double> &found, const std::vector<double> &expected) {
    assert_int_equal(found.size(), expected.size());
    for (size_t i = 0; i < found.size(); i++) assert_close(found[i], expected[i], 1e-12);
}

void test_one_manual_exposure(void **) {
    assert_sigmas(sigmas({manual(), manual(), manual()}), {0.03, 0.03, 0.03});
    assert_sigmas(sigmas({manual()}), {0.1});
}

void test_automatic_exposures(void **) {
    PictureMetadata automatic = manual();
    automatic.is_manual = false;
    assert_sigmas(sigmas({automatic, automatic}), {0.1, 0.1});
    assert_sigmas(sigmas({manual(), automatic, manual()}), {0.03, 0.1, 0.03});
}

// Of several manual exposures, that of the most pictures; with equal counts, the first.
void test_the_largest_group(void **) {
    PictureMetadata longer = manual(), wider = manual(), faster = manual(), other = manual();
    longer.exposure_time_s = 0.02, wider.f_number = 5.6, faster.iso = 200.0;
    std::strcpy(other.key.camera_model, "Another");
    for (const PictureMetadata &m : {longer, wider, faster, other})
        assert_sigmas(sigmas({m, manual(), manual(), m, manual()}), {0.1, 0.03, 0.03, 0.1, 0.03});
    assert_sigmas(sigmas({longer, manual(), manual(), longer}), {0.03, 0.1, 0.1, 0.03});
    assert_sigmas(sigmas({longer, wider, faster, manual()}), {0.1, 0.1, 0.1, 0.1});
}

void test_what_is_not_known_is_left_out(void **) {
    PictureMetadata no_aperture = manual();
    no_aperture.f_number.reset();
    assert_sigmas(sigmas({no_aperture, manual(), manual()}), {0.0, 0.03, 0.03});
}

void test_the_option_is_for_all(void **) {
    PictureMetadata automatic = manual();
    automatic.is_manual = false;
    FitOptions options;
    options.exif_sigma = 0.2;
    assert_sigmas(sigmas({manual(), manual(), automatic}, options), {0.2, 0.2, 0.2});
    options.exif_sigma = 0.0;
    assert_sigmas(sigmas({manual(), manual(), automatic}, options), {0.0, 0.0, 0.0});
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_one_manual_exposure),   cmocka_unit_test(test_automatic_exposures),
        cmocka_unit_test(test_the_largest_group),     cmocka_unit_test(test_what_is_not_known_is_left_out),
        cmocka_unit_test(test_the_option_is_for_all),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
