// Converts a correction to the library's plan and to the header and metadata of the output.
#pragma once

#include <vector>

#include "photo/correct/correction.hpp"
#include "photo/pictures/picture.hpp"

namespace lensprof {

// A plan that owns its memory.
class Plan {
public:
    Plan(const lensprof_apply_options &options, const std::string &item)
        : memory_(lensprof_plan_bytes(&options) / 8 + 1) {
        lensprof_error error{};
        check(lensprof_plan_init(memory_.data(), memory_.size() * 8, &options, &plan_, &error), item, &error);
    }
    const lensprof_plan *get() const { return plan_; }

private:
    std::vector<uint64_t> memory_;
    const lensprof_plan *plan_ = nullptr;
};

lensprof_apply_options options_of(const Picture &source, const Correction &job, const CorrectionKind &kind);

// The header of the output.
Picture header_of_result(const Picture &source, uint32_t sample);

// The metadata of the source with the mark of the correction.
WriteOptions write_options(const Correction &job, const CorrectionKind &kind);

}  // namespace lensprof
