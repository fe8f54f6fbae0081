"""Profiles as values."""
import gc
import math
import pickle
import struct
import unittest
import zlib

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

    def test_camera_kind(self):
        self.assertIs(lp.ProfileKey().camera_kind, lp.CameraKind.ANY)
        self.assertIs(lp.ProfileKey(camera_maker="Google", camera_model="Pixel 6").camera_kind, lp.CameraKind.PHONE)
        self.assertIs(lp.ProfileKey(camera_model="EOS 6D").camera_kind, lp.CameraKind.STILL)
        self.assertIs(lp.ProfileKey(processing=lp.Processing.RAW).camera_kind, lp.CameraKind.LINEAR)

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

    def test_falloff(self):
        self.assertEqual(lp.half_diagonal(400, 300), 250)
        profile = lp.Profile(vignetting=lp.Vignetting(k=(-0.3, 0.1, 0), center=(0.1, 0)),
                             covariance=np.diag([1e-4, 4e-4, 0, 1e-6, 1e-6]))
        value, sigma = profile.corner_falloff()
        self.assertAlmostEqual(value, 0.8, delta=1e-15)
        self.assertAlmostEqual(sigma, np.sqrt(5e-4), delta=1e-15)
        self.assertAlmostEqual(profile.radial_falloff(0.5)[0], 1 - 0.3 / 4 + 0.1 / 16, delta=1e-15)
        profile.grid = lp.GainGrid(np.full((2, 2), 0.5, np.float32))
        value, sigma = profile.falloff(400, 300, 199.5 + 25 + 125, 149.5, channel=2)
        self.assertAlmostEqual(value, 0.5 * (1 - 0.3 / 4 + 0.1 / 16), delta=1e-12)
        by_center = 2 * 0.5 * (-0.3 + 2 * 0.1 / 4)
        self.assertAlmostEqual(sigma, 0.5 * np.sqrt(1e-4 / 16 + 4e-4 / 256 + by_center ** 2 * 1e-6), delta=1e-12)
        self.assertIsNone(lp.Profile().corner_falloff()[1])
        for wrong in (3, -1):
            with self.assertRaises(ValueError):
                profile.corner_falloff(wrong)

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
        profile.response = profile.response[::-1]  # aliases its own memory
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


def blob_of(profile, covariance=False):
    """The blob according to docs/blob.md, written independently of the library."""
    key, provenance, grid = profile.key, profile.provenance, profile.grid
    texts = [text.encode() for text in (key.camera_maker, key.camera_model, key.lens, provenance.method,
                                        provenance.software)]
    n = profile.covariance_size if covariance else 0
    shape = grid.attenuation.shape if grid.attenuation.size else (0, 0, 0)
    fixed = struct.pack("<BBBBBBBx5B3x", key.processing, profile.responses, profile.vignettings, shape[0], shape[2],
                        shape[1], n, *map(len, texts))
    fixed += struct.pack("<5dqIIdd", key.focal_mm, key.aperture, key.distance_m, *profile.vignetting[0].center,
                         provenance.created_unix_s, provenance.images, provenance.pairs, provenance.heldout_rms,
                         provenance.inlier_share)
    rest = b"".join(struct.pack("<3d", *falloff.k) for falloff in profile.vignetting)
    for curve in profile.response:
        rest += struct.pack("<BBxx", curve.kind, curve.modes)
        if curve.kind == lp.ResponseKind.GAMMA:
            rest += struct.pack("<d", curve.gamma)
        if curve.kind >= lp.ResponseKind.EMOR:
            rest += np.asarray(curve.emor[:curve.modes], "<f8").tobytes() + np.asarray(curve.table, "<f4").tobytes()
    rest += np.asarray(grid.attenuation, "<f4").tobytes()
    rest += b"".join(profile.covariance[i, i:].astype("<f8").tobytes() for i in range(n)) + b"".join(texts)
    blob = b"LPRF" + struct.pack("<HHI", 1, 0, 12 + len(fixed) + len(rest) + 4) + fixed + rest
    return blob + struct.pack("<I", zlib.crc32(blob))


