"""The photograph library from Python: pictures, scenes, calibrations, corrected copies."""
import functools
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import threading
import unittest
import warnings
from datetime import datetime

import numpy as np

import lensprof as lp

PROGRAM = os.environ["LENSPROF_PROGRAM"]


def run(*words):
    return subprocess.run([PROGRAM, *map(str, words)], check=True, capture_output=True, text=True).stdout


@functools.cache
def rendered(*options):
    """A folder of six pictures, rendered once with these options."""
    folder = tempfile.mkdtemp()
    unittest.addModuleCleanup(shutil.rmtree, folder)
    run("simulate", "-o", folder, "--size", "400x300", *options)
    for other in [*pathlib.Path(folder).glob("*.pto"), *pathlib.Path(folder).glob("*.json")]:
        other.unlink()
    return pathlib.Path(folder)


@functools.cache
def calibrated():
    """The calibration of these pictures with default options, made once; a test must not close it."""
    return lp.calibrate(rendered())


class WithScene(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls._folder = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls._folder.name)
        cls.photos = rendered()
        cls.files = sorted(cls.photos.glob("*.png"))

    @classmethod
    def tearDownClass(cls):
        cls._folder.cleanup()

    def setUp(self):
        catch = warnings.catch_warnings()
        catch.__enter__()
        warnings.simplefilter("ignore", lp.Notice)
        self.addCleanup(catch.__exit__, None, None, None)


class TestPictures(WithScene):
    def test_read_and_write(self):
        picture = lp.read_picture(self.files[0])
        self.assertEqual(picture.pixels.shape, (300, 400, 3))
        self.assertEqual(picture.metadata.key.lens, "Simulated Lens")
        np.testing.assert_array_equal(lp.read_picture(self.files[0].read_bytes()).pixels, picture.pixels)
        self.assertLess(lp.read_picture(self.files[0], max_side=100).pixels.shape[1], 300)
        for name, pixels in (("a.png", picture.pixels), ("b.tif", picture.pixels.astype(np.uint16) * 257),
                             ("c.tif", picture.pixels / np.float32(255)), ("d.png", picture.pixels[::-1, ::2, 0].copy())):
            lp.write_picture(self.folder / name, pixels, like=picture)
            np.testing.assert_array_equal(lp.read_picture(self.folder / name).pixels, pixels)
        self.assertEqual(lp.read_picture(self.folder / "a.png").metadata.key.lens, "Simulated Lens")
        encoded = lp.encode_picture(".png", picture.pixels)
        np.testing.assert_array_equal(lp.read_picture(encoded).pixels, picture.pixels)
        self.assertLess(len(lp.encode_picture(".jpg", picture.pixels, jpeg_quality=30)), len(encoded))

    def test_metadata(self):
        key = lp.ProfileKey(camera_maker="Acme", camera_model="One", lens="A 50 mm", focal_mm=50, distance_m=2.5)
        taken = datetime(2024, 5, 1, 12, 30, 15, 250000)
        given = lp.PictureMetadata(key=key, exposure_time_s=1 / 60, iso=204800, f_number=2.8, captured=taken)
        pixels = np.zeros((20, 30, 3), np.uint8)
        for name in ("e.png", "e.jpg", "e.tif"):
            lp.write_picture(self.folder / name, pixels, metadata=given)
            read = lp.read_picture(self.folder / name).metadata
            self.assertEqual((read.exposure_time_s, read.iso, read.f_number, read.captured), (1 / 60, 204800, 2.8, taken))
            self.assertEqual((read.key.camera_maker, read.key.camera_model, read.key.lens, read.key.focal_mm,
                              read.key.aperture, read.key.distance_m), ("Acme", "One", "A 50 mm", 50, 2.8, 2.5))
            self.assertAlmostEqual(read.ev, np.log2(2048 / 60 / 2.8**2), places=12)
            self.assertIs(read.is_corrected, False)
        like = lp.read_picture(self.folder / "e.jpg")  # what is not given stays
        encoded = lp.encode_picture(".png", pixels, like=like, metadata=lp.PictureMetadata(iso=100))
        read = lp.read_picture(encoded).metadata
        self.assertEqual((read.iso, read.exposure_time_s, read.key.lens), (100, 1 / 60, "A 50 mm"))
        self.assertIsNone(lp.read_picture(lp.encode_picture(".png", pixels)).metadata.captured)
        for wrong in ({"exposure_time_s": 0}, {"exposure_time_s": np.nan}, {"iso": -5}, {"f_number": np.inf},
                      {"key": lp.ProfileKey(focal_mm=-3)}):
            with self.assertRaises(lp.Error) as caught:
                lp.encode_picture(".png", pixels, metadata=lp.PictureMetadata(**wrong))
            self.assertIs(caught.exception.status, lp.Status.ERROR_ARGUMENT, wrong)

    def test_refused(self):
        for source, status in ((self.folder / "missing.png", lp.Status.ERROR_READ), (b"GIF89a", lp.Status.ERROR_READ),
                               (b"", lp.Status.ERROR_READ), (self.folder, lp.Status.ERROR_READ)):
            with self.assertRaises(lp.Error) as caught:
                lp.read_picture(source)
            self.assertIs(caught.exception.status, status)
        with self.assertRaises(lp.Error):
            lp.write_picture(self.folder / "a.xyz", np.zeros((2, 2), np.uint8))
        with self.assertRaisesRegex(lp.Error, r"^\.jpg: "):
            lp.encode_picture(".jpg", np.zeros((2, 2), np.float32))
        self.assertFalse((self.folder / "a.xyz").exists())
        with self.assertRaises(TypeError):
            lp.write_picture(self.folder / "a.png", np.zeros((2, 2), np.int64))


