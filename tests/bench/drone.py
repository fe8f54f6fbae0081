"""A drone over flat, finely textured ground: thousands of pictures, and the database that COLMAP would write for them.

Every picture is a part of one repeating texture, so the true position of its points is known to the pixel; the
keypoints of the database are off by KEYPOINT_PX. Measures how time and memory of lensprof grow with the number of
pictures.
"""
import json
import pathlib
import shutil
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import colmap
import scorer
import tools

ROWS, COLUMNS, QUICK_COLUMNS = 25, (20, 40, 80, 200), (20,)
WIDTH, HEIGHT = 1000, 750
STEP_X, STEP_Y, JITTER = 250, 300, 20  # px: each point is in ten pictures
OBSERVATIONS, MARGIN = 600, 20  # per picture; px from its rim
KEYPOINT_PX, NOISE_LEVELS, QUALITY = 0.3, 1.0, 92
EV, BALANCE = 0.75, 0.06  # uniform within +-
K, CENTER = (-0.45, 0.12, -0.06), (0.01, -0.02)
TILE, CELLS = 4096, ((16, 0.3), (64, 0.4), (256, 0.5), (1024, 0.4))  # px; standard deviations in stops
MEAN_LIGHT, CODES = 0.18, 1 << 14
LEAST_MATCHES = 15
LIMIT_S = 3600


