#include "picture_files.hpp"

namespace picture_files {

size_t files_in_folder() {
    return static_cast<size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

Bytes load(const std::string &path) {
    std::ifstream file(path, std::ios::binary);
    Bytes bytes;
    char block[65536];
    do {
        file.read(block, sizeof block);
        bytes.insert(bytes.end(), block, block + file.gcount());
    } while (file);
    return bytes;
}

void save(const std::string &path, const Bytes &bytes) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char *>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

std::string failure_of(lensprof_status status, const std::function<void()> &call) {
    try {
        call();
    } catch (const Failure &failure) {
        if (failure.group() != status) fail_msg("%s: %s", failure.what(), lensprof_status_name(failure.status));
        return failure.what();
    }
    fail_msg("no Failure");
    return std::string();
}

void assert_failure(lensprof_status status, const std::string &part, const std::function<void()> &call) {
    const std::string text = failure_of(status, call);
    if (text.find(part) == std::string::npos) fail_msg("'%s' does not contain '%s'", text.c_str(), part.c_str());
}

Bytes make_profile(bool grey, size_t size) {
    Bytes profile(size, 0);
    const auto put = [&](size_t at, const char *text) { std::copy(text, text + 4, profile.begin() + long(at)); };
    for (int i = 0; i < 4; ++i) profile[size_t(i)] = static_cast<uint8_t>(size >> (24 - 8 * i));
    profile[8] = 2;
    put(12, "mntr");
    put(16, grey ? "GRAY" : "RGB ");
    put(20, "XYZ ");
    put(36, "acsp");
    const uint8_t d50[] = {0, 0, 0xf6, 0xd6, 0, 1, 0, 0, 0, 0, 0xd3, 0x2d};
    std::copy(std::begin(d50), std::end(d50), profile.begin() + 68);
    for (size_t i = 132; i < size; ++i) profile[i] = static_cast<uint8_t>(i * 7 + i / 256);
    return profile;
}

Picture make_noise(uint32_t width, uint32_t height, uint32_t sample, uint32_t layout) {
    Picture picture;
    picture.width = picture.frame_width = width;
    picture.height = picture.frame_height = height;
    picture.sample = sample;
    picture.layout = layout;
    picture.row_bytes = width * lensprof_layout_samples(layout) * lensprof_sample_type_bytes(sample);
    picture.pixels.resize(picture.row_bytes * height);
    uint64_t state = width + 31 * height + sample;
    for (uint8_t &byte : picture.pixels) byte = static_cast<uint8_t>(256 * lp_random(&state));
    if (sample == LENSPROF_SAMPLE_F32) {
        float *values = reinterpret_cast<float *>(picture.pixels.data());
        for (size_t i = 0; i < picture.pixels.size() / 4; ++i)
            values[i] = static_cast<float>(lp_random(&state) * 1.5 - 0.2);
    }
    return picture;
}

Picture make_smooth(uint32_t width, uint32_t height, uint32_t layout) {
    Picture picture = make_noise(width, height, LENSPROF_SAMPLE_U8, layout);
    const uint32_t samples = lensprof_layout_samples(layout);
    for (uint32_t y = 0; y < height; ++y) {
        for (uint32_t x = 0; x < width; ++x) {
            for (uint32_t c = 0; c < samples; ++c)
                picture.pixels[y * picture.row_bytes + x * samples + c] =
                    static_cast<uint8_t>(120 + 60 * sin(x * 0.02 + c) + 50 * cos(y * 0.03 - c));
        }
    }
    return picture;
}

void assert_same_pixels(const Picture &a, const Picture &b) {
    assert_int_equal(a.width, b.width);
    assert_int_equal(a.height, b.height);
    assert_int_equal(a.sample, b.sample);
    assert_int_equal(a.layout, b.layout);
    assert_int_equal(a.row_bytes, b.row_bytes);
    assert_int_equal(a.pixels.size(), b.pixels.size());
    assert_memory_equal(a.pixels.data(), b.pixels.data(), a.pixels.size());
}

void assert_near_pixels(const Picture &a, const Picture &b, int levels) {
    assert_int_equal(a.pixels.size(), b.pixels.size());
    for (size_t i = 0; i < a.pixels.size(); ++i) assert_true(std::abs(a.pixels[i] - b.pixels[i]) <= levels);
}

void write_block(TIFF *tiff, const Picture &picture, uint32_t x0, uint32_t y0, uint32_t width, uint32_t height,
                 int plane) {
    const uint32_t samples = lensprof_layout_samples(picture.layout),
                   bytes = lensprof_sample_type_bytes(picture.sample);
    Bytes block;
    for (uint32_t y = y0; y < y0 + height; ++y) {
        for (uint32_t x = x0; x < x0 + width; ++x) {
            const uint8_t *pixel = picture.pixels.data() + std::min(y, picture.height - 1) * picture.row_bytes
                                   + std::min(x, picture.width - 1) * size_t(samples) * bytes;
            if (plane < 0)
                block.insert(block.end(), pixel, pixel + samples * bytes);
            else
                block.insert(block.end(), pixel + unsigned(plane) * bytes, pixel + (unsigned(plane) + 1) * bytes);
        }
    }
    const uint16_t s = static_cast<uint16_t>(std::max(plane, 0));
    const tmsize_t size = static_cast<tmsize_t>(block.size());
    if (TIFFIsTiled(tiff))
        assert_true(TIFFWriteEncodedTile(tiff, TIFFComputeTile(tiff, x0, y0, 0, s), block.data(), size) == size);
    else
        assert_true(TIFFWriteEncodedStrip(tiff, TIFFComputeStrip(tiff, y0, s), block.data(), size) == size);
}

void write_tiff_file(const std::string &path, const Picture &picture, const TiffKind &kind) {
    TIFF *tiff = TIFFOpen(path.c_str(), kind.mode);
    assert_non_null(tiff);
    const uint32_t samples = lensprof_layout_samples(picture.layout);
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, picture.width);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, picture.height);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, kind.bits ? kind.bits : 8 * lensprof_sample_type_bytes(picture.sample));
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, picture.sample == LENSPROF_SAMPLE_F32 ? SAMPLEFORMAT_IEEEFP : kind.format);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, samples);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, kind.planar);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, kind.compression);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC,
                 samples > 2 && kind.photometric < PHOTOMETRIC_RGB ? PHOTOMETRIC_RGB : kind.photometric);
    if (kind.compression == COMPRESSION_JPEG && samples == 3) {
        TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_YCBCR);
        TIFFSetField(tiff, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
        TIFFSetField(tiff, TIFFTAG_JPEGQUALITY, 95);
    }
    const uint16_t extra = EXTRASAMPLE_ASSOCALPHA;
    if (samples % 2 == 0) TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &extra);
    if (kind.tile) {
        TIFFSetField(tiff, TIFFTAG_TILEWIDTH, kind.tile);
        TIFFSetField(tiff, TIFFTAG_TILELENGTH, kind.tile);
    } else {
        TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, kind.rows_per_strip);
    }
    const bool separate = kind.planar == PLANARCONFIG_SEPARATE;
    const uint32_t step_x = kind.tile ? kind.tile : picture.width, step_y = kind.tile ? kind.tile : kind.rows_per_strip;
    for (int plane = separate ? 0 : -1; plane < (separate ? int(samples) : 0); ++plane) {
        for (uint32_t y = 0; y < picture.height; y += step_y) {
            for (uint32_t x = 0; x < picture.width; x += step_x)
                write_block(tiff, picture, x, y, step_x, kind.tile ? step_y : std::min(step_y, picture.height - y),
                            plane);
        }
    }
    TIFFClose(tiff);
}

