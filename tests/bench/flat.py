"""The paper's figure 6 (Goldman & Chen 2005): falloff from a white card compared with that from overlapping pictures.

One simulated lens per seed. The card: three 16 bit linear pictures, rotated by 0, 90 and 180 degrees, under a light
with a gradient, with the noise of the sequence. The sequence: rendered by `lensprof simulate`, measured by `lensprof
build`.
"""
import json
import shutil
import struct
import subprocess
import zlib

import numpy as np

import tools

SEEDS = 6
LENSES = ["-0.30,0.05,-0.15", "-0.45,0.12,-0.06", "-0.70,0.35,-0.10"]
WIDTH, HEIGHT, NOISE_LEVELS, GRADIENT = 640, 480, 2.0, 0.08
RADII = np.linspace(0.0, 1.0, 41)


def falloff(k, r2):
    return 1.0 + k[0] * r2 + k[1] * r2**2 + k[2] * r2**3


def write_png(path, values, bits=16):
    """Values 0..1 of shape (height, width, 3)."""
    rows = np.rint(np.clip(values, 0.0, 1.0) * (2**bits - 1)).astype(">u2" if bits == 16 else np.uint8)
    raw = b"".join(b"\0" + row.tobytes() for row in rows)

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    head = struct.pack(">IIBBBBB", rows.shape[1], rows.shape[0], bits, 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(raw, 1))
                     + chunk(b"IEND", b""))


def card(k, center, turn_deg, seed):
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    half, turn = np.hypot(WIDTH, HEIGHT) / 2, np.radians(turn_deg)
    dx, dy = (x - (WIDTH - 1) / 2) / half, (y - (HEIGHT - 1) / 2) / half
    light = 0.6 * np.exp(GRADIENT * (np.cos(turn) * dx - np.sin(turn) * dy))
    light = light * falloff(k, (dx - center[0])**2 + (dy - center[1])**2)
    noise = np.random.default_rng(seed).normal(0.0, NOISE_LEVELS / 255.0, (HEIGHT, WIDTH, 3))
    return light[:, :, None] + noise


def call(*words):
    done = subprocess.run([tools.LENSPROF, *map(str, words)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    return json.loads(done.stdout) if done.stdout.startswith(b"{") else None


def measure(seed, lens):
    folder = tools.WORK / ("flat%d" % seed)
    shutil.rmtree(folder, ignore_errors=True)
    subprocess.run([tools.LENSPROF, "simulate", "-o", folder, "--seed", str(seed), "--vignetting", lens,
                    "--response", "srgb", "--set", f"center=0.02,-0.015,noise={NOISE_LEVELS}", "--exif"], check=True,
                   stdout=subprocess.DEVNULL)
    truth = json.loads((folder / "truth.json").read_text())["vignetting"]
    names = []
    for turn in (0, 90, 180):
        names.append(folder / ("card%d.png" % turn))
        write_png(names[-1], card(truth["k"][0], truth["center"], turn, 1000 * seed + turn))
    curves = {"card": call("flat", *names, "--linear", "--rotation", "0,90,180", "--no-store", "--json"),
              "sequence": call("build", folder / "pano.pto", "--no-store", "--json")}
    shutil.rmtree(folder)
    record = {"seed": seed, "lens": lens, "usable": {name: bool(c and c["usable"]) for name, c in curves.items()}}
    at = {name: falloff(c["vignetting"]["k"][0], RADII**2) for name, c in curves.items() if c}
    true = falloff(truth["k"][0], RADII**2)
    for name, values in at.items():
        record[name] = float(abs(values - true).max())
    if len(at) == 2:
        record["apart"] = float(abs(at["card"] - at["sequence"]).max())
    return record


def run_all(quick, say):
    records = []
    for seed in range(1, (2 if quick else SEEDS) + 1):
        records.append(measure(seed, LENSES[seed % len(LENSES)]))
        say("flat: seed %d: %s" % (seed, records[-1]))
    return records
