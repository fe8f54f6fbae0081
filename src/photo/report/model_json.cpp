// Response, falloff and covariance, the parts that fits and profiles share, as JSON.
#include <cmath>

#include <nlohmann/json.hpp>

#include "photo/report/report.hpp"

namespace lensprof {

Json number_or_null(double value) { return value == LENSPROF_UNKNOWN || !std::isfinite(value) ? Json() : Json(value); }

Json covariance_json(const double *values, uint32_t n) {
    Json rows = Json::array();
    for (uint32_t i = 0; i < n; i++) rows.push_back(std::vector<double>(values + i * n, values + (i + 1) * n));
    return rows;
}

Json samples_json(const lensprof_response *responses, uint32_t count) {
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

Json gain_grid_json(const lensprof_gain_grid &grid) {
    if (!grid.columns) return Json();
    Json channels = Json::array();
    const float *row_values = grid.attenuation;
    for (uint32_t c = 0; c < grid.channels; c++) {
        Json rows = Json::array();
        for (uint32_t row = 0; row < grid.rows; row++, row_values += grid.columns)
            rows.push_back(std::vector<float>(row_values, row_values + grid.columns));
        channels.push_back(rows);
    }
    return {{"columns", grid.columns}, {"rows", grid.rows}, {"attenuation", channels}};
}

const char *gamma_name(uint32_t from) {
    static const char *const names[] = {"auto", "prior", "exif", "known", "none", "profile", "falloff", "cameras"};
    return from <= LENSPROF_GAMMA_CAMERAS ? names[from] : "unknown";
}

const char *camera_kind_name(uint32_t kind) {
    static const char *const names[] = {"any", "film", "digital", "camera", "phone", "linear"};
    return kind <= LENSPROF_CAMERA_LINEAR ? names[kind] : "unknown";
}

}  // namespace lensprof
