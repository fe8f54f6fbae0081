/* Calibrates a folder of overlapping photographs, and writes a corrected copy of each.
 *
 *     photo FOLDER OUTPUT_FOLDER */
#include <stdio.h>

#include <lensprof/photo.h>

int main(int argc, char **argv) {
    if (argc != 3) return fprintf(stderr, "usage: photo FOLDER OUTPUT_FOLDER\n"), 2;
    const char *folder = argv[1], *source, *name;
    lensprof_scene *scene = NULL;
    lensprof_calibration *calibration = NULL;
    lensprof_scene_info info;
    lensprof_error error = {"", {0, 0, 0, 0}};
    char target[4096];
    lensprof_scene_info_init(&info);
    lensprof_status status = lensprof_scene_open(&folder, 1, NULL, NULL, &scene, &error);
    if (status == LENSPROF_OK) status = lensprof_scene_get_info(scene, &info, &error);
    if (status == LENSPROF_OK) status = lensprof_calibrate(scene, NULL, NULL, &calibration, &error);
    for (uint32_t i = 0; status == LENSPROF_OK && i < info.images; i++) {
        status = lensprof_scene_image_at(scene, i, NULL, &name, &source, &error);
        if (status == LENSPROF_OK) snprintf(target, sizeof target, "%s/%s", argv[2], name);
        const lensprof_copy copy = {source, target};
        if (status == LENSPROF_OK) status = lensprof_correct_files(calibration, &copy, 1, NULL, NULL, NULL, &error);
    }
    if (status != LENSPROF_OK) fprintf(stderr, "%s\n", error.text);
    lensprof_calibration_destroy(calibration);
    lensprof_scene_destroy(scene);
    return status != LENSPROF_OK;
}
