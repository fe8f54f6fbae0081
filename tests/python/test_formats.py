"""Hugin projects and point files, Lensfun databases, measured exposures."""
import gc
import json
import math
import pathlib
import tempfile
import unittest

import numpy as np

import lensprof as lp
from lensprof import formats
from support import refused, simple_pairs

PROJECT = """# hugin project file
p f2 w3000 h1500 v360  n"TIFF_m"

i w400 h300 f0 v55.5 Ra0 Rb0 Rc0 Rd0 Re0 Eev11.5 Er1.25 Eb0.75 r1.5 p-2.5 y10 a0.01 b-0.02 c0.03 d4 e-5 Va1 Vb-0.3 \
Vc0.1 Vd-0.05 Vx25 Vy-50 Vm5 n"first picture.jpg"
i w400 h300 f0 v=0 Ra=0 Rb=0 Rc=0 Rd=0 Re=0 Eev12.5 Er=0 Eb1 r0 p0 y-20 a=0 b=0 c=0 d=0 e=0 Va=0 Vb=0 Vc=0 Vd=0 Vx=0 \
Vy=0 S20,380,30,290 Vm5 n"zwei\u00e9.jpg"

v Ra0 Vb0 Eev1

k i0 t0 p"9.5 19.5 29.5 19.5 29.5 39.5 9.5 39.5"
"""


def project(text):
    return formats.Pto(text.encode())


