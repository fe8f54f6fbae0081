"""Exposure sweeps of a static scene as calibration records of cameras for visual odometry: `lensprof bracket FOLDER -o`
and responseCalib (response_calib.py) on the same frames. Error: of pcalib.txt, levels of 255 at the levels 8 to 250, at
the best scale, without those below the first of the 1024 samples of a profile's response, up to which it is linear (8 for
a gamma of 2, 14 for 2.4)."""
import shutil
import time

import numpy as np

import response_calib
import tools

WIDTH, HEIGHT = 240, 180
LOWEST, HIGHEST = 8, 250
GRID = np.linspace(0.0, 1.0, 65537)


def s_curve(x):
    """Toe and shoulder, like the extremes of EMoR."""
    return 1.15 * x ** 1.2 / (x ** 1.2 + 0.15)


RESPONSES = {"gamma 1": lambda x: x, "gamma 2": lambda x: x ** 0.5, "gamma 2.4": lambda x: x ** (1 / 2.4),
             "sRGB": lambda x: np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.maximum(x, 1e-9) ** (1 / 2.4) - 0.055),
             "S curve": s_curve}
USUAL = {"response": "gamma 2", "frames": 120, "step": 0.0915, "full": 6000.0, "jpeg": 0, "falloff": 0.4,
         "shuffled": False, "missing": 0.0, "flicker": 0.0, "depth": 8, "colour": False, "repeats": 1}
THIRD, WHOLE = {"step": 1 / 3, "frames": 34}, {"step": 1.0, "frames": 12}
CASES = {"usual": {}, "1/3 EV": THIRD, "1 EV": WHOLE, "gamma 1": {"response": "gamma 1"},
         "gamma 2.4": {"response": "gamma 2.4"}, "sRGB": {"response": "sRGB"}, "S curve": {"response": "S curve"},
         "S curve, 1/3 EV": {"response": "S curve", **THIRD}, "sRGB, 1 EV": {"response": "sRGB", **WHOLE},
         "noise": {"full": 1000.0}, "little noise": {"full": 40000.0}, "JPEG 90": {"jpeg": 90},
         "falloff of 3 stops": {"falloff": 0.875}, "random order": {"shuffled": True},
         "each exposure four times": {"repeats": 4, "frames": 30, "step": 0.38},
         "30 % of exposures missing": {"missing": 0.3}, "flicker of 3 %": {"flicker": 0.03},
         "flicker, sRGB, 1/3 EV": {"flicker": 0.03, "response": "sRGB", **THIRD},
         "16 bit": {"depth": 16}, "colour": {"colour": True, "frames": 60, "step": 0.18}}


def smooth_noise(random, sigma):
    """Texture of about one standard deviation, by a product of Gaussian low passes."""
    fy, fx = np.meshgrid(np.fft.fftfreq(HEIGHT), np.fft.rfftfreq(WIDTH), indexing="ij")
    spectrum = np.fft.rfft2(random.normal(size=(HEIGHT, WIDTH))) * np.exp(-2 * (np.pi * sigma) ** 2 * (fx ** 2 + fy ** 2))
    texture = np.fft.irfft2(spectrum, (HEIGHT, WIDTH))
    return texture / texture.std()


def make(case, seed):
    """-> frames, the exposures of times.txt (NaN: missing)."""
    import cv2
    c = dict(USUAL, **CASES[case])
    random = np.random.default_rng([seed, len(case)])
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    r2 = ((x - (WIDTH - 1) / 2) ** 2 + (y - (HEIGHT - 1) / 2) ** 2) / ((WIDTH ** 2 + HEIGHT ** 2) / 4)
    scene = 0.5 * np.exp(0.9 * smooth_noise(random, 3.0)) * (1 - c["falloff"] * r2)
    scene = scene[..., None] * (np.array([0.6, 1.0, 0.8]) if c["colour"] else np.ones(1))
    times = 0.06 * 2.0 ** (c["step"] * np.arange(c["frames"]))
    times = np.repeat(times, c["repeats"])
    if c["shuffled"]:
        times = random.permutation(times)
    frames = []
    for t in times:
        light = scene * (t / 6.0) * (1 + random.uniform(-c["flicker"], c["flicker"]))
        light = light + random.normal(size=light.shape) * np.sqrt(light / c["full"] + 1e-7)
        value = RESPONSES[c["response"]](np.clip(light, 0, 1))
        top = 2 ** c["depth"] - 1
        frame = np.clip(np.round(top * value), 0, top).astype(np.uint16 if c["depth"] == 16 else np.uint8)
        if c["jpeg"]:
            frame = cv2.imdecode(cv2.imencode(".jpg", frame, [cv2.IMWRITE_JPEG_QUALITY, c["jpeg"]])[1], 0)[..., None]
        frames.append(frame)
    return frames, np.where(random.uniform(size=len(times)) < c["missing"], np.nan, times), c


