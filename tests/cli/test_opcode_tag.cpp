// Opcode lists in TIFF and DNG files written by libtiff, read back with libtiff and with exiftool.
#include "picture_files.hpp"

#include <sys/resource.h>

#include <cstdio>
#include <cstring>
#include <memory>

#include "formats/each_format.h"

#include "photo/pictures/opcode_tag.hpp"

using namespace picture_files;

namespace {

constexpr uint32_t width = 40, height = 30;

Bytes some_list(size_t bytes) {
    Bytes list = {0, 0, 0, 1, 0, 0, 0, 3, 1, 3, 0, 0, 0, 0, 0, 1, 0, 0, 0, 56};
    for (size_t i = list.size(); i < bytes; ++i) list.push_back(static_cast<uint8_t>(i * 37));
    list.resize(bytes);
    return list;
}

void set_image(TIFF *tiff, uint16_t photometric, uint32_t type, uint16_t bits, uint16_t samples) {
    TIFFSetField(tiff, TIFFTAG_SUBFILETYPE, type);
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, samples);
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 8u);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, photometric);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
}

void write_rows(TIFF *tiff, uint8_t seed) {
    std::vector<uint8_t> row(static_cast<size_t>(TIFFScanlineSize(tiff)));
    for (uint32_t y = 0; y < height; ++y) {
        for (size_t i = 0; i < row.size(); ++i) row[i] = static_cast<uint8_t>(seed + 7 * i + 13 * y);
        assert_int_equal(TIFFWriteScanline(tiff, row.data(), y, 0), 1);
    }
    assert_int_equal(TIFFWriteDirectory(tiff), 1);
}

// As in DNG files: a preview, and the raw image in the last of its SubIFDs.
std::string write_dng(const std::string &name, const char *mode, uint16_t children) {
    const std::string path = in_folder(name);
    TIFF *tiff = TIFFOpen(path.c_str(), mode);
    set_image(tiff, PHOTOMETRIC_RGB, FILETYPE_REDUCEDIMAGE, 8, 3);
    const uint8_t version[4] = {1, 4, 0, 0};
    TIFFSetField(tiff, TIFFTAG_DNGVERSION, version);
    TIFFSetField(tiff, TIFFTAG_SOFTWARE, "a camera");
    const std::vector<toff_t> offsets(children, 0);
    TIFFSetField(tiff, TIFFTAG_SUBIFD, children, offsets.data());
    write_rows(tiff, 1);
    for (uint16_t i = 1; i < children; ++i) {
        set_image(tiff, PHOTOMETRIC_RGB, FILETYPE_REDUCEDIMAGE, 8, 3);
        write_rows(tiff, static_cast<uint8_t>(50 + i));
    }
    set_image(tiff, PHOTOMETRIC_CFA, 0, 16, 1);
    const uint16_t repeat[2] = {2, 2};
    const uint8_t pattern[4] = {1, 2, 0, 1};
    const uint32_t area[4] = {2, 4, height, width};
    TIFFSetField(tiff, TIFFTAG_CFAREPEATPATTERNDIM, repeat);
    TIFFSetField(tiff, TIFFTAG_CFAPATTERN, 4, pattern);
    TIFFSetField(tiff, TIFFTAG_ACTIVEAREA, area);
    write_rows(tiff, 100);
    TIFFClose(tiff);
    return path;
}

std::string write_plain(const std::string &name, const char *mode, int pages = 1) {
    const std::string path = in_folder(name);
    TIFF *tiff = TIFFOpen(path.c_str(), mode);
    for (int page = 0; page < pages; ++page) {
        set_image(tiff, PHOTOMETRIC_RGB, 0, 8, 3);
        write_rows(tiff, static_cast<uint8_t>(page));
    }
    TIFFClose(tiff);
    return path;
}

// libtiff's view: all rows of the current directory, and the tag.
struct Seen {
    Bytes rows, list;
};

