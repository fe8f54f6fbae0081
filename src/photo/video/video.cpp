#include "photo/video/video.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <new>

extern "C" {
#include <libavutil/display.h>
}

#include "photo/base/failure.hpp"
#include "photo/base/file_kind.hpp"
#include "photo/base/format.hpp"
#include "photo/video/libav.hpp"

namespace lensprof {
namespace {

// The display matrix of a stream, 9 numbers; NULL: none.
const int32_t *display_matrix_of(const AVStream &stream) {
    constexpr size_t bytes = 9 * sizeof(int32_t);
#if LIBAVFORMAT_VERSION_INT >= AV_VERSION_INT(60, 15, 100)
    const AVPacketSideData *data = av_packet_side_data_get(
        stream.codecpar->coded_side_data, stream.codecpar->nb_coded_side_data, AV_PKT_DATA_DISPLAYMATRIX);
    return data && data->size >= bytes ? reinterpret_cast<const int32_t *>(data->data) : nullptr;
#else
    size_t size = 0;
    const uint8_t *data = av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, &size);
    return data && size >= bytes ? reinterpret_cast<const int32_t *>(data) : nullptr;
#endif
}

// The matrix (a, b; c, d) shows the stored place (x, y) at (a x + c y, b x + d y). Angles between quarter turns are
// taken as the nearest of them.
uint16_t orientation_of(const int32_t *matrix) {
    if (!matrix) return 1;
    const int32_t a = matrix[0], b = matrix[1], c = matrix[3], d = matrix[4];
    if (std::abs(int64_t(a)) >= std::abs(int64_t(b))) return a >= 0 ? (d >= 0 ? 1 : 4) : (d >= 0 ? 2 : 3);
    return b >= 0 ? (c >= 0 ? 5 : 6) : (c >= 0 ? 8 : 7);
}

// What makes grey values of this transfer function something else than a rendering for a screen; NULL: nothing.
const char *refused_transfer(AVColorTransferCharacteristic transfer) {
    switch (transfer) {
    case AVCOL_TRC_SMPTE2084: return "PQ (HDR10, Dolby Vision)";
    case AVCOL_TRC_ARIB_STD_B67: return "HLG (HDR)";
    case AVCOL_TRC_LOG:
    case AVCOL_TRC_LOG_SQRT: return "log";
    case AVCOL_TRC_SMPTE428: return "SMPTE 428 (digital cinema)";
    default: return nullptr;
    }
}

int64_t duration_of(const AVFrame &frame) {
#if LIBAVUTIL_VERSION_INT >= AV_VERSION_INT(57, 30, 100)
    return frame.duration;
#else
    return frame.pkt_duration;
#endif
}

std::string tag_of(const AVFormatContext &file, const AVStream &stream, std::initializer_list<const char *> names) {
    for (const AVDictionary *tags : {file.metadata, stream.metadata})
        for (const char *name : names)
            if (const AVDictionaryEntry *entry = av_dict_get(tags, name, nullptr, 0)) return entry->value;
    return {};
}

}  // namespace

struct VideoReader::Decoder {
    explicit Decoder(const std::string &path);

    bool next(VideoFrame &frame);
    void convert(Picture &picture);

    VideoInfo info;

private:
    [[noreturn]] void fail(const std::string &what) const { throw Failure(LENSPROF_ERROR_READ, path_ + ": " + what); }
    [[noreturn]] void fail_whole(const std::string &why) const {
        const auto kind = other_pictures(path_);
        fail("is " + (kind ? kind->kind : std::string("a video")) + " that " + why
             + "; a recording that was not finished, or a damaged file: repair it, or give another copy");
    }
    [[noreturn]] void fail_cut(const std::string &why) const {
        if (!read_) fail_whole("has no frame that can be decoded: " + why);
        fail("is damaged or cut: " + why + " after " + counted(read_, "frame")
             + "; copy the file again, or keep its intact part with `ffmpeg -i FILE -c copy intact.mkv`");
    }
    void open();
    void describe();
    void refuse_transfer(const AVFrame &frame) const;
    bool is_cut() const;
    bool receive();
    void send();

    std::string path_;
    Libav<AVFormatContext> file_;
    Libav<AVCodecContext> codec_;
    Libav<AVFrame> frame_{av_frame_alloc()};
    Libav<AVPacket> packet_{av_packet_alloc()};
    Libav<SwsContext> scaler_;
    std::array<int, 3> scaler_for_{-1, -1, -1};  // pixel format, matrix, range
    int stream_ = -1;
    bool is_held_ = false, is_at_end_ = false;  // frame_ holds the next frame; all packets were sent
    uint64_t read_ = 0;
    int64_t first_time_ = 0;
    double seconds_ = 0.0, frame_s_ = 0.0;
    double packets_end_s_ = 0.0;  // of the last packet that was read
};

VideoReader::Decoder::Decoder(const std::string &path) : path_(path) {
    av_log_set_level(AV_LOG_QUIET);
    open();
    is_held_ = receive();
    if (!is_held_) fail_whole("has no frame");
    describe();
}

