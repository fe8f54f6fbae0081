"""Both errors of the verdict on rendered sequences, good ones that are refused and bad ones that are accepted; and what
is applied where pictures leave open a falloff.

Good: smooth and hard scenes, every option drawn from the seed. Bad: noise, negatives, tone mapping and misplaced
pictures. Open: little overlap, few pictures, one view and others; no correction may be worse than none. `--tune` uses
other seeds than the reported figures.
"""
import json
import random
import re
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

import scorer
import tools

NEED_OPENCV = ("noise", "negatives")
GOOD, BAD = ("smooth", "hard"), ("noise", "negatives", "tone mapping", "misplaced")
OPEN = ("little overlap", "few pictures", "constant exposure", "moved camera", "sky", "one view", "corrected")
EMOR = ("emor:2.05,-0.12,-0.49,0.27,-0.18", "emor:-0.92,-0.88,1.03,0.36,-0.28")
RESPONSES = ("srgb", "film", "gamma:2.2", *EMOR)
FALLOFFS = ("-0.33,0.06,-0.16", "-0.15,0.02,-0.05", "-0.6,0.3,-0.12", "-0.8,0.5,-0.2")
TEST_PAIRS = "2000"
COUNT_GOOD, COUNT_BAD, COUNT_OPEN, QUICK = 100, 50, 45, 6  # sequences per kind
LIMITS = {True: 0.01, False: 0.02}  # share of good ones refused, of bad ones accepted without a warning
HOLDS = (0.63, 0.73)  # share within the stated standard errors


@dataclass
class Sequence:
    kind: str
    number: int
    arguments: list
    response: str

    @property
    def name(self):
        return "%s %d" % (self.kind, self.number)


def pick(r, *values):
    return values[r.randrange(len(values))]


def common(r, falloffs=FALLOFFS, balances=("0", "0.05", "0.2"), exif=([], ["--exif"])):
    return ["--response", pick(r, *RESPONSES), "--vignetting=" + pick(r, *falloffs),
            "--set", f"wb={pick(r, *balances)}", "--set", "noise=" + pick(r, "1", "2", "3"),
            "--format", pick(r, "png", "png", "jpeg", "tiff16"),
            "--set=center=%.3f,%.3f" % (r.gauss(0, 0.015), r.gauss(0, 0.015))] + pick(r, *exif)


def smooth(r):
    return ["--scene", pick(r, "sky", "wall"), "--images", pick(r, "3", "5", "8"), "--size",
            pick(r, "600x450", "800x600"), "--set", "ev=" + pick(r, "0.3", "0.8", "1.5"),
            "--set", "overlap=" + pick(r, "0.25", "0.35", "0.5"), "--set", "outliers=" + pick(r, "0", "0", "0.1", "0.3"),
            "--set", "misalign=" + pick(r, "0", "2", "5"), "--set", "hfov=" + pick(r, "40", "50", "65"), *common(r)]


def hard(r):
    return ["--scene", pick(r, "foliage", "interior", "landscape"), "--images", pick(r, "3", "6", "12"), "--size",
            pick(r, "600x450", "800x600"), "--set", "ev=" + pick(r, "0.5", "1.5", "2.5"),
            "--set", "overlap=" + pick(r, "0.15", "0.3", "0.4"), "--set", "parallax=" + pick(r, "0", "3", "8"),
            "--set", "sharpen=" + pick(r, "0", "0.3", "0.8"), "--set", "clip=" + pick(r, "0", "0.03", "0.1"),
            "--set", "objects=" + pick(r, "0", "0.1", "0.2"), "--set", "misalign=" + pick(r, "0", "2", "5"),
            "--set", "outliers=" + pick(r, "0", "0", "0.1"), *common(r)]


def plain(r):
    return ["--scene", pick(r, "landscape", "wall", "foliage", "sky", "interior"), "--images", pick(r, "3", "5", "8"),
            "--size", "600x450", "--set", "ev=" + pick(r, "0.3", "1", "2"), *common(r)]


def tone_mapped(r):
    return plain(r) + ["--set", "local-tone=" + pick(r, "0.5", "1", "2")]


def row(r, images, scenes=("landscape", "wall", "foliage", "interior"), overlap=("0.3", "0.4"), ev=("0.3", "0.8", "1.5"),
        **given):
    """A row of small pictures."""
    return ["--scene", pick(r, *scenes), "--images", pick(r, *images), "--size", pick(r, "600x450", "600x400"),
            "--set", f"overlap={pick(r, *overlap)}", "--set", "ev=" + pick(r, *ev),
            "--set", "hfov=" + pick(r, "40", "50", "65"), *common(r, **given)]


