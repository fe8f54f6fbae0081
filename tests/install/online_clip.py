#!/usr/bin/env python3
"""Checks the example online_ratio: runs it on a clip of a wall of stones, over which a camera of gamma 2.2 pans 2 px per
frame. The exposure rises by 0.5 EV at frame 10 of 20. Without NumPy, which the examples do not need.

usage: online_clip.py PROGRAM
"""
import random
import re
import subprocess
import sys

WIDTH, HEIGHT, FRAMES, STEP, STONE = 256, 192, 20, 10, 12


def clip():
    dice = random.Random(7)
    columns = (WIDTH + 2 * FRAMES) // STONE + 1
    stones = [[0.03 + 0.5 * dice.random() ** 2 for _ in range(columns)] for _ in range(HEIGHT // STONE + 1)]
    frames = bytearray()
    for frame in range(FRAMES):
        factor = 2.0 ** 0.5 if frame >= STEP else 1.0
        grey = [[255.0 * (light * factor) ** (1 / 2.2) for light in row] for row in stones]
        for y in range(HEIGHT):
            row = grey[y // STONE]
            frames += bytes(int(row[(x + 2 * frame) // STONE] + 0.5 + dice.gauss(0, 0.7)) for x in range(WIDTH))
    return bytes(frames)


def main():
    done = subprocess.run([sys.argv[1], str(WIDTH), str(HEIGHT)], input=clip(), stdout=subprocess.PIPE, check=True)
    text = done.stdout.decode()
    steps = [(float(ev), float(sigma), int(tracks))
             for ev, sigma, tracks in re.findall(r"step ([+-][\d.]+) \+- ([\d.]+) EV.* (\d+) tracks", text)]
    print(text)
    wrong = [number for number, (ev, sigma, tracks) in enumerate(steps, 1)
             if tracks < 20 or abs(ev - (0.5 if number == STEP else 0.0)) > max(3 * sigma, 0.01)]
    if len(steps) != FRAMES - 1 or wrong:
        sys.exit(f"online_clip.py: {len(steps)} steps, of which these are wrong: {wrong}")
    if "without known exposures" not in text:
        sys.exit("online_clip.py: the exponent cannot be determined, but the example does not state it")


main()
