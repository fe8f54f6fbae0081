// The parts of `lensprof simulate`: a known camera and a known scene.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <lensprof/lensprof.h>

#include "cli/simulate/moving.hpp"
#include "cli/simulate/simulate_options.hpp"
#include "cli/simulate/simulated_scene.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/scene/scene.hpp"

namespace lensprof {

// An object in one picture only; px of the frame.
struct Block {
    double left, top, right, bottom;
    double rgb[3];   // radiance
    double texture;  // amplitude in the logarithm of radiance; 0 = even
    double depth;    // offset of its texture in the noise

    bool contains(double x, double y) const { return x >= left && x < right && y >= top && y < bottom; }
};

// Gain of local tone mapping, EV, on a coarse grid over the frame.
struct ToneMap {
    uint32_t columns = 0, rows = 0;
    std::vector<double> ev;
};

// The exposure in a picture's metadata.
struct Settings {
    double time_s, iso, f_number;
};

// The complete truth of a simulated sequence.
struct Truth {
    uint32_t seed = 1;
    SimulatedKind scene = SimulatedKind::landscape;
    lensprof_response response;
    lensprof_vignetting vignetting[3];  // of red, green, blue
    uint32_t vignettings = 1;
    double noise_levels = 2.0;   // of 255, in the grey value
    double outlier_share = 0.0;  // share of pixels or pairs replaced by random values
    double object_share = 0.0;   // share of a picture covered by moving objects
    double local_tone = 0.0;     // EV: maximum by which local tone mapping raises shadows and lowers highlights
    double parallax = 0.0;       // px: maximum shift of a near object between two pictures
    double sharpening = 0.0;     // gain of the unsharp mask
    double clip_share = 0.0;     // share of the pixels that are white in a channel; 0 = exposures as drawn
    std::vector<lensprof_camera> cameras;
    std::vector<std::array<double, 2>> positions;  // px by which each picture shifts the nearest objects; empty = the
                                                   // camera only turns
    std::vector<lensprof_exposure> exposures;
    std::vector<std::string> files;
    std::vector<std::vector<Block>> objects;  // per image; the last one is in front; empty = none anywhere
    std::vector<ToneMap> tone;                // per image; empty = no local tone mapping
    std::vector<Settings> settings;           // per image; empty = not written
    bool is_manual = false;                   // marked as set manually
    // only of a moving camera:
    std::shared_ptr<const MovingWorld> world;  // instead of the scene
    const char *world_word = nullptr;          // its name
    double gloss = 1.0;                        // strength of highlights; 0 = matte surfaces
    Pinhole pinhole{};
    std::vector<Pose> poses;  // per image
};

// splitmix64: uniform and normal random numbers from a seed, the same on every machine.
class Random {
public:
    explicit Random(uint64_t seed) : state_(seed) {}
    double uniform();  // [0, 1)
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    double normal();

private:
    uint64_t state_;
};

constexpr double kSimulatedFNumber = 2.8;  // a wide, constant aperture, because falloff depends on it

// The truth requested by the options; Failure (usage).
Truth make_truth(const SimulateOptions &options, const SimulatedScene &scene);

// The scene as an alignment program would find it: geometry known, exposures unknown.
Scene aligned_scene(const SimulateOptions &options, const Truth &truth);
std::string truth_text(const Truth &truth);  // content of truth.json

// Irradiance that image `index` records for a pixel of radiance `rgb`; 1 = white.
void irradiance_of(const Truth &truth, uint32_t index, double x, double y, const double rgb[3], double irradiance[3]);

// Grey values 0..1 that image `index` records for radiance `rgb` at a pixel, without noise.
void record(const Truth &truth, uint32_t index, double x, double y, const double rgb[3], double value[3]);

// Random blocks with sides of 5..25 % of those of the frame and centres in it, covering `share` of it on average.
std::vector<Block> random_blocks(const lensprof_camera &camera, double share, Random &random);

// Radiance of the object in front at a pixel; false if not found.
bool object_radiance(const Truth &truth, const SimulatedScene &scene, uint32_t index, double x, double y,
                     double rgb[3]);

// Radiance that image `index` sees at a pixel: of an object, else of the scene; 0 outside the lens's field.
void seen_radiance(const Truth &truth, const SimulatedScene &scene, uint32_t index, double x, double y, double rgb[3]);

// --set parallax: cameras that also move; then the scene direction of what is seen in a direction.
void move_cameras(double parallax, Random &random, Truth &truth);
void moved_direction(const Truth &truth, const SimulatedScene &scene, uint32_t index, double direction[2]);

// --set moving: the scene, cameras and poses; then automatic exposures and white balances.
void place_moving_cameras(const SimulateOptions &options, Truth &truth);
void expose_automatically(const SimulateOptions &options, Truth &truth);

// --set clip: shifts all exposures equally until this share of the pixels is white in a channel.
void clip_lights(double share, const SimulatedScene &scene, Truth &truth);

// --set sharpen: unsharp mask (Gaussian, sigma 1.5 px) of float RGB, clipped to 0..1.
void sharpen(double gain, Picture &picture);

// Local tone mapping after the response: a pixel is raised by truth.local_tone EV if its surroundings (Gaussian mean of
// the grey value, sigma a tenth of the width) are black, and lowered by as much if they are white.
ToneMap tone_map(const Truth &truth, const SimulatedScene &scene, uint32_t index);
double tone_gain(const Truth &truth, uint32_t index, double x, double y);
void map_tone(double gain, double value[3]);  // white stays white

// `count` correspondences in random overlaps, uniform over ten rings of radius, both ends between `darkest` and 250
// levels. `noisy` adds objects, local tone mapping, noise, outlier pairs (one end random) and rounding to `levels`
// steps. Returns fewer if the overlaps are too small.
std::vector<lensprof_pair> simulate_pairs(const Truth &truth, const SimulatedScene &scene, uint32_t count,
                                          double darkest, bool noisy, uint32_t levels);

}  // namespace lensprof
