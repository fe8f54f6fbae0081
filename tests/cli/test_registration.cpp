// Cameras and candidates of pictures without a project, from simulated matches.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <opencv2/calib3d.hpp>

#include "photo/registration/cameras.hpp"
#include "photo/registration/candidates.hpp"
#include "photo/registration/copies.hpp"
#include "photo/registration/matching.hpp"
#include "photo/registration/nearest_features.hpp"
#include "photo/registration/pinhole.hpp"
extern "C" {
#include "support.h"
}

using namespace lensprof;

namespace {

constexpr uint32_t kWidth = 1200, kHeight = 900;

struct Scene {
    std::vector<lensprof_camera> cameras;
    std::vector<PictureOptics> optics;
    std::vector<PictureLink> links;
};

lensprof_camera camera_at(double yaw, double pitch, double hfov) {
    lensprof_camera camera{};
    camera.width = kWidth, camera.height = kHeight;
    camera.hfov_deg = hfov, camera.yaw_deg = yaw, camera.pitch_deg = pitch;
    return camera;
}

bool is_seen(const double xy[2]) { return xy[0] >= 0.0 && xy[1] >= 0.0 && xy[0] < kWidth && xy[1] < kHeight; }

// Links between all pictures that overlap enough, with matches that have `noise` px of error and a share of wrong ones.
Scene scene_of(std::vector<lensprof_camera> cameras, double noise, double wrong, uint32_t seed) {
    Scene scene;
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0.0, noise);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    scene.cameras = std::move(cameras);
    scene.optics.assign(scene.cameras.size(), {kWidth, kHeight, 0, std::nullopt, 1});
    for (uint32_t i = 0; i < scene.cameras.size(); i++)
        for (uint32_t j = i + 1; j < scene.cameras.size(); j++) {
            PictureLink link{{i, j}, {}, cv::Matx33d::eye()};
            for (int n = 0; n < 400; n++) {
                const double x = uniform(random) * kWidth, y = uniform(random) * kHeight;
                double direction[2], xy[2];
                if (!lensprof_camera_unproject(&scene.cameras[i], x, y, direction)
                    || !lensprof_camera_project(&scene.cameras[j], direction[0], direction[1], xy) || !is_seen(xy))
                    continue;
                const bool is_wrong = uniform(random) < wrong;
                if (is_wrong) xy[0] = uniform(random) * kWidth, xy[1] = uniform(random) * kHeight;
                link.matches.push_back({{x, y}, {xy[0] + normal(random), xy[1] + normal(random)}});
            }
            if (link.matches.size() >= 40) scene.links.push_back(link);
        }
    return scene;
}

// Error in px of a position in picture `from` as seen by `to`, of the found cameras compared with the true ones.
double largest_error(const Scene &scene, const FoundCameras &found) {
    double largest = 0.0;
    for (const PictureLink &link : scene.links)
        for (const auto &[place, other] : link.matches) {
            double direction[2], xy[2], truth[2];
            const uint32_t i = link.picture[0], j = link.picture[1];
            if (!lensprof_camera_unproject(&scene.cameras[i], place.x, place.y, direction)
                || !lensprof_camera_project(&scene.cameras[j], direction[0], direction[1], truth))
                continue;
            assert_true(lensprof_camera_unproject(&found.cameras[i], place.x, place.y, direction));
            assert_true(lensprof_camera_project(&found.cameras[j], direction[0], direction[1], xy));
            largest = std::max(largest, std::hypot(xy[0] - truth[0], xy[1] - truth[1]));
        }
    return largest;
}

