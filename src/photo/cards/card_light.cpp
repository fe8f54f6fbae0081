#include "photo/cards/card_light.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "photo/base/format.hpp"
#include "photo/calibration/lens_settings.hpp"
#include "photo/calibration/scene_trial.hpp"
#include "photo/cards/card_names.hpp"
#include "photo/scene/open_scene.hpp"

namespace lensprof {
namespace {

using Row3 = std::array<double, 3>;

constexpr double light_sigma_ev = 0.5;  // of each coefficient of the light, before it is measured
constexpr double missed_share = 0.08;   // of a known light, which simulated pictures show by 92 to 94 %
constexpr int radii = 64;
constexpr double least_scale = 0.98;  // of focal lengths: that of the check, within the rounding of EXIF

// Solves the 3 x 3 system by Cramer's rule; its matrix is positive definite.
Row3 solved(const std::array<Row3, 3> &a, const Row3 &b) {
    const auto determinant = [](const std::array<Row3, 3> &m) {
        return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
               + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    };
    Row3 x;
    const double whole = determinant(a);
    for (size_t column = 0; column < 3; column++) {
        std::array<Row3, 3> replaced = a;
        for (size_t row = 0; row < 3; row++) replaced[row][column] = b[row];
        x[column] = determinant(replaced) / whole;
    }
    return x;
}

// k of least squares, weighted by area, to M(r) 2^-light(r scale).
Row3 refitted(const lensprof_vignetting &falloff, const RadialLight &light, double scale) {
    std::array<Row3, 3> a{};
    Row3 b{};
    for (int n = 1; n <= radii; n++) {
        const double r = double(n) / radii, r2 = r * r;
        const double wanted =
            lensprof_vignetting_eval(&falloff, r2, nullptr) * std::exp2(-light.ev_at(r * scale)) - 1.0;
        const Row3 powers{r2, r2 * r2, r2 * r2 * r2};
        for (size_t i = 0; i < 3; i++) {
            b[i] += r * powers[i] * wanted;
            for (size_t k = 0; k < 3; k++) a[i][k] += r * powers[i] * powers[k];
        }
    }
    return solved(a, b);
}

// First row of a falloff curve in the covariance of a profile (profile.h).
uint32_t first_row(const lensprof_profile &profile, uint32_t curve) {
    uint32_t row = 3 * curve;
    for (uint32_t n = 0; n < profile.responses; n++)
        if (profile.response[n].kind == LENSPROF_RESPONSE_EMOR) row += profile.response[n].modes;
    return row;
}

// dk/dc of a curve, by central differences.
std::array<Row3, 2> slopes_of(const lensprof_vignetting &falloff, const RadialLight &light, double scale) {
    constexpr double step = 1e-4;
    std::array<Row3, 2> slopes;
    for (size_t n = 0; n < 2; n++) {
        RadialLight more = light, less = light;
        more.c[n] += step, less.c[n] -= step;
        const Row3 high = refitted(falloff, more, scale), low = refitted(falloff, less, scale);
        for (size_t i = 0; i < 3; i++) slopes[n][i] = (high[i] - low[i]) / (2.0 * step);
    }
    return slopes;
}

// The light is the same in all curves, so that their errors are correlated.
void add_error(const RadialLight &light, double scale, const lensprof_vignetting *before, lensprof_profile &profile) {
    const uint32_t size = profile.covariance_size;
    if (!size || first_row(profile, profile.vignettings) > size) return;
    std::vector<std::array<Row3, 2>> slopes;
    for (uint32_t curve = 0; curve < profile.vignettings; curve++)
        slopes.push_back(slopes_of(before[curve], light, scale));
    const auto slope = [&](uint32_t i, size_t n) { return slopes[i / 3][n][i % 3]; };
    const uint32_t first = first_row(profile, 0), count = 3 * profile.vignettings;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = i; k < count; k++) {  // symmetric to the last digit
            double sum = profile.covariance[(first + i) * size + first + k];
            for (size_t n = 0; n < 2; n++)
                for (size_t m = 0; m < 2; m++) sum += slope(i, n) * light.covariance[n][m] * slope(k, m);
            profile.covariance[(first + i) * size + first + k] = profile.covariance[(first + k) * size + first + i] =
                sum;
        }
}

// What distinguishes the setting of the pictures from that of cards: "aperture".
std::vector<std::string> differences(const lensprof_profile_key &cards, const lensprof_profile_key &pictures) {
    std::vector<std::string> found;
    const auto add = [&](bool differs, const char *what) {
        if (differs) found.emplace_back(what);
    };
    const auto differ = [](const char *a, const char *b) { return *a && *b && std::strcmp(a, b) != 0; };
    add(differ(cards.camera_model, pictures.camera_model), "camera");
    add(differ(cards.lens, pictures.lens), "lens");
    for (const auto &[field, what] : {std::pair(&lensprof_profile_key::focal_mm, "focal length"),
                                      std::pair(&lensprof_profile_key::aperture, "aperture"),
                                      std::pair(&lensprof_profile_key::distance_m, "distance")}) {
        lensprof_profile_key a, b;  // with this number alone; distances differ by what they mean at a focal length
        lensprof_profile_key_init(&a), lensprof_profile_key_init(&b);
        if (field == &lensprof_profile_key::distance_m) a.focal_mm = b.focal_mm = pictures.focal_mm;
        a.*field = cards.*field, b.*field = pictures.*field;
        add(!is_same_setting(a, b), what);
    }
    return found;
}

// The good setting that differs least: "a.tif and others (24 mm, f/2.8) differ in aperture".
std::string nearest_setting(const std::vector<MeasuredSetting> &settings, const lensprof_profile_key &key) {
    const MeasuredSetting *nearest = nullptr;
    std::vector<std::string> least;
    for (const MeasuredSetting &setting : settings) {
        if (!setting.is_good()) continue;
        const std::vector<std::string> own = differences(setting.of.key, key);
        if (!nearest || own.size() < least.size()) nearest = &setting, least = own;
    }
    if (!nearest) return "no setting of the cards is good";
    return "no good setting of the cards is of their camera, lens, focal length, aperture and distance; the nearest, "
           + nearest->of.label + " (" + nearest->of.pictures.front().file + "), differs in " + joined(least, " and ");
}

// What EXIF does not state of a picture, its name may.
lensprof_profile_key with_names(lensprof_profile_key key, const std::string &file) {
    const lensprof_profile_key named = setting_of_names(file);
    for (const auto field :
         {&lensprof_profile_key::focal_mm, &lensprof_profile_key::aperture, &lensprof_profile_key::distance_m})
        if (key.*field == LENSPROF_UNKNOWN) key.*field = named.*field;
    return key;
}

// Failure if the cards are of several focal lengths or apertures, and the picture states none.
void require_one_setting(const lensprof_profile_key &key, const std::string &file,
                         const std::vector<MeasuredSetting> &settings) {
    for (const auto &[field, what] : {std::pair(&lensprof_profile_key::focal_mm, "focal length"),
                                      std::pair(&lensprof_profile_key::aperture, "aperture")})
        for (const MeasuredSetting &setting : settings)
            if (key.*field == LENSPROF_UNKNOWN && setting.of.key.*field != settings.front().of.key.*field)
                throw Failure(LENSPROF_ERROR_NOT_USABLE,
                              file + ": neither EXIF nor its name states the " + what
                                  + ", and the cards are of several; give pictures that do, such as "
                                    "Lens_name--35mm--2.8_1.tif");
}

}  // namespace

