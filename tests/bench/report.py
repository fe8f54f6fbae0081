"""The tables, in Markdown."""
import math
import statistics

import cases
from tools import LABELS

FIGURES = [("ev_raw", "exposure, raw, EV"), ("ev_aligned", "exposure, EV"), ("wb_aligned", "white balance, EV"),
           ("falloff_raw", "falloff, raw, max"), ("falloff_aligned", "falloff, max"),
           ("center", "centre, half diagonals"), ("response_aligned", "response, levels"),
           ("clean_rms", "clean residual, levels")]
TARGET_FIGURES = {"ev_raw": "exposure, raw", "ev_aligned": "exposure", "ev_spread": "spread of exposures"}
COSTS = [("cpu_s", "CPU, s"), ("peak_mb", "peak, MB")]

READING = """Errors are differences from the truth, medians over runs (seeds and responses); all tools get the same
seeds. Raw: as the tool states it. All other figures are aligned: the exponent that pictures alone leave open is
removed. Clean residual: RMS of the symmetric transfer error, in levels of 255, on 2000 noise-free pairs that no tool
has seen; "lensprof is better" counts the cases in which lensprof's is smaller. Failure: clean residual above 5
levels, or no result. Refused: lensprof reports that its result is not usable; it is scored nevertheless. Response
falls: somewhere on the 1024 samples of the curve as stated; vig_optimize's curve is scored after the clipping that
Hugin applies to it. vig_optimize seeds its own sampling from the clock, so its columns `-s 0 -p 2000` and `defaults`
vary from run to run. Everything else except times repeats exactly. CPU times in the accuracy tables were measured
with {jobs} cases in parallel."""

READING_REAL = """Five-fold cross validation: both tools fit the same 80 % of the pairs. The table shows the residual
of the other 20 %, in levels of 255. The columns "agreeing" leave out the pairs of images that mostly disagree,
because the project has them in the wrong place (the median residual of the image's pairs is above 10 levels with
both tools); the fits included them. Everything is estimated, whatever the v lines of a project request. Pairs drawn
by vig_optimize differ in every run; those with grey values outside 0..1 are left out for both tools."""

READING_GALLERY = """Verdict, and seams compared with those of vig_optimize -s 0 -p 2000. Seam of a link: median over
its places of the difference between a picture and its prediction from the other one, in levels of 255. The table
shows the median over all links (and the worst). Places come from features of the pictures, not from a project or a
tool. Only links of which lensprof joined both images are measured."""


def number(value):
    """Three significant digits, at most four decimal places."""
    if value is None or not math.isfinite(value):
        return "–"
    if abs(value) < 0.01:
        return "%.4f" % value
    return "%.*f" % (max(0, 2 - math.floor(math.log10(abs(value)))), value)


def row(*cells):
    return "| " + " | ".join(str(c) for c in cells) + " |"


def header(*cells):
    return [row(*cells), "|" + "---|" * len(cells)]


def median(records, key):
    """A run without a result counts as infinitely bad; None: the figure does not apply."""
    values = [v for v in (r.get(key, math.inf) for r in records) if v is not None]
    return statistics.median(values) if values else math.nan


def count(records, test):
    return sum(1 for r in records if test(r))


def failures(records):
    return count(records, lambda r: r["failed"])


def unnoticed(records):
    return count(records, lambda r: r["failed"] and r.get("usable") is not False)


def refusals(records):
    return count(records, lambda r: r.get("usable") is False)


def falling(records):
    return count(records, lambda r: not r.get("monotone", False))


def ratio(ours, theirs):
    under = median(theirs or [], "clean_rms")
    return number(median(ours, "clean_rms") / under) if under > 0 and math.isfinite(under) else "–"


def wins(ours, theirs):
    """`k of n`: cases in which lensprof's clean residual is smaller."""
    other = {r["case"]: r.get("clean_rms", math.inf) for r in theirs or []}
    won = count(ours, lambda r: r.get("clean_rms", math.inf) < other.get(r["case"], -math.inf))
    return "%d of %d" % (won, len(other)) if other else "–"


