// Levelled copies of the frames of a sequence.
#pragma once

#include <string>
#include <vector>

#include "photo/correct/correction.hpp"
#include "photo/deflicker/measure.hpp"

namespace lensprof {

// A frame and what is done to it.
struct LevelledFrame {
    std::string file;
    lensprof_deflicker_frame measured;
    lensprof_exposure wanted;

    double change_ev() const { return wanted.ev - measured.exposure.ev; }
};

std::vector<LevelledFrame> levelled_frames(const FrameSequence &sequence, const MeasuredSequence &measured,
                                           const std::vector<lensprof_exposure> &wanted);

// The response, with what else differs between this frame and the others.
std::shared_ptr<const lensprof_profile> frame_model(const MeasuredSequence &measured, uint32_t index);

// The copies in `folder`, under the names of the frames. Frames that are not levelled are copied without a change.
std::vector<Correction> levelled_copies(const std::vector<LevelledFrame> &frames, const MeasuredSequence &measured,
                                        const std::string &folder);

// Removes the copies that an earlier run has made of the same frames with the same corrections, and returns their
// number.
size_t remove_finished(std::vector<Correction> &jobs);

}  // namespace lensprof
