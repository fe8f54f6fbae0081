#!/usr/bin/env python3
"""Tests of the reference method of Engel et al.: it recovers a simulated response."""
import unittest

import numpy as np

import response_calib


class ResponseCalib(unittest.TestCase):
    def test_a_gamma_of_two(self):
        random = np.random.default_rng(3)
        light = np.exp(random.normal(0.0, 0.8, (24, 32)))
        times = 2.0 ** np.arange(-8.0, 2.0, 0.1)
        frames = [np.round(255 * np.sqrt(np.minimum(light * t, 1.0))).astype(np.uint8) for t in times]
        g = response_calib.inverse_response(frames, times)
        levels = np.arange(20, 250)
        truth = (levels / 255.0) ** 2
        scale = np.median(g[levels] / truth)
        errors = 255 * np.sqrt(g[levels] / scale) - levels
        self.assertLess(np.sqrt(np.mean(errors ** 2)), 0.5)

    def test_white_leaks_two_pixels(self):
        frame = np.zeros((1, 7, 7), np.uint8)
        frame[0, 3, 3] = 255
        _, counts = response_calib.without_white(frame)
        self.assertEqual(int((~counts).sum()), 25)


if __name__ == "__main__":
    unittest.main()
