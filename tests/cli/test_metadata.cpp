// Metadata of picture files: reading files written through Exiv2, and what a copy keeps and leaves out.
#include <cstring>
#include <thread>

#include <exiv2/exiv2.hpp>  // before cmocka, which makes a macro of `fail`

#include "photo/pictures/lens_name.hpp"
#include "picture_files.hpp"

using namespace picture_files;

namespace {

const char *const names[] = {"a.jpg", "a.png", "a.tif"};

// Lets `change` edit the metadata of a file.
void edit(const std::string &path, const std::function<void(Exiv2::Image &)> &change) {
    auto image = Exiv2::ImageFactory::open(path);
    image->readMetadata();
    change(*image);
    image->writeMetadata();
}

// A small JPEG with these EXIF values, in Exiv2's text form.
std::string make_exif(const std::vector<std::pair<const char *, const char *>> &values) {
    const std::string path = in_folder("exif.jpg");
    write_picture(path, make_smooth(16, 8, LENSPROF_LAYOUT_RGB));
    edit(path, [&](Exiv2::Image &image) {
        for (const auto &value : values) image.exifData()[value.first] = std::string(value.second);
    });
    return path;
}

PictureMetadata read_exif(const std::vector<std::pair<const char *, const char *>> &values) {
    const PictureMetadata metadata = read_metadata(make_exif(values));
    assert_ok(lensprof_profile_key_validate(&metadata.key));
    return metadata;
}

void test_nothing_known(void **) {
    for (const char *name : names) {
        write_picture(in_folder(name), make_smooth(9, 7, LENSPROF_LAYOUT_RGB));
        const PictureMetadata metadata = read_metadata(in_folder(name));
        assert_ok(lensprof_profile_key_validate(&metadata.key));
        assert_string_equal(metadata.key.camera_maker, "");
        assert_string_equal(metadata.key.camera_model, "");
        assert_string_equal(metadata.key.lens, "");
        assert_close(metadata.key.focal_mm, LENSPROF_UNKNOWN, 0);
        assert_close(metadata.key.aperture, LENSPROF_UNKNOWN, 0);
        assert_close(metadata.key.distance_m, LENSPROF_UNKNOWN, 0);
        assert_int_equal(metadata.key.processing, LENSPROF_PROCESSING_JPEG);
        assert_false(metadata.exposure_time_s || metadata.iso || metadata.f_number || metadata.exif_ev);
    }
}

void test_written_is_read(void **) {
    PictureMetadata metadata = unknown_metadata();
    std::strcpy(metadata.key.camera_maker, "Lensprof");
    std::strcpy(metadata.key.camera_model, "Simulated \xc3\xa9");
    std::strcpy(metadata.key.lens, "24-70mm F2.8");
    metadata.key.focal_mm = 35.5;
    metadata.key.aperture = 5.6;
    metadata.key.distance_m = INFINITY;
    metadata.exposure_time_s = 1 / 320.0;
    metadata.iso = 400;
    for (const char *name : names) {
        WriteOptions options;
        options.metadata = &metadata;
        const Picture picture = make_smooth(33, 20, LENSPROF_LAYOUT_RGB);
        assert_true(write_picture(in_folder(name), picture, options));
        assert_near_pixels(picture, read_picture(in_folder(name)), name[2] == 'j' ? 3 : 0);
        const PictureMetadata again = read_metadata(in_folder(name));
        assert_string_equal(again.key.camera_maker, metadata.key.camera_maker);
        assert_string_equal(again.key.camera_model, metadata.key.camera_model);
        assert_string_equal(again.key.lens, metadata.key.lens);
        assert_close(again.key.focal_mm, 35.5, 1e-9);
        assert_close(again.key.aperture, 5.6, 1e-9);
        assert_true(std::isinf(again.key.distance_m));
        assert_close(again.exposure_time_s.value_or(0), 1 / 320.0, 1e-12);
        assert_close(again.iso.value_or(0), 400, 0);
        assert_close(again.f_number.value_or(0), 5.6, 1e-9);
        // log2(400 / 100 / 320 / 5.6^2)
        assert_close(again.exif_ev.value_or(0), 2 - 8.321928094887362 - 2 * 2.485426827170242, 1e-9);
        assert_int_equal(files_in_folder(), 1);
        empty_folder(nullptr);
    }
}

void test_float_tiff_is_linear(void **) {
    write_picture(in_folder("a.tif"), make_noise(8, 8, LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_RGB));
    assert_int_equal(read_metadata(in_folder("a.tif")).key.processing, LENSPROF_PROCESSING_RAW);
}

void test_unit_and_sensor(void **) {
    const PictureMetadata both =
        read_exif({{"Exif.Photo.BodySerialNumber", " 0123 "}, {"Exif.Photo.LensSerialNumber", "9"}});
    assert_string_equal(both.key.unit, "0123/9");
    assert_string_equal(read_exif({{"Exif.Photo.LensSerialNumber", "9"}}).key.unit, "/9");
    assert_string_equal(
        read_exif({{"Exif.Photo.BodySerialNumber", "0000"}, {"Exif.Photo.LensSerialNumber", "-"}}).key.unit, "");
    const PictureMetadata equivalent =
        read_exif({{"Exif.Photo.FocalLength", "425/100"}, {"Exif.Photo.FocalLengthIn35mmFilm", "26"}});
    assert_close(equivalent.key.crop_factor, 26 / 4.25, 1e-9);
    for (const char *focal : {"0/1", "1/0", "5000/1"})
        assert_close(
            read_exif({{"Exif.Photo.FocalLength", focal}, {"Exif.Photo.FocalLengthIn35mmFilm", "26"}}).key.crop_factor,
            LENSPROF_UNKNOWN, 0);
}

// Crop factor for pixels of 3.9 um, from EXIF of a picture of width x height; EXIF states own_width x own_height.
double crop_of_pitch(const char *width, const char *height, uint32_t own_width, uint32_t own_height,
                     const char *focal_in_35mm = nullptr) {
    const std::string path = in_folder("pitch.jpg");
    write_picture(path, make_smooth(own_width, own_height, LENSPROF_LAYOUT_GREY));
    edit(path, [&](Exiv2::Image &image) {
        Exiv2::ExifData &exif = image.exifData();
        exif["Exif.Photo.PixelXDimension"] = std::string(width);
        exif["Exif.Photo.PixelYDimension"] = std::string(height);
        exif["Exif.Photo.FocalPlaneXResolution"] = std::string("100000/39");
        exif["Exif.Photo.FocalPlaneYResolution"] = std::string("100000/39");
        exif["Exif.Photo.FocalPlaneResolutionUnit"] = std::string("3");
        exif["Exif.Photo.FocalLength"] = std::string("18/1");
        if (focal_in_35mm) exif["Exif.Photo.FocalLengthIn35mmFilm"] = std::string(focal_in_35mm);
    });
    const PictureMetadata metadata = read_metadata(path);
    assert_int_equal(metadata.size.width, own_width);
    assert_int_equal(metadata.size.height, own_height);
    return metadata.key.crop_factor;
}

void test_sensor_by_pitch(void **) {
    const double full = std::hypot(36, 24) / (std::hypot(2400, 1600) * 0.0039);  // 9.36 mm x 6.24 mm
    assert_close(crop_of_pitch("2400", "1600", 2400, 1600), full, 1e-9);
    assert_close(crop_of_pitch("1600", "2400", 2400, 1600), full, 1e-9);        // rotated
    assert_close(crop_of_pitch("2400", "1600", 2400, 1600, "70"), full, 1e-9);  // 70/18 is 3.89, rounded
    assert_close(crop_of_pitch("2400", "1600", 2400, 1600, "27"), 1.5, 1e-9);   // contradiction
    assert_close(crop_of_pitch("2400", "1600", 1200, 800), LENSPROF_UNKNOWN, 0);
    assert_close(crop_of_pitch("2400", "1600", 1200, 800, "70"), 70 / 18.0, 1e-9);
    assert_close(crop_of_pitch("2400", "1600", 1000, 750), LENSPROF_UNKNOWN, 0);  // cropped, perhaps resized
    assert_close(crop_of_pitch("2400", "1600", 1000, 750, "27"), LENSPROF_UNKNOWN, 0);
    assert_close(crop_of_pitch("1200", "800", 1200, 800), LENSPROF_UNKNOWN, 0);  // reduced, as EXIF states
    assert_close(crop_of_pitch("1200", "800", 1200, 800, "27"), 1.5, 1e-9);
}

// A crop that has all pixels of one side, or many: the pitch of its pixels is the camera's, and the frame was larger.
void test_sensor_of_a_crop(void **) {
    const double full_mm = std::hypot(36, 24), pitch_mm = 0.0039;
    const uint32_t sizes[][2] = {{2400, 1350}, {1600, 1600}, {1350, 2400}, {1600, 2000}, {2400, 800}, {1800, 1350}};
    for (const auto &size : sizes) {
        const double crop = full_mm / (std::hypot(size[0], size[1]) * pitch_mm);
        assert_close(crop_of_pitch("2400", "1600", size[0], size[1], "70"), crop, 1e-9);
        // by the equivalent, which is that of the frame: 27/18
        assert_close(crop_of_pitch("2400", "1600", size[0], size[1], "27"),
                     1.5 * std::hypot(2400, 1600) / std::hypot(size[0], size[1]), 1e-9);
    }
    assert_close(crop_of_pitch("2400", "1600", 1201, 800, "27"), 1.5, 1e-9);   // resized
    assert_close(crop_of_pitch("2400", "1600", 3000, 800, "27"), 1.5, 1e-9);   // stitched
    assert_close(crop_of_pitch("2400", "1600", 1600, 2400, "27"), 1.5, 1e-9);  // rotated
}

// Nikon's codes of the AF-S Zoom-Nikkor 24-70mm f/2.8G ED.
void test_nikon_lens_of_numbers(void **) {
    const std::vector<std::pair<const char *, const char *>> numbers = {{"Exif.Image.Make", "NIKON CORPORATION"},
                                                                        {"Exif.Photo.LensModel", "24.0-70.0 mm f/2.8"},
                                                                        {"Exif.Nikon3.Version", "48 50 49 48"},
                                                                        {"Exif.Nikon3.LensType", "6"},
                                                                        {"Exif.NikonLd1.Version", "48 49 48 48"},
                                                                        {"Exif.NikonLd1.LensIDNumber", "147"},
                                                                        {"Exif.NikonLd1.LensFStops", "72"},
                                                                        {"Exif.NikonLd1.MinFocalLength", "55"},
                                                                        {"Exif.NikonLd1.MaxFocalLength", "92"},
                                                                        {"Exif.NikonLd1.MaxApertureAtMinFocal", "36"},
                                                                        {"Exif.NikonLd1.MaxApertureAtMaxFocal", "36"},
                                                                        {"Exif.NikonLd1.MCUVersion", "149"}};
    const std::string lens = read_exif(numbers).key.lens;
    assert_true(lens.find("24-70mm") != std::string::npos && lens.find("AF-S") != std::string::npos);
    assert_string_equal(read_exif({numbers[0], numbers[1]}).key.lens, "24.0-70.0 mm f/2.8");
    auto named = numbers;
    named[1].second = "NIKKOR 24-70";
    assert_string_equal(read_exif(named).key.lens, "NIKKOR 24-70");
}

void test_texts(void **) {
    const std::string longer = "  " + std::string(62, 'm') + "\xc3\xa9\xc3\xa9  ";
    PictureMetadata metadata = read_exif({{"Exif.Image.Make", "  NIKON CORPORATION  "},
                                          {"Exif.Image.Model", longer.c_str()},
                                          {"Exif.Photo.LensModel", " Caf\xe9\t50mm \n"}});
    assert_string_equal(metadata.key.camera_maker, "NIKON CORPORATION");
    assert_string_equal(metadata.key.camera_model, std::string(62, 'm').c_str());  // no half character at byte 63
    assert_string_equal(metadata.key.lens, "Caf\xc3\xa9 50mm");
    for (const char *nothing : {"", "   ", "----", "0.0 mm f/0.0", "n/a", "(65535)", "Unknown (7)", "None"}) {
        metadata = read_exif({{"Exif.Photo.LensModel", nothing}});
        assert_string_equal(metadata.key.lens, "");
    }
}

void test_lens_of_maker_note(void **) {
    const PictureMetadata canon = read_exif({{"Exif.Image.Make", "Canon"},
                                             {"Exif.Image.Model", "Canon EOS 5D"},
                                             {"Exif.Photo.LensModel", " "},
                                             {"Exif.Canon.LensModel", "EF35mm f/1.4L USM"},
                                             {"Exif.CanonCs.LensType", "131"},
                                             {"Exif.CanonCs.Lens", "35 35 1"}});
    assert_non_null(std::strstr(canon.key.lens, "35mm"));
    const PictureMetadata olympus =
        read_exif({{"Exif.Image.Make", "OLYMPUS IMAGING CORP."}, {"Exif.OlympusEq.LensModel", "OLYMPUS 14-54mm Lens"}});
    assert_true(olympus.key.lens[0] == '\0' || std::strstr(olympus.key.lens, "14-54mm"));
}

LensName lens_of(const std::function<void(Exiv2::Image &)> &change) {
    const std::string path = in_folder("lens.jpg");
    write_picture(path, make_smooth(16, 8, LENSPROF_LAYOUT_RGB));
    edit(path, change);
    const PictureMetadata metadata = read_metadata(path);
    return {metadata.key.lens, metadata.ambiguous_lens};
}

// Files from raw converters have no maker notes. 230 is Canon's number of the lens, 137 that of several Sigma lenses.
void test_lens_in_xmp(void **) {
    const auto xmp_lens = [](const char *maker, const char *lens, const char *number, const char *range) {
        return lens_of([&](Exiv2::Image &image) {
            image.exifData()["Exif.Image.Make"] = std::string(maker);
            if (*lens) image.xmpData()["Xmp.aux.Lens"] = std::string(lens);
            if (*number) image.xmpData()["Xmp.aux.LensID"] = std::string(number);
            if (*range) image.xmpData()["Xmp.aux.LensInfo"] = std::string(range);
        });
    };
    const char *name = "EF24-70mm f/2.8L USM", *range = "24/1 70/1 0/0 0/0";
    assert_string_equal(xmp_lens("Canon", name, "230", range).name.c_str(), name);
    assert_string_equal(xmp_lens("FUJIFILM", "XF23mmF1.4 R", "", "").name.c_str(), "XF23mmF1.4 R");
    for (const char *stated : {range, ""})
        assert_string_equal(xmp_lens("Canon", "", "230", stated).name.c_str(), "Canon EF 24-70mm f/2.8L USM");
    assert_string_equal(xmp_lens("Canon", "", "230", "17/1 40/1 0/0 0/0").name.c_str(), "");
    assert_non_null(std::strstr(xmp_lens("Canon", "", "137", "18/1 50/1 0/0 0/0").name.c_str(), "Sigma 18-50mm"));
    assert_string_equal(xmp_lens("Canon", "", "137", "").name.c_str(), "");
    for (const char *maker : {"FUJIFILM", "Other", ""})
        assert_string_equal(xmp_lens(maker, "", "230", range).name.c_str(), "");
    const LensName sony = xmp_lens("SONY", "", "24", "");
    assert_string_equal(sony.name.c_str(), "");
    assert_non_null(std::strstr(sony.ambiguous.c_str(), "Sigma 18-50mm"));
    const LensName nikon = xmp_lens("NIKON CORPORATION", "18.0-55.0 mm f/3.5-5.6", "154", "180/10 550/10 35/10 56/10");
    assert_string_equal(nikon.name.c_str(), "18.0-55.0 mm f/3.5-5.6");
    assert_string_equal(lens_of([](Exiv2::Image &image) {
                            image.exifData()["Exif.Photo.LensModel"] = std::string("EF50mm f/1.8 STM");
                            image.xmpData()["Xmp.aux.Lens"] = std::string("Another 85mm");
                        }).name.c_str(),
                        "EF50mm f/1.8 STM");
}

void test_lens_of_canon_without_number(void **) {
    for (const char *number : {"0", "65535"})
        assert_string_equal(read_exif({{"Exif.Image.Make", "Canon"},
                                       {"Exif.Canon.LensModel", "EF24-105mm f/4L IS USM"},
                                       {"Exif.CanonCs.LensType", number}})
                                .key.lens,
                            "EF24-105mm f/4L IS USM");
}

// Texts of other types than ASCII, UNDEFINED with or without a character code.
void test_texts_as_bytes(void **) {
    const std::string text = "EF50mm f/1.8 STM";
    for (const Exiv2::TypeId type : {Exiv2::unsignedByte, Exiv2::undefined})
        for (const std::string &code : {std::string(), std::string("ASCII\0\0\0", 8)}) {
            const std::string bytes = code + text;
            const auto value_of = [&](const std::string &content) {
                auto value = Exiv2::Value::create(type);
                value->read(reinterpret_cast<const Exiv2::byte *>(content.data()), static_cast<long>(content.size()),
                            Exiv2::littleEndian);
                return value;
            };
            const std::string path = in_folder("bytes.jpg");
            write_picture(path, make_smooth(16, 8, LENSPROF_LAYOUT_RGB));
            edit(path, [&](Exiv2::Image &image) {
                image.exifData().add(Exiv2::ExifKey("Exif.Image.Model"), value_of("Canon EOS 6D").get());
                image.exifData().add(Exiv2::ExifKey("Exif.Photo.LensModel"), value_of(bytes).get());
            });
            const PictureMetadata metadata = read_metadata(path);
            assert_string_equal(metadata.key.lens, text.c_str());
            assert_string_equal(metadata.key.camera_model, "Canon EOS 6D");
        }
}

// A program has written the EXIF around a maker note in another byte order.
void test_maker_note_in_the_other_byte_order(void **) {
    static const struct {
        const char *maker, *key, *value, *lens;
    } notes[] = {
        {"Canon", "Exif.CanonCs.LensType", "230", "Canon EF 24-70mm f/2.8L USM"},
        {"Canon", "Exif.Canon.LensModel", "EF24-105mm f/4L IS USM", "EF24-105mm f/4L IS USM"},
        {"SONY", "Exif.Sony1.LensID", "25501", "Minolta AF 50mm F1.7"},
        {"Panasonic", "Exif.Panasonic.LensType", "LUMIX G VARIO 14-42/F3.5-5.6II", "LUMIX G VARIO 14-42/F3.5-5.6II"}};
    for (const auto &note : notes)
        for (const Exiv2::ByteOrder order : {Exiv2::littleEndian, Exiv2::bigEndian}) {
            const std::string own = in_folder("own.jpg"), other = in_folder("other.jpg");
            for (const std::string &path : {own, other}) write_picture(path, make_smooth(16, 8, LENSPROF_LAYOUT_RGB));
            const auto write = [&](Exiv2::Image &image, Exiv2::ByteOrder written) {
                image.setByteOrder(written);
                image.exifData()["Exif.Image.Make"] = std::string(note.maker);
                image.exifData()["Exif.Image.Model"] = std::string("A camera");
            };
            edit(own, [&](Exiv2::Image &image) {
                write(image, order);
                image.exifData()[note.key] = std::string(note.value);
            });
            assert_string_equal(read_metadata(own).key.lens, note.lens);
            auto source = Exiv2::ImageFactory::open(own);
            source->readMetadata();
            const Exiv2::Exifdatum bytes = *source->exifData().findKey(Exiv2::ExifKey("Exif.Photo.MakerNote"));
            const long offset = source->exifData()["Exif.MakerNote.Offset"].toLong();
            edit(other, [&](Exiv2::Image &image) {
                write(image, order == Exiv2::littleEndian ? Exiv2::bigEndian : Exiv2::littleEndian);
                image.exifData().add(bytes);
            });
            auto written = Exiv2::ImageFactory::open(other);
            written->readMetadata();
            assert_int_equal(written->exifData()["Exif.MakerNote.Offset"].toLong(), offset);
            assert_true(written->byteOrder() != order);
            assert_string_equal(read_metadata(other).key.lens, note.lens);
        }
}

// Picture styles as in the maker notes.
void test_style(void **) {
    assert_string_equal(read_exif({{"Exif.Image.Make", "Canon"}, {"Exif.CanonPr.PictureStyle", "130"}}).key.style,
                        "Portrait");
    assert_string_equal(read_exif({{"Exif.Image.Make", "FUJIFILM"}, {"Exif.Fujifilm.FilmMode", "512"}}).key.style,
                        "F2/Fujichrome (Velvia)");
    assert_string_equal(read_exif({{"Exif.Image.Make", "Canon"}}).key.style, "");
    assert_string_equal(read_exif({{"Exif.Image.Make", "Canon"}, {"Exif.CanonPr.PictureStyle", "9999"}}).key.style, "");
}

void test_exposure(void **) {
    PictureMetadata metadata =
        read_exif({{"Exif.Photo.ShutterSpeedValue", "7/1"}, {"Exif.Photo.ApertureValue", "6/1"}});
    assert_close(metadata.exposure_time_s.value_or(0), 1 / 128.0, 1e-12);
    assert_close(metadata.f_number.value_or(0), 8, 1e-12);
    assert_close(metadata.key.aperture, 8, 1e-12);
    assert_false(metadata.iso || metadata.exif_ev);

    // The plain tags take precedence over APEX; zero and zero denominators are unknown.
    metadata = read_exif({{"Exif.Photo.ExposureTime", "1/250"},
                          {"Exif.Photo.ShutterSpeedValue", "7/1"},
                          {"Exif.Photo.FNumber", "28/10"},
                          {"Exif.Photo.ApertureValue", "6/1"},
                          {"Exif.Photo.ISOSpeedRatings", "200"},
                          {"Exif.Photo.FocalLength", "18/1"}});
    assert_close(metadata.exposure_time_s.value_or(0), 0.004, 1e-15);
    assert_close(metadata.f_number.value_or(0), 2.8, 1e-15);
    assert_close(metadata.iso.value_or(0), 200, 0);
    assert_close(metadata.key.focal_mm, 18, 0);
    assert_close(metadata.exif_ev.value_or(0), std::log2(0.004 * 2 / 7.84), 1e-12);
    metadata = read_exif({{"Exif.Photo.ExposureTime", "0/1"},
                          {"Exif.Photo.FNumber", "0/0"},
                          {"Exif.Photo.FocalLength", "5/0"},
                          {"Exif.Photo.ISOSpeedRatings", "0"}});
    assert_false(metadata.exposure_time_s || metadata.f_number || metadata.iso || metadata.exif_ev);
    assert_close(metadata.key.focal_mm, LENSPROF_UNKNOWN, 0);
    assert_close(metadata.key.aperture, LENSPROF_UNKNOWN, 0);
}

// Either tag is enough, whatever the other states; 0 and 2 are "not defined" and "normal program", mode 2 is
// bracketing.
void test_manual_exposure(void **) {
    using Tags = std::vector<std::pair<const char *, const char *>>;
    const char *program = "Exif.Photo.ExposureProgram", *mode = "Exif.Photo.ExposureMode";
    for (const Tags &tags : {Tags{{program, "1"}}, Tags{{mode, "1"}}, Tags{{program, "1"}, {mode, "2"}},
                             Tags{{program, "2"}, {mode, "1"}}, Tags{{"Exif.Image.ExposureProgram", "1"}}})
        assert_true(read_exif(tags).is_manual);
    for (const Tags &tags : {Tags{}, Tags{{program, "0"}}, Tags{{program, "2"}, {mode, "0"}}, Tags{{mode, "2"}}})
        assert_false(read_exif(tags).is_manual);
}

void test_distance(void **) {
    const std::pair<const char *, double> values[] = {{"35/10", 3.5},
                                                      {"0/1", LENSPROF_UNKNOWN},
                                                      {"0/0", LENSPROF_UNKNOWN},
                                                      {"4294967295/1", INFINITY},
                                                      {"4294967295/4294967295", INFINITY},
                                                      {"90000/1", LENSPROF_UNKNOWN}};
    for (const auto &value : values) {
        const double distance = read_exif({{"Exif.Photo.SubjectDistance", value.first}}).key.distance_m;
        if (std::isinf(value.second))
            assert_true(std::isinf(distance));
        else
            assert_close(distance, value.second, 1e-12);
    }
    const PictureMetadata canon = read_exif({{"Exif.Image.Make", "Canon"}, {"Exif.CanonSi.SubjectDistance", "214"}});
    assert_close(canon.key.distance_m, 2.14, 1e-9);
}

// Copies.

// A picture of the format of `name`, with all metadata that cameras and editors write.
void make_source(const std::string &name) {
    Picture picture = make_smooth(48, 32, LENSPROF_LAYOUT_RGB);
    picture.traits.orientation = 6;
    picture.icc = make_profile(false, 400);
    write_picture(in_folder(name), picture);
    const Bytes thumbnail = load(in_folder(name));
    edit(in_folder(name), [&](Exiv2::Image &image) {
        Exiv2::ExifData &exif = image.exifData();
        exif["Exif.Image.Make"] = std::string("Canon");
        exif["Exif.Image.Model"] = std::string("Canon EOS 5D");
        exif["Exif.Image.Orientation"] = uint16_t(6);
        exif["Exif.Image.Artist"] = std::string("A. Nonymous");
        exif["Exif.Photo.ExposureTime"] = Exiv2::URational(1, 50);
        exif["Exif.Photo.PixelXDimension"] = uint32_t(4368);
        exif["Exif.Photo.PixelYDimension"] = uint32_t(2912);
        exif["Exif.Photo.UserComment"] = std::string("charset=Ascii words");
        exif["Exif.GPSInfo.GPSAltitude"] = Exiv2::URational(1234, 10);
        exif["Exif.CanonSi.SubjectDistance"] = uint16_t(214);
        if (image.mimeType() != "image/tiff")
            Exiv2::ExifThumb(exif).setJpegThumbnail(thumbnail.data(), long(thumbnail.size()));
        image.iptcData()["Iptc.Application2.Caption"] = std::string("A caption");
        image.xmpData()["Xmp.dc.subject"] = std::string("words");
        image.xmpData()["Xmp.dc.format"] = std::string("image/x-raw");
        image.xmpData()["Xmp.tiff.ImageWidth"] = std::string("4368");
        image.xmpData()["Xmp.xmpNote.HasExtendedXMP"] = std::string("0123");
    });
}

void check_copy(const std::string &path, const char *mime_type) {
    auto image = Exiv2::ImageFactory::open(path);
    image->readMetadata();
    Exiv2::ExifData &exif = image->exifData();
    assert_string_equal(image->mimeType().c_str(), mime_type);
    assert_string_equal(exif["Exif.Image.Model"].toString().c_str(), "Canon EOS 5D");
    assert_string_equal(exif["Exif.Image.Artist"].toString().c_str(), "A. Nonymous");
    assert_string_equal(exif["Exif.Image.Orientation"].toString().c_str(), "6");
    assert_string_equal(exif["Exif.Photo.ExposureTime"].toString().c_str(), "1/50");
    assert_string_equal(exif["Exif.Photo.PixelXDimension"].toString().c_str(), "60");
    assert_string_equal(exif["Exif.Photo.PixelYDimension"].toString().c_str(), "40");
    assert_string_equal(exif["Exif.Photo.UserComment"].toString().c_str(), "charset=Ascii words");
    assert_string_equal(exif["Exif.GPSInfo.GPSAltitude"].toString().c_str(), "1234/10");
    assert_string_equal(exif["Exif.CanonSi.SubjectDistance"].toString().c_str(), "214");
    assert_string_equal(image->iptcData()["Iptc.Application2.Caption"].toString().c_str(), "A caption");
    assert_string_equal(image->xmpData()["Xmp.dc.subject"].toString().c_str(), "words");
    assert_string_equal(image->xmpData()["Xmp.dc.format"].toString().c_str(), mime_type);
    assert_string_equal(image->xmpData()["Xmp.tiff.ImageWidth"].toString().c_str(), "60");
    assert_true(image->xmpData().findKey(Exiv2::XmpKey("Xmp.xmpNote.HasExtendedXMP")) == image->xmpData().end());
    for (const Exiv2::Exifdatum &datum : exif) {
        assert_string_not_equal(datum.groupName().c_str(), "Thumbnail");
        if (image->mimeType() == "image/tiff" || datum.groupName() != "Image") continue;
        for (uint16_t structure : {256, 258, 273, 279, 34675})  // width, bits, strips, colour profile
            assert_int_not_equal(datum.tag(), structure);
    }
}

// From every format to every format: the metadata are copied; pixels, profile and resolution stay.
void test_copy(void **) {
    const char *const mime_types[] = {"image/jpeg", "image/png", "image/tiff"};
    Picture picture = make_smooth(60, 40, LENSPROF_LAYOUT_RGB);
    picture.icc = make_profile(false, 100000);
    picture.traits.x_resolution = picture.traits.y_resolution = 300;
    picture.traits.resolution_unit = PictureTraits::Unit::inch;
    for (const char *from : {"s.jpg", "s.png", "s.tif"}) {
        make_source(from);
        for (size_t i = 0; i < 3; ++i) {
            WriteOptions options;
            options.metadata_from = in_folder(from);
            write_picture(in_folder("plain" + std::string(names[i])), picture);
            assert_true(write_picture(in_folder(names[i]), picture, options));
            check_copy(in_folder(names[i]), mime_types[i]);
            const Picture plain = read_picture(in_folder("plain" + std::string(names[i])));
            const Picture copied = read_picture(in_folder(names[i]));
            assert_same_pixels(plain, copied);
            assert_true(copied.icc == picture.icc);
            assert_close(copied.traits.x_resolution, plain.traits.x_resolution, 0);
            assert_true(copied.traits.resolution_unit == plain.traits.resolution_unit);
            assert_true(copied.traits.quantisation == plain.traits.quantisation);
        }
    }
}

// Exiv2 rebuilds the TIFF: pixels, strips, extra samples and byte order of every kind must survive.
void test_copy_to_any_tiff(void **) {
    make_source("s.jpg");
    for (const char *mode : {"wl", "wb"}) {
        for (uint32_t layout = LENSPROF_LAYOUT_GREY; layout <= LENSPROF_LAYOUT_RGBA; ++layout) {
            for (uint32_t sample : {LENSPROF_SAMPLE_U8, LENSPROF_SAMPLE_U16, LENSPROF_SAMPLE_F32}) {
                for (uint32_t tile : {0u, 16u}) {
                    for (uint16_t planar : {PLANARCONFIG_CONTIG, PLANARCONFIG_SEPARATE}) {
                        const Picture picture = make_noise(60, 40, sample, layout);
                        TiffKind kind{mode, COMPRESSION_LZW, planar};
                        kind.tile = tile;
                        kind.rows_per_strip = 1;
                        write_tiff_file(in_folder("a.tif"), picture, kind);
                        const Picture before = read_picture(in_folder("a.tif"));
                        assert_true(copy_metadata(in_folder("s.jpg"), in_folder("a.tif")));
                        const Picture after = read_picture(in_folder("a.tif"));
                        assert_same_pixels(picture, after);
                        assert_true(before.traits.alpha == after.traits.alpha);
                        assert_int_equal(before.traits.compression, after.traits.compression);
                        assert_int_equal(load(in_folder("a.tif"))[0], mode[1] == 'l' ? 'I' : 'M');
                        assert_string_equal(read_metadata(in_folder("a.tif")).key.camera_model, "Canon EOS 5D");
                    }
                }
            }
        }
    }
}

// Correcting a file in place.
void test_copy_from_itself(void **) {
    for (const char *name : {"s.jpg", "s.png", "s.tif"}) {
        make_source(name);
        Picture picture = make_smooth(60, 40, LENSPROF_LAYOUT_RGB);
        picture.traits.orientation = 6;
        WriteOptions options;
        options.metadata_from = in_folder(name);
        write_picture(in_folder(name), picture, options);
        check_copy(in_folder(name), name[2] == 'j' ? "image/jpeg" : name[2] == 'p' ? "image/png" : "image/tiff");
        assert_near_pixels(picture, read_picture(in_folder(name)), name[2] == 'j' ? 3 : 0);
    }
}

// ExifTool edits written and copied files without -m, and reports no errors.
void test_exiftool(void **) {
    if (system("exiftool -ver >/dev/null 2>&1") != 0) {
        print_message("needs package libimage-exiftool-perl\n");
        skip();
    }
    PictureMetadata metadata = unknown_metadata();
    std::strcpy(metadata.key.camera_model, "Model");
    metadata.iso = 100;
    for (const std::string name : names) {
        WriteOptions options;
        options.metadata = &metadata;
        write_picture(in_folder("first-" + name), make_smooth(33, 20, LENSPROF_LAYOUT_RGB), options);
        options.metadata = nullptr;
        options.metadata_from = in_folder("first-" + name);
        write_picture(in_folder("second-" + name), make_smooth(33, 20, LENSPROF_LAYOUT_RGB), options);
        for (const std::string start : {"first-", "second-"}) {
            const std::string path = in_folder(start + name), quoted = "'" + path + "'";
            FILE *said = popen(("exiftool -validate -warning -error -a -s3 " + quoted).c_str(), "r");
            std::string text;
            for (char line[300]; fgets(line, sizeof line, said);) text += line;
            assert_int_equal(pclose(said), 0);
            if (name == "a.png" && text != "OK\n") fail_msg("%s: %s", path.c_str(), text.c_str());
            if (system(("exiftool -q -overwrite_original -EXIF:ISO=800 -EXIF:Artist=me " + quoted).c_str()) != 0)
                fail_msg("%s: exiftool does not edit it", path.c_str());
            assert_close(read_metadata(path).iso.value_or(0), 800, 0);
            assert_string_equal(read_metadata(path).key.camera_model, "Model");
            read_picture(path);
        }
    }
}

void test_big_tiff_has_no_metadata(void **) {
    make_source("s.jpg");
    TiffKind kind;
    kind.mode = "w8";
    const Picture picture = make_noise(20, 10, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB);
    write_tiff_file(in_folder("big.tif"), picture, kind);
    const Bytes before = load(in_folder("big.tif"));
    assert_string_equal(read_metadata(in_folder("big.tif")).key.camera_model, "");
    assert_false(copy_metadata(in_folder("s.jpg"), in_folder("big.tif")));
    assert_false(write_metadata(in_folder("big.tif"), unknown_metadata()));
    assert_true(load(in_folder("big.tif")) == before);
    WriteOptions options;
    options.metadata_from = in_folder("big.tif");
    assert_false(write_picture(in_folder("a.tif"), picture, options));
    assert_same_pixels(picture, read_picture(in_folder("a.tif")));
}

void test_copy_fails(void **) {
    make_source("s.jpg");
    const Bytes whole = load(in_folder("s.jpg"));
    save(in_folder("cut.jpg"), Bytes(whole.begin(), whole.begin() + 15));
    const auto copy = [](const char *from, const char *to) {
        return [=] { copy_metadata(in_folder(from), in_folder(to)); };
    };
    assert_failure(LENSPROF_ERROR_READ, "no.jpg: cannot read", copy("no.jpg", "s.jpg"));
    assert_failure(LENSPROF_ERROR_READ, "no.jpg: cannot read", copy("s.jpg", "no.jpg"));
    assert_failure(LENSPROF_ERROR_READ, "cut.jpg: cannot read metadata: ", copy("s.jpg", "cut.jpg"));
    assert_true(load(in_folder("s.jpg")) == whole);
    assert_int_equal(files_in_folder(), 2);

    // More EXIF than fits into a JPEG segment.
    write_picture(in_folder("a.tif"), make_smooth(8, 8, LENSPROF_LAYOUT_RGB));
    edit(in_folder("a.tif"), [](Exiv2::Image &image) {
        for (const char *key : {"Exif.Image.Artist", "Exif.Image.Copyright", "Exif.Image.ImageDescription",
                                "Exif.Image.Software", "Exif.Photo.UserComment"})
            image.exifData()[key] = std::string(19000, 'a');  // Exiv2 drops longer ones
    });
    WriteOptions options;
    options.metadata_from = in_folder("a.tif");
    const Picture picture = make_smooth(8, 8, LENSPROF_LAYOUT_RGB);
    assert_failure(LENSPROF_ERROR_WRITE,
                   "a.jpg: cannot write metadata: ", [&] { write_picture(in_folder("a.jpg"), picture, options); });
    assert_false(fs::exists(in_folder("a.jpg")));
}

// Several threads read pictures simultaneously.
void test_threads(void **) {
    make_source("s.jpg");
    std::vector<std::thread> threads;
    bool good[4] = {};
    for (int i = 0; i < 4; ++i) {
        threads.emplace_back([i, &good] {
            const std::string target = in_folder("t" + std::to_string(i) + ".tif");
            WriteOptions options;
            options.metadata_from = in_folder("s.jpg");
            good[i] = true;
            for (int run = 0; run < 20; ++run) {
                write_picture(target, read_picture(in_folder("s.jpg")), options);
                good[i] = good[i] && std::strcmp(read_metadata(target).key.camera_model, "Canon EOS 5D") == 0;
            }
        });
    }
    for (std::thread &thread : threads) thread.join();
    for (bool one : good) assert_true(one);
}

}  // namespace

