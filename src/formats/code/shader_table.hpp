// Responses as short tables, for programs that interpolate in single precision.
#pragma once

#include <vector>

#include <lensprof/profile.h>

namespace lensprof {

// g at even steps of grey for each response, between which it is linear.
struct ShaderTable {
    std::vector<std::vector<float>> values;
    double worst = 0.0;  // largest error of a corrected value, levels of 255
};

// The shortest table with a worst error of less than 0.3 levels.
ShaderTable shader_table(const lensprof_profile &profile);

}  // namespace lensprof
