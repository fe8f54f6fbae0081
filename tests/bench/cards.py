"""Both errors of the verdict on rendered cards: good ones that are refused, and bad ones that are accepted.

Every option is drawn from the seed; `--tune` uses other seeds than the reported figures. A card does harm if it is
accepted and what is applied, polynomial and gain grid, is wrong by more than HARM anywhere in the frame.
"""
import json
import random
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import tools
from flat import falloff, write_png

GOOD = ("even", "sloped", "turned", "dusty", "edge", "deep", "pedestal")
BAD = ("lamp", "pedestal alone", "textured", "scene", "shadow", "clipped", "steep", "wrong exposures", "wrong turns",
       "light changed", "partial", "wrong response")
# Reasons that name what is wrong, where an accepted card can be no better than a note
NAMED = {"lamp": ("flat_one_light",), "pedestal alone": ("flat_black_level",),
         "sloped": ("flat_center_by_prior", "flat_one_light")}
COUNT_GOOD, COUNT_BAD, QUICK = 50, 20, 3  # cards per kind
HARM = 0.02  # of M
RADII = np.linspace(0.0, 1.0, 41)  # half diagonals
PLACES = 97, 73  # where a falloff is compared
SCENES = "landscape", "sky", "wall", "foliage", "interior"
TURNS = 0, 90, 180, 270
EXPOSURES = [0.0], [0.0], [-1.0, 1.0], [-1.5, 0.0, 1.5]  # EV
CODINGS = ({"form": "png16", "gamma": 1.0},) * 3 + ({"form": "png8", "gamma": 2.2}, {"form": "jpeg", "gamma": 2.2})


def pick(r, values):
    return values[r.randrange(len(values))]


def common(r):
    """A good card under an even light. gradient: of the light, per half diagonal; bend: of its logarithm, as of a lamp
    at a distance; level: of white, in the middle; noise: levels of 255, at white."""
    shots, depth, first, second = r.randrange(1, 5), r.uniform(0.15, 0.7), r.uniform(0.5, 1.3), r.uniform(-0.3, 0.3)
    turns = r.choices(TURNS, k=shots) if r.random() < 0.5 else [0] * shots
    coding = dict(pick(r, CODINGS))
    return {"seed": r.randrange(1 << 30), "size": pick(r, ((480, 360), (480, 320), (360, 480))),
            "k": [-depth * first, -depth * second, -depth * (1.0 - first - second)], "cosine": r.random() < 0.3,
            "center": [r.gauss(0.0, 0.015), r.gauss(0.0, 0.015)], "noise": pick(r, (0.3, 1.0, 2.0)),
            "balance": [r.uniform(0.6, 1.0), 1.0, r.uniform(0.6, 1.0)], "turns": turns, "stated_turns": turns,
            "evs": pick(r, EXPOSURES), "stated_evs": None, "coding": coding, "stated_gamma": coding["gamma"],
            "level": r.uniform(0.35, 0.8), "drift": [r.uniform(0.8, 1.0) for _ in turns],
            "gradients": [[r.uniform(0.0, 0.02), r.uniform(0.0, 360.0)]] * shots, "bend": r.uniform(0.1, 0.25),
            "texture": [r.uniform(0.0, 0.002), r.uniform(0.7, 3.0)], "spots": [], "border": 0.0, "white": 0.0}


def turned(r, card, least=0.0, most=0.3):
    """The light slopes, and at least one shot is rotated."""
    turns = [0, *(pick(r, TURNS[1:]) for _ in range(r.randrange(1, 4)))]
    return {"turns": turns, "stated_turns": turns, "drift": [r.uniform(0.8, 1.0) for _ in turns],
            "gradients": [[r.uniform(least, most), r.uniform(0.0, 360.0)]] * len(turns)}


def single(r, card, least=0.02, most=0.08):
    return {"turns": [0], "stated_turns": [0], "drift": [1.0],
            "gradients": [[r.uniform(least, most), r.uniform(0.0, 360.0)]]}


