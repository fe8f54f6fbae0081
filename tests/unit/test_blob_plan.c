/* Plans made from a blob equal plans made from the profile unpacked from it. */
#include "blob_support.h"
#include "core/image.h"

enum {
    W = 41,
    H = 29
};

typedef struct pictures {
    uint8_t source[3][W * H * 4 * 4], target[3][W * H * 4 * 4];
} pictures;

static void fill(pictures *p, uint32_t sample, uint64_t *random) {
    for (int plane = 0; plane < 3; plane++)
        for (size_t i = 0; i < W * H * 4; i++) {
            const float value = (float)(1.2 * lp_random(random) - 0.1);
            if (sample == LENSPROF_SAMPLE_F32)
                memcpy(p->source[plane] + 4 * i, &value, 4);
            else
                for (int b = 0; b < 4; b++) p->source[plane][4 * i + (size_t)b] = (uint8_t)(256 * lp_random(random));
            if (sample == LENSPROF_SAMPLE_F16) p->source[plane][4 * i + 1] &= 0x3f, p->source[plane][4 * i + 3] &= 0x3f;
        }
    memset(p->target, 0, sizeof p->target);
}

static lensprof_target view(uint8_t *data, uint32_t sample, uint32_t layout) {
    if (layout == LENSPROF_LAYOUT_PLANAR) layout = LENSPROF_LAYOUT_GREY;
    const ptrdiff_t row = (ptrdiff_t)(W * lensprof_layout_samples(layout) * lensprof_sample_type_bytes(sample));
    return (lensprof_target){data, row, W, H, sample, layout};
}

static void run(const lensprof_plan *plan, const lensprof_apply_options *o, pictures *p) {
    lensprof_image source[3];
    lensprof_target target[3];
    for (int i = 0; i < 3; i++) {
        const lensprof_target read = view(p->source[i], o->source_sample, o->source_layout);
        source[i] = lp_image_of(&read);
        target[i] = view(p->target[i], o->target_sample, o->source_layout);
    }
    if (o->source_layout == LENSPROF_LAYOUT_PLANAR)
        assert_ok(lensprof_apply_planar(plan, source, target, 0, 0));
    else
        assert_ok(lensprof_apply(plan, source, target, 0, 0));
}

static const lensprof_plan *make_plan(const lensprof_apply_options *o, void **memory) {
    const size_t bytes = lensprof_plan_bytes(o);
    const lensprof_plan *plan = NULL;
    assert_true(bytes > 0);
    *memory = malloc(bytes);
    assert_ok(lensprof_plan_init(*memory, bytes, o, &plan, NULL));
    return plan;
}

static lensprof_apply_options random_options(uint64_t *random) {
    lensprof_apply_options o;
    lensprof_apply_options_init(&o);
    o.direction = (uint32_t)(2 * lp_random(random));
    o.input = (uint32_t)(1.3 * lp_random(random));
    o.output = (uint32_t)(1.3 * lp_random(random));
    o.frame_width = W, o.frame_height = H;
    o.source_sample = (uint32_t)(4 * lp_random(random));
    o.target_sample = (uint32_t)(4 * lp_random(random));
    o.source_layout = (uint32_t)(11 * lp_random(random));
    o.saturated = (uint32_t)(2 * lp_random(random));
    o.dither = (uint32_t)(2 * lp_random(random));
    o.strength = lp_random(random) < 0.5 ? 1.0 : lp_random(random);
    o.gain_cap = lp_random(random) < 0.5 ? 0.0 : 1.0 + lp_random(random);
    o.source.ev = lp_random(random), o.target.ev = lp_random(random);
    o.target.white_balance[0] = 0.8 + 0.4 * lp_random(random);
    return o;
}

static void use_profile(lensprof_apply_options *o, const lensprof_profile *p) {
    o->blob = NULL, o->blob_bytes = 0;
    o->response = p->response, o->responses = p->responses;
    o->vignetting = p->vignetting, o->vignettings = p->vignettings;
    o->grid = &p->grid;
}

static void test_same_bytes_as_from_the_profile(void **state) {
    (void)state;
    uint64_t random = 5;
    lensprof_profile *p = malloc(sizeof *p), *unpacked = malloc(sizeof *unpacked);
    pictures *a = malloc(sizeof *a), *b = malloc(sizeof *b);
    lensprof_profile_init(unpacked);
    for (int n = 0; n < 1500; n++) {
        void *memory[2];
        size_t bytes;
        random_profile(p, &random);
        lensprof_apply_options o = random_options(&random);
        uint8_t *packed = pack(p, n % 2, &bytes), *blob = malloc(bytes + 8);
        const size_t shift = (size_t)(n % 8);
        memcpy(blob + shift, packed, bytes);
        assert_ok(lensprof_profile_unpack(packed, bytes, unpacked));
        o.blob = blob + shift, o.blob_bytes = bytes;
        const size_t needed = lensprof_plan_bytes(&o);
        const lensprof_plan *from_blob = make_plan(&o, &memory[0]);
        memset(blob, 0xFF, bytes + 8); /* the plan does not read it again */
        use_profile(&o, unpacked);
        assert_int_equal(needed, lensprof_plan_bytes(&o));
        const lensprof_plan *from_profile = make_plan(&o, &memory[1]);
        fill(a, o.source_sample, &random);
        *b = *a;
        run(from_blob, &o, a);
        run(from_profile, &o, b);
        assert_memory_equal(a->target, b->target, sizeof a->target);
        free(memory[0]), free(memory[1]), free(packed), free(blob);
    }
    free(p), free(unpacked), free(a), free(b);
}

