// `lensprof flat`: pictures of a white card or another even light -> falloff -> a profile in the database.
#include "cli/fitting/flat.hpp"

#include <chrono>
#include <cmath>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "cli/fitting/fitting.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/interrupt.hpp"
#include "cli/program/message.hpp"
#include "cli/program/options.hpp"
#include "cli/program/run.hpp"
#include "cli/report/falloff.hpp"

namespace lensprof {
namespace {

std::array<double, 4> card_of(const std::string &word) {
    const std::vector<std::string> sides = split(word);
    if (sides.size() != 4) throw std::invalid_argument(word + ": not a rectangle X,Y,WIDTH,HEIGHT");
    std::array<double, 4> card;
    for (size_t i = 0; i < 4; i++) card[i] = number_of(sides[i], {0.0, 1e6});
    return card;
}

void declare_card(Command &command, FlatCommand &o) {
    command.flag("--several", o.several, "one card at several places of the frame, its brightness the same in all");
    command.number("--ev-sigma", o.ev_sigma, {0.001, 1.0}, "with --several: standard error of an exposure, EV");
    command.flag("--find-card", o.find_card, "the card covers a part of the frame: look for it");
    command.words(
        "--card", "X,Y,WIDTH,HEIGHT", [&o](const std::string &word) { o.cards.push_back(card_of(word)); },
        "the card is there (px of the frame): once, or once a picture");
    command.choice("--light", o.light,
                   {{"auto", LENSPROF_FLAT_LIGHT_AUTO},
                    {"even", LENSPROF_FLAT_LIGHT_EVEN},
                    {"plane", LENSPROF_FLAT_LIGHT_PLANE},
                    {"quadratic", LENSPROF_FLAT_LIGHT_QUADRATIC}},
                   "even, plane, quadratic, or auto: plane, with --several even");
    command.flag("--own-light", o.own_light, "every shot has a light of its own");
}

void declare(Command &command, FlatCommand &o) {
    command.files("FILES", o.files, "pictures of the card, all of one camera, lens and setting");
    command.require("FILES");
    command.flag(
        "--linear", o.linear,
        "the pictures are linear (developed from RAW without a tone curve); float TIFF, and a colour profile with a "
        "linear tone curve, say so themselves");
    command.number("--gamma", o.gamma, {0.1, 10.0}, "the pictures' response is x^(1/gamma)");
    command.profile_id("--profile", o.profile, "the response is that of this profile of the database");
    command.counts("--shots", o.shots, 0, 1000000,
                   "number of every picture's shot, as 1,1,1,2,2,2: exposures of one shot are merged; without it every "
                   "picture is a shot of its own");
    command.numbers("--ev", o.ev, any_number, "exposure of every picture, EV, instead of EXIF's");
    command.numbers("--turned", o.turned_deg, {-360.0, 360.0},
                    "by how many degrees the camera was turned about its axis, clockwise seen from behind it, in every "
                    "shot: separates the light from the lens");
    declare_card(command, o);
    command.choice("--falloff-curves", o.falloff_curves, {{"auto", 0}, {"1", 1}, {"3", 3}},
                   "1, 3 (one a channel) or auto (3 where they clearly differ)");
    command.choice("--center", o.free_center, {{"free", true}, {"fixed", false}},
                   "free, or fixed in the middle of the frame");
    command.choice(
        "--grid", o.grid,
        {{"auto", LENSPROF_FLAT_GRID_AUTO}, {"none", LENSPROF_FLAT_GRID_NONE}, {"always", LENSPROF_FLAT_GRID_ALWAYS}},
        "gain grid for what is not radial: auto (where 0.3 % are left), none, always");
    command.number("--black", o.black, {0.0, 1.0}, "grey value (0..1) below which nothing is used");
    command.number("--white", o.white, {0.0, 1.0}, "grey value (0..1) above which nothing is used");
    command.count("--max-side", o.max_side, 0, UINT32_MAX,
                  "read pictures reduced to no less than this many pixels (1600); 0 = full");
    declare_store(command, o.store);
    declare_json(command, o.json);
    declare_progress(command, o.progress);
}

int on_progress(double done, void *progress) {
    static_cast<Progress *>(progress)->update("fitting", done);
    return interrupted();
}

// JPEG rounds colours over blocks of 16 pixels, which no mean over pixels evens out: channels do not get curves of
// their own from that.
void mind_jpeg(const FlatCommand &o, FlatInput &input, Streams &streams) {
    for (size_t i = 0; i < input.pictures.size(); i++) {
        if (!input.pictures[i].traits.is_lossy) continue;
        if (o.falloff_curves == 0) input.options.vignettings = 1;
        const bool is_jpeg = input.pictures[i].traits.format == FileFormat::jpeg;
        warn(
            streams,
            o.files[i] + (is_jpeg ? ": JPEG" : ": its lossy compression") + " rounds grey values and colours over blocks of pixels, so that "
               "the falloff may be farther off "
               "than stated (by half a level of the card's grey); RAW, or TIFF or PNG of 16 bit, is better");
        return;
    }
}

// What is known before the fit.
FlatReport begin_report(const FlatInput &input) {
    FlatReport report;
    report.names = input.names;
    report.response = input.response;
    for (const auto &image : input.images) {
        report.shots.push_back(image.shot);
        report.ev.push_back(image.ev);
        report.turned.push_back(image.turn_deg);
    }
    report.quality.resize(input.images.size());
    lensprof_flat_result_init(&report.fit);
    return report;
}

// What is reported where no fit could be made.
FlatReport no_flat(const FlatInput &input, const Failure &failure) {
    FlatReport report = begin_report(input);
    report.fit.vignettings = 1;
    report.fit.corner_sigma = NAN;
    report.verdict.text = failure.what();
    report.verdict.code = LENSPROF_REASON_FLAT_FEW_CELLS;
    return report;
}

FlatReport measure(const FlatCommand &o, FlatInput &input, Progress &progress, Streams &streams) {
    auto clock = std::chrono::steady_clock::now();
    read_flat(o, progress, input);
    progress.clear();
    mind_jpeg(o, input, streams);
    stop_if_interrupted();
    FlatReport report = begin_report(input);
    report.load_s = lap(clock);
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
    auto profile = profile_of(fit, input.response, input.images.size());
    profile->key = input.key;
    return store_profile(o.store, *profile, {"flat", o.files.front(), fit.usable != 0});
}

FlatReport measure_or_say_why_not(const FlatCommand &o, FlatInput &input, Streams &streams) {
    Progress progress(streams.err, o.progress ? ShowProgress::always : ShowProgress::when_terminal);
    try {
        return measure(o, input, progress, streams);
    } catch (const Failure &failure) {
        if (o.json && failure.code == ExitCode::not_usable) print_json(flat_json(no_flat(input, failure)), streams.out);
        throw;
    }
}

int run(const FlatCommand &o, Streams &streams) {
    check_flat_options(o);
    FlatInput input = prepare_flat(o, streams);
    check_store(o.store);
    FlatReport report = measure_or_say_why_not(o, input, streams);
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
    if (report.fit.usable && !report.verdict.text.empty()) warn(streams, o.files.front() + ": " + report.verdict.text);
    if (!report.fit.usable) tell(streams, not_usable_text(o.files.front(), report.verdict, o.store));
    return static_cast<int>(report.fit.usable ? ExitCode::done : ExitCode::not_usable);
}

}  // namespace

void declare_flat(Command &program) {
    Command command = program.add(
        "flat", "pictures of a white card or another even light -> a lens profile in the database",
        "Measures the falloff on pictures of a white card or another even light; docs/flat.md explains how to take them.");
    auto o = std::make_shared<FlatCommand>();
    declare(command, *o);
    command.run([o](Streams &streams) { return run(*o, streams); });
}

}  // namespace lensprof
