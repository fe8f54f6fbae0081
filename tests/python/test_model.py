"""Responses, falloffs, exposures and cameras compared with their formulas in NumPy."""
import copy
import ctypes
import gc
import math
import pickle
import unittest

import numpy as np

import lensprof as lp
from lensprof._library import lib
from support import refused


class Responses(unittest.TestCase):
    def test_gamma(self):
        response = lp.Response.from_gamma(2.2)
        x = np.array([[0.0, 0.1], [0.5, 1.0]])
        np.testing.assert_allclose(response.eval(x), x ** (1 / 2.2), rtol=1e-14)
        np.testing.assert_allclose(response.invert(x), x ** 2.2, rtol=1e-14)
        self.assertEqual((response.kind, response.gamma, response.modes), (lp.ResponseKind.GAMMA, 2.2, 0))
        self.assertIsInstance(response.eval(0.25), float)
        self.assertAlmostEqual(response.eval_slope(0.25), 0.25 ** (1 / 2.2 - 1) / 2.2, places=12)
        self.assertAlmostEqual(response.invert_slope(0.25), 2.2 * 0.25 ** 1.2, places=12)

    def test_outside_is_clamped(self):
        response = lp.Response.from_gamma(2)
        np.testing.assert_array_equal(response.eval([-1, 2]), [0, 1])
        np.testing.assert_array_equal(response.eval_slope([-1, 2]), [0, 0])

    def test_arrays_are_bit_for_bit_the_numbers(self):
        """One call for an array gives what a call of the scalar function gives for each number."""
        random = np.random.default_rng(1)
        numbers = random.uniform(-0.2, 1.3, (7, 30))
        numbers[0, :5] = (np.nan, np.inf, -np.inf, 0.0, 1.0)
        slope = ctypes.c_double()
        falloff = lp.Vignetting(k=(-0.3, 0.05, -0.1), center=(0.02, -0.01))
        curves = [lp.Response(), lp.Response.from_gamma(2.2), lp.Response.from_emor([0.5, -0.2]),
                  lp.Response.from_table([0, 0.5, 0.5, 1])]
        cases = [(lib.lensprof_vignetting_eval, falloff, falloff.eval, falloff.eval_slope)]
        for curve in curves:
            cases += [(lib.lensprof_response_eval, curve, curve.eval, curve.eval_slope),
                      (lib.lensprof_response_invert, curve, curve.invert, curve.invert_slope)]
        for scalar, this, value_of, slope_of in cases:
            expected = [(scalar(ctypes.byref(this), x, ctypes.byref(slope)), slope.value) for x in numbers.ravel()]
            for given in (numbers, numbers.T.copy().T, np.repeat(numbers, 2, axis=1)[:, ::2], numbers.tolist()):
                self.assertEqual(value_of(given).shape, (7, 30))
                self.assertEqual(value_of(given).tobytes(), np.array(expected)[:, 0].tobytes())
                self.assertEqual(slope_of(given).tobytes(), np.array(expected)[:, 1].tobytes())
            self.assertEqual(value_of(numbers[:0]).shape, (0, 30))
            for one in (0.25, np.float32(0.25), np.array(0.25)):
                self.assertIs(type(value_of(one)), float)
                self.assertEqual(value_of(one), scalar(ctypes.byref(this), 0.25, None))

    def test_linear_is_the_default(self):
        response = lp.Response()
        self.assertEqual(response, lp.Response.linear())
        np.testing.assert_array_equal(response.table, np.arange(1024) / 1023)

    def test_emor_is_mean_plus_modes(self):
        response = lp.Response.from_emor([0.5, -0.25])
        expected = lp.emor_table(0) + 0.5 * lp.emor_table(1) - 0.25 * lp.emor_table(2)
        np.testing.assert_allclose(response.table[1:-1], expected[1:-1], atol=1e-15)
        np.testing.assert_array_equal(response.emor, [0.5, -0.25] + 23 * [0])
        self.assertEqual((response.kind, response.modes), (lp.ResponseKind.EMOR, 2))

    def test_emor_tables(self):
        modes = np.stack([lp.emor_table(mode) for mode in range(1, 26)])
        np.testing.assert_allclose(modes @ modes.T, np.eye(25), atol=1e-4)  # orthonormal, published with 7 digits
        self.assertFalse(lp.emor_table(0).flags.writeable)
        with refused(self, lp.Status.ERROR_ARGUMENT):
            lp.emor_table(26)

    def test_typical(self):
        response, covariance, sigma = lp.Response.typical(lp.CameraKind.STILL)
        self.assertEqual((response.kind, covariance.shape), (lp.ResponseKind.EMOR, (25, 25)))
        self.assertTrue(np.linalg.eigvalsh(covariance).min() > 0 and 0.05 < sigma < 0.1)
        q = np.log(np.log(response.invert(208 / 255) / response.invert(48 / 255)))
        self.assertAlmostEqual(q, 0.882, delta=0.002)
        response, covariance, sigma = lp.Response.typical(lp.CameraKind.LINEAR)
        self.assertEqual((response, covariance.any(), sigma), (lp.Response.linear(), False, 0))
        with self.assertRaises(ValueError):
            lp.Response.typical(6)

    def test_table(self):
        response = lp.Response.from_table([0, 0.75, 1])
        np.testing.assert_allclose(response.eval([0.25, 0.5, 0.75]), [0.375, 0.75, 0.875], atol=1e-3)
        np.testing.assert_allclose(response.invert([0.375, 0.875]), [0.25, 0.75], atol=1e-3)

    def test_refused(self):
        for make, status in (
                (lambda: lp.Response.from_gamma(0), lp.Status.ERROR_RESPONSE),
                (lambda: lp.Response.from_gamma(math.nan), lp.Status.ERROR_RESPONSE),
                (lambda: lp.Response.from_emor([50]), lp.Status.ERROR_RESPONSE),
                (lambda: lp.Response.from_emor([math.inf]), lp.Status.ERROR_NOT_FINITE),
                (lambda: lp.Response.from_emor([0] * 26), lp.Status.ERROR_ARGUMENT),
                (lambda: lp.Response.from_table([0]), lp.Status.ERROR_ARGUMENT),
                (lambda: lp.Response.from_table([0, 0.5, 0.4, 1]), lp.Status.ERROR_RESPONSE)):
            with refused(self, status):
                make()

    def test_cannot_be_changed(self):
        response = lp.Response.from_gamma(2)
        with self.assertRaises(AttributeError):
            response.gamma = 3
        with self.assertRaises(ValueError):
            response.table[5] = 0
        with self.assertRaises(TypeError):
            lp.Response(gamma=3)
        response.validate()

    def test_view_outlives_its_object(self):
        table = lp.Response.from_gamma(2).table
        expected = table.copy()
        gc.collect()
        junk = [lp.Response.linear() for _ in range(50)]
        np.testing.assert_array_equal(table, expected)
        del junk

    def test_copies(self):
        response = lp.Response.from_gamma(2)
        for other in (response.copy(), copy.copy(response), copy.deepcopy(response),
                      pickle.loads(pickle.dumps(response))):
            self.assertEqual(other, response)
            self.assertFalse(np.shares_memory(other.table, response.table))
        self.assertNotEqual(response, lp.Response.from_gamma(2.1))


