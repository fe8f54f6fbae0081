#include "photo/scene/exposure_reader.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include <nlohmann/json.hpp>

#include "photo/base/format.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/reconstruction/pictures.hpp"

namespace lensprof {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr uint64_t max_file_bytes = uint64_t(1) << 30;
constexpr double max_ev = 30.0;  // relative to the reference

// Reads the file and reports errors.
class Reader {
public:
    explicit Reader(const std::string &path) : path_(path) {}

    [[noreturn]] void fail(const std::string &what) const {
        throw Failure(LENSPROF_ERROR_READ, path_ + ": " + what + advice("exposure_file_wanted"));
    }
    const Json &member(const Json &object, const char *name) const {
        if (!object.is_object() || !object.contains(name)) fail(std::string("has no ") + name);
        return object[name];
    }
    const Json &list(const Json &object, const char *name) const {
        const Json &found = member(object, name);
        if (!found.is_array() || found.empty()) fail(std::string("has no list of ") + name);
        return found;
    }
    double number(const Json &value, const char *name) const {
        if (!value.is_number() || !std::isfinite(value.get<double>())) fail(std::string(name) + " is not a number");
        return value.get<double>();
    }
    uint32_t index(const Json &object, const char *name, size_t count) const {
        const double number = this->number(member(object, name), name);
        if (number < 0.0 || number >= double(count) || number != std::floor(number))
            fail(std::string(name) + " is not an index of an element of the file");
        return static_cast<uint32_t>(number);
    }
    std::string text(const Json &object, const char *name) const {
        const Json &value = member(object, name);
        if (!value.is_string() || value.get_ref<const std::string &>().empty())
            fail(std::string(name) + " is not a string");
        if (value.get_ref<const std::string &>().find('\0') != std::string::npos)
            fail(std::string(name) + " is not a valid name");
        return value.get<std::string>();
    }
    std::vector<double> numbers(const Json &object, const char *name, size_t max_count) const {
        std::vector<double> values;
        for (const Json &value : list(object, name)) values.push_back(number(value, name));
        if (values.size() > max_count) fail(std::string(name) + " has too many numbers");
        return values;
    }

