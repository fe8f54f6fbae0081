"""How time and memory of lensprof grow with the number of images: mosaics of a narrow lens, 100 pairs per image, given
as a point file. One turn per size, without a peer (vig_optimize takes minutes from 61 images on, see Speed)."""
import shutil
import subprocess
import time

import scorer
import tools

SIZES, QUICK_SIZES = (10, 30, 100, 300, 1000, 2000), (10, 30, 100)
PAIRS_AN_IMAGE = 100
MOSAIC = "--set no-images=yes --seed 1 --set hfov=4,overlap=0.4,jitter=0.1,ev=0.5,mean-ev=-1,outliers=0.1"


def measure(images):
    folder = tools.WORK / "scale" / str(images)
    shutil.rmtree(folder, ignore_errors=True)
    rows = max(1, round((images / 1.25) ** 0.5))  # about as high as wide, in degrees
    began = time.perf_counter()
    subprocess.run([tools.LENSPROF, "simulate", "-o", str(folder), *MOSAIC.split(), "--images", str(images),
                    "--set", f"rows={rows},points={PAIRS_AN_IMAGE * images},test-points=2000"], check=True,
                   stdout=subprocess.DEVNULL)
    record = {"images": images, "simulate_s": time.perf_counter() - began}
    used, model = tools.run_lensprof(str(folder / "pano.pto"), str(folder / "lensprof"),
                                     ["--points", str(folder / "points.txt")])
    used.pop("timeless", None)
    record.update(used)
    if model:
        truth, pairs = scorer.read_truth(folder / "truth.json"), scorer.read_points(folder / "test_points.txt")
        sizes = tools.sizes_of_pto((folder / "pano.pto").read_text())
        record.update(scorer.score(truth, model, pairs, sizes))
    return record


def run_all(quick, say):
    records = []
    for images in QUICK_SIZES if quick else SIZES:
        say("scale: %d images" % images)
        records.append(measure(images))
    return records
