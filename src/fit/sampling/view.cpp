#include "fit/sampling/view.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "fit/base/constants.hpp"
#include "fit/base/fail.hpp"
#include "fit/base/lanes.hpp"
#include "fit/base/parallel.hpp"

namespace lensprof {
namespace {

constexpr int kReach = 2;  // patches are (2 kReach + 1) pixels square
constexpr int kPatchSide = 2 * kReach + 1, kPatchPixels = kPatchSide * kPatchSide;
constexpr double kAlmostWhite = 1.0 - 1e-9;       // 1 itself means a channel that is white in every pixel
constexpr float kSmallestSpread = 1.0f / 255.0f;  // of a patch without noise

const uint8_t *pixel(const lensprof_image &view, int u, int v, uint32_t sample) {
    uint32_t bytes = lensprof_sample_type_bytes(view.sample);
    return static_cast<const uint8_t *>(view.data) + static_cast<ptrdiff_t>(v) * view.row_bytes
           + (static_cast<size_t>(u) * lensprof_layout_samples(view.layout) + sample) * bytes;
}

double load(const lensprof_image &view, int u, int v, uint32_t sample) {
    const uint8_t *p = pixel(view, u, v, sample);
    if (view.sample == LENSPROF_SAMPLE_U8) return *p / 255.0;
    if (view.sample == LENSPROF_SAMPLE_U16) {
        uint16_t value;
        std::memcpy(&value, p, sizeof value);
        return value / 65535.0;
    }
    float value;
    std::memcpy(&value, p, sizeof value);
    return value;
}

// Lanes are the channels of a patch's pixel (the last one is a copy).

// Grey values of the bytes 0..255.
struct ByteValues {
    float value[256];
    constexpr ByteValues() : value() {
        for (int i = 0; i < 256; i++) value[i] = static_cast<float>(i / 255.0);
    }
};
constexpr ByteValues kByteValues;

float grey_value(uint8_t sample) { return kByteValues.value[sample]; }
float grey_value(uint16_t sample) { return static_cast<float>(sample * (1.0 / 65535.0)); }  // rounds as a quotient does
float grey_value(float sample) { return sample; }

// The pixels around (u, v), row by row; `offset` has the place of every lane's sample in a pixel.
template <class Sample>
void gather(const lensprof_image &view, int u, int v, const int *offset, Lanes *out) {
    const size_t samples = lensprof_layout_samples(view.layout);
    for (int dv = -kReach; dv <= kReach; dv++) {
        const auto *p = reinterpret_cast<const Sample *>(pixel(view, u - kReach, v + dv, 0));
        for (int du = 0; du < kPatchSide; du++, p += samples, out++)
            *out = Lanes{grey_value(p[offset[0]]), grey_value(p[offset[1]]), grey_value(p[offset[2]]),
                         grey_value(p[offset[3]])};
    }
}

template <class Sample>
void mean_row(const lensprof_image &view, int v, int channels, float *out) {
    const auto *p = reinterpret_cast<const Sample *>(pixel(view, 0, v, 0));
    const size_t samples = lensprof_layout_samples(view.layout);
    for (uint32_t u = 0; u < view.width; u++, p += samples)
        out[u] = channels == 1 ? grey_value(p[0]) : (grey_value(p[0]) + grey_value(p[1]) + grey_value(p[2])) / 3.0f;
}

template <class Sample>
void colour_row(const lensprof_image &view, int v, const int offset[3], float *out) {
    const auto *p = reinterpret_cast<const Sample *>(pixel(view, 0, v, 0));
    const size_t samples = lensprof_layout_samples(view.layout);
    for (uint32_t u = 0; u < view.width; u++, p += samples)
        for (int c = 0; c < 3; c++) *out++ = grey_value(p[offset[c]]);
}

Lanes lower(Lanes a, Lanes b) { return a < b ? a : b; }
Lanes higher(Lanes a, Lanes b) { return a > b ? a : b; }
Lanes absolute(Lanes a) { return higher(a, -a); }

void sort_two(Lanes &low, Lanes &high) {
    const Lanes a = low, b = high;
    low = lower(a, b);
    high = higher(a, b);
}

// Value number count / 2 in order, for every lane; `count` is even. Each round moves the largest value to the end.
// Reorders the values.
template <int count>
Lanes upper_median(Lanes *values) {
    for (int last = count - 1; last >= count / 2; last--)
        for (int i = 0; i < last; i++) sort_two(values[i], values[i + 1]);
    return values[count / 2];
}

// Median of every lane; `count` is odd. Of any count / 2 + 2 values the least and the largest cannot be the median of
// all: they are dropped until one value is left. Reorders the values.
template <int count>
Lanes median(Lanes *values) {
    constexpr int end = count / 2 + 2;
    int first = 0;  // values[first..end) are considered
    for (int next = end;; next++) {
        for (int i = first + 1; i < end; i++) sort_two(values[first], values[i]);
        for (int i = first + 1; i < end - 1; i++) sort_two(values[i], values[end - 1]);
        first++;
        if (next == count) return values[first];
        values[end - 1] = values[next];
    }
}

// Mean of the values within 2.5 standard deviations of the centre, which starts at the median: nearly as accurate as a
// mean for plain noise, and barely biased if a third of the pixels are wrong, even all on one side.
Lanes robust_mean(const Lanes *values) {
    Lanes scratch[kPatchPixels];
    std::copy(values, values + kPatchPixels, scratch);
    Lanes center = median<kPatchPixels>(scratch);
    for (int i = 0; i < kPatchPixels; i++) scratch[i] = absolute(values[i] - center);
    Lanes spread = static_cast<float>(kMadToSigma) * median<kPatchPixels>(scratch);
    const Lanes zero = {}, one = zero + 1.0f;
    for (int round = 0; round < 3; round++) {
        const Lanes limit = 2.5f * higher(spread, zero + kSmallestSpread);
        Lanes sum = zero, square = zero, kept = zero;
        for (int i = 0; i < kPatchPixels; i++) {
            const Lanes distance = values[i] - center, used = absolute(distance) > limit ? zero : distance;
            kept += absolute(distance) > limit ? zero : one;
            sum += used;
            square += used * used;
        }
        const Lanes count = higher(kept, one);
        Lanes deviation;
        for (int c = 0; c < kLanes; c++) deviation[c] = std::sqrt(square[c] / count[c]);
        // 1.1: corrects the spread of plain noise for the cut
        spread = kept > zero ? lower(spread, 1.1f * deviation) : spread;
        center += sum / count;
    }
    return center;
}

// A quick check first: in some channel, the middle and its four neighbours are all black or saturated.
bool is_out_of_range(const Lanes *values, float black, float white) {
    constexpr int middle = kPatchPixels / 2;
    for (int c = 0; c < kLanes; c++) {
        int bad = 0;
        for (int i : {middle, middle - 1, middle + 1, middle - kPatchSide, middle + kPatchSide})
            bad += !(values[i][c] >= black && values[i][c] <= white);
        if (bad == 5) return true;
    }
    return false;
}

// Whether a channel is above white in more than a quarter of the pixels: it is saturated, and the values left below
// white, by noise and coding, do not represent its mean.
bool is_saturated(const Lanes *values, float white) {
    for (int c = 0; c < kLanes; c++) {
        int above = 0;
        for (int i = 0; i < kPatchPixels; i++) above += values[i][c] > white;
        if (4 * above > kPatchPixels) return true;
    }
    return false;
}

bool all_in_range(const Lanes *values, float black, float white) {
    for (int i = 0; i < kPatchPixels; i++)
        for (int c = 0; c < kLanes; c++)
            if (!(values[i][c] >= black && values[i][c] <= white)) return false;
    return true;
}

struct Slope {
    Lanes across, down;  // per view pixel
};

// Medians of the halves suppress single wrong pixels; the halves' centres are kReach + 1 pixels apart.
Slope slope_of(const Lanes *values) {
    constexpr int half = kReach * kPatchSide;
    Lanes left[half], right[half], above[half], below[half];
    std::copy(values, values + half, above);
    std::copy(values + kPatchPixels - half, values + kPatchPixels, below);
    for (int row = 0; row < kPatchSide; row++) {
        std::copy_n(values + row * kPatchSide, kReach, left + row * kReach);
        std::copy_n(values + row * kPatchSide + kReach + 1, kReach, right + row * kReach);
    }
    constexpr float distance = kReach + 1;
    return {(upper_median<half>(right) - upper_median<half>(left)) / distance,
            (upper_median<half>(below) - upper_median<half>(above)) / distance};
}

}  // namespace

lensprof_status check_view(const lensprof_sample_image &image, uint32_t i, lensprof_error *error) {
    lensprof_status status = lensprof_image_validate(&image.view);
    if (status != LENSPROF_OK) return fail_at(LENSPROF_ITEM_IMAGE, i, status, error, "the view of pixels is invalid");
    const auto &view = image.view;
    if (view.layout > LENSPROF_LAYOUT_BGRA || view.sample > LENSPROF_SAMPLE_F32)
        return fail_at(
            LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_ARGUMENT, error,
            "mosaics, planes and half floats are not supported here; give interleaved pixels of U8, U16 or F32");
    if (!image.reduction || image.every_pixel > 1
        || static_cast<uint64_t>(view.width) * image.reduction > image.camera.width
        || static_cast<uint64_t>(view.height) * image.reduction > image.camera.height)
        return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_SIZE, error,
                       "a view of %u x %u with reduction %u does not fit a frame of %u x %u", view.width, view.height,
                       image.reduction, image.camera.width, image.camera.height);
    ptrdiff_t width = static_cast<ptrdiff_t>(view.width), row = image.mask_row_bytes;
    constexpr ptrdiff_t kLongestRow = ptrdiff_t{1} << 28;
    if (image.mask && ((row < width && row > -width) || row > kLongestRow || row < -kLongestRow))
        return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_SIZE, error,
                       "mask rows are %td bytes apart, less than the view's %td pixels", row, width);
    if (!(image.black >= 0.0 && image.white <= 1.0 && image.black < image.white))
        return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_ARGUMENT, error,
                       "black and white must satisfy 0 <= black < white <= 1");
    return LENSPROF_OK;
}

