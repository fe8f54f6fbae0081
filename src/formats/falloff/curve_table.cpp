#include "formats/falloff/curve_table.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace lensprof {
namespace {

constexpr double kLevels = 255.0, kLargestChange = 25.5;  // levels

// The nearest curve that does not fall, by pooling adjacent violators (Ayer et al. 1955).
std::vector<double> isotonic(const std::vector<double> &values) {
    struct Block {
        double sum, count;
        double mean() const { return sum / count; }
    };
    std::vector<Block> blocks;
    for (const double value : values) {
        Block block{value, 1.0};
        for (; !blocks.empty() && blocks.back().mean() > block.mean(); blocks.pop_back())
            block.sum += blocks.back().sum, block.count += blocks.back().count;
        blocks.push_back(block);
    }
    std::vector<double> fitted;
    for (const Block &block : blocks) fitted.insert(fitted.end(), static_cast<size_t>(block.count), block.mean());
    return fitted;
}

}  // namespace

void make_increasing(std::vector<double> &values, double step, Repair &repair) {
    // y rises by the step per value exactly if y - i step does not fall.
    std::vector<double> fitted;
    for (size_t i = 0; i < values.size(); i++) fitted.push_back(values[i] - step * static_cast<double>(i));
    fitted = isotonic(fitted);
    const double flat = fitted.back() - fitted.front();
    double change = 0.0;
    for (size_t i = 0; i < values.size(); i++) {
        fitted[i] += step * static_cast<double>(i);
        change = std::max(change, std::fabs(fitted[i] - values[i]));
    }
    const double range = fitted.back() - fitted.front(), levels = kLevels * change / range;
    if (!(flat > 0.0) || !std::isfinite(range) || !(levels <= kLargestChange))
        throw FormatFailure{LENSPROF_ERROR_RESPONSE,
                            "values decrease so much that no increasing curve is within a tenth of them, so it is not "
                            "a response; check the file and the kind of table"};
    values = fitted;
    repair.change = std::max(repair.change, levels);
}

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

std::vector<double> greys_of(const lensprof_response &response, size_t count) {
    std::vector<double> values(count);
    for (size_t i = 0; i < count; i++)
        values[i] = lensprof_response_eval(&response, static_cast<double>(i) / static_cast<double>(count - 1), nullptr);
    return values;
}

void check_response(const lensprof_response &response, const std::string &item) {
    const lensprof_status status = lensprof_response_validate(&response);
    if (status != LENSPROF_OK)
        throw FormatFailure{
            status, item + " is invalid (" + lensprof_status_name(status) + "); see lensprof_response_validate"};
}

}  // namespace lensprof
