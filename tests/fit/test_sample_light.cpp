// Sampling with a known camera: places are compared by the light they received.
#include "fit/sampling/light.hpp"
#include "sampled_pictures.hpp"

#include <algorithm>

using lensprof::is_lost_grey;
using lensprof::Light;

namespace {

constexpr double kEmor[] = {0.8, -0.4};

lensprof_response curved_response() {
    lensprof_response response;
    assert_ok(lensprof_response_set_emor(&response, kEmor, 2));
    return response;
}

lensprof_vignetting strong_falloff() {
    lensprof_vignetting vignetting{};
    vignetting.k[0] = -0.6, vignetting.k[1] = 0.2, vignetting.k[2] = -0.1;
    vignetting.center[0] = 0.02;
    return vignetting;
}

// Equal light gives equal values, and twice the light gives 2^(1/2.2) times the value.
void test_light_is_what_was_received(void **) {
    const lensprof_response response = curved_response();
    const lensprof_vignetting vignetting = strong_falloff();
    const Light light(&response, &vignetting);
    lensprof_camera camera{};
    camera.width = 640, camera.height = 480;
    double least = 1.0;
    for (const double received : {0.05, 0.1, 0.2, 0.4})
        for (const double x : {0.0, 100.0, 320.0, 639.0})
            for (const double y : {0.0, 240.0, 479.0}) {
                const double r2 = lensprof_vignetting_r2(&vignetting, 640, 480, x, y, nullptr);
                const double grey = lensprof_response_eval(
                    &response, received * lensprof_vignetting_eval(&vignetting, r2, nullptr), nullptr);
                const double found = std::pow(light.of(static_cast<float>(grey), camera, x, y), 2.2) / received;
                if (least == 1.0) least = found;
                assert_close(found, least, 1e-4);
            }
    assert_close(least, 0.5, 1e-4);  // M(1): the corner's light is unchanged
    for (const float lost : {0.0f, 0.003f, 0.985f, 1.0f}) {
        assert_true(is_lost_grey(lost));
        assert_true(light.of(lost, camera, 0, 0) == lost);
    }
    assert_true(light.of(0.97f, camera, 0, 0) <= lensprof::kWhiteGrey);
    assert_false(Light(nullptr, nullptr).is_known());
}

// Linear pictures, the second with a fortieth of the light: its texture is less than a twentieth of the first's.
struct FarApart : Pictures {
    FarApart() : Pictures(2, 320, 240, 15.0) {
        for (float &value : data[1]) value /= 40;
        for (lensprof_sample_image &image : images) image.black = 1e-4;
    }
};

lensprof_link link_of(FarApart &pictures, const lensprof_response *response, std::vector<lensprof_pair> &pairs,
                      lensprof_status expected = LENSPROF_OK) {
    lensprof_sample_options options = options_of(LENSPROF_SAMPLING_BALANCED, 500);
    lensprof_link link{};
    uint32_t found = 0;
    options.links = &link, options.link_capacity = 1, options.link_count = &found;
    options.response = response;
    assert_int_equal(pictures.sample(options, pairs), expected);
    return link;
}

void test_light_joins_what_grey_values_do_not(void **) {
    detail = 0.07;
    FarApart pictures;
    detail = 0.0;
    lensprof_response linear;
    lensprof_response_set_linear(&linear);
    std::vector<lensprof_pair> pairs;
    link_of(pictures, nullptr, pairs, LENSPROF_ERROR_NO_SAMPLES);
    const lensprof_link link = link_of(pictures, &linear, pairs);
    assert_int_equal(link.state, LENSPROF_LINK_VERIFIED);
    assert_true(pairs.size() > 300);
    for (const lensprof_pair &pair : pairs) {  // the pictures' own grey values
        const int bright = pair.image[0] == 0 ? 0 : 1;
        for (int c = 0; c < 3; c++) assert_close(pair.value[bright][c] / pair.value[1 - bright][c], 40.0, 1.0);
    }
}

void test_other_pictures_stay_apart(void **) {
    detail = 0.07;
    FarApart pictures;
    detail = 0.0;
    std::reverse(pictures.data[1].begin(), pictures.data[1].end());  // rotated by 180 degrees
    lensprof_response linear;
    lensprof_response_set_linear(&linear);
    std::vector<lensprof_pair> pairs;
    link_of(pictures, &linear, pairs, LENSPROF_ERROR_NO_SAMPLES);
}

void test_refuses_what_is_no_camera(void **) {
    Pictures pictures(2, 80, 60, 20.0);
    std::vector<lensprof_pair> pairs;
    lensprof_error error;
    lensprof_response response = curved_response();
    lensprof_vignetting vignetting = strong_falloff();
    lensprof_sample_options options = options_of(LENSPROF_SAMPLING_BALANCED, 100);
    options.response = &response, options.vignetting = &vignetting;
    assert_ok(pictures.sample(options, pairs, &error));
    vignetting.k[0] = -3.0;
    assert_int_equal(pictures.sample(options, pairs, &error), LENSPROF_ERROR_VIGNETTING);
    assert_non_null(strstr(error.text, "falloff is invalid"));
    std::swap(response.table[100], response.table[800]);
    assert_int_equal(pictures.sample(options, pairs, &error), LENSPROF_ERROR_RESPONSE);
    assert_non_null(strstr(error.text, "response is invalid"));
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_light_is_what_was_received),
        cmocka_unit_test(test_light_joins_what_grey_values_do_not),
        cmocka_unit_test(test_other_pictures_stay_apart),
        cmocka_unit_test(test_refuses_what_is_no_camera),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
