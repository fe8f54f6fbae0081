"""The tools under test: how each is called and how its result is read. A result is a scorer.Model."""
import datetime
import importlib.util
import json
import os
import pathlib
import platform
import re
import shutil
import subprocess
import sys

import numpy as np

from scorer import Curve, Model, model_of_json

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
WORK = ROOT / "build" / "bench"
LENSPROF = os.path.abspath(os.environ.get("LENSPROF", ROOT / "build" / "lensprof"))
VIG_OPTIMIZE = shutil.which("vig_optimize")
OPENCV = importlib.util.find_spec("cv2") is not None
NO_OPENCV = "no OpenCV for Python (package python3-opencv)"
LIMIT_S = 600

PAPER = ["--fit", "modes=5,loss=huber,prior=0,sampling=paper"]
LABELS = {"lensprof": "lensprof", "lensprof-paper": "lensprof as the paper", "hugin": "vig_optimize, same points",
          "hugin-2000": "vig_optimize -s 0 -p 2000", "hugin-3": "vig_optimize -s 3 (defaults)",
          "hugin-default": "vig_optimize, defaults"}


def measured(command, cwd, log, threads=None, limit_s=LIMIT_S, until=""):
    """Runs a command with its output in log.out and log.err, up to the text `until` in log.err
    -> {code, wall_s, cpu_s, peak_mb, out}."""
    environment = dict(os.environ, LC_ALL="C")
    if threads:
        environment["OMP_NUM_THREADS"] = str(threads)
    report = "%s.usage" % log
    with open("%s.out" % log, "w") as out, open("%s.err" % log, "w+") as err:
        subprocess.run([sys.executable, "-I", "-S", str(HERE / "usage.py"), report, str(limit_s), until, *map(str, command)],
                       cwd=cwd, env=environment, stdout=out, stderr=err, stdin=subprocess.DEVNULL, check=True)
    with open(report) as file:
        used = json.load(file)
    used["out"] = pathlib.Path("%s.out" % log).read_text(errors="replace")
    return used


def monotone(values):
    return bool((np.diff(np.asarray(values, float)) >= 0.0).all())


def run_lensprof(project, log, extra=()):
    """-> (usage, model or None). usage also gets the items of of_json and `timeless`: the output without its times."""
    command = [LENSPROF, "build", project, "--no-store", "--json", *extra]
    used = measured(command, pathlib.Path(project).parent, log, 1)
    text = used.pop("out")
    if used["code"] not in (0, 4) or not text.startswith("{"):
        return dict(used, lost=pathlib.Path("%s.err" % log).read_text(errors="replace")[-300:]), None
    data = json.loads(text)
    used.update(of_json(data), timeless=re.sub(r'"seconds":\{[^}]*\}', "", text))
    values = data["response"]["values"][0]
    return used, model_of_json(data, Curve(values), monotone(values))


def of_json(data):
    """The verdict and figures of the object that `build` and `bracket` print. reason: the text of the first refusal or
    warning; reason_code: the code of the first finding. equalizes: None for older programs, which print one reason."""
    residual, findings = data["residual"], data.get("findings", [])
    severe = [f["text"] for f in findings if f["severity"] in ("refusal", "warning")]
    return {"usable": data["usable"], "equalizes": data.get("equalizes", data.get("evens")), "findings": findings,
            "passed": data.get("passed", []), "reason": severe[0] if severe else data.get("reason", ""),
            "reason_code": findings[0]["code"] if findings else data.get("reason_code", "none"), "solve_s": data["seconds"]["solve"], "pairs": data["pairs"],
            "before_rms": residual["before_rms"], "heldout_rms": residual["heldout_rms"],
            "left_out": [n for n, i in enumerate(data["images"]) if i["ev"] is None or not i.get("joined", True)],
            "unverified": [link["images"] for link in data.get("links", []) if not link["verified"]]}


