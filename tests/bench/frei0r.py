#!/usr/bin/env python3
"""Frames per second of the frei0r plug-in in FFmpeg, compared with the pipeline without it, FFmpeg's own filter vignette, and
a loop over liblensfun on a pipe.

usage: frei0r.py PLUGIN LENSFUN_FRAMES TABLE     prints a table, and writes it to the file TABLE

300 frames of 1920 x 1080, RGBA, uncompressed from the page cache to /dev/null, so that neither a decoder nor a disk counts.
Medians of five runs; CPU seconds are those of all processes.
"""

import os
import pathlib
import resource
import shlex
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

import lensprof as lp

WIDTH, HEIGHT, FRAMES, RUNS = 1920, 1080, 300, 5
K = (-0.35, 0.12, -0.08)


def measure(command, environment):
    """Wall and CPU seconds."""
    before, begun = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    subprocess.run(["bash", "-c", f"set -o pipefail; {command}"], check=True, env=environment, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return time.monotonic() - begun, cpu


def main():
    plugin, loop = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    environment = {**os.environ, "FREI0R_PATH": str(plugin.parent)}
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        key = lp.ProfileKey(camera_model="One", lens="A 50 mm", focal_mm=50, aperture=2.8)
        lp.formats.write_profiles("lens.json", [lp.Profile(key=key, vignetting=lp.Vignetting(k=K))])
        frames = np.random.default_rng(1).integers(0, 256, (10, HEIGHT, WIDTH, 4), np.uint8)
        frames.tofile("frames.rgba")
        source = f"ffmpeg -v error -stream_loop {FRAMES // 10 - 1} -f rawvideo -pix_fmt rgba -s {WIDTH}x{HEIGHT} -i frames.rgba"
        sink = "-f rawvideo -pix_fmt rgba -y /dev/null"
        words = f"{shlex.quote(str(loop))} {WIDTH} {HEIGHT} {K[0]} {K[1]} {K[2]}"
        rows = {
            "FFmpeg, no filter": f"{source} {sink}",
            "FFmpeg, frei0r=lensprof, sRGB": f"{source} -vf 'frei0r=lensprof:lens.json|srgb|1' {sink}",
            "FFmpeg, its filter vignette": f"{source} -vf 'vignette=mode=backward' {sink}",
            "FFmpeg, pipe, cat": f"{source} -f rawvideo -pix_fmt rgba - | cat",
            "FFmpeg, pipe, liblensfun": f"{source} -f rawvideo -pix_fmt rgba - | {words}",
        }
        taken = {name: [] for name in rows}
        for _ in range(RUNS):  # in turn, so that all have the same load
            for name, command in rows.items():
                taken[name].append(measure(command, environment))
    first = statistics.median(wall for wall, _ in taken["FFmpeg, no filter"])
    lines = ["| 300 frames 1920 x 1080 | frames/s | time / without a filter | CPU s |", "|---|---|---|---|"]
    for name, runs in taken.items():
        wall, cpu = (statistics.median(values) for values in zip(*runs, strict=True))
        lines.append(f"| {name} | {FRAMES / wall:.0f} | {wall / first:.2f} | {cpu:.1f} |")
    print("\n".join(lines))
    pathlib.Path(sys.argv[3]).write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
