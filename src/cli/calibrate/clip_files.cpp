#include "cli/calibrate/clip_files.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

#include "cli/correct/exposure_chart.hpp"
#include "cli/profiles/foreign_file.hpp"
#include "photo/base/failure.hpp"
#include "photo/base/format.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/library.hpp"
#include "photo/base/paths.hpp"
#include "photo/clip/frame_source.hpp"

namespace lensprof {
namespace {

std::string path_in(const std::string &folder, const std::string &name) {
    return (std::filesystem::path(folder) / name).string();
}

double number_in(const std::string &word, const std::string &where) {
    double value = NAN;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
        throw Failure(LENSPROF_ERROR_READ, where + ": " + word + " is not a finite number; correct it");
    return value;
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
    std::string text = "frame,seconds,state,segment,ev,ev_sigma,red,blue,keyframe,repeats,points,mean_level\n";
    for (size_t i = 0; i < clip.frames.size(); i++) {
        const ClipFrame &frame = clip.frames[i];
        text += format("%zu,%.6f,%s,%u,", i + 1, frame.seconds, clip_state_name(frame.state), frame.segment);
        if (frame.state == ClipState::measured)
            text += format("%.5f,%.5f,%.5f,%.5f", frame.exposure.ev, frame.ev_sigma, frame.exposure.white_balance[0],
                           frame.exposure.white_balance[2]);
        else
            text += ",,,";
        text +=
            format(",%d,%d,%zu,%.2f\n", frame.is_keyframe, frame.repeats, frame.observations.size(), frame.mean_level);
    }
    return text;
}

}  // namespace

const char *clip_state_name(ClipState state) {
    return state == ClipState::measured ? "measured" : state == ClipState::blank ? "blank" : "unlinked";
}

std::vector<double> read_clip_times(const std::string &path, const ClipTracks &clip) {
    std::istringstream text(read_text(path, max_text_bytes));
    std::vector<double> ev;
    size_t number = 0;
    for (std::string line; std::getline(text, line);) {
        const std::string where = path + ": line " + std::to_string(++number);
        std::istringstream words(line.substr(0, line.find('#')));
        std::vector<std::string> fields;
        for (std::string word; words >> word;) fields.push_back(word);
        if (fields.empty()) continue;
        if (fields.size() < 2 || fields.size() > 3)
            throw Failure(LENSPROF_ERROR_READ, where + ": give name, time stamp and exposure time");
        const double time = fields.size() == 3 ? number_in(fields[2], where) : NAN;
        if (time <= 0.0) throw Failure(LENSPROF_ERROR_READ, where + ": the exposure time must be above 0; correct it");
        ev.push_back(std::log2(time));
    }
    if (ev.size() != clip.frames_in_clip && ev.size() != clip.frames.size())
        throw Failure(LENSPROF_ERROR_READ,
                      path
                          + format(": has %zu lines, but the clip has %llu frames; give a line for "
                                   "each frame",
                                   ev.size(), static_cast<unsigned long long>(clip.frames_in_clip)));
    std::vector<double> of_frames;
    for (size_t i = 0; i < clip.frames.size(); i++)
        of_frames.push_back(ev[ev.size() == clip.frames_in_clip ? clip.frames[i].number : i]);
    return of_frames;
}

double offset_of_times(const ClipTracks &clip, const std::vector<double> &known_ev) {
    std::vector<double> offsets;
    for (size_t i = 0; i < known_ev.size(); i++)
        if (clip.frames[i].state == ClipState::measured && std::isfinite(known_ev[i]))
            offsets.push_back(known_ev[i] - clip.frames[i].exposure.ev);
    if (offsets.empty()) return 0.0;
    const auto middle = offsets.begin() + static_cast<std::ptrdiff_t>(offsets.size() / 2);
    std::nth_element(offsets.begin(), middle, offsets.end());
    return *middle;
}

double error_of_times(const ClipTracks &clip, const std::vector<double> &known_ev) {
    struct Sum {
        double value = 0.0, squares = 0.0, frames = 0.0;
    };
    std::map<uint32_t, Sum> of_segment;
    for (size_t i = 0; i < known_ev.size(); i++) {
        if (clip.frames[i].state != ClipState::measured || std::isnan(known_ev[i])) continue;
        const double difference = known_ev[i] - clip.frames[i].exposure.ev;
        Sum &sum = of_segment[clip.frames[i].segment];
        sum.value += difference, sum.squares += difference * difference, sum.frames++;
    }
    double squares = 0.0, count = 0.0;
    for (const auto &[segment, sum] : of_segment) {
        squares += std::max(0.0, sum.squares - sum.value * sum.value / sum.frames);
        count += sum.frames;
    }
    return count > 0.0 ? std::sqrt(squares / count) : NAN;
}

std::vector<std::string> write_model(const ClipFit &fit, const ClipTracks &clip, const std::string &folder,
                                     OutputFiles &outputs) {
    const auto profile = fit.profile();
    const std::string response = path_in(folder, "pcalib.txt"), falloff = path_in(folder, "vignette.png");
    lensprof_export_options options;
    lensprof_export_options_init(&options);
    options.format = LENSPROF_FORMAT_PCALIB;
    outputs.add(response, exported(response, {profile.get()}, options));
    ForeignOptions map;
    map.width = clip.info.width, map.height = clip.info.height;
    write_foreign(format_to_write(falloff, ""), falloff, map, {profile.get()}, {});
    return {response, falloff};
}

std::vector<std::string> write_exposures(const ClipTracks &clip, double offset_ev, const std::string &folder,
                                         OutputFiles &outputs) {
    const std::string times = path_in(folder, "times.txt"), table = path_in(folder, "exposures.csv"),
                      chart = path_in(folder, "exposures.svg");
    outputs.add(times, times_text(clip, offset_ev));
    outputs.add(table, exposure_table(clip));
    const std::string title =
        counted(clip.frames.size(), "frame") + " of " + std::filesystem::path(clip.path).filename().string();
    outputs.add(chart, exposure_chart(charted(clip), true, title, chart));
    return {times, table, chart};
}

std::vector<lensprof_exposure> wanted_exposures(const std::string &to, const ClipTracks &clip) {
    std::vector<lensprof_exposure> wanted;
    const size_t named = to == "mean" || to == "first" || to.empty() ? 0 : frame_number(to);
    for (const ClipFrame &frame : clip.frames) {
        if (frame.state != ClipState::measured || frame.segment < wanted.size()) continue;
        lensprof_exposure mean;
        lensprof_exposure_init(&mean);
        wanted.resize(frame.segment + 1, mean);
        if (to == "first") wanted.back() = frame.exposure;
    }
    if (named == 0) return wanted;
    if (named > clip.frames.size())
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--to " + to + ": " + clip.path + " has " + counted(clip.frames.size(), "frame"));
    const ClipFrame &frame = clip.frames[named - 1];
    if (frame.state != ClipState::measured)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--to " + to + ": this frame is " + clip_state_name(frame.state) + "; name another one");
    wanted[frame.segment] = frame.exposure;
    return wanted;
}

std::vector<uint32_t> write_levelled_frames(const ClipFit &fit, const ClipTracks &clip,
                                            const std::vector<lensprof_exposure> &wanted, double frames_per_s,
                                            ClipOutput &output, Events &events) {
    const auto profile = fit.profile();
    const auto source = open_frames(clip.path, frames_per_s, events);
    const size_t count = clip.frames.size();
    std::vector<uint32_t> unmeasured;
    size_t done = 0;
    for (VideoFrame frame; done < count && source->next(frame);) {
        const ClipFrame &measured = clip.frames[done];
        if (frame.number != measured.number) continue;
        stop_if_cancelled();
        const size_t index = done++;
        const bool is_measured = measured.state == ClipState::measured;
        if (!is_measured) unmeasured.push_back(static_cast<uint32_t>(index));
        if (!is_measured && !output.is_video()) continue;
        source->read(frame.picture);
        if (is_measured) {
            lensprof_exposure change = measured.exposure;
            change.ev -= wanted[measured.segment].ev;
            for (size_t c = 0; c < 3; c++) change.white_balance[c] /= wanted[measured.segment].white_balance[c];
            output.write_levelled(index, count, *profile, change, frame);
        } else {
            output.write_unchanged(index, count, frame);
        }
        events.update_items("frames", static_cast<uint32_t>(done), static_cast<uint32_t>(count));
    }
    output.finish();
    events.clear();
    return unmeasured;
}

}  // namespace lensprof
