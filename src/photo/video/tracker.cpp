#include "photo/video/tracker.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "fit/base/quantile.hpp"
#include "photo/video/look.hpp"

namespace lensprof {
namespace {

constexpr int reduced_side = 640;    // px, the longer side of the frames that are tracked
constexpr int most_corners = 360;    // per frame
constexpr double least_share = 0.8;  // of most_corners, below which new ones are added
constexpr double corner_quality = 0.004, largest_return_px = 0.6;
constexpr int window_px = 15, levels = 4, border_px = Look::reach + 3;
constexpr double least_kept = 0.15;  // of the corners, else the frame is a cut
constexpr uint32_t few_corners = 12;
constexpr double blank_levels = 6.0;  // mean of a frame without content, from black or white
constexpr double same_levels = 0.1;   // mean difference of a repeated frame

using Points = std::vector<cv::Point2f>;

// Pixels of a frame per pixel of the reduced frame.
uint32_t reduction(uint32_t width, uint32_t height) {
    return std::max(1u, (std::max(width, height) + reduced_side / 2) / reduced_side);
}

// The frame in grey, 8 bits, reduced by whole pixels.
cv::Mat reduced_grey(const Picture &frame, int side) {
    const int depth = frame.sample == LENSPROF_SAMPLE_U16 ? CV_16U : CV_8U;
    const int channels = frame.layout == LENSPROF_LAYOUT_GREY ? 1 : 3;
    const cv::Mat stored(static_cast<int>(frame.height), static_cast<int>(frame.width), CV_MAKETYPE(depth, channels),
                         const_cast<uint8_t *>(frame.pixels.data()), frame.row_bytes);
    cv::Mat grey = stored, small, bytes;
    if (channels == 3) cv::cvtColor(stored, grey, cv::COLOR_RGB2GRAY);
    if (side > 1) {
        const cv::Mat whole = grey(cv::Rect(0, 0, grey.cols / side * side, grey.rows / side * side));
        cv::resize(whole, small, {whole.cols / side, whole.rows / side}, 0, 0, cv::INTER_AREA);
        grey = small;
    }
    grey.convertTo(bytes, CV_8U, depth == CV_16U ? 255.0 / 65535.0 : 1.0);
    return bytes.data == frame.pixels.data() ? bytes.clone() : bytes;
}

std::array<double, 256> cumulative(const cv::Mat &grey) {
    std::array<double, 256> sums{};
    for (int y = 0; y < grey.rows; y++)
        for (int x = 0; x < grey.cols; x++) sums[grey.at<uint8_t>(y, x)]++;
    for (size_t i = 1; i < sums.size(); i++) sums[i] += sums[i - 1];
    for (double &sum : sums) sum /= double(grey.total());
    return sums;
}

// The frame with the grey values of the one before: equal shares of pixels get equal levels. This undoes any change of
// exposure, whatever the response, which Lucas-Kanade does not expect.
cv::Mat with_levels_of(const cv::Mat &before, const cv::Mat &grey) {
    const auto from = cumulative(grey), to = cumulative(before);
    cv::Mat table(1, 256, CV_8U), matched;
    for (int level = 0, wanted = 0; level < 256; level++) {
        const double below = level ? from[size_t(level) - 1] : 0.0, middle = 0.5 * (below + from[size_t(level)]);
        while (wanted < 255 && to[size_t(wanted)] < middle) wanted++;
        table.at<uint8_t>(level) = static_cast<uint8_t>(wanted);
    }
    cv::LUT(grey, table, matched);
    return matched;
}

// The mean variance of 7 x 7 pixels about each pixel; large where the mean is near black or white.
cv::Mat unevenness_of(const cv::Mat &grey) {
    constexpr double darkest = 14.0, brightest = 238.0, clipped_cost = 1e4;
    cv::Mat values, mean, squares;
    grey.convertTo(values, CV_32F);
    cv::blur(values, mean, {7, 7});
    cv::blur(values.mul(values), squares, {7, 7});
    cv::Mat variance = squares - mean.mul(mean);
    variance.setTo(clipped_cost, (mean < darkest) | (mean > brightest));
    return variance;
}

// The most even place around a corner, relative to it.
cv::Point2f even_offset(const cv::Mat &unevenness, cv::Point2f corner) {
    constexpr int reach = 4;
    const int x = cvRound(corner.x), y = cvRound(corner.y);
    float best = INFINITY;
    cv::Point2f offset(0, 0);
    for (int dy = -reach; dy <= reach; dy += 2)
        for (int dx = -reach; dx <= reach; dx += 2) {
            const int u = x + dx, v = y + dy;
            if (u < 4 || v < 4 || u >= unevenness.cols - 4 || v >= unevenness.rows - 4) continue;
            const float value = unevenness.at<float>(v, u);
            if (value < best) best = value, offset = {float(u) - corner.x, float(v) - corner.y};
        }
    return offset;
}

}  // namespace

struct CornerTracker::State {
    struct Corner {
        uint32_t track;
        cv::Point2f born, offset;
        Look look;
        Warp warp;

        cv::Point2f place() const { return {float(warp.place.x()), float(warp.place.y())}; }
    };

    void follow(const cv::Mat &grey, TrackedFrame &found);
    void find_new(const cv::Mat &grey);

