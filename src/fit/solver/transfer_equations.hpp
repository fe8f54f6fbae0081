// The quadratic model of the transfer error: residuals of pairs by shared unknowns and by a_ic - a_jc.
#pragma once

#include "fit/problem/loss.hpp"
#include "fit/solver/normal_equations.hpp"

namespace lensprof {

class TransferEquations : public NormalEquations {
public:
    TransferEquations(const Problem &problem, const Prior &prior, const Loss &loss, const NoiseWeights &weights,
                      const Estimate &estimate, const ModeTable &modes);

private:
    struct Rows;  // residuals of one edge and channel
    struct Part;
    void add_chunk(const Chunk &chunk, const Loss &loss, const NoiseWeights &weights, const Estimate &estimate,
                   const ModeTable &modes, Part &part) const;
    void add_edge(const Edge &edge, const Loss &loss, const NoiseWeights &weights, const Estimate &estimate,
                  const ModeTable &modes, Part &part) const;
    static void add_rows(const Edge &edge, int channel, Part &part);
};

}  // namespace lensprof
