#!/usr/bin/env python3
"""The frei0r plug-in in FFmpeg: 300 frames are those that the library gives, and errors leave frames unchanged.

usage: test_frei0r.py PLUGIN      exit 77: FFmpeg with its filter frei0r, or NumPy, is missing
LENSPROF_LIBRARY and PYTHONPATH as for tests/python.
"""

import ctypes
import os
import pathlib
import shutil
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


def set_every_frame(plugin, before, after):
    """Video programs set the parameters before every frame: the profile is read when it changes only."""
    library = ctypes.CDLL(str(plugin))
    library.f0r_construct.restype = ctypes.c_void_p
    instance = ctypes.c_void_p(library.f0r_construct(WIDTH, HEIGHT))
    profile = pathlib.Path("once.json")
    shutil.copy("linear.json", profile)
    for is_there in (True, False):
        for index, text in ((0, b"once.json"), (1, b"srgb")):
            library.f0r_set_param_value(instance, ctypes.byref(ctypes.c_char_p(text)), index)
        library.f0r_set_param_value(instance, ctypes.byref(ctypes.c_double(1)), 2)
        out = np.zeros_like(before)
        library.f0r_update(instance, ctypes.c_double(0), before.ctypes.data_as(ctypes.c_void_p),
                           out.ctypes.data_as(ctypes.c_void_p))  # fmt: skip
        assert np.array_equal(out, after), is_there
        profile.unlink(missing_ok=True)
    library.f0r_destruct(instance)


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
        pathlib.Path("empty.json").touch()
        newer = bytearray(linear.pack())
        newer[8] += 1  # its version
        pathlib.Path("newer.blob").write_bytes(newer)
        for parameters, profile, response, strength in (
            ("linear.json", linear, lp.Response.srgb(), 1),
            ("linear.json|2.2", linear, lp.Response.from_gamma(2.2), 1),
            (r"linear.json|2\,2", linear, lp.Response.from_gamma(2.2), 1),
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
            ("linear.json|2.2.2", "response 2.2.2: is unknown"),
            ("linear.json|1e9", "response 1e9: is unknown"),
            ("linear.json|99", "response 99: is unknown"),
            ("linear.json|srgb|nan", "strength"),
            ("newer.blob", "lensprof: newer.blob: "),
            ("empty.json", "lensprof: empty.json: "),
        ):
            found, said = filtered(frames[:5], plugin, parameters)
            assert said.count("lensprof: ") == 1 and text in said, (parameters, said)
            assert np.array_equal(found, frames[:5]), parameters
        set_every_frame(plugin, frames[0], lp.correct(frames[0], lp.Profile(key=key, response=lp.Response.srgb(),
                                                                            vignetting=linear.vignetting[0])))  # fmt: skip
    print(f"test_frei0r: {FRAMES} frames, six sets of parameters, ten errors, parameters set for every frame")


if __name__ == "__main__":
    main()
