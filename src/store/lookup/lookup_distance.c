/* A focus distance that is not known: the falloff at several, the spread of which is a part of the standard error. */
#include "store/lookup/lookup_distance.h"

#include <math.h>

#define MOST_DISTANCES 8 /* stored focus distances that are tried */

/* Of M in the corner, where a lens is known at one distance only: two thirds of the errors over the usual distances are
 * below this for lenses that are known at several, but asked by their farthest alone (make bench-lookup). */
#define LONE_DISTANCE_SIGMA 0.007

/* Distances, and the share of photographs taken at each. */
typedef struct distances {
    uint32_t count;
    double distance_m[MOST_DISTANCES], share[MOST_DISTANCES];
} distances;

/* Landscapes and buildings, groups, people, portraits, close-ups (docs/database.md). */
static const distances usual = {
    7, {INFINITY, 10.0, 5.0, 3.0, 1.5, 0.7, 0.3}, {0.25, 0.2, 0.19, 0.14, 0.11, 0.08, 0.03}};

/* Those that are stored, from far to near, in equal shares. */
static distances stored_distances(const lp_falloff_nodes *nodes) {
    distances all = {0, {0.0}, {0.0}};
    for (double below = INFINITY; all.count < MOST_DISTANCES; all.count++) {
        double next = 0.0;
        for (uint32_t i = 0; i < nodes->count; i++) {
            const double distance_m = nodes->node[i].distance_m;
            if ((all.count == 0 || distance_m < below) && distance_m > next) next = distance_m;
        }
        if (next <= 0.0) break;
        all.distance_m[all.count] = below = next;
    }
    for (uint32_t d = 0; d < all.count; d++) all.share[d] = 1.0 / all.count;
    return all;
}

static double corner_of(const lp_falloff_prediction *p) {
    double sum = 0.0;
    for (int c = 0; c < 3; c++) sum += (1.0 + p->k[c][0] + p->k[c][1] + p->k[c][2]) / 3.0;
    return sum;
}

/* Predictions at several distances; those that can be made, their shares adding up to 1. */
typedef struct predictions {
    uint32_t count;
    double share[MOST_DISTANCES];
    lp_falloff_prediction prediction[MOST_DISTANCES];
} predictions;

/* -1 without memory. If none can be made, prediction[0] is at the distance of the nearest node. */
static int predict_at(const distances *candidates, const lp_falloff_nodes *nodes, lp_falloff_node target,
                      predictions *made) {
    double shares = 0.0;
    made->count = 0;
    for (uint32_t d = 0; d < candidates->count; d++) {
        lp_falloff_prediction prediction;
        target.distance_m = candidates->distance_m[d];
        const int done = lp_predict_falloff(nodes, &target, &prediction);
        if (done < 0) return -1;
        if (!done && (made->count || d)) continue;
        made->prediction[made->count] = prediction;
        made->share[made->count] = candidates->share[d];
        if (done) shares += candidates->share[d], made->count++;
    }
    for (uint32_t d = 0; d < made->count; d++) made->share[d] /= shares;
    return 1;
}

/* Standard deviation of M in the corner over the predictions, about `corner`. */
static double spread_about(const predictions *made, double corner) {
    double variance = 0.0;
    for (uint32_t d = 0; d < made->count; d++) {
        const double off = corner_of(&made->prediction[d]) - corner;
        variance += made->share[d] * off * off;
    }
    return sqrt(variance);
}

/* Rows, weights and error of the prediction whose corner is nearest to that of its curves. */
static void take_nearest(const predictions *made, lp_falloff_prediction *p) {
    const lp_falloff_prediction curves = *p;
    double nearest = INFINITY;
    for (uint32_t d = 0; d < made->count; d++) {
        const double off = fabs(corner_of(&made->prediction[d]) - corner_of(&curves));
        if (off < nearest) nearest = off, *p = made->prediction[d];
    }
    for (int c = 0; c < 3; c++)
        for (int n = 0; n < 3; n++) p->k[c][n] = curves.k[c][n];
}

/* At every radius the mean of the predictions, or the weakest of them. */
static void join(const predictions *made, int weakest, lp_falloff_prediction *p) {
    double samples[LP_FALLOFF_RADII], joined[LP_FALLOFF_RADII];
    *p = made->prediction[0];
    for (int c = 0; c < 3 && made->count > 1; c++) {
        for (uint32_t d = 0; d < made->count; d++) {
            lp_sample_falloff(made->prediction[d].k[c], samples);
            for (int j = 0; j < LP_FALLOFF_RADII; j++)
                joined[j] = weakest ? (d ? fmax(joined[j], samples[j]) : samples[j])
                                    : (d ? joined[j] : 0.0) + made->share[d] * samples[j];
        }
        lp_fit_falloff(joined, p->k[c]);
    }
    take_nearest(made, p);
}

/* How far the truth is from `p` by the distance alone: the spread over the usual distances, or over those stored where
 * none of the usual ones can be predicted. -1 without memory. */
static int spread_by_distance(const lp_falloff_nodes *nodes, const lp_falloff_node *target, const predictions *made,
                              const lp_falloff_prediction *p, double *sigma) {
    predictions likely;
    if (predict_at(&usual, nodes, *target, &likely) < 0) return -1;
    *sigma = spread_about(likely.count ? &likely : made, corner_of(p));
    return 1;
}

int lp_predict_any_distance(const lp_falloff_nodes *nodes, const lp_falloff_node *target, uint32_t rule,
                            lp_falloff_prediction *prediction, double *sigma) {
    const distances stored = stored_distances(nodes);
    const int is_lone = stored.count == 1;
    distances tried = rule == LENSPROF_DISTANCE_USUAL && !is_lone ? usual : stored;
    predictions made;
    if (rule == LENSPROF_DISTANCE_FARTHEST && tried.count) tried.count = 1;
    if (predict_at(&tried, nodes, *target, &made) < 0) return -1;
    *prediction = made.prediction[0];
    if (!made.count) return 0;
    join(&made, rule == LENSPROF_DISTANCE_WEAKEST, prediction);
    *sigma = LONE_DISTANCE_SIGMA;
    return is_lone ? 1 : spread_by_distance(nodes, target, &made, prediction, sigma);
}
