/* lensprof/store.h - the profile database (SQLite), and pictures corrected by what it holds.
 *
 * Example: a picture corrected with a stored lens, in place.
 *
 *     lensprof_profile_key_init(&key), lensprof_profile_init(&profile); // the rest of the key stays unknown
 *     strcpy(key.lens, "Acme 50mm f/1.8"), key.focal_mm = 50, key.aperture = 2.8, key.crop_factor = 1.5;
 *     status = lensprof_store_open("lenses.db", LENSPROF_STORE_READ, &store, &error);
 *     if (status == LENSPROF_OK) status = lensprof_store_lookup(store, &key, NULL, &profile, NULL, &error);
 *     if (status == LENSPROF_OK) status = lensprof_correct(&profile, NULL, &picture, &error);
 *     lensprof_store_close(store);
 *
 * Every call is one transaction, or part of the caller's transaction. It is atomic, even if the process is killed or
 * the power fails. The file is in write-ahead mode: readers and a writer do not block each other, and a call waits up
 * to 5 s for another writer (then BUSY). While the database is open, a -wal and a -shm file exist next to it; the last
 * process to close it removes them. A file of an older layout is read as it is. The first call that writes upgrades it;
 * older versions then refuse it. Threads: a handle belongs to one thread at a time; several processes may open the same
 * file. */
#ifndef LENSPROF_STORE_H
#define LENSPROF_STORE_H

#include "apply.h"
#include "profile.h"
#include "reason.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct lensprof_store lensprof_store;

typedef enum lensprof_store_mode {
    LENSPROF_STORE_READ = 0, /* the file must exist; nothing is written (but the work of a killed writer is completed or
                              * undone); works on read-only media if the file was closed properly */
    LENSPROF_STORE_WRITE = 1, /* the file must exist */
    LENSPROF_STORE_CREATE = 2 /* write; creates the file if it does not exist */
} lensprof_store_mode;

/* Opens a database. Creates *store, which must be closed.
 * Errors (the text names the file): NOT_FOUND (also for a missing folder), READ_ONLY, CORRUPT (not a lensprof database;
 * also an empty file, except in mode CREATE), LAYOUT (made by a newer version), BUSY, FULL, STORE, MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_open(const char *path, uint32_t mode,
                                                                   lensprof_store **store, lensprof_error *error);
LENSPROF_API void lensprof_store_close(lensprof_store *store); /* NULL is allowed */

/* Adds a profile and sets *id (may be NULL). Profiles with the same key stay; lensprof_store_find returns the newest.
 * provenance.prior_id is an id of this database: when you copy a profile from another database, set it to the id of the
 * copied prior, or to 0, as lensprof_store_merge does. Errors: those of lensprof_profile_validate; ARGUMENT for a
 * profile of a fit that was not usable (provenance.not_usable) unless provenance.forced is 1; RESPONSE for a table that
 * does not match its kind and parameters; FULL, also if all ids are used; those of the store. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_put(lensprof_store *store,
                                                                  const lensprof_profile *profile, int64_t *id,
                                                                  lensprof_error *error);

/* Copies the newest profile with an equal key to an initialised *profile, and its id to *id (may be NULL). Texts are
 * compared without ASCII case and outer blanks; focal length, aperture, distance and colour temperature to 1e-6
 * relative; unknown equals only unknown; processing must be the same. NOT_FOUND if no profile matches. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_find(lensprof_store *store,
                                                                   const lensprof_profile_key *key,
                                                                   lensprof_profile *profile, int64_t *id,
                                                                   lensprof_error *error);

/* What to use if the focus distance is unknown. */
typedef enum lensprof_distance_rule {
    LENSPROF_DISTANCE_USUAL = 0,   /* the mean over the distances of most photographs (docs/database.md) */
    LENSPROF_DISTANCE_WEAKEST = 1, /* the weakest of the falloffs at all stored distances, radius by radius: never
                                      corrects too much, whatever the distance */
    LENSPROF_DISTANCE_FARTHEST = 2 /* the falloff at the farthest stored distance */
} lensprof_distance_rule;

