"""Profiles as values."""
import gc
import math
import pickle
import unittest

import numpy as np

import lensprof as lp
from support import refused


class Keys(unittest.TestCase):
    def test_defaults(self):
        key = lp.ProfileKey()
        self.assertEqual((key.camera_maker, key.camera_model, key.lens), ("", "", ""))
        self.assertEqual((key.focal_mm, key.aperture, key.distance_m), (lp.UNKNOWN,) * 3)
        self.assertIs(key.processing, lp.Processing.JPEG)
        key.validate()

    def test_texts(self):
        key = lp.ProfileKey(lens="Objektiv f/2,8 – é")
        self.assertEqual(key.lens, "Objektiv f/2,8 – é")
        key.lens = "kurz"
        self.assertEqual(key.lens, "kurz")
        self.assertEqual(key, lp.ProfileKey(lens="kurz"))
        self.assertEqual(bytes(key), bytes(lp.ProfileKey(lens="kurz")))  # nothing is left of the longer text
        key.camera_model = "x" * 63
        with self.assertRaisesRegex(ValueError, "camera_model holds at most 63 bytes"):
            key.camera_model = "é" * 32
        with self.assertRaises(ValueError):
            key.camera_model = "a\0b"
        self.assertEqual(key.camera_model, "x" * 63)

    def test_refused(self):
        for key in (lp.ProfileKey(lens="a\nb"), lp.ProfileKey(focal_mm=0), lp.ProfileKey(aperture=math.nan)):
            with refused(self, lp.Status.ERROR_ARGUMENT):
                key.validate()
        lp.ProfileKey(distance_m=math.inf).validate()


class Profiles(unittest.TestCase):
    def test_defaults(self):
        profile = lp.Profile()
        self.assertEqual(profile.response, (lp.Response.linear(),))
        self.assertEqual(profile.vignetting, (lp.Vignetting(),))
        self.assertEqual(profile.covariance.shape, (0, 0))
        self.assertEqual(profile.provenance, lp.Provenance())
        profile.validate()

    def test_gain_grid(self):
        profile = lp.Profile(grid=lp.GainGrid([[1, 0.9], [0.8, 0.7]]))
        profile.validate()
        profile.grid.attenuation[0, 0, 0] = 0.5
        self.assertEqual(profile.grid, lp.GainGrid([[0.5, 0.9], [0.8, 0.7]]))
        profile.grid.attenuation[0, 1, 1] = 0
        with refused(self, lp.Status.ERROR_VIGNETTING):
            profile.validate()
        profile.grid = lp.GainGrid()
        profile.validate()
        self.assertEqual(profile, lp.Profile())

    def test_inner_values_share_memory(self):
        profile = lp.Profile()
        profile.key.lens = "50 mm"
        profile.provenance.images = 7
        profile.vignetting[0].k[1] = 0.5
        self.assertEqual((profile.key.lens, profile.provenance.images), ("50 mm", 7))
        self.assertEqual(profile.vignetting[0], lp.Vignetting(k=(0, 0.5, 0)))

    def test_inner_value_outlives_the_profile(self):
        key = lp.Profile(key=lp.ProfileKey(lens="50 mm")).key
        gc.collect()
        junk = [lp.Profile() for _ in range(20)]
        self.assertEqual(key.lens, "50 mm")
        del junk

    def test_one_or_three_curves(self):
        curves = [lp.Response.from_gamma(gamma) for gamma in (2, 2.1, 2.2)]
        profile = lp.Profile(response=curves, vignetting=lp.Vignetting(k=(-0.1, 0, 0)))
        self.assertEqual((profile.responses, profile.vignettings), (3, 1))
        self.assertEqual(profile.response, tuple(curves))
        profile.response = profile.response[::-1]  # from its own memory
        self.assertEqual(profile.response, tuple(curves[::-1]))
        profile.response = curves[0]
        self.assertEqual(profile.response, (curves[0],))
        for wrong in (curves[:2], [], [1, 2, 3]):
            with self.assertRaisesRegex(TypeError, "one Response for all channels, or three"):
                profile.response = wrong

    def test_covariance(self):
        profile, matrix = lp.Profile(), np.array([[2.0, 0.5], [0.5, 1.0]])
        profile.covariance = matrix
        np.testing.assert_array_equal(profile.covariance, matrix)
        profile.validate()
        profile.covariance[0, 1] = 3
        with refused(self, lp.Status.ERROR_ARGUMENT):
            profile.validate()
        profile.covariance = np.eye(36)
        profile.validate()
        for wrong in (np.eye(37), np.zeros((2, 3)), np.zeros(4)):
            with self.assertRaises(ValueError):
                profile.covariance = wrong
        self.assertEqual(profile.covariance_size, 36)

    def test_refused(self):
        profile = lp.Profile(vignetting=lp.Vignetting(k=(-2, 0, 0)))
        with refused(self, lp.Status.ERROR_VIGNETTING):
            profile.validate()
        profile = lp.Profile()
        profile.responses = 2
        with refused(self, lp.Status.ERROR_ARGUMENT):
            profile.validate()

    def test_copies(self):
        profile = lp.Profile(response=lp.Response.from_gamma(2), covariance=np.eye(3))
        for other in (profile.copy(), pickle.loads(pickle.dumps(profile))):
            self.assertEqual(other, profile)
            other.key.lens = "other"
            self.assertNotEqual(other, profile)


if __name__ == "__main__":
    unittest.main()
