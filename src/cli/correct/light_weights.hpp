// How well a picture shows the light of a pixel.
#pragma once

#include <array>

#include "cli/correct/correction.hpp"
#include "cli/pictures/picture.hpp"

namespace lensprof {

// Samples of a pixel: 1 or 3. Failure (usage) that names the file for a picture with transparency.
size_t samples_of_light(const Picture &header, const std::string &file);

// Grey value 0..1 of the n-th sample of a row.
double grey_at(const lensprof_image &rows, uint32_t y, size_t n);

// The largest grey value of a pixel's channels. Where that is well within, the others are what the light is, be it next
// to none of red.
double largest_grey(const lensprof_image &rows, uint32_t x, uint32_t y);

// How far a pixel is from black and white, by its largest grey value: 0 at them, 1 between.
double trust_of(double largest);
bool is_white(double largest);

// What the exposure and white balance of a picture make of the light in one as it is wanted.
double gain_of(const Correction &job, size_t channel);

// A picture's noise is the same at all grey values, so that 1/f'^2 of the response and the gain weigh the light that it
// shows.
class LightWeights {
public:
    explicit LightWeights(const Correction &job);

    double at(size_t channel, double grey) const;

private:
    static constexpr int steps = 4096;  // of grey values
    std::array<std::array<double, steps + 1>, 3> weight_;
};

}  // namespace lensprof
