"""The profile database."""
import contextlib
import gc
import math
import os
import pathlib
import sqlite3
import tempfile
import threading
import unittest

import numpy as np

import lensprof as lp
from support import refused


def sample_profile(lens="Distagon 28 mm", **key):
    profile = lp.Profile(
        key=lp.ProfileKey(camera_maker="Maker", camera_model="Model \u00e9", lens=lens, focal_mm=28, aperture=2.8,
                          distance_m=math.inf, processing=lp.Processing.RAW, **key),
        response=[lp.Response.from_gamma(2.2), lp.Response.from_emor([0.5, -0.25]),
                  lp.Response.from_table([0, 0.7, 1])],
        vignetting=lp.Vignetting(k=(-0.3, 0.1, -0.05), center=(0.01, -0.02)), covariance=np.diag(np.arange(1.0, 8.0)),
        grid=lp.GainGrid(np.linspace(0.8, 1.2, 3 * 32 * 31).reshape(3, 32, 31)))
    for name, value in {"method": "transfer", "software": "lensprof test", "source": "/tmp/a.pto",
                        "created_unix_s": 10**10, "images": 5, "pairs": 2000, "heldout_rms": 0.5,
                        "inlier_share": 0.97}.items():
        setattr(profile.provenance, name, value)
    return profile


# The library may have a newer SQLite than Python, one of before 3.37 does not open its tables.
damages_databases = unittest.skipIf(sqlite3.sqlite_version_info < (3, 37), "needs a Python with SQLite 3.37")


