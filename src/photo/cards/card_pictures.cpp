// The input of a fit of cards: pictures with their exposure, rotation, card and response.
#include "photo/cards/card_pictures.hpp"

#include <algorithm>
#include <cmath>

#include "photo/base/databases.hpp"
#include "photo/base/format.hpp"
#include "photo/base/parallel.hpp"
#include "photo/base/paths.hpp"
#include "photo/calibration/known_exposures.hpp"
#include "photo/cards/count_samples.hpp"
#include "photo/cards/saturated_samples.hpp"
#include "photo/pictures/named_pictures.hpp"
#include "photo/pictures/other_parts.hpp"
#include "photo/pictures/picture_levels.hpp"
#include "photo/scene/scene_pictures.hpp"

namespace lensprof {
namespace {

constexpr double max_abs_ev = 64.0;

std::vector<uint32_t> shots_of(const CardOptions &o, size_t pictures) {
    std::vector<uint32_t> shots;
    if (o.shots.empty()) {
        for (uint32_t i = 0; i < pictures; i++) shots.push_back(i + 1);
        return shots;
    }
    require_count(o.shots.size(), option_name("shots"), pictures, "picture");
    return o.shots;
}

// By EXIF's orientation, which cameras measure. Failure if it is the same for all.
std::vector<double> rotations_of_exif(const std::vector<std::string> &files,
                                      const std::vector<PictureMetadata> &metadata) {
    std::vector<double> rotations;
    for (const PictureMetadata &picture : metadata)
        rotations.push_back(picture.orientation == 6   ? 90.0
                            : picture.orientation == 3 ? 180.0
                            : picture.orientation == 8 ? 270.0
                                                       : 0.0);
    const auto is_first = [&](double rotation) { return rotation == rotations.front(); };
    if (std::all_of(rotations.begin(), rotations.end(), is_first))
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      files.front() + ": the orientation that EXIF states is the same for all pictures of this setting; "
                                      "turn the camera between the shots, or give the angles with "
                          + option_name("rotation"));
    return rotations;
}

// The rotation per picture from that of the shots, in the order of their first pictures.
std::vector<double> rotations_of(const CardOptions &o, const std::vector<uint32_t> &shots) {
    std::vector<uint32_t> order;
    for (uint32_t shot : shots)
        if (std::find(order.begin(), order.end(), shot) == order.end()) order.push_back(shot);
    std::vector<double> rotations(shots.size(), 0.0);
    if (o.rotation_deg.empty()) return rotations;
    require_count(o.rotation_deg.size(), option_name("rotation"), order.size(), "shot");
    for (size_t i = 0; i < shots.size(); i++)
        rotations[i] =
            o.rotation_deg[static_cast<size_t>(std::find(order.begin(), order.end(), shots[i]) - order.begin())];
    return rotations;
}

// Exposures matter between pictures of one shot and, with a card at several places, between all.
bool needs_ev(const CardOptions &o, const std::vector<uint32_t> &shots, size_t i) {
    return (o.several && shots.size() > 1) || std::count(shots.begin(), shots.end(), shots[i]) > 1;
}

std::vector<double> exposures_of(const CardOptions &o, const std::vector<std::string> &files,
                                 const std::vector<uint32_t> &shots, const std::vector<PictureMetadata> &metadata,
                                 Events &events) {
    std::vector<double> ev(shots.size(), 0.0);
    const std::vector<lensprof_known_exposure> stated =
        exif_exposures(metadata, std::vector<uint32_t>(shots.size(), 0));
    bool are_needed = false;
    if (!o.ev.empty()) require_count(o.ev.size(), option_name("ev"), files.size(), "picture");
    if (!o.ev.empty()) ev = o.ev;
    for (size_t i = 0; i < ev.size(); i++) {
        if (o.ev.empty() && needs_ev(o, shots, i)) {
            if (std::isnan(stated[i].ev))
                throw Failure(LENSPROF_ERROR_ARGUMENT, files[i]
                                                   + ": EXIF does not state its exposure (time, aperture, ISO); give "
                                                     "the exposures of all pictures with "
                                                   + option_name("ev") + ", for example 0,0,0 if they are equal");
            ev[i] = stated[i].ev;
            are_needed = true;
        }
        if (!(std::fabs(ev[i]) <= max_abs_ev))
            throw Failure(LENSPROF_ERROR_ARGUMENT, files[i] + ": an exposure beyond 64 EV is not plausible; check "
                                                       + option_name("ev") + " or EXIF");
    }
    const std::string in_part = exif_use(stated, metadata, files).note;
    if (are_needed && !in_part.empty())
        events.note(files[0], in_part + " (" + option_name("ev") + " gives them instead)");
    return ev;
}

// Whether the pictures are linear: as stated, else if all are marked as linear. `o` has at most one response.
bool are_linear(const CardOptions &o, const std::vector<PictureMetadata> &metadata) {
    if (o.linear || o.gamma || o.profile) return o.linear;
    return std::all_of(metadata.begin(), metadata.end(), [](const PictureMetadata &picture) {
        return picture.processing_before == LENSPROF_PROCESSING_RAW;
    });
}

// The response that the databases have for the camera of a rendered picture. Failure without one.
std::vector<lensprof_response> stored_response(const StoreOptions &o, const PictureMetadata &metadata,
                                               const std::string &file, Events &events) {
    const std::vector<std::string> files = existing_databases(o.dbs);
    lensprof_lookup_options options;
    lensprof_lookup_options_init(&options);
    options.response_alone = 1;
    lensprof_lookup lookup;
    lensprof_lookup_init(&lookup);
    auto profile = new_profile();
    const bool is_found = !files.empty() && *metadata.key.camera_model
                          && Databases(files).look_up(metadata.key, options, *profile, lookup) == LENSPROF_OK
                          && (lookup.response_from == LENSPROF_RESPONSE_FROM_PROFILE
                              || lookup.response_from == LENSPROF_RESPONSE_FROM_CAMERA);
    if (!is_found)
        throw Failure(LENSPROF_ERROR_ARGUMENT, file + ": is not marked as linear, and no database has the response of its "
                                                      "camera; give the response of the pictures with "
                                                   + option_name("linear") + ", " + option_name("gamma") + " or "
                                                   + option_name("response_profile"));
    events.note(file, "is not linear: its response is that of the camera in the database"
                          + (lookup.response_sigma > 0.0
                                 ? format(", whose exponent is known to %.0f %%", 100.0 * lookup.response_sigma)
                                 : std::string()));
    return {profile->response, profile->response + profile->responses};
}

// Pictures that only the caller declares linear are rendered ones for everything else.
void note_linear(const PictureMetadata &first, const std::string &file, Events &events) {
    if (first.processing_before == LENSPROF_PROCESSING_RAW) return;
    events.note(file, (first.may_be_linear ? "is not marked as linear"
                                           : "is linear according to " + option_name("linear")
                                                 + ", but not according to its colour profile or format")
                          + advice("linear_pictures"));
}

// The card's rectangle as a mask of the stored pixels.
std::vector<uint8_t> mask_of(const std::array<double, 4> &r, const Picture &picture, const std::string &file) {
    if (!(r[2] > 0 && r[3] > 0) || r[0] + r[2] > picture.frame_width || r[1] + r[3] > picture.frame_height)
        throw Failure(LENSPROF_ERROR_ARGUMENT, option_name("card") + format(" %g,%g,%g,%g", r[0], r[1], r[2], r[3])
                                                   + ": not a rectangle X,Y,WIDTH,HEIGHT in the "
                                                   + std::to_string(picture.frame_width) + " x "
                                                   + std::to_string(picture.frame_height) + " px of " + file);
    std::vector<uint8_t> mask(static_cast<size_t>(picture.width) * picture.height);
    const double side = picture.reduction;
    for (uint32_t y = 0; y < picture.height; y++)
        for (uint32_t x = 0; x < picture.width; x++)
            mask[static_cast<size_t>(y) * picture.width + x] =
                x * side >= r[0] && (x + 1) * side <= r[0] + r[2] && y * side >= r[1] && (y + 1) * side <= r[1] + r[3];
    return mask;
}

// All pictures must have the same frame and kind; Failure names the one that differs.
uint32_t common_channels(const std::vector<std::string> &files, const std::vector<Picture> &pictures) {
    const Picture &first = pictures.front();
    const uint32_t channels = lensprof_layout_channels(first.layout);
    for (size_t i = 0; i < pictures.size(); i++) {
        const Picture &p = pictures[i];
        if (p.frame_width != first.frame_width || p.frame_height != first.frame_height)
            throw Failure(
                LENSPROF_ERROR_READ,
                format("%s: is %u x %u px, not %u x %u as %s; give pictures of one camera, all in the same orientation",
                       files[i].c_str(), p.frame_width, p.frame_height, first.frame_width, first.frame_height,
                       files.front().c_str()));
        if (lensprof_layout_channels(p.layout) != channels)
            throw Failure(LENSPROF_ERROR_ARGUMENT, files[i] + ": is in colour and others are grey, or the reverse; give "
                                                        "pictures of one kind");
        if (std::max(p.width, p.height) < least_card_side)
            throw Failure(LENSPROF_ERROR_NOT_USABLE, files[i] + ": fewer than 64 px give too few cells; give larger "
                                                             "pictures",
                          LENSPROF_REASON_FLAT_FEW_CELLS);
    }
    return channels;
}

// A level that nobody stated may be a pedestal of 64 of 1023 or 256 of 4095: 6 %, two standard errors. That of raw
// files is known to about two steps of 12 bit.
constexpr double unknown_black_sigma = 0.03, file_black_sigma = 0.0005;

bool has_linear_response(const CardInput &input) {
    return std::all_of(input.response.begin(), input.response.end(),
                       [](const lensprof_response &r) { return r.kind == LENSPROF_RESPONSE_LINEAR; });
}

StatedLevels levels_of_file(const PictureMetadata &metadata) {
    StatedLevels levels;
    if (metadata.black_level)
        for (const double black : *metadata.black_level)  // below one code it is nothing
            levels.black.push_back({black < 1.0 ? 0.0 : black, false});
    if (metadata.white_level) levels.white = {*metadata.white_level, false};
    return levels;
}

// Adds what a file states, or notes that it does not suit its samples.
bool add_levels(const StatedLevels &added, const Picture &first, const std::string &file, const LevelScale &scale,
                lensprof_levels &levels, Events &events) {
    try {
        levels = levels_of(added, first, file, levels, scale);
    } catch (const Failure &) {
        events.note(file, "its tags BlackLevel and WhiteLevel do not suit its samples, and are ignored");
        return false;
    }
    if (!added.black.empty())
        events.note(file, format("its black level of %g is subtracted, as the file states", added.black[1].number));
    if (added.white) events.note(file, format("its white level is %g, as the file states", added.white->number));
    return true;
}

// Divides float counts by that at saturation, which is full scale then. Returns it; nothing for other samples.
std::optional<double> scale_counts(CardInput &input, StatedLevels &stated, Events &events) {
    const auto counts = std::find_if(input.pictures.begin(), input.pictures.end(), are_counts);
    const auto i = counts == input.pictures.end() ? 0 : static_cast<size_t>(counts - input.pictures.begin());
    const auto count = count_at_white(stated, input.levels, input.pictures[i], input.files[i], events);
    if (!count) return count;
    for (Picture &picture : input.pictures) divide_samples(*count, picture);
    for (StatedLevels *levels : {&stated, &input.levels})
        if (levels->white && !levels->white->is_share) levels->white.reset();
    return count;
}

// Grey values below which cells are left out. Steps of 8 bit, tone curves and an unknown black level change darker
// ones; of finer linear samples above a known black level, only noise does.
constexpr double usual_darkest = 2.0 / 255.0, least_darkest = 0.2 / 255.0;

void ignore_below(double darkest, CardInput &input) {
    for (lensprof_flat_image &image : input.images) image.black = darkest;
}

// Levels of the samples, and how well they are known: as stated, of dark frames, or as the file states.
void take_levels(const CardOptions &o, CardInput &input, Events &events) {
    StatedLevels stated = o.levels;
    const std::optional<double> count = scale_counts(input, stated, events);
    const Picture &first = input.pictures.front();
    const LevelScale scale = count ? LevelScale{*count, true} : LevelScale::of(first);
    const std::string &file = input.files.front();
    lensprof_flat_options &options = input.options;
    for (size_t i = 1; i < input.pictures.size() && o.levels.any(); i++)
        if (input.pictures[i].sample != first.sample)
            throw Failure(LENSPROF_ERROR_ARGUMENT, input.files[i] + ": its samples are of another type than those of "
                                                       + file + "; give pictures with the same black level");
    std::optional<DarkLevel> dark;
    if (o.dark) {
        dark = dark_level_for(*o.dark, {scale.full_scale, true, scale.has_counts()}, first, file, events);
        std::copy(dark->black.begin(), dark->black.end(), options.levels.black);
    }
    options.levels = levels_of(stated, first, file, options.levels, scale);
    const bool are_codes = first.sample == LENSPROF_SAMPLE_U8 || first.sample == LENSPROF_SAMPLE_U16 || count;
    StatedLevels added;  // by the file
    if (has_linear_response(input) && are_codes) {
        if (stated.black.empty() && !o.dark) added.black = input.levels.black;
        if (!stated.white) added.white = input.levels.white;
    }
    if (added.any() && !add_levels(added, first, file, scale, options.levels, events)) added = {};
    ignore_below(o.ignore_below.value_or(usual_darkest), input);
    if (!has_linear_response(input)) return;
    const bool is_stated_by_file = first.traits.format == FileFormat::raw || !added.black.empty();
    const bool is_known = dark || !o.levels.black.empty() || is_stated_by_file;
    if (is_known && first.sample != LENSPROF_SAMPLE_U8) ignore_below(o.ignore_below.value_or(least_darkest), input);
    options.black_sigma = dark                      ? std::clamp(dark->sigma, 1e-6, 0.2)
                          : !o.levels.black.empty() ? 0.0
                          : is_stated_by_file       ? file_black_sigma
                                                    : unknown_black_sigma;
}

void require_black_below_cards(const CardInput &input) {
    for (size_t i = 0; i < input.pictures.size(); i++) {
        const uint32_t green = lensprof_layout_channels(input.pictures[i].layout) / 2;
        require_black_below(input.pictures[i], green, input.options.levels, input.files[i], option_name("black"));
    }
}

// Samples that saturate below white are white.
void find_saturated(CardInput &input, Events &events) {
    bool is_noted = false;
    for (size_t i = 0; i < input.pictures.size() && has_linear_response(input); i++) {
        const std::optional<double> largest = saturated_sample(input.pictures[i]);
        if (!largest) continue;
        constexpr double half_code = 0.5 / 65535.0;
        const double white = lensprof_levels_to_value(&input.options.levels, 1, *largest - half_code);
        if (!(white < input.images[i].white)) continue;
        input.images[i].white = white;
        if (!is_noted)
            events.note(input.files[i], format("many of its samples are %.0f of 65535, and none are larger: they are "
                                               "taken as saturated; state the white level with %s",
                                               *largest * 65535.0, option_name("white_level").c_str()));
        is_noted = true;
    }
}

}  // namespace

