"""COLMAP (package colmap): runs it on pictures to get database.db and a model, and writes its database directly."""
import os
import re
import shutil
import sqlite3

import tools

PROGRAM = shutil.which("colmap")
MISSING = "colmap is not installed (package colmap)"
LIMIT_S = 1800
PAIR_BASE = 2147483647
FIGURES = {"registered": r"Registered images: (\d+)", "points": r"Points: (\d+)", "observations": r"Observations: (\d+)",
           "track_length": r"Mean track length: ([\d.]+)", "error_px": r"Mean reprojection error: ([\d.]+)"}
SCHEMA = """
CREATE TABLE cameras (camera_id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, model INTEGER NOT NULL,
  width INTEGER NOT NULL, height INTEGER NOT NULL, params BLOB, prior_focal_length INTEGER NOT NULL);
CREATE TABLE images (image_id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, name TEXT NOT NULL UNIQUE,
  camera_id INTEGER NOT NULL, prior_qw REAL, prior_qx REAL, prior_qy REAL, prior_qz REAL, prior_tx REAL, prior_ty REAL,
  prior_tz REAL);
CREATE TABLE keypoints (image_id INTEGER PRIMARY KEY NOT NULL, rows INTEGER NOT NULL, cols INTEGER NOT NULL, data BLOB);
CREATE TABLE descriptors (image_id INTEGER PRIMARY KEY NOT NULL, rows INTEGER NOT NULL, cols INTEGER NOT NULL,
  data BLOB);
CREATE TABLE matches (pair_id INTEGER PRIMARY KEY NOT NULL, rows INTEGER NOT NULL, cols INTEGER NOT NULL, data BLOB);
CREATE TABLE two_view_geometries (pair_id INTEGER PRIMARY KEY NOT NULL, rows INTEGER NOT NULL, cols INTEGER NOT NULL,
  data BLOB, config INTEGER NOT NULL, F BLOB, E BLOB, H BLOB, qvec BLOB, tvec BLOB);
"""
SIMPLE_RADIAL, CALIBRATED = 2, 2


def step(folder, command, *options, may_fail=False):
    """One command of COLMAP -> usage; RuntimeError if it fails."""
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    used = tools.measured([PROGRAM, command, *options], folder, folder / command, limit_s=LIMIT_S)
    if used["code"] and not may_fail:
        raise RuntimeError("colmap %s: exit code %s; see %s.err" % (command, used["code"], folder / command))
    return used


def match(pictures, folder, features=()):
    """-> database.db of a folder's pictures, each matched with each, and the seconds taken. `features`: options."""
    database = folder / "database.db"
    for end in ("", "-wal", "-shm"):
        database.with_name(database.name + end).unlink(missing_ok=True)
    steps = [step(folder, "feature_extractor", "--database_path", database, "--image_path", pictures,
                  "--ImageReader.single_camera", 1, "--SiftExtraction.use_gpu", 0, *features),
             step(folder, "exhaustive_matcher", "--database_path", database, "--SiftMatching.use_gpu", 0)]
    return database, sum(used["wall_s"] for used in steps)


def rebuild(pictures, folder):
    """-> the mapper's model with most images for folder/database.db, or None, and its figures."""
    models = folder / "sparse"
    shutil.rmtree(models, ignore_errors=True)
    models.mkdir()
    step(folder, "mapper", "--database_path", folder / "database.db", "--image_path", pictures, "--output_path",
         models, may_fail=True)  # the mapper fails if it finds no model
    return largest(folder)


def largest(folder):
    """-> the model with most images in folder/sparse, or None, and its figures."""
    found = [(analyzed(folder, model), model) for model in sorted((folder / "sparse").iterdir())]
    if not found:
        return None, {"registered": 0}
    figures, best = max(found, key=lambda own: own[0]["registered"])
    return best, figures


def analyzed(folder, model):
    """The figures that `colmap model_analyzer` prints for a model."""
    step(folder, "model_analyzer", "--path", model)
    text = "".join((folder / ("model_analyzer" + end)).read_text(errors="replace") for end in (".out", ".err"))
    found = {name: re.search(pattern, text) for name, pattern in FIGURES.items()}
    return {name: float(m.group(1)) if m else 0.0 for name, m in found.items()}


def matched(database):
    """Pairs of pictures with matches verified by COLMAP, and these matches."""
    opened = sqlite3.connect(database)
    pairs, matches = opened.execute("SELECT count(*), sum(rows) FROM two_view_geometries WHERE rows > 0").fetchone()
    opened.close()
    return {"pairs": pairs, "matches": matches or 0}


def write_database(path, size, images, pairs):
    """A database of one camera. images: (name, keypoints [n, 4] float32) in the order of their numbers, starting at 1;
    pairs: (number, number, matches [n, 2] uint32), the smaller number first."""
    path.unlink(missing_ok=True)
    database = sqlite3.connect(path)
    database.executescript("PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF;" + SCHEMA)
    database.execute("INSERT INTO cameras VALUES (1, ?, ?, ?, NULL, 0)", (SIMPLE_RADIAL, *size))
    for number, (name, keypoints) in enumerate(images, 1):
        database.execute("INSERT INTO images (image_id, name, camera_id) VALUES (?, ?, 1)", (number, name))
        database.execute("INSERT INTO keypoints VALUES (?, ?, 4, ?)", (number, len(keypoints), keypoints.tobytes()))
    database.executemany(
        "INSERT INTO two_view_geometries (pair_id, rows, cols, data, config) VALUES (?, ?, 2, ?, ?)",
        ((PAIR_BASE * a + b, len(matches), matches.tobytes(), CALIBRATED) for a, b, matches in pairs))
    database.commit()
    database.close()
