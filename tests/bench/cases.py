"""The synthetic cases, rendered by `lensprof simulate`, and the results of each tool for them."""
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import scorer
import tools

EMOR = ["emor:2.05,-0.12,-0.49,0.27,-0.18", "emor:-0.92,-0.88,1.03,0.36,-0.28", "emor:3.21,-0.4,-0.81,-0.08,0.17"]
POINT_RESPONSES = ["srgb", "gamma:2.2", "film", "linear", EMOR[0], EMOR[1]]
PICTURE_RESPONSES = ["srgb", "film", EMOR[0]]  # per seed, if the group does not name one
SHARES, COUNTS = (0, 10, 30, 50), (50, 100, 200, 300, 500, 1000)
POINT_SEEDS, PICTURE_SEEDS = 24, 3
TEST_PAIRS = "2000"

PICTURES = [
    ("sRGB", "--response srgb"),
    ("gamma 2.2", "--response gamma:2.2"),
    ("film", "--response film"),
    ("EMoR curves", "--response EMOR"),
    ("linear", "--response linear"),
    ("linear, 16 bit", "--response linear --format tiff16 --set noise=0.5"),
    ("chromatic falloff", "--vignetting -0.30,0.05,-0.15,-0.25,0.03,-0.15,-0.36,0.08,-0.16"),
    ("10 % outlier pixels", "--set outliers=0.1"),
    ("30 % outlier pixels", "--set outliers=0.3"),
    ("moving objects, 10 %", "--set objects=0.1"),
    ("moving objects, 25 %", "--set objects=0.25"),
    ("JPEG", "--format jpeg"),
    ("16-bit TIFF", "--format tiff16 --set noise=0.5"),
    ("float TIFF", "--response linear --format tiff32 --set noise=0.5"),  # as files of this kind are
    ("fixed exposure", "--set ev=0,wb=0"),
    ("misaligned 3 px", "--set misalign=3"),
    ("misaligned 10 px", "--set misalign=10"),
    ("overlap 8 degrees", "--set overlap=0.16"),
    ("2 images", "--images 2"),
    ("24 images, 2 rows", "--images 24 --set rows=2"),
    ("28 in a strip, one exposure", "--images 28 --set rows=1,hfov=16,ev=0"),
    ("EXIF tells exposures", "--exif"),
    ("EXIF within 0.1 EV", "--exif --set exif-rounding=0.1"),
    ("falloff of 4 stops", "--vignetting=-1.6,0.9,-0.2375"),
]
QUICK_PICTURES = ("sRGB", "30 % outlier pixels", "moving objects, 25 %", "JPEG", "fixed exposure", "2 images",
                  "28 in a strip, one exposure", "falloff of 4 stops")

# (case, figure, limit for every run or None); report.py prints them next to each other.
TARGETS = [
    ("moving objects, 10 %", "ev_aligned", 0.01),
    ("moving objects, 25 %", "ev_aligned", 0.03),
    ("28 in a strip, one exposure", "ev_spread", None),
    ("EXIF tells exposures", "ev_raw", None),
    ("EXIF within 0.1 EV", "ev_raw", None),
]

# No single response produces these pictures: the right answer is that the result is not usable.
REFUSALS = [
    ("local tone mapping, 0.5 EV", "--set local-tone=0.5"),
    ("local tone mapping, 1 EV", "--set local-tone=1"),
    ("local tone mapping, 2 EV", "--set local-tone=2"),
]


@dataclass
class Case:
    name: str
    groups: list      # in the tables
    seed: int
    response: str
    arguments: list   # for `lensprof simulate`
    pictures: bool
    peers: bool = True  # also run the peers and the paper's variant


