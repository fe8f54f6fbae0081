#include "store/lookup/falloff_prediction.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TREND 0.4        /* the mean falloff wide open is 1 - 0.4 r^2 */
#define ANY_LEVEL 100.0  /* variance of the level of all curves of a lens: ordinary kriging */
#define OWN_NOISE 1e-4   /* variance of a node about the smooth truth, in units of the process's */
#define PRIOR_SIGMA 0.15 /* of the process, with the weight of PRIOR_NODES nodes */
#define PRIOR_NODES 4.0
#define SPARE 0.02 /* of M, beyond what neighbours span */

typedef struct point {
    double x, t, z, d; /* d: distance from the setting asked for */
    uint32_t node;
} point;

static double distance(const point *a, const point *b) {
    return sqrt((a->x - b->x) * (a->x - b->x) + (a->t - b->t) * (a->t - b->t) + (a->z - b->z) * (a->z - b->z));
}

static double covariance(const point *a, const point *b) {
    const double d = distance(a, b);
    return (1.0 + d) * exp(-d) + ANY_LEVEL;
}

/* The smallest f-number at this focal length or a longer one; beyond the longest that is known, at that. */
static double widest_at(const lp_falloff_node *nodes, uint32_t count, const lp_falloff_node *at, double focal_mm) {
    double longest = 0.0;
    for (uint32_t i = 0; i < count; i++) longest = fmax(longest, nodes[i].focal_mm);
    const double from = 0.999 * fmin(focal_mm, longest);
    double widest = at->focal_mm >= from ? at->aperture : INFINITY;
    for (uint32_t i = 0; i < count; i++)
        if (nodes[i].focal_mm >= from && nodes[i].aperture < widest) widest = nodes[i].aperture;
    return widest;
}

static point point_of(const lp_falloff_node *node, double widest) {
    point p;
    p.x = 0.5 * log2(node->focal_mm);
    p.t = widest / node->aperture;
    p.z = fmin(0.2 / node->distance_m, 6.0);
    p.d = 0.0;
    p.node = 0;
    return p;
}

static int is_nearer(const void *a, const void *b) {
    const point *p = a, *q = b;
    if (p->d != q->d) return p->d < q->d ? -1 : 1;
    return p->node < q->node ? -1 : p->node > q->node; /* one order, whatever the library's sort does */
}

/* `other` says the same as `node` and is focused at least as far away. */
static int repeats(const lp_falloff_node *other, const lp_falloff_node *node) {
    return other->focal_mm == node->focal_mm && other->aperture == node->aperture
           && !memcmp(other->k, node->k, sizeof node->k) && other->distance_m >= node->distance_m;
}

uint32_t lp_drop_repeated(lp_falloff_node *nodes, uint32_t count) {
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        int is_repeated = 0;
        for (uint32_t j = 0; j < kept; j++) is_repeated |= repeats(&nodes[j], &nodes[i]);
        for (uint32_t j = i + 1; j < count && !is_repeated; j++) is_repeated = repeats(&nodes[j], &nodes[i]);
        if (!is_repeated) nodes[kept++] = nodes[i];
    }
    return kept;
}

/* The nearest nodes, nearest first, to points[count]; returns how many are used. */
static uint32_t find_neighbours(const lp_falloff_node *nodes, uint32_t count, const lp_falloff_node *at,
                                const point *here, point *points) {
    double focal_mm = -1.0, widest = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        if (nodes[i].focal_mm != focal_mm) widest = widest_at(nodes, count, at, focal_mm = nodes[i].focal_mm);
        points[i] = point_of(&nodes[i], widest);
        points[i].d = distance(&points[i], here);
        points[i].node = i;
    }
    qsort(points, count, sizeof *points, is_nearer);
    return count < LP_NEIGHBOURS ? count : LP_NEIGHBOURS;
}

/* Cholesky factor of a, in its lower half. The matrix is positive definite by OWN_NOISE. */
static void factorise(double a[LP_NEIGHBOURS][LP_NEIGHBOURS], uint32_t n) {
    for (uint32_t j = 0; j < n; j++)
        for (uint32_t i = j; i < n; i++) {
            double sum = a[i][j];
            for (uint32_t m = 0; m < j; m++) sum -= a[i][m] * a[j][m];
            a[i][j] = i == j ? sqrt(sum) : sum / a[j][j];
        }
}

static void solve(double a[LP_NEIGHBOURS][LP_NEIGHBOURS], uint32_t n, double *x) {
    for (uint32_t i = 0; i < n; i++) {
        for (uint32_t m = 0; m < i; m++) x[i] -= a[i][m] * x[m];
        x[i] /= a[i][i];
    }
    for (uint32_t i = n; i-- > 0;) {
        for (uint32_t m = i + 1; m < n; m++) x[i] -= a[m][i] * x[m];
        x[i] /= a[i][i];
    }
}

void lp_sample_falloff(const double k[3], double *values) {
    for (int i = 0; i < LP_FALLOFF_RADII; i++) {
        const double r = (double)i / (LP_FALLOFF_RADII - 1), s = r * r;
        values[i] = 1.0 + s * (k[0] + s * (k[1] + s * k[2]));
    }
}

void lp_fit_falloff(const double *values, double k[3]) {
    double a[LP_NEIGHBOURS][LP_NEIGHBOURS] = {{0.0}};
    k[0] = k[1] = k[2] = 0.0;
    for (int i = 1; i < LP_FALLOFF_RADII; i++) {
        const double r = (double)i / (LP_FALLOFF_RADII - 1), s = r * r, basis[3] = {s, s * s, s * s * s};
        for (int p = 0; p < 3; p++) {
            for (int q = 0; q <= p; q++) a[p][q] += r * basis[p] * basis[q];
            k[p] += r * basis[p] * (values[i] - 1.0);
        }
    }
    factorise(a, 3);
    solve(a, 3, k);
}

