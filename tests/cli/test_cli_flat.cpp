// `lensprof flat` in process: cards of a known lens as picture files; printed and stored results, refused input.
#include "cli_runs.hpp"
#include "icc_files.hpp"

#include <lensprof/lensprof.h>

#include "photo/base/library.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/report/falloff.hpp"

namespace {

using namespace cli_runs;

constexpr uint32_t width = 360, height = 270;
const lensprof_vignetting lens{{-0.42, 0.10, -0.05}, {0.03, -0.02}};

struct Card {
    double ev = 0.0, rotation_deg = 0.0, slant = 0.08, texture = 0.0, gamma = 1.0;
    uint32_t layout = LENSPROF_LAYOUT_RGB;
    double left = 0.0, right = 1.0;   // part of the width covered by the card
    bool told = false;                // EXIF has exposure and camera
    Bytes icc;                        // colour profile
    double black = 0.0, white = 1.0;  // samples without light and at saturation
    bool dark = false;                // the lens is covered
    double circle = 2.0;              // half diagonals that it lights up
};

std::string shoot(const std::string &name, const Card &card) {
    Picture picture = make_noise(width, height, LENSPROF_SAMPLE_U16, card.layout);
    picture.icc = card.icc;
    const uint32_t samples = lensprof_layout_samples(card.layout);
    const double half = 0.5 * std::hypot(width, height), turn = card.rotation_deg * M_PI / 180.0;
    lensprof_response response;
    assert_int_equal(lensprof_response_set_gamma(&response, card.gamma), LENSPROF_OK);
    uint64_t random = 77;
    auto *at = reinterpret_cast<uint16_t *>(picture.pixels.data());
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            double dx = (x - 0.5 * (width - 1)) / half, dy = (y - 0.5 * (height - 1)) / half;
            double m =
                lensprof_vignetting_eval(&lens, lensprof_vignetting_r2(&lens, width, height, x, y, nullptr), nullptr);
            double light =
                0.4 * std::exp2(card.ev) * m * std::exp(card.slant * (std::cos(turn) * dx - std::sin(turn) * dy));
            light *= 1.0 + card.texture * std::sin(0.35 * x) * std::sin(0.3 * y);
            if (x < card.left * width || x >= card.right * width) light *= 0.1;
            if (card.dark || std::hypot(dx, dy) > card.circle) light = 0.0;
            for (uint32_t c = 0; c < samples; c++) {
                double grey = lensprof_response_eval(&response, light, nullptr) + 0.003 * lp_normal(&random);
                const double value = card.black + (card.white - card.black) * grey;
                *at++ = static_cast<uint16_t>(std::lround(65535.0 * std::min(std::max(value, 0.0), card.white)));
            }
        }
    PictureMetadata metadata = unknown_metadata();
    if (card.told) {
        set_text(metadata.key.camera_model, sizeof metadata.key.camera_model, "Box 1");
        metadata.key.aperture = 2.0;
        metadata.f_number = 2.0, metadata.iso = 100.0, metadata.exposure_time_s = 0.01 * std::exp2(card.ev);
    }
    WriteOptions options;
    options.metadata = card.told ? &metadata : nullptr;
    const std::string path = in_folder(name);
    write_picture(path, picture, options);
    return path;
}

std::string shoot_grey(const std::string &name) {
    Card card;
    card.layout = LENSPROF_LAYOUT_GREY, card.dark = true;
    return shoot(name, card);
}

Words flat(const Words &words) { return Words{"flat"} + words; }

double corner_error(const Json &json) {
    lensprof_vignetting found{};
    for (size_t i = 0; i < 3; i++) found.k[i] = json["vignetting"]["k"][0][i].get<double>();
    return lensprof_vignetting_eval(&found, 1.0, nullptr) - lensprof_vignetting_eval(&lens, 1.0, nullptr);
}

