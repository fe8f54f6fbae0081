#!/usr/bin/env python3
"""The scorer itself: truth scores zero, the ambiguity of response and exposure is taken out and nothing else is."""
import pathlib
import sys
import tempfile
import unittest

import numpy as np

import cases
import lensfun_rule
import real
import report
import scorer
import tools

SIZES = np.array([[800, 600]] * 5)
SRGB = np.array([12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055 for x in np.linspace(0, 1, 1024)])


class Powered(scorer.Model):
    """A model moved along the ambiguity: everything to the power of `power`."""
    power = 1.0

    def falloff(self, r2):
        return super().falloff(r2) ** self.power


def camera(power=1.0, kind=Powered):
    rng = np.random.default_rng(7)
    balance = np.stack([rng.uniform(0.85, 1.15, 5), np.ones(5), rng.uniform(0.85, 1.15, 5)], axis=1)
    balance[0] = 1.0
    model = kind(power * rng.uniform(-1, 1, 5), balance ** power, np.array([[-0.3, 0.05, -0.15]]),
                 np.array([0.02, -0.015]), scorer.Curve(SRGB, np.linspace(0, 1, 1024) ** power))
    model.power = power
    return model


def scene_pairs(model, count=400):
    """Pairs of a made-up scene by the image formation itself, one number at a time: independent of scorer.transfer."""
    rng = np.random.default_rng(8)
    image, xy, value = [], [], []
    while len(image) < count:
        ends, points, light = rng.permutation(5)[:2], rng.uniform(0, 600, (2, 2)), rng.uniform(0.02, 0.5, 3)
        grey = np.zeros((2, 3))
        for side in range(2):
            x, y = points[side] - [799 / 2, 599 / 2] - 500 * model.center
            r2 = (x * x + y * y) / 500.0 ** 2
            m = 1 + model.k[0][0] * r2 + model.k[0][1] * r2 ** 2 + model.k[0][2] * r2 ** 3
            for c in range(3):
                exposure = 2 ** model.ev[ends[side]] * model.white_balance[ends[side], c]
                grey[side, c] = np.interp(light[c] * m * exposure, np.linspace(0, 1, 1024), SRGB)
        if grey.max() < 250 / 255:
            image.append(ends), xy.append(points), value.append(grey)
    return scorer.Pairs(np.array(image), np.array(xy), np.array(value))


class Scorer(unittest.TestCase):
    def setUp(self):
        self.truth = camera()
        self.pairs = scene_pairs(self.truth)

    def score(self, model):
        return scorer.score(self.truth, model, self.pairs, SIZES)

    def test_truth_scores_zero(self):
        result = self.score(camera())
        self.assertAlmostEqual(result["exponent"], 1.0, 12)
        for name in scorer.METRICS:
            self.assertLess(result[name], 0.02 if name.startswith("response") else 1e-9, name)
        self.assertFalse(result["failed"])

    def test_ambiguity_is_seen_raw_and_gone_aligned(self):
        for power in (0.7, 1.3):
            result = self.score(camera(power))
            self.assertAlmostEqual(result["exponent"], power, 9)
            for name, least in (("ev", 0.05), ("wb", 0.01), ("falloff", 0.03), ("response", 3.0)):
                self.assertGreater(result[name + "_raw"], least, name)
                self.assertLess(result[name + "_aligned"], 0.05 if name == "response" else 1e-9, name)
            self.assertLess(result["clean_rms"], 1e-3)  # of interpolating the moved curve

    def test_exponent_comes_from_the_response_when_exposures_do_not_vary(self):
        self.truth.ev[:] = 0.3
        found = camera(1.3)
        found.ev[:] = 0.39
        self.assertAlmostEqual(scorer.gauge_exponent(self.truth, found), 1.3, 3)

    def test_known_disturbance_is_measured_as_such(self):
        found = camera()
        found.ev = found.ev + np.array([0.0, 0.1, 0.0, 0.0, 0.0])
        self.assertAlmostEqual(self.score(found)["ev_raw"], 0.1 / np.sqrt(5), 12)
        found = camera()
        found.ev[0] += 0.1  # the reference: aligned, only one image of five is off
        self.assertAlmostEqual(self.score(found)["ev_raw"], 0.1 * np.sqrt(4 / 5), 12)
        self.assertLess(self.score(found)["ev_aligned"], 0.045)  # 0.04 by itself
        found = camera()
        found.k = found.k + np.array([[0.0, 0.0, 0.02]])
        self.assertAlmostEqual(self.score(found)["falloff_raw"], 0.02, 12)
        found = camera()
        found.white_balance[2, 0] *= 2.0
        self.assertAlmostEqual(self.score(found)["wb_raw"], 1.0 / np.sqrt(10), 12)
        found = camera()
        found.center = found.center + np.array([0.03, 0.04])
        self.assertAlmostEqual(self.score(found)["center"], 0.05, 12)

    def test_spread_of_exposures(self):
        truth, found = camera(), camera()
        truth.ev[:] = 0.0
        found.ev = np.array([0.0, 0.03, -0.02, 0.01, 0.0])
        self.assertAlmostEqual(scorer.score(truth, found, self.pairs, SIZES)["ev_spread"], 0.05)

    def test_useless_result_is_a_failure(self):
        result = self.score(scorer.identity(5))
        self.assertTrue(result["failed"])
        difference = 255 * (self.pairs.value[:, 0] - self.pairs.value[:, 1])
        self.assertAlmostEqual(result["clean_rms"], np.sqrt(np.mean(difference ** 2)), 9)

    def test_falloff_of_every_channel(self):
        k = np.array([[-0.1, 0, 0], [-0.2, 0, 0], [-0.3, 0, 0]])
        model = scorer.Model(np.zeros(1), np.ones((1, 3)), k, np.zeros(2), None)
        np.testing.assert_allclose(model.falloff([0.0, 0.5]), [[1, 1, 1], [0.95, 0.9, 0.85]])

    def test_gamma_curve_is_exact(self):
        curve, x = scorer.Gamma(2.2), np.array([0.0, 1e-5, 0.3, 1.0])
        np.testing.assert_allclose(curve.f(x), x ** (1 / 2.2))
        np.testing.assert_allclose(curve.g(curve.f(x)), x, atol=1e-15)


