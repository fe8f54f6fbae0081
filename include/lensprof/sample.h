/* lensprof/sample.h - correspondences: the same scene point seen in two pictures.
 *
 * Threads: calls are independent of each other; the pictures are only read. One call uses as many threads as its
 * options say, all gone when it returns; the pairs do not depend on their number: same input, same bytes. */
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
    double xy[2][2];    /* position in each, px of the full frame */
    double value[2][3]; /* grey values 0..1: red, green, blue; grey pictures use [0] and repeat it */
} lensprof_pair;

/* One sight of a scene point. Observations of one `point` (any number, the same for all of them) are a track: two or
 * more, at most one an image. Frozen value struct. */
typedef struct lensprof_observation {
    uint32_t point;  /* the scene point */
    uint32_t image;  /* index */
    double xy[2];    /* position, px of the full frame */
    double value[3]; /* grey values 0..1: red, green, blue; with one channel [0]. Above 250/255 a value is taken for
                        saturated: the sensor received at least as much. Below half a level of 255: at most that */
} lensprof_observation;

/* A picture to sample. The view may be a reduced picture: pixel (u, v) is then the mean of the square of frame
 * pixels from (u, v) * reduction on, or of some pixels of it whose places vary from square to square. */
typedef struct lensprof_sample_image {
    uint32_t struct_size;
    uint32_t reduction;       /* side of that square, px; 1 = full size. view.width * reduction <= camera.width */
    uint32_t every_pixel;     /* 1: no pixel of a patch may be outside [black, white]; 0: its robust mean counts */
    uint32_t reserved;        /* 0 */
    lensprof_image view;      /* the frame, reduced or not; layouts with alpha: alpha below half = excluded */
    lensprof_camera camera;   /* full frame */
    const uint8_t *mask;      /* one byte a view pixel, 0 = excluded; NULL = all included */
    ptrdiff_t mask_row_bytes; /* at least the width of the view, or at most minus that; unused without a mask */
    double black, white;      /* samples outside [black, white] in any channel are not used; 0..1 */
} lensprof_sample_image;

/* Full size, robust means, no mask, 2/255 to 250/255; view and camera zero, to be set by the caller. */
LENSPROF_API void lensprof_sample_image_init_sized(lensprof_sample_image *image, size_t size);
static inline void lensprof_sample_image_init(lensprof_sample_image *image) {
    lensprof_sample_image_init_sized(image, sizeof *image);
}

typedef enum lensprof_sampling {
    LENSPROF_SAMPLING_BALANCED = 0, /* balanced over image pairs, radius and grey level; quiet patches preferred */
    LENSPROF_SAMPLING_PAPER = 1, /* d'Angelo 2007 section 5.1: 5n random points, 10 radius bins, n/10 lowest gradient */
    LENSPROF_SAMPLING_BRACKET = 2 /* balanced, without asking whether two places look alike: near black and white they
                                     do not. For pictures by a camera that did not move */
} lensprof_sampling;

/* What texture says of the cameras of two images that overlap, after they were corrected. */
typedef enum lensprof_link_state {
    LENSPROF_LINK_UNVERIFIED = 0, /* too little texture to say: pairs come from quiet places, by the cameras as given */
    LENSPROF_LINK_VERIFIED = 1,   /* the images show the same where the cameras have it */
    LENSPROF_LINK_CONTRADICTED = 2 /* they do not: no pairs come from this link */
} lensprof_link_state;

/* Two images that overlap. Frozen value struct. */
typedef struct lensprof_link {
    uint32_t image[2]; /* indices, the smaller one first */
    uint32_t state;    /* lensprof_link_state */
    uint32_t pairs;    /* drawn from this link; of tracks, with the image that a track was begun in */
} lensprof_link;

typedef struct lensprof_sample_options {
    uint32_t struct_size;
    uint32_t sampling; /* lensprof_sampling */
    uint32_t pairs;    /* wanted number of pairs, or of points with tracks; fewer come when the overlaps do not hold as
                          many */
    uint32_t seed;     /* same seed, same pairs */
    uint32_t threads;  /* at most so many, the caller's included; 0 = one a core */
    uint32_t reserved; /* 0 */
    lensprof_progress progress; /* or NULL; the fraction never falls */
    void *progress_user;
    lensprof_link *links;   /* the caller's array of link_capacity, or NULL: receives the links of balanced sampling, */
    uint32_t *link_count;   /* and this their number, which may be larger than what there was room for; or NULL */
    uint32_t link_capacity; /* n images have at most n (n - 1) / 2 links */
    uint32_t reserved2;     /* 0 */
    const lensprof_response *response; /* what a first fit or a profile knows of the camera, or NULL. With it balanced
                                          sampling compares the light in two pictures in place of their grey values,
                                          which differ in more than a factor where exposures are far apart, */
    const lensprof_vignetting *vignetting; /* without the falloff, where that is known; or NULL. The pairs hold the
                                              pictures' own grey values all the same. */
    uint32_t *match_of_pair;               /* the caller's array of `capacity`, or NULL: receives of each pair of
                                              lensprof_sample_matches the index of the match that it was measured at */
} lensprof_sample_options;