Seen look(TIFF *tiff, uint16_t tag) {
    Seen seen;
    Bytes row(static_cast<size_t>(TIFFScanlineSize(tiff)));
    for (uint32_t y = 0; y < height; ++y) {
        assert_int_equal(TIFFReadScanline(tiff, row.data(), y, 0), 1);
        seen.rows.insert(seen.rows.end(), row.begin(), row.end());
    }
    uint32_t count = 0;
    const uint8_t *bytes = nullptr;
    if (TIFFGetField(tiff, tag, &count, &bytes)) seen.list.assign(bytes, bytes + count);
    return seen;
}

// Main directories in their order, or the SubIFDs of the first.
std::vector<Seen> look_at(const std::string &path, uint16_t tag, bool children) {
    std::vector<Seen> all;
    TIFFSetWarningHandler(nullptr);  // warnings about tags unknown to libtiff
    TIFF *tiff = TIFFOpen(path.c_str(), "r");
    assert_non_null(tiff);
    uint16_t count = 0;
    const toff_t *found = nullptr;
    std::vector<toff_t> offsets;
    if (children && TIFFGetField(tiff, TIFFTAG_SUBIFD, &count, &found)) offsets.assign(found, found + count);
    if (!children) do
            all.push_back(look(tiff, tag));
        while (TIFFReadDirectory(tiff));
    for (const toff_t offset : offsets) {
        assert_int_equal(TIFFSetSubDirectory(tiff, offset), 1);
        all.push_back(look(tiff, tag));
    }
    TIFFClose(tiff);
    return all;
}

// All bytes of the old file are unchanged, except the 4 that point to the directory.
void assert_kept(const Bytes &before, const Bytes &after) {
    assert_true(after.size() > before.size());
    size_t first = before.size(), last = 0, changed = 0;
    for (size_t i = 0; i < before.size(); ++i)
        if (before[i] != after[i]) {
            first = std::min(first, i);
            last = i;
            ++changed;
        }
    assert_true(changed >= 1 && last - first < 4);
}

void test_raw_image_of_a_dng(void **) {
    for (const char *mode : {"wl", "wb"})
        for (const uint16_t children : {1, 3})
            for (const uint16_t tag : {tag_opcode_list2, tag_opcode_list3}) {
                const std::string in = write_dng("in.dng", mode, children), out = in_folder("out.dng");
                const Bytes before = load(in), list = some_list(77);
                write_opcode_list(in, out, tag, list);
                assert_true(load(in) == before);
                assert_kept(before, load(out));
                const std::vector<Seen> mains = look_at(out, tag, false), subs = look_at(out, tag, true),
                                        old = look_at(in, tag, true);
                assert_int_equal(mains.size(), 1);
                assert_true(mains[0].list.empty() && mains[0].rows == look_at(in, tag, false)[0].rows);
                assert_int_equal(subs.size(), children);
                for (uint16_t i = 0; i < children; ++i) {
                    assert_true(subs[i].rows == old[i].rows);
                    assert_true(i + 1 == children ? subs[i].list == list : subs[i].list.empty());
                }
                const OpcodeLists lists = read_opcode_lists(out);
                assert_true(lists.raw);
                assert_true((tag == tag_opcode_list2 ? lists.list2 : lists.list3) == list);
                assert_true((tag == tag_opcode_list2 ? lists.list3 : lists.list2).empty());
                assert_int_equal(lists.width, width - 4);
                assert_int_equal(lists.height, height - 2);
                assert_int_equal(lists.layout, LENSPROF_LAYOUT_GBRG);
            }
}

// An existing list is replaced, the other one stays; in place, and twice.
void test_replaced_in_place(void **) {
    const std::string path = write_dng("in.dng", "wb", 2);
    write_opcode_list(path, path, tag_opcode_list2, some_list(100));
    write_opcode_list(path, path, tag_opcode_list3, some_list(61));
    write_opcode_list(path, path, tag_opcode_list2, some_list(40));
    const Bytes nothing = {0, 0, 0, 0};  // stored in the directory itself
    const OpcodeLists lists = read_opcode_lists(path);
    assert_true(lists.list2 == some_list(40) && lists.list3 == some_list(61));
    assert_true(look_at(path, tag_opcode_list2, true).at(1).list == some_list(40));
    write_opcode_list(path, path, tag_opcode_list3, nothing);
    assert_true(read_opcode_lists(path).list3 == nothing);
    assert_true(look_at(path, tag_opcode_list3, true).at(1).list == nothing);
    assert_int_equal(files_in_folder(), 1);
}

