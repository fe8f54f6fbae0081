// `lensprof flat`: measures the falloff on pictures of a white card or another even light and stores a profile.
#include "cli/fitting/flat.hpp"

#include <chrono>
#include <cmath>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "cli/fitting/fitting.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/exit_code.hpp"
#include "cli/program/message.hpp"
#include "cli/program/options.hpp"
#include "cli/program/progress.hpp"
#include "cli/program/run.hpp"
#include "cli/report/findings.hpp"
#include "photo/base/events.hpp"
#include "photo/base/lap.hpp"
#include "photo/calibration/outcome.hpp"
#include "photo/pictures/orientation.hpp"
#include "photo/pictures/rotated_profile.hpp"
#include "photo/report/falloff.hpp"

namespace lensprof {
namespace {

std::array<double, 4> card_of(const std::string &word) {
    const std::vector<std::string> sides = split(word);
    if (sides.size() != 4) throw std::invalid_argument(word + ": not a rectangle X,Y,WIDTH,HEIGHT or find");
    std::array<double, 4> card;
    for (size_t i = 0; i < 4; i++) card[i] = number_of(sides[i], {0.0, 1e6});
    return card;
}

void declare_flat_fit(Command &command, FlatCommand &o) {
    Keys keys = command.expert().keys("--fit", "how the falloff is measured");
    keys.number("gamma", o.gamma, {0.1, 10.0}, "use the response x^(1/gamma)");
    keys.profile_id("profile", o.profile, "use the response of this profile of the database");
    keys.number("ev-sigma", o.ev_sigma, {0.001, 1.0},
                "standard error of an exposure, EV, with --several; default 0.02");
    keys.choice("light", o.light,
                {{"auto", LENSPROF_FLAT_LIGHT_AUTO},
                 {"even", LENSPROF_FLAT_LIGHT_EVEN},
                 {"plane", LENSPROF_FLAT_LIGHT_PLANE},
                 {"quadratic", LENSPROF_FLAT_LIGHT_QUADRATIC}},
                "model of the light on the card: even, plane, quadratic or auto (default: plane, or even with "
                "--several or where it fits as well)");
    keys.flag("own-light", o.own_light, "estimate the light per shot, instead of one for all shots");
    keys.choice("falloff-curves", o.falloff_curves, {{"auto", 0}, {"1", 1}, {"3", 3}},
                "number of falloff curves: 1, 3 (one per channel) or auto (default: 3 if they clearly differ)");
    keys.choice("center", o.free_center, {{"free", true}, {"fixed", false}},
                "centre of the falloff: free (default) or fixed at the centre of the frame");
    keys.choice(
        "grid", o.grid,
        {{"auto", LENSPROF_FLAT_GRID_AUTO}, {"none", LENSPROF_FLAT_GRID_NONE}, {"always", LENSPROF_FLAT_GRID_ALWAYS}},
        "gain grid for what k1..k3 leave: auto (default: if 0.3 % or more remain, or for a deep falloff), none or "
        "always");
    keys.number("black", o.black, {0.0, 1.0}, "ignore grey values below this, 0 to 1; default 2/255");
    keys.number("white", o.white, {0.0, 1.0}, "ignore grey values above this, 0 to 1; default 250/255");
    declare_max_side(keys, o.max_side);
}

void declare(Command &command, FlatCommand &o) {
    command.files("FILE", o.files, "pictures of the card, all of one camera, lens and setting");
    command.require("FILE");
    command.flag(
        "--linear", o.linear,
        "the pictures are linear (developed from raw files without a tone curve); not needed for float TIFF or a "
        "colour profile with a linear tone curve");
    command.numbers("--rotation", o.rotation_deg, {-360.0, 360.0},
                    "rotation of the camera about its optical axis per shot, degrees, clockwise seen from the back of "
                    "the camera; separates the light from the lens; default 0");
    command.file("--report", o.report, "write a report with charts as one .html file");
    Command expert = command.expert();
    expert.counts("--shots", o.shots, 0, 1000000,
                  "shot number per picture, such as 1,1,1,2,2,2: exposures of one shot are merged; default one shot "
                  "per picture");
    expert.numbers("--ev", o.ev, any_number, "exposure per picture, EV, separated by commas; default from EXIF");
    expert.flag("--several", o.several,
                "the pictures show one card at several places of the frame, with constant brightness");
    expert.words(
        "--card", "X,Y,WIDTH,HEIGHT|find",
        [&o](const std::string &word) {
            if (word == "find")
                o.find_card = true;
            else
                o.cards.push_back(card_of(word));
        },
        "rectangle of the card, px of the frame: give once for all, or once per picture; find: find the card, which "
        "covers only a part of the frame; default the whole frame");
    declare_store(command, o.store);
    declare_flat_fit(command, o);
    declare_json(command, o.json);
    declare_progress(command, o.progress);
}

// JPEG rounds colours over blocks of 16 pixels, which averaging does not remove: no falloff per channel from JPEG.
void handle_lossy_pictures(const FlatCommand &o, FlatInput &input, Streams &streams) {
    for (size_t i = 0; i < input.pictures.size(); i++) {
        if (!input.pictures[i].traits.is_lossy) continue;
        if (o.falloff_curves == 0) input.options.vignettings = 1;
        const bool is_jpeg = input.pictures[i].traits.format == FileFormat::jpeg;
        warn(
            streams,
            o.files[i] + (is_jpeg ? ": JPEG" : ": its lossy compression")
                + " rounds grey values and colours over blocks of pixels; the error of the falloff may exceed the "
                  "stated one by half a grey level of the card. Use raw files, or 16 bit TIFF or PNG");
        return;
    }
}

// The report fields known before the fit.
FlatReport begin_report(const FlatInput &input) {
    FlatReport report;
    report.names = input.names;
    report.response = input.response;
    for (const auto &image : input.images) {
        report.shots.push_back(image.shot);
        report.ev.push_back(image.ev);
        report.rotated.push_back(image.rotation_deg);
    }
    report.quality.resize(input.images.size());
    lensprof_flat_result_init(&report.fit);
    return report;
}

// The report if no fit was possible.
FlatReport failed_report(const FlatInput &input, const Failure &failure) {
    FlatReport report = begin_report(input);
    report.fit.vignettings = 1;
    report.fit.corner_sigma = NAN;
    report.verdict.refuse(LENSPROF_REASON_FLAT_FEW_CELLS, failure.what());
    return report;
}

FlatReport measure(const FlatCommand &o, FlatInput &input, Progress &progress, Streams &streams) {
    auto clock = std::chrono::steady_clock::now();
    read_flat(o, progress, input);
    progress.clear();
    handle_lossy_pictures(o, input, streams);
    stop_if_cancelled();
    FlatReport report = begin_report(input);
    report.load_s = lap(clock);
    input.options.progress = on_fit_progress;
    input.options.progress_user = &progress;
    lensprof_error error{};
    lensprof_flat *flat = nullptr;
    const auto count = static_cast<uint32_t>(input.images.size());
    const lensprof_status status =
        lensprof_fit_flat(&input.options, input.images.data(), count, nullptr, 0, &flat, &error);
    report.held = {flat, lensprof_flat_destroy};
    progress.clear();
    check_named(status, input.names.size() == 1 ? input.names[0] : input.names[0] + " and the others", error,
                LENSPROF_ITEM_IMAGE, input.names);
    check(lensprof_flat_get(flat, &report.fit, &error), "fit", &error);
    for (uint32_t i = 0; i < count; i++) {
        lensprof_flat_image_quality_init(&report.quality[i]);
        check(lensprof_flat_image_at(flat, i, &report.quality[i], &error), "fit", &error);
    }
    report.solve_s = lap(clock);
    report.verdict = verdict_of(flat);
    name_images(report.names, report.verdict);
    name_shots(report.names, report.shots, report.verdict);
    return report;
}

int64_t store(const FlatCommand &o, const FlatInput &input, const FlatReport &report, Streams &streams) {
    const auto &fit = report.fit;
    auto profile = profile_of(*report.held);
    profile->key = input.key;
    const lensprof_flat_image &frame = input.images.front();
    const uint16_t turn = sensor_orientation(frame.width, frame.height, input.pictures.front().traits.orientation);
    if (!turn)
        note(streams, o.files.front() + ": no orientation states which way this portrait picture was rotated: the "
                                        "profile is stored with its centre in the middle of the frame, and without "
                                        "what differs between opposite sides; give the pictures as the camera wrote "
                                        "them");
    turn_profile_to_sensor(turn, *profile);
    return store_profile(o.store, *profile, {"flat", o.files.front(), fit.usable != 0});
}

FlatReport measure_or_report_failure(const FlatCommand &o, FlatInput &input, Streams &streams) {
    Progress progress(streams, o.progress);
    try {
        return measure(o, input, progress, streams);
    } catch (const Failure &failure) {
        if (o.json && failure.group() == LENSPROF_ERROR_NOT_USABLE)
            print_json(flat_json(failed_report(input, failure)), streams.out);
        throw;
    }
}

int run(const FlatCommand &o, Streams &streams) {
    check_flat_options(o);
    FlatInput input = prepare_flat(o, streams);
    check_report(o.report, o.files, o.store);
    check_store(o.store);
    FlatReport report = measure_or_report_failure(o, input, streams);
    const bool is_stored = report.fit.usable || o.store.force;
    stop_if_cancelled();
    OutputFiles outputs;
    if (!o.report.empty())
        outputs.add(o.report, flat_page(report, o.files.front(), command_text(streams.words), streams.warnings));
    if (is_stored && !o.store.no_store) report.profile_id = store(o, input, report, streams);
    outputs.commit();
    if (o.json)
        print_json(flat_json(report), streams.out);
    else
        print_flat(report, streams.out);
    if (report.profile_id && !o.json)
        streams.out << "stored    profile " << report.profile_id << " in " << store_path(o.store.db) << ": "
                    << describe_key(input.key) << "\n";
    Progress events(streams);
    if (report.fit.usable) report_findings(report.verdict, o.files.front(), events);
    if (!report.fit.usable) print_message(streams, not_usable_text(o.files.front(), report.verdict, o.store));
    return static_cast<int>(report.fit.usable ? ExitCode::done : ExitCode::not_usable);
}

}  // namespace

void declare_flat(Command &program) {
    Command command = program.add(
        "flat", "measure a lens profile on pictures of a white card",
        "Measures the falloff from pictures of a white card or another even light; see docs/flat.md for how to take "
        "them.");
    auto o = std::make_shared<FlatCommand>();
    declare(command, *o);
    command.example("lensprof flat card0.tif card90.tif --linear --rotation 0,90 --camera \"EOS R5\"");
    command.run([o](Streams &streams) { return run(*o, streams); });
}

}  // namespace lensprof
