/* simulate.hpp - the parts of `lensprof simulate`: a known camera before a known scene. */
#ifndef LENSPROF_CLI_SIMULATE_HPP
#define LENSPROF_CLI_SIMULATE_HPP

#include <string>
#include <vector>

#include <lensprof/lensprof.h>

#include "scene.hpp"

namespace lensprof {

/* Everything that is true about a simulated sequence. */
struct Truth {
    uint32_t seed = 1;
    lensprof_response response;
    lensprof_vignetting vignetting[3]; /* of red, green, blue */
    uint32_t vignettings = 1;
    double noise_levels = 2.0;         /* of 255, in the grey value */
    double outlier_share = 0.0;        /* pixels or pairs replaced by random numbers */
    std::vector<lensprof_camera> cameras;
    std::vector<lensprof_exposure> exposures;
    std::vector<std::string> files;
};

/* splitmix64: uniform and normal numbers from a seed, the same on every machine. */
class Random {
public:
    explicit Random(uint64_t seed) : state_(seed) {}
    double uniform();                         /* [0, 1) */
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    double normal();

private:
    uint64_t state_;
};

/* Grey values 0..1 that image `index` records of radiance `rgb` at a pixel, without noise. */
void record(const Truth &truth, uint32_t index, double x, double y, const double rgb[3], double value[3]);

/* `count` correspondences in random overlaps, evenly over ten rings of radius, both ends between `darkest` and 250
 * levels. `noisy` adds noise, outlier pairs (one end random) and rounding to `levels` steps. Fewer come back where
 * overlaps hold too few. */
std::vector<lensprof_pair> simulate_pairs(const Truth &truth, const Scene &scene, uint32_t count, double darkest,
                                          bool noisy, uint32_t levels);

}  // namespace lensprof

#endif