typedef struct lensprof_lookup_options {
    uint32_t struct_size;
    uint32_t distance_rule;  /* lensprof_distance_rule */
    uint32_t with_doubt;     /* 1: use profiles with a doubt (provenance) like others; 0: use them only if the doubt
                                concerns the response alone */
    uint32_t any_processing; /* 1: ignore the processing of the key; 0: see lensprof_store_lookup */
    uint32_t force_falloff;  /* 1: use falloffs of uncorrected pictures for CORRECTED keys as well; 0: do not */
    uint32_t response_alone; /* 1: if there is no falloff for the key, but profiles of the camera, return their response
                                without a falloff, as a prior of fits, with `rows` 0; 0: that is NOT_FOUND */
} lensprof_lookup_options;

/* USUAL, without doubt, falloffs of the key's processing. */
static inline void lensprof_lookup_options_init(lensprof_lookup_options *options) {
    lensprof_init_sized(options, sizeof *options);
}

#define LENSPROF_LOOKUP_ROWS 24
#define LENSPROF_LOOKUP_REASONS 8
#define LENSPROF_LOOKUP_RESPONSES 8
#define LENSPROF_LOOKUP_NEAREST 3

/* Origin of the response in the answer of a lookup. */
typedef enum lensprof_response_from {
    LENSPROF_RESPONSE_FROM_PROFILE = 0, /* the stored profile that is the answer */
    LENSPROF_RESPONSE_FROM_CAMERA = 1,  /* weighted mean of the profiles of the camera, with any lens */
    LENSPROF_RESPONSE_FROM_KIND = 2,    /* the typical response of the kind of camera (model.h) */
    LENSPROF_RESPONSE_FROM_RAW = 3      /* linear, as sensor data is */
} lensprof_response_from;

/* How a lookup found its answer. Standard errors are 68 % bands; those of M apply in the corner. */
typedef struct lensprof_lookup {
    uint32_t struct_size;
    uint32_t exact;                      /* 1: the answer is a stored profile, unchanged */
    uint32_t rows;                       /* number of profiles used for the falloff, 1..LENSPROF_LOOKUP_ROWS */
    uint32_t reserved;                   /* 0 */
    int64_t id[LENSPROF_LOOKUP_ROWS];    /* their ids, nearest first */
    double weight[LENSPROF_LOOKUP_ROWS]; /* their weights; they sum to about 1; some may be negative */
    double distance; /* from the setting to the nearest profile: 0 = the same; refused beyond 0.5, which is two stops
                        from wide open, a factor 2 in focal length, or 0.4 m focus against infinity */
    double sigma;    /* standard error of M for the worst curve: the four below combined; LENSPROF_UNKNOWN for an exact
                        answer without covariance */
    double name_score; /* match of the lens name (of the camera name if no lens was given): 1 equal except for case and
                          outer blanks; 0.9 except for signs and blanks; 0.8 except for a leading maker, its spelling,
                          or the name of a camera in another country; 0.6 the same words in another order or form, with
                          all numbers and generations equal, if nothing better is stored; 0.5 also words missing in one
                          name that do not identify the lens */
    char reason[256];  /* warnings, as many whole sentences as fit; if nothing is found, why */
    uint32_t reason_code[LENSPROF_LOOKUP_REASONS]; /* lensprof_reason of each sentence, in order, including those that
                                                      do not fit in `reason`; NONE after the last. Their numbers are the
                                                      other members */
    double falloff_sigma;    /* standard error of M due to the profiles and their distance from the setting */
    double distance_sigma;   /* due to an unknown focus distance; otherwise 0 */
    double sensor_sigma;     /* due to an unknown sensor size; otherwise 0 */
    double response_sigma;   /* standard error of ln gamma of the response; its effect on M is M |ln M| times that.
                                LENSPROF_UNKNOWN for an exact answer that does not have it */
    uint32_t response_from;  /* lensprof_response_from */
    uint32_t camera_kind;    /* lensprof_camera_kind of the key */
    uint32_t falloff_store;  /* index of the database that has the falloff */
    uint32_t response_store; /* index of the database that has the response, if that is from profiles */
    uint32_t response_rows;  /* number of profiles used for the response, 0..LENSPROF_LOOKUP_RESPONSES */
    uint32_t reserved2;      /* 0 */
    int64_t response_id[LENSPROF_LOOKUP_RESPONSES];
    double response_weight[LENSPROF_LOOKUP_RESPONSES]; /* their weights; they sum to 1 */
    char nearest[LENSPROF_LOOKUP_NEAREST][128]; /* if no lens has the name: the lenses with the most similar names,
                                                   nearest first; empty after the last */
} lensprof_lookup;

