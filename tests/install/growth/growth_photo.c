/* growth_photo - calls every function of lensprof/photo.h that takes a struct that grows. Compiled with the headers of
 * one version, it runs with the library of another.
 *
 *   growth_photo ok FOLDER       every call returns OK and the right result, although the library may be newer
 *   growth_photo refused FOLDER  every call returns STRUCT_SIZE with a text: the library is older
 *
 * FOLDER is made; the caller removes it. Prints a line per struct; exit 1 if one is wrong. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <lensprof/photo.h>

#define IMAGES 4
#define WIDTH 240
#define HEIGHT 180

static char folder[512];
static lensprof_picture *picture;
static lensprof_scene *scene;
static lensprof_calibration *calibration;
static int wrong_results;

static const char *path_of(const char *name) {
    static char paths[4][1024];
    static int next;
    char *path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

static void expect(int holds, const char *what) {
    if (holds) return;
    printf("WRONG: %s\n", what);
    wrong_results++;
}

static void must(lensprof_status status, const lensprof_error *error, const char *what) {
    if (status == LENSPROF_OK) return;
    printf("%s: %s %s\n", what, lensprof_status_name(status), error->text);
    exit(1);
}

/* Pictures of one scene, 10 degrees apart, and a Hugin project of them. */
static void write_scene(void) {
    static uint8_t pixels[HEIGHT][WIDTH][3];
    lensprof_error error;
    mkdir(folder, 0777), mkdir(path_of("in"), 0777);
    FILE *project = fopen(path_of("in/scene.pto"), "w");
    if (!project) exit(1);
    fprintf(project, "p f0 w1000 h500 v100\n");
    for (int i = 0; i < IMAGES; i++) {
        lensprof_camera camera = {.width = WIDTH, .height = HEIGHT, .hfov_deg = 50.0, .yaw_deg = 10.0 * i};
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++) {
                double d[2] = {0.0, 0.0};
                (void)lensprof_camera_unproject(&camera, x, y, d);
                for (int c = 0; c < 3; c++)
                    pixels[y][x][c] =
                        (uint8_t)(128.0 + 60.0 * sin(17.0 * d[0] + 5.0 * d[1] + c) + 50.0 * cos(23.0 * d[1]));
            }
        char name[32];
        snprintf(name, sizeof name, "in/%d.png", i);
        const lensprof_image view = {pixels, sizeof pixels[0], WIDTH, HEIGHT, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB};
        must(lensprof_picture_write(path_of(name), &view, NULL, &error), &error, name);
        fprintf(project, "i w%d h%d f0 %s r0 p0 y%d n\"%d.png\"\n", WIDTH, HEIGHT,
                i ? "v=0 Ra=0 Rb=0 Rc=0 Rd=0 Re=0 Va=0 Vb=0 Vc=0 Vd=0" : "v50", 10 * i, i);
    }
    fclose(project);
}

static void open_handles(void) {
    lensprof_error error;
    const char *project = path_of("in/scene.pto");
    must(lensprof_picture_open(path_of("in/0.png"), &picture, &error), &error, "picture");
    must(lensprof_scene_open(&project, 1, NULL, NULL, &scene, &error), &error, "scene");
    must(lensprof_calibrate(scene, NULL, NULL, &calibration, &error), &error, "calibration");
}

static lensprof_status call_picture_info(void *given, lensprof_error *error) {
    lensprof_picture_info *info = given;
    const lensprof_status status = lensprof_picture_get_info(picture, 0, info, error);
    expect(status != LENSPROF_OK || (info->width == WIDTH && info->read_height == HEIGHT), "size of a picture");
    return status;
}

static lensprof_status call_metadata(void *given, lensprof_error *error) {
    lensprof_picture_metadata *metadata = given;
    const lensprof_status status = lensprof_picture_get_metadata(picture, metadata, error);
    expect(status != LENSPROF_OK || metadata->iso == LENSPROF_UNKNOWN, "ISO of a picture");
    return status;
}

static lensprof_status write_pixel(const lensprof_picture_options *options, lensprof_error *error) {
    static const uint8_t pixel[3] = {1, 2, 3};
    const lensprof_image view = {pixel, 3, 1, 1, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB};
    return lensprof_picture_write(path_of("pixel.png"), &view, options, error);
}

static lensprof_status call_metadata_in(void *given, lensprof_error *error) {
    lensprof_picture_options options;
    lensprof_picture_options_init(&options);
    ((lensprof_picture_metadata *)given)->iso = 200.0;
    options.metadata = given;
    return write_pixel(&options, error);
}

static lensprof_status call_picture_options(void *given, lensprof_error *error) { return write_pixel(given, error); }

static lensprof_status open_again(const lensprof_scene_options *options, const lensprof_events *events,
                                  lensprof_error *error) {
    const char *project = path_of("in/scene.pto");
    lensprof_scene *again = NULL;
    const lensprof_status status = lensprof_scene_open(&project, 1, options, events, &again, error);
    lensprof_scene_destroy(again);
    return status;
}

