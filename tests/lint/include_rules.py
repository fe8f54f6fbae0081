#!/usr/bin/env python3
"""Layer rules, from the #include lines: which headers each layer may use (docs/architecture.md, section 2).

usage: include_rules.py SOURCE_DIR       list violations; exit 1 if there are any
       include_rules.py --draw SOURCE_DIR   print the rooms of every layer, the rooms that each includes, and their
floors
       include_rules.py --self-check     plant violations in temporary trees; exit 1 if one is not found
"""

import pathlib
import re
import sys
import tempfile

SOURCES = {".c", ".h", ".cpp", ".hpp", ".cc", ".cxx", ".hh", ".inc"}
INCLUDE = re.compile(r'^\s*#\s*include(?:_next)?\s*(?:<([^>]+)>|"([^"]+)"|(\S+))')

FREESTANDING = {"float.h", "limits.h", "stdbool.h", "stddef.h", "stdint.h"}
C_LIBRARY = FREESTANDING | {
    "assert.h",
    "ctype.h",
    "errno.h",
    "fenv.h",
    "inttypes.h",
    "locale.h",
    "math.h",
    "setjmp.h",
    "signal.h",
    "stdarg.h",
    "stdio.h",
    "stdlib.h",
    "string.h",
    "time.h",
}
C_ARITHMETIC = C_LIBRARY - {"locale.h", "setjmp.h", "signal.h", "time.h"}
SYSTEM = {"fcntl.h", "fnmatch.h", "io.h", "psapi.h", "unistd.h", "windows.h", "sys/*"}
INTRINSICS = {"immintrin.h", "smmintrin.h", "arm_neon.h", "cpuid.h"}
CPP_LIBRARY = {"<c++>"}  # every standard C++ header: a name without a dot
CPP_OUTSIDE = {
    "condition_variable",
    "csetjmp",
    "csignal",
    "ctime",
    "filesystem",
    "fstream",
    "future",
    "iostream",
    "locale",
    "mutex",
    "shared_mutex",
    "stop_token",
    "syncstream",
    "thread",
}

CORE_API = {"base.h", "model.h", "geometry.h", "apply.h", "fixed.h", "packed.h", "profile.h", "reason.h", "sensor.h"}
FIT_API = CORE_API | {"sample.h", "exposure_settings.h", "fit.h", "flat.h", "fields.h", "deflicker.h", "online.h",
                      "rendering.h", "trial.h"}
FORMATS_API = FIT_API | {"exposures.h", "hugin.h", "formats.h"}
STORE_API = CORE_API | {"store.h"}
PHOTO_API = FIT_API | STORE_API | {"photo.h"}
WHOLE_API = FORMATS_API | PHOTO_API | {"lensprof.h"}


class Layer:
    """api: public headers; other: headers in angle brackets; private: folders and single headers under src in addition to
    its own folder; never: excluded standard headers."""

    def __init__(self, api, other, private=(), never=frozenset()):
        self.api, self.other, self.private, self.never = api, other, private, never


# The longest matching folder counts.
LAYERS = {
    "src/core": Layer(CORE_API, FREESTANDING | {"math.h", "string.h"}),
    "src/core/kernels": Layer(CORE_API, FREESTANDING | {"string.h"} | INTRINSICS, private=["core"]),
    "src/threads": Layer(set(), CPP_LIBRARY),
    "src/falloff": Layer(CORE_API, C_ARITHMETIC | CPP_LIBRARY | {"Eigen/*"}, ["core"], CPP_OUTSIDE),
    "src/fit": Layer(FIT_API, C_ARITHMETIC | CPP_LIBRARY | {"Eigen/*", "nlopt.h", "nlopt.hpp"},
                     ["core", "falloff", "threads"], CPP_OUTSIDE),
    "src/formats": Layer(
        FORMATS_API, C_ARITHMETIC | CPP_LIBRARY | {"pugixml.hpp", "nlohmann/*"}, ["core", "falloff"], CPP_OUTSIDE
    ),
    "src/store": Layer(STORE_API, C_ARITHMETIC | {"sqlite3.h"}, ["core", "falloff"]),
    "src/photo": Layer(WHOLE_API, C_LIBRARY | CPP_LIBRARY | {"nlohmann/*"}, ["threads", "falloff/rise.hpp", "fit/base/chained.hpp",
                        "fit/base/joined_sets.hpp", "fit/base/location.hpp",
                        "fit/base/mixed_bits.hpp", "fit/base/quantile.hpp", "fit/base/track_pairs.hpp"]),
    "src/cli": Layer(
        WHOLE_API,
        C_LIBRARY | CPP_LIBRARY | {"CLI/*", "cairo-svg.h", "cairo.h", "nlohmann/*"},
        ["photo", "threads", "fit/base/joined_sets.hpp", "fit/base/mixed_bits.hpp"],
    ),
    "examples": Layer(WHOLE_API, C_LIBRARY),
    "bindings": Layer(WHOLE_API, C_LIBRARY | CPP_LIBRARY | {"Python.h", "frei0r.h", "nlohmann/json.hpp"}),
}

