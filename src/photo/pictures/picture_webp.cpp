// WebP through libwebp: RIFF chunks with its demultiplexer, pixels with its incremental decoder.
#include <algorithm>
#include <cstdio>
#include <new>

#include <webp/decode.h>
#include <webp/demux.h>

#include "photo/base/events.hpp"
#include "photo/pictures/coded_file.hpp"

namespace lensprof {

namespace codec {

namespace {

constexpr size_t step_bytes = size_t(1) << 18;  // decoded between two checks for interrupts

const char *text_of(VP8StatusCode status) {
    switch (status) {
    case VP8_STATUS_BITSTREAM_ERROR: return "libwebp: bad bitstream";
    case VP8_STATUS_UNSUPPORTED_FEATURE: return "libwebp: unsupported feature";
    case VP8_STATUS_SUSPENDED:
    case VP8_STATUS_NOT_ENOUGH_DATA: return "its data end before the picture is complete";
    default: return "libwebp cannot decode it";
    }
}

// The whole file, because the demultiplexer needs it.
std::vector<uint8_t> load(const std::string &path) {
    const File file = open_for_reading(path);
    const uint64_t size = file_bytes(file.get());
    if (size > coded_max_bytes) fail_unsupported(path, "is a WebP picture larger than 1 GiB; convert it to TIFF first");
    std::vector<uint8_t> bytes;
    if (size > 0) bytes.resize(static_cast<size_t>(size));
    if (std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size())
        fail_damaged(path, "it was truncated while being read");
    return bytes;
}

class WebpFile {
public:
    explicit WebpFile(const std::string &path) : path_(path), bytes_(load(path)) {
        const WebPData data{bytes_.data(), bytes_.size()};
        demuxer_.reset(WebPDemux(&data));
        const VP8StatusCode status = WebPGetFeatures(bytes_.data(), bytes_.size(), &features_);
        if (status == VP8_STATUS_OUT_OF_MEMORY) throw std::bad_alloc();
        if (status != VP8_STATUS_OK) fail_damaged(path, text_of(status));
        if (features_.has_animation) fail_animated(path, "WebP");
        if (!demuxer_) fail_damaged(path, "its chunks are cut off or contradict each other");
    }

    const WebPBitstreamFeatures &features() const { return features_; }
    const std::vector<uint8_t> &bytes() const { return bytes_; }

    // Empty if missing.
    std::vector<uint8_t> chunk(const char *name) const {
        WebPChunkIterator found = {};
        std::vector<uint8_t> bytes;
        if (WebPDemuxGetChunk(demuxer_.get(), name, 1, &found))
            bytes.assign(found.chunk.bytes, found.chunk.bytes + found.chunk.size);
        WebPDemuxReleaseChunkIterator(&found);
        return bytes;
    }

private:
    std::string path_;
    std::vector<uint8_t> bytes_;
    std::unique_ptr<WebPDemuxer, void (*)(WebPDemuxer *)> demuxer_{nullptr, WebPDemuxDelete};
    WebPBitstreamFeatures features_ = {};
};

class WebpSource final : public DecodedSource {
public:
    explicit WebpSource(const ReadRequest &request) : DecodedSource(request.path), webp_(request.path) {
        constexpr int lossless = 2;
        const WebPBitstreamFeatures &features = webp_.features();
        header_.traits.format = FileFormat::webp;
        header_.traits.is_lossy = features.format != lossless;
        header_.sample = LENSPROF_SAMPLE_U8;
        header_.layout = features.has_alpha ? LENSPROF_LAYOUT_RGBA : LENSPROF_LAYOUT_RGB;
        header_.icc = webp_.chunk("ICCP");
        set_coded_frame(header_, static_cast<uint32_t>(features.width), static_cast<uint32_t>(features.height),
                        request);
    }

private:
    void decode(uint8_t *pixels, size_t bytes) override;

    WebpFile webp_;
};

void WebpSource::decode(uint8_t *pixels, size_t bytes) {
    const WEBP_CSP_MODE mode = header_.layout == LENSPROF_LAYOUT_RGBA ? MODE_RGBA : MODE_RGB;
    const std::unique_ptr<WebPIDecoder, void (*)(WebPIDecoder *)> decoder(
        WebPINewRGB(mode, pixels, bytes, static_cast<int>(bytes / header_.frame_height)), WebPIDelete);
    if (!decoder) throw std::bad_alloc();
    const std::vector<uint8_t> &coded = webp_.bytes();
    VP8StatusCode status = VP8_STATUS_SUSPENDED;
    for (size_t end = 0; status == VP8_STATUS_SUSPENDED && end < coded.size();) {
        stop_if_cancelled();
        end = std::min(end + step_bytes, coded.size());
        status = WebPIUpdate(decoder.get(), coded.data(), end);
    }
    if (status == VP8_STATUS_OUT_OF_MEMORY) throw std::bad_alloc();
    if (status != VP8_STATUS_OK) fail_damaged(path_, text_of(status));
}

}  // namespace

std::unique_ptr<RowSource> open_webp(const ReadRequest &request) { return std::make_unique<WebpSource>(request); }

CodedMetadata webp_metadata(const std::string &path) {
    const WebpFile webp(path);
    CodedMetadata metadata;
    const std::vector<uint8_t> exif = webp.chunk("EXIF");
    metadata.exif = without_exif_mark(exif.data(), exif.size());
    metadata.xmp = webp.chunk("XMP ");
    metadata.icc = webp.chunk("ICCP");
    metadata.width = static_cast<uint32_t>(webp.features().width);
    metadata.height = static_cast<uint32_t>(webp.features().height);
    return metadata;
}

}  // namespace codec

bool can_read_webp() { return true; }

}  // namespace lensprof
