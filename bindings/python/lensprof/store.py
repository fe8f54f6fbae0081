"""The profile database (SQLite); see lensprof/store.h."""
from __future__ import annotations

import ctypes
import os
from ctypes import POINTER, byref, c_int64, c_uint32
from contextlib import ExitStack, contextmanager
from typing import Any, Iterator, List, Optional, Sequence, Union

from . import _abi
from ._abi import CameraKind, DistanceRule, Reason, ResponseFrom, Status, StoreMode, StoreNames
from ._library import Error, Handle, check, lib
from ._paths import PathLike, optional_text
from ._struct import Enumerated, Flag, Nested, Struct, Text, Value, Vector, default, integer
from .profile import CameraModel, Profile, ProfileKey, Provenance


class StoreRow(Value, _abi.StoreRow):
    """A row of a listing: id, key and provenance of a profile. damaged: the row has impossible values; its key and
    provenance are unknown, and Store.get reports what is wrong."""

    id: int = default
    damaged: Flag = Flag()
    key: Nested[ProfileKey] = Nested(ProfileKey)
    provenance: Nested[Provenance] = Nested(Provenance)


class LookupOptions(Struct, _abi.LookupOptions):
    """Options of Store.lookup. distance_rule: what to use if the focus distance is unknown. with_doubt: use profiles
    with a doubt like others. any_processing: ignore the processing of the key. force_falloff: use falloffs of
    uncorrected pictures also for keys with processing CORRECTED. response_alone: return the camera's response if no
    falloff is found."""

    distance_rule: Enumerated[DistanceRule] = Enumerated(DistanceRule)
    with_doubt: Flag = Flag()
    any_processing: Flag = Flag()
    force_falloff: Flag = Flag()
    response_alone: Flag = Flag()


class Lookup(Value, _abi.Lookup):
    """How Store.lookup found its answer.

    The falloff: id[:rows] and weight[:rows] of the profiles used, nearest first; exact if the answer is one of them,
    unchanged; distance to the nearest; name_score. The response: response_from is its origin, response_id and
    response_weight[:response_rows] the profiles used; camera_kind is the kind of camera. Standard errors: sigma of M in
    the corner, with the parts falloff_sigma, distance_sigma and sensor_sigma, and response_sigma, of ln gamma.
    falloff_store and response_store: indices of the databases in lookup_in. reason: warnings; their codes are
    `reasons`. nearest: if no lens has the name, the lenses with the most similar names.
    """

    exact: Flag = Flag()
    rows: int = default
    id: Vector = Vector(writable=False)
    weight: Vector = Vector(writable=False)
    distance: float = default
    sigma: float = default
    name_score: float = default
    reason: Text = Text()
    reason_code: Vector = Vector(writable=False)
    falloff_sigma: float = default
    distance_sigma: float = default
    sensor_sigma: float = default
    response_sigma: float = default
    response_from: Enumerated[ResponseFrom] = Enumerated(ResponseFrom)
    camera_kind: Enumerated[CameraKind] = Enumerated(CameraKind)
    falloff_store: int = default
    response_store: int = default
    response_rows: int = default
    response_id: Vector = Vector(writable=False)
    response_weight: Vector = Vector(writable=False)

    @property
    def reasons(self) -> tuple[Reason, ...]:
        """The Reason of each sentence in `reason`."""
        return tuple(Reason(code) for code in self.reason_code.tolist() if code != Reason.NONE)

    @property
    def nearest(self) -> tuple[str, ...]:
        texts = vars(_abi.Lookup)["nearest"].__get__(self)
        names = (bytes(text).split(b"\0")[0].decode("utf-8", "surrogateescape") for text in texts)
        return tuple(name for name in names if name)


class StoreFault(Value, _abi.StoreFault):
    """A fault found by Store.check: id of the profile, 0 for the file as a whole, and the reason."""

    id: int = default
    reason: Text = Text()


class StoreSummary(Value, _abi.StoreSummary):
    """A lens or a camera, with a summary of its profiles: their number, also by Processing, the number of distinct
    cameras or lenses named with it (others), and (smallest, largest) of focal_mm, aperture and distance_m."""

    camera_maker: Text = Text()
    camera_model: Text = Text()
    lens: Text = Text()
    profiles: int = default
    others: int = default
    processing: Vector = Vector(writable=False)
    focal_mm: Vector = Vector(writable=False)
    aperture: Vector = Vector(writable=False)
    distance_m: Vector = Vector(writable=False)


