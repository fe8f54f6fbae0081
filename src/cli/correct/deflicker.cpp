// `lensprof deflicker`: levels the exposure of the frames of a stationary camera over time.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "cli/correct/deflicker_clip.hpp"
#include "cli/correct/exposure_chart.hpp"
#include "cli/correct/model_options.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/database_options.hpp"
#include "cli/program/exit_code.hpp"
#include "cli/program/message.hpp"
#include "cli/program/options.hpp"
#include "cli/program/progress.hpp"
#include "cli/program/response_words.hpp"
#include "cli/report/drawing.hpp"
#include "photo/base/format.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/deflicker/offsets.hpp"
#include "photo/report/report.hpp"
#include "photo/video/video.hpp"

namespace lensprof {
namespace {

enum class Write {
    copies,
    xmp,
    pp3,
    csv
};
const Choices<Write> write_kinds = {
    {"copies", Write::copies}, {"xmp", Write::xmp}, {"pp3", Write::pp3}, {"csv", Write::csv}};

struct DeflickerOptions {
    std::vector<std::string> files;
    std::string output, to, chart;
    bool keep_light = false, json = false, progress = false;
    double window_s = 0.0;
    std::vector<Write> write;
    MeasureOptions measure;
    CorrectionKind kind;
    ClipCodec codec;

