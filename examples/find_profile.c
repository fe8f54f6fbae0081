/* find_profile - put a profile into the database argv[1], which is made when there is none, and find it again. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <lensprof/store.h>

/* Prints what went wrong, when something did. */
static int failed(lensprof_status status, const lensprof_error *error) {
    if (status != LENSPROF_OK) printf("%s: %s\n", lensprof_status_name(status), error->text);
    return status != LENSPROF_OK;
}

static int put(lensprof_store *store, lensprof_profile *profile) {
    lensprof_error error;
    int64_t id;

    lensprof_profile_init(profile);
    strcpy(profile->key.camera_model, "Example Camera");
    strcpy(profile->key.lens, "50 mm F1.8");
    profile->key.focal_mm = 50.0;
    profile->key.aperture = 1.8;
    profile->vignetting[0].k[0] = -0.4;
    if (failed(lensprof_store_put(store, profile, &id, &error), &error)) return 1;
    printf("stored as profile %ld\n", (long)id);
    return 0;
}

static int find(lensprof_store *store, lensprof_profile *profile) {
    lensprof_profile_key key;
    lensprof_error error;
    int64_t id;

    lensprof_profile_init(profile);
    lensprof_profile_key_init(&key);
    strcpy(key.camera_model, "EXAMPLE CAMERA"); /* capitals do not matter */
    strcpy(key.lens, "50 mm F1.8");
    key.focal_mm = 50.0;
    key.aperture = 1.8;
    if (failed(lensprof_store_find(store, &key, profile, &id, &error), &error)) return 1;
    printf("found profile %ld: %.1f %% of the light in the corner\n", (long)id,
           100.0 * lensprof_vignetting_eval(&profile->vignetting[0], 1.0, NULL));

    key.aperture = 8.0;
    if (lensprof_store_find(store, &key, profile, &id, &error) != LENSPROF_ERROR_NOT_FOUND) return 1;
    printf("none for f/8\n");
    return 0;
}

int main(int argc, char **argv) {
    lensprof_profile *profile;
    lensprof_store *store;
    lensprof_error error;
    int code;

    if (argc != 2) {
        printf("usage: find_profile DATABASE\n");
        return 2;
    }
    if (failed(lensprof_store_open(argv[1], LENSPROF_STORE_CREATE, &store, &error), &error)) return 1;
    profile = malloc(sizeof *profile); /* 50 kB: not for a small stack */
    code = !profile || put(store, profile) || find(store, profile);
    free(profile);
    lensprof_store_close(store);
    return code;
}
