"""Fitting pairs, and the complete way from overlapping arrays to corrected ones."""
import gc
import os
import signal
import subprocess
import sys
import threading
import unittest
from datetime import datetime, timezone
import weakref

import numpy as np

import lensprof as lp
from support import (EXPOSURES, RED, fit_images, linear_options, pictures, refused, sample_images, simple_pairs,
                     true_profile, two_images)


def overlap_rms(pairs):
    """RMS difference between the two pictures of every pair, levels of 255."""
    return 255 * np.sqrt(np.mean((pairs["value"][:, 0] - pairs["value"][:, 1]) ** 2))


class WholeWay(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.pictures = pictures()
        cls.pairs = lp.sample_overlap(sample_images(cls.pictures))
        cls.result = lp.fit_overlap(fit_images(), cls.pairs)
        # f and M are known up to a common exponent: compare after removing the gamma between the responses.
        grey = np.linspace(0.1, 0.9, 50)
        found, true = np.log(cls.result.response.invert(grey)), np.log(true_profile().response[0].invert(grey))
        cls.gamma = (found @ true) / (true @ true)
        cls.response_error = np.abs(np.exp(found / cls.gamma) - np.exp(true)).max()

    def test_parameters_are_near_the_truth(self):
        self.assertTrue(self.result.usable, [f.text for f in self.result.findings])
        self.assertTrue(self.result.converged)
        self.assertLess(abs(self.gamma - 1), 0.1)
        self.assertLess(self.response_error, 0.01)
        np.testing.assert_allclose(self.result.exposures["ev"] / self.gamma, EXPOSURES, atol=0.02)
        np.testing.assert_allclose(self.result.exposures["white_balance"][:, 0] ** (1 / self.gamma), RED, atol=0.02)
        r2 = np.linspace(0, 1, 11)
        np.testing.assert_allclose(self.result.vignetting[0].eval(r2) ** (1 / self.gamma),
                                   true_profile().vignetting[0].eval(r2), atol=0.02)

    def test_by_transfer_functions(self):
        options = lp.FitOptions()
        options.method = lp.Method.TRANSFER_FUNCTION
        result = lp.fit_overlap(fit_images(), self.pairs, options)
        self.assertTrue(result.usable, [f.text for f in result.findings])
        found, true = result.exposures["ev"], np.array(EXPOSURES)
        np.testing.assert_allclose(found * ((true @ true) / (true @ found)), true, atol=0.05)

    def test_statistics(self):
        result = self.result
        self.assertGreater(result.before_rms, 10)
        self.assertLess(result.heldout_rms, 1)
        self.assertEqual((result.components, result.covariance.shape), (1, (result.response.modes + 5,) * 2))
        self.assertTrue((np.diag(result.covariance) > 0).all())
        rms, median = result.transfer_rms(self.pairs)
        self.assertLess(abs(rms - result.heldout_rms), 0.3)
        self.assertLess(median, rms)

    def test_corrected_overlap_agrees(self):
        profile = self.result.profile(lp.ProfileKey(lens="test"))
        reference = self.result.exposure(0)
        for i, array in enumerate(self.pictures):
            lp.correct(array, profile, source=self.result.exposure(i), target=reference, out=array)
        after = lp.sample_overlap(sample_images(self.pictures))
        self.assertGreater(overlap_rms(self.pairs), 30)
        self.assertLess(overlap_rms(after), 1)

    def test_profile(self):
        profile = self.result.profile(lp.ProfileKey(lens="test"), source="a.pto", created=datetime.fromtimestamp(5, timezone.utc))
        profile.validate()
        self.assertEqual((profile.response, profile.vignetting), ((self.result.response,), self.result.vignetting))
        np.testing.assert_array_equal(profile.covariance, self.result.covariance)
        self.assertEqual(profile.provenance, lp.Provenance(
            method="transfer", software=f"lensprof {lp.version()}", source="a.pto",
            created=datetime.fromtimestamp(5, timezone.utc), images=3,
            pairs=self.result.pairs, heldout_rms=self.result.heldout_rms, inlier_share=self.result.inlier_share,
            gamma_sigma=self.result.gamma_sigma))

    def test_same_input_same_result(self):
        again = lp.fit_overlap(fit_images(), self.pairs)
        self.assertEqual(again.response, self.result.response)
        np.testing.assert_array_equal(again.exposures, self.result.exposures)


class Fits(unittest.TestCase):
    def test_exposure_of_a_linear_pair(self):
        for loss in lp.Loss:
            result = lp.fit_overlap(two_images(), simple_pairs(gain=1.5), linear_options(loss=loss))
            np.testing.assert_allclose(result.exposures["ev"], [0, np.log2(1.5)], atol=1e-4)
            self.assertEqual(result.exposure(1).ev, result.exposures["ev"][1])

    def test_links(self):
        images = [lp.FitImage(0, 240, 180), lp.FitImage(1, 240, 180, free=lp.Free.EV),
                  lp.FitImage(2, 240, 180, free=lp.Free.EV, ev_of=1)]
        self.assertEqual((images[1].ev_of, images[1].red_of, images[2].ev_of, images[2].blue_of), (1, 1, 1, 2))
        pairs = np.concatenate([simple_pairs(), simple_pairs()])
        pairs["image"][len(pairs) // 2:] = (0, 2)
        result = lp.fit_overlap(images, pairs, linear_options())
        self.assertEqual(result.exposures["ev"][1], result.exposures["ev"][2])
        self.assertAlmostEqual(result.exposures["ev"][1], np.log2(1.5), places=4)

    def test_lens_settings(self):
        images = two_images()
        images[1].setting = 4
        result = lp.fit_overlap(images, simple_pairs(), linear_options(free=lp.Free.K1))
        self.assertEqual([s.images for s in result.settings], [1, 0, 0, 0, 1])
        self.assertEqual(result.settings[0].vignetting, result.vignetting)
        np.testing.assert_array_equal(result.settings[0].covariance, result.covariance)
        self.assertEqual(result.settings[4].setting_pairs, len(simple_pairs()))
        key = lp.ProfileKey(camera_model="c")
        self.assertEqual(result.profile(key, setting=4).vignetting[0], result.settings[4].vignetting[0])
        self.assertEqual(result.profile(key).vignetting[0], result.vignetting[0])
        with self.assertRaisesRegex(lp.Error, "setting 2 has no image in it"):
            result.profile(key, setting=2)
        with self.assertRaises(lp.Error):
            images[1].setting = lp.SETTINGS_MAX
            lp.fit_overlap(images, simple_pairs(), linear_options())

    def test_cameras(self):
        images = [lp.FitImage(i, 240, 180, setting=i // 2, camera=i // 2) for i in range(4)]
        rng, gain = np.random.default_rng(3), (1.0, 1.5, 0.8, 1.2)
        pairs = np.zeros(3000, dtype=lp.PAIR_DTYPE)
        for n in range(len(pairs)):
            pairs["image"][n] = sorted(rng.choice(4, 2, replace=False))
            pairs["xy"][n] = rng.uniform((0, 0), (239, 179), (2, 2))
            light = rng.uniform(0.05, 0.6) * np.array([1.0, 1.1, 0.9])
            for end in range(2):
                seen = pairs["image"][n, end]
                exponent = 1 / 2.2 if seen < 2 else 1 / 1.8
                pairs["value"][n, end] = (light * gain[seen]) ** exponent + rng.normal(0, 0.001, 3)
        result = lp.fit_overlap(images, pairs, lp.FitOptions(free=lp.Free.RESPONSE))
        self.assertEqual([(c.images, c.attached, c.joined) for c in result.cameras], [(2, 0, True), (2, 0, True)])
        self.assertEqual(result.left_out, 0)
        self.assertGreater(result.cameras[1].shared_pairs, 1000)
        own = [np.interp(0.5, np.linspace(0, 1, 1024), result.settings[c.setting].response.table) for c in result.cameras]
        self.assertGreater(own[0], own[1])
        profile = result.profile(lp.ProfileKey(camera_model="c"), setting=1)
        self.assertEqual(profile.response[0], result.settings[1].response)
        self.assertNotEqual(profile.response[0], result.response)
        with self.assertRaises(lp.Error):
            images[1].camera = 1
            lp.fit_overlap(images, pairs)

    def test_pairs_are_not_copied(self):
        from lensprof import _arrays
        import ctypes
        pairs = simple_pairs()
        pointer, count = _arrays.pairs(pairs[100:])
        self.assertEqual((ctypes.addressof(pointer.contents), count), (pairs.ctypes.data + 100 * 88, 300))
        exposures = np.zeros(2, dtype=lp.EXPOSURE_DTYPE)
        self.assertIs(_arrays.exposures(exposures), exposures)

    def test_views_outlive_the_result(self):
        result = lp.fit_overlap(two_images(), simple_pairs(), linear_options())
        views = result.response.table, result.exposures, result.covariance, result.vignetting[0]
        copies = [view.copy() for view in views]
        del result
        gc.collect()
        junk = [lp.FitResult() for _ in range(20)]
        for view, expected in zip(views, copies):
            self.assertTrue(np.array_equal(view, expected) if isinstance(view, np.ndarray) else view == expected)
        del junk


class Tracks(unittest.TestCase):
    """The radiance method, with the pairs of two images as tracks."""

    def observations(self, gain=1.5):
        pairs = simple_pairs(gain=gain)
        tracks = np.zeros(2 * len(pairs), dtype=lp.OBSERVATION_DTYPE)
        for side in (0, 1):
            tracks["point"][side::2] = np.arange(len(pairs))
            tracks["image"][side::2] = side
            tracks["xy"][side::2] = pairs["xy"][:, side]
            tracks["value"][side::2] = pairs["value"][:, side]
        return tracks

    def test_exposure_of_a_linear_pair(self):
        options = linear_options(method=lp.Method.RADIANCE)
        result = lp.fit_radiance(two_images(), self.observations(), options)
        self.assertTrue(result.usable, [f.text for f in result.findings])
        self.assertAlmostEqual(result.exposures["ev"][1], np.log2(1.5), places=4)
        self.assertEqual(result.profile(lp.ProfileKey(lens="test")).provenance.method, "radiance")
        of_pairs = lp.fit_overlap(two_images(), simple_pairs(), options)
        self.assertAlmostEqual(of_pairs.exposures["ev"][1], result.exposures["ev"][1], places=6)

    def test_refused(self):
        tracks = self.observations()
        with refused(self, lp.Status.ERROR_ARGUMENT):
            lp.fit_radiance(two_images(), tracks[:-1])
        with refused(self, lp.Status.ERROR_UNSUPPORTED):
            lp.fit_radiance(two_images(), tracks, lp.FitOptions())
        with refused(self, lp.Status.ERROR_NO_SAMPLES):
            lp.fit_radiance(two_images(), tracks[:0])
        with self.assertRaises(TypeError):
            lp.fit_radiance(two_images(), simple_pairs())


class Options(unittest.TestCase):
    def test_defaults(self):
        options = lp.FitOptions()
        self.assertEqual(options.free, lp.Free.RESPONSE | lp.Free.K1 | lp.Free.K2 | lp.Free.K3 | lp.Free.CENTER)
        self.assertEqual((options.channels, options.modes, options.loss), (3, lp.MODES_AUTO, lp.Loss.ROBUST))
        self.assertEqual((options.huber_levels, options.prior_weight, options.max_iterations), (5, 1, 200))
        self.assertIsNone(options.response)
        self.assertIsNone(options.progress)

    def test_response_is_kept_alive(self):
        options = linear_options(response=lp.Response.from_gamma(2.0))
        gc.collect()
        junk = [lp.Response.from_gamma(0.5) for _ in range(50)]
        self.assertEqual(options.response, lp.Response.from_gamma(2.0))
        result = lp.fit_overlap(two_images(), simple_pairs(gain=1.5), options)
        self.assertAlmostEqual(result.exposures["ev"][1], 2 * np.log2(1.5), places=3)  # 1.5 in sqrt(light)
        options.response = None
        self.assertIsNone(options.response)
        self.assertEqual(lp.fit_overlap(two_images(), simple_pairs(), options).response.kind, lp.ResponseKind.EMOR)
        with self.assertRaises(TypeError):
            options.response = 2.0
        del junk

    def test_progress_is_kept_alive_and_called(self):
        seen = []

        def note(done):
            seen.append(done)
        options, alive = linear_options(progress=note), weakref.ref(note)
        del note
        gc.collect()
        self.assertIsNotNone(alive())
        lp.fit_overlap(two_images(), simple_pairs(), options)
        self.assertGreater(len(seen), 0)
        self.assertTrue(all(0 <= done <= 1 for done in seen) and seen == sorted(seen))
        del options
        gc.collect()
        self.assertIsNone(alive())

    def test_progress_cancels(self):
        with refused(self, lp.Status.ERROR_CANCELLED):
            lp.fit_overlap(two_images(), simple_pairs(), linear_options(progress=lambda done: True))

    def test_exception_in_progress_comes_out(self):
        def fail(done):
            raise ZeroDivisionError("mine")
        with self.assertRaisesRegex(ZeroDivisionError, "mine"):
            lp.fit_overlap(two_images(), simple_pairs(), linear_options(progress=fail))
        with self.assertRaises(TypeError):
            lp.FitOptions(progress=5)

    def test_interrupt_cancels(self):
        code = """
import os, signal, lensprof as lp, support
signal.signal(signal.SIGINT, signal.default_int_handler)
calls = []
def progress(done):
    calls.append(done)
    if len(calls) == 1:
        os.kill(os.getpid(), signal.SIGINT)
try:
    lp.fit_overlap(support.two_images(), support.simple_pairs(), lp.FitOptions(progress=progress))
except KeyboardInterrupt:
    print("interrupted", len(calls), signal.getsignal(signal.SIGINT) is signal.default_int_handler)
"""
        output = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True,
                                cwd=os.path.dirname(os.path.abspath(__file__)))
        self.assertEqual((output.stdout, output.stderr), ("interrupted 1 True\n", ""))

    def test_in_another_thread(self):
        results, before = [], signal.getsignal(signal.SIGINT)
        thread = threading.Thread(
            target=lambda: results.append(lp.fit_overlap(two_images(), simple_pairs(), linear_options())))
        thread.start()
        thread.join()
        self.assertTrue(results)
        self.assertIs(signal.getsignal(signal.SIGINT), before)


class Refused(unittest.TestCase):
    def expect(self, status, images=None, pairs=None, options=None):
        pairs = simple_pairs() if pairs is None else pairs
        before = pairs.copy()
        with refused(self, status):
            lp.fit_overlap(two_images() if images is None else images, pairs, options or linear_options())
        self.assertEqual(pairs.tobytes(), before.tobytes())

    def test_by_the_library(self):
        nan, far, bright = simple_pairs(), simple_pairs(), simple_pairs()
        nan["value"][5, 0, 1] = np.nan
        far["image"][7] = (0, 2)
        bright["value"][0, 1, 2] = 1.5
        self.expect(lp.Status.ERROR_NOT_FINITE, pairs=nan)
        self.expect(lp.Status.ERROR_ARGUMENT, pairs=far)
        self.expect(lp.Status.ERROR_ARGUMENT, pairs=bright)
        self.expect(lp.Status.ERROR_NO_SAMPLES, pairs=simple_pairs()[:0])
        self.expect(lp.Status.ERROR_NO_UNKNOWNS, images=[lp.FitImage(i, 800, 600, free=lp.Free(0)) for i in range(2)])
        self.expect(lp.Status.ERROR_ARGUMENT, images=two_images()[:1])
        self.expect(lp.Status.ERROR_SIZE, images=[lp.FitImage(i, 0, 10) for i in range(2)])
        self.expect(lp.Status.ERROR_ARGUMENT, options=linear_options(channels=2))
        self.expect(lp.Status.ERROR_VIGNETTING, options=linear_options(vignetting=lp.Vignetting(k=(-3, 0, 0))))

    def test_by_the_package(self):
        with self.assertRaisesRegex(TypeError, "pairs must be an array of dtype"):
            lp.fit_overlap(two_images(), np.zeros((5, 16)))
        with self.assertRaisesRegex(ValueError, "one contiguous dimension"):
            lp.fit_overlap(two_images(), simple_pairs()[::2])
        with self.assertRaisesRegex(TypeError, "numpy.ndarray, not list"):
            lp.fit_overlap(two_images(), [1])

    def test_transfer_rms(self):
        result = lp.fit_overlap(two_images(), simple_pairs(gain=1.5), linear_options())
        self.assertLess(result.transfer_rms(simple_pairs(gain=1.5))[0], 1e-3)
        far = simple_pairs()
        far["image"][7] = (0, 2)
        for pairs in (simple_pairs()[:0], far):
            with refused(self, lp.Status.ERROR_ARGUMENT):
                result.transfer_rms(pairs)

    def test_colour_differences(self):
        result = lp.fit_overlap(two_images(), simple_pairs(gain=1.5), linear_options())
        differences = result.colour_differences(simple_pairs(gain=1.5))
        self.assertEqual(differences.shape, (len(simple_pairs()),))
        self.assertLess(np.median(differences), 1e-3)
        with refused(self, lp.Status.ERROR_ARGUMENT):
            result.colour_differences(simple_pairs()[:0])

    def test_numbers_per_pair(self):
        pairs = simple_pairs()
        options = lp.FitOptions(points=np.arange(len(pairs)) // 2, view_distances=np.ones(len(pairs)))
        self.assertEqual(options.points.dtype, np.uint32)
        options.points = options.points[::-1][::-1]  # kept by the options
        lp.fit_overlap(two_images(), pairs, options)
        for wrong in (np.zeros(3, np.uint32), np.zeros((2, 2), np.uint32)):
            with self.assertRaisesRegex(ValueError, "one (number )?for each"):
                lp.fit_overlap(two_images(), pairs, lp.FitOptions(points=wrong))
        for wrong in ([0.7, 1.2], [-1, 0], [2**32, 0]):
            with self.assertRaisesRegex(ValueError, "integers of 0..4294967295"):
                options.points = wrong
        options.points = None
        with refused(self, lp.Status.ERROR_ARGUMENT):
            lp.fit_overlap(two_images(), pairs, options)

    def test_closed(self):
        result = lp.fit_overlap(two_images(), simple_pairs(), linear_options())
        result._fit.close()
        with self.assertRaisesRegex(ValueError, "is closed"):
            result.profile(lp.ProfileKey(lens="test"))


if __name__ == "__main__":
    unittest.main()