void test_rotated_shots_are_measured_and_stored(void **) {
    Words files;
    for (int turn : {0, 90, 180}) {
        Card card;
        card.rotation_deg = turn;
        files.push_back(shoot("rotated" + std::to_string(turn) + ".tif", card));
    }
    const std::string db = in_folder("flat.db");
    const Words words = flat(files) + Words{"--linear", "--rotation", "0,90,180", "--camera", "Box", "--db", db};
    const Json json = json_of(words + Words{"--json"});
    assert_true(json["usable"].get<bool>());
    assert_string_equal(json["method"].get<std::string>().c_str(), "flat");
    assert_true(json["separated"].get<bool>());
    assert_close(corner_error(json), 0.0, 0.002);
    assert_close(json["vignetting"]["center"][0].get<double>(), 0.03, 0.003);
    assert_close(json["images"][0]["gradient"][0].get<double>(), 0.08, 0.004);
    assert_int_equal(json["covariance"].size(), 5);
    assert_int_equal(json["profile"].get<int>(), 1);
    const Json stored = json_of({"profile", "show", "1", "--json", "--db", db});
    assert_string_equal(stored["provenance"]["method"].get<std::string>().c_str(), "flat");
    assert_string_equal(stored["key"]["processing"].get<std::string>().c_str(), "raw");
    assert_true(stored["vignetting"] == json["vignetting"]);
    const std::string table = must_exit(done, words);
    for (const char *part : {"falloff", "separated from the lens", "stored    profile 2", "residual", "rotated180.tif"})
        assert_true(contains(table, part));
}

// One shot in a light of unknown slope: the note names the option that states the light, which changes the corners by
// about what the note states.
void test_the_light_is_stated(void **) {
    const std::string file = shoot("one_light.tif", Card{});
    const Words words = flat({file, "--linear", "--no-store", "--json"});
    const auto corners = [](const Json &json) {
        lensprof_vignetting found{};
        for (size_t i = 0; i < 3; i++) found.k[i] = json["vignetting"]["k"][0][i].get<double>();
        for (size_t i = 0; i < 2; i++) found.center[i] = json["vignetting"]["center"][i].get<double>();
        const auto light = [&](double x, double y) {
            return lensprof_vignetting_eval(&found, lensprof_vignetting_r2(&found, width, height, x, y, nullptr),
                                            nullptr);
        };
        std::vector<double> values;  // compared with the middle of the frame
        for (const double x : {0.0, width - 1.0})
            for (const double y : {0.0, height - 1.0})
                values.push_back(light(x, y) / light(0.5 * (width - 1.0), 0.5 * (height - 1.0)));
        return values;
    };
    const Json chosen = json_of(words), even = json_of(words + Words{"--light", "even"}),
               plane = json_of(words + Words{"--light", "plane"});
    assert_true(even["light"] == "even" && plane["light"] == "plane" && chosen["light"] == "plane");
    const auto note = std::find_if(chosen["findings"].begin(), chosen["findings"].end(),
                                   [](const Json &finding) { return finding["code"] == "flat_center_by_prior"; });
    assert_true(note != chosen["findings"].end() && contains((*note)["text"].get<std::string>(), "--light even"));
    double change = 0.0;
    for (size_t i = 0; i < 4; i++)
        change = std::max(change, std::fabs(std::log2(corners(even)[i] / corners(chosen)[i])));
    const double stated = chosen["light_ev"];  // of ln M as a polynomial, without a grid
    assert_true(stated > 0.02 && change > 0.4 * stated && change < 1.2 * stated);
    assert_false(contains(even.dump(), "flat_center_by_prior"));
    const Outcome printed = run_words(flat({file, "--linear", "--no-store"}));  // once
    assert_true(contains(printed.out, "[flat_center_by_prior]") && !contains(printed.err, "[flat_center_by_prior]"));
}

// Grey value of a corner relative to the middle, each the mean of 16 x 16 pixels.
double evenness(const std::string &file) {
    const Picture picture = read_picture(file);
    const auto mean = [&](uint32_t left, uint32_t top) {
        double sum = 0.0;
        for (uint32_t y = top; y < top + 16; y++)
            for (uint32_t x = left; x < left + 16; x++)
                sum += reinterpret_cast<const uint16_t *>(picture.pixels.data())[3 * (y * width + x) + 1];
        return sum;
    };
    return mean(0, 0) / mean(width / 2 - 8, height / 2 - 8);
}

