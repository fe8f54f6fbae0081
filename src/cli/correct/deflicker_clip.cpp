#include "cli/correct/deflicker_clip.hpp"

#include <algorithm>
#include <filesystem>

#include "photo/base/format.hpp"
#include "photo/base/memory_file.hpp"
#include "photo/clip/camera_motion.hpp"
#include "photo/video/video.hpp"

namespace lensprof {
namespace {

constexpr double fitting_tone_error = 0.03;  // of a response that fits
constexpr size_t most_compared = 16;         // frames that choose the response

[[noreturn]] void fail_moving_clip(const std::string &clip, double motion) {
    throw Failure(LENSPROF_ERROR_NOT_USABLE,
                  clip
                      + format(": the camera moves by %.1f %% of the frame from frame to frame; use `lensprof "
                               "calibrate`, which levels frames of a moving camera",
                               100.0 * motion));
}

// Frames that move little from one to the next are followed, but what falls off towards the corners moves over them.
void check_motion(const std::string &clip, const CameraMotion &motion, Events &events) {
    constexpr double most_per_frame = 0.01, much_travel = 0.1;
    if (motion.per_frame() > most_per_frame) fail_moving_clip(clip, motion.per_frame());
    if (motion.travel() > much_travel)
        events.warn(clip,
                    format("the camera moves by %.0f %% of the frame in the first seconds; its falloff stays in the "
                           "frames, and its exposures are less exact than those of `lensprof calibrate`, which "
                           "measures both for a moving camera",
                           100.0 * motion.travel()));
}

void check_clip_region(const MeasureOptions &o, const std::string &clip, const VideoInfo &info) {
    const auto &region = o.region_px;
    if (!region.empty() && (region[0] >= info.width || region[1] >= info.height))
        throw Failure(LENSPROF_ERROR_ARGUMENT, clip
                                                   + format(": its frames have %u x %u pixels, but the region begins "
                                                            "at %u, %u; give one within them",
                                                            info.width, info.height, region[0], region[1]));
}

// Measures the clip with a response, and lists its frames if `sequence` is empty.
MeasuredSequence measure_with_response(const std::string &clip, const MeasureOptions &o,
                                       const std::shared_ptr<const lensprof_profile> &model, const ClipOutput &output,
                                       FrameSequence &sequence, Events &events) {
    VideoReader reader(clip);
    const VideoInfo &info = reader.info();
    check_clip_region(o, clip, info);
    MeasuredSequence measured;
    measured.model = model;
    const std::vector<lensprof_response> response(model->response, model->response + model->responses);
    measured.deflicker = new_deflicker(o, response, {info.width, info.height});
    lensprof_error error{};
    uint32_t count = 0;
    CameraMotion motion;
    const bool is_first_look = sequence.frames.empty();
    for (VideoFrame frame; reader.next(frame); count++) {
        stop_if_cancelled();
        reader.read(frame.picture);
        if (is_first_look && !motion.is_known()) {
            motion.add(frame.picture, frame.seconds);
            if (motion.is_known()) check_motion(clip, motion, events);
        }
        lensprof_deflicker_facts facts;
        lensprof_deflicker_facts_init(&facts);
        facts.seconds = frame.seconds;
        const lensprof_image view = frame.picture.view();
        check(lensprof_deflicker_add(measured.deflicker.get(), &view, &facts, &error), clip, &error);
        events.update_items("measuring", count, static_cast<uint32_t>(info.frames));
        if (sequence.frames.size() <= count) sequence.frames.push_back({output.name_of(count), {}, frame.seconds});
    }
    events.clear();
    if (count < 2)
        throw Failure(LENSPROF_ERROR_NOT_USABLE, clip + ": has only one frame; give a clip", LENSPROF_REASON_FEW_PAIRS);
    if (is_first_look && !motion.is_known()) check_motion(clip, motion, events);
    take_measurement(clip, count, measured);
    if (measured.result.moving) fail_moving_clip(clip, measured.result.motion);
    return measured;
}

// The measurement of frames of all exposures, with the response that fits them.
MeasuredSequence measure_some(const std::string &clip, const MeasureOptions &o, const FrameSequence &sequence,
                              const MeasuredSequence &measured, Events &events) {
    const auto names = frames_of_all_exposures(sequence, measured.frames, most_compared);
    const TemporaryFolder folder;
    FrameSequence some;
    VideoReader reader(clip);
    const VideoInfo &info = reader.info();
    for (VideoFrame frame; reader.next(frame);) {
        stop_if_cancelled();
        const std::string &name = sequence.frames.at(frame.number).file;
        if (std::find(names.begin(), names.end(), name) == names.end()) continue;
        reader.read(frame.picture);
        frame.picture.traits = PictureTraits();
        const std::string file =
            (std::filesystem::path(folder.path()) / std::filesystem::path(name).stem()).string() + ".png";
        write_picture(file, frame.picture);
        PictureMetadata metadata = read_metadata(file);
        metadata.size = {info.width, info.height};
        set_text(metadata.key.camera_maker, sizeof metadata.key.camera_maker, info.camera_maker);
        set_text(metadata.key.camera_model, sizeof metadata.key.camera_model, info.camera_model);
        metadata.key.processing = LENSPROF_PROCESSING_JPEG;
        some.frames.push_back({file, metadata});
    }
    return measure_frames(o, some, events);
}

}  // namespace

MeasuredSequence measure_clip(const std::string &clip, const MeasureOptions &options, const ClipOutput &output,
                              FrameSequence &sequence, Events &events) {
    auto model = std::shared_ptr<lensprof_profile>(new_profile());
    lensprof_response_set_srgb(&model->response[0]);
    if (options.response) model->response[0] = *options.response;
    MeasuredSequence measured = measure_with_response(clip, options, model, output, sequence, events);
    measured.response = options.response ? "given response" : "sRGB";
    if (options.response || measured.result.tone_error <= fitting_tone_error) return measured;
    try {
        const MeasuredSequence some = measure_some(clip, options, sequence, measured, events);
        if (some.response == measured.response) return measured;
        MeasuredSequence better = measure_with_response(clip, options, some.model, output, sequence, events);
        better.response = some.response;
        if (better.result.tone_error < measured.result.tone_error) return better;
    } catch (const Failure &failure) {
        if (!is_of_input(failure)) throw;
    }
    return measured;
}

void write_levelled_clip(const std::string &clip, const std::vector<LevelledFrame> &frames,
                         const MeasuredSequence &measured, ClipOutput &output, Events &events) {
    VideoReader reader(clip);
    VideoFrame frame;
    for (uint32_t i = 0; i < frames.size() && reader.next(frame); i++) {
        stop_if_cancelled();
        reader.read(frame.picture);
        output.write_levelled(i, frames.size(), *frame_model(measured, i), frames[i].measured.exposure,
                              frames[i].wanted, frame);
        events.update_items("writing", i, static_cast<uint32_t>(frames.size()));
    }
    events.clear();
    output.finish();
}

}  // namespace lensprof
