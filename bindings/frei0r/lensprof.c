/* A frei0r plug-in: takes the falloff of a lens out of video, for FFmpeg, Kdenlive, Shotcut and their like.
 *
 *     ffmpeg -i clip.mp4 -vf "frei0r=lensprof:lens.json|srgb|1" corrected.mp4
 *
 * Parameters, in this order: `profile`, a file of any format that lensprof_import reads, of which the first usable
 * profile is taken; `response` of the video: "profile", "srgb", or an exponent such as "2.2" (default: that of the
 * profile, or srgb if the profile has none); `strength`, 0 to 1. An error is a sentence on stderr, once, and frames
 * pass unchanged. */
#include <frei0r.h>
#include <lensprof/lensprof.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    PROFILE,
    RESPONSE,
    STRENGTH,
    PARAMETERS
};

typedef struct lens {
    uint32_t width, height;
    f0r_param_string texts[2]; /* PROFILE and RESPONSE; NULL: not given */
    double strength;
    int is_ready; /* 0: the parameters have changed since the plan was made */
    void *memory; /* of the plan; NULL: frames pass unchanged */
    const lensprof_plan *plan;
} lens;

int f0r_init(void) { return 1; }
void f0r_deinit(void) {}

void f0r_get_plugin_info(f0r_plugin_info_t *info) {
    *info = (f0r_plugin_info_t){.name = "lensprof",
                                .author = "The lensprof authors",
                                .plugin_type = F0R_PLUGIN_TYPE_FILTER,
                                .color_model = F0R_COLOR_MODEL_RGBA8888,
                                .frei0r_version = FREI0R_MAJOR_VERSION,
                                .major_version = LENSPROF_VERSION_MAJOR,
                                .minor_version = LENSPROF_VERSION_MINOR,
                                .num_params = PARAMETERS,
                                .explanation = "Takes the falloff of a lens out of the picture, by its profile"};
}

void f0r_get_param_info(f0r_param_info_t *info, int index) {
    static const f0r_param_info_t all[PARAMETERS] = {
        {"profile", F0R_PARAM_STRING, "file of the profile of the lens: JSON, blob, Lensfun XML, LCP, ..."},
        {"response", F0R_PARAM_STRING, "response of the video: profile, srgb, or an exponent such as 2.2"},
        {"strength", F0R_PARAM_DOUBLE, "share of the falloff that is taken out, 0 to 1"}};
    if (index >= 0 && index < PARAMETERS) *info = all[index];
}

f0r_instance_t f0r_construct(unsigned int width, unsigned int height) {
    lens *this = calloc(1, sizeof *this);
    if (this) this->width = width, this->height = height, this->strength = 1.0;
    return this;
}

void f0r_destruct(f0r_instance_t instance) {
    lens *this = instance;
    free(this->texts[PROFILE]), free(this->texts[RESPONSE]), free(this->memory), free(this);
}

void f0r_set_param_value(f0r_instance_t instance, f0r_param_t value, int index) {
    lens *this = instance;
    if (index == STRENGTH) {
        const double strength = *(f0r_param_double *)value;
        if (memcmp(&strength, &this->strength, sizeof strength) != 0) /* NaN equals itself, too */
            this->strength = strength, this->is_ready = 0;
    }
    if (index != PROFILE && index != RESPONSE) return;
    const char *text = *(f0r_param_string *)value, *old = this->texts[index];
    if (!text || (old && strcmp(text, old) == 0)) return; /* programs set all parameters again for every frame */
    char *copy = malloc(strlen(text) + 1);
    if (copy) strcpy(copy, text);
    free(this->texts[index]);
    this->texts[index] = copy, this->is_ready = 0;
}

void f0r_get_param_value(f0r_instance_t instance, f0r_param_t value, int index) {
    lens *this = instance;
    static char none[] = "";
    if (index == STRENGTH) *(f0r_param_double *)value = this->strength;
    if (index == PROFILE || index == RESPONSE)
        *(f0r_param_string *)value = this->texts[index] ? this->texts[index] : none;
}

/* The content of a file; NULL with a message if it cannot be read. */
static void *read_file(const char *path, size_t *size) {
    enum {
        LARGEST = 64 << 20
    };
    FILE *file = fopen(path, "rb");
    char *data = file ? malloc(LARGEST) : NULL;
    *size = data ? fread(data, 1, LARGEST, file) : 0;
    if (!data || ferror(file) || *size == LARGEST) {
        fprintf(stderr, "lensprof: %s: cannot be read; give the file of a profile as the first parameter\n", path);
        free(data), data = NULL;
    }
    if (file) fclose(file);
    return data;
}