# The rooms of a layer, its folders, from the ground up: a room may use those before it. "" is the layer's own folder.
ROOMS = {
    "src/fit": ["base", "problem", "prior", "solver", "verdict", "methods", "methods/transfer_function", "scene",
                "sampling", "flat", "fields", "deflicker", "rendering", "trial", "online", "api"],
    "src/formats": ["text", "falloff", "code", "hugin", "", "any"],
    "src/store": ["file", "names", "profiles", "lookup"],
    "src/photo": ["system", "base", "pictures", "video", "registration", "reconstruction", "report", "scene", "calibration", "cards", "fields", "clip", "correct", "deflicker", "folder", "api"],
    "src/cli": ["program", "report", "page", "fitting", "response", "profiles", "correct", "simulate", "calibrate"],
}

# Headers that only a single room may use.
ROOM_HEADERS = {
    "src/photo/system": SYSTEM,
    "src/photo/calibration": {"Eigen/*"},  # pedestal.cpp
    "src/photo/registration": {"Eigen/*", "opencv2/*", "cpuid.h", "immintrin.h"},  # nearest_features.cpp
    "src/photo/reconstruction": {"sqlite3.h"},
    "src/photo/video": {"Eigen/*", "libavcodec/*", "libavformat/*", "libavutil/*", "libswscale/*", "opencv2/*"},
    "src/cli/fitting": {"zip.h"},
    "src/photo/pictures": {"OpenEXR/*", "cairo.h", "exiv2/*", "fitsio.h", "jerror.h", "jpeglib.h", "jxl/*", "libheif/*", "libraw/*",
                           "png.h", "pugixml.hpp", "tiffio.h", "webp/*", "zlib.h"},
}

# Headers that each public header may include in addition to <stddef.h> and <stdint.h>: nothing above its own layer.
PUBLIC = {
    "base.h": set(),
    "model.h": CORE_API,
    "geometry.h": CORE_API,
    "apply.h": CORE_API,
    "fixed.h": CORE_API,
    "packed.h": CORE_API,
    "profile.h": CORE_API,
    "reason.h": CORE_API,
    "sensor.h": CORE_API,
    "sample.h": FIT_API,
    "exposure_settings.h": CORE_API,
    "fit.h": FIT_API,
    "flat.h": FIT_API,
    "deflicker.h": CORE_API,
    "fields.h": CORE_API,
    "rendering.h": CORE_API,
    "online.h": CORE_API,
    "exposures.h": CORE_API,
    "trial.h": FIT_API,
    "hugin.h": FIT_API,
    "formats.h": FORMATS_API,
    "store.h": STORE_API,
    "photo.h": FIT_API,
    "lensprof.h": FORMATS_API | STORE_API,
}


def matches(header, allowed):
    if header in allowed or ("." not in header and "/" not in header and "<c++>" in allowed):
        return True
    return any(pattern.endswith("/*") and header.startswith(pattern[:-1]) for pattern in allowed)


def layer_of(folder):
    found = [name for name in LAYERS if folder == name or folder.startswith(name + "/")]
    return max(found, key=len, default=None)


def room_of(layer_name, folder):
    return "" if folder == layer_name else folder[len(layer_name) + 1 :]


