"""Findings and their codes: what a result was checked for, and what came of it; see lensprof/reason.h."""
from __future__ import annotations

from ctypes import byref
from typing import Any, Callable

from . import _abi
from ._abi import ItemKind, Reason, Severity
from ._library import check, lib
from ._struct import Enumerated, Nested, Numbers, Struct, Text, Value, default


class Item(Value, _abi.Item):
    """The item that a text refers to by index: `index` of its kind, in bytes text_begin to text_begin + text_bytes of
    its UTF-8. Kind NONE if it refers to no item."""

    kind: Enumerated[ItemKind] = Enumerated(ItemKind)
    index: int = default
    text_begin: int = default
    text_bytes: int = default


class Finding(Struct, _abi.Finding):
    """One finding. code: a Reason; severity: a Severity, PASSED if the rule holds; rule_severity: what it finds
    otherwise. value: the numbers that lensprof/reason.h lists for the code; item: the image or shot concerned; text: a
    sentence of these. measured: the number that the rule compares with
    `limit`; both are NaN for a finding without one."""

    code: Enumerated[Reason] = Enumerated(Reason)
    severity: Enumerated[Severity] = Enumerated(Severity)
    rule_severity: Enumerated[Severity] = Enumerated(Severity)
    value_count: int = default
    value: Numbers = Numbers("value_count")
    measured: float = default
    limit: float = default
    item: Nested[Item] = Nested(Item)
    text: Text = Text()


class WithFindings:
    """A result with the findings on it: refusals, warnings and notes; and the rules that hold."""

    _findings: tuple[Finding, ...] = ()

    def _take(self, struct: Any, at: Callable[..., int]) -> None:
        """at(index, finding, error) asks the library for one of those that the fields of the C struct count."""
        count = struct.findings.__get__(self) + struct.passed.__get__(self)
        self._findings = tuple(Finding() for _ in range(count))
        for index, finding in enumerate(self._findings):
            error = _abi.ErrorText()
            check(at(index, byref(finding), byref(error)), f"no finding {index}", error)

    @property
    def findings(self) -> tuple[Finding, ...]:
        return tuple(finding for finding in self._findings if finding.severity is not Severity.PASSED)

    @property
    def passed(self) -> tuple[Finding, ...]:
        return tuple(finding for finding in self._findings if finding.severity is Severity.PASSED)


def reason_name(reason: Reason) -> str:
    """The name of a reason in JSON: that of the member in lower case."""
    return lib.lensprof_reason_name(Reason(reason)).decode()


def reason_text(reason: Reason) -> str:
    """A short sentence for a reason, without the item and the numbers of a result; empty for Reason.NONE."""
    return lib.lensprof_reason_text(Reason(reason)).decode()
