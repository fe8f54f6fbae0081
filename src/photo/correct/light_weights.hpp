// How reliably a picture measures the irradiance of a pixel.
#pragma once

#include <array>

#include "photo/correct/correction.hpp"
#include "photo/pictures/picture.hpp"

namespace lensprof {

// Samples per pixel: 1 or 3. Failure (usage) with the file name for a picture with transparency.
size_t samples_of_light(const Picture &header, const std::string &file);

// Grey value 0..1 of the n-th sample of a row.
double grey_at(const lensprof_image &rows, uint32_t y, size_t n);

// The largest grey value of a pixel's channels. If it is unclipped, the other channels are valid too, even if one is
// close to zero.
double largest_grey(const lensprof_image &rows, uint32_t x, uint32_t y);

// How far a pixel is from clipping, by its largest grey value: 0 at black and white, 1 in between.
double trust_of(double largest);
bool is_white(double largest);

// The factor from the irradiance of a picture to that of the wanted exposure and white balance.
double gain_of(const Correction &job, size_t channel);

// The noise of a picture is assumed equal at all grey values, so the irradiance is weighted by 1/f'^2 of the response
// and by the gain.
class LightWeights {
public:
    explicit LightWeights(const Correction &job);

    double at(size_t channel, double grey) const;

private:
    static constexpr int steps = 4096;  // tabulated over grey values
    std::array<std::array<double, steps + 1>, 3> weight_;
};

}  // namespace lensprof
