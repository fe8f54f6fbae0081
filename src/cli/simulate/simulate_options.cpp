#include "cli/simulate/simulate_options.hpp"

#include "cli/program/error.hpp"
#include "cli/program/response_words.hpp"

namespace lensprof {
namespace {

const Choices<SimulateFormat> formats = {
    {"png", {".png", LENSPROF_SAMPLE_U8}},     {"png16", {".png", LENSPROF_SAMPLE_U16}},
    {"tiff", {".tif", LENSPROF_SAMPLE_U8}},    {"tiff16", {".tif", LENSPROF_SAMPLE_U16}},
    {"tiff32", {".tif", LENSPROF_SAMPLE_F32}}, {"jpeg", {".jpg", LENSPROF_SAMPLE_U8}},
};

const Choices<SceneKind> scenes = {
    {"landscape", SceneKind::landscape}, {"sky", SceneKind::sky},           {"wall", SceneKind::wall},
    {"foliage", SceneKind::foliage},     {"interior", SceneKind::interior},
};

const Choices<std::optional<MovingKind>> moving = {
    {"terrain", MovingKind::terrain},
    {"room", MovingKind::room},
};

void declare_camera(Command &command, SimulateOptions &o) {
    o.response = response_of_word("srgb");
    command.size("--size", o.width, o.height, {16, 32768}, "size of the pictures, px; default 800x600");
    command.number("--hfov", o.hfov, {1.0, 150.0}, "horizontal field of view, degrees; default 50");
    command.number("--overlap", o.overlap, {0.0, 0.99},
                   "overlap of neighbouring pictures, as a share of the picture; "
                   "default 0.4");
    command.number("--jitter", o.jitter, {0.0, 20.0}, "sigma of random yaw, pitch and roll, degrees; default 1");
    command.number("--misalign", o.misalign, {0.0, 1e3},
                   "sigma of the error of yaw and pitch in the project, px; "
                   "default 0");
    command.word(
        "--response", "RESPONSE", [&o](const std::string &word) { o.response = response_of_word(word); },
        "response: srgb (default), linear, gamma:G, film, or emor:a,b,... (EMoR coefficients)");
    command.numbers("--vignetting", o.vignetting, any_number,
                    "falloff k1,k2,k3, or nine numbers for red, green and "
                    "blue; default -0.3,0.05,-0.15");
    command.numbers("--center", o.center, any_number, "centre x,y of the falloff, half diagonals; default 0.02,-0.015");
    command.number(
        "--ev", o.ev, {0.0, 8.0},
        "range of exposures, EV: uniform within +- this, default 1; with --moving automatic within +- this, default "
        "0.75");
    command.number("--mean-ev", o.mean_ev, {-8.0, 8.0},
                   "centre of the exposures, EV, default 0; at 0 the brightest clouds are white, and with --moving "
                   "the mean irradiance is 0.2 of white");
    command.number("--clip", o.clip, {0.0, 0.9},
                   "shift all exposures equally so that this share of the pixels is white in a channel; default 0 = "
                   "no shift");
    command.number("--wb", o.wb, {0.0, 0.9},
                   "range of white balance factors: uniform within 1 +- this, default 0.15; with --moving the size of "
                   "their drift, default 0.06");
}

void declare_disturbances(Command &command, SimulateOptions &o) {
    command.number("--noise", o.noise, {0.0, 100.0}, "sigma of the noise, levels of 255; default 2");
    command.number("--outliers", o.outliers, {0.0, 1.0},
                   "share of pixels (and of --points pairs) replaced by random values; default 0");
    command.number("--objects", o.objects, {0.0, 0.9},
                   "share of each picture covered by moving objects, also in pairs; default 0");
    command.number("--local-tone", o.local_tone, {0.0, 4.0},
                   "maximum gain of local tone mapping after the response, EV; default 0");
    command.number("--sharpen", o.sharpen, {0.0, 10.0},
                   "gain of an unsharp mask of 1.5 px after the response; "
                   "default 0");
    command.number("--parallax", o.parallax, {0.0, 1e3},
                   "parallax of a moving camera: maximum shift of near objects between two pictures, px; default 0");
    command.flag("--exif", o.exif, "write exposure time and ISO to EXIF, consistent with the true exposures");
    command.number("--exif-rounding", o.exif_rounding, {0.0, 4.0},
                   "sigma of the error of the EXIF exposures, EV; "
                   "default 0");
    command.flag("--exif-manual", o.exif_manual, "mark the exposures in EXIF as set manually, at one ISO");
    command.number("--exif-scatter", o.exif_scatter, {0.0, 4.0},
                   "sigma of the true exposure about the one set and written to EXIF, EV; default 0");
}

// Options for a camera that turns about a point.
void check_moving_options(const SimulateOptions &o) {
    const SimulateOptions usual{};
    const std::pair<const char *, bool> changed[] = {
        {"--rows", o.rows != usual.rows},
        {"--overlap", o.overlap != usual.overlap},
        {"--misalign", o.misalign != usual.misalign},
        {"--scene", o.scene != usual.scene},
        {"--parallax", o.parallax != usual.parallax},
        {"--points", o.points != usual.points},
        {"--test-points", o.test_points != usual.test_points},
    };
    for (const auto &option : changed)
        if (option.second)
            throw Failure(ExitCode::usage, option.first
                                               + std::string(": is for a camera that turns about one point; omit it, "
                                                             "or omit --moving"));
    if (o.hfov < 20.0 || o.hfov > 100.0)
        throw Failure(ExitCode::usage, "--hfov: must be 20 to 100 degrees with --moving; give a value in this range");
}

}  // namespace

void declare_simulate_options(Command &command, SimulateOptions &o) {
    command.folder("-o,--output", o.output, "output folder for pictures, pano.pto (not with --moving) and truth.json");
    command.require("--output");
    command.count("--images", o.images, 2, 5000, "number of pictures; default 6");
    command.count("--rows", o.rows, 1, 100, "number of rows of pictures; default 1");
    command.choice("--scene", o.scene, scenes,
                   "content of the pictures: landscape (default), sky, wall, foliage or "
                   "interior");
    command.choice("--moving", o.moving, moving,
                   "move the camera through a 3D scene: terrain (in rows over hills) or room (around a room); "
                   "default: it turns about one point");
    command.number("--gloss", o.gloss, {0.0, 4.0},
                   "strength of highlights on glossy surfaces, with --moving; default 1; 0 = all matte");
    declare_camera(command, o);
    declare_disturbances(command, o);
    command.list("--format", o.formats, formats,
                 "format of the pictures; several, separated by commas, are used in "
                 "turn; default png");
    command.count("--seed", o.seed, 0, UINT32_MAX, "seed of scene and camera; default 1");
    command.count("--points", o.points, 0, 1000000, "also write points.txt with this many noisy pairs; default 0");
    command.count("--test-points", o.test_points, 0, 1000000,
                  "also write test_points.txt with this many noise-free pairs, for evaluation; default 0");
    command.flag("--no-images", o.no_images, "do not write pictures");
    declare_progress(command, o.progress);
}

void check_simulate_options(const SimulateOptions &o) {
    if (o.moving) check_moving_options(o);
    if (o.gloss && !o.moving) throw Failure(ExitCode::usage, "--gloss: needs --moving; add it, or omit --gloss");
    if (o.exif && o.no_images) throw Failure(ExitCode::usage, "--exif: needs pictures to write to; omit --no-images");
    if (o.exif_rounding > 0.0 && !o.exif)
        throw Failure(ExitCode::usage,
                      "--exif-rounding: needs --exif; add it, or "
                      "omit --exif-rounding");
    if (o.exif_scatter > 0.0 && !o.exif)
        throw Failure(ExitCode::usage,
                      "--exif-scatter: needs --exif; add it, or "
                      "omit --exif-scatter");
    if (o.exif_manual && !o.exif)
        throw Failure(ExitCode::usage,
                      "--exif-manual: needs --exif; add it, or omit "
                      "--exif-manual");
}

}  // namespace lensprof
