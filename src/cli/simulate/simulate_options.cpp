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
    command.number(
        "--ev", o.ev, {0.0, 8.0},
        "exposures are uniform within +- this, EV, default 1; --moving: automatic within this, default 0.75");
    command.number("--mean-ev", o.mean_ev, {-8.0, 8.0},
                   "about this; at 0 the brightest clouds are white, and the mean light of --moving is 0.2 of white");
    command.number("--clip", o.clip, {0.0, 0.9},
                   "move all exposures alike, so that this share of the pixels is white in a channel; 0 = leave them");
    command.number("--wb", o.wb, {0.0, 0.9},
                   "white balance factors are uniform within 1 +- this, default 0.15; --moving: drift, default 0.06");
}

void declare_disturbances(Command &command, SimulateOptions &o) {
    command.number("--noise", o.noise, {0.0, 100.0}, "sigma, levels of 255");
    command.number("--outliers", o.outliers, {0.0, 1.0},
                   "share of pixels (and of --points pairs) replaced by random numbers");
    command.number("--objects", o.objects, {0.0, 0.9},
                   "share of every picture that moving objects cover; pairs with an end on one see it");
    command.number("--local-tone", o.local_tone, {0.0, 4.0},
                   "local tone mapping after the response, strongest gain, EV");
    command.number("--sharpen", o.sharpen, {0.0, 10.0}, "gain of an unsharp mask of 1.5 px after the response");
    command.number("--parallax", o.parallax, {0.0, 1e3},
                   "the camera moves: what is near shifts by up to this between two pictures, px");
    command.flag("--exif", o.exif, "pictures tell exposure time and ISO too, true to the exposures");
    command.number("--exif-rounding", o.exif_rounding, {0.0, 4.0}, "sigma of the error of what they tell, EV");
    command.flag("--exif-manual", o.exif_manual, "they tell that the exposure was set by hand, at one ISO");
    command.number("--exif-scatter", o.exif_scatter, {0.0, 4.0},
                   "sigma of the shutter and aperture about what was set and is told, EV");
}

// What is about a camera that turns.
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
                                               + std::string(": is for a camera that turns in one place; leave it out, "
                                                             "or leave out --moving"));
    if (o.hfov < 20.0 || o.hfov > 100.0)
        throw Failure(ExitCode::usage, "--hfov: --moving takes 20 to 100 degrees; give a number in between");
}

}  // namespace

void declare_simulate_options(Command &command, SimulateOptions &o) {
    command.folder("-o,--output", o.output, "folder for pictures, pano.pto (not with --moving) and truth.json");
    command.require("--output");
    command.count("--images", o.images, 2, 5000, "number of pictures");
    command.count("--rows", o.rows, 1, 100, "rows of pictures");
    command.choice("--scene", o.scene, scenes, "what the pictures show");
    command.choice("--moving", o.moving, moving,
                   "the camera moves through a scene in space: over hills in rows, or round a room");
    command.number("--gloss", o.gloss, {0.0, 4.0},
                   "strength of the highlights of glossy surfaces, with --moving; 0 = all are matte, default 1");
    declare_camera(command, o);
    declare_disturbances(command, o);
    command.list("--format", o.formats, formats, "of the pictures; several, with commas, take turns");
    command.count("--seed", o.seed, 0, UINT32_MAX, "another seed, another scene and camera");
    command.count("--points", o.points, 0, 1000000, "also write points.txt with this many noisy pairs");
    command.count("--test-points", o.test_points, 0, 1000000,
                  "also write test_points.txt with noise-free pairs, for scoring");
    command.flag("--no-images", o.no_images, "write no pictures");
}

void check_simulate_options(const SimulateOptions &o) {
    if (o.moving) check_moving_options(o);
    if (o.gloss && !o.moving) throw Failure(ExitCode::usage, "--gloss: needs --moving");
    if (o.exif && o.no_images)
        throw Failure(ExitCode::usage, "--exif: there is no picture to write it into; leave out --no-images");
    if (o.exif_rounding > 0.0 && !o.exif) throw Failure(ExitCode::usage, "--exif-rounding: needs --exif");
    if (o.exif_scatter > 0.0 && !o.exif) throw Failure(ExitCode::usage, "--exif-scatter: needs --exif");
    if (o.exif_manual && !o.exif) throw Failure(ExitCode::usage, "--exif-manual: needs --exif");
}

}  // namespace lensprof
