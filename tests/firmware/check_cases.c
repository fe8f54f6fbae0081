/* check_cases - on the board: every case is within one level of double precision, and rows of sensors have the bytes of
 * the machine that wrote them. */
#include <string.h>

#include <lensprof/sensor.h>

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
    const lensprof_target to = {out, 0, c->width, 1, c->target, c->layout};
    uint32_t worst = 0;
    if (lensprof_fixed_plan_open(c->plan, c->plan_bytes, &plan) != LENSPROF_OK
        || lensprof_fixed_apply(plan, &from, &to, c->x0, c->y0) != LENSPROF_OK)
        return 65536;
    for (uint32_t i = 0; i < c->width * lensprof_layout_samples(c->layout); i++, samples++) {
        const uint32_t is = sample_at(out, c->target, i), wanted = sample_at(c->wanted, c->target, i);
        const uint32_t error = is > wanted ? is - wanted : wanted - is;
        same += !error;
        if (error > worst) worst = error;
    }
    return worst;
}

/* Whether a row of a sensor has the wanted bytes; in place. */
static int is_same(const sensor_row *r) {
    static uint16_t out[512];
    const lensprof_sensor_plan *plan;
    const lensprof_target row = {out, 0, r->width, 1, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY};
    memcpy(out, r->in, 2 * r->width);
    return lensprof_sensor_plan_open(r->plan, r->plan_bytes, &plan) == LENSPROF_OK
           && lensprof_sensor_apply(plan, NULL, &row, r->x0, r->y0) == LENSPROF_OK
           && !memcmp(out, r->wanted, 2 * r->width);
}

int main(void) {
    uint32_t worst = 0, rows = 0;
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
    put_text(" samples the same; ");
    for (uint32_t n = 0; n < sensor_row_count; n++) rows += (uint32_t)is_same(&sensor_rows[n]);
    put_number(rows);
    put_text(" of ");
    put_number(sensor_row_count);
    put_text(" rows of sensors have the same bytes\n");
    return worst > 1 || !case_count || !rows || rows != sensor_row_count;
}
