// Fit, profile, project and mosaic of each panorama.
#include <algorithm>

#include "photo/base/events.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/base/utf8.hpp"
#include "photo/calibration/calibration.hpp"
#include "photo/calibration/exposure_file.hpp"
#include "photo/calibration/outcome.hpp"
#include "photo/correct/scene_model.hpp"
#include "photo/folder/attempt.hpp"
#include "photo/folder/panoramas.hpp"
#include "photo/scene/exposure_reader.hpp"
#include "photo/scene/hugin_project.hpp"
#include "photo/scene/photographs.hpp"

namespace lensprof {
namespace {

// File names need not be UTF-8: invalid bytes are replaced.
Json valid_json(const Json &json) { return Json::parse(json.dump(-1, ' ', false, Json::error_handler_t::replace)); }

Scene scene_of(const Panorama &panorama) {
    Scene scene;
    scene.path = panorama.source;
    for (const InputPicture *picture : panorama.pictures) {
        scene.files.push_back(picture->file);
        scene.names.push_back(picture->name);
        scene.metadata.push_back(picture->metadata);
    }
    set_found(panorama.found, scene);
    return scene;
}

// The warnings while a fit was prepared, and those of its result.
Json warnings_of(const NoticeList &before, const Outcome &outcome) {
    Json warnings = Json::array();
    const auto add = [&](const Notice &notice) {
        if (notice.severity == LENSPROF_SEVERITY_WARNING) warnings.push_back(one_line(notice.line()));
    };
    std::for_each(before.list.begin(), before.list.end(), add);
    std::for_each(outcome.notices.list.begin(), outcome.notices.list.end(), add);
    return warnings;
}

// The result of a fit as calibrate.json has it.
Json result_of(const BuildReport &report) {
    Json result = kept_in_utf8(build_json(report));
    result.erase("seconds");
    result.erase("schema");
    return result;
}

// Notices are kept for the summary; the rest is passed on.
class PanoramaEvents : public ForwardedEvents {
public:
    using ForwardedEvents::ForwardedEvents;

