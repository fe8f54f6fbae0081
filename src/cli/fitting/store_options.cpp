#include "cli/fitting/store_options.hpp"

#include "cli/page/page.hpp"
#include "cli/program/key_texts.hpp"
#include "photo/base/output_file.hpp"

namespace lensprof {

Choices<std::optional<uint32_t>> processing_choices() {
    return {{"raw", LENSPROF_PROCESSING_RAW},
            {"jpeg", LENSPROF_PROCESSING_JPEG},
            {"corrected", LENSPROF_PROCESSING_CORRECTED}};
}

Keys declare_store(Command &command, StoreOptions &o) {
    command.words(
        "--db", "FILE",
        [&o](const std::string &word) {
            o.dbs.push_back(word);
            o.db = o.dbs.front();
        },
        "profile database; repeat to read several, the profile is stored in the first; default lensprof/profiles.db "
        "in $XDG_DATA_HOME or ~/.local/share");
    command.flag("--no-store", o.no_store, "do not store the profile");
    command.text("--camera", o.camera, "camera model; default from EXIF");
    command.text("--lens", o.lens, "lens model; default from EXIF");
    command.number("--focal", o.focal, focal_lengths, "focal length, mm, such as 50 or 50mm; default from EXIF");
    command.number("--aperture", o.aperture, f_numbers, "f-number, such as 4 or f/4; default from EXIF");
    Command expert = command.expert();
    expert.flag("--force", o.force, "store the result even if it is not usable");
    Keys keys = expert.keys("--key", "what else the profile is for, instead of EXIF");
    keys.text("maker", o.maker, "camera maker");
    keys.text("unit", o.unit,
              "serial numbers of camera and lens, for a profile of this single unit; exif takes those of the picture; "
              "default none");
    keys.number("crop-factor", o.crop_factor, crop_factors,
                "43.27 mm divided by the sensor diagonal; default from EXIF or the table of cameras");
    keys.number("distance", o.distance, distances, "focus distance, m, such as 3 or 3m");
    keys.number("temperature", o.temperature, temperatures,
                "colour temperature of the light, K, if the falloff depends on it, such as 2850 or 2850K");
    keys.choice("processing", o.processing, processing_choices(),
                "processing of the pictures: raw, jpeg or corrected (falloff corrected in camera)");
    keys.text("style", o.style, "picture style, by the camera's name for it");
    return keys;
}

void check_store_options(const StoreOptions &o, bool reads_db, bool writes_other_files) {
    require_text_sizes(o.maker, o.camera, o.lens, o.unit, o.style);
    if (o.no_store && o.force && !writes_other_files)
        throw Failure(
            LENSPROF_ERROR_ARGUMENT,
            "--no-store and --force (store a result that is not usable) exclude each other; omit one of them");
    if (o.no_store && !reads_db && !o.db.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--db and --no-store exclude each other; omit one of them");
}

void check_report(const std::string &report, const std::vector<std::string> &inputs, const StoreOptions &o) {
    if (report.empty()) return;
    check_page_name(report);
    std::vector<std::string> reserved = inputs;
    if (!o.no_store) reserved.push_back(store_path(o.db));
    check_not_reserved(report, "report", reserved);
    check_output_file(report);
}

}  // namespace lensprof
