// JPEG XL through libjxl, whose decoder takes the file in parts and reports events.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <new>

#include <jxl/decode.h>

#include "photo/base/events.hpp"
#include "photo/pictures/coded_file.hpp"
#include "photo/pictures/file_boxes.hpp"
#include "photo/pictures/picture_excerpt.hpp"

namespace lensprof {

namespace codec {

namespace {

constexpr size_t part_bytes = size_t(1) << 18;
constexpr uint64_t working_max_bytes = uint64_t(2) << 30;  // libjxl decodes to floats, regardless of the output type
constexpr size_t box_max_bytes = size_t(64) << 20;         // of EXIF or XMP, which may be compressed
constexpr int max_boxes = 1000;                            // searched for a JPEG
constexpr size_t box_first_bytes = size_t(64) << 10;

// Whether a container has the data to restore a JPEG file (ISO/IEC 18181-2, box jbrd), which may follow the picture's
// header.
bool has_jpeg(std::FILE *file) {
    std::vector<uint8_t> head;
    if (!read_at(file, 0, 4, head) || big_endian(head.data(), 4) != 12) return false;
    uint64_t offset = 12;
    for (int boxes = 0; boxes < max_boxes && read_at(file, offset, 16, head); ++boxes) {
        if (std::memcmp(&head[4], "jbrd", 4) == 0) return true;
        uint64_t size = big_endian(head.data(), 4);
        if (size == 1) size = big_endian(&head[8], 8);
        if (size < 8 || size > UINT64_MAX / 4 - offset) return false;  // 0: up to the end
        offset += size;
    }
    return false;
}

class JxlFile {
public:
    JxlFile(const std::string &path, int events);

    // The next subscribed event, up to JXL_DEC_SUCCESS.
    JxlDecoderStatus next();

    // Requires the next event to be this one.
    void expect(JxlDecoderStatus event) {
        if (next() != event) fail("its headers are out of order");
    }

    // Common first steps for every picture; refuses unsupported ones.
    void read_head();

    void check(JxlDecoderStatus status) const {
        if (status != JXL_DEC_SUCCESS) fail("libjxl cannot decode it");
    }
    [[noreturn]] void fail(const char *detail) const { fail_damaged(path_, std::string("JPEG XL: ") + detail); }

    JxlDecoder *decoder() const { return decoder_.get(); }
    const JxlBasicInfo &info() const { return info_; }
    bool keeps_jpeg() const { return keeps_jpeg_; }
    bool is_box(const char *type, const JxlBoxType &box_type) const {
        return std::memcmp(box_type, type, sizeof box_type) == 0;
    }
    std::vector<uint8_t> icc() const;

    // Contents of the EXIF and XMP boxes, up to the end of the file.
    void read_boxes(std::vector<uint8_t> &exif, std::vector<uint8_t> &xmp);

private:
    void take_more();
    void note_box();
    void open_box(std::vector<uint8_t> &box);
    void close_box();
    JxlDecoderStatus end_boxes();
    void check_kind() const;