// A TIFF without a raw image: the first page; later pages stay reachable.
void test_plain_tiff(void **) {
    for (const char *mode : {"wl", "wb"}) {
        const std::string in = write_plain("in.tif", mode, 3), out = in_folder("out.tif");
        write_opcode_list(in, out, tag_opcode_list3, some_list(60));
        assert_kept(load(in), load(out));
        const std::vector<Seen> pages = look_at(out, tag_opcode_list3, false),
                                old = look_at(in, tag_opcode_list3, false);
        assert_int_equal(pages.size(), 3);
        for (size_t i = 0; i < 3; ++i)
            assert_true(pages[i].rows == old[i].rows && pages[i].list == (i == 0 ? some_list(60) : Bytes()));
        const OpcodeLists lists = read_opcode_lists(out);
        assert_true(!lists.raw && lists.width == width && lists.layout == LENSPROF_LAYOUT_RGB);
    }
}

void assert_refused(const std::string &in, const char *why) {
    const std::string out = in_folder("out.dng");
    save(out, {1, 2, 3});  // an existing file
    const size_t files = files_in_folder();
    int refused = 0;
    for (const bool writes : {false, true}) try {
            if (writes)
                write_opcode_list(in, out, tag_opcode_list2, some_list(60));
            else
                read_opcode_lists(in);
        } catch (const Failure &failure) {
            assert_int_equal(failure.group(), LENSPROF_ERROR_READ);
            if (!strstr(failure.what(), why) || !strstr(failure.what(), in.c_str())) fail_msg("%s", failure.what());
            ++refused;
        }
    assert_int_equal(refused, 2);
    assert_int_equal(files_in_folder(), files);
    assert_true(load(out) == Bytes({1, 2, 3}));
}

void test_refused(void **) {
    assert_refused(in_folder("none.dng"), "cannot be opened");
    assert_refused(folder.string(), "");
    const std::string in = in_folder("in.dng");
    save(in, {});
    assert_refused(in, "is not a TIFF");
    save(in, {0xFF, 0xD8, 0xFF, 0xE0, 0, 16, 'J', 'F', 'I', 'F', 0});
    assert_refused(in, "is not a TIFF");
    write_plain("in.dng", "w8");
    assert_refused(in, "is a BigTIFF");
    save(in, {'I', 'I', 42, 0, 8, 0, 0, 0, 0, 0, 8, 0, 0, 0});  // the first directory points to itself as the next
    assert_refused(in, "circular");
    save(in, {'I', 'I', 42, 0, 0, 0, 0, 0});
    assert_refused(in, "no image directory");
    save(in, {'M', 'M', 0, 42, 0, 0, 0, 8, 255, 255, 0});
    assert_refused(in, "is cut off");
}

