// The exposures of the frames of a sequence.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <lensprof/deflicker.h>

#include "photo/base/library.hpp"
#include "photo/deflicker/frames.hpp"

namespace lensprof {

struct DeflickerDestroy {
    void operator()(lensprof_deflicker *deflicker) const { lensprof_deflicker_destroy(deflicker); }
};

struct MeasureOptions {
    std::optional<lensprof_response> response;  // of the frames; else chosen
    std::vector<std::string> dbs;               // databases with responses of cameras
    std::vector<uint32_t> region_px;            // left, top, width, height of what is compared; empty: all
    bool rows = false;                          // flicker of lines, too
    uint32_t threads = 0;
};

struct MeasuredSequence {
    std::unique_ptr<lensprof_deflicker, DeflickerDestroy> deflicker;
    lensprof_deflicker_result result{};
    std::shared_ptr<const lensprof_profile> model;  // the response
    std::string response;                           // where it is from
    std::vector<lensprof_deflicker_frame> frames;   // of the sequence

    std::vector<lensprof_exposure> curve(const lensprof_deflicker_target &target, double &window) const;
};

uint32_t first_levelled(const std::vector<lensprof_deflicker_frame> &frames);  // its index

// An object for frames of this size, with the options' region and rows, and one response or three.
std::unique_ptr<lensprof_deflicker, DeflickerDestroy>
new_deflicker(const MeasureOptions &options, const std::vector<lensprof_response> &response, const PictureSize &size);

// Sets result and frames by measuring what was added to the object; `item` is its name in a Failure.
void take_measurement(const std::string &item, size_t count, MeasuredSequence &measured);

// Whether a dozen of these frames, spread over all, show one scene from a camera that did not move; false for fewer.
bool shows_still_camera(const std::vector<Frame> &frames, Events &events);

// The segment with most levelled frames.
uint32_t longest_segment(const std::vector<lensprof_deflicker_frame> &measured);

// Files of up to `most` frames of the longest segment whose exposures are spread evenly over its range.
std::vector<std::string> frames_of_all_exposures(const FrameSequence &sequence,
                                                 const std::vector<lensprof_deflicker_frame> &measured, size_t most);

// Measures all frames; those that cannot be read are left out of the sequence. The response is the given one, linear
// for raw and linear frames, else the first of these that the ratios of dark and bright tones agree with: that of a
// stored profile of the camera, sRGB, and one fitted to frames of different exposures. Failure (not usable) for a
// moving camera, after the first frames.
MeasuredSequence measure_frames(const MeasureOptions &options, FrameSequence &sequence, Events &events);

}  // namespace lensprof
