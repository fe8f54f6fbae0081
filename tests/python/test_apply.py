"""Applying a profile to arrays: values according to the formula, memory, and refused input."""
import gc
import threading
import unittest

import numpy as np

import lensprof as lp
from support import read_only, refused

GAMMA = 2.0
K = (-0.4, 0.1, 0.0)
TYPES = {np.uint8: 255, np.uint16: 65535, np.float32: 1}


def profile():
    return lp.Profile(response=lp.Response.from_gamma(GAMMA), vignetting=lp.Vignetting(k=K))


def falloff(height, width):
    y, x = np.mgrid[0:height, 0:width]
    r2 = ((x - (width - 1) / 2) ** 2 + (y - (height - 1) / 2) ** 2) / (width**2 + height**2) * 4
    return 1 + K[0] * r2 + K[1] * r2**2 + K[2] * r2**3


def corrected(grey, gain=1.0):
    """Goldman & Chen 2005, equation 16, with f(x) = sqrt(x), for grey values 0..1."""
    m = falloff(*grey.shape[:2])
    return np.clip(grey**GAMMA / (m[..., None] if grey.ndim == 3 else m) * gain, 0, 1) ** (1 / GAMMA)


def picture(dtype, shape=(30, 40, 3), largest=0.6):
    values = np.random.default_rng(5).uniform(0.05, largest, shape)
    return (values * TYPES[dtype]).astype(dtype)


def options(**fields):
    return lp.ApplyOptions(**{"frame_width": 40, "frame_height": 30, "response": profile().response,
                              "vignetting": profile().vignetting, **fields})


class Fixed(unittest.TestCase):
    def test_within_a_level_of_the_plan_in_floating_point(self):
        for shape in ((30, 40), (30, 40, 3), (30, 40, 4)):
            array = picture(np.uint8, shape)
            fields = options(source_layout={2: lp.Layout.GREY}.get(len(shape), lp.Layout.RGB if shape[-1] == 3 else
                                                                   lp.Layout.RGBA))
            plan, wanted = lp.FixedPlan(fields), lp.Plan(fields).apply(array)
            result = plan.apply(array)
            self.assertLessEqual(np.abs(result.astype(int) - wanted).max(), 1)
            self.assertTrue((result != array).any())
            tile = np.ascontiguousarray(array[10:20, 5:25])
            np.testing.assert_array_equal(lp.FixedPlan.open(plan.data, fields.source_layout).apply(tile, x0=5, y0=10),
                                          result[10:20, 5:25])

    def test_a_mosaic_of_12_bit(self):
        levels = lp.Levels(black=[256 / 65535] * 3, white=4095 / 65535)
        fields = options(source_sample=lp.SampleType.U16, target_sample=lp.SampleType.U16, levels=levels,
                         output_levels=levels, source_layout=lp.Layout.RGGB, response=lp.Response())
        array = np.random.default_rng(3).integers(200, 4096, (30, 40)).astype(np.uint16)
        result = lp.FixedPlan(fields).apply(array)
        wanted = np.minimum(256 + (array.astype(float) - 256) / falloff(30, 40), 4095)
        self.assertLessEqual(np.abs(result - wanted).max(), 0.51)
        self.assertLessEqual(np.abs(lp.Plan(fields).apply(array).astype(int) - result).max(), 1)

    def test_companded_samples_of_12_bit(self):
        levels = lp.Levels(black=[240 / 65535] * 3, white=4095 / 65535)
        knees = lp.Response.from_table([0.0, 0.5, 0.7, 0.8, 0.875, 0.925, 0.95, 0.975, 1.0])
        array = np.random.default_rng(4).integers(200, 4096, (30, 40)).astype(np.uint16)
        for target in (lp.SampleType.U16, lp.SampleType.U8):
            fields = options(source_sample=lp.SampleType.U16, target_sample=target, levels=levels, response=knees,
                             source_layout=lp.Layout.RGGB, output=lp.Encoding.LINEAR)
            plan, wanted = lp.FixedPlan(fields), lp.Plan(fields).apply(array)
            result = plan.apply(array)
            self.assertEqual(result.dtype, wanted.dtype)
            self.assertLessEqual(np.abs(result.astype(int) - wanted).max(), 1)
            again = lp.FixedPlan.open(plan.data, lp.Layout.RGGB).apply(array, np.empty_like(result))
            np.testing.assert_array_equal(again, result)

    def test_gain_grid(self):
        fields = options(grid=lp.GainGrid([[0.5, 0.8, 0.6], [0.9, 1.0, 0.7]]), strength=0.8)
        array = picture(np.uint8)
        difference = lp.FixedPlan(fields).apply(array).astype(int) - lp.Plan(fields).apply(array)
        self.assertLessEqual(np.abs(difference).max(), 1)

    def test_what_is_refused(self):
        plan = lp.FixedPlan(options())
        self.assertLess(len(plan.data), 5000)
        for bad in (plan.data[:-4], plan.data[:20], b"", plan.data[:-1] + bytes([plan.data[-1] ^ 1])):
            with self.assertRaises(lp.Error):
                lp.FixedPlan.open(bad, lp.Layout.RGB)
        for fields in ({"source_sample": lp.SampleType.F32}, {"dither": True}):
            with self.assertRaises(lp.Error):
                lp.FixedPlan(options(**fields))
        with self.assertRaises(lp.Error):
            plan.apply(picture(np.uint8, (30, 40, 3)), x0=1)


