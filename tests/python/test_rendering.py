"""Fits of renderings of raw frames."""
import ctypes
import unittest

import numpy as np

import lensprof as lp
from support import refused

WIDTH, HEIGHT = 480, 320
CURVE = 1 / 2.4


def shot(seed=1, channels=3, gain=1.4):
    """A raw frame, and the picture that a camera with a power function renders of it."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    draw = np.random.default_rng(seed)
    field = np.zeros((HEIGHT, WIDTH))
    for _ in range(60):  # soft patches
        u, v, size = draw.uniform(0, WIDTH), draw.uniform(0, HEIGHT), draw.uniform(15, 60)
        field += draw.uniform(-1, 1) * np.exp(-((x - u)**2 + (y - v)**2) / size**2)
    light = 0.003 * 250**((field - field.min()) / np.ptp(field))  # of all brightnesses
    raw = light[..., None] * np.linspace(0.8, 1.0, channels)
    rendered = np.clip(gain * raw, 0, 1)**CURVE
    raw, rendered = np.rint(np.clip(raw, 0, 1) * 65535), np.rint(255 * rendered)
    shape = (HEIGHT, WIDTH, 3)[:2 if channels == 1 else 3]
    return raw.astype(np.uint16).reshape(shape), rendered.astype(np.uint8).reshape(shape)


class Rendering(unittest.TestCase):
    def test_one_shot(self):
        result = lp.fit_rendering([shot()])
        self.assertTrue(result.usable, [f.text for f in result.findings])
        self.assertLess(abs(np.log(result.gamma * CURVE)), 0.02)
        self.assertLess(result.gamma_sigma, 0.1)
        self.assertEqual(len(result.shots), 1)
        found = result.shots[0]
        self.assertEqual((found.width, found.height, found.channels), (WIDTH, HEIGHT, 3))
        self.assertEqual(found.areas, result.areas)
        self.assertAlmostEqual(found.scale, 1.0, delta=0.01)
        self.assertFalse(found.corrects_falloff)
        self.assertEqual({f.code for f in result.passed} & {lp.Reason.SCATTER, lp.Reason.FEW_GREYS},
                         {lp.Reason.SCATTER, lp.Reason.FEW_GREYS})

    def test_several_shots_and_a_turn(self):
        raw, rendered = shot(2)
        result = lp.fit_rendering([shot(1), (raw, np.ascontiguousarray(np.rot90(rendered)))])
        self.assertEqual([s.quarter_turns for s in result.shots], [0, 1])
        self.assertLess(abs(np.log(result.gamma * CURVE)), 0.02)

    def test_grey_and_repeated(self):
        first, second = (lp.fit_rendering([shot(channels=1)]) for _ in range(2))
        self.assertEqual(first.shots[0].channels, 1)
        self.assertEqual(bytes(first), bytes(second))

    def test_refused(self):
        raw, rendered = shot()
        grey = np.ascontiguousarray(rendered[..., 1])
        for shots, status in (([], lp.Status.ERROR_NO_SAMPLES),
                              ([(raw, grey)], lp.Status.ERROR_UNSUPPORTED),
                              ([(raw, shot(9)[1])], lp.Status.ERROR_NO_OVERLAP),
                              ([(raw, np.zeros_like(rendered))], lp.Status.ERROR_NO_SAMPLES),
                              ([(raw[:40], rendered)], lp.Status.ERROR_SIZE),
                              ([(raw, rendered[:100, :200])], lp.Status.ERROR_SIZE),
                              ([(rendered, rendered)], lp.Status.ERROR_ARGUMENT),
                              ([(raw, rendered), shot(channels=1)], lp.Status.ERROR_ARGUMENT)):
            with self.subTest(status=status, shots=len(shots)), refused(self, status):
                lp.fit_rendering([tuple(map(np.ascontiguousarray, pair)) for pair in shots])
        prior = lp.Response()
        ctypes.memset(ctypes.byref(prior), 0xff, ctypes.sizeof(prior))
        with refused(self, lp.Status.ERROR_ARGUMENT):
            lp.fit_rendering([(raw, rendered)], prior=prior)

    def test_cancelled(self):
        with refused(self, lp.Status.ERROR_CANCELLED):
            lp.fit_rendering([shot()], progress=lambda done: True)

        def fail(done):
            raise KeyError("stop")
        with self.assertRaises(KeyError):
            lp.fit_rendering([shot()], progress=fail)


if __name__ == "__main__":
    unittest.main()
