"""Sequences and pictures on a local Dask cluster of two workers, one of which is killed in between; stores in memory of
fsspec. Needs dask.distributed, fsspec and pyarrow; skipped without them."""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import threading
import time
import unittest

import lensprof as lp

missing = ""
try:
    import fsspec
    import pyarrow.parquet
    from dask.distributed import Client, LocalCluster
except ImportError as error:
    missing = f"{error}; pip install lensprof[fleet]"
from lensprof import fleet

PROGRAM = os.environ["LENSPROF_PROGRAM"]


def sequence(folder, ev):
    """Three overlapping pictures; the exposure makes them differ from those of other sequences."""
    subprocess.run([PROGRAM, "simulate", "-o", str(folder), "--size", "320x240", "--set", f"mean-ev={ev}"], check=True,
                   capture_output=True)
    return str(folder)


def profiles_of(database):
    with lp.Store(database) as store:
        return sorted(store.get(row.id).pack() for row in store.list())


def settled(row):
    """A row without what differs from run to run."""
    return {name: value for name, value in row.items() if name != "seconds"}


@unittest.skipIf(missing, missing)
class Fleet(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.sequences = [sequence(cls.folder / f"walk {n}", -0.3 * n) for n in range(4)]
        (cls.folder / "empty").mkdir()
        cls.sequences.append(str(cls.folder / "empty"))
        cls.plain = str(cls.folder / "plain")
        cls.rows = [fleet.calibrate_sequence(one, cls.plain) for one in cls.sequences]

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_rows(self):
        self.assertEqual([row["state"] for row in self.rows], ["done"] * 4 + ["failed"])
        self.assertIn("empty", self.rows[4]["error"])
        for row in self.rows[:4]:
            self.assertEqual((row["profiles"], row["error"]), (1, ""))
            self.assertTrue(0.3 < row["corner"] < 1.0, row)
        self.assertEqual(len(fleet.stores_of(self.plain)), 4)

    def test_names_differ_where_folders_have_the_same_name(self):
        self.assertNotEqual(fleet.name_of("/a/walk"), fleet.name_of("/b/walk"))
        self.assertEqual(fleet.name_of("s3://bucket/a/walk/"), fleet.name_of("s3://bucket/a/walk"))
        self.assertEqual(fleet.name_of("s3://bucket/a/walk/")[:5], "walk-")
        self.assertEqual(fleet.name_of("walk"), fleet.name_of("file://" + os.path.abspath("walk")))

    def test_one_address_is_no_list(self):
        for job in (lambda: fleet.calibrate_sequences(self.sequences[0], self.plain, None),
                    lambda: fleet.correct_all(self.sequences[0], self.plain, "x.db", None),
                    lambda: fleet.correct_pictures(self.sequences[0], self.plain, "x.db")):
            self.assertRaisesRegex(TypeError, "give a list", job)

    def test_missing_database_is_a_failure_whatever_exists(self):
        picture = next(pathlib.Path(self.sequences[0]).glob("*.png"))
        output = str(self.folder / "once")
        for database, state in ((fleet.stores_of(self.plain)[0], "done"), (str(self.folder / "none.db"), "failed")):
            rows = fleet.correct_pictures([str(picture)], output, database)
            self.assertEqual([row["state"] for row in rows], [state])
        self.assertIn("none.db", rows[0]["error"])

    def test_damaged_row_is_done_again(self):
        output = self.folder / "damaged"
        shutil.copytree(self.plain, output)
        row = output / "rows" / f"{self.rows[0]['name']}.json"
        for content in ("{", "[]", "{}"):
            row.write_text(content)
            self.assertEqual(settled(fleet.calibrate_sequence(self.sequences[0], str(output))), settled(self.rows[0]))
            self.assertEqual(json.loads(row.read_text())["state"], "done")

    def test_what_has_a_row_is_not_done_again(self):
        """But what failed is."""
        before = (pathlib.Path(self.plain) / "rows" / f"{self.rows[0]['name']}.json").stat().st_mtime_ns
        self.assertEqual(fleet.calibrate_sequence(self.sequences[0], self.plain), self.rows[0])
        after = (pathlib.Path(self.plain) / "rows" / f"{self.rows[0]['name']}.json").stat().st_mtime_ns
        self.assertEqual(before, after)

    def test_merge_in_any_order_and_again(self):
        stores = fleet.stores_of(self.plain)
        first, second = str(self.folder / "first.db"), str(self.folder / "second.db")
        self.assertEqual(fleet.merge_stores(stores, first), (4, 0))
        self.assertEqual(fleet.merge_stores(stores, first), (0, 4))
        for store in reversed(stores):
            fleet.merge_stores([store], second)
        self.assertEqual(profiles_of(first), profiles_of(second))

    def test_two_workers_one_of_which_is_killed(self):
        output = str(self.folder / "cluster")
        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
            def kill():
                rows = pathlib.Path(output) / "rows"
                while not rows.is_dir() or not any(rows.iterdir()):  # one is done, others are at work
                    time.sleep(0.02)
                os.kill(next(iter(client.run(os.getpid).values())), signal.SIGKILL)

            killer = threading.Thread(target=kill)
            killer.start()
            rows = fleet.calibrate_sequences(self.sequences, output, client)
            killer.join()
            self.assertEqual([settled(row) for row in rows], [settled(row) for row in self.rows])
            pictures = sorted(str(path) for path in pathlib.Path(self.sequences[0]).glob("*.png"))
            broken = self.folder / "broken.png"
            broken.write_bytes(b"\x89PNG")
            copies = fleet.correct_all([*pictures, str(broken)], output + "/copies", output + "/profiles.db", client, batch=2)
        self.assertEqual(profiles_of(output + "/profiles.db"), sorted(
            profile for store in fleet.stores_of(self.plain) for profile in profiles_of(fsspec.core.url_to_fs(store)[1])))
        table = pyarrow.parquet.read_table(output + "/calibrations.parquet").to_pylist()
        self.assertEqual(table, rows)
        self.assertEqual([row["state"] for row in copies], ["done"] * len(pictures) + ["failed"])
        self.assertIn("broken.png", copies[-1]["error"])
        self.assertTrue(all(pathlib.Path(row["copy"]).is_file() for row in copies[:-1]))
        self.assertFalse(list(pathlib.Path(output).rglob("*.part")))

    def test_worker_that_dies_again_and_again(self):
        """As when it runs out of memory: a row with the reason, and the others go on."""
        with LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
            row = fleet._row_of(client.submit(os._exit, 1), {"sequence": "walk"})
            self.assertEqual((row["sequence"], row["state"]), ("walk", "failed"))
            self.assertIn("died", row["error"])

    def test_object_storage(self):
        memory = fsspec.filesystem("memory")
        memory.put(self.sequences[0], "/bucket/walk", recursive=True)
        row = fleet.calibrate_sequence("memory://bucket/walk", "memory://bucket/output")
        self.assertEqual(row["state"], "done", row)
        self.assertEqual(row["corner"], self.rows[0]["corner"])
        stores = fleet.stores_of("memory://bucket/output")
        self.assertEqual(len(stores), 1)
        self.assertEqual(fleet.merge_stores(stores, str(self.folder / "memory.db"))[0], 1)
        self.assertEqual(json.loads(memory.cat(f"/bucket/output/rows/{row['name']}.json")), row)

    def test_storage_that_fails_in_the_middle(self):
        """Neither a row nor half a file is left, and the next run does it."""
        target = self.folder / "full"
        target.mkdir()
        system = fsspec.filesystem("file")
        real, calls = type(system).put_file, []

        def failing(this, local, remote, **options):
            calls.append(remote)
            if len(calls) == 2:
                pathlib.Path(remote).write_bytes(b"half")
                raise OSError(28, "No space left on device", remote)
            return real(this, local, remote, **options)

        type(system).put_file = failing
        try:
            row = fleet.calibrate_sequence(self.sequences[1], str(target))
        finally:
            type(system).put_file = real
        self.assertEqual((row["state"], "No space left" in row["error"]), ("failed", True))
        self.assertFalse(list(target.rglob("*.part")) + list(target.rglob("exposures/*.json")))
        self.assertEqual(fleet.calibrate_sequence(self.sequences[1], str(target))["state"], "done")


if __name__ == "__main__":
    unittest.main()