class Projects(unittest.TestCase):
    def test_images(self):
        with project(PROJECT) as pto:
            self.assertEqual(len(pto), 2)
            first, second = pto.image(0), pto.image(1)
            self.assertEqual([pto.name(0), pto.name(1)], ["first picture.jpg", "zwei\u00e9.jpg"])
        self.assertEqual(first.camera, lp.Camera(width=400, height=300, hfov_deg=55.5, yaw_deg=10, pitch_deg=-2.5,
                                                 roll_deg=1.5, radial=(0.01, -0.02, 0.03), shift_px=(4, -5)))
        self.assertEqual(first.exposure, lp.Exposure(ev=-11.5, white_balance=(1.25, 1, 0.75)))
        self.assertEqual(first.vignetting, lp.Vignetting(k=(-0.3, 0.1, -0.05), center=(0.1, -0.2)))
        self.assertEqual(first.free, lp.Free.RESPONSE | lp.Free.K1)
        self.assertEqual(second.free, lp.Free.RESPONSE | lp.Free.K1 | lp.Free.EV)
        self.assertEqual((second.response_of, second.red_of, second.ev_of, second.blue_of), (0, 0, 1, 1))
        self.assertEqual(second.crop.tolist(), [20, 30, 380, 290])
        self.assertIs(second.crop_circular, False)

    def test_bytes_and_text(self):
        self.assertEqual(bytes(project(PROJECT)), PROJECT.encode())
        latin = PROJECT.encode("latin-1")
        pto = formats.Pto(latin)
        self.assertEqual(bytes(pto), latin)
        self.assertEqual(pto.name(1).encode("utf-8", "surrogateescape"), "zwei\u00e9.jpg".encode("latin-1"))

    def test_response(self):
        self.assertEqual(project(PROJECT.replace("Vm5 n", "Vm5 Rt1 n")).response(0).kind, lp.ResponseKind.LINEAR)
        response = project(PROJECT).response(1)
        np.testing.assert_allclose(response.table, lp.emor_table(0), atol=1e-6)

    def test_set_name(self):
        pto = project(PROJECT)
        pto.set_name(1, "../other \u00e9.jpg")
        self.assertEqual(pto.name(1), "../other \u00e9.jpg")
        self.assertEqual(bytes(pto).decode(), PROJECT.replace("zwei\u00e9.jpg", "../other \u00e9.jpg"))
        for name in ("", 'a"b'):
            with refused(self, lp.Status.ERROR_ARGUMENT):
                pto.set_name(0, name)
        with self.assertRaises(ValueError):
            pto.set_name(0, "a\0b")
        self.assertEqual(pto.name(0), "first picture.jpg")

    def test_draw_mask(self):
        pto = project(PROJECT)
        y, x = np.mgrid[0:300, 0:400]
        mask = np.full((300, 400), 7, dtype=np.uint8)
        self.assertIs(pto.draw_mask(1, mask), mask)
        np.testing.assert_array_equal(mask, (x >= 20) & (x < 380) & (y >= 30) & (y < 290))
        parent = np.zeros((320, 420), dtype=bool)
        pto.draw_mask(0, parent[309:9:-1, 5:405])
        inside = (x >= 10) & (x < 30) & (y >= 20) & (y < 40)
        np.testing.assert_array_equal(parent[309:9:-1, 5:405], ~inside)
        self.assertEqual(parent.sum(), (~inside).sum())
        small = pto.draw_mask(1, np.zeros((30, 40), dtype=np.uint8))
        self.assertEqual((small.sum(), small[3:29, 2:38].sum()), (26 * 36, 26 * 36))

    def test_draw_mask_refused(self):
        pto, mask = project(PROJECT), np.full((30, 40), 7, dtype=np.uint8)
        with refused(self, lp.Status.ERROR_ARGUMENT):
            pto.draw_mask(2, mask)
        with refused(self, lp.Status.ERROR_SIZE):
            pto.draw_mask(0, mask[:0])
        self.assertTrue((mask == 7).all())
        for wrong, error in ((mask[:, ::2], ValueError), (mask.astype(float), TypeError), (mask[0], ValueError)):
            with self.assertRaises(error):
                pto.draw_mask(0, wrong)
        mask.flags.writeable = False
        with self.assertRaisesRegex(ValueError, "read-only"):
            pto.draw_mask(0, mask)

    def test_set_result(self):
        pto = project(PROJECT)
        response, vignetting = lp.Response.from_emor([0.5, -0.125]), lp.Vignetting(k=(-0.25, 0, 0), center=(0.1, 0))
        pto.set_result(response, vignetting, [lp.Exposure(), lp.Exposure(ev=1.5, white_balance=(1, 1, 2))])
        again = formats.Pto(bytes(pto))
        for index in (0, 1):
            self.assertEqual(again.image(index).emor.tolist(), [0.5, -0.125, 0, 0, 0])
            np.testing.assert_allclose(again.image(index).vignetting.k, vignetting.k)
            np.testing.assert_allclose(again.image(index).vignetting.center, vignetting.center)
        self.assertEqual([again.image(index).exposure.ev for index in (0, 1)], [-11.5, -10])
        self.assertEqual(again.image(1).exposure.white_balance[2], 1.5)
        array = np.zeros(2, dtype=lp.EXPOSURE_DTYPE)
        array["white_balance"], array["ev"] = 1, (2, 0)
        again.set_result(response, vignetting, array, reference=1)
        self.assertEqual([again.image(index).exposure.ev for index in (0, 1)], [-8, -10])

    def test_set_settings(self):
        pto = project("i w800 h600 f0 v50 Va1 Vb0 Vc0 Vd0 Vx0 Vy0 Vm5 n\"a\"\ni w800 h600 f0 v=0 Va=0 Vb=0 Vc=0 Vd=0 Vx=0 Vy=0 "
                     "Vm5 n\"b\"\ni w800 h600 f0 v=0 Va=0 Vb=0 Vc=0 Vd=0 Vx=0 Vy=0 Vm5 n\"c\"\n")
        curves = [lp.Vignetting(k=(-0.1, 0, 0)), lp.Vignetting(k=(-0.4, 0.1, 0), center=(0.1, 0))]
        pto.set_settings([0, 1, 1], curves)
        text = bytes(pto).decode()
        self.assertIn("Va=1 Vb=1 Vc=1 Vd=1 Vx=1 Vy=1", text)
        self.assertIn("Vb-0.4 ", text)
        again = project(text)
        self.assertEqual([again.image(i).vignetting.k[0] for i in range(3)], [-0.1, -0.4, -0.4])
        self.assertEqual([again.image(i).vignetting_of for i in range(3)], [0, 1, 1])
        for arguments in ([0, 1], curves), ([0, 2, 1], curves), ([0, 0, 0], [lp.Vignetting(k=(-2, 0, 0))]):
            with self.assertRaises(lp.Error):
                pto.set_settings(*arguments)
        self.assertEqual(bytes(pto).decode(), text)

    def test_set_cameras(self):
        pto = project("".join(f"i w800 h600 f0 v50 Ra0 Rb0 Rc0 Rd0 Re0 Va1 Vb0 Vc0 Vd0 Vx0 Vy0 Vm5 n\"{n}\"\n" for n in "abc"))
        curves = [lp.Response.from_emor([0.5, 0.1]), lp.Response.from_emor([-0.3])]
        pto.set_cameras([1, 0, 1], curves)
        text = bytes(pto).decode()
        self.assertIn("Ra=0 Rb=0 Rc=0 Rd=0 Re=0", text)
        again = project(text)
        self.assertEqual([again.image(i).emor[0] for i in range(3)], [-0.3, 0.5, -0.3])
        self.assertEqual([again.image(i).response_of for i in range(3)], [0, 1, 0])
        for arguments in ([0, 1], curves), ([0, 2, 1], curves):
            with self.assertRaises(lp.Error):
                pto.set_cameras(*arguments)
        self.assertEqual(bytes(pto).decode(), text)

    def test_set_result_refused(self):
        pto, good = project(PROJECT), [lp.Exposure()] * 2
        curves = lp.Response(), lp.Vignetting()
        for arguments, status in (((*curves, good[:1]), lp.Status.ERROR_ARGUMENT),
                                  ((*curves, good, 2), lp.Status.ERROR_ARGUMENT),
                                  ((curves[0], lp.Vignetting(k=(-5, 0, 0)), good), lp.Status.ERROR_VIGNETTING),
                                  ((*curves, [lp.Exposure(ev=80)] * 2), lp.Status.ERROR_EXPOSURE)):
            with refused(self, status):
                pto.set_result(*arguments)
        self.assertEqual(bytes(pto), PROJECT.encode())

    def test_refused(self):
        for text, status, words in (("i w10 h10\ni w0 h10\n", lp.Status.ERROR_SYNTAX, "line 2"),
                                    ("i w10 h10\nv Q0\n", lp.Status.ERROR_VARIABLE, "line 2"),
                                    ("i w10 h10 f7\n", lp.Status.ERROR_UNSUPPORTED, "line 1")):
            with refused(self, status) as caught:
                project(text)
            self.assertIn(words, caught.exception.text)
        pto = project(PROJECT)
        for call in (pto.image, pto.response, pto.name):
            with refused(self, lp.Status.ERROR_ARGUMENT):
                call(2)
            with self.assertRaises(ValueError):
                call(-1)

    def test_closed(self):
        pto = project(PROJECT)
        image = pto.image(0)
        pto.close()
        pto.close()
        for call in (lambda: len(pto), lambda: pto.image(0), lambda: bytes(pto)):
            with self.assertRaisesRegex(ValueError, "this Pto is closed"):
                call()
        gc.collect()
        self.assertEqual(image.camera.width, 400)


