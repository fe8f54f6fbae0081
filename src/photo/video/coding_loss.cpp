#include "photo/video/coding_loss.hpp"

#include <algorithm>
#include <cmath>

#include "photo/base/events.hpp"
#include "photo/base/failure.hpp"
#include "photo/base/format.hpp"

namespace lensprof {
namespace {

SampledRows sampled_rows(const VideoFrame &frame) {
    constexpr uint32_t step = 16;  // rows
    const Picture &picture = frame.picture;
    SampledRows rows{frame.number, picture.sample, {}};
    for (uint32_t y = step / 2 < picture.height ? step / 2 : 0; y < picture.height; y += step) {
        const uint8_t *row = &picture.pixels[y * picture.row_bytes];
        rows.bytes.insert(rows.bytes.end(), row, row + picture.row_bytes);
    }
    return rows;
}

// NaN if the frames have different sizes; their depths may differ.
double mean_difference(const SampledRows &a, const SampledRows &b) {
    if (a.count() != b.count()) return NAN;
    double sum = 0.0;
    for (size_t n = 0; n < a.count(); n++)
        sum += std::abs(sample_value(a.sample, a.bytes.data(), n) - sample_value(b.sample, b.bytes.data(), n));
    return 255.0 * sum / double(a.count());
}

}  // namespace

void CodingLoss::add(const VideoFrame &frame, size_t frames) {
    constexpr size_t most_sampled = 16;
    if (frames_++ % std::max<size_t>(frames / most_sampled, 1) == 0 && sampled_.size() < 2 * most_sampled)
        sampled_.push_back(sampled_rows(frame));
}

CodingLoss::Differences CodingLoss::measured(const std::string &file, const std::string &path) const {
    Differences differences;
    VideoReader reader(file);
    VideoFrame frame;
    auto wanted = sampled_.begin();
    uint64_t frames = 0;
    for (; reader.next(frame); frames++) {
        stop_if_cancelled();
        if (wanted == sampled_.end() || frames != wanted->number) continue;
        reader.read(frame.picture);
        const double difference = mean_difference(*wanted++, sampled_rows(frame));
        if (std::isnan(difference))
            throw Failure(LENSPROF_ERROR_WRITE, path + ": its frames are read back with another size; choose another "
                                                       "codec or suffix");
        differences.mean += difference / double(sampled_.size());
        differences.largest = std::max(differences.largest, difference);
    }
    if (frames != frames_)
        throw Failure(LENSPROF_ERROR_WRITE,
                      path
                          + format(": %llu frames were coded, but %llu are read back; choose "
                                   "another codec or suffix",
                                   static_cast<unsigned long long>(frames_), static_cast<unsigned long long>(frames)));
    return differences;
}

}  // namespace lensprof
