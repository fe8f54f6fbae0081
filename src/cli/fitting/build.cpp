// `lensprof build`: fits response, falloff and exposures to the pictures of a project and stores a profile.
#include <algorithm>
#include <filesystem>
#include <functional>
#include <numeric>
#include <optional>

#include <nlohmann/json.hpp>

#include "cli/fitting/build.hpp"
#include "cli/fitting/fit_page.hpp"
#include "cli/fitting/fitting.hpp"
#include "cli/fitting/store_options.hpp"
#include "cli/page/page.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/level_words.hpp"
#include "cli/program/message.hpp"
#include "cli/program/options.hpp"
#include "cli/program/progress.hpp"
#include "cli/program/shard.hpp"
#include "cli/report/drawing.hpp"
#include "cli/report/gain_chart.hpp"
#include "photo/base/file_kind.hpp"
#include "photo/base/format.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/calibration/calibration.hpp"
#include "photo/calibration/exposure_file.hpp"
#include "photo/calibration/preview.hpp"
#include "photo/calibration/scene_fit.hpp"
#include "photo/pictures/other_parts.hpp"
#include "photo/pictures/picture_levels.hpp"
#include "photo/reconstruction/reconstruction_file.hpp"
#include "photo/scene/exposure_reader.hpp"
#include "photo/scene/hugin_project.hpp"
#include "photo/scene/photographs.hpp"
#include "photo/scene/point_file.hpp"
#include "photo/scene/reconstruction_scene.hpp"

