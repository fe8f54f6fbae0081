#include "cli/fitting/stored_prior.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "cli/pictures/picture.hpp"
#include "cli/program/databases.hpp"
#include "cli/program/paths.hpp"

namespace lensprof {
namespace {

// Whether two sources may have pictures in common: `build FOLDER` stores the folder, and `calibrate FOLDER` a picture
// of each panorama.
bool may_share(const std::string &one, const std::string &other) {
    const auto is_in = [](const std::string &picture, const std::string &folder) {
        return is_picture_name(picture) && picture.compare(0, folder.size() + 1, folder + "/") == 0;
    };
    return one == other || is_in(one, other) || is_in(other, one);
}

// Whether a profile in this one's history was made from `source`.
bool holds(lensprof_store *store, const lensprof_profile &profile, const std::string &source) {
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
bool says_how_sure(const lensprof_profile &profile) {
    if (profile.responses == 1 && profile.response[0].kind == LENSPROF_RESPONSE_TABLE
        && profile.provenance.gamma_sigma > 0.0 && profile.provenance.gamma_sigma < 0.7)
        return true;
    for (uint32_t i = 0; i < profile.covariance_size; i++)
        if (profile.covariance[i * profile.covariance_size + i] > 0.0) return true;
    return false;
}

// A response of the kind of camera, not of this camera: the fit has this prior anyway.
void forget_response(lensprof_profile &profile) {
    const uint32_t n = profile.covariance_size, modes = profile.responses == 1 ? profile.response[0].modes : 0;
    for (uint32_t i = 0; i < std::min(modes, n); i++)
        for (uint32_t j = 0; j < n; j++) profile.covariance[i * n + j] = profile.covariance[j * n + i] = 0.0;
}

// Standard error of M in the corner, added to that of profiles at other settings: copies of a lens differ, and most
// measurements in Lensfun have no stated error. Assumed, not measured.
constexpr double kCopySigma = 0.02;

// Adds it to the covariance block of the falloff, which a lookup scales to its stated error.
void add_copy_error(const lensprof_lookup &how, lensprof_profile &profile) {
    const double stated = std::hypot(how.falloff_sigma, std::hypot(how.distance_sigma, how.sensor_sigma));
    if (!(stated > 0.0)) return;
    const double scale = (stated * stated + kCopySigma * kCopySigma) / (stated * stated);
    const uint32_t n = profile.covariance_size;
    for (uint32_t i = n - std::min(n, 3 * profile.vignettings); i < n; i++)
        for (uint32_t j = n - std::min(n, 3 * profile.vignettings); j < n; j++) profile.covariance[i * n + j] *= scale;
}

// A prior composed of profiles of the lens at other settings and of the camera with other lenses. No pictures count as
// those of the result.
EarlierProfile composed_prior(const Databases &databases, const lensprof_store *own_store, const lensprof_lookup &how,
                              std::unique_ptr<lensprof_profile> profile, const std::string &own) {
    const bool is_camera =
        how.response_from == LENSPROF_RESPONSE_FROM_PROFILE || how.response_from == LENSPROF_RESPONSE_FROM_CAMERA;
    if (!is_camera) forget_response(*profile);
    if (!says_how_sure(*profile)) return {0, nullptr, "profiles of this lens have no covariance"};
    add_copy_error(how, *profile);
    std::vector<std::pair<lensprof_store *, int64_t>> rows;
    for (uint32_t i = 0; i < how.rows; i++) rows.emplace_back(databases.store(how.falloff_store), how.id[i]);
    for (uint32_t i = 0; is_camera && i < how.response_rows; i++)
        rows.emplace_back(databases.store(how.response_store), how.response_id[i]);
    auto row = new_profile();
    double gamma_sigma = 0.0;
    for (const auto &[store, id] : rows) {
        if (lensprof_store_get(store, id, row.get(), nullptr) != LENSPROF_OK) continue;
        if (may_share(row->provenance.source, own) || holds(store, *row, own))
            return {0, nullptr, "profile " + std::to_string(id) + " already includes these pictures"};
        if (row->provenance.forced)
            return {0, nullptr,
                    "profile " + std::to_string(id) + " was stored with --force from a fit that was not usable"};
        gamma_sigma = std::max(gamma_sigma, row->provenance.gamma_sigma);
    }
    if (is_camera && profile->response[0].kind == LENSPROF_RESPONSE_TABLE)
        gamma_sigma = std::max(how.response_sigma, 0.0);
    lensprof_provenance &provenance = profile->provenance;
    provenance.images = provenance.pairs = 0;
    provenance.gamma_sigma = gamma_sigma;
    const bool is_own = rows.front().first == own_store;
    return {rows.front().second, std::move(profile), "", true, is_own};
}

// The profile with an id in the first database, unless it includes these pictures; `named` is its name.
EarlierProfile one_prior(lensprof_store *store, int64_t id, std::unique_ptr<lensprof_profile> profile,
                         const std::string &own, bool is_asked) {
    const std::string named = "profile " + std::to_string(id);
    if (!says_how_sure(*profile)) return {0, nullptr, named + " has no covariance"};
    if (profile->provenance.forced)
        return {0, nullptr, named + " was stored with --force from a fit that was not "
                                                                "usable"};
    if (may_share(own, profile->provenance.source)) {  // fitted again: its earlier prior is used again
        id = profile->provenance.prior_id;
        if (id <= 0 || lensprof_store_get(store, id, profile.get(), nullptr) != LENSPROF_OK || !says_how_sure(*profile)
            || profile->provenance.forced)
            return {0, nullptr, named + " is from these pictures alone, which are fitted again"};
    }
    if (!may_share(own, profile->provenance.source) && !holds(store, *profile, own))
        return {id, std::move(profile), ""};
    const std::string reason = "profile " + std::to_string(id) + " already includes these pictures, and later ones";
    if (is_asked)
        throw Failure(ExitCode::usage,
                      own + ": " + reason + "; a fit would add no information. Use --stored none to fit them alone");
    return {0, nullptr, reason};
}

// A predicted falloff has an error, unlike an imported profile: the lookup asks for a setting slightly off the stored
// one.
lensprof_profile_key beside(lensprof_profile_key key, const lensprof_profile &stored) {
    constexpr double hair = 1e-4;
    if (key.aperture == LENSPROF_UNKNOWN) key.aperture = stored.key.aperture;
    if (key.aperture != LENSPROF_UNKNOWN) key.aperture *= 1.0 + hair;
    return key;
}

}  // namespace

EarlierProfile find_stored_prior(const StoreOptions &o, int64_t id, bool is_asked, const lensprof_profile_key &key,
                                 const std::string &source) {
    auto files = databases_of(o.dbs);
    if (!path_exists(files.front())) files.erase(files.begin());  // it is created when the profile is stored
    auto profile = new_profile();
    const std::string own = source_of(source);
    if (id) {
        const Store store = open_store(o.db, LENSPROF_STORE_READ);
        lensprof_error error{};
        check(lensprof_store_get(store.get(), id, profile.get(), &error), store_path(o.db), &error);
        EarlierProfile given = one_prior(store.get(), id, std::move(profile), own, is_asked);
        if (!given.id)
            throw Failure(ExitCode::usage, "--stored " + std::to_string(id) + ": " + given.reason
                                               + "; give another profile, or --stored none to fit the pictures alone");
        return given;
    }
    if (files.empty()) return {0, nullptr, is_asked ? "no database exists yet" : ""};
    const Databases databases(files);
    lensprof_lookup how;
    lensprof_lookup_init(&how);
    lensprof_lookup_options options;
    lensprof_lookup_options_init(&options);
    options.response_alone = 1;
    if (databases.look_up(key, options, *profile, how) != LENSPROF_OK)
        return {0, nullptr, is_asked ? "no profile is stored for this lens and setting" : ""};
    const bool is_own = is_same_file(databases.file(how.falloff_store), store_path(o.db));
    if (how.exact && is_own && says_how_sure(*profile))
        return one_prior(databases.store(how.falloff_store), how.id[0], std::move(profile), own, is_asked);
    if (how.exact) {
        const std::string named = "profile " + std::to_string(how.id[0]);
        if (databases.look_up(beside(key, *profile), options, *profile, how) != LENSPROF_OK || how.exact)
            return {0, nullptr, named + " has no covariance"};
    }
    return composed_prior(databases, is_own ? databases.store(how.falloff_store) : nullptr, how, std::move(profile),
                          own);
}

}  // namespace lensprof