def split(records, group=None):
    """{tool: records of the group}"""
    tools = [t for t in LABELS if any(r["tool"] == t for r in records)]
    return {t: [r for r in records if r["tool"] == t and (group is None or group in r["groups"])] for t in tools}


def groups_of(records):
    found = []
    for r in records:
        found += [g for g in r["groups"] if g not in found]
    return found


def residual_table(records):
    """Clean residual and failures of every tool."""
    labels = [LABELS[t] for t in split(records)]
    lines = header("case", "runs", "uncorrected", *labels, "lensprof / same points", "lensprof is better",
                   "lensprof / best of Hugin")
    for group in groups_of(records):
        of, cells = split(records, group), []
        for r in of.values():
            cells.append(number(median(r, "clean_rms")) + (" (%d)" % failures(r) if failures(r) else ""))
        peers = [r for t, r in of.items() if t.startswith("hugin")]
        best = min(peers, key=lambda r: median(r, "clean_rms"), default=None)
        ours = of["lensprof"]
        before = number(median(ours, "uncorrected_rms"))
        lines.append(row(group, len(ours), before, *cells, ratio(ours, of.get("hugin")),
                         wins(ours, of.get("hugin")), ratio(ours, best)))
    return lines


def beside_table(records):
    """lensprof / Hugin on the same pairs: all other errors."""
    keys = [(k, title) for k, title in FIGURES if k != "clean_rms"]
    lines = header("case", *(title for _, title in keys), "response falls", "refused", "CPU, s")
    for group in groups_of(records):
        of = split(records, group)
        pair = [of["lensprof"], of.get("hugin", [])]
        cells = [" / ".join(number(median(r, k)) for r in pair) for k, _ in keys]
        falls = " / ".join(str(falling(r)) if r else "–" for r in pair)
        cpu = " / ".join(number(median(r, "cpu_s")) for r in pair)
        lines.append(row(group, *cells, falls, refusals(pair[0]), cpu))
    return lines


def summary_table(records, costs):
    """One line per tool, over all cases."""
    lines = header("tool", "runs", *(title for _, title in FIGURES), "largest clean residual", "failures",
                   "failures not refused", "refused", "response falls", "lensprof is better",
                   *(title for _, title in costs))
    tools = split(records)
    for tool, of in tools.items():
        figures = [number(median(of, k)) for k, _ in FIGURES]
        figures.append(number(max(r.get("clean_rms", math.inf) for r in of)))
        counts = failures(of), unnoticed(of), refusals(of), falling(of)
        better = "" if tool == "lensprof" else wins(tools["lensprof"], of)
        lines.append(row(LABELS[tool], len(of), *figures, *counts, better, *(number(median(of, k)) for k, _ in costs)))
    return lines


def accuracy(title, note, records, costs):
    if not records:
        return []
    return ["## " + title, "", note, "",
            "Clean residual, levels of 255: median (failures).", "", *residual_table(records), "",
            "lensprof / vig_optimize on the same pairs, medians.", "", *beside_table(records), "",
            "All cases.", "", *summary_table(records, costs), ""]


def targets(records):
    """Figures specific to single cases; a run meets a target if it is at or below it."""
    lines = []
    for group, key, target in cases.TARGETS:
        of = split([r for r in records if group in r["groups"]])
        if not of:
            continue
        ours = of["lensprof"]
        met = "%d of %d" % (count(ours, lambda r: r.get(key, math.inf) <= target), len(ours)) if target else "–"
        largest = number(max(r.get(key, math.inf) for r in ours))
        lines.append(row(group, TARGET_FIGURES[key], number(target), number(median(ours, key)), largest, met,
                         number(median(of.get("hugin", []), key)), refusals(ours)))
    if not lines:
        return []
    return ["Figures specific to single cases, in EV; largest: of the lensprof runs.", "",
            *header("case", "figure", "target", "lensprof", "largest", "met by", "vig_optimize, same points",
                    "refused"),
            *lines, ""]


