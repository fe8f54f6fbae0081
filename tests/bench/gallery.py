"""The expected result for each set of real pictures, and whether it was met: verdict, joined images, and seams compared
with Hugin's.

Seams are measured at places that no tool chose (seams.py), on links of which lensprof joined both images.
"""
import json
import pathlib
import re
import shutil
from dataclasses import dataclass

import numpy as np

import scorer
import seams
import tools

HUGIN_SHARE = 1.1  # of vig_optimize's median seam; it seeds its sampling from the clock


@dataclass
class Expected:
    usable: bool = None
    equalizes: bool = None
    joined: int = None            # number of images
    seam: float = None            # upper limit of the median over the links, levels
    beside_hugin: float = None    # levels allowed above HUGIN_SHARE of Hugin's median seam
    unless_refused: bool = False  # the seam is not checked if lensprof reports that its result is not usable


PROJECTS = {  # by the name of the folder; other projects have no expectation
    "weir": Expected(equalizes=True, seam=3.0),
    "brighton_beach": Expected(beside_hugin=0.0, unless_refused=True),
    "grail": Expected(equalizes=True, joined=17),
    "halfdome": Expected(usable=False, equalizes=True),
    "goldengate": Expected(equalizes=True, beside_hugin=0.2),
    "hill": Expected(equalizes=True, beside_hugin=0.2),
    "ledge": Expected(equalizes=True, beside_hugin=0.2),
    "pier": Expected(equalizes=True, beside_hugin=0.2),
}
BRACKETS = {  # options, and the expected result
    "memorial": (["--fit", "ignore-below=20"], Expected(usable=True)),  # pure blue borders: nothing in red and green
    "frobisher": ([], Expected(usable=True)),
}
PICTURES = {".jpg", ".jpeg", ".png", ".tif", ".tiff"}


def pictures_of(project):
    """The project's pictures, in the order of the images."""
    names = re.findall(r'^i .*n"([^"]*)"', project.read_text(errors="replace"), re.M)
    return [project.parent / name for name in names]


def freed(project, copy):
    """A copy whose v lines request everything that lensprof's `--fit free=all` estimates; it may be in another folder."""
    lines = [line for line in project.read_text(errors="replace").splitlines() if not line.startswith("v")]
    lines = [re.sub(r'n"([^"]*)"', lambda m: 'n"%s"' % (project.parent / m.group(1)), line)
             if line.startswith("i ") else line for line in lines]
    names = "Ra0 Rb0 Rc0 Rd0 Re0 Vb0 Vc0 Vd0 Vx0 Vy0".split()
    names += ["%s%d" % (name, i) for i in range(1, len(pictures_of(project))) for name in ("Eev", "Er", "Eb")]
    copy.write_text("\n".join(lines + ["v " + name for name in names] + ["v"]) + "\n")


def measure(project, used, model, hugin):
    """Median and worst seam of a project before and after each tool; `used` and the models are from the runs."""
    sizes = tools.sizes_of_pto(project.read_text(errors="replace"))
    left_out = used.get("left_out", [])
    pairs = seams.seam_pairs(pictures_of(project))
    links = len(np.unique(pairs.image, axis=0))
    pairs = pairs.select(~np.isin(pairs.image, left_out).any(axis=1))
    record = {"images": len(sizes), "joined": len(sizes) - len(left_out), "links": links, "places": len(pairs),
              "seams": {}}
    for name, of in (("before", scorer.identity(len(sizes))), ("lensprof", model), ("hugin", hugin)):
        levels = list(seams.seams(of, pairs, sizes).values()) if of and len(pairs) else []
        if levels:
            record["seams"][name] = {"median": float(np.median(levels)), "worst": max(levels)}
        record["links_measured"] = max(record.get("links_measured", 0), len(levels))
    return record


def unmet(expected, used, record=None):
    """Unmet expectations, as texts; record: from `measure`."""
    said = {True: "yes", False: "no", None: "not stated"}
    found = ["%s: %s" % (key, said[used.get(key)]) for key in ("usable", "equalizes")
             if getattr(expected, key) not in (None, used.get(key))]
    if record is None:
        return found
    if expected.joined not in (None, record["joined"]):
        found.append("joined: %d" % record["joined"])
    ours, theirs = (record["seams"].get(tool, {}).get("median") for tool in ("lensprof", "hugin"))
    limits = [expected.seam] if expected.seam else []
    if expected.beside_hugin is not None and theirs is not None:
        limits.append(HUGIN_SHARE * theirs + expected.beside_hugin)
    if limits and not (expected.unless_refused and used.get("usable") is False):
        if ours is None:
            found.append("seam: not measured")
        elif ours > min(limits):
            found.append("seam: %.2f, above %.2f" % (ours, min(limits)))
    return found


def run_bracket(name, files, options, expected, folder):
    """`lensprof bracket` on the files -> a record."""
    folder.mkdir(parents=True, exist_ok=True)
    command = [tools.LENSPROF, "bracket", "--no-store", "--json", *options, *files]
    text = tools.measured(command, folder, str(folder / "bracket")).pop("out")
    used = tools.of_json(json.loads(text)) if text.startswith("{") else \
        {"usable": False, "reason_code": (folder / "bracket.err").read_text(errors="replace")[-200:].strip()}
    return {"set": name, "options": " ".join(options), "images": len(files), "lensprof": used,
            "unmet": None if expected is None else unmet(expected, used)}


def run_brackets(root, say):
    """Every folder of pictures in a folder `brackets`; and its first picture with a copy, which shows no response."""
    records = []
    for parent in sorted(p for p in pathlib.Path(root).resolve().rglob("brackets") if p.is_dir()):
        for source in sorted(p for p in parent.iterdir() if p.is_dir()):
            files = sorted(f for f in source.iterdir() if f.suffix.lower() in PICTURES)
            if len(files) < 2:
                continue
            folder = tools.WORK / "real" / ("brackets-" + source.name)
            shutil.rmtree(folder, ignore_errors=True)
            options, expected = BRACKETS.get(source.name, ([], None))
            records.append(run_bracket(source.name, files, options, expected, folder))
            copy = folder / ("copy" + files[0].suffix)
            shutil.copy(files[0], copy)
            records.append(run_bracket(source.name + ", one picture twice", [files[0], copy], options,
                                       Expected(usable=False), folder))
            say("real: bracket %s" % source.name)
    return records
