// Measures how fast a profile is applied: one thread, 24 megapixel RGB, compared with memcpy and with alternatives for
// the same work (Lensfun's lf_modifier_apply_color_modification, OpenCV's multiply by a precomputed gain image, and a
// plain loop over tables); and a raw mosaic by each kind of plan. Times are CPU time of the thread, medians of
// interleaved rounds. Prints a Markdown table.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include <time.h>

#include <lensfun.h>
#include <lensprof/sensor.h>
#include <opencv2/core.hpp>

namespace {

constexpr int kWidth = 6000, kHeight = 4000, kRounds = 9;
constexpr size_t kSamples = static_cast<size_t>(kWidth) * kHeight * 3;
constexpr double kFalloff[3] = {-0.30, 0.05, -0.15};

double cpu_seconds() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double attenuation(int x, int y) {
    const double dx = x - (kWidth - 1) / 2.0, dy = y - (kHeight - 1) / 2.0;
    const double r2 = (dx * dx + dy * dy) / (0.25 * (double(kWidth) * kWidth + double(kHeight) * kHeight));
    return 1.0 + r2 * (kFalloff[0] + r2 * (kFalloff[1] + r2 * kFalloff[2]));
}

template <class T>
struct Kind;
template <>
struct Kind<uint8_t> {
    static constexpr const char *name = "u8";
    static constexpr double unit = 255.0;
    static constexpr uint32_t sample = LENSPROF_SAMPLE_U8;
    static constexpr lfPixelFormat lensfun = LF_PF_U8;
    static constexpr int opencv = CV_8UC3;
};
template <>
struct Kind<uint16_t> {
    static constexpr const char *name = "u16";
    static constexpr double unit = 65535.0;
    static constexpr uint32_t sample = LENSPROF_SAMPLE_U16;
    static constexpr lfPixelFormat lensfun = LF_PF_U16;
    static constexpr int opencv = CV_16UC3;
};
template <>
struct Kind<float> {
    static constexpr const char *name = "f32";
    static constexpr double unit = 1.0;
    static constexpr uint32_t sample = LENSPROF_SAMPLE_F32;
    static constexpr lfPixelFormat lensfun = LF_PF_F32;
    static constexpr int opencv = CV_32FC3;
};

// A plan of lensprof. `whole`: response, falloff, exposure, white balance and response; otherwise linear samples and
// falloff.
class Ours {
public:
    Ours(uint32_t sample, bool whole) {
        const double emor[3] = {0.8, -0.3, 0.1};
        lensprof_apply_options options;
        lensprof_apply_options_init(&options);
        lensprof_response_set_linear(&response_);
        if (whole && lensprof_response_set_emor(&response_, emor, 3) != LENSPROF_OK) std::abort();
        std::copy(kFalloff, kFalloff + 3, vignetting_.k);
        options.response = &response_;
        options.vignetting = &vignetting_;
        options.frame_width = kWidth, options.frame_height = kHeight;
        options.source_sample = options.target_sample = sample;
        options.input = options.output = whole ? LENSPROF_ENCODING_RESPONSE : LENSPROF_ENCODING_LINEAR;
        if (whole) options.target = {0.3, {1.1, 1.0, 0.9}};
        memory_.resize(lensprof_plan_bytes(&options) / 8 + 1);
        const double began = cpu_seconds();
        if (lensprof_plan_init(memory_.data(), memory_.size() * 8, &options, &plan_, nullptr) != LENSPROF_OK)
            std::abort();
        init_s = cpu_seconds() - began;
    }
    void apply(const void *source, void *target, uint32_t sample) const {
        const ptrdiff_t row = static_cast<ptrdiff_t>(kWidth) * 3 * lensprof_sample_type_bytes(sample);
        const lensprof_image from = {source, row, kWidth, kHeight, sample, LENSPROF_LAYOUT_RGB};
        const lensprof_target to = {target, row, kWidth, kHeight, sample, LENSPROF_LAYOUT_RGB};
        if (lensprof_apply(plan_, &from, &to, 0, 0) != LENSPROF_OK) std::abort();
    }
    double init_s = 0.0;

private:
    lensprof_response response_;
    lensprof_vignetting vignetting_{};
    std::vector<uint64_t> memory_;
    const lensprof_plan *plan_ = nullptr;
};

// A straightforward implementation: response, falloff, white balance and response, with tables, and the falloff per
// pixel.
template <class T>
class PlainLoop {
public:
    PlainLoop() : inverse_(Kind<T>::unit == 1.0 ? 4096 : static_cast<size_t>(Kind<T>::unit) + 1), forward_(4097) {
        for (size_t i = 0; i < inverse_.size(); i++)
            inverse_[i] = std::pow(float(i) / float(inverse_.size() - 1), 2.2f);
        for (size_t i = 0; i < forward_.size(); i++)
            forward_[i] = std::pow(float(i) / 4096.0f, 1.0f / 2.2f) * float(Kind<T>::unit);
    }
    void apply(const T *source, T *target) const {
        const float balance[3] = {1.1f, 1.0f, 0.9f};
        const float per_r2 = 4.0f / (float(kWidth) * kWidth + float(kHeight) * kHeight);
        for (int y = 0; y < kHeight; y++)
            for (int x = 0; x < kWidth; x++) {
                const float dx = x - 0.5f * (kWidth - 1), dy = y - 0.5f * (kHeight - 1),
                            r2 = (dx * dx + dy * dy) * per_r2;
                const float gain =
                    1.0f / (1.0f + r2 * (float(kFalloff[0]) + r2 * (float(kFalloff[1]) + r2 * float(kFalloff[2]))));
                for (int c = 0; c < 3; c++) {
                    const size_t at = 3 * (static_cast<size_t>(y) * kWidth + x) + c;
                    const float position = std::min(inverse_[index(source[at])] * gain * balance[c], 1.0f) * 4096.0f;
                    const int j = std::min(static_cast<int>(position), 4095);
                    const float value = forward_[j] + (position - j) * (forward_[j + 1] - forward_[j]);
                    target[at] = Kind<T>::unit == 1.0 ? T(value) : T(value + 0.5f);
                }
            }
    }

private:
    size_t index(T value) const {
        if (Kind<T>::unit != 1.0) return static_cast<size_t>(value);
        return static_cast<size_t>(std::min(std::max(float(value), 0.0f), 1.0f) * float(inverse_.size() - 1) + 0.5f);
    }
    std::vector<float> inverse_, forward_;
};

class Lensfun {
public:
    explicit Lensfun(lfPixelFormat format) : lens_(lf_lens_new()) {
        lens_->CropFactor = 1.0f, lens_->AspectRatio = 1.5f, lens_->MinFocal = lens_->MaxFocal = 50.0f;
        lens_->Type = LF_RECTILINEAR;
        lfLensCalibVignetting one{};
        one.Model = LF_VIGNETTING_MODEL_PA, one.Focal = 50.0f, one.Aperture = 2.8f, one.Distance = 1000.0f;
        for (int n = 0; n < 3; n++) one.Terms[n] = float(kFalloff[n]);
        lf_lens_add_calib_vignetting(lens_, &one);
        modifier_ = lf_modifier_new(lens_, 1.0f, kWidth, kHeight);
        const int done = lf_modifier_initialize(modifier_, lens_, format, 50.0f, 2.8f, 1000.0f, 1.0f, LF_RECTILINEAR,
                                                LF_MODIFY_VIGNETTING, false);
        if (!(done & LF_MODIFY_VIGNETTING)) std::abort();
    }
    ~Lensfun() {
        lf_modifier_destroy(modifier_);
        lf_lens_destroy(lens_);
    }
    void apply(void *pixels, int row_bytes) const {
        lf_modifier_apply_color_modification(modifier_, pixels, 0, 0, kWidth, kHeight, LF_CR_3(RED, GREEN, BLUE),
                                             row_bytes);
    }

private:
    lfLens *lens_;
    lfModifier *modifier_;
};

struct Contender {
    std::string name;
    std::function<void()> run;
    std::vector<double> seconds;

