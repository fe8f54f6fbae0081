/* online_ratio - the exposure of every frame of a clip relative to the frame before, while it plays:
 *
 *     ffmpeg -v error -i clip.mp4 -vf scale=640:480 -f rawvideo -pix_fmt gray - | online_ratio 640 480
 *
 * The library takes tracks from the caller. The tracker here is as simple as one can be: corners of the image, searched
 * in the next frame by normalised correlation, which brightness does not change. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <lensprof/online.h>

#define CELL 32  /* px: one new track per cell without a track */
#define PATCH 4  /* half side of a patch, px */
#define REACH 12 /* of the search, px per frame */
#define TRACKS 1024

typedef struct point {
    uint64_t track;
    int x, y;
} point;

typedef struct picture {
    int width, height;
    unsigned char *grey;
} picture;

static point points[TRACKS];
static int count;
static uint64_t tracks;

static int at(const picture *p, int x, int y) { return p->grey[y * p->width + x]; }

static int is_inside(const picture *p, int x, int y, int margin) {
    return x >= margin && y >= margin && x < p->width - margin && y < p->height - margin;
}

/* Mean and sum of squares about it. */
static double mean_of(const picture *p, int x, int y, double *squares) {
    double sum = 0.0, sum2 = 0.0, n = (2 * PATCH + 1) * (2 * PATCH + 1);
    int i, j;
    for (j = -PATCH; j <= PATCH; j++)
        for (i = -PATCH; i <= PATCH; i++) {
            double v = at(p, x + i, y + j);
            sum += v, sum2 += v * v;
        }
    *squares = sum2 - sum * sum / n;
    return sum / n;
}

/* Normalised correlation of two patches, -1..1. */
static double correlation(const picture *a, int ax, int ay, const picture *b, int bx, int by) {
    double of_a, of_b, product = 0.0, mean_a = mean_of(a, ax, ay, &of_a), mean_b = mean_of(b, bx, by, &of_b);
    int i, j;
    for (j = -PATCH; j <= PATCH; j++)
        for (i = -PATCH; i <= PATCH; i++)
            product += (at(a, ax + i, ay + j) - mean_a) * (at(b, bx + i, by + j) - mean_b);
    return of_a > 0.0 && of_b > 0.0 ? product / sqrt(of_a * of_b) : -1.0;
}

/* Moves a point from one frame to the next: coarse steps, then single pixels. Returns whether it was found. */
static int follow(const picture *from, const picture *to, point *p) {
    int best_x = p->x, best_y = p->y, step, i, j;
    double best = -1.0;
    for (step = 3; step > 0; step -= 2) {
        int reach = step == 3 ? REACH : 2, middle_x = best_x, middle_y = best_y;
        for (j = -reach; j <= reach; j += step)
            for (i = -reach; i <= reach; i += step) {
                double c;
                if (!is_inside(to, middle_x + i, middle_y + j, PATCH)) continue;
                c = correlation(from, p->x, p->y, to, middle_x + i, middle_y + j);
                if (c > best) best = c, best_x = middle_x + i, best_y = middle_y + j;
            }
    }
    p->x = best_x, p->y = best_y;
    return best > 0.9;
}

static void follow_all(const picture *from, const picture *to) {
    int kept = 0, i;
    for (i = 0; i < count; i++)
        if (follow(from, to, &points[i])) points[kept++] = points[i];
    count = kept;
}

/* The strongest corner of a cell: the smaller eigenvalue of the gradients' products. 0 if it has none. */
static int find_corner(const picture *p, int left, int top, point *found) {
    double best = 200.0;
    int x, y, i, j;
    for (y = top; y < top + CELL; y += 2)
        for (x = left; x < left + CELL; x += 2) {
            double xx = 0.0, xy = 0.0, yy = 0.0, smaller;
            if (!is_inside(p, x, y, PATCH + 1)) continue;
            for (j = -2; j <= 2; j++)
                for (i = -2; i <= 2; i++) {
                    double dx = at(p, x + i + 1, y + j) - at(p, x + i - 1, y + j);
                    double dy = at(p, x + i, y + j + 1) - at(p, x + i, y + j - 1);
                    xx += dx * dx, xy += dx * dy, yy += dy * dy;
                }
            smaller = 0.5 * (xx + yy - sqrt((xx - yy) * (xx - yy) + 4.0 * xy * xy));
            if (smaller > best) best = smaller, found->x = x, found->y = y;
        }
    return best > 200.0;
}

