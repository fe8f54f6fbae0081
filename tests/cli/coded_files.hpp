// HEIF, WebP and JPEG XL files written with the encoders of the libraries, if the program was built with them. They are
// lossless, so the input picture is the ground truth.
#pragma once

#include <cstring>
#include <memory>

#include <exiv2/exiv2.hpp>

#ifdef LENSPROF_HAS_WEBP
#include <webp/encode.h>
#endif
#ifdef LENSPROF_HAS_HEIF
#include <libheif/heif.h>
#endif
#ifdef LENSPROF_HAS_JXL
#include <jxl/encode.h>
#endif

#include "picture_files.hpp"

// x265 does not free all memory.
extern "C" const char *__lsan_default_suppressions();
extern "C" const char *__lsan_default_suppressions() { return "leak:libx265\nleak:libfontconfig"; }

namespace coded_files {

using namespace picture_files;

// What a file contains in addition to its pixels.
struct Extras {
    Bytes exif, xmp, icc;
    uint16_t orientation = 1;  // the format's own orientation
    int transfer = 0;          // ITU-T H.273, for HEIF; 0 = sRGB
};

// A TIFF structure, as embedded in all of these files.
inline Bytes make_exif(uint16_t orientation) {
    Exiv2::ExifData exif;
    exif["Exif.Image.Make"] = "Example Works";
    exif["Exif.Image.Model"] = "Example One";
    exif["Exif.Image.Orientation"] = orientation;
    exif["Exif.Photo.LensModel"] = "Example 35mm F2";
    exif["Exif.Photo.FNumber"] = Exiv2::URational(28, 10);
    exif["Exif.Photo.ExposureTime"] = Exiv2::URational(1, 60);
    exif["Exif.Photo.ISOSpeedRatings"] = uint16_t(200);
    exif["Exif.Photo.FocalLength"] = Exiv2::URational(35, 1);
    Exiv2::Blob blob;
    Exiv2::ExifParser::encode(blob, Exiv2::littleEndian, exif);
    return {blob.begin(), blob.end()};
}

inline Bytes make_xmp() {
    const std::string text =
        "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF "
        "xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\"><rdf:Description rdf:about=\"\" "
        "xmlns:xmp=\"http://ns.adobe.com/xap/1.0/\" xmp:Rating=\"4\"/></rdf:RDF></x:xmpmeta>";
    return {text.begin(), text.end()};
}

// The four bytes before EXIF, in HEIF and JPEG XL.
inline Bytes with_offset(const Bytes &exif) {
    Bytes item(4, 0);
    item.insert(item.end(), exif.begin(), exif.end());
    return item;
}

// Values of fewer bits, each in 16.
inline Picture of_bits(Picture picture, unsigned bits) {
    auto *values = reinterpret_cast<uint16_t *>(picture.pixels.data());
    for (size_t i = 0; i < picture.pixels.size() / 2; ++i) values[i] = static_cast<uint16_t>(values[i] >> (16 - bits));
    return picture;
}

// The same, scaled to the full range of 16 bits.
inline Picture full_scale(Picture picture, unsigned bits) {
    auto *values = reinterpret_cast<uint16_t *>(picture.pixels.data());
    const double white = (1u << bits) - 1;
    for (size_t i = 0; i < picture.pixels.size() / 2; ++i)
        values[i] = static_cast<uint16_t>(std::lround(values[i] / white * 65535.0));
    return picture;
}

inline void put_number(Bytes &bytes, uint32_t value, int count) {
    for (int i = 0; i < count; ++i) bytes.push_back(static_cast<uint8_t>(value >> 8 * i));
}

// RIFF: a name, a size, the bytes, and a padding byte if their number is odd.
inline void put_riff(Bytes &bytes, const char *name, const Bytes &content) {
    bytes.insert(bytes.end(), name, name + 4);
    put_number(bytes, static_cast<uint32_t>(content.size()), 4);
    bytes.insert(bytes.end(), content.begin(), content.end());
    if (content.size() % 2 != 0) bytes.push_back(0);
}

// An extended WebP that contains the chunks of `simple`, with these flags in addition to those of `extras`.
inline Bytes extended_webp(const Bytes &simple, uint32_t width, uint32_t height, uint8_t flags, const Extras &extras) {
    Bytes head, content = {'W', 'E', 'B', 'P'}, all;
    flags = static_cast<uint8_t>(flags | (extras.icc.empty() ? 0 : 0x20) | (extras.exif.empty() ? 0 : 8)
                                 | (extras.xmp.empty() ? 0 : 4));
    put_number(head, flags, 4);
    put_number(head, width - 1, 3);
    put_number(head, height - 1, 3);
    put_riff(content, "VP8X", head);
    if (!extras.icc.empty()) put_riff(content, "ICCP", extras.icc);
    content.insert(content.end(), simple.begin() + 12, simple.end());
    if (!extras.exif.empty()) put_riff(content, "EXIF", extras.exif);
    if (!extras.xmp.empty()) put_riff(content, "XMP ", extras.xmp);
    put_riff(all, "RIFF", content);
    return all;
}

#ifdef LENSPROF_HAS_WEBP
// 8 bit RGB or RGBA; lossless if `quality` is negative.
inline Bytes webp_bytes(const Picture &picture, float quality = -1) {
    WebPConfig config;
    WebPPicture coded;
    assert_true(WebPConfigInit(&config) && WebPPictureInit(&coded));
    config.lossless = coded.use_argb = quality < 0;
    config.exact = 1;
    if (quality >= 0) config.quality = quality;
    coded.width = static_cast<int>(picture.width), coded.height = static_cast<int>(picture.height);
    const int row = static_cast<int>(picture.row_bytes);
    assert_true(picture.layout == LENSPROF_LAYOUT_RGBA ? WebPPictureImportRGBA(&coded, picture.pixels.data(), row)
                                                       : WebPPictureImportRGB(&coded, picture.pixels.data(), row));
    WebPMemoryWriter writer;
    WebPMemoryWriterInit(&writer);
    coded.writer = WebPMemoryWrite, coded.custom_ptr = &writer;
    assert_true(WebPEncode(&config, &coded));
    const Bytes bytes(writer.mem, writer.mem + writer.size);
    WebPMemoryWriterClear(&writer);
    WebPPictureFree(&coded);
    return bytes;
}
#endif

#ifdef LENSPROF_HAS_HEIF
inline void assert_heif(const heif_error &error) {
    if (error.code != heif_error_Ok) fail_msg("libheif: %s", error.message);
}

inline bool can_write_heif(heif_compression_format format) {
    heif_encoder *encoder = nullptr;
    const bool can = heif_context_get_encoder_for_format(nullptr, format, &encoder).code == heif_error_Ok;
    if (encoder) heif_encoder_release(encoder);
    return can;
}

// Interleaved RGB or RGBA, or planes of grey and alpha; `bits` of each sample.
inline heif_image *heif_pixels(const Picture &picture, int bits) {
    const int width = static_cast<int>(picture.width), height = static_cast<int>(picture.height);
    const bool is_grey = picture.layout == LENSPROF_LAYOUT_GREY, has_alpha = picture.layout == LENSPROF_LAYOUT_RGBA;
    const heif_chroma chroma =
        is_grey    ? heif_chroma_monochrome
        : bits > 8 ? (has_alpha ? heif_chroma_interleaved_RRGGBBAA_LE : heif_chroma_interleaved_RRGGBB_LE)
                   : (has_alpha ? heif_chroma_interleaved_RGBA : heif_chroma_interleaved_RGB);
    heif_image *image = nullptr;
    assert_heif(
        heif_image_create(width, height, is_grey ? heif_colorspace_monochrome : heif_colorspace_RGB, chroma, &image));
    const heif_channel channel = is_grey ? heif_channel_Y : heif_channel_interleaved;
    assert_heif(heif_image_add_plane(image, channel, width, height, bits));
    int stride = 0;
    uint8_t *plane = heif_image_get_plane(image, channel, &stride);
    for (uint32_t y = 0; y < picture.height; ++y)
        std::memcpy(plane + size_t(y) * size_t(stride), picture.pixels.data() + y * picture.row_bytes,
                    picture.row_bytes);
    return image;
}

// Lossless, without conversion of red, green and blue.
inline void add_heif(heif_context *context, heif_encoder *encoder, const Picture &picture, int bits,
                     const Extras &extras, heif_image_handle **handle) {
    heif_image *image = heif_pixels(picture, bits);
    heif_color_profile_nclx *nclx = heif_nclx_color_profile_alloc();
    nclx->color_primaries = heif_color_primaries_ITU_R_BT_709_5;
    nclx->transfer_characteristics = static_cast<heif_transfer_characteristics>(extras.transfer ? extras.transfer : 13);
    nclx->matrix_coefficients = picture.layout == LENSPROF_LAYOUT_GREY ? heif_matrix_coefficients_ITU_R_BT_601_6
                                                                       : heif_matrix_coefficients_RGB_GBR;
    nclx->full_range_flag = 1;
    if (extras.icc.empty())
        assert_heif(heif_image_set_nclx_color_profile(image, nclx));
    else
        assert_heif(heif_image_set_raw_color_profile(image, "prof", extras.icc.data(), extras.icc.size()));
    heif_encoding_options *options = heif_encoding_options_alloc();
    options->output_nclx_profile = nclx;
    options->macOS_compatibility_workaround_no_nclx_profile = 0;
    options->image_orientation = static_cast<heif_orientation>(extras.orientation);
    assert_heif(heif_context_encode_image(context, image, encoder, options, handle));
    heif_encoding_options_free(options);
    heif_nclx_color_profile_free(nclx);
    heif_image_release(image);
}

// `others` are added before the primary one.
inline void write_heif(const std::string &path, heif_compression_format format, const Picture &picture, int bits,
                       const Extras &extras = {}, const std::vector<Picture> &others = {}) {
    heif_context *context = heif_context_alloc();
    heif_encoder *encoder = nullptr;
    assert_heif(heif_context_get_encoder_for_format(context, format, &encoder));
    assert_heif(heif_encoder_set_lossless(encoder, 1));
    heif_encoder_set_parameter_string(encoder, "chroma", "444");
    for (const Picture &other : others) {
        heif_image_handle *handle = nullptr;
        add_heif(context, encoder, other, 8, {}, &handle);
        heif_image_handle_release(handle);
    }
    heif_image_handle *handle = nullptr;
    add_heif(context, encoder, picture, bits, extras, &handle);
    assert_heif(heif_context_set_primary_image(context, handle));
    if (!extras.exif.empty())
        assert_heif(heif_context_add_exif_metadata(context, handle, extras.exif.data(), int(extras.exif.size())));
    if (!extras.xmp.empty())
        assert_heif(heif_context_add_XMP_metadata(context, handle, extras.xmp.data(), int(extras.xmp.size())));
    assert_heif(heif_context_write_to_file(context, path.c_str()));
    heif_image_handle_release(handle);
    heif_encoder_release(encoder);
    heif_context_free(context);
}
#endif

#ifdef LENSPROF_HAS_JXL
struct JxlKind {
    float distance = 0;  // 0 = lossless
    uint32_t transfer = JXL_TRANSFER_FUNCTION_SRGB;
    bool boxes_compressed = false, animated = false;
    uint32_t bits = 0;  // 0: as in the picture
};

inline JxlBasicInfo jxl_info(const Picture &picture, const Extras &extras, const JxlKind &kind) {
    const uint32_t samples = lensprof_layout_samples(picture.layout);
    JxlBasicInfo info;
    JxlEncoderInitBasicInfo(&info);
    info.xsize = picture.width, info.ysize = picture.height;
    info.bits_per_sample = kind.bits ? kind.bits : 8 * lensprof_sample_type_bytes(picture.sample);
    info.exponent_bits_per_sample = picture.sample == LENSPROF_SAMPLE_F32 ? 8 : 0;
    info.num_color_channels = samples < 3 ? 1 : 3;
    if (samples % 2 == 0) {
        info.num_extra_channels = 1;
        info.alpha_bits = info.bits_per_sample;
        info.alpha_exponent_bits = info.exponent_bits_per_sample;
        info.alpha_premultiplied = picture.traits.alpha == PictureTraits::Alpha::associated;
    }
    info.uses_original_profile = kind.distance == 0;
    info.orientation = static_cast<JxlOrientation>(extras.orientation);
    if (kind.animated) {
        info.have_animation = JXL_TRUE;
        info.animation.tps_numerator = 10, info.animation.tps_denominator = 1;
    }
    return info;
}

inline Bytes jxl_bytes(const Picture &picture, const Extras &extras = {}, const JxlKind &kind = {}) {
    const std::unique_ptr<JxlEncoder, void (*)(JxlEncoder *)> owner(JxlEncoderCreate(nullptr), JxlEncoderDestroy);
    JxlEncoder *encoder = owner.get();
    const auto good = [](JxlEncoderStatus status) { assert_int_equal(status, JXL_ENC_SUCCESS); };
    const JxlBasicInfo info = jxl_info(picture, extras, kind);
    const bool has_boxes = !extras.exif.empty() || !extras.xmp.empty();
    if (has_boxes) good(JxlEncoderUseBoxes(encoder));
    good(JxlEncoderSetBasicInfo(encoder, &info));
    JxlColorEncoding colour;
    JxlColorEncodingSetToSRGB(&colour, info.num_color_channels == 1);
    colour.transfer_function = static_cast<JxlTransferFunction>(kind.transfer);
    good(extras.icc.empty() ? JxlEncoderSetColorEncoding(encoder, &colour)
                            : JxlEncoderSetICCProfile(encoder, extras.icc.data(), extras.icc.size()));
    JxlEncoderFrameSettings *settings = JxlEncoderFrameSettingsCreate(encoder, nullptr);
    good(kind.distance == 0 ? JxlEncoderSetFrameLossless(settings, JXL_TRUE)
                            : JxlEncoderSetFrameDistance(settings, kind.distance));
    const JxlDataType type = picture.sample == LENSPROF_SAMPLE_F32   ? JXL_TYPE_FLOAT
                             : picture.sample == LENSPROF_SAMPLE_U16 ? JXL_TYPE_UINT16
                                                                     : JXL_TYPE_UINT8;
    const JxlPixelFormat format = {lensprof_layout_samples(picture.layout), type, JXL_NATIVE_ENDIAN, 0};
    good(JxlEncoderAddImageFrame(settings, &format, picture.pixels.data(), picture.pixels.size()));
    const JXL_BOOL compressed = kind.boxes_compressed;
    const Bytes exif = with_offset(extras.exif);
    if (!extras.exif.empty()) good(JxlEncoderAddBox(encoder, "Exif", exif.data(), exif.size(), compressed));
    if (!extras.xmp.empty()) good(JxlEncoderAddBox(encoder, "xml ", extras.xmp.data(), extras.xmp.size(), compressed));
    JxlEncoderCloseInput(encoder);
    Bytes bytes(picture.pixels.size() * 2 + (1 << 16));
    uint8_t *next = bytes.data();
    size_t rest = bytes.size();
    good(JxlEncoderProcessOutput(encoder, &next, &rest));
    bytes.resize(bytes.size() - rest);
    return bytes;
}
#endif

}  // namespace coded_files
