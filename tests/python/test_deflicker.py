"""Levels of frames in time."""
import unittest

import numpy as np

import lensprof as lp
from support import refused

WIDTH, HEIGHT = 120, 80


def srgb(x):
    x = np.clip(x, 0, 1)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x**(1 / 2.4) - 0.055)


def linear(v):
    return np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055)**2.4)


def light():
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    return 0.16 * np.exp(0.5 * np.sin(x / 6 + y / 17) + 0.5 * np.cos(y / 5 - x / 29))


def frames(evs, dtype=np.uint8, channels=3):
    for ev in evs:
        value = srgb(light() * 2**ev) if dtype != np.float32 else light() * 2**ev
        full = {np.uint8: 255, np.uint16: 65535, np.float32: 1}[dtype]
        picture = np.floor(value * full + 0.5).astype(dtype) if full > 1 else value.astype(np.float32)
        yield picture if channels == 1 else np.dstack([picture] * channels)


EVS = 0.15 * np.sin(2.3 * np.arange(16)) + 0.05 * np.cos(5.1 * np.arange(16))


class Deflicker(unittest.TestCase):
    def test_levels(self):
        for dtype, channels in ((np.uint8, 3), (np.uint16, 1), (np.float32, 3)):
            levels = lp.deflicker(frames(EVS, dtype, channels))
            self.assertEqual((levels.result.frames, levels.result.levelled, levels.result.segments), (16, 16, 1))
            self.assertLess(np.abs(levels.frames["exposure"]["ev"] - (EVS - EVS[0])).max(), 0.004)
            means = []
            for index, frame in enumerate(frames(EVS, dtype, channels)):
                out = levels.level(index, frame)
                self.assertEqual((out.dtype, out.shape), (frame.dtype, frame.shape))
                full = {np.uint8: 255, np.uint16: 65535, np.float32: 1}[dtype]
                means.append(np.log2((linear(out / full) if full > 1 else out).mean()))
            self.assertLess(np.abs(np.diff(means)).max(), 0.01 if dtype == np.uint8 else 0.004)

    def test_blue_first(self):
        tinted = [np.dstack([f[..., 0], f[..., 1], (f[..., 2] * 0.8).astype(np.uint8)]) for f in frames(EVS[:4])]
        given = lp.deflicker(tinted)
        reversed_ = lp.deflicker([np.ascontiguousarray(f[..., ::-1]) for f in tinted], layout=lp.Layout.BGR)
        self.assertEqual(given.frames.tobytes(), reversed_.frames.tobytes())
        out = reversed_.level(2, np.ascontiguousarray(tinted[2][..., ::-1]))
        self.assertTrue((out[..., ::-1] == given.level(2, tinted[2])).all())

    def test_targets(self):
        levels = lp.deflicker(frames(EVS), times=np.arange(16) * 5.0, settings_ev=np.arange(16) / 3, to="light", window=40)
        self.assertEqual(levels.window, 40)
        self.assertAlmostEqual(levels.result.known_range, 5)
        levels.target(3)
        self.assertTrue(np.allclose(levels.wanted["ev"], levels.frames["exposure"]["ev"][3]))
        levels.target(list(np.linspace(0, 1, 16)))
        self.assertTrue(np.allclose(levels.wanted["ev"], np.linspace(0, 1, 16)))
        levels.target("mean")
        self.assertTrue(np.allclose(levels.wanted["ev"], levels.frames["exposure"]["ev"].mean()))
        with self.assertRaises(ValueError):
            levels.target([1.0, 2.0])
        with self.assertRaises(ValueError):
            levels.target("brighter")

    def test_apertures_and_lines(self):
        y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
        r2 = ((x - (WIDTH - 1) / 2)**2 + (y - (HEIGHT - 1) / 2)**2) / ((WIDTH**2 + HEIGHT**2) / 4)
        pictures = [np.round(65535 * srgb(light() * (1 - k * r2))).astype(np.uint16) for k in [0.1] * 6 + [0.5] * 4]
        levels = lp.deflicker(pictures, f_numbers=[8] * 6 + [2.8] * 4)
        self.assertEqual(levels.shading(0).columns, 0)
        grid = levels.shading(8)
        self.assertAlmostEqual(float(grid.eval(WIDTH, HEIGHT, np.zeros(1), np.zeros(1), 0)[0]), 0.5 / 0.9, delta=0.03)
        self.assertLess(np.abs(np.log2(linear(levels.level(8, pictures[8]) / 65535) / light()
                                       * light().mean() / linear(levels.level(8, pictures[8]) / 65535).mean())).max(), 0.25)
        waves = [np.round(65535 * srgb(light() * 2**(0.1 * np.sin(y / 5 + 2.3 * i)))).astype(np.uint16) for i in range(20)]
        self.assertEqual(lp.deflicker(waves, rows=True).shading(9).rows, lp.GRID_SIDE)

    def test_refusals(self):
        with refused(self, lp.Status.ERROR_NO_SAMPLES):
            lp.deflicker([np.zeros((40, 60), np.uint8)] * 3)
        with refused(self, lp.Status.ERROR_SIZE):
            lp.deflicker([np.full((40, 60), 90, np.uint8), np.full((40, 61), 90, np.uint8)])
        with refused(self, lp.Status.ERROR_ARGUMENT):
            lp.deflicker(frames(EVS), times=[3.0, 2.0] + [4.0] * 14)
        with refused(self, lp.Status.ERROR_ARGUMENT):
            lp.deflicker(frames(EVS), to="light")
        with refused(self, lp.Status.ERROR_ARGUMENT):
            lp.deflicker(frames(EVS), region=(0.5, 0, 0.2, 1))
        with self.assertRaises(ValueError):
            lp.deflicker(frames(EVS), times=[1.0, 2.0])
        with self.assertRaises(ValueError):
            lp.deflicker(frames(EVS), times=range(99))
        with refused(self, lp.Status.ERROR_UNSUPPORTED):
            lp.deflicker([np.full((40, 60), 0.3, np.float16)] * 3)
        with refused(self, lp.Status.ERROR_SIZE):
            lp.deflicker([np.full((4, 4), 90, np.uint8)] * 3)


if __name__ == "__main__":
    unittest.main()
