#include "photo/calibration/outcome.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "photo/base/format.hpp"
#include "photo/pictures/rotated_profile.hpp"
#include "photo/report/falloff.hpp"

namespace lensprof {
namespace {

// Reports the other images with wrong known exposures; the verdict reports the worst.
void note_wrong_exposures(const BuildReport &report, Events &events) {
    const Finding *worst = report.verdict.find(LENSPROF_REASON_KNOWN_WRONG);
    if (!worst) return;
    for (size_t i = 0; i < report.quality.size(); i++) {
        const auto &q = report.quality[i];
        if (q.known_ev_left_out && i != worst->item.index)
            events.note(report.names[i],
                        format("its exposure differs from the known one by %.1f EV; the known one is not used",
                               std::fabs(q.known_ev_residual)));
    }
}

// Whether the camera of an image is part of the result; a single camera always is.
bool is_camera_joined(const BuildReport &report, size_t image) {
    return report.cameras.empty() || report.cameras[report.camera_of[image]].found.joined;
}

// Reports the cameras that are not part of the result, with reasons.
static void warn_of_unjoined_cameras(const BuildReport &report, const std::string &source, Events &events) {
    for (uint32_t k = 0; k < report.cameras.size(); k++) {
        const CameraReport &camera = report.cameras[k];
        if (camera.found.joined) continue;
        const auto fitted_setting =
            std::find_if(report.settings.begin(), report.settings.end(),
                         [&](const SettingReport &setting) { return setting.camera == k && setting.found.images; });
        const std::string left_out = camera.label + ": left out: ";
        if (!camera.found.images)
            events.warn(source, left_out + "no two of its pictures overlap enough; give more of them, or use "
                                    + option_name("one_lens") + " to treat all as one camera");
        else if (!camera.fit.equalizes && fitted_setting != report.settings.end() && !fitted_setting->found.usable)
            events.warn(source, left_out + "its pictures cannot be corrected: " + fitted_setting->verdict.headline());
        else
            events.warn(source, left_out + "its overlap with pictures of the other cameras is too small or inconsistent; "
                                     "give more that overlap");
    }
}

// Whether an image that was left out took part in a fit first, or shows something else than those it overlaps.
bool disagrees(const BuildReport &report, size_t image) {
    return report.quality[image].pairs > 0
           || std::any_of(report.links.begin(), report.links.end(), [=](const lensprof_link &link) {
                  return link.state == LENSPROF_LINK_CONTRADICTED && (link.image[0] == image || link.image[1] == image);
              });
}

// Reports the images that are left out, even if the verdict is about them.
void warn_of_unjoined_images(const BuildReport &report, Events &events) {
    for (size_t i = 0; i < report.quality.size() && report.fit.left_out; i++)
        if (!report.quality[i].joined && is_camera_joined(report, i))
            events.warn(report.names[i], disagrees(report, i)
                                             ? "left out: it disagrees with the others; check its alignment"
                                             : "left out: no pair connects it to the others; add pictures that overlap "
                                               "it, or check its alignment");
}

}  // namespace

std::unique_ptr<lensprof_profile> profile_of_setting(const BuildReport &report, const SettingReport &setting,
                                                     const Storing &how) {
    auto profile = profile_of(*report.held, setting.number);
    profile->key = setting.key;
    profile->levels = report.levels;
    lensprof_provenance &provenance = profile->provenance;
    provenance.not_usable = !setting.found.usable;
    set_text(provenance.method, sizeof provenance.method, how.method);
    set_text(provenance.source, sizeof provenance.source, source_of(how.source));
    if (setting.is_turn_unknown) turn_profile_to_sensor(0, *profile);
    return profile;
}

std::string not_usable_text(const std::string &source, const Verdict &verdict, const StoreOptions &store) {
    return source + ": not usable: " + verdict.headline()
           + (store.force || store.no_store ? std::string() : "; nothing was stored" + advice("force"));
}

namespace {

int64_t store_setting(const BuildReport &report, const SettingReport &setting, const StoreOptions &store,
                      const Storing &how) {
    const bool is_usable = setting.found.usable != 0;
    const EarlierProfile *prior = how.prior;
    const auto profile = profile_of_setting(report, setting, how);
    const bool holds = prior && holds_prior(setting.found);
    const int64_t prior_id = holds && prior->is_own ? prior->id : 0;
    if (holds && prior->profile) profile->image_circle = prior->profile->image_circle;  // no overlaps show it
    return store_profile(store, *profile, {how.method, how.source, is_usable, prior_id});
}

// Reports which of several settings give no profile, and why.
void warn_of_unstored_settings(const BuildReport &report, const std::string &source, Events &events) {
    for (const SettingReport &setting : report.settings)
        if (setting.found.images && setting.found.usable && !setting.no_key.empty())
            events.warn(source, setting.label + ": not stored: " + setting.no_key);
    for (const SettingReport &setting : report.settings)
        if (setting.has_same_key)
            events.warn(
                source,
                setting.label + ": not stored: another setting has the same camera, lens, focal length and aperture");
    for (const SettingReport &setting : report.settings)
        if (!setting.found.usable && !setting.is_reference)
            events.warn(source,
                        setting.label
                            + (setting.found.images ? ": not stored as a profile: " + setting.verdict.headline()
                                                    : ": not stored: none of its pictures agrees with the others"));
}

bool is_any_usable(const BuildReport &report) {
    return report.fit.usable || std::any_of(report.settings.begin(), report.settings.end(), [](const auto &setting) {
               return setting.found.images && setting.found.usable;
           });
}

}  // namespace

Outcome outcome_of(const BuildReport &report, const StoreOptions &store, const std::string &source,
                   bool equalizes_pictures) {
    Outcome outcome;
    Events &events = outcome.notices;
    if (report.fit.usable) report_findings(report.verdict, source, events);
    const bool equalizes = equalizes_pictures && report.fit.equalizes;
    if (report.fit.usable) note_wrong_exposures(report, events);
    if (report.fit.usable || equalizes)
        warn_of_unjoined_cameras(report, source, events), warn_of_unjoined_images(report, events);
    outcome.is_good = is_any_usable(report) || (store.no_store && equalizes);
    if (!report.fit.usable && outcome.is_good)
        events.warn(source, (report.fit.equalizes ? "corrects these pictures, but is not stored as a profile: "
                                                  : "the setting of the reference is not stored as a profile: ")
                                + report.verdict.headline());
    if (outcome.is_good)
        warn_of_unstored_settings(report, source, events);
    else
        outcome.refusal = not_usable_text(source, report.verdict, store) + (equalizes ? advice("accept") : "");
    return outcome;
}

// Stores the profiles of every usable lens setting, or of all if forced.
void store_result(BuildReport &report, const lensprof_profile_key &key, const StoreOptions &store, const Storing &how) {
    const bool is_wanted = report.fit.usable || store.force;
    if (report.settings.empty() && is_wanted) {
        SettingReport single;
        single.key = key, single.is_reference = true, single.is_turn_unknown = report.is_turn_unknown;
        single.number = LENSPROF_FIT_REFERENCE, single.found = report.fit;
        report.profile_id = store_setting(report, single, store, how);
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
        setting.profile_id = store_setting(report, setting, store, how);
        if (setting.is_reference) report.profile_id = setting.profile_id;
    }
}

}  // namespace lensprof
