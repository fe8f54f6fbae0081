// `lensprof align --merge`: frames of known light must give that light, beyond white and down to black.
#ifdef LENSPROF_HAS_OPENEXR  // before cmocka, which defines a macro skip
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#endif

#include "cli_runs.hpp"

using namespace cli_runs;

namespace {

constexpr uint32_t width = 200, height = 120;

double encode(double x) { return std::pow(std::min(std::max(x, 0.0), 1.0), 1 / 2.2); }

// Soft blobs over nine stops; 1 is white in a frame at 0 EV.
double light(uint32_t x, uint32_t y, uint32_t c) {
    const double u = x / 23.0, v = y / 17.0;
    return 0.3 * std::exp2(4.5 * std::sin(0.4 * u + 0.1 * c) * std::cos(0.5 * v));
}

// Frames of 16 bits with noise of half a level of 255.
Words make_frames(const std::vector<double> &ev, const char *end = ".png") {
    fs::create_directories(work("in"));
    Words files;
    uint64_t random = 1;
    for (size_t i = 0; i < ev.size(); ++i) {
        Picture frame = make_noise(width, height, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB);
        for (uint32_t y = 0; y < height; ++y)
            for (uint32_t x = 0; x < width; ++x)
                for (uint32_t c = 0; c < 3; ++c) {
                    double noise = 0;
                    for (int k = 0; k < 12; ++k)
                        noise +=
                            static_cast<double>((random = random * 6364136223846793005u + 1442695040888963407u) >> 40)
                                / 16777216
                            - 0.5;
                    const double grey = encode(light(x, y, c) * std::exp2(ev[i])) + noise * 0.5 / 255;
                    reinterpret_cast<uint16_t *>(frame.pixels.data() + y * frame.row_bytes)[3 * x + c] =
                        static_cast<uint16_t>(std::lround(65535 * std::min(std::max(grey, 0.0), 1.0)));
                }
        files.push_back(work("in/h" + std::to_string(i) + end));
        write_picture(files.back(), frame);
    }
    return files;
}

const std::vector<double> bracket_ev = {0.0, -2.5, 2.5, -5.0};

// Error of a merged picture in stops, pixel by pixel: the largest, and the RMS. Gamma is open, so a line is first
// fitted to the logarithms.
void errors_of(const Picture &merged, double &largest, double &rms, double &brightest) {
    double n = 0, a = 0, b = 0, aa = 0, ab = 0, bb = 0;
    brightest = 0;
    const auto each = [&](auto use) {
        for (uint32_t y = 0; y < height; ++y)
            for (uint32_t x = 0; x < width; ++x)
                for (uint32_t c = 0; c < 3; ++c)
                    use(std::log2(light(x, y, c)), std::log2(static_cast<double>(reinterpret_cast<const float *>(
                                                       merged.pixels.data() + y * merged.row_bytes)[3 * x + c])));
    };
    each([&](double truth, double found) {
        assert_true(std::isfinite(found));
        brightest = std::max(brightest, found);
        n += 1, a += truth, b += found, aa += truth * truth, ab += truth * found, bb += found * found;
    });
    const double slope = (n * ab - a * b) / (n * aa - a * a), level = (b - slope * a) / n;
    largest = 0;
    double sum = 0;
    each([&](double truth, double found) {
        const double off = (found - level) / slope - truth;
        largest = std::max(largest, std::fabs(off)), sum += off * off;
    });
    rms = std::sqrt(sum / n);
}

void test_light_beyond_white(void **) {
    const Words frames = make_frames(bracket_ev);
    const std::string out = work("hdr.tif");
    const Json json = json_of(Words{"align", "--merge", out, "--to", "first", "--json"} + frames);
    assert_int_equal(json["frames"].size(), 4);
    assert_string_equal(json["frames"][3]["output"].get<std::string>().c_str(), out.c_str());
    assert_false(fs::exists("aligned"));
    const Picture merged = read_picture(out);
    assert_int_equal(merged.sample, LENSPROF_SAMPLE_F32);
    assert_true(merged.width == width && merged.height == height);
    double largest, rms, brightest;
    errors_of(merged, largest, rms, brightest);
    print_message("error %.3f stops RMS, %.3f at most; brightest %.2f stops above white\n", rms, largest, brightest);
    assert_true(rms < 0.02 && largest < 0.2);
    assert_true(brightest > 1.5);  // out of 2.76, up to gamma
    // Another order samples other pairs.
    const Words rotated = {frames[0], frames[3], frames[2], frames[1]};
    must_exit(done, Words{"align", "--merge", work("again.tif"), "--to", "first"} + rotated);
    double again[3];
    errors_of(read_picture(work("again.tif")), again[0], again[1], again[2]);
    assert_true(again[0] < 0.2 && again[1] < 0.02);
    const auto metadata = read_metadata(out);
    assert_true(metadata.mark && metadata.mark->linear);
}

#ifdef LENSPROF_HAS_OPENEXR
std::vector<float> read_exr(const std::string &path) {
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    assert_true(window.max.x + 1 == int(width) && window.max.y + 1 == int(height));
    std::vector<float> pixels(size_t(3) * width * height, -1.0f);
    Imf::FrameBuffer frame;
    const char *names[] = {"R", "G", "B"};
    for (size_t c = 0; c < 3; c++)
        frame.insert(names[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char *>(pixels.data() + c), 12, 12 * width));
    file.setFrameBuffer(frame);
    file.readPixels(0, window.max.y);
    return pixels;
}
#endif

// OpenEXR holds the same numbers as TIFF, or is refused with the next step.
void test_openexr(void **) {
    const Words frames = make_frames({0.0, -2.0});
    const Words to_exr = Words{"align", "--merge", work("hdr.exr")} + frames;
    if (!can_write_exr()) {
        assert_refused(usage, to_exr, {"hdr.exr", "libopenexr-dev"});
        return;
    }
    must_exit(done, to_exr);
    must_exit(done, Words{"align", "--merge", work("hdr.tif")} + frames);
    must_exit(done, {"bracket", frames[0], frames[1], "--ev", "0,-2", "--camera", "C", "--db", work("c.db")});
    const Words linear = {"apply", "--profile", "1", "--db", work("c.db"), "--linear", frames[0], "-o", work("light")};
    must_exit(done, linear);
    must_exit(done, linear + Words{"--encoding", "linear=exr"});
    assert_refused(usage, {"align", "--merge", work("y.png"), frames[0], frames[1]}, {"y.png"});
    assert_refused(usage, {"apply", "--profile", "1", "--db", work("c.db"), "--encoding", "linear=exr", frames[0]},
                   {"--linear"});
    // A light file of other pictures is not replaced, one of the same pictures is.
    must_exit(done, to_exr);
    must_exit(done, linear + Words{"--encoding", "linear=exr"});
    const std::string other = work("other/h0.png");
    fs::create_directories(work("other"));
    fs::copy_file(frames[1], other);
    assert_refused(usage,
                   {"apply", "--profile", "1", "--db", work("c.db"), "--linear", "--encoding", "linear=exr", other,
                    "-o", work("light")},
                   {"light/h0.exr", "made from another picture (h0.png)", "--overwrite"});
    assert_refused(usage, {"align", "--merge", work("hdr.exr"), other, frames[0]}, {"hdr.exr", "--overwrite"});
#ifdef LENSPROF_HAS_OPENEXR
    for (const std::string &name : {work("hdr"), work("light/h0")}) {
        const Picture tiff = read_picture(name + ".tif");
        assert_memory_equal(read_exr(name + ".exr").data(), tiff.pixels.data(), tiff.pixels.size());
    }
#endif
}

// Pixels that are white in all frames get their value from the darkest frame; black ones, from the brightest.
void test_beyond_all_frames(void **) {
    const Words frames = make_frames({0.0, 1.5, 3.0});
    const std::string out = work("bright.tif");
    must_exit(done, Words{"align", "--merge", out, "--to", "first"} + frames);
    double largest, rms, brightest;
    errors_of(read_picture(out), largest, rms, brightest);
    assert_close(brightest, 0.0, 0.02);
    assert_true(largest > 1.0);
}

// Saturated colours: if red is almost zero, or the only colour, the frames that show the pixel well determine it.
void test_saturated_colours(void **) {
    Words frames = make_frames({0.0, -2.0, 3.0});
    for (size_t i = 0; i < frames.size(); i++) {
        Picture frame = read_picture(frames[i]);
        const double gain = std::exp2(std::vector<double>{0.0, -2.0, 3.0}[i]);
        for (uint32_t y = 40; y < 60; ++y)
            for (uint32_t x = 50; x < 90; ++x) {
                auto *pixel = reinterpret_cast<uint16_t *>(frame.pixels.data() + y * frame.row_bytes) + 3 * x;
                const bool is_red = x < 70;
                for (uint32_t c = 0; c < 3; ++c)
                    pixel[c] = (c == 0) == is_red ? static_cast<uint16_t>(std::lround(65535 * encode(0.5 * gain))) : 0;
            }
        write_picture(frames[i], frame);
    }
    const std::string out = work("red.tif");
    must_exit(done, Words{"align", "--merge", out, "--to", "first"} + frames);
    const Picture merged = read_picture(out);
    const auto at = [&](uint32_t x, uint32_t c) {
        return reinterpret_cast<const float *>(merged.pixels.data() + 50 * merged.row_bytes)[3 * x + c];
    };
    // Half of white in the frame at 0 EV, up to gamma; white in the brightest frame.
    const double half = at(60, 0);
    print_message("red %.3f, green and blue next to it %.3f\n", half, double(at(80, 1)));
    assert_true(half > 0.3 && half < 0.7);
    assert_close(at(80, 1), half, 0.05);
    assert_close(at(80, 2), half, 0.05);
    for (uint32_t c : {1u, 2u}) assert_true(at(60, c) < 0.01);
    assert_true(at(80, 0) < 0.01);
}

void test_refusals(void **) {
    const Words frames = make_frames({0.0, -2.0});
    const auto refuse = [&](int code, const Words &words, const char *said) {
        assert_refused(code, Words{"align"} + words, {said});
    };
    refuse(usage, Words{"--merge", work("out.png")} + frames, ".tif");
    refuse(usage, Words{"--merge", work("out.tif"), "--project", work("x.pto")}, "--project");
    refuse(usage, Words{"--merge", work("out.tif"), "-o", work("frames")} + frames, "--output");
    refuse(usage, Words{"--merge", work("none/out.tif")} + frames, "none/out.tif");
    save_text(work("mine.tif"), "not a picture of lensprof's");
    refuse(usage, Words{"--merge", work("mine.tif")} + frames, "--overwrite");
    must_exit(done, Words{"align", "--overwrite", "--merge", work("mine.tif")} + frames);
    const Words tiffs = make_frames({0.0, -2.0}, ".tif");
    refuse(usage, Words{"--merge", tiffs[1]} + tiffs, "h1.tif");
    Picture alpha = make_noise(width, height, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGBA);
    write_picture(work("alpha.png"), alpha);
    const Outcome transparent = run_words({"align", "--merge", work("t.tif"), work("alpha.png"), frames[0]});
    assert_true(transparent.code != done && !fs::exists(work("t.tif")));
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        CLI_TEST(test_light_beyond_white), CLI_TEST(test_openexr),  CLI_TEST(test_beyond_all_frames),
        CLI_TEST(test_saturated_colours),  CLI_TEST(test_refusals),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