std::string LightCheck::text() const {
    if (!rings) return "shows no corners";
    const std::string amount = format("%+.2f ± %.2f EV", ring_ev[rings - 1], ring_sigma_ev[rings - 1]);
    switch (corners) {
    case LENSPROF_TRIAL_CORNERS_AGREE: return "the corners come out right: " + amount;
    case LENSPROF_TRIAL_CORNERS_TOO_DARK: return "the corners come out too dark: " + amount;
    case LENSPROF_TRIAL_CORNERS_TOO_BRIGHT: return "the corners come out too bright: " + amount;
    default: return "the corners are not shown well enough: " + amount;
    }
}

LightCheck check_light(const std::vector<std::string> &pictures, bool are_linear,
                       const std::vector<MeasuredSetting> &settings, Events &events) {
    WarningsAlone warnings(events);
    const Scene scene = open_scene(pictures, {}, warnings);
    const SceneTrial trial(scene, are_linear, events);
    const lensprof_profile_key key = with_names(trial.key(), trial.file());
    LightCheck check;
    check.pictures = scene.path;
    require_one_setting(key, trial.file(), settings);
    const auto is_theirs = [&](const MeasuredSetting &setting) {
        const lensprof_profile_key &a = setting.of.key, &b = key;
        const bool is_camera = !*a.camera_model || !*b.camera_model || std::strcmp(a.camera_model, b.camera_model) == 0;
        return setting.is_good() && is_camera && is_same_setting(a, b);
    };
    const auto found = std::find_if(settings.begin(), settings.end(), is_theirs);
    if (found == settings.end())
        throw Failure(LENSPROF_ERROR_NOT_USABLE, check.pictures + ": taken at " + describe_setting(key, "unknown")
                                                     + ": " + nearest_setting(settings, key));
    check.setting = static_cast<size_t>(found - settings.begin());
    lensprof_trial_result result;
    lensprof_trial_result_init(&result);
    const std::vector<lensprof_trial_candidate> candidates = trial.run({found->fit->profile.get()}, &result);
    const lensprof_trial_candidate &candidate = candidates.front();
    check.corners = candidate.corners, check.rings = candidate.rings;
    std::copy_n(result.ring_end, LENSPROF_TRIAL_RINGS, check.ring_end);
    std::copy_n(candidate.ring_ev, LENSPROF_TRIAL_RINGS, check.ring_ev);
    std::copy_n(candidate.ring_sigma_ev, LENSPROF_TRIAL_RINGS, check.ring_sigma_ev);
    return check;
}

