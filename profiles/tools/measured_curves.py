"""Measured response curves, as the tools here read them, and the place of a curve within its family.

dorfCurves.txt: the Database of Response Functions (Grossberg & Nayar, Columbia University), six lines a curve (name, kind,
"I =", 1024 irradiances, "B =", 1024 grey values). Curves 0 to 153 are scanned film, 172 to 200 digital and video cameras.

modern_cameras.csv: one row a curve of a digital camera or phone: name, maker, model, kind (camera, phone: measured by
exposure brackets; converter: a raw converter's curve that imitates a camera), source and more, then i0 ... i255, the
irradiance at 256 grey levels, 1 at white.

Neither file is part of lensprof; the tools here print statistics of them.
"""
import csv
import re

import numpy as np

SAMPLES = 1024
DARK, BRIGHT = 48 / 255, 208 / 255  # the gauge's grey values: kGaugeDark, kGaugeBright in src/fit/prior/gamma_prior.hpp
x = np.linspace(0, 1, SAMPLES)


class Curve:
    """Of one camera or film: f on the uniform grid of irradiance; curves of one `group` are left out together."""

    def __init__(self, name, maker, kind, group, f):
        self.name, self.maker, self.kind, self.group = name, maker, kind, group
        self.f = np.maximum.accumulate(f)

    def irradiance(self, grey):
        return np.interp(grey, self.f + 1e-9 * x, x)

    def position(self):
        """ln gamma of the curve within its family f(x^(1/gamma)): q = ln ln(I(208) / I(48))."""
        return np.log(np.log(self.irradiance(BRIGHT) / self.irradiance(DARK)))

    def moved(self, position):
        """f of the member of the family at this position."""
        gamma = np.exp(position - self.position())
        return np.interp(x ** (1 / gamma), x, self.f)


def dorf(path):
    lines = [line.strip() for line in open(path) if line.strip()]
    names = [lines[i] for i in range(0, len(lines), 6)]
    curves = np.array([[float(word) for word in lines[i + 5].split()] for i in range(0, len(lines), 6)])
    label = [re.sub("(Red|Green|Blue)$", "", n) if not re.match("curve", n) else "unnamed%d" % (i // 3)
             for i, n in enumerate(names)]
    for i in range(len(curves)):  # duplicates belong to the group of the first
        for j in range(i):
            if np.abs(curves[i] - curves[j]).max() < 1e-6:
                label = [label[j] if name == label[i] else name for name in label]
    kind = ["film" if i < 154 else "plain" if i < 172 else "digital" for i in range(len(curves))]
    return [Curve(n, "DoRF", k, g, f) for n, k, g, f in zip(names, kind, label, curves)]


def white_of(irradiance):
    """Where the line through the levels 245 to 252 reaches 255: white as the measured curves have it."""
    return np.polyval(np.polyfit(np.arange(245, 253), irradiance[245:253], 1), 255)


def modern(path):
    """Measured cameras and phones, and converter curves of one camera; not those that a maker's cameras share, which are
    drawn by hand."""
    rows = [row for row in csv.reader(line for line in open(path) if not line.startswith("#"))]
    first = rows[0].index("i0")
    curves = []
    for row in rows[1:]:
        of = dict(zip(rows[0], row))
        if "drawn by hand" in of["source"]:
            continue
        irradiance = np.maximum.accumulate(np.array([float(word) for word in row[first:]]))
        if of["kind"] == "converter":
            irradiance = np.minimum(irradiance / white_of(irradiance), 1.0)
        rises = np.r_[True, np.diff(irradiance) > 1e-12]
        f = np.interp(x, irradiance[rises], (np.arange(256) / 255)[rises])
        f[-1] = 1.0
        model = re.sub(r"^(EOS) (\d+D) .*like.*", r"\1", of["model"])
        curves.append(Curve(of["name"], of["maker"], of["kind"], of["maker"] + " " + model, f))
    return curves


def plain():
    """Curves that are none of a camera: linear, powers, sRGB and Rec. 709."""
    powers = [Curve("gamma %g" % g, "", "plain", "gamma %g" % g, x ** (1 / g)) for g in (1.0, 1.8, 2.0, 2.2, 2.4, 2.6)]
    srgb = np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.maximum(x, 1e-9) ** (1 / 2.4) - 0.055)
    rec709 = np.where(x < 0.018, 4.5 * x, 1.099 * np.maximum(x, 1e-9) ** 0.45 - 0.099)
    return powers + [Curve("sRGB", "", "plain", "sRGB", srgb), Curve("Rec. 709", "", "plain", "Rec. 709", rec709)]


def emor(path):
    """Mean and modes of the empirical model of response, 1 + 25 rows of 1024 samples (see make_emor_table.py)."""
    rows = []
    for line in open(path):
        if re.match(r"\s*(f0|h\(\s*\d+\))\s*=", line):
            rows.append([])
        elif line.strip():
            rows[-1] += [float(word) for word in line.split()]
    return np.array(rows)
