#include "cli/fitting/fitting.hpp"

#include <algorithm>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "cli/fitting/fit_page.hpp"
#include "cli/program/exit_code.hpp"
#include "cli/program/message.hpp"
#include "cli/program/options.hpp"
#include "cli/program/progress.hpp"
#include "cli/report/findings.hpp"
#include "photo/base/events.hpp"
#include "photo/base/format.hpp"
#include "photo/calibration/outcome.hpp"

namespace lensprof {
namespace {

void declare_method(Keys &keys, FitOptions &o) {
    keys.choice("method", o.method,
                {{"transfer", LENSPROF_METHOD_TRANSFER},
                 {"radiance", LENSPROF_METHOD_RADIANCE},
                 {"transfer-function", LENSPROF_METHOD_TRANSFER_FUNCTION}},
                "transfer (d'Angelo 2007, default), radiance (Goldman & Chen 2005: one radiance per scene point, seen "
                "by any number of pictures, saturated ones included) or transfer-function (Kim & Pollefeys 2004)");
}

Choices<std::optional<uint32_t>> camera_kind_choices() {
    Choices<std::optional<uint32_t>> choices{{"auto", std::nullopt}};
    for (uint32_t kind = LENSPROF_CAMERA_ANY; kind <= LENSPROF_CAMERA_LINEAR; kind++)
        choices.emplace_back(camera_kind_name(kind), kind);
    return choices;
}

void declare_prior(Keys &keys, FitOptions &o, bool may_be_stored) {
    keys.number("prior", o.prior_weight, {0.0, 1e6},
                std::string("weight of the priors") + (may_be_stored ? ", stored ones included" : "")
                    + "; default 1; 0 = none, as in the paper");
    if (!may_be_stored) return;
    keys.word(
        "stored", "auto|none|ID",
        [&o](const std::string &word) {
            o.stored = word != "none";
            o.stored_is_requested = o.stored;
            o.stored_id = !o.stored || word == "auto" ? 0 : profile_id_of(word);
        },
        "prior from the databases: auto (default), the profile stored for this lens and setting, else the known "
        "falloff of the lens and response of the camera; ID, a profile; none");
}

void declare_gamma(Keys &keys, FitOptions &o, bool known_response) {
    Choices<uint32_t> gamma = {
        {"auto", LENSPROF_GAMMA_AUTO}, {"exif", LENSPROF_GAMMA_EXPOSURES}, {"prior", LENSPROF_GAMMA_PRIOR}};
    std::string about =
        "source of the common exponent of exposure, falloff and response: auto (default: differing EXIF exposures and "
        "the prior, weighted by standard error), exif, prior";
    if (known_response) {
        gamma.emplace_back("known", LENSPROF_GAMMA_KNOWN);
        about += ", known (the project's response)";
    }
    keys.choice("gamma-from", o.gamma_from, gamma, about);
}

}  // namespace

Keys declare_fit(Command &command, FitOptions &o, FitChoices choices) {
    Keys keys = command.expert().keys("--fit", "how the pictures are fitted");
    declare_method(keys, o);
    const auto read_modes = [&o](const std::string &word) {
        o.modes = word == "auto" ? LENSPROF_MODES_AUTO : count_of(word, 0, LENSPROF_EMOR_MODES);
    };
    keys.word("modes", "COUNT|auto", read_modes,
              "number of EMoR modes of the response, 0 to 25, or auto (default: chosen by held-out error)");
    keys.choice("loss", o.loss,
                {{"robust", LENSPROF_LOSS_ROBUST}, {"huber", LENSPROF_LOSS_HUBER}, {"squared", LENSPROF_LOSS_SQUARED}},
                "loss function: robust (default), huber (as in the paper) or squared");
    keys.number("huber", o.huber, {0.01, 255.0}, "sigma of the Huber loss, levels of 255; default 5");
    declare_prior(keys, o, choices.stored_prior);
    declare_gamma(keys, o, choices.known_response);
    keys.number("exif-sigma", o.exif_sigma, {0.0, 10.0},
                "standard error of EXIF exposures, EV; default 0.1, or 0.03 for pictures at one manual exposure; 0 = "
                "ignore EXIF exposures");
    keys.choice("camera-kind", o.camera_kind, camera_kind_choices(),
                "kind of camera that the prior describes: camera or phone (today's JPEG), digital (of the 1990s), film "
                "(scanned), linear (the response is fixed as linear), any, or auto (default: according to EXIF)");
    return keys;
}

void declare_sampling(Keys &keys, SamplingOptions &o, const std::string &default_pairs) {
    keys.count("pairs", o.pairs, 0, 1 << 24, "number of pairs; default 0 = " + default_pairs);
    keys.count("seed", o.seed, 0, UINT32_MAX, "seed of the sampling; default 1");
    declare_max_side(keys, o.max_side);
}

void declare_max_side(Keys &keys, uint32_t &max_side) {
    keys.count("max-side", max_side, 0, UINT32_MAX,
               format("read pictures reduced to at least this many pixels on the longer side; default %u; 0 = full "
                      "size",
                      max_side));
}

void check_fit_options(const FitOptions &o) {
    if (o.stored_is_requested && !uses_stored_prior(o))
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--fit stored: needs --fit method=transfer or radiance, and a prior above 0");
    if (o.gamma_from == LENSPROF_GAMMA_EXPOSURES && o.exif_sigma == 0.0)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--fit gamma-from=exif and exif-sigma=0 (ignore EXIF) exclude each other; omit one of them");
}

namespace {

// Prints where profiles were stored.
void print_stored(const BuildReport &report, const lensprof_profile_key &key, const StoreOptions &store,
                  std::ostream &out) {
    const auto print = [&](int64_t id, const lensprof_profile_key &stored_key) {
        if (id)
            out << "stored    profile " << id << " in " << store_path(store.db) << ": " << describe_key(stored_key)
                << "\n";
    };
    if (report.settings.empty()) print(report.profile_id, key);
    for (const SettingReport &setting : report.settings) print(setting.profile_id, setting.key);
}

}  // namespace

int finish_fit(BuildReport &report, const lensprof_profile_key &key, const StoreOptions &store, const Finish &finish,
               Streams &streams) {
    stop_if_cancelled();
    if (!store.no_store) store_result(report, key, store, {finish.method, finish.source, finish.prior});
    const Outcome outcome = outcome_of(report, store, finish.source, finish.equalizes_pictures);
    std::vector<std::string> warnings = streams.warnings;
    for (const Notice &notice : outcome.notices.list)
        if (notice.severity == LENSPROF_SEVERITY_WARNING) warnings.push_back(notice.line());
    if (!finish.report.empty()) finish.outputs->add(finish.report, fit_page(std::move(*finish.page), report, warnings));
    if (finish.outputs) finish.outputs->commit();
    if (finish.json)
        print_json(build_json(report), streams.out);
    else
        print_build(report, streams.out);
    if (!finish.json) print_stored(report, key, store, streams.out);
    Progress events(streams);
    for (const Notice &notice : outcome.notices.list) events.notice(notice.severity, notice.item, notice.text);
    if (!outcome.is_good) print_message(streams, outcome.refusal);
    return static_cast<int>(outcome.is_good ? ExitCode::done : ExitCode::not_usable);
}

void check_max_side(uint32_t max_side) {
    if (max_side != 0 && max_side < 64)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--fit max-side: fewer than 64 pixels give too few samples; give more, or 0 for full size");
}

}  // namespace lensprof