def dusty(r, card):
    """Spots on the sensor: place, radius in px, depth. Texture below half a percent; a black border of 2 px."""
    spots = [[r.random(), r.random(), r.uniform(1.5, 6.0), r.uniform(0.02, 0.3)] for _ in range(r.randrange(2, 16))]
    return {"spots": spots, "texture": [r.uniform(0.001, 0.004), r.uniform(0.7, 6.0)],
            "border": pick(r, (0.0, 0.0, 0.0, 0.005))}


def deep(r, card):
    """Three to five stops at the corner, by the law of the cosine."""
    return {**single(r, card, 0.0, 0.02), "cosine": True, "k": [r.uniform(0.03, 0.12) - 1.0, 0.0, 0.0],
            "coding": dict(CODINGS[0]), "stated_gamma": 1.0, "noise": 0.3, "level": r.uniform(0.6, 0.8)}


def pedestal(r, card):
    """A black level that nobody stated, at two exposures: of one shot, or of shots by hand."""
    evs = [r.uniform(-2.0, -1.0), 0.0]
    card = {**single(r, card, 0.0, 0.03), "coding": dict(CODINGS[0]), "stated_gamma": 1.0, "black": r.uniform(0.01, 0.07),
            "evs": evs, "stated_evs": [evs[0] + r.gauss(0.0, 0.05), 0.0]}
    if r.random() < 0.5:
        return card
    return {**card, "turns": [0, 0], "stated_turns": [0, 0], "evs": [0.0], "stated_evs": None,
            "drift": [1.0, 2.0**evs[0]], "gradients": card["gradients"] * 2}


def pedestal_alone(r, card):
    return {**pedestal(r, card), "black": r.uniform(0.03, 0.07), "evs": [0.0], "stated_evs": None, "turns": [0],
            "stated_turns": [0], "drift": [1.0], "gradients": [[r.uniform(0.0, 0.03), r.uniform(0.0, 360.0)]]}


def edge(r, card):
    """The image circle ends within the frame: its radius, half diagonals, and where, seen from the falloff's centre."""
    return {**single(r, card, 0.0, 0.02), "coding": dict(pick(r, CODINGS[2:4])), "circle": [
        r.uniform(0.6, 0.95), r.gauss(0.0, 0.01), r.gauss(0.0, 0.01)], "stated_gamma": None}


def lamp(r, card):
    """The light is brighter in the middle; nothing in one card shows that."""
    return {**single(r, card, 0.0, 0.02), "lamp": r.uniform(0.1, 0.5)}


def steep(r, card):
    return turned(r, card, 0.6, 1.2) if r.random() < 0.3 else single(r, card, 0.3, 0.8)


def shadow(r, card):
    """An edge that is at most a few px wide, or a second lamp. place: half diagonals from the middle, in the scene."""
    return {"shadow": {"lamp": r.random() < 0.4, "angle": r.uniform(0.0, 360.0), "place": r.uniform(-0.4, 0.6),
                       "strength": r.uniform(0.05, 0.4), "width": r.uniform(0.2, 0.5), "edge": r.uniform(0.002, 0.02)}}


def wrong_exposures(r, card):
    evs = pick(r, EXPOSURES[2:])
    stated = list(evs)
    stated[r.randrange(len(evs))] += pick(r, (-1, 1)) * r.uniform(0.4, 1.5)
    return {"evs": evs, "stated_evs": stated}


def wrong_turns(r, card):
    found = turned(r, card, 0.1, 0.3)
    wrong = [found["turns"][0], (found["turns"][1] + pick(r, TURNS[1:])) % 360, *found["turns"][2:]]
    return {**found, "stated_turns": wrong}


def light_changed(r, card):
    found = turned(r, card)
    return {**found, "gradients": [[r.uniform(0.1, 0.4), r.uniform(0.0, 360.0)] for _ in found["turns"]]}


def partial(r, card):
    """The card ends at one or two sides; beyond it, something darker with structure."""
    covered, grey = r.uniform(0.35, 0.65), r.uniform(0.1, 0.7)
    return {"extent": pick(r, ([covered, 1.0], [1.0, covered], [covered ** 0.5] * 2)), "grey": grey}


