/* lensprof/store.h - the profile database (SQLite).
 *
 * Every call is one transaction, or part of the caller's: it happens whole or not at all, also when the process is
 * killed or the power fails. The file is in write-ahead mode: readers and a writer do not hinder each other, and calls
 * wait up to 5 s for another writer (then BUSY). While it is open a -wal and a -shm lie beside it; the last to close
 * removes them. A file of an older layout is read as it is; the first call that writes brings it up to date, which
 * older versions then refuse. Threads: a handle belongs to one thread at a time; several processes may open the same
 * file. */
#ifndef LENSPROF_STORE_H
#define LENSPROF_STORE_H

#include "profile.h"
#include "reason.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct lensprof_store lensprof_store;

typedef enum lensprof_store_mode {
    LENSPROF_STORE_READ = 0,  /* the file must exist; nothing is written (but what a killed writer left is completed or
                               * undone); works on  read-only media, where the file was closed */
    LENSPROF_STORE_WRITE = 1, /* the file must exist */
    LENSPROF_STORE_CREATE = 2 /* write, and make the file when there is none */
} lensprof_store_mode;

/* Opens a database. *store is created and must be closed.
 * Errors (the text names the file): NOT_FOUND (also a missing folder), READ_ONLY, CORRUPT (not a lensprof database;
 * also an empty file unless it may be made), LAYOUT (made by a newer version), BUSY, FULL, STORE, MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_open(const char *path, uint32_t mode,
                                                                   lensprof_store **store, lensprof_error *error);
LENSPROF_API void lensprof_store_close(lensprof_store *store); /* NULL is allowed */

/* Adds a profile and sets *id (may be NULL). A profile with the same key stays: `find` returns the newest.
 * provenance.prior_id is an id of this database: who copies a profile from another one sets it to that of the copied
 * prior, or 0, as lensprof_store_merge does. Errors: what lensprof_profile_validate says; ARGUMENT for a profile of a
 * fit that was not usable (provenance.not_usable) unless provenance.forced is 1; RESPONSE for a table that is not the
 * curve of its kind and numbers; FULL also where ids are used up; and the store's. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_put(lensprof_store *store,
                                                                  const lensprof_profile *profile, int64_t *id,
                                                                  lensprof_error *error);

/* The newest profile whose key is equal, to an initialised *profile, and its *id (may be NULL) (texts ignoring ASCII
 * case and outer blanks; focal length, aperture, distance and colour temperature to 1e-6 relative; unknown equals
 * unknown only; the same processing). NOT_FOUND when there is none. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_find(lensprof_store *store,
                                                                   const lensprof_profile_key *key,
                                                                   lensprof_profile *profile, int64_t *id,
                                                                   lensprof_error *error);

/* What stands for a focus distance that is not known. */
typedef enum lensprof_distance_rule {
    LENSPROF_DISTANCE_WEAKEST = 0,  /* of the falloffs at all stored distances the weakest, radius by radius: what is
                                       taken out was there, whatever the distance */
    LENSPROF_DISTANCE_FARTHEST = 1, /* that at the farthest one */
    LENSPROF_DISTANCE_USUAL = 2     /* the mean over the distances of most photographs (docs/database.md) */
} lensprof_distance_rule;

typedef struct lensprof_lookup_options {
    uint32_t struct_size;
    uint32_t distance_rule;  /* lensprof_distance_rule */
    uint32_t with_doubt;     /* 1: profiles with a doubt (provenance) count as others do; 0: only those of which the
                                response alone is in doubt */
    uint32_t any_processing; /* 1: the key's processing does not matter; 0: see lensprof_store_lookup */
    uint32_t force_falloff;  /* 1: falloffs of uncorrected pictures for keys that are CORRECTED, too; 0: not */
    uint32_t
        response_alone; /* 1: where there is no falloff for the key, but the camera has profiles, its response
                           without a falloff is the answer, as a prior of fits: `rows` is 0; 0: that is NOT_FOUND */
} lensprof_lookup_options;

/* USUAL, without doubt, falloffs of the key's processing. */
LENSPROF_API void lensprof_lookup_options_init_sized(lensprof_lookup_options *options, size_t size);
static inline void lensprof_lookup_options_init(lensprof_lookup_options *options) {
    lensprof_lookup_options_init_sized(options, sizeof *options);
}

#define LENSPROF_LOOKUP_ROWS 24
#define LENSPROF_LOOKUP_REASONS 8
#define LENSPROF_LOOKUP_RESPONSES 8

/* Where the response of a lookup's answer is from. */
typedef enum lensprof_response_from {
    LENSPROF_RESPONSE_FROM_PROFILE = 0, /* the stored profile that is the answer */
    LENSPROF_RESPONSE_FROM_CAMERA = 1,  /* profiles of the camera, whatever their lens: their weighted mean */
    LENSPROF_RESPONSE_FROM_KIND = 2,    /* the typical response of the kind of camera (model.h) */
    LENSPROF_RESPONSE_FROM_RAW = 3      /* linear, as sensor data are */
} lensprof_response_from;

