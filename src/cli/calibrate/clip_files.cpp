#include "cli/calibrate/clip_files.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "cli/correct/exposure_chart.hpp"
#include "cli/profiles/foreign_file.hpp"
#include "photo/base/failure.hpp"
#include "photo/base/format.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/library.hpp"
#include "photo/base/paths.hpp"

namespace lensprof {
namespace {

constexpr char response_name[] = "pcalib.txt", falloff_name[] = "vignette.png", times_name[] = "times.txt",
               table_name[] = "exposures.csv", list_name[] = "exposures.json", chart_name[] = "exposures.svg";
constexpr char table_header[] = "frame,seconds,state,segment,ev,ev_sigma,red,blue,keyframe,repeats,points,mean_level\n";

std::string path_in(const std::string &folder, const std::string &name) {
    return (std::filesystem::path(folder) / name).string();
}

std::vector<LevelledFrame> charted(const ClipTracks &clip) {
    std::vector<LevelledFrame> frames;
    for (const ClipFrame &frame : clip.frames) {
        LevelledFrame charted{};
        lensprof_deflicker_frame_init(&charted.measured);
        lensprof_exposure_init(&charted.wanted);
        charted.measured.state =
            frame.state == ClipState::measured ? LENSPROF_FRAME_LEVELLED : LENSPROF_FRAME_DISAGREES;
        charted.measured.segment = frame.segment, charted.measured.seconds = frame.seconds;
        charted.measured.exposure = frame.exposure;
        frames.push_back(charted);
    }
    return frames;
}

// Without the exposure where it is not measured.
std::string times_text(const ClipTracks &clip, double offset_ev) {
    std::string text;
    for (size_t i = 0; i < clip.frames.size(); i++) {
        const ClipFrame &frame = clip.frames[i];
        text += format("%05zu %.6f", i + 1, frame.seconds);
        if (frame.state == ClipState::measured) text += format(" %.6g", std::exp2(frame.exposure.ev + offset_ev));
        text += "\n";
    }
    return text;
}

std::string exposure_table(const ClipTracks &clip) {
    std::string text = table_header;
    for (size_t i = 0; i < clip.frames.size(); i++) {
        const ClipFrame &frame = clip.frames[i];
        text += format("%zu,%.6f,%s,%u,", i + 1, frame.seconds, clip_state_name(frame.state), frame.segment);
        if (frame.state == ClipState::measured)
            text += format("%.5f,%.5f,%.5f,%.5f", frame.exposure.ev, frame.ev_sigma, frame.exposure.white_balance[0],
                           frame.exposure.white_balance[2]);
        else
            text += ",,,";
        text += format(",%d,%d,%u,%.2f\n", frame.is_keyframe, frame.repeats, frame.observation_count, frame.mean_level);
    }
    return text;
}

}  // namespace

std::vector<std::string> clip_files(const std::string &folder) {
    std::vector<std::string> files;
    for (const char *name : {response_name, falloff_name, times_name, table_name, list_name, chart_name})
        files.push_back(path_in(folder, name));
    return files;
}

bool has_clip_files(const std::string &folder) {
    const std::string table = path_in(folder, table_name);
    return is_regular_file(table) && read_head(table, sizeof table_header - 1) == table_header;
}

Json clip_frames_json(const ClipTracks &clip) {
    Json frames = Json::array();
    for (const ClipFrame &frame : clip.frames)
        frames.push_back({{"seconds", frame.seconds},
                          {"state", clip_state_name(frame.state)},
                          {"segment", frame.segment},
                          {"ev", number_or_null(frame.exposure.ev)},
                          {"ev_sigma", frame.ev_sigma},
                          {"white_balance", frame.exposure.white_balance},
                          {"keyframe", frame.is_keyframe},
                          {"repeats", frame.repeats}});
    return frames;
}

const char *clip_state_name(ClipState state) {
    return state == ClipState::measured ? "measured" : state == ClipState::blank ? "blank" : "unlinked";
}

GivenTimes::GivenTimes(const std::string &path, const FrameSource &source, bool uses_all_frames)
    : path_(path), uses_all_frames_(uses_all_frames) {
    if (path.empty()) return;
    lines_ = read_times_lines(path);
    const VideoInfo &info = source.info();
    const bool is_of_pictures = info.codec == pictures_codec;
    if (is_of_pictures) {
        std::vector<std::string> files;
        for (uint64_t number = 0; number < info.frames; number++) files.push_back(source.name_of(number));
        lines_ = lines_of_files(lines_, files);
    }
    // Containers may count frames that are not shown.
    const double tolerance = is_of_pictures ? 0.0 : 10.0 + 0.05 * double(info.frames);
    if (uses_all_frames && info.frames > 0 && std::abs(double(lines_.size()) - double(info.frames)) > tolerance)
        fail_count(info.frames);
}

void GivenTimes::fail_count(uint64_t frames) const {
    throw Failure(LENSPROF_ERROR_READ, path_
                                           + format(": has %zu lines, but the clip has %llu frames; give a line for "
                                                    "each frame",
                                                    lines_.size(), static_cast<unsigned long long>(frames)));
}

// The time stamps of lines and of a video span the same time, in seconds, milliseconds, microseconds or nanoseconds.
void GivenTimes::check_time_stamps(const ClipTracks &clip) const {
    const double stated = lines_.back().time_stamp - lines_.front().time_stamp,
                 seen_s = clip.frames.back().seconds - clip.frames.front().seconds;
    for (const double unit : {1.0, 1e3, 1e6, 1e9})
        if (std::abs(stated / unit - seen_s) < 0.1 * seen_s) return;
    throw Failure(
        LENSPROF_ERROR_READ,
        path_
            + format(": its time stamps span %.6g, but the frames of %s %.6g s; give the file that belongs to "
                     "the clip, or the clip's own time stamps",
                     stated, clip.path.c_str(), seen_s));
}

std::vector<double> GivenTimes::of(const ClipTracks &clip) const {
    if (lines_.empty()) return {};
    const bool are_of_all = lines_.size() == clip.frames_in_clip;
    if (!are_of_all && lines_.size() != clip.frames.size()) fail_count(clip.frames_in_clip);
    if (are_of_all && clip.frames.size() == clip.frames_in_clip && !is_folder(clip.path)) check_time_stamps(clip);
    std::vector<double> known_ev;
    for (size_t i = 0; i < clip.frames.size(); i++)
        known_ev.push_back(lines_[are_of_all ? clip.frames[i].number : i].ev);
    if (std::none_of(known_ev.begin(), known_ev.end(), [](double ev) { return std::isfinite(ev); })) return {};
    return known_ev;
}

std::vector<double> GivenTimes::of_first(const ClipTracks &clip) const {
    std::vector<double> known_ev;
    for (const ClipFrame &frame : clip.frames)
        if (uses_all_frames_ && frame.number < lines_.size()) known_ev.push_back(lines_[frame.number].ev);
    return known_ev;
}

double GivenTimes::range_ev() const {
    double low = INFINITY, high = -INFINITY;
    for (const TimesLine &line : lines_)
        if (std::isfinite(line.ev)) low = std::min(low, line.ev), high = std::max(high, line.ev);
    return std::max(0.0, high - low);
}

std::vector<std::string> write_model(const ClipFit &fit, const ClipTracks &clip, const std::string &folder,
                                     OutputFiles &outputs) {
    const auto profile = fit.profile();
    const std::string response = path_in(folder, response_name), falloff = path_in(folder, falloff_name);
    lensprof_export_options options;
    lensprof_export_options_init(&options);
    options.format = LENSPROF_FORMAT_PCALIB;
    outputs.add(response, exported(response, {profile.get()}, options));
    ForeignOptions map;
    map.width = clip.info.width, map.height = clip.info.height;
    write_foreign(format_to_write(falloff, ""), outputs.temporary_for(falloff), map, {profile.get()}, {});
    return {response, falloff};
}

std::vector<std::string> write_exposures(const ClipTracks &clip, double offset_ev, const std::string &folder,
                                         OutputFiles &outputs) {
    const std::string times = path_in(folder, times_name), table = path_in(folder, table_name),
                      list = path_in(folder, list_name), chart = path_in(folder, chart_name);
    outputs.add(times, times_text(clip, offset_ev));
    outputs.add(table, exposure_table(clip));
    outputs.add(list, Json{{"schema", json_schema}, {"frames", clip_frames_json(clip)}}.dump(1) + "\n");
    const std::string title =
        counted(clip.frames.size(), "frame") + " of " + std::filesystem::path(clip.path).filename().string();
    outputs.add(chart, exposure_chart(charted(clip), true, title, chart, ChartOf::exposures));
    return {times, table, list, chart};
}

}  // namespace lensprof