class Points(unittest.TestCase):
    def test_round_trip(self):
        pairs = simple_pairs()
        text = formats.encode_points(pairs, [lp.Camera(width=240, height=180)] * 2)
        again = formats.read_points(text)
        self.assertEqual(again.tobytes(), pairs.tobytes())
        columns = np.array([line.split() for line in text.decode().splitlines()], dtype=float)
        self.assertEqual(columns.shape, (len(pairs), 16))
        np.testing.assert_array_equal(columns[:, 2:6], pairs["xy"].reshape(-1, 4))
        x, y = pairs["xy"][:, 1].T
        np.testing.assert_allclose(columns[:, 14], np.hypot(x - 119.5, y - 89.5) / 150, rtol=1e-14)

    def test_empty(self):
        self.assertEqual(len(formats.read_points(b"")), 0)
        self.assertEqual(formats.encode_points(np.zeros(0, lp.PAIR_DTYPE), []), b"")

    def test_refused(self):
        pairs, cameras = simple_pairs(), [lp.Camera(width=240, height=180)] * 2
        with refused(self, lp.Status.ERROR_ARGUMENT):
            formats.encode_points(pairs, cameras[:1])
        with refused(self, lp.Status.ERROR_SIZE):
            formats.encode_points(pairs, [lp.Camera()] * 2)
        pairs["xy"][3, 0, 0] = math.inf
        with refused(self, lp.Status.ERROR_NOT_FINITE):
            formats.encode_points(pairs, cameras)
        with self.assertRaises(ValueError):
            formats.encode_points(pairs[::-1], cameras)
        with self.assertRaises(TypeError):
            formats.encode_points(pairs["xy"], cameras)
        with refused(self, lp.Status.ERROR_SYNTAX) as caught:
            formats.read_points(b"0 1 1 1 2 2 .1 .1 .1 .2 .2 .2 0 0 0 0\n0 1\n")
        self.assertIn("line 2", caught.exception.text)


