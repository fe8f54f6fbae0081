// Profiles to JSON.
#include <algorithm>
#include <cmath>

#include "formats/each_format.h"

#include "core/levels.h"
#include "core/profile.h"
#include "formats/json.hpp"

namespace lensprof {
namespace {

void write_key(JsonWriter &json, const lensprof_profile_key &key) {
    json.name("key");
    json.open('{');
    write_text(json, "camera_maker", key.camera_maker);
    write_text(json, "camera_model", key.camera_model);
    write_text(json, "lens", key.lens);
    write_text(json, "unit", key.unit);
    write_known(json, "crop_factor", key.crop_factor);
    write_known(json, "focal_mm", key.focal_mm);
    write_known(json, "aperture", key.aperture);
    if (std::isinf(key.distance_m))
        write_text(json, "distance_m", "infinity");
    else
        write_known(json, "distance_m", key.distance_m);
    write_known(json, "color_temperature_k", key.color_temperature_k);
    write_text(json, "processing", kJsonProcessings[key.processing]);
    write_text(json, "style", key.style);
    json.close('}');
}

void write_grid(JsonWriter &json, const lensprof_gain_grid &grid) {
    json.name("gain_grid");
    if (!grid.columns) return json.word("null");
    json.open('{');
    json.name("columns");
    json.integer(grid.columns);
    json.name("rows");
    json.integer(grid.rows);
    json.name("attenuation");
    json.open('[');
    const float *node = grid.attenuation;
    for (uint32_t c = 0; c < grid.channels; c++) {
        json.open('[');
        for (uint32_t j = 0; j < grid.rows; j++) {
            json.open('[');
            for (uint32_t i = 0; i < grid.columns; i++) json.number(double(*node++));
            json.close(']');
        }
        json.close(']');
    }
    json.close(']');
    json.close('}');
}

// Only if there are any.
void write_levels(JsonWriter &json, const lensprof_profile &profile) {
    const lensprof_levels levels = lp_profile_levels(&profile);
    if (!lp_has_levels(&levels)) return;
    json.name("levels");
    json.open('{');
    json.name("black");
    json.numbers(levels.black, 3);
    json.name("white");
    json.number(lp_white_level(&levels));
    json.close('}');
}

void write_circle(JsonWriter &json, const lensprof_profile &profile) {
    const lensprof_image_circle circle = lp_profile_circle(&profile);
    if (circle.radius == 0.0) return;
    json.name("image_circle");
    json.open('{');
    json.name("center");
    json.numbers(circle.center, 2);
    json.name("radius");
    json.number(circle.radius);
    json.close('}');
}

// Samples of all curves, or, where they are implied, of none, which makes a profile 0.7 instead of 20 kB.
void write_samples(JsonWriter &json, const lensprof_profile &profile) {
    if (std::all_of(profile.response, profile.response + profile.responses, is_implied)) return;
    json.name("values");
    json.open('[');
    for (uint32_t c = 0; c < profile.responses; c++) json.numbers(profile.response[c].table, LENSPROF_RESPONSE_SAMPLES);
    json.close(']');
}

void write_response(JsonWriter &json, const lensprof_profile &profile) {
    json.name("response");
    json.open('{');
    write_kind(json, profile.response[0]);
    write_samples(json, profile);
    if (profile.responses > 1) {
        json.name("curves");
        json.open('[');
        for (uint32_t c = 0; c < profile.responses; c++) {
            json.open('{');
            write_kind(json, profile.response[c]);
            json.close('}');
        }
        json.close(']');
    }
    json.close('}');
}

void write_covariance(JsonWriter &json, const lensprof_profile &profile) {
    const uint32_t n = profile.covariance_size;
    json.name("covariance");
    json.open('[');
    for (uint32_t i = 0; i < n; i++) json.numbers(profile.covariance + i * n, n);
    json.close(']');
}

void write_provenance(JsonWriter &json, const lensprof_provenance &provenance) {
    json.name("provenance");
    json.open('{');
    write_text(json, "method", provenance.method);
    write_text(json, "software", provenance.software);
    write_text(json, "source", provenance.source);
    json.name("created_unix_s");
    json.integer(provenance.created_unix_s);
    json.name("images");
    json.integer(provenance.images);
    json.name("pairs");
    json.integer(provenance.pairs);
    write_known(json, "heldout_rms", provenance.heldout_rms);
    write_known(json, "inlier_share", provenance.inlier_share);
    write_text(json, "doubt", provenance.doubt);
    json.name("prior_id");
    if (provenance.prior_id)
        json.integer(provenance.prior_id);
    else
        json.word("null");
    json.name("forced");
    json.word(provenance.forced ? "true" : "false");
    write_known(json, "gamma_sigma", provenance.gamma_sigma > 0.0 ? provenance.gamma_sigma : LENSPROF_UNKNOWN);
    json.close('}');
}

void write_schema(JsonWriter &json) {
    json.name("schema");
    json.integer(kJsonSchema);
}

std::string profiles_text(const lensprof_profile *const *profiles, uint32_t count) {
    JsonWriter json;
    if (count != 1) {
        json.open('{');
        write_schema(json);
        json.name("profiles");
        json.open('[');
    }
    for (uint32_t i = 0; i < count; i++) {
        const lensprof_status status = profiles[i] ? lensprof_profile_validate(profiles[i]) : LENSPROF_ERROR_ARGUMENT;
        if (status != LENSPROF_OK)
            throw failure_at(
                LENSPROF_ITEM_PROFILE, i,
                std::string("is invalid (") + lensprof_status_name(status) + "); see lensprof_profile_validate",
                status);
        if (count != 1) json.line();
        write_profile(json, *profiles[i]);
    }
    if (count != 1) {
        json.close(']');
        json.close('}');
    }
    return json.all();
}

}  // namespace

void write_text(JsonWriter &json, const char *name, const char *value) {
    json.name(name);
    json.text(value);
}

void write_known(JsonWriter &json, const char *name, double value) {
    json.name(name);
    json.known(value);
}

void write_kind(JsonWriter &json, const lensprof_response &response) {
    write_text(json, "kind", kJsonResponseKinds[response.kind]);
    if (response.kind == LENSPROF_RESPONSE_EMOR) {
        json.name("emor");
        json.numbers(response.emor, response.modes);
    }
    if (response.kind == LENSPROF_RESPONSE_GAMMA) {
        json.name("gamma");
        json.number(response.gamma);
    }
}

bool is_implied(const lensprof_response &given) {
    lensprof_response made;
    lensprof_status status = LENSPROF_OK;
    switch (given.kind) {
    case LENSPROF_RESPONSE_LINEAR: lensprof_response_set_linear(&made); break;
    case LENSPROF_RESPONSE_GAMMA: status = lensprof_response_set_gamma(&made, given.gamma); break;
    case LENSPROF_RESPONSE_EMOR: status = lensprof_response_set_emor(&made, given.emor, given.modes); break;
    default: return false;
    }
    return status == LENSPROF_OK && std::equal(given.table, given.table + LENSPROF_RESPONSE_SAMPLES, made.table);
}

void write_vignetting(JsonWriter &json, const lensprof_vignetting *vignetting, uint32_t count) {
    json.name("vignetting");
    json.open('{');
    json.name("k");
    json.open('[');
    for (uint32_t c = 0; c < count; c++) json.numbers(vignetting[c].k, 3);
    json.close(']');
    json.name("center");
    json.numbers(vignetting[0].center, 2);
    json.close('}');
}

void write_profile(JsonWriter &json, const lensprof_profile &profile) {
    json.open('{');
    write_schema(json);
    json.name("id");
    json.word("null");
    write_key(json, profile.key);
    write_vignetting(json, profile.vignetting, profile.vignettings);
    write_grid(json, profile.grid);
    write_levels(json, profile);
    write_circle(json, profile);
    write_response(json, profile);
    write_covariance(json, profile);
    write_provenance(json, profile.provenance);
    json.close('}');
}

}  // namespace lensprof

using namespace lensprof;

lensprof_status lp_json_write(const lensprof_profile *const *profiles, uint32_t profile_count, void *data,
                              size_t capacity, size_t *count, lensprof_error *error) {
    if ((!profiles && profile_count) || (!data && capacity)) {
        set_error(error, "lensprof_export: profiles or data is NULL; pass a buffer");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return write_at_boundary(data, capacity, count, error, [&] { return profiles_text(profiles, profile_count); });
}
