// Built instead of video.cpp and tracker.cpp without libav and OpenCV.
#include "photo/base/failure.hpp"
#include "photo/video/tracker.hpp"
#include "photo/video/video.hpp"

namespace lensprof {

struct VideoReader::Decoder {
    VideoInfo info;
};
struct CornerTracker::State {};

bool can_read_video() { return false; }

VideoReader::VideoReader(const std::string &path) {
    throw Failure(LENSPROF_ERROR_READ,
                  path + ": is a video, and this program was built without libav and OpenCV; make frames of it first, "
                         "for example with `ffmpeg -i FILE -vf fps=2 frame_%04d.png`");
}
VideoReader::~VideoReader() = default;
const VideoInfo &VideoReader::info() const { return decoder_->info; }
bool VideoReader::next(VideoFrame &) { return false; }
void VideoReader::read(Picture &) {}

CornerTracker::CornerTracker() = default;
CornerTracker::~CornerTracker() = default;
TrackedFrame CornerTracker::add(const Picture &) {
    throw Failure(LENSPROF_ERROR_READ, "frames of a moving camera need OpenCV, without which this program was built");
}

}  // namespace lensprof