// `flat` and `apply` treat a card alike: linear because of its colour profile, or because of an option for both.
void test_the_card_is_corrected(void **) {
    for (bool has_profile : {true, false}) {
        Card card;
        card.told = true, card.slant = 0.0;
        if (has_profile) card.icc = icc_files::profile_of(icc_files::samples_curve({}));
        const std::string name = has_profile ? "linear" : "silent", file = shoot(name + ".tif", card);
        const Words db = {"--db", in_folder(name + ".db")}, setting = {"--lens", "Box lens", "--focal", "35"};
        assert_true(evenness(file) < 0.75);
        const Words measure = flat({file}) + setting + db, out = {"-o", in_folder(name + "-out"), "--overwrite", file};
        if (has_profile) {
            const Outcome outcome = run_words(measure);
            assert_int_equal(outcome.code, done);
            assert_false(contains(outcome.err, "--key processing=raw"));
            assert_int_equal(
                json_of(Words{"profile", "list", "--json", "--key", "processing=raw"} + db)["profiles"].size(), 1);
            must_exit(done, Words{"apply"} + setting + db + out);
        } else {
            assert_refused(usage, measure, {file, "is not marked as linear", "--linear"});
            const Outcome outcome = run_words(measure + Words{"--linear"});
            assert_int_equal(outcome.code, done);
            assert_true(contains(outcome.err, "lensprof apply --key processing=raw"));
            const Outcome guessed = run_words(Words{"apply"} + setting + db + out);
            assert_int_equal(guessed.code, done);
            assert_true(contains(guessed.err, "this 16 bit TIFF is not marked as linear"));
            must_exit(done, Words{"apply", "--key", "processing=raw"} + setting + db + out);
        }
        assert_close(evenness(in_folder(name + "-out/" + name + ".tif")), 1.0, 0.01);
    }
}

// The picture rotated by 90 degrees, as another program saves it: higher than wide, without an orientation.
std::string stand_up(const std::string &file, const std::string &name) {
    Picture lying = read_picture(file), standing = make_noise(height, width, LENSPROF_SAMPLE_U16, lying.layout);
    const auto *from = reinterpret_cast<const uint16_t *>(lying.pixels.data());
    auto *to = reinterpret_cast<uint16_t *>(standing.pixels.data());
    for (uint32_t y = 0; y < width; y++)
        for (uint32_t x = 0; x < height; x++)
            std::copy_n(from + 3 * ((height - 1 - x) * width + y), 3, to + 3 * (y * height + x));
    write_picture(in_folder(name), standing, {});
    return in_folder(name);
}

// Adds a tag with a number to the directory of a TIFF.
void state_level(const std::string &file, uint16_t tag, uint32_t value) {
    TIFF *tiff = TIFFOpen(file.c_str(), "r+");
    assert_non_null(tiff);
    float level = static_cast<float>(value);
    uint32_t white = value;
    assert_int_equal(
        tag == TIFFTAG_BLACKLEVEL ? TIFFSetField(tiff, tag, 1, &level) : TIFFSetField(tiff, tag, 1, &white), 1);
    assert_int_equal(TIFFRewriteDirectory(tiff), 1);
    TIFFClose(tiff);
}

// Of green, 0..1.
double sample_of(const Picture &picture, uint32_t x, uint32_t y) {
    return sample_value(picture.sample, picture.pixels.data() + y * picture.row_bytes, size_t(3) * x + 1);
}

// The image circle is found, stored and printed; applied, what lies outside keeps its bytes.
void test_an_image_circle(void **) {
    Card card;
    card.circle = 0.8, card.slant = 0.0;
    const std::string file = shoot("circle.tif", card);
    const Outcome outcome =
        run_words({"flat", file, "--linear", "--camera", "Box", "--lens", "Fish", "--db", work("c.db")});
    assert_int_equal(outcome.code, done);
    assert_true(contains(outcome.out, "at the edge of the image circle: 7"));  // 76.6 % by the formula at r = .8
    const Json profile = json_of({"profile", "show", "1", "--db", work("c.db"), "--json"});
    assert_close(profile["image_circle"]["radius"].get<double>(), 0.8, 0.01);
    must_exit(done,
              {"apply", "--profile", "1", "--db", work("c.db"), "--key", "processing=raw", "-o", work("out"), file});
    const Picture before = read_picture(file), after = read_picture(work("out/circle.tif"));
    int kept = 0;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            const double r =
                std::hypot(x - 0.5 * (width - 1), y - 0.5 * (height - 1)) / (0.5 * std::hypot(width, height));
            if (r > 0.81) assert_true(sample_of(after, x, y) == sample_of(before, x, y)), kept++;
            if (r > 0.7 && r < 0.79) assert_true(sample_of(after, x, y) > 1.1 * sample_of(before, x, y));
        }
    assert_true(kept > 3000);
}

