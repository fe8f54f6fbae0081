// EXIF of PNG files: in the standard chunk, in a text chunk as Exiv2 writes it, or in both.
#include <cstring>
#include <set>

#include <exiv2/exiv2.hpp>  // before cmocka, which makes a macro of `fail`

#include "picture_files.hpp"

using namespace picture_files;

namespace {

// Lets `change` edit the metadata of a file.
void edit(const std::string &path, const std::function<void(Exiv2::Image &)> &change) {
    auto image = Exiv2::ImageFactory::open(path);
    image->readMetadata();
    change(*image);
    image->writeMetadata();
}

size_t count_of(const Bytes &bytes, const std::string &part) {
    size_t count = 0;
    for (auto at = bytes.begin(); (at = std::search(at, bytes.end(), part.begin(), part.end())) != bytes.end(); ++at)
        ++count;
    return count;
}

// Once, in the standard chunk, after the first and after further writes.
void test_png_chunk(void **) {
    PictureMetadata metadata = unknown_metadata();
    std::strcpy(metadata.key.camera_model, "Model");
    write_picture(in_folder("a.png"), make_smooth(33, 20, LENSPROF_LAYOUT_RGB));
    const Bytes without = load(in_folder("a.png"));
    for (double iso : {100, 200, 300}) {
        metadata.iso = iso;
        assert_true(write_metadata(in_folder("a.png"), metadata));
        const Bytes bytes = load(in_folder("a.png"));
        assert_int_equal(count_of(bytes, "eXIf"), 1);
        assert_int_equal(count_of(bytes, "Raw profile type exif"), 0);
        assert_close(read_metadata(in_folder("a.png")).iso.value_or(0), iso, 0);
    }
    edit(in_folder("a.png"),
         [](Exiv2::Image &image) { image.exifData()["Exif.Photo.FNumber"] = Exiv2::URational(4, 1); });
    assert_int_equal(count_of(load(in_folder("a.png")), "Raw profile type exif"),
                     1);  // from Exiv2: read and replaced
    assert_true(write_metadata(in_folder("a.png"), metadata));
    assert_int_equal(count_of(load(in_folder("a.png")), "Raw profile type exif"), 0);
    assert_close(read_metadata(in_folder("a.png")).f_number.value_or(0), 4, 0);
    write_picture(in_folder("b.png"), make_smooth(33, 20, LENSPROF_LAYOUT_RGB));
    assert_true(copy_metadata(in_folder("b.png"), in_folder("b.png")));  // nothing
    assert_true(load(in_folder("b.png")) == without);
}

// The chunks of a PNG file whose name is `type`, whole.
Bytes chunks_of(const Bytes &png, const std::string &type) {
    Bytes found;
    for (size_t at = 8; at + 12 <= png.size();) {
        const size_t size = 12 + (size_t(png[at + 1]) << 16 | size_t(png[at + 2]) << 8 | png[at + 3]);
        if (std::equal(type.begin(), type.end(), png.begin() + long(at) + 4))
            found.insert(found.end(), png.begin() + long(at), png.begin() + long(at + size));
        at += size;
    }
    return found;
}

// EXIF in the standard chunk and in a text chunk, in either order: the standard one counts, and only one is kept.
void test_png_with_both_chunks(void **) {
    constexpr long header = 8 + 25;
    PictureMetadata metadata = unknown_metadata();
    metadata.iso = 200;
    write_picture(in_folder("plain.png"), make_smooth(33, 20, LENSPROF_LAYOUT_RGB));
    const Bytes plain = load(in_folder("plain.png"));
    save(in_folder("b.png"), plain), save(in_folder("t.png"), plain);
    assert_true(write_metadata(in_folder("b.png"), metadata));
    edit(in_folder("t.png"), [](Exiv2::Image &image) {
        image.exifData()["Exif.Photo.ISOSpeedRatings"] = uint16_t(100);
        image.exifData()["Exif.Photo.FNumber"] = Exiv2::URational(4, 1);
    });
    const Bytes text = chunks_of(load(in_folder("t.png")), "zTXt"), chunk = chunks_of(load(in_folder("b.png")), "eXIf");
    assert_true(!text.empty() && !chunk.empty());
    for (const bool text_first : {true, false}) {
        Bytes both = plain;
        for (const Bytes &part : {text_first ? chunk : text, text_first ? text : chunk})
            both.insert(both.begin() + header, part.begin(), part.end());
        save(in_folder("both.png"), both);
        assert_close(read_metadata(in_folder("both.png")).iso.value_or(0), 200, 0);
        save(in_folder("b.png"), plain);
        assert_true(copy_metadata(in_folder("both.png"), in_folder("b.png")));
        auto image = Exiv2::ImageFactory::open(in_folder("b.png"));
        image->readMetadata();
        std::multiset<std::string> keys;
        for (const Exiv2::Exifdatum &datum : image->exifData()) keys.insert(datum.key());
        assert_int_equal(keys.count("Exif.Photo.ISOSpeedRatings"), 1);
        assert_int_equal(keys.count("Exif.Image.ExifTag"), 1);
    }
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_png_chunk),
        cmocka_unit_test(test_png_with_both_chunks),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
