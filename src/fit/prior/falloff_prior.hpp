// What the falloffs of lenses have in common, as the prior of a falloff that pictures leave open.
//
// A falloff is described by u = ln M at three radii, which are one to one with k1, k2, k3. Over measured lenses u has a
// distribution per class of sensor size and stops from wide open, with heavy tails (multivariate t), and pictures that
// the camera corrected have u near 0. A fit uses the normal distribution with the mean and scatter of this mixture,
// whose components are weighted by how well they predict what the pictures show (empirical Bayes).
#pragma once

#include <Eigen/Core>

#include <lensprof/profile.h>

namespace lensprof {

// Location and scatter of u over measured lenses (profiles/tools/make_falloff_prior.py): a t distribution with
// kFalloffFreedom degrees of freedom.
struct FalloffClass {
    double mean[3], scatter[3][3];
};
constexpr int kSensorClassCount = 2;  // full frame and larger, smaller
constexpr int kStopClassCount = 4;    // wide open, one stop down, two, three or more
constexpr double kFalloffFreedom = 4.0;
extern const FalloffClass kFalloffClasses[kSensorClassCount][kStopClassCount];

// What is known of a lens that has no profile; LENSPROF_UNKNOWN: all classes count equally.
struct LensFacts {
    double stops = LENSPROF_UNKNOWN, crop_factor = LENSPROF_UNKNOWN;  // stops: from wide open
};

// u of a falloff, and its derivatives by k1, k2, k3; `slope` may be NULL. M is taken as at least .001.
Eigen::Vector3d log_falloff(const double k[3], Eigen::Matrix3d *slope);

// A normal distribution of u.
struct FalloffPrior {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d precision = Eigen::Matrix3d::Zero();  // zero: nothing is known
};

// Before any picture.
FalloffPrior expected_falloff(const LensFacts &lens);

// What pictures alone show of a falloff, in information form: their precision of u, and that times u.
struct ShownFalloff {
    Eigen::Matrix3d precision;
    Eigen::Vector3d weighted;
};

// The prior once pictures were seen. Classes that predict them poorly lose their weight, and so does the whole if
// none predicts them; distance: between pictures and prior, in combined standard errors.
FalloffPrior falloff_given(const ShownFalloff &shown, const LensFacts &lens, double &distance);

}  // namespace lensprof
