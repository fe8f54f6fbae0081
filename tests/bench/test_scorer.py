#!/usr/bin/env python3
"""Tests of the scorer: truth scores zero, and only the ambiguity between response and exposure is removed."""
import json
import math
import pathlib
import random
import re
import sqlite3
import sys
import tempfile
import unittest

import numpy as np

import cases
import colmap
import colours
import drone
import flat
import gallery
import lensfun_rule
import real
import report
import scorer
import seams
import tools
import trial_tables
import trials
import card_tables
import cards
import limit_curves
import verdict_tables
import verdicts

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
    """Pairs of a synthetic scene from the image formation, one number at a time, independent of scorer.transfer."""
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
            self.assertLess(result["clean_rms"], 1e-3)  # error of interpolating the moved curve

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
        self.assertEqual(lines[0]["r"], 0.0)  # not from the file's name

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

    def test_an_image_that_joins_no_other(self):
        """Its numbers are null; it counts as uncorrected, and is named."""
        image = {"ev": 0.5, "white_balance": [1.1, 1.0, 0.9]}
        alone = [{"ev": None, "white_balance": w, "joined": False} for w in (None, [None] * 3)]
        data = {"usable": False, "equalizes": True, "reason": "r", "reason_code": "c", "pairs": 7, "seconds": {"solve": 1.0},
                "residual": {"before_rms": 9.0, "heldout_rms": None}, "images": [dict(image, joined=True), *alone],
                "links": [{"images": [0, 1], "pairs": 3, "verified": False}, {"images": [0, 2], "pairs": 4, "verified": True}],
                "vignetting": {"k": [[-0.3, 0, 0]], "center": [0, 0]}}
        model, used = scorer.model_of_json(data, None), tools.of_json(data)
        self.assertEqual(model.ev.tolist(), [0.5, 0.0, 0.0])
        self.assertEqual(model.white_balance.tolist(), [[1.1, 1.0, 0.9], [1.0] * 3, [1.0] * 3])
        self.assertEqual((used["left_out"], used["unverified"], used["equalizes"]), ([1, 2], [[0, 1]], True))
        data["images"] = [image]  # output of older programs
        del data["equalizes"], data["links"]
        used = tools.of_json(json.loads(json.dumps(data)))
        self.assertEqual((used["left_out"], used["unverified"], used["equalizes"]), ([], [], None))

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


@unittest.skipUnless(tools.OPENCV, tools.NO_OPENCV)
class Seams(unittest.TestCase):
    """Two pictures of a synthetic wall, the second rotated, shifted and with half the exposure."""
    SIZES = np.array([[420, 320]] * 2)
    EV = -1.0

    @classmethod
    def setUpClass(cls):
        import cv2
        random, wall = np.random.default_rng(5), np.zeros((320, 600, 3))
        for blur, share in ((1.5, 0.35), (5.0, 0.3), (20.0, 0.35)):
            layer = cv2.GaussianBlur(random.uniform(size=wall.shape), (0, 0), blur)
            wall += share * (layer - layer.min()) / np.ptp(layer)
        cls.turn = cv2.getRotationMatrix2D((210, 160), 4.0, 1.0) + [[0, 0, -70], [0, 0, 6]]
        light = [wall[:, :420], 2.0 ** cls.EV * cv2.warpAffine(wall, cls.turn, (420, 320), flags=cv2.INTER_CUBIC)]
        with tempfile.TemporaryDirectory() as folder:
            files = [folder + "/%d.png" % n for n in range(2)]
            for file, part in zip(files, light):
                cv2.imwrite(file, np.clip(np.rint(255 * part), 0, 255).astype(np.uint8))
            cls.pairs = seams.seam_pairs(files)
            cls.twin = seams.seam_pairs([files[0], files[0]])

    def seam(self, ev):
        model = scorer.identity(2)
        model.ev[1] = ev
        return seams.seams(model, self.pairs, self.SIZES)[(0, 1)]

    def test_the_true_gain_leaves_no_seam_and_others_do(self):
        self.assertGreater(self.seam(0.0), 30.0)
        self.assertLess(self.seam(self.EV), 1.0)
        self.assertGreater(self.seam(self.EV + 0.1), 3.0)

    def test_places_are_the_same_point_of_the_wall(self):
        there = self.pairs.xy[:, 0] @ self.turn[:, :2].T + self.turn[:, 2]
        self.assertGreater(len(there), 200)
        self.assertLess(np.median(np.hypot(*(there - self.pairs.xy[:, 1]).T)), 0.3)

    def test_a_picture_beside_itself(self):
        self.assertEqual(seams.seams(scorer.identity(2), self.twin, self.SIZES), {(0, 1): 0.0})


