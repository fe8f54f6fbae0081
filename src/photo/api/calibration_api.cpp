// Scenes calibrated, and results asked, stored and saved.
#include <cmath>
#include <filesystem>

#include "photo/api/handles.hpp"
#include "photo/api/sized.hpp"
#include "photo/base/paths.hpp"
#include "photo/calibration/exposure_file.hpp"
#include "photo/calibration/outcome.hpp"
#include "photo/correct/scene_model.hpp"
#include "photo/report/falloff.hpp"
#include "photo/scene/exposure_reader.hpp"
#include "photo/scene/hugin_project.hpp"

namespace lensprof {
namespace {

constexpr size_t first_calibrate_options = LENSPROF_FIRST(lensprof_calibrate_options, key),
                 first_calibration_info = LENSPROF_FIRST(lensprof_calibration_info, equalizes);

// What is known of a key.
StoreOptions store_of(const lensprof_profile_key &key) {
    StoreOptions o;
    o.maker = key.camera_maker, o.camera = key.camera_model, o.lens = key.lens, o.unit = key.unit, o.style = key.style;
    o.crop_factor = key.crop_factor, o.focal = key.focal_mm, o.aperture = key.aperture, o.distance = key.distance_m;
    if (key.processing != LENSPROF_PROCESSING_JPEG) o.processing = key.processing;  // JPEG: also if unknown
    return o;
}

void check_options(const lensprof_calibrate_options &given) {
    const auto refuse = [](bool is_wrong, const char *what) {
        if (is_wrong) throw Failure(LENSPROF_ERROR_ARGUMENT, what);
    };
    refuse(given.method > LENSPROF_METHOD_RADIANCE, "method: is unknown");
    refuse(given.falloff_curves != 0 && given.falloff_curves != 1 && given.falloff_curves != 3,
           "falloff_curves: is neither 0, 1 nor 3");
    refuse(!std::isfinite(given.exif_sigma), "exif_sigma: is not finite");
    refuse(given.free & ~(LENSPROF_FREE_LENS | LENSPROF_FREE_IMAGE), "free: has unknown parameters");
    refuse(given.max_side && given.max_side < 64, "max_side: is below 64");
    refuse(given.camera_kind > LENSPROF_CAMERA_LINEAR && given.camera_kind != LENSPROF_CAMERA_AUTO,
           "camera_kind: is unknown");
    refuse(given.sampling > LENSPROF_SAMPLING_PAPER, "sampling: is neither BALANCED nor PAPER");
    refuse(given.key && lensprof_profile_key_validate(given.key) != LENSPROF_OK, "key: has values out of range");
}

// The options of a fit that the caller gives; nothing is stored yet.
SceneFitOptions options_of(const lensprof_calibrate_options &from) {
    check_options(from);
    SceneFitOptions o;
    if (from.key) o.store = store_of(*from.key);
    o.store.no_store = true;
    o.store.dbs = databases_of(from);
    if (!o.store.dbs.empty()) o.store.db = o.store.dbs.front();
    o.fit.method = from.method, o.fit.modes = from.modes, o.fit.loss = from.loss;
    o.fit.gamma_from = from.gamma_from;
    o.fit.prior_weight = from.prior_weight, o.fit.huber = from.huber_levels;
    if (from.camera_kind != LENSPROF_CAMERA_AUTO) o.fit.camera_kind = from.camera_kind;
    if (!(from.exif_sigma < 0.0)) o.fit.exif_sigma = from.exif_sigma;
    o.fit.stored = from.use_stored != 0;
    o.falloff_curves = from.falloff_curves;
    o.free = from.free;
    o.pixels = {from.seed, from.pairs, from.max_side};
    o.sampling = from.sampling;
    if (from.reference) o.reference = from.reference;
    o.one_lens = from.one_lens != 0;
    return o;
}

// The settings of a result; without several, the only one.
std::vector<SettingReport> settings_of(const Calibration &calibration) {
    const BuildReport &report = calibration.fit.report;
    if (!report.settings.empty()) return report.settings;
    SettingReport single;
    single.key = calibration.key, single.is_reference = true, single.is_turn_unknown = report.is_turn_unknown;
    single.number = LENSPROF_FIT_REFERENCE, single.found = report.fit;
    return {single};
}

Storing storing_of(const Calibration &calibration) {
    return {method_name(calibration.options.fit.method), calibration.scene.path, &calibration.prior};
}

const Calibration &fitted(const lensprof_calibration *calibration) {
    require(calibration, "calibration");
    if (!calibration->of_scene)
        throw Failure(LENSPROF_ERROR_ARGUMENT, calibration->result.path + ": was opened, and has no fit");
    return *calibration->of_scene;
}

void require_known(const lensprof_profile_key &key, const std::string &file) {
    if (!*key.camera_model && !*key.lens)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      file + ": EXIF names neither camera nor lens; set the key of the profile and store that");
}

std::string file_text(const lensprof_calibration &handle, const std::string &path) {
    const Calibration &calibration = fitted(&handle);
    const std::string kind = lowercase_extension(path);
    if (!handle.corrects())
        throw Failure(LENSPROF_ERROR_NOT_USABLE, path + ": not written: " + calibration.fit.report.verdict.headline());
    if (kind == "pto") return result_text(calibration.fit, calibration.scene, path);
    if (kind == "json" && std::filesystem::path(path).filename().string().rfind("exposures", 0) == 0)
        return exposures_text(calibration.fit, calibration.scene, calibration.metadata, path);
    lensprof_export_options options;
    lensprof_export_options_init(&options);
    options.format = lensprof_format_detect(nullptr, 0, path.c_str());
    const lensprof_format_info *format = lensprof_format_get_info(options.format);
    if (!format || !format->is_written || options.format == LENSPROF_FORMAT_MAP
        || options.format == LENSPROF_FORMAT_DNG_OPCODES)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      path + ": the name is not that of a format that holds a profile; use .pto, exposures.json, "
                             "profile.json or another of lensprof/formats.h");
    const auto settings = settings_of(calibration);
    const SettingReport *reference = &settings[0];
    for (const SettingReport &setting : settings)
        if (setting.is_reference) reference = &setting;
    options.width = calibration.scene.images[calibration.scene.reference].camera.width;
    options.height = calibration.scene.images[calibration.scene.reference].camera.height;
    const auto profile = profile_of_setting(calibration.fit.report, *reference, storing_of(calibration));
    const lensprof_profile *profiles[] = {profile.get()};
    return written(path, [&](void *data, size_t capacity, size_t *count, lensprof_error *why) {
        return lensprof_export(profiles, 1, &options, data, capacity, count, why);
    });
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

void lensprof_calibrate_options_init_sized(lensprof_calibrate_options *options, size_t size) {
    lensprof_init_sized(options, size);
    if (size < first_calibrate_options) return;
    options->modes = LENSPROF_MODES_AUTO, options->loss = LENSPROF_LOSS_ROBUST;
    options->gamma_from = LENSPROF_GAMMA_AUTO;
    options->seed = 1, options->max_side = SamplingOptions{}.max_side;
    options->use_stored = 1;
    options->prior_weight = 1.0, options->exif_sigma = -1.0;
    options->camera_kind = LENSPROF_CAMERA_AUTO, options->huber_levels = FitOptions{}.huber;
}

lensprof_status lensprof_calibrate(const lensprof_scene *scene, const lensprof_calibrate_options *given,
                                   const lensprof_events *events, lensprof_calibration **calibration,
                                   lensprof_error *error) {
    std::unique_ptr<lensprof_calibration> handle(new (std::nothrow) lensprof_calibration);
    if (!handle) return report_failure(LENSPROF_ERROR_MEMORY, "calibration: out of memory", error);
    return photo_call("calibration", handle->events, error, [&] {
        handle->events.set(events);
        require(scene, "scene"), require(calibration, "calibration");
        lensprof_calibrate_options defaults;
        lensprof_calibrate_options_init(&defaults);
        const auto options = options_of(taken(given, defaults, first_calibrate_options, "options"));
        handle->of_scene.emplace(scene->scene, options, handle->events);
        report_findings(handle->of_scene->fit.report.verdict, scene->scene.path, handle->events);
        handle->result = with_result(*handle->of_scene);
        handle->exposures = handle->of_scene->fit.best.exposures;
        handle->events.set(nullptr);
        *calibration = handle.release();
    });
}

lensprof_status lensprof_calibration_open(const char *path, const char *images, lensprof_calibration **calibration,
                                          lensprof_error *error) {
    return photo_call("calibration", error, [&] {
        require(path, "path"), require(calibration, "calibration");
        auto handle = std::make_unique<lensprof_calibration>();
        handle->result = is_exposure_file(path) ? read_exposures(path, images ? images : "") : read_hugin_project(path);
        handle->exposures = relative_to_joined(handle->result);
        *calibration = handle.release();
    });
}

void lensprof_calibration_destroy(lensprof_calibration *calibration) { delete calibration; }

const lensprof_fit *lensprof_calibration_get_fit(const lensprof_calibration *calibration) {
    return calibration && calibration->of_scene ? calibration->of_scene->fit.best.held.get() : nullptr;
}

lensprof_status lensprof_calibration_get_info(const lensprof_calibration *calibration, lensprof_calibration_info *info,
                                              lensprof_error *error) {
    return photo_call("calibration", error, [&] {
        require(calibration, "calibration"), require(info, "info");
        lensprof_calibration_info found;
        lensprof_calibration_info_init(&found);
        found.images = static_cast<uint32_t>(calibration->result.images.size());
        found.equalizes = calibration->corrects();
        if (calibration->of_scene) {
            found.profiles = static_cast<uint32_t>(settings_of(*calibration->of_scene).size());
            found.findings = static_cast<uint32_t>(calibration->of_scene->fit.report.verdict.findings.size());
            found.usable = calibration->of_scene->fit.best.result.usable;
        }
        give(found, info, first_calibration_info, "info");
    });
}

lensprof_status lensprof_calibration_image_at(const lensprof_calibration *calibration, uint32_t index,
                                              const char **name, const char **file, lensprof_error *error) {
    return photo_call("calibration", error, [&] {
        require(calibration, "calibration"), require_index(index, calibration->result.images.size(), "image");
        if (name) *name = calibration->result.names[index].c_str();
        if (file) *file = calibration->result.files[index].c_str();
    });
}

lensprof_status lensprof_calibration_exposure_at(const lensprof_calibration *calibration, uint32_t image,
                                                 lensprof_exposure *exposure, double *errors, lensprof_error *error) {
    return photo_call("calibration", error, [&] {
        require(calibration, "calibration"), require(exposure, "exposure");
        const Scene &result = calibration->result;
        require_index(image, result.images.size(), "image");
        *exposure = calibration->exposures[image];
        if (result.images[image].left_out) exposure->ev = NAN;
        if (!errors) return;
        std::fill(errors, errors + 4, NAN);
        if (!calibration->of_scene || result.images[image].left_out) return;
        const auto &quality = calibration->of_scene->fit.report.quality[image];
        errors[0] = quality.ev_sigma;
        std::copy_n(quality.white_balance_sigma, 3, errors + 1);
    });
}

lensprof_status lensprof_calibration_profile_at(const lensprof_calibration *calibration, uint32_t index,
                                                lensprof_profile *profile, lensprof_error *error) {
    return photo_call("calibration", error, [&] {
        require(profile, "profile");
        const auto settings = settings_of(fitted(calibration));
        require_index(index, settings.size(), "profile");
        if (!settings[index].found.images)
            throw Failure(LENSPROF_ERROR_NOT_FOUND, settings[index].label + ": none of its pictures agrees with the "
                                                                            "others, so that it has no profile");
        const auto found =
            profile_of_setting(calibration->of_scene->fit.report, settings[index], storing_of(*calibration->of_scene));
        check(lensprof_profile_copy(profile, found.get()), "profile");
    });
}

lensprof_status lensprof_calibration_finding_at(const lensprof_calibration *calibration, uint32_t index,
                                                lensprof_finding *finding, lensprof_error *error) {
    return photo_call("calibration", error, [&] {
        require(finding, "finding");
        const auto &findings = fitted(calibration).fit.report.verdict.findings;
        require_index(index, findings.size(), "finding");
        const Finding &from = findings[index];
        lensprof_finding found;
        lensprof_finding_init(&found);
        found.code = from.code, found.severity = from.severity, found.rule_severity = from.severity;
        found.item = from.item, found.measured = from.measured, found.limit = from.limit;
        found.value_count = static_cast<uint32_t>(std::min(from.values.size(), std::size(found.value)));
        std::copy_n(from.values.begin(), found.value_count, found.value);
        set_text(found.text, sizeof found.text, from.text);
        give(found, finding, LENSPROF_FIRST(lensprof_finding, text), "finding");
    });
}

lensprof_status lensprof_calibration_store(lensprof_calibration *calibration, const char *database, uint32_t *stored,
                                           lensprof_error *error) {
    return photo_call("calibration", error, [&] {
        const Calibration &of = fitted(calibration);
        BuildReport report = of.fit.report;
        StoreOptions store = of.options.store;
        store.no_store = false, store.db = database ? database : "";
        const auto is_unnamed = [](const SettingReport &s) { return !*s.key.camera_model && !*s.key.lens; };
        if (std::all_of(report.settings.begin(), report.settings.end(), is_unnamed))
            require_known(of.key, of.scene.path);
        for (SettingReport &setting : report.settings)
            if (is_unnamed(setting)) setting.no_key = "EXIF names neither camera nor lens";
        store_result(report, of.key, store, storing_of(of));
        uint32_t count = report.settings.empty() && report.profile_id;
        for (const SettingReport &setting : report.settings) count += setting.profile_id != 0;
        if (!count) throw Failure(LENSPROF_ERROR_NOT_USABLE, not_usable_text(of.scene.path, report.verdict, store));
        if (stored) *stored = count;
    });
}

lensprof_status lensprof_calibration_save(lensprof_calibration *calibration, const char *path, lensprof_error *error) {
    return photo_call("calibration", error, [&] {
        require(calibration, "calibration"), require(path, "path");
        refuse_own_file(path, "result", calibration->result);
        const std::string text = file_text(*calibration, path);
        write_file(path, text.data(), text.size());
    });
}
