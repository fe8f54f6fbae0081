#!/usr/bin/env python3
"""Measures what the falloffs of lenses have in common, by sensor and stops from wide open: the prior on the
falloff.

    make_falloff_prior.py [FOLDER]                 prints src/fit/prior/falloff_prior_table.cpp
    make_falloff_prior.py --leave-out [FOLDER]     how well the prior predicts lenses that it was not made from

FOLDER: the XML files of Lensfun's database (default /usr/share/lensfun/version_1, package liblensfun-data-v1; CC BY-SA
3.0). Only statistics of the data are printed, no row of it. An entry counts if .05 < M <= 1.05 on the whole frame;
others are not falloffs of lenses. A falloff is described by u = ln M at r = .5, .75 and 1 half diagonals, which is one
to one with k1, k2, k3. For each class of sensor size and stops from wide open, the multivariate t distribution with
4 degrees of freedom is fitted by expectation maximisation (Lange, Little & Taylor 1989). All entries of a lens together have the
weight of one lens, so that zooms measured at many settings do not outvote the others.
"""
import collections
import glob
import math
import sys
import xml.etree.ElementTree as ET

import numpy as np

RADII = (0.5, 0.75, 1.0)
FREEDOM = 4.0
SENSORS = (("full frame or larger", 0.0, 1.2), ("smaller sensor", 1.2, 99.0))  # crop factor
STOPS = (("wide open", -0.1, 0.5), ("1 stop", 0.5, 1.5), ("2 stops", 1.5, 2.5), ("3 stops or more", 2.5, 99.0))
CLASSES = [(sensor, stop) for sensor in SENSORS for stop in STOPS]
SMALLEST, LARGEST = 0.05, 1.05
Entry = collections.namedtuple("Entry", "lens crop_factor focal aperture u")


def entries_of(folder):
    entries = []
    grid = np.linspace(0.02, 1.0, 50)
    for file in sorted(glob.glob(folder + "/*.xml")):
        for number, lens in enumerate(ET.parse(file).getroot().iter("lens")):
            crop_factor = float(lens.findtext("cropfactor", "1"))
            for row in lens.iter("vignetting"):
                if row.get("model") != "pa":
                    continue
                k = [float(row.get("k%d" % n) or 0.0) for n in (1, 2, 3)]
                falloff = lambda r: 1.0 + k[0] * r**2 + k[1] * r**4 + k[2] * r**6
                if not (falloff(grid) > SMALLEST).all() or not (falloff(grid) <= LARGEST).all():
                    continue
                u = [math.log(falloff(r)) for r in RADII]
                entries.append(Entry((file, number), crop_factor, float(row.get("focal")), float(row.get("aperture")), u))
    return entries


def stops_of(entries):
    """Stops of each entry from the widest aperture measured at its focal length."""
    widest = {}
    for e in entries:
        key = (e.lens, e.focal)
        widest[key] = min(e.aperture, widest.get(key, math.inf))
    return np.array([2.0 * math.log2(e.aperture / widest[e.lens, e.focal]) for e in entries])


def t_distribution(u, weight):
    """Location and scatter of the t distribution that fits weighted rows best."""
    mean, scatter = np.average(u, axis=0, weights=weight), np.cov(u.T, aweights=weight)
    for _ in range(200):
        off = u - mean
        distance2 = np.einsum("ni,ij,nj->n", off, np.linalg.inv(scatter), off)
        trust = weight * (FREEDOM + u.shape[1]) / (FREEDOM + distance2)
        mean = (trust[:, None] * u).sum(0) / trust.sum()
        off = u - mean
        scatter = (trust[:, None] * off).T @ off / weight.sum()
    return mean, scatter


def members(entries, of_class):
    """The entries of a class, and their weights."""
    (_, smallest, largest), (_, low, high) = of_class
    chosen = [e for e, s in zip(entries, stops_of(entries)) if smallest <= e.crop_factor < largest and low <= s < high]
    count = collections.Counter(e.lens for e in chosen)
    return chosen, np.array([1.0 / count[e.lens] for e in chosen])


def print_table(entries):
    print("// Made by profiles/tools/make_falloff_prior.py of %d entries; do not edit.\n"
          "// Statistics of Lensfun's lens data (CC BY-SA 3.0, see NOTICE).\n"
          '#include "fit/prior/falloff_prior.hpp"\n\nnamespace lensprof {\n' % len(entries))
    print("const FalloffClass kFalloffClasses[kSensorClassCount][kStopClassCount] = {")
    for sensor in SENSORS:
        print("    {")
        for stop in STOPS:
            chosen, weight = members(entries, (sensor, stop))
            mean, scatter = t_distribution(np.array([e.u for e in chosen]), weight)
            print("        // %s, %s: %d entries; M(1) at the mean %.3f" % (
                sensor[0], stop[0], len(chosen), math.exp(mean[2])))
            print("        {{%.4f, %.4f, %.4f}," % tuple(mean))
            print("         {{%.6f, %.6f, %.6f}, {%.6f, %.6f, %.6f}, {%.6f, %.6f, %.6f}}}," % tuple(scatter.ravel()))
        print("    },")
    print("};\n\n}  // namespace lensprof")


def leave_out(entries):
    """Each lens predicted by a prior made without its fifth of the lenses."""
    fold = {lens: n % 5 for n, lens in enumerate(sorted({e.lens for e in entries}))}
    print("| sensor, stops | entries | M(1): within 1 | within 2 | all radii: median of distance²/3 | within 95 % |")
    print("|---|---|---|---|---|---|")
    for of_class in CLASSES:
        chosen, all_weights = members(entries, of_class)
        corner, shape, weights = [], [], []
        for f in range(5):
            is_tested = np.array([fold[e.lens] == f for e in chosen])
            u = np.array([e.u for e in chosen])
            mean, scatter = t_distribution(u[~is_tested], all_weights[~is_tested])
            off = u[is_tested] - mean
            corner.extend(abs(off[:, 2]) / math.sqrt(scatter[2, 2]))
            shape.extend(np.einsum("ni,ij,nj->n", off, np.linalg.inv(scatter), off) / 3.0)
            weights.extend(all_weights[is_tested])
        share = lambda values, limit: 100.0 * np.average(np.array(values) < limit, weights=weights)
        print("| %s, %s | %d | %.0f %% | %.0f %% | %.2f | %.0f %% |" % (
            of_class[0][0], of_class[1][0], len(corner), share(corner, 1.0), share(corner, 2.0), np.median(shape),
            share(shape, 6.591)))


arguments = [word for word in sys.argv[1:] if word != "--leave-out"]
data = entries_of(arguments[0] if arguments else "/usr/share/lensfun/version_1")
if not data:
    sys.exit("no falloffs found; install liblensfun-data-v1, or give the folder of Lensfun's XML files")
leave_out(data) if "--leave-out" in sys.argv else print_table(data)