def wrong_response(r, card):
    true, stated = pick(r, ((2.2, 1.0), (1.0, 2.2), (1.8, 2.4), (2.4, 1.8)))
    return {"coding": {"form": "png16", "gamma": true}, "stated_gamma": stated}


DRAWS = {"even": lambda r, card: {}, "deep": deep, "pedestal": pedestal, "pedestal alone": pedestal_alone,
         "edge": edge, "lamp": lamp,
         "sloped": single, "turned": turned, "dusty": dusty,
         "textured": lambda r, card: {"texture": [r.uniform(0.02, 0.08), r.uniform(2.0, 25.0)]},
         "scene": lambda r, card: {"cosine": False, "evs": [0.0], "scene": pick(r, SCENES)},
         "shadow": shadow, "clipped": lambda r, card: {"evs": [0.0], "white": r.uniform(0.05, 0.4)}, "steep": steep,
         "wrong exposures": wrong_exposures, "wrong turns": wrong_turns, "light changed": light_changed,
         "partial": partial, "wrong response": wrong_response}


def cards(quick, tune):
    for kind in GOOD + BAD:
        for number in range(QUICK if quick else COUNT_GOOD if kind in GOOD else COUNT_BAD):
            r = random.Random("card %s %d %s" % (kind, number, "tune" if tune else "report"))
            card = common(r)
            card.update(DRAWS[kind](r, card), kind=kind, number=number, name="%s %d" % (kind, number))
            card["stated_gamma"] = card["stated_gamma"] or card["coding"]["gamma"]
            yield card


def true_falloff(card, r2):
    """A polynomial, or the law of the cosine for the same corner."""
    k = card["k"]
    return (1.0 + ((1.0 + sum(k)) ** -0.5 - 1.0) * r2) ** -2.0 if card["cosine"] else falloff(k, r2)


def structure(strength, scale_px, shape, seed):
    """A factor of smoothed noise."""
    draw = np.fft.rfft2(np.random.default_rng(seed).standard_normal(shape))
    f2 = np.fft.fftfreq(shape[0])[:, None]**2 + np.fft.rfftfreq(shape[1])**2
    field = np.fft.irfft2(draw * np.exp(-2.0 * (np.pi * scale_px)**2 * f2), shape)
    return np.exp(strength * field / field.std())


def scene_light(card, shot, dx, dy):
    """The light on the card, at half diagonals from the middle of the frame."""
    turn = np.radians(card["turns"][shot])
    x, y = np.cos(turn) * dx - np.sin(turn) * dy, np.sin(turn) * dx + np.cos(turn) * dy
    size, angle = card["gradients"][shot]
    slope = size * (x * np.cos(np.radians(angle)) + y * np.sin(np.radians(angle)))
    light = np.exp(slope + card["bend"] * slope**2) / (1.0 + card.get("lamp", 0.0) * (dx**2 + dy**2))
    if "shadow" in card:
        s, angle = card["shadow"], np.radians(card["shadow"]["angle"])
        along = x * np.cos(angle) + y * np.sin(angle) - s["place"]
        across = y * np.cos(angle) - x * np.sin(angle)
        light *= 1.0 + s["strength"] * np.exp(-(along**2 + across**2) / s["width"]**2) if s["lamp"] else \
            1.0 - s["strength"] * 0.5 * (1.0 + np.tanh(along / s["edge"]))
    return light