class TestCalibration(WithScene):
    def test_as_build(self):
        built = json.loads(run("build", self.photos, "--no-store", "--json"))
        calibration = calibrated()
        self.assertTrue(calibration.usable and calibration.equalizes)
        self.assertEqual(list(calibration.exposures["name"]), [file.name for file in self.files])
        self.assertEqual(list(calibration.exposures["ev"]), [image["ev"] for image in built["images"]])
        self.assertEqual(list(calibration.exposures["ev_sigma"]), [image["ev_sigma"] for image in built["images"]])
        self.assertEqual(list(calibration.profiles[0].vignetting[0].k), built["vignetting"]["k"][0])
        self.assertEqual([finding.text for finding in calibration.findings], [f["text"] for f in built["findings"]])

    def test_options_as_build(self):
        built = json.loads(run("build", self.photos, "--no-store", "--json", "--key", "style=Vivid",
                               "--fit", "reference=3,camera-kind=phone,sampling=paper"))
        calibration = lp.calibrate(self.photos, reference=3, camera_kind=lp.CameraKind.PHONE, sampling=lp.Sampling.PAPER,
                                   key=lp.ProfileKey(style="Vivid"))
        self.assertEqual(list(calibration.exposures["ev"]), [image["ev"] for image in built["images"]])
        self.assertEqual(calibration.exposures["ev"][3], 0)
        self.assertEqual(calibration.profiles[0].key.style, "Vivid")
        calibration.save(self.folder / "RESULT.PTO")
        with self.assertRaisesRegex(lp.Error, "none.png"):
            lp.calibrate(self.photos, reference="none.png")
        for wrong in ({"huber_levels": -1}, {"key": lp.ProfileKey(aperture=-2)}):
            with self.assertRaises(lp.Error) as caught:
                lp.calibrate(self.photos, **wrong)
            self.assertIs(caught.exception.status, lp.Status.ERROR_ARGUMENT)

    def test_scene(self):
        scene = lp.Scene.open([self.files[0], self.files[1], self.files[2]])
        self.assertEqual([image.camera.width for image in scene.images], [400] * 3)
        self.assertEqual((scene.left_out, len(scene.matches), scene.is_reconstruction), ({}, 0, False))
        self.assertGreaterEqual(len(scene.links), len(scene.images) - 1)
        self.assertTrue((scene.links["image"][:, 0] < scene.links["image"][:, 1]).all() and scene.links["fits_cameras"].all())
        scene.save(self.folder / "found.pto")
        self.assertEqual(len(lp.Scene.open(self.folder / "found.pto").images), 3)

    def test_the_fit_of_the_result(self):
        calibration = lp.calibrate(self.photos)
        result = calibration.result
        np.testing.assert_array_equal(result.exposures["ev"], calibration.exposures["ev"])
        self.assertEqual(result.exposure(1).ev, calibration.exposure(1).ev)
        self.assertEqual(len(result.image_quality), len(calibration.exposures))
        self.assertEqual(list(result.profile(lp.ProfileKey(lens="A")).vignetting[0].k),
                         list(calibration.profiles[0].vignetting[0].k))
        calibration.save(self.folder / "exposures_named.json")
        self.addCleanup(lambda: self.assertRaises(ValueError, result.profile, lp.ProfileKey()))
        self.addCleanup(calibration.close)
        read = lp.Calibration.read(self.folder / "exposures_named.json")
        self.assertEqual(list(read.exposures["name"]), list(calibration.exposures["name"]))

    def test_arrays_that_no_file_holds(self):
        frames = [lp.read_picture(file).pixels for file in self.files]
        for dtype in (np.float16, np.float32):
            with self.assertRaises(TypeError):
                lp.calibrate([frame.astype(dtype) for frame in frames])
        with self.assertRaises(lp.Error):
            lp.write_picture(self.folder / "half.tif", frames[0].astype(np.float16))
        calibration = lp.calibrate(frames)
        for call in (lambda: calibration.save(self.folder / "a.pto"), lambda: calibration.correct("a", "b")):
            with self.assertRaises(ValueError):
                call()
        with self.assertRaises((AttributeError, TypeError)):
            lp.calibrate(self.photos, one_lense=True)

    def test_a_function_of_progress_may_use_the_scene(self):
        scene = lp.Scene.open(self.files)
        seen = []

        def use(_step, _done):
            if not seen:
                seen.append(len(scene.links))
                with self.assertRaises(ValueError):
                    scene.close()

        scene.calibrate(progress=use)
        self.assertGreater(seen[0], 0)
        scene.close()

    def test_two_folders_at_the_same_time(self):
        copies = [self.folder / name for name in ("one", "two")]
        for copy in copies:
            shutil.copytree(self.photos, copy)
        outputs = [self.folder / f"{copy.name}-out" for copy in copies]
        threads = [threading.Thread(target=lp.calibrate_folder, args=([copy], output), kwargs={"store": False})
                   for copy, output in zip(copies, outputs)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for copy, output in zip(copies, outputs):
            files = json.loads((output / ".lensprof-calibrate.json").read_text().split("\n")[0])["files"]
            self.assertTrue(files and all(entry["stamp"] for entry in files.values()))
            sorted(copy.iterdir())[0].unlink()
            lp.calibrate_folder([copy], output, store=False)  # nothing counts as edited

    def test_names_that_are_no_text(self):
        odd = self.folder / os.fsdecode(b"odd\xff")
        odd.mkdir()
        for file in self.files:
            shutil.copy(file, odd / os.fsdecode(b"\xfe" + os.fsencode(file.name)))
        output = self.folder / "odd-out"
        self.assertEqual(len(lp.calibrate_folder([odd], output, store=False)["pictures"]), len(self.files))
        before = {file: file.stat().st_mtime_ns for file in output.iterdir()}
        lp.calibrate_folder([odd], output, store=False)
        self.assertEqual({file: file.stat().st_mtime_ns for file in output.iterdir()}, before)

    def test_records_that_nobody_wrote(self):
        output = self.folder / "deep-out"
        output.mkdir()
        deep = "[" * 200000 + "]" * 200000
        (output / ".lensprof-calibrate.json").write_text(
            '{"schema":5,"files":{},"digest":"","notes":' + deep + "}\n")
        self.assertEqual(len(lp.calibrate_folder([self.photos], output, store=False)["pictures"]), len(self.files))
        with self.assertRaises(lp.Error):
            (self.folder / "exposures-deep.json").write_text('{"file":"lensprof exposures","reference":' + deep + "}")
            lp.Calibration.read(self.folder / "exposures-deep.json")

    def test_saved_and_corrected(self):
        calibration = calibrated()
        for name in ("exposures.json", "result.pto", "profile.json", "pcalib.txt"):
            calibration.save(self.folder / name)
        read = lp.Calibration.read(self.folder / "exposures.json")
        np.testing.assert_array_equal(read.exposures["ev"], calibration.exposures["ev"])
        lp.correct_file(self.files[1], calibration, self.folder / "one.png")
        lp.correct_file(self.files[1], read, self.folder / "two.png")
        one, two = (lp.read_picture(self.folder / name).pixels for name in ("one.png", "two.png"))
        np.testing.assert_array_equal(one, two)
        self.assertGreater(np.abs(one.astype(int) - lp.read_picture(self.files[1]).pixels).mean(), 1)
        lp.correct_file(self.files[1], calibration, self.folder / "mild.png", gain_cap=1.001, dither=True)
        lp.correct_file(self.files[1], calibration, self.folder / "darker.png", simulate=True)
        mild, darker = (lp.read_picture(self.folder / name).pixels for name in ("mild.png", "darker.png"))
        self.assertTrue(darker[:20, :20].mean() < mild[:20, :20].mean() < one[:20, :20].mean())
        count = lp.correct_files([(file, self.folder / f"all-{file.name}") for file in self.files], calibration)
        self.assertEqual(count, len(self.files))
        with self.assertRaises(lp.Error) as caught:
            lp.correct_file(self.files[1], calibration, self.files[1])
        self.assertIs(caught.exception.status, lp.Status.ERROR_ARGUMENT)

    def test_stored(self):
        database = self.folder / "profiles.db"
        self.assertEqual(lp.calibrate(self.photos, use_stored=False).store(database), 1)
        self.assertEqual(lp.correct_files([(self.files[0], self.folder / "by-profile.png")], databases=[database]), 1)

    def test_plot(self):
        try:
            import matplotlib  # noqa: F401
        except ImportError:
            self.skipTest("no matplotlib")
        figure = calibrated().plot()
        figure.savefig(self.folder / "profile.png")
        self.assertEqual(len(figure.axes), 2)

    def test_arrays(self):
        frames = (lp.read_picture(file).pixels for file in self.files[:4])
        calibration = lp.calibrate(frames, names=["a", "b", "c", "d"])
        self.assertEqual(list(calibration.exposures["name"]), ["a", "b", "c", "d"])
        self.assertTrue(calibration.equalizes)
        frame = np.zeros((8, 8), np.uint8)
        for given in ({"names": ["../a"]}, {"names": ["a", "a"]}, {"times": [1.0]}, {"times": [1.0] * 3}, {"metadata": []}):
            with self.assertRaises(ValueError):
                lp.calibrate(iter([frame, frame]), **given)
        with self.assertRaises(TypeError):
            lp.calibrate(self.photos, times=[1.0])

    def test_arrays_with_exposures(self):
        """Arrays with what the EXIF of files states have the result of the files; the order is that of the arrays."""
        photos = rendered("--exif")
        pictures = [lp.read_picture(file) for file in sorted(photos.glob("*.png"), reverse=True)]
        names = [file.stem for file in sorted(photos.glob("*.png"), reverse=True)]
        metadata = [picture.metadata for picture in pictures]
        options = {"use_stored": False}

        def by_name(calibration):
            rows = calibration.exposures[np.argsort(calibration.exposures["name"])]
            return np.column_stack([rows["ev"], rows["ev_sigma"], rows["white_balance"]])

        whole = lp.calibrate(sorted(photos.glob("*.png"), reverse=True), **options)
        arrays = lp.calibrate((picture.pixels for picture in pictures), names=names, metadata=metadata, **options)
        self.assertEqual(list(arrays.exposures["name"]), names)
        np.testing.assert_array_equal(by_name(arrays), by_name(whole))
        self.assertEqual(arrays.result.gamma_from, lp.GammaFrom.EXPOSURES)
        self.assertEqual(arrays.result.gamma_sigma, whole.result.gamma_sigma)
        self.assertEqual(arrays.profiles[0].key, whole.profiles[0].key)
        # the exposures as times, at one ISO and f-number that nothing states
        times = [2.0**m.ev for m in metadata]
        timed = lp.calibrate([picture.pixels for picture in pictures], times=times, **options)
        self.assertEqual(timed.result.gamma_from, lp.GammaFrom.EXPOSURES)
        np.testing.assert_allclose(timed.exposures["ev"], arrays.exposures["ev"], atol=0.02)
        bare = lp.calibrate([picture.pixels for picture in pictures], **options)
        self.assertNotEqual(bare.result.gamma_from, lp.GammaFrom.EXPOSURES)
        self.assertGreater(bare.result.gamma_sigma, 2 * timed.result.gamma_sigma)

    def test_folder(self):
        out = self.folder / "out"
        done = lp.calibrate_folder(self.photos, out, store=False)
        self.assertEqual(len(done["pictures"]), len(self.files))
        self.assertTrue((out / self.files[0].name).exists())
        self.assertEqual(lp.calibrate_folder(self.photos, out, store=False), done)

    def test_refused(self):
        for paths, status in ((self.folder / "missing", lp.Status.ERROR_READ), (self.files[:1], lp.Status.ERROR_NOT_USABLE),
                              ([], lp.Status.ERROR_ARGUMENT)):
            with self.assertRaises(lp.Error) as caught:
                lp.Scene.open(paths)
            self.assertIs(caught.exception.status, status)
        scene = lp.Scene.open(self.photos)
        with self.assertRaises(ValueError):
            scene.calibrate(method=77)
        scene.close()
        with self.assertRaises(ValueError):
            scene.calibrate()

    def test_progress(self):
        steps = []
        lp.calibrate(self.photos, progress=lambda step, done: steps.append((step, done)))
        self.assertIn("fitting", {step for step, _ in steps})
        self.assertTrue(all(0 <= done <= 1 for _, done in steps))
        with self.assertRaises(lp.Error) as caught:
            lp.Scene.open(self.photos, progress=lambda step, done: True)
        self.assertIs(caught.exception.status, lp.Status.ERROR_CANCELLED)
        with self.assertRaises(ZeroDivisionError):
            lp.Scene.open(self.photos, progress=lambda step, done: 1 / 0)

    def test_notices(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            lp.Scene.open([*self.files, self.files[0]])
            (self.folder / "broken.png").write_bytes(b"\x89PNG\r\n")
            lp.Scene.open([*self.files, self.folder / "broken.png"])
        self.assertIn("broken.png", "".join(str(warning.message) for warning in caught))


class TestTypedUse(WithScene):
    def test_runs(self):
        import typed_use

        self.assertEqual(typed_use.main(self.photos), 0)


class TestMissing(unittest.TestCase):
    def test_only_the_base_library(self):
        code = ("import lensprof as lp\nprint(lp.version())\ntry:\n    lp.read_picture('a.png')\n"
                "except ImportError as error:\n    print(error)")
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True,
                              env={**os.environ, "LENSPROF_PHOTO_LIBRARY": "/nowhere/liblensprof-photo.so"})
        self.assertIn("LENSPROF_PHOTO_LIBRARY=/nowhere/liblensprof-photo.so: cannot be loaded (", done.stdout, done.stderr)

    def test_photograph_library_that_is_not_installed(self):
        """Nor is it in the folder of the base library."""
        with tempfile.TemporaryDirectory() as folder:
            alone = pathlib.Path(shutil.copy(os.environ["LENSPROF_LIBRARY"], folder))
            code = ("import ctypes.util\nctypes.util.find_library = lambda name: None\nimport lensprof as lp\n"
                    "lp._library._file_names = lambda name='lensprof': ['nowhere-' + name]\n"
                    "try:\n    lp.read_picture('a.png')\nexcept ImportError as error:\n    print(error)")
            environment = {**os.environ, "LENSPROF_LIBRARY": str(alone)}
            environment.pop("LENSPROF_PHOTO_LIBRARY", None)
            done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment)
            self.assertIn("is not installed; install it (`pip install", done.stdout, done.stderr)


if __name__ == "__main__":
    unittest.main()
