"""How C structures look in Python.

A public class inherits from `Value` (or `Struct`) and the raw structure of `_abi`. Plain numbers are used as they are;
the descriptors below show the other fields: texts as str, arrays as NumPy views, enumerations as enumerations and inner
structures as public classes that share the outer one's memory.
"""
from __future__ import annotations

import ctypes
import datetime
import operator
from typing import TYPE_CHECKING, Any, Generic, Iterable, Optional, Sequence, Type, TypeVar, Union

import numpy as np
import numpy.typing as npt

from ._library import initialise

if TYPE_CHECKING:
    from typing_extensions import dataclass_transform
else:
    def dataclass_transform(**_how: bool):
        return lambda cls: cls

T = TypeVar("T")

default: Any = object()
"""The library's default, of a field that is a plain number."""

_LIMITS: dict[type, tuple[int, int]] = {ctypes.c_uint32: (0, 2**32 - 1), ctypes.c_uint64: (0, 2**64 - 1),
                                       ctypes.c_int64: (-2**63, 2**63 - 1)}


def integer(value: Any, what: str, kind: type = ctypes.c_uint32) -> int:
    """The value as an int that the C type holds; ctypes itself would wrap it around."""
    number = operator.index(value)
    low, high = _LIMITS[kind]
    if not low <= number <= high:
        raise ValueError(f"{what} is {number}; give {low}..{high}")
    return number


def _raw(cls: type) -> Any:
    """The structure of `_abi` that a public class wraps."""
    return next(base for base in cls.__mro__ if "_fields_" in vars(base))


@dataclass_transform(kw_only_default=True)
class Struct:
    """Fields are given by name; omitted ones have the library's defaults. Unknown names are errors."""

    def __init_subclass__(cls) -> None:
        for name in [name for name, value in vars(cls).items() if value is default]:
            delattr(cls, name)  # the raw structure has the field

    def __init__(self, **fields: Any):
        self._set_defaults()
        for name, value in fields.items():
            setattr(self, name, value)

    def _set_defaults(self) -> None:
        initialise(self)

    @classmethod
    def _names(cls: Any) -> list[str]:
        shown = {field.field: name for base in cls.__mro__ for name, field in vars(base).items()
                 if isinstance(field, _Field)}
        return [shown.get(field[0], field[0]) for field in _raw(cls)._fields_
                if field[0] not in ("struct_size", "image_quality_size", "reserved", "reserved2", "reserved3")]

    def __setattr__(self, name: str, value: Any) -> None:
        if not name.startswith("_"):
            if not hasattr(type(self), name):
                raise AttributeError(f"{type(self).__name__} has no field {name}; it has {', '.join(self._names())}")
            kind = dict(_raw(type(self))._fields_).get(name)
            if kind in _LIMITS:
                value = integer(value, f"{type(self).__name__}.{name}", kind)
        super().__setattr__(name, value)

    def __repr__(self) -> str:
        def shown(value: Any) -> str:
            if not isinstance(value, np.ndarray):
                return repr(value)
            return repr(value.tolist()) if value.size <= 8 else f"<{' x '.join(map(str, value.shape))} {value.dtype}>"

        return f"{type(self).__name__}({', '.join(f'{n}={shown(getattr(self, n))}' for n in self._names())})"


class Value(Struct):
    """A structure that is a plain value: it can be compared, copied and pickled."""

    def copy(self: T) -> T:
        """An independent copy."""
        return type(self).from_buffer_copy(self)  # type: ignore[attr-defined]

    def __eq__(self, other: Any) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        return all(np.array_equal(getattr(self, n), getattr(other, n)) if isinstance(getattr(self, n), np.ndarray)
                   else getattr(self, n) == getattr(other, n) for n in self._names())

    __hash__ = None  # type: ignore[assignment]


class _Field:
    """A field of the raw structure, `field`, which has the same name unless stated."""

    field = ""

    def __set_name__(self, owner: type, name: str) -> None:
        self.name, self.field = name, self.field or name
        self.raw = vars(_raw(owner))[self.field]
        self.kind = dict(_raw(owner)._fields_)[self.field]


class Text(_Field):
    """UTF-8 in a char array, as str."""

    def __get__(self, instance: Any, owner: Optional[type] = None) -> str:
        if instance is None:
            return self  # type: ignore[return-value]
        return self.raw.__get__(instance).decode("utf-8", "surrogateescape")

    def __set__(self, instance: Any, value: str) -> None:
        text, room = value.encode("utf-8", "surrogateescape"), ctypes.sizeof(self.kind)
        if b"\0" in text or len(text) >= room:
            raise ValueError(f"{self.name} holds at most {room - 1} bytes of UTF-8, none of them 0; shorten {value!r}")
        place = ctypes.addressof(instance) + self.raw.offset
        ctypes.memmove(place, text.ljust(room, b"\0"), room)  # ctypes would leave the rest of a longer text


