#include "cli/program/option_names.hpp"

#include <map>

namespace lensprof {

std::string option_of(const std::string &name) {
    static const std::map<std::string, std::string> options = {
        {"aperture", "--aperture"},
        {"black", "--black"},
        {"black_level", "--fit black-level=LEVEL"},
        {"camera", "--camera"},
        {"camera_kind_linear", "--fit camera-kind=linear"},
        {"card", "--card"},
        {"crop_factor", "--key crop-factor=NUMBER"},
        {"dark", "--dark"},
        {"databases", "--db FILE"},
        {"distance", "--key distance"},
        {"doubtful", "`lensprof apply --key doubtful=yes`"},
        {"ev", "--ev"},
        {"exposure_keep", "--set exposure=keep"},
        {"falloff_curves", "--fit falloff-curves"},
        {"field_channel", "--fit channel"},
        {"focal", "--focal"},
        {"free_all", "--fit free=all"},
        {"gamma", "--fit gamma=G"},
        {"ignore_below", "--fit ignore-below"},
        {"image_list", "--reconstruction list=FILE"},
        {"images", "--images"},
        {"lens", "--lens"},
        {"light", "--light"},
        {"linear", "--linear"},
        {"maker", "--key maker"},
        {"max_side", "--fit max-side"},
        {"method_transfer_function", "--fit method=transfer-function"},
        {"no_store", "--no-store"},
        {"one_lens", "--one-lens"},
        {"overwrite", "--overwrite"},
        {"processing", "--key processing"},
        {"own_light", "--fit own-light=yes"},
        {"profile", "--profile"},
        {"response", "--set response"},
        {"response_profile", "--fit profile=ID"},
        {"rotation", "--rotation"},
        {"sampling_paper", "--fit sampling=paper"},
        {"shots", "--shots"},
        {"shard", "--reconstruction shard"},
        {"stored", "--fit stored"},
        {"style", "--key style"},
        {"temperature", "--key temperature"},
        {"track_colours", "--reconstruction track-colors"},
        {"turned", "--turned"},
        {"unit", "--key unit"},
        {"units_against", "--units against=ID"},
        {"units_by", "--units by=folder or by=serial"},
        {"units_by_name", "--units by=cam_{unit}_*"},
        {"unit_text", "--key unit=TEXT"},
        {"white_level", "--fit white-level=LEVEL"},
    };
    const auto found = options.find(name);
    return found == options.end() ? name : found->second;
}

std::string advice_for(const std::string &situation) {
    static const std::map<std::string, std::string> advice = {
        {"accept", "; it does correct these pictures: use --no-store to accept it"},
        {"apply", "lensprof apply"},
        {"apply_database", " --db"},
        {"apply_project", "lensprof apply --pto"},
        {"build_project", "; use `lensprof build` for a project"},
        {"card", "; measure the falloff with `lensprof flat`"},
        {"exif_used", " (--fit exif-sigma=0 ignores EXIF)"},
        {"exposure_file_wanted", ", or give the file that `lensprof build --write exposures=FILE` wrote"},
        {"exposure_of_options", "; it is that of --ev or --times"},
        {"exposures_given", "; give it to `apply --model`"},
        {"force", " (use --force to store it anyway)"},
        {"force_falloff", "; use --set force-falloff=yes to correct it anyway"},
        {"free_parameters", " (use --fit free=... to change this)"},
        {"fixed_balance", " (Er and Eb on the v lines, or --fit free=all)"},
        {"linear_pictures", "; correct such pictures with `lensprof apply --key processing=raw`"},
        {"make_profile", " with `lensprof build`"},
        {"moving_camera",
         "; use `lensprof calibrate FOLDER --moving` for frames of a moving camera, --rows for lamps that flicker, or "
         "give a part that stands still with --region"},
        {"moving_frames",
         "those of `lensprof calibrate FOLDER --moving`, which measures both for a moving camera. If it stands still, and "
         "clouds or people move, compare a part that stands still with --region"},
        {"name_pictures", "; run `lensprof build` on the pictures with --camera and --lens"},
        {"name_project", "; run `lensprof build` on the project with --camera and --lens"},
        {"no_profile", "; see `lensprof profile list`"},
        {"one_lens", " (use --one-lens to treat all as one)"},
        {"one_visit", ", with --reconstruction list=FILE"},
        {"output", " with -o"},
        {"photographs", "; of ordinary pictures that overlap, use `lensprof build` or `lensprof calibrate`"},
        {"prior_alone", " Use --fit stored=none to fit them alone"},
        {"prior_given", ", or --fit stored=none to fit the pictures alone"},
        {"several_cards", ". If they show different scenes, use `lensprof flat --fields`"},
        {"still_camera",
         "; use `lensprof bracket` for its response, `lensprof align` to match or merge the pictures, `lensprof "
         "deflicker` to level a timelapse. "
         "Both need plain exposures, without HDR"},
        {"still_group", "; use `lensprof bracket`, `lensprof align` or `lensprof deflicker` for it"},
    };
    const auto found = advice.find(situation);
    return found == advice.end() ? std::string() : found->second;
}

}  // namespace lensprof