/* All zero. */
static inline void lensprof_lookup_init(lensprof_lookup *lookup) { lensprof_init_sized(lookup, sizeof *lookup); }

/* Composes the profile for a setting from a falloff and a response (docs/database.md has the details).
 * The falloff depends on the lens: it is that of a stored profile, or is predicted from profiles of the same lens at
 * other settings. Raw and rendered pictures have the same falloff; pictures corrected by the camera (CORRECTED) match
 * only each other. The name of the lens selects first, then unit, camera and sensor. Without a lens the camera selects:
 * its profiles without a lens, or with its only lens, are used (focal lengths within 2 % or 0.1 mm, as such cameras
 * round them). Profiles of the key's unit precede those of any unit; those of its camera precede those of a lens alone,
 * which precede those of other cameras. Of the remaining ones, those of the smallest sensor not smaller than the key's
 * are used, with radii rescaled; if the key's is unknown, those of the smallest of all. If the best candidates have
 * nothing near the setting, the next best are used. The response depends on the camera: linear for RAW; otherwise the
 * mean of the responses of the camera's profiles of rendered pictures with any lens, those with the key's picture style
 * before those without one; without such profiles, the typical response of the kind of camera. A stored profile that
 * matches everything is returned unchanged. Any other answer has the given key, no gain grid, provenance method
 * "lookup", and a covariance of both parts. Nothing is written. NOT_FOUND if there is no such lens or nothing near
 * enough: *lookup is then filled as far as possible, *profile is unchanged, and the text of the error is the reason.
 * *profile must be initialised, and *lookup if it is given. options may be NULL, for the defaults, and lookup, if the
 * answer alone is wanted. Of stores[count],
 * count > 0, the falloff comes from the first that has one for the key, the response from the first that has profiles
 * of the camera; the reason of a refusal is that of the first that has the lens. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_lookup_in(lensprof_store *const *stores, uint32_t count,
                                                                        const lensprof_profile_key *key,
                                                                        const lensprof_lookup_options *options,
                                                                        lensprof_profile *profile,
                                                                        lensprof_lookup *lookup, lensprof_error *error);

/* The same in one database. */
LENSPROF_MUST_USE static inline lensprof_status
lensprof_store_lookup(lensprof_store *store, const lensprof_profile_key *key, const lensprof_lookup_options *options,
                      lensprof_profile *profile, lensprof_lookup *lookup, lensprof_error *error) {
    return lensprof_store_lookup_in(&store, 1, key, options, profile, lookup, error);
}

/* From here to commit or rollback, all calls on this handle form one transaction, which makes thousands of them fast.
 * Closing the store rolls back. Errors: READ_ONLY, BUSY, ...; ARGUMENT for a second begin, or a commit without begin.
 */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_begin(lensprof_store *store, lensprof_error *error);
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_commit(lensprof_store *store, lensprof_error *error);
LENSPROF_API void lensprof_store_rollback(lensprof_store *store);

/* Copies the profile with an id to an initialised *profile. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_get(lensprof_store *store, int64_t id,
                                                                  lensprof_profile *profile, lensprof_error *error);

/* A row of a listing. Frozen value struct. */
typedef struct lensprof_store_row {
    int64_t id;
    uint32_t damaged;     /* 1: the row has impossible values; its key and provenance are unknown */
    uint32_t reserved[3]; /* 0 */
    lensprof_profile_key key;
    lensprof_provenance provenance;
} lensprof_store_row;

