// The first estimate is a rotation w (axis times angle, radians) of the second camera, which corrects wrong rotations
// of a project. The similarity of two blocks a and b of grey levels is their normalised cross-correlation
//
//     sum (a - mean a)(b - mean b) / sqrt(sum (a - mean a)^2 sum (b - mean b)^2),      -1 .. 1,
//
// which a gain and an offset of either (exposure, falloff within a block) leave as it is. For block m of the first
// image the best place near the expected one is off by o_m (px of the full frame). To first order a change d of w moves
// the expected place by J_m d, J_m = d place / d w (2 x 3, px a radian, by finite differences), so that d minimises
//
//     sum_m c_m |o_m - J_m d|^2 + (p / T)^2 |d|^2,     (sum_m c_m J_m'J_m + (p / T)^2 I) d = sum_m c_m J_m'o_m.
//
// p is a pixel of the level, the accuracy of a place, and T = kTrust the expected error of a project in
// radians: rotations that no block determines (about the axis of view, with all blocks at one place) stay 0. The trust
//
//     c_m = correlation / (1 + |o_m - J_m d|^2 / s^2),      s = 4 p at first, then p,
//
// is that of a Cauchy loss, iterated: blocks on things that moved do not bias the rest. The search goes from
// the coarse level, whose first guess is the shift under which all blocks match best together, to the fine one.
//
// A wrong angle of view, distortion or a camera that was moved leave more than a rotation. If blocks do not match
// under a rotation, the second frame is bent by a homography as well. Every block is searched for separately, over a
// wide area; the similarity transform of two blocks that most other blocks support is the first guess. With places s =
// (u, v) of the second frame in half diagonals, the change M of the homography moves them by
//
//     du = h1 u + h2 v + h3 + u (h7 u + h8 v),     dv = h4 u + h5 v + h6 + v (h7 u + h8 v),
//
// linear in h, which is fitted as d is, with T = kBendTrust.
//
// If there are few blocks, or each shows only an edge, their separate places carry little information. The first step
// is then a joint estimate: the rotation under which the mean square of their positive correlations is largest, by a
// search along its three axes.
//
// Each is accepted only where the correlations of most blocks are clearly better than without it.
#include "fit/sampling/registration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <lensprof/model.h>

#include "fit/base/quantile.hpp"
#include "fit/sampling/block_search.hpp"

namespace lensprof {
namespace {

constexpr int kColumns = 24, kRows = 18;  // places of the first image that are examined, if the second sees them
constexpr size_t kMinBlocks = 8;          // blocks required if each is matched separately,
constexpr size_t kMinJointBlocks = 3;     // and if they are matched together
constexpr double kMatchOfFew = 0.75;  // mean correlation of fewer than kMinBlocks blocks: some shift matches by chance
constexpr int kCell = 2;              // neighbouring places, of which one is used, so that no single object decides
constexpr int kFarthest = 12;         // coarse pixels by which the project may be off,
constexpr int kFarthestBlock = 24;    // and by which one block may be
constexpr int kSearch = 3;            // level pixels around the expected place of a block
constexpr double kMatch = 0.5;        // smallest correlation of blocks that show the same,
constexpr double kFarMatch = 0.6;     // and of those found over a wide area: the best of many
constexpr double kOfCoarse = 0.5;     // texture of a block on the fine level, relative to that on the coarse one,
constexpr double kFineTexture = 0.0075;  // or standard deviation, grey value 0..1
constexpr double kRight = 0.85;          // mean correlation of a project that is right
constexpr double kInPlace = 0.6;         // the same, if blocks show that no small correction is needed
constexpr double kSmallestShift = 0.5;   // fine pixels: smaller corrections are not made
constexpr double kBetter = 0.02;         // mean correlation by which a correction must be better than none,
constexpr double kClearlyBetter = 0.1;   // the same, if many blocks show things that moved or are at other distances
constexpr double kPreferred = 0.05;      // significant difference of correlations
constexpr double kTrust = 0.01;      // radians: expected error of a project, for rotations that blocks do not determine
constexpr double kBendTrust = 0.02;  // the same of a homography's elements
constexpr double kLargestBend = 0.25;     // rotation or change of scale of a first guess
constexpr double kFollows = 2.0;          // coarse pixels within which a block follows a guess
constexpr double kMinFollowing = 0.2;     // share of the blocks that follow a guess
constexpr double kDerivativeStep = 1e-4;  // radians
constexpr std::array<int, 2> kNoShift = {0, 0};

// A block of the first image, and its place in the second according to the project.
struct Place {
    double x, y;
    Gaze gaze;
    size_t cell;
    std::array<Block<4>, 2> block;  // per level

