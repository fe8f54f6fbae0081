// What is estimated is a rotation w (axis times angle, radians) of the second camera, which a project that is off by
// turns needs. The similarity of two blocks a and b of grey levels is their normalised cross-correlation
//
//     sum (a - mean a)(b - mean b) / sqrt(sum (a - mean a)^2 sum (b - mean b)^2),      -1 .. 1,
//
// which a gain and an offset of either (exposure, falloff within a block) leave as it is. For block m of the first
// image the best place near the expected one is off by o_m (px of the full frame). To first order a change d of w moves
// the expected place by J_m d, J_m = d place / d w (2 x 3, px a radian, by finite differences), so that d minimises
//
//     sum_m c_m |o_m - J_m d|^2 + (p / T)^2 |d|^2,     (sum_m c_m J_m'J_m + (p / T)^2 I) d = sum_m c_m J_m'o_m.
//
// p is a pixel of the level, which is what a place is known to, and T = kTrust the radians that a project is off
// beforehand: turns that no block shows (about the axis of view, with all blocks at one place) stay 0. The trust
//
//     c_m = correlation / (1 + |o_m - J_m d|^2 / s^2),      s = 4 p at first, then p,
//
// is that of a Cauchy loss, iterated: blocks on things that moved do not draw the rest along. From the coarse level,
// whose first guess is the shift under which all blocks match best together, to the fine one; accepted only where the
// correlations of most blocks are clearly better than by the project.
#include "fit/sampling/registration.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace lensprof {
namespace {

constexpr int kColumns = 24, kRows = 18;  // places of the first image that are looked at
constexpr size_t kFewest = 8;             // blocks that take part
constexpr int kCell = 2;                  // places side by side, of which one takes part: no single thing decides
constexpr int kFarthest = 12;             // coarse pixels by which the project may be off
constexpr int kSearch = 3;                // level pixels about where a block is expected
constexpr double kTexture = 0.015;        // standard deviation of a block, grey value 0..1: more than noise
constexpr double kMatch = 0.5;            // correlation of blocks that show the same, at least
constexpr double kRight = 0.85;           // mean correlation of a project that is right
constexpr double kBetter = 0.02;          // mean correlation by which a rotation must be better than the project
constexpr double kPreferred = 0.05;       // difference of correlations that tells
constexpr double kTrust = 0.01;           // radians: how far off a project is, for turns that blocks do not tell
constexpr double kDerivativeStep = 1e-4;  // radians

// Square of level pixels about a place, without its mean and of length 1.
template <int reach>
struct Block {
    static constexpr int kSide = 2 * reach + 1, kCount = kSide * kSide;
    std::array<float, kCount> value;
    double texture = 0.0;  // standard deviation before

    // (x, y): full frame. `map` turns and scales the square, given in px of the full frame `pixel` apart.
    bool cut(const GreyLevels::Level &level, double x, double y, double pixel, const double map[2][2]) {
        double u0 = (x + 0.5) / level.pixel, v0 = (y + 0.5) / level.pixel, step = pixel / level.pixel;
        float sum = 0.0f, square = 0.0f;
        for (int k = 0; k < kCount; k++) {
            double a = step * (k % kSide - reach), b = step * (k / kSide - reach);
            double u = std::floor(u0 + map[0][0] * a + map[0][1] * b);
            double v = std::floor(v0 + map[1][0] * a + map[1][1] * b);
            if (!(u >= 0.0 && v >= 0.0 && u < level.width && v < level.height)) return false;
            value[static_cast<size_t>(k)] =
                level.grey[static_cast<size_t>(v) * static_cast<size_t>(level.width) + static_cast<size_t>(u)];
            sum += value[static_cast<size_t>(k)];
        }
        for (float &one : value) one -= sum / kCount, square += one * one;
        texture = std::sqrt(square / kCount);
        for (float &one : value) one = square > 0.0f ? one / std::sqrt(square) : 0.0f;
        return true;
    }

    double correlation(const Block &other) const {
        float sum = 0.0f;
        for (size_t k = 0; k < value.size(); k++) sum += value[k] * other.value[k];
        return sum;
    }
};

constexpr double kUpright[2][2] = {{1.0, 0.0}, {0.0, 1.0}};

// A block of the first image, and where the project expects it in the second.
struct Place {
    double x, y;
    size_t cell;
    std::array<Block<4>, 2> block;  // of each level
};

struct Matcher {
    const lensprof_camera &first, &second;
    const GreyLevels &first_grey, &second_grey;
    std::vector<Place> places;