/* Keeps a curve near those of the neighbours. */
static void restrain(const lp_falloff_node *nodes, const point *points, uint32_t used, int curve, double k[3]) {
    double low[LP_FALLOFF_RADII], high[LP_FALLOFF_RADII], values[LP_FALLOFF_RADII], own[LP_FALLOFF_RADII];
    int changed = 0;
    for (uint32_t i = 0; i < used; i++) {
        lp_sample_falloff(nodes[points[i].node].k[curve], own);
        for (int j = 0; j < LP_FALLOFF_RADII; j++) {
            if (!i || own[j] < low[j]) low[j] = own[j];
            if (!i || own[j] > high[j]) high[j] = own[j];
        }
    }
    lp_sample_falloff(k, values);
    for (int j = 0; j < LP_FALLOFF_RADII; j++) {
        const double spare = 0.5 * (high[j] - low[j]) + SPARE;
        const double inside = fmax(fmin(values[j], high[j] + spare), fmax(low[j] - spare, 0.5 * low[j]));
        if (inside != values[j]) values[j] = inside, changed = 1;
    }
    if (changed) lp_fit_falloff(values, k);
}

/* The neighbours' mean and their weighted differences from it, trends taken out first and put back here. */
static void combine(const lp_falloff_node *nodes, const point *points, uint32_t used, const point *here,
                    const double *weight, double k[3][3]) {
    for (int c = 0; c < 3; c++) {
        for (int n = 0; n < 3; n++) {
            double mean = 0.0, sum = 0.0;
            for (int pass = 0; pass < 2; pass++)
                for (uint32_t i = 0; i < used; i++) {
                    const double y = nodes[points[i].node].k[c][n] + (n ? 0.0 : TREND * points[i].t * points[i].t);
                    if (pass)
                        sum += weight[i] * (y - mean);
                    else
                        mean += y / used;
                }
            k[c][n] = mean + sum - (n ? 0.0 : TREND * here->t * here->t);
        }
        restrain(nodes, points, used, c, k[c]);
    }
}

/* Range of the neighbours' corners, beyond which a prediction does not go (restrain). */
static double corner_span(const lp_falloff_node *nodes, const point *points, uint32_t used) {
    double low = INFINITY, high = -INFINITY;
    for (uint32_t i = 0; i < used; i++)
        for (int c = 0; c < 3; c++) {
            const double *k = nodes[points[i].node].k[c];
            low = fmin(low, k[0] + k[1] + k[2]), high = fmax(high, k[0] + k[1] + k[2]);
        }
    return high - low;
}

/* Variance of the process by what the neighbours' corners show. */
static double process_variance(const lp_falloff_node *nodes, const point *points, uint32_t used,
                               double a[LP_NEIGHBOURS][LP_NEIGHBOURS]) {
    double y[LP_NEIGHBOURS], x[LP_NEIGHBOURS], mean = 0.0, q = 0.0;
    for (uint32_t i = 0; i < used; i++) {
        const lp_falloff_node *node = &nodes[points[i].node];
        y[i] = TREND * points[i].t * points[i].t;
        for (int c = 0; c < 3; c++) y[i] += (node->k[c][0] + node->k[c][1] + node->k[c][2]) / 3.0;
        mean += y[i] / used;
    }
    for (uint32_t i = 0; i < used; i++) x[i] = y[i] -= mean;
    solve(a, used, x);
    for (uint32_t i = 0; i < used; i++) q += x[i] * y[i];
    return (PRIOR_NODES * PRIOR_SIGMA * PRIOR_SIGMA + q) / (PRIOR_NODES + used - 1.0);
}

int lp_predict_falloff(const lp_falloff_node *nodes, uint32_t count, const lp_falloff_node *at,
                       lp_falloff_prediction *prediction) {
    memset(prediction, 0, sizeof *prediction);
    prediction->nearest = INFINITY;
    point *points = malloc(count * sizeof *points);
    if (!points) return -1;
    const point here = point_of(at, widest_at(nodes, count, at, at->focal_mm));
    const uint32_t used = find_neighbours(nodes, count, at, &here, points);
    prediction->nearest = points[0].d;
    if (points[0].d > LP_FALLOFF_REACH) {
        free(points);
        return 0;
    }
    double a[LP_NEIGHBOURS][LP_NEIGHBOURS], weight[LP_NEIGHBOURS], b[LP_NEIGHBOURS], explained = 0.0;
    for (uint32_t i = 0; i < used; i++) {
        for (uint32_t j = 0; j <= i; j++) a[i][j] = covariance(&points[i], &points[j]);
        a[i][i] += OWN_NOISE + nodes[points[i].node].variance / (PRIOR_SIGMA * PRIOR_SIGMA);
        weight[i] = b[i] = covariance(&points[i], &here);
    }
    factorise(a, used);
    solve(a, used, weight);
    for (uint32_t i = 0; i < used; i++) {
        explained += weight[i] * b[i];
        prediction->row[i].node = points[i].node;
        prediction->row[i].weight = weight[i];
    }
    combine(nodes, points, used, &here, weight, prediction->k);
    const double left = 1.0 + ANY_LEVEL + OWN_NOISE - explained;
    const double sigma = sqrt(process_variance(nodes, points, used, a) * fmax(left, OWN_NOISE));
    prediction->sigma = fmin(sigma, corner_span(nodes, points, used) + PRIOR_SIGMA);
    prediction->used = used;
    free(points);
    return 1;
}
