// The light predicted for a cell, and its derivatives (Goldman & Chen 2005, equation 14):
//     P = t L0 M(r) = exp(level + light . basis(q)) M(r)
// q is the cell's position rotated into the scene, in half diagonals from the frame's centre. M has one of two forms:
//     powers      M = 1 + k1 r^2 + k2 r^4 + k3 r^6, that of a profile
//     logarithm   ln M = l1 u + l2 u^2 + ... + l6 u^6, u = r^2 / (1 + r^2): above 0 for any l, and close to both the
//                 law of the cosine and exp(-r^2) for six stops in the corner
#pragma once

#include <array>
#include <limits>

#include <Eigen/Core>

#include "fit/flat/shots.hpp"

namespace lensprof {

constexpr int kMaxLightTerms = 4;  // x, y, x^2 - y^2, 2 x y
constexpr int kPowers = 3, kLogTerms = 6, kMaxFalloffTerms = 6;

enum class FalloffForm {
    powers,
    logarithm
};

// M at one r^2, its derivative by r^2, and the derivatives of both by the terms.
struct FalloffAt {
    double value, slope;
    std::array<double, kMaxFalloffTerms> by_term, slope_by_term;
};

// Layout of the vector of unknowns: curves, centre, levels, light.
struct FlatModel {
    CellGrid grid;
    int channels = 3, curves = 1, shots = 1;
    int light_terms = 2;
    bool own_light = false, several = false;
    FalloffForm form = FalloffForm::powers;
    // r^2 at which the data end: from there on, ln M continues with its last slope up to `held`, and stays constant.
    double reach = std::numeric_limits<double>::infinity(), held = std::numeric_limits<double>::infinity();
    std::vector<std::array<double, 2>> turn;  // per shot: cosine and sine

    int terms() const { return form == FalloffForm::powers ? kPowers : kLogTerms; }
    int k(int curve) const { return terms() * curve; }
    int center() const { return terms() * curves; }
    int levels() const { return center() + 2; }
    // The level of a shot is level(channel) alone; with `several`, the error of its exposure is added.
    int level(int shot, int channel) const { return levels() + (several ? 0 : shot * channels) + channel; }
    int exposure_error(int shot) const { return levels() + channels + shot; }
    int light(int shot, int channel) const {
        int first = levels() + (several ? channels + shots : shots * channels);
        return first + ((own_light ? shot : 0) * channels + channel) * light_terms;
    }
    int unknowns() const { return light(own_light ? shots - 1 : 0, channels - 1) + light_terms; }
    int curve_of(int channel) const { return curves == 3 ? channel : 0; }

    // The number of angles at which shots differ enough to separate light from lens.
    size_t angles() const;
};

// The centre, and k1..k3 if the form has them, 0 otherwise.
lensprof_vignetting falloff_of(const FlatModel &model, const Eigen::VectorXd &u, int curve);
void set_falloff(const FlatModel &model, const lensprof_vignetting &vignetting, Eigen::VectorXd &u);

// What a form is a polynomial of, and its derivative by r^2.
double power_base(FalloffForm form, double r2, double *slope);

// M within the data, and continued beyond them.
double falloff_value(const FlatModel &model, const Eigen::VectorXd &u, int curve, double r2);
FalloffAt falloff_at(const FlatModel &model, const Eigen::VectorXd &u, int curve, double r2);
FalloffAt continued_falloff(const FlatModel &model, const Eigen::VectorXd &u, int curve, double r2);

// The light of a channel with its derivatives by the unknowns it depends on, which are the same everywhere in a shot.
struct Prediction {
    static constexpr int kMaxEntries = kMaxFalloffTerms + 2 + 2 + kMaxLightTerms;
    double value = 0.0;
    int count = 0;
    std::array<int, kMaxEntries> index;
    std::array<double, kMaxEntries> derivative;

    void add(int i, double slope) {
        index[static_cast<size_t>(count)] = i;
        derivative[static_cast<size_t>(count++)] = slope;
    }
};

// The light that some unknowns predict for the channels at a place in a shot. Both arguments must outlive it.
class FlatLight {
public:
    FlatLight(const FlatModel &model, const Eigen::VectorXd &u);

    std::array<double, 3> at(int shot, double x, double y) const;
    std::array<Prediction, 3> with_derivatives(int shot, double x, double y) const;

private:
    struct Place;
    Place place_of(int shot, double x, double y) const;
    double without_falloff(int shot, int channel, const Place &place) const;

    const FlatModel &model_;
    const Eigen::VectorXd &u_;
    lensprof_vignetting about_center_;
    std::vector<double> even_;  // the same everywhere: per shot and channel
};

// Slope of the logarithm of the light in a shot's frame, to the right and down, per half diagonal: mean of the
// channels.
std::array<double, 2> light_gradient(const FlatModel &model, const Eigen::VectorXd &u, int shot);

}  // namespace lensprof
