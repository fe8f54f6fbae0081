// The readers of responses, for files of any format. Each throws FormatFailure.
#pragma once

#include <string_view>
#include <vector>

#include <lensprof/formats.h>

#include "formats/falloff/curve_table.hpp"

namespace lensprof {

lensprof_response read_pcalib(std::string_view text, Repair &repair);

// One response or three, at `responses`; returns their number.
uint32_t read_curves(std::string_view text, uint32_t curve, Repair &repair, lensprof_response *responses);

// The same of a cube, which holds the curve INVERSE or FORWARD; others are refused.
void check_cube_curve(uint32_t curve);
uint32_t read_cube(std::string_view text, uint32_t curve, Repair &repair, lensprof_response *responses);

// The values of one channel of a table and the lines that they are in.
struct TableColumn {
    std::vector<double> values;
    std::vector<size_t> lines;
};
lensprof_response response_of_column(TableColumn column, uint32_t curve, Repair &repair);

void read_radical_responses(std::string_view data, Repair &repair, lensprof_response *responses);

}  // namespace lensprof
