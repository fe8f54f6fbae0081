// Files with more than one picture: what a corrected copy keeps, leaves out and names, and which files are refused.
#include <exiv2/exiv2.hpp>  // before cmocka, which makes a macro of `fail`

#include "cli_runs.hpp"

#include "photo/pictures/metadata.hpp"
#include "photo/pictures/other_parts.hpp"

using namespace cli_runs;

namespace {

using cli_runs::operator+;

Bytes operator+(Bytes a, const Bytes &b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

Bytes bytes_of(const std::string &text) { return {text.begin(), text.end()}; }

Bytes number(uint64_t value, int size, bool big = true) {
    Bytes bytes;
    for (int i = 0; i < size; i++) bytes.push_back(static_cast<uint8_t>(value >> 8 * (big ? size - 1 - i : i)));
    return bytes;
}

uint64_t value_at(const Bytes &bytes, size_t place, int size) {
    uint64_t value = 0;
    assert_true(place + size_t(size) <= bytes.size());
    for (int i = 0; i < size; i++) value = value << 8 | bytes[place + size_t(i)];
    return value;
}

Bytes segment(int marker, const Bytes &content) {
    return Bytes{0xff, uint8_t(marker)} + number(content.size() + 2, 2) + content;
}

Bytes jpeg(uint32_t width, uint32_t height) {
    write_jpeg_file(work("jpeg"), make_smooth(width, height, LENSPROF_LAYOUT_RGB), {});
    const Bytes bytes = load(work("jpeg"));
    fs::remove(work("jpeg"));
    return bytes;
}

Bytes with_segments(const Bytes &picture, const Bytes &segments) {
    return Bytes(picture.begin(), picture.begin() + 2) + segments + Bytes(picture.begin() + 2, picture.end());
}

Bytes xmp_segment(const std::string &attributes, const std::string &content = "") {
    return segment(0xe1, bytes_of(std::string("http://ns.adobe.com/xap/1.0/") + '\0'
                                  + "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF "
                                    "xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\"><rdf:Description "
                                    "rdf:about=\"\" "
                                  + attributes + ">" + content + "</rdf:Description></rdf:RDF></x:xmpmeta>"));
}

constexpr uint32_t gain_map = 0, preview = 0x010002, stereo = 0x020002, baseline = 0x030000;

struct Entry {
    uint32_t type;
    Bytes bytes;
    int64_t error = 0;  // of the stated offset
};

// A multi-picture JPEG (CIPA DC-007), written independently of the code under test.
Bytes multi_picture(const std::vector<Entry> &others, bool big, const Bytes &segments = {}, uint32_t first = baseline) {
    const Bytes picture = with_segments(jpeg(80, 60), segments);
    const size_t at = 2 + segments.size(), index_bytes = 4 + 4 + 8 + 2 + 36 + 4 + 16 * (others.size() + 1);
    const size_t whole = picture.size() + index_bytes;
    const auto n = [&](uint64_t value, int size) { return number(value, size, big); };
    Bytes index = bytes_of(big ? "MM" : "II") + n(42, 2) + n(8, 4) + n(3, 2) + n(0xb000, 2) + n(7, 2) + n(4, 4)
                  + bytes_of("0100") + n(0xb001, 2) + n(4, 2) + n(1, 4) + n(others.size() + 1, 4) + n(0xb002, 2)
                  + n(7, 2) + n(16 * (others.size() + 1), 4) + n(50, 4) + n(0, 4);
    index = index + n(first, 4) + n(whole, 4) + n(0, 4) + n(0, 4);
    uint64_t place = whole;
    Bytes rest;
    for (const Entry &entry : others) {
        index = index + n(entry.type, 4) + n(entry.bytes.size(), 4) + n(place - (at + 8) + uint64_t(entry.error), 4)
                + n(0, 4);
        place += entry.bytes.size();
        rest = rest + entry.bytes;
    }
    const Bytes file = Bytes(picture.begin(), picture.begin() + long(at))
                       + segment(0xe2, bytes_of(std::string("MPF\0", 4)) + index)
                       + Bytes(picture.begin() + long(at), picture.end());
    assert_int_equal(file.size(), whole);
    return file + rest;
}

// A copy of `file` as the commands write it, with the metadata of the original.
Bytes copy_of(const Bytes &file, const std::string &target) {
    save(work("in.jpg"), file);
    WriteOptions options;
    options.metadata_from = work("in.jpg");
    assert_true(write_picture(work(target), read_picture(work("in.jpg")), options));
    return load(work(target));
}

size_t find(const Bytes &bytes, const std::string &text) {
    return size_t(std::search(bytes.begin(), bytes.end(), text.begin(), text.end()) - bytes.begin());
}
bool holds(const Bytes &bytes, const std::string &text) { return find(bytes, text) < bytes.size(); }

// The pictures after the first one, at the offsets of the index, which is in "MM".
std::vector<Bytes> pictures_of(const Bytes &file) {
    const size_t at = find(file, std::string("MPF\0", 4)) + 4;
    std::vector<Bytes> pictures;
    if (at > file.size()) return pictures;
    assert_int_equal(value_at(file, at, 4), 0x4d4d002a);
    const size_t directory = at + value_at(file, at + 4, 4), count = value_at(file, directory + 2 + 12 + 8, 4),
                 entries = at + value_at(file, directory + 2 + 24 + 8, 4);
    assert_int_equal(value_at(file, entries + 8, 4), 0);
    const size_t first = value_at(file, entries + 4, 4);
    assert_int_equal(value_at(file, first - 2, 2), 0xffd9);
    for (size_t i = 1; i < count; i++) {
        const size_t start = at + value_at(file, entries + 16 * i + 8, 4),
                     size = value_at(file, entries + 16 * i + 4, 4);
        assert_true(start >= first && start + size <= file.size());
        pictures.emplace_back(file.begin() + long(start), file.begin() + long(start + size));
    }
    return pictures;
}

void assert_pictures(const Bytes &file, const std::vector<Bytes> &wanted) {
    assert_true(pictures_of(file) == wanted);
    read_picture(work("out.jpg"));
}

Words left_out() { return other_parts(work("in.jpg"), work("out.jpg")).left_out; }

Bytes map_of_hdr() {
    return with_segments(jpeg(20, 15), xmp_segment("xmlns:hdrgm=\"http://ns.adobe.com/hdr-gain-map/1.0/\" "
                                                   "hdrgm:Version=\"1.0\" hdrgm:GainMapMax=\"3\""));
}

const char *const container =
    "xmlns:hdrgm=\"http://ns.adobe.com/hdr-gain-map/1.0/\" "
    "xmlns:Container=\"http://ns.google.com/photos/1.0/container/\" "
    "xmlns:Item=\"http://ns.google.com/photos/1.0/container/item/\" hdrgm:Version=\"1.0\"";
const char *const directory =
    "<Container:Directory><rdf:Seq><rdf:li rdf:parseType=\"Resource\"><Container:Item Item:Semantic=\"Primary\" "
    "Item:Mime=\"image/jpeg\"/></rdf:li><rdf:li rdf:parseType=\"Resource\"><Container:Item Item:Semantic=\"GainMap\" "
    "Item:Mime=\"image/jpeg\" Item:Length=\"1234\"/></rdf:li></rdf:Seq></Container:Directory>";

// In both byte orders, with one and several pictures, and with offsets that another program left wrong.
void test_gain_maps_are_kept(void **) {
    const Bytes map = map_of_hdr(), depth = jpeg(30, 20);
    for (const bool big : {false, true})
        for (const int64_t error : {0, 100, -70}) {
            assert_pictures(copy_of(multi_picture({{gain_map, map, error}}, big), "out.jpg"), {map});
            assert_true(left_out().empty());
            const auto file = multi_picture({{gain_map, map, error}, {gain_map, depth, error}}, big);
            assert_pictures(copy_of(file, "out.jpg"), {map, depth});
        }
    // previews show the uncorrected picture
    const auto file = multi_picture({{preview, depth}, {gain_map, map}, {preview, jpeg(40, 30)}}, true);
    assert_pictures(copy_of(file, "out.jpg"), {map});
    assert_int_equal(left_out().size(), 2);
    assert_true(contains(left_out()[0], "preview"));
    assert_false(holds(copy_of(multi_picture({{preview, depth}}, false), "out.jpg"), "MPF"));
    assert_true(contains(left_out().at(0), "preview"));
}

// The list of parts and the version of the gain map stay in a JPEG and not in a TIFF.
void test_tags_of_gain_maps(void **) {
    const Bytes map = map_of_hdr();
    const std::string iso = "urn:iso:std:iso:ts:21496:-1";
    const Bytes segments = xmp_segment(container, directory) + segment(0xe2, bytes_of(iso + '\0') + number(0, 4));
    const Bytes file = multi_picture({{gain_map, map}}, true, segments), copy = copy_of(file, "out.jpg");
    assert_pictures(copy, {map});
    const Bytes head(copy.begin(), copy.begin() + long(find(copy, "MPF")));
    for (const std::string &tag : {iso, std::string("hdrgm:Version=\"1.0\""), std::string("Item:Semantic=\"GainMap\""),
                                   std::string("Item:Length=\"1234\"")})
        if (!holds(head, tag)) fail_msg("%s is missing", tag.c_str());
    copy_of(file, "out.tif");
    const std::string packet = read_xmp_packet(work("out.tif"));
    assert_false(contains(packet, "hdrgm"));
    assert_false(contains(packet, "Container"));
    const auto parts = other_parts(work("in.jpg"), work("out.tif")).left_out;
    assert_int_equal(parts.size(), 1);
    assert_string_equal(parts[0].c_str(), "a gain map (HDR)");
}

void test_data_after_the_picture(void **) {
    const Bytes video = number(24, 4) + bytes_of("ftypmp42") + Bytes(500, 7);
    const std::string motion =
        "xmlns:GCamera=\"http://ns.google.com/photos/1.0/camera/\" GCamera:MotionPhoto=\"1\" "
        "GCamera:MicroVideoOffset=\"512\"";
    const Bytes picture = jpeg(80, 60);
    const Bytes copy = copy_of(with_segments(picture, xmp_segment(motion)) + video, "out.jpg");
    assert_true(Bytes(copy.end() - long(video.size()), copy.end()) == video);
    assert_true(holds(copy, "MicroVideoOffset=\"512\""));
    assert_true(left_out().empty());
    copy_of(with_segments(picture, xmp_segment(motion)) + video, "out.tif");
    assert_false(contains(read_xmp_packet(work("out.tif")), "Video"));
    const Bytes samsung = Bytes(100, 3) + bytes_of("SEFT");
    assert_true(holds(copy_of(picture + samsung, "out.jpg"), "SEFT"));
    // nothing lists these
    assert_false(holds(copy_of(picture + video, "out.jpg"), "ftypmp42"));
    assert_true(contains(left_out().at(0), "a video"));
    copy_of(picture + jpeg(20, 10), "out.jpg");
    assert_true(contains(left_out().at(0), "another picture"));
    copy_of(picture + Bytes(40, 'x') + Bytes(40, 'y'), "out.jpg");
    assert_true(contains(left_out().at(0), "80 bytes"));
    copy_of(picture + Bytes(4000, 0), "out.jpg");
    assert_true(left_out().empty());
    copy_of(with_segments(picture, segment(0xe1, bytes_of("http://ns.adobe.com/xmp/extension/") + Bytes(80, 0))),
            "out.jpg");
    assert_true(contains(left_out().at(0), "extended XMP"));
}

// An index that is cut off, points outside the file or at something else, or counts wrongly.
void test_damaged_indices(void **) {
    const Bytes map = map_of_hdr(), good = multi_picture({{gain_map, map}}, true);
    const size_t at = find(good, "MPF");
    for (const auto &[place, value] : std::vector<std::pair<size_t, uint8_t>>{{4, 'X'},
                                                                              {8, 0x7f},
                                                                              {12, 0xff},
                                                                              {38, 0xb1},
                                                                              {15 + 12 + 10, 9},
                                                                              {12 + 2 + 24 + 7, 1},
                                                                              {12 + 2 + 24 + 8, 0x70},
                                                                              {4 + 50 + 16 + 4, 0x7f},
                                                                              {4 + 50 + 16 + 5, 0xff}}) {
        Bytes file = good;
        file[at + place] = value;
        const Bytes copy = copy_of(file, "out.jpg");
        if (holds(copy, "MPF") || left_out().size() != 1 || !contains(left_out()[0], "index (MPF) is damaged"))
            fail_msg("byte %zu: %zu left out", place, left_out().size());
        read_picture(work("out.jpg"));
    }
    const Bytes cut(good.begin(), good.end() - 30);
    copy_of(cut, "out.jpg");
    assert_true(contains(left_out().at(0), "damaged"));
}

// An index without another picture, alone or with entries that the camera left empty, is not damaged: what follows the
// picture is named by what it is, as without an index.
void test_empty_indices(void **) {
    const Bytes video = number(24, 4) + bytes_of("ftypmp42") + Bytes(500, 7);
    for (const int entries : {0, 1, 3}) {
        const Bytes file = multi_picture(std::vector<Entry>(size_t(entries), Entry{preview, {}}), true);
        for (const auto &[after, left] : std::vector<std::pair<Bytes, std::string>>{
                 {{}, ""}, {Bytes(4000, 0), ""}, {video, "a video"}, {jpeg(20, 10), "another picture"}}) {
            assert_false(holds(copy_of(file + after, "out.jpg"), "MPF"));
            const Words names = left_out();
            if (names.size() != !left.empty() || (!left.empty() && !contains(names[0], left)))
                fail_msg("%d entries: %s instead of %s", entries, names.empty() ? "" : names[0].c_str(), left.c_str());
        }
    }
}

// Previews are left out, but not what follows them, which the index does not list.
void test_data_after_previews(void **) {
    const Bytes video = number(24, 4) + bytes_of("ftypmp42") + Bytes(500, 7),
                samsung = Bytes(100, 3) + bytes_of("SEFT");
    const std::string motion = "xmlns:GCamera=\"http://ns.google.com/photos/1.0/camera/\" GCamera:MotionPhoto=\"1\"";
    const Bytes plain = multi_picture({{preview, jpeg(8, 8)}, {preview, jpeg(4, 4)}}, true),
                listing = multi_picture({{preview, jpeg(8, 8)}}, true, xmp_segment(motion));
    assert_false(holds(copy_of(plain + video, "out.jpg"), "ftypmp42"));
    assert_int_equal(left_out().size(), 3);
    assert_true(contains(left_out()[2], "a video"));
    copy_of(plain + Bytes(4000, 0), "out.jpg");
    assert_int_equal(left_out().size(), 2);
    for (const auto &[file, after] : std::vector<std::pair<Bytes, Bytes>>{{listing, video}, {plain, samsung}}) {
        const Bytes copy = copy_of(file + after, "out.jpg");
        assert_true(Bytes(copy.end() - long(after.size()), copy.end()) == after);
        assert_false(holds(copy, "MPF"));
        for (const std::string &name : left_out()) assert_true(contains(name, "preview"));
    }
}

// Entries that share bytes are damaged. With the previews left out, a part of the other picture would be missing.
void test_overlapping_entries(void **) {
    const Bytes map = map_of_hdr();
    const auto both = [&](int64_t error) {
        return multi_picture({{preview, jpeg(8, 8)}, {gain_map, map}, {preview, map, error}}, true);
    };
    assert_pictures(copy_of(both(0), "out.jpg"), {map});
    const Bytes twice = both(-int64_t(map.size()));
    copy_of(Bytes(twice.begin(), twice.end() - long(map.size())), "out.jpg");
    assert_int_equal(left_out().size(), 1);
    assert_true(contains(left_out()[0], "index (MPF) is damaged"));
}

// Any number of bytes 0xff may precede a marker.
void test_padded_markers(void **) {
    const Bytes map = map_of_hdr(), padded = multi_picture({{gain_map, map}}, true, Bytes(300000, 0xff));
    assert_pictures(copy_of(padded, "out.jpg"), {map});
    assert_true(left_out().empty());
}

// Changed and cut files never crash, and what is written can be read.
void test_hostile_files(void **) {
    const Bytes good =
        multi_picture({{preview, jpeg(8, 8)}, {gain_map, map_of_hdr()}}, false, xmp_segment(container, directory));
    uint64_t state = 1;
    for (int i = 0; i < 150; i++) {
        Bytes file = good;
        const size_t index = find(good, "MPF");
        for (int k = 0; k < 3; k++) file[index + size_t(lp_random(&state) * 100)] = uint8_t(256 * lp_random(&state));
        if (i % 3 == 0) file.resize(size_t(lp_random(&state) * double(good.size())));
        save(work("in.jpg"), file);
        try {
            copy_of(file, "out.jpg");
            read_picture(work("out.jpg"));
            several_pictures(work("in.jpg"));
        } catch (const Failure &failure) {
            assert_int_equal(failure.group(), LENSPROF_ERROR_READ);
        }
    }
}

// Apple's maker note: the other entries and their values stay.
void test_apple_maker_note(void **) {
    const auto entry = [](uint32_t tag, uint32_t type, uint32_t value) {
        return number(tag, 2) + number(type, 2) + number(1, 4) + number(value, 4);
    };
    const Bytes note = bytes_of(std::string("Apple iOS\0\0\1MM", 14)) + number(4, 2) + entry(1, 9, 14)
                       + entry(0x21, 10, 68) + entry(0x30, 10, 76) + entry(0x3f, 10, 84) + number(0, 4) + number(3, 4)
                       + number(2, 4) + number(5, 4) + number(4, 4) + number(7, 4) + number(6, 4);
    save(work("in.jpg"), multi_picture({{gain_map, map_of_hdr()}}, true));
    const auto edited = Exiv2::ImageFactory::open(work("in.jpg"));
    Exiv2::DataValue value(note.data(), long(note.size()));
    edited->exifData().add(Exiv2::ExifKey("Exif.Photo.MakerNote"), &value);
    edited->writeMetadata();
    const Bytes file = load(work("in.jpg"));
    assert_true(holds(file, std::string(note.begin(), note.end())));
    assert_true(holds(copy_of(file, "out.jpg"), std::string(note.begin(), note.end())));  // keeps the gain map
    const Bytes copy = copy_of(file, "out.tif");
    const size_t at = find(copy, "Apple iOS");
    assert_true(at < copy.size());
    assert_int_equal(value_at(copy, at + 14, 2), 2);
    assert_int_equal(value_at(copy, at + 16, 2), 1);
    assert_int_equal(value_at(copy, at + 28, 2), 0x3f);
    assert_int_equal(value_at(copy, at + 84, 4), 7);
}

// Of a JPEG XL container, before anything is decoded.
void test_gain_map_of_jxl(void **) {
    const auto box = [](const std::string &type, const Bytes &content) {
        return number(content.size() + 8, 4) + bytes_of(type) + content;
    };
    const Bytes start = box("JXL ", {'\r', '\n', 0x87, '\n'}) + box("ftyp", bytes_of("jxl ") + number(0, 4));
    save(work("a.jxl"), start + box("jxlc", Bytes(30, 9)));
    assert_true(other_parts(work("a.jxl"), work("a.tif")).left_out.empty());
    save(work("a.jxl"), start + box("jhgm", Bytes(30, 9)) + box("jxlc", Bytes(30, 9)));
    assert_string_equal(other_parts(work("a.jxl"), work("a.tif")).left_out.at(0).c_str(), "a gain map (HDR)");
}

struct Page {
    uint32_t width, height;
    uint32_t type = 0;
};

void write_pages(const std::string &path, const char *mode, const std::vector<Page> &pages) {
    TIFF *tiff = TIFFOpen(path.c_str(), mode);
    for (const Page &page : pages) {
        TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, page.width);
        TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, page.height);
        TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8);
        TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
        TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
        TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, page.height);
        if (page.type) TIFFSetField(tiff, TIFFTAG_SUBFILETYPE, page.type);
        Bytes pixels(page.width * page.height, 100);
        TIFFWriteEncodedStrip(tiff, 0, pixels.data(), tmsize_t(pixels.size()));
        TIFFWriteDirectory(tiff);
    }
    TIFFClose(tiff);
}

