/* make_cases - writes random cases for integer plans as C, for a board without floating point: plans prepared here,
 * pixels, and the expected results in double precision. */
#define PIXELS 40
#include "unit/fixed_cases.h"
#include "unit/sensor_cases.h"

enum {
    CASES = 40,
    WIDE = 6, /* the last ones: 16 bit through curves, and between 8 and 16 bit */
    SENSORS = 40,
    SENSOR_PIXELS = 100
};

static void print_words(const char *kind, int n, const uint32_t *words, size_t count) {
    printf("static const uint32_t %s_%d[] = {", kind, n);
    for (size_t i = 0; i < count; i++) printf("%s0x%08x,", i % 8 ? " " : "\n    ", words[i]);
    printf("};\n");
}

/* Small grids, for small flash. */
static void print_sensor(int n, uint64_t *random) {
    static sensor_case c;
    static uint32_t words[(SENSOR_WIDTH + 1) / 2];
    make_sensor(&c, random);
    c.readout.columns = 6 + sensor_below(3, random), c.readout.rows = 6 + sensor_below(3, random);
    make_sensor_plan(&c);
    const lensprof_image from = {c.in[0], 0, SENSOR_PIXELS, 1, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY};
    const lensprof_target to = {c.out[0], 0, SENSOR_PIXELS, 1, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY};
    assert_ok(lensprof_sensor_apply(c.plan, &from, &to, c.x0, c.y0));
    print_words("sensor_plan", n, c.memory, lensprof_sensor_plan_bytes(&c.readout) / 4);
    memcpy(words, c.in[0], 2 * SENSOR_PIXELS);
    print_words("sensor_in", n, words, SENSOR_PIXELS / 2);
    memcpy(words, c.out[0], 2 * SENSOR_PIXELS);
    print_words("sensor_wanted", n, words, SENSOR_PIXELS / 2);
    printf("#define SENSOR_%d {sensor_plan_%d, sizeof sensor_plan_%d, sensor_in_%d, sensor_wanted_%d, %d, %u, %u}\n", n,
           n, n, n, n, SENSOR_PIXELS, c.x0, c.y0);
}

int main(void) {
    static fixture f;
    uint64_t random = 77;
    printf("/* Written by make_cases. */\n#include \"cases.h\"\n\nconst uint32_t case_count = %d;\n", CASES);
    for (int n = 0; n < CASES; n++) {
        static uint32_t words[ROOM / 4];
        if (n < CASES - WIDE)
            make_case(&f, n % 4 ? LENSPROF_SAMPLE_U8 : LENSPROF_SAMPLE_U16, &random);
        else
            make_wide_case(&f, n % 3 != 2, n % 3 != 1, n % 2, &random);
        print_words("plan", n, f.memory, lensprof_fixed_plan_bytes(&f.m.options) / 4);
        memcpy(words, f.in, sizeof words);
        print_words("in", n, words, (PIXELS * f.bytes + 3) / 4);
        memset(words, 0, sizeof words);
        for (uint32_t i = 0; i < PIXELS * lensprof_layout_samples(f.from.layout); i++)
            if (f.to.sample == LENSPROF_SAMPLE_U8)
                ((uint8_t *)words)[i] = (uint8_t)wanted_at(&f, i);
            else
                ((uint16_t *)words)[i] = (uint16_t)wanted_at(&f, i);
        print_words("wanted", n, words, sizeof words / 4);
        printf("#define CASE_%d {plan_%d, sizeof plan_%d, in_%d, wanted_%d, %u, %u, %u, %u, %u, %u}\n", n, n, n, n, n,
               f.from.sample, f.to.sample, f.from.layout, PIXELS, f.x0, f.y0);
    }
    printf("const random_case cases[] = {");
    for (int n = 0; n < CASES; n++) printf("CASE_%d, ", n);
    printf("};\nconst uint32_t sensor_row_count = %d;\n", SENSORS);
    for (int n = 0; n < SENSORS; n++) print_sensor(n, &random);
    printf("const sensor_row sensor_rows[] = {");
    for (int n = 0; n < SENSORS; n++) printf("SENSOR_%d, ", n);
    printf("};\n");
    return 0;
}
