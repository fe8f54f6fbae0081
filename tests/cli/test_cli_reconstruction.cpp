// `build` of reconstructions, and `apply --model`: exposures and falloff compared with the truth of a simulated moving
// camera, and the files written for other programs.
#include <deque>

#include "photo/scene/block_sampling.hpp"
#include "photo/scene/reconstruction_scene.hpp"

#include "moving_scenes.hpp"

using namespace moving_scenes;

namespace {

constexpr uint32_t images = 12;

int make_folders(void **state) {
    if (make_folder(state) != 0) return -1;
    setenv("XDG_DATA_HOME", in_folder("work/data").c_str(), 1);
    setenv("XDG_DATA_DIRS", in_folder("work/share").c_str(), 1);
    return 0;
}

Words build(const std::string &project, const Words &more = {}) {
    return Words{"build", work(project), "--images", work("pictures"), "--no-store", "--json"} + more;
}

// The largest error of exposures after aligning their common offset and the exponent, EV.
double exposure_error(const Json &result, const Json &truth) {
    std::vector<double> found, real;
    double means[2] = {};
    for (size_t i = 0; i < images; i++) {
        if (result["images"][i]["ev"].is_null()) fail_msg("image %zu was left out", i);
        found.push_back(result["images"][i]["ev"].get<double>());
        real.push_back(truth["images"][i]["ev"].get<double>());
        means[0] += found[i] / images, means[1] += real[i] / images;
    }
    double across = 0, along = 0;
    for (size_t i = 0; i < images; i++) {
        found[i] -= means[0], real[i] -= means[1];
        across += found[i] * real[i], along += found[i] * found[i];
    }
    double largest = 0;
    for (size_t i = 0; i < images; i++) largest = std::max(largest, std::fabs(found[i] * across / along - real[i]));
    return largest;
}

struct Work {
    Work() : scene("pictures", MovingKind::room, images) {
        scene.write_colmap("model");
        scene.write_opensfm(work("tracks.csv"));
    }
    MovingScene scene;
};

const Work &shared() {
    static const Work work;
    return work;
}

// Before any test: a slice of them needs the scene, too.
int make_work(void **state) {
    if (make_folders(state) != 0) return -1;
    shared();
    return 0;
}

void test_exposures_are_found(void **) {
    const Json &truth = shared().scene.truth;
    for (const char *project : {"model", "tracks.csv"}) {
        const Json result = json_of(build(project));
        const double error = exposure_error(result, truth);
        if (error > 0.03) fail_msg("%s: exposures are %.3f EV off", project, error);
        const Json &variance = result["colour_variance"];
        assert_true(variance["pairs"].get<int>() > 1000);
        assert_true(variance["result"].get<double>() < 0.7 * variance["exposures_only"].get<double>());
        assert_true(variance["exposures_only"].get<double>() < variance["before"].get<double>());
        assert_string_equal(result["gamma"]["camera_kind_from"].get<std::string>().c_str(), "reconstruction");
    }
}

// Colours of the tracks instead of pictures: on request, and if there are no pictures.
void test_colours_stand_for_pictures(void **) {
    const Json &truth = shared().scene.truth;
    const Json asked = json_of(build("tracks.csv", {"--reconstruction", "track-colors=yes"}));
    assert_true(exposure_error(asked, truth) < 0.06);
    fs::create_directory(work("elsewhere"));
    fs::copy_file(work("tracks.csv"), work("elsewhere/tracks.csv"));
    const Words alone = {"build", work("elsewhere/tracks.csv"), "--no-store", "--json"};
    assert_refused(unreadable, alone, {"tracks.csv", "--images", "reconstruction.json"});
    Json shots = Json::object();
    for (size_t i = 0; i < images; i++) shots[shared().scene.file(i)] = {{"camera", "one"}};
    save_text(work("elsewhere/reconstruction.json"),
              Json::array({{{"cameras", {{"one", {{"width", 400}, {"height", 300}}}}}, {"shots", shots}}}).dump());
    assert_true(exposure_error(json_of(alone), truth) < 0.06);
    fs::remove_all(work("elsewhere"));
    assert_refused(usage, build("model", {"--reconstruction", "track-colors=yes"}),
                   {"--reconstruction track-colors", "tracks.csv", "COLMAP model"});
}

// Repeated runs give the same bytes.
void test_is_deterministic(void **) {
    const std::string first = must_exit(done, build("model", {"--write", "exposures=" + work("a.json")}));
    must_exit(done, build("model", {"--write", "exposures=" + work("b.json")}));
    assert_true(load(work("a.json")) == load(work("b.json")));
    for (const char *name : {"a.json", "b.json"}) fs::remove(work(name));
}

// Pictures in blocks of two, and all in one block: the same links, and about as many pairs.
void test_blocks(void **) {
    Events progress;
    const Scene project = scene_of_reconstruction(work("model"), {work("pictures"), false, {}, {}, 0, 1}, progress);
    lensprof_sample_options options;
    lensprof_sample_options_init(&options);
    std::vector<lensprof_pair> pairs[2];
    std::vector<lensprof_link> links[2];
    std::vector<uint32_t> points[2];
    for (const size_t n : {0u, 1u}) {
        uint32_t channels = 0;
        const uint64_t block_bytes = n ? 2 * 3 * 400 * 300 : default_block_bytes;
        pairs[n] = sample_in_blocks(project, options, 800, block_bytes, progress, links[n], points[n], &channels);
        assert_int_equal(channels, 3);
        assert_int_equal(points[n].size(), pairs[n].size());
    }
    assert_int_equal(links[0].size(), links[1].size());
    for (size_t l = 0; l < links[0].size(); l++)
        for (int side = 0; side < 2; side++) assert_int_equal(links[0][l].image[side], links[1][l].image[side]);
    assert_true(pairs[1].size() > 0.95 * double(pairs[0].size()) && pairs[1].size() < 1.05 * double(pairs[0].size()));
}

// The colours of the points in half of the images, changed as by another light: each point by its own factor.
void test_two_visits(void **) {
    std::istringstream lines(text_of(work("tracks.csv")));
    std::ostringstream changed;
    for (std::string line; std::getline(lines, line);) {
        std::vector<std::string> fields;
        std::istringstream words(line);
        for (std::string word; std::getline(words, word, '\t');) fields.push_back(word);
        const bool is_second = fields.size() > 8 && fields[0] >= shared().scene.file(images / 2);
        for (size_t c = 6; is_second && c < 9; c++) {
            const double light = 0.35 + 1.6 * double(std::stoul(fields[1]) * 2654435761u % 1024) / 1024.0;
            fields[c] =
                std::to_string(std::min(255, int(std::lround(std::stoi(fields[c]) * std::pow(light, 1 / 2.2)))));
        }
        for (size_t n = 0; n < fields.size(); n++) changed << (n ? "\t" : "") << fields[n];
        changed << "\n";
    }
    save_text(work("visits.csv"), changed.str());
    const Words both = {"build",      work("visits.csv"), "--images",        work("pictures"),
                        "--no-store", "--reconstruction", "track-colors=yes"};
    const Words outputs = {"--write", "exposures=" + work("exposures.json"), "--write",
                           "gain-chart=" + work("gain.svg")};
    fs::remove(work("exposures.json"));
    assert_refused(not_usable, both + outputs, {"visits.csv", "in different light", "--reconstruction list"});
    std::string first;
    for (size_t i = 0; i < images / 2; i++) first += shared().scene.file(i) + "\n";
    save_text(work("first.txt"), first);
    const Json one = json_of(both + Words{"--reconstruction", "list=" + work("first.txt"), "--json"});
    assert_int_equal(one["images"].size(), images / 2);
    save_text(work("first.txt"), first + "nobody.png\n");
    assert_refused(unreadable, both + Words{"--reconstruction", "list=" + work("first.txt")},
                   {"first.txt", "nobody.png"});
    for (const char *name : {"first.txt", "visits.csv"}) fs::remove(work(name));
}

// Matches that do not show the same: the observations of each picture belong to later tracks, with another offset per
// picture.
void test_wrong_matches(void **) {
    std::istringstream lines(text_of(work("tracks.csv")));
    std::map<std::string, std::deque<std::string>> later;  // previous tracks in each image
    std::ostringstream changed;
    for (std::string line; std::getline(lines, line);) {
        const size_t name = line.find('\t'), track = line.find('\t', name + 1);
        if (track == std::string::npos) {
            changed << line << "\n";
            continue;
        }
        auto &own = later[line.substr(0, name)];
        own.push_back(line.substr(name + 1, track - name - 1));
        if (own.size() < 50 + 37 * later.size()) continue;
        changed << line.substr(0, name + 1) << own.front() << line.substr(track) << "\n";
        own.pop_front();
    }
    save_text(work("wrong.csv"), changed.str());
    for (const Words &more : {Words{}, Words{"--reconstruction", "track-colors=yes"}})
        assert_refused(not_usable,
                       Words{"build", work("wrong.csv"), "--images", work("pictures"), "--no-store", "--write",
                             "exposures=" + work("no.json")}
                           + more,
                       {"wrong.csv"});
    fs::remove(work("wrong.csv"));
}

// Fitted once: repeated runs give the same bytes.
void write_exposures() {
    static std::string exposures;
    if (exposures.empty()) {
        must_exit(done, build("model", {"--write", "exposures=" + work("exposures.json")}));
        exposures = text_of(work("exposures.json"));
    }
    save_text(work("exposures.json"), exposures);
}

// Shards for several machines: every picture exactly once, with the same outputs as without shards.
void test_shards(void **) {
    write_exposures();
    const Words apply = {"apply", "--model", work("exposures.json"), "-o"};
    must_exit(done, apply + Words{work("whole")});
    for (const char *part : {"1/5", "2/5", "3/5", "4/5", "5/5"})
        must_exit(done, apply + Words{work("parts"), "--shard", part});
    for (size_t i = 0; i < images; i++) {
        const std::string name = "/" + shared().scene.file(i);
        assert_true(load(work("whole" + name)) == load(work("parts" + name)));
    }
    for (const char *name : {"whole", "parts"}) fs::remove_all(work(name));
    for (const char *part : {"0/5", "6/5", "5", "1/0", "a/b", "1/2/3"})
        assert_refused(usage, apply + Words{work("parts"), "--shard", part}, {"--shard", part});
    assert_refused(usage, apply + Words{work("parts"), "--shard", "1/20"}, {"--shard 1/20", "12 pictures"});
    const Words own = {"--camera", "Example", "--lens", "Example"};
    std::vector<std::string> files;
    for (const char *part : {"1/2", "2/2"}) {
        const Words words = {"build",          work("model"),      "--images",
                             work("pictures"), "--reconstruction", std::string("shard=") + part,
                             "--json"};
        const Json result = json_of(words + own + Words{"--db", work(std::string(part, 1) + ".db"), "--force"});
        for (const Json &image : result["images"]) files.push_back(image["file"].get<std::string>());
    }
    std::sort(files.begin(), files.end());
    assert_int_equal(files.size(), images);
    assert_true(std::unique(files.begin(), files.end()) == files.end());
    must_exit(done, {"profile", "merge", work("1.db"), work("2.db"), "--db", work("all.db")});
    assert_refused(usage, build("model", {"--reconstruction", "shard=1/9"}),
                   {"--reconstruction shard=1/9", "fewer than two"});
}

void test_chart_of_gains(void **) {
    for (const char *name : {"gain.svg", "gain.png"}) {
        must_exit(done, build("model", {"--write", "gain-chart=" + work(name)}));
        assert_true(load(work(name)).size() > 2000);
        fs::remove(work(name));
    }
    assert_refused(usage, build("model", {"--write", "gain-chart=" + work("gain.txt")}), {"gain.txt", ".svg or .png"});
}

// The file has what other programs need, under the names of the images.
void test_file_of_exposures(void **) {
    write_exposures();
    const std::string first = text_of(work("exposures.json"));
    must_exit(done, build("model", {"--write", "exposures=" + work("exposures.json")}));  // replaces its own file
    assert_string_equal(text_of(work("exposures.json")).c_str(), first.c_str());
    const Json all = parsed(first);
    assert_int_equal(all["schema"].get<int>(), 1);
    assert_int_equal(all["images"].size(), images);
    double mean = 0;
    for (size_t i = 0; i < images; i++) {
        const Json &image = all["images"][i];
        assert_string_equal(image["name"].get<std::string>().c_str(), shared().scene.file(i).c_str());
        assert_string_equal(image["file"].get<std::string>().c_str(), ("pictures/" + shared().scene.file(i)).c_str());
        assert_int_equal(image["width"].get<int>(), 400);
        mean += image["ev"].get<double>() / images;
        assert_true(i == 0 || image["ev_sigma"].get<double>() > 0);
    }
    assert_true(std::fabs(mean - all["mean"]["ev"].get<double>()) < 1e-9);
    const Json &camera = all["cameras"][all["lenses"][0]["camera"].get<size_t>()], &light = camera["light_of_level"];
    assert_int_equal(light.size(), 256);
    assert_true(light[0].get<double>() == 0.0 && light[255].get<double>() == 1.0);
    for (size_t level = 1; level < 256; level++)
        assert_true(light[level].get<double>() >= light[level - 1].get<double>());
}

// Mean absolute difference of grey values at places that two pictures show.
double mean_difference(const std::string &folder) {
    const MovingScene &scene = shared().scene;
    std::vector<Picture> pictures;
    for (size_t i = 0; i < images; i++) pictures.push_back(read_picture(work(folder + "/" + scene.file(i))));
    double sum = 0, count = 0;
    for (const Track &track : scene.tracks)
        for (size_t n = 1; n < track.sights.size(); n++) {
            double value[2];
            for (size_t side = 0; side < 2; side++) {
                const Sight &sight = track.sights[n - 1 + side];
                const Picture &picture = pictures[sight.image];
                value[side] = picture.pixels[size_t(std::lround(sight.xy[1])) * picture.row_bytes
                                             + 3 * size_t(std::lround(sight.xy[0])) + 1];
            }
            sum += std::fabs(value[0] - value[1]), count++;
        }
    return sum / count;
}

// Corrected copies have the names, sizes and formats of the pictures, so that they fit the model.
void test_corrected_copies(void **) {
    write_exposures();
    const Disk before = disk();
    must_exit(done, {"apply", "--model", work("exposures.json"), "-o", work("corrected")});
    for (size_t i = 0; i < images; i++) {
        const std::string name = "/" + shared().scene.file(i);
        const Picture own = read_header(work("pictures" + name), {}), copy = read_header(work("corrected" + name), {});
        assert_true(own.width == copy.width && own.height == copy.height && own.layout == copy.layout);
    }
    assert_true(mean_difference("corrected") < 0.6 * mean_difference("pictures"));
    fs::remove_all(work("corrected"));
    const std::string changes = difference(before, disk());  // in particular the originals
    if (!changes.empty()) fail_msg("on the disk:%s", changes.c_str());
}

// Folders in image names are kept; --images gives the new place of the pictures.
void test_folders_of_names(void **) {
    write_exposures();
    const std::string first = shared().scene.file(0);
    fs::create_directories(work("moved/left"));
    for (size_t i = 0; i < images; i++)
        fs::copy_file(work("pictures/" + shared().scene.file(i)),
                      work((i ? "moved/" : "moved/left/") + shared().scene.file(i)));
    edit(work("exposures.json"), "\"name\": \"" + first + "\"", "\"name\": \"left/" + first + "\"");
    edit(work("exposures.json"), "\"reference\": \"" + first + "\"", "\"reference\": \"left/" + first + "\"");
    must_exit(done, {"apply", "--model", work("exposures.json"), "--images", work("moved"), "-o", work("corrected")});
    assert_true(fs::exists(work("corrected/left/" + first)));
    assert_true(fs::exists(work("corrected/" + shared().scene.file(1))));
    for (const char *name : {"corrected", "moved"}) fs::remove_all(work(name));
}

// EXIF of the copies has the measured exposures, marked as such in XMP.
void test_seeded_exif(void **) {
    write_exposures();
    must_exit(done, {"apply", "--model", work("exposures.json"), "--encoding", "exif-exposure=yes", "--set",
                     "exposure=keep", "-o", work("seeded")});
    const Json all = parsed(text_of(work("exposures.json")));
    double offset = 0;
    for (size_t i = 0; i < images; i++) {
        const PictureMetadata metadata = read_metadata(work("seeded/" + shared().scene.file(i)));
        assert_true(metadata.exif_ev.has_value() && metadata.mark && metadata.mark->is_exposure_measured);
        const double own = *metadata.exif_ev - all["images"][i]["ev"].get<double>();
        if (i == 0) offset = own;
        assert_true(std::fabs(own - offset) < 0.01);
    }
    fs::remove_all(work("seeded"));
}

void test_bad_files_of_exposures(void **) {
    write_exposures();
    const std::string good = text_of(work("exposures.json"));
    const Words apply = {"apply", "--model", work("exposures.json"), "-o", work("out")};
    const std::pair<const char *, const char *> changes[] = {
        {"\"schema\": 1", "\"schema\": 7"},        {"\"lens\": 0", "\"lens\": 5"},
        {"\"camera\": 0", "\"camera\": -1"},       {"\"width\": 400", "\"width\": 0"},
        {"\"width\": 400", "\"width\": \"x\""},    {"\"light_of_level\"", "\"light_of_leve\""},  // not read
        {"\"kind\": \"emor\"", "\"kind\": \"x\""}, {"lensprof exposures", "other"}};
    for (const auto &[part, by] : changes) {
        edit(work("exposures.json"), part, by);
        if (std::string(by) == "\"light_of_leve\"") {
            must_exit(done, apply);
            fs::remove_all(work("out"));
        } else {
            assert_refused(unreadable, apply, {"exposures.json", "--write exposures"});
        }
        fs::remove(work("exposures.json"));
        save_text(work("exposures.json"), good);
    }
    for (size_t bytes = 0; bytes + 1 < good.size(); bytes += good.size() / 23) {
        fs::remove(work("exposures.json"));
        save_text(work("exposures.json"), good.substr(0, bytes));
        assert_refused(unreadable, apply, {"exposures.json"});
    }
}

// Options that exclude each other are refused by name.
void test_options(void **) {
    write_exposures();
    const std::string file = work("exposures.json");
    assert_refused(usage, {"apply", "--model", file, "--pto", file, "-o", work("out")}, {"--pto", "--model"});
    assert_refused(usage,
                   {"apply", "--profile", "1", "--encoding", "exif-exposure=yes", work("pictures"), "-o", work("out")},
                   {"--encoding exif-exposure", "--model"});
    assert_refused(usage, {"apply", "--model", file, "--merge", "--linear", "-o", work("out")}, {"--merge", "--pto"});
    save_text(work("notes.txt"), "mine");
    assert_refused(usage, build("model", {"--write", "exposures=" + work("notes.txt")}),
                   {"notes.txt",
                    "exists and is not a "
                    "file of exposures"});
    for (const char *key : {"preview", "project"})
        assert_refused(usage, build("model", {"--write", key + ("=" + work("x.png"))}),
                       {std::string("--write ") + key, "reconstruction"});
    assert_refused(usage, build("model", {"--points", work("x.png")}), {"--points", "reconstruction"});
    assert_refused(usage, {"build", work("pictures"), "--images", work("pictures"), "--no-store"},
                   {"--images", "reconstruction"});
}

// A picture resized after matching.
void test_resized_picture(void **) {
    write_exposures();
    const std::string picture = work("pictures/" + shared().scene.file(3));
    const Bytes own = load(picture);
    fs::remove(picture);
    write_picture(picture, make_smooth(200, 150, LENSPROF_LAYOUT_RGB));
    assert_refused(unreadable, build("model"), {shared().scene.file(3), "200 x 150", "400 x 300"});
    const Outcome applied = run_words({"apply", "--model", work("exposures.json"), "-o", work("resized")});
    assert_int_equal(applied.code, unreadable);
    for (const std::string &name : {shared().scene.file(3), std::string("200 x 150"), std::string("400 x 300")})
        assert_true(contains(applied.err, name));
    assert_true(fs::exists(work("resized/" + shared().scene.file(2))));  // the others are corrected
    assert_false(fs::exists(work("resized/" + shared().scene.file(3))));
    fs::remove(picture);
    save(picture, own);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_exposures_are_found),
        cmocka_unit_test(test_colours_stand_for_pictures),
        cmocka_unit_test(test_is_deterministic),
        cmocka_unit_test(test_blocks),
        cmocka_unit_test(test_shards),
        cmocka_unit_test(test_two_visits),
        cmocka_unit_test(test_wrong_matches),
        cmocka_unit_test(test_chart_of_gains),
        cmocka_unit_test(test_file_of_exposures),
        cmocka_unit_test(test_corrected_copies),
        cmocka_unit_test(test_folders_of_names),
        cmocka_unit_test(test_seeded_exif),
        cmocka_unit_test(test_bad_files_of_exposures),
        cmocka_unit_test(test_options),
        cmocka_unit_test(test_resized_picture),
    };
    return cmocka_run_group_tests(tests, make_work, remove_folder);
}
