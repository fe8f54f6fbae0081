// Commands on HEIC, AVIF, WebP and JPEG XL behave as with the same pixels in PNG.
#include "coded_files.hpp"  // Exiv2, before a macro of cmocka

#include "batch_runs.hpp"

using namespace batch_runs;
using namespace coded_files;

namespace {

// A format that the program reads, and that the tests can write.
struct Coding {
    const char *end, *other_end;  // other_end: the extension of another format
    std::function<void(const std::string &path, const Picture &, const Extras &)> write;
    bool is_deep;  // holds 16 bit
};

std::vector<Coding> codings() {
    std::vector<Coding> all;
#ifdef LENSPROF_HAS_WEBP
    all.push_back({".webp", ".jpg",
                   [](const std::string &path, const Picture &picture, const Extras &extras) {
                       save(path, extended_webp(webp_bytes(picture), picture.width, picture.height, 0, extras));
                   },
                   false});
#endif
#ifdef LENSPROF_HAS_HEIF
    const auto add_heif_coding = [&](heif_compression_format format, const char *end) {
        if (!can_write_heif(format)) return;
        all.push_back({end, ".png",
                       [format](const std::string &path, const Picture &picture, const Extras &extras) {
                           write_heif(path, format, picture, 8, extras);
                       },
                       false});
    };
    add_heif_coding(heif_compression_HEVC, ".heic");
    add_heif_coding(heif_compression_AV1, ".avif");
#endif
#ifdef LENSPROF_HAS_JXL
    all.push_back({".jxl", ".tif",
                   [](const std::string &path, const Picture &picture, const Extras &extras) {
                       save(path, jxl_bytes(picture, extras));
                   },
                   true});
#endif
    if (all.empty()) {
        print_message("built without libheif, libwebp and libjxl\n");
        skip();
    }
    return all;
}

Picture smooth() { return make_smooth(200, 150, LENSPROF_LAYOUT_RGB); }

Picture smooth16() {
    Picture picture = make_noise(200, 150, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB);
    auto *values = reinterpret_cast<uint16_t *>(picture.pixels.data());
    for (size_t i = 0; i < picture.pixels.size() / 2; ++i)
        values[i] = static_cast<uint16_t>(30000 + 20000 * std::sin(double(i) / 971.0));
    return picture;
}

void test_apply(void **) {
    for (const Coding &coding : codings())
        for (const bool deep : {false, true}) {
            if (deep && !coding.is_deep) continue;
            const Picture picture = deep ? smooth16() : smooth();
            const std::string name = std::string("a") + (deep ? "16" : "8");
            coding.write(work(name + coding.end), picture, {make_exif(1), {}, {}, 1});
            write_picture(work(name + ".png"), picture);
            must_exit(done, corrected_into("coded", {work(name + coding.end)}));
            must_exit(done, corrected_into("plain", {work(name + ".png")}));
            const Picture corrected = read_picture(work("coded/" + name + ".tif"));
            assert_same_pixels(corrected, read_picture(work("plain/" + name + ".png")));
            assert_true(corrected.pixels != picture.pixels);
            const PictureMetadata metadata = read_metadata(work("coded/" + name + ".tif"));
            assert_string_equal(metadata.key.lens, "Example 35mm F2");
            assert_true(metadata.mark && metadata.mark->falloff == CorrectionMark::Falloff::removed);
            empty_work(nullptr);
        }
}

// The content decides, whatever the name; the name alone does not make it such a file.
void test_other_names(void **) {
    for (const Coding &coding : codings()) {
        const std::string name = std::string("a") + coding.other_end;
        coding.write(work(name), smooth(), {});
        must_exit(done, corrected_into("coded", {work(name)}));
        assert_int_equal(read_picture(work("coded/a.tif")).traits.format, FileFormat::tiff);
        write_jpeg_file(work(std::string("b") + coding.end), smooth(), {});
        must_exit(done, corrected_into("coded", {work(std::string("b") + coding.end)}));
        assert_int_equal(read_picture(work("coded/b.tif")).traits.format, FileFormat::tiff);
        empty_work(nullptr);
    }
}

void test_folder(void **) {
    Words wanted;
    fs::create_directories(work("in/deep"));
    for (const Coding &coding : codings()) {
        const std::string name = std::string("deep/") + (coding.end + 1) + coding.end;
        coding.write(work("in/" + name), smooth(), {});
        wanted.push_back(work(std::string("out/deep/") + (coding.end + 1) + ".tif"));
    }
    must_exit(done, corrected_into("out", {work("in")}));
    for (const std::string &name : wanted) assert_true(fs::exists(name));
}

// A project written by simulate, with its pictures in another format: the fit is the same.
void test_build(void **) {
    const auto fit = [](const std::string &project) {
        Json json = json_of(Words{"build", project, "--no-store", "--json"} + quick);
        return json.at("vignetting").dump() + json.at("response").dump();
    };
    const std::string wanted = fit(scene("pano.pto"));
    for (const Coding &coding : codings()) {
        copy_of("scene");
        for (const auto &entry : fs::directory_iterator(work("copy"))) {
            if (entry.path().extension() != ".png") continue;
            const Picture picture = read_picture(entry.path().string());
            coding.write(fs::path(entry.path()).replace_extension(coding.end).string(), picture, {});
            fs::remove(entry.path());
        }
        edit(work("copy/pano.pto"), "(img[0-9]+)\\.png", std::string("$1") + coding.end);
        assert_string_equal(fit(work("copy/pano.pto")).c_str(), wanted.c_str());
        fs::remove_all(work("copy"));
    }
}

// Frames of a stationary camera, each a stop darker than the previous one.
Words make_frames(const std::string &end, const Coding *coding) {
    Words files;
    for (const int step : {0, 1, 2}) {
        Picture frame = make_smooth(160, 120, LENSPROF_LAYOUT_RGB);
        for (uint8_t &v : frame.pixels)
            v = static_cast<uint8_t>(std::lround(255 * std::pow(std::pow(v / 255.0, 2.2) / (1 << step), 1 / 2.2)));
        files.push_back(work("f" + std::to_string(step) + end));
        coding ? coding->write(files.back(), frame, {}) : void(write_picture(files.back(), frame));
    }
    return files;
}

void test_align(void **) {
    must_exit(done, Words{"align", "-o", work("plain")} + make_frames(".png", nullptr));
    for (const Coding &coding : codings()) {
        must_exit(done, Words{"align", "-o", work("coded")} + make_frames(coding.end, &coding));
        for (const int step : {0, 1, 2}) {
            const std::string name = "/f" + std::to_string(step);
            assert_same_pixels(read_picture(work("coded" + name + ".tif")),
                               read_picture(work("plain" + name + ".png")));
        }
        fs::remove_all(work("coded"));
    }
}

void test_bracket(void **) {
    const auto response = [](const Words &frames) {
        const Outcome outcome = run_words(Words{"bracket", "--times", "4,2,1", "--no-store", "--json"} + frames);
        assert_true(outcome.code == done || outcome.code == not_usable);
        return parsed(outcome.out).at("response").dump();
    };
    const std::vector<Coding> all = codings();
    assert_string_equal(response(make_frames(all[0].end, &all[0])).c_str(),
                        response(make_frames(".png", nullptr)).c_str());
}

void test_flat(void **) {
    for (const Coding &coding : codings()) {
        Picture card = make_noise(240, 180, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB);
        for (uint32_t y = 0; y < card.height; ++y)
            for (uint32_t x = 0; x < card.width; ++x)
                for (uint32_t c = 0; c < 3; ++c) {
                    const double r = std::hypot(x - 119.5, y - 89.5) / 150.0;
                    card.pixels[y * card.row_bytes + 3 * x + c] =
                        static_cast<uint8_t>(std::lround(200 * (1 - 0.3 * r * r)));
                }
        coding.write(work(std::string("card") + coding.end), card, {make_exif(1), {}, {}, 1});
        write_picture(work("card.png"), card);
        const auto falloff = [](const std::string &name) {
            return json_of({"flat", "--linear", "--no-store", "--fit", "falloff-curves=1", "--json", work(name)})
                .at("vignetting")
                .dump();
        };
        assert_string_equal(falloff(std::string("card") + coding.end).c_str(), falloff("card.png").c_str());
        empty_work(nullptr);
    }
}

// Cut anywhere, or reduced to its beginning: exit code 3, the name, and nothing written.
void test_cut(void **) {
    for (const Coding &coding : codings()) {
        const std::string path = work(std::string("a") + coding.end);
        coding.write(path, smooth(), {});
        const Bytes whole = load(path);
        fs::create_directories(work("out"));  // stays if a file turns out to be damaged after its header
        for (const size_t size : {size_t(16), size_t(40), size_t(200), whole.size() / 3, whole.size() / 2,
                                  whole.size() * 9 / 10, whole.size() - 20}) {
            save(path, Bytes(whole.begin(), whole.begin() + static_cast<ptrdiff_t>(size)));
            assert_refused(unreadable, corrected_into("out", {path}), {path});
        }
        Bytes zeros(whole.begin(), whole.begin() + 40);
        zeros.resize(whole.size(), 0);
        save(path, zeros);
        assert_refused(unreadable, corrected_into("out", {path}), {path});
    }
}

#ifdef LENSPROF_HAS_HEIF
// ISO/IEC 23008-12, 6.5.3: the sizes of a file's pictures, in boxes of a separate type.
void test_heif_of_false_size(void **) {
    for (const Coding &coding : codings()) {
        const std::string path = work(std::string("a") + coding.end);
        coding.write(path, smooth(), {});
        Bytes bytes = load(path);
        if (bytes[4] != 'f' || bytes[5] != 't') continue;  // not HEIF
        const auto declare = [&](uint32_t side) {
            const std::string type = "ispe";
            for (auto at = bytes.begin();;) {
                at = std::search(at, bytes.end(), type.begin(), type.end());
                if (at == bytes.end()) break;
                for (int i = 0; i < 8; ++i) at[8 + i] = static_cast<uint8_t>(side >> (24 - 8 * (i % 4)));
                at += 4;
            }
            save(path, bytes);
        };
        fs::create_directories(work("out"));
        declare(18000);
        assert_refused(unreadable, corrected_into("out", {path}), {path, "damaged"});
        declare(30000);
        assert_refused(unreadable, corrected_into("out", {path}), {path, "30000 x 30000 pixels exceed the limit"});
        declare(0);
        assert_refused(unreadable, corrected_into("out", {path}), {path});
    }
}
#endif

void test_not_written(void **) {
    write_picture(work("a.png"), smooth());
    for (const char *name : {"sheet.webp", "sheet.heic", "sheet.jxl"})
        assert_refused(usage, corrected_into("out", {"--contact-sheet", work(name), work("a.png")}),
                       {name, "does not write it; give a name ending in .tif, .png or .jpg"});
}

// Phone cameras correct the falloff before writing any of these formats.
void test_phone(void **) {
    for (const Coding &coding : codings()) {
        Exiv2::ExifData exif;
        exif["Exif.Image.Make"] = "Apple";
        exif["Exif.Image.Model"] = "iPhone 12";
        Exiv2::Blob blob;
        Exiv2::ExifParser::encode(blob, Exiv2::littleEndian, exif);
        coding.write(work(std::string("a") + coding.end), smooth(), {{blob.begin(), blob.end()}, {}, {}, 1});
        const PictureMetadata metadata = read_metadata(work(std::string("a") + coding.end));
        assert_string_equal(metadata.corrected_by.c_str(), "in camera (a phone)");
        assert_int_equal(metadata.key.processing, LENSPROF_PROCESSING_CORRECTED);
    }
}

// Without the library, files are identified by their content; these bytes identify the kind.
void test_without(void **) {
    const struct {
        bool is_read;
        Bytes start;
        const char *kind, *next;
    } kinds[] = {
        {can_read_webp(), {'R', 'I', 'F', 'F', 0, 0, 0, 0, 'W', 'E', 'B', 'P'}, "is a WebP picture", "libwebp-dev"},
        {can_read_jxl(), {0xff, 0x0a, 0, 0, 0, 0, 0, 0}, "is a JPEG XL picture", "libjxl-dev"},
        {can_read_heif(), {0, 0, 0, 16, 'f', 't', 'y', 'p', 'h', 'e', 'i', 'c', 0, 0, 0, 0}, "in HEIC", "libheif-dev"},
        {can_read_heif(), {0, 0, 0, 16, 'f', 't', 'y', 'p', 'a', 'v', 'i', 'f', 0, 0, 0, 0}, "in AVIF", "libheif-dev"}};
    for (const auto &kind : kinds) {
        save(work("a.x"), kind.start);
        if (kind.is_read)
            assert_refused(unreadable, corrected_into("out", {work("a.x")}), {"a.x: cannot read: file is truncated"});
        else
            assert_refused(unreadable, corrected_into("out", {work("a.x")}), {"a.x", kind.kind, kind.next});
    }
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_apply),
        CLI_TEST(test_other_names),
        CLI_TEST(test_folder),
        CLI_TEST(test_build),
        CLI_TEST(test_align),
        CLI_TEST(test_bracket),
        CLI_TEST(test_flat),
        CLI_TEST(test_cut),
        CLI_TEST(test_not_written),
        CLI_TEST(test_phone),
        CLI_TEST(test_without),
#ifdef LENSPROF_HAS_HEIF
        CLI_TEST(test_heif_of_false_size),
#endif
    };
    return cmocka_run_group_tests(tests, make_scene, remove_folder);
}
