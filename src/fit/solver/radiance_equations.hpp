// The quadratic model of the radiance method: residuals of tracks, their radiances eliminated.
//
// With v the derivatives of a track's predictions by the logarithm of its radiance, W its weights and J those by
// everything else, eliminating the radiance leaves  J'WJ - J'Wv v'WJ / v'Wv. v is also the derivative by the images'
// log exposures, one observation each: their part is again the Laplacian of a graph, in which a track joins its images
// i and j by W_i v_i^2 W_j v_j^2 / v'Wv.
#pragma once

#include "fit/problem/radiance.hpp"
#include "fit/solver/normal_equations.hpp"

namespace lensprof {

class RadianceEquations : public NormalEquations {
public:
    RadianceEquations(const Problem &problem, const Prior &prior, const Loss &loss, const Trust &trust,
                      const Estimate &estimate, const ModeTable &modes);

private:
    struct Part;
    void add_chunk(const Range &chunk, const TrackEvaluator &evaluator, const Trust &trust, const ModeTable &modes,
                   Part &part) const;
    void add_channel(const Range &track, int channel, const TrackFit &fit, double factor, const ModeTable &modes,
                     Part &part) const;
    static void add_rows(Part &part);
};

}  // namespace lensprof
