// Corrects the crops of a picture, each by its own plan, and the rest of it by another.
#pragma once

#include <memory>
#include <vector>

#include "photo/correct/picture_plan.hpp"

namespace lensprof {

class CropPlans {
public:
    CropPlans(const Picture &source, const Correction &job, const CorrectionKind &kind);

    // Rows of the picture, from `first_row` on; `target` has the size of `source`, or is the same memory. Where crops
    // overlap, each has the half that is nearer to its middle.
    void apply(const Plan &rest, const lensprof_image &source, const lensprof_target &target, uint32_t first_row) const;

private:
    struct Part {
        const CropCorrection *correction;
        std::unique_ptr<Plan> plan;
    };
    // Columns of a row with one plan.
    struct Span {
        uint32_t begin, end;
        const Part *part;
    };
    std::vector<Span> spans_of(uint32_t width, uint32_t row) const;

    const Correction &job_;
    std::vector<Part> parts_;
};

}  // namespace lensprof