class MeasuredExposures(unittest.TestCase):
    """exposures.json."""

    def content(self):
        images = [formats.ExposuresImage("a.jpg", (640, 480), 0, lp.Exposure(ev=1 / 3, white_balance=(4, 1, 1)),
                                         file="../\u00e9/a.jpg", ev_sigma=0.01, white_balance_sigma=(0.1, 0, None)),
                  formats.ExposuresImage("b.jpg", (640, 480), 1, lp.Exposure()),
                  formats.ExposuresImage("c.jpg", (480, 640), 1, None)]
        lenses = [formats.ExposuresLens(0, (lp.Vignetting(k=(-0.3, 0, 0)),), "50 mm"),
                  formats.ExposuresLens(1, tuple(lp.Vignetting(k=(0.1 * c - 0.3, 0, 0)) for c in range(3)))]
        cameras = [formats.ExposuresCamera(lp.Response.from_gamma(2.2), "Acme"), formats.ExposuresCamera(lp.Response())]
        return formats.Exposures(cameras, lenses, images, reference=1, software="me")

    def test_round_trip(self):
        given = self.content()
        self.assertEqual(formats.read_exposures(formats.encode_exposures(given)), given)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "exposures.json")
            formats.write_exposures(path, given)
            self.assertEqual(formats.read_exposures(path), given)
            file = json.loads(path.read_text("utf-8"))
        self.assertEqual((file["reference"], file["software"]), ("b.jpg", "me"))
        self.assertEqual(len(file["cameras"][0]["light_of_level"]), 256)
        self.assertEqual([image["ev"] for image in file["images"]], [1 / 3, 0.0, None])
        self.assertEqual(file["images"][0]["white_balance_sigma"], [0.1, 0.0, None])
        self.assertAlmostEqual(file["mean"]["ev"], 1 / 6)
        self.assertIn(f'"lensprof {lp.version()}"', formats.encode_exposures(given._replace(software=None)).decode())

    def test_refused(self):
        given = self.content()
        with refused(self, lp.Status.ERROR_SYNTAX) as caught:
            formats.read_exposures(formats.encode_exposures(given).replace(b'"width": 640', b'"width": 0', 1))
        self.assertIn("images[0].width is 0", caught.exception.text)
        with refused(self, lp.Status.ERROR_ARGUMENT) as caught:
            formats.encode_exposures(given._replace(images=[given.images[1], given.images[0]._replace(lens=2)]))
        self.assertIn("image 1: lens is not the index", caught.exception.text)
        four = given.lenses[0]._replace(vignetting=(lp.Vignetting(),) * 4)
        with refused(self, lp.Status.ERROR_ARGUMENT) as caught:
            formats.encode_exposures(given._replace(lenses=[four, four]))
        self.assertIn("lens 0: vignettings is neither 1 nor 3", caught.exception.text)
        with self.assertRaisesRegex(ValueError, "zero bytes"):
            formats.encode_exposures(given._replace(software="a\0b"))


def exported(profiles, format, **more):
    return formats.encode_profiles(profiles, format=format, **more).decode()


def imported(text, format, name=""):
    return formats.read_profiles(text.encode(), name, format=format)


LENSFUN = """<lensdatabase version="1"><lens><maker>Acme</maker><model>50mm \u00e9</model><mount>Generic</mount>
<cropfactor>1.5</cropfactor><calibration>
<vignetting model="pa" focal="50" aperture="2" distance="1000" k1="-0.5" k2="0.25" k3="-0.1"/>
<vignetting model="pa" focal="50" aperture="4" distance="0.5" k1="-2" k2="0" k3="0"/>
</calibration></lens></lensdatabase>"""