def check_room(layer_name, folder, target):
    """Within a layer: only the room itself and those below it."""
    rooms = ROOMS.get(layer_name)
    if rooms is None:
        return None
    own, other = room_of(layer_name, folder), room_of(layer_name, target)
    for room in (own, other):
        if room not in rooms:
            return f"{layer_name}/{room} is not in ROOMS of tests/lint/include_rules.py; add it where it belongs"
    if rooms.index(other) > rooms.index(own):
        return f"{other or layer_name} lies above {own or layer_name}, which must not know it"
    return None


def check_quoted(root, path, layer_name, header):
    """A quoted header is named from src, and must be in the layer's own folder or in one that it may see. Outside src
    it is named from its folder."""
    if ".." in header.split("/"):
        return "leads out of its folder by '..'; name it from src"
    if not layer_name.startswith("src/"):
        return None if (path.parent / header).is_file() else f"is not found in {layer_name}"
    owner = header.split("/")[0]
    if (root / "src" / header).is_file():
        target = ("src/" + header).rpartition("/")[0]
        if layer_of(target) == layer_name:
            return check_room(layer_name, path.parent.relative_to(root).as_posix(), target)
        if owner in LAYERS[layer_name].private or header in LAYERS[layer_name].private:
            return None
    if (root / "src" / header).is_file() or any((root / top / header).is_file() for top in ("include", "include/lensprof")):
        return f"is not {layer_name}'s own; it may use public headers as <lensprof/...>" + (
            f" and private ones of {', '.join(LAYERS[layer_name].private)}" if LAYERS[layer_name].private else ""
        )
    if (path.parent / header).is_file():
        return "is not named from src"
    return f"is not found in {layer_name}"


def check_angle(layer_name, header, folder):
    layer = LAYERS[layer_name]
    if header.startswith("lensprof/"):
        name = header[len("lensprof/") :]
        return None if name in layer.api else f"belongs to a layer that {layer_name} must not know"
    if header in layer.never:
        return f"{layer_name} does no input or output, threads or time"
    allowed = layer.other | ROOM_HEADERS.get(folder, set())
    return None if matches(header, allowed) else f"is not among the headers that {layer_name} may use"


def check_public(path, angle, quoted):
    allowed = PUBLIC.get(path.name)
    if allowed is None:
        return "its header is not in the table PUBLIC of tests/lint/include_rules.py; add it with its layer"
    if angle:
        return None if angle in {"stddef.h", "stdint.h"} else "a public header includes stddef.h and stdint.h only"
    return None if quoted in allowed else f"{path.name} must not know {quoted}"


def check_tree(root):
    """Violations as texts, and the number of files checked."""
    violations, files = [], 0
    for path in sorted(p for top in ("src", "include", "examples", "bindings") for p in (root / top).rglob("*")):
        folder = path.parent.relative_to(root).as_posix()
        public = folder == "include/lensprof"
        name = layer_of(folder)
        if (
            path.suffix not in SOURCES
            or not path.is_file()
            or (not public and name is None and not folder.startswith("src"))
        ):
            continue
        files += 1
        if not public and name is None:
            violations.append(
                f"{path.relative_to(root)}: is in no layer; add its folder to LAYERS in tests/lint/include_rules.py"
            )
            continue
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            match = INCLUDE.match(line)
            if not match:
                continue
            angle, quoted, macro = match.groups()
            if macro:
                why = "is not a plain name"
            elif public:
                why = check_public(path, angle, quoted)
            else:
                why = check_angle(name, angle, folder) if angle else check_quoted(root, path, name, quoted)
            if why:
                violations.append(f"{path.relative_to(root)}:{number}: {angle or quoted or macro}: {why}")
    return violations, files