class Vignettings(unittest.TestCase):
    def test_polynomial(self):
        vignetting = lp.Vignetting(k=(-0.3, 0.1, -0.05))
        r2 = np.linspace(0, 1, 7)
        np.testing.assert_allclose(vignetting.eval(r2), 1 - 0.3 * r2 + 0.1 * r2**2 - 0.05 * r2**3, rtol=1e-15)
        np.testing.assert_allclose(vignetting.eval_slope(r2), -0.3 + 0.2 * r2 - 0.15 * r2**2, rtol=1e-14)

    def test_radius(self):
        vignetting = lp.Vignetting(center=(0.1, -0.2))
        x, y = np.array([0, 17.5]), np.array([0, 3.0])
        dx, dy = (x - 19.5) / 25 - 0.1, (y - 14.5) / 25 + 0.2  # 40 x 30: half diagonal 25
        np.testing.assert_allclose(vignetting.r2(40, 30, x, y), dx**2 + dy**2, rtol=1e-14)
        np.testing.assert_allclose(vignetting.r2_gradient(40, 30, x, y), np.stack([-2 * dx, -2 * dy], axis=-1),
                                   rtol=1e-14)

    def test_fields_are_views(self):
        vignetting = lp.Vignetting()
        vignetting.k[0] = -0.25
        self.assertEqual(vignetting.eval(1.0), 0.75)
        vignetting.k = [0, 0, 0.5]
        self.assertEqual(vignetting.eval(1.0), 1.5)
        with self.assertRaisesRegex(ValueError, "k holds 3 numbers"):
            vignetting.k = (1, 2)

    def test_validate(self):
        lp.Vignetting(k=(-0.5, 0, 0)).validate()
        with refused(self, lp.Status.ERROR_VIGNETTING):
            lp.Vignetting(k=(-1.5, 0, 0)).validate()
        with refused(self, lp.Status.ERROR_NOT_FINITE):
            lp.Vignetting(k=(math.nan, 0, 0)).validate()


