// The simulated camera, according to the options.
#include <cmath>
#include <stdexcept>

#include "cli/simulate/simulate.hpp"
#include "photo/base/failure.hpp"
#include "photo/base/format.hpp"
#include "photo/base/library.hpp"

namespace lensprof {
namespace {

// Exposure time and ISO that give the exposure of every image, apart from --set exif-rounding.
std::vector<Settings> exposure_settings(const SimulateOptions &o, const Truth &truth) {
    Random random(truth.seed * 104729ull + 11);
    std::vector<Settings> settings;
    for (const auto &e : truth.exposures) {
        double stated = e.ev + o.exif_rounding * random.normal();
        double iso = 100.0 * std::exp2(std::floor(random.uniform(0.0, 4.0)));
        if (o.exif_manual) iso = 100.0;
        settings.push_back({std::exp2(stated) / iso, iso, kSimulatedFNumber});  // 1/100 s at ISO 100 for 0 EV
    }
    return settings;
}

// The EXIF exposures of the pictures, and the scatter of the true ones about them.
void add_settings(const SimulateOptions &o, Truth &truth) {
    truth.settings = exposure_settings(o, truth);
    truth.is_manual = o.exif_manual;
    Random random(truth.seed * 86028121ull + 7);
    for (auto &e : truth.exposures) e.ev += o.exif_scatter * random.normal();
}

// Parts for the keys objects, parallax, clip and local-tone, and --exif; with separate random numbers, so that the rest
// stays the same.
void add_disturbances(const SimulateOptions &o, const SimulatedScene &scene, Truth &truth) {
    Random random(o.seed * 15485863ull + 3);
    truth.object_share = o.objects;
    truth.local_tone = o.local_tone;
    truth.sharpening = o.sharpen;
    if (o.objects > 0.0)
        for (const auto &camera : truth.cameras) truth.objects.push_back(random_blocks(camera, o.objects, random));
    Random places(o.seed * 32452843ull + 17);
    if (o.parallax > 0.0) move_cameras(o.parallax, places, truth);
    if (o.clip > 0.0) clip_lights(o.clip, scene, truth);
    if (o.local_tone > 0.0)
        for (uint32_t i = 0; i < truth.cameras.size(); i++) truth.tone.push_back(tone_map(truth, scene, i));
    if (o.exif) add_settings(o, truth);
}

void place_cameras(const SimulateOptions &o, Random &random, Truth &truth) {
    double degree = std::acos(-1.0) / 180.0,
           vfov = 2.0 / degree * std::atan(std::tan(o.hfov / 2.0 * degree) * o.height / o.width);
    uint32_t columns = (o.images + o.rows - 1) / o.rows;
    for (uint32_t i = 0; i < o.images; i++) {
        uint32_t row = i / columns, column = i % columns;
        lensprof_camera camera{};
        camera.width = o.width;
        camera.height = o.height;
        camera.hfov_deg = o.hfov;
        double yaw = (column - (columns - 1) / 2.0 + (row % 2 ? 0.5 : 0.0)) * o.hfov * (1.0 - o.overlap);
        camera.yaw_deg = std::remainder(yaw + o.jitter * random.normal(), 360.0);
        camera.pitch_deg = (row - (o.rows - 1) / 2.0) * vfov * (1.0 - o.overlap) + o.jitter * random.normal();
        camera.roll_deg = o.jitter * random.normal();
        check(lensprof_camera_validate(&camera), "--set hfov");
        truth.cameras.push_back(camera);
    }
}

// Uniform; the first white balance is neutral.
void draw_exposures(const SimulateOptions &o, Random &random, Truth &truth) {
    const double max_ev = o.ev.value_or(kRandomEv), wb = o.wb.value_or(kRandomWb);
    for (uint32_t i = 0; i < o.images; i++) {
        lensprof_exposure e;
        lensprof_exposure_init(&e);
        double draws[3] = {o.mean_ev + random.uniform(-max_ev, max_ev), random.uniform(1 - wb, 1 + wb),
                           random.uniform(1 - wb, 1 + wb)};
        e.ev = draws[0];
        if (i > 0) e.white_balance[0] = draws[1], e.white_balance[2] = draws[2];
        truth.exposures.push_back(e);
    }
}

// Failure (usage) for the option at fault: the curve, or the centre if only it is.
void check_falloff(lensprof_vignetting falloff) {
    if (lensprof_vignetting_validate(&falloff) == LENSPROF_OK) return;
    falloff.center[0] = falloff.center[1] = 0.0;
    if (lensprof_vignetting_validate(&falloff) != LENSPROF_OK)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--vignetting: the falloff must stay positive up to the corner; give smaller numbers");
    throw Failure(
        LENSPROF_ERROR_ARGUMENT,
        "--set center: the falloff must stay positive up to the farthest corner; give a centre closer to 0,0");
}

}  // namespace

Truth make_truth(const SimulateOptions &o, const SimulatedScene &scene) {
    Truth truth;
    truth.seed = o.seed;
    truth.scene = o.scene;
    truth.response = o.response;
    truth.noise_levels = o.noise;
    truth.outlier_share = o.outliers;
    if (o.vignetting.size() != 3 && o.vignetting.size() != 9)
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--vignetting: give three numbers, or nine");
    if (o.center.size() != 2) throw Failure(LENSPROF_ERROR_ARGUMENT, "--set center: give two numbers, x,y");
    truth.vignettings = static_cast<uint32_t>(o.vignetting.size() / 3);
    for (uint32_t c = 0; c < 3; c++) {
        for (uint32_t n = 0; n < 3; n++)
            truth.vignetting[c].k[n] = o.vignetting[(truth.vignettings == 3 ? 3 * c : 0) + n];
        for (uint32_t d = 0; d < 2; d++) truth.vignetting[c].center[d] = o.center[d];
        check_falloff(truth.vignetting[c]);
    }
    if (o.moving) {
        place_moving_cameras(o, truth);
        expose_automatically(o, truth);
    } else {
        Random random(o.seed);
        place_cameras(o, random, truth);
        draw_exposures(o, random, truth);
    }
    for (uint32_t i = 0; i < o.images; i++)
        truth.files.push_back(format("img%03u", i) + o.formats[i % o.formats.size()].extension);
    add_disturbances(o, scene, truth);
    return truth;
}

}  // namespace lensprof
