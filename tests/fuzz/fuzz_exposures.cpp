// Fuzzing exposures.json. Invariant for any bytes: an invalid file gives a status of exposures.h and an error text, and
// no handle; otherwise what it holds can be written, and reads back the same.
#include <lensprof/exposures.h>

#include "fuzz_main.hpp"

namespace {

const char *const kTarget = "fuzz_exposures";
const std::vector<std::string> kWords = {"{",
                                         "}",
                                         "[",
                                         "]",
                                         ",",
                                         ":",
                                         "\"",
                                         "null",
                                         "-",
                                         "0",
                                         "1",
                                         "-1",
                                         "0.5",
                                         "64",
                                         "1e308",
                                         "1e-320",
                                         "1e999",
                                         "[]",
                                         "{}",
                                         "\"kind\":\"gamma\",\"gamma\":2.2",
                                         "\"kind\":\"table\",\"values\":[[0,1]]",
                                         "\"ev\":null,",
                                         "\"ev_sigma\":null,",
                                         "\"name\":\"\",",
                                         "\"camera\"",
                                         "\\u0000",
                                         "\\ud800",
                                         "4294967296",
                                         "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[",
                                         "\xC3\xA9",
                                         "\xFF"};

struct Owner {
    lensprof_exposures *handle = nullptr;
    ~Owner() { lensprof_exposures_destroy(handle); }
};

bool read(const std::vector<char> &text, Owner &owner) {
    lensprof_error error;
    const lensprof_status status = lensprof_exposures_read(text.data(), text.size(), &owner.handle, &error);
    demand(status == LENSPROF_OK || status == LENSPROF_ERROR_SYNTAX || status == LENSPROF_ERROR_UNSUPPORTED
               || status == LENSPROF_ERROR_VIGNETTING || status == LENSPROF_ERROR_RESPONSE
               || status == LENSPROF_ERROR_EXPOSURE,
           "unexpected status");
    demand((status == LENSPROF_OK) == !error.text[0], "status and error text contradict each other");
    demand((status == LENSPROF_OK) == (owner.handle != nullptr), "status and handle contradict each other");
    return status == LENSPROF_OK;
}

std::vector<char> write(const lensprof_exposures *handle) {
    lensprof_exposures_info info;
    lensprof_exposures_info_init(&info);
    demand(lensprof_exposures_get_info(handle, &info, nullptr) == LENSPROF_OK, "no info");
    std::vector<lensprof_exposures_camera> cameras(info.camera_count);
    std::vector<lensprof_exposures_lens> lenses(info.lens_count);
    std::vector<lensprof_exposures_image> images(info.image_count);
    for (uint32_t i = 0; i < info.camera_count; i++) {
        lensprof_exposures_camera_init(&cameras[i]);
        demand(lensprof_exposures_get_camera(handle, i, &cameras[i], nullptr) == LENSPROF_OK, "no camera");
    }
    for (uint32_t i = 0; i < info.lens_count; i++) {
        lensprof_exposures_lens_init(&lenses[i]);
        demand(lensprof_exposures_get_lens(handle, i, &lenses[i], nullptr) == LENSPROF_OK, "no lens");
    }
    for (uint32_t i = 0; i < info.image_count; i++) {
        lensprof_exposures_image_init(&images[i]);
        demand(lensprof_exposures_get_image(handle, i, &images[i], nullptr) == LENSPROF_OK, "no image");
    }
    return written([&](void *data, size_t capacity, size_t *count) {
        return lensprof_exposures_write(&info, cameras.data(), lenses.data(), images.data(), data, capacity, count,
                                        nullptr);
    });
}

bool try_bytes(const std::vector<char> &bytes) {
    Owner first, again;
    if (!read(bytes, first)) return false;
    const std::vector<char> text = write(first.handle);
    demand(read(text, again) && write(again.handle) == text, "does not read back the same");
    return true;
}

}  // namespace
