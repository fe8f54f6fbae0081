"""The tables of the part `video`."""
import math

from report import header, number, row

READING = """Rendered clips of a moving camera with automatic exposure: 640 x 480, 300 frames, H.264 at crf 12, gamma 2.2,
falloff 1 - 0.45 r^2 (corner 0.55), exposures over 2 EV and 0.03 EV of jitter, noise of one level, unless the case
states otherwise. Pan: 4 pixels per frame over a strip of {source}; room: a walk through a room with walls and panels
of them, with parallax and occlusion. S curve: with toe and shoulder, not a gamma. Exposures: RMS and largest error,
EV, after removing the mean; drift: peak to peak of the error, averaged over 25 frames; falloff: largest error over the
radius; response: largest error at the levels 8 to 250, levels, at the best scale. The worse of the seeds. Fixed
exposures leave the exponent open, also with times. CPU: seconds of one clip. Encoding: by how much the codec changed
the brightness of the frames, EV, RMS after removing the mean, most of it jitter that it leaves out; decoded: RMS error
of the exposures compared with those of the decoded frames."""

ALONE = """Without exposure times: after the exponent that fits the true exposures best, which a clip alone does not
determine (with fixed exposures: the true response); exponent: the smallest and the largest. As stated: with the
exponent of typical cameras, as the program writes its files. Bergmann et al. 2018: bergmann.py, in NumPy, on the same
frames; exposures of the backend, fast: those of the fast estimate, RMS."""


def worst(records, *keys):
    """The largest of the runs; infinite without a result."""
    values = []
    for record in records:
        for key in keys:
            record = record.get(key) if isinstance(record, dict) else None
        values.append(math.inf if record is None else record)
    return number(max(values))


def figures(records, how):
    return ["%s (%s)" % (worst(records, how, "ev"), worst(records, how, "ev_largest")),
            *(worst(records, how, name) for name in ("drift", "falloff", "response"))]


def exponents(records):
    found = [r["exponent"] for r in records if "exponent" in r]
    return "%.2f to %.2f" % (min(found), max(found)) if found else "–"


def video(results):
    if not results:
        return []
    by_case = {}
    for record in results["cases"]:
        by_case.setdefault(record["case"], []).append(record)
    source = "photographs" if results["photographs"] else "painted pictures"
    names = ("exposures", "drift", "falloff", "response")
    lines = ["## Clips", "", READING.format(source=source), "", "With exposure times:", ""]
    lines += header("case", "runs", "encoding", "usable", *names, "decoded", "segments", "frames without an exposure", "CPU, s", "peak, MB")
    for case, records in by_case.items():
        of = [r["times"] for r in records]
        lines.append(row(case, len(of), worst(records, "encoding"), sum(r["code"] == 0 for r in of), *figures(of, "raw"),
                         worst(of, "raw", "ev_decoded"), *(max((r.get(key, 0) for r in of)) for key in ("segments", "without_ev")), worst(of, "cpu_s"),
                         worst(of, "peak_mb")))
    lines += ["", ALONE, ""]
    lines += header("case", "usable", "exponent", *names, "as stated: exposures", "falloff", "response",
                    *("Bergmann: %s" % n for n in (*names, "exponent", "fast", "CPU, s")))
    for case, records in by_case.items():
        of, peer = [r["alone"] for r in records], [r.get("bergmann", {}) for r in records]
        lines.append(row(case, sum(r["code"] == 0 for r in of), exponents(of), *figures(of, "aligned"),
                         *(worst(of, "raw", name) for name in ("ev", "falloff", "response")), *figures(peer, "aligned"),
                         exponents(peer), worst(peer, "fast"), worst(peer, "cpu_s")))
    return lines + [""]
