#include "cli/fitting/flat_units.hpp"

#include <nlohmann/json.hpp>

#include "cli/program/message.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"

namespace lensprof {
namespace {

std::shared_ptr<lensprof_profile> reference_of(const StoreOptions &o, int64_t id) {
    if (!id) return nullptr;
    Store store = open_store(o.db, LENSPROF_STORE_READ);
    std::shared_ptr<lensprof_profile> profile = new_profile();
    lensprof_error error{};
    check(lensprof_store_get(store.get(), id, profile.get(), &error), store_path(o.db), &error);
    return profile;
}

// Light that all units see alike cancels in their differences. A plane of each unit's own would take what a tilted lens
// does for a gradient of the light.
CardOptions options_of_units(const CardOptions &o) {
    CardOptions own = o;
    const bool is_turned = o.turned || !o.rotation_deg.empty();
    if (o.light == LENSPROF_FLAT_LIGHT_AUTO && !is_turned && !o.several) own.light = LENSPROF_FLAT_LIGHT_EVEN;
    return own;
}

void store_units(const CardOptions &o, UnitCards &cards) {
    for (UnitBatch &batch : cards.batches) {
        const size_t pass = batch.count(UnitVerdict::pass), fail = batch.count(UnitVerdict::fail);
        const bool is_good = pass > 0 && pass >= fail;  // else they may be of two types
        if (!batch.mean || cards.options.against || (!is_good && !o.store.force)) continue;
        const std::string &first = cards.setting_of(batch.units.front()).of.pictures.front().file;
        batch.profile_id = store_profile(o.store, *batch.mean, {"flat", first, is_good});
    }
    if (!cards.options.stores_each) return;
    for (const UnitBatch &batch : cards.batches)
        for (const UnitResult &unit : batch.units) {
            if (unit.verdict != UnitVerdict::pass) continue;
            MeasuredSetting &setting = cards.settings[unit.setting];
            set_text(setting.fit->profile->key.unit, sizeof setting.fit->profile->key.unit, setting.of.unit);
            store_fit(o.store, *setting.fit);
        }
}

// Names of units longer than the key's text would be stored as those of others.
void check_unit_names(const CardSettings &settings, const UnitOptions &o) {
    if (!o.stores_each) return;
    for (const CardSetting &setting : settings.list)
        if (setting.unit.size() >= sizeof setting.key.unit)
            throw Failure(LENSPROF_ERROR_ARGUMENT, "--units store: the name of unit " + setting.unit
                                                       + " is longer than the "
                                                       + std::to_string(sizeof setting.key.unit - 1)
                                                       + " bytes of a profile; give shorter names");
}

}  // namespace

int run_units(const UnitsCommand &o, const CardSettings &settings, Streams &streams) {
    check_unit_names(settings, o.units);
    check_store(o.cards.store);
    UnitCards cards;
    cards.options = o.units, cards.left_out = settings.left_out, cards.given = settings.given;
    cards.missing = settings.missing_units;
    const std::shared_ptr<lensprof_profile> reference = reference_of(o.cards.store, o.units.against);
    Progress progress(streams, o.progress);
    const CardOptions own = options_of_units(o.cards);
    cards.settings = measure_settings(own, settings, 0, progress);
    cards.batches = compare_units(cards.settings, o.units.limits, reference.get());
    OutputFiles outputs;
    for (const std::string &output : o.outputs) outputs.add(output, units_csv(cards));
    stop_if_cancelled();
    if (!o.cards.store.no_store) store_units(o.cards, cards);
    if (!o.report.empty()) outputs.add(o.report, units_page(cards, command_text(streams.words), streams.warnings));
    progress.clear();
    outputs.commit();
    if (o.json)
        print_json(units_json(cards), streams.out);
    else
        print_units(cards, o.cards.store.no_store ? std::string() : store_path(o.cards.store.db),
                    streams.verbosity != Verbosity::quiet, streams.out);
    return static_cast<int>(units_exit_code(cards));
}

}  // namespace lensprof
