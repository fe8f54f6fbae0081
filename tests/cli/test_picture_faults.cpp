// Picture files: all kinds of errors, and the files left on the disk.
#include "picture_files.hpp"

#include <csignal>
#include <cstring>

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "photo/base/output_file.hpp"

using namespace picture_files;

namespace {

struct Sample {
    std::string name;
    Picture picture;  // the picture that it contains
    Bytes bytes;
};

void add_sample(std::vector<Sample> &samples, const std::string &name) {
    samples.push_back({name, read_picture(in_folder(name)), load(in_folder(name))});
}

// One file for every way of decoding pixels.
std::vector<Sample> make_samples() {
    std::vector<Sample> samples;
    const Picture smooth = make_smooth(61, 47, LENSPROF_LAYOUT_RGB);
    write_picture(in_folder("plain.png"), smooth);
    add_sample(samples, "plain.png");
    Bytes bytes = smooth.pixels;
    write_png_file(in_folder("interlaced.png"),
                   {61, 47, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_ADAM7, [](png_structp, png_infop) {}}, bytes);
    add_sample(samples, "interlaced.png");
    write_jpeg_file(in_folder("baseline.jpg"), smooth, JpegKind());
    add_sample(samples, "baseline.jpg");
    write_jpeg_file(in_folder("progressive.jpg"), smooth, {90, 2, 2, true, false});
    add_sample(samples, "progressive.jpg");
    for (uint16_t compression :
         {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS, COMPRESSION_JPEG}) {
        for (uint32_t tile : {0u, 16u}) {
            TiffKind kind{"w", compression, tile ? uint16_t(PLANARCONFIG_SEPARATE) : uint16_t(PLANARCONFIG_CONTIG)};
            if (compression == COMPRESSION_JPEG) kind.planar = PLANARCONFIG_CONTIG;
            kind.tile = tile;
            kind.rows_per_strip = 16;
            const std::string name = std::to_string(compression) + (tile ? "tiles.tif" : "strips.tif");
            write_tiff_file(in_folder(name), smooth, kind);
            add_sample(samples, name);
        }
    }
    return samples;
}

// Moves the directory of a little-endian TIFF before the pixels, so that a cut hits the pixels.
Bytes directory_first(const Bytes &tiff) {
    const auto get = [&](size_t at) {
        return size_t(tiff[at]) | size_t(tiff[at + 1]) << 8 | size_t(tiff[at + 2]) << 16 | size_t(tiff[at + 3]) << 24;
    };
    const size_t start = get(4), shift = tiff.size() - start;
    Bytes moved(tiff.begin(), tiff.begin() + 8);
    moved.insert(moved.end(), tiff.begin() + long(start), tiff.end());
    moved.insert(moved.end(), tiff.begin() + 8, tiff.begin() + long(start));
    const auto put = [&](size_t at, size_t value) {
        for (size_t i = 0; i < 4; ++i) moved[at + i] = static_cast<uint8_t>(value >> (8 * i));
    };
    put(4, 8);
    const size_t entries = moved[8] + 256u * moved[9];
    for (size_t at = 10; at < 10 + 12 * entries; at += 12) {
        const size_t tag = moved[at] + 256u * moved[at + 1], type = moved[at + 2], count = moved[at + 4];
        const size_t bytes = count * (type == 3 ? 2 : type == 5 ? 8 : type == 4 ? 4 : 1);
        size_t value = moved[at + 8] | size_t(moved[at + 9]) << 8 | size_t(moved[at + 10]) << 16;
        if (bytes > 4 || tag == TIFFTAG_STRIPOFFSETS) {
            value = value < start ? value + shift : value - start + 8;
            put(at + 8, value);
        }
    }
    return moved;
}

void check_cut(const Sample &sample, const Bytes &bytes, size_t length) {
    const std::string path = in_folder("cut");
    save(path, Bytes(bytes.begin(), bytes.begin() + long(length)));
    for (uint32_t max_side : {0u, 10u}) {
        ReadOptions options;
        options.max_side = max_side;
        try {
            const Picture picture = read_picture(path, options);
            // No pixel may be missing: the cut bytes were not needed.
            save(path, sample.bytes);
            assert_same_pixels(picture, read_picture(path, options));
            assert_true(bytes.size() - length <= 4 && sample.name.find(".tif") != std::string::npos);
        } catch (const Failure &failure) {
            assert_int_equal(failure.group(), LENSPROF_ERROR_READ);
            assert_non_null(std::strstr(failure.what(), "cut: cannot read: "));
        }
    }
}

void test_cut_files(void **) {
    for (const Sample &sample : make_samples()) {
        for (size_t length = 0; length < sample.bytes.size(); length += 1 + sample.bytes.size() / 150)
            check_cut(sample, sample.bytes, length);
        for (size_t i = 1; i < 6; ++i) check_cut(sample, sample.bytes, sample.bytes.size() - i);
    }
}

// Many programs write the directory first; libtiff writes it at the end.
void test_cut_tiff_pixels(void **) {
    for (const Picture &picture : {make_noise(40, 30, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB),
                                   make_noise(40, 30, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_GREY)}) {
        for (uint16_t compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE}) {
            TiffKind kind{"wl", compression};
            kind.rows_per_strip = 30;
            write_tiff_file(in_folder("a.tif"), picture, kind);
            const Bytes moved = directory_first(load(in_folder("a.tif")));
            save(in_folder("b.tif"), moved);
            assert_same_pixels(picture, read_picture(in_folder("b.tif")));
            for (size_t length = 400; length < moved.size() - 8; length += moved.size() / 20) {
                save(in_folder("b.tif"), Bytes(moved.begin(), moved.begin() + long(length)));
                assert_failure(LENSPROF_ERROR_READ, "b.tif: cannot read: file is truncated or damaged (",
                               [] { read_picture(in_folder("b.tif")); });
            }
        }
    }
}

