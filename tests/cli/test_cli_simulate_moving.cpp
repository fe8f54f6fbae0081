// simulate --set moving: poses, exposures and light match truth.json. Projection and inversion of the camera are
// computed here; the positions of surfaces come from the scene itself.
#include <sched.h>

#include <array>

#include "cli/simulate/moving.hpp"

#include "cli_runs.hpp"

using namespace cli_runs;

namespace {

constexpr uint32_t width = 320, height = 240, images = 5;

Words simulate(const std::string &kind, const Words &more) {
    Words words = {"simulate", "-o", work(kind), "--set", std::string("moving=") + kind};
    const Words usual = {"--size", "320x240", "--images", "5", "--set", "noise=0", "--format", "tiff16"};
    for (size_t i = 0; i < usual.size(); i += 2)
        if (std::find(more.begin(), more.end(), usual[i]) == more.end()) words = words + Words{usual[i], usual[i + 1]};
    return words + more;
}

Json truth_of(const std::string &name) { return parsed(text_of(work(name + "/truth.json"))); }

// Grey values of a picture, and its entry in truth.json.
struct View {
    std::vector<double> samples;  // 0..1
    double ev, white_balance[3], centre[3], rotation[3][3], focal, principal[2];

    // Position of a point of the scene in the frame; false if it is outside.
    bool project(const Vector3 &point, double xy[2]) const {
        const double way[3] = {point.x - centre[0], point.y - centre[1], point.z - centre[2]};
        double seen[3] = {};
        for (int row = 0; row < 3; ++row)
            for (int k = 0; k < 3; ++k) seen[row] += rotation[row][k] * way[k];
        for (int k = 0; k < 2; ++k) xy[k] = principal[k] + focal * seen[k] / seen[2];
        return seen[2] > 0 && xy[0] >= 1 && xy[1] >= 1 && xy[0] <= width - 2.0 && xy[1] <= height - 2.0;
    }
};

View view_of(const Json &truth, size_t i, const std::string &name) {
    const Json &image = truth["images"][i], &pose = image["pose"];
    View view = {};
    const Picture picture = read_picture(work(name + "/" + image["file"].get<std::string>()));
    assert_int_equal(picture.sample, LENSPROF_SAMPLE_U16);
    for (size_t s = 0; s + 1 < picture.pixels.size(); s += 2) {
        uint16_t code;
        std::memcpy(&code, &picture.pixels[s], 2);
        view.samples.push_back(code / 65535.0);
    }
    view.ev = image["ev"].get<double>();
    view.focal = truth["camera"]["focal_px"].get<double>();
    for (size_t k = 0; k < 3; ++k) {
        view.white_balance[k] = image["white_balance"][k].get<double>();
        view.centre[k] = pose["centre_m"][k].get<double>();
        for (size_t row = 0; row < 3; ++row) view.rotation[row][k] = pose["rotation"][row][k].get<double>();
    }
    for (size_t k = 0; k < 2; ++k) view.principal[k] = truth["camera"]["principal_px"][k].get<double>();
    return view;
}

double falloff_at(const Json &truth, const double xy[2]) {
    const Json &k = truth["vignetting"]["k"][0], &centre = truth["vignetting"]["center"];
    const double half = std::hypot(width, height) / 2;
    const double x = (xy[0] - (width - 1) / 2.0) / half - centre[0].get<double>();
    const double y = (xy[1] - (height - 1) / 2.0) / half - centre[1].get<double>(), r2 = x * x + y * y;
    return 1 + r2 * (k[0].get<double>() + r2 * (k[1].get<double>() + r2 * k[2].get<double>()));
}

// Light of a grey value, from the table of the response.
double light_of(const std::vector<double> &response, double value) {
    const size_t above = size_t(std::lower_bound(response.begin(), response.end(), value) - response.begin());
    if (above == 0) return 0;
    if (above == response.size()) return 1;
    const double share = (value - response[above - 1]) / (response[above] - response[above - 1]);
    return (double(above) - 1 + share) / (double(response.size()) - 1);
}

// Radiance at a position between pixels, with the camera inverted; 0 if a neighbouring pixel is black or white.
void radiance_at(const Json &truth, const std::vector<double> &response, const View &view, const double xy[2],
                 double rgb[3]) {
    const double left = std::floor(xy[0]), top = std::floor(xy[1]);
    for (size_t c = 0; c < 3; ++c) {
        double sum = 0;
        bool known = true;
        for (int corner = 0; corner < 4; ++corner) {
            const double x = left + corner % 2, y = top + double(corner / 2);
            const double value = view.samples[3 * (size_t(y) * width + size_t(x)) + c];
            known = known && value > 0.02 && value < 0.98;
            sum += (1 - std::fabs(xy[0] - x)) * (1 - std::fabs(xy[1] - y)) * light_of(response, value);
        }
        rgb[c] = known ? sum / (falloff_at(truth, xy) * std::exp2(view.ev) * view.white_balance[c]) : 0;
    }
}

// One channel of a point that two pictures see.
struct Match {
    double difference;  // of the logarithms of radiance
    double falloffs;    // logarithm of the ratio of the falloffs
    bool glossy;
};

class Sequence {
public:
    explicit Sequence(const std::string &kind) : truth(truth_of(kind)) {
        world_ = make_moving_world(kind == "room" ? MovingKind::room : MovingKind::terrain,
                                   {1, images, width, height, 50, 1, 1});
        response_ = truth["response"]["values"][0].get<std::vector<double>>();
        for (size_t i = 0; i < images; ++i) views_.push_back(view_of(truth, i, kind));
    }

