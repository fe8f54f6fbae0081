"""A camera that runs, from NumPy arrays of tracks whose truth is known."""
import math
import unittest

import numpy as np

import lensprof as lp

WIDTH, HEIGHT, GAMMA, CORNER = 640, 480, 2.2, 0.6


class Film:
    """Points that pass a camera which pans: 200 tracks, falloff 1 - 0.4 r^2, exposures that sway by 1 EV."""

    def __init__(self, channels=1, seed=1):
        self.dice, self.channels = np.random.default_rng(seed), channels
        self.x, self.y = self.dice.uniform(0, WIDTH - 1, 200), self.dice.uniform(0, HEIGHT - 1, 200)
        self.light = np.exp(-3.5 * self.dice.uniform(size=(200, channels)))
        self.tracks, self.frame = np.arange(200), -1

    def next(self):
        self.frame += 1
        self.x = self.x + 6.0 * (self.frame > 0)
        out = self.x > WIDTH - 1
        self.x[out] -= WIDTH - 1
        self.tracks = np.where(out, self.tracks + 200, self.tracks)
        self.light[out] = np.exp(-3.5 * self.dice.uniform(size=(out.sum(), self.channels)))
        self.ev = math.sin(self.frame / 25.0)
        r2 = ((self.x - (WIDTH - 1) / 2) ** 2 + (self.y - (HEIGHT - 1) / 2) ** 2) / 400.0 ** 2
        irradiance = self.light * (1.0 - (1.0 - CORNER) * r2)[:, None] * 2.0 ** self.ev
        values = np.clip(irradiance, 0, 1) ** (1 / GAMMA) + self.dice.normal(0, 0.006, self.light.shape)
        return self.tracks, np.column_stack([self.x, self.y]), np.clip(values, 0, 1)


class OnlineTest(unittest.TestCase):
    def run_film(self, frames, **options):
        film = Film(options.get("channels", 1))
        online = lp.Online(lp.OnlineOptions(width=WIDTH, height=HEIGHT, tracks=200, **options))
        for number in range(frames):
            exposure = online.add(number, *film.next(), known_ev=film.ev + 5, known_ev_sigma=0.1)
            online.solve()
        return film, online, exposure

    def test_exposure_and_camera(self):
        film, online, exposure = self.run_film(300)
        self.assertEqual(exposure.state, lp.OnlineState.CHAINED)
        self.assertLess(abs(exposure.ev - film.ev), 4 * exposure.ev_sigma)
        self.assertLess(exposure.step_sigma, 0.02)
        result = online.result
        self.assertLess(abs(result.corner - CORNER), 4 * result.corner_sigma)
        self.assertLess(result.corner_sigma, 0.03)
        self.assertEqual(result.known, sum(lp.OnlineKnown))
        self.assertEqual((result.frames, result.lost, result.chains), (300, 0, 1))
        profile = online.profile(lp.ProfileKey(lens="a lens"), source="film")
        self.assertEqual((profile.key.lens, profile.provenance.source), ("a lens", "film"))
        self.assertLess(abs(profile.falloff(WIDTH, HEIGHT, 0, 0)[0] - result.corner), 0.01)

    def test_earlier_exposures(self):
        film, online, _ = self.run_film(40)
        exposure = online.add(40, *film.next())
        self.assertEqual(online.exposure(40).ev, exposure.ev)
        self.assertLess(abs(online.exposure(30).ev - math.sin(30 / 25.0)), 4 * online.exposure(30).ev_sigma)
        with self.assertRaises(lp.Error) as caught:
            online.exposure(41)
        self.assertEqual(caught.exception.status, lp.Status.ERROR_NOT_FOUND)

    def test_channels(self):
        _, online, exposure = self.run_film(20, channels=3)
        np.testing.assert_allclose(exposure.white_balance, 1.0, atol=0.05)

    def test_lost(self):
        online = lp.Online(lp.OnlineOptions(width=WIDTH, height=HEIGHT))
        exposure = online.add(3, [], [], [])
        self.assertEqual(exposure.state, lp.OnlineState.LOST)
        self.assertTrue(math.isnan(exposure.ev) and math.isinf(exposure.ev_sigma))
        self.assertFalse(online.solve(5))

    def test_bad_input(self):
        with self.assertRaises(lp.Error):
            lp.Online(lp.OnlineOptions())
        with self.assertRaises(TypeError):
            lp.Online(None)
        online = lp.Online(lp.OnlineOptions(width=WIDTH, height=HEIGHT, tracks=8))
        good = [1, 2], [[10, 10], [20, 20]], [0.4, 0.5]
        online.add(1, *good)
        for number, tracks, xy, values, status in [
                (1, *good, lp.Status.ERROR_ARGUMENT),
                (2, [1, 1], good[1], good[2], lp.Status.ERROR_ARGUMENT),
                (2, good[0], [[10, 10], [700, 20]], good[2], lp.Status.ERROR_ARGUMENT),
                (2, good[0], good[1], [0.4, 1.5], lp.Status.ERROR_ARGUMENT),
                (2, good[0], good[1], [0.4, math.nan], lp.Status.ERROR_NOT_FINITE),
                (2, list(range(9)), [[1, 1]] * 9, [0.5] * 9, lp.Status.ERROR_CAPACITY)]:
            with self.assertRaises(lp.Error) as caught:
                online.add(number, tracks, xy, values)
            self.assertEqual(caught.exception.status, status)
        with self.assertRaises(ValueError):
            online.add(2, [1], [[1, 2], [3, 4]], [0.5])
        with self.assertRaises(ValueError):
            online.add(2, [1], [[1, 2]], [[0.5, 0.5, 0.5]])
        with self.assertRaises(TypeError):
            online.add(2, [1.5], [[1, 2]], [0.5])
        self.assertEqual(online.result.frames, 1)


if __name__ == "__main__":
    unittest.main()
