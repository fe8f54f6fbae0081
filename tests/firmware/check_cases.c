/* check_cases - on the board: every case is within one level of double precision. */
#include <string.h>

#include <lensprof/fixed.h>

#include "board.h"
#include "cases.h"

static void put_number(uint32_t number) {
    char text[11], *p = text + sizeof text;
    *--p = '\0';
    do *--p = (char)('0' + number % 10);
    while (number /= 10);
    put_text(p);
}

static uint32_t sample_at(const void *data, uint32_t sample, uint32_t i) {
    return sample == LENSPROF_SAMPLE_U8 ? ((const uint8_t *)data)[i] : ((const uint16_t *)data)[i];
}

static uint32_t samples, same;

/* The largest difference in a case, in levels; out of range if the case cannot be applied. */
static uint32_t check(const random_case *c) {
    static uint16_t out[512];
    const lensprof_fixed_plan *plan;
    const lensprof_image from = {c->in, 0, c->width, 1, c->sample, c->layout};
    const lensprof_target to = {out, 0, c->width, 1, c->sample, c->layout};
    uint32_t worst = 0;
    if (lensprof_fixed_plan_open(c->plan, c->plan_bytes, &plan) != LENSPROF_OK
        || lensprof_fixed_apply(plan, &from, &to, c->x0, c->y0) != LENSPROF_OK)
        return 65536;
    for (uint32_t i = 0; i < c->width * lensprof_layout_samples(c->layout); i++, samples++) {
        const uint32_t is = sample_at(out, c->sample, i), wanted = sample_at(c->wanted, c->sample, i);
        const uint32_t error = is > wanted ? is - wanted : wanted - is;
        same += !error;
        if (error > worst) worst = error;
    }
    return worst;
}

int main(void) {
    uint32_t worst = 0;
    for (uint32_t n = 0; n < case_count; n++) {
        const uint32_t own = check(&cases[n]);
        if (own > worst) worst = own;
    }
    put_number(case_count);
    put_text(" random profiles: worst ");
    put_number(worst);
    put_text(" level, ");
    put_number(same);
    put_text(" of ");
    put_number(samples);
    put_text(" samples the same\n");
    return worst > 1 || !case_count;
}
