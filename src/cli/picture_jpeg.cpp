/* JPEG through libjpeg-turbo. Its errors leave by longjmp: see codec::guarded. */
#include "picture.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <new>

#include <jpeglib.h>

#include <jerror.h>

namespace lensprof {

namespace codec {

namespace {

constexpr int profile_marker = JPEG_APP0 + 2;
constexpr int default_quality = 95;

/* Where libjpeg goes when something is wrong; `manager` comes first, so that a pointer to it is one to this. */
struct JpegState {
    jpeg_error_mgr manager;
    std::jmp_buf jump;
    char text[JMSG_LENGTH_MAX] = "";
    int error_number = 0;
};

[[noreturn]] void on_error(j_common_ptr info) {
    JpegState *state = reinterpret_cast<JpegState *>(info->err);
    state->error_number = info->err->msg_code == JERR_FILE_WRITE ? errno : 0;
    info->err->format_message(info, state->text);
    std::longjmp(state->jump, 1);
}

/* libjpeg only warns about damage and invents the missing pixels. Other warnings say that a file is unusual; bytes
 * before a marker, which some cameras write as padding, are among them. */
void on_message(j_common_ptr info, int level) {
    static const int damage[] = {JWRN_JPEG_EOF,     JWRN_HIT_MARKER,       JWRN_HUFF_BAD_CODE,
                                 JWRN_ARITH_BAD_CODE, JWRN_BOGUS_PROGRESSION, JWRN_MUST_RESYNC};
    if (level < 0 && std::find(std::begin(damage), std::end(damage), info->err->msg_code) != std::end(damage))
        on_error(info);
}

void on_output(j_common_ptr) {}

jpeg_error_mgr *set_handlers(JpegState &state) {
    jpeg_std_error(&state.manager);
    state.manager.error_exit = on_error;
    state.manager.emit_message = on_message;
    state.manager.output_message = on_output;
    return &state.manager;
}

struct JpegReader {
    explicit JpegReader(const std::string &path) : file(open_for_reading(path)) { info.err = set_handlers(state); }
    ~JpegReader() { jpeg_destroy_decompress(&info); }
    JpegReader(const JpegReader &) = delete;
    JpegReader &operator=(const JpegReader &) = delete;

    JpegState state;
    File file;
    jpeg_decompress_struct info = {};
};

struct JpegWriter {
    explicit JpegWriter(const std::string &path) : file(open_for_writing(path)) { info.err = set_handlers(state); }
    ~JpegWriter() { jpeg_destroy_compress(&info); }
    JpegWriter(const JpegWriter &) = delete;
    JpegWriter &operator=(const JpegWriter &) = delete;