// A row, two rows, and a closed ring; the angle of view is unknown.
void test_a_camera_that_turned(void **) {
    for (uint32_t seed = 1; seed <= 3; seed++) {
        std::vector<lensprof_camera> row, rows, ring;
        for (int i = 0; i < 6; i++) row.push_back(camera_at(30.0 * i, 2.0 * (i % 2), 50.0));
        for (int i = 0; i < 10; i++) rows.push_back(camera_at(18.0 * (i % 5), 20.0 * (i / 5), 32.0));
        for (int i = 0; i < 18; i++) ring.push_back(camera_at(20.0 * i, 0.0, 34.0));
        for (auto *cameras : {&row, &rows, &ring}) {
            for (lensprof_camera &c : *cameras) c.radial[1] = -0.03;
            const Scene scene = scene_of(*cameras, 0.4, 0.05, seed);
            const FoundCameras found = find_cameras(scene.optics, scene.links);
            assert_int_equal(found.kind, SceneKind::panorama);
            assert_true(largest_error(scene, found) < 2.0);
            assert_true(std::fabs(found.cameras[0].hfov_deg / (*cameras)[0].hfov_deg - 1.0) < 0.04);
        }
    }
}

// Metadata with an error of a tenth, and rotated pictures.
void test_metadata_are_a_first_guess(void **) {
    std::vector<lensprof_camera> ring;
    for (int i = 0; i < 18; i++) ring.push_back(camera_at(20.0 * i, 0.0, 34.0));
    for (lensprof_camera &c : ring) c.roll_deg = 90.0;
    Scene scene = scene_of(ring, 0.4, 0.0, 4);
    for (PictureOptics &o : scene.optics) o.hfov_deg = 34.0 * 1.08, o.orientation = 6;
    const FoundCameras found = find_cameras(scene.optics, scene.links);
    assert_true(largest_error(scene, found) < 2.0);
    for (const lensprof_camera &c : found.cameras) {
        assert_true(std::fabs(c.roll_deg - 90.0) < 1.0);  // the camera is upright
        assert_true(std::fabs(c.pitch_deg) < 1.0);
    }
}

// A drone over the ground: the position of every picture relative to the first.
void test_a_camera_that_moved_over_a_plane(void **) {
    std::vector<lensprof_camera> cameras;
    for (int i = 0; i < 9; i++) {
        lensprof_camera c = camera_at(1.5 * (i % 2), -1.0 * (i % 3), 70.0);
        c.translation[0] = 0.35 * (i % 3), c.translation[1] = 0.3 * (i / 3), c.translation[2] = 0.02 * (i % 2);
        c.roll_deg = i % 2 ? 3.0 : -2.0;
        cameras.push_back(c);
    }
    Scene scene = scene_of(cameras, 0.4, 0.05, 7);
    for (PictureLink &link : scene.links) {
        std::vector<cv::Point2d> from, to;
        for (const auto &[place, other] : link.matches) from.push_back(place), to.push_back(other);
        link.homography = cv::findHomography(from, to, cv::USAC_MAGSAC, 3.0);
    }
    for (PictureOptics &o : scene.optics) o.hfov_deg = 72.0;
    const FoundCameras found = find_cameras(scene.optics, scene.links);
    assert_int_equal(found.kind, SceneKind::plane);
    double sum = 0.0;
    for (double r : found.link_residuals) sum += r;
    assert_true(sum / double(found.link_residuals.size()) < 0.001);
}

// The same pixels as by the model of geometry.h, for turned and moved cameras with distortion, seen or not.
void test_pinhole(void **) {
    std::mt19937 random(21);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    int projected = 0, lost = 0;
    for (int n = 0; n < 400; n++) {
        lensprof_camera camera[2];
        for (lensprof_camera &c : camera) {
            c = camera_at(60.0 * uniform(random), 30.0 * uniform(random), 70.0 + 40.0 * uniform(random));
            c.roll_deg = 180.0 * uniform(random);
            for (double &r : c.radial) r = n % 4 ? 0.15 * uniform(random) : 0.0;
            if (n % 3 == 0) std::generate_n(c.translation, 3, [&] { return 0.4 * uniform(random); });
        }
        const double x = 0.5 * kWidth * (1.0 + 1.2 * uniform(random)),
                     y = 0.5 * kHeight * (1.0 + 1.2 * uniform(random));
        double direction[2], xy[2];
        const bool is_seen = lensprof_camera_unproject(&camera[0], x, y, direction)
                             && lensprof_camera_project(&camera[1], direction[0], direction[1], xy);
        const Pinhole first(camera[0]), second(camera[1]);
        Eigen::Vector3d ray, seen;
        Eigen::Vector2d found;
        assert_int_equal(first.ray(x, y, ray) && first.seen(ray, seen) && second.project(seen, found), is_seen);
        if (!is_seen) {
            lost++;
            continue;
        }
        projected++;
        assert_true(std::hypot(found.x() - xy[0], found.y() - xy[1]) < 1e-7 * (1.0 + std::hypot(xy[0], xy[1])));
    }
    assert_true(projected > 100 && lost > 100);
}

