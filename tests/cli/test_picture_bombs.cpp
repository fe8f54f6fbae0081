// Small files that declare large frames are refused before memory is allocated for them. Valid files that compress as
// far as their format allows are read.
#include "program_runs.hpp"

using namespace program_runs;

namespace {

// Limit of the program's peak memory beyond that at its start, bytes. Sanitizers need more, and count memory that is
// only reserved.
#if defined(__SANITIZE_ADDRESS__)
constexpr long most_memory = 200l << 20;
constexpr bool claims_cost_memory = true;
#else
constexpr long most_memory = 40l << 20;
constexpr bool claims_cost_memory = false;
#endif

void put_big_endian(Bytes &bytes, uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<uint8_t>(value >> shift));
}

uint32_t crc_of(const uint8_t *bytes, size_t count) {
    uint32_t crc = 0xffffffff;
    for (size_t i = 0; i < count; ++i) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
    }
    return ~crc;
}

void put_chunk(Bytes &bytes, const char *type, const Bytes &data) {
    put_big_endian(bytes, static_cast<uint32_t>(data.size()));
    const size_t start = bytes.size();
    bytes.insert(bytes.end(), type, type + 4);
    bytes.insert(bytes.end(), data.begin(), data.end());
    put_big_endian(bytes, crc_of(bytes.data() + start, bytes.size() - start));
}

// A header and `data` bytes of pixels that are not a Deflate stream.
Bytes make_png_bomb(uint32_t side, uint8_t bits, uint8_t colour, uint8_t interlace, size_t data) {
    Bytes bytes = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'}, header;
    put_big_endian(header, side);
    put_big_endian(header, side);
    header.insert(header.end(), {bits, colour, 0, 0, interlace});
    put_chunk(bytes, "IHDR", header);
    put_chunk(bytes, "IDAT", Bytes(data, 0x55));
    put_chunk(bytes, "IEND", {});
    return bytes;
}

struct TiffBomb {
    uint32_t width, height;
    uint16_t bits, samples, planar;
    uint32_t tile_width, tile_height;  // 0: one strip
    uint32_t data_bytes;               // as declared
};

void put_little_endian(Bytes &bytes, uint32_t value, int count) {
    for (int i = 0; i < count; ++i) bytes.push_back(static_cast<uint8_t>(value >> (8 * i)));
}

// A classic TIFF of one directory and no pixels.
Bytes make_tiff_bomb(const TiffBomb &bomb, uint16_t compression) {
    const uint16_t photometric = bomb.samples > 2 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK;
    const bool tiled = bomb.tile_width > 0;
    std::vector<std::pair<uint16_t, uint32_t>> entries = {
        {256, bomb.width}, {257, bomb.height}, {258, bomb.bits}, {259, compression}, {262, photometric}};
    if (!tiled) entries.push_back({273, 8});
    entries.push_back({277, bomb.samples});
    if (!tiled) entries.insert(entries.end(), {{278, bomb.height}, {279, bomb.data_bytes}});
    entries.push_back({284, bomb.planar});
    if (tiled)
        entries.insert(entries.end(),
                       {{322, bomb.tile_width}, {323, bomb.tile_height}, {324, 8}, {325, bomb.data_bytes}});
    Bytes bytes = {'I', 'I', 42, 0, 8, 0, 0, 0};
    put_little_endian(bytes, static_cast<uint32_t>(entries.size()), 2);
    for (const auto &entry : entries) {
        put_little_endian(bytes, entry.first, 2);
        put_little_endian(bytes, 4, 2);  // LONG
        put_little_endian(bytes, 1, 4);
        put_little_endian(bytes, entry.second, 4);
    }
    put_little_endian(bytes, 0, 4);
    return bytes;
}

// `apply` and `flat` refuse the file with `declared` in the text.
void assert_harmless(const std::string &name, const Bytes &bytes, const std::string &declared) {
    static const long start = run_program({"--version"}).peak;
    save(work(name), bytes);
    for (const Words &words :
         {corrected_into("out", {work(name)}), Words{"flat", "--no-store", "--linear", work(name)}}) {
        const Ended ended = run_program(words);
        const std::string text = "cannot read: file is truncated or damaged (" + declared;
        if (ended.code != unreadable || !contains(ended.err, name) || !contains(ended.err, text)
            || !contains(ended.err, "; copy it again"))
            fail_msg("%s: exit code %d, %s", joined(words).c_str(), ended.code, ended.err.c_str());
        if (ended.peak - start > most_memory)
            fail_msg("%s: %ld MiB, %ld at the start", joined(words).c_str(), ended.peak >> 20, start >> 20);
    }
}

