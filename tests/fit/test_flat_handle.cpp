// A fit of a card that the caller holds: its memory, its profile, and what it refuses.
#include "flat_pictures.hpp"

#include <cstring>

namespace {

FlatPictures card() {
    FlatPictures p;
    p.width = 300, p.height = 220;
    p.shoot(0);
    p.shoot(1, 0.0, 90.0);
    return p;
}

lensprof_flat *fit_of(const FlatPictures &p, const lensprof_flat_options &o, void *memory = nullptr, size_t size = 0) {
    lensprof_flat *flat = nullptr;
    assert_ok(
        lensprof_fit_flat(&o, p.images.data(), static_cast<uint32_t>(p.images.size()), memory, size, &flat, nullptr));
    return flat;
}

// A caller's profile that still holds another fit's data.
lensprof_profile used_profile() {
    lensprof_profile profile;
    lensprof_profile_init(&profile);
    profile.covariance_size = 5;
    for (int i = 0; i < 25; i++) profile.covariance[i] = 9.0;
    std::strcpy(profile.key.lens, "a lens");
    std::strcpy(profile.provenance.source, "a file");
    std::strcpy(profile.provenance.method, "a method that is longer");
    profile.provenance.created_unix_s = 5, profile.provenance.prior_id = 7, profile.provenance.forced = 1;
    profile.provenance.heldout_rms = 99.0;
    return profile;
}

void test_memory(void **) {
    const FlatPictures p = card();
    const lensprof_flat_options o = p.options();
    const size_t bytes = lensprof_flat_bytes(2);
    std::vector<uint64_t> memory(bytes / 8);
    lensprof_flat *own = fit_of(p, o), *other = fit_of(p, o, memory.data(), bytes);
    assert_ptr_equal(other, memory.data());
    const auto a = std::make_unique<lensprof_flat_result>(), b = std::make_unique<lensprof_flat_result>();
    lensprof_flat_result_init(a.get()), lensprof_flat_result_init(b.get());
    assert_ok(lensprof_flat_get(own, a.get(), nullptr));
    assert_ok(lensprof_flat_get(other, b.get(), nullptr));
    assert_memory_equal(a.get(), b.get(), sizeof *a);
    assert_int_equal(a->images, 2);
    lensprof_flat_destroy(own), lensprof_flat_destroy(other);
}

void test_profile(void **) {
    const FlatPictures p = card();
    lensprof_flat_options o = p.options();
    std::vector<lensprof_response> responses(3);
    for (lensprof_response &response : responses) lensprof_response_set_linear(&response);
    o.response = responses.data(), o.responses = 3;
    lensprof_flat *flat = fit_of(p, o);
    const auto r = p.fit(o);
    for (lensprof_response &response : responses) assert_ok(lensprof_response_set_gamma(&response, 2.2));  // copied
    lensprof_profile profile = used_profile();
    assert_ok(lensprof_flat_profile(flat, &profile, nullptr));
    lensprof_flat_destroy(flat);
    assert_string_equal(profile.key.lens, "a lens");  // the caller's
    assert_string_equal(profile.provenance.source, "a file");
    assert_int_equal(profile.provenance.created_unix_s, 5);
    assert_int_equal(profile.provenance.prior_id, 7);
    assert_int_equal(profile.provenance.forced, 1);
    assert_int_equal(profile.responses, 3);
    assert_int_equal(profile.response[2].kind, LENSPROF_RESPONSE_LINEAR);
    assert_int_equal(profile.vignettings, r->vignettings);
    assert_memory_equal(profile.vignetting, r->vignetting, sizeof r->vignetting);
    assert_memory_equal(&profile.grid, &r->gain_grid, sizeof profile.grid);
    assert_int_equal(profile.covariance_size, r->covariance_size);
    assert_memory_equal(profile.covariance, r->covariance, r->covariance_size * r->covariance_size * sizeof(double));
    assert_string_equal(profile.provenance.method, "flat");
    assert_string_equal(profile.provenance.software, "lensprof 0.3.0");
    assert_int_equal(profile.provenance.images, 2);
    assert_int_equal(profile.provenance.pairs, r->cells);
    assert_int_equal(profile.provenance.not_usable, !r->usable);
    assert_close(profile.provenance.heldout_rms, LENSPROF_UNKNOWN, 0.0);
    assert_close(profile.provenance.inlier_share, r->inlier_share, 0.0);
    assert_ok(lensprof_profile_validate(&profile));
}

void test_refused(void **) {
    const FlatPictures p = card();
    std::vector<uint64_t> memory(lensprof_flat_bytes(2) / 8);
    lensprof_flat *flat = fit_of(p, p.options(), memory.data(), 8 * memory.size());
    const auto result = std::make_unique<lensprof_flat_result>();
    lensprof_flat_image_quality quality;
    lensprof_profile profile = used_profile();
    lensprof_finding finding;
    lensprof_error error;
    lensprof_finding_init(&finding);
    lensprof_flat_result_init(result.get()), lensprof_flat_image_quality_init(&quality);
    assert_int_equal(lensprof_flat_image_at(flat, 2, &quality, &error), LENSPROF_ERROR_ARGUMENT);
    assert_non_null(std::strstr(error.text, "no image 2, but 2"));
    assert_int_equal(lensprof_flat_get(nullptr, result.get(), &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_flat_get(flat, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_flat_image_at(nullptr, 0, &quality, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_flat_image_at(flat, 0, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
    assert_ok(lensprof_flat_get(flat, result.get(), &error));
    const uint32_t count = result->findings + result->passed;
    assert_ok(lensprof_flat_finding_at(flat, count - 1, &finding, &error));
    assert_int_equal(finding.severity, LENSPROF_SEVERITY_PASSED);
    assert_int_equal(lensprof_flat_finding_at(flat, count, &finding, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_flat_finding_at(nullptr, 0, &finding, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_flat_finding_at(flat, 0, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_flat_profile(nullptr, &profile, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_flat_profile(flat, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
    result->struct_size = quality.struct_size = profile.struct_size = 0;
    assert_int_equal(lensprof_flat_get(flat, result.get(), &error), LENSPROF_ERROR_STRUCT_SIZE);
    assert_int_equal(lensprof_flat_image_at(flat, 0, &quality, &error), LENSPROF_ERROR_STRUCT_SIZE);
    assert_int_equal(lensprof_flat_profile(flat, &profile, &error), LENSPROF_ERROR_STRUCT_SIZE);
    lensprof_flat_result_init(result.get()), lensprof_flat_image_quality_init(&quality);
    profile = used_profile();
    lensprof_flat_destroy(flat);
    assert_int_equal(lensprof_flat_get(flat, result.get(), &error), LENSPROF_ERROR_ARGUMENT);
    assert_non_null(std::strstr(error.text, "released"));
    assert_int_equal(lensprof_flat_image_at(flat, 0, &quality, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_flat_finding_at(flat, 0, &finding, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_flat_profile(flat, &profile, &error), LENSPROF_ERROR_ARGUMENT);
    assert_string_equal(profile.provenance.method, "a method that is longer");
    lensprof_flat_destroy(flat);
    lensprof_flat_destroy(nullptr);
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_memory),
        cmocka_unit_test(test_profile),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