void VideoReader::Decoder::open() {
    AVFormatContext *file = nullptr;
    int code = avformat_open_input(&file, ("file:" + path_).c_str(), nullptr, nullptr);
    if (code < 0) fail_whole("cannot be opened: " + text_of_error(code));
    file_.reset(file);
    code = avformat_find_stream_info(file, nullptr);
    const AVCodec *decoder = nullptr;
    if (code >= 0) code = av_find_best_stream(file, AVMEDIA_TYPE_VIDEO, -1, -1, &decoder, 0);
    if (code == AVERROR_DECODER_NOT_FOUND)
        fail(
            "there is no decoder for its video in the installed libavcodec; convert it with `ffmpeg -i FILE -crf 12 "
            "converted.mp4` where it can be played");
    if (code < 0 || (file->streams[code]->disposition & AV_DISPOSITION_ATTACHED_PIC))
        fail("contains no video, only sound or other data; give a file with a video");
    stream_ = code;
    for (unsigned i = 0; i < file->nb_streams; i++)
        if (int(i) != stream_) file->streams[i]->discard = AVDISCARD_ALL;
    const AVStream &stream = *file->streams[stream_];
    codec_.reset(avcodec_alloc_context3(decoder));
    if (!codec_ || !frame_ || !packet_) throw std::bad_alloc();
    code = avcodec_parameters_to_context(codec_.get(), stream.codecpar);
    codec_->pkt_timebase = stream.time_base;
    codec_->thread_count = 0;
    if (code >= 0) code = avcodec_open2(codec_.get(), decoder, nullptr);
    if (code < 0) fail("its " + std::string(decoder->name) + " video cannot be decoded: " + text_of_error(code));
}

void VideoReader::Decoder::describe() {
    const AVStream &stream = *file_->streams[stream_];
    const auto *format = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(frame_->format));
    info.width = static_cast<uint32_t>(frame_->width), info.height = static_cast<uint32_t>(frame_->height);
    info.sample = format && format->comp[0].depth > 8 ? LENSPROF_SAMPLE_U16 : LENSPROF_SAMPLE_U8;
    info.orientation = orientation_of(display_matrix_of(stream));
    info.is_interlaced = stream.codecpar->field_order > AV_FIELD_PROGRESSIVE;
    info.codec = avcodec_get_name(stream.codecpar->codec_id);
    info.camera_maker = tag_of(*file_, stream, {"com.apple.quicktime.make", "com.android.manufacturer", "make"});
    info.camera_model = tag_of(*file_, stream, {"com.apple.quicktime.model", "com.android.model", "model"});
    if (stream.avg_frame_rate.num > 0) info.frames_per_s = av_q2d(stream.avg_frame_rate);
    info.frames = static_cast<uint64_t>(std::max<int64_t>(stream.nb_frames, 0));
    frame_s_ = info.frames_per_s > 0.0 ? 1.0 / info.frames_per_s : 0.04;
    first_time_ = frame_->best_effort_timestamp;
}

// Whether the index of the file names packets beyond its end, or its header a later one than the last.
bool VideoReader::Decoder::is_cut() const {
    constexpr double tolerance_s = 0.5;
    AVStream *stream = file_->streams[stream_];
    const bool states_duration = file_->nb_streams == 1 && file_->duration > 0
                                 && file_->duration_estimation_method == AVFMT_DURATION_FROM_STREAM;
    const double stated_s = states_duration ? double(file_->duration) / AV_TIME_BASE : 0.0;
    if (packets_end_s_ > 0.0 && packets_end_s_ < stated_s - std::max(tolerance_s, 3.0 * frame_s_)) return true;
    const int count = avformat_index_get_entries_count(stream);
    const int64_t size = file_->pb ? avio_size(file_->pb) : -1;
    if (count < 1 || size < 0) return false;
    const AVIndexEntry *last = avformat_index_get_entry(stream, count - 1);
    return last->pos >= size || last->pos + last->size > size;
}

// Sends the next packet of the stream, or the end.
void VideoReader::Decoder::send() {
    for (;;) {
        const int code = av_read_frame(file_.get(), packet_.get());
        if (code == AVERROR_EOF) {
            if (is_cut()) fail_cut("it ends");
            is_at_end_ = true;
            avcodec_send_packet(codec_.get(), nullptr);
            return;
        }
        if (code < 0) fail_cut(text_of_error(code));
        const bool is_of_stream = packet_->stream_index == stream_;
        if (is_of_stream && packet_->pts != AV_NOPTS_VALUE)
            packets_end_s_ = std::max(
                packets_end_s_, double(packet_->pts + packet_->duration) * av_q2d(file_->streams[stream_]->time_base));
        const bool is_corrupt = packet_->flags & AV_PKT_FLAG_CORRUPT;
        const int sent = is_of_stream && !is_corrupt ? avcodec_send_packet(codec_.get(), packet_.get()) : 0;
        av_packet_unref(packet_.get());
        if (!is_of_stream) continue;
        if (is_corrupt) fail_cut("a packet is incomplete");
        if (sent < 0) fail_cut(text_of_error(sent));
        return;
    }
}