def refused(records):
    if not records:
        return []
    lines = ["## To be refused", "", "No single response produces these pictures: local tone mapping renders a point"
             " according to its surroundings, which differ from picture to picture.", ""]
    lines += header("case", "runs", "refused", "exposure, raw, EV", "falloff, raw, max", "clean residual, levels")
    for group in groups_of(records):
        of = split(records, group)["lensprof"]
        figures = [number(median(of, key)) for key in ("ev_raw", "falloff_raw", "clean_rms")]
        lines.append(row(group, len(of), refusals(of), *figures))
    return lines + [""]


def flat(records):
    if not records:
        return []
    lines = ["## By a card and by a sequence", "", "Goldman & Chen 2005, figure 6, simulated: largest difference of M"
             " from the truth over the half diagonal, raw, noise of 2 levels. Card: three linear pictures of 640 x 480,"
             " rotated by 90 degrees, under a light with a gradient (`flat`). Sequence: six overlapping pictures of the"
             " same lens with EXIF exposures (`build`). Card beside sequence: largest difference between the two.", ""]
    lines += header("seed", "falloff", "card", "sequence", "card beside sequence")
    for r in records:
        lines.append(row(r["seed"], r["lens"], *(number(r.get(key)) for key in ("card", "sequence", "apart"))))
    figures = [number(median(records, key)) for key in ("card", "sequence", "apart")]
    return lines + [row("median", "", *figures), ""]


def scale(records):
    if not records:
        return []
    lines = ["## Scale", "", "Mosaics of a narrow lens, 100 pairs per image (10 % outliers), given as a point file; one"
             " turn.", ""]
    lines += header("images", "pairs", "solver, s", "process, s", "peak, MB", "usable", "exposure, EV",
                    "clean residual", "simulate, s")
    for r in records:
        cells = [number(r.get(key)) for key in ("solve_s", "wall_s", "peak_mb")]
        usable = "yes" if r.get("usable") else "no: %s" % r.get("reason", r.get("lost", "exit code %s" % r.get("code")))
        lines.append(row(r["images"], r.get("pairs", "–"), *cells, usable, number(r.get("ev_aligned")),
                         number(r.get("clean_rms")), number(r["simulate_s"])))
    return lines + [""]


def static(records):
    if not records:
        return []
    lines = ["## Stationary camera", "", "Four frames, exposures unknown, aligned to the brightest (Kim & Pollefeys"
             " 2004, section 3.1): RMS difference summed over the channels, levels of 255, median over the seeds."
             " With the true curve, only rounding and noise remain. Debevec & Malik 1997 is given the true exposures.", ""]
    tools = [key for key in ("truth", "transfer", "transfer-function", "debevec") if key in records[0]]
    lines += header("curve", "noise", "runs", *tools)
    for curve, noise in sorted({(r["curve"], r["noise"]) for r in records}):
        of = [r for r in records if (r["curve"], r["noise"]) == (curve, noise)]
        values = [[r[key] if r[key] is not None else math.inf for r in of] for key in tools]
        lines.append(row(curve, noise, len(of), *(number(statistics.median(v)) for v in values)))
    return lines + [""]


def sweep(records):
    if not records:
        return []
    lines = ["## Exposure sweeps", "", "Static scenes of 240 x 180 with times.txt, gamma 2, grey, 8 bit, 120 frames in steps"
             " of 6 %, unless the case states otherwise. RMS and largest error of pcalib.txt, levels; the worse of the"
             " seeds. responseCalib (Engel et al. 2016): as published; accepted: how many of its results increase strictly,"
             " as DSO requires.", ""]
    lines += header("case", "frames", "runs", "usable", "lensprof, RMS", "largest", "CPU, s", "peak, MB", "responseCalib, RMS",
                    "largest", "CPU, s", "accepted")
    for case in dict.fromkeys(r["case"] for r in records):
        of = [r for r in records if r["case"] == case]
        worst = [number(max((r[key] for r in of if key in r), default=None)) for key in
                 ("rms", "largest", "cpu_s", "peak_mb", "engel_rms", "engel_largest", "engel_cpu_s")]
        accepted = sum(r["engel_accepted"] for r in of) if "engel_accepted" in of[0] else "–"
        lines.append(row(case, of[0]["frames"], len(of), sum(r["code"] == 0 for r in of), *worst, accepted))
    return lines + [""]