def samples():
    table = lp.Response.from_table(np.linspace(0, 1, 50) ** 0.4)
    falloffs = [lp.Vignetting(k=(-0.3 + 0.05 * c, 0.1, -0.05), center=(0.02, -0.03)) for c in range(3)]
    key = lp.ProfileKey(camera_maker="M", camera_model="Kamera ä", lens="50 mm", focal_mm=50, distance_m=math.inf,
                        processing=lp.Processing.RAW)
    rich = lp.Profile(key=key, response=[lp.Response.from_emor([0.8, -0.3, 0.1]), lp.Response.from_gamma(2.2), table],
                      vignetting=falloffs, grid=lp.GainGrid(np.linspace(0.5, 1.5, 3 * 4 * 5).reshape(3, 4, 5)),
                      covariance=np.diag([1.0, 2.0, 3.0]) + 0.25)
    rich.provenance.method, rich.provenance.software, rich.provenance.pairs = "transfer", "lensprof 0.1.0", 5000
    rich.provenance.created_unix_s, rich.provenance.heldout_rms = -5, 1.5
    return [lp.Profile(), rich, lp.Profile(response=lp.Response.from_gamma(0.5)),
            lp.Profile(key=key, response=table, vignetting=falloffs[0], covariance=np.eye(36))]


class Blobs(unittest.TestCase):
    def test_bytes_are_those_of_the_format(self):
        for profile in samples():
            for covariance in (False, True):
                self.assertEqual(profile.pack(covariance=covariance), blob_of(profile, covariance))

    def test_round_trip(self):
        for profile in samples():
            profile.provenance.source = "stays here"
            back = lp.Profile.unpack(np.frombuffer(profile.pack(covariance=True), np.uint8))
            back.validate()
            self.assertEqual(back.pack(covariance=True), profile.pack(covariance=True))
            self.assertEqual(back.provenance.source, "")
            for ours, theirs in zip(profile.response, back.response):
                np.testing.assert_allclose(theirs.table, ours.table, rtol=0, atol=3.1e-8)
            for name in ("key", "vignetting", "grid"):
                self.assertEqual(getattr(back, name), getattr(profile, name))
            np.testing.assert_array_equal(back.covariance, profile.covariance)
            self.assertEqual(lp.Profile.unpack(profile.pack()).covariance_size, 0)

    def test_image_circle(self):
        profile = lp.Profile(vignetting=lp.Vignetting(k=(-0.5, 0, 0)), image_circle=lp.ImageCircle(center=(0.1, 0), radius=0.6))
        profile.validate()
        self.assertEqual(lp.Profile.unpack(profile.pack()).image_circle, profile.image_circle)
        self.assertTrue(profile.image_circle.contains(300, 200, 150, 100))
        self.assertFalse(profile.image_circle.contains(300, 200, 0, 0))
        with refused(self, lp.Status.ERROR_ARGUMENT):
            lp.ImageCircle(radius=-1).validate()
        options = lp.ApplyOptions(frame_width=300, frame_height=200)
        options.set_profile(profile)
        self.assertEqual((options.image_circle, options.levels), (profile.image_circle, None))
        picture = np.full((200, 300, 3), 50, np.uint8)
        corrected = lp.Plan(options).apply(picture)
        self.assertEqual(corrected[0, 0].tolist(), [50, 50, 50])
        self.assertGreater(int(corrected[100, 240, 0]), 55)
        profile.levels.white = 0.5
        options.set_profile(profile)
        self.assertEqual((options.levels.white, options.output_levels.white), (0.5, 0.5))

    def test_refused(self):
        blob = samples()[1].pack()
        wrong = [b"", blob[:-1], blob + b"\0", b"x" * 200]
        wrong += [blob[:at] + bytes([blob[at] ^ 4]) + blob[at + 1:] for at in range(0, len(blob), 211)]
        for data in wrong:
            with refused(self, lp.Status.ERROR_CORRUPT):
                lp.Profile.unpack(data)
        newer = blob[:4] + b"\5" + blob[5:-4]
        with refused(self, lp.Status.ERROR_LAYOUT):
            lp.Profile.unpack(newer + struct.pack("<I", zlib.crc32(newer)))
        for data in ("text", 5, None):
            with self.assertRaises(TypeError):
                lp.Profile.unpack(data)
        with refused(self, lp.Status.ERROR_VIGNETTING):
            lp.Profile(vignetting=lp.Vignetting(k=(-2, 0, 0))).pack()


if __name__ == "__main__":
    unittest.main()
