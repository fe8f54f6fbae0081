"""Grids of gains for raw sensors against an exact reference in Python's own integers, which reads the plan's bytes."""
import random
import struct
import unittest

import numpy as np

import lensprof as lp

MOSAICS = ["G", "RGGB", "RGgB", "gBRG", "RRGGRRGGGGBBGGBB", "RRGGRRGGggBBggBB", "BGRGGIGIRGBGGIGI", "RWWB"]


def planes_of(mosaic):
    return sum(letter in mosaic for letter in "RGgBIW")


class Reference:
    """What a plan does to a sample, by the text of lensprof/sensor.h and the layout of core/sensor.h."""

    def __init__(self, data):
        words = struct.unpack_from("<5I", data)
        self.width, self.height = words[3:5]
        self.side, self.planes = data[20:22]
        self.shift = data[136:140]
        self.plane = data[24:40]
        self.columns, self.rows = struct.unpack_from("<2I", data, 40)
        self.axes = [struct.unpack_from("<4I", data, 48 + 16 * d) for d in range(2)]
        self.black_in = struct.unpack_from("<4i", data, 80)
        self.black_out = struct.unpack_from("<4i", data, 96)
        self.largest = struct.unpack_from("<4I", data, 112)
        self.nodes = struct.unpack_from(f"<{self.planes * self.rows * self.columns}I", data, 140)

    @staticmethod
    def place(axis, nodes, sample):
        first, step, whole, _ = axis
        position = first + sample * step
        node = min(position // whole, nodes - 2)
        return node, position - node * whole

    @staticmethod
    def between(a, b, part):
        return a + ((b - a) * part >> 31)

    def gain(self, plane, x, y):
        _, step, whole, per_whole = self.axes[0]
        row, rest = self.place(self.axes[1], self.rows, y)
        down = rest * self.axes[1][3]
        column, rest = self.place(self.axes[0], self.columns, x)
        first = plane * self.rows * self.columns + row * self.columns + column
        left, right = (self.between(self.nodes[i], self.nodes[i + self.columns], down) for i in (first, first + 1))
        stride = step * self.side
        rise = ((right - left) * (stride * per_whole) + (1 << 30)) >> 31
        return self.between(left, right, rest % stride * per_whole) + rest // stride * rise

    def sample(self, code, x, y):
        plane = self.plane[y % self.side * self.side + x % self.side]
        light = (code << 14) - self.black_in[plane]
        shift = self.shift[plane]
        result = light * self.gain(plane, x, y) + (self.black_out[plane] << shift) + (1 << (shift + 13))
        return min(max(result >> (shift + 14), 0), self.largest[plane])


def random_case(rng):
    mosaic = rng.choice(MOSAICS)
    options = lp.ApplyOptions(
        frame_width=rng.randrange(400, 4000), frame_height=rng.randrange(400, 3000),
        response=lp.Response(), vignetting=lp.Vignetting(k=[rng.uniform(-0.5, 0.1), rng.uniform(-0.2, 0.1), 0.05]),
        source=lp.Exposure(ev=rng.uniform(-1, 1)))
    readout = lp.Readout(x=rng.randrange(16), y=rng.randrange(16), step=rng.choice([1, 1, 2, 3]), flip=rng.randrange(4))
    readout.set_mosaic(mosaic)
    shape = (planes_of(mosaic), rng.randrange(5, 34), rng.randrange(5, 34))
    if rng.random() < 0.5:
        readout.gains = np.array([rng.uniform(0.5, 3.0) for _ in range(np.prod(shape))]).reshape(shape)
    else:
        readout.rows, readout.columns = shape[1:]
    if rng.random() < 0.8:
        white = (1 << rng.choice([10, 12, 14, 16])) - 1
        black = [rng.uniform(-10, white / 6) for _ in range(4)]
        readout.levels = lp.SensorLevels(black=black, white=white)
        if rng.random() < 0.3:
            readout.output_levels = lp.SensorLevels(black=[0] * 4, white=65535)
    return options, readout


class SensorTest(unittest.TestCase):
    def test_samples_are_those_of_exact_arithmetic(self):
        rng = random.Random(7)
        for _ in range(60):
            options, readout = random_case(rng)
            plan = lp.SensorPlan(options, readout)
            reference = Reference(plan.data)
            width, rows = 40, 5
            x0, y0 = rng.randrange(reference.width - width + 1), rng.randrange(reference.height - rows + 1)
            codes = np.array([rng.randrange(65536 if rng.random() < 0.3 else 4096) for _ in range(width * rows)],
                             dtype=np.uint16).reshape(rows, width)
            wanted = [[reference.sample(int(codes[y, x]), x0 + x, y0 + y) for x in range(width)] for y in range(rows)]
            np.testing.assert_array_equal(plan.apply(codes, x0=x0, y0=y0), wanted)

    def test_packed_rows_and_bytes_in_flash(self):
        rng = random.Random(9)
        options, readout = random_case(rng)
        plan = lp.SensorPlan.open(lp.SensorPlan(options, readout).data)
        codes = np.array([[rng.randrange(1024) for _ in range(64)] for _ in range(2)], dtype=np.uint16)
        wanted = lp.pack_rows(np.minimum(plan.apply(codes, y0=3), 1023), lp.Packing.RAW10)
        np.testing.assert_array_equal(plan.apply_packed(lp.pack_rows(codes, lp.Packing.RAW10), lp.Packing.RAW10, 64, y0=3),
                                      wanted)
        damaged = bytearray(plan.data)
        damaged[60] ^= 1
        for data, status in ((damaged, lp.Status.ERROR_CORRUPT), (plan.data[:-4], lp.Status.ERROR_CAPACITY)):
            with self.assertRaises(lp.Error) as raised:
                lp.SensorPlan.open(bytes(data))
            self.assertEqual(raised.exception.status, status)

    def test_two_temperatures(self):
        options = lp.ApplyOptions(frame_width=640, frame_height=480, response=lp.Response(),
                                  vignetting=lp.Vignetting())
        plans = []
        for gain in (1.25, 1.75):
            readout = lp.Readout(gains=np.full((3, 5, 7), gain))
            readout.set_mosaic("RGGB")
            plans.append(lp.SensorPlan(options, readout))
        share = lp.mired_share(2850, 6500, 4000)
        self.assertAlmostEqual(share / 65536, (1 / 2850 - 1 / 4000) / (1 / 2850 - 1 / 6500), delta=1e-4)
        mixed = lp.SensorPlan.mix(plans[0], plans[1], share)
        row = mixed.apply(np.full((1, 640), 10000, dtype=np.uint16))
        np.testing.assert_allclose(row, 10000 * (1.25 + 0.5 * share / 65536), atol=1)
        with self.assertRaises(lp.Error):
            lp.SensorPlan.mix(plans[0], plans[1], 70000)

    def test_flat_field_of_a_device(self):
        readout = lp.Readout(columns=9, rows=7, levels=lp.SensorLevels(black=[64] * 4, white=1023))
        readout.set_mosaic("GRBG")
        y, x = np.mgrid[0:240, 0:320]
        light = 64 + 800 * (1 - 0.4 * x / 319) * (1 - 0.2 * y / 239)
        picture = np.round(light).astype(np.uint16)
        flat = lp.SensorFlat(320, 240, readout)
        for row in range(240):
            flat.add(picture[row:row + 1], y0=row)
        gains = lp.SensorFlat.open(flat.data).gains()
        self.assertEqual(gains.shape, (3, 7, 9))
        wanted = 1 / ((1 - 0.4 * np.linspace(0, 1, 9)) * (1 - 0.2 * np.linspace(0, 1, 7)[:, None]))
        np.testing.assert_allclose(gains, np.broadcast_to(wanted, gains.shape), rtol=2e-3)
        flat.add(picture[:1])
        with self.assertRaisesRegex(lp.Error, "missing"):
            flat.gains()

    def test_what_is_refused(self):
        options = lp.ApplyOptions(frame_width=640, frame_height=480, response=lp.Response(),
                                  vignetting=lp.Vignetting())
        readout = lp.Readout()
        with self.assertRaises(lp.Error):
            readout.set_mosaic("RGB")
        with self.assertRaises(ValueError):
            readout.gains = np.ones((3, 4))
        readout.gains = np.ones((2, 5, 5))
        with self.assertRaises(ValueError):  # one plane
            lp.SensorPlan(options, readout)
        readout.gains = np.zeros((1, 5, 5))
        with self.assertRaisesRegex(lp.Error, "gains"):
            lp.SensorPlan(options, readout)
        plan = lp.SensorPlan(options, lp.Readout())
        with self.assertRaises(lp.Error):
            plan.apply(np.zeros((1, 640), dtype=np.uint8))
        with self.assertRaises(lp.Error):
            plan.apply(np.zeros((1, 640), dtype=np.uint16), x0=1)
        self.assertLess(plan.error(options, lp.Readout()), 1e-6)


if __name__ == "__main__":
    unittest.main()
