#!/usr/bin/env python3
"""Draws the gamma family: three cameras that make the same pictures. usage: draw_gamma.py OUT.svg

For the exponents g = 0.7, 1, 1.4: the response f(x^(1/g)), the falloff M^g and the exposures e^g, with f of gamma 2.2,
M = 1 - 0.35 r^2 and exposures of -1, 0 and 1 EV. The fourth panel shows the grey values along one diagonal of the frame,
computed with each of the three cameras: the curves are the same.
"""

import sys

EXPONENTS, COLOURS = (0.7, 1.0, 1.4), ("#1f77b4", "#222222", "#d62728")
WIDTH, HEIGHT, LEFT, TOP, SIDE, GAP = 940, 290, 48, 46, 180, 52


def response(x, g):
    return min(x, 1.0) ** (1 / 2.2 / g)


def falloff(r, g):
    return (1 - 0.35 * r * r) ** g


def grey(r, ev, g):
    """B = f( L M e ), where light and exposure are those of the member g of the family."""
    light, exposure = 0.3**g, 2.0 ** (ev * g)
    return response(light * falloff(r, g) * exposure, g)


def path(points, left, low, high, colour, dash="", width=2):
    span = high - low
    spots = " ".join(f"{left + SIDE * x:.1f},{TOP + SIDE * (1 - (y - low) / span):.1f}" for x, y in points)
    return f'<polyline points="{spots}" fill="none" stroke="{colour}" stroke-width="{width}"{dash}/>'


def panel(number, title, across, low, high):
    left = LEFT + number * (SIDE + GAP)
    return left, [
        f'<rect x="{left}" y="{TOP}" width="{SIDE}" height="{SIDE}" fill="none" stroke="#999"/>',
        f'<text x="{left}" y="{TOP - 12}" font-weight="bold">{title}</text>',
        f'<text x="{left + SIDE / 2}" y="{TOP + SIDE + 30}" text-anchor="middle">{across}</text>',
        f'<text x="{left - 6}" y="{TOP + 5}" text-anchor="end">{high:g}</text>',
        f'<text x="{left - 6}" y="{TOP + SIDE}" text-anchor="end">{low:g}</text>',
        f'<text x="{left}" y="{TOP + SIDE + 16}">0</text><text x="{left + SIDE}" y="{TOP + SIDE + 16}" text-anchor="end">1</text>',
    ]


def drawing():
    grid = [i / 100 for i in range(101)]
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="13">',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>',
    ]
    left, lines = panel(0, "response f(x^(1/γ))", "irradiance", 0, 1)
    out += lines + [path([(x, response(x, g)) for x in grid], left, 0, 1, c) for g, c in zip(EXPONENTS, COLOURS)]
    left, lines = panel(1, "falloff M^γ", "radius, half diagonals", 0, 1)
    out += lines + [path([(r, falloff(r, g)) for r in grid], left, 0, 1, c) for g, c in zip(EXPONENTS, COLOURS)]
    left, lines = panel(2, "exposures e^γ, EV", "true exposure, −1 to 1 EV", -1.5, 1.5)
    out += lines + [path([(x, (2 * x - 1) * g) for x in (0, 1)], left, -1.5, 1.5, c) for g, c in zip(EXPONENTS, COLOURS)]
    left, lines = panel(3, "grey values: all the same", "radius, half diagonals", 0, 1)
    out += lines
    for ev in (-1, 0, 1):
        for g, c, dash, width in zip(EXPONENTS, COLOURS, ("", ' stroke-dasharray="10 8"', ' stroke-dasharray="3 9"'), (6, 4, 2)):
            out.append(path([(r, grey(r, ev, g)) for r in grid], left, 0, 1, c, dash, width))
    for i, (g, c) in enumerate(zip(EXPONENTS, COLOURS)):
        x = LEFT + 130 * i
        out.append(f'<line x1="{x}" x2="{x + 30}" y1="{HEIGHT - 8}" y2="{HEIGHT - 8}" stroke="{c}" stroke-width="3"/>')
        out.append(f'<text x="{x + 38}" y="{HEIGHT - 4}">γ = {g:g}</text>')
    return "\n".join(out + ["</svg>", ""])


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    worst = max(abs(grey(r / 50, ev, g) - grey(r / 50, ev, 1.0)) for r in range(51) for ev in (-1, 0, 1) for g in EXPONENTS)
    if worst > 1e-12:
        sys.exit(f"the three cameras do not make the same pictures: {worst}")
    with open(sys.argv[1], "w", encoding="utf-8") as file:
        file.write(drawing())


if __name__ == "__main__":
    main()
