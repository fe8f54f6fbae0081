// `lensprof apply`: corrected pictures (Goldman & Chen 2005, equation 16).
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include <nlohmann/json.hpp>

#include "cli/correct/correction.hpp"
#include "cli/correct/overlaps.hpp"
#include "cli/correct/picture_model.hpp"
#include "cli/correct/project_model.hpp"
#include "cli/correct/seeded_exif.hpp"
#include "cli/fitting/exposure_file.hpp"
#include "cli/pictures/coded_kind.hpp"
#include "cli/pictures/named_pictures.hpp"
#include "cli/pictures/raw_kind.hpp"
#include "cli/profiles/foreign_file.hpp"
#include "cli/profiles/lookup_report.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/format.hpp"
#include "cli/program/message.hpp"
#include "cli/program/options.hpp"
#include "cli/program/output_file.hpp"
#include "cli/program/paths.hpp"
#include "cli/program/run.hpp"
#include "cli/program/shard.hpp"

namespace lensprof {
namespace {

// Exposure of the outputs.
enum class Exposure {
    by_default,  // mean with a project, else keep
    mean,
    reference,
    keep
};

// Output for camera raw files.
enum class RawOutput {
    by_default,  // DNG for a DNG, else TIFF
    dng,
    tif
};

struct Options {
    ModelOptions model;
    RawOutput raw_output = RawOutput::by_default;
    std::string linear_end;  // of --linear-output; empty: not given
    std::string pto, exposures, images, shard, output, sheet;
    Exposure exposure = Exposure::by_default;
    CorrectionKind kind;
    bool seed_exif = false, merge = false, skip = false, json = false, progress = false, has_output = true;
    std::vector<std::string> files;