lensprof_status check_finite(const std::function<lensprof_sample_image(uint32_t)> &image, uint32_t count,
                             uint32_t threads, const std::function<bool()> &stop, lensprof_error *error) {
    struct Place {
        bool found;
        uint32_t x, y;
    };
    std::vector<Place> places(count);
    auto work = [&](uint32_t i) {
        lensprof_sample_image view_image = image(i);
        places[i].found = View(view_image).find_not_finite(places[i].x, places[i].y);
    };
    if (!for_each_parallel(count, threads, work, stop)) throw Cancelled();
    for (uint32_t i = 0; i < count; i++)
        if (places[i].found)
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_NOT_FINITE, error,
                           "pixel %u, %u is not a finite number", places[i].x, places[i].y);
    return LENSPROF_OK;
}

View::View(const lensprof_sample_image &image)
    : image_(image),
      channels_(static_cast<int>(lensprof_layout_channels(image.view.layout))),
      reversed_(image.view.layout == LENSPROF_LAYOUT_BGR || image.view.layout == LENSPROF_LAYOUT_BGRA),
      alpha_(lensprof_layout_samples(image.view.layout) != lensprof_layout_channels(image.view.layout)) {}

double View::sample(int u, int v, int channel) const {
    return load(image_.view, u, v, static_cast<uint32_t>(reversed_ ? 2 - channel : channel));
}