void write_png_file(const std::string &path, const PngKind &kind, Bytes &packed) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    std::FILE *file = std::fopen(path.c_str(), "wb");
    png_init_io(png, file);
    png_set_IHDR(png, info, kind.width, kind.height, kind.bits, kind.colour, kind.interlace, 0, 0);
    kind.extra(png, info);
    png_write_info(png, info);
    std::vector<png_bytep> rows(kind.height);
    for (size_t y = 0; y < kind.height; ++y) rows[y] = packed.data() + y * (packed.size() / kind.height);
    png_write_image(png, rows.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    std::fclose(file);
}

void write_jpeg_file(const std::string &path, const Picture &picture, const JpegKind &kind) {
    jpeg_compress_struct info;
    jpeg_error_mgr errors;
    info.err = jpeg_std_error(&errors);
    jpeg_create_compress(&info);
    std::FILE *file = std::fopen(path.c_str(), "wb");
    jpeg_stdio_dest(&info, file);
    info.image_width = picture.width;
    info.image_height = picture.height;
    info.input_components = int(lensprof_layout_samples(picture.layout));
    info.in_color_space = kind.cmyk ? JCS_CMYK : info.input_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(&info);
    jpeg_set_quality(&info, kind.quality, TRUE);
    info.comp_info[0].h_samp_factor = info.input_components == 1 ? 1 : kind.step_x;
    info.comp_info[0].v_samp_factor = info.input_components == 1 ? 1 : kind.step_y;
    info.optimize_coding = kind.best_tables;
    if (kind.progressive) jpeg_simple_progression(&info);
    jpeg_start_compress(&info, TRUE);
    for (size_t y = 0; y < picture.height; ++y) {
        JSAMPROW row = const_cast<JSAMPROW>(picture.pixels.data() + y * picture.row_bytes);
        jpeg_write_scanlines(&info, &row, 1);
    }
    jpeg_finish_compress(&info);
    jpeg_destroy_compress(&info);
    std::fclose(file);
}

int make_folder(void **) {
    std::string name = (fs::temp_directory_path() / "lensprof-pictures-XXXXXX").string();
    if (!mkdtemp(name.data())) return -1;
    folder = name;
    return 0;
}

int remove_folder(void **) {
    fs::remove_all(folder);
    return 0;
}

int empty_folder(void **) {
    for (const fs::directory_entry &entry : fs::directory_iterator(folder)) fs::remove_all(entry.path());
    return 0;
}

}  // namespace picture_files
