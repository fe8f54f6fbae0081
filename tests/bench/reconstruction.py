"""Exposures of reconstructions (COLMAP's database and model, OpenSfM's tracks): rendered pictures of a moving camera
compared with the truth; real ones compared with EXIF, which the fit does not get; and COLMAP on corrected copies."""
import json
import pathlib
import shutil
import subprocess

import numpy as np

import colmap
import colours
import drone
import photographs
import scorer
import tools

WORK = tools.WORK / "reconstruction"
# Seed 1 was used during development.
SIMULATED = (("terrain", 2, "film", "-0.5,0.2,-0.1"), ("terrain", 3, "gamma:1.8", "-0.25,-0.15,0.05"),
             ("room", 2, "srgb", "-0.6,0.3,-0.1"), ("room", 3, "emor:0.8,-0.3,0.1", "-0.1,-0.3,0.08"))
CAMERA = "--images 24 --size 1200x900"
FEWER_FEATURES = ["--SiftExtraction.max_num_features", 4000]  # for the rendered pictures, to save time
ONLY = ["--fit", "free=ev,wb"]
NO_EXIF = ["--fit", "exif-sigma=0"]
REBUILT = ("snowmiku", "lund")


def build(project, pictures, log, extra=()):
    """`build` -> usage and the object it printed, or None; exposures and pairs go to files named after the log."""
    command = [tools.LENSPROF, "build", project, "--images", pictures, "--no-store", "--force", "--json",
               "--fit", "stored=none", "--write", f"exposures={log}.exposures.json,points={log}.points.txt", *extra]
    used = tools.measured(command, log.parent, log)
    text = used.pop("out")
    if used["code"] not in (0, 4) or not text.startswith("{"):
        return dict(used, lost=pathlib.Path("%s.err" % log).read_text(errors="replace")[-300:]), None
    data = json.loads(text)
    return dict(used, **tools.of_json(data)), data


def fit_ways(ways, pictures, folder, extra=()):
    """{way: project} -> {way: (usage, object, object with exposures only)}; fits without a result are left out."""
    results = {}
    for way, project in ways.items():
        used, data = build(project, pictures, folder / way, extra)
        _, only = build(project, pictures, folder / (way + "_only"), [*extra, *ONLY])
        if data and only:
            results[way] = (used, data, only)
    return results


def variances_of(folder, way):
    """For all sampled pairs; the fit itself excludes glossy points."""
    exposures = {name: colours.Exposures(folder / (way + end + ".exposures.json"))
                 for name, end in (("exposures_only", "_only"), ("result", ""))}
    return colours.variances(scorer.read_points(folder / (way + "_only.points.txt")), exposures)


def reconstruct(pictures, folder, features=(), matched=None):
    """COLMAP on a folder of pictures -> {way: project} and figures. `matched`: a folder with a database.db and a sparse
    made earlier for these pictures."""
    if matched:
        shutil.copyfile(matched / "database.db", folder / "database.db")
        shutil.copytree(matched / "sparse", folder / "sparse")
        model, figures = colmap.largest(folder)
    else:
        figures = {"match_s": colmap.match(pictures, folder, features)[1]}
        model, found = colmap.rebuild(pictures, folder)
        figures.update(found)
    figures.update(colmap.matched(folder / "database.db"))
    ways = {"database": folder / "database.db"}
    if model:
        ways["model"] = model
    return ways, figures


def set_name(kind, seed, *_):
    return "%s-%d" % (kind, seed)


def measure_simulated(kind, seed, response, vignetting):
    name = set_name(kind, seed)
    folder = WORK / name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    pictures = folder / "images"
    subprocess.run([tools.LENSPROF, "simulate", "-o", pictures, "--seed", str(seed), "--response", response,
                    "--set", f"moving={kind}",
                    "--vignetting=" + vignetting, *CAMERA.split()], check=True, stdout=subprocess.DEVNULL)
    truth = pictures / "truth.json"
    truth.rename(folder / "truth.json")  # COLMAP reads all files in the folder
    truth = scorer.read_truth(folder / "truth.json", response)
    ways, figures = reconstruct(pictures, folder, FEWER_FEATURES)
    records = []
    for way, (used, data, only) in fit_ways(ways, pictures, folder).items():
        records.append({"set": name, "response": response, "vignetting": vignetting, "way": way, "colmap": figures,
                        "images": len(data["images"]), **used, **scorer.largest_errors(truth, data),
                        "only": scorer.largest_errors(truth, only), "variance": variances_of(folder, way),
                        "stated_variance": data.get("colour_variance")})
    return records


def stated_ev(files):
    """Exposures from EXIF, log2(t ISO / 100 / N^2); None if a picture lacks it, or without exiftool."""
    if not shutil.which("exiftool"):
        return None
    text = subprocess.run(["exiftool", "-n", "-json", "-ExposureTime", "-ISO", "-FNumber", *map(str, files)],
                          capture_output=True, check=False).stdout
    tags = ("ExposureTime", "ISO", "FNumber")
    stated = [[entry.get(tag) for tag in tags] for entry in json.loads(text or b"[]")]
    if len(stated) != len(files) or not all(isinstance(v, (int, float)) and v > 0 for own in stated for v in own):
        return None
    time, iso, number = np.array(stated, float).T
    return np.log2(time * iso / 100.0 / number ** 2)