def point_cases(quick, _=""):
    """As in d'Angelo's figure 1: error over the share of outliers (300 pairs) and over the number of pairs (10 %)."""
    jobs = [(300, share) for share in SHARES] + [(count, 10) for count in COUNTS if count != 300]
    for seed in range(1, (4 if quick else POINT_SEEDS) + 1):
        response = POINT_RESPONSES[(seed - 1) % len(POINT_RESPONSES)]
        for count, share in jobs:
            groups = ["300 pairs, %d %% outliers" % share] if count == 300 else []
            groups += ["%d pairs, 10 %% outliers" % count] if share == 10 and count != 300 else []
            yield Case("points_%d_%d_%d" % (count, share, seed), groups, seed, response,
                       ["--set", f"no-images=yes,points={count},outliers={share / 100.0}"], False)


def picture_cases(quick, match=""):
    return cases_of([p for p in PICTURES if match or not quick or p[0] in QUICK_PICTURES], quick, True)


def refusal_cases(quick, _=""):
    return cases_of(REFUSALS, quick, False)


def cases_of(groups, quick, peers):
    for group, options in groups:
        for seed in range(1, (1 if quick else PICTURE_SEEDS) + 1):
            words = options.replace("EMOR", EMOR[(seed - 1) % len(EMOR)]).split()
            named = "--response" in words
            response = words[words.index("--response") + 1] if named else PICTURE_RESPONSES[(seed - 1) % 3]
            name = "".join(c if c.isalnum() else "_" for c in "%s_%d" % (group, seed))
            yield Case(name, [group], 100 + seed, response, words, True, peers)


def make(case, folder):
    shutil.rmtree(folder, ignore_errors=True)
    words = case.arguments if "--response" in case.arguments else case.arguments + ["--response", case.response]
    common = ["-o", str(folder), "--seed", str(case.seed), "--set", f"test-points={TEST_PAIRS}"]
    subprocess.run([tools.LENSPROF, "simulate", *common, *words], check=True, stdout=subprocess.DEVNULL)


def calls(case, folder):
    """(tool, function, arguments) in the order in which they must run."""
    points = folder / ("pairs.txt" if case.pictures else "points.txt")
    given = ["--write", f"points={points}"] if case.pictures else ["--points", str(points)]
    yield "lensprof", tools.run_lensprof, given
    if not case.peers:
        return
    yield "lensprof-paper", tools.run_lensprof, tools.PAPER + ([] if case.pictures else given)
    if tools.VIG_OPTIMIZE:
        yield "hugin", tools.run_hugin, ["-i", str(points)]
        if case.pictures:
            yield "hugin-2000", tools.run_hugin, ["-s", "0", "-p", "2000"]
            yield "hugin-default", tools.run_hugin, []


def run_case(case, keep):
    """-> one record per tool."""
    folder = tools.WORK / "cases" / case.name
    make(case, folder)
    truth = scorer.read_truth(folder / "truth.json", case.response)
    pairs, sizes = scorer.read_points(folder / "test_points.txt"), tools.sizes_of_pto((folder / "pano.pto").read_text())
    before = scorer.rms(scorer.transfer(scorer.identity(len(sizes)), pairs, sizes))
    records = []
    for tool, run, extra in calls(case, folder):
        record = {"case": case.name, "groups": case.groups, "seed": case.seed, "response": case.response, "tool": tool,
                  "uncorrected_rms": before, "failed": True}
        used, model = run(str(folder / "pano.pto"), str(folder / tool), extra)
        used.pop("timeless", None)
        record.update(used)
        if model:
            record.update(scorer.score(truth, model, pairs, sizes))
        records.append(record)
    if not keep:
        for picture in folder.glob("img*"):
            picture.unlink()
    return records


def run_all(cases, match, jobs, keep, say):
    cases, done = [c for c in cases if not match or any(match in group for group in c.groups)], []
    with ThreadPoolExecutor(jobs) as pool:
        for records in pool.map(lambda case: run_case(case, keep), cases):
            done.append(records)
            if len(done) % 20 == 0 or len(done) == len(cases):
                say("%d of %d cases" % (len(done), len(cases)))
    return [record for records in done for record in records]
