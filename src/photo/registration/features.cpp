#include "photo/registration/features.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "photo/pictures/picture.hpp"

namespace lensprof {
namespace {

constexpr double reduced_side = 1200.0;  // px, approximate longer side after reduction
constexpr double contrast = 0.01;        // of SIFT: smooth pictures have no stronger ones

float sample_at(const uint8_t *samples, uint32_t type, size_t i) {
    switch (type) {
    case LENSPROF_SAMPLE_U8: return samples[i];
    case LENSPROF_SAMPLE_U16: return reinterpret_cast<const uint16_t *>(samples)[i];
    default: return reinterpret_cast<const float *>(samples)[i];
    }
}

// Means of the channels over squares of `reduction` px.
cv::Mat reduced_grey(PictureReader &reader, uint32_t reduction) {
    Picture rows = reader.header();
    const uint32_t channels = lensprof_layout_channels(rows.layout), samples = lensprof_layout_samples(rows.layout);
    const int width = static_cast<int>(rows.width / reduction), height = static_cast<int>(rows.height / reduction);
    cv::Mat grey(height, width, CV_32F, cv::Scalar(0));
    const uint32_t left = rows.height;
    rows.height = 1;
    rows.pixels.resize(rows.row_bytes);
    for (uint32_t y = 0; y < left; y++) {
        reader.read(rows.target());
        const int v = static_cast<int>(y / reduction);
        if (v >= height) continue;
        float *out = grey.ptr<float>(v);
        for (uint32_t x = 0; x < static_cast<uint32_t>(width) * reduction; x++)
            for (uint32_t c = 0; c < channels; c++)
                out[x / reduction] += sample_at(rows.pixels.data(), rows.sample, size_t(x) * samples + c);
    }
    return grey;
}

// 8 bit, stretched from the darkest to the brightest thousandth, so that dark pictures keep their texture. Linear
// samples are converted by square roots, close to how they are displayed.
cv::Mat stretched(cv::Mat grey, bool is_linear) {
    if (is_linear) {
        cv::max(grey, 0.0f, grey);
        cv::sqrt(grey, grey);
    }
    std::vector<float> sorted;
    for (int y = 0; y < grey.rows; y += 3)
        for (int x = 0; x < grey.cols; x += 3)
            if (std::isfinite(grey.at<float>(y, x))) sorted.push_back(grey.at<float>(y, x));
    if (sorted.empty()) return cv::Mat::zeros(grey.size(), CV_8U);
    std::sort(sorted.begin(), sorted.end());
    const size_t tail = sorted.size() / 1000;
    const double low = sorted[tail], high = sorted[sorted.size() - 1 - tail];
    const double scale = high > low ? 255.0 / (high - low) : 0.0;
    cv::Mat out;
    grey.convertTo(out, CV_8U, scale, -low * scale);
    return out;
}

// The frame as a square of 64 px, minus its blurred version: what a change of tone or a vignetting barely affects.
cv::Mat detail_of(const cv::Mat &grey) {
    constexpr int side = 64;
    constexpr double blur = 3.0;  // px
    cv::Mat small, smooth;
    cv::resize(grey, small, {side, side}, 0, 0, cv::INTER_AREA);
    small.convertTo(small, CV_32F);
    cv::GaussianBlur(small, smooth, {}, blur, blur, cv::BORDER_REFLECT);
    return small - smooth;
}

// SIFT features of a picture; their places in it, px.
struct Found {
    std::vector<cv::KeyPoint> points;
    cv::Mat descriptors;  // one row per point
};

Found detected(const cv::Mat &grey, uint32_t max_count) {
    Found found;
    cv::SIFT::create(static_cast<int>(max_count), 3, contrast)
        ->detectAndCompute(grey, cv::noArray(), found.points, found.descriptors);
    return found;
}

// The same at half the size, in a quarter of the time: without the finest features, which come last in every order.
Found detected_at_half(const cv::Mat &grey, uint32_t max_count) {
    const cv::Mat even = grey(cv::Rect(0, 0, grey.cols / 2 * 2, grey.rows / 2 * 2));
    if (even.empty()) return {};
    cv::Mat half;
    cv::resize(even, half, {even.cols / 2, even.rows / 2}, 0, 0, cv::INTER_AREA);
    Found found = detected(half, max_count);
    for (cv::KeyPoint &p : found.points) p.pt = 2.0f * p.pt + cv::Point2f(0.5f, 0.5f), p.size *= 2.0f;
    return found;
}

// Numbers of points, the largest first. A strict order, so that the result does not depend on the detector's order.
std::vector<int> largest_first(const std::vector<cv::KeyPoint> &points) {
    std::vector<int> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) {
        const cv::KeyPoint &p = points[static_cast<size_t>(a)], &q = points[static_cast<size_t>(b)];
        return std::tie(q.size, p.pt.x, p.pt.y, p.angle) < std::tie(p.size, q.pt.x, q.pt.y, q.angle);
    });
    return order;
}

}  // namespace

cv::Mat take_roots(const cv::Mat &descriptors) {
    cv::Mat roots(descriptors.rows, descriptors.cols, CV_16S), row;
    for (int y = 0; y < descriptors.rows; y++) {
        cv::sqrt(descriptors.row(y) / std::max(cv::norm(descriptors.row(y), cv::NORM_L1), 1e-9), row);
        row.convertTo(roots.row(y), CV_16S, unit_length);
    }
    return roots;
}

uint32_t most_features_of(size_t pictures) {
    constexpr size_t fewest = 800, usual = 3000, of_all = 240000;  // 60 MB
    return static_cast<uint32_t>(std::clamp(of_all / std::max<size_t>(pictures, 1), fewest, usual));
}

Features find_features(const std::string &file, uint32_t max_count, size_t enough) {
    PictureReader reader(file);
    const Picture &header = reader.header();
    Features features;
    features.width = header.width, features.height = header.height;
    features.is_grey = lensprof_layout_channels(header.layout) == 1;
    const double longer = std::max(header.width, header.height);
    const uint32_t reduction = std::max(1u, static_cast<uint32_t>(std::lround(longer / reduced_side)));
    if (header.width < reduction || header.height < reduction) return features;  // a line
    const cv::Mat grey = stretched(reduced_grey(reader, reduction),
                                   header.sample == LENSPROF_SAMPLE_F32 || header.traits.format == FileFormat::raw);
    features.detail = detail_of(grey);
    Found found;
    if (enough > 0) found = detected_at_half(grey, max_count);
    if (enough == 0 || found.points.size() < enough) found = detected(grey, max_count);
    cv::Mat sorted;
    for (int i : largest_first(found.points)) {
        const cv::Point2f &p = found.points[static_cast<size_t>(i)].pt;
        features.places.emplace_back((p.x + 0.5) * reduction - 0.5, (p.y + 0.5) * reduction - 0.5);
        sorted.push_back(found.descriptors.row(i));
    }
    features.descriptors = take_roots(sorted);
    return features;
}

}  // namespace lensprof
