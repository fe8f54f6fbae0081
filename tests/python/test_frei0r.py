#!/usr/bin/env python3
"""The frei0r plug-in in FFmpeg: 300 frames are those that the library gives, and errors leave frames unchanged.

usage: test_frei0r.py PLUGIN      exit 77: FFmpeg with its filter frei0r, or NumPy, is missing
LENSPROF_LIBRARY and PYTHONPATH as for tests/python.
"""

import os
import pathlib
import subprocess
import sys
import tempfile

WIDTH, HEIGHT, FRAMES = 160, 96, 300


def skip(why):
    print(f"test_frei0r: skipped: {why}")
    sys.exit(77)


try:
    import lensprof as lp
    import numpy as np
except ImportError as error:
    skip(error)


def filtered(frames, plugin, parameters):
    """Frames after the filter, and what was printed."""
    command = ["ffmpeg", "-hide_banner", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgba", "-s", f"{WIDTH}x{HEIGHT}",
               "-i", "-", "-vf", f"frei0r=lensprof:{parameters}", "-f", "rawvideo", "-pix_fmt", "rgba", "-"]  # fmt: skip
    done = subprocess.run(command, input=frames.tobytes(), capture_output=True,
                          env={**os.environ, "FREI0R_PATH": str(plugin.parent)})  # fmt: skip
    assert done.returncode == 0, done.stderr.decode()
    return np.frombuffer(done.stdout, np.uint8).reshape(-1, HEIGHT, WIDTH, 4), done.stderr.decode()


def main():
    plugin = pathlib.Path(sys.argv[1]).resolve()
    try:
        if b"frei0r" not in subprocess.run(["ffmpeg", "-hide_banner", "-filters"], capture_output=True).stdout:
            skip("FFmpeg has no filter frei0r")
    except FileNotFoundError:
        skip("ffmpeg is not installed")
    frames = np.random.default_rng(1).integers(0, 256, (FRAMES, HEIGHT, WIDTH, 4), np.uint8)
    key = lp.ProfileKey(camera_model="One", lens="A 35 mm", focal_mm=35, aperture=2)
    linear = lp.Profile(key=key, vignetting=lp.Vignetting(k=(-0.35, 0.12, -0.08)))
    measured = lp.Profile(key=key, response=lp.Response.from_emor([0.8, -0.4]), vignetting=linear.vignetting[0])
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for name, profile in (("linear.json", linear), ("measured.json", measured)):
            lp.formats.write_profiles(name, [profile])
        pathlib.Path("not.json").write_text("{}")
        for parameters, profile, response, strength in (
            ("linear.json", linear, lp.Response.srgb(), 1),
            ("linear.json|2.2", linear, lp.Response.from_gamma(2.2), 1),
            ("measured.json", measured, measured.response[0], 1),
            ("measured.json|profile|0.5", measured, measured.response[0], 0.5),
            ("measured.json|srgb|1", measured, lp.Response.srgb(), 1),
        ):
            wanted = lp.Profile(key=key, response=response, vignetting=profile.vignetting[0])
            found, said = filtered(frames, plugin, parameters)
            assert not said, said
            for before, after in zip(frames, found, strict=True):
                assert np.array_equal(after, lp.correct(before, wanted, strength=strength)), parameters
        for parameters, text in (
            ("nowhere.json", "nowhere.json: cannot be read; give the file of a profile"),
            ("not.json", "lensprof: not.json: "),
            ("linear.json|loud", "response loud: is unknown; use profile, srgb, or an exponent"),
            ("linear.json|-1", "response -1: is unknown"),
        ):
            found, said = filtered(frames[:5], plugin, parameters)
            assert said.count("lensprof: ") == 1 and text in said, said
            assert np.array_equal(found, frames[:5]), parameters
    print(f"test_frei0r: {FRAMES} frames, five sets of parameters, four errors")


if __name__ == "__main__":
    main()