static void add_corners(const picture *p) {
    int left, top, i;
    for (top = 0; top + CELL <= p->height; top += CELL)
        for (left = 0; left + CELL <= p->width; left += CELL) {
            for (i = 0; i < count && (points[i].x / CELL != left / CELL || points[i].y / CELL != top / CELL);) i++;
            if (i < count || count == TRACKS || !find_corner(p, left, top, &points[count])) continue;
            points[count++].track = tracks++;
        }
}

/* Grey value of a point: mean of 5 x 5 pixels, 0..1. */
static float value_of(const picture *p, const point *at_point) {
    int sum = 0, i, j;
    for (j = -2; j <= 2; j++)
        for (i = -2; i <= 2; i++) sum += at(p, at_point->x + i, at_point->y + j);
    return (float)(sum / (25.0 * 255.0));
}

static lensprof_status add_frame(lensprof_online *online, const picture *p, uint64_t number,
                                 lensprof_online_exposure *exposure, lensprof_error *error) {
    static lensprof_online_observation seen[TRACKS];
    lensprof_online_frame frame;
    lensprof_status status;
    int i;
    lensprof_online_frame_init(&frame);
    memset(seen, 0, sizeof seen);
    for (i = 0; i < count; i++) {
        seen[i].track = points[i].track, seen[i].weight = 1.0f;
        seen[i].x = (float)points[i].x, seen[i].y = (float)points[i].y, seen[i].value[0] = value_of(p, &points[i]);
    }
    frame.number = number, frame.count = (uint32_t)count, frame.observations = seen;
    status = lensprof_online_add(online, &frame, exposure, error);
    return status == LENSPROF_OK ? lensprof_online_solve(online, 1, NULL, error) : status;
}

static void print_result(const lensprof_online *online) {
    lensprof_online_result r;
    lensprof_online_result_init(&r);
    if (lensprof_online_get(online, &r, NULL) != LENSPROF_OK) return;
    printf("exponent %.2f, standard error %.0f %%%s\n", r.gamma, 100.0 * r.log_gamma_sigma,
           r.known & LENSPROF_ONLINE_KNOWS_EXPONENT ? "" : ": not determined without known exposures");
    printf("light in the corner %.3f +- %.3f%s\n", r.corner, r.corner_sigma,
           r.known & LENSPROF_ONLINE_KNOWS_FALLOFF ? "" : ": not certain yet; move the camera");
}

int main(int arguments, char **argument) {
    lensprof_online_options options;
    lensprof_online_exposure exposure;
    lensprof_online *online;
    lensprof_error error;
    picture now, before;
    void *memory;
    uint64_t number = 0;
    size_t bytes;
    if (arguments != 3 || atoi(argument[1]) < 64 || atoi(argument[2]) < 64) {
        fprintf(stderr, "usage: online_ratio WIDTH HEIGHT < frames of grey bytes\n");
        return 2;
    }
    now.width = before.width = atoi(argument[1]), now.height = before.height = atoi(argument[2]);
    bytes = (size_t)now.width * (size_t)now.height;
    lensprof_online_options_init(&options), lensprof_online_exposure_init(&exposure);
    options.width = (uint32_t)now.width, options.height = (uint32_t)now.height, options.tracks = TRACKS;
    now.grey = malloc(bytes), before.grey = malloc(bytes), memory = malloc(lensprof_online_bytes(&options));
    if (!now.grey || !before.grey || !memory) return 1;
    if (lensprof_online_begin(memory, lensprof_online_bytes(&options), &options, &online, &error) != LENSPROF_OK) {
        fprintf(stderr, "%s\n", error.text);
        return 1;
    }
    for (; fread(now.grey, 1, bytes, stdin) == bytes; number++) {
        unsigned char *swapped = before.grey;
        if (number) follow_all(&before, &now);
        add_corners(&now);
        if (add_frame(online, &now, number, &exposure, &error) != LENSPROF_OK) {
            fprintf(stderr, "%s\n", error.text);
            return 1;
        }
        printf("frame %lu: step %+.3f +- %.3f EV, since the first %+.3f +- %.3f, %u tracks\n", (unsigned long)number,
               exposure.step_ev, exposure.step_sigma, exposure.ev, exposure.ev_sigma, exposure.tracks);
        before.grey = now.grey, now.grey = swapped;
    }
    print_result(online);
    free(now.grey), free(before.grey), free(memory);
    return number ? 0 : 1;
}
