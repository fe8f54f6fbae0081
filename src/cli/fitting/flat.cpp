// `lensprof flat`: measures the falloff on pictures of a white card or another even light and stores a profile.
#include "cli/fitting/flat.hpp"

#include <cmath>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "cli/fitting/fields.hpp"
#include "cli/fitting/fitting.hpp"
#include "cli/fitting/flat_units.hpp"
#include "cli/fitting/lens_report.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/exit_code.hpp"
#include "cli/program/level_words.hpp"
#include "cli/program/message.hpp"
#include "cli/program/numbers.hpp"
#include "cli/program/options.hpp"
#include "cli/program/progress.hpp"
#include "cli/program/run.hpp"
#include "photo/base/paths.hpp"
#include "photo/calibration/outcome.hpp"
#include "photo/cards/card_advice.hpp"
#include "photo/cards/lens_cards.hpp"

namespace lensprof {
namespace {

struct FlatCommand : CardOptions {
    std::vector<std::string> files;
    std::string report, bundle, into, table;  // files; empty: none
    std::vector<std::string> outputs, check;
    bool json = false, progress = false;
    bool fields = false;         // pictures of different scenes, not of a card
    uint32_t field_channel = 0;  // 0: not given
    SensorTables sensor_tables;
    UnitOptions compared_units;
};

std::array<double, 4> card_of(const std::string &word) {
    const std::vector<std::string> sides = split(word);
    if (sides.size() != 4) throw std::invalid_argument(word + ": not a rectangle X,Y,WIDTH,HEIGHT or find");
    std::array<double, 4> card;
    for (size_t i = 0; i < 4; i++) card[i] = number_of(sides[i], {0.0, 1e6});
    return card;
}

void declare_flat_fit(Command &command, FlatCommand &o) {
    Keys keys = command.expert().keys("--fit", "how the falloff is measured");
    keys.number("gamma", o.gamma, {0.1, 10.0}, "use the response x^(1/gamma)");
    keys.profile_id("profile", o.profile, "use the response of this profile of the database");
    keys.number("ev-sigma", o.ev_sigma, {0.001, 1.0},
                "standard error of an exposure, EV, with --several; default 0.02");
    keys.renamed("light", "--light");
    keys.flag("own-light", o.own_light, "estimate the light per shot, instead of one for all shots");
    keys.choice("falloff-curves", o.falloff_curves, {{"auto", 0}, {"1", 1}, {"3", 3}},
                "number of falloff curves: 1, 3 (one per channel) or auto (default: 3 if they clearly differ)");
    keys.choice("center", o.free_center, {{"free", true}, {"fixed", false}},
                "centre of the falloff: free (default) or fixed at the centre of the frame");
    keys.choice(
        "grid", o.grid,
        {{"auto", LENSPROF_FLAT_GRID_AUTO}, {"none", LENSPROF_FLAT_GRID_NONE}, {"always", LENSPROF_FLAT_GRID_ALWAYS}},
        "gain grid for what k1..k3 leave: auto (default: if 0.3 % or more remain, or for a deep falloff), none or "
        "always");
    keys.number("ignore-below", o.ignore_below, {0.0, 1.0},
                "ignore grey values below this, 0 to 1; default 2/255, or 0.2/255 of linear pictures of 16 bits "
                "or floats whose black level is known");
    keys.number("ignore-above", o.ignore_above, {0.0, 1.0}, "ignore grey values above this, 0 to 1; default 250/255");
    keys.word(
        "white-level", "LEVEL", [&o](const std::string &word) { o.levels.white = white_level_of(word); },
        "sample at saturation, as a value such as 4095 or a percentage; default full scale, which is 1 for float samples");
    keys.choice("tables", o.sensor_tables, {{"16x12", {16, 12}}, {"32x32", {32, 32}}},
                "with -o FILE.json: size of the tables, 16x12 (default) or 32x32, which a Raspberry Pi 5 reads");
    keys.count("channel", o.field_channel, 1, 1000, "with --fields: channel of stacks that have several, from 1");
    declare_max_side(keys, o.max_side);
}

void declare(Command &command, FlatCommand &o) {
    o.levels.black_option = "black", o.levels.white_option = "white_level";
    command.files("FILE", o.files, "pictures of the card, and folders of them: of one setting, or of all of a lens");
    command.require("FILE");
    command.flag(
        "--linear", o.linear,
        "the pictures are linear (developed from raw files without a tone curve); not needed for float TIFF or a "
        "colour profile with a linear tone curve");
    command.numbers("--rotation", o.rotation_deg, {-360.0, 360.0},
                    "rotation of the camera about its optical axis per shot, degrees, clockwise seen from the back of "
                    "the camera; separates the light from the lens (--turned takes it from EXIF); default 0");
    command.word(
        "--black", "LEVEL", [&o](const std::string &word) { o.levels.black = black_levels_of(word); },
        "sample without light, which is subtracted: a value such as 256, of float samples such as 0.06, a percentage "
        "such as 6%, or RED:GREEN:BLUE; --dark FILE measures it on pictures with the lens covered; default 0, or what "
        "exposures of one card show");
    command.words(
        "--check", "FILE", [&o](const std::string &word) { o.check.push_back(word); },
        "overlapping pictures of ordinary things, taken at a setting of the cards (folder, files or Hugin project): they "
        "show whether the light on the cards was even, and what was not is removed");
    command.words(
        "-o,--output", "FILE", [&o](const std::string &word) { o.outputs.push_back(word); },
        "write the lens: its good settings for Lensfun as .xml (--into adds them to a database of Lensfun), a table of "
        "all settings as .csv, or the shading of a sensor at its colour temperatures for the Raspberry Pi as .json; "
        "repeat for several");
    command.file("--report", o.report,
                 "write a report with charts as one .html file (--bundle: with all else for an upload)");
    Command expert = command.expert();
    expert.flag(
        "--fields", o.fields,
        "the pictures show different scenes under one shading, such as fields of a microscope: find the shading "
        "that all have in common, and their offset");
    expert.file("--bundle", o.bundle,
                "write report, numbers, the lens for Lensfun and reduced pictures as one .zip file, for an upload");
    expert.file(
        "--into", o.into,
        "database of Lensfun that the .xml file contains, too: the settings are added to its entry of the lens");
    expert.flag("--turned", o.turned,
                "the camera was rotated about its optical axis between the shots of a setting: by the orientation in "
                "EXIF, instead of --rotation");
    expert.counts("--shots", o.shots, 0, 1000000,
                  "shot number per picture, such as 1,1,1,2,2,2: exposures of one shot are merged; default one shot "
                  "per picture");
    expert.numbers("--ev", o.ev, any_number, "exposure per picture, EV, separated by commas; default from EXIF");
    expert.words(
        "--dark", "FILE", [&o](const std::string &word) { o.dark_files.push_back(word); },
        "picture with the lens covered, which gives the black level; repeat for several");
    expert.choice("--light", o.light,
                  {{"auto", LENSPROF_FLAT_LIGHT_AUTO},
                   {"even", LENSPROF_FLAT_LIGHT_EVEN},
                   {"plane", LENSPROF_FLAT_LIGHT_PLANE},
                   {"quadratic", LENSPROF_FLAT_LIGHT_QUADRATIC}},
                  "what the light on the card is taken to be: even, as in an integrating sphere; plane, which slopes; "
                  "quadratic, which is also bent; or auto (default: plane; even with --several or where it fits as "
                  "well; quadratic where shots at several angles show it)");
    expert.flag("--several", o.several,
                "the pictures show one card at several places of the frame, with constant brightness");
    expert.words(
        "--card", "X,Y,WIDTH,HEIGHT|find",
        [&o](const std::string &word) {
            if (word == "find")
                o.find_card = true;
            else
                o.cards.push_back(card_of(word));
        },
        "rectangle of the card, px of the frame: give once for all, or once per picture; find: find the card, which "
        "covers only a part of the frame; default the whole frame");
    declare_store(command, o.store)
        .file("table", o.table,
              "CSV file of the settings of pictures, instead of EXIF: a header of file, maker, camera, lens, focal, "
              "aperture, distance, temperature in any order, then a row per picture; names may have * and ?");
    declare_flat_fit(command, o);
    declare_units(command, o.compared_units);
    declare_json(command, o.json);
    declare_progress(command, o.progress);
}

bool is_lens_file(const std::string &output) { return lowercase_extension(output) == "xml"; }

bool is_sensor_file(const std::string &output) { return lowercase_extension(output) == "json"; }

bool wants_sensor_file(const FlatCommand &o) { return std::any_of(o.outputs.begin(), o.outputs.end(), is_sensor_file); }

bool wants_lens_file(const FlatCommand &o) { return std::any_of(o.outputs.begin(), o.outputs.end(), is_lens_file); }

// What concerns a lens as a whole, not units of it.
void check_unit_options(const FlatCommand &o) {
    const std::pair<bool, const char *> others[] = {{!o.check.empty(), "--check"},
                                                    {!o.bundle.empty(), "--bundle"},
                                                    {!o.into.empty(), "--into"},
                                                    {wants_lens_file(o), "-o FILE.xml"},
                                                    {wants_sensor_file(o), "-o FILE.json"},
                                                    {!o.store.unit.empty(), "--key unit"}};
    for (const auto &[is_given, name] : others)
        if (is_given)
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          std::string("--units and ") + name + " exclude each other; omit one");
    if (o.compared_units.stores_each && o.store.no_store)
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--units store and --no-store exclude each other; omit one of them");
}

// Before anything is read.
void check_options(const FlatCommand &o) {
    check_store_options(o.store, (!o.linear && !o.gamma) || o.compared_units.against);
    if (o.linear + o.gamma.has_value() + (o.profile != 0) > 1)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "give the response of the pictures with one of --linear, --fit gamma=G, --fit profile=ID");
    for (size_t i = 0; i < o.files.size(); i++)
        for (size_t j = 0; j < i; j++)
            if (is_same_file(o.files[i], o.files[j]))
                throw Failure(LENSPROF_ERROR_ARGUMENT, o.files[i] + ": given twice; give it once");
    if (o.ignore_below && !(*o.ignore_below < o.ignore_above))
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--fit ignore-below: must be less than ignore-above; give a smaller value");
    if (!o.dark_files.empty() && !o.levels.black.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--black and --dark exclude each other; give one of them");
    if (o.max_side != 0 && o.max_side < least_card_side)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--fit max-side: fewer than 64 pixels give too few cells; give more, or 0 for full size");
    if (o.several && (o.light == LENSPROF_FLAT_LIGHT_PLANE || o.light == LENSPROF_FLAT_LIGHT_QUADRATIC))
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--several: assumes even light on the card; omit --light");
    if (!o.into.empty() && o.outputs.empty() && o.bundle.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--into: needs -o FILE.xml, which receives the whole database");
    if (o.turned && !o.rotation_deg.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--turned and --rotation exclude each other; give one of them");
    if (o.compared_units.rule) check_unit_options(o);
    if (o.find_card && !o.cards.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--card find and a rectangle exclude each other; give one of them");
}

// The lens settings of the pictures, before anything is solved.
CardSettings settings_of(const FlatCommand &o, Events &events) {
    std::optional<SettingTable> table;
    if (!o.table.empty()) table.emplace(o.table);
    CardSettings settings = card_settings(o.files, o, table ? &*table : nullptr, events);
    if (table)
        for (const std::string &file : table->unused()) events.note(o.table, "no picture has the name " + file);
    return settings;
}

CardFit fit_or_report_failure(const FlatCommand &o, const CardSetting &setting, Streams &streams) {
    Progress progress(streams, o.progress);
    CardInput input = prepare_cards(o, setting.pictures, progress);
    check_report(o.report, o.files, o.store);
    check_store(o.store);
    try {
        return fit_cards(o, input, progress);
    } catch (const Failure &failure) {
        if (o.json && failure.group() == LENSPROF_ERROR_NOT_USABLE)
            print_json(flat_json(failed_fit(input, failure)), streams.out);
        throw;
    }
}

// All about the only setting.
int run_one(const FlatCommand &o, const CardSetting &setting, Streams &streams) {
    CardFit found = fit_or_report_failure(o, setting, streams);
    const std::string &first = found.files.front();
    const bool is_stored = found.fit.usable || o.store.force;
    stop_if_cancelled();
    OutputFiles outputs;
    if (!o.report.empty())
        outputs.add(o.report, flat_page(found, first, command_text(streams.words), streams.warnings));
    if (is_stored && !o.store.no_store) store_fit(o.store, found);
    outputs.commit();
    if (o.json)
        print_json(flat_json(found), streams.out);
    else
        print_flat(found, streams.verbosity != Verbosity::quiet, streams.out);
    if (found.profile_id && !o.json)
        streams.out << "stored    profile " << found.profile_id << " in " << store_path(o.store.db) << ": "
                    << describe_key(found.key) << "\n";
    Progress events(streams);
    if (found.fit.usable && o.json) report_findings(found.verdict, first, events);  // else they are in the table
    if (!found.fit.usable) print_message(streams, not_usable_text(first, found.verdict, o.store));
    return static_cast<int>(found.fit.usable ? ExitCode::done : ExitCode::not_usable);
}

// No output may replace an input, the database or another output.
void check_outputs(const FlatCommand &o, const CardSettings &settings) {
    std::vector<std::string> reserved = o.check;
    reserved.insert(reserved.end(), o.dark_files.begin(), o.dark_files.end());
    if (!o.table.empty()) reserved.push_back(o.table);
    for (const CardSetting &setting : settings.list)
        for (const CardPicture &picture : setting.pictures) reserved.push_back(picture.file);
    for (const LeftOutCard &card : settings.left_out) reserved.push_back(card.file);
    check_report(o.report, reserved, o.store);
    if (!o.store.no_store) reserved.push_back(store_path(o.store.db));
    if (!o.report.empty()) reserved.push_back(o.report);
    if (!o.bundle.empty()) {
        check_bundle(o.bundle);
        check_not_reserved(o.bundle, "bundle", reserved);
        reserved.push_back(o.bundle);
    }
    for (const std::string &output : o.outputs) {
        check_lens_output(output);
        check_not_reserved(output, "output", reserved);
        check_output_file(output);
        reserved.push_back(output);
    }
}

LensCards measured(const FlatCommand &o, const CardSettings &settings, Events &events) {
    LensCards cards;
    cards.settings = measure_settings(o, settings, 0, events);
    cards.left_out = settings.left_out, cards.given = settings.given;
    if (!o.check.empty()) {
        cards.light = check_light(o.check, o.linear, cards.settings, events);
        if (cards.light->finds_light()) cards.light_removed = remove_light(*cards.light, cards.settings);
    }
    cards.missing = missing_settings(cards.settings, largest_prediction_error);
    return cards;
}

// Without other outputs, what prevents the file is reported before the pictures are read.
bool is_lens_file_alone(const FlatCommand &o) {
    return !o.outputs.empty() && std::all_of(o.outputs.begin(), o.outputs.end(), is_lens_file) && o.report.empty()
           && o.bundle.empty();
}

// Makes the lens for Lensfun, as far as nothing prevents it, and warns of the outputs that therefore do not hold it.
void make_or_explain(const FlatCommand &o, LensCards &cards, bool is_lacking, Events &events) {
    try {
        if (!is_lacking) make_lens_file({o.store.dbs, o.into}, cards);
    } catch (const Failure &failure) {
        if (is_lens_file_alone(o) || !is_of_input(failure)) throw;
        cards.lens_file_obstacle = failure.what();
    }
    const std::string reason = cards.good() ? cards.lens_file_obstacle : "no setting is good";
    if (reason.empty()) return;
    for (const std::string &output : o.outputs)
        if (is_lens_file(output)) events.warn(output, "not written: " + reason);
    if (!o.bundle.empty() && cards.lens_file_text.empty()) events.warn(o.bundle, "has no lens.xml: " + reason);
}

// A line per setting.
int run_lens(const FlatCommand &o, const CardSettings &settings, Streams &streams) {
    check_outputs(o, settings);
    check_store(o.store);
    const bool has_lens_file = wants_lens_file(o) || !o.bundle.empty();
    const std::string lacking = has_lens_file ? lacking_for_lensfun(o.store, settings) : std::string();
    const std::string obstacle = lacking.empty() && wants_lens_file(o) ? several_for_lensfun(settings) : lacking;
    if (is_lens_file_alone(o) && !obstacle.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, o.outputs.front() + ": " + obstacle);
    if (const std::string several = wants_sensor_file(o) ? several_for_sensor(settings) : ""; !several.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      *std::find_if(o.outputs.begin(), o.outputs.end(), is_sensor_file) + ": " + several);
    Progress progress(streams, o.progress);
    progress.note("", counted_settings(settings) + (settings.list.size() > 1 ? ": each is measured alone" : ""));
    LensCards cards = measured(o, settings, progress);
    cards.lens_file_obstacle = obstacle;
    if (has_lens_file) make_or_explain(o, cards, !lacking.empty(), progress);
    if (wants_sensor_file(o)) make_sensor_file(o.sensor_tables, cards);
    OutputFiles outputs;
    for (const std::string &output : o.outputs) add_lens_output(output, cards, outputs);
    if (!o.bundle.empty()) add_bundle(o.bundle, cards, command_text(streams.words), progress, outputs);
    stop_if_cancelled();
    if (!o.store.no_store) store_settings(o.store, cards.settings);
    if (!o.report.empty()) outputs.add(o.report, lens_page(cards, command_text(streams.words), streams.warnings));
    progress.clear();
    outputs.commit();
    if (o.json)
        print_json(lens_json(cards), streams.out);
    else
        print_lens(cards, o.store.no_store ? std::string() : store_path(o.store.db),
                   streams.verbosity != Verbosity::quiet, streams.out);
    return static_cast<int>(lens_exit_code(cards));
}

// The first option that is for cards alone; NULL if none is given.
const char *card_option(const FlatCommand &o) {
    const CardOptions cards;  // the defaults
    const std::pair<bool, const char *> given[] = {{!o.rotation_deg.empty(), "--rotation"},
                                                   {o.turned, "--turned"},
                                                   {!o.shots.empty(), "--shots"},
                                                   {!o.ev.empty(), "--ev"},
                                                   {o.several, "--several"},
                                                   {o.find_card || !o.cards.empty(), "--card"},
                                                   {!o.check.empty(), "--check"},
                                                   {!o.bundle.empty(), "--bundle"},
                                                   {!o.into.empty(), "--into"},
                                                   {o.compared_units.rule.has_value(), "--units"},
                                                   {!o.table.empty(), "--key table"},
                                                   {o.ignore_below != cards.ignore_below, "--fit ignore-below"},
                                                   {o.ignore_above != cards.ignore_above, "--fit ignore-above"},
                                                   {o.max_side != cards.max_side, "--fit max-side"},
                                                   {o.light != cards.light, "--light"},
                                                   {o.own_light, "--fit own-light"},
                                                   {o.grid != cards.grid, "--fit grid"},
                                                   {!o.free_center, "--fit center"},
                                                   {o.falloff_curves != 0, "--fit falloff-curves"}};
    for (const auto &[is_given, name] : given)
        if (is_given) return name;
    return nullptr;
}

int run_fields(const FlatCommand &o, Streams &streams) {
    if (const char *name = card_option(o))
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      std::string(name) + ": is for pictures of a card, not for --fields; omit one of them");
    FieldsCommand command;
    command.files = o.files, command.outputs = o.outputs, command.report = o.report;
    command.json = o.json, command.progress = o.progress;
    command.fit.store = o.store, command.fit.profile = o.profile, command.fit.gamma = o.gamma;
    command.fit.linear = o.linear, command.fit.levels = o.levels, command.fit.channel = o.field_channel;
    command.dark_files = o.dark_files;
    return fit_fields_command(command, streams);
}

int run(FlatCommand o, Streams &streams) {
    check_options(o);
    if (o.fields) return run_fields(o, streams);
    if (o.field_channel) throw Failure(LENSPROF_ERROR_ARGUMENT, "--fit channel: is for --fields; give it as well");
    Progress events(streams, o.progress);
    o.units = o.compared_units.rule;
    if (!o.dark_files.empty()) {
        o.dark = dark_level(o.dark_files, o.max_side, 0, events);
        refuse_dark_cards(o.files, o, *o.dark);
    }
    const CardSettings settings = settings_of(o, events);
    if (o.compared_units.rule) {
        check_outputs(o, settings);
        return run_units({o, o.compared_units, o.outputs, o.report, o.json, o.progress}, settings, streams);
    }
    const bool is_one = settings.list.size() == 1 && !settings.has_folders && settings.left_out.empty();
    if (is_one && o.outputs.empty() && o.bundle.empty() && o.check.empty())
        return run_one(o, settings.list.front(), streams);
    return run_lens(o, settings, streams);
}

}  // namespace

void declare_flat(Command &program) {
    Command command = program.add(
        "flat", "measure a lens profile on pictures of a white card",
        "Measures the falloff from pictures of a white card or another even light; see docs/flat.md for how to take "
        "them.");
    auto o = std::make_shared<FlatCommand>();
    declare(command, *o);
    command.footer(
        "Pictures are grouped by camera, lens, focal length, aperture, distance and colour temperature, as\n"
        "EXIF or their names state them, and every setting is measured alone; of several settings, or a\n"
        "folder, a table has a line for each. Exit code 0: all are good; 4: some must be taken again, a unit\n"
        "does not pass, or something is missing for the file for Lensfun; 3: files could not be read.\n"
        "With --fields, pictures of anything, such as fields of a microscope, give the shading that all\n"
        "have in common; see docs/fields.md.");
    command.example("lensprof flat cards -o lens.xml --report lens.html");
    command.example("lensprof flat line --linear --units by=folder -o units.csv --report line.html");
    command.example("lensprof flat --fields slides --camera Orca --lens \"10x 0.30\" -o shading.tif");
    command.run([o](Streams &streams) { return run(*o, streams); });
}

}  // namespace lensprof
