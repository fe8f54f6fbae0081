#include "photo/deflicker/long_sequence.hpp"

#include <cmath>

#include "photo/calibration/sequence_fit.hpp"
#include "photo/deflicker/measure.hpp"
#include "photo/scene/static_camera.hpp"

namespace lensprof {
namespace {

constexpr size_t kFitFrames = 12;

MeasuredSequence measure_all(const MeasureOptions &options, FrameSequence &sequence, Events &events) {
    MeasuredSequence measured = measure_frames(options, sequence, events);
    if (!sequence.left_out.empty()) throw Failure(LENSPROF_ERROR_READ, sequence.left_out[0].reason);
    return measured;
}

}  // namespace

LongSequence fit_long_sequence(const std::vector<std::string> &files, const FitOptions &options,
                               const SamplingOptions &pixels, Events &events) {
    FrameSequence sequence;
    for (const std::string &file : files) {
        sequence.frames.emplace_back();
        sequence.frames.back().file = file;
        sequence.frames.back().metadata = read_metadata(file);
        sequence.frames.back().metadata.size = read_size(file);
    }
    MeasuredSequence measured = measure_all({}, sequence, events);
    LongSequence found;
    found.names = frames_of_all_exposures(sequence, measured.frames, kFitFrames);
    Scene scene = static_scene(found.names, true);
    scene.reference = 0;
    found.fitted = fit_sequence(scene, options, pixels, events);
    found.fitted.exposures.assign(files.size(), {NAN, {1.0, 1.0, 1.0}});
    if (!found.fitted.corrects()) return found;
    MeasureOptions with_response;
    with_response.response = found.fitted.result.response;
    measured = measure_all(with_response, sequence, events);
    const uint32_t segment = longest_segment(measured.frames);
    for (size_t i = 0; i < files.size(); i++) {
        const lensprof_deflicker_frame &frame = measured.frames[i];
        found.white_shares.push_back(frame.white_share);
        if (frame.state == LENSPROF_FRAME_LEVELLED && frame.segment == segment)
            found.fitted.exposures[i] = frame.exposure;
    }
    return found;
}

}  // namespace lensprof