// Damage is either detected or harmless to the process.
void test_changed_bytes(void **) {
    uint64_t state = 11;
    for (const Sample &sample : make_samples()) {
        for (int run = 0; run < 120; ++run) {
            Bytes bytes = sample.bytes;
            for (int i = 0; i < 1 + run % 4; ++i) {
                const size_t range = run % 2 ? bytes.size() : std::min<size_t>(bytes.size(), 300);
                const size_t at = static_cast<size_t>(double(range) * lp_random(&state));
                bytes[run % 3 ? at : bytes.size() - 1 - at] = static_cast<uint8_t>(256 * lp_random(&state));
            }
            save(in_folder("changed"), bytes);
            try {
                const Picture picture = read_picture(in_folder("changed"));
                assert_int_equal(picture.pixels.size(), picture.row_bytes * picture.height);
                read_metadata(in_folder("changed"));
            } catch (const Failure &failure) {
                assert_non_null(std::strstr(failure.what(), "changed: cannot read"));
            }
        }
    }
}

// The number of a component's quantisation table is a byte of the file; only 0 to 3 are valid.
void test_any_quantisation_table(void **) {
    write_jpeg_file(in_folder("a.jpg"), make_smooth(40, 30, LENSPROF_LAYOUT_RGB), JpegKind());
    Bytes bytes = load(in_folder("a.jpg"));
    size_t frame = 2;
    while (bytes[frame + 1] != 0xc0) frame += 2 + 256u * bytes[frame + 2] + bytes[frame + 3];
    for (size_t component = 0; component < 3; ++component)
        for (int number = 0; number < 256; ++number) {
            Bytes changed = bytes;
            changed[frame + 12 + 3 * component] = static_cast<uint8_t>(number);
            save(in_folder("changed"), changed);
            if (number > 3)
                assert_failure(LENSPROF_ERROR_READ, "changed: cannot read: file is truncated or damaged",
                               [] { read_picture(in_folder("changed")); });
        }
}

// An end marker inside a JPEG strip: libtiff only warns, and would invent half of the pixels.
void test_damaged_jpeg_in_tiff(void **) {
    TiffKind kind{"wl", COMPRESSION_JPEG};
    kind.rows_per_strip = 64;
    write_tiff_file(in_folder("a.tif"), make_smooth(96, 64, LENSPROF_LAYOUT_RGB), kind);
    Bytes bytes = load(in_folder("a.tif"));
    bytes[300] = 0xff;  // the strip of about 770 bytes comes first
    bytes[301] = 0xd9;
    save(in_folder("a.tif"), bytes);
    assert_failure(LENSPROF_ERROR_READ, "a.tif: cannot read: file is truncated or damaged",
                   [] { read_picture(in_folder("a.tif")); });
}

void test_png_checks_content(void **) {
    Sample sample = make_samples()[0];
    for (size_t at = 40; at < sample.bytes.size(); at += sample.bytes.size() / 40) {
        Bytes bytes = sample.bytes;
        bytes[at] ^= 0x10;
        save(in_folder("changed.png"), bytes);
        assert_failure(LENSPROF_ERROR_READ, "changed.png: cannot read: file is truncated or damaged",
                       [] { read_picture(in_folder("changed.png")); });
    }
}