/* Lists profiles in the order camera maker, model, lens, focal length, aperture, distance, id. Texts and known numbers
 * in filter (may be NULL) must match; its processing is ignored. rows[capacity] and *count as in base.h. A row whose
 * key or provenance cannot be read does not end the list: it is reported with `damaged` 1 and its id.
 * lensprof_store_get reports what is wrong with it; lensprof_store_check also finds damage in the rest of a profile. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_list(lensprof_store *store,
                                                                   const lensprof_profile_key *filter,
                                                                   lensprof_store_row *rows, uint32_t capacity,
                                                                   uint32_t *count, lensprof_error *error);

/* Checks whether a profile is already stored: *id receives the id of one with the same key, content and provenance
 * (method, software, prior and forced are ignored), or 0. Numbers must be equal; of a response only those that its kind
 * uses. Intended for imports, before a put: the store must be open for writing. Errors: those of
 * lensprof_profile_validate; those of the store. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_find_same(lensprof_store *store,
                                                                        const lensprof_profile *profile, int64_t *id,
                                                                        lensprof_error *error);

/* Adds every profile of `other`, another open database, that lensprof_store_find_same does not find, the oldest first.
 * Provenance is kept, but prior_id becomes the id of the prior in this database, or 0 if the prior is not here. A
 * profile that is already here keeps its provenance, but gets a prior_id from the other database if its own is 0.
 * Atomic and idempotent: merging again adds nothing. *added and *known (may be NULL) receive the number of profiles
 * added and of those already present. Cameras missing here (by maker, model and variant) are added but not counted.
 * `other` is only read, whatever its layout. Errors: ARGUMENT for the database itself; those of lensprof_store_put and,
 * for `other`, of lensprof_store_get: the text names the file and the damaged profile. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_merge(lensprof_store *store, lensprof_store *other,
                                                                    uint32_t *added, uint32_t *known,
                                                                    lensprof_error *error);

/* Stores a camera. It replaces the one with exactly the same maker, model and variant, if there is one.
 * Errors: ARGUMENT if it has no model, a text is not terminated or has control characters, or a number is out of range;
 * those of the store. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_put_camera(lensprof_store *store,
                                                                         const lensprof_camera_model *camera,
                                                                         lensprof_error *error);

/* Finds a camera by its EXIF name or common name. Case, signs, a leading maker, the spelling of the maker and names in
 * other countries are ignored; the maker may be empty. If several cameras have the name, data in which they differ is
 * unknown. NOT_FOUND, with *camera unchanged, if no camera matches. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_find_camera(lensprof_store *store, const char *maker,
                                                                          const char *model,
                                                                          lensprof_camera_model *camera,
                                                                          lensprof_error *error);

/* Lists the whole table of cameras by maker, model and variant. cameras[capacity] and *count as in base.h. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_list_camera_models(lensprof_store *store,
                                                                                 lensprof_camera_model *cameras,
                                                                                 uint32_t capacity, uint32_t *count,
                                                                                 lensprof_error *error);

/* A fault in a database. */
typedef struct lensprof_store_fault {
    int64_t id;       /* of the profile; 0 = of the file as a whole */
    char reason[256]; /* in words, or as reported by SQLite */
} lensprof_store_fault;

/* Receives the faults: those of the file, rows without their profile, then damaged profiles by id. It must not call the
 * store. A return value other than OK ends the check and becomes its result. */
typedef lensprof_status (*lensprof_fault_visitor)(void *user, const lensprof_store_fault *fault);

/* Reads and checks everything: SQLite's integrity_check, foreign keys, and every profile as lensprof_store_get does
 * (types, ranges, finite numbers, monotone responses, positive falloffs, symmetric covariance). A row may therefore be
 * reported more than once. *profiles and *faults (may be NULL) receive their numbers; faults are not errors. One
 * transaction, which writes nothing. visit may be NULL. Errors: those of the store, except damage that the check could
 * continue after; the return value of the visitor. */
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

