#include "photo/calibration/scene_fit.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "photo/base/events.hpp"
#include "photo/base/format.hpp"
#include "photo/base/lap.hpp"
#include "photo/base/paths.hpp"
#include "photo/calibration/known_exposures.hpp"
#include "photo/calibration/pedestal.hpp"
#include "photo/pictures/icc.hpp"
#include "photo/pictures/named_pictures.hpp"
#include "photo/scene/block_sampling.hpp"
#include "photo/scene/point_file.hpp"
#include "photo/scene/sampling.hpp"
#include "photo/scene/scene_pictures.hpp"

namespace lensprof {
namespace {

lensprof_fit_options scene_options(const SceneFitOptions &o, const Scene &scene, lensprof_response &fixed) {
    lensprof_fit_options options = fit_options(o.fit);
    const auto &lens = scene.images[scene.reference];
    uint32_t free_in_scene = 0;
    for (const auto &image : scene.images) free_in_scene |= image.free & LENSPROF_FREE_LENS;
    options.free &= free_in_scene;
    options.reference = scene.reference;
    options.vignettings = o.falloff_curves;
    options.vignetting = lens.vignetting;
    fixed = scene.models[scene.reference]->response[0];
    options.response = &fixed;
    if (options.free & LENSPROF_FREE_FALLOFF)
        if (lensprof_vignetting_validate(&options.vignetting) != LENSPROF_OK)
            options.vignetting = lensprof_vignetting{};
    return options;
}

// A profile stores measured properties of a lens: without any to estimate, nothing is stored.
void check_unknowns(const SceneFitOptions &o, const Scene &scene, const lensprof_fit_options &options) {
    if (!o.store.no_store && !(options.free & (LENSPROF_FREE_RESPONSE | LENSPROF_FREE_FALLOFF)))
        throw Failure(LENSPROF_ERROR_ARGUMENT, scene.path
                                           + ": neither response nor falloff is estimated, so there is nothing to "
                                             "store; give " + option_name("no_store") + ", or " + option_name("free_all"));
}

bool is_grey(const std::vector<lensprof_pair> &pairs) {
    for (const auto &p : pairs)
        for (const auto &v : p.value)
            if (v[0] != v[1] || v[1] != v[2]) return false;
    return true;
}

using Pictures = std::vector<SamplePicture>;

lensprof_sample_options sample_options(const SceneFitOptions &o) {
    lensprof_sample_options options;
    lensprof_sample_options_init(&options);
    options.sampling = o.sampling;
    options.pairs = o.pixels.pairs;
    options.seed = o.pixels.seed;
    return options;
}

// Passes the links found by sampling to the fit.
void set_links(SceneFit &state) {
    state.input.options.links = state.report.links.data();
    state.input.options.link_count = static_cast<uint32_t>(state.report.links.size());
}

// Samples pairs or tracks of the pictures; `known`, if not NULL, is the known camera and helps to find them.
void draw_points(const SceneFitOptions &o, const Scene &scene, Pictures &pictures, const Fitted *known,
                 SceneFit &state) {
    auto clock = std::chrono::steady_clock::now();
    FitInput &input = state.input;
    std::vector<lensprof_link> &links = state.report.links;
    lensprof_sample_options options = sample_options(o);
    lensprof_vignetting falloff{};
    if (known) options.response = &known->result.response;
    if (known && !has_crops(scene)) {
        falloff = green_falloff(known->result);
        if (!input.turn_of.empty()) falloff.center[0] = falloff.center[1] = 0.0;  // sampling takes one for all pictures
        options.vignetting = &falloff;
    }
    // The method radiance makes tracks of pairs if sampling by cameras finds no tracks.
    const bool by_matches = scene.by_matches && o.sampling == LENSPROF_SAMPLING_BALANCED;
    if (o.fit.method == LENSPROF_METHOD_RADIANCE && !by_matches) {
        input.observations = sample_tracks(scene, pictures, options, state.events, &links);
        input.pairs = pairs_of_tracks(input.observations);
    } else {
        input.pairs = sample_pairs(scene, pictures, options, {}, state.events, &links);
    }
    set_links(state);
    state.report.sample_s += lap(clock);
}

// Passes what a reconstruction knows of its pairs to the fit.
void set_points(const Scene &scene, std::vector<uint32_t> points, FitInput &input) {
    input.points = std::move(points);
    for (const lensprof_pair &pair : input.pairs)
        input.view_distances.push_back(scene.view_distances.at(std::minmax(pair.image[0], pair.image[1])));
}

// The fitted pairs or tracks, and the pictures they were drawn from (empty if pairs are given).
Pictures get_points(const SceneFitOptions &o, const Scene &scene, SceneFit &state) {
    auto clock = std::chrono::steady_clock::now();
    uint32_t &channels = state.input.options.channels;
    if (!o.points.empty() || !scene.pairs.empty()) {
        state.input.pairs = o.points.empty() ? scene.pairs : read_points(o.points, scene);
        if (o.points.empty()) set_points(scene, scene.pair_points, state.input);
        channels = is_grey(state.input.pairs) ? 1 : 3;
        state.report.load_s = lap(clock);
        return {};
    }
    if (scene.is_reconstruction) {
        lensprof_sample_options options = sample_options(o);
        options.pairs = 0;  // as many as there are matches, which were selected for this
        std::vector<uint32_t> points;
        state.input.pairs = sample_in_blocks(scene, options, o.pixels.max_side, default_block_bytes, state.events,
                                             state.report.links, points, &channels);
        set_points(scene, std::move(points), state.input);
        set_links(state);
        state.report.sample_s = lap(clock);
        return {};
    }
    Pictures pictures = read_pictures(scene, o.pixels.max_side, state.events);
    channels = channel_count(pictures);
    state.report.load_s = lap(clock);
    draw_points(o, scene, pictures, nullptr, state);
    return pictures;
}

size_t links_of_state(const std::vector<lensprof_link> &links, uint32_t state) {
    return static_cast<size_t>(
        std::count_if(links.begin(), links.end(), [=](const lensprof_link &link) { return link.state == state; }));
}

// Whether a second result explains more of the pictures: worse in nothing, and with more of them, better, or with more
// verified links.
bool explains_more(const Fitted &second, const std::vector<lensprof_link> &second_links, const Fitted &first,
                   const std::vector<lensprof_link> &first_links) {
    const auto ranking_of = [](const Fitted &fitted, const std::vector<lensprof_link> &links) {
        return std::tuple(joined_images(fitted), fitted.result.equalizes != 0, fitted.result.usable != 0,
                          links_of_state(links, LENSPROF_LINK_VERIFIED));
    };
    const bool is_worse = joined_images(second) < joined_images(first)
                          || second.result.equalizes < first.result.equalizes
                          || second.result.usable < first.result.usable;
    return !is_worse && ranking_of(second, second_links) > ranking_of(first, first_links);
}

// Whether links may connect images once response and falloff are known. Not with a refused result, whose irradiance is
// wrong.
bool may_connect_more(const SceneFitOptions &o, const Fitted &first, const std::vector<lensprof_link> &links) {
    const uint32_t code = first.verdict.code();
    const bool is_trusted =
        first.corrects() || code == LENSPROF_REASON_IMAGE_GROUPS || code == LENSPROF_REASON_IMAGES_MINORITY;
    const bool is_complete =
        joined_images(first) == first.exposures.size() && links_of_state(links, LENSPROF_LINK_CONTRADICTED) == 0;
    return o.sampling == LENSPROF_SAMPLING_BALANCED && is_trusted && !is_complete;
}

// Draws again, comparing irradiance instead of grey values, and fits the new pairs; kept if it explains more.
void resample(const SceneFitOptions &o, const Scene &scene, Pictures &pictures, SceneFit &state) {
    const std::vector<lensprof_pair> pairs = state.input.pairs;
    const std::vector<lensprof_observation> observations = state.input.observations;
    const std::vector<lensprof_link> links = state.report.links;
    std::vector<lensprof_fit_image_quality> quality;
    try {
        draw_points(o, scene, pictures, &state.best, state);
        const Fitted second = fit(state.input, state.report.reference, state.item, state.events, &quality);
        if (explains_more(second, state.report.links, state.best, links)) {
            state.best = second;
            state.report.quality = quality;
            state.report.sampling_rounds = 2;
            return;
        }
    } catch (const Failure &failure) {
        if (failure.group() == LENSPROF_ERROR_CANCELLED) throw;  // else the first fit stays
    }
    state.input.pairs = pairs, state.input.observations = observations, state.report.links = links;
    set_links(state);
}

// Changes the reference of the project: if nothing else is fixed, its exposure is fixed instead, so that standard
// errors are relative to it. Fixed exposures are relative to the project's own reference; then the result is shifted
// afterwards.
void set_reference(uint32_t reference, FitInput &input) {
    uint32_t &current = input.options.reference, free_in_images = 0;
    for (const auto &image : input.images) free_in_images |= image.free;
    for (uint32_t i = 0; i < input.images.size(); i++) {
        const auto &image = input.images[i];
        bool linked = image.ev_of != i || image.red_of != i || image.blue_of != i;
        if (linked || (i != current && image.free != free_in_images)) return;
    }
    std::swap(input.images[current].free, input.images[reference].free);
    current = reference;
}

// Sets the images' settings, if the method fits several, and cameras.
void set_settings(const SceneFitOptions &o, SceneFit &state, Events &events) {
    LensSettings &settings = state.settings;
    const bool has_one_falloff = o.fit.method == LENSPROF_METHOD_TRANSFER_FUNCTION;  // with one falloff per camera
    if (has_one_falloff && settings.first.size() > settings.first_of_camera.size()) {
        events.warn(option_name("method_transfer_function"),
                    "estimates one falloff, but these pictures have " + counted(settings.first.size(), "lens setting")
                        + "; use transfer or radiance to estimate one per setting");
        settings.of_image = settings.camera_of_image, settings.first = settings.first_of_camera;
    }
    for (size_t i = 0; i < state.input.images.size(); i++) {
        state.input.images[i].setting = settings.of_image[i];
        state.input.images[i].camera = settings.camera_of_image[i];
    }
    if (settings.has_rotated_images()) state.input.turn_of = settings.turn_of_image;
    lensprof_fit_options &options = state.input.options;
    if (!settings.are_centres_unknown || !(options.free & LENSPROF_FREE_CENTER)) return;
    options.free &= ~uint32_t(LENSPROF_FREE_CENTER);
    options.vignetting.center[0] = options.vignetting.center[1] = 0.0;
    events.note(state.item,
                "no orientation states which way the portrait pictures were rotated; portrait and "
                "landscape pictures share a falloff around the middle of the frame");
}

// How far each lens was stopped down, and the size of the sensor, if EXIF states them: falloffs depend on both.
void set_lens_facts(const std::vector<PictureMetadata> &metadata, std::vector<lensprof_fit_image> &images) {
    for (size_t i = 0; i < images.size(); i++) {
        if (metadata[i].f_number && metadata[i].open_f_number)
            images[i].f_number_ratio = std::clamp(*metadata[i].f_number / *metadata[i].open_f_number, 1.0, 64.0);
        const double crop_factor = metadata[i].key.crop_factor;
        if (crop_factor != LENSPROF_UNKNOWN) images[i].crop_factor = std::clamp(crop_factor, 0.1, 100.0);
    }
}

// Failure (usage) for images of several cameras with different responses that should share a fixed one, for more
// cameras than a fit takes, and if each image has its own camera.
void check_cameras(const Scene &scene, uint32_t free, LensSettings &settings) {
    if (!settings.has_several_cameras()) return;
    const size_t cameras = settings.first_of_camera.size();
    const auto fail = [&](const std::string &reason) {
        throw Failure(LENSPROF_ERROR_ARGUMENT, scene.path + ": its images are from " + std::to_string(cameras)
                                                   + " cameras, according to their links in Ra..Re and EXIF" + reason);
    };
    if (!(free & LENSPROF_FREE_RESPONSE)) {
        const auto &first = scene.images[settings.first_of_camera[0]];
        for (const uint32_t i : settings.first_of_camera) {
            const auto &image = scene.images[i];
            if (image.response_type != first.response_type || !std::equal(image.emor, image.emor + 5, first.emor))
                fail(", and the response of " + scene.names[i] + " is fixed while others are estimated; estimate "
                                                                     "all responses, or give one camera at a time");
        }
        join_cameras(settings);
    } else if (cameras == scene.images.size()) {
        fail(", one image each; give more pictures per camera, or use " + option_name("one_lens")
             + " to treat all as one");
    } else if (cameras > LENSPROF_CAMERAS_MAX) {
        fail(format(", but a fit takes at most %d; give fewer, or use %s to treat all as one", LENSPROF_CAMERAS_MAX,
                    option_name("one_lens").c_str()));
    }
}

// The kind of all cameras, if the pictures state it; any if they differ.
CameraKind common_camera_kind(const SceneFitOptions &o, const std::vector<PictureMetadata> &metadata,
                              const LensSettings &settings, const CameraKind &of_reference) {
    for (const uint32_t first : settings.first_of_camera)
        if (of_reference.from != KindFrom::option && settings.has_several_cameras()
            && camera_kind_of(o.fit, metadata[first].key, metadata[first]).kind != of_reference.kind)
            return {};
    return of_reference;
}

// The images of the smaller of two visits, which a finding names.
std::string images_of_visit(const Scene &scene, const BuildReport &report, uint32_t image) {
    std::vector<uint32_t> images;
    for (uint32_t i = 0; i < report.quality.size(); i++)
        if (report.quality[i].component == report.quality[image].component) images.push_back(i);
    return listed(images, scene.names);
}

// A pedestal in linear pictures passes for smaller differences of exposure and falloff.
void warn_of_pedestal(const Scene &scene, const SceneFit &state, Events &events) {
    const auto found = find_pedestal(state.input.pairs, state.input.images);
    if (!found) return;
    const double sample = lensprof_levels_to_sample(&scene.levels, 1, found->level);
    events.warn(scene.path,
                format("dark and bright parts agree better with a black level of about %.2g %% of full scale; measure "
                       "it with the lens covered, and state it with %s; or the pictures are not linear",
                       100.0 * sample, option_name("black_level").c_str()));
}

// What the fit of a reconstruction found of colours, and of light.
void report_scene(const Scene &scene, SceneFit &state) {
    if (state.input.points.empty() || !state.input.options.free) return;
    BuildReport &report = state.report;
    const lensprof_fit_result &result = state.best.result;
    report.variance = {result.colour_variance_before, result.colour_variance_exposures_only, result.colour_variance,
                       state.input.pairs.size()};
    if (result.model == LENSPROF_FIT_MODEL_EXPOSURES) {
        state.settings.of_image.assign(state.settings.of_image.size(), 0), state.settings.first.resize(1);
        join_cameras(state.settings);
    }
    for (Finding &finding : state.best.verdict.findings)
        if (finding.code == LENSPROF_REASON_IMAGE_GROUPS && !std::isnan(finding.limit))
            finding.text += advice("one_visit") + ": " + images_of_visit(scene, report, finding.item.index);
}

// The result of each setting, if there are several.
void report_settings(const SceneFitOptions &o, const Scene &scene, const std::vector<PictureMetadata> &metadata,
                     SceneFit &state) {
    BuildReport &report = state.report;
    const LensSettings &settings = state.settings;
    report.is_turn_unknown = settings.is_turn_unknown[0];
    if (!settings.has_several_settings()) return;
    report.setting_of = settings.of_image;
    for (uint32_t s = 0; s < settings.first.size(); s++) {
        const uint32_t first = settings.first[s];
        SettingReport setting;
        setting.camera = settings.camera_of_image[first];
        try {
            setting.key = override_key(metadata[first].key, metadata[first].size, o.store, scene.files[first]);
        } catch (const Failure &failure) {  // the others are stored
            if (failure.group() != LENSPROF_ERROR_ARGUMENT || s == settings.of_image[state.best.result.reference])
                throw;
            setting.key = metadata[first].key, setting.no_key = failure.what();
        }
        setting.label = describe_setting(setting.key, scene.names[first]);
        if (settings.has_several_cameras())
            setting.label = describe_camera(metadata[first].key, scene.names[settings.first_of_camera[setting.camera]])
                            + ", " + setting.label;
        for (const SettingReport &other : report.settings)
            if (other.label == setting.label) setting.label += ", from " + scene.names[first];
        setting.is_reference = s == settings.of_image[state.best.result.reference];
        setting.number = s, setting.found = state.best.settings[s];
        setting.is_turn_unknown = settings.is_turn_unknown[s];
        setting.verdict = setting.found.images ? verdict_of(state.best.held.get(), s) : Verdict{};
        const bool is_refused = !setting.verdict.texts(LENSPROF_SEVERITY_REFUSAL).empty();
        if (setting.found.images && !setting.found.usable && !is_refused)  // with all others
            setting.verdict.add_first(state.best.verdict.findings.at(0));
        name_images(scene.names, setting.verdict);
        report.settings.push_back(setting);
    }
}

// The same for each camera.
void report_cameras(const Scene &scene, const std::vector<PictureMetadata> &metadata, SceneFit &state) {
    BuildReport &report = state.report;
    const LensSettings &settings = state.settings;
    if (!settings.has_several_cameras()) return;
    report.camera_of = settings.camera_of_image;
    for (uint32_t k = 0; k < settings.first_of_camera.size(); k++) {
        const uint32_t first = settings.first_of_camera[k];
        CameraReport camera;
        camera.label = describe_camera(metadata[first].key, scene.names[first]);
        for (const CameraReport &other : report.cameras)
            if (other.label == camera.label) camera.label += ", from " + scene.names[first];
        camera.is_reference = k == settings.camera_of_image[state.best.result.reference];
        camera.found = state.best.cameras[k];
        camera.fit = state.best.settings[camera.found.setting];
        report.cameras.push_back(camera);
    }
}

}  // namespace

std::vector<PictureMetadata> picture_metadata(const SceneFitOptions &o, const Scene &scene) {
    if (!scene.metadata.empty()) return scene.metadata;
    std::vector<PictureMetadata> metadata(scene.files.size(), unknown_metadata());
    if (o.points.empty() && scene.pairs.empty()) require_one_kind(scene.files);
    for (uint32_t i = 0; i < metadata.size(); i++) {
        bool needed = o.points.empty() || (i == scene.reference && !o.store.no_store);
        if (needed && path_exists(scene.files[i])) metadata[i] = read_metadata(scene.files[i]);
    }
    return metadata;
}

// Float samples are shares: counts beyond 1 would be white.
static void refuse_counts(const StatedLevels &stated, const std::string &file) {
    std::vector<StatedLevel> all = stated.black;
    if (stated.white) all.push_back(*stated.white);
    for (const StatedLevel &level : all)
        if (!level.is_share && level.number > 1.0)
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          file
                              + format(": has float samples, of which 1 is full scale, below the stated level of %g; "
                                       "divide the samples by that at full scale, and state levels as percentages",
                                       level.number));
}

