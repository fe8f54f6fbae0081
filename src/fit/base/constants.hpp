// Constants used in several folders.
#pragma once

namespace lensprof {

constexpr double kPi = 3.14159265358979323846;
constexpr double kLn2 = 0.6931471805599453;  // natural logarithm per EV
constexpr double kMadToSigma = 1.4826;  // standard deviation of a normal distribution per median absolute deviation

}  // namespace lensprof
