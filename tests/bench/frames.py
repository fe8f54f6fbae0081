"""Frames of a camera that turns slowly: the registration of `build` compared with COLMAP's sequential matcher.

Times per picture show whether the cost stays flat. COLMAP finds features and matches, on the CPU, but no cameras.
"""
import pathlib
import re
import shutil
import subprocess

import colmap
import tools

COUNTS, QUICK = (100, 500), (20,)
STEPS = ("finding features", "matching pictures", "matching further pictures", "finding cameras")
RENDERED = "--size 640x360 --format jpeg --seed 1 --set overlap=0.97 --set hfov=50"


def seconds_of(text):
    """Wall time of the steps of the registration, from the lines of --verbose."""
    return {step: float(found.group(1)) for step in STEPS
            if (found := re.search(r"^lensprof: %s: ([\d.]+) s$" % step, text, re.M))}


def by_colmap(pictures, folder):
    """CPU seconds of COLMAP's features and matches of neighbours in the sequence."""
    database = folder / "database.db"
    database.unlink(missing_ok=True)
    own = ["--database_path", database]
    steps = [colmap.step(folder, "feature_extractor", *own, "--image_path", pictures, "--ImageReader.single_camera", 1,
                         "--SiftExtraction.use_gpu", 0),
             colmap.step(folder, "sequential_matcher", *own, "--SiftMatching.use_gpu", 0)]
    return sum(used["cpu_s"] for used in steps)


def measure(count, folder):
    """`count` frames -> a record."""
    shutil.rmtree(folder, ignore_errors=True)
    pictures = folder / "frames"
    pictures.mkdir(parents=True)
    subprocess.run([tools.LENSPROF, "simulate", "-o", pictures, "--images", str(count), *RENDERED.split()], check=True,
                   stdout=subprocess.DEVNULL)
    for other in pictures.iterdir():
        if other.suffix != ".jpg":
            other.unlink()  # the project and the truth
    used = tools.measured([tools.LENSPROF, "build", pictures, "--no-store", "--verbose", "--json"], folder,
                          folder / "lensprof")
    steps = seconds_of(pathlib.Path(folder / "lensprof.err").read_text(errors="replace"))
    found = re.search(r"(\d+) pictures overlap \((\d+) links", (folder / "lensprof.err").read_text(errors="replace"))
    record = {"pictures": count, "cpu_s": used["cpu_s"], "peak_mb": used["peak_mb"], "steps": steps,
              "joined": int(found.group(1)) if found else 0, "links": int(found.group(2)) if found else 0}
    if colmap.PROGRAM:
        record["colmap_cpu_s"] = by_colmap(pictures, folder)
    return record


def run_all(quick, say):
    records = []
    for count in QUICK if quick else COUNTS:
        records.append(measure(count, tools.WORK / "frames" / str(count)))
        say("frames: %d pictures" % count)
    return records