static void require_linear(const SceneFitOptions &o, const PictureMetadata &metadata, const Picture &header,
                           const std::string &file) {
    const bool is_rendered =
        !header.icc.empty() && tone_curve_of(header.icc.data(), header.icc.size()) == ToneCurve::other;
    if (header.traits.is_lossy || is_rendered)
        throw Failure(LENSPROF_ERROR_ARGUMENT, file + ": is a rendered picture, and black and white level are those of "
                                                      "linear ones; omit " + option_name("black_level") + " and "
                                                   + option_name("white_level"));
    if (camera_kind_of(o.fit, metadata.key, metadata).kind != LENSPROF_CAMERA_LINEAR)
        throw Failure(LENSPROF_ERROR_ARGUMENT, file + ": is not known to be linear, and black and white level are those "
                                                      "of linear pictures; give " + option_name("camera_kind_linear")
                                                   + " if it is");
}

lensprof_levels scene_levels(const SceneFitOptions &o, const Scene &scene,
                             const std::vector<PictureMetadata> &metadata) {
    if (!o.levels.any()) return {};
    if (!o.points.empty() || !scene.pairs.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      (o.points.empty() ? scene.path : o.points)
                          + ": its values are taken as they are, without black and white level; omit "
                          + option_name("black_level") + " and " + option_name("white_level")
                          + ", or give the pictures instead");
    lensprof_levels levels{};
    uint32_t sample = 0;
    for (size_t i = 0; i < scene.files.size(); i++) {
        stop_if_cancelled();
        const std::string &file = scene.files[i];
        const Picture header = read_header(file);
        require_linear(o, metadata[i], header, file);
        if (i == 0) sample = header.sample;
        if (header.sample == LENSPROF_SAMPLE_F32) refuse_counts(o.levels, file);
        if (header.sample != sample)
            throw Failure(LENSPROF_ERROR_ARGUMENT, file + ": its samples are of another type than those of "
                                                       + scene.files[0] + "; give pictures with the same black level");
        levels = levels_of(o.levels, header, file);
    }
    return levels;
}

