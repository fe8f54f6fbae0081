#!/usr/bin/env python3
"""What every platform must give alike, as exercised.txt has it: prints a line of each result, with a hash of its bytes.

Corrections, blobs, integer plans and files are the same bytes everywhere; numbers of a fit are printed to as many places as
the mathematical functions of the systems agree.
"""

import hashlib
import os
import sys
import tempfile

import numpy as np

import lensprof as lp

FALLOFF = lp.Vignetting(k=(-0.35, 0.12, -0.08))


def digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:16]


def profile() -> lp.Profile:
    key = lp.ProfileKey(camera_maker="Canon", camera_model="EOS R5", lens="RF 35 mm", focal_mm=35, aperture=1.8,
                        crop_factor=1)
    return lp.Profile(key=key, response=lp.Response.from_gamma(2.2), vignetting=FALLOFF)


def picture(dtype: type) -> np.ndarray:
    samples = (np.arange(240 * 180 * 3, dtype=np.uint64) * 2654435761 >> 7) % (np.iinfo(dtype).max + 1)
    return samples.astype(dtype).reshape(180, 240, 3)


def fit() -> str:
    """Exposures of three pictures of one scene."""
    response = lp.Response.from_gamma(2.2)
    cameras = [lp.Camera(width=240, height=180, hfov_deg=45, yaw_deg=yaw) for yaw in (0, 16, -16)]
    frames = []
    for camera, ev in zip(cameras, (0.0, 0.8, -0.6)):
        y, x = np.mgrid[0:180, 0:240]
        longitude, latitude = np.moveaxis(camera.unproject(x, y), -1, 0)
        scene = 0.03 + 0.5 * ((np.sin(13 * longitude + 5 * latitude) + np.sin(9 * latitude - 4 * longitude) + 2) / 4) ** 2
        light = scene * FALLOFF.eval(FALLOFF.r2(240, 180, x, y)) * 2.0**ev
        frames.append(np.round(255 * response.eval(np.clip(light, 0, 1))).astype(np.uint8))
    pairs = lp.sample_overlap([lp.SampleImage(frame, camera) for frame, camera in zip(frames, cameras)])
    options = lp.FitOptions(free=lp.Free.FALLOFF, response=response)
    found = lp.fit_overlap([lp.FitImage(i, 240, 180, free=lp.Free.EV) for i in range(3)], pairs, options)
    ev = [found.exposure(i).ev - found.exposure(0).ev for i in range(3)]
    return f"{' '.join(f'{value:+.3f}' for value in ev)} EV of {len(pairs)} pairs, usable {found.usable}"


def main() -> None:
    this = profile()
    print("blob", digest(this.pack()))
    for dtype in (np.uint8, np.uint16):
        print("corrected", dtype.__name__, digest(lp.correct(picture(dtype), this).tobytes()))
    print("lensfun", digest(lp.formats.encode_profiles([this], format=lp.formats.Format.LENSFUN)))
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "Ünïcode 写真.db")
        with lp.Store(path, lp.StoreMode.CREATE) as store:
            store.put(this)
            found, lookup = store.lookup(this.key)
            print("store", digest(found.pack()), "exact" if lookup.exact else "not exact")
    print("fit", fit())
    try:
        lp.Profile.unpack(b"no profile")
    except lp.Error as error:
        print("error", error)
    print(f"lensprof {lp.version()}, Python {sys.version.split()[0]}, NumPy {np.__version__}, {sys.platform}", file=sys.stderr)


if __name__ == "__main__":
    main()
