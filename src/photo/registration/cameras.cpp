#include "photo/registration/cameras.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <tuple>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <Eigen/SparseCholesky>

#include "fit/base/quantile.hpp"
#include "photo/base/events.hpp"
#include "photo/registration/camera_rotation.hpp"
#include "photo/registration/pinhole.hpp"
#include "threads/item_loop.hpp"

namespace lensprof {
namespace {

constexpr size_t max_link_matches = 40;      // matches used per link, spread over its overlap,
constexpr size_t coarse_link_matches = 10;   // and until the scale of the loss is its last
constexpr double widest_deg = 140.0;         // maximum angle of view of a rectilinear lens
constexpr double last_scale = 0.001;         // of the loss, as a share of the longer side
constexpr double lost_residual = 0.005;      // of the same: half of the links are not explained, fine steps are in vain
constexpr double fitting_residual = 0.0012;  // of the same: a panorama with larger residuals may be a plane

// An even selection of about `count`.
Matches evenly(const Matches &matches, size_t count) {
    Matches chosen;
    const size_t step = std::max<size_t>(1, matches.size() / count);
    for (size_t m = 0; m < matches.size(); m += step) chosen.push_back(matches[m]);
    return chosen;
}

// Every cell of a grid over the first frame contributes its first match, until there are enough.
Matches spread(const Matches &matches, const PictureOptics &first) {
    constexpr int cells = 8;
    Matches left = matches, chosen;
    while (chosen.size() < max_link_matches && !left.empty()) {
        bool taken[cells * cells] = {};
        Matches rest;
        for (const auto &m : left) {
            const int across = std::clamp(int(m.first.x / first.width * cells), 0, cells - 1);
            const int down = std::clamp(int(m.first.y / first.height * cells), 0, cells - 1);
            bool &is_taken = taken[down * cells + across];
            (is_taken || chosen.size() == max_link_matches ? rest : chosen).push_back(m);
            is_taken = true;
        }
        left = std::move(rest);
    }
    return chosen;
}

// The unknowns: angle of view and a, b, c per lens, angles and position per picture.
constexpr Eigen::Index lens_unknowns = 4, picture_unknowns = 6, camera_unknowns = lens_unknowns + picture_unknowns;

double &value(lensprof_camera &c, Eigen::Index k) {
    double *const all[camera_unknowns] = {&c.hfov_deg,       &c.radial[0],     &c.radial[1], &c.radial[2],
                                          &c.yaw_deg,        &c.pitch_deg,     &c.roll_deg,  &c.translation[0],
                                          &c.translation[1], &c.translation[2]};
    return *all[k];
}

constexpr double difference_steps[camera_unknowns] = {1e-4, 1e-5, 1e-5, 1e-5, 1e-4, 1e-4, 1e-4, 1e-5, 1e-5, 1e-5};
// Prior standard deviations from the first guess, degrees and shares; angles are free.
constexpr double known_hfov = 0.05, unknown_hfov = 0.6, usual_hfov_deg = 45.0;  // of the logarithm of the angle
constexpr double expected_sigmas[camera_unknowns] = {0.0, 0.02, 0.05, 0.02, 1e4, 1e4, 1e4, 1.0, 1.0, 1.0};

// Distance of a point in this direction from its position in the second picture, px.
bool residual(const Pinhole &second, const Eigen::Vector3d &direction, const Match &match, Eigen::Vector2d &r) {
    if (!second.project(direction, r)) return false;
    r -= Eigen::Vector2d(match.second.x, match.second.y);
    return true;
}

// The same of a point seen by the first camera.
bool residual(const Pinhole &first, const Pinhole &second, const Match &match, Eigen::Vector2d &r) {
    Eigen::Vector3d ray, direction;
    return first.ray(match.first.x, match.first.y, ray) && first.seen(ray, direction)
           && residual(second, direction, match, r);
}

// A camera, and with each of its unknowns moved by its difference step.
struct Nearby {
    Pinhole at, moved[camera_unknowns];