void View::row(int v, float *values, uint8_t *allowed) const {
    const int colour[3] = {reversed_ ? 2 : 0, 1, reversed_ ? 0 : 2}, grey[3] = {0, 0, 0};
    const int *offset = channels_ == 3 ? colour : grey;
    if (image_.view.sample == LENSPROF_SAMPLE_U8)
        colour_row<uint8_t>(image_.view, v, offset, values);
    else if (image_.view.sample == LENSPROF_SAMPLE_U16)
        colour_row<uint16_t>(image_.view, v, offset, values);
    else
        colour_row<float>(image_.view, v, offset, values);
    if (image_.mask || alpha_)
        for (int u = 0; u < static_cast<int>(image_.view.width); u++) allowed[u] = is_allowed(u, v);
    else
        std::fill_n(allowed, image_.view.width, uint8_t{1});
}

void View::grey_row(int v, float *out) const {
    if (image_.view.sample == LENSPROF_SAMPLE_U8)
        mean_row<uint8_t>(image_.view, v, channels_, out);
    else if (image_.view.sample == LENSPROF_SAMPLE_U16)
        mean_row<uint16_t>(image_.view, v, channels_, out);
    else
        mean_row<float>(image_.view, v, channels_, out);
}

bool View::is_allowed(int u, int v) const {
    if (image_.mask && !image_.mask[static_cast<ptrdiff_t>(v) * image_.mask_row_bytes + u]) return false;
    return !alpha_ || load(image_.view, u, v, static_cast<uint32_t>(channels_)) >= 0.5;
}

bool View::find_not_finite(uint32_t &x, uint32_t &y) const {
    const auto &view = image_.view;
    if (view.sample != LENSPROF_SAMPLE_F32) return false;
    for (y = 0; y < view.height; y++)
        for (x = 0; x < view.width; x++)
            for (uint32_t s = 0; s < lensprof_layout_samples(view.layout); s++)
                if (!std::isfinite(load(view, static_cast<int>(x), static_cast<int>(y), s))) return true;
    return false;
}