def write(folder, frames, times, c):
    import cv2
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "images").mkdir(parents=True)
    lines = ["# name time exposure_ms"]
    for i, (frame, t) in enumerate(zip(frames, times)):
        end, how = (".jpg", [cv2.IMWRITE_JPEG_QUALITY, c["jpeg"]]) if c["jpeg"] else (".png", [])
        cv2.imwrite(str(folder / "images" / ("%05d%s" % (i, end))), frame, how)
        lines.append("%05d %.6f" % (i, 1.5e9 + 0.05 * i) + ("" if np.isnan(t) else " %.6f" % t))
    (folder / "times.txt").write_text("\n".join(lines) + "\n")


def read_pcalib(path):
    """As DSO reads it: 256 values, strictly increasing, rescaled to 0..255."""
    g = np.array(path.read_text().splitlines()[0].split(), float).astype(np.float32)
    if len(g) != 256 or not (np.diff(g) > 0).all():
        raise ValueError("DSO refuses %s" % path)
    return 255.0 * (g - g[0]) / (g[255] - g[0])


def level_error(g, response):
    """RMS and largest error, levels."""
    lowest = max(LOWEST, int(np.ceil(255 * response(np.array(1 / 1023)))))
    levels = np.arange(lowest, HIGHEST + 1)
    light = np.maximum(np.asarray(g, float)[levels] / g[255], 0.0)
    errors = [255 * np.interp(light * scale, GRID, response(GRID)) - levels for scale in np.geomspace(0.5, 2.0, 1401)]
    best = min(errors, key=lambda e: np.mean(e ** 2))
    return float(np.sqrt(np.mean(best ** 2))), float(np.abs(best).max())


def measure(case, seed):
    folder = tools.WORK / "sweep"
    frames, times, c = make(case, seed)
    write(folder, frames, times, c)
    record = {"case": case, "seed": seed, "frames": len(frames)}
    out = folder / "calibration"
    used = tools.measured([tools.LENSPROF, "bracket", folder, "-o", out, "--no-store", "--json"], folder,
                          folder / "lensprof")
    record.update(code=used["code"], cpu_s=used["cpu_s"], peak_mb=used["peak_mb"])
    if used["code"] == 0:
        record["rms"], record["largest"] = level_error(read_pcalib(out / "pcalib.txt"), RESPONSES[c["response"]])
    if c["depth"] == 8 and not c["colour"]:  # all that responseCalib reads; frames without an exposure it skips
        known = ~np.isnan(times)
        start = time.process_time()
        g = response_calib.inverse_response(np.array(frames)[known, ..., 0], times[known])
        record["engel_cpu_s"] = time.process_time() - start
        record["engel_rms"], record["engel_largest"] = level_error(g, RESPONSES[c["response"]])
        record["engel_accepted"] = bool((np.diff(g) > 0).all())
    shutil.rmtree(folder)
    return record


def run_all(quick, tune, match, say):
    if not tools.OPENCV:
        say("sweep: SKIPPED: " + tools.NO_OPENCV)
        return []
    records = []
    for case in CASES:
        if match and match not in case:
            continue
        for seed in ((11, 12) if tune else (1,) if quick else (1, 2)):
            records.append(measure(case, seed))
            say("sweep %s %d: %s" % (case, seed, records[-1]))
    return records