    cv::Mat before, smooth;  // the frame before; this one without noise
    std::vector<cv::Mat> pyramid_before;
    std::vector<Corner> corners;
    uint32_t next_track = 0;
};

CornerTracker::CornerTracker() : state_(std::make_unique<State>()) {}
CornerTracker::~CornerTracker() = default;

// Keeps the corners that are found in the frame, and from there again where they were.
void CornerTracker::State::follow(const cv::Mat &grey, TrackedFrame &found) {
    if (corners.empty()) return;
    const cv::Size window(window_px, window_px);
    const cv::TermCriteria criteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 20, 0.01);
    std::vector<cv::Mat> pyramid;
    cv::buildOpticalFlowPyramid(with_levels_of(before, grey), pyramid, window, levels - 1);
    Points from, to, back;
    for (const Corner &corner : corners) from.push_back(corner.place());
    std::vector<uint8_t> is_found, is_back;
    cv::calcOpticalFlowPyrLK(pyramid_before, pyramid, from, to, is_found, cv::noArray(), window, levels - 1, criteria);
    cv::calcOpticalFlowPyrLK(pyramid, pyramid_before, to, back, is_back, cv::noArray(), window, levels - 1, criteria);
    std::vector<Corner> kept;
    std::vector<double> motion, travel;
    const cv::Rect2f inside(border_px, border_px, float(grey.cols - 2 * border_px), float(grey.rows - 2 * border_px));
    size_t inner = 0;  // corners that did not leave the frame
    for (size_t i = 0; i < corners.size(); i++) {
        const bool is_inside = inside.contains(to[i]);
        inner += is_inside || !is_found[i];
        if (!is_found[i] || !is_back[i] || !is_inside || cv::norm(back[i] - from[i]) > largest_return_px) continue;
        Warp warp = corners[i].warp;
        warp.place = {double(to[i].x), double(to[i].y)};
        if (!corners[i].look.align(smooth, warp)) continue;
        kept.push_back(corners[i]);
        kept.back().warp = warp;
        motion.push_back(cv::norm(kept.back().place() - from[i]));
        travel.push_back(cv::norm(kept.back().place() - corners[i].born));
    }
    const double half_diagonal = 0.5 * std::hypot(grey.cols, grey.rows);
    found.kept = inner ? double(kept.size()) / double(std::max(inner, kept.size())) : 0.0;
    found.motion = upper_median(motion) / half_diagonal;
    found.travel = upper_median(travel) / half_diagonal;
    if (found.kept < least_kept || kept.size() < few_corners / 2) kept.clear();
    corners = std::move(kept);
    found.found_again = corners.size();
}

void CornerTracker::State::find_new(const cv::Mat &grey) {
    if (double(corners.size()) >= least_share * most_corners) return;
    const double distance = std::sqrt(double(grey.total()) / most_corners) * 0.6;
    cv::Mat mask(grey.size(), CV_8U, cv::Scalar(0));
    mask(cv::Rect(border_px, border_px, grey.cols - 2 * border_px, grey.rows - 2 * border_px)) = 255;
    for (const Corner &corner : corners) cv::circle(mask, corner.place(), cvRound(distance), cv::Scalar(0), cv::FILLED);
    Points found;
    cv::goodFeaturesToTrack(grey, found, most_corners - int(corners.size()), corner_quality, distance, mask, 5);
    const cv::Mat unevenness = unevenness_of(grey);
    for (const cv::Point2f &place : found)
        corners.push_back({next_track++, place, even_offset(unevenness, place), Look(smooth, place), Warp(place)});
}

bool CornerTracker::can_follow(uint32_t width, uint32_t height) {
    return std::min(width, height) / reduction(width, height) > 2 * window_px;
}

TrackedFrame CornerTracker::add(const Picture &frame) {
    const int side = static_cast<int>(reduction(frame.width, frame.height));
    const cv::Mat grey = reduced_grey(frame, side);
    TrackedFrame found;
    found.side = static_cast<uint32_t>(side);
    found.mean_level = cv::mean(grey)[0];
    found.is_blank = found.mean_level < blank_levels || found.mean_level > 255.0 - blank_levels;
    State &s = *state_;
    if (found.is_blank) {
        s.corners.clear(), s.before.release();
        return found;
    }
    cv::GaussianBlur(grey, s.smooth, {3, 3}, 0.7);
    if (!s.before.empty() && s.before.size() == grey.size()) {
        found.repeats = cv::norm(s.before, grey, cv::NORM_L1) <= same_levels * double(grey.total());
        s.follow(grey, found);
    }
    s.find_new(grey);
    s.before = grey;
    cv::buildOpticalFlowPyramid(grey, s.pyramid_before, {window_px, window_px}, levels - 1);
    for (const State::Corner &corner : s.corners) {
        const Eigen::Vector2f place = corner.warp(corner.offset.x, corner.offset.y).cast<float>() * float(side);
        const Eigen::Matrix2f shape = corner.warp.shape.cast<float>();
        const float middle = 0.5f * float(side - 1);  // of the square of a reduced pixel
        found.places.push_back({corner.track,
                                place.x() + middle,
                                place.y() + middle,
                                {shape(0, 0), shape(0, 1), shape(1, 0), shape(1, 1)}});
    }
    return found;
}

}  // namespace lensprof