void test_not_pictures(void **) {
    save(in_folder("empty.png"), {});
    save(in_folder("text.jpg"), Bytes(5000, 'x'));
    save(in_folder("raw.cr2"), {'I', 'I', '*', 0, 16, 0, 0, 0, 'C', 'R', 2, 0, 0, 0, 0, 0});
    const auto read = [](const char *name) { return [name] { read_picture(in_folder(name)); }; };
    assert_failure(LENSPROF_ERROR_READ, "empty.png: cannot read: file is truncated", read("empty.png"));
    assert_failure(LENSPROF_ERROR_READ, "is not a PNG, TIFF, JPEG, HEIC, AVIF, WebP, JPEG XL or FITS",
                   read("text.jpg"));
    assert_failure(LENSPROF_ERROR_READ, "camera raw", read("raw.cr2"));
    assert_failure(LENSPROF_ERROR_READ, "no.png: cannot read: No such file", read("no.png"));
    assert_failure(LENSPROF_ERROR_READ, "is a folder", read("."));
    assert_failure(LENSPROF_ERROR_READ, "is a folder", [] { read_size(in_folder(".")); });
    assert_failure(LENSPROF_ERROR_READ,
                   "text.jpg: cannot read metadata: ", [] { read_metadata(in_folder("text.jpg")); });
    assert_failure(LENSPROF_ERROR_READ, "is a folder", [] { read_metadata(in_folder(".")); });
    assert_int_equal(mkfifo(in_folder("pipe.jpg").c_str(), 0600), 0);  // without a writer
    assert_failure(LENSPROF_ERROR_READ, "pipe.jpg: cannot read: not a regular file", read("pipe.jpg"));
    assert_failure(LENSPROF_ERROR_READ, "pipe.jpg: cannot read", [] { read_metadata(in_folder("pipe.jpg")); });
}

void test_unsupported_kinds(void **) {
    const auto read = [] { read_picture(in_folder("a")); };
    const Picture four = make_noise(20, 10, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGBA);
    write_jpeg_file(in_folder("a"), four, {90, 1, 1, false, true});
    assert_failure(LENSPROF_ERROR_READ, "a: cannot read: CMYK", read);

    const Bytes lossless = {0xff, 0xd8, 0xff, 0xf7, 0, 11, 8, 0, 10, 0, 20,   1,    1,    0x11, 0,  // JPEG-LS
                            0xff, 0xda, 0,    8,    1, 1,  0, 0, 0,  0, 0x55, 0x55, 0xff, 0xd9};
    save(in_folder("a"), lossless);
    assert_failure(LENSPROF_ERROR_READ, "a: cannot read: unsupported kind of JPEG (JPEG-LS); convert it first", read);

    const Picture grey = make_noise(20, 10, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY);
    TiffKind kind;
    kind.format = SAMPLEFORMAT_INT;
    write_tiff_file(in_folder("a"), grey, kind);
    assert_failure(LENSPROF_ERROR_READ, "16 bit TIFF of sample format 2", read);
    kind.format = SAMPLEFORMAT_IEEEFP;
    write_tiff_file(in_folder("a"), grey, kind);
    assert_failure(LENSPROF_ERROR_READ, "16 bit TIFF of sample format 3", read);
    kind.format = SAMPLEFORMAT_UINT;
    kind.photometric = PHOTOMETRIC_SEPARATED;
    write_tiff_file(in_folder("a"), four, kind);
    assert_failure(LENSPROF_ERROR_READ, "photometric interpretation 5", read);
    kind.photometric = PHOTOMETRIC_MINISBLACK;
    kind.bits = 1;
    Picture narrow = make_noise(3, 10, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_GREY);
    write_tiff_file(in_folder("a"), narrow, kind);
    assert_failure(LENSPROF_ERROR_READ, "1 bit TIFF", read);
}

// A header that declares a frame of terabytes is refused before memory is allocated for it.
void test_too_large(void **) {
    Bytes bytes(30, 0);
    PngKind kind{10, 3, 8, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, [](png_structp, png_infop) {}};
    write_png_file(in_folder("a.png"), kind, bytes);
    Bytes file = load(in_folder("a.png"));
    const Bytes size = {0, 16, 0, 0, 0, 16, 0, 0};  // 2^20 x 2^20
    std::copy(size.begin(), size.end(), file.begin() + 16);
    const Bytes crc = {0x6e, 0x43, 0xff, 0x19};
    std::copy(crc.begin(), crc.end(), file.begin() + 29);
    save(in_folder("a.png"), file);
    assert_failure(LENSPROF_ERROR_READ, "1048576 x 1048576 pixels exceed the limit",
                   [] { read_size(in_folder("a.png")); });

    TIFF *tiff = TIFFOpen(in_folder("a.tif").c_str(), "w");
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 1u << 20);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 1u << 20);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 1u << 20);
    Bytes strip(100, 0);
    TIFFWriteRawStrip(tiff, 0, strip.data(), 100);
    TIFFClose(tiff);
    assert_failure(LENSPROF_ERROR_READ, "1048576 x 1048576 pixels exceed the limit",
                   [] { read_picture(in_folder("a.tif")); });
}