class StoreStats(Value, _abi.StoreStats):
    """Contents of a database: counts, (smallest, largest) of focal_mm, aperture and distance_m, bytes, layout; method
    and source, the groups with the most profiles, as dictionaries of their counts."""

    profiles: int = default
    cameras: int = default
    lenses: int = default
    units: int = default
    methods: int = default
    sources: int = default
    with_grid: int = default
    with_covariance: int = default
    with_doubt: int = default
    bytes: int = default
    layout: int = default
    processing: Vector = Vector(writable=False)
    focal_mm: Vector = Vector(writable=False)
    aperture: Vector = Vector(writable=False)
    distance_m: Vector = Vector(writable=False)

    @property
    def method(self) -> dict[str, int]:
        """Profiles by method."""
        return self._groups("method")

    @property
    def source(self) -> dict[str, int]:
        """Profiles by source."""
        return self._groups("source")

    def _groups(self, field: str) -> dict[str, int]:
        return {group.name.decode("utf-8", "surrogateescape"): group.profiles
                for group in vars(_abi.StoreStats)[field].__get__(self) if group.profiles}


class Store(Handle):
    """A profile database; `with Store(path, StoreMode.CREATE) as store:`. Every call is one transaction."""

    def __init__(self, path: Union[PathLike, bytes], mode: StoreMode = StoreMode.READ):
        pointer, error = POINTER(_abi.Store)(), _abi.ErrorText()
        name = os.fsencode(path)
        if b"\0" in name:
            raise ValueError(f"{path!r}: a path holds no zero bytes; name a file")
        check(lib.lensprof_store_open(name, StoreMode(mode), byref(pointer), byref(error)),
              f"{path!r}: cannot be opened", error)
        super().__init__(pointer, lib.lensprof_store_close)
        self._path = os.fsdecode(path)

    def __repr__(self) -> str:
        return f"Store({self._path!r})"

    def _call(self, function: Any, *arguments: Any) -> None:
        """Calls a function that takes a store first and an error text last."""
        error = _abi.ErrorText()
        with self._use() as store:
            check(function(store, *arguments, byref(error)), f"{function.__name__} failed", error)

    def put(self, profile: Profile) -> int:
        """Adds a profile and returns its id. Profiles with the same key stay; `find` returns the newest."""
        number = c_int64()
        self._call(lib.lensprof_store_put, byref(profile), byref(number))
        return number.value

    def find(self, key: ProfileKey) -> tuple[int, Profile]:
        """Id and profile of the newest with an equal key; lensprof.Error NOT_FOUND if no profile matches.

        Texts are compared without ASCII case and outer blanks, numbers to 1e-6 relative; UNKNOWN equals only UNKNOWN.
        """
        profile, number = Profile(), c_int64()
        self._call(lib.lensprof_store_find, byref(key), byref(profile), byref(number))
        return number.value, profile

    def lookup(self, key: ProfileKey, options: Optional[LookupOptions] = None) -> tuple[Profile, Lookup]:
        """The profile for a setting, composed of the lens's falloff (stored or predicted from other settings) and the
        camera's response, and how it was found. Raises lensprof.Error NOT_FOUND, with the reason and, as `lookup`, its
        Lookup, if no profile is near enough."""
        return lookup_in([self], key, options)

    @contextmanager
    def transaction(self) -> Iterator[None]:
        """`with store.transaction():` makes all calls in it one transaction: stored at its end, or rolled back on an
        exception."""
        self._call(lib.lensprof_store_begin)
        try:
            yield
        except BaseException:
            with self._use() as store:
                lib.lensprof_store_rollback(store)
            raise
        self._call(lib.lensprof_store_commit)

    def find_same(self, profile: Profile) -> int:
        """The id of a stored profile with the same key, content and provenance, whatever its method and software; 0 if
        it is not stored. Intended for imports, before put(): the store must be open for writing."""
        found = c_int64()
        self._call(lib.lensprof_store_find_same, byref(profile), byref(found))
        return found.value

    def merge(self, other: Store) -> tuple[int, int]:
        """Adds the profiles of another open database that find_same() does not find; returns the number added and the
        number already present. All or none."""
        if not isinstance(other, Store):
            raise TypeError(f"merge takes a Store, not {type(other).__name__}")
        if other is self:
            raise ValueError("this Store is the database itself; merge another one")
        added, known = c_uint32(), c_uint32()
        with other._use() as theirs:
            self._call(lib.lensprof_store_merge, theirs, byref(added), byref(known))
        return added.value, known.value

    def check(self) -> tuple[int, List[StoreFault]]:
        """Reads and checks everything: the number of profiles, and all faults."""
        faults: List[StoreFault] = []
        raised: List[BaseException] = []
        profiles = c_uint32()

        def visit(_user: Any, fault: Any) -> int:
            try:
                faults.append(StoreFault.from_buffer_copy(fault.contents))
                return Status.OK
            except BaseException as exception:  # must not cross C
                raised.append(exception)
                return Status.ERROR_CANCELLED

        try:
            self._call(lib.lensprof_store_check, _abi.FaultVisitor(visit), None, byref(profiles), None)
        except Error:
            if raised:
                raise raised[0] from None
            raise
        return profiles.value, faults

    def stats(self) -> StoreStats:
        """A summary of the database."""
        stats = StoreStats()
        self._call(lib.lensprof_store_get_stats, byref(stats))
        return stats

    def get(self, id: int) -> Profile:
        """The profile with an id."""
        profile = Profile()
        self._call(lib.lensprof_store_get, integer(id, "id", c_int64), byref(profile))
        return profile

    def remove(self, id: int) -> None:
        """Removes the profile with an id; lensprof.Error NOT_FOUND if it does not exist."""
        self._call(lib.lensprof_store_remove, integer(id, "id", c_int64))

    def list(self, filter: Optional[ProfileKey] = None) -> List[StoreRow]:
        """Rows in the order camera maker, model, lens, focal, aperture, distance, id.

        filter: its texts and known numbers must match.
        """
        return self._list(StoreRow, _abi.StoreRow, lib.lensprof_store_list, None if filter is None else byref(filter))

    def lenses(self, part: Optional[str] = None) -> List[StoreSummary]:
        """The lenses of the stored profiles by name; with `part` those with that name, or with all its words."""
        return self._list(StoreSummary, _abi.StoreSummary, lib.lensprof_store_list_names, int(StoreNames.LENSES), optional_text(part))

    def cameras(self, part: Optional[str] = None) -> List[StoreSummary]:
        """The cameras of the stored profiles, as for lenses()."""
        return self._list(StoreSummary, _abi.StoreSummary, lib.lensprof_store_list_names, int(StoreNames.CAMERAS), optional_text(part))

    def put_camera(self, camera: CameraModel) -> None:
        """Stores a camera, replacing the one with the same maker, model and variant."""
        self._call(lib.lensprof_store_put_camera, byref(camera))

    def find_camera(self, maker: str, model: str) -> CameraModel:
        """Finds a camera by its EXIF name or common name; maker may be empty. Data in which several cameras of one name
        differ is unknown. Raises lensprof.Error (NOT_FOUND)."""
        camera = CameraModel()
        self._call(lib.lensprof_store_find_camera, optional_text(maker), optional_text(model), byref(camera))
        return camera

    def camera_models(self) -> List[CameraModel]:
        """The whole table of cameras, by maker, model and variant."""
        return self._list(CameraModel, _abi.CameraModel, lib.lensprof_store_list_camera_models)

    def set_key(self, id: int, key: ProfileKey) -> None:
        """Changes the key of the profile with an id; all else stays."""
        self._call(lib.lensprof_store_set_key, integer(id, "id", c_int64), byref(key))

    def _list(self, row: Any, raw: Any, function: Any, *arguments: Any) -> List[Any]:
        """All rows that function(store, *arguments, rows, capacity, count, error) has."""
        rows, found = (raw * 0)(), c_uint32()
        while True:  # until they fit: another process may add rows between two calls
            try:
                self._call(function, *arguments, rows, len(rows), byref(found))
                if found.value <= len(rows):
                    break
            except Error as error:
                if error.status != Status.ERROR_CAPACITY:
                    raise
            rows = (raw * found.value)()
        size = ctypes.sizeof(raw)
        return [row.from_buffer(rows, i * size) for i in range(found.value)]


def lookup_in(stores: Sequence[Store], key: ProfileKey,
              options: Optional[LookupOptions] = None) -> tuple[Profile, Lookup]:
    """Store.lookup in several databases: the falloff of the first that has one for the key, the response of the first
    that has profiles of the camera."""
    profile, how, error = Profile(), Lookup(), _abi.ErrorText()
    with ExitStack() as held:
        # one order for all threads, as each database is locked
        used = {id(store): store for store in sorted(stores, key=id)}
        pointers = {number: held.enter_context(store._use()) for number, store in used.items()}
        handles = (POINTER(_abi.Store) * max(len(stores), 1))(*(pointers[id(store)] for store in stores))
        status = lib.lensprof_store_lookup_in(handles, len(stores), byref(key), byref(options or LookupOptions()),
                                              byref(profile), byref(how), byref(error))
    try:
        check(status, "lensprof_store_lookup_in failed", error)
    except Error as failure:
        failure.lookup = how  # type: ignore[attr-defined]
        raise
    return profile, how
