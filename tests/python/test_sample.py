"""Sampling overlapping arrays."""
import unittest

import numpy as np

import lensprof as lp
from support import HEIGHT, WIDTH, cameras, fit_images, pictures, radiance, read_only, refused, sample_images


class Sampling(unittest.TestCase):
    def test_pairs_see_the_same_point(self):
        pairs = lp.sample_overlap(sample_images(pictures()))
        self.assertEqual(pairs.dtype, lp.PAIR_DTYPE)
        self.assertGreater(len(pairs), 1500)
        self.assertLessEqual(len(pairs), 2000)
        self.assertTrue((pairs["image"][:, 0] != pairs["image"][:, 1]).all())
        for i, camera in enumerate(cameras()):
            for side in (0, 1):
                chosen = pairs[pairs["image"][:, side] == i]
                here = camera.unproject(chosen["xy"][:, side, 0], chosen["xy"][:, side, 1])
                others = chosen["xy"][:, 1 - side]
                for j, other in enumerate(cameras()):
                    at = chosen["image"][:, 1 - side] == j
                    there = other.unproject(others[at, 0], others[at, 1])
                    np.testing.assert_allclose(here[at], there, atol=1e-9)

    def test_matches(self):
        true = lp.sample_overlap(sample_images(pictures()), lp.SampleOptions(pairs=900))
        matches = np.zeros(len(true), lp.MATCH_DTYPE)
        matches["image"], matches["xy"] = true["image"], true["xy"]
        options = lp.SampleOptions(pairs=500)
        pairs = lp.sample_matches(sample_images(pictures()), matches, options)
        self.assertEqual(pairs.dtype, lp.PAIR_DTYPE)
        self.assertGreater(len(pairs), 400)
        known = {tuple(xy) for xy in true["xy"].reshape(-1, 4)}
        self.assertTrue(all(tuple(xy) in known for xy in pairs["xy"].reshape(-1, 4)))
        self.assertTrue((options.links["state"] == lp.LinkState.VERIFIED).all())
        np.testing.assert_array_equal(matches["xy"][options.match_of_pair], pairs["xy"])
        with self.assertRaises(TypeError):
            lp.sample_matches(sample_images(pictures()), true)
        matches["image"][3] = 7
        with refused(self, lp.Status.ERROR_ARGUMENT) as caught:
            lp.sample_matches(sample_images(pictures()), matches)
        self.assertEqual((caught.exception.item_kind, caught.exception.item_index), (lp.ItemKind.MATCH, 3))

    def test_tracks(self):
        tracks = lp.sample_tracks(sample_images(pictures()), lp.SampleOptions(pairs=500))
        self.assertEqual(tracks.dtype, lp.OBSERVATION_DTYPE)
        points, count = np.unique(tracks["point"], return_counts=True)
        self.assertGreater(len(points), 400)
        self.assertEqual(set(count), {2, 3})
        directions = np.zeros((len(tracks), 2))
        for i, camera in enumerate(cameras()):
            own = tracks["image"] == i
            directions[own] = camera.unproject(tracks["xy"][own, 0], tracks["xy"][own, 1])
        first = np.searchsorted(tracks["point"], tracks["point"])
        np.testing.assert_allclose(directions, directions[first], atol=1e-9)
        result = lp.fit_radiance(fit_images(), tracks)
        self.assertTrue(result.usable, [f.text for f in result.findings])
        self.assertLess(result.heldout_rms, 1)

    def test_links_reach_the_fit(self):
        options = lp.SampleOptions()
        self.assertIsNone(options.links)
        pairs = lp.sample_overlap(sample_images(pictures()), options)
        links = options.links
        self.assertEqual(links.dtype, lp.LINK_DTYPE)
        self.assertEqual(links["pairs"].sum(), len(pairs))
        self.assertTrue((links["image"][:, 0] < links["image"][:, 1]).all())
        self.assertLessEqual(set(links["state"]), set(lp.LinkState))
        links["state"] = lp.LinkState.UNVERIFIED
        result = lp.fit_overlap(fit_images(), pairs, lp.FitOptions(links=links))
        self.assertTrue(result.usable and result.equalizes)
        self.assertTrue({f.code for f in result.findings} & {lp.Reason.LINKS_UNVERIFIED, lp.Reason.MISSING_GREYS})
        links["state"] = 7
        with refused(self, lp.Status.ERROR_ARGUMENT):
            lp.fit_overlap(fit_images(), pairs, lp.FitOptions(links=links))
        with self.assertRaises(TypeError):
            lp.FitOptions(links=[1, 2])

    def test_an_image_that_does_not_agree(self):
        pairs = lp.sample_overlap(sample_images(pictures()))
        of_two = (pairs["image"] == 2).any(axis=1)
        pairs = pairs[~of_two | (np.arange(len(pairs)) % 5 == 0)].copy()
        random = np.random.default_rng(1)
        for side in (0, 1):
            own = pairs["image"][:, side] == 2
            pairs["value"][own, side] = random.uniform(0.1, 0.9, (own.sum(), 3))
        result = lp.fit_overlap(fit_images(), pairs)
        self.assertEqual((result.left_out, result.reference), (1, 0))
        self.assertEqual(list(result.image_quality["joined"]), [1, 1, 0])
        self.assertEqual(list(np.isnan(result.exposures["ev"])), [False, False, True])

    def test_values_are_those_of_the_pictures(self):
        arrays = pictures()
        pairs = lp.sample_overlap(sample_images(arrays))
        column, row = np.rint(pairs["xy"][:, 0]).astype(int).T
        for i, array in enumerate(arrays):
            own = pairs["image"][:, 0] == i
            difference = pairs["value"][own, 0] * 255 - array[row[own], column[own]]
            self.assertLess(np.median(np.abs(difference)), 2)  # patches of 5 x 5 px compared with one noisy pixel

    def test_options(self):
        images = sample_images(pictures())
        few = lp.sample_overlap(images, lp.SampleOptions(pairs=300, seed=4))
        np.testing.assert_array_equal(few, lp.sample_overlap(images, lp.SampleOptions(pairs=300, seed=4)))
        self.assertFalse(np.array_equal(few, lp.sample_overlap(images, lp.SampleOptions(pairs=300, seed=5))))
        self.assertLessEqual(len(few), 300)
        paper = lp.sample_overlap(images, lp.SampleOptions(pairs=300, sampling=lp.Sampling.PAPER))
        self.assertGreater(len(paper), 100)

    def test_a_known_camera(self):
        """Linear pictures 40 times apart in light join by their light alone; the pairs hold their own values."""
        bright, dark = [array.astype(np.float32) / 255 * 0.9 for array in pictures()[:2]]
        dark /= 40
        images = [lp.SampleImage(array, camera, black=1e-4) for array, camera in zip((bright, dark), cameras())]
        options = lp.SampleOptions(pairs=300, response=lp.Response.linear(), vignetting=lp.Vignetting())
        self.assertEqual(options.response, lp.Response.linear())
        pairs = lp.sample_overlap(images, options)
        self.assertGreater(len(pairs), 100)
        self.assertLess(pairs["value"].min(), 0.02)
        self.assertIsNone(lp.SampleOptions().response)
        with self.assertRaises(TypeError):
            lp.SampleOptions(response=2.2)
        with refused(self, lp.Status.ERROR_VIGNETTING):
            lp.sample_overlap(images, lp.SampleOptions(vignetting=lp.Vignetting(k=(-3, 0, 0))))

    def test_views_of_any_kind(self):
        """The same picture in another place, order and type gives the same pairs."""
        arrays = pictures()
        expected = lp.sample_overlap(sample_images(arrays))
        inside = np.zeros((3, HEIGHT + 20, WIDTH + 30, 3), dtype=np.uint8)
        slices = [frame[5:5 + HEIGHT, 7:7 + WIDTH] for frame in inside]
        upside_down = [np.ascontiguousarray(array[::-1])[::-1] for array in arrays]
        for view, array in zip(slices, arrays):
            view[...] = array
        for views in (slices, upside_down):
            np.testing.assert_array_equal(lp.sample_overlap(sample_images(views)), expected)
        mirrored = [lp.SampleImage(np.ascontiguousarray(array[..., ::-1]), camera, layout=lp.Layout.BGR)
                    for array, camera in zip(arrays, cameras())]
        np.testing.assert_array_equal(lp.sample_overlap(mirrored), expected)

    def test_read_only_memory(self):
        mapped = [read_only(picture) for picture in pictures()]
        for array, image in zip(mapped, sample_images(mapped)):
            self.assertFalse(array.flags.writeable)
            self.assertEqual(image._view(0).view.data, array.ctypes.data)  # no copy
        options = lp.SampleOptions(pairs=300)
        for call in (lp.sample_overlap, lp.sample_tracks):
            np.testing.assert_array_equal(call(sample_images(mapped), options), call(sample_images(pictures()), options))

    def test_masks(self):
        arrays, mask = pictures(), np.zeros((HEIGHT * 2, WIDTH), dtype=bool)
        mask[::-2, :][:, : WIDTH // 2] = True
        images = sample_images(arrays)
        images[0].mask = mask[::-2]  # rows reversed and with gaps: the left half
        pairs = lp.sample_overlap(images)
        used = np.concatenate([pairs["xy"][pairs["image"][:, side] == 0, side, 0] for side in (0, 1)])
        self.assertGreater(len(used), 100)
        self.assertLess(used.max(), WIDTH // 2)
        self.assertLess(used.min(), WIDTH // 4)

    def test_alpha_excludes(self):
        alpha = np.full((HEIGHT, WIDTH, 1), 255, dtype=np.uint8)
        alpha[:, WIDTH // 2:] = 0
        images = sample_images(pictures())
        images[0].array = np.concatenate([images[0].array, alpha], axis=2)
        pairs = lp.sample_overlap(images)
        used = np.concatenate([pairs["xy"][pairs["image"][:, side] == 0, side, 0] for side in (0, 1)])
        self.assertLess(used.max(), WIDTH // 2)

    def test_reduced_pictures(self):
        large = [lp.Camera(width=WIDTH * 2, height=HEIGHT * 2, hfov_deg=45, yaw_deg=camera.yaw_deg)
                 for camera in cameras()]
        images = [lp.SampleImage(array, camera, reduction=2) for array, camera in zip(pictures(), large)]
        pairs = lp.sample_overlap(images)
        self.assertGreater(pairs["xy"][..., 0].max(), WIDTH * 1.5)

    def test_grey_floats_repeat_their_value(self):
        y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
        images = [lp.SampleImage(radiance(camera.unproject(x, y))[..., 1].astype(np.float32), camera)
                  for camera in cameras()]
        pairs = lp.sample_overlap(images)
        np.testing.assert_array_equal(pairs["value"][..., 0], pairs["value"][..., 2])
        np.testing.assert_allclose(pairs["value"][:, 0], pairs["value"][:, 1], atol=0.01)  # the scene itself


class Threads(unittest.TestCase):
    def test_any_number_gives_the_same_pairs(self):
        images = sample_images(pictures())
        one, five = (lp.sample_overlap(images, lp.SampleOptions(threads=threads)) for threads in (1, 5))
        np.testing.assert_array_equal(one, five)

    def test_progress(self):
        seen = []
        options = lp.SampleOptions(progress=seen.append)
        lp.sample_overlap(sample_images(pictures()), options)
        self.assertEqual((seen, seen[-1]), (sorted(seen), 1.0))
        self.assertIsNone(lp.SampleOptions().progress)

    def test_progress_cancels(self):
        with refused(self, lp.Status.ERROR_CANCELLED):
            lp.sample_overlap(sample_images(pictures()), lp.SampleOptions(progress=lambda done: True))


class Refused(unittest.TestCase):
    def test_by_the_library(self):
        arrays = pictures()
        images = sample_images(arrays)
        with refused(self, lp.Status.ERROR_ARGUMENT):
            lp.sample_overlap(images[:1])
        far = [lp.SampleImage(array, lp.Camera(width=WIDTH, height=HEIGHT, hfov_deg=20, yaw_deg=90 * i))
               for i, array in enumerate(arrays)]
        with refused(self, lp.Status.ERROR_NO_OVERLAP):
            lp.sample_overlap(far)
        dark = [lp.SampleImage(np.zeros_like(array), camera) for array, camera in zip(arrays, cameras())]
        with refused(self, lp.Status.ERROR_NO_SAMPLES):
            lp.sample_overlap(dark)
        images[1].array = arrays[1].astype(np.float32) / 255
        images[1].array[3, 5, 1] = np.nan
        with refused(self, lp.Status.ERROR_NOT_FINITE) as caught:
            lp.sample_overlap(images)
        self.assertIn("image 1: pixel 5, 3", caught.exception.text)
        images[1].camera = lp.Camera()
        with refused(self, lp.Status.ERROR_GEOMETRY):
            lp.sample_overlap(images)

    def test_by_the_package(self):
        images = sample_images(pictures())
        images[2].array = images[2].array.astype(np.float64)
        with self.assertRaisesRegex(TypeError, "convert the picture"):
            lp.sample_overlap(images)
        images[2].array = np.zeros((HEIGHT, WIDTH * 2, 3), np.uint8)[:, ::2]
        with self.assertRaisesRegex(ValueError, "image 2 of shape"):
            lp.sample_overlap(images)
        for mask, error in ((np.zeros((HEIGHT, WIDTH)), TypeError), (np.zeros((WIDTH, HEIGHT), bool), ValueError),
                            (np.zeros((HEIGHT, WIDTH * 2), bool)[:, ::2], ValueError), ([[1]], TypeError)):
            images = sample_images(pictures())
            images[0].mask = mask
            with self.assertRaises(error):
                lp.sample_overlap(images)


if __name__ == "__main__":
    unittest.main()
