// JPEG through libjpeg-turbo. Its errors leave by longjmp: see codec::guarded.
#include "photo/pictures/codec.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <new>

#include <jpeglib.h>

#include <jerror.h>

#include "photo/base/events.hpp"
#include "photo/pictures/coefficient_file.hpp"
#include "photo/system/system.hpp"

namespace lensprof {

namespace codec {

namespace {

constexpr int profile_marker = JPEG_APP0 + 2;
constexpr int default_quality = 95;

// Error handling of libjpeg; `manager` comes first, so that a pointer to it points to this.
struct JpegState {
    jpeg_error_mgr manager;
    std::jmp_buf jump;
    char text[JMSG_LENGTH_MAX] = "";
    int error_number = 0;
    jpeg_progress_mgr progress = {};
};

[[noreturn]] void on_error(j_common_ptr info) {
    JpegState *state = reinterpret_cast<JpegState *>(info->err);
    state->error_number = info->err->msg_code == JERR_FILE_WRITE ? errno : 0;
    info->err->format_message(info, state->text);
    std::longjmp(state->jump, 1);
}

// libjpeg only warns about damage and invents the missing pixels. Other warnings are about unusual files, including
// bytes before a marker, which some cameras write as padding.
void on_message(j_common_ptr info, int level) {
    static const int damage[] = {JWRN_JPEG_EOF,       JWRN_HIT_MARKER,        JWRN_HUFF_BAD_CODE,
                                 JWRN_ARITH_BAD_CODE, JWRN_BOGUS_PROGRESSION, JWRN_MUST_RESYNC};
    if (level < 0 && std::find(std::begin(damage), std::end(damage), info->err->msg_code) != std::end(damage))
        on_error(info);
}

void on_output(j_common_ptr) {}

// For use within a call that processes the whole picture; the caller then checks the interrupt itself.
void on_progress(j_common_ptr info) {
    if (is_cancelled()) std::longjmp(reinterpret_cast<JpegState *>(info->err)->jump, 1);
}

// Call after the object was created, which clears it.
void watch_interrupts(j_common_ptr info, JpegState &state) {
    state.progress.progress_monitor = on_progress;
    info->progress = &state.progress;
}

jpeg_error_mgr *set_handlers(JpegState &state) {
    jpeg_std_error(&state.manager);
    state.manager.error_exit = on_error;
    state.manager.emit_message = on_message;
    state.manager.output_message = on_output;
    return &state.manager;
}

struct JpegReader {
    explicit JpegReader(const ReadRequest &request) : file(open(request)) {
        if (!file) throw std::bad_alloc();
        info.err = set_handlers(state);
    }
    ~JpegReader() { jpeg_destroy_decompress(&info); }
    JpegReader(const JpegReader &) = delete;
    JpegReader &operator=(const JpegReader &) = delete;

