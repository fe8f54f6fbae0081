// Pictures of several cameras: a response, a falloff and a profile for each, joined by common parameters.
#include "cli_runs.hpp"
#include "photo/pictures/metadata.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/registration/registration.hpp"

namespace {

using namespace cli_runs;

constexpr size_t kImages = 12;
const std::vector<double> kFalloff{-0.45, 0.12, -0.10}, kOtherFalloff{-0.15, 0.03, -0.05};
const Words quietly{"--no-store", "--fit", "stored=none", "--json"};

std::string numbered(size_t i) { return (i < 10 ? "img00" : "img0") + std::to_string(i) + ".png"; }

void state_camera(const std::string &file, const char *maker, const char *model) {
    PictureMetadata metadata = read_metadata(file);
    std::snprintf(metadata.key.camera_maker, sizeof metadata.key.camera_maker, "%s", maker);
    std::snprintf(metadata.key.camera_model, sizeof metadata.key.camera_model, "%s", model);
    assert_true(write_metadata(file, metadata));
}

std::string two_cameras() { return in_folder("pair"); }

// Pictures of one scene, alternating between two cameras with different response and falloff.
int make_pictures(void **state) {
    if (make_folder(state) != 0) return -1;
    const Words same{"--images", std::to_string(kImages), "--seed", "12",      "--size", "400x300",    "--exif",
                     "--set",    "overlap=0.72",          "--set",  "noise=1", "--set",  "mean-ev=-1", "--set",
                     "jitter=1"};
    must_exit(
        done,
        Words{"simulate", "-o", two_cameras(), "--response", "emor:1.2,-0.3", "--vignetting=-0.45,0.12,-0.1"} + same);
    must_exit(done, Words{"simulate", "-o", in_folder("other"), "--response", "film", "--vignetting=-0.15,0.03,-0.05"}
                        + same);
    for (size_t i = 1; i < kImages; i += 2) {
        fs::copy_file(in_folder("other/" + numbered(i)), two_cameras() + "/" + numbered(i),
                      fs::copy_options::overwrite_existing);
        state_camera(two_cameras() + "/" + numbered(i), "Other", "Other X100");
    }
    return 0;
}

std::string project() { return two_cameras() + "/pano.pto"; }

// A folder with only the pictures.
std::string pictures(const std::string &name) {
    fs::remove_all(work(name));
    fs::create_directory(work(name));
    for (size_t i = 0; i < kImages; i++)
        fs::copy_file(two_cameras() + "/" + numbered(i), work(name + "/" + numbered(i)));
    return work(name);
}

// EXIF of both determines gamma, so that falloffs can be compared with the true ones.
void assert_both_found(const Json &json, double tolerance) {
    assert_true(json["usable"] == true && json["equalizes"] == true);
    assert_int_equal(json["cameras"].size(), 2);
    assert_int_equal(json["settings"].size(), 2);
    for (size_t n = 0; n < 2; n++) {
        const Json &camera = json["cameras"][n], &setting = json["settings"][n];
        assert_int_equal(camera["images"], kImages / 2);
        assert_true(camera["joined"] == true && camera["reference"] == (n == 0));
        assert_true(camera["shared_pairs"].get<int>() > 500);
        assert_true(camera["irradiance_difference_ev"].get<double>() < 0.03);
        assert_int_equal(setting["camera"], n);
        assert_string_equal(setting["key"]["camera_model"].get<std::string>().c_str(),
                            n ? "Other X100" : "Simulated Camera");
        const double error = falloff_error(setting["vignetting"]["k"][0], n ? kOtherFalloff : kFalloff);
        print_message("%s: falloff within %.4f\n", setting["label"].get<std::string>().c_str(), error);
        assert_true(error < tolerance);
    }
    for (size_t i = 0; i < kImages; i++) {
        assert_int_equal(json["images"][i]["camera"], i % 2);
        assert_true(json["images"][i]["joined"] == true);
    }
    assert_true(json["cameras"][0]["response"]["values"] == json["response"]["values"]);
}

void test_project(void **) {
    assert_both_found(json_of(Words{"build", project()} + quietly), 0.02);
    assert_both_found(json_of(Words{"build", project(), "--fit", "method=radiance"} + quietly), 0.02);
    const std::string text = must_exit(done, {"build", project(), "--no-store"});
    assert_true(contains(text, "camera    Other X100, 6 pictures; the light of "));
    assert_true(contains(text, "setting   Other X100, "));
    assert_int_equal(
        json_of(Words{"build", project(), "--fit", "method=transfer-function"} + quietly)["cameras"].size(), 2);
}

void test_one_lens_takes_all_as_one(void **) {
    const Json each = json_of(Words{"build", project()} + quietly);
    const Outcome one = run_words(Words{"build", project(), "--one-lens"} + quietly);
    const Json json = parsed(one.out);
    assert_true(json["cameras"].empty() && !json["images"][0].contains("camera"));
    assert_true(json["residual"]["heldout_median"].get<double>()
                > 2.0 * each["residual"]["heldout_median"].get<double>());
    // Linear pictures have one response, and a falloff per setting of each camera.
    const Json linear = parsed(run_words(Words{"build", project(), "--fit", "camera-kind=linear"} + quietly).out);
    assert_true(linear["cameras"].empty());
    assert_int_equal(linear["settings"].size(), 2);
    // Values on the command line hold for all pictures.
    assert_true(parsed(run_words(Words{"build", project(), "--camera", "One"} + quietly).out)["cameras"].empty());
    // Also if the project does not link them.
    std::string text = text_of(project());
    for (size_t at = text.find("Ra=0"); at != std::string::npos; at = text.find("Ra=0", at)) text.replace(at, 4, "Ra0");
    const std::string unlinked = two_cameras() + "/unlinked.pto";
    save_text(unlinked, text);
    assert_true(parsed(run_words(Words{"build", unlinked, "--camera", "One"} + quietly).out)["cameras"].empty());
    assert_int_equal(parsed(run_words(Words{"build", unlinked} + quietly).out)["cameras"].size(), 2);
}

// Without a project: the overlaps join both cameras, and the written project assigns each picture to its camera.
void test_folder(void **) {
    if (!can_register()) return skip();  // built without OpenCV, which finds overlaps
    const std::string folder = pictures("folder"), found = work("found.pto");
    const Outcome outcome = run_words(Words{"build", folder, "--write", std::string("project=") + found} + quietly);
    assert_int_equal(outcome.code, done);
    assert_true(contains(outcome.err, "from 2 cameras, sizes or processings"));
    const Json json = parsed(outcome.out);
    assert_both_found(json, 0.02);
    assert_true(json["left_out"].empty());
    // The project keeps the cameras apart even without EXIF.
    for (size_t i = 0; i < kImages; i++) state_camera(folder + "/" + numbered(i), "", "");
    assert_int_equal(json_of(Words{"build", found} + quietly)["cameras"].size(), 2);
}

void test_profiles(void **) {
    const std::string db = work("p.db");
    const Json json = json_of({"build", project(), "--db", db, "--json"});
    for (size_t n = 0; n < 2; n++) {
        const Json stored = json_of({"profile", "show", std::to_string(n + 1), "--db", db, "--json"});
        assert_string_equal(stored["key"]["camera_model"].get<std::string>().c_str(),
                            n ? "Other X100" : "Simulated Camera");
        assert_true(stored["vignetting"]["k"][0] == json["settings"][n]["vignetting"]["k"][0]);
        assert_true(stored["response"]["values"] == json["cameras"][n]["response"]["values"]);
        assert_int_equal(stored["provenance"]["images"], kImages / 2);
    }
}

double seams(const std::string &folder) {
    Words words{"build", project(),     "--write",   "points=" + work("seams.txt"), "--json", "--no-store",
                "--fit", "stored=none", "--one-lens"};
    fs::remove(work("seams.txt"));
    const std::string copy = work("seams");
    fs::remove_all(copy);
    fs::create_directory(copy);
    fs::copy_file(project(), copy + "/pano.pto");
    for (size_t i = 0; i < kImages; i++) fs::copy_file(folder + "/" + numbered(i), copy + "/" + numbered(i));
    words[1] = copy + "/pano.pto";
    return parsed(run_words(words).out)["residual"]["before_rms"].get<double>();
}

// One response encodes all pictures, and the seams disappear; if pictures keep their exposure, each uses its own.
void test_apply(void **) {
    const std::string result = two_cameras() + "/result.pto", out = work("even"), kept = work("kept");
    must_exit(done, Words{"build", project(), "--write", std::string("pto=") + result} + quietly);
    const std::string text = text_of(result);
    for (const char *part : {" Ra=0 Rb=0 Rc=0", " Ra=1 Rb=1 Rc=1"}) {
        size_t count = 0;
        for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) count++;
        assert_int_equal(count, kImages / 2 - 1);
    }
    const Outcome outcome = run_words({"apply", "--pto", result, "-o", out});
    assert_int_equal(outcome.code, done);
    assert_true(contains(outcome.err, "has several cameras"));
    const double before = seams(two_cameras()), after = seams(out);
    print_message("before %.2f, after %.2f levels\n", before, after);
    assert_true(after < 0.15 * before);
    assert_false(contains(run_words({"apply", "--pto", result, "--set", "exposure=keep", "-o", kept}).err, "several"));
    assert_true(seams(kept) > 2.0 * after);
    // The same with profiles from a database, which has both.
    const std::string db = work("both.db"), by_db = work("by_db");
    must_exit(done, {"build", project(), "--db", db});
    must_exit(done, {"apply", "--pto", result, "--profile", "auto", "--db", db, "-o", by_db});
    assert_true(seams(by_db) < 0.15 * before);
    // A preview shows both, too.
    must_exit(done, Words{"build", project(), "--write", "preview=" + work("preview.png")} + quietly);
    assert_true(fs::exists(work("preview.png")));
}

