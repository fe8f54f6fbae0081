// The shading of fields: estimates compared with the truth of made pictures, what must not change them, and refusals.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <vector>

extern "C" {
#include "support.h"
}
#undef fail

#include <lensprof/fields.h>

#include "fit/fields/content.hpp"

namespace {

constexpr uint32_t kWidth = 96, kHeight = 72;

// Off-centre, with a tilt: not radial about the middle.
double shading(double x, double y) {
    const double u = (x - 0.35 * kWidth) / kWidth, v = (y - 0.6 * kHeight) / kWidth;
    return std::exp(-0.9 * u * u - 1.4 * v * v + 0.15 * u);
}

double uniform(uint64_t &random, double low, double high) { return low + (high - low) * lp_random(&random); }

enum class Scene {
    cells,   // bright on an even background
    stains,  // dark on it
    waves    // no background at all
};

struct Made {
    Scene scene = Scene::cells;
    double light = 0.012, offset = 0.002, noise = 0.0001;  // of full scale: a sixteen bit camera that uses 2 % of it
    double levels = 0.3;                                   // spread of ln level
};

struct Field {
    uint32_t width = kWidth, height = kHeight;
    std::vector<uint16_t> pixels;
    lensprof_image view() const {
        return {pixels.data(), ptrdiff_t(width) * 2, width, height, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY};
    }
};

// ln C of a scene.
std::vector<double> content(Scene scene, uint64_t &random) {
    std::vector<double> c(size_t(kWidth) * kHeight, scene == Scene::waves ? 0.0 : 1.0);
    const int things = scene == Scene::waves ? 14 : 25;
    for (int i = 0; i < things; i++) {
        const double x = uniform(random, -0.1, 1.1) * kWidth, y = uniform(random, -0.1, 1.1) * kHeight;
        const double size = uniform(random, 2.0, 6.0), height = uniform(random, 0.3, 2.0);
        const double wave = uniform(random, 0.05, 0.4), turn = uniform(random, 0.0, 3.14),
                     phase = uniform(random, 0.0, 6.28);
        for (uint32_t v = 0; v < kHeight; v++)
            for (uint32_t u = 0; u < kWidth; u++) {
                double &at = c[size_t(v) * kWidth + u];
                const double r = std::hypot(u - x, v - y) / size;
                if (scene == Scene::cells && r < 1.0) at += 2.0 * height;
                if (scene == Scene::stains && r < 1.0) at *= std::exp(-height);
                if (scene == Scene::waves)
                    at += 0.1 * std::sin(wave * (std::cos(turn) * u + std::sin(turn) * v) + phase);
            }
    }
    if (scene == Scene::waves)
        for (double &at : c) at = std::exp(at);
    return c;
}

std::vector<Field> make(size_t count, const Made &made, uint64_t seed = 5) {
    std::vector<Field> fields(count);
    uint64_t random = seed;
    for (Field &field : fields) {
        const double level = made.light * std::exp(made.levels * lp_normal(&random));
        const std::vector<double> c = content(made.scene, random);
        for (uint32_t v = 0; v < kHeight; v++)
            for (uint32_t u = 0; u < kWidth; u++) {
                const double light = level * shading(u, v) * c[size_t(v) * kWidth + u];
                const double value = light + made.offset + made.noise * lp_normal(&random);
                field.pixels.push_back(static_cast<uint16_t>(std::lround(65535.0 * std::clamp(value, 0.0, 1.0))));
            }
    }
    return fields;
}

using Held = std::unique_ptr<lensprof_fields, decltype(&lensprof_fields_destroy)>;

lensprof_fields_options options() {
    lensprof_fields_options o;
    lensprof_fields_options_init(&o);
    o.channels = 1, o.width = kWidth, o.height = kHeight, o.threads = 1;
    return o;
}

// That of the pictures, where the offset does not matter.
lensprof_fields_options known_offset() {
    lensprof_fields_options o = options();
    o.given_offset = 1, o.offset[0] = 0.002;
    return o;
}

Held create(const lensprof_fields_options &o) {
    lensprof_fields *made = nullptr;
    assert_ok(lensprof_fields_create(&o, &made, nullptr));
    return {made, lensprof_fields_destroy};
}

Held added(const std::vector<Field> &fields, const lensprof_fields_options &o) {
    Held held = create(o);
    for (const Field &field : fields) {
        const lensprof_image view = field.view();
        assert_ok(lensprof_fields_add(held.get(), &view, nullptr, 0, nullptr));
    }
    return held;
}

std::unique_ptr<lensprof_fields_result> result_of(const Held &held) {
    auto result = std::make_unique<lensprof_fields_result>();
    lensprof_fields_result_init(result.get());
    assert_ok(lensprof_fields_get(held.get(), result.get(), nullptr));
    return result;
}

std::unique_ptr<lensprof_fields_result> fitted(const std::vector<Field> &fields,
                                               const lensprof_fields_options &o = options()) {
    const Held held = added(fields, o);
    assert_ok(lensprof_fields_fit(held.get(), nullptr));
    return result_of(held);
}

// RMS over the frame of the shading over its mean, from the truth.
double error_of(const lensprof_fields_result &r, uint32_t channel = 0) {
    std::vector<double> found, truth;
    double found_mean = 0.0, truth_mean = 0.0;
    for (uint32_t v = 0; v < kHeight; v += 2)
        for (uint32_t u = 0; u < kWidth; u += 2) {
            found.push_back(lensprof_gain_grid_eval(&r.shading, kWidth, kHeight, u, v, channel));
            truth.push_back(shading(u, v));
            found_mean += found.back(), truth_mean += truth.back();
        }
    double sum = 0.0;
    for (size_t i = 0; i < found.size(); i++) {
        const double away = found[i] / found_mean - truth[i] / truth_mean;
        sum += away * away * static_cast<double>(found.size() * found.size());
    }
    return std::sqrt(sum / static_cast<double>(found.size()));
}

std::vector<uint32_t> codes_of(const Held &held, uint32_t severity) {
    std::vector<uint32_t> codes;
    const auto r = result_of(held);
    for (uint32_t i = 0; i < r->findings; i++) {
        lensprof_finding finding;
        lensprof_finding_init(&finding);
        assert_ok(lensprof_fields_finding_at(held.get(), i, &finding, nullptr));
        assert_true(finding.text[0] != '\0');
        if (finding.severity == severity) codes.push_back(finding.code);
    }
    return codes;
}

bool has(const std::vector<uint32_t> &codes, uint32_t code) {
    return std::find(codes.begin(), codes.end(), code) != codes.end();
}

void test_shading_and_offset_of_bright_cells(void **) {
    const auto fields = make(16, {});
    const Held held = added(fields, options());
    assert_ok(lensprof_fields_fit(held.get(), nullptr));
    const auto r = result_of(held);
    assert_true(r->usable);
    assert_int_equal(r->used, 16);
    assert_true(error_of(*r) < 0.003);
    const lensprof_fields_channel &channel = r->channel[0];
    assert_true(channel.offset_found);
    assert_true(channel.offset_sigma > 0.0 && channel.offset_sigma < 1e-4);
    assert_true(std::abs(channel.offset - 0.002) < std::max(4.0 * channel.offset_sigma, 2e-5));
    assert_true(channel.shading_error > 0.0 && channel.shading_error < 0.005);
    assert_true(channel.heldout_rms < 0.3 * channel.even_rms);
    assert_close(lensprof_gain_grid_eval(&r->shading, kWidth, kHeight, 0.5 * (kWidth - 1), 0.5 * (kHeight - 1), 0), 1.0,
                 1e-6);
    double best = INFINITY;  // the smoothness chosen is the one that predicts best
    for (uint32_t i = 0; i < r->smoothnesses; i++) {
        lensprof_fields_smoothness tried;
        assert_ok(lensprof_fields_smoothness_at(held.get(), 0, i, &tried, nullptr));
        best = std::min(best, tried.rms);
        if (i == channel.smoothness) assert_close(tried.rms, channel.heldout_rms, 1e-12);
    }
    assert_close(best, channel.heldout_rms, 1e-12);
}

// Levels are those of the background, whatever the scenes contain.
void test_levels(void **) {
    auto fields = make(12, {});
    for (uint16_t &pixel : fields[3].pixels)
        pixel = static_cast<uint16_t>(std::lround(131.07 + 2.0 * (pixel - 131.07)));
    const Held held = added(fields, options());
    assert_ok(lensprof_fields_fit(held.get(), nullptr));
    uint64_t random = 5;
    const double middle = shading(0.5 * (kWidth - 1), 0.5 * (kHeight - 1));
    for (uint32_t i = 0; i < 12; i++) {
        double level = 0.012 * std::exp(0.3 * lp_normal(&random)) * middle * (i == 3 ? 2.0 : 1.0);
        content(Scene::cells, random);
        for (size_t k = 0; k < size_t(kWidth) * kHeight; k++) lp_normal(&random);
        lensprof_fields_image image;
        lensprof_fields_image_init(&image);
        assert_ok(lensprof_fields_image_at(held.get(), i, &image, nullptr));
        assert_true(image.used);
        assert_int_equal(image.same_as, i);
        assert_close(image.level[0] / level, 1.0, 0.01);
    }
}

void test_dark_stains_and_pictures_without_background(void **) {
    assert_true(error_of(*fitted(make(12, {Scene::stains, 0.4, 0.01, 0.002, 0.15}))) < 0.004);
    assert_true(error_of(*fitted(make(40, {Scene::waves, 0.2, 0.0, 0.001, 0.3}))) < 0.03);
}

// The true error over the stated one, of sets of ten pictures: with errors by chance alone, about two of three lie
// below 1, and almost none beyond 3.
void test_stated_errors_hold(void **) {
    const Made kinds[] = {{Scene::cells, 0.012, 0.002, 0.0001, 0.3},
                          {Scene::stains, 0.4, 0.01, 0.002, 0.15},
                          {Scene::waves, 0.2, 0.01, 0.001, 0.3}};
    std::vector<double> ratios;
    for (const Made &made : kinds)
        for (uint64_t seed = 11; seed < 17; seed++) {
            const auto r = fitted(make(10, made, seed));
            ratios.push_back(error_of(*r) / r->channel[0].shading_error);
        }
    std::sort(ratios.begin(), ratios.end());
    const double median = ratios[ratios.size() / 2];
    assert_true(median > 0.4 && median < 1.15);
    assert_true(ratios.back() < 3.0);
}

// Two pictures are two groups, and state an error as well.
void test_few_pictures_state_an_error(void **) {
    const auto r = fitted(make(2, {}), known_offset());
    const double stated = r->channel[0].shading_error;
    assert_true(stated > error_of(*r) / 3.0 && std::isfinite(stated));
}

void test_given_offset(void **) {
    const auto r = fitted(make(6, {}), known_offset());
    assert_false(r->channel[0].offset_found);
    assert_close(r->channel[0].offset, 0.002, 0.0);
    assert_true(error_of(*r) < 0.004);
    lensprof_fields_options below = known_offset(), above = known_offset();
    below.offset[0] = -0.01;
    assert_close(fitted(make(6, {}), below)->channel[0].offset, -0.01, 0.0);
    above.offset[0] = 0.9;  // more than all cells
    assert_true(fitted(make(6, {}), above)->channel[0].offset < 0.5);
}

// Then the next step is to give the offset.
void test_an_error_by_the_offset_is_explained(void **) {
    const Held held = added(make(4, {Scene::cells, 0.012, 0.002, 0.0001, 0.0}), options());
    assert_ok(lensprof_fields_fit(held.get(), nullptr));
    const auto r = result_of(held);
    assert_false(r->channel[0].offset_found);
    assert_true(r->channel[0].shading_error > 0.02);
    lensprof_finding finding;
    lensprof_finding_init(&finding);
    for (uint32_t i = 0; finding.code != LENSPROF_REASON_FIELDS_UNCERTAIN; i++)
        assert_ok(lensprof_fields_finding_at(held.get(), i, &finding, nullptr));
    assert_non_null(std::strstr(finding.text, "give the offset"));
}

// Pictures of one level do not show the offset.
void test_equal_levels_do_not_determine_the_offset(void **) {
    const Held held = added(make(6, {Scene::stains, 0.4, 0.0, 0.002, 0.0}), options());
    assert_ok(lensprof_fields_fit(held.get(), nullptr));
    const auto r = result_of(held);
    assert_true(r->usable);
    if (!r->channel[0].offset_found) {
        assert_true(has(codes_of(held, LENSPROF_SEVERITY_NOTE), LENSPROF_REASON_FIELDS_OFFSET));
        assert_close(r->channel[0].offset, 0.0, 0.0);
    }
    assert_true(error_of(*r) < 0.01);
}

void test_order_and_threads_do_not_change_a_byte(void **) {
    auto fields = make(9, {});
    const auto first = fitted(fields);
    std::reverse(fields.begin() + 1, fields.end());
    lensprof_fields_options o = options();
    o.threads = 3;
    const auto second = fitted(fields, o);
    assert_memory_equal(&first->shading, &second->shading, sizeof first->shading);
    assert_memory_equal(first->channel, second->channel, sizeof first->channel);
}

void test_colour_reduced_and_gamma(void **) {
    const auto grey = make(8, {Scene::stains, 0.4, 0.0, 0.002, 0.2});
    lensprof_response response;
    assert_ok(lensprof_response_set_gamma(&response, 2.2));
    lensprof_fields_options o = options();
    o.channels = 3, o.width = 2 * kWidth, o.height = 2 * kHeight, o.response = &response;
    o.given_offset = 1;
    const Held held = create(o);
    for (const Field &field : grey) {
        std::vector<float> pixels;  // a view of half the frame's size, with a gamma and its own offset per channel
        for (uint16_t value : field.pixels)
            for (double factor : {0.5, 1.0, 0.8})
                pixels.push_back(static_cast<float>(std::pow(factor * value / 65535.0, 1.0 / 2.2)));
        const lensprof_image view = {pixels.data(), kWidth * 12,         kWidth,
                                     kHeight,       LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_RGB};
        assert_ok(lensprof_fields_add(held.get(), &view, nullptr, 0, nullptr));
    }
    assert_ok(lensprof_fields_fit(held.get(), nullptr));
    const auto r = result_of(held);
    assert_int_equal(r->shading.channels, 3);
    for (uint32_t c = 0; c < 3; c++) assert_true(error_of(*r, c) < 0.005);
    auto profile = std::make_unique<lensprof_profile>();
    lensprof_profile_init(profile.get());
    assert_ok(lensprof_fields_profile(held.get(), profile.get(), nullptr));
    assert_ok(lensprof_profile_validate(profile.get()));
    assert_memory_equal(&profile->grid, &r->shading, sizeof profile->grid);
    assert_int_equal(profile->response[0].kind, response.kind);
    assert_string_equal(profile->provenance.method, "fields");
    assert_int_equal(profile->provenance.images, 8);
}

// A mask, and samples that are not finite, leave the rest as it is.
void test_excluded_pixels(void **) {
    const auto fields = make(8, {});
    const Held held = create(known_offset());
    std::vector<uint8_t> mask(size_t(kWidth) * kHeight, 1);
    for (uint32_t v = 20; v < 32; v++) std::fill_n(mask.begin() + ptrdiff_t(v) * kWidth + 30, 16, 0);
    for (const Field &field : fields) {
        std::vector<float> pixels;
        for (size_t i = 0; i < field.pixels.size(); i++)
            pixels.push_back(!mask[i]       ? 100.0f
                             : i % 997 == 0 ? std::numeric_limits<float>::quiet_NaN()
                                            : static_cast<float>(field.pixels[i] / 65535.0));
        const lensprof_image view = {pixels.data(), kWidth * 4,          kWidth,
                                     kHeight,       LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_GREY};
        assert_ok(lensprof_fields_add(held.get(), &view, mask.data(), kWidth, nullptr));
    }
    assert_ok(lensprof_fields_fit(held.get(), nullptr));
    const auto r = result_of(held);
    assert_true(error_of(*r) < 0.006);
    assert_true(r->unseen_share > 0.01 && r->unseen_share < 0.05);
    assert_true(has(codes_of(held, LENSPROF_SEVERITY_WARNING), LENSPROF_REASON_FIELDS_UNSEEN));
}

// The camera saturates far below the type's largest value; what is saturated must not pull.
void test_saturated_at_any_value(void **) {
    auto fields = make(10, {});
    for (Field &field : fields)
        for (uint16_t &pixel : field.pixels) pixel = std::min<uint16_t>(pixel, 1600);
    const Held held = added(fields, known_offset());
    assert_ok(lensprof_fields_fit(held.get(), nullptr));
    const auto r = result_of(held);
    assert_true(r->white_share > 0.01);
    assert_true(has(codes_of(held, LENSPROF_SEVERITY_NOTE), LENSPROF_REASON_FIELDS_WHITE));
    assert_true(error_of(*r) < 0.006);
}

void test_repeated_and_black_pictures_are_left_out(void **) {
    auto fields = make(9, {});
    fields.push_back(fields[2]);
    fields.push_back(fields[0]);
    for (uint16_t &pixel : fields.back().pixels) pixel = 0;
    const Held held = added(fields, known_offset());
    assert_ok(lensprof_fields_fit(held.get(), nullptr));
    const auto r = result_of(held);
    assert_int_equal(r->images, 11);
    assert_int_equal(r->used, 9);
    assert_int_equal(r->repeated, 1);
    assert_int_equal(r->black, 1);
    lensprof_fields_image image;
    lensprof_fields_image_init(&image);
    assert_ok(lensprof_fields_image_at(held.get(), 9, &image, nullptr));
    assert_int_equal(image.same_as, 2);
    assert_true(std::isnan(image.level[0]));
    const auto notes = codes_of(held, LENSPROF_SEVERITY_NOTE);
    assert_true(has(notes, LENSPROF_REASON_FIELDS_REPEATED) && has(notes, LENSPROF_REASON_FIELDS_BLACK));
    fields.resize(9);
    const auto without = fitted(fields, known_offset());
    assert_memory_equal(&without->shading, &r->shading, sizeof r->shading);
}

// A closed shutter among pictures of light.
void test_a_dark_picture_is_left_out(void **) {
    auto fields = make(9, {});
    const auto without = fitted(fields, known_offset());
    fields.push_back(fields[0]);
    uint64_t random = 5;
    const double black = 65535.0 * known_offset().offset[0];
    for (uint16_t &pixel : fields.back().pixels)
        pixel = static_cast<uint16_t>(std::lround(std::fmax(black + 3.0 * lp_normal(&random), 0.0)));
    const auto r = fitted(fields, known_offset());
    assert_int_equal(r->used, 9);
    assert_int_equal(r->black, 1);
    assert_memory_equal(&without->shading, &r->shading, sizeof r->shading);
}

void test_refusals(void **) {
    const auto refused = [](const std::vector<Field> &fields, uint32_t code) {
        const Held held = added(fields, known_offset());
        assert_ok(lensprof_fields_fit(held.get(), nullptr));
        assert_false(result_of(held)->usable);
        assert_true(has(codes_of(held, LENSPROF_SEVERITY_REFUSAL), code));
    };
    const auto fields = make(2, {Scene::waves, 0.2, 0.0, 0.001, 0.3});
    refused({fields[0]}, LENSPROF_REASON_FIELDS_FEW);
    refused(fields, LENSPROF_REASON_FIELDS_FEW);
    refused({fields[0], fields[0], fields[0], fields[0]}, LENSPROF_REASON_FIELDS_FEW);
    std::vector<Field> one_scene(6, fields[0]);  // in other light, with other noise
    uint64_t random = 3;
    for (Field &field : one_scene) {
        const double level = uniform(random, 0.7, 1.3);
        for (uint16_t &pixel : field.pixels)
            pixel = static_cast<uint16_t>(std::clamp(level * pixel + 60.0 * lp_normal(&random), 0.0, 65535.0));
    }
    refused(one_scene, LENSPROF_REASON_FIELDS_PATTERN);
    std::vector<Field> black(4, fields[0]);
    for (Field &field : black) std::fill(field.pixels.begin(), field.pixels.end(), uint16_t(0));
    const Held held = added(black, options());
    assert_int_equal(lensprof_fields_fit(held.get(), nullptr), LENSPROF_ERROR_NO_SAMPLES);
}

// A closed shutter: an offset that drifts a little, noise of reading, and that of the pixels, which all pictures share.
void test_dark_pictures(void **) {
    const auto status_of = [](double light, const lensprof_fields_options &o) {
        std::vector<Field> fields(5);
        uint64_t random = 11;
        std::vector<double> own;
        for (size_t i = 0; i < size_t(kWidth) * kHeight; i++) own.push_back(1.5 * lp_normal(&random));
        for (size_t n = 0; n < fields.size(); n++)
            for (size_t i = 0; i < own.size(); i++) {
                const double lit = light * shading(double(i % kWidth), double(i / kWidth));
                fields[n].pixels.push_back(static_cast<uint16_t>(
                    std::lround(131.0 + 0.3 * double(n) + lit + own[i] + 3.0 * lp_normal(&random))));
            }
        return lensprof_fields_fit(added(fields, o).get(), nullptr);
    };
    assert_int_equal(status_of(0.0, options()), LENSPROF_ERROR_NO_SAMPLES);
    assert_int_equal(status_of(0.0, known_offset()), LENSPROF_ERROR_NO_SAMPLES);
    assert_int_equal(status_of(20.0, options()), LENSPROF_OK);
    assert_int_equal(status_of(20.0, known_offset()), LENSPROF_OK);
    lensprof_fields_options lit = options();  // evenly: with this offset the pictures are far above it
    lit.given_offset = 1;
    assert_int_equal(status_of(0.0, lit), LENSPROF_OK);
}

void test_invalid_arguments(void **) {
    lensprof_fields *made = nullptr;
    lensprof_error error{};
    lensprof_fields_options o = options();
    o.channels = 2;
    assert_int_equal(lensprof_fields_create(&o, &made, &error), LENSPROF_ERROR_ARGUMENT);
    o = options(), o.width = 0;
    assert_int_equal(lensprof_fields_create(&o, &made, &error), LENSPROF_ERROR_SIZE);
    o = options(), o.offset[1] = NAN;
    assert_int_equal(lensprof_fields_create(&o, &made, &error), LENSPROF_ERROR_ARGUMENT);
    o = options(), o.struct_size = 4;
    assert_int_equal(lensprof_fields_create(&o, &made, &error), LENSPROF_ERROR_STRUCT_SIZE);
    assert_int_equal(lensprof_fields_create(nullptr, &made, &error), LENSPROF_ERROR_ARGUMENT);
    assert_null(made);
    const Held held = create(options());
    const auto fields = make(1, {});
    lensprof_image view = fields[0].view();
    view.height -= 3;
    assert_int_equal(lensprof_fields_add(held.get(), &view, nullptr, 0, &error), LENSPROF_ERROR_SIZE);
    assert_non_null(std::strstr(error.text, "image 0"));
    auto result = std::make_unique<lensprof_fields_result>();
    lensprof_fields_result_init(result.get());
    assert_int_equal(lensprof_fields_get(held.get(), result.get(), &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fields_fit(held.get(), &error), LENSPROF_ERROR_NO_SAMPLES);
    lensprof_fields_destroy(nullptr);
}

int cancel(double fraction, void *seen) {
    *static_cast<double *>(seen) = fraction;
    return fraction > 0.1;
}

void test_cancelled(void **) {
    double seen = 0.0;
    lensprof_fields_options o = options();
    o.progress = cancel, o.progress_user = &seen;
    const Held held = added(make(6, {}), o);
    assert_int_equal(lensprof_fields_fit(held.get(), nullptr), LENSPROF_ERROR_CANCELLED);
    assert_true(seen > 0.1 && seen < 0.5);
}

// The force of the content is the slope of its cost.
void test_force_is_the_slope_of_the_cost(void **) {
    std::vector<float> values;
    uint64_t random = 9;
    for (int i = 0; i < 4000; i++)
        values.push_back(static_cast<float>(i % 3 ? 0.05 * lp_normal(&random) : 0.6 + 0.3 * lp_normal(&random)));
    lensprof::Content density;
    density.start(values);
    density.fit(values, 40);
    for (double at = -0.12; at < 1.0; at += 0.03) {
        constexpr double step = 0.004;
        const double slope =
            (density.at(static_cast<float>(at + step)).cost - density.at(static_cast<float>(at - step)).cost)
            / (2.0 * step);
        const auto pull = density.at(static_cast<float>(at));
        assert_close(pull.force, slope, 0.02 * std::abs(slope) + 0.4);
        assert_true(pull.weight > 0.0);
    }
    assert_close(density.narrowest_sigma(), 0.05, 0.02);
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shading_and_offset_of_bright_cells),
        cmocka_unit_test(test_levels),
        cmocka_unit_test(test_dark_stains_and_pictures_without_background),
        cmocka_unit_test(test_stated_errors_hold),
        cmocka_unit_test(test_few_pictures_state_an_error),
        cmocka_unit_test(test_given_offset),
        cmocka_unit_test(test_equal_levels_do_not_determine_the_offset),
        cmocka_unit_test(test_an_error_by_the_offset_is_explained),
        cmocka_unit_test(test_order_and_threads_do_not_change_a_byte),
        cmocka_unit_test(test_colour_reduced_and_gamma),
        cmocka_unit_test(test_excluded_pixels),
        cmocka_unit_test(test_saturated_at_any_value),
        cmocka_unit_test(test_repeated_and_black_pictures_are_left_out),
        cmocka_unit_test(test_a_dark_picture_is_left_out),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_dark_pictures),
        cmocka_unit_test(test_invalid_arguments),
        cmocka_unit_test(test_cancelled),
        cmocka_unit_test(test_force_is_the_slope_of_the_cost),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