def timelapse(results):
    if not results:
        return []
    lines = ["## Timelapses", "", "Rendered frames of a stationary camera, 90 of 480 x 270 unless the case states otherwise, with"
             " moving clouds, JPEG. Steps of the brightness of the ground from frame to frame in linear light, beyond the"
             " change of the light where the camera's settings are known; range: between the extremes of what remains over the"
             " sequence, EV; the worse of the seeds. The script levels the mean of encoded luma to its running mean; FFmpeg:"
             " its filter deflicker.", ""]
    names = ("before", "lensprof", "ffmpeg", "script")
    lines += header("case", "frames", *("%s, largest step" % n for n in names), *("%s, range" % n for n in names), "CPU, s",
                    "peak, MB", "script CPU, s")
    for case in dict.fromkeys(r["case"] for r in results["cases"]):
        of = [r for r in results["cases"] if r["case"] == case]
        cells = [number(max((r[n][key] for r in of if n in r), default=None)) for key in ("largest_step", "range") for n in names]
        lines.append(row(case, of[0]["frames"], *cells, number(max(r["cpu_s"] for r in of)), number(max(r["peak_mb"] for r in of)),
                         number(max(r["script"]["cpu_s"] for r in of))))
    large = results["large"]
    if large:
        lines += ["", "%d JPEG of 24 megapixels, CPU seconds per frame: levelled copies %s (peak %s MB), exposures alone %s (peak %s"
                  " MB); OpenCV decodes one in %s and encodes one in %s." % (
                      large["frames"], number(large["copies"]["cpu_s"]), number(large["copies"]["peak_mb"]),
                      number(large["table"]["cpu_s"]), number(large["table"]["peak_mb"]), number(large["decode_cpu_s"]),
                      number(large["encode_cpu_s"]))]
    return lines + [""]


def speed(results):
    if not results:
        return []
    lines = ["## Speed", "", "Solver alone, with given pairs (10 % outliers). lensprof uses all cores, vig_optimize its"
             " single one.", ""]
    lines += header("case", "turns", "tool", "solver, s", "CPU of the process, s", "lensprof's solver / CPU",
                    "lensprof's CPU / CPU", "clean residual")
    for r in results["solver"]:
        cells = [number(r.get(k)) for k in ("solve_s", "cpu_s", "ratio_solve_to_cpu", "ratio_cpu_s", "clean_rms")]
        lines.append(row(r["case"], r["turns"], LABELS[r["tool"]], *cells))
    lines += ["", "Whole command; each tool with its own number of threads. Outliers: 10 % of the pixels.", ""]
    lines += header("case", "MB a file", "turns", "tool", "pairs used", "wall, s", "CPU, s", "peak, MB", "lensprof / tool: wall",
                    "CPU", "peak", "clean residual")
    for r in results["command"]:
        keys = ("wall_s", "cpu_s", "peak_mb", "ratio_wall_s", "ratio_cpu_s", "ratio_peak_mb", "clean_rms")
        pairs = "%d" % r["pairs"] if "pairs" in r else "–"
        lines.append(row(r["case"], number(r["file_mb"]), r["turns"], LABELS[r["tool"]], pairs, *(number(r.get(k)) for k in keys)))
    same = all(r["identical"] for r in results["solver"] + results["command"] if r["tool"] == "lensprof")
    return lines + ["", "lensprof's output was %s to the byte over all turns, apart from `seconds`."
                    % ("identical" if same else "NOT IDENTICAL"), ""]


