"""Sequences and pictures by the thousand, on several machines; docs/howto/fleet.md.

`calibrate_sequence` and `correct_pictures` are plain functions that return rows: Ray, Spark and Slurm call them as they
are. `calibrate_sequences` and `correct_all` run them on a Dask client. Paths are local folders, or addresses that fsspec
knows, such as s3://bucket/folder.

Every sequence has a database of its own, so that workers share nothing; `merge_stores` joins them, in any order and any
number of times. A row is written last. What has a row is not done again, so a run that was killed goes on.
"""
from __future__ import annotations

import contextlib
import hashlib
import json
import os
import pathlib
import tempfile
import time
from typing import Any, Callable, Iterator, Optional, Sequence

from .calibration import Calibration
from .copies import correct_file
from ._abi import StoreMode
from ._library import Error
from .scene import calibrate
from .store import Store

Row = dict[str, Any]
STATES = ("done", "not usable", "failed")


def name_of(address: str) -> str:
    """A name for the files of a sequence, which no other address has: its last part, and a hash of all of it. A local
    folder has one name, whether its path is relative, absolute, or an address (file://)."""
    if "://" not in address or address.startswith("file://"):
        address = os.path.abspath(address.removeprefix("file://"))
    address = address.rstrip("/")
    return f"{address.rsplit('/', 1)[-1]}-{hashlib.sha256(address.encode()).hexdigest()[:12]}"


def _below(folder: str, name: str) -> str:
    return f"{folder.rstrip('/')}/{name}"


def _copy_name(picture: str) -> str:
    """The name of a picture with a hash of its address before its ending, if it has one."""
    stem, dot, ending = picture.rsplit("/", 1)[-1].rpartition(".")
    return f"{stem}-{name_of(picture)[-12:]}.{ending}" if dot else name_of(picture)


def _file_system(address: str) -> tuple[Any, str]:
    import fsspec  # type: ignore[import,unused-ignore]

    system, path = fsspec.core.url_to_fs(address)
    return system, path


def _is_local(system: Any) -> bool:
    return "file" in (system.protocol if isinstance(system.protocol, tuple) else (system.protocol,))


@contextlib.contextmanager
def local_copy(address: str) -> Iterator[str]:
    """A file or folder on this machine: the path itself, or a copy that is removed afterwards."""
    system, path = _file_system(address)
    if _is_local(system):
        yield path
        return
    with tempfile.TemporaryDirectory(prefix="lensprof-") as folder:
        copy = os.path.join(folder, path.rstrip("/").rsplit("/", 1)[-1])
        system.get(path, copy, recursive=system.isdir(path))
        yield copy


def put_file(local: str, address: str) -> None:
    """Writes a file whole or not at all: storage that fails in the middle leaves none of that name."""
    system, path = _file_system(address)
    system.makedirs(path.rsplit("/", 1)[0], exist_ok=True)
    if not _is_local(system):  # an object appears when its upload is complete
        system.put_file(local, path)
        return
    part = f"{path}.{os.getpid()}.part"
    try:
        system.put_file(local, part)
        os.replace(part, path)
    finally:
        with contextlib.suppress(FileNotFoundError):
            os.remove(part)


