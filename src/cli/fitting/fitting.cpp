#include "cli/fitting/fitting.hpp"

#include <algorithm>
#include <cmath>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/fitting/project.hpp"
#include "cli/program/interrupt.hpp"
#include "cli/program/options.hpp"

namespace lensprof {
namespace {

uint32_t modes_of(const std::string &text) {
    if (text == "auto") return LENSPROF_MODES_AUTO;
    size_t used = 0;
    int value = -1;
    try {
        value = std::stoi(text, &used);
    } catch (const std::exception &) {
    }
    if (used != text.size() || value < 0 || value > LENSPROF_EMOR_MODES)
        throw Failure(ExitCode::usage, "--modes " + text + ": give 0..25 or auto");
    return static_cast<uint32_t>(value);
}

uint32_t method_of_name(const std::string &name) {
    return name == "radiance"            ? LENSPROF_METHOD_RADIANCE
           : name == "transfer-function" ? LENSPROF_METHOD_TRANSFER_FUNCTION
           : name == "debevec"           ? LENSPROF_METHOD_DEBEVEC
                                         : LENSPROF_METHOD_TRANSFER;
}

// --prior as a weight; -1 for what is none.
double prior_weight_of(const std::string &text) {
    size_t used = 0;
    double value = -1.0;
    try {
        value = std::stod(text, &used);
    } catch (const std::exception &) {
    }
    return used == text.size() && value >= 0.0 && value <= 1e6 ? value : -1.0;
}

// What --prior may be.
CLI::Validator is_prior(bool may_be_stored) {
    return {[may_be_stored](std::string &text) {
                if (prior_weight_of(text) >= 0.0 || (may_be_stored && text == "auto")) return std::string();
                return text + ": give a weight, 0 to 1000000" + (may_be_stored ? ", or auto" : "");
            },
            may_be_stored ? "WEIGHT|auto" : "WEIGHT"};
}

int on_progress(double done, void *progress) {
    static_cast<Progress *>(progress)->update("fitting", done);
    return interrupted();
}

// Of counts, which do not run over.
uint32_t sum_of(uint32_t a, uint32_t b) { return a + std::min(b, UINT32_MAX - a); }

}  // namespace

void declare_fit(CLI::App &app, FitOptions &o, FitChoices choices) {
    std::vector<std::string> methods = {"transfer", "radiance", "transfer-function"};
    std::vector<std::string> gamma = {"auto", "exif", "prior"};
    std::string about =
        "transfer (d'Angelo 2007), radiance (Goldman & Chen 2005: one radiance a scene point, which any "
        "number of pictures may see, saturated ones among them) or transfer-function (Kim & Pollefeys "
        "2004)";
    if (choices.debevec) {
        methods.push_back("debevec");
        about += "; debevec (Debevec & Malik 1997), a reference: known exposures taken as exact, white balances fixed";
    }
    std::string settles =
        "what settles the common exponent of exposure, falloff and response: auto (EXIF exposures that "
        "differ, and the prior, each by its standard error), exif, prior";
    if (choices.known_response) {
        gamma.push_back("known");
        settles += ", known (the project's response)";
    }
    app.add_option("--method", o.method, about)->check(CLI::IsMember(methods));
    app.add_option("--modes", o.modes, "EMoR modes of the response: 0..25 or auto (held-out error decides)");
    app.add_option("--loss", o.loss, "robust, huber (the paper's) or squared")
        ->check(CLI::IsMember({"robust", "huber", "squared"}));
    app.add_option("--huber", o.huber, "sigma of the Huber loss, levels of 255")->check(in_range(0.01, 255.0));
    std::string weighs = "weight of the priors; 0 = none, as in the paper";
    if (choices.stored_prior)
        weighs +=
            "; auto: the profile that is stored for this lens and setting is the prior, and what is stored holds "
            "both";
    app.add_option("--prior", o.prior, weighs)->check(is_prior(choices.stored_prior));
    app.add_option("--gamma-from", o.gamma_from, settles)->check(CLI::IsMember(gamma));
    app.add_option("--exif-sigma", o.exif_sigma, "standard error of an EXIF exposure, EV; 0 = do not use them")
        ->check(in_range(0.0, 10.0));
    app.add_option("--camera-kind", o.camera_kind, "whose responses the prior is of: any, film or digital")
        ->check(CLI::IsMember({"any", "film", "digital"}));
}

void check_fit_options(const FitOptions &o) {
    if (o.wants_stored_prior() && o.method != "transfer" && o.method != "radiance")
        throw Failure(ExitCode::usage, "--prior auto: is for the methods transfer and radiance; give a weight");
    if (o.gamma_from == "exif" && o.exif_sigma == 0.0)
        throw Failure(ExitCode::usage,
                      "--gamma-from exif and --exif-sigma 0, which leaves EXIF out, contradict each other");
}

lensprof_fit_options fit_options(const FitOptions &o) {
    lensprof_fit_options options;
    lensprof_fit_options_init(&options);
    options.method = method_of_name(o.method);
    options.modes = modes_of(o.modes);
    options.loss = o.loss == "huber"     ? LENSPROF_LOSS_HUBER
                   : o.loss == "squared" ? LENSPROF_LOSS_SQUARED
                                         : LENSPROF_LOSS_ROBUST;
    options.gamma_from = o.gamma_from == "exif"    ? LENSPROF_GAMMA_EXPOSURES
                         : o.gamma_from == "prior" ? LENSPROF_GAMMA_PRIOR
                                                   : LENSPROF_GAMMA_AUTO;
    if (o.gamma_from == "known") options.free &= ~LENSPROF_FREE_RESPONSE;
    options.camera_kind = camera_kind_of_name(o.camera_kind);
    options.huber_levels = o.huber;
    options.prior_weight = o.wants_stored_prior() ? 1.0 : prior_weight_of(o.prior);
    return options;
}

void add_known_exposures(const FitOptions &o, const std::vector<std::string> &files,
                         const std::vector<PictureMetadata> &metadata, std::vector<lensprof_fit_image> &images,
                         Streams &streams) {
    constexpr double farthest = 40.0;  // EV from 1 s, f/1, ISO 100: no picture was ever taken there
    for (size_t i = 0; i < images.size() && o.exif_sigma > 0.0; i++) {
        if (!metadata[i].exif_ev) continue;
        if (!(std::fabs(*metadata[i].exif_ev) < farthest)) {
            streams.err << "lensprof: warning: " << files[i]
                        << ": time, aperture and ISO in its EXIF cannot be true and are not used\n";
            continue;
        }
        images[i].known_ev = *metadata[i].exif_ev;
        images[i].known_ev_sigma = std::max(o.exif_sigma, 1e-3);
    }
}

Fitted fit(FitInput &input, uint32_t reference, const std::string &item, Progress &progress,
           std::vector<lensprof_fit_image_quality> *quality) {
    Fitted fitted;
    auto count = static_cast<uint32_t>(input.images.size());
    fitted.exposures.resize(count);
    lensprof_fit_result_init(&fitted.result);
    if (quality) {
        quality->resize(count);
        fitted.result.image_quality = quality->data();
    }
    input.options.progress = on_progress;
    input.options.progress_user = &progress;
    lensprof_error error{};
    const auto *images = input.images.data();
    auto pairs = static_cast<uint32_t>(input.pairs.size()), tracked = static_cast<uint32_t>(input.observations.size());
    lensprof_status status = tracked ? lensprof_fit_radiance(&input.options, images, count, input.observations.data(),
                                                             tracked, fitted.exposures.data(), &fitted.result, &error)
                                     : lensprof_fit_overlap(&input.options, images, count, input.pairs.data(), pairs,
                                                            fitted.exposures.data(), &fitted.result, &error);
    stop_if_interrupted();
    if (status == LENSPROF_ERROR_NO_UNKNOWNS)
        throw Failure(ExitCode::usage,
                      item + ": asks for nothing on its v lines; add some in Hugin, or give --free all");
    check(status, item, &error);
    fitted.result.image_quality = nullptr;
    fitted.exposures = relative_exposures(fitted.exposures, reference);
    return fitted;
}

BuildReport no_fit(const std::vector<std::string> &names, const std::string &reason) {
    BuildReport report;
    report.names = names;
    report.exposures.resize(names.size());
    for (auto &e : report.exposures) lensprof_exposure_init(&e);
    lensprof_fit_result_init(&report.fit);
    report.fit.heldout_rms = report.fit.heldout_median = report.fit.before_rms = LENSPROF_UNKNOWN;
    report.fit.gamma_from = LENSPROF_GAMMA_NONE;
    report.fit.gamma_sigma = LENSPROF_UNKNOWN;
    report.fit.vignettings = 1;
    report.quality.resize(names.size());
    report.verdict.text = reason;
    return report;
}

int finish_fit(BuildReport &report, const lensprof_profile_key &key, const StoreOptions &store, const Finish &finish,
               Streams &streams) {
    bool good = report.fit.usable || store.force;
    stop_if_interrupted();
    if (good && !store.no_store) {
        auto profile = profile_of(report.fit);
        profile->key = key;
        profile->provenance.images = static_cast<uint32_t>(report.names.size());
        int64_t held = 0;
        if (finish.prior && report.fit.profile_prior == LENSPROF_PROFILE_PRIOR_USED) {
            held = finish.prior->id;
            const lensprof_provenance &earlier = finish.prior->profile->provenance;
            profile->provenance.images = sum_of(profile->provenance.images, earlier.images);
            profile->provenance.pairs = sum_of(profile->provenance.pairs, earlier.pairs);
        }
        report.profile_id =
            store_profile(store, *profile, {finish.method, finish.source, report.fit.usable != 0, held});
    }
    if (finish.outputs) finish.outputs->commit();
    if (finish.json)
        print_json(build_json(report), streams.out);
    else
        print_build(report, streams.out);
    if (report.profile_id && !finish.json)
        streams.out << "stored    profile " << report.profile_id << " in " << store_path(store.db) << ": "
                    << describe_key(key) << "\n";
    if (report.fit.usable && !report.verdict.text.empty())
        streams.err << "lensprof: warning: " << finish.source << ": " << report.verdict.text << "\n";
    if (!report.fit.usable)
        streams.err << "lensprof: " << finish.source << ": not usable: " << report.verdict.text
                    << (good || store.no_store ? "" : "; nothing was stored (--force stores it all the same)") << "\n";
    return static_cast<int>(report.fit.usable ? ExitCode::done : ExitCode::not_usable);
}

void check_max_side(uint32_t max_side) {
    if (max_side != 0 && max_side < 64)
        throw Failure(
            ExitCode::usage,
            "--max-side: pictures of less than 64 pixels hold too few samples; give more, or 0 for full size");
}

double lap(std::chrono::steady_clock::time_point &since) {
    auto now = std::chrono::steady_clock::now();
    double seconds = std::chrono::duration<double>(now - since).count();
    since = now;
    return seconds;
}

}  // namespace lensprof