def real_rows(record):
    for fold in record["folds"]:
        bad, tool = fold["disagreeing_images"], "lensprof" if fold["tool"] == "lensprof" else "vig_optimize"
        keys = ("rms", "median", "clipped_rms")
        agreeing = [number(fold["agreeing"].get(k)) if bad else "" for k in keys]
        yield row(record["project"], fold["points_by"], fold["all"]["pairs"], tool, number(fold["uncorrected"]["rms"]),
                  *(number(fold["all"][k]) for k in keys), *agreeing, ", ".join(map(str, bad)),
                  "%d of 5" % fold["monotone_folds"], fold["failed_folds"] or "")


def real(records):
    if not records:
        return []
    lines = ["## Real pictures", "", READING_REAL, ""]
    lines += header("project", "pairs by", "pairs", "tool", "uncorrected RMS", "RMS", "median", "RMS, clipped at 20",
                    "agreeing: RMS", "median", "RMS, clipped", "disagreeing images", "monotone", "folds failed")
    for record in records:
        lines += real_rows(record)
    lines += ["", "lensprof on the pictures.", ""]
    lines += header("project", "images", "pairs", "usable", "held-out RMS", "monotone on 1024 samples",
                    "two runs identical to the byte")
    for r in records:
        used = r["lensprof"]
        usable = "yes" if used.get("usable") else "no: %s" % used.get("reason", used.get("lost"))
        lines.append(row(r["project"], r["images"], used.get("pairs", "–"), usable, number(used.get("heldout_rms")),
                         *("yes" if r[k] else "NO" for k in ("monotone", "identical"))))
    return lines + [""]


def seam_cells(record, tool):
    """Median (worst)."""
    of = record["seams"].get(tool)
    return "%s (%s)" % (number(of["median"]), number(of["worst"])) if of else "–"


def met(unmet):
    return "" if unmet is None else "NOT met: " + "; ".join(unmet) if unmet else "met"


def verdict_cells(used):
    said = {True: "yes", False: "no"}
    reason = used.get("reason_code") or used.get("lost", "")
    return (*(said.get(used.get(key), "–") for key in ("usable", "equalizes")), reason)


def gallery(records):
    """Real projects and whether their expectations are met."""
    if not records:
        return []
    lines = ["### Gallery", ""]
    if not any("gallery" in r for r in records):
        return lines + ["**SKIPPED: no OpenCV for Python (package python3-opencv)**", ""]
    lines += [READING_GALLERY, ""]
    lines += header("project", "usable", "equalizes", "reason", "joined", "residual before", "held out", "links",
                    "seam before", "lensprof", "vig_optimize", "expected")
    for r in records:
        of, used = r["gallery"], r["lensprof"]
        lines.append(row(r["project"], *verdict_cells(used), "%d of %d" % (of["joined"], of["images"]),
                         number(used.get("before_rms")), number(used.get("heldout_rms")),
                         "%d of %d" % (of["links_measured"], of["links"]),
                         *(seam_cells(of, tool) for tool in ("before", "lensprof", "hugin")), met(r["unmet"])))
    return lines + [""]


def brackets(records):
    if not records:
        return []
    lines = ["### Brackets", "", "`lensprof bracket` with exposures from EXIF, if available.", ""]
    lines += header("set", "options", "pictures", "usable", "reason", "left out", "residual before", "held out",
                    "expected")
    for r in records:
        used = r["lensprof"]
        usable, _, reason = verdict_cells(used)
        lines.append(row(r["set"], r["options"], r["images"], usable, reason, len(used.get("left_out", [])),
                         number(used.get("before_rms")), number(used.get("heldout_rms")), met(r["unmet"])))
    return lines + [""]


