"""Would an ellipse make the gain grid unnecessary? Forms of the falloff compared on real shading.

    radial    M = 1 + k1 r^2 + k2 r^4 + k3 r^6, or ln M = l1 u + ... + l6 u^6, u = r^2 / (1 + r^2), as `lensprof flat`
    ellipse   the same, with d' A d for r^2: A is symmetric with determinant 1 (its scale belongs to k), so the ratio
              of the axes is one unknown and their angle another. Compare the deformable radial polynomial of Bal &
              Palus 2023, Sensors 23(3) 1157
    tilt      radial and a plane, added to M or ln M: as many unknowns as an ellipse with an angle
    grid      radial, times bilinear nodes, 24 along the longer side, with the stiffness of src/fit/flat/grid.cpp

Tables: every shading table of libcamera for the Raspberry Pi below DIR/shading (of `--real DIR`) and in the package
libcamera-ipa; a case is a channel under one light. Equal tables count once. A cell of a table is as wide as about six
cells of `lensprof flat`, so the RMS of the relative residual over the table is the measure that the finding
`flat_not_radial` compares with its limits of .003 (note; a gain grid is fitted from there on) and .01 (warning). Errors
are held out: a fit to three quarters of the blocks of 2 x 2 cells predicts the fourth, four times. Of the polynomial
and the logarithm, the form with the smaller error counts, for each shape. `lensprof flat` itself also measures each
table, as a card of cubic splines through the cells.

Sequences: every project below DIR/overlaps. `lensprof build` draws the pairs and fits the response; the differences of
ln light between the two ends of a pair determine ln M and a constant per link of two images, robustly. Links are held
out, up to five groups of them: pairs of one link share its misalignment and what moved. The noise is far above .003, so
shapes are compared by the standard error of the difference between their held-out residuals.

Criterion, fixed before the first run: the ellipse, with or without an angle, earns its place if its held-out error is
below .003 in at least a quarter of the cases in which that of the radial form with a free centre is not. For sequences:
in at least a quarter of those in which the grid predicts better than the radial form by two standard errors, it does
not predict better than an ellipse by as much. Changed after the first run: links are held out instead of single pairs;
the grid of sequences has the stiffness with the smallest held-out error (of .1, 1 and 10); colours of monochrome
sensors are left out.

Rendered frames (a fisheye, an ellipse) only show that the fits find what is there.
"""
import json
import pathlib

import numpy as np

import flat
import real
import scorer
import tools

NOTE, WARNING = 0.003, 0.01  # kGridNeeded and kNotRadial, kMuchNotRadial of src/fit/flat
PACKAGE = pathlib.Path("/usr/share/libcamera/ipa")
WIDE = ("imx290", "imx708", "se327m12")  # 16:9; the other sensors are 4:3
CENTER_SIGMA = 0.02  # half diagonals; the prior of `lensprof flat`, relative to cells with an error of NOTE
NODES, STIFFNESS, RIDGE = 24, 0.02, 1e-6  # of src/fit/flat/grid.cpp
SHAPES = {"radial": 0, "radial, centre": 2, "ellipse": 3, "ellipse, angle": 4}  # unknowns of the shape
ELLIPSES = ("ellipse", "ellipse, angle")
TERMS = {"powers": 3, "logarithm": 6}
FOLDS, CLIP, ROUNDS = 5, 3.0, 4  # of sequences; a residual counts up to so many standard deviations
PAIR_TERMS, PAIR_NODES, PAIR_STIFFNESS = 3, 8, 0.1  # fewer terms and nodes, and stiffer: pairs are noisy
DARKEST, BRIGHTEST = 0.08, 0.92  # grey values that count
CARD_WIDTH, CARD_LIGHT, CARD_NOISE = 960, 0.6, 5e-4  # px; of full scale


def radius2(shape, x, y):
    """d' A d. shape: centre, p and q of A = exp([[p, q], [q, -p]]); those that are missing are 0."""
    cx, cy, p, q = np.concatenate([shape, np.zeros(4 - len(shape))])
    size = np.hypot(p, q)
    share = np.sinh(size) / size if size > 1e-9 else 1.0
    dx, dy = x - cx, y - cy
    return np.cosh(size) * (dx**2 + dy**2) + share * (p * (dx**2 - dy**2) + 2 * q * dx * dy)