/* Storing the samples in single precision does not show in 8 bit: the codes equal those of the profile itself, or
 * differ by one near a rounding boundary. */
static void test_close_to_the_profile_itself(void **state) {
    (void)state;
    uint64_t random = 9;
    lensprof_profile *p = malloc(sizeof *p);
    pictures *a = malloc(sizeof *a), *b = malloc(sizeof *b);
    uint32_t others = 0, codes = 0;
    for (int n = 0; n < 200; n++) {
        void *memory[2];
        size_t bytes;
        random_profile(p, &random);
        lensprof_apply_options o = random_options(&random);
        o.source_sample = o.target_sample = LENSPROF_SAMPLE_U8;
        o.source_layout = LENSPROF_LAYOUT_RGB;
        uint8_t *blob = pack(p, 0, &bytes);
        o.blob = blob, o.blob_bytes = bytes;
        const lensprof_plan *from_blob = make_plan(&o, &memory[0]);
        use_profile(&o, p);
        const lensprof_plan *from_profile = make_plan(&o, &memory[1]);
        fill(a, o.source_sample, &random);
        *b = *a;
        run(from_blob, &o, a);
        run(from_profile, &o, b);
        for (size_t i = 0; i < W * H * 3; i++) {
            const int difference = abs(a->target[0][i] - b->target[0][i]);
            assert_true(difference <= 1);
            others += difference != 0, codes++;
        }
        free(memory[0]), free(memory[1]), free(blob);
    }
    assert_true(others * 10000.0 < codes);
    free(p), free(a), free(b);
}

static void test_plan_refuses(void **state) {
    (void)state;
    uint64_t random = 2;
    lensprof_profile *p = malloc(sizeof *p);
    lensprof_profile_init(p);
    random_grid(&p->grid, &random);
    size_t bytes;
    uint8_t *blob = pack(p, 0, &bytes);
    lensprof_apply_options good, o;
    lensprof_apply_options_init(&good);
    good.frame_width = W, good.frame_height = H;
    good.blob = blob, good.blob_bytes = bytes;
    const size_t needed = lensprof_plan_bytes(&good);
    uint8_t *memory = malloc(needed);
    const lensprof_plan *plan = NULL;
    memset(memory, 0xAA, needed);
#define REFUSED(change, status)                                                          \
    do {                                                                                 \
        o = good;                                                                        \
        change;                                                                          \
        assert_int_equal(lensprof_plan_init(memory, needed, &o, &plan, NULL), status);   \
        if (status != LENSPROF_ERROR_SIZE) assert_int_equal(lensprof_plan_bytes(&o), 0); \
    } while (0)
    REFUSED(o.response = p->response, LENSPROF_ERROR_ARGUMENT);
    REFUSED(o.vignetting = p->vignetting, LENSPROF_ERROR_ARGUMENT);
    REFUSED(o.grid = &p->grid, LENSPROF_ERROR_ARGUMENT);
    REFUSED(o.blob = NULL, LENSPROF_ERROR_ARGUMENT);
    REFUSED(o.blob_bytes = 0, LENSPROF_ERROR_CORRUPT);
    REFUSED(o.blob_bytes--, LENSPROF_ERROR_CORRUPT);
    REFUSED(o.frame_width = 0, LENSPROF_ERROR_SIZE);
    for (size_t bit = 0; bit < 8 * bytes; bit++) {
        blob[bit / 8] ^= (uint8_t)(1 << bit % 8);
        REFUSED((void)0, LENSPROF_ERROR_CORRUPT);
        blob[bit / 8] ^= (uint8_t)(1 << bit % 8);
    }
    blob[4] = 5;
    seal(blob, bytes);
    REFUSED((void)0, LENSPROF_ERROR_LAYOUT);
    blob[4] = 1;
    seal(blob, bytes);
#undef REFUSED
    assert_int_equal(lensprof_plan_init(memory, needed - 1, &good, &plan, NULL), LENSPROF_ERROR_CAPACITY);
    for (size_t i = 0; i < needed; i++) assert_int_equal(memory[i], 0xAA);
    assert_null(plan);
    good.responses = good.vignettings = 77; /* the count comes from the blob */
    assert_ok(lensprof_plan_init(memory, needed, &good, &plan, NULL));
    free(memory), free(blob), free(p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_same_bytes_as_from_the_profile),
        cmocka_unit_test(test_close_to_the_profile_itself),
        cmocka_unit_test(test_plan_refuses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