class Captured(Text):
    """A date and time as in EXIF, as a datetime without time zone; None if it is unknown."""

    def __get__(self, instance: Any, owner: Optional[type] = None) -> Optional[datetime.datetime]:  # type: ignore[override]
        if instance is None:
            return self  # type: ignore[return-value]
        time, _, fraction = super().__get__(instance).partition(".")
        try:
            return datetime.datetime.strptime(f"{time}.{fraction[:6] or 0}", "%Y:%m:%d %H:%M:%S.%f")
        except ValueError:
            return None

    def __set__(self, instance: Any, value: Optional[datetime.datetime]) -> None:  # type: ignore[override]
        super().__set__(instance, "" if value is None else value.strftime("%Y:%m:%d %H:%M:%S.%f"))


class UnixTime(_Field):
    """Seconds since 1970 as a datetime in UTC; None for 0."""

    def __init__(self, field: str):
        self.field = field

    def __get__(self, instance: Any, owner: Optional[type] = None) -> Optional[datetime.datetime]:
        if instance is None:
            return self  # type: ignore[return-value]
        seconds = self.raw.__get__(instance)
        return _EPOCH + datetime.timedelta(seconds=seconds) if seconds else None

    def __set__(self, instance: Any, value: Optional[datetime.datetime]) -> None:
        if value is not None and value.tzinfo is None:
            raise ValueError(f"{self.name} takes a datetime with a time zone, such as datetime.now(timezone.utc)")
        self.raw.__set__(instance, 0 if value is None else (value - _EPOCH) // datetime.timedelta(seconds=1))


_EPOCH = datetime.datetime(1970, 1, 1, tzinfo=datetime.timezone.utc)


class Vector(_Field):
    """A C array of numbers as a NumPy view on the structure's memory."""

    def __init__(self, writable: bool = True):
        self.writable = writable

    def __get__(self, instance: Any, owner: Optional[type] = None) -> npt.NDArray[Any]:
        if instance is None:
            return self  # type: ignore[return-value]
        view = np.ctypeslib.as_array(self.raw.__get__(instance))
        view.flags.writeable = self.writable
        return view

    def __set__(self, instance: Any, value: Union[Sequence[float], npt.NDArray[Any]]) -> None:
        numbers = np.asarray(value)
        if numbers.shape != (self.kind._length_,):
            raise ValueError(f"{self.name} holds {self.kind._length_} numbers, not an array of shape {numbers.shape}")
        self.raw.__set__(instance, self.kind(*numbers.tolist()))


class Enumerated(_Field, Generic[T]):
    """A number as a member of an enumeration."""

    def __init__(self, enum: Type[T]):
        self.enum = enum

    def __get__(self, instance: Any, owner: Optional[type] = None) -> T:
        if instance is None:
            return self  # type: ignore[return-value]
        return self.enum(self.raw.__get__(instance))  # type: ignore[call-arg]

    def __set__(self, instance: Any, value: Union[T, int]) -> None:
        self.raw.__set__(instance, int(self.enum(value)))  # type: ignore[call-arg, call-overload]


class Nested(_Field, Generic[T]):
    """An inner structure; assigning copies."""

    def __init__(self, cls: Type[T]):
        self.cls = cls

    def __get__(self, instance: Any, owner: Optional[type] = None) -> T:
        if instance is None:
            return self  # type: ignore[return-value]
        return self.cls.from_buffer(self.raw.__get__(instance))  # type: ignore[attr-defined]

    def __set__(self, instance: Any, value: T) -> None:
        self.raw.__set__(instance, value)


class Flag(_Field):
    """0 or 1 as bool."""

    def __get__(self, instance: Any, owner: Optional[type] = None) -> bool:
        if instance is None:
            return self  # type: ignore[return-value]
        return bool(self.raw.__get__(instance))

    def __set__(self, instance: Any, value: bool) -> None:
        self.raw.__set__(instance, int(bool(value)))


def one_or_three(value: Any, cls: type, what: str) -> list[Any]:
    """A value for all channels, or three of them."""
    values = [value] if isinstance(value, cls) else list(value)
    if len(values) not in (1, 3) or not all(isinstance(v, cls) for v in values):
        raise TypeError(f"{what} takes one {cls.__name__} for all channels, or three")
    return values


class Curves(_Field, Generic[T]):
    """An array of three structures with a valid count in another field (1 or 3): a tuple that shares memory.

    Assigning one value or three copies them and sets the count.
    """

    def __init__(self, cls: Type[T], count: str):
        self.cls, self.count = cls, count

    def __get__(self, instance: Any, owner: Optional[type] = None) -> tuple[T, ...]:
        if instance is None:
            return self  # type: ignore[return-value]
        array, count = self.raw.__get__(instance), min(getattr(instance, self.count), 3)
        return tuple(self.cls.from_buffer(array[i]) for i in range(count))  # type: ignore[attr-defined]

    def __set__(self, instance: Any, value: Union[T, Iterable[T]]) -> None:
        values = one_or_three(value, self.cls, self.name)
        copies = [v.copy() for v in values]  # they may come from this very array
        array = self.raw.__get__(instance)
        for i, copy in enumerate(copies):
            array[i] = copy
        setattr(instance, self.count, len(copies))


class Numbers(_Field):
    """An array of numbers with a valid count in another field: a tuple of floats."""

    def __init__(self, count: str):
        self.count = count

    def __get__(self, instance: Any, owner: Optional[type] = None) -> tuple[float, ...]:
        if instance is None:
            return self  # type: ignore[return-value]
        return tuple(self.raw.__get__(instance)[:getattr(instance, self.count)])


class Count(_Field):
    """The number of structures or bytes that a pointer refers to. It is set together with the pointer."""

    def __init__(self, instead: str = "assign one or three curves"):
        self.instead = instead

    def __get__(self, instance: Any, owner: Optional[type] = None) -> int:
        if instance is None:
            return self  # type: ignore[return-value]
        return self.raw.__get__(instance)

    def __set__(self, instance: Any, value: int) -> None:
        raise AttributeError(f"{self.name} cannot be set; {self.instead} instead")


class Referenced(_Field, Generic[T]):
    """A pointer to structures: copies of what is assigned, kept alive by this structure. A tuple, empty for NULL,
    which None assigns where it is `optional`."""

    def __init__(self, cls: Type[T], count: str, optional: bool = False):
        self.cls, self.count, self.optional = cls, count, optional

    def __get__(self, instance: Any, owner: Optional[type] = None) -> tuple[T, ...]:
        if instance is None:
            return self  # type: ignore[return-value]
        array = vars(instance).get("_" + self.name) or ()
        return tuple(self.cls.from_buffer(item) for item in array)  # type: ignore[attr-defined]

    def __set__(self, instance: Any, value: Union[T, Iterable[T], None]) -> None:
        values = () if value is None and self.optional else one_or_three(value, self.cls, self.name)
        self._point(instance, (_raw(self.cls) * len(values))(*values) if values else None)
        vars(_raw(type(instance)))[self.count].__set__(instance, len(values))

    def _point(self, instance: Any, array: Any) -> None:
        self.raw.__set__(instance, array)
        vars(instance)["_" + self.name] = array  # ctypes keeps it alive too, but does not show it


class OptionalReference(Referenced[T]):
    """A pointer to one structure, or None for NULL."""

    def __init__(self, cls: Type[T]):
        super().__init__(cls, "")

    def __get__(self, instance: Any, owner: Optional[type] = None) -> Optional[T]:  # type: ignore[override]
        found = super().__get__(instance, owner)
        return found if instance is None else found[0] if found else None  # type: ignore[return-value]

    def __set__(self, instance: Any, value: Optional[T]) -> None:  # type: ignore[override]
        if not (value is None or isinstance(value, self.cls)):
            raise TypeError(f"{self.name} takes a {self.cls.__name__} or None")
        values = () if value is None else (value,)
        array = (_raw(self.cls) * len(values))(*values)
        self._point(instance, array if values else None)


class Bytes(_Field):
    """A pointer to bytes: a copy of what is assigned, kept alive by this structure, or None for NULL."""

    def __init__(self, count: str):
        self.count = count

    def __get__(self, instance: Any, owner: Optional[type] = None) -> Optional[bytes]:
        if instance is None:
            return self  # type: ignore[return-value]
        return vars(instance).get("_" + self.name)

    def __set__(self, instance: Any, value: Any) -> None:
        data = None if value is None else memoryview(value).tobytes()
        vars(instance)["_" + self.name] = data
        self.raw.__set__(instance, ctypes.cast(ctypes.c_char_p(data), ctypes.c_void_p))
        vars(_raw(type(instance)))[self.count].__set__(instance, len(data or b""))
