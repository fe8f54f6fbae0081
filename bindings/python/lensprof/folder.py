"""The whole job of a folder of photographs; see lensprof/photo.h."""
from __future__ import annotations

import json
import pathlib
from ctypes import byref
from typing import Any, Iterable, Sequence, Union

from . import _abi
from ._events import Progress, calling_events
from ._library import check, initialised, photo
from ._paths import PathLike, raw_path, raw_paths, set_databases


def calibrate_folder(paths: Union[PathLike, Iterable[PathLike]], output: PathLike, databases: Sequence[PathLike] = (),
                     store: bool = True, one_lens: bool = False, overwrite: bool = False, threads: int = 0,
                     progress: Progress = None) -> dict[str, Any]:
    """The whole job of a folder: all its panoramas are found, fitted, stored and corrected, other pictures are corrected
    by the databases. A second call does what is missing or has changed. Returns the content of output/calibrate.json
    (docs/json.md)."""
    options = initialised(_abi.FolderOptions, one_lens=int(one_lens), no_store=int(not store), overwrite=int(overwrite),
                          threads=threads)
    set_databases(options, databases)
    error = _abi.ErrorText()
    with calling_events(progress) as events:
        status = photo().lensprof_calibrate_folder(*raw_paths(paths), raw_path(output), byref(options), events, None,
                                                   byref(error))
    check(status, "the folder cannot be calibrated", error)
    return dict(json.loads((pathlib.Path(output) / "calibrate.json").read_text("utf-8")))
