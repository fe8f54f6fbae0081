"""Real pictures without a truth: how well a model fitted to 80 % of the pairs predicts the other 20 %."""
import pathlib
import shutil
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import gallery
import scorer
import tools

FOLDS = 5
NAMES = ("pano.pto", "hugin.pto")
FREE_ALL = ["--fit", "free=all"]  # whatever the v lines of a project request
CLIP_LEVELS = 20.0
DISAGREE_LEVELS, DISAGREE_PAIRS = 10.0, 10


def projects_below(root):
    """{name: path} of every project; the name is that of its folder, or its own if a folder has two."""
    root = pathlib.Path(root).resolve()
    found = sorted(p for p in root.rglob("*.pto") if p.name in NAMES)
    folders = [p.parent for p in found]
    places = [p.with_suffix("") if folders.count(p.parent) > 1 else p.parent for p in found]
    return {root.name if place == root else str(place.relative_to(root)): p for place, p in zip(places, found)}


def figures(residual):
    """RMS, median and RMS of residuals clipped at 20 levels, for [n, 2, 3]."""
    size = np.abs(residual)
    return {"pairs": len(residual), "rms": scorer.rms(size), "median": float(np.median(size)),
            "clipped_rms": scorer.rms(np.minimum(size, CLIP_LEVELS))} if len(residual) else {"pairs": 0}


def disagreeing(pairs, residuals):
    """(rows, images): images that are misplaced in the project or show something else, and their pairs.
    The median residual of their pairs, 10 or more, is above 10 levels with every tool."""
    bad, images = np.zeros(len(pairs), bool), []
    for image in np.unique(pairs.image):
        rows = (pairs.image == image).any(axis=1)
        if rows.sum() >= DISAGREE_PAIRS and all(np.median(np.abs(r[rows])) > DISAGREE_LEVELS for r in residuals):
            bad |= rows
            images.append(int(image))
    return bad, images


def in_range(text):
    """Lines of a point file with all grey values within 0..1; Hugin's interpolation exceeds this range for some."""
    lines = text.splitlines(keepends=True)
    return "".join(line for line in lines if all(0.0 <= float(v) <= 1.0 for v in line.split()[6:12]))


def cross_validate(project, points, folder):
    """Both tools fit 80 % of the pairs (the same file) and are scored on the other 20 %, five times.
    project: a copy whose v lines request everything."""
    text = pathlib.Path(project).read_text(errors="replace")
    lines = [line for line in pathlib.Path(points).read_text().splitlines() if line.strip()]
    pairs, sizes = scorer.read_points(points), tools.sizes_of_pto(text)
    fold_of = np.arange(len(lines)) % FOLDS
    calls = {"lensprof": tools.run_lensprof, **({"hugin": tools.run_hugin} if tools.VIG_OPTIMIZE else {})}
    option = {"lensprof": [*FREE_ALL, "--points"], "hugin": ["-i"]}
    residual = {tool: np.zeros((len(lines), 2, 3)) for tool in calls}
    monotone, failed = dict.fromkeys(calls, 0), dict.fromkeys(calls, 0)
    for fold in range(FOLDS):
        train = folder / ("train%d.txt" % fold)
        train.write_text("".join(line + "\n" for line, f in zip(lines, fold_of) if f != fold))
        test = fold_of == fold
        for tool, run in calls.items():
            _, model = run(project, str(folder / ("%s%d" % (tool, fold))), [*option[tool], str(train)])
            failed[tool] += model is None
            monotone[tool] += bool(model and model.monotone)
            used = model or scorer.identity(len(sizes))
            residual[tool][test] = scorer.transfer(used, pairs.select(test), sizes)
    bad, images = disagreeing(pairs, list(residual.values()))
    before = scorer.transfer(scorer.identity(len(sizes)), pairs, sizes)
    return [{"tool": tool, "all": figures(r), "agreeing": figures(r[~bad]), "disagreeing_images": images,
             "failed_folds": failed[tool], "monotone_folds": monotone[tool], "uncorrected": figures(before)}
            for tool, r in residual.items()]


def run_project(project, name):
    folder = tools.WORK / "real" / name.replace("/", "-")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    runs = []
    for turn in "ab":
        outputs = [folder / ("%s_%s" % (turn, file)) for file in ("pairs.txt", "result.pto")]
        used, model = tools.run_lensprof(str(project), str(folder / turn),
                                         [*FREE_ALL, "--write", f"points={outputs[0]}", "--write", f"pto={outputs[1]}"])
        runs.append([used.pop("timeless", None)] + [p.read_bytes() if p.exists() else None for p in outputs])
    record = {"project": name, "images": len(tools.sizes_of_pto(project.read_text(errors="replace"))), "lensprof": used,
              "monotone": bool(model and model.monotone), "identical": runs[0] == runs[1], "folds": []}
    sources = {"lensprof": folder / "a_pairs.txt", "vig_optimize": folder / "hugin_pairs.txt"}
    free, hugin = folder / "free.pto", None
    gallery.freed(project, free)
    if tools.VIG_OPTIMIZE:
        own = ["-s", "0", "-p", "2000", "-w", str(sources["vig_optimize"])]
        _, hugin = tools.run_hugin(str(free), str(folder / "own"), own)
        if sources["vig_optimize"].exists():
            sources["vig_optimize"].write_text(in_range(sources["vig_optimize"].read_text()))
    for source, points in sources.items():
        if points.exists() and points.stat().st_size:
            for result in cross_validate(str(free), str(points), folder):
                record["folds"].append(dict(result, points_by=source))
    if tools.OPENCV:
        expected = gallery.PROJECTS.get(project.parent.name)
        record["gallery"] = gallery.measure(project, used, model, hugin)
        record["unmet"] = expected and gallery.unmet(expected, used, record["gallery"])
    return record


def run_all(root, jobs, say):
    projects, records = projects_below(root), []
    if not tools.OPENCV:
        say("SKIPPED: gallery: " + tools.NO_OPENCV)
    with ThreadPoolExecutor(jobs) as pool:
        for record in pool.map(run_project, projects.values(), projects):
            records.append(record)
            say("real: %d of %d projects" % (len(records), len(projects)))
    return records
