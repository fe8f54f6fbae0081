"""The scorer's own camera model, and the errors of a recovered model. Independent of the tools.

    B = f( L M(r) 2^ev w ),   M = 1 + k1 r^2 + k2 r^4 + k3 r^6,   r = |p - c| / half diagonal,   w_green = 1

Gauge. With an unknown response, exposures are known up to a common factor and an exponent G (2^ev, w and M to the power
G, f(x) becomes f(x^(1/G))). Errors are given raw, and aligned: after removing G, the slope of the recovered against the
true exposures. If exposures do not vary, G is the slope of the recovered against the true inverse response, both
logarithmic.
"""
import json
from dataclasses import dataclass

import numpy as np

FAILURE_LEVELS = 5.0  # a result with a larger clean residual is useless
METRICS = ("ev_raw", "ev_aligned", "wb_raw", "wb_aligned", "falloff_raw", "falloff_aligned", "center", "response_raw",
           "response_aligned", "clean_rms", "clean_median")


class Curve:
    """A response f on [0,1], piecewise linear, and its inverse g."""

    def __init__(self, values, x=None):
        self.y = np.maximum.accumulate(np.asarray(values, float))
        self.x = np.linspace(0.0, 1.0, len(self.y)) if x is None else np.asarray(x, float)
        rises = np.concatenate([[True], np.diff(self.y) > 0])
        self.inverse_y, self.inverse_x = self.y[rises], self.x[rises]

    def f(self, x):
        return np.interp(x, self.x, self.y)

    def g(self, b):
        return np.interp(b, self.inverse_y, self.inverse_x)


class Gamma:
    """f(x) = x^(1/gamma), which no table of 1024 samples represents near black."""

    def __init__(self, gamma):
        self.gamma = gamma

    def f(self, x):
        return np.clip(x, 0.0, 1.0) ** (1.0 / self.gamma)

    def g(self, b):
        return np.clip(b, 0.0, 1.0) ** self.gamma


@dataclass
class Model:
    ev: np.ndarray           # [n]
    white_balance: np.ndarray  # [n, 3]
    k: np.ndarray            # [1 or 3, 3]: for all channels, or per channel
    center: np.ndarray       # [2], half diagonals
    curve: object
    monotone: bool = True    # of the curve as stated by the tool, all samples

    def falloff(self, r2):
        """M per channel: [..., 3], never below 1e-6."""
        k, r2 = np.broadcast_to(self.k, (3, 3)), np.asarray(r2)[..., None]
        return np.maximum(1.0 + r2 * (k[:, 0] + r2 * (k[:, 1] + r2 * k[:, 2])), 1e-6)


@dataclass
class Pairs:
    image: np.ndarray  # [n, 2]
    xy: np.ndarray     # [n, 2 sides, 2], px
    value: np.ndarray  # [n, 2 sides, 3 channels], 0..1

    def __len__(self):
        return len(self.image)

    def select(self, rows):
        return Pairs(self.image[rows], self.xy[rows], self.value[rows])


def read_points(path):
    """A point file: image1 image2 x1 y1 x2 y2 R1 G1 B1 R2 G2 B2 0 r1 r2 0."""
    a = np.loadtxt(path, ndmin=2)
    return Pairs(a[:, :2].astype(int), a[:, 2:6].reshape(-1, 2, 2), a[:, 6:12].reshape(-1, 2, 3))


def read_truth(path, response="table"):
    """truth.json of `lensprof simulate`; `response` is the value of --response."""
    with open(path) as file:
        truth = json.load(file)
    curve = Gamma(float(response[6:])) if response.startswith("gamma:") else Curve(truth["response"]["values"][0])
    return model_of_json(truth, curve)


def model_of_json(data, curve, monotone=True):
    """An image that is not joined has null numbers and counts as uncorrected."""
    def known(values, otherwise):
        return [otherwise if v is None else v for v in values]

    return Model(np.array(known([i["ev"] for i in data["images"]], 0.0), float),
                 np.array([known(i["white_balance"] or [None] * 3, 1.0) for i in data["images"]], float),
                 np.atleast_2d(np.array(data["vignetting"]["k"], float)),
                 np.array(data["vignetting"]["center"], float), curve, monotone)


def rms(x):
    return float(np.sqrt(np.mean(np.square(x))))


