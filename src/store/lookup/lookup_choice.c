/* Which rows of the lens count, and at which setting they are asked. */
#include "store/lookup/lookup_choice.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define SAME_SENSOR 0.02    /* crop factors that differ by so much are of one sensor: EXIF rounds */
#define CROP_TOLERANCE 0.96 /* a sensor may be larger by so much than the one that was measured */
#define SAME_FOCAL 0.02     /* of a lens that cannot be changed */
#define SAME_FOCAL_MM 0.1

/* A focal length may be off the stored ones by so much of it where the aperture is off, too. Beyond, of settings of
 * Lensfun's lenses that were left out with all on their side, half were within the standard error stated, and a third
 * with apertures wider than the stored ones; within, all seven were (docs/benchmark-results.md). */
#define NEAR_FOCAL 0.06

/* The error of M in the corner, in standard errors of the prediction, that 68 of 100 were below where all rows of a
 * shortest or longest focal length, or of the widest apertures, were left out: lenses of one half of Lensfun's
 * database alike; 1.46 and 1.70 on the other half. Beyond the smallest aperture it is below 1. */
#define FOCAL_WIDENING 1.85
#define APERTURE_WIDENING 2.06

/* A clause for which there is no room is left out as a whole, its name first. */
void lp_add_lookup_reason(lensprof_lookup *lookup, lensprof_reason reason, const char *name) {
    const char *text = lensprof_reason_text(reason);
    const size_t used = strlen(lookup->reason), capacity = sizeof lookup->reason - used;
    const size_t bytes = strlen(text) + (used ? 2 : 0);
    uint32_t index = 0;
    while (index + 1 < LENSPROF_LOOKUP_REASONS && lookup->reason_code[index]) index++;
    lookup->reason_code[index] = reason;
    if (bytes >= capacity) return;
    if (name && bytes + 2 + strlen(name) >= capacity) name = NULL;
    snprintf(lookup->reason + used, capacity, "%s%s%s%s", used ? "; " : "", text, name ? ": " : "", name ? name : "");
}

/* ---- which of them ---- */

static int is_sensor_covered(const lp_candidate *c, const lensprof_profile_key *key) {
    return c->crop == LENSPROF_UNKNOWN || key->crop_factor == LENSPROF_UNKNOWN
           || key->crop_factor / c->crop >= CROP_TOLERANCE;
}

/* Larger is better: unit, camera, then the sensor nearest to the key's; where that is not known, the smallest, whose
 * falloff is the weakest. */
static double rank_of(const lp_candidate *c, const lensprof_profile_key *key) {
    const int has_crop = c->crop != LENSPROF_UNKNOWN, is_requested = key->crop_factor != LENSPROF_UNKNOWN;
    const double sensor = !has_crop      ? 0.5
                          : is_requested ? fmin(c->crop / key->crop_factor, 1.0)
                                         : 1.0 - 1.0 / (1.0 + c->crop);
    return 100.0 * c->of_unit + 10.0 * c->of_camera + sensor;
}

static int has_several_sensors(const lp_candidates *found) {
    double low = INFINITY, high = 0.0;
    for (uint32_t i = 0; i < found->count; i++) {
        const double crop = found->all[i].crop;
        if (crop != LENSPROF_UNKNOWN) low = fmin(low, crop), high = fmax(high, crop);
    }
    return high > low * (1.0 + SAME_SENSOR);
}

/* Of those whose rank is below `below` the best group, to group[]; returns its rank, -INFINITY for none. */
static double take_best(const lp_candidates *found, const lensprof_profile_key *key, double below,
                        lp_candidates *group) {
    double best = -INFINITY;
    group->count = 0;
    for (uint32_t i = 0; i < found->count; i++) {
        const double rank = rank_of(&found->all[i], key);
        if (is_sensor_covered(&found->all[i], key) && rank < below) best = fmax(best, rank);
    }
    for (uint32_t i = 0; i < found->count && best > -INFINITY; i++) {
        const double rank = rank_of(&found->all[i], key);
        if (is_sensor_covered(&found->all[i], key) && rank < below && rank >= best - SAME_SENSOR)
            group->all[group->count++] = found->all[i];
    }
    return best;
}

