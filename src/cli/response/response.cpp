// `lensprof response`: fits the camera's response to raw files and the camera's JPEGs of them.
#include <algorithm>
#include <cctype>
#include <chrono>
#include <filesystem>
#include <memory>

#include <nlohmann/json.hpp>

#include "cli/fitting/fitting.hpp"
#include "cli/fitting/store_options.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/exit_code.hpp"
#include "cli/program/interrupt.hpp"
#include "cli/program/message.hpp"
#include "cli/program/progress.hpp"
#include "cli/report/findings.hpp"
#include "cli/response/response_report.hpp"
#include "photo/base/events.hpp"
#include "photo/base/format.hpp"
#include "photo/base/lap.hpp"
#include "photo/base/paths.hpp"
#include "photo/calibration/outcome.hpp"
#include "photo/pictures/metadata.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/pictures/raw_kind.hpp"

namespace lensprof {
namespace {

struct Options {
    StoreOptions store;
    std::vector<std::string> files, jpegs;
    bool json = false, progress = false;
};

void declare(Command &command, Options &o) {
    command.files("FILE", o.files, "raw files of one camera, with the JPEG that the camera embedded in each");
    command.require("FILE");
    command.words(
        "--jpeg", "FILE", [&o](const std::string &word) { o.jpegs.push_back(word); },
        "camera JPEG of the same shot; give one per raw file, in the same order; default the embedded JPEG");
    declare_store(command, o.store);
    declare_json(command, o.json);
    declare_progress(command, o.progress);
}

void check_options(const Options &o) {
    check_store_options(o.store);
    if (!o.jpegs.empty()) require_count(o.jpegs.size(), "--jpeg", o.files.size(), "raw file");
    for (size_t i = 0; i < o.files.size(); i++)
        for (size_t k = 0; k < i; k++)
            if (is_same_file(o.files[i], o.files[k]))
                throw Failure(LENSPROF_ERROR_ARGUMENT, o.files[i] + ": given twice; give it once");
    if (o.files.size() > LENSPROF_RENDERING_SHOTS)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      format("%zu files are too many (maximum %d), and a few suffice; give fewer", o.files.size(),
                             LENSPROF_RENDERING_SHOTS));
}

// A JPEG in the same folder with the base name of the raw file; empty = none.
std::string neighbouring_jpeg(const std::string &raw) {
    std::error_code ignored;
    for (const char *end : {".JPG", ".jpg", ".JPEG", ".jpeg"}) {
        const std::string file = std::filesystem::path(raw).replace_extension(end).string();
        if (std::filesystem::is_regular_file(file, ignored)) return file;
    }
    return {};
}

Picture read_jpeg(const std::string &file) {
    Picture picture = read_picture(file);
    if (picture.traits.format != FileFormat::jpeg)
        throw Failure(LENSPROF_ERROR_ARGUMENT, file + ": is not a JPEG, but only the camera's own JPEGs show its response; "
                                              "give the JPEG of the same shot with --jpeg");
    if (read_metadata(file).mark)
        throw Failure(LENSPROF_ERROR_ARGUMENT, file + ": was written by lensprof, but only the camera's own JPEGs show its "
                                              "response; give the original");
    return picture;
}

bool is_large_enough(const Picture &picture) {
    return std::max(picture.width, picture.height) >= LENSPROF_RENDERING_SIDE;
}

// The JPEG of --jpeg, else the embedded one, else (none, or not much larger than an icon) the JPEG next to the raw
// file, whose name `jpeg_file` receives.
Picture read_rendered(const Options &o, size_t i, std::string &jpeg_file, Streams &streams) {
    if (!o.jpegs.empty()) return read_jpeg(jpeg_file = o.jpegs[i]);
    const std::string other = neighbouring_jpeg(o.files[i]);
    try {
        Picture picture = read_raw_preview(o.files[i]);
        if (is_large_enough(picture) || other.empty()) return picture;
    } catch (const Failure &failure) {
        const bool is_raw = failure.group() == LENSPROF_ERROR_READ && can_read_raw() && raw_kind(o.files[i]);
        if (!is_raw) throw;
        if (other.empty()) throw Failure(failure.status, failure.what() + std::string(", and give it with --jpeg"));
    }
    note(streams, o.files[i] + ": has no large enough JPEG preview; using " + other);
    return read_jpeg(jpeg_file = other);
}

// Cells of 2 x 2 pixels: nothing is interpolated.
Picture read_cells(const std::string &file) {
    const Picture header = read_header(file);
    if (header.traits.format != FileFormat::raw)
        throw Failure(LENSPROF_ERROR_READ, file + ": is not a camera raw file; give one, and its JPEG with --jpeg");
    const uint32_t longer = std::max(header.width, header.height);
    if (std::min(header.width, header.height) < 2 * LENSPROF_RENDERING_RAW_SIDE)
        throw Failure(LENSPROF_ERROR_NOT_USABLE,
                      file + format(": %u x %u px are too few; give a larger raw file", header.width, header.height),
                      LENSPROF_REASON_FEW_PAIRS);
    return read_picture(file, {longer / 2});
}

std::string camera_of(const PictureMetadata &metadata) {
    return camera_name(metadata.key.camera_maker, metadata.key.camera_model);
}

void demand_one_camera(const Options &o, const std::vector<PictureMetadata> &metadata) {
    for (size_t i = 1; i < metadata.size(); i++)
        if (camera_of(metadata[i]) != camera_of(metadata[0]))
            throw Failure(LENSPROF_ERROR_ARGUMENT, o.files[i] + ": comes from another camera (" + camera_of(metadata[i])
                                                       + ") than " + o.files[0] + " (" + camera_of(metadata[0])
                                                       + "); give files of one camera");
}

// Picture styles have their own responses; a style that not all files share is not stored in the profile.
void keep_common_style(const std::vector<PictureMetadata> &metadata, lensprof_profile_key &key,
                       const StoreOptions &store) {
    if (!store.style.empty()) return;
    for (const PictureMetadata &m : metadata)
        if (std::string(m.key.style) != key.style) return set_text(key.style, sizeof key.style, "");
}

lensprof_response prior_of(const lensprof_profile_key &key) {
    const uint32_t kind = lensprof_camera_kind_of(&key);
    lensprof_response prior;
    check(lensprof_response_set_typical(
              &prior, kind == LENSPROF_CAMERA_PHONE ? LENSPROF_CAMERA_PHONE : LENSPROF_CAMERA_STILL, nullptr, nullptr),
          "response");
    return prior;
}

int on_progress(double, void *) { return interrupted(); }

using HeldRendering = std::unique_ptr<lensprof_rendering, decltype(&lensprof_rendering_destroy)>;

HeldRendering new_rendering(const lensprof_profile_key &key) {
    const lensprof_response prior = prior_of(key);
    lensprof_rendering *made = nullptr;
    lensprof_error error{};
    check(lensprof_rendering_create(&prior, on_progress, nullptr, &made, &error), "response", &error);
    return {made, lensprof_rendering_destroy};
}

// Failure for pictures that cannot be compared, with what to give instead.
void check_added(lensprof_status status, const ResponseFile &file, const lensprof_error &error) {
    const std::string text = file.rendered_name() + ": " + error.text;
    const char *advice = "; give the camera's JPEG of the same picture with --jpeg";
    switch (status) {
    case LENSPROF_ERROR_SIZE: throw Failure(LENSPROF_ERROR_NOT_USABLE, text + advice, LENSPROF_REASON_FEW_PAIRS);
    case LENSPROF_ERROR_NO_OVERLAP:
        throw Failure(LENSPROF_ERROR_NOT_USABLE, text + advice, LENSPROF_REASON_IMAGE_GROUPS);
    case LENSPROF_ERROR_UNSUPPORTED: throw Failure(LENSPROF_ERROR_NOT_USABLE, text, LENSPROF_REASON_UNDETERMINED);
    default: check(status, file.rendered_name(), &error);
    }
}

void add_files(const Options &o, Progress &progress, lensprof_rendering *rendering, ResponseReport &report,
               Streams &streams) {
    for (size_t i = 0; i < o.files.size(); i++) {
        stop_if_cancelled();
        progress.update("comparing", double(i) / double(o.files.size()));
        ResponseFile file;
        file.file = o.files[i];
        const Picture rendered = read_rendered(o, i, file.rendered, streams), raw = read_cells(o.files[i]);
        if (i > 0 && (raw.layout == LENSPROF_LAYOUT_GREY) != (report.files[0].shot.channels == 1))
            throw Failure(LENSPROF_ERROR_ARGUMENT, o.files[i] + ": is in colour and " + o.files[0]
                                                       + " is grey, or the reverse; give files of one kind");
        const lensprof_image raw_view = raw.view(), rendered_view = rendered.view();
        lensprof_error error{};
        check_added(lensprof_rendering_add(rendering, &raw_view, &rendered_view, &error), file, error);
        lensprof_rendering_shot_init(&file.shot);
        check(lensprof_rendering_shot_at(rendering, static_cast<uint32_t>(i), &file.shot, &error), file.file, &error);
        report.files.push_back(std::move(file));
    }
    progress.clear();
}

void measure(const Options &o, const lensprof_profile_key &key, ResponseReport &report, Streams &streams) {
    Progress progress(streams, o.progress);
    auto clock = std::chrono::steady_clock::now();
    const HeldRendering rendering = new_rendering(key);
    add_files(o, progress, rendering.get(), report, streams);
    report.load_s = lap(clock);
    lensprof_error error{};
    lensprof_rendering_result_init(&report.result);
    const lensprof_status status = lensprof_rendering_fit(rendering.get(), &report.result, &error);
    const bool is_of_shot = error.item.kind == LENSPROF_ITEM_IMAGE && error.item.index < o.files.size();
    if (status != LENSPROF_OK && is_of_shot)
        throw Failure(LENSPROF_ERROR_NOT_USABLE, with_name(error.text, error.item, o.files[error.item.index]),
                      LENSPROF_REASON_FEW_PAIRS);
    check(status, o.files.front(), &error);
    for (uint32_t i = 0; i < report.files.size(); i++)
        check(lensprof_rendering_shot_at(rendering.get(), i, &report.files[i].shot, &error), o.files[i], &error);
    report.verdict = verdict_of(rendering.get(), report.result);
    name_images(o.files, report.verdict);
    report.solve_s = lap(clock);
}

int64_t store(const Options &o, const lensprof_profile_key &key, const ResponseReport &report) {
    auto profile = new_profile();
    profile->key = key;
    profile->response[0] = report.result.response;
    auto &p = profile->provenance;
    p.images = static_cast<uint32_t>(report.files.size());
    p.pairs = report.result.areas;
    p.gamma_sigma = report.result.gamma_sigma;
    p.not_usable = !report.result.usable;
    set_text(p.software, sizeof p.software, std::string("lensprof ") + lensprof_version());
    return store_profile(o.store, *profile, {"response", o.files.front(), report.result.usable != 0});
}

int finish(const Options &o, lensprof_profile_key key, ResponseReport &report, Streams &streams) {
    if (!o.store.processing)
        key.processing = report.result.corrects_falloff ? LENSPROF_PROCESSING_CORRECTED : LENSPROF_PROCESSING_JPEG;
    stop_if_cancelled();
    if ((report.result.usable || o.store.force) && !o.store.no_store) report.profile_id = store(o, key, report);
    if (o.json)
        print_json(response_report_json(report), streams.out);
    else
        print_response_report(report, streams.out);
    if (report.profile_id && !o.json)
        streams.out << "stored    profile " << report.profile_id << " in " << store_path(o.store.db) << ": "
                    << describe_key(key) << "\n";
    Progress events(streams);
    if (report.result.usable) report_findings(report.verdict, o.files.front(), events);
    if (!report.result.usable) print_message(streams, not_usable_text(o.files.front(), report.verdict, o.store));
    return static_cast<int>(report.result.usable ? ExitCode::done : ExitCode::not_usable);
}

int run(const Options &o, Streams &streams) {
    check_options(o);
    std::vector<PictureMetadata> metadata;
    for (const std::string &file : o.files) metadata.push_back(read_metadata(file));
    demand_one_camera(o, metadata);
    Progress events(streams);
    lensprof_profile_key key = camera_key(o.store, metadata[0], o.files[0], events);
    keep_common_style(metadata, key, o.store);
    key.processing = LENSPROF_PROCESSING_JPEG;  // the stored profile describes the rendering, not the raw file
    check_store(o.store);
    ResponseReport report;
    try {
        measure(o, key, report, streams);
    } catch (const Failure &failure) {
        if (o.json && failure.group() == LENSPROF_ERROR_NOT_USABLE) {
            report.verdict.refuse(failure.reason, failure.what());
            report.files.clear();
            print_json(response_report_json(report), streams.out);
        }
        throw;
    }
    return finish(o, key, report, streams);
}

}  // namespace

void declare_response(Command &program) {
    Command command =
        program.add("response", "fit the camera's response to raw files and their JPEGs",
                    "Fits the response of a camera to raw files and the JPEGs that the camera made from them; see "
                    "docs/raw.md for suitable files.");
    auto o = std::make_shared<Options>();
    declare(command, *o);
    command.example("lensprof response IMG_1.NEF");
    command.run([o](Streams &streams) { return run(*o, streams); });
}

}  // namespace lensprof
