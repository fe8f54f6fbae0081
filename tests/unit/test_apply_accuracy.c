/* Apply against a reference in double precision, over random profiles: 8 bit within a level and nearly always the same,
 * 16 bit within a level, float within four units in the last place where both sides are linear. */
#include "support.h"

#include <lensprof/apply.h>

enum { PROFILES = 400, W = 4000, H = 3000, PIXELS = 900 };

typedef struct model {
    lensprof_response response[3];
    lensprof_vignetting vignetting[3];
    lensprof_gain_grid grid;
    lensprof_apply_options options;
} model;

static void random_response(lensprof_response *r, uint64_t *random)
{
    uint32_t kind = (uint32_t)(4 * lp_random(random));
    double emor[4], sizes[4] = {1.0, 0.5, 0.3, 0.1}, table[40] = {0.0};
    lensprof_response_set_linear(r);
    if (kind == 1) assert_ok(lensprof_response_set_gamma(r, 1.0 + 1.6 * lp_random(random)));
    if (kind == 2)
        do
            for (int i = 0; i < 4; i++) emor[i] = sizes[i] * (2.0 * lp_random(random) - 1.0);
        while (lensprof_response_set_emor(r, emor, 4) != LENSPROF_OK);
    if (kind < 3) return;
    for (int i = 1; i < 40; i++) table[i] = table[i - 1] + 0.2 + lp_random(random);
    for (int i = 0; i < 40; i++) table[i] /= table[39];
    assert_ok(lensprof_response_set_table(r, table, 40));
}

/* Falloffs of real lenses: between .25 and 1.1 anywhere in the frame. */
static void random_falloff(lensprof_vignetting *v, const double center[2], uint64_t *random)
{
    int good = 0;
    while (!good) {
        for (int n = 0; n < 3; n++) v->k[n] = 1.2 * lp_random(random) - 0.8;
        v->center[0] = center[0], v->center[1] = center[1];
        good = 1;
        for (double r = 0.0; r <= 1.2; r += 0.02) {
            double m = lensprof_vignetting_eval(v, r * r, NULL);
            good = good && m > 0.25 && m < 1.1;
        }
    }
}

static void random_model(model *m, uint64_t *random)
{
    memset(m, 0, sizeof *m);
    lensprof_apply_options *o = &m->options;
    lensprof_apply_options_init(o);
    const double center[2] = {0.1 * (lp_random(random) - 0.5), 0.1 * (lp_random(random) - 0.5)};
    o->responses = lp_random(random) < 0.5 ? 1 : 3;
    o->vignettings = lp_random(random) < 0.5 ? 1 : 3;
    for (int c = 0; c < 3; c++) {
        random_response(&m->response[c], random);
        random_falloff(&m->vignetting[c], center, random);
    }
    o->response = m->response, o->vignetting = m->vignetting;
    o->frame_width = W, o->frame_height = H;
    o->direction = lp_random(random) < 0.3;
    o->saturated = LENSPROF_SATURATED_AS_VALUE;
    o->source.ev = 2.0 * lp_random(random) - 1.0;
    for (int c = 0; c < 3; c += 2) o->source.white_balance[c] = 0.7 + 0.6 * lp_random(random);
    if (lp_random(random) < 0.3) o->strength = lp_random(random);
    if (lp_random(random) < 0.3) o->gain_cap = 1.0 + 2.0 * lp_random(random);
    if (lp_random(random) < 0.3) {
        m->grid.columns = 2 + (uint32_t)(31 * lp_random(random));
        m->grid.rows = 2 + (uint32_t)(31 * lp_random(random));
        m->grid.channels = lp_random(random) < 0.5 ? 1 : 3;
        for (uint32_t i = 0; i < m->grid.columns * m->grid.rows * m->grid.channels; i++)
            m->grid.attenuation[i] = (float)(0.8 + 0.4 * lp_random(random));
        o->grid = &m->grid;
    }
}

/* The formula of apply.h for a value of a channel at a pixel. */
static double reference(const model *m, double value, uint32_t c, uint32_t x, uint32_t y)
{
    const lensprof_apply_options *o = &m->options;
    const lensprof_response *r = &m->response[o->responses == 3 ? c : 0];
    const lensprof_vignetting *v = &m->vignetting[o->vignettings == 3 ? c : 0];
    double falloff = lensprof_vignetting_eval(v, lensprof_vignetting_r2(v, W, H, x, y, NULL), NULL);
    if (o->grid) falloff *= lensprof_gain_grid_eval(o->grid, W, H, x, y, c);
    falloff = 1.0 + o->strength * (falloff - 1.0);
    if (o->gain_cap > 0.0) falloff = fmax(falloff, 1.0 / o->gain_cap);
    double ratio = lensprof_exposure_factor(&o->target, c) / lensprof_exposure_factor(&o->source, c);
    double light = o->input == LENSPROF_ENCODING_LINEAR ? value : lensprof_response_invert(r, value, NULL);
    light *= o->direction == LENSPROF_DIRECTION_CORRECT ? ratio / falloff : falloff / ratio;
    return o->output == LENSPROF_ENCODING_LINEAR ? light : lensprof_response_eval(r, light, NULL);
}

