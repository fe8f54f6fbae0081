"""Uses the photograph library with types, for `mypy --strict`; it is checked and run."""
from __future__ import annotations

import pathlib
import sys
from typing import Optional

import numpy as np
import numpy.typing as npt

import lensprof as lp


def on_step(step: str, done: float) -> Optional[bool]:
    return bool(step) and done > 2.0


def exposures(calibration: lp.Calibration) -> npt.NDArray[np.float64]:
    values: npt.NDArray[np.float64] = calibration.exposures["ev"]
    return values


def main(folder: pathlib.Path) -> int:
    scene: lp.Scene = lp.Scene.open(folder, progress=on_step)
    names: list[str] = [image.name for image in scene.images]
    width: int = scene.images[0].camera.width
    calibration: lp.Calibration = scene.calibrate(method=lp.Method.TRANSFER)
    usable: bool = calibration.usable
    findings: list[tuple[lp.Severity, str]] = [(finding.severity, finding.text) for finding in calibration.findings]
    profile: lp.Profile = calibration.profiles[0]
    lens: str = profile.key.lens
    calibration.save(folder / "exposures.json")
    read: lp.Calibration = lp.Calibration.read(folder / "exposures.json")
    picture: lp.Picture = lp.read_picture(folder / names[0], max_side=100)
    pixels: npt.NDArray[np.generic] = picture.pixels
    iso: float = picture.metadata.iso
    lp.write_picture(folder / "small.png", pixels, like=picture)
    encoded: bytes = lp.encode_picture(".png", pixels)
    written: int = lp.correct_files([(folder / names[0], folder / "corrected.png")], read, exposure=lp.CopyExposure.KEEP)
    with lp.Store(str(folder / "p.db"), lp.StoreMode.CREATE) as store:
        number: int = store.put(profile)
        again: lp.Profile = store.get(number)
    print(width, usable, findings, lens, iso, len(encoded), written, again.key.lens, exposures(calibration).sum())
    return 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