def axes(shape):
    """Ratio of the longer axis to the shorter one, and the angle of the longer one in degrees, from x towards y."""
    p, q = np.concatenate([shape, np.zeros(4 - len(shape))])[2:]
    return float(np.exp(np.hypot(p, q))), float(np.degrees(np.arctan2(-q, -p)) / 2 % 180)


def terms_of(form, r2):
    base = r2 if form == "powers" else r2 / (1 + r2)
    return np.stack([base**n for n in range(1, TERMS[form] + 1)], axis=1)


def solve(columns, right):
    """Least squares, independent of the units of the columns."""
    scale = np.linalg.norm(columns, axis=0)
    scale[scale == 0.0] = 1.0
    return np.linalg.lstsq(columns / scale, right, rcond=1e-9)[0] / scale


def minimise(residual, start, steps=40):
    """Levenberg-Marquardt with derivatives by differences. residual: of the unknowns of the shape, after the linear
    ones were eliminated."""
    u, damping = np.array(start, float), 1e-3
    now = residual(u)
    for _ in range(steps if len(u) else 0):
        slope = np.stack([(residual(u + step) - residual(u - step)) / 2e-5 for step in 1e-5 * np.eye(len(u))], axis=1)
        normal = slope.T @ slope
        step = np.linalg.solve(normal + damping * np.diag(np.diag(normal) + 1e-12), -slope.T @ now)
        tried = u + step * min(1.0, 0.2 / np.abs(step).max())
        there = residual(tried)
        gain = now @ now - there @ there
        if gain > 0.0:
            is_done = gain < 1e-9 * (now @ now)
            u, now, damping = tried, there, damping / 10
        else:
            damping *= 10
            is_done = damping > 1e6
        if is_done:
            break
    return u


def bilinear(sides, columns, rows, x, y):
    """Weights of the nodes of a grid over the frame at places: [places, nodes]. sides: of the frame, half diagonals."""
    out = np.zeros((len(x), rows, columns))
    at = [np.clip((v / side + 0.5) * (n - 1), 0, n - 1) for v, side, n in zip((x, y), sides, (columns, rows))]
    first = [np.minimum(v.astype(int), n - 2) for v, n in zip(at, (columns, rows))]
    part = [v - f for v, f in zip(at, first)]
    for i in (0, 1):
        for j in (0, 1):
            out[np.arange(len(x)), first[1] + j, first[0] + i] += np.abs(1 - i - part[0]) * np.abs(1 - j - part[1])
    return out.reshape(len(x), -1)


def grid_size(sides, nodes):
    return tuple(max(2, round(nodes * side / max(sides))) for side in sides)


def stiff(columns, rows):
    """Normal matrix of the second differences along both sides."""
    across, down = (np.diff(np.eye(n), 2, axis=0) for n in (columns, rows))
    across, down = np.kron(np.eye(rows), across), np.kron(down, np.eye(columns))
    return across.T @ across + down.T @ down


