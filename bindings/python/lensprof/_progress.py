"""Progress functions of long calls, and Ctrl-C during them."""
from __future__ import annotations

import contextlib
import signal
import threading
from typing import Any, Callable, Iterator, Optional

from . import _abi
from ._struct import Struct

Function = Callable[[float], Optional[bool]]


class ProgressField:
    """A function or None, which the options keep."""

    def __get__(self, options: Any, owner: Optional[type] = None) -> Optional[Function]:
        return self if options is None else vars(options).get("progress")  # type: ignore[return-value]

    def __set__(self, options: Any, function: Optional[Function]) -> None:
        if not (function is None or callable(function)):
            raise TypeError("progress takes a function or None")
        vars(options)["progress"] = function


class WithProgress(Struct):
    """Options with a field `progress`, called repeatedly with the fraction done (0..1). The call is cancelled if it
    returns True or raises an exception, which then propagates from the call."""

    progress: ProgressField = ProgressField()

    @classmethod
    def _names(cls) -> list[str]:
        return [name for name in super()._names() if name != "progress_user"]


@contextlib.contextmanager
def _interrupts() -> Iterator[list[int]]:
    """Ctrl-C during a call. Python would raise KeyboardInterrupt on entry to a callback from C, where nothing can catch
    it. The signal is therefore only recorded; the callback then cancels the call, and KeyboardInterrupt is raised at
    the end."""
    noted: list[int] = []
    usual = (threading.current_thread() is threading.main_thread()
             and signal.getsignal(signal.SIGINT) is signal.default_int_handler)
    if usual:
        signal.signal(signal.SIGINT, lambda number, _frame: noted.append(number))
    try:
        yield noted
    finally:
        if usual:
            signal.signal(signal.SIGINT, signal.default_int_handler)
    if noted:
        raise KeyboardInterrupt


@contextlib.contextmanager
def calling_function(function: Optional[Function]) -> Iterator[Any]:
    """The C function of a progress function or None, valid within the block, for calls of the library."""
    raised: list[BaseException] = []

    def on_progress(done: float, _user: Any) -> int:
        try:
            return 1 if interrupted or (function and function(done)) else 0
        except BaseException as exception:  # must not cross C
            raised.append(exception)
            return 1

    try:
        with _interrupts() as interrupted:
            yield _abi.Progress(on_progress)
    finally:
        if raised:
            raise raised[0]


@contextlib.contextmanager
def calling(options: Any) -> Iterator[Any]:
    """The raw options for one call of the library, valid within the block; `options` keeps alive what they point to."""
    raw: Any = next(base for base in type(options).__mro__ if "_fields_" in vars(base))
    call = raw.from_buffer_copy(options)
    with calling_function(options.progress) as function:
        call.progress = function
        yield call
