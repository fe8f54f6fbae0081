// Frames of videos, one at a time (libavformat, libavcodec, libswscale).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "photo/pictures/picture.hpp"

namespace lensprof {

// What a video states of itself.
struct VideoInfo {
    uint32_t width = 0, height = 0;  // of the frames, as stored
    uint32_t sample = LENSPROF_SAMPLE_U8;
    uint16_t orientation = 1;  // EXIF orientation that shows the frames upright
    bool is_interlaced = false;
    std::string codec;                       // "h264"
    std::string camera_maker, camera_model;  // as phones state them; empty: not stated
    double frames_per_s = 0.0;               // on average; 0: not stated
    uint64_t frames = 0;                     // 0: not stated
};

// A frame: full-range RGB, as stored (the rotation is kept but not applied); three equal channels if the video is grey.
// 8 bits, or 16 of full scale for sources of more than 8.
struct VideoFrame {
    double seconds = 0.0;               // presentation time since the first frame
    uint64_t number = 0;                // 0 for the first
    double duration_s = 0.0;            // 0: not stated
    std::optional<int64_t> time_stamp;  // as the stream states it, in its time base
    Picture picture;
};

// Whether the program was built with libav.
bool can_read_video();

// Whether the first bytes of a file are those of a video.
bool is_video(const std::string &path);

// Whether a file has the name of a video.
bool has_video_suffix(const std::string &path);

// Decodes a video from its beginning, and holds one frame. The matrix (BT.601, 709, 2020, ...) and the range (limited
// or full) are those that the stream states; without a matrix, BT.709 for frames above 1024 x 576 pixels, else BT.601.
// Grey values stay as rendered: what is known of their transfer function is not applied. All functions throw Failure
// (unreadable) with the file name: for a file without a video or a frame, PQ, HLG and log transfer functions,
// frames that change their size, and a damaged or cut file, with the number of frames before it.
class VideoReader {
public:
    explicit VideoReader(const std::string &path);
    ~VideoReader();
    VideoReader(const VideoReader &) = delete;
    VideoReader &operator=(const VideoReader &) = delete;

    const VideoInfo &info() const;

    // Advances to the next frame, and sets its number and time; false after the last.
    bool next(VideoFrame &frame);

    // The pixels of that frame, into memory that is used again.
    void read(Picture &picture);

private:
    struct Decoder;
    std::unique_ptr<Decoder> decoder_;
};

}  // namespace lensprof
