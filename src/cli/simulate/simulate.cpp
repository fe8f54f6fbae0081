// `lensprof simulate`: overlapping pictures of a procedural scene, taken by a known camera.
#include "cli/simulate/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "cli/program/commands.hpp"
#include "cli/program/options.hpp"
#include "cli/program/progress.hpp"
#include "cli/program/run.hpp"
#include "photo/base/events.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/parallel.hpp"
#include "photo/base/paths.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/scene/hugin_project.hpp"
#include "photo/scene/point_file.hpp"
#include "photo/scene/scene.hpp"

namespace lensprof {
namespace {

// Irradiance of one picture before the lens, as float RGB.
Picture render(const Truth &truth, const SimulatedScene &scene, uint32_t i) {
    const auto &camera = truth.cameras[i];
    Picture picture;
    picture.width = picture.frame_width = camera.width;
    picture.height = picture.frame_height = camera.height;
    picture.sample = LENSPROF_SAMPLE_F32;
    picture.row_bytes = static_cast<size_t>(camera.width) * 3 * sizeof(float);
    picture.pixels.resize(picture.row_bytes * camera.height);
    for (uint32_t y = 0; y < camera.height; y++) {
        stop_if_cancelled();
        auto *row = reinterpret_cast<float *>(&picture.pixels[y * picture.row_bytes]);
        for (uint32_t x = 0; x < camera.width; x++) {
            double rgb[3];
            seen_radiance(truth, scene, i, x, y, rgb);
            for (int c = 0; c < 3; c++) row[3 * x + static_cast<uint32_t>(c)] = static_cast<float>(rgb[c]);
        }
    }
    return picture;
}

// The effect of the camera: the library's own correction, run in reverse.
void expose(const Truth &truth, uint32_t i, Picture &picture) {
    lensprof_apply_options options;
    lensprof_apply_options_init(&options);
    options.direction = LENSPROF_DIRECTION_SIMULATE;
    options.input = LENSPROF_ENCODING_LINEAR;
    options.frame_width = picture.width;
    options.frame_height = picture.height;
    options.source_sample = options.target_sample = LENSPROF_SAMPLE_F32;
    options.response = &truth.response;
    options.vignettings = truth.vignettings;
    options.vignetting = truth.vignetting;
    options.source = truth.exposures[i];
    std::vector<uint64_t> memory(lensprof_plan_bytes(&options) / 8 + 1);
    const lensprof_plan *plan = nullptr;
    lensprof_error error{};
    check(lensprof_plan_init(memory.data(), memory.size() * 8, &options, &plan, &error), "simulate", &error);
    const lensprof_target target = picture.target();
    check(lensprof_apply(plan, nullptr, &target, 0, 0), "simulate");
}

void map_tones(const Truth &truth, uint32_t i, Picture &picture) {
    for (uint32_t y = 0; y < picture.height; y++) {
        auto *row = reinterpret_cast<float *>(&picture.pixels[y * picture.row_bytes]);
        for (uint32_t x = 0; x < picture.width; x++) {
            float *pixel = row + 3 * x;
            double value[3] = {pixel[0], pixel[1], pixel[2]};
            map_tone(tone_gain(truth, i, x, y), value);
            for (int c = 0; c < 3; c++) pixel[c] = static_cast<float>(value[c]);
        }
    }
}

// Noise, outliers and rounding. A saturated sample stays exactly white: clipping follows the noise in a camera.
void digitise(const Truth &truth, uint32_t i, uint32_t sample, Picture &picture) {
    Random random(truth.seed * 7919ull + i);
    Picture result = picture;
    result.sample = sample;
    result.row_bytes = static_cast<size_t>(result.width) * 3 * lensprof_sample_type_bytes(sample);
    result.pixels.assign(result.row_bytes * result.height, 0);
    for (uint32_t y = 0; y < picture.height; y++) {
        stop_if_cancelled();
        const auto *row = reinterpret_cast<const float *>(&picture.pixels[y * picture.row_bytes]);
        uint8_t *out = &result.pixels[y * result.row_bytes];
        for (uint32_t x = 0; x < picture.width; x++) {
            bool outlier = truth.outlier_share > 0.0 && random.uniform() < truth.outlier_share;
            for (uint32_t c = 0; c < 3; c++) {
                double value = row[3 * x + c];
                if (outlier)
                    value = random.uniform();
                else if (value < 1.0 && truth.noise_levels > 0.0)
                    value += random.normal() * truth.noise_levels / 255.0;
                value = std::clamp(value, 0.0, 1.0);
                uint32_t s = 3 * x + c;
                if (sample == LENSPROF_SAMPLE_U8) {
                    out[s] = static_cast<uint8_t>(std::lround(value * 255.0));
                } else if (sample == LENSPROF_SAMPLE_U16) {
                    auto code = static_cast<uint16_t>(std::lround(value * 65535.0));
                    std::memcpy(out + 2 * s, &code, 2);
                } else {
                    auto code = static_cast<float>(value);
                    std::memcpy(out + 4 * s, &code, 4);
                }
            }
        }
    }
    picture = std::move(result);
}

PictureMetadata metadata_of(const Truth &truth, uint32_t i) {
    PictureMetadata m = unknown_metadata();
    set_text(m.key.camera_maker, sizeof m.key.camera_maker, "lensprof");
    set_text(m.key.camera_model, sizeof m.key.camera_model, "Simulated Camera");
    set_text(m.key.lens, sizeof m.key.lens, "Simulated Lens");
    m.software = "lensprof";  // so that the response is not taken for that of a camera's own JPEG
    double half = truth.cameras[i].hfov_deg * std::acos(-1.0) / 360.0;
    m.key.focal_mm = std::round(180.0 / std::tan(half)) / 10.0;  // on a sensor 36 mm wide
    m.key.aperture = kSimulatedFNumber;
    m.f_number = kSimulatedFNumber;
    if (!truth.settings.empty()) {
        m.iso = truth.settings[i].iso;
        m.exposure_time_s = truth.settings[i].time_s;
        m.is_manual = truth.is_manual;
    }
    return m;
}

void write_pictures(const SimulateOptions &o, const Truth &truth, const SimulatedScene &scene, Progress &progress) {
    for_each_parallel(static_cast<uint32_t>(truth.files.size()), "rendering", progress, [&](uint32_t i) {
        Picture picture = render(truth, scene, i);
        expose(truth, i, picture);
        if (!truth.tone.empty()) map_tones(truth, i, picture);
        if (truth.sharpening > 0.0) sharpen(truth.sharpening, picture);
        digitise(truth, i, o.formats[i % o.formats.size()].sample, picture);
        PictureMetadata metadata = metadata_of(truth, i);
        WriteOptions write;
        write.metadata = &metadata;
        std::string path = (std::filesystem::path(o.output) / truth.files[i]).string();
        if (!write_picture(path, picture, write) && o.exif)
            throw Failure(LENSPROF_ERROR_WRITE,
                          path + ": EXIF cannot be written to a TIFF of 4 GB; use a smaller --size");
    });
}

int run(const SimulateOptions &o, Streams &streams) {
    check_simulate_options(o);
    const SimulatedScene scene(o.seed, o.scene);
    const Truth truth = make_truth(o, scene);
    make_folder(o.output);
    std::filesystem::path folder(o.output);

    Progress progress(streams, o.progress);
    if (!o.no_images) write_pictures(o, truth, scene, progress);
    const std::string pto = (folder / "pano.pto").string(), truth_file = (folder / "truth.json").string();
    // A project cannot store the position of a moving camera.
    if (!o.moving) write_hugin_project(aligned_scene(o, truth), pto);
    const std::string json = truth_text(truth);
    write_file(truth_file, json.data(), json.size());
    if (o.points || o.test_points) {
        Scene read = read_hugin_project(pto);
        uint32_t levels = o.formats[0].sample == LENSPROF_SAMPLE_U8 ? 255 : 65535;
        auto write = [&](const char *name, uint32_t count, double darkest, bool noisy) {
            std::string text = points_text(simulate_pairs(truth, scene, count, darkest, noisy, levels), read);
            write_file((folder / name).string(), text.data(), text.size());
        };
        if (o.points) write("points.txt", o.points, 1.0 / 255.0, true);
        if (o.test_points) write("test_points.txt", o.test_points, 3.0 / 255.0, false);
    }
    progress.clear();
    streams.out << (o.moving ? truth_file : pto) << "\n";
    return 0;
}

}  // namespace

void declare_simulate(Command &program) {
    Command command = program.add(
        "simulate", "render overlapping pictures of a simulated camera",
        "Renders overlapping pictures of a procedural scene and writes the true camera parameters to truth.json.");
    auto o = std::make_shared<SimulateOptions>();
    declare_simulate_options(command, *o);
    command.example("lensprof simulate -o pictures --set mean-ev=-0.8");
    command.run([o](Streams &streams) { return run(*o, streams); });
}

}  // namespace lensprof