    JpegState state;
    File file;
    jpeg_compress_struct info = {};
};

[[noreturn]] void fail_reading(const std::string &path, const JpegState &state) {
    static const int unsupported[] = {JERR_BAD_PRECISION,    JERR_SOF_UNSUPPORTED,   JERR_NOT_COMPILED,
                                      JERR_ARITH_NOTIMPL,    JERR_CONVERSION_NOTIMPL, JERR_CCIR601_NOTIMPL,
                                      JERR_FRACT_SAMPLE_NOTIMPL};
    if (state.manager.msg_code == JERR_OUT_OF_MEMORY)
        throw std::bad_alloc();
    const int *end = std::end(unsupported);
    if (std::find(std::begin(unsupported), end, state.manager.msg_code) != end)
        fail_unsupported(path, std::string("unsupported kind of JPEG (") + state.text + "); convert it first");
    fail_damaged(path, state.text);
}

void read_quantisation(const jpeg_decompress_struct &info, PictureTraits &traits) {
    for (int i = 0; i < std::min(info.num_components, 2); ++i) {
        const JQUANT_TBL *table = info.quant_tbl_ptrs[info.comp_info[i].quant_tbl_no];
        if (!table) { /* comes later in the file: the writer's default will do */
            traits.quantisation.clear();
            return;
        }
        std::array<uint16_t, 64> values;
        std::copy(std::begin(table->quantval), std::end(table->quantval), values.begin());
        traits.quantisation.push_back(values);
    }
}

void read_traits(const jpeg_decompress_struct &info, PictureTraits &traits) {
    using Unit = PictureTraits::Unit;
    read_quantisation(info, traits);
    traits.progressive = info.progressive_mode != 0;
    if (info.num_components == 3) {
        traits.chroma_step_x = std::max(1, info.comp_info[0].h_samp_factor / info.comp_info[1].h_samp_factor);
        traits.chroma_step_y = std::max(1, info.comp_info[0].v_samp_factor / info.comp_info[1].v_samp_factor);
        if (traits.chroma_step_x * traits.chroma_step_y > 8) /* more than an interleaved scan may have */
            traits.chroma_step_x = traits.chroma_step_y = 2;
    }
    if (info.saw_JFIF_marker) {
        traits.x_resolution = info.X_density;
        traits.y_resolution = info.Y_density;
        traits.resolution_unit = info.density_unit == 1 ? Unit::inch : info.density_unit == 2 ? Unit::centimetre
                                                                                              : Unit::none;
    }
}

bool read_start(JpegReader &reader, Picture &picture) {
    return guarded(reader.state.jump, [&] {
        jpeg_create_decompress(&reader.info);
        jpeg_stdio_src(&reader.info, reader.file.get());
        jpeg_save_markers(&reader.info, profile_marker, 0xffff);
        jpeg_read_header(&reader.info, TRUE);
        read_traits(reader.info, picture.traits);
        JOCTET *profile = nullptr;
        unsigned bytes = 0;
        if (jpeg_read_icc_profile(&reader.info, &profile, &bytes)) {
            std::unique_ptr<JOCTET, void (*)(void *)> owner(profile, std::free);
            picture.icc.assign(profile, profile + bytes);
        }
    });
}

bool start_decoding(JpegReader &reader, const Picture &picture) {
    return guarded(reader.state.jump, [&] {
        reader.info.scale_num = 1;
        reader.info.scale_denom = picture.reduction > 1 ? 2 : 1; /* the inverse DCT averages almost for nothing */
        reader.info.out_color_space = picture.layout == LENSPROF_LAYOUT_GREY ? JCS_GRAYSCALE : JCS_RGB;
        reader.info.dct_method = JDCT_ISLOW;
        jpeg_start_decompress(&reader.info);
    });
}

bool read_rows(JpegReader &reader, RowSink &sink) {
    return guarded(reader.state.jump, [&] {
        while (reader.info.output_scanline < reader.info.output_height) {
            JSAMPROW row = sink.row();
            jpeg_read_scanlines(&reader.info, &row, 1);
            sink.accept();
        }
        jpeg_finish_decompress(&reader.info);
    });
}

void set_tables(jpeg_compress_struct &info, const PictureTraits &traits, int quality) {
    if (quality > 0 || traits.quantisation.empty()) {
        jpeg_set_quality(&info, quality > 0 ? quality : default_quality, TRUE);
        return;
    }
    const int tables = static_cast<int>(std::min<size_t>(traits.quantisation.size(), 2));
    for (int i = 0; i < tables; ++i) {
        unsigned values[64];
        std::copy(traits.quantisation[i].begin(), traits.quantisation[i].end(), values);
        jpeg_add_quant_table(&info, i, values, 100, FALSE);
    }
    for (int i = 1; i < info.num_components; ++i)
        info.comp_info[i].quant_tbl_no = tables - 1;
}

void set_density(jpeg_compress_struct &info, const PictureTraits &traits) {
    using Unit = PictureTraits::Unit;
    const Unit unit = traits.resolution_unit == Unit::metre ? Unit::centimetre : traits.resolution_unit;
    const double x = convert_resolution(traits.x_resolution, traits.resolution_unit, unit);
    const double y = convert_resolution(traits.y_resolution, traits.resolution_unit, unit);
    if (!(std::fmin(x, y) >= 0.5 && std::fmax(x, y) < 65535))
        return;
    info.density_unit = unit == Unit::inch ? 1 : unit == Unit::centimetre ? 2 : 0;
    info.X_density = static_cast<UINT16>(std::lround(x));
    info.Y_density = static_cast<UINT16>(std::lround(y));
}

void start_encoding(JpegWriter &writer, const Picture &picture, int quality) {
    jpeg_compress_struct &info = writer.info;
    const bool grey = picture.layout == LENSPROF_LAYOUT_GREY;
    jpeg_create_compress(&info);
    jpeg_stdio_dest(&info, writer.file.get());
    info.image_width = picture.width;
    info.image_height = picture.height;
    info.input_components = grey ? 1 : 3;
    info.in_color_space = grey ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(&info);
    set_tables(info, picture.traits, quality);
    set_density(info, picture.traits);
    info.comp_info[0].h_samp_factor = grey ? 1 : picture.traits.chroma_step_x;
    info.comp_info[0].v_samp_factor = grey ? 1 : picture.traits.chroma_step_y;
    info.optimize_coding = TRUE;
    info.dct_method = JDCT_ISLOW;
    if (picture.traits.progressive)
        jpeg_simple_progression(&info);
    jpeg_start_compress(&info, TRUE);
    if (!picture.icc.empty())
        jpeg_write_icc_profile(&info, picture.icc.data(), static_cast<unsigned>(picture.icc.size()));
}

void write_all(JpegWriter &writer, const Picture &picture, int quality) {
    start_encoding(writer, picture, quality);
    for (uint32_t y = 0; y < picture.height; ++y) {
        JSAMPROW row = const_cast<JSAMPROW>(picture.pixels.data() + y * picture.row_bytes);
        jpeg_write_scanlines(&writer.info, &row, 1);
    }
    jpeg_finish_compress(&writer.info);
}

}  // namespace

Picture read_jpeg(const ReadRequest &request) {
    JpegReader reader(request.path);
    Picture picture;
    picture.traits.format = FileFormat::jpeg;
    if (!read_start(reader, picture))
        fail_reading(request.path, reader.state);
    const int components = reader.info.num_components;
    if ((components != 1 && components != 3) || reader.info.jpeg_color_space == JCS_UNKNOWN)
        fail_unsupported(request.path, "CMYK or unknown kind of colour; convert it to RGB first");
    picture.sample = LENSPROF_SAMPLE_U8;
    picture.layout = components == 1 ? LENSPROF_LAYOUT_GREY : LENSPROF_LAYOUT_RGB;
    set_frame(picture, reader.info.image_width, reader.info.image_height, request);
    if (request.header_only)
        return picture;
    if (!start_decoding(reader, picture))
        fail_reading(request.path, reader.state);
    RowSink sink(picture, reader.info.output_width, picture.reduction > 1 ? 2 : 1);
    if (!read_rows(reader, sink))
        fail_reading(request.path, reader.state);
    return picture;
}

void write_jpeg(const std::string &path, const Picture &picture, int quality) {
    if (picture.sample != LENSPROF_SAMPLE_U8)
        fail_to_hold(path, "JPEG holds 8 bit samples; write a .tif or .png file");
    if (picture.layout != LENSPROF_LAYOUT_GREY && picture.layout != LENSPROF_LAYOUT_RGB)
        fail_to_hold(path, "JPEG does not hold alpha; write a .tif or .png file");
    JpegWriter writer(path);
    if (!guarded(writer.state.jump, [&] { write_all(writer, picture, quality); }))
        fail_to_write(path, writer.state.text, writer.state.error_number);
    close_written(writer.file, path);
}

}  // namespace codec

}  // namespace lensprof
