"""The tables of the part `reconstruction`."""
from report import header, number, row

READING_SIMULATED = """Rendered pictures of a moving camera (`simulate --set moving`), matched by COLMAP 3.8, fitted from
its database and from its model. Errors are the largest ones: exposures with offset and exponent removed, M with the
exponent removed. Exposures only: `--fit free=ev,wb`."""

READING_VARIANCE = """Variance of colours: half the squared difference between two pictures at one point, in levels
of 255 squared, mean of the smallest 90 %. Affine: a gain and an offset per picture and channel in grey values,
fitted to the same pairs by robust least squares, as in the training of radiance fields; it has six numbers per
picture, exposures have three. Exposures only: `--fit free=ev,wb`, which uses the mean response of EMoR. "With the
typical response" is what `build` itself reports (`colour_variance`)."""

READING_REAL = """EXIF is withheld (`--fit exif-sigma=0`). Exposures are compared with those of EXIF: correlation r,
slope, standard deviation of the difference. Values in brackets are for exposures only (`--fit free=ev,wb`)."""

READING_SCALE = """A drone over flat ground: pictures of 1000 x 750 (JPEG) and a database as COLMAP writes it, 600
keypoints per picture, each point in about ten pictures. `build database.db --no-store --write exposures=FILE`;
`apply --model` on the smallest set. Fits: all fits until no more points are left out as glossy."""

WAYS = {"database": "database.db", "model": "model"}


def variance_cells(record):
    """For exposures only, the smaller of the two variances is the reference."""
    of, stated = record["variance"], record["stated_variance"] or {}
    only = [of["exposures_only"], stated.get("exposures_only", of["exposures_only"])]
    return [number(v) for v in (of["before"], of["affine"], *only, of["result"], of["result"] / max(min(only), 1e-9))]


VARIANCE_TITLES = ("variance before", "affine", "exposures only", "with the typical response", "lensprof",
                   "lensprof / exposures only")


def simulated(records):
    if not records:
        return []
    lines = ["### Rendered", "", READING_SIMULATED, ""]
    lines += header("set", "response", "by", "joined", "exposure, EV", "M", "exposures only: exposure, EV", "M", "CPU, s", "peak, MB",
                    "verdict: usable, equalizes")
    for r in records:
        lines.append(row(r["set"], r["response"], WAYS[r["way"]], "%d of %d" % (r["joined"], r["images"]), number(r["ev"]),
                         number(r["falloff"]), number(r["only"]["ev"]), number(r["only"]["falloff"]), number(r["cpu_s"]),
                         number(r["peak_mb"]), "%s, %s" % (r["usable"], r["equalizes"])))
    lines += ["", READING_VARIANCE, ""]
    lines += header("set", "by", "pairs", *VARIANCE_TITLES)
    for r in records:
        lines.append(row(r["set"], WAYS[r["way"]], r["variance"]["pairs"], *variance_cells(r)))
    return lines + [""]


def real(records):
    if not records:
        return []
    lines = ["### Real pictures", "", READING_REAL, ""]
    lines += header("pictures", "by", "joined", "EXIF spans, EV", "r", "slope", "difference, EV", *VARIANCE_TITLES, "CPU, s",
                    "peak, MB", "verdict: usable, equalizes")
    for r in records:
        ours, only = r.get("result", {}), r.get("only", {})
        cells = ["%s (%s)" % (number(ours.get(key)), number(only.get(key))) for key in ("r", "slope", "off_ev")]
        lines.append(row(r["set"], WAYS[r["way"]], "%s of %d" % (ours.get("joined", "–"), r["images"]), number(r.get("exif_ev")),
                         *cells, *variance_cells(r), number(r["cpu_s"]), number(r["peak_mb"]),
                         "%s, %s" % (r["usable"], r["equalizes"])))
    return lines + [""]


def tracks(records):
    if not records:
        return []
    lines = ["### Colours in tracks.csv", "", "Exposures from the pictures and from the colours of OpenSfM's tracks"
             " alone (`--reconstruction track-colors=yes`); r and slope compared with EXIF, which is withheld.", ""]
    lines += header("pictures", "number", "pairs: pictures", "tracks", "r: pictures", "tracks", "slope: pictures", "tracks",
                    "largest difference, EV")
    for r in records:
        cells = [number(r.get(way, {}).get(key)) for key in ("r", "slope") for way in ("pictures", "tracks")]
        pairs = [r.get(way, {}).get("pairs", "–") for way in ("pictures", "tracks")]
        lines.append(row(r["set"], r["images"], *pairs, *cells, number(r.get("off_ev"))))
    return lines + [""]


def rebuilt(records):
    if not records:
        return []
    lines = ["### A model rebuilt", "", "COLMAP on the pictures and on the copies by `apply --model`: output of"
             " `colmap model_analyzer` for the largest model, and verified pairs of pictures and matches.", ""]
    lines += header("set", "pictures", "pairs", "matches", "registered", "points", "observations", "track length",
                    "reprojection error, px", "apply, s")
    for r in records:
        for label in ("before", "after"):
            own = r.get(label, {})
            whole = ["%d" % own[key] if key in own else "–" for key in ("registered", "points", "observations")]
            lines.append(row(r["set"], "as taken" if label == "before" else "corrected",
                             *(own.get(key, "–") for key in ("pairs", "matches")), "%s of %d" % (whole[0], r["images"]),
                             *whole[1:], number(own.get("track_length")), number(own.get("error_px")),
                             number(r["apply_s"]) if label == "after" else ""))
    return lines + [""]


def scale(records):
    if not records:
        return []
    lines = ["### Many pictures", "", READING_SCALE, ""]
    lines += header("pictures", "observations", "database, MB", "pairs", "joined", "wall, s", "read, s", "sample, s", "fits, s", "CPU, s",
                    "peak, MB", "exposure, EV", "M", "variance before", "lensprof", "apply, s", "apply peak, MB")
    for r in records:
        seconds, of = r.get("seconds", {}), r.get("variance", {})
        parts = [seconds.get(key) for key in ("register", "sample")]
        fits = r["wall_s"] - sum(parts) if seconds else None
        cells = [number(v) for v in (r["wall_s"], *parts, fits, r["cpu_s"], r["peak_mb"], r.get("ev"), r.get("falloff"),
                                     of.get("before"), of.get("result"))]
        lost = r.get("lost", "")
        lines.append(row(r["images"], r["observations"], number(r["database_mb"]), r.get("pairs", "–"), r.get("joined", lost or "–"),
                         *cells, *(number(r[k]) if r.get(k) else "" for k in ("apply_s", "apply_mb"))))
    return lines + [""]


def tables(results):
    if not results:
        return []
    lines = ["## Reconstructions", ""]
    for what in results["skipped"]:
        lines += ["**SKIPPED: %s**" % what, ""]
    return (lines + simulated(results["simulated"]) + real(results["real"]) + tracks(results["tracks"])
            + rebuilt(results["rebuilt"]) + scale(results["scale"]))
