// The readers of responses, for files of any format. Each throws FormatFailure.
#pragma once

#include <string_view>

#include <lensprof/formats.h>

#include "formats/falloff/curve_table.hpp"

namespace lensprof {

lensprof_response read_pcalib(std::string_view text, Repair &repair);

// One response or three, at `responses`; returns their number.
uint32_t read_curves(std::string_view text, uint32_t curve, Repair &repair, lensprof_response *responses);

void read_radical_responses(std::string_view data, Repair &repair, lensprof_response *responses);

}  // namespace lensprof
