// The C functions of lensprof/photo.h: the same results as the command, and bad input.
#include <lensprof/photo.h>

#include "cli_runs.hpp"

using namespace cli_runs;

namespace {

struct Free {
    void operator()(lensprof_scene *scene) const { lensprof_scene_destroy(scene); }
    void operator()(lensprof_calibration *calibration) const { lensprof_calibration_destroy(calibration); }
    void operator()(lensprof_picture *picture) const { lensprof_picture_destroy(picture); }
};
template <class Handle>
using Held = std::unique_ptr<Handle, Free>;

void must_be_ok(lensprof_status status, const lensprof_error &error) {
    if (status != LENSPROF_OK) fail_msg("%s: %s", lensprof_status_name(status), error.text);
}

// `call(error)` returns this status, with a text that contains `part`.
template <class Call>
void assert_status(lensprof_status wanted, const std::string &part, const Call &call) {
    lensprof_error error{};
    const lensprof_status status = call(&error);
    if (status != wanted || !contains(error.text, part))
        fail_msg("%s, not %s: '%s' has no '%s'", lensprof_status_name(status), lensprof_status_name(wanted), error.text,
                 part.c_str());
}

Held<lensprof_scene> open_scene(const std::string &path, const lensprof_events *events = nullptr) {
    const char *name = path.c_str();
    lensprof_scene *scene = nullptr;
    lensprof_error error{};
    must_be_ok(lensprof_scene_open(&name, 1, nullptr, events, &scene, &error), error);
    return Held<lensprof_scene>(scene);
}

Held<lensprof_calibration> calibrated(const lensprof_scene *scene) {
    lensprof_calibration *calibration = nullptr;
    lensprof_error error{};
    must_be_ok(lensprof_calibrate(scene, nullptr, nullptr, &calibration, &error), error);
    return Held<lensprof_calibration>(calibration);
}

lensprof_calibration_info info_of(const lensprof_calibration *calibration) {
    lensprof_calibration_info info;
    lensprof_calibration_info_init(&info);
    lensprof_error error{};
    must_be_ok(lensprof_calibration_get_info(calibration, &info, &error), error);
    return info;
}

Held<lensprof_picture> open_picture(const std::string &path) {
    lensprof_picture *picture = nullptr;
    lensprof_error error{};
    must_be_ok(lensprof_picture_open(path.c_str(), &picture, &error), error);
    return Held<lensprof_picture>(picture);
}

Picture read_all(const lensprof_picture *picture, uint32_t max_side = 0) {
    lensprof_picture_info info;
    lensprof_picture_info_init(&info);
    lensprof_error error{};
    must_be_ok(lensprof_picture_get_info(picture, max_side, &info, &error), error);
    Picture read;
    read.width = info.read_width, read.height = info.read_height;
    read.sample = info.sample, read.layout = info.layout;
    read.row_bytes =
        size_t(read.width) * lensprof_layout_samples(info.layout) * lensprof_sample_type_bytes(info.sample);
    read.pixels.resize(read.row_bytes * read.height);
    const lensprof_target target = read.target();
    must_be_ok(lensprof_picture_read(picture, max_side, &target, &error), error);
    return read;
}

std::string photos(const std::string &name = "") { return in_folder("photos" + (name.empty() ? name : "/" + name)); }

int make_photos(void **state) {
    if (make_folder(state)) return 1;
    return run_words({"simulate", "-o", photos(), "--size", "400x300"}).code;
}

// That of the rendered pictures with default options, made once.
lensprof_calibration *of_photos() {
    static const Held<lensprof_calibration> made = calibrated(open_scene(photos()).get());
    return made.get();
}

// One scene, by build and by C: the same exposures, errors, response and falloff, to the last digit.
void test_as_build(void **) {
    const Json built = json_of({"build", photos(), "--no-store", "--json"});
    const auto scene = open_scene(photos());
    const auto calibration = calibrated(scene.get());
    lensprof_fit_result result;
    lensprof_fit_result_init(&result);
    lensprof_error error{};
    must_be_ok(lensprof_fit_setting_at(lensprof_calibration_get_fit(calibration.get()), LENSPROF_FIT_REFERENCE, &result,
                                       &error),
               error);
    assert_int_equal(result.usable, built["usable"].get<bool>());
    for (size_t i = 0; i < 3; i++)
        assert_true(result.vignetting[0].k[i] == built["vignetting"]["k"][0][i].get<double>());
    for (size_t i = 0; i < LENSPROF_RESPONSE_SAMPLES; i++)
        assert_true(result.response.table[i] == built["response"]["values"][0][i].get<double>());
    for (uint32_t i = 0; i < 6; i++) {
        lensprof_exposure exposure;
        double errors[4];
        must_be_ok(lensprof_calibration_exposure_at(calibration.get(), i, &exposure, errors, &error), error);
        const Json &image = built["images"][i];
        assert_true(exposure.ev == image["ev"].get<double>());
        assert_true(errors[0] == image["ev_sigma"].get<double>());
    }
    const uint32_t findings = info_of(calibration.get()).findings;
    assert_int_equal(findings, built["findings"].size());
    assert_int_equal(info_of(calibration.get()).images, built["images"].size());
    for (uint32_t i = 0; i < findings; i++) {
        lensprof_finding finding;
        lensprof_finding_init(&finding);
        must_be_ok(lensprof_calibration_finding_at(calibration.get(), i, &finding, &error), error);
        assert_string_equal(finding.text, built["findings"][i]["text"].get<std::string>().c_str());
    }
    const char *name, *file;
    must_be_ok(lensprof_calibration_image_at(calibration.get(), 1, &name, &file, &error), error);
    assert_string_equal(name, "img001.png");
    assert_true(std::filesystem::equivalent(file, photos() + "/img001.png"));
    lensprof_finding none;
    lensprof_finding_init(&none);
    assert_int_equal(lensprof_calibration_finding_at(calibration.get(), findings, &none, &error),
                     LENSPROF_ERROR_ARGUMENT);
}

// The options that the command has, too, and a key that replaces EXIF.
void test_options_as_build(void **) {
    const Json built = json_of({"build", photos(), "--no-store", "--json", "--camera", "Other", "--key", "style=Vivid",
                                "--fit", "reference=img003.png,camera-kind=phone,loss=huber,huber=4,sampling=paper"});
    const auto scene = open_scene(photos());
    lensprof_profile_key key;
    lensprof_profile_key_init(&key);
    std::strcpy(key.camera_model, "Other"), std::strcpy(key.style, "Vivid");
    lensprof_calibrate_options options;
    lensprof_calibrate_options_init(&options);
    options.reference = "img003.png", options.camera_kind = LENSPROF_CAMERA_PHONE, options.key = &key;
    options.loss = LENSPROF_LOSS_HUBER, options.huber_levels = 4.0, options.sampling = LENSPROF_SAMPLING_PAPER;
    lensprof_calibration *made = nullptr;
    lensprof_error error{};
    must_be_ok(lensprof_calibrate(scene.get(), &options, nullptr, &made, &error), error);
    const Held<lensprof_calibration> calibration(made);
    for (uint32_t i = 0; i < 6; i++) {
        lensprof_exposure exposure;
        must_be_ok(lensprof_calibration_exposure_at(made, i, &exposure, nullptr, &error), error);
        assert_true(exposure.ev == built["images"][i]["ev"].get<double>());
        assert_true(i != 3 || exposure.ev == 0.0);
    }
    lensprof_profile profile;
    lensprof_profile_init(&profile);
    must_be_ok(lensprof_calibration_profile_at(made, 0, &profile, &error), error);
    assert_string_equal(profile.key.camera_model, "Other");
    assert_string_equal(profile.key.style, "Vivid");
    assert_string_equal(profile.key.lens, "Simulated Lens");
    const auto refused = [&](const char *part) {
        lensprof_calibration *none = nullptr;
        assert_status(LENSPROF_ERROR_ARGUMENT, part,
                      [&](auto *why) { return lensprof_calibrate(scene.get(), &options, nullptr, &none, why); });
    };
    options.reference = "none.png", refused("none.png"), options.reference = nullptr;
    options.huber_levels = -1.0, refused("huber_levels"), options.huber_levels = 5.0;
    options.camera_kind = 77, refused("camera_kind"), options.camera_kind = LENSPROF_CAMERA_AUTO;
    options.sampling = LENSPROF_SAMPLING_BRACKET, refused("sampling"), options.sampling = LENSPROF_SAMPLING_BALANCED;
    key.aperture = -4.0, refused("key");
}

void test_scene(void **) {
    const auto scene = open_scene(photos());
    lensprof_scene_info info;
    lensprof_scene_info_init(&info);
    lensprof_error error{};
    must_be_ok(lensprof_scene_get_info(scene.get(), &info, &error), error);
    assert_int_equal(info.images, 6);
    assert_int_equal(info.left_out, 0);
    const Bytes picture = load(photos() + "/img000.png");
    std::filesystem::create_symlink(photos() + "/img000.png", work("link.pto"));
    for (const std::string &path : {photos() + "/img000.png", work("link.pto")})
        assert_status(LENSPROF_ERROR_ARGUMENT, "would be overwritten",
                      [&](lensprof_error *why) { return lensprof_scene_save(scene.get(), path.c_str(), why); });
    assert_true(load(photos() + "/img000.png") == picture);
    assert_in_range(info.links, 5, 15);
    lensprof_scene_link link, last{};
    for (uint32_t i = 0; i < info.links; i++) {
        must_be_ok(lensprof_scene_link_at(scene.get(), i, &link, &error), error);
        assert_true(link.image[0] < link.image[1] && link.image[1] < info.images && link.points >= 10);
        assert_true(link.fits_cameras == 1);
        assert_true(i == 0 || std::lexicographical_compare(last.image, last.image + 2, link.image, link.image + 2));
        last = link;
    }
    assert_status(LENSPROF_ERROR_ARGUMENT, "link",
                  [&](lensprof_error *why) { return lensprof_scene_link_at(scene.get(), info.links, &link, why); });
    lensprof_camera camera;
    const char *name, *file;
    must_be_ok(lensprof_scene_image_at(scene.get(), 4, &camera, &name, &file, &error), error);
    assert_string_equal(name, "img004.png");
    assert_true(camera.width > 0);
    assert_status(LENSPROF_ERROR_ARGUMENT, "only 6", [&](lensprof_error *why) {
        return lensprof_scene_image_at(scene.get(), 6, nullptr, nullptr, nullptr, why);
    });
    must_be_ok(lensprof_scene_save(scene.get(), work("found.pto").c_str(), &error), error);
    const auto again = open_scene(work("found.pto"));
    must_be_ok(lensprof_scene_get_info(again.get(), &info, &error), error);
    assert_int_equal(info.images, 6);
}

// Results that are saved are read again, and copies by them are those of the fit.
void test_saved(void **) {
    lensprof_calibration *calibration = of_photos();
    lensprof_error error{};
    for (const char *name : {"exposures.json", "result.pto", "profile.json", "pcalib.txt"})
        must_be_ok(lensprof_calibration_save(calibration, work(name).c_str(), &error), error);
    assert_status(LENSPROF_ERROR_ARGUMENT, "would be overwritten", [&](lensprof_error *why) {
        return lensprof_calibration_save(calibration, photos("img001.png").c_str(), why);
    });
    assert_status(LENSPROF_ERROR_ARGUMENT, "not that of a format", [&](lensprof_error *why) {
        return lensprof_calibration_save(calibration, work("result.xyz").c_str(), why);
    });
    lensprof_calibration *opened = nullptr;
    must_be_ok(lensprof_calibration_open(work("exposures.json").c_str(), nullptr, &opened, &error), error);
    const Held<lensprof_calibration> held(opened);
    const std::string source = photos("img002.png"), target = work("a.png"), other = work("b.png");
    const lensprof_copy copy = {source.c_str(), target.c_str()}, by_file = {source.c_str(), other.c_str()};
    uint32_t written = 0;
    must_be_ok(lensprof_correct_files(calibration, &copy, 1, nullptr, nullptr, &written, &error), error);
    assert_int_equal(written, 1);
    must_be_ok(lensprof_correct_files(opened, &by_file, 1, nullptr, nullptr, nullptr, &error), error);
    const Picture a = read_picture(target), b = read_picture(other);
    assert_true(a.pixels == b.pixels);
    assert_true(a.pixels != read_picture(source).pixels);
    assert_null(lensprof_calibration_get_fit(opened));
    const lensprof_calibration_info info = info_of(opened), whole = info_of(calibration);
    assert_int_equal(info.images, whole.images);
    assert_true(info.equalizes && whole.equalizes && whole.usable && !info.usable);
    assert_int_equal(info.profiles + info.findings, 0);
}

// The copies of `apply`, with the options that it has.
void test_options_as_apply(void **) {
    lensprof_calibration *calibration = of_photos();
    lensprof_error error{};
    must_be_ok(lensprof_calibration_save(calibration, work("exposures.json").c_str(), &error), error);
    const std::string source = photos("img002.png"), target = work("copy.png");
    const lensprof_copy copy = {source.c_str(), target.c_str()};
    lensprof_correct_options options;
    lensprof_correct_options_init(&options);
    options.gain_cap = 1.05, options.strength = 0.9, options.dither = 1;
    const auto written = [&](const std::string &set) {
        options.overwrite = 1;
        must_be_ok(lensprof_correct_files(calibration, &copy, 1, &options, nullptr, nullptr, &error), error);
        must_exit(done, {"apply", "--model", work("exposures.json"), "-o", work("applied"), "--overwrite", "--encoding",
                         "dither=yes", "--set", set});
        assert_true(read_picture(target).pixels == read_picture(work("applied/img002.png")).pixels);
    };
    written("gain-cap=1.05,strength=.9");
    options.simulate = 1, options.gain_cap = 0.0, options.strength = 1.0;
    written("simulate=yes");
    options.simulate = 0, options.gain_cap = 0.5;
    assert_status(LENSPROF_ERROR_ARGUMENT, "gain_cap", [&](auto *why) {
        return lensprof_correct_files(calibration, &copy, 1, &options, nullptr, nullptr, why);
    });
}

void test_profiles(void **) {
    lensprof_calibration *calibration = of_photos();
    assert_int_equal(info_of(calibration).profiles, 1);
    lensprof_profile profile;
    lensprof_profile_init(&profile);
    lensprof_error error{};
    must_be_ok(lensprof_calibration_profile_at(calibration, 0, &profile, &error), error);
    assert_true(profile.vignetting[0].k[0] < 0.0);
    assert_true(profile.covariance_size > 0);
    const bool is_named = *profile.key.camera_model || *profile.key.lens;
    const std::string db = work("photo.db");
    uint32_t stored = 0;
    const lensprof_status status = lensprof_calibration_store(calibration, db.c_str(), &stored, &error);
    assert_int_equal(status, is_named ? LENSPROF_OK : LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(fs::exists(db), is_named);
}

// From a path and from memory, full and reduced, the same pixels; written and encoded.
void test_pictures(void **) {
    const std::string path = photos("img000.png");
    const auto picture = open_picture(path);
    const Picture all = read_all(picture.get());
    assert_true(all.pixels == read_picture(path).pixels);
    const Picture small = read_all(picture.get(), 100);
    assert_true(small.width < all.width && small.width >= 100);
    const Bytes bytes = load(path);
    lensprof_picture *memory = nullptr;
    lensprof_error error{};
    must_be_ok(lensprof_picture_open_memory(bytes.data(), bytes.size(), &memory, &error), error);
    const Held<lensprof_picture> held(memory);
    assert_true(read_all(memory).pixels == all.pixels);
    const lensprof_image view = all.view();
    lensprof_picture_options options;
    lensprof_picture_options_init(&options);
    options.like = picture.get();
    must_be_ok(lensprof_picture_write(work("copy.tif").c_str(), &view, &options, &error), error);
    assert_true(read_picture(work("copy.tif")).pixels == all.pixels);
    Bytes encoded(all.pixels.size() + 65536);
    size_t count = 0;
    must_be_ok(lensprof_picture_encode(".png", &view, &options, encoded.data(), encoded.size(), &count, &error), error);
    encoded.resize(count);
    must_be_ok(lensprof_picture_open_memory(encoded.data(), count, &memory, &error), error);
    const Held<lensprof_picture> again(memory);
    assert_true(read_all(memory).pixels == all.pixels);
    assert_status(LENSPROF_ERROR_CAPACITY, "are needed", [&](lensprof_error *why) {
        return lensprof_picture_encode(".png", &view, nullptr, encoded.data(), 10, &count, why);
    });
}

// What is given replaces that of the other picture in EXIF; the rest of it stays.
void test_metadata(void **) {
    const auto like = open_picture(photos("img000.png"));
    lensprof_picture_metadata metadata, read;
    lensprof_picture_metadata_init(&metadata), lensprof_picture_metadata_init(&read);
    metadata.exposure_time_s = 0.008, metadata.iso = 102400, metadata.f_number = 4.0;
    std::snprintf(metadata.captured, sizeof metadata.captured, "2024:05:01 12:30:15.25");
    lensprof_picture_options options;
    lensprof_picture_options_init(&options);
    options.like = like.get(), options.metadata = &metadata;
    const Picture all = read_all(like.get());
    const lensprof_image view = all.view();
    lensprof_error error{};
    must_be_ok(lensprof_picture_write(work("exif.jpg").c_str(), &view, &options, &error), error);
    must_be_ok(lensprof_picture_get_metadata(open_picture(work("exif.jpg")).get(), &read, &error), error);
    assert_true(read.exposure_time_s == 0.008 && read.iso == 102400 && read.f_number == 4.0);
    assert_string_equal(read.captured, metadata.captured);
    assert_string_equal(read.key.lens, "Simulated Lens");
    metadata.f_number = 0.0;
    assert_status(LENSPROF_ERROR_ARGUMENT, "f_number", [&](lensprof_error *why) {
        return lensprof_picture_write(work("bad.jpg").c_str(), &view, &options, why);
    });
    metadata.f_number = 4.0, metadata.struct_size = 8;
    assert_status(LENSPROF_ERROR_STRUCT_SIZE, "metadata", [&](lensprof_error *why) {
        return lensprof_picture_write(work("bad.jpg").c_str(), &view, &options, why);
    });
    assert_false(std::filesystem::exists(work("bad.jpg")));
}

void test_bad_pictures(void **) {
    save(work("empty.jpg"), {});
    save(work("text.png"), Bytes(100, 'x'));
    lensprof_picture *picture = nullptr;
    for (const char *name : {"empty.jpg", "text.png", "missing.png", "."})
        assert_status(LENSPROF_ERROR_READ, name,
                      [&](lensprof_error *why) { return lensprof_picture_open(work(name).c_str(), &picture, why); });
    assert_status(LENSPROF_ERROR_READ, "the bytes of the picture",
                  [&](lensprof_error *why) { return lensprof_picture_open_memory("GIF89a", 6, &picture, why); });
    assert_status(LENSPROF_ERROR_READ, "the bytes of the picture",
                  [&](lensprof_error *why) { return lensprof_picture_open_memory(nullptr, 0, &picture, why); });
    assert_status(LENSPROF_ERROR_ARGUMENT, "NULL",
                  [&](lensprof_error *why) { return lensprof_picture_open(nullptr, &picture, why); });
    assert_null(picture);
    const auto good = open_picture(photos("img000.png"));
    uint8_t pixels[12] = {};
    const lensprof_target target = {pixels, 6, 2, 2, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB};
    assert_status(LENSPROF_ERROR_SIZE, "size",
                  [&](lensprof_error *why) { return lensprof_picture_read(good.get(), 0, &target, why); });
    const lensprof_image image = {pixels, 6, 2, 2, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB};
    assert_status(LENSPROF_ERROR_ARGUMENT, "x.bmp", [&](lensprof_error *why) {
        return lensprof_picture_write(work("x.bmp").c_str(), &image, nullptr, why);
    });
    lensprof_picture_info info{};
    assert_status(LENSPROF_ERROR_STRUCT_SIZE, "_init",
                  [&](lensprof_error *why) { return lensprof_picture_get_info(good.get(), 0, &info, why); });
    info.struct_size = sizeof info + 8;
    assert_status(LENSPROF_ERROR_STRUCT_SIZE, "newer",
                  [&](lensprof_error *why) { return lensprof_picture_get_info(good.get(), 0, &info, why); });
}

void test_bad_scenes(void **) {
    lensprof_scene *scene = nullptr;
    const auto open = [&](const std::string &path, lensprof_error *why) {
        const char *name = path.c_str();
        return lensprof_scene_open(&name, 1, nullptr, nullptr, &scene, why);
    };
    assert_status(LENSPROF_ERROR_READ, "missing.pto", [&](auto *why) { return open(work("missing.pto"), why); });
    assert_status(LENSPROF_ERROR_NOT_USABLE, "only one picture",
                  [&](auto *why) { return open(photos("img000.png"), why); });
    assert_status(LENSPROF_ERROR_ARGUMENT, "NULL",
                  [&](auto *why) { return lensprof_scene_open(nullptr, 1, nullptr, nullptr, &scene, why); });
    assert_status(LENSPROF_ERROR_ARGUMENT, "NULL",
                  [&](auto *why) { return lensprof_scene_open(nullptr, 0, nullptr, nullptr, &scene, why); });
    fs::create_directories(work("\xff\xfe"));
    assert_status(LENSPROF_ERROR_ARGUMENT, "", [&](auto *why) { return open(work("\xff\xfe"), why); });
    assert_null(scene);
    assert_status(LENSPROF_ERROR_ARGUMENT, "NULL",
                  [&](auto *why) { return lensprof_calibrate(nullptr, nullptr, nullptr, nullptr, why); });
    lensprof_calibrate_options options;
    lensprof_calibrate_options_init(&options);
    options.method = 77;
    const auto good = open_scene(photos());
    lensprof_calibration *calibration = nullptr;
    assert_status(LENSPROF_ERROR_ARGUMENT, "method",
                  [&](auto *why) { return lensprof_calibrate(good.get(), &options, nullptr, &calibration, why); });
    assert_null(calibration);
    lensprof_scene_destroy(nullptr), lensprof_calibration_destroy(nullptr), lensprof_picture_destroy(nullptr);
}

// Nothing is written if one of the pictures cannot be corrected.
void test_bad_copies(void **) {
    lensprof_calibration *calibration = of_photos();
    fs::copy_file(photos("img000.png"), work("stranger.png"));
    const std::string good = photos("img000.png"), stranger = work("stranger.png"), to_a = work("to_a.png"),
                      to_b = work("to_b.png");
    const auto refused = [&](lensprof_status status, const char *part, std::initializer_list<lensprof_copy> copies) {
        assert_status(status, part, [&](lensprof_error *why) {
            return lensprof_correct_files(calibration, copies.begin(), uint32_t(copies.size()), nullptr, nullptr,
                                          nullptr, why);
        });
        assert_false(fs::exists(to_a) || fs::exists(to_b));
    };
    refused(LENSPROF_ERROR_NOT_FOUND, "not a picture of",
            {{good.c_str(), to_a.c_str()}, {stranger.c_str(), to_b.c_str()}});
    refused(LENSPROF_ERROR_ARGUMENT, "img000.png", {{good.c_str(), good.c_str()}});
    refused(LENSPROF_ERROR_ARGUMENT, "to_a.png", {{good.c_str(), to_a.c_str()}, {good.c_str(), to_a.c_str()}});
    refused(LENSPROF_ERROR_ARGUMENT, "NULL", {{good.c_str(), nullptr}});
    lensprof_correct_options overwriting;  // but not pictures of the scene
    lensprof_correct_options_init(&overwriting);
    overwriting.overwrite = 1;
    const Bytes before = load(photos("img001.png"));
    const std::string other = photos("img001.png");
    const lensprof_copy over = {good.c_str(), other.c_str()};
    assert_status(LENSPROF_ERROR_ARGUMENT, "img001.png", [&](auto *why) {
        return lensprof_correct_files(calibration, &over, 1, &overwriting, nullptr, nullptr, why);
    });
    assert_true(load(other) == before);
    lensprof_correct_options options;
    lensprof_correct_options_init(&options);
    const std::string db = work("none.db");
    const char *name = db.c_str();
    options.databases = &name, options.database_count = 1;
    const lensprof_copy copy = {good.c_str(), to_a.c_str()};
    lensprof_error error{};
    assert_int_not_equal(lensprof_correct_files(nullptr, &copy, 1, &options, nullptr, nullptr, &error), LENSPROF_OK);
    assert_false(fs::exists(to_a));
}

// The whole job: a second call has nothing to do, and the folder is that of the command.
void test_folder(void **) {
    const std::string in = photos(), out = work("out"), db = work("p.db");
    const char *path = in.c_str(), *database = db.c_str();
    lensprof_folder_options options;
    lensprof_folder_options_init(&options);
    options.databases = &database, options.database_count = 1;
    lensprof_folder_result result;
    lensprof_folder_result_init(&result);
    lensprof_error error{};
    must_be_ok(lensprof_calibrate_folder(&path, 1, out.c_str(), &options, nullptr, &result, &error), error);
    assert_int_equal(result.found, 6);
    assert_int_equal(result.corrected, 6);
    assert_int_equal(result.written, 6);
    assert_int_equal(result.fitted, 1);
    must_be_ok(lensprof_calibrate_folder(&path, 1, out.c_str(), &options, nullptr, &result, &error), error);
    assert_int_equal(result.written, 0);
    assert_int_equal(result.fitted, 0);
    const Json json = json_of({"calibrate", in, "-o", out, "--db", db, "--json"});
    assert_int_equal(json["now"]["corrected"], 0);
    assert_true(fs::exists(db));
    assert_status(LENSPROF_ERROR_ARGUMENT, "folder of the pictures", [&](auto *why) {
        return lensprof_calibrate_folder(&path, 1, in.c_str(), &options, nullptr, nullptr, why);
    });
    assert_status(LENSPROF_ERROR_ARGUMENT, "NULL", [&](auto *why) {
        return lensprof_calibrate_folder(&path, 1, nullptr, nullptr, nullptr, nullptr, why);
    });
}

struct Counted {
    int steps = 0, notices = 0, last = 1 << 30;
    static int on_step(const char *, double, const char *, void *user) {
        auto &counted = *static_cast<Counted *>(user);
        return ++counted.steps > counted.last;
    }
    static void on_notice(const lensprof_notice *notice, void *user) {
        static_cast<Counted *>(user)->notices += *notice->text != 0;
    }
};

// A call that is cancelled at any of its steps returns CANCELLED and leaves nothing.
void test_cancelled(void **) {
    Counted all;
    lensprof_events events;
    lensprof_events_init(&events);
    events.user = &all, events.progress = Counted::on_step, events.notice = Counted::on_notice;
    open_scene(photos(), &events);
    assert_true(all.steps > 3 && all.notices > 0);
    const std::string path = photos();
    const char *name = path.c_str();
    for (int last = 0; last < all.steps; last += std::max(1, all.steps / 6)) {
        Counted some;
        some.last = last;
        events.user = &some;
        lensprof_scene *scene = nullptr;
        lensprof_error error{};
        const lensprof_status status = lensprof_scene_open(&name, 1, nullptr, &events, &scene, &error);
        const Held<lensprof_scene> held(scene);  // the last step may be too late
        if (status != LENSPROF_OK) assert_int_equal(status, LENSPROF_ERROR_CANCELLED);
        if (last == 0) assert_int_equal(status, LENSPROF_ERROR_CANCELLED);
        assert_int_equal(scene == nullptr, status != LENSPROF_OK);
    }
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        CLI_TEST(test_as_build),
        CLI_TEST(test_options_as_build),
        CLI_TEST(test_options_as_apply),
        CLI_TEST(test_scene),
        CLI_TEST(test_saved),
        CLI_TEST(test_profiles),
        CLI_TEST(test_pictures),
        CLI_TEST(test_bad_pictures),
        CLI_TEST(test_bad_scenes),
        CLI_TEST(test_bad_copies),
        CLI_TEST(test_cancelled),
        CLI_TEST(test_folder),
        CLI_TEST(test_metadata),
    };
    return cmocka_run_group_tests(tests, make_photos, remove_folder);
}
