#include "cli/simulate/simulate_options.hpp"

#include "cli/program/response_words.hpp"
#include "photo/base/failure.hpp"

namespace lensprof {
namespace {

const Choices<SimulateFormat> formats = {
    {"png", {".png", LENSPROF_SAMPLE_U8}},     {"png16", {".png", LENSPROF_SAMPLE_U16}},
    {"tiff", {".tif", LENSPROF_SAMPLE_U8}},    {"tiff16", {".tif", LENSPROF_SAMPLE_U16}},
    {"tiff32", {".tif", LENSPROF_SAMPLE_F32}}, {"jpeg", {".jpg", LENSPROF_SAMPLE_U8}},
};

const Choices<SimulatedKind> scenes = {
    {"landscape", SimulatedKind::landscape}, {"sky", SimulatedKind::sky},           {"wall", SimulatedKind::wall},
    {"foliage", SimulatedKind::foliage},     {"interior", SimulatedKind::interior},
};

const Choices<std::optional<MovingKind>> moving = {
    {"terrain", MovingKind::terrain},
    {"room", MovingKind::room},
};

void declare_camera(Keys &keys, SimulateOptions &o) {
    keys.number("hfov", o.hfov, {1.0, 150.0}, "horizontal field of view, degrees; default 50");
    keys.count("rows", o.rows, 1, 100, "number of rows of pictures; default 1");
    keys.number("overlap", o.overlap, {0.0, 0.99},
                "overlap of neighbouring pictures, as a share of the picture; default 0.4");
    keys.number("jitter", o.jitter, {0.0, 20.0}, "sigma of random yaw, pitch and roll, degrees; default 1");
    keys.number("misalign", o.misalign, {0.0, 1e3},
                "sigma of the error of yaw and pitch in the project, px; default 0");
    keys.numbers("center", o.center, any_number, "centre x,y of the falloff, half diagonals; default 0.02,-0.015");
    keys.number("ev", o.ev, {0.0, 8.0},
                "range of exposures, EV: uniform within +- this, default 1; with moving automatic within +- this, "
                "default 0.75");
    keys.number("mean-ev", o.mean_ev, {-8.0, 8.0},
                "centre of the exposures, EV, default 0; at 0 the brightest clouds are white, and with moving the mean "
                "irradiance is 0.2 of white");
    keys.number("clip", o.clip, {0.0, 0.9},
                "shift all exposures equally so that this share of the pixels is white in a channel; default 0 = no "
                "shift");
    keys.number("wb", o.wb, {0.0, 0.9},
                "range of white balance factors: uniform within 1 +- this, default 0.15; with moving the size of their "
                "drift, default 0.06");
    keys.choice("moving", o.moving, moving,
                "move the camera through a 3D scene: terrain (in rows over hills) or room (around a room); default: "
                "it turns about one point");
    keys.number("gloss", o.gloss, {0.0, 4.0},
                "strength of highlights on glossy surfaces, with moving; default 1; 0 = all matte");
}

void declare_disturbances(Keys &keys, SimulateOptions &o) {
    keys.number("noise", o.noise, {0.0, 100.0}, "sigma of the noise, levels of 255; default 2");
    keys.number("outliers", o.outliers, {0.0, 1.0},
                "share of pixels (and of pairs in points.txt) replaced by random values; default 0");
    keys.number("objects", o.objects, {0.0, 0.9},
                "share of each picture covered by moving objects, also in pairs; default 0");
    keys.number("local-tone", o.local_tone, {0.0, 4.0},
                "maximum gain of local tone mapping after the response, EV; default 0");
    keys.number("sharpen", o.sharpen, {0.0, 10.0}, "gain of an unsharp mask of 1.5 px after the response; default 0");
    keys.number("parallax", o.parallax, {0.0, 1e3},
                "parallax of a moving camera: maximum shift of near objects between two pictures, px; default 0");
    keys.number("exif-rounding", o.exif_rounding, {0.0, 4.0},
                "sigma of the error of the EXIF exposures, EV; default 0");
    keys.flag("exif-manual", o.exif_manual, "mark the exposures in EXIF as set manually, at one ISO");
    keys.number("exif-scatter", o.exif_scatter, {0.0, 4.0},
                "sigma of the true exposure about the one set and written to EXIF, EV; default 0");
}

// Options for a camera that turns about a point.
void check_moving_options(const SimulateOptions &o) {
    const SimulateOptions usual{};
    const std::pair<const char *, bool> changed[] = {
        {"--set rows", o.rows != usual.rows},
        {"--set overlap", o.overlap != usual.overlap},
        {"--set misalign", o.misalign != usual.misalign},
        {"--scene", o.scene != usual.scene},
        {"--set parallax", o.parallax != usual.parallax},
        {"--set points", o.points != usual.points},
        {"--set test-points", o.test_points != usual.test_points},
    };
    for (const auto &option : changed)
        if (option.second)
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          option.first
                              + std::string(": is for a camera that turns about one point; omit it, "
                                            "or omit --set moving"));
    if (o.hfov < 20.0 || o.hfov > 100.0)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--set hfov: must be 20 to 100 degrees with moving; give a value in this range");
}

}  // namespace

void declare_simulate_options(Command &command, SimulateOptions &o) {
    o.response = response_of_word("srgb");
    command.folder("-o,--output", o.output,
                   "output folder for pictures, pano.pto (not with --set moving) and truth.json");
    command.require("--output");
    command.count("--images", o.images, 2, 5000, "number of pictures; default 6");
    command.size("--size", o.width, o.height, {16, 32768}, "size of the pictures, px; default 800x600");
    command.choice("--scene", o.scene, scenes,
                   "content of the pictures: landscape (default), sky, wall, foliage or interior");
    command.word(
        "--response", "RESPONSE", [&o](const std::string &word) { o.response = response_of_word(word); },
        "response: srgb (default), linear, gamma:G, film, emor:a,b,... (EMoR coefficients) or a file (pcalib.txt)");
    command.numbers("--vignetting", o.vignetting, any_number,
                    "falloff k1,k2,k3, or nine numbers for red, green and blue; default -0.3,0.05,-0.15");
    command.flag("--exif", o.exif, "write exposure time and ISO to EXIF, consistent with the true exposures");
    command.list("--format", o.formats, formats,
                 "format of the pictures; several, separated by commas, are used in turn; default png");
    command.count("--seed", o.seed, 0, UINT32_MAX, "seed of scene and camera; default 1");
    Keys keys = command.expert().keys("--set", "further properties of camera and scene");
    declare_camera(keys, o);
    declare_disturbances(keys, o);
    keys.count("points", o.points, 0, 1000000, "also write points.txt with this many noisy pairs; default 0");
    keys.count("test-points", o.test_points, 0, 1000000,
               "also write test_points.txt with this many noise-free pairs, for evaluation; default 0");
    keys.flag("no-images", o.no_images, "do not write pictures");
    declare_progress(command, o.progress);
}

void check_simulate_options(const SimulateOptions &o) {
    if (o.moving) check_moving_options(o);
    if (o.gloss && !o.moving)
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--set gloss: needs moving; add it, or omit gloss");
    if (o.exif && o.no_images)
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--exif: needs pictures to write to; omit --set no-images");
    for (const auto &[key, is_given] :
         {std::pair("exif-rounding", o.exif_rounding > 0.0), std::pair("exif-scatter", o.exif_scatter > 0.0),
          std::pair("exif-manual", o.exif_manual)})
        if (is_given && !o.exif)
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          std::string("--set ") + key + ": needs --exif; add it, or omit " + key);
}

}  // namespace lensprof
