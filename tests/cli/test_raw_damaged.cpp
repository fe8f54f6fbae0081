// Camera raw files with damage that LibRaw does not report: each is refused, whatever was in memory before.
#include "raw_runs.hpp"

#include <random>

using namespace raw_runs;

namespace {

Dng noise(uint16_t bits, Packing packing) {
    Dng dng;
    dng.width = 160, dng.height = 120, dng.bits = bits, dng.packing = packing;
    dng.white = (1u << bits) - 1;
    dng.black = {100};
    std::mt19937 random(3);
    for (size_t i = 0; i < size_t(160) * 120; i++)
        dng.values.push_back(static_cast<uint16_t>(200 + random() % (dng.white - 300)));
    return dng;
}

void write_bytes(const std::string &name, const Bytes &bytes) { save(work(name), bytes); }

// Read alone and after another picture, reduced and at full size.
void assert_damaged(const Bytes &bytes, const char *why) {
    write_bytes("damaged.dng", bytes);
    for (const uint32_t side : {0u, 80u}) {
        ReadOptions options;
        options.max_side = side;
        assert_failure(LENSPROF_ERROR_READ, why, [&] { read_picture(work("damaged.dng"), options); });
        assert_int_equal(read_picture(work("good.dng"), options).reduction, side ? 2 : 1);
        assert_failure(LENSPROF_ERROR_READ, why, [&] { read_picture(work("damaged.dng"), options); });
    }
}

// The JPEG is at the end of the file: SOI, SOF3 with its height at byte 7, DHT, SOS.
void test_lossless_jpeg(void **) {
    needs_libraw();
    const Dng dng = noise(14, Packing::lossless);
    const Bytes whole = dng_bytes(dng);
    const size_t at = whole.size() - lossless_jpeg(dng).size();
    write_bytes("good.dng", whole);
    const auto changed = [&](size_t first, size_t count, uint8_t value) {
        Bytes bytes = whole;
        std::fill_n(bytes.begin() + static_cast<ptrdiff_t>(at + first), count, value);
        return bytes;
    };
    assert_damaged(changed(0, 1, 0), "no valid header");
    assert_damaged(changed(0, 512, 0), "no valid header");
    assert_damaged(changed(0, whole.size() - at, 0), "no valid header");
    assert_damaged(changed(3, 1, 0xc0), "no valid header");   // another process
    assert_damaged(changed(16, 1, 0xfe), "no valid header");  // no table
    assert_damaged(changed(8, 1, 60), "does not fill");       // half the height
    assert_damaged(changed(10, 1, 159), "does not fill");
    assert_damaged(changed(2000, whole.size() - at - 2000, 0), "damaged");  // codes of zero, the shortest ones
}

void test_junk_of_a_large_size(void **) {
    needs_libraw();
    Dng dng = noise(14, Packing::lossless);
    write_bytes("good.dng", dng_bytes(dng));
    const size_t jpeg = lossless_jpeg(dng).size();
    dng.declared = 4000;
    Bytes bytes = dng_bytes(dng);
    for (size_t i = bytes.size() - jpeg; i < bytes.size(); i++) bytes[i] = "junk"[i % 4];
    assert_damaged(bytes, "no valid header");
    const Outcome outcome = run_words({"flat", work("damaged.dng"), "--no-store"});
    assert_int_equal(outcome.code, unreadable);
    assert_true(contains(outcome.err, "damaged.dng"));
}

// Without DNGVersion, LibRaw uses a decoder that pads with zeros.
void test_packed_rows_that_lack(void **) {
    needs_libraw();
    const struct {
        const char *maker, *model, *end;
    } cameras[] = {{"NIKON CORPORATION", "NIKON D700", "nef"}, {"PENTAX", "PENTAX K-5", "pef"}};
    for (const auto &camera : cameras) {
        Dng dng = noise(12, Packing::bits);
        dng.maker = camera.maker, dng.model = camera.model, dng.is_dng = false;
        const std::string name = std::string("x.") + camera.end;
        const Bytes whole = dng_bytes(dng);
        write_bytes(name, whole);
        assert_true(read_picture(work(name)).width >= 156);  // LibRaw crops pictures of some cameras
        for (const size_t lacks : {1u, 10u, 200u, 5000u}) {
            write_bytes(name, Bytes(whole.begin(), whole.end() - static_cast<ptrdiff_t>(lacks)));
            assert_failure(LENSPROF_ERROR_READ, "are cut off", [&] { read_picture(work(name)); });
        }
    }
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_lossless_jpeg),
        CLI_TEST(test_junk_of_a_large_size),
        CLI_TEST(test_packed_rows_that_lack),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
