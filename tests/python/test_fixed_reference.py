"""Integer plans, applied by a second program that knows only the bytes of a plan (src/core/fixed_plan.h): every sample is
the same."""
import struct
import types
import unittest

import numpy as np

import lensprof as lp

HEAD = struct.Struct("<5I 4B 4B 4B 2B 2B 2B 2B 2i 2I 9i i 3i 6i i 3I 5I 4I 4I")
LOG, PLACE, SAMPLE, EXPONENT = 22, 21, 14, 26  # binary places
NONE = -(1 << 30)
LOGS = np.round(2.0**LOG * np.log2(1 + np.arange(257) / 256)).astype(np.int64)
POWERS = np.round(2.0**30 * 2 ** (np.arange(257) / 256)).astype(np.int64)


def log2(v):
    """Of integers above 0."""
    top = np.frexp(v)[1].astype(np.int64) - 1
    mantissa = (v << 31 - top) & (1 << 31) - 1
    i, part = mantissa >> 23, mantissa >> 7 & 0xffff
    rise = LOGS[i + 1] - LOGS[i]
    return (top << LOG) + LOGS[i] + (rise * part >> 16) + ((rise * rise >> 16) * (part * (65535 - part) >> 16) * 11 >> 27)


def times_power(number, gain, largest):
    """number 2^gain, to nearest."""
    whole, part = gain >> LOG, gain & (1 << LOG) - 1
    i, rest = part >> 14, part & 0x3fff
    power = POWERS[i] + ((POWERS[i + 1] - POWERS[i] >> 5) * (rest - (rest * (16384 - rest) * 44 >> 29)) >> 9)
    exact = [min((int(n) * int(p) + (1 << 29 - w) if w < 30 else 0) >> 30 - w, largest) if -33 <= w <= 25 else
             largest if w > 0 and n else 0 for n, p, w in zip(*np.broadcast_arrays(number, power, whole))]
    return np.array(exact, dtype=np.int64)


def raised(log, exponent):
    return np.clip(log * exponent + (1 << EXPONENT - 1) >> EXPONENT, NONE, -NONE)