void test_kinds_that_formats_cannot_hold(void **) {
    const auto write = [](const char *name, uint32_t sample, uint32_t layout) {
        return [=] { write_picture(in_folder(name), make_noise(8, 8, sample, layout)); };
    };
    assert_failure(LENSPROF_ERROR_ARGUMENT, "a.png: cannot write: PNG holds",
                   write("a.png", LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_RGB));
    assert_failure(LENSPROF_ERROR_ARGUMENT, "a.jpg: cannot write: JPEG holds 8 bit",
                   write("a.jpg", LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB));
    assert_failure(LENSPROF_ERROR_ARGUMENT, "alpha", write("a.jpg", LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGBA));
    assert_failure(LENSPROF_ERROR_ARGUMENT, "a.bmp: unknown picture format",
                   write("a.bmp", LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB));
    assert_failure(LENSPROF_ERROR_ARGUMENT, "unknown picture format",
                   write("png", LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB));
    Picture picture = make_noise(8, 8, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGBA);
    picture.traits.alpha = PictureTraits::Alpha::associated;
    assert_failure(LENSPROF_ERROR_ARGUMENT, "premultiplied", [&] { write_picture(in_folder("a.png"), picture); });
    picture.pixels.resize(10);
    assert_failure(LENSPROF_ERROR_WRITE, "invalid picture", [&] { write_picture(in_folder("a.tif"), picture); });
    Picture wide = make_noise(70000, 1, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_GREY);
    assert_failure(LENSPROF_ERROR_WRITE, "a.jpg: cannot write: Maximum supported image dimension",
                   [&] { write_picture(in_folder("a.jpg"), wide); });
    assert_int_equal(files_in_folder(), 0);
}

void test_unwritable_targets(void **) {
    const Picture picture = make_smooth(8, 8, LENSPROF_LAYOUT_RGB);
    assert_failure(LENSPROF_ERROR_WRITE, "no/a.png: cannot write: No such file",
                   [&] { write_picture(in_folder("no/a.png"), picture); });
    fs::create_directory(in_folder("b.png"));
    assert_failure(LENSPROF_ERROR_ARGUMENT, "b.png: cannot write: not a regular file",
                   [&] { write_picture(in_folder("b.png"), picture); });
    assert_failure(LENSPROF_ERROR_WRITE, "/proc/a.png: cannot write: ", [&] { write_picture("/proc/a.png", picture); });
    if (geteuid() != 0) {  // root may write everywhere
        fs::permissions(in_folder("b.png"), fs::perms::owner_read | fs::perms::owner_exec);
        assert_failure(LENSPROF_ERROR_WRITE, "Permission denied",
                       [&] { write_picture(in_folder("b.png/a.png"), picture); });
    }
    assert_int_equal(files_in_folder(), 1);
}

// On failure the older file stays; on success the permissions and the symbolic link to it are kept.
void test_replacing(void **) {
    save(in_folder("old.png"), {1, 2, 3});
    chmod(in_folder("old.png").c_str(), 0640);
    fs::create_symlink("old.png", in_folder("link.png"));
    Picture picture = make_noise(8, 8, LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_RGB);
    failure_of(LENSPROF_ERROR_ARGUMENT, [&] { write_picture(in_folder("link.png"), picture); });
    assert_true(load(in_folder("old.png")) == Bytes({1, 2, 3}));
    WriteOptions options;
    options.metadata_from = in_folder("missing.jpg");
    picture = make_smooth(8, 8, LENSPROF_LAYOUT_RGB);
    assert_failure(LENSPROF_ERROR_READ, "missing.jpg: cannot read",
                   [&] { write_picture(in_folder("link.png"), picture, options); });
    assert_true(load(in_folder("old.png")) == Bytes({1, 2, 3}));

    write_picture(in_folder("link.png"), picture);
    assert_same_pixels(picture, read_picture(in_folder("old.png")));
    assert_true(fs::is_symlink(in_folder("link.png")));
    assert_true((fs::status(in_folder("old.png")).permissions() & fs::perms::all) == fs::perms(0640));
    assert_int_equal(files_in_folder(), 2);
}

