// Responses as other programs tabulate them: mostly inverted, as the irradiances of evenly spaced grey values.
#pragma once

#include <string>
#include <vector>

#include <lensprof/model.h>

#include "formats/text/text.hpp"

namespace lensprof {

constexpr size_t kMaxCurveRows = 65536;
constexpr double kDarkest = 1e-6;  // of full irradiance: replaces 0 in formats that store its logarithm

// First index whose value is below (strict: not above) the one before it; the size if there is no such index.
size_t find_fall(const std::vector<double> &values, bool strict);

// How values that fall are treated: refused, or replaced by the nearest increasing curve; and how far they then are
// from it.
struct Repair {
    bool is_allowed = false;
    double change = 0.0;  // the largest of all curves, levels: 1/255 of the range of a curve
};

// Replaces values by the nearest curve, in least squares, that rises by at least `step` per value. Throws RESPONSE if
// that is off by over a tenth of its range, or flat, which is not a response.
void make_increasing(std::vector<double> &values, double step, Repair &repair);

// The response with these irradiances at the grey values i / (size - 1), to any scale: the last is that of full grey.
// At least 2, finite, none below 0 or below that before it, and the last above 0; below the first of them the response
// is 0.
lensprof_response response_of_irradiances(const std::vector<double> &irradiances);

// Irradiances 0..1 of `count` evenly spaced grey values.
std::vector<double> irradiances_of(const lensprof_response &response, size_t count);

// Grey values 0..1 of `count` evenly spaced irradiances.
std::vector<double> greys_of(const lensprof_response &response, size_t count);

// Throws, with the status of lensprof_response_validate, if it is not a response. what: "response 1".
void check_response(const lensprof_response &response, const std::string &item);

}  // namespace lensprof