    std::string path_;
    File file_;
    std::unique_ptr<JxlDecoder, void (*)(JxlDecoder *)> decoder_{nullptr, JxlDecoderDestroy};
    std::vector<uint8_t> part_;  // of the file, held by the decoder
    bool is_at_end_ = false;
    JxlBasicInfo info_ = {};
    bool keeps_jpeg_ = false;
    std::vector<uint8_t> *exif_ = nullptr, *xmp_ = nullptr, *box_ = nullptr;  // box_: that is being read
};

JxlFile::JxlFile(const std::string &path, int events) : path_(path), file_(open_for_reading(path)) {
    decoder_.reset(JxlDecoderCreate(nullptr));
    if (!decoder_) throw std::bad_alloc();
    keeps_jpeg_ = has_jpeg(file_.get());
    std::rewind(file_.get());
    check(JxlDecoderSubscribeEvents(decoder(), events | JXL_DEC_BASIC_INFO | JXL_DEC_COLOR_ENCODING | JXL_DEC_BOX));
    check(JxlDecoderSetKeepOrientation(decoder(), JXL_TRUE));
    JxlDecoderSetDecompressBoxes(decoder(), JXL_TRUE);  // fails where libjxl is built without Brotli
}

// Passes the decoder its unused bytes and the next ones of the file.
void JxlFile::take_more() {
    stop_if_cancelled();
    if (is_at_end_) fail("its data end before the picture is complete");
    const size_t rest = JxlDecoderReleaseInput(decoder());
    part_.erase(part_.begin(), part_.end() - static_cast<ptrdiff_t>(rest));
    part_.resize(rest + part_bytes);
    const size_t received = std::fread(part_.data() + rest, 1, part_bytes, file_.get());
    part_.resize(rest + received);
    is_at_end_ = received < part_bytes;
    check(JxlDecoderSetInput(decoder(), part_.data(), part_.size()));
}

JxlDecoderStatus JxlFile::next() {
    for (;;) {
        const JxlDecoderStatus status = JxlDecoderProcessInput(decoder());
        if (box_ && (status == JXL_DEC_BOX || status == JXL_DEC_SUCCESS)) close_box();
        switch (status) {
        case JXL_DEC_ERROR: fail("libjxl cannot decode it");
        case JXL_DEC_NEED_MORE_INPUT:
            if (is_at_end_ && exif_ && info_.xsize > 0) return end_boxes();
            take_more();
            break;
        case JXL_DEC_BOX: note_box(); break;
        case JXL_DEC_BOX_NEED_MORE_OUTPUT: {
            std::vector<uint8_t> &box = *box_;
            const size_t used = box.size() - JxlDecoderReleaseBoxBuffer(decoder());
            if (box.size() >= box_max_bytes) fail("its EXIF or XMP is larger than 64 MiB");
            box.resize(2 * box.size());
            check(JxlDecoderSetBoxBuffer(decoder(), box.data() + used, box.size() - used));
            break;
        }
        default: return status;
        }
    }
}

void JxlFile::note_box() {
    JxlBoxType type = {};
    check(JxlDecoderGetBoxType(decoder(), type, JXL_TRUE));
    if (exif_ && exif_->empty() && is_box("Exif", type)) open_box(*exif_);
    if (xmp_ && xmp_->empty() && is_box("xml ", type)) open_box(*xmp_);
}

void JxlFile::open_box(std::vector<uint8_t> &box) {
    box.resize(box_first_bytes);
    check(JxlDecoderSetBoxBuffer(decoder(), box.data(), box.size()));
    box_ = &box;
}

void JxlFile::close_box() {
    box_->resize(box_->size() - JxlDecoderReleaseBoxBuffer(decoder()));
    box_ = nullptr;
}

// The last box may have no size. Decoding shows whether the picture before it is complete.
JxlDecoderStatus JxlFile::end_boxes() {
    if (box_) close_box();
    return JXL_DEC_SUCCESS;
}

void JxlFile::read_boxes(std::vector<uint8_t> &exif, std::vector<uint8_t> &xmp) {
    exif_ = &exif, xmp_ = &xmp;
    read_head();
    while (next() != JXL_DEC_SUCCESS) continue;
}

void JxlFile::read_head() {
    expect(JXL_DEC_BASIC_INFO);
    check(JxlDecoderGetBasicInfo(decoder(), &info_));
    expect(JXL_DEC_COLOR_ENCODING);
    check_kind();
    JxlColorEncoding colour = {};
    const bool is_named =
        JxlDecoderGetColorAsEncodedProfile(decoder(), nullptr, JXL_COLOR_PROFILE_TARGET_ORIGINAL, &colour)
        == JXL_DEC_SUCCESS;
    if (is_named && colour.transfer_function == JXL_TRANSFER_FUNCTION_PQ) fail_hdr(path_, "JPEG XL", "PQ");
    if (is_named && colour.transfer_function == JXL_TRANSFER_FUNCTION_HLG) fail_hdr(path_, "JPEG XL", "HLG");
    if (is_named || info_.uses_original_profile || info_.exponent_bits_per_sample > 0) return;
    // Colours in libjxl's own space, of a picture with an ICC profile that libjxl cannot convert back to: it would
    // return linear light, for which integers are too coarse.
    colour = {};
    colour.color_space = info_.num_color_channels == 1 ? JXL_COLOR_SPACE_GRAY : JXL_COLOR_SPACE_RGB;
    colour.white_point = JXL_WHITE_POINT_D65;
    colour.primaries = JXL_PRIMARIES_SRGB;
    colour.transfer_function = JXL_TRANSFER_FUNCTION_SRGB;
    colour.rendering_intent = JXL_RENDERING_INTENT_RELATIVE;
    check(JxlDecoderSetPreferredColorProfile(decoder(), &colour));
}

void JxlFile::check_kind() const {
    if (info_.have_animation) fail_animated(path_, "JPEG XL");
    for (uint32_t i = 0; i < info_.num_extra_channels; ++i) {
        JxlExtraChannelInfo channel = {};
        check(JxlDecoderGetExtraChannelInfo(decoder(), i, &channel));
        if (channel.type == JXL_CHANNEL_BLACK)
            fail_unsupported(path_, "is a JPEG XL picture in CMYK; convert it to RGB first");
    }
}

// Format of the returned pixels.
std::vector<uint8_t> JxlFile::icc() const {
    size_t size = 0;
    if (JxlDecoderGetICCProfileSize(decoder(), nullptr, JXL_COLOR_PROFILE_TARGET_DATA, &size) != JXL_DEC_SUCCESS)
        return {};
    std::vector<uint8_t> profile(size);
    check(JxlDecoderGetColorAsICCProfile(decoder(), nullptr, JXL_COLOR_PROFILE_TARGET_DATA, profile.data(), size));
    return profile;
}

class JxlSource final : public DecodedSource {
public:
    explicit JxlSource(const ReadRequest &request)
        : DecodedSource(request.path), jxl_(request.path, JXL_DEC_FULL_IMAGE) {
        jxl_.read_head();
        const JxlBasicInfo &info = jxl_.info();
        const bool is_grey = info.num_color_channels == 1, has_alpha = info.alpha_bits > 0;
        header_.traits.format = FileFormat::jxl;
        header_.traits.is_lossy = !info.uses_original_profile || jxl_.keeps_jpeg();
        header_.traits.orientation = static_cast<uint16_t>(info.orientation);
        if (info.alpha_premultiplied) header_.traits.alpha = PictureTraits::Alpha::associated;
        header_.sample = info.exponent_bits_per_sample > 0 ? LENSPROF_SAMPLE_F32
                         : info.bits_per_sample > 8        ? LENSPROF_SAMPLE_U16
                                                           : LENSPROF_SAMPLE_U8;
        header_.layout = is_grey ? (has_alpha ? LENSPROF_LAYOUT_GREY_ALPHA : LENSPROF_LAYOUT_GREY)
                                 : (has_alpha ? LENSPROF_LAYOUT_RGBA : LENSPROF_LAYOUT_RGB);
        header_.icc = jxl_.icc();
        set_coded_frame(header_, info.xsize, info.ysize, request);
        if (uint64_t(info.xsize) * info.ysize * (info.num_color_channels + info.num_extra_channels) * sizeof(float)
            > working_max_bytes)
            fail_unsupported(request.path,
                             size_text(info.xsize, info.ysize) + " exceed the limit of JPEG XL; convert it to TIFF "
                                                                 "first");
    }

private:
    void decode(uint8_t *pixels, size_t bytes) override;

