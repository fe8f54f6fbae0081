"""Time and memory. The tools take turns within one run, so that other load on the machine affects all of them equally.
Ratios are computed per turn; their median over the turns is stated."""
import shutil
import statistics
import subprocess

import scorer
import tools

# Name, options of simulate, maximum number of turns, whether a quick run includes it.
SOLVER = [("6 images, 300 pairs", "--images 6 --set points=300", 9, True),
          ("20 images, 5000 pairs", "--images 20 --set rows=2,points=5000", 9, True),
          ("61 images, 300 pairs", "--images 61 --set rows=4,hfov=25,mean-ev=-1,points=300", 3, True),
          ("61 images, 5000 pairs", "--images 61 --set rows=4,hfov=25,mean-ev=-1,points=5000", 1, False)]
GIVEN = "--set no-images=yes,outliers=0.1 "
COMMAND = [("6 JPEG of 0.5 MP", "--images 6 --size 816x612 --format jpeg", 9, True),
           ("20 JPEG of 2 MP", "--images 20 --set rows=2 --size 1632x1224 --format jpeg", 9, False),
           ("20 JPEG of 12 MP", "--images 20 --set rows=2 --size 4000x3000 --format jpeg", 3, False),
           ("20 JPEG of 12 MP, outliers", "--images 20 --set rows=2 --size 4000x3000 --format jpeg --set outliers=0.1", 3, False)]
COMMON = "--seed 1 --set test-points=2000"


def render(name, options):
    folder = tools.WORK / "speed" / "".join(c if c.isalnum() else "_" for c in name)
    shutil.rmtree(folder, ignore_errors=True)
    subprocess.run([tools.LENSPROF, "simulate", "-o", str(folder), *COMMON.split(), *options.split()], check=True,
                   stdout=subprocess.DEVNULL)
    return folder


def megabytes(folder):
    """Mean size of a picture's file."""
    sizes = [picture.stat().st_size for picture in folder.glob("img*")]
    return statistics.mean(sizes) / 1e6 if sizes else None


def solver_runs(folder):
    """{tool: call}: with given pairs, so no picture is opened. vig_optimize solves on one thread."""
    project, points = str(folder / "pano.pto"), str(folder / "points.txt")
    yield "lensprof", lambda: tools.run_lensprof(project, str(folder / "lensprof"), ["--points", points])
    if tools.VIG_OPTIMIZE:
        yield "hugin", lambda: tools.run_hugin(project, str(folder / "hugin"), ["-i", points])


def command_runs(folder):
    """{tool: call}: the whole command from the pictures, with each tool's default number of threads. Large pictures are
    compared with vig_optimize -s 3 only: without reduction it holds all of them in memory as floating point numbers."""
    project = str(folder / "pano.pto")
    yield "lensprof", lambda: tools.run_lensprof(project, str(folder / "lensprof"))
    if tools.VIG_OPTIMIZE:
        small = (("hugin-2000", ["-s", "0", "-p", "2000"]), ("hugin-default", []))
        for tool, extra in (("hugin-3", ["-s", "3"]),) if "12_MP" in folder.name else small:
            yield tool, lambda tool=tool, extra=extra: tools.run_hugin(project, str(folder / tool), extra, threads=None)


def measure(name, options, runs, turns):
    """-> one record per tool: the figures of every turn, medians, ratios of lensprof to the tool."""
    folder = render(name, options)
    truth, pairs = scorer.read_truth(folder / "truth.json", "srgb"), scorer.read_points(folder / "test_points.txt")
    sizes, calls, taken = tools.sizes_of_pto((folder / "pano.pto").read_text()), dict(runs(folder)), {}
    for _ in range(turns):
        for tool, call in calls.items():
            taken.setdefault(tool, []).append(call())
    records = []
    for tool, results in taken.items():
        used = [u for u, _ in results]
        record = {"case": name, "tool": tool, "turns": turns, "file_mb": megabytes(folder),
                  "complete": all(model for _, model in results)}
        for key in ("wall_s", "cpu_s", "peak_mb", "solve_s", "pairs"):
            if all(key in u for u in used):
                record[key] = statistics.median(u[key] for u in used)
                record[key + "_turns"] = [u[key] for u in used]
        if record["complete"]:
            record["clean_rms"] = scorer.score(truth, results[-1][1], pairs, sizes)["clean_rms"]
        if tool == "lensprof":
            record["identical"] = len({u.get("timeless") for u in used}) == 1
        records.append(record)
    for record in records:  # solver: compared with the peer's whole process, as it reports no solver time
        for key, own in (("wall_s", "wall_s"), ("cpu_s", "cpu_s"), ("peak_mb", "peak_mb"), ("solve_to_cpu", "solve_s")):
            ours, theirs = records[0].get(own + "_turns"), record.get(key.replace("solve_to_cpu", "cpu_s") + "_turns")
            if ours and theirs:
                record["ratio_" + key] = statistics.median(a / b for a, b in zip(ours, theirs))
    return records


def run_all(quick, turns, say):
    solver, command = [], []
    for cases, also, runs, records in ((SOLVER, GIVEN, solver_runs, solver), (COMMAND, "", command_runs, command)):
        for name, options, most, in_quick in cases:
            if in_quick or not quick:
                say("speed: " + name)
                records += measure(name, also + options, runs, 1 if quick and not name.startswith("6 ") else min(turns, most))
    return {"solver": solver, "command": command}