def transfer(model, pairs, sizes):
    """Residuals in levels of 255: B1 - f(g(B2) s1/s2) and B2 - f(g(B1) s2/s1), [n, 2, 3]. sizes: [images, 2], px."""
    size = sizes[pairs.image].astype(float)
    rho = np.hypot(size[..., 0], size[..., 1])[..., None] / 2.0
    r2 = np.sum(np.square((pairs.xy - (size - 1.0) / 2.0) / rho - model.center), axis=-1)
    s = model.falloff(r2) * (2.0 ** model.ev[pairs.image])[..., None] * model.white_balance[pairs.image]
    light = model.curve.g(pairs.value)
    predicted = np.stack([light[:, 1] * s[:, 0] / s[:, 1], light[:, 0] * s[:, 1] / s[:, 0]], axis=1)
    return 255.0 * (pairs.value - model.curve.f(predicted))


def identity(images):
    """No correction: its transfer residual is B1 - B2."""
    return Model(np.zeros(images), np.ones((images, 3)), np.zeros((1, 3)), np.zeros(2), Curve([0.0, 1.0]))


def log_light(curve, b):
    return np.log(np.maximum(curve.g(b), 1e-9))


def gauge_exponent(truth, model):
    """G, or 1 if it is undetermined or absurd."""
    deviation = truth.ev - truth.ev.mean()
    if np.ptp(truth.ev) > 0.05:
        exponent = deviation @ (model.ev - model.ev.mean()) / (deviation @ deviation)
    else:
        b = np.linspace(20.0, 235.0, 200) / 255.0
        exponent = np.polyfit(log_light(truth.curve, b), log_light(model.curve, b), 1)[0]
    return float(exponent) if np.isfinite(exponent) and exponent > 1e-3 else 1.0


def response_error(truth, model, exponent):
    """RMS over grey values 5..250 of f_true( (g(B)/c)^(1/G) ) - B, levels, at the scale c that makes it smallest."""
    b = np.arange(5, 251) / 255.0
    found = log_light(model.curve, b) / exponent
    scale = np.median(found - log_light(truth.curve, b)) + np.linspace(-0.6, 0.6, 481)
    return 255.0 * min(rms(truth.curve.f(np.exp(found - c)) - b) for c in scale)


def errors(truth, model, exponent, centred):
    """(exposure RMS EV, white balance RMS EV, falloff largest error, response RMS levels) after removing an exponent.
    Exposures are relative to image 0, or `centred`: to their mean."""
    ev = (model.ev - model.ev[0]) / exponent - (truth.ev - truth.ev[0])
    if centred:
        ev = ev - ev.mean()
    balance = [np.log2(np.maximum(m.white_balance[:, ::2], 1e-6)) for m in (model, truth)]
    balance = [v - v[0] for v in balance]
    r2 = np.linspace(0.0, 1.0, 201) ** 2
    falloff = np.abs(model.falloff(r2) ** (1.0 / exponent) - truth.falloff(r2)).max()
    return rms(ev), rms(balance[0] / exponent - balance[1]), float(falloff), response_error(truth, model, exponent)


def score(truth, model, pairs, sizes):
    """All errors of a recovered model. pairs: noise-free correspondences that no tool has seen. ev_spread: difference
    between the highest and the lowest exposure error, as stated; if exposures are all equal, their spread."""
    exponent = gauge_exponent(truth, model)
    result = {"exponent": exponent}
    for tag, values in (("raw", errors(truth, model, 1.0, False)), ("aligned", errors(truth, model, exponent, True))):
        result.update({"%s_%s" % (name, tag): v for name, v in zip(("ev", "wb", "falloff", "response"), values)})
    residual = transfer(model, pairs, sizes)
    result.update(center=float(np.hypot(*(model.center - truth.center))), clean_rms=rms(residual),
                  clean_median=float(np.median(np.abs(residual))), monotone=bool(model.monotone),
                  ev_spread=float(np.ptp(model.ev - truth.ev)))
    if len(truth.ev) < 3:
        result["ev_aligned"] = None  # a single exposure difference: zero by construction
    result["failed"] = not result["clean_rms"] <= FAILURE_LEVELS
    return result


def largest_errors(truth, data):
    """{joined, ev, falloff}: largest errors of the object printed by `build --json`, over the joined images, after
    removing offset and exponent of the exposures; its images are in the order of the truth."""
    joined = np.array([i["ev"] is not None for i in data["images"]])
    found = model_of_json(data, Curve(data["response"]["values"][0]))
    known, model = (Model(m.ev[joined], m.white_balance[joined], m.k, m.center, m.curve) for m in (truth, found))
    exponent = gauge_exponent(known, model)
    off = model.ev / exponent - known.ev
    return {"joined": int(joined.sum()), "ev": float(np.abs(off - off.mean()).max()),
            "falloff": errors(known, model, exponent, True)[2]}