void View::to_view(double x, double y, double &u, double &v) const {
    u = (x + 0.5) / image_.reduction - 0.5;
    v = (y + 0.5) / image_.reduction - 0.5;
}

bool View::holds(double x, double y) const {
    double u, v;
    to_view(x, y, u, v);
    return u >= kReach && v >= kReach && u <= image_.view.width - 1.0 - kReach
           && v <= image_.view.height - 1.0 - kReach;
}

// Also repeats the value of a grey view in the other channels.
bool View::in_range(Patch &patch, bool keep_white) const {
    for (int c = channels_; c < 3; c++) patch.value[c] = patch.value[0];
    for (double value : patch.value)
        if (!(value >= image_.black && value <= image_.white) && !(keep_white && value == 1.0)) return false;
    return true;
}

bool View::patch(double x, double y, bool keep_white, Patch &out) const {
    double u, v;
    to_view(x, y, u, v);
    const int iu = static_cast<int>(std::lround(u)), iv = static_cast<int>(std::lround(v));
    for (int i = 0; (image_.mask || alpha_) && i < kPatchPixels; i++)
        if (!is_allowed(iu + i % kPatchSide - kReach, iv + i / kPatchSide - kReach)) return false;
    Lanes all[kPatchPixels];
    const int colour[kLanes] = {reversed_ ? 2 : 0, 1, reversed_ ? 0 : 2, 1}, grey[kLanes] = {0, 0, 0, 0};
    const int *offset = channels_ == 3 ? colour : grey;
    if (image_.view.sample == LENSPROF_SAMPLE_U8)
        gather<uint8_t>(image_.view, iu, iv, offset, all);
    else if (image_.view.sample == LENSPROF_SAMPLE_U16)
        gather<uint16_t>(image_.view, iu, iv, offset, all);
    else
        gather<float>(image_.view, iu, iv, offset, all);
    const auto black = static_cast<float>(image_.black), white = static_cast<float>(image_.white);
    bool is_white[3] = {false, false, false};
    for (int c = 0; c < 3 && keep_white; c++)
        is_white[c] = std::all_of(all, all + kPatchPixels, [=](const Lanes &pixel) { return pixel[c] > white; });
    if (is_out_of_range(all, black, keep_white ? INFINITY : white)) return false;
    if (!keep_white && is_saturated(all, white)) return false;
    if (image_.every_pixel && !all_in_range(all, black, keep_white ? INFINITY : white)) return false;
    const Slope slope = slope_of(all);
    const Lanes mean = robust_mean(all);
    out.gradient = 0.0;
    for (int c = 0; c < 3; c++) {
        const double gu = slope.across[c], gv = slope.down[c], value = mean[c];
        if (c < channels_) out.gradient += std::hypot(gu, gv);
        out.value[c] = std::clamp(value + gu * (u - iu) + gv * (v - iv), 0.0, 1.0);
        if (keep_white) out.value[c] = is_white[c] ? 1.0 : std::min(out.value[c], kAlmostWhite);
    }
    return in_range(out, keep_white);
}

bool View::point(double x, double y, bool keep_white, Patch &out) const {
    double u, v;
    to_view(x, y, u, v);
    int iu = static_cast<int>(u), iv = static_cast<int>(v);
    double fu = u - iu, fv = v - iv;
    out.gradient = 0.0;
    for (int dv = 0; dv < 2; dv++)
        for (int du = 0; du < 2; du++)
            if (!is_allowed(iu + du, iv + dv)) return false;
    for (int c = 0; c < channels_; c++) {
        double top = (1.0 - fu) * sample(iu, iv, c) + fu * sample(iu + 1, iv, c);
        double bottom = (1.0 - fu) * sample(iu, iv + 1, c) + fu * sample(iu + 1, iv + 1, c);
        out.value[c] = std::clamp((1.0 - fv) * top + fv * bottom, 0.0, 1.0);
        out.gradient += std::hypot(0.5 * (sample(iu + 1, iv, c) - sample(iu - 1, iv, c)),
                                   0.5 * (sample(iu, iv + 1, c) - sample(iu, iv - 1, c)));
        if (keep_white && out.value[c] > image_.white) out.value[c] = 1.0;
    }
    return in_range(out, keep_white);
}

}  // namespace lensprof