    static File open(const ReadRequest &request) {
        if (!request.bytes) return open_for_reading(request.path);
        return {system::open_bytes(request.bytes->data(), request.bytes->size()), std::fclose};
    }

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
    stop_if_cancelled();
    static const int unsupported[] = {
#if JPEG_LIB_VERSION < 70  // later ones decode it
        JERR_ARITH_NOTIMPL,
#endif
        JERR_BAD_PRECISION,
        JERR_SOF_UNSUPPORTED,
        JERR_NOT_COMPILED,
        JERR_CONVERSION_NOTIMPL,
        JERR_CCIR601_NOTIMPL,
        JERR_FRACT_SAMPLE_NOTIMPL
    };
    if (state.manager.msg_code == JERR_OUT_OF_MEMORY) throw std::bad_alloc();
    constexpr int lossless_frame = 0xf7;  // SOF55 of ITU-T T.87
    if (state.manager.msg_code == JERR_UNKNOWN_MARKER && state.manager.msg_parm.i[0] == lossless_frame)
        fail_unsupported(path, "unsupported kind of JPEG (JPEG-LS); convert it first");
    const int *end = std::end(unsupported);
    if (std::find(std::begin(unsupported), end, state.manager.msg_code) != end)
        fail_unsupported(path, std::string("unsupported kind of JPEG (") + state.text + "); convert it first");
    fail_damaged(path, state.text);
}

void read_quantisation(const jpeg_decompress_struct &info, PictureTraits &traits) {
    for (int i = 0; i < std::min(info.num_components, 2); ++i) {
        const int number = info.comp_info[i].quant_tbl_no;  // as in the file: libjpeg has not examined it yet
        const JQUANT_TBL *table = number >= 0 && number < NUM_QUANT_TBLS ? info.quant_tbl_ptrs[number] : nullptr;
        if (!table) {  // comes later in the file: the default of the writer is used
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
        if (traits.chroma_step_x * traits.chroma_step_y > 8)  // more than an interleaved scan can have
            traits.chroma_step_x = traits.chroma_step_y = 2;
    }
    if (info.saw_JFIF_marker) {
        traits.x_resolution = info.X_density;
        traits.y_resolution = info.Y_density;
        traits.resolution_unit = info.density_unit == 1   ? Unit::inch
                                 : info.density_unit == 2 ? Unit::centimetre
                                                          : Unit::none;
    }
}

void read_start(JpegReader &reader, Picture &picture) {
    jpeg_create_decompress(&reader.info);
    watch_interrupts(reinterpret_cast<j_common_ptr>(&reader.info), reader.state);
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
}

void set_decoding(JpegReader &reader, const Picture &picture) {
    reader.info.scale_num = 1;
    reader.info.scale_denom = picture.reduction > 1 ? 2 : 1;  // averaging in the inverse DCT costs almost nothing
    reader.info.out_color_space = picture.layout == LENSPROF_LAYOUT_GREY ? JCS_GRAYSCALE : JCS_RGB;
    reader.info.dct_method = JDCT_ISLOW;
    jpeg_calc_output_dimensions(&reader.info);
}

class JpegSource final : public RowSource {
public:
    explicit JpegSource(const ReadRequest &request);
    uint32_t halved() const override { return header_.reduction > 1 ? 2 : 1; }
    uint32_t row_count() const override { return reader_.info.output_height; }
    uint32_t row_width() const override { return reader_.info.output_width; }
    void read(uint8_t *row) override;
    void finish() override;

private:
    template <class Body>
    void run(const Body &body) {
        if (!guarded(reader_.state.jump, body)) fail_reading(path_, reader_.state);
    }

    std::string path_;
    JpegReader reader_;
    bool started_ = false;
};

JpegSource::JpegSource(const ReadRequest &request) : path_(request.path), reader_(request) {
    header_.traits.format = FileFormat::jpeg;
    header_.traits.is_lossy = true;
    run([&] { read_start(reader_, header_); });
    const int components = reader_.info.num_components;
    if ((components != 1 && components != 3) || reader_.info.jpeg_color_space == JCS_UNKNOWN)
        fail_unsupported(path_, "CMYK or unknown colour space; convert it to RGB first");
    header_.sample = LENSPROF_SAMPLE_U8;
    header_.layout = components == 1 ? LENSPROF_LAYOUT_GREY : LENSPROF_LAYOUT_RGB;
    set_frame(header_, reader_.info.image_width, reader_.info.image_height, request);
    run([&] { set_decoding(reader_, header_); });
}

void JpegSource::read(uint8_t *row) {
    run([&] {
        if (!started_) {
            started_ = true;
            jpeg_start_decompress(&reader_.info);
        }
        jpeg_read_scanlines(&reader_.info, &row, 1);
    });
}

void JpegSource::finish() {
    run([&] { jpeg_finish_decompress(&reader_.info); });
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
    for (int i = 1; i < info.num_components; ++i) info.comp_info[i].quant_tbl_no = tables - 1;
}

void set_density(jpeg_compress_struct &info, const PictureTraits &traits) {
    using Unit = PictureTraits::Unit;
    const Unit unit = traits.resolution_unit == Unit::metre ? Unit::centimetre : traits.resolution_unit;
    const double x = convert_resolution(traits.x_resolution, traits.resolution_unit, unit);
    const double y = convert_resolution(traits.y_resolution, traits.resolution_unit, unit);
    if (!(std::fmin(x, y) >= 0.5 && std::fmax(x, y) < 65535)) return;
    info.density_unit = unit == Unit::inch ? 1 : unit == Unit::centimetre ? 2 : 0;
    info.X_density = static_cast<UINT16>(std::lround(x));
    info.Y_density = static_cast<UINT16>(std::lround(y));
}

void start_encoding(JpegWriter &writer, CoefficientFile &coefficients, const Picture &picture, int quality) {
    jpeg_compress_struct &info = writer.info;
    const bool grey = picture.layout == LENSPROF_LAYOUT_GREY;
    jpeg_create_compress(&info);
    watch_interrupts(reinterpret_cast<j_common_ptr>(&info), writer.state);
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
    if (picture.traits.progressive) jpeg_simple_progression(&info);
    coefficients.attach(info);
    jpeg_start_compress(&info, TRUE);
    if (!picture.icc.empty())
        jpeg_write_icc_profile(&info, picture.icc.data(), static_cast<unsigned>(picture.icc.size()));
}

class JpegSink final : public RowSink {
public:
    JpegSink(const std::string &path, const Picture &header, int quality)
        : path_(path), coefficients_(path), writer_(path) {
        run([&] { start_encoding(writer_, coefficients_, header, quality); });
    }

    void write(const uint8_t *row) override {
        JSAMPROW rows[] = {const_cast<JSAMPROW>(row)};
        run([&] { jpeg_write_scanlines(&writer_.info, rows, 1); });
    }

    void finish() override {
        run([&] { jpeg_finish_compress(&writer_.info); });
        close_written(writer_.file, path_);
    }

private:
    template <class Body>
    void run(const Body &body) {
        if (guarded(writer_.state.jump, body)) return;
        stop_if_cancelled();
        fail_to_write(path_, writer_.state.text, writer_.state.error_number);
    }

    std::string path_;
    CoefficientFile coefficients_;
    JpegWriter writer_;
};

}  // namespace

std::unique_ptr<RowSource> open_jpeg(const ReadRequest &request) { return std::make_unique<JpegSource>(request); }

std::unique_ptr<RowSink> create_jpeg(const std::string &path, const Picture &header, int quality) {
    if (header.sample != LENSPROF_SAMPLE_U8) fail_to_hold(path, "JPEG holds 8 bit samples; write a .tif or .png file");
    if (header.layout != LENSPROF_LAYOUT_GREY && header.layout != LENSPROF_LAYOUT_RGB)
        fail_to_hold(path, "JPEG does not hold alpha; write a .tif or .png file");
    return std::make_unique<JpegSink>(path, header, quality);
}

}  // namespace codec

}  // namespace lensprof