// Every processor finds the same, for any number of rows and with equal ones.
void test_nearest_features(void **) {
    const std::vector<NearestKernel> kernels = nearest_kernels();
#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
    const bool has_vnni = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vnni");
    assert_int_equal(kernels.size(), 1 + (__builtin_cpu_supports("avx2") != 0) + has_vnni);
#endif
    std::mt19937 random(11);
    for (const auto &[count_a, count_b] : {std::pair(1, 1), {3, 2}, {4, 16}, {9, 17}, {17, 33}, {30, 203}}) {
        std::vector<int16_t> a, b;
        for (int i = 0; i < count_a * descriptor_length; i++) a.push_back(static_cast<int16_t>(random() % 2800));
        for (int i = 0; i < count_b * descriptor_length; i++) b.push_back(static_cast<int16_t>(random() % 2800));
        if (count_b > 9) std::copy_n(b.begin() + 8 * descriptor_length, descriptor_length, b.begin());
        const auto plain = kernels.back().find(a.data(), count_a, b.data(), count_b);
        for (const NearestFeatures &nearest : plain)
            assert_true(nearest.best > 0 && nearest.number >= 0 && nearest.number < count_b);
        for (const NearestKernel &kernel : kernels) {
            const auto found = kernel.find(a.data(), count_a, b.data(), count_b);
            assert_int_equal(found.size(), count_a);
            for (size_t i = 0; i < found.size(); i++)
                if (found[i].number != plain[i].number || found[i].best != plain[i].best
                    || (count_b > 1 && found[i].next != plain[i].next))
                    fail_msg("%s: row %zu of %d among %d", kernel.instructions, i, count_a, count_b);
        }
    }
}

// Similar pictures are candidates, and the number of candidates does not grow with the square.
void test_candidates(void **) {
    std::mt19937 random(3);
    std::normal_distribution<float> normal(0.0f, 1.0f);
    constexpr int kGroups = 40, kMembers = 5, kFeatures = 60;
    std::vector<Features> pictures;
    for (int group = 0; group < kGroups; group++) {
        cv::Mat own(kFeatures, descriptor_length, CV_32F);
        for (int y = 0; y < kFeatures; y++)
            for (int x = 0; x < descriptor_length; x++) own.at<float>(y, x) = std::fabs(normal(random));
        for (int member = 0; member < kMembers; member++) {
            Features picture;
            picture.descriptors = own.clone();
            for (int y = 0; y < kFeatures; y++)
                for (int x = 0; x < descriptor_length; x++) {
                    float &value = picture.descriptors.at<float>(y, x);
                    value = std::max(0.0f, value + 0.3f * normal(random));
                }
            picture.descriptors = take_roots(picture.descriptors);
            pictures.push_back(picture);
        }
    }
    std::vector<Features> mixed;  // pictures of a group are far apart
    for (int member = 0; member < kMembers; member++)
        for (int group = 0; group < kGroups; group++) mixed.push_back(pictures[size_t(group * kMembers + member)]);
    const std::vector<PicturePair> pairs = candidate_pairs(mixed);
    assert_true(pairs.size() <= 14 * mixed.size());
    size_t found = 0;
    for (const auto &[a, b] : pairs) found += a % kGroups == b % kGroups;
    assert_int_equal(found, kGroups * kMembers * (kMembers - 1) / 2);

    const std::vector<PicturePair> linked{{0, 1}, {1, 2}};
    const std::vector<PicturePair> further = further_pairs(3, linked, linked);
    assert_int_equal(further.size(), 1);
    assert_true(further[0] == PicturePair(0, 2));
}

