#include "photo/cards/count_samples.hpp"

#include <cmath>
#include <cstring>

#include "fit/base/quantile.hpp"
#include "photo/base/failure.hpp"
#include "photo/base/format.hpp"

namespace lensprof {

double bright_sample(const Picture &picture) {
    constexpr double share = 0.9;
    std::vector<double> values;
    for (size_t n = 0; n < picture.pixels.size() / sizeof(float); n++) {
        const double value = sample_value(picture.sample, picture.pixels.data(), n);
        if (std::isfinite(value)) values.push_back(value);
    }
    return quantile(values, share);
}

bool are_counts(const Picture &picture) {
    return picture.sample == LENSPROF_SAMPLE_F32 && bright_sample(picture) > most_exposed;
}

std::optional<double> count_at_white(const StatedLevels &stated, const StatedLevels &of_file, const Picture &picture,
                                     const std::string &file, Events &events) {
    if (picture.sample != LENSPROF_SAMPLE_F32) return std::nullopt;
    const bool is_stated = stated.white && !stated.white->is_share, is_counted = are_counts(picture);
    if (is_stated && is_counted)
        levels_of({{}, stated.white, {}, stated.white_option}, picture, file, {}, {1.0, false, bright_sample(picture)});
    if (is_stated) return stated.white->number;
    if (!is_counted) return std::nullopt;
    if (!of_file.white)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      file
                          + format(": its float samples reach %.6g, and are counts: 1 would be full scale. State the "
                                   "count at saturation with %s%s",
                                   bright_sample(picture), option_name("white_level").c_str(),
                                   stated.white ? ", not a percentage of it" : ""));
    events.note(file,
                format("its samples are counts; its white level is %g, as the file states", of_file.white->number));
    return of_file.white->number;
}

void divide_samples(double count, Picture &picture) {
    if (picture.sample != LENSPROF_SAMPLE_F32) return;
    for (size_t n = 0; n < picture.pixels.size() / sizeof(float); n++) {
        const auto share = static_cast<float>(sample_value(picture.sample, picture.pixels.data(), n) / count);
        std::memcpy(picture.pixels.data() + n * sizeof share, &share, sizeof share);
    }
}

}  // namespace lensprof
