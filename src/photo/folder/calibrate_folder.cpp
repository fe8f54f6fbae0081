#include "photo/folder/calibrate_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include <nlohmann/json.hpp>

#include "photo/base/input_file.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/deflicker/measure.hpp"
#include "photo/folder/ledger.hpp"
#include "photo/folder/sheet.hpp"
#include "photo/pictures/named_pictures.hpp"
#include "photo/registration/registration.hpp"
#include "photo/scene/photographs.hpp"

namespace lensprof {
namespace {

// Checks for files in the way of outputs before anything is computed.
void check_existing_files(const FolderOptions &o, const Inputs &inputs, const Ledger &ledger) {
    std::vector<std::string> outputs = sheet_names(o, inputs.pictures.size());
    outputs.insert(outputs.begin(), (std::filesystem::path(o.output) / summary_name).string());
    for (const InputPicture &picture : inputs.pictures) outputs.push_back(picture.target);
    for (const std::string &file : outputs) {
        if (is_folder(file)) throw Failure(LENSPROF_ERROR_ARGUMENT, file + ": is a folder; give another output folder");
        if (!o.overwrite && !ledger.contains(file) && ledger.is_foreign(file))
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          file + ": exists and was not written by calibrate; give another folder, or use "
                              + option_name("overwrite"));
    }
}

// Writes only if it has changed: a run that finds everything done changes nothing.
void write_summary(const FolderOptions &o, const Json &json, Ledger &ledger) {
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
void check_database(const FolderOptions &o) {
    if (o.store.db.empty() || !is_in_new_folder(o.store.db, o.output)) check_store(o.store);
}

Json summary_json(const FolderOptions &o, const Inputs &inputs, const Panoramas &panoramas,
                  const CorrectedPictures &pictures) {
    Json json = {{"schema", json_schema},
                 {"software", std::string("lensprof ") + lensprof_version()},
                 {"inputs", o.inputs},
                 {"found", inputs.found},
                 {"unreadable", inputs.unreadable}};
    json["panoramas"] = Json::array(), json["pictures"] = Json::array(), json["left_out"] = Json::array();
    for (const Panorama &panorama : panoramas.list) json["panoramas"].push_back(panorama.summary);
    for (const CorrectedPicture &picture : pictures.list) {
        Json entry = {{"file", picture.picture->file}, {"output", picture.picture->target}};
        entry["panorama"] = picture.panorama.empty() ? Json() : Json(picture.panorama);
        entry["ev"] = picture.ev ? Json(*picture.ev) : Json();
        if (picture.job.profile_id) entry["profile"] = picture.job.profile_id;
        if (picture.job.lookup) entry["lookup"] = lookup_json(*picture.job.lookup);
        json["pictures"].push_back(entry);
    }
    for (const LeftOutPicture &entry : all_left_out(inputs, pictures))
        json["left_out"].push_back({{"file", entry.file}, {"reason", entry.reason}});
    json["sheets"] = sheet_names(o, pictures.list.size());
    return json;
}

// A tripod is named before the pictures are registered, which takes long.
void note_still_camera(const Inputs &inputs, Events &events) {
    std::vector<Frame> frames;
    for (const InputPicture &picture : inputs.pictures) frames.push_back({picture.file, picture.metadata});
    if (shows_still_camera(frames, events)) events.note("", inputs.label + still_camera_reason());
}

}  // namespace

std::vector<LeftOutPicture> all_left_out(const Inputs &inputs, const CorrectedPictures &pictures) {
    std::vector<LeftOutPicture> all(inputs.left_out);
    all.insert(all.end(), pictures.left_out.begin(), pictures.left_out.end());
    std::stable_sort(all.begin(), all.end(), [](const auto &a, const auto &b) { return a.file < b.file; });
    return all;
}

FolderResult calibrate_folder(const FolderOptions &o, Events &events) {
    check_output_folder(o.output);
    check_database(o);
    FolderLock lock(o.output);
    FolderResult result;
    result.inputs = find_inputs(o.inputs, o.output, events);
    const Inputs &inputs = result.inputs;
    note_still_camera(inputs, events);
    if (has_ledger(o.output)) remove_stale_temporaries(o.output);
    Ledger ledger(o.output, o.overwrite);
    check_existing_files(o, inputs, ledger);
    if (inputs.pictures.empty() && inputs.unreadable)
        throw Failure(LENSPROF_ERROR_READ,
                      (inputs.found > 1 ? inputs.label + ": none of the pictures can be read; the first: " : "")
                          + inputs.left_out[0].reason);
    if (!can_register() && !inputs.pictures.empty()) register_pictures({inputs.pictures[0].file}, {}, false, events);
    make_folder(o.output);
    lock.acquire();
    try {
        result.panoramas = find_panoramas(o, inputs, ledger, events);
        remove_obsolete_panoramas(o, result.panoramas, ledger);
        fit_panoramas(o, result.panoramas, ledger, events);
    } catch (const Json::exception &) {  // somebody edited the records
        throw Failure(LENSPROF_ERROR_WRITE, (std::filesystem::path(o.output) / calibrate_records).string()
                                                + ": invalid records of earlier runs; remove this file and run again");
    }
    result.pictures = plan_corrections(o, inputs, result.panoramas);
    write_corrections(o, result.pictures, ledger, events);
    write_mosaics(result.panoramas, result.pictures, ledger, events);
    write_sheets(o, result.pictures, ledger, events);
    result.summary = summary_json(o, inputs, result.panoramas, result.pictures);
    write_summary(o, result.summary, ledger);
    result.is_stored = std::any_of(result.panoramas.list.begin(), result.panoramas.list.end(), [](const Panorama &p) {
        return p.summary["result"].is_object() && !p.summary["result"]["profile"].is_null();
    });
    return result;
}

std::string nothing_corrected(const FolderOptions &o, const Inputs &inputs) {
    return inputs.label + ": nothing could be corrected; see the reasons in "
           + (std::filesystem::path(o.output) / summary_name).string()
           + ", and where none is given, give pictures that overlap by a third, or a database that contains the lens";
}

}  // namespace lensprof
