#include "formats/falloff/curve_table.hpp"

#include <algorithm>

namespace lensprof {

size_t find_fall(const std::vector<double> &values, bool strict) {
    for (size_t i = 1; i < values.size(); i++)
        if (strict ? !(values[i] > values[i - 1]) : !(values[i] >= values[i - 1])) return i;
    return values.size();
}

lensprof_response response_of_irradiances(const std::vector<double> &irradiances) {
    constexpr size_t kLast = LENSPROF_RESPONSE_SAMPLES - 1;
    const double last = static_cast<double>(irradiances.size() - 1);
    double table[LENSPROF_RESPONSE_SAMPLES];
    for (size_t j = 0; j <= kLast; j++) {
        const double x = irradiances.back() * static_cast<double>(j) / kLast;
        const auto above = std::upper_bound(irradiances.begin(), irradiances.end(), x);
        double grey = 1.0;
        if (above == irradiances.begin())
            grey = 0.0;
        else if (above != irradiances.end())
            grey = (static_cast<double>(above - irradiances.begin()) - 1.0 + (x - above[-1]) / (above[0] - above[-1]))
                   / last;
        table[j] = j ? std::clamp(grey, table[j - 1], 1.0) : 0.0;
    }
    table[kLast] = 1.0;
    lensprof_response response;
    const lensprof_status status = lensprof_response_set_table(&response, table, LENSPROF_RESPONSE_SAMPLES);
    if (status != LENSPROF_OK) throw FormatFailure{status, "it is not a response; check the content of the table"};
    return response;
}

std::vector<double> irradiances_of(const lensprof_response &response, size_t count) {
    std::vector<double> values(count);
    for (size_t i = 0; i < count; i++)
        values[i] =
            lensprof_response_invert(&response, static_cast<double>(i) / static_cast<double>(count - 1), nullptr);
    return values;
}

void check_response(const lensprof_response &response, const std::string &item) {
    const lensprof_status status = lensprof_response_validate(&response);
    if (status != LENSPROF_OK)
        throw FormatFailure{
            status, item + " is invalid (" + lensprof_status_name(status) + "); see lensprof_response_validate"};
}

}  // namespace lensprof
