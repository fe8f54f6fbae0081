"""Corrected copies of picture files; see lensprof/photo.h."""
from __future__ import annotations

import contextlib
from ctypes import byref, c_uint32
from typing import TYPE_CHECKING, Any, Iterable, Optional, Sequence, TypedDict

from . import _abi
from ._abi import CopyExposure
from ._events import Progress, calling_events
from ._library import check, photo
from ._paths import PathLike, raw_path, set_databases
from ._struct import Enumerated, Flag, Struct, default

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .calibration import Calibration


class CorrectOptions(TypedDict, total=False):
    """How copies are corrected. exposure: CopyExposure.MEAN, KEEP or REFERENCE. linear: irradiance as float. overwrite:
    replace existing files even if they were made from other pictures. threads: 0 = all cores. force_falloff: correct
    also pictures whose falloff was corrected before. strength: of the falloff correction; gain_cap: its largest gain,
    0 = unlimited. simulate: add the falloff instead. dither: ordered dither instead of rounding in 8 bit pictures.
    chroma: correct only the colour of the falloff. databases: without a calibration, profile databases; none = the
    user's own and the installed one. progress: see Progress."""

    exposure: CopyExposure
    linear: bool
    overwrite: bool
    threads: int
    force_falloff: bool
    strength: float
    gain_cap: float
    simulate: bool
    dither: bool
    chroma: bool
    databases: Sequence[PathLike]
    progress: Progress


class _RawOptions(Struct, _abi.CorrectOptions):
    exposure: Enumerated[CopyExposure] = Enumerated(CopyExposure)
    linear: Flag = Flag()
    overwrite: Flag = Flag()
    threads: int = default
    force_falloff: Flag = Flag()
    strength: float = default
    gain_cap: float = default
    simulate: Flag = Flag()
    dither: Flag = Flag()
    chroma: Flag = Flag()

    def __init__(self, databases: Sequence[PathLike] = (), **fields: Any):
        super().__init__(**fields)
        set_databases(self, databases)


def correct_files(copies: Iterable[tuple[PathLike, PathLike]], calibration: Optional[Calibration] = None,
                  **options: Unpack[CorrectOptions]) -> int:
    """Writes corrected copies (source, target) of pictures of a calibrated scene; without a calibration with the profile
    that the databases have for their camera, lens and setting. Returns the number of copies."""
    pairs = [(raw_path(source), raw_path(target)) for source, target in copies]
    kind: Any = _abi.Copy * max(len(pairs), 1)
    array = kind(*pairs)
    progress = options.pop("progress", None)
    given, error, written = _RawOptions(**options), _abi.ErrorText(), c_uint32()
    with contextlib.ExitStack() as stack:
        handle = stack.enter_context(calibration._use()) if calibration is not None else None
        events = stack.enter_context(calling_events(progress))
        status = photo().lensprof_correct_files(handle, array, len(pairs), byref(given), events, byref(written),
                                                byref(error))
    check(status, "the pictures cannot be corrected", error)
    return written.value


def correct_file(source: PathLike, calibration: Optional[Calibration], target: PathLike,
                 **options: Unpack[CorrectOptions]) -> None:
    """Writes one corrected copy; as correct_files."""
    correct_files([(source, target)], calibration, **options)