    explicit Nearby(const lensprof_camera &camera) : at(camera) {
        for (Eigen::Index k = 0; k < camera_unknowns; k++) {
            lensprof_camera other = camera;
            value(other, k) += difference_steps[k];
            moved[k] = Pinhole(other);
        }
    }
};

class CameraFit {
public:
    CameraFit(const std::vector<PictureOptics> &pictures, const std::vector<PictureLink> &links)
        : pictures_(pictures), links_(links) {
        for (const PictureLink &link : links) {
            matches_.push_back(spread(link.matches, pictures[link.picture[0]]));
            coarse_matches_.push_back(evenly(matches_.back(), coarse_link_matches));
        }
        for (const PictureOptics &p : pictures) lenses_ = std::max(lenses_, p.lens + 1);
        find_order();
    }

    FoundCameras run();

private:
    // A link's part of the normal equations, over its unknowns.
    struct Part {
        Eigen::Index count = 0, column[2 * camera_unknowns] = {}, unknown[2 * camera_unknowns] = {};
        int end[2 * camera_unknowns] = {};  // the picture of the unknown, 0 or 1
        Eigen::Matrix<double, 2 * camera_unknowns, 2 *camera_unknowns> normal =
            Eigen::Matrix<double, 2 * camera_unknowns, 2 * camera_unknowns>::Zero();
        Eigen::Matrix<double, 2 * camera_unknowns, 1> right = Eigen::Matrix<double, 2 * camera_unknowns, 1>::Zero();
    };

    void find_order();
    void find_angles_of_view();
    void start(const std::vector<double> &hfov);
    void start_before_plane();
    void choose_unknowns(bool is_distorted, bool is_plane);
    Eigen::Index column(size_t picture, Eigen::Index k) const;
    double px(size_t link, double share) const;
    double expectation(std::vector<Eigen::Triplet<double>> *normal, Eigen::VectorXd *right) const;
    double cost(double scale, size_t link_step = 1) const;
    Part part_of(size_t link) const;
    std::vector<Pinhole> pinholes() const { return {cameras_.begin(), cameras_.end()}; }
    void add_match(size_t link, const Match &match, double scale, const Nearby &first, const Nearby &second,
                   Part &part) const;
    void add_matches(double scale, std::vector<Eigen::Triplet<double>> &normal, Eigen::VectorXd &right) const;
    void move(const Eigen::VectorXd &step);
    bool step(double scale, double &damping);
    void descend(double first_scale);
    const std::vector<Matches> &used_matches() const { return is_coarse_ ? coarse_matches_ : matches_; }
    double fit_undistorted(bool is_plane);
    double fit_distorted(bool is_plane);
    void fit_before_plane();
    std::vector<double> residuals() const;
    void level();

