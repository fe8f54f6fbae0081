#!/usr/bin/env python3
"""Measures how the exponent gamma of a camera follows from the shape of its response.

    make_gamma_prior.py dorfCurves.txt > src/fit/prior/gamma_prior_table.hpp          (needs numpy)

Pictures leave a common exponent of response, falloff and exposures open, but not the response's shape, by which we mean
what all members of the family f(x^(1/gamma)) share. Every curve of the Database of Response Functions (Grossberg &
Nayar, Columbia University) is brought to the member with f(0.08) = 0.35; the exponent that did it, and the curve's
values there at 0.02, 0.04 and 0.75, are its position and its shape. A quadratic of the whitened shape predicts the
position (robust ridge regression). Its error is measured by leaving out each camera or film with all its channels and
duplicates. The curves themselves are not part of lensprof. Also printed, to standard error: that error.
"""
import re
import sys

import numpy as np

GREY, IRRADIANCE, POINTS = 0.35, 0.08, (0.02, 0.04, 0.75)  # GREY: kGaugeGrey in gamma_prior.hpp
LARGEST = 3.0  # standard deviations of the shape; farther shapes count as that far
KINDS = [("any", range(0, 201), True), ("film", range(0, 154), True), ("digital", range(172, 201), False)]
x = np.linspace(0, 1, 1024)


def read(path):
    lines = [line.strip() for line in open(path) if line.strip()]
    names = [lines[i] for i in range(0, len(lines), 6)]
    return names, np.array([[float(w) for w in lines[i + 5].split()] for i in range(0, len(lines), 6)])


def groups(names, curves):
    """Numbers that are equal for the channels of one film or camera, and for duplicates."""
    label = [re.sub("(Red|Green|Blue)$", "", n) if not re.match("curve", n) else "unnamed%d" % (i // 3)
             for i, n in enumerate(names)]
    group = np.unique(label, return_inverse=True)[1]
    for i in range(len(curves)):
        for j in range(i):
            if np.abs(curves[i] - curves[j]).max() < 1e-6:
                group[group == group[i]] = group[j]
    return group


def position_and_shape(curve):
    curve = np.maximum.accumulate(curve) + 1e-9 * x
    exponent = np.log(np.interp(GREY, curve, x)) / np.log(IRRADIANCE)
    return np.log(exponent), np.interp(np.array(POINTS) ** exponent, x, curve)


def terms(shape, mean, whiten):
    z = (shape - mean) @ whiten.T
    z *= np.minimum(1.0, LARGEST / np.maximum(np.linalg.norm(z, axis=1), 1e-12))[:, None]
    pairs = [z[:, a] * z[:, b] for a in range(3) for b in range(a + 1)]
    return np.column_stack([np.ones(len(z)), z] + pairs)


def regress(shape, position, quadratic):
    mean = shape.mean(0)
    whiten = np.linalg.inv(np.linalg.cholesky(np.cov(shape.T)))
    if not quadratic:  # too few curves for more than a constant
        return mean, whiten, np.r_[np.median(position), np.zeros(9)]
    a, weight = terms(shape, mean, whiten), np.ones(len(shape))
    ridge = np.eye(10)
    ridge[0, 0] = 0.0
    for _ in range(25):
        beta = np.linalg.solve((a * weight[:, None]).T @ a + ridge, (a * weight[:, None]).T @ position)
        weight = 1.0 / np.maximum(1.0, np.abs(position - a @ beta) / 0.1)
    return mean, whiten, beta


def left_out_error(rows, shape, position, group, quadratic):
    error = np.zeros(len(rows))
    for g in set(group[rows]):
        test = group[rows] == g
        mean, whiten, beta = regress(shape[rows][~test], position[rows][~test], quadratic)
        error[test] = position[rows][test] - terms(shape[rows][test], mean, whiten) @ beta
    return np.abs(error)


def numbers(values):
    return ", ".join("%.5g" % v for v in np.ravel(values))


names, curves = read(sys.argv[1])
group = groups(names, curves)
position, shape = map(np.array, zip(*[position_and_shape(c) for c in curves]))
print("// Made by profiles/tools/make_gamma_prior.py; do not edit.\n#pragma once\n")
print("#include \"fit/prior/gamma_prior.hpp\"\n\nnamespace lensprof {\n")
print("constexpr double kGaugeIrradiance = %g, kShapePoints[3] = {%s}, kLargestShape = %g;\n"
      % (IRRADIANCE, numbers(POINTS), LARGEST))
print("// By lensprof_camera_kind.\nconstexpr GammaPrior kGammaPriors[3] = {")
for name, rows, quadratic in KINDS:
    rows = np.array(rows)
    mean, whiten, beta = regress(shape[rows], position[rows], quadratic)
    error = left_out_error(rows, shape, position, group, quadratic)
    sigma = np.quantile(error, 0.6827)
    sys.stderr.write("%s: %d curves, left out: median |ln gamma| %.3f, 68 %% %.3f, rms %.3f\n"
                     % (name, len(rows), np.median(error), sigma, np.sqrt((error ** 2).mean())))
    print("    {%.3f,\n     {%s},\n     {{%s}, {%s}, {%s}},\n     {%s}},"
          % (sigma, numbers(mean), *map(numbers, whiten), numbers(beta)))
print("};\n\n}  // namespace lensprof")
