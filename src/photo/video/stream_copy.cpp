#include "photo/video/stream_copy.hpp"

#include <algorithm>
#include <cmath>
#include <new>

#include "photo/base/failure.hpp"
#include "photo/base/format.hpp"
#include "photo/base/paths.hpp"

namespace lensprof {
namespace {

// Tags that the writer of the container sets, or that describe the coding of the source.
bool is_of_coding(const std::string &key) {
    for (const char *name : {"major_brand", "minor_version", "compatible_brands", "encoder", "ENCODER", "rotate",
                             "DURATION", "BPS", "vendor_id"})
        if (key == name) return true;
    for (const char *prefix : {"_STATISTICS", "BPS-", "DURATION-", "NUMBER_OF_"})
        if (key.rfind(prefix, 0) == 0) return true;
    return false;
}

const char *kind_of(const AVStream &stream) {
    switch (stream.codecpar->codec_type) {
    case AVMEDIA_TYPE_AUDIO: return "sound";
    case AVMEDIA_TYPE_SUBTITLE: return "subtitles";
    case AVMEDIA_TYPE_VIDEO: return stream.disposition & AV_DISPOSITION_ATTACHED_PIC ? "picture" : "second video";
    case AVMEDIA_TYPE_ATTACHMENT: return "attachment";
    default: return "data";
    }
}

bool is_cover(const AVStream &stream) {
    return stream.codecpar->codec_type == AVMEDIA_TYPE_VIDEO && (stream.disposition & AV_DISPOSITION_ATTACHED_PIC);
}

// "sound (aac)"
std::string name_of_stream(const AVStream &stream) {
    const AVCodecID codec = stream.codecpar->codec_id;
    return kind_of(stream) + (codec == AV_CODEC_ID_NONE ? "" : std::string(" (") + avcodec_get_name(codec) + ")");
}

}  // namespace

void copy_shape_data(const AVStream &from, AVStream &to) {
    for (const AVPacketSideDataType type : {AV_PKT_DATA_DISPLAYMATRIX, AV_PKT_DATA_STEREO3D, AV_PKT_DATA_SPHERICAL}) {
#if LIBAVFORMAT_VERSION_INT >= AV_VERSION_INT(60, 15, 100)
        const AVPacketSideData *data =
            av_packet_side_data_get(from.codecpar->coded_side_data, from.codecpar->nb_coded_side_data, type);
        if (!data) continue;
        AVPacketSideData *copy = av_packet_side_data_new(&to.codecpar->coded_side_data,
                                                         &to.codecpar->nb_coded_side_data, type, data->size, 0);
        if (!copy) throw std::bad_alloc();
        std::copy_n(data->data, data->size, copy->data);
#else
        size_t size = 0;
        const uint8_t *data = av_stream_get_side_data(&from, type, &size);
        if (!data) continue;
        uint8_t *copy = av_stream_new_side_data(&to, type, size);
        if (!copy) throw std::bad_alloc();
        std::copy_n(data, size, copy);
#endif
    }
}

void copy_tags(const AVDictionary *from, AVDictionary **to, bool is_of_copy) {
    const AVDictionaryEntry *entry = nullptr;
    while ((entry = av_dict_get(from, "", entry, AV_DICT_IGNORE_SUFFIX)))
        if (is_of_copy || !is_of_coding(entry->key)) av_dict_set(to, entry->key, entry->value, 0);
}

void copy_chapters(const AVFormatContext &from, AVFormatContext &to, double later_s) {
    if (from.nb_chapters == 0) return;
    to.chapters = static_cast<AVChapter **>(av_calloc(from.nb_chapters, sizeof(AVChapter *)));
    if (!to.chapters) throw std::bad_alloc();
    for (unsigned i = 0; i < from.nb_chapters; i++) {
        auto *chapter = static_cast<AVChapter *>(av_mallocz(sizeof(AVChapter)));
        if (!chapter) throw std::bad_alloc();
        chapter->id = from.chapters[i]->id, chapter->time_base = from.chapters[i]->time_base;
        const auto later = static_cast<int64_t>(std::llround(later_s / av_q2d(chapter->time_base)));
        chapter->start = from.chapters[i]->start - later, chapter->end = from.chapters[i]->end - later;
        to.chapters[to.nb_chapters++] = chapter;
        copy_tags(from.chapters[i]->metadata, &chapter->metadata, true);
    }
}

std::string fitting_suffix(const std::string &source, const std::string &path) {
    const std::string suffix = lowercase_extension(source), present = lowercase_extension(path);
    if (suffix != present && (suffix == "mp4" || suffix == "mov")) return suffix;
    return present == "mkv" ? "mov" : "mkv";
}

StreamCopy::StreamCopy(const std::string &source, const std::string &path, AVFormatContext &from, AVFormatContext &to,
                       double later_s, Events &events)
    : source_(source), path_(path), from_(from), to_(to), later_s_(later_s), events_(events) {
    if (!packet_) throw std::bad_alloc();
}

void StreamCopy::note_left_out(unsigned index, const std::string &what) {
    events_.note(source_, format("stream %u, ", index) + what + ", is left out, because " + path_ + " cannot hold it");
}

// A cover in Matroska is an attached file; a stream of packets would be a second video.
int StreamCopy::add_cover(const AVStream &stream) {
    const bool is_png = stream.codecpar->codec_id == AV_CODEC_ID_PNG;
    const AVPacket &picture = stream.attached_pic;
    AVStream *file = avformat_new_stream(&to_, nullptr);
    if (!file) throw std::bad_alloc();
    AVCodecParameters &attached = *file->codecpar;
    attached.codec_type = AVMEDIA_TYPE_ATTACHMENT, attached.codec_id = stream.codecpar->codec_id;
    attached.extradata =
        static_cast<uint8_t *>(av_mallocz(static_cast<size_t>(picture.size) + AV_INPUT_BUFFER_PADDING_SIZE));
    if (!attached.extradata) throw std::bad_alloc();
    attached.extradata_size = picture.size;
    std::copy_n(picture.data, picture.size, attached.extradata);
    copy_tags(stream.metadata, &file->metadata, true);
    av_dict_set(&file->metadata, "filename", is_png ? "cover.png" : "cover.jpg", AV_DICT_DONT_OVERWRITE);
    av_dict_set(&file->metadata, "mimetype", is_png ? "image/png" : "image/jpeg", AV_DICT_DONT_OVERWRITE);
    return -1;
}

// A copy of another stream; -1 if it has no place in the container and can be left out, or no packets.
int StreamCopy::add_copy(unsigned index) {
    const AVStream &stream = *from_.streams[index];
    const AVCodecParameters &stated = *stream.codecpar;
    const AVMediaType type = stated.codec_type;
    // Titles of chapters and time codes, which libavformat writes with the chapters and tags.
    if (type == AVMEDIA_TYPE_DATA
        && (stated.codec_tag == MKTAG('t', 'e', 'x', 't') || stated.codec_tag == MKTAG('t', 'm', 'c', 'd')))
        return -1;
    const bool is_attachable = stated.codec_id == AV_CODEC_ID_PNG || stated.codec_id == AV_CODEC_ID_MJPEG;
    if (is_cover(stream) && is_attachable && std::string(to_.oformat->name) == "matroska") return add_cover(stream);
    if (avformat_query_codec(to_.oformat, stated.codec_id, FF_COMPLIANCE_NORMAL) != 1) {
        if (type != AVMEDIA_TYPE_DATA && type != AVMEDIA_TYPE_ATTACHMENT && type != AVMEDIA_TYPE_UNKNOWN
            && !is_cover(stream))
            throw Failure(LENSPROF_ERROR_ARGUMENT, path_ + ": a file of this suffix does not hold the "
                                                       + name_of_stream(stream) + " of " + source_
                                                       + "; give a name with ." + fitting_suffix(source_, path_));
        note_left_out(index, name_of_stream(stream));
        return -1;
    }
    AVStream *copy = avformat_new_stream(&to_, nullptr);
    if (!copy || avcodec_parameters_copy(copy->codecpar, &stated) < 0) throw std::bad_alloc();
    const AVCodecTag *const *tags = to_.oformat->codec_tag;
    if (tags && av_codec_get_id(tags, stated.codec_tag) != stated.codec_id && av_codec_get_tag(tags, stated.codec_id))
        copy->codecpar->codec_tag = 0;
    copy->time_base = stream.time_base, copy->disposition = stream.disposition;
    copy->avg_frame_rate = stream.avg_frame_rate, copy->sample_aspect_ratio = stream.sample_aspect_ratio;
    copy_tags(stream.metadata, &copy->metadata, true);
    if (type == AVMEDIA_TYPE_VIDEO) {
        copy_shape_data(stream, *copy);
        if (!is_cover(stream))
            events_.note(source_, format("has a second video, stream %u, which is copied as it is", index));
    }
    return copy->index;
}

void StreamCopy::add() {
    const auto index = static_cast<unsigned>(place_.size());
    place_.push_back(add_copy(index));
    if (place_.back() < 0) from_.streams[index]->discard = AVDISCARD_ALL;
}

void StreamCopy::until(double seconds) {
    while (!is_done_) {
        int code = is_held_ ? 0 : av_read_frame(&from_, packet_.get());
        if (code == AVERROR_EOF) {
            is_done_ = true;
            return;
        }
        if (code < 0)
            throw Failure(LENSPROF_ERROR_READ, source_ + ": its sound or other data cannot be read: "
                                                   + text_of_error(code) + "; copy the file again");
        const auto stream = static_cast<size_t>(packet_->stream_index);
        is_held_ = true;
        const AVRational base = from_.streams[stream]->time_base;
        const int64_t time = packet_->dts != AV_NOPTS_VALUE ? packet_->dts : packet_->pts;
        if (time != AV_NOPTS_VALUE && double(time) * av_q2d(base) > seconds) return;
        is_held_ = false;
        if (stream >= place_.size() || place_[stream] < 0) {
            av_packet_unref(packet_.get());
            continue;
        }
        const auto later = static_cast<int64_t>(std::llround(later_s_ / av_q2d(base)));
        if (packet_->pts != AV_NOPTS_VALUE) packet_->pts -= later;
        if (packet_->dts != AV_NOPTS_VALUE) packet_->dts -= later;
        packet_->stream_index = place_[stream], packet_->pos = -1;
        av_packet_rescale_ts(packet_.get(), base, to_.streams[place_[stream]]->time_base);
        code = av_interleaved_write_frame(&to_, packet_.get());
        if (code < 0) throw Failure(LENSPROF_ERROR_WRITE, path_ + ": cannot be written: " + text_of_error(code));
    }
}

}  // namespace lensprof