#define TEST(name) cmocka_unit_test_setup(name, empty_folder)

int main() {
    Exiv2::LogMsg::setLevel(Exiv2::LogMsg::mute);
    Exiv2::XmpProperties::registerNs("http://ns.adobe.com/xmp/note/", "xmpNote");
    const CMUnitTest tests[] = {
        TEST(test_nothing_known),
        TEST(test_written_is_read),
        TEST(test_float_tiff_is_linear),
        TEST(test_texts),
        TEST(test_unit_and_sensor),
        TEST(test_sensor_by_pitch),
        TEST(test_sensor_of_a_crop),
        TEST(test_nikon_lens_of_numbers),
        TEST(test_lens_of_maker_note),
        TEST(test_lens_in_xmp),
        TEST(test_lens_of_canon_without_number),
        TEST(test_texts_as_bytes),
        TEST(test_maker_note_in_the_other_byte_order),
        TEST(test_style),
        TEST(test_exposure),
        TEST(test_manual_exposure),
        TEST(test_distance),
        TEST(test_copy),
        TEST(test_copy_to_any_tiff),
        TEST(test_copy_from_itself),
        TEST(test_exiftool),
        TEST(test_big_tiff_has_no_metadata),
        TEST(test_copy_fails),
        TEST(test_threads),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
