// Built instead of video.cpp without libav.
#include "photo/base/failure.hpp"
#include "photo/video/video.hpp"

namespace lensprof {

struct VideoReader::Decoder {
    VideoInfo info;
};

bool can_read_video() { return false; }

VideoReader::VideoReader(const std::string &path) {
    throw Failure(LENSPROF_ERROR_READ,
                  path + ": is a video, and this program was built without libav; make frames of it first, for example "
                         "with `ffmpeg -i FILE -vf fps=2 frame_%04d.png`");
}
VideoReader::~VideoReader() = default;
const VideoInfo &VideoReader::info() const { return decoder_->info; }
bool VideoReader::next(VideoFrame &, bool) { return false; }

}  // namespace lensprof
