// The exponent gamma that a response has by measure of its camera's kind.
//
// A response's family f(x^(1/gamma)) is one shape; its position in it (lp_gauge_position) moves by ln gamma. Cameras of
// a kind have it in common: it is that of the kind's typical response (core/typical_table.c), with the error that was
// measured there.
#pragma once

#include <Eigen/Core>

#include <lensprof/fit.h>

namespace lensprof {

// Position of a response table within its family; *slope, when not NULL, receives its change with every EMoR mode.
double gamma_position(const double *table, Eigen::VectorXd *slope = nullptr);

// A response table and the covariance of its EMoR modes, as many as it has.
struct KnownResponse {
    const double *table;
    Eigen::MatrixXd covariance;
};

// Largest difference of two responses' shapes - what all members of a family share - at four grey values, in standard
// errors of both together and of what modes leave.
double shape_distance(const KnownResponse &a, const KnownResponse &b);

class GammaPrior {
public:
    explicit GammaPrior(uint32_t camera_kind);  // lensprof_camera_kind

    double position() const { return position_; }

    // Standard error of ln gamma for a camera of the kind,
    double sigma() const { return sigma_; }

    // and for a response of this shape: one that is none of the kind's is as uncertain as any camera's besides.
    double sigma_of(const double *table) const;

    // How far the shape - what all members of a family share - is from that of the kind's typical response, relative to
    // what measured cameras of the kind keep: beyond 1 it is unusual.
    double oddness(const double *table) const;

private:
    using Shape = Eigen::Vector4d;

    double position_, sigma_, of_any_;  // of_any_: standard error for a camera of which nothing is known
    Shape shape_;
    Eigen::Matrix4d precision_;
};

}  // namespace lensprof