    lensprof_response response(const Json &camera) const;
    void vignetting(const Json &lens, lensprof_profile &model) const;
    lensprof_exposure exposure(const Json &image) const;

private:
    std::string path_;
};

lensprof_response Reader::response(const Json &camera) const {
    const Json &json = member(camera, "response");
    const std::string kind = text(json, "kind");
    lensprof_response response{};
    lensprof_status status = LENSPROF_OK;
    if (kind == "linear") {
        lensprof_response_set_linear(&response);
    } else if (kind == "gamma") {
        status = lensprof_response_set_gamma(&response, number(member(json, "gamma"), "gamma"));
    } else if (kind == "emor") {
        const Json &modes = member(json, "emor");
        const std::vector<double> values = modes.empty() ? std::vector<double>() : numbers(json, "emor", 25);
        status = lensprof_response_set_emor(&response, values.data(), static_cast<uint32_t>(values.size()));
    } else if (kind != "table") {
        fail("unknown kind of response " + short_name(kind));
    } else {
        const Json &channels = list(json, "values");
        const std::vector<double> values = numbers({{"values", channels[0]}}, "values", LENSPROF_RESPONSE_SAMPLES);
        status = values.size() < 2
                     ? LENSPROF_ERROR_RESPONSE
                     : lensprof_response_set_table(&response, values.data(), static_cast<uint32_t>(values.size()));
    }
    if (status != LENSPROF_OK) fail("a response is not valid");
    return response;
}

void Reader::vignetting(const Json &lens, lensprof_profile &model) const {
    const Json &json = member(lens, "vignetting"), &curves = list(json, "k");
    const std::vector<double> center = numbers(json, "center", 2);
    if ((curves.size() != 1 && curves.size() != 3) || center.size() != 2) fail("a vignetting is not valid");
    model.vignettings = static_cast<uint32_t>(curves.size());
    for (size_t c = 0; c < curves.size(); c++) {
        const std::vector<double> k = numbers({{"k", curves[c]}}, "k", 3);
        if (k.size() != 3) fail("a vignetting is not valid");
        std::copy(k.begin(), k.end(), model.vignetting[c].k);
        std::copy(center.begin(), center.end(), model.vignetting[c].center);
        if (lensprof_vignetting_validate(&model.vignetting[c]) != LENSPROF_OK) fail("a vignetting is not valid");
    }
}

lensprof_exposure Reader::exposure(const Json &image) const {
    lensprof_exposure result;
    lensprof_exposure_init(&result);
    result.ev = number(member(image, "ev"), "ev");
    const std::vector<double> balance = numbers(image, "white_balance", 3);
    if (balance.size() != 3 || std::fabs(result.ev) > max_ev) fail("an exposure is not valid");
    for (size_t c = 0; c < 3; c++)
        if (!(balance[c] >= 1e-6 && balance[c] <= 1e6)) fail("a white balance is not valid");
    std::copy(balance.begin(), balance.end(), result.white_balance);
    return result;
}

// One model per lens, shared by its images.
std::vector<std::shared_ptr<const lensprof_profile>> models_of(const Reader &reader, const Json &all) {
    const Json &cameras = reader.list(all, "cameras");
    std::vector<lensprof_response> responses;
    for (const Json &camera : cameras) responses.push_back(reader.response(camera));
    std::vector<std::shared_ptr<const lensprof_profile>> models;
    for (const Json &lens : reader.list(all, "lenses")) {
        auto model = std::shared_ptr<lensprof_profile>(new_profile());
        model->response[0] = responses[reader.index(lens, "camera", responses.size())];
        reader.vignetting(lens, *model);
        models.push_back(model);
    }
    return models;
}

void add_image(const Reader &reader, const Json &json,
               const std::vector<std::shared_ptr<const lensprof_profile>> &models, const std::string &images,
               Scene &scene) {
    const std::string name = reader.text(json, "name");
    const fs::path folder = fs::path(scene.path).parent_path();
    const auto side = [&](const char *member) {
        const double value = reader.number(reader.member(json, member), member);
        if (value < 1.0 || value > double(max_image_side) || value != std::floor(value))
            reader.fail(name + " has no size");
        return static_cast<uint32_t>(value);
    };
    lensprof_pto_image image;
    lensprof_pto_image_init(&image);
    image.camera.width = side("width"), image.camera.height = side("height");
    image.left_out = reader.member(json, "ev").is_null();
    lensprof_exposure_init(&image.exposure);
    if (!image.left_out) image.exposure = reader.exposure(json);
    const auto index = static_cast<uint32_t>(scene.images.size());
    image.response_of = image.vignetting_of = image.center_of = image.ev_of = image.red_of = image.blue_of = index;
    scene.images.push_back(image);
    scene.models.push_back(models[reader.index(json, "lens", models.size())]);
    scene.names.push_back(name);
    const bool has_file = json.contains("file") && images.empty();
    if (!has_file && images.empty())
        reader.fail("does not state the folder of " + name + "; give it with " + option_name("images"));
    scene.files.push_back(has_file ? (folder / reader.text(json, "file")).lexically_normal().string()
                                   : picture_of_name(images, name));
}

}  // namespace

bool is_exposure_file(const std::string &path) {
    return read_head(path, 256).find("\"lensprof exposures\"") != std::string::npos;
}

Scene exposures_of(const Json &all, const std::string &path, const std::string &images) {
    const Reader reader(path);
    if (!all.is_object() || !all.contains("file") || all["file"] != "lensprof exposures")
        reader.fail("is not a file of exposures");
    if (reader.member(all, "schema") != exposures_schema) reader.fail("has another format version");
    Scene scene;
    scene.path = path;
    const auto models = models_of(reader, all);
    std::set<std::string> names;
    for (const Json &image : reader.list(all, "images")) {
        add_image(reader, image, models, images, scene);
        if (!names.insert(scene.names.back()).second) reader.fail("names " + scene.names.back() + " twice");
    }
    if (std::all_of(scene.images.begin(), scene.images.end(), [](const auto &image) { return image.left_out; }))
        reader.fail("has no exposures");
    const std::string reference = reader.text(all, "reference");
    if (!names.count(reference)) reader.fail("does not contain the reference image " + short_name(reference));
    for (uint32_t i = 0; i < scene.names.size(); i++)
        if (scene.names[i] == reference) scene.reference = i;
    return scene;
}

Scene read_exposures(const std::string &path, const std::string &images) {
    return exposures_of(Json::parse(read_text(path, max_file_bytes), nullptr, false), path, images);
}

}  // namespace lensprof