class AnyFormat(unittest.TestCase):
    """One call for all formats."""

    def profile(self):
        key = lp.ProfileKey(lens="Acme 50mm", crop_factor=1.5, focal_mm=50, aperture=2.8)
        return lp.Profile(key=key, vignetting=lp.Vignetting(k=(-0.3, 0.05, 0)), response=lp.Response.from_gamma(2.2))

    def test_there_and_back(self):
        for name, format in (("a.xml", formats.Format.LENSFUN), ("a.json", formats.Format.JSON), ("a.blob", formats.Format.BLOB),
                             ("a.vgn", formats.Format.RADICAL_VIGNETTING)):
            data = formats.encode_profiles([self.profile()], name, frame=(600, 400))
            self.assertEqual(formats.detect(data), format)
            found, usable = formats.read_profiles(data, name)[0]  # Lensfun's entries of infinity are two
            self.assertTrue(usable)
            self.assertAlmostEqual(found.vignetting[0].k[0], -0.3, places=6)
        self.assertEqual(formats.encode_profiles([self.profile()] * 2, format=formats.Format.JSON).count(b"Acme"), 2)

    def test_key_and_frame(self):
        data = formats.encode_profiles([self.profile()], format=formats.Format.ALSC, frame=(640, 480))
        key = lp.ProfileKey(camera_model="Pi", processing=lp.Processing.RAW)
        (found, _), = formats.read_profiles(data, "tuning.json", key=key, frame=(640, 480))
        self.assertEqual(found.key.camera_model, "Pi")
        self.assertEqual(found.provenance.source, "tuning.json")
        with self.assertRaisesRegex(lp.Error, "width and height"):
            formats.read_profiles(data)

    def test_refused(self):
        self.assertEqual(formats.detect(b"hello"), formats.Format.AUTO)
        self.assertEqual(formats.info(formats.Format.DRONE_XMP)[2:], (formats.Holds.FALLOFF, False, False, True))
        with self.assertRaises(ValueError):
            formats.info(formats.Format.AUTO)
        for data, name, words in ((b"hello", "", "specify the format"), (b"", "a.csv", "is empty"),
                                  (b"hello", "a.blob", "not a profile blob"), (b"\x89PNG", "a.png", "a picture")):
            with self.assertRaisesRegex(lp.Error, words):
                formats.read_profiles(data, name)
        with self.assertRaisesRegex(lp.Error, "read only"):
            formats.encode_profiles([self.profile()], "a.xmp")
        with self.assertRaisesRegex(lp.Error, "holds one profile"):
            formats.encode_profiles([self.profile()] * 2, "a.csv")

    def test_a_format_is_no_word(self):
        for word, member in (("json", "JSON"), ("opcodes", "DNG_OPCODES"), ("crf", "RADICAL_RESPONSE")):
            with self.assertRaisesRegex(ValueError, f"'{word}' is a format.*format=Format.{member}$"):
                formats.encode_profiles([self.profile()], word)
        for word, member in (("json", "JSON"), ("lensfun", "LENSFUN"), ("xyz", "JSON")):
            for call in (lambda: formats.encode_profiles([self.profile()], format=word),
                         lambda: formats.read_profiles(b"{}", format=word), lambda: formats.info(word)):
                with self.assertRaisesRegex(TypeError, f"Format.{member}, and not '{word}'"):
                    call()
        self.assertIn(b"Acme", formats.encode_profiles([self.profile()], "json", format=formats.Format.JSON))  # a file's name

    def test_files(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "a.json")
            formats.write_profiles(path, [self.profile()])
            data = path.read_bytes()
            self.assertEqual(data, formats.encode_profiles([self.profile()], "a.json"))
            for source in (path, str(path), data, bytearray(data), memoryview(data)):
                (found, usable), = formats.read_profiles(source)
                self.assertEqual((usable, found.key.lens), (True, "Acme 50mm"))
                self.assertEqual(formats.detect(source), formats.Format.JSON)
            self.assertEqual(formats.read_profiles(path)[0].profile.provenance.source, "a.json")
            self.assertEqual(formats.read_profiles(data, "b.json")[0].profile.provenance.source, "b.json")
            with self.assertRaisesRegex(TypeError, "colour"):
                formats.write_profiles(path, [self.profile()], colour=1)
            formats.write_points(path, simple_pairs(), [lp.Camera(width=240, height=180)] * 2)
            self.assertEqual(formats.read_points(path).tobytes(), simple_pairs().tobytes())
            project(PROJECT).write(path)
            self.assertEqual(path.read_bytes(), PROJECT.encode())
            self.assertEqual(repr(formats.Pto(path)), "Pto(2 images)")
            readers = (formats.read_profiles, formats.detect, formats.read_points, formats.Pto, formats.read_lensfun_cameras)
            for reader in readers:
                with self.assertRaises(FileNotFoundError):
                    reader(path.with_name("none.json"))
                with self.assertRaisesRegex(TypeError, "the path of a file or its bytes, not int"):
                    reader(5)