static lensprof_status call_events(void *given, lensprof_error *error) { return open_again(NULL, given, error); }
static lensprof_status call_scene_options(void *given, lensprof_error *error) { return open_again(given, NULL, error); }

static lensprof_status call_scene_info(void *given, lensprof_error *error) {
    lensprof_scene_info *info = given;
    const lensprof_status status = lensprof_scene_get_info(scene, info, error);
    expect(status != LENSPROF_OK || info->images == IMAGES, "images of a scene");
    return status;
}

static lensprof_status call_calibrate_options(void *given, lensprof_error *error) {
    lensprof_calibration *made = NULL;
    lensprof_exposure exposure;
    const lensprof_status status = lensprof_calibrate(scene, given, NULL, &made, error);
    if (status == LENSPROF_OK) {
        must(lensprof_calibration_exposure_at(made, 1, &exposure, NULL, error), error, "exposure");
        expect(fabs(exposure.ev) < 0.05, "exposure of a calibration");
    }
    lensprof_calibration_destroy(made);
    return status;
}

static lensprof_status call_calibration_info(void *given, lensprof_error *error) {
    lensprof_calibration_info *info = given;
    const lensprof_status status = lensprof_calibration_get_info(calibration, info, error);
    expect(status != LENSPROF_OK || info->images == IMAGES, "images of a calibration");
    return status;
}

static lensprof_status call_correct_options(void *given, lensprof_error *error) {
    const lensprof_copy copy = {path_of("in/1.png"), path_of("copy.png")};
    ((lensprof_correct_options *)given)->overwrite = 1;
    uint32_t written = 0;
    const lensprof_status status = lensprof_correct_files(calibration, &copy, 1, given, NULL, &written, error);
    expect((written == 1) == (status == LENSPROF_OK), "copies written");
    return status;
}

static lensprof_status whole(const lensprof_folder_options *options, lensprof_folder_result *result,
                             lensprof_error *error) {
    const char *in = path_of("in");
    return lensprof_calibrate_folder(&in, 1, path_of("out"), options, NULL, result, error);
}

static lensprof_status call_folder_options(void *given, lensprof_error *error) {
    lensprof_folder_options *options = given;
    options->no_store = 1;
    return whole(options, NULL, error);
}

static lensprof_status call_folder_result(void *given, lensprof_error *error) {
    lensprof_folder_options options;
    lensprof_folder_options_init(&options);
    options.no_store = 1;
    lensprof_folder_result *result = given;
    const lensprof_status status = whole(&options, result, error);
    expect(status != LENSPROF_OK || result->found == IMAGES, "pictures of a folder");
    return status;
}

#define GROWING(kind, call) \
    { #kind, sizeof(lensprof_##kind), (void (*)(void *))init_##kind, call }
#define INIT(kind) \
    static void init_##kind(void *given) { lensprof_##kind##_init(given); }
INIT(events)
INIT(picture_info)
INIT(picture_metadata)
INIT(picture_options)
INIT(scene_options)
INIT(scene_info)
INIT(calibrate_options)
INIT(calibration_info)
INIT(correct_options)
INIT(folder_options)
INIT(folder_result)

static const struct growing {
    const char *name;
    size_t size;
    void (*init)(void *given);
    lensprof_status (*call)(void *given, lensprof_error *error);
} structs[] = {
    GROWING(events, call_events),
    GROWING(picture_info, call_picture_info),
    GROWING(picture_metadata, call_metadata),
    GROWING(picture_metadata, call_metadata_in),
    GROWING(picture_options, call_picture_options),
    GROWING(scene_options, call_scene_options),
    GROWING(scene_info, call_scene_info),
    GROWING(calibrate_options, call_calibrate_options),
    GROWING(calibration_info, call_calibration_info),
    GROWING(correct_options, call_correct_options),
    GROWING(folder_options, call_folder_options),
    GROWING(folder_result, call_folder_result),
};

int main(int count, char **words) {
    int right = 1;
    if (count != 3 || (strcmp(words[1], "ok") && strcmp(words[1], "refused"))) {
        printf("usage: growth_photo ok|refused FOLDER\n");
        return 2;
    }
    const int refused = words[1][0] == 'r';
    snprintf(folder, sizeof folder, "%s", words[2]);
    write_scene();
    open_handles();
    for (size_t i = 0; i < sizeof structs / sizeof structs[0]; i++) {
        lensprof_error error = {"", {0, 0, 0, 0}};
        void *given = calloc(1, structs[i].size);
        if (!given) return 1;
        structs[i].init(given);
        wrong_results = 0;
        const lensprof_status status = structs[i].call(given, &error);
        printf("%s: %s %s\n", structs[i].name, lensprof_status_name(status), error.text);
        if (status != (refused ? LENSPROF_ERROR_STRUCT_SIZE : LENSPROF_OK) || wrong_results
            || (refused && !strstr(error.text, "newer lensprof")))
            right = 0, printf("WRONG: %s\n", structs[i].name);
        free(given);
    }
    lensprof_calibration_destroy(calibration), lensprof_scene_destroy(scene), lensprof_picture_destroy(picture);
    return !right;
}