    void find_places();
    bool cut(size_t level, const Sight &at, double du, double dv, Block<4> &out) const;
    std::vector<std::optional<double>> correlations(size_t level, const Rotation &rotation) const;
    void common_shift(double shift[2]) const;
    bool refine(size_t level, const double *shift, Rotation &rotation) const;
    double median_shift(const Rotation &rotation) const;
};

// The block with most texture of every cell of the first image, where the second sees it too.
void Matcher::find_places() {
    for (int row = 0; row < kRows; row++)
        for (int column = 0; column < kColumns; column++) {
            Place p{};
            p.x = (column + 0.5) / kColumns * first.width - 0.5, p.y = (row + 0.5) / kRows * first.height - 0.5;
            p.cell = static_cast<size_t>(row / kCell * (kColumns / kCell) + column / kCell);
            Sight at;
            bool good = sight(first, second, {}, 1.0, p.x, p.y, at);
            for (size_t n = 0; n < 2 && good; n++)
                good = p.block[n].cut(first_grey.level[n], p.x, p.y, first_grey.level[n].pixel, kUpright);
            if (good && p.block[0].texture > kTexture) places.push_back(p);
        }
    std::stable_sort(places.begin(), places.end(),
                     [](const Place &a, const Place &b) { return a.block[0].texture > b.block[0].texture; });
    std::array<bool, (kColumns / kCell) * (kRows / kCell)> taken{};
    auto is_taken = [&](const Place &p) { return std::exchange(taken[p.cell], true); };
    places.erase(std::remove_if(places.begin(), places.end(), is_taken), places.end());
}

// The second image's block, (du, dv) level pixels beside where it is expected.
bool Matcher::cut(size_t n, const Sight &at, double du, double dv, Block<4> &out) const {
    const auto &level = second_grey.level[n];
    return out.cut(level, at.x + du * level.pixel, at.y + dv * level.pixel, first_grey.level[n].pixel, at.map);
}

std::vector<std::optional<double>> Matcher::correlations(size_t n, const Rotation &rotation) const {
    std::vector<std::optional<double>> result;
    Block<4> other;
    Sight at;
    for (const Place &p : places) {
        bool seen = sight(first, second, rotation, 1.0, p.x, p.y, at) && cut(n, at, 0.0, 0.0, other);
        result.push_back(seen ? std::optional(p.block[n].correlation(other)) : std::nullopt);
    }
    return result;
}

// The shift, in coarse pixels of the second image, under which all blocks together match best.
void Matcher::common_shift(double shift[2]) const {
    constexpr int size = kFarthest + 1;  // every second pixel
    std::array<double, size * size> sum{};
    std::array<size_t, size * size> count{};
    auto offset = [](int k) { return 2 * k - kFarthest; };
    Block<4> other;
    Sight at;
    for (const Place &p : places) {
        if (!sight(first, second, {}, 1.0, p.x, p.y, at)) continue;
        for (int k = 0; k < size * size; k++)
            if (cut(0, at, offset(k % size), offset(k / size), other)) {
                sum[static_cast<size_t>(k)] += p.block[0].correlation(other);
                count[static_cast<size_t>(k)]++;
            }
    }
    double best = 0.0;
    shift[0] = shift[1] = 0.0;
    for (int k = 0; k < size * size; k++) {
        auto n = static_cast<size_t>(k);
        double mean = count[n] >= std::max(kFewest, places.size() / 4) ? sum[n] / static_cast<double>(count[n]) : 0.0;
        if (mean > best) best = mean, shift[0] = offset(k % size), shift[1] = offset(k / size);
    }
}

// Looks for every block about where it is expected, and fits the rotation to where they are: least squares, with less
// trust in blocks that are far from the others. `shift`: expected beside the rotation, level pixels.
bool Matcher::refine(size_t n, const double *shift, Rotation &rotation) const {
    struct Match {
        Eigen::Matrix<double, 2, 3> by_rotation;
        Eigen::Vector2d off;  // px of the full frame
        double quality;
    };
    const double pixel = second_grey.level[n].pixel;
    std::vector<Match> matches;
    Block<4> other;
    for (const Place &p : places) {
        Sight at, moved;
        if (!sight(first, second, rotation, 1.0, p.x, p.y, at)) continue;
        Match m{};
        for (int dv = -kSearch; dv <= kSearch; dv++)
            for (int du = -kSearch; du <= kSearch; du++)
                if (cut(n, at, shift[0] + du, shift[1] + dv, other) && p.block[n].correlation(other) > m.quality) {
                    m.quality = p.block[n].correlation(other);
                    m.off = {(shift[0] + du) * pixel, (shift[1] + dv) * pixel};
                }
        bool good = m.quality > kMatch;
        for (int d = 0; d < 3 && good; d++) {
            Rotation turned = rotation;
            turned[static_cast<size_t>(d)] += kDerivativeStep;
            good = sight(first, second, turned, 1.0, p.x, p.y, moved);
            m.by_rotation.col(d) << (moved.x - at.x) / kDerivativeStep, (moved.y - at.y) / kDerivativeStep;
        }
        if (good) matches.push_back(m);
    }
    if (matches.size() < kFewest) return false;
    Eigen::Vector3d change = Eigen::Vector3d::Zero();
    for (int round = 0; round < 8; round++) {
        Eigen::Matrix3d normal = Eigen::Matrix3d::Identity() * std::pow(pixel / kTrust, 2);
        Eigen::Vector3d right = Eigen::Vector3d::Zero();
        for (const Match &m : matches) {
            double away = (m.off - m.by_rotation * change).norm() / (round ? pixel : 4.0 * pixel);
            double weight = m.quality / (1.0 + away * away);
            normal += weight * m.by_rotation.transpose() * m.by_rotation;
            right += weight * m.by_rotation.transpose() * m.off;
        }
        change = normal.ldlt().solve(right);
    }
    for (int d = 0; d < 3; d++) rotation[static_cast<size_t>(d)] += change[d];
    return change.allFinite();
}

double Matcher::median_shift(const Rotation &rotation) const {
    std::vector<double> shifts;
    for (const Place &p : places) {
        Sight from, to;
        if (sight(first, second, {}, 1.0, p.x, p.y, from) && sight(first, second, rotation, 1.0, p.x, p.y, to))
            shifts.push_back(std::hypot(to.x - from.x, to.y - from.y));
    }
    if (shifts.empty()) return 0.0;
    auto middle = shifts.begin() + static_cast<ptrdiff_t>(shifts.size() / 2);
    std::nth_element(shifts.begin(), middle, shifts.end());
    return *middle;
}

double mean_of(const std::vector<std::optional<double>> &correlations, size_t &count) {
    double sum = 0.0;
    count = 0;
    for (const auto &one : correlations)
        if (one) sum += *one, count++;
    return count ? sum / static_cast<double>(count) : 0.0;
}

// Whether most blocks match better under the rotation than by the project: what moved prefers it, too, but not the
// scene about it.
bool most_prefer(const std::vector<std::optional<double>> &rotated, const std::vector<std::optional<double>> &project) {
    size_t better = 0, worse = 0;
    for (size_t p = 0; p < rotated.size(); p++) {
        double gain = rotated[p].value_or(0.0) - project[p].value_or(0.0);
        better += gain > kPreferred, worse += gain < -kPreferred;
    }
    return better > 2 * worse;
}

// Of every four pixels the mean of the middle two: one that is wrong does not count.
GreyLevels::Level halved(const GreyLevels::Level &from) {
    GreyLevels::Level to;
    to.width = from.width / 2, to.height = from.height / 2, to.pixel = 2.0 * from.pixel;
    to.grey.resize(static_cast<size_t>(to.width) * static_cast<size_t>(to.height));
    for (int v = 0; v < to.height; v++) {
        const float *above = from.grey.data() + static_cast<ptrdiff_t>(2 * v) * from.width, *below = above + from.width;
        float *out = to.grey.data() + static_cast<ptrdiff_t>(v) * to.width;
        for (int u = 0; u < to.width; u++, above += 2, below += 2) {
            float low = std::min(std::min(above[0], above[1]), std::min(below[0], below[1]));
            float high = std::max(std::max(above[0], above[1]), std::max(below[0], below[1]));
            out[u] = 0.5f * (above[0] + above[1] + below[0] + below[1] - low - high);
        }
    }
    return to;
}

}  // namespace

