/* lensprof/base.h - version, status codes, errors.
 *
 * Example: the error of a call, printed.
 *
 *     status = lensprof_store_open("lenses.db", LENSPROF_STORE_READ, &store, &error);
 *     if (status != LENSPROF_OK)
 *         fprintf(stderr, "lensprof %s: %s: %s\n", lensprof_version(), lensprof_status_name(status), error.text);
 *     lensprof_store_close(store);
 *
 * Rules for the whole API:
 *  - Every function that can fail returns lensprof_status. On error its outputs are unchanged.
 *  - A call that can fail for more than one reason also takes a caller-owned lensprof_error (may be NULL). It receives
 *    a sentence that names the offending item and the next step. There is no global or thread-local error state.
 *  - Input bytes are passed as `const void *data, size_t size`; data may be NULL if size is 0.
 *  - Results of variable length go to `buffer, capacity, *count`, in bytes for files and texts, otherwise in elements.
 *    *count receives the full length. With capacity 0 (the buffer may then be NULL) the call only sets *count and
 *    returns OK. Any other capacity that is too small is refused with CAPACITY: *count is set and nothing is written.
 *    The terminator of a text is not counted, and is written only if there is room for it; allocate *count + 1 bytes if
 *    you need it. count may be NULL if it counts bytes.
 *  - Extensible structs begin with `uint32_t struct_size`. Their `_init` function sets it to the size that the program
 *    was compiled with, and all other members to their defaults. Call it first, for output structs too. New members are
 *    appended. A library accepts every size from that of the struct's first version up to its own: members missing from
 *    an older program's struct take their defaults, and outputs are filled up to the program's struct_size, which does
 *    not change. Larger structs (the program is newer than the library) and smaller ones (_init was not called) are
 *    refused with STRUCT_SIZE. All elements of an array have the same struct_size, which is the stride of the array.
 *    Never assign such a struct between memory of the library and memory of the program.
 *  - lensprof_profile_key and lensprof_provenance are members of other structs. They have a fixed size, with reserved
 *    space (zero) for new members. Structs that the library owns and only shows (lensprof_import_entry,
 *    lensprof_store_fault) get new members at their end. All other public structs are frozen values.
 *  - Every header opens with an example, the body of a function. Variables that it does not declare are these:
 *        lensprof_status status; lensprof_error error; lensprof_profile profile; lensprof_profile_key key;
 *        lensprof_store *store; lensprof_camera cameras[3]; lensprof_image image, images[3], raw, jpeg;
 *        lensprof_target picture, pictures[3];
 *    image and picture, and images[i] and pictures[i], are views of the same pixels, 8 bit RGB; raw is a linear frame
 *    of 16 bits, and jpeg what the camera rendered of it.
 *  - Input and output live in the caller's buffers. The library keeps no reference after a call returns unless stated.
 *
 * Threads: everything declared here may be called from any thread at any time.
 */
#ifndef LENSPROF_BASE_H
#define LENSPROF_BASE_H

#include <stddef.h>
#include <stdint.h>

#define LENSPROF_VERSION_MAJOR 0
#define LENSPROF_VERSION_MINOR 3
#define LENSPROF_VERSION_PATCH 0

/* LENSPROF_EXPORTS: the library itself is compiled. Programs for Windows call functions of a DLL without a mark. */
#if defined(_WIN32) && defined(LENSPROF_EXPORTS)
#define LENSPROF_API __declspec(dllexport)
#elif defined(__GNUC__) && !defined(_WIN32)
#define LENSPROF_API __attribute__((visibility("default")))
#else
#define LENSPROF_API
#endif
#if defined(__GNUC__)
#define LENSPROF_MUST_USE __attribute__((warn_unused_result))
#else
#define LENSPROF_MUST_USE
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Values never change. Groups: 1-9 argument, 10-19 resource, 20-29 model or data, 30-39 fit, 40-49 store, 50-59 format,
 * 60-69 file, 90 internal. */
