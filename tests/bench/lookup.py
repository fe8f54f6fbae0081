#!/usr/bin/env python3
"""lookup.py [FOLDER]: how well lookups predict falloffs between the stored settings, on Lensfun's database.

Leave one out. All of FOLDER's .xml (the installed liblensfun-data-v1) is imported into a new database. Then, for every
lens (with its crop factor and camera), focal length and aperture, the rows at all focus distances are removed in a
transaction, their settings are looked up (lensprof_store_lookup), and the transaction is rolled back. Lensfun's rule
(lensfun_rule.py) gets the same rows. Error: RMS of M's over r = 0, 1/32 .. 1, where M = 1 + k1 r^2 + k2 r^4 + k3 r^6.
Doubtful rows, which lookups skip by default, are neither used nor queried, in both cases. A lens with a single focal
length and aperture has no other rows and is not queried.

Two halves: the axes and most constants of the prediction were chosen on the lenses with an even CRC-32 of
"maker|model|mount,mount|crop factor", as in the file; the test half contains none of those lenses.

Then the same lenses are queried without a focus distance (distance.py).

Exit code 1: on the test half the mean error is not at least a quarter below Lensfun's; 77: there is no data.
"""
import collections
import os
import pathlib
import re
import sys
import tempfile
import zlib
from xml.etree import ElementTree

import numpy as np

import lensfun_rule
import tools
from report import header, number, row

sys.path.insert(0, str(tools.ROOT / "bindings" / "python"))
os.environ.setdefault("LENSPROF_LIBRARY", str(tools.ROOT / "build" / "liblensprof.so"))
import lensprof  # noqa: E402
import distance  # noqa: E402

TEST, CHOSEN, ALL = "test half", "other half", "all"
TARGET = 0.75  # ratio to Lensfun's mean error
INSTALLED = "/usr/share/lensfun/version_1"
RADII = np.linspace(0.0, 1.0, 33)
REASON = re.compile(r".*?has no profile for this setting[^a-z]*(.*?)( \(LENSPROF_[A-Z_]*\))?$", re.S)
POWERS = np.stack([RADII ** 2, RADII ** 4, RADII ** 6])

Row = collections.namedtuple("Row", "id key setting k is_test")
# ours, theirs, corner: errors, None if refused for `reason`; inner: error at r = 0.5 divided by its standard error from
# the
# profile's covariance; foreign: rows of another lens were used.
Asked = collections.namedtuple("Asked", "ours theirs corner sigma inner foreign reason")


class Undo(Exception):
    """Ends a transaction without storing it."""


def halves_of(text):
    """For every falloff of a file, in order: whether its lens is in the test half."""
    for lens in ElementTree.fromstring(text).findall("lens"):
        mounts = ",".join(mount.text or "" for mount in lens.findall("mount"))
        name = "|".join((lens.findtext("maker") or "", lens.findtext("model") or "", mounts,
                         str(lens.findtext("cropfactor"))))
        for _ in lens.iterfind("calibration/vignetting"):
            yield zlib.crc32(name.encode()) & 1 == 1


def fill(store, folder):
    """Imports a folder's databases in one transaction -> ({id: (k, is_test)}, entries, unusable, doubtful)."""
    stored, entries, doubtful = {}, 0, 0
    with store.transaction():
        for file in sorted(folder.glob("*.xml")):
            text = file.read_bytes()
            try:
                found, tests = lensprof.formats.read_profiles(text, file.name), list(halves_of(text))
            except lensprof.Error as error:
                sys.exit("lookup.py: %s: %s" % (file, error))
            if len(found) != len(tests):
                sys.exit("lookup.py: %s has %d falloffs, but %d were read" % (file, len(tests), len(found)))
            entries += len(found)
            for (profile, usable), is_test in zip(found, tests):
                if usable:
                    stored[store.put(profile)] = tuple(profile.vignetting[0].k), is_test
                    doubtful += bool(profile.provenance.doubt)
    return stored, entries, entries - len(stored), doubtful


def lenses(store, stored):
    """{(lens, crop factor, camera): rows without a doubt}."""
    found = collections.defaultdict(list)
    for one in store.list():
        key = one.key
        if not one.provenance.doubt:
            found[key.lens, key.crop_factor, key.camera_model].append(
                Row(one.id, key, (key.focal_mm, key.aperture, key.distance_m), *stored[one.id]))
    return found


def our_answer(store, key):
    """Profile, Lookup; None and the reason if it is refused."""
    try:
        return store.lookup(key)
    except lensprof.Error as error:
        if error.status != lensprof.Status.ERROR_NOT_FOUND:
            raise
        return None, REASON.sub(r"\1", str(error))


def ask(store, one, others, span):
    """One row that is currently removed from the database, of a lens with rows `others` in it."""
    profile, how = our_answer(store, one.key)
    ours = profile and np.array(profile.vignetting[0].k)
    theirs = lensfun_rule.predict([o.setting for o in others], [o.k for o in others], one.setting, span)
    errors = [None if k is None else (k - np.array(one.k)) @ POWERS for k in (ours, theirs)]
    rms = [None if e is None else float(np.sqrt((e ** 2).mean())) for e in errors]
    if ours is None:
        return Asked(*rms, None, None, None, False, how)
    known = {o.id for o in others}
    inner = abs(float(errors[0][16])) / profile.radial_falloff(0.5)[1]
    return Asked(*rms, abs(float(errors[0][-1])), how.sigma, inner, not known.issuperset(list(how.id)[:how.rows]), "")


