"""The method `radiance`: speed and accuracy on tracks compared with the paper's algorithm, and with `transfer` on
pictures.

The peer is Goldman & Chen 2005, section 5, on NumPy: squared distance, five EMoR modes with a Gaussian prior, a falloff
of three coefficients, one exposure per image. Parameters and radiances are optimised in turn: radiances by equation 13
as long as that lowers the objective and exactly otherwise, parameters by Nelder-Mead; falling curves have infinite
cost. After LIMIT_S seconds its current state is scored. The paper found radiances by Nelder-Mead, too; here Newton's
method on all points simultaneously is used, which is faster.
"""
import os
import shutil
import subprocess
import sys
import time

import numpy as np

import scorer
import tools

IMAGES, POINTS, WIDTH, HEIGHT, NOISE = 12, 2000, 800, 600, 2.0
FALLOFF = np.array([-0.30, 0.05, -0.15])
LIMIT_S, QUICK_LIMIT_S = 120, 30
PICTURES = [("6 pictures", "--images 6"), ("6 pictures, 10 % outliers", "--images 6 --set outliers=0.1"),
            ("12 pictures, 2 rows", "--images 12 --set rows=2"),
            ("6 pictures, 1.5 EV, bright", "--images 6 --set ev=1.5,mean-ev=1")]
SIGMA = np.array([3.417, 1.295, 0.4695, 0.2022, 0.09608])  # of the EMoR coefficients over the curves of DoRF
GRID = np.linspace(0.0, 1.0, 1024)


def lensprof():
    sys.path.insert(0, str(tools.ROOT / "bindings" / "python"))
    os.environ.setdefault("LENSPROF_LIBRARY", str(tools.ROOT / "build" / "liblensprof.so"))
    import lensprof as lp
    return lp


class Tracks:
    """A simulated strip with a known camera: points seen in 2 to 5 neighbouring images."""

    def __init__(self, lp, seed):
        random = np.random.default_rng(seed)
        self.true_ev = np.concatenate(([0.0], random.uniform(-1.0, 1.0, IMAGES - 1)))
        lengths = random.integers(2, 6, POINTS)
        self.point = np.repeat(np.arange(POINTS), lengths)
        order = np.concatenate([np.arange(n) for n in lengths])
        self.image = (np.repeat(random.integers(0, IMAGES, POINTS), lengths) + order) % IMAGES
        self.xy = random.uniform((0, 0), (WIDTH - 1, HEIGHT - 1), (len(self.point), 2))
        offset = self.xy - np.array([(WIDTH - 1) / 2, (HEIGHT - 1) / 2])
        self.r2 = (offset ** 2).sum(axis=1) / ((WIDTH ** 2 + HEIGHT ** 2) / 4)
        light = np.exp(random.uniform(-4.5, -0.5, POINTS))[:, None] * np.exp(random.uniform(-0.3, 0.3, (POINTS, 3)))
        e = light[self.point] * (attenuation(FALLOFF, self.r2) * 2.0 ** self.true_ev[self.image])[:, None]
        e = np.minimum(e, 1.0)
        grey = np.where(e <= 0.0031308, 12.92 * e, 1.055 * e ** (1 / 2.4) - 0.055)
        self.value = np.clip(np.rint(255 * grey + random.normal(0, NOISE, grey.shape)), 0, 255) / 255
        self.array = np.zeros(len(self.point), dtype=lp.OBSERVATION_DTYPE)
        for name in ("point", "image", "xy", "value"):
            self.array[name] = getattr(self, name)

    def errors(self, ev, k):
        """(exposure, RMS EV; falloff, largest) after removing the common exponent."""
        exponent = max(float(self.true_ev @ ev / (self.true_ev @ self.true_ev)), 1e-3)
        deviation = ev / exponent - self.true_ev
        r2 = np.linspace(0.0, 1.0, 201) ** 2
        fall = np.maximum(attenuation(k, r2), 1e-6) ** (1.0 / exponent) - attenuation(FALLOFF, r2)
        return scorer.rms(deviation - deviation.mean()), float(np.abs(fall).max())


