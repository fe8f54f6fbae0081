// HEIC, AVIF, WebP and JPEG XL as pictures: values, layouts, profiles, orientation, metadata. The libraries encode
// without loss, so the input is the ground truth.
#include "coded_files.hpp"

#include "photo/pictures/coded_kind.hpp"

#include "heif_grid.hpp"

using namespace coded_files;

namespace {

[[maybe_unused]] void needs(bool is_there, const char *what) {
    if (is_there) return;
    print_message("without %s\n", what);
    skip();
}

// A colour profile that encoders parse: that of PNG files written by this program.
[[maybe_unused]] Bytes some_profile() { return make_profile(false, 300); }

[[maybe_unused]] void assert_reads(const std::string &path, const Picture &expected, FileFormat format) {
    const Picture got = read_picture(path);
    assert_int_equal(got.traits.format, format);
    assert_same_pixels(got, expected);
    const Picture header = read_header(path);
    assert_int_equal(header.width, expected.width);
    assert_int_equal(header.sample, expected.sample);
    ReadOptions reduced;
    reduced.max_side = 20;
    const Picture small = read_picture(path, reduced);
    assert_int_equal(small.reduction, std::max(got.width, got.height) / 20 / 2 * 2);
    assert_int_equal(small.pixels.size(), small.row_bytes * small.height);
}

[[maybe_unused]] void assert_metadata(const std::string &path, uint16_t orientation) {
    const PictureMetadata metadata = read_metadata(path);
    assert_string_equal(metadata.key.camera_maker, "Example Works");
    assert_string_equal(metadata.key.camera_model, "Example One");
    assert_string_equal(metadata.key.lens, "Example 35mm F2");
    assert_true(std::fabs(metadata.key.aperture - 2.8) < 1e-6 && std::fabs(metadata.key.focal_mm - 35.0) < 1e-6);
    assert_true(metadata.exposure_time_s && std::fabs(*metadata.exposure_time_s * 60 - 1) < 1e-6);
    assert_true(metadata.iso && *metadata.iso == 200.0);
    assert_int_equal(metadata.orientation, orientation);
    assert_int_equal(metadata.size.width, 83);
    assert_int_equal(metadata.size.height, 61);
    assert_true(read_xmp_packet(path).find("Rating=\"4\"") != std::string::npos);
}

// Both are written to a TIFF: pixels by the writer, EXIF by a copy.
[[maybe_unused]] void assert_copied(const std::string &path, uint16_t orientation, const Bytes &icc) {
    const Picture picture = read_picture(path);
    WriteOptions options;
    options.metadata_from = path;
    assert_true(write_picture(in_folder("copy.tif"), picture, options));
    const Picture copy = read_picture(in_folder("copy.tif"));
    assert_same_pixels(copy, picture);
    assert_true(copy.icc == icc);
    assert_int_equal(copy.traits.orientation, orientation);
    assert_metadata(in_folder("copy.tif"), orientation);
}

#ifdef LENSPROF_HAS_WEBP

void test_webp(void **) {
    for (const uint32_t layout : {LENSPROF_LAYOUT_RGB, LENSPROF_LAYOUT_RGBA}) {
        const Picture picture = make_noise(83, 61, LENSPROF_SAMPLE_U8, layout);
        save(in_folder("a.png"), webp_bytes(picture));  // by content, whatever the name
        assert_reads(in_folder("a.png"), picture, FileFormat::webp);
        assert_false(read_header(in_folder("a.png")).traits.is_lossy);
    }
    save(in_folder("lossy.webp"), webp_bytes(make_smooth(83, 61, LENSPROF_LAYOUT_RGB), 90));
    assert_true(read_header(in_folder("lossy.webp")).traits.is_lossy);
}

void test_webp_metadata(void **) {
    const Picture picture = make_noise(83, 61, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB);
    Bytes marked = {'E', 'x', 'i', 'f', 0, 0};
    const Bytes exif = make_exif(6);
    marked.insert(marked.end(), exif.begin(), exif.end());
    for (const Bytes &block : {exif, marked}) {
        save(in_folder("a.webp"), extended_webp(webp_bytes(picture), 83, 61, 0, {block, make_xmp(), some_profile()}));
        assert_metadata(in_folder("a.webp"), 6);
        assert_true(read_picture(in_folder("a.webp")).icc == some_profile());
        assert_reads(in_folder("a.webp"), picture, FileFormat::webp);
        assert_copied(in_folder("a.webp"), 6, some_profile());
    }
}

// Two frames with their durations, in an extended file with the animation flag.
void test_webp_animation(void **) {
    const Bytes still = webp_bytes(make_noise(16, 16, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB));
    Bytes frames(12, 0), frame;
    put_riff(frames, "ANIM", Bytes(6, 0));
    put_number(frame, 0, 3);
    put_number(frame, 0, 3);
    put_number(frame, 15, 3);
    put_number(frame, 15, 3);
    put_number(frame, 100, 4);
    frame.insert(frame.end(), still.begin() + 12, still.end());
    put_riff(frames, "ANMF", frame);
    put_riff(frames, "ANMF", frame);
    save(in_folder("a.webp"), extended_webp(frames, 16, 16, 2, {}));
    assert_failure(LENSPROF_ERROR_READ, "is a WebP animation", [] { read_header(in_folder("a.webp")); });
}

// libwebp's own program, which decodes in one step.
void test_webp_as_dwebp(void **) {
    needs(system("command -v dwebp >/dev/null 2>&1") == 0, "dwebp (package webp)");
    const std::string path = in_folder("a.webp"), png = in_folder("a.png");
    save(path, webp_bytes(make_smooth(301, 203, LENSPROF_LAYOUT_RGB), 60));
    assert_int_equal(system(("dwebp -quiet '" + path + "' -o '" + png + "'").c_str()), 0);
    assert_same_pixels(read_picture(path), read_picture(png));
}

#endif

#ifdef LENSPROF_HAS_HEIF

constexpr heif_compression_format codings[] = {heif_compression_HEVC, heif_compression_AV1};

template <class Test>
void for_each_coding(const Test &test) {
    bool any = false;
    for (const heif_compression_format coding : codings) {
        if (!can_write_heif(coding)) continue;
        any = true;
        test(coding, in_folder(coding == heif_compression_HEVC ? "a.heic" : "a.avif"));
    }
    needs(any, "an encoder in libheif");
}

void test_heif_values(void **) {
    for_each_coding([](heif_compression_format coding, const std::string &path) {
        for (const unsigned bits : {8u, 10u, 12u}) {
            if (bits == 10 && coding == heif_compression_AV1) continue;  // libheif 1.15 passes libaom a wrong profile
            const uint32_t sample = bits > 8 ? LENSPROF_SAMPLE_U16 : LENSPROF_SAMPLE_U8;
            Picture picture = make_noise(84, 62, sample, LENSPROF_LAYOUT_RGB);
            if (bits > 8) picture = of_bits(picture, bits);
            write_heif(path, coding, picture, static_cast<int>(bits));
            assert_reads(path, bits > 8 ? full_scale(picture, bits) : picture, FileFormat::heif);
            assert_string_equal(coded_kind(path)->name, coding == heif_compression_HEVC ? "HEIC" : "AVIF");
        }
    });
}

void test_heif_layouts(void **) {
    for_each_coding([](heif_compression_format coding, const std::string &path) {
        for (const uint32_t layout : {LENSPROF_LAYOUT_GREY, LENSPROF_LAYOUT_RGBA}) {
            const Picture picture = make_noise(84, 62, LENSPROF_SAMPLE_U8, layout);
            write_heif(path, coding, picture, 8);
            assert_reads(path, picture, FileFormat::heif);
        }
    });
}

void test_heif_metadata(void **) {
    for_each_coding([](heif_compression_format coding, const std::string &path) {
        const Picture picture = make_noise(83, 61, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB);
        // the file's own orientation takes precedence over EXIF's
        write_heif(path, coding, picture, 8, {make_exif(6), make_xmp(), some_profile()});
        assert_metadata(path, 1);
        assert_true(read_header(path).icc == some_profile());
        assert_copied(path, 1, some_profile());
        assert_int_equal(read_metadata(path).is_of_camera, coding == heif_compression_HEVC);
    });
}

// The displayed pixel of a picture with EXIF's orientation: the pixel at (x, y).
const uint8_t *displayed(const Picture &stored, uint16_t orientation, uint32_t x, uint32_t y) {
    const uint32_t w = stored.width, h = stored.height;
    const struct {
        uint32_t x, y;
    } places[] = {{x, y}, {w - 1 - x, y}, {w - 1 - x, h - 1 - y}, {x, h - 1 - y},
                  {y, x}, {y, h - 1 - x}, {w - 1 - y, h - 1 - x}, {w - 1 - y, x}};
    const auto &place = places[orientation - 1];
    return stored.pixels.data() + place.y * stored.row_bytes + place.x * 3;
}

// Stored pixels are those before libheif rotated them, and the orientation rotates them as libheif does.
void test_heif_orientation(void **) {
    for_each_coding([](heif_compression_format coding, const std::string &path) {
        const Picture picture = make_noise(84, 62, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB);
        for (uint16_t orientation = 1; orientation <= 8; ++orientation) {
            write_heif(path, coding, picture, 8, {make_exif(1), {}, {}, orientation});
            const Picture got = read_picture(path);
            const uint16_t own = read_metadata(path).orientation;
            assert_int_equal(got.traits.orientation, own);
            heif_context *context = heif_context_alloc();
            heif_image_handle *handle = nullptr;
            heif_image *image = nullptr;
            assert_heif(heif_context_read_from_file(context, path.c_str(), nullptr));
            assert_heif(heif_context_get_primary_image_handle(context, &handle));
            assert_heif(heif_decode_image(handle, &image, heif_colorspace_RGB, heif_chroma_interleaved_RGB, nullptr));
            int row = 0;
            const uint8_t *plane = heif_image_get_plane_readonly(image, heif_channel_interleaved, &row);
            const uint32_t width = uint32_t(heif_image_get_width(image, heif_channel_interleaved)),
                           height = uint32_t(heif_image_get_height(image, heif_channel_interleaved));
            assert_int_equal(width, orientation >= 5 ? 62 : 84);
            for (uint32_t y = 0; y < height; ++y)
                for (uint32_t x = 0; x < width; ++x)
                    assert_memory_equal(displayed(got, own, x, y), plane + y * uint32_t(row) + 3 * x, 3);
            heif_image_release(image);
            heif_image_handle_release(handle);
            heif_context_free(context);
            if (orientation != 1 && orientation != 3 && orientation != 6 && orientation != 8) continue;
            assert_int_equal(own, orientation);  // only for rotations: the mirror axis differs between editions
            assert_same_pixels(got, picture);
        }
    });
}

void test_heif_primary(void **) {
    for_each_coding([](heif_compression_format coding, const std::string &path) {
        const Picture picture = make_noise(84, 62, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB);
        write_heif(path, coding, picture, 8, {}, {make_noise(64, 64, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB)});
        assert_reads(path, picture, FileFormat::heif);
    });
}

// Two rows of three tiles, the last ones cut off, rotated as on a phone held upright.
void test_heif_grid(void **) {
    needs(can_write_heif(heif_compression_HEVC), "an encoder of HEIC in libheif");
    constexpr uint32_t tile = 64, width = 170, height = 100;
    const Picture picture = make_noise(3 * tile, 2 * tile, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB);
    std::vector<Bytes> tiles;
    for (uint32_t i = 0; i < 6; ++i) {
        Picture part = make_noise(tile, tile, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB);
        for (uint32_t y = 0; y < tile; ++y)
            std::memcpy(part.pixels.data() + y * part.row_bytes,
                        picture.pixels.data() + (i / 3 * tile + y) * picture.row_bytes + i % 3 * tile * 3,
                        part.row_bytes);
        write_heif(in_folder("tile.heic"), heif_compression_HEVC, part, 8);
        tiles.push_back(load(in_folder("tile.heic")));
    }
    Picture shown = make_noise(width, height, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB);
    for (uint32_t y = 0; y < height; ++y)
        std::memcpy(shown.pixels.data() + y * shown.row_bytes, picture.pixels.data() + y * picture.row_bytes,
                    shown.row_bytes);
    for (const unsigned quarters : {0u, 3u}) {
        save(in_folder("a.heic"), heif_grid::bytes_of(tiles, {3, 2, tile, width, height, quarters}));
        assert_reads(in_folder("a.heic"), shown, FileFormat::heif);
        assert_int_equal(read_metadata(in_folder("a.heic")).orientation, quarters ? 6 : 1);
    }
}

void test_heif_transfer(void **) {
    const Picture picture = make_noise(84, 62, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB);
    for_each_coding([&](heif_compression_format coding, const std::string &path) {
        for (const int transfer : {16, 18}) {
            Extras extras;
            extras.transfer = transfer;
            write_heif(path, coding, picture, 8, extras);
            const char *name = transfer == 16 ? "(PQ transfer)" : "(HLG transfer)";
            assert_failure(LENSPROF_ERROR_READ, name, [&] { read_header(path); });
        }
        Extras linear;
        linear.transfer = 8;
        write_heif(path, coding, picture, 8, linear);
        assert_int_equal(read_metadata(path).key.processing, LENSPROF_PROCESSING_RAW);
        write_heif(path, coding, picture, 8);
        assert_int_equal(read_metadata(path).key.processing, LENSPROF_PROCESSING_JPEG);
    });
}

#endif

#ifdef LENSPROF_HAS_JXL

void test_jxl_values(void **) {
    for (const uint32_t sample : {LENSPROF_SAMPLE_U8, LENSPROF_SAMPLE_U16, LENSPROF_SAMPLE_F32})
        for (const uint32_t layout :
             {LENSPROF_LAYOUT_GREY, LENSPROF_LAYOUT_GREY_ALPHA, LENSPROF_LAYOUT_RGB, LENSPROF_LAYOUT_RGBA}) {
            const Picture picture = make_noise(83, 61, sample, layout);
            save(in_folder("a.jxl"), jxl_bytes(picture));
            assert_reads(in_folder("a.jxl"), picture, FileFormat::jxl);
        }
}

void test_jxl_metadata(void **) {
    const Picture picture = make_noise(83, 61, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB);
    for (const bool compressed : {false, true}) {
        JxlKind kind;
        kind.boxes_compressed = compressed;
        for (const uint16_t orientation : {uint16_t(1), uint16_t(6), uint16_t(7)}) {
            save(in_folder("a.jxl"), jxl_bytes(picture, {make_exif(3), make_xmp(), {}, orientation}, kind));
            assert_metadata(in_folder("a.jxl"), orientation);
            assert_reads(in_folder("a.jxl"), picture, FileFormat::jxl);
            assert_copied(in_folder("a.jxl"), orientation, read_header(in_folder("a.jxl")).icc);
        }
    }
}

void test_jxl_transfer(void **) {
    const Picture picture = make_noise(83, 61, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB);
    const auto path = in_folder("a.jxl");
    JxlKind kind;
    kind.transfer = JXL_TRANSFER_FUNCTION_PQ;
    save(path, jxl_bytes(picture, {}, kind));
    assert_failure(LENSPROF_ERROR_READ, "(PQ transfer)", [&] { read_header(path); });
    kind.transfer = JXL_TRANSFER_FUNCTION_HLG;
    save(path, jxl_bytes(picture, {}, kind));
    assert_failure(LENSPROF_ERROR_READ, "(HLG transfer)", [&] { read_header(path); });
    kind.transfer = JXL_TRANSFER_FUNCTION_LINEAR;
    save(path, jxl_bytes(picture, {}, kind));
    assert_int_equal(read_metadata(path).key.processing, LENSPROF_PROCESSING_RAW);
}

void test_jxl_lossy(void **) {
    const Picture picture = make_smooth(83, 61, LENSPROF_LAYOUT_RGB);
    JxlKind kind;
    kind.distance = 0.5f;
    save(in_folder("a.jxl"), jxl_bytes(picture, {}, kind));
    const Picture got = read_picture(in_folder("a.jxl"));
    assert_true(got.traits.is_lossy);
    assert_near_pixels(got, picture, 8);
}

void test_jxl_animation(void **) {
    JxlKind kind;
    kind.animated = true;
    save(in_folder("a.jxl"), jxl_bytes(make_noise(83, 61, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB), {}, kind));
    assert_failure(LENSPROF_ERROR_READ, "is a JPEG XL animation", [] { read_header(in_folder("a.jxl")); });
}

// libjxl's own programs: a JPEG recompressed as JPEG XL counts as the camera's own.
void test_jxl_of_jpeg(void **) {
    needs(system("command -v cjxl >/dev/null 2>&1 && command -v djxl >/dev/null 2>&1") == 0,
          "cjxl (package libjxl-tools)");
    const std::string path = in_folder("a.jxl"), jpeg = in_folder("a.jpg"), png = in_folder("a.png");
    write_jpeg_file(jpeg, make_smooth(301, 203, LENSPROF_LAYOUT_RGB), {});
    assert_int_equal(system(("cjxl --quiet '" + jpeg + "' '" + path + "' 2>/dev/null").c_str()), 0);
    assert_int_equal(system(("djxl --quiet '" + path + "' '" + png + "' 2>/dev/null").c_str()), 0);
    const Picture got = read_picture(path);
    assert_true(got.traits.is_lossy && read_metadata(path).is_of_camera);
    assert_near_pixels(got, read_picture(png), 0);
}

#endif

void test_names(void **) {
    for (const char *name : {"A.HEIC", "a.heif", "a.hif", "a.avif", "a.webp", "a.jxl"}) {
        assert_true(is_picture_name(name));
        assert_failure(LENSPROF_ERROR_ARGUMENT, "does not write it; give a name ending in .tif",
                       [&] { format_of_name(name); });
    }
    assert_false(is_picture_name("a.mp4"));
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_names, empty_folder),
#ifdef LENSPROF_HAS_WEBP
        cmocka_unit_test_setup(test_webp, empty_folder),
        cmocka_unit_test_setup(test_webp_metadata, empty_folder),
        cmocka_unit_test_setup(test_webp_animation, empty_folder),
        cmocka_unit_test_setup(test_webp_as_dwebp, empty_folder),
#endif
#ifdef LENSPROF_HAS_HEIF
        cmocka_unit_test_setup(test_heif_values, empty_folder),
        cmocka_unit_test_setup(test_heif_layouts, empty_folder),
        cmocka_unit_test_setup(test_heif_metadata, empty_folder),
        cmocka_unit_test_setup(test_heif_orientation, empty_folder),
        cmocka_unit_test_setup(test_heif_primary, empty_folder),
        cmocka_unit_test_setup(test_heif_transfer, empty_folder),
        cmocka_unit_test_setup(test_heif_grid, empty_folder),
#endif
#ifdef LENSPROF_HAS_JXL
        cmocka_unit_test_setup(test_jxl_values, empty_folder),
        cmocka_unit_test_setup(test_jxl_metadata, empty_folder),
        cmocka_unit_test_setup(test_jxl_transfer, empty_folder),
        cmocka_unit_test_setup(test_jxl_lossy, empty_folder),
        cmocka_unit_test_setup(test_jxl_animation, empty_folder),
        cmocka_unit_test_setup(test_jxl_of_jpeg, empty_folder),
#endif
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