    const std::vector<PictureOptics> &pictures_;
    const std::vector<PictureLink> &links_;
    std::vector<Matches> matches_, coarse_matches_;  // per link
    bool is_coarse_ = false;                         // which of them a step uses
    uint32_t lenses_ = 1;
    std::vector<double> first_hfov_, hfov_, hfov_sigma_;  // per lens: the first guess, and the expectation
    size_t root_ = 0;                                     // the fixed picture
    std::vector<std::pair<size_t, bool>> tree_;           // links in the order in which pictures are added; true:
                                                          // backwards
    std::vector<lensprof_camera> cameras_;
    std::vector<Eigen::Index> column_;  // per unknown of the lenses, then of the pictures; -1: fixed
    Eigen::Index columns_ = 0;
};

// The tree of the strongest links, starting at the picture with most matches (Prim 1957); of equal ones the first.
void CameraFit::find_order() {
    std::vector<size_t> strength(pictures_.size());
    std::vector<std::vector<size_t>> of_picture(pictures_.size());
    for (size_t n = 0; n < links_.size(); n++)
        for (uint32_t p : links_[n].picture) strength[p] += links_[n].matches.size(), of_picture[p].push_back(n);
    root_ = static_cast<size_t>(std::max_element(strength.begin(), strength.end()) - strength.begin());
    std::vector<bool> joined(pictures_.size());
    const auto is_weaker = [&](size_t a, size_t b) {
        return std::tuple(links_[a].matches.size(), b) < std::tuple(links_[b].matches.size(), a);
    };
    std::priority_queue<size_t, std::vector<size_t>, decltype(is_weaker)> open(is_weaker);  // links of joined pictures
    const auto join = [&](size_t picture) {
        joined[picture] = true;
        for (const size_t n : of_picture[picture]) open.push(n);
    };
    for (join(root_); !open.empty();) {
        const size_t best = open.top();
        open.pop();
        const auto &p = links_[best].picture;
        if (joined[p[0]] && joined[p[1]]) continue;
        tree_.emplace_back(best, joined[p[1]]);
        join(joined[p[1]] ? p[0] : p[1]);
    }
}

// The expectation is the angle of the metadata, or a usual one. The first guess is near it or, without metadata, the
// angle with which the links fit best when the pictures are added one after another. Links that close a loop are most
// informative, but only with fine steps.
void CameraFit::find_angles_of_view() {
    std::vector<std::vector<double>> known(lenses_);
    for (const PictureOptics &p : pictures_)
        if (p.hfov_deg) known[p.lens].push_back(*p.hfov_deg);
    hfov_.assign(lenses_, usual_hfov_deg), hfov_sigma_.assign(lenses_, unknown_hfov);
    for (uint32_t lens = 0; lens < lenses_; lens++)
        if (!known[lens].empty())
            hfov_[lens] = std::min(upper_median(known[lens]), widest_deg), hfov_sigma_[lens] = known_hfov;
    const bool all_known = std::none_of(known.begin(), known.end(), [](const auto &k) { return k.empty(); });
    constexpr double guess_scale = 0.01;
    constexpr size_t max_links = 300;  // an even selection suffices
    choose_unknowns(false, false);
    is_coarse_ = true;
    double least = 1e300;
    for (double factor = all_known ? 0.9 : 0.07; factor < (all_known ? 1.1 : 3.0); factor *= 1.01) {
        std::vector<double> guess = hfov_;
        for (uint32_t lens = 0; lens < lenses_; lens++)
            if (known[lens].empty() || all_known) guess[lens] = std::min(guess[lens] * factor, widest_deg);
        start(guess);
        const double misfit = cost(guess_scale, 1 + links_.size() / max_links);
        if (misfit < least) least = misfit, first_hfov_ = guess;
    }
}

void CameraFit::start(const std::vector<double> &hfov) {
    cameras_.assign(pictures_.size(), {});
    std::vector<Eigen::Matrix3d> turn(pictures_.size(), Eigen::Matrix3d::Identity());
    for (size_t i = 0; i < pictures_.size(); i++) {
        cameras_[i].projection = LENSPROF_PROJECTION_RECTILINEAR;
        cameras_[i].width = pictures_[i].width, cameras_[i].height = pictures_[i].height;
        cameras_[i].hfov_deg = hfov[pictures_[i].lens];
    }
    for (const auto &[n, is_backwards] : tree_) {
        const uint32_t a = links_[n].picture[0], b = links_[n].picture[1];
        const Eigen::Matrix3d between =
            rotation_between(pictures_[a], cameras_[a].hfov_deg, pictures_[b], cameras_[b].hfov_deg, matches_[n]);
        if (is_backwards)
            turn[a] = between.transpose() * turn[b];
        else
            turn[b] = between * turn[a];
    }
    for (size_t i = 0; i < pictures_.size(); i++) set_angles(cameras_[i], turn[i]);
}

// Assumes that the fixed picture looks straight at the plane. With X = (x, y, 1) a point of the plane and K the camera
// matrix, a picture at T sees it at K R (X - T), so its homography H from the fixed one satisfies K^-1 H K0 ~ R [e1 e2
// (-Tx, -Ty, 1 - Tz)].
void CameraFit::start_before_plane() {
    const auto lens = [&](size_t i) {
        const PictureOptics &p = pictures_[i];
        const double focal = focal_px(p, cameras_[i].hfov_deg);
        Eigen::Matrix3d k;
        k << focal, 0.0, 0.5 * (p.width - 1.0), 0.0, focal, 0.5 * (p.height - 1.0), 0.0, 0.0, 1.0;
        return k;
    };
    std::vector<Eigen::Matrix3d> from_root(pictures_.size(), Eigen::Matrix3d::Identity());
    for (const auto &[n, is_backwards] : tree_) {
        const auto *p = links_[n].picture;
        const Eigen::Matrix3d between =
            Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(links_[n].homography.val);
        if (is_backwards)
            from_root[p[0]] = between.inverse() * from_root[p[1]];
        else
            from_root[p[1]] = between * from_root[p[0]];
    }
    for (size_t i = 0; i < pictures_.size(); i++) {
        Eigen::Matrix3d seen = lens(i).inverse() * from_root[i] * lens(root_);
        seen /= std::copysign(0.5 * (seen.col(0).norm() + seen.col(1).norm()), seen(2, 2));
        Eigen::Matrix3d turn;
        turn << seen.col(0), seen.col(1), seen.col(0).cross(seen.col(1));
        const Eigen::JacobiSVD<Eigen::Matrix3d> svd(turn, Eigen::ComputeFullU | Eigen::ComputeFullV);
        turn = svd.matrixU() * svd.matrixV().transpose();
        const Eigen::Vector3d place = Eigen::Vector3d::UnitZ() - turn.transpose() * seen.col(2);
        if (!turn.allFinite() || !place.allFinite() || i == root_) continue;
        set_angles(cameras_[i], turn);
        Eigen::Map<Eigen::Vector3d>(cameras_[i].translation) = place;
    }
    set_angles(cameras_[root_], Eigen::Matrix3d::Identity());
}

void CameraFit::choose_unknowns(bool is_distorted, bool is_plane) {
    const auto pictures = static_cast<Eigen::Index>(pictures_.size());
    column_.assign(static_cast<size_t>(lenses_ * lens_unknowns + pictures * picture_unknowns), -1);
    columns_ = 0;
    for (Eigen::Index u = 0; u < static_cast<Eigen::Index>(column_.size()); u++) {
        const Eigen::Index of_pictures = u - lenses_ * lens_unknowns;
        bool is_free;
        if (of_pictures < 0) {
            is_free = u % lens_unknowns == 0 || is_distorted;
        } else {
            const bool is_root = static_cast<size_t>(of_pictures / picture_unknowns) == root_;
            const Eigen::Index k = of_pictures % picture_unknowns;
            // The plane is in front of the panorama's centre, so the fixed picture may look at it obliquely.
            is_free = k < 3 ? !is_root || (is_plane && k < 2) : is_plane && !is_root;
        }
        if (is_free) column_[static_cast<size_t>(u)] = columns_++;
    }
}

Eigen::Index CameraFit::column(size_t picture, Eigen::Index k) const {
    const Eigen::Index lens = pictures_[picture].lens;
    const Eigen::Index u = k < lens_unknowns ? lens * lens_unknowns + k
                                             : Eigen::Index(lenses_) * lens_unknowns
                                                   + Eigen::Index(picture) * picture_unknowns + k - lens_unknowns;
    return column_[static_cast<size_t>(u)];
}

double CameraFit::px(size_t link, double share) const {
    const PictureOptics &second = pictures_[links_[link].picture[1]];
    return share * std::max(second.width, second.height);
}

// The cost of deviations from the expectations; adds its part of the normal equations if requested.
double CameraFit::expectation(std::vector<Eigen::Triplet<double>> *normal, Eigen::VectorXd *right) const {
    double sum = 0.0;
    std::vector<bool> done(static_cast<size_t>(columns_));
    for (size_t i = 0; i < cameras_.size(); i++)
        for (Eigen::Index k = 0; k < camera_unknowns; k++) {
            const Eigen::Index c = column(i, k);
            if (c < 0 || done[static_cast<size_t>(c)]) continue;
            done[static_cast<size_t>(c)] = true;
            lensprof_camera camera = cameras_[i];
            const uint32_t lens = pictures_[i].lens;
            const double expected = k >= 4 && k < 7 ? value(camera, k) : 0.0;
            const double sigma = k == 0 ? hfov_sigma_[lens] * value(camera, k) : expected_sigmas[k];
            const double off = k == 0 ? std::log(value(camera, k) / hfov_[lens]) / hfov_sigma_[lens]
                                      : (value(camera, k) - expected) / sigma;
            sum += off * off;
            if (!normal) continue;
            normal->emplace_back(c, c, 1.0 / (sigma * sigma));
            (*right)[c] -= off / sigma;
        }
    return sum;
}

// Uses every link_step-th link. Adds in the order of the links, so that the number of threads does not matter.
double CameraFit::cost(double scale, size_t link_step) const {
    const std::vector<Pinhole> cameras = pinholes();
    std::vector<double> sums((links_.size() + link_step - 1) / link_step);
    for_each_item(static_cast<uint32_t>(sums.size()), thread_count(0), [&](uint32_t item, uint32_t) {
        const size_t n = item * link_step;
        const auto &p = links_[n].picture;
        Eigen::Vector2d r;
        for (const Match &m : used_matches()[n]) {
            const bool seen = residual(cameras[p[0]], cameras[p[1]], m, r);
            sums[item] += std::log1p(seen ? r.squaredNorm() / std::pow(px(n, scale), 2) : 1.0 / (scale * scale));
        }
        return true;
    });
    return std::accumulate(sums.begin(), sums.end(), expectation(nullptr, nullptr));
}

// The unknowns of a link.
CameraFit::Part CameraFit::part_of(size_t link) const {
    const uint32_t *p = links_[link].picture;
    Part part;
    for (int end = 0; end < 2; end++)
        for (Eigen::Index k = 0; k < camera_unknowns; k++) {
            const Eigen::Index c = column(p[end], k);
            if (c < 0 || std::find(part.column, part.column + part.count, c) != part.column + part.count) continue;
            part.end[part.count] = end, part.unknown[part.count] = k, part.column[part.count++] = c;
        }
    return part;
}

// Forward differences. Only the lens of the first camera changes the ray of a match in its frame.
void CameraFit::add_match(size_t link, const Match &match, double scale, const Nearby &first, const Nearby &second,
                          Part &part) const {
    const uint32_t *p = links_[link].picture;
    Eigen::Vector3d ray, direction, moved_ray, moved_direction;
    Eigen::Vector2d r, moved;
    if (!first.at.ray(match.first.x, match.first.y, ray) || !first.at.seen(ray, direction)
        || !residual(second.at, direction, match, r))
        return;
    const double s = px(link, scale), weight = 1.0 / (s * s + r.squaredNorm());  // rho'(e) / s^2
    Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, 2 * camera_unknowns> rows(2, part.count);
    for (Eigen::Index n = 0; n < part.count; n++) {
        const Eigen::Index k = part.unknown[n];
        const int end = part.end[n];
        const bool is_of_lens = k < lens_unknowns, is_shared = is_of_lens && part.column[n] == column(p[1 - end], k);
        const Pinhole &from = end == 0 || is_shared ? first.moved[k] : first.at,
                      &to = end == 1 || is_shared ? second.moved[k] : second.at;
        bool is_seen = true;
        if (end == 1 && !is_shared)
            moved_direction = direction;
        else if (is_of_lens)
            is_seen = from.ray(match.first.x, match.first.y, moved_ray) && from.seen(moved_ray, moved_direction);
        else
            is_seen = from.seen(ray, moved_direction);
        if (!is_seen || !residual(to, moved_direction, match, moved)) return;
        rows.col(n) = (moved - r) / difference_steps[k];
    }
    part.normal.topLeftCorner(part.count, part.count) += weight * rows.transpose().lazyProduct(rows);
    part.right.head(part.count) -= weight * rows.transpose().lazyProduct(r);
}

void CameraFit::move(const Eigen::VectorXd &step) {
    for (size_t i = 0; i < cameras_.size(); i++)
        for (Eigen::Index k = 0; k < camera_unknowns; k++)
            if (const Eigen::Index c = column(i, k); c >= 0) value(cameras_[i], k) += step[c];
}

// Sums over all links on all cores, in their order, so that the number of threads does not matter. The parts of a
// thousand links are kept at a time: of all links of thousands of frames they would take 100 MB.
void CameraFit::add_matches(double scale, std::vector<Eigen::Triplet<double>> &normal, Eigen::VectorXd &right) const {
    constexpr size_t links_at_once = 1000;
    const std::vector<Nearby> cameras(cameras_.begin(), cameras_.end());
    for (size_t begin = 0; begin < links_.size(); begin += links_at_once) {
        std::vector<Part> parts(std::min(links_at_once, links_.size() - begin));
        for_each_item(static_cast<uint32_t>(parts.size()), thread_count(0), [&](uint32_t item, uint32_t) {
            const size_t n = begin + item;
            const uint32_t *p = links_[n].picture;
            parts[item] = part_of(n);
            for (const Match &m : used_matches()[n]) add_match(n, m, scale, cameras[p[0]], cameras[p[1]], parts[item]);
            return true;
        });
        for (const Part &part : parts)
            for (Eigen::Index a = 0; a < part.count; a++) {
                right[part.column[a]] += part.right[a];
                for (Eigen::Index b = 0; b < part.count; b++)
                    if (part.column[b] <= part.column[a])
                        normal.emplace_back(part.column[a], part.column[b], part.normal(a, b));
            }
    }
}

// False if no step reduces the cost clearly.
bool CameraFit::step(double scale, double &damping) {
    std::vector<Eigen::Triplet<double>> normal;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(columns_);
    stop_if_cancelled();
    const double before = cost(scale);
    add_matches(scale, normal, right);
    expectation(&normal, &right);
    Eigen::SparseMatrix<double> matrix(columns_, columns_);
    matrix.setFromTriplets(normal.begin(), normal.end());
    const Eigen::VectorXd diagonal = matrix.diagonal();
    const std::vector<lensprof_camera> old = cameras_;
    for (; damping < 1e8; damping *= 10.0) {
        Eigen::SparseMatrix<double> damped = matrix;
        damped.diagonal() = diagonal * (1.0 + damping) + Eigen::VectorXd::Constant(columns_, 1e-9);
        Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(damped);
        const Eigen::VectorXd step = solver.solve(right);
        if (solver.info() == Eigen::Success && step.allFinite()) {
            move(step);
            const bool is_valid = std::all_of(cameras_.begin(), cameras_.end(), [](const lensprof_camera &c) {
                return lensprof_camera_validate(&c) == LENSPROF_OK && c.hfov_deg > 1e-3;
            });
            const double after = is_valid ? cost(scale) : before;
            if (after < before) {
                damping = std::max(damping * 0.1, 1e-9);
                return after < before * (1.0 - 1e-6);
            }
            cameras_ = old;
        }
    }
    return false;
}

// Gives up before the last scale if the coarse steps have shown that no such cameras took the pictures.
void CameraFit::descend(double first_scale) {
    for (double scale = first_scale;; scale = std::max(last_scale, scale * 0.5)) {
        double damping = 1e-3;
        is_coarse_ = scale > last_scale;
        if (!is_coarse_ && upper_median(residuals()) > lost_residual) return;
        const int steps = scale > last_scale ? 5 : 40;
        for (int n = 0; n < steps && step(scale, damping);) n++;
        if (scale <= last_scale) return;
    }
}

std::vector<double> CameraFit::residuals() const {
    const std::vector<Pinhole> cameras = pinholes();
    std::vector<double> result;
    for (size_t n = 0; n < links_.size(); n++) {
        const auto &p = links_[n].picture;
        std::vector<double> off;
        Eigen::Vector2d r;
        for (const Match &m : matches_[n])
            off.push_back(residual(cameras[p[0]], cameras[p[1]], m, r) ? r.norm() / px(n, 1.0) : 1.0);
        result.push_back(upper_median(off));
    }
    return result;
}

// Rotates all cameras so that their horizontal axes are level and their view is in front. A picture of the scene upside
// down stays so.
void CameraFit::level() {
    Eigen::Matrix3d across = Eigen::Matrix3d::Zero();
    Eigen::Vector3d down = Eigen::Vector3d::Zero(), ahead = Eigen::Vector3d::Zero();
    for (size_t i = 0; i < cameras_.size(); i++) {
        const Eigen::Matrix3d turn = upright(pictures_[i].orientation) * turn_of(cameras_[i]);
        across += turn.row(0).transpose() * turn.row(0);
        down += turn.row(1).transpose();
        ahead += turn.row(2).transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(across);
    // If all look the same way, their axes do not determine which way is up.
    Eigen::Vector3d axis = axes.eigenvalues()[1] > 0.02 * axes.eigenvalues()[2]
                               ? Eigen::Vector3d(axes.eigenvectors().col(0))
                               : Eigen::Vector3d(down.normalized());
    if (axis.dot(down) < 0.0) axis = -axis;
    ahead -= axis * axis.dot(ahead);
    if (ahead.norm() < 1e-3) ahead = turn_of(cameras_[root_]).row(2).transpose(), ahead -= axis * axis.dot(ahead);
    ahead.normalize();
    Eigen::Matrix3d world;  // its rows are the new axes
    world << axis.cross(ahead).transpose(), axis.transpose(), ahead.transpose();
    if (!world.allFinite()) return;
    for (lensprof_camera &c : cameras_) set_angles(c, turn_of(c) * world.transpose());
}

// Starts from the current cameras. The distortion is added once all else is nearly right.
double CameraFit::fit_undistorted(bool is_plane) {
    choose_unknowns(false, is_plane);
    descend(0.1);
    return cost(last_scale);
}

double CameraFit::fit_distorted(bool is_plane) {
    choose_unknowns(true, is_plane);
    descend(0.004);
    return cost(last_scale);
}

// Starts from turned cameras, and from what the homographies show.
void CameraFit::fit_before_plane() {
    const double by_turns = fit_undistorted(true);
    const std::vector<lensprof_camera> moved = cameras_;
    start(hfov_);
    start_before_plane();
    if (by_turns < fit_undistorted(true)) cameras_ = moved;
    fit_distorted(true);
}

FoundCameras CameraFit::run() {
    find_angles_of_view();
    start(first_hfov_);
    fit_undistorted(false);
    fit_distorted(false);
    const std::vector<lensprof_camera> rotated = cameras_;
    const std::vector<double> off = residuals();
    if (upper_median(off) > fitting_residual) {
        fit_before_plane();
        const std::vector<double> current = residuals();
        if (upper_median(current) < 0.6 * upper_median(off)) return {SceneKind::plane, cameras_, current};
        cameras_ = rotated;
    }
    level();
    return {SceneKind::panorama, cameras_, off};
}

}  // namespace

FoundCameras find_cameras(const std::vector<PictureOptics> &pictures, const std::vector<PictureLink> &links) {
    return CameraFit(pictures, links).run();
}

}  // namespace lensprof
