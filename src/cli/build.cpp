/* `lensprof build`: pictures of a project -> response, falloff, exposures -> a profile in the database. */
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <regex>

#include <unistd.h>

#include "interrupt.hpp"
#include "output_file.hpp"
#include "project.hpp"
#include "report.hpp"
#include "run.hpp"

namespace lensprof {
namespace {

struct Options {
    std::string pto, points, points_out, pto_out, db, method = "transfer", modes = "auto", loss = "robust",
                sampling = "balanced", gamma_from = "auto", camera_kind = "any", falloff = "auto", reference, free,
                compare, maker, camera, lens, processing;
    bool no_store = false, json = false, force = false, one_lens = false, progress = false;
    double huber = 5.0, prior = 1.0, exif_sigma = 0.1, focal = LENSPROF_UNKNOWN, aperture = LENSPROF_UNKNOWN,
           distance = LENSPROF_UNKNOWN;
    uint32_t seed = 1, pairs = 0, max_side = 800;
};

void declare(CLI::App &app, Options &o) {
    app.add_option("PROJECT", o.pto, "Hugin project; its v lines choose what is estimated")->required();
    app.add_option("--points", o.points,
                   "use the pairs of this point file; the pictures (and their EXIF exposures) are then not used");
    app.add_option("--points-out", o.points_out,
                   "write the pairs used (Hugin's 16 columns), also those of a fit that is not usable");
    app.add_option("--pto-out", o.pto_out, "write the project with the result in it, for Hugin, nona and apply");
    app.add_option("--db", o.db, "profile database; default the user's own");
    app.add_flag("--no-store", o.no_store, "do not store the profile");
    app.add_flag("--force", o.force, "store a result that is not usable");
    app.add_option("--method", o.method, "transfer (d'Angelo 2007)")->check(CLI::IsMember({"transfer"}));
    app.add_option("--modes", o.modes, "EMoR modes of the response: 0..25 or auto (held-out error decides)");
    app.add_option("--loss", o.loss, "robust, huber (the paper's) or squared")
        ->check(CLI::IsMember({"robust", "huber", "squared"}));
    app.add_option("--huber", o.huber, "sigma of the Huber loss, levels of 255")->check(in_range(0.01, 255.0));
    app.add_option("--prior", o.prior, "weight of the priors; 0 = none, as in the paper")->check(in_range(0.0, 1e6));
    app.add_option("--gamma-from", o.gamma_from,
                   "what settles the common exponent of exposure, falloff and response: auto (EXIF exposures that "
                   "differ, and the prior, each by its standard error), exif, prior, known (the project's response)")
        ->check(CLI::IsMember({"auto", "exif", "prior", "known"}));
    app.add_option("--exif-sigma", o.exif_sigma, "standard error of an EXIF exposure, EV; 0 = do not use them")
        ->check(in_range(0.0, 10.0));
    app.add_option("--camera-kind", o.camera_kind, "whose responses the prior is of: any, film or digital")
        ->check(CLI::IsMember({"any", "film", "digital"}));
    app.add_option("--falloff-curves", o.falloff, "1, 3 (one a channel) or auto (held-out error decides)")
        ->check(CLI::IsMember({"auto", "1", "3"}));
    app.add_option("--free", o.free, "what is estimated instead of the v lines: response,falloff,center,ev,wb or all");
    app.add_option("--reference", o.reference, "image (number or name) whose exposure is 0 EV");
    app.add_flag("--one-lens", o.one_lens, "take images that are not linked as one lens");
    app.add_option("--sampling", o.sampling, "balanced or paper (d'Angelo 5.1)")
        ->check(CLI::IsMember({"balanced", "paper"}));
    app.add_option("--pairs", o.pairs, "number of pairs; 0 = 300 an image, at least 2000")->check(in_range(0, 1 << 24));
    app.add_option("--seed", o.seed, "of the sampling");
    app.add_option("--max-side", o.max_side,
                   "sample pictures reduced to no less than this many pixels (800); 0 = full size");
    app.add_option("--maker", o.maker, "camera maker, instead of EXIF's");
    app.add_option("--camera", o.camera, "camera model");
    app.add_option("--lens", o.lens, "lens");
    app.add_option("--focal", o.focal, "focal length, mm")->check(in_range(0.01, 1e5));
    app.add_option("--aperture", o.aperture, "f-number")->check(in_range(0.01, 1e4));
    app.add_option("--distance", o.distance, "focus distance, m")->check(in_range(1e-6, INFINITY));
    app.add_option("--processing", o.processing, "raw, jpeg or corrected (falloff corrected in camera)");
    app.add_option("--compare", o.compare, "truth.json of `simulate`: print recovered beside true values");
    app.add_flag("--json", o.json, "print one JSON object");
    app.add_flag("--progress", o.progress, "show progress also when standard error is not a terminal");
}

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

constexpr uint32_t falloff_flags = LENSPROF_FREE_K1 | LENSPROF_FREE_K2 | LENSPROF_FREE_K3;
constexpr uint32_t lens_flags = LENSPROF_FREE_RESPONSE | falloff_flags | LENSPROF_FREE_CENTER;
constexpr uint32_t balance_flags = LENSPROF_FREE_RED | LENSPROF_FREE_BLUE;

/* --free: the same unknowns for every image. */
uint32_t free_of(const std::string &list) {
    uint32_t flags = 0;
    std::string word;
    for (char c : list + ",") {
        if (c != ',') {
            word += c;
            continue;
        }
        if (word == "response") flags |= LENSPROF_FREE_RESPONSE;
        else if (word == "falloff") flags |= falloff_flags;
        else if (word == "center") flags |= LENSPROF_FREE_CENTER;
        else if (word == "ev") flags |= LENSPROF_FREE_EV;
        else if (word == "wb") flags |= balance_flags;
        else if (word == "all") flags |= lens_flags | LENSPROF_FREE_EV | balance_flags;
        else throw Failure(ExitCode::usage, "--free " + word + ": use response, falloff, center, ev, wb, all");
        word.clear();
    }
    return flags;
}

lensprof_fit_options fit_options(const Options &o, const Project &project, lensprof_response &fixed) {
    lensprof_fit_options options;
    lensprof_fit_options_init(&options);
    const auto &lens = project.images[project.reference];
    options.free = 0;
    for (const auto &image : project.images) options.free |= image.free & lens_flags;
    options.reference = project.reference;
    options.modes = modes_of(o.modes);
    options.loss = o.loss == "huber"     ? LENSPROF_LOSS_HUBER
                   : o.loss == "squared" ? LENSPROF_LOSS_SQUARED
                                         : LENSPROF_LOSS_ROBUST;
    options.vignettings = o.falloff == "auto" ? 0 : o.falloff == "3" ? 3 : 1;
    options.gamma_from = o.gamma_from == "exif"    ? LENSPROF_GAMMA_EXPOSURES
                         : o.gamma_from == "prior" ? LENSPROF_GAMMA_PRIOR
                                                   : LENSPROF_GAMMA_AUTO;
    if (o.gamma_from == "known") options.free &= ~LENSPROF_FREE_RESPONSE;
    options.camera_kind = camera_kind_of_name(o.camera_kind);
    options.huber_levels = o.huber;
    options.prior_weight = o.prior;
    options.vignetting = lens.vignetting;
    check(lensprof_pto_get_response(project.pto.get(), project.reference, &fixed), project.path);
    options.response = &fixed;
    if (options.free & falloff_flags)
        if (lensprof_vignetting_validate(&options.vignetting) != LENSPROF_OK)
            options.vignetting = lensprof_vignetting{};
    return options;
}

int on_progress(double done, void *progress) {
    static_cast<Progress *>(progress)->update("fitting", done);
    return interrupted();
}

/* Seconds since the last call. */
double lap(std::chrono::steady_clock::time_point &since) {
    auto now = std::chrono::steady_clock::now();
    double seconds = std::chrono::duration<double>(now - since).count();
    since = now;
    return seconds;
}

bool is_grey(const std::vector<lensprof_pair> &pairs) {
    for (const auto &p : pairs)
        for (const auto &v : p.value)
            if (v[0] != v[1] || v[1] != v[2]) return false;
    return true;
}

/* What the pictures say about themselves. Beside given pairs they may be anything: only what the profile's key needs is
 * read. */
std::vector<PictureMetadata> picture_metadata(const Options &o, const Project &project) {
    std::vector<PictureMetadata> metadata(project.files.size(), unknown_metadata());
    for (uint32_t i = 0; i < metadata.size(); i++) {
        bool needed = o.points.empty() || (i == project.reference && !o.no_store);
        if (needed && std::filesystem::exists(project.files[i])) metadata[i] = read_metadata(project.files[i]);
    }
    return metadata;
}

/* The key of the profile: EXIF of the reference picture, then what the command line says. */
lensprof_profile_key profile_key(const Options &o, const Project &project,
                                 const std::vector<PictureMetadata> &metadata, Streams &streams) {
    const std::string &file = project.files[project.reference];
    lensprof_profile_key key = metadata[project.reference].key;
    if (!o.maker.empty()) set_text(key.camera_maker, sizeof key.camera_maker, o.maker);
    if (!o.camera.empty()) set_text(key.camera_model, sizeof key.camera_model, o.camera);
    if (!o.lens.empty()) set_text(key.lens, sizeof key.lens, o.lens);
    if (o.focal != LENSPROF_UNKNOWN) key.focal_mm = o.focal;
    if (o.aperture != LENSPROF_UNKNOWN) key.aperture = o.aperture;
    if (o.distance != LENSPROF_UNKNOWN) key.distance_m = o.distance;
    if (!o.processing.empty()) key.processing = processing_of_name(o.processing);
    if (!*key.camera_model && !*key.lens && !o.no_store)
        throw Failure(ExitCode::usage,
                      file + ": no EXIF says which camera and lens it was; give --camera and --lens, or --no-store");
    for (size_t i = 0; i < project.files.size() && o.aperture == LENSPROF_UNKNOWN && o.points.empty(); i++) {
        const lensprof_profile_key &other = metadata[i].key;
        auto differ = [](double a, double b) { return a != b && a != LENSPROF_UNKNOWN && b != LENSPROF_UNKNOWN; };
        if (std::filesystem::exists(project.files[i])
            && (differ(other.aperture, key.aperture) || differ(other.focal_mm, key.focal_mm)))
            streams.err << "lensprof: warning: " << project.files[i] << ": aperture or focal length differ from "
                        << file << "; one falloff is estimated for both\n";
    }
    return key;
}

/* What the pictures are fitted with. */
struct FitInput {
    lensprof_fit_options options;
    lensprof_response fixed;
    std::vector<lensprof_fit_image> images;
    std::vector<lensprof_pair> pairs;
};

/* Exposures by EXIF, as soft observations. */
void add_known_exposures(const Options &o, const Project &project, const std::vector<PictureMetadata> &metadata,
                         std::vector<lensprof_fit_image> &images, Streams &streams) {
    constexpr double farthest = 40.0; /* EV from 1 s, f/1, ISO 100: no picture was ever taken there */
    for (size_t i = 0; i < images.size() && o.exif_sigma > 0.0 && o.points.empty(); i++) {
        if (!metadata[i].exif_ev) continue;
        if (!(std::fabs(*metadata[i].exif_ev) < farthest)) {
            streams.err << "lensprof: warning: " << project.files[i]
                        << ": time, aperture and ISO in its EXIF cannot be true and are not used\n";
            continue;
        }
        images[i].known_ev = *metadata[i].exif_ev;
        images[i].known_ev_sigma = std::max(o.exif_sigma, 1e-3);
    }
}

/* Another reference than the project's: where nothing else is held, it is held in that one's place, so that standard
 * errors are relative to it. Held exposures are relative to the project's own; there the result is moved afterwards. */
void refer_to(uint32_t reference, FitInput &input) {
    uint32_t &own = input.options.reference, asked = 0;
    for (const auto &image : input.images) asked |= image.free;
    for (uint32_t i = 0; i < input.images.size(); i++) {
        const auto &image = input.images[i];
        bool linked = image.ev_of != i || image.red_of != i || image.blue_of != i;
        if (linked || (i != own && image.free != asked)) return;
    }
    std::swap(input.images[own].free, input.images[reference].free);
    own = reference;
}

/* A database that cannot be used shows before the work is done. */
void check_store(const std::string &db) {
    std::filesystem::path file = store_path(db), folder = std::filesystem::absolute(file).parent_path();
    if (std::filesystem::exists(file)
        && !(std::filesystem::is_regular_file(file) && std::filesystem::file_size(file) == 0))
        open_store(db, LENSPROF_STORE_WRITE);
    else if (!db.empty() && !std::filesystem::is_directory(folder))
        throw Failure(ExitCode::store,
                      db + ": there is no folder " + folder.string() + " for the database; make it first");
    else if (db.empty()) {
        while (!std::filesystem::exists(folder) && folder.has_relative_path()) folder = folder.parent_path();
        if (access(folder.c_str(), W_OK) != 0)
            throw Failure(ExitCode::store, file.string() + ": cannot be made in " + folder.string()
                                               + "; name a database with --db FILE");
    }
}

/* A database that was to be made for one profile is not left behind empty; one that somebody else has filled stays. */
void remove_empty_store(const std::string &file) {
    lensprof_store *store = nullptr;
    uint32_t profiles = 0;
    if (lensprof_store_open(file.c_str(), LENSPROF_STORE_READ, &store, nullptr) == LENSPROF_OK) {
        Store closing(store);
        if (lensprof_store_list(store, nullptr, nullptr, 0, &profiles, nullptr) != LENSPROF_OK) return;
    }
    std::error_code ignored;
    if (profiles == 0) std::filesystem::remove(file, ignored);
}

int64_t store_profile(const Options &o, const Project &project, const lensprof_profile_key &key,
                      const lensprof_fit_result &fit) {
    auto profile = std::make_unique<lensprof_profile>();
    lensprof_profile_init(profile.get());
    profile->key = key;
    profile->response[0] = fit.response;
    profile->vignettings = fit.vignettings;
    std::copy(fit.vignetting, fit.vignetting + 3, profile->vignetting);
    profile->covariance_size = fit.covariance_size;
    std::copy(fit.covariance, fit.covariance + fit.covariance_size * fit.covariance_size, profile->covariance);
    auto &p = profile->provenance;
    set_text(p.method, sizeof p.method, o.method + (fit.usable ? "" : " (forced)"));
    set_text(p.software, sizeof p.software, std::string("lensprof ") + lensprof_version());
    set_text(p.source, sizeof p.source, std::filesystem::absolute(o.pto).string());
    p.created_unix_s = static_cast<int64_t>(std::time(nullptr));
    p.images = static_cast<uint32_t>(project.images.size());
    p.pairs = fit.pairs;
    p.heldout_rms = fit.heldout_rms;
    p.inlier_share = fit.inlier_share;
    bool is_new = !std::filesystem::exists(store_path(o.db));
    try {
        Store store = open_store(o.db, LENSPROF_STORE_CREATE);
        int64_t id = 0;
        lensprof_error error{};
        check(lensprof_store_put(store.get(), profile.get(), &id, &error), store_path(o.db), &error);
        return id;
    } catch (const Failure &) {
        if (is_new) remove_empty_store(store_path(o.db));
        throw;
    }
}

/* No output may take the place of an input, of the database or of another output. */
void check_outputs(const Options &o, const Project &project) {
    std::vector<std::string> taken{o.pto, o.points, o.compare};
    taken.insert(taken.end(), project.files.begin(), project.files.end());
    if (!o.no_store) taken.push_back(store_path(o.db));
    for (const std::string &output : {o.points_out, o.pto_out}) {
        if (output.empty()) continue;
        for (const std::string &other : taken)
            if (is_same_file(output, other))
                throw Failure(ExitCode::usage, output + ": would be written over; give the output another name");
        taken.push_back(output);
    }
}

constexpr uint32_t project_modes = 5;  /* Ra..Re */

/* A fit and the exposures that belong to it. */
struct Fitted {
    lensprof_fit_result result{};
    std::vector<lensprof_exposure> exposures;  /* relative to the reference */
};

/* The text of the project with the result in it. */
std::string project_text(const Options &o, Project &project, const Fitted &fitted, uint32_t reference) {
    check(lensprof_pto_set_result(project.pto.get(), &fitted.result.response, &green_falloff(fitted.result),
                                  fitted.exposures.data(), static_cast<uint32_t>(fitted.exposures.size()), reference),
          o.pto);
    // Names are relative to the project's folder, which may be another one now.
    auto folder = std::filesystem::absolute(o.pto_out).parent_path();
    if (folder.lexically_normal() != std::filesystem::absolute(o.pto).parent_path().lexically_normal())
        for (uint32_t i = 0; i < project.files.size(); i++) {
            auto file = std::filesystem::absolute(project.files[i])
                            .lexically_normal()
                            .lexically_proximate(folder.lexically_normal());
            check(lensprof_pto_set_name(project.pto.get(), i, file.string().c_str()), project.files[i]);
        }
    return pto_text(*project.pto);
}

/* Files that are complete beside their final names until everything else has worked. */
class Outputs {
public:
    void add(const std::string &path, const std::string &text) {
        files_.push_back(std::make_unique<OutputFile>(path));
        files_.back()->write(text.data(), text.size());
    }
    void commit() {
        for (auto &file : files_) file->commit();
    }

private:
    std::vector<std::unique_ptr<OutputFile>> files_;
};

std::vector<lensprof_pair> get_pairs(const Options &o, const Project &project, Progress &progress, BuildReport &report,
                                     uint32_t &channels) {
    auto clock = std::chrono::steady_clock::now();
    std::vector<lensprof_pair> pairs;
    if (!o.points.empty()) {
        pairs = read_points(o.points, project);
        channels = is_grey(pairs) ? 1 : 3;
        report.load_s = lap(clock);
        return pairs;
    }
    auto pictures = read_pictures(project, o.max_side, progress);
    channels = channel_count(pictures);
    report.load_s = lap(clock);
    lensprof_sample_options options;
    lensprof_sample_options_init(&options);
    options.sampling = o.sampling == "paper" ? LENSPROF_SAMPLING_PAPER : LENSPROF_SAMPLING_BALANCED;
    options.pairs = o.pairs;
    options.seed = o.seed;
    pairs = sample_pairs(project, pictures, options, progress);
    report.sample_s = lap(clock);
    return pairs;
}

Fitted fit(const Options &o, const FitInput &input, uint32_t reference,
           std::vector<lensprof_fit_image_quality> *quality) {
    Fitted fitted;
    auto count = static_cast<uint32_t>(input.images.size());
    fitted.exposures.resize(count);
    lensprof_fit_result_init(&fitted.result);
    if (quality) {
        quality->resize(count);
        fitted.result.image_quality = quality->data();
    }
    lensprof_error error{};
    lensprof_status status = lensprof_fit_overlap(&input.options, input.images.data(), count, input.pairs.data(),
                                                  static_cast<uint32_t>(input.pairs.size()), fitted.exposures.data(),
                                                  &fitted.result, &error);
    stop_if_interrupted();
    if (status == LENSPROF_ERROR_NO_UNKNOWNS)
        throw Failure(ExitCode::usage,
                      o.pto + ": asks for nothing on its v lines; add some in Hugin, or give --free all");
    check(status, o.points.empty() ? o.pto : o.points, &error);
    fitted.result.image_quality = nullptr;
    fitted.exposures = relative_exposures(fitted.exposures, reference);
    return fitted;
}

/* A project holds five modes and one falloff: what is best with these, not what is left of something better. */
Fitted fit_for_project(const Options &o, FitInput &input, const Fitted &best, uint32_t reference) {
    bool fits = best.result.response.modes <= project_modes && best.result.vignettings == 1;
    if (fits || !(input.options.free & LENSPROF_FREE_RESPONSE)) return best;
    input.options.modes = std::min<uint32_t>(best.result.response.modes, project_modes);
    input.options.vignettings = 1;
    return fit(o, input, reference, nullptr);
}

/* The fit counts images; people know them by their files. */
std::string with_names(const std::string &reason, const std::vector<std::string> &names) {
    static const std::regex number("image ([0-9]+)");
    std::smatch match;
    if (!std::regex_search(reason, match, number)) return reason;
    size_t i = std::stoul(match[1].str());
    return i < names.size() ? match.prefix().str() + names[i] + match.suffix().str() : reason;
}

BuildReport build(const Options &o, Project &project, const std::vector<PictureMetadata> &metadata, Outputs &outputs,
                  Streams &streams) {
    Progress progress(streams.err, o.progress ? ShowProgress::always : ShowProgress::when_terminal);
    BuildReport report;
    report.names = project.names;
    report.reference = o.reference.empty() ? project.reference : image_of_word(project, o.reference);
    FitInput input;
    input.options = fit_options(o, project, input.fixed);
    report.camera_kind = input.options.camera_kind;
    input.pairs = get_pairs(o, project, progress, report, input.options.channels);
    stop_if_interrupted();
    input.options.progress = on_progress;
    input.options.progress_user = &progress;
    input.images = fit_images(project);
    add_known_exposures(o, project, metadata, input.images, streams);
    refer_to(report.reference, input);
    Fitted best = fit(o, input, report.reference, &report.quality);
    report.fit = best.result;
    set_text(report.fit.reason, sizeof report.fit.reason, with_names(best.result.reason, project.names));
    report.exposures = best.exposures;
    if (!o.points_out.empty()) outputs.add(o.points_out, points_text(input.pairs, project));
    if (!o.pto_out.empty() && (report.fit.usable || o.force)) {
        Fitted written = fit_for_project(o, input, best, report.reference);
        outputs.add(o.pto_out, project_text(o, project, written, report.reference));
    }
    progress.clear();
    if (report.fit.usable && *report.fit.reason)
        streams.err << "lensprof: warning: " << o.pto << ": " << report.fit.reason << "\n";
    if (o.gamma_from == "exif" && report.fit.gamma_from == LENSPROF_GAMMA_PRIOR)
        streams.err << "lensprof: warning: " << o.pto
                    << (o.points.empty() ? ": no EXIF exposures that differ" : ": EXIF is not read beside --points")
                    << ": gamma rests on the prior\n";
    return report;
}

/* What --json prints where no fit could be made: the same object, neutral, with the reason. */
void print_no_fit(const std::vector<std::string> &names, const std::string &reason, Streams &streams) {
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
    set_text(report.fit.reason, sizeof report.fit.reason, reason);
    print_json(build_json(report), streams.out);
}

/* The command behind its options; `names` receives the images as soon as they are known. */
int build_and_store(const Options &o, std::vector<std::string> &names, Streams &streams) {
    Project project = read_project(o.pto, o.one_lens);
    names = project.names;
    if (project.images.size() < 2)
        throw Failure(ExitCode::not_usable, o.pto + ": has one image; at least two overlapping ones are needed");
    check_outputs(o, project);
    if (!o.free.empty())
        for (auto &image : project.images) image.free = free_of(o.free);
    auto metadata = picture_metadata(o, project);
    lensprof_profile_key key = profile_key(o, project, metadata, streams);
    TrueValues truth;
    if (!o.compare.empty()) truth = read_truth(o.compare, project.images.size());
    if (!o.no_store) check_store(o.db);
    Outputs outputs;
    BuildReport report = build(o, project, metadata, outputs, streams);
    bool good = report.fit.usable || o.force;
    stop_if_interrupted();
    if (good && !o.no_store) report.profile_id = store_profile(o, project, key, report.fit);
    outputs.commit();
    if (o.json) print_json(build_json(report), streams.out);
    else print_build(report, streams.out);
    if (report.profile_id && !o.json)
        streams.out << "stored    profile " << report.profile_id << " in " << store_path(o.db) << ": "
                    << describe_key(key) << "\n";
    if (!o.compare.empty() && !o.json) print_comparison(report, truth, streams.out);
    if (!report.fit.usable)
        streams.err << "lensprof: " << o.pto << ": not usable: " << report.fit.reason
                    << (good                   ? ""
                        : !o.no_store          ? "; nothing was stored (--force stores it all the same)"
                        : !o.pto_out.empty()   ? "; no project was written (--force writes it all the same)"
                                               : "") << "\n";
    return static_cast<int>(report.fit.usable ? ExitCode::done : ExitCode::not_usable);
}

}  // namespace

int run_build(const std::vector<std::string> &arguments, Streams &streams) {
    Options o;
    CLI::App app("Recovers response, falloff, exposure and white balance from overlapping pictures.", "lensprof build");
    declare(app, o);
    if (!parse(app, arguments, streams)) return 0;
    if (o.max_side != 0 && o.max_side < 64)
        throw Failure(
            ExitCode::usage,
            "--max-side: pictures of less than 64 pixels hold too few samples; give more, or 0 for full size");
    if (o.gamma_from == "exif" && o.exif_sigma == 0.0)
        throw Failure(ExitCode::usage,
                      "--gamma-from exif and --exif-sigma 0, which leaves EXIF out, contradict each other");
    if (o.json && !o.compare.empty())
        throw Failure(ExitCode::usage, "--compare prints a table, which --json leaves out; give one of the two");
    if (o.no_store && !o.db.empty()) throw Failure(ExitCode::usage, "--db and --no-store contradict each other");

    std::vector<std::string> names;
    try {
        return build_and_store(o, names, streams);
    } catch (const Failure &failure) {
        if (o.json && failure.code == ExitCode::not_usable) print_no_fit(names, failure.what(), streams);
        throw;
    }
}

}  // namespace lensprof
