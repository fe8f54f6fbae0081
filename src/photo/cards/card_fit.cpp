#include "photo/cards/card_fit.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "photo/base/format.hpp"
#include "photo/base/lap.hpp"
#include "photo/calibration/fit.hpp"
#include "photo/cards/card_advice.hpp"
#include "photo/pictures/even_light.hpp"
#include "photo/pictures/orientation.hpp"
#include "photo/pictures/rotated_profile.hpp"

namespace lensprof {
namespace {

// JPEG rounds colours over blocks of 16 pixels, which averaging does not remove: no falloff per channel from JPEG.
void handle_lossy_pictures(const CardOptions &o, CardInput &input, Events &events) {
    for (size_t i = 0; i < input.pictures.size(); i++) {
        if (!input.pictures[i].traits.is_lossy) continue;
        if (o.falloff_curves == 0) input.options.vignettings = 1;
        const bool is_jpeg = input.pictures[i].traits.format == FileFormat::jpeg;
        events.warn(input.files[i],
                    std::string(is_jpeg ? "JPEG" : "its lossy compression")
                        + " rounds grey values and colours over blocks of pixels; the error of the falloff may exceed "
                          "the stated one by half a grey level of the card. Use raw files, or 16 bit TIFF or PNG");
        return;
    }
}

// No pedestal is below 0: the light changed its form between the exposures, or a program subtracted too much.
void warn_of_negative_black(const CardInput &input, const lensprof_flat_result &fit, Events &events) {
    constexpr double clear = 5.0;  // standard errors
    const bool is_raw = input.pictures.front().traits.format == FileFormat::raw;
    if (is_raw || !fit.black_shown || fit.black_offset > -clear * fit.black_sigma) return;
    events.warn(
        input.files.front(),
        format("the exposures show a black level of %.2f %%, below 0: a program subtracted too much, or the light "
               "changed between them; if it is 0, state it with %s",
               100.0 * fit.levels.black[1], option_name("black").c_str()));
}

// What is known before the fit.
CardFit begun(const CardInput &input) {
    CardFit fit;
    fit.files = input.files;
    fit.response = input.response;
    fit.key = input.key;
    for (const auto &image : input.images) {
        fit.shots.push_back(image.shot);
        fit.ev.push_back(image.ev);
        fit.rotated.push_back(image.rotation_deg);
    }
    if (const lensprof_flat_image &first = input.images.front(); first.height > 0) {
        fit.aspect = static_cast<double>(first.width) / first.height;
        fit.width = first.width, fit.height = first.height;
    }
    fit.quality.resize(input.images.size());
    lensprof_flat_result_init(&fit.fit);
    return fit;
}

// The orientation that turns the pictures to the frame of the sensor; 0: unknown.
uint16_t turn_of(const CardInput &input) {
    const lensprof_flat_image &frame = input.images.front();
    return sensor_orientation(frame.width, frame.height, input.pictures.front().traits.orientation);
}

// The profile in the frame of the sensor.
std::shared_ptr<lensprof_profile> sensor_profile(const CardInput &input, const lensprof_flat &flat, uint16_t turn,
                                                 Events &events) {
    std::shared_ptr<lensprof_profile> profile = profile_of(flat);
    profile->key = input.key;
    if (!turn)
        events.note(input.files.front(),
                    "no orientation states which way this portrait picture was rotated: the profile "
                    "is stored with its centre in the middle of the frame, and without what differs "
                    "between opposite sides; give the pictures as the camera wrote them");
    turn_profile_to_sensor(turn, *profile);
    return profile;
}

}  // namespace

CardFit fit_cards(const CardOptions &o, CardInput &input, Events &events) {
    auto clock = std::chrono::steady_clock::now();
    read_cards(o, input, events);
    events.clear();
    handle_lossy_pictures(o, input, events);
    stop_if_cancelled();
    CardFit found = begun(input);
    found.load_s = lap(clock);
    input.options.progress = on_fit_progress;
    input.options.progress_user = &events;
    lensprof_error error{};
    lensprof_flat *flat = nullptr;
    const auto count = static_cast<uint32_t>(input.images.size());
    const lensprof_status status =
        lensprof_fit_flat(&input.options, input.images.data(), count, nullptr, 0, &flat, &error);
    found.held = {flat, lensprof_flat_destroy};
    events.clear();
    try {
        check_named(status, input.files.size() == 1 ? input.files[0] : input.files[0] + " and the others", error,
                    LENSPROF_ITEM_IMAGE, input.files);
    } catch (const Failure &failure) {
        if (failure.group() != LENSPROF_ERROR_NOT_USABLE) throw;
        throw Failure(failure.status, failure.what() + advice_without_fit(o, input), failure.reason);
    }
    check(lensprof_flat_get(flat, &found.fit, &error), "fit", &error);
    for (uint32_t i = 0; i < count; i++) {
        lensprof_flat_image_quality_init(&found.quality[i]);
        check(lensprof_flat_image_at(flat, i, &found.quality[i], &error), "fit", &error);
    }
    found.solve_s = lap(clock);
    warn_of_negative_black(input, found.fit, events);
    found.verdict = verdict_of(flat);
    name_images(found.files, found.verdict);
    name_shots(found.files, found.shots, found.verdict);
    for (size_t i = 0; i < input.pictures.size() && !found.fit.usable; i++)
        found.shows_even_light.push_back(shows_even_light(input.pictures[i]));
    add_advice(o, input, found, events);
    const uint16_t turn = turn_of(input);
    found.is_turn_unknown = !turn;
    found.profile = sensor_profile(input, *flat, turn, events);
    return found;
}

CardFit failed_fit(const CardInput &input, const Failure &failure) {
    CardFit found = begun(input);
    found.fit.vignettings = 1;
    found.fit.corner_sigma = NAN;
    found.verdict.refuse(LENSPROF_REASON_FLAT_FEW_CELLS, failure.what());
    return found;
}

void store_fit(const StoreOptions &o, CardFit &fit) {
    fit.profile_id = store_profile(o, *fit.profile, {"flat", fit.files.front(), fit.fit.usable != 0});
}

}  // namespace lensprof