std::string beyond(const std::string &size, size_t bytes) {
    return "it declares " + size + ", too many for its " + std::to_string(bytes) + " bytes of data)";
}

void test_png_bombs(void **) {
    const auto check = [](uint32_t side, uint8_t bits, uint8_t colour) {
        const std::string size = std::to_string(side) + " x " + std::to_string(side) + " pixels";
        for (uint8_t interlace : {PNG_INTERLACE_NONE, PNG_INTERLACE_ADAM7}) {
            const Bytes bytes = make_png_bomb(side, bits, colour, interlace, 0);
            assert_harmless("a.png", bytes, beyond(size, bytes.size()));
        }
    };
    check(37000, 16, PNG_COLOR_TYPE_RGB);
    check(65535, 8, PNG_COLOR_TYPE_GRAY);
    check(65535, 1, PNG_COLOR_TYPE_GRAY);
}

// Enough bytes for the frame, but not pixels.
void test_padded_bombs(void **) {
    if (claims_cost_memory) skip();  // sanitizers touch every reserved page
    assert_harmless("a.png", make_png_bomb(37000, 16, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_ADAM7, 9 << 20), "");
    for (const TiffBomb &bomb : {TiffBomb{30000, 30000, 8, 3, PLANARCONFIG_SEPARATE, 0, 0, 3 << 20},
                                 TiffBomb{32752, 32768, 8, 1, PLANARCONFIG_CONTIG, 32752, 32768, 3 << 20}}) {
        Bytes bytes = make_tiff_bomb(bomb, COMPRESSION_ADOBE_DEFLATE);
        bytes.resize(4 << 20, 0x55);
        assert_harmless("a.tif", bytes, "");
    }
}

// Bits, the lowest of each byte first.
struct LowBits {
    Bytes bytes;
    unsigned used = 0;

    void put(uint64_t value, unsigned count) {
        for (unsigned i = 0; i < count; ++i, ++used) {
            if (used % 8 == 0) bytes.push_back(0);
            bytes.back() = static_cast<uint8_t>(bytes.back() | (value >> i & 1) << used % 8);
        }
    }
};

// A lossless WebP with sides of 14 bits and invalid pixels.
Bytes make_webp_bomb(uint32_t side, size_t data) {
    LowBits picture;
    picture.put(0x2f, 8);
    picture.put(side - 1, 14);
    picture.put(side - 1, 14);
    picture.put(0, 4);  // no alpha, version 0
    picture.bytes.resize(picture.bytes.size() + data, 0x55);
    Bytes bytes = {'R', 'I', 'F', 'F'};
    put_little_endian(bytes, static_cast<uint32_t>(12 + picture.bytes.size()), 4);
    for (const char c : {'W', 'E', 'B', 'P', 'V', 'P', '8', 'L'}) bytes.push_back(static_cast<uint8_t>(c));
    put_little_endian(bytes, static_cast<uint32_t>(picture.bytes.size()), 4);
    bytes.insert(bytes.end(), picture.bytes.begin(), picture.bytes.end());
    return bytes;
}

void test_webp_bombs(void **) {
    if (!can_read_webp() || claims_cost_memory) skip();
    assert_harmless("a.webp", make_webp_bomb(16383, 0), "");
    assert_harmless("a.webp", make_webp_bomb(16383, 4 << 20), "");
}

// A JPEG XL codestream with sides of 30 bits, usual header fields and invalid pixels (ISO/IEC 18181-1, annex D).
Bytes make_jxl_bomb(uint32_t side, size_t data) {
    LowBits bits;
    bits.put(0x0aff, 16);
    bits.put(0, 1);  // no multiple of 8
    bits.put(3, 2);
    bits.put(side - 1, 30);
    bits.put(0, 3);  // no ratio
    bits.put(3, 2);
    bits.put(side - 1, 30);
    bits.put(3, 2);  // usual metadata: 8 bit, sRGB; no custom weights
    bits.bytes.resize(bits.bytes.size() + data, 0x55);
    return bits.bytes;
}