/* How a lookup came to its answer. Standard errors are 68 % bands; those of M are of its value in the corner. */
typedef struct lensprof_lookup {
    uint32_t struct_size;
    uint32_t exact;                      /* 1: a stored profile, as it is */
    uint32_t rows;                       /* profiles the falloff is from, 1..LENSPROF_LOOKUP_ROWS */
    uint32_t reserved;                   /* 0 */
    int64_t id[LENSPROF_LOOKUP_ROWS];    /* of them, nearest first */
    double weight[LENSPROF_LOOKUP_ROWS]; /* of each; they add up to about 1, and may be below 0 */
    double distance; /* from the setting to the nearest one; 0 = the same, refused beyond 0.5: two stops from wide
                        open, a factor 2 in focal length, 0.4 m focus against infinity */
    double sigma;    /* standard error of M, of the worst curve: the four below together; LENSPROF_UNKNOWN for an exact
                        one without covariance */
    double name_score; /* of the lens's name (of the camera's, where no lens was asked for): 1 the same but for case and
                          outer blanks, 0.9 but for signs and blanks, 0.8 but for a maker in front or its spelling, or
                          a camera's name in another country; 0.6 the same words in another order or form, all
                          numbers and generations the same, where nothing better is stored; 0.5 and words that say
                          nothing of the lens are missing in one */
    char reason[256];  /* cautions, whole sentences as far as they fit; where nothing is found, why */
    uint32_t reason_code[LENSPROF_LOOKUP_REASONS]; /* lensprof_reason of each sentence, in their order, also of those
                                                      that `reason` has no room for; NONE after the last. The numbers
                                                      are the other members */
    double falloff_sigma;    /* standard error of M by the profiles and by how far away they are */
    double distance_sigma;   /* by the focus distance, where it is not known; else 0 */
    double sensor_sigma;     /* by the sensor's size, where it is not known; else 0 */
    double response_sigma;   /* standard error of ln gamma of the response; in M it is M |ln M| times that.
                                LENSPROF_UNKNOWN for an exact one of which it is not known */
    uint32_t response_from;  /* lensprof_response_from */
    uint32_t camera_kind;    /* lensprof_camera_kind of the key */
    uint32_t falloff_store;  /* index of the database that the falloff is from */
    uint32_t response_store; /* and of that of the response, where it is from profiles */
    uint32_t response_rows;  /* profiles the response is from, 0..LENSPROF_LOOKUP_RESPONSES */
    uint32_t reserved2;      /* 0 */
    int64_t response_id[LENSPROF_LOOKUP_RESPONSES];
    double response_weight[LENSPROF_LOOKUP_RESPONSES]; /* of each; they add up to 1 */
} lensprof_lookup;

/* All zero. */
LENSPROF_API void lensprof_lookup_init_sized(lensprof_lookup *lookup, size_t size);
static inline void lensprof_lookup_init(lensprof_lookup *lookup) { lensprof_lookup_init_sized(lookup, sizeof *lookup); }

/* The profile for a setting, composed of two kinds of knowledge (docs/database.md says how).
 * The falloff is the lens's: that of a stored profile, or predicted from those of the same lens at other settings; raw
 * or rendered, light falls off the same, but what the camera has corrected (CORRECTED) is only like itself. The lens's
 * name decides, then the unit, camera and sensor - without a lens the camera, whose profiles without a lens, or of its
 * only lens, count (their focal lengths to 2 % or 0.1 mm, for such cameras round them). Profiles of the key's unit come
 * before those of any, of its camera before those of a lens alone and of other cameras; of these, those of the smallest
 * sensor that is not smaller than the key's, their radii rescaled, and of the smallest of all where the key's is not
 * known. Where the best have none near the setting, the next best serve.
 * The response is the camera's: linear for RAW, else the mean of the responses of the camera's profiles of rendered
 * pictures, of the key's picture style before those of none, whatever the lens; where there are none, the typical one
 * of the kind of camera. A profile that is stored for all of it is the answer as it is. Else it has key `key`, no gain
 * grid, provenance method "lookup", and a covariance of both parts. Nothing is written. NOT_FOUND, with *lookup filled
 * as far as it goes, where there is no such lens, or nothing near enough; profile is then untouched. Both are
 * initialised ones. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_lookup(lensprof_store *store,
                                                                     const lensprof_profile_key *key,
                                                                     const lensprof_lookup_options *options,
                                                                     lensprof_profile *profile, lensprof_lookup *lookup,
                                                                     lensprof_error *error);

/* The same in stores[count], count > 0: the falloff from the first that has one for the key, the response from the
 * first that has profiles of the camera. The reason of a refusal is that of the first that knows the lens. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_lookup_in(lensprof_store *const *stores, uint32_t count,
                                                                        const lensprof_profile_key *key,
                                                                        const lensprof_lookup_options *options,
                                                                        lensprof_profile *profile,
                                                                        lensprof_lookup *lookup, lensprof_error *error);

/* From here to commit or rollback all calls on this handle are one transaction, which makes thousands of them fast.
 * Closing the store rolls back. Errors: READ_ONLY, BUSY, ... ; ARGUMENT for a second begin, or an end without one. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_begin(lensprof_store *store, lensprof_error *error);
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_commit(lensprof_store *store, lensprof_error *error);
LENSPROF_API void lensprof_store_rollback(lensprof_store *store);

/* The profile with an id, to an initialised *profile. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_get(lensprof_store *store, int64_t id,
                                                                  lensprof_profile *profile, lensprof_error *error);

/* A row of a listing. Frozen value struct. */
typedef struct lensprof_store_row {
    int64_t id;
    uint32_t damaged;     /* 1: the row has impossible values; its key and provenance are then unknown */
    uint32_t reserved[3]; /* 0 */
    lensprof_profile_key key;
    lensprof_provenance provenance;
} lensprof_store_row;