def card_light(card, shot):
    """The light that reaches the sensor in a shot, relative to that in the middle."""
    (width, height), seed = card["size"], [card["seed"], shot]
    y, x = np.mgrid[0:height, 0:width]
    half = np.hypot(width, height) / 2.0
    dx, dy = (x - (width - 1) / 2) / half, (y - (height - 1) / 2) / half
    light = scene_light(card, shot, dx, dy) * structure(*card["texture"], dx.shape, seed)
    if "extent" in card:
        beyond = (x > card["extent"][0] * width) | (y > card["extent"][1] * height)
        light[beyond] = card["grey"] * structure(0.05, 10.0, dx.shape, seed)[beyond]
    light *= true_falloff(card, (dx - card["center"][0])**2 + (dy - card["center"][1])**2)
    for across, down, radius, depth in card["spots"]:
        light *= 1.0 - depth * np.exp(-(np.hypot(x - across * width, y - down * height) / radius)**4)
    if "circle" in card:
        radius, across, down = card["circle"]
        out = np.hypot(dx - card["center"][0] - across, dy - card["center"][1] - down) - radius
        light *= 0.5 - 0.5 * np.tanh(out / 0.006)
    edge = card["border"] * width
    light[(np.minimum(x, width - 1 - x) < edge) | (np.minimum(y, height - 1 - y) < edge)] = 0.0
    return light


def write_pictures(card, folder):
    """All exposures of all shots, in order."""
    names, coding = [], card["coding"]
    for shot, drift in enumerate(card["drift"]):
        light = card_light(card, shot)
        level = 1.0 / np.quantile(light, 1.0 - card["white"]) if card["white"] else card["level"] * drift
        for exposure, ev in enumerate(card["evs"]):
            values = np.clip(level * 2.0**ev * light[:, :, None] * card["balance"], 0.0, 1.0)
            noise = np.random.default_rng([card["seed"], shot, exposure]).standard_normal(values.shape)
            values = values**(1.0 / coding["gamma"]) + card["noise"] / 255.0 * np.sqrt(values) * noise
            values = card.get("black", 0.0) + (1.0 - card.get("black", 0.0)) * values
            names.append(folder / ("%d_%d.%s" % (shot, exposure, "jpg" if coding["form"] == "jpeg" else "png")))
            if coding["form"] == "jpeg":
                import cv2
                cv2.imwrite(str(names[-1]), np.rint(255.0 * np.clip(values[:, :, ::-1], 0.0, 1.0)).astype(np.uint8))
            else:
                write_png(names[-1], values, 8 if coding["form"] == "png8" else 16)
    return names


def simulate_scene(card, folder):
    shots = len(card["turns"])
    subprocess.run([tools.LENSPROF, "simulate", "-o", folder, "--images", str(max(2, shots)), "--scene", card["scene"],
                    "--size", "%dx%d" % tuple(card["size"]), "--response", "linear", "--format", "png16", "--seed",
                    str(card["seed"]), "--vignetting=%.6f,%.6f,%.6f" % tuple(card["k"]), "--set",
                    "center=%.4f,%.4f,noise=%g" % (*card["center"], card["noise"])], check=True,
                   stdout=subprocess.DEVNULL)
    return sorted(folder.glob("img*"))[:shots]


def arguments(card):
    """What is stated of the pictures."""
    shots, evs = len(card["turns"]), card["stated_evs"] or card["evs"]
    gamma = 1.0 if "scene" in card else card["stated_gamma"]
    found = ["--linear"] if gamma == 1.0 else ["--fit", "gamma=%g" % gamma]
    found += ["--rotation", ",".join(map(str, card["stated_turns"]))] if any(card["stated_turns"]) else []
    if len(evs) > 1:
        found += ["--shots", ",".join(str(shot + 1) for shot in range(shots) for _ in evs),
                  "--ev=" + ",".join("%.4f" % ev for _ in range(shots) for ev in evs)]
    return found


def corner_places(card, end):
    """Where the corner is, half diagonals from the middle: of the frame, or around the end of the data."""
    width, height = (np.array(card["size"]) - 1.0) / np.hypot(*card["size"])  # the middle of the last pixel
    if not end:
        return np.array([width, -width, width, -width]), np.array([height, height, -height, -height])
    angle = np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False)
    x = card["center"][0] + end * np.cos(angle)
    y = card["center"][1] + end * np.sin(angle)
    inside = (abs(x) <= width) & (abs(y) <= height)
    return (x[inside], y[inside]) if inside.any() else corner_places(card, None)


