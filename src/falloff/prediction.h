/* A lens's falloff between the settings at which it is known: kriging. C, for the store; nothing is thrown. */
#ifndef LENSPROF_FALLOFF_PREDICTION_H
#define LENSPROF_FALLOFF_PREDICTION_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define LP_NEIGHBOURS 24 /* nodes that a prediction uses */

/* What is known at one setting. distance_m may be infinite. */
typedef struct lp_falloff_node {
    int64_t id; /* the caller's */
    double focal_mm, aperture, distance_m;
    double k[3][3];  /* curve by curve; all three also where they are the same */
    double variance; /* of M in the corner; 0 = not known, LP_VARIANCE_UNREAD = the caller's to read */
} lp_falloff_node;

#define LP_VARIANCE_UNREAD (-1.0)

/* What is known of a lens. Variances that are not read are, by read_variance, of those nodes alone that count: it sets
 * node->variance, or returns false, which ends the prediction. */
typedef struct lp_falloff_nodes {
    lp_falloff_node *node;
    uint32_t count;
    bool (*read_variance)(void *user, lp_falloff_node *node);
    void *user;
} lp_falloff_nodes;

typedef struct lp_falloff_prediction {
    double k[3][3];
    double sigma;   /* standard error of M in the corner */
    double nearest; /* distance to the nearest node, 0..LP_FALLOFF_REACH */
    uint32_t used;
    struct {
        uint32_t node; /* index */
        double weight;
    } row[LP_NEIGHBOURS]; /* nearest first; weights add up to nearly 1 */
} lp_falloff_prediction;

/* Beyond this distance nothing is predicted: two stops from wide open, or a factor 2 in focal length. */
#define LP_FALLOFF_REACH 0.5

/* Leaves of nodes with the same focal length, aperture and curves the one focused farthest, the last of several, in
 * their order; returns how many are left. order[count] is for its own use. */
uint32_t lp_drop_repeated(lp_falloff_node *nodes, uint32_t count, uint32_t *order);

/* The falloff at a setting; one node at least, none repeated. 0 where the nearest is beyond LP_FALLOFF_REACH; then only
 * `nearest` is set. Returns -1 without memory or a variance.
 *
 * Kriging of curves: with x = log2(f)/2, t = N0/N, z = 0.2 m/D and the distance d between settings in these, the
 * covariance of M is (1 + d) e^-d + const; N0 is the smallest f-number known at this focal length or a longer one, so
 * that t = 1 is wide open. From curves a mean trend -0.4 t^2 r^2 is taken first. Axes, kernel and constants are those
 * of the smallest leave-one-out error over half of the lenses of Lensfun's database, checked on the other half
 * (docs/database.md). A prediction leaves the range of its neighbours' curves by no more than half of that range and
 * 0.02, and stays above half of the lowest. */
int lp_predict_falloff(const lp_falloff_nodes *nodes, const lp_falloff_node *target, lp_falloff_prediction *prediction);

/* The curves with M(r) = sum over r^2, r^4, r^6 nearest to values[LP_FALLOFF_RADII] at r = i / (LP_FALLOFF_RADII - 1),
 * weighted by area. */
#define LP_FALLOFF_RADII 33
void lp_fit_falloff(const double *values, double k[3]);
void lp_sample_falloff(const double k[3], double *values);

/* Covariance of k1..k3 (3 x 3) of a falloff whose M has the standard error `sigma` in the corner. Its shape is that of
 * the errors of predictions for settings that were left out, over one half of the lenses of Lensfun's database, all
 * lenses alike, by a Student distribution of 3 degrees of freedom. */
void lp_falloff_covariance(double sigma, double covariance[9]);

#ifdef __cplusplus
}
#endif
#endif
