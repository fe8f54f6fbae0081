/* Camera projections of PanoTools: direction -> pixel in seven steps, and the inverse of each step for the way back.
 * In this file vectors are right-handed as seen by the eye: x right, y down, z forward; directions have length 1. */
#include <lensprof/geometry.h>

#include <math.h>

#define PI 3.14159265358979323846
#define MAX_SIDE_PX (1u << 20)
#define EDGE 1e-9 /* margin at the rim of projections that turn back there: rounding must not lose the rim itself */

/* Thoby 2006: radius = 1.47 F sin(0.713 angle), measured on a Nikkor 10.5 mm. */
#define THOBY_RADIUS 1.47
#define THOBY_ANGLE 0.713

static double radians(double degrees) { return degrees * (PI / 180); }

/* ---- validity ------------------------------------------------------------------------------------------- */

/* Largest possible field of view in degrees; *open is 1 if the limit itself is not possible. 0 = unknown projection.
 * The angle of an equidistant fisheye is proportional to the radius, so that a frame may be wider than the image circle
 * of 360 degrees: such as one that has two circles side by side. */
static double widest_hfov(uint32_t projection, int *open) {
    *open = 0;
    switch (projection) {
    case LENSPROF_PROJECTION_RECTILINEAR: *open = 1; return 180;
    case LENSPROF_PROJECTION_STEREOGRAPHIC: *open = 1; return 360;
    case LENSPROF_PROJECTION_THOBY: return 180 / THOBY_ANGLE;
    case LENSPROF_PROJECTION_CIRCULAR_FISHEYE:
    case LENSPROF_PROJECTION_FULLFRAME_FISHEYE: return 3600;
    case LENSPROF_PROJECTION_CYLINDRICAL:
    case LENSPROF_PROJECTION_EQUIRECTANGULAR:
    case LENSPROF_PROJECTION_ORTHOGRAPHIC: /* beyond 180 degrees libpano13 means a frame wider than the image circle */
    case LENSPROF_PROJECTION_EQUISOLID: return 360;
    default: return 0;
    }
}

static int all_finite(const double *values, int count) {
    for (int i = 0; i < count; i++) {
        if (!isfinite(values[i])) return 0;
    }
    return 1;
}

static int is_moved(const lensprof_camera *camera) {
    return camera->translation[0] != 0 || camera->translation[1] != 0 || camera->translation[2] != 0;
}

/* Unit vector of longitude and latitude (positive down). */
static void vector_of(double longitude, double latitude, double v[3]) {
    v[0] = cos(latitude) * sin(longitude);
    v[1] = sin(latitude);
    v[2] = cos(latitude) * cos(longitude);
}

/* The remapping plane is normal . point = 1 in panorama coordinates. */
static void plane_normal(const lensprof_camera *camera, double normal[3]) {
    vector_of(radians(camera->plane_deg[0]), -radians(camera->plane_deg[1]), normal);
}