class Reference:
    def __init__(self, data):
        h = HEAD.unpack_from(data)
        words = np.frombuffer(data, dtype="<i4", offset=HEAD.size).astype(np.int64)
        self.magic, self.bytes = struct.pack("<I", h[0]), h[1]
        self.channels_of = h[9:13]
        self.site = np.array(h[13:17]).reshape(2, 2)
        self.sample, self.samples, self.simulate, self.target = h[5], h[7], h[17], h[24]
        decode, encode, self.falloffs, self.levels = *h[19:22], h[23]
        self.center, (self.reach, self.shift) = h[25:27], h[27:29]
        self.k, self.least, self.factor = np.array(h[29:38]).reshape(3, 3), h[38], h[39:42]
        self.black_in, self.black_out, self.largest = h[42:45], h[45:48], h[48]
        columns, rows, channels, self.grid_shift, self.strength = h[52:57]
        self.nodes = words[len(words) - columns * rows * channels:].reshape(channels, rows, columns) if columns else None
        self.axes = h[57:61], h[61:65]
        curves = [types.SimpleNamespace(**dict(zip(("samples", "one", "log_one", "most", "exponent"), row)), words=words)
                  for row in words[:5 * (decode + encode)].reshape(-1, 5)]
        self.decode, self.encode = ([ends[c if count == 3 else 0] for c in range(3)] if count else None
                                    for ends, count in ((curves[:decode], decode), (curves[decode:], encode)))

    @staticmethod
    def place(axis, nodes, pixel):
        _, step, whole, per_whole = axis
        node = np.minimum(pixel * step // whole, nodes - 2)
        return node, (pixel * step - node * whole) * per_whole

    def with_grid(self, nodes, x, y, m):
        def between(a, b, part):
            return a + ((b - a) * part >> 31)

        (i, across), (j, down) = (self.place(axis, size, pixel)
                                  for axis, size, pixel in zip(self.axes, nodes.shape[::-1], (x, y)))
        attenuation = between(between(nodes[j, i], nodes[j, i + 1], across),
                              between(nodes[j + 1, i], nodes[j + 1, i + 1], across), down)
        one = 1 << self.shift
        return one + (((m * attenuation >> self.grid_shift) - one) * self.strength >> 30)

    def gain(self, channel, x, y):
        r2 = ((x << 10) - self.center[0]) ** 2 + ((y << 10) - self.center[1]) ** 2
        t = r2 << self.reach >> 32
        m = np.zeros_like(t)
        for k in self.k[channel if self.falloffs == 3 else 0][::-1]:
            m = (k + m) * t >> 31
        m += 1 << self.shift
        if self.nodes is not None:
            m = self.with_grid(self.nodes[channel if len(self.nodes) == 3 else 0], x, y, m)
        gain = self.factor[channel] - (log2(np.maximum(m, self.least)) - (self.shift << LOG))
        return -gain if self.simulate else gain

    def light(self, code, channel):
        curve = self.decode[channel]
        number = (code << 8) - self.black_in[channel]
        if curve.samples:
            f, b = curve.words[curve.samples:curve.samples + 1024], code << SAMPLE
            j = np.clip(np.searchsorted(f, b, side="left") - 1, 0, 1022)
            number = (j << PLACE) + (np.maximum(b - f[j], 0) << PLACE) // np.maximum(f[j + 1] - f[j], 1)
            number = np.where(b > f[-1], 1023 << PLACE, number)
        log = np.minimum(log2(np.maximum(number, 1)) - curve.log_one, curve.most)
        return np.where(number > 0, raised(log, curve.exponent), NONE)

    def code(self, light, channel):
        curve = self.encode[channel]
        number = times_power(curve.one, raised(light, curve.exponent), curve.one if curve.samples else 1 << 25)
        if not curve.samples:
            return number + self.black_out[channel]
        f = curve.words[curve.samples:curve.samples + 1024]
        j = np.maximum(number - 1, 0) >> PLACE
        return f[j] + ((f[j + 1] - f[j]) * (number - (j << PLACE)) >> PLACE) >> SAMPLE - 8

    def linear(self, code, channel, gain):
        light = (code << 8) - self.black_in[channel]
        size = times_power(np.abs(light), gain, 1 << 25)
        return np.where(light < 0, -size, size) + self.black_out[channel]

    def apply(self, picture):
        """Of (height, width, samples)."""
        out = np.zeros(picture.shape, dtype=(np.uint8, np.uint16)[self.target])
        y, x = np.mgrid[:picture.shape[0], :picture.shape[1]]
        for n in range(self.samples):
            of_site = self.site[y & 1, x & 1] if self.samples == 1 else np.full(x.shape, self.channels_of[n])
            for channel in range(3):
                at = of_site == channel
                code = picture[at][:, n].astype(np.int64) * (257 if self.sample < self.target else 1)
                gain = self.gain(channel, x[at], y[at])
                if self.decode:
                    number = self.code(self.light(code, channel) + gain, channel)
                elif self.levels:
                    number = self.linear(code, channel, gain)
                else:
                    number = times_power(code, gain, self.largest) << 8
                out[at, n] = np.clip(number + 128 >> 8, 0, self.largest)
        return out


RESPONSES = (lp.Response(), lp.Response.from_gamma(2.2), lp.Response.from_emor([0.3, -0.2]),
             lp.Response.from_table([0.0, 0.6, 0.85, 0.85, 0.95, 1.0]))


class FixedReference(unittest.TestCase):
    def check(self, random, source, target, layout):
        samples = {lp.Layout.RGGB: 1, lp.Layout.GREY: 1}.get(layout, 3)
        levels = lp.Levels(black=random.uniform(-0.02, 0.1, 3), white=random.uniform(0.6, 1.0))
        falloff = [lp.Vignetting(k=random.uniform(-0.1, 0.05, 3), center=(0.1, -0.2)) for _ in range(3)]
        fields = lp.ApplyOptions(
            frame_width=30, frame_height=20, source_sample=source, target_sample=target, source_layout=layout,
            response=[RESPONSES[i] for i in random.integers(0, 4, 3)], vignetting=falloff[:random.choice([1, 3])],
            output_response=[RESPONSES[random.integers(0, 4)]] if random.random() < 0.4 else None,
            input=int(random.choice([0, 0, 1])), output=int(random.choice([0, 0, 1])), direction=int(random.choice([0, 1])),
            levels=levels if random.random() < 0.5 else None, output_levels=levels if random.random() < 0.5 else None,
            source=lp.Exposure(ev=random.uniform(-1, 1), white_balance=(1.3, 1, 0.8)),
            saturated=lp.Saturated.AS_VALUE, strength=random.choice([1.0, 0.6]),
            grid=lp.GainGrid(random.uniform(0.6, 1.1, (random.choice([1, 3]), 4, 7))) if random.random() < 0.5 else None)
        plan = lp.FixedPlan(fields)
        reference = Reference(plan.data)
        self.assertEqual((reference.magic, reference.bytes), (b"LFX4", len(plan.data)))
        picture = random.integers(0, (256, 65536)[source], (20, 30, samples)).astype((np.uint8, np.uint16)[source])
        shape = picture.shape if samples > 1 else picture.shape[:2]
        np.testing.assert_array_equal(plan.apply(picture.reshape(shape)), reference.apply(picture).reshape(shape))

    def test_every_sample_is_the_same(self):
        random = np.random.default_rng(9)
        for source, target in ((1, 1), (1, 0), (0, 1)):
            for layout in (lp.Layout.RGGB, lp.Layout.GREY, lp.Layout.RGB, lp.Layout.BGR):
                for _ in range(4):
                    self.check(random, lp.SampleType(source), lp.SampleType(target), layout)


if __name__ == "__main__":
    unittest.main()
