#include "cli/report/report.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "cli/program/format.hpp"
#include "cli/program/input_file.hpp"
#include "cli/program/library.hpp"
#include "cli/program/utf8.hpp"
#include "cli/report/falloff.hpp"

namespace lensprof {
Json number_or_null(double value) { return value == LENSPROF_UNKNOWN || !std::isfinite(value) ? Json() : Json(value); }

namespace {

// Distances can be infinite, which JSON cannot represent.
Json distance_json(double distance_m) { return std::isinf(distance_m) ? Json("infinity") : number_or_null(distance_m); }

}  // namespace

Json covariance_json(const double *values, uint32_t n) {
    Json rows = Json::array();
    for (uint32_t i = 0; i < n; i++) rows.push_back(std::vector<double>(values + i * n, values + (i + 1) * n));
    return rows;
}

// Curve samples for plotting, for any kind.
static Json samples_json(const lensprof_response *responses, uint32_t count) {
    Json values = Json::array();
    for (uint32_t c = 0; c < count; c++)
        values.push_back(std::vector<double>(responses[c].table, responses[c].table + LENSPROF_RESPONSE_SAMPLES));
    return values;
}

Json response_json(const lensprof_response *responses, uint32_t count) {
    static const char *const kinds[] = {"linear", "gamma", "emor", "table"};
    Json json;
    json["kind"] = kinds[responses[0].kind];
    if (responses[0].kind == LENSPROF_RESPONSE_EMOR)
        json["emor"] = std::vector<double>(responses[0].emor, responses[0].emor + responses[0].modes);
    if (responses[0].kind == LENSPROF_RESPONSE_GAMMA) json["gamma"] = responses[0].gamma;
    json["values"] = samples_json(responses, count);
    return json;
}

Json vignetting_json(const lensprof_vignetting *vignettings, uint32_t count) {
    Json json, k = Json::array();
    for (uint32_t c = 0; c < count; c++) k.push_back(std::vector<double>(vignettings[c].k, vignettings[c].k + 3));
    json["k"] = k;
    json["center"] = {vignettings[0].center[0], vignettings[0].center[1]};
    return json;
}

namespace {

void print_gain_grid(const lensprof_gain_grid &grid, std::ostream &out) {
    if (!grid.columns) return;
    const float *end = grid.attenuation + grid.channels * grid.rows * grid.columns;
    const auto range = std::minmax_element(grid.attenuation, end);
    out << format("gain grid %u x %u nodes, %s; multiplies the falloff by %.3f to %.3f\n", grid.columns, grid.rows,
                  grid.channels == 3 ? "one grid per channel" : "all channels", double(*range.first),
                  double(*range.second));
}

double corner(const lensprof_vignetting &v) { return lensprof_vignetting_eval(&v, 1.0, nullptr); }

// 100 M at r, " +- " and its standard error if known; an error is never printed as 0.0.
std::string light_at(const lensprof_profile &profile, uint32_t curve, double r, bool &is_known) {
    double sigma;
    const double m = lensprof_profile_radial_falloff(&profile, curve, r, &sigma), percent = 100.0 * sigma;
    is_known = sigma > 0.0;
    return format("%.1f", 100.0 * m) + (is_known ? format(percent < 0.05 ? " +- %.1g" : " +- %.1f", percent) : "");
}

}  // namespace

void print_vignettings(const lensprof_profile &profile, std::ostream &out) {
    static const char *const channels[3] = {" of red", " of green", " of blue"};
    for (uint32_t c = 0; c < profile.vignettings; c++) {
        const lensprof_vignetting &v = profile.vignetting[c];
        const char *channel = profile.vignettings == 3 ? channels[c] : "";
        if (!has_falloff(v)) {
            out << "falloff" << channel << "   none: not measured, or fixed at zero\n";
            continue;
        }
        out << "falloff" << channel
            << format("   k1 %+.4f  k2 %+.4f  k3 %+.4f   centre %+.4f %+.4f half diagonals\n", v.k[0], v.k[1], v.k[2],
                      v.center[0], v.center[1]);
        bool is_known;
        const std::string middle = light_at(profile, c, 0.5, is_known), end = light_at(profile, c, 1.0, is_known);
        out << format("          light at r = 0.5: %s %%, in the corner: %s %% (%.2f stops)%s\n", middle.c_str(),
                      end.c_str(), -std::log2(corner(v)), is_known ? "" : ", error unknown");
    }
}

void print_response(const lensprof_response &r, std::ostream &out) {
    static const char *const kinds[] = {"linear", "gamma", "EMoR", "table"};
    std::string kind = kinds[r.kind];
    if (r.kind == LENSPROF_RESPONSE_EMOR) kind += format(", %u modes", r.modes);
    if (r.kind == LENSPROF_RESPONSE_GAMMA) kind += format(" %.3g", r.gamma);
    out << "response  " << kind << ";  grey value (of 255) at irradiance";
    for (double x : {0.01, 0.05, 0.2, 0.5})
        out << format("  %g: %.1f", x, 255.0 * lensprof_response_eval(&r, x, nullptr));
    out << "\n";
}

const char *gamma_name(uint32_t from) {
    static const char *const names[] = {"auto", "prior", "exif", "known", "none", "profile", "falloff", "cameras"};
    return from <= LENSPROF_GAMMA_CAMERAS ? names[from] : "unknown";
}

const char *camera_kind_name(uint32_t kind) {
    static const char *const names[] = {"any", "film", "digital", "camera", "phone", "linear"};
    return kind <= LENSPROF_CAMERA_LINEAR ? names[kind] : "unknown";
}

bool holds_prior(const lensprof_fit_result &fit) {
    return fit.profile_prior != LENSPROF_PROFILE_PRIOR_NONE && fit.profile_prior != LENSPROF_PROFILE_PRIOR_OVERRULED;
}

const char *processing_name(uint32_t processing) {
    static const char *const names[] = {"raw", "jpeg", "corrected"};
    return processing <= LENSPROF_PROCESSING_CORRECTED ? names[processing] : "unknown";
}

namespace {

std::string hex_of(const std::string &text) {
    std::string hex;
    for (const char c : text) hex += format("%02x", static_cast<unsigned char>(c));
    return hex;
}

// The bytes of a text that is not UTF-8, or of a list with such texts; null if not needed.
Json bytes_of(const Json &value) {
    if (value.is_string()) return is_utf8(value.get<std::string>()) ? Json() : Json(hex_of(value.get<std::string>()));
    if (!value.is_array()) return Json();
    Json list = Json::array();
    bool any = false;
    for (const Json &item : value) {
        list.push_back(item.is_string() ? bytes_of(item) : Json());
        any = any || !list.back().is_null();
    }
    return any ? list : Json();
}

// Adds to every member with text that is not UTF-8 one with its bytes.
void keep_bytes(Json &json) {
    if (json.is_object()) {
        Json kept = Json::object();
        for (const auto &member : json.items()) {
            kept[member.key()] = member.value();
            const Json bytes = bytes_of(member.value());
            if (!bytes.is_null()) kept[member.key() + "_bytes"] = bytes;
        }
        json = std::move(kept);
    }
    for (Json &item : json)
        if (item.is_structured()) keep_bytes(item);
}

bool has_only_utf8(const Json &json) {
    if (json.is_string()) return is_utf8(json.get_ref<const std::string &>());
    return !json.is_structured() || std::all_of(json.begin(), json.end(), has_only_utf8);
}

}  // namespace

void print_json(const Json &json, std::ostream &out) {
    if (!has_only_utf8(json)) {
        Json kept = json;
        keep_bytes(kept);
        out << kept.dump(-1, ' ', false, Json::error_handler_t::replace) << "\n";
        return;
    }
    out << json.dump() << "\n";
}

namespace {

Json numbers(const double *values, size_t count) { return std::vector<double>(values, values + count); }

// Whether the fit left out an image, which then has no exposure.
bool is_left_out(const BuildReport &report, size_t image) {
    return report.fit.left_out && image < report.quality.size() && !report.quality[image].joined;
}

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

const char *response_from_name(uint32_t from) {
    static const char *const names[] = {"pictures", "options", "kind", "profile"};
    return from <= LENSPROF_FIT_RESPONSE_PROFILE ? names[from] : "unknown";
}

const char *kind_from_name(KindFrom from) {
    static const char *const names[] = {"none", "option", "pictures", "reconstruction"};
    return names[static_cast<int>(from)];
}

const char *describe_kind_from(KindFrom from) {
    return from == KindFrom::option     ? "as requested"
           : from == KindFrom::pictures ? "according to the pictures"
           : from == KindFrom::none     ? "because no picture states the camera; use --camera-kind to change it"
                                        : "typical of reconstructions; use --camera-kind to change it";
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
        const lensprof_fit_setting &found = setting.found;
        const lensprof_fit_result fit = found.images ? result_of(report, setting) : report.fit;
        Json json;
        json["label"] = setting.label;
        if (!report.cameras.empty()) json["camera"] = setting.camera;
        json["key"] = key_json(setting.key);
        json["reference"] = setting.is_reference;
        json["images"] = found.images;
        json["pairs"] = found.pairs;
        json["usable"] = found.images && found.usable;
        add_verdict(setting.verdict, json);
        json["vignetting"] = found.images ? vignetting_json(found.vignetting, fit.vignettings) : Json();
        json["coverage"] = std::vector<uint32_t>(found.radius_ends, found.radius_ends + LENSPROF_COVERAGE_BINS);
        json["covariance"] = found.images ? covariance_json(found.covariance, fit.covariance_size) : Json();
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

// The stored profile used as the prior; null if none was requested.
Json prior_json(const BuildReport &report) {
    static const Json overruled[] = {Json::array(), Json::array(), {"response", "falloff"}, {"response"}, {"falloff"}};
    const uint32_t verdict = report.fit.profile_prior;
    if (!report.prior_id && report.no_prior.empty()) return Json();
    return {{"profile", report.prior_id ? Json(report.prior_id) : Json()},
            {"composed", report.prior_is_composed},
            {"used", holds_prior(report.fit)},
            {"overruled", overruled[std::min<uint32_t>(verdict, LENSPROF_PROFILE_PRIOR_FALLOFF_OVERRULED)]},
            {"reason", verdict >= LENSPROF_PROFILE_PRIOR_OVERRULED ? report.verdict.text : report.no_prior}};
}

}  // namespace

// The results per camera, if there are several.
static Json cameras_json(const BuildReport &report) {
    Json list = Json::array();
    for (const CameraReport &camera : report.cameras) {
        const lensprof_fit_camera &found = camera.found;
        Json json;
        json["label"] = camera.label;
        json["reference"] = camera.is_reference;
        json["images"] = found.images;
        json["attached"] = found.attached;
        json["joined"] = found.joined != 0;
        json["pairs"] = found.images ? Json(found.pairs) : Json();
        json["shared_pairs"] = found.shared_pairs;
        json["agreeing_share"] = found.shared_pairs ? Json(found.agreeing_share) : Json();
        json["light_difference_ev"] = found.shared_pairs ? Json(found.light_difference_ev) : Json();
        json["log_gamma"] = found.log_gamma;
        json["offset_sigma_ev"] = found.joined ? Json(found.offset_sigma_ev) : Json();
        json["evens"] = found.images && found.evens;
        json["response"] = found.images ? response_json(&found.response, 1) : Json();
        if (found.images) json["response"]["from"] = response_from_name(found.response_from);
        json["gamma_from"] = found.images ? Json(gamma_name(found.gamma_from)) : Json();
        json["gamma_sigma"] = found.images ? number_or_null(found.gamma_sigma) : Json();
        json["heldout_rms"] = found.images ? number_or_null(found.heldout_rms) : Json();
        list.push_back(json);
    }
    return list;
}

lensprof_fit_result result_of(const BuildReport &report, const SettingReport &setting) {
    lensprof_fit_result own = report.fit;
    lensprof_error error{};
    if (!report.cameras.empty() && report.cameras[setting.camera].found.images)
        check(lensprof_fit_result_take_camera(&own, &report.cameras[setting.camera].found, &error), "fit", &error);
    check(lensprof_fit_result_take_setting(&own, &setting.found, &error), "fit", &error);
    return own;
}

Json build_json(const BuildReport &report) {
    const auto &fit = report.fit;
    Json json;
    json["schema"] = 1;
    json["usable"] = fit.usable != 0;
    json["evens"] = fit.evens != 0;
    add_verdict(report.verdict, json);
    json["reference"] = report.reference;
    json["images"] = images_json(report);
    if (report.has_falloff) json["vignetting"] = vignetting_json(fit.vignetting, fit.vignettings);
    json["settings"] = settings_json(report);
    json["cameras"] = cameras_json(report);
    json["response"] = response_json(&fit.response, 1);
    json["response"]["from"] = response_from_name(fit.response_from);
    json["response"]["light_spread_ev"] = fit.light_spread_ev;
    json["residual"] = {{"before_rms", number_or_null(fit.before_rms)},
                        {"heldout_rms", number_or_null(fit.heldout_rms)},
                        {"heldout_median", number_or_null(fit.heldout_median)},
                        {"noise", fit.noise_levels},
                        {"frame_share", fit.frame_share},
                        {"image_share", fit.image_share},
                        {"inlier_share", fit.inlier_share}};
    if (report.variance.pairs)
        json["colour_variance"] = {{"before", report.variance.before},
                                   {"exposures_only", report.variance.exposures_only},
                                   {"result", report.variance.result},
                                   {"pairs", report.variance.pairs}};
    json["gamma_from"] = gamma_name(fit.gamma_from);
    json["gamma"] = gamma_json(report);
    json["coverage"] = {{"radius", std::vector<uint32_t>(fit.radius_ends, fit.radius_ends + LENSPROF_COVERAGE_BINS)},
                        {"grey", std::vector<uint32_t>(fit.grey_ends, fit.grey_ends + LENSPROF_COVERAGE_BINS)}};
    json["pairs"] = fit.pairs;
    json["looks"] = report.looks;
    json["links"] = links_json(report.links);
    json["components"] = fit.components;
    json["iterations"] = fit.iterations;
    json["covariance"] = covariance_json(fit.covariance, fit.covariance_size);
    json["left_out"] = left_out_json(report);
    json["seconds"] = {
        {"register", report.register_s}, {"load", report.load_s}, {"sample", report.sample_s}, {"solve", fit.seconds}};
    json["prior"] = prior_json(report);
    json["profile"] = report.profile_id ? Json(report.profile_id) : Json();
    return json;
}

namespace {

void print_exposures(const BuildReport &report, std::ostream &out) {
    size_t width = 5;
    for (const auto &name : report.names) width = std::max(width, name.size());
    out << format("%-*s  %8s  %6s  %7s  %7s\n", static_cast<int>(width), "image", "EV", "+-", "red", "blue");
    for (size_t i = 0; i < report.names.size(); i++) {
        const auto &e = report.exposures[i];
        double sigma = i < report.quality.size() ? report.quality[i].ev_sigma : 0.0;
        std::string error = sigma > 0.0 ? format("%.3f", sigma) : std::string("-");
        if (std::isnan(e.ev)) {
            out << format("%-*s  %8s\n", static_cast<int>(width), report.names[i].c_str(),
                          is_left_out(report, i) ? "left out" : "unknown");
            continue;
        }
        out << format("%-*s  %+8.3f  %6s  %7.4f  %7.4f%s\n", static_cast<int>(width), report.names[i].c_str(), e.ev,
                      error.c_str(), e.white_balance[0], e.white_balance[2],
                      i == report.reference ? "  reference" : "");
    }
}

void print_gamma(const BuildReport &report, std::ostream &out) {
    const auto &fit = report.fit;
    if (fit.gamma_from == LENSPROF_GAMMA_KNOWN) {
        out << "gamma     known from the fixed parameters";
        if (report.camera_kind.kind == LENSPROF_CAMERA_LINEAR && fit.response.kind == LENSPROF_RESPONSE_LINEAR)
            out << ": a linear response, " << describe_kind_from(report.camera_kind.from);
        out << "\n";
        return;
    }
    const bool is_given = report.exposures_given && fit.gamma_from == LENSPROF_GAMMA_EXPOSURES;
    out << "gamma     from " << (is_given ? "the given exposures" : gamma_name(fit.gamma_from));
    if (fit.gamma_from == LENSPROF_GAMMA_PRIOR)
        out << " (of the kind " << camera_kind_name(report.camera_kind.kind) << ", "
            << describe_kind_from(report.camera_kind.from) << ")";
    if (fit.gamma_sigma > 0.0) out << format(", +- %.0f %%", 100.0 * fit.gamma_sigma);
    if (fit.gamma_from == LENSPROF_GAMMA_NONE) out << " (no prior; the +- here exclude its error)";
    out << ": the common exponent of " << (report.has_falloff ? "exposure, falloff" : "exposure")
        << " and response, which pictures alone do not determine (docs/model.md)\n";
}

void print_prior(const BuildReport &report, std::ostream &out) {
    if (!report.no_prior.empty()) out << "prior     of all cameras: " << report.no_prior << "\n";
    if (!report.prior_id) return;
    const uint32_t verdict = report.fit.profile_prior;
    out << "prior     " << (report.prior_is_composed ? "composed of profile " : "profile ") << report.prior_id
        << (report.prior_is_composed ? " and others of the lens and the camera" : "")
        << (verdict == LENSPROF_PROFILE_PRIOR_USED ? ", used by the result\n"
            : verdict == LENSPROF_PROFILE_PRIOR_RESPONSE_OVERRULED
                ? ", whose falloff is used; its response is overruled by the pictures\n"
            : verdict == LENSPROF_PROFILE_PRIOR_FALLOFF_OVERRULED
                ? ", whose response is used; its falloff is overruled by the pictures\n"
                : ", overruled by the pictures\n");
}

// "links     12 verified, 2 not (too little texture to check the alignment), 1 contradicted".
std::string links_row(const std::vector<lensprof_link> &links) {
    size_t count[LENSPROF_LINK_CONTRADICTED + 1] = {};
    for (const lensprof_link &link : links) count[std::min<uint32_t>(link.state, LENSPROF_LINK_CONTRADICTED)]++;
    std::string row = format("links     %zu verified", count[LENSPROF_LINK_VERIFIED]);
    if (count[LENSPROF_LINK_UNVERIFIED])
        row += format(", %zu not (too little texture to check the alignment)", count[LENSPROF_LINK_UNVERIFIED]);
    if (count[LENSPROF_LINK_CONTRADICTED]) row += format(", %zu contradicted", count[LENSPROF_LINK_CONTRADICTED]);
    return row + "\n";
}

// For one lens setting, or for each.
void print_falloffs(const BuildReport &report, std::ostream &out) {
    if (report.settings.empty()) print_vignettings(*profile_of(report.fit), out);
    for (const SettingReport &setting : report.settings) {
        if (!setting.found.images) continue;
        out << "setting   " << setting.label << format(", %s", counted(setting.found.images, "picture").c_str())
            << (setting.found.usable ? "" : "; not stored as a profile") << "\n";
        print_vignettings(*profile_of(result_of(report, setting)), out);
    }
}

// For one camera, or for each, with its connection to that of the reference.
void print_responses(const BuildReport &report, std::ostream &out) {
    if (report.cameras.empty()) {
        if (report.fit.response_from == LENSPROF_FIT_RESPONSE_KIND)
            out << "response  typical of the kind of camera: the pictures do not determine it\n";
        print_response(report.fit.response, out);
    }
    for (const CameraReport &camera : report.cameras) {
        const lensprof_fit_camera &found = camera.found;
        out << "camera    " << camera.label;
        if (found.images) out << format(", %s", counted(found.images, "picture").c_str());
        if (!found.joined)
            out << (found.images ? "; not connected to the reference" : ": left out");
        else if (camera.is_reference)
            out << ", with the reference";
        else
            out << format("; the light of %u shared pairs differs by %.3f EV (median)", found.shared_pairs,
                          found.light_difference_ev);
        if (found.images && !camera.is_reference && found.heldout_rms != LENSPROF_UNKNOWN)
            out << format("; residual %.2f levels (RMS, held out)", found.heldout_rms);
        out << "\n";
        if (!found.images) continue;
        if (found.response_from == LENSPROF_FIT_RESPONSE_KIND)
            out << "response  typical of the kind of camera: its pictures do not determine it\n";
        print_response(found.response, out);
    }
}

}  // namespace

void print_build(const BuildReport &report, std::ostream &out) {
    const auto &fit = report.fit;
    print_exposures(report, out);
    if (report.has_falloff) print_falloffs(report, out);
    print_responses(report, out);
    print_gamma(report, out);
    print_prior(report, out);
    std::string heldout = "not measured: too few pairs";
    if (fit.heldout_rms != LENSPROF_UNKNOWN)
        heldout = format("%.2f (RMS; median %.2f) on pairs left out of the fit", fit.heldout_rms, fit.heldout_median);
    out << format("residual  before %.2f, after %s, levels of 255; %.1f %% inliers of %u pairs\n", fit.before_rms,
                  heldout.c_str(), 100.0 * fit.inlier_share, fit.pairs);
    if (report.variance.pairs)
        out << format(
            "colours   variance of a point's colour over its views %.1f before, %.1f with exposures alone, %.1f with "
            "this result, levels squared\n",
            report.variance.before, report.variance.exposures_only, report.variance.result);
    if (!report.links.empty()) out << links_row(report.links);
    if (report.register_s > 0.0) out << format("time      find overlaps %.2f s\n", report.register_s);
    out << format("time      load %.2f s, sample %.2f s, solve %.2f s\n", report.load_s, report.sample_s, fit.seconds);
    if (!fit.usable && fit.evens && report.has_falloff)
        out << "CORRECTS these pictures; not stored as a profile: " << report.verdict.text << "\n";
    else if (!fit.usable)
        out << "NOT USABLE: " << report.verdict.text << "\n";
    else if (!report.verdict.text.empty())
        out << "warning   " << report.verdict.text << "\n";
}

Json key_json(const lensprof_profile_key &key) {
    return {{"camera_maker", key.camera_maker},
            {"camera_model", key.camera_model},
            {"lens", key.lens},
            {"unit", key.unit},
            {"crop_factor", number_or_null(key.crop_factor)},
            {"focal_mm", number_or_null(key.focal_mm)},
            {"aperture", number_or_null(key.aperture)},
            {"distance_m", distance_json(key.distance_m)},
            {"color_temperature_k", number_or_null(key.color_temperature_k)},
            {"processing", processing_name(key.processing)},
            {"style", key.style}};
}

Json provenance_json(const lensprof_provenance &p) {
    return {{"method", p.method},
            {"software", p.software},
            {"source", p.source},
            {"created_unix_s", p.created_unix_s},
            {"images", p.images},
            {"pairs", p.pairs},
            {"heldout_rms", number_or_null(p.heldout_rms)},
            {"inlier_share", number_or_null(p.inlier_share)},
            {"doubt", p.doubt},
            {"prior_id", p.prior_id ? Json(p.prior_id) : Json()},
            {"forced", p.forced != 0},
            {"gamma_sigma", p.gamma_sigma > 0.0 ? Json(p.gamma_sigma) : Json()}};
}

Json profile_json(int64_t id, const lensprof_profile &profile) {
    const lensprof_profile *const pointer = &profile;
    const auto write = [&](void *text, size_t capacity, size_t *count, lensprof_error *error) {
        return lensprof_json_write(&pointer, 1, text, capacity, count, error);
    };
    Json json = Json::parse(written("profile as JSON", write));
    json["response"]["values"] = samples_json(profile.response, profile.responses);
    if (id) json["id"] = id;
    return json;
}

std::string camera_name(const std::string &maker, const std::string &model) {
    if (maker.empty() || model.empty()) return maker + model;
    const std::string word = maker.substr(0, maker.find(' '));
    const auto is_same = [](char a, char b) {
        const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
        return lower(a) == lower(b);
    };
    const bool names_maker = model.size() >= word.size() && std::equal(word.begin(), word.end(), model.begin(), is_same)
                             && (model.size() == word.size() || model[word.size()] == ' ');
    return names_maker ? model : maker + " " + model;
}

KeyParts key_parts(const lensprof_profile_key &key) {
    KeyParts parts;
    parts[0] = camera_name(key.camera_maker, key.camera_model);
    parts[1] = key.lens;
    if (key.focal_mm != LENSPROF_UNKNOWN) parts[2] = format("%g mm", key.focal_mm);
    if (key.aperture != LENSPROF_UNKNOWN) parts[3] = format("f/%g", key.aperture);
    if (std::isinf(key.distance_m))
        parts[4] = "focus at infinity";
    else if (key.distance_m != LENSPROF_UNKNOWN)
        parts[4] = format("focus at %g m", key.distance_m);
    parts[5] = processing_name(key.processing);
    return parts;
}

std::string spell_part(const KeyParts &parts, size_t part) {
    static const char *const names[] = {"camera", "lens", "focal length", "aperture", "focus", "processing"};
    return parts[part].empty() ? std::string(names[part]) + " unknown" : parts[part];
}

std::string describe_key(const lensprof_profile_key &key) {
    const KeyParts parts = key_parts(key);
    std::string text = spell_part(parts, 0);
    for (size_t part = 1; part < parts.size(); part++) text += ", " + spell_part(parts, part);
    return text;
}

void print_profile(int64_t id, const lensprof_profile &profile, std::ostream &out) {
    const auto &p = profile.provenance;
    out << "profile   " << (id ? std::to_string(id) + ": " : std::string()) << describe_key(profile.key) << "\n";
    if (*profile.key.unit) out << "unit      " << profile.key.unit << " only\n";
    if (profile.key.color_temperature_k != LENSPROF_UNKNOWN)
        out << format("light     %g K\n", profile.key.color_temperature_k);
    if (*profile.key.style) out << "style     " << profile.key.style << "\n";
    print_vignettings(profile, out);
    print_gain_grid(profile.grid, out);
    for (uint32_t c = 0; c < profile.responses; c++) print_response(profile.response[c], out);
    out << "source    " << (*p.method ? p.method : "unknown method");
    if (p.prior_id) out << ", with profile " << p.prior_id << " as its prior";
    if (p.forced) out << ", stored with --force though not usable";
    out << ", " << p.images << " images, " << p.pairs << " pairs";
    if (p.heldout_rms != LENSPROF_UNKNOWN) out << format(", residual %.2f levels", p.heldout_rms);
    out << (*p.source ? std::string(", ") + p.source : std::string()) << "\n";
    if (*p.doubt) out << "doubt     " << p.doubt << "\n";
}

TrueValues read_truth(const std::string &path, size_t images) {
    TrueValues truth;
    try {
        Json json = Json::parse(read_text(path, largest_text));
        for (const Json &image : json.at("images")) truth.ev.push_back(image.at("ev").get<double>());
        const Json &curves = json.at("vignetting").at("k"), &center = json.at("vignetting").at("center");
        for (size_t n = 0; n < 3; n++) truth.vignetting.k[n] = curves.at(curves.size() / 2).at(n).get<double>();
        for (size_t d = 0; d < 2; d++) truth.vignetting.center[d] = center.at(d).get<double>();
    } catch (const Json::exception &) {
        throw Failure(ExitCode::unreadable, path + ": is not the truth.json of `lensprof simulate`");
    }
    if (truth.ev.size() != images)
        throw Failure(ExitCode::unreadable,
                      path
                          + format(": is for %zu images, not for %zu; give the truth.json of this project",
                                   truth.ev.size(), images));
    return truth;
}

const lensprof_vignetting &green_falloff(const lensprof_fit_result &fit) {
    return fit.vignetting[fit.vignettings == 3 ? 1 : 0];
}

void print_comparison(const BuildReport &report, const TrueValues &truth, std::ostream &out) {
    std::vector<double> true_ev, ev;
    std::vector<size_t> images;  // with an exposure
    for (size_t i = 0; i < report.exposures.size(); i++) {
        if (std::isnan(report.exposures[i].ev)) continue;
        images.push_back(i);
        true_ev.push_back(truth.ev[i] - truth.ev[report.reference]);
        ev.push_back(report.exposures[i].ev);
    }
    const size_t n = images.size();
    double mean = 0, true_mean = 0, cross = 0, square = 0;
    for (size_t i = 0; i < n; i++)
        mean += ev[i] / static_cast<double>(n), true_mean += true_ev[i] / static_cast<double>(n);
    for (size_t i = 0; i < n; i++) {
        cross += (ev[i] - mean) * (true_ev[i] - true_mean);
        square += (true_ev[i] - true_mean) * (true_ev[i] - true_mean);
    }
    double gamma = square > 1e-6 && cross > 0 ? cross / square : 1.0;
    double ev_error = 0, ev_aligned = 0, m_error = 0, m_aligned = 0;
    out << "\n"
           "recovered next to true (aligned: without the exponent "
        << format("%.3f", gamma)
        << ", which pictures "
           "alone do not "
           "determine)\n";
    out << "image      EV  recovered     true  aligned\n";
    for (size_t i = 0; i < n; i++) {
        ev_error = std::max(ev_error, std::abs(ev[i] - true_ev[i]));
        ev_aligned = std::max(ev_aligned, std::abs((ev[i] - mean) / gamma - (true_ev[i] - true_mean)));
        out << format("%5zu          %+8.3f %+8.3f %+8.3f\n", images[i], ev[i], true_ev[i], ev[i] / gamma);
    }
    out << "radius falloff  recovered     true  aligned\n";
    for (int k = 0; k <= 4; k++) {
        double r2 = k * k / 16.0, m = lensprof_vignetting_eval(&green_falloff(report.fit), r2, nullptr);
        double t = lensprof_vignetting_eval(&truth.vignetting, r2, nullptr), a = std::pow(m, 1.0 / gamma);
        m_error = std::max(m_error, std::abs(m - t));
        m_aligned = std::max(m_aligned, std::abs(a - t));
        out << format("%6.2f         %8.4f %8.4f %8.4f\n", k / 4.0, m, t, a);
    }
    out << format("centre         %+.4f %+.4f, true %+.4f %+.4f half diagonals\n", report.fit.vignetting[0].center[0],
                  report.fit.vignetting[0].center[1], truth.vignetting.center[0], truth.vignetting.center[1]);
    out << format("largest error  exposure %.4f EV (aligned %.4f), falloff %.4f (aligned %.4f)\n", ev_error, ev_aligned,
                  m_error, m_aligned);
}

}  // namespace lensprof
