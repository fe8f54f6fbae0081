// The limits of verdicts on fits, each with what it is derived from. `lensprof_finding` has the measured value next to
// its limit, also where a rule holds, so that benchmarks draw good refused and bad accepted over every limit.
#pragma once

#include <cstdint>

namespace lensprof {

// Data. Tenths of the grey values; half diagonals; EV.
constexpr double kPairsPerUnknown = 2.0;  // fewer leave no pairs to hold out
constexpr double kMinGreys = 4.0, kEnoughGreys = 8.0;
constexpr double kSmallestRadius = 0.6;  // beyond it, k1..k3 extrapolate
constexpr double kSameView = 0.03;       // of r^2: a corner of 70 % then changes grey values by 1 %
// Root mean square difference, EV, of overlapping pictures, over pairs and channels. Below it, they do not determine a
// response without falloff: their transfer functions are the identity.
constexpr double kSmallestSpread = 0.15;

// Agreement. Shares of pairs; levels of 255.
constexpr double kSmallestAgreement = 0.3;
constexpr double kSmallestStillAgreement = 0.7;  // if equal places are compared,
constexpr double kStillMedian = 1.5;             // and levels of 255 that half of them exceed
constexpr double kLargestNoise = 6.0;            // above the noise of any camera, so the model does not fit
constexpr double kMinInliers = 3.0;              // of an image: fewer agree by chance,
constexpr double kSmallestImageShare = 0.2;      // or a smaller share of its pairs
constexpr double kInconsistentImage = 5.0;       // median residual of an image, and four times the noise

// Patterns per image: share of the residual's variance, and levels of 255. Noise and moving things stay below the
// share; rounding and JPEG below the levels.
constexpr double kLargestImageShare = 0.2, kSuspiciousImageShare = 0.1;
constexpr double kHarmfulPattern = 0.5, kSmallestPattern = 0.3;
constexpr double kHarmfulStillPattern = 2.0, kStillPattern = 1.0;  // the same if no falloff can be biased
constexpr double kNotRadial = 0.3;                                 // share explained by one map over the frame

// Falloff and centre.
constexpr double kLargestCornerSigma = 0.1;  // of M
constexpr double kFarCenter = 0.1;           // half diagonals: five standard errors of its prior
constexpr double kOnLimit = 0.98;            // of the largest allowed offset of the centre
constexpr double kClearOfLimit = 3.0;        // standard errors

// Exposures.
constexpr double kLargestEvSigma = 0.3;      // EV, standard error: above it the exposure is not determined
constexpr double kContradiction = 5.0;       // standard errors between an exposure and its known value
constexpr int kMany = 12;                    // known exposures, whose errors follow from their scatter
constexpr double kInconsistentGamma = 0.05;  // of ln gamma

// Response.
constexpr double kUnusual = 1.0;  // Gauge::oddness

// Seams. Levels of 255; kSeen is comparable to the texture around a seam.
constexpr double kSmallestShare = 0.7;  // of the pairs that agree
constexpr double kLargestRms = 15.0;
constexpr double kSeen = 3.0;

}  // namespace lensprof