// A file cut anywhere is refused, or read if only pixels are missing; a file changed anywhere is refused or read.
void test_cuts_and_mutations(void **) {
    const Bytes whole = load(write_dng("in.dng", "wl", 3));
    const std::string path = in_folder("cut.dng"), out = in_folder("out.dng");
    const auto try_one = [&](bool writes) {
        try {
            if (!writes) return read_opcode_lists(path).width ? 1 : 2;
            write_opcode_list(path, out, tag_opcode_list3, some_list(60));
            return read_opcode_lists(out).list3 == some_list(60) ? 1 : 2;
        } catch (const Failure &failure) {
            assert_int_equal(failure.group(), LENSPROF_ERROR_READ);
            return 0;
        }
    };
    for (size_t size = 0; size < whole.size(); size += 61) {
        save(path, Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
        assert_int_equal(try_one(true), 0);  // the raw image's directory is at the end of the file
    }
    Bytes changed = whole;
    size_t good = 0;
    for (size_t at = 0; at < whole.size(); at += 1 + at / 400) {
        changed[at] ^= 0x91;
        save(path, changed);
        good += try_one(at % 300 == 0) == 1;  // flushing every write to the disk would take too long
        changed[at] = whole[at];
    }
    assert_true(good > 100);
}

// Lists written by the library, under exiftool's names for them.
void test_exiftool(void **) {
    if (system("exiftool -ver >/dev/null 2>&1") != 0) {
        print_message("needs package libimage-exiftool-perl\n");
        skip();
    }
    const std::string path = write_dng("in.dng", "wl", 1);
    auto profile = std::make_unique<lensprof_profile>();
    lensprof_profile_init(profile.get());
    profile->vignettings = 3;
    for (int c = 0; c < 3; ++c) profile->vignetting[c] = {{-0.3 - 0.05 * c, 0, 0}, {0, 0}};
    Bytes list(20000);
    size_t needed = 0;
    const auto write = [&](uint32_t form, uint16_t tag) {
        assert_ok(lp_dng_opcodes_write(profile.get(), width - 4, height - 2, LENSPROF_LAYOUT_GBRG, form, list.data(),
                                       list.size(), &needed, nullptr, nullptr));
        write_opcode_list(path, path, tag, Bytes(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(needed)));
    };
    write(LENSPROF_DNG_GAIN_MAP, tag_opcode_list2);
    profile->vignettings = 1;
    write(LENSPROF_DNG_RADIAL, tag_opcode_list3);
    FILE *said = popen(("exiftool -s -OpcodeList2 -OpcodeList3 -ImageWidth -Warning '" + path + "'").c_str(), "r");
    std::string text;
    for (char line[300]; fgets(line, sizeof line, said);) text += line;
    assert_int_equal(pclose(said), 0);
    for (const char *expected :
         {"OpcodeList2", ": GainMap, GainMap, GainMap, GainMap\n", "OpcodeList3", ": FixVignetteRadial\n"})
        if (text.find(expected) == std::string::npos) fail_msg("no %s in %s", expected, text.c_str());
    assert_true(text.find("Warning") == std::string::npos);
}

long peak_memory() {
    rusage used = {};
    assert_int_equal(getrusage(RUSAGE_SELF, &used), 0);
    return used.ru_maxrss * 1024;
}

// 255 SubIFDs that are the same directory, with the maximal number of entries: 400 MB if all were held.
void test_shared_directory(void **) {
#if defined(__SANITIZE_ADDRESS__)
    skip();  // the address sanitizer keeps freed memory
#endif
    constexpr uint32_t children = 255, entries = 65535, list = 62, child = list + 4 * children;
    Bytes bytes = {'I', 'I', 42, 0, 8, 0, 0, 0};
    const auto put = [&](uint32_t value, int count) {
        for (int i = 0; i < count; ++i) bytes.push_back(static_cast<uint8_t>(value >> (8 * i)));
    };
    const auto put_entry = [&](uint32_t tag, uint32_t type, uint32_t count, uint32_t value) {
        put(tag, 2), put(type, 2), put(count, 4), put(value, 4);
    };
    put(4, 2);
    put_entry(256, 4, 1, width), put_entry(257, 4, 1, height), put_entry(262, 3, 1, 1);
    put_entry(330, 4, children, list);
    put(0, 4);
    for (uint32_t i = 0; i < children; ++i) put(child, 4);
    put(entries, 2);
    for (uint32_t i = 0; i < entries; ++i) put_entry(60000, 1, 1, 0);
    put(0, 4);
    save(in_folder("in.dng"), bytes);
    const long before = peak_memory();
    const OpcodeLists lists = read_opcode_lists(in_folder("in.dng"));
    assert_false(lists.raw);
    assert_int_equal(lists.width, width);
    assert_in_range(peak_memory() - before, 0, 20l << 20);
}

}  // namespace

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_raw_image_of_a_dng, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_replaced_in_place, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_plain_tiff, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_refused, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_cuts_and_mutations, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_shared_directory, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_exiftool, make_folder, remove_folder),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