    void notice(uint32_t severity, const std::string &item, const std::string &text) override {
        kept.notice(severity, item, text);
    }
    NoticeList kept;
};

// The panorama is not stored if EXIF does not name camera and lens, unless the caller names them.
void choose_storing(const FolderOptions &o, const lensprof_profile_key &exif, bool by_matches, Panorama &panorama,
                    StoreOptions &store) {
    panorama.summary["not_stored"] = nullptr;
    if (o.store.no_store) panorama.summary["not_stored"] = option_name("no_store");
    if (o.store.no_store || *exif.camera_model || *exif.lens) return;
    store.no_store = true;
    panorama.summary["not_stored"] =
        "EXIF does not name camera and lens" + advice(by_matches ? "name_pictures" : "name_project");
}

// Fits and stores; the project text goes to `outputs`, which are committed with the profile.
void fit_and_store(const FolderOptions &o, Panorama &panorama, Scene &scene, Events &of_folder) {
    PanoramaEvents events(of_folder);
    SceneFitOptions options;
    options.store = o.store;
    options.one_lens = o.one_lens;
    if (panorama.summary["camera"] == camera_stationary)
        throw Failure(LENSPROF_ERROR_NOT_USABLE, panorama.name + still_camera_reason(), LENSPROF_REASON_FEW_PAIRS);
    choose_storing(o, scene.metadata[scene.reference].key, scene.by_matches, panorama, options.store);
    if (panorama.summary["cameras_fit"] == false) events.warn(panorama.name, poor_cameras_note);
    Calibration calibration(scene, options, events);
    SceneFit &state = calibration.fit;
    OutputFiles outputs;
    outputs.add(panorama.project, state.best.corrects()
                                      ? result_text(state, calibration.scene, panorama.project)
                                      : pto_text(*hugin_project(calibration.scene, panorama.project)));
    stop_if_cancelled();
    if (!options.store.no_store)
        store_result(state.report, calibration.key, options.store,
                     {method_name(options.fit.method), scene.path, &calibration.prior});
    const Outcome outcome = outcome_of(state.report, options.store, scene.path, true);
    outputs.commit();
    const bool is_stored = state.report.profile_id != 0;
    if (!is_stored && (!options.store.no_store || !state.report.fit.usable))
        panorama.summary["not_stored"] = state.report.verdict.text();
    panorama.summary["key"] = key_json(calibration.key);
    panorama.summary["database"] = is_stored ? Json(store_path(options.store.db)) : Json();
    panorama.summary["warnings"] = warnings_of(events.kept, outcome);
    panorama.summary["result"] = result_of(state.report);
    panorama.exposures.clear();
    if (state.best.corrects())
        panorama.exposures = exposures_text(state, calibration.scene, calibration.metadata, panorama.project);
    if (o.describe)
        panorama.page = valid_json(
            o.describe(calibration, panorama.summary["warnings"].get<std::vector<std::string>>(), of_folder));
}

// A failed panorama does not stop the others. If a picture could not be read, the next run tries again; if the pictures
// are unsuitable, it does not.
void fit_one(const FolderOptions &o, Panorama &panorama, Ledger &ledger, Events &events) {
    Scene scene = scene_of(panorama);
    ledger.begin(panorama.project, panorama.key);
    ledger.save();
    bool is_final = true;
    try {
        fit_and_store(o, panorama, scene, events);
    } catch (const Failure &failure) {
        if (!is_of_pictures(failure)) throw;
        is_final = failure.group() == LENSPROF_ERROR_NOT_USABLE;
        panorama.summary["result"] = nullptr;
        panorama.summary["not_stored"] = failure.what();
        panorama.summary["warnings"] = Json::array();
        write_hugin_project(scene, panorama.project);
    }
    ledger.finish(panorama.project);
    const std::string text = read_text(panorama.project, max_text_bytes);
    panorama.written = digest_of_text(text);
    Json files = Json::array();
    for (const InputPicture *picture : panorama.pictures) files.push_back(ascii_path(canonical_path(picture->file)));
    panorama.summary = valid_json(panorama.summary);
    ledger.notes["results"][ascii_path(panorama.name)] = {{"key", is_final ? panorama.key : std::string()},
                                                          {"files", files},
                                                          {"source", ascii_path(panorama.source)},
                                                          {"summary", panorama.summary},
                                                          {"page", panorama.page},
                                                          {"exposures", ascii_path(panorama.exposures)},
                                                          {"project", ascii_path(text)}};
    ledger.save();
    panorama.summary["project"] = panorama.project;  // its bytes, as recall() has them
}

// Whether the profile that an earlier run stored is still there.
bool is_stored(const FolderOptions &o, const Json &summary) {
    const Json &result = summary["result"];
    const auto has_profile = [](const Json &setting) { return !setting["profile"].is_null(); };
    if (!result.is_object()
        || (result["profile"].is_null()
            && std::none_of(result["settings"].begin(), result["settings"].end(), has_profile)))
        return true;
    if (!path_exists(store_path(o.store.db))) return false;
    const Store store = open_store(o.store.db, LENSPROF_STORE_READ);
    auto profile = new_profile();
    const auto is_there = [&](const Json &id) {
        return id.is_null()
               || lensprof_store_get(store.get(), id.get<int64_t>(), profile.get(), nullptr) == LENSPROF_OK;
    };
    bool all = is_there(result["profile"]);
    for (const Json &setting : result["settings"]) all = all && is_there(setting["profile"]);
    return all;
}

// The result of an earlier run with its project, which is rewritten if somebody removed it.
bool recall(const FolderOptions &o, Panorama &panorama, Ledger &ledger) {
    const Json &notes = ledger.notes;
    const std::string name = ascii_path(panorama.name);
    if (!notes.contains("results") || !notes["results"].contains(name)) return false;
    const Json &known = notes["results"][name];
    if (known.value("key", "") != panorama.key || !is_stored(o, known["summary"])) return false;
    const bool is_fitted = known["summary"]["result"].is_object();
    if (is_fitted && o.describe && known.value("page", Json()).is_null()) return false;  // of a caller without a report
    panorama.summary = known["summary"];
    panorama.page = known.value("page", Json());
    panorama.exposures = path_of_ascii(known.value("exposures", std::string()));
    panorama.summary["project"] = panorama.project;  // the folder may be spelled differently
    const std::string text = path_of_ascii(known["project"].get<std::string>());
    panorama.written = digest_of_text(text);
    if (ledger.is_current(panorama.project, panorama.key)) return true;
    ledger.begin(panorama.project, panorama.key);
    ledger.save();
    write_file(panorama.project, text.data(), text.size());
    ledger.finish(panorama.project);
    ledger.save();
    return true;
}

}  // namespace

bool Panorama::is_edited() const { return written != digest_of_text(read_text(project, max_text_bytes)); }

Scene Panorama::corrected_scene() const {
    Scene scene = read_hugin_project(project);
    if (exposures.empty() || is_edited()) return scene;
    const Scene known = exposures_of(exposures, project, "");
    const ImagesByFile images(known);
    for (uint32_t i = 0; i < scene.images.size(); i++) {
        const auto image = images.find(scene.files[i]);
        if (!image) return scene;
        scene.models[i] = known.models[*image];
        scene.images[i].exposure = known.images[*image].exposure;
        scene.images[i].left_out = known.images[*image].left_out;
        if (*image == known.reference) scene.reference = i;
    }
    return scene;
}

void fit_panoramas(const FolderOptions &o, Panoramas &panoramas, Ledger &ledger, Events &events) {
    for (Panorama &panorama : panoramas.list) {
        stop_if_cancelled();
        if (!recall(o, panorama, ledger)) {
            fit_one(o, panorama, ledger, events);
            panoramas.fitted++;
        }
        for (const Json &warning : panorama.summary["warnings"]) events.warn({}, warning.get<std::string>());
        if (!panorama.equalizes()) continue;
        if (panorama.is_edited())
            events.note(panorama.project, "was edited since the fit; its pictures are corrected as it states");
    }
}

}  // namespace lensprof
