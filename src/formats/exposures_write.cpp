// Measured exposures to JSON.
#include "formats/exposures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace lensprof {
namespace {

constexpr size_t kMaxBytes = size_t{64} << 20;  // that are read

[[noreturn]] void fail_at(const char *kind, size_t index, const std::string &text,
                          lensprof_status status = LENSPROF_ERROR_ARGUMENT) {
    throw FormatFailure{status, kind + (" " + std::to_string(index)) + ": " + text};
}

// The elements of a program's array in structs of this library.
template <class Item>
std::vector<Item> items_of(const Item *given, uint32_t count, void (*init)(Item *), size_t first, const char *name) {
    if (!given || !count)
        throw FormatFailure{LENSPROF_ERROR_ARGUMENT, std::string("no ") + name + "; give at least one"};
    std::vector<Item> items(count);
    for (uint32_t i = 0; i < count; i++) {
        init(&items[i]);
        const char *wrong = lp_sized_is_alike(given, i) ? lp_sized_take(&items[i], lp_sized_at(given, i), first)
                                                        : "struct_size differs from that of the first; initialise all";
        if (wrong) throw FormatFailure{LENSPROF_ERROR_STRUCT_SIZE, std::string(name) + ": " + wrong};
    }
    return items;
}

class ExposuresWriter {
public:
    explicit ExposuresWriter(lensprof_exposures all) : all_(std::move(all)) {}

    std::string text() {
        check();
        json_.open('{');
        json_.name("schema");
        json_.integer(kExposuresSchema);
        write_text(json_, "file", kExposuresFile);
        const std::string current = std::string("lensprof ") + lensprof_version();
        write_text(json_, "software", all_.info.software ? all_.info.software : current.c_str());
        write_text(json_, "reference", all_.images[all_.info.reference].name);
        write_mean();
        write_list("cameras", all_.cameras, [&](const lensprof_exposures_camera &camera) { write_camera(camera); });
        write_list("lenses", all_.lenses, [&](const lensprof_exposures_lens &lens) { write_lens(lens); });
        write_list("images", all_.images, [&](const lensprof_exposures_image &image) { write_image(image); });
        json_.close('}');
        const std::string text = json_.all();
        if (text.size() > kMaxBytes)
            throw FormatFailure{LENSPROF_ERROR_SIZE, "over 64 MiB of exposures; write fewer images to a file"};
        return text;
    }

private:
    void check() const {
        for (size_t i = 0; i < all_.cameras.size(); i++)
            if (lensprof_response_validate(&all_.cameras[i].response) != LENSPROF_OK)
                fail_at("camera", i, "is not a response; see lensprof_response_validate", LENSPROF_ERROR_RESPONSE);
        for (size_t i = 0; i < all_.lenses.size(); i++) check_lens(i);
        std::set<std::string_view> names;
        for (uint32_t i = 0; i < all_.images.size(); i++) {
            check_image(i);
            if (!names.insert(all_.images[i].name).second)
                fail_at_image(i, "has the name of another image; give each its own");
        }
        if (all_.info.reference >= all_.images.size())
            throw FormatFailure{LENSPROF_ERROR_ARGUMENT, "reference is not the index of an image; correct it"};
        if (std::all_of(all_.images.begin(), all_.images.end(), is_left_out))
            throw FormatFailure{LENSPROF_ERROR_ARGUMENT, "no image has an exposure; there is nothing to write"};
    }

    void check_lens(size_t i) const {
        const lensprof_exposures_lens &lens = all_.lenses[i];
        if (lens.camera >= all_.cameras.size()) fail_at("lens", i, "camera is not the index of a camera; correct it");
        if (lens.vignettings != 1 && lens.vignettings != 3)
            fail_at("lens", i, "vignettings is neither 1 nor 3; correct it");
        for (uint32_t c = 0; c < lens.vignettings; c++)
            if (lensprof_vignetting_validate(&lens.vignetting[c]) != LENSPROF_OK)
                fail_at("lens", i, "is not a falloff; see lensprof_vignetting_validate", LENSPROF_ERROR_VIGNETTING);
    }

    [[noreturn]] static void fail_at_image(uint32_t i, const char *text,
                                           lensprof_status status = LENSPROF_ERROR_ARGUMENT) {
        throw failure_at(LENSPROF_ITEM_IMAGE, i, text, status);
    }

