"""Reason codes: why a result is not usable, or what is doubtful about it; see lensprof/reason.h."""
from __future__ import annotations

from . import _abi
from ._abi import ItemKind, Reason
from ._library import lib
from ._struct import Enumerated, Value


class Item(Value, _abi.Item):
    """The item that a text refers to by index: `index` of its kind, in bytes text_begin to text_begin + text_bytes of
    its UTF-8. Kind NONE if it refers to no item."""

    kind = Enumerated(ItemKind)
    index: int
    text_begin: int
    text_bytes: int


def reason_name(reason: Reason) -> str:
    """The name of a reason in JSON: that of the member in lower case."""
    return lib.lensprof_reason_name(Reason(reason)).decode()


def reason_text(reason: Reason) -> str:
    """A short sentence for a reason, without the item and the numbers of a result; empty for Reason.NONE."""
    return lib.lensprof_reason_text(Reason(reason)).decode()
