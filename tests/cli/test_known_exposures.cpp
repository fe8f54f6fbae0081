// The standard errors of EXIF exposures in the fit.
#include <algorithm>
#include <cstring>
#include <sstream>

#include "photo/calibration/known_exposures.hpp"

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

struct Known {
    std::vector<double> sigmas, ev;
    std::string note;
};

Known known_of(std::vector<PictureMetadata> metadata, const FitOptions &options = {}) {
    std::vector<lensprof_fit_image> images(metadata.size());
    Scene project;
    project.path = "pictures";
    for (size_t i = 0; i < metadata.size(); i++) project.names.push_back("img" + std::to_string(i) + ".jpg");
    project.files = project.names;
    for (uint32_t i = 0; i < images.size(); i++) {
        auto &m = metadata[i];
        lensprof_fit_image_init(&images[i], i, 200, 150);
        if (m.exposure_time_s && m.f_number && m.iso)
            m.exif_ev = std::log2(*m.exposure_time_s * *m.iso / 100.0 / (*m.f_number * *m.f_number));
    }
    NoticeList notices;
    const ExifUse use = add_known_exposures(options, project, metadata, images, notices);
    Known known{{}, {}, {}};
    for (const Notice &notice : notices.list) known.note += notice.line() + "\n";
    for (const auto &image : images) known.sigmas.push_back(image.known_ev_sigma), known.ev.push_back(image.known_ev);
    assert_int_equal(use.note.empty(), known.note.empty());
    assert_true(known.note.find(use.note) != std::string::npos);
    assert_int_equal(use.images,
                     std::count_if(known.sigmas.begin(), known.sigmas.end(), [](double s) { return s > 0; }));
    return known;
}

std::vector<double> sigmas(const std::vector<PictureMetadata> &metadata, const FitOptions &options = {}) {
    return known_of(metadata, options).sigmas;
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

// Exposures of 0, 1 and -2 EV by time and ISO.
std::vector<PictureMetadata> three_exposures() {
    std::vector<PictureMetadata> m(3, manual());
    for (auto &metadata : m) metadata.is_manual = false;
    m[1].exposure_time_s = 0.02;
    m[2].exposure_time_s = 0.005, m[2].iso = 50.0;
    return m;
}

void assert_steps(const Known &known, const char *in_note) {
    assert_sigmas(known.sigmas, {0.1, 0.1, 0.1});
    assert_close(known.ev[1] - known.ev[0], 1.0, 1e-9);
    assert_close(known.ev[2] - known.ev[0], -2.0, 1e-9);
    assert_true(known.note.find(in_note) != std::string::npos);
}

// What no picture states cancels.
void test_a_field_that_all_lack_cancels(void **) {
    assert_steps(known_of(three_exposures()), "");
    assert_true(known_of(three_exposures()).note.empty());
    std::vector<PictureMetadata> m = three_exposures();
    for (auto &metadata : m) metadata.f_number.reset();
    assert_steps(known_of(m), "3 of 3 pictures, by time and ISO: it states no aperture");
    m[2].iso = 100.0, m[2].exposure_time_s = 0.0025;
    for (auto &metadata : m) metadata.iso.reset();
    assert_steps(known_of(m), "by the time alone");
    for (auto &metadata : m) metadata.f_number = 8.0;
    assert_steps(known_of(m), "by time and aperture: it states no ISO");
    for (auto &metadata : m) metadata.exposure_time_s.reset();
    assert_sigmas(known_of(m).sigmas, {0.0, 0.0, 0.0});  // cameras vary the time
    assert_true(known_of(m).note.empty());               // an aperture alone describes the lens
    for (auto &metadata : m) metadata.iso = 200.0;
    assert_sigmas(known_of(m).sigmas, {0.0, 0.0, 0.0});
    assert_true(known_of(m).note.find("0 of 3 pictures") != std::string::npos);
    assert_true(known_of({unknown_metadata(), unknown_metadata()}).note.empty());
}

// One that some pictures lack is unknown in these.
void test_a_field_that_one_lacks_is_unknown(void **) {
    for (int field = 0; field < 3; field++) {
        std::vector<PictureMetadata> m = three_exposures();
        (field == 0 ? m[1].f_number : field == 1 ? m[1].iso : m[1].exposure_time_s).reset();
        const Known known = known_of(m);
        assert_sigmas(known.sigmas, {0.1, 0.0, 0.1});
        assert_close(known.ev[2] - known.ev[0], -2.0, 1e-9);
        const char *without[] = {"aperture", "ISO", "exposure time"};
        assert_true(known.note.find(std::string("2 of 3 pictures; without ") + without[field] + ": img1.jpg")
                    != std::string::npos);
    }
}

// A lens without contacts next to one with: only the larger group is comparable.
void test_lenses_are_not_compared_without_apertures(void **) {
    std::vector<PictureMetadata> m(5, manual());
    for (auto &metadata : m) metadata.is_manual = false, std::strcpy(metadata.key.lens, "With contacts");
    for (size_t i : {1, 3, 4}) m[i].f_number.reset(), *m[i].key.lens = '\0';
    assert_sigmas(known_of(m).sigmas, {0.0, 0.1, 0.0, 0.1, 0.1});
    const std::string apart = "; not comparable with these, because a lens states no aperture: img0.jpg, img2.jpg";
    assert_true(known_of(m).note.find("3 of 5 pictures, by time and ISO: it states no aperture" + apart)
                != std::string::npos);
    assert_true(known_of(m).note.find("without ") == std::string::npos);
    m[2].exposure_time_s.reset();
    assert_true(known_of(m).note.find("no aperture: img0.jpg; without exposure time: img2.jpg") != std::string::npos);
    m[2].exposure_time_s = 0.01;
    m[4].key.focal_mm = 50.0;  // a third lens
    assert_sigmas(known_of(m).sigmas, {0.1, 0.0, 0.1, 0.0, 0.0});
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
        cmocka_unit_test(test_one_manual_exposure),
        cmocka_unit_test(test_automatic_exposures),
        cmocka_unit_test(test_the_largest_group),
        cmocka_unit_test(test_what_is_not_known_is_left_out),
        cmocka_unit_test(test_the_option_is_for_all),
        cmocka_unit_test(test_a_field_that_all_lack_cancels),
        cmocka_unit_test(test_a_field_that_one_lacks_is_unknown),
        cmocka_unit_test(test_lenses_are_not_compared_without_apertures),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