class Verdicts(unittest.TestCase):
    def test_drawing_repeats_and_tuning_has_other_seeds(self):
        def drawn(tune):
            return {s.name: s.arguments for s in verdicts.sequences(False, tune)}

        report_on, tune = drawn(False), drawn(True)
        self.assertEqual(report_on, drawn(False))
        self.assertEqual(len(report_on), 2 * 100 + 4 * 50 + 7 * 45)
        self.assertEqual(report_on.keys(), tune.keys())
        self.assertFalse([name for name in tune if tune[name] == report_on[name]])
        quick = {s.name: s.arguments for s in verdicts.sequences(True, False)}
        self.assertEqual(quick, {name: report_on[name] for name in quick})  # the quick cases are a subset

    def test_misplaced_pictures_change_places(self):
        lines = "".join('i w%d h3 n"img%03d.png"\n' % (n, n) for n in range(5))
        for seed in range(20):
            with tempfile.TemporaryDirectory() as folder:
                file = pathlib.Path(folder, "pano.pto")
                file.write_text(lines)
                verdicts.spoil("misplaced", pathlib.Path(folder), random.Random(seed))
                text = file.read_text()
            names = re.findall(r'n"img(\d+).png"', text)
            self.assertEqual(sorted(map(int, names)), list(range(5)))
            self.assertEqual(names, sorted(names, reverse=True))
            self.assertEqual(re.sub('n".*"', "", text), re.sub('n".*"', "", lines))  # everything else stays

    def test_errors_over_stated_errors(self):
        """Image 1 is the reference, image 2 is not joined, image 3 is held."""
        truth = scorer.identity(5)
        truth.ev, truth.k = np.array([0.5, 1.0, 7.0, 0.0, -1.0]), np.array([[-0.3, 0.0, 0.0]])
        images = [{"ev": ev, "ev_sigma": sigma} for ev, sigma in ((-0.4, 0.2), (0, 0), (None, None), (9, 0), (-2.3, 0.1))]
        block = np.diag([5.0, 5.0, 1e-4, 1e-4, 1e-4, 5.0, 5.0])  # two EMoR coefficients, k, the centre
        block[2, 3] = block[3, 2] = 5e-5
        data = {"images": images, "reference": 1, "covariance": block.tolist(),
                "vignetting": {"k": [[-0.25, 0.0, -0.01]], "center": [0, 0]}}
        z = verdicts.standardised(data, truth)
        np.testing.assert_allclose(z["ev"], [0.5, -3.0])
        np.testing.assert_allclose(z["corner"], [0.04 / 0.02])
        self.assertEqual(verdicts.standardised(dict(data, covariance=[]), truth)["corner"], [])

    def test_what_is_applied(self):
        """Image 2 is not joined; older programs do not name a model."""
        truth, model = scorer.identity(4), scorer.identity(4)
        truth.k, model.k = np.array([[-0.3, 0.0, 0.0]]), np.array([[-0.1, -0.1, 0.05]])
        model.ev = np.array([0.0, 0.3, 7.0, -0.3])
        images = [{"ev": 0.0}, {"ev": 0.3}, {"ev": 7.0, "joined": False}, {"ev": -0.3}]
        found = verdicts.applied({"usable": False, "equalizes": True, "model": "exposures", "images": images}, truth, model)
        self.assertEqual(found["applied"], "exposures")
        np.testing.assert_allclose([found[key] for key in ("corner", "corner_error", "ev_range", "ev_deviation")],
                                   [0.85, 0.15, 0.6, math.sqrt(0.06)])
        for usable, expected in ((True, "full"), (False, "nothing")):
            old = verdicts.applied({"usable": usable, "images": images}, truth, model)
            self.assertEqual(old["applied"], expected)

    def test_table_of_what_is_open(self):
        record = {"kind": "sky", "z": {"corner": [0.5]}, "ev_range": 0.1, "ev_deviation": 0.05, "worse": False}
        full = [dict(record, applied="full", corner_error=e) for e in (0.02, 0.04, 0.9)]
        other = [dict(record, applied="exposures", corner_error=3.0, worse=True), {"kind": "sky", "failed": True}]
        lines = verdict_tables.open_table(full + other)
        cells = [cell.strip() for cell in lines[-2].split("|")[1:-1]]
        self.assertEqual(cells[:8], ["sky", "5", "3", "0", "1", "1", "0.0400", "0.900"])
        self.assertIn("100 % of 3", cells[8])
        self.assertEqual(cells[9:], ["0.100", "0.100", "0.0500", "0.0500", "1 (at most 0; **not met**)"])
        self.assertEqual(len(lines[-3].split("|")), len(lines[-1].split("|")))
        self.assertEqual(verdict_tables.open_table([dict(record, kind="smooth")]), [])

    def test_what_is_missed(self):
        def missed(kind, usable, reason="", failed=False):
            return verdicts.is_missed({"kind": kind, "usable": usable, "reason": reason, "failed": failed})

        self.assertEqual([missed("hard", False), missed("hard", True, failed=True), missed("hard", True, "careful")],
                         ["refused", "failed", None])
        self.assertEqual([missed("noise", True), missed("noise", True, "careful"), missed("noise", False, "no")],
                         ["accepted", None, None])


