#include "photo/cards/card_settings.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <tuple>

#include "photo/base/format.hpp"
#include "photo/base/parallel.hpp"
#include "photo/base/paths.hpp"
#include "photo/calibration/lens_settings.hpp"
#include "photo/cards/card_advice.hpp"
#include "photo/cards/card_names.hpp"
#include "photo/cards/card_units.hpp"
#include "photo/pictures/named_pictures.hpp"
#include "photo/report/report.hpp"

namespace lensprof {
namespace {

// What the names state and EXIF does not.
void complete_by_names(const std::string &file, lensprof_profile_key &key) {
    const lensprof_profile_key named = setting_of_names(file);
    if (!*key.lens) set_text(key.lens, sizeof key.lens, named.lens);
    if (key.focal_mm == LENSPROF_UNKNOWN) key.focal_mm = named.focal_mm;
    if (key.aperture == LENSPROF_UNKNOWN) key.aperture = named.aperture;
    if (key.distance_m == LENSPROF_UNKNOWN) key.distance_m = named.distance_m;
    if (key.color_temperature_k == LENSPROF_UNKNOWN) key.color_temperature_k = named.color_temperature_k;
}

void replace_by_options(const StoreOptions &o, lensprof_profile_key &key) {
    if (!o.camera.empty()) set_text(key.camera_model, sizeof key.camera_model, o.camera);
    if (!o.lens.empty()) set_text(key.lens, sizeof key.lens, o.lens);
    if (o.focal != LENSPROF_UNKNOWN) key.focal_mm = o.focal;
    if (o.aperture != LENSPROF_UNKNOWN) key.aperture = o.aperture;
    if (o.distance != LENSPROF_UNKNOWN) key.distance_m = o.distance;
    if (o.temperature != LENSPROF_UNKNOWN) key.color_temperature_k = o.temperature;
}

struct Read {
    lensprof_profile_key stated;  // by the picture, its name and a table
    std::optional<CardPicture> picture;
    std::string failure;
};

std::vector<Read> read_all(const std::vector<NamedPicture> &named, const CardOptions &o, SettingTable *table,
                           Events &events) {
    std::vector<Read> read(named.size());
    for_each_parallel(static_cast<uint32_t>(named.size()), "reading EXIF", events, [&](uint32_t i) {
        try {
            read[i].picture = CardPicture{named[i].file, read_metadata(named[i].file), i};
        } catch (const Failure &failure) {
            if (!is_of_input(failure)) throw;
            read[i].failure = failure.what();
        }
    });
    const std::vector<std::string> paths = o.units ? paths_without_units(*o.units, named) : std::vector<std::string>();
    for (size_t i = 0; i < read.size(); i++) {
        Read &one = read[i];
        if (!one.picture) {
            if (table) table->use(named[i].file);
            continue;
        }
        lensprof_profile_key &key = one.picture->metadata.key;
        complete_by_names(o.units ? paths[i] : named[i].file, key);
        if (table) table->apply(one.picture->file, key);
        one.stated = key;
        replace_by_options(o.store, key);
    }
    return read;
}

bool states_setting(const lensprof_profile_key &key) {
    return key.focal_mm != LENSPROF_UNKNOWN && key.aperture != LENSPROF_UNKNOWN;
}

bool is_whole(double value) { return std::fabs(value - std::round(value)) < 1e-6 * std::max(value, 1.0); }

// As cameras show f-numbers: two digits.
bool is_shown_aperture(double aperture) { return is_whole(aperture < 10.0 ? 10.0 * aperture : aperture); }

// One nominal f-number. Numbers computed from whole, half or third stops (APEX: 11.31 for f/11) are off by up to 0.082
// stops; nominal ones are 0.089 apart or more (f/3.2 and f/3.3). Two that cameras show as such are never the same.
bool is_same_aperture(double a, double b) {
    constexpr double rounding_stops = 0.085;
    const double stops = std::fabs(2.0 * std::log2(a / b));
    return stops < 1e-3 || (stops < rounding_stops && !(is_shown_aperture(a) && is_shown_aperture(b)));
}

// Of the last digit, at least a thousandth.
double unit_of(double number) {
    double unit = 1.0;
    while (unit > 1e-3 && !is_whole(number / unit)) unit /= 10.0;
    return unit;
}

// One focal length, of which the shorter number may be rounded: 4.25 and 4.3 mm, but not 97 and 98 mm.
bool is_same_focal(double a, double b) { return std::fabs(a - b) < 0.5 * std::max(unit_of(a), unit_of(b)) + 1e-6; }

// Unknown distances are taken as far; all far ones are alike, near ones within the rounding of EXIF.
bool is_same_distance(double a, double b) {
    constexpr double far_m = 9.0, rounding = 0.1;
    const auto is_far = [](double distance) { return distance == LENSPROF_UNKNOWN || distance >= far_m; };
    return is_far(a) || is_far(b) ? is_far(a) && is_far(b) : std::fabs(std::log(a / b)) < rounding;
}

// What only one of them states separates them, too.
bool is_same(const lensprof_profile_key &a, const lensprof_profile_key &b) {
    const auto are_alike = [](double x, double y, bool (*is_one)(double, double)) {
        return x == LENSPROF_UNKNOWN || y == LENSPROF_UNKNOWN ? x == y : is_one(x, y);
    };
    return std::strcmp(a.camera_model, b.camera_model) == 0 && std::strcmp(a.lens, b.lens) == 0
           && are_alike(a.focal_mm, b.focal_mm, is_same_focal) && are_alike(a.aperture, b.aperture, is_same_aperture)
           && is_same_setting(a, b) && is_same_distance(a.distance_m, b.distance_m)
           && a.color_temperature_k == b.color_temperature_k;
}

auto rank_of(const lensprof_profile_key &key) {
    return std::make_tuple(std::string(key.camera_model), std::string(key.lens), key.focal_mm, key.aperture,
                           key.distance_m, key.color_temperature_k);
}

// "24 mm, f/2.8, 2850 K".
std::string label_of(const lensprof_profile_key &key, const std::string &first) {
    const std::string temperature = temperature_text(key);
    const bool is_stated =
        key.focal_mm != LENSPROF_UNKNOWN || key.aperture != LENSPROF_UNKNOWN || key.distance_m != LENSPROF_UNKNOWN;
    if (temperature.empty()) return describe_setting(key, first);
    return is_stated ? describe_setting(key, first) + ", " + temperature : temperature;
}

// The least rounded numbers come first: apertures as cameras show them, focal lengths with most digits, distances that
// are stated.
auto precision_of(const lensprof_profile_key &key) {
    return std::make_tuple(!is_shown_aperture(key.aperture), unit_of(key.focal_mm), key.distance_m == LENSPROF_UNKNOWN,
                           rank_of(key));
}

// A setting, and those that its numbers may be rounded from: none, or several.
struct GroupedSetting {
    CardSetting setting;
    std::vector<size_t> sources;
};

// The settings that a number may be rounded from; those that may be rounded themselves do not count.
std::vector<size_t> sources_of(const std::vector<GroupedSetting> &groups, const lensprof_profile_key &key) {
    std::vector<size_t> sources;
    for (size_t i = 0; i < groups.size(); i++)
        if (groups[i].sources.empty() && is_same(groups[i].setting.key, key)) sources.push_back(i);
    return sources;
}

// The setting that pictures of this key belong to; the end of the list if it is a new one.
size_t group_of(const std::vector<GroupedSetting> &groups, const lensprof_profile_key &key,
                const std::vector<size_t> &sources) {
    if (sources.size() == 1) return sources.front();
    const auto is_it = [&](const GroupedSetting &group) {
        return group.sources == sources && is_same(group.setting.key, key);
    };
    return static_cast<size_t>(std::find_if(groups.begin(), groups.end(), is_it) - groups.begin());
}

// By what the pictures state, not by their order: rounded numbers join the setting that they are rounded from. Those of
// two settings (24 mm, of 23.6 and 24.4) are measured apart from both, with what is the same but for rounding.
std::vector<CardSetting> grouped(const std::vector<CardPicture> &pictures, Events &events) {
    std::map<decltype(precision_of(pictures.front().metadata.key)), std::vector<CardPicture>> alike;
    for (const CardPicture &picture : pictures) alike[precision_of(picture.metadata.key)].push_back(picture);
    std::vector<GroupedSetting> groups;
    for (const auto &[precision, own] : alike) {
        const lensprof_profile_key &key = own.front().metadata.key;
        const std::vector<size_t> sources = sources_of(groups, key);
        const size_t group = group_of(groups, key, sources);
        if (group < groups.size()) {
            std::vector<CardPicture> &joined = groups[group].setting.pictures;
            joined.insert(joined.end(), own.begin(), own.end());
            continue;
        }
        const std::string label = label_of(key, own.front().file);
        if (sources.size() > 1)
            events.note(label, "may be " + groups[sources[0]].setting.label + " or " + groups[sources[1]].setting.label
                                   + ", by the rounding of what cameras state: measured alone; give a table if it is "
                                     "one of them");
        groups.push_back({{key, own, label}, sources});
    }
    std::vector<CardSetting> settings;
    for (GroupedSetting &group : groups) settings.push_back(std::move(group.setting));
    for (CardSetting &setting : settings)
        std::sort(setting.pictures.begin(), setting.pictures.end(),
                  [](const CardPicture &a, const CardPicture &b) { return a.index < b.index; });
    std::stable_sort(settings.begin(), settings.end(),
                     [](const CardSetting &a, const CardSetting &b) { return rank_of(a.key) < rank_of(b.key); });
    return settings;
}

// Names what the pictures of a setting state differently and is yet taken as one.
void note_rounding(const CardSetting &setting, Events &events) {
    const lensprof_profile_key &key = setting.key;
    const CardPicture *named = nullptr;  // the first by name
    for (const CardPicture &picture : setting.pictures) {
        const lensprof_profile_key &other = picture.metadata.key;
        const bool is_stated = other.distance_m != LENSPROF_UNKNOWN && key.distance_m != LENSPROF_UNKNOWN;
        const bool is_rounded = other.focal_mm != key.focal_mm || other.aperture != key.aperture
                                || (is_stated && other.distance_m != key.distance_m);
        if (is_rounded && (!named || picture.file < named->file)) named = &picture;
    }
    if (named)
        events.note(setting.label, named->file + " states " + describe_setting(named->metadata.key, named->file)
                                       + ": taken as one setting, by the rounding of what cameras state; give a table "
                                         "if they are two");
}

// The profile is of the setting, not of what its first picture states.
void take_numbers(CardSetting &setting) {
    for (CardPicture &picture : setting.pictures) {
        lensprof_profile_key &key = picture.metadata.key;
        key.focal_mm = setting.key.focal_mm, key.aperture = setting.key.aperture;
        key.distance_m = setting.key.distance_m;
    }
}

// Options that replace what pictures state differently: they may make one setting of several.
void note_replaced(const std::vector<Read> &read, Events &events) {
    struct Number {
        double lensprof_profile_key::*field;
        bool (*is_one)(double, double);
        const char *option, *name;
    };
    for (const Number &number : {Number{&lensprof_profile_key::focal_mm, is_same_focal, "focal", "focal length"},
                                 {&lensprof_profile_key::aperture, is_same_aperture, "aperture", "aperture"},
                                 {&lensprof_profile_key::distance_m, is_same_distance, "distance", "distance"}}) {
        std::vector<const Read *> replaced;
        for (const Read &one : read) {
            if (!one.picture || one.stated.*number.field == LENSPROF_UNKNOWN) continue;
            if (!number.is_one(one.stated.*number.field, one.picture->metadata.key.*number.field))
                replaced.push_back(&one);
        }
        if (replaced.empty()) continue;
        const Read &first = *replaced.front();
        events.note("", option_name(number.option) + " replaces the " + number.name + " of "
                            + counted(replaced.size(), "picture") + ", such as that of " + first.picture->file + " ("
                            + describe_setting(first.stated, first.picture->file) + ")");
    }
}

// Files with the same bytes as an earlier one.
class Copies {
public:
    // The earlier file, unless both were named: then both are wanted; empty without one. Failure.
    std::string earlier(const NamedPicture &named) {
        const auto [found, is_new] =
            files_.emplace(std::make_pair(file_bytes(named.file), digest_of(named.file)), &named);
        return is_new || !(named.in_folder || found->second->in_folder) ? std::string() : found->second->file;
    }

private:
    std::map<std::pair<uint64_t, std::string>, const NamedPicture *> files_;
};

std::string reason_to_leave_out(const NamedPicture &named, const Read &read, Copies &copies) {
    try {
        const bool is_empty = is_regular_file(named.file) && !file_bytes(named.file);
        if (!read.picture) return is_empty ? named.file + ": is empty (0 bytes); copy it again" : read.failure;
        if (const std::string first = copies.earlier(named); !first.empty()) return named.file + ": a copy of " + first;
    } catch (const Failure &failure) {  // not there any more
        return failure.what();
    }
    if (named.in_folder && !read.picture->metadata.corrected_by.empty())
        return named.file + ": falloff corrected " + read.picture->metadata.corrected_by
               + ": it shows what is left of it; turn the correction off, or give raw files without it";
    return {};
}

std::string unknown_setting_text(const CardPicture &picture) {
    const bool has_focal = picture.metadata.key.focal_mm != LENSPROF_UNKNOWN,
               has_aperture = picture.metadata.key.aperture != LENSPROF_UNKNOWN;
    const char *const missing = has_focal      ? "the aperture"
                                : has_aperture ? "the focal length"
                                               : "focal length and aperture";
    return picture.file + ": neither EXIF nor its name states " + missing
           + "; name it LENS--24mm--2.8 or 24mm_f2.8, or give a table"
           + (has_dark_name(picture.file) ? "; if the lens was covered, give it with " + option_name("dark") : "");
}

// Of several settings, none has pictures of unknown ones.
void leave_out_unknown(CardSettings &settings) {
    if (settings.list.size() < 2) return;
    const auto unknown = std::stable_partition(settings.list.begin(), settings.list.end(),
                                               [](const CardSetting &s) { return states_setting(s.key); });
    if (unknown == settings.list.begin()) return;  // all of them: no picture states its setting
    for (auto setting = unknown; setting != settings.list.end(); ++setting)
        for (const CardPicture &picture : setting->pictures)
            settings.left_out.push_back({picture.file, unknown_setting_text(picture)});
    settings.list.erase(unknown, settings.list.end());
}

// A setting of several units becomes one per unit, in the order of their names.
std::vector<CardSetting> settings_of_units(const std::vector<CardSetting> &settings) {
    std::vector<CardSetting> split;
    for (size_t group = 0; group < settings.size(); group++) {
        std::map<std::string, CardSetting> units;
        for (const CardPicture &picture : settings[group].pictures) {
            CardSetting &own = units[picture.unit];
            own.key = settings[group].key, own.label = settings[group].label;
            own.unit = picture.unit, own.group = group;
            own.pictures.push_back(picture);
        }
        for (auto &[unit, own] : units) split.push_back(std::move(own));
    }
    return split;
}

// Where the colour temperature of some cards is stated, that of none is the usual one.
void leave_out_without_temperature(CardSettings &settings) {
    const auto has_temperature = [](const CardSetting &s) { return s.key.color_temperature_k != LENSPROF_UNKNOWN; };
    const auto unknown = std::stable_partition(settings.list.begin(), settings.list.end(), has_temperature);
    if (unknown == settings.list.begin()) return;
    for (auto setting = unknown; setting != settings.list.end(); ++setting)
        for (const CardPicture &picture : setting->pictures)
            settings.left_out.push_back(
                {picture.file, picture.file
                                   + ": its name does not state the colour temperature, as those of others do; put it "
                                     "in a folder such as 2850K, or give a table"});
    settings.list.erase(unknown, settings.list.end());
}

}  // namespace

std::string temperature_text(const lensprof_profile_key &key) {
    return key.color_temperature_k == LENSPROF_UNKNOWN ? std::string() : format("%g K", key.color_temperature_k);
}

CardSettings card_settings(const std::vector<std::string> &names, const CardOptions &o, SettingTable *table,
                           Events &events) {
    CardSettings settings;
    std::vector<std::string> other_files;
    std::vector<UnlistedFolder> unlisted;
    std::vector<NamedPicture> named = named_pictures(names, "", other_files, &unlisted);
    leave_out_dark_frames(o.dark_files, named, events);
    for (const std::string &line : other_files) events.warn("", line);
    for (const UnlistedFolder &folder : unlisted) settings.left_out.push_back({folder.folder, folder.reason});
    settings.given = named.size();
    std::vector<CardPicture> pictures;
    const std::vector<Read> read = read_all(named, o, table, events);
    events.clear();
    note_replaced(read, events);
    Copies copies;
    for (size_t i = 0; i < named.size(); i++) {
        settings.has_folders |= named[i].in_folder;
        const std::string reason = reason_to_leave_out(named[i], read[i], copies);
        if (reason.empty())
            pictures.push_back(*read[i].picture);
        else
            settings.left_out.push_back({named[i].file, reason});
    }
    if (o.units)
        for (const LeftOutCard &one : assign_units(*o.units, named, pictures, events)) settings.left_out.push_back(one);
    if (o.units) settings.missing_units = units_without_pictures(*o.units, names, pictures, settings.left_out);
    if (pictures.empty()) {
        const LeftOutCard &first = settings.left_out.front();
        throw Failure(LENSPROF_ERROR_READ, settings.left_out.size() == 1
                                               ? first.reason
                                               : "none of the " + counted(settings.left_out.size(), "picture")
                                                     + " can be used; the first: " + first.reason);
    }
    settings.list = grouped(pictures, events);
    leave_out_unknown(settings);
    leave_out_without_temperature(settings);
    for (CardSetting &setting : settings.list) note_rounding(setting, events), take_numbers(setting);
    if (o.units) settings.list = settings_of_units(settings.list);
    return settings;
}

}  // namespace lensprof
