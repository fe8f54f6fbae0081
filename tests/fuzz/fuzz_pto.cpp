// Fuzzing Hugin projects. Invariant for any bytes: an invalid project gives a status of formats.h and an error text;
// otherwise every image, response, name and mask can be read, the project survives writing and reading unchanged, and
// takes a result.
#include <array>
#include <memory>

#include <lensprof/formats.h>
#include <lensprof/model.h>

#include "fuzz_main.hpp"

namespace {

const char *const kTarget = "fuzz_pto";
const std::vector<std::string> kWords = {
    "\n",  "\r",       " ",        "\"",     "=",          "=0",   "=99999999999",  "nan",
    "inf", "-",        "1e309",    "-1",     "i w10 h10 ", "\nv ", "\nk i0 t1 p\"", "#hugin_",
    "Vm",  "S1,2,3,4", "C0,9,0,9", "\nm i3", "Eev",        "\xFF", "v=0",           "j=0"};

struct Destroy {
    void operator()(lensprof_pto *pto) const { lensprof_pto_destroy(pto); }
};
using Project = std::unique_ptr<lensprof_pto, Destroy>;

constexpr uint32_t kMostImages = 64;  // more only take more time

Project read(const std::vector<char> &text) {
    lensprof_pto *pto = nullptr;
    lensprof_error error{};
    const lensprof_status status = lensprof_pto_read(text.data(), text.size(), &pto, &error);
    demand(status == LENSPROF_OK || status == LENSPROF_ERROR_SYNTAX || status == LENSPROF_ERROR_VARIABLE
               || status == LENSPROF_ERROR_UNSUPPORTED || status == LENSPROF_ERROR_SIZE
               || status == LENSPROF_ERROR_ARGUMENT,
           "unexpected status");
    demand((status == LENSPROF_OK) == !error.text[0], "status and error text contradict each other");
    demand((status == LENSPROF_OK) == (pto != nullptr), "status and project contradict each other");
    return Project(pto);
}

std::vector<char> write(const Project &pto) {
    return written([&](char *text, size_t capacity, size_t *count) {
        return lensprof_pto_write(pto.get(), text, capacity, count, nullptr);
    });
}

void visit_images(const Project &pto) {
    for (uint32_t i = 0; i < lensprof_pto_image_count(pto.get()); i++) {
        lensprof_pto_image image;
        lensprof_pto_image_init(&image);
        lensprof_response response;
        demand(lensprof_pto_get_image(pto.get(), i, &image, nullptr) == LENSPROF_OK, "no image");
        demand(lensprof_pto_get_response(pto.get(), i, &response, nullptr) == LENSPROF_OK, "no response");
        demand(lensprof_response_validate(&response) == LENSPROF_OK, "an invalid response");
        written([&](char *name, size_t capacity, size_t *count) {
            return lensprof_pto_get_name(pto.get(), i, name, capacity, count, nullptr);
        });
        std::array<uint8_t, 16 * 12> mask;
        mask.fill(2);
        demand(lensprof_pto_draw_mask(pto.get(), i, mask.data(), 16, 12, 16, nullptr) == LENSPROF_OK, "no mask");
        for (uint8_t value : mask) demand(value <= 1, "a mask that is neither 0 nor 1");
    }
}

void set_result(const Project &pto) {
    lensprof_response response;
    lensprof_response_set_linear(&response);
    lensprof_vignetting vignetting{};
    vignetting.k[0] = -0.2;
    std::vector<lensprof_exposure> exposures(lensprof_pto_image_count(pto.get()));
    for (auto &exposure : exposures) lensprof_exposure_init(&exposure);
    const auto count = static_cast<uint32_t>(exposures.size());
    demand(
        lensprof_pto_set_result(pto.get(), &response, &vignetting, exposures.data(), count, 0, nullptr) == LENSPROF_OK,
        "takes no result");
    demand(read(write(pto)) != nullptr, "does not read back with a result");
}

bool try_bytes(const std::vector<char> &bytes) {
    const Project pto = read(bytes);
    if (!pto || lensprof_pto_image_count(pto.get()) > kMostImages) return false;
    visit_images(pto);
    const std::vector<char> text = write(pto);
    const Project again = read(text);
    demand(again && write(again) == text, "does not read back the same");
    if (lensprof_pto_image_count(pto.get()) > 0) set_result(pto);
    return true;
}

}  // namespace