class Lensfun(unittest.TestCase):
    def test_read(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "my.xml")
            path.write_bytes(LENSFUN.encode())
            found = [imported(LENSFUN, formats.Format.LENSFUN, "my.xml"), formats.read_profiles(path),
                     formats.read_profiles(str(path))]
        for (good, usable), (bad, damaged) in found:
            self.assertIs(usable, True)
            self.assertIs(damaged, False)
            self.assertEqual(good.key, lp.ProfileKey(lens="Acme 50mm \u00e9", crop_factor=1.5, focal_mm=50, aperture=2,
                                                     distance_m=math.inf, processing=lp.Processing.RAW))
            self.assertEqual(good.vignetting[0].k.tolist(), [-0.5, 0.25, -0.1])
            self.assertEqual(good.provenance.source, "my.xml; Lensfun database, CC BY-SA 3.0")
            good.validate()
            self.assertEqual(bad.provenance.doubt, "M is negative at r = 0.71")
            self.assertEqual(bad.key.distance_m, 0.5)
            with refused(self, lp.Status.ERROR_VIGNETTING):
                bad.validate()

    def test_round_trip(self):
        profile = lp.Profile()
        profile.key = lp.ProfileKey(lens="A <lens>", crop_factor=1, focal_mm=35.1, aperture=1.4, distance_m=0.3,
                                    processing=lp.Processing.RAW)
        profile.vignetting = lp.Vignetting(k=(-0.25, 0, 0))
        text = exported(iter([profile]), formats.Format.LENSFUN)
        self.assertIn("<model>A &lt;lens&gt;</model>", text)
        (again, usable), = imported(text, formats.Format.LENSFUN)
        self.assertTrue(usable)
        self.assertEqual(again.key, profile.key)
        self.assertEqual(again.vignetting, profile.vignetting)
        self.assertEqual(imported(exported([], formats.Format.LENSFUN), formats.Format.LENSFUN), [])
        camera = lp.CameraModel(maker="SONY", model="A body", mount="Sony E", crop_factor=1)
        added = exported([profile], formats.Format.LENSFUN, camera=camera, into=text.encode())
        self.assertEqual(len(imported(added, formats.Format.LENSFUN)), 2)
        self.assertIn("<mount>Sony E</mount>", added)

    def test_cost(self):
        """What a file for Lensfun loses: of a centre, the error of the corner that is farthest from it."""
        key = lp.ProfileKey(lens="A", crop_factor=1, focal_mm=35, aperture=1.4, processing=lp.Processing.RAW)
        exact, shifted = lp.Profile(), lp.Profile()
        for profile in exact, shifted:
            profile.key, profile.vignetting = key, lp.Vignetting(k=(-0.4, 0, 0))
        shifted.key.aperture = 2.0
        shifted.vignetting = lp.Vignetting(k=(-0.4, 0, 0), center=(0.1, 0))
        cost = np.full(2, np.nan)
        text = exported(iter([exact, shifted]), formats.Format.LENSFUN, cost_ev=cost)
        self.assertLess(cost[0], 0.001)
        width, height = 3000, 2000
        written = {found.key.aperture: found.vignetting for found, _ in imported(text, formats.Format.LENSFUN)}
        x, y = np.array([(width - 1) / 2, 0, width - 1, 0, width - 1]), np.array([(height - 1) / 2, 0, 0, height - 1, height - 1])
        falloffs = [v.eval(v.r2(width, height, x, y)) for v in (shifted.vignetting[0], written[2.0][0])]
        relative = [falloff[1:] / falloff[0] for falloff in falloffs]
        self.assertAlmostEqual(cost[1], np.max(np.abs(np.log2(relative[0] / relative[1]))), delta=0.002)
        self.assertGreater(cost[1], 0.05)
        for wrong, kind in ((np.zeros(1), ValueError), (np.zeros(2, np.float32), TypeError), ([0.0, 0.0], TypeError),
                            (np.zeros(4)[::2], ValueError)):
            with self.assertRaises(kind):
                exported([exact, shifted], formats.Format.LENSFUN, cost_ev=wrong)
        cost.flags.writeable = False
        with self.assertRaisesRegex(ValueError, "read-only"):
            exported([exact, shifted], formats.Format.LENSFUN, cost_ev=cost)

    def test_refused(self):
        with refused(self, lp.Status.ERROR_SYNTAX) as caught:
            imported(LENSFUN.replace("k1=\"-2\"", "k1=\"x\""), formats.Format.LENSFUN)
        self.assertIn("line 4: lens \"Acme 50mm", caught.exception.text)
        with refused(self, lp.Status.ERROR_ARGUMENT) as caught:
            exported([lp.Profile()], formats.Format.LENSFUN)
        self.assertIn("profile 0: its lens is unknown", caught.exception.text)
        with self.assertRaises(TypeError):
            exported([lp.Vignetting()], formats.Format.LENSFUN)
        with self.assertRaises(ValueError):
            imported(LENSFUN, formats.Format.LENSFUN, "a\0b")


class Json(unittest.TestCase):
    def test_round_trip(self):
        profile = lp.Profile()
        profile.key = lp.ProfileKey(lens="L \u00e9", focal_mm=1 / 3, distance_m=math.inf, unit="7")
        profile.vignetting = lp.Vignetting(k=(-0.1 - 0.2, 0, 0), center=(1 / 7, 0))
        profile.response = lp.Response.from_emor([0.1, -1 / 3])
        text = exported([profile], formats.Format.JSON)
        self.assertEqual(bytes(imported(text, formats.Format.JSON)[0][0]), bytes(profile))
        both = imported(exported([profile, lp.Profile()], formats.Format.JSON), formats.Format.JSON)
        self.assertEqual([p.key.lens for p, _ in both], ["L \u00e9", ""])
        self.assertEqual(imported(exported([], formats.Format.JSON), formats.Format.JSON), [])

    def test_refused(self):
        text = exported([lp.Profile()], formats.Format.JSON)
        with refused(self, lp.Status.ERROR_SYNTAX) as caught:
            imported(text.replace('"center"', '"centre"').replace('"k"', '"K"'), formats.Format.JSON)
        self.assertIn('vignetting has no "k"', caught.exception.text)
        with self.assertRaises(TypeError):
            exported([lp.Vignetting()], formats.Format.JSON)


