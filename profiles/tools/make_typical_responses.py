#!/usr/bin/env python3
"""Makes the typical responses of the kinds of cameras: mean, covariance and error of ln gamma, in EMoR coefficients.

    make_typical_responses.py emor.txt dorfCurves.txt modern_cameras.csv > src/core/typical_table.c      (needs numpy)

The files are described in measured_curves.py. Every curve is moved along its family f(x^(1/gamma)) to the middle position
of its kind; the mean there, every camera or film with one vote, is the typical response, and the scatter about it that of the
shape (white's place included). Scatter of few cameras leaves directions without any: a fifth of it is taken as
independent from mode to mode. Phones, too few to have a scatter of their own, have that of cameras and phones together.
The error of ln gamma is what the position of a left-out camera differs from the middle of the others: 68 % of fifteen and more
curves are nearer, of fewer the root mean square times Student's factor. It enters the covariance along the family's direction.
"Any" is the mixture of camera, phone, digital, film and plain curves in equal parts; of its errors the farthest plain
curve is at most 1.95 away, so that a fit, which adds a little, stays within two. Also printed, to standard error: the positions, left-out errors by kind and maker, and how
well 25 modes follow the curves.
"""
import sys

import numpy as np

import measured_curves as measured
from measured_curves import x

MODES = 25
INDEPENDENT = 0.2  # share of the scatter
REACH = 1.95       # standard errors
FLOOR = 2e-4       # standard deviation of a coefficient, at least
KINDS = ("any", "film", "digital", "camera", "phone")  # in the order of lensprof_camera_kind
STUDENT_68 = {3: 1.20, 4: 1.14}  # by degrees of freedom

base = measured.emor(sys.argv[1])
mean_curve, modes = base[0], base[1:]


def project(f):
    return modes @ (f - mean_curve)


def tabled(coefficients):
    f = mean_curve + coefficients @ modes
    f[0], f[-1] = 0.0, 1.0
    return f


def by_group(curves):
    groups = {}
    for curve in curves:
        groups.setdefault(curve.group, []).append(curve)
    return groups


def middle_position(curves):
    """The median: of film and of old digital cameras some lie far away."""
    return np.median([c.position() for c in curves])


def left_out(curves):
    """Position of every curve less the middle one of the others."""
    return np.array([c.position() - middle_position([o for o in curves if o.group != c.group]) for c in curves])


def error_of(curves):
    error = np.abs(left_out(curves))
    if len(curves) >= 15:
        return np.quantile(error, 0.6827)
    return STUDENT_68[len(by_group(curves)) - 1] * np.sqrt(np.mean(error ** 2))


class Kind:
    """Coefficients at position q, covariance of the shape there, error of q."""

    def __init__(self, curves):
        self.q, self.sigma = middle_position(curves), error_of(curves)
        self.groups = [np.mean([project(c.moved(self.q)) for c in of], axis=0) for of in by_group(curves).values()]
        self.mean = at_position(np.mean(self.groups, axis=0), self.q)
        self.off = np.array(self.groups) - np.mean(self.groups, axis=0)
        self.scatter = self.off.T @ self.off / (len(self.groups) - 1)


def curve_of(coefficients):
    return measured.Curve("", "", "", "", tabled(coefficients))


def at_position(coefficients, position):
    """A mean of curves at one position is not quite there, nor is what is projected on the modes."""
    for _ in range(4):
        curve = curve_of(coefficients)
        coefficients = coefficients + project(curve.moved(position)) - project(curve.f)
    return coefficients


def direction(mean):
    """Change of the coefficients with ln gamma, by which the position moves by one."""
    h, curve = 0.02, curve_of(mean)
    q = curve.position()
    step = project(curve.moved(q + h)) - project(curve.moved(q - h))
    return step / (curve_of(mean + 0.5 * step).position() - curve_of(mean - 0.5 * step).position())


def mixture(kinds, farthest):
    any_ = Kind.__new__(Kind)
    any_.q = np.mean([k.q for k in kinds])
    means = [project(curve_of(k.mean).moved(any_.q)) for k in kinds]
    any_.mean = at_position(np.mean(means, axis=0), any_.q)
    any_.scatter = np.mean([k.scatter + np.outer(m - any_.mean, m - any_.mean) for k, m in zip(kinds, means)], axis=0)
    spread = np.sqrt(np.mean([k.sigma ** 2 + (k.q - any_.q) ** 2 for k in kinds]))
    any_.sigma = max(spread, max(abs(c.position() - any_.q) for c in farthest) / REACH)
    return any_


