// Measured exposures from JSON.
#include "formats/exposures.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

namespace lensprof {
namespace {

// A member that is an array with at least one object.
JsonValue list_of(const JsonValue &object, const char *name) {
    const JsonValue list = object.required(name);
    if (!list.is_array() || !list.size()) list.fail("is not an array of objects; correct it");
    return list;
}

// Calls read(object) for each object of a list.
template <class Read>
void read_each(const JsonValue &list, Read read) {
    size_t count = 0;
    for (JsonValue object = list.first(); object; object = object.next(), count++) read(object);
    if (count != list.size()) list.fail("holds null; remove it");
}

uint32_t index_of(const JsonValue &object, const char *name, size_t count) {
    return static_cast<uint32_t>(object.required(name).integer(0, static_cast<int64_t>(count) - 1));
}

// Standard errors; unknown if null or missing.
double sigma_of(const JsonValue &value) {
    if (!value) return LENSPROF_UNKNOWN;
    const double sigma = value.number();
    if (sigma < 0.0) value.fail("is below 0; correct it, null means unknown");
    return sigma;
}

class ExposuresReader {
public:
    explicit ExposuresReader(lensprof_exposures &all) : all_(all) {}

    void read(const JsonValue &root) {
        check_kind(root);
        lensprof_exposures_info_init(&all_.info);
        if (const JsonValue software = root["software"]) all_.info.software = keep(software);
        if (const JsonValue mean = root["mean"]) read_exposure(mean);
        read_each(list_of(root, "cameras"), [&](const JsonValue &camera) { add_camera(camera); });
        read_each(list_of(root, "lenses"), [&](const JsonValue &lens) { add_lens(lens); });
        const JsonValue images = list_of(root, "images");
        read_each(images, [&](const JsonValue &image) { add_image(image); });
        if (std::all_of(all_.images.begin(), all_.images.end(),
                        [](const auto &i) { return std::isnan(i.exposure.ev); }))
            images.fail("has no image with an \"ev\"; give a file with a result", LENSPROF_ERROR_EXPOSURE);
        find_reference(root.required("reference"));
        all_.info.camera_count = static_cast<uint32_t>(all_.cameras.size());
        all_.info.lens_count = static_cast<uint32_t>(all_.lenses.size());
        all_.info.image_count = static_cast<uint32_t>(all_.images.size());
    }

private:
    void check_kind(const JsonValue &root) {
        if (!root.is_object()) root.fail("is not an object; correct it");
        const JsonValue file = root.required("file"), schema = root.required("schema");
        if (file.text() != kExposuresFile) file.fail(std::string("is not \"") + kExposuresFile + "\"; correct it");
        if (schema.integer(INT64_MIN, INT64_MAX) != kExposuresSchema)
            schema.fail("is not 1; use the version of lensprof that wrote the file", LENSPROF_ERROR_UNSUPPORTED);
    }

    const char *keep(const JsonValue &value) {
        const std::string_view text = value.text();
        if (text.find('\0') != text.npos) value.fail("has a zero byte; remove it");
        return all_.texts.emplace_back(text).c_str();
    }

    // A text that must not be empty.
    const char *keep_name(const JsonValue &value) {
        const char *name = keep(value);
        if (!*name) value.fail("is empty; correct it");
        return name;
    }

    static lensprof_exposure read_exposure(const JsonValue &object) {
        lensprof_exposure exposure;
        const JsonValue balance = object.required("white_balance");
        const std::vector<double> factors = balance.numbers(3, 3);
        exposure.ev = object.required("ev").number_within(-64.0, 64.0);
        std::copy(factors.begin(), factors.end(), exposure.white_balance);
        if (lensprof_exposure_validate(&exposure) != LENSPROF_OK)
            balance.fail("is not three factors of 1e-6 to 1e6; correct it", LENSPROF_ERROR_EXPOSURE);
        return exposure;
    }

    void add_camera(const JsonValue &json) {
        lensprof_exposures_camera camera;
        lensprof_exposures_camera_init(&camera);
        if (const JsonValue name = json["name"]) camera.name = keep(name);
        const JsonValue response = json.required("response"), values = response["values"];
        if (values && (!values.is_array() || values.size() != 1)) values.fail("does not hold one list; correct it");
        read_curve(response, values ? values.first() : values, camera.response);
        if (const JsonValue light = json["light_of_level"]) light.numbers(kLevels, kLevels);
        all_.cameras.push_back(camera);
    }

    void add_lens(const JsonValue &json) {
        lensprof_exposures_lens lens;
        lensprof_exposures_lens_init(&lens);
        if (const JsonValue name = json["name"]) lens.name = keep(name);
        lens.camera = index_of(json, "camera", all_.cameras.size());
        lens.vignettings = read_vignetting(json.required("vignetting"), lens.vignetting);
        all_.lenses.push_back(lens);
    }