/* PanoTools counts z backward, hence the sign. */
static void camera_position(const lensprof_camera *camera, double position[3]) {
    position[0] = camera->translation[0];
    position[1] = camera->translation[1];
    position[2] = -camera->translation[2];
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* 1 - N.T: distance of the camera in front of the remapping plane. */
static double plane_distance(const lensprof_camera *camera) {
    double normal[3], position[3];
    plane_normal(camera, normal);
    camera_position(camera, position);
    return 1 - dot(normal, position);
}

lensprof_status lensprof_camera_validate(const lensprof_camera *camera) {
    if (!camera) return LENSPROF_ERROR_ARGUMENT;
    int open;
    double widest = widest_hfov(camera->projection, &open);
    const double angles[4] = {camera->hfov_deg, camera->yaw_deg, camera->pitch_deg, camera->roll_deg};
    if (!all_finite(angles, 4) || !all_finite(camera->radial, 3) || !all_finite(camera->shift_px, 2)
        || !all_finite(camera->shear_px, 2) || !all_finite(camera->translation, 3)
        || !all_finite(camera->plane_deg, 2)) {
        return LENSPROF_ERROR_GEOMETRY;
    }
    if (camera->width < 1 || camera->width > MAX_SIDE_PX || camera->height < 1 || camera->height > MAX_SIDE_PX) {
        return LENSPROF_ERROR_GEOMETRY;
    }
    if (!(camera->hfov_deg > 0) || camera->hfov_deg > widest || (open && camera->hfov_deg >= widest)) {
        return LENSPROF_ERROR_GEOMETRY;
    }
    /* The radial polynomial must rise at the centre, the shear must be invertible, the camera must see the plane. */
    double shear = (camera->shear_px[0] / camera->height) * (camera->shear_px[1] / camera->width);
    if (!(1 - camera->radial[0] - camera->radial[1] - camera->radial[2] > 0) || !(fabs(1 - shear) > 1e-6)) {
        return LENSPROF_ERROR_GEOMETRY;
    }
    if (is_moved(camera) && !(fabs(plane_distance(camera)) > 1e-12)) return LENSPROF_ERROR_GEOMETRY;
    return LENSPROF_OK;
}

/* ---- camera position (translation) and rotation ----------------------------------------------------------- */

/* Direction from the panorama's centre -> direction from the moved camera: both point to the same point of the
 * plane. */
static int translate(const lensprof_camera *camera, double v[3]) {
    double normal[3], position[3];
    plane_normal(camera, normal);
    camera_position(camera, position);
    double rate = dot(normal, v);
    if (!(rate > 0)) return 0;
    double length2 = 0;
    for (int i = 0; i < 3; i++) {
        v[i] = v[i] / rate - position[i];
        length2 += v[i] * v[i];
    }
    double length = sqrt(length2);
    if (!(length > 0) || !isfinite(length)) return 0;
    for (int i = 0; i < 3; i++) {
        v[i] /= length;
    }
    return 1;
}

/* The ray X = s v from the camera at T meets the plane where N.(X + T) = 1; X + T is seen from the centre. */
static int untranslate(const lensprof_camera *camera, double v[3]) {
    double normal[3], position[3];
    plane_normal(camera, normal);
    camera_position(camera, position);
    double s = plane_distance(camera) / dot(normal, v);
    if (!(s > 0) || !isfinite(s)) return 0;
    for (int i = 0; i < 3; i++) {
        v[i] = s * v[i] + position[i];
    }
    return 1;
}

static void turn(double *a, double *b, double angle) {
    double c = cos(angle), s = sin(angle), old = *a;
    *a = c * old + s * *b;
    *b = c * *b - s * old;
}

static void rotate(const lensprof_camera *camera, double v[3]) {
    turn(&v[2], &v[0], radians(camera->yaw_deg));
    turn(&v[1], &v[2], radians(camera->pitch_deg));
    turn(&v[0], &v[1], radians(camera->roll_deg));
}

static void unrotate(const lensprof_camera *camera, double v[3]) {
    turn(&v[0], &v[1], -radians(camera->roll_deg));
    turn(&v[1], &v[2], -radians(camera->pitch_deg));
    turn(&v[2], &v[0], -radians(camera->yaw_deg));
}

/* ---- the ideal lens --------------------------------------------------------------------------------------- */

static double focal_px(const lensprof_camera *camera) {
    double a = radians(camera->hfov_deg), width = camera->width;
    switch (camera->projection) {
    case LENSPROF_PROJECTION_RECTILINEAR: return width / (2 * tan(a / 2));
    case LENSPROF_PROJECTION_ORTHOGRAPHIC: return a <= PI ? width / (2 * sin(a / 2)) : width / (2 * (2 - sin(a / 2)));
    case LENSPROF_PROJECTION_STEREOGRAPHIC: return width / (4 * tan(a / 4));
    case LENSPROF_PROJECTION_THOBY: return width / (2 * THOBY_RADIUS * sin(THOBY_ANGLE * a / 2));
    case LENSPROF_PROJECTION_EQUISOLID: return width / (4 * sin(a / 4));
    default: return width / a;
    }
}

/* Radius in px of a direction with distance s from the axis and z along the axis (s^2 + z^2 = 1). Negative if the
 * lens does not see it. */
static double radius_px(uint32_t projection, double focal, double s, double z) {
    double angle = atan2(s, z);
    switch (projection) {
    case LENSPROF_PROJECTION_RECTILINEAR: return z > 0 ? focal * s / z : -1;
    case LENSPROF_PROJECTION_ORTHOGRAPHIC: return z >= -EDGE ? focal * s : -1;
    case LENSPROF_PROJECTION_STEREOGRAPHIC: /* tan(angle / 2) without cancellation; undefined at 180 deg */
        return z > 0 ? 2 * focal * s / (1 + z) : s > EDGE ? 2 * focal * (1 - z) / s : -1;
    case LENSPROF_PROJECTION_THOBY:
        return THOBY_ANGLE * angle <= PI / 2 + EDGE ? THOBY_RADIUS * focal * sin(THOBY_ANGLE * angle) : -1;
    case LENSPROF_PROJECTION_EQUISOLID: return 2 * focal * sin(angle / 2);
    default: return focal * angle;
    }
}

/* Angle from the axis of a radius in px; NaN if undefined (asin beyond 1). */
static double angle_of_radius(uint32_t projection, double focal, double radius) {
    double q = radius / focal;
    switch (projection) {
    case LENSPROF_PROJECTION_RECTILINEAR: return atan(q);
    case LENSPROF_PROJECTION_ORTHOGRAPHIC: return asin(q);
    case LENSPROF_PROJECTION_STEREOGRAPHIC: return 2 * atan(q / 2);
    case LENSPROF_PROJECTION_THOBY: return asin(q / THOBY_RADIUS) / THOBY_ANGLE;
    case LENSPROF_PROJECTION_EQUISOLID: return 2 * asin(q / 2);
    default: return q <= PI ? q : NAN;
    }
}

/* Direction in the camera's frame -> px from the optical axis. */
static int lens_project(const lensprof_camera *camera, const double v[3], double xy[2]) {
    double focal = focal_px(camera), s = hypot(v[0], v[1]);
    if (camera->projection == LENSPROF_PROJECTION_CYLINDRICAL
        || camera->projection == LENSPROF_PROJECTION_EQUIRECTANGULAR) {
        double level = hypot(v[0], v[2]);
        xy[0] = focal * atan2(v[0], v[2]);
        xy[1] =
            camera->projection == LENSPROF_PROJECTION_CYLINDRICAL ? focal * v[1] / level : focal * atan2(v[1], level);
        return 1;
    }
    if (s == 0) { /* the axis itself; backwards it is a circle or infinitely far */
        xy[0] = xy[1] = 0;
        return v[2] > 0;
    }
    double radius = radius_px(camera->projection, focal, s, v[2]);
    xy[0] = radius * (v[0] / s);
    xy[1] = radius * (v[1] / s);
    return radius >= 0;
}

static int lens_unproject(const lensprof_camera *camera, const double xy[2], double v[3]) {
    double focal = focal_px(camera), radius = hypot(xy[0], xy[1]);
    if (camera->projection == LENSPROF_PROJECTION_CYLINDRICAL
        || camera->projection == LENSPROF_PROJECTION_EQUIRECTANGULAR) {
        int cylinder = camera->projection == LENSPROF_PROJECTION_CYLINDRICAL;
        double longitude = xy[0] / focal;
        double latitude = cylinder ? atan(xy[1] / focal) : xy[1] / focal;
        vector_of(longitude, latitude, v);
        return fabs(longitude) <= PI && fabs(latitude) <= PI / 2;
    }
    double angle = angle_of_radius(camera->projection, focal, radius);
    double along = radius > 0 ? sin(angle) / radius : 0;
    v[0] = along * xy[0];
    v[1] = along * xy[1];
    v[2] = cos(angle);
    return isfinite(angle);
}

/* ---- radial distortion ------------------------------------------------------------------------------------ */

/* P(R) = a R^4 + b R^3 + c R^2 + (1-a-b-c) R */
static double radial_eval(const double radial[3], double r) {
    double d = 1 - radial[0] - radial[1] - radial[2];
    return r * (d + r * (radial[2] + r * (radial[1] + r * radial[0])));
}

static double radial_slope(const double radial[3], double r) {
    double d = 1 - radial[0] - radial[1] - radial[2];
    return d + r * (2 * radial[2] + r * (3 * radial[1] + r * 4 * radial[0]));
}

/* 1 if P rises all the way from 0 to r: the slope is positive at 0, at r, and at its extrema in between, which are
 * the roots of 12 a R^2 + 6 b R + 2 c. */
static int radial_rises(const double radial[3], double r) {
    double a = 12 * radial[0], b = 6 * radial[1], c = 2 * radial[2];
    double q = b * b - 4 * a * c;
    if (!(radial_slope(radial, r) > 0)) return 0;
    if (q < 0) return 1;
    double u = -0.5 * (b + copysign(sqrt(q), b));
    double roots[2] = {u / a, c / u}; /* infinite or NaN if there is no such root: never inside */
    for (int i = 0; i < 2; i++) {
        if (roots[i] > 0 && roots[i] < r && !(radial_slope(radial, roots[i]) > 0)) return 0;
    }
    return 1;
}

/* The R >= 0 on the rising branch with P(R) = target, or -1: Newton's method inside a bracket. A point beyond the
 * branch counts as too far, so the bracket always holds the answer if there is one. */
static double radial_invert(const double radial[3], double target) {
    double low = 0, high = target > 1 ? target : 1;
    while (radial_rises(radial, high) && radial_eval(radial, high) < target) {
        low = high;
        high *= 2;
        if (high > 1e12) return -1;
    }
    double r = target > low && target < high ? target : 0.5 * (low + high);
    for (int i = 0; i < 200; i++) {
        double excess = radial_eval(radial, r) - target, next = NAN;
        if (!radial_rises(radial, r)) {
            high = r;
        } else {
            *(excess > 0 ? &high : &low) = r;
            next = r - excess / radial_slope(radial, r);
        }
        if (!(next >= low && next <= high)) {
            next = 0.5 * (low + high);
        }
        if (fabs(next - r) <= 4e-16 * r) {
            break;
        }
        r = next;
    }
    double miss = fabs(radial_eval(radial, r) - target);
    return radial_rises(radial, r) && miss <= 1e-13 * (1 + target) ? r : -1;
}

static int is_distorted(const lensprof_camera *camera) {
    return camera->radial[0] != 0 || camera->radial[1] != 0 || camera->radial[2] != 0;
}

static double half_side(const lensprof_camera *camera) {
    return 0.5 * (camera->width < camera->height ? camera->width : camera->height);
}

static int distort(const lensprof_camera *camera, double xy[2]) {
    double r = hypot(xy[0], xy[1]) / half_side(camera);
    double factor = r > 0 ? radial_eval(camera->radial, r) / r : 1;
    xy[0] *= factor;
    xy[1] *= factor;
    return radial_rises(camera->radial, r);
}

static int undistort(const lensprof_camera *camera, double xy[2]) {
    double target = hypot(xy[0], xy[1]) / half_side(camera);
    double r = radial_invert(camera->radial, target);
    double factor = target > 0 ? r / target : 1;
    xy[0] *= factor;
    xy[1] *= factor;
    return r >= 0;
}

/* ---- all steps ------------------------------------------------------------------------------------------ */

int lensprof_camera_project(const lensprof_camera *camera, double longitude, double latitude, double xy[2]) {
    double v[3], p[2];
    vector_of(longitude, latitude, v);
    if (is_moved(camera) && !translate(camera, v)) return 0;
    rotate(camera, v);
    if (!lens_project(camera, v, p) || (is_distorted(camera) && !distort(camera, p))) return 0;
    double x = p[0] + camera->shift_px[0], y = p[1] + camera->shift_px[1];
    double px = x + camera->shear_px[0] / camera->height * y + 0.5 * camera->width - 0.5;
    double py = y + camera->shear_px[1] / camera->width * x + 0.5 * camera->height - 0.5;
    if (!isfinite(px) || !isfinite(py)) return 0;
    xy[0] = px;
    xy[1] = py;
    return 1;
}

int lensprof_camera_unproject(const lensprof_camera *camera, double x, double y, double direction[2]) {
    double across = x - 0.5 * camera->width + 0.5, down = y - 0.5 * camera->height + 0.5;
    double shear_x = camera->shear_px[0] / camera->height, shear_y = camera->shear_px[1] / camera->width;
    double determinant = 1 - shear_x * shear_y, v[3];
    double p[2] = {(across - shear_x * down) / determinant - camera->shift_px[0],
                   (down - shear_y * across) / determinant - camera->shift_px[1]};
    if (!isfinite(p[0]) || !isfinite(p[1]) || (is_distorted(camera) && !undistort(camera, p))
        || !lens_unproject(camera, p, v)) {
        return 0;
    }
    unrotate(camera, v);
    if (is_moved(camera) && !untranslate(camera, v)) return 0;
    direction[0] = atan2(v[0], v[2]);
    direction[1] = atan2(v[1], hypot(v[0], v[2]));
    return 1;
}

size_t lensprof_camera_project_many(const lensprof_camera *camera, const double *directions, size_t count, double *xy) {
    size_t seen = 0;
    for (size_t i = 0; i < count; i++, directions += 2, xy += 2)
        if (lensprof_camera_project(camera, directions[0], directions[1], xy))
            seen++;
        else
            xy[0] = xy[1] = NAN;
    return seen;
}

size_t lensprof_camera_unproject_many(const lensprof_camera *camera, const double *xy, size_t count,
                                      double *directions) {
    size_t seen = 0;
    for (size_t i = 0; i < count; i++, xy += 2, directions += 2)
        if (lensprof_camera_unproject(camera, xy[0], xy[1], directions))
            seen++;
        else
            directions[0] = directions[1] = NAN;
    return seen;
}
