#include "cli/profiles/check_against.hpp"

#include <algorithm>
#include <sstream>

#include <nlohmann/json.hpp>

#include "cli/profiles/trial_report.hpp"
#include "cli/program/exit_code.hpp"
#include "cli/program/message.hpp"
#include "cli/program/progress.hpp"
#include "photo/base/library.hpp"
#include "photo/calibration/scene_trial.hpp"
#include "photo/scene/open_scene.hpp"

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
    TrialReport report(store_path(db), scene.path, profiles);
    std::vector<const lensprof_profile *> given;
    for (const StoredProfile &stored : profiles) given.push_back(stored.profile.get());
    report.candidates = SceneTrial(scene, false, progress).run(given, &report.result);
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
