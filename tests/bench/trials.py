"""What `profile check --against` states on the corners, on rendered sequences: its sign and its standard errors.

Every option is drawn from the seed; `--tune` uses other seeds than the reported figures. Candidates are the true
falloff, others that are OFF EV too bright and too dark in the corner, and none. Kinds differ in what the profile has:

exact    the true response
fitted   a response fitted to other pictures of the camera, with its covariance
lens     no response, as of Lensfun; EXIF has the exposures, in thirds of a stop
linear   sensor data
"""
import json
import random
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

import scorer
import tools
from verdicts import RESPONSES, pick

KINDS = ("exact", "fitted", "lens", "linear")
COUNT, QUICK = 30, 2  # sequences per kind
OFF = 0.2  # EV, in the corner
CANDIDATES = ("true", "too bright", "too dark", "none")
SIGNS = {"true": "agree", "too bright": "too-bright", "too dark": "too-dark", "none": "too-dark"}
ENDS = (0.25, 0.5, 0.7, 0.85, 1.0)  # of the rings, half diagonals
GREYS = np.arange(24, 241) / 255.0  # within which responses are compared
RADII2 = np.linspace(0.0, 1.0, 101)


@dataclass
class Trial:
    kind: str
    number: int
    response: str
    size: tuple
    k: list
    center: tuple
    power: int  # of r^2: how the falloff of the wrong candidates deviates
    camera: list  # arguments of the pictures of the camera, and
    arguments: list  # of these pictures

    @property
    def name(self):
        return "%s %d" % (self.kind, self.number)


def trial(kind, number, r):
    depth, first, second = r.uniform(0.15, 0.6), r.uniform(0.3, 1.2), r.uniform(-0.4, 0.4)
    k = [-depth * first, -depth * second, -depth * (1.0 - first - second)]
    size, center = pick(r, (480, 360), (480, 320), (360, 480)), (r.gauss(0.0, 0.015), r.gauss(0.0, 0.015))
    response = "linear" if kind == "linear" else pick(r, *RESPONSES)
    camera = ["--response", response, "--size", "%dx%d" % size, "--vignetting=%.5f,%.5f,%.5f" % tuple(k),
              "--set=center=%.4f,%.4f" % center, "--set", "noise=" + pick(r, "0.5", "1", "2", "3"),
              "--format", "tiff32" if kind == "linear" else pick(r, "png", "jpeg", "jpeg"),
              "--set", "hfov=" + pick(r, "35", "50", "65"), "--set", "sharpen=" + pick(r, "0", "0", "0.3")]
    arguments = ["--scene", pick(r, "landscape", "sky", "wall", "foliage", "interior"), "--seed",
                 str(r.randrange(1, 1 << 30)), "--images", pick(r, "4", "5", "6"),
                 "--set", "rows=" + pick(r, "1", "1", "2"), "--set", "overlap=" + pick(r, "0.3", "0.4", "0.5"),
                 "--set", "ev=" + pick(r, "0.3", "0.8", "1.5"),
                 "--set", "wb=" + pick(r, "0", "0.05", "0.2"), "--set", "jitter=" + pick(r, "1", "3"),
                 "--set", "misalign=" + pick(r, "0", "0.5", "1.5"), "--set", "parallax=" + pick(r, "0", "0", "2"),
                 "--set", "objects=" + pick(r, "0", "0", "0.1"), "--set", "clip=" + pick(r, "0", "0", "0.03")]
    if kind == "lens":
        arguments += ["--exif", "--set", "exif-rounding=0.1"]
    return Trial(kind, number, response, size, k, center, pick(r, 1, 2, 3), camera, arguments)


def trials(quick, tune):
    for kind in KINDS:
        for number in range(QUICK if quick else COUNT):
            yield trial(kind, number, random.Random("trial %s %d %s" % (kind, number, "tune" if tune else "checked")))


def polynomial(k, r2):
    return 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[2]))


def fitted_k(falloff):
    """k1..k3 of a falloff at RADII2."""
    return np.linalg.lstsq(RADII2[:, None] ** np.arange(1, 4), falloff - 1.0, rcond=None)[0].tolist()


def radii2(size, center):
    """r^2 of the pixels about a centre, half diagonals."""
    (width, height), half = size, np.hypot(*size) / 2.0
    x, y = np.meshgrid(np.arange(width) - (width - 1) / 2.0, np.arange(height) - (height - 1) / 2.0)
    return (x / half - center[0]) ** 2 + (y / half - center[1]) ** 2


def true_rings(one, gamma, k):
    """What a candidate leaves: mean of its error per ring, relative to the first, EV."""
    of_lens, ring = radii2(one.size, one.center), np.searchsorted(np.square(ENDS), radii2(one.size, (0.0, 0.0)))
    left = gamma * np.log2(polynomial(one.k, of_lens)) - np.log2(polynomial(k, of_lens))
    means = np.array([left[ring == n].mean() for n in range(len(ENDS))])
    return means - means[0]


