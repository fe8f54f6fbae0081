"""Arrays as picture files of a temporary folder, from which the library reads them like photographs."""
from __future__ import annotations

import contextlib
import os
import pathlib
import tempfile
from typing import Any, Iterable, Iterator, Optional

import numpy as np

from ._types import Pixels
from .pictures import PictureMetadata, write_picture

_END: Any = object()


@contextlib.contextmanager
def written_frames(frames: Iterable[Pixels], names: Optional[Iterable[str]], times: Optional[Iterable[float]],
                   metadata: Optional[Iterable[PictureMetadata]]) -> Iterator[tuple[str, dict[str, str]]]:
    """A folder with the files of frames, and the name of the frame of each, while the block runs; of an iterator, one
    frame is in memory. What is given for the frames is written as EXIF. The library sorts files by name and
    skips hidden ones: they are numbered if the frames have another order or such names."""
    labels = None if names is None else list(names)
    files = [os.fsencode(f"{label}.png") for label in labels or ()]
    is_sorted = all(a < b for a, b in zip(files, files[1:])) and not any(file.startswith(b".") for file in files)
    columns: dict[str, Any] = {"names": labels, "times": times, "metadata": metadata}
    given = {what: iter(values) for what, values in columns.items() if values is not None}
    with tempfile.TemporaryDirectory() as folder:
        written: dict[str, str] = {}
        for number, frame in enumerate(frames):
            row = {what: next(values, _END) for what, values in given.items()}
            for what in (what for what, value in row.items() if value is _END):
                raise ValueError(f"{number} {what} for more frames: give one for each frame")
            if not isinstance(frame, np.ndarray) or frame.dtype not in (np.uint8, np.uint16):
                raise TypeError(f"frame {number} has samples of {getattr(frame, 'dtype', type(frame))}; give uint8 or uint16")
            name = row.get("names", f"frame{number:05d}")
            if not isinstance(name, str):
                raise TypeError(f"names has {name!r}; give texts")
            if not name or pathlib.PurePath(name).name != name or name in written.values():
                raise ValueError(f"{name!r}: is not the name of a frame; give each its own, without folders")
            if not isinstance(row.get("metadata", PictureMetadata()), PictureMetadata):
                raise TypeError(f"metadata has {row['metadata']!r}; give a PictureMetadata for each frame")
            stated = PictureMetadata() if metadata is None else row["metadata"].copy()
            if times is not None:
                if not 0 < row["times"] < float("inf"):
                    raise ValueError(f"times has {row['times']!r}; give exposure times in s")
                stated.exposure_time_s = row["times"]
            file = f"{name}.png" if is_sorted else f"{number:05d} {name}.png"
            write_picture(os.path.join(folder, file), frame, metadata=stated)
            written[file] = name
        for what in (what for what, values in given.items() if next(values, _END) is not _END):
            raise ValueError(f"more {what} than the {len(written)} frames: give one for each frame")
        yield folder, written
