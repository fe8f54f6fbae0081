"""The tables of the part `trials`."""
import math

import numpy as np

from report import count, header, number, row
from trials import CANDIDATES, ENDS, KINDS, OFF, SIGNS

READING_TRIALS = """Rendered sequences, every option drawn from the seed. Each is checked against the true falloff,
others that are {off:g} EV too bright and too dark in the corner, and none. The profile has the true response (exact),
one that was fitted to other pictures (fitted), or none, but exposures in EXIF, off by 0.1 EV (lens); or the pictures
are sensor data (linear). Sign: of the brightness left in the outermost ring. Stated: the command states it; otherwise
it states that the difference is within the error or not shown. Refused: the command finds too few pairs, or `build`
refuses the pictures to fit; such sequences count in no other column. Standard errors: brightness left per ring,
relative to the middle, compared with the truth; z is the error divided by its standard error. The candidates of one
sequence share its errors, so the binomial error counts sequences. Targets: every sign right, 68 % within one standard
error. To repeat a case: `run.sh --only trials --match "fitted 17"{tune}`."""
WITHIN = {1.0: 0.683, 2.0: 0.954}  # share of a normal distribution


def trials(results):
    """Signs, standard errors per ring and per kind, and the cases that are wrong."""
    if not results or not results["records"]:
        return []
    records = results["records"]
    reading = READING_TRIALS.format(off=OFF, tune=" --tune" if results["tune"] else "")
    lines = ["## Profiles against pictures", "", reading, ""]
    groups = [(kind, [r for r in records if r["kind"] == kind]) for kind in KINDS] + [("all", records)]
    groups = [(kind, of) for kind, of in groups if of]
    measured = [(kind, [r for r in of if not r["refused"]]) for kind, of in groups]
    measured = [(kind, of) for kind, of in measured if of]
    lines += header("kind", "sequences", "refused", "true: agrees", *("%s: %s" % (c, what) for c in CANDIDATES[1:]
                                                           for what in ("sign right", "stated")), "not shown",
                    "standard error in the outermost ring, EV: median")
    lines += [sign_row(kind, of) for kind, of in groups]
    for names, title in ((CANDIDATES[:1], "The true falloff"), (CANDIDATES, "All candidates")):
        lines += ["", "%s: share within one, within two standard errors, median of |z| (0.67)." % title, ""]
        rings = ["r up to %g" % end for end in ENDS[1:]]
        lines += header("kind", "binomial error", *rings, "all rings")
        lines += [ring_row(kind, of, names) for kind, of in measured]
    wrong = [(r, c) for r in records for c in CANDIDATES if not r["refused"] and is_wrong(r, c)]
    if wrong:
        lines += ["", "Wrong signs, and true ones that are called wrong.", ""]
        lines += header("case", "candidate", "stated", "truth, EV", "found, EV", "standard error")
        lines += [wrong_row(r, c) for r, c in wrong]
    return lines + [""]


def has_sign(record, candidate):
    """Of the outermost ring, of a candidate that is wrong."""
    found = record["candidates"][candidate]
    last = len(found["ev"]) - 1
    return last > 0 and found["ev"][last] * found["truth"][last] > 0.0


def is_stated(record, candidate):
    return record["candidates"][candidate]["corners"] == SIGNS[candidate]


def is_wrong(record, candidate):
    """The true falloff is called wrong, or another one has the wrong sign."""
    if candidate == "true":
        return record["candidates"][candidate]["corners"] in ("too-dark", "too-bright")
    return not has_sign(record, candidate)


def sign_row(kind, every):
    of = [r for r in every if not r["refused"]]
    found = [r["candidates"][c] for r in of for c in CANDIDATES]
    signs = [count(of, lambda r, c=c, test=test: test(r, c)) for c in CANDIDATES[1:] for test in (has_sign, is_stated)]
    sigmas = [r["candidates"]["true"]["sigma"][-1] for r in of if len(r["candidates"]["true"]["sigma"]) > 1]
    sigma = np.median(sigmas) if sigmas else np.nan
    return row(kind, len(every), len(every) - len(of), count(of, lambda r: is_stated(r, "true")), *signs,
               count(found, lambda f: f["corners"] == "not-shown"), number(float(sigma)))


def ring_row(kind, of, names):
    z = [[v for r in of for c in names for v in r["candidates"][c]["z"][n:n + 1]] for n in range(len(ENDS) - 1)]
    z.append([v for ring in z for v in ring])
    error = 100.0 * math.sqrt(WITHIN[1.0] * (1.0 - WITHIN[1.0]) / len(of))
    return row(kind, "%.0f %%" % error, *map(held, z))


def held(z):
    if not z:
        return "–"
    shares = ["%.0f %%" % (100.0 * np.mean(np.abs(z) < limit)) for limit in WITHIN]
    return "%s, %s, %.2f" % (*shares, np.median(np.abs(z)))


def wrong_row(record, candidate):
    found = record["candidates"][candidate]
    return row("%s %d" % (record["kind"], record["number"]), candidate, found["corners"],
               *("%+.3f" % found[key][len(found["ev"]) - 1] for key in ("truth", "ev")), "%.3f" % found["sigma"][-1])