void test_jxl_bombs(void **) {
    if (!can_read_jxl() || claims_cost_memory) skip();
    assert_harmless("a.jxl", make_jxl_bomb(13000, 100), "");
    assert_harmless("a.jxl", make_jxl_bomb(13000, 1 << 20), "");
    for (const uint32_t side : {16000u, 1000000u}) {
        save(work("a.jxl"), make_jxl_bomb(side, 100));
        const std::string size = std::to_string(side) + " x " + std::to_string(side) + " pixels exceed the limit";
        assert_refused(unreadable, corrected_into("out", {work("a.jxl")}), {"a.jxl: cannot read: " + size});
    }
}

void test_tiff_bombs(void **) {
    for (uint16_t compression :
         {COMPRESSION_NONE, COMPRESSION_PACKBITS, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PIXARLOG,
          COMPRESSION_JPEG, COMPRESSION_OJPEG, COMPRESSION_LZMA, COMPRESSION_ZSTD}) {
        if (!TIFFIsCODECConfigured(compression)) continue;
        const bool jpeg = compression == COMPRESSION_JPEG;
        const TiffBomb tiles{1048576, 1300, uint16_t(jpeg ? 8 : 16), 3, PLANARCONFIG_SEPARATE, 16384, 16384, 0};
        const TiffBomb strip{30000, 30000, 8, 3, PLANARCONFIG_SEPARATE, 0, 0, 100};
        if (compression != COMPRESSION_OJPEG) {  // its colour is YCbCr, which is refused earlier
            assert_harmless("tiles.tif", make_tiff_bomb(tiles, compression), beyond("1048576 x 1300 pixels", 0));
            assert_harmless("strip.tif", make_tiff_bomb(strip, compression), beyond("30000 x 30000 pixels", 100));
        }
        const TiffBomb tile{32752, 32768, 8, 1, PLANARCONFIG_CONTIG, 32752, 32768, 100};
        assert_harmless("tile.tif", make_tiff_bomb(tile, compression), beyond("32752 x 32768 pixels", 100));
        const TiffBomb chopped{40000, 40000, 8, 3, PLANARCONFIG_CONTIG, 0, 0, 100};  // libtiff divides it into rows
        const Bytes bytes = make_tiff_bomb(chopped, compression);
        if (compression == COMPRESSION_NONE)
            assert_harmless("rows.tif", bytes, beyond("40000 x 40000 pixels", bytes.size()));
        if (compression == COMPRESSION_NONE) continue;  // reported above
        const TiffBomb one{8, 8, 8, 1, PLANARCONFIG_CONTIG, 32752, 32768, 100};
        assert_harmless("one.tif", make_tiff_bomb(one, compression), beyond("a tile of 32752 x 32768 pixels", 100));
    }
}

// A few bytes can encode a large block of one grey. Refused are blocks without bytes, blocks larger than compression or
// memory allow, and blocks with other content.
void test_tiff_bombs_without_ratio(void **) {
    for (uint16_t compression : {COMPRESSION_WEBP, COMPRESSION_LERC}) {
        if (!TIFFIsCODECConfigured(compression)) continue;
        const bool webp = compression == COMPRESSION_WEBP;
        const TiffBomb empty{1048576, 1300, 8, 3, PLANARCONFIG_CONTIG, 16000, 16000, 0};
        assert_harmless("empty.tif", make_tiff_bomb(empty, compression), beyond("1048576 x 1300 pixels", 0));
        if (webp) {
            const TiffBomb few{16000, 16000, 8, 3, PLANARCONFIG_CONTIG, 16000, 16000, 19};
            assert_harmless("few.tif", make_tiff_bomb(few, compression), beyond("16000 x 16000 pixels", 19));
        }
        const TiffBomb strip{30000, 30000, 8, 3, PLANARCONFIG_CONTIG, 0, 0, 100};
        assert_harmless("strip.tif", make_tiff_bomb(strip, compression), "invalid size of a strip or tile");
        const TiffBomb side{20000, 100, 8, 3, PLANARCONFIG_CONTIG, 0, 0, 100};
        assert_harmless("side.tif", make_tiff_bomb(side, compression), webp ? "invalid size" : "");
        const TiffBomb tile{16368, 16368, 8, 3, PLANARCONFIG_CONTIG, 16368, 16368, 100};
        assert_harmless("tile.tif", make_tiff_bomb(tile, compression), "");
    }
}

