#include "stored_prior.hpp"

#include <cstdlib>
#include <filesystem>
#include <set>

namespace lensprof {
namespace {

/* The profile that is in one with this method; 0 = none. */
int64_t prior_of(const std::string &method) {
    const size_t plus = method.find('+');
    return plus == std::string::npos ? 0 : std::strtoll(method.c_str() + plus + 1, nullptr, 10);
}

/* Whether the profile, or one that is in it, was made from `source`. */
bool holds(lensprof_store *store, const lensprof_profile &profile, const std::string &source) {
    auto next = std::make_unique<lensprof_profile>(profile);
    std::set<int64_t> seen;
    while (source != next->provenance.source) {
        const int64_t id = prior_of(next->provenance.method);
        if (id <= 0 || !seen.insert(id).second
            || lensprof_store_get(store, id, next.get(), nullptr) != LENSPROF_OK)
            return false;
    }
    return true;
}

bool is_uncertain(const lensprof_profile &profile) {
    for (uint32_t i = 0; i < profile.covariance_size; i++)
        if (profile.covariance[i * profile.covariance_size + i] > 0.0) return true;
    return false;
}

}  // namespace

StoredPrior find_stored_prior(const StoreOptions &o, const lensprof_profile_key &key, const std::string &source) {
    const std::string file = store_path(o.db);
    if (!std::filesystem::exists(file)) return {0, nullptr, "there is no database yet"};
    Store store = open_store(o.db, LENSPROF_STORE_READ);
    auto profile = std::make_unique<lensprof_profile>();
    lensprof_error error{};
    lensprof_lookup how{};
    lensprof_lookup_options options;
    lensprof_lookup_options_init(&options);
    const lensprof_status status = lensprof_store_lookup(store.get(), &key, &options, profile.get(), &how, &error);
    if (status != LENSPROF_ERROR_NOT_FOUND) check(status, file, &error);
    if (status != LENSPROF_OK || !how.exact) return {0, nullptr, "no profile is stored for this lens and setting"};
    const std::string named = "profile " + std::to_string(how.id[0]);
    if (!is_uncertain(*profile)) return {0, nullptr, named + " has no covariance"};
    if (holds(store.get(), *profile, std::filesystem::absolute(source).string()))
        return {0, nullptr, named + " holds these pictures already"};
    return {how.id[0], std::move(profile), ""};
}

std::string fused_method(const std::string &method, int64_t prior) {
    return method + "+" + std::to_string(prior);
}

}  // namespace lensprof
