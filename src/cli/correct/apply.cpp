// `lensprof apply`: corrected pictures (Goldman & Chen 2005, equation 16).
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <set>

#include <nlohmann/json.hpp>

#include "cli/correct/apply_options.hpp"
#include "cli/correct/apply_plan.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/exit_code.hpp"
#include "cli/program/message.hpp"
#include "cli/program/options.hpp"
#include "cli/program/run.hpp"
#include "photo/base/format.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/correct/correction.hpp"
#include "photo/correct/lookup_report.hpp"
#include "photo/correct/overlaps.hpp"
#include "photo/correct/scene_model.hpp"
#include "photo/correct/seeded_exif.hpp"
#include "photo/pictures/contact_sheet.hpp"
#include "photo/pictures/thumbnail.hpp"

namespace lensprof {
namespace {

void list_left_out(const ApplyWork &work, size_t corrected, Streams &streams) {
    if (work.left_out.empty()) return;
    print_message(streams, std::to_string(work.left_out.size()) + " of "
                               + counted(corrected + work.left_out.size(), "picture") + " left out:");
    for (const LeftOut &picture : work.left_out) print_message(streams, "  " + picture.reason);
}

// The code of the first picture that failed; a picture without a profile counts only if none did.
lensprof_status status_of(const std::vector<LeftOut> &left_out) {
    lensprof_status status = LENSPROF_OK;
    for (const LeftOut &picture : left_out) {
        if (picture.corrected_already) continue;
        if (group_of(picture.status) != LENSPROF_ERROR_NOT_FOUND) return picture.status;
        status = picture.status;
    }
    return status;
}

Json left_out_json(const ApplyWork &work) {
    Json list = Json::array();
    std::vector<LeftOut> all(work.left_out);
    all.insert(all.end(), work.unjoined.begin(), work.unjoined.end());
    for (const LeftOut &picture : all)
        list.push_back(
            {{"file", picture.file}, {"reason", picture.reason}, {"corrected_already", picture.corrected_already}});
    return list;
}

bool has_one_falloff(const lensprof_profile &model) {
    const auto is_first = [&](const lensprof_vignetting &v) { return std::equal(v.k, v.k + 3, model.vignetting[0].k); };
    return model.grid.channels != 3 && std::all_of(model.vignetting, model.vignetting + model.vignettings, is_first);
}

// A note of the first picture that it concerns, with the number of others.
template <class Concerns>
void note_of(const std::vector<Correction> &jobs, const Concerns &concerns, const std::string &text, Streams &streams) {
    const auto first = std::find_if(jobs.begin(), jobs.end(), concerns);
    if (first == jobs.end()) return;
    const auto count = std::count_if(first, jobs.end(), concerns);
    note(streams, first->source + (count > 1 ? " and " + std::to_string(count - 1) + " more" : "") + ": " + text);
}

// For --chroma: pictures whose colour the profile cannot correct.
void note_colourless(const std::vector<Correction> &jobs, Streams &streams) {
    note_of(
        jobs, [](const Correction &job) { return has_one_falloff(*job.model); },
        "its profile has one falloff for all channels, so that --chroma leaves it unchanged", streams);
}

// What a profile with an image circle leaves alone; opcodes of DNG do not hold it.
void note_circles(const std::vector<Correction> &jobs, Streams &streams) {
    const auto radius = [](const Correction &job) { return job.model->image_circle.radius; };
    for (const bool in_opcodes : {false, true}) {
        const auto concerns = [&](const Correction &job) { return radius(job) > 0.0 && job.copies_dng == in_opcodes; };
        const auto first = std::find_if(jobs.begin(), jobs.end(), concerns);
        if (first == jobs.end()) continue;
        note_of(jobs, concerns,
                format("the image circle has a radius of %.2f half diagonals; ", radius(*first))
                    + (in_opcodes ? "the opcode lifts what lies outside by the continued falloff"
                                  : "what lies outside is left as it is"),
                streams);
    }
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
        if (job.lookup->lookup.sigma > answer.least_certain->lookup->lookup.sigma) answer.least_certain = &job;
    }
    for (const std::string &text : order) {
        const Answer &answer = answers.at(text);
        const std::string others = answer.count > 1 ? " and " + std::to_string(answer.count - 1) + " more" : "";
        note(streams, answer.first->source + others + ": " + text + "; " + (answer.count > 1 ? "at most, " : "")
                          + describe_error(answer.least_certain->lookup->lookup));
    }
}

Corrected merge(const ApplyOptions &o, const ApplySource &source, const ApplyWork &work, Progress &progress) {
    std::vector<PlacedCorrection> placed;
    for (const Correction &job : work.jobs) placed.push_back({job, source.images->at(job.source, "--pto")});
    return write_from_overlaps(*source.scene, placed, work.lit, o.kind, progress);
}

// Pictures of several cameras match only if one response encodes them: that of the project's reference or, if responses
// come from profiles, that of the first picture.
void encode_alike(const ApplySource &source, std::vector<Correction> &jobs, Streams &streams) {
    auto encoding = source.has_model ? common_encoding(*source.scene) : nullptr;
    const auto &first = jobs[0].model->response[0];
    const bool differ = std::any_of(jobs.begin(), jobs.end(), [&](const Correction &job) {
        return !std::equal(std::begin(first.table), std::end(first.table), std::begin(job.model->response[0].table));
    });
    if (!source.has_model && differ) encoding = std::make_shared<lensprof_response>(first);
    if (!encoding) return;
    for (Correction &job : jobs) job.encoding = encoding;
    note(streams, source.scene->path + ": has several cameras; all outputs are encoded with the response of "
                      + (source.has_model ? std::string("the reference") : jobs[0].source)
                      + " (use --set exposure=keep to encode each with its own)");
}

// Whether a file is a picture that a camera took.
bool is_photograph(const std::string &file) {
    if (!is_regular_file(file)) return false;
    try {
        const PictureMetadata metadata = read_metadata(file);
        return *metadata.key.camera_model || metadata.exposure_time_s;
    } catch (const Failure &) {  // not a picture
        return false;
    }
}

// Failure for a contact sheet that cannot be written or would replace a photograph, before the pictures are corrected.
void check_sheet(const ApplyOptions &o, size_t pictures) {
    if (pictures > ContactSheet::most_pictures)
        throw Failure(
            LENSPROF_ERROR_ARGUMENT,
            o.sheet
                + format(": a contact sheet holds at most %zu pictures, but %zu are given; correct them in parts",
                         ContactSheet::most_pictures, pictures));
    if (!is_in_new_folder(o.sheet, o.output)) check_output_file(o.sheet);
    if (!o.kind.overwrite && is_photograph(o.sheet))
        throw Failure(LENSPROF_ERROR_ARGUMENT, o.sheet + ": is a photograph; give the contact sheet another name, or use "
                                                 "--overwrite");
}

// 1 if the metadata of a picture that was read are damaged.
uint16_t orientation_of(const std::string &file) {
    try {
        return read_metadata(file).orientation;
    } catch (const Failure &) {
        return 1;
    }
}

ContactSheet::Cell sheet_cell(const Correction &job, const SmallCopies &small, uint32_t side) {
    const std::string name = std::filesystem::path(job.source).filename().string();
    if (!small.before.width) return {Picture(), Picture(), name, "not corrected"};
    const uint16_t orientation = orientation_of(job.source);
    return {upright_copy(small.before, orientation, side), upright_copy(small.after, orientation, side), name,
            correction_note(job)};
}

Corrected correct(const ApplyOptions &o, const ApplySource &source, ApplyWork &work, Streams &streams) {
    if (work.jobs.empty()) return {};
    lensprof_exposure reference;
    lensprof_exposure_init(&reference);
    const OutputExposure chosen = o.exposure != OutputExposure::by_default ? o.exposure
                                  : o.project().empty()                    ? OutputExposure::keep
                                                                           : OutputExposure::mean;
    const auto set_target = [&](auto &correction) {
        correction.target_exposure = chosen == OutputExposure::keep   ? correction.exposure
                                     : chosen == OutputExposure::mean ? work.mean
                                                                      : reference;
    };
    for (Correction &job : work.jobs) {
        set_target(job);
        for (CropCorrection &crop : job.crops) set_target(crop);
        if (!job.crops.empty()) job.target_exposure = job.exposure;  // what is not of a crop is not corrected
    }
    if (source.scene && chosen != OutputExposure::keep && !o.kind.linear && !o.kind.simulate)
        encode_alike(source, work.jobs, streams);
    if (o.seed_exif) seed_exif(work.jobs, *source.scene, source.exposures);
    if (!o.sheet.empty()) check_sheet(o, work.jobs.size());
    make_folder(o.output);
    Progress progress(streams, o.progress);
    ContactSheet sheet(o.sheet.empty() ? 0 : work.jobs.size());
    if (o.kind.chroma) note_colourless(work.jobs, streams);
    note_circles(work.jobs, streams);
    print_notes(work.jobs, streams);
    const CopySink sink{sheet.side(), [&](uint32_t i, const SmallCopies &small) {
                            sheet.put(i, sheet_cell(work.jobs[i], small, sheet.side()));
                        }};
    Corrected written = o.merge ? merge(o, source, work, progress)
                                : write_corrected(work.jobs, o.kind, o.sheet.empty() ? nullptr : &sink, progress);
    progress.clear();
    if (!o.sheet.empty()) sheet.write(o.sheet);
    return written;
}

int run(ApplyOptions &o, Streams &streams) {
    check_project_options(o);
    if (!o.linear_end.empty() && !o.kind.linear)
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--encoding linear: needs --linear; give both or neither");
    if (!o.sheet.empty() && format_of_name(o.sheet) == FileFormat::exr)
        throw Failure(
            LENSPROF_ERROR_ARGUMENT,
            o.sheet + ": a contact sheet is not written as OpenEXR; give a name ending in .jpg, .png or .tif");
    if (o.merge) check_merge(o);
    o.model.puts_in = o.kind.simulate;
    o.has_output = !o.output.empty();
    if (!o.has_output) o.output = "corrected";
    const ApplySource source = open_source(o);
    ApplyWork work = plan_work(o, source, streams);
    const Corrected written = correct(o, source, work, streams);
    if (work.jobs.size() == 1 && work.left_out.empty() && !written.failed.empty())
        throw Failure(written.failed[0].failure);
    for (const auto &[file, failure] : written.failed)
        work.left_out.push_back({file, failure.what(), false, failure.status});
    if (o.json) {
        Json json = {{"schema", json_schema}, {"pictures", written.pictures}, {"left_out", left_out_json(work)}};
        add_speed(written, json);
        print_json(json, streams.out);
    } else {
        for (const auto &entry : written.pictures) streams.out << entry["output"].get<std::string>() << "\n";
        if (!o.sheet.empty() && !work.jobs.empty()) streams.out << o.sheet << "\n";
    }
    list_left_out(work, written.pictures.size(), streams);
    if (work.jobs.empty() && work.left_out.empty()) return static_cast<int>(ExitCode::not_usable);
    return static_cast<int>(exit_code(status_of(work.left_out)));
}

}  // namespace

void declare_apply(Command &program) {
    Command command = program.add("apply", "correct pictures with a profile or a project",
                                  "Removes falloff, exposure and white balance differences from pictures and encodes "
                                  "them again.");
    auto o = std::make_shared<ApplyOptions>();
    declare_options(command, *o);
    command.example("lensprof apply photos -o corrected");
    command.run([o](Streams &streams) { return run(*o, streams); });
}

}  // namespace lensprof