// Compressions of fewer bits per sample, or of other colours, than supported pictures have.
void test_tiff_of_no_use(void **) {
    for (uint16_t compression : {COMPRESSION_CCITTRLE, COMPRESSION_CCITTFAX4, COMPRESSION_NEXT, COMPRESSION_THUNDERSCAN,
                                 COMPRESSION_JBIG, COMPRESSION_SGILOG, COMPRESSION_JXL}) {
        save(work("a.tif"), make_tiff_bomb({64, 64, 8, 3, PLANARCONFIG_CONTIG, 0, 0, 100}, compression));
        assert_refused(unreadable, corrected_into("out", {work("a.tif")}),
                       {"a.tif: cannot read: TIFF compression " + std::to_string(compression)
                        + " is not supported; convert it first"});
    }
}

// A valid file of one grey: it is read, reduced, and uniformly `grey`.
void assert_read(const std::string &name, uint8_t grey) {
    ReadOptions options;
    options.max_side = 200;
    const Picture picture = read_picture(work(name), options);
    for (uint8_t byte : picture.pixels)
        if (byte != grey) fail_msg("%s: %d, not %d", name.c_str(), byte, grey);
    fs::remove(work(name));
}

// Uncompressed bytes per byte of the file.
double ratio(const std::string &name, double packed) { return packed / double(fs::file_size(work(name))); }

// Deflate's limit is 1032.
void test_constant_png(void **) {
    constexpr uint32_t side = 8000;
    for (int bits : {1, 8})
        for (int interlace : {PNG_INTERLACE_NONE, PNG_INTERLACE_ADAM7}) {
            PngKind kind{side, side, bits, PNG_COLOR_TYPE_GRAY, interlace};
            kind.extra = [](png_structp png, png_infop) {
                png_set_compression_level(png, 9);
                png_set_filter(png, 0, PNG_FILTER_NONE);
            };
            Bytes packed(size_t(side) * side * unsigned(bits) / 8, 0);
            write_png_file(work("a.png"), kind, packed);
            assert_true(ratio("a.png", double(packed.size())) > (bits == 1 ? 900 : 1000));
            assert_read("a.png", 0);
        }
    Bytes palette(size_t(side) * side / 8, 0);  // 24 bits per bit
    PngKind kind{side, side, 1, PNG_COLOR_TYPE_PALETTE, PNG_INTERLACE_ADAM7};
    kind.extra = [](png_structp png, png_infop info) {
        const png_color colours[] = {{7, 7, 7}, {8, 8, 8}};
        png_set_PLTE(png, info, colours, 2);
    };
    write_png_file(work("a.png"), kind, palette);
    assert_read("a.png", 7);
}

// A TIFF of one grey in strips of `rows`, or in tiles of `rows` x `rows`.
void write_constant_tiff(const std::string &path, uint32_t side, uint16_t compression, bool tiled, uint32_t rows) {
    TIFF *tiff = TIFFOpen(path.c_str(), "w");
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, side);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, side);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8);
    const bool colour = compression == COMPRESSION_WEBP;
    const uint32_t samples = colour ? 3 : 1;
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, samples);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, colour ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, compression);
    if (compression == COMPRESSION_WEBP) TIFFSetField(tiff, TIFFTAG_WEBP_LOSSLESS, 1);
    if (tiled) {
        TIFFSetField(tiff, TIFFTAG_TILEWIDTH, rows);
        TIFFSetField(tiff, TIFFTAG_TILELENGTH, rows);
    } else {
        TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, rows);
    }
    if (compression == COMPRESSION_ADOBE_DEFLATE) TIFFSetField(tiff, TIFFTAG_ZIPQUALITY, 9);
    Bytes block(size_t(tiled ? rows : side) * rows * samples, 128);
    const uint32_t blocks = tiled ? TIFFNumberOfTiles(tiff) : TIFFNumberOfStrips(tiff);
    for (uint32_t i = 0; i < blocks; ++i) {
        const size_t count = tiled ? block.size() : size_t(side) * std::min(rows, side - i * rows) * samples;
        const tmsize_t size = static_cast<tmsize_t>(count);
        assert_true((tiled ? TIFFWriteEncodedTile(tiff, i, block.data(), size)
                           : TIFFWriteEncodedStrip(tiff, i, block.data(), size))
                    == size);
        std::fill(block.begin(), block.end(), uint8_t(128));  // libtiff may modify it
    }
    TIFFClose(tiff);
}

