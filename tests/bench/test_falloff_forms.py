#!/usr/bin/env python3
"""Tests of falloff_forms: the fits recover the axes of made ellipses; tables and the criterion are read correctly."""
import json
import pathlib
import tempfile
import unittest

import numpy as np

import falloff_forms as forms
import form_tables
import scorer

RATIO, TURN = 1.3, 25.0  # of the longer axis to the shorter one; degrees
CENTER, K = (0.03, -0.02), (-0.5, 0.2, -0.05)


def falloff(x, y, ratio=RATIO):
    """From the semi-axes and the turned coordinates, independent of radius2."""
    turn, x, y = np.radians(TURN), x - CENTER[0], y - CENTER[1]
    along, across = x * np.cos(turn) + y * np.sin(turn), y * np.cos(turn) - x * np.sin(turn)
    r2 = (along / ratio**0.5)**2 + (across * ratio**0.5)**2
    return 1 + K[0] * r2 + K[1] * r2**2 + K[2] * r2**3


def card(ratio=RATIO, noise=0.0):
    frame = forms.Card(np.ones((12, 16)), 4 / 3)
    light = 0.8 * falloff(frame.x, frame.y, ratio) * (1 + np.random.default_rng(3).normal(0, noise, frame.x.shape))
    return forms.Card(light.reshape(12, 16), 4 / 3)


class Cards(unittest.TestCase):
    def test_corners_of_a_frame_are_at_one_half_diagonal(self):
        frame = forms.Card(np.ones((300, 400)), 4 / 3)
        self.assertAlmostEqual(np.hypot(frame.x, frame.y).max(), 1.0, 2)
        self.assertAlmostEqual(frame.x.max() / frame.y.max(), 4 / 3, 2)

    def test_axes_of_an_ellipse_are_recovered(self):
        of = card()
        shape, light = forms.fit_card(of, np.ones(192, bool), "powers", 4)
        ratio, angle = forms.axes(shape)
        self.assertAlmostEqual(ratio, RATIO, 4)
        self.assertAlmostEqual(angle, TURN, 2)
        np.testing.assert_allclose(shape[:2], CENTER, atol=1e-3)  # with its prior
        np.testing.assert_allclose(light, of.light, rtol=1e-4)

    def test_a_round_falloff_has_equal_axes(self):
        shape, _ = forms.fit_card(card(1.0), np.ones(192, bool), "powers", 3)
        self.assertAlmostEqual(forms.axes(shape)[0], 1.0, 4)

    def test_held_out_errors_tell_the_shapes_apart(self):
        shapes = forms.compare_card(card(noise=1e-3))["shapes"]
        self.assertGreater(shapes["radial, centre"]["rms"], forms.WARNING)
        self.assertLess(shapes["ellipse, angle"]["rms"], 1.3e-3)
        self.assertLess(shapes["ellipse, angle"]["pattern"], 5e-4)
        self.assertAlmostEqual(shapes["ellipse, angle"]["axes"][0], RATIO, 2)
        self.assertLess(shapes["grid"]["rms"], 0.5 * shapes["radial, centre"]["rms"])

    def test_a_card_is_drawn_through_the_cells(self):
        of = card()
        wide = forms.drawn(forms.drawn(of.light.reshape(12, 16), 36).T, 48).T
        fine = forms.Card(np.ones((36, 48)), 4 / 3)
        expected = falloff(fine.x, fine.y).reshape(36, 48)
        np.testing.assert_allclose(wide / wide[18, 24], expected / expected[18, 24], rtol=2e-3)
        np.testing.assert_allclose(wide[1::3, 1::3], of.light.reshape(12, 16), rtol=1e-9)

    def test_noise_is_measured(self):
        self.assertAlmostEqual(card(noise=5e-3).noise, 5e-3, 3)
        self.assertLess(card().noise, 2e-4)

    def test_gains_of_a_tuning_file(self):
        gains = {"luminance_lut": [2.0] * 96 + [4.0] * 96, "calibrations_Cr": [{"ct": 3000, "table": [1.25] * 192}]}
        other = {**gains, "luminance_lut": [3.0] * 96 + [4.0] * 96}
        with tempfile.TemporaryDirectory() as folder:
            for name, tables in (("a", gains), ("b", gains), ("c_mono", other)):
                pathlib.Path(folder, name + ".json").write_text(json.dumps({"algorithms": [{"rpi.alsc": tables}]}))
            cards = forms.tables_below([pathlib.Path(folder)])
            lights = dict(forms.tables_of(pathlib.Path(folder, "a.json")))
        self.assertEqual(list(cards), [("a", "green"), ("a", "red 3000 K"), ("c_mono", "green")])
        self.assertEqual((lights["green"][0, 0], lights["green"][11, 15], lights["red 3000 K"][0, 0]), (0.5, 0.25, 0.4))


class Sequences(unittest.TestCase):
    def test_axes_are_recovered_from_overlaps(self):
        draw = np.random.default_rng(9)
        image = draw.permuted(np.tile([0, 1, 2, 3], (1500, 1)), axis=1)[:, :2]
        xy = draw.uniform(0, 1, (1500, 2, 2)) * [399, 299]
        place = (xy - [199.5, 149.5]) / 250
        light = falloff(place[..., 0], place[..., 1]) * 0.4 * np.exp(0.1 * image)
        value = np.repeat(light[..., None], 3, axis=2)
        value[::10, 0] *= 1.4  # something moved
        ends = forms.Ends(scorer.Pairs(image, xy, value), scorer.Gamma(1.0), [[400, 300]] * 4)
        shapes = forms.compare_ends(ends)
        self.assertAlmostEqual(shapes["ellipse, angle"]["axes"][0], RATIO, 1)
        self.assertAlmostEqual(shapes["ellipse, angle"]["axes"][1], TURN, -1)
        self.assertGreater(shapes["ellipse, angle"]["better"], 5.0)
        self.assertGreater(shapes["radial, centre"]["grid_better"], 2.0)
        self.assertLess(shapes["ellipse, angle"]["grid_better"], 2.0)


class Tables(unittest.TestCase):
    def test_the_criterion_counts_what_the_radial_form_leaves(self):
        def record(camera, radial, ellipse, turned):
            rms = {"radial, centre": radial, "ellipse": ellipse, "ellipse, angle": turned}
            return {"camera": camera, "shapes": {name: {"rms": of} for name, of in rms.items()}}

        records = [record("a", 0.002, 0.001, 0.001), record("a", 0.02, 0.0029, 0.004), record("b", 0.02, 0.02, 0.0031),
                   record("b", 0.02, 0.02, 0.001), record("c", 0.02, 0.02, 0.02)]
        self.assertEqual(form_tables.share(records, "rms"), (2, 4))
        self.assertEqual(form_tables.cameras_of(records), (2, 3))


if __name__ == "__main__":
    unittest.main()