void test_pages(void **) {
    const Page page = {700, 500}, small = {160, 120};
    const struct {
        std::vector<Page> pages;
        const char *what;  // of the file; "" if it has one picture
        const char *left_out = "";
    } files[] = {
        {{page}, ""},
        {{page, page}, "has 2 pages"},
        {std::vector<Page>(40, small), "has 40 pages"},
        {std::vector<Page>(300, {10, 8}), "has 300 pages"},
        {std::vector<Page>(5000, {4, 3}), "has more than 4096 pages"},
        {{page, {700, 500, FILETYPE_PAGE}, {700, 500, FILETYPE_PAGE}}, "has 3 pages"},
        {{page, small}, ""},
        {{page, {400, 300}}, "has 2 pages"},
        {{page, small, small}, "has 3 pages"},
        {{page, page, small}, "has 3 pages"},
        {{page, {350, 250, FILETYPE_REDUCEDIMAGE}, small}, "has 2 pages"},
        {{page, {350, 250, FILETYPE_REDUCEDIMAGE}, {175, 125, FILETYPE_REDUCEDIMAGE}}, ""},
        {{page, {700, 500, FILETYPE_MASK}}, "", "a mask"},
    };
    for (const char *mode : {"wl", "wb", "w8l", "w8b"})
        for (const auto &file : files) {
            write_pages(work("a.tif"), mode, file.pages);
            const std::string what = several_pictures(work("a.tif")).what;
            if (what != file.what) fail_msg("%s, %s: '%s'", mode, file.what, what.c_str());
            const Words names = other_parts(work("a.tif"), work("b.tif")).left_out;
            assert_string_equal(names.empty() ? "" : names[0].c_str(), file.left_out);
        }
    // a chain that returns to its start, and one that leads outside the file
    write_pages(work("a.tif"), "wl", {page, page});
    Bytes bytes = load(work("a.tif"));
    for (const uint32_t next :
         {uint32_t(value_at(Bytes(bytes.rbegin(), bytes.rend()), bytes.size() - 8, 4)), 0x7fffffffu}) {
        const size_t first = size_t(value_at(Bytes(bytes.rbegin(), bytes.rend()), bytes.size() - 8, 4));
        Bytes changed = bytes;
        const size_t end = first + 2 + 12 * (bytes[first] + 256u * bytes[first + 1]);
        const Bytes offset = number(next, 4, false);
        std::copy(offset.begin(), offset.end(), changed.begin() + long(end));
        save(work("a.tif"), changed);
        several_pictures(work("a.tif"));
        read_picture(work("a.tif"));
        const Words names = other_parts(work("a.tif"), work("b.tif")).left_out;
        assert_int_equal(names.size(), next == 0x7fffffffu);
        if (!names.empty()) assert_true(contains(names[0], "damaged"));
    }
}