class Tables(unittest.TestCase):
    def test_pcalib(self):
        text = exported([lp.Profile(response=lp.Response.from_gamma(2.2))], formats.Format.PCALIB)
        values = np.array(text.split(), dtype=np.float32)
        self.assertEqual(len(values), 256)
        self.assertTrue((np.diff(values) > 0).all())
        grey = np.arange(256) / 255
        np.testing.assert_allclose(imported(text, formats.Format.PCALIB)[0][0].response[0].invert(grey), grey**2.2, atol=3e-4)
        with refused(self, lp.Status.ERROR_RESPONSE) as caught:
            formats.read_profiles(b"0 1 1 2", format=formats.Format.PCALIB, strict=True)
        self.assertIn("value 2 (1)", caught.exception.text)

    def test_curves(self):
        given = [lp.Response.from_gamma(g) for g in (1.8, 2.0, 2.2)]
        for kind in formats.CurveKind:
            text = formats.encode_profiles([lp.Profile(response=given)], "a.csv", curve=kind, tables=(0, 4096))
            (again, _), = formats.read_profiles(text, "a.csv", curve=kind)
            for a, b in zip(given, again.response):
                np.testing.assert_allclose(a.table, b.table, atol=3e-4)
        (one, _), = imported(exported([lp.Profile(response=given[0])], formats.Format.CURVES), formats.Format.CURVES)
        self.assertEqual(len(one.response), 1)
        with refused(self, lp.Status.ERROR_RESPONSE) as caught:
            formats.read_profiles(b"0\n3\n2\n", "a.csv", strict=True)
        self.assertIn("line 3", caught.exception.text)


class Maps(unittest.TestCase):
    def test_round_trip(self):
        profile = lp.Profile()
        profile.key = lp.ProfileKey(lens="L")
        profile.vignetting = [lp.Vignetting(k=(k, 0.1, 0), center=(0.05, 0)) for k in (-0.5, -0.4, -0.3)]
        for sense in formats.MapSense:
            values = formats.write_map(profile, (640, 480), (64, 48), 3, sense)
            self.assertEqual(values.shape, (48, 64, 3))
            found, usable = formats.read_map(values, sense, (640, 480), profile.key)
            self.assertTrue(usable)
            self.assertEqual(found.key.lens, "L")
            np.testing.assert_allclose([v.k for v in found.vignetting], [v.k for v in profile.vignetting], atol=1e-4)
        grey = formats.write_map(profile, (64, 48))
        self.assertEqual((grey.shape, grey.dtype, grey.max()), ((48, 64), np.float32, 1))
        self.assertEqual(len(formats.read_map(grey)[0].vignetting), 1)
        with refused(self, lp.Status.ERROR_NOT_FINITE):
            formats.read_map(np.full((9, 9), math.nan))
        with self.assertRaises(ValueError):
            formats.read_map(np.ones(9))

    def test_alsc(self):
        profile = lp.Profile()
        profile.vignetting = [lp.Vignetting(k=(k, 0.1, 0), center=(0.05, 0)) for k in (-0.5, -0.4, -0.3)]
        frame, format = (3280, 2464), formats.Format.ALSC
        text = formats.encode_profiles([profile], format=format, frame=frame, color_temperature_k=5000).decode()
        tuning = '{"algorithms":[{"rpi.dpc":{}},' + text + "]}"
        (found, _), = formats.read_profiles(tuning.encode(), format=format, frame=frame)
        frames = [formats.write_map(p, frame, (16, 12), 3) for p in (profile, found)]
        np.testing.assert_allclose(frames[0], frames[1], rtol=3e-3)
        with refused(self, lp.Status.ERROR_SYNTAX) as caught:
            formats.read_profiles(text.encode(), format=format, frame=frame, tables=(10, 10))
        self.assertIn("luminance_lut has 192 values", caught.exception.text)

    def test_radical(self):
        profile = lp.Profile()
        profile.vignetting = [lp.Vignetting(k=(k, 0.1, 0), center=(0.05, 0)) for k in (-0.5, -0.4, -0.3)]
        (found, _), = formats.read_profiles(formats.encode_profiles([profile], "a.vgn", frame=(640, 480)), "a.vgn")
        np.testing.assert_allclose([v.k for v in found.vignetting], [v.k for v in profile.vignetting], rtol=1e-12)
        given = [lp.Response.from_gamma(g) for g in (1.8, 2.0, 2.2)]
        (found, _), = formats.read_profiles(formats.encode_profiles([lp.Profile(response=given)], "a.crf"), "a.crf")
        for a, b in zip(given, found.response):
            np.testing.assert_allclose(a.table, b.table, atol=1e-3)


