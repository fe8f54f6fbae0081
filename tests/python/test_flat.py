"""Flat field fits of arrays."""
import unittest

import numpy as np

import lensprof as lp
from support import read_only, refused

WIDTH, HEIGHT = 240, 180
LENS = lp.Vignetting(k=(-0.4, 0.1, -0.05), center=(0.02, -0.01))


def card(rotation_deg=0.0, ev=0.0, seed=1, channels=3):
    """A card, lit more strongly on the right, photographed with a linear camera."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    half = np.hypot(WIDTH, HEIGHT) / 2
    dx, dy = (x - (WIDTH - 1) / 2) / half, (y - (HEIGHT - 1) / 2) / half
    turn = np.radians(rotation_deg)
    r2 = (dx - LENS.center[0]) ** 2 + (dy - LENS.center[1]) ** 2
    m = 1 + LENS.k[0] * r2 + LENS.k[1] * r2**2 + LENS.k[2] * r2**3
    light = 0.5 * 2.0**ev * m * np.exp(0.06 * (np.cos(turn) * dx - np.sin(turn) * dy))
    noise = np.random.default_rng(seed).normal(0, 0.003, (HEIGHT, WIDTH, channels))
    return np.clip((light[:, :, None] + noise) * 65535, 0, 65535).astype(np.uint16)


class Flat(unittest.TestCase):
    def test_rotated_shots(self):
        images = [lp.FlatImage(card(90 * i, seed=i), shot=i, rotation_deg=90 * i) for i in range(3)]
        result = lp.fit_flat(images)
        self.assertTrue(result.usable, [f.text for f in result.findings])
        self.assertTrue(result.separated)
        self.assertEqual(len(result.vignetting), 1)
        np.testing.assert_allclose(result.vignetting[0].center, LENS.center, atol=0.003)
        self.assertAlmostEqual(sum(result.vignetting[0].k), sum(LENS.k), delta=0.002)
        self.assertEqual(result.covariance.shape, (5, 5))
        self.assertEqual(result.light, lp.FlatLight.PLANE)
        np.testing.assert_allclose(result.image_quality["gradient"][0], (0.06, 0), atol=0.005)
        self.assertEqual(len(result.spot), result.spots)
        profile = result.profile(lp.ProfileKey(lens="a lens"))
        self.assertEqual(profile.provenance.method, "flat")
        self.assertEqual(profile.vignetting[0], result.vignetting[0])

    def test_exposures_response_and_grid(self):
        options = lp.FlatOptions(response=lp.Response.linear(), grid=lp.FlatGrid.ALWAYS, threads=1)
        images = [lp.FlatImage(card(ev=ev, seed=5), ev=ev) for ev in (-1.0, 0.5)]
        result = lp.fit_flat(images, options)
        self.assertTrue(result.usable, [f.text for f in result.findings])
        self.assertEqual(result.shots, 1)
        self.assertGreater(result.gain_grid.columns, 2)
        self.assertLess(abs(result.image_quality["ev_residual"]).max(), 0.02)

    def test_read_only_memory(self):
        array, options = card(), lp.FlatOptions(threads=1)
        mapped = lp.FlatImage(read_only(array))
        self.assertEqual(mapped._view(0).view.data, mapped.array.ctypes.data)
        self.assertEqual(lp.fit_flat([mapped], options).vignetting, lp.fit_flat([lp.FlatImage(array)], options).vignetting)

    def test_refused(self):
        with refused(self, lp.Status.ERROR_ARGUMENT):
            lp.fit_flat([])
        with refused(self, lp.Status.ERROR_ARGUMENT):
            lp.fit_flat([lp.FlatImage(card(channels=1))])
        with refused(self, lp.Status.ERROR_SIZE):
            lp.fit_flat([lp.FlatImage(card(), width=100)])
        with refused(self, lp.Status.ERROR_NO_SAMPLES):
            lp.fit_flat([lp.FlatImage(card(), mask=np.zeros((HEIGHT, WIDTH), bool))])
        with self.assertRaises(ValueError):
            lp.fit_flat([lp.FlatImage(card(), mask=np.zeros((3, 4), bool))])

    def test_progress_cancels(self):
        with refused(self, lp.Status.ERROR_CANCELLED):
            lp.fit_flat([lp.FlatImage(card())], lp.FlatOptions(progress=lambda done: True))


if __name__ == "__main__":
    unittest.main()