    void add_image(const JsonValue &json) {
        lensprof_exposures_image image;
        lensprof_exposures_image_init(&image);
        const JsonValue name = json.required("name");
        image.name = keep_name(name);
        if (!names_.insert(image.name).second) name.fail("is that of another image; correct it");
        if (const JsonValue file = json["file"]) image.file = keep_name(file);
        image.width = static_cast<uint32_t>(json.required("width").integer(1, kExposuresSide));
        image.height = static_cast<uint32_t>(json.required("height").integer(1, kExposuresSide));
        image.lens = index_of(json, "lens", all_.lenses.size());
        if (json.has("ev") && !json["ev"])
            image.exposure.ev = NAN;
        else
            read_result(json, image);
        all_.images.push_back(image);
    }

    static void read_result(const JsonValue &json, lensprof_exposures_image &image) {
        image.exposure = read_exposure(json);
        image.ev_sigma = sigma_of(json["ev_sigma"]);
        const JsonValue sigmas = json["white_balance_sigma"];
        if (!sigmas) return;
        if (!sigmas.is_array() || sigmas.size() != 3) sigmas.fail("is not an array of three; correct it");
        JsonValue sigma = sigmas.first();
        for (double &of_channel : image.white_balance_sigma) of_channel = sigma_of(sigma), sigma = sigma.next();
    }

    void find_reference(const JsonValue &reference) {
        const std::string_view name = reference.text();
        const auto found =
            std::find_if(all_.images.begin(), all_.images.end(), [&](const auto &i) { return name == i.name; });
        if (found == all_.images.end())
            reference.fail("is " + in_quotes(name) + ", not the name of an image; correct it");
        all_.info.reference = static_cast<uint32_t>(found - all_.images.begin());
    }

    lensprof_exposures &all_;
    std::set<std::string_view> names_;
};

template <class Item>
lensprof_status get_item(const Item *item, Item *out, size_t first, lensprof_error *error) {
    if (!item || !out) {
        set_error(error,
                  "exposures or the result is NULL, or the index is out of range; see lensprof_exposures_get_info");
        return LENSPROF_ERROR_ARGUMENT;
    }
    if (const char *wrong = lp_sized_wrong(out, first, sizeof *out)) {
        set_error(error, wrong);
        return LENSPROF_ERROR_STRUCT_SIZE;
    }
    set_error(error, "");
    lp_sized_copy(out, item);
    return LENSPROF_OK;
}

template <class Item>
const Item *item_at(const std::vector<Item> &items, uint32_t index) {
    return index < items.size() ? &items[index] : nullptr;
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

void lensprof_exposures_camera_init_sized(lensprof_exposures_camera *camera, size_t size) {
    if (lp_sized_begin(camera, size, kFirstCamera)) lensprof_response_set_linear(&camera->response);
}

void lensprof_exposures_lens_init_sized(lensprof_exposures_lens *lens, size_t size) {
    if (lp_sized_begin(lens, size, kFirstLens)) lens->vignettings = 1;
}

void lensprof_exposures_image_init_sized(lensprof_exposures_image *image, size_t size) {
    if (!lp_sized_begin(image, size, kFirstImage)) return;
    lensprof_exposure_init(&image->exposure);
    image->ev_sigma = LENSPROF_UNKNOWN;
    for (double &sigma : image->white_balance_sigma) sigma = LENSPROF_UNKNOWN;
}

lensprof_status lensprof_exposures_read(const void *data, size_t size, lensprof_exposures **exposures,
                                        lensprof_error *error) {
    if ((!data && size) || !exposures) {
        set_error(error,
                  "lensprof_exposures_read: data or exposures is NULL; pass a buffer and a place for the handle");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return at_boundary(error, [&] {
        const JsonText json(view_of(data, size));
        auto all = std::make_unique<lensprof_exposures>();
        ExposuresReader(*all).read(json.root());
        *exposures = all.release();
    });
}

void lensprof_exposures_destroy(lensprof_exposures *exposures) { delete exposures; }

lensprof_status lensprof_exposures_get_info(const lensprof_exposures *exposures, lensprof_exposures_info *info,
                                            lensprof_error *error) {
    return get_item(exposures ? &exposures->info : nullptr, info, kFirstInfo, error);
}

lensprof_status lensprof_exposures_get_camera(const lensprof_exposures *exposures, uint32_t index,
                                              lensprof_exposures_camera *camera, lensprof_error *error) {
    return get_item(exposures ? item_at(exposures->cameras, index) : nullptr, camera, kFirstCamera, error);
}

lensprof_status lensprof_exposures_get_lens(const lensprof_exposures *exposures, uint32_t index,
                                            lensprof_exposures_lens *lens, lensprof_error *error) {
    return get_item(exposures ? item_at(exposures->lenses, index) : nullptr, lens, kFirstLens, error);
}

lensprof_status lensprof_exposures_get_image(const lensprof_exposures *exposures, uint32_t index,
                                             lensprof_exposures_image *image, lensprof_error *error) {
    return get_item(exposures ? item_at(exposures->images, index) : nullptr, image, kFirstImage, error);
}
