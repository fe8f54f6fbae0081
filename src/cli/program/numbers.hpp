// Parsing of numbers in option values.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace lensprof {

// The quantity of a number: determines the units that may follow it.
enum class Unit {
    none,
    focal_mm,       // 24, 24mm
    f_number,       // 4, f/4, F4
    time_s,         // 0.5, 1/60, 1/60s
    distance_m,     // 3, 3m
    temperature_k,  // 2850, 2850K
};

// A number from low to high, inclusive; never "nan", and "inf" only within this range.
struct Quantity {
    double low, high;
    Unit unit = Unit::none;
};

constexpr Quantity any_number = {-1e300, 1e300};
constexpr Quantity crop_factors = {0.01, 1e4};
constexpr Quantity focal_lengths = {0.01, 1e5, Unit::focal_mm};
constexpr Quantity f_numbers = {0.01, 1e4, Unit::f_number};
constexpr Quantity temperatures = {1000.0, 20000.0, Unit::temperature_k};
constexpr Quantity distances = {1e-6, INFINITY, Unit::distance_m};

// Parses "0.125", "1e-3" or "1/8", with or without unit. Throws std::invalid_argument with the reason.
double number_of(const std::string &word, const Quantity &quantity);

// Parses an integer. Throws std::invalid_argument as above.
uint32_t count_of(const std::string &word, uint32_t low, uint32_t high);

// Splits a comma-separated list.
std::vector<std::string> split(const std::string &list, char separator = ',');

// The same, without empty elements. Throws std::invalid_argument as above.
std::vector<std::string> elements(const std::string &list);

}  // namespace lensprof
