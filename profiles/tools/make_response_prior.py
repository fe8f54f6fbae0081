#!/usr/bin/env python3
"""Measures the prior on EMoR coefficients over measured response curves: root mean squares about the model's mean, and
correlations.

    make_response_prior.py emor.txt dorfCurves.txt

emor.txt: see make_emor_table.py. dorfCurves.txt: the Database of Response Functions (Grossberg & Nayar, Columbia University),
six lines a curve (name, kind, "I =", 1024 irradiances, "B =", 1024 grey values). The curves themselves are not part of
lensprof; of the numbers printed here the first 25 are kEmorSigma in src/fit/prior/prior.cpp, the others, of all pairs of modes
below the diagonal, kEmorCorrelation in src/fit/prior/response_prior_table.cpp.
"""
import re
import sys

SAMPLES = 1024

modes = []
for line in open(sys.argv[1]):
    if re.match(r"\s*(f0|h\(\d+\))\s*=", line):
        modes.append([])
    elif line.strip():
        modes[-1] += [float(word) for word in line.split()]
mean, modes = modes[0], modes[1:]

lines = [line.strip() for line in open(sys.argv[2]) if line.strip()]
curves = [[float(word) for word in lines[i + 5].split()] for i in range(0, len(lines), 6)]
if any(len(curve) != SAMPLES for curve in curves):
    sys.exit("%s: every curve must have %d samples" % (sys.argv[2], SAMPLES))

# The modes are orthonormal on the grid: a coefficient is a product with its mode.
coefficients = [[sum(h * (b - m) for h, b, m in zip(mode, curve, mean)) for curve in curves] for mode in modes]
sigma = [(sum(a * a for a in of_mode) / len(curves)) ** 0.5 for of_mode in coefficients]
for value in sigma:
    print("%.4g" % value)
print()
for l in range(len(modes)):
    for m in range(l):
        product = sum(a * b for a, b in zip(coefficients[l], coefficients[m])) / len(curves)
        print("%.3f" % (product / (sigma[l] * sigma[m])), end=", " if m < l - 1 else ",\n")