def leave_out(store, rows):
    """Looks up every row of a lens with the rows of its focal length and aperture removed."""
    groups = collections.defaultdict(list)
    for one in rows:
        groups[one.setting[:2]].append(one)
    focals = [one.setting[0] for one in rows]
    asked = []
    for group in groups.values() if len(groups) > 1 else ():
        others = [one for one in rows if one.setting[:2] != group[0].setting[:2]]
        try:
            with store.transaction():
                for one in group:
                    store.remove(one.id)
                asked += [ask(store, one, others, max(focals) - min(focals)) for one in group]
                raise Undo
        except Undo:
            pass
    return asked


def errors_of_both(asked):
    """Rows that both answer, and their errors: lensprof's, Lensfun's."""
    both = [a for a in asked if a.ours is not None and a.theirs is not None]
    return both, np.array([a.ours for a in both]), np.array([a.theirs for a in both])


def ratio_of_means(asked):
    _, ours, theirs = errors_of_both(asked)
    return ours.mean() / theirs.mean() if len(ours) else np.nan


def cells(name, half):
    """One row of the table."""
    asked = half["asked"]
    both, ours, theirs = errors_of_both(asked)
    left = np.array([a.theirs for a in asked if a.ours is None and a.theirs is not None])
    sigmas = np.array([a.corner / a.sigma for a in both])
    refused = ["%d" % sum(getattr(a, who) is None for a in asked) for who in ("ours", "theirs")]
    figures = ["%.4f / %.4f" % (of(ours), of(theirs)) for of in (np.mean, np.median, lambda e: np.quantile(e, 0.9))]
    return [name, half["lenses"], len(asked), " / ".join(refused), len(both), *figures, number(ratio_of_means(asked)),
            number((ours.sum() + left.sum()) / (theirs.sum() + left.sum())),
            *("%.1f %%" % (100.0 * (sigmas < limit).mean()) for limit in (1.0, 2.0)),
            "%.1f %%" % (100.0 * np.mean([a.inner < 1.0 for a in both]))]


def document(halves, counts):
    asked = halves[ALL]["asked"]
    reasons = collections.Counter(a.reason for a in asked if a.reason)
    lines = ["%d entries, %d of them unusable, %d stored with a doubt; %d stand alone. %d answers used rows of another"
             " lens, crop factor or camera. Pairs of figures are lensprof / Lensfun's rule."
             % (*counts, sum(a.foreign for a in asked)), ""]
    lines += header("lenses", "number", "asked", "refused", "compared", "error of M, mean", "median", "90 %",
                    "ratio of means", "with what lensprof refuses at Lensfun's error", "corners within 1 sigma",
                    "2 sigma", "r = 0.5 within 1 sigma")
    lines += [row(*cells(name, half)) for name, half in halves.items()]
    lines += ["", "Refused by lensprof:"] + ["- %d: %s" % (n, reason) for reason, n in reasons.most_common()]
    return "\n".join(lines) + "\n"


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else INSTALLED)
    if not any(folder.glob("*.xml")):
        print("lookup.py: %s: no Lensfun data; install liblensfun-data-v1 (make test-deps)" % folder, file=sys.stderr)
        sys.exit(77)
    halves = {name: {"lenses": 0, "asked": []} for name in (TEST, CHOSEN, ALL)}
    of_distance, alone = {TEST: [], CHOSEN: []}, 0
    with tempfile.TemporaryDirectory() as scratch, \
            lensprof.Store(pathlib.Path(scratch) / "lensfun.db", lensprof.StoreMode.CREATE) as store:
        stored, *counts = fill(store, folder)
        for rows in lenses(store, stored).values():
            asked = leave_out(store, rows)
            alone += 0 if asked else len(rows)
            name = TEST if all(one.is_test for one in rows) else CHOSEN
            for half in (halves[name], halves[ALL]):
                half["lenses"] += bool(asked)
                half["asked"] += asked
            several = distance.ask_lens(store, rows)
            of_distance[name] += [several] if several else []
        profiles, faults = store.check()
    if faults or profiles != len(stored):
        sys.exit("lookup.py: the lookups changed the database: %d of %d profiles, %d faults"
                 % (profiles, len(stored), len(faults)))
    if not all(errors_of_both(half["asked"])[0] for half in halves.values()):
        sys.exit("lookup.py: %s: too few lenses with several settings; each half needs some" % folder)
    text = document(halves, [*counts, alone])
    print(text + distance.document(of_distance), end="")
    if not ratio_of_means(halves[TEST]["asked"]) <= TARGET:
        sys.exit("lookup.py: the mean error on the test half is above %g of Lensfun's" % TARGET)


if __name__ == "__main__":
    main()
