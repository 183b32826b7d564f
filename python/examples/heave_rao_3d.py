"""The heave of a sphere in regular waves, in 3-D, beside that of Capytaine: the response amplitude operator (RAO).

The sphere is half under water in the middle of a channel, of which one side is computed. The wave is measured in a run without the
sphere, in a narrower channel, at its place. Capytaine has the sphere in open water: in waves longer than the channel is wide the
side walls change the heave by less than 2 % (an infinite row of spheres stands for them).

    python heave_rao_3d.py [--periods 1.0 1.2] [--dp 0.0375] [--panels 800] [--out FOLDER] [--plot FILE]

The default takes about two minutes of one core and is coarse, with eight particles in a diameter.
"""

import argparse
import math
import tempfile
from pathlib import Path

import numpy as np

import pontoon as pt
from pontoon import potential_flow

#: Radius of the sphere and its place, depth of the water, half the width and length of the channel, m.
RADIUS, PLACE, DEPTH, HALF, LENGTH = 0.15, 1.1, 0.375, 0.375, 2.6
#: Height of the waves, m, and the times between which their amplitude is measured, s.
WAVE, START, UNTIL = 0.05, 4.0, 7.0


def channel(period: float, dp: float, sphere: bool) -> pt.Scene:
    """Returns a channel with waves of this period (s) in particles of `dp` (m), with or without the sphere."""
    half = HALF if sphere else 4.0 * dp
    solid = f"""
[[solid]]
name = "sphere"
shape = {{ ball = {{ radius = {RADIUS} }} }}
at = {{ x = {PLACE}, y = 0.0, draft = "equilibrium" }}
free = {{ density = 500.0, locked = ["x", "turn_y"] }}

[[probe]]
motion = "sphere"
every = 0.01
"""
    return pt.Scene.from_toml(
        f"""
title = "A sphere in waves"
dimension = 3
dp = {dp}
until = {UNTIL}
symmetry = {{ y = 0.0 }}
frames = "off"

[[water]]
fill = {{ box = {{ min = [0.0, 0.0, 0.0], max = [{LENGTH}, {half}, {DEPTH}] }} }}

[[solid]]
name = "tank"
fixed = true
shape = {{ tank = {{ size = [{LENGTH + 0.225:g}, {2.0 * half}, {DEPTH + 0.15}] }} }}
at = {{ x = -0.225, y = {-half} }}

[[solid]]
name = "paddle"
shape = {{ box = {{ size = [0.15, {2.0 * half}, {DEPTH + 0.15}] }} }}
at = {{ x = -0.075, y = 0.0, bottom = 0.0 }}
driven = {{ along = [1.0, 0.0, 0.0], wave = {{ regular = {{ height = {WAVE}, period = {period} }}, absorb = true }} }}

[[damping]]
from = [{PLACE + 0.4}, 0.0, 0.0]
to = [{LENGTH}, 0.0, 0.0]

[model]
c0_factor = 7.0

[[probe]]
elevation = {{ x = {PLACE}, y = 0.0 }}
every = 0.01
{solid if sphere else ""}"""
    )


def main() -> None:
    """Runs the waves, prints both RAOs and checks the difference."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--periods", type=float, nargs="+", default=[1.0], help="periods of the waves, s")
    options.add_argument("--dp", type=float, default=0.0375, help="particle spacing, m")
    options.add_argument("--panels", type=int, default=800, help="panels of Capytaine")
    options.add_argument("--out", type=Path, help="folder of the runs")
    options.add_argument("--plot", type=Path, help="file for a plot")
    given = options.parse_args()
    out = given.out or Path(tempfile.mkdtemp())
    periods = sorted(given.periods, reverse=True)

    bodies = potential_flow.export_bodies(channel(periods[0], given.dp, True), out / "bodies", panels=given.panels)
    computed = bodies.solve([2.0 * math.pi / period for period in periods], motions=["heave"]).rao("heave")
    heave: list[complex] = []
    for period in periods:
        runs = [
            pt.run(channel(period, given.dp, sphere), out=out / f"{period:g}-{sphere}", report=False)
            for sphere in (False, True)
        ]
        names = ("elevation.eta", "heave")
        wave, answer = (run.series[name].harmonic(period, START) for run, name in zip(runs, names, strict=True))
        print(f"period {period:g} s: wave {1e3 * abs(wave):.1f} mm, heave {1e3 * abs(answer):.1f} mm")
        heave.append(answer / wave)
    measured = pt.Rao(
        name="channel",
        motion="sphere.heave_m",
        unit="m/m",
        frequency=1.0 / np.array(periods),
        amplitude=np.abs(heave),
        phase=np.degrees(np.angle(heave)),
        coherence=np.ones(len(heave)),
    )
    comparison = potential_flow.compare_raos(measured, computed)
    print(comparison)
    leads = zip(measured.frequency, measured.phase, computed.phase, strict=True)
    for frequency, own, other in leads:
        print(f"  {frequency:8.4g} Hz  heave leads the wave by {own:.0f}°, in potential flow by {other:.0f}°")
    if given.plot:
        import matplotlib

        matplotlib.use("Agg")
        from matplotlib import pyplot

        figure, axes = pyplot.subplots(figsize=(5, 4))
        comparison.plot(axes)
        figure.savefig(given.plot, dpi=120)

    # Measured 5 % below potential flow. The free heave of the start dies away slowly, and changes the amplitude by several per cent.
    assert abs(comparison.difference).max() < 0.15
    assert abs(measured.phase - computed.phase).max() < 25.0, "degrees"


if __name__ == "__main__":
    main()
