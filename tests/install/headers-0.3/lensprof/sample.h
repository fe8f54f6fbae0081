/* lensprof/sample.h - correspondences: the same scene point in two pictures.
 *
 * Example: pairs from overlapping pictures whose cameras are known.
 *
 *     static lensprof_pair pairs[2000];
 *     uint32_t count;
 *     lensprof_sample_image samples[3];
 *     lensprof_sample_options options;
 *     lensprof_sample_options_init(&options);
 *     for (uint32_t i = 0; i < 3; i++) {
 *         lensprof_sample_image_init(&samples[i]);
 *         samples[i].view = images[i], samples[i].camera = cameras[i];
 *     }
 *     status = lensprof_sample_overlap(&options, samples, 3, pairs, 2000, &count, &error);
 *     if (status == LENSPROF_OK) printf("%u pairs\n", (unsigned)count);
 *
 * Threads: calls are independent of each other; the pictures are only read. One call uses up to the number of threads
 * in its options, and joins them before it returns. The pairs do not depend on that number: same input, same bytes. */
#ifndef LENSPROF_SAMPLE_H
#define LENSPROF_SAMPLE_H

#include "apply.h"
#include "geometry.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One correspondence. Frozen value struct. */
typedef struct lensprof_pair {
    uint32_t image[2];  /* indices of two different images */
    double xy[2][2];    /* position in each image, px of the full frame */
    double value[2][3]; /* grey values 0..1: red, green, blue; grey pictures repeat [0] */
} lensprof_pair;

/* One view of a scene point. All observations with the same `point` (any number) form a track: two or more, at most one
 * per image. Frozen value struct. */
typedef struct lensprof_observation {
    uint32_t point;  /* the scene point */
    uint32_t image;  /* index */
    double xy[2];    /* position, px of the full frame */
    double value[3]; /* grey values 0..1: red, green, blue; with one channel only [0]. A value above 250/255 counts as
                        saturated: a lower bound of the light. A value below half a level of 255 is an upper bound */
} lensprof_observation;

/* A picture to sample. The view may be a reduced picture: pixel (u, v) is then the mean of the square of frame pixels
 * that begins at (u, v) * reduction, or of some pixels of that square whose places vary from square to square. */
typedef struct lensprof_sample_image {
    uint32_t struct_size;
    uint32_t reduction;       /* side of that square, px; 1 = full size. view.width * reduction <= camera.width */
    uint32_t every_pixel;     /* 1: all pixels of a patch must be within [black, white]; 0: its robust mean must be */
    uint32_t reserved;        /* 0 */
    lensprof_image view;      /* the frame, reduced or not; in layouts with alpha, alpha below half = excluded */
    lensprof_camera camera;   /* full frame */
    const uint8_t *mask;      /* one byte per view pixel, 0 = excluded; NULL = all included */
    ptrdiff_t mask_row_bytes; /* magnitude at least the width of the view, may be negative; unused without a mask */
    double black, white;      /* samples outside [black, white] in any channel are not used; 0..1 */
} lensprof_sample_image;

/* Full size, robust means, no mask, 2/255 to 250/255. View and camera are zero; the caller must set them. */
LENSPROF_API void lensprof_sample_image_init_sized(lensprof_sample_image *image, size_t size);
static inline void lensprof_sample_image_init(lensprof_sample_image *image) {
    lensprof_sample_image_init_sized(image, sizeof *image);
}

typedef enum lensprof_sampling {
    LENSPROF_SAMPLING_BALANCED = 0, /* balanced over image pairs, radius and grey level; prefers smooth patches */
    LENSPROF_SAMPLING_PAPER = 1, /* d'Angelo 2007 section 5.1: 5n random points, 10 radius bins, n/10 lowest gradient */
    LENSPROF_SAMPLING_BRACKET = 2 /* balanced, without comparing the appearance of the two places, which differs near
                                     black and white. For pictures from a stationary camera */
} lensprof_sampling;

/* Result of comparing the texture of two overlapping images, after their cameras were corrected. */
typedef enum lensprof_link_state {
    LENSPROF_LINK_UNVERIFIED =
        0,                      /* too little texture to decide: pairs come from smooth places, by the cameras given */
    LENSPROF_LINK_VERIFIED = 1, /* the images show the same content where the cameras predict it */
    LENSPROF_LINK_CONTRADICTED = 2 /* they do not: no pairs come from this link */
} lensprof_link_state;

/* Two images that overlap. Frozen value struct. */
typedef struct lensprof_link {
    uint32_t image[2]; /* indices, the smaller one first */
    uint32_t state;    /* lensprof_link_state */
    uint32_t pairs;    /* pairs drawn from this link; for tracks, with the image that a track was started in */
} lensprof_link;