bool place_of(const lensprof_camera &first, const lensprof_camera &second, const Rotation &rotation, double sign,
              double x, double y, double xy[2]) {
    double direction[2];
    if (!lensprof_camera_unproject(&first, x, y, direction)) return false;
    rotate(rotation, sign, direction);
    return lensprof_camera_project(&second, direction[0], direction[1], xy);
}

void unit_vector(const double direction[2], double v[3]) {
    v[0] = std::cos(direction[1]) * std::sin(direction[0]);
    v[1] = std::sin(direction[1]);
    v[2] = std::cos(direction[1]) * std::cos(direction[0]);
}

void direction_of_vector(const double v[3], double direction[2]) {
    direction[0] = std::atan2(v[0], v[2]);
    direction[1] = std::asin(std::clamp(v[1], -1.0, 1.0));
}

void rotate(const Rotation &rotation, double sign, double direction[2]) {
    if (rotation[0] == 0.0 && rotation[1] == 0.0 && rotation[2] == 0.0) return;
    Eigen::Vector3d v, axis(rotation.data());
    unit_vector(direction, v.data());
    v = Eigen::AngleAxisd(sign * axis.norm(), axis.normalized()) * v;
    direction_of_vector(v.data(), direction);
}

bool sight(const lensprof_camera &first, const lensprof_camera &second, const Rotation &rotation, double sign, double x,
           double y, Sight &out) {
    double xy[2], beside[2];
    constexpr double step = 2.0;  // px
    if (!place_of(first, second, rotation, sign, x, y, xy)) return false;
    for (int d = 0; d < 2; d++) {
        double inwards = (d == 0 ? x < 0.5 * first.width : y < 0.5 * first.height) ? step : -step;
        double to_x = x + (d == 0 ? inwards : 0.0), to_y = y + (d == 1 ? inwards : 0.0);
        if (!place_of(first, second, rotation, sign, to_x, to_y, beside)) return false;
        for (int e = 0; e < 2; e++) out.map[e][d] = (beside[e] - xy[e]) / inwards;
    }
    out.x = xy[0], out.y = xy[1];
    return true;
}