// The black level is stated, that of dark frames, or that which two exposures show; applied, the card is even, and
// black is where it was.
void test_the_black_level(void **) {
    Card card;
    card.slant = 0.0, card.black = 256.0 / 65535.0, card.white = 4095.0 / 65535.0;
    const std::string bright = shoot("pedestal.tif", card);
    card.ev = -1.3;
    const std::string dim = shoot("dim.tif", card);
    card.dark = true;
    const std::string dark = shoot("dark.tif", card), again = shoot("dark2.tif", card);
    Picture not_finite = make_noise(width, height, LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_RGB);
    reinterpret_cast<float *>(not_finite.pixels.data())[7] = NAN;
    write_picture(in_folder("odd_dark.tif"), not_finite);
    const Words common = {"--linear", "--fit", "white-level=4095,center=fixed", "--light", "even", "--json"};
    const auto measured = [&](const Words &words) { return json_of(flat(words) + common + Words{"--no-store"}); };

    const Json open = measured({bright});
    assert_true(corner_error(open) > 0.03);
    assert_true(contains(open.dump(), "flat_black_level"));
    assert_true(open["levels"]["black_ev"].get<double>() > 0.02);
    for (const Words &words : {Words{bright, "--black", "256"}, Words{bright, "--black", "0.390631%"},
                               Words{bright, "--black", "256:256:256"}, Words{bright, "--dark", dark, "--dark", again},
                               Words{bright, dim}, Words{bright, dim, "--shots", "1,1", "--ev", "0,-1.3"}}) {
        const Json json = measured(words);
        assert_close(corner_error(json), 0.0, 0.003);
        for (const Json &black : json["levels"]["black"]) assert_close(65535.0 * black.get<double>(), 256.0, 3.0);
        assert_close(json["levels"]["white"].get<double>(), 4095.0 / 65535.0, 1e-12);
        assert_int_equal(json["levels"]["from_pictures"].get<bool>(), words.size() > 1 && words[1] == dim);
    }

    state_level(bright, 50714, 256);  // BlackLevel and WhiteLevel, as multispectral cameras write them
    state_level(bright, 50717, 4095);
    const Json of_file = json_of(flat({bright, "--linear", "--json", "--no-store"}));
    assert_close(corner_error(of_file), 0.0, 0.004);
    assert_close(of_file["levels"]["white"].get<double>(), 4095.0 / 65535.0, 1e-12);

    state_level(bright, 50714, 5000);  // above white: not plausible
    const Outcome odd = run_words(flat({bright, "--linear", "--no-store"}));
    assert_int_equal(odd.code, done);
    assert_true(contains(odd.err, "BlackLevel"));
    state_level(bright, 50714, 256);

    const Words db = {"--db", in_folder("black.db")}, setting = {"--camera", "Box", "--lens", "Box lens"};
    must_exit(done, flat({bright, dim}) + common + setting + db);
    assert_true(contains(must_exit(done, Words{"profile", "show", "1"} + db), "levels    black 0.39"));
    const Words apply = Words{"apply", bright, "--profile", "1", "--key", "processing=raw"} + db;
    must_exit(done, apply + Words{"-o", in_folder("levelled")});
    const Picture result = read_picture(in_folder("levelled/pedestal.tif"));
    const auto mean = [&](uint32_t left, uint32_t top) {
        double sum = 0.0;
        for (uint32_t i = 0; i < 256; i++)
            sum += reinterpret_cast<const uint16_t *>(
                result.pixels.data())[3 * ((top + i / 16) * width + left + i % 16) + 1];
        return sum / 256.0;
    };
    const double middle = mean(width / 2 - 8, height / 2 - 8);
    assert_close(middle, 256.0 + 0.4 * 3839.0, 8.0);
    assert_close(mean(0, 0), middle, 12.0);
    must_exit(done, apply + Words{"--set", "black=0,white=100%", "-o", in_folder("unlevelled")});
    assert_true(evenness(in_folder("unlevelled/pedestal.tif")) > 1.05);
    must_exit(done, apply + Words{"--set", "white=65535", "-o", in_folder("white")});  // black stays the profile's
    assert_close(evenness(in_folder("white/pedestal.tif")), 1.0, 0.01);

    const struct {
        int code;
        Words words;
        const char *named;
    } wrong[] = {
        {usage, {bright, "--black", "0.0078"}, "ignore-below=0.0078"},
        {usage, {bright, "--black", "0.0078"}, "such as 0.78%"},
        {usage, {bright, "--black", "70000"}, "--black"},
        {usage, {bright, "--black", "1:2"}, "RED:GREEN:BLUE"},
        {usage, {bright, "--black", "5000", "--fit", "white-level=4095"}, "not below its white level"},
        {usage, {bright, "--black", "256", "--dark", dark}, "exclude each other"},
        {not_usable, {bright, "--dark", dim}, "dim.tif: is not dark"},
        {usage, {bright, "--dark", shoot_grey("grey_dark.tif")}, "grey_dark.tif"},
        {unreadable, {bright, "--dark", in_folder("none.tif")}, "none.tif"},
        {unreadable, {bright, "--dark", in_folder("odd_dark.tif")}, "odd_dark.tif: pixel 2, 0 is not a finite"},
        {usage, {bright, "--fit", "white-level=0"}, "white level"},
    };
    for (const auto &one : wrong)
        assert_refused(one.code, flat(one.words) + Words{"--linear", "--no-store"}, {one.named});
    assert_refused(usage, apply + Words{"--set", "black=80%,white=4095", "-o", in_folder("never")},
                   {"pedestal.tif", "not below its white level"});
    assert_false(std::filesystem::exists(in_folder("never/pedestal.tif")));
}

