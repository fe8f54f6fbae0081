// Levelled clips: videos with everything else of their source, pictures in a folder, and frames of transforms.json.
#include <sched.h>

#include "clip_scenes.hpp"
#include "program_runs.hpp"

#include "photo/clip/transforms_file.hpp"
#include "photo/video/video.hpp"

using namespace clip_scenes;

namespace {

constexpr uint32_t still_frames = 16, moving_frames = 30;
const Words known = {"--response", "gamma:2.2"};

// What a program prints.
std::string printed(const std::string &command) {
    FILE *pipe = popen(("(" + command + ") </dev/null 2>/dev/null").c_str(), "r");
    std::string text;
    if (!pipe) return text;
    for (int c; (c = std::fgetc(pipe)) != EOF;) text += static_cast<char>(c);
    pclose(pipe);
    return text;
}

// Time stamps and checksums of the packets of a kind of streams, and what ffprobe shows of the video.
std::string packets(const std::string &name, const std::string &kind) {
    return printed("ffmpeg -v error -i " + quoted(name) + " -map 0:" + kind
                   + " -c copy -f framemd5 - | grep -v '^#extradata'");
}
std::string shown(const std::string &name, const std::string &entries) {
    return printed("ffprobe -v error -select_streams v:0 -show_entries " + entries + " -of csv " + quoted(name));
}

std::vector<VideoFrame> frames_of(const std::string &name) {
    VideoReader reader(in_folder(name));
    std::vector<VideoFrame> frames;
    for (VideoFrame frame; reader.next(frame); frames.push_back(frame)) reader.read(frame.picture);
    return frames;
}

double mean_of(const Picture &picture) {
    double sum = 0.0;
    const size_t bytes = picture.sample == LENSPROF_SAMPLE_U16 ? 2 : 1;
    for (size_t n = 0; n < picture.pixels.size() / bytes; n++)
        sum += 255.0 * sample_value(picture.sample, picture.pixels.data(), n);
    return sum / double(picture.pixels.size() / bytes);
}

double mean_difference(const Picture &a, const Picture &b) {
    assert_int_equal(a.pixels.size(), b.pixels.size());
    double sum = 0.0;
    for (size_t n = 0; n < a.pixels.size(); n++) sum += std::abs(int(a.pixels[n]) - int(b.pixels[n]));
    return sum / double(a.pixels.size());
}

// Mean brightness of the frames apart, levels of 255.
double spread(const std::vector<VideoFrame> &frames) {
    double low = 255.0, high = 0.0;
    for (const VideoFrame &frame : frames) {
        low = std::min(low, mean_of(frame.picture)), high = std::max(high, mean_of(frame.picture));
    }
    return high - low;
}

// Times, rotation, colours, shape of pixels, tags, sound and subtitles are those of the source.
void test_all_is_kept(void **) {
    save_text(in_folder("words.srt"), "1\n00:00:00,100 --> 00:00:00,500\nhello\n");
    encoded("still", "plain.mp4",
            "-f lavfi -i sine=frequency=440:duration=1 -i " + quoted("words.srt")
                + " -map 0 -map 1 -map 2 -vf settb=1/12800,setpts='(N*512+mod(N\\,3)*100)' -vsync passthrough "
                  "-enc_time_base 1/12800 -c:v libx264 -crf 8 -pix_fmt yuv420p -bf 2 -c:a aac -c:s mov_text "
                  "-video_track_timescale 12800 -color_range pc -colorspace bt709 -color_primaries bt709 -color_trc "
                  "bt709 -aspect 16:9 -metadata title=Wall -metadata:s:a language=deu");
    if (shell("ffmpeg -y -display_rotation 90 -i " + quoted("plain.mp4") + " -map 0 -c copy " + quoted("turned.mp4"))
        && shell("ffmpeg -y -i " + quoted("plain.mp4") + " -map 0 -c copy -metadata:s:v rotate=90 "
                 + quoted("turned.mp4")))
        skip();
    const Json json = json_of(
        Words{"deflicker", in_folder("turned.mp4"), "-o", in_folder("even.mp4"), "--to", "mean", "--json"} + known);
    assert_string_equal(json["video"]["encoder"].get<std::string>().c_str(), "libx264");
    assert_string_equal(json["video"]["pixels"].get<std::string>().c_str(), "yuv420p");
    const auto before = frames_of("turned.mp4"), after = frames_of("even.mp4");
    assert_int_equal(after.size(), still_frames);
    for (size_t i = 0; i < after.size(); i++) assert_close(after[i].seconds, before[i].seconds, 1e-6);
    assert_true(spread(before) > 15.0 && spread(after) < 0.3 * spread(before));
    assert_true(VideoReader(in_folder("turned.mp4")).info().orientation > 1);
    assert_int_equal(VideoReader(in_folder("even.mp4")).info().orientation,
                     VideoReader(in_folder("turned.mp4")).info().orientation);
    for (const char *kind : {"a", "s"}) {
        assert_true(packets("turned.mp4", kind).size() > 100);
        assert_string_equal(packets("even.mp4", kind).c_str(), packets("turned.mp4", kind).c_str());
    }
    for (const char *entries :
         {"stream=color_range,color_space,color_primaries,color_transfer,sample_aspect_ratio,time_base,start_pts",
          "format_tags=title", "stream_tags=language"}) {
        assert_true(shown("turned.mp4", entries).size() > 10);
        assert_string_equal(shown("even.mp4", entries).c_str(), shown("turned.mp4", entries).c_str());
    }
}

// The loss that is stated is that of the file: a lossless video differs from the pictures only by the conversion.
void test_codecs(void **) {
    const std::string source = encoded("still", "still.mkv", "-c:v libx264 -crf 8 -pix_fmt yuv444p");
    must_exit(done, Words{"deflicker", source, "-o", in_folder("pictures"), "--to", "mean"} + known);
    const auto level = [&](const std::string &name, const Words &codec) {
        return json_of(Words{"deflicker", source, "-o", in_folder(name), "--to", "mean", "--json"} + known
                       + codec)["video"];
    };
    const Json whole = level("whole.mkv", {"--codec", "ffv1"}), coded = level("coded.mkv", {"--codec", "h264:30"}),
               usual = level("usual.mkv", {});
    assert_true(whole["mean_difference"].get<double>() < 0.5);
    assert_true(usual["mean_difference"].get<double>() > whole["mean_difference"].get<double>());
    assert_true(coded["mean_difference"].get<double>() > usual["mean_difference"].get<double>());
    assert_true(coded["largest_difference"].get<double>() >= coded["mean_difference"].get<double>());
    for (const auto &[name, json] : {std::pair{"whole.mkv", &whole}, {"coded.mkv", &coded}}) {
        const auto frames = frames_of(name);
        double sum = 0.0;
        for (const VideoFrame &frame : frames) {
            char file[40];
            std::snprintf(file, sizeof file, "pictures/frame_%05d.png", int(frame.number) + 1);
            sum += mean_difference(frame.picture, read_picture(in_folder(file)));
        }
        assert_close((*json)["mean_difference"].get<double>(), sum / still_frames, 0.1);
    }
    encoded("still", "deep.mkv", "-c:v ffv1 -pix_fmt yuv420p10le");
    const Json deep = json_of(Words{"deflicker", in_folder("deep.mkv"), "-o", in_folder("deep.mp4"), "--json"} + known);
    assert_string_equal(deep["video"]["pixels"].get<std::string>().c_str(), "yuv420p10le");
    assert_int_equal(frames_of("deep.mp4")[0].picture.sample, LENSPROF_SAMPLE_U16);
    const Json web = json_of(Words{"deflicker", source, "-o", in_folder("web.webm"), "--to", "mean", "--json"} + known);
    assert_string_equal(web["video"]["encoder"].get<std::string>().c_str(), "libvpx-vp9");
    assert_true(spread(frames_of("web.webm")) < 0.3 * spread(frames_of("still.mkv")));
}

// One processor, or all. A new program: the threads of OpenCV in this one may hold locks when it forks.
void test_same_bytes(void **) {
    const std::string source = encoded("still", "same.mkv", "-frames:v 8 -c:v libx264 -crf 8 -pix_fmt yuv420p");
    for (const char *codec : {"h264", "h265", "vp9", "ffv1"}) {
        const Words words = Words{"deflicker", source, "--overwrite", "--codec", codec} + known;
        must_exit(done, words + Words{"-o", in_folder("all.mkv")});
        const auto ended = program_runs::run_program(words + Words{"-o", in_folder("one.mkv")}, [] {
            cpu_set_t one;
            CPU_ZERO(&one);
            sched_getaffinity(0, sizeof one, &one);
            for (int cpu = 0, kept = 0; cpu < CPU_SETSIZE; cpu++)
                if (CPU_ISSET(cpu, &one) && kept++) CPU_CLR(cpu, &one);
            sched_setaffinity(0, sizeof one, &one);
        });
        if (ended.code != done) fail_msg("%s: %d, %s", codec, ended.code, ended.err.c_str());
        if (load(in_folder("all.mkv")) != load(in_folder("one.mkv"))) fail_msg("%s: other bytes", codec);
    }
}

void test_video_refusals(void **) {
    const std::string source = encoded("still", "r.mp4", "-f lavfi -i sine=duration=1 -c:v libx264 -c:a aac");
    encoded("still", "one.mp4", "-frames:v 1 -c:v libx264");
    if (shell("ffmpeg -y -f lavfi -i sine=duration=1 " + quoted("sound.mp4"))
        || shell("ffmpeg -y -i " + quoted("r.mp4") + " -c copy -movflags faststart " + quoted("cut.mp4")))
        skip();
    fs::resize_file(in_folder("cut.mp4"), fs::file_size(in_folder("cut.mp4")) / 2);
    save_text(in_folder("there.mp4"), "kept");
    save_text(in_folder("file"), "kept");
    const auto refused = [&](int code, const std::string &clip, const Words &more, const Words &named) {
        assert_refused(code, Words{"deflicker", in_folder(clip)} + more, named);
    };
    const std::string out = in_folder("out.mp4");
    refused(usage, "r.mp4", {"-o", source}, {"r.mp4: is the input"});
    refused(usage, "r.mp4", {"-o", in_folder("there.mp4")}, {"there.mp4: exists", "--overwrite"});
    refused(usage, "r.mp4", {"-o", in_folder("out.avi")}, {"out.avi: videos are written as .mp4, .mov, .mkv or .webm"});
    refused(usage, "r.mp4", {"-o", in_folder("out.webm")}, {"does not hold the sound (aac)", "give a name with .mp4"});
    refused(usage, "r.mp4", {"-o", out, "--codec", "ffv1"}, {"out.mp4: a file of this suffix does not hold ffv1"});
    refused(usage, "r.mp4", {"-o", out, "--codec", "jpeg"}, {"--codec jpeg: is for a folder"});
    refused(usage, "r.mp4", {"-o", in_folder("out"), "--codec", "vp9"}, {"--codec vp9: is for a video"});
    refused(usage, "r.mp4", {"-o", out, "--codec", "h263"}, {"h263: use png, jpeg, h264, h265, vp9 or ffv1"});
    refused(usage, "r.mp4", {"-o", out, "--codec", "ffv1:3"}, {"ffv1 is lossless"});
    for (const char *codec : {"h264:60", "h264:", "h264:-1"})
        refused(usage, "r.mp4", {"-o", out, "--codec", codec}, {codec, "h264 has qualities of 0 to 51"});
    refused(failed, "r.mp4", {"-o", in_folder("file/out.mp4")}, {"file/out.mp4: cannot write"});
    refused(usage, "r.mp4", {"-o", out, "--keep-light"}, {"--keep-light needs"});
    refused(usage, "r.mp4", {"-o", out, "--write", "xmp"}, {"--write xmp"});
    refused(usage, "r.mp4", {"-o", out, "--to", "99"}, {"--to 99"});
    refused(usage, "r.mp4", {"-o", out, "--region", "900,0,10,10"}, {"have 320 x 240 pixels"});
    refused(unreadable, "sound.mp4", {"-o", out}, {"contains no video, only sound"});
    refused(unreadable, "cut.mp4", {"-o", out}, {"cut.mp4: is a video (MP4) that has no frame"});
    refused(not_usable, "one.mp4", {"-o", out}, {"has only one frame"});
    assert_refused(usage, {"deflicker", in_folder("still/images"), "-o", in_folder("o"), "--codec", "png"},
                   {"--codec: is for a video"});
    assert_refused(usage, {"deflicker", in_folder("still/images"), "-o", out},
                   {"out.mp4: a video is written of a video"});
    const Disk before = disk();
    const Words words = Words{"deflicker", source, "-o", out} + known;
    const auto ended = program_runs::run_program(words, [] {
        const rlimit limit{20000, 20000};
        setrlimit(RLIMIT_FSIZE, &limit);
        std::signal(SIGXFSZ, SIG_IGN);
    });
    assert_refusal(words, {ended.code, "", ended.err}, failed, {"out.mp4: cannot be written"}, before);
}

// Frames, tables and charts of a video as of a folder.
void test_options_of_frames(void **) {
    const std::string source = encoded("still", "o.mkv", "-c:v ffv1 -pix_fmt yuv444p");
    must_exit(done, Words{"deflicker", source, "-o", in_folder("jpegs"), "--codec", "jpeg:80", "--to", "frame_00006"}
                        + known);
    const Picture kept = read_picture(in_folder("jpegs/frame_00006.jpg"));
    assert_int_equal(kept.traits.format == FileFormat::jpeg, 1);
    assert_true(mean_difference(kept, frames_of("o.mkv")[5].picture) < 3.0);
    assert_close(mean_of(read_picture(in_folder("jpegs/frame_00014.jpg"))), mean_of(kept), 2.5);
    must_exit(done, Words{"deflicker", source, "-o", in_folder("o.mp4"), "--write", "copies,csv", "--chart",
                          in_folder("o.svg"), "--to", in_folder("jpegs/exposures.csv")}
                        + known);
    assert_true(contains(text_of(in_folder("o.csv")), "\nframe_00016,"));
    assert_true(contains(text_of(in_folder("o.svg")), "</svg>"));
    must_exit(done, Words{"deflicker", source, "-o", in_folder("table"), "--write", "csv"} + known);
    assert_true(fs::exists(in_folder("table/exposures.csv")) && !fs::exists(in_folder("table/frame_00001.png")));
}

// Fields keep their order: the frames that players make of them go forward.
void test_fields_keep_their_order(void **) {
    const auto order = [](const std::string &file) {
        return shown(file, "stream=field_order") + shown(file, "frame=interlaced_frame,top_field_first");
    };
    for (const auto &[field, word, flags] :
         {std::tuple{"tff", "stream,tt\n", "frame,1,1"}, std::tuple{"bff", "stream,bb\n", "frame,1,0"}}) {
        const std::string name = field, levelled = name + "_levelled.mp4";
        encoded("still", name + ".mp4",
                "-frames:v 6 -c:v libx264 -crf 8 -pix_fmt yuv420p -flags +ildct+ilme -x264-params " + name
                    + "=1 -vf setfield=" + name);
        must_exit(done, Words{"deflicker", in_folder(name + ".mp4"), "-o", in_folder(levelled)} + known);
        assert_true(contains(order(levelled), word) && contains(order(levelled), flags));
        assert_string_equal(order(levelled).c_str(), order(name + ".mp4").c_str());
    }
}

// Times begin at 0 where the container is another one, a cover does not become a second video, and odd sizes are coded.
void test_other_containers(void **) {
    encoded("still", "late.ts", "-f lavfi -i sine=duration=1 -c:v libx264 -c:a aac -output_ts_offset 36000");
    must_exit(done, Words{"deflicker", in_folder("late.ts"), "-o", in_folder("late.mp4")} + known);
    assert_true(std::stod(shown("late.ts", "format=start_time").substr(7)) > 36000.0);
    assert_close(std::stod(shown("late.mp4", "format=start_time").substr(7)), 0.0, 0.1);
    assert_true(frames_of("late.mp4").size() == still_frames && packets("late.mp4", "a").size() > 100);
    encoded("still", "covered.mp4",
            "-i " + quoted("still/images/00000.png")
                + " -map 0 -map 1 -frames:v:0 6 -c:v:0 libx264 -c:v:1 png -disposition:v:1 attached_pic");
    must_exit(done, Words{"deflicker", in_folder("covered.mp4"), "-o", in_folder("covered.mkv")} + known);
    assert_string_equal(printed("ffprobe -v error -show_entries stream_disposition=attached_pic -of csv=p=0 "
                                + quoted("covered.mkv") + " | sort | tr -d '\\n'")
                            .c_str(),
                        "01");
    encoded("still", "odd.mkv", "-frames:v 6 -vf crop=319:239:0:0:exact=1 -c:v ffv1 -pix_fmt yuv420p");
    const Outcome odd = run_words(Words{"deflicker", in_folder("odd.mkv"), "-o", in_folder("odd.mp4")} + known);
    assert_int_equal(odd.code, done);
    assert_true(contains(odd.err,
                         "its pixels are yuv444p, not yuv420p as those of the source, which libx264 does not "
                         "code in frames of 319 x 239 pixels"));
    encoded("still", "clear.mkv", "-frames:v 6 -vf format=rgba,colorchannelmixer=aa=0.5 -c:v ffv1 -pix_fmt bgra");
    const Outcome clear = run_words(Words{"deflicker", in_folder("clear.mkv"), "-o", in_folder("opaque.mkv")} + known);
    assert_true(clear.code == done && contains(clear.err, "opaque.mkv: its frames are opaque"));
}

// What deflicker of a clip must not replace.
void test_tables_are_kept(void **) {
    const std::string source = encoded("still", "t.mp4", "-c:v libx264 -crf 8");
    const Words tables = {"deflicker", source, "--write", "copies,csv", "-o"};
    save_text(in_folder("t_out.csv"), "mine\n1\n");
    assert_refused(usage, tables + Words{in_folder("t_out.mp4")}, {"t_out.csv: exists, and no earlier", "--overwrite"});
    assert_refused(usage, tables + Words{in_folder("t_out.mp4"), "--overwrite", "--to", in_folder("t_out.csv")},
                   {"t_out.csv: would be overwritten"});
    must_exit(done, tables + Words{in_folder("t_out.mp4"), "--overwrite"} + known);
    fs::remove(in_folder("t_out.mp4"));
    must_exit(done, tables + Words{in_folder("t_out.mp4")} + known);  // its own table is replaced
    fs::create_directories(folder / "t_frames");
    save_text(in_folder("t_frames/frame_00003.png"), "mine");
    assert_refused(usage, {"deflicker", source, "-o", in_folder("t_frames")},
                   {"frame_00003.png: exists", "--overwrite"});
    must_exit(done, Words{"deflicker", source, "-o", in_folder("t_frames"), "--write", "csv"} + known);
    assert_string_equal(text_of(in_folder("t_frames/frame_00003.png")).c_str(), "mine");
}

// What an interrupted run has finished is kept, unless it would become another frame; frames of others are not
// replaced.
void test_interrupted_frames(void **) {
    const std::string source = encoded("still", "i.mkv", "-c:v ffv1 -pix_fmt yuv444p"), out = in_folder("i_frames");
    const Words words = Words{"deflicker", source, "-o", out} + known;
    const auto interrupted = [&](const Words &more) {
        const program_runs::Child child = program_runs::start_program(words + more);
        int status = 0;
        while (waitpid(child.id, &status, WNOHANG) == 0)
            if (fs::exists(out + "/frame_00003.png")) kill(child.id, SIGINT);
        close(child.err);
        return WIFEXITED(status) && WEXITSTATUS(status) == done;
    };
    must_exit(done, Words{"deflicker", source, "-o", in_folder("i_whole")} + known);
    if (interrupted({})) fail_msg("it was faster than an interrupt");
    assert_true(fs::exists(out + "/frame_00001.png") && !fs::exists(out + "/frame_00016.png"));
    const std::string list = out + "/.lensprof-frames.json", lines = text_of(list), first = out + "/frame_00001.png";
    const auto pixels = load(first);
    // A damaged list shows nothing, so that its frames are those of others; a cut line loses its frame alone.
    for (const std::string &damaged : {std::string("{"), std::string(71 << 20, ' ')}) {
        save_text(list, damaged);
        assert_refused(usage, words, {"frame_0000", ": exists"});
    }
    save_text(list, lines + "frame_0");
    // An edited frame is somebody's.
    save_text(first, "edited");
    assert_refused(usage, words, {"frame_00001.png: exists"});
    fs::remove(first);
    save_text(out + "/frame_00015.png", "mine");
    assert_refused(usage, words, {"frame_00015.png: exists"});
    fs::remove(out + "/frame_00015.png");
    const Outcome other = run_words({"deflicker", encoded("still", "j.mkv", "-c:v ffv1 -pix_fmt yuv444p"), "-o", out});
    assert_int_equal(other.code, usage);
    // A run with --overwrite that is interrupted goes on, too; what the list links to is left alone.
    const std::string precious = in_folder("precious.txt");
    save_text(precious, text_of(list));
    fs::remove(list);
    fs::create_symlink(precious, list);
    fs::remove(out + "/frame_00003.png");
    interrupted({"--overwrite"});
    assert_true(text_of(precious) == lines + "frame_0" && !fs::is_symlink(list));
    assert_true(load(first) == pixels);
    // Another codec replaces the frames that the list has.
    must_exit(done, words + Words{"--codec", "jpeg"});
    assert_true(fs::exists(out + "/frame_00016.jpg") && !fs::exists(first));
    fs::remove_all(out);
    if (interrupted({})) fail_msg("it was faster than an interrupt");
    const Outcome second = run_words(words);
    assert_int_equal(second.code, done);
    assert_true(contains(second.err, "of an interrupted run kept"));
    for (uint32_t i = 1; i <= still_frames; i++) {
        char name[32];
        std::snprintf(name, sizeof name, "/frame_%05u.png", i);
        assert_true(load(out + name) == load(in_folder("i_whole") + name));
    }
    assert_false(fs::exists(list));
    assert_refused(usage, words, {"frame_00001.png: exists", "--overwrite"});
}

// A response that sRGB is not is fitted to frames of the video.
void test_response_is_found(void **) {
    const std::string source = encoded("linear", "linear.mkv", "-c:v ffv1 -pix_fmt yuv444p");
    const Json json = json_of({"deflicker", source, "-o", in_folder("linear_levelled"), "--to", "mean", "--json"});
    const std::string response = json["response"].get<std::string>();
    assert_true(contains(response, "response fitted to"));
    const Json stated =
        json_of({"deflicker", source, "-o", in_folder("linear_srgb"), "--to", "mean", "--response", "srgb", "--json"});
    assert_true(json["tone_error"].get<double>() < 0.7 * stated["tone_error"].get<double>());
}

// In a video nothing is left out: black frames are as they were.
void test_moving_video(void **) {
    const std::string source =
        encoded("moving", "moving.mp4",
                "-vf drawbox=t=fill:color=black:enable='between(n\\,12\\,13)' -c:v libx264 -crf 8 "
                "-pix_fmt yuv420p");
    const Words words = {"calibrate", source, "-o", in_folder("model"), "--no-store", "--frames"};
    const Outcome outcome =
        run_words(words + Words{in_folder("model/levelled.mkv"), "--to", "first", "--codec", "ffv1"});
    if (outcome.code != done) fail_msg("%s", outcome.err.c_str());
    assert_true(contains(outcome.err,
                         "levelled.mkv: not levelled, because the exposure is not measured: frame_00013, "
                         "frame_00014"));
    const auto before = frames_of("moving.mp4"), after = frames_of("model/levelled.mkv");
    assert_int_equal(after.size(), moving_frames);
    assert_true(mean_difference(before[12].picture, after[12].picture) < 1.0);
    // The middle of the first frame keeps its level, the corner becomes brighter.
    const auto level = [](const VideoFrame &frame, uint32_t x, uint32_t y) {
        double sum = 0.0;
        for (uint32_t n = 0; n < 20; n++)
            for (uint32_t m = 0; m < 60; m++)
                sum += frame.picture.pixels[(y + n) * frame.picture.row_bytes + 3 * x + m];
        return sum / 1200.0;
    };
    assert_close(level(after[0], 150, 110), level(before[0], 150, 110), 4.0);
    assert_true(level(after[0], 4, 4) > 1.1 * level(before[0], 4, 4));
    assert_refused(usage, words + Words{in_folder("x.mp4"), "--fps", "5"}, {"x.mp4: a video has all frames"});
    assert_refused(usage, {"calibrate", source, "-o", in_folder("x"), "--to", "3"}, {"--to: is for levelled frames"});
    assert_refused(usage,
                   {"calibrate", source, "-o", in_folder("x"), "--report", in_folder("y.html"), "--frames",
                    in_folder("y.html/levelled")},
                   {"y.html: the levelled frames have this name"});
    assert_refused(usage, {"calibrate", source, "-o", in_folder("x"), "--one-lens"}, {"--one-lens: is for pictures"});
    assert_refused(usage, words + Words{source}, {"moving.mp4: is the input"});
    for (const auto &[frame, reason] :
         {std::pair{"13", "this frame is blank"}, {"99", "has 30 frames"}, {"x", "neither"}})
        assert_refused(usage, {"calibrate", source, "-o", in_folder("x"), "--frames", in_folder("y"), "--to", frame},
                       {std::string("--to ") + frame + ": ", reason});
}

// The frames that transforms.json lists, with their poses afterwards.
void test_transforms(void **) {
    const std::string data = in_folder("data"), listed = data + "/transforms.json";
    fs::create_directories(data);
    fs::copy(in_folder("moving/images"), data + "/images");
    write_picture(data + "/images/00004.png", rendered_black());
    Json content = {{"w", width}, {"h", height}, {"fl_x", 300.125}, {"ply_file_path", "points.ply"}};
    content["frames"] = Json::array();
    for (uint32_t place = 0; place < moving_frames; place++) {
        const uint32_t i = place * 7 % moving_frames;  // as COLMAP lists them
        const std::string name = "./images/" + frame_name(i);
        content["frames"].push_back(
            {{"file_path", i % 2 ? name.substr(0, name.size() - 4) : name},
             {"transform_matrix", {{1, 0, 0, i / 7.0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}},
             {"mask_path", "masks/" + frame_name(i)}});
    }
    content["test_filenames"] = {"./images/00004", "images/./" + frame_name(7), "images/00009"};
    save_text(listed, content.dump());
    std::string times;  // names in the order of the list, not of the frames
    for (uint32_t place = 0; place < moving_frames; place++) {
        const uint32_t i = place * 7 % moving_frames;
        times += frame_name(i) + " " + std::to_string(place) + " " + std::to_string(std::exp2(true_ev(i))) + "\n";
    }
    save_text(in_folder("data_times.txt"), times);
    const Words words = {"calibrate", data, "-o", in_folder("data_model"), "--no-store", "--frames"};
    const Outcome outcome = run_words(words + Words{in_folder("trained"), "--times", in_folder("data_times.txt")});
    if (outcome.code != done) fail_msg("%s", outcome.err.c_str());
    assert_true(contains(outcome.err, "trained: left out, because the exposure is not measured: frame_00005.png"));
    assert_true(contains(outcome.err, "transforms.json: lists the frames in another order than that of the numbers"));
    Json found = parsed(text_of(in_folder("trained/transforms.json")));
    assert_int_equal(found["frames"].size(), moving_frames - 1);
    assert_string_equal(found["test_filenames"].dump().c_str(),
                        "[\"images/frame_00008.png\",\"images/frame_00010.png\"]");
    assert_string_equal(found["ply_file_path"].get<std::string>().c_str(), "../data/points.ply");
    assert_true(found["fl_x"] == content["fl_x"] && found["w"] == content["w"]);
    for (Json &frame : found["frames"]) {
        const std::string file = frame["file_path"].get<std::string>();
        const size_t number = std::stoul(file.substr(file.find("frame_") + 6)) - 1;
        assert_true(frame["transform_matrix"][0][3] == number / 7.0);
        assert_string_equal(frame["mask_path"].get<std::string>().c_str(),
                            ("../data/masks/" + frame_name(uint32_t(number))).c_str());
        assert_true(fs::exists(in_folder("trained/" + file)));
        if (number > 5)  // of the same scene
            assert_close(frame["exposure_ev"].get<double>() - found["frames"][4]["exposure_ev"].get<double>(),
                         true_ev(uint32_t(number)) - true_ev(5), 0.25);
    }
    assert_refused(usage, words + Words{in_folder("trained")}, {"trained: has a transforms.json", "--overwrite"});
    assert_refused(usage, words + Words{data}, {"data: is the input"});
    assert_refused(usage, words + Words{in_folder("x.mp4")}, {"x.mp4: a video is written of a video"});
    const auto broken = [&](const std::string &text, const Words &named) {
        save_text(listed, text);
        assert_refused(unreadable, {"calibrate", data, "-o", in_folder("none")}, named);
    };
    broken("{\"frames\": [", {"transforms.json: is not JSON", "repair it"});
    broken("{\"frames\": [], \"x\": " + std::string(100000, '[') + std::string(100000, ']') + "}",
           {"transforms.json: is nested more than 100 deep"});
    broken("[]", {"transforms.json: has no list of frames"});
    broken("{\"frames\": []}", {"transforms.json: lists no frames"});
    broken("{\"frames\": [{\"a\": 1}]}", {"frames[0] has no file_path"});
    broken("{\"frames\": [{\"file_path\": \"images/none\"}]}", {"frames[0]: ", "images/none does not exist"});
    content["w"] = 17;
    broken(content.dump(), {"states w = 17, h = 240, but", "00000.png has 320 x 240 pixels"});
    content["w"] = width;
    Picture small = rendered_black();
    small.height = small.frame_height = 100;
    small.pixels.resize(small.row_bytes * 100);
    write_picture(data + "/images/00009.png", small);
    broken(content.dump(), {"00009.png: has 320 x 100 pixels"});
}

// Names that differ in one whole number are sorted by it; others, in the order of time here, stay as listed.
void test_order_of_names(void **) {
    const auto order_of = [](const Words &names) {
        fs::remove_all(folder / "order");
        Json content = {{"frames", Json::array()}};
        for (const std::string &name : names) {
            fs::create_directories((folder / "order" / name).parent_path());
            save_text(in_folder("order/" + name + ".png"), "not read");
            content["frames"].push_back({{"file_path", name}});
        }
        save_text(in_folder("order/transforms.json"), content.dump());
        const TransformsFile transforms = read_transforms(in_folder("order"));
        std::string order;
        for (size_t i = 0; i < names.size(); i++) {
            assert_string_equal(
                transforms.files[i].c_str(),
                in_folder("order/" + transforms.content["frames"][i]["file_path"].get<std::string>() + ".png").c_str());
            order += fs::path(transforms.files[i]).stem().string() + " ";
        }
        return order + (transforms.is_sorted ? "sorted" : "listed");
    };
    assert_string_equal(order_of({"f_10", "f_9", "f_011"}).c_str(), "f_9 f_10 f_011 sorted");
    assert_string_equal(order_of({"frame.0002", "frame.0001"}).c_str(), "frame.0001 frame.0002 sorted");
    assert_string_equal(order_of({"t1.0", "t1.02", "t1.1"}).c_str(), "t1.0 t1.02 t1.1 listed");
    assert_string_equal(order_of({"1.0", "1.02", "1.1"}).c_str(), "1.0 1.02 1.1 listed");
    assert_string_equal(order_of({"b/2", "a/1"}).c_str(), "2 1 listed");
    assert_string_equal(order_of({"2_left", "1_left"}).c_str(), "2_left 1_left listed");
}

int set_up(void **state) {
    if (make_folder(state) != 0) return 1;
    write_frames("still", still_frames, 0.0, false);
    write_frames("moving", moving_frames, 9.0, true);
    write_frames("linear", 20, 0.0, false, 1.0);
    return 0;
}

}  // namespace

int main() {
    if (!can_read_video() || shell("ffmpeg -version") != 0) return 77;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_is_kept),       cmocka_unit_test(test_codecs),
        cmocka_unit_test(test_same_bytes),        cmocka_unit_test(test_video_refusals),
        cmocka_unit_test(test_options_of_frames), cmocka_unit_test(test_response_is_found),
        cmocka_unit_test(test_moving_video),      cmocka_unit_test(test_transforms),
        cmocka_unit_test(test_tables_are_kept),   cmocka_unit_test(test_fields_keep_their_order),
        cmocka_unit_test(test_other_containers),  cmocka_unit_test(test_interrupted_frames),
        cmocka_unit_test(test_order_of_names),
    };
    return cmocka_run_group_tests(tests, set_up, remove_folder);
}
