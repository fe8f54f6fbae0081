"""Timelapses with flicker: `lensprof deflicker`, FFmpeg's deflicker filter, and a script that levels the mean of encoded
luma, as most public programs do, on the same rendered frames. What remains is measured on places that do not change, in
linear light: steps from frame to frame, and how far the light of the scene is missed."""
import shutil
import subprocess
import time

import numpy as np

import tools

FFMPEG = shutil.which("ffmpeg")
EXIFTOOL = shutil.which("exiftool")
SMOOTH = 15  # frames before and after, of the script's mean


def srgb(e):
    e = np.clip(e, 0, 1)
    return np.where(e <= 0.0031308, 12.92 * e, 1.055 * e ** (1 / 2.4) - 0.055)


def s_curve(e):
    return 1.15 * np.clip(e, 0, 1) ** 1.2 / (np.clip(e, 0, 1) ** 1.2 + 0.15)


def inverse(encode):
    grid = np.linspace(0, 1, 65537)
    return lambda value: np.interp(value, encode(grid), grid)


USUAL = {"size": (480, 270), "frames": 90, "flicker": 0.07, "encode": srgb, "format": "jpg", "people": 0, "noise": 8000.0,
         "dusk": 0.0, "jump": 0.0, "shake": 0.0, "colour": 0.0}
CASES = {"aperture flicker of .07 EV": {}, "dusk of 6 EV, camera in thirds": {"dusk": -6.0, "flicker": 0.05},
         "dawn of 3 EV, camera in thirds": {"dusk": 3.0, "flicker": 0.05}, "exposure to and fro by 1.3 EV": {"jump": 1.3},
         "a crowd": {"people": 14}, "noise": {"noise": 600.0}, "16 bit PNG": {"format": "png"},
         "white balance": {"colour": 0.06}, "S curve": {"encode": s_curve, "flicker": 0.2},
         "wind, .5 px": {"shake": 0.5}, "1500 frames": {"size": (192, 108), "frames": 1500, "people": 2}}


def texture(random, size, sigma):
    import cv2
    w, h = size
    t = cv2.GaussianBlur(random.normal(size=(h + 8, w + 8)), (0, 0), sigma)
    return t / t.std()