// Pictures in a ring about the camera, each of which shows a part of it, and some of nothing else.
struct Ring {
    static constexpr uint32_t kPictures = 60, kUnrelated = 4;
    static constexpr int kStep = 100, kPoints = 900;
    std::vector<Features> pictures;

    Ring() {
        std::mt19937 random(5);
        std::normal_distribution<float> normal(0.0f, 1.0f);
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        constexpr double around = kStep * double(kPictures);
        cv::Mat own(kPoints, descriptor_length, CV_32F);
        std::vector<cv::Point2d> places;
        for (int n = 0; n < kPoints; n++) {
            places.emplace_back(uniform(random) * around, uniform(random) * kHeight);
            for (int x = 0; x < descriptor_length; x++) own.at<float>(n, x) = std::fabs(normal(random));
        }
        for (uint32_t i = 0; i < kPictures + kUnrelated; i++) {
            Features picture;
            picture.width = kWidth, picture.height = kHeight;
            cv::Mat seen;
            for (int n = 0; n < kPoints; n++) {
                const cv::Point2d &place = places[size_t(n)];
                const double x = std::fmod(place.x - kStep * double(i) + 2.0 * around, around);
                if (x >= kWidth) continue;
                picture.places.emplace_back(x + 0.3 * normal(random), place.y + 0.3 * normal(random));
                cv::Mat row = own.row(n).clone();
                for (int k = 0; k < descriptor_length; k++) {
                    const float noise = i < kPictures ? 0.1f * normal(random) : 3.0f * normal(random);
                    row.at<float>(0, k) = std::max(0.0f, row.at<float>(0, k) + noise);
                }
                seen.push_back(row);
            }
            picture.descriptors = take_roots(seen);
            pictures.push_back(picture);
        }
    }
};

using Pairs = std::vector<PicturePair>;

// The links of the ring's pictures in this order, by their numbers in it.
Pairs links_of(const Ring &ring, const std::vector<uint32_t> &order) {
    std::vector<Features> pictures;
    for (const uint32_t i : order) pictures.push_back(ring.pictures[i]);
    Events events;
    Pairs pairs;
    for (const PictureLink &link : find_links(pictures, events))
        pairs.push_back(std::minmax(order[link.picture[0]], order[link.picture[1]]));
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

// Many pictures have enough links each, in any order: those next to each other, and the first with the last.
void test_links_of_many(void **) {
    const Ring ring;
    std::vector<uint32_t> order(ring.pictures.size());
    std::iota(order.begin(), order.end(), 0u);
    std::vector<uint32_t> shuffled = order;
    std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(9));
    const size_t all = Ring::kPictures * (kWidth / Ring::kStep - 1);  // that overlap
    for (const std::vector<uint32_t> &own : {order, shuffled}) {
        const Pairs pairs = links_of(ring, own);
        std::vector<size_t> count(ring.pictures.size());
        for (const auto &[a, b] : pairs) count[a]++, count[b]++;
        for (uint32_t i = 0; i < ring.pictures.size(); i++)
            assert_true(i < Ring::kPictures ? count[i] >= 10 : count[i] == 0);
        for (uint32_t i = 0; i < Ring::kPictures; i++)
            assert_true(
                std::binary_search(pairs.begin(), pairs.end(), PicturePair(std::minmax(i, (i + 1) % Ring::kPictures))));
        assert_true(pairs.size() <= all);
        assert_true(pairs == links_of(ring, own));
    }
}

// Neighbours of the ring match under one homography. Not so where every other point is nearer and moves more.
void test_neighbours_of_a_camera_that_turned(void **) {
    const Ring ring;
    std::vector<std::pair<Features, Features>> neighbours, moved;
    for (uint32_t i = 0; i < 4; i++) neighbours.emplace_back(ring.pictures[i], ring.pictures[i + 1]);
    moved = neighbours;
    for (auto &[first, second] : moved) {
        std::mt19937 random(2);
        for (cv::Point2d &place : second.places) place.x += random() % 2 ? 40.0 + double(random() % 200) : 0.0;
    }
    assert_true(turn_only(neighbours));
    assert_false(turn_only(moved));
    for (auto &[first, second] : neighbours) second = ring.pictures[Ring::kPictures];
    assert_false(turn_only(neighbours));
}