class GainGrids(unittest.TestCase):
    NODES = np.array([[1.0, 0.5, 0.25], [2.0, 1.5, 1.0]], dtype=np.float32)

    def test_no_grid_is_the_default(self):
        grid = lp.GainGrid()
        grid.validate()
        self.assertEqual((grid.columns, grid.rows, grid.channels, grid.attenuation.size), (0, 0, 0, 0))
        self.assertEqual(grid.eval(640, 480, 10, 20), 1.0)

    def test_bilinear(self):
        grid = lp.GainGrid(self.NODES)
        self.assertEqual((grid.columns, grid.rows, grid.channels), (3, 2, 1))
        x, y = np.meshgrid([0, 10.5, 50, 75.25, 100], [0, 3, 20])
        columns = [np.interp(x, [0, 50, 100], row) for row in self.NODES.astype(float)]
        expected = columns[0] + y / 20 * (columns[1] - columns[0])
        np.testing.assert_allclose(grid.eval(101, 21, x, y), expected, rtol=1e-12)
        np.testing.assert_array_equal(grid.eval(101, 21, [-5, 300], [-5, 300]), [1, 1])

    def test_channels(self):
        grid = lp.GainGrid(np.stack([self.NODES, 2 * self.NODES, 3 * self.NODES]))
        self.assertEqual([grid.eval(101, 21, 0, 20, c) for c in range(3)], [2, 4, 6])
        with refused(self, lp.Status.ERROR_ARGUMENT):
            grid.eval(101, 21, 0, 0, 3)

    def test_a_smaller_grid_leaves_nothing_behind(self):
        grid = lp.GainGrid(np.full((3, 32, 32), 0.5))
        grid.attenuation = self.NODES
        grid.validate()
        self.assertEqual(bytes(grid), bytes(lp.GainGrid(self.NODES)))
        grid.attenuation[0, 1, 2] = 7
        self.assertEqual(grid.eval(11, 11, 10, 10), 7.0)
        self.assertEqual(grid.copy(), grid)
        grid.attenuation = grid.attenuation[:, ::-1]
        self.assertEqual(grid.eval(11, 11, 10, 0), 7.0)

    def test_refused(self):
        for shape in ((2,), (1, 4), (4, 33), (2, 4, 4), (1, 1, 4, 4)):
            with self.assertRaisesRegex(ValueError, "2..32"):
                lp.GainGrid(np.ones(shape))
        for value, status in ((0, lp.Status.ERROR_VIGNETTING), (1001, lp.Status.ERROR_VIGNETTING),
                              (math.nan, lp.Status.ERROR_NOT_FINITE)):
            grid = lp.GainGrid(self.NODES)
            grid.attenuation[0, 0, 0] = value
            with refused(self, status):
                grid.validate()


class Exposures(unittest.TestCase):
    def test_factor(self):
        exposure = lp.Exposure(ev=-2, white_balance=(1.5, 1, 0.5))
        self.assertEqual([exposure.factor(c) for c in range(3)], [0.375, 0.25, 0.125])
        with refused(self, lp.Status.ERROR_ARGUMENT):
            exposure.factor(3)

    def test_default_and_validate(self):
        self.assertEqual(lp.Exposure().white_balance.tolist(), [1, 1, 1])
        lp.Exposure().validate()
        with refused(self, lp.Status.ERROR_EXPOSURE):
            lp.Exposure(ev=65).validate()

    def test_mean(self):
        mean = lp.Exposure.mean([lp.Exposure(ev=1, white_balance=(4, 1, 1)), lp.Exposure(ev=math.nan), lp.Exposure(ev=4)])
        self.assertEqual(mean.ev, 2.5)
        np.testing.assert_allclose(mean.white_balance, (2, 1, 1), rtol=1e-15)
        self.assertTrue(math.isnan(lp.Exposure.mean([]).ev))


class Structs(unittest.TestCase):
    def test_unknown_names(self):
        with self.assertRaisesRegex(AttributeError, "Camera has no field hfov; it has projection, width"):
            lp.Camera(hfov=50)
        with self.assertRaises(AttributeError):
            lp.Exposure().evs = 3

    def test_numbers_that_would_wrap_around(self):
        for value in (-1, 2**32):
            with self.assertRaisesRegex(ValueError, "Camera.width"):
                lp.Camera(width=value)
        with self.assertRaises(TypeError):
            lp.Camera(width=2.5)
        self.assertEqual(lp.Camera(width=np.int64(20)).width, 20)

    def test_unknown_enumeration(self):
        with self.assertRaises(ValueError):
            lp.Camera(projection=5)
        self.assertIs(lp.Camera(projection=4).projection, lp.Projection.EQUIRECTANGULAR)

    def test_comparison_and_text(self):
        one = lp.Exposure(ev=1)
        self.assertEqual(one, lp.Exposure(ev=1))
        self.assertNotEqual(one, lp.Exposure(ev=1, white_balance=(1, 1, 2)))
        self.assertNotEqual(one, 1)
        self.assertEqual(repr(one), "Exposure(ev=1.0, white_balance=[1.0, 1.0, 1.0])")


