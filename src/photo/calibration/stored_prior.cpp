#include "photo/calibration/stored_prior.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "photo/base/databases.hpp"
#include "photo/base/paths.hpp"
#include "photo/pictures/picture.hpp"

namespace lensprof {
namespace {

// Whether two sources may have pictures in common: `build FOLDER` stores the folder, and `calibrate FOLDER` a picture
// of each panorama.
bool may_share(const std::string &a, const std::string &b) {
    const auto is_in = [](const std::string &picture, const std::string &folder) {
        return is_picture_name(picture) && picture.compare(0, folder.size() + 1, folder + "/") == 0;
    };
    return a == b || is_in(a, b) || is_in(b, a);
}

// Whether a profile in this one's history was made from `source`.
bool includes_source(lensprof_store *store, const lensprof_profile &profile, const std::string &source) {
    auto next = std::make_unique<lensprof_profile>(profile);
    std::set<int64_t> seen;
    for (;;) {
        const int64_t id = next->provenance.prior_id;
        if (id <= 0 || !seen.insert(id).second || lensprof_store_get(store, id, next.get(), nullptr) != LENSPROF_OK)
            return false;
        if (may_share(source, next->provenance.source)) return true;
    }
}

// A refined response, a table, states only the error of gamma; an error of 0.7 or more carries no information.
bool has_uncertainty(const lensprof_profile &profile) {
    if (profile.responses == 1 && profile.response[0].kind == LENSPROF_RESPONSE_TABLE
        && profile.provenance.gamma_sigma > 0.0 && profile.provenance.gamma_sigma < 0.7)
        return true;
    for (uint32_t i = 0; i < profile.covariance_size; i++)
        if (profile.covariance[i * profile.covariance_size + i] > 0.0) return true;
    return false;
}

// A response of the kind of camera, not of this camera: the fit has this prior anyway.
void drop_response(lensprof_profile &profile) {
    const uint32_t n = profile.covariance_size, modes = profile.responses == 1 ? profile.response[0].modes : 0;
    for (uint32_t i = 0; i < std::min(modes, n); i++)
        for (uint32_t j = 0; j < n; j++) profile.covariance[i * n + j] = profile.covariance[j * n + i] = 0.0;
}

// Standard error of M in the corner, added to that of profiles at other settings: copies of a lens differ, and most
// measurements in Lensfun have no stated error. Assumed, not measured.
constexpr double kCopySigma = 0.02;

// Adds it to the covariance block of the falloff, which a lookup scales to its stated error.
void add_copy_error(const lensprof_lookup &lookup, lensprof_profile &profile) {
    const double stated = std::hypot(lookup.falloff_sigma, std::hypot(lookup.distance_sigma, lookup.sensor_sigma));
    if (!(stated > 0.0)) return;
    const double scale = (stated * stated + kCopySigma * kCopySigma) / (stated * stated);
    const uint32_t n = profile.covariance_size;
    for (uint32_t i = n - std::min(n, 3 * profile.vignettings); i < n; i++)
        for (uint32_t j = n - std::min(n, 3 * profile.vignettings); j < n; j++) profile.covariance[i * n + j] *= scale;
}

// A prior composed of profiles of the lens at other settings and of the camera with other lenses. No pictures count as
// those of the result.
EarlierProfile composed_prior(const Databases &databases, const lensprof_store *result_store,
                              const lensprof_lookup &lookup, std::unique_ptr<lensprof_profile> profile,
                              const std::string &source_name) {
    const bool is_camera =
        lookup.response_from == LENSPROF_RESPONSE_FROM_PROFILE || lookup.response_from == LENSPROF_RESPONSE_FROM_CAMERA;
    if (!is_camera) drop_response(*profile);
    if (!has_uncertainty(*profile)) return {0, nullptr, "profiles of this lens have no covariance"};
    add_copy_error(lookup, *profile);
    std::vector<std::pair<lensprof_store *, int64_t>> rows;
    for (uint32_t i = 0; i < lookup.rows; i++) rows.emplace_back(databases.store(lookup.falloff_store), lookup.id[i]);
    for (uint32_t i = 0; is_camera && i < lookup.response_rows; i++)
        rows.emplace_back(databases.store(lookup.response_store), lookup.response_id[i]);
    auto row = new_profile();
    double gamma_sigma = 0.0;
    for (const auto &[store, id] : rows) {
        if (lensprof_store_get(store, id, row.get(), nullptr) != LENSPROF_OK) continue;
        if (may_share(row->provenance.source, source_name) || includes_source(store, *row, source_name))
            return {0, nullptr, "profile " + std::to_string(id) + " already includes these pictures"};
        if (row->provenance.forced)
            return {0, nullptr,
                    "profile " + std::to_string(id) + " was stored by force from a fit that was not usable"};
        gamma_sigma = std::max(gamma_sigma, row->provenance.gamma_sigma);
    }
    if (is_camera && profile->response[0].kind == LENSPROF_RESPONSE_TABLE)
        gamma_sigma = std::max(lookup.response_sigma, 0.0);
    lensprof_provenance &provenance = profile->provenance;
    provenance.images = provenance.pairs = 0;
    provenance.gamma_sigma = gamma_sigma;
    const bool is_own = rows.front().first == result_store;
    return {rows.front().second, std::move(profile), "", true, is_own};
}

// The profile with an id in the first database, unless it includes these pictures; `named` is its name.
EarlierProfile single_prior(lensprof_store *store, int64_t id, std::unique_ptr<lensprof_profile> profile,
                            const std::string &source_name, bool is_requested) {
    const std::string named = "profile " + std::to_string(id);
    if (!has_uncertainty(*profile)) return {0, nullptr, named + " has no covariance"};
    if (profile->provenance.forced)
        return {0, nullptr, named + " was stored by force from a fit that was not "
                                                                "usable"};
    if (may_share(source_name, profile->provenance.source)) {  // fitted again: its earlier prior is used again
        id = profile->provenance.prior_id;
        if (id <= 0 || lensprof_store_get(store, id, profile.get(), nullptr) != LENSPROF_OK
            || !has_uncertainty(*profile) || profile->provenance.forced)
            return {0, nullptr, named + " is from these pictures alone, which are fitted again"};
    }
    if (!may_share(source_name, profile->provenance.source) && !includes_source(store, *profile, source_name))
        return {id, std::move(profile), ""};
    const std::string reason = "profile " + std::to_string(id) + " already includes these pictures, and later ones";
    if (is_requested)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      source_name + ": " + reason + "; a fit would add no information." + advice("prior_alone"));
    return {0, nullptr, reason};
}

// A predicted falloff has an error, unlike an imported profile: the lookup asks for a setting slightly off the stored
// one.
lensprof_profile_key offset_key(lensprof_profile_key key, const lensprof_profile &stored) {
    constexpr double relative_offset = 1e-4;
    if (key.aperture == LENSPROF_UNKNOWN) key.aperture = stored.key.aperture;
    if (key.aperture != LENSPROF_UNKNOWN) key.aperture *= 1.0 + relative_offset;
    return key;
}

}  // namespace