// A cropped picture shows the falloff of the lens about another centre, which one falloff for all does not model.
static void warn_of_other_shapes(const Scene &scene, const std::vector<PictureMetadata> &metadata, Events &events) {
    constexpr double kLargestDifference = 0.01;  // of the ratio of the sides: resized pictures are rounded
    const auto ratio = [&](uint32_t i) {
        const auto [shorter, longer] = std::minmax(metadata[i].size.width, metadata[i].size.height);
        return shorter > 0 ? double(longer) / shorter : 0.0;
    };
    const auto named = [&](uint32_t i) {
        return scene.files[i] + format(" (%u x %u pixels)", metadata[i].size.width, metadata[i].size.height);
    };
    const double wanted = ratio(scene.reference);
    for (uint32_t i = 0; i < metadata.size(); i++) {
        if (!(wanted > 0.0) || !(ratio(i) > 0.0) || std::fabs(ratio(i) / wanted - 1.0) <= kLargestDifference) continue;
        events.warn(named(i), "not of the shape of " + named(scene.reference)
                          + "; estimating one centre of the falloff for all; a cropped picture has another one: leave "
                            "it out");
        return;
    }
}

lensprof_profile_key profile_key(const SceneFitOptions &o, const Scene &scene,
                                 const std::vector<PictureMetadata> &metadata, Events &events) {
    const std::string &file = scene.files[scene.reference];
    warn_of_truncation(metadata[scene.reference], o.store, file, events);
    const PictureMetadata &reference = metadata[scene.reference];
    lensprof_profile_key key = override_key(reference.key, reference.size, o.store, file);
    if (!o.one_lens) return key;
    warn_of_other_shapes(scene, metadata, events);
    const LensSettings settings = lens_settings(scene, metadata, o.store, false);
    for (uint32_t first : settings.first)
        if (settings.of_image[first] != settings.of_image[scene.reference]) {
            events.warn(scene.files[first],
                        "lens, focal length, aperture or focus differ from " + file
                            + format("; estimating one falloff for all %zu settings", settings.first.size()));
            break;
        }
    return key;
}