    double median() {
        std::sort(seconds.begin(), seconds.end());
        return seconds[seconds.size() / 2];
    }
};

// Largest difference from the falloff in double precision, relative to full scale.
template <class T>
double error_of(const std::vector<T> &source, const std::vector<T> &target) {
    double worst = 0.0;
    for (int y = 7; y < kHeight; y += 97)
        for (int x = 5; x < kWidth; x += 89)
            for (int c = 0; c < 3; c++) {
                const size_t at = 3 * (static_cast<size_t>(y) * kWidth + x) + c;
                const double wanted = std::min(double(source[at]) / attenuation(x, y), Kind<T>::unit);
                worst = std::max(worst, std::fabs(wanted - double(target[at])) / Kind<T>::unit);
            }
    return worst;
}

template <class T>
void measure() {
    std::vector<T> source(kSamples), target(kSamples);
    uint64_t random = 12345;
    for (T &value : source) {
        random = random * 6364136223846793005ull + 1442695040888963407ull;
        const double u = 0.6 * double(random >> 40) / double(1 << 24) * Kind<T>::unit;
        value = T(Kind<T>::unit == 1.0 ? u : std::floor(u));
    }
    const Ours gain(Kind<T>::sample, false), chain(Kind<T>::sample, true);
    const Lensfun lensfun(Kind<T>::lensfun);
    const PlainLoop<T> loop;
    cv::Mat from(kHeight, kWidth, Kind<T>::opencv, source.data()), to(kHeight, kWidth, Kind<T>::opencv, target.data());
    cv::Mat gains(kHeight, kWidth, CV_32FC3);
    for (int y = 0; y < kHeight; y++)
        for (int x = 0; x < kWidth; x++) {
            const float g = float(1.0 / attenuation(x, y));
            gains.at<cv::Vec3f>(y, x) = cv::Vec3f(g, g, g);
        }
    auto copy = [&] { std::memcpy(target.data(), source.data(), kSamples * sizeof(T)); };
    std::vector<Contender> all = {
        {"memcpy", copy, {}},
        {"lensprof, falloff of linear samples", [&] { gain.apply(source.data(), target.data(), Kind<T>::sample); }, {}},
        {"lensprof, response → falloff, exposure, white balance → response",
         [&] { chain.apply(source.data(), target.data(), Kind<T>::sample); },
         {}},
        {"Lensfun, falloff, in place", [&] { lensfun.apply(target.data(), kWidth * 3 * int(sizeof(T))); }, {}},
        {"OpenCV multiply by a gain image", [&] { cv::multiply(from, gains, to, 1.0, to.type()); }, {}},
        {"plain loop, response → falloff, white balance → response",
         [&] { loop.apply(source.data(), target.data()); },
         {}},
    };
    for (int round = 0; round <= kRounds; round++)
        for (Contender &one : all) {
            copy();  // Lensfun works in place; all start from the same data
            const double began = cpu_seconds();
            one.run();
            if (round) one.seconds.push_back(cpu_seconds() - began);  // the first round is a warm-up
        }
    gain.apply(source.data(), target.data(), Kind<T>::sample);
    const double error = error_of(source, target), megapixels = 1e-6 * kWidth * kHeight;
    double median[6];
    for (size_t i = 0; i < all.size(); i++) median[i] = all[i].median();
    for (size_t i = 0; i < all.size(); i++)
        std::printf("| %s | %s | %.0f | %.2f | %.2f | %.2f | %.2f |\n", Kind<T>::name, all[i].name.c_str(),
                    megapixels / median[i], median[i] / median[0], median[3] / median[i], median[4] / median[i],
                    median[5] / median[i]);
    std::fprintf(stderr,
                 "%s: falloff within %.2g of full scale; making a plan takes %.3f ms, of the whole chain %.3f ms\n",
                 Kind<T>::name, error, 1e3 * gain.init_s, 1e3 * chain.init_s);
}

// Options and plans of a 12 bit sensor of 24 megapixels, RGGB, with a pedestal of 256.
class Sensor {
public:
    Sensor() {
        lensprof_apply_options options;
        lensprof_readout readout;
        lensprof_response_set_linear(&response_);
        std::copy(kFalloff, kFalloff + 3, vignetting_.k);
        lensprof_apply_options_init(&options);
        options.response = &response_, options.vignetting = &vignetting_;
        options.frame_width = kWidth, options.frame_height = kHeight;
        options.source_sample = options.target_sample = LENSPROF_SAMPLE_U16;
        options.source_layout = LENSPROF_LAYOUT_RGGB;
        options.input = options.output = LENSPROF_ENCODING_LINEAR;
        options.levels = options.output_levels = &levels_;
        lensprof_readout_init(&readout);
        memory_[0].resize(lensprof_plan_bytes(&options) / 8 + 1);
        memory_[1].resize(lensprof_fixed_plan_bytes(&options) / 8 + 1);
        if (lensprof_readout_set_mosaic(&readout, "RGGB") != LENSPROF_OK) std::abort();
        memory_[2].resize(lensprof_sensor_plan_bytes(&readout) / 8 + 1);
        if (lensprof_plan_init(memory_[0].data(), memory_[0].size() * 8, &options, &plan, nullptr) != LENSPROF_OK
            || lensprof_fixed_plan_init(memory_[1].data(), memory_[1].size() * 8, &options, &fixed, nullptr)
                   != LENSPROF_OK
            || lensprof_sensor_plan_init(memory_[2].data(), memory_[2].size() * 8, &options, &readout, &grid, nullptr)
                   != LENSPROF_OK)
            std::abort();
    }
    const lensprof_plan *plan = nullptr;
    const lensprof_fixed_plan *fixed = nullptr;
    const lensprof_sensor_plan *grid = nullptr;

private:
    lensprof_response response_;
    lensprof_vignetting vignetting_{};
    lensprof_levels levels_ = {{256 / 65535.0, 256 / 65535.0, 256 / 65535.0}, 4095 / 65535.0};
    std::vector<uint64_t> memory_[3];
};

void must(lensprof_status status) {
    if (status != LENSPROF_OK) std::abort();
}

void measure_mosaic() {
    const size_t samples = static_cast<size_t>(kWidth) * kHeight;
    std::vector<uint16_t> source(samples), target(samples);
    for (size_t i = 0; i < samples; i++) source[i] = static_cast<uint16_t>(256 + i * 7919 % 2000);
    std::vector<uint8_t> packed(samples / 4 * 5);
    const Sensor sensor;
    const lensprof_target mosaic = {target.data(), kWidth * 2,          kWidth,
                                    kHeight,       LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGGB};
    const lensprof_target grey = {target.data(), kWidth * 2,          kWidth,
                                  kHeight,       LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY};
    const lensprof_packed_target raw = {packed.data(), kWidth * 5 / 4, kWidth, kHeight};
    cv::Mat from(kHeight, kWidth, CV_16UC1, source.data()), to(kHeight, kWidth, CV_16UC1, target.data());
    cv::Mat gains(kHeight, kWidth, CV_32FC1);
    for (int y = 0; y < kHeight; y++)
        for (int x = 0; x < kWidth; x++) gains.at<float>(y, x) = float(1.0 / attenuation(x, y));
    auto copy = [&] { std::memcpy(target.data(), source.data(), samples * 2); };
    std::vector<Contender> all = {
        {"memcpy", copy, {}},
        {"OpenCV multiply by a gain image, without black level",
         [&] { cv::multiply(from, gains, to, 1.0, CV_16U); },
         {}},
        {"lensprof, float plan", [&] { must(lensprof_apply(sensor.plan, nullptr, &mosaic, 0, 0)); }, {}},
        {"lensprof, grid of gains", [&] { must(lensprof_sensor_apply(sensor.grid, nullptr, &grey, 0, 0)); }, {}},
        {"lensprof, grid of gains, RAW10",
         [&] { must(lensprof_sensor_apply_packed(sensor.grid, LENSPROF_PACKING_RAW10, nullptr, &raw, 0, 0)); },
         {}},
        {"lensprof, integer plan", [&] { must(lensprof_fixed_apply(sensor.fixed, nullptr, &mosaic, 0, 0)); }, {}},
    };
    for (int round = 0; round <= 5; round++)
        for (Contender &one : all) {
            copy();
            const double began = cpu_seconds();
            one.run();
            if (round) one.seconds.push_back(cpu_seconds() - began);
        }
    const double first = all[0].median(), opencv = all[1].median();
    std::printf(
        "\n| mosaic of 24 megapixels, 16 bit | MP/s | x memcpy's time | x OpenCV's rate |\n|---|---:|---:|---:|\n");
    for (Contender &one : all)
        std::printf("| %s | %.0f | %.2f | %.2f |\n", one.name.c_str(), 1e-6 * double(samples) / one.median(),
                    one.median() / first, opencv / one.median());
}

}  // namespace

int main() {
    cv::setNumThreads(1);
    std::printf("24 megapixel RGB, one thread, CPU time, medians of %d rounds. Lensfun %d.%d.%d, OpenCV %s.\n\n",
                kRounds, LF_VERSION_MAJOR, LF_VERSION_MINOR, LF_VERSION_MICRO, CV_VERSION);
    std::printf("| samples | | MP/s | x memcpy's time | x Lensfun's rate | x OpenCV's rate | x the loop's rate |\n");
    std::printf("|---|---|---:|---:|---:|---:|---:|\n");
    measure<float>();
    measure<uint16_t>();
    measure<uint8_t>();
    measure_mosaic();
    return 0;
}