def beside_exif(known, names, data):
    """{r, slope, off_ev} of recovered exposures compared with {name: EV}, over the joined images."""
    pairs = [(known[name], image["ev"]) for name, image in zip(names, data["images"]) if image["ev"] is not None]
    stated, found = np.array(pairs).T
    return {"joined": len(pairs), "r": float(np.corrcoef(stated, found)[0, 1]),
            "slope": float(np.polyfit(stated, found, 1)[0]), "off_ev": float(np.std(found - stated))}


def names_of(folder, way):
    return colours.Exposures(folder / (way + ".exposures.json")).names


def copied(files, folder):
    pictures = folder / "images"
    shutil.rmtree(folder, ignore_errors=True)
    pictures.mkdir(parents=True)
    for file in files:
        shutil.copyfile(file, pictures / file.name)
    return pictures


def measure_real(name, files):
    """A set of real pictures -> records, one per way, and COLMAP's figures."""
    folder = WORK / name
    pictures = copied(files, folder)
    stated = stated_ev(files)
    known = None if stated is None else dict(zip((file.name for file in files), stated))
    source = files[0].parent if files[0].parent.name == name else files[0].parent.parent
    matched = source if (source / "database.db").exists() and (source / "sparse").is_dir() else None
    ways, figures = reconstruct(pictures, folder, matched=matched)
    records = []
    for way, (used, data, only) in fit_ways(ways, pictures, folder, NO_EXIF).items():
        record = {"set": name, "way": way, "images": len(data["images"]), **used, "variance": variances_of(folder, way),
                  "stated_variance": data.get("colour_variance")}
        if known:
            names = names_of(folder, way)
            record.update(exif_ev=float(np.ptp(stated)), result=beside_exif(known, names, data),
                          only=beside_exif(known, names, only))
        records.append(record)
    return records, figures


def measure_rebuilt(name, before):
    """COLMAP again, on the copies corrected with the result from the database."""
    folder, again = WORK / name, WORK / (name + "-corrected")
    shutil.rmtree(again, ignore_errors=True)
    again.mkdir()
    used = tools.measured([tools.LENSPROF, "apply", "--model", folder / "database.exposures.json", "-o", again / "images"],
                          again, again / "apply")
    record = {"set": name, "images": sum(1 for _ in (folder / "images").iterdir()), "apply_s": used["wall_s"],
              "before": before}
    if used["code"]:
        return dict(record, lost=pathlib.Path("%s.err" % (again / "apply")).read_text(errors="replace")[-300:])
    return dict(record, after=reconstruct(again / "images", again)[1])


def opensfm_folders(root):
    """Folders below root/reconstruction with tracks in OpenSfM's format."""
    return sorted(tracks.parent for tracks in (pathlib.Path(root) / "reconstruction").glob("*/tracks_example.csv"))


def measure_tracks(source):
    """With the pictures, and with the colours in tracks.csv alone."""
    folder = WORK / (source.name + "-tracks")
    files = photographs.pictures_in(source / "images")
    pictures = copied(files, folder)
    for name, end in (("tracks", ".csv"), ("reconstruction", ".json")):
        shutil.copyfile(source / (name + "_example" + end), folder / (name + end))
    record, evs, stated = {"set": source.name, "images": len(files)}, {}, stated_ev(files)
    for way, extra in (("pictures", []), ("tracks", ["--reconstruction", "track-colors=yes"])):
        record[way], data = build(folder / "tracks.csv", pictures, folder / way, [*NO_EXIF, *extra])
        if data is None:
            return record
        evs[way] = np.array([np.nan if i["ev"] is None else i["ev"] for i in data["images"]])
        if stated is not None:
            record[way].update(beside_exif(dict(zip((f.name for f in files), stated)), names_of(folder, way), data))
    off = evs["tracks"] - evs["pictures"]
    return dict(record, off_ev=float(np.nanmax(np.abs(off - np.nanmean(off)))))


def chosen(name, match):
    return any(text in name for text in match.split(","))


def run_simulated(cameras, say):
    records = []
    for number, camera in enumerate(cameras, 1):
        records += measure_simulated(*camera)
        say("reconstruction: %d of %d rendered sets" % (number, len(cameras)))
    return records


def run_real(root, match, say):
    result = {"real": [], "rebuilt": [], "tracks": []}
    for path, files in photographs.moving(root).items():
        name = path.split("/")[-1]
        if not chosen(name, match):
            continue
        records, figures = measure_real(name, files)
        result["real"] += records
        say("reconstruction: %s, %d pictures" % (name, len(files)))
        if name in REBUILT and (WORK / name / "database.exposures.json").exists():
            result["rebuilt"].append(measure_rebuilt(name, figures))
            say("reconstruction: %s rebuilt" % name)
    result["tracks"] = [measure_tracks(folder) for folder in opensfm_folders(root) if chosen(folder.name, match)]
    return result


def run_all(root, quick, match, keep, say):
    """`match`: only sets whose names contain one of these comma-separated texts; the aerial pictures are `drone`."""
    result = {"simulated": [], "real": [], "rebuilt": [], "tracks": [], "scale": [], "skipped": []}
    cameras = [camera for camera in SIMULATED if chosen(set_name(*camera), match)]
    if colmap.PROGRAM:
        result["simulated"] = run_simulated(cameras[:1] if quick else cameras, say)
        if root:
            result.update(run_real(root, match, say))
    else:
        result["skipped"].append(colmap.MISSING)
    if not tools.OPENCV:
        result["skipped"].append(tools.NO_OPENCV)
    elif chosen("drone", match):
        result["scale"] = drone.run_all(quick, keep, say)
    for what in result["skipped"]:
        say("SKIPPED: " + what)
    return result