def make(case, seed, folder):
    """Writes the frames -> the truth: log2 of exposure and light of each, and the settings."""
    import cv2
    c = dict(USUAL, **CASES[case])
    random = np.random.default_rng([seed, len(case)])
    w, h = c["size"]
    n = c["frames"]
    y, x = np.mgrid[0:h, 0:w].astype(float)
    r2 = ((x - (w - 1) / 2) ** 2 + (y - (h - 1) / 2) ** 2) / ((w * w + h * h) / 4)
    ground = 0.17 * np.exp(0.45 * texture(random, c["size"], 3.0))
    colours = np.dstack([np.exp(0.15 * texture(random, c["size"], 6.0))[4:4 + h, 4:4 + w] for _ in range(3)])
    light = np.linspace(0, c["dusk"], n)
    settings = np.round(-light * 3) / 3
    ev = settings + random.normal(0, c["flicker"], n)
    if c["jump"]:
        ev += np.where(np.arange(n) % 3 == 0, 0.7, -0.6) * c["jump"] / 1.3
    folder.mkdir(parents=True)
    for i in range(n):
        scene = ground
        if c["shake"]:
            dx, dy = c["shake"] * np.sin(i * 2.1), c["shake"] * np.cos(i * 1.3)
            scene = cv2.warpAffine(ground, np.float32([[1, 0, dx - 4], [0, 1, dy - 4]]), (w, h))
        else:
            scene = ground[4:4 + h, 4:4 + w]
        clouds = sum(0.25 * np.exp(-((x - ((j * 140 + i * 2.2) % (w + 200) - 100)) ** 2 / 60 ** 2
                                     + (y - 0.18 * h - 15 * j) ** 2 / 18 ** 2)) for j in range(4))
        scene = np.where(y < 0.55 * h, 0.35 + 0.25 * (1 - y / h) + clouds, scene)
        for p in range(c["people"]):
            at = (p * 97 + i * (5 + p % 5)) % w
            scene = np.where((abs(x - at) < 0.02 * w) & (abs(y - 0.75 * h) < 0.09 * h), 0.02 + 0.3 * (p % 2), scene)
        scene = scene * (1 - 0.4 * r2) * 2.0 ** (ev[i] + light[i])
        tint = np.array([1 - c["colour"] * np.sin(1.1 * i), 1, 1 + c["colour"] * np.sin(1.7 * i)])
        e = scene[..., None] * colours * tint
        e = e + random.normal(size=e.shape) * np.sqrt(np.maximum(e, 0) / c["noise"] + 1e-7)
        value = c["encode"](e)
        name = str(folder / ("f%05d.%s" % (i, c["format"])))
        if c["format"] == "png":
            cv2.imwrite(name, (value * 65535 + 0.5).astype(np.uint16))
        else:
            cv2.imwrite(name, (value * 255 + 0.5).astype(np.uint8), [cv2.IMWRITE_JPEG_QUALITY, 92])
    if c["dusk"] and EXIFTOOL:
        table = folder.parent / "exif.csv"
        rows = ["SourceFile,Make,Model,ExposureTime,ISO,FNumber,DateTimeOriginal"]
        rows += ["%s/f%05d.jpg,Test,Timelapse,%.8f,100,8,2026:01:01 17:%02d:%02d" % (folder, i, 2.0 ** settings[i] / 250,
                                                                                  i // 6, i % 6 * 10) for i in range(n)]
        table.write_text("\n".join(rows) + "\n")
        subprocess.run([EXIFTOOL, "-q", "-n", "-overwrite_original", "-csv=%s" % table, folder], check=True)
    return ev, light, c


def remaining(folder, names, truth_light, c):
    """Steps from frame to frame and range of the brightness of the ground in linear light, beyond the wanted light."""
    import cv2
    linear = inverse(c["encode"])
    places, w, h = [], *c["size"]
    for name in names:
        picture = cv2.imread(str(folder / name), cv2.IMREAD_UNCHANGED)
        value = picture[int(0.6 * h):, :, 1] / (65535.0 if picture.dtype == np.uint16 else 255.0)
        places.append(cv2.blur(linear(value), (9, 9))[4::9, 4::9])
    steps = []
    for a, b in zip(places, places[1:]):
        good = (a > 0.002) & (b > 0.002) & (a < 0.8) & (b < 0.8)
        steps.append(np.median(np.log2(b[good] / a[good])))
    steps = np.array(steps) - np.diff(truth_light)
    level = np.concatenate([[0.0], np.cumsum(steps)])
    return {"largest_step": float(np.abs(steps).max()), "rms_step": float(np.sqrt((steps ** 2).mean())),
            "range": float(np.ptp(level))}


def by_script(source, target, names):
    """Levels the mean of encoded luma to its running mean."""
    import cv2
    pictures = [cv2.imread(str(source / name), cv2.IMREAD_UNCHANGED) for name in names]
    means = np.array([picture.mean() for picture in pictures])
    for i, (name, picture) in enumerate(zip(names, pictures)):
        wanted = means[max(i - SMOOTH, 0):i + SMOOTH + 1].mean()
        top = np.iinfo(picture.dtype).max
        out = np.clip(picture * (wanted / means[i]) + 0.5, 0, top).astype(picture.dtype)
        cv2.imwrite(str(target / name), out, [cv2.IMWRITE_JPEG_QUALITY, 95])


def by_ffmpeg(source, target, c):
    subprocess.run([FFMPEG, "-loglevel", "error", "-y", "-framerate", "25", "-i", str(source / ("f%05d." + c["format"])),
                    "-vf", "deflicker=size=%d:mode=am" % (2 * SMOOTH - 1), "-start_number", "0", "-q:v", "1",
                    str(target / ("f%05d." + c["format"]))], check=True, stdout=subprocess.DEVNULL)


def measure(case, seed):
    work = tools.WORK / "timelapse"
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    source = work / "frames"
    _, light, c = make(case, seed, source)
    names = ["f%05d.%s" % (i, c["format"]) for i in range(c["frames"])]
    record = {"case": case, "seed": seed, "frames": c["frames"], "before": remaining(source, names, light, c)}
    used = tools.measured([tools.LENSPROF, "deflicker", source, "-o", work / "own", "--json"], work, work / "lensprof")
    record.update(code=used["code"], cpu_s=used["cpu_s"], peak_mb=used["peak_mb"])
    if used["code"] == 0:
        record["lensprof"] = remaining(work / "own", names, light, c)
    (work / "script").mkdir()
    start = time.process_time()
    by_script(source, work / "script", names)
    record["script"] = dict(remaining(work / "script", names, light, c), cpu_s=time.process_time() - start)
    if FFMPEG:
        (work / "ffmpeg").mkdir()
        by_ffmpeg(source, work / "ffmpeg", c)
        record["ffmpeg"] = remaining(work / "ffmpeg", names, light, c)
    shutil.rmtree(work)
    return record


def large(say):
    """Frames of 24 megapixels: the share of decoding, reading all frames twice and encoding them once."""
    import cv2
    work = tools.WORK / "timelapse"
    shutil.rmtree(work, ignore_errors=True)
    (work / "frames").mkdir(parents=True)
    random = np.random.default_rng(5)
    base = cv2.resize(np.exp(0.5 * texture(random, (1500, 1000), 2.0))[:1000, :1500], (6000, 4000))
    count = 10
    for i in range(count):
        value = 255 * srgb(0.17 * base * 2 ** random.normal(0, 0.07)) + random.normal(0, 1, base.shape)
        cv2.imwrite(str(work / "frames" / ("f%d.jpg" % i)), np.dstack([np.clip(value, 0, 255).astype(np.uint8)] * 3),
                    [cv2.IMWRITE_JPEG_QUALITY, 92])
    record = {"frames": count}
    for name, words in (("copies", []), ("table", ["--write", "csv"])):
        used = tools.measured([tools.LENSPROF, "deflicker", work / "frames", "-o", work / name, "--json", *words], work,
                              work / name)
        record[name] = {"cpu_s": used["cpu_s"] / count, "peak_mb": used["peak_mb"]}
    start = time.process_time()
    pictures = [cv2.imread(str(work / "frames" / ("f%d.jpg" % i))) for i in range(2)]
    record["decode_cpu_s"] = (time.process_time() - start) / 2
    start = time.process_time()
    for picture in pictures:
        cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, 92, cv2.IMWRITE_JPEG_OPTIMIZE, 1])
    record["encode_cpu_s"] = (time.process_time() - start) / 2
    shutil.rmtree(work)
    say("timelapse: 24 megapixels: %s" % record)
    return record


def run_all(quick, match, say):
    if not tools.OPENCV:
        say("timelapse: SKIPPED: " + tools.NO_OPENCV)
        return {}
    records = []
    for case in CASES:
        if match and match not in case:
            continue
        for seed in ((1,) if quick else (1, 2)):
            records.append(measure(case, seed))
            say("timelapse %s %d: %s" % (case, seed, records[-1]))
    return {"cases": records, "large": {} if quick or match else large(say)}
