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

// What pictures look like afterwards.
enum class Exposure {
    by_default,  // mean with a project, else keep
    mean,
    reference,
    keep
};

// What becomes of camera raw files.
enum class RawOutput {
    by_default,  // a DNG of a DNG, else a TIFF
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

    // The file that says the pictures' exposures, and the option that names it.
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
    std::vector<LeftOut> unjoined;      // that the result of the project is without
    std::vector<PlacedCorrection> lit;  // of --merge: all images that say something of the light
    lensprof_exposure mean{};           // what --output-exposure mean makes the pictures like
};

void declare_exposure(Command &command, Options &o) {
    command.file("--pto", o.pto, "take exposures (and, without --profile or --from-db, the curves) from this project");
    command.file("--model", o.exposures,
                 "take exposures, response and falloff from this exposures.json of `build --exposures-out`");
    command.folder("--images", o.images, "with --model: folder of the pictures, where they are elsewhere by now");
    command.flag(
        "--seed-exif", o.seed_exif,
        "with --model: write the exposure that each output has into its EXIF (ExposureTime), and a mark of that "
        "into its XMP; best with --output-exposure keep");
    command.choice(
        "--output-exposure", o.exposure,
        {{"mean", Exposure::mean}, {"reference", Exposure::reference}, {"keep", Exposure::keep}},
        "mean: all like the geometric mean of the project (default with --pto and --model); reference: like its "
        "0 EV; keep: each its own (default without)");
}

void declare(Command &command, Options &o) {
    o.model.add_options(command);
    declare_exposure(command, o);
    command.flag("--linear", o.kind.linear, "write irradiance instead of grey values, as 32 bit float TIFF");
    command.choice("--linear-output", o.linear_end, {{"tif", ".tif"}, {"exr", ".exr"}},
                   "of --linear: tif (default), or exr, OpenEXR without metadata");
    command.text("--shard", o.shard,
                 "only a part of the pictures, for several machines at once: 2/5 is the second of five; outputs are "
                 "as without");
    command.flag(
        "--merge", o.merge,
        "of --linear with --pto: the light of each picture in its own frame from all pictures of the project that "
        "overlap it, also where it is white or black itself (HDR)");
    command.choice(
        "--raw-output", o.raw_output, {{"dng", RawOutput::dng}, {"tif", RawOutput::tif}},
        "of camera raw files: dng, a copy of the DNG with the falloff as an opcode, pixels untouched (default "
        "for DNG); tif, a linear 16 bit TIFF in the camera's colours (default for others)");
    command.flag("--simulate", o.kind.simulate, "put the falloff in instead of taking it out");
    command.number("--strength", o.kind.strength, {0.0, 1.0}, "share of the falloff to take out, 0 to 1; default 1");
    command.number("--gain-cap", o.kind.gain_cap, {1.0, 1e6},
                   "corners get at most so many times their light, 1 or more, so that noise stays low; default no cap");
    command.flag("--dither", o.kind.dither,
                 "ordered 8 x 8 dither in place of rounding, in pictures of 8 bit: no bands in skies");
    command.flag(
        "--skip", o.skip,
        "leave out pictures without a profile and those corrected already, and list them at the end, as is done "
        "with those of folders; without it none is corrected where one that is named cannot be");
    command.folder("-o,--output", o.output,
                   "folder for the pictures; those of subfolders go to subfolders; default corrected, here");
    command.file("--contact-sheet", o.sheet, "write an overview, before above after, as .png, .tif or .jpg");
    declare_writing(command, o.kind);
    declare_json(command, o.json);
    declare_progress(command, o.progress);
    command.files("FILES", o.files,
                  "pictures, or folders of them with their subfolders; with --pto default all of the project");
    command.footer(
        "Pictures keep format, depth, metadata and colour profile; a mark in their XMP says that lensprof corrected\n"
        "them. Several are corrected at once, in strips of rows; interlaced PNG and progressive JPEG alone are held in\n"
        "memory as a whole. All are opened first: when one cannot be, nothing is written. When one turns out to be\n"
        "damaged later, those before it are written, it and those after it are not. Exit code 5: pictures were refused\n"
        "(no profile, or corrected already): of pictures that are named none is corrected then; those of folders, and with\n"
        "--skip all, are left out. An output is replaced where it was made of the same picture; one that is not by\n"
        "lensprof only in a folder that is named with -o.");
}

// A DNG stays one, with the falloff as an opcode, unless something is asked for that an opcode does not express.
bool becomes_dng(const Options &o, const std::string &raw) {
    const CorrectionKind &kind = o.kind;
    const bool is_plain = !kind.linear && !kind.simulate && kind.strength == 1.0 && kind.gain_cap == 0.0
                          && o.project().empty() && o.sheet.empty();
    if (o.raw_output == RawOutput::dng && raw != "DNG")
        throw Failure(ExitCode::usage, "--raw-output dng: takes DNG files, and one is a " + raw
                                           + "; convert it to DNG first, or leave the option out");
    if (o.raw_output == RawOutput::dng && !is_plain)
        throw Failure(ExitCode::usage,
                      "--raw-output dng: an opcode is a falloff alone; leave out --linear, --simulate, --strength, "
                      "--gain-cap, --pto and --contact-sheet, or give --raw-output tif");
    return raw == "DNG" && is_plain && o.raw_output != RawOutput::tif;
}

