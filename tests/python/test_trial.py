"""Trials of profiles on pairs."""
import unittest

import numpy as np

import lensprof as lp
from support import FALLOFF, fit_images, pictures, refused, sample_images, true_profile


def changed(factor):
    profile = true_profile()
    profile.vignetting = lp.Vignetting(k=tuple(factor * k for k in FALLOFF))
    return profile


class Trial(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.pairs = lp.sample_overlap(sample_images(pictures()))

    def test_true_profile_is_best(self):
        result = lp.try_profiles(fit_images(), self.pairs, [changed(0.0), changed(0.5), true_profile()])
        self.assertEqual(result.best, 2)
        self.assertTrue(result.usable and result.decided)
        self.assertEqual([c.has_falloff for c in result.candidates], [False, True, True])
        self.assertEqual(result.images, 3)
        best = result.candidates[2]
        self.assertLess(best.heldout_rms, 2.5)  # noise of one level at both ends
        self.assertTrue(best.as_good_as_best and best.better_than_none)
        self.assertEqual(best.response_from, lp.TrialResponse.OWN)
        self.assertAlmostEqual(best.below_none, result.none.heldout_rms - best.heldout_rms)
        self.assertFalse(result.none.has_falloff)
        self.assertGreater(result.before_rms, result.none.heldout_rms)
        self.assertIn("decided=True", repr(result))

    def test_repeated(self):
        first, second = (lp.try_profiles(fit_images(), self.pairs, [true_profile()]) for _ in range(2))
        self.assertEqual(bytes(first), bytes(second))
        self.assertEqual(*(bytes(r.candidates[0]) for r in (first, second)))

    def test_sensor_data(self):
        result = lp.try_profiles(fit_images(), self.pairs, [true_profile()], camera_kind=lp.CameraKind.LINEAR)
        self.assertEqual(result.candidates[0].response_from, lp.TrialResponse.LINEAR)

    def test_refused(self):
        outside, unknown = self.pairs.copy(), self.pairs.copy()
        outside["image"][3] = (0, 7)
        unknown["value"][4, 1, 2] = np.nan
        for pairs, profiles, status in ((self.pairs, [], lp.Status.ERROR_ARGUMENT),
                                        (self.pairs[:20], [true_profile()], lp.Status.ERROR_NO_SAMPLES),
                                        (self.pairs[:0], [true_profile()], lp.Status.ERROR_NO_SAMPLES),
                                        (outside, [true_profile()], lp.Status.ERROR_ARGUMENT),
                                        (unknown, [true_profile()], lp.Status.ERROR_NOT_FINITE)):
            with self.subTest(status=status, pairs=len(pairs)), refused(self, status):
                lp.try_profiles(fit_images(), pairs, profiles)
        with self.assertRaises(TypeError):
            lp.try_profiles(fit_images(), self.pairs, [None])


if __name__ == "__main__":
    unittest.main()