static bool is_corrected(const lp_candidate *c) { return c->processing == LENSPROF_PROCESSING_CORRECTED; }

/* What a camera has corrected has another falloff: where any processing will do, that of the newest profile, which is
 * the last. */
static void keep_one_falloff(lp_candidates *found) {
    const bool corrected = is_corrected(&found->all[found->count - 1]);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < found->count; i++)
        if (is_corrected(&found->all[i]) == corrected) found->all[kept++] = found->all[i];
    found->count = kept;
}

static double mired_of(double color_temperature_k) { return 1e6 / color_temperature_k; }

/* Shading depends on the light: of the rows that have a colour temperature only those of the nearest one count (in
 * mired, 1e6/K), where the key has one. Returns whether that is the key's. */
static bool keep_nearest_light(lp_candidates *found, const lensprof_profile_key *key) {
    uint32_t kept = 0;
    double nearest = INFINITY;
    if (key->color_temperature_k == LENSPROF_UNKNOWN) return true;
    const double requested = mired_of(key->color_temperature_k);
    for (uint32_t i = 0; i < found->count; i++)
        if (found->all[i].color_temperature_k != LENSPROF_UNKNOWN)
            nearest = fmin(nearest, fabs(mired_of(found->all[i].color_temperature_k) - requested));
    for (uint32_t i = 0; i < found->count; i++) {
        const lp_candidate *c = &found->all[i];
        if (c->color_temperature_k == LENSPROF_UNKNOWN
            || fabs(mired_of(c->color_temperature_k) - requested) <= nearest * (1.0 + 1e-9))
            found->all[kept++] = *c;
    }
    found->count = kept;
    return nearest == INFINITY || nearest <= 1e-6 * requested;
}

double lp_choose_candidates(const lp_candidates *found, const lensprof_profile_key *key, double below,
                            lp_candidates *group, lensprof_lookup *lookup) {
    const double rank = take_best(found, key, below, group);
    if (!group->count) return rank;
    const int is_ambiguous = key->crop_factor == LENSPROF_UNKNOWN && has_several_sensors(found);
    keep_one_falloff(group);
    if (!keep_nearest_light(group, key)) lp_add_lookup_reason(lookup, LENSPROF_REASON_LOOKUP_OTHER_LIGHT, NULL);
    if (is_ambiguous) lp_add_lookup_reason(lookup, LENSPROF_REASON_LOOKUP_SMALLEST_SENSOR, NULL);
    if (group->all[0].of_camera < 0) lp_add_lookup_reason(lookup, LENSPROF_REASON_LOOKUP_ON_OTHER_CAMERA, NULL);
    if (found->by_words)
        lp_add_lookup_reason(lookup, LENSPROF_REASON_LOOKUP_BY_WORDS, found->last.lens);
    else if (found->by_camera)
        lp_add_lookup_reason(lookup, LENSPROF_REASON_LOOKUP_BUILT_IN, found->last.lens);
    return rank - SAME_SENSOR;
}

/* ---- at which setting ---- */

/* Focal length for 0, aperture for 1. */
static double setting(const lp_falloff_node *node, int axis) { return axis ? node->aperture : node->focal_mm; }

static void set(lp_falloff_node *node, int axis, double value) { *(axis ? &node->aperture : &node->focal_mm) = value; }

/* Rows that lack a number which the key has are of no use; one that the key lacks must be the same in all rows. Returns
 * NONE, or what is wrong. */
