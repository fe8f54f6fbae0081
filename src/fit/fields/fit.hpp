// The fit of fields: what a caller's object holds.
#pragma once

#include <array>
#include <vector>

#include <lensprof/fields.h>

#include "fit/fields/cells.hpp"
#include "fit/fields/shading.hpp"
#include "fit/verdict/finding.hpp"

namespace lensprof {

struct FieldPicture {
    FieldCells cells;                              // linear values
    std::array<double, 3> level{{NAN, NAN, NAN}};  // of the last fit
    bool used = false;
    uint32_t same_as = 0;
};

struct FieldsFit {
    lensprof_fields_options options;
    std::array<lensprof_response, 3> response;
    FieldGrid grid;
    std::vector<FieldPicture> pictures;
    bool is_fitted = false;
    lensprof_fields_result result;
    std::array<std::vector<double>, 3> heldout;  // per channel and smoothness
    Findings verdict;
};

// Fits all pictures; false if none shows light. Throws Cancelled.
bool fit_fields(FieldsFit &fit);

// Whether the samples are light; others have no offset.
bool is_linear(const FieldsFit &fit);

// Fills verdict and usable.
void judge_fields(FieldsFit &fit);

}  // namespace lensprof
