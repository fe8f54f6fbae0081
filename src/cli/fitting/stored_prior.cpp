#include "cli/fitting/stored_prior.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include "cli/program/paths.hpp"

namespace lensprof {
namespace {

// Whether a profile that is in this one was made from `source`.
bool holds(lensprof_store *store, const lensprof_profile &profile, const std::string &source) {
    auto next = std::make_unique<lensprof_profile>(profile);
    std::set<int64_t> seen;
    for (;;) {
        const int64_t id = next->provenance.prior_id;
        if (id <= 0 || !seen.insert(id).second || lensprof_store_get(store, id, next.get(), nullptr) != LENSPROF_OK)
            return false;
        if (source == next->provenance.source) return true;
    }
}

bool is_uncertain(const lensprof_profile &profile) {
    for (uint32_t i = 0; i < profile.covariance_size; i++)
        if (profile.covariance[i * profile.covariance_size + i] > 0.0) return true;
    return false;
}

// A response that is none of this camera's but of its kind: the fit knows that by itself.
void forget_response(lensprof_profile &profile) {
    const uint32_t n = profile.covariance_size, modes = profile.responses == 1 ? profile.response[0].modes : 0;
    for (uint32_t i = 0; i < std::min(modes, n); i++)
        for (uint32_t j = 0; j < n; j++) profile.covariance[i * n + j] = profile.covariance[j * n + i] = 0.0;
}

// What is composed of profiles of the lens at other settings, and of the camera with other lenses. It is the prior, but
// nobody's pictures count as those of the result.
EarlierProfile composed_prior(lensprof_store *store, const lensprof_lookup &how,
                              std::unique_ptr<lensprof_profile> profile, const std::string &own) {
    const bool is_camera =
        how.response_from == LENSPROF_RESPONSE_FROM_PROFILE || how.response_from == LENSPROF_RESPONSE_FROM_CAMERA;
    if (!is_camera) forget_response(*profile);
    if (!is_uncertain(*profile)) return {0, nullptr, "profiles of this lens have no covariance"};
    std::vector<int64_t> ids(how.id, how.id + how.rows);
    if (is_camera) ids.insert(ids.end(), how.response_id, how.response_id + how.response_rows);
    auto row = new_profile();
    double gamma_sigma = 0.0;
    for (const int64_t id : ids) {
        if (lensprof_store_get(store, id, row.get(), nullptr) != LENSPROF_OK) continue;
        if (row->provenance.source == own || holds(store, *row, own))
            return {0, nullptr, "profile " + std::to_string(id) + " holds these pictures already"};
        if (row->provenance.forced)
            return {0, nullptr,
                    "profile " + std::to_string(id) + " was stored by --force, of a fit that was not usable"};
        gamma_sigma = std::max(gamma_sigma, row->provenance.gamma_sigma);
    }
    lensprof_provenance &provenance = profile->provenance;
    provenance.images = provenance.pairs = 0;
    provenance.gamma_sigma = gamma_sigma;
    return {how.id[0], std::move(profile), "", true};
}

}  // namespace

EarlierProfile find_stored_prior(const StoreOptions &o, const lensprof_profile_key &key, const std::string &source) {
    const std::string file = store_path(o.db);
    if (!path_exists(file)) return {0, nullptr, "there is no database yet"};
    Store store = open_store(o.db, LENSPROF_STORE_READ);
    auto profile = new_profile();
    lensprof_error error{};
    lensprof_lookup how;
    lensprof_lookup_init(&how);
    lensprof_lookup_options options;
    lensprof_lookup_options_init(&options);
    const lensprof_status status = lensprof_store_lookup(store.get(), &key, &options, profile.get(), &how, &error);
    if (status != LENSPROF_ERROR_NOT_FOUND) check(status, file, &error);
    if (status != LENSPROF_OK) return {0, nullptr, "no profile is stored for this lens and setting"};
    if (!how.exact) return composed_prior(store.get(), how, std::move(profile), source_of(source));
    const std::string named = "profile " + std::to_string(how.id[0]);
    if (!is_uncertain(*profile)) return {0, nullptr, named + " has no covariance"};
    if (profile->provenance.forced) return {0, nullptr, named + " was stored by --force, of a fit that was not usable"};
    const std::string own = source_of(source);
    int64_t id = how.id[0];
    if (own == profile->provenance.source) {  // fitted again: what it was given then is the prior again
        id = profile->provenance.prior_id;
        if (id <= 0 || lensprof_store_get(store.get(), id, profile.get(), nullptr) != LENSPROF_OK
            || !is_uncertain(*profile))
            return {0, nullptr, named + " is of these pictures alone, which are fitted again"};
    }
    if (own == profile->provenance.source || holds(store.get(), *profile, own))
        throw Failure(ExitCode::usage, source + ": profile " + std::to_string(id)
                                           + " holds these pictures already, and others that came later; nothing would be "
                                             "gained. Leave --prior auto out to fit them alone");
    return {id, std::move(profile), ""};
}

}  // namespace lensprof
