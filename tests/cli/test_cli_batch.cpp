// Many pictures corrected simultaneously, each in strips: the bytes do not depend on threads and strips. Also what
// remains after a failure.
#include "batch_runs.hpp"

#include "cli/program/progress.hpp"
#include "photo/correct/copy_losses.hpp"
#include "photo/correct/correction.hpp"

using namespace batch_runs;

namespace {

// Whether all that was printed is one line that states clipping.
bool is_clipping_alone(const std::string &said) {
    return contains(said, "lensprof: warning: ") && contains(said, ": the correction clips up to ")
           && std::count(said.begin(), said.end(), '\n') == 1;
}

// One picture for every way of reading and writing rows.
Words make_kinds() {
    Words files;
    const auto next = [&](const std::string &name) { return files.emplace_back(work("in/" + name)); };
    fs::create_directories(work("in"));
    for (uint32_t layout : {LENSPROF_LAYOUT_GREY_ALPHA, LENSPROF_LAYOUT_RGB})
        for (uint32_t sample : {LENSPROF_SAMPLE_U8, LENSPROF_SAMPLE_U16, LENSPROF_SAMPLE_F32}) {
            const Picture picture = make_noise(97, 61, sample, layout);
            const std::string name = std::to_string(layout) + std::to_string(sample);
            write_picture(next(name + ".tif"), picture);
            for (uint32_t tile : {0u, 16u}) {
                TiffKind kind{"w", COMPRESSION_LZW, PLANARCONFIG_SEPARATE};
                kind.tile = tile;
                write_tiff_file(next(name + "planes" + std::to_string(tile) + ".tif"), picture, kind);
            }
            if (sample != LENSPROF_SAMPLE_F32) write_picture(next(name + ".png"), picture);
        }
    Bytes bytes = make_noise(97, 61, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB).pixels;
    write_png_file(next("interlaced.png"),
                   {97, 61, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_ADAM7, [](png_structp, png_infop) {}}, bytes);
    for (bool progressive : {false, true})
        write_jpeg_file(next(progressive ? "progressive.jpg" : "baseline.jpg"),
                        make_smooth(97, 61, LENSPROF_LAYOUT_RGB), {90, 2, 2, progressive, false});
    write_picture(next("grey.jpg"), make_smooth(97, 61, LENSPROF_LAYOUT_GREY));
    return files;
}

// All files of a folder, by name.
std::map<std::string, Bytes> contents(const std::string &place) {
    std::map<std::string, Bytes> all;
    for (const fs::directory_entry &entry : fs::directory_iterator(place))
        all[entry.path().filename().string()] = load(entry.path().string());
    return all;
}

// The expected result: the whole picture corrected in one step.
Picture corrected_whole(const std::string &file, const lensprof_profile &model, bool linear) {
    Picture source = read_picture(file), result = source;
    lensprof_apply_options options;
    lensprof_apply_options_init(&options);
    options.output = linear ? LENSPROF_ENCODING_LINEAR : LENSPROF_ENCODING_RESPONSE;
    if (source.sample == LENSPROF_SAMPLE_F32) options.input = options.output = LENSPROF_ENCODING_LINEAR;
    options.frame_width = source.width;
    options.frame_height = source.height;
    options.source_sample = source.sample;
    options.source_layout = source.layout;
    options.target_sample = linear ? static_cast<uint32_t>(LENSPROF_SAMPLE_F32) : source.sample;
    options.responses = model.responses;
    options.vignettings = model.vignettings;
    options.response = model.response;
    options.vignetting = model.vignetting;
    options.grid = &model.grid;
    result.sample = options.target_sample;
    result.row_bytes =
        source.width * lensprof_layout_samples(source.layout) * lensprof_sample_type_bytes(result.sample);
    result.pixels.assign(result.row_bytes * result.height, 0);
    std::vector<uint64_t> memory(lensprof_plan_bytes(&options) / 8 + 1);
    const lensprof_plan *plan = nullptr;
    assert_ok(lensprof_plan_init(memory.data(), memory.size() * 8, &options, &plan, nullptr));
    const lensprof_image from = source.view();
    const lensprof_target to = result.target();
    assert_ok(lensprof_apply(plan, &from, &to, 0, 0));
    return result;
}

std::map<std::string, Bytes> correct_by(const Words &files, bool linear, uint32_t threads, uint32_t strip_rows) {
    std::shared_ptr<const lensprof_profile> model = make_profile_of_lens();
    std::vector<Correction> jobs;
    const std::string out = work("strips");
    fs::remove_all(out);
    fs::create_directory(out);
    for (const std::string &file : files) {
        fs::path name = fs::path(file).filename();
        if (linear) name += ".tif";
        Correction job;
        job.source = file, job.target = out + "/" + name.string(), job.model = model, job.model_name = "lens";
        lensprof_exposure_init(&job.exposure);
        lensprof_exposure_init(&job.target_exposure);
        jobs.push_back(job);
    }
    std::ostringstream output, said;
    Streams streams{output, said};
    Progress progress(streams);
    CorrectionKind kind;
    kind.linear = linear;
    kind.threads = threads;
    kind.strip_rows = strip_rows;
    const Corrected corrected = write_corrected(jobs, kind, nullptr, progress);
    assert_int_equal(corrected.pictures.size(), files.size());
    for (size_t i = 0; i < files.size(); ++i)
        assert_string_equal(corrected.pictures[i]["file"].get<std::string>().c_str(), files[i].c_str());
    assert_true(linear ? said.str().empty() : is_clipping_alone(said.str()));  // of noise, a part turns white
    return contents(out);
}

void test_same_bytes_by_any_threads_and_strips(void **) {
    const Words files = make_kinds();
    const auto model = make_profile_of_lens();
    for (const bool linear : {false, true}) {
        const auto wanted = correct_by(files, linear, 1, 1000);
        assert_int_equal(wanted.size(), files.size());
        for (const auto &way : {std::pair<uint32_t, uint32_t>{1, 1}, {2, 7}, {5, 16}, {500, 0}})
            for (const auto &file : correct_by(files, linear, way.first, way.second))
                if (file.second != wanted.at(file.first))
                    fail_msg("%u threads, strips of %u rows: bytes of %s differ", way.first, way.second,
                             file.first.c_str());
        for (const std::string &file : files) {
            const std::string name = fs::path(file).filename().string();
            write_picture(work("whole" + name + ".tif"), corrected_whole(file, *model, linear));
            const Picture whole = read_picture(work("whole" + name + ".tif")),
                          strips = read_picture(work("strips/" + name + (linear ? ".tif" : "")));
            if (fs::path(file).extension() == ".jpg" && !linear)
                assert_near_pixels(whole, strips, 60);  // coding noise
            else
                assert_same_pixels(whole, strips);
        }
    }
}

// Strips read by PictureReader and written by PictureWriter give the same file as write_picture.
void test_reader_and_writer(void **) {
    for (const std::string &file : make_kinds()) {
        const std::string extension = fs::path(file).extension().string();
        write_picture(work("whole" + extension), read_picture(file));
        for (uint32_t strip : {1u, 7u, 61u}) {
            PictureReader reader(file);
            PictureWriter writer(work("strips" + extension), reader.header());
            Bytes rows(reader.header().row_bytes * strip);
            for (uint32_t y = 0; y < 61; y += strip) {
                const Picture &header = reader.header();
                const lensprof_target view = {rows.data(),   ptrdiff_t(header.row_bytes),
                                              header.width,  std::min(strip, 61 - y),
                                              header.sample, header.layout};
                reader.read(view);
                writer.write(image_of(view));
            }
            assert_true(writer.finish());
            assert_false(fs::exists(work("strips" + extension)));
            writer.commit();
            assert_true(load(work("strips" + extension)) == load(work("whole" + extension)));
            fs::remove(work("strips" + extension));
        }
    }
}

// A contact sheet does not depend on the number of threads either.
void test_sheet_by_any_threads(void **) {
    const Words files = make_kinds();
    Bytes wanted;
    for (const char *threads : {"1", "2", "5"}) {
        const std::string out = std::string("out") + threads;
        must_exit(done, corrected_into(out, Words{"--threads", threads, "--contact-sheet", work("sheet.png")} + files));
        const Bytes sheet = load(work("sheet.png"));
        assert_true(wanted.empty() || sheet == wanted);
        wanted = sheet;
    }
    const Picture sheet = read_picture(work("sheet.png"));
    assert_true(sheet.width >= 6 * 97 && sheet.height >= files.size() / 6 * 2 * 61);
}

// Failures.

// Gives a picture a valid header but incomplete pixels.
void damage(const std::string &file) {
    Bytes bytes = load(file);
    if (fs::path(file).extension() == ".tif")  // the directory is at the end
        std::fill_n(bytes.begin() + long(bytes.size() / 2), 200, uint8_t(0xee));
    else
        bytes.resize(bytes.size() / 2);
    save(file, bytes);
    read_header(file);
}

void set_not_a_number(const std::string &file) {
    Picture picture = make_noise(200, 150, LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_RGB);
    const float nan = NAN;
    std::memcpy(&picture.pixels[picture.pixels.size() - 8], &nan, 4);
    write_picture(file, picture);
}

// Every picture but the bad ones is written, whatever the threads; these are listed, and nothing else remains.
void test_bad_picture_among_good_ones(void **) {
    for (const std::string extension : {".png", ".jpg", ".tif", ".float.tif"}) {
        fs::remove_all(work("in"));
        fs::create_directories(work("in"));
        Words files;
        for (int i = 0; i < 12; ++i) {
            files.push_back(work("in/" + std::to_string(10 + i) + extension));
            write_picture(files.back(), make_noise(200, 150, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB));
        }
        const bool number = extension == ".float.tif";
        for (int bad : {5, 6, 11}) number ? set_not_a_number(files[size_t(bad)]) : damage(files[size_t(bad)]);
        for (const char *threads : {"1", "2", "5", "40"}) {
            fs::remove_all(work("out"));
            const Outcome outcome = run_words(corrected_into("out", Words{"--threads", threads} + files));
            assert_int_equal(outcome.code, unreadable);
            assert_true(contains(outcome.err, "lensprof: 3 of 12 pictures left out:\n"));
            const char *reason = number ? "pixel 199, 149 is not a finite number" : "truncated or damaged";
            for (int bad : {5, 6, 11}) {
                const size_t place = outcome.err.find("lensprof:   " + files[size_t(bad)] + ": ");
                assert_true(place != std::string::npos);
                assert_true(outcome.err.find(reason, place) < outcome.err.find('\n', place));
            }
            assert_int_equal(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 9);
            const auto left = contents(work("out"));
            assert_int_equal(left.size(), 9);
            for (const auto &file : left) {
                const int number_of_file = std::stoi(file.first);
                assert_true(number_of_file != 15 && number_of_file != 16 && number_of_file != 21);
                assert_int_equal(read_picture(work("out/" + file.first)).height, 150);
            }
        }
    }
}

// The disk is full for one picture: an older file of this name stays.
void test_full_disk_among_pictures(void **) {
    fs::create_directories(work("in"));
    fs::create_directories(work("out"));
    Words files;
    for (int i = 0; i < 8; ++i) {
        files.push_back(work("in/" + std::to_string(i) + ".tif"));
        const uint32_t side = i == 4 ? 400 : 60;
        write_picture(files.back(), make_noise(side, side, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB));
    }
    save_text(work("out/4.tif"), "old");
    for (const char *threads : {"1", "2", "5"}) {
        const Outcome outcome = run_child(corrected_into("out", Words{"--threads", threads} + files), [] {
            signal(SIGXFSZ, SIG_IGN);
            const rlimit limit = {100000, 100000};
            if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(254);
        });
        assert_int_equal(outcome.code, failed);
        assert_true(contains(outcome.err, work("out/4.tif") + ": cannot write: File too large"));
        assert_int_equal(contents(work("out")).size(), 5);
        assert_string_equal(text_of(work("out/4.tif")).c_str(), "old");
    }
}

// Messages.

void test_speed_is_said(void **) {
    fs::create_directories(work("in"));
    Words files;
    for (int i = 0; i < 5; ++i) {
        files.push_back(work("in/" + std::to_string(i) + ".png"));
        write_picture(files.back(), make_noise(300, 200, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB));
    }
    const Json json = json_of(corrected_into("out", Words{"--json"} + files));
    const double seconds = json["seconds"].get<double>(), rate = json["megapixels_per_second"].get<double>();
    assert_true(seconds > 0);
    assert_close(seconds * rate, 5 * 300 * 200 * 1e-6, 1e-9);

    assert_true(is_clipping_alone(run_words(corrected_into("out", files)).err));
    const std::string said = run_words(corrected_into("out", Words{"--progress"} + files)).err;
    assert_true(contains(said, "correcting 0 %, 0 of 5 pictures"));
    assert_true(contains(said, " of 5 pictures, "));
    assert_true(contains(said, "megapixels/s"));
    assert_true(contains(said, "corrected 5 pictures, 0.3 megapixels in "));
    const std::string one = run_words(corrected_into("out", {"--progress", files[0]})).err;
    assert_true(contains(one, "of 1 pictures"));
    assert_false(contains(one, "corrected"));
}

void test_bad_thread_counts(void **) {
    write_picture(work("a.png"), make_noise(30, 20, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB));
    for (const char *word : {"-1", "1025", "many", "1.5", "nan", ""}) {
        assert_refused(usage, corrected_into("out", {"--threads", word, work("a.png")}), {"--threads"});
        assert_refused(usage, {"align", "--threads", word, "-o", work("out"), work("a.png"), work("a.png")},
                       {"--threads"});
    }
}

void test_time_left(void **) {
    TimeLeft left;
    assert_close(left.seconds("reading", 0.0, 100.0), 0.0, 0.0);
    assert_close(left.seconds("reading", 0.1, 101.0), 0.0, 0.0);  // too early for an estimate
    assert_close(left.seconds("reading", 0.25, 110.0), 30.0, 1e-9);
    assert_close(left.seconds("reading", 0.5, 110.0), 10.0, 1e-9);
    assert_close(left.seconds("sampling", 0.2, 111.0), 0.0, 0.0);   // other work starts a new estimate,
    assert_close(left.seconds("sampling", 0.6, 115.0), 4.0, 1e-9);  // from the progress it had then
    assert_close(left.seconds("sampling", 0.1, 116.0), 0.0, 0.0);   // and so does work that is repeated
    left.seconds("fitting", 0.0, 120.0), left.seconds("fitting", 1.0, 140.0);
    assert_close(left.seconds("fitting", 0.0, 140.0), 0.0, 0.0);  // repeated once more
    assert_close(left.seconds("fitting", 0.3, 143.0), 7.0, 1e-9);
    assert_true(describe_time_left(4.0).empty());
    assert_string_equal(describe_time_left(41.2).c_str(), ", 42 s left");
    assert_string_equal(describe_time_left(61.0).c_str(), ", 2 min left");
    assert_string_equal(describe_time_left(7501.0).c_str(), ", 2 h 6 min left");
}

// The advice is a whole command if the user did not give one.
void test_losses_name_a_command(void **) {
    std::ostringstream out, err;
    Streams streams{out, err};
    Progress command(streams);
    const CallerScope caller(&command);
    std::vector<Correction> jobs(3);
    for (size_t i = 0; i < jobs.size(); i++) {
        jobs[i].source = std::to_string(i) + ".jpg";
        jobs[i].command = i == 1 ? "lensprof apply --pto 'the folder/panorama_a.pto'" : "";
    }
    jobs[1].target_exposure.ev = 3;
    CopyLosses losses, own;
    losses.add(jobs[0], 0.02), losses.add(jobs[1], 0.09), losses.add(jobs[2], 0.005);
    own.add(jobs[0], 0.02);
    const std::vector<std::string> lines = losses.warnings();
    assert_int_equal(lines.size(), 2);
    assert_string_equal(lines[0].c_str(),
                        "1.jpg: lifted by 3.0 EV, which shows the noise; use `lensprof apply --pto 'the "
                        "folder/panorama_a.pto' --set exposure=keep -o FOLDER`, or pictures of 16 bits");
    assert_string_equal(lines[1].c_str(),
                        "1.jpg and 1 more: the correction clips up to 9.0 % more of the pixels; use `lensprof apply "
                        "--pto 'the folder/panorama_a.pto' --linear -o FOLDER`, which clips none");
    assert_int_equal(own.warnings().size(), 1);
    assert_true(contains(own.warnings()[0], "clips 2.0 % more of the pixels; use `lensprof apply --linear`, which"));
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_same_bytes_by_any_threads_and_strips),
        CLI_TEST(test_reader_and_writer),
        CLI_TEST(test_sheet_by_any_threads),
        CLI_TEST(test_bad_picture_among_good_ones),
        CLI_TEST(test_full_disk_among_pictures),
        CLI_TEST(test_speed_is_said),
        CLI_TEST(test_bad_thread_counts),
        CLI_TEST(test_time_left),
        CLI_TEST(test_losses_name_a_command),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
