// Where levelled frames of a clip go: pictures in a folder, or a video.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cli/program/options.hpp"
#include "photo/folder/ledger.hpp"
#include "photo/report/report.hpp"
#include "photo/video/video_writer.hpp"

namespace lensprof {

// png or jpeg of a folder, else that of a video; empty: png, or by the name of the video.
using ClipCodec = VideoCodec;

// Declares --codec, for experts.
void declare_codec(Command &command, ClipCodec &codec);

// The number of a frame that is named "12", "frame_00012" or "frame_00012.png", from 1; 0: none.
size_t frame_number(const std::string &word);

// Whether an output of this name is a video, not a folder. Failure as of is_video_name.
bool is_video_output(const std::string &path);

class ClipOutput {
public:
    // Failure before anything is measured: of VideoWriter, and (usage) for an output that would replace the source or
    // one of `inputs`, or, without `overwrite`, a video or frames that exist, unless an interrupted run of the same
    // clip wrote them and nobody changed them: those are kept where they are as they would be written; (failed) for a
    // folder that cannot be written.
    ClipOutput(const std::string &source, const std::string &path, const std::vector<std::string> &inputs,
               const ClipCodec &codec, bool overwrite, Events &events);

    bool is_video() const { return writer_ != nullptr; }
    std::string name_of(size_t index) const;  // "frame_00001.png"; of a video without the suffix

    // Changes the frame in place from the measured to the wanted exposure, without falloff, and writes it.
    void write_levelled(size_t index, size_t count, const lensprof_profile &model, const lensprof_exposure &measured,
                        const lensprof_exposure &wanted, VideoFrame &frame);
    void write_unchanged(size_t index, size_t count, VideoFrame &frame);

    // Frames of an earlier run that this one did not replace are removed.
    void finish();

    Json json() const;         // codec and loss of a video; null for a folder
    std::string text() const;  // the same for people
    const std::string &path() const { return path_; }

private:
    void check_frames(const std::vector<std::string> &inputs, bool overwrite);
    void write_picture_of(size_t index, Picture &picture);

    Events &events_;
    std::string source_, path_, suffix_;
    std::set<std::string> older_;     // frames in the folder that this run has not written
    std::unique_ptr<Ledger> ledger_;  // of frames in a folder; an interrupted run leaves it
    bool is_begun_ = false;
    size_t kept_ = 0;  // frames of an interrupted run
    int quality_;
    std::unique_ptr<VideoWriter> writer_;
    std::optional<VideoLoss> loss_;
};

}  // namespace lensprof