// Float samples of 0 to 1: a level is a share, with or without %; what lies above 1 is not white if the sample at
// saturation is stated.
void test_levels_of_float_samples(void **) {
    Card card;
    card.slant = 0.0, card.black = 0.05;
    const auto as_float = [](const std::string &file, const std::string &name, double factor) {
        const Picture codes = read_picture(file);
        Picture shares = make_noise(width, height, LENSPROF_SAMPLE_F32, codes.layout);
        for (size_t n = 0; n < size_t(3) * width * height; n++) {
            const auto value = static_cast<float>(factor * sample_value(codes.sample, codes.pixels.data(), n));
            std::memcpy(shares.pixels.data() + n * sizeof value, &value, sizeof value);
        }
        write_picture(in_folder(name), shares);
        return in_folder(name);
    };
    const std::string codes = shoot("levels.tif", card), shares = as_float(codes, "shares.tif", 1.0),
                      bright = as_float(codes, "above.tif", 4.5), counts = as_float(codes, "wide.tif", 1e6);
    const auto measured = [](const Words &words) {
        return json_of(flat(words) + Words{"--no-store", "--light", "even", "--fit", "center=fixed", "--json"});
    };
    assert_close(corner_error(measured({shares, "--black", "0.05"})), 0.0, 0.003);
    assert_true(measured({shares, "--black", "0.05"})["vignetting"]
                == measured({shares, "--black", "5%"})["vignetting"]);
    assert_close(corner_error(measured({counts, "--black", "50000", "--fit", "white-level=1e6"})), 0.0, 0.003);
    assert_refused(usage, flat({shares, "--no-store", "--black", "256"}), {"shares.tif", "from 0 to 1", "--black"});
    const Outcome white = run_words(flat({bright, "--no-store"}));
    assert_int_equal(white.code, not_usable);
    assert_true(contains(white.err, "--fit white-level=LEVEL"));
    const Outcome stated = run_words(flat({bright, "--no-store", "--fit", "white-level=80%"}));
    assert_int_equal(stated.code, not_usable);
    assert_false(contains(stated.err, "--fit white-level"));  // it is stated
    assert_close(corner_error(measured({bright, "--black", "0.225", "--fit", "white-level=4.5"})), 0.0, 0.003);
}

// Every page of a dark frame counts.
void test_pages_of_dark_frames(void **) {
    Card card;
    card.slant = 0.0, card.black = 0.05;
    const std::string file = shoot("paged.tif", card), pages = in_folder("dark_pages.tif");
    card.dark = true;
    TIFF *tiff = TIFFOpen(pages.c_str(), "w");
    for (const double level : {0.03, 0.05, 0.05}) {
        card.black = level;
        const Picture page = read_picture(shoot("one_page.tif", card));
        TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width), TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height);
        TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 16), TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 3);
        TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB), TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, height);
        TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
        std::vector<uint8_t> bytes = page.pixels;
        assert_true(TIFFWriteEncodedStrip(tiff, 0, bytes.data(), static_cast<tmsize_t>(bytes.size())) > 0);
        assert_int_equal(TIFFWriteDirectory(tiff), 1);
    }
    TIFFClose(tiff);
    const Json json = json_of(
        flat({file, "--linear", "--no-store", "--json", "--light", "even", "--fit", "center=fixed", "--dark", pages}));
    assert_close(json["levels"]["black"][0].get<double>(), 0.05, 0.001);  // the median; 0.03 of the first page alone
}

// Rotated shots without stated angles: the refusal names the options.
void test_rotated_shots_of_unknown_angles(void **) {
    Words files;
    for (const int turn : {0, 90, 180}) {
        Card card;
        card.rotation_deg = turn;
        files.push_back(shoot("unknown" + std::to_string(turn) + ".tif", card));
    }
    const Words words = flat(files) + Words{"--linear", "--no-store"};
    assert_refused(not_usable, words, {"--rotation or --turned", "--fit own-light=yes"});
    const Json json = json_of(words + Words{"--json", "--fit", "own-light=yes"});
    assert_true(json["usable"] == true);
    assert_close(corner_error(json), 0.0, 0.01);
}