def radiance(results):
    if not results:
        return []
    names = {"lensprof": "lensprof", "lensprof-5": "lensprof, 5 modes, squared", "paper": "alternation, Nelder-Mead"}
    lines = ["## The method `radiance`", "", "12 images x 2000 points of 2 to 5 observations, three channels, noise of 2"
             " levels, sRGB response unknown; medians over seeds. The paper's algorithm: tests/bench/radiance.py.", ""]
    lines += header("who", "s", "settled", "exposure, EV", "falloff, max")
    for name, label in names.items():
        records = [r[name] for r in results["paper"]]
        settled = "%d of %d" % (count(records, lambda r: r["settled"]), len(records))
        lines.append(row(label, *(number(median(records, key)) if key else settled for key in
                                  ("seconds", None, "ev_aligned", "falloff_aligned"))))
    lines += ["", "Compared with `transfer`, from pictures.", ""]
    lines += header("case", "method", "runs", "exposure, EV", "falloff, max", "response, levels", "clean residual",
                    "solver, s", "usable")
    for case, method in dict.fromkeys((r["case"], r["method"]) for r in results["transfer"]):
        records = [r for r in results["transfer"] if (r["case"], r["method"]) == (case, method)]
        figures = (number(median(records, key)) for key in
                   ("ev_aligned", "falloff_aligned", "response_aligned", "clean_rms", "solve_s"))
        lines.append(row(case, method, len(records), *figures, count(records, lambda r: r.get("usable"))))
    return lines + [""]


def knowledge(records):
    """Prior knowledge, and the remaining errors; unmet targets are marked."""
    if not records:
        return []
    from knowledge import HOLDS, PAIRS, STATES, TARGETS, TIME_SIGMA_EV

    def share(of, test):
        return count(of, test) / len(of)

    def beside(value, shown, target, met):
        return "%s (%s%s)" % (shown % value, target, "" if met else "; **not met**")

    lines = ["## What is known beforehand", "", "Simulated digital cameras with Lensfun's lenses, 6 images, %d pairs,"
             " exposures within 1 EV and unknown. Errors of M in the corner and of the exponent (slope of the recovered"
             " against the true exposures), as stated. Camera: its bracket, EXIF within %g EV. Lens: Lensfun's profiles"
             " of it, without those of the setting. Refused: no profile is near enough to the setting. Targets are in"
             " brackets. Stated errors should hold for 68 %%." % (PAIRS, TIME_SIGMA_EV), ""]
    lines += header("known", "fits", "lookups refused", "error of M, median", "90 %", "exponents within .9 to 1.1",
                    "scatter of ln γ", "stated", "error of M holds", "error of γ holds", "not usable", "overruled")
    for state in STATES:
        every = [r for r in records if r["state"] == state]
        of = [r for r in every if not r.get("refused")]
        if not of:
            continue
        errors = sorted(r["corner_error"] for r in of)
        middle, logs = statistics.median(errors), [math.log(r["slope"]) for r in of]
        most, least = TARGETS[state]
        slopes = share(of, lambda r: 0.9 <= r["slope"] <= 1.1)
        held = [share(of, lambda r: r["corner_error"] <= r["corner_sigma"]),
                share(of, lambda r: abs(math.log(r["slope"])) <= r["gamma_sigma"])]
        target = "%.0f to %.0f %%" % (100 * HOLDS[0], 100 * HOLDS[1])
        lines.append(row(
            state, len(of), len(every) - len(of), beside(middle, "%.4f", "%g" % most, middle <= most),
            "%.4f" % errors[int(0.9 * len(errors))],
            beside(100 * slopes, "%.0f %%", "%.0f %%" % (100 * least), slopes >= least),
            "%.3f" % statistics.pstdev(logs), "%.3f" % statistics.median(r["gamma_sigma"] for r in of),
            *(beside(100 * h, "%.0f %%", target, HOLDS[0] <= h <= HOLDS[1]) for h in held),
            count(of, lambda r: not r["usable"]), count(of, lambda r: r["prior"].endswith("OVERRULED"))))
    return lines + [""]


