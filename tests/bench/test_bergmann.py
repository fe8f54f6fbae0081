#!/usr/bin/env python3
"""Tests of the reference method of Bergmann et al.: it recovers a simulated camera, and follows corners."""
import unittest

import numpy as np

import bergmann
import clips
import tools
import video

FRAMES, SPEED, PIXELS = 150, 5.0, 16


def simulated(response, k, noise, seed=1):
    """Tracks of a pan with known positions, 150 points per frame, noise before rounding -> tracks, truth."""
    random = np.random.default_rng(seed)
    width, height = clips.WIDTH, clips.HEIGHT
    ev = np.cumsum(random.normal(0, 0.12, FRAMES))
    ev -= ev.mean()
    count = int(150 * (width + FRAMES * SPEED) / width)
    x, y = random.uniform(0, width + FRAMES * SPEED, count), random.uniform(0, height, count)
    light = 0.5 * np.exp2(random.uniform(-5, -0.3, (count, 1)) + random.normal(0, 0.3, (count, PIXELS)))
    rows = []
    for i in range(FRAMES):
        at = x - i * SPEED
        ids = np.flatnonzero((at > 0) & (at < width - 1))
        r2 = (4 * (at[ids] - (width - 1) / 2) ** 2 + 4 * (y[ids] - (height - 1) / 2) ** 2) / (width ** 2 + height ** 2)
        seen = np.clip(light[ids] * (clips.falloff(k, r2) * 2 ** ev[i])[:, None], 0, 1)
        grey = 255 * clips.RESPONSES[response](seen) + noise * random.normal(size=seen.shape)
        rows.append((ids, np.full(len(ids), i), r2, np.clip(np.round(grey) if noise else grey, 0, 255), np.ones(seen.shape)))
    return bergmann.Tracks(*(np.concatenate(part) for part in zip(*rows))), {"ev": ev.tolist(), "k": k, "response": response}


class Bergmann(unittest.TestCase):
    def errors(self, *of):
        tracks, truth = simulated(*of)
        c, a, ev, fast = bergmann.fit(tracks)
        fall, g = bergmann.attenuation(a, video.RADII ** 2), bergmann.inverse(c, np.arange(256))
        return [video.score(truth, e, fall, g)["aligned"] for e in (ev, fast)]

    def test_recovers_a_camera(self):
        """Without noise exactly, but for what four modes of EMoR leave of the response."""
        for of, most_ev, most_levels in ((("gamma 2.2", (-0.45, 0.0, 0.0), 0), 0.001, 0.5),
                                         (("gamma 2.2", (-0.9, 0.25, 0.0), 1), 0.006, 1.2),
                                         (("S curve", (-0.45, 0.0, 0.0), 1), 0.006, 1.2)):
            with self.subTest(of=of):
                for found in self.errors(*of):  # of the backend, and fast
                    self.assertLess(found["ev"], most_ev)
                    self.assertLess(found["falloff"], 0.005)
                    self.assertLess(found["response_rms"], most_levels)

    def test_white_and_black_count_for_nothing(self):
        tracks = bergmann.Tracks(np.zeros(1, int), np.zeros(1, int), np.zeros(1), np.array([[0.0, 90.0, 255.0]]), np.ones((1, 3)))
        self.assertEqual(tracks.weight.tolist(), [[0.0, 1.0, 0.0]])

    @unittest.skipUnless(tools.OPENCV, tools.NO_OPENCV)
    def test_follows_corners_of_a_brighter_picture(self):
        import cv2
        random = np.random.default_rng(5)
        scene = 40 * np.exp(0.5 * cv2.GaussianBlur(random.normal(size=(200, 260)), (0, 0), 3) * 9)
        xy = np.stack(np.meshgrid(np.arange(40.0, 210, 20), np.arange(40.0, 160, 20)), -1).reshape(-1, 2)
        moved = cv2.warpAffine(scene, np.float32([[1, 0, 3.3], [0, 1, -2.6]]), (260, 200))
        ahead = bergmann.follow(*(bergmann.pyramid(p.astype(np.float32)) for p in (scene, 1.3 * moved)), xy)
        self.assertLess(np.median(np.hypot(*(ahead - xy - (3.3, -2.6)).T)), 0.15)


class Score(unittest.TestCase):
    """Of video.py, on truth with a known distortion."""

    def test_the_exponent_is_removed(self):
        ev = np.sin(np.arange(100) / 9.0)
        truth = {"ev": ev.tolist(), "k": (-0.45, 0.0, 0.0), "response": "S curve"}
        g = np.interp(np.arange(256) / 255.0, clips.s_curve(clips.FINE), clips.FINE) ** 0.8
        found = video.score(truth, 0.8 * ev + 3.0, 2.0 * (1 - 0.45 * video.RADII ** 2) ** 0.8, g)
        self.assertAlmostEqual(found["exponent"], 0.8, 6)
        for name, most in (("ev", 1e-9), ("drift", 1e-9), ("falloff", 1e-9), ("response", 0.3)):
            self.assertLess(found["aligned"][name], most)
            self.assertGreater(found["raw"][name], 0.05)

    def test_rings_of_a_picture(self):
        picture = 1 - 0.5 * clips.radius2()
        np.testing.assert_allclose(video.by_radius(picture), 1 - 0.5 * video.RADII ** 2, atol=0.003)


if __name__ == "__main__":
    unittest.main()