// A profile is stored in the frame of the sensor, which is wider than high: of a card that was rotated either way, what
// the turn does not change. Pictures of both shapes are then even but for what differs between opposite sides.
void test_portrait_cards(void **) {
    Card card;
    card.slant = 0.0;
    const std::string lying = shoot("lying.tif", card), standing = stand_up(lying, "standing.tif");
    const Words db = {"--db", in_folder("standing.db")},
                setting = {"--camera", "Box 1", "--lens", "Box lens", "--focal", "35", "--aperture", "2"};
    const Outcome run = run_words(flat({standing, "--linear"}) + setting + db);
    assert_int_equal(run.code, done);
    assert_true(contains(run.err, "no orientation states which way this portrait picture was rotated"));
    const Json stored = json_of(Words{"profile", "show", "1", "--json"} + db)["vignetting"];
    assert_true(stored["center"] == Json({0.0, 0.0}));
    for (const std::string &file : {lying, standing}) {
        must_exit(done, Words{"apply", "-o", in_folder("even"), file, "--key", "processing=raw"} + setting + db);
        const Picture even = read_picture(in_folder("even/" + std::filesystem::path(file).filename().string()));
        const auto mean = [&](uint32_t left, uint32_t top) {
            double sum = 0.0;
            for (uint32_t y = top; y < top + 16; y++)
                for (uint32_t x = left; x < left + 16; x++)
                    sum += reinterpret_cast<const uint16_t *>(even.pixels.data())[3 * (y * even.width + x) + 1];
            return sum;
        };
        const uint32_t right = even.width - 16, bottom = even.height - 16;
        const double corners = mean(0, 0) + mean(right, 0) + mean(0, bottom) + mean(right, bottom);
        assert_close(corners / (4.0 * mean(right / 2, bottom / 2)), 1.0, 0.015);
    }
}

void test_exposures_come_from_exif_or_the_command_line(void **) {
    Card card;
    card.gamma = 2.2, card.told = true;
    Words files;
    for (double ev : {-2.0, -1.0, 0.5}) {
        card.ev = ev;
        files.push_back(shoot("ev" + std::to_string(files.size()) + ".tif", card));
    }
    const Words words = flat(files) + Words{"--fit", "gamma=2.2", "--shots", "1,1,1", "--no-store", "--json"};
    const Json json = json_of(words);
    assert_int_equal(json["shots"].get<int>(), 1);
    assert_close(corner_error(json), 0.0, 0.004);
    assert_close(json["images"][2]["ev"].get<double>() - json["images"][0]["ev"].get<double>(), 2.5, 0.01);
    for (const Json &image : json["images"]) assert_close(image["ev_residual"].get<double>(), 0.0, 0.02);
    const Json given = json_of(words + Words{"--ev", "-2,-1,0.5"});
    assert_close(corner_error(given), 0.0, 0.004);
    const Json wrong = json_of(words + Words{"--ev", "-2,-1.6,0.5"}, not_usable);
    assert_true(contains(text_of(wrong), "EV away"));
    assert_string_equal(code_of(wrong).c_str(), "flat_exposure_wrong");
    const std::string file = wrong["images"][1]["file"];  // the picture with the wrong exposure
    assert_true(contains(text_of(wrong), file));
    assert_true(wrong["findings"][0]["item"] == Json({{"kind", "image"}, {"index", 1}, {"file", file}}));
    assert_true(wrong["findings"][0]["values"].size() == 1 && wrong["findings"][0]["values"][0].get<double>() > 0.3);
}

void test_a_card_at_several_places(void **) {
    Words files;
    for (int i = 0; i < 3; i++) {
        Card card;
        card.slant = 0.0, card.left = i / 3.0, card.right = (i + 1) / 3.0;
        files.push_back(shoot("place" + std::to_string(i) + ".tif", card));
    }
    const Words words = flat(files) + Words{"--linear", "--several", "--ev", "0,0,0", "--no-store", "--json"};
    const Json found = json_of(words + Words{"--card", "find"});
    assert_close(corner_error(found), 0.0, 0.01);
    assert_close(found["images"][1]["card"][0].get<double>(), 120, 12);
    const Json given =
        json_of(words + Words{"--card", "0,0,118,270", "--card", "122,0,116,270", "--card", "242,0,118,270"});
    assert_close(corner_error(given), 0.0, 0.01);
}