DrawnPairs first_pairs(const SceneFitOptions &o, const Scene &scene, Events &progress) {
    SceneFit drawn(progress);
    get_points(o, scene, drawn);
    stop_if_cancelled();
    return {std::move(drawn.input.pairs), drawn.input.options.channels};
}

void fit_scene(const SceneFitOptions &o, Scene &scene, const std::vector<PictureMetadata> &metadata,
               const EarlierProfile &prior, SceneFit &state, Events &events) {
    BuildReport &report = state.report;
    FitInput &input = state.input;
    report.names = scene.names;
    report.left_out = scene.left_out;
    report.levels = scene.levels;
    report.register_s = scene.register_s;
    report.reference = o.reference.empty() ? scene.reference : image_of_word(scene, o.reference);
    input.options = scene_options(o, scene, input.fixed);
    report.prior_id = prior.id;
    report.no_prior = prior.reason;
    report.prior_is_composed = prior.is_composed;
    input.options.profile = prior.profile.get();
    check_unknowns(o, scene, input.options);
    state.settings = lens_settings(scene, metadata, o.store, o.one_lens);
    report.camera_kind = common_camera_kind(o, metadata, state.settings, report.camera_kind);
    input.options.camera_kind = report.camera_kind.kind;
    if (report.camera_kind.kind == LENSPROF_CAMERA_LINEAR) join_cameras(state.settings);  // all have one response
    check_cameras(scene, input.options.free, state.settings);
    Pictures pictures = get_points(o, scene, state);
    stop_if_cancelled();
    if (scene.by_matches && o.sampling == LENSPROF_SAMPLING_PAPER)
        events.warn(option_name("sampling_paper"),
                    "needs a camera model, which fits pictures of a moving camera poorly; omit it");
    input.images = fit_images(scene);
    state.item = o.points.empty() ? scene.path : o.points;
    set_settings(o, state, events);
    set_lens_facts(metadata, input.images);
    const bool is_linear = report.camera_kind.kind == LENSPROF_CAMERA_LINEAR;
    if (is_linear && o.points.empty() && scene.pairs.empty() && !state.settings.has_several_settings())
        warn_of_pedestal(scene, state, events);
    input.options.moving_camera = scene.by_matches;
    input.options.unlinked_images = static_cast<uint32_t>(scene.is_reconstruction ? 0 : scene.unlinked);
    if (o.points.empty()) report.exif = add_known_exposures(o.fit, scene, metadata, input.images, events);
    set_reference(report.reference, input);
    const auto setting_of = [&](uint32_t image) { return state.settings.of_image[image]; };
    if (prior.profile && setting_of(input.options.reference) != setting_of(scene.reference)) {
        input.options.profile = nullptr, report.prior_id = 0;
        report.no_prior = "the reference has another lens setting than " + scene.names[scene.reference];
    }
    state.best = fit(input, report.reference, state.item, state.events, &report.quality);
    const bool has_one_camera = !state.settings.has_several_cameras();  // irradiance is compared with one response
    if (has_one_camera && !pictures.empty() && may_connect_more(o, state.best, report.links))
        resample(o, scene, pictures, state);
    report_scene(scene, state);
    report.fit = state.best.result, report.held = state.best.held;
    report.verdict = state.best.verdict;
    for (Finding &finding : report.verdict.findings)
        if (finding.code == LENSPROF_REASON_WHITE_BALANCE_FIXED) finding.text += advice("fixed_balance");
    name_images(scene.names, report.verdict);
    if (o.points.empty()) name_sources(metadata, false, report.verdict);
    report_settings(o, scene, metadata, state);
    report_cameras(scene, metadata, state);
    report.exposures = state.best.exposures;
    if (state.best.reference != report.reference)
        events.warn(scene.names[report.reference],
                    "the reference was left out; exposures are relative to " + scene.names[state.best.reference]);
    report.reference = state.best.reference;
}

}  // namespace lensprof