// A sequence is linked with growing distance, where it is linked half way; a picture with enough links needs no more.
void test_candidates_of_a_sequence(void **) {
    LinkedPictures linked(40);
    assert_int_equal(linked.in_sequence(2).size(), 38);
    assert_true(linked.in_sequence(4).empty());
    for (uint32_t i = 0; i + 2 < 20; i++) linked.add_link({i, i + 2});
    assert_int_equal(linked.in_sequence(4).size(), 16);
    assert_true(linked.are_near(3, 7) && !linked.are_near(3, 9));
    const std::vector<PicturePair> through = linked.through_common();
    assert_int_equal(through.size(), 16);
    linked.add_tried(through);
    assert_true(linked.through_common().empty() && linked.is_tried({3, 7}));
    LinkedPictures star(40);
    for (uint32_t i = 1; i < 25; i++) star.add_link({0, i});
    assert_true(star.is_joined(0) && !star.is_joined(1));
    for (const auto &[a, b] : star.through_common()) assert_true(a > 0 && b > 0);
}

void test_groups(void **) {
    std::vector<PictureLink> links(3);
    links[0].picture[0] = 4, links[0].picture[1] = 5;
    links[1].picture[0] = 0, links[1].picture[1] = 4;
    links[2].picture[0] = 1, links[2].picture[1] = 3;
    const std::vector<uint32_t> groups = groups_of(6, links), wanted{0, 1, 2, 1, 0, 0};
    assert_true(groups == wanted);
}

// Detail of a scene, the same for one seed, and different noise for each picture.
Features picture_of(unsigned scene, unsigned noise, uint32_t width = kWidth, uint32_t height = kHeight) {
    std::mt19937 random(scene);
    std::normal_distribution<float> normal(0.0f, 12.0f), error(0.0f, 1.0f);
    Features picture;
    picture.width = width, picture.height = height;
    picture.detail = cv::Mat(64, 64, CV_32F);
    for (int y = 0; y < 64; y += 2)
        for (int x = 0; x < 64; x += 2) picture.detail(cv::Rect(x, y, 2, 2)) = normal(random);
    std::mt19937 own(noise);
    for (int y = 0; y < 64; y++)
        for (int x = 0; x < 64; x++) picture.detail.at<float>(y, x) += error(own);
    return picture;
}

std::vector<PictureCopy> copies_among(const std::vector<Features> &pictures,
                                      const std::vector<std::string> &captured = {}) {
    std::vector<CopyCandidate> all;
    for (size_t i = 0; i < pictures.size(); i++)
        all.push_back({&pictures[i], captured.empty() ? "" : captured[i], std::nullopt});
    return find_copies(all);
}

// Two photographs in seven other orientations each; the copies name the first.
void test_turned_copies(void **) {
    std::vector<Features> pictures{picture_of(1, 1), picture_of(2, 2)};
    for (unsigned scene : {1u, 2u})
        for (int turn = 0; turn < 4; turn++)
            for (bool mirrored : {false, true}) {
                if (turn == 0 && !mirrored) continue;
                Features copy = turn % 2 ? picture_of(scene, 90, kHeight, kWidth) : picture_of(scene, 91);
                if (turn) cv::rotate(copy.detail, copy.detail, turn - 1);
                if (mirrored) cv::flip(copy.detail, copy.detail, 1);
                copy.detail = 0.7f * copy.detail;  // of another tone
                pictures.push_back(copy);
            }
    const std::vector<PictureCopy> found = copies_among(pictures);
    assert_int_equal(found.size(), 14);
    size_t mirrored = 0;
    for (const PictureCopy &one : found) {
        assert_int_equal(one.original, one.copy < 9 ? 0 : 1);
        mirrored += one.how == ", mirrored";
    }
    assert_int_equal(mirrored, 8);
}

