#include "photo/pictures/exif_exposure.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

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

// Days from 1970-01-01 (proleptic Gregorian calendar).
int64_t days_of(int64_t year, int64_t month, int64_t day) {
    const int64_t y = month > 2 ? year : year - 1, era = (y >= 0 ? y : y - 399) / 400, of_era = y - era * 400;
    const int64_t of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
    return era * 146097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719468;
}

std::optional<double> read_taken(const Exif &exif) {
    int year, month, day, hour, minute, second;
    const std::string time = read_text(exif, exif_tags::captured);
    if (std::sscanf(time.c_str(), "%4d:%2d:%2d %2d:%2d:%2d", &year, &month, &day, &hour, &minute, &second) != 6
        || year < 1 || month < 1 || month > 12 || day < 1 || day > 31)
        return std::nullopt;
    double fraction = 0.0, unit = 0.1;
    for (const char digit : read_text(exif, exif_tags::captured_fraction)) {
        if (digit < '0' || digit > '9') break;
        fraction += unit * (digit - '0'), unit /= 10.0;
    }
    return static_cast<double>(((days_of(year, month, day) * 24 + hour) * 60 + minute) * 60 + second) + fraction;
}

}  // namespace

void read_exposure(const Exif &exif, std::optional<double> maker_iso, PictureMetadata &metadata) {
    metadata.f_number = read_f_number(exif);
    metadata.open_f_number = read_open_f_number(exif);
    metadata.exposure_time_s = read_exposure_time(exif);
    metadata.iso = read_iso(exif, maker_iso);
    metadata.captured = read_captured(exif);
    metadata.taken_s = read_taken(exif);
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