CardInput prepare_cards(const CardOptions &o, const std::vector<CardPicture> &pictures, Events &events) {
    std::vector<std::string> files;
    std::vector<PictureMetadata> metadata;
    for (const CardPicture &picture : pictures) files.push_back(picture.file), metadata.push_back(picture.metadata);
    CardInput input;
    lensprof_flat_options_init(&input.options);
    require_one_kind(files);
    if (o.cards.size() > 1) require_count(o.cards.size(), option_name("card"), files.size(), "picture");
    note_several(files, events, advice("several_cards"));
    input.files = files;
    std::vector<uint32_t> shots = shots_of(o, files.size());
    const std::vector<double> ev = exposures_of(o, files, shots, metadata, events),
                              rotations = o.turned ? rotations_of_exif(files, metadata) : rotations_of(o, shots);
    for (size_t i = 0; i < files.size(); i++) {
        lensprof_flat_image image;
        lensprof_flat_image_init(&image);
        image.shot = shots[i];
        image.ev = ev[i];
        image.rotation_deg = rotations[i];
        image.white = o.ignore_above;
        input.images.push_back(image);
    }
    input.response = given_response(o.store, o.gamma, o.profile);
    input.levels = levels_of_file(metadata.front());
    if (are_linear(o, metadata)) {
        note_linear(metadata.front(), files.front(), events);
        if (metadata.front().corrected_by.empty()) metadata.front().key.processing = LENSPROF_PROCESSING_RAW;
    } else if (!o.gamma && !o.profile) {
        input.response = stored_response(o.store, metadata.front(), files.front(), events);
    }
    warn_of_truncation(metadata.front(), o.store, files.front(), events);
    input.key = override_key(metadata.front().key, metadata.front().size, o.store, files.front());
    auto &options = input.options;
    options.vignettings = o.falloff_curves;
    options.light = o.light;
    options.grid = o.grid;
    if (!o.free_center) options.free &= ~LENSPROF_FREE_CENTER;
    options.own_light = o.own_light;
    options.several = o.several;
    options.find_card = o.find_card;
    options.ev_sigma = o.ev_sigma;
    options.threads = o.threads;
    return input;
}