EarlierProfile find_stored_prior(const StoreOptions &o, int64_t id, bool is_requested, const lensprof_profile_key &key,
                                 const std::string &source) {
    auto files = o.dbs.empty() ? existing_databases({}) : o.dbs;
    if (!files.empty() && !path_exists(files.front()))
        files.erase(files.begin());  // it is created when the profile is stored
    auto profile = new_profile();
    const std::string source_name = source_of(source);
    if (id) {
        const Store store = open_store(o.db, LENSPROF_STORE_READ);
        lensprof_error error{};
        check(lensprof_store_get(store.get(), id, profile.get(), &error), store_path(o.db), &error);
        EarlierProfile given = single_prior(store.get(), id, std::move(profile), source_name, is_requested);
        if (!given.id)
            throw Failure(LENSPROF_ERROR_ARGUMENT, option_name("stored") + "=" + std::to_string(id) + ": "
                                                       + given.reason + "; give another profile"
                                                       + advice("prior_given"));
        return given;
    }
    if (files.empty()) return {0, nullptr, is_requested ? "no database exists yet" : ""};
    const Databases databases(files);
    lensprof_lookup lookup;
    lensprof_lookup_init(&lookup);
    lensprof_lookup_options options;
    lensprof_lookup_options_init(&options);
    options.response_alone = 1;
    if (databases.look_up(key, options, *profile, lookup) != LENSPROF_OK)
        return {0, nullptr, is_requested ? "no profile is stored for this lens and setting" : ""};
    const bool is_own = is_same_file(databases.file(lookup.falloff_store), o.db.empty() ? user_store_path() : o.db);
    if (lookup.exact && is_own && has_uncertainty(*profile))
        return single_prior(databases.store(lookup.falloff_store), lookup.id[0], std::move(profile), source_name,
                            is_requested);
    if (lookup.exact) {
        const std::string named = "profile " + std::to_string(lookup.id[0]);
        if (databases.look_up(offset_key(key, *profile), options, *profile, lookup) != LENSPROF_OK || lookup.exact)
            return {0, nullptr, named + " has no covariance"};
    }
    return composed_prior(databases, is_own ? databases.store(lookup.falloff_store) : nullptr, lookup,
                          std::move(profile), source_name);
}

}  // namespace lensprof