    // Points on a grid of picture a that b also sees.
    std::vector<Match> matches(size_t a, size_t b) const {
        std::vector<Match> found;
        for (double y = 5; y < height - 5; y += 4)
            for (double x = 5; x < width - 5; x += 4) add_match(views_[a], views_[b], {x, y}, found);
        return found;
    }

    const Json truth;

private:
    static Line line_to(const View &view, const double xy[2]) {
        const double seen[3] = {(xy[0] - view.principal[0]) / view.focal, (xy[1] - view.principal[1]) / view.focal, 1};
        double way[3] = {};
        for (int k = 0; k < 3; ++k)
            for (int row = 0; row < 3; ++row) way[k] += view.rotation[row][k] * seen[row];
        return {{view.centre[0], view.centre[1], view.centre[2]}, normalised({way[0], way[1], way[2]})};
    }

    void add_match(const View &a, const View &b, const std::array<double, 2> &in_a, std::vector<Match> &found) const {
        const Hit hit = world_->trace(line_to(a, in_a.data()));
        double in_b[2], light[2][3];
        if (hit.surface == 0 || !b.project(hit.point, in_b)) return;
        const Hit again = world_->trace(line_to(b, in_b));
        const Vector3 apart = again.point - hit.point;
        if (again.surface != hit.surface || dot(apart, apart) > 1e-4) return;
        const double nearer = hit.distance_m / again.distance_m;
        if (nearer < 0.8 || nearer > 1.25) return;  // fine texture fades with distance
        radiance_at(truth, response_, a, in_a.data(), light[0]);
        radiance_at(truth, response_, b, in_b, light[1]);
        for (int c = 0; c < 3; ++c)
            if (light[0][c] > 0 && light[1][c] > 0)
                found.push_back({std::log(light[1][c] / light[0][c]),
                                 std::log(falloff_at(truth, in_b) / falloff_at(truth, in_a.data())),
                                 world_->look(hit, 0.05).gloss > 0});
    }

