"""Frames of a camera that turns, walks, or is carried around an object: the registration of `build` compared with
COLMAP's sequential matcher.

CPU time per picture of pans of up to 2000 small frames shows whether the cost stays flat. COLMAP finds features and
matches, on the CPU, but no cameras.
"""
import pathlib
import re
import shutil
import subprocess

import numpy as np

import clips
import colmap
import tools
import views

# Pans: frames, width, height, px from frame to frame.
PANS, QUICK = ((120, 640, 360, 12), (100, 320, 180, 6), (500, 320, 180, 6), (1000, 320, 180, 6), (2000, 320, 180, 6)), \
    ((50, 320, 180, 6),)
WALK = "--images 50 --set moving=room --size 405x720 --format jpeg --seed 1"
VIEWS = 120
COLMAP_UP_TO = 120  # pictures; its features of more take too long
FIT_UP_TO = 500  # pictures; of more, the fit takes hours
STEPS = ("looking at neighbours", "finding features", "matching pictures", "matching further pictures", "finding cameras")


def pan(count, width, height, step, folder, photographs):
    """Frames cut from a strip of pictures, with automatic exposure, falloff and noise."""
    import cv2
    folder.mkdir(parents=True)
    random = np.random.default_rng([count, 5])
    high, wide, strip = height + 120, count * step + width + 8, []
    source = clips.pictures(photographs, random)
    while sum(part.shape[1] for part in strip) < wide:
        part = next(source) if count * step < 4000 else clips.painted(random, 1000)  # few photographs: no place twice
        scale = high / part.shape[0]
        strip.append(cv2.resize(part, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA))
    strip = np.concatenate(strip, 1)
    m, value = clips.falloff((-0.45, 0, 0), clips.radius2((height, width)))[..., None], 0.0
    for i in range(count):
        x, y = i * step, 60 + 25 * np.sin(i / 9)
        light = cv2.warpAffine(strip[:, x:x + width + 8], np.float32([[1, 0, 0], [0, 1, -y]]), (width, height)) * m
        value += 0.3 * (np.log2(clips.MEAN / max(light.mean(), 1e-3)) - value)
        levels = np.clip(light * 2 ** (value + random.normal(0, 0.03)), 0, 1) ** (1 / 2.2) * 255
        levels += random.normal(0, 1, light.shape)
        cv2.imwrite(str(folder / ("frame%04d.jpg" % i)), np.clip(levels + 0.5, 0, 255).astype(np.uint8),
                    [cv2.IMWRITE_JPEG_QUALITY, 93])


def walk(folder):
    folder.mkdir(parents=True)
    subprocess.run([tools.LENSPROF, "simulate", "-o", folder, *WALK.split()], check=True, stdout=subprocess.DEVNULL)
    for other in folder.iterdir():
        if other.suffix != ".jpg":
            other.unlink()  # the project and the truth


def seconds_of(text):
    """CPU time of the steps of the registration, from the lines of --verbose."""
    return {step: float(found.group(1)) for step in STEPS
            if (found := re.search(r"^lensprof: %s: [\d.]+ s, CPU ([\d.]+) s$" % step, text, re.M))}


def by_colmap(pictures, folder):
    """CPU seconds of COLMAP's features and matches of neighbours in the sequence."""
    database = folder / "database.db"
    database.unlink(missing_ok=True)
    own = ["--database_path", database]
    steps = [colmap.step(folder, "feature_extractor", *own, "--image_path", pictures, "--ImageReader.single_camera", 1,
                         "--SiftExtraction.use_gpu", 0),
             colmap.step(folder, "sequential_matcher", *own, "--SiftMatching.use_gpu", 0)]
    return sum(used["cpu_s"] for used in steps)


def measure(name, draw, folder):
    """The pictures that draw(folder) writes, unless they are there -> a record."""
    pictures, drawn = folder / "frames", folder / "drawn"
    if not drawn.exists():
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        draw(pictures)
        drawn.touch()
    count = len(list(pictures.iterdir()))
    used = tools.measured([tools.LENSPROF, "build", pictures, "--no-store", "--verbose", "--json"], folder,
                          folder / "lensprof", until="" if count <= FIT_UP_TO else "lensprof: sampling: ")
    text = (folder / "lensprof.err").read_text(errors="replace")
    found = re.search(r"(\d+) pictures overlap \((\d+) links(?: that fit; (\d+) more)?", text)
    record = {"name": name, "pictures": count, "cpu_s": used["cpu_s"] if count <= FIT_UP_TO else None, "peak_mb": used["peak_mb"],
              "steps": seconds_of(text), "joined": int(found.group(1)) if found else 0,
              "links": int(found.group(2)) + int(found.group(3) or 0) if found else 0}
    if colmap.PROGRAM and count <= COLMAP_UP_TO:
        record["colmap_cpu_s"] = by_colmap(pictures, folder)
    return record


def run_all(quick, photographs, match, say):
    """`photographs`: a folder of JPEG to cover scenes with; None: they are painted. `match`: parts of the names of cases,
    separated by commas. Pictures of an earlier run are used."""
    if not tools.OPENCV:
        say("frames: SKIPPED: " + tools.NO_OPENCV)
        return []
    cases = [("pan, %d x %d" % size[1:3], size[0], lambda to, size=size: pan(*size, to, photographs))
             for size in (QUICK if quick else PANS)]
    if not quick:
        cases += [("walk, 405 x 720", 50, walk),
                  ("around an object, 3072 x 2304", VIEWS, lambda to: views.render(VIEWS, 1, to, photographs))]
    records = []
    for name, count, draw in cases:
        if not any(part in "%s, %d" % (name, count) for part in match.split(",")):
            continue
        folder = tools.WORK / "frames" / re.sub(r"\W+", "-", "%s %d%s" % (name, count, "" if photographs else " painted"))
        records.append(measure(name, draw, folder))
        say("frames: %s, %d pictures" % (name, count))
    return records
