/* The image circle (lensprof/model.h): a pixel lies in it if its squared distance from the centre is at most that of
 * the rim. */
#include "core/image_circle.h"

#include <math.h>

#define LARGEST_RADIUS 4.0 /* half diagonals: covers the frame about any centre */

lensprof_status lensprof_image_circle_validate(const lensprof_image_circle *circle) {
    if (!circle) return LENSPROF_ERROR_ARGUMENT;
    const double *c = circle->center;
    if (circle->radius == 0.0) return c[0] == 0.0 && c[1] == 0.0 ? LENSPROF_OK : LENSPROF_ERROR_ARGUMENT;
    return circle->radius > 0.0 && circle->radius <= LARGEST_RADIUS && fabs(c[0]) <= 1.0 && fabs(c[1]) <= 1.0
               ? LENSPROF_OK
               : LENSPROF_ERROR_ARGUMENT;
}

int lensprof_image_circle_contains(const lensprof_image_circle *circle, uint32_t width, uint32_t height, double x,
                                   double y) {
    if (circle->radius == 0.0) return 1;
    const lensprof_vignetting about = {{0.0, 0.0, 0.0}, {circle->center[0], circle->center[1]}};
    return lensprof_vignetting_r2(&about, width, height, x, y, NULL) <= circle->radius * circle->radius;
}

/* Pixels of a row are in the circle from one column to another, and the nearest one to its centre is if any is. */
void lp_image_circle_columns(const lensprof_image_circle *circle, uint32_t width, uint32_t height, uint32_t y,
                             uint32_t *first, uint32_t *end) {
    const double last = width - 1.0;
    const double middle = 0.5 * last + lensprof_half_diagonal(width, height) * circle->center[0];
    const uint32_t nearest = middle <= 0.0 ? 0 : middle >= last ? width - 1 : (uint32_t)(middle + 0.5);
    *first = *end = 0;
    if (!lensprof_image_circle_contains(circle, width, height, nearest, y)) return;
    for (uint32_t in = nearest; *first < in;) { /* bisection: the answer is first..in */
        const uint32_t x = *first + (in - *first) / 2;
        if (lensprof_image_circle_contains(circle, width, height, x, y))
            in = x;
        else
            *first = x + 1;
    }
    *end = nearest + 1;
    for (uint32_t out = width; *end < out;) { /* end..out */
        const uint32_t x = *end + (out - *end) / 2;
        if (lensprof_image_circle_contains(circle, width, height, x, y))
            *end = x + 1;
        else
            out = x;
    }
}
