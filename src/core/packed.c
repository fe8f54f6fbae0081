/* Samples packed in groups of bytes, and plans applied to them through a short buffer (lensprof/packed.h). */
#include "core/packed.h"

#define CHUNK 64 /* samples between unpacking and packing: 128 bytes of stack; whole groups of every packing */

/* ---- groups ---- */

/* Samples of a group, which takes group_of(packing) * packing / 8 bytes; 0 if the packing is unknown. */
static uint32_t group_of(uint32_t packing) {
    if (packing == LENSPROF_PACKING_RAW10 || packing == LENSPROF_PACKING_RAW14) return 4;
    return packing == LENSPROF_PACKING_RAW8 ? 1 : packing == LENSPROF_PACKING_RAW12 ? 2 : 0;
}

/* The high bytes of a group, then its low bits, 24 at most, as one little-endian number. */
static void unpack(uint32_t packing, const uint8_t *packed, uint32_t width, uint16_t *samples) {
    const uint32_t group = group_of(packing), bytes = group * packing / 8, bits = packing - 8;
    for (; width; width -= group, packed += bytes, samples += group) {
        uint32_t low = 0;
        for (uint32_t i = bytes; i-- > group;) low = low << 8 | packed[i];
        for (uint32_t i = 0; i < group; i++, low >>= bits)
            samples[i] = (uint16_t)((uint32_t)packed[i] << bits | (low & ((1u << bits) - 1)));
    }
}

static void pack(uint32_t packing, const uint16_t *samples, uint32_t width, uint8_t *packed) {
    const uint32_t group = group_of(packing), bytes = group * packing / 8, bits = packing - 8;
    const uint32_t largest = (1u << packing) - 1;
    for (; width; width -= group, packed += bytes, samples += group) {
        uint32_t low = 0;
        for (uint32_t i = group; i-- > 0;) {
            const uint32_t code = samples[i] < largest ? samples[i] : largest;
            packed[i] = (uint8_t)(code >> bits);
            low = low << bits | (code & ((1u << bits) - 1));
        }
        for (uint32_t i = group; i < bytes; i++, low >>= 8) packed[i] = (uint8_t)low;
    }
}

/* ---- rows ---- */

size_t lensprof_packed_row_bytes(uint32_t packing, uint32_t width) {
    const uint32_t group = group_of(packing);
    return !group || width > LP_LARGEST_SIDE || width % group ? 0 : (size_t)(width / group) * (group * packing / 8);
}

static lensprof_status validate_row(uint32_t packing, uint32_t width, const void *packed, const void *samples) {
    if (!packed || !samples || !group_of(packing)) return LENSPROF_ERROR_ARGUMENT;
    return lensprof_packed_row_bytes(packing, width) ? LENSPROF_OK : LENSPROF_ERROR_SIZE;
}

lensprof_status lensprof_unpack_row(uint32_t packing, const uint8_t *packed, uint32_t width, uint16_t *samples) {
    const lensprof_status status = validate_row(packing, width, packed, samples);
    if (status == LENSPROF_OK) unpack(packing, packed, width, samples);
    return status;
}

lensprof_status lensprof_pack_row(uint32_t packing, const uint16_t *samples, uint32_t width, uint8_t *packed) {
    const lensprof_status status = validate_row(packing, width, packed, samples);
    if (status == LENSPROF_OK) pack(packing, samples, width, packed);
    return status;
}

/* ---- tiles ---- */

/* A view with one byte per sample, which the checks of views accept. */
static lensprof_image bytes_of(const lensprof_packed_image *view) {
    return (lensprof_image){view->data,   view->row_bytes,    view->width,
                            view->height, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_GREY};
}

/* Whether rows of this many bytes do not overlap each other. */
static int holds_rows(const lensprof_image *view, size_t bytes) {
    return view->height == 1 || (size_t)(view->row_bytes < 0 ? -view->row_bytes : view->row_bytes) >= bytes;
}

/* With one byte per sample the views are compared with the frame, then with all their bytes with each other. */
static lensprof_status validate_tile(const lp_packed_plan *plan, uint32_t packing, lensprof_image source,
                                     lensprof_image target, uint32_t x0, uint32_t y0) {
    if (!group_of(packing) || (plan->layout != LENSPROF_LAYOUT_GREY && !lp_is_mosaic(plan->layout)))
        return LENSPROF_ERROR_ARGUMENT;
    const lp_tiles tiles = {LENSPROF_SAMPLE_U8, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_GREY, plan->frame_width,
                            plan->frame_height};
    const lensprof_status status = lp_tile_validate(&tiles, &source, &target, x0, y0);
    if (status != LENSPROF_OK) return status;
    const size_t bytes = lensprof_packed_row_bytes(packing, target.width);
    if (!bytes || !holds_rows(&source, bytes) || !holds_rows(&target, bytes)) return LENSPROF_ERROR_SIZE;
    if (source.data == target.data && source.row_bytes == target.row_bytes) return LENSPROF_OK;
    source.width = target.width = (uint32_t)bytes;
    return lp_images_overlap(&source, &target) ? LENSPROF_ERROR_ARGUMENT : LENSPROF_OK;
}

static lensprof_status apply_row(const lp_packed_plan *plan, uint32_t packing, const uint8_t *from, uint8_t *to,
                                 uint32_t width, uint32_t x0, uint32_t y0) {
    uint16_t samples[CHUNK];
    lensprof_target chunk = {samples, 0, CHUNK, 1, LENSPROF_SAMPLE_U16, plan->layout};
    lensprof_status status = LENSPROF_OK;
    for (uint32_t x = 0; status == LENSPROF_OK && x < width; x += CHUNK) {
        const size_t before = (size_t)(x / 8) * packing; /* bytes */
        if (width - x < CHUNK) chunk.width = width - x;
        unpack(packing, from + before, chunk.width, samples);
        status = plan->apply(plan->plan, &chunk, x0 + x, y0);
        if (status == LENSPROF_OK) pack(packing, samples, chunk.width, to + before);
    }
    return status;
}

lensprof_status lp_apply_packed(const lp_packed_plan *plan, uint32_t packing, const lensprof_packed_image *source,
                                const lensprof_packed_target *target, uint32_t x0, uint32_t y0) {
    if (!target) return LENSPROF_ERROR_ARGUMENT;
    const lensprof_packed_image in_place = {target->data, target->row_bytes, target->width, target->height};
    if (!source) source = &in_place;
    lensprof_status status = validate_tile(plan, packing, bytes_of(source), bytes_of(&in_place), x0, y0);
    for (uint32_t y = 0; status == LENSPROF_OK && y < target->height; y++)
        status = apply_row(plan, packing, (const uint8_t *)source->data + (ptrdiff_t)y * source->row_bytes,
                           (uint8_t *)target->data + (ptrdiff_t)y * target->row_bytes, target->width, x0, y0 + y);
    return status;
}