def covariance(kind):
    own = np.diag(np.diag(kind.scatter)) + FLOOR ** 2 * np.eye(MODES)
    scatter = (1 - INDEPENDENT) * kind.scatter + INDEPENDENT * own
    d = direction(kind.mean)
    dark, bright = (curve_of(kind.mean).irradiance(b) for b in (measured.DARK, measured.BRIGHT))
    f = tabled(kind.mean)
    slope = np.zeros(MODES)  # of the position, by coefficient
    for at, sign in ((bright, 1), (dark, -1)):
        h = np.array([np.interp(at, x, mode) for mode in modes])
        rise = np.interp(at + 1e-3, x, f) - np.interp(at - 1e-3, x, f)
        slope -= sign * h * 2e-3 / rise / at / np.log(bright / dark)
    keep = np.eye(MODES) - np.outer(d, slope) / (slope @ d)  # takes out what moves the position
    return keep @ scatter @ keep.T + (kind.sigma / (slope @ d)) ** 2 * np.outer(d, d) + FLOOR ** 2 * np.eye(MODES)


def report(name, curves):
    error = left_out(curves)
    groups = by_group(curves)
    sys.stderr.write("%s: %d curves of %d, position %.3f, rms %.3f; left out: median %.3f, 68 %% %.3f, rms %.3f\n"
                     % (name, len(curves), len(groups), middle_position(curves), np.std([c.position() for c in curves]),
                        np.median(np.abs(error)), np.quantile(np.abs(error), 0.6827), np.sqrt(np.mean(error ** 2))))
    for maker in sorted({c.maker for c in curves}):
        own = error[[c.maker == maker for c in curves]]
        sys.stderr.write("    %-10s %3d curves, off by %+.3f on average, rms %.3f\n"
                         % (maker, len(own), own.mean(), np.sqrt(np.mean(own ** 2))))


def follow(curves):
    """How far 25 modes stay from the curves, levels of 255 at the grey levels 8 to 250."""
    level = np.arange(8, 251)
    for c in curves:
        off = 255 * np.interp(c.irradiance(level / 255), x, tabled(project(c.f))) - level
        sys.stderr.write("    %-34s %.2f rms, %.2f at most\n" % (c.name, np.sqrt(np.mean(off ** 2)), np.abs(off).max()))


def numbers(values):
    words = ["%.5g" % v for v in values]
    rows, row = [], ""
    for word in words:
        if len(row) + len(word) > 104:
            rows.append(row.rstrip())
            row = ""
        row += word + ", "
    return "\n      ".join(rows + [row]).rstrip(", ")


dorf, modern = measured.dorf(sys.argv[2]), measured.modern(sys.argv[3])
of = {"film": [c for c in dorf if c.kind == "film"], "digital": [c for c in dorf if c.kind == "digital"],
      "camera": [c for c in modern if c.kind in ("camera", "converter")],
      "phone": [c for c in modern if c.kind == "phone"], "plain": measured.plain()}
for name, curves in of.items():
    if name != "plain":
        report(name, curves)
sys.stderr.write("25 modes, levels:\n")
follow(modern)
kinds = {name: Kind(curves) for name, curves in of.items() if name != "plain"}
both = np.concatenate([kinds["camera"].off, kinds["phone"].off])
kinds["phone"].scatter = both.T @ both / (len(both) - 2)
plain = Kind.__new__(Kind)
plain.q = np.mean([c.position() for c in of["plain"]])
plain.sigma = np.std([c.position() for c in of["plain"]])
moved = np.array([project(c.moved(plain.q)) for c in of["plain"]])
plain.mean = moved.mean(axis=0)
plain.scatter = np.cov(moved.T)
kinds["any"] = mixture([kinds["camera"], kinds["phone"], kinds["digital"], kinds["film"], plain], of["plain"])

print("""/* Made by profiles/tools/make_typical_responses.py; do not edit. */
#include "core/typical.h"

const lp_typical lp_typical_responses[LP_TYPICAL_KINDS] = {""")
for name in KINDS:
    kind = kinds[name]
    c = covariance(kind)
    f = tabled(np.array([float("%.5g" % v) for v in kind.mean]))
    if np.diff(f).min() < 0 or np.linalg.eigvalsh(c / np.sqrt(np.outer(np.diag(c), np.diag(c)))).min() < 1e-4:
        sys.exit("%s: the mean falls (%g), or the covariance is none" % (name, np.diff(f).min()))
    sys.stderr.write("%s: position %.3f of its curve, ln gamma +- %.3f\n"
                     % (name, curve_of(kind.mean).position(), kind.sigma))
    print("    {/* %s */\n     %.3f,\n     {%s},\n     {%s}},"
          % (name, kind.sigma, numbers(kind.mean), numbers(c[np.tril_indices(MODES)])))
print("};")
