// `lensprof simulate`: overlapping pictures of a procedural scene, taken by a known camera.
#include "cli/simulate/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "cli/fitting/project.hpp"
#include "cli/pictures/picture.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/format.hpp"
#include "cli/program/numbers.hpp"
#include "cli/program/options.hpp"
#include "cli/program/output_file.hpp"
#include "cli/program/parallel.hpp"
#include "cli/program/paths.hpp"
#include "cli/program/progress.hpp"
#include "cli/program/response_words.hpp"
#include "cli/program/run.hpp"
#include "cli/report/report.hpp"

namespace lensprof {
namespace {

// Of the pictures.
struct Format {
    const char *extension;
    uint32_t sample;
};

const Choices<Format> formats = {
    {"png", {".png", LENSPROF_SAMPLE_U8}},     {"png16", {".png", LENSPROF_SAMPLE_U16}},
    {"tiff", {".tif", LENSPROF_SAMPLE_U8}},    {"tiff16", {".tif", LENSPROF_SAMPLE_U16}},
    {"tiff32", {".tif", LENSPROF_SAMPLE_F32}}, {"jpeg", {".jpg", LENSPROF_SAMPLE_U8}},
};

struct Options {
    std::string output;
    lensprof_response response;
    std::vector<Format> formats = {{".png", LENSPROF_SAMPLE_U8}};
    uint32_t images = 6, rows = 1, seed = 1, points = 0, test_points = 0, width = 800, height = 600;
    double hfov = 50, overlap = 0.4, jitter = 1, ev = 1, mean_ev = 0, wb = 0.15, noise = 2, outliers = 0, misalign = 0,
           objects = 0, local_tone = 0, exif_rounding = 0, exif_scatter = 0;
    std::vector<double> vignetting{-0.30, 0.05, -0.15}, center{0.02, -0.015};
    bool no_images = false, exif = false, exif_manual = false;
};

void declare_camera(Command &command, Options &o) {
    o.response = response_of_word("srgb");
    command.size("--size", o.width, o.height, {16, 32768}, "of the pictures, px");
    command.number("--hfov", o.hfov, {1.0, 150.0}, "horizontal field of view, degrees");
    command.number("--overlap", o.overlap, {0.0, 0.99}, "share of a picture that the next one sees too");
    command.number("--jitter", o.jitter, {0.0, 20.0}, "sigma of yaw, pitch and roll, degrees");
    command.number("--misalign", o.misalign, {0.0, 1e3}, "sigma of the error of the project's yaw and pitch, px");
    command.word(
        "--response", "RESPONSE", [&o](const std::string &word) { o.response = response_of_word(word); },
        "linear, srgb, gamma:G, film, or emor:a,b,... (EMoR coefficients)");
    command.numbers("--vignetting", o.vignetting, any_number, "k1,k2,k3, or nine numbers for red, green, blue");
    command.numbers("--center", o.center, any_number, "x,y of the falloff's centre, half diagonals");
    command.number("--ev", o.ev, {0.0, 8.0}, "exposures are uniform within +- this, EV");
    command.number("--mean-ev", o.mean_ev, {-8.0, 8.0}, "about this; at 0 the brightest clouds are white");
    command.number("--wb", o.wb, {0.0, 0.9}, "white balance factors are uniform within 1 +- this");
}

void declare_disturbances(Command &command, Options &o) {
    command.number("--noise", o.noise, {0.0, 100.0}, "sigma, levels of 255");
    command.number("--outliers", o.outliers, {0.0, 1.0},
                   "share of pixels (and of --points pairs) replaced by random numbers");
    command.number("--objects", o.objects, {0.0, 0.9},
                   "share of every picture that moving objects cover; pairs with an end on one see it");
    command.number("--local-tone", o.local_tone, {0.0, 4.0},
                   "local tone mapping after the response, strongest gain, EV");
    command.flag("--exif", o.exif, "pictures tell exposure time and ISO too, true to the exposures");
    command.number("--exif-rounding", o.exif_rounding, {0.0, 4.0}, "sigma of the error of what they tell, EV");
    command.flag("--exif-manual", o.exif_manual, "they tell that the exposure was set by hand, at one ISO");
    command.number("--exif-scatter", o.exif_scatter, {0.0, 4.0},
                   "sigma of the shutter and aperture about what was set and is told, EV");
}

void declare(Command &command, Options &o) {
    command.folder("-o,--output", o.output, "folder for pictures, pano.pto and truth.json");
    command.require("--output");
    command.count("--images", o.images, 2, 5000, "number of pictures");
    command.count("--rows", o.rows, 1, 100, "rows of pictures");
    declare_camera(command, o);
    declare_disturbances(command, o);
    command.list("--format", o.formats, formats, "of the pictures; several, with commas, take turns");
    command.count("--seed", o.seed, 0, UINT32_MAX, "another seed, another scene and camera");
    command.count("--points", o.points, 0, 1000000, "also write points.txt with this many noisy pairs");
    command.count("--test-points", o.test_points, 0, 1000000,
                  "also write test_points.txt with noise-free pairs, for scoring");
    command.flag("--no-images", o.no_images, "write no pictures");
}

// A wide aperture, which stays: falloff changes with it.
constexpr double kFNumber = 2.8;

// Exposure time and ISO that make up the exposure of every image, but for --exif-rounding.
std::vector<Settings> exposure_settings(const Options &o, const Truth &truth) {
    Random random(truth.seed * 104729ull + 11);
    std::vector<Settings> settings;
    for (const auto &e : truth.exposures) {
        double stated = e.ev + o.exif_rounding * random.normal();
        double iso = 100.0 * std::exp2(std::floor(random.uniform(0.0, 4.0)));
        if (o.exif_manual) iso = 100.0;
        settings.push_back({std::exp2(stated) / iso, iso, kFNumber});  // 1/100 s at ISO 100 for 0 EV
    }
    return settings;
}

// What the pictures tell of their exposures, and how these then scatter.
void add_settings(const Options &o, Truth &truth) {
    truth.settings = exposure_settings(o, truth);
    truth.is_manual = o.exif_manual;
    Random random(truth.seed * 86028121ull + 7);
    for (auto &e : truth.exposures) e.ev += o.exif_scatter * random.normal();
}

// Asked for with --objects, --local-tone and --exif; random numbers of their own, so that the rest stays the same.
void add_disturbances(const Options &o, const Scene &scene, Truth &truth) {
    Random random(o.seed * 15485863ull + 3);
    truth.object_share = o.objects;
    truth.local_tone = o.local_tone;
    if (o.objects > 0.0)
        for (const auto &camera : truth.cameras) truth.objects.push_back(random_blocks(camera, o.objects, random));
    if (o.local_tone > 0.0)
        for (uint32_t i = 0; i < truth.cameras.size(); i++) truth.tone.push_back(tone_map(truth, scene, i));
    if (o.exif) add_settings(o, truth);
}

void check_exif(const Options &o) {
    if (o.exif && o.no_images)
        throw Failure(ExitCode::usage, "--exif: there is no picture to write it into; leave out --no-images");
    if (o.exif_rounding > 0.0 && !o.exif) throw Failure(ExitCode::usage, "--exif-rounding: needs --exif");
    if (o.exif_scatter > 0.0 && !o.exif) throw Failure(ExitCode::usage, "--exif-scatter: needs --exif");
    if (o.exif_manual && !o.exif) throw Failure(ExitCode::usage, "--exif-manual: needs --exif");
}

void place_cameras(const Options &o, Random &random, Truth &truth) {
    double degree = std::acos(-1.0) / 180.0,
           vfov = 2.0 / degree * std::atan(std::tan(o.hfov / 2.0 * degree) * o.height / o.width);
    uint32_t columns = (o.images + o.rows - 1) / o.rows;
    for (uint32_t i = 0; i < o.images; i++) {
        uint32_t row = i / columns, column = i % columns;
        lensprof_camera camera{};
        camera.width = o.width;
        camera.height = o.height;
        camera.hfov_deg = o.hfov;
        double yaw = (column - (columns - 1) / 2.0 + (row % 2 ? 0.5 : 0.0)) * o.hfov * (1.0 - o.overlap);
        camera.yaw_deg = std::remainder(yaw + o.jitter * random.normal(), 360.0);
        camera.pitch_deg = (row - (o.rows - 1) / 2.0) * vfov * (1.0 - o.overlap) + o.jitter * random.normal();
        camera.roll_deg = o.jitter * random.normal();
        check(lensprof_camera_validate(&camera), "--hfov");
        truth.cameras.push_back(camera);
    }
}

// Failure (usage) that names the option to blame: the curve, or where only it is off the middle the centre.
void check_falloff(lensprof_vignetting falloff) {
    if (lensprof_vignetting_validate(&falloff) == LENSPROF_OK) return;
    falloff.center[0] = falloff.center[1] = 0.0;
    if (lensprof_vignetting_validate(&falloff) != LENSPROF_OK)
        throw Failure(ExitCode::usage,
                      "--vignetting: the falloff must stay positive to the corner; give smaller numbers");
    throw Failure(ExitCode::usage,
                  "--center: the falloff must stay positive to the corner farthest from its centre; give "
                  "a centre nearer to 0,0");
}

Truth make_truth(const Options &o) {
    Truth truth;
    truth.seed = o.seed;
    truth.response = o.response;
    truth.noise_levels = o.noise;
    truth.outlier_share = o.outliers;
    if (o.vignetting.size() != 3 && o.vignetting.size() != 9)
        throw Failure(ExitCode::usage, "--vignetting: give three numbers, or nine");
    if (o.center.size() != 2) throw Failure(ExitCode::usage, "--center: give two numbers, x,y");
    truth.vignettings = static_cast<uint32_t>(o.vignetting.size() / 3);
    for (uint32_t c = 0; c < 3; c++) {
        for (uint32_t n = 0; n < 3; n++)
            truth.vignetting[c].k[n] = o.vignetting[(truth.vignettings == 3 ? 3 * c : 0) + n];
        for (uint32_t d = 0; d < 2; d++) truth.vignetting[c].center[d] = o.center[d];
        check_falloff(truth.vignetting[c]);
    }
    Random random(o.seed);
    place_cameras(o, random, truth);
    for (uint32_t i = 0; i < o.images; i++) {
        lensprof_exposure e;
        lensprof_exposure_init(&e);
        double draws[3] = {o.mean_ev + random.uniform(-o.ev, o.ev), random.uniform(1 - o.wb, 1 + o.wb),
                           random.uniform(1 - o.wb, 1 + o.wb)};
        e.ev = draws[0];
        if (i > 0) e.white_balance[0] = draws[1], e.white_balance[2] = draws[2];
        truth.exposures.push_back(e);
        truth.files.push_back(format("img%03u", i) + o.formats[i % o.formats.size()].extension);
    }
    return truth;
}

// Irradiance of one picture before the lens, as float RGB.
Picture render(const Truth &truth, const Scene &scene, uint32_t i) {
    const auto &camera = truth.cameras[i];
    Picture picture;
    picture.width = picture.frame_width = camera.width;
    picture.height = picture.frame_height = camera.height;
    picture.sample = LENSPROF_SAMPLE_F32;
    picture.row_bytes = static_cast<size_t>(camera.width) * 3 * sizeof(float);
    picture.pixels.resize(picture.row_bytes * camera.height);
    for (uint32_t y = 0; y < camera.height; y++) {
        auto *row = reinterpret_cast<float *>(&picture.pixels[y * picture.row_bytes]);
        for (uint32_t x = 0; x < camera.width; x++) {
            double rgb[3];
            seen_radiance(truth, scene, i, x, y, rgb);
            for (int c = 0; c < 3; c++) row[3 * x + static_cast<uint32_t>(c)] = static_cast<float>(rgb[c]);
        }
    }
    return picture;
}

// What the camera does to the light: the product's own apply, run backwards.
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
    lensprof_image view = picture.view();
    check(lensprof_apply(plan, &view, &view, 0, 0), "simulate");
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
    double half = truth.cameras[i].hfov_deg * std::acos(-1.0) / 360.0;
    m.key.focal_mm = std::round(180.0 / std::tan(half)) / 10.0;  // on a sensor 36 mm wide
    m.key.aperture = kFNumber;
    m.f_number = kFNumber;
    if (!truth.settings.empty()) {
        m.iso = truth.settings[i].iso;
        m.exposure_time_s = truth.settings[i].time_s;
        m.is_manual = truth.is_manual;
    }
    return m;
}

// The project as an alignment program would leave it: geometry known, exposures to be found.
std::string project_text(const Options &o, const Truth &truth) {
    Random random(truth.seed * 31ull + 5);
    std::string text =
        "# rendered by lensprof simulate\np f2 w3000 h1500 v360  E0 R0 n\"TIFF_m c:LZW\"\nm g1 i0 f0 m2 "
        "p0.00784314\n\n";
    for (size_t i = 0; i < truth.cameras.size(); i++) {
        const auto &c = truth.cameras[i];
        double degrees_per_px = c.hfov_deg / c.width, e[2] = {random.normal(), random.normal()};
        const char *link = i ? "=0" : "0", *va = i ? "=0" : "1";
        text += format("i w%u h%u f0 v%s", c.width, c.height, i ? "=0" : format("%.17g", c.hfov_deg).c_str());
        for (char letter : {'a', 'b', 'c', 'd', 'e'}) text += format(" R%c%s", letter, link);
        text +=
            format(" Eev0 Er1 Eb1 r%.17g p%.17g y%.17g TrX0 TrY0 TrZ0 Tpy0 Tpp0 j0", c.roll_deg,
                   c.pitch_deg + o.misalign * degrees_per_px * e[0], c.yaw_deg + o.misalign * degrees_per_px * e[1]);
        for (char letter : {'a', 'b', 'c', 'd', 'e', 'g', 't'}) text += format(" %c%s", letter, link);
        text += format(" Va%s Vb%s Vc%s Vd%s Vx%s Vy%s Vm5 n\"%s\"\n", va, link, link, link, link, link,
                       truth.files[i].c_str());
    }
    text += "\nv Ra0 Rb0 Rc0 Rd0 Re0\nv Vb0 Vc0 Vd0 Vx0 Vy0\n";
    for (size_t i = 1; i < truth.cameras.size(); i++) text += format("v Eev%zu Er%zu Eb%zu\n", i, i, i);
    return text + "v\n";
}

Json image_json(const Truth &truth, size_t i) {
    const auto &e = truth.exposures[i];
    Json image = {
        {"file", truth.files[i]}, {"ev", e.ev}, {"white_balance", {e.white_balance[0], 1.0, e.white_balance[2]}}};
    if (!truth.settings.empty()) {
        const auto &s = truth.settings[i];
        image["exif_ev"] = std::log2(s.time_s * s.iso / 100.0 / (s.f_number * s.f_number));
    }
    if (!truth.objects.empty()) {
        image["objects"] = Json::array();
        for (const auto &b : truth.objects[i]) image["objects"].push_back({b.left, b.top, b.right, b.bottom});
    }
    return image;
}

Json truth_json(const Truth &truth) {
    Json json, images = Json::array(), k = Json::array();
    for (size_t i = 0; i < truth.files.size(); i++) images.push_back(image_json(truth, i));
    for (uint32_t c = 0; c < truth.vignettings; c++)
        k.push_back({truth.vignetting[c].k[0], truth.vignetting[c].k[1], truth.vignetting[c].k[2]});
    json["schema"] = 1;
    json["images"] = images;
    json["vignetting"] = {{"k", k}, {"center", {truth.vignetting[0].center[0], truth.vignetting[0].center[1]}}};
    json["response"] = {
        {"values", {std::vector<double>(truth.response.table, truth.response.table + LENSPROF_RESPONSE_SAMPLES)}}};
    json["noise"] = truth.noise_levels;
    json["outliers"] = truth.outlier_share;
    json["objects"] = truth.object_share;
    json["local_tone"] = truth.local_tone;
    return json;
}

void write_pictures(const Options &o, const Truth &truth, const Scene &scene, Progress &progress) {
    for_each_parallel(static_cast<uint32_t>(truth.files.size()), "rendering", progress, [&](uint32_t i) {
        Picture picture = render(truth, scene, i);
        expose(truth, i, picture);
        if (!truth.tone.empty()) map_tones(truth, i, picture);
        digitise(truth, i, o.formats[i % o.formats.size()].sample, picture);
        PictureMetadata metadata = metadata_of(truth, i);
        WriteOptions write;
        write.metadata = &metadata;
        std::string path = (std::filesystem::path(o.output) / truth.files[i]).string();
        if (!write_picture(path, picture, write) && o.exif)
            throw Failure(ExitCode::failed, path + ": a TIFF of 4 GB cannot hold EXIF; use a smaller --size");
    });
}

int run(const Options &o, Streams &streams) {
    check_exif(o);
    Truth truth = make_truth(o);
    Scene scene(o.seed);
    add_disturbances(o, scene, truth);
    make_folder(o.output);
    std::filesystem::path folder(o.output);

    Progress progress(streams.err, ShowProgress::when_terminal);
    if (!o.no_images) write_pictures(o, truth, scene, progress);
    std::string project = project_text(o, truth), json = truth_json(truth).dump(1) + "\n";
    std::string pto = (folder / "pano.pto").string();
    write_file(pto, project.data(), project.size());
    write_file((folder / "truth.json").string(), json.data(), json.size());
    if (o.points || o.test_points) {
        Project read = read_project(pto, false);
        uint32_t levels = o.formats[0].sample == LENSPROF_SAMPLE_U8 ? 255 : 65535;
        auto write = [&](const char *name, uint32_t count, double darkest, bool noisy) {
            std::string text = points_text(simulate_pairs(truth, scene, count, darkest, noisy, levels), read);
            write_file((folder / name).string(), text.data(), text.size());
        };
        if (o.points) write("points.txt", o.points, 1.0 / 255.0, true);
        if (o.test_points) write("test_points.txt", o.test_points, 3.0 / 255.0, false);
    }
    progress.clear();
    streams.out << pto << "\n";
    return 0;
}

}  // namespace

void declare_simulate(Command &program) {
    Command command = program.add(
        "simulate", "render overlapping pictures with a known camera",
        "Renders overlapping pictures of a procedural scene, taken by a camera whose truth is written down.");
    auto o = std::make_shared<Options>();
    declare(command, *o);
    command.run([o](Streams &streams) { return run(*o, streams); });
}

}  // namespace lensprof