class Trials(unittest.TestCase):
    def test_drawing_repeats_and_tuning_has_other_seeds(self):
        def drawn(quick, tune):
            return {one.name: str(one) for one in trials.trials(quick, tune)}

        report_on, tune, quick = drawn(False, False), drawn(False, True), drawn(True, False)
        self.assertEqual(report_on, drawn(False, False))
        self.assertEqual(len(report_on), 4 * trials.COUNT)
        self.assertFalse([name for name in tune if tune[name] == report_on[name]])
        self.assertEqual(quick, {name: report_on[name] for name in quick})

    def test_what_candidates_leave(self):
        """The true one nothing; the others rise or fall to nearly OFF, whose corner is that of the frame's middle."""
        one = next(trials.trials(True, False))
        true, bright, dark = (trials.true_rings(one, 1.0, k) for k in trials.candidates(one, 1.0))
        np.testing.assert_allclose(true, 0.0, atol=1e-9)
        np.testing.assert_allclose(bright, -dark, atol=0.01)
        self.assertTrue((np.diff(bright) > 0.0).all() and 0.5 * trials.OFF < bright[-1] < trials.OFF)
        self.assertTrue((np.diff(trials.true_rings(one, 1.0, [0.0] * 3)) < 0.0).all())

    def test_exponent_of_a_response(self):
        self.assertAlmostEqual(trials.exponent(scorer.Gamma(2.0), scorer.Gamma(2.2)), 1.1, 9)

    def test_table(self):
        def found(corners, ev, truth):
            return {"corners": corners, "ev": [0.0, ev], "truth": [0.0, truth, 2 * truth], "sigma": [0.0, 0.01], "z": [0.5]}

        record = {"kind": "exact", "number": 3, "refused": False, "candidates": {
            "true": found("agree", 0.01, 0.0), "too bright": found("too-dark", -0.1, 0.1),
            "too dark": found("not-shown", -0.1, -0.1), "none": found("too-dark", -0.3, -0.3)}}
        refused = {"kind": "exact", "number": 4, "refused": True, "candidates": {}}
        text = "\n".join(trial_tables.trials({"tune": True, "records": [record, refused]}))
        self.assertIn("| exact | 2 | 1 | 1 | 0 | 0 | 1 | 0 | 1 | 1 | 1 | 0.0100 |", text)
        self.assertIn("| 100 %, 100 %, 0.50 | – | – | – | 100 %, 100 %, 0.50 |", text)
        self.assertIn("| exact 3 | too bright | too-dark | +0.100 | -0.100 | 0.010 |", text)
        self.assertEqual(trial_tables.trials({}), [])