PTO = """p f2 w3000 h1500 v360
i w400 h300 f0 v50 Ra=1 Rb0 Rc0 Rd0 Re0 Eev-1.5e-1 Er1.1 Eb0.9 r0 p0 y0 Va1 Vb-0.25 Vc0 Vd0 Vx25 Vy-50 n"a r9 Eev7.jpg"
#-hugin  cropFactor=1
i w400 h300 f0 v=0 Ra0.5 Rb=0 Rc=0 Rd=0 Re=0 Eev0.25 Er1 Eb1 r0 p0 y9 Va=0 Vb=0 Vc=0 Vd=0 Vx=0 Vy=0 n"b.jpg"
i w400 h300 f0 v=1 Ra=0 Rb=1 Rc=0 Rd=0 Re=0 Eev=1 Er=0 Eb1 r0 p0 y18 Va=0 Vb=1 Vc=0 Vd=0 Vx=0 Vy=0 n"c.jpg"
v Ra0
"""


class Files(unittest.TestCase):
    def test_pto_links(self):
        lines = tools.parse_pto(PTO)
        self.assertEqual([i["Ra"] for i in lines], [0.5, 0.5, 0.5])  # forward, own, chain
        self.assertEqual([i["Vb"] for i in lines], [-0.25] * 3)
        self.assertEqual([i["Eev"] for i in lines], [-0.15, 0.25, 0.25])
        self.assertEqual([i["v"] for i in lines], [50.0] * 3)
        self.assertEqual(lines[0]["r"], 0.0)  # not the file's name

    def test_pairs_drawn(self):
        text = "extracting good points\nSelected 181 points\nVignetting Optimization\nIteration: 0, error: 14.76\n"
        self.assertEqual(tools.pairs_drawn(text), {"pairs": 181})
        self.assertEqual(tools.pairs_drawn("Vignetting Optimization\nIteration: 0, error: 14.76\n"), {})

    def test_pto_links_in_a_circle(self):
        with self.assertRaises(ValueError):
            tools.parse_pto('i w4 h3 Ra=1 n"a"\ni w4 h3 Ra=0 n"b"\n')

    def test_pto_as_a_model(self):
        model = tools.model_of_pto(PTO)
        np.testing.assert_allclose(model.ev, [0.15, -0.25, -0.25])
        np.testing.assert_allclose(model.white_balance, [[1.1, 1, 0.9], [1, 1, 1], [1.1, 1, 1]])
        np.testing.assert_allclose(model.center, [0.1, -0.2])
        table = tools.emor_table()
        np.testing.assert_allclose(model.curve.f(np.linspace(0, 1, 1024)), table[0] + 0.5 * table[1], atol=1e-12)
        self.assertTrue(model.monotone)
        self.assertFalse(tools.model_of_pto(PTO.replace("Ra0.5", "Ra-9")).monotone)

    def test_point_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "points.txt")
            path.write_text("3 1 10 20 30 40 0.1 0.2 0.3 0.4 0.5 0.6 0 0.7 0.8 0\n")
            pairs = scorer.read_points(path)
        self.assertEqual((pairs.image.tolist(), pairs.xy.tolist()), ([[3, 1]], [[[10, 20], [30, 40]]]))
        self.assertEqual(pairs.value.tolist(), [[[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]]])

    def test_points_out_of_range_are_left_out(self):
        line = "0 1 10 20 30 40 0.1 0.2 0.3 0.4 0.5 %s 0 0.7 0.8 0\n"
        kept = [line % "0", line % "1"]
        self.assertEqual(real.in_range(kept[0] + line % "-0.0004" + kept[1] + line % "1.001"), "".join(kept))

    def test_usage_of_a_process(self):
        with tempfile.TemporaryDirectory() as folder:
            code = "x = bytearray(64 << 20); print(3)"
            used = tools.measured([sys.executable, "-S", "-c", code], folder, folder + "/log")
        self.assertEqual((used["code"], used["out"]), (0, "3\n"))
        self.assertTrue(64 < used["peak_mb"] < 200)
        self.assertTrue(0 < used["cpu_s"] < used["wall_s"] + 1)