/* Balanced, 0 pairs (= 300 per image, or 150 points with tracks; at least 2000), seed 1, threads on all cores, no
 * progress. */
LENSPROF_API void lensprof_sample_options_init_sized(lensprof_sample_options *options, size_t size);
static inline void lensprof_sample_options_init(lensprof_sample_options *options) {
    lensprof_sample_options_init_sized(options, sizeof *options);
}

/* Finds correspondences between `image_count` pictures. Balanced sampling corrects the cameras first, between
 * neighbours and for its own use, where the pictures show that they are some pixels off, leaves out places whose
 * surroundings differ in the two, and all places of two pictures that hardly show the same anywhere. pairs[capacity]
 * and *count as in base.h: the capacity to give is the number wanted, whatever the overlaps hold, and nothing is
 * sampled to find it; then *count receives the number found, which may be smaller. Errors: fewer than two images
 * ARGUMENT; RESPONSE and VIGNETTING for a response or falloff that is not valid; NaN in a float view NOT_FINITE (the
 * text names image and pixel); NO_OVERLAP; NO_SAMPLES when overlaps exist but every sample is masked, black or
 * saturated, or does not show the same; CANCELLED; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_sample_overlap(const lensprof_sample_options *options,
                                                                       const lensprof_sample_image *images,
                                                                       uint32_t image_count, lensprof_pair *pairs,
                                                                       uint32_t capacity, uint32_t *count,
                                                                       lensprof_error *error);

/* Finds points that two pictures or more see, each in up to 16 of those that see it, for lensprof_fit_radiance.
 * Balanced: spread evenly over what the pictures see, of those near each other the quietest, balanced over radius and
 * grey level; with the same corrections as lensprof_sample_overlap. Paper (Goldman & Chen 2005, section 5): uniform in
 * a cylindrical system, single points, the cameras as they are. A channel above white in all of a patch has the value
 * 1: it is saturated, and that is kept; a patch partly above white is not used. Every point has an observation that is
 * not saturated. observations[capacity] and *count, sorted by point, as there. Errors: as lensprof_sample_overlap. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_sample_tracks(
    const lensprof_sample_options *options, const lensprof_sample_image *images, uint32_t image_count,
    lensprof_observation *observations, uint32_t capacity, uint32_t *count, lensprof_error *error);

/* Two places of two images that show the same, as feature matching finds them. Frozen value struct. */
typedef struct lensprof_match {
    uint32_t image[2]; /* indices of two different images */
    double xy[2][2];   /* position in each, px of the full frame; the middle of the first pixel is (0, 0) */
    double map[2][2];  /* d xy[1] / d xy[0]: how the surroundings are turned and scaled from the first image to the
                          second, as by a homography or the shapes of two features; all 0: not known */
} lensprof_match;

/* Measures correspondences at places that are known to match: of a camera that moved, where no cameras of images[]
 * explain all overlaps. Only width and height of the cameras are looked at. Where a match has a map, the pair comes
 * from the quietest of the places within 8 pixels of the first view along each axis, and only where the surroundings
 * are alike; otherwise from the match itself. Links are verified by their matches, unless their surroundings contradict
 * them. The choice among matches is balanced as lensprof_sample_overlap's, whatever options->sampling says except
 * paper, which is refused. Equal matches give equal pairs. pairs[capacity], *count and links as there. Errors: as
 * there; an ARGUMENT error about a match names it as its ITEM: its images or places are not of images[], or its map has
 * a determinant that is not positive and finite. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status
lensprof_sample_matches(const lensprof_sample_options *options, const lensprof_sample_image *images,
                        uint32_t image_count, const lensprof_match *matches, uint32_t match_count, lensprof_pair *pairs,
                        uint32_t capacity, uint32_t *count, lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