def little_overlap(r):
    return row(r, ("3", "5", "7"), overlap=("0.1", "0.12", "0.15")) + ["--set", "misalign=" + pick(r, "0", "1", "3")]


def few_pictures(r):
    return row(r, ("2", "3"), overlap=("0.2", "0.3", "0.5")) + ["--set", "misalign=" + pick(r, "0", "1", "3")]


def constant_exposure(r):
    return row(r, ("6", "8", "12"), ev=("0",), balances=("0",), exif=([],)) + [
        "--set", "misalign=" + pick(r, "1", "2", "3"), "--set", "parallax=" + pick(r, "0", "2", "4"),
        "--set", "objects=" + pick(r, "0", "0.05", "0.1")]


def moved_camera(r):
    return row(r, ("5", "6"), overlap=("0.4", "0.6")) + [
        "--set", "parallax=" + pick(r, "10", "20", "30"), "--set", "objects=" + pick(r, "0", "0.1", "0.2")]


def sky(r):
    return row(r, ("3", "5", "8"), scenes=("sky",), ev=("0.1", "0.3"))


def one_view(r):
    """The camera stands on a tripod."""
    return row(r, ("2", "3", "5"), overlap=("0.96", "0.975", "0.985")) + ["--set", "jitter=" + pick(r, "0", "0.05", "0.2")]


def corrected(r):
    """The camera has corrected the falloff."""
    return row(r, ("3", "5", "8"), falloffs=("0,0,0", "-0.02,0.01,-0.01", "0.01,-0.02,0.02", "-0.04,0.03,0"))


DRAWS = {"smooth": smooth, "hard": hard, "noise": plain, "negatives": plain, "tone mapping": tone_mapped,
         "misplaced": plain, "little overlap": little_overlap, "few pictures": few_pictures,
         "constant exposure": constant_exposure, "moved camera": moved_camera, "sky": sky, "one view": one_view,
         "corrected": corrected}
COUNTS = {**dict.fromkeys(GOOD, COUNT_GOOD), **dict.fromkeys(BAD, COUNT_BAD), **dict.fromkeys(OPEN, COUNT_OPEN)}


def sequences(quick, tune):
    for kind, count in COUNTS.items():
        for n in range(QUICK if quick else count):
            r = random.Random("%s %d %s" % (kind, n, "tune" if tune else "report"))
            words = DRAWS[kind](r)
            words += ["--seed", str(r.randrange(1, 1 << 30))]
            yield Sequence(kind, n, words, words[words.index("--response") + 1])