    JxlFile jxl_;
};

void JxlSource::decode(uint8_t *pixels, size_t bytes) {
    const JxlDataType type = header_.sample == LENSPROF_SAMPLE_F32   ? JXL_TYPE_FLOAT
                             : header_.sample == LENSPROF_SAMPLE_U16 ? JXL_TYPE_UINT16
                                                                     : JXL_TYPE_UINT8;
    const JxlPixelFormat format = {lensprof_layout_samples(header_.layout), type, JXL_NATIVE_ENDIAN, 0};
    jxl_.expect(JXL_DEC_NEED_IMAGE_OUT_BUFFER);
    size_t needed = 0;
    jxl_.check(JxlDecoderImageOutBufferSize(jxl_.decoder(), &format, &needed));
    if (needed != bytes) jxl_.fail("libjxl decodes a size other than the declared one");
    jxl_.check(JxlDecoderSetImageOutBuffer(jxl_.decoder(), &format, pixels, bytes));
    jxl_.expect(JXL_DEC_FULL_IMAGE);
}

}  // namespace

std::unique_ptr<RowSource> open_jxl(const ReadRequest &request) { return std::make_unique<JxlSource>(request); }

CodedMetadata jxl_metadata(const std::string &path) {
    JxlFile jxl(path, 0);
    CodedMetadata metadata;
    std::vector<uint8_t> exif;
    jxl.read_boxes(exif, metadata.xmp);
    metadata.exif = exif_of_item(exif);
    metadata.icc = jxl.icc();
    metadata.width = jxl.info().xsize;
    metadata.height = jxl.info().ysize;
    metadata.orientation = static_cast<uint16_t>(jxl.info().orientation);
    metadata.is_camera_jpeg = jxl.keeps_jpeg();
    return metadata;
}

}  // namespace codec

bool can_read_jxl() { return true; }

}  // namespace lensprof
