// Videos with the frames of another one, changed (libavformat, libavcodec, libswscale).
#pragma once

#include <memory>
#include <string>

#include "photo/base/events.hpp"
#include "photo/video/video.hpp"

namespace lensprof {

// How pixels are coded.
struct VideoCodec {
    std::string name;  // h264, h265, vp9 or ffv1; empty: VP9 for .webm, else H.264, or HEVC for more than 8 bits
    int quality = -1;  // crf of the encoder; -1: 16, or 20 of VP9
};

// The decoded video against the frames that were written, in levels of 255: mean absolute differences over all of
// some frames, and over that which differs most.
struct VideoLoss {
    std::string codec, pixels;  // "libx264", "yuv420p"
    double mean = 0.0, largest = 0.0;
};

// Whether a file of this name is written as a video: .mp4, .mov, .mkv or .webm. Failure (usage) for names of other
// videos.
bool is_video_name(const std::string &path);

// Whether `name` is one of VideoCodec.
bool is_video_codec(const std::string &name);

// The largest number of such a codec's quality; -1: it is lossless.
int worst_quality(const std::string &codec);

// Codes the frames of a video again, with its time stamps, rotation, shape of pixels, colour tags, metadata and
// chapters. Its other streams are copied packet by packet; those that do not fit the container are noted if they are
// data, and otherwise refused. The depth and the sampling of colours are kept where the encoder has them. Everything is
// opened and checked in the constructor, so that it fails before long computations: Failure (usage) for a name, codec
// or stream that do not fit each other, and an encoder that is not installed. Nothing exists at `path` before
// finish(). The same bytes for any number of processors.
class VideoWriter {
public:
    VideoWriter(const std::string &source, const std::string &path, const VideoCodec &codec, Events &events);
    ~VideoWriter();
    VideoWriter(const VideoWriter &) = delete;
    VideoWriter &operator=(const VideoWriter &) = delete;

    // The next frame of the source, with its pixels as VideoReader gives them, changed. `frames`: about how many there
    // are in all.
    void write(const VideoFrame &frame, size_t frames);

    // Completes the file, decodes it to measure the loss, and renames it to its name.
    VideoLoss finish();

private:
    struct Encoder;
    std::unique_ptr<Encoder> encoder_;
};

}  // namespace lensprof
