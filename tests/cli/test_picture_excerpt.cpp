// Editing metadata in an excerpt of a picture file gives exactly the bytes of Exiv2 on the whole file.
#include <cstring>

#include <exiv2/exiv2.hpp>  // before cmocka, which makes a macro of `fail`

#include "picture_files.hpp"

#include "photo/pictures/picture_excerpt.hpp"

using namespace picture_files;

namespace {

using Change = std::function<void(Exiv2::Image &)>;

void edit(const codec::PictureExcerpt &excerpt, const Change &change) {
    auto image = Exiv2::ImageFactory::open(excerpt.bytes().data(), static_cast<long>(excerpt.bytes().size()));
    image->readMetadata();
    change(*image);
    image->writeMetadata();
    Exiv2::BasicIo &io = image->io();
    io.open();
    assert_true(excerpt.replace(io.mmap(), static_cast<size_t>(io.size())));
}

void change_nothing(Exiv2::Image &) {}

void add_little(Exiv2::Image &image) {
    image.exifData()["Exif.Image.Make"] = std::string("Maker");
    image.exifData()["Exif.Photo.ISOSpeedRatings"] = uint16_t(200);
}

void add_much(Exiv2::Image &image) {
    add_little(image);
    image.exifData()["Exif.Photo.UserComment"] = std::string(30001, 'x');
    image.exifData()["Exif.GPSInfo.GPSAltitude"] = Exiv2::URational(1, 3);
    image.iptcData()["Iptc.Application2.Caption"] = std::string("caption");
    image.xmpData()["Xmp.dc.creator"] = std::string("somebody");
}

void turn(Exiv2::Image &image) { image.exifData()["Exif.Image.Orientation"] = uint16_t(8); }

// The pixels are unchanged, the file equals that of Exiv2 alone, and the excerpt is small.
void check_edits(const std::string &name, size_t excerpt_max) {
    const std::string path = in_folder(name), other = in_folder("whole-" + name);
    const Bytes bytes = load(path);
    const Picture before = read_picture(path);
    for (const Change &change : {Change(change_nothing), Change(add_little), Change(add_much), Change(turn)}) {
        save(path, bytes);
        save(other, bytes);
        const auto excerpt = codec::excerpt_of(path);
        if (!excerpt) fail_msg("%s: no excerpt", name.c_str());
        assert_true(excerpt->bytes().size() < excerpt_max);
        edit(*excerpt, change);
        edit(*codec::whole_file(other), change);
        if (load(path) != load(other))
            fail_msg("%s: editing the excerpt and the whole file gives different bytes", name.c_str());
        assert_same_pixels(before, read_picture(path));
        assert_true(before.icc == read_picture(path).icc);
    }
    assert_int_equal(files_in_folder(), 2);
    fs::remove(path);
    fs::remove(other);
}

void test_png(void **) {
    for (uint32_t layout = LENSPROF_LAYOUT_GREY; layout <= LENSPROF_LAYOUT_RGBA; ++layout)
        for (uint32_t sample : {LENSPROF_SAMPLE_U8, LENSPROF_SAMPLE_U16}) {
            Picture picture = make_noise(211, 97, sample, layout);
            picture.traits.x_resolution = picture.traits.y_resolution = 300;
            if (sample == LENSPROF_SAMPLE_U16) picture.icc = make_profile(layout < LENSPROF_LAYOUT_RGB, 400);
            write_picture(in_folder("a.png"), picture);
            check_edits("a.png", 1000);
        }
}

void test_jpeg(void **) {
    for (bool progressive : {false, true})
        for (uint32_t layout : {LENSPROF_LAYOUT_GREY, LENSPROF_LAYOUT_RGB}) {
            Picture picture = make_noise(211, 97, LENSPROF_SAMPLE_U8, layout);
            picture.icc = make_profile(layout == LENSPROF_LAYOUT_GREY, 400);
            picture.traits.progressive = progressive;
            write_picture(in_folder("a.jpg"), picture);
            check_edits("a.jpg", 3000);
        }
}

// A TIFF is edited as a whole, whatever wrote it: this program, another, or Exiv2, which writes the directory first.
void test_tiff(void **) {
    const Picture picture = make_noise(45, 38, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB);
    TiffKind tiles{"wl", COMPRESSION_LZW};
    tiles.tile = 16;
    for (const TiffKind &kind : {tiles, TiffKind{"w8", COMPRESSION_LZW}, TiffKind{"wb", COMPRESSION_NONE}}) {
        write_tiff_file(in_folder("a.tif"), picture, kind);
        assert_null(codec::excerpt_of(in_folder("a.tif")).get());
    }
    write_picture(in_folder("a.tif"), picture);
    edit(*codec::whole_file(in_folder("a.tif")), add_much);
    PictureMetadata metadata = unknown_metadata();
    std::strcpy(metadata.key.camera_model, "Model");
    assert_true(write_metadata(in_folder("a.tif"), metadata));
    assert_string_equal(read_metadata(in_folder("a.tif")).key.camera_model, "Model");
    assert_same_pixels(picture, read_picture(in_folder("a.tif")));
}

// Any damage results in no excerpt, or in an excerpt that gives a file or a Failure.
void test_damaged_files(void **) {
    const Picture picture = make_noise(45, 38, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB);
    uint64_t state = 3;
    for (const char *name : {"a.png", "a.jpg", "a.tif"}) {
        write_picture(in_folder(name), picture);
        const Bytes bytes = load(in_folder(name));
        for (int run = 0; run < 400; ++run) {
            Bytes changed = bytes;
            const size_t range = run % 2 ? 300 : bytes.size(), at = size_t(double(range) * lp_random(&state));
            changed[run % 4 < 2 ? at : bytes.size() - 1 - at] = static_cast<uint8_t>(256 * lp_random(&state));
            if (run % 5 == 0) changed.resize(at);
            save(in_folder(name), changed);
            try {
                write_metadata(in_folder(name), unknown_metadata());
            } catch (const Failure &failure) {
                assert_non_null(std::strstr(failure.what(), name));
                assert_true(load(in_folder(name)) == changed);
            }
            assert_int_equal(files_in_folder(), 1);
        }
        fs::remove(in_folder(name));
    }
}

}  // namespace

#define TEST(name) cmocka_unit_test_setup(name, empty_folder)

int main() {
    const CMUnitTest tests[] = {
        TEST(test_png),
        TEST(test_jpeg),
        TEST(test_tiff),
        TEST(test_damaged_files),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