namespace lensprof {
namespace {

struct BuildOptions : SceneFitOptions {
    std::vector<std::string> inputs;
    std::string images, image_list, shard, points_out, exposures_out, gain_chart, pto_out, project_out, preview, report,
        compare;
    bool track_colours = false;
    std::vector<uint32_t> free_words;  // LENSPROF_FREE_... of --fit free
    bool json = false, progress = false;
};

constexpr uint32_t balance_flags = LENSPROF_FREE_RED | LENSPROF_FREE_BLUE;
constexpr uint32_t all_flags = LENSPROF_FREE_LENS | LENSPROF_FREE_EV | balance_flags;

void declare_input(Command &command, BuildOptions &o) {
    command.files(
        "FILE", o.inputs,
        "overlapping pictures and folders of them; or one Hugin project, whose v lines choose what is estimated; or "
        "one reconstruction (COLMAP database.db or model folder, tracks.csv of OpenSfM and OpenDroneMap, Bundler "
        ".out, AliceVision .sfm, OpenMVG sfm_data.json, or a folder with one of them)");
    command.require("FILE");
    command.folder("--images", o.images, "folder of the reconstruction's pictures; default next to the reconstruction");
    command.expert().file("--points", o.points,
                          "use the pairs of this point file instead of the pictures and their EXIF exposures");
    Keys keys = command.expert().keys("--reconstruction", "what is used of a reconstruction");
    keys.file("list", o.image_list, "use only the images that this file lists, one name per line; default all");
    keys.word(
        "shard", "INDEX/COUNT", [&o](const std::string &word) { o.shard = word; },
        "use only a part of the images, to distribute the work: 2/5 is the second of five parts; give each part its "
        "own --db and join them with `profile merge`; default all");
    keys.flag("track-colors", o.track_colours,
              "use the colours in tracks.csv instead of reading the pictures, also done if there are no pictures");
}

void declare_outputs(Command &command, BuildOptions &o) {
    command.file("--report", o.report,
                 "write a report with charts and the pictures before and after, as one .html file");
    Keys keys = command.keys("--write", "further files to write", "KEY=FILE,...");
    keys.file("preview", o.preview,
              "a mosaic of the pictures before and, below, after correction, as .jpg, .png or .tif");
    keys.file("pto", o.pto_out, "the project with the result, for Hugin, nona and `apply --pto`");
    keys.file("exposures", o.exposures_out,
              "exposures and white balances with standard errors, response and falloff as JSON, for `apply --model` "
              "and other programs");
    keys.file("project", o.project_out,
              "the project found for the pictures, before the fit, for inspection and correction in Hugin");
    keys.file("points", o.points_out, "the pairs used (Hugin's 16 columns), even if the fit is not usable");
    keys.file("gain-chart", o.gain_chart,
              "a chart of the improvement by the correction, as .svg or .png; needs a reconstruction");
}

void declare_build_fit(Command &command, BuildOptions &o) {
    FitChoices choices;
    choices.stored_prior = true;
    Keys keys = declare_fit(command, o.fit, choices);
    keys.choice("falloff-curves", o.falloff_curves, {{"auto", 0}, {"1", 1}, {"3", 3}},
                "number of falloff curves: 1, 3 (one per channel) or auto (default: chosen by held-out error)");
    keys.list("free", o.free_words,
              {{"response", LENSPROF_FREE_RESPONSE},
               {"falloff", LENSPROF_FREE_FALLOFF},
               {"center", LENSPROF_FREE_CENTER},
               {"ev", LENSPROF_FREE_EV},
               {"wb", balance_flags},
               {"all", all_flags}},
              "parameters to estimate for every image; default according to the v lines, or all if there are no "
              "photometric v lines");
    keys.text("reference", o.reference,
              "image (number or name) whose exposure is 0 EV; default the first whose exposure is fixed, else the "
              "first");
    keys.choice("sampling", o.sampling, {{"balanced", LENSPROF_SAMPLING_BALANCED}, {"paper", LENSPROF_SAMPLING_PAPER}},
                "selection of the pairs: balanced (default) or paper (d'Angelo 5.1)");
    o.levels.black_option = "black_level", o.levels.white_option = "white_level";
    keys.word(
        "black-level", "LEVEL", [&o](const std::string &word) { o.levels.black = black_levels_of(word); },
        "sample without light of linear pictures, which is subtracted and stored: a value such as 256, a percentage "
        "such as 6%, or RED:GREEN:BLUE; default 0");
    keys.word(
        "white-level", "LEVEL", [&o](const std::string &word) { o.levels.white = white_level_of(word); },
        "sample at saturation of linear pictures, as a value such as 4095 or a percentage; default full scale");
    declare_sampling(keys, o.pixels, "300 per image, at least 2000 (radiance: number of points, 150 per image)");
    keys.file("truth", o.compare, "compare the estimates with the true values in truth.json of `simulate`");
}

void declare(Command &command, BuildOptions &o) {
    declare_input(command, o);
    declare_outputs(command, o);
    declare_store(command, o.store);
    command.flag(
        "--one-lens", o.one_lens,
        "estimate one response and one falloff for all pictures, regardless of the stated camera, lens, focal length, "
        "aperture and focus");
    declare_build_fit(command, o);
    declare_json(command, o.json);
    declare_progress(command, o.progress);
}

// A picture name for a text output is a mistake that could overwrite a photograph; so is a preview with the name of
// one.
void reject_photograph(const std::string &output, bool is_preview) {
    if (!is_preview && is_picture_name(output))
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      output + ": is the name of a picture, but the output is text; give another name");
    if (!is_preview || !is_regular_file(output)) return;
    PictureMetadata metadata = unknown_metadata();
    try {
        metadata = read_metadata(output);
    } catch (const Failure &) {
        return;  // not a readable picture
    }
    if (*metadata.key.camera_model || metadata.exposure_time_s)
        throw Failure(LENSPROF_ERROR_ARGUMENT, output + ": is an existing photograph; give the preview another name");
}

// Files of exposures are next to reconstructions; nothing else must be overwritten by mistake.
void reject_other_file(const std::string &output) {
    if (!is_regular_file(output) || file_bytes(output) == 0 || is_exposure_file(output)) return;
    throw Failure(LENSPROF_ERROR_ARGUMENT, output + ": exists and is not a file of exposures; give another name");
}

// No output may overwrite an input, the database or another output.
void check_outputs(const BuildOptions &o, std::vector<std::string> reserved) {
    reserved.insert(reserved.end(), {o.points, o.image_list, o.compare});
    if (!o.store.no_store) reserved.push_back(store_path(o.store.db));
    for (const std::string &output :
         {o.points_out, o.exposures_out, o.gain_chart, o.pto_out, o.project_out, o.preview, o.report}) {
        if (output.empty()) continue;
        check_not_reserved(output, "output", reserved);
        reject_photograph(output, output == o.preview || output == o.gain_chart);
        if (output == o.exposures_out) reject_other_file(output);
        check_output_file(output);
        reserved.push_back(output);
    }
}

// `apply` takes what these files do not hold as options.
void note_levels(const BuildOptions &o, const lensprof_levels &levels, Events &events) {
    if (!has_levels(levels)) return;
    const double *black = levels.black;
    std::string words = format("%.6g%%", 100.0 * black[0]);
    if (black[1] != black[0] || black[2] != black[0])
        words += format(":%.6g%%:%.6g%%", 100.0 * black[1], 100.0 * black[2]);
    if (levels.white > 0.0) words += format(",white=%.6g%%", 100.0 * levels.white);
    for (const std::string &file : {o.pto_out, o.exposures_out})
        if (!file.empty())
            events.note(
                file, "does not hold the black and white level; to use it, give `lensprof apply` --set black=" + words);
}

// Everything that is written of a calibration. The page of the report lacks its verdict.
void add_outputs(const BuildOptions &o, Calibration &calibration, OutputFiles &outputs, Json &page, Streams &streams,
                 Events &events) {
    SceneFit &fit = calibration.fit;
    Scene &scene = calibration.scene;
    const bool is_written = fit.best.corrects() || o.store.force;
    if (!o.points_out.empty()) outputs.add(o.points_out, points_text(fit.input.pairs, scene));
    if (!o.exposures_out.empty() && is_written)
        outputs.add(o.exposures_out, exposures_text(fit, scene, calibration.metadata, o.exposures_out));
    if (!o.gain_chart.empty() && !fit.input.points.empty() && is_written)
        outputs.add(o.gain_chart, gain_chart(o.gain_chart, scene.path, gain_curves(fit)));
    if (!o.pto_out.empty() && is_written) outputs.add(o.pto_out, result_text(fit, scene, o.pto_out));
    if (is_written) note_levels(o, scene.levels, events);
    if (!o.preview.empty() && fit.best.corrects()) write_preview(o.preview, scene, fit.best, events);
    if (!o.report.empty())
        page = fit_page_data({fit.report, fit.input, fit.best, fit.input.images, scene, calibration.metadata,
                              command_text(streams.words)},
                             events);
    events.clear();
    if (o.fit.gamma_from == LENSPROF_GAMMA_EXPOSURES && fit.report.fit.gamma_from == LENSPROF_GAMMA_PRIOR)
        warn(streams, scene.path
                          + (o.points.empty() ? ": the EXIF exposures do not differ" : ": --points does not read EXIF")
                          + "; gamma depends on the prior");
}

// Checks that need no overlaps, which take time to find.
void check_photographs(const BuildOptions &o, const Photographs &list) {
    std::vector<std::string> inputs = list.files;
    for (const auto &[file, reason] : list.left_out) inputs.push_back(file);
    check_outputs(o, inputs);
    check_store(o.store);
    if (o.store.no_store) return;
    // One picture with camera or lens suffices as the reference; without any, the first one fails.
    std::optional<Failure> missing_name;
    for (const std::string &file : list.files) {
        try {
            const PictureMetadata metadata = read_metadata(file);
            override_key(metadata.key, metadata.size, o.store, file);
            return;
        } catch (const Failure &failure) {
            if (!missing_name && failure.group() == LENSPROF_ERROR_ARGUMENT)
                missing_name = failure;  // others are left out and reported
                                         // later
        }
    }
    if (missing_name) throw *missing_name;
}

// Refuses options that need a project with cameras.
Scene open_reconstruction(const BuildOptions &o, Events &events) {
    for (const auto &[option, value] : {std::pair("--points", o.points), std::pair("--write preview", o.preview),
                                        std::pair("--write project", o.project_out)})
        if (!value.empty())
            throw Failure(LENSPROF_ERROR_ARGUMENT, std::string(option) + ": is for panoramas, but " + o.inputs[0]
                                                       + " is a reconstruction; omit the option");
    return scene_of_reconstruction(
        o.inputs[0], {o.images, o.track_colours, o.image_list, shard_of(o.shard), o.pixels.pairs, o.pixels.seed},
        events);
}

// The project, or the pictures instead.
Scene open_project(const BuildOptions &o, Events &progress) {
    if (o.inputs.size() == 1 && is_reconstruction(o.inputs[0])) return open_reconstruction(o, progress);
    for (const auto &[option, is_given] :
         {std::pair("--images", !o.images.empty()), std::pair("--reconstruction list", !o.image_list.empty()),
          std::pair("--reconstruction shard", !o.shard.empty()),
          std::pair("--reconstruction track-colors", o.track_colours),
          std::pair("--write gain-chart", !o.gain_chart.empty())})
        if (is_given)
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          std::string(option) + ": is for reconstructions, but " + o.inputs[0]
                              + " is not one; omit the option, or give only database.db, tracks.csv or a similar file");
    for (const std::string &input : o.inputs) refuse_other_kind(input);
    const bool is_project = o.inputs.size() == 1 && !is_picture_argument(o.inputs[0]);
    for (const std::string &input : o.inputs)
        if (!is_project && !is_picture_argument(input))
            throw Failure(LENSPROF_ERROR_ARGUMENT, input + ": is neither a picture (.jpg, .png, .tif) nor a folder; give a "
                                                   "single project, or pictures and folders");
    if (is_project && !o.project_out.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--write project: needs pictures, but " + o.inputs[0]
                                                   + " is a project; omit the option, or use --write pto=FILE");
    if (is_project) {
        reject_reconstruction_part(o.inputs[0]);
        Scene scene = read_hugin_project(o.inputs[0]);
        for (const auto &[option, value] : {std::pair("--write preview", o.preview), std::pair("--report", o.report)})
            if (!value.empty()) refuse_crops(scene, option);
        if (o.points.empty()) note_several(scene.files, progress);
        return scene;
    }
    if (!o.points.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--points: needs the project that its pairs belong to; give the project instead of pictures");
    const Photographs list = find_photographs(o.inputs, progress);
    check_photographs(o, list);
    return scene_of_pictures(list, o.one_lens, progress);
}

// Runs the command after option parsing; `names` receives the images as soon as they are known.
int build_and_store(const BuildOptions &o, std::vector<std::string> &names, Streams &streams) {
    Progress events(streams, o.progress);
    Scene scene = open_project(o, events);
    names = scene.names;
    std::vector<std::string> inputs = scene.files;
    inputs.push_back(scene.path);
    inputs.insert(inputs.end(), scene.sources.begin(), scene.sources.end());
    check_outputs(o, inputs);
    if (!o.project_out.empty()) write_hugin_project(scene, o.project_out);
    TrueValues truth;
    if (!o.compare.empty()) truth = read_truth(o.compare, scene.images.size());
    Calibration calibration(std::move(scene), o, events);
    OutputFiles outputs;
    Json page;
    add_outputs(o, calibration, outputs, page, streams, events);
    BuildReport &report = calibration.fit.report;
    const int code = finish_fit(report, calibration.key, o.store,
                                {method_name(o.fit.method), calibration.scene.path, o.json, true, o.report, &page,
                                 &outputs, &calibration.prior},
                                streams);
    if (!o.compare.empty() && !o.json) print_comparison(report, truth, streams.out);
    const bool is_refused = !report.fit.usable && !report.fit.equalizes;
    for (const std::string &file : {o.exposures_out, o.pto_out})
        if (is_refused && !file.empty() && !o.store.force)
            print_message(streams, file + ": not written (use --force to write it anyway)");
    if (is_refused && !o.preview.empty())
        print_message(streams, o.preview + ": not written: the result corrects nothing");
    return code;
}

int run(const BuildOptions &o, Streams &streams) {
    check_max_side(o.pixels.max_side);
    check_fit_options(o.fit);
    if (!o.preview.empty()) check_preview(o.preview);
    if (!o.gain_chart.empty()) check_chart_name(o.gain_chart);
    if (!o.report.empty()) check_page_name(o.report);
    if (!o.preview.empty() && !o.points.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--write preview: needs the pictures, which --points does not read; give one of them");
    if (o.json && !o.compare.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--fit truth prints a table, and --json prints JSON; give one of them");
    check_store_options(o.store, uses_stored_prior(o.fit), !o.pto_out.empty() || !o.exposures_out.empty());

    std::vector<std::string> names;
    try {
        return build_and_store(o, names, streams);
    } catch (const Failure &failure) {
        if (o.json && failure.group() == LENSPROF_ERROR_NOT_USABLE)
            print_json(build_json(no_fit(names, failure)), streams.out);
        throw;
    }
}

}  // namespace

int build_page(const std::vector<std::string> &inputs, const std::string &images, const std::string &page,
               Streams &streams) {
    BuildOptions o;
    o.inputs = inputs, o.images = images, o.report = page;
    o.store.no_store = true;
    return run(o, streams);
}

void declare_build(Command &program) {
    Command command = program.add("build", "fit a lens profile to overlapping pictures or a Hugin project",
                                  "Estimates response, falloff, exposures and white balances from overlapping "
                                  "pictures.");
    auto o = std::make_shared<BuildOptions>();
    declare(command, *o);
    command.example("lensprof build photos --report report.html");
    command.run([o](Streams &streams) {
        o->free = std::accumulate(o->free_words.begin(), o->free_words.end(), 0u, std::bit_or<>());
        return run(*o, streams);
    });
}

}  // namespace lensprof
