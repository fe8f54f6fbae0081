/* Extensible structs: the rule of struct_size (include/lensprof/base.h) in one place.
 *
 * A library accepts a program's struct of every size from that of the struct's first version up to its own. Inputs
 * are copied into the library's own struct, which holds the defaults; outputs are copied back up to the program's size.
 */
#ifndef LENSPROF_CORE_SIZED_H
#define LENSPROF_CORE_SIZED_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Bytes up to the end of a member. The size of a struct's first version is defined by its last member at that time,
 * which is also correct for 32-bit addresses. */
#define LP_END_OF(type, member) (offsetof(type, member) + sizeof(((type *)0)->member))

static inline uint32_t lp_sized_bytes(const void *given) {
    uint32_t bytes;
    memcpy(&bytes, given, sizeof bytes);
    return bytes;
}

/* Element `i` of a program's array of structs, whose stride is the struct_size of the first one. */
static inline const void *lp_sized_at(const void *array, size_t i) {
    return (const char *)array + i * lp_sized_bytes(array);
}

/* Whether this element has the struct_size of the first one, as all must have. */
static inline int lp_sized_is_alike(const void *array, size_t i) {
    return lp_sized_bytes(lp_sized_at(array, i)) == lp_sized_bytes(array);
}

/* Begins an _init_sized function: sets `size` bytes to zero, and struct_size. Returns whether the members of the
 * first version are present; a later member is present if `size` reaches its LP_END_OF. */
static inline int lp_sized_begin(void *given, size_t size, size_t first) {
    const uint32_t bytes = size <= UINT32_MAX ? (uint32_t)size : 0;
    if (size < sizeof bytes) return 0;
    memset(given, 0, size);
    memcpy(given, &bytes, sizeof bytes);
    return size >= first;
}

/* NULL if a struct of this library (`current_bytes`) is compatible with the given one, else why not and what to do. */
static inline const char *lp_sized_wrong(const void *given, size_t first, size_t current_bytes) {
    const uint32_t bytes = lp_sized_bytes(given);
    if (bytes < first) return "struct_size is not set; call the struct's _init function first";
    if (bytes > current_bytes)
        return "struct_size is that of a newer lensprof than this library; install the newer library";
    return NULL;
}

/* Copies the members that both have, except struct_size. */
static inline void lp_sized_copy(void *to, const void *from) {
    const uint32_t to_bytes = lp_sized_bytes(to), from_bytes = lp_sized_bytes(from), head = sizeof from_bytes;
    memcpy((char *)to + head, (const char *)from + head, (to_bytes < from_bytes ? to_bytes : from_bytes) - head);
}

/* Copies the given members into `target`, which is initialised. Returns NULL, or the error of lp_sized_wrong. */
static inline const char *lp_sized_take(void *target, const void *given, size_t first) {
    const char *wrong = lp_sized_wrong(given, first, lp_sized_bytes(target));
    if (!wrong) lp_sized_copy(target, given);
    return wrong;
}

#endif