static lensprof_reason resolve_axis(lp_candidates *found, lp_falloff_node *target, int axis) {
    static const lensprof_reason missing[] = {LENSPROF_REASON_LOOKUP_FOCAL_MISSING,
                                              LENSPROF_REASON_LOOKUP_APERTURE_MISSING};
    static const lensprof_reason useless[] = {LENSPROF_REASON_LOOKUP_NO_FOCAL, LENSPROF_REASON_LOOKUP_NO_APERTURE};
    uint32_t kept = 0;
    if (setting(target, axis) == LENSPROF_UNKNOWN) {
        const double only = setting(&found->all[0].node, axis);
        for (uint32_t i = 1; i < found->count; i++)
            if (!lp_is_same(setting(&found->all[i].node, axis), only)) return missing[axis];
        set(target, axis, only != LENSPROF_UNKNOWN ? only : 1.0); /* where nobody knows it makes no difference */
        for (uint32_t i = 0; i < found->count && only == LENSPROF_UNKNOWN; i++) set(&found->all[i].node, axis, 1.0);
        return LENSPROF_REASON_NONE;
    }
    for (uint32_t i = 0; i < found->count; i++)
        if (setting(&found->all[i].node, axis) != LENSPROF_UNKNOWN) found->all[kept++] = found->all[i];
    found->count = kept;
    return kept ? LENSPROF_REASON_NONE : useless[axis];
}

/* 0 within the stored settings, 1 outside, 2 too far. Nothing is predicted more than one node beyond the last: the
 * outermost two nodes' spacing (in stops or octaves), or a twelfth of an octave in focal length and a third of a stop
 * where there is one node only. */
static int place_of(const lp_candidates *found, const lp_falloff_node *target, int axis) {
    double low = INFINITY, high = -INFINITY, above_low = INFINITY, below_high = -INFINITY;
    const double single = axis ? 1.0 / 6.0 : 1.0 / 12.0; /* log2; of the f-number half a stop counts as 1/4 */
    for (uint32_t i = 0; i < found->count; i++) {
        const double value = log2(setting(&found->all[i].node, axis));
        low = fmin(low, value), high = fmax(high, value);
    }
    for (uint32_t i = 0; i < found->count; i++) {
        const double value = log2(setting(&found->all[i].node, axis));
        if (value > low + 1e-6) above_low = fmin(above_low, value);
        if (value < high - 1e-6) below_high = fmax(below_high, value);
    }
    const double requested = log2(setting(target, axis)), least = 1e-6;
    const double before = high - low > 1e-6 ? fmax(above_low - low, single) : single;
    const double after = high - low > 1e-6 ? fmax(high - below_high, single) : single;
    if (requested < low - before - least || requested > high + after + least) return 2;
    return requested < low - least || requested > high + least;
}

/* Focal length and aperture, where they are not given and the same everywhere. Returns NONE, or why not. */
lensprof_reason lp_resolve_setting(lp_candidates *found, lp_falloff_node *target, lensprof_lookup *lookup) {
    static const lensprof_reason out_of_range[] = {LENSPROF_REASON_LOOKUP_FOCAL_BEYOND,
                                                   LENSPROF_REASON_LOOKUP_APERTURE_BEYOND};
    static const lensprof_reason outside[] = {LENSPROF_REASON_LOOKUP_FOCAL_OUTSIDE,
                                              LENSPROF_REASON_LOOKUP_APERTURE_OUTSIDE};
    for (int axis = 0; axis < 2; axis++) {
        const lensprof_reason wrong = resolve_axis(found, target, axis);
        if (wrong) return wrong;
        const int side = place_of(found, target, axis);
        if (side > 1) return out_of_range[axis];
        if (side > 0) lp_add_lookup_reason(lookup, outside[axis], NULL);
    }
    return LENSPROF_REASON_NONE;
}

/* Of the stored focal lengths for 0, apertures for 1. */
static void range_of(const lp_candidates *found, int axis, double *low, double *high) {
    *low = INFINITY, *high = -INFINITY;
    for (uint32_t i = 0; i < found->count; i++) {
        const double value = setting(&found->all[i].node, axis);
        *low = fmin(*low, value), *high = fmax(*high, value);
    }
}