    // Whether the block has texture on a level: that of the coarse level's larger block may be outside the fine
    // level's.
    bool shows(size_t level) const {
        return level == 0 || block[1].texture > std::min(kOfCoarse * block[0].texture, kFineTexture);
    }
};

// A block that was found in the second image.
struct Match {
    const Place *place;
    Sight expected;       // expected place in the second image
    Eigen::Vector2d off;  // and its offset from there, px of the full frame
    double quality;
    Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, 8> rows;  // derivative of the expected place by every unknown
};

// The h that minimises sum c_m |off_m - rows_m h|^2 + ridge^2 |h|^2, with c_m being the trust.
Eigen::VectorXd robust_step(const std::vector<Match> &matches, double ridge, double pixel) {
    const Eigen::Index size = matches.front().rows.cols();
    Eigen::VectorXd change = Eigen::VectorXd::Zero(size);
    for (int round = 0; round < 8; round++) {
        Eigen::MatrixXd normal = Eigen::MatrixXd::Identity(size, size) * ridge * ridge;
        Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
        for (const Match &m : matches) {
            const double distance = (m.off - m.rows * change).norm() / (round ? pixel : 4.0 * pixel);
            const double weight = m.quality / (1.0 + distance * distance);
            normal += weight * m.rows.transpose() * m.rows;
            right += weight * m.rows.transpose() * m.off;
        }
        change = normal.ldlt().solve(right);
    }
    return change;
}

using Correlations = std::vector<std::optional<double>>;  // per place; empty if the second image does not see it

double mean_of(const Correlations &correlations, size_t &count) {
    double sum = 0.0;
    count = 0;
    for (const auto &correlation : correlations)
        if (correlation) sum += *correlation, count++;
    return count ? sum / static_cast<double>(count) : 0.0;
}

// The weight of a correlation in the search for the shift under which all blocks match together. Blocks of things that
// moved have random correlations around 0; the square keeps their share small compared with that of the blocks that
// match.
double agreement(double correlation) { return correlation > 0.0 ? correlation * correlation : 0.0; }

struct Matcher {
    const lensprof_camera &first, &second;
    const GreyLevels &first_grey, &second_grey;
    std::vector<Place> places;

