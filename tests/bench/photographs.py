"""From pictures alone: lensprof's registration compared with Hugin's chain (pto_gen, cpfind, cpclean, autooptimiser).

lensprof fits both projects, so only the geometry differs; seams are measured at places that neither chose (seams.py).
Pictures: a rendered sequence, and every folder of real ones.
"""
import json
import pathlib
import shutil
import subprocess

import numpy as np

import gallery
import real
import scorer
import seams
import tools

FIT = ["--no-store", "--fit", "stored=none", "--json"]
RENDERED = "--images 20 --set rows=2 --size 4000x3000 --format jpeg --seed 1"
QUICK = "--images 6 --size 1200x900 --format jpeg --seed 1"
CHAIN = (("pto_gen", "-o", "0.pto"), ("cpfind", "--multirow", "-o", "1.pto", "0.pto"), ("cpclean", "-o", "2.pto", "1.pto"),
         ("autooptimiser", "-a", "-l", "-s", "-o", "3.pto", "2.pto"))
HAS_HUGIN = all(shutil.which(step[0]) for step in CHAIN)


def by_hugin(files, folder):
    """Hugin's chain -> (usage of all steps together, project or None)."""
    total = {"wall_s": 0.0, "cpu_s": 0.0, "peak_mb": 0.0}
    for n, step in enumerate(CHAIN):
        used = tools.measured([*step, *(files if n == 0 else [])], folder, folder / ("hugin%d" % n))
        total = {"wall_s": total["wall_s"] + used["wall_s"], "cpu_s": total["cpu_s"] + used["cpu_s"],
                 "peak_mb": max(total["peak_mb"], used["peak_mb"])}
        if used["code"]:
            return dict(total, lost=step[0]), None
    return total, folder / "3.pto"


def fit(inputs, log, extra=()):
    """`build` -> (usage with the verdict, model or None, names of the images)."""
    used = tools.measured([tools.LENSPROF, "build", *inputs, *FIT, *extra], log.parent, log)
    text = used.pop("out")
    if not text.startswith("{"):
        return dict(used, lost=pathlib.Path("%s.err" % log).read_text(errors="replace")[-300:]), None, []
    data = json.loads(text)
    used.update(tools.of_json(data))
    values = data["response"]["values"][0]
    model = tools.model_of_json(data, tools.Curve(values), tools.monotone(values))
    return used, model, [pathlib.Path(i["file"]).name for i in data["images"]]


def measure(name, files, folder):
    """One set of pictures -> a record."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    files = [str(f) for f in files]
    own, model, names = fit(files, folder / "lensprof", ["--write", "project=" + str(folder / "found.pto")])
    record = {"name": name, "pictures": len(files), "lensprof": dict(own, joined=len(names) - len(own.get("left_out", [])))}
    models = {"lensprof": (model, names, own.get("left_out", []))}
    if HAS_HUGIN:
        chain, project = by_hugin(files, folder)
        record["hugin"] = chain
        if project:
            used, model, names = fit([project], folder / "by_hugin", real.FREE_ALL)
            record["hugin"].update(fitted=used, joined=len(names) - len(used.get("left_out", [])))
            models["hugin"] = (model, names, used.get("left_out", []))
    if tools.OPENCV:
        pairs = seams.seam_pairs(files)
        for tool, (model, names, left_out) in models.items():
            record[tool]["seam"] = seam_of(model, names, left_out, pairs, files)
    return record


def pictures_in(folder):
    return sorted(p for p in folder.iterdir() if p.suffix.lower() in gallery.PICTURES)


def moving(root):
    """{name: files} of folders below root/reconstruction: pictures of a moving camera."""
    sets = {}
    for folder in sorted(p for p in (pathlib.Path(root) / "reconstruction").glob("*") if p.is_dir()):
        own = folder / "images" if (folder / "images").is_dir() else folder
        files = pictures_in(own)
        if len(files) > 2:
            sets["%s/%s" % (folder.parent.name, folder.name)] = files
    return sets


def exif_ev(files, folder):
    """Exposures from the metadata, as Hugin's pto_gen reads them, EV; None if they are all equal."""
    if not HAS_HUGIN or tools.measured(["pto_gen", "-o", "exif.pto", *files], folder, folder / "exif")["code"]:
        return None
    ev = -np.array([line["Eev"] for line in tools.parse_pto((folder / "exif.pto").read_text())])
    return ev if np.ptp(ev) > 0.1 else None


def measure_moving(name, files, folder):
    """Exposures from pictures alone compared with EXIF's, which the fit does not get."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    files = [str(f) for f in files]
    used, model, _ = fit(files, folder / "lensprof", ["--fit", "exif-sigma=0"])
    record = {"name": name, "pictures": len(files), **used}
    known = exif_ev(files, folder)
    if model is None or known is None or len(model.ev) != len(files):
        return record
    joined = np.array([n not in used["left_out"] for n in range(len(files))])
    found, known = model.ev[joined], known[joined]
    off = found - known
    return dict(record, joined=int(joined.sum()), correlation=float(np.corrcoef(found, known)[0, 1]),
                slope=float(np.polyfit(known, found, 1)[0]), off_ev=float(np.std(off)), exif_ev=float(np.ptp(known)))


def measure_all(sets, measure_one, prefix, what, say):
    records = []
    for name, files in sets.items():
        records.append(measure_one(name, files, tools.WORK / "photographs" / (prefix + name.replace("/", "-"))))
        say("photographs: %d of %d %s" % (len(records), len(sets), what))
    return records


def run_moving(root, say):
    sets = moving(root) if root else {}
    for name, project in (real.projects_below(root) if root else {}).items():
        if name.endswith("brighton_beach"):
            sets[name] = pictures_in(project.parent)
    return measure_all(sets, measure_moving, "moved-", "sets of a moving camera", say)


def seam_of(model, names, left_out, pairs, files):
    """Median over the links of which the tool joined both pictures; None if there is no model."""
    place = {name: n for n, name in enumerate(names) if n not in left_out}
    number = np.array([place.get(pathlib.Path(f).name, -1) for f in files])
    kept = pairs.select((number[pairs.image] >= 0).all(axis=1))
    if model is None or not len(kept):
        return None
    own = scorer.Pairs(number[kept.image], kept.xy, kept.value)
    import cv2
    sizes = np.zeros((len(names), 2), int)
    for f, n in zip(files, number):
        if n >= 0:
            sizes[n] = cv2.imread(f, cv2.IMREAD_UNCHANGED).shape[1::-1]
    return float(np.median(list(seams.seams(model, own, sizes).values())))


def run_all(root, quick, say):
    rendered = tools.WORK / "photographs" / "rendered"
    shutil.rmtree(rendered, ignore_errors=True)
    subprocess.run([tools.LENSPROF, "simulate", "-o", str(rendered), *(QUICK if quick else RENDERED).split()], check=True,
                   stdout=subprocess.DEVNULL)
    sets = {"rendered": sorted(rendered.glob("img*"))}
    for name, project in (real.projects_below(root) if root else {}).items():
        sets[name] = pictures_in(project.parent)
    return measure_all(sets, measure, "of-", "sets", say)