GreyLevels::GreyLevels(const View &view) {
    const auto &picture = view.image().view;
    Level full;
    full.width = static_cast<int>(picture.width), full.height = static_cast<int>(picture.height);
    full.pixel = view.image().reduction;
    full.grey.resize(static_cast<size_t>(full.width) * static_cast<size_t>(full.height));
    for (int v = 0; v < full.height; v++)
        view.grey_row(v, full.grey.data() + static_cast<size_t>(v) * static_cast<size_t>(full.width));
    level[1] = halved(full);
    level[0] = halved(level[1]);
}

std::optional<double> likeness(const GreyLevels &first, double x, double y, const GreyLevels &second,
                               const Sight &sight) {
    Block<3> a, b;
    const double pixel = first.level[0].pixel;
    if (!a.cut(first.level[0], x, y, pixel, kUpright) || !b.cut(second.level[0], sight.x, sight.y, pixel, sight.map)
        || std::max(a.texture, b.texture) < kTexture)
        return std::nullopt;
    return a.correlation(b);
}

Rotation registration(const lensprof_camera &first, const GreyLevels &first_grey, const lensprof_camera &second,
                      const GreyLevels &second_grey) {
    constexpr double none[2] = {0.0, 0.0};
    Matcher matcher{first, second, first_grey, second_grey, {}};
    matcher.find_places();
    if (matcher.places.size() < kFewest) return {};
    size_t compared, found_in;
    const auto by_project = matcher.correlations(1, {});
    double project = mean_of(by_project, compared), shift[2];
    if (compared < kFewest || project > kRight) return {};
    matcher.common_shift(shift);
    Rotation rotation{};
    if (!matcher.refine(0, shift, rotation) || !matcher.refine(0, none, rotation)) return {};
    for (int round = 0; round < 2; round++)
        if (!matcher.refine(1, none, rotation)) return {};
    const auto by_rotation = matcher.correlations(1, rotation);
    double found = mean_of(by_rotation, found_in);
    double view_pixel = 0.5 * second_grey.level[1].pixel;
    bool is_better = 2 * found_in > compared && found > kMatch && found > project + kBetter
                     && most_prefer(by_rotation, by_project) && matcher.median_shift(rotation) > view_pixel;
    return is_better ? rotation : Rotation{};
}

}  // namespace lensprof
