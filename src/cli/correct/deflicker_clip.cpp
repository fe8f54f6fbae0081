#include "cli/correct/deflicker_clip.hpp"

#include <algorithm>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "cli/correct/exposure_chart.hpp"
#include "cli/program/exit_code.hpp"
#include "cli/program/progress.hpp"
#include "cli/report/drawing.hpp"
#include "photo/base/format.hpp"
#include "photo/base/output_file.hpp"
#include "photo/deflicker/offsets.hpp"
#include "photo/report/report.hpp"
#include "photo/video/video.hpp"

namespace lensprof {
namespace {

std::string levelled_name(size_t index) { return format("frame_%05zu.png", index + 1); }

void measure_clip(const DeflickerClip &o, const lensprof_response &response, MeasuredSequence &measured,
                  Events &events) {
    VideoReader reader(o.clip);
    measured.deflicker = new_deflicker(o.measure, {response}, {reader.info().width, reader.info().height});
    lensprof_error error{};
    uint32_t count = 0;
    for (VideoFrame frame; reader.next(frame); count++) {
        stop_if_cancelled();
        reader.read(frame.picture);
        lensprof_deflicker_facts facts;
        lensprof_deflicker_facts_init(&facts);
        facts.seconds = frame.seconds;
        const lensprof_image view = frame.picture.view();
        check(lensprof_deflicker_add(measured.deflicker.get(), &view, &facts, &error), o.clip, &error);
        events.update_items("measuring", count, static_cast<uint32_t>(reader.info().frames));
    }
    events.clear();
    if (count < 2)
        throw Failure(LENSPROF_ERROR_NOT_USABLE, o.clip + ": has only one frame; give a clip",
                      LENSPROF_REASON_FEW_PAIRS);
    take_measurement(o.clip, count, measured);
    if (measured.result.moving)
        throw Failure(LENSPROF_ERROR_NOT_USABLE,
                      o.clip
                          + format(": the camera moves by %.1f %% of the frame from frame to frame; use `lensprof "
                                   "calibrate`, which levels frames of a moving camera",
                                   100.0 * measured.result.motion));
}

lensprof_deflicker_target clip_target(const DeflickerClip &o, const MeasuredSequence &measured) {
    lensprof_deflicker_target target;
    lensprof_deflicker_target_init(&target);
    target.window_s = o.window_s;
    if (o.to == "mean") {
        target.to = LENSPROF_TO_MEAN;
    } else if (o.to == "first") {
        target.to = LENSPROF_TO_FRAME;
        target.frame = first_levelled(measured.frames);
    } else if (!o.to.empty() && o.to != "smooth") {
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--to " + o.to + ": frames of a video are levelled to smooth, mean or "
                                                             "first; give one of them");
    }
    return target;
}

void write_levelled(const DeflickerClip &o, const lensprof_response &response, const std::vector<LevelledFrame> &frames,
                    const MeasuredSequence &measured, Events &events) {
    const auto profile = new_profile();
    profile->response[0] = response;
    VideoReader reader(o.clip);
    VideoFrame frame;
    for (uint32_t i = 0; i < frames.size() && reader.next(frame); i++) {
        stop_if_cancelled();
        reader.read(frame.picture);
        check(lensprof_deflicker_shading(measured.deflicker.get(), i, &profile->grid, nullptr), o.clip);
        lensprof_exposure change = frames[i].measured.exposure;
        change.ev -= frames[i].wanted.ev;
        for (size_t c = 0; c < 3; c++) change.white_balance[c] /= frames[i].wanted.white_balance[c];
        const std::string name = (std::filesystem::path(o.folder) / frames[i].file).string();
        lensprof_error error{};
        lensprof_target pixels = frame.picture.target();
        check(lensprof_correct(profile.get(), &change, &pixels, &error), name, &error);
        frame.picture.traits = PictureTraits();
        write_picture(name, frame.picture);
        events.update_items("writing", i, static_cast<uint32_t>(frames.size()));
    }
    events.clear();
}

}  // namespace

int deflicker_clip(const DeflickerClip &o, Streams &streams) {
    Progress events(streams, o.progress);
    if (!o.chart.empty()) check_output_file(o.chart);
    lensprof_response response;
    lensprof_response_set_srgb(&response);
    if (o.measure.response) response = *o.measure.response;
    MeasuredSequence measured;
    measure_clip(o, response, measured, events);
    double window_s = 0.0;
    const auto wanted = measured.curve(clip_target(o, measured), window_s);
    std::vector<LevelledFrame> frames;
    for (size_t i = 0; i < measured.frames.size(); i++)
        frames.push_back({levelled_name(i), measured.frames[i], wanted[i]});
    make_folder(o.folder);
    write_levelled(o, response, frames, measured, events);
    const std::string table = (std::filesystem::path(o.folder) / "exposures.csv").string();
    OutputFiles outputs;
    outputs.add(table, offset_table(frames));
    const std::string title =
        counted(frames.size(), "frame") + " of " + std::filesystem::path(o.clip).filename().string();
    if (!o.chart.empty()) outputs.add(o.chart, exposure_chart(frames, true, title, o.chart));
    outputs.commit();
    const lensprof_deflicker_result &result = measured.result;
    if (o.json)
        print_json({{"schema", json_schema},
                    {"frames", result.frames},
                    {"levelled", result.levelled},
                    {"segments", result.segments},
                    {"flicker_ev", result.flicker},
                    {"tone_error", result.tone_error},
                    {"window_s", window_s},
                    {"written", {o.folder, table}}},
                   streams.out);
    else
        streams.out << counted(result.levelled, "frame") << " levelled\n"
                    << format("flicker   %.4f EV before\n", result.flicker) << "written   " << o.folder << "\n";
    return static_cast<int>(ExitCode::done);
}

}  // namespace lensprof
