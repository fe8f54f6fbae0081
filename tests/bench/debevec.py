"""The response from pictures of known exposure (Debevec & Malik 1997), the reference of the table of stationary
cameras. Linear least squares for G = ln f^-1 at the grey levels 1 to 255, equation 3:

    sum over pairs w^2 (G(B1) - G(B2) - ln t1/t2)^2  +  lambda sum over levels (w(z) G''(z))^2,    G(128) = 0

Two grey values of one place eliminate its radiance from the two terms w^2 (G(B) - ln E - ln t)^2 of the paper, which
leaves the weight w1^2 w2^2 / (w1^2 + w2^2). One curve serves all channels (the paper: one each). The exposures are
exact; there is no outlier rejection, and the curve is made monotone only at the end."""
import numpy as np

LEVELS = 255  # of G: 1..255
GAUGE = 128 - 1  # index of the level where G is 0
SMOOTHNESS = 10.0  # lambda for as many equations as in the paper,
PAPERS_ROWS = 300.0  # and in proportion for more, so that these do not make the curve rougher
RIDGE = 1e-9  # relative to the equations: holds levels that neither pairs nor smoothness determine


def hat(level):
    """Equation 4, plus one, so that the ends have some weight."""
    return np.minimum(level, 255.0 - level) + 1.0


def hats(values):
    """Weights of the levels 1..255 in G(values), linear in between; values 1..255, one row each."""
    low = np.minimum(values.astype(int), LEVELS - 1)
    rows = np.zeros((len(values), LEVELS))
    at = np.arange(len(values))
    rows[at, low - 1] += 1.0 - (values - low)
    rows[at, low] += values - low
    return rows


def log_inverse(first, second, log_ratio, smoothness=SMOOTHNESS):
    """G at the levels 1..255 from grey values of the same places in two pictures (0..255, any channels) and ln t1/t2 of
    what they received: exposure, white balance and falloff. Values below 1 have no unknown and white ones no
    information."""
    first, second, log_ratio = (np.ravel(a).astype(float) for a in np.broadcast_arrays(first, second, log_ratio))
    used = (np.minimum(first, second) >= 1.0) & (np.maximum(first, second) < 255.0)
    first, second, log_ratio = first[used], second[used], log_ratio[used]
    normal, right = np.zeros((LEVELS, LEVELS)), np.zeros(LEVELS)
    for part in range(0, len(first), 1 << 14):  # a dense row has 2 KB
        a, b, t = (values[part:part + (1 << 14)] for values in (first, second, log_ratio))
        w1, w2 = hat(a) ** 2, hat(b) ** 2
        rows, weight = hats(a) - hats(b), w1 * w2 / (w1 + w2)
        normal += rows.T @ (weight[:, None] * rows)
        right += rows.T @ (weight * t)
    count = max(len(first), 1)
    bent = np.diff(np.eye(LEVELS), 2, axis=0) * hat(np.arange(2, LEVELS))[:, None]
    normal += max(smoothness, 1e-6) * count / PAPERS_ROWS * bent.T @ bent + RIDGE * count * np.eye(LEVELS)
    free = np.arange(LEVELS) != GAUGE
    g = np.zeros(LEVELS)
    g[free] = np.linalg.solve(normal[np.ix_(free, free)], right[free])
    return g


def rises(g):
    """Over the middle half of the grey values; it falls if the exposures are in reverse order."""
    return bool(g[191] > g[63])


def inverse(g):
    """f^-1 at the levels 0..255, 1 at the last: rising, and linear up to level 1."""
    light = np.maximum.accumulate(np.exp(g - np.max(g)))
    return np.concatenate([[0.0], light])


def response_of(frames, ev, places=20000, seed=1):
    """f^-1 from frames (uint8) of a stationary camera and their exposures in EV: `places` random pixels, each in all
    pairs of frames."""
    chosen = np.random.default_rng(seed).integers(0, frames[0].shape[0] * frames[0].shape[1], places)
    grey = [frame.reshape(-1, frame.shape[-1])[chosen] for frame in frames]
    first, second = np.triu_indices(len(frames), 1)
    ratio = np.log(2.0) * (np.asarray(ev)[first] - np.asarray(ev)[second])
    return inverse(log_inverse(np.stack([grey[i] for i in first]), np.stack([grey[i] for i in second]),
                               ratio[:, None, None]))