void test_long_name(void **) {
    const std::string name(251, 'x');
    const Picture picture = make_smooth(8, 8, LENSPROF_LAYOUT_RGB);
    write_picture(in_folder(name + ".png"), picture);
    assert_same_pixels(picture, read_picture(in_folder(name + ".png")));
}

// In a child process whose files may not grow beyond `limit`. 0 if everything went as expected.
int write_on_full_disk(const std::string &name, const Picture &picture, const WriteOptions &options, rlim_t limit) {
    const pid_t child = fork();
    if (child == 0) {
        const rlimit small = {limit, limit};
        std::signal(SIGXFSZ, SIG_IGN);
        setrlimit(RLIMIT_FSIZE, &small);
        int result = 1;
        try {
            write_picture(in_folder(name), picture, options);
        } catch (const Failure &failure) {
            const std::string text = failure.what();
            result = text.find(name + ": cannot write: File too large") == std::string::npos ? 2
                     : failure.group() != LENSPROF_ERROR_WRITE                               ? 3
                                                                                             : 0;
            if (result != 0) std::fprintf(stderr, "%s\n", text.c_str());
        }
        _exit(result);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

void test_full_disk(void **) {
    const Picture picture = make_noise(200, 150, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB);
    Picture stored = picture;
    stored.traits.compression = COMPRESSION_NONE;
    write_picture(in_folder("source.jpg"), make_smooth(8, 8, LENSPROF_LAYOUT_RGB));
    PictureMetadata metadata = unknown_metadata();
    std::strcpy(metadata.key.camera_model, "A camera whose name needs some room in the file");
    WriteOptions options;
    for (const char *name : {"a.png", "a.tif", "b.tif", "a.jpg"}) {
        const Picture &p = name[0] == 'b' ? stored : picture;
        write_picture(in_folder("whole" + std::string(name)), p);
        const rlim_t size = static_cast<rlim_t>(fs::file_size(in_folder("whole" + std::string(name))));
        for (rlim_t limit : {rlim_t(0), rlim_t(1), rlim_t(4096), rlim_t(20000), size / 2, size - 1}) {
            assert_int_equal(write_on_full_disk(name, p, options, limit), 0);
            assert_false(fs::exists(in_folder(name)));
        }
        WriteOptions with_metadata;  // the pixels fit, the metadata do not
        with_metadata.metadata = &metadata;
        assert_int_equal(write_on_full_disk(name, p, with_metadata, size + 20), 0);
        assert_false(fs::exists(in_folder(name)));
        fs::remove(in_folder("whole" + std::string(name)));
    }
    // The coefficients of a large JPEG, before anything is written to the file itself.
    const Picture large = make_smooth(1404, 2000, LENSPROF_LAYOUT_RGB);
    for (rlim_t limit : {rlim_t(0), rlim_t(1) << 20, rlim_t(16) << 20})
        assert_int_equal(write_on_full_disk("a.jpg", large, options, limit), 0);
    assert_false(fs::exists(in_folder("a.jpg")));
    assert_int_equal(files_in_folder(), 1);
}

void test_write_file(void **) {
    write_file(in_folder("a.json"), "{}", 2);
    assert_true(load(in_folder("a.json")) == Bytes({'{', '}'}));
    {
        OutputFile output(in_folder("a.json"));
        assert_true(fs::path(output.temporary()).extension() == ".json");
        assert_true(fs::path(output.temporary()).parent_path() == folder);
        assert_int_equal(files_in_folder(), 2);
    }
    assert_true(load(in_folder("a.json")) == Bytes({'{', '}'}));
    assert_int_equal(files_in_folder(), 1);
}

}  // namespace

#define TEST(name) cmocka_unit_test_setup(name, empty_folder)

int main() {
    const CMUnitTest tests[] = {
        TEST(test_cut_files),
        TEST(test_cut_tiff_pixels),
        TEST(test_changed_bytes),
        TEST(test_any_quantisation_table),
        TEST(test_damaged_jpeg_in_tiff),
        TEST(test_png_checks_content),
        TEST(test_not_pictures),
        TEST(test_unsupported_kinds),
        TEST(test_too_large),
        TEST(test_kinds_that_formats_cannot_hold),
        TEST(test_unwritable_targets),
        TEST(test_replacing),
        TEST(test_long_name),
        TEST(test_full_disk),
        TEST(test_write_file),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
