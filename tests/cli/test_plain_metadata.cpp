// EXIF, XMP, IPTC and comments without Exiv2: the program links the picture library without it. EXIF is built here, in
// every layout that the standard allows, independently of the code under test.
#include <cstring>

#include "picture_files.hpp"

#include "photo/pictures/exif_layout.hpp"
#include "photo/pictures/exif_tags.hpp"
#include "photo/pictures/exif_value.hpp"
#include "photo/pictures/note_place.hpp"
#include "photo/pictures/photoshop_block.hpp"

using namespace picture_files;

namespace {

enum : uint16_t {
    kByte = 1,
    kAscii = 2,
    kShort = 3,
    kLong = 4,
    kRational = 5,
    kUndefined = 7,
    kSignedRational = 10
};

// What stays the same in all layouts.
struct Layout {
    bool big = false, photo_first = false, descending = false, undefined_texts = false, long_numbers = false;
};

Bytes bytes_of(const std::string &text) { return {text.begin(), text.end()}; }

Bytes operator+(Bytes a, const Bytes &b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

bool holds(const Bytes &bytes, const std::string &text) {
    return std::search(bytes.begin(), bytes.end(), text.begin(), text.end()) != bytes.end();
}

size_t place_of(const Bytes &bytes, const std::string &text) {
    return size_t(std::search(bytes.begin(), bytes.end(), text.begin(), text.end()) - bytes.begin());
}

Bytes number(uint64_t value, size_t size, bool big) {
    Bytes bytes(size);
    for (size_t i = 0; i < size; i++) bytes[big ? size - 1 - i : i] = uint8_t(value >> 8 * i);
    return bytes;
}

struct Field {
    uint16_t tag, type;
    uint32_t count;
    Bytes values;
};

// A TIFF structure with directories that may lie in any order, and values after them.
class Builder {
public:
    explicit Builder(const Layout &layout) : layout_(layout) {}

    Field text(uint16_t tag, const std::string &value) const {
        const Bytes bytes = bytes_of(value + (layout_.undefined_texts ? "" : std::string(1, '\0')));
        return {tag, uint16_t(layout_.undefined_texts ? kUndefined : kAscii), uint32_t(bytes.size()), bytes};
    }
    Field integer(uint16_t tag, uint32_t value) const {
        const uint16_t type = layout_.long_numbers ? kLong : kShort;
        return {tag, type, 1, number(value, type == kLong ? 4 : 2, layout_.big)};
    }
    Field fraction(uint16_t tag, uint32_t above, uint32_t below, uint16_t type = kRational) const {
        return {tag, type, 1, number(above, 4, layout_.big) + number(below, 4, layout_.big)};
    }

    // The structure, with a pointer to `photo` in `image` if there are fields.
    Bytes build(std::vector<Field> image, std::vector<Field> photo) const {
        const auto table = [](size_t fields) { return 2 + 12 * fields + 4; };
        const size_t image_table = table(image.size() + !photo.empty()),
                     photo_table = photo.empty() ? 0 : table(photo.size());
        const size_t image_at = layout_.photo_first ? 8 + photo_table : 8,
                     photo_at = layout_.photo_first ? 8 : 8 + image_table;
        if (!photo.empty()) image.push_back({0x8769, kLong, 1, number(photo_at, 4, layout_.big)});
        Bytes block =
            bytes_of(layout_.big ? "MM" : "II") + number(42, 2, layout_.big) + number(image_at, 4, layout_.big);
        block.resize(8 + image_table + photo_table);
        write(image, image_at, block);
        if (!photo.empty()) write(photo, photo_at, block);
        return block;
    }

private:
    void write(std::vector<Field> fields, size_t at, Bytes &block) const {
        std::sort(fields.begin(), fields.end(),
                  [&](const Field &a, const Field &b) { return layout_.descending ? a.tag > b.tag : a.tag < b.tag; });
        Bytes table = number(fields.size(), 2, layout_.big);
        for (Field field : fields) {
            table = table + number(field.tag, 2, layout_.big) + number(field.type, 2, layout_.big)
                    + number(field.count, 4, layout_.big);
            if (field.values.size() > 4) {
                const size_t place = block.size();
                block = block + field.values;
                if (block.size() % 2) block.push_back(0);
                field.values = number(place, 4, layout_.big);
            }
            field.values.resize(4);
            table = table + field.values;
        }
        table = table + Bytes(4);
        std::copy(table.begin(), table.end(), block.begin() + long(at));
    }

    Layout layout_;
};

std::vector<Field> image_fields(const Builder &make) {
    return {make.text(271, "Lensprof"), make.text(272, "Simulated camera"), make.integer(274, 6),
            make.text(305, "A program")};
}

std::vector<Field> photo_fields(const Builder &make) {
    return {make.fraction(0x829a, 1, 320),
            make.fraction(0x829d, 56, 10),
            make.integer(0x8827, 400),
            make.fraction(0x9205, 3, 1),
            make.fraction(0x9206, 7, 2),
            make.fraction(0x920a, 355, 10),
            make.text(0x9003, "2024:01:02 03:04:05"),
            make.text(0x9291, "07"),
            make.text(0xa434, "Zoom 24-70mm F2.8"),
            make.text(0xa431, "0123"),
            make.text(0xa435, "9"),
            make.integer(0xa402, 1),
            make.integer(0xa405, 53)};
}

void check(const PictureMetadata &metadata) {
    assert_ok(lensprof_profile_key_validate(&metadata.key));
    assert_string_equal(metadata.key.camera_maker, "Lensprof");
    assert_string_equal(metadata.key.camera_model, "Simulated camera");
    assert_string_equal(metadata.key.lens, "Zoom 24-70mm F2.8");
    assert_string_equal(metadata.key.unit, "0123/9");
    assert_string_equal(metadata.software.c_str(), "A program");
    assert_string_equal(metadata.captured.c_str(), "2024:01:02 03:04:05.07");
    assert_int_equal(metadata.orientation, 6);
    assert_close(metadata.exposure_time_s.value_or(0), 1 / 320.0, 1e-12);
    assert_close(metadata.f_number.value_or(0), 5.6, 1e-12);
    assert_close(metadata.open_f_number.value_or(0), std::exp2(1.5), 1e-12);
    assert_close(metadata.iso.value_or(0), 400, 0);
    assert_close(metadata.key.focal_mm, 35.5, 1e-12);
    assert_close(metadata.key.distance_m, 3.5, 1e-12);
    assert_close(metadata.key.crop_factor, 53 / 35.5, 1e-12);
    assert_true(metadata.is_manual);
}

Bytes plain(const char *name) {
    write_picture(in_folder(name), make_smooth(48, 32, LENSPROF_LAYOUT_RGB));
    return load(in_folder(name));
}

Bytes segment(uint8_t marker, const Bytes &content) {
    return Bytes{0xff, marker} + number(content.size() + 2, 2, true) + content;
}

Bytes jpeg_with_segments(const Bytes &segments) {
    const Bytes picture = plain("plain.jpg");
    return Bytes(picture.begin(), picture.begin() + 2) + segments + Bytes(picture.begin() + 2, picture.end());
}

Bytes jpeg_of(const Bytes &block) {
    return jpeg_with_segments(segment(0xe1, bytes_of(std::string("Exif\0\0", 6)) + block));
}

// libpng does not check the sums of chunks that it does not know; here they are right.
Bytes png_of(const std::string &type, const Bytes &content) {
    Bytes covered = bytes_of(type) + content;
    uint32_t sum = 0xffffffffu;
    for (const uint8_t byte : covered) {
        sum ^= byte;
        for (int bit = 0; bit < 8; ++bit) sum = sum >> 1 ^ (sum & 1 ? 0xedb88320u : 0u);
    }
    const Bytes picture = plain("plain.png"), chunk = number(content.size(), 4, true) + covered + number(~sum, 4, true);
    return Bytes(picture.begin(), picture.begin() + 33) + chunk + Bytes(picture.begin() + 33, picture.end());
}

Bytes hexadecimal_profile(const Bytes &block) {
    const Bytes all = bytes_of(std::string("Exif\0\0", 6)) + block;
    std::string text = std::string("Raw profile type exif") + '\0' + "\nexif\n      " + std::to_string(all.size());
    char digits[3];
    for (size_t i = 0; i < all.size(); ++i) {
        std::snprintf(digits, sizeof digits, "%02x", all[i]);
        text += (i % 36 ? "" : "\n") + std::string(digits);
    }
    return bytes_of(text + "\n");
}

// A TIFF of one strip; as a DNG its pixels are a mosaic.
Bytes tiff_of(const Layout &layout, bool is_dng) {
    const Builder make(layout);
    std::vector<Field> image = image_fields(make);
    const Field sizes[] = {make.integer(256, 16),
                           make.integer(257, 8),
                           make.integer(258, 8),
                           make.integer(259, 1),
                           make.integer(262, is_dng ? 32803 : 1),
                           make.integer(277, 1),
                           make.integer(278, 8),
                           {279, kLong, 1, number(128, 4, layout.big)},
                           {273, kLong, 1, number(0, 4, layout.big)}};
    image.insert(image.end(), std::begin(sizes), std::end(sizes));
    if (is_dng) image.push_back({50706, kByte, 4, {1, 4, 0, 0}});
    Bytes block = make.build(image, photo_fields(make));
    image[image_fields(make).size() + 8].values = number(block.size(), 4, layout.big);
    block = make.build(image, photo_fields(make));
    return block + Bytes(128, 77);
}

std::vector<Layout> layouts() {
    std::vector<Layout> all;
    for (int bits = 0; bits < 32; ++bits)
        all.push_back({(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0, (bits & 16) != 0});
    return all;
}

void test_every_layout(void **) {
    for (const Layout &layout : layouts()) {
        const Builder make(layout);
        const Bytes block = make.build(image_fields(make), photo_fields(make));
        save(in_folder("a.jpg"), jpeg_of(block));
        check(read_metadata(in_folder("a.jpg")));
        save(in_folder("a.png"), png_of("eXIf", block));
        check(read_metadata(in_folder("a.png")));
        save(in_folder("b.png"), png_of("tEXt", hexadecimal_profile(block)));
        check(read_metadata(in_folder("b.png")));
        save(in_folder("a.tif"), tiff_of(layout, false));
        check(read_metadata(in_folder("a.tif")));
        save(in_folder("a.dng"), tiff_of(layout, true));
        check(read_metadata(in_folder("a.dng")));
        assert_int_equal(read_metadata(in_folder("a.dng")).key.processing, LENSPROF_PROCESSING_RAW);
        assert_int_equal(read_metadata(in_folder("a.dng")).size.width, 16);
    }
}

PictureMetadata read_block(const Bytes &block) {
    save(in_folder("a.jpg"), jpeg_of(block));
    return read_metadata(in_folder("a.jpg"));
}

void test_unusual_values(void **) {
    for (const bool big : {false, true}) {
        const Builder make({big});
        // no Exif directory; and fields of it in the main one
        assert_string_equal(read_block(make.build({make.text(272, "Model")}, {})).key.camera_model, "Model");
        assert_close(read_block(make.build({make.fraction(0x829a, 1, 50)}, {})).exposure_time_s.value_or(0), 0.02, 0);
        const PictureMetadata zero =
            read_block(make.build({}, {make.fraction(0x829a, 1, 0), make.fraction(0x829d, 0, 0),
                                       make.fraction(0x9206, 0, 1), make.integer(0x8827, 0)}));
        assert_false(zero.exposure_time_s || zero.f_number || zero.iso);
        assert_close(zero.key.distance_m, LENSPROF_UNKNOWN, 0);
        assert_true(std::isinf(read_block(make.build({}, {make.fraction(0x9206, 0xffffffffu, 1)})).key.distance_m));
        // APEX values: Tv -2 is 4 s
        assert_close(read_block(make.build({}, {make.fraction(0x9201, uint32_t(-2), 1, kSignedRational)}))
                         .exposure_time_s.value_or(0),
                     4, 1e-12);
        // ISO above 16 bits, whose kind SensitivityType states
        const Field large{0x8833, kLong, 1, number(102400, 4, big)}, other{0x8832, kLong, 1, number(7, 4, big)};
        assert_close(read_block(make.build({}, {make.integer(0x8827, 65535), make.integer(0x8830, 3), large, other}))
                         .iso.value_or(0),
                     102400, 0);
        assert_close(read_block(make.build({}, {make.integer(0x8830, 2), large, other})).iso.value_or(0), 7, 0);
        assert_close(read_block(make.build({}, {{0x8827, kByte, 1, {100}}})).iso.value_or(0), 100, 0);
        assert_close(
            read_block(make.build({}, {{0x8827, kShort, 2, number(200, 2, big) + number(0, 2, big)}})).iso.value_or(0),
            200, 0);
        const Field lens{0xa432, kRational, 4,
                         number(50, 4, big) + number(1, 4, big) + number(50, 4, big) + number(1, 4, big)
                             + number(18, 4, big) + number(10, 4, big) + number(18, 4, big) + number(10, 4, big)};
        assert_close(read_block(make.build({}, {lens})).open_f_number.value_or(0), 1.8, 1e-12);
        // a pointer of 16 bits
        Bytes block = make.build({make.text(272, "Model")}, {make.integer(0x8827, 100)});
        const Bytes entry = number(0x8769, 2, big) + number(kLong, 2, big);
        const size_t at = place_of(block, {entry.begin(), entry.end()}) + 2;
        const Bytes narrow = number(kShort, 2, big) + number(1, 4, big)
                             + (big ? Bytes(block.begin() + long(at) + 8, block.begin() + long(at) + 10) + Bytes(2)
                                    : Bytes(block.begin() + long(at) + 6, block.begin() + long(at) + 10));
        std::copy(narrow.begin(), narrow.end(), block.begin() + long(at));
        assert_close(read_block(block).iso.value_or(0), 100, 0);
    }
}

// Values that are large or lie outside count as missing; directories that lead to each other end.
void test_hostile_structures(void **) {
    for (const bool big : {false, true}) {
        const Builder make({big});
        const Field huge{0xa434, kAscii, 0xffffffffu, number(8, 4, big) + Bytes(4)},
            far{0xa431, kAscii, 100, number(0, 4, big) + Bytes(4)};
        PictureMetadata metadata = read_block(make.build({}, {huge, far, make.integer(0x8827, 100)}));
        assert_string_equal(metadata.key.lens, "");
        assert_close(metadata.iso.value_or(0), 100, 0);
        for (const uint32_t target : {0u, 4u, 8u, 0x7fffffffu, 0xffffffffu}) {
            metadata = read_block(make.build({make.text(272, "Model"),
                                              {0x8769, kLong, 1, number(target, 4, big)},
                                              {0x8825, kLong, 1, number(8, 4, big)}},
                                             {}));
            assert_string_equal(metadata.key.camera_model, "Model");
        }
        assert_string_equal(
            read_block(bytes_of(big ? "MM" : "II") + number(42, 2, big) + number(0, 4, big)).key.camera_model, "");
    }
    for (const char *text : {"", "Exif", "garbage of some length"})
        assert_string_equal(read_block(bytes_of(text)).key.camera_model, "");
}

// Every truncation and every value of every byte: what is read can be written and is read again.
void test_damaged_blocks(void **) {
    for (const Layout &layout : {Layout{false}, Layout{true, true}}) {
        const Builder make(layout);
        const Bytes block = make.build(
            {make.text(272, "Camera"), make.integer(274, 6)},
            {make.fraction(0x829a, 1, 320), make.integer(0x8827, 400), {0x927c, kUndefined, 8, Bytes(8, 1)}});
        const auto try_block = [](const Bytes &damaged) {
            const Exif exif = read_exif(damaged);
            read_text(exif, exif_tags::model);
            read_number(exif, {exif_tags::exposure_time, exif_tags::iso_speed_ratings});
            const Bytes written = exif_block(exif);
            const Exif again = read_exif(written);
            for (size_t i = 0; i < exif_groups; ++i) assert_true(again.fields[i].size() <= exif.fields[i].size());
            if (const ExifField *model = exif.find(exif_tags::model))
                assert_true(again.find(exif_tags::model)->bytes == model->bytes);
        };
        for (size_t size = 0; size < block.size(); ++size) {
            try_block(Bytes(block.begin(), block.begin() + long(size)));
            read_block(Bytes(block.begin(), block.begin() + long(size)));
        }
        for (size_t at = 0; at < block.size(); ++at)
            for (int value = 0; value < 256; ++value) {
                Bytes damaged = block;
                damaged[at] = uint8_t(value);
                try_block(damaged);
                if (value == 0 || value == 255) read_block(damaged);
            }
    }
}

const char *const packet_text =
    "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">"
    "<rdf:Description rdf:about=\"\" xmlns:aux=\"http://ns.adobe.com/exif/1.0/aux/\" "
    "xmlns:dc=\"http://purl.org/dc/elements/1.1/\" xmlns:xmp=\"http://ns.adobe.com/xap/1.0/\" aux:Lens=\"XF23mmF1.4 R\" "
    "dc:format=\"image/x-raw\" xmp:Thumbnails=\"old\"><dc:subject><rdf:Bag><rdf:li>words</rdf:li></rdf:Bag>"
    "</dc:subject></rdf:Description></rdf:RDF></x:xmpmeta>";

// A JPEG with EXIF whose maker note has offsets of its own from the start of the structure, XMP, IPTC and a comment.
Bytes full_jpeg(const Layout &layout) {
    const Builder make(layout);
    const std::string value = "a value of the note";
    const auto note_at = [&](size_t place) {
        return number(1, 2, layout.big) + number(6, 2, layout.big) + number(kAscii, 2, layout.big)
               + number(value.size(), 4, layout.big) + number(place + 18, 4, layout.big) + Bytes(4) + bytes_of(value);
    };
    const auto block_with = [&](const Bytes &note) {
        auto photo = photo_fields(make);
        photo.push_back({0x927c, kUndefined, uint32_t(note.size()), note});
        return make.build(image_fields(make), photo);
    };
    const Bytes first = block_with(note_at(0));
    const Bytes block = block_with(note_at(place_of(first, value) - 18));
    const Bytes caption = Bytes{0x1c, 2, 120, 0, 9} + bytes_of("A caption");
    const Bytes resources = bytes_of("8BIM") + Bytes{4, 4, 0, 0} + number(caption.size(), 4, true) + caption;
    return jpeg_with_segments(
        segment(0xe1, bytes_of(std::string("Exif\0\0", 6)) + block)
        + segment(0xe1, bytes_of(std::string("http://ns.adobe.com/xap/1.0/") + '\0' + packet_text))
        + segment(0xed, bytes_of(std::string("Photoshop 3.0") + '\0') + resources)
        + segment(0xfe, bytes_of("A comment")));
}

// Where the note's value is in a file, from the start of the structure at `base`; checks that its offset leads there.
void check_note(const Bytes &file, size_t base, bool big) {
    const size_t value = place_of(file, "a value of the note");
    assert_true(value < file.size());
    const Bytes offset = number(value - base, 4, big);
    assert_true(std::equal(offset.begin(), offset.end(), file.begin() + long(value) - 8));
}

CorrectionMark some_mark() {
    CorrectionMark mark;
    mark.falloff = CorrectionMark::Falloff::removed;
    mark.software = "lensprof 9";
    mark.model = "a <model> & more";
    mark.source = "in.jpg";
    mark.digest = "0123456789abcdef";
    return mark;
}

// XMP, IPTC and comment of the source, as the format holds them.
void check_blocks(const std::string &name, const Bytes &file) {
    const std::string packet = read_xmp_packet(in_folder(name));
    const std::string type = name == "out.jpg" ? "image/jpeg" : name == "out.png" ? "image/png" : "image/tiff";
    for (const std::string &part : {std::string("words"), std::string("XF23mmF1.4 R"), type})
        assert_true(packet.find(part) != std::string::npos);
    assert_true(packet.find("Thumbnails") == std::string::npos);
    assert_true(holds(file, name == "out.png" ? "09412063617074696f6e" : "\tA caption"));
    if (name != "out.tif") assert_true(holds(file, "A comment"));
}

// Into every format, twice, so that the second copy replaces what the first one wrote.
void test_marked_copies(void **) {
    for (const Layout &layout : {Layout{false}, Layout{true}, Layout{true, true, true}}) {
        save(in_folder("in.jpg"), full_jpeg(layout));
        check_note(load(in_folder("in.jpg")), place_of(load(in_folder("in.jpg")), "Exif") + 6, layout.big);
        for (const char *name : {"out.jpg", "out.png", "out.tif"}) {
            plain(name);
            size_t first_size = 0;
            for (int time = 0; time < 2; ++time) {
                const CorrectionMark mark = some_mark();
                assert_true(copy_metadata(in_folder("in.jpg"), in_folder(name), &mark));
                const PictureMetadata metadata = read_metadata(in_folder(name));
                assert_true(metadata.mark.has_value());
                assert_true(metadata.mark->falloff == CorrectionMark::Falloff::removed);
                assert_string_equal(metadata.mark->model.c_str(), mark.model.c_str());
                assert_string_equal(metadata.mark->digest.c_str(), mark.digest.c_str());
                assert_string_equal(metadata.corrected_by.c_str(), "by lensprof 9, from in.jpg");
                assert_int_equal(metadata.key.processing, LENSPROF_PROCESSING_CORRECTED);
                check(metadata);
                const Bytes file = load(in_folder(name));
                const size_t base = name[4] == 'j'   ? place_of(file, "Exif") + 6
                                    : name[4] == 'p' ? place_of(file, "eXIf") + 4
                                                     : 0;
                check_note(file, base, layout.big);
                check_blocks(name, file);
                if (time) assert_int_equal(file.size(), first_size);
                first_size = file.size();
            }
            assert_near_pixels(make_smooth(48, 32, LENSPROF_LAYOUT_RGB), read_picture(in_folder(name)),
                               name[4] == 'j' ? 3 : 0);
        }
    }
}

// Offsets from the start of the structure move with a note; those from the start of the note do not.
void test_moved_notes(void **) {
    for (const bool big : {false, true})
        for (const size_t header : {0, 6, 8, 10, 12})
            for (const bool is_absolute : {false, true}) {
                const auto note_at = [&](size_t place) {
                    const size_t values = (is_absolute ? place : 0) + header + 2 + 24;
                    return Bytes(header, 'h') + number(2, 2, big) + number(1, 2, big) + number(kAscii, 2, big)
                           + number(30, 4, big) + number(values, 4, big) + number(2, 2, big) + number(kShort, 2, big)
                           + number(1, 4, big) + number(7, 2, big) + Bytes(2) + Bytes(30, 'v');
                };
                for (const auto &[from, to] : {std::pair<size_t, size_t>{100, 5000}, {70000, 12}, {20, 21}})
                    assert_true(moved_note(note_at(from), from, to) == note_at(to));
                assert_true(moved_note(note_at(0), 0, 300) == note_at(0));  // unknown place
            }
    uint64_t state = 1;
    for (int run = 0; run < 2000; ++run) {
        Bytes note(size_t(lp_random(&state) * 80));
        for (uint8_t &byte : note) byte = uint8_t(lp_random(&state) * (run % 2 ? 256 : 6));
        assert_int_equal(moved_note(note, 50, 90).size(), note.size());
    }
}

std::string output_of(const std::string &command) {
    std::string text;
    FILE *output = popen(command.c_str(), "r");
    for (char line[300]; fgets(line, sizeof line, output);) text += line;
    assert_int_equal(pclose(output), 0);
    return text;
}

void test_exiftool(void **) {
    if (system("exiftool -ver >/dev/null 2>&1") != 0) {
        print_message("needs package libimage-exiftool-perl\n");
        skip();
    }
    for (const bool big : {false, true}) {
        save(in_folder("in.jpg"), full_jpeg({big}));
        for (const std::string name : {"out.jpg", "out.png", "out.tif"}) {
            plain(name.c_str());
            const CorrectionMark mark = some_mark();
            assert_true(copy_metadata(in_folder("in.jpg"), in_folder(name), &mark));
            const std::string path = "'" + in_folder(name) + "'";
            const std::string text = output_of(
                "exiftool -n -s3 -ExposureTime -FNumber -ISO -LensModel -Model -Orientation "
                "-FocalLength -XMP:Falloff -XMP:Model -XMP:Subject -IPTC:Caption-Abstract "
                + path);
            assert_string_equal(text.c_str(),
                                "0.003125\n5.6\n400\nZoom 24-70mm F2.8\nSimulated camera\n6\n35.5\nremoved\n"
                                "a <model> & more\nwords\nA caption\n");
            assert_string_equal(output_of("exiftool -warning -error -s3 " + path).c_str(), "");
            assert_int_equal(system(("exiftool -q -overwrite_original -EXIF:ISO=800 " + path).c_str()), 0);
            assert_close(read_metadata(in_folder(name)).iso.value_or(0), 800, 0);
            assert_true(read_metadata(in_folder(name)).mark.has_value());
        }
    }
}

// XMP alone: the lens, the mark, and damage.
void test_packets(void **) {
    const auto with_packet = [](const std::string &packet) {
        save(in_folder("a.jpg"),
             jpeg_with_segments(segment(0xe1, bytes_of(std::string("http://ns.adobe.com/xap/1.0/") + '\0' + packet))));
        return read_metadata(in_folder("a.jpg"));
    };
    assert_string_equal(with_packet(packet_text).key.lens, "XF23mmF1.4 R");
    const std::string text = packet_text;
    for (size_t size = 0; size < text.size(); ++size) {
        const PictureMetadata metadata = with_packet(text.substr(0, size));
        assert_true(metadata.key.lens[0] == '\0' || size + 12 >= text.size());
    }
    for (size_t at = 0; at < text.size(); at += 3) {
        std::string damaged = text;
        damaged[at] = at % 2 ? '<' : '\xff';
        with_packet(damaged);
    }
    std::string deep;
    for (int level = 0; level < 9000; ++level) deep += "<a>";
    for (int level = 0; level < 9000; ++level) deep += "</a>";
    with_packet(deep);
    // a section whose text looks like markup
    const char *const section = "<![CDATA[a \" > <b> & ]]>";
    std::string other = text;
    other.replace(other.find("words"), 5, section);
    with_packet(other);
    plain("b.jpg");
    assert_true(copy_metadata(in_folder("a.jpg"), in_folder("b.jpg")));
    assert_true(read_xmp_packet(in_folder("b.jpg")).find(section) != std::string::npos);
    const auto read = mark_of_packet(packet_of_mark(some_mark()));
    assert_true(read.has_value());
    assert_string_equal(read->model.c_str(), "a <model> & more");
    assert_false(mark_of_packet("no packet").has_value());
}

// Copies of damaged files are complete or a Failure.
void test_damaged_copies(void **) {
    const Bytes good = full_jpeg({});
    const size_t end = place_of(good, "A comment");
    uint64_t state = 5;
    for (int run = 0; run < 300; ++run) {
        Bytes damaged = good;
        for (int k = 0; k < 3; ++k) damaged[size_t(lp_random(&state) * double(end))] = uint8_t(256 * lp_random(&state));
        save(in_folder("in.jpg"), damaged);
        const char *name = run % 3 == 0 ? "out.jpg" : run % 3 == 1 ? "out.png" : "out.tif";
        plain(name);
        try {
            copy_metadata(in_folder("in.jpg"), in_folder(name));
        } catch (const Failure &failure) {
            assert_int_equal(failure.group(), LENSPROF_ERROR_READ);
        }
        read_metadata(in_folder(name));
        read_picture(in_folder(name));
    }
}

// A last resource of odd length may lack its padding; IPTC written after it must be found again.
void test_unpadded_resources(void **) {
    const Bytes iptc = Bytes{0x1c, 2, 120, 0, 1, 'x'};
    const Bytes resources = bytes_of("8BIM") + Bytes{4, 12, 0, 0, 0, 0, 0, 3, 'o', 'd', 'd'};
    const Bytes all = codec::with_iptc(resources, iptc);
    assert_true(codec::iptc_of(all) == iptc);
    assert_true(codec::with_iptc(all, {}) == resources + Bytes(1));
}

}  // namespace

#define TEST(name) cmocka_unit_test_setup(name, empty_folder)

int main() {
    const CMUnitTest tests[] = {
        TEST(test_every_layout),       TEST(test_unusual_values), TEST(test_hostile_structures),
        TEST(test_damaged_blocks),     TEST(test_marked_copies),  TEST(test_moved_notes),
        TEST(test_exiftool),           TEST(test_packets),        TEST(test_damaged_copies),
        TEST(test_unpadded_resources),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
