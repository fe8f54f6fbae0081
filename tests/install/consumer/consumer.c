/* Links every layer of the installed library from C, and checks that header and library have the same version. */
#include <stdio.h>
#include <string.h>

#include <lensprof/lensprof.h>

int main(void) {
    static const char text[] = "p f2 w100 h50 v360\ni w10 h8 f0 v50 Eev0 n\"a.png\"\nv Eev0\nv\n";
    char version[32];
    lensprof_pto *pto = NULL;
    lensprof_store *store = NULL;
    lensprof_fit_options options;
    lensprof_error error;

    sprintf(version, "%d.%d.%d", LENSPROF_VERSION_MAJOR, LENSPROF_VERSION_MINOR, LENSPROF_VERSION_PATCH);
    if (strcmp(version, lensprof_version()) != 0) return 1;
    lensprof_fit_options_init(&options);
    if (options.struct_size != sizeof options) return 2;
    if (lensprof_pto_read(text, sizeof text - 1, &pto, &error) != LENSPROF_OK) return 3;
    if (lensprof_pto_image_count(pto) != 1) return 4;
    lensprof_pto_destroy(pto);
    if (lensprof_store_open("/nonexistent/x.db", LENSPROF_STORE_READ, &store, &error) != LENSPROF_ERROR_NOT_FOUND)
        return 5;
    printf("lensprof %s from C\n", version);
    return 0;
}