def attenuation(k, r2):
    return 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[2]))


class Peer:
    def __init__(self, lp, tracks, limit):
        self.tracks, self.limit = tracks, limit
        self.tables = np.array([lp.emor_table(mode) for mode in range(6)])
        self.weight = (NOISE / 255) ** 2  # lambda: weight of the prior relative to squared grey values
        self.evaluations = 0

    def curve(self, p):
        return self.tables[0] + p[3:8] @ self.tables[1:]

    def factor(self, p):
        ev = np.concatenate(([0.0], p[8:]))
        return attenuation(p[:3], self.tracks.r2) * 2.0 ** ev[self.tracks.image]

    def total(self, values):
        """Sums over the observations of each point."""
        return np.stack([np.bincount(self.tracks.point, values[:, c], POINTS) for c in range(3)], axis=1)

    def objective(self, p, light):
        self.evaluations += 1
        curve, s = self.curve(p), self.factor(p)
        if (np.diff(curve) < 0).any() or (s <= 0).any():
            return np.inf
        error = self.tracks.value - np.interp(light[self.tracks.point] * s[:, None], GRID, curve)
        return (error ** 2).sum() + self.weight * ((p[3:8] / SIGMA) ** 2).sum()

    def average(self, p):
        """Equation 13."""
        s = self.factor(p)
        count = np.bincount(self.tracks.point, minlength=POINTS)[:, None]
        return self.total(np.interp(self.tracks.value, self.curve(p), GRID) / s[:, None]) / count

    def exact(self, p, light):
        curve, s = self.curve(p), self.factor(p)[:, None]
        slope = np.append(np.diff(curve) * 1023, 0.0)
        light = np.maximum(light, 1e-6)
        for _ in range(20):
            e = np.clip(light[self.tracks.point] * s, 0.0, 1.0)
            by = slope[np.minimum((e * 1023).astype(int), 1022)] * s
            pull = self.total(by * (self.tracks.value - np.interp(e, GRID, curve)))
            step = pull / np.maximum(self.total(by * by), 1e-12)
            light = np.clip(light + step, 0.5 * light, 2.0 * light)
        return light

    def simplex(self, p, light, steps, most, end):
        """Nelder and Mead's method starting at p."""
        points = np.vstack([p] + [p + step * np.eye(len(p))[i] for i, step in enumerate(steps)])
        values = np.array([self.objective(q, light) for q in points])
        for _ in range(most):
            order = np.argsort(values)
            points, values = points[order], values[order]
            if values[-1] - values[0] < 1e-9 * values[0] or time.perf_counter() > end:
                break
            centre = points[:-1].mean(axis=0)
            tried = centre + (centre - points[-1])
            value = self.objective(tried, light)
            if value < values[0]:
                further = centre + 2.0 * (centre - points[-1])
                beyond = self.objective(further, light)
                tried, value = (further, beyond) if beyond < value else (tried, value)
            elif value >= values[-2]:
                nearer = centre + 0.5 * ((tried if value < values[-1] else points[-1]) - centre)
                near = self.objective(nearer, light)
                if near >= min(value, values[-1]):
                    points[1:] = points[0] + 0.5 * (points[1:] - points[0])
                    values[1:] = [self.objective(q, light) for q in points[1:]]
                    continue
                tried, value = nearer, near
            points[-1], values[-1] = tried, value
        return points[values.argmin()], values.min()

    def run(self):
        """-> (seconds, whether it converged, exposures, falloff)."""
        began = time.perf_counter()
        end = began + self.limit
        p = np.zeros(8 + IMAGES - 1)
        light = self.average(p)
        value = self.objective(p, light)
        steps = np.concatenate((np.full(3, 0.1), 0.3 * SIGMA, np.full(IMAGES - 1, 0.3)))
        settled = False
        while time.perf_counter() < end and not settled:
            before = value
            p, value = self.simplex(p, light, steps, 400, end)
            quick = self.average(p)
            if self.objective(p, quick) < value:
                light = quick
            else:
                light = self.exact(p, light)
            value = self.objective(p, light)
            settled = bool(before - value < 1e-4 * before)
            steps = np.maximum(0.7 * steps, 1e-3)
        return time.perf_counter() - began, settled, np.concatenate(([0.0], p[8:])), p[:3]