def run_hugin(project, log, extra=(), threads=1):
    """vig_optimize on a project -> (usage, model or None)."""
    result = "%s.pto" % log
    if os.path.exists(result):
        os.remove(result)
    command = [VIG_OPTIMIZE, "-v", "-o", result, *extra, project]
    used = measured(command, pathlib.Path(project).parent, log, threads)
    text = used.pop("out")
    if used["code"] or not os.path.exists(result):
        return dict(used, lost=text[-300:]), None
    counts = re.findall(r"Iteration: (\d+)", text)
    used["iterations"] = int(counts[-1]) if counts else None
    used.update(pairs_drawn(text))
    return used, model_of_pto(pathlib.Path(result).read_text(errors="replace"))


def pairs_drawn(text):
    """{"pairs": n} from the output of vig_optimize; {} if they were given."""
    found = re.search(r"Selected (\d+) points", text)
    return {"pairs": int(found.group(1))} if found else {}


def parse_pto(text):
    """Numbers of every i line, {name: value}, with links (`=N`: the value of image N) resolved."""
    lines = []
    for line in text.splitlines():
        if not line.startswith("i "):
            continue
        words = re.sub(r'n"[^"]*"', "", line).split()[1:]
        found = [re.match(r"([A-Za-z]+)(=?)([-+]?[\d.]+(?:[eE][-+]?\d+)?)$", word) for word in words]
        lines.append({m.group(1): (bool(m.group(2)), float(m.group(3))) for m in found if m})

    def resolve(image, name):
        for _ in lines:
            link, value = lines[image][name]
            if not link:
                return value
            image = int(value)
        raise ValueError("i line %d: circular links of %s" % (image, name))

    return [{name: resolve(i, name) for name in line} for i, line in enumerate(lines)]


def sizes_of_pto(text):
    return np.array([[line["w"], line["h"]] for line in parse_pto(text)], int)


_emor = []


def emor_table():
    """[26, 1024]: the mean curve and the modes, from the library's source (Grossberg & Nayar's published table)."""
    if not _emor:
        text = (ROOT / "src" / "core" / "emor_table.c").read_text()
        numbers = re.findall(r"[-+]?\d\.\d+e[-+]\d+", text[text.index("= {"):])
        _emor.append(np.array(numbers, float).reshape(26, 1024))
    return _emor[0]


def model_of_pto(text):
    """Hugin writes -log2 of the exposure factor, centres in px and five EMoR coefficients. It makes the curve monotone
    before using it (ResponseTransform, enforceMonotonicity); `monotone` is False if that was necessary."""
    lines = parse_pto(text)
    lens = lines[0]
    curve = emor_table()[0] + sum(lens["R" + c] * emor_table()[1 + n] for n, c in enumerate("abcde"))
    half_diagonal = np.hypot(lens["w"], lens["h"]) / 2.0
    return Model(np.array([-i["Eev"] for i in lines]), np.array([[i["Er"], 1.0, i["Eb"]] for i in lines]),
                 np.array([[lens["Vb"], lens["Vc"], lens["Vd"]]]), np.array([lens["Vx"], lens["Vy"]]) / half_diagonal,
                 Curve(np.minimum(curve, curve[-1])), monotone(curve))


def version_line():
    """CPU, date and versions, without which no figure must be quoted."""
    def first(command, pattern):
        try:
            text = subprocess.run(command, capture_output=True, text=True, check=False)
        except OSError:
            return "?"
        match = re.search(pattern, text.stdout + text.stderr)
        return match.group(1) if match else "?"

    cpu = first(["cat", "/proc/cpuinfo"], r"model name\s*: (.*)")
    commit = "LENSPROF=" + LENSPROF if "LENSPROF" in os.environ else \
        "commit " + first(["git", "-C", str(ROOT), "describe", "--always", "--dirty"], r"^(\S+)$")
    peer = first([VIG_OPTIMIZE, "--help"], r"version (\S+)") if VIG_OPTIMIZE else "not installed"
    return "%s, %d cores, %s %s; %s; %s (%s); vig_optimize %s; Python %s, NumPy %s" % (
        cpu, os.cpu_count(), platform.system(), platform.release(), datetime.date.today().isoformat(),
        first([LENSPROF, "--version"], r"(lensprof \S+)"), commit, peer, platform.python_version(), np.__version__)
