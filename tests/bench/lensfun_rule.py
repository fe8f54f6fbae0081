"""Lensfun's own rule between its calibrations, in NumPy: the peer of lookup.py.

lfLens::InterpolateVignetting and __vignetting_dist in libs/lensfun/lens.cpp: inverse distance weighting (Shepard) of
the coefficients k1, k2, k3 of all calibrations of one lens, with power 3.5 and
    d^2 = ((f - f_i) / (f_max - f_min))^2 + (4/N - 4/N_i)^2 + (0.1 m/D - 0.1 m/D_i)^2,
focal length f, f-number N, focus distance D. A calibration within 1e-4 is the answer; if all are
farther than 1, Lensfun does not answer. It may take f_max and f_min from the lens's name; here they come from its
calibrations.
"""
import numpy as np

POWER, SAME, FARTHEST = 3.5, 1e-4, 1.0
INFINITY_M = 1000.0  # Lensfun's files use 1000 m for infinity


def near(settings):
    """focal_mm, aperture and distance_m with Lensfun's number for infinity."""
    settings = np.array(settings, float)
    settings[..., 2] = np.minimum(settings[..., 2], INFINITY_M)
    return settings


def predict(settings, coefficients, asked, focal_span_mm):
    """k1, k2, k3 at `asked` (focal_mm, aperture, distance_m) from settings[n, 3] and coefficients[n, 3], or None.
    focal_span_mm: longest minus shortest focal length of the lens."""
    known, at = near(settings), near(asked)
    d = np.sqrt(((known[:, 0] - at[0]) / (focal_span_mm or 1.0)) ** 2 + (4.0 / known[:, 1] - 4.0 / at[1]) ** 2
                + (0.1 / known[:, 2] - 0.1 / at[2]) ** 2)
    if d.min() > FARTHEST:
        return None
    if d.min() < SAME:
        return np.asarray(coefficients, float)[d.argmin()]
    weight = d ** -POWER
    return weight @ np.asarray(coefficients, float) / weight.sum()