/* Contents of a database. Names that differ only in ASCII case or outer blanks count once. */
typedef struct lensprof_store_stats {
    uint32_t struct_size;
    uint32_t layout; /* version of profiles/schema */
    uint32_t profiles;
    uint32_t cameras, lenses, units;                 /* distinct known ones */
    uint32_t processing[3];                          /* profiles, by lensprof_processing */
    uint32_t with_covariance, with_grid, with_doubt; /* profiles */
    uint32_t methods, sources;                       /* distinct ones */
    double focal_mm[2]; /* smallest and largest known value; LENSPROF_UNKNOWN if none is known */
    double aperture[2];
    double distance_m[2];
    lensprof_store_group method[LENSPROF_STATS_GROUPS]; /* those with the most profiles, largest first */
    lensprof_store_group source[LENSPROF_STATS_GROUPS];
    int64_t bytes; /* of the file, including a log next to it */
} lensprof_store_stats;

/* All zero. */
static inline void lensprof_store_stats_init(lensprof_store_stats *stats) { lensprof_init_sized(stats, sizeof *stats); }

/* Fills an initialised *stats. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_get_stats(lensprof_store *store,
                                                                        lensprof_store_stats *stats,
                                                                        lensprof_error *error);

/* Removes the profile with an id; NOT_FOUND if it does not exist. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_remove(lensprof_store *store, int64_t id,
                                                                     lensprof_error *error);

/* Changes the key of the stored profile with an id; its content, provenance and id stay. Errors: NOT_FOUND; ARGUMENT
 * for an invalid key. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_set_key(lensprof_store *store, int64_t id,
                                                                      const lensprof_profile_key *key,
                                                                      lensprof_error *error);

/* A lens or a camera, with a summary of its profiles. Frozen value struct. */
typedef struct lensprof_store_summary {
    char camera_maker[64]; /* empty in a list of lenses */
    char camera_model[64];
    char lens[128];         /* empty in a list of cameras */
    uint32_t profiles;      /* number of its profiles */
    uint32_t others;        /* distinct cameras named with a lens, or distinct lenses named with a camera */
    uint32_t processing[3]; /* profiles, by lensprof_processing */
    uint32_t reserved;      /* 0 */
    double focal_mm[2];     /* smallest and largest known value; LENSPROF_UNKNOWN if none is known */
    double aperture[2];
    double distance_m[2];
} lensprof_store_summary;

typedef enum lensprof_store_names {
    LENSPROF_NAMES_LENSES = 0,
    LENSPROF_NAMES_CAMERAS = 1
} lensprof_store_names;

/* Lists the lenses, or the cameras (`which`, lensprof_store_names), of the stored profiles, ordered by name. `part`
 * (NULL or blanks: all) is a name as in lookups. If no name matches, its words are searched, each anywhere in maker and
 * name, ignoring ASCII case, blanks and signs. rows[capacity] and *count as in base.h. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_list_names(lensprof_store *store, uint32_t which,
                                                                         const char *part, lensprof_store_summary *rows,
                                                                         uint32_t capacity, uint32_t *count,
                                                                         lensprof_error *error);

/* Removes the falloff (and gain grid) of a profile from a whole picture, in place. Samples are encoded by the response
 * of the profile, before and after. exposure: exposure and white balance of the picture, which become 0 EV and 1, 1, 1;
 * NULL keeps them. apply.h has the same in parts: without heap, for tiles, other encodings, and many pictures of one
 * plan. Errors: ARGUMENT for NULL; those of lensprof_image_validate, lensprof_apply_options_set_profile and
 * lensprof_plan_init, with the picture unchanged; UNSUPPORTED for the layout PLANAR; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_correct(const lensprof_profile *profile,
                                                                const lensprof_exposure *exposure,
                                                                const lensprof_target *picture, lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
