#include "photo/cards/lens_cards.hpp"

#include <algorithm>

#include "photo/base/format.hpp"
#include "photo/base/parallel.hpp"

namespace lensprof {
namespace {

// The values of a list for some of the pictures; a list of another length is the same for all.
template <class Value>
std::vector<Value> of_pictures(const std::vector<Value> &values, const CardSetting &setting, size_t given) {
    if (values.size() != given) return values;
    std::vector<Value> part;
    for (const CardPicture &picture : setting.pictures) part.push_back(values[picture.index]);
    return part;
}

CardOptions options_of(const CardOptions &o, const CardSetting &setting, size_t given) {
    CardOptions own = o;
    own.shots = of_pictures(o.shots, setting, given);
    own.ev = of_pictures(o.ev, setting, given);
    own.rotation_deg = of_pictures(o.rotation_deg, setting, given);
    own.cards = of_pictures(o.cards, setting, given);
    own.own_light |= o.rotation_deg.empty() && !o.turned && !o.several;  // as that of shots held by hand
    own.threads = 1;
    return own;
}

void measure(const CardOptions &o, MeasuredSetting &setting) {
    const std::vector<CardPicture> &pictures = setting.of.pictures;
    const lensprof_profile_key &key = setting.of.key;
    if (pictures.size() > 1 && (key.focal_mm == LENSPROF_UNKNOWN || key.aperture == LENSPROF_UNKNOWN))
        setting.notices.note("", "focal length or aperture are unknown: the pictures are taken for one setting");
    try {
        if (pictures.size() > LENSPROF_FLAT_IMAGES)
            throw Failure(LENSPROF_ERROR_NOT_USABLE, counted(pictures.size(), "picture")
                                                         + " of one setting; give at most "
                                                         + std::to_string(LENSPROF_FLAT_IMAGES));
        CardInput input = prepare_cards(o, pictures, setting.notices);
        setting.fit = fit_cards(o, input, setting.notices);
        if (!setting.fit->fit.usable)
            setting.refusal = setting.fit->shows_any_even_light()
                                  ? setting.fit->verdict.headline()
                                  : "the pictures do not show an even light" + advice("photographs");
    } catch (const Failure &failure) {
        if (!is_of_input(failure)) throw;
        setting.refusal = failure.what(), setting.status = failure.status;
    }
}

}  // namespace

std::vector<MeasuredSetting> measure_settings(const CardOptions &o, const CardSettings &settings, uint32_t threads,
                                              Events &events) {
    if (o.cards.size() > 1) require_count(o.cards.size(), option_name("card"), settings.given, "picture");
    std::vector<MeasuredSetting> measured;
    for (const CardSetting &setting : settings.list) measured.emplace_back().of = setting;
    const auto count = static_cast<uint32_t>(measured.size());
    for_each_in_order(
        count, thread_count(threads),
        [&](uint32_t i) { measure(options_of(o, measured[i].of, settings.given), measured[i]); },
        [&](uint32_t i) { events.update_items("measuring settings", i + 1, count); });
    events.clear();
    if (std::all_of(measured.begin(), measured.end(),
                    [](const MeasuredSetting &s) { return s.status == LENSPROF_ERROR_ARGUMENT; }))
        throw Failure(LENSPROF_ERROR_ARGUMENT, measured.front().refusal);
    return measured;
}

void store_settings(const StoreOptions &o, std::vector<MeasuredSetting> &settings) {
    for (MeasuredSetting &setting : settings)
        if (setting.fit && setting.fit->profile && (setting.is_good() || o.force)) store_fit(o, *setting.fit);
}

}  // namespace lensprof
