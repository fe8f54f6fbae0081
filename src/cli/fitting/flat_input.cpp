// The input of `lensprof flat`: pictures with their exposure, rotation, card and response.
#include <algorithm>
#include <cmath>
#include <set>

#include "cli/fitting/flat.hpp"
#include "cli/fitting/store_options.hpp"
#include "cli/program/message.hpp"
#include "cli/program/numbers.hpp"
#include "cli/program/progress.hpp"
#include "photo/base/format.hpp"
#include "photo/base/parallel.hpp"
#include "photo/base/paths.hpp"
#include "photo/calibration/known_exposures.hpp"
#include "photo/pictures/metadata.hpp"
#include "photo/pictures/named_pictures.hpp"
#include "photo/pictures/other_parts.hpp"
#include "photo/scene/scene_pictures.hpp"

namespace lensprof {
namespace {

constexpr double max_abs_ev = 64.0;
constexpr uint32_t min_side = 64;

std::vector<uint32_t> shots_of(const FlatCommand &o) {
    std::vector<uint32_t> shots;
    if (o.shots.empty()) {
        for (uint32_t i = 0; i < o.files.size(); i++) shots.push_back(i + 1);
        return shots;
    }
    require_count(o.shots.size(), "--shots", o.files.size(), "picture");
    return o.shots;
}

// The rotation per picture from that of the shots, in the order of their first pictures.
std::vector<double> rotations_of(const FlatCommand &o, const std::vector<uint32_t> &shots) {
    std::vector<uint32_t> order;
    for (uint32_t shot : shots)
        if (std::find(order.begin(), order.end(), shot) == order.end()) order.push_back(shot);
    std::vector<double> rotations(shots.size(), 0.0);
    if (o.rotation_deg.empty()) return rotations;
    require_count(o.rotation_deg.size(), "--rotation", order.size(), "shot");
    for (size_t i = 0; i < shots.size(); i++)
        rotations[i] =
            o.rotation_deg[static_cast<size_t>(std::find(order.begin(), order.end(), shots[i]) - order.begin())];
    return rotations;
}

// Exposures matter between pictures of one shot and, with a card at several places, between all.
bool needs_ev(const FlatCommand &o, const std::vector<uint32_t> &shots, size_t i) {
    return (o.several && shots.size() > 1) || std::count(shots.begin(), shots.end(), shots[i]) > 1;
}

std::vector<double> exposures_of(const FlatCommand &o, const std::vector<uint32_t> &shots,
                                 const std::vector<PictureMetadata> &metadata, Streams &streams) {
    std::vector<double> ev(shots.size(), 0.0);
    const std::vector<lensprof_known_exposure> stated =
        exif_exposures(metadata, std::vector<uint32_t>(shots.size(), 0));
    bool are_needed = false;
    if (!o.ev.empty()) require_count(o.ev.size(), "--ev", o.files.size(), "picture");
    if (!o.ev.empty()) ev = o.ev;
    for (size_t i = 0; i < ev.size(); i++) {
        if (o.ev.empty() && needs_ev(o, shots, i)) {
            if (std::isnan(stated[i].ev))
                throw Failure(LENSPROF_ERROR_ARGUMENT, o.files[i]
                                                   + ": EXIF does not state its exposure (time, aperture, ISO); give "
                                                     "the exposures of all pictures with --ev, for example 0,0,0 if "
                                                     "they are equal");
            ev[i] = stated[i].ev;
            are_needed = true;
        }
        if (!(std::fabs(ev[i]) <= max_abs_ev))
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          o.files[i] + ": an exposure beyond 64 EV is not plausible; check --ev or EXIF");
    }
    const std::string in_part = exif_use(stated, metadata, o.files).note;
    if (are_needed && !in_part.empty()) note(streams, o.files[0] + ": " + in_part + " (--ev gives them instead)");
    return ev;
}

// Whether the pictures are linear: by the command line, else if all are marked as linear. `o` has at most one response.
bool are_linear(const FlatCommand &o, const std::vector<PictureMetadata> &metadata) {
    if (o.linear || o.gamma || o.profile) return o.linear;
    for (size_t i = 0; i < metadata.size(); i++)
        if (metadata[i].processing_before != LENSPROF_PROCESSING_RAW)
            throw Failure(LENSPROF_ERROR_ARGUMENT, o.files[i] + ": is not marked as linear; give the response of the pictures "
                                                        "with --linear, --fit gamma=G or --fit profile=ID");
    return true;
}

// Pictures that only the command line declares linear are rendered ones for all other commands.
void note_linear(const PictureMetadata &first, const std::string &file, Streams &streams) {
    if (first.processing_before == LENSPROF_PROCESSING_RAW) return;
    note(streams, file
                      + (first.may_be_linear
                             ? ": is not marked as linear"
                             : ": is linear according to --linear, but not according to its colour profile or format")
                      + "; correct such pictures with `lensprof apply --key processing=raw`");
}

std::vector<lensprof_response> response_of(const FlatCommand &o) {
    std::vector<lensprof_response> response(1);
    lensprof_response_set_linear(response.data());
    if (o.gamma) check(lensprof_response_set_gamma(response.data(), *o.gamma), "--fit gamma");
    if (o.profile) {
        Store store = open_store(o.store.db, LENSPROF_STORE_READ);
        auto profile = new_profile();
        lensprof_error error{};
        check(lensprof_store_get(store.get(), o.profile, profile.get(), &error), store_path(o.store.db), &error);
        response.assign(profile->response, profile->response + profile->responses);
    }
    return response;
}

// The card's rectangle as a mask of the stored pixels.
std::vector<uint8_t> mask_of(const std::array<double, 4> &r, const Picture &picture, const std::string &file) {
    if (!(r[2] > 0 && r[3] > 0) || r[0] + r[2] > picture.frame_width || r[1] + r[3] > picture.frame_height)
        throw Failure(LENSPROF_ERROR_ARGUMENT, format("--card %g,%g,%g,%g", r[0], r[1], r[2], r[3])
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
uint32_t common_channels(const FlatCommand &o, const std::vector<Picture> &pictures) {
    const Picture &first = pictures.front();
    const uint32_t channels = lensprof_layout_channels(first.layout);
    for (size_t i = 0; i < pictures.size(); i++) {
        const Picture &p = pictures[i];
        if (p.frame_width != first.frame_width || p.frame_height != first.frame_height)
            throw Failure(
                LENSPROF_ERROR_READ,
                format("%s: is %u x %u px, not %u x %u as %s; give pictures of one camera, all in the same orientation",
                       o.files[i].c_str(), p.frame_width, p.frame_height, first.frame_width, first.frame_height,
                       o.files.front().c_str()));
        if (lensprof_layout_channels(p.layout) != channels)
            throw Failure(LENSPROF_ERROR_ARGUMENT, o.files[i] + ": is in colour and others are grey, or the reverse; give "
                                                        "pictures of one kind");
        if (std::max(p.width, p.height) < min_side)
            throw Failure(LENSPROF_ERROR_NOT_USABLE, o.files[i] + ": fewer than 64 px give too few cells; give larger "
                                                             "pictures",
                          LENSPROF_REASON_FLAT_FEW_CELLS);
    }
    return channels;
}

}  // namespace

void check_flat_options(const FlatCommand &o) {
    check_store_options(o.store);
    if (o.linear + o.gamma.has_value() + (o.profile != 0) > 1)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "give the response of the pictures with one of --linear, --fit gamma=G, --fit profile=ID");
    if (o.files.size() > LENSPROF_FLAT_IMAGES)
        throw Failure(LENSPROF_ERROR_ARGUMENT, std::to_string(o.files.size()) + " pictures; give at most "
                                                   + std::to_string(LENSPROF_FLAT_IMAGES));
    for (size_t i = 0; i < o.files.size(); i++)
        for (size_t j = 0; j < i; j++)
            if (is_same_file(o.files[i], o.files[j]))
                throw Failure(LENSPROF_ERROR_ARGUMENT, o.files[i] + ": given twice; give it once");
    if (!(o.black < o.white))
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--fit black: must be less than white; give a smaller value");
    if (o.max_side != 0 && o.max_side < min_side)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--fit max-side: fewer than 64 pixels give too few cells; give more, or 0 for full size");
    if (o.several && (o.light == LENSPROF_FLAT_LIGHT_PLANE || o.light == LENSPROF_FLAT_LIGHT_QUADRATIC))
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--several: assumes even light on the card; omit --fit light");
    if (o.find_card && !o.cards.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--card find and a rectangle exclude each other; give one of them");
    if (o.cards.size() > 1 && o.cards.size() != o.files.size())
        throw Failure(LENSPROF_ERROR_ARGUMENT, std::to_string(o.cards.size()) + " --card for "
                                                   + counted(o.files.size(), "picture")
                                                   + "; give one for all, or one per picture");
}

FlatInput prepare_flat(const FlatCommand &o, Streams &streams) {
    FlatInput input;
    lensprof_flat_options_init(&input.options);
    require_one_kind(o.files);
    Progress events(streams);
    note_several(o.files, events);
    std::vector<PictureMetadata> metadata;
    for (const auto &file : o.files) metadata.push_back(read_metadata(file));
    input.names = o.files;
    std::vector<uint32_t> shots = shots_of(o);
    std::vector<double> ev = exposures_of(o, shots, metadata, streams), rotations = rotations_of(o, shots);
    for (size_t i = 0; i < o.files.size(); i++) {
        lensprof_flat_image image;
        lensprof_flat_image_init(&image);
        image.shot = shots[i];
        image.ev = ev[i];
        image.rotation_deg = rotations[i];
        image.black = o.black;
        image.white = o.white;
        input.images.push_back(image);
    }
    input.response = response_of(o);
    if (are_linear(o, metadata)) {
        note_linear(metadata.front(), o.files.front(), streams);
        metadata.front().key.processing = LENSPROF_PROCESSING_RAW;
    }
    warn_of_truncation(metadata.front(), o.store, o.files.front(), events);
    input.key = override_key(metadata.front().key, metadata.front().size, o.store, o.files.front());
    auto &options = input.options;
    options.vignettings = o.falloff_curves;
    options.light = o.light;
    options.grid = o.grid;
    if (!o.free_center) options.free &= ~LENSPROF_FREE_CENTER;
    options.own_light = o.own_light;
    options.several = o.several;
    options.find_card = o.find_card;
    options.ev_sigma = o.ev_sigma;
    return input;
}

void read_flat(const FlatCommand &o, Progress &progress, FlatInput &input) {
    const size_t count = o.files.size();
    input.pictures.resize(count);
    input.masks.resize(count);
    for_each_parallel(static_cast<uint32_t>(count), "reading pictures", progress, [&](uint32_t i) {
        ReadOptions reduced;
        reduced.max_side = o.max_side;
        input.pictures[i] = read_picture(o.files[i], reduced);
    });
    input.options.channels = common_channels(o, input.pictures);
    if (input.options.channels == 1 && input.options.vignettings == 3)
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--fit falloff-curves=3: the pictures are grey; use 1");
    for (size_t i = 0; i < count; i++) {
        const Picture &picture = input.pictures[i];
        if (!o.cards.empty())
            input.masks[i] = mask_of(o.cards.size() == 1 ? o.cards.front() : o.cards[i], picture, o.files[i]);
        auto &image = input.images[i];
        image.view = picture.view();
        image.width = picture.frame_width;
        image.height = picture.frame_height;
        image.reduction = picture.reduction;
        image.mask = input.masks[i].empty() ? nullptr : input.masks[i].data();
        image.mask_row_bytes = static_cast<ptrdiff_t>(picture.width);
    }
    input.options.response = input.response.data();
    input.options.responses = static_cast<uint32_t>(input.response.size());
}

}  // namespace lensprof
