// Metadata about a falloff correction made before lensprof, written through Exiv2 as cameras do.
#include <cstring>

#include <exiv2/exiv2.hpp>  // before cmocka, which makes a macro of `fail`

#include "picture_files.hpp"

using namespace picture_files;

namespace {

struct Tag {
    const char *key, *type, *value;
};

PictureMetadata read_with(const char *name, const std::vector<Tag> &tags, const std::vector<Tag> &xmp = {}) {
    const std::string path = in_folder(name);
    write_picture(path, make_smooth(16, 8, LENSPROF_LAYOUT_RGB));
    auto image = Exiv2::ImageFactory::open(path);
    image->readMetadata();
    for (const Tag &tag : tags) {
        const auto value = Exiv2::Value::create(Exiv2::TypeInfo::typeId(tag.type));
        assert_int_equal(value->read(tag.value), 0);
        image->exifData().add(Exiv2::ExifKey(tag.key), value.get());
    }
    for (const Tag &tag : xmp) image->xmpData()[tag.key] = std::string(tag.value);
    image->writeMetadata();
    return read_metadata(path);
}

void assert_corrected(const PictureMetadata &metadata, const char *by) {
    assert_string_equal(metadata.corrected_by.c_str(), by);
    assert_int_equal(metadata.key.processing, *by ? LENSPROF_PROCESSING_CORRECTED : LENSPROF_PROCESSING_JPEG);
}

void test_switches_of_cameras(void **) {
    static const struct {
        const char *maker;
        Tag off, on;
        const char *by;
    } cameras[] = {
        {"SONY",
         {"Exif.Sony1.0x2011", "Long", "0"},
         {"Exif.Sony1.0x2011", "Long", "2"},
         "in camera (Sony: vignetting correction)"},
        {"SONY",
         {"Exif.Sony1.0x2011", "Long", "4294967295"},
         {"Exif.Sony1.0x2011", "Long", "2"},
         "in camera (Sony: vignetting correction)"},
        {"Panasonic",
         {"Exif.Panasonic.ShadingCompensation", "Short", "0"},
         {"Exif.Panasonic.ShadingCompensation", "Short", "1"},
         "in camera (Panasonic: shading compensation)"},
        {"NIKON CORPORATION",
         {"Exif.Nikon3.VignetteControl", "Short", "0"},
         {"Exif.Nikon3.VignetteControl", "Short", "3"},
         "in camera (Nikon: vignette control)"},
        {"PENTAX",
         {"Exif.Pentax.0x007d", "Undefined", "1 1 0 1"},
         {"Exif.Pentax.0x007d", "Undefined", "0 0 1 0"},
         "in camera (Pentax: peripheral illumination correction)"},
        // Fields: version 0 and size, then the switch.
        {"Canon",
         {"Exif.Canon.0x4015", "Short", "0 22 0 1 1 1 70 0 0 0 0"},
         {"Exif.Canon.0x4015", "Short", "0 22 1 0 0 0 70 0 0 0 0"},
         "in camera (Canon: peripheral illumination correction)"},
        {"Canon",
         {"Exif.Canon.0x4016", "SLong", "32 0 0 0 0 0 1 1"},
         {"Exif.Canon.0x4016", "SLong", "32 0 0 0 0 1 0 0"},
         "in camera (Canon: peripheral illumination correction)"},
        {"Canon",
         {"Exif.Canon.0x4018", "SLong", "16 0 1 1"},
         {"Exif.Canon.0x4018", "SLong", "16 1 0 0"},
         "in camera (Canon: peripheral illumination correction)"},
    };
    for (const auto &camera : cameras) {
        const Tag make{"Exif.Image.Make", "Ascii", camera.maker};
        assert_corrected(read_with("a.jpg", {make, camera.off}), "");
        assert_corrected(read_with("a.jpg", {make, camera.on}), camera.by);
        // In a raw converter's picture, and in other formats, the maker notes are those of the raw file.
        assert_corrected(read_with("a.jpg", {make, {"Exif.Image.Software", "Ascii", "darktable 4.2.1"}, camera.on}),
                         "");
        assert_corrected(read_with("a.tif", {make, camera.on}), "");
    }
}

// The menu was on, but the camera had no data for the lens.
void test_canon_says_what_was_done(void **) {
    const Tag make{"Exif.Image.Make", "Ascii", "Canon"}, menu{"Exif.Canon.0x4016", "SLong", "32 0 0 0 0 1 0 0"};
    assert_corrected(read_with("a.jpg", {make, {"Exif.Canon.0x4015", "Short", "0 22 0 0 0 0 0 0 0 0 0"}, menu}), "");
    assert_corrected(read_with("a.jpg", {make, {"Exif.Canon.0x4015", "Short", "0 0 0 0 0 0 0 0 0 0 0"}, menu}),
                     "in camera (Canon: peripheral illumination correction)");
}

void test_olympus(void **) {
    for (const char *value : {"0", "1"}) {
        const auto metadata = read_with("a.jpg", {{"Exif.Image.Make", "Ascii", "OM Digital Solutions"},
                                                  {"Exif.Olympus2.CameraID", "Undefined", "79 76 89 77"},
                                                  {"Exif.OlympusCs.ShadingCompensation", "Short", value}});
        assert_corrected(metadata, *value == '1' ? "in camera (Olympus: shading compensation)" : "");
    }
}

void test_phones(void **) {
    const Tag make{"Exif.Image.Make", "Ascii", "Apple"}, model{"Exif.Image.Model", "Ascii", "iPhone 12"};
    assert_corrected(read_with("a.jpg", {make, model}), "in camera (a phone)");
    assert_corrected(read_with("a.jpg", {make, model, {"Exif.Image.Software", "Ascii", "RawTherapee 5.9"}}), "");
    assert_corrected(
        read_with("a.jpg", {{"Exif.Image.Make", "Ascii", "Canon"}, {"Exif.Image.Model", "Ascii", "Canon EOS 6D"}}), "");
}

void test_raw_converters(void **) {
    const Tag enabled{"Xmp.crs.LensProfileEnable", "", "1"}, disabled{"Xmp.crs.LensProfileEnable", "", "0"},
        applied{"Xmp.crs.AlreadyApplied", "", "True"}, planned{"Xmp.crs.AlreadyApplied", "", "False"};
    for (const char *name : {"a.jpg", "a.png", "a.tif"}) {
        assert_corrected(read_with(name, {}, {enabled, applied}), "by the raw converter (Adobe: lens profile)");
        assert_corrected(read_with(name, {}, {disabled, applied}), "");
        assert_corrected(read_with(name, {}, {enabled, planned}), "");
    }
    // One opcode with 4 bytes of data: 3 is FixVignetteRadial, 1 is WarpRectilinear.
    const char *falloff = "0 0 0 1 0 0 0 3 1 3 0 0 0 0 0 0 0 0 0 4 0 0 0 0",
               *other = "0 0 0 1 0 0 0 1 1 3 0 0 0 0 0 0 0 0 0 4 0 0 0 0",
               *second = "0 0 0 2 0 0 0 1 1 3 0 0 0 0 0 0 0 0 0 1 7 0 0 0 9 1 3 0 0 0 0 0 0 0 0 0 0",
               *short_list = "0 0 0 9 0 0 0 1 1 3 0 0 0 0 0 0 255 255 255 255 0 0 0 3";
    const char *by = "by the raw converter (opcodes of DNG)";
    assert_corrected(read_with("a.tif", {{"Exif.Image.OpcodeList3", "Undefined", falloff}}), by);
    assert_corrected(read_with("a.tif", {{"Exif.Image.OpcodeList2", "Undefined", second}}), by);
    assert_corrected(read_with("a.tif", {{"Exif.Image.OpcodeList3", "Undefined", other}}), "");
    assert_corrected(read_with("a.tif", {{"Exif.Image.OpcodeList3", "Undefined", short_list}}), "");
    assert_corrected(read_with("a.tif", {{"Exif.Image.DNGVersion", "Byte", "1 4 0 0"},
                                         {"Exif.Image.OpcodeList3", "Undefined", falloff}}),
                     "");
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_switches_of_cameras),
        cmocka_unit_test(test_canon_says_what_was_done),
        cmocka_unit_test(test_olympus),
        cmocka_unit_test(test_phones),
        cmocka_unit_test(test_raw_converters),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
