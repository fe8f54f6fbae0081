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
#include "photo/video/coding_loss.hpp"
#include "photo/video/libav.hpp"
#include "photo/video/stream_copy.hpp"

namespace lensprof {
namespace {

constexpr int coding_threads = 4;  // of any machine, because encoders give other bytes for another number

struct Coding {
    const char *name, *encoder;
    int quality, worst_quality;  // crf; -1: lossless
    bool halves_odd_sizes;       // codes colours of half the size of frames with odd sides
    std::vector<std::pair<const char *, const char *>> options;
};
const Coding codings[] = {
    {"h264", "libx264", 16, 51, false, {{"preset", "medium"}}},
    {"h265", "libx265", 16, 51, false, {{"preset", "medium"}, {"x265-params", "log-level=none:frame-threads=2"}}},
    {"vp9",
     "libvpx-vp9",
     20,
     63,
     true,
     {{"deadline", "good"}, {"cpu-used", "2"}, {"tile-columns", "2"}, {"row-mt", "1"}}},
    {"ffv1", "ffv1", -1, -1, true, {{"level", "3"}, {"slices", "4"}, {"slicecrc", "1"}}},
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

// Whether the colours of the format have a whole number of pixels in a frame.
bool is_whole(AVPixelFormat format, int width, int height) {
    const auto *described = av_pix_fmt_desc_get(format);
    return described && width % (1 << described->log2_chroma_w) == 0 && height % (1 << described->log2_chroma_h) == 0;
}

// That of the encoder which loses least of those that it codes in this size.
AVPixelFormat nearest_format(const AVCodec &encoder, const Coding &coding, const AVCodecParameters &source) {
    const AVPixelFormat wanted = plain_format(static_cast<AVPixelFormat>(source.format));
    std::vector<AVPixelFormat> fitting;
    for (const AVPixelFormat *format = formats_of(encoder); format && *format != AV_PIX_FMT_NONE; format++)
        if (coding.halves_odd_sizes || is_whole(*format, source.width, source.height)) fitting.push_back(*format);
    if (fitting.empty()) return wanted;
    fitting.push_back(AV_PIX_FMT_NONE);
    const AVPixelFormat nearest = avcodec_find_best_pix_fmt_of_list(fitting.data(), wanted, 0, nullptr);
    return plain_format(nearest == AV_PIX_FMT_NONE ? fitting[0] : nearest);
}

bool has_alpha(AVPixelFormat format) {
    const auto *described = av_pix_fmt_desc_get(format);
    return described && (described->flags & AV_PIX_FMT_FLAG_ALPHA);
}

bool is_top_field_first(AVFieldOrder order) { return order == AV_FIELD_TT || order == AV_FIELD_BT; }

// Marks a frame of an interlaced video with the order of its fields, which encoders do not take from the stream.
void set_fields(AVFieldOrder order, AVFrame &frame) {
    if (order <= AV_FIELD_PROGRESSIVE) return;
    const bool is_top_first = is_top_field_first(order);
#if LIBAVUTIL_VERSION_INT >= AV_VERSION_INT(58, 7, 100)
    frame.flags |= AV_FRAME_FLAG_INTERLACED | (is_top_first ? AV_FRAME_FLAG_TOP_FIELD_FIRST : 0);
#else
    frame.interlaced_frame = 1, frame.top_field_first = is_top_first;
#endif
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
    void open_source();
    void open_encoder(const VideoCodec &codec);
    void set_colours(AVPixelFormat stored);
    void note_pixels(AVPixelFormat stored, const Coding &coding) const;
    void add_streams();
    void add_coded();
    void write_header();
    void open_scaler(AVPixelFormat rgb);
    void convert(const Picture &picture, AVFrame &frame);
    void encode(const AVFrame *frame);

    std::string source_, path_;
    Events &events_;
    uint16_t orientation_;  // of the source
    std::unique_ptr<OutputFile> output_;
    Libav<AVFormatContext> from_;
    std::unique_ptr<AVFormatContext, OutputClose> to_;
    Libav<AVCodecContext> codec_;
    Libav<SwsContext> scaler_;
    Libav<AVFrame> padded_;
    Libav<AVPacket> coded_{av_packet_alloc()};
    int stream_ = -1, coded_stream_ = -1;  // of the source, and of the output
    double later_s_ = 0.0;                 // of the source's times, which begin at 0 in another container
    std::unique_ptr<StreamCopy> copy_;
    std::optional<int64_t> last_time_;
    std::map<int64_t, int64_t> durations_;  // by time stamp, of the frames in the encoder
    CodingLoss loss_;
};

VideoWriter::Encoder::Encoder(const std::string &source, const std::string &path, const VideoCodec &codec,
                              Events &events)
    : source_(source), path_(path), events_(events), orientation_(VideoReader(source).info().orientation) {
    if (!coded_) throw std::bad_alloc();
    open_source();
    AVFormatContext *file = nullptr;
    if (avformat_alloc_output_context2(&file, nullptr, nullptr, path.c_str()) < 0)
        refuse("the installed libavformat does not write such files; give a name with another suffix");
    to_.reset(file);
    to_->flags |= AVFMT_FLAG_BITEXACT;
    if (from_->start_time != AV_NOPTS_VALUE && !av_match_name(to_->oformat->name, from_->iformat->name))
        later_s_ = double(from_->start_time) / AV_TIME_BASE;
    copy_ = std::make_unique<StreamCopy>(source, path, *from_, *to_, later_s_, events);
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
    codec_.reset(avcodec_alloc_context3(encoder));
    if (!codec_) throw std::bad_alloc();
    codec_->width = stated.width, codec_->height = stated.height;
    codec_->pix_fmt = nearest_format(*encoder, coding, stated);
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
    if (stated.field_order > AV_FIELD_PROGRESSIVE && encoder->id == AV_CODEC_ID_H264)
        options.set("x264-params", is_top_field_first(stated.field_order) ? "tff=1" : "bff=1");
    if (coding.quality >= 0) options.set("crf", std::to_string(codec.quality < 0 ? coding.quality : codec.quality));
    const int code = avcodec_open2(codec_.get(), encoder, options.get());
    if (code < 0)
        refuse(format("%s cannot code frames of %d x %d pixels in %s (%s); choose another codec", coding.encoder,
                      stated.width, stated.height, av_get_pix_fmt_name(codec_->pix_fmt), text_of_error(code).c_str()));
    note_pixels(stored, coding);
}

void VideoWriter::Encoder::note_pixels(AVPixelFormat stored, const Coding &coding) const {
    const std::string of_size = coding.halves_odd_sizes || is_whole(stored, codec_->width, codec_->height)
                                    ? ""
                                    : format(" in frames of %d x %d pixels", codec_->width, codec_->height);
    if (codec_->pix_fmt != plain_format(stored))
        events_.note(path_, std::string("its pixels are ") + av_get_pix_fmt_name(codec_->pix_fmt) + ", not "
                                + av_get_pix_fmt_name(stored) + " as those of the source, which " + coding.encoder
                                + " does not code" + of_size);
    if (has_alpha(stored)) events_.note(path_, "its frames are opaque, because transparency is not levelled");
}

void VideoWriter::Encoder::add_coded() {
    const AVStream &stream = *from_->streams[stream_];
    AVStream *coded = avformat_new_stream(to_.get(), nullptr);
    if (!coded || avcodec_parameters_from_context(coded->codecpar, codec_.get()) < 0) throw std::bad_alloc();
    if (codec_->codec_id == AV_CODEC_ID_HEVC && to_->oformat->codec_tag
        && av_codec_get_id(to_->oformat->codec_tag, MKTAG('h', 'v', 'c', '1')) == AV_CODEC_ID_HEVC)
        coded->codecpar->codec_tag = MKTAG('h', 'v', 'c', '1');  // which players of Apple expect
    coded->time_base = stream.time_base, coded->disposition = stream.disposition;
    coded->avg_frame_rate = stream.avg_frame_rate, coded->sample_aspect_ratio = codec_->sample_aspect_ratio;
    copy_tags(stream.metadata, &coded->metadata, false);
    copy_shape_data(stream, *coded);
    coded_stream_ = coded->index;
}

void VideoWriter::Encoder::add_streams() {
    for (unsigned i = 0; i < from_->nb_streams; i++) {
        if (int(i) != stream_) {
            copy_->add();
            continue;
        }
        copy_->skip();
        add_coded();
    }
    copy_tags(from_->metadata, &to_->metadata, false);
    copy_chapters(*from_, *to_, later_s_);
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
               + fitting_suffix(source_, path_));
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
    set_fields(codec_->field_order, frame);
    if (av_frame_get_buffer(&frame, 0) < 0) throw std::bad_alloc();
    sws_scale(scaler_.get(), padded_->data, padded_->linesize, 0, frame.height, frame.data, frame.linesize);
}

void VideoWriter::Encoder::write(const VideoFrame &frame, size_t frames) {
    const AVRational base = codec_->time_base;
    const auto counted_time = static_cast<int64_t>(std::llround(frame.seconds / av_q2d(base)));
    const auto later = static_cast<int64_t>(std::llround(later_s_ / av_q2d(base)));
    int64_t time = frame.time_stamp ? *frame.time_stamp - later : counted_time;
    if (last_time_) time = std::max(time, *last_time_ + 1);
    last_time_ = time;
    copy_->until(double(time + later) * av_q2d(base));
    const Libav<AVFrame> pixels(av_frame_alloc());
    if (!pixels) throw std::bad_alloc();
    convert(frame.picture, *pixels);
    pixels->pts = time;
    durations_[time] = static_cast<int64_t>(std::llround(frame.duration_s / av_q2d(base)));
    encode(pixels.get());
    loss_.add(frame, frames);
}

void VideoWriter::Encoder::encode(const AVFrame *frame) {
    int code = avcodec_send_frame(codec_.get(), frame);
    written(code);
    while ((code = avcodec_receive_packet(codec_.get(), coded_.get())) >= 0) {
        const auto duration = durations_.find(coded_->pts);
        if (duration != durations_.end()) {
            coded_->duration = duration->second;
            durations_.erase(duration);
        }
        coded_->stream_index = coded_stream_;
        av_packet_rescale_ts(coded_.get(), codec_->time_base, to_->streams[coded_stream_]->time_base);
        written(av_interleaved_write_frame(to_.get(), coded_.get()));
    }
    if (code != AVERROR(EAGAIN) && code != AVERROR_EOF) written(code);
}

VideoLoss VideoWriter::Encoder::finish() {
    encode(nullptr);
    copy_->until(INFINITY);
    written(av_write_trailer(to_.get()));
    written(avio_closep(&to_->pb));
    if (VideoReader(output_->temporary()).info().orientation != orientation_)
        events_.warn(path_, "does not hold the rotation of " + source_
                                + " with the installed libavformat; give a name with .mp4 to keep it");
    const auto [mean, largest] = loss_.measured(output_->temporary(), path_);
    output_->commit();
    return {codec_->codec->name, av_get_pix_fmt_name(codec_->pix_fmt), mean, largest};
}

bool is_video_codec(const std::string &name) {
    return std::any_of(std::begin(codings), std::end(codings), [&](const Coding &c) { return name == c.name; });
}

int worst_quality(const std::string &codec) { return coding_of(codec).worst_quality; }

VideoWriter::VideoWriter(const std::string &source, const std::string &path, const VideoCodec &codec, Events &events)
    : encoder_(std::make_unique<Encoder>(source, path, codec, events)) {}
VideoWriter::~VideoWriter() = default;
void VideoWriter::write(const VideoFrame &frame, size_t frames) { encoder_->write(frame, frames); }
VideoLoss VideoWriter::finish() { return encoder_->finish(); }

}  // namespace lensprof