def beside_the_paper(seed, limit, turns=5):
    lp = lensprof()
    tracks = Tracks(lp, seed)
    images = [lp.FitImage(i, WIDTH, HEIGHT, free=lp.Free.EV) for i in range(IMAGES)]
    free = lp.Free.RESPONSE | lp.Free.K1 | lp.Free.K2 | lp.Free.K3
    record = {"observations": len(tracks.point)}
    for name, fields in (("lensprof", {}), ("lensprof-5", {"modes": 5, "loss": lp.Loss.SQUARED, "vignettings": 1})):
        seconds = []
        for _ in range(turns):
            began = time.perf_counter()
            options = lp.FitOptions(method=lp.Method.RADIANCE, free=free, **fields)
            result = lp.fit_radiance(images, tracks.array, options)
            seconds.append(time.perf_counter() - began)
        ev, fall = tracks.errors(result.exposures["ev"], np.array(result.vignetting[0].k))
        record[name] = {"seconds": float(np.median(seconds)), "settled": bool(result.converged), "ev_aligned": ev,
                        "falloff_aligned": fall}
    peer = Peer(lp, tracks, limit)
    seconds, settled, ev, k = peer.run()
    ev_error, fall = tracks.errors(ev, k)
    record["paper"] = {"seconds": seconds, "settled": settled, "ev_aligned": ev_error, "falloff_aligned": fall,
                       "evaluations": peer.evaluations, "limit_s": limit}
    return record


def beside_transfer(name, options, seeds):
    """The same pictures with both methods, and with `radiance` on the pairs of `transfer`."""
    records = []
    for seed in seeds:
        folder = tools.WORK / "radiance" / ("%s_%d" % ("".join(c if c.isalnum() else "_" for c in name), seed))
        shutil.rmtree(folder, ignore_errors=True)
        subprocess.run([tools.LENSPROF, "simulate", "-o", str(folder), "--size", "800x600", "--seed", str(seed),
                        "--set", "test-points=2000", *options.split()], check=True, stdout=subprocess.DEVNULL)
        truth, pairs = scorer.read_truth(folder / "truth.json", "srgb"), scorer.read_points(folder / "test_points.txt")
        project, points = str(folder / "pano.pto"), str(folder / "drawn.txt")
        sizes = tools.sizes_of_pto((folder / "pano.pto").read_text())
        for tool, extra in (("transfer", ["--write", f"points={points}"]), ("radiance", ["--fit", "method=radiance"]),
                            ("radiance, same pairs", ["--fit", "method=radiance", "--points", points])):
            used, model = tools.run_lensprof(project, str(folder / "log"), extra)
            used.pop("timeless", None)
            records.append(dict(used, case=name, method=tool, seed=seed,
                                **(scorer.score(truth, model, pairs, sizes) if model else {"clean_rms": np.inf})))
    return records


def run_all(quick, say):
    results = {"paper": [], "transfer": []}
    for seed in range(1, 2 if quick else 4):
        say("radiance: %d images x %d points, seed %d" % (IMAGES, POINTS, seed))
        results["paper"].append(beside_the_paper(seed, QUICK_LIMIT_S if quick else LIMIT_S))
    for name, options in PICTURES[:2] if quick else PICTURES:
        say("radiance: " + name)
        results["transfer"] += beside_transfer(name, options, range(1, 2 if quick else 6))
    return results