// The whole job: a profile for each, and pictures that match.
void test_calibrate(void **) {
    if (!can_register()) return skip();  // built without OpenCV, which finds overlaps
    const std::string folder = pictures("job"), out = work("job_out"), db = work("job.db");
    const std::string text = must_exit(done, {"calibrate", folder, "-o", out, "--db", db});
    assert_true(contains(text, "profiles 1, 2 stored"));
    const double after = seams(out);
    assert_true(after < 0.15 * seams(two_cameras()));
    const Json json = parsed(text_of(out + "/calibrate.json"));
    assert_int_equal(json["panoramas"].size(), 1);
    assert_int_equal(json["panoramas"][0]["result"]["cameras"].size(), 2);
    assert_true(contains(must_exit(done, {"calibrate", folder, "-o", out, "--db", db}), "all in earlier runs"));
}

// The light is the same, whichever camera saw it.
void test_light(void **) {
    const std::string result = two_cameras() + "/result.pto";
    must_exit(done, Words{"build", project(), "--write", std::string("pto=") + result} + quietly);
    const Json json = json_of({"apply", "--pto", result, "--linear", "--merge", "-o", work("light"), "--json"});
    for (const Json &picture : json["pictures"]) assert_true(picture["agreement"].get<double>() > 0.85);
}

