#include "cli/profiles/check_against.hpp"

#include <algorithm>
#include <sstream>

#include <nlohmann/json.hpp>

#include "cli/profiles/profile_trial.hpp"
#include "cli/profiles/trial_report.hpp"
#include "cli/program/exit_code.hpp"
#include "cli/program/message.hpp"
#include "cli/program/progress.hpp"
#include "photo/base/format.hpp"
#include "photo/base/library.hpp"
#include "photo/calibration/scene_fit.hpp"
#include "photo/scene/open_scene.hpp"
#include "photo/scene/scene_pictures.hpp"

namespace lensprof {
namespace {

constexpr size_t kMinMeasuredPairs = 30;  // pairs

bool is_number(const std::string &word) {
    return !word.empty() && word.find_first_not_of("0123456789") == std::string::npos;
}

// Numbers are ids, used once each; other words are further pictures, as a shell expands --against *.jpg.
void split_words(const AgainstOptions &o, std::vector<int64_t> &ids, std::vector<std::string> &pictures) {
    pictures = o.pictures;
    for (const std::string &word : o.words) {
        if (!is_number(word)) {
            pictures.push_back(word);
            continue;
        }
        int64_t id = 0;
        try {
            id = profile_id_of(word);
        } catch (const std::invalid_argument &wrong) {
            throw Failure(LENSPROF_ERROR_ARGUMENT, "profile check: " + std::string(wrong.what()));
        }
        if (std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
    }
    if (o.pictures.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, (o.words.empty() ? std::string("--images") : o.words[0])
                                           + ": unexpected argument without --against, which names the pictures to "
                                             "check profiles against; see `lensprof help profile check`");
    if (ids.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--against: needs profile ids; see `lensprof profile list`");
}

std::vector<StoredProfile> read_by_ids(const std::string &db, const std::vector<int64_t> &ids) {
    const Store store = open_store(db, LENSPROF_STORE_READ);
    std::vector<StoredProfile> profiles;
    for (const int64_t id : ids) {
        profiles.push_back({id, new_profile()});
        lensprof_error error{};
        check(lensprof_store_get(store.get(), id, profiles.back().profile.get(), &error), store_path(db), &error);
    }
    return profiles;
}

// Notes on a scene announce estimates, which are not made here; warnings concern the pictures.
class WarningsAlone : public ForwardedEvents {
public:
    using ForwardedEvents::ForwardedEvents;

    void notice(uint32_t severity, const std::string &item, const std::string &text) override {
        if (severity == LENSPROF_SEVERITY_WARNING) ForwardedEvents::notice(severity, item, text);
    }
};

// The pairs of one camera at one lens setting, as in a profile: the setting with most pairs. `first` receives its image
// with most metadata.
std::vector<lensprof_pair> pairs_of_one_setting(const Scene &scene, const std::vector<PictureMetadata> &metadata,
                                                std::vector<lensprof_pair> pairs, uint32_t &first, Streams &streams) {
    const LensSettings settings = lens_settings(scene, metadata, {}, false);
    std::vector<size_t> count(settings.first.size());
    const auto setting_of = [&](const lensprof_pair &pair, int side) { return settings.of_image[pair.image[side]]; };
    const auto has_one_setting = [&](const lensprof_pair &pair) { return setting_of(pair, 0) == setting_of(pair, 1); };
    for (const lensprof_pair &pair : pairs)
        if (has_one_setting(pair)) count[setting_of(pair, 0)]++;
    const auto main_setting = static_cast<uint32_t>(std::max_element(count.begin(), count.end()) - count.begin());
    first = settings.first[main_setting];
    const auto is_portrait = [&](uint32_t i) { return scene.images[i].camera.height > scene.images[i].camera.width; };
    const auto is_like_first = [&](uint32_t i) {  // the centre of a profile is in one frame
        return settings.of_image[i] == main_setting && is_portrait(i) == is_portrait(first);
    };
    size_t other_pictures = 0;
    for (uint32_t i = 0; i < scene.images.size(); i++) other_pictures += !is_like_first(i);
    if (other_pictures)
        warn(streams, scene.path + ": " + counted(other_pictures, "picture")
                          + " of another camera, size or lens setting left out, since a profile describes one "
                            "setting; using those of " + describe_setting(metadata[first].key, scene.names[first]));
    const auto is_other = [&](const lensprof_pair &p) {
        return !is_like_first(p.image[0]) || !is_like_first(p.image[1]);
    };
    pairs.erase(std::remove_if(pairs.begin(), pairs.end(), is_other), pairs.end());
    return pairs;
}

TrialErrors try_candidate(const TrialPairs &pairs, const Candidate &candidate, const lensprof_profile *falloff) {
    return try_model(pairs, {falloff, candidate.responses.data(), static_cast<uint32_t>(candidate.responses.size())});
}

// For rendered pictures only the falloff of a raw profile applies.
bool has_response(const lensprof_profile &profile) {
    return profile.key.processing != LENSPROF_PROCESSING_RAW || profile.response[0].kind != LENSPROF_RESPONSE_LINEAR;
}

// The response of the pictures: that of sensor data is linear.
void use_profile_response(const lensprof_profile &profile, uint32_t camera_kind, Candidate &candidate) {
    candidate.response_from = ResponseOf::own;
    candidate.responses.assign(profile.response, profile.response + profile.responses);
    if (camera_kind != LENSPROF_CAMERA_LINEAR) return;
    candidate.response_from = ResponseOf::sensor;
    candidate.responses.resize(1);
    lensprof_response_set_linear(&candidate.responses[0]);
}

// For a candidate without a response of its own: the best one, of the kind of camera or of a profile.
void use_best_response(const TrialPairs &pairs, const std::vector<Candidate> &profiles, uint32_t camera_kind,
                       const lensprof_profile *falloff, Candidate &candidate) {
    candidate.response_from = camera_kind == LENSPROF_CAMERA_LINEAR ? ResponseOf::sensor : ResponseOf::kind;
    candidate.responses.resize(1);
    lensprof_error error{};
    check(lensprof_response_set_typical(&candidate.responses[0], camera_kind, nullptr, nullptr), "response", &error);
    candidate.errors = try_candidate(pairs, candidate, falloff);
    const auto rms_of = [](const TrialErrors &errors) {  // of what is not an outlier
        return figures_of(errors, explained_pairs({errors})).rms;
    };
    for (const Candidate &other : profiles) {
        if (other.response_from != ResponseOf::own) continue;
        TrialErrors errors = try_candidate(pairs, other, falloff);
        if (rms_of(errors) >= rms_of(candidate.errors)) continue;
        candidate.errors = std::move(errors);
        candidate.response_from = ResponseOf::other, candidate.response_id = other.id;
    }
}

std::vector<Candidate> try_profiles(const TrialPairs &pairs, const std::vector<StoredProfile> &profiles,
                                    uint32_t camera_kind) {
    std::vector<Candidate> candidates(profiles.size());
    for (size_t i = 0; i < profiles.size(); i++) {
        const lensprof_profile &profile = *profiles[i].profile;
        candidates[i].id = profiles[i].id, candidates[i].label = describe_key(profile.key);
        candidates[i].has_falloff = has_falloff(profile);
        if (!has_response(profile) && camera_kind != LENSPROF_CAMERA_LINEAR) continue;
        use_profile_response(profile, camera_kind, candidates[i]);
        candidates[i].errors = try_candidate(pairs, candidates[i], &profile);
    }
    for (size_t i = 0; i < profiles.size(); i++)
        if (candidates[i].responses.empty())
            use_best_response(pairs, candidates, camera_kind, profiles[i].profile.get(), candidates[i]);
    return candidates;
}

void warn_of_earlier_correction(const Scene &scene, const std::vector<PictureMetadata> &metadata, Streams &streams) {
    for (size_t i = 0; i < metadata.size(); i++)
        if (!metadata[i].corrected_by.empty()) {
            warn(streams, scene.names[i] + ": its falloff was corrected before, " + metadata[i].corrected_by
                              + "; only the remaining falloff is measured");
            return;
        }
}

// The measured report; figures are filled in.
TrialReport measure(const Scene &scene, const std::vector<StoredProfile> &profiles, Progress &progress,
                    Streams &streams) {
    const std::vector<PictureMetadata> metadata = picture_metadata({}, scene);
    const SceneFitOptions options;
    if (!scene.is_reconstruction) check_pictures(scene, options.pixels.max_side);
    DrawnPairs sampled = first_pairs(options, scene, progress);
    progress.clear();
    uint32_t first = 0;
    sampled.pairs = pairs_of_one_setting(scene, metadata, std::move(sampled.pairs), first, streams);
    warn_of_earlier_correction(scene, metadata, streams);
    const uint32_t kind = camera_kind_of({}, metadata[first].key, metadata[first]).kind;
    TrialReport report;
    report.pairs = split_for_trial(fit_images(scene), sampled.pairs, sampled.channels);
    if (report.pairs.heldout.size() < kMinMeasuredPairs)
        throw Failure(LENSPROF_ERROR_NOT_USABLE,
                      scene.path
                          + format(": its overlaps contain %zu usable pairs, but at least %zu are needed; give "
                                   "pictures that overlap by a third",
                                   report.pairs.heldout.size(), kMinMeasuredPairs),
                      LENSPROF_REASON_FEW_PAIRS);
    report.profiles = try_profiles(report.pairs, profiles, kind);
    use_best_response(report.pairs, report.profiles, kind, nullptr, report.none);
    compare(report);
    return report;
}

}  // namespace

void declare_against(Command &command, AgainstOptions &o) {
    command.texts("ID", o.words, "profiles to compare with --against, and further pictures");
    command.words(
        "--against", "FILE", [&o](const std::string &word) { o.pictures.push_back(word); },
        "compare the profiles on these overlapping pictures (folders or files, such as *.jpg), Hugin project or "
        "reconstruction, and report which fits best");
    command.folder("--images", o.images, "folder of the reconstruction's pictures; default next to the reconstruction");
    declare_progress(command, o.progress);
}

int run_against(const AgainstOptions &o, const std::string &db, bool json, Streams &streams) {
    std::vector<int64_t> ids;
    std::vector<std::string> pictures;
    split_words(o, ids, pictures);
    const std::vector<StoredProfile> profiles = read_by_ids(db, ids);
    Progress progress(streams, o.progress);
    WarningsAlone warnings(progress);
    SceneOptions options;
    options.reconstruction.images = o.images;
    const Scene scene = open_scene(pictures, options, warnings);
    if (scene.images.size() < 2)
        throw Failure(LENSPROF_ERROR_NOT_USABLE, scene.path + ": has only one image; give at least two that overlap",
                      LENSPROF_REASON_FEW_PAIRS);
    TrialReport report = measure(scene, profiles, progress, streams);
    report.file = store_path(db), report.path = scene.path;
    if (json)
        print_json(trial_json(report), streams.out);
    else
        print_trial(report, streams.out);
    if (report.is_any_better()) return static_cast<int>(ExitCode::done);
    print_message(streams, scene.path
                      + ": no profile is better than leaving the falloff uncorrected; give profiles of this lens and "
                        "setting, or make one with `lensprof build`");
    return static_cast<int>(ExitCode::not_usable);
}

}  // namespace lensprof