    std::shared_ptr<const MovingWorld> world_;
    std::vector<double> response_;
    std::vector<View> views_;
};

double median(std::vector<double> values) {
    assert_true(values.size() > 100);
    std::nth_element(values.begin(), values.begin() + long(values.size() / 2), values.end());
    return values[values.size() / 2];
}

// Matte points look the same in all pictures, even if one shows them in a corner and another in its middle.
void check_light(const std::string &kind) {
    must_exit(done, simulate(kind, {}));
    const Sequence sequence(kind);
    for (size_t b = 1; b < images; ++b) {
        std::vector<double> all, sizes, darker, lighter;
        for (const Match &match : sequence.matches(b - 1, b)) {
            if (match.glossy) continue;
            all.push_back(match.difference), sizes.push_back(std::fabs(match.difference));
            if (match.falloffs < -0.05) darker.push_back(match.difference);
            if (match.falloffs > 0.05) lighter.push_back(match.difference);
        }
        assert_close(median(all), 0, 0.01);
        assert_true(median(sizes) < 0.04);
        assert_close(median(darker), 0, 0.02);
        assert_close(median(lighter), 0, 0.02);
    }
}

void test_light_of_terrain(void **) { check_light("terrain"); }
void test_light_of_room(void **) { check_light("room"); }

// The highlight on the floor moves with the camera, unless all surfaces are matte.
void test_glossy_surfaces(void **) {
    for (const char *gloss : {"1", "0"}) {
        must_exit(done, simulate("room", {"--set", std::string("gloss=") + gloss}));
        assert_close(truth_of("room")["gloss"].get<double>(), std::atof(gloss), 0);
        std::vector<double> matte, glossy;
        for (const Match &match : Sequence("room").matches(0, 2))
            (match.glossy ? glossy : matte).push_back(std::fabs(match.difference));
        assert_true((median(glossy) > 1.8 * median(matte)) == (gloss[0] == '1'));
    }
}

double row_dot(const Json &rotation, size_t a, size_t b) {
    double sum = 0;
    for (size_t k = 0; k < 3; ++k) sum += rotation[a][k].get<double>() * rotation[b][k].get<double>();
    return sum;
}

// The usual content of truth.json with a valid camera; no project.
void test_truth(void **) {
    for (const char *kind : {"terrain", "room"}) {
        const std::string out = must_exit(done, simulate(kind, {"--set", "no-images=yes", "--images", "24"}));
        assert_string_equal(out.c_str(), (work(std::string(kind) + "/truth.json") + "\n").c_str());
        assert_false(fs::exists(work(std::string(kind) + "/pano.pto")));
        const Json truth = truth_of(kind);
        assert_string_equal(truth["scene"].get<std::string>().c_str(), kind);
        assert_close(truth["camera"]["focal_px"].get<double>(), 160 / std::tan(25 * std::acos(-1.0) / 180), 1e-9);
        assert_close(truth["camera"]["principal_px"][0].get<double>(), 159.5, 0);
        assert_close(truth["camera"]["principal_px"][1].get<double>(), 119.5, 0);
        assert_int_equal(truth["images"].size(), 24);
        double least[3] = {99, 99, 99}, most[3] = {-99, -99, -99}, before[2] = {1, 1};
        for (const Json &image : truth["images"]) {
            const Json &rotation = image["pose"]["rotation"];
            for (size_t a = 0; a < 3; ++a)
                for (size_t b = 0; b < 3; ++b) assert_close(row_dot(rotation, a, b), a == b, 1e-12);
            const double values[3] = {image["ev"].get<double>(), image["white_balance"][0].get<double>(),
                                      image["white_balance"][2].get<double>()};
            for (int k = 0; k < 3; ++k)
                least[k] = std::min(least[k], values[k]), most[k] = std::max(most[k], values[k]);
            for (int k = 0; k < 2; ++k) assert_close(values[k + 1], before[k], 0.02), before[k] = values[k + 1];
        }
        assert_true(most[0] - least[0] > 0.3 && most[0] - least[0] <= 1.5);
        for (int k = 1; k < 3; ++k) assert_true(most[k] - least[k] > 0.02 && least[k] >= 0.94 && most[k] <= 1.06);
    }
}

// Within the requested limits, around the mean.
void test_limits_of_exposure(void **) {
    must_exit(done, simulate("room", {"--set", "no-images=yes", "--images", "24"}));
    const Json usual = truth_of("room")["images"];
    must_exit(done, simulate("room", {"--set", "no-images=yes", "--images", "24", "--set", "ev=0,wb=0,mean-ev=-1"}));
    const Json held = truth_of("room")["images"];
    double mean = 0;
    for (size_t i = 0; i < 24; ++i) {
        mean += usual[i]["ev"].get<double>() / 24;
        assert_close(held[i]["ev"].get<double>(), held[0]["ev"].get<double>(), 0);
        for (size_t c = 0; c < 3; ++c) assert_close(held[i]["white_balance"][c].get<double>(), 1, 0);
    }
    assert_close(held[0]["ev"].get<double>(), mean - 1, 0.1);
}

void test_metadata(void **) {
    must_exit(done, simulate("terrain", {"--images", "2", "--size", "64x48", "--format", "jpeg"}));
    const PictureMetadata m = read_metadata(work("terrain/img000.jpg"));
    assert_string_equal(m.key.camera_model, "Simulated Camera");
    assert_close(m.key.focal_mm, 38.6, 1e-9);  // 18 / tan 25 degrees
    assert_false(m.exposure_time_s || m.iso || m.exif_ev);
    must_exit(done, simulate("terrain", {"--images", "2", "--size", "64x48", "--format", "jpeg", "--exif"}));
    const Json truth = truth_of("terrain")["images"];
    assert_close(truth[1]["exif_ev"].get<double>() - truth[0]["exif_ev"].get<double>(),
                 truth[1]["ev"].get<double>() - truth[0]["ev"].get<double>(), 1e-9);
}

void test_same_bytes_with_any_threads(void **) {
    const Words small = {"--size",      "96x72", "--set",          "noise=2", "--set",
                         "objects=0.1", "--set", "local-tone=0.5", "--set",   "clip=0.02"};
    cpu_set_t all, one;
    assert_int_equal(sched_getaffinity(0, sizeof all, &all), 0);
    CPU_ZERO(&one);
    for (int cpu = 0; cpu < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++cpu)
        if (CPU_ISSET(cpu, &all)) CPU_SET(cpu, &one);
    for (const char *kind : {"terrain", "room"}) {
        must_exit(done, simulate(kind, small));
        fs::rename(work(kind), work("many"));
        assert_int_equal(sched_setaffinity(0, sizeof one, &one), 0);
        must_exit(done, simulate(kind, small));
        assert_int_equal(sched_setaffinity(0, sizeof all, &all), 0);
        for (const char *file : {"/img000.tif", "/img002.tif", "/img004.tif", "/truth.json"})
            assert_true(text_of(work(std::string("many") + file)) == text_of(work(std::string(kind) + file)));
        fs::remove_all(work("many"));
    }
    must_exit(done, simulate("room", small + Words{"--seed", "2"}));
    fs::rename(work("room"), work("other"));
    must_exit(done, simulate("room", small));
    assert_false(text_of(work("other/img000.tif")) == text_of(work("room/img000.tif")));
}

void test_refused_options(void **) {
    for (const Words &words : {Words{"--set", "rows=2"}, Words{"--set", "overlap=0.7"}, Words{"--set", "misalign=1"},
                               Words{"--scene", "wall"}, Words{"--set", "parallax=5"}, Words{"--set", "points=10"},
                               Words{"--set", "test-points=10"}})
        assert_refused(usage, simulate("room", words), {words[0], "omit --set moving"});
    for (const char *hfov : {"19", "101"})
        assert_refused(usage, simulate("terrain", {"--set", std::string("hfov=") + hfov}), {"--set hfov", "20 to 100"});
    assert_refused(usage, {"simulate", "-o", work("s"), "--set", "gloss=1"}, {"--set gloss: needs moving"});
    assert_refused(usage, simulate("room", {"--set", "gloss=5"}), {"--set gloss"});
    assert_refused(usage, {"simulate", "-o", work("s"), "--set", "moving=sea"}, {"--set moving", "terrain"});
    assert_refused(usage, {"simulate", "-o", work("s"), "--set", "moving="}, {"--set moving"});
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_light_of_terrain),
        CLI_TEST(test_light_of_room),
        CLI_TEST(test_glossy_surfaces),
        CLI_TEST(test_truth),
        CLI_TEST(test_limits_of_exposure),
        CLI_TEST(test_metadata),
        CLI_TEST(test_same_bytes_with_any_threads),
        CLI_TEST(test_refused_options),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