def photographs(records):
    """Registration from pictures alone, by both tools."""
    if not records:
        return []
    lines = ["## From photographs", "", "From pictures to the fit; Hugin's times are for pto_gen, cpfind, cpclean and"
             " autooptimiser, without the fit. Seam: median over the links, levels of 255, after lensprof's fit on each"
             " geometry.", ""]
    lines += header("pictures", "number", "lensprof joined", "Hugin joined", "lensprof wall, s", "Hugin wall, s", "wall ratio", "CPU ratio",
                    "lensprof seam", "Hugin seam", "verdict: usable, equalizes")
    for r in records:
        ours, theirs = r["lensprof"], r.get("hugin", {})
        lines.append(row(r["name"], r["pictures"], ours["joined"], theirs.get("joined", "–"), number(ours["wall_s"]),
                         number(theirs.get("wall_s")), number(ratio_of(ours, theirs, "wall_s")),
                         number(ratio_of(ours, theirs, "cpu_s")), number(ours.get("seam")), number(theirs.get("seam")),
                         "%s, %s" % (ours.get("usable"), ours.get("equalizes"))))
    return lines + [""]


def moving(records):
    """Pictures of a moving camera: exposures compared with EXIF's, which the fit did not get."""
    if not records:
        return []
    lines = ["## A camera that moved", "", "Exposures from pictures alone (`build FOLDER --fit exif-sigma=0`) compared with"
             " those of EXIF: correlation, slope, standard deviation of the difference.", ""]
    lines += header("pictures", "number", "joined", "EXIF spans, EV", "correlation", "slope", "difference, EV", "wall, s",
                    "verdict: usable, equalizes")
    for r in records:
        lines.append(row(r["name"], r["pictures"], r.get("joined", "–"), number(r.get("exif_ev")), number(r.get("correlation")),
                         number(r.get("slope")), number(r.get("off_ev")), number(r["wall_s"]),
                         "%s, %s" % (r.get("usable"), r.get("equalizes"))))
    return lines + [""]


def of_frames(records):
    """Registration of frames and views."""
    if not records:
        return []
    lines = ["## Frames of a camera that turns or moves", "", "`build` on rendered pictures: CPU time of its registration,"
             " per picture, and of the whole command; CPU time of COLMAP's feature_extractor and sequential_matcher.", ""]
    lines += header("pictures", "number", "joined", "links", "registration CPU, s", "CPU per picture, s", "whole CPU, s",
                    "memory, MB", "COLMAP CPU, s")
    for r in records:
        registered = sum(r["steps"].values())
        lines.append(row(r["name"], r["pictures"], r["joined"], r["links"], number(registered),
                         number(registered / r["pictures"]), number(r["cpu_s"]), number(r["peak_mb"]),
                         number(r.get("colmap_cpu_s"))))
    return lines + [""]


def ratio_of(ours, theirs, key):
    return ours[key] / theirs[key] if theirs.get(key) else None


def document(results):
    from card_tables import cards
    from form_tables import forms
    from reconstruction_tables import tables
    from trial_tables import trials
    from verdict_tables import verdicts
    from video_tables import video
    lines = ["# Benchmark", "", results["machine"], ""]
    if results["skipped"]:
        lines += ["**SKIPPED: %s**" % results["skipped"], ""]
    if results["points"] or results["pictures"]:
        lines += [READING.format(jobs=results["jobs"]), ""]
    lines += accuracy("Pairs given: 6 images, as in figure 1 of d'Angelo 2007", "Noise of 2 levels.", results["points"],
                      COSTS[:1])
    lines += accuracy("From pictures", "6 pictures of 800 x 600, 50 degrees wide, 40 % overlap, exposures within 1 EV,"
                      " noise of 2 levels, unless the case states otherwise.", results["pictures"], COSTS)
    lines += targets(results["pictures"]) + refused(results["refusals"]) + verdicts(results["verdicts"])
    lines += flat(results["flat"]) + cards(results["cards"]) + forms(results["forms"]) + trials(results["trials"])
    lines += static(results["static"]) + sweep(results["sweep"]) + timelapse(results["timelapse"])
    lines += video(results["video"]) + scale(results["scale"]) + speed(results["speed"])
    lines += radiance(results["radiance"]) + knowledge(results["knowledge"]) + real(results["real"])
    lines += photographs(results["photographs"]) + moving(results["moving"]) + of_frames(results["frames"])
    lines += tables(results["reconstruction"])
    lines += gallery(results["real"]) + brackets(results["brackets"])
    return "\n".join(lines).rstrip() + "\n"