void test_the_response_of_a_profile(void **) {
    Card card;
    const std::string linear = shoot("first.tif", card), db = in_folder("response.db");
    must_exit(done, flat({linear, "--linear", "--camera", "Box", "--db", db}));
    const Json json = json_of(flat({linear, "--fit", "profile=1", "--camera", "Box", "--db", db, "--json"}));
    assert_string_equal(json["response"]["kind"].get<std::string>().c_str(), "linear");
    assert_refused(not_found, flat({linear, "--fit", "profile=99", "--camera", "Box", "--db", db}), {"99"});
}

void test_what_is_not_usable_is_not_stored(void **) {
    Card card;
    card.texture = 0.06;
    const std::string path = shoot("cloth.tif", card), db = in_folder("cloth.db");
    const Words words = flat({path, "--linear", "--camera", "Box", "--db", db});
    assert_refused(not_usable, words, {"texture", "nothing was stored"});
    const Json json = json_of(words + Words{"--json", "--force"}, not_usable);
    assert_false(json["usable"].get<bool>());
    assert_int_equal(json["profile"].get<int>(), 1);
    const Json stored = json_of({"profile", "show", "1", "--json", "--db", db});
    assert_string_equal(stored["provenance"]["method"].get<std::string>().c_str(), "flat");
    assert_true(stored["provenance"]["forced"].get<bool>());
}

void test_grey_pictures_and_the_grid(void **) {
    Card card;
    card.layout = LENSPROF_LAYOUT_GREY;
    const std::string path = shoot("grey.png", card);
    const Json json = json_of(flat({path, "--linear", "--no-store", "--json", "--fit", "grid=always,center=fixed"}));
    assert_int_equal(json["vignetting"]["k"].size(), 1);
    assert_true(json["gain_grid"]["columns"].get<int>() > 4);
    assert_int_equal(json["gain_grid"]["attenuation"].size(), 1);
    assert_close(json["vignetting"]["center"][0].get<double>(), 0.0, 0.0);
}

// A gain grid that grows as u^2 to both sides, u = -1..1: on a circle of r, u is r cos(angle) times the half diagonal
// over the half width, sqrt(1 + 1 / aspect^2), and the mean of the squared cosine is 1/2.
void test_light_on_a_circle_has_the_shape_of_the_picture(void **) {
    const auto profile = lensprof::new_profile();
    profile->vignettings = 1;
    lensprof_gain_grid &grid = profile->grid;
    grid.columns = 17, grid.rows = 2;
    for (uint32_t channel = 0; channel < 3; channel++)
        for (uint32_t i = 0; i < 34; i++) {
            const double u = (i % 17) / 8.0 - 1.0;
            grid.attenuation[channel * 34 + i] = static_cast<float>(1.0 + 0.5 * u * u);
        }
    for (const double aspect : {4.0, 1.5, 1.0, 0.75}) {
        const double mean = 1.0 + 0.5 * 0.25 * 0.5 * (1.0 + 1.0 / (aspect * aspect));
        assert_close(lensprof::mean_light(*profile, 1, 0.5, aspect), mean, 0.002);
    }
}

