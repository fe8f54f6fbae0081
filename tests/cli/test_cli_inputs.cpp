// Inputs that are not regular files, that are too long or too many, or whose names are not UTF-8.
#include <exiv2/exiv2.hpp>  // before cmocka, which makes a macro of `fail`

#include "cli_runs.hpp"

#include <fcntl.h>
#include <sys/time.h>

using namespace cli_runs;

namespace {

// In a child with 1 GB of memory and 20 s: an endless file must not be read completely.
void assert_refused_in_bounds(const Words &words, const std::string &named) {
    const Outcome outcome = run_child(words, [] {
        alarm(20);
#if !defined(__SANITIZE_ADDRESS__)
        const rlimit bytes = {1u << 30, 1u << 30};
        setrlimit(RLIMIT_AS, &bytes);
#endif
    });
    if (outcome.code != unreadable || !contains(outcome.err, named))
        fail_msg("%s: exit code %d: %s", joined(words).c_str(), outcome.code, outcome.err.c_str());
}

Words build(const std::string &pto, const Words &more = {}) { return Words{"build", pto, "--no-store"} + quick + more; }

void test_apply_to_nothing(void **) {
    assert_refused(usage, {"apply", "--profile", "1", "-o", work("out"), ""}, {"FILE"});
}

void test_folder_with_a_link_to_itself(void **) {
    const std::string copy = copy_of("scene"), db = work("p.db");
    must_exit(done, Words{"build", copy + "/pano.pto", "--db", db} + quick);
    fs::create_symlink("loop.png", copy + "/loop.png");
    const Words words = {"apply", "--profile", "1", "--db", db, "-o", work("out"), copy};
    const Outcome outcome = run_words(words);
    assert_int_equal(outcome.code, unreadable);
    assert_true(contains(outcome.err, copy + "/loop.png: cannot read"));
    assert_false(contains(outcome.err, "filesystem error"));
    assert_true(fs::exists(work("out/img000.png")));  // the others are corrected
    assert_false(fs::exists(work("out/loop.png")));
}

void test_long_names(void **) {
    const std::string pto = copy_of("scene") + "/pano.pto";
    for (const size_t length : {300, 5000, 100000}) {
        save_text(pto, text_of(scene("pano.pto")));
        edit(pto, "img001.png", std::string(length, 'x'));
        for (const Words &words :
             {build(pto), build(pto, {"--points", work("points.txt")}), Words{"apply", "--pto", pto, "-o", work("out")},
              Words{"align", "--project", pto, "-o", work("out")}}) {
            assert_refused(unreadable, words, {pto, "image 1"});
            assert_true(run_words(words).err.size() < 1000);
        }
    }
    const std::string name = work(std::string(5000, 'x'));
    for (const Words &words :
         {build(name), Words{"apply", "--pto", name, "-o", work("out")},
          Words{"apply", "--profile", "1", "-o", work("out"), name}, Words{"profile", "list", "--db", name},
          Words{"profile", "import", name}, build(scene("pano.pto"), {"--write", std::string("points=") + name}),
          Words{"bracket", name, name + "y", "--no-store"}, Words{"flat", name, "--linear", "--no-store"},
          Words{"simulate", "-o", name}, Words{"profile", "show", "1", "--blob", name}}) {
        const Outcome outcome = run_words(words);
        assert_true(outcome.code != done && outcome.code != stopped);
        if (contains(outcome.err, "filesystem error")) fail_msg("%s: %s", words[0].c_str(), outcome.err.c_str());
    }
}

void test_what_is_no_file(void **) {
    assert_int_equal(mkfifo(work("fifo").c_str(), 0600), 0);
    fs::create_directory(work("folder"));
    for (const std::string &name : {std::string("/dev/zero"), work("fifo"), work("folder")}) {
        if (name != work("folder")) assert_refused_in_bounds(build(name), name);  // a folder may hold pictures
        assert_refused_in_bounds(build(scene("pano.pto"), {"--points", name}), name);
        assert_refused_in_bounds(build(scene("pano.pto"), {"--fit", std::string("truth=") + name}), name);
        assert_refused_in_bounds({"apply", "--pto", name, "-o", work("out")}, name);
        assert_refused_in_bounds({"align", "--project", name, "-o", work("out")}, name);
        assert_refused_in_bounds({"profile", "import", name}, name);
        assert_refused_in_bounds({"profile", "show", "--blob", name}, name);
    }
}

// A sparse file of this size, which takes no space on the disk.
std::string sparse(const std::string &name, uint64_t bytes) {
    save_text(name, "p f2\n");
    fs::resize_file(name, bytes);
    return name;
}

void test_files_that_are_too_large(void **) {
    const std::string pto = sparse(work("65.pto"), uint64_t(65) << 20), json = work("65.json");
    fs::copy(pto, json);
    for (const Words &words : {build(pto), build(scene("pano.pto"), {"--fit", std::string("truth=") + pto}),
                               Words{"profile", "import", json}}) {
        const Outcome outcome = run_child(words);
        assert_int_equal(outcome.code, unreadable);
        assert_true(contains(outcome.err, "exceeds the maximum size of such a file"));
    }
    const Outcome unknown = run_child({"profile", "import", pto});
    assert_int_equal(unknown.code, usage);
    assert_true(contains(unknown.err, "give it with --format"));
}

// Point files may be large: the first lines show whether it is one.
void test_large_files_of_no_points(void **) {
    const std::string points = sparse(work("points.txt"), uint64_t(3) << 30), line = work("line.txt");
    save_text(line, std::string(100000, '1'));
    for (const std::string &file : {points, line})
        assert_refused_in_bounds(build(scene("pano.pto"), {"--points", file}), "line 1");
    fs::remove(points);
}

// A project of many images, all of the same file.
std::string many_pictures(const std::string &folder, const char *last, uint32_t count, const char *size) {
    std::string text = "p f2 w3000 h1500 v360\n";
    for (uint32_t i = 0; i < count; i++)
        text += "i " + std::string(size) + " f0 v" + (i ? "=0" : "50") + " Eev0 r0 p0 y" + std::to_string(i % 360)
                + " n\"" + (i + 1 < count ? "one.png" : last) + "\"\n";
    save_text(folder + "/many.pto", text + "v Eev1\n");
    return folder + "/many.pto";
}

double seconds_now() {
    timeval now = {};
    gettimeofday(&now, nullptr);
    return double(now.tv_sec) + 1e-6 * double(now.tv_usec);
}

// All are checked before the first is loaded: an error in the last one is reported without delay.
void test_pictures_are_checked_first(void **) {
    write_picture(work("one.png"), make_smooth(1500, 1500, LENSPROF_LAYOUT_RGB));
    write_picture(work("small.png"), make_smooth(150, 100, LENSPROF_LAYOUT_RGB));
    const double start = seconds_now();
    for (const char *last : {"missing.png", "small.png", "many.pto"})
        assert_refused(unreadable, build(many_pictures(work(""), last, 1000, "w1500 h1500"), {"--one-lens"}), {last});
    assert_true(seconds_now() - start < 20.0);  // loading them takes minutes
    const std::string pto = many_pictures(work(""), "one.png", 2000, "w1500 h1500");
    assert_refused(unreadable, build(pto, {"--one-lens", "--fit", "max-side=0"}),
                   {pto, "2000 pictures need 16.8 GiB of memory", "--fit max-side"});
}

// A file is recognised among thousands, under any name.
void test_many_files(void **) {
    constexpr uint32_t count = 3000;
    write_picture(work("0.png"), make_smooth(20, 10, LENSPROF_LAYOUT_GREY));
    const Bytes bytes = load(work("0.png"));
    Words frames = {"align", "-o", work("out"), work("0.png")};
    std::string text = "p f2 w3000 h1500 v360\n";
    for (uint32_t i = 0; i < count; i++) {
        const std::string name = std::to_string(i) + ".png";
        text += "i w20 h10 f0 v" + std::string(i ? "=0" : "50") + " Eev0 r0 p0 y0 Va-0.1 n\"" + name + "\"\n";
        if (i) save(work(name), bytes), frames.push_back(work(name));
    }
    save_text(work("many.pto"), text);
    fs::create_hard_link(work("7.png"), work("same.png"));
    fs::create_symlink("8.png", work("link.png"));
    const double start = seconds_now();
    for (const char *name : {"0.png", "same.png", "link.png", "./9.png"}) {
        const Outcome outcome = run_words(frames + Words{work(name)});
        assert_int_equal(outcome.code, usage);
        assert_true(contains(outcome.err, std::string(name) + ": given twice"));
    }
    write_picture(work("other.png"), make_smooth(20, 10, LENSPROF_LAYOUT_GREY));
    const Outcome apply =
        run_words({"apply", "--pto", work("many.pto"), "-o", work("out"), work(""), work("other.png")});
    assert_int_equal(apply.code, usage);
    assert_true(contains(apply.err, "other.png: is not a picture of"));
    assert_true(seconds_now() - start < 20.0);  // comparing all pairs takes minutes
}

void test_image_without_a_name(void **) {
    const std::string pto = copy_of("scene") + "/pano.pto";
    edit(pto, "n\"img001.png\"", "n\"\"");
    for (const Words &words : {build(pto), Words{"apply", "--pto", pto, "-o", work("out")}})
        assert_refused(unreadable, words, {pto + ": image 1 has no file name", "correct the project"});
}

// Warnings are also lines for a terminal: control characters in names are escaped, whether of one or two bytes.
void test_names_with_control_characters(void **) {
    const std::string name = work("a\x1b[31m\xc2\x9b\xc2\xa0.jpg");
    fs::copy_file(mixed("img005.jpg"), name);
    const std::string err = run_words({"flat", name, "--linear", "--no-store"}).err;
    assert_true(contains(err, "warning: " + work("a\\x1b[31m\\xc2\\x9b\xc2\xa0.jpg") + ": JPEG rounds"));
    assert_false(contains(err, "\x1b") || contains(err, "\xc2\x9b"));
}

void test_files_in_place_of_folders(void **) {
    const std::string pto = scene("pano.pto"), file = scene("img000.png");
    must_exit(done, Words{"build", pto, "--db", work("p.db")} + quick);
    for (const std::string &name : {file, file + "/deeper"})
        for (const Words &words :
             {Words{"simulate", "-o", name}, Words{"apply", "--profile", "1", "--db", work("p.db"), file, "-o", name},
              Words{"align", "--project", pto, "-o", name}})
            assert_refused(usage, words, {name + ": " + file + " is not a folder; give another name"});
    for (const std::string &name : {file + "/x.db", file + "/deeper/x.db"})
        assert_refused(store_failed, {"build", pto, "--db", name}, {name + ": " + file + " is not a folder"});
    for (const std::string &name : {std::string("/dev/full"), scene("")})
        assert_refused(usage, build(pto, {"--write", std::string("points=") + name}),
                       {name + ": ", "give the name of a file"});
}

// Values that a profile cannot hold are not truncated silently.
void test_names_that_are_too_long(void **) {
    const std::string camera(63, 'c'), lens(127, 'l'), db = work("p.db"), copy = copy_of("scene");
    const Words words = Words{"build", copy + "/pano.pto", "--db", db} + quick;
    assert_refused(usage, words + Words{"--camera", camera + "c"}, {"--camera: is 64 bytes long", "at most 63"});
    assert_refused(usage, words + Words{"--lens", lens + "l"}, {"--lens: is 128 bytes long", "at most 127"});
    save_text(work("pcalib.txt"), "0 1 2 3\n");
    assert_refused(usage, {"profile", "import", work("pcalib.txt"), "--camera", camera + "c", "--db", db},
                   {"--camera: "});
    must_exit(done, words + Words{"--camera", camera, "--lens", lens});
    {
        auto image = Exiv2::ImageFactory::open(copy + "/img000.png");
        image->readMetadata();
        image->exifData()["Exif.Photo.LensModel"] = lens + "xyz";
        image->writeMetadata();
    }
    const Outcome cut = run_words(words + Words{"--camera", "C"});
    assert_int_equal(cut.code, done);
    assert_true(contains(cut.err, "img000.png: the EXIF text for --lens is too long and was truncated"));
    for (const Words &quiet : {words + Words{"--lens", "L"}, Words{"build", copy + "/pano.pto", "--no-store"} + quick})
        assert_false(contains(run_words(quiet).err, "--lens"));
}

// How people and scripts see a name that is not UTF-8.
void test_names_that_are_not_utf8(void **) {
    const std::string copy = copy_of("scene"), name = "b\xe9\xed\xa0\x80.png", db = work("p.db");
    fs::rename(copy + "/img001.png", copy + "/" + name);
    edit(copy + "/pano.pto", "img001.png", name);
    const Json build = json_of(Words{"build", copy + "/pano.pto", "--db", db, "--json"} + quick);
    assert_string_equal(build["images"][1]["file_bytes"].get<std::string>().c_str(), "62e9eda0802e706e67");
    assert_false(build["images"][0].contains("file_bytes"));
    assert_true(contains(build["images"][1]["file"].get<std::string>(), "\xef\xbf\xbd"));
    const Json apply = json_of({"apply", "--profile", "1", "--db", db, "-o", work("out"), "--json", copy + "/" + name});
    const std::string hex = apply["pictures"][0]["output_bytes"].get<std::string>();
    std::string bytes;
    for (size_t i = 0; i + 1 < hex.size(); i += 2) bytes += char(std::stoi(hex.substr(i, 2), nullptr, 16));
    assert_string_equal(bytes.c_str(), work("out/" + name).c_str());
    assert_true(fs::exists(bytes));
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_apply_to_nothing),
        CLI_TEST(test_folder_with_a_link_to_itself),
        CLI_TEST(test_long_names),
        CLI_TEST(test_what_is_no_file),
        CLI_TEST(test_files_that_are_too_large),
        CLI_TEST(test_large_files_of_no_points),
        CLI_TEST(test_pictures_are_checked_first),
        CLI_TEST(test_many_files),
        CLI_TEST(test_image_without_a_name),
        CLI_TEST(test_names_with_control_characters),
        CLI_TEST(test_files_in_place_of_folders),
        CLI_TEST(test_names_that_are_too_long),
        CLI_TEST(test_names_that_are_not_utf8),
    };
    return cmocka_run_group_tests(tests, make_scene, remove_folder);
}