    // The file with the exposures, and its option.
    const std::string &project() const { return pto.empty() ? exposures : pto; }
    const char *project_option() const { return pto.empty() ? "--model" : "--pto"; }
};

struct LeftOut {
    std::string file, reason;
    bool corrected_already;
};

struct Work {
    std::vector<Correction> jobs;
    std::vector<LeftOut> left_out;
    std::vector<LeftOut> unjoined;      // missing from the result of the project
    std::vector<PlacedCorrection> lit;  // of --merge: all images that contribute
    lensprof_exposure mean{};           // the target of --output-exposure mean
};

void declare_exposure(Command &command, Options &o) {
    command.file("--pto", o.pto,
                 "use the exposures (and, without --profile or --from-db, response and falloff) of "
                 "this project");
    command.file("--model", o.exposures,
                 "use exposures, response and falloff of this exposures.json of `build --exposures-out`");
    command.folder("--images", o.images,
                   "folder of the pictures, with --model, if they were moved; default as stored "
                   "in the file");
    command.flag(
        "--seed-exif", o.seed_exif,
        "write the estimated exposure of each output into its EXIF (ExposureTime) and mark this in its XMP; needs "
        "--model; best with --output-exposure keep");
    command.choice(
        "--output-exposure", o.exposure,
        {{"mean", Exposure::mean}, {"reference", Exposure::reference}, {"keep", Exposure::keep}},
        "exposure of the outputs: mean (geometric mean of the project; default with --pto and --model), reference (0 "
        "EV of the project) or keep (unchanged; default without a project)");
}

void declare(Command &command, Options &o) {
    o.model.add_options(command);
    declare_exposure(command, o);
    command.flag("--linear", o.kind.linear, "write irradiance instead of grey values, as 32 bit float");
    command.choice("--linear-output", o.linear_end, {{"tif", ".tif"}, {"exr", ".exr"}},
                   "file format of --linear: tif (default) or exr (OpenEXR without metadata)");
    command.word(
        "--shard", "INDEX/COUNT", [&o](const std::string &word) { o.shard = word; },
        "correct only a part of the pictures, to distribute the work: 2/5 is the second of five parts; "
        "outputs do not depend on it; default all");
    command.flag(
        "--merge", o.merge,
        "merge into each picture the irradiance of all overlapping pictures of the project, also where it is clipped "
        "itself (HDR); needs --linear and --pto");
    command.choice(
        "--raw-output", o.raw_output, {{"dng", RawOutput::dng}, {"tif", RawOutput::tif}},
        "output for camera raw files: dng (default for DNG: a copy with the falloff as an opcode, pixels unchanged) "
        "or tif (default for others: a linear 16 bit TIFF in camera colours)");
    command.flag("--simulate", o.kind.simulate, "add the falloff instead of correcting it");
    command.number("--strength", o.kind.strength, {0.0, 1.0}, "share of the falloff to correct, 0 to 1; default 1");
    command.number("--gain-cap", o.kind.gain_cap, {1.0, 1e6},
                   "maximum gain of the falloff correction, 1 or more, to limit noise in the corners; default "
                   "unlimited");
    command.flag("--dither", o.kind.dither,
                 "use ordered 8 x 8 dither instead of rounding in 8 bit pictures, to avoid banding");
    command.flag(
        "--skip", o.skip,
        "skip named pictures that have no profile or are already corrected, and list them at the end, as for folders; "
        "default: nothing is written if a named picture cannot be corrected");
    command.folder("-o,--output", o.output, "output folder, with the subfolders of the input; default corrected");
    command.file("--contact-sheet", o.sheet,
                 "write an overview of the pictures before and, below, after correction, "
                 "as .png, .tif or .jpg");
    declare_writing(command, o.kind);
    declare_json(command, o.json);
    declare_progress(command, o.progress);
    command.files("FILE", o.files,
                  "pictures and folders of pictures (with subfolders); with --pto or --model default all of the "
                  "project");
    command.footer(
        "Outputs keep format, depth, metadata and colour profile of the picture; a mark in their XMP states\n"
        "the correction by lensprof. Several pictures are corrected in parallel, in strips of rows; only\n"
        "interlaced PNG and progressive JPEG are held in memory completely. All pictures are opened first:\n"
        "if one cannot be opened, nothing is written. If one turns out to be damaged later, only those\n"
        "before it are written. Exit code 5: pictures were refused, because they have no profile or are\n"
        "already corrected. If one of them was named, nothing is written; those of folders, and with --skip\n"
        "all of them, are left out. An existing output is replaced if it was made from the same picture; a\n"
        "file not written by lensprof is replaced only in a folder given with -o.");
}

// A DNG stays a DNG with the falloff as an opcode, unless the options need more than an opcode can express.
bool becomes_dng(const Options &o, const std::string &raw) {
    const CorrectionKind &kind = o.kind;
    const bool is_plain = !kind.linear && !kind.simulate && kind.strength == 1.0 && kind.gain_cap == 0.0
                          && o.project().empty() && o.sheet.empty();
    if (o.raw_output == RawOutput::dng && raw != "DNG")
        throw Failure(ExitCode::usage, "--raw-output dng: needs DNG files, but one is a " + raw
                                           + "; convert it to DNG first, or omit the option");
    if (o.raw_output == RawOutput::dng && !is_plain)
        throw Failure(ExitCode::usage,
                      "--raw-output dng: an opcode stores only the falloff; omit --linear, --simulate, --strength, "
                      "--gain-cap, --pto and --contact-sheet, or use --raw-output tif");
    return raw == "DNG" && is_plain && o.raw_output != RawOutput::tif;
}

// `named`: the name of the picture, with its folders below the output folder.
std::string target_name(const Options &o, const NamedPicture &picture, const std::filesystem::path &named) {
    std::filesystem::path name = named;
    const auto raw = raw_kind(picture.file);
    if (o.kind.linear)
        name.replace_extension(o.linear_end.empty() ? ".tif" : o.linear_end);
    else if ((raw && !becomes_dng(o, *raw)) || (!raw && is_read_alone(picture.file)))
        name.replace_extension(".tif");
    if (raw && becomes_dng(o, *raw)) name.replace_extension(".dng");
    return (std::filesystem::path(o.output) / name).string();
}

// A picture with another aspect ratio is not one the project was made with; another size is accepted.
void check_shape(const Project &project, uint32_t image, const std::string &file) {
    const auto &camera = project.images[image].camera;
    PictureSize size = read_size(file);
    const double expected = static_cast<double>(camera.width) / camera.height,
                 shape = static_cast<double>(size.width) / size.height;
    const bool is_same = size.width == camera.width && size.height == camera.height;
    if (project.models.empty() ? std::abs(shape / expected - 1.0) > 0.01 : !is_same)
        throw Failure(ExitCode::unreadable,
                      file + format(": is %u x %u pixels, but ", size.width, size.height) + project.path
                          + format(" states %u x %u; use the pictures that the project was made with", camera.width,
                                   camera.height));
}

// A project without a result would change nothing; nobody wants that.
void check_has_result(const Project &project) {
    for (const auto &image : project.images) {
        bool response = std::any_of(image.emor, image.emor + 5, [](double a) { return a != 0.0; });
        bool falloff = std::any_of(image.vignetting.k, image.vignetting.k + 3, [](double k) { return k != 0.0; });
        if (response || falloff || image.response_type == 1) return;
    }
    throw Failure(
        ExitCode::usage,
        project.path + ": has neither response nor falloff; give the project that `lensprof build --pto-out` wrote");
}

// The project and, without --profile and --from-db, its model.
struct Source {
    std::unique_ptr<Project> project;
    std::unique_ptr<ImagesByFile> images;
    std::vector<lensprof_exposure> exposures;
    bool has_model = false;
    std::unique_ptr<PictureModels> models;
};

Source open_source(const Options &o) {
    Source source;
    if (o.files.empty() && o.project().empty())
        throw Failure(ExitCode::usage,
                      "no pictures to correct; give pictures "
                      "or folders");
    source.models = std::make_unique<PictureModels>(o.model, o.project().empty());
    const bool from_store = source.models->are_used();
    if (!from_store && o.project().empty())
        throw Failure(ExitCode::usage,
                      "no correction given and no database found; give --profile ID, --from-db, --pto FILE or --model "
                      "FILE");
    if (!o.project().empty()) {
        source.project =
            std::make_unique<Project>(o.pto.empty() ? read_exposures(o.exposures, o.images) : read_project(o.pto));
        source.images = std::make_unique<ImagesByFile>(*source.project);
        source.exposures = relative_to_joined(*source.project);
        source.has_model = !from_store;
    } else if (o.exposure == Exposure::mean || o.exposure == Exposure::reference) {
        throw Failure(ExitCode::usage, std::string("--output-exposure ")
                                           + (o.exposure == Exposure::mean ? "mean" : "reference")
                                           + " needs the exposures of a project; give the project with --pto or "
                                             "--model");
    }
    return source;
}

// If no profile is looked up, an error in the metadata is ignored here: reading the pixels reports it.
PictureMetadata metadata_of(const Options &o, const std::string &file) {
    try {
        return read_metadata(file);
    } catch (const Failure &) {
        if (!o.model.profile && o.project().empty()) throw;
        return unknown_metadata();
    }
}

// NotThisOne for a picture already corrected by lensprof.
void check_mark(const Options &o, const std::string &file, const PictureMetadata &metadata) {
    const auto &mark = metadata.mark;
    if (o.model.force_falloff || o.kind.simulate || !mark || mark->falloff != CorrectionMark::Falloff::removed) return;
    throw NotThisOne(ExitCode::not_found,
                     file + ": already corrected, " + metadata.corrected_by
                         + "; give the original, or use --force-falloff to correct it again",
                     true);
}

// NotThisOne for a DNG whose opcodes already correct the falloff.
void check_opcodes(const Options &o, const std::string &file) {
    if (o.model.force_falloff || !has_falloff_opcode(file)) return;
    throw NotThisOne(ExitCode::not_found,
                     file + ": its opcodes already correct the falloff; use --raw-output tif, which ignores them",
                     true);
}

// The name of a model's image, by which the model identifies the output; without folders if these lead outside.
std::filesystem::path name_below(const std::string &name) {
    const auto path = std::filesystem::path(name).lexically_normal();
    const bool leads_out = path.is_absolute() || *path.begin() == "..";
    return leads_out ? path.filename() : path;
}

Correction make_job(const Options &o, const Source &source, const NamedPicture &picture) {
    Correction job;
    job.source = picture.file;
    std::filesystem::path named =
        std::filesystem::path(picture.subfolder) / std::filesystem::path(picture.file).filename();
    lensprof_exposure_init(&job.own);
    if (source.project) {
        const uint32_t image = source.images->at(picture.file, o.project_option());
        check_shape(*source.project, image, picture.file);
        job.own = source.exposures[image];
        if (source.has_model) job.model = model_of_project(*source.project, image);
        job.model_name = std::filesystem::path(o.project()).filename().string();
        if (!source.project->models.empty()) named = name_below(source.project->names[image]);
    }
    job.target = target_name(o, picture, named);
    const PictureMetadata metadata = metadata_of(o, picture.file);
    check_mark(o, picture.file, metadata);
    if (source.models->are_used()) source.models->choose(metadata, job);
    job.copies_dng = is_dng_name(job.target);
    if (job.copies_dng) check_opcodes(o, picture.file);
    return job;
}

// Named pictures are all wanted: all reasons are printed, and nothing is written.
[[noreturn]] void fail_refused(const std::vector<NotThisOne> &refused, size_t count, Streams &streams) {
    if (refused.size() == 1)
        throw Failure(refused[0].code, refused[0].what() + std::string(count > 1 ? "; or skip it with --skip" : ""));
    for (const NotThisOne &failure : refused) tell(streams, failure.what());
    throw Failure(refused[0].code, std::to_string(refused.size()) + " of " + counted(count, "picture")
                                       + " cannot be corrected, and nothing was written; use --skip to leave them out");
}

// All images of the project in its result. An image that cannot be written itself still contributes; the reason is
// printed.
std::vector<PlacedCorrection> placed_images(const Options &o, const Source &source, const Work &work,
                                            Streams &streams) {
    std::vector<PlacedCorrection> placed;
    std::optional<uint32_t> layout;
    const Project &project = *source.project;
    std::set<uint32_t> written;
    for (const Correction &job : work.jobs) {
        written.insert(source.images->at(job.source, "--pto"));
        check_mergeable(job.source, layout);
    }
    for (uint32_t i = 0; i < project.images.size(); i++) {
        const std::string &file = project.files[i];
        if (project.images[i].left_out) continue;
        try {
            check_shape(project, i, file);
            check_mark(o, file, metadata_of(o, file));
            check_mergeable(file, layout);
        } catch (const Failure &failure) {
            if (written.count(i) || failure.code == ExitCode::interrupted) throw;
            warn(streams, failure.what() + std::string("; it is not merged"));
            continue;
        }
        Correction job;
        job.source = file, job.own = source.exposures[i], job.model = model_of_project(project, i);
        placed.push_back({job, i});
    }
    return placed;
}

void take_shard(const Shard &shard, std::vector<NamedPicture> &pictures) {
    const size_t first = shard.first(pictures.size()), end = shard.end(pictures.size());
    if (first == end && !pictures.empty())
        throw Failure(ExitCode::usage, format("--shard %u/%u: contains none of the %zu pictures; use fewer parts",
                                              shard.number, shard.count, pictures.size()));
    pictures.erase(pictures.begin() + static_cast<std::ptrdiff_t>(end), pictures.end());
    pictures.erase(pictures.begin(), pictures.begin() + static_cast<std::ptrdiff_t>(first));
}

Work plan_work(const Options &o, const Source &source, Streams &streams) {
    std::vector<NamedPicture> pictures;
    if (o.files.empty() && source.project)
        for (const std::string &file : source.project->files) pictures.push_back({file, "", false});
    else
        pictures = named_pictures(o.files, o.output);
    take_shard(shard_of(o.shard), pictures);
    if (pictures.empty()) throw Failure(ExitCode::usage, "no pictures to correct; give pictures or folders");
    Work work;
    lensprof_exposure_init(&work.mean);
    if (source.project) work.mean = mean_exposure(joined_exposures(*source.project, source.exposures));
    std::vector<std::string> inputs = source.project ? source.project->files : std::vector<std::string>();
    std::vector<NotThisOne> refused;
    for (const NamedPicture &picture : pictures) {
        inputs.push_back(picture.file);
        note_instead(picture, streams);
        if (source.project && picture.in_folder && !source.images->find(picture.file)) {
            work.left_out.push_back({picture.file, picture.file + ": is not a picture of " + o.project(), false});
            continue;
        }
        if (source.project && source.project->images[source.images->at(picture.file, o.project_option())].left_out) {
            const std::string reason =
                picture.file + ": not corrected: the project has no exposure for it; use the original";
            warn(streams, reason);
            work.unjoined.push_back({picture.file, reason, false});
            continue;
        }
        try {
            work.jobs.push_back(make_job(o, source, picture));
        } catch (const NotThisOne &failure) {
            if (o.skip || picture.in_folder)
                work.left_out.push_back({picture.file, failure.what(), failure.corrected_already});
            else
                refused.push_back(failure);
        }
    }
    if (!refused.empty()) fail_refused(refused, pictures.size(), streams);
    if (!o.sheet.empty()) format_of_name(o.sheet);  // for its errors, before anything is written
    check_targets(work.jobs, inputs, o.sheet);
    check_older_outputs(work.jobs, o.kind, o.has_output);
    if (source.has_model && !o.pto.empty()) check_has_result(*source.project);
    if (o.merge) work.lit = placed_images(o, source, work, streams);
    return work;
}

void list_left_out(const Work &work, Streams &streams) {
    if (work.left_out.empty()) return;
    tell(streams, std::to_string(work.left_out.size()) + " of "
                      + counted(work.jobs.size() + work.left_out.size(), "picture") + " left out:");
    for (const LeftOut &picture : work.left_out) tell(streams, "  " + picture.reason);
}

Json left_out_json(const Work &work) {
    Json list = Json::array();
    std::vector<LeftOut> all(work.left_out);
    all.insert(all.end(), work.unjoined.begin(), work.unjoined.end());
    for (const LeftOut &picture : all)
        list.push_back(
            {{"file", picture.file}, {"reason", picture.reason}, {"corrected_already", picture.corrected_already}});
    return list;
}

// Prints each note once, with the first picture it applies to; for pictures with the same answer the largest error.
void print_notes(const std::vector<Correction> &jobs, Streams &streams) {
    struct Answer {
        const Correction *first, *least_certain;
        size_t count;
    };
    std::vector<std::string> order;
    std::map<std::string, Answer> answers;
    std::set<std::string> printed;
    for (const Correction &job : jobs) {
        if (!job.note.empty() && printed.insert(job.note).second) note(streams, job.source + ": " + job.note);
        if (!job.lookup) continue;
        const auto [found, is_new] = answers.try_emplace(describe_briefly(*job.lookup), Answer{&job, &job, 0});
        if (is_new) order.push_back(found->first);
        Answer &answer = found->second;
        answer.count++;
        if (job.lookup->how.sigma > answer.least_certain->lookup->how.sigma) answer.least_certain = &job;
    }
    for (const std::string &text : order) {
        const Answer &answer = answers.at(text);
        const std::string others = answer.count > 1 ? " and " + std::to_string(answer.count - 1) + " more" : "";
        note(streams, answer.first->source + others + ": " + text + "; " + (answer.count > 1 ? "at most, " : "")
                          + describe_error(answer.least_certain->lookup->how));
    }
}

Corrected merge(const Options &o, const Source &source, const Work &work, Progress &progress) {
    std::vector<PlacedCorrection> placed;
    for (const Correction &job : work.jobs) placed.push_back({job, source.images->at(job.source, "--pto")});
    return write_from_overlaps(*source.project, placed, work.lit, o.kind, progress);
}

// Pictures of several cameras match only if one response encodes them: that of the project's reference or, if responses
// come from profiles, that of the first picture.
void encode_alike(const Source &source, std::vector<Correction> &jobs, Streams &streams) {
    auto encoding = source.has_model ? common_encoding(*source.project) : nullptr;
    const auto &first = jobs[0].model->response[0];
    const bool differ = std::any_of(jobs.begin(), jobs.end(), [&](const Correction &job) {
        return !std::equal(std::begin(first.table), std::end(first.table), std::begin(job.model->response[0].table));
    });
    if (!source.has_model && differ) encoding = std::make_shared<lensprof_response>(first);
    if (!encoding) return;
    for (Correction &job : jobs) job.encoding = encoding;
    note(streams, source.project->path + ": has several cameras; all outputs are encoded with the response of "
                      + (source.has_model ? std::string("the reference") : jobs[0].source)
                      + " (use --output-exposure keep to encode each with its own)");
}

Corrected correct(const Options &o, const Source &source, Work &work, Streams &streams) {
    if (work.jobs.empty()) return {};
    lensprof_exposure reference;
    lensprof_exposure_init(&reference);
    const Exposure chosen = o.exposure != Exposure::by_default ? o.exposure
                            : o.project().empty()              ? Exposure::keep
                                                               : Exposure::mean;
    for (Correction &job : work.jobs)
        job.wanted = chosen == Exposure::keep ? job.own : chosen == Exposure::mean ? work.mean : reference;
    if (source.project && chosen != Exposure::keep && !o.kind.linear && !o.kind.simulate)
        encode_alike(source, work.jobs, streams);
    if (o.seed_exif) seed_exif(work.jobs, *source.project, source.exposures);
    if (!o.sheet.empty() && work.jobs.size() > ContactSheet::most_pictures)
        throw Failure(
            ExitCode::usage,
            o.sheet
                + format(": a contact sheet holds at most %zu pictures, but %zu are given; correct them in parts",
                         ContactSheet::most_pictures, work.jobs.size()));
    make_folder(o.output);
    Progress progress(streams, o.progress);
    ContactSheet sheet(o.sheet.empty() ? 0 : work.jobs.size());
    print_notes(work.jobs, streams);
    Corrected written = o.merge ? merge(o, source, work, progress)
                                : write_corrected(work.jobs, o.kind, o.sheet.empty() ? nullptr : &sheet, progress);
    progress.clear();
    if (!o.sheet.empty()) sheet.write(o.sheet);
    return written;
}

void check_merge(const Options &o) {
    if (o.pto.empty() || !o.kind.linear)
        throw Failure(ExitCode::usage,
                      "--merge: needs overlapping pictures and --linear; give their project with --pto, and --linear");
    if (o.model.profile || o.model.from_db || o.model.response)
        throw Failure(ExitCode::usage,
                      "--merge: uses response and falloff of the project; omit --profile, --from-db and the response");
    if (o.kind.simulate || o.kind.strength != 1.0 || o.kind.gain_cap != 0.0 || o.kind.dither || !o.sheet.empty())
        throw Failure(ExitCode::usage,
                      "--merge: corrects the falloff completely and writes irradiance; omit --simulate, --strength, "
                      "--gain-cap, --dither and --contact-sheet");
}

void check_project_options(const Options &o) {
    if (!o.pto.empty() && !o.exposures.empty())
        throw Failure(ExitCode::usage, "--pto and --model exclude each other: both give exposures; give one of them");
    if (o.seed_exif && o.linear_end == ".exr")
        throw Failure(ExitCode::usage, "--seed-exif: OpenEXR has no EXIF; use --linear-output tif, or omit the option");
    if (o.exposures.empty() && (!o.images.empty() || o.seed_exif))
        throw Failure(ExitCode::usage, std::string(o.seed_exif ? "--seed-exif" : "--images")
                                           + ": needs --model; give it, or omit the option");
}

int run(Options &o, Streams &streams) {
    check_project_options(o);
    if (!o.linear_end.empty() && !o.kind.linear)
        throw Failure(ExitCode::usage, "--linear-output: needs --linear; give both or neither");
    if (!o.sheet.empty() && format_of_name(o.sheet) == FileFormat::exr)
        throw Failure(
            ExitCode::usage,
            o.sheet + ": a contact sheet is not written as OpenEXR; give a name ending in .jpg, .png or .tif");
    if (o.merge) check_merge(o);
    o.model.puts_in = o.kind.simulate;
    o.has_output = !o.output.empty();
    if (!o.has_output) o.output = "corrected";
    const Source source = open_source(o);
    Work work = plan_work(o, source, streams);
    const Corrected written = correct(o, source, work, streams);
    if (o.json) {
        Json json = {{"schema", 1}, {"pictures", written.pictures}, {"left_out", left_out_json(work)}};
        add_speed(written, json);
        print_json(json, streams.out);
    } else {
        for (const auto &entry : written.pictures) streams.out << entry["output"].get<std::string>() << "\n";
        if (!o.sheet.empty() && !work.jobs.empty()) streams.out << o.sheet << "\n";
    }
    list_left_out(work, streams);
    const bool all_done = std::all_of(work.left_out.begin(), work.left_out.end(),
                                      [](const LeftOut &left_out) { return left_out.corrected_already; });
    if (work.jobs.empty() && work.left_out.empty()) return static_cast<int>(ExitCode::not_usable);
    return static_cast<int>(all_done ? ExitCode::done : ExitCode::not_found);
}

}  // namespace

void declare_apply(Command &program) {
    Command command = program.add("apply", "correct pictures with a profile or a project",
                                  "Removes falloff, exposure and white balance differences from pictures and encodes "
                                  "them again.");
    auto o = std::make_shared<Options>();
    declare(command, *o);
    command.example("lensprof apply photos -o corrected");
    command.run([o](Streams &streams) { return run(*o, streams); });
}

}  // namespace lensprof