    void check_image(uint32_t i) const {
        const auto is_side = [](uint32_t side) { return side >= 1 && side <= kExposuresSide; };
        const auto is_negative = [](double sigma) { return sigma < 0.0 && sigma != LENSPROF_UNKNOWN; };
        const lensprof_exposures_image &image = all_.images[i];
        const double *sigmas = image.white_balance_sigma;
        if (!image.name || !*image.name) fail_at_image(i, "has no name; set it");
        if (image.file && !*image.file) fail_at_image(i, "file is empty; set it, or pass NULL");
        if (!is_side(image.width) || !is_side(image.height))
            fail_at_image(i, "width or height is not 1..1048576 px; set it");
        if (image.lens >= all_.lenses.size()) fail_at_image(i, "lens is not the index of a lens; correct it");
        if (!is_left_out(image) && lensprof_exposure_validate(&image.exposure) != LENSPROF_OK)
            fail_at_image(i, "is not an exposure; see lensprof_exposure_validate", LENSPROF_ERROR_EXPOSURE);
        if (is_negative(image.ev_sigma) || std::any_of(sigmas, sigmas + 3, is_negative))
            fail_at_image(i, "a standard error is below 0; correct it, or pass LENSPROF_UNKNOWN");
    }

    static bool is_left_out(const lensprof_exposures_image &image) { return std::isnan(image.exposure.ev); }

    template <class Item, class Write>
    void write_list(const char *name, const std::vector<Item> &items, Write write) {
        json_.name(name);
        json_.open('[');
        for (const Item &item : items) {
            json_.open('{');
            write(item);
            json_.close('}');
        }
        json_.close(']');
    }

    void write_exposure(const lensprof_exposure &exposure) {
        json_.name("ev");
        json_.number(exposure.ev);
        json_.name("white_balance");
        json_.numbers(exposure.white_balance, 3);
    }

    void write_mean() {
        std::vector<lensprof_exposure> exposures;
        for (const lensprof_exposures_image &image : all_.images) exposures.push_back(image.exposure);
        lensprof_exposure mean;
        lensprof_exposure_mean(exposures.data(), exposures.size(), &mean);
        json_.name("mean");
        json_.open('{');
        write_exposure(mean);
        json_.close('}');
    }

    // The response in its own form, and the irradiance of every 8 bit grey level.
    void write_camera(const lensprof_exposures_camera &camera) {
        if (camera.name) write_text(json_, "name", camera.name);
        json_.name("response");
        json_.open('{');
        write_kind(json_, camera.response);
        if (!is_implied(camera.response)) {
            json_.name("values");
            json_.open('[');
            json_.numbers(camera.response.table, LENSPROF_RESPONSE_SAMPLES);
            json_.close(']');
        }
        json_.close('}');
        std::array<double, kLevels> light;
        for (size_t level = 0; level < kLevels; level++)
            light[level] = lensprof_response_invert(&camera.response, static_cast<double>(level) / 255.0, nullptr);
        json_.name("light_of_level");
        json_.numbers(light.data(), kLevels);
    }

    void write_lens(const lensprof_exposures_lens &lens) {
        if (lens.name) write_text(json_, "name", lens.name);
        json_.name("camera");
        json_.integer(lens.camera);
        write_vignetting(json_, lens.vignetting, lens.vignettings);
    }

    void write_image(const lensprof_exposures_image &image) {
        write_text(json_, "name", image.name);
        if (image.file) write_text(json_, "file", image.file);
        json_.name("width");
        json_.integer(image.width);
        json_.name("height");
        json_.integer(image.height);
        json_.name("lens");
        json_.integer(image.lens);
        if (is_left_out(image)) {
            json_.name("ev");
            return json_.word("null");
        }
        write_exposure(image.exposure);
        write_known(json_, "ev_sigma", image.ev_sigma);
        json_.name("white_balance_sigma");
        json_.open('[');
        for (double sigma : image.white_balance_sigma) json_.known(sigma);
        json_.close(']');
    }

    const lensprof_exposures all_;
    JsonWriter json_{JsonWriter::kIndented};
};

}  // namespace
}  // namespace lensprof

using namespace lensprof;

lensprof_status lensprof_exposures_write(const lensprof_exposures_info *info, const lensprof_exposures_camera *cameras,
                                         const lensprof_exposures_lens *lenses, const lensprof_exposures_image *images,
                                         void *data, size_t capacity, size_t *count, lensprof_error *error) {
    if (!info || (!data && capacity)) {
        set_error(error, "lensprof_exposures_write: info or data is NULL; pass the counts and a buffer");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return write_at_boundary(data, capacity, count, error, [&] {
        lensprof_exposures all;
        lensprof_exposures_info_init(&all.info);
        if (const char *wrong = lp_sized_take(&all.info, info, kFirstInfo))
            throw FormatFailure{LENSPROF_ERROR_STRUCT_SIZE, wrong};
        all.cameras = items_of(cameras, all.info.camera_count, lensprof_exposures_camera_init, kFirstCamera, "cameras");
        all.lenses = items_of(lenses, all.info.lens_count, lensprof_exposures_lens_init, kFirstLens, "lenses");
        all.images = items_of(images, all.info.image_count, lensprof_exposures_image_init, kFirstImage, "images");
        return ExposuresWriter(std::move(all)).text();
    });
}