class Cards(unittest.TestCase):
    CARD = {"size": [480, 360], "k": [-0.3, 0.05, -0.15], "cosine": False, "center": [0.02, -0.01]}

    def test_drawing_repeats_and_tuning_has_other_seeds(self):
        def drawn(quick, tune):
            return {card["name"]: json.dumps(card) for card in cards.cards(quick, tune)}

        report_on, tune, quick = drawn(False, False), drawn(False, True), drawn(True, False)
        self.assertEqual(report_on, drawn(False, False))
        self.assertEqual(len(report_on), 7 * 50 + 12 * 20)
        self.assertEqual(report_on.keys(), tune.keys())
        self.assertFalse([name for name in tune if tune[name] == report_on[name]])
        self.assertEqual(quick, {name: report_on[name] for name in quick})

    def test_all_lists_have_one_entry_per_shot(self):
        for card in cards.cards(False, False):
            lengths = {len(card[key]) for key in ("turns", "stated_turns", "drift", "gradients")}
            self.assertEqual(lengths, {len(card["turns"])})

    def test_a_picture_repeats_and_shows_the_falloff(self):
        card = next(c for c in cards.cards(True, False) if c["kind"] == "even")
        card.update(self.CARD, texture=[0.0, 1.0], gradients=[[0.0, 0.0]] * len(card["turns"]))
        light = cards.card_light(card, 0)
        np.testing.assert_array_equal(light, cards.card_light(card, 0))
        x, y = (np.array([479.0, 359.0]) / 2.0) / 300.0
        self.assertAlmostEqual(light[-1, -1], flat.falloff(card["k"], (x - 0.02)**2 + (y + 0.01)**2), 9)

    def test_errors_of_a_falloff(self):
        def errors(k, center, grid=None):
            return cards.errors(self.CARD, {"vignetting": {"k": k, "center": center}, "gain_grid": grid})

        k, center = self.CARD["k"], self.CARD["center"]
        np.testing.assert_allclose(errors([k], center), [0.0, 0.0], atol=1e-12)
        np.testing.assert_allclose(errors([k, k, [-0.3, 0.05, -0.09]], center)[0], 0.1)  # M(1): .66 instead of .6
        radial, frame = errors([k], [0.0, 0.0])
        self.assertEqual(radial, 0.0)
        self.assertGreater(frame, 0.01)
        grid = {"columns": 4, "rows": 3, "attenuation": np.full((3, 3, 4), 1.05).tolist()}
        np.testing.assert_allclose(errors([k], center, grid), [0.0, 0.05], atol=1e-9)

    def test_a_grid_is_interpolated(self):
        nodes = np.add.outer(np.arange(3.0), 2.0 * np.arange(5.0))  # a plane stays one
        np.testing.assert_allclose(cards.between(nodes), np.add.outer(np.linspace(0, 2, cards.PLACES[1]),
                                                                      np.linspace(0, 8, cards.PLACES[0])), atol=1e-12)

    def test_corner(self):
        card = {**self.CARD, "center": [0.0, 0.0]}
        self.assertAlmostEqual(cards.true_corner(card, None), flat.falloff(card["k"], (479**2 + 359**2) / 600**2), 12)
        self.assertAlmostEqual(cards.true_corner(card, 0.7), flat.falloff(card["k"], 0.49), 12)

    def test_table(self):
        def record(kind, error, usable=True, reason="", found=()):
            return {"kind": kind, "number": 0, "name": kind + " 0", "usable": usable, "reason": reason, "error": error,
                    "frame_error": 2 * error, "z": 0.5, "passed": [], "corner": 0.5 + error, "true_corner": 0.5,
                    "seconds": 0.25, "findings": [{"code": code, "severity": "note", "limit": 0.0, "measured": 1.0}
                                                  for code in found]}

        records = [record("even", 0.001), record("even", 0.5, False, "no"), record("lamp", 0.005),
                   record("lamp", 0.3), record("lamp", 0.2, True, "careful"), record("lamp", 0.9, False, "no"),
                   record("lamp", 0.4, found=["flat_one_light"])]
        lines = card_tables.cards({"tune": False, "skipped": [], "records": records})
        cells = [[c.strip() for c in line.strip("|").split("|")] for line in lines if line.startswith("| lamp |")]
        self.assertEqual(cells, [["lamp", "5", "1", "4", "1", "0.50", "0.50", "0.250", "0.400", "0.500", "0.800", "2",
                                  "1", "", "0.25"]])
        self.assertEqual([line.split("|")[1:3] for line in lines[lines.index("Missed.") + 4:-1]],
                         [[" even 0 ", " refused "], [" lamp 0 ", " harm that nothing names "]])
        self.assertEqual(card_tables.cards({}), [])


