// `lensprof flat`: pictures of a white card or another even light -> falloff -> a profile in the database.
#include "cli/fitting/flat.hpp"

#include <chrono>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/fitting/fitting.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/interrupt.hpp"
#include "cli/program/options.hpp"
#include "cli/program/run.hpp"
#include "cli/report/falloff.hpp"

namespace lensprof {
namespace {

void declare(CLI::App &app, FlatCommand &o) {
    app.add_option("FILES", o.files, "pictures of the card, all of one camera, lens and setting")->required();
    app.add_flag("--linear", o.linear, "the pictures are linear (developed from RAW without a tone curve)");
    app.add_option("--gamma", o.gamma, "the pictures' response is x^(1/gamma)")->check(in_range(0.1, 10.0));
    app.add_option("--profile", o.profile, "the response is that of this profile of the database")
        ->check(CLI::PositiveNumber);
    app.add_option("--shots", o.shots,
                   "number of every picture's shot, as 1,1,1,2,2,2: exposures of one shot are merged; without it every "
                   "picture is a shot of its own");
    app.add_option("--ev", o.ev, "exposure of every picture, EV, instead of EXIF's");
    app.add_option("--turned", o.turned,
                   "by how many degrees the camera was turned about its axis, clockwise seen from behind it, in every "
                   "shot: tells the light from the lens");
    app.add_flag("--several", o.several, "one card at several places of the frame, its brightness the same in all");
    app.add_option("--ev-sigma", o.ev_sigma, "with --several: standard error of an exposure, EV")
        ->check(in_range(0.001, 1.0));
    app.add_flag("--find-card", o.find_card, "the card covers a part of the frame: look for it");
    app.add_option("--card", o.cards, "the card is at X,Y,WIDTH,HEIGHT (px of the frame): once, or once a picture");
    app.add_option("--light", o.light, "even, plane, quadratic, or auto: plane, with --several even")
        ->check(CLI::IsMember({"auto", "even", "plane", "quadratic"}));
    app.add_flag("--own-light", o.own_light, "every shot has a light of its own");
    app.add_option("--falloff-curves", o.falloff, "1, 3 (one a channel) or auto (3 where they clearly differ)")
        ->check(CLI::IsMember({"auto", "1", "3"}));
    app.add_option("--center", o.center, "free, or fixed in the middle of the frame")
        ->check(CLI::IsMember({"free", "fixed"}));
    app.add_option("--grid", o.grid, "gain grid for what is not radial: auto (where 0.3 % are left), none, always")
        ->check(CLI::IsMember({"auto", "none", "always"}));
    app.add_option("--black", o.black, "grey value (0..1) below which nothing is used")->check(in_range(0.0, 1.0));
    app.add_option("--white", o.white, "grey value (0..1) above which nothing is used")->check(in_range(0.0, 1.0));
    app.add_option("--max-side", o.max_side, "read pictures reduced to no less than this many pixels (1600); 0 = full");
    declare_store(app, o.store);
    app.add_flag("--json", o.json, "print one JSON object");
    app.add_flag("--progress", o.progress, "show progress also when standard error is not a terminal");
}

int on_progress(double done, void *progress) {
    static_cast<Progress *>(progress)->update("fitting", done);
    return interrupted();
}

// JPEG rounds colours over blocks of 16 pixels, which no mean over pixels evens out: channels do not get curves of
// their own from that.
void mind_jpeg(const FlatCommand &o, FlatInput &input, Streams &streams) {
    for (size_t i = 0; i < input.pictures.size(); i++) {
        if (input.pictures[i].traits.format != FileFormat::jpeg) continue;
        if (o.falloff == "auto") input.options.vignettings = 1;
        streams.err
            << "lensprof: warning: " << o.files[i]
            << ": JPEG rounds grey values and colours over blocks of pixels, so that the falloff may be farther off "
               "than stated (by half a level of the card's grey); RAW, or TIFF or PNG of 16 bit, is better\n";
        return;
    }
}

FlatReport measure(const FlatCommand &o, FlatInput &input, Progress &progress, Streams &streams) {
    auto clock = std::chrono::steady_clock::now();
    read_flat(o, progress, input);
    progress.clear();
    mind_jpeg(o, input, streams);
    stop_if_interrupted();
    FlatReport report;
    report.load_s = lap(clock);
    report.names = input.names;
    report.response = input.response;
    for (const auto &image : input.images) {
        report.shots.push_back(image.shot);
        report.ev.push_back(image.ev);
        report.turned.push_back(image.turn_deg);
    }
    report.quality.resize(input.images.size());
    lensprof_flat_result_init(&report.fit);
    report.fit.image_quality = report.quality.data();
    input.options.progress = on_progress;
    input.options.progress_user = &progress;
    lensprof_error error{};
    lensprof_status status = lensprof_fit_flat(&input.options, input.images.data(),
                                               static_cast<uint32_t>(input.images.size()), &report.fit, &error);
    progress.clear();
    check_named(status, input.names.size() == 1 ? input.names[0] : input.names[0] + " and the others", error,
                LENSPROF_ITEM_IMAGE, input.names);
    report.solve_s = lap(clock);
    report.verdict = verdict_of(report.fit);
    name_image(report.names, report.verdict);
    name_shot(report.names, report.shots, report.verdict);
    return report;
}

int64_t store(const FlatCommand &o, const FlatInput &input, const FlatReport &report) {
    const auto &fit = report.fit;
    auto profile = profile_of_curves(fit, input.response.data(), static_cast<uint32_t>(input.response.size()));
    profile->key = input.key;
    profile->grid = fit.gain_grid;
    profile->provenance.images = static_cast<uint32_t>(input.images.size());
    profile->provenance.pairs = fit.cells;
    profile->provenance.inlier_share = fit.inlier_share;
    return store_profile(o.store, *profile, {"flat", o.files.front(), fit.usable != 0});
}

}  // namespace

int run_flat(const std::vector<std::string> &arguments, Streams &streams) {
    FlatCommand o;
    CLI::App app(
        "Measures the falloff on pictures of a white card or another even light; docs/flat.md tells how to take "
        "them.",
        "lensprof flat");
    declare(app, o);
    if (!parse(app, arguments, streams)) return 0;
    check_flat_options(o);
    FlatInput input = prepare_flat(o);
    check_store(o.store);
    Progress progress(streams.err, o.progress ? ShowProgress::always : ShowProgress::when_terminal);
    FlatReport report = measure(o, input, progress, streams);
    const bool good = report.fit.usable || o.store.force;
    stop_if_interrupted();
    if (good && !o.store.no_store) report.profile_id = store(o, input, report);
    if (o.json)
        print_json(flat_json(report), streams.out);
    else
        print_flat(report, streams.out);
    if (report.profile_id && !o.json)
        streams.out << "stored    profile " << report.profile_id << " in " << store_path(o.store.db) << ": "
                    << describe_key(input.key) << "\n";
    if (report.fit.usable && !report.verdict.text.empty())
        streams.err << "lensprof: warning: " << o.files.front() << ": " << report.verdict.text << "\n";
    if (!report.fit.usable)
        streams.err << "lensprof: " << o.files.front() << ": not usable: " << report.verdict.text
                    << (good || o.store.no_store ? "" : "; nothing was stored (--force stores it all the same)")
                    << "\n";
    return static_cast<int>(report.fit.usable ? ExitCode::done : ExitCode::not_usable);
}

}  // namespace lensprof
