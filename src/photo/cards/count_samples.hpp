// Float samples that are counts of a sensor, not shares of full scale.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "photo/base/events.hpp"
#include "photo/pictures/stated_levels.hpp"

namespace lensprof {

// The sample that a tenth of a float picture exceeds; hot pixels are fewer.
double bright_sample(const Picture &picture);

constexpr double most_exposed = 2.0;  // of full scale: what developing can make of shares

// Whether float samples are far above 1, which is full scale by convention.
bool are_counts(const Picture &picture);

// The count at saturation, by which float pictures are divided: the white level as stated, else that of the file if the
// samples are counts; empty if they are shares already. Failure, which names the option, for counts of unknown scale,
// and for a white level that is not one of them.
std::optional<double> count_at_white(const StatedLevels &stated, const StatedLevels &of_file, const Picture &picture,
                                     const std::string &file, Events &events);

// Makes shares of the counts of a float picture.
void divide_samples(double count, Picture &picture);

}  // namespace lensprof