double lp_widening(const lp_candidates *found, const lp_falloff_node *target) {
    double low[2], high[2], widening = 1.0;
    for (int axis = 0; axis < 2; axis++) range_of(found, axis, &low[axis], &high[axis]);
    if (target->focal_mm < low[0] * (1.0 - 1e-6) || target->focal_mm > high[0] * (1.0 + 1e-6))
        widening = FOCAL_WIDENING;
    if (target->aperture < low[1] * (1.0 - 1e-6)) widening = fmax(widening, APERTURE_WIDENING);
    return widening;
}

/* Of a setting, to two decimals; a point whatever the locale. */
#define NUMBER_BYTES 24
static void spell_number(double value, char text[NUMBER_BYTES]) {
    const long long hundredths = llround(fmin(value, 1e9) * 100.0);
    int length = snprintf(text, NUMBER_BYTES, "%lld.%02d", hundredths / 100, (int)(hundredths % 100));
    while (text[length - 1] == '0') text[--length] = 0;
    if (text[length - 1] == '.') text[--length] = 0;
}

bool lp_is_outside_both(const lp_candidates *found, const lp_falloff_node *target, char *text, size_t bytes) {
    double low[2], high[2];
    for (int axis = 0; axis < 2; axis++) range_of(found, axis, &low[axis], &high[axis]);
    const bool is_shorter = target->focal_mm < low[0] / (1.0 + NEAR_FOCAL);
    if (!is_shorter && target->focal_mm <= high[0] * (1.0 + NEAR_FOCAL)) return false;
    if (target->aperture >= low[1] * (1.0 - 1e-6) && target->aperture <= high[1] * (1.0 + 1e-6)) return false;
    char word[6][NUMBER_BYTES];
    const double values[6] = {target->focal_mm, target->aperture, low[0], high[0], low[1], high[1]};
    for (int i = 0; i < 6; i++) spell_number(values[i], word[i]);
    snprintf(text, bytes,
             "focal length %s mm and aperture f/%s are both outside those at which this lens is known: %s to %s mm,"
             " f/%s to f/%s",
             word[0], word[1], word[2], word[3], word[4], word[5]);
    return true;
}

/* Cameras with a fixed lens round its focal length as they like (4.25, 4.2, 4.3 mm): one that differs by no more than
 * that is the stored one. */
void lp_round_focal(const lp_candidates *found, lp_falloff_node *target, lensprof_lookup *lookup) {
    double nearest = LENSPROF_UNKNOWN, off = fmax(SAME_FOCAL * target->focal_mm, SAME_FOCAL_MM);
    for (uint32_t i = 0; i < found->count && target->focal_mm != LENSPROF_UNKNOWN; i++) {
        const lp_candidate *c = &found->all[i];
        const double d = fabs(c->node.focal_mm - target->focal_mm);
        if (c->is_fixed && c->node.focal_mm != LENSPROF_UNKNOWN && d <= off + 1e-9 && (d < off || nearest < 0.0))
            off = d, nearest = c->node.focal_mm;
    }
    if (nearest < 0.0 || lp_is_same(nearest, target->focal_mm)) return;
    target->focal_mm = nearest;
    lp_add_lookup_reason(lookup, LENSPROF_REASON_LOOKUP_FOCAL_ROUNDED, NULL);
}

/* The newest row that is at the setting and has the pictures' response, or -1. */
int64_t lp_find_exact(const lp_candidates *found, const lp_falloff_node *target, const lensprof_profile_key *key) {
    int64_t newest = -1;
    for (uint32_t i = 0; i < found->count; i++) {
        const lp_candidate *c = &found->all[i];
        const int same_sensor = c->crop == LENSPROF_UNKNOWN || key->crop_factor == LENSPROF_UNKNOWN
                                || fabs(c->crop / key->crop_factor - 1.0) <= SAME_SENSOR;
        if (same_sensor && c->has_own_response && lp_is_same(c->node.focal_mm, target->focal_mm)
            && lp_is_same(c->node.aperture, target->aperture) && lp_is_same(c->node.distance_m, target->distance_m)
            && c->node.id > newest)
            newest = c->node.id;
    }
    return newest;
}