class Gallery(unittest.TestCase):
    RECORD = {"joined": 3, "seams": {"lensprof": {"median": 2.4}, "hugin": {"median": 2.0}}}

    def unmet(self, expected, usable=True, equalizes=True, record=None):
        return gallery.unmet(gallery.Expected(**expected), {"usable": usable, "equalizes": equalizes}, record or self.RECORD)

    def test_expectations(self):
        everything = {"usable": True, "equalizes": True, "joined": 3, "seam": 2.4, "beside_hugin": 0.2}
        self.assertEqual(self.unmet(everything), [])
        self.assertEqual(self.unmet(everything, False, None), ["usable: no", "equalizes: not stated"])
        self.assertEqual(self.unmet({"joined": 4}), ["joined: 3"])
        self.assertEqual(self.unmet({"seam": 2.3}), ["seam: 2.40, above 2.30"])
        self.assertEqual(self.unmet({"beside_hugin": 0.1}), ["seam: 2.40, above 2.30"])
        self.assertEqual(self.unmet({"beside_hugin": 0.1, "unless_refused": True}, False), [])
        self.assertEqual(self.unmet({"seam": 3.0}, record={"joined": 3, "seams": {}}), ["seam: not measured"])

    def test_a_freed_copy(self):
        with tempfile.TemporaryDirectory() as folder:
            project, copy = pathlib.Path(folder, "pano.pto"), pathlib.Path(folder, "free.pto")
            project.write_text(PTO)
            gallery.freed(project, copy)
            text = copy.read_text()
            self.assertIn('n"%s/b.jpg"' % folder, text)
        asked = re.findall(r"^v (.*)$", text, re.M)
        self.assertEqual(asked[:10], "Ra0 Rb0 Rc0 Rd0 Re0 Vb0 Vc0 Vd0 Vx0 Vy0".split())
        self.assertEqual(asked[10:], ["Eev1", "Er1", "Eb1", "Eev2", "Er2", "Eb2"])
        self.assertEqual(tools.parse_pto(text), tools.parse_pto(PTO))


class LensfunRule(unittest.TestCase):
    """The peer of lookup.py, compared with weights computed by hand."""
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


class Colours(unittest.TestCase):
    """On pairs of a known camera, the true exposures leave no difference, and gains and offsets are found."""

    def exposures(self, model, folder):
        path = pathlib.Path(folder, "exposures.json")
        images = [{"name": "%d.jpg" % n, "width": 800, "height": 600, "lens": 0, "ev": model.ev[n],
                   "white_balance": list(model.white_balance[n])} for n in range(len(model.ev))]
        path.write_text(json.dumps({
            "reference": "0.jpg", "images": images,
            "mean": {"ev": model.ev.mean(), "white_balance": list(np.exp(np.log(model.white_balance).mean(axis=0)))},
            "cameras": [{"response": {"kind": "table", "values": [list(SRGB)]}}],
            "lenses": [{"camera": 0, "vignetting": {"k": model.k.tolist(), "center": list(model.center)}}]}))
        return colours.Exposures(path)

    def test_true_exposures_leave_nothing(self):
        model = camera()
        pairs = scene_pairs(model)
        with tempfile.TemporaryDirectory() as folder:
            found = colours.variances(pairs, {"result": self.exposures(model, folder)})
            model.ev = model.ev + [0.0, 0.1, 0.0, 0.0, 0.0]
            wrong = colours.variances(pairs, {"result": self.exposures(model, folder)})
        self.assertEqual(found["pairs"], len(pairs))
        self.assertLess(found["result"], 1e-3)
        self.assertGreater(found["before"], 10.0)
        self.assertGreater(found["affine"], 0.1)  # a gain of grey values cannot represent a falloff
        self.assertGreater(wrong["result"], 0.1)

    def test_an_image_that_is_not_joined(self):
        model = camera()
        pairs = scene_pairs(model)
        with tempfile.TemporaryDirectory() as folder:
            exposures = self.exposures(model, folder)
        exposures.ev[2] = np.nan
        self.assertEqual(colours.variances(pairs, {"result": exposures})["pairs"], int((pairs.image != 2).all(axis=1).sum()))

    def test_variance_by_hand(self):
        levels = np.zeros((10, 2, 3))
        levels[:, 1] = [2.0, 0.0, 4.0]
        levels[3, 1] = 200.0  # the worst of ten, which is not counted
        self.assertAlmostEqual(colours.variance(levels), 0.5 * (4.0 + 16.0) / 3.0)

    def test_gains_and_offsets(self):
        rng = np.random.default_rng(5)
        gain, offset = np.array([1.2, 0.9, 0.9]), np.array([5.0, -8.0, 3.0])
        first = rng.integers(0, 3, 600)
        second, true = (first + rng.integers(1, 3, 600)) % 3, rng.uniform(20.0, 200.0, 600)
        a, b = ((true - offset[i]) / gain[i] for i in (first, second))
        b[:60] = rng.uniform(0.0, 255.0, 60)
        found = colours.affine_of_channel(first, second, a, b, 3)
        np.testing.assert_allclose(found[0], gain, atol=1e-3)
        np.testing.assert_allclose(found[1], offset, atol=0.1)

    def test_largest_errors(self):
        truth, found = camera(), camera()
        found.ev = 1.3 * truth.ev + 0.7
        found.ev[1] = 5.0  # not joined
        data = {"images": [{"ev": None if n == 1 else ev, "white_balance": [1.0, 1.0, 1.0]} for n, ev in enumerate(found.ev)],
                "vignetting": {"k": truth.k.tolist(), "center": list(truth.center)}, "response": {"values": [list(SRGB)]}}
        own = scorer.largest_errors(truth, data)
        self.assertEqual(own["joined"], 4)
        self.assertAlmostEqual(own["ev"], 0.0)
        r2 = np.linspace(0.0, 1.0, 201) ** 2
        self.assertAlmostEqual(own["falloff"], np.abs(truth.falloff(r2) ** (1 / 1.3) - truth.falloff(r2)).max())


