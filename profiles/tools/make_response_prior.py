#!/usr/bin/env python3
"""Measures the prior on EMoR coefficients: their root mean square over measured response curves, about the model's mean.

    make_response_prior.py emor.txt dorfCurves.txt

emor.txt: see make_emor_table.py. dorfCurves.txt: the Database of Response Functions (Grossberg & Nayar, Columbia University),
six lines a curve (name, kind, "I =", 1024 irradiances, "B =", 1024 grey values). The curves themselves are not part of
lensprof; the 25 numbers printed here are kEmorSigma in src/fit/prior.cpp.
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

for mode in modes:  # the modes are orthonormal on the grid
    squares = [sum(h * (b - m) for h, b, m in zip(mode, curve, mean)) ** 2 for curve in curves]
    print("%.4g" % (sum(squares) / len(squares)) ** 0.5)
