"""Verdicts as data: codes, items and numbers of results, errors and lookups; docs/reasons.md."""
import pathlib
import re
import tempfile
import unittest

import numpy as np

import lensprof as lp

DOCS = pathlib.Path(__file__).parents[2] / "docs" / "reasons.md"


def grey_pairs(count, images):
    """Pairs of neighbouring images that see the same grey values at random places."""
    random = np.random.default_rng(1)
    pairs = np.zeros(count, dtype=lp.PAIR_DTYPE)
    first = random.integers(0, images - 1, count)
    pairs["image"] = np.stack([first, first + 1], axis=1)
    pairs["xy"] = random.uniform(0, [599, 399], (count, 2, 2))
    pairs["value"] = random.uniform(0.1, 0.9, (count, 1, 1))
    return pairs


class Reasons(unittest.TestCase):
    def test_a_fit_states_its_reason(self):
        pairs = grey_pairs(600, 4)
        pairs = pairs[pairs["image"][:, 0] != 1]  # images 0 and 1, and images 2 and 3
        result = lp.fit_overlap([lp.FitImage(i, 600, 400) for i in range(4)], pairs)
        self.assertFalse(result.usable)
        finding = result.findings[0]
        self.assertIs(finding.code, lp.Reason.IMAGE_GROUPS)
        self.assertIs(finding.severity, lp.Severity.REFUSAL)
        self.assertEqual(finding.value, (2.0,))
        item = finding.item
        self.assertEqual((item.kind, item.index), (lp.ItemKind.IMAGE, 2))
        end = item.text_begin + item.text_bytes
        self.assertEqual(finding.text.encode()[item.text_begin:end], b"image 2")
        self.assertIn("groups", lp.reason_text(finding.code))
        self.assertEqual(sorted(result.findings, key=lambda f: -f.severity), list(result.findings))
        for rule in result.passed:
            self.assertIs(rule.severity, lp.Severity.PASSED)
            self.assertEqual((rule.text, np.isfinite([rule.measured, rule.limit]).all()), ("", True))

    def test_a_flat_field_states_its_reason(self):
        result = lp.fit_flat([lp.FlatImage(np.full((300, 400, 3), 251, dtype=np.uint8), white=1.0)])
        self.assertTrue(all(f.code in list(lp.Reason) and f.text for f in result.findings))
        self.assertTrue(result.passed)
        white = np.full((300, 400, 3), 128, dtype=np.uint8)
        white[:150] = 255
        result = lp.fit_flat([lp.FlatImage(white, shot=5)])
        finding = result.findings[0]
        self.assertIs(finding.code, lp.Reason.FLAT_WHITE)
        self.assertEqual((finding.item.kind, finding.item.index), (lp.ItemKind.SHOT, 5))
        self.assertAlmostEqual(finding.value[0], 0.5, delta=0.05)
        self.assertEqual((finding.measured, finding.limit), (finding.value[0], 0.2))

    def test_an_error_names_its_item(self):
        pairs = grey_pairs(100, 3)
        pairs["value"][7, 1, 2] = 1.5
        with self.assertRaises(lp.Error) as caught:
            lp.fit_overlap([lp.FitImage(i, 600, 400) for i in range(3)], pairs)
        self.assertEqual((caught.exception.item_kind, caught.exception.item_index), (lp.ItemKind.PAIR, 7))
        with self.assertRaises(lp.Error) as caught:
            lp.fit_overlap([lp.FitImage(0, 600, 400)], grey_pairs(100, 3))
        self.assertIs(caught.exception.item_kind, lp.ItemKind.NONE)

    def test_a_lookup_states_its_reasons(self):
        with tempfile.TemporaryDirectory() as folder:
            with lp.Store(pathlib.Path(folder) / "p.db", lp.StoreMode.CREATE) as store:
                for aperture, distance in ((2.0, 1.0), (4.0, 1.0), (2.0, 9.0), (4.0, 9.0)):
                    key = lp.ProfileKey(lens="Lens 50mm", focal_mm=50, aperture=aperture, distance_m=distance,
                                        crop_factor=1.5)
                    store.put(lp.Profile(key=key, vignetting=lp.Vignetting(k=(-0.4 / aperture, 0, 0))))
                how = store.lookup(lp.ProfileKey(lens="Lens 50mm", focal_mm=50, aperture=5.0, crop_factor=1.5))[1]
                self.assertEqual(how.reasons, (lp.Reason.LOOKUP_APERTURE_OUTSIDE, lp.Reason.LOOKUP_USUAL_DISTANCE,
                                               lp.Reason.LOOKUP_TYPICAL_RESPONSE))
                self.assertEqual(how.reason, "; ".join(map(lp.reason_text, how.reasons)))
                with self.assertRaises(lp.Error) as caught:
                    store.lookup(lp.ProfileKey(lens="Another", focal_mm=50, aperture=2.0))
                self.assertEqual(caught.exception.lookup.reasons, (lp.Reason.LOOKUP_NO_LENS,))

    def test_names_are_those_of_the_enumerators(self):
        for reason in lp.Reason:
            self.assertEqual(lp.reason_name(reason), reason.name.lower())

    def test_the_documentation_lists_every_reason(self):
        severities = r"(?:(?:refusal|warning|note)(?:, )?)+"
        row = re.compile(rf"^\| (\d+) \| `(\w+)` \| (?:{severities} \| )?(.+?) \| .*? \| (.+?) \| (.+?) \|$", re.M)
        rows = row.findall(DOCS.read_text(encoding="utf-8"))
        listed = {int(code): name for code, name, *_ in rows}
        self.assertEqual(len(rows), len(listed))
        self.assertEqual(listed, {int(r): r.name.lower() for r in lp.Reason if r})
        for code, _, meaning, cause, cure in rows:
            for text in (meaning, cause, cure):
                self.assertGreaterEqual(len(text), 10, code)


if __name__ == "__main__":
    unittest.main()
