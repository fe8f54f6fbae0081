// Handles of libav, and what its numbers of colours mean.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/avstring.h>
#include <libavutil/imgutils.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

namespace lensprof {

struct LibavFree {
    void operator()(AVFormatContext *context) const { avformat_close_input(&context); }
    void operator()(AVCodecContext *context) const { avcodec_free_context(&context); }
    void operator()(AVFrame *frame) const { av_frame_free(&frame); }
    void operator()(AVPacket *packet) const { av_packet_free(&packet); }
    void operator()(SwsContext *context) const { sws_freeContext(context); }
};
template <class Type>
using Libav = std::unique_ptr<Type, LibavFree>;

inline std::string text_of_error(int code) {
    char text[AV_ERROR_MAX_STRING_SIZE] = {};
    av_strerror(code, text, sizeof text);
    return text;
}

// The numbers of a matrix in libswscale; BT.709 or BT.601 by the size where none is stated.
inline int matrix_of(AVColorSpace stated, int width, int height) {
    switch (stated) {
    case AVCOL_SPC_BT709: return SWS_CS_ITU709;
    case AVCOL_SPC_FCC: return SWS_CS_FCC;
    case AVCOL_SPC_SMPTE170M:
    case AVCOL_SPC_BT470BG: return SWS_CS_ITU601;
    case AVCOL_SPC_SMPTE240M: return SWS_CS_SMPTE240M;
    case AVCOL_SPC_BT2020_NCL: return SWS_CS_BT2020;
    default: return width > 1024 || height > 576 ? SWS_CS_ITU709 : SWS_CS_ITU601;
    }
}

// Whether matrix_of is that of a stated matrix, or none is stated.
inline bool has_known_matrix(AVColorSpace stated) {
    switch (stated) {
    case AVCOL_SPC_RGB:
    case AVCOL_SPC_UNSPECIFIED:
    case AVCOL_SPC_RESERVED:
    case AVCOL_SPC_BT709:
    case AVCOL_SPC_FCC:
    case AVCOL_SPC_SMPTE170M:
    case AVCOL_SPC_BT470BG:
    case AVCOL_SPC_SMPTE240M:
    case AVCOL_SPC_BT2020_NCL: return true;
    default: return false;
    }
}

inline bool is_rgb(AVPixelFormat format) {
    const auto *described = av_pix_fmt_desc_get(format);
    return described && (described->flags & AV_PIX_FMT_FLAG_RGB);
}

// The formats of JPEG are full range by their name.
inline bool is_full_range(AVColorRange stated, AVPixelFormat format) {
    if (stated != AVCOL_RANGE_UNSPECIFIED) return stated == AVCOL_RANGE_JPEG;
    const char *name = av_get_pix_fmt_name(format);
    return (name && std::string(name).rfind("yuvj", 0) == 0) || is_rgb(format);
}

constexpr int scaler_flags = SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_FULL_CHR_H_INP | SWS_BITEXACT;

}  // namespace lensprof