/* Lists profiles in the order camera maker, model, lens, focal, aperture, distance, id. Where filter (may be NULL) has
 * a text or a known number, only equal ones; its processing does not matter. rows[capacity] and
 * *count as in base.h. A row whose key or
 * provenance cannot be read does not end the list: it is a row with `damaged` 1 and its id. lensprof_store_get reports
 * what is wrong with it; lensprof_store_check finds damage in the rest of a profile, too. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_list(lensprof_store *store,
                                                                   const lensprof_profile_key *filter,
                                                                   lensprof_store_row *rows, uint32_t capacity,
                                                                   uint32_t *count, lensprof_error *error);

/* Whether a profile is stored already: *id receives that of one with the same key, content and provenance, whatever its
 * method, software, prior and forced, or 0. Numbers must be equal; of responses those that their kind has. For those
 * who import, before a put: the store must be open for writing. Errors: what lensprof_profile_validate says; the
 * store's. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_find_same(lensprof_store *store,
                                                                        const lensprof_profile *profile, int64_t *id,
                                                                        lensprof_error *error);

/* Adds every profile of `other`, another open database, that lensprof_store_find_same does not find, the oldest first,
 * with its provenance as it is; but prior_id becomes the id that the prior has here, 0 where it is not here. A known
 * profile keeps its provenance, but gets a prior_id from the other database where it has none. All or none, and never
 * twice: merged again, nothing is added. *added and *known (may be NULL) receive how many were and how many were there.
 * Cameras that are not there by maker, model and variant are added, too; they do not count.
 * `other` is only read, whatever its layout. Errors: ARGUMENT for the database itself; what lensprof_store_put and, of
 * `other`, lensprof_store_get say: the text names the file and the damaged profile. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_merge(lensprof_store *store, lensprof_store *other,
                                                                    uint32_t *added, uint32_t *known,
                                                                    lensprof_error *error);

/* Stores a camera, in place of the one with the same maker, model and variant (to the letter) where there is one.
 * Errors: ARGUMENT for what lensprof_camera_model_validate refuses; the store's. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_put_camera(lensprof_store *store,
                                                                         const lensprof_camera_model *camera,
                                                                         lensprof_error *error);

/* The camera of a name, as EXIF has it or as people call it: case, signs, a maker in front, the spelling of the maker
 * and names in other countries do not matter; the maker may be empty. Where several have the name, what they do not
 * agree on is unknown. NOT_FOUND, with *camera untouched, where there is none. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_find_camera(lensprof_store *store, const char *maker,
                                                                          const char *model,
                                                                          lensprof_camera_model *camera,
                                                                          lensprof_error *error);

/* Lists the whole table of cameras by maker, model and variant. cameras[capacity] and *count as in base.h. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_list_camera_models(lensprof_store *store,
                                                                                 lensprof_camera_model *cameras,
                                                                                 uint32_t capacity, uint32_t *count,
                                                                                 lensprof_error *error);

/* Something that is wrong in a database. */
typedef struct lensprof_store_fault {
    int64_t id;       /* of the profile; 0 = of the file as a whole */
    char reason[256]; /* in words, or as SQLite says it */
} lensprof_store_fault;

/* Receives the faults: those of the file, rows without their profile, then damaged profiles by id. It makes no call on
 * the store. Anything but OK ends the check and is what it returns. */
typedef lensprof_status (*lensprof_fault_visitor)(void *user, const lensprof_store_fault *fault);

