// `lensprof apply`: corrected pictures (Goldman & Chen 2005, equation 16).
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <set>

#include <nlohmann/json.hpp>

#include "cli/correct/correction.hpp"
#include "cli/fitting/project.hpp"
#include "cli/profiles/lookup_report.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/format.hpp"
#include "cli/program/message.hpp"
#include "cli/program/options.hpp"
#include "cli/program/output_file.hpp"
#include "cli/program/paths.hpp"
#include "cli/program/run.hpp"

namespace lensprof {
namespace {

// What pictures look like afterwards.
enum class Exposure {
    by_default,  // mean with a project, else keep
    mean,
    reference,
    keep
};

struct Options {
    std::string db, pto, output, sheet;
    Exposure exposure = Exposure::by_default;
    int64_t profile = 0;
    CorrectionKind kind;
    bool from_db = false, json = false, progress = false;
    std::vector<std::string> files;
};

void declare_model(Command &command, Options &o) {
    command.profile_id("--profile", o.profile, "id of the profile to use");
    command.flag("--from-db", o.from_db,
                 "look each picture's profile up by its EXIF; between the settings that are stored its falloff is "
                 "predicted, as by `lensprof query`");
    command.file("--pto", o.pto, "take exposures (and, without --profile or --from-db, the curves) from this project");
    declare_db(command, o.db);
    command.choice("--output-exposure", o.exposure,
                   {{"mean", Exposure::mean}, {"reference", Exposure::reference}, {"keep", Exposure::keep}},
                   "mean: all like the geometric mean of the project (default with --pto); reference: like its 0 EV; "
                   "keep: each its own (default without --pto)");
}

void declare(Command &command, Options &o) {
    declare_model(command, o);
    command.flag("--linear", o.kind.linear, "write irradiance instead of grey values, as 32 bit float TIFF");
    command.flag("--simulate", o.kind.simulate, "put the falloff in instead of taking it out");
    command.number("--strength", o.kind.strength, {0.0, 1.0}, "share of the falloff to take out, 0 to 1; default 1");
    command.number("--gain-cap", o.kind.gain_cap, {1.0, 1e6},
                   "corners get at most so many times their light, 1 or more, so that noise stays low; default no cap");
    command.flag("--dither", o.kind.dither,
                 "ordered 8 x 8 dither in place of rounding, in pictures of 8 bit: no bands in skies");
    command.file("-o,--output", o.output, "folder for the pictures");
    command.require("--output");
    command.file("--contact-sheet", o.sheet, "write an overview, before above after, as .png, .tif or .jpg");
    declare_threads(command, o.kind.threads);
    declare_json(command, o.json);
    declare_progress(command, o.progress);
    command.files("FILES", o.files, "pictures, or folders of them; with --pto default all of the project");
    command.footer(
        "Pictures keep format, depth, metadata and colour profile. Several are corrected at once, in strips of rows;\n"
        "interlaced PNG and progressive JPEG alone are held in memory as a whole. All are opened first: when one\n"
        "cannot be, nothing is written. When one turns out to be damaged later, those before it are written, it and\n"
        "those after it are not. A picture that was corrected already is not known as such: it is corrected again.");
}

std::shared_ptr<lensprof_profile> model_of_project(const Project &project) {
    auto profile = std::shared_ptr<lensprof_profile>(new_profile());
    lensprof_error error{};
    check(lensprof_pto_get_response(project.pto.get(), project.reference, &profile->response[0], &error), project.path,
          &error);
    profile->vignetting[0] = project.images[project.reference].vignetting;
    return profile;
}

void look_up(lensprof_store *store, const Options &o, Correction &job) {
    auto profile = std::shared_ptr<lensprof_profile>(new_profile());
    lensprof_error error{};
    job.profile_id = o.profile;
    if (o.profile) {
        check(lensprof_store_get(store, o.profile, profile.get(), &error), store_path(o.db), &error);
    } else {
        const lensprof_profile_key key = read_metadata(job.source).key;
        lensprof_lookup_options options;
        lensprof_lookup_options_init(&options);
        lensprof_lookup how;
        lensprof_lookup_init(&how);
        const lensprof_status status = lensprof_store_lookup(store, &key, &options, profile.get(), &how, &error);
        if (status == LENSPROF_ERROR_NOT_FOUND)
            throw Failure(ExitCode::not_found, job.source + ": no profile for " + describe_key(key) + " in "
                                                   + store_path(o.db) + " (" + how.reason
                                                   + "); make one with `lensprof build` or name one with --profile");
        check(status, store_path(o.db), &error);
        if (how.exact)
            job.profile_id = how.id[0];
        else
            job.lookup = std::make_shared<lensprof_lookup>(how);
    }
    job.model = profile;
}

std::string target_name(const Options &o, const std::string &source) {
    std::filesystem::path name = std::filesystem::path(source).filename();
    if (o.kind.linear) name.replace_extension(".tif");
    return (std::filesystem::path(o.output) / name).string();
}

// A picture of another shape is not the one the project was made with; another size of the same shape will do.
void check_shape(const Project &project, uint32_t image, const std::string &file) {
    const auto &camera = project.images[image].camera;
    PictureSize size = read_size(file);
    double expected = static_cast<double>(camera.width) / camera.height,
           shape = static_cast<double>(size.width) / size.height;
    if (std::abs(shape / expected - 1.0) > 0.01)
        throw Failure(ExitCode::unreadable,
                      file + format(": is %u x %u pixels, but ", size.width, size.height) + project.path
                          + format(" says %u x %u; use the pictures that the project was made with", camera.width,
                                   camera.height));
}

// One response and one falloff are applied to all images.
void check_one_result(const Project &project) {
    const auto &first = project.images[project.reference];
    for (uint32_t i = 0; i < project.images.size(); i++) {
        const auto &image = project.images[i];
        bool same = image.response_type == first.response_type && std::equal(image.emor, image.emor + 5, first.emor)
                    && std::equal(image.vignetting.k, image.vignetting.k + 3, first.vignetting.k);
        if (!same)
            throw Failure(ExitCode::usage, project.path + ": image " + std::to_string(i) + " (" + project.names[i]
                                               + ") has a response or falloff of its own; correct one lens at a time");
    }
}

// A project without a result would change nothing, which nobody asks for on purpose.
void check_has_result(const Project &project) {
    for (const auto &image : project.images) {
        bool response = std::any_of(image.emor, image.emor + 5, [](double a) { return a != 0.0; });
        bool falloff = std::any_of(image.vignetting.k, image.vignetting.k + 3, [](double k) { return k != 0.0; });
        if (response || falloff || image.response_type == 1) return;
    }
    throw Failure(
        ExitCode::usage,
        project.path + ": holds no response and no falloff; give the project that `lensprof build --pto-out` wrote");
}

// The pictures, and in `mean` what --output-exposure mean makes them like.
std::vector<Correction> make_jobs(const Options &o, lensprof_exposure &mean) {
    if (o.profile && o.from_db) throw Failure(ExitCode::usage, "--profile and --from-db contradict each other");
    bool from_store = o.profile || o.from_db;
    if (!from_store && o.pto.empty())
        throw Failure(ExitCode::usage, "say what to correct with: --profile ID, --from-db or --pto FILE");
    std::unique_ptr<Project> project;
    std::vector<lensprof_exposure> exposures;
    std::shared_ptr<const lensprof_profile> model;
    if (!o.pto.empty()) {
        project = std::make_unique<Project>(read_project(o.pto, true));
        exposures = project_exposures(*project);
        if (!from_store) model = model_of_project(*project);
        mean = mean_exposure(exposures);
    } else if (o.exposure == Exposure::mean || o.exposure == Exposure::reference) {
        throw Failure(ExitCode::usage, std::string("--output-exposure ")
                                           + (o.exposure == Exposure::mean ? "mean" : "reference")
                                           + " needs the exposures of a project; give it with --pto");
    }
    std::vector<std::string> files = o.files.empty() && project ? project->files : expand_folders(o.files);
    if (files.empty()) throw Failure(ExitCode::usage, "no pictures to correct; name them");
    Store store = from_store ? open_store(o.db, LENSPROF_STORE_READ) : Store();
    const auto images = project ? std::make_unique<ImagesByFile>(*project) : nullptr;
    std::vector<Correction> jobs;
    for (const std::string &file : files) {
        Correction job{file, target_name(o, file), model, {}, {}, 0, nullptr, 0};
        lensprof_exposure_init(&job.own);
        if (project) {
            uint32_t image = images->at(file, "--pto");
            check_shape(*project, image, file);
            job.own = exposures[image];
        }
        if (from_store) look_up(store.get(), o, job);
        jobs.push_back(job);
    }
    check_targets(jobs, project ? project->files : files, o.sheet);
    if (model) {
        check_has_result(*project);
        check_one_result(*project);
    }
    return jobs;
}

// Once for every kind of prediction, with its first picture.
void say_predicted(const std::vector<Correction> &jobs, Streams &streams) {
    std::set<std::string> said;
    for (const Correction &job : jobs) {
        if (!job.lookup) continue;
        const lensprof_lookup &how = *job.lookup;
        std::string text =
            "falloff " + describe_prediction(how) + format(", standard error %.3f of M in the corner", how.sigma);
        if (*how.reason) text += std::string("; ") + how.reason;
        if (said.insert(text).second) note(streams, job.source + ": " + text);
    }
}

int run(const Options &o, Streams &streams) {
    lensprof_exposure mean, reference;
    lensprof_exposure_init(&mean);
    lensprof_exposure_init(&reference);
    std::vector<Correction> jobs = make_jobs(o, mean);
    const Exposure chosen = o.exposure != Exposure::by_default ? o.exposure
                            : o.pto.empty()                    ? Exposure::keep
                                                               : Exposure::mean;
    make_folder(o.output);

    Progress progress(streams.err, o.progress ? ShowProgress::always : ShowProgress::when_terminal);
    ContactSheet sheet;
    for (Correction &job : jobs)
        job.wanted = chosen == Exposure::keep ? job.own : chosen == Exposure::mean ? mean : reference;
    say_predicted(jobs, streams);
    Corrected written = write_corrected(jobs, o.kind, o.sheet.empty() ? nullptr : &sheet, progress);
    progress.clear();
    if (!o.sheet.empty()) sheet.write(o.sheet);
    if (o.json) {
        Json json = {{"schema", 1}, {"pictures", written.pictures}};
        add_speed(written, json);
        print_json(json, streams.out);
    } else {
        for (const auto &entry : written.pictures) streams.out << entry["output"].get<std::string>() << "\n";
        if (!o.sheet.empty()) streams.out << o.sheet << "\n";
    }
    return 0;
}

}  // namespace

void declare_apply(Command &program) {
    Command command = program.add("apply", "correct pictures with a profile or a project",
                                  "Corrects pictures: undoes falloff, exposure and white balance, and encodes again.");
    auto o = std::make_shared<Options>();
    declare(command, *o);
    command.run([o](Streams &streams) { return run(*o, streams); });
}

}  // namespace lensprof
