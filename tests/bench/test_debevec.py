#!/usr/bin/env python3
"""Tests of the reference method of Debevec & Malik: it recovers simulated responses."""
import unittest

import numpy as np

import debevec
import static

EV = np.array([2.0, 1.0, 0.0, -1.0, -2.0])
CURVES = static.CURVES


def pairs_of(curve, noise, count=10000, seed=42, ev=EV):
    """Grey values (count, 3) of places in two of the pictures, one or two apart, and ln t1/t2: log radiance uniform
    over 6.5 EV, normal noise below white, 8 bits."""
    random = np.random.default_rng(seed)
    first = random.integers(0, len(ev) - 1, count)
    second = np.minimum(first + random.integers(1, 3, count), len(ev) - 1)
    light = np.exp(-4.5 + 4.5 * random.random((count, 1)) + 0.6 * (random.random((count, 3)) - 0.5))
    grey = []
    for image in (first, second):
        seen = light * 2.0 ** ev[image][:, None]
        value = 255.0 * CURVES[curve](np.clip(seen, 0.0, 1.0)) + noise * random.normal(size=seen.shape) * (seen < 1.0)
        grey.append(np.clip(np.round(value), 0, 255))
    return grey[0], grey[1], np.log(2.0) * (ev[first] - ev[second])[:, None]


def error_of(light, curve):
    """RMS difference of f(light) from the levels 5..250 at the best scale, and the largest from 20 up. Below 20, noise
    is a large part of the value, and least squares on a logarithm are biased."""
    level = np.arange(5, 251)
    best = (255.0, 255.0)
    for scale in np.exp(np.linspace(-0.7, 0.7, 1400)):
        off = np.abs(255.0 * CURVES[curve](np.clip(scale * light[5:251], 0.0, 1.0)) - level)
        best = min(best, (float(np.sqrt(np.mean(off ** 2))), float(off[15:].max())))
    return best


class Debevec(unittest.TestCase):
    def test_recovers_responses(self):
        for curve in CURVES:
            for noise in (0, 1):
                with self.subTest(curve=curve, noise=noise):
                    g = debevec.log_inverse(*pairs_of(curve, noise))
                    light = debevec.inverse(g)
                    rms, largest = error_of(light, curve)
                    self.assertTrue(debevec.rises(g))
                    self.assertTrue((np.diff(light) >= 0).all() and light[0] == 0 and light[-1] == 1)
                    self.assertLess(rms, 1.0)
                    self.assertLess(largest, 2.5)

    def test_smoothness_helps_few_pairs(self):
        """Without it, the call still returns."""
        few = pairs_of("sRGB", 2, 300)
        smooth, rough = (error_of(debevec.inverse(debevec.log_inverse(*few, smoothness=s)), "sRGB")[0] for s in (10, 0))
        self.assertLess(smooth, rough)

    def test_grey_pictures(self):
        first, second, ratio = pairs_of("sRGB", 1)
        light = debevec.inverse(debevec.log_inverse(first[:, 0], second[:, 0], ratio[:, 0]))
        self.assertLess(error_of(light, "sRGB")[0], 1.0)

    def test_exposures_in_reverse_fall(self):
        first, second, ratio = pairs_of("sRGB", 1, 4000)
        g = debevec.log_inverse(first, second, -ratio)
        self.assertFalse(debevec.rises(g))
        self.assertTrue((np.diff(debevec.inverse(g)) >= 0).all())

    def test_black_and_white_count_for_nothing(self):
        first, second, ratio = pairs_of("sRGB", 1, 4000)
        g = debevec.log_inverse(first, second, ratio)
        add = [np.concatenate([a, np.broadcast_to(b, (2, a.shape[1]))])
               for a, b in ((first, [[0], [255]]), (second, [[90], [90]]), (ratio, [[0.7], [0.7]]))]
        np.testing.assert_allclose(debevec.log_inverse(*add), g, atol=1e-9)

    def test_frames_of_the_benchmark(self):
        """As good as the true curve but for what rounding leaves."""
        frames, ev = static.make("sRGB", 1, 0)
        truth = static.error(frames, static.by_truth(frames, ev, "sRGB"))
        self.assertLess(static.error(frames, static.by_debevec(frames, ev)), 1.5 * truth)


if __name__ == "__main__":
    unittest.main()
