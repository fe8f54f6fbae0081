#!/usr/bin/env python3
"""Draws the picture of the README: a rendered panorama before and after correction, and the falloff that was found.

usage: gallery.py LENSPROF TARGET.svg

Everything comes from the data in the report that `lensprof report` writes, and from the truth of the simulation.
"""

import base64
import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

WIDTH, MARGIN, GAP, CHART_HEIGHT = 880, 12, 10, 250
STYLE = """
text { font: 14px system-ui, sans-serif; fill: #1c1d1f; } .tick { fill: #5b5f66; font-size: 12px; }
.grid { stroke: #e0e2e6; } .axis { stroke: #5b5f66; fill: none; } .fit { fill: none; stroke: #1f5fbf; stroke-width: 2.5; }
.band { fill: #1f5fbf; opacity: .16; } .truth { fill: none; stroke: #b8500b; stroke-width: 2; stroke-dasharray: 7 5; }
.point { fill: #5b5f66; } .label { fill: #fff; } .plate { fill: #000; opacity: .62; } .page { fill: #fff; }
"""


def jpeg_size(url):
    """Width and height: the first frame header (ITU-T T.81)."""
    data = base64.b64decode(url.partition(",")[2])
    at = 2
    while data[at + 1] not in (0xC0, 0xC1, 0xC2):
        at += 2 + struct.unpack(">H", data[at + 2:at + 4])[0]
    height, width = struct.unpack(">HH", data[at + 5:at + 9])
    return width, height


def picture(url, label, top):
    width, height = jpeg_size(url)
    shown = round((WIDTH - 2 * MARGIN) * height / width)
    return shown, (f'<image x="{MARGIN}" y="{top}" width="{WIDTH - 2 * MARGIN}" height="{shown}" href="{url}"/>'
                   f'<rect class="plate" x="{MARGIN + 8}" y="{top + 8}" width="{12 + 8 * len(label)}" height="22" rx="4"/>'
                   f'<text class="label" x="{MARGIN + 14}" y="{top + 24}">{label}</text>')


def chart(data, truth, top):
    """Relative illuminance over the radius: the fit with its band, the pairs' medians, and the truth."""
    left, right, bottom, low = 70, WIDTH - 230, top + CHART_HEIGHT - 44, 0.5
    x = lambda r: left + r * (right - left)
    y = lambda m: bottom - (m - low) / (1.05 - low) * (bottom - top - 8)
    path = lambda points: "M" + "L".join(f"{x(r):.1f} {y(m):.1f}" for r, m in points)
    curve = data["falloffs"][len(data["falloffs"]) // 2]
    radii = [i / (len(curve["m"]) - 1) for i in range(len(curve["m"]))]
    upper = [(r, m + s) for r, m, s in zip(radii, curve["m"], curve["sigma"])]
    lower = [(r, m - s) for r, m, s in zip(radii, curve["m"], curve["sigma"])]
    k = truth["vignetting"]["k"][len(truth["vignetting"]["k"]) // 2]
    true = [(r, 1 + k[0] * r**2 + k[1] * r**4 + k[2] * r**6) for r in radii]
    parts = [f'<line class="grid" x1="{left}" x2="{right}" y1="{y(m / 10):.1f}" y2="{y(m / 10):.1f}"/>'
             f'<text class="tick" x="{left - 8}" y="{y(m / 10) + 4:.1f}" text-anchor="end">{m / 10:.1f}</text>' for m in range(5, 11)]
    parts += [f'<text class="tick" x="{x(r / 4):.0f}" y="{bottom + 18}" text-anchor="middle">{r / 4:g}</text>' for r in range(5)]
    parts.append(f'<path class="axis" d="M{left} {top}V{bottom}H{right}"/>'
                 f'<text x="{(left + right) / 2:.0f}" y="{bottom + 38}" text-anchor="middle">radius, half diagonals</text>'
                 f'<text transform="translate(22 {(top + bottom) / 2:.0f}) rotate(-90)" text-anchor="middle">relative illuminance</text>')
    parts.append(f'<path class="band" d="{path(upper + lower[::-1])}Z"/>'
                 f'<path class="fit" d="{path(zip(radii, curve["m"]))}"/><path class="truth" d="{path(true)}"/>')
    parts += [f'<circle class="point" cx="{x(p["r"]):.1f}" cy="{y(p["m"]):.1f}" r="3"/>' for p in data["falloff_points"]]
    for i, (kind, text) in enumerate((("fit", "fit, with standard error"), ("truth", "truth of the simulation"))):
        parts.append(f'<path class="{kind}" d="M{right + 24} {top + 24 + 26 * i}h30"/>'
                     f'<text x="{right + 62}" y="{top + 29 + 26 * i}">{text}</text>')
    parts.append(f'<circle class="point" cx="{right + 39}" cy="{top + 76}" r="3"/><text x="{right + 62}" y="{top + 81}">medians of pairs</text>')
    return "".join(parts)


def main():
    lensprof, target = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)

        def run(*words):
            subprocess.run([lensprof, *words], cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

        run("simulate", "-o", "pictures", "--seed", "5", "--set", "mean-ev=-0.8", "--exif")
        run("build", "pictures/pano.pto", "--no-store", "--report", "report.html")
        text = (folder / "report.html").read_text(encoding="utf-8")
        data = json.loads(re.search(r'id="data">(.*?)</script>', text).group(1))
        truth = json.loads((folder / "pictures" / "truth.json").read_text())
    view = data["views"][0]
    height, before = picture(view["before"], "before", MARGIN)
    _, after = picture(view["after"], "after", MARGIN + height + GAP)
    top = MARGIN + 2 * (height + GAP) + 6
    total = top + CHART_HEIGHT
    target.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {total}" width="{WIDTH}" height="{total}">'
                      f'<style>{STYLE}</style><rect class="page" width="{WIDTH}" height="{total}"/>{before}{after}'
                      f'{chart(data, truth, top)}</svg>\n', encoding="utf-8")
    print(f"{target}: {target.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
