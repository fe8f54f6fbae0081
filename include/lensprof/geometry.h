/* lensprof/geometry.h - camera projections: direction <-> image pixel.
 *
 * Example: where the centre of one picture lies in the next.
 *
 *     lensprof_camera left = {.width = 640, .height = 480, .hfov_deg = 50.0}, right = left; // rectilinear
 *     double direction[2], xy[2];
 *     right.yaw_deg = 20.0;
 *     if (lensprof_camera_unproject(&left, 319.5, 239.5, direction)
 *         && lensprof_camera_project(&right, direction[0], direction[1], xy))
 *         printf("%.1f, %.1f\n", xy[0], xy[1]);
 *
 * The PanoTools camera model as used by Hugin and nona; agrees with libpano13 (`pano_trafo`) to 1e-4 px.
 * Directions are longitude and latitude in radians, latitude positive DOWN; (0,0) is the centre of the panorama.
 * Pixel centres are integers; pixel (0,0) is the centre of the upper left pixel. No heap, no I/O.
 * Threads: all functions are pure. */
#ifndef LENSPROF_GEOMETRY_H
#define LENSPROF_GEOMETRY_H

#include "base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Lens projections, numbered as the `f` parameter of a PTO `i` line. */
typedef enum lensprof_projection {
    LENSPROF_PROJECTION_RECTILINEAR = 0,
    LENSPROF_PROJECTION_CYLINDRICAL = 1,
    LENSPROF_PROJECTION_CIRCULAR_FISHEYE = 2,  /* equidistant */
    LENSPROF_PROJECTION_FULLFRAME_FISHEYE = 3, /* equidistant */
    LENSPROF_PROJECTION_EQUIRECTANGULAR = 4,
    LENSPROF_PROJECTION_ORTHOGRAPHIC = 8,
    LENSPROF_PROJECTION_STEREOGRAPHIC = 10,
    LENSPROF_PROJECTION_THOBY = 20,
    LENSPROF_PROJECTION_EQUISOLID = 21
} lensprof_projection;

/* Camera of one picture. Frozen value struct; all angles in degrees. */
typedef struct lensprof_camera {
    uint32_t projection;    /* lensprof_projection */
    uint32_t width, height; /* full frame, px */
    double hfov_deg;        /* horizontal field of view of `width` */
    double yaw_deg, pitch_deg, roll_deg;
    double radial[3];      /* a, b, c of R (a R^3 + b R^2 + c R + 1-a-b-c), R = 1 at half the smaller side */
    double shift_px[2];    /* d, e: centre shift */
    double shear_px[2];    /* g, t */
    double translation[3]; /* TrX, TrY, TrZ */
    double plane_deg[2];   /* Tpy, Tpp: yaw and pitch of the remapping plane, used with a translation */
} lensprof_camera;

/* LENSPROF_OK if the camera can be evaluated: known projection, sizes > 0, finite numbers, and a field of view that the
 * projection allows. Errors: GEOMETRY; ARGUMENT for NULL. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_camera_validate(const lensprof_camera *camera);

/* Direction -> pixel. Returns 1 and sets xy, or returns 0 if the direction is not visible (at the back of the camera,
 * or beyond the radius where the radial polynomial turns back). The pixel may lie outside the frame. The camera must be
 * valid. */
LENSPROF_API int lensprof_camera_project(const lensprof_camera *camera, double longitude, double latitude,
                                         double xy[2]);

/* Pixel -> direction {longitude, latitude}. Returns 1, or 0 if no direction maps to that pixel. Inverse of
 * lensprof_camera_project to 1e-9 px. */
LENSPROF_API int lensprof_camera_unproject(const lensprof_camera *camera, double x, double y, double direction[2]);

/* The two for `count` directions (longitude, latitude of each) and pixels (x, y of each), bit for bit those of the
 * functions for one. All arrays have 2 * count numbers; the results may be the same array as the input. Both numbers of
 * a result are NaN where the function for one returns 0. Return how many are not. Nothing else can fail. */
LENSPROF_API size_t lensprof_camera_project_many(const lensprof_camera *camera, const double *directions, size_t count,
                                                 double *xy);
LENSPROF_API size_t lensprof_camera_unproject_many(const lensprof_camera *camera, const double *xy, size_t count,
                                                   double *directions);

#ifdef __cplusplus
}
#endif
#endif
