// Built instead of video.cpp, video_writer.cpp, tracker.cpp and what these use, without libav and OpenCV.
#include "photo/base/failure.hpp"
#include "photo/video/tracker.hpp"
#include "photo/video/video_writer.hpp"

namespace lensprof {

struct VideoReader::Decoder {
    VideoInfo info;
};
struct VideoWriter::Encoder {};
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

bool is_video_codec(const std::string &) { return false; }
int worst_quality(const std::string &) { return -1; }

VideoWriter::VideoWriter(const std::string &, const std::string &path, const VideoCodec &, Events &) {
    throw Failure(LENSPROF_ERROR_WRITE, path + ": videos are written with libav, without which this program was built; "
                                               "give the name of a folder");
}
VideoWriter::~VideoWriter() = default;
void VideoWriter::write(const VideoFrame &, size_t) {}
VideoLoss VideoWriter::finish() { return {}; }

CornerTracker::CornerTracker() = default;
CornerTracker::~CornerTracker() = default;
TrackedFrame CornerTracker::add(const Picture &) {
    throw Failure(LENSPROF_ERROR_READ, "frames of a moving camera need OpenCV, without which this program was built");
}

}  // namespace lensprof
