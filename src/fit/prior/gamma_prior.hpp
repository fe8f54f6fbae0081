// The exponent gamma of a response, as measured for its kind of camera.
//
// A response's family f(x^(1/gamma)) is one shape; its position in it (lp_gauge_position) moves by ln gamma. Cameras
// of a kind share it: it is that of the kind's typical response (core/typical_table.c), with the error measured there.
#pragma once

#include <Eigen/Core>

#include <lensprof/fit.h>

namespace lensprof {

// Position of a response table within its family; *slope, if not NULL, receives its derivatives by every EMoR mode.
double gamma_position(const double *table, Eigen::VectorXd *slope = nullptr);

// A response table and the covariance of its EMoR modes, as many as are known.
struct KnownResponse {
    const double *table;
    Eigen::MatrixXd covariance;
};

// Largest difference between the shapes (what all members of a family share) of two responses at four grey values, in
// standard errors that combine those of both and the error of the modes.
double shape_distance(const KnownResponse &a, const KnownResponse &b);

class GammaPrior {
public:
    explicit GammaPrior(uint32_t camera_kind);  // lensprof_camera_kind

    double position() const { return position_; }

    // Standard error of ln gamma for a camera of the kind,
    double sigma() const { return sigma_; }

    // and for a response of this shape. A shape untypical of the kind adds the uncertainty of a camera of any kind.
    double sigma_of(const double *table) const;

    // Distance of the shape (what all members of a family share) from that of the kind's typical response, relative to
    // the spread of measured cameras of the kind: above 1 it is unusual.
    double oddness(const double *table) const;

private:
    using Shape = Eigen::Vector4d;

    double position_, sigma_, of_any_;  // of_any_: standard error for a camera of unknown kind
    Shape shape_;
    Eigen::Matrix4d precision_;
};

}  // namespace lensprof
