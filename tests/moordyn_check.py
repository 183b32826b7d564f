#!/usr/bin/env python3
"""Compares mooring lines on random decks with MoorDyn, from its Python package.

    python3 tests/moordyn_check.py [--require] [--decks N] [--out DIR]

Each deck is one line in still water from an anchor on the bed to a fairlead that moves on an ellipse: a slack chain or a taut rope.
In a third as many decks again the fairlead also moves across the plane of the line.
MoorDyn computes the tension at the fairlead, of a chain with twice the segments; the unit test `lines_follow_moordyn` reads the
decks from DIR (variable MOORDYN_DECKS) and compares its own, within 2 % of the range. Without the package `moordyn` the script
prints that it is skipped; with --require it fails.
"""

import argparse
import math
import os
import random
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import moordyn
except ImportError:
    moordyn = None

WATER, GRAVITY, STEP, UNTIL = 1025.0, 9.81, 0.05, 30.0

DECK = """\
--------------------- MoorDyn Input File ------------------------------------
Random deck
---------------------- LINE TYPES -----------------------------------
TypeName Diam MassDen EA BA/-zeta EI Cd Ca CdAx CaAx
(name) (m) (kg/m) (N) (N-s/-) (N-m2) (-) (-) (-) (-)
line {diameter} {mass} {stiffness} -{zeta} 0.0 {drag} {added} {drag_axial} 0.0
---------------------- POINTS ---------------------------------------
ID Attachment X Y Z M V CdA CA
(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
1 Fixed {x} 0.0 {bottom} 0 0 0 0
2 Coupled 0.0 0.0 {top} 0 0 0 0
---------------------- LINES ----------------------------------------
ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs
(#) (name) (#) (#) (m) (-) (-)
1 line 1 2 {length} {reference} -
---------------------- OPTIONS --------------------------------------
{inner} dtM
1e5 kbot
1e4 cbot
{water} WtrDnsty
{depth} WtrDpth
{gravity} g
0.0 FrictionCoefficient
0.2 dtIC
200 TmaxIC
4 CdScaleIC
1e-6 threshIC
---------------------- OUTPUTS --------------------------------------
FairTen1
------------------------- need this line --------------------------------------
"""


def random_deck(rng, is_spatial):
    """Numbers of a deck: a slack chain, or a taut rope that keeps tension. A spatial one has sway."""
    depth = rng.uniform(40.0, 150.0)
    chain = rng.random() < 0.5
    diameter = rng.uniform(0.1, 0.25)
    deck = {
        "depth": depth,
        "bottom": -depth,
        "top": -rng.uniform(5.0, 10.0),
        "x": depth * (rng.uniform(3.0, 5.0) if chain else rng.uniform(0.3, 1.5)),
        "diameter": diameter,
        "mass": rng.uniform(5000.0, 6500.0) * diameter**2 if chain else rng.uniform(900.0, 1300.0) * diameter**2,
        "stiffness": rng.uniform(1.0e10, 2.5e10) * diameter**2 if chain else rng.uniform(3e8, 2e9) * diameter**2,
        "zeta": rng.uniform(0.5, 1.0),
        "drag": rng.uniform(1.0, 2.0),
        "added": rng.uniform(0.7, 1.0),
        "drag_axial": rng.uniform(0.0, 0.4),
        "segments": rng.randrange(20, 41) * (2 if chain else 1),
        "surge": rng.uniform(0.5, 2.0),
        "heave": rng.uniform(0.5, 2.0),
        "period": rng.uniform(8.0, 14.0),
        "water": WATER,
        "gravity": GRAVITY,
    }
    distance = math.hypot(deck["x"], depth + deck["top"])
    # Slack chain has a hundredth more than its chord and part of it on the bed; a rope is strained by 3 to 6 %.
    stretch = rng.uniform(1.01, 1.03) if chain else 1.0 / rng.uniform(1.05, 1.09)
    deck["length"] = distance * stretch
    # MoorDyn's chain of 23 segments is 4.5 % of the range from one of 92, so that the reference has twice the segments.
    deck["reference"] = deck["segments"] * (2 if chain else 1)
    node = deck["length"] / deck["reference"]
    deck["sway"] = rng.uniform(1.0, 3.0) if is_spatial else 0.0
    deck["inner"] = 0.05 * node * math.sqrt(deck["mass"] / deck["stiffness"])
    return deck


def motion(deck, t):
    """Place of the fairlead: an ellipse that grows over a period."""
    ramp = min(t / deck["period"], 1.0)
    ramp = ramp * ramp * (3.0 - 2.0 * ramp)
    phase = 2.0 * math.pi * t / deck["period"]
    sway = deck["sway"] * ramp * math.cos(phase)
    return [deck["surge"] * ramp * math.sin(phase), sway, deck["top"] + deck["heave"] * ramp * (1.0 - math.cos(phase))]


def tensions(deck, folder):
    """Times (s) and tensions at the fairlead (N) from MoorDyn."""
    path = folder / "lines.txt"
    path.write_text(DECK.format(**deck))
    system = moordyn.Create(str(path))
    moordyn.SetVerbosity(system, moordyn.LEVEL_ERR)
    moordyn.Init(system, motion(deck, 0.0), [0.0] * 3)
    line = moordyn.GetLine(system, 1)
    rows = [(0.0, moordyn.GetLineFairTen(line))]
    for k in range(round(UNTIL / STEP)):
        t = k * STEP
        now, then = motion(deck, t), motion(deck, t + STEP)
        moordyn.Step(system, now, [(b - a) / STEP for a, b in zip(now, then)], t, STEP)
        rows.append((t + STEP, moordyn.GetLineFairTen(line)))
    moordyn.Close(system)
    return rows


COLUMNS = [
    "depth", "top", "x", "length", "segments", "diameter", "mass", "stiffness", "zeta", "drag", "added", "drag_axial",
    "surge", "heave", "period", "sway",
]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--require", action="store_true")
    parser.add_argument("--decks", type=int, default=6)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path)
    arguments = parser.parse_args()
    if moordyn is None:
        print("moordyn_check: skipped, the package moordyn is missing")
        return int(arguments.require)
    rng = random.Random(arguments.seed)
    with tempfile.TemporaryDirectory() as scratch:
        folder = arguments.out or Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        for i in range(arguments.decks + arguments.decks // 3):
            deck = random_deck(rng, i >= arguments.decks)
            rows = tensions(deck, folder)
            text = ",".join(COLUMNS) + "\n" + ",".join(repr(float(deck[name])) for name in COLUMNS) + "\n"
            text += "".join(f"{t!r},{tension!r}\n" for t, tension in rows)
            (folder / f"deck_{i:03}.csv").write_text(text)
        if arguments.out:
            return 0
        command = ["cargo", "test", "--release", "--locked", "--lib", "lines_follow_moordyn", "--", "--nocapture", "--ignored"]
        return subprocess.run(command, env={**os.environ, "MOORDYN_DECKS": str(folder)}, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