typedef struct lensprof_sample_options {
    uint32_t struct_size;
    uint32_t sampling; /* lensprof_sampling */
    uint32_t pairs; /* requested number of pairs, or of points with tracks; fewer are found if the overlaps do not hold
                       as many */
    uint32_t seed;  /* same seed, same pairs */
    uint32_t threads;           /* maximum number, including the caller's; 0 = one per core */
    uint32_t reserved;          /* 0 */
    lensprof_progress progress; /* or NULL; the fraction never decreases */
    void *progress_user;
    lensprof_link *links;   /* the caller's array of link_capacity, or NULL: receives the links of balanced sampling */
    uint32_t *link_count;   /* or NULL: receives the number of links, which may exceed link_capacity */
    uint32_t link_capacity; /* n images have at most n (n - 1) / 2 links */
    uint32_t reserved2;     /* 0 */
    const lensprof_response *response; /* response from a first fit or a profile, or NULL. With it, balanced sampling
                                          compares the light in two pictures instead of their grey values, which differ
                                          by more than a factor if exposures are far apart */
    const lensprof_vignetting *vignetting; /* falloff to remove from that light, if known; or NULL. The pairs hold the
                                              pictures' own grey values in any case */
    uint32_t *match_of_pair;               /* the caller's array of `capacity`, or NULL: receives, for each pair of
                                              lensprof_sample_matches, the index of the match where it was measured */
} lensprof_sample_options;

/* Balanced, 0 pairs (= 300 per image, or 150 points with tracks; at least 2000), seed 1, threads on all cores, no
 * progress callback. */
LENSPROF_API void lensprof_sample_options_init_sized(lensprof_sample_options *options, size_t size);
static inline void lensprof_sample_options_init(lensprof_sample_options *options) {
    lensprof_sample_options_init_sized(options, sizeof *options);
}

/* Finds correspondences between `image_count` pictures. Balanced sampling first corrects the cameras of neighbours, for
 * its own use, if the pictures show that they are some pixels off. It skips places whose surroundings differ in the two
 * pictures, and all places of two pictures that show almost nothing in common anywhere. pairs[capacity] and *count as
 * in base.h. The capacity to provide is the requested number, whatever the overlaps hold; asking for it samples
 * nothing. *count then receives the number found, which may be smaller. Errors: ARGUMENT for fewer than two images;
 * RESPONSE and VIGNETTING for an invalid response or falloff; NOT_FINITE for NaN in a float view (the text names image
 * and pixel); NO_OVERLAP; NO_SAMPLES if overlaps exist but every sample is masked, black or saturated, or shows
 * different content; CANCELLED; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_sample_overlap(const lensprof_sample_options *options,
                                                                       const lensprof_sample_image *images,
                                                                       uint32_t image_count, lensprof_pair *pairs,
                                                                       uint32_t capacity, uint32_t *count,
                                                                       lensprof_error *error);

/* Finds points seen in two or more pictures, each in up to 16 of them, for lensprof_fit_radiance. Balanced: spread
 * evenly over the area that the pictures cover, prefers the smoothest of neighbouring points, balanced over radius and
 * grey level, with the same corrections as lensprof_sample_overlap. Paper (Goldman & Chen 2005, section 5): uniform in
 * a cylindrical system, single points, the cameras as given. A channel that exceeds white in the whole patch is kept as
 * saturated, with the value 1; a patch that exceeds white only in part is not used. Every point has an observation that
 * is not saturated. observations[capacity] and *count, sorted by point, as for lensprof_sample_overlap. Errors: as
 * there. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_sample_tracks(
    const lensprof_sample_options *options, const lensprof_sample_image *images, uint32_t image_count,
    lensprof_observation *observations, uint32_t capacity, uint32_t *count, lensprof_error *error);

/* Two places in two images that show the same content, as found by feature matching. Frozen value struct. */
typedef struct lensprof_match {
    uint32_t image[2]; /* indices of two different images */
    double xy[2][2];   /* position in each, px of the full frame; the centre of the first pixel is (0, 0) */
    double map[2][2];  /* d xy[1] / d xy[0]: rotation and scale of the surroundings from the first image to the second,
                          from a homography or the shapes of two features; all 0 = unknown */
} lensprof_match;

/* Measures correspondences at places that are known to match. For a moving camera, where no set of cameras in images[]
 * explains all overlaps. Only width and height of the cameras are used. If a match has a map, the pair comes from the
 * smoothest place within 8 pixels of the first view along each axis, and only if the surroundings agree.
 * Otherwise it comes from the match itself. Links are verified by their matches, unless the surroundings contradict
 * them. Matches are selected with the balance of lensprof_sample_overlap, whatever options->sampling is; PAPER is
 * refused. Equal matches give equal pairs. pairs[capacity], *count and links as for lensprof_sample_overlap. Errors: as
 * there; an ARGUMENT error about a match names it in the ITEM: its images or places are not in images[], or the
 * determinant of its map is not positive and finite. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status
lensprof_sample_matches(const lensprof_sample_options *options, const lensprof_sample_image *images,
                        uint32_t image_count, const lensprof_match *matches, uint32_t match_count, lensprof_pair *pairs,
                        uint32_t capacity, uint32_t *count, lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
