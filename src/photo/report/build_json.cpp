// The JSON object of `build`.
#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "photo/pictures/picture_levels.hpp"
#include "photo/report/report.hpp"

namespace lensprof {
namespace {

Json numbers(const double *values, size_t count) { return std::vector<double>(values, values + count); }

// Exposure and quality per image.
Json images_json(const BuildReport &report) {
    Json images = Json::array();
    for (size_t i = 0; i < report.names.size(); i++) {
        const auto &e = report.exposures[i];
        Json image = {{"file", report.names[i]},
                      {"ev", std::isnan(e.ev) ? Json() : Json(e.ev)},
                      {"white_balance", is_left_out(report, i) ? Json() : numbers(e.white_balance, 3)}};
        if (!report.settings.empty()) image["setting"] = report.setting_of[i];
        if (!report.cameras.empty()) image["camera"] = report.camera_of[i];
        if (i < report.quality.size()) {
            const auto &q = report.quality[i];
            image["ev_sigma"] = q.ev_sigma;
            image["white_balance_sigma"] = numbers(q.white_balance_sigma, 3);
            image["median_residual"] = q.pairs ? Json(q.median_residual) : Json();
            image["known_ev_residual"] = q.known_ev_residual;
            image["known_ev_left_out"] = q.known_ev_left_out != 0;
            image["pairs"] = q.pairs;
            image["inliers"] = q.inliers;
            image["component"] = q.component;
            image["joined"] = q.joined != 0;
            image["radius"] = q.radius;
            image["grey"] = {q.grey_low, q.grey_high};
        } else {
            image["median_residual"] = Json();
        }
        images.push_back(image);
    }
    return images;
}

Json links_json(const std::vector<lensprof_link> &links) {
    static const char *const states[] = {"unverified", "verified", "contradicted"};
    Json list = Json::array();
    for (const lensprof_link &link : links)
        list.push_back({{"images", {link.image[0], link.image[1]}},
                        {"state", states[std::min<uint32_t>(link.state, LENSPROF_LINK_CONTRADICTED)]},
                        {"verified", link.state == LENSPROF_LINK_VERIFIED},
                        {"pairs", link.pairs}});
    return list;
}

const char *model_name(uint32_t model) {
    switch (model) {
    case LENSPROF_FIT_MODEL_FULL: return "full";
    case LENSPROF_FIT_MODEL_LENS: return "lens";
    case LENSPROF_FIT_MODEL_EXPOSURES: return "exposures";
    default: return "nothing";
    }
}

const char *response_from_name(uint32_t from) {
    static const char *const names[] = {"pictures", "options", "kind", "profile"};
    return from <= LENSPROF_FIT_RESPONSE_PROFILE ? names[from] : "unknown";
}

const char *kind_from_name(KindFrom from) {
    static const char *const names[] = {"none", "option", "pictures", "reconstruction"};
    return names[static_cast<int>(from)];
}

Json left_out_json(const BuildReport &report) {
    Json list = Json::array();
    for (const auto &[file, reason] : report.left_out) list.push_back({{"file", file}, {"reason", reason}});
    return list;
}

// The results per lens setting, if there are several.
Json settings_json(const BuildReport &report) {
    Json list = Json::array();
    for (const SettingReport &setting : report.settings) {
        const lensprof_fit_result &found = setting.found;
        Json json;
        json["label"] = setting.label;
        if (!report.cameras.empty()) json["camera"] = setting.camera;
        json["key"] = key_json(setting.key);
        json["reference"] = setting.is_reference;
        json["images"] = found.images;
        json["pairs"] = found.setting_pairs;
        json["usable"] = found.images && found.usable;
        add_verdict(setting.verdict, json);
        json["vignetting"] = found.images ? vignetting_json(found.vignetting, found.vignettings) : Json();
        json["coverage"] = std::vector<uint32_t>(found.radius_ends, found.radius_ends + LENSPROF_COVERAGE_BINS);
        json["covariance"] = found.images ? covariance_json(found.covariance, found.covariance_size) : Json();
        json["profile"] = setting.profile_id ? Json(setting.profile_id) : Json();
        list.push_back(json);
    }
    return list;
}

// The source of the exponent, its standard error, and the sensitivity of every parameter to it.
Json gamma_json(const BuildReport &report) {
    const auto &fit = report.fit;
    Json correlation = Json::array();
    for (uint32_t i = 0; i < fit.covariance_size; i++) {
        double sigma = std::sqrt(fit.covariance[i * fit.covariance_size + i]);
        correlation.push_back(sigma > 0.0 ? fit.gamma_sigma * fit.gamma_direction[i] / sigma : 0.0);
    }
    Json json;
    json["from"] = gamma_name(fit.gamma_from);
    json["sigma"] = number_or_null(fit.gamma_sigma);
    json["camera_kind"] = camera_kind_name(report.camera_kind.kind);
    json["camera_kind_from"] = kind_from_name(report.camera_kind.from);
    json["direction"] = numbers(fit.gamma_direction, fit.covariance_size);
    json["correlation"] = correlation;
    return json;
}

// Why the stored profile, or a part of it, was not used.
std::string prior_reason(const BuildReport &report) {
    for (const lensprof_reason code : {LENSPROF_REASON_PRIOR_OVERRULED, LENSPROF_REASON_PRIOR_RESPONSE_OVERRULED,
                                       LENSPROF_REASON_PRIOR_FALLOFF_OVERRULED})
        if (const Finding *finding = report.verdict.find(code)) return finding->text;
    return report.no_prior;
}

// The stored profile used as the prior; null if none was requested.
Json prior_json(const BuildReport &report) {
    static const Json overruled[] = {Json::array(), Json::array(), {"response", "falloff"}, {"response"}, {"falloff"}};
    const uint32_t verdict = report.fit.profile_prior;
    if (!report.prior_id && report.no_prior.empty()) return Json();
    return {{"profile", report.prior_id ? Json(report.prior_id) : Json()},
            {"composed", report.prior_is_composed},
            {"used", holds_prior(report.fit)},
            {"overruled", overruled[std::min<uint32_t>(verdict, LENSPROF_PROFILE_PRIOR_FALLOFF_OVERRULED)]},
            {"reason", prior_reason(report)}};
}

// What was used of the exposures in EXIF.
Json exif_json(const ExifUse &use) {
    Json fields = Json::array();
    if (use.images) fields.push_back("time");
    if (use.images && !use.cancels_iso) fields.push_back("iso");
    if (use.images && !use.cancels_aperture) fields.push_back("aperture");
    return {{"images", use.images}, {"fields", fields}, {"note", use.note.empty() ? Json() : Json(use.note)}};
}

// The results per camera, if there are several.
Json cameras_json(const BuildReport &report) {
    Json list = Json::array();
    for (const CameraReport &camera : report.cameras) {
        const lensprof_fit_camera &found = camera.found;
        const lensprof_fit_result &fit = camera.fit;
        Json json;
        json["label"] = camera.label;
        json["reference"] = camera.is_reference;
        json["images"] = found.images;
        json["attached"] = found.attached;
        json["joined"] = found.joined != 0;
        json["pairs"] = found.images ? Json(fit.pairs) : Json();
        json["shared_pairs"] = found.shared_pairs;
        json["agreeing_share"] = found.shared_pairs ? Json(found.agreeing_share) : Json();
        json["irradiance_difference_ev"] = found.shared_pairs ? Json(found.irradiance_difference_ev) : Json();
        json["log_gamma"] = found.log_gamma;
        json["offset_sigma_ev"] = found.joined ? Json(found.offset_sigma_ev) : Json();
        json["equalizes"] = found.images && fit.equalizes;
        json["response"] = found.images ? response_json(&fit.response, 1) : Json();
        if (found.images) json["response"]["from"] = response_from_name(fit.response_from);
        json["gamma_from"] = found.images ? Json(gamma_name(fit.gamma_from)) : Json();
        json["gamma_sigma"] = found.images ? number_or_null(fit.gamma_sigma) : Json();
        json["heldout_rms"] = found.images ? number_or_null(fit.heldout_rms) : Json();
        list.push_back(json);
    }
    return list;
}

}  // namespace

Json build_json(const BuildReport &report) {
    const auto &fit = report.fit;
    Json json;
    json["schema"] = json_schema;
    json["usable"] = fit.usable != 0;
    json["equalizes"] = fit.equalizes != 0;
    json["model"] = model_name(fit.model);
    add_verdict(report.verdict, json);
    json["reference"] = report.reference;
    json["images"] = images_json(report);
    if (report.has_falloff) json["vignetting"] = vignetting_json(fit.vignetting, fit.vignettings);
    json["settings"] = settings_json(report);
    json["cameras"] = cameras_json(report);
    json["response"] = response_json(&fit.response, 1);
    json["response"]["from"] = response_from_name(fit.response_from);
    json["response"]["irradiance_spread_ev"] = fit.irradiance_spread_ev;
    json["residual"] = {{"before_rms", number_or_null(fit.before_rms)},
                        {"heldout_rms", number_or_null(fit.heldout_rms)},
                        {"heldout_median", number_or_null(fit.heldout_median)},
                        {"noise", fit.noise_levels},
                        {"frame_share", fit.frame_share},
                        {"image_share", fit.image_share},
                        {"inlier_share", fit.inlier_share}};
    if (report.variance.pairs)
        json["colour_variance"] = {{"before", report.variance.before},
                                   {"exposures_only", number_or_null(report.variance.exposures_only)},
                                   {"result", report.variance.result},
                                   {"pairs", report.variance.pairs}};
    if (has_levels(report.levels))
        json["levels"] = {{"black", std::vector<double>(report.levels.black, report.levels.black + 3)},
                          {"white", report.levels.white > 0.0 ? report.levels.white : 1.0}};
    json["gamma_from"] = gamma_name(fit.gamma_from);
    json["gamma"] = gamma_json(report);
    json["coverage"] = {{"radius", std::vector<uint32_t>(fit.radius_ends, fit.radius_ends + LENSPROF_COVERAGE_BINS)},
                        {"grey", std::vector<uint32_t>(fit.grey_ends, fit.grey_ends + LENSPROF_COVERAGE_BINS)}};
    json["pairs"] = fit.pairs;
    json["looks"] = report.sampling_rounds;
    json["links"] = links_json(report.links);
    json["components"] = fit.components;
    json["iterations"] = fit.iterations;
    json["covariance"] = covariance_json(fit.covariance, fit.covariance_size);
    json["left_out"] = left_out_json(report);
    json["seconds"] = {
        {"register", report.register_s}, {"load", report.load_s}, {"sample", report.sample_s}, {"solve", fit.seconds}};
    json["exif_exposures"] = exif_json(report.exif);
    json["equal_exposures"] = fit.equal_exposures != 0;
    json["prior"] = prior_json(report);
    json["lens_prior"] = {{"falloff_distance", fit.falloff_prior_distance},
                          {"center_distance", fit.center_prior_distance},
                          {"error_inflation", fit.error_inflation}};
    json["profile"] = report.profile_id ? Json(report.profile_id) : Json();
    return json;
}

}  // namespace lensprof
