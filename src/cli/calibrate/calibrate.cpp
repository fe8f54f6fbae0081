// `lensprof calibrate`: finds panoramas, stores profiles, and writes corrected copies and a report into one folder.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <sstream>

#include "cli/calibrate/corrections.hpp"
#include "cli/calibrate/folder_page.hpp"
#include "cli/calibrate/inputs.hpp"
#include "cli/calibrate/ledger.hpp"
#include "cli/calibrate/panoramas.hpp"
#include "cli/calibrate/sheet.hpp"
#include "cli/calibrate/summary.hpp"
#include "cli/page/page.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/exit_code.hpp"
#include "cli/program/message.hpp"
#include "cli/program/options.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/pictures/named_pictures.hpp"
#include "photo/registration/registration.hpp"

namespace lensprof {
namespace {

void declare(Command &command, CalibrateOptions &o) {
    command.files("FILE", o.inputs, "pictures and folders of pictures (with subfolders)");
    command.require("FILE");
    command.folder("-o,--output", o.output, "output folder");
    command.require("--output");
    command.words(
        "--db", "FILE",
        [&o](const std::string &word) {
            o.store.dbs.push_back(word);
            o.store.db = o.store.dbs.front();
        },
        "profile database; repeat to read several, profiles are stored in the first; default lensprof/profiles.db in "
        "$XDG_DATA_HOME or ~/.local/share");
    command.flag("--no-store", o.store.no_store, "do not store profiles");
    command.flag("--one-lens", o.one_lens,
                 "treat the pictures of a panorama as from one camera and lens, regardless "
                 "of their EXIF");
    command.flag("--overwrite", o.overwrite, "replace files in the output folder that calibrate did not write");
    command.file("--report", o.report,
                 "write a web page with the pictures before and after, charts and reasons: an .html file");
    command.count("--threads", o.threads, 0, 1024, "number of threads that correct pictures; default 0 = all cores");
    declare_json(command, o.json);
    declare_progress(command, o.progress);
    command.footer(
        "Finds all panoramas in the folder, fits them, stores their profiles if usable, and corrects them.\n"
        "Other pictures are corrected with a profile of the databases for their camera, lens and setting, if\n"
        "there is one. The output folder receives a corrected copy of each picture under its own name; per\n"
        "panorama a project (panorama_NAME.pto, for Hugin) and a mosaic before and after\n"
        "(panorama_NAME.jpg); a contact sheet (calibrate_sheet.jpg); and calibrate.json with all numbers and\n"
        "reasons. A second run does only what is missing or has changed, also after an interrupt. Originals\n"
        "are never modified. Exit code 0: something was corrected, and the rest is listed; 4: nothing could\n"
        "be corrected; 3: no picture could be read.");
    command.example("lensprof calibrate holiday -o holiday/calibrated");
}

// Checks for files in the way of outputs before anything is computed.
void check_existing_files(const CalibrateOptions &o, const Inputs &inputs, const Ledger &ledger) {
    std::vector<std::string> outputs = sheet_names(o, inputs.pictures.size());
    outputs.insert(outputs.begin(), (std::filesystem::path(o.output) / summary_name).string());
    for (const InputPicture &picture : inputs.pictures) outputs.push_back(picture.target);
    for (const std::string &file : outputs) {
        if (is_folder(file))
            throw Failure(LENSPROF_ERROR_ARGUMENT, file + ": is a folder; give another output folder with -o");
        if (!o.overwrite && !ledger.contains(file) && ledger.is_foreign(file))
            throw Failure(LENSPROF_ERROR_ARGUMENT, file + ": exists and was not written by calibrate; give another folder "
                                                  "with -o, or use --overwrite");
    }
}

// Writes only if it has changed: a run that finds everything done changes nothing.
void write_summary(const CalibrateOptions &o, const Json &json, Ledger &ledger) {
    const std::string file = (std::filesystem::path(o.output) / summary_name).string();
    std::ostringstream text;
    print_json(json, text);
    const std::string key = digest_of_text(text.str());
    if (!ledger.is_current(file, key)) {
        ledger.begin(file, key);
        ledger.save();
        write_file(file, text.str().data(), text.str().size());
        ledger.finish(file);
    }
    ledger.save();
}

// A database in the output folder needs no check before the folder is created.
void check_database(const CalibrateOptions &o) {
    if (o.store.db.empty() || !is_in_new_folder(o.store.db, o.output)) check_store(o.store);
}

// Failure for a report that cannot be written, before anything is computed.
void check_report(const CalibrateOptions &o) {
    if (o.report.empty()) return;
    check_page_name(o.report);
    check_not_reserved(o.report, "report", {store_path(o.store.db)});
    if ((canonical_path(o.output) + "/").rfind(canonical_path(o.report) + "/", 0) == 0)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      o.report + ": the output folder has this name; give the report another one");
    if (is_too_long(o.report))
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      short_name(o.report) + ": the name is too long; give the report a shorter one");
    if (!is_in_new_folder(o.report, o.output)) check_output_file(o.report);
}