class DngOpcodes(unittest.TestCase):
    def test_round_trip(self):
        profile = lp.Profile()
        profile.vignetting = lp.Vignetting(k=(-0.4, 0.1, -0.05), center=(0.05, 0))
        for form in (formats.DngForm.RADIAL, formats.DngForm.GAIN_MAP):
            of_tag = {"format": formats.Format.DNG_OPCODES, "frame": (600, 400), "layout": lp.Layout.RGGB}
            data = formats.encode_profiles([profile], form=form, **of_tag)
            self.assertEqual(data[:8], bytes([0, 0, 0, 1, 0, 0, 0, 9 if form == formats.DngForm.GAIN_MAP else 3]))
            (again, usable), = formats.read_profiles(data, "a.dng", **of_tag)
            self.assertTrue(usable)
            np.testing.assert_allclose(again.vignetting[0].k, profile.vignetting[0].k, atol=0.03)

    def test_refused(self):
        with refused(self, lp.Status.ERROR_SYNTAX) as caught:
            formats.read_profiles(b"\0\0\0\1", format=formats.Format.DNG_OPCODES, frame=(600, 400))
        self.assertIn("fewer bytes", caught.exception.text)
        with refused(self, lp.Status.ERROR_ARGUMENT):
            formats.encode_profiles([lp.Profile()], format=formats.Format.DNG_OPCODES, frame=(600, 400), layout=lp.Layout.RGBA)


class Lcp(unittest.TestCase):
    def test_round_trip(self):
        profile = lp.Profile()
        profile.key = lp.ProfileKey(camera_maker="Acme", camera_model="One", lens="A <lens>", crop_factor=1.5, focal_mm=35,
                                    aperture=1.4, distance_m=math.inf, processing=lp.Processing.RAW)
        profile.vignetting = lp.Vignetting(k=(-0.3, 0.1, 0), center=(0.05, 0))
        for size in ((0, 0), (6000, 4000)):
            text = exported([profile], formats.Format.LCP, frame=size)
            self.assertIn("<stCamera:Lens>A &lt;lens&gt;</stCamera:Lens>", text)
            (again, usable), = imported(text, formats.Format.LCP, "my.lcp")
            self.assertTrue(usable)
            self.assertEqual(again.key, profile.key)
            np.testing.assert_allclose(again.vignetting[0].k, profile.vignetting[0].k, rtol=1e-12)
            self.assertEqual(again.provenance.source, "my.lcp; Adobe lens profile")

    def test_refused(self):
        with refused(self, lp.Status.ERROR_SYNTAX):
            imported("<rdf:RDF/>", formats.Format.LCP)
        with refused(self, lp.Status.ERROR_ARGUMENT) as caught:
            exported([lp.Profile()], formats.Format.LCP)
        self.assertIn("profile 0: its lens is unknown", caught.exception.text)


class DroneXmp(unittest.TestCase):
    PACKET = """<rdf:RDF><rdf:Description tiff:Make="MicaSense"><Camera:VignettingPolynomial><rdf:Seq>%s</rdf:Seq>
</Camera:VignettingPolynomial></rdf:Description></rdf:RDF>"""

    def read(self, packet, name=""):
        return formats.read_profiles(packet.encode(), name, format=formats.Format.DRONE_XMP, frame=(800, 600))

    def test_read(self):
        text = self.PACKET % "<rdf:li>0</rdf:li><rdf:li>-2e-6</rdf:li>"  # 1 - 2e-6 r^2, 1 - 0.5 in the corner
        (profile, usable), = self.read(text, "a.tif")
        self.assertTrue(usable)
        np.testing.assert_allclose(profile.vignetting[0].k, (-0.5, 0, 0), atol=1e-9)
        self.assertEqual(profile.key.camera_maker, "MicaSense")

    def test_refused(self):
        with refused(self, lp.Status.ERROR_NOT_FOUND):
            self.read("<rdf:RDF/>")


if __name__ == "__main__":
    unittest.main()
