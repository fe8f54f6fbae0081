"""The experiment of Kim & Pollefeys 2004, section 3.1: frames of a stationary camera, exposures unknown, aligned to the
brightest. Error: RMS difference from it, summed over the channels, on pixels without a sample at 0 or 255. Compared
with the true response and exposures (only rounding remains), and with Debevec & Malik 1997 (debevec.py), given the true
exposures. Own scenes and curves, because the paper's 20 curves of DoRF are not freely available."""
import json
import shutil
import struct
import subprocess
import zlib

import numpy as np

import debevec
import tools

WIDTH, HEIGHT, FRAMES = 320, 240, 4
CURVES = {"linear": lambda x: x, "gamma 2.2": lambda x: x ** (1 / 2.2),
          "sRGB": lambda x: np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.maximum(x, 1e-9) ** (1 / 2.4) - 0.055),
          "film": lambda x: 1.15 * x ** 1.2 / (x ** 1.2 + 0.15)}
METHODS = ("transfer", "transfer-function")
GRID = np.linspace(0.0, 1.0, 4096)


def write_png(path, picture):
    rows = np.concatenate([np.zeros((HEIGHT, 1), np.uint8), picture.reshape(HEIGHT, -1)], 1)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8, 2, 0, 0, 0))
                     + chunk(b"IDAT", zlib.compress(rows.tobytes(), 1)) + chunk(b"IEND", b""))


def unfiltered(kind, line, above):
    """One row of a PNG, 3 bytes per pixel."""
    if kind == 0 or kind == 2:
        return line + (above if kind == 2 else np.uint8(0))
    out = np.zeros((WIDTH + 1, 3), int)
    up, line = np.vstack([np.zeros((1, 3), int), above.reshape(-1, 3)]), line.reshape(-1, 3).astype(int)
    for x in range(1, WIDTH + 1):
        a, b, c = out[x - 1], up[x], up[x - 1]
        pa, pb, pc = abs(b - c), abs(a - c), abs(a + b - 2 * c)
        paeth = np.where((pa <= pb) & (pa <= pc), a, np.where(pb <= pc, b, c))
        out[x] = (line[x - 1] + (a if kind == 1 else (a + b) // 2 if kind == 3 else paeth)) % 256
    return out[1:].astype(np.uint8).reshape(-1)


def read_png(path):
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        packed += data[at + 8:at + 8 + size] if kind == b"IDAT" else b""
        at += 12 + size
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(HEIGHT, 1 + 3 * WIDTH)
    out, above = [], np.zeros(3 * WIDTH, np.uint8)
    for row in rows:
        above = unfiltered(row[0], row[1:], above)
        out.append(above)
    return np.array(out).reshape(HEIGHT, WIDTH, 3)


def make(curve, seed, noise):
    """-> frames and their exposures in EV. The scene: cosines of random frequencies over about six EV."""
    random = np.random.default_rng([seed, 5])
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    light = np.zeros((HEIGHT, WIDTH, 3))
    for _ in range(12):
        u, v, phase = random.normal(0, 0.04), random.normal(0, 0.04), random.uniform(0, 6.28)
        light += np.cos(u * x + v * y + phase)[..., None] * (0.5 + 0.15 * random.normal(size=3))
    light = 0.18 * np.exp(0.8 * light)
    ev = 0.8 - np.concatenate([[0.0], np.cumsum(random.uniform(0.4, 1.2, FRAMES - 1))])
    frames = []
    for e in ev:
        seen = light * 2.0 ** e
        grey = 255 * CURVES[curve](np.clip(seen, 0, 1)) + noise * random.normal(size=seen.shape) * (seen < 1)
        frames.append(np.clip(np.round(grey), 0, 255).astype(np.uint8))
    return frames, ev


def error(frames, aligned):
    """Error of the frames aligned to the first, compared with the first."""
    total = count = 0
    for source, after in zip(frames[1:], aligned[1:]):
        good = ((source > 0) & (source < 255) & (frames[0] > 0) & (frames[0] < 255)).all(2)
        total += ((after[good].astype(float) - frames[0][good]) ** 2).sum()
        count += good.sum()
    return float(np.sqrt(total / max(count, 1)))


def by_curve(frames, ev, f, g):
    """Frames aligned to the first by a response (f on GRID) and its inverse (g at 256 levels)."""
    tables = [np.clip(np.round(255 * np.interp(np.clip(g * 2.0 ** (ev[0] - e), 0, 1), GRID, f)), 0, 255) for e in ev]
    return [table[frame] for table, frame in zip(tables, frames)]


def by_truth(frames, ev, curve):
    f = CURVES[curve](GRID)
    return by_curve(frames, ev, f, np.interp(np.arange(256) / 255, f, GRID))


def by_debevec(frames, ev):
    g = debevec.response_of(frames, ev)
    return by_curve(frames, ev, np.interp(GRID, g, np.arange(256) / 255), g)


def by_lensprof(folder, method):
    files = [str(folder / ("f%d.png" % i)) for i in range(FRAMES)]
    out = folder / method
    ran = subprocess.run([tools.LENSPROF, "align", "--json", "--fit", f"method={method}", "--to", "first", "-o", str(out), *files],
                         stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    if ran.returncode != 0:
        return None, ran.returncode
    json.loads(ran.stdout)
    return [read_png(out / ("f%d.png" % i)) for i in range(FRAMES)], 0


def measure(curve, seed, noise):
    folder = tools.WORK / "static"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    frames, ev = make(curve, seed, noise)
    for i, frame in enumerate(frames):
        write_png(folder / ("f%d.png" % i), frame)
    record = {"curve": curve, "seed": seed, "noise": noise, "truth": error(frames, by_truth(frames, ev, curve))}
    for method in METHODS:
        aligned, code = by_lensprof(folder, method)
        record[method] = error(frames, aligned) if aligned else None
        if code:
            record["code of " + method] = code
    record["debevec"] = error(frames, by_debevec(frames, ev))
    return record


def run_all(quick, say):
    records = []
    for seed in (1,) if quick else (1, 2, 3):
        for curve in CURVES:
            for noise in (0, 2):
                say("static: %s, seed %d, noise %d" % (curve, seed, noise))
                records.append(measure(curve, seed, noise))
    return records
