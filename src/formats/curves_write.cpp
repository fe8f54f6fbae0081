// Response curves to CSV.
#include <algorithm>
#include <cmath>
#include <vector>

#include "formats/each_format.h"

#include "formats/falloff/curve_table.hpp"

namespace lensprof {
namespace {

std::vector<double> column(const lensprof_response &response, uint32_t curve, uint32_t rows) {
    if (curve == LENSPROF_CURVE_FORWARD) return greys_of(response, rows);
    std::vector<double> values = irradiances_of(response, rows);
    for (double &value : values) {
        if (curve == LENSPROF_CURVE_LOG) value = std::log(std::max(value, kDarkest));
        if (curve == LENSPROF_CURVE_LOG10) value = std::log10(std::max(value, kDarkest));
    }
    return values;
}

std::string curves_text(const lensprof_response *responses, uint32_t count, uint32_t curve, uint32_t rows) {
    std::vector<std::vector<double>> columns;
    for (uint32_t c = 0; c < count; c++) {
        check_response(responses[c], "response " + std::to_string(c));
        columns.push_back(column(responses[c], curve, rows));
    }
    static constexpr const char *kNames[] = {"irradiance", "ln(irradiance)", "log10(irradiance)", "grey"};
    const bool forward = curve == LENSPROF_CURVE_FORWARD;
    std::string text = forward ? "irradiance" : "grey";
    text += count == 3 ? ",red,green,blue\n" : "," + std::string(kNames[curve]) + "\n";
    for (uint32_t i = 0; i < rows; i++) {
        text += forward ? number_text(i / (rows - 1.0)) : std::to_string(i);
        for (const std::vector<double> &values : columns) text += "," + number_text(values[i]);
        text += '\n';
    }
    return text;
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

lensprof_status lp_curves_write(const lensprof_response *responses, uint32_t response_count, uint32_t curve,
                                uint32_t rows, void *data, size_t capacity, size_t *count, lensprof_error *error) {
    if (!responses || (response_count != 1 && response_count != 3) || curve > LENSPROF_CURVE_FORWARD || rows < 2
        || rows > kMaxCurveRows || (!data && capacity)) {
        set_error(error, "lensprof_export: give 1 or 3 responses, a lensprof_curve, 2 to 65536 rows and a buffer");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return write_at_boundary(data, capacity, count, error,
                             [&] { return curves_text(responses, response_count, curve, rows); });
}
