#include "cli/fitting/fit_page.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "cli/fitting/fit_residuals.hpp"
#include "cli/page/page.hpp"
#include "cli/report/curves_json.hpp"
#include "photo/base/format.hpp"
#include "photo/base/paths.hpp"
#include "photo/calibration/preview.hpp"
#include "photo/pictures/thumbnail.hpp"

namespace lensprof {
namespace {

Json falloffs_json(const BuildReport &report) {
    Json curves = Json::array();
    if (!report.has_falloff) return curves;
    if (report.settings.empty()) add_falloff_curves(*profile_of(*report.held), "", curves);
    for (const SettingReport &setting : report.settings)
        if (setting.found.images) add_falloff_curves(*profile_of(*report.held, setting.number), setting.label, curves);
    return curves;
}

Json responses_json(const BuildReport &report) {
    Json curves = Json::array();
    if (report.cameras.empty()) add_response_curves(*profile_of(*report.held), "this fit", curves);
    for (const CameraReport &camera : report.cameras) {
        if (!camera.found.images) continue;
        auto profile = new_profile();
        profile->response[0] = camera.fit.response;
        add_response_curves(*profile, camera.label, curves);
    }
    return curves;
}

Json images_json(const FitPageInput &input) {
    const BuildReport &report = input.report;
    Json json = Json::array();
    for (size_t i = 0; i < report.names.size(); i++) {
        const lensprof_exposure &exposure = report.exposures[i];
        const bool has_quality = i < report.quality.size();
        const lensprof_fit_image_quality quality = has_quality ? report.quality[i] : lensprof_fit_image_quality{};
        const bool is_known =
            i < input.images.size() && input.images[i].known_ev_sigma > 0.0 && quality.known_ev_residual != 0.0;
        json.push_back(
            {{"name", report.names[i]},
             {"ev", number_or_null(exposure.ev)},
             {"ev_sigma", quality.ev_sigma},
             {"known_ev", is_known ? number_or_null(exposure.ev - quality.known_ev_residual) : Json()},
             {"balance", std::vector<double>(exposure.white_balance, exposure.white_balance + 3)},
             {"balance_sigma", std::vector<double>(quality.white_balance_sigma, quality.white_balance_sigma + 3)}});
    }
    return json;
}

Json facts_json(const BuildReport &report) {
    const lensprof_fit_result &fit = report.fit;
    Json facts = Json::array();
    const auto add = [&](const char *name, const std::string &value) { facts.push_back({name, value}); };
    add("pictures used",
        format("%zu of %zu", joined_images(report.exposures), report.names.size() + report.left_out.size()));
    add("pairs", std::to_string(fit.pairs));
    if (report.has_falloff && report.settings.empty())
        add("corner illuminance", corner_text(*profile_of(*report.held)));
    if (fit.before_rms > 0.0)
        add("residual (RMS, grey levels)", format("%.1f before, %.1f after", fit.before_rms, fit.heldout_rms));
    if (report.variance.pairs)
        add("colour variance, levels²",
            format("%.0f before, %.0f by exposures alone, %.0f after", report.variance.before,
                   report.variance.exposures_only, report.variance.result));
    add("gamma from", std::string(gamma_name(fit.gamma_from))
                          + (fit.gamma_sigma > 0.0 ? format(", ± %.0f %%", 100.0 * fit.gamma_sigma) : ""));
    if (report.profile_id) add("stored as profile", std::to_string(report.profile_id));
    return facts;
}

void add_views(const FitPageInput &input, Events &events, Json &page) {
    const Fitted &fitted = input.best;
    std::vector<uint32_t> images = images_with_exposure(fitted);
    const size_t image_count = images.size();
    if (!fitted.corrects()) page["views_note"] = "The result is not usable, so no picture was corrected.";
    if (!fitted.corrects() || images.empty() || !is_regular_file(input.scene.files[images[0]])) return;
    if (image_count > max_views) {
        std::vector<uint32_t> shown_images;
        for (size_t n = 0; n < max_views; n++) shown_images.push_back(images[n * image_count / max_views]);
        images = shown_images;
        page["views_note"] = views_note(max_views, image_count);
    }
    const uint32_t side = view_side(images.size());
    const bool has_mosaic = !input.scene.is_reconstruction && images.size() <= 200;
    auto copies = corrected_copies(input.scene, fitted, images, has_mosaic ? std::max(side, 500u) : side, events);
    Json views = Json::array();
    if (has_mosaic) {
        const Mosaic mosaic = mosaic_of(copies);
        views.push_back(view_json("all pictures, unblended", mosaic.before, mosaic.after));
    }
    for (CorrectedCopy &copy : copies) {
        const uint16_t orientation = copy.image < input.metadata.size() ? input.metadata[copy.image].orientation : 1;
        views.push_back(view_json(input.scene.names[copy.image], upright_copy(copy.before, orientation, side),
                                  upright_copy(copy.after, orientation, side)));
    }
    page["views"] = std::move(views);
}

}  // namespace

Json curves_page(const BuildReport &report, const std::string &path, const std::string &subtitle,
                 const std::string &command) {
    const std::string title = std::filesystem::path(path).filename().string();
    Json page = new_page("fit", title.empty() ? path : title, subtitle, command);
    page["falloffs"] = falloffs_json(report);
    page["falloff_points"] = page["left_out"] = Json::array();
    page["responses"] = responses_json(report);
    page["typical"] = typical_band(report.camera_kind.kind);
    return page;
}

Json fit_page_data(const FitPageInput &input, Events &events) {
    const BuildReport &report = input.report;
    Json page = curves_page(report, input.scene.path, input.subtitle, input.command);
    const std::vector<PairEnds> ends = ends_of_pairs(input.input, input.best, input.scene);
    if (report.has_falloff) page["falloff_points"] = falloff_points(ends, input.best);
    page["images"] = images_json(input);
    page["residuals"] = residual_figures(ends, input.best, input.scene);
    for (const auto &[name, reason] : report.left_out) page["left_out"].push_back({{"name", name}, {"reason", reason}});
    for (size_t i = 0; i < report.names.size(); i++)
        if (std::isnan(report.exposures[i].ev))
            page["left_out"].push_back({{"name", report.names[i]},
                                        {"reason", "no exposure was found: the warnings or its verdict state why"}});
    if (input.shows_pictures) add_views(input, events, page);
    return page;
}

void add_fit_verdict(Json &page, const BuildReport &report, const std::vector<std::string> &warnings) {
    page["verdict"] = page_verdict(report.fit.usable, report.fit.equalizes, report.verdict, warnings);
    page["facts"] = facts_json(report);
}

std::string fit_page(Json page, const BuildReport &report, const std::vector<std::string> &warnings) {
    add_fit_verdict(page, report, warnings);
    page["result"] = build_json(report);
    return page_of(page);
}

}  // namespace lensprof
