"""Why a result is not usable, or what is doubtful about it, as numbers; see lensprof/reason.h."""
from __future__ import annotations

from . import _abi
from ._abi import ItemKind, Reason
from ._library import lib
from ._struct import Enumerated, Value


class Item(Value, _abi.Item):
    """What a text names by its number: `index` of its kind, in bytes text_begin to text_begin + text_bytes of its UTF-8.
    Kind NONE where it names nothing."""

    kind = Enumerated(ItemKind)
    index: int
    text_begin: int
    text_bytes: int


def reason_name(reason: Reason) -> str:
    """The name of a reason in the JSON of the command line program: that of the member in lower case."""
    return lib.lensprof_reason_name(Reason(reason)).decode()


def reason_text(reason: Reason) -> str:
    """A short sentence for a reason, without the item and the numbers of a result; empty for Reason.NONE."""
    return lib.lensprof_reason_text(Reason(reason)).decode()
