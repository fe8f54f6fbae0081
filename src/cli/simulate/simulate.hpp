// The parts of `lensprof simulate`: a known camera before a known scene.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <lensprof/lensprof.h>

#include "cli/pictures/picture.hpp"
#include "cli/simulate/moving.hpp"
#include "cli/simulate/scene.hpp"
#include "cli/simulate/simulate_options.hpp"

namespace lensprof {

// An object that is in one picture only; px of the frame.
struct Block {
    double left, top, right, bottom;
    double rgb[3];   // radiance
    double texture;  // amplitude in the logarithm of radiance; 0 = even
    double depth;    // where in the noise its texture lies

    bool holds(double x, double y) const { return x >= left && x < right && y >= top && y < bottom; }
};

// Gain of local tone mapping, EV, on a coarse grid from corner to corner of the frame.
struct ToneMap {
    uint32_t columns = 0, rows = 0;
    std::vector<double> ev;
};

// What the metadata of a picture state about its exposure.
struct Settings {
    double time_s, iso, f_number;
};

// Everything that is true about a simulated sequence.
struct Truth {
    uint32_t seed = 1;
    SceneKind scene = SceneKind::landscape;
    lensprof_response response;
    lensprof_vignetting vignetting[3];  // of red, green, blue
    uint32_t vignettings = 1;
    double noise_levels = 2.0;   // of 255, in the grey value
    double outlier_share = 0.0;  // pixels or pairs replaced by random numbers
    double object_share = 0.0;   // of a picture, covered by objects that move
    double local_tone = 0.0;     // EV: most that local tone mapping raises shadows and lowers lights
    double parallax = 0.0;       // px: most that something near shifts between two pictures
    double sharpening = 0.0;     // gain of the unsharp mask
    double clip_share = 0.0;     // of the pixels, white in a channel; 0 = exposures as drawn
    std::vector<lensprof_camera> cameras;
    std::vector<std::array<double, 2>> positions;  // px that each shifts what is nearest by; empty = it only turns
    std::vector<lensprof_exposure> exposures;
    std::vector<std::string> files;
    std::vector<std::vector<Block>> objects;  // of every image; the last one is in front; empty = none anywhere
    std::vector<ToneMap> tone;                // of every image; empty = no local tone mapping
    std::vector<Settings> settings;           // of every image; empty = the pictures do not tell
    bool is_manual = false;                   // they tell that these were set by hand
    // --moving alone:
    std::shared_ptr<const MovingWorld> world;  // instead of the scene
    const char *world_word = nullptr;          // its name
    double gloss = 1.0;                        // strength of highlights; 0 = matte surfaces
    Pinhole pinhole{};
    std::vector<Pose> poses;  // of every image
};

// splitmix64: uniform and normal numbers from a seed, the same on every machine.
class Random {
public:
    explicit Random(uint64_t seed) : state_(seed) {}
    double uniform();  // [0, 1)
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    double normal();

private:
    uint64_t state_;
};

constexpr double kSimulatedFNumber = 2.8;  // a wide aperture, which stays: falloff changes with it

// All that the options ask for; Failure (usage).
Truth make_truth(const SimulateOptions &options, const Scene &scene);

// The project as an alignment program would leave it: geometry known, exposures to be found.
std::string project_text(const SimulateOptions &options, const Truth &truth);
std::string truth_text(const Truth &truth);  // of truth.json

// Irradiance that image `index` records at a pixel of radiance `rgb`; 1 = white.
void irradiance_of(const Truth &truth, uint32_t index, double x, double y, const double rgb[3], double irradiance[3]);

// Grey values 0..1 that image `index` records of radiance `rgb` at a pixel, without noise.
void record(const Truth &truth, uint32_t index, double x, double y, const double rgb[3], double value[3]);

// Random blocks, their sides 5..25 % of the frame's and their centres in it, that cover `share` of it on average.
std::vector<Block> random_blocks(const lensprof_camera &camera, double share, Random &random);

// Radiance of the object in front at a pixel; false when there is none.
bool object_radiance(const Truth &truth, const Scene &scene, uint32_t index, double x, double y, double rgb[3]);

// Radiance that image `index` sees at a pixel: of an object, else of the scene; 0 where the lens sees nothing.
void seen_radiance(const Truth &truth, const Scene &scene, uint32_t index, double x, double y, double rgb[3]);

// --parallax: cameras that also move. Then the direction in which the scene has what is seen in a direction.
void move_cameras(double parallax, Random &random, Truth &truth);
void moved_direction(const Truth &truth, const Scene &scene, uint32_t index, double direction[2]);

// --moving: the world, cameras and poses. Then exposures and white balances as a camera would choose them.
void place_moving_cameras(const SimulateOptions &options, Truth &truth);
void expose_automatically(const SimulateOptions &options, Truth &truth);

// --clip: moves all exposures alike until this share of the pixels is white in a channel.
void clip_lights(double share, const Scene &scene, Truth &truth);

// --sharpen: unsharp mask (Gaussian, sigma 1.5 px) of float RGB, clipped to 0..1.
void sharpen(double gain, Picture &picture);

// Local tone mapping after the response: where the surroundings (Gaussian mean of the grey value, sigma a tenth of the
// width) of a pixel are black it is raised by truth.local_tone EV, where they are white lowered by as much.
ToneMap tone_map(const Truth &truth, const Scene &scene, uint32_t index);
double tone_gain(const Truth &truth, uint32_t index, double x, double y);
void map_tone(double gain, double value[3]);  // white stays white

// `count` correspondences in random overlaps, evenly over ten rings of radius, both ends between `darkest` and 250
// levels. `noisy` adds objects, local tone mapping, noise, outlier pairs (one end random) and rounding to `levels`
// steps. Fewer come back where overlaps hold too few.
std::vector<lensprof_pair> simulate_pairs(const Truth &truth, const Scene &scene, uint32_t count, double darkest,
                                          bool noisy, uint32_t levels);

}  // namespace lensprof