def errors(card, data):
    """Largest relative error of M over the radii, of the polynomial alone; and over the frame, of what is applied. Both
    within the image circle."""
    curves, (width, height), grid = data["vignetting"]["k"], card["size"], data["gain_grid"]
    end = card["circle"][0] - 0.03 if "circle" in card else 1.0
    radii2 = (end * RADII)**2
    radial = max(float(abs(falloff(k, radii2) / true_falloff(card, radii2) - 1.0).max()) for k in curves)
    half = np.hypot(width, height)
    dx, dy = np.meshgrid(np.linspace(1 - width, width - 1, PLACES[0]) / half,
                         np.linspace(1 - height, height - 1, PLACES[1]) / half)

    def r2(center):
        return (dx - center[0])**2 + (dy - center[1])**2

    found = np.array([falloff(k, r2(data["vignetting"]["center"])) for k in curves])
    found = found * (np.array([between(nodes) for nodes in grid["attenuation"]]) if grid else 1.0)
    off = abs(found / true_falloff(card, r2(card["center"])) - 1.0)
    return radial, float(off[..., r2(card["center"]) < end**2].max() if "circle" in card else off.max())


def between(nodes):
    """A gain grid at the places where a falloff is compared, bilinear."""
    nodes = np.array(nodes)
    for axis, count in ((0, PLACES[1]), (1, PLACES[0])):
        at = np.linspace(0.0, nodes.shape[axis] - 1.0, count)
        first = np.minimum(at.astype(int), nodes.shape[axis] - 2)
        share = (at - first).reshape((-1, 1) if axis == 0 else (1, -1))
        nodes = np.take(nodes, first, axis) * (1.0 - share) + np.take(nodes, first + 1, axis) * share
    return nodes


def true_corner(card, end):
    x, y = corner_places(card, end)
    return float(true_falloff(card, (x - card["center"][0])**2 + (y - card["center"][1])**2).mean())


def measure(card, tune, keep):
    folder = tools.WORK / "cards" / ("%s_%s" % (card["name"].replace(" ", "_"), "tune" if tune else "report"))
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    names = simulate_scene(card, folder) if "scene" in card else write_pictures(card, folder)
    done = subprocess.run([tools.LENSPROF, "flat", *names, *arguments(card), "--no-store", "--json"],
                          capture_output=True, text=True, check=False)
    if done.returncode not in (0, 4):
        raise RuntimeError("%s: %s" % (card["name"], done.stderr[-300:]))
    data = json.loads(done.stdout)
    severe = [f["text"] for f in data["findings"] if f["severity"] in ("refusal", "warning")]
    record = {**card, **{key: data[key] for key in ("usable", "findings", "passed")}}
    record["reason"] = severe[0] if severe else ""
    record["error"], record["frame_error"] = errors(card, data)
    corner = true_corner(card, data["edge"] and data["radius"])
    off = data["corner"] - corner
    record.update(corner=data["corner"], true_corner=corner, edge=data["edge"], corner_sigma=data["corner_sigma"],
                  residual=data["residual"], z=off / data["corner_sigma"] if data["corner_sigma"] else None,
                  seconds=sum(data["seconds"].values()))
    if not keep:
        shutil.rmtree(folder)
    return record


def run_all(quick, tune, jobs, keep, say, match=""):
    """match: a kind, or a single case such as "even 17"."""
    chosen = [c for c in cards(quick and not match, tune) if not match or match in (c["kind"], c["name"])]
    skipped = [c["name"] for c in chosen if c["coding"]["form"] == "jpeg" and "scene" not in c and not tools.OPENCV]
    if skipped:
        say("SKIPPED: cards: %d JPEG: %s" % (len(skipped), tools.NO_OPENCV))
    chosen, records = [c for c in chosen if c["name"] not in skipped], []
    with ThreadPoolExecutor(jobs) as pool:
        for record in pool.map(lambda c: measure(c, tune, keep), chosen):
            records.append(record)
            if len(records) % 50 == 0 or len(records) == len(chosen):
                say("cards: %d of %d" % (len(records), len(chosen)))
    return {"tune": tune, "skipped": skipped, "records": records}
