// Pictures of `simulate --set moving` with the output that structure from motion would give for them: points computed
// from the scene itself.
#pragma once

#include <array>
#include <set>

#include "cli/simulate/moving.hpp"

#include "cli_runs.hpp"

namespace moving_scenes {

using namespace cli_runs;

struct Pose {
    double centre[3], rotation[3][3], focal, principal[2];
};

inline Pose pose_of(const Json &truth, size_t i) {
    Pose pose = {};
    const Json &own = truth["images"][i]["pose"];
    pose.focal = truth["camera"]["focal_px"].get<double>();
    for (size_t k = 0; k < 3; k++) {
        pose.centre[k] = own["centre_m"][k].get<double>();
        for (size_t row = 0; row < 3; row++) pose.rotation[row][k] = own["rotation"][row][k].get<double>();
    }
    for (size_t k = 0; k < 2; k++) pose.principal[k] = truth["camera"]["principal_px"][k].get<double>();
    return pose;
}

// Position of a point of the scene in a picture; false if its depth is not positive.
inline bool project(const Pose &pose, const Vector3 &point, double xy[2]) {
    const double way[3] = {point.x - pose.centre[0], point.y - pose.centre[1], point.z - pose.centre[2]};
    double seen[3] = {};
    for (int row = 0; row < 3; row++)
        for (int k = 0; k < 3; k++) seen[row] += pose.rotation[row][k] * way[k];
    for (int k = 0; k < 2; k++) xy[k] = pose.principal[k] + pose.focal * seen[k] / seen[2];
    return seen[2] > 0;
}

inline Line line_to(const Pose &pose, double x, double y) {
    const double seen[3] = {(x - pose.principal[0]) / pose.focal, (y - pose.principal[1]) / pose.focal, 1};
    double way[3] = {};
    for (int k = 0; k < 3; k++)
        for (int row = 0; row < 3; row++) way[k] += pose.rotation[row][k] * seen[row];
    return {{pose.centre[0], pose.centre[1], pose.centre[2]}, normalised({way[0], way[1], way[2]})};
}

struct Sight {
    size_t image;
    double xy[2];
};

struct Track {
    Vector3 point;
    std::vector<Sight> sights;
};

// A simulated sequence in work(name), and points on a grid in every picture with their positions in all pictures that
// see them.
class MovingScene {
public:
    MovingScene(const std::string &name, MovingKind kind, uint32_t images, const Words &more = {})
        : name_(name), width_(400), height_(300) {
        const std::string kind_name = kind == MovingKind::room ? "room" : "terrain";
        must_exit(done,
                  Words{"simulate", "-o", work(name), "--set", std::string("moving=") + kind_name, "--size", "400x300",
                        "--images", std::to_string(images), "--set", "gloss=0,noise=1", "--format", "png"}
                      + more);
        truth = parsed(text_of(work(name + "/truth.json")));
        const auto world = make_moving_world(kind, {1, images, width_, height_, 50, 1, 0});
        for (size_t i = 0; i < images; i++) poses_.push_back(pose_of(truth, i));
        for (size_t i = 0; i < images; i++)
            for (double y = 6 + double(i % 3); y < height_ - 6; y += 13)
                for (double x = 6 + double(i % 5); x < width_ - 6; x += 13) add_track(*world, i, x, y);
    }

    std::string file(size_t i) const { return truth["images"][i]["file"].get<std::string>(); }

    // COLMAP's text model in the folder work(name).
    void write_colmap(const std::string &name) const;
    // OpenSfM's tracks.csv, with the colours of the pictures.
    void write_opensfm(const std::string &path) const;

    Json truth;
    std::vector<Track> tracks;

private:
    void add_track(const MovingWorld &world, size_t first, double x, double y) {
        const Hit hit = world.trace(line_to(poses_[first], x, y));
        if (hit.surface == 0) return;
        Track track{hit.point, {}};
        for (size_t i = 0; i < poses_.size(); i++) {
            Sight sight{i, {}};
            if (!project(poses_[i], hit.point, sight.xy) || sight.xy[0] < 3 || sight.xy[1] < 3
                || sight.xy[0] > width_ - 4.0 || sight.xy[1] > height_ - 4.0)
                continue;
            const Hit again = world.trace(line_to(poses_[i], sight.xy[0], sight.xy[1]));
            const Vector3 apart = again.point - hit.point;
            if (again.surface == hit.surface && dot(apart, apart) < 1e-4) track.sights.push_back(sight);
        }
        if (track.sights.size() > 1) tracks.push_back(track);
    }