RadialLight light_of(const LightCheck &check) {
    const double *ends = check.ring_end;
    double a[2][2] = {{1.0 / (light_sigma_ev * light_sigma_ev), 0.0}, {0.0, 1.0 / (light_sigma_ev * light_sigma_ev)}};
    double b[2] = {0.0, 0.0};
    const double middle = ends[0] * ends[0] / 2.0;  // mean r^2 of the first ring, with which the others are compared
    for (uint32_t ring = 1; ring < check.rings; ring++) {
        const double r2 = (ends[ring - 1] * ends[ring - 1] + ends[ring] * ends[ring]) / 2.0;
        const double powers[2] = {r2 - middle, r2 * r2 - middle * middle};
        const double weight = 1.0 / std::max(check.ring_sigma_ev[ring] * check.ring_sigma_ev[ring], 1e-6);
        for (int i = 0; i < 2; i++) {
            b[i] -= weight * powers[i] * check.ring_ev[ring];  // corrected, what is too bright had too little light
            for (int k = 0; k < 2; k++) a[i][k] += weight * powers[i] * powers[k];
        }
    }
    RadialLight light;
    const double determinant = a[0][0] * a[1][1] - a[0][1] * a[1][0];
    light.covariance[0][0] = a[1][1] / determinant, light.covariance[1][1] = a[0][0] / determinant;
    light.covariance[0][1] = light.covariance[1][0] = -a[0][1] / determinant;
    for (int i = 0; i < 2; i++) light.c[i] = light.covariance[i][0] * b[0] + light.covariance[i][1] * b[1];
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 2; k++) light.covariance[i][k] += missed_share * missed_share * light.c[i] * light.c[k];
    return light;
}

bool divide_by_light(const RadialLight &light, double scale, lensprof_profile &profile) {
    lensprof_vignetting before[3];
    std::copy_n(profile.vignetting, 3, before);
    for (lensprof_vignetting &curve : profile.vignetting) {
        const Row3 k = refitted(curve, light, scale);
        std::copy_n(k.begin(), 3, curve.k);
    }
    const auto is_valid = [](const lensprof_vignetting &curve) {
        return lensprof_vignetting_validate(&curve) == LENSPROF_OK;
    };
    if (!std::all_of(profile.vignetting, profile.vignetting + 3, is_valid)) {
        std::copy_n(before, 3, profile.vignetting);
        return false;
    }
    add_error(light, scale, before, profile);
    return true;
}

size_t remove_light(const LightCheck &check, std::vector<MeasuredSetting> &settings) {
    const lensprof_profile_key checked = settings[check.setting].of.key;
    const RadialLight light = light_of(check);
    size_t corrected = 0;
    for (MeasuredSetting &setting : settings) {
        if (!setting.is_good()) continue;
        const lensprof_profile_key &key = setting.of.key;
        const bool is_lens =
            std::strcmp(key.camera_model, checked.camera_model) == 0 && std::strcmp(key.lens, checked.lens) == 0;
        const bool are_known = key.focal_mm != LENSPROF_UNKNOWN && checked.focal_mm != LENSPROF_UNKNOWN;
        const double scale = key.focal_mm == checked.focal_mm ? 1.0  // of angles
                             : are_known                      ? checked.focal_mm / key.focal_mm
                                                              : INFINITY;
        if (!is_lens || !(scale * least_scale <= 1.0)) {
            setting.notices.note("",
                                 "the pictures given to check the light show less of it than these cards: it is not "
                                 "removed; check with pictures at the shortest focal length");
            continue;
        }
        if (!divide_by_light(light, scale, *setting.fit->profile)) {
            setting.notices.warn("",
                                 "the light cannot be removed from so deep a falloff: take the cards again in an even "
                                 "light");
            continue;
        }
        corrected++;
        setting.notices.note("", format("the light on the cards was %s in the corners, %+.2f EV, compared with %s, and "
                                        "is removed",
                                        check.corners == LENSPROF_TRIAL_CORNERS_TOO_BRIGHT ? "darker" : "brighter",
                                        light.ev_at(std::min(scale, 1.0)), check.pictures.c_str()));
    }
    return corrected;
}

}  // namespace lensprof