// A single picture of a third camera is left out with a reason; the others are unaffected.
void test_single_picture(void **) {
    const std::string folder = pictures("third");
    fs::copy_file(project(), folder + "/pano.pto");
    state_camera(folder + "/" + numbered(5), "Third", "Third 1");
    const Outcome outcome = run_words(Words{"build", folder + "/pano.pto"} + quietly);
    assert_int_equal(outcome.code, done);
    assert_true(contains(outcome.err, "Third 1: left out"));
    const Json json = parsed(outcome.out);
    assert_int_equal(json["cameras"].size(), 3);
    assert_true(json["images"][5]["joined"] == false && json["images"][5]["ev"].is_null());
    assert_true(json["cameras"][2]["response"].is_null());
    if (can_register()) {
        fs::remove(folder + "/pano.pto");
        const Json found = json_of(Words{"build", folder} + quietly);
        assert_int_equal(found["cameras"].size(), 2);
        assert_int_equal(found["left_out"].size(), 1);
        assert_true(contains(found["left_out"][0]["reason"].get<std::string>(),
                             "no two pictures of its camera, size "
                             "or processing overlap"));
    }
}

// A camera without a name is not stored; the others are.
void test_camera_without_a_name(void **) {
    const std::string folder = pictures("unnamed"), db = work("unnamed.db");
    std::string text = text_of(project());  // a separate response for every second image, since EXIF is missing
    const std::string linked = "Ra=0 Rb=0 Rc=0 Rd=0 Re=0", own = "Ra0 Rb0 Rc0 Rd0 Re0",
                      other = "Ra=1 Rb=1 Rc=1 Rd=1 Re=1";
    for (size_t at = text.find(linked), n = 0; at != std::string::npos; at = text.find(linked, at + 1), n++)
        if (n % 2 == 0) text.replace(at, linked.size(), n == 0 ? own : other);
    save_text(folder + "/pano.pto", text);
    for (size_t i = 1; i < kImages; i += 2) {
        const Picture picture = read_picture(folder + "/" + numbered(i));
        fs::remove(folder + "/" + numbered(i));
        write_picture(folder + "/" + numbered(i), picture);  // without metadata
    }
    const Outcome outcome = run_words({"build", folder + "/pano.pto", "--db", db, "--json"});
    assert_int_equal(outcome.code, done);
    assert_true(contains(outcome.err, "not stored: "));
    const Json json = parsed(outcome.out);
    assert_int_equal(json["cameras"].size(), 2);
    assert_int_equal(json["settings"][0]["profile"], 1);
    assert_true(json["settings"][1]["profile"].is_null());
}