def draw(root):
    """Every room with the rooms that it includes, the ground floor first."""
    below = {}
    for path in sorted(p for p in (root / "src").rglob("*") if p.suffix in SOURCES):
        room = path.parent.relative_to(root / "src").as_posix()
        below.setdefault(room, set())
        for line in path.read_text(encoding="utf-8").splitlines():
            match = INCLUDE.match(line)
            target = match and match.group(2) and match.group(2).rpartition("/")[0]
            if target and target != room:
                below[room].add(target)

    def floor(room, above=()):
        if room in above:
            sys.exit(f"circle: {' -> '.join((*above, room))}")
        return 1 + max((floor(r, (*above, room)) for r in below.get(room, ())), default=-1)

    for layer in sorted({room.split("/")[0] for room in below}):
        rooms = sorted((floor(room), room) for room in below if room.split("/")[0] == layer)
        arrows = sum(r.split("/")[0] == layer for _, room in rooms for r in below[room])
        print(f"{layer}: {len(rooms)} rooms, {arrows} arrows between them")
        for level, room in rooms:
            print(f"  floor {level}  {room:36} {', '.join(sorted(below[room]))}")


GOOD = {
    "include/lensprof/base.h": "#include <stddef.h>\n#include <stdint.h>\n",
    "include/lensprof/store.h": '#include "base.h"\n',
    "src/core/base.c": '#include <lensprof/base.h>\n#include <string.h>\n#include "core/own.h"\n',
    "src/core/own.h": "#include <math.h>\n",
    "src/fit/api/fit.cpp": '#include <vector>\n#include <Eigen/Core>\n#include "core/own.h"\n#include "fit/base/low.hpp"\n'
                           '#include "threads/loop.hpp"\n',
    "src/fit/base/low.hpp": "#include <vector>\n",
    "src/threads/loop.hpp": "#include <mutex>\n#include <thread>\n",
    "src/falloff/low.hpp": "#include <Eigen/Core>\n#include <lensprof/profile.h>\n",
    "src/formats/pto.cpp": '#include <string>\n#include <lensprof/fit.h>\n#include "falloff/low.hpp"\n',
    "src/store/file/store.c": "#include <sqlite3.h>\n#include <lensprof/store.h>\n// #include <fine.h>\n",
    "src/cli/program/run.cpp": '#include <CLI/CLI.hpp>\n#include "cli/program/run.hpp"\n'
                               '#include "threads/loop.hpp"\n',
    "src/cli/program/run.hpp": '#include <lensprof/lensprof.h>\n#include "photo/base/events.hpp"\n',
    "src/photo/base/events.hpp": "#include <lensprof/reason.h>\n",
    "src/photo/system/files.cpp": "#include <sys/stat.h>\n#include <windows.h>\n",
    "src/photo/pictures/picture.cpp": '#include <png.h>\n#include "photo/base/events.hpp"\n#include "threads/loop.hpp"\n',
    "examples/one.c": "#include <stdio.h>\n#include <lensprof/lensprof.h>\n",
}
BAD = [
    ("src/core/base.c", "#include <stdio.h>"),
    ("src/core/base.c", "#include <stdlib.h>"),
    ("src/core/base.c", "#  include <threads.h>"),
    ("src/core/base.c", "#include <lensprof/store.h>"),
    ("src/core/base.c", '#include "fit/base/low.hpp"'),
    ("src/core/base.c", "#include <vector>"),
    ("src/core/base.c", '#include "lensprof/base.h"'),
    ("src/core/base.c", '#include "../fit/api/fit.cpp"'),
    ("src/core/kernels/lane.c", "#include <math.h>"),
    ("src/core/base.c", "#include <immintrin.h>"),
    ("src/core/base.c", "#include HEADER"),
    ("src/fit/api/fit.cpp", "#include <lensprof/store.h>"),
    ("src/fit/api/fit.cpp", "#include <sqlite3.h>"),
    ("src/fit/api/fit.cpp", "#include <lensprof/formats.h>"),
    ("src/fit/api/fit.cpp", '#include "formats/pto.cpp"'),
    ("src/fit/api/fit.cpp", "#include <iostream>"),
    ("src/fit/api/fit.cpp", "#include <mutex>"),
    ("src/fit/api/fit.cpp", "#include <png.h>"),
    ("src/fit/api/fit.cpp", "#include <lensprof/lensprof.h>"),
    ("src/formats/pto.cpp", "#include <nlopt.h>"),
    ("src/formats/pto.cpp", "#include <Eigen/Core>"),
    ("src/falloff/low.hpp", "#include <lensprof/fit.h>"),
    ("src/falloff/low.hpp", '#include "formats/pto.cpp"'),
    ("src/falloff/low.hpp", "#include <sqlite3.h>"),
    ("src/core/base.c", '#include "falloff/low.hpp"'),
    ("src/formats/pto.cpp", '#include "fit/api/fit.cpp"'),
    ("src/formats/pto.cpp", '#include "threads/loop.hpp"'),
    ("src/threads/loop.hpp", "#include <lensprof/base.h>"),
    ("src/threads/loop.hpp", '#include "fit/base/low.hpp"'),
    ("src/fit/api/fit.cpp", "#include <thread>"),
    ("src/formats/pto.cpp", "#include <fstream>"),
    ("src/formats/pto.cpp", "#include <lensprof/store.h>"),
    ("src/store/file/store.c", "#include <lensprof/fit.h>"),
    ("src/store/file/store.c", "#include <unistd.h>"),
    ("src/store/file/store.c", '#include "cli/program/run.hpp"'),
    ("src/cli/program/run.cpp", '#include "core/own.h"'),
    ("src/cli/program/run.cpp", "#include <png.h>"),
    ("src/cli/program/run.cpp", "#include <unistd.h>"),
    ("src/photo/base/events.hpp", "#include <sys/stat.h>"),
    ("src/photo/system/files.cpp", '#include "photo/base/events.hpp"'),
    ("src/photo/base/events.hpp", '#include "cli/program/run.hpp"'),
    ("src/photo/base/events.hpp", '#include "photo/pictures/picture.cpp"'),
    ("src/photo/base/events.hpp", "#include <png.h>"),
    ("src/photo/pictures/picture.cpp", '#include "core/own.h"'),
    ("src/cli/program/run.cpp", "#include <sqlite3.h>"),
    ("src/cli/program/run.cpp", "#include <Eigen/Core>"),
    ("src/cli/program/run.cpp", "#include <nlopt.h>"),
    ("src/cli/program/run.cpp", '#include "store/file/store.c"'),
    ("include/lensprof/base.h", "#include <stdio.h>"),
    ("include/lensprof/base.h", '#include "store.h"'),
    ("include/lensprof/new.h", "#include <stddef.h>"),
    ("src/other/new.c", "#include <stddef.h>"),
    ("examples/one.c", '#include "core/own.h"'),
    ("bindings/python/x.c", "#include <sqlite3.h>"),
    ("src/core/base.c", '#include "own.h"'),
    ("src/fit/base/low.hpp", '#include "fit/api/fit.cpp"'),
    ("src/fit/attic/new.hpp", '#include "fit/base/low.hpp"'),
    ("src/fit/fit.cpp", '#include "fit/base/low.hpp"'),
]