    bool overlap_box(double low[2], double high[2]) const;
    bool is_textured(const Place &p) const;
    void find_places();
    double mean_agreement(size_t level, const Rotation &rotation) const;
    Rotation together(const std::array<int, 2> &shift) const;
    std::vector<double> around(size_t level, const Place &place, const Sight &expected, const Shifts &shifts) const;
    Correlations correlations(size_t level, const Correction &correction) const;
    std::array<int, 2> common_shift() const;
    std::vector<Match> look(size_t level, const Shifts &shifts, double least, const Correction &correction) const;
    bool refine(size_t level, const std::array<int, 2> &shift, Rotation &rotation) const;
    bool refine_bend(size_t level, Correction &correction) const;
    bool guess_bend(Correction &correction) const;
    std::optional<Rotation> rotation(const std::array<int, 2> &shift) const;
    std::optional<Correction> bent(Correction correction) const;
    bool is_better(const Correction &correction, const Correlations &correlations, const Correction &reference,
                   const Correlations &without) const;
    double median_shift(const Correction &from, const Correction &to) const;
    bool is_in_place(const Correlations &uncorrected) const;
};

// The approximate area of the first frame that the second sees: shares of its width and height. False if it sees
// nothing.
bool Matcher::overlap_box(double low[2], double high[2]) const {
    constexpr int kScan = 48;
    std::fill(low, low + 2, 1.0), std::fill(high, high + 2, 0.0);
    for (int row = 0; row < kScan; row++)
        for (int column = 0; column < kScan; column++) {
            const double position[2] = {(column + 0.5) / kScan, (row + 0.5) / kScan};
            const bool is_seen = sees(first, second, position[0], position[1]);
            for (int d = 0; d < 2 && is_seen; d++)
                low[d] = std::min(low[d], position[d] - 0.5 / kScan),
                high[d] = std::max(high[d], position[d] + 0.5 / kScan);
        }
    return high[0] > low[0];
}

// Whether the texture comes from the scene: clear, or faint but well above the noise, as in a dark picture.
bool Matcher::is_textured(const Place &p) const {
    constexpr double kFaint = 0.004, kReliable = 0.8;
    const double texture = p.block[0].texture;
    if (texture > kTexture) return true;
    return texture > kFaint && first_grey.reliability(p.x, p.y, texture) > kReliable;
}

// Finds the block with the most texture in every cell of the first image that the second sees too.
void Matcher::find_places() {
    double low[2], high[2];
    if (!overlap_box(low, high)) return;
    for (int row = 0; row < kRows; row++)
        for (int column = 0; column < kColumns; column++) {
            const double x = (low[0] + (column + 0.5) / kColumns * (high[0] - low[0])) * first.width - 0.5;
            const double y = (low[1] + (row + 0.5) / kRows * (high[1] - low[1])) * first.height - 0.5;
            Place p{x, y, {first, {}, Way::forward, x, y}, {}, {}};
            p.cell = static_cast<size_t>(row / kCell * (kColumns / kCell) + column / kCell);
            Sight expected;
            bool good = p.gaze.sight(second, {}, Way::forward, expected);
            for (size_t n = 0; n < 2 && good; n++)
                good = p.block[n].cut_flat(first_grey.level[n], p.x, p.y, first_grey.level[n].pixel, kUpright);
            if (good && is_textured(p)) places.push_back(p);
        }
    std::stable_sort(places.begin(), places.end(),
                     [](const Place &a, const Place &b) { return a.block[0].texture > b.block[0].texture; });
    std::array<bool, (kColumns / kCell) * (kRows / kCell)> taken{};
    auto is_taken = [&](const Place &p) { return std::exchange(taken[p.cell], true); };
    places.erase(std::remove_if(places.begin(), places.end(), is_taken), places.end());
}

// Correlations of a place's block with the second image's around the expected place.
std::vector<double> Matcher::around(size_t n, const Place &place, const Sight &expected, const Shifts &shifts) const {
    return correlations_around(place.block[n], second_grey.level[n], expected, first_grey.level[n].pixel, shifts);
}

Correlations Matcher::correlations(size_t n, const Correction &correction) const {
    Correlations result;
    Block<4> other;
    Sight expected;
    for (const Place &p : places) {
        bool seen =
            p.shows(n) && p.gaze.sight(second, correction, Way::forward, expected)
            && other.cut_flat(second_grey.level[n], expected.x, expected.y, first_grey.level[n].pixel, expected.map);
        result.push_back(seen ? std::optional(p.block[n].correlation(other)) : std::nullopt);
    }
    return result;
}

// The shift, in coarse pixels of the second image, under which all blocks together match best.
std::array<int, 2> Matcher::common_shift() const {
    const Shifts shifts{kNoShift, kFarthest, 1};
    std::vector<double> sum(shifts.count());
    std::vector<size_t> count(shifts.count());
    Sight expected;
    for (const Place &p : places) {
        if (!p.gaze.sight(second, {}, Way::forward, expected)) continue;
        const std::vector<double> found = around(0, p, expected, shifts);
        for (size_t k = 0; k < found.size(); k++)
            if (found[k] != kOutside) sum[k] += agreement(found[k]), count[k]++;
    }
    double best = 0.0;
    std::array<int, 2> shift = kNoShift;
    for (size_t k = 0; k < shifts.count(); k++) {
        const double mean =
            count[k] >= std::max(kMinJointBlocks, places.size() / 4) ? sum[k] / static_cast<double>(count[k]) : 0.0;
        if (mean > best) best = mean, shift = shifts.at(k);
    }
    return shift;
}

// Searches for every block around its expected place under the correction.
std::vector<Match> Matcher::look(size_t n, const Shifts &shifts, double least, const Correction &correction) const {
    const double pixel = second_grey.level[n].pixel;
    std::vector<Match> matches;
    for (const Place &p : places) {
        Match m{};
        m.place = &p;
        if (!p.gaze.sight(second, correction, Way::forward, m.expected)) continue;
        const std::vector<double> found = around(n, p, m.expected, shifts);
        const auto best = std::max_element(found.begin(), found.end());
        if (!(*best > least)) continue;
        const auto [du, dv] = shifts.at(static_cast<size_t>(best - found.begin()));
        m.quality = *best, m.off = {du * pixel, dv * pixel};
        matches.push_back(m);
    }
    return matches;
}

// Mean over the blocks that are seen under the rotation; -1 if there are too few.
double Matcher::mean_agreement(size_t level, const Rotation &rotation) const {
    Correlations agreements = correlations(level, {rotation, {}});
    for (auto &correlation : agreements)
        if (correlation) correlation = agreement(*correlation);
    size_t count;
    const double mean = mean_of(agreements, count);
    const auto showing = std::count_if(places.begin(), places.end(), [=](const Place &p) { return p.shows(level); });
    return 2 * count > static_cast<size_t>(showing) ? mean : -1.0;
}

// The rotation under which all blocks together match best: along the axes through the middle of the second frame, with
// steps of two pixels at first.
Rotation Matcher::together(const std::array<int, 2> &shift) const {
    double middle[2], one_px_aside[2];
    const double x = 0.5 * (second.width - 1.0), y = 0.5 * (second.height - 1.0);
    if (!lensprof_camera_unproject(&second, x, y, middle)
        || !lensprof_camera_unproject(&second, x + 1.0, y, one_px_aside))
        return {};
    Eigen::Vector3d ahead, aside;
    unit_vector(middle, ahead.data()), unit_vector(one_px_aside, aside.data());
    const double angle = std::acos(std::min(1.0, ahead.dot(aside)));  // of one px of the full frame
    const Eigen::Vector3d right = (aside - ahead * ahead.dot(aside)).normalized(), up = right.cross(ahead);
    // A rotation by +angle about `up` moves what is ahead to the right or to the left: both are tried.
    const Eigen::Vector3d axes[3] = {angle * up, angle * right, ahead * 2.0 / std::hypot(second.width, second.height)};
    const double coarse = second_grey.level[0].pixel;
    Rotation best{};
    double best_agreement = mean_agreement(0, best);
    auto try_from = [&](size_t level, const Rotation &from, const Eigen::Vector3d &change) {
        const Rotation next{from[0] + change[0], from[1] + change[1], from[2] + change[2]};
        const double mean = mean_agreement(level, next);
        if (mean > best_agreement) best_agreement = mean, best = next;
    };
    const Rotation no_rotation{};
    for (double a : {-1.0, 1.0})
        for (double b : {-1.0, 1.0})
            try_from(0, no_rotation, coarse * (a * shift[0] * axes[0] + b * shift[1] * axes[1]));
    for (size_t level : {0, 1}) {
        best_agreement = mean_agreement(level, best);
        for (double step = level == 0 ? 2.0 : 1.0; step > 0.2; step *= 0.5)
            for (int round = 0; round < 6; round++) {
                const Rotation from = best;
                for (const Eigen::Vector3d &axis : axes)
                    for (double sign : {-1.0, 1.0})
                        try_from(level, from, sign * step * second_grey.level[level].pixel * axis);
                if (from == best) break;
            }
    }
    return best;
}

// Fits the rotation to the places of the blocks: least squares, with less trust in blocks that are far from the others.
bool Matcher::refine(size_t n, const std::array<int, 2> &shift, Rotation &rotation) const {
    const double pixel = second_grey.level[n].pixel;
    std::vector<Match> matches = look(n, {shift, kSearch, 1}, kMatch, {rotation, {}});
    auto is_lost = [&](Match &m) {
        m.rows.resize(2, 3);
        for (int d = 0; d < 3; d++) {
            Rotation rotated = rotation;
            rotated[static_cast<size_t>(d)] += kDerivativeStep;
            double moved[2];
            if (!place_of(first, second, {rotated, {}}, Way::forward, m.place->x, m.place->y, moved)) return true;
            m.rows.col(d) << (moved[0] - m.expected.x) / kDerivativeStep, (moved[1] - m.expected.y) / kDerivativeStep;
        }
        return false;
    };
    matches.erase(std::remove_if(matches.begin(), matches.end(), is_lost), matches.end());
    if (matches.size() < kMinBlocks) return false;
    const Eigen::VectorXd change = robust_step(matches, pixel / kTrust, pixel);
    for (int d = 0; d < 3; d++) rotation[static_cast<size_t>(d)] += change[d];
    return change.allFinite();
}

// The same for the homography.
bool Matcher::refine_bend(size_t n, Correction &correction) const {
    const double pixel = second_grey.level[n].pixel, scale = lensprof_half_diagonal(second.width, second.height);
    std::vector<Match> matches = look(n, {kNoShift, kSearch, 1}, kMatch, correction);
    if (matches.size() < kMinBlocks) return false;
    for (Match &m : matches) {
        const Eigen::Vector2d s = frame_place(second, m.expected.x, m.expected.y);
        m.rows.resize(2, 8);
        m.rows.row(0) << s[0], s[1], 1.0, 0.0, 0.0, 0.0, s[0] * s[0], s[0] * s[1];
        m.rows.row(1) << 0.0, 0.0, 0.0, s[0], s[1], 1.0, s[1] * s[0], s[1] * s[1];
        m.rows *= scale;
    }
    const Eigen::VectorXd h = robust_step(matches, pixel / kBendTrust, pixel);
    Eigen::Matrix3d change;
    change << 1.0 + h[0], h[1], h[2], h[3], 1.0 + h[4], h[5], -h[6], -h[7], 1.0;
    correction.bend = Bend(change * correction.bend->forward);
    return h.allFinite() && correction.bend->forward.determinant() > 0.0;
}

// The similarity that most blocks follow, among those defined by two blocks; false if too few follow any. Tries all
// pairs of blocks, or evenly chosen ones.
bool Matcher::guess_bend(Correction &correction) const {
    constexpr size_t kMaxGuesses = 4000;
    const double pixel = second_grey.level[0].pixel, scale = lensprof_half_diagonal(second.width, second.height);
    const std::vector<Match> matches = look(0, {kNoShift, kFarthestBlock, 2}, kFarMatch, correction);
    using Complex = std::complex<double>;
    std::vector<Complex> from, off;
    for (const Match &m : matches) {
        const Eigen::Vector2d s = frame_place(second, m.expected.x, m.expected.y);
        from.emplace_back(s[0], s[1]), off.emplace_back(m.off[0] / scale, m.off[1] / scale);
    }
    const size_t count = matches.size(), guesses = count * (count - 1) / 2;
    const size_t step = 1 + guesses / kMaxGuesses;
    double best = 0.0;
    Complex turn, shift;
    size_t guess = 0;
    for (size_t a = 0; a < count; a++)
        for (size_t b = a + 1; b < count; b++) {
            if (guess++ % step) continue;
            const Complex factor = (off[b] - off[a]) / (from[b] - from[a]), moved = off[a] - factor * from[a];
            if (!(std::abs(factor) < kLargestBend)) continue;
            double follow = 0.0;
            for (size_t m = 0; m < count; m++)
                follow += std::abs(off[m] - moved - factor * from[m]) * scale < kFollows * pixel;
            if (follow > best) best = follow, turn = factor, shift = moved;
        }
    if (best < std::max(double(kMinBlocks), kMinFollowing * static_cast<double>(count))) return false;
    Eigen::Matrix3d bend;
    bend << 1.0 + turn.real(), -turn.imag(), shift.real(), turn.imag(), 1.0 + turn.real(), shift.imag(), 0.0, 0.0, 1.0;
    correction.bend = Bend(bend);
    return true;
}

// Median distance between the places of blocks under two corrections, px of the full frame.
double Matcher::median_shift(const Correction &a, const Correction &b) const {
    std::vector<double> shifts;
    for (const Place &p : places) {
        double from[2], to[2];
        if (place_of(first, second, a, Way::forward, p.x, p.y, from)
            && place_of(first, second, b, Way::forward, p.x, p.y, to))
            shifts.push_back(std::hypot(to[0] - from[0], to[1] - from[1]));
    }
    return upper_median(std::move(shifts));
}

// Whether most blocks match better with the correction than without: things that moved prefer it, too, but the scene
// around them does not.
bool most_prefer(const Correlations &corrected, const Correlations &without) {
    size_t better = 0, worse = 0;
    for (size_t p = 0; p < corrected.size(); p++) {
        double gain = corrected[p].value_or(0.0) - without[p].value_or(0.0);
        better += gain > kPreferred, worse += gain < -kPreferred;
    }
    return better > 2 * worse;
}

// Whether most blocks match clearly better, at places that are clearly different. `correlations` and `without` are the
// correlations of the two.
bool Matcher::is_better(const Correction &correction, const Correlations &correlations, const Correction &reference,
                        const Correlations &without) const {
    size_t compared, found_in;
    const double before = mean_of(without, compared), found = mean_of(correlations, found_in);
    const bool is_match =
        found_in < kMinBlocks ? found > kMatchOfFew : found > kMatch || found > before + kClearlyBetter;
    return 2 * found_in > compared && is_match && found > before + kBetter && most_prefer(correlations, without)
           && median_shift(reference, correction) > kSmallestShift * second_grey.level[1].pixel;
}

// Whether blocks match where the project has them, and no better slightly displaced: noise keeps their correlations low
// even if the project is right. `uncorrected`: correlations without a correction.
bool Matcher::is_in_place(const Correlations &uncorrected) const {
    size_t compared;
    const double mean = mean_of(uncorrected, compared);
    Rotation rotated{};
    Correction bent{rotated, Bend(Eigen::Matrix3d::Identity())};
    if (compared < kMinBlocks || !(mean > kInPlace) || !refine(1, kNoShift, rotated) || !refine_bend(1, bent))
        return false;
    const double max_shift = kSmallestShift * second_grey.level[1].pixel;
    return median_shift({}, {rotated, {}}) < max_shift && median_shift({}, bent) < max_shift;
}

std::optional<Rotation> Matcher::rotation(const std::array<int, 2> &shift) const {
    Rotation rotation{};
    if (!refine(0, shift, rotation) || !refine(0, kNoShift, rotation)) return std::nullopt;
    for (int round = 0; round < 2; round++)
        if (!refine(1, kNoShift, rotation)) return std::nullopt;
    return rotation;
}

std::optional<Correction> Matcher::bent(Correction correction) const {
    if (!guess_bend(correction)) return std::nullopt;
    for (size_t level : {0, 0, 1, 1})
        if (!refine_bend(level, correction)) return std::nullopt;
    return correction;
}

}  // namespace

Correction registration(const lensprof_camera &first, const GreyLevels &first_grey, const lensprof_camera &second,
                        const GreyLevels &second_grey) {
    Matcher matcher{first, second, first_grey, second_grey, {}};
    matcher.find_places();
    if (matcher.places.size() < kMinJointBlocks) return {};
    Correction found;
    Correlations correlations = matcher.correlations(1, found);
    auto is_right = [&] {
        size_t compared;
        const double mean = mean_of(correlations, compared);
        return compared < kMinJointBlocks || mean > kRight;
    };
    auto take_if_better = [&](const Correction &other) {
        const Correlations other_correlations = matcher.correlations(1, other);
        if (matcher.is_better(other, other_correlations, found, correlations))
            found = other, correlations = other_correlations;
    };
    if (is_right() || matcher.is_in_place(correlations)) return found;
    const std::array<int, 2> shift = matcher.common_shift();  // start of both rotations
    if (const auto rotation = matcher.rotation(shift)) take_if_better({*rotation, {}});
    if (is_right()) return found;
    take_if_better({matcher.together(shift), {}});
    if (is_right()) return found;
    if (const auto bent = matcher.bent(found)) take_if_better(*bent);
    return found;
}

}  // namespace lensprof