typedef struct first_profile {
    lensprof_profile profile;
    int is_found, has_response;
} first_profile;

static lensprof_status take_first(void *user, const lensprof_import_entry *entry) {
    first_profile *first = user;
    if (first->is_found || !entry->usable) return LENSPROF_OK;
    first->is_found = 1;
    first->has_response = entry->profile->response[0].kind != LENSPROF_RESPONSE_LINEAR;
    return lensprof_profile_copy(&first->profile, entry->profile);
}

static int read_profile(const char *path, first_profile *first) {
    size_t size;
    void *data = read_file(path, &size);
    if (!data) return 0;
    lensprof_import_options options;
    lensprof_import_options_init(&options);
    options.name = path;
    lensprof_error error = {0};
    const lensprof_status status = lensprof_import(data, size, &options, take_first, first, &error);
    free(data);
    if (status != LENSPROF_OK)
        fprintf(stderr, "lensprof: %s: %s\n", path, error.text);
    else if (!first->is_found)
        fprintf(stderr, "lensprof: %s: has no usable profile; give a file that has one\n", path);
    return status == LENSPROF_OK && first->is_found;
}

/* A number such as 2.2, or 2,2 as some locales of video programs write it; 0 for anything else. strtod() would depend
 * on the locale of the program. */
static double number_of(const char *text) {
    double number = 0.0, unit = 1.0;
    int has_point = 0, has_digit = 0;
    for (; *text; text++) {
        if ((*text == '.' || *text == ',') && !has_point) {
            has_point = 1;
        } else if (*text >= '0' && *text <= '9') {
            has_digit = 1, number = 10.0 * number + (*text - '0'), unit *= has_point ? 10.0 : 1.0;
        } else {
            return 0.0;
        }
    }
    return has_digit ? number / unit : 0.0;
}

/* Sets the response that the text names, where it is not that of the profile; 0 with a message if it is unknown. */
static int choose_response(const char *text, const first_profile *first, lensprof_response *response,
                           lensprof_apply_options *options) {
    if (!text || !*text) text = first->has_response ? "profile" : "srgb";
    if (strcmp(text, "profile") == 0) return 1;
    if (strcmp(text, "srgb") == 0)
        lensprof_response_set_srgb(response);
    else if (lensprof_response_set_gamma(response, number_of(text)) != LENSPROF_OK) {
        fprintf(stderr, "lensprof: response %s: is unknown; use profile, srgb, or an exponent such as 2.2\n", text);
        return 0;
    }
    options->response = response, options->responses = 1;
    return 1;
}

static void prepare(lens *this) {
    free(this->memory);
    this->memory = NULL, this->is_ready = 1;
    first_profile first = {.is_found = 0};
    lensprof_profile_init(&first.profile);
    if (!read_profile(this->texts[PROFILE] ? this->texts[PROFILE] : "(no profile)", &first)) return;
    lensprof_response response;
    lensprof_apply_options options;
    lensprof_apply_options_init(&options);
    lensprof_error error = {0};
    lensprof_status status = lensprof_apply_options_set_profile(&options, &first.profile);
    options.frame_width = this->width, options.frame_height = this->height;
    options.source_layout = LENSPROF_LAYOUT_RGBA;
    options.strength = this->strength;
    if (!choose_response(this->texts[RESPONSE], &first, &response, &options)) return;
    const size_t bytes = lensprof_plan_bytes(&options);
    this->memory = malloc(bytes);
    if (status == LENSPROF_OK && this->memory)
        status = lensprof_plan_init(this->memory, bytes, &options, &this->plan, &error);
    if (status != LENSPROF_OK || !this->memory) {
        fprintf(stderr, "lensprof: %s: %s\n", this->texts[PROFILE],
                error.text[0] ? error.text : lensprof_status_name(status));
        free(this->memory), this->memory = NULL;
    }
}

void f0r_update(f0r_instance_t instance, double time, const uint32_t *in, uint32_t *out) {
    (void)time;
    lens *this = instance;
    const ptrdiff_t row_bytes = (ptrdiff_t)this->width * 4;
    if (!this->is_ready) prepare(this);
    const lensprof_image source = {in, row_bytes, this->width, this->height, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGBA};
    const lensprof_target target = {out,          row_bytes,          this->width,
                                    this->height, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGBA};
    if (!this->memory || lensprof_apply(this->plan, &source, &target, 0, 0) != LENSPROF_OK)
        memcpy(out, in, (size_t)row_bytes * this->height);
}
