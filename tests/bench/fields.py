"""One shading of many pictures: lensprof compared with BaSiC (basicpy) and the median picture, on made fields.

Every set is one shading, one offset, and pictures of different scenes and levels, with the noise of a 16 bit camera;
the figure is the RMS over the frame of the shading over its mean, from the truth. BaSiC runs with its defaults, with
its dark field, with sorted intensities, and with both (not with 200 pictures); the best of them counts, chosen by the
truth. Even seeds were used to develop the method (--tune), odd ones are reported.

`make bench-fields` runs it with basicpy in an environment of its own. Without basicpy its figures are missing. Tables go to standard output, all figures to build/bench/fields.json.
"""
import argparse
import json
import pathlib
import time
import warnings

import numpy as np

import lensprof as lp

try:
    import torch
    from basicpy import BaSiC
    torch.set_num_threads(1)
except ImportError:
    BaSiC = None

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SIZES = [(256, 256), (240, 320), (300, 400), (200, 256)]
KINDS = {"sparse": "bright cells on a dark background", "confluent": "bright cells that cover most of the frame",
         "tissue": "stained tissue over 60 to 90 %, bright field", "slide": "dark things on a bright background",
         "dense": "structure everywhere, no background"}
SHADINGS = ["centred", "off-centre", "ring", "ridge", "tilted"]
VARIANTS = {"basic": {}, "basic dark": {"get_darkfield": True}, "basic sort": {"sort_intensity": True},
            "basic dark sort": {"get_darkfield": True, "sort_intensity": True}}
MANY = 100  # pictures beyond which only the first two variants run


def shading(kind, shape, draw):
    """Positive, mean 1."""
    half = 0.5 * np.hypot(*shape)
    y, x = ((np.mgrid[0:shape[0], 0:shape[1]].T + 0.5 - np.array(shape) / 2) / half).T
    some = lambda size: draw.uniform(-size, size)
    depth = draw.uniform(0.2, 0.55)
    if kind == "centred":
        light = 1 - depth * (x**2 + y**2)**draw.uniform(0.8, 1.4)
    elif kind == "off-centre":
        u, v = draw.uniform(0.15, 0.4) * draw.choice([-1, 1]), some(0.35)
        light = np.exp(-depth * 1.6 * ((x - u)**2 * draw.uniform(0.7, 1.3) + (y - v)**2))
    elif kind == "ring":
        r = np.hypot(x - some(0.1), y - some(0.1))
        light = 1 - depth * 0.7 * r**2 + 0.06 * np.exp(-0.5 * ((r - draw.uniform(0.45, 0.6)) / 0.06)**2)
    elif kind == "ridge":
        turn = draw.uniform(0, np.pi)
        u, v = x * np.cos(turn) + y * np.sin(turn), -x * np.sin(turn) + y * np.cos(turn)
        light = 1 - depth * 0.6 * (u**2 + v**2) - 0.08 * np.tanh((u - some(0.2)) / 0.07) + 0.1 * v
    else:
        light = 1 + depth * 0.6 * x + some(0.25) * y - depth * 0.5 * (x - some(0.2))**2 - 0.15 * x * y
    return light / light.mean()


def texture(shape, slope, draw):
    """A random field with the spectrum f^-slope, mean 0 and standard deviation 1."""
    f = np.hypot(*np.meshgrid(np.fft.fftfreq(shape[0]), np.fft.rfftfreq(shape[1]), indexing="ij"))
    wave = (draw.normal(size=f.shape) + 1j * draw.normal(size=f.shape)) / np.maximum(f, 2 / max(shape))**slope
    wave[0, 0] = 0
    field = np.fft.irfft2(wave, s=shape)
    return field / field.std()


def blobs(shape, count, size, draw):
    """So many soft ellipses in the frame, and as densely about it: its edges are like its middle."""
    out, edge = np.zeros(shape), 3 * size
    for _ in range(int(count * (shape[0] + 2 * edge) * (shape[1] + 2 * edge) / (shape[0] * shape[1]))):
        cy, cx = draw.uniform(-edge, shape[0] + edge), draw.uniform(-edge, shape[1] + edge)
        (ry, rx), turn, height = draw.lognormal(np.log(size), 0.3, 2), draw.uniform(0, np.pi), draw.lognormal(0, 0.5)
        reach = 3 * max(ry, rx)
        rows = slice(max(0, int(cy - reach)), max(0, min(shape[0], int(cy + reach))))
        columns = slice(max(0, int(cx - reach)), max(0, min(shape[1], int(cx + reach))))
        if rows.start >= rows.stop or columns.start >= columns.stop:
            continue
        y, x = np.mgrid[rows, columns]
        u = (x - cx) * np.cos(turn) + (y - cy) * np.sin(turn)
        v = -(x - cx) * np.sin(turn) + (y - cy) * np.cos(turn)
        out[rows, columns] += height / (1 + np.exp(np.minimum(6 * (np.hypot(u / rx, v / ry) - 1), 50)))
    return out


