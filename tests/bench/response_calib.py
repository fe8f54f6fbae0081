"""The response from a sweep of known exposures as mono_dataset_code's responseCalib computes it (Engel, Usenko & Cremers
2016): alternates the irradiance of every pixel and the inverse response at every grey level, both in closed form. Written
from its description and from reading its code; 8 bit grey frames."""
import numpy as np

ROUNDS, LEAK_PX = 10, 2


def without_white(frames):
    """Grey values and whether they count: white ones and their neighbours up to LEAK_PX do not."""
    frames = np.asarray(frames)
    white = frames == 255
    for axis in (1, 2):
        near = white.copy()
        for shift in range(1, LEAK_PX + 1):
            cut = [slice(None)] * 3
            back = list(cut)
            cut[axis], back[axis] = slice(shift, None), slice(None, -shift)
            near[tuple(cut)] |= white[tuple(back)]
            near[tuple(back)] |= white[tuple(cut)]
        white = near
    count = len(frames)
    return frames.reshape(count, -1), ~white.reshape(count, -1)


def inverse_response(frames, times):
    """G at the levels 0..255, 255 at the last. Levels that no pixel has continue the two before, as in the code."""
    grey, counts = without_white(frames)
    times = np.asarray(times, float)
    light = np.where(counts, grey, 0).sum(0) / np.maximum(counts.sum(0), 1)
    g = np.arange(256.0)
    for _ in range(ROUNDS):
        total, number = np.zeros(256), np.zeros(256)
        for values, used, time in zip(grey, counts, times):
            total += np.bincount(values[used], light[used] * time, 256)
            number += np.bincount(values[used], minlength=256)
        with np.errstate(invalid="ignore"):
            g = total / number
        for level in range(2, 256):
            if not np.isfinite(g[level]):
                g[level] = 2.0 * g[level - 1] - g[level - 2]
        above, below = np.zeros(grey.shape[1]), np.zeros(grey.shape[1])
        for values, used, time in zip(grey, counts, times):
            above += np.where(used, g[values] * time, 0.0)
            below += used * time ** 2
        light = np.maximum(np.divide(above, below, out=np.zeros_like(above), where=below > 0), 0.0)
        light, g = light * 255.0 / g[255], g * 255.0 / g[255]
    return g