def repeating_noise(rng, cell):
    """Smooth noise with a period of TILE px."""
    import cv2
    grid, rim = rng.standard_normal((TILE // cell, TILE // cell)).astype(np.float32), 3
    wide = cv2.resize(np.pad(grid, rim, "wrap"), None, fx=cell, fy=cell, interpolation=cv2.INTER_CUBIC)
    return wide[rim * cell:rim * cell + TILE, rim * cell:rim * cell + TILE]


def ground(rng):
    """Light of the ground, [rows, columns, 3], larger than a tile by the size of a picture."""
    grey = sum(deviation * repeating_noise(rng, cell) for cell, deviation in CELLS)
    light = np.empty((TILE + HEIGHT, TILE + WIDTH, 3), np.float32)
    for c in range(3):
        colour = grey + 0.15 * repeating_noise(rng, 64) + 0.15 * repeating_noise(rng, 512)
        light[..., c] = np.pad(MEAN_LIGHT * np.exp2(colour), ((0, HEIGHT), (0, WIDTH)), "wrap")
    return light


class Flight:
    """The truth: positions of the pictures, and the camera's exposures. Pictures are numbered along the rows."""

    def __init__(self, columns, seed=1):
        rng = np.random.default_rng(seed)
        row, column = np.divmod(np.arange(ROWS * columns), columns)
        self.row, self.column, self.columns = row, column, columns
        self.origin = np.stack([column * STEP_X, row * STEP_Y], axis=1) + rng.integers(0, JITTER, (len(row), 2))
        self.names = ["r%02d_c%03d.jpg" % place for place in zip(row, column)]
        balance = rng.uniform(1.0 - BALANCE, 1.0 + BALANCE, (len(row), 3))
        balance[:, 1], balance[0] = 1.0, 1.0
        curve = scorer.Curve(tools.emor_table()[0] + 0.6 * tools.emor_table()[1])
        self.truth = scorer.Model(rng.uniform(-EV, EV, len(row)), balance, np.array([K]), np.array(CENTER), curve)

    def first_columns(self, columns):
        """The same flight with shorter rows."""
        kept = self.column < columns
        part = object.__new__(Flight)
        part.row, part.column, part.columns, part.origin = self.row[kept], self.column[kept], columns, self.origin[kept]
        part.names = [name for name, is_kept in zip(self.names, kept) if is_kept]
        part.truth = scorer.Model(self.truth.ev[kept], self.truth.white_balance[kept], *(
            getattr(self.truth, what) for what in ("k", "center", "curve")))
        return part


def falloff(model):
    """M of every pixel."""
    rho = np.hypot(WIDTH, HEIGHT) / 2.0
    x, y = (np.arange(WIDTH) - (WIDTH - 1) / 2.0) / rho, (np.arange(HEIGHT) - (HEIGHT - 1) / 2.0) / rho
    r2 = np.square(x - model.center[0]) + np.square(y - model.center[1])[:, None]
    return model.falloff(r2).astype(np.float32)


def render(flight, folder):
    import cv2
    rng = np.random.default_rng(2)
    light, codes = ground(rng), flight.truth.curve.f(np.arange(CODES) / (CODES - 1.0)).astype(np.float32) * 255.0
    noise = rng.normal(0.0, NOISE_LEVELS, (2 * HEIGHT, 2 * WIDTH, 3)).astype(np.float32)
    shade, shifts = falloff(flight.truth) * np.float32(CODES - 1), rng.integers(0, HEIGHT, (len(flight.names), 2))

    def write(i):
        x, y = flight.origin[i] % TILE
        exposure = (2.0 ** flight.truth.ev[i] * flight.truth.white_balance[i]).astype(np.float32)
        code = np.minimum(light[y:y + HEIGHT, x:x + WIDTH] * shade * exposure, CODES - 1).astype(np.uint16)
        level = codes[code] + noise[shifts[i, 0]:shifts[i, 0] + HEIGHT, shifts[i, 1]:shifts[i, 1] + WIDTH]
        picture = np.clip(level + 0.5, 0, 255).astype(np.uint8)[..., ::-1]
        cv2.imwrite(str(folder / flight.names[i]), picture, [cv2.IMWRITE_JPEG_QUALITY, QUALITY])

    cv2.setNumThreads(1)
    with ThreadPoolExecutor(2) as pool:
        list(pool.map(write, range(len(flight.names))))


def observed(flight, rng):
    """Per picture the numbers of its points, ascending, and its keypoints (x y scale orientation)."""
    extent = flight.origin.max(axis=0) + (WIDTH, HEIGHT)
    count = int(OBSERVATIONS * extent.prod() / ((WIDTH - 2 * MARGIN) * (HEIGHT - 2 * MARGIN)))
    points = rng.uniform(0.0, 1.0, (count, 2)) * extent
    points = points[np.argsort(points[:, 0], kind="stable")]
    numbers, keypoints = [], []
    for x, y in flight.origin:
        first, last = np.searchsorted(points[:, 0], (x + MARGIN, x + WIDTH - MARGIN))
        rows = points[first:last, 1] - y
        own = first + np.flatnonzero((rows > MARGIN) & (rows < HEIGHT - MARGIN))
        keypoint = np.empty((len(own), 4), np.float32)
        keypoint[:, :2] = points[own] - (x, y) + 0.5 + rng.normal(0.0, KEYPOINT_PX, (len(own), 2))
        keypoint[:, 2], keypoint[:, 3] = 3.0, 0.0
        numbers.append(own)
        keypoints.append(keypoint)
    return numbers, keypoints


def pairs_of(flight, numbers):
    """(number, number, matches) of pictures that share enough points."""
    reach_x, reach_y = WIDTH // STEP_X, HEIGHT // STEP_Y
    for i, (row, column) in enumerate(zip(flight.row, flight.column)):
        for other_row in range(row, min(ROWS, row + reach_y + 1)):
            for other in range(max(0, column - reach_x), min(flight.columns, column + reach_x + 1)):
                j = other_row * flight.columns + other
                if j <= i:
                    continue
                _, a, b = np.intersect1d(numbers[i], numbers[j], assume_unique=True, return_indices=True)
                if len(a) >= LEAST_MATCHES:
                    yield i + 1, j + 1, np.stack([a, b], axis=1).astype(np.uint32)


def measure(flight, pictures, folder):
    """One number of pictures -> a record."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    numbers, keypoints = observed(flight, np.random.default_rng(3))
    colmap.write_database(folder / "database.db", (WIDTH, HEIGHT), list(zip(flight.names, keypoints)),
                          pairs_of(flight, numbers))
    record = {"images": len(flight.names), "observations": sum(map(len, numbers)),
              "database_mb": (folder / "database.db").stat().st_size / 2.0 ** 20}
    used = tools.measured([tools.LENSPROF, "build", folder / "database.db", "--images", pictures, "--no-store",
                           "--fit", "stored=none", "--json", "--write", "exposures=%s" % (folder / "exposures.json")], folder, folder / "build",
                          limit_s=LIMIT_S)
    text = used.pop("out")
    record.update(used)
    if not text.startswith("{"):
        return dict(record, lost=pathlib.Path("%s.err" % (folder / "build")).read_text(errors="replace")[-300:])
    data = json.loads(text)
    record.update(tools.of_json(data), **scorer.largest_errors(flight.truth, data), seconds=data["seconds"],
                  variance=data.get("colour_variance", {}))
    return record


def apply(record, folder):
    used = tools.measured([tools.LENSPROF, "apply", "--model", folder / "exposures.json", "-o", folder / "corrected"],
                          folder, folder / "apply", limit_s=LIMIT_S)
    record.update(apply_s=used["wall_s"] if used["code"] == 0 else None, apply_mb=used["peak_mb"])
    shutil.rmtree(folder / "corrected", ignore_errors=True)


def run_all(quick, keep, say):
    work = tools.WORK / "reconstruction" / "drone"
    pictures = work / "images"
    shutil.rmtree(work, ignore_errors=True)
    pictures.mkdir(parents=True)
    sizes = QUICK_COLUMNS if quick else COLUMNS
    flight, records = Flight(max(sizes)), []
    began = time.perf_counter()
    render(flight, pictures)
    say("reconstruction: %d pictures from above, %.0f s" % (len(flight.names), time.perf_counter() - began))
    for columns in sizes:
        folder = work / str(columns * ROWS)
        record = measure(flight.first_columns(columns), pictures, folder)
        if columns == min(sizes) and "lost" not in record:
            apply(record, folder)
        records.append(record)
        say("reconstruction: %d pictures in %.0f s" % (record["images"], record["wall_s"]))
    if not keep:
        shutil.rmtree(pictures)
    return records
