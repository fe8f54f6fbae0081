// Frames of a moving camera: of a video, or pictures of a folder.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "photo/base/events.hpp"
#include "photo/clip/transforms_file.hpp"
#include "photo/video/video.hpp"

namespace lensprof {

constexpr char pictures_codec[] = "pictures";  // of a folder

class FrameSource {
public:
    virtual ~FrameSource() = default;

    virtual const VideoInfo &info() const = 0;
    virtual std::string name_of(uint64_t number) const = 0;  // for messages, of a frame that was read
    virtual std::vector<std::string> files() const = 0;      // all that are read
    virtual const TransformsFile *transforms() const { return nullptr; }

    // The same frames from their beginning.
    virtual std::unique_ptr<FrameSource> again() const = 0;

    // As in VideoReader.
    virtual bool next(VideoFrame &frame) = 0;
    virtual void read(Picture &picture) = 0;
};

// The video, or the pictures of the folder, `frames_per_s` apart in time: those that its transforms.json lists, in the
// order of read_transforms, or all in it (or in images/ in it) in alphabetical order. Failure as of VideoReader,
// read_picture and read_transforms; Failure (unreadable) for a folder without pictures, and pictures of different
// sizes.
std::unique_ptr<FrameSource> open_frames(const std::string &path, double frames_per_s, Events &events);

}  // namespace lensprof
