"""Fits of the shading that pictures of different scenes have in common."""
import unittest

import numpy as np

import lensprof as lp
from support import refused

WIDTH, HEIGHT, OFFSET = 96, 72, 120


def shading():
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    return np.exp(-1.2 * ((x / WIDTH - 0.6)**2 + (y / WIDTH - 0.3)**2))


def fields(count=8, seed=1, channels=1, light=800.0):
    """Bright cells on an even background, of a camera that uses a few percent of its 16 bit."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    draw = np.random.default_rng(seed)
    for _ in range(count):
        scene = np.ones((HEIGHT, WIDTH))
        for _ in range(20):
            scene[np.hypot(x - draw.uniform(0, WIDTH), y - draw.uniform(0, HEIGHT)) < draw.uniform(2, 6)] += 2
        value = draw.uniform(0.6, 1.6) * light * shading() * scene + OFFSET + draw.normal(0, 3, scene.shape)
        picture = np.rint(value).astype(np.uint16)
        yield picture if channels == 1 else np.dstack([picture, (picture // 2).astype(np.uint16), picture])


def error(grid, channel=0):
    """RMS of the shading over its mean."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH].astype(float)
    found = grid.eval(WIDTH, HEIGHT, x, y, channel)
    return np.sqrt(np.mean((found / found.mean() - shading() / shading().mean())**2))


class Fields(unittest.TestCase):
    def test_shading_offset_and_profile(self):
        result = lp.fit_fields(fields())
        self.assertTrue(result.usable, [f.text for f in result.findings])
        self.assertEqual((result.images, result.used, result.channels), (8, 8, 1))
        self.assertLess(error(result.shading), 0.004)
        channel, = result.channel
        self.assertTrue(channel.offset_found)
        self.assertAlmostEqual(channel.offset * 65535, OFFSET, delta=4)
        tried = result.smoothness()
        self.assertAlmostEqual(tried["rms"].min(), channel.heldout_rms, places=12)
        self.assertEqual(tried["rms"].argmin(), channel.smoothness)
        self.assertTrue(result.image["used"].all())
        self.assertTrue((result.image["level"][:, 0] > 0).all())
        profile = result.profile(lp.ProfileKey(camera_model="Orca", lens="10x"), source="slide.tif")
        self.assertEqual(profile.provenance.method, "fields")
        self.assertEqual(profile.key.lens, "10x")
        self.assertEqual(bytes(profile.grid), bytes(result.shading))

    def test_colour_mask_and_options(self):
        mask = np.ones((HEIGHT, WIDTH), np.uint8)
        mask[10:20, 30:60] = 0
        options = lp.FieldsOptions(given_offset=True, offset=[OFFSET / 65535, OFFSET / 2 / 65535, OFFSET / 65535],
                                   threads=1)
        result = lp.fit_fields(((picture, mask) for picture in fields(channels=3)), options)
        self.assertEqual(result.shading.channels, 3)
        self.assertGreater(result.unseen_share, 0.01)
        self.assertIn(lp.Reason.FIELDS_UNSEEN, [f.code for f in result.findings])
        for number, channel in enumerate(result.channel):
            self.assertFalse(channel.offset_found)
            self.assertLess(error(result.shading, number), 0.01)

    def test_refused(self):
        same = next(fields())
        result = lp.fit_fields([same] * 4)
        self.assertFalse(result.usable)
        self.assertEqual(result.findings[0].code, lp.Reason.FIELDS_FEW)
        self.assertEqual(result.repeated, 3)
        with refused(self, lp.Status.ERROR_NO_SAMPLES):
            lp.fit_fields([np.zeros_like(same)])
        with refused(self, lp.Status.ERROR_SIZE):
            lp.fit_fields([same, same[:-5]])
        with refused(self, lp.Status.ERROR_CANCELLED):
            lp.fit_fields(fields(3), lp.FieldsOptions(progress=lambda done: True))
        with self.assertRaises(ValueError):
            lp.fit_fields([])


if __name__ == "__main__":
    unittest.main()