def content(kind, shape, draw):
    if kind == "sparse":
        return 1 + 3 * blobs(shape, draw.lognormal(np.log(40), 0.6), min(shape) / 40, draw) * draw.lognormal(0, 0.4)
    if kind == "confluent":
        cells = blobs(shape, draw.lognormal(np.log(260), 0.3), min(shape) / 28, draw)
        return 0.3 + cells * np.exp(0.2 * texture(shape, 1.5, draw))
    if kind == "tissue":
        cover, mask = draw.uniform(0.6, 0.9), texture(shape, 2.0, draw)
        inside = 1 / (1 + np.exp(-(mask - np.quantile(mask, 1 - cover)) / 0.03))
        stain = 0.55 * np.exp(0.25 * texture(shape, 1.2, draw) + 0.1 * draw.normal())
        return 1 - inside * (1 - np.clip(stain, 0.05, 0.98))
    if kind == "slide":
        return np.exp(-0.5 * blobs(shape, draw.lognormal(np.log(80), 0.5), min(shape) / 22, draw))
    return np.exp(0.3 * texture(shape, 1.3, draw))


def make(kind, shade, count, seed):
    """-> (pictures, shading, offset). Fluorescence uses 2 % of the range."""
    draw = np.random.default_rng([seed, list(KINDS).index(kind), SHADINGS.index(shade)])
    shape = SIZES[seed % len(SIZES)]
    truth = shading(shade, shape, draw)
    bright = kind in ("tissue", "slide")
    light, spread, gain, read = (20000, 0.12, 3.0, 20) if bright else (400, 0.3, 0.5, 3)
    offset = draw.uniform(500, 1500) if bright else draw.uniform(80, 200)
    pictures = []
    for _ in range(count):
        signal = light * draw.lognormal(0, spread) * truth * content(kind, shape, draw)
        values = gain * draw.poisson(signal / gain) + draw.normal(0, read, shape) + offset
        pictures.append(np.clip(np.rint(values), 0, 65535).astype(np.uint16))
    return np.array(pictures), truth, offset


def rms(found, truth):
    return float(np.sqrt(np.mean((found / found.mean() - truth)**2)))


def ours(pictures, truth, offset):
    result = lp.fit_fields(pictures, lp.FieldsOptions(threads=1))
    y, x = np.mgrid[0:truth.shape[0], 0:truth.shape[1]].astype(float)
    found = result.shading.eval(truth.shape[1], truth.shape[0], x, y, 0)
    channel = result.channel[0]
    return {"lensprof": rms(found, truth), "stated": channel.shading_error, "offset": channel.offset * 65535 - offset,
            "offset_sigma": channel.offset_sigma * 65535, "offset_found": channel.offset_found,
            "usable": result.usable}


def smoothed(picture):
    from scipy import ndimage
    return ndimage.gaussian_filter(picture, 0.05 * max(picture.shape), mode="nearest")


def basic(pictures, **options):
    from skimage.transform import resize
    fit = BaSiC(**options)
    fit.fit(pictures.astype(np.float32))
    field = np.asarray(fit.flatfield)
    return field if field.shape == pictures.shape[1:] else resize(field, pictures.shape[1:], mode="edge")


def compare(pictures, truth, offset):
    row, start = {}, time.perf_counter()
    row.update(ours(pictures, truth, offset), lensprof_s=time.perf_counter() - start)
    median = np.median(pictures, 0)
    row.update({"median": rms(median, truth), "median smoothed": rms(smoothed(median), truth)})
    for name, options in list(VARIANTS.items())[:2 if len(pictures) > MANY else None] if BaSiC else ():
        start = time.perf_counter()
        row[name] = rms(basic(pictures, **options), truth)
        row[name + "_s"] = time.perf_counter() - start
    return row


def table(rows):
    """A line per kind of scene and number of pictures: medians over the sets, and how often lensprof is the best."""
    print("\n| scenes | pictures | lensprof | best of BaSiC | BaSiC | median | median, smoothed | lensprof best | s | BaSiC, s |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for kind in KINDS:
        for count in sorted({row["count"] for row in rows}):
            these = [row for row in rows if row["kind"] == kind and row["count"] == count]
            if not these:
                continue
            best = [min((row[name] for name in VARIANTS if name in row), default=np.nan) for row in these]
            others = [min(b if b == b else np.inf, row["median"], row["median smoothed"]) for b, row in zip(best, these)]
            of = lambda name: np.median([row.get(name, np.nan) for row in these])
            won = sum(row["lensprof"] < other for row, other in zip(these, others))
            figures = [of("lensprof"), np.median(best), of("basic"), of("median"), of("median smoothed")]
            print(f"| {kind} | {count} | " + " | ".join(f"{100 * value:.2f}" for value in figures)
                  + f" | {won} of {len(these)} | {of('lensprof_s'):.1f} | {of('basic_s'):.1f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tune", action="store_true", help="even seeds")
    parser.add_argument("--sets", type=int, default=3, help="per kind of scene")
    parser.add_argument("--counts", default="10,40,200")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    counts, rows = [int(word) for word in options.counts.split(",")], []
    for number in range(options.sets):
        for index, kind in enumerate(KINDS):
            shade, seed = SHADINGS[(number + index) % len(SHADINGS)], 2 * number + (not options.tune)
            pictures, truth, offset = make(kind, shade, max(counts), seed)
            for count in counts:
                rows.append({"kind": kind, "shading": shade, "seed": seed, "count": count,
                             **compare(pictures[:count], truth, offset)})
                print({name: round(value, 5) if isinstance(value, float) else value
                       for name, value in rows[-1].items()}, flush=True)
    folder = ROOT / "build" / "bench"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "fields.json").write_text(json.dumps(rows, indent=1))
    table(rows)


if __name__ == "__main__":
    main()
