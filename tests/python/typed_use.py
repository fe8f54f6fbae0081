"""Uses the package with types, for `mypy --strict`; it is checked and run.

Each `type: ignore` is an error that mypy must find: without it, mypy refuses the comment as unused. This shows that the
types are those of the package and not Any.
"""
from __future__ import annotations

import datetime
import pathlib
import sys
from typing import Iterator, Optional

import numpy as np
import numpy.typing as npt

import lensprof as lp
from lensprof import formats


def on_step(step: str, done: float) -> Optional[bool]:
    return bool(step) and done > 2.0


def exposures(calibration: lp.Calibration) -> npt.NDArray[np.float64]:
    values: npt.NDArray[np.float64] = calibration.exposures["ev"]
    return values


def frames(files: list[pathlib.Path]) -> Iterator[npt.NDArray[np.generic]]:
    for file in files:
        yield lp.read_picture(file).pixels


def curves(profile: lp.Profile) -> npt.NDArray[np.float64]:
    middle: float = profile.response[0].eval(0.5)
    falloff: npt.NDArray[np.float64] = profile.vignetting[0].eval(np.linspace(0.0, middle, 5))
    r2: float = profile.vignetting[0].r2(640, 480, 3.0, 4)
    camera = lp.Camera(width=640, height=480, hfov_deg=50.0, projection=lp.Projection.RECTILINEAR)
    xy: npt.NDArray[np.float64] = camera.project([0.0, 0.1], r2)
    return np.concatenate([falloff, xy[0]])


def files_of_others(folder: pathlib.Path, profile: lp.Profile) -> tuple[bool, str, formats.Format]:
    formats.write_profiles(folder / "p.json", [profile], covariance=True)
    read: list[formats.ReadProfile] = formats.read_profiles(folder / "p.json", strict=True)
    usable: bool = read[0].usable
    created: Optional[datetime.datetime] = read[0].profile.provenance.created
    return usable, "unknown" if created is None else created.isoformat(), formats.detect((folder / "p.json").read_bytes())


def mistakes(store: lp.Store, scene: lp.Scene, profile: lp.Profile, picture: lp.Picture) -> None:
    """Never called."""
    store.get("1")  # type: ignore[arg-type]
    store.get(1).key.lens + 1  # type: ignore[operator]
    with lp.Store("p.db") as opened:
        opened.get(1).colour  # type: ignore[attr-defined]
    scene.calibrate(max_side="400")  # type: ignore[arg-type]
    scene.calibrate(colour=True)  # type: ignore[call-arg]
    lp.calibrate("photos", times="fast")  # type: ignore[arg-type]
    lp.correct_file("a.jpg", None, "b.jpg", exposure="mean")  # type: ignore[arg-type]
    formats.write_profiles("a.json", 5)  # type: ignore[arg-type]
    profile.response[0].eval(b=0.5)  # type: ignore[call-overload]
    profile.provenance.created = 5  # type: ignore[assignment]
    profile.key.processing = "RAW"  # type: ignore[assignment]
    picture.metadata.captured.year  # type: ignore[union-attr]
    lp.fit_overlap([], [1, 2])  # type: ignore[arg-type]


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
    timed: lp.Calibration = lp.calibrate(frames([folder / name for name in names]), names=sorted(names), max_side=200,
                                         times=[1 / 60] * len(names),
                                         metadata=[lp.PictureMetadata(f_number=8.0)] * len(names))
    print(timed.equalizes, curves(profile), files_of_others(folder, profile))
    print(width, usable, findings, lens, iso, len(encoded), written, again.key.lens, exposures(calibration).sum())
    return 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