// `named`: what the picture is called, with the folders below that of the outputs.
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

// A picture of another shape is not the one the project was made with; another size of the same shape will do.
void check_shape(const Project &project, uint32_t image, const std::string &file) {
    const auto &camera = project.images[image].camera;
    PictureSize size = read_size(file);
    const double expected = static_cast<double>(camera.width) / camera.height,
                 shape = static_cast<double>(size.width) / size.height;
    const bool is_same = size.width == camera.width && size.height == camera.height;
    if (project.models.empty() ? std::abs(shape / expected - 1.0) > 0.01 : !is_same)
        throw Failure(ExitCode::unreadable,
                      file + format(": is %u x %u pixels, but ", size.width, size.height) + project.path
                          + format(" says %u x %u; use the pictures that the project was made with", camera.width,
                                   camera.height));
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

// The project, and where neither --profile nor --from-db is given the model in it.
struct Source {
    std::unique_ptr<Project> project;
    std::unique_ptr<ImagesByFile> images;
    std::vector<lensprof_exposure> exposures;
    bool has_model = false;
    std::unique_ptr<PictureModels> models;
};

Source open_source(const Options &o) {
    Source source;
    if (o.files.empty() && o.project().empty()) throw Failure(ExitCode::usage, "no pictures to correct; name them");
    source.models = std::make_unique<PictureModels>(o.model, o.project().empty());
    const bool from_store = source.models->are_used();
    if (!from_store && o.project().empty())
        throw Failure(ExitCode::usage,
                      "say what to correct with: --profile ID, --from-db, --pto FILE or --model FILE; there is no "
                      "database of your own yet, and none is installed");
    if (!o.project().empty()) {
        source.project =
            std::make_unique<Project>(o.pto.empty() ? read_exposures(o.exposures, o.images) : read_project(o.pto));
        source.images = std::make_unique<ImagesByFile>(*source.project);
        source.exposures = relative_to_joined(*source.project);
        source.has_model = !from_store;
    } else if (o.exposure == Exposure::mean || o.exposure == Exposure::reference) {
        throw Failure(ExitCode::usage, std::string("--output-exposure ")
                                           + (o.exposure == Exposure::mean ? "mean" : "reference")
                                           + " needs the exposures of a project; give it with --pto or --model");
    }
    return source;
}

// Where no profile is to be found by them, metadata that cannot be read are those of a picture that cannot be, which is
// said of its pixels.
PictureMetadata metadata_of(const Options &o, const std::string &file) {
    try {
        return read_metadata(file);
    } catch (const Failure &) {
        if (!o.model.profile && o.project().empty()) throw;
        return unknown_metadata();
    }
}

// NotThisOne for a picture that lensprof has corrected.
void check_mark(const Options &o, const std::string &file, const PictureMetadata &metadata) {
    const auto &mark = metadata.mark;
    if (o.model.force_falloff || o.kind.simulate || !mark || mark->falloff != CorrectionMark::Falloff::removed) return;
    throw NotThisOne(ExitCode::not_found,
                     file + ": is corrected already, " + metadata.corrected_by
                         + "; correct that picture, or this one once more with --force-falloff",
                     true);
}

// NotThisOne for a DNG whose opcodes correct the falloff.
void check_opcodes(const Options &o, const std::string &file) {
    if (o.model.force_falloff || !has_falloff_opcode(file)) return;
    throw NotThisOne(ExitCode::not_found,
                     file + ": its opcodes correct the falloff already; give --raw-output tif, which corrects the "
                            "sensor's values without them",
                     true);
}

// The name of a model's image, by which the model takes the output for it; without folders where these lead out.
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

// Pictures that are named are all wanted: all reasons are told, and nothing is written.
[[noreturn]] void fail_refused(const std::vector<NotThisOne> &refused, size_t count, Streams &streams) {
    if (refused.size() == 1)
        throw Failure(refused[0].code,
                      refused[0].what() + std::string(count > 1 ? "; or leave it out with --skip" : ""));
    for (const NotThisOne &one : refused) tell(streams, one.what());
    throw Failure(refused[0].code, std::to_string(refused.size()) + " of " + counted(count, "picture")
                                       + " cannot be corrected, and none is; leave them out with --skip");
}

// Each image of the project that is part of its result. What keeps one that is not to be written itself from giving
// light is said, and the others give theirs.
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
            warn(streams, failure.what() + std::string("; its light is not used"));
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
        throw Failure(ExitCode::usage, format("--shard %u/%u: has none of the %zu pictures; give fewer parts",
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
    if (pictures.empty()) throw Failure(ExitCode::usage, "no pictures to correct; name them");
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
                picture.file
                + ": is not part of the result, and its exposure is not known; it is not corrected: use the original";
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

// Everything once, with the first picture of which it is true; of pictures that are answered alike the largest error.
void say_notes(const std::vector<Correction> &jobs, Streams &streams) {
    struct Answer {
        const Correction *first, *least_sure;
        size_t count;
    };
    std::vector<std::string> order;
    std::map<std::string, Answer> answers;
    std::set<std::string> said;
    for (const Correction &job : jobs) {
        if (!job.note.empty() && said.insert(job.note).second) note(streams, job.source + ": " + job.note);
        if (!job.lookup) continue;
        const auto [found, is_new] = answers.try_emplace(describe_briefly(*job.lookup), Answer{&job, &job, 0});
        if (is_new) order.push_back(found->first);
        Answer &answer = found->second;
        answer.count++;
        if (job.lookup->how.sigma > answer.least_sure->lookup->how.sigma) answer.least_sure = &job;
    }
    for (const std::string &text : order) {
        const Answer &answer = answers.at(text);
        const std::string others = answer.count > 1 ? " and " + std::to_string(answer.count - 1) + " more" : "";
        note(streams, answer.first->source + others + ": " + text + "; " + (answer.count > 1 ? "at most, " : "")
                          + describe_error(answer.least_sure->lookup->how));
    }
}

Corrected merge(const Options &o, const Source &source, const Work &work, Progress &progress) {
    std::vector<PlacedCorrection> placed;
    for (const Correction &job : work.jobs) placed.push_back({job, source.images->at(job.source, "--pto")});
    return write_from_overlaps(*source.project, placed, work.lit, o.kind, progress);
}

// Pictures of several cameras look alike only where one response encodes them: that of the project's reference, or
// where responses are of profiles that of the first picture.
void encode_alike(const Source &source, std::vector<Correction> &jobs, Streams &streams) {
    auto encoding = source.has_model ? common_encoding(*source.project) : nullptr;
    const auto &first = jobs[0].model->response[0];
    const bool differ = std::any_of(jobs.begin(), jobs.end(), [&](const Correction &job) {
        return !std::equal(std::begin(first.table), std::end(first.table), std::begin(job.model->response[0].table));
    });
    if (!source.has_model && differ) encoding = std::make_shared<lensprof_response>(first);
    if (!encoding) return;
    for (Correction &job : jobs) job.encoding = encoding;
    note(streams, source.project->path + ": is of several cameras; what is written is encoded by the response of "
                      + (source.has_model ? std::string("the reference's") : jobs[0].source)
                      + " (--output-exposure keep: each by its own)");
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
    make_folder(o.output);
    Progress progress(streams.err, o.progress ? ShowProgress::always : ShowProgress::when_terminal);
    ContactSheet sheet;
    say_notes(work.jobs, streams);
    Corrected written = o.merge ? merge(o, source, work, progress)
                                : write_corrected(work.jobs, o.kind, o.sheet.empty() ? nullptr : &sheet, progress);
    progress.clear();
    if (!o.sheet.empty()) sheet.write(o.sheet);
    return written;
}

void check_merge(const Options &o) {
    if (o.pto.empty() || !o.kind.linear)
        throw Failure(ExitCode::usage,
                      "--merge: takes light from overlapping pictures; give their project with --pto, and --linear");
    if (o.model.profile || o.model.from_db || o.model.response)
        throw Failure(ExitCode::usage,
                      "--merge: takes response and falloff of the project; leave out --profile, --from-db and the "
                      "response");
    if (o.kind.simulate || o.kind.strength != 1.0 || o.kind.gain_cap != 0.0 || o.kind.dither || !o.sheet.empty())
        throw Failure(ExitCode::usage,
                      "--merge: takes the falloff out as a whole, and writes light; leave out --simulate, --strength, "
                      "--gain-cap, --dither and --contact-sheet");
}

void check_project_options(const Options &o) {
    if (!o.pto.empty() && !o.exposures.empty())
        throw Failure(ExitCode::usage, "--pto and --model: both say the exposures; give one of the two");
    if (o.seed_exif && o.linear_end == ".exr")
        throw Failure(ExitCode::usage, "--seed-exif: OpenEXR holds no EXIF; give --linear-output tif, or leave it out");
    if (o.exposures.empty() && (!o.images.empty() || o.seed_exif))
        throw Failure(ExitCode::usage, std::string(o.seed_exif ? "--seed-exif" : "--images")
                                           + ": is for the exposures of --model; give that, or leave it out");
}

int run(Options &o, Streams &streams) {
    check_project_options(o);
    if (!o.linear_end.empty() && !o.kind.linear)
        throw Failure(ExitCode::usage,
                      "--linear-output: is for --linear, which writes irradiance; give both or neither");
    if (!o.sheet.empty() && format_of_name(o.sheet) == FileFormat::exr)
        throw Failure(
            ExitCode::usage,
            o.sheet + ": OpenEXR holds light, and a contact sheet is a picture; give a name in .jpg, .png or .tif");
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
                                      [](const LeftOut &one) { return one.corrected_already; });
    if (work.jobs.empty() && work.left_out.empty()) return static_cast<int>(ExitCode::not_usable);
    return static_cast<int>(all_done ? ExitCode::done : ExitCode::not_found);
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
