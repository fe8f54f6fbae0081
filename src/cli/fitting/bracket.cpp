// `lensprof bracket`: fits the camera's response to pictures of one scene at several exposures.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <nlohmann/json.hpp>

#include "cli/fitting/fit_page.hpp"
#include "cli/fitting/fitting.hpp"
#include "cli/fitting/store_options.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/message.hpp"
#include "cli/program/numbers.hpp"
#include "cli/program/options.hpp"
#include "cli/program/progress.hpp"
#include "photo/base/events.hpp"
#include "photo/base/format.hpp"
#include "photo/base/lap.hpp"
#include "photo/calibration/known_exposures.hpp"
#include "photo/pictures/named_pictures.hpp"
#include "photo/pictures/other_parts.hpp"
#include "photo/pictures/raw_kind.hpp"
#include "photo/scene/scene_pictures.hpp"
#include "photo/scene/static_camera.hpp"

namespace lensprof {
namespace {

struct BracketOptions {
    FitOptions fit;
    StoreOptions store;
    std::vector<std::string> files;
    std::vector<double> ev, times_s;
    std::string reference, report;
    double ev_sigma = 0.05, black = 0.0;
    bool free_balance = true, modes_only = false, json = false, progress = false;
    SamplingOptions pixels{1, 0, 1600};
};

void declare_bracket_fit(Command &command, BracketOptions &o) {
    Keys keys = declare_fit(command, o.fit, {false});
    keys.flag("modes-only", o.modes_only, "restrict the response to EMoR modes even if a free curve fits better");
    keys.number("ev-sigma", o.ev_sigma, {0.001, 10.0},
                "standard error of the exposures given by --ev or --times, EV; default 0.05");
    keys.choice("white-balance", o.free_balance, {{"free", true}, {"fixed", false}},
                "white balance of the pictures: free (default: estimated per picture) or fixed (the same in all)");
    keys.text("reference", o.reference,
              "picture (number or name) whose exposure is 0 EV; default the first usable one");
    keys.number("ignore-below", o.black, {0.0, 200.0},
                "ignore grey values up to this, levels of 255, if black is not 0, as in scanned film; default 0");
    declare_sampling(keys, o.pixels, "10000 per picture");
}

void declare(Command &command, BracketOptions &o) {
    command.files("FILE", o.files, "pictures of one scene from a stationary camera");
    command.require("FILE");
    command.numbers("--ev", o.ev, {-64.0, 64.0},
                    "exposures of the pictures, EV, larger = brighter, separated by commas; default from EXIF, else "
                    "unknown");
    command.numbers("--times", o.times_s, {1e-9, 1e9, Unit::time_s},
                    "exposure times instead of --ev, seconds, such as 1/8,1,8 or 1/8s,1s,8s");
    command.file("--report", o.report, "write a report with charts as one .html file");
    declare_store(command, o.store);
    declare_bracket_fit(command, o);
    declare_json(command, o.json);
    declare_progress(command, o.progress);
}

// The exposures of the command line, EV; empty if not given.
std::vector<double> given_exposures(const BracketOptions &o) {
    if (!o.ev.empty()) require_count(o.ev.size(), "--ev", o.files.size(), "picture");
    if (!o.ev.empty() || o.times_s.empty()) return o.ev;
    require_count(o.times_s.size(), "--times", o.files.size(), "picture");
    std::vector<double> ev;
    for (const double time_s : o.times_s) ev.push_back(std::log2(time_s));
    return ev;
}

std::vector<lensprof_pair> get_pairs(const BracketOptions &o, const Scene &scene, Progress &progress,
                                     BuildReport &report, uint32_t &channels) {
    auto clock = std::chrono::steady_clock::now();
    auto pictures = read_pictures(scene, o.pixels.max_side, progress);
    channels = channel_count(pictures);
    report.load_s = lap(clock);
    lensprof_sample_options options;
    lensprof_sample_options_init(&options);
    options.pairs = o.pixels.pairs;
    options.seed = o.pixels.seed;
    auto pairs = sample_still(scene, pictures, options, o.black, progress);
    report.sample_s = lap(clock);
    return pairs;
}

// The pictures connected by pairs, in order: the largest group, the earlier one of two. The others share almost no
// unclipped grey values with another picture.
std::vector<uint32_t> connected_pictures(const std::vector<lensprof_pair> &pairs, uint32_t count) {
    std::vector<uint32_t> group(count), size(count, 0);
    std::iota(group.begin(), group.end(), 0u);
    for (bool changed = true; changed;) {
        changed = false;
        for (const auto &pair : pairs) {
            uint32_t &a = group[pair.image[0]], &b = group[pair.image[1]], low = std::min(a, b);
            changed = changed || a != b;
            a = b = low;
        }
    }
    for (uint32_t g : group) size[g]++;
    auto largest = static_cast<uint32_t>(std::max_element(size.begin(), size.end()) - size.begin());
    std::vector<uint32_t> members;
    for (uint32_t i = 0; i < count; i++)
        if (group[i] == largest) members.push_back(i);
    return members;
}

// Only the members of the input, renumbered.
void keep_only(const std::vector<uint32_t> &members, FitInput &input) {
    std::vector<uint32_t> number(input.images.size(), UINT32_MAX);
    std::vector<lensprof_fit_image> images;
    for (uint32_t i : members) {
        number[i] = static_cast<uint32_t>(images.size());
        images.push_back(input.images[i]);
        images.back().ev_of = images.back().red_of = images.back().blue_of = number[i];
    }
    std::vector<lensprof_pair> pairs;
    for (lensprof_pair pair : input.pairs) {
        if (number[pair.image[0]] == UINT32_MAX || number[pair.image[1]] == UINT32_MAX) continue;
        for (uint32_t &image : pair.image) image = number[image];
        pairs.push_back(pair);
    }
    input.images = images;
    input.pairs = pairs;
}

// The result of the members at their indices; for the others what is known beforehand, relative to the reference.
void report_members(const std::vector<uint32_t> &members, const std::vector<lensprof_fit_image> &images,
                    const Fitted &fitted, BuildReport &report, Streams &streams) {
    const auto &zero = images[report.reference];
    std::vector<lensprof_fit_image_quality> quality(images.size());
    for (uint32_t i = 0, m = 0; i < images.size(); i++) {
        lensprof_exposure exposure;
        lensprof_exposure_init(&exposure);
        if (m < members.size() && members[m] == i) {
            exposure = fitted.exposures[m];
            quality[i] = report.quality[m++];
            quality[i].component = members[quality[i].component];
        } else {
            bool known = images[i].known_ev_sigma > 0.0 && zero.known_ev_sigma > 0.0;
            exposure.ev = known ? images[i].known_ev - zero.known_ev : NAN;
            quality[i].component = i;
            warn(streams, report.names[i] + ": left out: shares almost no unclipped grey values with another picture");
        }
        report.exposures.push_back(exposure);
    }
    report.quality = quality;
}

// The verdict of the members' fit in terms of the pictures, with the remedies of this command.
Verdict bracket_verdict(const Fitted &fitted, const std::vector<uint32_t> &members,
                        const std::vector<std::string> &names) {
    Verdict verdict = fitted.verdict;
    for (Finding &finding : verdict.findings) {
        if (finding.item.kind == LENSPROF_ITEM_IMAGE) finding.item.index = members[finding.item.index];
        switch (finding.code) {
        case LENSPROF_REASON_FEW_AGREE:
        case LENSPROF_REASON_FEW_INLIERS:
        case LENSPROF_REASON_IMAGE_DISAGREES:
        case LENSPROF_REASON_IMAGE_INCONSISTENT:
            finding.text += "; use --fit ignore-below=NUMBER to exclude grey values of a raised black level";
            break;
        default: break;
        }
    }
    name_images(names, verdict);
    return verdict;
}

FitInput fit_input(const BracketOptions &o, const Scene &scene, const std::vector<PictureMetadata> &metadata,
                   const std::vector<double> &ev, ExifUse &exif, Events &events) {
    FitInput input;
    input.options = fit_options(o.fit);
    input.options.free &= LENSPROF_FREE_RESPONSE;
    input.options.vignettings = 1;
    input.options.refine = !o.modes_only && o.fit.modes == LENSPROF_MODES_AUTO;
    input.images = fit_images(scene);
    if (ev.empty()) exif = add_known_exposures(o.fit, scene, metadata, input.images, events);
    for (size_t i = 0; i < ev.size(); i++) {
        input.images[i].known_ev = ev[i];
        input.images[i].known_ev_sigma = o.ev_sigma;
    }
    return input;
}

BuildReport fit_bracket(const BracketOptions &o, Scene &scene, const std::vector<PictureMetadata> &metadata,
                        const std::vector<double> &ev, const CameraKind &kind, Json &page, Streams &streams) {
    Progress progress(streams, o.progress);
    BuildReport report;
    report.names = scene.names;
    report.has_falloff = false;
    report.exposures_given = !ev.empty();
    FitInput input = fit_input(o, scene, metadata, ev, report.exif, progress);
    report.camera_kind = kind;
    input.options.camera_kind = kind.kind;
    if (!o.reference.empty()) report.reference = image_of_word(scene, o.reference);
    input.pairs = get_pairs(o, scene, progress, report, input.options.channels);
    stop_if_cancelled();
    const auto images = input.images;
    const auto members = connected_pictures(input.pairs, static_cast<uint32_t>(images.size()));
    auto place = std::find(members.begin(), members.end(), report.reference);
    if (place == members.end() && !o.reference.empty())
        throw Failure(LENSPROF_ERROR_NOT_USABLE,
                      scene.names[report.reference] + ": shares almost no unclipped grey values with another "
                                                        "picture; choose another reference",
                      LENSPROF_REASON_IMAGE_GROUPS);
    if (place == members.end()) place = members.begin();
    report.reference = *place;
    keep_only(members, input);
    input.options.reference = static_cast<uint32_t>(place - members.begin());
    Fitted best = fit(input, input.options.reference, scene.path, progress, &report.quality);
    progress.clear();
    report.fit = best.result, report.held = best.held;
    report.verdict = bracket_verdict(best, members, scene.names);
    name_sources(metadata, report.exposures_given, report.verdict);
    report_members(members, images, best, report, streams);
    if (!report.fit.usable) report.fit.equalizes = 0;  // a bracket must determine a response
    if (!o.report.empty())
        page = fit_page_data({report, input, best, images, scene, metadata, command_text(streams.words),
                              "Response from pictures of one scene", false},
                             progress);
    return report;
}

int bracket_and_store(const BracketOptions &o, Streams &streams) {
    std::vector<double> ev = given_exposures(o);
    Scene scene = static_scene(o.files, o.free_balance);
    check_pictures(scene, o.pixels.max_side);
    Progress events(streams);
    note_several(scene.files, events);
    require_one_kind(scene.files);
    std::vector<PictureMetadata> metadata;
    for (const std::string &file : scene.files) metadata.push_back(read_metadata(file));
    lensprof_profile_key key = camera_key(o.store, metadata[0], scene.files[0], events);
    check_store(o.store);
    CameraKind kind = camera_kind_of(o.fit, key, metadata[0]);
    if (kind.kind == LENSPROF_CAMERA_LINEAR && !o.fit.camera_kind && !raw_kind(scene.files[0]))
        kind = {};  // the response is wanted; that of a camera raw file is known
    OutputFiles outputs;
    Json page;
    BuildReport report = fit_bracket(o, scene, metadata, ev, kind, page, streams);
    return finish_fit(
        report, key, o.store,
        {o.fit.method == LENSPROF_METHOD_TRANSFER ? "bracket" : std::string("bracket ") + method_name(o.fit.method),
         scene.path, o.json, false, o.report, &page, &outputs},
        streams);
}

int run(const BracketOptions &o, Streams &streams) {
    check_max_side(o.pixels.max_side);
    check_fit_options(o.fit);
    check_store_options(o.store);
    check_report(o.report, o.files, o.store);
    if (!o.ev.empty() && !o.times_s.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--ev and --times exclude each other; give one of them");
    try {
        return bracket_and_store(o, streams);
    } catch (const Failure &failure) {
        if (o.json && failure.group() == LENSPROF_ERROR_NOT_USABLE) {
            BuildReport report = no_fit(o.files, failure);
            report.has_falloff = false;
            print_json(build_json(report), streams.out);
        }
        throw;
    }
}

}  // namespace

void declare_bracket(Command &program) {
    Command command = program.add("bracket", "fit the camera's response to an exposure bracket of one scene",
                                  "Estimates the camera's response and the exposures from pictures of one scene.");
    auto o = std::make_shared<BracketOptions>();
    declare(command, *o);
    command.example("lensprof bracket dark.jpg middle.jpg bright.jpg --times 1/60,1/15,1/4");
    command.run([o](Streams &streams) { return run(*o, streams); });
}

}  // namespace lensprof