class Card:
    """Light of a card at the middles of cells, in half diagonals from the frame's middle: flattened."""

    def __init__(self, light, aspect):
        rows, columns = light.shape
        half = 0.5 * np.hypot(aspect, 1.0)
        x, y = [(np.arange(n) + 0.5) / n - 0.5 for n in (columns, rows)]
        self.x, self.y = (g.ravel() for g in np.meshgrid(x * aspect / half, y / half))
        self.shape = light.shape
        self.light, self.sides = light.ravel() / light.max(), (aspect / half, 1.0 / half)
        column, row = np.meshgrid(np.arange(columns) // 2, np.arange(rows) // 2)
        self.fold = ((column + 2 * row) % 4).ravel()
        mixed = np.diff(np.diff(np.log(light), 2, axis=0), 2, axis=1)  # almost nothing of a smooth falloff remains
        self.noise = deviation(mixed) / 6.0


def deviation(residual):
    return 1.4826 * float(np.median(np.abs(residual)))


def fit_card(card, rows, form, unknowns, has_plane=False):
    """-> (shape, prediction at all places). The polynomial is linear in level and level k, the logarithm in l."""
    is_log = form == "logarithm"

    def columns(shape):
        parts = [np.ones((len(card.x), 1)), terms_of(form, radius2(shape, card.x, card.y))]
        return np.hstack(parts + [np.stack([card.x, card.y], axis=1)] * has_plane)

    def equations(shape):
        return (columns(shape)[rows], np.log(card.light[rows])) if is_log else \
            (columns(shape)[rows] / card.light[rows, None], np.ones(rows.sum()))

    def residual(shape):
        a, b = equations(shape)
        return np.append(a @ solve(a, b) - b, NOTE / CENTER_SIGMA * shape[:2])

    shape = minimise(residual, np.zeros(unknowns))
    value = columns(shape) @ solve(*equations(shape))
    return shape, np.exp(value) if is_log else np.maximum(value, 1e-6)


def fit_grid(card, rows, radial):
    """radial times the grid of what it leaves, at all places."""
    columns, lines = grid_size(card.sides, NODES)
    weights, typical = bilinear(card.sides, columns, lines, card.x, card.y), rows.sum() / (columns * lines)
    normal = weights[rows].T @ weights[rows] \
        + typical * (STIFFNESS * stiff(columns, lines) + RIDGE * np.eye(columns * lines))
    right = weights[rows].T @ (card.light / radial)[rows] + typical * RIDGE
    return radial * (weights @ np.linalg.solve(normal, right))


def errors(card, predict):
    """predict(rows): light at all places, from the light of some -> held-out errors, relative; and `pattern`, RMS of
    the fit to all places less the noise, as `lensprof flat` measures it."""
    error = np.zeros(len(card.x))
    for fold in range(4):
        out = card.fold == fold
        error[out] = (card.light / predict(~out) - 1.0)[out]
    fitted = scorer.rms(card.light / predict(np.ones(len(card.x), bool)) - 1.0)
    return {"rms": scorer.rms(error), "worst": float(np.abs(error).max()),
            "pattern": float(np.sqrt(max(fitted**2 - card.noise**2, 0.0)))}


def best_form(card, unknowns, has_plane=False):
    found = [dict(errors(card, lambda rows, f=form: fit_card(card, rows, f, unknowns, has_plane)[1]), form=form,
                  parameters=terms + unknowns + 2 * has_plane) for form, terms in TERMS.items()]
    return min(found, key=lambda f: f["rms"])


def compare_card(card):
    """{shape: errors, number of parameters of a curve, and axes of an ellipse}"""
    every = np.ones(len(card.x), bool)
    shapes = {name: best_form(card, unknowns) for name, unknowns in SHAPES.items()}
    shapes["tilt"] = best_form(card, 2, True)
    radial = shapes["radial, centre"]
    columns, lines = grid_size(card.sides, NODES)
    shapes["grid"] = dict(errors(card, lambda rows: fit_grid(card, rows, fit_card(card, rows, radial["form"], 2)[1])),
                          parameters=radial["parameters"] + columns * lines)
    if columns * lines > len(card.x):
        shapes["grid"]["pattern"] = None  # more nodes than cells: no residual of its own
    for name in ELLIPSES:
        shapes[name]["axes"] = axes(fit_card(card, every, shapes[name]["form"], SHAPES[name])[0])
    return {"noise": card.noise, "shapes": shapes}


def drawn(values, count):
    """Cubic (Catmull-Rom) through the middles of cells along the first axis, at the middles of so many pixels; two more
    cells beyond either end continue the parabola of the last three."""
    cells = list(values)
    for _ in range(2):
        cells = [3 * cells[0] - 3 * cells[1] + cells[2], *cells, 3 * cells[-1] - 3 * cells[-2] + cells[-3]]
    cells = np.array(cells)
    at = (np.arange(count) + 0.5) / count * len(values) + 1.5
    first = at.astype(int)
    t = (at - first).reshape(-1, *[1] * (values.ndim - 1))
    a, b, c, d = (cells[first + n] for n in (-1, 0, 1, 2))
    return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)))


def of_program(card):
    """The residuals that `lensprof flat` states of a card, without and with its gain grid; None: no result."""
    height = round(CARD_WIDTH * card.sides[1] / card.sides[0])
    light = CARD_LIGHT * drawn(drawn(card.light.reshape(card.shape), height).T, CARD_WIDTH).T
    light = light + np.random.default_rng(1).normal(0, CARD_NOISE, light.shape)
    path = tools.WORK / "forms" / "card.png"
    path.parent.mkdir(parents=True, exist_ok=True)
    flat.write_png(path, np.repeat(light[:, :, None], 3, axis=2))
    found = flat.call("flat", path, "--linear", "--light", "even", "--no-store", "--json")
    return found and {"frame": found["residual"]["frame"], "with_grid": found["residual"]["with_grid"]}