void read_cards(const CardOptions &o, CardInput &input, Events &events) {
    const size_t count = input.files.size();
    input.pictures.resize(count);
    input.masks.resize(count);
    ReadOptions reduced;
    reduced.max_side = o.max_side;
    const auto number = static_cast<uint32_t>(count);
    for_each_in_order(
        number, thread_count(o.threads), [&](uint32_t i) { input.pictures[i] = read_picture(input.files[i], reduced); },
        [&](uint32_t i) { events.update_items("reading pictures", i + 1, number); });
    input.options.channels = common_channels(input.files, input.pictures);
    if (input.options.channels == 1 && input.options.vignettings == 3)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      option_name("falloff_curves") + ": 3 falloff curves, but the pictures are grey; use 1");
    for (size_t i = 0; i < count; i++) {
        const Picture &picture = input.pictures[i];
        if (!o.cards.empty())
            input.masks[i] = mask_of(o.cards.size() == 1 ? o.cards.front() : o.cards[i], picture, input.files[i]);
        auto &image = input.images[i];
        image.view = picture.view();
        image.width = picture.frame_width;
        image.height = picture.frame_height;
        image.reduction = picture.reduction;
        image.mask = input.masks[i].empty() ? nullptr : input.masks[i].data();
        image.mask_row_bytes = static_cast<ptrdiff_t>(picture.width);
    }
    take_levels(o, input, events);
    if (!o.levels.black.empty() || o.dark) require_black_below_cards(input);
    find_saturated(input, events);
    input.options.response = input.response.data();
    input.options.responses = static_cast<uint32_t>(input.response.size());
}

}  // namespace lensprof