    std::string name_;
    uint32_t width_, height_;
    std::vector<Pose> poses_;
};

// A rotation as a quaternion (w, x, y, z); its angle is below 180 degrees if w is above 0.
inline std::array<double, 4> quaternion_of(const double r[3][3]) {
    std::array<double, 4> q = {1 + r[0][0] + r[1][1] + r[2][2], r[2][1] - r[1][2], r[0][2] - r[2][0],
                               r[1][0] - r[0][1]};
    if (q[0] < 1e-3) {  // about half a turn: use the largest column instead
        const int k = r[0][0] >= r[1][1] ? (r[0][0] >= r[2][2] ? 0 : 2) : (r[1][1] >= r[2][2] ? 1 : 2);
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        q[size_t(1 + k)] = 1 + r[k][k] - r[l][l] - r[m][m];
        q[size_t(1 + l)] = r[k][l] + r[l][k], q[size_t(1 + m)] = r[k][m] + r[m][k], q[0] = r[m][l] - r[l][m];
    }
    const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (double &x : q) x /= norm;
    return q;
}

inline void MovingScene::write_colmap(const std::string &name) const {
    fs::create_directories(work(name));
    std::ostringstream cameras, images, points;
    cameras << "# cameras\n1 SIMPLE_PINHOLE " << width_ << " " << height_ << " " << poses_[0].focal << " "
            << width_ / 2.0 << " " << height_ / 2.0 << "\n";
    images.precision(12), points.precision(12);
    std::vector<std::vector<std::pair<size_t, Sight>>> of_image(poses_.size());
    for (size_t p = 0; p < tracks.size(); p++) {
        points << p + 1 << " " << tracks[p].point.x << " " << tracks[p].point.y << " " << tracks[p].point.z
               << " 9 9 9 0.5";
        for (const Sight &sight : tracks[p].sights) {
            points << " " << sight.image + 1 << " " << of_image[sight.image].size();
            of_image[sight.image].push_back({p + 1, sight});
        }
        points << "\n";
    }
    for (size_t i = 0; i < poses_.size(); i++) {
        const Pose &pose = poses_[i];
        const auto q = quaternion_of(pose.rotation);
        images << i + 1;
        for (const double x : q) images << " " << x;
        for (const auto &row : pose.rotation)
            images << " " << -(row[0] * pose.centre[0] + row[1] * pose.centre[1] + row[2] * pose.centre[2]);
        images << " 1 " << file(i) << "\n";
        for (const auto &[point, sight] : of_image[i])  // COLMAP: the centre of the first pixel is (.5, .5)
            images << sight.xy[0] + 0.5 << " " << sight.xy[1] + 0.5 << " " << point << " ";
        images << "\n";
    }
    save_text(work(name + "/cameras.txt"), cameras.str());
    save_text(work(name + "/images.txt"), images.str());
    save_text(work(name + "/points3D.txt"), points.str());
}

inline void MovingScene::write_opensfm(const std::string &path) const {
    std::vector<Picture> pictures;
    for (size_t i = 0; i < poses_.size(); i++) pictures.push_back(read_picture(work(name_ + "/" + file(i))));
    std::ostringstream text;
    text << "OPENSFM_TRACKS_VERSION_v2\n";
    text.precision(9);
    const double side = std::max(width_, height_);
    for (size_t p = 0; p < tracks.size(); p++)
        for (size_t n = 0; n < tracks[p].sights.size(); n++) {
            const Sight &sight = tracks[p].sights[n];
            const Picture &picture = pictures[sight.image];
            const uint8_t *pixel = &picture.pixels[size_t(std::lround(sight.xy[1])) * picture.row_bytes
                                                   + 3 * size_t(std::lround(sight.xy[0]))];
            text << file(sight.image) << "\t" << p << "\t" << n << "\t" << (sight.xy[0] + 0.5 - width_ / 2.0) / side
                 << "\t" << (sight.xy[1] + 0.5 - height_ / 2.0) / side << "\t0.005\t" << int(pixel[0]) << "\t"
                 << int(pixel[1]) << "\t" << int(pixel[2]) << "\t-1\t-1\n";
        }
    save_text(path, text.str());
}

}  // namespace moving_scenes
