"""How much prior knowledge of camera and lens improves a fit of overlapping pictures.

Simulated cameras take sequences through Lensfun's lenses. Exposures vary by +-1 EV and are unknown, so pictures alone
leave the exponent gamma open; it is determined by what is known beforehand:

nothing   the typical response of a kind of camera
camera    a bracket of the camera, fitted and stored
lens      Lensfun's profiles of the lens, without those of the setting, looked up
both      the bracket and the profiles in one database, looked up

Camera: a response drawn from the typical one of digital cameras by its covariance; falling curves are drawn again with
the same exponent. Lens: one of Lensfun's, with one of its focal lengths and apertures, all equally often, and of the
stored focus distances the one nearest to a distance drawn from USUAL, the shares of lensprof_store_lookup. Lookups do
not get the distance, because EXIF mostly lacks it. Lenses are from the half that was not used to choose the constants
of lookups (lookup.py). Pictures: from `lensprof simulate`, 2000 pairs with noise and a tenth of outliers. Bracket: six
frames 1 EV apart with the same noise; exposure times are off by 0.07 EV, and a common factor of the exposures in EV by
1.8 %, the repeatability of measured cameras (docs/model.md).

Errors: |M - true M| in the corner; exponent: the slope of the recovered against the true exposures. A stated standard
error holds if it is above the error: for M that of the corner, for the exponent that of ln gamma.
"""
import os
import pathlib
import shutil
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import lookup  # first, because it finds the library's Python package
import scorer
import tools
import lensprof as lp
from distance import USUAL

STATES = ("nothing", "camera", "lens", "both")
# median error of M in the corner, share of exponents within .9 .. 1.1
TARGETS = {"nothing": (0.05, 0.80), "camera": (0.03, 0.90), "lens": (0.02, 0.95), "both": (0.01, 0.98)}
HOLDS = (0.63, 0.73)  # share of errors within the stated standard errors; nominal 68 %
KIND = lp.CameraKind.STILL
PAIRS, OUTLIERS = 2000, 0.1
FRAMES, POINTS, NOISE = 6, 300, 2.0  # for a bracket; noise in levels
TIME_SIGMA_EV, REPEATABILITY = 0.07, 0.018
CORNER, DARK = 1.03, 0.05
MAKER, MODEL = "Bench", "Bench %d"


class Undo(Exception):
    """Ends a transaction without storing it."""


def exponent_of(response):
    """q, which changes as ln gamma does (docs/model.md)."""
    return np.log(np.log(response.invert(208 / 255) / response.invert(48 / 255)))


def exponent_slope(mean):
    """Derivatives of q by the EMoR coefficients, at a response."""
    low, high = mean.invert(48 / 255), mean.invert(208 / 255)
    change = [[np.interp(x, np.linspace(0, 1, 1024), lp.emor_table(1 + n)) for n in range(25)] for x in (low, high)]
    by_log = [-np.array(c) / mean.eval_slope(x) / x for c, x in zip(change, (low, high))]
    return (by_log[1] - by_log[0]) / np.log(high / low)


def draw_response(random, mean, covariance):
    """Draws the exponent first, then shapes until one rises everywhere, so that
    rejection does not change the scatter of exponents."""
    slope = exponent_slope(mean)
    along = covariance @ slope / (slope @ covariance @ slope)
    exponent = random.normal(0.0, np.sqrt(slope @ covariance @ slope))
    while True:
        shape = random.multivariate_normal(np.zeros(25), covariance, method="eigh")
        try:
            return lp.Response.from_emor(mean.emor + shape + along * (exponent - slope @ shape))
        except lp.Error:
            pass  # falls somewhere


def is_dark(row):
    """Almost no light in the farthest corner for the centre that `lensprof simulate` uses, which refuses M below 0."""
    return scorer.Model(None, None, np.array([row.k]), None, None).falloff(CORNER ** 2)[0] < DARK


def draw_row(random, lenses):
    """Draws a row and its lens's rows: -> (row, rows)."""
    row, rows = draw_any_row(random, lenses)
    return (row, rows) if not is_dark(row) else draw_row(random, lenses)


def draw_any_row(random, lenses):
    rows = lenses[random.integers(len(lenses))]
    settings = sorted({one.setting[:2] for one in rows})
    setting = settings[random.integers(len(settings))]
    group = [one for one in rows if one.setting[:2] == setting]
    distance = random.choice(USUAL[0], p=USUAL[1])
    return min(group, key=lambda one: (abs(1.0 / one.setting[2] - 1.0 / distance), one.id)), rows


def frames(random, response):
    """A bracket: (images, pairs of neighbouring frames)."""
    ev = np.arange(FRAMES) - FRAMES / 2.0
    light = np.exp(random.uniform(-5.0, 1.0, (POINTS, 1))) * np.exp(random.normal(0.0, 0.2, (POINTS, 3)))
    seen = [response.eval(np.minimum(light * 2.0 ** e, 1.0)) for e in ev]
    grey = [np.clip(np.rint(255 * s + NOISE * random.normal(size=s.shape) * (s < 1.0)), 0, 255) / 255 for s in seen]
    told = ev * np.exp(random.normal(0.0, REPEATABILITY)) + random.normal(0.0, TIME_SIGMA_EV, FRAMES)
    xy = random.uniform((100, 100), (700, 500), (POINTS, 2))
    pairs = np.zeros((FRAMES - 1, POINTS), dtype=lp.PAIR_DTYPE)
    for i in range(FRAMES - 1):
        pairs["image"][i] = i, i + 1
        pairs["xy"][i] = np.stack([xy, xy], 1)
        pairs["value"][i] = np.stack([grey[i], grey[i + 1]], 1)
    images = [lp.FitImage(i, 800, 600, free=lp.Free.EV, known_ev=told[i], known_ev_sigma=TIME_SIGMA_EV)
              for i in range(FRAMES)]
    pairs = pairs.ravel()
    inside = ((pairs["value"] > 2 / 255) & (pairs["value"] < 250 / 255)).all((1, 2))
    return images, pairs[inside]


