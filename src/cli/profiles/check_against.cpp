#include "cli/profiles/check_against.hpp"

#include <algorithm>
#include <sstream>

#include <nlohmann/json.hpp>

#include "cli/profiles/trial_report.hpp"
#include "cli/program/exit_code.hpp"
#include "cli/program/message.hpp"
#include "cli/program/progress.hpp"
#include "photo/base/format.hpp"
#include "photo/base/library.hpp"
#include "photo/calibration/known_exposures.hpp"
#include "photo/calibration/scene_fit.hpp"
#include "photo/scene/open_scene.hpp"
#include "photo/scene/scene_pictures.hpp"

namespace lensprof {
namespace {

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

void warn_of_earlier_correction(const Scene &scene, const std::vector<PictureMetadata> &metadata, Streams &streams) {
    for (size_t i = 0; i < metadata.size(); i++)
        if (!metadata[i].corrected_by.empty()) {
            warn(streams, scene.names[i] + ": its falloff was corrected before, " + metadata[i].corrected_by
                              + "; only the remaining falloff is measured");
            return;
        }
}

// Runs the trial on the pictures.
void measure(const Scene &scene, const std::vector<StoredProfile> &profiles, Progress &progress, Streams &streams,
             TrialReport &report) {
    const std::vector<PictureMetadata> metadata = picture_metadata({}, scene);
    const SceneFitOptions options;
    if (!scene.is_reconstruction) check_pictures(scene, options.pixels.max_side);
    DrawnPairs sampled = first_pairs(options, scene, progress);
    progress.clear();
    uint32_t first = 0;
    const std::vector<lensprof_pair> pairs =
        pairs_of_one_setting(scene, metadata, std::move(sampled.pairs), first, streams);
    warn_of_earlier_correction(scene, metadata, streams);
    lensprof_trial_options trial;
    lensprof_trial_options_init(&trial);
    trial.channels = sampled.channels;
    trial.camera_kind = camera_kind_of({}, metadata[first].key, metadata[first]).kind;
    std::vector<const lensprof_profile *> given;
    for (const StoredProfile &stored : profiles) given.push_back(stored.profile.get());
    std::vector<lensprof_fit_image> images = fit_images(scene);
    WarningsAlone warnings(progress);
    add_known_exposures(options.fit, scene, metadata, images, warnings);
    lensprof_error error{};
    const lensprof_status status = lensprof_trial_run(
        &trial, images.data(), static_cast<uint32_t>(images.size()), pairs.data(), static_cast<uint32_t>(pairs.size()),
        given.data(), static_cast<uint32_t>(given.size()), report.candidates.data(), &report.result, &error);
    if (status == LENSPROF_ERROR_NO_SAMPLES)
        throw Failure(LENSPROF_ERROR_NOT_USABLE, scene.path + ": " + error.text, LENSPROF_REASON_FEW_PAIRS);
    check(status, scene.path, &error);
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
    TrialReport report(store_path(db), scene.path, profiles);
    measure(scene, profiles, progress, streams, report);
    if (json)
        print_json(trial_json(report), streams.out);
    else
        print_trial(report, streams.out);
    if (report.result.usable) return static_cast<int>(ExitCode::done);
    print_message(streams, scene.path
                      + ": no profile is better than leaving the falloff uncorrected; give profiles of this lens and "
                        "setting, or make one with `lensprof build`");
    return static_cast<int>(ExitCode::not_usable);
}

}  // namespace lensprof