    bool is_clip() const { return files.size() == 1 && is_video(files[0]); }
    std::string folder() const { return output.empty() ? "deflickered" : output; }
    bool writes(Write what) const {
        return write.empty() ? what == Write::copies : std::find(write.begin(), write.end(), what) != write.end();
    }
};

// What the frames get.
struct Levels {
    FrameSequence sequence;
    MeasuredSequence measured;
    std::vector<LevelledFrame> frames;
    lensprof_deflicker_target target;
    double window_s = 0.0;
};

void read_region(const std::string &word, std::vector<uint32_t> &region) {
    region.clear();
    for (const std::string &number : elements(word)) region.push_back(count_of(number, 0, picture_max_side));
    if (region.size() != 4 || region[2] == 0 || region[3] == 0)
        throw std::invalid_argument(word + ": is not left,top,width,height in pixels");
}

void declare(Command &command, DeflickerOptions &o) {
    command.files("FILE", o.files, "frames of one stationary camera, a folder of them, or one video");
    command.folder(
        "-o,--output", o.output,
        "folder for the copies and the table; default deflickered. Of xmp and pp3: default next to the frames. Of a "
        "video also a name with .mp4, .mov, .mkv or .webm, for a levelled video");
    declare_codec(command, o.codec);
    command.word(
        "--to", "smooth|mean|first|FRAME|FILE.csv", [&o](const std::string &word) { o.to = word; },
        "exposure of the frames: a smooth curve through their own (smooth, default), their mean, that of the first or of "
        "a frame, or the values of a table (a number or `file,ev` per line, EV relative to the first frame as it is)");
    command.flag(
        "--keep-light", o.keep_light,
        "remove the steps of the camera that EXIF states, and keep the light: dusk becomes dark. Default where "
        "EXIF states different exposures");
    command.number("--window", o.window_s, {1e-3, 1e9, Unit::time_s},
                   "time before and after a frame that shapes the smooth curve, s (frames, if EXIF states no times); "
                   "default: what best predicts frames that are left out, at least 30 frames");
    command.word(
        "--region", "X,Y,WIDTH,HEIGHT", [&o](const std::string &word) { read_region(word, o.measure.region_px); },
        "part of the frames that is compared, in pixels as stored; default all");
    command.list("--write", o.write, write_kinds,
                 "what is written: copies (default), exposures as settings for Lightroom and darktable (xmp) or "
                 "RawTherapee (pp3), or as a table exposures.csv (csv)");
    command.file("--chart", o.chart, "write a chart of the exposures before and after, as .svg or .png");
    command.word(
        "--response", "auto|RESPONSE",
        [&o](const std::string &word) {
            o.measure.response.reset();
            if (word != "auto") o.measure.response = response_of_word(word);
        },
        "response of the frames: auto (default: a stored one, sRGB, or one fitted to the frames, by how ratios of dark "
        "and bright tones agree), srgb, linear, gamma:G, film, emor:a,b,... or a file (pcalib.txt)");
    declare_databases(command, o.measure.dbs, "");
    command.flag("--rows", o.measure.rows, "level lines, too: lamps flicker within a frame at short exposures");
    declare_writing(command, o.kind);
    declare_json(command, o.json);
    declare_progress(command, o.progress);
}

void check_region(const MeasureOptions &measure, const Frame &first) {
    const std::vector<uint32_t> &region = measure.region_px;
    const PictureSize &size = first.metadata.size;
    if (!region.empty() && (region[0] >= size.width || region[1] >= size.height))
        throw Failure(LENSPROF_ERROR_ARGUMENT, format("--region: begins at %u, %u, but the frames have %u x %u pixels",
                                                      region[0], region[1], size.width, size.height));
}

uint32_t frame_named(const std::string &word, const FrameSequence &sequence) {
    for (uint32_t i = 0; i < sequence.frames.size(); i++)
        if (sequence.frames[i].file == word || std::filesystem::path(sequence.frames[i].file).filename() == word)
            return i;
    const size_t number = frame_number(word);  // of a video
    if (number > 0 && number <= sequence.frames.size() && !path_exists(sequence.frames[0].file))
        return static_cast<uint32_t>(number - 1);
    throw Failure(LENSPROF_ERROR_ARGUMENT,
                  "--to " + word + ": is neither smooth, mean, first, a table (.csv) nor the name of a frame");
}

// The target; `curve` must live as long as it.
lensprof_deflicker_target choose_target(const DeflickerOptions &o, const Levels &levels, std::vector<double> &curve) {
    lensprof_deflicker_target target;
    lensprof_deflicker_target_init(&target);
    target.window_s = o.window_s;
    const bool is_known = std::isfinite(levels.measured.result.known_range);
    if (o.keep_light && !is_known)
        throw Failure(
            LENSPROF_ERROR_ARGUMENT,
            levels.sequence.frames[0].file + ": --keep-light needs EXIF exposures of all frames; use --to smooth");
    if (o.keep_light || (o.to.empty() && is_known && levels.sequence.has_exposure_steps())) {
        target.to = LENSPROF_TO_LIGHT;
    } else if (o.to.empty() || o.to == "smooth") {
        target.to = LENSPROF_TO_SMOOTH;
    } else if (o.to == "mean") {
        target.to = LENSPROF_TO_MEAN;
    } else if (lowercase_extension(o.to) == "csv") {
        target.to = LENSPROF_TO_CURVE;
        curve = read_curve(o.to, levels.sequence);
        target.curve = curve.data();
    } else {
        target.to = LENSPROF_TO_FRAME;
        target.frame = o.to == "first" ? first_levelled(levels.measured.frames) : frame_named(o.to, levels.sequence);
        if (levels.measured.frames[target.frame].state != LENSPROF_FRAME_LEVELLED)
            throw Failure(LENSPROF_ERROR_ARGUMENT, "--to " + o.to + ": this frame is "
                                                       + state_name(levels.measured.frames[target.frame].state)
                                                       + "; name another one");
    }
    return target;
}

// Differences of the frames from the mean of their neighbours, EV, and the largest step from frame to frame.
struct Flicker {
    double median = 0.0, largest_step = 0.0;
};

template <class Value>
Flicker flicker_of(const std::vector<LevelledFrame> &frames, const Value &value_of) {
    Flicker flicker;
    std::vector<double> differences;
    const LevelledFrame *last = nullptr, *before_last = nullptr;
    for (const LevelledFrame &frame : frames) {
        if (frame.measured.state != LENSPROF_FRAME_LEVELLED) continue;
        if (last && last->measured.segment != frame.measured.segment) last = before_last = nullptr;
        if (last) flicker.largest_step = std::max(flicker.largest_step, std::abs(value_of(frame) - value_of(*last)));
        if (before_last)
            differences.push_back(std::abs(value_of(*last) - (value_of(frame) + value_of(*before_last)) / 2.0));
        before_last = last, last = &frame;
    }
    if (differences.empty()) return flicker;
    std::nth_element(differences.begin(), differences.begin() + long(differences.size() / 2), differences.end());
    flicker.median = differences[differences.size() / 2];
    return flicker;
}

double before_of(const LevelledFrame &frame) { return frame.measured.exposure.ev; }
double after_of(const LevelledFrame &frame) { return frame.wanted.ev; }

// Names the frames for which `is_one` holds, in one line.
template <class Is>
void name_frames(const Levels &levels, const Is &is_one, const std::string &what, bool warns, Streams &streams) {
    std::vector<uint32_t> numbers;
    std::vector<std::string> names;
    for (const LevelledFrame &frame : levels.frames) {
        if (is_one(frame)) numbers.push_back(static_cast<uint32_t>(names.size()));
        names.push_back(std::filesystem::path(frame.file).filename().string());
    }
    if (numbers.empty()) return;
    const std::string text = what + ": " + listed(numbers, names);
    warns ? warn(streams, text) : note(streams, text);
}

void report_frames(const Levels &levels, bool writes_xmp, Streams &streams) {
    constexpr double clipped = 0.01, darker_ev = -0.1, brighter_ev = 3.0, xmp_ev = 5.0;
    const auto has_state = [](uint32_t state) {
        return [state](const LevelledFrame &frame) { return frame.measured.state == state; };
    };
    if (levels.sequence.is_by_time)
        note(streams, "the frames are in order of the times in EXIF, which is not that of their names");
    if (levels.measured.result.tone_error > 0.1)
        warn(streams, format("ratios of dark and bright tones differ by %.0f %%: the response does not fit the frames; "
                             "give it with --response",
                             100.0 * levels.measured.result.tone_error));
    const auto begins = [&](const LevelledFrame &frame) {
        return frame.measured.state == LENSPROF_FRAME_LEVELLED && &frame != &levels.frames.front()
               && frame.measured.segment > 0 && (&frame)[-1].measured.segment != frame.measured.segment;
    };
    name_frames(levels, begins, "a new scene begins and is levelled apart", false, streams);
    name_frames(levels, has_state(LENSPROF_FRAME_DARK), "left unchanged, too dark to be measured", true, streams);
    name_frames(levels, has_state(LENSPROF_FRAME_WHITE), "left unchanged, too bright to be measured", true, streams);
    name_frames(levels, has_state(LENSPROF_FRAME_DISAGREES), "left unchanged, unlike the frames before and after", true,
                streams);
    name_frames(
        levels, [](const LevelledFrame &frame) { return frame.measured.repeats != 0; },
        "the same picture as the frame before", false, streams);
    name_frames(
        levels, [&](const LevelledFrame &f) { return f.measured.white_share > clipped && f.change_ev() < darker_ev; },
        "clipped highlights become grey, because the frame is darkened", true, streams);
    name_frames(
        levels, [&](const LevelledFrame &f) { return writes_xmp && std::abs(f.change_ev()) > xmp_ev; },
        "changed by more than the 5 EV that Lightroom takes", true, streams);
    name_frames(
        levels, [&](const LevelledFrame &f) { return f.change_ev() > brighter_ev; },
        "more than 3 EV brighter, with the noise of the dark parts", true, streams);
}

// What a stationary camera does not show.
void report_target(const Levels &levels, Streams &streams) {
    const bool is_light = levels.target.to == LENSPROF_TO_LIGHT;
    if (levels.target.to != LENSPROF_TO_SMOOTH && !is_light) return;
    double low = INFINITY, high = -INFINITY;
    for (const LevelledFrame &frame : levels.frames) {
        if (frame.measured.state != LENSPROF_FRAME_LEVELLED) continue;
        low = std::min(low, frame.wanted.ev), high = std::max(high, frame.wanted.ev);
    }
    if (is_light)
        note(streams,
             format("EXIF states exposures %.2f EV apart; without them the light changes by %.2f EV, which the "
                    "frames keep (--to smooth keeps the brightness of the frames)",
                    levels.measured.result.known_range, high - low));
    else
        note(streams,
             "a stationary camera does not show light and exposure apart: changes slower than the window stay, "
             "faster ones go");
}

void write_copies(const DeflickerOptions &o, std::vector<Correction> &jobs, Progress &progress) {
    const size_t finished = o.kind.overwrite ? 0 : remove_finished(jobs);
    if (finished > 0) progress.note(o.folder(), counted(finished, "copy", "copies") + " of an earlier run kept");
    if (jobs.empty()) return;
    make_folder(o.folder());
    const Corrected corrected = write_corrected(jobs, o.kind, nullptr, progress);
    if (!corrected.failed.empty()) throw Failure(corrected.failed[0].failure);
}

// exposures.csv in the folder, or NAME.csv next to a video; empty: not written.
std::string table_name(const DeflickerOptions &o, bool is_to_video) {
    if (!o.writes(Write::csv) && (!o.is_clip() || !o.write.empty() || is_to_video)) return {};
    std::filesystem::path output(o.folder());
    return (is_to_video ? output.replace_extension(".csv") : output / "exposures.csv").string();
}

// Failure before anything is measured, for a chart that would replace an input or cannot be written.
void check_chart(const DeflickerOptions &o, const std::vector<std::string> &reserved) {
    if (o.chart.empty()) return;
    check_not_reserved(o.chart, "chart", reserved);
    if (!is_in_new_folder(o.chart, o.folder())) check_output_file(o.chart);
}

// Failure before anything is measured, for a table that would replace a file which no earlier run wrote.
void check_table(const DeflickerOptions &o, bool is_to_video, std::vector<std::string> reserved) {
    const std::string table = table_name(o, is_to_video);
    if (table.empty()) return;
    if (lowercase_extension(o.to) == "csv") reserved.push_back(o.to);
    reserved.push_back(o.chart);
    check_not_reserved(table, "output", reserved);
    if (path_exists(table) && !o.kind.overwrite && !is_offset_table(table))
        throw Failure(LENSPROF_ERROR_ARGUMENT, table
                                                   + ": exists, and no earlier run wrote it; give the output another "
                                                     "name, or replace it with --overwrite");
}

void write_exposure_files(const DeflickerOptions &o, const Levels &levels, bool is_to_video,
                          std::vector<std::string> &written) {
    for (const auto &[kind, format] : {std::pair{Write::xmp, OffsetFormat::xmp}, {Write::pp3, OffsetFormat::pp3}}) {
        if (!o.writes(kind)) continue;
        if (!o.output.empty()) make_folder(o.output);
        const auto files = write_offsets(levels.frames, format, o.output);
        if (!files.empty()) written.push_back(files[0] + (files.size() > 1 ? " and further" : ""));
    }
    if (const std::string name = table_name(o, is_to_video); !name.empty()) {
        const std::string text = offset_table(levels.frames);
        if (!is_to_video) make_folder(o.folder());
        write_file(name, text.data(), text.size());
        written.push_back(name);
    }
    if (o.chart.empty()) return;
    const std::string of = o.is_clip() ? " of " + std::filesystem::path(o.files[0]).filename().string()
                                       : ", from " + std::filesystem::path(levels.frames[0].file).filename().string();
    const std::string bytes = exposure_chart(levels.frames, std::isfinite(levels.sequence.frames[0].seconds),
                                             counted(levels.frames.size(), "frame") + of, o.chart);
    write_file(o.chart, bytes.data(), bytes.size());
    written.push_back(o.chart);
}

Json report_json(const Levels &levels, const std::vector<std::string> &written) {
    const lensprof_deflicker_result &r = levels.measured.result;
    const Flicker before = flicker_of(levels.frames, before_of), after = flicker_of(levels.frames, after_of);
    Json frames = Json::array(), left_out = Json::array();
    for (const LevelledFrame &frame : levels.frames) {
        const lensprof_deflicker_frame &m = frame.measured;
        frames.push_back({{"file", frame.file},
                          {"seconds", m.seconds},
                          {"state", state_name(m.state)},
                          {"segment", m.segment},
                          {"ev", m.exposure.ev},
                          {"ev_sigma", m.ev_sigma},
                          {"white_balance", m.exposure.white_balance},
                          {"wanted_ev", frame.wanted.ev},
                          {"change_ev", frame.change_ev()},
                          {"agreeing_share", m.agreeing},
                          {"shift", m.shift},
                          {"clipped_share", m.white_share},
                          {"repeats", m.repeats != 0}});
    }
    for (const LeftOutFrame &frame : levels.sequence.left_out)
        left_out.push_back({{"file", frame.file}, {"reason", frame.reason}});
    return {{"schema", json_schema},
            {"response", levels.measured.response},
            {"tone_error", r.tone_error},
            {"window_s", levels.window_s},
            {"flicker_ev", {{"before", before.median}, {"after", after.median}}},
            {"largest_step_ev", {{"before", before.largest_step}, {"after", after.largest_step}}},
            {"segments", r.segments},
            {"frames", frames},
            {"left_out", left_out},
            {"written", written}};
}

void print_summary(const Levels &levels, const std::vector<std::string> &written, Streams &streams) {
    const Flicker before = flicker_of(levels.frames, before_of), after = flicker_of(levels.frames, after_of);
    streams.out << counted(levels.measured.result.levelled, "frame")
                << " levelled; response: " << levels.measured.response << "\n"
                << format("flicker       %.4f EV before, %.4f EV after\n", before.median, after.median)
                << format("largest step  %.4f EV before, %.4f EV after\n", before.largest_step, after.largest_step);
    for (const std::string &name : written) streams.out << "written       " << name << "\n";
}

void print_result(const DeflickerOptions &o, const Levels &levels, const std::vector<std::string> &written,
                  const ClipOutput *clip, Streams &streams) {
    if (o.json) {
        Json json = report_json(levels, written);
        if (clip && clip->is_video()) json["video"] = clip->json();
        print_json(json, streams.out);
        return;
    }
    print_summary(levels, written, streams);
    if (clip) streams.out << clip->text();
}

// Options that a video cannot take.
void check_clip_options(const DeflickerOptions &o) {
    if (o.keep_light)
        throw Failure(
            LENSPROF_ERROR_ARGUMENT,
            o.files[0] + ": --keep-light needs the exposures of the frames, which a video does not state; omit it");
    if (o.writes(Write::xmp) || o.writes(Write::pp3))
        throw Failure(LENSPROF_ERROR_ARGUMENT, o.files[0]
                                                   + ": --write xmp and pp3 are settings of raw files, which a video "
                                                     "does not have; write copies or csv");
}

int run_clip(const DeflickerOptions &o, Streams &streams) {
    check_clip_options(o);
    Progress progress(streams, o.progress);
    const std::string &clip = o.files[0];
    check_chart(o, {clip, o.folder()});
    check_table(o, is_video_output(o.folder()), {clip});
    ClipOutput output(clip, o.folder(), {clip, o.to}, o.codec, o.kind.overwrite || !o.writes(Write::copies), progress);
    Levels levels;
    levels.measured = measure_clip(clip, o.measure, output, levels.sequence, progress);
    std::vector<double> curve;
    levels.target = choose_target(o, levels, curve);
    levels.frames =
        levelled_frames(levels.sequence, levels.measured, levels.measured.curve(levels.target, levels.window_s));
    report_frames(levels, false, streams);
    report_target(levels, streams);
    std::vector<std::string> written;
    if (o.writes(Write::copies)) {
        write_levelled_clip(clip, levels.frames, levels.measured, output, progress);
        written.push_back(o.folder());
    }
    write_exposure_files(o, levels, output.is_video(), written);
    print_result(o, levels, written, &output, streams);
    return static_cast<int>(ExitCode::done);
}

int run_pictures(const DeflickerOptions &o, Streams &streams) {
    if (!o.codec.name.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--codec: is for a video; copies of pictures keep their format, so omit the option");
    if (is_video_output(o.folder()))
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      o.folder() + ": a video is written of a video; give the name of a folder for copies of pictures");
    Progress progress(streams, o.progress);
    Levels levels;
    levels.sequence = list_frames(o.files, o.folder(), progress);
    MeasureOptions measure = o.measure;
    measure.threads = o.kind.threads;
    std::vector<std::string> inputs;
    for (const Frame &frame : levels.sequence.frames) inputs.push_back(frame.file);
    check_region(measure, levels.sequence.frames[0]);
    check_table(o, false, inputs);
    check_chart(o, inputs);
    if (is_folder(o.folder())) remove_stale_temporaries(o.folder());
    levels.measured = measure_frames(measure, levels.sequence, progress);
    std::vector<double> curve;
    levels.target = choose_target(o, levels, curve);
    levels.frames =
        levelled_frames(levels.sequence, levels.measured, levels.measured.curve(levels.target, levels.window_s));
    std::vector<Correction> jobs;
    if (o.writes(Write::copies)) {
        jobs = levelled_copies(levels.frames, levels.measured, o.folder());
        check_targets(jobs, inputs, "");
        check_older_outputs(jobs, o.kind, false);
        std::vector<std::string> copies;
        for (const Correction &job : jobs) copies.push_back(job.target);
        if (!o.chart.empty()) check_not_reserved(o.chart, "chart", copies);
    }
    report_frames(levels, o.writes(Write::xmp), streams);
    report_target(levels, streams);
    std::vector<std::string> written;
    write_copies(o, jobs, progress);
    if (o.writes(Write::copies)) written.push_back(o.folder());
    write_exposure_files(o, levels, false, written);
    progress.clear();
    print_result(o, levels, written, nullptr, streams);
    for (const LeftOutFrame &frame : levels.sequence.left_out) print_message(streams, frame.reason + "; left out");
    return static_cast<int>(levels.sequence.left_out.empty() ? ExitCode::done : ExitCode::unreadable);
}

int run(const DeflickerOptions &o, Streams &streams) {
    if (o.files.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, "no frames to level; give a folder, or at least two frames");
    if (o.keep_light && !o.to.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--keep-light and --to exclude each other: both choose the exposure of "
                      "the frames; give one of them");
    for (const std::string &file : o.files)
        if (o.files.size() > 1 && is_video(file))
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          file + ": is a video, which is levelled alone; give one video, without other inputs");
    if (!o.chart.empty()) check_chart_name(o.chart);
    return o.is_clip() ? run_clip(o, streams) : run_pictures(o, streams);
}

}  // namespace

void declare_deflicker(Command &program) {
    Command command = program.add("deflicker", "level the exposure of the frames of a timelapse",
                                  "Levels exposure and white balance of the frames of a stationary camera to a smooth "
                                  "curve in time.");
    auto o = std::make_shared<DeflickerOptions>();
    o->kind.dither = true;  // flicker of half a level is visible in smooth areas, but rounded away
    declare(command, *o);
    command.footer(
        "Frames are taken in order of their times in EXIF, else of their names. Copies keep format, depth,\n"
        "metadata and colour profile. A run that was interrupted continues with the frames that are missing.\n"
        "Frames that cannot be read, or have another size, are left out and listed; the exit code is 3.");
    command.example("lensprof deflicker frames -o levelled --chart exposures.svg");
    command.run([o](Streams &streams) { return run(*o, streams); });
}

}  // namespace lensprof
