"""Progress, messages and cancellation of the photograph library."""
from __future__ import annotations

import contextlib
import warnings
from ctypes import byref
from typing import Any, Callable, Iterator, Optional, Union

from . import _abi
from ._abi import Severity
from ._library import initialised
from ._paths import text
from ._progress import _interrupts

Progress = Union[Callable[[str, float], Optional[bool]], bool, None]
"""A function of a step and the fraction of it that is done, which cancels the call if it returns True or raises; True
for a bar, if tqdm is installed."""


class Notice(UserWarning):
    """A message of the library about a file or scene, short of an error. Warnings are issued by `warnings.warn`."""


def _bar() -> Optional[Callable[[str, float], Optional[bool]]]:
    """A progress bar, if tqdm is installed."""
    try:
        from tqdm import tqdm  # type: ignore[import,unused-ignore]
    except ImportError:
        return None
    bars: dict[str, Any] = {}

    def show(step: str, done: float) -> None:
        if step not in bars:
            for other in bars.values():
                other.close()
            bars[step] = tqdm(total=100, desc=step, unit="%", leave=False)
        if bars[step].n != round(100 * done):
            bars[step].n = round(100 * done)
            bars[step].refresh()

    return show


@contextlib.contextmanager
def calling_events(progress: Progress) -> Iterator[Any]:
    """The raw events of one call. The functions are called by any thread of the library, one at a time. An exception
    cancels the call, and propagates from it."""
    function = _bar() if progress is True else progress or None
    if function is not None and not callable(function):
        raise TypeError("progress takes a function of a step and the fraction done, True or None")
    raised: list[BaseException] = []
    notices: list[str] = []

    def on_step(step: bytes, done: float, _detail: bytes, _user: Any) -> int:
        try:
            return 1 if interrupted or raised or (function and function(step.decode(), done)) else 0
        except BaseException as exception:  # must not cross C
            raised.append(exception)
            return 1

    def on_notice(notice: Any, _user: Any) -> None:
        if notice.contents.severity == Severity.WARNING:
            item, sentence = text(notice.contents.item), notice.contents.text.decode("utf-8", "replace")
            notices.append(f"{item}: {sentence}" if item else sentence)

    events = initialised(_abi.Events)
    events.progress, events.notice = _abi.OnStep(on_step), _abi.OnNotice(on_notice)
    try:
        with _interrupts() as interrupted:
            yield byref(events)
    finally:
        if raised:
            raise raised[0]
    for notice in notices:
        warnings.warn(notice, Notice, stacklevel=4)
