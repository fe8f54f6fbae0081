// `lensprof calibrate`: finds panoramas, stores profiles, and writes corrected copies and a report into one folder.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>
#include <sstream>
#include <utility>

#include "cli/calibrate/clip.hpp"
#include "cli/calibrate/folder_page.hpp"
#include "cli/calibrate/summary.hpp"
#include "cli/fitting/fit_page.hpp"
#include "cli/page/page.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/exit_code.hpp"
#include "cli/program/message.hpp"
#include "cli/program/options.hpp"
#include "cli/program/progress.hpp"
#include "cli/program/response_words.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/base/utf8.hpp"
#include "photo/folder/calibrate_folder.hpp"
#include "photo/pictures/metadata.hpp"
#include "photo/video/video.hpp"

namespace lensprof {
namespace {

struct CalibrateOptions : FolderOptions {
    std::string report;
    std::string times, frames, to;  // of a clip, as the next three
    ClipCodec codec;
    std::optional<lensprof_response> response;
    std::string response_file;
    double frames_per_s = 0.0;
    bool is_moving = false;
    bool json = false, progress = false;
};

// The part of a panorama in the report, without pictures.
Json page_of_panorama(Calibration &calibration, const std::vector<std::string> &warnings, Events &events) {
    SceneFit &fit = calibration.fit;
    Json page = fit_page_data(
        {fit.report, fit.input, fit.best, fit.input.images, calibration.scene, calibration.metadata, "", "", false},
        events);
    add_fit_verdict(page, fit.report, warnings);
    return page;
}

void declare(Command &command, CalibrateOptions &o) {
    command.files("FILE", o.inputs, "pictures and folders of pictures (with subfolders); or one video");
    command.require("FILE");
    command.folder("-o,--output", o.output, "output folder");
    command.require("--output");
    command.words(
        "--db", "FILE",
        [&o](const std::string &word) {
            o.store.dbs.push_back(word);
            o.store.db = o.store.dbs.front();
        },
        "profile database; repeat to read several, profiles are stored in the first; default lensprof/profiles.db in "
        "$XDG_DATA_HOME or ~/.local/share");
    command.flag("--no-store", o.store.no_store, "do not store profiles");
    command.flag("--one-lens", o.one_lens,
                 "treat the pictures of a panorama as from one camera and lens, regardless "
                 "of their EXIF");
    command.flag("--overwrite", o.overwrite,
                 "replace files in the output folder that calibrate did not write, and levelled frames");
    command.file("--report", o.report,
                 "write a web page with the pictures before and after, charts and reasons: an .html file");
    command.count("--threads", o.threads, 0, 1024, "number of threads that correct pictures; default 0 = all cores");
    command.flag("--moving", o.is_moving, "the folder holds the frames of a moving camera");
    command.number("--fps", o.frames_per_s, {0.01, 1000.0},
                   "frames per second that are used of a video; default all. Of a folder their rate; default 25");
    command.file("--times", o.times, "exposure times of the frames: a file of lines with name, time stamp, exposure");
    command.expert().word(
        "--response", "RESPONSE",
        [&o](const std::string &word) {
            o.response = response_of_word(word);
            o.response_file = is_regular_file(word) ? word : std::string();
        },
        "response of the frames of a video, if it is known: srgb, linear, gamma:G, film, emor:a,b,... or a file "
        "(pcalib.txt); default: fitted");
    command.folder(
        "--frames", o.frames,
        "write levelled frames of a video without falloff into this folder, or as a video: a name with .mp4, "
        ".mov, .mkv or .webm");
    command.word(
        "--to", "mean|first|FRAME", [&o](const std::string &word) { o.to = word; },
        "exposure of the levelled frames: their mean (default), that of the first, or of a frame, by its number");
    declare_codec(command, o.codec);
    declare_json(command, o.json);
    declare_progress(command, o.progress);
    command.footer(
        "Finds all panoramas in the folder, fits them, stores their profiles if usable, and corrects them.\n"
        "Other pictures are corrected with a profile of the databases for their camera, lens and setting, if\n"
        "there is one. The output folder receives a corrected copy of each picture under its own name; per\n"
        "panorama a project (panorama_NAME.pto, for Hugin) and a mosaic before and after\n"
        "(panorama_NAME.jpg); a contact sheet (calibrate_sheet.jpg); and calibrate.json with all numbers and\n"
        "reasons. A second run does only what is missing or has changed, also after an interrupt. Originals\n"
        "are never modified. Of a video, or the frames of a moving camera, the folder receives the\n"
        "response (pcalib.txt), the falloff (vignette.png) and the exposure of every frame (times.txt,\n"
        "exposures.csv, exposures.json, exposures.svg). Exit code 0: something was corrected, and the rest is\n"
        "listed; 4: nothing could be corrected; 3: no picture could be read.");
    command.example("lensprof calibrate holiday -o holiday/calibrated");
}

// Failure for a report that cannot be written, before anything is computed.
void check_report(const CalibrateOptions &o) {
    if (o.report.empty()) return;
    check_page_name(o.report);
    check_not_reserved(o.report, "report", {store_path(o.store.db)});
    if ((canonical_path(o.output) + "/").rfind(canonical_path(o.report) + "/", 0) == 0)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      o.report + ": the output folder has this name; give the report another one");
    if (is_too_long(o.report))
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      short_name(o.report) + ": the name is too long; give the report a shorter one");
    if (!is_in_new_folder(o.report, o.output)) check_output_file(o.report);
}

