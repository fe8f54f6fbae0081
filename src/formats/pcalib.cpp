// TUM's pcalib.txt, which DSO and its kin read: the inverse response at evenly spaced grey values.
#include <algorithm>

#include "formats/each_format.h"

#include "formats/responses.hpp"

namespace lensprof {
namespace {

constexpr size_t kRows = 256;
constexpr double kFull = 255.0;
// Between two values: six units of single precision, in which they are read, at 255.
constexpr double kMinStep = 1e-4;

// kMinStep of what 255 is in a file of another scale and number of values.
double smallest_step(const std::vector<double> &values) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return kMinStep / static_cast<double>(values.size()) * (*high - *low);
}

std::vector<double> read_values(std::string_view text) {
    std::vector<double> values;
    LineReader lines(text);
    while (lines.next())
        for (std::string_view rest = lines.line, word = next_word(rest); !word.empty(); word = next_word(rest)) {
            double value;
            if (!read_number(word, value))
                fail_at_line(lines.number, "value " + std::to_string(values.size()) + " is " + in_quotes(word)
                                               + ", not a finite number; interpolate missing grey values");
            if (values.size() == kMaxCurveRows)
                throw FormatFailure{LENSPROF_ERROR_SIZE, "over 65536 values; give one per grey value"};
            values.push_back(value);
        }
    return values;
}

std::string pcalib_text(const lensprof_response &response) {
    check_response(response, "the response");
    std::vector<double> values = irradiances_of(response, kRows);
    values[0] = 0.0;
    for (size_t i = 1; i < kRows; i++) values[i] = std::max(values[i] * kFull, values[i - 1] + kMinStep);
    values[kRows - 1] = kFull;
    for (size_t i = kRows - 1; i-- > 0 && values[i + 1] - values[i] < kMinStep / 2.0;)
        values[i] = values[i + 1] - kMinStep;
    std::string text;
    for (size_t i = 0; i < kRows; i++) text += (i ? " " : "") + number_text(values[i]);
    return text + "\n";
}

}  // namespace

lensprof_response read_pcalib(std::string_view text, Repair &repair) {
    std::vector<double> values = read_values(text);
    const size_t fall = find_fall(values, true);
    if (fall < values.size() && !repair.is_allowed)
        throw FormatFailure{LENSPROF_ERROR_RESPONSE,
                            "value " + std::to_string(fall) + " (" + number_text(values[fall])
                                + ") is not above the one before (" + number_text(values[fall - 1])
                                + "), but an inverse response must increase; smooth it, or write it with lensprof"};
    if (values.size() < kRows)
        throw FormatFailure{
            LENSPROF_ERROR_SYNTAX,
            std::to_string(values.size()) + " values, not 256 or more; give the whole file, with one per grey value"};
    if (fall < values.size()) make_increasing(values, smallest_step(values), repair);
    const double first = values.front(), range = values.back() - first;
    for (double &value : values) value = std::max((value - first) / range, 0.0);
    return response_of_irradiances(values);
}

}  // namespace lensprof

using namespace lensprof;

lensprof_status lp_pcalib_read(const void *data, size_t size, lensprof_response *response, lensprof_error *error) {
    if ((!data && size) || !response) {
        set_error(error, "lensprof_import: data or response is NULL; pass a buffer and a response");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return at_boundary(error, [&] {
        Repair none;
        *response = read_pcalib(view_of(data, size), none);
    });
}

lensprof_status lp_pcalib_write(const lensprof_response *response, void *data, size_t capacity, size_t *count,
                                lensprof_error *error) {
    if (!response || (!data && capacity)) {
        set_error(error, "lensprof_export: response or data is NULL; pass a response and a buffer");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return write_at_boundary(data, capacity, count, error, [&] { return pcalib_text(*response); });
}
