// What a video keeps of its source: tags, shape, chapters, and the packets of its other streams.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "photo/base/events.hpp"
#include "photo/video/libav.hpp"

namespace lensprof {

// Tags that hold for a video that is coded again, or all for a copy.
void copy_tags(const AVDictionary *from, AVDictionary **to, bool is_of_copy);

// Rotation, stereo and projection, which belong to the pixels' place, not to their coding.
void copy_shape_data(const AVStream &from, AVStream &to);

// Chapters that begin `later_s` earlier than those of the source.
void copy_chapters(const AVFormatContext &from, AVFormatContext &to, double later_s);

// A suffix that holds more than that of `path`: that of the source, if it is another one.
std::string fitting_suffix(const std::string &source, const std::string &path);

// Copies streams packet by packet.
class StreamCopy {
public:
    // From the file `source` to `path`; `later_s` is subtracted from the times.
    StreamCopy(const std::string &source, const std::string &path, AVFormatContext &from, AVFormatContext &to,
               double later_s, Events &events);

    // The next stream of the source, all of which are added in their order. Of those without a place in the container,
    // data and pictures are noted; Failure (usage) for others.
    void add();

    // The next stream of the source is coded elsewhere.
    void skip() { place_.push_back(-1); }

    // Copies the packets up to a time of the source.
    void until(double seconds);

private:
    int add_copy(unsigned index);
    int add_cover(const AVStream &stream);
    void note_left_out(unsigned index, const std::string &what);

    std::string source_, path_;
    AVFormatContext &from_, &to_;
    double later_s_;
    Events &events_;
    std::vector<int> place_;  // in the output, for each stream of the source; -1: none
    Libav<AVPacket> packet_{av_packet_alloc()};
    bool is_held_ = false, is_done_ = false;  // packet_ holds the next packet; all were copied
};

}  // namespace lensprof
