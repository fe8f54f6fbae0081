// Numbers in the words of an option.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace lensprof {

// What a number measures: the units that may follow it.
enum class Unit {
    none,
    focal_mm,    // 24, 24mm
    f_number,    // 4, f/4, F4
    time_s,      // 0.5, 1/60, 1/60s
    distance_m,  // 3, 3m
};

// A number from low to high, both included; neither "nan" nor "inf" beyond them.
struct Quantity {
    double low, high;
    Unit unit = Unit::none;
};

constexpr Quantity any_number = {-1e300, 1e300};
constexpr Quantity crop_factors = {0.01, 1e4};
constexpr Quantity focal_lengths = {0.01, 1e5, Unit::focal_mm};
constexpr Quantity f_numbers = {0.01, 1e4, Unit::f_number};
constexpr Quantity distances = {1e-6, INFINITY, Unit::distance_m};

// "0.125", "1e-3" or "1/8", with the unit or without. std::invalid_argument says what is wrong with the word.
double number_of(const std::string &word, const Quantity &quantity);

// A whole number. std::invalid_argument as above.
uint32_t count_of(const std::string &word, uint32_t low, uint32_t high);

// The words of a list with commas.
std::vector<std::string> split(const std::string &list, char separator = ',');

// The same, where none may be empty. std::invalid_argument as above.
std::vector<std::string> elements(const std::string &list);

// Failure (usage) that names the option where a list of so many `values` does not have one for each of `count` things
// ("picture").
void demand_count(size_t values, const std::string &option, size_t count, const std::string &thing);

}  // namespace lensprof
