#include "cli/fitting/fitting.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "cli/fitting/fit_page.hpp"
#include "cli/fitting/project.hpp"
#include "cli/program/exit_code.hpp"
#include "cli/program/interrupt.hpp"
#include "cli/program/message.hpp"
#include "cli/program/options.hpp"
#include "cli/report/falloff.hpp"
#include "photo/base/events.hpp"
#include "photo/base/format.hpp"
#include "photo/pictures/orientation.hpp"
#include "photo/pictures/rotated_profile.hpp"

namespace lensprof {
int on_fit_progress(double done, void *progress) {
    static_cast<Progress *>(progress)->update("fitting", done);
    return interrupted();
}

const char *method_name(uint32_t method) {
    static const char *const names[] = {"transfer", "radiance", "transfer-function"};
    return method <= LENSPROF_METHOD_TRANSFER_FUNCTION ? names[method] : "unknown";
}

namespace {

void declare_method(Keys &keys, FitOptions &o) {
    keys.choice("method", o.method,
                {{"transfer", LENSPROF_METHOD_TRANSFER},
                 {"radiance", LENSPROF_METHOD_RADIANCE},
                 {"transfer-function", LENSPROF_METHOD_TRANSFER_FUNCTION}},
                "transfer (d'Angelo 2007, default), radiance (Goldman & Chen 2005: one radiance per scene point, seen "
                "by any number of pictures, saturated ones included) or transfer-function (Kim & Pollefeys 2004)");
}

Choices<std::optional<uint32_t>> camera_kind_choices() {
    Choices<std::optional<uint32_t>> choices{{"auto", std::nullopt}};
    for (uint32_t kind = LENSPROF_CAMERA_ANY; kind <= LENSPROF_CAMERA_LINEAR; kind++)
        choices.emplace_back(camera_kind_name(kind), kind);
    return choices;
}

void declare_prior(Keys &keys, FitOptions &o, bool may_be_stored) {
    keys.number("prior", o.prior_weight, {0.0, 1e6},
                std::string("weight of the priors") + (may_be_stored ? ", stored ones included" : "")
                    + "; default 1; 0 = none, as in the paper");
    if (!may_be_stored) return;
    keys.word(
        "stored", "auto|none|ID",
        [&o](const std::string &word) {
            o.stored = word != "none";
            o.stored_is_requested = o.stored;
            o.stored_id = !o.stored || word == "auto" ? 0 : profile_id_of(word);
        },
        "prior from the databases: auto (default), the profile stored for this lens and setting, else the known "
        "falloff of the lens and response of the camera; ID, a profile; none");
}

void declare_gamma(Keys &keys, FitOptions &o, bool known_response) {
    Choices<uint32_t> gamma = {
        {"auto", LENSPROF_GAMMA_AUTO}, {"exif", LENSPROF_GAMMA_EXPOSURES}, {"prior", LENSPROF_GAMMA_PRIOR}};
    std::string about =
        "source of the common exponent of exposure, falloff and response: auto (default: differing EXIF exposures and "
        "the prior, weighted by standard error), exif, prior";
    if (known_response) {
        gamma.emplace_back("known", LENSPROF_GAMMA_KNOWN);
        about += ", known (the project's response)";
    }
    keys.choice("gamma-from", o.gamma_from, gamma, about);
}

}  // namespace

Keys declare_fit(Command &command, FitOptions &o, FitChoices choices) {
    Keys keys = command.expert().keys("--fit", "how the pictures are fitted");
    declare_method(keys, o);
    const auto read_modes = [&o](const std::string &word) {
        o.modes = word == "auto" ? LENSPROF_MODES_AUTO : count_of(word, 0, LENSPROF_EMOR_MODES);
    };
    keys.word("modes", "COUNT|auto", read_modes,
              "number of EMoR modes of the response, 0 to 25, or auto (default: chosen by held-out error)");
    keys.choice("loss", o.loss,
                {{"robust", LENSPROF_LOSS_ROBUST}, {"huber", LENSPROF_LOSS_HUBER}, {"squared", LENSPROF_LOSS_SQUARED}},
                "loss function: robust (default), huber (as in the paper) or squared");
    keys.number("huber", o.huber, {0.01, 255.0}, "sigma of the Huber loss, levels of 255; default 5");
    declare_prior(keys, o, choices.stored_prior);
    declare_gamma(keys, o, choices.known_response);
    keys.number("exif-sigma", o.exif_sigma, {0.0, 10.0},
                "standard error of EXIF exposures, EV; default 0.1, or 0.03 for pictures at one manual exposure; 0 = "
                "ignore EXIF exposures");
    keys.choice("camera-kind", o.camera_kind, camera_kind_choices(),
                "kind of camera that the prior describes: camera or phone (today's JPEG), digital (of the 1990s), film "
                "(scanned), linear (the response is fixed as linear), any, or auto (default: according to EXIF)");
    return keys;
}

void declare_sampling(Keys &keys, SamplingOptions &o, const std::string &default_pairs) {
    keys.count("pairs", o.pairs, 0, 1 << 24, "number of pairs; default 0 = " + default_pairs);
    keys.count("seed", o.seed, 0, UINT32_MAX, "seed of the sampling; default 1");
    declare_max_side(keys, o.max_side);
}

void declare_max_side(Keys &keys, uint32_t &max_side) {
    keys.count("max-side", max_side, 0, UINT32_MAX,
               format("read pictures reduced to at least this many pixels on the longer side; default %u; 0 = full "
                      "size",
                      max_side));
}

bool uses_stored_prior(const FitOptions &o) {
    return o.stored && o.prior_weight > 0.0
           && (o.method == LENSPROF_METHOD_TRANSFER || o.method == LENSPROF_METHOD_RADIANCE);
}

void check_fit_options(const FitOptions &o) {
    if (o.stored_is_requested && !uses_stored_prior(o))
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--fit stored: needs --fit method=transfer or radiance, and a prior above 0");
    if (o.gamma_from == LENSPROF_GAMMA_EXPOSURES && o.exif_sigma == 0.0)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--fit gamma-from=exif and exif-sigma=0 (ignore EXIF) exclude each other; omit one of them");
}

lensprof_fit_options fit_options(const FitOptions &o) {
    lensprof_fit_options options;
    lensprof_fit_options_init(&options);
    options.method = o.method;
    options.modes = o.modes;
    options.loss = o.loss;
    options.camera_kind = o.camera_kind.value_or(LENSPROF_CAMERA_ANY);
    options.huber_levels = o.huber;
    options.prior_weight = o.prior_weight;
    if (o.gamma_from == LENSPROF_GAMMA_KNOWN)
        options.free &= ~LENSPROF_FREE_RESPONSE;
    else
        options.gamma_from = o.gamma_from;
    return options;
}

CameraKind camera_kind_of(const FitOptions &o, lensprof_profile_key key, const PictureMetadata &metadata) {
    if (o.camera_kind) return {*o.camera_kind, KindFrom::option};
    key.processing = metadata.processing_before;
    const uint32_t kind = lensprof_camera_kind_of(&key);
    const bool is_camera_output =
        kind == LENSPROF_CAMERA_LINEAR || (kind != LENSPROF_CAMERA_ANY && metadata.is_of_camera);
    if (!is_camera_output) return {};  // anything but the camera's JPEG was developed by other software
    return {kind, KindFrom::pictures};
}

size_t joined_images(const Fitted &fitted) { return joined_images(fitted.exposures); }

size_t joined_images(const std::vector<lensprof_exposure> &exposures) {
    return static_cast<size_t>(std::count_if(exposures.begin(), exposures.end(),
                                             [](const lensprof_exposure &e) { return !std::isnan(e.ev); }));
}

// Asks a fit for all that it found.
static void ask(const lensprof_fit &held, const std::vector<lensprof_fit_image> &images, Fitted &fitted,
                std::vector<lensprof_fit_image_quality> *quality) {
    lensprof_error error{};
    lensprof_fit_result_init(&fitted.result);
    check(lensprof_fit_setting_at(&held, LENSPROF_FIT_REFERENCE, &fitted.result, &error), "fit", &error);
    fitted.settings.assign(fitted.result.setting_count, fitted.result);
    for (uint32_t s = 0; s < fitted.result.setting_count; s++)
        check(lensprof_fit_setting_at(&held, s, &fitted.settings[s], &error), "fit", &error);
    fitted.cameras.resize(fitted.result.camera_count);
    for (uint32_t k = 0; k < fitted.result.camera_count; k++) {
        lensprof_fit_camera_init(&fitted.cameras[k]);
        check(lensprof_fit_camera_at(&held, k, &fitted.cameras[k], &error), "fit", &error);
    }
    const bool has_one_setting = fitted.settings.size() == 1, has_one_camera = fitted.cameras.size() == 1;
    for (uint32_t i = 0; i < images.size(); i++) {
        fitted.setting_of.push_back(has_one_setting ? 0 : images[i].setting);
        fitted.camera_of.push_back(has_one_camera ? 0 : images[i].camera);
        if (!quality) continue;
        lensprof_fit_image_quality_init(&(*quality)[i]);
        check(lensprof_fit_image_at(&held, i, &(*quality)[i], &error), "fit", &error);
    }
}

// A place in a picture, as in the frame of its setting.
template <class Number>
static void turn_place(uint16_t turn, const lensprof_fit_image &stored, Number xy[2]) {
    const uint32_t size[2] = {stored.width, stored.height};
    double x = xy[0] - 0.5 * (size[0] - 1.0), y = xy[1] - 0.5 * (size[1] - 1.0);
    turn_upright(turn, x, y);
    xy[0] = static_cast<Number>(x + 0.5 * (size[swaps_sides(turn)] - 1.0));
    xy[1] = static_cast<Number>(y + 0.5 * (size[!swaps_sides(turn)] - 1.0));
}

// All pictures in the frames of their settings.
static FitInput rotated_input(const FitInput &input) {
    FitInput rotated = input;
    rotated.turn_of.clear();
    for (lensprof_pair &pair : rotated.pairs)
        for (int side = 0; side < 2; side++)
            turn_place(input.turn_of[pair.image[side]], input.images[pair.image[side]], pair.xy[side]);
    for (lensprof_observation &observation : rotated.observations)
        turn_place(input.turn_of[observation.image], input.images[observation.image], observation.xy);
    for (size_t i = 0; i < rotated.images.size(); i++)
        if (swaps_sides(input.turn_of[i])) std::swap(rotated.images[i].width, rotated.images[i].height);
    double *centre = rotated.options.vignetting.center;  // of the reference
    turn_upright(input.turn_of[input.options.reference], centre[0], centre[1]);
    return rotated;
}

std::array<lensprof_vignetting, 3> Fitted::falloff_of(uint32_t image) const {
    std::array<lensprof_vignetting, 3> falloff;
    const lensprof_vignetting *of_setting =
        settings.empty() ? result.vignetting : settings[setting_of[image]].vignetting;
    std::copy_n(of_setting, falloff.size(), falloff.begin());
    for (lensprof_vignetting &curve : falloff)
        if (!turn_of.empty()) turn_upright(inverse_orientation(turn_of[image]), curve.center[0], curve.center[1]);
    return falloff;
}

Fitted fit(FitInput &input, uint32_t reference, const std::string &item, Progress &progress,
           std::vector<lensprof_fit_image_quality> *quality) {
    if (!input.turn_of.empty()) {
        FitInput rotated = rotated_input(input);
        Fitted in_settings = fit(rotated, reference, item, progress, quality);
        in_settings.turn_of = input.turn_of;
        return in_settings;
    }
    Fitted fitted;
    auto count = static_cast<uint32_t>(input.images.size());
    fitted.exposures.resize(count);
    if (quality) quality->resize(count);
    lensprof_fit *held = nullptr;
    input.options.progress = on_fit_progress;
    input.options.progress_user = &progress;
    input.options.points = input.points.empty() ? nullptr : input.points.data();
    input.options.view_distances = input.view_distances.empty() ? nullptr : input.view_distances.data();
    lensprof_error error{};
    const auto *images = input.images.data();
    auto pairs = static_cast<uint32_t>(input.pairs.size()),
         observations = static_cast<uint32_t>(input.observations.size());
    lensprof_status status =
        observations ? lensprof_fit_radiance(&input.options, images, count, input.observations.data(), observations,
                                             nullptr, 0, fitted.exposures.data(), &held, &error)
                     : lensprof_fit_overlap(&input.options, images, count, input.pairs.data(), pairs, nullptr, 0,
                                            fitted.exposures.data(), &held, &error);
    fitted.held = {held, lensprof_fit_destroy};
    stop_if_cancelled();
    if (status == LENSPROF_ERROR_NO_UNKNOWNS)
        throw Failure(LENSPROF_ERROR_ARGUMENT, item + ": no parameter is estimated; give --fit free=all");
    check(status, item, &error);
    ask(*held, input.images, fitted, quality);
    fitted.verdict = verdict_of(held);
    fitted.reference = std::isnan(fitted.exposures[reference].ev) ? fitted.result.reference : reference;
    fitted.exposures = relative_exposures(fitted.exposures, fitted.reference);
    return fitted;
}

BuildReport no_fit(const std::vector<std::string> &names, const Failure &failure) {
    BuildReport report;
    report.names = names;
    report.exposures.resize(names.size());
    for (auto &e : report.exposures) lensprof_exposure_init(&e);
    lensprof_fit_result_init(&report.fit);
    lensprof_response_set_linear(&report.fit.response);
    report.fit.heldout_rms = report.fit.heldout_median = report.fit.before_rms = LENSPROF_UNKNOWN;
    report.fit.gamma_from = LENSPROF_GAMMA_NONE;
    report.fit.gamma_sigma = LENSPROF_UNKNOWN;
    report.fit.vignettings = 1;
    report.quality.resize(names.size());
    report.verdict.refuse(failure.reason, failure.what());
    return report;
}

// Reports the other images with wrong known exposures; the verdict reports the worst.
void note_wrong_exposures(const BuildReport &report, Streams &streams) {
    const Finding *worst = report.verdict.find(LENSPROF_REASON_KNOWN_WRONG);
    if (!worst) return;
    for (size_t i = 0; i < report.quality.size(); i++) {
        const auto &q = report.quality[i];
        if (q.known_ev_left_out && i != worst->item.index)
            note(streams, report.names[i]
                              + format(": its exposure differs from the known one by %.1f EV; the known one is not "
                                       "used",
                                       std::fabs(q.known_ev_residual)));
    }
}

// Whether the camera of an image is part of the result; a single camera always is.
static bool is_camera_joined(const BuildReport &report, size_t image) {
    return report.cameras.empty() || report.cameras[report.camera_of[image]].found.joined;
}

// Reports the cameras that are not part of the result, with reasons.
static void warn_of_unjoined_cameras(const BuildReport &report, const std::string &source, Streams &streams) {
    for (uint32_t k = 0; k < report.cameras.size(); k++) {
        const CameraReport &camera = report.cameras[k];
        if (camera.found.joined) continue;
        const auto fitted_setting =
            std::find_if(report.settings.begin(), report.settings.end(),
                         [&](const SettingReport &setting) { return setting.camera == k && setting.found.images; });
        const std::string left_out = source + ": " + camera.label + ": left out: ";
        if (!camera.found.images)
            warn(streams, left_out + "no two of its pictures overlap enough; give more of them, or use --one-lens to "
                                     "treat all as one camera");
        else if (!camera.fit.equalizes && fitted_setting != report.settings.end() && !fitted_setting->found.usable)
            warn(streams, left_out + "its pictures cannot be corrected: " + fitted_setting->verdict.headline());
        else
            warn(streams, left_out + "its overlap with pictures of the other cameras is too small or inconsistent; "
                                     "give more that overlap");
    }
}

// Whether an image that was left out took part in a fit first, or shows something else than those it overlaps.
static bool disagrees(const BuildReport &report, size_t image) {
    return report.quality[image].pairs > 0
           || std::any_of(report.links.begin(), report.links.end(), [=](const lensprof_link &link) {
                  return link.state == LENSPROF_LINK_CONTRADICTED && (link.image[0] == image || link.image[1] == image);
              });
}

// Reports the images that are left out, even if the verdict is about them.
void warn_of_unjoined_images(const BuildReport &report, Streams &streams) {
    for (size_t i = 0; i < report.quality.size() && report.fit.left_out; i++)
        if (!report.quality[i].joined && is_camera_joined(report, i))
            warn(streams, report.names[i]
                              + (disagrees(report, i) ? ": left out: it disagrees with the others; check its alignment"
                                                      : ": left out: no pair connects it to the others; add pictures "
                                                        "that overlap it, or check its alignment"));
}

std::string not_usable_text(const std::string &source, const Verdict &verdict, const StoreOptions &store) {
    return source + ": not usable: " + verdict.headline()
           + (store.force || store.no_store ? "" : "; nothing was stored (use --force to store it anyway)");
}

namespace {

// The profile of one setting, which is stored if `is_usable` or forced.
int64_t store_setting(const BuildReport &report, const SettingReport &setting, bool is_usable,
                      const StoreOptions &store, const Finish &finish) {
    const EarlierProfile *prior = finish.prior;
    auto profile = profile_of(*report.held, setting.number);
    profile->key = setting.key;
    profile->provenance.not_usable = !is_usable;
    if (setting.is_turn_unknown) turn_profile_to_sensor(0, *profile);
    const int64_t prior_id = prior && holds_prior(setting.found) && prior->is_own ? prior->id : 0;
    return store_profile(store, *profile, {finish.method, finish.source, is_usable, prior_id});
}

// Stores the profiles of every usable lens setting, or of all with --force.
void store_result(BuildReport &report, const lensprof_profile_key &key, const StoreOptions &store,
                  const Finish &finish) {
    const bool is_wanted = report.fit.usable || store.force;
    if (report.settings.empty() && is_wanted) {
        SettingReport single;
        single.key = key, single.is_reference = true, single.is_turn_unknown = report.is_turn_unknown;
        single.number = LENSPROF_FIT_REFERENCE, single.found = report.fit;
        report.profile_id = store_setting(report, single, report.fit.usable != 0, store, finish);
    }
    std::vector<SettingReport *> order;  // the reference first
    for (SettingReport &setting : report.settings) order.push_back(&setting);
    std::stable_partition(order.begin(), order.end(), [](const SettingReport *s) { return s->is_reference; });
    std::set<std::string> keys;
    for (SettingReport *entry : order) {
        SettingReport &setting = *entry;
        if (!setting.found.images || !(setting.found.usable || store.force) || !setting.no_key.empty()) continue;
        setting.has_same_key = !keys.insert(describe_key(setting.key)).second;
        if (setting.has_same_key) continue;  // a lookup could not distinguish them
        setting.profile_id = store_setting(report, setting, setting.found.usable != 0, store, finish);
        if (setting.is_reference) report.profile_id = setting.profile_id;
    }
}

// Prints where profiles were stored.
void print_stored(const BuildReport &report, const lensprof_profile_key &key, const StoreOptions &store,
                  std::ostream &out) {
    const auto print = [&](int64_t id, const lensprof_profile_key &stored_key) {
        if (id)
            out << "stored    profile " << id << " in " << store_path(store.db) << ": " << describe_key(stored_key)
                << "\n";
    };
    if (report.settings.empty()) print(report.profile_id, key);
    for (const SettingReport &setting : report.settings) print(setting.profile_id, setting.key);
}

// Reports which of several settings give no profile, and why.
void warn_of_unstored_settings(const BuildReport &report, const std::string &source, Streams &streams) {
    for (const SettingReport &setting : report.settings)
        if (setting.found.images && setting.found.usable && !setting.no_key.empty())
            warn(streams, source + ": " + setting.label + ": not stored: " + setting.no_key);
    for (const SettingReport &setting : report.settings)
        if (setting.has_same_key)
            warn(streams, source + ": " + setting.label
                              + ": not stored: another setting has the same camera, lens, focal length and aperture");
    for (const SettingReport &setting : report.settings)
        if (!setting.found.usable && !setting.is_reference)
            warn(streams, source + ": " + setting.label
                              + (setting.found.images ? ": not stored as a profile: " + setting.verdict.headline()
                                                      : ": not stored: none of its pictures agrees with the others"));
}

bool is_any_usable(const BuildReport &report) {
    return report.fit.usable || std::any_of(report.settings.begin(), report.settings.end(), [](const auto &setting) {
               return setting.found.images && setting.found.usable;
           });
}

// Everything that is wrong with a result, on standard error. Whether the command succeeds.
bool report_problems(const BuildReport &report, const StoreOptions &store, const Finish &finish, Streams &streams) {
    if (report.fit.usable) report_findings(report.verdict, finish.source, streams);
    const bool equalizes = finish.equalizes_pictures && report.fit.equalizes;
    if (report.fit.usable) note_wrong_exposures(report, streams);
    if (report.fit.usable || equalizes)
        warn_of_unjoined_cameras(report, finish.source, streams), warn_of_unjoined_images(report, streams);
    const bool is_good = is_any_usable(report) || (store.no_store && equalizes);
    if (!report.fit.usable && is_good)
        warn(streams, finish.source
                          + (report.fit.equalizes ? ": corrects these pictures, but is not stored as a profile: "
                                                  : ": the setting of the reference is not stored as a profile: ")
                          + report.verdict.headline());
    if (is_good) warn_of_unstored_settings(report, finish.source, streams);
    if (!is_good)
        print_message(streams,
                      not_usable_text(finish.source, report.verdict, store)
                          + (equalizes ? "; it does correct these pictures: use --no-store to accept it" : ""));
    return is_good;
}

}  // namespace

int finish_fit(BuildReport &report, const lensprof_profile_key &key, const StoreOptions &store, const Finish &finish,
               Streams &streams) {
    stop_if_cancelled();
    if (!store.no_store) store_result(report, key, store, finish);
    std::ostringstream messages;  // after the result, but known before the outputs are complete
    Streams message_streams = streams.with(streams.out, messages);
    const bool is_good = report_problems(report, store, finish, message_streams);
    if (!finish.report.empty())
        finish.outputs->add(finish.report, fit_page(std::move(*finish.page), report, message_streams.warnings));
    if (finish.outputs) finish.outputs->commit();
    if (finish.json)
        print_json(build_json(report), streams.out);
    else
        print_build(report, streams.out);
    if (!finish.json) print_stored(report, key, store, streams.out);
    streams.err << messages.str();
    return static_cast<int>(is_good ? ExitCode::done : ExitCode::not_usable);
}

void check_max_side(uint32_t max_side) {
    if (max_side != 0 && max_side < 64)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--fit max-side: fewer than 64 pixels give too few samples; give more, or 0 for full size");
}

double lap(std::chrono::steady_clock::time_point &since) {
    auto now = std::chrono::steady_clock::now();
    double seconds = std::chrono::duration<double>(now - since).count();
    since = now;
    return seconds;
}

}  // namespace lensprof
