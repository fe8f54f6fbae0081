#!/usr/bin/env python3
"""exercise_photo.py FOLDER: calibrates a folder of pictures and writes copies, with what pip installs alone. The light in
the corner is that of a build with the libraries of Debian 12, 0.665."""

import sys

import lensprof as lp

calibration = lp.calibrate(sys.argv[1])
light = calibration.profiles[0].vignetting[0].eval(1.0)
assert calibration.usable and abs(light - 0.665) < 0.02, (calibration.usable, light)
picture = lp.read_picture(sys.argv[1] + "/img000.png")
lp.write_picture("copy.jpg", picture.pixels, like=picture)
lp.write_picture("copy.tif", picture.pixels, like=picture)
assert (lp.read_picture("copy.tif").pixels == picture.pixels).all()
assert lp.read_picture("copy.jpg").metadata.key.lens == "Simulated Lens"
print(f"calibrated {len(calibration.exposures)} pictures, light in the corner {light:.3f}")