// The cameras' pictures have nothing in common: the result is that of the reference's camera.
void test_cameras_that_share_nothing(void **) {
    const std::string folder = pictures("apart"), db = work("apart.db");
    fs::copy_file(project(), folder + "/pano.pto");
    // Instead of many masks, the other camera's pictures are flipped, so that they show something else.
    for (size_t i = 1; i < kImages; i += 2) {
        Picture picture = read_picture(folder + "/" + numbered(i));
        Picture rotated = picture;
        for (uint32_t y = 0; y < picture.height; y++)
            std::copy_n(picture.pixels.data() + (picture.height - 1 - y) * picture.row_bytes, picture.row_bytes,
                        rotated.pixels.data() + y * picture.row_bytes);
        write_picture(folder + "/" + numbered(i), rotated);
        state_camera(folder + "/" + numbered(i), "Other", "Other X100");
    }
    const Outcome outcome = run_words({"build", folder + "/pano.pto", "--db", db, "--json"});
    const Json json = parsed(outcome.out);
    assert_true(json["cameras"][1]["joined"] == false);
    assert_true(contains(outcome.err, "Other X100: left out"));
    for (size_t i = 1; i < kImages; i += 2) assert_true(json["images"][i]["ev"].is_null());
}

void test_what_is_refused(void **) {
    const std::string folder = pictures("refused"), pto = folder + "/pano.pto", result = two_cameras() + "/result.pto";
    must_exit(done, Words{"build", project(), "--write", std::string("pto=") + result} + quietly);
    assert_refused(usage, {"build", result, "--fit", "gamma-from=known", "--no-store"},
                   {"2 cameras", "is fixed while others are estimated"});
    fs::copy_file(project(), pto);
    for (size_t i = 0; i < kImages; i++)
        state_camera(folder + "/" + numbered(i), "Each", ("Own " + std::to_string(i)).c_str());
    assert_refused(usage, {"build", pto, "--no-store"}, {"12 cameras", "one image each", "--one-lens"});
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        CLI_TEST(test_project),
        CLI_TEST(test_one_lens_takes_all_as_one),
        CLI_TEST(test_folder),
        CLI_TEST(test_profiles),
        CLI_TEST(test_apply),
        CLI_TEST(test_calibrate),
        CLI_TEST(test_light),
        CLI_TEST(test_single_picture),
        CLI_TEST(test_camera_without_a_name),
        CLI_TEST(test_cameras_that_share_nothing),
        CLI_TEST(test_what_is_refused),
    };
    return cmocka_run_group_tests(tests, make_pictures, remove_folder);
}