void test_refused(void **) {
    Card card;
    const std::string path = shoot("card.tif", card), other = shoot("card2.tif", card);
    card.layout = LENSPROF_LAYOUT_GREY;
    const std::string grey = shoot("grey.tif", card), text = in_folder("text.tif"), db = in_folder("refused.db");
    save(text, Bytes{'n', 'o'});
    Picture tiny = make_smooth(40, 30, LENSPROF_LAYOUT_RGB), wide = make_smooth(400, 90, LENSPROF_LAYOUT_RGB);
    write_picture(in_folder("tiny.png"), tiny);
    write_picture(in_folder("wide.png"), wide);
    const Words good{"--linear", "--camera", "Box", "--db", db};
    struct Case {
        int code;
        Words words, named;
    };
    const Case cases[] = {
        {usage, {}, {"FILE"}},
        {usage, {path}, {"--linear", "--fit gamma=", "--fit profile="}},
        {usage, {path, "--linear", "--fit", "gamma=2"}, {"one of"}},
        {usage, {path, "--fit", "gamma=11", "--no-store"}, {"--fit gamma"}},
        {usage, {path, "--fit", "gamma=nan", "--no-store"}, {"--fit gamma"}},
        {usage, {path, "--linear"}, {"card.tif", "--camera"}},
        {usage, Words{path, other, "--shots", "1,1"} + good, {"card.tif", "--ev"}},
        {usage, Words{path, other, "--several"} + good, {"card.tif", "--ev"}},
        {usage, Words{path, other, "--shots", "1"} + good, {"--shots"}},
        {usage, Words{path, other, "--shots", "1,1.5"} + good, {"--shots"}},
        {usage, Words{path, other, "--ev", "1,x"} + good, {"--ev"}},
        {usage, Words{path, other, "--ev", "1,"} + good, {"--ev"}},
        {usage, Words{path, other, "--ev", "1,99"} + good, {"card2.tif", "64 EV"}},
        {usage, Words{path, other, "--rotation", "0"} + good, {"--rotation"}},
        {usage, Words{path, other, "--rotation", "0,400"} + good, {"--rotation"}},
        {usage, Words{path, "--light", "bright"} + good, {"--light"}},
        {usage, Words{path, "--light", "plane", "--several"} + good, {"--several"}},
        {usage, Words{path, "--fit", "light=even"} + good, {"--fit light is now --light; `lensprof flat --help-all`"}},
        {usage, Words{path, "--card", "1,2,3"} + good, {"--card"}},
        {usage, Words{path, "--card", "0,0,361,270"} + good, {"--card", "360 x 270", "card.tif"}},
        {usage, Words{path, "--card", "0,0,10,10", "--card", "find"} + good, {"--card", "find"}},
        {usage,
         Words{path, other, grey, "--card", "0,0,9,9", "--card", "0,0,9,9"} + good,
         {"--card: 2 values for 3 pictures"}},
        {usage, Words{path, grey} + good, {"grey.tif"}},
        {usage, Words{grey, "--fit", "falloff-curves=3"} + good, {"grey"}},
        {unreadable, Words{path, in_folder("wide.png")} + good, {"wide.png", "400 x 90"}},
        {usage, Words{path, other, path} + good, {"card.tif", "twice"}},
        {usage, Words{path, "--fit", "ignore-below=0.9,ignore-above=0.5"} + good, {"--fit ignore-below"}},
        {usage, Words{path, "--fit", "max-side=10"} + good, {"--fit max-side"}},
        {usage, Words{path, "--no-store"} + good, {"--no-store"}},
        {unreadable, Words{in_folder("nothing.tif")} + good, {"nothing.tif"}},
        {unreadable, Words{text} + good, {"text.tif"}},
        {not_usable, Words{in_folder("tiny.png")} + good, {"tiny.png"}},
        {not_usable, Words{path, "--fit", "ignore-above=0.02"} + good, {"black and white"}},
        {store_failed, {path, "--linear", "--camera", "Box", "--db", text}, {"text.tif"}},
        {store_failed, {path, "--linear", "--camera", "Box", "--db", in_folder("no/such.db")}, {"no/such.db"}},
        {store_failed, {path, "--linear", "--camera", "Box", "--db", "/proc/lensprof/p.db"}, {"/proc/lensprof"}},
    };
    for (const Case &one : cases) {
        assert_refused(one.code, flat(one.words), one.named);
        if (one.code != not_usable) continue;
        const Json json = json_of(flat(one.words) + Words{"--json"}, not_usable);
        assert_false(json["usable"].get<bool>());
        assert_string_equal(code_of(json).c_str(), "flat_few_cells");
        assert_true(json["images"][0]["file"] == one.words[0] && json["profile"].is_null());
        assert_true(json["vignetting"]["k"] == Json({{0.0, 0.0, 0.0}}) && json["corner_sigma"].is_null());
    }
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_rotated_shots_are_measured_and_stored),
        CLI_TEST(test_the_light_is_stated),
        CLI_TEST(test_the_card_is_corrected),
        CLI_TEST(test_an_image_circle),
        CLI_TEST(test_the_black_level),
        CLI_TEST(test_levels_of_float_samples),
        CLI_TEST(test_pages_of_dark_frames),
        CLI_TEST(test_rotated_shots_of_unknown_angles),
        CLI_TEST(test_portrait_cards),
        CLI_TEST(test_exposures_come_from_exif_or_the_command_line),
        CLI_TEST(test_a_card_at_several_places),
        CLI_TEST(test_the_response_of_a_profile),
        CLI_TEST(test_what_is_not_usable_is_not_stored),
        CLI_TEST(test_grey_pictures_and_the_grid),
        CLI_TEST(test_light_on_a_circle_has_the_shape_of_the_picture),
        CLI_TEST(test_refused),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
