#include "photo/video/video_writer.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <new>
#include <vector>

#include "photo/base/failure.hpp"
#include "photo/base/format.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/video/libav.hpp"

namespace lensprof {
namespace {

constexpr int coding_threads = 4;  // of any machine, because encoders give other bytes for another number

struct Coding {
    const char *name, *encoder;
    int quality, worst_quality;  // crf; -1: lossless
    std::vector<std::pair<const char *, const char *>> options;
};
const Coding codings[] = {
    {"h264", "libx264", 16, 51, {{"preset", "medium"}}},
    {"h265", "libx265", 16, 51, {{"preset", "medium"}, {"x265-params", "log-level=none:frame-threads=2"}}},
    {"vp9", "libvpx-vp9", 20, 63, {{"deadline", "good"}, {"cpu-used", "2"}, {"tile-columns", "2"}, {"row-mt", "1"}}},
    {"ffv1", "ffv1", -1, -1, {{"level", "3"}, {"slices", "4"}, {"slicecrc", "1"}}},
};

const Coding &coding_of(const std::string &name) {
    return *std::find_if(std::begin(codings), std::end(codings), [&](const Coding &c) { return name == c.name; });
}

struct OutputClose {
    void operator()(AVFormatContext *file) const {
        if (file->pb) avio_closep(&file->pb);
        avformat_free_context(file);
    }
};

class Options {
public:
    ~Options() { av_dict_free(&dictionary_); }
    void set(const std::string &key, const std::string &value) {
        av_dict_set(&dictionary_, key.c_str(), value.c_str(), 0);
    }
    AVDictionary **get() { return &dictionary_; }

private:
    AVDictionary *dictionary_ = nullptr;
};

int depth_of(AVPixelFormat format) {
    const auto *described = av_pix_fmt_desc_get(format);
    return described ? described->comp[0].depth : 8;
}

// The same without the range in its name.
AVPixelFormat plain_format(AVPixelFormat format) {
    switch (format) {
    case AV_PIX_FMT_YUVJ420P: return AV_PIX_FMT_YUV420P;
    case AV_PIX_FMT_YUVJ422P: return AV_PIX_FMT_YUV422P;
    case AV_PIX_FMT_YUVJ444P: return AV_PIX_FMT_YUV444P;
    case AV_PIX_FMT_YUVJ440P: return AV_PIX_FMT_YUV440P;
    default: return format;
    }
}

const AVPixelFormat *formats_of(const AVCodec &encoder) {
#if LIBAVCODEC_VERSION_INT >= AV_VERSION_INT(61, 13, 100)
    const void *formats = nullptr;
    avcodec_get_supported_config(nullptr, &encoder, AV_CODEC_CONFIG_PIX_FORMAT, 0, &formats, nullptr);
    return static_cast<const AVPixelFormat *>(formats);
#else
    return encoder.pix_fmts;
#endif
}

// That of the encoder which loses least.
AVPixelFormat nearest_format(const AVCodec &encoder, AVPixelFormat source) {
    const AVPixelFormat wanted = plain_format(source), *formats = formats_of(encoder);
    if (!formats) return wanted;
    const AVPixelFormat nearest = avcodec_find_best_pix_fmt_of_list(formats, wanted, 0, nullptr);
    return nearest == AV_PIX_FMT_NONE ? formats[0] : plain_format(nearest);
}

// What belongs to the pixels' place, not to their coding.
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

// Tags that the writer of the container sets, or that describe the coding of the source.
bool is_of_coding(const std::string &key) {
    for (const char *prefix : {"major_brand", "minor_version", "compatible_brands", "encoder", "ENCODER", "rotate",
                               "DURATION", "BPS", "NUMBER_OF_", "_STATISTICS", "vendor_id"})
        if (key.rfind(prefix, 0) == 0) return true;
    return false;
}

void copy_tags(const AVDictionary *from, AVDictionary **to, bool is_of_copy) {
    const AVDictionaryEntry *entry = nullptr;
    while ((entry = av_dict_get(from, "", entry, AV_DICT_IGNORE_SUFFIX)))
        if (is_of_copy || !is_of_coding(entry->key)) av_dict_set(to, entry->key, entry->value, 0);
}

void copy_chapters(const AVFormatContext &from, AVFormatContext &to) {
    if (from.nb_chapters == 0) return;
    to.chapters = static_cast<AVChapter **>(av_calloc(from.nb_chapters, sizeof(AVChapter *)));
    if (!to.chapters) throw std::bad_alloc();
    for (unsigned i = 0; i < from.nb_chapters; i++) {
        auto *chapter = static_cast<AVChapter *>(av_mallocz(sizeof(AVChapter)));
        if (!chapter) throw std::bad_alloc();
        chapter->id = from.chapters[i]->id, chapter->time_base = from.chapters[i]->time_base;
        chapter->start = from.chapters[i]->start, chapter->end = from.chapters[i]->end;
        to.chapters[to.nb_chapters++] = chapter;
        copy_tags(from.chapters[i]->metadata, &chapter->metadata, true);
    }
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

// Some rows of a frame, to compare with those that the finished video shows.
struct Sampled {
    uint64_t number;
    std::vector<uint8_t> rows;
};

std::vector<uint8_t> sampled_rows(const Picture &picture) {
    constexpr uint32_t step = 16;  // rows
    std::vector<uint8_t> rows;
    for (uint32_t y = step / 2 < picture.height ? step / 2 : 0; y < picture.height; y += step) {
        const uint8_t *row = &picture.pixels[y * picture.row_bytes];
        rows.insert(rows.end(), row, row + picture.row_bytes);
    }
    return rows;
}

double mean_difference(uint32_t sample, const std::vector<uint8_t> &a, const std::vector<uint8_t> &b) {
    const size_t count = a.size() / (sample == LENSPROF_SAMPLE_U16 ? 2 : 1);
    double sum = 0.0;
    for (size_t n = 0; n < count; n++)
        sum += std::abs(sample_value(sample, a.data(), n) - sample_value(sample, b.data(), n));
    return 255.0 * sum / double(count);
}

}  // namespace

struct VideoWriter::Encoder {
    Encoder(const std::string &source, const std::string &path, const VideoCodec &codec, Events &events);

