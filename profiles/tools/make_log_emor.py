#!/usr/bin/env python3
"""Makes the basis of the logarithm of inverse responses that the method `transfer-function` fits.

    make_log_emor.py dorfCurves.txt > src/fit/methods/transfer_function/log_emor_table.cpp          (needs numpy)

Kim & Pollefeys 2004, section 2.3: principal components of g(I) = ln f^-1(I) over the curves of the Database of Response
Functions (Grossberg & Nayar, Columbia University), at the grey levels 1..255 of 255: at level 0 every logarithm is minus
infinity, and it is left out. The curves themselves are not part of lensprof. Also printed, to standard error: the
share of the variance that the first modes explain (figure 4).
"""
import sys

import numpy as np

SAMPLES, LEVELS, MODES = 1024, 255, 25


def log_inverse(curve):
    """ln of the smallest x with f(x) >= I / 255, for I = 1..255."""
    grey = np.arange(1, LEVELS + 1) / LEVELS
    j = np.searchsorted(curve, grey, side="left")  # the first sample that is not below
    low, high = curve[j - 1], curve[j]
    return np.log((j - 1 + (grey - low) / (high - low)) / (SAMPLES - 1))


lines = [line.strip() for line in open(sys.argv[1]) if line.strip()]
curves = [np.array([float(word) for word in lines[i + 5].split()]) for i in range(0, len(lines), 6)]
if any(len(curve) != SAMPLES for curve in curves):
    sys.exit("%s: every curve must have %d samples" % (sys.argv[1], SAMPLES))

g = np.array([log_inverse(curve) for curve in curves])
mean = g.mean(0)
_, scale, modes = np.linalg.svd(g - mean, full_matrices=False)
modes *= np.sign(modes.sum(1))[:, None]
share = np.cumsum(scale ** 2) / np.sum(scale ** 2)
sys.stderr.write("share of the variance in the first 1..15 modes: %s\n" % " ".join("%.5f" % s for s in share[:15]))


def rows(values):
    for i in range(0, len(values), 8):
        print("        " + " ".join("%.9e," % v for v in values[i:i + 8]))


print("""// Made by profiles/tools/make_log_emor.py from dorfCurves.txt; do not edit.
// Principal components of ln f^-1 over the Database of Response Functions; see NOTICE.
#include "fit/methods/transfer_function/log_inverse.hpp"

namespace lensprof {

// Row 0 is the mean, row n is mode n, at the grey levels 1..255.
const double kLogEmor[1 + kLogModes][kLogLevels] = {""")
for curve in [mean, *modes[:MODES]]:
    print("    {")
    rows(curve)
    print("    },")
print("};\n\n// Standard deviation of each mode's coefficient over the database; what all modes together vary by, squared.")
print("const double kLogEmorSigma[kLogModes] = {")
rows(scale[:MODES] / np.sqrt(len(g)))
print("};\nconst double kLogEmorVariance = %.9e;\n\n}  // namespace lensprof" % (np.sum(scale ** 2) / len(g)))
