// Fuzzing lensprof_import with AUTO. Invariant for any bytes: the detected format reads them, or they are refused with
// a text; every usable entry is valid and can be written and read again.
#include "fuzz_import.hpp"

namespace {

const char *const kTarget = "fuzz_any";
const std::vector<std::string> kWords = {"<lensdatabase version=\"2\">",
                                         "CameraProfiles",
                                         "VignettingModel",
                                         "LPRF",
                                         "<x:xmpmeta>",
                                         "<?xpacket",
                                         "{\"rpi.alsc\":",
                                         "luminance_lut",
                                         "# name: ",
                                         "LUT_1D_SIZE 2\n",
                                         "\x89PNG",
                                         "\xFF\xD8",
                                         "II*",
                                         "\n",
                                         "0",
                                         "-1",
                                         "1e308",
                                         "nan",
                                         "{",
                                         "}",
                                         "\xFF"};
const char *const kNames[] = {"a.xml", "a.lcp", "a.json", "a.blob", "a.dng", "a.xmp", "a.txt",
                              "a.csv", "a.crf", "a.vgn",  "a.cube", "a.h",   ""};

lensprof_status visit_any(void *user, const lensprof_import_entry *entry) {
    const lensprof_status status = visit(user, entry);
    demand(entry->holds <= LENSPROF_HOLDS_FALLOFF, "an entry that holds nothing");
    return status;
}

// As JSON, which holds all of a profile.
void write_and_read(const lensprof_profile &profile) {
    const lensprof_profile *const pointer = &profile;
    lensprof_export_options options;
    lensprof_export_options_init(&options);
    options.name = "a.json";
    const std::vector<char> text = written([&](void *data, size_t capacity, size_t *count) {
        return lensprof_export(&pointer, 1, &options, data, capacity, count, nullptr);
    });
    Visited again;
    demand(lensprof_import(text.data(), text.size(), nullptr, visit_any, &again, nullptr) == LENSPROF_OK
               && again.usable.size() == 1,
           "does not read back");
}

bool try_bytes(const std::vector<char> &bytes) {
    static size_t turn = 0;
    bool is_read = false;
    for (size_t n = 0; n < 2; n++) {  // by content, and under a name that may be misleading
        lensprof_import_options options;
        lensprof_import_options_init(&options);
        options.name = n ? kNames[turn++ % (sizeof kNames / sizeof *kNames)] : nullptr;
        options.width = 60, options.height = 40;
        options.columns = 4, options.rows = 3;
        lensprof_error error;
        Visited visited;
        const lensprof_status status =
            lensprof_import(bytes.data(), bytes.size(), &options, visit_any, &visited, &error);
        check_reading(
            status, error, visited,
            {LENSPROF_ERROR_SYNTAX, LENSPROF_ERROR_UNSUPPORTED, LENSPROF_ERROR_SIZE, LENSPROF_ERROR_NOT_FOUND,
             LENSPROF_ERROR_VIGNETTING, LENSPROF_ERROR_RESPONSE, LENSPROF_ERROR_NOT_FINITE, LENSPROF_ERROR_ARGUMENT});
        if (status == LENSPROF_OK && !visited.usable.empty()) write_and_read(*visited.usable[0]);
        is_read = is_read || status == LENSPROF_OK;
    }
    return is_read;
}

}  // namespace