/* Reads everything and checks it: SQLite's integrity_check, foreign keys, and every profile as lensprof_store_get does
 * (types, ranges, finite numbers, monotone responses, positive falloffs, symmetric covariance), so that a row may be
 * named more than once. *profiles and *faults (may be NULL) receive how many there are; faults are no error. One
 * transaction, which writes nothing. visit may be NULL. Errors: the store's, but not for damage that it could get
 * past; what the visitor returns. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_check(lensprof_store *store, lensprof_fault_visitor visit,
                                                                    void *user, uint32_t *profiles, uint32_t *faults,
                                                                    lensprof_error *error);

#define LENSPROF_STATS_GROUPS 8

/* Profiles with the same text. */
typedef struct lensprof_store_group {
    char name[256];
    uint32_t profiles; /* 0 beyond the last group */
    uint32_t reserved; /* 0 */
} lensprof_store_group;

/* What is in a database. Names that differ in ASCII case or outer blanks are one. */
typedef struct lensprof_store_stats {
    uint32_t struct_size;
    uint32_t layout; /* number of profiles/schema */
    uint32_t profiles;
    uint32_t cameras, lenses, units;                 /* different ones that are known */
    uint32_t processing[3];                          /* profiles, by lensprof_processing */
    uint32_t with_covariance, with_grid, with_doubt; /* profiles */
    uint32_t methods, sources;                       /* different ones */
    double focal_mm[2]; /* smallest and largest that is known; LENSPROF_UNKNOWN where none is */
    double aperture[2];
    double distance_m[2];
    lensprof_store_group method[LENSPROF_STATS_GROUPS]; /* those with the most profiles, largest first */
    lensprof_store_group source[LENSPROF_STATS_GROUPS];
    int64_t bytes; /* of the file, what a log beside it holds included */
} lensprof_store_stats;

/* All zero. */
LENSPROF_API void lensprof_store_stats_init_sized(lensprof_store_stats *stats, size_t size);
static inline void lensprof_store_stats_init(lensprof_store_stats *stats) {
    lensprof_store_stats_init_sized(stats, sizeof *stats);
}

/* To an initialised *stats. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_get_stats(lensprof_store *store,
                                                                        lensprof_store_stats *stats,
                                                                        lensprof_error *error);

/* Removes the profile with an id; NOT_FOUND when there is none. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_remove(lensprof_store *store, int64_t id,
                                                                     lensprof_error *error);

/* Gives the stored profile with an id another key; what it holds, its provenance and its id stay. Errors: NOT_FOUND;
 * ARGUMENT for a key that is not valid. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_set_key(lensprof_store *store, int64_t id,
                                                                      const lensprof_profile_key *key,
                                                                      lensprof_error *error);

/* A lens or a camera, and what is stored of it. Frozen value struct. */
typedef struct lensprof_store_summary {
    char camera_maker[64]; /* empty in a list of lenses */
    char camera_model[64];
    char lens[128];         /* empty in a list of cameras */
    uint32_t profiles;      /* of it */
    uint32_t others;        /* different cameras that are named with a lens, or lenses with a camera */
    uint32_t processing[3]; /* profiles, by lensprof_processing */
    uint32_t reserved;      /* 0 */
    double focal_mm[2];     /* smallest and largest that is known; LENSPROF_UNKNOWN where none is */
    double aperture[2];
    double distance_m[2];
} lensprof_store_summary;

/* The lenses, or the cameras, of the stored profiles, in the order of their names. `part` (NULL or blanks: all) is a
 * name as lookups take it; where no name is that, the words of `part`, each anywhere in the maker and name, without
 * ASCII case, blanks and signs. rows[capacity] and *count as in base.h. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_list_lenses(lensprof_store *store, const char *part,
                                                                          lensprof_store_summary *rows,
                                                                          uint32_t capacity, uint32_t *count,
                                                                          lensprof_error *error);
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_list_cameras(lensprof_store *store, const char *part,
                                                                           lensprof_store_summary *rows,
                                                                           uint32_t capacity, uint32_t *count,
                                                                           lensprof_error *error);

/* The name of a lens, and how near it is to one that was asked for. Frozen value struct. */
typedef struct lensprof_store_name {
    char lens[128]; /* as it is stored */
    double score;   /* 0..1: share of the words that both names have, focal lengths and f-numbers counting most */
} lensprof_store_name;

/* The stored lenses whose names are nearest to key->lens (key->camera_maker counts as the lens's maker where it names
 * none), nearest first: for a lens that a lookup did not find. names[most]; *count receives how many were written,
 * fewer where no more are near at all. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_nearest_lenses(lensprof_store *store,
                                                                             const lensprof_profile_key *key,
                                                                             lensprof_store_name *names, uint32_t most,
                                                                             uint32_t *count, lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
