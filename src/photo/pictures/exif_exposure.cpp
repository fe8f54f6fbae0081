#include "photo/pictures/exif_exposure.hpp"

#include <cmath>
#include <cstdlib>

#include "photo/pictures/exif_value.hpp"

namespace lensprof {
namespace {

constexpr uint16_t kManual = 1;  // EXIF 2.32 section 4.6.5, of ExposureProgram and of ExposureMode alike

// EXIF 2.32 section 4.6.5: APEX values Tv = -log2(time), Av = 2 log2(f-number).
std::optional<double> read_exposure_time(const Exiv2::ExifData &exif) {
    const double time = read_number(exif, {"Exif.Photo.ExposureTime", "Exif.Image.ExposureTime"});
    const double apex = read_number(exif, {"Exif.Photo.ShutterSpeedValue", "Exif.Image.ShutterSpeedValue"});
    const std::optional<double> stated = in_range(time, 1e6);
    if (time == 0 && apex == 0) return std::nullopt;  // written for an unknown time
    return stated ? stated : in_range(std::exp2(-apex), 1e6);
}

std::optional<double> read_f_number(const Exiv2::ExifData &exif) {
    const double stated = read_number(exif, {"Exif.Photo.FNumber", "Exif.Image.FNumber"});
    const double apex = read_number(exif, {"Exif.Photo.ApertureValue", "Exif.Image.ApertureValue"});
    if (in_range(stated, 1000)) return stated;
    return apex > 0 ? in_range(std::exp2(apex / 2), 1000) : std::nullopt;
}

// MaxApertureValue (APEX) is the widest of the lens at the focal length of the picture (EXIF 2.32 section 4.6.5);
// LensSpecification states those of the shortest and the longest focal length, for one lens both.
std::optional<double> read_open_f_number(const Exiv2::ExifData &exif) {
    const double apex = read_number(exif, {"Exif.Photo.MaxApertureValue", "Exif.Image.MaxApertureValue"});
    if (apex > 0) return in_range(std::exp2(apex / 2), 1000);
    const auto lens = exif.findKey(Exiv2::ExifKey("Exif.Photo.LensSpecification"));
    if (lens == exif.end() || lens->count() < 4 || lens->toFloat(2) != lens->toFloat(3)) return std::nullopt;
    return in_range(lens->toFloat(2), 1000);
}

// Exiv2 knows where makers store it; the readable form is the standard number, the raw one often is not.
std::optional<double> read_iso(const Exiv2::ExifData &exif) {
    const auto datum = Exiv2::isoSpeed(exif);
    if (datum == exif.end()) return std::nullopt;
    return in_range(std::strtod(datum->print(&exif).c_str(), nullptr), 1e8);
}

// Cameras write one tag or both; if they disagree (a program that the camera has no number for, manual bracketing), the
// one stating manual exposure is right.
bool read_is_manual(const Exiv2::ExifData &exif) {
    return read_number(exif, {"Exif.Photo.ExposureProgram", "Exif.Image.ExposureProgram"}) == kManual
           || read_number(exif, {"Exif.Photo.ExposureMode"}) == kManual;
}

// Without the fraction of a second, frames of a burst have the same time.
std::string read_captured(const Exiv2::ExifData &exif) {
    const auto time = exif.findKey(Exiv2::ExifKey("Exif.Photo.DateTimeOriginal")),
               fraction = exif.findKey(Exiv2::ExifKey("Exif.Photo.SubSecTimeOriginal"));
    if (time == exif.end() || fraction == exif.end()) return {};
    const std::string digits = fraction->toString();
    return digits.find_first_of("123456789") == std::string::npos ? "" : time->toString() + "." + digits;
}

}  // namespace

double exposure_ev(double time_s, double iso, double f_number) {
    return std::log2(time_s * iso / 100 / (f_number * f_number));
}

void read_exposure(const Exiv2::ExifData &exif, PictureMetadata &metadata) {
    metadata.f_number = read_f_number(exif);
    metadata.open_f_number = read_open_f_number(exif);
    metadata.exposure_time_s = read_exposure_time(exif);
    metadata.iso = read_iso(exif);
    metadata.captured = read_captured(exif);
    metadata.is_manual = read_is_manual(exif);
    if (metadata.exposure_time_s && metadata.iso && metadata.f_number)
        metadata.exif_ev = exposure_ev(*metadata.exposure_time_s, *metadata.iso, *metadata.f_number);
}

void write_exposure(const PictureMetadata &metadata, Exiv2::ExifData &exif) {
    set_rational(exif, "Exif.Photo.FNumber", metadata.key.aperture);
    set_rational(exif, "Exif.Photo.ExposureTime", metadata.exposure_time_s.value_or(LENSPROF_UNKNOWN));
    const auto apex = exif.findKey(Exiv2::ExifKey("Exif.Photo.ShutterSpeedValue"));  // states the old exposure time
    if (metadata.exposure_time_s && apex != exif.end()) exif.erase(apex);
    if (metadata.iso && *metadata.iso >= 0.5)  // 16 bits; 65535 means a larger value
        exif["Exif.Photo.ISOSpeedRatings"] = static_cast<uint16_t>(std::lround(std::fmin(*metadata.iso, 65535)));
    if (!metadata.is_manual) return;
    exif["Exif.Photo.ExposureProgram"] = kManual;
    exif["Exif.Photo.ExposureMode"] = kManual;
}

}  // namespace lensprof
