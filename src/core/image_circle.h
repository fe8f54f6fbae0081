/* The columns of a row in an image circle, for kernels. */
#ifndef LENSPROF_CORE_IMAGE_CIRCLE_H
#define LENSPROF_CORE_IMAGE_CIRCLE_H

#include <lensprof/model.h>

/* Pixels first..end - 1 of row y lie in the circle, which exists; the same as lensprof_image_circle_contains. */
void lp_image_circle_columns(const lensprof_image_circle *circle, uint32_t width, uint32_t height, uint32_t y,
                             uint32_t *first, uint32_t *end);

#endif