def _put_row(row: Row, address: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "row.json"
        path.write_text(json.dumps(row, sort_keys=True), encoding="utf-8")
        put_file(str(path), address)


def _written_row(address: str) -> Optional[Row]:
    """None also if something else wrote there, or damaged it: then the sequence is done again."""
    system, path = _file_system(address)
    if not system.exists(path):
        return None
    with contextlib.suppress(ValueError):
        row = json.loads(system.cat_file(path))
        return row if isinstance(row, dict) and row.get("state") in STATES else None
    return None


def _reported(row: Row, job: Callable[[Row], None]) -> Row:
    """The row with what the job adds. Its errors become the state `failed` and a sentence: one picture that is broken
    does not end the others."""
    begun = time.perf_counter()
    try:
        job(row)
    except (Error, OSError, ValueError, MemoryError) as error:
        row.update(state="failed", error=str(error) or type(error).__name__)
    row["seconds"] = round(time.perf_counter() - begun, 3)
    return row


def calibrate_sequence(sequence: str, output: str, **options: Any) -> Row:
    """Calibrates the overlapping pictures in a folder, with the options of `lensprof.calibrate`. Writes
    output/stores/NAME.db (its profiles, if they are usable), output/exposures/NAME.json and output/rows/NAME.json;
    returns that row: sequence, name, state (done, not usable, failed), error, images, profiles, corner, findings,
    seconds. If the row exists, it is returned."""
    name = name_of(sequence)
    address = _below(output, f"rows/{name}.json")
    written = _written_row(address)
    if written is not None and written["state"] != "failed":
        return written
    row: Row = {"sequence": sequence, "name": name, "state": "done", "error": "", "images": 0, "profiles": 0,
                "corner": None, "findings": ""}

    def job(row: Row) -> None:
        with local_copy(sequence) as pictures, tempfile.TemporaryDirectory(prefix="lensprof-") as work:
            calibration = calibrate(pictures, **options)
            _describe(calibration, row)
            _put_results(calibration, name, output, work)

    _reported(row, job)
    _put_row(row, address)
    return row


def _describe(calibration: Calibration, row: Row) -> None:
    row["images"] = len(calibration.exposures)
    row["findings"] = "; ".join(finding.text for finding in calibration.findings)
    if calibration.usable:
        row["profiles"] = len(calibration.profiles)
        row["corner"] = calibration.profiles[0].corner_falloff()[0]
    else:
        row["state"] = "not usable"


def _put_results(calibration: Calibration, name: str, output: str, work: str) -> None:
    exposures, database = os.path.join(work, "exposures.json"), os.path.join(work, "store.db")
    calibration.save(exposures)
    if calibration.usable:
        with Store(database, StoreMode.CREATE) as store:
            for profile in calibration.profiles:
                store.put(profile)
        put_file(database, _below(output, f"stores/{name}.db"))
    put_file(exposures, _below(output, f"exposures/{name}.json"))


def correct_pictures(pictures: Sequence[str], output: str, database: str, **options: Any) -> list[Row]:
    """Corrected copies of pictures in `output`, by the profiles of a database, with the options of
    `lensprof.correct_files`; a row for each: picture, copy, state (done, failed), error, seconds. A copy that exists is
    not made again, also if the database or the options are others: give those another output."""
    rows = []
    pictures = _list_of(pictures)
    with local_copy(database) as profiles, tempfile.TemporaryDirectory(prefix="lensprof-") as work:
        for picture in pictures:
            copy = _below(output, _copy_name(picture))
            row: Row = {"picture": picture, "copy": copy, "state": "done", "error": ""}

            def job(row: Row, picture: str = picture, copy: str = copy) -> None:
                system, path = _file_system(copy)
                if system.exists(path):
                    Store(profiles).close()  # a wrong name is an error, whatever copies exist
                    return
                made = os.path.join(work, path.rsplit("/", 1)[-1])
                with local_copy(picture) as source:
                    correct_file(source, None, made, databases=[profiles], threads=1, **options)
                put_file(made, copy)
                os.remove(made)

            rows.append(_reported(row, job))
    return rows


def merge_stores(stores: Sequence[str], into: str) -> tuple[int, int]:
    """Adds the profiles of databases to `into`, a local file that is created if it is missing: the number added, and
    the number that it had. The order does not matter, and merging again adds nothing."""
    added = known = 0
    with Store(into, StoreMode.CREATE) as whole:
        for address in sorted(stores):
            with local_copy(address) as path, Store(path) as part:
                new, old = whole.merge(part)
                added, known = added + new, known + old
    return added, known


def stores_of(output: str) -> list[str]:
    """The databases that calibrate_sequence wrote."""
    system, path = _file_system(_below(output, "stores"))
    files = system.ls(path, detail=False) if system.isdir(path) else []
    return sorted(system.unstrip_protocol(file) for file in files if file.endswith(".db"))


def write_table(rows: Sequence[Row], address: str) -> None:
    """The rows as one Parquet file."""
    import pyarrow  # type: ignore[import,unused-ignore]
    import pyarrow.parquet  # type: ignore[import,unused-ignore]

    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "table.parquet")
        pyarrow.parquet.write_table(pyarrow.Table.from_pylist(list(rows)), path)
        put_file(path, address)


def _list_of(addresses: Sequence[str]) -> list[str]:
    if isinstance(addresses, str):
        raise TypeError(f"{addresses}: is one address; give a list of them")
    return list(addresses)


def calibrate_sequences(sequences: Sequence[str], output: str, client: Any, **options: Any) -> list[Row]:
    """calibrate_sequence on the workers of a Dask client. Writes output/calibrations.parquet, and joins the databases in
    output/profiles.db. The rows are in the order of the sequences; a worker that dies becomes a row, too."""
    sequences = _list_of(sequences)
    futures = client.map(calibrate_sequence, sequences, output=output, pure=False, retries=2, **options)
    rows = [_row_of(future, {"sequence": sequence, "name": name_of(sequence), "images": 0, "profiles": 0,
                             "corner": None, "findings": ""}) for future, sequence in zip(futures, sequences)]
    write_table(rows, _below(output, "calibrations.parquet"))
    with tempfile.TemporaryDirectory(prefix="lensprof-") as work:
        whole = os.path.join(work, "profiles.db")
        merge_stores(stores_of(output), whole)
        put_file(whole, _below(output, "profiles.db"))
    return rows


def correct_all(pictures: Sequence[str], output: str, database: str, client: Any, batch: int = 32,
                **options: Any) -> list[Row]:
    """correct_pictures on the workers of a Dask client, `batch` pictures a task. Writes output/corrections.parquet."""
    pictures = _list_of(pictures)
    batches = [pictures[i:i + batch] for i in range(0, len(pictures), batch)]
    futures = client.map(correct_pictures, batches, output=output, database=database, pure=False, retries=2, **options)
    rows: list[Row] = []
    for future, part in zip(futures, batches):
        result = _row_of(future, {})
        rows += result if isinstance(result, list) else [{"picture": picture, "copy": "", **result} for picture in part]
    write_table(rows, _below(output, "corrections.parquet"))
    return rows


def _row_of(future: Any, unknown: Row) -> Any:
    """What a task returned; if its worker died or ran out of memory, the row `unknown` with the reason."""
    error = future.exception()
    if error is None:
        return future.result()
    text = str(error).splitlines()[0] if str(error) else type(error).__name__
    return {**unknown, "state": "failed", "error": text, "seconds": 0.0}
