#!/usr/bin/env python3
"""Measures lensprof and its peers; see run.sh."""
import argparse
import json
import os
import sys
import time

import cards
import cases
import falloff_forms
import flat
import gallery
import radiance
import frames
import photographs
import real
import reconstruction
import report
import scale
import speed
import static
import sweep
import timelapse
import tools
import trials
import verdicts
import video

PARTS = ("points", "pictures", "refusals", "verdicts", "flat", "cards", "forms", "trials", "static", "sweep", "timelapse",
         "video", "scale", "speed", "radiance", "knowledge", "photographs", "frames-registration", "reconstruction", "real")


def parse():
    p = argparse.ArgumentParser(description="Measures lensprof compared with Hugin's vig_optimize.", prog="run.sh")
    p.add_argument("--quick", action="store_true", help="few cases, under three minutes")
    p.add_argument("--real", metavar="DIR", help="also real pictures: pano.pto, hugin.pto and brackets below DIR")
    p.add_argument("--only", default=",".join(PARTS), help="parts, separated by commas: " + ", ".join(PARTS))
    p.add_argument("--match", metavar="TEXT", default="",
                   help="only accuracy cases with TEXT in the name of their row; verdicts, cards, trials: one kind, or one case"
                        " such as smooth 17; reconstruction: sets, separated by commas: terrain, room, drone, and real"
                        " ones; frames-registration: parts of names, separated by commas: walk, object")
    p.add_argument("--repeat", type=int, default=5, help="turns of the speed measurement")
    p.add_argument("--jobs", type=int, default=min(2, os.cpu_count() or 1), help="parallel cases (accuracy only)")
    p.add_argument("--sequences", type=int, metavar="N", help="sequences of the part knowledge (default 60, quick 20)")
    p.add_argument("--tune", action="store_true",
                   help="knowledge: the half of the lenses used to choose constants; verdicts, cards, trials: other seeds")
    p.add_argument("--keep", action="store_true", help="keep the rendered pictures")
    options = p.parse_args()
    options.only = options.only.split(",")
    if set(options.only) - set(PARTS):
        p.error("--only: use " + ", ".join(PARTS))
    if options.real and not (real.projects_below(options.real) or photographs.moving(options.real) or
                             video.photographs_of(options.real)):
        p.error("--real %s: holds no pano.pto or hugin.pto, no reconstruction, and no src_pano" % options.real)
    return options


def main():
    options, start = parse(), time.time()
    if not os.access(tools.LENSPROF, os.X_OK):
        sys.exit("run.sh: %s: program not found; run `make` first" % tools.LENSPROF)

    def say(text):
        print("[%4d s] %s" % (time.time() - start, text), file=sys.stderr, flush=True)

    tools.WORK.mkdir(parents=True, exist_ok=True)
    skipped = "" if tools.VIG_OPTIMIZE else "vig_optimize (package hugin-tools) is missing; only lensprof is measured"
    results = {"schema": 1, "machine": tools.version_line(), "jobs": options.jobs, "quick": options.quick,
               "points": [], "pictures": [], "refusals": [], "flat": [], "static": [], "sweep": [], "timelapse": {},
               "video": {}, "scale": [], "speed": {},
               "verdicts": {}, "cards": {}, "forms": {}, "trials": {}, "radiance": {}, "knowledge": [],
               "photographs": [], "moving": [], "frames": [], "reconstruction": {},
               "real": [], "brackets": [], "skipped": skipped}
    if skipped:
        say("SKIPPED: " + skipped)
    if "speed" in options.only:
        results["speed"] = speed.run_all(options.quick, options.repeat, say)
    if "radiance" in options.only:
        results["radiance"] = radiance.run_all(options.quick, say)
    if "scale" in options.only:
        results["scale"] = scale.run_all(options.quick, say)
    if "static" in options.only:
        results["static"] = static.run_all(options.quick, say)
    if "timelapse" in options.only:
        results["timelapse"] = timelapse.run_all(options.quick, options.match, say)
    if "video" in options.only:
        results["video"] = video.run_all(options.real, options.quick, options.tune, options.match, say)
    if "sweep" in options.only:
        results["sweep"] = sweep.run_all(options.quick, options.tune, options.match, say)
    for part, of in (("points", cases.point_cases), ("pictures", cases.picture_cases),
                     ("refusals", cases.refusal_cases)):
        if part in options.only:
            chosen = of(options.quick, options.match)
            results[part] = cases.run_all(chosen, options.match, options.jobs, options.keep, say)
    if "verdicts" in options.only:
        results["verdicts"] = verdicts.run_all(options.quick, options.tune, options.jobs, options.keep, say,
                                               options.match)
    if "flat" in options.only:
        results["flat"] = flat.run_all(options.quick, say)
    if "cards" in options.only:
        results["cards"] = cards.run_all(options.quick, options.tune, options.jobs, options.keep, say, options.match)
    if "forms" in options.only:
        results["forms"] = falloff_forms.run_all(options.real, options.quick, say)
    if "trials" in options.only:
        results["trials"] = trials.run_all(options.quick, options.tune, options.jobs, options.keep, say, options.match)
    if "knowledge" in options.only:
        import knowledge  # needs the library in addition to the program
        results["knowledge"] = knowledge.run_all(options.sequences or (20 if options.quick else 60), options.tune,
                                                 options.jobs, say)
    if "frames-registration" in options.only:
        results["frames"] = frames.run_all(options.quick, video.photographs_of(options.real), options.match, say)
    if "photographs" in options.only:
        results["photographs"] = photographs.run_all(options.real, options.quick, say)
        results["moving"] = photographs.run_moving(options.real, say)
    if "reconstruction" in options.only:
        results["reconstruction"] = reconstruction.run_all(options.real, options.quick, options.match, options.keep,
                                                            say)
    if options.real and "real" in options.only:
        results["real"] = real.run_all(options.real, options.jobs, say)
        results["brackets"] = gallery.run_brackets(options.real, say)
    results["seconds"] = time.time() - start
    text = report.document(results)
    (tools.WORK / "results.json").write_text(json.dumps(results, indent=1) + "\n")
    (tools.WORK / "benchmarks.md").write_text(text)
    print(text, end="")
    say("done; figures in %s" % (tools.WORK / "results.json"))


if __name__ == "__main__":
    main()
