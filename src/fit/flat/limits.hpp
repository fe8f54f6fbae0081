// The limits of verdicts on flat fields, each with what it is derived from.
#pragma once

namespace lensprof {
namespace flat_limits {

constexpr double kMinCells = 60.0;
constexpr double kSmallestRadius = 0.6, kWholeRadius = 0.9;   // half diagonals: beyond it, k1..k3 extrapolate
constexpr double kMuchClipped = 0.2, kSomeClipped = 0.005;    // of the card, white or black in every exposure
constexpr double kLargestCornerSigma = 0.01;                  // of M
constexpr double kMuchTexture = 0.01, kSomeTexture = 0.005;   // of the light
constexpr double kSteepAlone = 0.2, kSlantAlone = 0.1;        // of the light per half diagonal, not rotated:
constexpr double kSteepRotated = 0.5;                         // its square is about the error of a plane
constexpr double kMuchPerShot = 0.015, kSomePerShot = 0.004;  // of the light
constexpr double kNotRadial = 0.003;                          // of the light
constexpr double kWrongEv = 0.3, kDoubtfulEv = 0.1;           // EV, within a shot
constexpr double kSteepest = 0.05, kFlattest = 20.0;          // d ln E / d ln B; of cameras .2 to 10
constexpr double kFewInliers = 0.5;
constexpr double kFarCenter = 0.1;  // half diagonals, as for pairs

}  // namespace flat_limits
}  // namespace lensprof