class Cameras(unittest.TestCase):
    def test_rectilinear_formula(self):
        camera = lp.Camera(width=401, height=301, hfov_deg=60)
        focal = 0.5 * 401 / math.tan(math.radians(30))
        longitude, latitude = np.array([0.0, 0.2, -0.1]), np.array([0.0, 0.1, 0.05])
        expected = np.stack([200 + focal * np.tan(longitude),
                             150 + focal * np.tan(latitude) / np.cos(longitude)], axis=-1)
        np.testing.assert_allclose(camera.project(longitude, latitude), expected, atol=1e-9)

    def test_inverse(self):
        camera = lp.Camera(width=400, height=300, hfov_deg=50, yaw_deg=20, pitch_deg=-10, roll_deg=5,
                           radial=(0.01, -0.02, 0))
        y, x = np.mgrid[0:300:37, 0:400:41]
        directions = camera.unproject(x, y)
        self.assertEqual(directions.shape, x.shape + (2,))
        np.testing.assert_allclose(camera.project(directions[..., 0], directions[..., 1]), np.stack([x, y], axis=-1),
                                   atol=1e-8)

    def test_arrays_are_bit_for_bit_the_numbers(self):
        camera = lp.Camera(width=400, height=300, hfov_deg=50, yaw_deg=20, radial=(0.01, -0.02, 0))
        falloff, grid = lp.Vignetting(k=(-0.3, 0, 0), center=(0.1, 0)), lp.GainGrid([[1, 0.9, 0.8], [0.7, 0.6, 0.5]])
        random, two = np.random.default_rng(2), (ctypes.c_double * 2)()
        across, down = random.uniform(-3, 3, (9, 1)), random.uniform(-1.5, 1.5, (2, 1, 8))
        across[0], down[0, 0, 0] = np.nan, np.inf

        def each(call):
            return np.array([call(x, y) for x, y in zip(*(a.ravel() for a in np.broadcast_arrays(across, down)))])

        def mapped(function):
            return lambda x, y: tuple(two) if function(ctypes.byref(camera), x, y, two) else (np.nan, np.nan)

        def gradient(x, y):
            lib.lensprof_vignetting_r2(ctypes.byref(falloff), 400, 300, x, y, two)
            return tuple(two)
        for found, expected in (
                (camera.project(across, down), each(mapped(lib.lensprof_camera_project))),
                (camera.unproject(across, down), each(mapped(lib.lensprof_camera_unproject))),
                (falloff.r2_gradient(400, 300, across, down), each(gradient))):
            self.assertEqual(found.shape, (2, 9, 8, 2))
            np.testing.assert_array_equal(found.reshape(-1, 2), expected)
        for found, expected in (
                (falloff.r2(400, 300, across, down),
                 each(lambda x, y: lib.lensprof_vignetting_r2(ctypes.byref(falloff), 400, 300, x, y, None))),
                (grid.eval(400, 300, across, down, 2),
                 each(lambda x, y: lib.lensprof_gain_grid_eval(ctypes.byref(grid), 400, 300, x, y, 2)))):
            self.assertEqual(found.shape, (2, 9, 8))
            np.testing.assert_array_equal(found.ravel(), expected)
        self.assertIs(type(falloff.r2(400, 300, 5, 6.0)), float)
        with self.assertRaises(ValueError):
            camera.project(np.zeros(2), np.zeros(3))

    def test_broadcast_and_unseen(self):
        camera = lp.Camera(width=400, height=300, hfov_deg=50)
        pixels = camera.project([0, math.pi], 0)
        np.testing.assert_allclose(pixels[0], [199.5, 149.5])
        self.assertTrue(np.isnan(pixels[1]).all())
        self.assertEqual(camera.project(0, 0).shape, (2,))

    def test_refused(self):
        for camera in (lp.Camera(), lp.Camera(width=10, height=10, hfov_deg=190), lp.Camera(width=10, height=10)):
            for call in (camera.validate, lambda: camera.project(0, 0), lambda: camera.unproject(0, 0)):
                with refused(self, lp.Status.ERROR_GEOMETRY):
                    call()


if __name__ == "__main__":
    unittest.main()