typedef enum lensprof_status {
    LENSPROF_OK = 0,
    LENSPROF_ERROR_ARGUMENT = 1,     /* NULL, unknown enum value, index out of range */
    LENSPROF_ERROR_STRUCT_SIZE = 2,  /* struct_size not set by an _init function, or set by a newer version */
    LENSPROF_ERROR_SIZE = 3,         /* zero or overflowing size, stride too small, tile outside the frame */
    LENSPROF_ERROR_CAPACITY = 4,     /* the caller's buffer is too small; the needed size is reported */
    LENSPROF_ERROR_NOT_FINITE = 5,   /* NaN or infinity where a finite number is required */
    LENSPROF_ERROR_MEMORY = 10,      /* out of memory */
    LENSPROF_ERROR_CANCELLED = 11,   /* the progress callback asked to stop */
    LENSPROF_ERROR_RESPONSE = 20,    /* not a response: decreasing, or its ends are not 0 and 1 */
    LENSPROF_ERROR_VIGNETTING = 21,  /* not a falloff: not positive over the whole frame */
    LENSPROF_ERROR_EXPOSURE = 22,    /* exposure or white balance is not positive and finite */
    LENSPROF_ERROR_GEOMETRY = 23,    /* camera that cannot be evaluated */
    LENSPROF_ERROR_NO_OVERLAP = 30,  /* no two images see the same point */
    LENSPROF_ERROR_NO_SAMPLES = 31,  /* images overlap, but every sample is saturated, black or masked */
    LENSPROF_ERROR_NO_UNKNOWNS = 32, /* no parameter is free */
    LENSPROF_ERROR_NOT_USABLE = 33,  /* the pictures do not suffice; the error text has the reason */
    LENSPROF_ERROR_STORE = 40,       /* the database could not be opened or used */
    LENSPROF_ERROR_NOT_FOUND = 41,   /* no such profile */
    LENSPROF_ERROR_CORRUPT = 42,     /* not a lensprof database or profile blob, or damaged */
    LENSPROF_ERROR_LAYOUT = 43,      /* written by a newer lensprof */
    LENSPROF_ERROR_READ_ONLY = 44,   /* the database cannot be written */
    LENSPROF_ERROR_FULL = 45,        /* no space left for the database */
    LENSPROF_ERROR_BUSY = 46,        /* another process holds the database */
    LENSPROF_ERROR_SYNTAX = 50,      /* malformed file; the error text gives the line */
    LENSPROF_ERROR_VARIABLE = 51,    /* unknown or unusable variable name on a `v` line */
    LENSPROF_ERROR_UNSUPPORTED = 52, /* valid, but not supported by this version */
    LENSPROF_ERROR_READ = 60,        /* a file cannot be read, or is not what it should be */
    LENSPROF_ERROR_WRITE = 61,       /* a file or folder cannot be written */
    LENSPROF_ERROR_INTERNAL = 90     /* a defect of lensprof; please report */
} lensprof_status;

typedef enum lensprof_item_kind {
    LENSPROF_ITEM_NONE = 0,
    LENSPROF_ITEM_IMAGE = 1,       /* index into the images of the call */
    LENSPROF_ITEM_PAIR = 2,        /* index into the pairs */
    LENSPROF_ITEM_OBSERVATION = 3, /* index into the observations */
    LENSPROF_ITEM_POINT = 4,       /* lensprof_observation.point */
    LENSPROF_ITEM_SHOT = 5,        /* lensprof_flat_image.shot */
    LENSPROF_ITEM_PROFILE = 6,     /* index into the profiles */
    LENSPROF_ITEM_FRAME = 7,       /* index into the frames */
    LENSPROF_ITEM_MATCH = 8        /* index into the matches */
} lensprof_item_kind;

/* The item that a text refers to by index, as in "image 3". A program with a better name can substitute it. Frozen
 * value struct; all zero if the text refers to no item. */
typedef struct lensprof_item {
    uint32_t kind;       /* lensprof_item_kind */
    uint32_t index;      /* from 0 */
    uint32_t text_begin; /* byte offset in the text where the item is named */
    uint32_t text_bytes; /* length of that name in bytes; 0 if the text was truncated before its end */
} lensprof_item;

/* The first error of a call. Frozen value struct. */
typedef struct lensprof_error {
    char text[256];     /* always terminated; empty if there is no error */
    lensprof_item item; /* the item that the text names */
} lensprof_error;

/* Called repeatedly, on the thread that made the call, with the fraction done (0..1). A non-zero return value cancels
 * the call, which then returns CANCELLED. */
typedef int (*lensprof_progress)(double done, void *user);

/* Name of a status, e.g. "LENSPROF_ERROR_SIZE"; "unknown status" for other values. Static storage. */
LENSPROF_API const char *lensprof_status_name(lensprof_status status);

/* Sets a struct of `size` bytes to zero, and its struct_size: what the _init functions of results call. */
LENSPROF_API void lensprof_init_sized(void *given, size_t size);

/* "0.3.0". Static storage. */
LENSPROF_API const char *lensprof_version(void);

#ifdef __cplusplus
}
#endif
#endif
