#!/usr/bin/env python3
"""fleet.py PROGRAM TABLE: throughput of lensprof.fleet on this machine: a plain loop, and Dask with one and two workers.

Simulated sequences of six JPEG of 12 MP are calibrated, and their pictures corrected. CPU seconds are those of all
processes; the share of decoding is the CPU time of reading the same files as the library reads them.
"""
import concurrent.futures
import functools
import os
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time
import warnings

from dask.distributed import Client, LocalCluster

import lensprof as lp
from lensprof import fleet

SEQUENCES, SIZE, RUNS = 8, "4000x3000", 3
CALIBRATED_SIDE = 800  # px: pictures are reduced to it when they are decoded


def cpu_s():
    own, children = resource.getrusage(resource.RUSAGE_SELF), resource.getrusage(resource.RUSAGE_CHILDREN)
    return own.ru_utime + own.ru_stime + children.ru_utime + children.ru_stime


def in_new_process(work):
    """Wall and CPU seconds of `work` in a process of its own, which ends with its workers."""
    with concurrent.futures.ProcessPoolExecutor(1) as pool:
        return pool.submit(measured, work).result()


def measured(work):
    begun, used = time.perf_counter(), cpu_s()
    work()
    return time.perf_counter() - begun, cpu_s() - used


def plain(sequences, pictures, database, output):
    if pictures:
        rows = fleet.correct_pictures(pictures, output, database)
    else:
        rows = [fleet.calibrate_sequence(sequence, output) for sequence in sequences]
    assert all(row["state"] == "done" for row in rows), rows


def on_workers(workers, sequences, pictures, database, output):
    with LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        if pictures:
            rows = fleet.correct_all(pictures, output, database, client, batch=4)
        else:
            rows = fleet.calibrate_sequences(sequences, output, client)
    assert all(row["state"] == "done" for row in rows), rows


def read_all(pictures, max_side):
    for picture in pictures:
        lp.read_picture(picture, max_side=max_side)


def main():
    warnings.simplefilter("ignore")  # notices about clipped pixels
    program, table = sys.argv[1:]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        sequences = [str(folder / f"sequence{n}") for n in range(SEQUENCES)]
        for n, sequence in enumerate(sequences):
            subprocess.run([program, "simulate", "-o", sequence, "--size", SIZE, "--format", "jpeg", "--exif",
                            "--seed", str(n + 1)], check=True, capture_output=True)
        pictures = sorted(str(path) for sequence in sequences for path in pathlib.Path(sequence).glob("*.jpg"))
        first = str(folder / "first")
        plain(sequences, [], "", first)
        database = str(folder / "profiles.db")
        fleet.merge_stores(fleet.stores_of(first), database)
        lines = ["| job | run as | per minute | CPU s each | of it decoding |", "|---|---|---|---|---|"]
        for job, count, files in (("sequences of 6 × 12 MP", SEQUENCES, []), ("copies of 12 MP", len(pictures), pictures)):
            reading = [in_new_process(functools.partial(read_all, pictures, 0 if files else CALIBRATED_SIDE))[1]
                       for _ in range(RUNS)]
            for how, run in (("plain loop", plain), ("1 worker", functools.partial(on_workers, 1)),
                             ("2 workers", functools.partial(on_workers, 2))):
                taken = [in_new_process(functools.partial(run, sequences, files, database, str(folder / f"{job} {how} {n}")))
                         for n in range(RUNS)]
                wall, cpu = (statistics.median(values) for values in zip(*taken))
                lines.append(f"| {job} | {how} | {60 * count / wall:.3g} | {cpu / count:.3g} "
                             f"| {100 * statistics.median(reading) / cpu:.0f} % |")
                print(lines[-1], flush=True)
        lines.append(f"\n{os.cpu_count()} processors; median of {RUNS} runs. Starting a local cluster is part of the time.")
        pathlib.Path(table).write_text("\n".join(lines) + "\n", encoding="utf-8")
        print("\n".join(lines))


if __name__ == "__main__":
    main()