/* How far the result is from the reference for pixels of a few rows: the worst, and the share that is the same. */
static double worst_error(const model *m, uint32_t sample, uint64_t *random, double *same)
{
    static union { uint8_t u8[3 * PIXELS]; uint16_t u16[3 * PIXELS]; float f32[3 * PIXELS]; } in, out;
    const double unit = sample == LENSPROF_SAMPLE_U8 ? 255.0 : sample == LENSPROF_SAMPLE_U16 ? 65535.0 : 1.0;
    const lensprof_plan *plan;
    double worst = 0.0;
    void *memory = malloc(lensprof_plan_bytes(&m->options));
    assert_ok(lensprof_plan_init(memory, lensprof_plan_bytes(&m->options), &m->options, &plan));
    for (uint32_t i = 0; i < 3 * PIXELS; i++) {
        double value = lp_random(random);
        if (sample == LENSPROF_SAMPLE_U8) in.u8[i] = (uint8_t)(256.0 * value);
        else if (sample == LENSPROF_SAMPLE_U16) in.u16[i] = (uint16_t)(65536.0 * value);
        else in.f32[i] = (float)value;
    }
    const uint32_t x0 = (uint32_t)((W - PIXELS) * lp_random(random)), y = (uint32_t)(H * lp_random(random));
    lensprof_image from = {&in, 0, PIXELS, 1, sample, LENSPROF_LAYOUT_RGB}, to = from;
    to.data = &out;
    assert_ok(lensprof_apply(plan, &from, &to, x0, y));
    for (uint32_t i = 0; i < 3 * PIXELS; i++) {
        double value = sample == LENSPROF_SAMPLE_U8 ? in.u8[i] : sample == LENSPROF_SAMPLE_U16 ? in.u16[i] : (double)in.f32[i];
        double wanted = reference(m, value / unit, i % 3, x0 + i / 3, y), error;
        if (sample == LENSPROF_SAMPLE_F32) {
            float nearest = (float)wanted;
            error = fabs((double)out.f32[i] - wanted) / ((double)nextafterf(nearest, 1e30f) - (double)nearest);
        } else {
            wanted = floor(unit * fmin(fmax(wanted, 0.0), 1.0) + 0.5);
            error = fabs((sample == LENSPROF_SAMPLE_U8 ? out.u8[i] : out.u16[i]) - wanted);
        }
        *same += error == 0.0;
        worst = fmax(worst, error);
    }
    free(memory);
    return worst;
}

static void check_levels(uint32_t sample, double smallest_share)
{
    uint64_t random = 17;
    double same = 0.0, worst = 0.0;
    for (int n = 0; n < PROFILES; n++) {
        model m;
        random_model(&m, &random);
        m.options.source_sample = m.options.target_sample = sample;
        m.options.input = lp_random(&random) < 0.3;
        m.options.output = lp_random(&random) < 0.3;
        worst = fmax(worst, worst_error(&m, sample, &random, &same));
    }
    same /= 3.0 * PIXELS * PROFILES;
    print_message("worst %.0f level, %.4f %% the same\n", worst, 100.0 * same);
    assert_true(worst <= 1.0);
    assert_true(same >= smallest_share);
}

static void test_8_bit(void **state)
{
    (void)state;
    check_levels(LENSPROF_SAMPLE_U8, 0.999);
}

static void test_16_bit(void **state)
{
    (void)state;
    check_levels(LENSPROF_SAMPLE_U16, 0.95);
}

static void test_linear_float(void **state)
{
    (void)state;
    uint64_t random = 29;
    double same = 0.0, worst = 0.0;
    for (int n = 0; n < PROFILES; n++) {
        model m;
        random_model(&m, &random);
        m.options.source_sample = m.options.target_sample = LENSPROF_SAMPLE_F32;
        m.options.input = m.options.output = LENSPROF_ENCODING_LINEAR;
        worst = fmax(worst, worst_error(&m, LENSPROF_SAMPLE_F32, &random, &same));
    }
    print_message("worst %.2f units in the last place\n", worst);
    assert_true(worst <= 4.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_8_bit),
        cmocka_unit_test(test_16_bit),
        cmocka_unit_test(test_linear_float),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
