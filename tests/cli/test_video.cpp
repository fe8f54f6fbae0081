// Frames of videos that ffmpeg encodes, compared with the frames that it decodes.
#include <cstdlib>

#include "picture_files.hpp"

#include "photo/pictures/thumbnail.hpp"
#include "photo/video/video.hpp"

using namespace picture_files;

namespace {

constexpr uint32_t width = 96;  // of 64 rows

bool has_ffmpeg = false;

int shell(const std::string &command) { return std::system((command + " </dev/null >/dev/null 2>&1").c_str()); }

std::string quoted(const std::string &name) { return "'" + in_folder(name) + "'"; }

// Encodes 12 frames of a test picture, or of what `input` describes.
std::string encode(const std::string &name, const std::string &options,
                   const std::string &input = "testsrc2=size=96x64:rate=10") {
    if (shell("ffmpeg -y -f lavfi -i " + input + " -frames:v 12 " + options + " " + quoted(name))) skip();
    return in_folder(name);
}

void cut_to(const std::string &path, double share) {
    fs::resize_file(path, static_cast<uintmax_t>(share * double(fs::file_size(path))));
}

std::vector<VideoFrame> frames_of(const std::string &path) {
    VideoReader reader(path);
    std::vector<VideoFrame> frames;
    for (VideoFrame frame; reader.next(frame); frames.push_back(frame)) reader.read(frame.picture);
    return frames;
}

// The largest mean difference of a frame from that of ffmpeg, levels of 255.
double difference(const std::string &name, const std::string &scale, bool is_deep) {
    const std::string flags = "accurate_rnd+full_chroma_int+full_chroma_inp+bicubic";
    assert_int_equal(
        shell("ffmpeg -y -noautorotate -i " + quoted(name) + " -vf scale=" + scale + "out_range=full:flags=" + flags
              + " -pix_fmt " + (is_deep ? "rgb48le" : "rgb24") + " -f rawvideo " + quoted("frames.raw")),
        0);
    const Bytes wanted = load(in_folder("frames.raw"));
    const auto frames = frames_of(in_folder(name));
    assert_int_equal(frames.size(), 12);
    assert_int_equal(wanted.size(), 12 * frames[0].picture.pixels.size());
    double largest = 0.0;
    size_t n = 0;
    for (const VideoFrame &frame : frames) {
        assert_int_equal(frame.picture.sample, is_deep ? LENSPROF_SAMPLE_U16 : LENSPROF_SAMPLE_U8);
        double sum = 0.0;
        const Bytes &found = frame.picture.pixels;
        const size_t step = is_deep ? 2 : 1;
        for (size_t i = 0; i < found.size(); i += step, n += step)
            sum += std::abs(is_deep ? (found[i] + 256.0 * found[i + 1] - wanted[n] - 256.0 * wanted[n + 1]) / 257.0
                                    : double(found[i]) - wanted[n]);
        largest = std::max(largest, sum * double(step) / double(found.size()));
    }
    return largest;
}

// Codecs, matrices, ranges and depths.
void test_pixels(void **) {
    if (!has_ffmpeg) skip();
    encode("a.mp4", "-c:v libx264 -crf 12 -pix_fmt yuv420p -colorspace bt709 -color_range tv");
    assert_true(difference("a.mp4", "in_color_matrix=bt709:in_range=tv:", false) < 0.3);
    assert_true(difference("a.mp4", "in_color_matrix=bt601:in_range=tv:", false) > 1.0);
    encode("b.mp4", "-c:v libx264 -crf 12 -pix_fmt yuv422p -colorspace smpte170m -color_range pc");
    assert_true(difference("b.mp4", "in_color_matrix=bt601:in_range=full:", false) < 0.3);
    encode("c.mp4", "-c:v libx265 -crf 12 -pix_fmt yuv420p10le -colorspace bt709 -color_range tv");
    assert_true(difference("c.mp4", "in_color_matrix=bt709:in_range=tv:", true) < 0.3);
    encode("d.avi", "-c:v mjpeg -q:v 2 -pix_fmt yuvj420p");
    assert_true(difference("d.avi", "in_color_matrix=bt601:in_range=full:", false) < 0.3);
    encode("e.mkv", "-c:v ffv1 -pix_fmt bgr0");
    assert_true(difference("e.mkv", "", false) < 0.01);
    encode("f.webm", "-c:v libvpx-vp9 -crf 10 -b:v 0 -pix_fmt yuv420p");
    assert_true(difference("f.webm", "in_color_matrix=bt601:in_range=tv:", false) < 0.3);
}

// Known colours, without any help of ffmpeg's decoder.
void test_known_colours(void **) {
    if (!has_ffmpeg) skip();
    struct {
        const char *colour;
        int rgb[3];
    } const cases[] = {{"0xC86432", {200, 100, 50}}, {"white", {255, 255, 255}}, {"black", {0, 0, 0}}};
    for (const auto &[colour, rgb] : cases)
        for (const char *range : {"tv", "pc"}) {
            const std::string to = std::string(range) == "tv" ? "tv" : "full";
            const std::string path = encode("flat.mkv",
                                            "-vf scale=out_color_matrix=bt709:out_range=" + to
                                                + ",format=yuv444p -c:v ffv1 -colorspace bt709 -color_range " + range,
                                            std::string("color=c=") + colour + ":size=96x64:rate=10");
            const Picture picture = frames_of(path).at(3).picture;
            for (int c = 0; c < 3; c++) assert_close(picture.pixels[(30 * width + 40) * 3 + size_t(c)], rgb[c], 1.5);
        }
    const std::string path =
        encode("grey.mkv", "-c:v ffv1 -pix_fmt gray -color_range pc", "color=c=0x808080:size=96x64:rate=10");
    assert_close(frames_of(path).at(0).picture.pixels[0], 128, 1.0);
}

void test_times(void **) {
    if (!has_ffmpeg) skip();
    const auto even = frames_of(encode("even.mp4", "-c:v mpeg4"));
    assert_int_equal(even.size(), 12);
    assert_close(even[11].seconds, 1.1, 1e-6);
    const auto odd = frames_of(encode("odd.mkv",
                                      "-vf settb=1/1000,setpts=N*N*10 -vsync passthrough -enc_time_base 1:1000 "
                                      "-c:v libx264 -bf 0"));
    assert_int_equal(odd.size(), 12);
    for (size_t i = 0; i < odd.size(); i++) assert_close(odd[i].seconds, double(i * i) * 0.01, 0.002);
}

// Turned upright, a frame is that which ffmpeg shows.
void test_rotation(void **) {
    if (!has_ffmpeg) skip();
    encode("straight.mp4", "-c:v mpeg4");
    assert_int_equal(VideoReader(in_folder("straight.mp4")).info().orientation, 1);
    for (const std::string degrees : {"90", "180", "270"}) {
        if (shell("ffmpeg -y -display_rotation:v " + degrees + " -i " + quoted("straight.mp4") + " -c copy "
                  + quoted("turned.mp4"))
            && shell("ffmpeg -y -i " + quoted("straight.mp4") + " -c copy -metadata:s:v:0 rotate=" + degrees + " "
                     + quoted("turned.mp4")))
            skip();
        shell("ffmpeg -y -i " + quoted("turned.mp4") + " -frames:v 1 -pix_fmt rgb24 -f rawvideo "
              + quoted("shown.raw"));
        const Bytes shown = load(in_folder("shown.raw"));
        VideoReader reader(in_folder("turned.mp4"));
        VideoFrame frame;
        assert_true(reader.next(frame));
        reader.read(frame.picture);
        assert_int_equal(frame.picture.width, width);
        assert_true(reader.info().orientation != 1);
        const Picture upright = upright_copy(frame.picture, reader.info().orientation, width);
        assert_int_equal(shown.size(), upright.pixels.size());
        double sum = 0.0;
        for (size_t i = 0; i < shown.size(); i++) sum += std::abs(double(shown[i]) - upright.pixels[i]);
        assert_in_range(static_cast<int>(sum / double(shown.size())), 0, 12);  // ffmpeg shows coarser colours
    }
}

// The number of frames in the message of a cut file.
size_t frames_before_cut(const std::string &path) {
    const std::string text = failure_of(LENSPROF_ERROR_READ, [&] { frames_of(path); });
    const size_t place = text.find(" after ");
    assert_true(text.rfind(path + ": is damaged or cut", 0) == 0 && place != std::string::npos);
    return size_t(std::atoi(text.c_str() + place + 7));
}

void test_cut_files(void **) {
    if (!has_ffmpeg) skip();
    const std::string mp4 = encode("cut.mp4", "-c:v libx264 -crf 12 -bf 0 -g 1 -movflags faststart");
    cut_to(mp4, 0.6);
    const size_t count = frames_before_cut(mp4);
    assert_true(count > 2 && count < 12);
    const std::string unfinished = encode("unfinished.mp4", "-c:v mpeg4");
    cut_to(unfinished, 0.5);
    assert_failure(LENSPROF_ERROR_READ, "unfinished.mp4: is a video (MP4) that cannot be opened",
                   [&] { frames_of(unfinished); });
    const std::string mkv = encode("cut.mkv", "-c:v mjpeg -q:v 2");
    cut_to(mkv, 0.3);
    assert_true(frames_before_cut(mkv) < 12);
    const std::string avi = encode("cut.avi", "-c:v mjpeg -q:v 2");
    cut_to(avi, 0.4);
    assert_true(frames_before_cut(avi) < 12);
}

void test_refusals(void **) {
    if (!has_ffmpeg) skip();
    const std::string transfers[][2] = {{"smpte2084", "PQ"}, {"arib-std-b67", "HLG"}, {"log100", "log"}};
    for (const auto &[transfer, name] : transfers) {
        const std::string path = encode("hdr.mp4", "-c:v libx264 -pix_fmt yuv420p -color_trc " + transfer);
        assert_failure(LENSPROF_ERROR_READ, "hdr.mp4: its transfer function is " + name, [&] { frames_of(path); });
    }
    if (shell("ffmpeg -y -f lavfi -i sine -t 0.2 " + quoted("sound.mkv"))) skip();
    assert_failure(LENSPROF_ERROR_READ, "sound.mkv: contains no video", [&] { frames_of(in_folder("sound.mkv")); });
    save(in_folder("text.mp4"), Bytes(5000, 'x'));
    assert_failure(LENSPROF_ERROR_READ, "text.mp4: is a video that cannot be opened",
                   [&] { frames_of(in_folder("text.mp4")); });
    encode("small.h264", "-c:v libx264 -pix_fmt yuv420p");
    encode("large.h264", "-c:v libx264 -pix_fmt yuv420p", "testsrc2=size=128x64:rate=10");
    Bytes both = load(in_folder("small.h264"));
    const Bytes more = load(in_folder("large.h264"));
    both.insert(both.end(), more.begin(), more.end());
    save(in_folder("both.h264"), both);
    assert_failure(LENSPROF_ERROR_READ, "frame 13 has 128 x 64 pixels, but those before it have 96 x 64",
                   [&] { frames_of(in_folder("both.h264")); });
}

void test_one_frame(void **) {
    if (!has_ffmpeg) skip();
    const auto one = frames_of(encode("one.mp4", "-frames:v 1 -c:v mpeg4"));
    assert_int_equal(one.size(), 1);
    assert_true(is_video(in_folder("one.mp4")));
    save(in_folder("picture.png"), {0x89, 'P', 'N', 'G'});
    assert_false(is_video(in_folder("picture.png")));
}

int set_up(void **) {
    has_ffmpeg = can_read_video() && shell("ffmpeg -version") == 0;
    if (!has_ffmpeg) print_message("skipped: ffmpeg or libav is missing\n");
    return make_folder(nullptr);
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pixels),    cmocka_unit_test(test_known_colours), cmocka_unit_test(test_times),
        cmocka_unit_test(test_rotation),  cmocka_unit_test(test_cut_files),     cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_one_frame),
    };
    return cmocka_run_group_tests(tests, set_up, remove_folder);
}
