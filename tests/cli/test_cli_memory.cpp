// Peak memory of the program, as a process, while it corrects pictures. A child starts with the peak of its parent, so
// this process must stay small: pictures are made in children.
#include "program_runs.hpp"

using namespace program_runs;

namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool keeps_freed_memory = true;
#else
constexpr bool keeps_freed_memory = false;
#endif

// Peak memory of the program as a process, bytes.
long peak_of(const Words &words) {
    const Ended ended = run_program(words);
    if (ended.code != done) fail_msg("exit code %d, %s", ended.code, ended.err.c_str());
    return ended.peak;
}

// Equal rows compress well, which keeps the test fast.
Picture make_tall(uint32_t height) {
    Picture picture = make_smooth(600, 16, LENSPROF_LAYOUT_RGB);
    picture.pixels.resize(picture.row_bytes * height);
    for (size_t i = picture.row_bytes * 16; i < picture.pixels.size(); ++i)
        picture.pixels[i] = picture.pixels[i - picture.row_bytes * 16];
    picture.height = picture.frame_height = height;
    return picture;
}

// A file with `height` rows, made in a separate process so that this process, from which later children start, stays
// small.
std::string make_tall_file(const std::string &kind, uint32_t height) {
    const std::string path = work(kind + std::to_string(height) + "." + kind.substr(kind.size() - 3));
    const pid_t child = fork();
    if (child == 0) {
        Picture picture = make_tall(height);
        picture.traits.compression = kind == "stored.tif" ? COMPRESSION_NONE : COMPRESSION_LZW;
        TiffKind tiles{"w", COMPRESSION_LZW};
        tiles.tile = 128;
        if (kind == "tiles.tif")
            write_tiff_file(path, picture, tiles);
        else
            write_picture(path, picture);
        _exit(0);
    }
    int status = 1;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
    return path;
}

// The tall pictures have 12 MB more of pixels, and as a JPEG 25 MB more of coefficients.
void test_memory_does_not_grow_with_height(void **) {
    if (keeps_freed_memory) skip();
    const uint32_t low = 1000, high = 8000;
    database();
    for (const std::string kind : {"rows.png", "strips.tif", "stored.tif", "tiles.tif", "baseline.jpg"}) {
        const std::string small = make_tall_file(kind, low), tall = make_tall_file(kind, high);
        const Words words = {"--threads", "1", "--contact-sheet", work("sheet.png")};
        const long few = peak_of(corrected_into("out", words + Words{small})),
                   many = peak_of(corrected_into("out", words + Words{tall}));
        if (many - few > 6 << 20)
            fail_msg("%s: %ld KiB for %u rows, %ld KiB for %u", kind.c_str(), few / 1024, low, many / 1024, high);
        fs::remove(small);
        fs::remove(tall);
        fs::remove_all(work("out"));
    }
}

// One picture per thread.
void test_memory_does_not_grow_with_pictures(void **) {
    if (keeps_freed_memory) skip();
    database();
    const std::string file = make_tall_file("strips.tif", 1500);
    Words files;
    for (int i = 0; i < 16; ++i) {
        files.push_back(work(std::to_string(i) + ".tif"));
        fs::create_hard_link(file, files.back());
    }
    const long few = peak_of(corrected_into("out", {"--threads", "2", files[0], files[1]})),
               many = peak_of(corrected_into("out", Words{"--threads", "2"} + files));
    if (many - few > 6 << 20) fail_msg("%ld KiB for two pictures, %ld KiB for 16", few / 1024, many / 1024);
}

// The program uses at most 12 bytes per value of a map, on which its limit of 80 million values is based.
void test_memory_of_a_map(void **) {
    if (keeps_freed_memory) skip();
    save_text(
        work("three.json"),
        R"({"schema":1,"key":{"camera_model":"C","lens":"L","focal_mm":35,"processing":"jpeg"},"vignetting":)"
        R"({"k":[[-0.4,0.1,-0.1],[-0.3,0.1,-0.1],[-0.4,0.1,-0.1]],"center":[0,0]},"response":{"kind":"linear"}})");
    assert_int_equal(run_program({"profile", "import", work("three.json"), "--db", work("map.db")}).code, done);
    const Words words = {"profile", "export",        "1",          "--db",         work("map.db"),
                         "-o",      work("map.tif"), "--encoding", "frame=800x800"};
    const long few = peak_of(words + Words{"--encoding", "grid=2x2"}), many = peak_of(words);
    assert_in_range(many - few, 0, 14 * 3 * 800 * 800);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_memory_does_not_grow_with_height),
        CLI_TEST(test_memory_does_not_grow_with_pictures),
        CLI_TEST(test_memory_of_a_map),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