std::string database() {
    save_text(work("a.xml"), lensfun_text("One", {{35, 2.8, -0.4}}));
    must_exit(done, {"profile", "import", work("a.xml"), "--db", work("p.db")});
    return work("p.db");
}

void save_several() {
    write_pages(work("pages.tif"), "w", {{90, 80}, {90, 80}, {90, 80}});
    save(work("stereo.jpg"), multi_picture({{stereo, jpeg(80, 60)}}, true, {}, stereo | 0x20000000));
    fs::copy_file(work("stereo.jpg"), work("two.mpo"));
    PngKind animated{40, 30};
    animated.extra = [](png_structp png, png_infop info) {
        png_unknown_chunk chunk = {};
        static Bytes content = number(5, 4) + number(0, 4);
        std::memcpy(chunk.name, "acTL", 5);
        chunk.data = content.data(), chunk.size = content.size(), chunk.location = PNG_HAVE_IHDR;
        png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_ALWAYS, nullptr, 0);
        png_set_unknown_chunks(png, info, &chunk, 1);
    };
    Bytes rows(40 * 30 * 3, 90);
    write_png_file(work("moving.png"), animated, rows);
}

// Named, they are refused; in a folder, left out; commands that only read them print a note.
void test_commands(void **) {
    const std::string db = database();
    save_several();
    const struct {
        const char *name, *what, *step;
    } files[] = {{"pages.tif", "has 3 pages", "tiffsplit"},
                 {"stereo.jpg", "has 2 pictures", "exiftool -b -MPImage2"},
                 {"two.mpo", "has 2 pictures", "exiftool -b -MPImage2"},
                 {"moving.png", "is an animation of 5 frames", "ffmpeg"}};
    const Words apply = {"apply", "--profile", "1", "--db", db, "--set", "response=srgb", "-o", work("out")};
    for (const auto &file : files) {
        assert_refused(unreadable, apply + Words{work(file.name)}, {file.name, file.what, file.step});
        const std::string other = work(std::string("other") + fs::path(file.name).extension().string());
        fs::copy_file(work(file.name), other);
        assert_refused(unreadable, {"align", work(file.name), other, "-o", work("out")}, {file.what, file.step});
        for (const Words &reading : {Words{"bracket", work(file.name), other, "--times", "1,2", "--no-store"},
                                     Words{"build", work(file.name), other, "--no-store"}}) {
            const std::string err = run_words(reading).err;
            if (!contains(err, std::string(file.name) + ": " + file.what) || !contains(err, "only the first is used"))
                fail_msg("%s: %s", file.name, err.c_str());
        }
        fs::remove(other);
    }
    fs::create_directories(work("in"));
    for (const auto &file : files) fs::rename(work(file.name), work("in/") + file.name);
    const Bytes map = map_of_hdr();
    save(work("in/one.jpg"), multi_picture({{gain_map, map}}, true));
    const Outcome outcome = run_words(apply + Words{work("in")});
    assert_int_equal(outcome.code, unreadable);
    const std::string read = run_words({"build", work("in"), "--no-store"}).err;
    assert_true(contains(read, "only the first is used"));
    for (const auto &file : files) {
        assert_true(contains(outcome.err, std::string(file.name) + ": " + file.what));
        const bool is_copy = std::string(file.name) == "two.mpo";  // of stereo.jpg
        assert_true(contains(read, std::string(file.name) + ": " + (is_copy ? "left out: a copy" : file.what)));
        assert_false(fs::exists(work("out/") + file.name));
    }
    assert_true(pictures_of(load(work("out/one.jpg"))) == std::vector<Bytes>{map});
    const Outcome linear = run_words(apply + Words{work("in/one.jpg"), "--linear"});
    assert_int_equal(linear.code, done);
    assert_true(contains(linear.err, "one.jpg: left out of the copy: a gain map (HDR)"));
}