    void write(const VideoFrame &frame, size_t frames);
    VideoLoss finish();

private:
    [[noreturn]] void refuse(const std::string &what) const {
        throw Failure(LENSPROF_ERROR_ARGUMENT, path_ + ": " + what);
    }
    void written(int code) const {
        if (code < 0) throw Failure(LENSPROF_ERROR_WRITE, path_ + ": cannot be written: " + text_of_error(code));
    }
    // That of the source, if it is another one.
    std::string fitting_suffix() const {
        const std::string suffix = lowercase_extension(source_);
        return suffix == lowercase_extension(path_) || (suffix != "mp4" && suffix != "mov") ? "mkv" : suffix;
    }
    void open_source();
    void open_encoder(const VideoCodec &codec);
    void set_colours(AVPixelFormat stored);
    void add_streams();
    bool add_copy(unsigned index);
    void write_header();
    void open_scaler(AVPixelFormat rgb);
    void convert(const Picture &picture, AVFrame &frame);
    void copy_until(double seconds);
    void encode(const AVFrame *frame);
    VideoLoss measured() const;

    std::string source_, path_;
    Events &events_;
    std::unique_ptr<OutputFile> output_;
    Libav<AVFormatContext> from_;
    std::unique_ptr<AVFormatContext, OutputClose> to_;
    Libav<AVCodecContext> codec_;
    Libav<SwsContext> scaler_;
    Libav<AVFrame> padded_;
    Libav<AVPacket> coded_{av_packet_alloc()}, copied_{av_packet_alloc()};
    int stream_ = -1;
    std::vector<int> stream_of_;                     // of the output, for each of the source; -1: none
    bool is_copy_held_ = false, is_copied_ = false;  // copied_ holds the next packet; all were copied
    std::optional<int64_t> last_time_;
    std::map<int64_t, int64_t> durations_;  // by time stamp, of the frames in the encoder
    std::vector<Sampled> sampled_;
    uint32_t sample_ = LENSPROF_SAMPLE_U8;
    uint64_t frames_ = 0;
};

VideoWriter::Encoder::Encoder(const std::string &source, const std::string &path, const VideoCodec &codec,
                              Events &events)
    : source_(source), path_(path), events_(events) {
    const VideoReader readable(source);  // else its failure states why
    if (!coded_ || !copied_) throw std::bad_alloc();
    open_source();
    AVFormatContext *file = nullptr;
    if (avformat_alloc_output_context2(&file, nullptr, nullptr, path.c_str()) < 0)
        refuse("the installed libavformat does not write such files; give a name with another suffix");
    to_.reset(file);
    to_->flags |= AVFMT_FLAG_BITEXACT;
    open_encoder(codec);
    add_streams();
    output_ = std::make_unique<OutputFile>(path);
    write_header();
}

void VideoWriter::Encoder::open_source() {
    AVFormatContext *file = nullptr;
    int code = avformat_open_input(&file, ("file:" + source_).c_str(), nullptr, nullptr);
    from_.reset(file);
    if (code >= 0) code = avformat_find_stream_info(file, nullptr);
    if (code >= 0) code = av_find_best_stream(file, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
    if (code < 0) throw Failure(LENSPROF_ERROR_READ, source_ + ": cannot be opened: " + text_of_error(code));
    stream_ = code;
    file->streams[stream_]->discard = AVDISCARD_ALL;
}

void VideoWriter::Encoder::set_colours(AVPixelFormat stored) {
    const AVCodecParameters &stated = *from_->streams[stream_]->codecpar;
    codec_->color_primaries = stated.color_primaries, codec_->color_trc = stated.color_trc;
    codec_->chroma_sample_location = stated.chroma_location;
    codec_->colorspace = stated.color_space, codec_->color_range = stated.color_range;
    if (is_rgb(codec_->pix_fmt)) {
        codec_->colorspace = AVCOL_SPC_RGB, codec_->color_range = AVCOL_RANGE_JPEG;
    } else if (is_rgb(stored)) {
        codec_->colorspace = AVCOL_SPC_BT709, codec_->color_range = AVCOL_RANGE_MPEG;
    } else if (is_full_range(stated.color_range, stored)) {
        codec_->color_range = AVCOL_RANGE_JPEG;
    }
}

void VideoWriter::Encoder::open_encoder(const VideoCodec &codec) {
    const AVStream &stream = *from_->streams[stream_];
    const AVCodecParameters &stated = *stream.codecpar;
    const auto stored = static_cast<AVPixelFormat>(stated.format);
    const bool is_deep = depth_of(stored) > 8;
    const std::string usual = lowercase_extension(path_) == "webm" ? "vp9" : is_deep ? "h265" : "h264";
    const Coding &coding = coding_of(codec.name.empty() ? usual : codec.name);
    const AVCodec *encoder = avcodec_find_encoder_by_name(coding.encoder);
    if (!encoder)
        refuse(std::string("the installed libavcodec has no encoder ") + coding.encoder
               + "; choose another codec, such as ffv1 for .mkv, or write a folder of pictures");
    if (avformat_query_codec(to_->oformat, encoder->id, FF_COMPLIANCE_NORMAL) != 1)
        refuse(std::string("a file of this suffix does not hold ") + coding.name
               + "; give a name with .mkv, or choose another codec");
    if (codec.quality > coding.worst_quality)
        refuse(format("%s has qualities of 0 to %d, where lower is better, not %d", coding.name, coding.worst_quality,
                      codec.quality));
    codec_.reset(avcodec_alloc_context3(encoder));
    if (!codec_) throw std::bad_alloc();
    codec_->width = stated.width, codec_->height = stated.height;
    codec_->pix_fmt = nearest_format(*encoder, stored);
    codec_->time_base = stream.time_base, codec_->framerate = stream.avg_frame_rate;
    codec_->sample_aspect_ratio =
        stream.sample_aspect_ratio.num ? stream.sample_aspect_ratio : stated.sample_aspect_ratio;
    codec_->field_order = stated.field_order;
    codec_->thread_count = coding_threads, codec_->bit_rate = 0;
    codec_->flags |= AV_CODEC_FLAG_BITEXACT;
    if (stated.field_order > AV_FIELD_PROGRESSIVE)
        codec_->flags |= AV_CODEC_FLAG_INTERLACED_DCT | AV_CODEC_FLAG_INTERLACED_ME;
    if (to_->oformat->flags & AVFMT_GLOBALHEADER) codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    set_colours(stored);
    Options options;
    for (const auto &[key, value] : coding.options) options.set(key, value);
    if (coding.quality >= 0) options.set("crf", std::to_string(codec.quality < 0 ? coding.quality : codec.quality));
    const int code = avcodec_open2(codec_.get(), encoder, options.get());
    if (code < 0)
        refuse(format("%s cannot code frames of %d x %d pixels in %s (%s); choose another codec", coding.encoder,
                      stated.width, stated.height, av_get_pix_fmt_name(codec_->pix_fmt), text_of_error(code).c_str()));
    if (codec_->pix_fmt != plain_format(stored))
        events_.note(path_, std::string("its pixels are ") + av_get_pix_fmt_name(codec_->pix_fmt) + ", not "
                                + av_get_pix_fmt_name(stored) + " as those of the source, which " + coding.encoder
                                + " does not code");
}

// A copy of another stream; false if it has no place in the container and can be left out.
bool VideoWriter::Encoder::add_copy(unsigned index) {
    const AVStream &stream = *from_->streams[index];
    const AVCodecParameters &stated = *stream.codecpar;
    const AVMediaType type = stated.codec_type;
    const std::string what =
        std::string(kind_of(stream))
        + (stated.codec_id == AV_CODEC_ID_NONE ? "" : std::string(" (") + avcodec_get_name(stated.codec_id) + ")");
    // Titles of chapters and time codes, which libavformat writes with the chapters and tags.
    if (type == AVMEDIA_TYPE_DATA
        && (stated.codec_tag == MKTAG('t', 'e', 'x', 't') || stated.codec_tag == MKTAG('t', 'm', 'c', 'd')))
        return false;
    if (avformat_query_codec(to_->oformat, stated.codec_id, FF_COMPLIANCE_NORMAL) != 1) {
        if (type != AVMEDIA_TYPE_DATA && type != AVMEDIA_TYPE_ATTACHMENT && type != AVMEDIA_TYPE_UNKNOWN)
            refuse("a file of this suffix does not hold the " + what + " of " + source_ + "; give a name with ."
                   + fitting_suffix());
        events_.note(source_,
                     format("stream %u, ", index) + what + ", is left out, because " + path_ + " cannot hold it");
        return false;
    }
    AVStream *copy = avformat_new_stream(to_.get(), nullptr);
    if (!copy || avcodec_parameters_copy(copy->codecpar, &stated) < 0) throw std::bad_alloc();
    const AVCodecTag *const *tags = to_->oformat->codec_tag;
    if (tags && av_codec_get_id(tags, stated.codec_tag) != stated.codec_id && av_codec_get_tag(tags, stated.codec_id))
        copy->codecpar->codec_tag = 0;
    copy->time_base = stream.time_base, copy->disposition = stream.disposition;
    copy->avg_frame_rate = stream.avg_frame_rate, copy->sample_aspect_ratio = stream.sample_aspect_ratio;
    copy_tags(stream.metadata, &copy->metadata, true);
    if (type == AVMEDIA_TYPE_VIDEO) {
        copy_shape_data(stream, *copy);
        if (!(stream.disposition & AV_DISPOSITION_ATTACHED_PIC))
            events_.note(source_, format("has a second video, stream %u, which is copied as it is", index));
    }
    return true;
}

void VideoWriter::Encoder::add_streams() {
    for (unsigned i = 0; i < from_->nb_streams; i++) {
        stream_of_.push_back(static_cast<int>(to_->nb_streams));
        if (int(i) != stream_) {
            if (!add_copy(i)) {
                stream_of_.back() = -1;
                from_->streams[i]->discard = AVDISCARD_ALL;
            }
            continue;
        }
        const AVStream &stream = *from_->streams[i];
        AVStream *coded = avformat_new_stream(to_.get(), nullptr);
        if (!coded || avcodec_parameters_from_context(coded->codecpar, codec_.get()) < 0) throw std::bad_alloc();
        if (codec_->codec_id == AV_CODEC_ID_HEVC && to_->oformat->codec_tag
            && av_codec_get_id(to_->oformat->codec_tag, MKTAG('h', 'v', 'c', '1')) == AV_CODEC_ID_HEVC)
            coded->codecpar->codec_tag = MKTAG('h', 'v', 'c', '1');  // which players of Apple expect
        coded->time_base = stream.time_base, coded->disposition = stream.disposition;
        coded->avg_frame_rate = stream.avg_frame_rate, coded->sample_aspect_ratio = codec_->sample_aspect_ratio;
        copy_tags(stream.metadata, &coded->metadata, false);
        copy_shape_data(stream, *coded);
    }
    copy_tags(from_->metadata, &to_->metadata, false);
    copy_chapters(*from_, *to_);
}

void VideoWriter::Encoder::write_header() {
    Options options;
    const AVRational base = codec_->time_base;
    if (base.num == 1) options.set("video_track_timescale", std::to_string(base.den));
    if (av_dict_get(from_->metadata, "com.", nullptr, AV_DICT_IGNORE_SUFFIX))
        options.set("movflags", "use_metadata_tags");  // those of phones
    written(avio_open(&to_->pb, ("file:" + output_->temporary()).c_str(), AVIO_FLAG_WRITE));
    const int code = avformat_write_header(to_.get(), options.get());
    if (code == AVERROR(EINVAL) || code == AVERROR_PATCHWELCOME)
        refuse("a file of this suffix does not hold the streams of " + source_ + "; give a name with ."
               + fitting_suffix());
    written(code);
}

// Opens the conversion, and a frame for RGB: libswscale reads beyond the rows that it converts.
void VideoWriter::Encoder::open_scaler(AVPixelFormat rgb) {
    scaler_.reset(sws_getContext(codec_->width, codec_->height, rgb, codec_->width, codec_->height, codec_->pix_fmt,
                                 scaler_flags, nullptr, nullptr, nullptr));
    if (!scaler_) refuse(std::string("RGB is not converted to ") + av_get_pix_fmt_name(codec_->pix_fmt));
    const int *numbers = sws_getCoefficients(matrix_of(codec_->colorspace, codec_->width, codec_->height));
    sws_setColorspaceDetails(scaler_.get(), numbers, 1, numbers, is_full_range(codec_->color_range, codec_->pix_fmt), 0,
                             1 << 16, 1 << 16);
    padded_.reset(av_frame_alloc());
    if (!padded_) throw std::bad_alloc();
    padded_->format = rgb, padded_->width = codec_->width, padded_->height = codec_->height;
    if (av_frame_get_buffer(padded_.get(), 0) < 0) throw std::bad_alloc();
}

void VideoWriter::Encoder::convert(const Picture &picture, AVFrame &frame) {
    if (!scaler_) open_scaler(picture.sample == LENSPROF_SAMPLE_U16 ? AV_PIX_FMT_RGB48 : AV_PIX_FMT_RGB24);
    const int row_bytes = static_cast<int>(picture.row_bytes);
    av_image_copy_plane(padded_->data[0], padded_->linesize[0], picture.pixels.data(), row_bytes, row_bytes,
                        padded_->height);
    frame.format = codec_->pix_fmt, frame.width = codec_->width, frame.height = codec_->height;
    frame.colorspace = codec_->colorspace, frame.color_range = codec_->color_range;
    frame.color_primaries = codec_->color_primaries, frame.color_trc = codec_->color_trc;
    frame.chroma_location = codec_->chroma_sample_location;
    frame.sample_aspect_ratio = codec_->sample_aspect_ratio;
    if (av_frame_get_buffer(&frame, 0) < 0) throw std::bad_alloc();
    sws_scale(scaler_.get(), padded_->data, padded_->linesize, 0, frame.height, frame.data, frame.linesize);
}

void VideoWriter::Encoder::write(const VideoFrame &frame, size_t frames) {
    constexpr size_t most_sampled = 16;
    const AVRational base = codec_->time_base;
    const auto counted_time = static_cast<int64_t>(std::llround(frame.seconds / av_q2d(base)));
    int64_t time = frame.time_stamp.value_or(counted_time);
    if (last_time_) time = std::max(time, *last_time_ + 1);
    last_time_ = time, sample_ = frame.picture.sample;
    copy_until(double(time) * av_q2d(base));
    const Libav<AVFrame> pixels(av_frame_alloc());
    if (!pixels) throw std::bad_alloc();
    convert(frame.picture, *pixels);
    pixels->pts = time;
    durations_[time] = static_cast<int64_t>(std::llround(frame.duration_s / av_q2d(base)));
    encode(pixels.get());
    if (frames_++ % std::max<size_t>(frames / most_sampled, 1) == 0 && sampled_.size() < 2 * most_sampled)
        sampled_.push_back({frame.number, sampled_rows(frame.picture)});
}

void VideoWriter::Encoder::encode(const AVFrame *frame) {
    int code = avcodec_send_frame(codec_.get(), frame);
    written(code);
    const int index = stream_of_[size_t(stream_)];
    while ((code = avcodec_receive_packet(codec_.get(), coded_.get())) >= 0) {
        const auto duration = durations_.find(coded_->pts);
        if (duration != durations_.end()) {
            coded_->duration = duration->second;
            durations_.erase(duration);
        }
        coded_->stream_index = index;
        av_packet_rescale_ts(coded_.get(), codec_->time_base, to_->streams[index]->time_base);
        written(av_interleaved_write_frame(to_.get(), coded_.get()));
    }
    if (code != AVERROR(EAGAIN) && code != AVERROR_EOF) written(code);
}

// Copies the packets of the other streams up to a time.
void VideoWriter::Encoder::copy_until(double seconds) {
    while (!is_copied_) {
        const int code = is_copy_held_ ? 0 : av_read_frame(from_.get(), copied_.get());
        if (code == AVERROR_EOF) {
            is_copied_ = true;
            return;
        }
        if (code < 0)
            throw Failure(LENSPROF_ERROR_READ, source_ + ": its sound or other data cannot be read: "
                                                   + text_of_error(code) + "; copy the file again");
        const auto stream = static_cast<size_t>(copied_->stream_index);
        is_copy_held_ = true;
        const AVRational base = from_->streams[stream]->time_base;
        const int64_t time = copied_->dts != AV_NOPTS_VALUE ? copied_->dts : copied_->pts;
        if (time != AV_NOPTS_VALUE && double(time) * av_q2d(base) > seconds) return;
        is_copy_held_ = false;
        if (stream >= stream_of_.size() || stream_of_[stream] < 0 || int(stream) == stream_) {
            av_packet_unref(copied_.get());
            continue;
        }
        copied_->stream_index = stream_of_[stream], copied_->pos = -1;
        av_packet_rescale_ts(copied_.get(), base, to_->streams[stream_of_[stream]]->time_base);
        written(av_interleaved_write_frame(to_.get(), copied_.get()));
    }
}

VideoLoss VideoWriter::Encoder::measured() const {
    VideoLoss loss{codec_->codec->name, av_get_pix_fmt_name(codec_->pix_fmt)};
    VideoReader reader(output_->temporary());
    if (reader.info().orientation != VideoReader(source_).info().orientation)
        events_.warn(path_, "does not hold the rotation of " + source_
                                + " with the installed libavformat; give a name with .mp4 to keep it");
    VideoFrame frame;
    auto wanted = sampled_.begin();
    uint64_t frames = 0;
    for (; reader.next(frame); frames++) {
        stop_if_cancelled();
        if (wanted == sampled_.end() || frames != wanted->number) continue;
        reader.read(frame.picture);
        const double difference = mean_difference(sample_, wanted++->rows, sampled_rows(frame.picture));
        loss.mean += difference / double(sampled_.size());
        loss.largest = std::max(loss.largest, difference);
    }
    if (frames != frames_)
        throw Failure(LENSPROF_ERROR_WRITE,
                      path_
                          + format(": %llu frames were coded, but %llu are read back; choose "
                                   "another codec or suffix",
                                   static_cast<unsigned long long>(frames_), static_cast<unsigned long long>(frames)));
    return loss;
}

VideoLoss VideoWriter::Encoder::finish() {
    encode(nullptr);
    copy_until(INFINITY);
    written(av_write_trailer(to_.get()));
    written(avio_closep(&to_->pb));
    const VideoLoss loss = measured();
    output_->commit();
    return loss;
}

bool is_video_codec(const std::string &name) {
    return std::any_of(std::begin(codings), std::end(codings), [&](const Coding &c) { return name == c.name; });
}

VideoWriter::VideoWriter(const std::string &source, const std::string &path, const VideoCodec &codec, Events &events)
    : encoder_(std::make_unique<Encoder>(source, path, codec, events)) {}
VideoWriter::~VideoWriter() = default;
void VideoWriter::write(const VideoFrame &frame, size_t frames) { encoder_->write(frame, frames); }
VideoLoss VideoWriter::finish() { return encoder_->finish(); }

}  // namespace lensprof