def write_tree(root, tree):
    for name, text in tree.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)


def self_check():
    failures = []
    with tempfile.TemporaryDirectory() as folder:
        write_tree(pathlib.Path(folder), GOOD)
        violations, files = check_tree(pathlib.Path(folder))
        failures += [f"false alarm: {v}" for v in violations]
        if files != len(GOOD):
            failures.append(f"looked at {files} files of {len(GOOD)}")
    for name, line in BAD:
        with tempfile.TemporaryDirectory() as folder:
            write_tree(pathlib.Path(folder), {**GOOD, name: GOOD.get(name, "") + line + "\n"})
            violations, _ = check_tree(pathlib.Path(folder))
            if len(violations) != 1 or not violations[0].startswith(name):
                failures.append(f"{name}: {line}: found {violations}")
    print("\n".join(failures) or f"include_rules: {len(BAD)} planted violations found")
    return 1 if failures else 0


def main():
    if sys.argv[1:] == ["--self-check"]:
        return self_check()
    if len(sys.argv) == 3 and sys.argv[1] == "--draw":
        draw(pathlib.Path(sys.argv[2]))
        return 0
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    violations, files = check_tree(pathlib.Path(sys.argv[1]))
    if files < 20:
        violations.append(f"only {files} files found under {sys.argv[1]}; is it the source folder?")
    print("\n".join(violations) or f"include_rules: {files} files, no violation")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