def spoil(kind, folder, r):
    """Turns a rendered sequence into one that no camera took, or whose project is wrong."""
    if kind == "misplaced":  # reversed row: pictures that overlap in the project do not overlap
        text = (folder / "pano.pto").read_text()
        names = re.findall(r'n"(img[^"]*)"', text)
        turned = dict(zip(names, names[::-1]))
        (folder / "pano.pto").write_text(re.sub(r'n"(img[^"]*)"', lambda m: 'n"%s"' % turned[m.group(1)], text))
        return
    if kind not in ("noise", "negatives"):
        return
    import cv2
    for number, file in enumerate(sorted(folder.glob("img*"))):
        picture = cv2.imread(str(file), cv2.IMREAD_UNCHANGED)
        top = np.iinfo(picture.dtype).max
        if kind == "negatives":
            picture = top - picture
        else:  # independent noise, fine or coarse
            draw = np.random.default_rng([r.randrange(1 << 30), number])
            block = pick(r, 1, 4, 16)
            height, width = picture.shape[:2]
            size = (-(-height // block), -(-width // block), 3)
            picture = np.kron(draw.integers(0, top + 1, size), np.ones((block, block, 1)))[:height, :width]
            picture = picture.astype(np.uint16 if top > 255 else np.uint8)
        cv2.imwrite(str(file), picture)


def measure(sequence, tune, keep):
    folder = tools.WORK / "verdicts" / ("%s_%s_%03d" % (sequence.kind.replace(" ", "_"), "tune" if tune else "report",
                                                        sequence.number))
    shutil.rmtree(folder, ignore_errors=True)
    subprocess.run([tools.LENSPROF, "simulate", "-o", str(folder), "--set", f"test-points={TEST_PAIRS}", *sequence.arguments],
                   check=True, stdout=subprocess.DEVNULL)
    spoil(sequence.kind, folder, random.Random(sequence.number))
    truth = scorer.read_truth(folder / "truth.json", sequence.response)
    pairs = scorer.read_points(folder / "test_points.txt")
    sizes = tools.sizes_of_pto((folder / "pano.pto").read_text())
    used, model = tools.run_lensprof(str(folder / "pano.pto"), str(folder / "lensprof"), ["--fit", "stored=none"])
    record = {"kind": sequence.kind, "number": sequence.number, "arguments": " ".join(sequence.arguments),
              "usable": used.get("usable", False), "equalizes": used.get("equalizes"),
              "reason": used.get("reason") or used.get("lost", ""), "reason_code": used.get("reason_code", ""),
              "findings": used.get("findings", []), "passed": used.get("passed", []),
              "left_out": used.get("left_out", []), "unverified": used.get("unverified", []),
              "uncorrected_rms": scorer.rms(scorer.transfer(scorer.identity(len(sizes)), pairs, sizes)), "failed": True}
    joined = ~np.isin(pairs.image, record["left_out"]).any(axis=1)
    if model and sequence.kind not in BAD and joined.any():
        record.update(scorer.score(truth, model, pairs.select(joined), sizes))
        data = json.loads((folder / "lensprof.out").read_text())
        record["z"] = standardised(data, truth)
        record.update(applied(data, truth, model))
        record["worse"] = record["applied"] != "nothing" and record["clean_rms"] > scorer.rms(
            scorer.transfer(scorer.identity(len(sizes)), pairs.select(joined), sizes))
    if not keep:
        shutil.rmtree(folder)
    return record


def applied(data, truth, model):
    """What corrects the pictures, with the error of M in the corner and, over the joined images, the range and standard
    deviation of the errors of the exposures. Older programs apply all that they estimate."""
    joined = [image["ev"] is not None and image.get("joined", True) for image in data["images"]]
    off = (model.ev - truth.ev)[joined]
    return {"applied": data.get("model", "full") if data["usable"] or data.get("equalizes") else "nothing",
            "lens_prior": data.get("lens_prior"), "corner": float(model.falloff(1.0)[0]),
            "corner_error": float(abs(model.falloff(1.0) - truth.falloff(1.0))[0]),
            "ev_range": float(np.ptp(off)), "ev_deviation": float(off.std())}


def standardised(data, truth):
    """Errors divided by their stated standard errors, without alignment: {"ev": exposure of every joined image relative
    to the reference, "corner": M(1) of the first curve}. Held or undetermined values are left out."""
    reference, z = data["reference"], {"ev": [], "corner": []}
    for image, ev in zip(data["images"], truth.ev):
        if image["ev"] is not None and image.get("joined", True) and image["ev_sigma"]:
            z["ev"].append((image["ev"] - (ev - truth.ev[reference])) / image["ev_sigma"])
    if not data["covariance"]:  # there was no fit
        return z
    k, covariance = data["vignetting"]["k"], np.array(data["covariance"])
    first = len(covariance) - 2 - 3 * len(k)  # the centre is last, before it the curves' k
    sigma = float(np.sqrt(max(0.0, covariance[first:first + 3, first:first + 3].sum())))
    if sigma > 0.0:
        z["corner"].append((1.0 + sum(k[0]) - float(truth.falloff(1.0)[0])) / sigma)
    return z


def is_missed(record):
    """What is wrong with the verdict, in one word, or None."""
    if record["kind"] in OPEN:
        return "worse" if record.get("worse") else None
    if record["kind"] in GOOD:
        return "refused" if not record["usable"] else "failed" if record["failed"] else None
    return "accepted" if record["usable"] and not record["reason"] else None


def run_all(quick, tune, jobs, keep, say, match=""):
    """match: a kind, or a single case such as "smooth 17"."""
    skipped = [] if tools.OPENCV else [kind for kind in NEED_OPENCV if not match or match.startswith(kind)]
    if skipped:
        say("SKIPPED: verdicts: %s: %s" % (", ".join(skipped), tools.NO_OPENCV))
    cases, records = [s for s in sequences(quick and not match, tune)
                      if (not match or match in (s.kind, s.name)) and s.kind not in skipped], []
    with ThreadPoolExecutor(jobs) as pool:
        for record in pool.map(lambda s: measure(s, tune, keep), cases):
            records.append(record)
            if len(records) % 25 == 0 or len(records) == len(cases):
                say("verdicts: %d of %d sequences" % (len(records), len(cases)))
    return {"tune": tune, "skipped": skipped, "records": records}
