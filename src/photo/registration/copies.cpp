#include "photo/registration/copies.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <opencv2/imgproc.hpp>

#include "threads/item_loop.hpp"

namespace lensprof {
namespace {

constexpr int blocks = 4;                // across and down
constexpr int coarse_side = 16;          // of the version that selects pairs
constexpr float coarse_like = 0.7f;      // minimum correlation of coarse versions
constexpr double texture = 1.0;          // minimum standard deviation of a block with detail, of 255
constexpr double block_like = 0.8;       // minimum correlation of blocks with detail,
constexpr double share_of_blocks = 0.9;  // in this share of them
constexpr int min_blocks = 4;            // with detail
constexpr double max_rounding = 0.01;    // of 255, in the detail of equal pixels; noise of two frames differs by more
constexpr double max_aspect_change = 0.02, max_time_change = 0.01;
constexpr int orientations = 8;
constexpr int is_flipped_x = 1, is_flipped_y = 2, is_transposed = 4;  // bits of an orientation

cv::Mat rotated(const cv::Mat &square, int orientation) {
    cv::Mat result = square.clone();
    if (orientation & is_transposed) result = result.t();
    if (orientation & is_flipped_x) cv::flip(result, result, 1);
    if (orientation & is_flipped_y) cv::flip(result, result, 0);
    return result;
}

// Mean 0 and length 1, as a row; 0 without texture.
Eigen::RowVectorXf coarse_row(const cv::Mat &detail) {
    cv::Mat small;
    cv::resize(detail, small, {coarse_side, coarse_side}, 0, 0, cv::INTER_AREA);
    Eigen::RowVectorXf row = Eigen::Map<const Eigen::RowVectorXf>(small.ptr<float>(), small.rows * small.cols);
    row.array() -= row.mean();
    return row.normalized();
}

// Whether two versions show the same detail everywhere: borders and date stamps alone are not enough.
bool has_same_detail(const cv::Mat &a, const cv::Mat &b) {
    const int side = a.rows / blocks;
    int with_detail = 0, alike = 0;
    for (int n = 0; n < blocks * blocks; n++) {
        const cv::Rect block(n % blocks * side, n / blocks * side, side, side);
        cv::Scalar mean_a, mean_b, sigma_a, sigma_b;
        cv::meanStdDev(a(block), mean_a, sigma_a);
        cv::meanStdDev(b(block), mean_b, sigma_b);
        if (std::max(sigma_a[0], sigma_b[0]) < texture) continue;
        const double covariance = a(block).dot(b(block)) / (side * side) - mean_a[0] * mean_b[0];
        with_detail++, alike += covariance > block_like * sigma_a[0] * sigma_b[0];
    }
    return with_detail >= min_blocks && alike >= share_of_blocks * with_detail;
}

bool is_resized(const Features &a, const Features &b) {
    return std::minmax(a.width, a.height) != std::minmax(b.width, b.height);
}

// Whether metadata and sizes permit that two pictures are copies in this orientation.
bool may_be_copies(const CopyCandidate &a, const CopyCandidate &b, int orientation) {
    if (a.is_raw != b.is_raw) return false;
    const auto &first = a.exposure_time_s, &second = b.exposure_time_s;
    if (first && second && std::abs(*first / *second - 1.0) > max_time_change) return false;
    const double aspect = static_cast<double>(a.picture->width) / a.picture->height;
    double other = static_cast<double>(b.picture->width) / b.picture->height;
    if (orientation & is_transposed) other = 1.0 / other;
    if (std::abs(aspect / other - 1.0) > max_aspect_change) return false;
    if (!a.captured.empty() && !b.captured.empty()) return a.captured == b.captured;
    return orientation != 0 || a.captured != b.captured || is_resized(*a.picture, *b.picture)
           || a.picture->is_grey != b.picture->is_grey
           || cv::norm(a.picture->detail, b.picture->detail, cv::NORM_INF) < max_rounding;
}

// The orientation of `b` in which it shows `a`; upright first.
std::optional<int> orientation_between(const CopyCandidate &a, const CopyCandidate &b) {
    for (int o = 0; o < orientations; o++)
        if (may_be_copies(a, b, o) && has_same_detail(a.picture->detail, rotated(b.picture->detail, o))) return o;
    return std::nullopt;
}

bool is_mirrored(int orientation) { return ((orientation & 1) + (orientation >> 1 & 1) + (orientation >> 2 & 1)) % 2; }

std::string describe(int orientation, bool is_resized) {
    std::string text = is_mirrored(orientation) ? ", mirrored" : orientation ? ", rotated" : "";
    return is_resized ? text + ", resized" : text;
}

constexpr uint32_t none = UINT32_MAX;

// For each picture the first earlier one that it is a copy of, or `none`.
std::vector<uint32_t> first_copies(const std::vector<CopyCandidate> &pictures) {
    const auto count = static_cast<uint32_t>(pictures.size());
    Rows all = Rows::Zero(count, coarse_side * coarse_side);
    for (uint32_t i = 0; i < count; i++)
        if (!pictures[i].picture->detail.empty()) all.row(i) = coarse_row(pictures[i].picture->detail);
    std::vector<uint32_t> first(count, none);
    for_each_item(count, thread_count(0), [&](uint32_t i, uint32_t) {
        const cv::Mat &detail = pictures[i].picture->detail;
        if (detail.empty() || i == 0) return true;
        Rows versions(orientations, all.cols());
        for (int o = 0; o < orientations; o++) versions.row(o) = coarse_row(rotated(detail, o));
        const Eigen::RowVectorXf likeness = (versions * all.topRows(i).transpose()).colwise().maxCoeff();
        for (uint32_t j = 0; j < i && first[i] == none; j++)
            if (likeness[j] > coarse_like && orientation_between(pictures[j], pictures[i])) first[i] = j;
        return true;
    });
    return first;
}

}  // namespace

std::vector<PictureCopy> find_copies(const std::vector<CopyCandidate> &pictures) {
    std::vector<uint32_t> first = first_copies(pictures), best(first.size());
    const auto rank = [&](uint32_t i) {
        const Features &f = *pictures[i].picture;
        return std::tuple(pictures[i].overlaps, uint64_t(f.width) * f.height, !f.is_grey,
                          !pictures[i].captured.empty());
    };
    for (uint32_t i = 0; i < first.size(); i++) {
        best[i] = i;
        if (first[i] == none) first[i] = i;
        first[i] = first[first[i]];  // the root is earlier, hence final
        if (rank(i) > rank(best[first[i]])) best[first[i]] = i;
    }
    std::vector<PictureCopy> copies;
    for (uint32_t i = 0; i < first.size(); i++) {
        const uint32_t original = best[first[i]];
        if (original == i) continue;
        if (const auto found = orientation_between(pictures[original], pictures[i]))
            copies.push_back({i, original,
                              describe(*found, is_resized(*pictures[original].picture, *pictures[i].picture)),
                              is_mirrored(*found)});
    }
    return copies;
}

}  // namespace lensprof