def tables_of(path):
    """(channel and light, light of a card) of a tuning file: the gains of green, and those of red and blue relative to
    it. Those of monochrome sensors have no meaning."""
    def light_of(gains, columns):
        return 1.0 / np.array(gains, float).reshape(-1, columns)

    found = [v for a in json.loads(path.read_text())["algorithms"] for k, v in a.items() if k.endswith("alsc")]
    for tables in (t for t in found if t.get("luminance_lut")):
        columns = {192: 16, 1024: 32}[len(tables["luminance_lut"])]
        green = light_of(tables["luminance_lut"], columns)
        yield "green", green
        for name, key in (("red", "calibrations_Cr"), ("blue", "calibrations_Cb")):
            for of in tables.get(key, []) if "mono" not in path.stem else ():
                yield "%s %d K" % (name, of["ct"]), green * light_of(of["table"], columns)


def tables_below(folders):
    """{(camera, channel and light): Card}; a table that is equal to one before it is left out."""
    cards, seen = {}, set()
    for path in sorted((p for f in folders for p in f.rglob("*.json")), key=lambda p: (p.stem, str(p))):
        for name, light in tables_of(path):
            if light.tobytes() not in seen:
                seen.add(light.tobytes())
                cards[path.stem, name] = Card(light, 16 / 9 if path.stem.startswith(WIDE) else 4 / 3)
    return cards


def rendered():
    """Frames of 32 x 24 cells with noise of .001: an equidistant fisheye, cos^4 of the angle, 1 rad per half diagonal,
    centre moved; and an ellipse with axes of 1.25 : 1, turned by 20 degrees."""
    draw, frame = np.random.default_rng(5), Card(np.ones((24, 32)), 4 / 3)
    turn = np.radians(40)
    ellipse = [0.02, 0.01, -np.log(1.25) * np.cos(turn), -np.log(1.25) * np.sin(turn)]
    lights = {"fisheye": np.cos(np.sqrt(radius2([0.04, -0.03], frame.x, frame.y)))**4,
              "ellipse": 1 - 0.5 * radius2(ellipse, frame.x, frame.y)}
    return {("rendered", name): Card((light * (1 + draw.normal(0, 1e-3, light.shape))).reshape(24, 32), 4 / 3)
            for name, light in lights.items()}


class Ends:
    """Differences of ln light between the two ends of pairs, mean of the channels, with the response found."""

    def __init__(self, pairs, curve, sizes):
        light = np.log(np.maximum(curve.g(pairs.value), 1e-9))
        good = ((pairs.value > DARKEST) & (pairs.value < BRIGHTEST)).all(axis=(1, 2))
        pairs, light = pairs.select(good), light[good]
        self.difference = (light[:, 0] - light[:, 1]).mean(axis=1)
        size = np.asarray(sizes, float)[pairs.image]
        half = 0.5 * np.hypot(size[..., 0], size[..., 1])[..., None]
        self.x, self.y = np.moveaxis((pairs.xy - 0.5 * (size - 1)) / half, 2, 0)
        self.sides = tuple((size / half)[0, 0])
        links, link = np.unique(np.sort(pairs.image, axis=1), axis=0, return_inverse=True)
        self.link = link.ravel()
        self.sign = np.where(pairs.image[:, 0] < pairs.image[:, 1], 1.0, -1.0)
        self.constants = np.eye(len(links))[self.link] * self.sign[:, None]
        self.fold = self.link % min(FOLDS, len(links))

    def between(self, basis):
        """basis(x, y) of the first end less that of the second."""
        return basis(self.x[:, 0], self.y[:, 0]) - basis(self.x[:, 1], self.y[:, 1])

    def levelled(self, residual):
        """Each link less its median: the constant of a link that the fit did not see."""
        middles = [np.median((residual * self.sign)[self.link == n]) for n in range(self.constants.shape[1])]
        return residual - self.sign * np.array(middles)[self.link]


def trust(residual):
    """Square roots of the weights of a robust fit."""
    return 1.0 / np.sqrt(1.0 + (residual / (2.0 * deviation(residual)))**2)


def fit_ends(ends, rows, unknowns):
    """-> (shape, residual of all pairs) of a fit to some."""
    def columns(shape):
        basis = ends.between(lambda x, y: terms_of("logarithm", radius2(shape, x, y))[:, :PAIR_TERMS])
        return np.hstack([basis, ends.constants])

    weight, scale, shape, left = np.ones(rows.sum()), 0.1, np.zeros(unknowns), ends.difference
    for _ in range(ROUNDS):
        def equations(u, w=weight):
            return columns(u)[rows] * w[:, None], ends.difference[rows] * w

        def residual(u, s=scale):
            a, b = equations(u)
            return np.append(a @ solve(a, b) - b, s / CENTER_SIGMA * u[:2])

        shape = minimise(residual, shape)
        left = ends.difference - columns(shape) @ solve(*equations(shape))
        weight, scale = trust(left[rows]), deviation(left[rows])
    return shape, left


