// Which profile `lensprof apply` uses for a picture: according to EXIF and options that replace it, or by id; and what
// it refuses.
#include <sstream>

#include <exiv2/exiv2.hpp>  // before cmocka, which makes a macro of `fail`

#include "cli_runs.hpp"

#include <lensprof/store.h>

using namespace cli_runs;

namespace {

constexpr uint32_t width = 64, height = 48;
constexpr uint8_t grey = 60;

// A uniform grey picture, with EXIF of camera and lens if given.
std::string make_picture(const std::string &name, const char *camera = "", const char *lens = "",
                         uint32_t sample = LENSPROF_SAMPLE_U8) {
    Picture picture = make_noise(width, height, sample, LENSPROF_LAYOUT_RGB);
    if (sample == LENSPROF_SAMPLE_U8)
        std::fill(picture.pixels.begin(), picture.pixels.end(), grey);
    else
        std::fill_n(reinterpret_cast<float *>(picture.pixels.data()), width * height * 3, float(grey) / 255.0f);
    PictureMetadata metadata = unknown_metadata();
    std::strcpy(metadata.key.camera_model, camera);
    std::strcpy(metadata.key.lens, lens);
    metadata.key.focal_mm = 50;
    metadata.key.aperture = 2;
    WriteOptions options;
    options.metadata = &metadata;
    fs::create_directories(fs::path(work(name)).parent_path());
    write_picture(work(name), picture, options);
    return work(name);
}

// According to the camera's maker notes; the switch is Panasonic's.
std::string make_corrected(const std::string &name) {
    const std::string file = make_picture(name, "Camera", "Lens 50mm");
    auto image = Exiv2::ImageFactory::open(file);
    image->readMetadata();
    image->exifData()["Exif.Image.Make"] = std::string("Panasonic");
    image->exifData()["Exif.Panasonic.ShadingCompensation"] = uint16_t(1);
    image->writeMetadata();
    return file;
}

double corner_falloff(double k1) {
    const double r2 =
        ((width - 1) * (width - 1) + (height - 1) * (height - 1)) / double(width * width + height * height);
    return 1 + k1 * r2;
}

// Profiles 1 (raw, linear, k1 -0.4) of `lens` and 2 (jpeg, gamma 2, k1 -0.2) of "JPEG 35mm", in the user's own
// database.
std::string make_database(const char *lens = "Lens 50mm") {
    const std::string path = work("data/lensprof/profiles.db");
    fs::create_directories(fs::path(path).parent_path());
    lensprof_store *store = nullptr;
    assert_ok(lensprof_store_open(path.c_str(), LENSPROF_STORE_CREATE, &store, nullptr));
    for (const uint32_t processing : {LENSPROF_PROCESSING_RAW, LENSPROF_PROCESSING_JPEG}) {
        const bool raw = processing == LENSPROF_PROCESSING_RAW;
        auto p = std::make_unique<lensprof_profile>();
        lensprof_profile_init(p.get());
        std::strcpy(p->key.camera_model, "Camera");
        std::strcpy(p->key.lens, raw ? lens : "JPEG 35mm");
        p->key.focal_mm = 50;
        p->key.aperture = 2;
        p->key.processing = processing;
        p->vignetting[0].k[0] = raw ? -0.4 : -0.2;
        if (!raw) assert_ok(lensprof_response_set_gamma(p->response, 2));
        assert_ok(lensprof_store_put(store, p.get(), nullptr, nullptr));
    }
    lensprof_store_close(store);
    return path;
}

void assert_corner(const std::string &file, double wanted) {
    const Picture picture = read_picture(file);
    const double got = picture.sample == LENSPROF_SAMPLE_U8
                           ? picture.pixels[0]
                           : 255 * double(reinterpret_cast<const float *>(picture.pixels.data())[0]);
    if (std::fabs(got - wanted) > (picture.traits.format == FileFormat::jpeg ? 1.6 : 0.6))
        fail_msg("%s: %.2f in the corner, not %.2f", file.c_str(), got, wanted);
}

const double by_gamma_2 = grey / std::sqrt(corner_falloff(-0.2)), by_linear = grey / corner_falloff(-0.4);

// The first command of a user: only the output folder is given.
void test_database_by_default(void **) {
    const std::string file = make_picture("a.png", "Camera", "JPEG 35mm");
    assert_refused(usage, {"apply", "-o", work("out"), file},
                   {"no correction given and no database found", "--db FILE"});
    make_database();
    must_exit(done, {"apply", "-o", work("out"), file});
    assert_corner(work("out/a.png"), by_gamma_2);
    fs::rename(work("data/lensprof/profiles.db"), work("p.db"));
    must_exit(done, {"apply", "-o", work("db"), "--db", work("p.db"), file});
    assert_corner(work("db/a.png"), by_gamma_2);
}

void test_words_in_place_of_exif(void **) {
    make_database();
    const std::string file = make_picture("a.png");
    assert_refused(not_found, {"apply", "-o", work("out"), file}, {"camera unknown", "--lens"});
    must_exit(done, {"apply", "-o", work("out"), "--camera", "Camera", "--lens", "JPEG 35mm", "--aperture", "2", file});
    assert_corner(work("out/a.png"), by_gamma_2);
    assert_refused(not_found,
                   {"apply", "-o", work("none"), "--camera", "Camera", "--lens", "JPEG 35mm", "--aperture", "11", file},
                   {"f/11"});
    const std::string raw = make_picture("b.tif", "Camera", "Lens 50mm", LENSPROF_SAMPLE_F32);
    must_exit(done, {"apply", "-o", work("out"), raw});
    assert_corner(work("out/b.tif"), by_linear);
    must_exit(done, {"apply", "-o", work("word"), "--key", "processing=raw", "--camera", "Camera", "--lens",
                     "Lens 50mm", file});
    assert_corner(work("word/a.png"), by_linear);
}

// A falloff measured on raw files applies to other pictures once their response is known.
void test_response_in_place_of_the_profiles(void **) {
    make_database();
    const std::string file = make_picture("a.png", "Camera", "Lens 50mm");
    for (const Words &how : {Words{}, Words{"--profile", "1"}}) {
        must_exit(done, Words{"apply", "--set", "response=gamma:2", "-o", work("gamma"), file} + how);
        assert_corner(work("gamma/a.png"), grey / std::sqrt(corner_falloff(-0.4)));
        must_exit(done, Words{"apply", "--set", "response=linear", "-o", work("linear"), file} + how);
        assert_corner(work("linear/a.png"), by_linear);
        const double light = std::pow((grey / 255.0 + 0.055) / 1.055, 2.4) / corner_falloff(-0.4);
        must_exit(done, Words{"apply", "--set", "response=srgb", "-o", work("srgb"), file} + how);
        assert_corner(work("srgb/a.png"), 255 * (1.055 * std::pow(light, 1 / 2.4) - 0.055));
    }
    must_exit(done, {"apply", "--set", "response=auto", "--profile", "2", "-o", work("auto"), file});
    assert_corner(work("auto/a.png"), by_gamma_2);
    assert_refused(usage, {"apply", "--set", "response=log", "-o", work("none"), file}, {"--set response", "srgb"});
}

void test_profile_of_another_processing(void **) {
    make_database();
    const std::string file = make_picture("a.png", "Camera", "Lens 50mm"),
                      raw = make_picture("b.tif", "Camera", "Lens 50mm", LENSPROF_SAMPLE_F32);
    assert_refused(usage, {"apply", "--profile", "1", "-o", work("out"), file},
                   {file, "is treated as jpeg", "profile 1 is for raw", "--key processing=raw", "--set response"});
    assert_refused(usage, {"apply", "--profile", "2", "-o", work("out"), raw}, {raw, "is treated as raw", "for jpeg"});
    must_exit(done, {"apply", "--profile", "1", "--key", "processing=raw", "-o", work("out"), file});
    assert_corner(work("out/a.png"), by_linear);
    must_exit(done, {"apply", "--profile", "2", "--key", "processing=jpeg", "-o", work("out"), raw});
    assert_corner(work("out/b.tif"), by_gamma_2);
}

// Pictures that the camera has corrected are not corrected twice.
void test_corrected_in_camera(void **) {
    make_database("Lens 35mm");
    const std::string file = make_corrected("in/a.jpg");
    const Words words = {"apply", "--lens", "JPEG 35mm"};
    const char *by = "its falloff was already corrected, in camera (Panasonic: shading compensation)";
    assert_refused(not_found, words + Words{"-o", work("out"), file}, {file, by, "--set force-falloff=yes"});
    assert_refused(not_found, {"apply", "--profile", "2", "-o", work("out"), file}, {by});
    assert_refused(not_found, words + Words{"--set", "response=srgb", "-o", work("out"), file}, {by});
    for (const Words &how : {Words{"--lens", "JPEG 35mm"}, Words{"--profile", "2"}}) {
        const Outcome forced =
            run_words(Words{"apply", "--set", "force-falloff=yes", "-o", work("forced"), file} + how);
        assert_int_equal(forced.code, done);
        assert_true(contains(forced.err, std::string("note: ") + file + ": " + by + ", and is corrected again"));
        assert_corner(work("forced/a.jpg"), by_gamma_2);
    }
    must_exit(done, words + Words{"--key", "processing=jpeg", "-o", work("jpeg"), file});
    assert_corner(work("jpeg/a.jpg"), by_gamma_2);
    must_exit(done, words + Words{"--set", "simulate=yes", "-o", work("simulated"), file});
    assert_corner(work("simulated/a.jpg"), grey * std::sqrt(corner_falloff(-0.2)));
    make_picture("in/b.jpg", "Camera", "JPEG 35mm");
    const Json json = json_of({"apply", "--json", "-o", work("folder"), work("in")});  // left out, without a failure
    assert_int_equal(json["pictures"].size(), 1);
    assert_true(json["left_out"][0]["corrected_already"].get<bool>());
}

// A database with one raw falloff of a lens.
std::string make_lens(const std::string &name, const char *lens, double k1) {
    fs::create_directories(fs::path(work(name)).parent_path());
    lensprof_store *store = nullptr;
    assert_ok(lensprof_store_open(work(name).c_str(), LENSPROF_STORE_CREATE, &store, nullptr));
    auto profile = std::make_unique<lensprof_profile>();
    lensprof_profile_init(profile.get());
    std::strcpy(profile->key.lens, lens);
    profile->key.focal_mm = 50, profile->key.aperture = 2, profile->key.crop_factor = 1;
    profile->key.processing = LENSPROF_PROCESSING_RAW;
    profile->vignetting[0].k[0] = k1;
    assert_ok(lensprof_store_put(store, profile.get(), nullptr, nullptr));
    lensprof_store_close(store);
    return work(name);
}

// The corner of a corrected picture of grey `grey`, as a share of linear light according to the sRGB response.
double corrected_by(const std::string &file) {
    const Picture picture = read_picture(file);
    const auto linear = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
    return linear(grey / 255.0) / linear(picture.pixels[0] / 255.0);
}

// The installed database is searched after the user's own, without extra options; those of --db in their order, and no
// others.
void test_several_databases(void **) {
    const std::string picture = make_picture("p.png", "Camera", "Lens 50mm");
    const Words apply = {"apply",         "--overwrite", "--set",     "response=srgb", "--key",
                         "crop-factor=1", "-o",          work("out"), picture};
    assert_refused(usage, apply, {"--pto", "no database found"});
    make_lens("share/lensprof/lensfun.db", "Lens 50mm", -0.4);
    const std::string out = work("out/p.png");
    must_exit(done, apply);  // the user has no database
    assert_close(corrected_by(out), corner_falloff(-0.4), 0.02);
    make_lens("data/lensprof/profiles.db", "Lens 35mm", -0.1);
    const Json json = json_of(apply + Words{"--json"});
    const Json &found = json["pictures"][0]["lookup"];
    assert_true(found["database"] == work("share/lensprof/lensfun.db"));
    assert_true(found["response"]["from"] == "given");  // from --response: no other response is mentioned
    for (const auto &code : found["reason_codes"]) assert_true(code != "lookup_typical_response");
    assert_false(contains(found["reason"].get<std::string>(), "typical"));
    assert_close(corrected_by(out), corner_falloff(-0.4), 0.02);
    make_lens("data/lensprof/profiles.db", "Lens 50mm", -0.2);
    must_exit(done, apply);
    assert_close(corrected_by(out), corner_falloff(-0.2), 0.02);
    const std::string a = make_lens("a.db", "Lens 85mm", -0.5), b = make_lens("b.db", "Lens 50mm", -0.3);
    must_exit(done, apply + Words{"--db", a, "--db", b, "--db", a});
    assert_close(corrected_by(out), corner_falloff(-0.3), 0.02);
    const Json exact = json_of(apply + Words{"--json", "--key", "processing=raw", "--db", a, "--db", b});
    assert_true(exact["pictures"][0]["lookup"]["exact"].get<bool>());
    assert_true(exact["pictures"][0]["lookup"]["sigma"].is_null());  // the profile states none
    assert_refused(not_found, apply + Words{"--db", a}, {a, "no profile of a lens with this name"});
    assert_refused(not_found, apply + Words{"--db", a, "--db", work("none.db")}, {"none.db"});
    assert_refused(usage, apply + Words{"--db", ""}, {"--db"});
    const std::string said = must_exit(done, {"query", "--lens", "Lens 50mm", "--focal", "50", "--aperture", "2.1",
                                              "--key", "distance=inf", "--db", a, "--db", b});
    assert_true(contains(said, "of this lens in " + b));
    const Json range = json_of({"query", "--lens", "Lens 50mm", "--json"});
    assert_int_equal(range["matches"], 2);                    // of both
    save_text(work("share/lensprof/lensfun.db"), "damaged");  // not named on the command line: it is skipped
    must_exit(done, apply);
}

// An unknown error is not reported as 0, and no label has two meanings.
void test_unknown_error(void **) {
    const std::string db = make_database();
    const std::string said = must_exit(done, {"query", "--lens", "Lens 50mm", "--db", db});
    assert_true(contains(said, "stops), error unknown\n"));
    assert_false(contains(said, "+-"));
    make_lens("raw.db", "Lens 50mm", -0.4), make_lens("raw.db", "Lens 50mm", -0.3);
    const std::string newest = must_exit(done, {"query", "--lens", "Lens 50mm", "--focal", "50", "--aperture", "2",
                                                "--key", "crop-factor=1", "--db", work("raw.db")});
    assert_true(contains(newest, "error unknown\n"));
    for (const char *label : {"\nfalloff ", "\nresponse ", "\nlookup ", "\nsigma "}) {
        const size_t at = newest.find(label);
        if (at == std::string::npos || newest.find(label, at + 1) != std::string::npos)
            fail_msg("not once %s: %s", label, newest.c_str());
    }
}

// Stores a profile of "Bad 50mm"; returns its picture.
std::string make_bad(const char *db, double k1, double k2, double k3) {
    lensprof_store *store = nullptr;
    assert_ok(lensprof_store_open(work(db).c_str(), LENSPROF_STORE_CREATE, &store, nullptr));
    auto p = std::make_unique<lensprof_profile>();
    lensprof_profile_init(p.get());
    std::strcpy(p->key.camera_model, "Camera");
    std::strcpy(p->key.lens, "Bad 50mm");
    p->key.focal_mm = 50, p->key.aperture = 2, p->key.processing = LENSPROF_PROCESSING_JPEG;
    p->vignetting[0].k[0] = k1, p->vignetting[0].k[1] = k2, p->vignetting[0].k[2] = k3;
    assert_ok(lensprof_store_put(store, p.get(), nullptr, nullptr));
    lensprof_store_close(store);
    return make_picture("bad.png", "Camera", "Bad 50mm");
}

// Falloffs that no lens has: refused, unless asked for by --key doubtful=yes or by number.
void test_impossible_falloffs(void **) {
    const struct {
        double k[3];
        const char *said;  // NULL: possible
    } cases[] = {{{0.2, 0, 0}, "rises to 1.20"},
                 {{-0.98, 0, 0}, "falls to 0.02"},
                 {{-0.6, 0.3, 0.1}, "rises outward by 0.0"},
                 {{0.03, 0, 0}, "rises outward by 0.03"},
                 {{0.015, 0, 0}, nullptr},
                 {{-0.9, 0, 0}, nullptr},
                 {{-0.3, 0.1, -0.3}, nullptr}};
    int number = 0;
    for (const auto &one : cases) {
        const std::string db = "bad" + std::to_string(number++) + ".db";
        const std::string picture = make_bad(db.c_str(), one.k[0], one.k[1], one.k[2]);
        const Words words{"apply", picture, "--db", work(db), "-o", work(db + "_out")};
        const Outcome run = run_words(words);
        assert_int_equal(run.code, one.said ? not_found : done);
        if (one.said && !contains(run.err, one.said)) fail_msg("%s", run.err.c_str());
        assert_true(fs::exists(work(db + "_out/bad.png")) == !one.said);
        must_exit(done, words + Words{"--key", "doubtful=yes"});
        must_exit(done, words + Words{"--profile", "1"});
    }
}

// A prediction far from what is stored has a large error, which is stated.
void test_uncertain_prediction(void **) {
    lensprof_store *store = nullptr;
    assert_ok(lensprof_store_open(work("far.db").c_str(), LENSPROF_STORE_CREATE, &store, nullptr));
    for (const double k : {-0.0, -0.94}) {
        auto p = std::make_unique<lensprof_profile>();
        lensprof_profile_init(p.get());
        std::strcpy(p->key.camera_model, "Camera");
        std::strcpy(p->key.lens, "Zoom");
        p->key.focal_mm = k < -0.5 ? 33 : 78, p->key.aperture = 2, p->key.processing = LENSPROF_PROCESSING_JPEG;
        p->vignetting[0].k[0] = k;
        p->covariance_size = 0;
        assert_ok(lensprof_store_put(store, p.get(), nullptr, nullptr));
    }
    lensprof_store_close(store);
    const std::string picture = make_picture("far.png", "Camera", "Zoom");
    const Words words{"apply", picture, "--db", work("far.db"), "-o", work("far_out"), "--key", "crop-factor=1"};
    const Json found = json_of(Words{"query", "--db", work("far.db"), "--camera", "Camera", "--lens", "Zoom", "--focal",
                                     "50", "--aperture", "2", "--key", "crop-factor=1", "--json"});
    const double sigma = found["lookup"]["sigma"].is_number() ? found["lookup"]["sigma"].get<double>() : 0.0;
    const Outcome run = run_words(words);
    if (run.code != (sigma > 0.1 ? not_found : done) || sigma <= 0.1) fail_msg("%g: %s", sigma, run.err.c_str());
    assert_true(contains(run.err, "too uncertain") && contains(run.err, "--key doubtful=yes"));
    assert_false(fs::exists(work("far_out/far.png")));
    must_exit(done, words + Words{"--key", "doubtful=yes"});
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_database_by_default),
        CLI_TEST(test_words_in_place_of_exif),
        CLI_TEST(test_impossible_falloffs),
        CLI_TEST(test_uncertain_prediction),
        CLI_TEST(test_response_in_place_of_the_profiles),
        CLI_TEST(test_profile_of_another_processing),
        CLI_TEST(test_corrected_in_camera),
        CLI_TEST(test_several_databases),
        CLI_TEST(test_unknown_error),
    };
    const auto start = [](void **state) {
        return make_folder(state) + setenv("XDG_DATA_HOME", in_folder("work/data").c_str(), 1)
               + setenv("XDG_DATA_DIRS", ("relative:" + in_folder("none") + ":" + in_folder("work/share")).c_str(), 1);
    };
    return cmocka_run_group_tests(tests, start, remove_folder);
}
