#!/usr/bin/env python3
"""Clips of a moving camera (clips.py): `lensprof calibrate CLIP` with and without exposure times, and the method of
Bergmann, Wang & Cremers 2018 (bergmann.py) on the same frames, compared with the truth.

    video.py render CASE SEED FOLDER [PHOTOGRAPHS]   writes clip.mp4 (VP9: clip.webm), times.txt and truth.json
    video.py score FOLDER OUTPUT                     the errors of an output folder of `lensprof calibrate`
    video.py cases
"""
import csv
import json
import pathlib
import shutil
import sys
import time

import numpy as np

import clips
import tools

SMOOTH = 25  # frames over which drift is averaged
LOWEST, HIGHEST = 8, 250  # grey levels of the error of the response
RADII = np.linspace(0.0, 1.0, 101)
QUICK = ("pan", "room")
CASES = {"pan": {}, "pan, crf 20": {"crf": 20}, "pan, HEVC, 10 bits": {"codec": "HEVC 10 bit"},
         "pan, HEVC, 10 bits, crf 20": {"codec": "HEVC 10 bit", "crf": 20}, "pan, VP9": {"codec": "VP9"},
         "pan, VP9, crf 20": {"codec": "VP9", "crf": 20}, "pan, S curve": {"response": "S curve"},
         "pan, corner 0.35": {"k": (-0.9, 0.25, 0.0)}, "pan, corner 0.8": {"k": (-0.15, -0.05, 0.0)},
         "pan, 0.5 EV": {"range": 0.5}, "pan, fixed exposure": {"range": 0.0}, "pan, noise of 3 levels": {"noise": 3.0},
         "pan of 1 px per frame": {"speed": 1.0}, "pan, 2000 frames": {"frames": 2000}, "room": {"scene": "room"},
         "room, crf 20": {"scene": "room", "crf": 20}, "room, S curve": {"scene": "room", "response": "S curve"},
         "room, corner 0.35": {"scene": "room", "k": (-0.9, 0.25, 0.0)}, "room, 0.5 EV": {"scene": "room", "range": 0.5},
         "room, fixed exposure": {"scene": "room", "range": 0.0}, "room, noise of 3 levels": {"scene": "room", "noise": 3.0}}


def settings(case):
    return dict(clips.USUAL, **CASES[case])


def rms(x):
    return float(np.sqrt(np.mean(np.square(x))))


def exponent_of(ev, truth, g):
    """G, by which recovered exposures are too large: their slope, or of fixed exposures that of the inverse response."""
    t = np.array(truth["ev"])
    if np.ptp(t) > 0.05:
        known = np.isfinite(ev)
        value = np.polyfit(t[known], ev[known], 1)[0]
    else:
        levels = np.arange(20, 236)
        light = np.interp(levels / 255.0, clips.RESPONSES[truth["response"]](clips.FINE), clips.FINE)
        value = np.polyfit(np.log(light), np.log(np.maximum(g[levels] / g[255], 1e-9)), 1)[0]
    return float(value) if np.isfinite(value) and value > 1e-3 else 1.0


def response_error(g, response):
    """Largest and RMS error of f(scale * g), levels, at the scale with the least squares."""
    levels = np.arange(LOWEST, HIGHEST + 1)
    light, table = np.asarray(g, float)[levels] / g[255], clips.RESPONSES[response](clips.FINE)
    errors = [255 * np.interp(light * scale, clips.FINE, table) - levels for scale in np.geomspace(0.4, 2.5, 1401)]
    best = min(errors, key=lambda e: np.mean(e ** 2))
    return float(np.abs(best).max()), rms(best)


def errors(truth, ev, fall, g, exponent):
    """After removing an exponent and the mean of the exposures. fall: falloff at RADII; g: f^-1 at 0..255. ev_decoded: of
    the exposures as the codec left them, which smooths their jitter."""
    off = ev / exponent - np.array(truth["ev"])
    known = np.isfinite(off)
    off = off[known] - off[known].mean()
    decoded = off - np.array(truth.get("encoding", np.zeros(len(ev))))[known]
    even = np.convolve(off, np.full(SMOOTH, 1 / SMOOTH), "valid")
    fall = np.maximum(fall / fall[0], 1e-6) ** (1 / exponent)
    largest, of_levels = response_error(np.power(np.maximum(g / g[255], 0), 1 / exponent), truth["response"])
    return {"ev": rms(off), "ev_decoded": float(decoded.std()), "ev_largest": float(np.abs(off).max()), "drift": float(np.ptp(even)),
            "falloff": float(np.abs(fall - clips.falloff(truth["k"], RADII ** 2)).max()), "response": largest,
            "response_rms": of_levels}