int run(const CalibrateOptions &o, Streams &streams) {
    Progress progress(streams, o.progress);
    check_report(o);
    check_output_folder(o.output);
    check_database(o);
    FolderLock lock(o.output);
    const Inputs inputs = find_inputs(o.inputs, o.output, progress);
    if (has_ledger(o.output)) remove_stale_temporaries(o.output);
    Ledger ledger(o.output, o.overwrite);
    check_existing_files(o, inputs, ledger);
    if (inputs.pictures.empty() && inputs.unreadable)
        throw Failure(LENSPROF_ERROR_READ,
                      (inputs.found > 1 ? inputs.label + ": none of the pictures can be read; the first: " : "")
                          + inputs.left_out[0].reason);
    if (!can_register() && !inputs.pictures.empty()) register_pictures({inputs.pictures[0].file}, false, progress);
    make_folder(o.output);
    lock.acquire();
    Panoramas panoramas;
    try {
        panoramas = find_panoramas(o, inputs, ledger, progress);
        remove_obsolete_panoramas(o, panoramas, ledger);
        fit_panoramas(o, panoramas, ledger, progress);
    } catch (const Json::exception &) {  // somebody edited the records
        throw Failure(LENSPROF_ERROR_WRITE, (std::filesystem::path(o.output) / calibrate_records).string()
                                                + ": invalid records of earlier runs; remove this file and run again");
    }
    CorrectedPictures pictures = plan_corrections(o, inputs, panoramas);
    write_corrections(o, pictures, ledger, progress);
    write_sheets(o, pictures, ledger, progress);
    progress.clear();
    Json json = summary_json(o, inputs, panoramas, pictures);
    write_summary(o, json, ledger);
    if (!o.report.empty()) {
        const std::string page = folder_page(inputs, panoramas, pictures, json, command_text(streams.words), progress);
        write_file(o.report, page.data(), page.size());
    }
    if (o.json) {
        json["now"] = {
            {"registered", panoramas.is_registered}, {"fitted", panoramas.fitted}, {"corrected", pictures.written}};
        print_json(json, streams.out);
    } else {
        print_summary(o, inputs, panoramas, pictures, streams.out);
    }
    const bool is_stored = std::any_of(panoramas.list.begin(), panoramas.list.end(), [](const Panorama &p) {
        return p.summary["result"].is_object() && !p.summary["result"]["profile"].is_null();
    });
    if (!pictures.list.empty() || is_stored) return static_cast<int>(ExitCode::done);
    print_message(streams, inputs.label + ": nothing could be corrected; see the reasons in "
                               + (std::filesystem::path(o.output) / summary_name).string()
                               + ", and where none is given, give pictures that overlap by a third, or a database "
                                 "that contains the lens");
    return static_cast<int>(ExitCode::not_usable);
}

}  // namespace

void declare_calibrate(Command &program) {
    Command command = program.add("calibrate", "calibrate and correct all pictures of a folder",
                                  "Finds overlaps, fits and stores profiles, corrects the pictures and writes a "
                                  "contact sheet.");
    auto o = std::make_shared<CalibrateOptions>();
    declare(command, *o);
    command.run([o](Streams &streams) { return run(*o, streams); });
}

}  // namespace lensprof