class Values(unittest.TestCase):
    def test_correct_in_every_type(self):
        for dtype, white in TYPES.items():
            for shape in ((30, 40), (30, 40, 1), (30, 40, 3)):
                array = picture(dtype, shape)
                result = lp.correct(array, profile())
                self.assertEqual((result.dtype, result.shape), (array.dtype, shape))
                grey = array.reshape(30, 40, -1) / white
                error = np.abs(result.reshape(grey.shape) / white - corrected(grey)).max()
                self.assertLess(error, 1e-6 if dtype is np.float32 else 0.51 / white, (dtype, shape))

    def test_gain_grid(self):
        nodes = np.random.default_rng(2).uniform(0.7, 1.3, (3, 4, 6))
        with_grid, array = profile(), picture(np.float32, largest=0.5)
        with_grid.grid = lp.GainGrid(nodes)
        y, x = np.mgrid[0:30, 0:40]
        grid = np.stack([with_grid.grid.eval(40, 30, x, y, c) for c in range(3)], axis=-1)
        np.testing.assert_allclose(lp.correct(array, with_grid, saturated=lp.Saturated.AS_VALUE),
                                   corrected(array, 1 / grid), atol=2e-6)
        dark = lp.simulate(array, with_grid)
        np.testing.assert_allclose(dark, (array**GAMMA * falloff(30, 40)[..., None] * grid) ** (1 / GAMMA), atol=2e-6)

    def test_gain_grid_option(self):
        fields = options(grid=lp.GainGrid([[0.5, 0.5], [0.5, 0.5]]), vignetting=lp.Vignetting(),
                         response=lp.Response(), source_layout=lp.Layout.GREY)
        self.assertEqual(fields.grid, lp.GainGrid(np.full((2, 2), 0.5)))
        gc.collect()
        self.assertEqual(lp.Plan(fields).apply(np.full((30, 40), 100, np.uint8)).tolist(), [[200] * 40] * 30)
        fields.grid = None
        self.assertIsNone(fields.grid)
        self.assertEqual(lp.Plan(fields).apply(np.full((30, 40), 100, np.uint8)).tolist(), [[100] * 40] * 30)
        bad = lp.GainGrid([[0.5, 0.5], [0.5, 0.5]])
        bad.attenuation[0, 0, 0] = 0
        with refused(self, lp.Status.ERROR_VIGNETTING):
            lp.Plan(options(grid=bad))
        with self.assertRaises(TypeError):
            options(grid=np.ones((2, 2)))

    def test_output_response(self):
        array, fields = picture(np.uint16), options(source_sample=lp.SampleType.U16, target_sample=lp.SampleType.U16)
        self.assertEqual((fields.output_response, fields.output_responses), ((), 0))
        plain = lp.Plan(fields).apply(array)
        fields.output_response = fields.response[0]
        self.assertEqual(fields.output_responses, 1)
        np.testing.assert_array_equal(lp.Plan(fields).apply(array), plain)
        fields.output_response = lp.Response.from_gamma(1.5)
        other = lp.Plan(fields).apply(array)
        self.assertFalse(np.array_equal(other, plain))
        fields.output_response = None
        np.testing.assert_array_equal(lp.Plan(fields).apply(array), plain)
        with self.assertRaisesRegex(AttributeError, "assign output_response"):
            fields.output_responses = 3

    def test_blob_option(self):
        with_grid = profile()
        with_grid.response = lp.Response.from_emor([0.8, -0.3])
        with_grid.grid = lp.GainGrid(np.random.default_rng(2).uniform(0.7, 1.3, (3, 4, 6)))
        blob, array = with_grid.pack(), picture(np.uint16)
        fields = lp.ApplyOptions(frame_width=40, frame_height=30, source_sample=lp.SampleType.U16,
                                 target_sample=lp.SampleType.U16, blob=bytearray(blob))
        self.assertEqual((fields.blob, fields.blob_bytes), (blob, len(blob)))
        gc.collect()
        np.testing.assert_array_equal(lp.Plan(fields).apply(array), lp.correct(array, lp.Profile.unpack(blob)))
        with self.assertRaisesRegex(AttributeError, "assign blob"):
            fields.blob_bytes = 3
        fields.blob = blob[:-1]
        with refused(self, lp.Status.ERROR_CORRUPT):
            lp.Plan(fields)
        fields.blob = None
        with refused(self, lp.Status.ERROR_ARGUMENT):
            lp.Plan(fields)
        with refused(self, lp.Status.ERROR_ARGUMENT):
            lp.Plan(options(blob=blob))

    def test_exposure_and_white_balance(self):
        array = picture(np.float32, largest=0.3)
        source, target = lp.Exposure(ev=-1, white_balance=(2, 1, 0.5)), lp.Exposure(ev=0.5)
        expected = corrected(array, 2**1.5 / np.array([2, 1, 0.5]))
        np.testing.assert_allclose(lp.correct(array, profile(), source=source, target=target), expected, atol=2e-6)

    def test_simulate_is_the_inverse(self):
        array = picture(np.float32)
        exposure = lp.Exposure(ev=-0.7, white_balance=(1.1, 1, 0.9))
        recorded = lp.simulate(array, profile(), source=exposure)
        self.assertGreater(np.abs(recorded - array).max(), 0.1)
        np.testing.assert_allclose(lp.correct(recorded, profile(), source=exposure), array, atol=2e-6)

    def test_layouts(self):
        array, exposure = picture(np.uint8), lp.Exposure(white_balance=(1.5, 1, 0.7))
        expected = lp.correct(array, profile(), source=exposure)
        mirrored = np.ascontiguousarray(array[..., ::-1])
        result = lp.correct(mirrored, profile(), source=exposure, layout=lp.Layout.BGR)
        np.testing.assert_array_equal(result[..., ::-1], expected)
        alpha = picture(np.uint8, (30, 40, 1))
        result = lp.correct(np.concatenate([array, alpha], axis=2), profile(), source=exposure)
        np.testing.assert_array_equal(result, np.concatenate([expected, alpha], axis=2))
        result = lp.correct(np.concatenate([mirrored, alpha], axis=2), profile(), source=exposure,
                            layout=lp.Layout.BGRA)
        np.testing.assert_array_equal(result, np.concatenate([expected[..., ::-1], alpha], axis=2))
        grey = lp.correct(np.concatenate([alpha, alpha], axis=2), profile())
        np.testing.assert_array_equal(grey[..., 1:], alpha)
        np.testing.assert_array_equal(grey[..., 0], lp.correct(alpha[..., 0], profile()))

    def test_facts_of_layouts_and_samples(self):
        self.assertEqual([lp.layout_samples(layout) for layout in lp.Layout], [1, 2, 3, 4, 3, 4, 1, 1, 1, 1, 1])
        self.assertEqual([lp.layout_channels(layout) for layout in lp.Layout], [1, 1, 3, 3, 3, 3, 3, 3, 3, 3, 3])
        self.assertEqual([lp.sample_type_bytes(sample) for sample in lp.SampleType], [1, 2, 4, 2])

    def test_planes_mosaics_and_halves(self):
        rng = np.random.default_rng(4)
        profile = lp.Profile()
        profile.vignetting[0].k[:] = (-0.3, 0.05, -0.1)
        picture = rng.random((30, 40, 3)).astype(np.float16)
        options = lp.ApplyOptions(frame_width=40, frame_height=30, source_sample=lp.SampleType.F16,
                                  target_sample=lp.SampleType.F16, response=profile.response,
                                  vignetting=profile.vignetting)
        whole = lp.Plan(options).apply(picture)
        self.assertEqual(whole.dtype, np.float16)
        options.source_layout = lp.Layout.PLANAR
        planes = [np.ascontiguousarray(picture[:, :, c]) for c in range(3)]
        result = lp.Plan(options).apply_planar(planes)
        for c in range(3):
            np.testing.assert_array_equal(result[c], whole[:, :, c])
        with self.assertRaises(lp.Error):
            lp.Plan(options).apply_planar(planes, [planes[1], planes[0], planes[2]])
        with self.assertRaises(ValueError):
            lp.Plan(options).apply_planar(planes[:2])
        options.source_layout = lp.Layout.GRBG
        options.saturated = lp.Saturated.AS_VALUE
        mosaic = lp.Plan(options).apply(planes[1])
        self.assertEqual(mosaic.shape, (30, 40))
        self.assertGreater(float(mosaic.astype(np.float32).sum()), float(planes[1].astype(np.float32).sum()))

    def test_packed_rows(self):
        codes = (picture(np.uint16, (30, 40)) >> 6).astype(np.uint16)  # 10 bits
        packed = lp.pack_rows(codes, lp.Packing.RAW10)
        groups = codes.reshape(30, 10, 4)
        low = ((groups & 3) << np.arange(0, 8, 2)).sum(axis=2)  # the first sample in the lowest bits
        wanted = np.dstack([groups >> 2, low]).astype(np.uint8).reshape(30, 50)
        np.testing.assert_array_equal(packed, wanted)
        np.testing.assert_array_equal(lp.unpack_rows(packed, lp.Packing.RAW10, 40), codes)
        fields = options(source_sample=lp.SampleType.U16, target_sample=lp.SampleType.U16, source_layout=lp.Layout.RGGB,
                         input=lp.Encoding.LINEAR, output=lp.Encoding.LINEAR)
        for plan in (lp.Plan(fields), lp.FixedPlan(fields)):
            whole = plan.apply(codes)
            self.assertTrue((whole != codes).any())
            rows = np.zeros((30, 60), dtype=np.uint8)  # some bytes after each row
            rows[:, :50] = packed
            upside = plan.apply_packed(rows[2::-1], lp.Packing.RAW10, 40, y0=2)
            np.testing.assert_array_equal(lp.unpack_rows(upside, lp.Packing.RAW10, 40),
                                          np.minimum(plan.apply(np.ascontiguousarray(codes[2::-1]), y0=2), 1023))
            tile = lp.pack_rows(codes[3:9, 5:25], lp.Packing.RAW10)
            self.assertIs(plan.apply_packed(tile, lp.Packing.RAW10, 20, tile, x0=5, y0=3), tile)
            np.testing.assert_array_equal(lp.unpack_rows(tile, lp.Packing.RAW10, 20), np.minimum(whole[3:9, 5:25], 1023))
            plan.apply_packed(rows, lp.Packing.RAW10, 40, rows)
            np.testing.assert_array_equal(lp.unpack_rows(rows, lp.Packing.RAW10, 40), np.minimum(whole, 1023))
            self.assertFalse(rows[:, 50:].any())
            with self.assertRaises(lp.Error):
                plan.apply_packed(rows, lp.Packing.RAW10, 40, x0=1)
            for bad in (42, 44, 0):
                with self.assertRaises(ValueError):
                    plan.apply_packed(packed, lp.Packing.RAW10, bad)
            with self.assertRaises(ValueError):
                plan.apply_packed(read_only(packed), lp.Packing.RAW10, 40, read_only(packed))
            with self.assertRaises(TypeError):
                plan.apply_packed(codes, lp.Packing.RAW10, 40)
        with self.assertRaises(lp.Error):
            lp.Plan(options()).apply_packed(packed, lp.Packing.RAW10, 40)
        for bad in (codes.astype(np.uint8), codes.astype(np.float32)):
            with self.assertRaises(TypeError):
                lp.pack_rows(bad, lp.Packing.RAW12)
        with self.assertRaises(ValueError):
            lp.unpack_rows(packed, 11, 40)

    def test_strength_cap_and_dither(self):
        array = np.full((48, 64, 3), 90, np.uint8)
        full, half = lp.correct(array, profile()), lp.correct(array, profile(), strength=0.5)
        self.assertTrue(90 < half[0, 0, 1] < full[0, 0, 1])
        self.assertLessEqual(lp.correct(array, profile(), gain_cap=1.0).max(), 91)
        self.assertGreater(len(np.unique(lp.correct(array, profile(), dither=True)[20:28, 28:36])), 1)
        with self.assertRaisesRegex(lp.Error, "strength"):
            lp.correct(array, profile(), strength=2.0)
        with self.assertRaisesRegex(TypeError, "FixedPlan.open"):
            lp.FixedPlan(b"12")

    def test_saturated(self):
        array = np.full((30, 40, 3), 255, dtype=np.uint8)
        cast = lp.Exposure(ev=0.5, white_balance=(1, 1, 2))
        neutral = lp.correct(array, profile(), source=cast)
        np.testing.assert_array_equal(neutral[..., 0], neutral[..., 2])
        plain = lp.correct(array, profile(), source=cast, saturated=lp.Saturated.AS_VALUE)
        self.assertTrue((plain[..., 0] > plain[..., 2]).all())

    def test_curves_of_channels(self):
        gammas = (1.5, 2.0, 2.5)
        mixed = lp.Profile(response=[lp.Response.from_gamma(g) for g in gammas], vignetting=profile().vignetting)
        array = picture(np.float32)
        brighter = lp.Exposure(ev=0.2)
        result = lp.correct(array, mixed, target=brighter)
        for channel, gamma in enumerate(gammas):
            single = lp.Profile(response=lp.Response.from_gamma(gamma), vignetting=profile().vignetting)
            expected = lp.correct(array, single, target=brighter)
            np.testing.assert_array_equal(result[..., channel], expected[..., channel])

    def test_other_output_type_and_encoding(self):
        array = picture(np.uint8)
        plan = lp.Plan(options(output=lp.Encoding.LINEAR, target_sample=lp.SampleType.F32))
        light = plan.apply(array)
        self.assertEqual(light.dtype, np.float32)
        np.testing.assert_allclose(light, (array / 255) ** GAMMA / falloff(30, 40)[..., None], atol=1e-6)
        out = np.empty(array.shape, dtype=np.uint16)
        self.assertIs(lp.correct(array, profile(), out=out), out)
        np.testing.assert_allclose(out / 65535, corrected(array / 255), atol=1e-5)

    def test_tiles_are_parts_of_the_frame(self):
        array = picture(np.uint16)
        whole = lp.correct(array, profile())
        plan = lp.Plan(options(source_sample=lp.SampleType.U16, target_sample=lp.SampleType.U16))
        np.testing.assert_array_equal(plan.apply(array[7:19, 11:32], x0=11, y0=7), whole[7:19, 11:32])

    def test_threads_share_a_plan(self):
        array = picture(np.uint8)
        expected, result = lp.correct(array, profile()), array.copy()
        plan = lp.Plan(options())
        threads = [threading.Thread(target=plan.apply, args=(result[y:y + 5], result[y:y + 5]), kwargs={"y0": y})
                   for y in range(0, 30, 5)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        np.testing.assert_array_equal(result, expected)


class Memory(unittest.TestCase):
    def test_in_place(self):
        for dtype in TYPES:
            array = picture(dtype)
            expected, place = lp.correct(array, profile()), array.ctypes.data
            self.assertIs(lp.correct(array, profile(), out=array), array)
            self.assertEqual(array.ctypes.data, place)
            np.testing.assert_array_equal(array, expected)

    def test_slices(self):
        """Parts of a larger array with rows in all directions: written in place, and nothing outside them."""
        for rows in (slice(5, 35), slice(34, 4, -1), slice(0, 60, 2), slice(59, 0, -2)):
            parent = picture(np.uint8, (60, 100, 3))
            before, part = parent.copy(), parent[rows, 30:70]
            self.assertEqual(part.shape, (30, 40, 3))
            expected = lp.correct(np.ascontiguousarray(part), profile())
            self.assertIs(lp.correct(part, profile(), out=part), part)
            inside = np.zeros(parent.shape, dtype=bool)
            inside[rows, 30:70] = True
            np.testing.assert_array_equal(parent[rows, 30:70], expected)
            np.testing.assert_array_equal(parent[~inside], before[~inside])
            self.assertTrue((parent[inside] != before[inside]).any())

    def test_into_a_slice(self):
        array, parent = picture(np.uint8), np.zeros((50, 60, 3), dtype=np.uint8)
        lp.correct(array[::-1], profile(), out=parent[40:10:-1, 5:45])
        np.testing.assert_array_equal(parent[11:41, 5:45], lp.correct(array, profile()))
        self.assertEqual(np.count_nonzero(parent.any(axis=(1, 2))), 30)

    def test_single_rows_columns_and_samples(self):
        """NumPy gives axes of length 1 arbitrary strides."""
        for shape in ((1, 40), (30, 1), (1, 1), (30, 40)):
            parent = picture(np.uint8, (60, 80, 3))
            part = parent[::2, ::2, 1:2][:shape[0], :shape[1]]
            if shape[1] == 1:
                expected = lp.correct(part.copy(), profile())
                lp.correct(part, profile(), out=part)
                np.testing.assert_array_equal(part, expected)
            else:
                with self.assertRaisesRegex(ValueError, "must lie side by side"):
                    lp.correct(part, profile())
        row = np.lib.stride_tricks.as_strided(picture(np.uint16), (1, 40, 3), (7, 6, 2))
        np.testing.assert_array_equal(lp.correct(row, profile()), lp.correct(row.copy(), profile()))

    def test_plan_lives_without_its_options(self):
        array = picture(np.uint8)
        wanted = options(response=lp.Response.from_gamma(GAMMA), vignetting=lp.Vignetting(k=K))
        gc.collect()
        junk = [lp.Response.linear() for _ in range(50)]
        self.assertEqual(wanted.response, (lp.Response.from_gamma(GAMMA),))
        plan = lp.Plan(wanted)
        del wanted, junk
        gc.collect()
        junk = [np.ones(3000) for _ in range(50)]
        np.testing.assert_array_equal(plan.apply(array), lp.correct(array, profile()))
        del junk

    def test_count_of_curves_belongs_to_the_curves(self):
        wanted = options(response=[lp.Response.from_gamma(gamma) for gamma in (1, 2, 3)])
        self.assertEqual((wanted.responses, wanted.vignettings), (3, 1))
        for name in ("responses", "vignettings"):
            with self.assertRaisesRegex(AttributeError, "assign one or three curves"):
                setattr(wanted, name, 3)
        wanted.response = lp.Response.linear()
        self.assertEqual((wanted.responses, len(wanted.response)), (1, 1))

    def test_replaced_response_stays_readable(self):
        wanted = options()
        old = wanted.response[0]
        wanted.response = lp.Response.from_gamma(3)
        gc.collect()
        self.assertEqual(old, lp.Response.from_gamma(GAMMA))
        self.assertEqual(wanted.response[0].gamma, 3)


class Refused(unittest.TestCase):
    def test_types(self):
        for array in (np.zeros((4, 4)), np.zeros((4, 4), np.int8), np.zeros((4, 4), np.bool_), np.zeros((4, 4), ">u2"),
                      np.zeros((4, 4), ">f4")):
            with self.assertRaisesRegex(TypeError, "convert the picture to uint8, uint16, float16 or float32"):
                lp.correct(array, profile())
        with self.assertRaisesRegex(TypeError, "must be a numpy.ndarray, not list"):
            lp.correct([[1, 2]], profile())

    def test_shapes_and_strides(self):
        array = picture(np.uint8, (30, 80, 6))
        for wrong in (array[:, ::2, :3], array[:, ::-1, :3], array[..., :3], array[..., ::2], array[..., 0],
                      array[:, :, :3].transpose(1, 0, 2), np.asfortranarray(array[..., :3])):
            with self.assertRaisesRegex(ValueError, "must lie side by side"):
                lp.correct(wrong, profile())
        for wrong in (np.zeros(5, np.uint8), np.zeros((5, 5, 5), np.uint8), np.zeros((2, 2, 2, 3), np.uint8)):
            with self.assertRaises(ValueError):
                lp.correct(wrong, profile())
        with self.assertRaisesRegex(ValueError, "has 3 samples a pixel, which is not RGBA"):
            lp.correct(picture(np.uint8), profile(), layout=lp.Layout.RGBA)

    def test_read_only(self):
        array = picture(np.uint8)
        array.flags.writeable = False
        before = array.copy()
        with self.assertRaisesRegex(ValueError, "read-only"):
            lp.correct(array, profile(), out=array)
        np.testing.assert_array_equal(array, before)
        np.testing.assert_array_equal(lp.correct(read_only(before), profile()), lp.correct(before, profile()))

    def check_unchanged(self, status, source, out, call):
        before = source.copy(), out.copy()
        with refused(self, status):
            call()
        np.testing.assert_array_equal(source, before[0])
        np.testing.assert_array_equal(out, before[1])

    def test_views_that_do_not_fit(self):
        plan, array = lp.Plan(options()), picture(np.uint8)
        for out, status in ((np.zeros((30, 39, 3), np.uint8), lp.Status.ERROR_SIZE),
                            (np.zeros((29, 40, 3), np.uint8), lp.Status.ERROR_SIZE),
                            (np.zeros((30, 40, 3), np.uint16), lp.Status.ERROR_ARGUMENT)):
            self.check_unchanged(status, array, out, lambda: plan.apply(array, out))
        for place in ({"x0": 1}, {"y0": 1}, {"x0": 2**32 - 1}):
            out = np.zeros_like(array)
            self.check_unchanged(lp.Status.ERROR_SIZE, array, out, lambda: plan.apply(array, out, **place))
        with self.assertRaises(ValueError):
            plan.apply(array, x0=-1)

    def test_overlapping_views(self):
        plan, parent = lp.Plan(options()), picture(np.uint8, (40, 40, 3))
        for out in (parent[1:31], parent[29::-1]):
            self.check_unchanged(lp.Status.ERROR_ARGUMENT, parent, parent, lambda: plan.apply(parent[:30], out))

    def test_rows_on_top_of_each_other(self):
        rows = np.broadcast_to(picture(np.uint8, (1, 40, 3)), (30, 40, 3))
        with refused(self, lp.Status.ERROR_SIZE):
            lp.correct(rows, profile())

    def test_unaligned_and_empty(self):
        raw = np.zeros(30 * 40 * 2 + 1, dtype=np.uint8)
        with refused(self, lp.Status.ERROR_ARGUMENT):
            lp.correct(raw[1:].view(np.uint16).reshape(30, 40), profile())
        with refused(self, lp.Status.ERROR_SIZE):
            lp.correct(np.zeros((0, 40), np.uint8), profile())

    def test_options(self):
        three = [lp.Vignetting(center=(x, 0)) for x in (0, 0.1, 0)]
        for fields, status in (({"frame_width": 0}, lp.Status.ERROR_SIZE),
                               ({"vignetting": lp.Vignetting(k=(-3, 0, 0))}, lp.Status.ERROR_VIGNETTING),
                               ({"vignetting": three}, lp.Status.ERROR_VIGNETTING),
                               ({"source": lp.Exposure(ev=100)}, lp.Status.ERROR_EXPOSURE)):
            with refused(self, status):
                lp.Plan(options(**fields))
        with refused(self, lp.Status.ERROR_ARGUMENT):  # no response
            lp.Plan(lp.ApplyOptions(frame_width=1, frame_height=1))


if __name__ == "__main__":
    unittest.main()
