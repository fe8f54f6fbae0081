// `lensprof build`: pictures of a project -> response, falloff, exposures -> a profile in the database.
#include <algorithm>
#include <filesystem>
#include <functional>
#include <numeric>
#include <optional>

#include <nlohmann/json.hpp>

#include "cli/fitting/exposure_file.hpp"
#include "cli/fitting/fit_page.hpp"
#include "cli/fitting/fitting.hpp"
#include "cli/fitting/photographs.hpp"
#include "cli/fitting/preview.hpp"
#include "cli/fitting/profile_store.hpp"
#include "cli/fitting/project_fit.hpp"
#include "cli/fitting/reconstruction_project.hpp"
#include "cli/page/page.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/message.hpp"
#include "cli/program/options.hpp"
#include "cli/program/output_file.hpp"
#include "cli/program/paths.hpp"
#include "cli/reconstruction/reconstruction_file.hpp"
#include "cli/report/drawing.hpp"

namespace lensprof {
namespace {

struct Options : ProjectFitOptions {
    std::vector<std::string> inputs;
    std::string images, image_list, shard, points_out, exposures_out, gain_chart, pto_out, project_out, preview, report,
        compare;
    bool track_colours = false;
    std::vector<uint32_t> free;  // LENSPROF_FREE_..., for every image; empty: as the project asks
    bool json = false, progress = false;
};

constexpr uint32_t balance_flags = LENSPROF_FREE_RED | LENSPROF_FREE_BLUE;
constexpr uint32_t all_flags = lens_flags | LENSPROF_FREE_EV | balance_flags;

void declare_points(Command &command, Options &o) {
    command.files(
        "INPUT", o.inputs,
        "pictures and folders of pictures, whose overlaps are found; or one Hugin project, whose v lines choose "
        "what is estimated; or one reconstruction (COLMAP database.db or model folder, tracks.csv of OpenSfM and "
        "OpenDroneMap, Bundler .out, AliceVision .sfm, OpenMVG sfm_data.json, or a folder of one)");
    command.require("INPUT");
    command.folder("--images", o.images, "folder of a reconstruction's pictures; default beside it");
    command.file("--image-list", o.image_list,
                 "take the images of a reconstruction that this file names alone, one a line");
    command.text("--shard", o.shard,
                 "only a part of a reconstruction's images, for several machines at once: 2/5 is the second of five; "
                 "give each its own --db, which `profile merge` joins");
    command.flag("--track-colors", o.track_colours,
                 "take the colours in tracks.csv and read no picture; so it is without pictures, too");
    command.file("--project-out", o.project_out,
                 "write the project that was found for the pictures, before the fit; to correct it, open it in Hugin");
    command.file("--points", o.points,
                 "use the pairs of this point file; the pictures (and their EXIF exposures) are then not used");
    command.file("--points-out", o.points_out,
                 "write the pairs used (Hugin's 16 columns), also those of a fit that is not usable");
    command.file("--preview", o.preview,
                 "write a mosaic of the pictures before, and below it after correction, as .jpg, .png or .tif");
    command.file("--report", o.report,
                 "write a report with charts and the pictures before and after, as one .html file");
    command.file("--exposures-out", o.exposures_out,
                 "write exposures and white balances with their errors, response and falloff, for `apply --model` and "
                 "other programs, as JSON");
    command.file("--gain-chart", o.gain_chart,
                 "draw what the correction of a reconstruction's pictures gains, as .svg or .png");
    command.file("--pto-out", o.pto_out, "write the project with the result in it, for Hugin, nona and apply");
}

void declare(Command &command, Options &o) {
    declare_points(command, o);
    FitChoices choices;
    choices.stored_prior = true;
    declare_fit(command, o.fit, choices);
    command.choice("--falloff-curves", o.falloff_curves, {{"auto", 0}, {"1", 1}, {"3", 3}},
                   "1, 3 (one a channel) or auto (held-out error decides)");
    command.list("--free", o.free,
                 {{"response", LENSPROF_FREE_RESPONSE},
                  {"falloff", falloff_flags},
                  {"center", LENSPROF_FREE_CENTER},
                  {"ev", LENSPROF_FREE_EV},
                  {"wb", balance_flags},
                  {"all", all_flags}},
                 "what is estimated instead of the v lines, the same of every image; default of a project without "
                 "photometric v lines: all");
    command.text("--reference", o.reference, "image (number or name) whose exposure is 0 EV");
    command.flag(
        "--one-lens", o.one_lens,
        "estimate one response and one falloff for all pictures, whatever camera, lens, focal length, aperture and "
        "focus they state");
    command.choice("--sampling", o.sampling,
                   {{"balanced", LENSPROF_SAMPLING_BALANCED}, {"paper", LENSPROF_SAMPLING_PAPER}},
                   "balanced or paper (d'Angelo 5.1)");
    command.count("--pairs", o.pairs, 0, 1 << 24,
                  "number of pairs; 0 = 300 an image, at least 2000 (radiance: points, 150)");
    command.count("--seed", o.seed, 0, UINT32_MAX, "of the sampling");
    command.count("--max-side", o.max_side, 0, UINT32_MAX,
                  "sample pictures reduced to no less than this many pixels (800); 0 = full size");
    declare_store(command, o.store);
    command.file("--compare", o.compare, "truth.json of `simulate`: print recovered next to true values");
    declare_json(command, o.json);
    declare_progress(command, o.progress);
}

// A name for text that is one of a picture is a slip, which would cost a photograph where it is there; so would a
// preview in the place of one.
void check_is_no_photograph(const std::string &output, bool is_preview) {
    if (!is_preview && is_picture_name(output))
        throw Failure(ExitCode::usage,
                      output + ": is the name of a picture, and what is written is text; give another");
    if (!is_preview || !is_regular_file(output)) return;
    PictureMetadata metadata = unknown_metadata();
    try {
        metadata = read_metadata(output);
    } catch (const Failure &) {
        return;  // no picture that anybody can read
    }
    if (*metadata.key.camera_model || metadata.exposure_time_s)
        throw Failure(ExitCode::usage,
                      output + ": is a photograph that is there already; give the preview another name");
}

// Files of exposures lie beside those of reconstructions, and nothing else is to be lost by a slip.
void check_is_no_other_file(const std::string &output) {
    if (!is_regular_file(output) || file_bytes(output) == 0 || is_exposure_file(output)) return;
    throw Failure(ExitCode::usage, output + ": is there already, and is no file of exposures; give another name");
}

// No output may take the place of an input, of the database or of another output.
void check_outputs(const Options &o, std::vector<std::string> taken) {
    taken.insert(taken.end(), {o.points, o.image_list, o.compare});
    if (!o.store.no_store) taken.push_back(store_path(o.store.db));
    for (const std::string &output :
         {o.points_out, o.exposures_out, o.gain_chart, o.pto_out, o.project_out, o.preview, o.report}) {
        if (output.empty()) continue;
        for (const std::string &other : taken)
            if (is_same_file(output, other))
                throw Failure(ExitCode::usage, output + ": would be written over; give the output another name");
        check_is_no_photograph(output, output == o.preview || output == o.gain_chart);
        if (output == o.exposures_out) check_is_no_other_file(output);
        check_output_file(output);
        taken.push_back(output);
    }
}

// Few reconstruct from film. Sensors of phones are small.
CameraKind usual_kind(const lensprof_profile_key &key) {
    constexpr double least_crop_factor = 4.5;
    const bool is_phone = key.crop_factor != LENSPROF_UNKNOWN && key.crop_factor >= least_crop_factor;
    return {is_phone ? LENSPROF_CAMERA_PHONE : LENSPROF_CAMERA_CAMERA, KindFrom::reconstruction};
}

BuildReport build(const Options &o, Project &project, const std::vector<PictureMetadata> &metadata,
                  const EarlierProfile &prior, const CameraKind &kind, OutputFiles &outputs, Streams &streams) {
    Progress progress(streams.err, o.progress ? ShowProgress::always : ShowProgress::when_terminal);
    ProjectFit done(progress);
    done.report.camera_kind = kind;
    fit_project(o, project, metadata, prior, done, streams);
    BuildReport &report = done.report;
    if (!o.points_out.empty()) outputs.add(o.points_out, points_text(done.input.pairs, project));
    if (!o.exposures_out.empty() && (done.best.corrects() || o.store.force))
        outputs.add(o.exposures_out, exposures_text(done, project, metadata, o.exposures_out));
    if (!o.gain_chart.empty() && !done.gains.empty())
        outputs.add(o.gain_chart, gain_chart(o.gain_chart, project.path, done.gains));
    if (!o.pto_out.empty() && (done.best.corrects() || o.store.force))
        outputs.add(o.pto_out, result_text(done, project, o.pto_out));
    if (!o.preview.empty() && done.best.corrects()) write_preview(o.preview, project, done.best, progress);
    if (!o.report.empty())
        outputs.add(o.report,
                    fit_page({done, project, metadata, command_text(streams.words), streams.warnings}, progress));
    progress.clear();
    if (o.fit.gamma_from == LENSPROF_GAMMA_EXPOSURES && report.fit.gamma_from == LENSPROF_GAMMA_PRIOR)
        warn(streams, project.path
                          + (o.points.empty() ? ": no EXIF exposures that differ" : ": EXIF is not read with --points")
                          + ": gamma rests on the prior");
    return std::move(done.report);
}

// What can be said before the overlaps of pictures are found, which takes time.
void check_photographs(const Options &o, const Photographs &list) {
    std::vector<std::string> inputs = list.files;
    for (const auto &[file, why] : list.left_out) inputs.push_back(file);
    check_outputs(o, inputs);
    check_store(o.store);
    if (o.store.no_store) return;
    // One picture that states camera or lens may be the reference; where none does, the first says so.
    std::optional<Failure> unnamed;
    for (const std::string &file : list.files) {
        try {
            const PictureMetadata metadata = read_metadata(file);
            override_key(metadata.key, metadata.size, o.store, file);
            return;
        } catch (const Failure &failure) {
            if (!unnamed && failure.code == ExitCode::usage) unnamed = failure;  // others are left out, and named then
        }
    }
    if (unnamed) throw *unnamed;
}

// What cannot be asked of a project without cameras.
Project open_reconstruction(const Options &o, Streams &streams) {
    for (const auto &[option, value] : {std::pair("--points", o.points), std::pair("--preview", o.preview),
                                        std::pair("--project-out", o.project_out)})
        if (!value.empty())
            throw Failure(ExitCode::usage, std::string(option) + ": is for panoramas, and " + o.inputs[0]
                                               + " is a reconstruction; leave it out");
    return project_of_reconstruction(
        o.inputs[0], {o.images, o.track_colours, o.image_list, shard_of(o.shard), o.pairs, o.seed}, streams);
}

// A project, or the pictures that take its place.
Project open_project(const Options &o, Streams &streams) {
    if (o.inputs.size() == 1 && is_reconstruction(o.inputs[0])) return open_reconstruction(o, streams);
    for (const auto &[option, is_given] :
         {std::pair("--images", !o.images.empty()), std::pair("--image-list", !o.image_list.empty()),
          std::pair("--shard", !o.shard.empty()), std::pair("--track-colors", o.track_colours),
          std::pair("--gain-chart", !o.gain_chart.empty())})
        if (is_given)
            throw Failure(ExitCode::usage,
                          std::string(option) + ": is of a reconstruction, and " + o.inputs[0]
                              + " is none; leave it out, or give database.db, tracks.csv or the like alone");
    const bool is_project = o.inputs.size() == 1 && !names_pictures(o.inputs[0]);
    for (const std::string &input : o.inputs)
        if (!is_project && !names_pictures(input))
            throw Failure(ExitCode::usage, input + ": is no picture (.jpg, .png, .tif) and no folder; give one project "
                                                   "alone, or pictures and folders");
    if (is_project && !o.project_out.empty())
        throw Failure(ExitCode::usage, "--project-out: writes the project of pictures, and " + o.inputs[0]
                                           + " is a project; leave it out, or give --pto-out");
    if (is_project) {
        check_is_no_part(o.inputs[0]);
        return read_project(o.inputs[0]);
    }
    if (!o.points.empty())
        throw Failure(ExitCode::usage,
                      "--points: needs the project that its pairs belong to; give that in place of pictures");
    Progress progress(streams.err, o.progress ? ShowProgress::always : ShowProgress::when_terminal);
    const Photographs list = find_photographs(o.inputs, streams);
    check_photographs(o, list);
    return project_of_pictures(list, o.one_lens, progress, streams);
}

// What is estimated: by --free, else by the v lines; all where these name nothing photometric, as those of a project
// that was only aligned do not.
void choose_unknowns(const Options &o, Project &project, Streams &streams) {
    uint32_t free = std::accumulate(o.free.begin(), o.free.end(), 0u, std::bit_or<>()), asked = 0;
    for (const auto &image : project.images) asked |= image.free;
    if (!free && !asked) {
        note(streams, project.path
                          + ": its v lines name nothing photometric; response, falloff, exposures and white balances "
                            "are estimated, unless --free says else");
        free = all_flags;
    }
    for (auto &image : project.images) image.free = free ? free : image.free;
}

// The command once its options are read; `names` receives the images as soon as they are known.
int build_and_store(const Options &o, std::vector<std::string> &names, Streams &streams) {
    Project project = open_project(o, streams);
    names = project.names;
    if (project.images.size() < 2)
        throw Failure(ExitCode::not_usable, project.path + ": has one image; at least two overlapping ones are needed",
                      LENSPROF_REASON_FEW_PAIRS);
    std::vector<std::string> inputs = project.files;
    inputs.push_back(project.path);
    inputs.insert(inputs.end(), project.sources.begin(), project.sources.end());
    check_outputs(o, inputs);
    if (!o.project_out.empty()) write_project(project, o.project_out);
    choose_unknowns(o, project, streams);
    if (o.points.empty() && !project.is_reconstruction) check_pictures(project, o.max_side);
    auto metadata = picture_metadata(o, project);
    lensprof_profile_key key = profile_key(o, project, metadata, streams);
    TrueValues truth;
    if (!o.compare.empty()) truth = read_truth(o.compare, project.images.size());
    check_store(o.store);
    CameraKind kind = camera_kind_of(o.fit, key, metadata[project.reference]);
    if (project.is_reconstruction && kind.from == KindFrom::none) kind = usual_kind(key);
    OutputFiles outputs;
    EarlierProfile prior;
    if (takes_stored_prior(o.fit))
        prior = find_stored_prior(o.store, o.fit.stored_id, o.fit.stored_is_asked, key, project.path);
    BuildReport report = build(o, project, metadata, prior, kind, outputs, streams);
    int code = finish_fit(report, key, o.store,
                          {method_name(o.fit.method), project.path, o.json, true, &outputs, &prior}, streams);
    if (!o.compare.empty() && !o.json) print_comparison(report, truth, streams.out);
    for (const std::string &file : {o.exposures_out, o.pto_out})
        if (!report.fit.usable && !report.fit.evens && !file.empty() && !o.store.force)
            tell(streams, file + ": not written (--force writes it all the same)");
    if (!report.fit.usable && !report.fit.evens && !o.preview.empty())
        tell(streams, o.preview + ": not written, for the result evens nothing out");
    return code;
}

int run(const Options &o, Streams &streams) {
    check_max_side(o.max_side);
    check_fit_options(o.fit);
    if (!o.preview.empty()) check_preview(o.preview);
    if (!o.gain_chart.empty()) check_chart_name(o.gain_chart);
    if (!o.report.empty()) check_page_name(o.report);
    if (!o.preview.empty() && !o.points.empty())
        throw Failure(ExitCode::usage, "--preview: shows pictures, which --points leaves out; give one of the two");
    if (o.json && !o.compare.empty())
        throw Failure(ExitCode::usage, "--compare prints a table, which --json leaves out; give one of the two");
    check_store_options(o.store, takes_stored_prior(o.fit), !o.pto_out.empty() || !o.exposures_out.empty());

    std::vector<std::string> names;
    try {
        return build_and_store(o, names, streams);
    } catch (const Failure &failure) {
        if (o.json && failure.code == ExitCode::not_usable) print_json(build_json(no_fit(names, failure)), streams.out);
        throw;
    }
}

}  // namespace

void declare_build(Command &program) {
    Command command = program.add("build", "overlapping pictures, or a Hugin project -> a lens profile in the database",
                                  "Recovers response, falloff, exposure and white balance from overlapping pictures.");
    auto o = std::make_shared<Options>();
    declare(command, *o);
    command.run([o](Streams &streams) { return run(*o, streams); });
}

}  // namespace lensprof