bool VideoReader::Decoder::receive() {
    for (;;) {
        const int code = avcodec_receive_frame(codec_.get(), frame_.get());
        if (code == AVERROR_EOF) return false;
        if (code == AVERROR(EAGAIN)) {
            send();
            continue;
        }
        if (code < 0) fail_cut(text_of_error(code));
        if (frame_->decode_error_flags || (frame_->flags & AV_FRAME_FLAG_CORRUPT)) fail_cut("a frame has errors");
        return true;
    }
}

void VideoReader::Decoder::refuse_transfer(const AVFrame &frame) const {
    if (const char *transfer = refused_transfer(frame.color_trc))
        fail(std::string("its transfer function is ") + transfer
             + ", not that of pictures for a screen; record in SDR (BT.709), or convert it with `ffmpeg -i FILE -vf "
               "zscale=transfer=bt709,format=yuv420p converted.mp4`");
    if (!has_known_matrix(frame.colorspace))
        fail(std::string("its colours are coded as ") + av_color_space_name(frame.colorspace)
             + "; convert it to BT.709 first");
}

void VideoReader::Decoder::convert(Picture &picture) {
    const auto stored = static_cast<AVPixelFormat>(frame_->format);
    const std::array<int, 3> wanted{frame_->format, matrix_of(frame_->colorspace, frame_->width, frame_->height),
                                    is_full_range(frame_->color_range, stored)};
    const bool is_deep = info.sample == LENSPROF_SAMPLE_U16;
    if (wanted != scaler_for_) {
        scaler_.reset(sws_getContext(frame_->width, frame_->height, stored, frame_->width, frame_->height,
                                     is_deep ? AV_PIX_FMT_RGB48 : AV_PIX_FMT_RGB24, scaler_flags, nullptr, nullptr,
                                     nullptr));
        if (!scaler_)
            fail(std::string(av_get_pix_fmt_name(stored))
                 + " pixels cannot be converted to RGB; convert the video to yuv420p first");
        const int *numbers = sws_getCoefficients(wanted[1]);
        sws_setColorspaceDetails(scaler_.get(), numbers, wanted[2], numbers, 1, 0, 1 << 16, 1 << 16);
        scaler_for_ = wanted;
    }
    picture.width = picture.frame_width = info.width;
    picture.height = picture.frame_height = info.height;
    picture.sample = info.sample, picture.layout = LENSPROF_LAYOUT_RGB;
    picture.row_bytes = size_t(info.width) * (is_deep ? 6 : 3);
    picture.traits.orientation = info.orientation, picture.traits.is_lossy = true;
    picture.pixels.resize(picture.row_bytes * info.height);
    uint8_t *rows[4] = {picture.pixels.data(), nullptr, nullptr, nullptr};
    const int row_bytes[4] = {static_cast<int>(picture.row_bytes), 0, 0, 0};
    sws_scale(scaler_.get(), frame_->data, frame_->linesize, 0, frame_->height, rows, row_bytes);
}

bool VideoReader::Decoder::next(VideoFrame &frame) {
    if (!is_held_ && !(is_held_ = receive())) return false;
    if (static_cast<uint32_t>(frame_->width) != info.width || static_cast<uint32_t>(frame_->height) != info.height)
        fail(format("frame %llu has %d x %d pixels, but those before it have %u x %u; split the video there",
                    static_cast<unsigned long long>(read_ + 1), frame_->width, frame_->height, info.width,
                    info.height));
    refuse_transfer(*frame_);
    const bool has_time = frame_->best_effort_timestamp != AV_NOPTS_VALUE && first_time_ != AV_NOPTS_VALUE;
    const double stated_s =
        has_time ? double(frame_->best_effort_timestamp - first_time_) * av_q2d(file_->streams[stream_]->time_base)
                 : seconds_ + frame_s_;
    if (read_) seconds_ = stated_s > seconds_ ? stated_s : seconds_ + frame_s_;
    frame.seconds = seconds_, frame.number = read_++;
    frame.duration_s = double(duration_of(*frame_)) * av_q2d(file_->streams[stream_]->time_base);
    frame.time_stamp = has_time ? std::optional<int64_t>(frame_->best_effort_timestamp) : std::nullopt;
    is_held_ = false;
    return true;
}

bool can_read_video() { return true; }

VideoReader::VideoReader(const std::string &path) : decoder_(std::make_unique<Decoder>(path)) {}
VideoReader::~VideoReader() = default;
const VideoInfo &VideoReader::info() const { return decoder_->info; }
bool VideoReader::next(VideoFrame &frame) { return decoder_->next(frame); }
void VideoReader::read(Picture &picture) { decoder_->convert(picture); }

}  // namespace lensprof