// Upright frames of one size are copies only if the moment is the same; the largest is the original, then that in
// colour.
void test_upright_copies(void **) {
    const std::vector<Features> two{picture_of(1, 1), picture_of(1, 2)};
    assert_true(copies_among(two).empty());  // frames from a tripod
    assert_true(copies_among(two, {"10:00:00.10", "10:00:00.20"}).empty());
    assert_int_equal(copies_among(two, {"10:00:00.10", "10:00:00.10"}).size(), 1);
    assert_int_equal(copies_among(two, {"", "10:00:00.10"})[0].copy, 0);
    const std::vector<PictureCopy> resized = copies_among({picture_of(1, 1, 600, 450), picture_of(1, 2)}, {"", "1"});
    assert_int_equal(resized.size(), 1);
    assert_true(resized[0].copy == 0 && resized[0].original == 1 && resized[0].how == ", resized");
    assert_true(copies_among({picture_of(1, 1, 600, 600), picture_of(1, 2)}, {"", "1"}).empty());  // another shape
    Features small = picture_of(1, 3, kWidth / 2 + 1, kHeight / 2), grey = picture_of(1, 4);
    grey.is_grey = true;
    const std::vector<PictureCopy> smaller = copies_among({small, two[0]});
    assert_true(smaller.size() == 1 && smaller[0].copy == 0 && smaller[0].how == ", resized");
    assert_true(copies_among({small, two[0]}, {"10:00:00.10", "10:00:00.20"}).empty());
    const std::vector<PictureCopy> in_grey = copies_among({grey, two[0]});
    assert_true(in_grey.size() == 1 && in_grey[0].copy == 0 && in_grey[0].how.empty());
    assert_true(copies_among({grey, two[0]}, {"10:00:00.10", "10:00:00.20"}).empty());
    Features other_grey = picture_of(1, 5);
    other_grey.is_grey = true;
    assert_true(copies_among({grey, other_grey}).empty());  // frames from a tripod
    assert_true(copies_among({picture_of(2, 3, 600, 450), two[0]}).empty());
    const Features mirrored = [&] {
        Features f = picture_of(1, 6);
        cv::flip(f.detail, f.detail, 1);
        return f;
    }();
    for (const bool first_overlaps : {true, false}) {  // other pictures
        CopyCandidate first{&mirrored, "", std::nullopt}, second{&two[0], "", std::nullopt};
        first.overlaps = first_overlaps, second.overlaps = !first_overlaps;
        const std::vector<PictureCopy> found = find_copies({first, second});
        assert_true(found.size() == 1 && found[0].copy == first_overlaps && found[0].is_mirrored);
    }
    CopyCandidate darker{&two[0], "", 0.01}, brighter{&two[1], "1", 0.02};  // a bracket
    assert_true(find_copies({darker, brighter}).empty());
}

// Neither blank frames nor a common border with other content are copies.
void test_no_copies(void **) {
    std::vector<Features> pictures;
    for (unsigned n = 0; n < 30; n++)
        pictures.push_back(picture_of(10 + n, n, kWidth + n % 3 * 400, kHeight + n % 3 * 300));
    for (unsigned n = 0; n < 4; n++) {
        Features blank = picture_of(1, n), framed = picture_of(50 + n, n, 400 + 4 * n, 300 + 3 * n);
        blank.detail *= 0.01;
        framed.detail.rowRange(0, 8) = 200.0f, framed.detail.rowRange(56, 64) = 200.0f;
        framed.detail.rowRange(4, 60).colRange(0, 3) = -200.0f;
        pictures.push_back(blank), pictures.push_back(framed);
    }
    assert_true(copies_among(pictures).empty());
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_a_camera_that_turned),
        cmocka_unit_test(test_metadata_are_a_first_guess),
        cmocka_unit_test(test_a_camera_that_moved_over_a_plane),
        cmocka_unit_test(test_pinhole),
        cmocka_unit_test(test_nearest_features),
        cmocka_unit_test(test_candidates),
        cmocka_unit_test(test_links_of_many),
        cmocka_unit_test(test_neighbours_of_a_camera_that_turned),
        cmocka_unit_test(test_candidates_of_a_sequence),
        cmocka_unit_test(test_groups),
        cmocka_unit_test(test_turned_copies),
        cmocka_unit_test(test_upright_copies),
        cmocka_unit_test(test_no_copies),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