class Drone(unittest.TestCase):
    def test_database(self):
        flight = drone.Flight(2)
        numbers, keypoints = drone.observed(flight, np.random.default_rng(3))
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "database.db")
            colmap.write_database(path, (1000, 750), list(zip(flight.names, keypoints)), drone.pairs_of(flight, numbers))
            database = sqlite3.connect(path)
            names = dict(database.execute("SELECT image_id, name FROM images"))
            found = {image: np.frombuffer(data, np.float32).reshape(rows, cols) for image, rows, cols, data in
                     database.execute("SELECT image_id, rows, cols, data FROM keypoints")}
            pairs = database.execute("SELECT pair_id, rows, data FROM two_view_geometries WHERE config = 2").fetchall()
            database.close()
            self.assertEqual(colmap.matched(path), {"pairs": len(pairs), "matches": sum(pair[1] for pair in pairs)})
        self.assertEqual(sorted(names.values()), sorted(flight.names))
        self.assertGreater(len(pairs), 100)
        for pair, rows, data in pairs:
            a, b = divmod(pair, colmap.PAIR_BASE)
            self.assertLess(a, b)
            own = np.frombuffer(data, np.uint32).reshape(rows, 2)
            places = [found[image][own[:, side], :2] + flight.origin[flight.names.index(names[image])]
                      for side, image in enumerate((a, b))]
            self.assertLess(np.abs(places[0] - places[1]).max(), 10.0 * drone.KEYPOINT_PX)  # one point of the ground


class LimitCurves(unittest.TestCase):
    """Four sequences, of which a rule at 6 levels refuses two."""

    @staticmethod
    def record(kind, noise, others=()):
        rule = {"code": "scatter", "severity": "refusal", "measured": noise, "limit": 6.0}
        findings = [{"code": code, "severity": "refusal", "measured": None, "limit": None} for code in others]
        if noise > 6.0:
            findings.append(rule)
        return {"kind": kind, "findings": findings, "passed": [{"code": "few_agree", "severity": "refusal", "measured": 0.9, "limit": 0.3}]
                + ([] if noise > 6.0 else [rule])}

    def test_moving_a_limit_trades_one_error_for_the_other(self):
        records = [self.record("smooth", 3.5), self.record("hard", 8.0), self.record("noise", 7.0),
                   self.record("noise", 5.5), self.record("misplaced", 1.0, ["few_greys"])]
        lines = limit_curves.curves(records, verdicts.GOOD, verdicts.BAD)
        self.assertEqual(len([line for line in lines if "few_agree" in line]), 0)  # it refuses none of them
        cells = [c.strip() for c in lines[-1].strip("|").split("|")]
        self.assertEqual(cells[:2], ["`scatter`", "> 6"])
        self.assertEqual(cells[2:], ["2 / 0", "1 / 0", "1 / 0", "1 / 1", "1 / 2", "0 / 2", "0 / 2"])
        self.assertEqual(limit_curves.curves([], verdicts.GOOD, verdicts.BAD), [])


if __name__ == "__main__":
    unittest.main()
