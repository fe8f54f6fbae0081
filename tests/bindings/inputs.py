#!/usr/bin/env python3
"""Inputs of the bindings' tests and what the Python package, which has tests of its own, makes of them.

usage: inputs.py FOLDER

Writes blobs, a database with a name that is not ASCII, a tile of 8 bit and a frame of 16 bit RGB, both corrected, and
the line that a lookup prints. The lens's falloff is stored at two apertures; the lookup asks for one between them.
"""
import pathlib
import struct
import sys
import zlib

import numpy as np

import lensprof

FRAME, TILE = (64, 48), (5, 3, 40, 30)  # width and height; x, y, width and height: px


def profile_at(aperture: float, k1: float) -> lensprof.Profile:
    profile = lensprof.Profile()
    profile.key.camera_maker, profile.key.camera_model, profile.key.lens = "Acme", "Ä 1", "Objektiv 50mm ƒ/1.8 ÄÖ"
    profile.key.focal_mm, profile.key.aperture, profile.key.crop_factor = 50.0, aperture, 1.5
    profile.key.distance_m = 10.0
    profile.response = lensprof.Response.from_gamma(2.2)
    profile.vignetting = lensprof.Vignetting(k=(k1, 0.05, -0.1), center=(0.02, -0.01))
    return profile


def write_blobs(folder: pathlib.Path, blob: bytes) -> None:
    newer = blob[:4] + struct.pack("<H", 99) + blob[6:-4]  # a layout of the future, with its own sum
    (folder / "profile.blob").write_bytes(blob)
    (folder / "newer.blob").write_bytes(newer + struct.pack("<I", zlib.crc32(newer)))
    (folder / "truncated.blob").write_bytes(blob[:-7])
    (folder / "empty.blob").write_bytes(b"")


def write_tile(folder: pathlib.Path, blob: bytes) -> None:
    x, y, width, height = TILE
    pixels = np.random.default_rng(7).integers(0, 256, (height, width, 3), dtype=np.uint8)
    (folder / "tile.rgb").write_bytes(pixels.tobytes())
    options = lensprof.ApplyOptions(frame_width=FRAME[0], frame_height=FRAME[1])
    options.blob = blob
    lensprof.Plan(options).apply(pixels, pixels, x0=x, y0=y)
    (folder / "corrected.rgb").write_bytes(pixels.tobytes())


def write_frame(folder: pathlib.Path, blob: bytes) -> None:
    width, height = FRAME
    pixels = np.random.default_rng(8).integers(0, 65536, (height, width, 3), dtype=np.uint16)
    (folder / "frame.rgb16").write_bytes(pixels.tobytes())
    (folder / "corrected.rgb16").write_bytes(lensprof.correct(pixels, lensprof.Profile.unpack(blob)).tobytes())


def write_database(folder: pathlib.Path) -> None:
    name = folder / "Objektive ß 鏡.db"
    with lensprof.Store(name, lensprof.StoreMode.CREATE) as store:
        for aperture, k1 in ((1.8, -0.5), (4.0, -0.2)):
            store.put(profile_at(aperture, k1))
        key = profile_at(2.8, 0.0).key
        key.crop_factor = key.distance_m = lensprof.UNKNOWN
        profile, how = store.lookup(key)
    falloff, _ = profile.corner_falloff(channel=1)
    line = (f"{profile.key.lens}, {profile.key.focal_mm:.1f} mm, f/{profile.key.aperture:.1f}: corner {falloff:.4f}, "
            f"profiles {how.rows}, exact {int(how.exact)}\n")
    (folder / "lookup.txt").write_text(line, encoding="utf-8")


def main() -> None:
    folder = pathlib.Path(sys.argv[1])
    blob = profile_at(2.8, -0.35).pack()
    write_blobs(folder, blob)
    write_tile(folder, blob)
    write_frame(folder, blob)
    write_database(folder)


if __name__ == "__main__":
    main()