class Stores(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name) / "profiles \u00e9.db"

    def make(self, *profiles):
        with lp.Store(self.path, lp.StoreMode.CREATE) as store:
            return [store.put(profile) for profile in profiles]

    def test_round_trip(self):
        profile = sample_profile()
        number, = self.make(profile)
        with lp.Store(self.path) as store:
            self.assertEqual(store.get(number), profile)
            self.assertEqual(store.find(profile.key), (number, profile))
        with lp.Store(os.fsencode(self.path)) as store:
            self.assertEqual(len(store.list()), 1)

    def test_newest_is_found(self):
        first, second = sample_profile(), sample_profile()
        second.vignetting = lp.Vignetting(k=(-0.1, 0, 0))
        numbers = self.make(first, second)
        with lp.Store(self.path) as store:
            self.assertEqual(store.find(first.key.copy()), (numbers[1], second))
            self.assertEqual(store.get(numbers[0]), first)

    def test_list(self):
        numbers = self.make(*[sample_profile(lens) for lens in ("c", "a", "b", "a")])
        with lp.Store(self.path) as store:
            rows = store.list()
            only = store.list(lp.ProfileKey(lens="A"))
            self.assertEqual(store.list(lp.ProfileKey(lens="nothing")), [])
        gc.collect()
        junk = [lp.Profile() for _ in range(20)]
        self.assertEqual([row.id for row in rows], [numbers[i] for i in (1, 3, 2, 0)])
        self.assertEqual([row.key.lens for row in rows], ["a", "a", "b", "c"])
        self.assertEqual(rows[2].key, sample_profile("b").key)
        self.assertEqual(rows[2].provenance, sample_profile().provenance)
        self.assertEqual(only, rows[:2])
        del junk

    def test_list_while_another_adds(self):
        """Rows added between counting and fetching are fetched, too."""
        self.make(sample_profile("a"))
        with lp.Store(self.path) as store, lp.Store(self.path, lp.StoreMode.WRITE) as other:
            from lensprof import _library
            inner, added = _library.lib.lensprof_store_list, []

            def counted_then_added(*arguments):
                status = inner(*arguments)
                if not added:
                    added.append(other.put(sample_profile("b")))
                return status
            _library.lib.lensprof_store_list = counted_then_added
            try:
                self.assertEqual([row.key.lens for row in store.list()], ["a", "b"])
            finally:
                _library.lib.lensprof_store_list = inner

    def test_remove(self):
        numbers = self.make(sample_profile("a"), sample_profile("b"))
        with lp.Store(self.path, lp.StoreMode.WRITE) as store:
            store.remove(numbers[0])
            self.assertEqual([row.id for row in store.list()], numbers[1:])
            with refused(self, lp.Status.ERROR_NOT_FOUND):
                store.remove(numbers[0])

    def test_lenses_cameras_and_keys(self):
        self.make(sample_profile(), sample_profile(), sample_profile("Planar 50 mm"))
        with lp.Store(self.path, lp.StoreMode.WRITE) as store:
            self.assertEqual([(row.lens, row.profiles, row.others) for row in store.lenses()],
                             [("Distagon 28 mm", 2, 1), ("Planar 50 mm", 1, 1)])
            self.assertEqual([row.lens for row in store.lenses("50 planar")], ["Planar 50 mm"])
            self.assertEqual([(row.camera_model, row.others) for row in store.cameras()], [("Model \u00e9", 2)])
            self.assertEqual(store.cameras("nothing"), [])
            key = store.get(2).key
            key.lens, key.aperture = "Sonnar", 4
            store.set_key(2, key)
            self.assertEqual(store.get(2).key.lens, "Sonnar")
            self.assertEqual(store.lenses("sonnar")[0].aperture.tolist(), [4, 4])
            with refused(self, lp.Status.ERROR_NOT_FOUND):
                store.set_key(9, key)
            self.assertRaises(ValueError, store.lenses, "a\0b")

    def test_camera_models_and_nearest_lenses(self):
        self.make(sample_profile(), sample_profile("Planar 50 mm"))
        camera = lp.CameraModel(maker="Sony", model="ILCE-7M3", other_model="Alpha 7 III", mount="Sony E", crop_factor=1.0)
        with lp.Store(self.path, lp.StoreMode.WRITE) as store:
            self.assertEqual(store.camera_models(), [])
            store.put_camera(camera)
            self.assertEqual(store.find_camera("SONY", "alpha 7 iii"), camera)
            self.assertEqual(store.camera_models(), [camera])
            with refused(self, lp.Status.ERROR_NOT_FOUND):
                store.find_camera("Nikon", "ILCE-7M3")
            with refused(self, lp.Status.ERROR_ARGUMENT):
                store.put_camera(lp.CameraModel(maker="Sony"))
            with refused(self, lp.Status.ERROR_NOT_FOUND) as caught:
                store.lookup(lp.ProfileKey(lens="Planar 1.4/50"))
            self.assertEqual(caught.exception.lookup.nearest, ("Planar 50 mm",))

    def test_merge(self):
        self.make(sample_profile("a"), sample_profile("b"))
        with lp.Store(self.path.with_name("all.db"), lp.StoreMode.CREATE) as store, lp.Store(self.path) as other:
            store.put(sample_profile("b"))
            self.assertEqual(store.merge(other), (1, 1))
            self.assertEqual(store.merge(other), (0, 2))
            self.assertEqual(store.get(2), sample_profile("a"))
            with self.assertRaisesRegex(ValueError, "the database itself"):
                store.merge(store)
            with self.assertRaises(TypeError):
                store.merge(self.path)
            with refused(self, lp.Status.ERROR_READ_ONLY):
                other.merge(store)
            with lp.Store(self.path) as same, refused(self, lp.Status.ERROR_ARGUMENT):
                same.merge(other)

    def test_prior_and_find_same(self):
        profile = sample_profile("a")
        with lp.Store(self.path, lp.StoreMode.CREATE) as store:
            self.assertEqual(store.find_same(profile), 0)
            first = store.put(profile)
            profile.provenance.prior_id, profile.provenance.forced = first, 1
            self.assertEqual(store.find_same(profile), first)
            stored = store.get(store.put(profile)).provenance
            self.assertEqual((stored.prior_id, stored.forced, stored.not_usable), (first, 1, 0))
            profile.provenance.forced, profile.provenance.not_usable = 0, 1
            with refused(self, lp.Status.ERROR_ARGUMENT):
                store.put(profile)
            profile.provenance.prior_id, profile.provenance.not_usable = -1, 0
            with refused(self, lp.Status.ERROR_ARGUMENT):
                store.put(profile)

    @damages_databases
    def test_damaged_row_is_listed(self):
        first, second = self.make(sample_profile("a"), sample_profile("b"))
        with sqlite3.connect(self.path) as db:
            db.execute("PRAGMA ignore_check_constraints = ON")
            db.execute("UPDATE profiles SET aperture = -2.0 WHERE id = ?", (second,))
        db.close()
        with lp.Store(self.path) as store:
            rows = {row.id: row for row in store.list()}
            self.assertEqual((rows[first].damaged, rows[first].key.camera_model), (0, sample_profile("a").key.camera_model))
            self.assertEqual((rows[second].damaged, rows[second].key.aperture), (1, lp.UNKNOWN))
            with refused(self, lp.Status.ERROR_CORRUPT):
                store.get(second)

    @damages_databases
    def test_check_and_stats(self):
        numbers = self.make(sample_profile("a"), sample_profile("A "), sample_profile("b", unit="1"))
        with lp.Store(self.path) as store:
            self.assertEqual(store.check(), (3, []))
            stats = store.stats()
            self.assertEqual((stats.profiles, stats.cameras, stats.lenses, stats.units), (3, 1, 2, 1))
            self.assertEqual(list(stats.processing), [3, 0, 0])
            self.assertEqual((stats.with_covariance, stats.with_grid, stats.with_doubt, stats.layout), (3, 3, 0, 7))
            self.assertEqual((list(stats.focal_mm), list(stats.distance_m)), ([28, 28], [math.inf, math.inf]))
            self.assertEqual((stats.method, stats.source), ({"transfer": 3}, {"/tmp/a.pto": 3}))
            self.assertEqual(stats.bytes, self.path.stat().st_size)
        with contextlib.closing(sqlite3.connect(self.path)) as database:
            database.execute("UPDATE vignettings SET k1 = -9 WHERE profile_id = ?", (numbers[1],))
            database.commit()
        with lp.Store(self.path) as store:
            profiles, faults = store.check()
            self.assertEqual((profiles, [fault.id for fault in faults]), (3, [numbers[1]]))
            self.assertIn("VIGNETTING", faults[0].reason)

    def test_threads_share_a_store(self):
        profile = sample_profile()
        number, = self.make(profile)
        results = []
        with lp.Store(self.path) as store:
            threads = [threading.Thread(target=lambda: results.extend(store.get(number) == profile for _ in range(20)))
                       for _ in range(4)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
        self.assertEqual(results, [True] * 80)

    def test_closed(self):
        self.make(sample_profile())
        store = lp.Store(self.path)
        store.close()
        store.close()
        with self.assertRaisesRegex(ValueError, "this Store is closed"):
            store.list()

    def test_refused(self):
        with refused(self, lp.Status.ERROR_NOT_FOUND) as caught:
            lp.Store(self.path)
        self.assertIn(self.path.name, caught.exception.text)
        number, = self.make(sample_profile())
        with lp.Store(self.path) as store:
            with refused(self, lp.Status.ERROR_READ_ONLY):
                store.put(sample_profile())
            with refused(self, lp.Status.ERROR_NOT_FOUND):
                store.get(number + 1)
            with refused(self, lp.Status.ERROR_NOT_FOUND):
                store.find(lp.ProfileKey(lens="nothing"))
            with refused(self, lp.Status.ERROR_ARGUMENT):
                store.find(lp.ProfileKey(lens="a\tb"))
            with self.assertRaises(ValueError):
                store.get(2**63)
            self.assertEqual(len(store.list()), 1)

    def test_invalid_profile_is_not_stored(self):
        broken = sample_profile()
        broken.vignetting[0].k[0] = -9
        before = broken.copy()
        with lp.Store(self.path, lp.StoreMode.CREATE) as store:
            with refused(self, lp.Status.ERROR_VIGNETTING):
                store.put(broken)
            self.assertEqual(store.list(), [])
        self.assertEqual(broken, before)

    def test_not_a_database(self):
        self.path.write_text("something else, and long enough to be no header of SQLite at all")
        with refused(self, lp.Status.ERROR_CORRUPT):
            lp.Store(self.path)
        with self.assertRaisesRegex(ValueError, "zero bytes"):
            lp.Store("a\0b")
        with self.assertRaises(ValueError):
            lp.Store(self.path, 3)

    def test_lookup(self):
        with lp.Store(self.path, lp.StoreMode.CREATE) as store:
            with store.transaction():
                for aperture, k1 in ((1.8, -0.6), (2.8, -0.35), (4.0, -0.2), (5.6, -0.15)):
                    store.put(lp.Profile(key=lp.ProfileKey(lens="Lens 50 mm", focal_mm=50, aperture=aperture,
                                                           distance_m=math.inf), vignetting=lp.Vignetting(k=(k1, 0, 0))))
            with self.assertRaises(RuntimeError), store.transaction():
                store.put(sample_profile())
                raise RuntimeError("no more")
            self.assertEqual(len(store.list()), 4)
            key = lp.ProfileKey(lens="LENS 50mm", focal_mm=50, aperture=2.2, distance_m=math.inf)
            profile, how = store.lookup(key)
            self.assertTrue(-0.6 < profile.vignetting[0].k[0] < -0.35)
            self.assertEqual((how.exact, how.rows), (0, 4))
            self.assertAlmostEqual(how.name_score, 0.9)
            key.aperture = 4.0
            profile, how = store.lookup(key, lp.LookupOptions(distance_rule=lp.DistanceRule.FARTHEST))
            self.assertEqual((how.exact, how.id[0]), (1, 3))
            key.aperture = 22.0
            with refused(self, lp.Status.ERROR_NOT_FOUND):
                store.lookup(key)

    def test_lookup_in_several_databases(self):
        with lp.Store(self.path, lp.StoreMode.CREATE) as lenses, \
                lp.Store(str(self.path) + "-2", lp.StoreMode.CREATE) as cameras:
            key = lp.ProfileKey(lens="Lens 50 mm", focal_mm=50, aperture=2.8, distance_m=math.inf, crop_factor=1.0,
                                processing=lp.Processing.RAW)
            lenses.put(lp.Profile(key=key, vignetting=lp.Vignetting(k=(-0.3, 0, 0))))
            body = lp.ProfileKey(camera_model="Body", lens="Another lens", processing=lp.Processing.JPEG)
            number = cameras.put(lp.Profile(key=body, response=lp.Response.from_gamma(2.0)))
            key.camera_model, key.processing = "Body", lp.Processing.JPEG
            profile, how = lp.lookup_in([lenses, cameras], key)
            self.assertEqual((how.exact, how.falloff_store, how.response_store), (0, 0, 1))
            self.assertEqual((how.response_from, how.response_rows), (lp.ResponseFrom.CAMERA, 1))
            self.assertEqual(how.response_id[0], number)
            self.assertAlmostEqual(profile.response[0].eval(0.25), 0.5, places=3)
            self.assertAlmostEqual(profile.vignetting[0].k[0], -0.3, places=3)
            profile, how = lenses.lookup(key)
            self.assertEqual((how.response_from, how.camera_kind), (lp.ResponseFrom.KIND, lp.CameraKind.STILL))
            with refused(self, lp.Status.ERROR_NOT_FOUND):
                lp.lookup_in([cameras, cameras][:1], key)
            with refused(self, lp.Status.ERROR_ARGUMENT):
                lp.lookup_in([], key)


if __name__ == "__main__":
    unittest.main()
