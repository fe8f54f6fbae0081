// Which settings of a lens are still to be photographed, by the error of the store's predictions.
#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <set>

#include "photo/base/memory_file.hpp"
#include "photo/cards/lens_cards.hpp"
#include "photo/report/report.hpp"

namespace lensprof {
namespace {

constexpr double f_numbers[] = {1,   1.1, 1.2, 1.4, 1.6, 1.8, 2,  2.2, 2.5, 2.8, 3.2, 3.5, 4,  4.5, 5, 5.6,
                                6.3, 7.1, 8,   9,   10,  11,  13, 14,  16,  18,  20,  22,  25, 29,  32};
constexpr double usual_smallest = 16.0;
constexpr size_t most_missing = 20;

// The f-number as a camera shows it.
double shown_aperture(double aperture) {
    return *std::min_element(std::begin(f_numbers), std::end(f_numbers), [&](double a, double b) {
        return std::fabs(std::log(a / aperture)) < std::fabs(std::log(b / aperture));
    });
}

// What the settings of a lens span.
struct Range {
    double shortest = INFINITY, longest = 0.0;  // focal length, mm
    double widest[2] = {INFINITY, INFINITY};    // f-number at the shortest and the longest
    double smallest = usual_smallest;

    // Variable apertures change about linearly with the logarithm of the focal length.
    double widest_at(double focal_mm) const {
        if (!(longest > shortest)) return widest[0];
        const double t = std::log(focal_mm / shortest) / std::log(longest / shortest);
        return widest[0] * std::pow(widest[1] / widest[0], t);
    }
};

// "EF24-70mm f/2.8", "18-135mm F3.5-5.6", "XF56mmF1.2".
void read_name(const std::string &lens, Range &range) {
    static const std::regex focal(R"((\d+(?:\.\d+)?)\s*-\s*(\d+(?:\.\d+)?)\s*mm)", std::regex::icase),
        aperture(R"([fF]\s*/?\s*(\d+(?:\.\d+)?)(?:\s*-\s*(\d+(?:\.\d+)?))?(?![\d.]|\s*-?[\d.]*\s*mm))");
    std::smatch found;
    if (std::regex_search(lens, found, focal)) {
        const double shortest = std::stod(found[1]), longest = std::stod(found[2]);
        if (shortest > 0.0 && longest > shortest) range.shortest = shortest, range.longest = longest;
    }
    if (std::regex_search(lens, found, aperture) && std::stod(found[1]) >= 0.7) {
        range.widest[0] = range.widest[1] = std::stod(found[1]);
        if (found[2].matched && std::stod(found[2]) >= range.widest[0]) range.widest[1] = std::stod(found[2]);
    }
}

Range range_of(const std::vector<const MeasuredSetting *> &settings) {
    Range range;
    read_name(settings.front()->of.key.lens, range);
    double least = INFINITY;
    for (const MeasuredSetting *setting : settings) {
        const lensprof_profile_key &key = setting->of.key;
        range.shortest = std::min(range.shortest, key.focal_mm), range.longest = std::max(range.longest, key.focal_mm);
        range.smallest = std::max(range.smallest, key.aperture);
        least = std::min(least, setting->of.pictures.front().metadata.open_f_number.value_or(key.aperture));
    }
    for (double &widest : range.widest)
        if (std::isinf(widest)) widest = least;
    return range;
}

std::vector<MissingSetting> candidates_of(const Range &range) {
    const double middle = std::round(std::sqrt(range.shortest * range.longest));
    std::set<double> focals{range.shortest, range.longest};
    if (range.longest / range.shortest > 1.5) focals.insert(middle);
    std::vector<MissingSetting> candidates;
    for (const double focal : focals) {
        const double widest = range.widest_at(focal);
        std::set<double> apertures{shown_aperture(widest), shown_aperture(range.smallest)};
        for (const double stops : {1.0, 2.0, 3.0})
            if (widest * std::exp2(stops / 2.0) < range.smallest)
                apertures.insert(shown_aperture(widest * std::exp2(stops / 2.0)));
        for (const double aperture : apertures) candidates.push_back({{}, {}, focal, aperture, NAN});
    }
    return candidates;
}

// A database of its own with the settings as measured, which is gone afterwards.
class Predictions {
public:
    explicit Predictions(const std::vector<const MeasuredSetting *> &settings) {
        lensprof_store *store = nullptr;
        lensprof_error error{};
        check(lensprof_store_open((folder_.path() + "/predictions.db").c_str(), LENSPROF_STORE_CREATE, &store, &error),
              "predictions", &error);
        store_.reset(store);
        check(lensprof_store_begin(store, &error), "predictions", &error);  // never committed
        for (const MeasuredSetting *setting : settings)
            if (setting->is_good()) put(*setting->fit->profile, setting->of.key);
        for (const MeasuredSetting *setting : settings)  // that will be taken again
            if (!setting->is_good()) add_as_measured(setting->of.key);
    }