// One of each group of the table, and every command that reads files.
void test_known_kinds(void **) {
    const auto brand = [](const char *major) {
        return number(24, 4) + bytes_of(std::string("ftyp") + major) + number(0, 4) + bytes_of("isommp41");
    };
    const std::pair<Bytes, const char *> kinds[] = {
        {brand("isom"), "a video (MP4)"},
        {brand("qt  "), "a video (MOV)"},
        {number(8, 4) + bytes_of("wide") + Bytes(60, 1), "a video (MOV)"},
        {brand("M4A "), "sound"},
        {bytes_of("\x1a\x45\xdf\xa3") + bytes_of("....\x42\x82\x88matroska"), "a video (MKV)"},
        {bytes_of("\x1a\x45\xdf\xa3") + bytes_of("....\x42\x82\x84webm"), "a video (WebM)"},
        {bytes_of("RIFF") + number(9, 4) + bytes_of("AVI LIST"), "a video (AVI)"},
        {bytes_of("XISF0100") + Bytes(20, 0), "XISF"},
        {bytes_of("GIF89a") + Bytes(20, 1), "GIF"},
        {bytes_of("BM") + number(9999, 4) + Bytes(4, 0) + number(54, 4, false) + number(40, 4, false), "BMP"},
        {bytes_of("P6\n40 30\n255\n") + Bytes(40, 1), "Netpbm"},
        {bytes_of("8BPS") + number(1, 2) + Bytes(20, 0), "PSD"},
        {bytes_of("%PDF-1.7\n"), "PDF"},
        {bytes_of("PK\x03\x04") + Bytes(20, 0), "ZIP"},
        {number(12, 4) + bytes_of("jP  \r\n\x87\n") + Bytes(20, 0), "JPEG 2000"},
    };
    for (const auto &[bytes, name] : kinds) {
        save(work("clip one.jpg"), bytes);
        assert_refused(unreadable, {"calibrate", work("clip one.jpg"), "-o", work("out")}, {name});
    }
    save(work("clip one.mp4"), kinds[0].first);
    const std::string clip = work("clip one.mp4"), db = database();
    for (const Words &words : std::vector<Words>{{"build", clip},
                                                 {"build", clip, clip},
                                                 {"align", clip, "-o", work("out")},
                                                 {"bracket", clip, clip},
                                                 {"flat", clip},
                                                 {"apply", clip, "-o", work("out")},
                                                 {"apply", clip, "--profile", "1", "--db", db, "-o", work("out")},
                                                 {"profile", "import", clip, "--camera", "A", "--lens", "B"},
                                                 {"profile", "check", "--db", clip},
                                                 {"report", clip, "-o", work("a.html")},
                                                 {"response", clip}})
        assert_refused(unreadable, words, {"clip one.mp4", "is a video (MP4)", "ffmpeg -i '", "frame_%04d.png"});
    assert_refused(unreadable, {"calibrate", clip, "-o", work("out")}, {"clip one.mp4", "is a video (MP4)"});
    // the same container
    save(work("a.heic"), number(24, 4) + bytes_of("ftypmif1") + number(0, 4) + bytes_of("mif1heic") + Bytes(40, 0));
    assert_false(contains(run_words({"calibrate", work("a.heic"), "-o", work("out")}).err, "video"));
}

