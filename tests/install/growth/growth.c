/* growth - calls every function that takes a struct that grows. Compiled with the headers of one version, it runs with
 * the library of another.
 *
 *   growth ok DATABASE       every call returns OK and the right result, although the library may be newer
 *   growth refused DATABASE  every call returns STRUCT_SIZE with a text and changes nothing: the library is older
 *
 * DATABASE is created and removed. Prints a line per struct; exit 1 if one is wrong. */
#include "calls.h"

static int is_right(const growing *g, int refused) {
    lensprof_error error = {"", {0, 0, 0, 0}};
    char *given = new_structs(g, g->size), *before = malloc(g->size * g->count);
    if (!before) exit(1);
    memcpy(before, given, g->size * g->count);
    wrong_results = 0;
    const lensprof_status status = g->call(given, &error);
    printf("%s: %s %s\n", g->name, lensprof_status_name(status), error.text);
    int right = status == (refused ? LENSPROF_ERROR_STRUCT_SIZE : LENSPROF_OK) && !wrong_results;
    if (refused && g->is_output) right = right && !memcmp(given, before, g->size * g->count);
    if (refused && g->has_text) right = right && strstr(error.text, "newer lensprof");
    free(given);
    free(before);
    return right;
}

int main(int count, char **words) {
    int right = 1;
    if (count != 3 || (strcmp(words[1], "ok") && strcmp(words[1], "refused"))) {
        printf("usage: growth ok|refused DATABASE\n");
        return 2;
    }
    store_path = words[2];
    for (size_t i = 0; i < STRUCTS; i++) {
        prepare();
        if (!is_right(&structs[i], words[1][0] == 'r')) right = 0, printf("WRONG: %s\n", structs[i].name);
    }
    return !right;
}