    // Standard error of the corner; NAN: not predicted.
    double sigma_at(const lensprof_profile_key &key) {
        auto profile = new_profile();
        lensprof_lookup lookup;
        lensprof_lookup_init(&lookup);
        const lensprof_status status =
            lensprof_store_lookup(store_.get(), &key, nullptr, profile.get(), &lookup, nullptr);
        if (status != LENSPROF_OK) return NAN;
        return lookup.exact ? 0.0 : lookup.falloff_sigma;
    }

    // Takes a setting as measured: with its prediction or, without one, with the falloff of any measured setting.
    void add_as_measured(const lensprof_profile_key &key) {
        auto profile = new_profile();
        if (lensprof_store_lookup(store_.get(), &key, nullptr, profile.get(), nullptr, nullptr) != LENSPROF_OK && any_)
            check(lensprof_profile_copy(profile.get(), any_.get()), "predictions");
        put(*profile, key);
    }

private:
    void put(const lensprof_profile &from, const lensprof_profile_key &key) {
        auto profile = new_profile();
        check(lensprof_profile_copy(profile.get(), &from), "predictions");
        profile->key = key;
        profile->covariance_size = 0;
        lensprof_error error{};
        check(lensprof_store_put(store_.get(), profile.get(), nullptr, &error), "predictions", &error);
        any_ = std::move(profile);
    }

    const TemporaryFolder folder_;
    Store store_;
    std::unique_ptr<lensprof_profile> any_;
};

std::vector<MissingSetting> missing_of(const std::vector<const MeasuredSetting *> &settings, double limit) {
    Predictions predictions(settings);
    std::vector<MissingSetting> candidates = candidates_of(range_of(settings)), missing;
    const auto worse = [](double a, double b) { return std::isnan(a) ? !std::isnan(b) : a > b; };
    while (missing.size() < most_missing) {
        const MissingSetting *worst = nullptr;
        lensprof_profile_key key = settings.front()->of.key, worst_key = key;
        for (MissingSetting &candidate : candidates) {
            key.focal_mm = candidate.focal_mm, key.aperture = candidate.aperture;
            candidate.sigma = predictions.sigma_at(key);
            if (!worst || worse(candidate.sigma, worst->sigma)) worst = &candidate, worst_key = key;
        }
        if (!worst || worst->sigma <= limit) break;
        missing.push_back(*worst);
        predictions.add_as_measured(worst_key);
    }
    std::sort(missing.begin(), missing.end(), [](const MissingSetting &a, const MissingSetting &b) {
        return std::pair(a.focal_mm, a.aperture) < std::pair(b.focal_mm, b.aperture);
    });
    return missing;
}

}  // namespace

std::vector<MissingSetting> missing_settings(const std::vector<MeasuredSetting> &settings, double limit) {
    std::map<std::pair<std::string, std::string>, std::vector<const MeasuredSetting *>> lenses;
    for (const MeasuredSetting &setting : settings) {
        const lensprof_profile_key &key = setting.of.key;
        if (*key.lens && key.focal_mm != LENSPROF_UNKNOWN && key.aperture != LENSPROF_UNKNOWN)
            lenses[{key.camera_model, key.lens}].push_back(&setting);
    }
    std::vector<MissingSetting> missing;
    for (const auto &[name, of_lens] : lenses) {
        if (std::none_of(of_lens.begin(), of_lens.end(), [](const MeasuredSetting *s) { return s->is_good(); }))
            continue;
        std::vector<MissingSetting> own = missing_of(of_lens, limit);
        const lensprof_profile_key &key = of_lens.front()->of.key;
        for (MissingSetting &setting : own)
            setting.camera = camera_name(key.camera_maker, key.camera_model), setting.lens = name.second;
        missing.insert(missing.end(), own.begin(), own.end());
    }
    return missing;
}

}  // namespace lensprof
