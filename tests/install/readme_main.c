
/* The code that test_readme.sh adds to README's example: 80 % of the light in the corner, where 100 becomes 125. */
#include <stdio.h>

#define SIDE 41

int main(void) {
    static lensprof_profile profile;
    static uint8_t pixels[SIDE][SIDE][3];
    lensprof_profile_init(&profile);
    profile.vignetting[0].k[0] = -0.2;
    for (int i = 0; i < SIDE * SIDE * 3; i++) (&pixels[0][0][0])[i] = 100;
    const lensprof_status status = correct(&profile, pixels, SIDE, SIDE);
    const int corner = pixels[0][SIDE - 1][1], middle = pixels[SIDE / 2][SIDE / 2][1];
    printf("%s: corner %d, middle %d\n", lensprof_status_name(status), corner, middle);
    if (status != LENSPROF_OK || corner < 123 || corner > 125 || middle != 100) return 1;
    return correct(&profile, pixels, 0, SIDE) == LENSPROF_OK; /* refused, without a leak */
}
