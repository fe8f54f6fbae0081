"""The tables of the part `verdicts`."""
import limit_curves
from report import count, failures, header, median, number, row
from verdicts import BAD, GOOD, HOLDS, LIMITS, OPEN, is_missed

READING_VERDICTS = """Rendered sequences, every option drawn from the seed. Good ones (smooth: sky and walls; hard:
parallax, sharpening, white areas, moving objects) should be accepted, bad ones (noise, negatives, local tone
mapping, misplaced pictures) refused. Failed: accepted with a clean residual above 5 levels, over the joined images.
Exposures (relative to the reference) and M in the corner: share of errors within the stated standard error, without
alignment, over the accepted good sequences. Targets are in brackets. To repeat a case:
`run.sh --only verdicts --match "smooth 17"{tune}`."""

READING_OPEN = """What pictures leave open, rendered as above. Applied: everything that was fitted (full), the falloff of a known
lens, exposures and white balances alone, nothing. Error in the corner: difference of M from the truth, without
alignment, where a falloff is applied, and the share within the stated standard error. Exposures: range (highest less
lowest) and standard deviation of the errors. Worse: the clean residual over the joined images is above that of the
pictures without a correction."""
MODELS = ("full", "lens", "exposures", "nothing")


def verdicts(results):
    """Both errors of the verdict, and the sequences concerned."""
    if not results or not (results["records"] or results["skipped"]):
        return []
    lines = ["## Verdicts", "", READING_VERDICTS.format(tune=" --tune" if results["tune"] else ""), ""]
    lines += header("kind", "sequences", "refused", "accepted without a word", "accepted with a warning", "equalized",
                    "failed", "exposures within their standard error", "corners")
    for kind in GOOD + BAD:
        of = [r for r in results["records"] if r["kind"] == kind]
        if of:
            lines.append(verdict_row(kind, of, kind in GOOD, LIMITS))
        elif kind in results["skipped"]:
            lines.append(row(kind, "SKIPPED: no OpenCV", *[""] * 7))
    lines += limit_curves.curves(results["records"], GOOD, BAD)
    lines += open_table(results["records"])
    missed = [r for r in results["records"] if is_missed(r)]
    if missed:
        lines += ["", "Missed.", "", *header("case", "what", "clean residual", "reason")]
        lines += [row("%s %d" % (r["kind"], r["number"]), is_missed(r), number(r.get("clean_rms")),
                      r["reason"] or "none") for r in missed]
    return lines + [""]


def verdict_row(kind, of, good, limits):
    accepted = [r for r in of if r["usable"]]
    wordless = count(accepted, lambda r: not r["reason"])
    equalized = [r["equalizes"] for r in of if r["equalizes"] is not None]
    missed = len(of) - len(accepted) if good else wordless
    target = "%d (at most %.0f %%%s)" % (missed, 100 * limits[good],
                                         "" if missed <= limits[good] * len(of) else "; **not met**")
    holds = [held([z for r in accepted for z in r["z"][what]]) for what in ("ev", "corner")] if good else ["", ""]
    return row(kind, len(of), target if good else len(of) - len(accepted), wordless if good else target,
               len(accepted) - wordless, sum(equalized) if equalized else "–", failures(accepted) if good else "", *holds)


def held(z):
    """Share of errors within their standard error, with the target."""
    if not z:
        return "–"
    share = sum(abs(v) < 1.0 for v in z) / len(z)
    return "%.0f %% of %d (%.0f to %.0f %%%s)" % (100 * share, len(z), *(100 * h for h in HOLDS),
                                                "" if HOLDS[0] <= share <= HOLDS[1] else "; **not met**")


def open_table(records):
    """What is applied where pictures leave open a falloff."""
    found = [r for r in records if r["kind"] in OPEN]
    if not found:
        return []
    lines = ["", READING_OPEN, ""]
    lines += header("kind", "sequences", *MODELS, "corner: median", "worst", "within its standard error",
                    "range of exposures, EV: median", "worst", "deviation, EV: median", "worst", "worse than the originals")
    by_kind = {kind: [r for r in found if r["kind"] == kind] for kind in OPEN}
    return lines + [open_row(kind, of) for kind, of in [*by_kind.items(), ("all", found)] if of]


def open_row(kind, of):
    """A sequence without a result gets no correction."""
    by_model = {model: [r for r in of if r.get("applied", "nothing") == model] for model in MODELS}
    corrected = [r for r in of if r.get("applied", "nothing") != "nothing"]
    z = [z for r in by_model["full"] for z in r["z"]["corner"]]
    worse = count(of, lambda r: r.get("worse"))
    with_falloff = by_model["full"] + by_model["lens"]
    return row(kind, len(of), *map(len, by_model.values()), *extent(with_falloff, "corner_error"), held(z),
               *extent(corrected, "ev_range"), *extent(corrected, "ev_deviation"),
               "%d%s" % (worse, " (at most 0; **not met**)" if worse else ""))


def extent(records, key):
    """Median and worst."""
    return number(median(records, key)), number(max((r[key] for r in records), default=None))
