"""The tables of the part `forms`."""
import math
import statistics

from falloff_forms import ELLIPSES, NOTE, SHAPES, WARNING
from report import count, header, number, row

READING = """Shading tables; a case is a channel under one light. Errors are relative to M and held out: three quarters
of the blocks of 2 x 2 cells predict the fourth. A form suffices if its RMS is below {note:g}, from which on `lensprof
flat` adds a gain grid. Pattern: RMS of the fit to all cells less the noise, as `lensprof flat` measures it. Its own
figures, without and with its grid, are those of cards drawn from the tables. Per camera: medians."""

READING_SEQUENCES = """Sequences: held-out RMS of ln light between the ends of pairs; links are held out. In brackets:
by how many standard errors it predicts better than the radial form with a free centre. Ratio: of the axes, fitted to
all links, and its range if links are left out."""

LABELS = {"radial": "radial, frame's centre", "radial, centre": "radial, free centre",
          "ellipse": "ellipse, free centre", "ellipse, angle": "ellipse with angle, free centre",
          "tilt": "radial and a plane, free centre", "grid": "radial and gain grid"}


def figure(records, shape, key):
    return [r["shapes"][shape][key] for r in records]


def is_radial(record, key="rms"):
    return record["shapes"]["radial, centre"][key] < NOTE


def is_elliptical(record, key="rms"):
    return min(figure([record], name, key)[0] for name in ELLIPSES) < NOTE


def span(values):
    low, high = min(values), max(values)
    return "%d" % low if low == high else "%d to %d" % (low, high)


def share(of, key):
    wanting = [r for r in of if not is_radial(r, key)]
    return count(wanting, lambda r: is_elliptical(r, key)), len(wanting)


def forms(results):
    """Shapes over all cases, then per camera, and the sequences; last the figures that the criterion needs."""
    tables = [r for r in results["tables"] if r["camera"] != "rendered"] if results else []
    if not results:
        return []
    lines = ["## Forms of the falloff", ""]
    if tables:
        lines += [READING.format(note=NOTE), "", *shape_table(tables), ""]
    lines += [*camera_table(results["tables"]), ""]
    if tables:
        counts = (*share(tables, "rms"), *share(tables, "pattern"), *cameras_of(tables))
        lines += ["Of the cases in which the radial form does not suffice, an ellipse does in %d of %d; by the pattern,"
                  " in %d of %d.\nCameras of these cases: %d of %d." % counts, ""]
    return lines + sequence_table(results["sequences"])


def cameras_of(tables):
    wanting = [r for r in tables if not is_radial(r)]
    return len({r["camera"] for r in wanting if is_elliptical(r)}), len({r["camera"] for r in wanting})


def shape_table(tables):
    lines = header("form", "parameters", "RMS, median", "largest", "worst error, median", "largest", "pattern, median",
                   "RMS below %g" % NOTE, "below %g" % WARNING, "pattern below %g" % NOTE)
    for shape, label in LABELS.items():
        rms, worst, pattern = (figure(tables, shape, key) for key in ("rms", "worst", "pattern"))
        below = ["%d of %d" % (sum(v < limit for v in values), len(values)) if None not in values else "–"
                 for values, limit in ((rms, NOTE), (rms, WARNING), (pattern, NOTE))]
        lines.append(row(label, span(figure(tables, shape, "parameters")), number(statistics.median(rms)),
                         number(max(rms)), number(statistics.median(worst)), number(max(worst)),
                         number(None if None in pattern else statistics.median(pattern)), *below))
    return lines


def camera_table(records):
    lines = header("camera", "cases", "noise", *("RMS, " * (shape == "radial") + LABELS[shape] for shape in LABELS),
                   "axes, ratio", "angle, degrees", "pattern, radial", "lensprof flat", "with its grid")
    groups = dict.fromkeys((r["camera"], r["channel"] if r["camera"] == "rendered" else "") for r in records)
    for camera, channel in groups:
        of = [r for r in records if r["camera"] == camera and channel in ("", r["channel"])]
        ratio, angle = (statistics.median(a[n] for a in figure(of, "ellipse, angle", "axes")) for n in (0, 1))
        lines.append(row(" ".join(filter(None, (camera, channel))), len(of),
                         number(statistics.median(r["noise"] for r in of)),
                         *(number(statistics.median(figure(of, shape, "rms"))) for shape in LABELS),
                         "%.3f" % ratio, "%.0f" % angle,
                         number(statistics.median(figure(of, "radial, centre", "pattern"))),
                         *(number(statistics.median(r["program"][key] if r["program"] else math.inf for r in of))
                           for key in ("frame", "with_grid"))))
    return lines


def needs_grid(record, than="radial, centre"):
    return record["shapes"][than]["grid_better"] >= 2.0


def sequence_table(records):
    if not records:
        return []
    lines = [READING_SEQUENCES, ""]
    lines += header("sequence", "usable", "links", "pairs", *(LABELS[s] for s in SHAPES), "grid", "ratio, ellipse",
                    "ratio, ellipse with angle")
    for r in records:
        ratios = ["%.2f (%.2f to %.2f)" % (r["shapes"][e]["axes"][0], min(r["shapes"][e]["fold_ratios"]),
                                           max(r["shapes"][e]["fold_ratios"])) for e in ELLIPSES]
        cells = ["%s (%+.1f)" % (number(r["shapes"][s]["rms"]), r["shapes"][s]["better"]) for s in (*SHAPES, "grid")]
        lines.append(row(r["project"], "yes" if r["usable"] else "no", r["links"], r["pairs"], *cells, *ratios))
    wanting = [r for r in records if needs_grid(r)]
    enough = count(wanting, lambda r: any(not needs_grid(r, name) for name in ELLIPSES))
    return lines + ["", "The grid predicts better than the radial form by two standard errors in %d of %d sequences;\nin"
                    " %d of these not better than an ellipse by as much." % (len(wanting), len(records), enough), ""]