void test_constant_tiff(void **) {
    const std::map<uint16_t, double> least = {
        {COMPRESSION_NONE, 0.9},          {COMPRESSION_PACKBITS, 62}, {COMPRESSION_LZW, 900},
        {COMPRESSION_ADOBE_DEFLATE, 900}, {COMPRESSION_JPEG, 80},     {COMPRESSION_LZMA, 3000},
        {COMPRESSION_ZSTD, 10000},        {COMPRESSION_WEBP, 3000},   {COMPRESSION_LERC, 40000}};
    for (const auto &kind : least) {
        if (!TIFFIsCODECConfigured(kind.first)) continue;
        const bool slow = kind.first == COMPRESSION_WEBP;
        const uint32_t side = slow ? 2000 : 8000, tile = slow ? 512 : 2048;
        for (bool tiled : {false, true}) {
            const uint32_t rows = tiled ? tile : side;
            write_constant_tiff(work("a.tif"), side, kind.first, tiled, rows);
            const double whole = tiled ? 4.0 * rows : side;  // tiles are stored completely
            if (ratio("a.tif", whole * whole) < kind.second)
                fail_msg("compression %d: ratio %g", kind.first, ratio("a.tif", whole * whole));
            assert_read("a.tif", 128);
        }
    }
}

// Several strips share the same bytes: the file is smaller than its pixels, without compression.
void test_shared_strips(void **) {
    write_constant_tiff(work("a.tif"), 64, COMPRESSION_NONE, false, 16);
    Bytes bytes = load(work("a.tif"));
    const auto get = [&](size_t at) { return bytes[at] | bytes[at + 1] << 8 | bytes[at + 2] << 16; };
    Bytes shared(bytes.begin(), bytes.begin() + 8 + 16 * 64);  // the first strip
    const size_t directory = size_t(get(4)), kept = shared.size(), dropped = directory - kept;
    shared.insert(shared.end(), bytes.begin() + long(directory), bytes.end());
    const auto put = [&](size_t at, size_t value) {
        for (size_t i = 0; i < 4; ++i) shared[at + i] = static_cast<uint8_t>(value >> (8 * i));
    };
    put(4, kept);
    for (size_t at = kept + 2; at + 12 <= shared.size() && shared[at + 1] != 0; at += 12) {
        const int tag = shared[at] + 256 * shared[at + 1], count = shared[at + 4];
        if ((tag != TIFFTAG_STRIPOFFSETS && tag != TIFFTAG_STRIPBYTECOUNTS) || count != 4) continue;
        const bool shorts = shared[at + 2] == TIFF_SHORT;
        const size_t values = size_t(shared[at + 8] | shared[at + 9] << 8) - dropped;
        put(at + 8, values);
        for (size_t i = 1; i < 4 && tag == TIFFTAG_STRIPOFFSETS; ++i)
            std::copy_n(shared.begin() + long(values), shorts ? 2 : 4,
                        shared.begin() + long(values + i * (shorts ? 2 : 4)));
    }
    save(work("a.tif"), shared);
    assert_true(shared.size() < 64 * 64);
    assert_read("a.tif", 128);
}

void test_constant_jpeg(void **) {
    Picture picture;
    picture.width = picture.frame_width = picture.height = picture.frame_height = 8000;
    picture.layout = LENSPROF_LAYOUT_GREY;
    picture.row_bytes = 8000;
    picture.pixels.assign(size_t(8000) * 8000, 128);
    for (bool progressive : {false, true}) {
        write_jpeg_file(work("a.jpg"), picture, {90, 1, 1, progressive, false, true});
        assert_read("a.jpg", 128);
    }
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_png_bombs),      CLI_TEST(test_padded_bombs),
        CLI_TEST(test_tiff_bombs),     CLI_TEST(test_tiff_bombs_without_ratio),
        CLI_TEST(test_tiff_of_no_use), CLI_TEST(test_constant_png),
        CLI_TEST(test_constant_tiff),  CLI_TEST(test_shared_strips),
        CLI_TEST(test_constant_jpeg),  CLI_TEST(test_webp_bombs),
        CLI_TEST(test_jxl_bombs),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
