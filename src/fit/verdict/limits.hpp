// The limits of verdicts on fits, each with what it is derived from: a definition, or an experiment.
//
// Gallery: 200 good and 200 bad rendered sequences (`tests/bench/run.sh --only verdicts`, which prints the curve over
// every limit; docs/benchmark-results.md has them). "Gallery 4/14, 1/15, 0/15": good ones found / bad ones that no
// other rule finds, at half the limit, at the limit and at twice the limit. Rules without such a figure found nothing
// there: they are for inputs that the gallery does not render, which tests/fit has.
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
constexpr double kLargestNoise = 6.0;            // above the noise of any camera. Gallery 1/14, 1/15, 1/15
constexpr double kMinInliers = 3.0;              // of an image: fewer agree by chance,
constexpr double kSmallestImageShare = 0.2;      // or a smaller share of its pairs
constexpr double kSmallestLinkShare = 0.2;       // of a link, or the link is broken
constexpr double kSmallestPart = 0.5;            // of the images of a set: fewer agree by chance
constexpr double kInconsistentImage = 5.0;       // median residual, and four times the noise. Gallery 18/5, 12/5, 6/6

// Patterns per image: share of the residual's variance, and levels of 255. Noise and moving things stay below the
// share; rounding and JPEG below the levels. Chosen on the other half of the gallery (--tune), where .35 refuses a good
// sequence. Harmful: gallery 0/13, 0/15, 0/34; weak: 0/5, 0/5, 0/7. Real panoramas have 0, but grail .44 with a share
// of .18 (a warning) and halfdome 1.2 (refused).
constexpr double kLargestImageShare = 0.2, kSuspiciousImageShare = 0.1;
constexpr double kHarmfulPattern = 0.4, kWeakPattern = 0.15, kSmallestPattern = 0.3;
constexpr double kHarmfulStillPattern = 2.0, kStillPattern = 1.0;  // the same if no falloff can be biased
constexpr double kNotRadial = 0.3;                                 // share explained by one map over the frame

// Falloff and centre.
constexpr double kMovingImages = 12.0;       // of a moving camera
constexpr double kLargestCornerSigma = 0.1;  // of M. Gallery 1/14, 1/15, 0/15
constexpr double kFarCenter = 0.1;           // half diagonals: five standard errors of its prior
constexpr double kOnLimit = 0.98;            // of the largest allowed offset of the centre
constexpr double kClearOfLimit = 3.0;        // standard errors

// Exposures.
constexpr double kLargestEvSigma = 0.3;      // EV, standard error. Gallery 4/14, 1/15, 0/15
constexpr double kContradiction = 5.0;       // standard errors between an exposure and its known value
constexpr int kMany = 12;                    // known exposures, whose errors follow from their scatter
constexpr double kInconsistentGamma = 0.05;  // of ln gamma
// EV between known exposures that contradict each other: EXIF is rounded to a third; a real panorama has .29.
constexpr double kWrongByAStop = 1.0;
constexpr double kReportableEv = 0.1;   // EV: less is not seen
constexpr double kClearSpread = 0.7;    // EV, from the darkest to the brightest: visible in any pictures
constexpr double kFlatSlope = 0.1;      // of the known exposures against the found ones: they belong elsewhere
constexpr double kClearlyBetter = 4.0;  // in chi-squared, than the next explanation: two standard errors

// Response.
// Gauge::oddness: 1 = the spread of measured cameras. Twice it: gallery 39/2, 2/5, 0/7; real panoramas reach 1.9. No
// good sequence of 400, and no real panorama, has both an unusual response and a weak pattern of each
// image: gallery 0/3, 0/5, 0/7, of sequences with a weak pattern.
constexpr double kUnusual = 1.0, kVeryUnusual = 2.0;
// EV. At .06 EV the differences between shapes of responses, some 5 levels, move grey values by .2 to .4 levels, as
// much as rounding and interpolation do.
constexpr double kSmallestLightSpread = 0.06;
constexpr double kFewestGreys = 2.0;  // tenths of the grey values: one determines nothing at all

// Scenes of a reconstruction. Variances of a point's colour, levels of 255 squared: after the correction at most half
// of that before, or that of glossy surfaces, 20 levels between two images; and of two visits, between them over
// within.
constexpr double kMuchLessColour = 0.5, kGlossy = 200.0, kVisitRatio = 8.0;

// Held white balances. Levels of 255, and standard errors of a median.
constexpr double kClearLevels = 1.5, kClearBalance = 5.0;

// A prior profile. Standard errors by which held-out pairs are worse with it, and by which it deviates.
constexpr double kClearlyWorse = 3.0, kFarFromPrior = 5.0;

// Seams. Levels of 255; kSeen is comparable to the texture around a seam: gallery 8/0, 6/0, 5/0.
constexpr double kSmallestShare = 0.7;  // of the pairs that agree
constexpr double kLargestRms = 15.0;
constexpr double kSeen = 3.0;
constexpr double kEven = 2.0;      // between pictures that look alike,
constexpr double kOfNoise = 1.5;   // this much above the effect of noise,
constexpr double kMaxNoise = 4.0;  // at most;
constexpr double kUneven = 6.0;    // and between those that do not
constexpr double kGrown = 1.25;    // a seam that is visible, and this many times its size before;
constexpr double kOddLink = 5.0;   // of a link that contradicts the result, and this many times the noise,
constexpr double kOddNoise = 4.0;
constexpr double kMuchLess = 0.5;   // unless it is at most this many times its size before
constexpr double kEvenShare = 0.6;  // of all pairs that agree: with fewer, only part of the picture is even

}  // namespace lensprof