// Failure for a file with the name of a video that is not a video. Ogg may be sound, which is named elsewhere.
void check_video_name(const std::string &path) {
    if (!path_exists(path) || is_folder(path) || !has_video_suffix(path) || is_video(path)) return;
    if (lowercase_extension(path) == "ogv") return;
    throw Failure(LENSPROF_ERROR_READ, path + ": is not a video, or its beginning is damaged; give an intact file");
}

// Whether the inputs are one clip. Failure (usage) for several clips, and for options of a clip without one.
bool is_clip(const CalibrateOptions &o) {
    const bool is_one = o.inputs.size() == 1;
    for (const std::string &input : o.inputs) {
        check_video_name(input);
        if (!is_video(input) && !is_frame_folder(input) && !(o.is_moving && is_folder(input))) continue;
        if (!is_one)
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          input + ": is a clip, which is calibrated alone; give one clip, without other inputs");
        return true;
    }
    for (const auto &[is_given, name] : {std::pair{o.is_moving, "--moving"},
                                         {o.frames_per_s > 0.0, "--fps"},
                                         {!o.times.empty(), "--times"},
                                         {o.response.has_value(), "--response"},
                                         {!o.frames.empty(), "--frames"},
                                         {!o.to.empty(), "--to"},
                                         {!o.codec.name.empty(), "--codec"}})
        if (is_given)
            throw Failure(
                LENSPROF_ERROR_ARGUMENT,
                std::string(name)
                    + (is_one && is_folder(o.inputs[0])
                           ? ": is for clips; to read " + o.inputs[0] + " as frames of a moving camera, add --moving"
                           : std::string(": is for clips; give one video or one folder of frames, or omit "
                                         "the option")));
    return false;
}

// Pictures without EXIF, numbered one by one, as programs write the frames of a clip.
bool has_frames_of_clip(const std::string &folder) {
    constexpr size_t fewest = 12;
    std::set<std::string> files;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        if (entry->is_regular_file(error)) files.insert(entry->path().string());
    if (files.size() < fewest) return false;
    std::string prefix, suffix;
    long last = -1;
    for (const std::string &file : files) {
        const size_t end = file.find_last_of("0123456789", file.rfind('.')),
                     begin = file.find_last_not_of("0123456789", end);
        if (end == std::string::npos || begin == std::string::npos || end - begin > 9) return false;
        const long number = std::stol(file.substr(begin + 1, end - begin));
        if (last < 0) prefix = file.substr(0, begin + 1), suffix = file.substr(end + 1);
        if (last >= 0 && number != last + 1) return false;
        if (file.substr(0, begin + 1) != prefix || file.substr(end + 1) != suffix) return false;
        last = number;
    }
    try {
        const PictureMetadata metadata = read_metadata(*files.begin());
        return !*metadata.key.camera_model && !metadata.exposure_time_s;
    } catch (const Failure &) {
        return false;
    }
}

int run(CalibrateOptions &o, Streams &streams) {
    const bool is_of_clip = is_clip(o);
    check_report(o);
    if (is_of_clip) {
        if (o.one_lens)
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          "--one-lens: is for pictures, and a clip has one lens; omit the option");
        return calibrate_clip({o.inputs[0], o.output, o.times, o.response, o.response_file, o.frames, o.report, o.to,
                               o.codec, o.frames_per_s, o.store, o.overwrite, o.json, o.progress},
                              streams);
    }
    Progress events(streams, o.progress);
    if (o.inputs.size() == 1 && is_folder(o.inputs[0]) && has_frames_of_clip(o.inputs[0]))
        note(streams, o.inputs[0] + ": has numbered pictures without EXIF; if they are the frames of a moving camera, "
                                    "--moving calibrates them faster and more exactly");
    o.describe = page_of_panorama;
    FolderResult result = calibrate_folder(o, events);
    const auto &[inputs, panoramas, pictures, summary, is_stored] = result;
    events.clear();
    if (!o.report.empty()) {
        const std::string page = folder_page(inputs, panoramas, pictures, summary, command_text(streams.words), events);
        write_file(o.report, page.data(), page.size());
    }
    if (o.json) {
        Json json = summary;
        json["now"] = {
            {"registered", panoramas.is_registered}, {"fitted", panoramas.fitted}, {"corrected", pictures.written}};
        print_json(json, streams.out);
    } else {
        print_summary(o, inputs, panoramas, pictures, streams.out);
        if (!o.report.empty()) streams.out << one_line("report    " + o.report) << "\n";
    }
    if (!pictures.list.empty() || is_stored) return static_cast<int>(ExitCode::done);
    print_message(streams, nothing_corrected(o, inputs));
    return static_cast<int>(ExitCode::not_usable);
}

}  // namespace

void declare_calibrate(Command &program) {
    Command command = program.add("calibrate", "calibrate and correct all pictures of a folder",
                                  "Finds overlaps, fits and stores profiles, corrects the pictures and writes a "
                                  "contact sheet.");
    auto o = std::make_shared<CalibrateOptions>();
    declare(command, *o);
    command.run([o](Streams &streams) { return run(*o, streams); });
}

}  // namespace lensprof