def bracket(random, response, model):
    """The stored profile of the camera: without a lens, and without a falloff."""
    images, pairs = frames(random, response)
    found = lp.fit_overlap(images, pairs, lp.FitOptions(free=lp.Free.RESPONSE, refine=True, camera_kind=KIND, threads=1))
    return found.profile(lp.ProfileKey(camera_maker=MAKER, camera_model=model), source="bracket")


def known(store, row, rows, stored, model):
    """{state: profile or None if the lookup is refused}. The database is unchanged afterwards."""
    key = row.key.copy()
    key.camera_maker, key.camera_model, key.distance_m = MAKER, model, lp.UNKNOWN
    key.processing = lp.Processing.JPEG
    profiles = {"nothing": None}
    try:
        with store.transaction():
            for one in rows:
                if one.setting[:2] == row.setting[:2]:
                    store.remove(one.id)
            profiles["lens"] = looked_up(store, key)
            store.put(stored)
            nowhere = key.copy()
            nowhere.lens = "a lens that nobody has measured"
            profiles["camera"] = looked_up(store, nowhere, lp.LookupOptions(response_alone=True))
            profiles["both"] = looked_up(store, key)
            raise Undo
    except Undo:
        return profiles


def looked_up(store, key, options=None):
    try:
        return store.lookup(key, options)[0]
    except lp.Error as error:
        if error.status != lp.Status.ERROR_NOT_FOUND:
            raise
        return None


def simulate(folder, seed, response, row):
    """-> (images, pairs, truth)"""
    words = ["--set", f"no-images=yes,points={PAIRS},outliers={OUTLIERS},ev=1", "--seed", str(seed),
             "--response", "emor:" + ",".join("%.17g" % a for a in response.emor),
             "--vignetting=" + ",".join("%.17g" % k for k in row.k), "-o", str(folder)]
    subprocess.run([tools.LENSPROF, "simulate", *words], check=True, stdout=subprocess.DEVNULL)
    truth = scorer.read_truth(folder / "truth.json")
    sizes = tools.sizes_of_pto((folder / "pano.pto").read_text())
    images = [lp.FitImage(i, int(w), int(h)) for i, (w, h) in enumerate(sizes)]
    pairs = lp.formats.read_points(folder / "points.txt")
    shutil.rmtree(folder)
    return images, pairs, truth


def fit(images, pairs, truth, profile):
    found = lp.fit_overlap(images, pairs, lp.FitOptions(camera_kind=KIND, profile=profile, threads=1))
    corner, sigma = found.profile(lp.ProfileKey()).corner_falloff(1 if found.vignettings == 3 else 0)
    error = abs(corner - float(truth.falloff(1.0)[1]))
    slope = scorer.gauge_exponent(truth, scorer.Model(found.exposures["ev"], None, None, None, truth.curve))
    return {"corner_error": error, "corner_sigma": sigma, "slope": slope, "gamma_sigma": found.gamma_sigma,
            "known_corner": profile and profile.corner_falloff(), "usable": bool(found.usable), "prior": found.profile_prior.name, "gamma_from": found.gamma_from.name}


def run_case(number, folder, response, row, profiles):
    images, pairs, truth = simulate(folder / str(number), number, response, row)
    records = []
    for state in STATES:
        if state == "nothing" or profiles[state]:
            records.append({"case": number, "state": state, "lens": row.key.lens, "corner": float(truth.falloff(1.0)[1]),
                            **fit(images, pairs, truth, profiles[state])})
        else:
            records.append({"case": number, "state": state, "lens": row.key.lens, "refused": True})
    return records


def cases(store, stored, is_tuning, count):
    """Cameras and lenses, and the prior knowledge of each."""
    mean, covariance, _ = lp.Response.typical(KIND)
    lenses = [rows for (lens, _, camera), rows in sorted(lookup.lenses(store, stored).items())
              if lens and not camera and all(one.is_test for one in rows) != is_tuning]
    for number in range(1, count + 1):
        random = np.random.default_rng([number, 18])
        response = draw_response(random, mean, covariance)
        row, rows = draw_row(random, lenses)
        profile = bracket(random, response, MODEL % number)
        yield number, response, row, known(store, row, rows, profile, MODEL % number)


def run_all(count, is_tuning, jobs, say):
    """-> records of every case and state."""
    folder = pathlib.Path(lookup.INSTALLED)
    if not any(folder.glob("*.xml")):
        say("SKIPPED: knowledge: no Lensfun data in %s (package liblensfun-data-v1)" % folder)
        return []
    done = []
    with tempfile.TemporaryDirectory() as scratch, \
            lp.Store(pathlib.Path(scratch) / "lensfun.db", lp.StoreMode.CREATE) as store, ThreadPoolExecutor(jobs) as pool:
        stored, *_ = lookup.fill(store, folder)
        waiting = [pool.submit(run_case, case[0], pathlib.Path(scratch), *case[1:])
                   for case in cases(store, stored, is_tuning, count)]
        for n, result in enumerate(waiting, 1):
            done += result.result()
            if n % 20 == 0 or n == count:
                say("knowledge: %d of %d sequences" % (n, count))
    return done
