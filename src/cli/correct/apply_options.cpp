#include "cli/correct/apply_options.hpp"

#include "cli/correct/model_options.hpp"
#include "cli/program/level_words.hpp"
#include "photo/base/failure.hpp"

namespace lensprof {

// How pictures are corrected, and how they are written.
static void declare_keys(Command &command, ApplyOptions &o) {
    Keys keys = command.keys("--set", "how the pictures are corrected");
    keys.choice(
        "exposure", o.exposure,
        {{"mean", OutputExposure::mean}, {"reference", OutputExposure::reference}, {"keep", OutputExposure::keep}},
        "exposure of the outputs: mean (geometric mean of the project; default with --pto and --model), reference (0 "
        "EV of the project) or keep (unchanged; default without a project)");
    keys.number("strength", o.kind.strength, {0.0, 1.0}, "share of the falloff to correct, 0 to 1; default 1");
    keys.number("gain-cap", o.kind.gain_cap, {1.0, 1e6},
                "maximum gain of the falloff correction, 1 or more, to limit noise in the corners; default unlimited");
    keys.word(
        "black", "LEVEL", [&o](const std::string &word) { o.kind.levels.black = black_levels_of(word); },
        "sample without light, which is subtracted before and put back after, instead of the profile's: a value such "
        "as 256, a percentage such as 6%, or RED:GREEN:BLUE");
    keys.word(
        "white", "LEVEL", [&o](const std::string &word) { o.kind.levels.white = white_level_of(word); },
        "sample at saturation, at which outputs are clipped; a value such as 4095, or a percentage");
    declare_model_keys(keys, o.model);
    keys.flag("simulate", o.kind.simulate, "add the falloff instead of correcting it");
    Keys encoding = command.keys("--encoding", "how the outputs are written");
    encoding.choice("linear", o.linear_end, {{"tif", ".tif"}, {"exr", ".exr"}},
                    "file format of --linear: tif (default) or exr (OpenEXR without metadata)");
    encoding.choice("raw", o.raw_output, {{"dng", RawOutput::dng}, {"tif", RawOutput::tif}},
                    "output for camera raw files: dng (default for DNG: a copy with the falloff as an opcode, pixels "
                    "unchanged) or tif (default for others: a linear 16 bit TIFF in camera colours)");
    encoding.flag("dither", o.kind.dither,
                  "use ordered 8 x 8 dither instead of rounding in 8 bit pictures, to avoid banding");
    encoding.flag("exif-exposure", o.seed_exif,
                  "write the estimated exposure of each output into its EXIF (ExposureTime) and mark this in its XMP; "
                  "needs --model; recommended with --set exposure=keep");
}

static void declare_experts(Command command, ApplyOptions &o) {
    command.file("--model", o.exposures,
                 "use exposures, response and falloff of this exposures.json of `build --write exposures=FILE`");
    command.folder("--images", o.images,
                   "folder of the pictures, with --model, if they were moved; default as stored in the file");
    command.flag("--chroma", o.kind.chroma,
                 "correct only the colour of the falloff: neutral grey becomes neutral and keeps its luminance");
    command.flag("--linear", o.kind.linear, "write irradiance instead of grey values, as 32 bit float");
    command.flag(
        "--merge", o.merge,
        "merge into each picture the irradiance of all overlapping pictures of the project, also where it is clipped "
        "itself (HDR); needs --linear and --pto");
    command.word(
        "--shard", "INDEX/COUNT", [&o](const std::string &word) { o.shard = word; },
        "correct only a part of the pictures, to distribute the work: 2/5 is the second of five parts; "
        "outputs do not depend on it; default all");
    command.flag(
        "--skip", o.skip,
        "skip named pictures that have no profile or are already corrected, and list them at the end, as for folders; "
        "default: nothing is written if a named picture cannot be corrected");
    command.file("--contact-sheet", o.sheet,
                 "write an overview of the pictures before and, below, after correction, as .png, .tif or .jpg");
    declare_keys(command, o);
}

void declare_options(Command &command, ApplyOptions &o) {
    command.folder("-o,--output", o.output, "output folder, with the subfolders of the input; default corrected");
    command.file("--pto", o.pto, "use the exposures (and, without --profile, response and falloff) of this project");
    declare_model(command, o.model);
    declare_writing(command, o.kind);
    declare_experts(command.expert(), o);
    declare_json(command, o.json);
    declare_progress(command, o.progress);
    command.files("FILE", o.files,
                  "pictures and folders of pictures (with subfolders); with --pto or --model default all of the "
                  "project");
    command.footer(
        "Outputs keep format, depth, metadata and colour profile of the picture; a mark in their XMP states\n"
        "the correction by lensprof. Several pictures are corrected in parallel, in strips of rows; only\n"
        "interlaced PNG and progressive JPEG are held in memory completely. Of several pictures, those that\n"
        "cannot be read are listed with their reasons, and the others are corrected; the exit code is 3.\n"
        "Nothing is written if a named file does not exist.\n"
        "Exit code 5: pictures were refused, because they have no profile. If one of them, or an already\n"
        "corrected one, was named, nothing is written; those of folders, and with --skip all of them, are\n"
        "left out. An existing output is replaced if it was made from the same picture; a file not written\n"
        "by lensprof is replaced only in a folder given with -o.");
}

void check_merge(const ApplyOptions &o) {
    if (o.pto.empty() || !o.kind.linear)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--merge: needs overlapping pictures and --linear; give their project with --pto, and --linear");
    if (o.model.profile || o.model.from_db || o.model.response)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--merge: uses response and falloff of the project; omit --profile and --set response");
    if (o.kind.simulate || o.kind.chroma || o.kind.strength != 1.0 || o.kind.gain_cap != 0.0 || o.kind.dither
        || !o.sheet.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--merge: corrects the falloff completely and writes irradiance; omit --chroma, --set simulate, "
                      "strength and gain-cap, --encoding dither and --contact-sheet");
}

void check_project_options(const ApplyOptions &o) {
    if (!o.pto.empty() && !o.exposures.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--pto and --model exclude each other: both give exposures; give one of them");
    if (o.seed_exif && o.linear_end == ".exr")
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--encoding exif-exposure: OpenEXR has no EXIF; use linear=tif, or omit one of them");
    if (o.exposures.empty() && (!o.images.empty() || o.seed_exif))
        throw Failure(LENSPROF_ERROR_ARGUMENT, std::string(o.seed_exif ? "--encoding exif-exposure" : "--images")
                                                   + ": needs --model; give it, or omit the option");
}

}  // namespace lensprof
