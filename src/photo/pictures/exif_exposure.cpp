#include "photo/pictures/exif_exposure.hpp"

#include <algorithm>
#include <cmath>

#include <lensprof/exposure_settings.h>

#include "photo/pictures/exif_tags.hpp"
#include "photo/pictures/exif_value.hpp"

namespace lensprof {
namespace {

using exif_tags::in_image;

constexpr uint16_t kManual = 1;  // EXIF 2.32 section 4.6.5, of ExposureProgram and of ExposureMode alike

// EXIF 2.32 section 4.6.5: APEX values Tv = -log2(time), Av = 2 log2(f-number).
std::optional<double> read_exposure_time(const Exif &exif) {
    const double time = read_number(exif, {exif_tags::exposure_time, in_image(exif_tags::exposure_time)});
    const double apex = read_number(exif, {exif_tags::shutter_speed, in_image(exif_tags::shutter_speed)});
    const std::optional<double> stated = in_range(time, 1e6);
    if (time == 0 && apex == 0) return std::nullopt;  // written for an unknown time
    return stated ? stated : in_range(std::exp2(-apex), 1e6);
}

std::optional<double> read_f_number(const Exif &exif) {
    const double stated = read_number(exif, {exif_tags::f_number, in_image(exif_tags::f_number)});
    const double apex = read_number(exif, {exif_tags::aperture, in_image(exif_tags::aperture)});
    if (in_range(stated, 1000)) return stated;
    return apex > 0 ? in_range(std::exp2(apex / 2), 1000) : std::nullopt;
}

// MaxApertureValue (APEX) is the widest of the lens at the focal length of the picture (EXIF 2.32 section 4.6.5);
// LensSpecification states those of the shortest and the longest focal length, for one lens both.
std::optional<double> read_open_f_number(const Exif &exif) {
    const double apex = read_number(exif, {exif_tags::max_aperture, in_image(exif_tags::max_aperture)});
    if (apex > 0) return in_range(std::exp2(apex / 2), 1000);
    const ExifField *lens = exif.find(exif_tags::lens_specification);
    const double shortest = number_of(lens, exif.order, 2), longest = number_of(lens, exif.order, 3);
    return shortest == longest ? in_range(shortest, 1000) : std::nullopt;
}

// The number that SensitivityType names (EXIF 2.32 section 4.6.5): standard output sensitivity, recommended exposure
// index or ISO speed, the last of these if there are several.
std::optional<double> read_sensitivity(const Exif &exif) {
    const double type = read_number(exif, {exif_tags::sensitivity_type, in_image(exif_tags::sensitivity_type)});
    const ExifTag tag = type == 1                ? exif_tags::output_sensitivity
                        : type == 2 || type == 4 ? exif_tags::exposure_index
                                                 : exif_tags::iso_speed;
    return type >= 1 && type <= 7 ? in_range(read_number(exif, {tag, in_image(tag)}), 1e8) : std::nullopt;
}

// ISOSpeedRatings has 16 bits; 65535 means a larger value.
std::optional<double> read_iso(const Exif &exif, std::optional<double> maker_iso) {
    std::optional<double> iso;
    for (const ExifTag tag : {exif_tags::iso_speed_ratings, in_image(exif_tags::iso_speed_ratings)})
        if (!iso) iso = in_range(read_number(exif, {tag}), 1e8);
    if (!iso) iso = maker_iso;
    if (iso && *iso != 65535) return iso;
    const std::optional<double> sensitivity = read_sensitivity(exif);
    return sensitivity ? sensitivity : iso;
}

// Cameras write one tag or both; if they disagree (a program that the camera has no number for, manual bracketing), the
// one stating manual exposure is right.
bool read_is_manual(const Exif &exif) {
    return read_number(exif, {exif_tags::exposure_program, in_image(exif_tags::exposure_program)}) == kManual
           || read_number(exif, {exif_tags::exposure_mode}) == kManual;
}

// Without the fraction of a second, frames of a burst have the same time.
std::string read_captured(const Exif &exif) {
    const std::string time = read_text(exif, exif_tags::captured),
                      digits = read_text(exif, exif_tags::captured_fraction);
    return time.empty() || digits.find_first_of("123456789") == std::string::npos ? "" : time + "." + digits;
}

}  // namespace

void read_exposure(const Exif &exif, std::optional<double> maker_iso, PictureMetadata &metadata) {
    metadata.f_number = read_f_number(exif);
    metadata.open_f_number = read_open_f_number(exif);
    metadata.exposure_time_s = read_exposure_time(exif);
    metadata.iso = read_iso(exif, maker_iso);
    metadata.captured = read_captured(exif);
    metadata.is_manual = read_is_manual(exif);
    if (metadata.exposure_time_s && metadata.iso && metadata.f_number)
        metadata.exif_ev = lensprof_settings_ev(*metadata.exposure_time_s, *metadata.f_number, *metadata.iso);
}

void write_exposure(const PictureMetadata &metadata, Exif &exif) {
    set_rational(exif, exif_tags::f_number, metadata.key.aperture);
    set_rational(exif, exif_tags::exposure_time, metadata.exposure_time_s.value_or(LENSPROF_UNKNOWN));
    if (metadata.exposure_time_s) exif.erase(exif_tags::shutter_speed);  // states the old exposure time
    if (metadata.iso && *metadata.iso >= 0.5) {                          // 16 bits; 65535 means a larger value
        const auto iso = static_cast<uint32_t>(std::lround(*metadata.iso));
        exif.set_number(exif_tags::iso_speed_ratings, tiff_short, std::min(iso, 65535u));
        if (iso >= 65535) {
            exif.set_number(exif_tags::sensitivity_type, tiff_short, 3);  // what ISOSpeed is
            exif.set_number(exif_tags::iso_speed, tiff_long, iso);
        }
    }
    if (!metadata.captured.empty()) {  // both parts, so that no fraction of another time stays
        const size_t point = std::min(metadata.captured.find('.'), metadata.captured.size());
        exif.set_text(exif_tags::captured, metadata.captured.substr(0, point));
        exif.erase(exif_tags::captured_fraction);
        if (point < metadata.captured.size())
            exif.set_text(exif_tags::captured_fraction, metadata.captured.substr(point + 1));
    }
    if (!metadata.is_manual) return;
    exif.set_number(exif_tags::exposure_program, tiff_short, kManual);
    exif.set_number(exif_tags::exposure_mode, tiff_short, kManual);
}

}  // namespace lensprof
