#include "fit/prior/exposure_settings.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace lensprof {
namespace {

constexpr double kRoundedSigma = 0.1, kRepeatedSigma = 0.03;  // EV
constexpr double kMaxAbsEv = 40.0;           // EV relative to 1 s, f/1, ISO 100: no picture has such an exposure
constexpr double kRelativeTolerance = 1e-3;  // of times, apertures and ISO

using Settings = std::vector<lensprof_exposure_settings>;

bool is_stated(double value) { return value != LENSPROF_UNKNOWN; }

// What is not stated is that of 1 s, f/1, ISO 100.
double ev_of(const lensprof_exposure_settings &s) {
    return lensprof_settings_ev(s.time_s, is_stated(s.f_number) ? s.f_number : 1.0, is_stated(s.iso) ? s.iso : 100.0);
}

bool is_plausible(double ev) { return std::fabs(ev) < kMaxAbsEv; }

bool is_same(double a, double b) { return std::fabs(a / b - 1.0) < kRelativeTolerance; }

bool can_repeat(const lensprof_exposure_settings &s) {
    return s.is_manual && is_stated(s.time_s) && is_stated(s.f_number) && is_stated(s.iso) && is_plausible(ev_of(s));
}

// Whether two pictures have the same lens, time, aperture and ISO, set manually.
bool is_one_manual_exposure(const lensprof_exposure_settings &a, const lensprof_exposure_settings &b) {
    return can_repeat(a) && can_repeat(b) && a.lens == b.lens && is_same(a.time_s, b.time_s)
           && is_same(a.f_number, b.f_number) && is_same(a.iso, b.iso);
}

// The largest group (at least two) at one manual exposure, of equal ones the first.
std::vector<size_t> largest_manual_group(const Settings &settings) {
    std::vector<size_t> largest(1);
    std::vector<bool> is_seen(settings.size());
    for (size_t i = 0; i < settings.size(); i++) {
        if (is_seen[i]) continue;
        std::vector<size_t> group;
        for (size_t k = i; k < settings.size(); k++)
            if (is_one_manual_exposure(settings[i], settings[k])) is_seen[k] = true, group.push_back(k);
        if (group.size() > largest.size()) largest = std::move(group);
    }
    return largest.size() > 1 ? largest : std::vector<size_t>{};
}

// A lens of a camera.
using Lens = std::pair<uint32_t, uint32_t>;

// Pictures with comparable exposures: of one camera and, if the aperture cancels, of one lens.
using Comparable = std::tuple<uint32_t, bool, Lens>;
using Groups = std::map<Comparable, std::vector<size_t>>;

// Sets the states of all pictures; those that lack nothing are in the groups.
Groups comparable_pictures(const Settings &settings, std::vector<lensprof_known_exposure> &known) {
    std::set<uint32_t> states_iso;
    std::set<Lens> states_aperture;
    for (const lensprof_exposure_settings &s : settings) {
        if (is_stated(s.iso)) states_iso.insert(s.camera);
        if (is_stated(s.f_number)) states_aperture.insert({s.camera, s.lens});
    }
    Groups groups;
    for (size_t i = 0; i < settings.size(); i++) {
        const lensprof_exposure_settings &s = settings[i];
        const Lens lens = {s.camera, s.lens};
        const bool cancels_aperture = !states_aperture.count(lens);
        if (!is_stated(s.time_s))
            known[i].state = LENSPROF_EXPOSURE_NO_TIME;
        else if (!is_stated(s.iso) && states_iso.count(s.camera))
            known[i].state = LENSPROF_EXPOSURE_NO_ISO;
        else if (!is_stated(s.f_number) && !cancels_aperture)
            known[i].state = LENSPROF_EXPOSURE_NO_APERTURE;
        else
            groups[{s.camera, cancels_aperture, cancels_aperture ? lens : Lens{}}].push_back(i);
    }
    return groups;
}

void know(const lensprof_exposure_settings &settings, lensprof_known_exposure &known) {
    known.ev = ev_of(settings);
    known.state = is_plausible(known.ev) ? LENSPROF_EXPOSURE_KNOWN : LENSPROF_EXPOSURE_IMPLAUSIBLE;
    if (known.state == LENSPROF_EXPOSURE_KNOWN) known.sigma = kRoundedSigma;
}

}  // namespace

std::vector<lensprof_known_exposure> known_exposures(const Settings &settings) {
    std::vector<lensprof_known_exposure> known(settings.size(), {NAN, 0.0, LENSPROF_EXPOSURE_APART, 0});
    const Groups groups = comparable_pictures(settings, known);
    std::map<uint32_t, const std::vector<size_t> *> largest;  // per camera
    for (const auto &[key, pictures] : groups) {
        const std::vector<size_t> *&best = largest[std::get<0>(key)];
        if (!best || pictures.size() > best->size()) best = &pictures;
    }
    for (const auto &[camera, pictures] : largest)
        for (const size_t i : *pictures) know(settings[i], known[i]);
    for (const size_t i : largest_manual_group(settings))
        if (known[i].state == LENSPROF_EXPOSURE_KNOWN) known[i].sigma = kRepeatedSigma;
    return known;
}

}  // namespace lensprof
