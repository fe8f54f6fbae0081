// The limits of verdicts on flat fields, each with what it is derived from: a definition, or an experiment.
//
// Cards: 200 good and 200 bad rendered cards (`tests/bench/run.sh --only cards`, which prints the curve over every
// limit; docs/benchmark-results.md has them). "Cards 4/19, 1/20, 0/20": good ones found / bad ones with a falloff wrong
// by more than 2 % that no other rule finds, at half the limit, at the limit and at twice the limit. Of the bad ones 25
// pass every refusal and 11 every warning as well: one exposure cannot tell a wrong response from a falloff, and one
// card not a lamp in its middle. Limits without such a figure found nothing there: they are for inputs that these cards
// do not have.
#pragma once

namespace lensprof {
namespace flat_limits {

constexpr double kMinCells = 60.0;
constexpr double kSmallestRadius = 0.6, kWholeRadius = 0.9;  // half diagonals: beyond it, k1..k3 extrapolate

// Of the card, white or black in every exposure. Much: cards 0/25, 0/25, 0/25 (white and black, which other rules find
// as well). Some: white 0/11, 0/11, 0/11; black 10/11, 10/11, 10/11, all with a black border.
constexpr double kMuchClipped = 0.2, kSomeClipped = 0.005;

// Of M. Cards 0/10, 0/10, 0/10, of those without a grid. It holds only for falloffs that a polynomial describes: with
// the law of the cosine and a corner below .4, M(1) is wrong by 4 to 21 times its standard error.
constexpr double kLargestCornerSigma = 0.01;

// Of the light. Much: cards 8/21, 0/25, 0/27. Some: 35/11, 8/11, 0/11.
constexpr double kMuchTexture = 0.01, kSomeTexture = 0.005;

// Of the light per half diagonal: its square is about the error of a plane. Not rotated: cards 0/11, 0/16, 0/16, and
// 28/6, 0/6, 0/6 (slant); the good ones reach .08. Rotated: 10/8, 0/9, 0/10; the good ones reach .3.
constexpr double kSteepAlone = 0.2, kSlantAlone = 0.1, kSteepRotated = 0.5;

// Of the light: what an even light leaves of one that slopes. Made cards of 3 and 5 stops: slopes of .16 leave .001 and
// more, falloffs that are up to .06 off centre .0007 at most.
constexpr double kPatternOfSlope = 0.001;

// Of the light. Much: cards 0/25, 0/25, 0/29. Some: 22/11, 7/11, 0/11. With two shots, a changed light or a wrong angle
// can leave a pattern that both show, which counts as not radial.
constexpr double kMuchPerShot = 0.015, kSomePerShot = 0.004;

// Of the light. Some: cards 32/9, 13/10, 0/11. Much: 1/9, 0/10, 0/12; chosen on the other half (--tune). All their
// lenses are radial: the good ones reach .0054.
constexpr double kMuchNotRadial = 0.01, kNotRadial = 0.003;

// EV, within a shot. Wrong: cards 0/25, 0/25, 0/27.
constexpr double kWrongEv = 0.3, kDoubtfulEv = 0.1;

constexpr double kNotPolynomial = 0.01;  // of M: what a corrected picture shows

constexpr double kUncertainEv = 0.02;  // of the corner, by the error of the black level: below what pictures show
constexpr double kClearOffset = 3.0;   // standard errors

constexpr double kSteepest = 0.05, kFlattest = 20.0;  // d ln E / d ln B; of cameras .2 to 10
constexpr double kFewInliers = 0.5;
constexpr double kFarCenter = 0.1;  // half diagonals, as for pairs. Cards 0/10, 0/11, 0/11

}  // namespace flat_limits
}  // namespace lensprof
