"""Exposures by the settings of cameras."""
import unittest

import numpy as np

import lensprof as lp
from support import refused


def settings(*times):
    """Manual exposures at f/8, ISO 100."""
    made = np.zeros(len(times), dtype=lp.EXPOSURE_SETTINGS_DTYPE)
    made["time_s"], made["f_number"], made["iso"], made["is_manual"] = times, 8, 100, 1
    return made


class KnownExposures(unittest.TestCase):
    def test_times(self):
        known = lp.known_exposures(settings(0.01, 0.02, 0.01))
        self.assertEqual(known["ev"][0], lp.settings_ev(0.01, 8, 100))
        np.testing.assert_allclose(known["ev"] - known["ev"][0], [0, 1, 0], atol=1e-12)
        self.assertEqual(known["sigma"].tolist(), [0.03, 0.1, 0.03])
        self.assertTrue((known["state"] == lp.ExposureState.KNOWN).all())

    def test_unknown(self):
        given = settings(0.01, 0.02)
        given["time_s"][1] = lp.UNKNOWN
        known = lp.known_exposures(given)
        self.assertEqual(lp.ExposureState(known["state"][1]), lp.ExposureState.NO_TIME)
        self.assertTrue(np.isnan(known["ev"][1]))
        self.assertEqual(known["sigma"][1], 0)
        self.assertEqual(len(lp.known_exposures(settings())), 0)

    def test_into_a_fit(self):
        known = lp.known_exposures(settings(0.01, 0.02))
        images = [lp.FitImage(i, 300, 200, known_ev=k["ev"], known_ev_sigma=k["sigma"]) for i, k in enumerate(known)]
        self.assertEqual(images[1].known_ev - images[0].known_ev, known["ev"][1] - known["ev"][0])

    def test_bad_input(self):
        given = settings(0.01, 0.02)
        given["is_manual"][1] = 2
        with refused(self, lp.Status.ERROR_ARGUMENT):
            lp.known_exposures(given)
        with self.assertRaises(TypeError):
            lp.known_exposures(np.zeros(2))


if __name__ == "__main__":
    unittest.main()