def grid_of_ends(ends, rows, left):
    """The residual of all pairs after a grid of ln M, fitted to what a radial form leaves of some."""
    columns, lines = grid_size(ends.sides, PAIR_NODES)
    nodes, typical = columns * lines, rows.sum() / (columns * lines)
    a = np.hstack([ends.between(lambda x, y: bilinear(ends.sides, columns, lines, x, y)), ends.constants])
    penalty = RIDGE * typical * np.eye(a.shape[1])
    penalty[:nodes, :nodes] += PAIR_STIFFNESS * typical * stiff(columns, lines)
    rest = left
    for _ in range(ROUNDS):
        weight = trust(rest[rows])
        w = a[rows] * weight[:, None]
        rest = left - a @ np.linalg.solve(w.T @ w + penalty, w.T @ (left[rows] * weight))
    return rest


def compare_ends(ends):
    """{shape: held-out RMS of ln light, clipped; by how many standard errors it and the grid are better than the radial
    form and than it; axes of an ellipse, and the ratios of the folds}"""
    left = {name: np.zeros(len(ends.difference)) for name in (*SHAPES, "grid")}
    ratios = {name: [] for name in ELLIPSES}
    for fold in np.unique(ends.fold):
        out = ends.fold == fold
        for name, unknowns in SHAPES.items():
            shape, residual = fit_ends(ends, ~out, unknowns)
            left[name][out] = residual[out]
            if name in ELLIPSES:
                ratios[name].append(axes(shape)[0])
            if name == "radial, centre":
                left["grid"][out] = grid_of_ends(ends, ~out, residual)[out]
    left = {name: ends.levelled(of) for name, of in left.items()}
    limit = CLIP * deviation(left["radial, centre"])
    square = {name: np.minimum(np.abs(of), limit)**2 for name, of in left.items()}

    def better(name, than):
        gain = square[than] - square[name]
        return float(gain.mean() / (gain.std() / np.sqrt(len(gain)))) if gain.any() else 0.0

    shapes = {name: {"rms": float(np.sqrt(of.mean())), "better": better(name, "radial, centre"),
                     "grid_better": better("grid", name)} for name, of in square.items()}
    for name in ELLIPSES:
        shapes[name].update(axes=axes(fit_ends(ends, np.ones(len(ends.fold), bool), SHAPES[name])[0]),
                            fold_ratios=ratios[name])
    return shapes


def compare_project(project, name):
    folder = tools.WORK / "forms" / name.replace("/", "-")
    folder.mkdir(parents=True, exist_ok=True)
    points = folder / "pairs.txt"
    points.unlink(missing_ok=True)
    options = [*real.FREE_ALL, "--write", f"points={points}"]
    used, model = tools.run_lensprof(str(project), str(folder / "build"), options)
    if model is None or not points.exists():
        return None
    ends = Ends(scorer.read_points(points), model.curve, tools.sizes_of_pto(project.read_text(errors="replace")))
    return {"project": name, "usable": used["usable"], "pairs": len(ends.fold), "links": ends.constants.shape[1],
            "shapes": compare_ends(ends)}


def run_all(root, quick, say):
    """root: the folder of --real, or None."""
    folders = [f for f in ([pathlib.Path(root) / "shading"] if root else []) + [PACKAGE] if f.is_dir()]
    cards = {key: card for key, card in tables_below(folders).items() if not quick or key[1] == "green"}
    if not cards:
        say("SKIPPED: shading tables: none below DIR/shading of --real DIR or in the package libcamera-ipa")
    results = {"tables": [], "sequences": []}
    for (camera, channel), card in {**cards, **rendered()}.items():
        results["tables"].append({"camera": camera, "channel": channel, "program": of_program(card),
                                  **compare_card(card)})
    say("forms: %d tables" % len(cards))
    overlaps = pathlib.Path(root or "") / "overlaps"
    for name, project in (real.projects_below(overlaps) if root and not quick and overlaps.is_dir() else {}).items():
        results["sequences"] += filter(None, [compare_project(project, name)])
        say("forms: %s" % name)
    return results
