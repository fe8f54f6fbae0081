// Picture files: round trips, all kinds of files that the libraries can write, reduced reading.
#include "picture_files.hpp"

#include <algorithm>
#include <cmath>

using namespace picture_files;

namespace {

double value_of(const Picture &picture, uint32_t x, uint32_t y, uint32_t c) {
    const size_t i = size_t(x) * lensprof_layout_samples(picture.layout) + c;
    const uint8_t *row = picture.pixels.data() + y * picture.row_bytes;
    return picture.sample == LENSPROF_SAMPLE_U8    ? row[i]
           : picture.sample == LENSPROF_SAMPLE_U16 ? reinterpret_cast<const uint16_t *>(row)[i]
                                                   : double(reinterpret_cast<const float *>(row)[i]);
}

// Whether all samples of reduced pixel (x, y) are the mean of the middle two of the 2 x 2 pixels from (u, v) on, within
// rounding.
bool is_middle_of(const Picture &full, const Picture &small, uint32_t x, uint32_t y, uint32_t u, uint32_t v,
                  double tolerance) {
    for (uint32_t c = 0; c < lensprof_layout_samples(full.layout); ++c) {
        double values[4];
        for (uint32_t i = 0; i < 4; ++i) values[i] = value_of(full, u + i % 2, v + i / 2, c);
        std::sort(values, values + 4);
        const double mean = (values[1] + values[2]) / 2;
        const double rounded = full.sample == LENSPROF_SAMPLE_F32 ? double(float(mean)) : floor(mean + 0.5);
        if (!(std::fabs(value_of(small, x, y, c) - rounded) <= tolerance + 1e-7)) return false;
    }
    return true;
}

// Every pixel of `small` must be such a middle of a 2 x 2 block in its square of `full`.
void assert_reduced(const Picture &full, const Picture &small, uint32_t step, double tolerance) {
    assert_int_equal(small.reduction, step);
    assert_int_equal(small.width, full.width / step);
    assert_int_equal(small.height, full.height / step);
    assert_int_equal(small.frame_width, full.width);
    assert_int_equal(small.frame_height, full.height);
    assert_int_equal(small.pixels.size(), small.row_bytes * small.height);
    if (step == 1) assert_same_pixels(full, small);
    for (uint32_t i = 0; step > 1 && i < small.width * small.height; ++i) {
        const uint32_t x = i % small.width, y = i / small.width;
        bool found = false;
        for (uint32_t v = y * step; v < (y + 1) * step; v += 2)
            for (uint32_t u = x * step; u < (x + 1) * step; u += 2)
                found = found || is_middle_of(full, small, x, y, u, v, tolerance);
        if (!found) fail_msg("pixel %u, %u reduced by %u is not the middle of a block of its square", x, y, step);
    }
}

// Tests: round trips.

void test_png_round_trip(void **) {
    for (uint32_t layout = LENSPROF_LAYOUT_GREY; layout <= LENSPROF_LAYOUT_RGBA; ++layout) {
        for (uint32_t sample : {LENSPROF_SAMPLE_U8, LENSPROF_SAMPLE_U16}) {
            Picture picture = make_noise(37, 23, sample, layout);
            picture.icc = make_profile(layout < LENSPROF_LAYOUT_RGB, 400);
            picture.traits.x_resolution = picture.traits.y_resolution = 300;
            picture.traits.resolution_unit = PictureTraits::Unit::inch;
            write_picture(in_folder("a.PNG"), picture);
            const Picture again = read_picture(in_folder("a.PNG"));
            assert_same_pixels(picture, again);
            assert_true(again.icc == picture.icc);
            assert_close(again.traits.x_resolution, 300 / 0.0254, 0.5);
            assert_int_equal(again.frame_width, 37);
            assert_int_equal(again.reduction, 1);
        }
    }
}

void test_png_keeps_colour_chunks(void **) {
    Picture picture = make_noise(5, 4, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB);
    picture.traits.has_gamma = picture.traits.has_chromaticities = true;
    picture.traits.gamma = 55555;
    picture.traits.chromaticities = {31270, 32900, 60000, 30000, 20000, 70000, 15000, 5000};
    write_picture(in_folder("a.png"), picture);
    const PictureTraits gamma = read_picture(in_folder("a.png")).traits;
    assert_true(gamma.has_gamma && gamma.has_chromaticities && !gamma.has_srgb);
    assert_int_equal(gamma.gamma, 55555);
    assert_true(gamma.chromaticities == picture.traits.chromaticities);

    picture.traits = PictureTraits();
    picture.traits.has_srgb = true;
    picture.traits.srgb_intent = 1;
    write_picture(in_folder("a.png"), picture);
    write_picture(in_folder("b.png"), read_picture(in_folder("a.png")));
    const PictureTraits srgb = read_picture(in_folder("b.png")).traits;
    assert_true(srgb.has_srgb);
    assert_int_equal(srgb.srgb_intent, 1);
}

void test_tiff_round_trip(void **) {
    using Alpha = PictureTraits::Alpha;
    const Alpha alphas[] = {Alpha::unspecified, Alpha::associated, Alpha::unassociated};
    const uint16_t compressions[] = {COMPRESSION_NONE,     COMPRESSION_LZW,  COMPRESSION_ADOBE_DEFLATE,
                                     COMPRESSION_PACKBITS, COMPRESSION_LZMA, COMPRESSION_ZSTD,
                                     COMPRESSION_DEFLATE};
    int run = 0;
    for (uint16_t compression : compressions) {
        if (!TIFFIsCODECConfigured(compression)) continue;
        for (uint32_t layout = LENSPROF_LAYOUT_GREY; layout <= LENSPROF_LAYOUT_RGBA; ++layout) {
            for (uint32_t sample : {LENSPROF_SAMPLE_U8, LENSPROF_SAMPLE_U16, LENSPROF_SAMPLE_F32}) {
                Picture picture = make_noise(41, 29, sample, layout);
                picture.icc = make_profile(layout < LENSPROF_LAYOUT_RGB, 400);
                picture.traits.compression = compression;
                picture.traits.alpha = alphas[run++ % 3];
                picture.traits.orientation = 6;
                picture.traits.x_resolution = 254;
                picture.traits.y_resolution = 127;
                picture.traits.resolution_unit = PictureTraits::Unit::centimetre;
                const Picture before = picture;
                write_picture(in_folder("a.tif"), picture);
                assert_same_pixels(before, picture);
                const Picture again = read_picture(in_folder("a.tif"));
                assert_same_pixels(picture, again);
                assert_true(again.icc == picture.icc);
                assert_int_equal(again.traits.compression, compression);
                if (layout % 2 == 1) assert_true(again.traits.alpha == picture.traits.alpha);
                assert_int_equal(again.traits.orientation, 6);
                assert_close(again.traits.x_resolution, 254, 1e-4);
                assert_close(again.traits.y_resolution, 127, 1e-4);
                assert_true(again.traits.resolution_unit == PictureTraits::Unit::centimetre);
            }
        }
    }
}

void test_tiff_keeps_not_finite(void **) {
    Picture picture = make_noise(16, 9, LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_RGB);
    float *values = reinterpret_cast<float *>(picture.pixels.data());
    values[0] = NAN;
    values[7] = INFINITY;
    values[100] = -INFINITY;
    write_picture(in_folder("a.tiff"), picture);
    assert_same_pixels(picture, read_picture(in_folder("a.tiff")));
}

void test_jpeg_round_trip(void **) {
    for (uint32_t layout : {LENSPROF_LAYOUT_GREY, LENSPROF_LAYOUT_RGB}) {
        Picture picture = make_smooth(133, 87, layout);
        picture.icc = make_profile(layout == LENSPROF_LAYOUT_GREY, 200000);  // more than fits into one segment
        picture.traits.x_resolution = picture.traits.y_resolution = 300;
        picture.traits.resolution_unit = PictureTraits::Unit::inch;
        write_picture(in_folder("a.jpg"), picture);
        const Picture again = read_picture(in_folder("a.jpg"));
        assert_int_equal(again.layout, layout);
        assert_near_pixels(picture, again, 3);
        assert_true(again.icc == picture.icc);
        assert_close(again.traits.x_resolution, 300, 0);
        assert_true(again.traits.resolution_unit == PictureTraits::Unit::inch);
        assert_int_equal(again.traits.chroma_step_x, 1);
    }
}

// A rewritten file keeps quality, subsampling and coding of its source; an explicit quality takes precedence.
void test_jpeg_keeps_coding(void **) {
    const Picture picture = make_smooth(64, 48, LENSPROF_LAYOUT_RGB);
    for (const JpegKind &kind : {JpegKind{60, 2, 2, false, false}, JpegKind{85, 2, 1, true, false}}) {
        write_jpeg_file(in_folder("a.jpg"), picture, kind);
        const Picture first = read_picture(in_folder("a.jpg"));
        write_picture(in_folder("b.jpg"), first);
        const Picture second = read_picture(in_folder("b.jpg"));
        assert_int_equal(first.traits.quantisation.size(), 2);
        assert_true(first.traits.quantisation == second.traits.quantisation);
        assert_int_equal(second.traits.chroma_step_x, kind.step_x);
        assert_int_equal(second.traits.chroma_step_y, kind.step_y);
        assert_true(second.traits.progressive == kind.progressive);
    }
    WriteOptions options;
    options.jpeg_quality = 100;
    write_picture(in_folder("b.jpg"), read_picture(in_folder("a.jpg")), options);
    assert_int_equal(read_picture(in_folder("b.jpg")).traits.quantisation[0][0], 1);
}

// More coefficients than are held in memory: the file equals libjpeg's with all of them in memory.
void test_large_jpeg(void **) {
    const Picture noise = make_noise(1400, 1301, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB),
                  smooth = make_smooth(1404, 2000, LENSPROF_LAYOUT_RGB),
                  grey = make_smooth(4001, 2100, LENSPROF_LAYOUT_GREY);
    for (const bool progressive : {false, true})
        for (const int step : {1, 2})
            for (const Picture *kind : {&noise, &smooth, &grey}) {
                Picture picture = *kind;
                const uint64_t samples = uint64_t(picture.width) * picture.height;
                picture.traits.chroma_step_x = picture.traits.chroma_step_y = step;
                picture.traits.progressive = progressive;
                write_jpeg_file(in_folder("b.jpg"), picture, {95, step, step, progressive, false, true});
                write_picture(in_folder("a.jpg"), picture);
                assert_true(load(in_folder("a.jpg")) == load(in_folder("b.jpg")));
                if (step == 1 && kind != &noise)  // the test needs such pictures
                    assert_true(samples * 2 * lensprof_layout_channels(picture.layout) > jpeg_memory_bytes);
            }
}

// Tests: kinds of files.

// Packs bits from the highest down, as PNG does.
Bytes pack(const std::vector<int> &values, uint32_t width, int bits) {
    const size_t row_bytes = (width * unsigned(bits) + 7) / 8;
    Bytes packed(row_bytes * (values.size() / width), 0);
    for (size_t i = 0; i < values.size(); ++i) {
        const size_t bit = i % width * unsigned(bits);
        packed[i / width * row_bytes + bit / 8] |= static_cast<uint8_t>(values[i] << (8 - unsigned(bits) - bit % 8));
    }
    return packed;
}

void test_png_palette(void **) {
    const uint32_t width = 13, height = 5;
    for (int bits : {1, 2, 4, 8}) {
        const int colours = std::min(1 << bits, 200);
        std::vector<png_color> palette;
        for (int i = 0; i < colours; ++i) palette.push_back({png_byte(i), png_byte(255 - i), png_byte(i * 7)});
        Bytes alpha = {10, 200};
        std::vector<int> values;
        for (uint32_t i = 0; i < width * height; ++i) values.push_back(int(i * 5 % unsigned(colours)));
        Bytes packed = pack(values, width, bits);
        for (bool transparent : {false, true}) {
            const auto extra = [&](png_structp p, png_infop i) {
                png_set_PLTE(p, i, palette.data(), colours);
                if (transparent) png_set_tRNS(p, i, alpha.data(), 2, nullptr);
            };
            PngKind kind{width, height, bits, PNG_COLOR_TYPE_PALETTE, PNG_INTERLACE_NONE, extra};
            write_png_file(in_folder("a.png"), kind, packed);
            const Picture picture = read_picture(in_folder("a.png"));
            assert_int_equal(picture.layout, transparent ? LENSPROF_LAYOUT_RGBA : LENSPROF_LAYOUT_RGB);
            const size_t samples = transparent ? 4 : 3;
            for (size_t i = 0; i < values.size(); ++i) {
                const uint8_t *pixel = picture.pixels.data() + i * samples;
                assert_int_equal(pixel[0], palette[size_t(values[i])].red);
                assert_int_equal(pixel[1], palette[size_t(values[i])].green);
                assert_int_equal(pixel[2], palette[size_t(values[i])].blue);
                if (transparent) assert_int_equal(pixel[3], values[i] < 2 ? alpha[size_t(values[i])] : 255);
            }
        }
    }
}

void test_png_grey_bits(void **) {
    const uint32_t width = 11, height = 4;
    for (int bits : {1, 2, 4}) {
        std::vector<int> values;
        for (int i = 0; i < int(width * height); ++i) values.push_back(i % (1 << bits));
        Bytes packed = pack(values, width, bits);
        png_color_16 transparent = {};
        transparent.gray = 1;
        PngKind kind{width, height, bits, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, [&](png_structp p, png_infop i) {
                         png_set_tRNS(p, i, nullptr, 0, &transparent);
                     }};
        write_png_file(in_folder("a.png"), kind, packed);
        const Picture picture = read_picture(in_folder("a.png"));
        assert_int_equal(picture.layout, LENSPROF_LAYOUT_GREY_ALPHA);
        for (size_t i = 0; i < values.size(); ++i) {
            assert_int_equal(picture.pixels[2 * i], values[i] * 255 / ((1 << bits) - 1));
            assert_int_equal(picture.pixels[2 * i + 1], values[i] == 1 ? 0 : 255);
        }
    }
}

// 16 bit samples are big-endian in the file; interlaced rows are read in order.
void test_png_deep_interlaced(void **) {
    const uint32_t width = 19, height = 14;
    Bytes bytes(width * height * 6);
    uint64_t state = 5;
    for (uint8_t &byte : bytes) byte = static_cast<uint8_t>(256 * lp_random(&state));
    for (int interlace : {PNG_INTERLACE_NONE, PNG_INTERLACE_ADAM7}) {
        PngKind kind{width, height, 16, PNG_COLOR_TYPE_RGB, interlace, [](png_structp, png_infop) {}};
        write_png_file(in_folder("a.png"), kind, bytes);
        const Picture picture = read_picture(in_folder("a.png"));
        assert_int_equal(picture.sample, LENSPROF_SAMPLE_U16);
        for (uint32_t i = 0; i < width * height * 3; ++i)
            assert_close(value_of(picture, i / 3 % width, i / 3 / width, i % 3), bytes[2 * i] * 256 + bytes[2 * i + 1],
                         0);
        ReadOptions options;
        options.max_side = 6;
        assert_reduced(picture, read_picture(in_folder("a.png"), options), 2, 0);
    }
}

void test_tiff_kinds(void **) {
    for (const char *mode : {"wl", "wb", "w8"}) {
        for (uint32_t layout = LENSPROF_LAYOUT_GREY; layout <= LENSPROF_LAYOUT_RGBA; ++layout) {
            for (uint32_t sample : {LENSPROF_SAMPLE_U8, LENSPROF_SAMPLE_U16, LENSPROF_SAMPLE_F32}) {
                const Picture picture = make_noise(45, 38, sample, layout);
                for (uint16_t planar : {PLANARCONFIG_CONTIG, PLANARCONFIG_SEPARATE}) {
                    for (uint32_t tile : {0u, 16u, 64u}) {
                        TiffKind kind{mode, COMPRESSION_LZW, planar};
                        kind.tile = tile;
                        write_tiff_file(in_folder("a.tif"), picture, kind);
                        const Picture full = read_picture(in_folder("a.tif"));
                        assert_same_pixels(picture, full);
                        ReadOptions options;
                        options.max_side = 11;
                        assert_reduced(full, read_picture(in_folder("a.tif"), options), 4, 0);
                    }
                }
            }
        }
    }
}

void test_tiff_min_is_white(void **) {
    for (uint32_t sample : {LENSPROF_SAMPLE_U8, LENSPROF_SAMPLE_U16, LENSPROF_SAMPLE_F32}) {
        const Picture picture = make_noise(21, 17, sample, LENSPROF_LAYOUT_GREY_ALPHA);
        TiffKind kind;
        kind.photometric = PHOTOMETRIC_MINISWHITE;
        write_tiff_file(in_folder("a.tif"), picture, kind);
        const Picture again = read_picture(in_folder("a.tif"));
        const double white = sample == LENSPROF_SAMPLE_U8 ? 255 : sample == LENSPROF_SAMPLE_U16 ? 65535 : 1;
        for (uint32_t i = 0; i < 21 * 17; ++i) {
            assert_close(value_of(again, i % 21, i / 21, 0), white - value_of(picture, i % 21, i / 21, 0), 1e-7);
            assert_close(value_of(again, i % 21, i / 21, 1), value_of(picture, i % 21, i / 21, 1), 0);
        }
    }
}

// JPEG in TIFF is read as RGB, and is not written again with losses.
void test_tiff_jpeg(void **) {
    const Picture picture = make_smooth(96, 64, LENSPROF_LAYOUT_RGB);
    for (uint32_t tile : {0u, 32u}) {
        TiffKind kind;
        kind.compression = COMPRESSION_JPEG;
        kind.tile = tile;
        kind.rows_per_strip = 16;
        write_tiff_file(in_folder("a.tif"), picture, kind);
        const Picture again = read_picture(in_folder("a.tif"));
        assert_near_pixels(picture, again, 6);
        write_picture(in_folder("b.tif"), again);
        assert_same_pixels(again, read_picture(in_folder("b.tif")));
        assert_int_equal(read_header(in_folder("b.tif")).traits.compression, COMPRESSION_ADOBE_DEFLATE);
    }
}

void test_reduced_lossless(void **) {
    for (const char *name : {"a.png", "a.tif"}) {
        for (uint32_t sample : {LENSPROF_SAMPLE_U8, LENSPROF_SAMPLE_U16, LENSPROF_SAMPLE_F32}) {
            if (sample == LENSPROF_SAMPLE_F32 && name[2] == 'p') continue;
            const Picture full = make_noise(101, 67, sample, LENSPROF_LAYOUT_RGBA);
            write_picture(in_folder(name), full);
            for (uint32_t max_side : {100u, 50u, 49u, 20u, 3u, 1u}) {
                ReadOptions options;
                options.max_side = max_side;
                const uint32_t wanted = std::min(101 / max_side, 67u), step = wanted > 1 ? wanted / 2 * 2 : 1;
                assert_reduced(full, read_picture(in_folder(name), options), step, 0);
                assert_int_equal(read_header(in_folder(name), options).width, 101 / step);
            }
            ReadOptions larger;
            larger.max_side = 500;
            assert_same_pixels(full, read_picture(in_folder(name), larger));
        }
    }
}

void test_reduced_jpeg(void **) {
    for (uint32_t layout : {LENSPROF_LAYOUT_GREY, LENSPROF_LAYOUT_RGB}) {
        write_jpeg_file(in_folder("a.jpg"), make_smooth(203, 150, layout), JpegKind());
        const Picture full = read_picture(in_folder("a.jpg"));
        for (uint32_t wanted : {1u, 2u, 3u, 4u, 5u, 6u, 8u, 16u, 25u}) {
            ReadOptions options;
            options.max_side = 203 / wanted;
            const uint32_t step = wanted > 1 ? wanted / 2 * 2 : 1;
            assert_reduced(full, read_picture(in_folder("a.jpg"), options), step, step > 1 ? 2 : 0);
            assert_int_equal(read_header(in_folder("a.jpg"), options).width, 203 / step);
        }
    }
}

// Progressive files and halved chroma reduce in the same way.
void test_reduced_jpeg_kinds(void **) {
    for (int chroma : {1, 2})
        for (bool progressive : {false, true}) {
            Picture picture = make_smooth(160, 120, LENSPROF_LAYOUT_RGB);
            picture.traits.chroma_step_x = picture.traits.chroma_step_y = chroma;
            picture.traits.progressive = progressive;
            write_picture(in_folder("a.jpg"), picture);
            const Picture full = read_picture(in_folder("a.jpg"));
            assert_true(full.traits.progressive == progressive && full.traits.chroma_step_y == chroma);
            for (uint32_t step : {2u, 4u, 8u}) {
                ReadOptions options;
                options.max_side = 160 / step;
                assert_reduced(full, read_picture(in_folder("a.jpg"), options), step, 3);
            }
        }
}

// On a slope, patches of 5 x 5 reduced pixels have the mean of their squares' middles: neighbours compensate for the
// offset of each pixel.
void test_reduced_is_not_shifted(void **) {
    for (uint32_t step : {4u, 6u, 8u, 14u})
        for (bool down : {false, true}) {
            Picture full = make_noise(40 * step, 40 * step, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY);
            for (uint32_t y = 0; y < full.height; ++y)
                for (uint32_t x = 0; x < full.width; ++x)
                    reinterpret_cast<uint16_t *>(full.pixels.data() + y * full.row_bytes)[x] =
                        static_cast<uint16_t>(100 * (down ? y : x));
            write_picture(in_folder("a.png"), full);
            ReadOptions options;
            options.max_side = 40;
            const Picture small = read_picture(in_folder("a.png"), options);
            for (uint32_t y = 2; y + 2 < 40; ++y)
                for (uint32_t x = 2; x + 2 < 40; ++x) {
                    double sum = 0;
                    for (uint32_t i = 0; i < 25; ++i) sum += value_of(small, x + i % 5 - 2, y + i / 5 - 2, 0) / 25;
                    const double middle = 100 * ((down ? y : x) * step + (step - 1) / 2.0);
                    assert_close(sum / (100 * step), middle / (100 * step), 0.15);
                }
        }
}

// One wrong pixel in ten: less than one reduced pixel in ten is wrong, at any reduction.
void test_reduced_keeps_wrong_pixels_apart(void **) {
    Picture full = make_noise(640, 480, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_GREY);
    uint64_t random = 3;
    for (uint8_t &value : full.pixels) value = lp_random(&random) < 0.1 ? 255 : 100;
    write_picture(in_folder("a.png"), full);
    for (uint32_t max_side : {320u, 160u, 80u, 40u}) {
        ReadOptions options;
        options.max_side = max_side;
        const Picture small = read_picture(in_folder("a.png"), options);
        const auto clean = std::count(small.pixels.begin(), small.pixels.end(), uint8_t{100});
        assert_true(double(clean) > 0.92 * double(small.pixels.size()));  // at most one of four is wrong: 0.948
    }
}

// A reduced picture has its place in the frame; content counts, not the name.
void test_size(void **) {
    const Picture picture = make_smooth(90, 40, LENSPROF_LAYOUT_RGB);
    for (const char *name : {"a.png", "a.tif", "a.jpg"}) {
        write_picture(in_folder(name), picture);
        fs::rename(in_folder(name), in_folder("picture"));
        const PictureSize size = read_size(in_folder("picture"));
        assert_int_equal(size.width, 90);
        assert_int_equal(size.height, 40);
        Picture read = read_picture(in_folder("picture"));
        const lensprof_image view = read.view();
        assert_int_equal(view.width, 90);
        assert_int_equal(view.row_bytes, 270);
        assert_ptr_equal(view.data, read.pixels.data());
        assert_true(read.traits.format == format_of_name(name));
    }
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_png_round_trip),
        cmocka_unit_test(test_png_keeps_colour_chunks),
        cmocka_unit_test(test_tiff_round_trip),
        cmocka_unit_test(test_tiff_keeps_not_finite),
        cmocka_unit_test(test_jpeg_round_trip),
        cmocka_unit_test(test_jpeg_keeps_coding),
        cmocka_unit_test(test_png_palette),
        cmocka_unit_test(test_png_grey_bits),
        cmocka_unit_test(test_png_deep_interlaced),
        cmocka_unit_test(test_tiff_kinds),
        cmocka_unit_test(test_tiff_min_is_white),
        cmocka_unit_test(test_tiff_jpeg),
        cmocka_unit_test(test_reduced_lossless),
        cmocka_unit_test(test_reduced_jpeg),
        cmocka_unit_test(test_reduced_jpeg_kinds),
        cmocka_unit_test(test_reduced_is_not_shifted),
        cmocka_unit_test(test_reduced_keeps_wrong_pixels_apart),
        cmocka_unit_test(test_large_jpeg),
        cmocka_unit_test(test_size),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
