#include "photo/clip/frame_source.hpp"

#include <filesystem>

#include "photo/base/failure.hpp"
#include "photo/base/format.hpp"
#include "photo/base/paths.hpp"
#include "photo/scene/exposure_times.hpp"

namespace lensprof {
namespace {

class VideoFrames : public FrameSource {
public:
    explicit VideoFrames(const std::string &path) : path_(path), reader_(path) {}

    const VideoInfo &info() const override { return reader_.info(); }
    std::string name_of(uint64_t number) const override {
        return path_ + format(": frame %llu", static_cast<unsigned long long>(number + 1));
    }
    std::vector<std::string> files() const override { return {path_}; }
    std::unique_ptr<FrameSource> again() const override { return std::make_unique<VideoFrames>(path_); }
    bool next(VideoFrame &frame) override { return reader_.next(frame); }
    void read(Picture &picture) override { reader_.read(picture); }

private:
    std::string path_;
    VideoReader reader_;
};

class FolderFrames : public FrameSource {
public:
    FolderFrames(const std::string &folder, double frames_per_s, Events &events) : frame_s_(1.0 / frames_per_s) {
        if (has_transforms(folder)) transforms_ = std::make_shared<TransformsFile>(read_transforms(folder));
        files_ = transforms_ ? transforms_->files : find_sweep(folder, events).files;
        if (files_.empty()) throw Failure(LENSPROF_ERROR_READ, folder + ": has no pictures; give a folder with frames");
        if (transforms_ && transforms_->is_sorted)
            events.note(transforms_path(folder),
                        "lists the frames in another order than that of the numbers in their "
                        "names, in which they are read and written");
        const Picture header = read_header(files_[0]);
        if (transforms_) check_stated_size(*transforms_, header.width, header.height);
        const PictureMetadata metadata = read_metadata(files_[0]);
        info_.width = header.width, info_.height = header.height, info_.sample = header.sample;
        info_.orientation = metadata.orientation, info_.codec = pictures_codec;
        info_.camera_maker = metadata.key.camera_maker, info_.camera_model = metadata.key.camera_model;
        info_.frames_per_s = frames_per_s, info_.frames = files_.size();
    }

    const VideoInfo &info() const override { return info_; }
    std::string name_of(uint64_t number) const override { return files_.at(number); }
    const TransformsFile *transforms() const override { return transforms_.get(); }
    std::vector<std::string> files() const override {
        std::vector<std::string> files = files_;
        if (transforms_) files.push_back(transforms_path(transforms_->folder));
        return files;
    }
    std::unique_ptr<FrameSource> again() const override {
        auto source = std::make_unique<FolderFrames>(*this);
        source->next_ = 0;
        return source;
    }

    bool next(VideoFrame &frame) override {
        if (next_ == files_.size()) return false;
        frame.number = next_, frame.seconds = double(next_) * frame_s_;
        next_++;
        return true;
    }

    void read(Picture &picture) override {
        const std::string &file = files_[next_ - 1];
        picture = read_picture(file);
        if (picture.sample == LENSPROF_SAMPLE_F32
            || (picture.layout != LENSPROF_LAYOUT_RGB && picture.layout != LENSPROF_LAYOUT_GREY))
            throw Failure(LENSPROF_ERROR_READ, file + ": frames are RGB or grey without transparency, with 8 or 16 bits; "
                                                      "convert it");
        if (picture.width != info_.width || picture.height != info_.height)
            throw Failure(LENSPROF_ERROR_READ,
                          file
                              + format(": has %u x %u pixels, but %s has %u x %u; leave it out", picture.width,
                                       picture.height, files_[0].c_str(), info_.width, info_.height));
    }

private:
    std::shared_ptr<const TransformsFile> transforms_;  // or null
    std::vector<std::string> files_;
    double frame_s_;
    size_t next_ = 0;
    VideoInfo info_;
};

}  // namespace

std::unique_ptr<FrameSource> open_frames(const std::string &path, double frames_per_s, Events &events) {
    if (is_folder(path)) return std::make_unique<FolderFrames>(path, frames_per_s, events);
    return std::make_unique<VideoFrames>(path);
}

}  // namespace lensprof