def score(truth, ev, fall, g):
    """Errors as stated (raw), and after the exponent that fits the exposures best (aligned)."""
    ev, g = np.asarray(ev, float), np.asarray(g, float)
    exponent = exponent_of(ev, truth, g)
    return {"exponent": exponent, "without_ev": int((~np.isfinite(ev)).sum()), "raw": errors(truth, ev, fall, g, 1.0),
            "aligned": errors(truth, ev, fall, g, exponent)}


def by_radius(picture):
    """Falloff at RADII of a picture of it: means of rings."""
    r = np.sqrt(clips.radius2(picture.shape)).ravel()
    ring = np.minimum(np.rint(r * 200).astype(int), 200)
    count, total = np.bincount(ring, minlength=201), np.bincount(ring, picture.ravel(), 201)
    at = np.bincount(ring, r, 201)[count > 0] / count[count > 0]
    return np.interp(RADII, at, total[count > 0] / count[count > 0])


def score_output(truth, out):
    """The files that `lensprof calibrate CLIP -o out` writes."""
    import cv2
    with open(out / "exposures.csv") as file:
        rows = list(csv.DictReader(file))
    ev = np.full(len(truth["ev"]), np.nan)
    for row in rows:
        if row["ev"] and int(row["frame"]) <= len(ev):
            ev[int(row["frame"]) - 1] = float(row["ev"])
    fall = cv2.imread(str(out / "vignette.png"), cv2.IMREAD_UNCHANGED)
    fall = by_radius((fall if fall.ndim == 2 else fall[..., 1]) / 65535.0)
    g = np.array((out / "pcalib.txt").read_text().split(), float)[:256]
    return dict(score(truth, ev, fall, g), segments=len({row["segment"] for row in rows if row["ev"]}))


def run_lensprof(clip, truth, out, times):
    words = ["--times", times] if times else []
    used = tools.measured([tools.LENSPROF, "calibrate", clip, "-o", out, "--no-store", "--json", *words], clip.parent, out)
    used.pop("out")
    if (out / "exposures.csv").exists() and (out / "pcalib.txt").exists():
        used.update(score_output(truth, out))
    return used


def measure(case, seed, photographs, peer):
    import cv2
    cv2.setNumThreads(1)  # so that the peer's seconds of processor time are of one thread
    folder = tools.WORK / "video"
    shutil.rmtree(folder, ignore_errors=True)
    c = settings(case)
    clip, truth = clips.render(c, seed, folder, photographs)
    record = {"case": case, "seed": seed, "frames": c["frames"], "kilobytes": clip.stat().st_size // 1024, "encoding": float(np.std(truth["encoding"])),
              "times": run_lensprof(clip, truth, folder / "times", folder / "times.txt"),
              "alone": run_lensprof(clip, truth, folder / "alone", None)}
    if peer:
        start = time.process_time()
        ev, fast, fall, g = peer(clip, RADII)
        seconds = time.process_time() - start
        record["bergmann"] = dict(score(truth, ev, fall, g), cpu_s=seconds, fast=score(truth, fast, fall, g)["aligned"]["ev"])
    shutil.rmtree(folder)
    return record


def photographs_of(real):
    """The folder of photographs of --real DIR, if there is one."""
    folder = pathlib.Path(real or "") / "src_pano"
    return folder if real and any(folder.glob("*.jpg")) else None


def run_all(real, quick, tune, match, say):
    if not tools.OPENCV or not clips.FFMPEG:
        say("video: SKIPPED: " + (tools.NO_OPENCV if not tools.OPENCV else "no ffmpeg (package ffmpeg)"))
        return {}
    import bergmann
    photographs, records = photographs_of(real), []
    for case in CASES:
        if (match not in case) if match else (quick and case not in QUICK):
            continue
        for seed in ((11, 12) if tune else (1,) if quick else (1, 2)):
            records.append(measure(case, seed, photographs, bergmann.calibrate))
            say("video %s %d: %s" % (case, seed, records[-1]))
    return {"photographs": bool(photographs), "cases": records}


def main(words):
    if words[:1] == ["render"] and len(words) in (4, 5) and words[1] in CASES:
        clip, _ = clips.render(settings(words[1]), int(words[2]), words[3], *words[4:])
        print(clip)
    elif words[:1] == ["score"] and len(words) == 3:
        truth = json.loads((pathlib.Path(words[1]) / "truth.json").read_text())
        print(json.dumps(score_output(truth, pathlib.Path(words[2])), indent=1))
    elif words == ["cases"]:
        print("\n".join(CASES))
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main(sys.argv[1:])
