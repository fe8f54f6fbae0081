// `lensprof bracket`: fits the camera's response to pictures of one scene at several exposures.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "cli/fitting/fit_page.hpp"
#include "cli/fitting/fitting.hpp"
#include "cli/fitting/store_options.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/message.hpp"
#include "cli/program/numbers.hpp"
#include "cli/program/options.hpp"
#include "cli/program/progress.hpp"
#include "fit/base/joined_sets.hpp"
#include "photo/base/events.hpp"
#include "photo/base/format.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/calibration/known_exposures.hpp"
#include "photo/pictures/named_pictures.hpp"
#include "photo/pictures/other_parts.hpp"
#include "photo/pictures/raw_kind.hpp"
#include "photo/scene/exposure_times.hpp"
#include "photo/scene/static_camera.hpp"
#include "photo/scene/sweep_sampling.hpp"

namespace lensprof {
namespace {

struct BracketOptions {
    FitOptions fit;
    StoreOptions store;
    std::vector<std::string> files;
    std::vector<double> ev, times_s;
    std::string times_file, reference, report, output;
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

// Numbers, or a file.
void read_times(const std::string &word, BracketOptions &o) {
    try {
        for (const std::string &element : elements(word))
            o.times_s.push_back(number_of(element, {1e-9, 1e9, Unit::time_s}));
    } catch (const std::invalid_argument &) {
        if (!path_exists(word)) throw;
        o.times_s.clear();
        o.times_file = word;
    }
}

void declare(Command &command, BracketOptions &o) {
    command.files("FILE", o.files,
                  "pictures of one scene from a stationary camera, or the folder of a sweep: images/ and times.txt");
    command.require("FILE");
    command.numbers("--ev", o.ev, {-64.0, 64.0},
                    "exposures of the pictures, EV, larger = brighter, separated by commas; default from EXIF, else "
                    "unknown");
    command.word(
        "--times", "NUMBER,...|FILE", [&o](const std::string &word) { read_times(word, o); },
        "exposure times instead of --ev, seconds, such as 1/8,1,8 or 1/8s,1s,8s; or a file of lines with name, time "
        "stamp and exposure time; default times.txt in the folder");
    command.folder("-o,--output", o.output, "write the response as pcalib.txt into this folder");
    command.file("--report", o.report, "write a report with charts as one .html file");
    declare_store(command, o.store);
    declare_bracket_fit(command, o);
    declare_json(command, o.json);
    declare_progress(command, o.progress);
}

// The exposures of the command line or of times.txt, EV, NaN where unknown; empty if not given. A folder is replaced by
// its pictures.
std::vector<double> given_exposures(BracketOptions &o, Events &events) {
    const bool is_sweep = o.files.size() == 1 && is_folder(o.files[0]);
    if (is_sweep) {
        const ExposureSweep sweep = find_sweep(o.files[0], events);
        o.files = sweep.files;
        if (o.ev.empty() && o.times_s.empty() && o.times_file.empty()) o.times_file = sweep.times;
    }
    if (!o.times_file.empty()) return read_exposure_times(o.times_file, o.files, is_sweep, events);
    if (!o.ev.empty()) require_count(o.ev.size(), "--ev", o.files.size(), "picture");
    if (!o.ev.empty() || o.times_s.empty()) return o.ev;
    require_count(o.times_s.size(), "--times", o.files.size(), "picture");
    std::vector<double> ev;
    for (const double time_s : o.times_s) ev.push_back(std::log2(time_s));
    return ev;
}

std::vector<lensprof_pair> get_pairs(const BracketOptions &o, const Scene &scene, Progress &progress,
                                     BuildReport &report, uint32_t &channels) {
    lensprof_sample_options options;
    lensprof_sample_options_init(&options);
    options.pairs = o.pixels.pairs;
    options.seed = o.pixels.seed;
    SweepPairs sampled = sample_sweep(scene, o.pixels.max_side, options, o.black, progress);
    channels = sampled.channels;
    report.load_s = sampled.load_s, report.sample_s = sampled.sample_s;
    return sampled.pairs;
}

// The pictures connected by pairs, in order: the largest group, the earlier one of two. The others share almost no
// unclipped grey values with another picture.
std::vector<uint32_t> connected_pictures(const std::vector<lensprof_pair> &pairs, uint32_t count) {
    // Of a sweep's picture that is almost all white, too few pairs agree: up to 50, and a twentieth of the mean.
    const auto mean_pairs = static_cast<uint32_t>(2 * pairs.size() / count);
    const uint32_t least_pairs = count > sweep_in_memory ? std::clamp(mean_pairs / 20, 1u, 50u) : 1;
    std::vector<uint32_t> pair_count(count, 0), size(count, 0), members;
    for (const auto &pair : pairs)
        for (const uint32_t image : pair.image) pair_count[image]++;
    JoinedSets sets(count);
    for (const auto &pair : pairs)
        if (std::min(pair_count[pair.image[0]], pair_count[pair.image[1]]) >= least_pairs)
            sets.join(pair.image[0], pair.image[1]);
    for (uint32_t i = 0; i < count; i++) size[sets.of(i)]++;
    const auto largest = static_cast<uint32_t>(std::max_element(size.begin(), size.end()) - size.begin());
    for (uint32_t i = 0; i < count; i++)
        if (sets.of(i) == largest) members.push_back(i);
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

// Pictures in one line: "a.png to f.png, k.png"; at most eight such ranges.
std::string line_of(const std::vector<uint32_t> &numbers, const std::vector<std::string> &names) {
    constexpr int most_ranges = 8;
    std::string text;
    size_t first = 0;
    for (int range = 0; first < numbers.size() && range < most_ranges; range++) {
        size_t end = first + 1;
        while (end < numbers.size() && numbers[end] == numbers[end - 1] + 1) end++;
        text += (first ? ", " : "") + names[numbers[first]];
        if (end - first > 1) text += (end - first > 2 ? " to " : ", ") + names[numbers[end - 1]];
        first = end;
    }
    if (first < numbers.size()) text += " and " + std::to_string(numbers.size() - first) + " more";
    return text;
}

void warn_of_left_out(const std::vector<uint32_t> &numbers, const std::vector<std::string> &names, Streams &streams) {
    if (numbers.empty()) return;
    const bool is_one = numbers.size() == 1;
    warn(streams,
         line_of(numbers, names) + ": left out" + (is_one ? std::string() : ", " + counted(numbers.size(), "picture"))
             + (is_one ? ": shares" : ": they share") + " almost no unclipped grey values with another picture");
}

// The result of the members at their indices; for the others what is known beforehand, relative to the reference.
void report_members(const std::vector<uint32_t> &members, const std::vector<lensprof_fit_image> &images,
                    const Fitted &fitted, BuildReport &report, Streams &streams) {
    const auto &zero = images[report.reference];
    std::vector<lensprof_fit_image_quality> quality(images.size());
    std::vector<uint32_t> left_out;
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
            left_out.push_back(i);
        }
        report.exposures.push_back(exposure);
    }
    report.quality = quality;
    warn_of_left_out(left_out, report.names, streams);
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
        if (std::isnan(ev[i])) continue;
        input.images[i].known_ev = ev[i];
        input.images[i].known_ev_sigma = o.ev_sigma;
    }
    return input;
}

// Few or no pairs of these members agree with the response, such as of pictures that are almost all white.
std::vector<uint32_t> agreeing_members(const std::vector<uint32_t> &members,
                                       const std::vector<lensprof_fit_image_quality> &quality) {
    constexpr double least_share = 0.2;
    constexpr uint32_t least_inliers = 3;
    std::vector<uint32_t> agreeing;
    for (size_t m = 0; m < members.size(); m++)
        if (quality[m].inliers >= std::max(least_inliers, uint32_t(least_share * quality[m].pairs)))
            agreeing.push_back(static_cast<uint32_t>(m));
    return agreeing;
}

// The fit of a sweep does not fail because of a few pictures: it is repeated without those that disagree.
Fitted fit_members(const BracketOptions &o, const Scene &scene, std::vector<uint32_t> &members, FitInput &input,
                   Progress &progress, BuildReport &report) {
    constexpr double largest_odd_share = 0.1;
    const int most_rounds = scene.files.size() > sweep_in_memory && o.reference.empty() ? 3 : 0;
    const auto members_fit = [&] {
        const auto place = std::find(members.begin(), members.end(), report.reference);
        input.options.reference = static_cast<uint32_t>(place == members.end() ? 0 : place - members.begin());
        report.reference = members[input.options.reference];
        return fit(input, input.options.reference, scene.path, progress, &report.quality);
    };
    Fitted fitted = members_fit();
    for (int round = 0; round < most_rounds && !fitted.result.usable; round++) {
        const auto agreeing = agreeing_members(members, report.quality);
        const size_t odd = members.size() - agreeing.size();
        if (odd == 0 || double(odd) > largest_odd_share * double(members.size())) break;
        keep_only(agreeing, input);
        std::vector<uint32_t> kept;
        for (const uint32_t m : agreeing) kept.push_back(members[m]);
        members = kept;
        fitted = members_fit();
    }
    return fitted;
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
    auto members = connected_pictures(input.pairs, static_cast<uint32_t>(images.size()));
    if (!o.reference.empty() && !std::binary_search(members.begin(), members.end(), report.reference))
        throw Failure(LENSPROF_ERROR_NOT_USABLE,
                      scene.names[report.reference] + ": shares almost no unclipped grey values with another "
                                                        "picture; choose another reference",
                      LENSPROF_REASON_IMAGE_GROUPS);
    keep_only(members, input);
    const Fitted best = fit_members(o, scene, members, input, progress, report);
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

// Name of the response in the output folder, which DSO and its kin read.
std::string response_file(const BracketOptions &o) { return (std::filesystem::path(o.output) / "pcalib.txt").string(); }

std::string pcalib_of(const BuildReport &report, const std::string &file) {
    auto profile = new_profile();
    profile->response[0] = report.fit.response;
    lensprof_export_options options;
    lensprof_export_options_init(&options);
    options.format = LENSPROF_FORMAT_PCALIB;
    return exported(file, {profile.get()}, options);
}

// Adds pcalib.txt to the outputs. A sweep is without falloff, which the readers of pcalib.txt want as well.
void add_response_file(const BracketOptions &o, const BuildReport &report, OutputFiles &outputs, Streams &streams) {
    if (o.output.empty() || !(report.fit.usable || o.store.force)) return;
    make_folder(o.output);
    outputs.add(response_file(o), pcalib_of(report, response_file(o)));
    if (report.fit.gamma_from == LENSPROF_GAMMA_PRIOR)
        warn(streams, response_file(o)
                          + ": no exposure times were used, so its exponent is a guess; give them with --times FILE, or "
                            "as times.txt in the folder, and check those that a note rejects");
    note(streams, response_file(o)
                      + ": the response alone: the falloff is the same in all these pictures and cancels; for "
                        "vignette.png use `lensprof calibrate` on overlapping pictures or `lensprof flat` on a card, then "
                        "`lensprof profile export`");
}

// Without a name of the camera, files of the result are all that is wanted.
bool stores_profile(const BracketOptions &o, const PictureMetadata &metadata) {
    return !o.store.no_store
           && (o.output.empty() || *metadata.key.camera_model || !o.store.camera.empty() || !o.store.lens.empty());
}

int bracket_and_store(BracketOptions o, Streams &streams) {
    Progress events(streams);
    std::vector<double> ev = given_exposures(o, events);
    check_report(o.report, o.files, o.store);
    if (!o.output.empty()) check_output_folder(o.output);
    Scene scene = static_scene(o.files, o.free_balance);
    check_pictures(scene, o.pixels.max_side, sweep_in_memory);
    note_several(scene.files, events);
    require_one_kind(scene.files);
    std::vector<PictureMetadata> metadata;
    for (const std::string &file : scene.files) metadata.push_back(read_metadata(file));
    o.store.no_store = !stores_profile(o, metadata[0]);
    lensprof_profile_key key = camera_key(o.store, metadata[0], scene.files[0], events);
    check_store(o.store);
    CameraKind kind = camera_kind_of(o.fit, key, metadata[0]);
    if (kind.kind == LENSPROF_CAMERA_LINEAR && !o.fit.camera_kind && !raw_kind(scene.files[0]))
        kind = {};  // the response is wanted; that of a camera raw file is known
    OutputFiles outputs;
    Json page;
    BuildReport report = fit_bracket(o, scene, metadata, ev, kind, page, streams);
    add_response_file(o, report, outputs, streams);
    return finish_fit(
        report, key, o.store,
        {o.fit.method == LENSPROF_METHOD_TRANSFER ? "bracket" : std::string("bracket ") + method_name(o.fit.method),
         scene.path, o.json, false, o.report, &page, &outputs},
        streams);
}

int run(const BracketOptions &o, Streams &streams) {
    check_max_side(o.pixels.max_side);
    check_fit_options(o.fit);
    check_store_options(o.store, false, !o.output.empty());
    if (!o.ev.empty() && !(o.times_s.empty() && o.times_file.empty()))
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