def exponent(truth, found):
    """Of a response over the true one."""
    logs = [np.log(np.maximum(curve.g(GREYS), 1e-6)) for curve in (truth, found)]
    return float(np.polyfit(*logs, 1)[0])


def simulate(folder, arguments):
    subprocess.run([tools.LENSPROF, "simulate", "-o", str(folder), *arguments], check=True, stdout=subprocess.DEVNULL)


def run(*arguments, codes=(0,)):
    done = subprocess.run([tools.LENSPROF, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode not in codes:
        raise RuntimeError("%s: %s" % (" ".join(map(str, arguments)), done.stderr[-300:]))
    return done.stdout


def profile_of(one, folder, truth):
    """A profile of the camera, or None if its fit is refused -> (JSON without a falloff, exponent of its response)."""
    profile = {"schema": 2, "key": {"camera_model": "Simulated Camera", "lens": "Simulated Lens", "processing": "jpeg"},
               "vignetting": {"center": list(one.center)}}
    if one.kind == "fitted":
        other = ["--scene", "landscape", "--images", "6", "--seed", str(one.number + 1)]
        simulate(folder / "other", [*one.camera, *other])
        run("build", folder / "other" / "pano.pto", "--db", folder / "other.db", "--fit", "stored=none", codes=(0, 4))
        if not (folder / "other.db").exists():
            return None, 1.0
        run("profile", "export", 1, "--db", folder / "other.db", "-o", folder / "other.json")
        made = json.loads((folder / "other.json").read_text())
        profile.update(response=made["response"], covariance=made["covariance"], provenance=made["provenance"])
        return profile, exponent(truth, scorer.Curve(curve_of(made["response"])))
    if one.kind == "exact":
        profile["response"] = {"kind": "table", "values": [truth.f(np.linspace(0.0, 1.0, 1024)).tolist()]}
    else:
        profile["key"]["processing"] = "raw"
        profile["response"] = {"kind": "linear"}
    return profile, 1.0


def curve_of(response):
    table = tools.emor_table()
    return table[0] + np.array(response["emor"]) @ table[1:1 + len(response["emor"])]


def candidates(one, gamma):
    """k per candidate with a falloff; the wrong ones deviate by OFF in the corner."""
    true = polynomial(one.k, RADII2) ** gamma
    return [fitted_k(true * 2.0 ** (off * RADII2 ** one.power)) for off in (0.0, -OFF, OFF)]


def check(folder, profile, models):
    """The output of the command for candidates of a profile; "" if it is refused."""
    names = []
    for name, k in zip(CANDIDATES, models):
        profile["key"]["lens"], profile["vignetting"]["k"] = name, [k]
        names.append(folder / (name.replace(" ", "_") + ".json"))
        names[-1].write_text(json.dumps(profile))
    run("profile", "import", *names, "--db", folder / "trial.db")
    return run("profile", "check", 1, 2, 3, "--against", folder / "pictures" / "pano.pto", "--db", folder / "trial.db",
               "--json", codes=(0, 4))


def measure(one, tune, keep):
    folder = tools.WORK / "trials" / ("%s_%s_%03d" % (one.kind, "tune" if tune else "report", one.number))
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    simulate(folder / "pictures", [*one.camera, *one.arguments])
    profile, gamma = profile_of(one, folder, scorer.read_truth(folder / "pictures" / "truth.json", one.response).curve)
    models, out = candidates(one, gamma), ""
    if profile:
        out = check(folder, profile, models)
    record = {"kind": one.kind, "number": one.number, "arguments": " ".join(one.camera + one.arguments),
              "refused": not out, "candidates": {}}
    data = json.loads(out) if out else {"profiles": [], "none": None}
    for name, k, found in zip(CANDIDATES if out else (), [*models, [0.0] * 3], [*data["profiles"], data["none"]]):
        truth = true_rings(one, gamma, k)
        record["candidates"][name] = {
            "corners": found["corners"], "ev": found["ring_ev"], "sigma": found["ring_sigma_ev"],
            "truth": truth.tolist(),
            "z": [(e - t) / s for e, s, t in zip(found["ring_ev"][1:], found["ring_sigma_ev"][1:], truth[1:])]}
    if not keep:
        shutil.rmtree(folder)
    return record


def run_all(quick, tune, jobs, keep, say, match=""):
    """match: a kind, or a single case such as "fitted 17"."""
    chosen, records = [t for t in trials(quick and not match, tune) if not match or match in (t.kind, t.name)], []
    with ThreadPoolExecutor(jobs) as pool:
        for record in pool.map(lambda t: measure(t, tune, keep), chosen):
            records.append(record)
            if len(records) % 30 == 0 or len(records) == len(chosen):
                say("trials: %d of %d" % (len(records), len(chosen)))
    return {"tune": tune, "records": records}
