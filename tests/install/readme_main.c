/* The code that test_readme.sh adds to README's example: 80 % of the light in the corner, where 100 becomes 125. */
#include <stdio.h>
#include <stdlib.h>

#define SIDE 41

int main(void) {
    static lensprof_profile profile;
    static uint8_t pixels[SIDE][SIDE][3];
    lensprof_store *store = NULL;
    lensprof_error error;
    char path[] = "/tmp/lensprof-readme-XXXXXX.db";
    if (mkstemps(path, 3) < 0 || remove(path)) return 1;
    lensprof_profile_init(&profile);
    strcpy(profile.key.lens, "Acme 50mm f/1.8");
    profile.key.focal_mm = 50, profile.key.aperture = 2.8, profile.key.crop_factor = 1.5;
    profile.vignetting[0].k[0] = -0.2;
    for (int i = 0; i < SIDE * SIDE * 3; i++) (&pixels[0][0][0])[i] = 100;
    if (lensprof_store_open(path, LENSPROF_STORE_CREATE, &store, &error) != LENSPROF_OK
        || lensprof_store_put(store, &profile, NULL, &error) != LENSPROF_OK)
        return 1;
    const lensprof_status status = correct(store, profile.key.lens, 50, 2.8, 1.5, pixels, SIDE, SIDE, &error);
    const int corner = pixels[0][SIDE - 1][1], middle = pixels[SIDE / 2][SIDE / 2][1];
    printf("%s: corner %d, middle %d\n", lensprof_status_name(status), corner, middle);
    const int refused = correct(store, "Another 85mm", 85, 2.8, 1.5, pixels, SIDE, SIDE, &error) != LENSPROF_OK;
    lensprof_store_close(store);
    remove(path);
    return status != LENSPROF_OK || corner < 123 || corner > 125 || middle != 100 || !refused;
}
