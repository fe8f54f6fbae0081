"""Differences between the colours of a point in the pictures that show it, before and after a correction.

Variance: half the squared difference of a pair, mean over the channels, in levels of 255 squared; the mean of the
smallest 90 % of all pairs, because the others may show different things. `build` uses the same definition
(colour_variance).
"""
import json

import numpy as np

import scorer
import tools

COUNTED_SHARE = 0.9
HUBER = 1.345  # standard deviations
ROUNDS = 30


def curve_of(response):
    """The response of an exposures.json."""
    kind = response["kind"]
    if kind == "gamma":
        return scorer.Gamma(response["gamma"])
    if kind == "linear":
        return scorer.Gamma(1.0)
    if kind == "emor":
        table, modes = tools.emor_table(), np.array(response["emor"], float)
        return scorer.Curve(table[0] + modes @ table[1:1 + len(modes)])
    return scorer.Curve(response["values"][0])


class Exposures:
    """The result of `build --write exposures`. ev: NaN for an image that is not joined."""

    def __init__(self, path):
        with open(path) as file:
            data = json.load(file)
        images = data["images"]
        self.names = [i["name"] for i in images]
        self.ev = np.array([np.nan if i["ev"] is None else i["ev"] for i in images], float)
        self.white_balance = np.array([i.get("white_balance", [np.nan] * 3) for i in images], float)
        self.size = np.array([[i["width"], i["height"]] for i in images], float)
        self.lens = np.array([i["lens"] for i in images])
        self.mean_ev, self.mean_balance = data["mean"]["ev"], np.array(data["mean"]["white_balance"], float)
        curves = [curve_of(camera["response"]) for camera in data["cameras"]]
        self.curve = [curves[lens["camera"]] for lens in data["lenses"]]
        self.k = np.array([np.broadcast_to(lens["vignetting"]["k"], (3, 3)) for lens in data["lenses"]], float)
        self.center = np.array([lens["vignetting"]["center"] for lens in data["lenses"]], float)
        self.reference_lens = self.lens[self.names.index(data["reference"])]

    def levels(self, pairs):
        """Grey values of the pairs after correction to the mean exposure, levels of 255: [n, 2, 3]."""
        image = pairs.image
        size, k = self.size[image], self.k[self.lens[image]]
        rho = np.hypot(size[..., 0], size[..., 1])[..., None] / 2.0
        r2 = np.sum(np.square((pairs.xy - (size - 1.0) / 2.0) / rho - self.center[self.lens[image]]), axis=-1)[..., None]
        falloff = 1.0 + r2 * (k[..., 0] + r2 * (k[..., 1] + r2 * k[..., 2]))
        gain = 2.0 ** (self.mean_ev - self.ev[image])[..., None] * self.mean_balance / self.white_balance[image] / falloff
        light = np.empty_like(pairs.value)
        for lens, curve in enumerate(self.curve):
            own = self.lens[image] == lens
            light[own] = curve.g(pairs.value[own])
        return 255.0 * self.curve[self.reference_lens].f(light * gain)


def affine_levels(pairs, images):
    """The same after a gain and an offset per image and channel in grey values, as in the training of radiance fields
    and splats: robust least squares (Huber), mean gain 1, mean offset 0."""
    first, second = pairs.image.T
    corrected = np.empty_like(pairs.value)
    for c in range(3):
        a, b = 255.0 * pairs.value[:, 0, c], 255.0 * pairs.value[:, 1, c]
        gain, offset = affine_of_channel(first, second, a, b, images)
        corrected[:, 0, c], corrected[:, 1, c] = gain[first] * a + offset[first], gain[second] * b + offset[second]
    return corrected


def affine_of_channel(first, second, a, b, images):
    """Gains and offsets of every image for which gain a + offset agree best."""
    scale = 100.0  # levels: gives an offset about the weight of a gain
    design = np.zeros((len(a), 2 * images))
    rows = np.arange(len(a))
    design[rows, first], design[rows, images + first] = a / scale, 1.0
    design[rows, second], design[rows, images + second] = -b / scale, -1.0
    gauge = np.zeros((2, 2 * images))
    gauge[0, :images] = gauge[1, images:] = 1.0
    start = np.concatenate([np.ones(images), np.zeros(images)])
    x = start
    for _ in range(ROUNDS):
        residual = design @ x
        limit = HUBER * max(1.4826 * np.median(np.abs(residual)), 1e-9) if residual.any() else np.inf
        weighted = design * np.minimum(1.0, limit / np.maximum(np.abs(residual), 1e-12))[:, None]
        normal = np.block([[weighted.T @ design, gauge.T], [gauge, np.zeros((2, 2))]])
        right = np.concatenate([-weighted.T @ (design @ start), np.zeros(2)])
        moved = start + np.linalg.lstsq(normal, right, rcond=None)[0][:2 * images]
        done = np.abs(moved - x).max() < 1e-6
        x = moved
        if done:
            break
    return x[:images], scale * x[images:]


def variance(levels):
    """[n, 2, 3] -> variance, levels squared."""
    differences = np.sort(0.5 * np.mean(np.square(levels[:, 0] - levels[:, 1]), axis=-1))
    return float(differences[:max(1, int(COUNTED_SHARE * len(differences)))].mean())


def variances(pairs, exposures):
    """{before, affine, and one per {name: Exposures}}, all on the pairs that all of them correct."""
    joined = np.all([~np.isnan(e.ev) for e in exposures.values()], axis=0)
    pairs = pairs.select(joined[pairs.image].all(axis=1))
    result = {"pairs": len(pairs), "before": variance(255.0 * pairs.value),
              "affine": variance(affine_levels(pairs, len(joined)))}
    result.update({name: variance(own.levels(pairs)) for name, own in exposures.items()})
    return result
