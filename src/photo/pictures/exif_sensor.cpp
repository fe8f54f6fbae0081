#include "photo/pictures/exif_sensor.hpp"

#include <algorithm>
#include <cmath>

#include "photo/pictures/exif_tags.hpp"
#include "photo/pictures/exif_value.hpp"

namespace lensprof {
namespace {

struct StatedSize {
    double width, height;  // px of the frame as the camera took it; NaN = unknown
};

StatedSize read_stated_size(const Exif &exif) {
    return {read_number(exif, {exif_tags::pixel_width}), read_number(exif, {exif_tags::pixel_height})};
}

bool is_size_of(StatedSize stated, PictureSize size) {
    return (stated.width == size.width && stated.height == size.height)
           || (stated.width == size.height && stated.height == size.width);
}

// A picture of the stated aspect shows the whole frame, resized at most. One with another aspect was cropped. That it
// was not resized as well is proven if it has all pixels of one side, and assumed if it has half of both: the falloff
// is then rather too weak than too strong. NaN for smaller ones.
double shown_diagonal(StatedSize stated, PictureSize size) {
    constexpr double same_aspect = 0.01;  // the rounding of small pictures
    constexpr double min_share = 0.5;
    const double longer = std::fmax(size.width, size.height), shorter = std::fmin(size.width, size.height),
                 stated_longer = std::fmax(stated.width, stated.height),
                 stated_shorter = std::fmin(stated.width, stated.height);
    const bool is_part = shorter > 0 && longer <= stated_longer && shorter <= stated_shorter;  // false for NaN
    if (!is_part || std::fabs(longer / shorter * stated_shorter / stated_longer - 1.0) < same_aspect) return 1.0;
    const bool has_one_side = longer == stated_longer || shorter == stated_shorter || longer == stated_shorter;
    const bool has_half = longer >= min_share * stated_longer && shorter >= min_share * stated_shorter;
    return has_one_side || has_half ? std::hypot(longer, shorter) / std::hypot(stated_longer, stated_shorter) : NAN;
}

// 43.27 mm over the sensor diagonal, from the pixel pitch; NaN without it.
double read_pitched_crop(const Exif &exif, StatedSize stated) {
    const double unit = read_number(exif, {exif_tags::pitch_unit}) == 3 ? 10.0 : 25.4;  // mm: cm, inch
    return std::hypot(36.0, 24.0)
           / std::hypot(stated.width / read_number(exif, {exif_tags::pitch_x}) * unit,
                        stated.height / read_number(exif, {exif_tags::pitch_y}) * unit);
}

// From the 35 mm equivalent focal length, which is rounded to whole mm; if the pixel pitch agrees with it, or there is
// no equivalent, from the pitch. The pitch counts if the pixels are those of the camera. A small picture may have been
// resized by a program that updated its stated size: then the pitch alone is not trusted.
double read_crop_factor(const Exif &exif, double focal_mm, StatedSize stated, PictureSize size) {
    constexpr double min_pixels = 3e6, same = 0.1;
    const double equivalent = read_number(exif, {exif_tags::focal_length_35mm}) / focal_mm;
    const bool has_pixels = is_size_of(stated, size) || size.shown_diagonal < 1.0;
    const double pitched = has_pixels ? read_pitched_crop(exif, stated) : NAN;
    const auto is_plausible = [](double crop) { return crop > 0.2 && crop < 50.0; };
    const bool known = is_plausible(equivalent) && focal_mm > 0.0;
    const bool is_whole = double(size.width) * size.height >= min_pixels;
    if (is_plausible(pitched) && (known ? std::fabs(pitched / equivalent - 1.0) < same : is_whole)) return pitched;
    return known ? equivalent : LENSPROF_UNKNOWN;
}

}  // namespace

void read_sensor(const Exif &exif, bool is_raw, PictureMetadata &metadata) {
    const StatedSize stated = read_stated_size(exif);
    PictureSize &size = metadata.size;
    if (!is_raw) size.shown_diagonal = shown_diagonal(stated, size);  // raw files have margins
    const double crop_factor = read_crop_factor(exif, metadata.key.focal_mm, stated, size);
    metadata.key.crop_factor = size.of_part(crop_factor);
}

// Of a repeating pattern (BlackLevelRepeatDim), the mean counts.
void read_levels(const Exif &exif, PictureMetadata &metadata) {
    constexpr size_t largest_pattern = 64;
    const ExifField *black = exif.find(exif_tags::black_level);
    double sum = 0.0;
    size_t count = 0;
    for (; black && count < std::min<size_t>(black->count, largest_pattern); count++)
        sum += number_of(black, exif.order, count);
    if (count > 0 && std::isfinite(sum) && sum >= 0.0) {
        const double mean = sum / static_cast<double>(count);
        metadata.black_level = {mean, mean, mean};
        for (size_t c = 0; c < 3 && count == 3; c++) (*metadata.black_level)[c] = number_of(black, exif.order, c);
    }
    metadata.white_level = in_range(read_number(exif, {exif_tags::white_level}), 65536.0);
}

}  // namespace lensprof