class Tables(unittest.TestCase):
    def test_runs_without_result_count(self):
        self.assertEqual(report.median([{"x": 1.0}, {"x": 2.0}, {}], "x"), 2.0)
        self.assertEqual(report.median([{"x": 1.0}, {"x": None}], "x"), 1.0)
        self.assertEqual(report.number(report.median([{}], "x")), "–")

    def test_wins(self):
        ours = [{"case": "a", "clean_rms": 1.0}, {"case": "b", "clean_rms": 3.0}, {"case": "c"}]
        theirs = [{"case": "a"}, {"case": "b", "clean_rms": 2.0}, {"case": "c", "clean_rms": 9.0}]
        self.assertEqual((report.wins(ours, theirs), report.wins(theirs, ours), report.wins(ours, None)),
                         ("1 of 3", "2 of 3", "–"))

    def test_targets(self):
        group, _, limit = cases.TARGETS[0]
        runs = [{"tool": "lensprof", "groups": [group], "ev_aligned": limit * f} for f in (0.5, 1.0, 3.0)]
        rows = report.targets(runs + [{"tool": "lensprof", "groups": [group]}])  # the last has no result
        self.assertEqual(rows[-2], "| %s | exposure | 0.0100 | 0.0200 | – | 2 of 4 | – | 0 |" % group)
        self.assertEqual(report.targets([{"tool": "lensprof", "groups": ["sRGB"]}]), [])

    def test_numbers(self):
        self.assertEqual([report.number(v) for v in (0.00123, 0.0123, 1.234, 12.34, 1234.5)],
                         ["0.0012", "0.0123", "1.23", "12.3", "1234"])  # half to even

    def test_misplaced_image(self):
        image = np.array([[0, 1]] * 20 + [[1, 2]] * 12 + [[0, 1]] * 8)
        pairs = scorer.Pairs(image, np.zeros((40, 2, 2)), np.zeros((40, 2, 3)))
        residual = np.ones((40, 2, 3))
        residual[20:32] = -30.0
        bad, images = real.disagreeing(pairs, [residual, residual])
        self.assertEqual((bad.sum(), images), (12, [2]))
        self.assertEqual(real.disagreeing(pairs, [residual, np.ones((40, 2, 3))])[1], [])
        self.assertAlmostEqual(real.figures(residual)["clipped_rms"], np.sqrt((28 + 12 * 400) / 40))


class LensfunRule(unittest.TestCase):
    """The peer of lookup.py, against weights by hand."""
    KNOWN = [(20.0, 4.0, np.inf), (40.0, 4.0, 1000.0), (40.0, 2.0, 0.5)]
    K = [(-0.8, 0.1, 0.0), (-0.4, 0.3, 0.2), (-1.6, 0.5, 0.4)]

    def test_a_calibration_is_the_answer(self):
        self.assertEqual(tuple(lensfun_rule.predict(self.KNOWN, self.K, (20.0, 4.0, 1000.0), 20.0)), self.K[0])

    def test_weights(self):
        at = lensfun_rule.predict(self.KNOWN, self.K, (25.0, 4.0, 1000.0), 20.0)  # distances: 1/4, 3/4, and by hand
        third = ((15 / 20) ** 2 + (2.0 - 1.0) ** 2 + (0.1 / 0.5 - 0.1 / 1000) ** 2) ** 0.5
        weights = [0.25 ** -3.5, 0.75 ** -3.5, third ** -3.5]
        mean = [sum(w * k[i] for w, k in zip(weights, self.K)) / sum(weights) for i in range(3)]
        np.testing.assert_allclose(at, mean)

    def test_refusal(self):
        self.assertIsNone(lensfun_rule.predict(self.KNOWN, self.K, (61.0, 4.0, 1000.0), 20.0))
        self.assertIsNotNone(lensfun_rule.predict(self.KNOWN, self.K, (60.0, 4.0, 1000.0), 20.0))
        self.assertIsNotNone(lensfun_rule.predict([(50.0, 2.0, 1.0)], [self.K[0]], (50.0, 4.0, 1.0), 0.0))


if __name__ == "__main__":
    unittest.main()