// Files in a folder that hold pictures which no command reads: one line per kind, by content. Others stay silent.
void test_known_kinds_in_folders(void **) {
    const std::string db = database(), in = work("in"), kinds_only = work("kinds");
    fs::create_directories(in + "/sub");
    fs::create_directories(kinds_only);
    const Bytes clip = number(24, 4) + bytes_of("ftypisom") + number(0, 4) + bytes_of("isommp41");
    for (const char *name : {"/a.mp4", "/sub/b.MP4", "/sub/c.bin"}) save(in + name, clip);
    save(kinds_only + "/d.mp4", clip);
    save(in + "/.hidden.mp4", clip);
    save(in + "/star.xisf", bytes_of("XISF0100") + Bytes(20, 0));
    save_text(in + "/notes.txt", "P");
    save_text(in + "/one.xmp", "<x:xmpmeta>"), save_text(in + "/pano.pto", "p f2\n"), save_text(in + "/thumbs.db", "");
    save(in + "/song.m4a", number(24, 4) + bytes_of("ftypM4A ") + number(0, 4));
    save(in + "/rest.zip", bytes_of("PK\x03\x04") + Bytes(20, 0));
    for (const char *name : {"/one.jpg", "/two.jpg"}) save(in + name, jpeg(name[1] == 'o' ? 80 : 90, 60));
    for (const Words &words :
         std::vector<Words>{{"apply", "--profile", "1", "--db", db, "--set", "response=srgb", "-o", work("out"), in},
                            {"build", "--no-store", in},
                            {"calibrate", "--no-store", in, "-o", work("calibrated")}}) {
        const std::string said = run_words(words).err;
        for (const std::string line : {"/a.mp4 and 2 more: left out: a video (MP4), which lensprof does not read; make "
                                       "frames of it first, for example with `ffmpeg -i ",
                                       "/star.xisf: left out: an XISF file, which lensprof does not read; convert it"})
            if (!contains(said, "warning: " + in + line)) fail_msg("%s: %s", words[0].c_str(), said.c_str());
        for (const char *silent : {"hidden", "notes", "xmp", "pto", "thumbs", "song", "zip"})
            if (contains(said, silent)) fail_msg("%s: %s", words[0].c_str(), said.c_str());
        assert_refused(usage,
                       Words(words.begin(), words.end() - (words[0] == "calibrate" ? 3 : 1)) + Words{kinds_only}
                           + (words[0] == "calibrate" ? Words{"-o", work("calibrated2")} : Words{}),
                       {"kinds: is a folder without pictures", "d.mp4: left out: a video (MP4)"});
    }
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_gain_maps_are_kept),
        CLI_TEST(test_tags_of_gain_maps),
        CLI_TEST(test_data_after_the_picture),
        CLI_TEST(test_damaged_indices),
        CLI_TEST(test_empty_indices),
        CLI_TEST(test_hostile_files),
        CLI_TEST(test_apple_maker_note),
        CLI_TEST(test_gain_map_of_jxl),
        CLI_TEST(test_pages),
        CLI_TEST(test_data_after_previews),
        CLI_TEST(test_overlapping_entries),
        CLI_TEST(test_padded_markers),
        CLI_TEST(test_commands),
        CLI_TEST(test_known_kinds),
        CLI_TEST(test_known_kinds_in_folders),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
